//! Cards of bulk data: lines in small field, large field or free field format are joined to names with fields.

use std::collections::BTreeMap;

use super::divide::{CardField, LineFields, take_apart};
use super::line::BulkLine;
use super::replication::Replication;
use crate::findings::{FilePlace, ImportFinding, ImportFindings};

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

/// Joins lines to cards.
///
/// A line whose first field is blank or begins with `+` or `*` continues a card. Its marker, which is the rest of that
/// field, must agree with the one at the end of the line before, of which the first character has no meaning, where both
/// are present; if it does not, the line continues the earlier card whose last line ends with this marker. Fields before a
/// continuation are filled up with blanks to a whole line. Continuations of a card that could not be read are ignored.
#[must_use]
pub fn cards(lines: &[BulkLine], findings: &mut ImportFindings) -> Vec<Card> {
    let mut cards: Vec<Card> = Vec::new();
    // markers at the end of the last line of each card
    let mut ends: Vec<[String; 2]> = Vec::new();
    let mut by_marker: BTreeMap<String, usize> = BTreeMap::new();
    let mut replication = Replication::default();
    // the card that is being read; `None` while lines belong to a card that could not be read
    let mut current: Option<usize> = None;
    let mut is_equation = false;
    for line in lines {
        // the commas of equations of an optimisation do not divide fields
        let begins = line.text.trim_start().to_ascii_uppercase();
        let continues = line.text.starts_with([' ', '+', '*', ',']);
        is_equation = begins.starts_with("DEQATN") || (is_equation && continues);
        let read = match take_apart(line, is_equation) {
            Ok(read) => replication.expanded(read),
            Err(fault) => Err(fault),
        };
        let read = read.unwrap_or_else(|fault| {
            findings.error(*fault);
            current = None;
            Vec::new()
        });
        for line in read {
            let is_continuation = line.head.is_empty() || line.head.starts_with(['+', '*']);
            let index = if is_continuation {
                continued(&line, &cards, &ends, &by_marker, current, findings)
            } else {
                begun(&line, &mut cards, findings)
            };
            let Some(index) = index else {
                if !is_continuation {
                    current = None;
                }
                continue;
            };
            current = Some(index);
            if is_continuation {
                let whole = if line.large { 4 } else { 8 };
                let fields = &mut cards[index].fields;
                while !fields.len().is_multiple_of(whole) {
                    fields.push(CardField {
                        at: line.at,
                        text: String::new(),
                    });
                }
                fields.extend(line.fields);
            }
            let markers = markers(&line.tail.text);
            for marker in markers.iter().filter(|marker| !marker.is_empty()) {
                by_marker.insert(marker.clone(), index);
            }
            ends.resize(cards.len(), Default::default());
            ends[index] = markers;
        }
    }
    cards
}

/// Begins a card with its first line and returns its index; adds an error if the line has no name.
fn begun(line: &LineFields, cards: &mut Vec<Card>, findings: &mut ImportFindings) -> Option<usize> {
    let name = line.head.trim_end_matches('*').trim_end().to_owned();
    if !plain(&name) {
        let finding = ImportFinding::new(line.at, "", "must be a card name").with_found(&line.head);
        let hint = "a name consists of letters and digits; deletion by `/` is not supported";
        findings.error(finding.hint(hint));
        return None;
    }
    cards.push(Card {
        name,
        at: line.at,
        fields: line.fields.clone(),
    });
    Some(cards.len() - 1)
}

/// The index of the card that a line continues; `None` if that card could not be read, or, with an error, if there is none.
fn continued(
    line: &LineFields,
    cards: &[Card],
    ends: &[[String; 2]],
    by_marker: &BTreeMap<String, usize>,
    current: Option<usize>,
    findings: &mut ImportFindings,
) -> Option<usize> {
    let marker = line.head.get(1..).unwrap_or_default().trim();
    let ends_with = |index: &usize| ends[*index].iter().any(|end| end == marker);
    if !marker.is_empty() && !current.as_ref().is_some_and(ends_with) {
        let other = by_marker.get(marker).copied().filter(ends_with);
        if other.is_some() {
            return other;
        }
    }
    let Some(index) = current else {
        if cards.is_empty() {
            let expected = "must not be a continuation, because no card precedes it";
            let finding = ImportFinding::new(line.at, "", expected);
            findings.error(
                finding.hint(
                    "a line that begins with blanks, `+` or `*` continues the preceding line",
                ),
            );
        }
        return None;
    };
    if line.gap && line.head.is_empty() {
        let expected = "must not be continued after a blank line";
        let finding = ImportFinding::new(line.at, &cards[index].name, expected);
        findings.error(finding.hint("begin the continuation line with + in column 1"));
    }
    let [_, expected] = &ends[index];
    if !expected.is_empty() && !marker.is_empty() && !ends_with(&index) {
        let finding = ImportFinding::new(
            line.at,
            &cards[index].name,
            format!("must be continued by a line with the marker {expected}"),
        );
        let hint = "continuation lines must follow the line that ends with their marker";
        findings.error(finding.with_found(marker).hint(hint));
    }
    Some(index)
}

