//! Median and extremes of repeated times.

/// Median, minimum and maximum of repeated times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Median, s.
    pub median: f64,
    /// Minimum, s.
    pub least: f64,
    /// Maximum, s.
    pub most: f64,
    /// Number of times.
    pub count: usize,
}

impl Spread {
    /// The spread of `times`, s; `None` where there are none.
    #[must_use]
    pub fn of(times: &[f64]) -> Option<Spread> {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (least, most) = (*sorted.first()?, *sorted.last()?);
        let middle = sorted.len() / 2;
        let median =
            if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
        Some(Spread { median, least, most, count: sorted.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_stands_between_least_and_most() {
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(
            Spread::of(&[3.0, 1.0, 10.0]),
            Some(Spread { median: 3.0, least: 1.0, most: 10.0, count: 3 })
        );
        assert_eq!(Spread::of(&[4.0, 1.0, 2.0, 9.0]).map(|spread| spread.median), Some(3.0));
    }
}
