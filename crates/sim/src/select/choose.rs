//! Which foundation a scene needs: the lowest fidelity whose error, predicted or measured against a higher one, is
//! allowed.

use std::ops::ControlFlow;

use super::fidelity::{Choice, FoundationProvider, Reason, Selection};
use super::joint;
use super::rung::Fidelity;
use super::search::{Candidate, Outcome, Search};
use crate::{Analysis, Scene};

/// Modes that are looked at where no more are needed to tell rigid, influence and two modes.
const FEW: usize = 3;
/// Chooses a fidelity for every structure with a tolerance (`None`: its foundation is given), those that are carried
/// by bodies first, the others held at theirs (influence before their turn), and runs the scene. `watch` sees the
/// time that every run reaches, and may stop the choice.
///
/// First the errors of the fidelities are predicted, see [`PredictedErrors`](crate::PredictedErrors): fidelities expected to err
/// by much more than the tolerance are skipped; one expected to err by much less is taken without a higher one to
/// check it. What is left is compared: rigid and influence with the first [`Fidelity::Modal`] whose highest frequency
/// exceeds three times that of the bodies on their contacts, a number of modes with the next of 2, 4, 6, 8, 12, 16
/// and full, full with half its mesh. The run of the fidelity chosen is kept. Where several structures were refined,
/// all are checked together and raised together until the sum of their tolerances holds. Not controlled: pitch, roll,
/// lateral motion and forces, gauges and what lies between output times.
///
/// # Errors
/// A foundation that is given or influence that cannot be built; a scene that starts on no foundation.
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
    // what a body carries is small: it is tried on all that is still cheap
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
            // where they cannot be found, the fidelities say why
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
