//! The scene as numbered unknowns: freedoms q, contact components F, and the matrices between them.
//!
//! M q'' + C q' + K q = f(t) - R^T F. A component is a vertical contact (of one wheel, or of the wheels of
//! equalisers), a flange or a wheel's friction, in this order.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use splines::{Axis, Influence, Probe};

use crate::scene::arm_rows;
use crate::{Error, Foundation, Freedom, NormalLaw, Scene};

/// One physical wheel.
pub(crate) struct WheelPoint {
    pub body: usize,
    pub contact: usize,
    pub kind: usize,
    /// Hub from the body's origin.
    pub hub: [f64; 3],
    /// Index of its spin among the freedoms.
    pub spin: Option<usize>,
}

/// One vertical contact component.
pub(crate) struct Normal {
    pub wheels: Range<usize>,
    pub kind: usize,
    pub contact: usize,
    /// Which rigid part it presses on, where every part has its own force.
    pub part: Option<usize>,
}

impl Normal {
    /// Number of wheels that share the force.
    pub fn count(&self) -> f64 {
        self.wheels.len() as f64
    }
}

/// One probe of a structure: which component it belongs to, and its signed weight there.
pub(crate) struct Entry {
    pub component: usize,
    pub weight: f64,
    pub wheel: usize,
    pub probe: Probe,
}

/// The numbered scene.
pub(crate) struct System<'a> {
    pub scene: &'a Scene,
    pub foundations: &'a [Foundation],
    pub wheels: Vec<WheelPoint>,
    pub normals: Vec<Normal>,
    /// Wheels with a flange; component `normals.len() + i`.
    pub laterals: Vec<usize>,
    /// Wheels with friction; component `normals.len() + laterals.len() + i`.
    pub tractions: Vec<usize>,
    /// Freedom numbers of each body.
    pub freedom: Vec<[Option<usize>; 6]>,
    /// Freedom numbers of each structure.
    pub structure: Vec<Range<usize>>,
    pub freedoms: usize,
    pub mass: DMatrix<f64>,
    pub damping: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    pub gravity: DVector<f64>,
    /// Probes of each structure.
    pub entries: Vec<Vec<Entry>>,
    /// Whether some wheel's place along the rail depends on the freedoms.
    pub moves_freely: bool,
    /// Whether the rows of contact are the same at every time and place.
    pub constant_rows: bool,
    /// Whether every vertical law is linear.
    pub linear_normals: bool,
    /// Whether the linear contact equations are symmetric: see [`crate::forces`].
    pub symmetric: bool,
}

