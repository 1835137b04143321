//! A sweep file as written, unchecked.

use std::fmt;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};

use crate::text::entries::Entries;

crate::text::object::objects!(RawSweep, RawLaw);

/// A sweep: one scene or design, axes over values of its files, and the results of each run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawSweep {
    /// Name and version of the format.
    pub format: Option<String>,
    /// Name of the sweep; by default that of the file.
    pub name: Option<String>,
    /// Scene file, relative to the folder of this file.
    pub scene: Option<String>,
    /// Design file, relative to the folder of this file, in place of `scene`.
    pub design: Option<String>,
    /// Values of each axis, by its JSON pointer into the scene or design or, after a file name and `#`, into a file to
    /// which it refers, such as `spec.json#/girder/E`.
    pub axes: Option<Entries<RawAxis>>,
    /// How runs are chosen: "grid" (every combination), "latin" (Latin hypercube) or "sobol" (Sobol sequence).
    pub sampling: Option<String>,
    /// Number of runs of "latin" and "sobol".
    pub count: Option<f64>,
    /// Seed of the random numbers of "latin" and "sobol"; by default 1.
    pub seed: Option<u64>,
    /// Results of each run: "peaks", "extremes", "fatigue", "ratios", or names of columns of the history.
    pub results: Option<Vec<String>>,
}

/// Values of an axis: a list, or a range or distribution.
#[derive(Debug)]
pub(crate) enum RawAxis {
    List(Vec<RawScalar>),
    Law(Box<RawLaw>),
}

/// A range or a distribution; exactly one member.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawLaw {
    /// First value, last value, and number of equally spaced values.
    pub range: Option<[f64; 3]>,
    /// Smallest and largest value of a uniform distribution.
    pub uniform: Option<[f64; 2]>,
    /// Mean and standard deviation of a normal distribution.
    pub normal: Option<[f64; 2]>,
    /// Mean and standard deviation of a lognormal distribution, of the values themselves and not of their logarithms.
    pub lognormal: Option<[f64; 2]>,
}

/// A value that is not a list or an object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RawScalar {
    Number(f64),
    Text(String),
    Flag(bool),
}

impl<'de> Deserialize<'de> for RawAxis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawAxis;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of values or an object with `range`, `uniform`, `normal` or `lognormal`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<RawAxis, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(RawAxis::List)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawAxis, A::Error> {
                RawLaw::deserialize(MapAccessDeserializer::new(map))
                    .map(|law| RawAxis::Law(Box::new(law)))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl<'de> Deserialize<'de> for RawScalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = RawScalar;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, a string, true or false")
            }

            fn visit_bool<E: Error>(self, value: bool) -> Result<RawScalar, E> {
                Ok(RawScalar::Flag(value))
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<RawScalar, E> {
                Ok(RawScalar::Text(value.to_owned()))
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<RawScalar, E> {
                Ok(RawScalar::Number(value))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<RawScalar, E> {
                Ok(RawScalar::Number(value as f64))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<RawScalar, E> {
                Ok(RawScalar::Number(value as f64))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}
