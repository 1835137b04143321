//! How far first order holds for a run: what the axial forces under its largest loads would change.

use fea::{Preload, RailForce, second_order_change};
use formats::scene::motion::SimulationInput;
use formats::scene::{Foundation, Origin, Scene};
use formats::text::number::{number, rounded};

use crate::case_result::FirstOrderDoubt;
use crate::columns::NamedColumns;

/// Relative change from which it is told, and from which it is a warning, as codes ask for second order then (EN 1993-1-1,
/// 5.2.1).
const NOTED: f64 = 1e-3;
const WARNED: f64 = 0.1;

/// What is to be told of the structures without preload: the estimates of [`fea::second_order_change`] for the forces of all
/// wheels at the recorded time at which they are largest together, and for the weight of what has mass.
pub(super) fn second_order(
    scene: &Scene,
    input: &SimulationInput,
    record: &NamedColumns,
) -> Vec<FirstOrderDoubt> {
    (0..scene.structures.len())
        .filter_map(|index| of_structure(scene, index, input, record))
        .collect()
}

fn of_structure(
    scene: &Scene,
    index: usize,
    input: &SimulationInput,
    record: &NamedColumns,
) -> Option<FirstOrderDoubt> {
    let structure = &scene.structures[index];
    let Origin::Spec { spec, .. } = &structure.origin else {
        return None;
    };
    if spec.preload.is_some() || structure.foundation == Foundation::Rigid {
        return None;
    }
    let wheels: Vec<(usize, [&[f64]; 3])> = input
        .wheels
        .iter()
        .filter(|wheel| scene.rails[wheel.rail].structure == index)
        .map(|wheel| {
            let parts = ["x", "vertical", "lateral"].map(|part| record.part(&wheel.name, part));
            (scene.rails[wheel.rail].rail, parts)
        })
        .collect();
    let at = |of: &[f64], row: usize| of.get(row).copied().unwrap_or(0.0);
    let total = |row: usize| -> f64 {
        wheels
            .iter()
            .map(|(_, [_, vertical, lateral])| at(vertical, row).hypot(at(lateral, row)))
            .sum()
    };
    let times = record.values("time");
    let row = (0..times.len()).max_by(|&a, &b| total(a).total_cmp(&total(b)))?;
    let force = |(rail, [x, vertical, lateral]): &(usize, [&[f64]; 3])| RailForce {
        rail: *rail,
        x: at(x, row),
        force: [0.0, -at(vertical, row), at(lateral, row)],
    };
    let rails: Vec<RailForce> = wheels
        .iter()
        .map(force)
        .filter(|own| own.force != [0.0; 3])
        .collect();
    if rails.is_empty() {
        return None;
    }
    let (model, own) = spec.unloaded_model().ok()?;
    let size = model.up.iter().map(|a| a * a).sum::<f64>().sqrt();
    let weight = model.up.map(|a| {
        if spec.has_mass() && size > 0.0 {
            -scene.gravity * a / size
        } else {
            0.0
        }
    });
    let loads = Preload {
        acceleration: weight,
        points: Vec::new(),
        rails,
    };
    let time = number(rounded(times[row], 6));
    let change = match second_order_change(&model, &own, &loads) {
        Ok(change) => change,
        Err(fea::Error::Buckled { factor, .. }) => {
            return Some(FirstOrderDoubt {
                is_warning: true,
                text: format!(
                    "{}: under its weight and the wheel forces at t = {time} s the structure would buckle, by axial \
                     forces at {factor:.2} times these loads; the run neglects this; `preload` reports the buckling \
                     mode",
                    structure.name
                ),
            });
        }
        // What the run does not need, such as a direction that nothing resists, is no doubt about it.
        Err(_) => return None,
    };
    let turned = 0.5 * change.rotation * change.rotation;
    let most = change
        .of_displacements()
        .max(change.force)
        .max(change.moment);
    (most >= NOTED).then(|| FirstOrderDoubt {
        is_warning: most >= WARNED,
        text: format!(
            "{}: under its weight and the wheel forces at t = {time} s, when these are largest, second-order effects \
             would change deflections by about {:.1e}, forces by {:.1e} and moments by {:.1e} of the largest, and \
             large rotations would change deflections by {turned:.1e}; the run neglects this; `preload` includes the \
             axial forces",
            structure.name, change.deflection, change.force, change.moment
        ),
    })
}