impl<'a> System<'a> {
    /// Numbers a scene.
    pub fn new(scene: &'a Scene, foundations: &'a [Foundation]) -> Result<Self, Error> {
        scene.check(foundations.len())?;
        let mut freedoms = 0;
        let mut next = || {
            freedoms += 1;
            freedoms - 1
        };
        let freedom: Vec<[Option<usize>; 6]> = scene
            .bodies
            .iter()
            .map(|body| {
                let mut numbers = [None; 6];
                for (i, number) in numbers.iter_mut().enumerate() {
                    if body.free[i] && !(i == 0 && body.motion.is_some()) {
                        *number = Some(next());
                    }
                }
                numbers
            })
            .collect();
        let (mut wheels, mut normals) = (Vec::new(), Vec::new());
        for (index, contact) in scene.contacts.iter().enumerate() {
            let first = wheels.len();
            let kind = &scene.wheels[contact.wheel];
            for offset in &contact.offsets {
                let [x, y, z] = contact.at;
                let spin =
                    if kind.spin_inertia.is_some() && kind.friction.is_some() { Some(next()) } else { None };
                wheels.push(WheelPoint {
                    body: contact.body,
                    contact: index,
                    kind: contact.wheel,
                    hub: [x + offset, y, z],
                    spin,
                });
            }
            let parts = match &foundations[contact.structure].parts {
                Some(chains) => {
                    let chain = chains
                        .get(contact.rail)
                        .ok_or(Error::NoSuch { what: "rail", index: contact.rail })?;
                    (0..chain.count()).map(Some).collect()
                }
                None => vec![None],
            };
            for part in parts {
                normals.push(Normal {
                    wheels: first..wheels.len(),
                    kind: contact.wheel,
                    contact: index,
                    part,
                });
            }
        }
        let structure: Vec<Range<usize>> = foundations
            .iter()
            .map(|foundation| {
                let first = freedoms;
                freedoms += foundation.freedoms();
                first..freedoms
            })
            .collect();
        let laterals: Vec<usize> =
            (0..wheels.len()).filter(|&w| scene.wheels[wheels[w].kind].flange.is_some()).collect();
        let tractions: Vec<usize> = (0..wheels.len()).filter(|&w| wheels[w].spin.is_some()).collect();

        let mut system = System {
            scene,
            foundations,
            wheels,
            normals,
            laterals,
            tractions,
            freedom,
            structure,
            freedoms,
            mass: DMatrix::zeros(freedoms, freedoms),
            damping: DMatrix::zeros(freedoms, freedoms),
            stiffness: DMatrix::zeros(freedoms, freedoms),
            gravity: DVector::zeros(freedoms),
            entries: Vec::new(),
            moves_freely: false,
            constant_rows: false,
            linear_normals: false,
            symmetric: false,
        };
        system.fill_matrices()?;
        system.entries = (0..foundations.len()).map(|s| system.structure_entries(s)).collect();
        system.moves_freely = system.wheels.iter().any(|wheel| {
            let numbers = &system.freedom[wheel.body];
            numbers[0].is_some()
                || (numbers[4].is_some() && wheel.hub[2] != 0.0)
                || (numbers[5].is_some() && wheel.hub[1] != 0.0)
        });
        system.constant_rows = !system.moves_freely
            && system.laterals.is_empty()
            && system.tractions.is_empty()
            && foundations.iter().all(|foundation| foundation.structure.is_none());
        let laws = || scene.contacts.iter().map(|contact| &scene.wheels[contact.wheel].normal);
        system.linear_normals = laws().all(NormalLaw::is_linear);
        let ratio = |law: &NormalLaw| law.damping / law.stiffness;
        let grounded = laws().find(|law| !law.has_memory());
        system.symmetric = !system.moves_freely
            && grounded.is_none_or(|first| {
                laws().all(
                    |law| if law.has_memory() { ratio(first) == 0.0 } else { ratio(law) == ratio(first) },
                )
            });
        Ok(system)
    }

    /// Number of contact components.
    pub fn components(&self) -> usize {
        self.normals.len() + self.laterals.len() + self.tractions.len()
    }

    /// Component of flange `i`.
    pub fn lateral(&self, i: usize) -> usize {
        self.normals.len() + i
    }

    /// Component of friction `i`.
    pub fn traction(&self, i: usize) -> usize {
        self.normals.len() + self.laterals.len() + i
    }

