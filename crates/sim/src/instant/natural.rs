//! Natural modes of a scene at rest: bodies on their contacts and ropes, on flexible structures.

use nalgebra::{DMatrix, SymmetricEigen};

use crate::Analysis;
use crate::contact::solver::{RailMemory, Solver};
use crate::contact::system::System;
use crate::instant::hang::{equilibrate, place_below_ropes};
use crate::instant::settle::settle;
use crate::instant::uneven::locate_wheels;
use crate::mechanics::state::State;
use crate::record::energy::stored;
use crate::{Actuators, Error, Foundation, Scene};

/// Largest number of degrees of freedom for which natural modes are computed.
const MOST: usize = 300;

/// Step of the differences of forces, relative to the largest penetration at rest.
const MOVE: f64 = 1e-3;

/// Square of a frequency, relative to the largest, below which a mode is regarded as an unrestrained motion.
const LOOSE: f64 = 1e-10;

/// A natural mode of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalMode {
    /// Circular frequency, > 0, radian/time.
    pub omega: f64,
    /// Fraction of each body's six degrees of freedom in the kinetic energy, phi_i (M phi)_i / phi^T M phi; together
    /// with `structures` the fractions sum to 1.
    pub fraction: Vec<[f64; 6]>,
    /// Fraction of the degrees of freedom of structures with mass.
    pub structures: f64,
}

/// Undamped natural modes of `scene` on `foundations` at the position of its bodies at time `t`, lowest first;
/// `place` is the x of each body at that time. Returns `None` if the scene has too many degrees of freedom.
///
/// The modes satisfy K phi = omega^2 M phi. M is computed from the kinetic energy, and K from central differences of
/// the forces about static equilibrium: those of vertical contacts, of taut ropes and of touched stops, with the
/// compliance of the structures, and the effect of weight on swinging bodies. Dampers, friction, drives and brakes
/// are left out; flanges are included if they touch at rest. Rigid-body motions are left out.
///
/// # Errors
/// A scene that cannot be set up or has no equilibrium at that position.
pub fn natural_modes(
    scene: &Scene,
    foundations: &[Foundation],
    t: f64,
    place: &[f64],
) -> Result<Option<Vec<NaturalMode>>, Error> {
    let still = stilled(scene, place);
    let system = System::new(&still, foundations)?;
    match system.mechanics.dofs {
        0 => return Ok(Some(Vec::new())),
        dofs if dofs > MOST => return Ok(None),
        _ => {}
    }
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    let mut state = system.state();
    state.t = t;
    for (body, numbers) in still
        .bodies
        .iter()
        .zip(&system.mechanics.kinematics.numbers)
    {
        for (number, value) in numbers.iter().zip(body.start) {
            if let Some(number) = *number {
                state.q[number] = value;
            }
        }
    }
    locate_wheels(&mut solver, &state)?;
    place_below_ropes(&mut solver, &mut state)?;
    equilibrate(&mut solver, &mut state)?;
    if !settle(&mut solver, &mut state)? {
        return Err(Error::NoEquilibrium {
            time: t,
            fall: None,
        });
    }
    let mass = mass(&solver, &state);
    let stiffness = stiffness(&mut solver, &state, &mass)?;
    Ok(modes(&system, &mass, &stiffness))
}

/// The scene at rest, without prescribed motions, drives, brakes, damping and friction.
fn stilled(scene: &Scene, place: &[f64]) -> Scene {
    let mut still = Scene {
        gauges: Vec::new(),
        analysis: Analysis::Dynamic,
        ..scene.clone()
    };
    let Actuators {
        loads,
        ropes,
        stops,
        hanging: hung,
        ..
    } = still.actuators;
    still.actuators = Actuators {
        loads,
        ropes,
        stops,
        hanging: hung,
        ..Actuators::default()
    };
    for (body, x) in still.bodies.iter_mut().zip(place) {
        if body.motion.take().is_some() {
            body.free[0] = false;
        }
        body.start[0] = *x;
        body.start_speed = [0.0; 6];
    }
    for wheel in &mut still.wheels {
        wheel.normal.damping = 0.0;
        (wheel.friction, wheel.spin_inertia) = (None, None);
    }
    for rope in &mut still.actuators.ropes {
        rope.damping = 0.0;
    }
    for stop in &mut still.actuators.stops {
        stop.damping = 0.0;
    }
    still
}

