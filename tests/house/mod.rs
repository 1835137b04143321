//! The order of the house: what may import what, and what public names mean.
//!
//! Known exceptions stand in `exceptions.txt` (see `exceptions.rs`).

mod crates;
mod exceptions;
mod imports;
mod names;
mod tokens;
mod wings;

use std::collections::{BTreeMap, BTreeSet};

use crates::Crate;
use wings::Wings;

/// Normal dependencies that each crate may have on others of ours, lowest crate first.
const DEPENDENCIES: [(&str, &[&str]); 20] = [
    ("piecewise", &[]),
    ("splines", &[]),
    ("adams", &[]),
    ("practice", &[]),
    ("sections", &[]),
    ("fea", &["splines"]),
    ("sim", &["piecewise", "splines"]),
    ("trains", &["fea", "splines"]),
    (
        "formats",
        &["adams", "fea", "practice", "sections", "sim", "splines"],
    ),
    ("import", &["formats", "fea"]),
    (
        "design",
        &["formats", "trains", "practice", "fea", "splines"],
    ),
    ("foundations", &["formats", "fea", "sim", "splines"]),
    (
        "results",
        &[
            "foundations",
            "design",
            "trains",
            "practice",
            "formats",
            "fea",
            "piecewise",
            "sim",
            "splines",
            "adams",
        ],
    ),
    (
        "deck",
        &[
            "results",
            "adams",
            "foundations",
            "practice",
            "formats",
            "fea",
            "sim",
            "splines",
        ],
    ),
    ("sweep", &["results", "design", "foundations", "formats"]),
    (
        "report",
        &[
            "sweep",
            "design",
            "trains",
            "results",
            "foundations",
            "practice",
            "formats",
            "fea",
            "sim",
            "splines",
            "adams",
        ],
    ),
    (
        "outputs",
        &[
            "report",
            "sweep",
            "results",
            "design",
            "foundations",
            "formats",
            "adams",
        ],
    ),
    (
        "python",
        &[
            "outputs",
            "results",
            "foundations",
            "import",
            "design",
            "formats",
            "fea",
            "sim",
            "splines",
        ],
    ),
    (
        "study",
        &[
            "results",
            "report",
            "foundations",
            "practice",
            "formats",
            "fea",
            "sim",
            "splines",
            "adams",
        ],
    ),
    (
        "girderway",
        &[
            "sweep",
            "study",
            "outputs",
            "report",
            "deck",
            "design",
            "import",
            "results",
            "foundations",
            "practice",
            "sections",
            "formats",
            "fea",
            "sim",
            "splines",
            "adams",
        ],
    ),
];

/// The crate that reads and writes files, prints, and starts threads as it likes: the command line.
const FREE: [&str; 1] = ["girderway"];

/// The libraries that read files, and those that write them.
const FILES: [&str; 2] = ["formats", "outputs"];

/// Files of a crate from which on it must say the order of its wings.
const MANY_FILES: usize = 13;

fn dotted(path: &[String]) -> String {
    if path.is_empty() {
        "lib".to_owned()
    } else {
        path.join("::")
    }
}

#[test]
fn imports_run_one_way() {
    let mut files = BTreeSet::new();
    let mut modules = BTreeSet::new();
    for krate in crates::all() {
        let arrows = imports::arrows(krate);
        let named = |path: &Vec<String>| format!("{} {}", krate.name, dotted(path));
        files.extend(imports::circles(&arrows).iter().flatten().map(named));
        modules.extend(
            imports::circles(&imports::top_level(&arrows))
                .iter()
                .flatten()
                .map(named),
        );
    }
    exceptions::hold("file in a circle", &files);
    exceptions::hold("module in a circle", &modules);
}

