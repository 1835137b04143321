//! Combinations of AIST Technical Report 13 for the runways of mill buildings, and groups of ASCE 7.
//!
//! The combinations contain the loads of a runway alone; roof, wind, earthquake, fluids, soil and temperature belong
//! to the building. The loads with index m are those of all cranes that may act together, with index s those of one
//! crane.

use super::asce::CraneOperation;
use super::clause::{CodeClause, Evidence, aist_2020, asce_7};
use super::combination::{CraneLoad, FactoredLoad, GroupUse, LoadFactor, LoadGroup};

/// Which loads a combination contains besides dead load and crane.
#[derive(Clone, Copy, PartialEq)]
enum Cranes {
    /// All cranes that may act together.
    Several,
    /// One crane.
    One,
    /// One crane without payload.
    OneEmpty,
}

/// A combination: its name, the cranes, and the factors of dead load, crane, hoisted load, impact, side thrust,
/// traction, live load and buffer force.
type Row = (&'static str, Cranes, [f64; 8]);

/// Combinations for allowable stress design.
const ALLOWABLE: [Row; 15] = [
    (
        "1",
        Cranes::Several,
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "1a",
        Cranes::Several,
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "2",
        Cranes::Several,
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    ),
    (
        "2a",
        Cranes::Several,
        [1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0],
    ),
    ("2b", Cranes::One, [1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0]),
    (
        "4a",
        Cranes::Several,
        [1.0, 1.0, 0.75, 0.0, 0.75, 0.75, 0.75, 0.0],
    ),
    (
        "4b",
        Cranes::One,
        [1.0, 1.0, 0.75, 0.75, 0.0, 0.75, 0.75, 0.0],
    ),
    (
        "5a",
        Cranes::Several,
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "6a1",
        Cranes::Several,
        [1.0, 1.0, 0.75, 0.0, 0.0, 0.0, 0.75, 0.0],
    ),
    (
        "7",
        Cranes::Several,
        [0.6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "8",
        Cranes::Several,
        [0.6, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    ("9", Cranes::One, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.67]),
    (
        "10",
        Cranes::OneEmpty,
        [0.6, 0.6, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
    ),
    (
        "11 with traction",
        Cranes::OneEmpty,
        [0.6, 0.6, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    ),
    (
        "11 with buffer",
        Cranes::OneEmpty,
        [0.6, 0.6, 1.0, 0.0, 0.0, 0.0, 0.0, 0.67],
    ),
];

/// Combinations for strength design.
const STRENGTH: [Row; 14] = [
    (
        "1",
        Cranes::Several,
        [1.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "1a",
        Cranes::Several,
        [1.4, 1.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "2",
        Cranes::Several,
        [1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 1.6, 0.0],
    ),
    (
        "2a",
        Cranes::Several,
        [1.2, 1.2, 1.0, 0.0, 1.0, 1.0, 1.6, 0.0],
    ),
    (
        "2b",
        Cranes::Several,
        [1.2, 1.2, 1.6, 0.0, 1.6, 1.6, 1.0, 0.0],
    ),
    ("2c", Cranes::One, [1.2, 1.2, 1.6, 1.6, 0.0, 1.6, 1.0, 0.0]),
    (
        "3a",
        Cranes::Several,
        [1.2, 1.2, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0],
    ),
    (
        "4a",
        Cranes::Several,
        [1.2, 1.2, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    ),
    (
        "6 and 7",
        Cranes::Several,
        [0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    (
        "7a",
        Cranes::Several,
        [0.9, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ),
    ("8", Cranes::One, [1.2, 1.2, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
    (
        "9",
        Cranes::OneEmpty,
        [0.9, 0.9, 1.6, 0.0, 1.6, 0.0, 0.0, 0.0],
    ),
    (
        "10 with traction",
        Cranes::One,
        [0.9, 0.9, 0.0, 0.0, 0.0, 1.6, 0.0, 0.0],
    ),
    (
        "10 with buffer",
        Cranes::One,
        [0.9, 0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    ),
];

/// The combinations of AIST Technical Report 13 with the loads of a runway, for [`GroupUse::AllowableStress`] or
/// [`GroupUse::Strength`]; none for other uses.
///
/// In the combinations with [`CraneLoad::LeastHoistLoad`] the crane carries its least load.
///
/// # Source
/// AIST TR-13 (draft of 2020), 3.10.2, by a public program that quotes it.
#[must_use]
pub fn mill_combinations(purpose: GroupUse) -> Vec<LoadGroup> {
    let rows: &[Row] = match purpose {
        GroupUse::AllowableStress => &ALLOWABLE,
        GroupUse::Strength => &STRENGTH,
        _ => &[],
    };
    rows.iter()
        .map(|row| mill_combination(row, purpose))
        .collect()
}

/// One combination.
fn mill_combination(&(name, cranes, factors): &Row, purpose: GroupUse) -> LoadGroup {
    let hoist = match cranes {
        Cranes::OneEmpty => CraneLoad::LeastHoistLoad,
        _ => CraneLoad::HoistLoad,
    };
    let order = [
        CraneLoad::Dead,
        CraneLoad::SelfWeight,
        hoist,
        CraneLoad::Impact,
        CraneLoad::SideThrust,
        CraneLoad::Traction,
        CraneLoad::Live,
        CraneLoad::BufferForce,
    ];
    let present = order
        .into_iter()
        .zip(factors)
        .filter(|(_, factor)| *factor != 0.0);
    LoadGroup {
        name,
        purpose,
        is_single_crane: cranes != Cranes::Several,
        loads: numbers(present),
        clause: aist_2020("3.10.2", Evidence::Used),
    }
}

/// Loads with factors that are numbers.
fn numbers(loads: impl IntoIterator<Item = (CraneLoad, f64)>) -> Vec<FactoredLoad> {
    let factored = |(load, factor)| FactoredLoad {
        load,
        factor: LoadFactor::Number(factor),
    };
    loads.into_iter().map(factored).collect()
}

/// The fatigue combination of AIST Technical Report 13: one crane with its load, and half of its side thrust, without
/// impact.
///
/// # Source
/// AIST TR-13 (draft of 2020), 3.10.2, by a public program that quotes it.
#[must_use]
pub fn mill_fatigue() -> LoadGroup {
    LoadGroup {
        name: "fatigue",
        purpose: GroupUse::Fatigue,
        is_single_crane: true,
        loads: numbers([
            (CraneLoad::SelfWeight, 1.0),
            (CraneLoad::HoistLoad, 1.0),
            (CraneLoad::SideThrust, 0.5),
        ]),
        clause: aist_2020("3.10.2", Evidence::Used),
    }
}

/// The crane loads of ASCE 7 with their fractions: wheel loads with impact, the lateral force with 0.2 of hoisted load
/// and trolley, the longitudinal force with 0.1 of the wheel loads. The load combinations of chapter 2 treat them as
/// live load.
///
/// The factor of [`CraneLoad::Impact`] applies to the largest wheel loads, that of [`CraneLoad::SideThrust`] to the
/// weight of hoisted load, trolley and hoist, that of [`CraneLoad::Traction`] to the largest wheel loads.
///
/// # Source
/// ASCE/SEI 7-16, 4.9.3 to 4.9.5.
#[must_use]
pub fn asce_group(operation: CraneOperation) -> LoadGroup {
    let clause: CodeClause = asce_7("4.9.3 to 4.9.5", Evidence::Used);
    let is_powered = operation != CraneOperation::HandGeared;
    let horizontal = [(CraneLoad::SideThrust, 0.2), (CraneLoad::Traction, 0.1)];
    let vertical = [
        (CraneLoad::SelfWeight, 1.0),
        (CraneLoad::HoistLoad, 1.0),
        (CraneLoad::Impact, operation.impact()),
    ];
    LoadGroup {
        name: "crane loads",
        purpose: GroupUse::AllowableStress,
        is_single_crane: false,
        loads: numbers(
            vertical
                .into_iter()
                .chain(horizontal.into_iter().filter(|_| is_powered)),
        ),
        clause,
    }
}
