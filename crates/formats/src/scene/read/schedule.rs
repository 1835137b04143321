//! Tables of a value as a function of time.

use sim::Schedule;

use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads a piecewise function of time from rows (time, value), in the units of the scene.
pub(super) fn read_schedule(
    table: &[[f64; 2]],
    place: &Place<'_>,
    unit: Dimension,
    check: &mut Check<'_>,
) -> Option<Schedule> {
    let rows = read_rows(table, place, unit, check)?;
    Schedule::new(&rows).map_err(|error| check.faults.add(Fault::new(place, error.to_string()))).ok()
}

/// Reads rows (time, value) in the units of the scene; none if the times do not increase.
pub(super) fn read_rows(
    table: &[[f64; 2]],
    place: &Place<'_>,
    unit: Dimension,
    check: &mut Check<'_>,
) -> Option<Vec<[f64; 2]>> {
    if table.is_empty() {
        check.faults.add(Fault::new(place, "must have at least one row [time, value]").got("an empty list"));
        return None;
    }
    let times: Vec<f64> = table.iter().map(|row| row[0]).collect();
    let ordered = check.faults.increasing(&times, place);
    let mut rows = Vec::new();
    for (index, [t, value]) in table.iter().enumerate() {
        rows.push([*t, check.number(*value, &place.index(index), unit)]);
    }
    ordered.then_some(rows)
}
