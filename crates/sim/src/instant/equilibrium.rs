//! Static equilibrium of weights, loads and contact forces on wheels, with the deflection of the rails.

use std::borrow::Cow;

use nalgebra::{DMatrix, DMatrixView, DVector};
use smallvec::SmallVec;

use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::dense::dot;
use crate::numerics::lu::{Entries, LuFactors};
use crate::{BodyDof, Error};

/// Largest number of sweeps of the active set.
const SWEEPS: usize = 60;
/// Largest number of iterations on the forces of flanges.
const FLANGES: usize = 60;
/// Change of the degrees of freedom, relative to the largest penetration, below which the positions of the wheels
/// have converged.
const SETTLED: f64 = 1e-9;
/// Largest number of Newton iterations on the contact laws of one active set.
const ITERATIONS: usize = 50;
/// Change of the penetrations, relative to the largest, at which Newton's method ends.
const CONVERGED: f64 = 1e-14;
/// The same where the change has stopped falling: penetrations that are small beside the deflection of the rails keep the
/// rounding of it.
const STAGNANT: f64 = 1e-9;
/// Relative residual of the equilibrium equations above which the wheels cannot carry the weight.
const BALANCE: f64 = 1e-6;

/// Moves y, roll and pitch of every body (where they are free and wheels resist them) and the degrees of freedom of
/// the structures to static equilibrium at `at.t`; the other degrees of freedom stay.
///
/// Unknowns are the penetrations p and forces F of the vertical contacts and the degrees of freedom q. With the
/// active contacts, the equations p + (G + Phi K^-1 Phi^T) F = R q + constant, F = law(p) and R^T F = weights and
/// loads are solved by Newton's method. Sweeps over the active set drop contacts that pull and add contacts that are
/// pressed, until the set no longer changes. The solution is repeated with the slopes of the rails and the positions
/// of the wheels that follow from it, and with the forces of flanges, which are relaxed by Aitken's method, until
/// nothing changes.
///
/// # Errors
/// [`Error::NoEquilibrium`] if the wheels cannot carry the bodies, and any error from evaluating the structures.
pub(crate) fn balance_wheels(solver: &mut Solver, at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    let none = Error::NoEquilibrium {
        time: at.t,
        body: None,
    };
    at.v.fill(0.0);
    // The rope forces are kept at their values on entry: solving an instant during the iteration would find the ropes
    // slack.
    let springs: Vec<f64> = system.springs().iter().map(|&i| at.force[i]).collect();
    let entry = Values::from_slice(at.q.as_slice());
    let restore = |force: &mut [f64]| {
        system
            .springs()
            .iter()
            .zip(&springs)
            .for_each(|(&i, pull)| force[i] = *pull);
    };
    at.force.fill(0.0);
    restore(&mut at.force);
    let guides = system.guides();
    let mut relaxation = Relaxation::default();
    for _ in 0..FLANGES {
        let before = system.mechanics.moves_freely.then(|| at.q.clone());
        balance(solver, &entry, at)?;
        let rests = before.is_none_or(|before| has_settled(&before, at));
        if guides.is_empty() {
            if rests {
                return Ok(());
            }
            continue;
        }
        let taken: Vec<f64> = guides.iter().map(|&i| at.force[i]).collect();
        if !solver.instant(at)? {
            return Err(none);
        }
        restore(&mut at.force);
        let largest = at
            .force
            .iter()
            .fold(system.mechanics.gravity.amax(), |max, force| {
                max.max(force.abs())
            });
        let mut followed: Vec<f64> = guides.iter().map(|&i| at.force[i]).collect();
        let change = relaxation.step(&taken, &mut followed);
        guides
            .iter()
            .zip(followed)
            .for_each(|(&i, force)| at.force[i] = force);
        if change <= 1e-12 * largest && rests {
            return Ok(());
        }
    }
    Err(none)
}

