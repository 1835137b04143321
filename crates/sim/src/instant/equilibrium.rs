//! Static equilibrium of weights, loads and contact forces on wheels, with the deflection of the rails.

use nalgebra::{DMatrix, DVector};

use crate::contact::solver::Solver;
use crate::instant::balance::{Balance, Numbers, Values, pressing};
use crate::mechanics::state::State;
use crate::{BodyDof, Error};

/// Largest number of repetitions with the positions, slopes and heights that follow.
const PASSES: usize = 60;
/// Change of the forces, relative to the largest, below which they have converged.
const EQUAL: f64 = 1e-12;
/// Lever of a wheel, relative to the largest radius, that is rounding.
const LEVER: f64 = 1e-12;
/// Change of the degrees of freedom, relative to the largest penetration, below which the positions of the wheels
/// have converged; and below which they have where rounding lets them change no less.
const SETTLED: f64 = 1e-12;
const STAGNANT: f64 = 1e-9;

/// Moves y, roll and pitch of every body (where they are free and wheels resist them) and the degrees of freedom of
/// the structures to static equilibrium at `at.t`; the other degrees of freedom stay.
///
/// At fixed positions of the wheels this is a minimum of energy ([`Balance`]). It is repeated with the slopes of the rails and the
/// positions and heights of the wheels that follow from it, until nothing changes.
///
/// # Errors
/// [`Error::NoEquilibrium`] if the wheels cannot carry the bodies, and any error from evaluating the structures.
pub(crate) fn balance_wheels(solver: &mut Solver, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    at.v.fill(0.0);
    let entry = Values::from_slice(at.q.as_slice());
    for (i, force) in at.force.iter_mut().enumerate() {
        if !system.springs().contains(&i) {
            *force = 0.0;
        }
    }
    let mut last = f64::INFINITY;
    for _ in 0..PASSES {
        let before = system.mechanics.moves_freely.then(|| at.q.clone());
        let forces = (!system.guides().is_empty()).then(|| at.force.clone());
        balance(solver, &entry, at)?;
        let change = before.map_or(0.0, |before| change(&before, at));
        let rests = change <= SETTLED || (change <= STAGNANT && change >= 0.5 * last);
        last = change;
        let is_equal = forces.is_none_or(|before| {
            let pairs = before.iter().zip(at.force.iter());
            let most = at
                .force
                .iter()
                .fold(0.0_f64, |most, force| most.max(force.abs()));
            pairs.fold(0.0_f64, |change, (then, now)| {
                change.max((now - then).abs())
            }) <= EQUAL * most
        });
        if rests && is_equal {
            return Ok(());
        }
    }
    Err(Error::NoEquilibrium {
        time: at.t,
        fall: None,
    })
}

/// Whether the degrees of freedom have changed by no more than the tolerance since `before`.
pub(crate) fn has_settled(before: &DVector<f64>, at: &State) -> bool {
    change(before, at) <= STAGNANT
}

/// The largest change of a degree of freedom since `before`, relative to the largest penetration.
fn change(before: &DVector<f64>, at: &State) -> f64 {
    let depth = at.p.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    let pairs = before.iter().zip(at.q.iter());
    let most = pairs.fold(0.0_f64, |most, (then, now)| most.max((now - then).abs()));
    if most == 0.0 { 0.0 } else { most / depth }
}

/// Solves the equilibrium at the positions of `at`, with ropes and stops whose forces in `at` belong to `entry`.
fn balance(solver: &mut Solver, entry: &[f64], at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    solver.update(at)?;
    let moving = balancing(solver);
    let mut balance = Balance::new(solver, moving, entry, at)?;
    if !balance.solve() {
        return Err(Error::NoEquilibrium {
            time: at.t,
            fall: balance.fall(),
        });
    }
    let place = &balance.at;
    for (&number, &q) in balance.moving.iter().zip(&place.q) {
        at.q[number] = q;
    }
    for (&i, force) in balance.elements.iter().zip(&place.force) {
        at.force[i] = *force;
    }
    let verticals = system.verticals();
    at.p[..verticals].copy_from_slice(&place.p[..verticals]);
    at.p_rate.fill(0.0);
    solver.update_heights(at);
    solver.rest_rails(at);
    for i in 0..verticals {
        solver.set_active(i, balance.pieces[i] != 0);
    }
    rest_structures(solver, at)
}

/// Degrees of freedom of the bodies for which equilibrium is solved: y, roll and pitch, if a wheel resists them. The mean of wheels
/// before and behind a pin has no lever but for rounding.
pub(crate) fn balancing(solver: &Solver) -> Numbers {
    let (rows, count) = (solver.geometry().rows(), solver.system().verticals());
    let kinds = solver.system().scene.wheels.iter();
    let rounding = LEVER * kinds.fold(0.0_f64, |most, kind| most.max(kind.radius));
    let numbers = solver.system().mechanics.kinematics.numbers.iter();
    numbers
        .flat_map(|numbers| {
            [
                (BodyDof::Y, 0.0),
                (BodyDof::Roll, rounding),
                (BodyDof::Pitch, rounding),
            ]
            .map(|(dof, least)| (numbers[dof as usize], least))
        })
        .filter_map(|(number, least)| Some((number?, least)))
        .filter(|&(number, least)| (0..count).any(|i| rows.approach_row(i)[number].abs() > least))
        .map(|(number, _)| number)
        .collect()
}

/// Sets the degrees of freedom of structures to static equilibrium under the vertical and the guiding forces of `at`.
fn rest_structures(solver: &Solver, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    let (rows, pressing) = (solver.geometry().rows(), pressing(system));
    for block in &system.mechanics.blocks[1..] {
        let (first, size) = (block.range.start, block.range.len());
        let load = DMatrix::from_fn(size, 1, |k, _| {
            let loads = pressing
                .iter()
                .map(|&i| rows.approach_row(i)[first + k] * at.force[i]);
            -loads.sum::<f64>()
        });
        at.q.rows_mut(first, size)
            .copy_from(&block.rest(&load)?.column(0));
    }
    Ok(())
}
