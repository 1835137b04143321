//! Fatigue: cycles of the stress histories of a run, and their damage.
//!
//! For each stress point with a detail category, cycles are counted by the rainflow method
//! ([`practice::rainflow()`]). The damage of each cycle follows from the S-N curve of the detail in the scene's unit
//! of stress, and the damages are added by Miner's rule. With the damage D of one run and the reference range S_ref
//! at N_ref = 2 million cycles, the equivalent range of a single cycle is S_ref (D N_ref)^(1/3).

use practice::fatigue::Stress;
use practice::{Cycle, Damage, Strength, aisc, rainflow};
use serde_json::{Map, Value, json};

use crate::Error;
use crate::columns::bytes;
use crate::response::Response;
use crate::steps::ColumnInstant;
use formats::scene::{Fatigue, Origin, Scene};
use formats::spec::Detail;
use formats::units::{Dimension, Force, Length, Scale, Units};

/// Range of a stress, relative to its largest magnitude, below which it is rounding.
const ROUNDING: f64 = 1e-9;

/// The S-N curve of a detail, in the unit of stress of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Resistance {
    Eurocode(Strength),
    Aisc(aisc::AiscCurve),
}

/// Cycles and damage of one stress point in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct FatigueResult {
    /// Name of the stress column.
    pub column: String,
    /// Its detail category.
    pub detail: Detail,
    /// Its cycles, in the order in which they close.
    pub cycles: Vec<Cycle>,
    /// Times at which each cycle has its extremes.
    pub times: Vec<[f64; 2]>,
    /// Damage of each cycle.
    pub cycle_damage: Vec<f64>,
    /// Total damage and the largest range.
    pub damage: Damage,
    /// Stress range of the resistance at 2 million cycles, with partial factors.
    pub reference: f64,
    /// Stress range below which a history causes no damage, with partial factors.
    pub limit: f64,
    /// Stress range of a single cycle with the damage of the run, on the line of slope 3 through the reference.
    pub equivalent: f64,
    /// Damage of all runs of the service life; `None` where the scene does not specify their number.
    pub life: Option<f64>,
}

impl Resistance {
    fn new(detail: Detail, fatigue: &Fatigue, units: Units) -> Result<Resistance, practice::Error> {
        let unit = |length, force| {
            Scale {
                from: Units { length, force },
                to: units,
            }
            .factor(Dimension::STRESS)
        };
        match detail {
            Detail::Eurocode(category) => {
                let category = category * unit(Length::Millimetre, Force::Newton);
                Strength::new(Stress::Direct, category, fatigue.loads, fatigue.material)
                    .map(Resistance::Eurocode)
            }
            Detail::Aisc(category) => {
                let ksi = unit(Length::Inch, Force::Kip) / fatigue.loads / fatigue.material;
                aisc::AiscCurve::new(category, ksi).map(Resistance::Aisc)
            }
        }
    }

    fn damage(&self, range: f64) -> Result<f64, practice::Error> {
        match self {
            Resistance::Eurocode(strength) => strength.damage(range),
            Resistance::Aisc(curve) => curve.damage(range),
        }
    }

    fn miner(&self, cycles: &[Cycle]) -> Result<Damage, practice::Error> {
        match self {
            Resistance::Eurocode(strength) => strength.miner(cycles),
            Resistance::Aisc(curve) => curve.miner(cycles),
        }
    }

    /// Stress range at 2 million cycles, and largest stress range without damage.
    fn ranges(&self) -> [f64; 2] {
        match self {
            Resistance::Eurocode(strength) => [strength.reference(), strength.fatigue_limit()],
            Resistance::Aisc(curve) => [curve.reference(), curve.limit()],
        }
    }
}

/// The results of every stress point of a run that has a detail category and a column.
///
/// # Errors
/// [`Error::Cycles`] for a history that cannot be counted.
pub fn fatigue_results(scene: &Scene, response: &Response) -> Result<Vec<FatigueResult>, Error> {
    let mut all = Vec::new();
    for structure in &scene.structures {
        let Origin::Spec { spec, .. } = &structure.origin else {
            continue;
        };
        for cut in &spec.effects {
            for point in &cut.points {
                let column = format!("{}.{}.{}", structure.name, cut.name, point.name);
                let turns = response.turns.iter().find(|(name, _)| *name == column);
                let Some((detail, (_, turns))) = point.detail.zip(turns) else {
                    continue;
                };
                let result = fatigue_result(scene, column.clone(), detail, turns);
                all.push(result.map_err(|source| Error::Cycles {
                    column: column.clone(),
                    source,
                })?);
            }
        }
    }
    Ok(all)
}

