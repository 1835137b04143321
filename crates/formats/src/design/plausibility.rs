//! Values of a design that are probably in another unit than that of the file, or slips ([`crate::plausible`]).

use super::values::{Design, DesignTrain};
use crate::plausible::{
    BUFFER, CRANE_WEIGHT, ECCENTRICITY, GRAVITIES, HOIST_SPEEDS, HORIZONTAL, LOAD_FACTOR,
    OWN_LIMIT, RAIL_WEIGHT, SPAN, TRAIN_END, WHEEL_DISTANCE, WHEEL_LOADS, is_within,
};
use crate::text::number::{number, rounded};
use crate::units::{Dimension, Scale, Units};
use crate::verdict::{OmittedCheck, rail_phrase};

impl Design {
    /// Values that are probably wrong, each with what is usual.
    #[must_use]
    pub fn doubts(&self) -> Vec<OmittedCheck> {
        let mut out = self.doubts_about_dead_load();
        out.extend(
            self.trains
                .iter()
                .flat_map(|train| self.doubts_about(train)),
        );
        for case in &self.cases {
            let odd = case
                .factors
                .iter()
                .find(|(_, factor)| factor.abs() > LOAD_FACTOR);
            out.extend(odd.map(|(name, factor)| {
                let what = format!("factors of case {}", case.name);
                OmittedCheck::new(what, format!("`{name}` is {}", number(*factor)))
            }));
        }
        // The rated speed is in m/s.
        let speed = self.practice.hoist_speed;
        out.extend(
            speed
                .filter(|speed| !is_within(HOIST_SPEEDS, *speed))
                .map(|speed| {
                    let reason = format!(
                        "it is {} m/s; usual are 0.02 to 1 m/s",
                        number(rounded(speed, 4))
                    );
                    OmittedCheck::new("unit of `hoist_speed`", reason)
                }),
        );
        let mut longest = 0.0_f64;
        for (ends, rail) in self.spans.iter().zip(&self.spec.rails()) {
            let own = ends
                .windows(2)
                .map(|pair| pair[1] - pair[0])
                .fold(0.0, f64::max);
            longest = longest.max(own);
            if self.si(own, Dimension::LENGTH) > SPAN {
                let what = format!("unit of the spans of {}", rail_phrase(&rail.name));
                let reason = format!("a span has {}", self.words(own, Dimension::LENGTH));
                out.push(OmittedCheck::new(what, reason));
            }
        }
        let metres = self.si(longest, Dimension::LENGTH);
        let most = self.practice.limits.iter().filter_map(|limit| limit.most);
        out.extend(most.filter(|most| *most > OWN_LIMIT * metres).map(|most| {
            let reason = format!(
                "a deflection of {} m is allowed, the longest span has {} m",
                number(rounded(most, 4)),
                number(rounded(metres, 4))
            );
            OmittedCheck::new("unit of `practice.limits`", reason)
        }));
        out
    }

    fn si(&self, value: f64, dimension: Dimension) -> f64 {
        let scale = Scale {
            from: self.units,
            to: Units::SI,
        };
        value * scale.factor(dimension)
    }

    fn words(&self, value: f64, dimension: Dimension) -> String {
        format!(
            "{} {}",
            number(rounded(value, 4)),
            self.units.label(dimension)
        )
    }

    fn doubts_about_dead_load(&self) -> Vec<OmittedCheck> {
        let mut out = Vec::new();
        let gravity = self.dead.gravity;
        let is_odd = !is_within(GRAVITIES, self.si(gravity, Dimension::ACCELERATION));
        if gravity != 0.0 && is_odd {
            let reason = format!(
                "it is {}; 9.81 m/s^2 on earth",
                self.words(gravity, Dimension::ACCELERATION)
            );
            out.push(OmittedCheck::new("unit of `gravity`", reason));
        }
        let lines = self.dead.lines.iter().zip(self.spec.rails());
        for (line, rail) in lines {
            if self.si(*line, Dimension::STIFFNESS) > RAIL_WEIGHT {
                let what = format!("unit of the dead load along {}", rail_phrase(&rail.name));
                let reason = format!("it is {}", self.words(*line, Dimension::STIFFNESS));
                out.push(OmittedCheck::new(what, reason));
            }
        }
        out
    }

