//! Limits of one's own on deflections: the member `limits` of `practice` in designs and scenes.

use std::fmt;

use practice::clause::OWN_LIMIT;
use practice::limits::{DeflectionLimit, LimitLoads, LimitedDisplacement};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;
use crate::units::{Dimension, Scale, Units};

crate::text::object::objects!(RawOwnLimits);

/// Limits of one's own: each a part of the span such as "L/750", a length, or a list of these, of which the smallest holds.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub(crate) struct RawOwnLimits {
    /// Vertical deflection of a span from its chord under the static wheel loads.
    pub vertical: Option<RawLimit>,
    /// Lateral deflection of a span from its chord under the characteristic horizontal loads.
    pub lateral: Option<RawLimit>,
    /// Vertical deflection of an overhang under the static wheel loads; L is the length of the overhang.
    pub overhang: Option<RawLimit>,
}

/// A part of the span, or a length.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RawBound {
    Ratio(String),
    Length(f64),
}

/// One bound or several.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum RawLimit {
    One(RawBound),
    Several(Vec<RawBound>),
}

/// What a limit may be, in messages.
const EXPECTED: &str = "a ratio such as \"L/600\", a length, or a list of these";

struct BoundReader;

impl Visitor<'_> for BoundReader {
    type Value = RawBound;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a ratio such as \"L/600\", or a length")
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<RawBound, E> {
        Ok(RawBound::Ratio(value.to_owned()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<RawBound, E> {
        Ok(RawBound::Length(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<RawBound, E> {
        Ok(RawBound::Length(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<RawBound, E> {
        Ok(RawBound::Length(value as f64))
    }
}

impl<'de> Deserialize<'de> for RawBound {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(BoundReader)
    }
}

impl<'de> Deserialize<'de> for RawLimit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = RawLimit;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<RawLimit, E> {
                BoundReader.visit_str(value).map(RawLimit::One)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<RawLimit, E> {
                BoundReader.visit_f64(value).map(RawLimit::One)
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<RawLimit, E> {
                BoundReader.visit_i64(value).map(RawLimit::One)
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<RawLimit, E> {
                BoundReader.visit_u64(value).map(RawLimit::One)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawLimit, A::Error> {
                let mut out = Vec::new();
                while let Some(bound) = list.next_element()? {
                    out.push(bound);
                }
                Ok(RawLimit::Several(out))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// The limits as those of a code; `units` are those of the file.
pub(crate) fn read(
    raw: &RawOwnLimits,
    units: Units,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<DeflectionLimit> {
    let metre = Scale {
        from: units,
        to: Units::SI,
    }
    .factor(Dimension::LENGTH);
    let all = [
        (
            "vertical",
            &raw.vertical,
            LimitedDisplacement::RunwayVertical,
            LimitLoads::StaticWheels,
        ),
        (
            "lateral",
            &raw.lateral,
            LimitedDisplacement::RunwayLateral,
            LimitLoads::Horizontal,
        ),
        (
            "overhang",
            &raw.overhang,
            LimitedDisplacement::Overhang,
            LimitLoads::StaticWheels,
        ),
    ];
    let mut out = Vec::new();
    for (key, given, displacement, loads) in all {
        let Some(given) = given else { continue };
        let here = at.key(key);
        let (ratio, most) = match given {
            RawLimit::One(bound) => one(bound, &here, check),
            RawLimit::Several(list) => {
                if list.is_empty() {
                    check
                        .faults
                        .add(Fault::new(&here, "must have at least one limit").of_value());
                }
                let each = list.iter().enumerate();
                each.map(|(k, bound)| one(bound, &here.index(k), check))
                    .fold((None, None), |(ratio, most), (other, length)| {
                        (larger(ratio, other), smaller(most, length))
                    })
            }
        };
        out.push(DeflectionLimit {
            displacement,
            ratio,
            most: most.map(|most| most * metre),
            loads,
            clause: OWN_LIMIT,
        });
    }
    out
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::max)
}

fn smaller(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::min)
}

/// Ratio and length of a bound, of which one is known.
fn one(bound: &RawBound, at: &Place<'_>, check: &mut Check<'_>) -> (Option<f64>, Option<f64>) {
    match bound {
        RawBound::Length(length) => {
            let length = check.positive(*length, at, Dimension::LENGTH, "largest deflection");
            (None, Some(length))
        }
        RawBound::Ratio(text) => {
            let ratio = text
                .trim()
                .strip_prefix(['L', 'l'])
                .and_then(|rest| rest.trim_start().strip_prefix('/'))
                .and_then(|rest| rest.trim().parse::<f64>().ok())
                .filter(|ratio| ratio.is_finite() && *ratio > 0.0);
            if ratio.is_none() {
                let fault = Fault::new(at, "must be a ratio such as \"L/600\", or a length");
                check
                    .faults
                    .add(fault.got(format!("\"{text}\"")).of_value());
            }
            (ratio, None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::fault::Faults;

    fn limits(text: &str) -> (Vec<DeflectionLimit>, usize) {
        let raw: RawOwnLimits = serde_json::from_str(text).expect("limits");
        let mut faults = Faults::default();
        let scale = Scale {
            from: Units::SI,
            to: Units::SI,
        };
        let mut check = Check {
            faults: &mut faults,
            scale,
        };
        let found = read(&raw, Units::SI, &Place::root(), &mut check);
        (found, faults.0.len())
    }

    #[test]
    fn a_list_means_its_smallest_limit() {
        let (found, faults) =
            limits(r#"{"vertical": "L/750", "lateral": ["L/600", 0.02, " l / 400"]}"#);
        assert_eq!(faults, 0);
        assert_eq!(found[0].formula(), "L/750");
        assert_eq!(found[1].formula(), "L/600, at most 20 mm");
        let allowed = |length| found[1].allowable(length).expect("a length");
        assert!((allowed(6.0) - 0.01).abs() < 1e-15 && (allowed(30.0) - 0.02).abs() < 1e-15);
    }

    #[test]
    fn words_that_are_no_ratio_are_refused() {
        for text in ["L", "L/0", "L/-5", "600", "H/400", "L/x"] {
            assert_eq!(
                limits(&format!(r#"{{"vertical": "{text}"}}"#)).1,
                1,
                "{text}"
            );
        }
        assert_eq!(limits(r#"{"overhang": 0}"#).1, 1);
    }
}
