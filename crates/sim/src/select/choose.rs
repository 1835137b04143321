//! Choice of the foundations of a scene: the lowest fidelity whose error, predicted or measured against a higher
//! fidelity, is within the tolerance.

use std::ops::ControlFlow;

use super::fidelity::Fidelity;
use super::joint;
use super::search::{Candidate, Outcome, Search};
use super::selection::{Choice, FoundationProvider, Reason, Selection};
use crate::{Analysis, Scene};

/// Number of modes that are computed first; they suffice to decide between rigid, influence and two modes.
const FEW: usize = 3;
/// Chooses a fidelity for every structure with a tolerance (`None`: the foundation of the structure is fixed) and
/// runs the scene. Structures that are carried by bodies are chosen first. While one structure is chosen, the others
/// keep the fidelity chosen for them, or influence before their turn. `watch` receives the time that every run has
/// reached, and may stop the choice.
///
/// First the errors of the fidelities are predicted, see [`PredictedErrors`](crate::PredictedErrors). A fidelity
/// whose predicted error is much larger than the tolerance is skipped; one whose predicted error is much smaller is
/// accepted without a check against a higher fidelity. The remaining fidelities are compared by runs: rigid and
/// influence with the first [`Fidelity::Modal`] whose highest frequency exceeds three times that of the bodies on
/// their contacts, a number of modes with the next of 2, 4, 6, 8, 12, 16 and full, and full with a mesh of half as
/// many elements. The run of the chosen fidelity is the result. Where several structures were refined, all are
/// checked together and refined together until the sum of their tolerances is met. Errors of pitch, roll, lateral
/// motion and forces, of gauges, and of values between output times are not controlled.
///
/// # Errors
/// A fixed foundation or an influence foundation that cannot be built, or a scene that cannot be started on any
/// foundation.
pub fn choose<L: FoundationProvider>(
    scene: &Scene,
    tolerances: &[Option<f64>],
    provider: &mut L,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Selection, L::Error> {
    let mut foundations = (0..tolerances.len())
        .map(|structure| provider.foundation(structure, Fidelity::Influence))
        .collect::<Result<Vec<_>, _>>()?;
    let mut choices: Vec<Choice> = Vec::new();
    let (mut last, mut runs) = (None, 0);
    // A structure on a body is small, so it is chosen while the other foundations are still cheap.
    let (riding, standing): (Vec<usize>, Vec<usize>) =
        (0..tolerances.len()).partition(|&structure| foundations[structure].carrier.is_some());
    for structure in riding.into_iter().chain(standing) {
        let Some(tolerance) = tolerances[structure] else { continue };
        if scene.analysis == Analysis::QuasiStatic {
            choices.push(Choice::new(structure, Fidelity::Influence, Reason::QuasiStatic));
            continue;
        }
        let few = match provider.modes(structure, FEW) {
            Ok(None) => {
                choices.push(Choice::new(structure, Fidelity::Influence, Reason::NoMass));
                continue;
            }
            // Where the modes cannot be computed, building the fidelities returns the error.
            few => few.ok().flatten(),
        };
        let search = Search::new(scene, tolerance, structure, &mut foundations, provider, watch);
        let Outcome { choice, found, runs: own } = search.run(few)?;
        let Candidate { foundation, run, .. } = found;
        foundations[structure] = foundation;
        runs += own;
        choices.push(choice);
        last = Some(run);
    }
    let run = match last {
        Some(run) => run,
        None => {
            runs += 1;
            provider.run(scene, &foundations, watch)?
        }
    };
    let selection = Selection { choices, run, runs };
    let mut settled = joint::settle(scene, tolerances, foundations, provider, watch, selection);
    settled.choices.sort_by_key(|choice| choice.structure);
    Ok(settled)
}