#[test]
fn lower_wings_import_no_higher_one() {
    let mut faults = BTreeSet::new();
    let mut without = BTreeSet::new();
    for krate in crates::all() {
        let Some(wings) = Wings::of(krate) else {
            if krate.modules.len() >= MANY_FILES {
                without.insert(krate.name.clone());
            }
            continue;
        };
        for name in wings.missing(krate) {
            faults.insert(format!(
                "{}: {name} is not among the wings of lib.rs",
                krate.name
            ));
        }
        for name in wings.absent(krate) {
            faults.insert(format!(
                "{}: lib.rs names a wing {name} that does not exist",
                krate.name
            ));
        }
        for (from, targets) in &imports::arrows(krate) {
            for to in targets
                .iter()
                .filter(|to| wings.height(to) > wings.height(from))
            {
                faults.insert(format!(
                    "{}: {} imports {} of a higher wing",
                    krate.name,
                    dotted(from),
                    dotted(to)
                ));
            }
        }
    }
    exceptions::hold("no order of wings", &without);
    exceptions::hold("wing", &faults);
}

#[test]
fn crates_depend_in_one_direction() {
    let table: BTreeMap<&str, &[&str]> = DEPENDENCIES.into_iter().collect();
    let ours: BTreeSet<&str> = crates::all()
        .iter()
        .map(|krate| krate.name.as_str())
        .collect();
    let mut faults = BTreeSet::new();
    for krate in crates::all() {
        let Some(allowed) = table.get(krate.name.as_str()) else {
            faults.insert(format!(
                "{} is not in the table of tests/house/mod.rs",
                krate.name
            ));
            continue;
        };
        for name in krate
            .dependencies()
            .iter()
            .filter(|name| ours.contains(name.as_str()))
        {
            if !allowed.contains(&name.as_str()) {
                faults.insert(format!("{} depends on {name}", krate.name));
            }
        }
    }
    exceptions::hold("dependency", &faults);
}

#[test]
fn the_table_of_dependencies_has_no_circle() {
    for (place, (name, allowed)) in DEPENDENCIES.iter().enumerate() {
        for below in *allowed {
            let known = DEPENDENCIES[..place]
                .iter()
                .any(|(earlier, _)| earlier == below);
            assert!(known, "{name} may depend on {below}, which stands after it");
        }
    }
}

#[test]
fn libraries_read_no_files_print_nothing_and_start_no_threads() {
    let mut faults = BTreeSet::new();
    for krate in crates::all()
        .iter()
        .filter(|krate| !FREE.contains(&krate.name.as_str()))
    {
        let with_threads = effects(krate, &mut faults);
        let allowed = usize::from(krate.name == "results");
        if with_threads.len() > allowed {
            faults.insert(format!(
                "{}: threads in {}",
                krate.name,
                with_threads.join(", ")
            ));
        }
    }
    exceptions::hold("effect", &faults);
}

/// Adds what a library prints and reads to `faults`; returns its modules that start threads.
fn effects(krate: &Crate, faults: &mut BTreeSet<String>) -> Vec<String> {
    let mut with_threads = Vec::new();
    for (module, file) in &krate.modules {
        let name = dotted(module);
        let follows = |first: &str, then: &[&str]| {
            file.tokens
                .windows(1 + then.len())
                .any(|window| window[0] == first && window[1..].iter().eq(then))
        };
        let mut fault = |what: &str| {
            faults.insert(format!("{} {name}: {what}", krate.name));
        };
        for print in ["println", "print", "eprintln", "eprint", "dbg"] {
            if follows(print, &["!"]) {
                fault("prints");
            }
        }
        let reads = follows("fs", &["::"])
            || follows("std", &["::", "fs"])
            || follows("File", &["::", "open"]);
        if !FILES.contains(&krate.name.as_str()) && reads {
            fault("reads files");
        }
        if follows("thread", &["::", "spawn"])
            || follows("thread", &["::", "scope"])
            || follows("thread", &["::", "Builder"])
        {
            with_threads.push(name);
        }
    }
    with_threads
}

#[test]
fn a_public_name_has_one_meaning() {
    let mut places: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for krate in crates::all() {
        for (module, file) in &krate.modules {
            for name in names::public_types(&file.tokens) {
                places.entry(name).or_default().insert(format!(
                    "{}::{}",
                    krate.name,
                    dotted(module)
                ));
            }
        }
    }
    let double: BTreeSet<String> = places
        .iter()
        .filter(|(_, places)| places.len() > 1)
        .map(|(name, _)| name.clone())
        .collect();
    exceptions::hold("name", &double);
}
