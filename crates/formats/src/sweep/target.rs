//! The files of a scene or design as texts in which values are replaced.

use crate::text::inputs::Inputs;
use crate::text::source::{Source, without_mark};
use crate::text::tree::{TreeNode, Value};

use super::axis_value::AxisValue;

/// The place of a value in the files of a scene or design: its bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisPlace {
    /// Index of the file in [`Inputs::all`].
    pub file: usize,
    /// Byte offset of the value.
    pub start: usize,
    /// Byte offset after the value.
    pub end: usize,
}

/// The files of a scene or design.
#[derive(Clone, Debug)]
pub struct SweepTarget {
    inputs: Inputs,
}

/// Why a pointer has no value that can be varied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PointerError {
    /// What it must do.
    pub expected: String,
    /// What helps.
    pub hint: String,
}

impl SweepTarget {
    /// The files, the scene or design first.
    #[must_use]
    pub const fn new(inputs: Inputs) -> SweepTarget {
        SweepTarget { inputs }
    }

    /// The files as they are.
    #[must_use]
    pub const fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// The files with values in place of others; the places are those of different values. What is replaced is the
    /// text of each value alone, so that everything else stays as it is written.
    #[must_use]
    pub fn with(&self, changes: &[(&AxisPlace, &AxisValue)]) -> Inputs {
        let mut inputs = self.inputs.clone();
        for file in 0..self.inputs.all().len() {
            let mut own: Vec<_> = changes
                .iter()
                .filter(|(place, _)| place.file == file)
                .collect();
            if own.is_empty() {
                continue;
            }
            own.sort_by_key(|(place, _)| place.start);
            // places count from the beginning of the text
            let old = without_mark(&self.inputs.all()[file].bytes);
            let mut new = Vec::with_capacity(old.len() + 24 * own.len());
            let mut from = 0;
            for (place, value) in own {
                new.extend_from_slice(&old[from..place.start]);
                new.extend_from_slice(value.json().to_string().as_bytes());
                from = place.end;
            }
            new.extend_from_slice(&old[from..]);
            inputs.replace(file, new);
        }
        inputs
    }

    /// The place of the value to which a pointer leads, such as `/bodies/crane/weight` or `spec.json#/girder/E`, and
    /// the value.
    pub(super) fn find(&self, pointer: &str) -> Result<(AxisPlace, AxisValue), PointerError> {
        let (file, within) = pointer
            .split_once('#')
            .map_or((None, pointer), |(file, rest)| (Some(file), rest));
        let all = self.inputs.all();
        let index = match file {
            None => 0,
            Some(name) => all
                .iter()
                .skip(1)
                .position(|input| input.name == name)
                .map(|k| k + 1)
                .ok_or_else(|| PointerError {
                    expected: format!(
                        "must name a file of the {}, which \"{name}\" is not",
                        self.word()
                    ),
                    hint: match all
                        .iter()
                        .skip(1)
                        .map(|input| input.name.as_str())
                        .collect::<Vec<_>>()
                    {
                        names if names.is_empty() => "it refers to no file".to_owned(),
                        names => format!("its files: {}", names.join(", ")),
                    },
                })?,
        };
        let Ok(source) = all[index].source() else {
            return Err(PointerError {
                expected: format!(
                    "must refer to a value in a JSON file, which {} is not",
                    all[index].name
                ),
                hint: "values of tables cannot be varied".to_owned(),
            });
        };
        self.value(&source, within, index)
    }

    fn value(
        &self,
        source: &Source,
        pointer: &str,
        file: usize,
    ) -> Result<(AxisPlace, AxisValue), PointerError> {
        if !pointer.starts_with('/') {
            return Err(PointerError {
                expected: "must be a JSON pointer".to_owned(),
                hint: "it begins with /, such as /bodies/crane/weight or spec.json#/girder/E"
                    .to_owned(),
            });
        }
        if file == 0 && (pointer == "/compare" || pointer.starts_with("/compare/")) {
            return Err(PointerError {
                expected: "must refer to a value outside `compare`".to_owned(),
                hint: "comparisons are not run in a sweep".to_owned(),
            });
        }
        let tree = source.tree();
        let mut node: &TreeNode<'_> = tree.root();
        let mut walked = String::new();
        for step in pointer.split('/').skip(1) {
            let key = step.replace("~1", "/").replace("~0", "~");
            let next = match &node.value {
                Value::List(items) => key.parse::<usize>().ok().and_then(|index| items.get(index)),
                _ => node.member(&key).map(|member| &member.value),
            };
            node = next.ok_or_else(|| nowhere(node, &walked, &key, &source.name))?;
            walked.push('/');
            walked.push_str(step);
        }
        let value = match &node.value {
            Value::Unsigned(value) => AxisValue::Number(*value as f64),
            Value::Signed(value) => AxisValue::Number(*value as f64),
            Value::Float(value) => AxisValue::Number(*value),
            Value::Text(text) => AxisValue::Text(text.clone().into_owned()),
            Value::Bool(flag) => AxisValue::Flag(*flag),
            Value::Null | Value::List(_) | Value::Object(_) => {
                return Err(PointerError {
                    expected: format!(
                        "must refer to a number, a string, true or false in {}",
                        source.name
                    ),
                    hint: match below(node) {
                        below if below.is_empty() => "the value there is empty".to_owned(),
                        below => format!("it contains {below}"),
                    },
                });
            }
        };
        Ok((
            AxisPlace {
                file,
                start: node.start,
                end: node.end,
            },
            value,
        ))
    }

