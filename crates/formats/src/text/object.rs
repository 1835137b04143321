//! Deserialization of structs from objects only.
//!
//! The structs derived by serde also accept lists, by position. In an input file that is a mistake.

use serde::de::{Deserializer, Visitor};
use serde::forward_to_deserialize_any;

/// A deserializer that accepts objects only.
pub struct ObjectOnly<D>(
    /// The underlying deserializer.
    pub D,
);

impl<'de, D: Deserializer<'de>> Deserializer<'de> for ObjectOnly<D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_map(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

/// Implements `Deserialize` by the function that `#[serde(remote = "Self")]` derives, and accepts objects only.
#[macro_export]
macro_rules! objects {
    ($($name:ident),+ $(,)?) => {
        $(impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $name::deserialize($crate::text::object::ObjectOnly(deserializer))
            }
        })+
    };
}

pub use objects;
