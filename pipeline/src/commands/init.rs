//! `girderway init`: starter files that run as they are, with the schemas by which editors complete and check them.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::cli::{Global, InitArgs, Starter};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::schema;
use formats::text::diagnostic::Diagnostic;
use outputs::files;
use outputs::files::json as json_text;
use outputs::folder::check_path;

/// Folder of the schemas, in that of the files.
const SCHEMAS: &str = "schema";

/// Names and contents of files; the scene is the first.
type Files = &'static [(&'static str, &'static str)];

macro_rules! files {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../examples/", $folder, "/", $name)))),+]
    };
}

const BOGIE: Files = files!("bogie": "scene.json", "spec.json", "printed.adm", "sweep.json");
const GIRDERWAY: Files = files!("mill_girderway": "scene.json", "spec.json", "design.json", "scatter.json", "sweep.json");
const CRANE: Files = files!(
    "bridge_crane":
    "scene.json", "aisle.json", "girders.json", "emergency.json", "lifting.json", "drop.json", "buffer.json", "skew.json",
    "two_cranes.json", "sweep.json",
);

const RUNWAY: Files = files!("runway": "scene.json", "spec.json", "design.json", "sweep.json");

const fn files(starter: Starter) -> Files {
    match starter {
        Starter::Bogie => BOGIE,
        Starter::Crane => CRANE,
        Starter::Girderway => GIRDERWAY,
        Starter::Runway => RUNWAY,
    }
}

/// Writes the files into the named folder. If any of them exists already, none is written.
///
/// # Errors
/// A file exists already, or the folder or a file cannot be written.
pub fn run(args: &InitArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let folder = args.folder.clone().unwrap_or_else(|| PathBuf::from("."));
    // a folder that cannot be created is reported before any file is written
    check_path(&folder)?;
    let files: Vec<(PathBuf, String)> = (files(args.what).iter())
        .map(|(name, text)| (place(&folder, name), with_schema(text)))
        .chain(
            schemas()
                .into_iter()
                .map(|(name, text)| (place(&folder, &format!("{SCHEMAS}/{name}")), text)),
        )
        .collect();
    let taken: Vec<Diagnostic> = files
        .iter()
        .filter(|(path, _)| path.symlink_metadata().is_ok())
        .map(|(path, _)| Diagnostic {
            hint: Some("nothing is overwritten: name another folder, or move the file".to_owned()),
            ..Diagnostic::of_file(path.display().to_string(), "exists already")
        })
        .collect();
    if !taken.is_empty() {
        return Err(taken.into());
    }
    files::make(&folder.join(SCHEMAS))?;
    for (path, text) in &files {
        files::write_new(path, text.as_bytes())?;
        progress.say(&format!("wrote {}", path.display()));
    }
    let scene = files[0].0.display().to_string();
    let other = |name: &str| {
        files
            .iter()
            .map(|(path, _)| path)
            .find(|path| path.ends_with(name))
    };
    progress.say(&format!("next: girderway run {scene}"));
    for (command, name) in [("design", "design.json"), ("sweep", "sweep.json")] {
        if let Some(path) = other(name).filter(|path| !path.ends_with(format!("{SCHEMAS}/{name}")))
        {
            progress.say(&format!("      girderway {command} {}", path.display()));
        }
    }
    if global.json {
        let names: Vec<String> = files
            .iter()
            .map(|(path, _)| path.display().to_string())
            .collect();
        output::print(&json_text(&json!({ "scene": scene, "files": names })))?;
    }
    Ok(Exit::Done)
}

/// Names and contents of the schemas.
fn schemas() -> Vec<(&'static str, String)> {
    let all = [
        ("beam.json", schema::beam()),
        ("scene.json", schema::scene()),
        ("design.json", schema::design()),
        ("sweep.json", schema::sweep()),
    ];
    all.into_iter()
        .map(|(name, schema)| (name, json_text(&schema)))
        .collect()
}

/// A file with the path of its schema as its first member; a file without a schema as it is.
fn with_schema(text: &str) -> String {
    let formats = [
        ("girderway-beam/", "beam"),
        ("girderway-scene/", "scene"),
        ("girderway-design/", "design"),
        ("girderway-sweep/", "sweep"),
    ];
    let own = formats
        .iter()
        .find(|(format, _)| text.contains(&format!("\"{format}")));
    match (own, text.strip_prefix('{')) {
        (Some((_, name)), Some(rest)) => {
            let space = if rest.starts_with('\n') { "\n  " } else { "" };
            let next = if rest.starts_with('\n') { "," } else { ",\n " };
            format!("{{{space}\"$schema\": \"{SCHEMAS}/{name}.json\"{next}{rest}")
        }
        _ => text.to_owned(),
    }
}

/// Path of a file in a folder, without a leading `./`.
fn place(folder: &Path, name: &str) -> PathBuf {
    if folder == Path::new(".") {
        PathBuf::from(name)
    } else {
        folder.join(name)
    }
}
