//! An array: its shape, and its items, which are numbers or strings.

use super::header::{self, Header};

/// An array in C order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    pub shape: Vec<usize>,
    pub data: Data,
}

/// The items of an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Data {
    Numbers(Vec<f64>),
    Words(Vec<String>),
}

/// Why bytes cannot be read as an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Refusal {
    /// They are not an array.
    NoArray,
    /// An item type that is neither a real number nor a string.
    Kind(String),
    /// The size of the data does not match the shape.
    Size { expected: usize, found: usize },
}

impl Array {
    /// A one-dimensional array of strings.
    pub fn words(list: &[String]) -> Array {
        Array {
            shape: vec![list.len()],
            data: Data::Words(list.to_vec()),
        }
    }

    /// A one-dimensional array of numbers.
    pub fn line(list: &[f64]) -> Array {
        Array {
            shape: vec![list.len()],
            data: Data::Numbers(list.to_vec()),
        }
    }

    /// The array of the bytes of an `.npy` file.
    pub fn read(bytes: &[u8]) -> Result<Array, Refusal> {
        let (header, data) = header::split(bytes).ok_or(Refusal::NoArray)?;
        let kind = Kind::of(&header.descr).ok_or_else(|| Refusal::Kind(header.descr.clone()))?;
        let size = kind.size();
        let count = header
            .shape
            .iter()
            .try_fold(1_usize, |all, &one| all.checked_mul(one));
        let expected = count
            .and_then(|count| count.checked_mul(size))
            .unwrap_or(usize::MAX);
        if data.len() != expected {
            return Err(Refusal::Size {
                expected,
                found: data.len(),
            });
        }
        let items: Vec<&[u8]> = if size == 0 {
            vec![&[]; count.unwrap_or(0).min(1)]
        } else {
            data.chunks(size).collect()
        };
        let data = match kind {
            Kind::Words { .. } => Data::Words(items.iter().map(|item| kind.word(item)).collect()),
            _ => Data::Numbers(items.iter().map(|item| kind.number(item)).collect()),
        };
        Ok(Array {
            data,
            shape: header.shape.clone(),
        }
        .c_order(&header))
    }

    /// Converts an array whose items are in the order of its header to C order.
    fn c_order(self, header: &Header) -> Array {
        if !header.fortran || self.shape.len() < 2 {
            return self;
        }
        let Array { shape, data } = self;
        let data = match data {
            Data::Numbers(list) => Data::Numbers(reordered(&shape, &list)),
            Data::Words(list) => Data::Words(reordered(&shape, &list)),
        };
        Array { shape, data }
    }

    /// The bytes of an `.npy` file. Numbers are written as 64-bit integers if `whole`, otherwise as doubles; strings
    /// are written with four bytes per character.
    pub fn bytes(&self, whole: bool) -> Vec<u8> {
        match &self.data {
            Data::Numbers(list) if whole => {
                let mut out = header::bytes("<i8", &self.shape);
                out.extend(list.iter().flat_map(|value| (*value as i64).to_le_bytes()));
                out
            }
            Data::Numbers(list) => {
                let mut out = header::bytes("<f8", &self.shape);
                out.extend(list.iter().flat_map(|value| value.to_le_bytes()));
                out
            }
            Data::Words(list) => {
                let width = list
                    .iter()
                    .map(|word| word.chars().count())
                    .max()
                    .unwrap_or(0)
                    .max(1);
                let mut out = header::bytes(&format!("<U{width}"), &self.shape);
                for word in list {
                    let letters = word
                        .chars()
                        .map(u32::from)
                        .chain(std::iter::repeat(0))
                        .take(width);
                    out.extend(letters.flat_map(u32::to_le_bytes));
                }
                out
            }
        }
    }
}

/// Reorders items from Fortran order (first index fastest) to C order (last index fastest).
fn reordered<T: Clone>(shape: &[usize], list: &[T]) -> Vec<T> {
    let mut strides = Vec::with_capacity(shape.len());
    let mut step = 1;
    for size in shape {
        strides.push(step);
        step *= size;
    }
    // index in Fortran order of the k-th item in C order
    let place = |mut k: usize| {
        let mut at = 0;
        for (size, stride) in shape.iter().zip(&strides).rev() {
            at += (k % size) * stride;
            k /= size;
        }
        at
    };
    (0..list.len()).map(|k| list[place(k)].clone()).collect()
}

/// Type of the items, from `descr` of the header.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Float {
        size: usize,
        big: bool,
    },
    Signed {
        size: usize,
        big: bool,
    },
    Unsigned {
        size: usize,
        big: bool,
    },
    /// `wide`: four bytes per character, otherwise one.
    Words {
        count: usize,
        big: bool,
        wide: bool,
    },
}

