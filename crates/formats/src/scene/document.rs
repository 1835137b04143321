//! A scene file with its comparisons: the scene, and one variant of it with the changes of each comparison.

use std::path::Path;

use super::raw::RawScene;
use super::read::{Files, scene};
use super::values::scene::{FORMAT, Scene};
use crate::text::diagnostic::Diagnostic;
use crate::text::examine::{Examined, examine};
use crate::text::fault::{Basis, Fault, Faults};
use crate::text::inputs::{Input, Inputs};
use crate::text::names::check_name;
use crate::text::place::Place;
use crate::text::source::{Source, Tree};
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
    /// The changes that were merged into the scene file, if any; the last of `inputs` as well.
    pub changes: Option<Source>,
}

/// One run of a scene.
#[derive(Clone, Debug)]
pub struct Case {
    /// Label of the comparison; none for the scene itself.
    pub label: Option<String>,
    /// The scene with that comparison's changes.
    pub scene: Scene,
}

/// The text of a scene that has been read once, of which documents with different changes are made.
///
/// ```
/// use std::path::Path;
///
/// use formats::scene::SceneSource;
/// use formats::text::source::Source;
///
/// let source = SceneSource::open(Path::new("../../examples/bogie/scene.json")).expect("an example is right");
/// let changes = Source { name: "changes".to_owned(), text: r#"{"end": {"time": 8}}"#.to_owned() };
/// let document = source.document(Some(&changes), false).expect("a shorter run of the scene itself");
/// assert_eq!((document.scene().end, document.cases.len()), (8.0, 1));
///
/// let changes = Source { text: r#"{"end": {"time": -8}}"#.to_owned(), ..changes };
/// let wrong = source.document(Some(&changes), false).expect_err("a negative time");
/// assert!(wrong[0].to_string().starts_with("changes:1:18: end.time: must be positive, got -8"), "{}", wrong[0]);
/// ```
#[derive(Clone, Debug)]
pub struct SceneSource {
    inputs: Inputs,
    source: Source,
}

impl SceneSource {
    /// Reads a scene file. The files to which it refers are read with the documents.
    ///
    /// # Errors
    /// A file that cannot be read or is not text.
    pub fn open(path: &Path) -> Result<SceneSource, Vec<Diagnostic>> {
        let (inputs, source) = Inputs::open(path).map_err(|error| vec![*error])?;
        Ok(SceneSource { inputs, source })
    }

    /// A scene whose text is in memory; the files to which it refers are relative to `folder`. Messages call it
    /// `scene`, and so is its name if it states none.
    #[must_use]
    pub fn of_text(text: String, folder: &Path) -> SceneSource {
        let (inputs, source) = Inputs::of_text("scene", text, folder);
        SceneSource { inputs, source }
    }

    /// The scene that is the first of these files. Files that are among them are not read again.
    ///
    /// # Errors
    /// A file that is not text.
    pub fn of(inputs: Inputs) -> Result<SceneSource, Vec<Diagnostic>> {
        let source = inputs.all()[0].source().map_err(|error| vec![*error])?;
        Ok(SceneSource { inputs, source })
    }

    /// The source with the files of a document of it, so that further documents do not read them again.
    #[must_use]
    pub fn with_files_of(mut self, document: &Document) -> SceneSource {
        let is_changes = |input: &&Input| {
            document
                .changes
                .as_ref()
                .is_some_and(|own| own.name == input.name)
        };
        let files = document
            .inputs
            .all()
            .iter()
            .filter(|input| !is_changes(input));
        self.inputs.keep(files);
        self
    }

