//! Geometry of the force elements at one state: positions of wheels, compliance of the rails, rows.
//!
//! An update to (t, q) has the following order, because each part depends on the preceding ones:
//! 1. positions: prescribed travel and rail coordinates of all wheels; heights remain those of the last solution;
//! 2. compliance: G between the elements at these positions, and the fractions of contacts between rigid parts;
//! 3. rows: the constant part of every row, the part due to positions and time, then the shapes of structures;
//! 4. forces: the slope of the deflected rail under the latest forces, and the rows by which forces load the bodies.

use nalgebra::DVector;
use splines::Probe;

use super::candidates::Candidates;
use super::compliance::RailCompliance;
use super::element::{Frame, Local, Where};
use super::matrices::RailMatrices;
use super::places::Places;
use super::rows::Rows;
use super::switches::Switches;
use super::system::System;
use crate::mechanics::state::State;
use crate::numerics::dense::along;
use crate::scene::dof::arm_rows;
use crate::{Action, Error};

/// All data of the elements that depend on the positions of the wheels.
#[derive(Clone)]
pub(crate) struct Geometry {
    places: Places,
    rails: RailCompliance,
    rows: Rows,
    /// The part of the rows that is constant.
    constant: Rows,
    local: Vec<Local>,
    /// The switching state that rules have set.
    switches: Switches,
    /// Slope of the deflected rail under each element, d u/d x, including that of the unloaded rail's shape.
    rail_slope: Vec<f64>,
    /// Rows of the x of the wheels on which the slope of the deflected rail exerts a force, over the degrees of freedom,
    /// row-major; empty if no wheel moves freely along its rail.
    along_rail: Vec<f64>,
    shapes: ShapeSlopes,
    is_built: bool,
    /// Largest change of a displacement of a body for which the data of another state serve.
    near: f64,
    /// Heights of the wheels in the rows.
    height: Vec<f64>,
    drift: Drift,
}

/// Effect of the motion of the wheels since the last update, to first order.
#[derive(Clone)]
struct Drift {
    /// Motion of every wheel along its rail, at which the changes were found.
    wheels: Vec<f64>,
    /// Change of the approach of every element less the deflection of its rail; zero where this is no state.
    change: Vec<f64>,
    /// Scratch: the part of it by the motion of the wheels of other elements.
    by_others: Vec<f64>,
}

/// Largest change of a displacement of a body, in radii of the smallest wheel per unit of step tolerance, for which the
/// data of the state before the change serve.
const NEAR: f64 = 1e-5;

/// Multiple of it for which they serve where the slopes of the rails, which turn the forces, follow the present forces.
const CLOSE: f64 = 12.0;

/// Part of the first of these changes by which a wheel may move along its rail before its effect is found anew.
const STILL: f64 = 0.1;

/// How well the data of one state serve at another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Nearness {
    /// They serve as they are.
    Near,
    /// They serve with the rows of forces for the present forces.
    Close,
    Far,
}

/// Shapes of structures with mass at the elements.
#[derive(Clone)]
struct ShapeSlopes {
    /// Slopes of the shapes at each element, over the degrees of freedom, row-major.
    all: Vec<f64>,
    /// Scratch for one probe.
    value: Vec<f64>,
    slope: Vec<f64>,
}

impl Geometry {
    pub fn new(system: &System) -> Self {
        let (m, n) = (system.elements.len(), system.mechanics.dofs);
        let mut constant = Rows::zeros(system.row_spans.clone(), n);
        for (i, element) in system.elements.iter().enumerate() {
            element.constant_row(&system.mechanics, &mut constant.row_mut(i));
        }
        Geometry {
            places: Places::new(&system.mechanics),
            rails: RailCompliance::new(&system.mechanics, &system.probes, m),
            rows: constant.clone(),
            constant,
            local: vec![Local::default(); m],
            switches: Switches::new(&system.scene.actuators),
            rail_slope: vec![0.0; m],
            along_rail: rows_along_rails(system),
            shapes: ShapeSlopes {
                all: vec![0.0; m * n],
                value: vec![0.0; n],
                slope: vec![0.0; n],
            },
            is_built: false,
            near: 0.0,
            height: vec![0.0; system.mechanics.wheels.len()],
            drift: Drift {
                wheels: vec![0.0; system.mechanics.wheels.len()],
                change: vec![0.0; m],
                by_others: vec![0.0; m],
            },
        }
    }

