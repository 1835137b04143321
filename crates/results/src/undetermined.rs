//! Extremes that a run does not determine: where contacts open and close often, small differences grow, and the largest values
//! change with the last digits of the input.
//!
//! Where wheels lose contact or flanges strike again and again, the run is repeated with another accuracy. If largest values
//! differ by much more than both accuracies, it is repeated a few times more, and the smallest and the largest of these values are
//! told.

use formats::text::number::{number, rounded};
use formats::units::Dimension;
use serde_json::{Value, json};

use crate::columns::NamedColumns;
use crate::steps::ColumnPeak;

/// Number of times that wheels lose contact, or that flanges strike, from which a run is repeated.
const OFTEN: usize = 8;

/// Factors of the accuracy of the first repetition and of the others.
const FIRST: f64 = 0.5;
const MORE: [f64; 3] = [0.8, 0.35, 0.2];

/// Relative differences from which largest values are not determined: this, or so many times the accuracy.
const APART: f64 = 0.01;
const TIMES: f64 = 20.0;

/// Columns whose largest magnitudes are below this part of the largest of their dimension are left out.
const SMALL: f64 = 0.01;

/// A largest value that a run does not determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Undetermined {
    /// Name of the column.
    pub quantity: String,
    /// The smallest of its extremes in several runs.
    pub low: f64,
    /// The largest of them.
    pub high: f64,
    /// Why.
    pub reason: String,
}

impl Undetermined {
    /// Its range in words.
    #[must_use]
    pub fn range(&self) -> String {
        let [low, high] = [self.low, self.high].map(|value| number(rounded(value, 4)));
        format!("{} is between {low} and {high}", self.quantity)
    }

    /// The value as a member of `undetermined`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({"quantity": self.quantity, "low": self.low, "high": self.high, "reason": self.reason})
    }
}

/// How often contacts open and close in a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactChanges {
    /// Number of times that wheels lose contact.
    pub losses: usize,
    /// Number of times that flanges strike.
    pub strikes: usize,
}

impl ContactChanges {
    /// Those of a run with the columns of `record`, in which wheels lose contact so many times. A flange strikes where its force
    /// has been zero.
    pub fn new<'w>(
        losses: usize,
        wheels: impl Iterator<Item = &'w str>,
        record: &NamedColumns,
    ) -> ContactChanges {
        let strikes = |wheel: &str| {
            let forces = record.part(wheel, "lateral").windows(2);
            forces
                .filter(|pair| pair[0] == 0.0 && pair[1] != 0.0)
                .count()
        };
        ContactChanges {
            losses,
            strikes: wheels.map(strikes).sum(),
        }
    }

    fn words(&self) -> String {
        let mut words = Vec::new();
        if self.losses > 0 {
            words.push(format!("wheels lose contact {} times", self.losses));
        }
        if self.strikes > 0 {
            words.push(format!("flanges strike {} times", self.strikes));
        }
        words.join(" and ")
    }
}

/// The extremes of columns that `again`, which repeats the run with a factor of its accuracy, does not confirm; those first that
/// matter most ([`apart`]). `changes` is how often contacts open and close in the run. Without a repetition that ends there are none.
pub(crate) fn undetermined(
    accuracy: f64,
    changes: ContactChanges,
    own: &[ColumnPeak],
    again: &mut dyn FnMut(f64) -> Option<Vec<ColumnPeak>>,
) -> Vec<Undetermined> {
    if changes.losses.max(changes.strikes) < OFTEN {
        return Vec::new();
    }
    let mut all = vec![own.to_vec()];
    all.extend(again(FIRST));
    let has_ended = all.len() > 1;
    if has_ended && apart(accuracy, &all).is_empty() {
        return Vec::new();
    }
    all.extend(MORE.iter().filter_map(|factor| again(*factor)));
    let found = apart(accuracy, &all);
    let reason = format!(
        "{}; {} runs of other accuracies differ",
        changes.words(),
        all.len()
    );
    let one = |(quantity, [low, high]): (String, [f64; 2])| Undetermined {
        quantity,
        low,
        high,
        reason: reason.clone(),
    };
    found.into_iter().map(one).collect()
}

/// Columns whose extremes differ between runs, with the range of those of larger magnitude: forces first, and those first that differ
/// by the largest part of the largest of their dimension.
fn apart(accuracy: f64, all: &[Vec<ColumnPeak>]) -> Vec<(String, [f64; 2])> {
    let allowed = APART.max(TIMES * accuracy);
    let mut out = Vec::new();
    for own in &all[0] {
        let is_max = own.largest() == own.max;
        let extreme = |peak: &ColumnPeak| {
            if is_max {
                peak.max.value
            } else {
                peak.min.value
            }
        };
        let same = all
            .iter()
            .filter_map(|run| run.iter().find(|peak| peak.column == own.column));
        let range = same
            .map(extreme)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            });
        let kind = all[0].iter().filter(|peak| peak.dimension == own.dimension);
        let most = kind
            .map(|peak| peak.largest().value.abs())
            .fold(0.0, f64::max);
        let largest = range[0].abs().max(range[1].abs());
        let apart = (range[1] - range[0]) / largest;
        if largest > SMALL * most && apart > allowed {
            out.push((
                own.dimension != Dimension::FORCE,
                (range[1] - range[0]) / most,
                own.column.clone(),
                range,
            ));
        }
    }
    out.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
    out.into_iter()
        .map(|(_, _, column, range)| (column, range))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steps::ColumnInstant;

    fn peaks(value: f64) -> Vec<ColumnPeak> {
        let at = |value: f64| ColumnInstant { value, time: 1.0 };
        let column = |column: &str, value: f64| ColumnPeak {
            column: column.to_owned(),
            dimension: Dimension::FORCE,
            max: at(value),
            min: at(0.0),
        };
        vec![column("w.vertical", value), column("still.vertical", 50.0)]
    }

    fn lost(losses: usize) -> ContactChanges {
        ContactChanges { losses, strikes: 0 }
    }

    /// The range is that of all runs; columns that agree, and runs whose contacts last, have none.
    #[test]
    fn ranges_of_runs_that_differ_are_told() {
        let mut values = [110.0, 97.0, 104.0, 120.0].into_iter();
        let mut again = |_: f64| values.next().map(peaks);
        let few = lost(OFTEN - 1);
        assert!(undetermined(1e-4, few, &peaks(100.0), &mut again).is_empty());
        let found = undetermined(1e-4, lost(OFTEN), &peaks(100.0), &mut again);
        assert_eq!(found.len(), 1, "{found:?}");
        let Undetermined {
            quantity,
            low,
            high,
            ..
        } = &found[0];
        assert_eq!(
            (quantity.as_str(), *low, *high),
            ("w.vertical", 97.0, 120.0)
        );
        // a run that agrees is not repeated again
        let mut count = 0;
        let mut same = |_: f64| {
            count += 1;
            Some(peaks(100.5))
        };
        let strikes = ContactChanges {
            losses: 0,
            strikes: OFTEN,
        };
        assert!(undetermined(1e-4, strikes, &peaks(100.0), &mut same).is_empty());
        assert_eq!(count, 1);
    }

    /// A flange that leans on its rail from the start, leaves it and strikes again has struck once.
    #[test]
    fn flanges_strike_where_their_force_has_been_zero() {
        let mut record = NamedColumns::default();
        let forces = vec![3.0, 0.0, 0.0, -2.0, -1.0];
        record.push("w.lateral", Dimension::FORCE, forces);
        let found = ContactChanges::new(0, ["w"].into_iter(), &record);
        assert_eq!(found.strikes, 1);
    }
}
