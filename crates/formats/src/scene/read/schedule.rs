//! Tables of a value as a function of time, and the tables of motions.

use sim::{MotionKind, Profile, Schedule};

use crate::check::Check;
use crate::limits::{ROWS, TIME_RESOLUTION};
use crate::scene::raw::RawMotion;
use crate::text::fault::{Fault, number};
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
    Schedule::new(&rows)
        .map_err(|error| check.faults.add(Fault::new(place, error.to_string())))
        .ok()
}

/// Reads rows (time, value) in the units of the scene; none if the times do not increase.
pub(super) fn read_rows(
    table: &[[f64; 2]],
    place: &Place<'_>,
    unit: Dimension,
    check: &mut Check<'_>,
) -> Option<Vec<[f64; 2]>> {
    if table.is_empty() {
        check.faults.add(
            Fault::new(place, "must have at least one row [time, value]")
                .got("an empty list")
                .of_value(),
        );
        return None;
    }
    let times: Vec<f64> = table.iter().map(|row| row[0]).collect();
    let ordered = check.items(table.len(), &ROWS, place)
        && check.faults.increasing(&times, place)
        && are_apart(&times, place, check);
    let mut rows = Vec::new();
    for (index, [t, value]) in table.iter().enumerate() {
        rows.push([*t, check.number(*value, &place.index(index), unit)]);
    }
    ordered.then_some(rows)
}

/// Whether increasing times are far enough apart. If not, a fault is added for the first time that is too close to
/// the one before it.
fn are_apart(times: &[f64], place: &Place<'_>, check: &mut Check<'_>) -> bool {
    let largest = times
        .iter()
        .fold(1.0, |largest: f64, t| largest.max(t.abs()));
    let least = TIME_RESOLUTION * largest;
    let close = times.windows(2).position(|pair| pair[1] - pair[0] < least);
    if let Some(first) = close {
        let expected = format!("must be at least {} after the previous time", number(least));
        let fault =
            Fault::new(&place.index(first + 1).index(0), expected).got(number(times[first + 1]));
        let hint = format!(
            "the previous time is {}; represent a jump by a short ramp",
            number(times[first])
        );
        check.faults.add(fault.hint(hint));
    }
    close.is_none()
}

/// A table of a motion: its key, its kind, its rows as written, and the dimension of its values.
pub(super) type MotionTable<'r> = (&'static str, MotionKind, &'r Vec<[f64; 2]>, Dimension);

/// The tables that a motion has. `dimensions` are those of position, speed and acceleration.
pub(super) fn motion_tables(
    motion: &RawMotion,
    dimensions: [Dimension; 3],
) -> Vec<MotionTable<'_>> {
    let tables = [
        ("position", MotionKind::Position, &motion.position),
        ("speed", MotionKind::Speed, &motion.speed),
        (
            "acceleration",
            MotionKind::Acceleration,
            &motion.acceleration,
        ),
    ];
    let given = tables.into_iter().zip(dimensions);
    given
        .filter_map(|((key, kind, table), unit)| Some((key, kind, table.as_ref()?, unit)))
        .collect()
}

/// The prescribed motion of the only one of `tables`, from the position and the speed `start`; a fault if there is no
/// table or more than one.
pub(super) fn read_profile(
    tables: &[MotionTable<'_>],
    start: [f64; 2],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Profile> {
    let &[(key, kind, table, unit)] = tables else {
        let fault = Fault::new(
            at,
            "must have one table: `position`, `speed` or `acceleration`",
        );
        check
            .faults
            .add(fault.got(if tables.is_empty() { "none" } else { "several" }));
        return None;
    };
    let place = at.key(key);
    let rows = read_rows(table, &place, unit, check)?;
    let profile = Profile::new(kind, &rows, start[0], start[1]);
    profile
        .map_err(|error| check.faults.add(Fault::new(&place, error.to_string())))
        .ok()
}