    fn word(&self) -> &'static str {
        let is_design = |source: Source| {
            let tree = source.tree();
            let format = tree
                .root()
                .member("format")
                .and_then(|member| member.value.as_text());
            format == Some(crate::design::FORMAT)
        };
        if self.inputs.all()[0].source().is_ok_and(is_design) {
            "design"
        } else {
            "scene"
        }
    }
}

/// The error of a pointer whose step `key` does not exist in the value that was reached.
fn nowhere(node: &TreeNode<'_>, walked: &str, key: &str, file: &str) -> PointerError {
    let above = if walked.is_empty() {
        "the file"
    } else {
        walked
    };
    let hint = match below(node) {
        below if below.is_empty() => format!("{above} contains no values"),
        below => format!(
            "{above} contains {below}; to vary a key that the file leaves out, write it there first"
        ),
    };
    PointerError {
        expected: format!("must refer to a value of {file}, but \"{key}\" is not in {above}"),
        hint,
    }
}

/// Keys or indices below a value, in words.
fn below(node: &TreeNode<'_>) -> String {
    match &node.value {
        Value::Object(members) => {
            let keys: Vec<&str> = members.iter().map(|member| &*member.key).take(20).collect();
            keys.join(", ")
        }
        Value::List(items) if items.is_empty() => String::new(),
        Value::List(items) => format!("the items 0 to {}", items.len() - 1),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn target(folder: &std::path::Path) -> SweepTarget {
        fs::write(
            folder.join("scene.json"),
            "{\"a/b\": [1, {\"c\": -2.5e3}], \"spec\": \"spec.json\"}",
        )
        .expect("writable");
        fs::write(folder.join("spec.json"), "{\"girder\": {\"E\": 210}}").expect("writable");
        let (mut inputs, _) = Inputs::open(&folder.join("scene.json")).expect("readable");
        inputs.open_referenced("spec.json").expect("readable");
        SweepTarget::new(inputs)
    }

    #[test]
    fn values_take_the_place_of_others_and_leave_the_text_around_them() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let target = target(folder.path());
        let (c, old) = target.find("/a~1b/1/c").expect("a number");
        assert_eq!(old, AxisValue::Number(-2500.0));
        let (first, _) = target.find("/a~1b/0").expect("a number");
        let (modulus, _) = target.find("spec.json#/girder/E").expect("a number");
        let values = [
            AxisValue::Number(0.1),
            AxisValue::Number(7.0),
            AxisValue::Number(2.1e8),
        ];
        let inputs = target.with(&[
            (&c, &values[0]),
            (&modulus, &values[2]),
            (&first, &values[1]),
        ]);
        let text =
            |index: usize| String::from_utf8(inputs.all()[index].bytes.clone()).expect("text");
        assert_eq!(
            text(0),
            "{\"a/b\": [7.0, {\"c\": 0.1}], \"spec\": \"spec.json\"}"
        );
        assert_eq!(text(1), "{\"girder\": {\"E\": 210000000.0}}");
    }

    #[test]
    fn pointers_that_lead_nowhere_say_what_is_there() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let target = target(folder.path());
        let wrong = |pointer: &str| {
            target
                .find(pointer)
                .expect_err("a pointer that leads nowhere")
        };
        assert!(
            wrong("/a/b").hint.contains("a/b, spec"),
            "{:?}",
            wrong("/a/b")
        );
        assert!(wrong("other.json#/E").hint.contains("spec.json"));
        assert!(wrong("a").expected.contains("JSON pointer"));
        assert!(wrong("/a~1b").hint.contains("0 to 1"));
        assert!(wrong("/compare/0/end").hint.contains("comparisons"));
    }
}
