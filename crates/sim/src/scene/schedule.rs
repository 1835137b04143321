//! A quantity defined by a table over time.

use super::error::Error;
use super::profile::{check_rows, linear};

/// A piecewise linear function of time. Before the first and after the last row of its table it is constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    rows: Vec<[f64; 2]>,
}

impl Schedule {
    /// Builds the function from the rows (time, value) of `table`.
    ///
    /// # Errors
    /// An empty table, times that do not increase, or numbers that are not finite.
    pub fn new(table: &[[f64; 2]]) -> Result<Schedule, Error> {
        check_rows(table)?;
        Ok(Schedule {
            rows: table.to_vec(),
        })
    }

    /// Value at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        linear(&self.rows, t).0
    }

    /// Slope at `t`; at a break, the slope immediately after it.
    #[must_use]
    pub fn slope(&self, t: f64) -> f64 {
        linear(&self.rows, t).1
    }

    /// Integral of the value from 0 to `t`.
    #[must_use]
    pub fn integral(&self, t: f64) -> f64 {
        self.area(t) - self.area(0.0)
    }

    /// Times between the rows at which the value changes sign.
    pub fn turns(&self) -> impl Iterator<Item = f64> + '_ {
        self.rows
            .windows(2)
            .filter(|pair| pair[0][1] * pair[1][1] < 0.0)
            .map(|pair| {
                let [[t0, v0], [t1, v1]] = [pair[0], pair[1]];
                t0 + (t1 - t0) * v0 / (v0 - v1)
            })
    }

    /// Integral from the first row to `t`.
    fn area(&self, t: f64) -> f64 {
        let Some(&[first, start]) = self.rows.first() else {
            return 0.0;
        };
        if t <= first {
            return start * (t - first);
        }
        let mut sum = 0.0;
        let (mut t0, mut v0) = (first, start);
        for &[t1, v1] in &self.rows[1..] {
            if t <= t1 {
                return sum + 0.5 * (v0 + self.at(t)) * (t - t0);
            }
            sum += 0.5 * (v0 + v1) * (t1 - t0);
            (t0, v0) = (t1, v1);
        }
        sum + v0 * (t - t0)
    }

    /// Times at which the slope may jump.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.rows.iter().map(|row| row[0])
    }
}

#[cfg(test)]
mod tests {
    use super::Schedule;

    #[test]
    fn schedule_is_linear_between_its_rows_and_keeps_its_ends() {
        let schedule = Schedule::new(&[[1.0, 2.0], [3.0, 6.0], [4.0, 0.0]]).expect("a valid table");
        for (t, value) in [
            (0.0, 2.0),
            (1.0, 2.0),
            (2.0, 4.0),
            (3.0, 6.0),
            (3.5, 3.0),
            (9.0, 0.0),
        ] {
            assert_eq!(schedule.at(t), value, "t = {t}");
        }
        assert_eq!(schedule.breaks().collect::<Vec<_>>(), [1.0, 3.0, 4.0]);
    }

    #[test]
    fn schedule_refuses_tables_that_are_empty_turn_back_or_are_not_finite() {
        for table in [
            &[][..],
            &[[1.0, 0.0], [1.0, 2.0]],
            &[[0.0, f64::NAN]],
            &[[f64::INFINITY, 1.0]],
        ] {
            assert!(Schedule::new(table).is_err(), "{table:?}");
        }
    }
}
