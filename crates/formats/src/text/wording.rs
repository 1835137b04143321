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
        let habit = HABITS
            .iter()
            .find(|(word, meant, _)| *word == key && known.contains(meant));
        fault.hint = Some(match (habit, nearest(key, &known)) {
            (Some((_, meant, why)), _) => format!("did you mean `{meant}`? {why}"),
            (None, Some(near)) => format!("did you mean `{near}`? {list}"),
            (None, None) => list,
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
            if expected == "f64" {
                fault.hint = found
                    .strip_prefix("string ")
                    .and_then(|text| number_hint(text.trim_matches('"')));
            }
            let whole = ["must be a list", "must be an object"]
                .iter()
                .any(|kind| fault.expected.starts_with(kind));
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

/// Keys of other programs and standards: what is meant where that is a known key, and why.
const HABITS: [(&str, &str, &str); 31] = [
    ("I", "I_vertical", BENDING),
    ("Ix", "I_vertical", BENDING),
    ("Iy", "I_vertical", BENDING),
    ("Iz", "I_lateral", BENDING),
    ("Iyy", "I_vertical", BENDING),
    ("Izz", "I_lateral", BENDING),
    ("It", "J", "the torsion constant"),
    (
        "Ix",
        "J",
        "the torsion constant is J, the local axes across the member are y and z",
    ),
    ("Iyy", "Iy", "about the local axes of the member"),
    ("Izz", "Iz", "about the local axes of the member"),
    (
        "Av",
        "kA_vertical",
        "the effective shear area for vertical forces",
    ),
    ("area", "A", "the area of the cross section"),
    (
        "profile",
        "section",
        "the name of a rolled section, such as \"HEB 400\"",
    ),
    (
        "profile",
        "shape",
        "dimensions, or the name of a rolled section such as \"HEB 400\"",
    ),
    (
        "section",
        "girder",
        "the name of a rolled section is given in the girder: {\"spans\": [6], \"section\": \"HEB 400\"}",
    ),
    (
        "spans",
        "girder",
        "in the short form it contains the spans and the section: {\"spans\": [6, 6], \"section\": \"HEB 400\"}",
    ),
    (
        "length",
        "spans",
        "a list of the distances between supports: [6] for one span",
    ),
    (
        "rail",
        "crane_rail",
        "the name of a crane rail, such as \"A75\"",
    ),
    (
        "mass",
        "mass_per_length",
        "mass, not weight, per unit length",
    ),
    (
        "weight",
        "mass_per_length",
        "mass, not weight, per unit length",
    ),
    ("rho", "density", "mass, not weight, per unit volume"),
    (
        "fixed",
        "fix",
        "a list of degrees of freedom, such as [\"ux\", \"uy\", \"uz\"]",
    ),
    (
        "g",
        "gravity",
        "the acceleration, such as 9.81 m/s2 or 32.174 ft/s2",
    ),
    ("time", "end", "the end of the run: {\"time\": 30}"),
    ("duration", "end", "the end of the run: {\"time\": 30}"),
    (
        "dt",
        "output",
        "the time between two rows of the history: {\"dt\": 0.01}",
    ),
    (
        "tolerance",
        "accuracy",
        "the accuracy of the run; `tolerance` is that of a structure's foundation",
    ),
    (
        "speed",
        "v0",
        "the speed at the start; a prescribed speed is given in `motions`",
    ),
    ("diameter", "radius", "half the diameter"),
    ("P", "vertical", "the force that presses on the rail"),
    ("Q", "vertical", "the force that presses on the rail"),
];

/// Which second moment of area is which, in a girder.
const BENDING: &str = "`I_vertical` is for bending under vertical loads (strong axis), `I_lateral` for lateral bending";

/// Examples of values whose type is often wrong, by their key.
const EXAMPLES: [(&str, &str); 16] = [
    (
        "stations",
        "such as [0, 1.5, 3, 4.5, 6], the coordinates at which tables have values",
    ),
    (
        "spans",
        "such as [6, 7.5, 6], the distances between supports",
    ),
    (
        "vertical",
        "an object with k, or in a design a force or its parts by name",
    ),
    (
        "units",
        "such as {\"length\": \"m\", \"force\": \"kN\", \"time\": \"s\"}",
    ),
    (
        "shape",
        "such as {\"kind\": \"bar\", \"height\": 0.4, \"width\": 0.2}; a girder names a rolled section by `section`",
    ),
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

/// What to write in place of a text where a number is needed; `None` where that is not known.
fn number_hint(text: &str) -> Option<String> {
    let text = text.trim();
    if sections::rolled(text).is_some() {
        let hint = "a rolled section is named by `section` of the girder, or by `shape` of a section in the general form";
        return Some(hint.to_owned());
    }
    if let Ok(number) = text.parse::<f64>() {
        return number
            .is_finite()
            .then(|| format!("write it without quotes: {text}"));
    }
    let point = text.replacen(',', ".", 1);
    if point.parse::<f64>().is_ok() {
        return Some(format!("use a decimal point and no quotes: {point}"));
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)))?;
    let is_with_unit =
        text[..end].parse::<f64>().is_ok() && text[end..].trim().starts_with(char::is_alphabetic);
    is_with_unit.then(|| "give the number only: its unit follows from `units`".to_owned())
}

/// The number with a decimal comma that ends a text in the middle of it: at `offset` the part behind the comma begins.
/// JSON takes the comma for a separator.
fn with_decimal_comma(text: &str, offset: usize) -> Option<String> {
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let (before, after) = text.split_at_checked(offset)?;
    let whole = before.strip_suffix(',')?;
    let start = whole.rfind(|c| !is_of_number(c)).map_or(0, |at| at + 1);
    let end = after.find(|c| !is_of_number(c)).unwrap_or(after.len());
    let number = format!("{}.{}", &whole[start..], &after[..end]);
    let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    (is_digit(whole.chars().last())
        && is_digit(after.chars().next())
        && number.parse::<f64>().is_ok())
    .then_some(number)
}

fn plain_type(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "usize" | "u64" | "u32" => "a whole number, zero or more".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a boolean" => "true or false".to_owned(),
        other => other.strip_prefix("an array of length ").map_or_else(
            || other.to_owned(),
            |count| format!("a list of {count} items"),
        ),
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

/// The message and the hint for a text that is not JSON from the byte at `offset` on.
pub(super) fn syntax(message: &str, text: &str, offset: usize) -> (String, Option<String>) {
    if text.trim().is_empty() {
        return (
            "the file is empty".to_owned(),
            Some("a JSON object is needed".to_owned()),
        );
    }
    if message == "number out of range" {
        let hint = "the largest number in double precision is 1.8e308";
        return ("the number is too large".to_owned(), Some(hint.to_owned()));
    }
    if message == TOO_MANY_VALUES {
        let hint =
            "an input may have at most 20 million values; a grid has n x n numbers for n stations";
        return (
            "the file has too many values".to_owned(),
            Some(hint.to_owned()),
        );
    }
    if message.starts_with("EOF while parsing") {
        return ("not valid JSON: the file ends too early".to_owned(), None);
    }
    if message == "key must be a string"
        && let Some(number) = with_decimal_comma(text, offset)
    {
        let hint = format!("a decimal comma? numbers have a decimal point: {number}");
        return (
            "not valid JSON: key must be a string".to_owned(),
            Some(hint),
        );
    }
    let hint = match message {
        "key must be a string" => Some("JSON has no comments, and keys are in double quotes"),
        "trailing comma" => Some("JSON has no comma after the last item"),
        "expected value" => Some("JSON has no NaN, Infinity, comments or single quotes"),
        "recursion limit exceeded" => Some("lists and objects may be nested 128 deep"),
        _ => None,
    };
    (
        format!("not valid JSON: {message}"),
        hint.map(str::to_owned),
    )
}