impl Kind {
    fn of(descr: &str) -> Option<Kind> {
        let mut characters = descr.chars();
        let order = characters.next()?;
        let big = match order {
            '<' | '|' | '=' => false,
            '>' => true,
            _ => return None,
        };
        let kind = characters.next()?;
        let size: usize = characters.as_str().parse().ok()?;
        match (kind, size) {
            ('f', 4 | 8) => Some(Kind::Float { size, big }),
            ('i', 1 | 2 | 4 | 8) => Some(Kind::Signed { size, big }),
            ('u', 1 | 2 | 4 | 8) => Some(Kind::Unsigned { size, big }),
            ('U', _) if size <= 1 << 20 => Some(Kind::Words {
                count: size,
                big,
                wide: true,
            }),
            ('S', _) if size <= 1 << 20 => Some(Kind::Words {
                count: size,
                big,
                wide: false,
            }),
            _ => None,
        }
    }

    /// Size of an item in bytes.
    fn size(self) -> usize {
        match self {
            Kind::Float { size, .. } | Kind::Signed { size, .. } | Kind::Unsigned { size, .. } => {
                size
            }
            Kind::Words { count, wide, .. } => count * if wide { 4 } else { 1 },
        }
    }

    fn number(self, item: &[u8]) -> f64 {
        let whole = |big: bool| {
            let add = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
            if big {
                item.iter().fold(0, add)
            } else {
                item.iter().rev().fold(0, add)
            }
        };
        match self {
            Kind::Float { size: 4, big } => f64::from(f32::from_bits(whole(big) as u32)),
            Kind::Float { big, .. } => f64::from_bits(whole(big)),
            Kind::Signed { size, big } => {
                let unused = 64 - 8 * size as u32;
                ((whole(big) << unused) as i64 >> unused) as f64
            }
            Kind::Unsigned { big, .. } => whole(big) as f64,
            Kind::Words { .. } => f64::NAN,
        }
    }

    fn word(self, item: &[u8]) -> String {
        let Kind::Words { big, wide, .. } = self else {
            return String::new();
        };
        let text: String = if wide {
            let letter = |four: &[u8]| {
                let four: [u8; 4] = four.try_into().unwrap_or_default();
                let code = if big {
                    u32::from_be_bytes(four)
                } else {
                    u32::from_le_bytes(four)
                };
                char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER)
            };
            item.chunks(4).map(letter).collect()
        } else {
            String::from_utf8_lossy(item).into_owned()
        };
        text.trim_end_matches('\0').to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_read_in_either_byte_order_and_size() {
        for (descr, bytes, value) in [
            ("<f4", &[0x00, 0x00, 0xc0, 0x3f][..], 1.5),
            (">f4", &[0x3f, 0xc0, 0x00, 0x00], 1.5),
            ("|i1", &[0xff], -1.0),
            ("<i2", &[0xfe, 0xff], -2.0),
            (">i4", &[0x00, 0x00, 0x01, 0x00], 256.0),
            ("|u1", &[0xff], 255.0),
            (">f8", &[0xbf, 0xf0, 0, 0, 0, 0, 0, 0], -1.0),
        ] {
            let array = [header::bytes(descr, &[1]), bytes.to_vec()].concat();
            assert_eq!(Array::read(&array), Ok(Array::line(&[value])), "{descr}");
        }
        for descr in ["|O", "<c16", "<f2", "|b1", "", "<f", "<M8[ns]"] {
            let array = header::bytes(descr, &[0]);
            assert_eq!(
                Array::read(&array),
                Err(Refusal::Kind(descr.to_owned())),
                "{descr}"
            );
        }
    }

    #[test]
    fn words_and_numbers_read_back() {
        let words = Array::words(&[
            "ft".to_owned(),
            "\u{e9}lan \u{1f680}".to_owned(),
            String::new(),
        ]);
        assert_eq!(Array::read(&words.bytes(false)), Ok(words));
        let numbers = Array::line(&[-3.0, 0.0, 7.0]);
        assert_eq!(Array::read(&numbers.bytes(true)), Ok(numbers.clone()));
        assert_eq!(Array::read(&numbers.bytes(false)), Ok(numbers));
    }

    #[test]
    fn fortran_order_is_turned() {
        assert_eq!(reordered(&[2, 3], &[1, 4, 2, 5, 3, 6]), [1, 2, 3, 4, 5, 6]);
    }

    #[test]
    fn a_shape_that_promises_too_much_is_refused() {
        let huge = header::bytes("<f8", &[usize::MAX, 2]);
        assert!(matches!(
            Array::read(&huge),
            Err(Refusal::Size { found: 0, .. })
        ));
        let short = [header::bytes("<f8", &[2]), vec![0; 15]].concat();
        assert_eq!(
            Array::read(&short),
            Err(Refusal::Size {
                expected: 16,
                found: 15
            })
        );
    }
}