    /// The vertical contact that `wheel` belongs to; of its parts' contacts, the first.
    pub fn normals_of(&self, wheel: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.normals.len()).filter(move |&n| self.normals[n].wheels.contains(&wheel))
    }

    /// Displacements and speeds of body `b` in all six freedoms at time `t`.
    pub fn body(&self, b: usize, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> ([f64; 6], [f64; 6]) {
        let body = &self.scene.bodies[b];
        let (mut displacement, mut speed) = (body.start, [0.0; 6]);
        for i in 0..6 {
            if let Some(number) = self.freedom[b][i] {
                displacement[i] = q[number];
                speed[i] = v[number];
            }
        }
        if let Some(profile) = &body.motion {
            let at = profile.at(t);
            displacement[0] = at.x;
            speed[0] = at.v;
        }
        (displacement, speed)
    }

    fn fill_matrices(&mut self) -> Result<(), Error> {
        for (b, body) in self.scene.bodies.iter().enumerate() {
            let matrix = body.mass_matrix();
            let numbers = self.freedom[b];
            for i in 0..6 {
                let Some(row) = numbers[i] else { continue };
                if !(matrix[i][i] > 0.0 && matrix[i][i].is_finite()) {
                    return Err(Error::NoInertia { body: b, freedom: Freedom::ALL[i] });
                }
                for j in 0..6 {
                    if let Some(column) = numbers[j] {
                        self.mass[(row, column)] = matrix[i][j];
                    }
                }
                self.gravity[row] = -body.mass * self.scene.gravity * arm_rows(body.cg)[1][i];
            }
        }
        for wheel in &self.wheels {
            if let (Some(number), Some(inertia)) = (wheel.spin, self.scene.wheels[wheel.kind].spin_inertia) {
                self.mass[(number, number)] = inertia;
            }
        }
        for (range, foundation) in self.structure.iter().zip(self.foundations) {
            let Some(structure) = &foundation.structure else { continue };
            let (at, size) = ((range.start, range.start), (range.len(), range.len()));
            self.mass.view_mut(at, size).copy_from(&structure.mass);
            self.damping.view_mut(at, size).copy_from(&structure.damping);
            self.stiffness.view_mut(at, size).copy_from(&structure.stiffness);
        }
        Ok(())
    }

    /// Probes of structure `s`. A vertical component is positive downwards, hence its weight is negative;
    /// friction does not load the structure.
    fn structure_entries(&self, s: usize) -> Vec<Entry> {
        let mut entries = Vec::new();
        let rail_of = |contact: usize, part: Option<usize>| {
            let rail = self.scene.contacts[contact].rail;
            match (&self.foundations[s].parts, part) {
                (Some(chains), Some(part)) => chains[rail].rail(part),
                _ => rail,
            }
        };
        for (component, normal) in self.normals.iter().enumerate() {
            if self.scene.contacts[normal.contact].structure != s {
                continue;
            }
            for wheel in normal.wheels.clone() {
                let probe =
                    Probe { rail: rail_of(normal.contact, normal.part), x: 0.0, axis: Axis::Vertical };
                entries.push(Entry { component, weight: -1.0 / normal.count(), wheel, probe });
            }
        }
        for (i, &wheel) in self.laterals.iter().enumerate() {
            let contact = self.wheels[wheel].contact;
            if self.scene.contacts[contact].structure == s && self.foundations[s].parts.is_none() {
                let probe = Probe { rail: rail_of(contact, None), x: 0.0, axis: Axis::Lateral };
                entries.push(Entry { component: self.lateral(i), weight: 1.0, wheel, probe });
            }
        }
        entries
    }
}

/// Everything about the contacts that depends on where the wheels are.
#[derive(Clone)]
pub(crate) struct Geometry {
    /// Rail coordinate of each wheel.
    pub x: Vec<f64>,
    /// Height of each wheel's centre above its rail, from the last solution.
    pub height: Vec<f64>,
    /// Share of each vertical contact's law that acts, and its slope along the rail.
    pub share: Vec<[f64; 2]>,
    /// G over components, row-major.
    pub compliance: Vec<f64>,
    /// d G(i, j)/d x_i over components, row-major.
    pub slope: Vec<f64>,
    /// Approach e = `held` + `rows` q, before the give of G.
    pub rows: Vec<f64>,
    pub held: Vec<f64>,
    /// Rows of the forces, `rows` and the force along the rail from its slope: f = -`force_rows`^T F.
    pub force_rows: Vec<f64>,
    /// Rates that dampers and friction feel: `rate_held` + `rate_rows` v.
    pub rate_rows: Vec<f64>,
    pub rate_held: Vec<f64>,
    /// Slope of the deflected rail under each component, d u/d x.
    pub rail_slope: Vec<f64>,
    influence: Vec<Influence>,
    probes: Vec<Vec<Probe>>,
    shape: Vec<f64>,
    shape_slope: Vec<f64>,
    built: bool,
}

impl Geometry {
    pub fn new(system: &System) -> Self {
        let (m, n) = (system.components(), system.freedoms);
        Geometry {
            x: vec![0.0; system.wheels.len()],
            height: system.wheels.iter().map(|wheel| system.scene.wheels[wheel.kind].radius).collect(),
            share: vec![[1.0, 0.0]; system.normals.len()],
            compliance: vec![0.0; m * m],
            slope: vec![0.0; m * m],
            rows: vec![0.0; m * n],
            held: vec![0.0; m],
            force_rows: vec![0.0; m * n],
            rate_rows: vec![0.0; m * n],
            rate_held: vec![0.0; m],
            rail_slope: vec![0.0; m],
            influence: system.entries.iter().map(|entries| Influence::zeros(entries.len())).collect(),
            probes: system.entries.iter().map(|e| e.iter().map(|entry| entry.probe).collect()).collect(),
            shape: vec![0.0; n],
            shape_slope: vec![0.0; n],
            built: false,
        }
    }