/// Whether the degrees of freedom have changed by no more than the tolerance since `before`.
pub(crate) fn has_settled(before: &DVector<f64>, at: &State) -> bool {
    let depth = at.p.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    let pairs = before.iter().zip(at.q.iter());
    pairs.fold(0.0_f64, |most, (then, now)| most.max((now - then).abs())) <= SETTLED * depth
}

/// Solves the equilibrium for the flange forces of `at`, with ropes and stops whose forces in `at` belong to `entry`.
fn balance(solver: &mut Solver, entry: &[f64], at: &mut State) -> Result<(), Error> {
    let system = solver.system();
    solver.update(at)?;
    let moving = balancing(solver);
    let mut balance = Balance::new(solver, moving, entry, at)?;
    if !balance.solve() {
        return Err(Error::NoEquilibrium {
            time: at.t,
            body: balance.least_balanced(),
        });
    }
    for (&number, &q) in balance.moving.iter().zip(balance.q.iter()) {
        at.q[number] = q;
    }
    at.force[..system.verticals()].copy_from_slice(&balance.force);
    at.p[..balance.p.len()].copy_from_slice(&balance.p);
    at.p_rate.fill(0.0);
    solver.rest_rails(at);
    for i in 0..system.verticals() {
        solver.set_active(i, balance.active.contains(&i));
    }
    rest_structures(solver, at)
}

/// Degrees of freedom of the bodies for which equilibrium is solved: y, roll and pitch, if a wheel resists them.
fn balancing(solver: &Solver) -> Numbers {
    let (rows, count) = (solver.geometry().rows(), solver.system().verticals());
    let numbers = solver.system().mechanics.kinematics.numbers.iter();
    numbers
        .flat_map(|numbers| {
            [BodyDof::Y, BodyDof::Roll, BodyDof::Pitch].map(|f| numbers[f as usize])
        })
        .flatten()
        .filter(|&number| (0..count).any(|i| rows.approach_row(i)[number] != 0.0))
        .collect()
}

/// Elements that can load the rails at rest: the vertical contacts, then the guides.
fn pressing(system: &System) -> Vec<usize> {
    (0..system.verticals())
        .chain(system.guides().iter().copied())
        .collect()
}

