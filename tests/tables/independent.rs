//! A second reader of data sets, made for these tests alone: it knows lines that begin with a comma, and
//! nothing of the crate that writes them.

use formats::tables::{TableFormat, write};

use super::{Dice, random_set};

struct Found {
    id: u32,
    name: String,
    linear: bool,
    x: Vec<f64>,
    y: Vec<Vec<f64>>,
}

/// Splits at statements, then at `NAME =`, then at commas; numbers by the standard library.
fn parse(text: &str) -> (Vec<Found>, String) {
    let mut found: Vec<Found> = Vec::new();
    let mut units = String::new();
    let mut name = String::new();
    let mut logical = String::new();
    let lines: Vec<&str> = text.lines().collect();
    for (k, line) in lines.iter().enumerate() {
        if let Some(comment) = line.strip_prefix('!') {
            if let Some((_, value)) = comment.split_once("adams_view_name=") {
                name = value.trim().trim_matches('\'').to_owned();
            }
            continue;
        }
        logical.push(' ');
        logical.push_str(line);
        if lines.get(k + 1).is_some_and(|next| next.starts_with(',')) {
            continue;
        }
        let statement = std::mem::take(&mut logical);
        let statement = statement.trim();
        if statement.starts_with("UNITS/") {
            units = statement.replace(' ', "");
        } else if let Some(rest) = statement.strip_prefix("SPLINE/") {
            let mut parts = rest.split(',').map(str::trim);
            let id = parts.next().expect("an id").parse().expect("a number");
            let mut one = Found {
                id,
                name: std::mem::take(&mut name),
                linear: false,
                x: Vec::new(),
                y: Vec::new(),
            };
            let mut in_x = false;
            for part in parts {
                let number = match part.split_once('=') {
                    Some((key, value)) => {
                        in_x = key.trim() == "X";
                        if !in_x {
                            assert_eq!(key.trim(), "Y");
                            one.y.push(Vec::new());
                        }
                        value.trim()
                    }
                    None if part == "LINEAR_EXTRAPOLATE" => {
                        one.linear = true;
                        continue;
                    }
                    None => part,
                };
                let number: f64 = number.parse().expect("a number");
                if in_x {
                    one.x.push(number)
                } else {
                    one.y.last_mut().expect("a list").push(number)
                }
            }
            found.push(one);
        }
    }
    (found, units)
}

#[test]
fn an_independent_reader_finds_the_same_numbers_in_a_data_set() {
    let mut dice = Dice::new(31);
    for _ in 0..50 {
        let set = random_set(&mut dice);
        let bytes = write(&set, TableFormat::Adams).expect("writable");
        let (found, units) = parse(std::str::from_utf8(&bytes).expect("text"));
        assert_eq!(
            units,
            "UNITS/,FORCE=POUND_FORCE,MASS=SLUG,LENGTH=FOOT,TIME=SECOND"
        );
        assert_eq!(found.len(), set.tables.len());
        for (found, table) in found.iter().zip(&set.tables) {
            assert_eq!(
                (found.id, &found.name, found.linear),
                (table.id, &table.name, true)
            );
            let same = |a: &[f64], b: &[f64]| {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
            };
            assert!(same(&found.x, table.curves.x()));
            let (z, rows) = (table.curves.z(), table.curves.y());
            assert_eq!(found.y.len(), rows.len());
            for (i, (found, row)) in found.y.iter().zip(rows).enumerate() {
                let values = match z.get(i) {
                    None => found.as_slice(),
                    Some(z) => {
                        assert_eq!(found[0].to_bits(), z.to_bits());
                        &found[1..]
                    }
                };
                assert!(same(values, row));
            }
        }
    }
}