    /// Positions of the wheels.
    pub fn places(&self) -> &Places {
        &self.places
    }

    /// Compliance of the massless rails.
    #[inline]
    pub fn rails(&self) -> &RailMatrices {
        self.rails.matrices()
    }

    /// Rows of the elements.
    #[inline]
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// Properties of the elements, other than their rows, that change with the state.
    #[inline]
    pub fn local(&self) -> &[Local] {
        &self.local
    }

    /// Fraction of the law of element `i` that acts.
    #[inline]
    pub fn fraction(&self, i: usize) -> f64 {
        self.local[i].fraction[0]
    }

    /// The switching state that rules have set.
    pub fn switches(&self) -> &Switches {
        &self.switches
    }

    /// Slope of the deflected rail under element `i`.
    pub fn rail_slope(&self, i: usize) -> f64 {
        self.rail_slope[i]
    }

    /// Slope of the deflected rail under element `i` for the degrees of freedom `q` and the forces `force`, without
    /// that of the unloaded rail's shape.
    pub fn deflected_slope(&self, i: usize, q: &DVector<f64>, force: &[f64]) -> f64 {
        self.rails().deflected_slope(i, force) + self.shape_slope(i, q)
    }

    /// The part of this slope by the degrees of freedom of structures.
    pub fn shape_slope(&self, i: usize, q: &DVector<f64>) -> f64 {
        along(&self.shapes.all, i, q.as_slice())
    }

    /// Slopes of the shapes of structures at element `i`, over the degrees of freedom.
    pub fn shape_row(&self, i: usize) -> &[f64] {
        let n = self.shapes.slope.len();
        &self.shapes.all[i * n..(i + 1) * n]
    }

    /// Approach of element `i` at the degrees of freedom `q`, without the deflection of the rails.
    #[inline]
    pub fn approach(&self, i: usize, q: &DVector<f64>) -> f64 {
        self.rows.approach_at(i, q)
    }

    /// Rate for the damper or the friction law of element `i` at the speeds `v`.
    #[inline]
    pub fn rate(&self, i: usize, v: &DVector<f64>) -> f64 {
        self.rows.rate_at(i, v)
    }

    /// Deflection of the massless rail at element `i` under `force`.
    #[inline]
    pub fn deflection(&self, i: usize, force: &[f64]) -> f64 {
        self.rails().deflection(i, force)
    }

    /// Penetration of element `i` at `at`: its approach less the deflection of the rail.
    #[inline]
    pub fn penetration(&self, i: usize, at: &State) -> f64 {
        self.approach(i, &at.q) - self.deflection(i, &at.force)
    }

    /// Compliance of the rail at element `i` under its own force.
    pub fn own_compliance(&self, i: usize) -> f64 {
        self.rails().value[i * self.local.len() + i]
    }

    /// The scene at `state`; this geometry must belong to `state`.
    #[inline]
    pub fn frame<'c>(&'c self, system: &'c System<'c>, state: &'c State) -> Frame<'c> {
        Frame {
            mechanics: &system.mechanics,
            probes: &system.probes,
            state,
            rows: &self.rows,
            rails: self.rails(),
            places: &self.places,
            switches: &self.switches,
            local: &self.local,
            rail_slope: &self.rail_slope,
            is_uneven: system.traits.is_uneven,
        }
    }

