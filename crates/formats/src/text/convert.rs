//! Conversion of a located tree to the types of a format.
//!
//! A value is converted by serde. If a value has the wrong type, or a key is unknown or duplicate, the fault is
//! recorded with its place, and the member or item is marked as omitted. The whole tree is then converted again
//! without it, and this is repeated until no further fault occurs. Derived types therefore need no code for error
//! recovery, and a correct text is converted once. A value that fails only because a part of it has been omitted (for
//! example a vector with too few items) is omitted without a fault of its own. The conversion stops where the text is
//! truncated.

use std::collections::BTreeSet;
use std::fmt;

use serde::de::value::StrDeserializer;
use serde::de::{self, Deserialize, DeserializeSeed, Deserializer, Unexpected, Visitor};
use serde::forward_to_deserialize_any;

use super::fault::Fault;
use super::place::Place;
use super::tree::{TreeMember, TreeNode, Value};
use super::wording::{is_duplicate, type_fault};

/// Maximum number of faults that are collected from one text.
const MOST: usize = 100;

/// A fault of the conversion, with its place in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Located {
    /// What is wrong.
    pub fault: Fault,
    /// Byte offset of the value or key that the fault concerns.
    pub offset: usize,
    /// Byte offset of the first surplus item, if a list is too long.
    pub excess: Option<usize>,
}

/// Converts a tree. The first fault is the first one in the text. If there are faults, the members and items
/// concerned are omitted from the value; there is no value if the remainder cannot be converted either.
pub(crate) fn convert<'de, T: Deserialize<'de>>(root: &'de TreeNode<'de>) -> (Option<T>, Vec<Located>) {
    let mut left_out = BTreeSet::new();
    let mut faults = Vec::new();
    while faults.len() < MOST {
        let place = Place::root();
        let reader = Reader { node: root, place: &place, left_out: &left_out };
        match T::deserialize(reader).map_err(|stop| stop.at(&reader)) {
            Ok(value) => return (Some(value), faults),
            Err(Stop::At { located, start }) => {
                faults.extend(located.map(|located| *located));
                if start == root.start || !left_out.insert(start) {
                    break;
                }
            }
            Err(Stop::Message(_) | Stop::Excess { .. } | Stop::Broken) => break,
        }
    }
    (None, faults)
}

/// The reason why a conversion stops.
#[derive(Debug)]
enum Stop {
    /// A message of serde whose place has not been determined yet.
    Message(String),
    /// A list has too many items. The first surplus item begins at byte `offset`.
    Excess { items: usize, offset: usize },
    /// The value that begins at byte `start` cannot be converted. It has no fault of its own if the failure is a
    /// consequence of other faults.
    At { located: Option<Box<Located>>, start: usize },
    /// The text is truncated here.
    Broken,
}

impl Stop {
    /// Assigns the place of a value, unless a place within it has already been assigned.
    #[cold]
    fn at(self, reader: &Reader<'_, '_>) -> Stop {
        let node = reader.node;
        let (message, excess) = match self {
            Stop::Message(message) => (message, None),
            Stop::Excess { items, offset } => {
                (format!("invalid length {items}, expected fewer elements in array"), Some(offset))
            }
            placed @ (Stop::At { .. } | Stop::Broken) => return placed,
        };
        let path = reader.place.path();
        if is_duplicate(&message)
            && let Some(second) = node.second_of_a_key()
        {
            let located =
                Located { fault: Fault::duplicate(path, &second.key), offset: second.start, excess: None };
            return Stop::At { located: Some(Box::new(located)), start: second.value.start };
        }
        let follows = reader.left_out.range(node.start..).next().is_some_and(|start| *start < node.end);
        let located = Located { fault: type_fault(path, &message), offset: node.start, excess };
        Stop::At { located: (!follows).then(|| Box::new(located)), start: node.start }
    }

    /// Assigns the place of the key of a member.
    #[cold]
    fn at_key(self, member: &TreeMember<'_>, place: &Place<'_>) -> Stop {
        let Stop::Message(message) = self else { return self };
        let fault = type_fault(place.key(&member.key).path(), &message);
        let located = Located { fault, offset: member.start, excess: None };
        Stop::At { located: Some(Box::new(located)), start: member.value.start }
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stop::Message(message) => f.write_str(message),
            Stop::Excess { items, .. } => write!(f, "invalid length {items}"),
            Stop::At { located, .. } => f.write_str(located.as_ref().map_or("", |at| &at.fault.expected)),
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
        Stop::Message(format!("invalid value: {}, expected {expected}", Seen(seen)))
    }
}

