//! Models of other programs become beam specs that give the numbers those programs give.

mod bdf;
mod cards;
mod damage;
mod inp;
mod modes;
mod msh;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use formats::spec::{Form, FrameSpec, Spec};
use formats::text::diagnostic::Diagnostic;
use formats::text::source::Source;
use formats::units::{Force, Length};
use import::{ImportOptions, Imported, import};
use nalgebra::DVector;
use serde_json::Value;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/import")
}

fn text(name: &str) -> String {
    std::fs::read_to_string(folder().join(name)).expect("a file of the tests")
}

/// Options in metres and newtons.
fn plain() -> ImportOptions {
    ImportOptions {
        length: Some(Length::Metre),
        force: Some(Force::Newton),
        ..ImportOptions::default()
    }
}

/// Files in memory, read by name.
fn from_memory(
    main: &str,
    files: &[(&str, &str)],
    options: &ImportOptions,
) -> Result<Imported, Vec<Diagnostic>> {
    let files: BTreeMap<&Path, &str> = files
        .iter()
        .map(|(name, text)| (Path::new(*name), *text))
        .collect();
    let open = |path: &Path| {
        files
            .get(path)
            .map(|text| text.as_bytes().to_vec())
            .ok_or_else(|| io::ErrorKind::NotFound.into())
    };
    import(Path::new(main), &open, options)
}

/// One deck in memory.
fn deck(text: &str, options: &ImportOptions) -> Result<Imported, Vec<Diagnostic>> {
    from_memory("deck.bdf", &[("deck.bdf", text)], options)
}

fn json(imported: &Imported) -> Value {
    serde_json::from_str(&imported.text).expect("JSON")
}

fn told(wrong: &[Diagnostic]) -> String {
    wrong.iter().map(|wrong| format!("{wrong}\n")).collect()
}

/// The frame of the spec that was written, as `girderway fea` reads it.
fn frame(imported: &Imported) -> FrameSpec {
    let source = Source {
        name: "spec.json".to_owned(),
        text: imported.text.clone(),
    };
    let spec = Spec::read(&source, None).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    match spec.form {
        Form::Frame(frame) => frame,
        Form::Girder(_) => panic!("a girder"),
    }
}

/// Displacements of points under a load on the first of them; points by the names of their sets.
fn displacements(frame: &FrameSpec, points: &[&str], load: [f64; 6]) -> DVector<f64> {
    let index = |name: &&str| {
        let set = frame
            .point_sets
            .iter()
            .find(|(known, _)| known == name)
            .expect("a set");
        set.1[0]
    };
    let points: Vec<usize> = points.iter().map(index).collect();
    let (compliance, _) =
        fea::point_compliance(&frame.model, &points).expect("a structure that stands");
    compliance.columns(0, 6) * DVector::from_row_slice(&load)
}
