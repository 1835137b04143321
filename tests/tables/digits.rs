//! `--digits`: what rounding did is reported, and right.

use formats::tables::{RoundError, read, round};
use serde_json::Value;

use super::{Dice, bogie_grid, bytes, folder, girderway, random_set, table, told};

/// A number with more digits than a double has, by string arithmetic: the decimal expansion of `value`,
/// cut after `digits` and rounded by the rest.
fn by_hand(value: f64, digits: usize) -> f64 {
    if value == 0.0 {
        return value;
    }
    // 1100 digits are all that a double has
    let full = format!("{:.1100e}", value.abs());
    let (mantissa, exponent) = full.split_once('e').expect("an exponent");
    let all: Vec<u8> = mantissa
        .bytes()
        .filter(u8::is_ascii_digit)
        .map(|c| c - b'0')
        .collect();
    let (kept, rest) = all.split_at(digits);
    let mut kept: Vec<u8> = std::iter::once(0).chain(kept.iter().copied()).collect();
    let tie = rest[0] == 5 && rest[1..].iter().all(|&digit| digit == 0);
    let up = if tie {
        kept[digits] % 2 == 1
    } else {
        rest[0] >= 5
    };
    if up {
        let mut k = digits;
        kept[k] += 1;
        while kept[k] == 10 {
            kept[k] = 0;
            k -= 1;
            kept[k] += 1;
        }
    }
    let text: String = kept.iter().map(|digit| char::from(b'0' + digit)).collect();
    let exponent: i32 = exponent.parse().expect("a number");
    let shift = exponent - i32::try_from(digits).expect("few") + 1;
    let size: f64 = format!("{text}e{shift}").parse().expect("a number");
    if value < 0.0 { -size } else { size }
}

#[test]
fn rounding_is_that_of_the_decimal_expansion_and_its_report_is_right() {
    let mut dice = Dice::new(21);
    for digits in [1, 3, 10, 15] {
        let mut checked = 0;
        for _ in 0..40 {
            let set = random_set(&mut dice);
            let Ok((rounded, report)) = round(&set, digits) else {
                continue;
            };
            checked += 1;
            let mut largest = 0.0_f64;
            for (table, new) in set.tables.iter().zip(&rounded.tables) {
                let lists = |t: &formats::tables::Table| {
                    [t.curves.x(), t.curves.z(), &t.curves.y().concat()].concat()
                };
                for (given, new) in lists(table).into_iter().zip(lists(new)) {
                    assert_eq!(new, by_hand(given, digits), "{given} to {digits}");
                    if given != 0.0 {
                        largest = largest.max(((new - given) / given).abs());
                    }
                }
            }
            assert_eq!(report.largest, largest);
            assert!(report.stations && report.at.is_some());
        }
        assert!(checked > 20, "{digits}: {checked}");
    }
}

#[test]
fn all_digits_change_nothing() {
    let set = random_set(&mut Dice::new(22));
    let (same, report) = round(&set, 17).expect("17 digits tell all doubles apart");
    assert_eq!((same, report.largest, report.at), (set, 0.0, None));
}

#[test]
fn what_cannot_be_rounded_is_refused() {
    let curves = |x: [f64; 4], y: f64| {
        adams::SplineValues::new(x.to_vec(), Vec::new(), vec![vec![y; 4]]).expect("four")
    };
    let mut set = random_set(&mut Dice::new(23));
    set.tables = vec![table(7, "a", None, curves([0.0, 1.0, 1.01, 2.0], 0.0))];
    assert_eq!(round(&set, 2), Err(RoundError::Stations { id: 7 }));
    set.tables = vec![table(7, "a", None, curves([0.0, 1.0, 2.0, 3.0], f64::MAX))];
    assert_eq!(round(&set, 2), Err(RoundError::Overflow { id: 7 }));
}

#[test]
fn the_program_reports_rounding_to_people_and_to_programs() {
    let folder = folder();
    bogie_grid(folder.path());
    let plain = girderway(
        folder.path(),
        &["splines", "grid.json", "-o", "all.npz", "--quiet"],
    );
    assert_eq!(plain.status.code(), Some(0));
    let run = girderway(
        folder.path(),
        &[
            "splines",
            "grid.json",
            "-o",
            "ten.cmd",
            "--digits",
            "10",
            "--json",
        ],
    );
    assert_eq!((run.status.code(), told(&run).as_str()), (Some(0), ""));
    let result: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let rounding = &result["rounding"];
    let [all, ten] = ["all.npz", "ten.cmd"]
        .map(|name| read(name, &bytes(&folder.path().join(name)), None).expect("our own file"));
    let at = &rounding["at"];
    let id = u32::try_from(at["id"].as_u64().expect("an id")).expect("small");
    let value = |set: &formats::tables::TableSet| {
        let curves = &set.table(id).expect("the table").curves;
        let place = |list: &[f64], x: &Value| {
            list.iter()
                .position(|one| Some(*one) == x.as_f64())
                .expect("a station")
        };
        curves.y()[place(curves.z(), &at["z"])][place(curves.x(), &at["x"])]
    };
    let error = (value(&ten) / value(&all) - 1.0).abs();
    let largest = rounding["largest"].as_f64().expect("a number");
    assert!(
        (error - largest).abs() < 1e-15 && largest > 1e-11 && largest <= 5e-10,
        "{error} {largest}"
    );
    assert_eq!(
        (rounding["digits"].as_u64(), rounding["stations"].as_bool()),
        (Some(10), Some(false))
    );
    let run = girderway(
        folder.path(),
        &["splines", "grid.json", "-o", "ten.adm", "--digits", "10"],
    );
    assert!(
        told(&run).starts_with("rounded to 10 digits: the largest relative change is "),
        "{}",
        told(&run)
    );
}
