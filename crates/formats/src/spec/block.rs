//! Items of `cell_data` as written: one for each cell of a block, or a single one for the whole block.
//!
//! A list contains either the items of the cells or, if an item is itself a list, the single item of the block. Its
//! entries decide: if they are numbers (of a vector) or keywords (of a list of degrees of freedom), the list is one
//! item.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

/// The items of one key for one block of cells.
#[derive(Debug, PartialEq)]
pub(crate) enum Block<T> {
    /// An item for each cell.
    Each(Vec<T>),
    /// One item for all cells.
    All(T),
    /// No item: the default applies.
    Absent,
}

impl<T> Block<T> {
    /// The item of the cell of this index.
    pub fn get(&self, index: usize) -> Option<&T> {
        match self {
            Block::Each(items) => items.get(index),
            Block::All(item) => Some(item),
            Block::Absent => None,
        }
    }
}

/// A reference to an item of a list: its index or its name.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// An index, counted from 0.
    Index(usize),
    /// A name.
    Name(String),
}

impl<'de> Deserialize<'de> for Reference {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;

        impl Visitor<'_> for Words {
            type Value = Reference;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an index, counted from 0, or a name")
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Reference, E> {
                usize::try_from(value)
                    .map(Reference::Index)
                    .map_err(E::custom)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Reference, E> {
                Ok(Reference::Name(word.to_owned()))
            }
        }

        deserializer.deserialize_any(Words)
    }
}

/// A type of items that may be given as a list with one item per cell, or as one item for the whole block.
pub trait Item: Sized + for<'de> Deserialize<'de> {
    /// The expected value, for messages.
    const WHAT: &'static str;

    /// The item that a number represents, if any.
    fn of_index(_: usize) -> Option<Self> {
        None
    }

    /// The item that a text represents, if any.
    fn of_word(_: &str) -> Option<Self> {
        None
    }

    /// Interprets a list as the items of the cells, or as one item of the block.
    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Block<Self>, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(list)).map(Block::Each)
    }
}

impl Item for String {
    const WHAT: &'static str =
        "a keyword for the whole block, or a list with a keyword for each cell";

    fn of_word(word: &str) -> Option<Self> {
        Some(word.to_owned())
    }
}

impl Item for Reference {
    const WHAT: &'static str =
        "a section for the whole block, or a list with a section for each cell";

    fn of_index(index: usize) -> Option<Self> {
        Some(Reference::Index(index))
    }

    fn of_word(word: &str) -> Option<Self> {
        Some(Reference::Name(word.to_owned()))
    }
}

impl Item for Option<Reference> {
    const WHAT: &'static str = Reference::WHAT;

    fn of_index(index: usize) -> Option<Self> {
        Some(Reference::of_index(index))
    }

    fn of_word(word: &str) -> Option<Self> {
        Some(Reference::of_word(word))
    }
}

impl Item for Option<usize> {
    const WHAT: &'static str =
        "a number for the whole block, or a list with a number for each cell";

    fn of_index(index: usize) -> Option<Self> {
        Some(Some(index))
    }
}

/// One entry of a list: a leaf, which is part of a single item of the whole block, or an item of a cell.
enum Entry<L, T> {
    Leaf(L),
    Item(T),
}

/// Classifies a list by its entries. `of_leaves` makes an item of leaves, and rejects a wrong number of them.
fn classified<L, T, E: Error>(
    entries: Vec<Entry<L, T>>,
    what: &'static str,
    of_leaves: impl FnOnce(Vec<L>) -> Result<T, E>,
) -> Result<Block<T>, E> {
    let (mut leaves, mut items) = (Vec::new(), Vec::new());
    for entry in entries {
        match entry {
            Entry::Leaf(leaf) => leaves.push(leaf),
            Entry::Item(item) => items.push(item),
        }
    }
    match (leaves.is_empty(), items.is_empty()) {
        (false, false) => Err(E::custom(format_args!(
            "invalid type: a mixture of both, expected {what}"
        ))),
        (false, true) => of_leaves(leaves).map(Block::All),
        (true, _) => Ok(Block::Each(items)),
    }
}

impl<'de> Deserialize<'de> for Entry<f64, [f64; 3]> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Entry<f64, [f64; 3]>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of 3 numbers")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                Ok(Entry::Leaf(value))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                Ok(Entry::Leaf(value as f64))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
                Ok(Entry::Leaf(value as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
                <[f64; 3]>::deserialize(SeqAccessDeserializer::new(list)).map(Entry::Item)
            }
        }

        deserializer.deserialize_any(Numbers)
    }
}

