//! Rows of `summary.json` on stresses, end stops and pairs of rails.

use formats::LateralSection;
use formats::design::Design;
use serde_json::{Map, Value, json};

use crate::outcome::{DesignResult, EndStopForce, RailPairResponse, StressCheck, WheelStress};
use crate::state_json::{add_state, train_names};
use crate::words::{clause_json, side_word};

/// Adds the members `stresses`, `wheel_stresses`, `end_stops` and `pairs`, where there are any.
pub(crate) fn add_details(summary: &mut Value, design: &Design, result: &DesignResult) {
    let lists = [
        (
            "stresses",
            result
                .stresses
                .iter()
                .map(|check| stress(design, check))
                .collect::<Vec<Value>>(),
        ),
        (
            "wheel_stresses",
            result.wheel_stresses.iter().map(wheel_stress).collect(),
        ),
        ("end_stops", result.end_stops.iter().map(end_stop).collect()),
        (
            "pairs",
            result
                .pairs
                .iter()
                .map(|found| pair(design, found))
                .collect(),
        ),
    ];
    for (key, rows) in lists {
        if !rows.is_empty() {
            summary[key] = json!(rows);
        }
    }
}

fn named(values: &[(&'static str, f64)]) -> Map<String, Value> {
    values
        .iter()
        .map(|(name, value)| ((*name).to_owned(), json!(value + 0.0)))
        .collect()
}

fn stress(design: &Design, check: &StressCheck) -> Value {
    let g = &check.governing;
    let mut out = json!({
        "case": check.case,
        "rail": check.rail,
        "span": check.span,
        "section": check.section,
        "quantity": check.quantity,
        "value": check.value + 0.0,
        "strength": check.strength,
        "utilisation": check.utilisation(),
        "within": check.utilisation() <= 1.0,
        "x": g.x + 0.0,
        "side": side_word(g.side),
        "forces": named(&check.forces),
    });
    if let Some(fibre) = check.fibre {
        out["sampled"] = json!(true);
        if let Some(bound) = check.bound {
            out["bound"] = json!(bound);
        }
        out["fibre"] = json!(fibre);
        out["parts"] = Value::Object(named(&check.parts));
        out["lateral_section"] = json!(check.lateral_section.map(LateralSection::word));
    }
    add_state(&mut out, &train_names(design, check.case - 1), g);
    out
}

fn wheel_stress(found: &WheelStress) -> Value {
    let cycle = |cycle: &crate::WheelCycle| {
        json!({
            "train": cycle.wheel.0,
            "wheel": cycle.wheel.1,
            "vertical": cycle.vertical,
            "shear": cycle.shear,
        })
    };
    let mut out = json!({
        "case": found.case,
        "rail": found.rail,
        "section": found.section,
        "crane_rail": found.crane_rail,
        "fastening": found.fastening.0,
        "fastening_assumed": found.fastening.1,
        "train": found.wheel.0,
        "wheel": found.wheel.1,
        "force": found.force,
        "overlapping": found.overlapping,
        "effective_length": found.length,
        "vertical": found.vertical,
        "shear": found.shear,
        "global_shear": found.global_shear,
        "total_shear": found.total_shear(),
        "cycles": found.cycles.iter().map(cycle).collect::<Vec<_>>(),
    });
    if let (Value::Object(out), Value::Object(clause)) = (&mut out, clause_json(&found.clause)) {
        out.extend(clause);
    }
    if let Some(strength) = found.yield_strength {
        out["strength"] = json!(strength);
        out["utilisation"] = json!(found.vertical / strength);
    }
    out
}

fn end_stop(found: &EndStopForce) -> Value {
    json!({
        "case": found.case,
        "train": found.train,
        "rail": found.rail,
        "stop": if found.is_last { "last" } else { "first" },
        "x": found.x + 0.0,
        "factor": found.factor,
        "force": found.force,
    })
}

fn pair(design: &Design, found: &RailPairResponse) -> Value {
    let mut out = json!({
        "case": found.case,
        "rails": found.rails,
        "quantity": found.quantity,
        "distance": found.distance,
        "value": found.value + 0.0,
        "x": found.x + 0.0,
        "span": found.span,
        "sampled": true,
    });
    add_state(
        &mut out,
        &train_names(design, found.case - 1),
        &found.governing,
    );
    out
}
