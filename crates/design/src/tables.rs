//! `envelope.csv` and `reactions.csv`.

use formats::design::{Design, TILTING, TROLLEY_DRIVES};
use trains::{Governing, TrainPosition};

use crate::loads::LoadKind;
use crate::outcome::DesignResult;
use crate::words::{kind_word, plane_word, quantity_word};

/// A number in as many digits as it needs, without a negative zero.
fn text(value: f64) -> String {
    format!("{}", value + 0.0)
}

/// Positions of the trains of a state, and whether each is turned; separated by semicolons for several trains.
fn places(trains: &[TrainPosition]) -> [String; 2] {
    let join = |each: &dyn Fn(&TrainPosition) -> String| {
        trains.iter().map(each).collect::<Vec<_>>().join(";")
    };
    [
        join(&|train| text(train.position)),
        join(&|train| train.stance.turned.to_string()),
    ]
}

/// The envelopes of all cases along the rails, as CSV.
///
/// # Errors
/// None in practice: the text is written into memory.
pub fn envelope_csv(design: &Design, result: &DesignResult) -> Result<String, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record([
        "case",
        "rail",
        "plane",
        "x",
        "quantity",
        "kind",
        "value",
        "position",
        "turned",
        "moment",
        "shear",
        "deflection",
    ])?;
    let rails = design.spec.rails();
    for (number, case) in result.cases.iter().enumerate() {
        for row in &case.envelopes.envelopes {
            let Governing {
                value,
                x,
                trains,
                coincident,
                ..
            } = &row.governing;
            let [position, turned] = places(trains);
            let [moment, shear, deflection] = coincident.map(text);
            let plane = plane_word(row.quantity).to_owned();
            out.write_record([
                (number + 1).to_string(),
                rails[row.rail].name.clone(),
                plane,
                text(*x),
                quantity_word(row.quantity).to_owned(),
                kind_word(row.is_max).to_owned(),
                text(*value),
                position,
                turned,
                moment,
                shear,
                deflection,
            ])?;
        }
    }
    finish(out)
}

/// Reactions of all cases by load, as CSV.
///
/// # Errors
/// None in practice: the text is written into memory.
pub fn reactions_csv(result: &DesignResult) -> Result<String, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    out.write_record([
        "case",
        "support",
        "direction",
        "load",
        "kind",
        "value",
        "position",
        "turned",
    ])?;
    for (number, case) in result.cases.iter().enumerate() {
        let number = (number + 1).to_string();
        for reaction in &case.reactions {
            let dead = reaction.extremes[0].dead;
            for kind in ["max", "min"] {
                let name = [
                    number.as_str(),
                    &reaction.name.support,
                    &reaction.name.direction,
                    "dead",
                    kind,
                ];
                out.write_record(name.into_iter().chain([text(dead).as_str(), "", ""]))?;
            }
        }
        for (kind, reactions) in &case.by_load {
            let load = load_word(*kind);
            for reaction in reactions {
                for (index, governing) in reaction.extremes.iter().enumerate() {
                    let [position, turned] = places(&governing.trains);
                    let name = [&number, &reaction.name.support, &reaction.name.direction]
                        .map(String::as_str);
                    let value = text(governing.value);
                    let rest = [load, kind_word(index == 0), &value, &position, &turned];
                    out.write_record(name.into_iter().chain(rest))?;
                }
            }
        }
    }
    finish(out)
}

/// Word of a load.
#[must_use]
pub const fn load_word(kind: LoadKind) -> &'static str {
    match kind {
        LoadKind::All => "all",
        LoadKind::Vertical => "vertical",
        LoadKind::SideThrust => "side thrust",
        LoadKind::Traction => "traction",
        LoadKind::Buffer => "buffer",
        LoadKind::Skewing => "skewing",
        LoadKind::TrolleyDrives => TROLLEY_DRIVES,
        LoadKind::Tilting => TILTING,
    }
}

/// The text of a table.
pub(crate) fn finish(out: csv::Writer<Vec<u8>>) -> Result<String, csv::Error> {
    let bytes = out.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
