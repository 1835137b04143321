//! Cards of bulk data: lines in small field, large field or free field format are joined to names with fields.

use super::field::number;
use super::line::BulkLine;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

/// A field of a card with its position in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CardField {
    /// Position at which it begins.
    pub at: FilePlace,
    /// Text in capital letters without leading and trailing blanks; empty for a blank field.
    pub text: String,
}

/// A card with the fields of all its continuation lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Card {
    /// Name in capital letters, without the `*` that marks large fields.
    pub name: String,
    /// Position at which it begins.
    pub at: FilePlace,
    /// Fields after the name, eight for each line in small fields; continuation markers are not included.
    pub fields: Vec<CardField>,
}

/// A single line divided into fields. `head` is the first field (name or marker), `tail` the continuation marker.
struct Parts {
    head: String,
    fields: Vec<CardField>,
    tail: String,
    large: bool,
}

/// Joins lines to cards.
///
/// A line whose first field is blank or begins with `+` or `*` continues the card before it. The markers at the end
/// of the line before and at its own beginning must agree where both are present. Fields before a continuation are
/// filled up with blanks to a whole line. Continuations of a card that could not be read are ignored.
#[must_use]
pub fn cards(lines: &[BulkLine], findings: &mut ImportFindings) -> Vec<Card> {
    let mut cards: Vec<Card> = Vec::new();
    let mut tail = String::new();
    // true while continuation lines belong to a card that could not be read
    let mut lost = true;
    for line in lines {
        let Some(parts) = take_apart(line, findings) else {
            lost = true;
            continue;
        };
        let marker = parts.head.trim_start_matches(['+', '*']).trim();
        let continues = parts.head.is_empty() || parts.head.starts_with(['+', '*']);
        if !continues {
            let name = parts.head.trim_end_matches('*').trim_end().to_owned();
            lost = !plain(&name);
            if lost {
                let finding =
                    ImportFinding::new(line.at, "", "must be a card name").with_found(&parts.head);
                let hint = "a name consists of letters and digits; replication by `=` and deletion by `/` are not \
                            supported";
                findings.error(finding.hint(hint));
            } else {
                cards.push(Card {
                    name,
                    at: line.at,
                    fields: parts.fields,
                });
            }
            tail = parts.tail;
            continue;
        }
        let card = match cards.last_mut() {
            Some(card) if !lost => card,
            _ => {
                if cards.is_empty() {
                    let expected = "must not be a continuation, because no card precedes it";
                    let finding = ImportFinding::new(line.at, "", expected);
                    findings.error(finding.hint(
                        "a line that begins with blanks, `+` or `*` continues the preceding line",
                    ));
                }
                continue;
            }
        };
        if line.gap && parts.head.is_empty() {
            let finding = ImportFinding::new(
                line.at,
                &card.name,
                "must not be continued after a blank line",
            );
            findings.error(finding.hint("begin the continuation line with + in column 1"));
        }
        let expected = tail.trim_start_matches(['+', '*']).trim();
        if !expected.is_empty() && !marker.is_empty() && expected != marker {
            let finding = ImportFinding::new(
                line.at,
                &card.name,
                format!("must be continued by a line with the marker {expected}"),
            );
            findings.error(
                finding
                    .with_found(marker)
                    .hint("continuation lines must directly follow their card"),
            );
        }
        let whole = if parts.large { 4 } else { 8 };
        while card.fields.len() % whole != 0 {
            card.fields.push(CardField {
                at: line.at,
                text: String::new(),
            });
        }
        card.fields.extend(parts.fields);
        tail = parts.tail;
    }
    cards
}

fn plain(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
}

fn take_apart(line: &BulkLine, findings: &mut ImportFindings) -> Option<Parts> {
    // the commas of equations of an optimisation do not divide fields
    let is_equation = line.text.to_ascii_uppercase().starts_with("DEQATN");
    if line.text.contains(',') && !is_equation {
        free(line, findings)
    } else {
        Some(fixed(line))
    }
}

