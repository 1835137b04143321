//! Values of a design that are probably in another unit than that of the file.

use super::values::Design;
use crate::text::number::{number, rounded};
use crate::units::{Dimension, Scale, Units};
use crate::verdict::OmittedCheck;

/// Plausible range of vertical wheel loads, N: from a monorail trolley of 100 kg to twice the largest wheel loads of
/// ladle cranes, about 1 MN.
const WHEEL_LOADS: [f64; 2] = [200.0, 2e6];

/// Largest plausible rated hoisting speed, m/s. Container cranes have up to 3 m/s without load.
const HOIST_SPEED: f64 = 4.0;

/// Largest plausible span of a girder, m. The longest runway beams have about 40 m, bridges of gantry cranes 150 m.
const SPAN: f64 = 200.0;

/// Largest plausible ratio of the lateral force of a wheel to its vertical force.
const LATERAL: f64 = 1.0;

impl Design {
    /// Values that are probably wrong, each with what is usual.
    #[must_use]
    pub fn doubts(&self) -> Vec<OmittedCheck> {
        let scale = Scale {
            from: self.units,
            to: Units::SI,
        };
        let force = |value: f64| value * scale.factor(Dimension::FORCE);
        let words = |value: f64, dimension: Dimension| {
            format!(
                "{} {}",
                number(rounded(value, 4)),
                self.units.label(dimension)
            )
        };
        let mut out = Vec::new();
        let mut doubt = |what: String, reason: String| {
            out.push(OmittedCheck::new(format!("unit of {what}"), reason));
        };
        for train in &self.trains {
            let loads = train
                .wheels
                .iter()
                .map(|wheel| wheel.whole_vertical().abs());
            let [low, high] = WHEEL_LOADS;
            let odd = loads
                .filter(|load| *load != 0.0)
                .find(|load| !(low..=high).contains(&force(*load)));
            if let Some(load) = odd {
                let reason = format!(
                    "a wheel has {}; usual are 1 kN to 1 MN",
                    words(load, Dimension::FORCE)
                );
                doubt(format!("the wheel loads of train {}", train.name), reason);
            }
            let odd = train.wheels.iter().find(|wheel| {
                let vertical = wheel.whole_vertical().abs();
                let lateral = wheel.lateral.abs().max(wheel.skewing.abs());
                vertical > 0.0 && lateral > LATERAL * vertical
            });
            if let Some(wheel) = odd {
                let lateral = wheel.lateral.abs().max(wheel.skewing.abs());
                let reason = format!(
                    "a wheel has {} laterally and {} vertically",
                    words(lateral, Dimension::FORCE),
                    words(wheel.whole_vertical(), Dimension::FORCE)
                );
                doubt(
                    format!("the lateral forces of train {}", train.name),
                    reason,
                );
            }
        }
        // The rated speed is in m/s.
        if let Some(speed) = self
            .practice
            .hoist_speed
            .filter(|speed| *speed > HOIST_SPEED)
        {
            let reason = format!(
                "it is {} m/s; usual are 0.02 to 1 m/s",
                number(rounded(speed, 4))
            );
            doubt("`hoist_speed`".to_owned(), reason);
        }
        let rails = self.spec.rails();
        for (ends, rail) in self.spans.iter().zip(&rails) {
            let longest = ends
                .windows(2)
                .map(|pair| pair[1] - pair[0])
                .fold(0.0, f64::max);
            if longest * scale.factor(Dimension::LENGTH) > SPAN {
                let reason = format!("a span has {}", words(longest, Dimension::LENGTH));
                doubt(format!("the spans of rail {}", rail.name), reason);
            }
        }
        out
    }
}