    /// Updates all data to (t, q); `force` contains the latest forces, for the slopes of the rails.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn update(
        &mut self,
        system: &System,
        t: f64,
        q: &DVector<f64>,
        force: &[f64],
    ) -> Result<(), Error> {
        self.update_some(system, (t, q), force, &system.all)
    }

    /// Updates the data of `elements` to (t, q). Elements that are not among them must have no force.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn update_some(
        &mut self,
        system: &System,
        (t, q): (f64, &DVector<f64>),
        force: &[f64],
        elements: &Candidates,
    ) -> Result<(), Error> {
        let mechanics = &system.mechanics;
        self.drift.change.fill(0.0);
        self.drift.wheels.fill(0.0);
        self.places.move_to(mechanics, t, q);
        if system.traits.has_parts {
            for (element, local) in system.elements.iter().zip(&mut self.local) {
                local.fraction = element
                    .fraction(mechanics, &self.places)
                    .unwrap_or(local.fraction);
            }
        }
        self.rails
            .update(mechanics, &system.probes, &self.places.x, elements)?;
        let rows_stay = self.is_built && system.traits.has_constant_rows;
        self.is_built = true;
        if rows_stay {
            return Ok(());
        }
        self.update_rows(system, (t, q), elements)?;
        self.update_force_rows(system, q, force, elements);
        Ok(())
    }

    /// Updates what depends on the heights of the wheels and on the forces, where (t, q) are those of the last update: rows
    /// of elements that use heights, and rows of the forces. Positions, compliance and all other rows are the same.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub fn update_in_place(
        &mut self,
        system: &System,
        (t, q): (f64, &DVector<f64>),
        force: &[f64],
    ) -> Result<(), Error> {
        if system.traits.has_constant_rows {
            return Ok(());
        }
        // Shapes of structures are added to the rows of all elements together.
        let has_structures = system.mechanics.has_structures();
        let elements = if has_structures {
            &system.all
        } else {
            &system.by_height
        };
        self.update_rows(system, (t, q), elements)?;
        self.update_force_rows(system, q, force, &system.all);
        Ok(())
    }

    fn update_rows(
        &mut self,
        system: &System,
        (t, q): (f64, &DVector<f64>),
        elements: &Candidates,
    ) -> Result<(), Error> {
        let mechanics = &system.mechanics;
        let is_uneven = system.traits.is_uneven;
        self.height.copy_from_slice(&self.places.height);
        let Geometry {
            places,
            rows,
            local,
            switches,
            ..
        } = self;
        let at = Where {
            mechanics,
            t,
            q,
            places,
            switches,
            is_uneven,
        };
        let has_structures = mechanics.has_structures();
        for &i in elements.list() {
            rows.reset(
                i,
                &self.constant,
                system.fixed[i]
                    .row_changes
                    .map(|changes| changes || has_structures),
            );
            system.elements[i].update_row(&at, &mut rows.row_mut(i), &mut local[i]);
        }
        if has_structures {
            self.add_shapes(system, elements)?;
        }
        Ok(())
    }

    /// Adds the shapes of structures with mass to the rows of the `elements` on them.
    fn add_shapes(&mut self, system: &System, elements: &Candidates) -> Result<(), Error> {
        let n = system.mechanics.dofs;
        let ShapeSlopes { all, value, slope } = &mut self.shapes;
        all.fill(0.0);
        for (s, entries) in system.probes.entries.iter().enumerate() {
            let Some(structure) = &system.foundations[s].structure else {
                continue;
            };
            let range = system.mechanics.structures[s].clone();
            let size = range.len();
            for entry in entries.iter().filter(|entry| elements.has(entry.element)) {
                let at = Probe {
                    x: self.places.x[entry.wheel],
                    ..entry.probe
                };
                let (value, slope) = (&mut value[..size], &mut slope[..size]);
                structure
                    .shapes
                    .row(at, value, slope)
                    .map_err(|source| Error::Compliance {
                        structure: s,
                        source,
                    })?;
                let span = entry.element * n + range.start..entry.element * n + range.end;
                let is_along = system.fixed[entry.element].is_tangential;
                let rows = if is_along {
                    &mut self.rows.rate
                } else {
                    &mut self.rows.approach
                };
                for (target, shape) in rows[span.clone()].iter_mut().zip(value.iter()) {
                    *target -= entry.weight * shape;
                }
                for (target, shape) in all[span].iter_mut().zip(slope.iter()) {
                    *target += entry.weight * shape;
                }
            }
        }
        Ok(())
    }

    /// Computes the slope of the deflected rail under each element with a force, for the given forces and degrees of
    /// freedom and the wheel positions of the last update. It is set to zero for elements without force, where it has
    /// no effect.
    pub fn update_rail_slope(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) {
        for (i, own) in force.iter().enumerate() {
            if *own == 0.0 {
                self.rail_slope[i] = 0.0;
                continue;
            }
            self.rail_slope[i] = self.rails.matrices().deflected_slope(i, force);
            if system.mechanics.has_structures() {
                self.rail_slope[i] += along(&self.shapes.all, i, q.as_slice());
            }
            if system.traits.is_uneven {
                self.rail_slope[i] -= self.rows.rise[i];
            }
        }
    }

    /// Computes the rows of the forces: the rows of the approach, or of the rate for tangential elements, minus the
    /// slope of the rail times the rows of the wheel's x.
    fn update_force_rows(
        &mut self,
        system: &System,
        q: &DVector<f64>,
        force: &[f64],
        elements: &Candidates,
    ) {
        let moves_freely = system.mechanics.moves_freely;
        if moves_freely {
            self.update_rail_slope(system, q, force);
        }
        for &i in elements.list() {
            let span = self.rows.span(i);
            let own = if system.fixed[i].is_tangential {
                &self.rows.rate
            } else {
                &self.rows.approach
            };
            let (row, own) = (&mut self.rows.force[span.clone()], &own[span.clone()]);
            if !moves_freely {
                row.copy_from_slice(own);
                continue;
            }
            let slope = self.rail_slope[i];
            for (entry, (own, along)) in row.iter_mut().zip(own.iter().zip(&self.along_rail[span]))
            {
                *entry = own - slope * along;
            }
        }
    }

    /// Computes the heights of the wheel centres above their rails from the penetrations of `at`. Returns the largest
    /// relative change, or zero if no element depends on heights.
    pub fn update_heights(&mut self, system: &System, at: &State) -> f64 {
        if !system.traits.uses_heights {
            return 0.0;
        }
        let mut moved = 0.0_f64;
        for w in 0..system.mechanics.wheels.len() {
            // The wheels of one contact share its penetrations.
            if system.mechanics.follows_in_contact(w) {
                self.places.height[w] = self.places.height[w - 1];
                continue;
            }
            let deepest = system
                .mechanics
                .groups_of(w)
                .map(|i| at.p[i])
                .fold(f64::NEG_INFINITY, f64::max);
            let height = system.scene.wheels[system.mechanics.wheels[w].kind].radius - deepest;
            moved = moved.max((height - self.places.height[w]).abs() / height.abs());
            self.places.height[w] = height;
        }
        moved
    }

    /// Sets the heights of all wheels to their radii.
    pub fn reset_heights(&mut self, system: &System) {
        self.places.reset_heights(&system.mechanics);
    }

    /// Sets the piece of the uneven rail on which wheel `w` runs.
    pub fn set_piece(&mut self, w: usize, piece: usize) {
        self.places.piece[w] = piece;
    }

    /// Sets the pieces of uneven rails on which the wheels run.
    pub fn set_pieces(&mut self, pieces: &[usize]) {
        self.places.piece.copy_from_slice(pieces);
    }

    /// Executes `action` of a rule at time `t`. Returns whether the run ends.
    ///
    /// # Errors
    /// A hoisting speed that would wind up the whole rope before the end of the run.
    pub fn switch(&mut self, system: &System, action: Action, t: f64) -> Result<bool, Error> {
        self.switches.switch(system.scene, action, t)
    }

    /// Finds the change of the approach of each element less the deflection of its rail, where this is a state, by the motion
    /// dx of the wheels since the last update to the displacements `q` at the same time, under the forces `force`:
    ///
    /// (h_i' - w_i') dx_i - sum_j (dG_ij/dx_i dx_i + dG_ji/dx_j dx_j) F_j
    ///
    /// to first order, with the slopes h' of the unloaded rail and w' of the shapes of structures. It is zero where the
    /// compliance of a structure is not symmetric, and remains as it is where no wheel has moved by more than a tenth of what
    /// the data serve for.
    pub fn drift_to(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) {
        if !(system.traits.follows_motion && system.traits.has_symmetric_rails) {
            return;
        }
        let mechanics = &system.mechanics;
        let Geometry {
            drift:
                Drift {
                    wheels,
                    change,
                    by_others,
                },
            places,
            rails,
            rows,
            shapes,
            near,
            ..
        } = self;
        let moved = |w: usize| places.of_wheel(mechanics, w, q) - places.x[w];
        let mut leads = (0..wheels.len()).filter(|&w| !mechanics.follows_in_contact(w));
        if leads.all(|w| (moved(w) - wheels[w]).abs() <= STILL * *near) {
            return;
        }
        for w in 0..wheels.len() {
            wheels[w] = if mechanics.follows_in_contact(w) {
                wheels[w - 1]
            } else {
                moved(w)
            };
        }
        let rails = rails.matrices();
        let moved = |i: usize| system.first_wheel[i].map_or(0.0, |wheel| wheels[wheel]);
        by_others.fill(0.0);
        for (j, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            rails.add_slopes(j, moved(j) * force, by_others);
        }
        for &i in &system.probes.states {
            let mut slope = rows.rise[i] - rails.deflected_slope(i, force);
            if mechanics.has_structures() {
                slope -= along(&shapes.all, i, q.as_slice());
            }
            change[i] = moved(i) * slope - by_others[i];
        }
    }

    /// Change of the approach of element `i` less the deflection of its rail by the last [`Geometry::drift_to`]; zero
    /// immediately after an update, and where it is no state.
    #[inline]
    pub fn drift(&self, i: usize) -> f64 {
        self.drift.change[i]
    }

    /// How well the data at the displacements `before` serve at `now`, at the same time. All data change by a part of
    /// the order of dq/L, with the lengths L of rail elements, irregularities and ropes, times the displacements of
    /// the bodies alone: rows are linear in those of structures. A change dh of the height of a wheel changes the
    /// approach of its flange by dh times its roll, and the sliding velocity of a spinning wheel by dh times its
    /// spin.
    pub fn nearness(&self, system: &System, before: &DVector<f64>, now: &DVector<f64>) -> Nearness {
        if !system.traits.has_symmetric_rails {
            return Nearness::Far;
        }
        let bodies = system.mechanics.body_dofs();
        let moved = before.as_slice().iter().zip(now.as_slice()).take(bodies);
        let farthest = moved.fold(0.0_f64, |max, (before, now)| max.max((now - before).abs()));
        if farthest > CLOSE * self.near {
            return Nearness::Far;
        }
        let by_height = system.by_height.list().iter();
        let raised = by_height
            .filter_map(|&i| Some((i, system.first_wheel[i]?)))
            .map(|(i, wheel)| {
                let raised = (self.places.height[wheel] - self.height[wheel]).abs();
                let arm = if system.fixed[i].is_tangential {
                    1.0
                } else {
                    system.mechanics.roll(wheel, now).abs()
                };
                raised * arm
            });
        let farthest = raised.fold(farthest, f64::max);
        if farthest <= self.near {
            Nearness::Near
        } else if farthest <= CLOSE * self.near {
            Nearness::Close
        } else {
            Nearness::Far
        }
    }

    /// Updates the rows of the forces of `elements` to the displacements `q` and the forces `force`, at the positions
    /// of the last update.
    pub fn turn_forces(
        &mut self,
        system: &System,
        q: &DVector<f64>,
        force: &[f64],
        elements: &Candidates,
    ) {
        if !system.traits.has_constant_rows {
            self.update_force_rows(system, q, force, elements);
        }
    }

    /// Sets the tolerance distances for extrapolation of the compliance, for steps with the relative error
    /// `tolerance`; `radius` is the radius of the smallest wheel.
    pub fn set_accuracy(&mut self, tolerance: f64, radius: f64) {
        // Without wheels the radius is infinite.
        self.near = if radius.is_finite() {
            NEAR * tolerance * radius
        } else {
            0.0
        };
        self.rails.set_accuracy(tolerance, radius);
    }

    /// Whether interpolation of the compliance along paths is useful.
    pub fn wants_paths(&self) -> bool {
        self.rails.wants_paths()
    }

    /// Sets the paths along which the compliance is interpolated. `ends` are three times with their degrees of
    /// freedom. The path runs from the first to the third, or to the second if a rail element ends before the third.
    pub fn set_paths(&mut self, system: &System, ends: [(f64, &DVector<f64>); 3]) {
        let mechanics = &system.mechanics;
        let places = ends.map(|(t, q)| {
            self.places.travel_to(mechanics, t);
            (0..mechanics.wheels.len())
                .map(|w| self.places.of_wheel(mechanics, w, q))
                .collect::<Vec<_>>()
        });
        self.rails.set_paths(
            mechanics,
            &system.probes,
            places.each_ref().map(Vec::as_slice),
        );
    }

    /// Takes what `other` knows of the compliance along the prescribed ways of the wheels ([`RailCompliance::take_paths`]).
    pub fn take_paths(&mut self, other: &Geometry) {
        self.rails.take_paths(&other.rails);
    }

    /// Begins a path of the compliance of structure `s`; the present one is kept.
    pub fn begin_path(&mut self, s: usize) {
        self.rails.begin_path(s);
    }

    /// Exchanges the path of the compliance of structure `s` and the one before the last joint.
    pub fn exchange_paths(&mut self, s: usize) {
        self.rails.exchange_paths(s);
    }

    /// Sets the rail coordinates of wheels that cross at constant `speed` from their coordinates `start`, at time
    /// `t`. No other data are updated, except the travel of a body whose index and start are `root`.
    pub fn move_uniformly(
        &mut self,
        start: &[f64],
        speed: f64,
        t: f64,
        root: Option<(usize, f64)>,
    ) {
        let way = speed * t;
        for (x, place) in self.places.x.iter_mut().zip(start) {
            *x = place + way;
        }
        if let Some((root, from)) = root {
            let travel = &mut self.places.travel[root];
            (travel.x, travel.v) = (from + way, speed);
        }
    }

    /// Sets slopes of the deflected rails that were computed elsewhere; `slope` may be longer than there are elements.
    pub fn set_rail_slope(&mut self, slope: &[f64]) {
        for (own, slope) in self.rail_slope.iter_mut().zip(slope) {
            *own = *slope;
        }
    }

    /// Sets a compliance that was computed elsewhere, row by row.
    pub fn set_compliance(&mut self, rows: impl Iterator<Item = impl AsRef<[f64]>>) {
        self.rails.set_value(rows);
    }
}

/// Rows of the x of the wheels on which the slope of the deflected rail exerts a force, elements x degrees of freedom,
/// row-major; empty if no wheel moves freely along its rail.
fn rows_along_rails(system: &System) -> Vec<f64> {
    let (mechanics, n) = (&system.mechanics, system.mechanics.dofs);
    if !mechanics.moves_freely {
        return Vec::new();
    }
    let mut rows = vec![0.0; system.elements.len() * n];
    for (element, row) in system.elements.iter().zip(rows.chunks_exact_mut(n.max(1))) {
        let Some(wheel) = element.tilted_wheel().map(|w| &mechanics.wheels[w]) else {
            continue;
        };
        for (number, share) in mechanics
            .kinematics
            .combine(wheel.body, &arm_rows(wheel.hub)[0])
        {
            row[number] = share;
        }
    }
    rows
}
