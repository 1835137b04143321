//! Joint check of structures that were chosen one after another.

use std::ops::ControlFlow;

use super::distance::distance;
use super::fidelity::{Fidelity, MODES};
use super::selection::{Choice, FidelityTrial, FoundationProvider, RUN_ACCURACY, Reason, SAFE, Selection};
use crate::{Foundation, Scene};

/// Checks all chosen structures together and refines them until their joint error is within the tolerance. Each
/// iteration builds the next fidelity of every structure, runs the scene, and compares the result with the present
/// run. The iteration stops when the difference is at most 0.8 of the sum of the tolerances; otherwise the refined
/// structures and their run replace the present ones. It also stops when no higher fidelity exists or a foundation
/// cannot be built or run. The check is omitted where all structures after the first one stayed at influence, because
/// the error of the first one was then estimated with the final foundations of the others.
pub(super) fn settle<L: FoundationProvider>(
    scene: &Scene,
    tolerances: &[Option<f64>],
    mut foundations: Vec<Foundation>,
    provider: &mut L,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    mut selection: Selection,
) -> Selection {
    let is_open = |choice: &Choice| !matches!(choice.reason, Reason::NoMass | Reason::QuasiStatic);
    let searched: Vec<usize> =
        (0..selection.choices.len()).filter(|&c| is_open(&selection.choices[c])).collect();
    let all: Vec<f64> = searched.iter().filter_map(|&c| tolerances[selection.choices[c].structure]).collect();
    let kept = searched.iter().skip(1).all(|&c| selection.choices[c].fidelity == Fidelity::Influence);
    if kept || !selection.run.status.is_complete() {
        return selection;
    }
    let mut finer = scene.clone();
    finer.accuracy = all.iter().fold(finer.accuracy, |least, own| least.min(RUN_ACCURACY * own));
    let tolerance: f64 = all.iter().sum();
    let mut is_raised = false;
    loop {
        let raised: Vec<Fidelity> = searched.iter().map(|&c| above(&selection.choices[c])).collect();
        if searched.iter().zip(&raised).all(|(&c, fidelity)| selection.choices[c].fidelity == *fidelity) {
            return doubted(selection, &searched, is_raised, Reason::Highest);
        }
        for (&c, &fidelity) in searched.iter().zip(&raised) {
            let structure = selection.choices[c].structure;
            match provider.foundation(structure, fidelity) {
                Ok(foundation) => foundations[structure] = foundation,
                Err(_) => return doubted(selection, &searched, true, Reason::Unchecked),
            }
        }
        let higher = match provider.run(&finer, &foundations, watch) {
            Ok(higher) if higher.status.is_complete() => higher,
            _ => return doubted(selection, &searched, true, Reason::Unchecked),
        };
        selection.runs += 1;
        let estimate = distance(&selection.run, &higher, scene);
        let stages = selection.run.counts.stages as u64;
        let is_enough = estimate <= SAFE * tolerance;
        for (&c, &against) in searched.iter().zip(&raised) {
            let choice = &mut selection.choices[c];
            choice.tried.push(FidelityTrial { fidelity: choice.fidelity, estimate, against, stages });
            if !is_enough {
                choice.fidelity = against;
            } else if is_raised {
                (choice.reason, choice.estimate) = (Reason::Sufficient, Some(estimate));
            } else {
                choice.estimate = choice.estimate.map(|own| own.max(estimate));
            }
        }
        if is_enough {
            return selection;
        }
        is_raised = true;
        selection.run = higher;
    }
}

/// Fidelity that is used to check a choice: the one that it was compared with, or else the next higher one.
fn above(choice: &Choice) -> Fidelity {
    let checked = choice.tried.iter().rev().find(|tried| tried.fidelity == choice.fidelity);
    match (checked, choice.fidelity) {
        (Some(tried), _) => tried.against,
        (None, Fidelity::Rigid) => Fidelity::Influence,
        (None, Fidelity::Influence) => Fidelity::Modal(MODES[0]),
        (None, Fidelity::Modal(m)) => {
            MODES.into_iter().find(|&more| more > m).map_or(Fidelity::Full, Fidelity::Modal)
        }
        (None, Fidelity::Half | Fidelity::Full) => Fidelity::Full,
    }
}

/// Returns the selection; where `is_lost`, the error of the choices is marked as unknown, with `reason` as their
/// reason.
fn doubted(mut selection: Selection, searched: &[usize], is_lost: bool, reason: Reason) -> Selection {
    if is_lost {
        for &c in searched {
            let choice = &mut selection.choices[c];
            (choice.reason, choice.estimate) = (reason, None);
        }
    }
    selection
}
