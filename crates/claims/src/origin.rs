//! Where generated parts come from.

use std::path::Path;

use crate::error::Error;
use crate::file;

/// Parts of one kind, the data they are made from, and how those are made.
struct Origin {
    /// First word of the parts' names, up to a dash.
    kind: &'static str,
    what: &'static str,
    data: &'static str,
    commands: &'static [&'static str],
    time: &'static str,
}

const ALL: [Origin; 8] = [
    Origin {
        kind: "figures",
        what: "figures of others beside ours",
        data: "docs/claims.json",
        commands: &["cargo run -p claims -- figures"],
        time: "2 minutes, and the build of the tests that hold them",
    },
    Origin {
        kind: "tests",
        what: "lists of tests",
        data: "the tests' source",
        commands: &["cargo run -p claims"],
        time: "1 s",
    },
    Origin {
        kind: "maps",
        what: "maps of where methods fail",
        data: "docs/studies/stability.json",
        commands: &[
            "girderway study examples/bogie/scene.json --stability -o OUT",
            "cargo run -p claims -- stability OUT",
        ],
        time: "11 s",
    },
    Origin {
        kind: "studies",
        what: "charts, fronts, costs of scenes",
        data: "docs/studies",
        commands: &["girderway study SCENE -o OUT", "cargo run -p claims -- study OUT NAME COMMAND"],
        time: "5 seconds to 10 minutes a scene",
    },
    Origin {
        kind: "benches",
        what: "benchmarks",
        data: "docs/benchmarks.json",
        commands: &["cargo run -p claims -- benches"],
        time: "2 minutes, and the release build",
    },
    Origin {
        kind: "peers",
        what: "other codes side by side",
        data: "docs/peers.json",
        commands: &["python fea/bench_peers.py -o docs", "cargo run -p claims"],
        time: "10 minutes",
    },
    Origin {
        kind: "frames",
        what: "frames beside other solvers",
        data: "docs/frames.csv",
        commands: &["python fea/bench_frames.py --csv docs/frames.csv", "cargo run -p claims"],
        time: "10 minutes",
    },
    Origin {
        kind: "wheels",
        what: "time of a step by the number of wheels",
        data: "docs/wheels.csv",
        commands: &[
            "cargo run --release -p sim --example crossings -- wheels > docs/wheels.csv",
            "python fea/wheels_chart.py docs/wheels.csv docs/wheels.svg",
            "cargo run -p claims",
        ],
        time: "1 minute, and the release build",
    },
];

/// Where every kind of generated part comes from, and on which pages it stands.
///
/// # Errors
/// Pages that cannot be read.
pub fn table(root: &Path) -> Result<String, Error> {
    let mut pages = Vec::new();
    for path in file::folder(&root.join("docs"))? {
        if path.extension().is_some_and(|own| own == "md") {
            pages.push((file::name(&path), file::text(&path)?));
        }
    }
    let mut out = "| generated | on | from | by | which takes |\n|---|---|---|---|---|\n".to_owned();
    for own in ALL {
        let mark = format!("<!-- generated: {}", own.kind);
        let on = pages.iter().filter(|(_, text)| text.contains(&mark));
        let on: Vec<String> =
            on.map(|(name, _)| format!("[{}]({name})", name.trim_end_matches(".md"))).collect();
        let data = if own.data.contains(' ') { own.data.to_owned() } else { format!("`{}`", own.data) };
        let commands: Vec<String> = own.commands.iter().map(|command| format!("`{command}`")).collect();
        out += &format!(
            "| {} | {} | {data} | {} | {} |\n",
            own.what,
            on.join(", "),
            commands.join("; "),
            own.time
        );
    }
    Ok(out)
}
