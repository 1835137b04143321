//! Conversion of a located tree to the types of a format.
//!
//! A value is converted by serde. If a value has the wrong type, or a key is unknown or duplicate, the fault is
//! recorded with its place, and the member or item is marked as left out. The whole tree is then converted again
//! without it, and this is repeated until no further fault occurs. Derived types therefore need no code for error
//! recovery, and a correct text is converted once. In place of an item of a list that is left out, its neighbour is
//! converted, so that the other items keep their indices. A value that fails only because a part of it has been left
//! out (for example a vector without any valid item) is left out without a fault of its own. The conversion stops
//! where the text is truncated.

use std::collections::BTreeSet;
use std::fmt;

use serde::de::value::StrDeserializer;
use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, Unexpected, Visitor};
use serde::forward_to_deserialize_any;

use super::fault::Fault;
use super::place::{Path, Place};
use super::tree::{TreeMember, TreeNode, Value};
use super::wording::{is_duplicate, meant_key, type_fault};

/// Maximum number of faults that are collected from one text.
const MOST: usize = 100;

/// A fault of the conversion, with its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Located {
    /// What is wrong.
    pub fault: Fault,
    /// Byte offset of the value or key that the fault concerns.
    pub offset: usize,
}

/// A tree that has been converted as far as possible.
#[derive(Debug)]
pub(crate) struct Conversion<T> {
    /// The value without the parts that are left out; there is none if the remainder cannot be converted.
    pub value: Option<T>,
    /// The faults. The first one is the first in the text.
    pub faults: Vec<Located>,
    /// Paths of the values that are left out.
    pub lost: Vec<Path>,
}

/// Converts a tree.
pub(crate) fn convert<'de, T: Deserialize<'de>>(root: &'de TreeNode<'de>) -> Conversion<T> {
    let mut left_out = BTreeSet::new();
    let mut found = Conversion {
        value: None,
        faults: Vec::new(),
        lost: Vec::new(),
    };
    while found.faults.len() < MOST {
        match pass(root, &left_out) {
            Ok(value) => {
                found.value = Some(value);
                break;
            }
            Err(Stop::At(part)) => {
                found.faults.extend(part.located);
                found.lost.extend(part.lost);
                if part.start == root.start || !left_out.insert(part.start) {
                    break;
                }
            }
            Err(Stop::Message(_) | Stop::Excess { .. } | Stop::Broken) => break,
        }
    }
    found
}

fn pass<'de, T: Deserialize<'de>>(
    root: &'de TreeNode<'de>,
    left_out: &BTreeSet<usize>,
) -> Result<T, Stop> {
    let place = Place::root();
    let reader = Reader {
        node: root,
        place: &place,
        left_out,
    };
    T::deserialize(reader).map_err(|stop| stop.at(&reader))
}

/// The reason why a conversion stops.
#[derive(Debug)]
enum Stop {
    /// A message of serde whose place has not been determined yet.
    Message(String),
    /// A list of so many items has more than `most`.
    Excess { items: usize, most: usize },
    /// A value cannot be converted.
    At(Box<Unconverted>),
    /// The text is truncated here.
    Broken,
}

/// A value that cannot be converted.
#[derive(Debug)]
struct Unconverted {
    /// Byte offset of its beginning.
    start: usize,
    /// Its fault; there is none if the failure is a consequence of other faults.
    located: Option<Located>,
    /// Path of the value that is missing or uncertain without it.
    lost: Option<Path>,
}

impl Stop {
    /// Assigns the place of a value, unless a place within it has already been assigned.
    #[cold]
    fn at(self, reader: &Reader<'_, '_>) -> Stop {
        let node = reader.node;
        let message = match self {
            Stop::Message(message) => message,
            Stop::Excess { items, most } => {
                format!("invalid length {items}, expected an array of length {most}")
            }
            placed @ (Stop::At(_) | Stop::Broken) => return placed,
        };
        let path = reader.place.path();
        if is_duplicate(&message)
            && let Some(second) = node.second_of_a_key()
        {
            let located = Located {
                fault: Fault::duplicate(path, &second.key),
                offset: second.start,
            };
            let (start, lost) = (second.value.start, reader.place.key(&second.key).path());
            return Stop::At(Box::new(Unconverted {
                start,
                located: Some(located),
                lost: Some(lost),
            }));
        }
        let follows = reader
            .left_out
            .range(node.start..)
            .next()
            .is_some_and(|start| *start < node.end);
        let located = Located {
            fault: type_fault(path.clone(), &message),
            offset: node.start,
        };
        let located = (!follows).then_some(located);
        Stop::At(Box::new(Unconverted {
            start: node.start,
            located,
            lost: Some(path),
        }))
    }

