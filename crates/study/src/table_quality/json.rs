//! Findings as JSON: `girderway-check/1`.

use serde_json::{Value, json};
use splines::quality::{BlockExtreme, ReadingError, SlopeJump};

use super::findings::{ExactValues, TableQuality, TableVerdict};
use super::readings::{DirectFindings, ReadingFindings, WHEELS};
use super::subject::TableSource;

/// Name of the format with its version.
pub const FORMAT: &str = "girderway-check/1";

/// All findings as JSON.
#[must_use]
pub fn json(subject: &TableSource, all: &[TableQuality]) -> Value {
    let tables: Vec<Value> = all.iter().map(table).collect();
    json!({
        "format": FORMAT,
        "file": subject.file,
        "units": subject.units.map(formats::units::Units::json),
        "passed": all.iter().all(|found| found.verdicts.is_empty()),
        "notes": subject.notes,
        "tables": tables,
    })
}

fn table(found: &TableQuality) -> Value {
    let table = &found.item.table;
    let exact_values = match &found.exact_values {
        ExactValues::Surface => json!({ "from": "surface" }),
        ExactValues::Beam(beam) => {
            json!({ "from": "table", "EI": 1.0 / beam.bending, "error": beam.error })
        }
        ExactValues::None => Value::Null,
    };
    let failed: Vec<Value> = found.verdicts.iter().map(verdict).collect();
    let risks: Vec<Value> = found
        .risks
        .iter()
        .map(|risk| json!({ "kind": risk.word(), "text": risk.to_string() }))
        .collect();
    let beyond: Vec<Value> = found
        .beyond
        .iter()
        .map(|row| {
            json!({
                "x": row.x, "z": row.z, "parabola": row.parabola, "cubic": row.cubic, "tangent": row.tangent,
                "line": row.line, "spread": row.spread(),
            })
        })
        .collect();
    json!({
        "id": found.item.id,
        "name": found.item.name,
        "x": table.x(),
        "z": table.z(),
        "direct": found.item.is_direct(),
        "digits": found.digits.digits,
        "slack": found.digits.slack,
        "asymmetry": found.asymmetry.as_ref().map(extreme),
        "eigenvalues": found.spectrum.map(|s| [s.smallest, s.largest]),
        "supports": found.supports,
        "exact": exact_values,
        "readings": found.readings.iter().map(|r| reading(found, r)).collect::<Vec<_>>(),
        "beyond": beyond,
        "hazards": risks,
        "failed": failed,
    })
}

fn reading(found: &TableQuality, reading: &ReadingFindings) -> Value {
    let error = |e: &ReadingError, relative: f64| {
        json!({
            "relative": relative, "scale": e.scale, "largest": extreme(&e.largest),
            "diagonal": e.diagonal.as_ref().map(extreme),
        })
    };
    let mut object = json!({
        "reading": reading.method.word(),
        "error": reading.error.as_ref().map(|e| error(e, found.relative(e))),
        "error_between_supports": reading.span.as_ref().map(|e| error(e, e.relative())),
    });
    if let Some(own) = &reading.direct {
        direct(&mut object, own, found.load);
    }
    object
}

fn direct(object: &mut Value, own: &DirectFindings, load: Option<f64>) {
    object["asymmetry"] = extreme(&own.asymmetry);
    object["eigenvalues"] = json!([own.spectrum.smallest, own.spectrum.largest]);
    let layouts = WHEELS.iter().zip(&own.layouts).zip(&own.indefinite_fractions).map(|((wheels, layout), fraction)| {
        json!({
            "wheels": wheels, "at": layout.places, "eigenvalue": layout.smallest, "stiffness": layout.stiffness,
            "indefinite_share": fraction,
        })
    });
    object["layouts"] = layouts.collect();
    object["slope_jump"] = own.slope_jump.as_ref().map_or(Value::Null, slope_jump);
    if let Some(pair) = &own.pair {
        object["pair"] = json!({
            "at": pair.work.at, "work_by_load_squared": pair.work.work, "stored_by_load_squared": pair.work.stored,
            "slope_jump": pair.slope_jump.as_ref().map(slope_jump),
        });
    }
    if let Some(load) = load {
        object["work"] = json!(load * load * own.asymmetry.value);
        if let Some(pair) = &own.pair {
            object["pair"]["work"] = json!(load * load * pair.work.work);
        }
    }
}

fn extreme(found: &BlockExtreme) -> Value {
    json!({ "value": found.value, "x": found.x, "z": found.z })
}

fn slope_jump(found: &SlopeJump) -> Value {
    json!({ "x": found.x, "before": found.before, "beyond": found.beyond })
}

fn verdict(verdict: &TableVerdict) -> Value {
    match verdict {
        TableVerdict::Asymmetric(worst) => json!({ "check": "symmetric", "worst": extreme(worst) }),
        TableVerdict::Indefinite(s) => {
            json!({ "check": "positive-semidefinite", "eigenvalues": [s.smallest, s.largest] })
        }
        TableVerdict::Error(method, error, tolerance) => {
            json!({ "check": "error", "reading": method.word(), "error": error, "tolerance": tolerance })
        }
        TableVerdict::Unknown(method) => {
            json!({ "check": "error", "reading": method.word(), "error": null })
        }
    }
}
