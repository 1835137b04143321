//! A scene file with its comparisons: the scene, and one variant of it with the changes of each comparison.

use std::path::Path;

use super::raw::RawScene;
use super::read::{Files, scene};
use super::values::scene::{FORMAT, Scene};
use crate::text::diagnostic::Diagnostic;
use crate::text::examine::examine;
use crate::text::fault::{Basis, Fault, Faults};
use crate::text::inputs::Inputs;
use crate::text::names::check_name;
use crate::text::place::Place;
use crate::text::source::Tree;
use crate::text::tree::{TreeNode, Value};

/// A scene file with its comparisons, read and checked together with all files to which it refers.
///
/// ```
/// use std::path::Path;
///
/// use formats::scene::Document;
///
/// let document = Document::open(Path::new("../../examples/bogie/scene.json")).expect("an example is right");
/// let scene = document.scene();
/// assert_eq!(scene.bodies[0].name, "bogie");
/// assert!(document.cases.iter().skip(1).all(|case| case.label.is_some()));
///
/// let missing = Document::open(Path::new("no.json")).expect_err("there is no such file");
/// assert_eq!(missing[0].to_string(), "no.json: cannot be read: no such file");
/// ```
#[derive(Clone, Debug)]
pub struct Document {
    /// The scene itself, then one case for each entry of `compare`.
    pub cases: Vec<Case>,
    /// All files read.
    pub inputs: Inputs,
}

/// One run of a scene.
#[derive(Clone, Debug)]
pub struct Case {
    /// Label of the comparison; none for the scene itself.
    pub label: Option<String>,
    /// The scene with that comparison's changes.
    pub scene: Scene,
}

impl Document {
    /// Reads a scene, the files to which it refers, and its comparisons.
    ///
    /// # Errors
    /// All faults of all files. If the scene itself has faults, those of comparisons are wrong types and keys, and
    /// values out of range.
    pub fn open(path: &Path) -> Result<Document, Vec<Diagnostic>> {
        let (mut inputs, source) = Inputs::open(path).map_err(|error| vec![*error])?;
        let tree = source.tree();
        let comparisons =
            tree.root().member("compare").map(|member| member.value.items()).unwrap_or_default();
        let mut files = Files::of(&mut inputs);
        let scene = tree.read(FORMAT, |raw: &RawScene, faults| {
            faults.0.extend(tree.duplicates_below("compare").0);
            let scene = scene::read(raw, &source.name, &mut files, faults);
            check_labels(comparisons, faults);
            scene
        });
        let (scene, mut wrong) = scene.map_or_else(|wrong| (None, wrong), |scene| (Some(scene), Vec::new()));
        wrong.append(&mut files.wrong);
        let base = wrong.clone();
        let mut cases: Vec<Case> = scene.map(|scene| Case { label: None, scene }).into_iter().collect();
        for (index, changes) in comparisons.iter().enumerate().filter(|_| tree.is_whole()) {
            // another value has been reported with the labels
            let Value::Object(_) = changes.value else { continue };
            match case(&tree, &source.name, index, changes, &base, &mut inputs) {
                Ok(case) => cases.push(case),
                Err(diagnostics) => wrong
                    .extend(diagnostics.into_iter().filter(|new| !wrong.contains(new)).collect::<Vec<_>>()),
            }
        }
        // the faults of the scene file first
        wrong.sort_by_key(|one| one.file != source.name);
        if wrong.is_empty() { Ok(Document { cases, inputs }) } else { Err(wrong) }
    }

    /// Reads the scene that is the first of the files, without its comparisons.
    ///
    /// # Errors
    /// All faults of the scene and the files to which it refers.
    pub fn read_scene(mut inputs: Inputs) -> Result<Document, Vec<Diagnostic>> {
        let source = inputs.all()[0].source().map_err(|error| vec![*error])?;
        let mut files = Files::of(&mut inputs);
        let read =
            source.read(FORMAT, |raw: &RawScene, faults| scene::read(raw, &source.name, &mut files, faults));
        let mut wrong = files.wrong;
        match read {
            Ok(scene) if wrong.is_empty() => {
                Ok(Document { cases: vec![Case { label: None, scene }], inputs })
            }
            Ok(_) => Err(wrong),
            Err(mut own) => {
                own.append(&mut wrong);
                Err(own)
            }
        }
    }

    /// The scene itself.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.cases[0].scene
    }
}

/// Checks that every comparison has a unique label that is valid in file names, and that it does not change `format`,
/// `units`, `name` and `compare`.
fn check_labels(comparisons: &[TreeNode<'_>], faults: &mut Faults) {
    let root = Place::root();
    let list = root.key("compare");
    let mut seen: Vec<&str> = Vec::new();
    for (index, changes) in comparisons.iter().enumerate() {
        let at = list.index(index);
        if !matches!(changes.value, Value::Object(_)) {
            faults.add(Fault::new(&at, "must be an object with a `label` and changes"));
            continue;
        }
        match changes.member("label").map(|label| label.value.as_text()) {
            Some(Some(label)) => {
                check_name(label, &at.key("label"), faults);
                if seen.contains(&label) {
                    faults.add(
                        Fault::new(&at.key("label"), "must differ from the other labels")
                            .got(format!("{label:?} again")),
                    );
                }
                seen.push(label);
            }
            Some(None) => faults.add(Fault::new(&at.key("label"), "must be a string")),
            None => faults.add(
                Fault::new(&at, "missing key `label`")
                    .of_value()
                    .hint("the label is part of the file name history-<label>.csv"),
            ),
        }
        for key in ["format", "units", "name", "compare"] {
            if changes.member(key).is_some() {
                let expected = format!("a comparison cannot change `{key}`");
                faults.add(Fault::new(&at.key(key), expected).at_key());
            }
        }
    }
}

/// The scene of a document with the changes of `compare[index]` merged into it. `base` has the faults of the scene
/// itself and its files. If there are any, the faults of the changes alone are reported.
fn case(
    tree: &Tree<'_>,
    file: &str,
    index: usize,
    changes: &TreeNode<'_>,
    base: &[Diagnostic],
    inputs: &mut Inputs,
) -> Result<Case, Vec<Diagnostic>> {
    let label =
        changes.member("label").and_then(|label| label.value.as_text()).unwrap_or_default().to_owned();
    let mut merged = tree.root().without("compare");
    merged.merge(changes.without("label"));
    let mut files = Files::of(inputs);
    let examined = examine(&merged, |raw: &RawScene, faults| scene::read(raw, file, &mut files, faults));
    let mut faults = examined.faults;
    if !base.is_empty() {
        // a key that misses in the changes may be one that is wrong in the scene
        faults.0.retain(|fault| fault.basis == Basis::Value && !fault.expected.starts_with("missing key"));
    }
    faults.0.extend(examined.types.into_iter().map(|located| located.fault));
    match examined.value {
        Some(scene) if faults.0.is_empty() && files.wrong.is_empty() => {
            Ok(Case { label: Some(label), scene })
        }
        _ => {
            let mut wrong = tree.diagnose_merged(index, &faults);
            for diagnostic in wrong.iter_mut().filter(|found| !found.path.starts_with("compare")) {
                diagnostic.expected = format!("in comparison \"{label}\": {}", diagnostic.expected);
            }
            if base.is_empty() {
                wrong.append(&mut files.wrong);
            } else {
                let is_of_base = |one: &Diagnostic| {
                    base.iter().any(|known| one.path.ends_with(&known.path) && one.expected == known.expected)
                };
                wrong.retain(|one| one.path.starts_with("compare") && !is_of_base(one));
            }
            Err(wrong)
        }
    }
}