    /// Assigns the place of the key of a member. If another key was probably meant, its value is missing.
    #[cold]
    fn at_key(self, member: &TreeMember<'_>, place: &Place<'_>) -> Stop {
        let Stop::Message(message) = self else {
            return self;
        };
        let fault = type_fault(place.key(&member.key).path(), &message);
        let lost = meant_key(&fault).map(|key| place.key(key).path());
        let located = Some(Located {
            fault,
            offset: member.start,
        });
        Stop::At(Box::new(Unconverted {
            start: member.value.start,
            located,
            lost,
        }))
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Message(message) => f.write_str(message),
            Stop::Excess { items, .. } => write!(f, "invalid length {items}"),
            Stop::At(part) => {
                f.write_str(part.located.as_ref().map_or("", |at| &at.fault.expected))
            }
            Stop::Broken => f.write_str("the text breaks off"),
        }
    }
}

impl std::error::Error for Stop {}

/// Displays values as `serde_json` writes them in its messages.
struct Seen<'a>(Unexpected<'a>);

impl fmt::Display for Seen<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Unexpected::Unit => f.write_str("null"),
            Unexpected::Float(value) => write!(f, "floating point `{}`", serde_json::json!(value)),
            other => other.fmt(f),
        }
    }
}

impl de::Error for Stop {
    #[cold]
    fn custom<T: fmt::Display>(message: T) -> Stop {
        Stop::Message(message.to_string())
    }

    #[cold]
    fn invalid_type(seen: Unexpected<'_>, expected: &dyn de::Expected) -> Stop {
        Stop::Message(format!("invalid type: {}, expected {expected}", Seen(seen)))
    }

    #[cold]
    fn invalid_value(seen: Unexpected<'_>, expected: &dyn de::Expected) -> Stop {
        Stop::Message(format!(
            "invalid value: {}, expected {expected}",
            Seen(seen)
        ))
    }
}

/// A value to be converted.
#[derive(Clone, Copy)]
struct Reader<'a, 'de> {
    node: &'de TreeNode<'de>,
    place: &'a Place<'a>,
    /// Byte offsets of the values that are left out.
    left_out: &'a BTreeSet<usize>,
}

impl<'de> Reader<'_, 'de> {
    fn is_left_out(&self, node: &TreeNode<'_>) -> bool {
        !self.left_out.is_empty() && self.left_out.contains(&node.start)
    }

    /// Returns `value` if the text of the list or object is complete.
    fn closed<T>(&self, value: T) -> Result<T, Stop> {
        if self.node.is_whole() {
            Ok(value)
        } else {
            Err(Stop::Broken)
        }
    }

    fn list<V: Visitor<'de>>(
        self,
        items: &'de [TreeNode<'de>],
        visitor: V,
    ) -> Result<V::Value, Stop> {
        let mut rest = Items {
            reader: self,
            items,
            next: 0,
        };
        let value = visitor.visit_seq(&mut rest)?;
        match rest.current() {
            Some(_) => Err(Stop::Excess {
                items: items.len(),
                most: rest.next,
            }),
            None => self.closed(value),
        }
    }
}