/// A value to be converted.
#[derive(Clone, Copy)]
struct Reader<'a, 'de> {
    node: &'de TreeNode<'de>,
    place: &'a Place<'a>,
    /// Byte offsets of the omitted values.
    left_out: &'a BTreeSet<usize>,
}

impl<'de> Reader<'_, 'de> {
    fn is_left_out(&self, node: &TreeNode<'_>) -> bool {
        !self.left_out.is_empty() && self.left_out.contains(&node.start)
    }

    /// Returns `value` if the text of the list or object is complete.
    fn closed<T>(&self, value: T) -> Result<T, Stop> {
        if self.node.is_whole() { Ok(value) } else { Err(Stop::Broken) }
    }

    fn list<V: Visitor<'de>>(self, items: &'de [TreeNode<'de>], visitor: V) -> Result<V::Value, Stop> {
        let mut rest = Items { reader: self, items, next: 0 };
        let value = visitor.visit_seq(&mut rest)?;
        rest.skip_left_out();
        match items.get(rest.next) {
            Some(item) => Err(Stop::Excess { items: items.len(), offset: item.start }),
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
                .visit_map(Members { reader: self, members, next: 0 })
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

impl Items<'_, '_> {
    fn skip_left_out(&mut self) {
        while self.items.get(self.next).is_some_and(|item| self.reader.is_left_out(item)) {
            self.next += 1;
        }
    }
}

impl<'de> de::SeqAccess<'de> for &mut Items<'_, 'de> {
    type Error = Stop;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Stop> {
        self.skip_left_out();
        let Some(node) = self.items.get(self.next) else { return self.reader.closed(None) };
        let place = self.reader.place.index(self.next);
        self.next += 1;
        let item = Reader { node, place: &place, left_out: self.reader.left_out };
        seed.deserialize(item).map(Some).map_err(|stop| stop.at(&item))
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

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Stop> {
        while self.members.get(self.next).is_some_and(|member| self.reader.is_left_out(&member.value)) {
            self.next += 1;
        }
        let Some(member) = self.members.get(self.next) else { return self.reader.closed(None) };
        let key: StrDeserializer<'_, Stop> = de::IntoDeserializer::into_deserializer(&*member.key);
        seed.deserialize(key).map(Some).map_err(|stop| stop.at_key(member, self.reader.place))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Stop> {
        let member = &self.members[self.next];
        self.next += 1;
        let place = self.reader.place.key(&member.key);
        let value = Reader { node: &member.value, place: &place, left_out: self.reader.left_out };
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
        let (value, faults) = convert(&root);
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
        let text =
            r#"{"span": 60, "count": 3, "up": [0, 1, 0], "points": [1, 2.5], "parts": {"a": null, "b": 1}}"#;
        let (value, faults) = beam(text);
        let parts = Entries(vec![("a".to_owned(), None), ("b".to_owned(), Some(1.0))]);
        let up = Some([0.0, 1.0, 0.0]);
        assert_eq!(value, Some(Beam { span: Some(60.0), count: Some(3), up, points: vec![1.0, 2.5], parts }));
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
        let beam = Beam { span: Some(61.0), points: vec![1.0, 3.0], parts, ..Beam::default() };
        assert_eq!(value, Some(beam));
    }

    #[test]
    fn what_stands_before_a_break_is_checked_and_no_more() {
        let (value, faults) = beam(r#"{"span": "60", "points": [1, true, 2"#);
        assert_eq!(value, None);
        assert_eq!(faults, ["span: must be a number @ \"60\"", "points[1]: must be a number @ true"]);
        for text in ["{\"up\": [0, 1", "{\"span\"", "{\"span\": 6e", "{\"span\": 6"] {
            assert_eq!(beam(text), (None, Vec::new()), "{text}");
        }
    }

    #[test]
    fn lists_have_the_length_that_is_wanted() {
        let (_, faults) = beam(r#"{"up": [0, 1], "span": [[]]}"#);
        assert_eq!(faults, ["up: must be a list of 3 items @ [0, ", "span: must be a number @ [[]]"]);
        let text = r#"{"up": [0, 1, 0, 7]}"#;
        let root = json::read(text).root;
        let (_, faults) = convert::<Beam>(&root);
        assert_eq!(faults[0].excess, text.find('7'));
        assert_eq!(faults[0].fault.found.as_deref(), Some("4 items"));
    }

    #[test]
    fn a_text_that_is_no_object_has_no_value() {
        for text in ["7", "[60]", "\"span\""] {
            let (value, faults) = beam(text);
            assert_eq!(value, None);
            assert!(faults[0].starts_with(": must be an object @ "), "{faults:?}");
        }
    }
}