impl Item for [f64; 3] {
    const WHAT: &'static str =
        "a vector for the whole block, or a list with a vector for each cell";

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Block<Self>, A::Error> {
        let entries = Vec::deserialize(SeqAccessDeserializer::new(list))?;
        classified(entries, Self::WHAT, |numbers: Vec<f64>| {
            let count = numbers.len();
            numbers
                .try_into()
                .map_err(|_| A::Error::invalid_length(count, &"a list of 3 numbers"))
        })
    }
}

impl<'de> Deserialize<'de> for Entry<String, Vec<String>> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;

        impl<'de> Visitor<'de> for Words {
            type Value = Entry<String, Vec<String>>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Self::Value, E> {
                Ok(Entry::Leaf(word.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Entry::Item)
            }
        }

        deserializer.deserialize_any(Words)
    }
}

impl Item for Vec<String> {
    const WHAT: &'static str = "a list of degrees of freedom for the whole block, or a list with such a list for each cell";

    fn list<'de, A: SeqAccess<'de>>(list: A) -> Result<Block<Self>, A::Error> {
        let entries: Vec<Entry<String, Self>> = Vec::deserialize(SeqAccessDeserializer::new(list))?;
        // an empty list means no degrees of freedom for the whole block, regardless of the number of its cells
        if entries.is_empty() {
            Ok(Block::Absent)
        } else {
            classified(entries, Self::WHAT, Ok)
        }
    }
}

impl<'de, T: Item> Deserialize<'de> for Block<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Blocks(PhantomData))
    }
}

/// Visitor of a [`Block`].
struct Blocks<T>(PhantomData<T>);

impl<'de, T: Item> Visitor<'de> for Blocks<T> {
    type Value = Block<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(T::WHAT)
    }

    fn visit_unit<E: Error>(self) -> Result<Block<T>, E> {
        Ok(Block::Absent)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Block<T>, E> {
        let index = usize::try_from(value).ok().and_then(T::of_index);
        index
            .map(Block::All)
            .ok_or_else(|| E::invalid_type(serde::de::Unexpected::Unsigned(value), &self))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Block<T>, E> {
        let found = T::of_word(word);
        found
            .map(Block::All)
            .ok_or_else(|| E::invalid_type(serde::de::Unexpected::Str(word), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Block<T>, A::Error> {
        T::list(list)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    #[test]
    fn a_block_has_an_item_for_each_cell_or_one_for_all() {
        let up = [0.0, 1.0, 0.0];
        assert_eq!(of("[0, 1, 0]"), Ok(Block::All(up)));
        assert_eq!(
            of("[[0, 1, 0], [0, 1, 0.0]]"),
            Ok(Block::Each(vec![up, up]))
        );
        assert_eq!(of("null"), Ok(Block::<[f64; 3]>::Absent));
        let hinge = vec!["ry".to_owned(), "rz".to_owned()];
        assert_eq!(of("[\"ry\", \"rz\"]"), Ok(Block::All(hinge.clone())));
        assert_eq!(
            of("[[\"ry\", \"rz\"], []]"),
            Ok(Block::Each(vec![hinge, Vec::new()]))
        );
        assert_eq!(
            of("\"column\""),
            Ok(Block::All(Reference::Name("column".to_owned())))
        );
        let two = vec![Reference::Index(2), Reference::Name("strut".to_owned())];
        assert_eq!(of("[2, \"strut\"]"), Ok(Block::Each(two)));
        assert_eq!(of("3"), Ok(Block::All(Some(3usize))));
        assert_eq!(of("\"truss\""), Ok(Block::All("truss".to_owned())));
    }

    #[test]
    fn an_empty_list_has_no_cells_or_no_dofs() {
        assert_eq!(of("[]"), Ok(Block::<String>::Each(Vec::new())));
        assert_eq!(of("[]"), Ok(Block::<Vec<String>>::Absent));
    }

    #[test]
    fn what_is_neither_is_refused() {
        for text in ["[0, 1]", "[0, [0, 1, 0]]", "\"up\"", "2"] {
            assert!(of::<Block<[f64; 3]>>(text).is_err(), "{text}");
        }
        assert!(of::<Block<Reference>>("-1").is_err());
        assert!(of::<Block<Vec<String>>>("[\"ry\", [\"rz\"]]").is_err());
    }
}
