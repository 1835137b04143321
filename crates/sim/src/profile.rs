//! Prescribed motion: piecewise linear tables of position, speed or acceleration over time.

use crate::Error;

/// What a motion's table prescribes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Position over time.
    Position,
    /// Speed over time; the position starts at its initial value.
    Speed,
    /// Acceleration over time; position and speed start at their initial values.
    Acceleration,
}

/// A prescribed x(t): a piecewise linear table, held constant beyond its ends, integrated exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    order: Order,
    times: Vec<f64>,
    values: Vec<f64>,
    /// x, v at each knot (position and speed before the first knot are extended backwards).
    knots: Vec<[f64; 2]>,
}

/// Position, speed and acceleration at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion3 {
    /// Position.
    pub x: f64,
    /// Speed.
    pub v: f64,
    /// Acceleration.
    pub a: f64,
}

impl Profile {
    /// A profile from `table` rows (t, value), with position `x0` and speed `v0` at t = 0.
    ///
    /// A position table gives the position itself (`x0` is not used), a speed table does not use `v0`.
    ///
    /// # Errors
    /// An empty table, times that do not increase, numbers that are not finite.
    pub fn new(order: Order, table: &[[f64; 2]], x0: f64, v0: f64) -> Result<Self, Error> {
        if table.is_empty() {
            return Err(Error::Number { what: "rows of a motion table", wanted: "at least one", found: 0.0 });
        }
        for row in table {
            if !(row[0].is_finite() && row[1].is_finite()) {
                return Err(Error::Number { what: "motion table", wanted: "finite", found: row[0] + row[1] });
            }
        }
        if let Some(pair) = table.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            return Err(Error::Number {
                what: "time of a motion table",
                wanted: "increasing",
                found: pair[1][0],
            });
        }
        let times: Vec<f64> = table.iter().map(|row| row[0]).collect();
        let values: Vec<f64> = table.iter().map(|row| row[1]).collect();
        let mut profile = Profile { order, knots: vec![[0.0; 2]; times.len()], times, values };
        for i in 1..profile.times.len() {
            let dt = profile.times[i] - profile.times[i - 1];
            let end = profile.advance(profile.knots[i - 1], profile.values[i - 1], profile.values[i], dt, dt);
            profile.knots[i] = [end.x, end.v];
        }
        let origin = profile.at(0.0);
        let (dx, dv) = match order {
            Order::Position => (0.0, 0.0),
            Order::Speed => (x0 - origin.x, 0.0),
            Order::Acceleration => (x0 - origin.x, v0 - origin.v),
        };
        let times = profile.times.clone();
        for (knot, t) in profile.knots.iter_mut().zip(times) {
            knot[0] += dx + dv * t;
            knot[1] += dv;
        }
        Ok(profile)
    }

    /// Position, speed and acceleration at time `t`; at a knot, from the right.
    #[must_use]
    pub fn at(&self, t: f64) -> Motion3 {
        let last = self.times.len() - 1;
        let i = self.times.partition_point(|&knot| knot <= t);
        if i == 0 {
            self.advance(self.knots[0], self.values[0], self.values[0], 1.0, t - self.times[0])
        } else if i > last {
            self.advance(self.knots[last], self.values[last], self.values[last], 1.0, t - self.times[last])
        } else {
            let dt = self.times[i] - self.times[i - 1];
            self.advance(self.knots[i - 1], self.values[i - 1], self.values[i], dt, t - self.times[i - 1])
        }
    }

    /// Times at which the table has a knot: the motion is not smooth there.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.times
    }

    /// Motion at `s` after a knot with state `knot`, where the value runs from `a` to `b` over `dt`.
    fn advance(&self, knot: [f64; 2], a: f64, b: f64, dt: f64, s: f64) -> Motion3 {
        let rate = (b - a) / dt;
        match self.order {
            Order::Position => Motion3 { x: a + rate * s, v: rate, a: 0.0 },
            Order::Speed => Motion3 { x: knot[0] + a * s + rate * s * s / 2.0, v: a + rate * s, a: rate },
            Order::Acceleration => Motion3 {
                x: knot[0] + knot[1] * s + a * s * s / 2.0 + rate * s * s * s / 6.0,
                v: knot[1] + a * s + rate * s * s / 2.0,
                a: a + rate * s,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Motion3, Order, Profile};

    #[test]
    fn constant_speed_moves_on_a_line() {
        let profile = Profile::new(Order::Speed, &[[0.0, 5.0]], 2.0, 0.0).expect("a valid table");
        assert_eq!(profile.at(3.0), Motion3 { x: 17.0, v: 5.0, a: 0.0 });
    }

    #[test]
    fn a_speed_ramp_integrates_to_a_parabola_and_goes_on_at_its_last_speed() {
        let profile = Profile::new(Order::Speed, &[[0.0, 0.0], [4.0, 8.0]], 1.0, 0.0).expect("a valid table");
        assert_eq!(profile.at(2.0), Motion3 { x: 5.0, v: 4.0, a: 2.0 });
        assert_eq!(profile.at(5.0), Motion3 { x: 25.0, v: 8.0, a: 0.0 });
    }

    #[test]
    fn acceleration_starts_from_the_given_place_and_speed() {
        let profile =
            Profile::new(Order::Acceleration, &[[1.0, 2.0], [2.0, 2.0]], 3.0, 1.0).expect("a valid table");
        let at = profile.at(0.0);
        assert!((at.x - 3.0).abs() < 1e-14 && (at.v - 1.0).abs() < 1e-14);
        let at = profile.at(3.0);
        assert!((at.x - (3.0 + 3.0 + 9.0)).abs() < 1e-13 && (at.v - 7.0).abs() < 1e-13);
    }

    #[test]
    fn rejects_times_that_do_not_increase() {
        assert!(Profile::new(Order::Speed, &[[0.0, 1.0], [0.0, 2.0]], 0.0, 0.0).is_err());
    }
}