impl<'de> Deserializer<'de> for Reader<'_, 'de> {
    type Error = Stop;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match &self.node.value {
            Value::List(items) => self.list(items, visitor),
            Value::Object(members) => visitor
                .visit_map(Members {
                    reader: self,
                    members,
                    next: 0,
                })
                .and_then(|value| self.closed(value)),
            _ if !self.node.is_whole() => Err(Stop::Broken),
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Unsigned(value) => visitor.visit_u64(*value),
            Value::Signed(value) => visitor.visit_i64(*value),
            Value::Float(value) => visitor.visit_f64(*value),
            Value::Text(text) => visitor.visit_borrowed_str(text),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match self.node.value {
            Value::Null if self.node.is_whole() => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Stop> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        match self.node.value {
            // visitors of derived types would accept a list too
            Value::List(_) => Err(de::Error::invalid_type(Unexpected::Seq, &visitor)),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Stop> {
        match self.node.as_text() {
            Some(word) => visitor.visit_enum(de::IntoDeserializer::<Stop>::into_deserializer(word)),
            None => self.deserialize_any(visitor),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Stop> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        seq tuple tuple_struct struct identifier
    }
}

/// The items of a list.
struct Items<'a, 'de> {
    reader: Reader<'a, 'de>,
    items: &'de [TreeNode<'de>],
    next: usize,
}

impl<'de> Items<'_, 'de> {
    /// The item that is converted next, with its index: the next one; or, if it is left out, the nearest item before
    /// it, or otherwise after it.
    fn current(&self) -> Option<(usize, &'de TreeNode<'de>)> {
        let is_valid = |index: &usize| !self.reader.is_left_out(&self.items[*index]);
        let here = self.next;
        if here >= self.items.len() {
            return None;
        }
        let index = if is_valid(&here) {
            Some(here)
        } else {
            let before = || (0..here).rev().find(is_valid);
            let after = || (here + 1..self.items.len()).find(is_valid);
            before().or_else(after)
        };
        index.map(|index| (index, &self.items[index]))
    }
}

impl<'de> de::SeqAccess<'de> for &mut Items<'_, 'de> {
    type Error = Stop;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Stop> {
        let Some((index, node)) = self.current() else {
            return self.reader.closed(None);
        };
        let place = self.reader.place.index(index);
        self.next += 1;
        let item = Reader {
            node,
            place: &place,
            ..self.reader
        };
        seed.deserialize(item)
            .map(Some)
            .map_err(|stop| stop.at(&item))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len() - self.next)
    }
}

/// The members of an object.
struct Members<'a, 'de> {
    reader: Reader<'a, 'de>,
    members: &'de [TreeMember<'de>],
    next: usize,
}

impl<'de> de::MapAccess<'de> for Members<'_, 'de> {
    type Error = Stop;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Stop> {
        while self
            .members
            .get(self.next)
            .is_some_and(|member| self.reader.is_left_out(&member.value))
        {
            self.next += 1;
        }
        let Some(member) = self.members.get(self.next) else {
            return self.reader.closed(None);
        };
        let key: StrDeserializer<'_, Stop> = de::IntoDeserializer::into_deserializer(&*member.key);
        seed.deserialize(key)
            .map(Some)
            .map_err(|stop| stop.at_key(member, self.reader.place))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Stop> {
        let member = &self.members[self.next];
        self.next += 1;
        let place = self.reader.place.key(&member.key);
        let value = Reader {
            node: &member.value,
            place: &place,
            ..self.reader
        };
        seed.deserialize(value).map_err(|stop| stop.at(&value))
    }
}

#[cfg(test)]
mod tests {
    use super::super::entries::Entries;
    use super::super::json;
    use super::*;

    super::super::object::objects!(Beam);

    #[derive(Debug, Default, PartialEq, serde::Deserialize)]
    #[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
    struct Beam {
        span: Option<f64>,
        count: Option<usize>,
        up: Option<[f64; 3]>,
        #[serde(default)]
        points: Vec<f64>,
        #[serde(default)]
        parts: Entries<Option<f64>>,
    }

    /// The value, and the faults as `path: message @ text at the byte`.
    fn beam(text: &str) -> (Option<Beam>, Vec<String>) {
        let root = json::read(text).root;
        let Conversion { value, faults, .. } = convert(&root);
        let written = |located: &Located| {
            let fault = &located.fault;
            let rest: String = text[located.offset..].chars().take(4).collect();
            format!("{}: {} @ {rest}", fault.path, fault.expected)
        };
        let faults = faults.iter().map(written).collect();
        (value, faults)
    }

