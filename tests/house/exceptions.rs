//! Lists of known exceptions: they may shrink, never grow.
//!
//! `exceptions.txt` has a line `kind  name  reason` each, separated by tabs. A fault that is not listed fails its test,
//! and so does a listed one that is no longer there. `HOUSE=tidy cargo test --test house` takes out the lines that are no
//! longer needed; nothing adds one.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;

static FILE: Mutex<()> = Mutex::new(());

fn path() -> PathBuf {
    super::crates::root().join("tests/house/exceptions.txt")
}

/// Holds the faults found against the exceptions of one kind.
pub fn hold(kind: &str, found: &BTreeSet<String>) {
    let _one_at_a_time = FILE.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let text = fs::read_to_string(path()).expect("tests/house/exceptions.txt");
    let fields = |line: &str| -> Option<String> {
        let mut fields = line.split('\t');
        (fields.next() == Some(kind)).then(|| {
            fields
                .next()
                .expect("kind, name, reason, between tabs")
                .to_owned()
        })
    };
    let listed: BTreeSet<String> = text.lines().filter_map(fields).collect();
    for line in text
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
    {
        assert_eq!(
            line.split('\t').count(),
            3,
            "exceptions.txt: kind, name, reason, between tabs: {line}"
        );
    }
    let fresh: Vec<&String> = found.difference(&listed).collect();
    assert!(
        fresh.is_empty(),
        "{kind}: not allowed, and not in exceptions.txt:\n{}",
        lines(&fresh)
    );
    let stale: Vec<&String> = listed.difference(found).collect();
    if std::env::var("HOUSE").is_ok_and(|word| word == "tidy") && !stale.is_empty() {
        let kept = text
            .lines()
            .filter(|line| fields(line).is_none_or(|name| found.contains(&name)));
        let kept: String = kept.map(|line| format!("{line}\n")).collect();
        fs::write(path(), kept).expect("a writable exceptions.txt");
        return;
    }
    assert!(
        stale.is_empty(),
        "{kind}: no longer there, take the lines out of exceptions.txt (HOUSE=tidy does):\n{}",
        lines(&stale)
    );
}

fn lines(names: &[&String]) -> String {
    names.iter().map(|name| format!("  {name}\n")).collect()
}