/// Static compliance G + Phi K^-1 Phi^T of the elements that can load the rails at rest.
fn static_compliance(solver: &Solver) -> Result<DMatrix<f64>, Error> {
    let system = solver.system();
    let (m, pressing) = (system.elements.len(), pressing(system));
    let count = pressing.len();
    let (value, rows) = (&solver.geometry().rails().value, solver.geometry().rows());
    let mut compliance =
        DMatrix::from_fn(count, count, |i, j| value[pressing[i] * m + pressing[j]]);
    for block in &system.mechanics.blocks[1..] {
        let first = block.range.start;
        let phi = DMatrix::from_fn(block.range.len(), count, |k, i| {
            rows.approach_row(pressing[i])[first + k]
        });
        compliance += phi.transpose() * block.rest(&phi)?;
    }
    Ok(compliance)
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

/// Load on degree of freedom `number` from ropes and stops, for the forces of `at`.
fn pull_of_springs(solver: &Solver, number: usize, at: &State) -> f64 {
    let rows = solver.geometry().rows();
    solver
        .system()
        .springs()
        .iter()
        .map(|&i| -rows.approach_row(i)[number] * at.force[i])
        .sum()
}

/// Ropes and stops that act at `at` between bodies none of which hangs. A load on a rope follows the body that carries it, so
/// that the rope is no spring of it.
pub(crate) fn acting_springs(solver: &Solver, at: &State) -> impl Iterator<Item = usize> {
    let system = solver.system();
    let hangs = move |i: usize| {
        let points = system.elements[i].points();
        points.is_some_and(|points| {
            system
                .scene
                .actuators
                .hanging
                .iter()
                .any(|&b| points.is_on(b))
        })
    };
    system
        .springs()
        .iter()
        .copied()
        .filter(move |&i| at.force[i] > 0.0 && !hangs(i))
}

/// Stiffness of [`acting_springs`] by the `moving` degrees of freedom; empty without such springs.
fn stiffness_of_springs(solver: &Solver, moving: &[usize], at: &State) -> Entries {
    let mut sum = Entries::new();
    for i in acting_springs(solver, at) {
        sum.resize(moving.len() * moving.len(), 0.0);
        let row = solver.geometry().rows().approach_row(i);
        let stiffness = solver.geometry().local()[i].spring.stiffness;
        let pairs = moving
            .iter()
            .flat_map(|&k| moving.iter().map(move |&l| row[k] * row[l]));
        sum.iter_mut()
            .zip(pairs)
            .for_each(|(entry, pair)| *entry += stiffness * pair);
    }
    sum
}

/// Aitken's relaxation of a fixed-point iteration on forces: omega <- -omega r_old . (r - r_old) / |r - r_old|^2,
/// where r is the change of the forces in one iteration.
///
/// # Source
/// Irons, Tuck, Int. J. Numer. Meth. Engng 1 (1969) 275-277.
#[derive(Default)]
struct Relaxation {
    share: Option<f64>,
    residual: Vec<f64>,
}

impl Relaxation {
    /// Replaces the forces `followed`, which result from the forces `taken`, by the relaxed forces of the next
    /// iteration; returns the largest change before relaxation.
    fn step(&mut self, taken: &[f64], followed: &mut [f64]) -> f64 {
        let residual: Vec<f64> = followed
            .iter()
            .zip(taken)
            .map(|(new, old)| new - old)
            .collect();
        let bend: Vec<f64> = residual
            .iter()
            .zip(&self.residual)
            .map(|(new, old)| new - old)
            .collect();
        let square: f64 = bend.iter().map(|b| b * b).sum();
        let share = match self.share {
            Some(share) if square > 0.0 => -share * dot(&self.residual, &bend) / square,
            _ => 1.0,
        };
        for (next, (old, change)) in followed.iter_mut().zip(taken.iter().zip(&residual)) {
            *next = old + share * change;
        }
        let largest = residual.iter().fold(0.0_f64, |max, r| max.max(r.abs()));
        (self.share, self.residual) = (Some(share), residual);
        largest
    }
}

/// Equilibrium equations of the vertical contacts at fixed positions: p + A F = `constant` + `rows` q, F = law(p),
/// `rows`^T F + `springs` q = weight + `pull`.
struct Balance<'a> {
    system: &'a System<'a>,
    /// Active fraction of the law of each contact, times its number of wheels.
    share: Values,
    /// Numbers of the unknown degrees of freedom q.
    moving: Numbers,
    /// Compliance matrix A of the contacts, in its first rows and columns.
    compliance: DMatrix<f64>,
    /// Contacts x degrees of freedom, column by column.
    rows: Entries,
    constant: Values,
    weight: Values,
    /// Stiffness K of ropes and stops by the unknown degrees of freedom ([`stiffness_of_springs`]), and K q0, with q0 where
    /// their forces are part of the weight; empty without such springs.
    springs: Entries,
    pull: Values,
    active: Numbers,
    q: Values,
    p: Values,
    force: Values,
    /// Memory of the factors of the contacts and of the degrees of freedom.
    factors: [LuFactors; 2],
}

/// Numbers of contacts or of degrees of freedom, and a value for each of them; few of them need no allocation.
type Numbers = SmallVec<[usize; 8]>;
type Values = SmallVec<[f64; 8]>;

/// The largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Number of rows and columns up to which products are sums of columns.
const FEW: usize = 5;

/// A^T B for matrices with a number of rows, column by column.
fn transposed_product(a: &[f64], b: &[f64], rows: usize) -> Entries {
    let counts = [a, b].map(|own| own.len() / rows);
    if rows > FEW && counts.iter().all(|count| *count > FEW) {
        let [a, b] =
            [(a, counts[0]), (b, counts[1])].map(|(of, n)| DMatrixView::from_slice(of, rows, n));
        return SmallVec::from_vec((a.transpose() * b).data.into());
    }
    let mut out = Entries::new();
    for own in b.chunks_exact(rows) {
        out.extend(
            a.chunks_exact(rows)
                .map(|other| sum_of_products(other, own)),
        );
    }
    out
}

