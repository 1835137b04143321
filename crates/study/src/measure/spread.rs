//! Median and extremes of repeated times.

/// Median, minimum and maximum of repeated times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSpread {
    /// Median, s.
    pub median: f64,
    /// Minimum, s.
    pub min: f64,
    /// Maximum, s.
    pub max: f64,
    /// Number of times.
    pub count: usize,
}

impl TimeSpread {
    /// The spread of `times`, s; `None` where there are none.
    #[must_use]
    pub fn of(times: &[f64]) -> Option<TimeSpread> {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (least, most) = (*sorted.first()?, *sorted.last()?);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 {
            sorted[middle]
        } else {
            0.5 * (sorted[middle - 1] + sorted[middle])
        };
        Some(TimeSpread {
            median,
            min: least,
            max: most,
            count: sorted.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_stands_between_least_and_most() {
        assert_eq!(TimeSpread::of(&[]), None);
        assert_eq!(
            TimeSpread::of(&[3.0, 1.0, 10.0]),
            Some(TimeSpread {
                median: 3.0,
                min: 1.0,
                max: 10.0,
                count: 3
            })
        );
        assert_eq!(
            TimeSpread::of(&[4.0, 1.0, 2.0, 9.0]).map(|spread| spread.median),
            Some(3.0)
        );
    }
}
