//! Tables of benchmarks, from `docs/benchmarks.json`, of steps by wheels, and frames.

use crate::bench::{Bench, Sitting};
use crate::number::{number, time};

/// When and where they were run.
pub fn sitting(own: &Sitting) -> String {
    format!(
        "Sitting of {}: {}; {} benchmarks in {} s, release build, one thread.",
        own.date,
        own.machine,
        own.benches.len(),
        number(own.seconds, 2)
    )
}

/// Tables of the benchmarks of a program, one a function.
pub fn tables(own: &Sitting, program: &str) -> String {
    let within = |bench: &&Bench| bench.name.strip_prefix(program).is_some_and(|rest| rest.starts_with('/'));
    let all: Vec<&Bench> = own.benches.iter().filter(within).collect();
    let rest = |bench: &Bench| bench.name[program.len() + 1..].to_owned();
    let mut out = String::new();
    let mut singles = Vec::new();
    for group in all.chunk_by(|a, b| rest(a).split('/').next() == rest(b).split('/').next()) {
        match grid(group, &rest) {
            Some(table) => out += &table,
            None => singles.extend(group.iter().copied()),
        }
    }
    if singles.is_empty() { out } else { rows(&singles, &rest) + "\n" + &out }
}

/// A benchmark a row.
fn rows(all: &[&Bench], rest: &impl Fn(&Bench) -> String) -> String {
    let is_known = all.iter().any(|own| own.known.is_some());
    let mut out = "| benchmark | fastest | median | samples |".to_owned();
    out += if is_known {
        " known | median by known | source |\n|---|---|---|---|---|---|---|\n"
    } else {
        "\n|---|---|---|---|\n"
    };
    for own in all {
        out += &format!("| {} | {} | {} | {} |", rest(own), time(own.fastest), time(own.median), own.samples);
        if let Some(known) = &own.known {
            let by = number(own.median / known.value, 2);
            out += &format!(" {} | {by} | {} |", time(known.value), known.source);
        } else if is_known {
            out += " | | |";
        }
        out.push('\n');
    }
    out
}

/// A function with two arguments, one of them a count: shortest samples by it.
fn grid(all: &[&Bench], rest: &impl Fn(&Bench) -> String) -> Option<String> {
    let mut entries = Vec::new();
    for own in all {
        let path = rest(own);
        let [function, a, b] = path.split('/').collect::<Vec<_>>()[..] else { return None };
        // the count is either the one or the other
        let (row, column) = match (a.parse::<u64>(), b.parse::<u64>()) {
            (Err(_), Ok(column)) => (a, column),
            (Ok(column), Err(_)) => (b, column),
            _ => return None,
        };
        entries.push((function.to_owned(), row.to_owned(), column, *own));
    }
    let (mut lines, mut columns) = (Vec::new(), Vec::new());
    for (_, row, column, _) in &entries {
        if !lines.contains(row) {
            lines.push(row.clone());
        }
        if !columns.contains(column) {
            columns.push(*column);
        }
    }
    let mut out = format!("| {}, fastest |", entries.first()?.0);
    columns.iter().for_each(|column| out += &format!(" {column} |"));
    out += &format!("\n|---|{}\n", "---|".repeat(columns.len()));
    for line in lines {
        out += &format!("| {line} |");
        for column in &columns {
            let own = entries.iter().find(|own| own.1 == line && own.2 == *column).map(|own| own.3);
            let known = own.and_then(|own| own.known.as_ref());
            let known =
                known.map_or_else(String::new, |own| format!(" ({}: {})", own.source, time(own.value)));
            out += &format!(" {}{known} |", own.map_or_else(String::new, |own| time(own.fastest)));
        }
        out.push('\n');
    }
    Some(out + "\n")
}

#[cfg(test)]
mod tests {
    use super::{sitting, tables};
    use crate::bench::{Bench, Known, Sitting};

    fn bench(name: &str, median: f64, known: Option<f64>) -> Bench {
        let known = known.map(|value| Known { value, source: "elsewhere".to_owned() });
        Bench { name: name.to_owned(), fastest: 0.5 * median, median, samples: 9, known }
    }

    fn of(benches: Vec<Bench>) -> Sitting {
        Sitting { date: "2026-11-22".to_owned(), machine: "a machine".to_owned(), seconds: 61.0, benches }
    }

    #[test]
    fn functions_of_two_arguments_are_tables_by_the_count_and_known_times_stand_beside() {
        let own = of(vec![
            bench("p/q/fill/2/Exact", 1e-7, None),
            bench("p/q/fill/2/Akispl", 2e-7, Some(3e-7)),
            bench("p/q/fill/8/Exact", 4e-7, None),
            bench("p/q/alone", 1e-3, Some(2e-3)),
            bench("p/quite/another", 1.0, None),
        ]);
        assert_eq!(
            tables(&own, "p/q"),
            "| benchmark | fastest | median | samples | known | median by known | source |\n|---|---|---|---|---|---|---|\n\
             | alone | 500 us | 1.00 ms | 9 | 2.00 ms | 0.50 | elsewhere |\n\n\
             | fill, fastest | 2 | 8 |\n|---|---|---|\n| Exact | 50.0 ns | 200 ns |\n| Akispl | 100 ns (elsewhere: 300 ns) |  |\n\n"
        );
        assert!(sitting(&own).contains("5 benchmarks in 61 s"), "{}", sitting(&own));
    }

    #[test]
    fn times_that_nobody_knows_have_no_columns() {
        let own = of(vec![bench("p/q/a/(Radau, 0.5)", 2e-6, None)]);
        assert_eq!(
            tables(&own, "p/q"),
            "| benchmark | fastest | median | samples |\n|---|---|---|---|\n| a/(Radau, 0.5) | 1.00 us | 2.00 us | 9 |\n\n"
        );
        assert_eq!(tables(&own, "p/r"), "");
    }
}
