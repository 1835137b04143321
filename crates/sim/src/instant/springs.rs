//! Stiffness of ropes and stops by the degrees of freedom of bodies.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::point::scalar;
use crate::mechanics::state::State;
use crate::numerics::lu::Entries;

/// Stiffness that is added to the diagonal, relative to the largest entry: motions that nothing holds.
const LOOSE: f64 = 1e-14;
/// Part of a stiffness that rounding leaves where all of it should cancel.
const ROUNDING: f64 = 1e-10;

/// Stiffness of the ropes and stops that act at `at`, by the degrees of freedom `numbers`: k a a^T of each, with the row a of
/// its length, and T/l of taut ropes across their direction.
pub(crate) fn stiffness(solver: &Solver, numbers: &[usize], at: &State) -> DMatrix<f64> {
    let system = solver.system();
    let size = numbers.len();
    let mut matrix = DMatrix::zeros(size, size);
    let mut row = vec![0.0; system.mechanics.dofs];
    for &i in system.springs() {
        if at.force[i] <= 0.0 {
            continue;
        }
        let hold = &solver.geometry().local()[i].spring;
        let own = solver.geometry().rows().approach_row(i);
        let pull = DVector::from_fn(size, |r, _| own[numbers[r]]);
        matrix += &pull * pull.transpose() * hold.stiffness;
        if let Some(points) = system.elements[i].points().filter(|points| points.swings) {
            for axis in 0..3 {
                let mut unit = [0.0; 3];
                unit[axis] = 1.0;
                let lean = scalar(unit, hold.direction);
                row.fill(0.0);
                points.add_row(&system.mechanics, (at.t, &at.q), unit, &mut row);
                let across = DVector::from_fn(size, |r, _| row[numbers[r]] - lean * pull[r]);
                matrix += &across * across.transpose() * (at.force[i] / hold.length);
            }
        }
    }
    matrix
}

/// The stiffness that the `moving` degrees of freedom feel where hanging bodies follow them in equilibrium,
/// K_mm - K_mh K_hh^-1 K_hm, column by column; empty where there is none, as of a load that hangs freely on a rope.
pub(crate) fn followed(solver: &Solver, moving: &[usize], at: &State) -> Entries {
    if solver.system().springs().is_empty() || moving.is_empty() {
        return Entries::new();
    }
    let hanging = hanging(solver.system());
    let (own, all) = (moving.len(), [moving, &hanging].concat());
    let whole = stiffness(solver, &all, at);
    let direct = whole.view((0, 0), (own, own)).into_owned();
    let coupled = whole.view((own, 0), (hanging.len(), own)).into_owned();
    let followers = whole.view((own, own), (hanging.len(), hanging.len()));
    let least = ROUNDING * direct.amax();
    let left = match regular(followers.into_owned()) {
        Some(factor) => direct - coupled.transpose() * factor.solve(&coupled),
        None => direct,
    };
    if left.amax() <= least {
        return Entries::new();
    }
    Entries::from_slice(left.as_slice())
}

/// The factors of a stiffness, which is made regular; `None` without any.
pub(crate) fn regular(mut stiffness: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let stiffest = stiffness
        .diagonal()
        .iter()
        .fold(0.0_f64, |most, k| most.max(*k));
    if stiffest <= 0.0 {
        return None;
    }
    for k in 0..stiffness.nrows() {
        stiffness[(k, k)] += LOOSE * stiffest;
    }
    stiffness.cholesky()
}

/// Translational degrees of freedom of the hanging bodies that are attached to ropes or stops.
pub(crate) fn hanging(system: &System) -> Vec<usize> {
    let is_joined = |b: usize| {
        let mut points = system
            .springs()
            .iter()
            .filter_map(|&i| system.elements[i].points());
        points.any(|points| points.is_on(b))
    };
    let bodies = system.scene.actuators.hanging.iter();
    bodies
        .filter(|&&b| is_joined(b))
        .flat_map(|&b| {
            system.mechanics.kinematics.numbers[b]
                .iter()
                .take(3)
                .flatten()
                .copied()
        })
        .collect()
}

/// Ropes and stops that act at `at` between bodies none of which hangs.
pub(crate) fn acting_springs(solver: &Solver, at: &State) -> impl Iterator<Item = usize> {
    let system = solver.system();
    let hangs = move |i: usize| {
        let points = system.elements[i].points();
        let mut hanging = system.scene.actuators.hanging.iter();
        points.is_some_and(|points| hanging.any(|&b| points.is_on(b)))
    };
    let springs = system.springs().iter().copied();
    springs.filter(move |&i| at.force[i] > 0.0 && !hangs(i))
}
