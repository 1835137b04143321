//! Forces of buffers on the end stops of the rails.

use std::collections::BTreeSet;

use formats::design::Design;
use formats::verdict::OmittedCheck;

use crate::outcome::EndStopForce;

/// The force on each end stop that a train can meet, in each case with a factor of buffer forces: the sum of the buffer forces
/// of its wheels on the rail. A train whose forces have both signs meets the stops at both ends; a force along +x is met at the
/// last coordinate, one along -x at the first.
pub(crate) fn end_stop_forces(design: &Design) -> Vec<EndStopForce> {
    let rails = design.spec.rails();
    let mut out = Vec::new();
    for (number, case) in design.cases.iter().enumerate() {
        let factor = case.factor("buffer");
        if factor == 0.0 {
            continue;
        }
        let distinct: BTreeSet<usize> = case.trains.iter().copied().collect();
        for index in distinct {
            let train = &design.trains[index];
            for (rail, outline) in rails.iter().enumerate() {
                let own = train.wheels.iter().filter(|wheel| wheel.rail == rail);
                let force = factor * own.map(|wheel| wheel.buffer).sum::<f64>();
                let ends = if train.reverses {
                    vec![false, true]
                } else {
                    vec![force > 0.0]
                };
                for is_last in ends.into_iter().filter(|_| force != 0.0) {
                    out.push(EndStopForce {
                        case: number + 1,
                        train: train.name.clone(),
                        rail: outline.name.clone(),
                        is_last,
                        x: outline.range[usize::from(is_last)],
                        factor,
                        force: if is_last { force.abs() } else { -force.abs() },
                    });
                }
            }
        }
    }
    out
}

/// Why end stops have no forces although trains have buffers.
pub(crate) fn left_out(design: &Design) -> Option<OmittedCheck> {
    let has_buffer = design
        .trains
        .iter()
        .flat_map(|train| &train.wheels)
        .any(|wheel| wheel.buffer != 0.0);
    let is_factored = design.cases.iter().any(|case| case.factor("buffer") != 0.0);
    (has_buffer && !is_factored)
        .then(|| OmittedCheck::new("forces on end stops", "no case has a factor for `buffer`"))
}