/// The sum of products in their order, without a zero in front.
fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    let products = a.iter().zip(b).map(|(a, b)| a * b);
    products.reduce(|sum, product| sum + product).unwrap_or(0.0)
}

impl<'a> Balance<'a> {
    /// Sets up the equilibrium of the degrees of freedom `moving` for the current geometry of the solver. As a first
    /// estimate, all wheels that may act carry the same force. If no degree of freedom is unknown, the wheels with
    /// positive penetration carry.
    fn new(solver: &Solver<'a>, moving: Numbers, entry: &[f64], at: &State) -> Result<Self, Error> {
        let (system, geometry) = (solver.system(), solver.geometry());
        let rows = geometry.rows();
        let (n, count) = (system.mechanics.dofs, system.verticals());
        let stays = |k: usize| {
            !moving.contains(&k)
                && !system
                    .mechanics
                    .structures
                    .iter()
                    .any(|range| range.contains(&k))
        };
        let staying: Numbers = (0..n).filter(|&k| stays(k)).collect();
        let all = static_compliance(solver)?;
        let guides = || {
            system
                .guides()
                .iter()
                .enumerate()
                .map(|(k, &l)| (system.verticals() + k, l))
        };
        let constant: Values = (0..count)
            .map(|i| {
                let staid = staying
                    .iter()
                    .map(|&k| rows.approach_row(i)[k] * at.q[k])
                    .sum::<f64>();
                let taken = guides()
                    .map(|(place, l)| all[(i, place)] * at.force[l])
                    .sum::<f64>();
                rows.approach_offset[i] + staid - taken
            })
            .collect();
        let share: Values = (0..count)
            .map(|i| system.mechanics.groups[i].count() * geometry.fraction(i))
            .collect();
        let reach = |i: usize| {
            if moving.is_empty() {
                Some(constant[i])
            } else {
                None
            }
        };
        let active: Numbers = (0..count)
            .filter(|&i| share[i] > 0.0 && reach(i).is_none_or(|p| p > 0.0))
            .collect();
        let mut gravity = Cow::Borrowed(&system.mechanics.gravity);
        if !system.mechanics.carried.is_empty() {
            let weight = gravity.to_mut();
            system
                .mechanics
                .carried
                .weigh(&system.mechanics.kinematics, (at.t, &at.q), weight);
        }
        let mut weight: Values = moving
            .iter()
            .map(|&k| gravity[k] + pull_of_springs(solver, k, at))
            .collect();
        for load in &system.scene.actuators.loads {
            if let Some(j) = moving
                .iter()
                .position(|&k| system.mechanics.loaded(load) == Some(k))
            {
                weight[j] += load.value.at(at.t);
            }
        }
        // Where a rail slopes, its force on the hub has a longitudinal component, which turns the body.
        let tilted =
            |i: usize, k: usize| (rows.force_row(i)[k] - rows.approach_row(i)[k]) * at.force[i];
        for (j, &k) in moving.iter().enumerate() {
            weight[j] -= (0..count).map(|i| tilted(i, k)).sum::<f64>();
            weight[j] -= guides()
                .map(|(_, l)| rows.force_row(l)[k] * at.force[l])
                .sum::<f64>();
        }
        let each = largest(&weight) / active.len().max(1) as f64;
        let springs = stiffness_of_springs(solver, &moving, at);
        let begun: Values = moving.iter().map(|&k| entry[k]).collect();
        let pull = springs
            .chunks(moving.len().max(1))
            .map(|column| sum_of_products(column, &begun))
            .collect();
        let column = |&k: &usize| (0..count).map(move |i| rows.approach_row(i)[k]);
        Ok(Balance {
            compliance: all,
            rows: moving.iter().flat_map(column).collect(),
            p: (0..count)
                .map(|i| reach(i).unwrap_or_else(|| system.law(i).penetration(each)))
                .collect(),
            q: SmallVec::from_elem(0.0, moving.len()),
            force: SmallVec::from_elem(0.0, count),
            factors: Default::default(),
            springs,
            pull,
            system,
            share,
            moving,
            constant,
            weight,
            active,
        })
    }

