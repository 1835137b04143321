//! What a sweep is, in the words of its report.

use formats::sweep::{AxisValues, ResultKind, Sampling, Sweep, SweepInput};
use formats::units::{Dimension, Units};
use serde::{Deserialize, Serialize};

use crate::outcome::RunRow;

/// Description of a sweep. Shards carry it, so that a merged sweep has the report of one made in one piece.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepInfo {
    /// Name of the sweep.
    pub name: String,
    /// Name of its file.
    pub file: String,
    /// File of the scene or design.
    pub input: String,
    /// Whether it is a design.
    pub is_design: bool,
    /// Word of the sampling.
    pub sampling: String,
    /// Seed; of no meaning for grids.
    pub seed: u64,
    /// Number of runs.
    pub runs: usize,
    /// The axes: pointer, and values in words.
    pub axes: Vec<[String; 2]>,
    /// Words of the results.
    pub results: Vec<String>,
    /// Names of the results of the input as it is written, with units and values.
    pub as_written: Vec<(String, String, f64)>,
}

impl SweepInfo {
    /// The description of a sweep in file `file`; `as_written` are the results of its input without values of axes, in
    /// these units.
    #[must_use]
    pub fn new(sweep: &Sweep, file: &str, units: Units, as_written: &RunRow) -> SweepInfo {
        let label = |dimension: Dimension| units.label(dimension);
        let results = as_written
            .names
            .iter()
            .zip(&as_written.dimensions)
            .zip(&as_written.values);
        SweepInfo {
            name: sweep.name.clone(),
            file: file.to_owned(),
            input: sweep.input.file().to_owned(),
            is_design: matches!(sweep.input, SweepInput::Design(_)),
            sampling: sampling_word(sweep.sampling).to_owned(),
            seed: sweep.seed,
            runs: sweep.count,
            axes: sweep
                .axes
                .iter()
                .map(|axis| [axis.pointer.clone(), values_phrase(&axis.values)])
                .collect(),
            results: sweep.results.iter().map(result_word).collect(),
            as_written: results
                .map(|((name, dimension), value)| (name.clone(), label(*dimension), *value))
                .collect(),
        }
    }
}

/// The word of a sampling in sweep files.
const fn sampling_word(sampling: Sampling) -> &'static str {
    match sampling {
        Sampling::Grid => "grid",
        Sampling::Latin => "latin",
        Sampling::Sobol => "sobol",
    }
}

/// The word of a result in sweep files.
fn result_word(kind: &ResultKind) -> String {
    match kind {
        ResultKind::Peaks => "peaks".to_owned(),
        ResultKind::Extremes => "extremes".to_owned(),
        ResultKind::Fatigue => "fatigue".to_owned(),
        ResultKind::Ratios => "ratios".to_owned(),
        ResultKind::Column(name) => name.clone(),
    }
}

/// The values of an axis in words.
fn values_phrase(values: &AxisValues) -> String {
    /// Values of a list that are written out.
    const SHOWN: usize = 8;
    match values {
        AxisValues::List(list) => {
            let shown: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
            let more = if list.len() > SHOWN {
                format!(" and {} more", list.len() - SHOWN)
            } else {
                String::new()
            };
            format!("{}{more}", shown.join(", "))
        }
        AxisValues::Range(from, to, count) => format!("{count} values from {from} to {to}"),
        AxisValues::Uniform(low, high) => format!("uniform from {low} to {high}"),
        AxisValues::Normal(mean, deviation) => {
            format!("normal, mean {mean}, standard deviation {deviation}")
        }
        AxisValues::Lognormal(mean, deviation) => {
            format!("lognormal, mean {mean}, standard deviation {deviation}")
        }
    }
}
