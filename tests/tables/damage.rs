//! Files with random damage: refused or taken, never a panic, never a number that is none.

use formats::tables::{TableFormat, expand, factor, read, round, write};
use splines::Rank;

use super::{Dice, ENDINGS, FT_LBF, bytes, data, random_factored, random_set};

const PIECES: [&[u8]; 24] = [
    b"0",
    b"-1",
    b"1e308",
    b"1e999",
    b"nan",
    b",",
    b";",
    b"\n",
    b"\"",
    b"'",
    b"&",
    b"=",
    b"(",
    b"{",
    b"]",
    b"\xff",
    b"\x00",
    b"\xef\xbb\xbf",
    b"!",
    b"#",
    b"99999999999",
    b"x",
    b"Y = ",
    b"(2, 3)",
];

fn damaged(bytes: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=dice.below(4) {
        let (from, length) = (dice.below(out.len()), dice.below(12));
        let to = (from + length).min(out.len());
        let piece = PIECES[dice.below(PIECES.len())];
        match dice.below(5) {
            0 => out.truncate(from),
            1 => drop(out.drain(from..to)),
            2 => {
                if let Some(byte) = out.get_mut(from) {
                    *byte ^= 1 << dice.below(8);
                }
            }
            3 => drop(out.splice(from..to, piece.iter().copied())),
            _ => drop(out.splice(from..from, piece.iter().copied())),
        }
    }
    out
}

fn tried(name: &str, bytes: &[u8]) -> bool {
    let set = match read(name, bytes, Some(FT_LBF)) {
        Err(wrong) => {
            assert!(
                !wrong.is_empty()
                    && wrong
                        .iter()
                        .all(|one| one.file == name && !one.expected.is_empty())
            );
            return false;
        }
        Ok(set) => set,
    };
    let finite = |set: &formats::tables::TableSet| {
        set.tables.iter().all(|table| {
            table
                .curves
                .y()
                .iter()
                .flatten()
                .all(|value| value.is_finite())
        })
    };
    assert!(finite(&set));
    let _ = round(&set, 3).map(|(set, _)| assert!(finite(&set)));
    assert!(finite(&expand(&set)));
    let _ = factor(&set, Rank::Count(2));
    for ending in ENDINGS {
        let _ = write(
            &set,
            TableFormat::of(&format!("a.{ending}")).expect("a format"),
        );
    }
    true
}

#[test]
fn damaged_files_are_refused_or_taken() {
    let mut dice = Dice::new(51);
    let mut taken = 0;
    for ending in ENDINGS {
        let name = format!("a.{ending}");
        for _ in 0..4 {
            for set in [random_set(&mut dice), random_factored(&mut dice)] {
                let bytes =
                    write(&set, TableFormat::of(&name).expect("a format")).expect("writable");
                for _ in 0..150 {
                    taken += usize::from(tried(&name, &damaged(&bytes, &mut dice)));
                }
            }
        }
    }
    assert!(taken > 100, "only {taken} were taken");
}

#[test]
fn damaged_archives_of_numpy_are_refused_or_taken() {
    let mut dice = Dice::new(52);
    for name in ["plain.npz", "packed.npz", "oblong.npz"] {
        let bytes = bytes(&data(name));
        for _ in 0..1500 {
            tried(name, &damaged(&bytes, &mut dice));
        }
    }
}
