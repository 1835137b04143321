//! Typos that an editor with the schema notices: files with one mistake in a key or a value, of which the schemas alone
//! find nearly all.
//!
//! A mistake counts where it is one: where the reader of the format refuses the file, or where a summary, which has no
//! reader, would be another one. With `GIRDERWAY_TYPOS=FILE` the files and the verdicts go to that file, a line each, and
//! `tests/schema/second.py` compares them with those of another validator.

use std::fs;
use std::io::Write;
use std::path::Path;

use formats::scene::Document;
use formats::spec::Spec;
use formats::text::source::Source;
use serde_json::{Value, json};

use super::schema::schema;
use super::{example, folder, girderway, json, path, text};

/// Share of mistakes that the schemas find, together and that of each format alone.
const SHARE: f64 = 0.95;
/// The same without names of the user's own: those below the keys [`OWN_NAMES`].
const SHARE_WITHOUT_NAMES: f64 = 0.96;
/// Keys of inputs whose members the user names. Another name there is a mistake because another place of the file has
/// the first one, which no schema can express.
const OWN_NAMES: [&str; 6] = ["structures", "bodies", "wheels", "spans", "factors", "axes"];
/// Every so many mistakes that a schema finds, one is given to the reader, which must refuse it too.
const SAMPLE: usize = 40;
/// Keys whose strings are keywords; other strings are names.
const KEYWORDS: [&str; 37] = [
    "format",
    "force",
    "time",
    "theory",
    "kind",
    "type",
    "dof",
    "fix",
    "foundation",
    "reading",
    "couplings",
    "measure",
    "handover",
    "analysis",
    "stepper",
    "direction",
    "law",
    "damper",
    "side",
    "signs",
    "order",
    "component",
    "class",
    "s_class",
    "building_class",
    "hoisting",
    "drives",
    "guide",
    "lateral_section",
    "rail_fastening",
    "operation",
    "history",
    "status",
    "plane",
    "code",
    "sampling",
    "results",
];

/// Keys of summaries whose members are named by the scene: another name there is another scene, not a mistake.
const NAMED: [&str; 12] = [
    "wheels",
    "units",
    "foundation",
    "peaks",
    "dead_load",
    "envelopes",
    "bodies",
    "compare",
    "comparison",
    "factors",
    "positions",
    "signs",
];

/// A step from a value to one below it.
#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Index(usize),
}

/// A file with one mistake: what was done, whether it is to a name of the user's own, and the file.
struct Typo {
    what: String,
    is_own_name: bool,
    file: Value,
}

/// Places of all values below `value`, with the last key on the way; of long lists only the first three.
fn places(value: &Value, path: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    match value {
        Value::Object(members) => {
            for (key, member) in members {
                path.push(Step::Key(key.clone()));
                found.push(path.clone());
                places(member, path, found);
                path.pop();
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate().take(3) {
                path.push(Step::Index(index));
                found.push(path.clone());
                places(item, path, found);
                path.pop();
            }
        }
        _ => {}
    }
}

fn at<'v>(file: &'v mut Value, path: &[Step]) -> &'v mut Value {
    path.iter().fold(file, |value, step| match step {
        Step::Key(key) => value.get_mut(key).expect("a member"),
        Step::Index(index) => value.get_mut(index).expect("an item"),
    })
}

/// Wrong spellings of a key or keyword: a letter left out, two exchanged, one doubled, one replaced, other case.
fn spellings(word: &str) -> Vec<String> {
    let letters: Vec<char> = word.chars().collect();
    let middle = letters.len() / 2;
    let text = |letters: &[char]| letters.iter().collect::<String>();
    let mut all = Vec::new();
    if letters.len() > 1 {
        let mut left_out = letters.clone();
        left_out.remove(middle);
        let mut exchanged = letters.clone();
        exchanged.swap(middle - 1, middle);
        all.extend([text(&left_out), text(&exchanged)]);
    }
    let (mut doubled, mut replaced) = (letters.clone(), letters.clone());
    doubled.insert(middle, letters[middle]);
    replaced[middle] = if letters[middle] == 'q' { 'w' } else { 'q' };
    let case = |c: &char| {
        if c.is_lowercase() {
            c.to_ascii_uppercase()
        } else {
            c.to_ascii_lowercase()
        }
    };
    let other: String = letters
        .iter()
        .take(1)
        .map(case)
        .chain(letters.iter().skip(1).copied())
        .collect();
    all.extend([text(&doubled), text(&replaced), other]);
    all.retain(|one| one != word);
    all
}