    #[test]
    fn a_right_text_has_no_faults() {
        let text = r#"{"span": 60, "count": 3, "up": [0, 1, 0], "points": [1, 2.5], "parts": {"a": null, "b": 1}}"#;
        let (value, faults) = beam(text);
        let parts = Entries(vec![("a".to_owned(), None), ("b".to_owned(), Some(1.0))]);
        let up = Some([0.0, 1.0, 0.0]);
        assert_eq!(
            value,
            Some(Beam {
                span: Some(60.0),
                count: Some(3),
                up,
                points: vec![1.0, 2.5],
                parts
            })
        );
        assert!(faults.is_empty());
    }

    #[test]
    fn all_faults_are_found_at_once_and_the_rest_is_converted() {
        let text = r#"{"span": "60", "spam": 1, "count": -3, "up": [0, "1", 0], "points": [1, null, 3],
                       "parts": {"a": 1, "b": true, "a": 2}, "span": 61}"#;
        let (value, faults) = beam(text);
        let expected = [
            "span: must be a number @ \"60\"",
            "spam: unknown key `spam` @ \"spa",
            "count: must be a whole number, zero or more @ -3, ",
            "up[1]: must be a number @ \"1\",",
            "points[1]: must be a number @ null",
            "parts.b: must be a number @ true",
            "parts: duplicate key `a` @ \"a\":",
        ];
        assert_eq!(faults, expected);
        let parts = Entries(vec![("a".to_owned(), Some(1.0))]);
        let up = Some([0.0; 3]);
        let beam = Beam {
            span: Some(61.0),
            up,
            points: vec![1.0, 1.0, 3.0],
            parts,
            ..Beam::default()
        };
        assert_eq!(value, Some(beam));
    }

    #[test]
    fn an_item_that_is_left_out_is_replaced_by_a_neighbour() {
        let text = r#"{"up": [0, "1", 2], "points": [null, 2, 3, true]}"#;
        let root = json::read(text).root;
        let Conversion { value, lost, .. } = convert::<Beam>(&root);
        let paths: Vec<String> = lost.iter().map(Path::to_string).collect();
        assert_eq!(paths, ["up[1]", "points[0]", "points[3]"]);
        let value = value.expect("the rest is right");
        assert_eq!(
            (value.up, value.points),
            (Some([0.0, 0.0, 2.0]), vec![2.0, 2.0, 3.0, 3.0])
        );
    }

    #[test]
    fn what_stands_before_a_break_is_checked_and_no_more() {
        let (value, faults) = beam(r#"{"span": "60", "points": [1, true, 2"#);
        assert_eq!(value, None);
        assert_eq!(
            faults,
            [
                "span: must be a number @ \"60\"",
                "points[1]: must be a number @ true"
            ]
        );
        for text in [
            "{\"up\": [0, 1",
            "{\"span\"",
            "{\"span\": 6e",
            "{\"span\": 6",
        ] {
            assert_eq!(beam(text), (None, Vec::new()), "{text}");
        }
    }

    #[test]
    fn lists_have_the_length_that_is_wanted() {
        let (_, faults) = beam(r#"{"up": [0, 1], "span": [[]]}"#);
        assert_eq!(
            faults,
            [
                "up: must be a list of 3 items @ [0, ",
                "span: must be a number @ [[]]"
            ]
        );
        let root = json::read(r#"{"up": [0, 1, 0, 7]}"#).root;
        let faults = convert::<Beam>(&root).faults;
        assert_eq!(faults[0].fault.expected, "must be a list of 3 items");
        assert_eq!(faults[0].fault.found.as_deref(), Some("4 items"));
    }

    #[test]
    fn a_text_that_is_no_object_has_no_value() {
        for text in ["7", "[60]", "\"span\""] {
            let (value, faults) = beam(text);
            assert_eq!(value, None);
            assert!(
                faults[0].starts_with(": must be an object @ "),
                "{faults:?}"
            );
        }
    }
}