/// Cycles and damage of the stress history `turns`.
fn fatigue_result(
    scene: &Scene,
    column: String,
    detail: Detail,
    turns: &[ColumnInstant],
) -> Result<FatigueResult, practice::Error> {
    let fatigue = &scene.output.fatigue;
    let resistance = Resistance::new(detail, fatigue, scene.units)?;
    let values: Vec<f64> = turns.iter().map(|turn| turn.value).collect();
    let mut cycles = rainflow(&values, fatigue.history)?;
    drop_rounding(&mut cycles, &values);
    let each = cycles
        .iter()
        .map(|cycle| Ok(cycle.count * resistance.damage(cycle.range())?))
        .collect::<Result<Vec<f64>, practice::Error>>()?;
    let damage = resistance.miner(&cycles)?;
    let [reference, limit] = resistance.ranges();
    Ok(FatigueResult {
        column,
        detail,
        times: cycles
            .iter()
            .map(|cycle| cycle.samples.map(|at| turns[at].time))
            .collect(),
        cycles,
        cycle_damage: each,
        damage,
        reference,
        limit,
        equivalent: reference * (damage.sum * practice::fatigue::REFERENCE_CYCLES).cbrt(),
        life: fatigue.crossings.map(|crossings| crossings * damage.sum),
    })
}

/// Drops cycles whose range is only rounding of the stress: their number would depend on the units of the scene.
fn drop_rounding(cycles: &mut Vec<Cycle>, stresses: &[f64]) {
    let largest = stresses.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
    cycles.retain(|cycle| cycle.range() > ROUNDING * largest);
}

impl FatigueResult {
    /// Number of its cycles; half cycles count as one half.
    #[must_use]
    pub fn count(&self) -> f64 {
        self.cycles.iter().map(|cycle| cycle.count).sum()
    }

    /// The result as a member of `fatigue`.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut out = json!({
            "detail": match self.detail {
                Detail::Eurocode(category) => json!(category),
                Detail::Aisc(_) => json!(self.detail.word()),
            },
            "reference": self.reference,
            "limit": self.limit,
            "cycles": self.count(),
            "largest_range": self.damage.largest_range,
            "within_limit": self.damage.below_limit,
            "damage": self.damage.sum,
            "equivalent_range": self.equivalent,
            "crossings_to_failure": self.damage.repeats(),
        });
        if let Some(life) = self.life {
            out["life_damage"] = json!(life);
        }
        out
    }
}

/// The member `fatigue` of a run's summary; `None` without stress points.
#[must_use]
pub fn json(results: &[FatigueResult]) -> Option<Value> {
    let all: Map<_, _> = results
        .iter()
        .map(|result| (result.column.clone(), result.json()))
        .collect();
    (!all.is_empty()).then_some(Value::Object(all))
}

/// Cycles of all points of a run as comma-separated values; `None` without stress points.
///
/// # Errors
/// None in practice: writing to memory does not fail.
pub fn csv(results: &[FatigueResult]) -> Result<Option<Vec<u8>>, csv::Error> {
    if results.is_empty() {
        return Ok(None);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["point", "range", "mean", "count", "from", "to", "damage"])?;
    for result in results {
        let each = result.cycles.iter().zip(&result.times);
        for ((cycle, [from, to]), damage) in each.zip(&result.cycle_damage) {
            let numbers = [
                cycle.range(),
                cycle.mean() + 0.0,
                cycle.count,
                *from,
                *to,
                *damage,
            ];
            let numbers = numbers.into_iter().map(|number| format!("{number:?}"));
            writer.write_record(std::iter::once(result.column.clone()).chain(numbers))?;
        }
    }
    bytes(writer).map(Some)
}

#[cfg(test)]
mod tests {
    use practice::Repetition;

    use super::*;

    /// Analytic: a history of one cycle between 0 and 100 with ripples of rounding has that cycle alone, in any unit.
    #[test]
    fn ripples_of_rounding_are_no_cycles() {
        for unit in [1.0, 1e-3, 6.894_757e6] {
            let values = [0.0, 100.0, 100.0 - 1e-12, 100.0, 0.0, 2e-13, 0.0].map(|s| unit * s);
            let mut cycles = rainflow(&values, Repetition::Once).expect("a history");
            drop_rounding(&mut cycles, &values);
            let total: f64 = cycles.iter().map(|cycle| cycle.count).sum();
            let is_whole = |cycle: &Cycle| (cycle.range() / (100.0 * unit) - 1.0).abs() < 1e-12;
            assert!(total == 1.0 && cycles.iter().all(is_whole), "{cycles:?}");
        }
    }
}
