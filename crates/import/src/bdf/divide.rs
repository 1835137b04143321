//! Division of lines into fields: fixed format with small or large fields, and free format.

use super::field::number;
use super::line::BulkLine;
use crate::findings::{FilePlace, ImportFinding};

/// A field of a card with its position in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CardField {
    /// Position at which it begins.
    pub at: FilePlace,
    /// Text in capital letters without leading and trailing blanks; empty for a blank field.
    pub text: String,
}

/// A single line divided into fields.
#[derive(Clone, Debug)]
pub struct LineFields {
    /// Position of its beginning.
    pub at: FilePlace,
    /// Whether a blank line precedes it.
    pub gap: bool,
    /// The first field: a name, or the marker of a continuation.
    pub head: String,
    /// Eight fields, or four large ones.
    pub fields: Vec<CardField>,
    /// The tenth field, which may be the marker of a continuation. In fixed format it begins with column 73.
    pub tail: CardField,
    /// Whether its fields are large.
    pub large: bool,
    /// Whether it is in free format.
    pub free: bool,
}

/// Divides a line into fields. It is in free format if it has a comma, in the first ten columns or without a blank before
/// it. A line of replication of several fields without commas is refused, because blanks between them have another meaning
/// in free format than in the other ones.
pub fn take_apart(line: &BulkLine, is_equation: bool) -> Result<LineFields, Box<ImportFinding>> {
    let text = &line.text;
    let is_free = match text.find(',') {
        _ if is_equation => false,
        None => false,
        Some(place) => place < 10 || !text[..place].trim().contains(' '),
    };
    if is_free {
        return free(line);
    }
    let fixed = fixed(line);
    let is_replication = fixed.head.starts_with('=');
    if is_replication && text.trim_end().chars().count() > 8 {
        let finding = ImportFinding::new(line.at, "", "must have commas between its fields");
        let hint =
            "blanks may separate fields of replication or fill them up: write =,*(1),=,*(.5),==";
        return Err(Box::new(finding.with_found(&fixed.head).hint(hint)));
    }
    Ok(fixed)
}

/// Divides a line in fixed format: a name of 8 columns, then eight fields of 8 columns (small) or four fields of 16
/// columns (large), then a continuation marker of 8 columns.
fn fixed(line: &BulkLine) -> LineFields {
    let chars: Vec<char> = line.text.chars().take(80).collect();
    let columns = |from: usize, to: usize| -> String {
        let part = chars.get(from.min(chars.len())..to.min(chars.len()));
        part.into_iter().flatten().collect()
    };
    let cut = |from: usize, to: usize| {
        let part = columns(from, to);
        let blanks = part.chars().take_while(|c| *c == ' ').count();
        CardField {
            at: FilePlace {
                column: from + blanks + 1,
                ..line.at
            },
            text: part.trim().to_uppercase(),
        }
    };
    let head = cut(0, 8).text;
    let large = head.ends_with('*') || head.starts_with('*');
    let width = if large { 16 } else { 8 };
    let fields = (0..64 / width)
        .map(|k| cut(8 + k * width, 8 + (k + 1) * width))
        .collect();
    LineFields {
        at: line.at,
        gap: line.gap,
        head,
        fields,
        tail: CardField {
            at: cut(72, 80).at,
            text: columns(72, 80).trim_end().to_uppercase(),
        },
        large,
        free: false,
    }
}

/// Divides a line in free format at its commas and blanks: a name, eight fields (four if the name has a `*`), then a
/// continuation marker. A blank between two commas is a blank field; `n)` before a value states the number of its field,
/// the name being the first, and `)` that it is the tenth. Returns an error if the line has more fields.
fn free(line: &BulkLine) -> Result<LineFields, Box<ImportFinding>> {
    let mut words: Vec<CardField> = Vec::new();
    let mut column = 1;
    for part in line.text.split(',') {
        let before = words.len();
        let mut blanks = 0;
        for word in part.split(' ') {
            if !word.is_empty() {
                let at = FilePlace {
                    column: column + blanks,
                    ..line.at
                };
                words.push(CardField {
                    at,
                    text: word.to_uppercase(),
                });
            }
            blanks += word.chars().count() + 1;
        }
        if words.len() == before {
            words.push(CardField {
                at: FilePlace { column, ..line.at },
                text: String::new(),
            });
        }
        if may_be_one(&words[before..]) {
            let finding = ImportFinding::new(words[before].at, "", "must be separated by a comma");
            let hint =
                "a blank separates fields in free format: write 1,2 for two fields and 12 for one";
            return Err(Box::new(finding.with_found(part.trim()).hint(hint)));
        }
        column += part.chars().count() + 1;
    }
    let head = words.remove(0).text;
    let large = (head.ends_with('*') || head.starts_with('*')) && !head.starts_with("*(");
    let count = if large { 4 } else { 8 };
    let blank = CardField {
        at: line.at,
        text: String::new(),
    };
    let mut fields = vec![blank; count + 1];
    let mut next = 0;
    while words.last().is_some_and(|word| word.text.is_empty()) {
        words.pop();
    }
    for mut word in words {
        if let Some((index, value)) = numbered(&word.text) {
            next = index;
            word.text = value;
            if word.text.is_empty() {
                continue;
            }
        }
        let is_marker = next < count || word.text.starts_with('+') || number(&word.text).is_none();
        if next > count || !is_marker {
            let what = if large {
                "four fields in a line of large field format"
            } else {
                "eight fields in a line"
            };
            let finding = ImportFinding::new(word.at, &head, format!("has more than {what}"));
            let hint = "continue on the next line, beginning with a comma or +";
            return Err(Box::new(finding.hint(hint)));
        }
        let is_slash = word.text.starts_with('/') && word.text.trim_start_matches('/').is_empty();
        if head.starts_with('=') && is_slash && next > 0 {
            // each slash repeats the field before it
            for _ in 0..word.text.len().min(count - next) {
                fields[next].text = fields[next - 1].text.clone();
                next += 1;
            }
        } else {
            fields[next] = word;
            next += 1;
        }
    }
    let tail = fields.pop().unwrap_or_default();
    Ok(LineFields {
        at: line.at,
        gap: line.gap,
        head,
        fields,
        tail,
        large,
        free: true,
    })
}

/// Whether words that blanks separate could also be one set of degrees of freedom: different digits from 1 to 6 in
/// increasing order, as in `12 3`.
fn may_be_one(words: &[CardField]) -> bool {
    let digits: String = words.iter().map(|word| word.text.as_str()).collect();
    let digits = digits.as_bytes();
    words.len() > 1
        && digits.iter().all(|digit| (b'1'..=b'6').contains(digit))
        && digits.is_sorted_by(|a, b| a < b)
}

/// The index of the field and the value of a word such as `8)246`, or `)+A` for the tenth field.
fn numbered(word: &str) -> Option<(usize, String)> {
    let (place, value) = word.split_once(')')?;
    let place: usize = if place.is_empty() {
        10
    } else {
        place.parse().ok()?
    };
    (2..=10)
        .contains(&place)
        .then(|| (place - 2, value.to_owned()))
}
