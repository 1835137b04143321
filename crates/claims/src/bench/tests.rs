//! Trees of divan, tables, sittings.

use super::{Bench, Sitting, date, divan, machine, table};

/// Trees of divan, with boxes as it prints them for `|`, `+`, `\\` and `-`.
fn boxes(text: &str) -> String {
    text.replace('|', "\u{2502}").replace('+', "\u{251c}").replace('\\', "\u{2570}").replace('-', "\u{2500}")
}

fn told(all: &[Bench]) -> Vec<(&str, f64, f64, u64)> {
    all.iter().map(|own| (own.name.as_str(), own.fastest, own.median, own.samples)).collect()
}

#[test]
fn trees_of_divan_are_read_by_their_depth_and_headings() {
    let text = boxes(
            "Timer precision: 20 ns
scenes            fastest       | slowest       | median        | mean          | samples | iters
+- fast                         |               |               |               |         |
|  +- (Radau, 0.5)  1.5 \u{b5}s        | 2 \u{b5}s          | 1.75 \u{b5}s       | 1.8 \u{b5}s        | 100     | 1600
|  |                max alloc:    |               |               |               |         |
|  \\- 8            12 ns         | 13 ns         | 12.5 ns       | 12 ns         | 10      | 10
+- skipped        (ignored)     |               |               |               |         |
\\- slow           1.2 s         | 1.4 s         | 1.3 s         | 1.3 s         | 5       | 5

other             fastest       | slowest       | median        | mean          | samples | iters
\\- alone          3 ms          | 4 ms          | 3.5 ms        | 3.5 ms        | 7       | 7
",
        );
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let found = divan(&text, "sim/scenes");
    let wanted = [
        ("sim/scenes/fast/(Radau, 0.5)", 1.5e-6, 1.75e-6, 100),
        ("sim/scenes/fast/8", 12e-9, 12.5e-9, 10),
        ("sim/scenes/slow", 1.2, 1.3, 5),
        ("sim/scenes/alone", 3e-3, 3.5e-3, 7),
    ];
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (own, wanted) in told(&found).iter().zip(wanted) {
        assert!(
            own.0 == wanted.0 && near(own.1, wanted.1) && near(own.2, wanted.2) && own.3 == wanted.3,
            "{own:?}"
        );
    }
}

#[test]
fn tables_are_read_by_their_headings_and_names_may_have_spaces() {
    let text = "run   accuracy fastest_ms median_ms samples steps\nas built  1e-4  10.0 12.5 5 99\nrigid 1e-4 1 2 5 9\n";
    let found = table(text, "girderway/crane");
    assert_eq!(
        told(&found),
        [("girderway/crane/as built", 0.01, 0.0125, 5), ("girderway/crane/rigid", 1e-3, 2e-3, 5)]
    );
    assert!(table("no table at all\n1 2 3\n", "x").is_empty());
    assert!(divan("running 0 tests\n", "x").is_empty());
}

#[test]
fn a_sitting_is_read_as_it_was_written() {
    let known = Some(super::Known { value: 2e-6, source: "elsewhere".to_owned() });
    let bench = Bench { name: "a/b/c".to_owned(), fastest: 1e-6, median: 2.5e-6, samples: 3, known };
    let own = Sitting {
        date: date(20_778),
        machine: machine("model name : Some\n", "0.5 1", 2),
        seconds: 12.0,
        benches: vec![bench.clone(), Bench { known: None, ..bench }],
    };
    assert_eq!(
        (own.date.as_str(), own.machine.as_str()),
        ("2026-11-21", "Some, 2 cores, load 0.5 at the start")
    );
    assert_eq!(serde_json::from_str::<Sitting>(&own.text()).expect("JSON"), own);
}

#[test]
fn days_are_those_of_the_calendar() {
    for (days, text) in
        [(0, "1970-01-01"), (59, "1970-03-01"), (11_016, "2000-02-29"), (19_782, "2024-02-29")]
    {
        assert_eq!(date(days), text);
    }
}