    /// Sweeps over the active set; returns false if no set is in equilibrium with the weights.
    fn solve(&mut self) -> bool {
        for _ in 0..SWEEPS {
            if self.active.is_empty() {
                return self.moving.is_empty();
            }
            let Some(converged) = self.iterate() else {
                return false;
            };
            if !self.sweep() {
                return converged;
            }
        }
        false
    }

    /// The body for which the forces of the active contacts are farthest from balancing weights and loads; `None`
    /// where they balance all.
    ///
    /// The forces F minimise |R^T F - weight| by least squares. Each degree of freedom counts relative to its weight
    /// and to the largest weight times its levers.
    fn least_balanced(&self) -> Option<usize> {
        let rows = DMatrix::from_column_slice(self.share.len(), self.moving.len(), &self.rows);
        let weight = DVector::from_column_slice(&self.weight);
        let lever = rows.select_rows(&self.active).transpose();
        let by_contacts = || {
            let forces = lever.clone().svd(true, true).solve(&weight, BALANCE).ok()?;
            Some(&lever * forces)
        };
        let none = || DVector::zeros(self.moving.len());
        let carried = if lever.is_empty() {
            none()
        } else {
            by_contacts().unwrap_or_else(none)
        };
        let largest = weight.amax();
        let relative = |j: usize| {
            let size = self.weight[j].abs() + largest * rows.column(j).amax();
            (self.weight[j] - carried[j]).abs() / size.max(f64::MIN_POSITIVE)
        };
        let worst = (0..self.moving.len()).max_by(|&i, &j| relative(i).total_cmp(&relative(j)))?;
        if relative(worst) <= BALANCE {
            return None;
        }
        let numbers = &self.system.mechanics.kinematics.numbers;
        numbers
            .iter()
            .position(|own| own.contains(&Some(self.moving[worst])))
    }