/// Mass matrix at `at`, from the kinetic energy T: M_ij = T(e_i + e_j) - T(e_i) - T(e_j) + T(0).
fn mass(solver: &Solver, at: &State) -> DMatrix<f64> {
    let n = solver.system().mechanics.dofs;
    let mut probe = at.clone();
    let mut energy = |moving: &[usize]| {
        probe.v.fill(0.0);
        moving.iter().for_each(|&i| probe.v[i] += 1.0);
        stored(solver.system(), solver.geometry(), &probe).kinetic
    };
    let rest = energy(&[]);
    let alone: Vec<f64> = (0..n).map(|i| energy(&[i])).collect();
    let mut mass = DMatrix::zeros(n, n);
    for j in 0..n {
        for i in 0..=j {
            let both = energy(&[i, j]);
            mass[(i, j)] = both - alone[i] - alone[j] + rest;
            mass[(j, i)] = mass[(i, j)];
        }
    }
    mass
}

/// Stiffness matrix at `at`, by central differences of M a.
fn stiffness(solver: &mut Solver, at: &State, mass: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    let n = solver.system().mechanics.dofs;
    let depth = at.p.iter().fold(0.0_f64, |most, p| most.max(*p));
    let step = MOVE * if depth > 0.0 { depth } else { MOVE };
    let lost = Error::NoEquilibrium {
        time: at.t,
        fall: None,
    };
    let mut probe = at.clone();
    let mut out = DMatrix::zeros(n, n);
    for j in 0..n {
        let mut forces = [1.0, -1.0].map(|_| at.a.clone());
        for (sign, force) in [1.0, -1.0].into_iter().zip(&mut forces) {
            probe.copy_from(at);
            probe.q[j] += sign * step;
            if !solver.instant(&mut probe)? {
                return Err(lost);
            }
            force.copy_from(&(mass * &probe.a));
        }
        out.set_column(j, &((&forces[1] - &forces[0]) / (2.0 * step)));
    }
    Ok(0.5 * (&out + out.transpose()))
}

/// Modes of K and M without rigid-body motions; `None` if M is not positive definite.
fn modes(
    system: &System,
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
) -> Option<Vec<NaturalMode>> {
    let lower = mass.clone().cholesky()?.l();
    let half = lower.solve_lower_triangular(stiffness)?;
    let whole = lower.solve_lower_triangular(&half.transpose())?;
    let eigen = SymmetricEigen::new(0.5 * (&whole + whole.transpose()));
    let largest = eigen.eigenvalues.amax();
    let upper = lower.transpose();
    let mut modes = Vec::new();
    for (k, &square) in eigen.eigenvalues.iter().enumerate() {
        if square <= LOOSE * largest {
            continue;
        }
        let shape = upper.solve_upper_triangular(&eigen.eigenvectors.column(k))?;
        let energy = shape.component_mul(&(mass * &shape));
        let own = |number: &Option<usize>| number.map_or(0.0, |number| energy[number]);
        let share: Vec<[f64; 6]> = system
            .mechanics
            .kinematics
            .numbers
            .iter()
            .map(|of| of.each_ref().map(own))
            .collect();
        let structures = system
            .mechanics
            .structures
            .iter()
            .flat_map(|range| range.clone().map(|i| energy[i]))
            .sum();
        modes.push(NaturalMode {
            omega: square.sqrt(),
            fraction: share,
            structures,
        });
    }
    modes.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Some(modes)
}