    /// Reads the scene with the members of `changes` merged into it (RFC 7386), the files to which it refers, and its
    /// comparisons where `compares`, each merged into the changed scene. The rules are those of the entries of
    /// `compare`: changes cannot concern `format`, `units`, `name` and `compare`.
    ///
    /// # Errors
    /// All faults of all files and of the changes. If the scene itself has faults, those of comparisons are wrong types
    /// and keys, and values out of range.
    pub fn document(
        &self,
        changes: Option<&Source>,
        compares: bool,
    ) -> Result<Document, Vec<Diagnostic>> {
        let mut inputs = self.inputs.clone();
        let tree = self.source.tree();
        let empty = Source {
            name: "changes".to_owned(),
            text: "{}".to_owned(),
        };
        let changing = changes.unwrap_or(&empty);
        let changing = changing.tree();
        if changes.is_some() {
            check_changes(&changing)?;
        }
        let comparisons = tree
            .root()
            .member("compare")
            .map(|member| member.value.items())
            .unwrap_or_default();
        let mut files = Files::of(&mut inputs);
        let name = self.source.name.as_str();
        let read = |raw: &RawScene, faults: &mut Faults| {
            faults.0.extend(tree.duplicates_below("compare").0);
            let scene = scene::read(raw, name, &mut files, faults);
            check_labels(comparisons, faults);
            scene
        };
        let scene = if changes.is_some() && tree.is_whole() {
            let mut merged = tree.root().clone();
            merged.merge(changing.root().clone());
            let Examined {
                value,
                types,
                mut faults,
            } = examine(&merged, read);
            let other = tree.other_format(FORMAT).filter(|_| !types.is_empty());
            faults
                .0
                .extend(types.into_iter().map(|located| located.fault));
            let wrong = || {
                other.map_or_else(
                    || tree.diagnose_changed(&changing, None, &faults),
                    |one| vec![one],
                )
            };
            value.filter(|_| faults.0.is_empty()).ok_or_else(wrong)
        } else {
            tree.read(FORMAT, read)
        };
        let (scene, mut wrong) =
            scene.map_or_else(|wrong| (None, wrong), |scene| (Some(scene), Vec::new()));
        wrong.append(&mut files.wrong);
        let base = wrong.clone();
        let mut cases: Vec<Case> = scene
            .map(|scene| Case { label: None, scene })
            .into_iter()
            .collect();
        let texts = Texts {
            scene: &tree,
            changes: changes.map(|_| &changing),
            file: name,
        };
        for (index, comparison) in comparisons
            .iter()
            .enumerate()
            .filter(|_| tree.is_whole() && compares)
        {
            // another value has been reported with the labels
            let Value::Object(_) = comparison.value else {
                continue;
            };
            match case(&texts, index, comparison, &base, &mut inputs) {
                Ok(case) => cases.push(case),
                Err(diagnostics) => wrong.extend(
                    diagnostics
                        .into_iter()
                        .filter(|new| !wrong.contains(new))
                        .collect::<Vec<_>>(),
                ),
            }
        }
        // the faults of the scene file first
        wrong.sort_by_key(|one| one.file != self.source.name);
        if let Some(changes) = changes {
            inputs.add(&changes.name, changes.text.clone().into_bytes());
        }
        if wrong.is_empty() {
            Ok(Document {
                cases,
                inputs,
                changes: changes.cloned(),
            })
        } else {
            Err(wrong)
        }
    }
}

impl Document {
    /// Reads a scene, the files to which it refers, and its comparisons.
    ///
    /// # Errors
    /// All faults of all files. If the scene itself has faults, those of comparisons are wrong types and keys, and
    /// values out of range.
    pub fn open(path: &Path) -> Result<Document, Vec<Diagnostic>> {
        SceneSource::open(path)?.document(None, true)
    }

    /// The scene itself.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.cases[0].scene
    }

    /// Locates faults of a case, whose label is `label`, in the scene file or in the changes.
    #[must_use]
    pub fn diagnose(&self, label: Option<&str>, faults: &Faults) -> Vec<Diagnostic> {
        let source = match self.inputs.all()[0].source() {
            Ok(source) => source,
            Err(wrong) => return vec![*wrong],
        };
        let tree = source.tree();
        let labelled = |entry: &TreeNode<'_>| {
            let own = entry
                .member("label")
                .and_then(|label| label.value.as_text());
            own.is_some() && own == label
        };
        let comparisons = tree
            .root()
            .member("compare")
            .map(|list| list.value.items())
            .unwrap_or_default();
        let index = comparisons.iter().position(labelled);
        match (&self.changes, index) {
            (Some(changes), index) => tree.diagnose_changed(&changes.tree(), index, faults),
            (None, Some(index)) => tree.diagnose_merged(index, faults),
            (None, None) => tree.diagnose(faults),
        }
    }
}

