//! `summary.json` of a sweep.

use serde_json::{Map, Value, json};

use crate::info::SweepInfo;
use crate::sensitivity::sensitivities;
use crate::statistics::ResultDistribution;
use crate::table::ResultTable;

/// Name and version of the format.
const FORMAT: &str = "girderway-sweep-summary/1";

/// The statistics of all results as JSON: for each its unit, the value of the input as written, its distribution, the
/// runs with its extremes, and its dependence on each axis.
#[must_use]
pub fn summary(info: &SweepInfo, table: &ResultTable) -> Value {
    let mut results = Map::new();
    for (index, name) in table.columns.iter().enumerate() {
        let Some(found) = ResultDistribution::new(&table.column(index)) else {
            continue;
        };
        let [q5, q50, q95, q99] = found.quantiles;
        let mut entry = json!({
            "count": found.count,
            "mean": found.mean,
            "standard_deviation": found.deviation,
            "mean_interval": [found.mean_interval.low, found.mean_interval.high],
            "max": { "value": found.most.0, "run": found.most.1 },
            "min": { "value": found.least.0, "run": found.least.1 },
            "quantiles": { "5": q5, "50": q50, "95": q95, "99": q99 },
            "95_interval": [found.upper_interval.low, found.upper_interval.high],
        });
        if let Some((_, unit, value)) = info.as_written.iter().find(|(known, ..)| known == name) {
            entry["unit"] = json!(unit);
            entry["as_written"] = json!(value);
        }
        let dependence: Map<String, Value> = (table.axes.iter().zip(sensitivities(table, index)))
            .map(|(axis, one)| {
                let values =
                    json!({ "rank_correlation": one.rank_correlation, "first_order": one.first_order });
                (axis.clone(), values)
            })
            .collect();
        if !dependence.is_empty() {
            entry["axes"] = Value::Object(dependence);
        }
        results.insert(name.clone(), entry);
    }
    let axes: Map<String, Value> = info
        .axes
        .iter()
        .map(|[pointer, values]| (pointer.clone(), json!(values)))
        .collect();
    json!({
        "format": FORMAT,
        "name": info.name,
        "status": "done",
        "input": info.input,
        "sampling": info.sampling,
        "seed": info.seed,
        "axes": axes,
        "runs": info.runs,
        "with_results": table.runs.len(),
        "failures": table.failures.len(),
        "results": results,
    })
}