    fn doubts_about(&self, train: &DesignTrain) -> Vec<OmittedCheck> {
        let mut out = Vec::new();
        let mut doubt = |what: &str, reason: String| {
            out.push(OmittedCheck::new(
                format!("{what} of train {}", train.name),
                reason,
            ));
        };
        let force = |value: f64| self.words(value, Dimension::FORCE);
        let length = |value: f64| self.words(value, Dimension::LENGTH);
        let wheels = &train.wheels;
        let vertical: Vec<f64> = wheels.iter().map(|wheel| wheel.whole_vertical()).collect();
        let sum: f64 = vertical.iter().map(|load| load.abs()).sum();

        let is_odd = |load: &&f64| {
            **load != 0.0 && !is_within(WHEEL_LOADS, self.si(load.abs(), Dimension::FORCE))
        };
        if let Some(load) = vertical.iter().find(is_odd) {
            let reason = format!("a wheel has {}; usual are 1 kN to 1 MN", force(load.abs()));
            doubt("unit of the wheel loads", reason);
        }
        if sum > 0.0 && vertical.iter().all(|load| *load <= 0.0) {
            let reason = "all wheels pull the rail up; positive forces press".to_owned();
            doubt("sign of the wheel loads", reason);
        }
        let side = |k: usize| wheels[k].lateral.abs().max(wheels[k].skewing.abs());
        let sideways = (0..wheels.len())
            .find(|&k| vertical[k] != 0.0 && side(k) > HORIZONTAL * vertical[k].abs());
        if let Some(k) = sideways {
            let (side, load) = (force(side(k)), force(vertical[k].abs()));
            let reason = format!("a wheel has {side} laterally and {load} vertically");
            doubt("unit of the lateral forces", reason);
        }
        let total = |of: fn(&super::values::DesignWheel) -> f64| {
            wheels.iter().map(|wheel| of(wheel).abs()).sum::<f64>()
        };
        for (what, along, most) in [
            (
                "longitudinal force",
                total(|wheel| wheel.longitudinal),
                HORIZONTAL,
            ),
            ("buffer force", total(|wheel| wheel.buffer), BUFFER),
        ] {
            if sum > 0.0 && along > most * sum {
                let reason = format!("it is {}, its wheel loads are {}", force(along), force(sum));
                doubt(&format!("unit of the {what}"), reason);
            }
        }
        let weights: f64 = train.weights.iter().flatten().sum();
        if sum > 0.0 && weights > CRANE_WEIGHT * sum {
            let reason = format!(
                "together they are {}, its wheel loads {}",
                force(weights),
                force(sum)
            );
            doubt("unit of the weights", reason);
        }
        let near = wheels.iter().enumerate().find_map(|(k, wheel)| {
            let later = wheels[k + 1..]
                .iter()
                .filter(|next| next.rail == wheel.rail);
            let distance = later
                .map(|next| (next.x - wheel.x).abs())
                .fold(f64::INFINITY, f64::min);
            let is_near = self.si(distance, Dimension::LENGTH) < WHEEL_DISTANCE;
            is_near.then_some(distance)
        });
        if let Some(distance) = near {
            let reason = format!("two wheels are {} apart", length(distance));
            doubt("unit of the wheel distances", reason);
        }
        let end = train.ends.iter().copied().fold(0.0, f64::max);
        if self.si(end, Dimension::LENGTH) > TRAIN_END {
            let reason = format!("the train ends {} beyond its wheels", length(end));
            doubt("unit of the `ends`", reason);
        }
        let aside = wheels.iter().map(|wheel| wheel.eccentricity.abs());
        let aside = aside.fold(0.0, f64::max);
        if self.si(aside, Dimension::LENGTH) > ECCENTRICITY {
            let reason = format!("a wheel stands {} beside its rail", length(aside));
            doubt("unit of the `eccentricity`", reason);
        }
        out
    }
}
