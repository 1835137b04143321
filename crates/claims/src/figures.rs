//! Tables of figures, from `docs/claims.json`.

use crate::number::{digits, number, percent};
use crate::record::{Record, Verdict};

/// Kinds of sources: what a kind is called, and words that tell it.
const KINDS: [(&str, &[&str]); 5] = [
    (
        "analytic: closed forms, series, derivations that share no code with ours",
        &[
            "closed form",
            "force method",
            "theory",
            "symmetry",
            "virtual work",
            "rayleigh",
            "series",
            "analytic",
            "by hand",
        ],
    ),
    ("published: in print or in a manual", &["published", "printed", "manual", "nafems", "standard"]),
    ("external: a prototype of others for this mechanics", &["prototype"]),
    (
        "external: other codes, and equations written out in Python",
        &["scipy", "numba", "exudyn", "opensees", "pynite", "scikit-fem", "diffsol", "numpy", ".py"],
    ),
    ("converged: finer steps or meshes, another method", &["converged", "finer"]),
];

/// Kind of a source; itself where no word tells one.
fn kind(source: &str) -> &str {
    let lower = source.to_lowercase();
    let known = KINDS.iter().find(|(_, words)| words.iter().any(|word| lower.contains(word)));
    known.map_or(source, |(kind, _)| kind)
}

fn count(records: &[&Record], verdict: Verdict) -> usize {
    records.iter().filter(|own| own.verdict == verdict).count()
}

/// How many figures there are against what kinds of sources, and how they stand.
pub fn summary(records: &[Record]) -> String {
    let mut kinds: Vec<&str> = KINDS.iter().map(|(kind, _)| *kind).collect();
    for own in records {
        if !kinds.contains(&kind(&own.source)) {
            kinds.push(kind(&own.source));
        }
    }
    let mut out =
        "| against | figures | met | not exceeded | not met, with why |\n|---|---|---|---|---|\n".to_owned();
    let row = |name: &str, own: &[&Record]| {
        let [met, below, corrected] =
            [Verdict::Met, Verdict::Below, Verdict::Corrected].map(|verdict| count(own, verdict));
        format!("| {name} | {} | {met} | {below} | {corrected} |\n", own.len())
    };
    for name in kinds {
        let own: Vec<&Record> = records.iter().filter(|own| kind(&own.source) == name).collect();
        if !own.is_empty() {
            out += &row(name, &own);
        }
    }
    out + &row("all", &records.iter().collect::<Vec<_>>())
}

/// A table a test, by sections.
pub fn tables(records: &[Record]) -> String {
    let mut out = String::new();
    let mut sections: Vec<&str> = records.iter().map(|own| own.section.as_str()).collect();
    sections.dedup();
    for section in sections {
        let own: Vec<&Record> = records.iter().filter(|own| own.section == section).collect();
        out += &format!("\n### {section}\n");
        for own in own.chunk_by(|a, b| (&a.file, &a.test) == (&b.file, &b.test)) {
            out += &format!("\n`{}` in `{}`\n\n", own[0].test, own[0].file);
            out += "| figure | source | known | ours | deviation |\n|---|---|---|---|---|\n";
            own.iter().for_each(|record| out += &row(record));
            out += &notes(own);
        }
    }
    out
}

/// Why figures of a test are not met: a line a reason.
fn notes(own: &[&Record]) -> String {
    let mut seen: Vec<&str> = Vec::new();
    for record in own.iter().filter(|own| own.verdict == Verdict::Corrected) {
        if !seen.contains(&record.why.as_str()) {
            seen.push(&record.why);
        }
    }
    seen.iter().map(|why| format!("\nNot met: {why}.\n")).collect()
}

fn row(own: &Record) -> String {
    let known = digits(own.known);
    let value = match own.verdict {
        Verdict::Below => number(own.ours, 2),
        // one digit more than was known, as many as a small difference needs
        _ => number(own.ours, (known + 1).max(3)),
    };
    let deviation = match own.verdict {
        Verdict::Below => "not above".to_owned(),
        Verdict::Met => percent(own.ours / own.known - 1.0),
        Verdict::Corrected if own.known == 0.0 => "**not met**".to_owned(),
        Verdict::Corrected => format!("**{}**", percent(own.ours / own.known - 1.0)),
    };
    let known = if own.verdict == Verdict::Below {
        format!("at most {}", number(own.known, known))
    } else {
        number(own.known, known)
    };
    format!("| {} | {} | {known} | {value} | {deviation} |\n", own.what, own.source)
}

#[cfg(test)]
mod tests {
    use super::{summary, tables};
    use crate::record::{Record, Verdict};

    fn record(source: &str, verdict: Verdict) -> Record {
        Record {
            section: "1 One".to_owned(),
            what: "w, ft".to_owned(),
            known: 2.0,
            source: source.to_owned(),
            ours: 2.5,
            within: 0.3,
            verdict,
            why: if verdict == Verdict::Corrected { "counted".to_owned() } else { String::new() },
            file: "f.rs".to_owned(),
            test: "t".to_owned(),
        }
    }

    #[test]
    fn sources_are_counted_by_their_kinds_and_unknown_ones_by_name() {
        let all = [
            record("Closed form", Verdict::Below),
            record("prototype", Verdict::Corrected),
            record("fea/some.py", Verdict::Met),
            record("hearsay", Verdict::Met),
        ];
        let told = summary(&all);
        let row =
            |begin: &str, end: &str| told.lines().any(|line| line.starts_with(begin) && line.ends_with(end));
        assert!(
            row("| analytic", "| 1 | 0 | 1 | 0 |") && row("| external: a prototype", "| 1 | 0 | 0 | 1 |"),
            "{told}"
        );
        assert!(
            row("| external: other", "| 1 | 1 | 0 | 0 |") && row("| hearsay", "| 1 | 1 | 0 | 0 |"),
            "{told}"
        );
        assert!(row("| all", "| 4 | 2 | 1 | 1 |"), "{told}");
    }

    #[test]
    fn figures_that_are_not_met_are_bold_and_say_why() {
        let told = tables(&[record("prototype", Verdict::Corrected)]);
        assert!(told.contains("| **+25 %** |") && told.contains("Not met: counted."), "{told}");
    }
}