/// Members that neither changes nor comparisons can concern.
const FIXED: [&str; 4] = ["format", "units", "name", "compare"];

/// Checks that changes are an object, and do not concern `format`, `units`, `name` and `compare`.
fn check_changes(changes: &Tree<'_>) -> Result<(), Vec<Diagnostic>> {
    let root = Place::root();
    let mut faults = changes.duplicates();
    if changes.is_whole() && !matches!(changes.root().value, Value::Object(_)) {
        faults.add(Fault::new(&root, "must be an object with changes"));
    }
    for key in FIXED {
        if changes.root().member(key).is_some() {
            faults.add(
                Fault::new(&root.key(key), format!("changes cannot include `{key}`")).at_key(),
            );
        }
    }
    if let Some(wrong) = changes.syntax_error() {
        return Err(vec![wrong]);
    }
    if faults.0.is_empty() {
        Ok(())
    } else {
        Err(changes.diagnose(&faults))
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
            faults.add(Fault::new(
                &at,
                "must be an object with a `label` and changes",
            ));
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
        for key in FIXED {
            if changes.member(key).is_some() {
                let expected = format!("a comparison cannot change `{key}`");
                faults.add(Fault::new(&at.key(key), expected).at_key());
            }
        }
    }
}

/// The texts of which the cases of a document are merged.
struct Texts<'t> {
    /// The scene file.
    scene: &'t Tree<'t>,
    /// The changes of the whole document.
    changes: Option<&'t Tree<'t>>,
    /// Name of the scene file.
    file: &'t str,
}

/// The scene of a document with the changes of `compare[index]` merged into it. `base` has the faults of the scene
/// itself and its files. If there are any, the faults of the changes alone are reported.
fn case(
    texts: &Texts<'_>,
    index: usize,
    comparison: &TreeNode<'_>,
    base: &[Diagnostic],
    inputs: &mut Inputs,
) -> Result<Case, Vec<Diagnostic>> {
    let Texts {
        scene: tree,
        changes,
        file,
    } = texts;
    let label = comparison
        .member("label")
        .and_then(|label| label.value.as_text())
        .unwrap_or_default()
        .to_owned();
    let mut merged = tree.root().without("compare");
    if let Some(changes) = changes {
        merged.merge(changes.root().clone());
    }
    merged.merge(comparison.without("label"));
    let mut files = Files::of(inputs);
    let examined = examine(&merged, |raw: &RawScene, faults| {
        scene::read(raw, file, &mut files, faults)
    });
    let mut faults = examined.faults;
    if !base.is_empty() {
        // a key that misses in the changes may be one that is wrong in the scene
        faults.0.retain(|fault| {
            fault.basis == Basis::Value && !fault.expected.starts_with("missing key")
        });
    }
    faults
        .0
        .extend(examined.types.into_iter().map(|located| located.fault));
    match examined.value {
        Some(scene) if faults.0.is_empty() && files.wrong.is_empty() => Ok(Case {
            label: Some(label),
            scene,
        }),
        _ => {
            let mut wrong = match changes {
                Some(changes) => tree.diagnose_changed(changes, Some(index), &faults),
                None => tree.diagnose_merged(index, &faults),
            };
            for diagnostic in wrong
                .iter_mut()
                .filter(|found| !found.path.starts_with("compare"))
            {
                diagnostic.expected = format!("in comparison \"{label}\": {}", diagnostic.expected);
            }
            if base.is_empty() {
                wrong.append(&mut files.wrong);
            } else {
                let is_of_base = |one: &Diagnostic| {
                    base.iter().any(|known| {
                        one.path.ends_with(&known.path) && one.expected == known.expected
                    })
                };
                wrong.retain(|one| one.path.starts_with("compare") && !is_of_base(one));
            }
            Err(wrong)
        }
    }
}