    /// Newton's method with the active contacts; under linear laws the first iterate is the solution. Returns `None` if they
    /// cannot carry the weight, otherwise whether the iteration converged.
    fn iterate(&mut self) -> Option<bool> {
        let is_linear = self.active.iter().all(|&i| self.system.law(i).is_linear());
        let mut before = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let solved = self.linearised()?;
            let change = self.advance(&solved);
            if is_linear {
                return Some(true);
            }
            let depth = self.p.iter().fold(0.0_f64, |max, p| max.max(p.abs()));
            if change <= CONVERGED * depth || (change <= STAGNANT * depth && change >= 0.5 * before)
            {
                return Some(true);
            }
            before = change;
        }
        Some(false)
    }

    /// Newton's linear system: the forces of the active contacts from (A + 1/k) F = R q + constant - p + f/k and R^T
    /// F + K q = weight + K q0, where f and k are force and stiffness of the laws at p, and K is the stiffness of ropes and
    /// stops. Sets q.
    fn linearised(&mut self) -> Option<Values> {
        let (size, count) = (self.active.len(), self.share.len());
        let Balance {
            active,
            compliance,
            factors: [factors, of_dofs],
            ..
        } = self;
        let mut free = Values::new();
        let mut own = Values::new();
        for &i in active.iter() {
            let point = self.system.law(i).at(self.p[i], 0.0);
            own.push(1.0 / (self.share[i] * point.by_penetration));
            free.push(self.constant[i] - self.p[i] + point.force / point.by_penetration);
        }
        factors.replace(size, |matrix| {
            for (r, (&row, own)) in active.iter().zip(own).enumerate() {
                matrix.extend(active.iter().map(|&column| compliance[(row, column)]));
                matrix[r * (size + 1)] += own;
            }
        });
        if self.moving.is_empty() {
            return factors.solve(&mut free).then_some(free);
        }
        let mut lever = Entries::new();
        for rows in self.rows.chunks_exact(count) {
            lever.extend(active.iter().map(|&i| rows[i]));
        }
        let mut by_lever = lever.clone();
        if !by_lever
            .chunks_exact_mut(size)
            .all(|column| factors.solve(column))
            || !factors.solve(&mut free)
        {
            return None;
        }
        let by_free = free;
        let mut stiffness = transposed_product(&lever, &by_lever, size);
        let carried = lever
            .chunks_exact(size)
            .map(|lever| sum_of_products(lever, &by_free));
        let mut balance: Values = self
            .weight
            .iter()
            .zip(carried)
            .map(|(weight, carried)| weight - carried)
            .collect();
        let moving = self.moving.len();
        stiffness
            .iter_mut()
            .zip(&self.springs)
            .for_each(|(sum, own)| *sum += own);
        balance
            .iter_mut()
            .zip(&self.pull)
            .for_each(|(sum, own)| *sum += own);
        let mut next = balance.clone();
        of_dofs.replace(moving, |matrix| {
            (0..moving).for_each(|r| matrix.extend(stiffness[r..].iter().step_by(moving).copied()));
        });
        if !of_dofs.solve(&mut next) {
            return None;
        }
        let scale = largest(&self.weight).max(f64::MIN_POSITIVE);
        let product = |columns: &[f64], r: usize, rows: usize| {
            let terms = columns[r..]
                .iter()
                .step_by(rows)
                .zip(&next)
                .map(|(entry, q)| entry * q);
            terms.reduce(|sum, term| sum + term).unwrap_or(0.0)
        };
        let residual = |j: usize| (product(&stiffness, j, moving) - balance[j]).abs();
        let balanced = (0..moving).map(residual).fold(0.0, f64::max) <= BALANCE * scale;
        if !(balanced && next.iter().all(|q| q.is_finite())) {
            return None;
        }
        let solved = (0..size)
            .map(|r| product(&by_lever, r, size) + by_free[r])
            .collect();
        self.q = next;
        Some(solved)
    }

    /// Updates the penetrations to those for the forces `solved` by the linearised laws, keeping them positive for
    /// nonlinear laws; returns the largest change.
    fn advance(&mut self, solved: &[f64]) -> f64 {
        let mut change = 0.0_f64;
        self.force.fill(0.0);
        for (r, &i) in self.active.iter().enumerate() {
            let (law, share) = (self.system.law(i), self.share[i]);
            let point = law.at(self.p[i], 0.0);
            let wanted =
                self.p[i] + (solved[r] - share * point.force) / (share * point.by_penetration);
            let floor = 0.1 * self.p[i].abs();
            let bounded = if law.exponent == 1.0 {
                wanted
            } else {
                wanted.max(floor)
            };
            change = change.max((bounded - self.p[i]).abs());
            self.p[i] = bounded;
            self.force[i] = solved[r];
        }
        change
    }

    /// Drops the contacts that pull and adds those that are pressed; returns whether the active set changed.
    fn sweep(&mut self) -> bool {
        let deepest = self.p.iter().fold(0.0_f64, |max, p| max.max(p.abs()));
        let before = self.active.clone();
        let system = self.system;
        let force = &self.force;
        self.active
            .retain(|i| force[*i] >= 0.0 || system.law(*i).bilateral);
        for i in (0..self.share.len()).filter(|i| !before.contains(i) && self.share[*i] > 0.0) {
            let row = self.rows[i..].iter().step_by(self.share.len());
            let reach: f64 = row.zip(&self.q).map(|(r, q)| r * q).sum();
            let give: f64 = self
                .compliance
                .row(i)
                .iter()
                .zip(&self.force)
                .map(|(g, f)| g * f)
                .sum();
            self.p[i] = self.constant[i] + reach - give;
            if self.p[i] > 1e-13 * deepest {
                self.active.push(i);
            }
        }
        self.active.sort_unstable();
        self.active != before
    }
}