    /// Updates everything for the wheels' places at (t, q); `force` are the latest forces, for the rail's slope.
    pub fn update(&mut self, system: &System, t: f64, q: &DVector<f64>, force: &[f64]) -> Result<(), Error> {
        let speed_is_needed = !system.tractions.is_empty();
        for (w, wheel) in system.wheels.iter().enumerate() {
            let body = &system.scene.bodies[wheel.body];
            let numbers = &system.freedom[wheel.body];
            let value = |i: usize| numbers[i].map_or(body.start[i], |number| q[number]);
            let x = body.motion.as_ref().map_or_else(|| value(0), |profile| profile.at(t).x);
            self.x[w] = x + wheel.hub[0] + value(4) * wheel.hub[2] - value(5) * wheel.hub[1];
        }
        self.update_compliance(system)?;
        if !(self.built && system.constant_rows) {
            self.update_rows(system)?;
            self.built = true;
        }
        if speed_is_needed {
            for (i, &w) in system.tractions.iter().enumerate() {
                let body = &system.scene.bodies[system.wheels[w].body];
                self.rate_held[system.traction(i)] =
                    body.motion.as_ref().map_or(0.0, |profile| profile.at(t).v);
            }
        }
        self.update_force_rows(system, q, force)
    }

    fn update_compliance(&mut self, system: &System) -> Result<(), Error> {
        let m = system.components();
        for (s, entries) in system.entries.iter().enumerate() {
            let foundation = &system.foundations[s];
            if let Some(chains) = &foundation.parts {
                for (normal, share) in system.normals.iter().zip(&mut self.share) {
                    let contact = &system.scene.contacts[normal.contact];
                    if let (true, Some(part)) = (contact.structure == s, normal.part) {
                        let chain = &chains[contact.rail];
                        let mean = normal.wheels.clone().map(|w| self.x[w]).sum::<f64>() / normal.count();
                        *share = chain.share(part, mean);
                    }
                }
            }
            let Some(compliance) = &foundation.compliance else { continue };
            for (probe, entry) in self.probes[s].iter_mut().zip(entries) {
                probe.x = self.x[entry.wheel];
            }
            let influence = &mut self.influence[s];
            compliance
                .fill(&self.probes[s], influence)
                .map_err(|source| Error::Compliance { structure: s, source })?;
            for row in entries {
                self.compliance[row.component * m..(row.component + 1) * m].fill(0.0);
                self.slope[row.component * m..(row.component + 1) * m].fill(0.0);
            }
            for (i, row) in entries.iter().enumerate() {
                for (j, column) in entries.iter().enumerate() {
                    let weight = row.weight * column.weight;
                    let at = row.component * m + column.component;
                    self.compliance[at] += weight * influence.value[(i, j)];
                    self.slope[at] += weight * influence.slope[(i, j)];
                }
            }
        }
        Ok(())
    }