/// Wrong values in place of one at a key: another type, a keyword misspelt, the other sign, a pair of brackets missing
/// or too many.
fn values(value: &Value, key: &str) -> Vec<Value> {
    let mut all = vec![json!([value])];
    match value {
        Value::Number(number) => {
            all.push(json!(number.to_string()));
            if number.as_f64().is_some_and(|number| number > 0.0) {
                all.push(match number.as_i64() {
                    Some(whole) => json!(-whole),
                    None => json!(-number.as_f64().unwrap_or(1.0)),
                });
            }
        }
        Value::String(word) => {
            all.push(json!(3));
            if KEYWORDS.contains(&key) && !word.is_empty() {
                all.extend(spellings(word).into_iter().map(Value::from));
            }
        }
        Value::Bool(is) => all.extend([json!(is.to_string()), json!(i32::from(*is))]),
        Value::Array(items) => {
            all.extend(items.first().cloned());
            all.push(json!("text"));
        }
        Value::Object(_) => all.push(json!("text")),
        Value::Null => {}
    }
    all.retain(|other| other != value);
    all
}

/// A mistake at a place: another key, or another value.
enum Mistake {
    Key(String),
    Value(Value),
}

/// The value at a place.
fn seen<'v>(file: &'v Value, path: &[Step]) -> &'v Value {
    path.iter().fold(file, |value, step| match step {
        Step::Key(key) => &value[key],
        Step::Index(index) => &value[index],
    })
}

/// Files with one mistake, `most` or a few less of all that are possible, spread evenly; of an output, whose numbers may
/// have any sign, without those of a name of the scene or of a sign.
fn typos(file: &Value, is_output: bool, most: usize) -> Vec<Typo> {
    let mut paths = Vec::new();
    places(file, &mut Vec::new(), &mut paths);
    let mut all = Vec::new();
    for path in &paths {
        let (last, before) = path.split_last().expect("places are below the root");
        let key_of = |steps: &[Step]| {
            steps.iter().rev().find_map(|step| match step {
                Step::Key(key) => Some(key.clone()),
                Step::Index(_) => None,
            })
        };
        let is_name =
            is_output && key_of(before).is_some_and(|above| NAMED.contains(&above.as_str()));
        if let (Step::Key(word), false) = (last, is_name) {
            let taken = seen(file, before).as_object().expect("an object has keys");
            let free = spellings(word)
                .into_iter()
                .filter(|wrong| !taken.contains_key(wrong));
            all.extend(free.map(|wrong| (path, Mistake::Key(wrong))));
        }
        let (old, key) = (seen(file, path), key_of(path).unwrap_or_default());
        let is_free =
            |wrong: &Value| is_output && key != "time" && old.is_number() && wrong.is_number();
        let wrong = values(old, &key)
            .into_iter()
            .filter(|wrong| !is_free(wrong));
        all.extend(wrong.map(|wrong| (path, Mistake::Value(wrong))));
    }
    let every = all.len().div_ceil(most);
    all.into_iter()
        .step_by(every)
        .map(|(path, mistake)| made(file, path, mistake))
        .collect()
}

/// The file with a mistake at a place.
fn made(file: &Value, path: &[Step], mistake: Mistake) -> Typo {
    let words = path.iter().map(|step| match step {
        Step::Key(key) => key.clone(),
        Step::Index(index) => index.to_string(),
    });
    let place = words.collect::<Vec<_>>().join(".");
    let mut changed = file.clone();
    let mut is_own_name = false;
    let what = match (mistake, path.split_last()) {
        (Mistake::Key(wrong), Some((Step::Key(word), before))) => {
            is_own_name = matches!(before.last(), Some(Step::Key(above)) if OWN_NAMES.contains(&above.as_str()));
            let object = at(&mut changed, before)
                .as_object_mut()
                .expect("an object has keys");
            let member = object.remove(word).expect("a member");
            let what = format!("key {place} => {wrong}");
            object.insert(wrong, member);
            what
        }
        (Mistake::Key(wrong), _) => panic!("{place} is no key, which cannot be {wrong}"),
        (Mistake::Value(wrong), _) => {
            let shown = wrong.to_string().chars().take(40).collect::<String>();
            *at(&mut changed, path) = wrong;
            format!("value {place} => {shown}")
        }
    };
    Typo {
        what,
        is_own_name,
        file: changed,
    }
}

/// What the reader of the format says to a file beside `path`; `None` where it accepts it or there is no reader.
fn refusal(format: &str, path: &Path, file: &Value) -> Option<String> {
    let text = file.to_string();
    let first = |diagnostics: Vec<formats::text::diagnostic::Diagnostic>| {
        diagnostics
            .first()
            .map_or_else(|| "refused".to_owned(), |one| format!("{one:?}"))
    };
    match format {
        "beam" => {
            let source = Source::from_bytes("spec.json", text.into_bytes()).expect("JSON");
            Spec::read(&source, None).err().map(first)
        }
        "summary" | "design-summary" => Some("another summary".to_owned()),
        _ => {
            let changed = path.with_file_name("changed.json");
            fs::write(&changed, text).expect("written");
            match format {
                "scene" => Document::open(&changed).err().map(first),
                "sweep" => formats::sweep::Sweep::open(&changed).err().map(first),
                _ => formats::design::Design::open(&changed).err().map(first),
            }
        }
    }
}

