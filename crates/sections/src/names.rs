//! Names of sections and rails as users write them.

/// Number of near names in a hint.
const NEAR: usize = 4;
/// Length of a name above which no name is near, since all are shorter.
const LONG: usize = 24;

/// A name without blanks, in capitals: `HEB400` for `heb 400`, `W24X94` for `W 24x94`.
pub fn plain(name: &str) -> String {
    name.chars()
        .filter(|letter| !letter.is_whitespace())
        .map(|letter| {
            if letter == '\u{d7}' {
                'X'
            } else {
                letter.to_ascii_uppercase()
            }
        })
        .collect()
}

/// Whether `pattern` is a part of `name`, where blanks and case do not count.
#[must_use]
pub fn matches(name: &str, pattern: &str) -> bool {
    plain(name).contains(&plain(pattern))
}

/// The names that are nearest to `wrong` by edit distance, and of these by the numbers in them; empty if all are far.
pub fn nearest(wrong: &str, names: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    let own = plain(wrong);
    if own.len() > LONG {
        return Vec::new();
    }
    let allowed = (own.chars().count() / 2).clamp(1, 3);
    let mut found: Vec<(usize, u64, &'static str)> = names
        .map(|name| {
            let other = plain(name);
            (distance(&own, &other), difference(&own, &other), name)
        })
        .filter(|(edits, _, _)| *edits <= allowed)
        .collect();
    found.sort();
    found
        .into_iter()
        .take(NEAR)
        .map(|(_, _, name)| name)
        .collect()
}

/// Sum of the differences between the whole numbers of two names, in order.
fn difference(a: &str, b: &str) -> u64 {
    let numbers = |name: &str| -> Vec<u64> {
        let parts = name.split(|letter: char| !letter.is_ascii_digit());
        parts.filter_map(|part| part.parse().ok()).collect()
    };
    let pairs = numbers(a).into_iter().zip(numbers(b));
    pairs.fold(0, |sum, (one, other)| {
        sum.saturating_add(one.abs_diff(other))
    })
}

/// Edit distance between two words: insertions, deletions and substitutions.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut before = row[0];
        row[0] = i + 1;
        for (j, other) in b.iter().enumerate() {
            let best = (before + usize::from(letter != *other))
                .min(row[j] + 1)
                .min(row[j + 1] + 1);
            before = std::mem::replace(&mut row[j + 1], best);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_and_case_do_not_count() {
        assert_eq!(plain(" heb 400 "), "HEB400");
        assert_eq!(plain("W24\u{d7}94"), "W24X94");
        assert!(matches("HEB 400", "b4"));
        assert!(!matches("HEB 400", "A4"));
    }

    #[test]
    fn the_nearest_names_come_first() {
        let names = ["HEB 360", "HEB 400", "HEB 450", "IPE 400"];
        assert_eq!(
            nearest("HEB 410", names.into_iter()),
            ["HEB 400", "HEB 450", "HEB 360"]
        );
        assert!(nearest("oak beam", names.into_iter()).is_empty());
        assert!(nearest(&"HEB400".repeat(1000), names.into_iter()).is_empty());
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
