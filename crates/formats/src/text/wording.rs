//! Translates the messages of serde and `serde_json` to the wording of this program.

use super::fault::{Basis, Fault, nearest};
use super::json::TOO_MANY_VALUES;
use super::place::{Path, Step};

/// Whether a message of serde reports a duplicate key.
pub(super) fn is_duplicate(message: &str) -> bool {
    message.starts_with("duplicate field ")
}

/// Converts a message of serde about the value at `path`: it has the wrong type, or its key is unknown.
pub(super) fn type_fault(path: Path, message: &str) -> Fault {
    let mut fault = Fault {
        path,
        at_key: false,
        expected: message.to_owned(),
        found: None,
        hint: None,
        basis: Basis::Value,
    };
    if let Some(rest) = message.strip_prefix("unknown field `")
        && let Some((key, known)) = rest.split_once('`')
    {
        let known: Vec<&str> = known.split('`').skip(1).step_by(2).collect();
        fault.at_key = true;
        fault.expected = format!("unknown key `{key}`");
        let list = format!("known keys are {}", known.join(", "));
        fault.hint = Some(match nearest(key, &known) {
            Some(near) => format!("did you mean `{near}`? {list}"),
            None => list,
        });
    } else if let Some((found, expected)) = message.split_once(", expected ") {
        let found = ["invalid type: ", "invalid value: ", "invalid length "]
            .iter()
            .find_map(|prefix| found.strip_prefix(prefix).map(|rest| (*prefix, rest)));
        if let Some((prefix, found)) = found {
            let count = prefix == "invalid length ";
            fault.expected = format!("must be {}", plain_type(expected));
            fault.found = Some(if count {
                format!("{found} item{}", if found == "1" { "" } else { "s" })
            } else {
                plain_found(found)
            });
            let whole =
                ["must be a list", "must be an object"].iter().any(|kind| fault.expected.starts_with(kind));
            if let Some(Step::Key(key)) = fault.path.0.last().filter(|_| whole) {
                let example = EXAMPLES.iter().find(|(known, _)| known == key);
                fault.hint = example.map(|(_, example)| (*example).to_owned());
            }
        }
    }
    fault
}

/// The known key that was probably meant by an unknown one.
pub(super) fn meant_key(fault: &Fault) -> Option<&str> {
    let hint = fault.hint.as_deref()?.strip_prefix("did you mean `")?;
    hint.split_once('`').map(|(key, _)| key)
}

/// Examples of values whose type is often wrong, by their key.
const EXAMPLES: [(&str, &str); 11] = [
    ("position", "rows [time, value], such as [[0, 4]]"),
    ("speed", "rows [time, value], such as [[0, 4]]"),
    ("acceleration", "rows [time, value], such as [[0, 4]]"),
    ("value", "rows [time, value], such as [[0, 4]]"),
    ("end", "such as {\"time\": 30}"),
    ("output", "such as {\"dt\": 0.01}"),
    ("do", "such as {\"brake\": \"trolley\"}"),
    ("dof", "such as [\"x\", \"y\", \"pitch\"]"),
    ("fix", "such as [\"ux\", \"uy\", \"uz\", \"rx\"]"),
    ("inertia", "[roll, yaw, pitch], in a spec about x, y, z"),
    ("at", "[x, y, z]: along, up, to the right"),
];

fn plain_type(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "usize" | "u64" | "u32" => "a whole number, zero or more".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a boolean" => "true or false".to_owned(),
        other => other
            .strip_prefix("an array of length ")
            .map_or_else(|| other.to_owned(), |count| format!("a list of {count} items")),
    }
}

fn plain_found(found: &str) -> String {
    let kinds = [
        ("string ", "the text "),
        ("floating point ", "the number "),
        ("integer ", "the number "),
        ("boolean ", ""),
    ];
    for (prefix, plain) in kinds {
        if let Some(rest) = found.strip_prefix(prefix) {
            return format!("{plain}{}", rest.trim_matches('`'));
        }
    }
    match found {
        "sequence" => "a list".to_owned(),
        "map" => "an object".to_owned(),
        other => other.to_owned(),
    }
}

/// The message and the hint for a text that is not JSON.
pub(super) fn syntax(message: &str, text: &str) -> (String, Option<String>) {
    if text.trim().is_empty() {
        return ("the file is empty".to_owned(), Some("a JSON object is needed".to_owned()));
    }
    if text.starts_with('\u{feff}') {
        let hint = "the file begins with a byte order mark: save it as UTF-8 without one";
        return ("not valid JSON".to_owned(), Some(hint.to_owned()));
    }
    if message == "number out of range" {
        let hint = "double precision ends at 1.8e308";
        return ("the number is too large".to_owned(), Some(hint.to_owned()));
    }
    if message == TOO_MANY_VALUES {
        let hint =
            "an input may have 20 million numbers, words and items; a grid has n x n numbers for n stations";
        return ("the file has too many values".to_owned(), Some(hint.to_owned()));
    }
    if message.starts_with("EOF while parsing") {
        return ("not valid JSON: the file ends too early".to_owned(), None);
    }
    let hint = match message {
        "key must be a string" => Some("JSON has no comments, and keys stand in double quotes"),
        "trailing comma" => Some("JSON has no comma after the last item"),
        "expected value" => Some("JSON has no NaN, Infinity, comments or single quotes"),
        "recursion limit exceeded" => Some("lists and objects may be nested 128 deep"),
        _ => None,
    };
    (format!("not valid JSON: {message}"), hint.map(str::to_owned))
}