/// The markers of continuations that the tenth field of a line may mean: without its first character, and without `+` or
/// `*`, which is what is before the marker in free format.
fn markers(tail: &str) -> [String; 2] {
    let rest = tail.chars().skip(1).collect::<String>().trim().to_owned();
    let plain = tail.trim().trim_start_matches(['+', '*']).trim().to_owned();
    [rest, plain]
}

fn plain(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdf::field::{Number, number};

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

    /// Cards as text in free format.
    fn written(text: &str) -> Vec<String> {
        let (cards, findings) = read(text);
        assert!(!findings.has_errors(), "{text}: {:?}", findings.errors());
        cards
            .iter()
            .map(|card| format!("{},{}", card.name, texts(card).join(",")))
            .collect()
    }

    /// The examples of the NASTRAN user's manual (NASA), section 2.4.1.2.1, with the numbers that increments give.
    #[test]
    fn replication_gives_the_cards_of_the_manual() {
        let grids = [
            "GRID,2,3,1.0,2.0,,4,316",
            "GRID,3,3,1.2E0,2.0,,4,316",
            "GRID,4,3,1.4E0,2.0,,4,316",
            "GRID,5,3,1.6E0,2.0,,4,316",
            "GRID,6,3,1.8E0,2.0,,4,316",
        ];
        let near = |text: &str| {
            let round = |field: &str| match number(field) {
                Some(Number::Real(value)) if field.contains('E') => {
                    format!("{:E}", (value * 1e9).round() / 1e9)
                }
                _ => field.to_owned(),
            };
            let rounded: Vec<String> = text.split(',').map(round).collect();
            rounded.join(",")
        };
        for text in [
            "GRID, 2, 3, 1.0 2.0,, 4,316\n=, *(1), =, *(.2), ==\n=(3)",
            "grid,2,3,1.0,2.0,,4,316\n=(4),*(1),=,%(1.8),==",
            "GRID, 2, 3, 1.0 2.0,, 4,316\n=,*1,=,*.2,==\n=3",
        ] {
            let found: Vec<String> = written(text).iter().map(|card| near(card)).collect();
            assert_eq!(found, grids, "{text}");
        }
        assert_eq!(written("Grid, 2 3 1.0 2.0, 7) 4, 316"), grids[..1]);
        let text = "PBAR, 3, 4, 5.0 , 6.0, )+ABC-1\n= , *(1), =, *(2.)  ==\n=(2)\n+ABC-1, 7.7  8.8  9.  )+DEF-22\n=(3),==";
        assert_eq!(
            written(text),
            [
                "PBAR,3,4,5.0,6.0,,,,,7.7,8.8,9.",
                "PBAR,4,4,7E0,6.0,,,,,7.7,8.8,9.",
                "PBAR,5,4,9E0,6.0,,,,,7.7,8.8,9.",
                "PBAR,6,4,1.1E1,6.0,,,,,7.7,8.8,9."
            ]
        );
        // rule 25: each slash is the field before it
        let slashes = written("CQUAD2,101,1,11,12,16,15\n=(2),*(1),=,*(1),///");
        assert_eq!(
            slashes,
            written("CQUAD2,101,1,11,12,16,15\n=(2),*(1),=,*(1),*(1),*(1),*(1)")
        );
        assert_eq!(slashes[2], "CQUAD2,103,1,13,14,18,17");
        // rule 12: a parenthesis is the tenth field of the line before
        let text = "Tabled3,62, 126.9, 30.0 10)+abc\n),  1.23e+4,  5.67+8, 1234567. endt";
        assert_eq!(
            written(text),
            ["TABLED3,62,126.9,30.0,,,,,,1.23E+4,5.67+8,1234567.,ENDT"]
        );
        // fields that are the same as in the line before, in a line with a name of its own
        assert_eq!(
            written("GRID,1,0,0.,75.,0.,,345\nGRID,2,=,53.,==")[1],
            "GRID,2,0,53.,75.,0.,,345"
        );
    }

    #[test]
    fn replication_that_has_no_meaning_is_refused() {
        for (text, expected) in [
            ("=,*(1)", "must follow a line whose fields it repeats"),
            (
                "GRID,1\n=(3)",
                "must follow a line with the increments that it repeats",
            ),
            (
                "GRID,1\n=(0),*(1)",
                "must be =, or = with a number of copies above 0",
            ),
            (
                "GRID,1\n=,*(.5)",
                "must be an increment of the same type as the field of the line before",
            ),
            (
                "GRID,1\n=,=,*(1)",
                "must be an increment of the same type as the field of the line before",
            ),
            (
                "GRID,1\n=(2),%(4)",
                "must be reached by equal whole increments",
            ),
            (
                "GRID,1\n=       *(1)",
                "must have commas between its fields",
            ),
            (
                "GRID*,1,,2.,3.\n=,*(1),==",
                "must not repeat fields of lines in large field format",
            ),
            (
                "GRID,1\n=(9999999999),*(1)",
                "must not make more than 200000 lines by replication",
            ),
            (
                "GRID,9223372036854775807\n=,*(1)",
                "must give a number within the range of its type",
            ),
            (
                "PBAR,1,1,.1,,,,,,+A\n+A,1.,2.\n=,*(1),==",
                "must not repeat a continuation line whose marker has no number",
            ),
            ("CBAR,1,1,1 2,0.,0.,1.", "must be separated by a comma"),
        ] {
            let errors = read(text).1.errors();
            let found: Vec<&str> = errors.iter().map(|error| error.expected.as_str()).collect();
            assert_eq!(found.first(), Some(&expected), "{text}: {found:?}");
        }
    }

    #[test]
    fn blanks_separate_fields_in_free_format() {
        assert_eq!(
            written(
                "CBAR,  1, 1,  1, 2,  0.  0.  1.0  1\nPBAR, 1  11 .785 .049 .049 .098\n,    1.  0. 0."
            ),
            [
                "CBAR,1,1,1,2,0.,0.,1.0,1",
                "PBAR,1,11,.785,.049,.049,.098,,,1.,0.,0."
            ]
        );
        // a comma behind fields in columns does not make a line free, nor do the commas of equations
        let (cards, _) = read("MAT1    1       2.1,+11 .3");
        assert_eq!(texts(&cards[0])[..2], ["1", "2.1,+11"]);
        let (cards, findings) =
            read("DEQATN  1       F(A,B)=A\n        +MAX(A, B) * 2. + A * B + A * A + B * B");
        assert!(
            !findings.has_errors() && cards.len() == 1,
            "{:?}",
            findings.errors()
        );
    }

    #[test]
    fn continuations_follow_their_markers() {
        let line = |head: &str, fields: &str, tail: &str| format!("{head:<8}{fields:<64}{tail}");
        let of = |tail: &str, head: &str| {
            [
                line("PBAR", "1       1       .1", tail),
                line(head, "1.", ""),
            ]
            .join("\n")
        };
        // the first character of the tenth field has no meaning
        for (tail, head) in [
            ("+CD1", "+CD1"),
            ("CCD1", "+CD1"),
            (" CD1", "+CD1"),
            ("QCD1", "*CD1"),
            ("+CD1", "+"),
            ("", "+CD1"),
        ] {
            assert_eq!(
                written(&of(tail, head)),
                ["PBAR,1,1,.1,,,,,,1."],
                "{tail} {head}"
            );
        }
        let errors = read(&of("+CD1", "+CD2")).1.errors();
        assert_eq!(
            errors[0].expected,
            "must be continued by a line with the marker CD1"
        );
        // lines of an unsorted deck continue the card that ends with their marker
        let text = "PBAR,1,6,.1,,,,,,+P1\nPBAR,2,6,.2,,,,,,+P2\nMAT1,6,1.+7\n+P1,1.,,,,,,,,+P3\n+P2,2.\n+P3,3.";
        assert_eq!(
            written(text),
            [
                "PBAR,1,6,.1,,,,,,1.,,,,,,,,3.",
                "PBAR,2,6,.2,,,,,,2.",
                "MAT1,6,1.+7"
            ]
        );
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
            ("=       1", "must have commas between its fields"),
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