/// Folders whose files are taken, and summaries of runs and designs of them.
fn files(work: &tempfile::TempDir) -> Vec<(&'static str, std::path::PathBuf)> {
    let mut all = Vec::new();
    for origin in [
        "bogie",
        "runway",
        "bridge_crane",
        "mill_girderway",
        "ties",
        "wheel",
        "yang_yau",
    ] {
        let target = work.path().join(origin);
        fs::create_dir(&target).expect("a new folder");
        let mut names: Vec<_> = fs::read_dir(example(origin))
            .expect("an example")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.is_file())
            .collect();
        names.sort();
        for path in names {
            let copy = target.join(path.file_name().expect("a name"));
            fs::copy(&path, &copy).expect("copied");
            if copy.extension().is_some_and(|ending| ending == "json") {
                let value = json(&fs::read(&copy).expect("a file"));
                match value["format"].as_str() {
                    Some("girderway-beam/1") => all.push(("beam", copy)),
                    Some("girderway-scene/1") => all.push(("scene", copy)),
                    Some("girderway-design/1") => all.push(("design", copy)),
                    Some("girderway-sweep/1") => all.push(("sweep", copy)),
                    _ => {}
                }
            }
        }
    }
    for (command, file, format, out) in [
        ("run", "bogie/fast.json", "summary", "fast"),
        ("run", "runway/scene.json", "summary", "plain"),
        ("design", "runway/design.json", "design-summary", "design"),
    ] {
        let file = example(file);
        let run = girderway(work, &[command, path(&file), "-o", out, "--quiet"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        all.push((format, work.path().join(out).join("summary.json")));
    }
    all
}

#[test]
fn schemas_alone_find_nearly_all_typos() {
    let work = folder();
    let mut record =
        std::env::var_os("GIRDERWAY_TYPOS").map(|path| fs::File::create(path).expect("a file"));
    let (mut faults, mut found, mut missed, mut strict) = (0, 0, Vec::new(), Vec::new());
    // found, all, and the same without names of the user's own
    let mut by_format: std::collections::BTreeMap<&str, [usize; 4]> =
        std::collections::BTreeMap::new();
    for (format, path) in files(&work) {
        let schema = schema(format);
        let validator = jsonschema::validator_for(&schema).expect("a valid schema");
        let good = json(&fs::read(&path).expect("a file"));
        assert!(validator.is_valid(&good), "{}", path.display());
        let is_output = format.ends_with("summary");
        assert!(
            is_output || refusal(format, &path, &good).is_none(),
            "{}",
            path.display()
        );
        // of files with thousands of values, a sample tells as much
        let is_short = matches!(format, "design" | "sweep");
        let most = if record.is_some() || is_short {
            1000
        } else {
            60
        };
        let all = typos(&good, is_output, most);
        for (index, typo) in all.into_iter().enumerate() {
            let fits = validator.is_valid(&typo.file);
            if let Some(record) = &mut record {
                let line =
                    json!({ "schema": format, "what": typo.what, "fits": fits, "file": typo.file });
                writeln!(record, "{line}").expect("written");
            }
            let why = if fits || index % SAMPLE == 0 {
                refusal(format, &path, &typo.file)
            } else {
                Some(String::new())
            };
            let what = || {
                format!(
                    "{} {}",
                    path.file_name().unwrap_or_default().to_string_lossy(),
                    typo.what
                )
            };
            match (fits, why) {
                (true, None) => {}
                (false, None) => strict.push(what()),
                (is_missed, Some(why)) => {
                    faults += 1;
                    found += usize::from(!is_missed);
                    let counts = by_format.entry(format).or_default();
                    let is_found = usize::from(!is_missed);
                    let counted = usize::from(!typo.is_own_name);
                    for (count, more) in
                        counts
                            .iter_mut()
                            .zip([is_found, 1, is_found * counted, counted])
                    {
                        *count += more;
                    }
                    if is_missed {
                        missed.push(format!("{} {}: {why}", format, what()));
                    }
                }
            }
        }
    }
    let share = found as f64 / faults as f64;
    println!(
        "{found} of {faults} mistakes found by the schemas alone: {:.2} %; {by_format:?}",
        100.0 * share
    );
    for one in &missed {
        println!("missed: {one}");
    }
    assert!(
        strict.is_empty(),
        "the schema refuses what the reader accepts: {strict:?}"
    );
    assert!(faults > 1000, "{faults}");
    assert!(share >= SHARE, "{share}: {missed:?}");
    // what remains are names that a file uses elsewhere, and numbers that are wrong only beside others
    for (format, [found, all, found_besides_names, besides_names]) in by_format {
        let share = |part: usize, whole: usize| part as f64 / whole as f64;
        assert!(share(found, all) >= SHARE, "{format}: {found} of {all}");
        let besides = share(found_besides_names, besides_names);
        assert!(
            besides >= SHARE_WITHOUT_NAMES,
            "{format}: {found_besides_names} of {besides_names}"
        );
    }
}