    fn update_rows(&mut self, system: &System) -> Result<(), Error> {
        let n = system.freedoms;
        self.rows.fill(0.0);
        self.rate_rows.fill(0.0);
        self.held.fill(0.0);
        let put =
            |rows: &mut [f64], held: &mut f64, component: usize, body: usize, row: [f64; 6], scale: f64| {
                for i in 0..6 {
                    match system.freedom[body][i] {
                        Some(number) => rows[component * n + number] += scale * row[i],
                        None if i > 0 => *held += scale * row[i] * system.scene.bodies[body].start[i],
                        None => {}
                    }
                }
            };
        for (component, normal) in system.normals.iter().enumerate() {
            for w in normal.wheels.clone() {
                let wheel = &system.wheels[w];
                let row = arm_rows(wheel.hub)[1];
                put(
                    &mut self.rows,
                    &mut self.held[component],
                    component,
                    wheel.body,
                    row,
                    -1.0 / normal.count(),
                );
            }
            let span = component * n..(component + 1) * n;
            self.rate_rows[span.clone()].copy_from_slice(&self.rows[span]);
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            let (component, wheel) = (system.lateral(i), &system.wheels[w]);
            let [x, y, z] = wheel.hub;
            let row = arm_rows([x, y - self.height[w], z])[2];
            put(&mut self.rows, &mut self.held[component], component, wheel.body, row, 1.0);
        }
        let mut unused = 0.0;
        for (i, &w) in system.tractions.iter().enumerate() {
            let (component, wheel) = (system.traction(i), &system.wheels[w]);
            put(&mut self.rate_rows, &mut unused, component, wheel.body, arm_rows(wheel.hub)[0], 1.0);
            if let Some(spin) = wheel.spin {
                self.rate_rows[component * n + spin] += self.height[w];
            }
        }
        for (s, entries) in system.entries.iter().enumerate() {
            let Some(structure) = &system.foundations[s].structure else { continue };
            let range = system.structure[s].clone();
            let size = range.len();
            for entry in entries {
                let at = Probe { x: self.x[entry.wheel], ..entry.probe };
                let (value, slope) = (&mut self.shape[..size], &mut self.shape_slope[..size]);
                structure
                    .shapes
                    .row(at, value, slope)
                    .map_err(|source| Error::Compliance { structure: s, source })?;
                let row = &mut self.rows[entry.component * n + range.start..entry.component * n + range.end];
                for (target, shape) in row.iter_mut().zip(value.iter()) {
                    *target -= entry.weight * shape;
                }
            }
        }
        Ok(())
    }

    /// Slope of the deflected rail under each component, for the forces and freedoms given.
    pub fn update_rail_slope(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) -> Result<(), Error> {
        let m = system.components();
        for i in 0..m {
            self.rail_slope[i] = self.slope[i * m..(i + 1) * m].iter().zip(force).map(|(g, f)| g * f).sum();
        }
        for (s, entries) in system.entries.iter().enumerate() {
            let Some(structure) = &system.foundations[s].structure else { continue };
            let range = system.structure[s].clone();
            let size = range.len();
            for entry in entries {
                let at = Probe { x: self.x[entry.wheel], ..entry.probe };
                let (value, slope) = (&mut self.shape[..size], &mut self.shape_slope[..size]);
                structure
                    .shapes
                    .row(at, value, slope)
                    .map_err(|source| Error::Compliance { structure: s, source })?;
                self.rail_slope[entry.component] += entry.weight
                    * slope.iter().zip(range.clone()).map(|(shape, number)| shape * q[number]).sum::<f64>();
            }
        }
        Ok(())
    }

    /// Rows of the forces: those of the approach, less the rail's slope times the rows of the wheel's x.
    fn update_force_rows(&mut self, system: &System, q: &DVector<f64>, force: &[f64]) -> Result<(), Error> {
        let n = system.freedoms;
        if system.constant_rows {
            if self.force_rows != self.rows {
                self.force_rows.copy_from_slice(&self.rows);
            }
            return Ok(());
        }
        let first_traction = system.traction(0);
        self.force_rows.copy_from_slice(&self.rows);
        self.force_rows[first_traction * n..].copy_from_slice(&self.rate_rows[first_traction * n..]);
        if !system.moves_freely {
            return Ok(());
        }
        self.update_rail_slope(system, q, force)?;
        let mut along = |component: usize, w: usize| {
            let wheel = &system.wheels[w];
            let row = arm_rows(wheel.hub)[0];
            for (i, coefficient) in row.iter().enumerate() {
                if let Some(number) = system.freedom[wheel.body][i] {
                    self.force_rows[component * n + number] -= self.rail_slope[component] * coefficient;
                }
            }
        };
        for (component, normal) in system.normals.iter().enumerate() {
            along(component, normal.wheels.start);
        }
        for (i, &w) in system.laterals.iter().enumerate() {
            along(system.lateral(i), w);
        }
        Ok(())
    }
}