/// Divides a line in fixed format: a name of 8 columns, then eight fields of 8 columns (small) or four fields of 16
/// columns (large), then a continuation marker of 8 columns.
fn fixed(line: &BulkLine) -> Parts {
    let chars: Vec<char> = line.text.chars().take(80).collect();
    let cut = |from: usize, to: usize| {
        let part: String = chars
            .get(from.min(chars.len())..to.min(chars.len()))
            .into_iter()
            .flatten()
            .collect();
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
    Parts {
        head,
        fields,
        tail: cut(72, 80).text,
        large,
    }
}

/// Divides a line in free format at its commas: a name, eight fields (four if the name has a `*`), then a
/// continuation marker. Returns `None`, with an error, if the line has more fields.
fn free(line: &BulkLine, findings: &mut ImportFindings) -> Option<Parts> {
    let mut fields = Vec::new();
    let mut column = 1;
    for part in line.text.split(',') {
        let blanks = part.chars().take_while(|c| *c == ' ').count();
        let at = FilePlace {
            column: column + blanks,
            ..line.at
        };
        fields.push(CardField {
            at,
            text: part.trim().to_uppercase(),
        });
        column += part.chars().count() + 1;
    }
    let head = fields.remove(0).text;
    let large = head.ends_with('*') || head.starts_with('*');
    let count = if large { 4 } else { 8 };
    while fields.last().is_some_and(|field| field.text.is_empty()) {
        fields.pop();
    }
    let tail = if fields.len() > count {
        fields[count].text.clone()
    } else {
        String::new()
    };
    let marker = tail.is_empty() || tail.starts_with('+') || number(&tail).is_none();
    if fields.len() > count + 1 || !marker {
        let what = if large {
            "four fields in a line of large field format"
        } else {
            "eight fields in a line"
        };
        let finding = ImportFinding::new(fields[count].at, &head, format!("has more than {what}"));
        findings.error(finding.hint("continue on the next line, beginning with a comma or +"));
        return None;
    }
    fields.resize(
        count,
        CardField {
            at: line.at,
            text: String::new(),
        },
    );
    Some(Parts {
        head,
        fields,
        tail,
        large,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Vec<Card>, ImportFindings) {
        let mut findings = ImportFindings::default();
        let lines: Vec<BulkLine> = text
            .lines()
            .enumerate()
            .map(|(index, text)| BulkLine {
                at: FilePlace {
                    file: 0,
                    line: index + 1,
                    column: 1,
                },
                text: text.to_owned(),
                gap: false,
            })
            .collect();
        (cards(&lines, &mut findings), findings)
    }

    /// Texts of the fields without trailing blank fields.
    fn texts(card: &Card) -> Vec<&str> {
        let mut texts: Vec<&str> = card
            .fields
            .iter()
            .map(|field| field.text.as_str())
            .collect();
        while texts.last().is_some_and(|text| text.is_empty()) {
            texts.pop();
        }
        texts
    }

    #[test]
    fn one_card_reads_the_same_in_every_format() {
        let wanted = [
            "5", "1", "10", "20", "0.", "1.", "0.", "", "456", "", "", "", "", "1.5",
        ];
        for text in [
            "CBAR           5       1      10      20      0.      1.      0.        +A\n+A           456                                     1.5",
            "cbar    5       1       10      20      0.      1.      0.\n        456                                     1.5",
            "CBAR,5,1,10,20,0.,1.,0.,,+A\n+A,456,,,,,1.5",
            "CBAR,5,1,10,20,0.,1.,0.\n,456,,,,,1.5",
            "cbar , 5, 1 ,10,20,0.,1.,0.,\n+,456,,,,,1.5",
            "CBAR*                  5               1              10              20*A\n*A                    0.              1.              0.                *B\n*B                   456                                                *C\n*C                                   1.5",
            "CBAR*,5,1,10,20,*A\n*A,0.,1.,0.,,*B\n*B,456,,,,*C\n*C,,1.5",
            "CBAR*                  5               1              10              20\n*                     0.              1.              0.\n+            456                                     1.5",
        ] {
            let (cards, findings) = read(text);
            assert!(!findings.has_errors(), "{text}: {:?}", findings.errors());
            assert_eq!(cards.len(), 1, "{text}");
            assert_eq!(
                (cards[0].name.as_str(), texts(&cards[0])),
                ("CBAR", wanted.to_vec()),
                "{text}"
            );
        }
    }

    #[test]
    fn a_large_card_of_one_line_may_be_continued_in_small_fields() {
        let (cards, findings) =
            read("GRID*                  1                              2.\n+       7");
        assert!(!findings.has_errors());
        assert_eq!(texts(&cards[0]), ["1", "", "2.", "", "", "", "", "", "7"]);
    }

    #[test]
    fn fields_know_their_columns() {
        let (cards, _) = read("GRID           1              2.\nGRID, 2,,3.");
        assert_eq!(cards[0].fields[0].at.column, 16);
        assert_eq!(cards[0].fields[2].at.column, 31);
        assert_eq!(
            cards[1].fields[0].at,
            FilePlace {
                file: 0,
                line: 2,
                column: 7
            }
        );
        assert_eq!(cards[1].fields[2].at.column, 10);
    }

    #[test]
    fn what_stands_beyond_column_80_is_a_comment() {
        let text = format!("{:<80}12345", "GRID    1");
        assert_eq!(texts(&read(&text).0[0]), ["1"]);
    }

    #[test]
    fn lost_continuations_are_refused() {
        for (text, expected) in [
            (
                "+A      1",
                "must not be a continuation, because no card precedes it",
            ),
            (
                "GRID    1                                                               +A\n+B      1",
                "must be continued by a line with the marker A",
            ),
            (
                "GRID,1,,0.,0.,0.,,,,7",
                "has more than eight fields in a line",
            ),
            (
                "GRID*,1,,0.,0.,,0.",
                "has more than four fields in a line of large field format",
            ),
            ("=       1", "must be a card name"),
            ("GR.ID   1", "must be a card name"),
        ] {
            let errors = read(text).1.errors();
            assert_eq!(
                errors.first().map(|error| error.expected.as_str()),
                Some(expected),
                "{text}"
            );
        }
    }
}
