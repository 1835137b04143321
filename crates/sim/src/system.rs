//! The scene as numbered unknowns: freedoms q, contact components F, and the matrices between them.
//!
//! M q'' + C q' + K q = f(t) - R^T F. A component is a vertical contact (of one wheel, or of the wheels of
//! equalisers), a flange, a wheel's friction, a drive, a brake, a rope or a stop,
//! in this order.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use splines::{Axis, Probe};

use crate::actuator::Pull;
use crate::kinematics::{Kinematics, Terms};
use crate::link::Link;
use crate::matter::Block;
use crate::ride::Rides;
use crate::scene::arm_rows;
use crate::stand::{Normal, Stand, WheelPoint};
use crate::state::State;
use crate::tie::Tie;
use crate::{Error, Flange, Foundation, Freedom, Irregularity, Load, Mount, NormalLaw, Scene};

/// One probe of a structure: which component it belongs to, and its signed weight there.
pub(crate) struct Entry {
    pub component: usize,
    pub weight: f64,
    pub wheel: usize,
    pub probe: Probe,
    /// Which of [`System::treads`] it belongs to.
    pub tread: Option<usize>,
}

/// Wheels of one contact under a component along a rail that gives: they move alike.
pub(crate) struct Tread {
    pub component: usize,
    /// The first of them.
    pub wheel: usize,
}

/// Share of a freedom's mass below which what it moves by itself is rounding.
const IDLE: f64 = 1e-13;

/// The numbered scene.
pub(crate) struct System<'a> {
    pub scene: &'a Scene,
    pub foundations: &'a [Foundation],
    pub wheels: Vec<WheelPoint<'a>>,
    pub normals: Vec<Normal>,
    /// Vertical components of each contact.
    bearing: Vec<Range<usize>>,
    /// Where components along the rails load structures that feel it.
    pub treads: Vec<Tread>,
    /// Wheels with a flange; component `normals.len() + i`.
    pub laterals: Vec<usize>,
    /// Wheels with friction; component `normals.len() + laterals.len() + i`.
    pub tractions: Vec<usize>,
    /// Drives and braked contacts; component `normals.len() + laterals.len() + tractions.len() + i`.
    pub pulls: Vec<Pull>,
    /// Ropes and stops, the last components.
    pub links: Vec<Link<'a>>,
    /// Numbers of the freedoms of each body itself.
    pub freedom: Vec<[Option<usize>; 6]>,
    /// Displacements of the bodies over the freedoms.
    pub kinematics: Kinematics,
    /// Bodies that ride on bodies.
    pub rides: Rides,
    /// Freedom numbers of each structure.
    pub structure: Vec<Range<usize>>,
    pub freedoms: usize,
    /// M, C and K: the bodies and spins, then each structure; without bodies that ride on others.
    pub blocks: Vec<Block>,
    /// Inertia between the bodies and structures on them.
    pub ties: Vec<Tie>,
    /// Weights, without those of bodies that ride on others.
    pub gravity: DVector<f64>,
    /// Probes of each structure.
    pub entries: Vec<Vec<Entry>>,
    /// Whether the probes of a structure are the components in their order, with weight -1 each: the compliance
    /// of the components is then the structure's.
    pub is_direct: Vec<bool>,
    /// Largest stiffness of a wheel on its rail.
    pub stiffest: f64,
    /// Whether some structure is loaded along its rails.
    pub is_dragged: bool,
    /// Whether some wheel runs on an uneven rail.
    pub is_uneven: bool,
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
        Mount::check(scene, foundations)?;
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
        let Stand { wheels, normals, bearing } = Stand::new(scene, foundations, &mut next)?;
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
        let tractions: Vec<usize> =
            (0..wheels.len()).filter(|&w| wheels[w].spin.is_some() || wheels[w].turn.is_some()).collect();

        let mut kinematics = Kinematics::new(scene, &freedom)?;
        let rides = Rides::new(scene, foundations, &kinematics)?;
        kinematics.weigh(scene, foundations, &structure, &rides);
        let mut system = System {
            scene,
            foundations,
            wheels,
            normals,
            bearing,
            treads: Vec::new(),
            laterals,
            tractions,
            pulls: Vec::new(),
            links: Vec::new(),
            kinematics,
            rides,
            freedom,
            structure,
            freedoms,
            blocks: Vec::new(),
            ties: Vec::new(),
            gravity: DVector::zeros(freedoms),
            entries: Vec::new(),
            is_direct: Vec::new(),
            stiffest: scene.wheels.iter().fold(0.0, |max, wheel| wheel.normal.stiffness.max(max)),
            is_dragged: foundations.iter().any(|foundation| foundation.is_dragged),
            is_uneven: false,
            moves_freely: false,
            constant_rows: false,
            linear_normals: false,
            symmetric: false,
        };
        system.fill_matrices()?;
        system.pulls = Pull::all(&system);
        system.links = Link::all(&system);
        system.treads = system.all_treads();
        system.entries = (0..foundations.len()).map(|s| system.structure_entries(s)).collect();
        system.is_direct = system
            .entries
            .iter()
            .map(|entries| {
                entries.len() == system.components()
                    && entries.iter().enumerate().all(|(i, e)| e.component == i && e.weight == -1.0)
            })
            .collect();
        system.judge();
        Ok(system)
    }

    /// Finds which simplifications hold.
    fn judge(&mut self) {
        self.moves_freely = self
            .wheels
            .iter()
            .any(|wheel| !self.kinematics.combine(wheel.body, &arm_rows(wheel.hub)[0]).is_empty());
        self.is_uneven = (0..self.wheels.len()).any(|w| self.irregularity(w).is_some());
        self.constant_rows = !self.moves_freely
            && !self.is_uneven
            && self.laterals.is_empty()
            && self.tractions.is_empty()
            && self.pulls.is_empty()
            && self.links.is_empty()
            && self.foundations.iter().all(|foundation| foundation.structure.is_none());
        let scene = self.scene;
        let laws = || scene.contacts.iter().map(|contact| &scene.wheels[contact.wheel].normal);
        self.linear_normals = laws().all(NormalLaw::is_linear);
        let ratio = |law: &NormalLaw| law.damping / law.stiffness;
        let grounded = laws().find(|law| !law.has_memory());
        self.symmetric = !self.moves_freely
            && self.foundations.iter().filter_map(|f| f.compliance.as_ref()).all(|c| c.is_symmetric())
            && grounded.is_none_or(|first| {
                laws().all(
                    |law| if law.has_memory() { ratio(first) == 0.0 } else { ratio(law) == ratio(first) },
                )
            });
    }

    /// Shape of the unloaded rail of wheel `w`, where it is uneven.
    pub fn irregularity(&self, w: usize) -> Option<&'a Irregularity> {
        let contact = &self.scene.contacts[self.wheels[w].contact];
        let shapes = &self.foundations[contact.structure].irregularities;
        shapes.get(contact.rail).filter(|shape| !shape.is_straight())
    }

    /// Number of contact components.
    pub fn components(&self) -> usize {
        self.normals.len() + self.laterals.len() + self.tractions.len() + self.pulls.len() + self.links.len()
    }

    /// Whether some structure has freedoms of its own.
    pub fn has_structures(&self) -> bool {
        self.structure.iter().any(|range| !range.is_empty())
    }

    /// Law of vertical contact `i`, of one wheel.
    pub fn law(&self, i: usize) -> &'a NormalLaw {
        &self.scene.wheels[self.normals[i].kind].normal
    }

    /// Component of flange `i`.
    pub fn lateral(&self, i: usize) -> usize {
        self.normals.len() + i
    }

    /// The law of flange `i`.
    pub fn flange(&self, i: usize) -> Option<&'a Flange> {
        self.scene.wheels[self.wheels[self.laterals[i]].kind].flange.as_ref()
    }

    /// Component of friction `i`.
    pub fn traction(&self, i: usize) -> usize {
        self.normals.len() + self.laterals.len() + i
    }

    /// Component of drive or brake `i`.
    pub fn pull(&self, i: usize) -> usize {
        self.normals.len() + self.laterals.len() + self.tractions.len() + i
    }

    /// Components along the rails whose massless give is a state: frictions, drives and brakes, where some structure is
    /// dragged.
    pub fn drags(&self) -> Range<usize> {
        if self.is_dragged { self.traction(0)..self.link(0) } else { 0..0 }
    }

    fn all_treads(&self) -> Vec<Tread> {
        let mut treads: Vec<Tread> = Vec::new();
        for component in self.drags() {
            for wheel in self.wheels_of(component) {
                let contact = self.wheels[wheel].contact;
                let is_dragged = self.foundations[self.scene.contacts[contact].structure].is_dragged;
                if is_dragged && self.tread_of(&treads, component, contact).is_none() {
                    treads.push(Tread { component, wheel });
                }
            }
        }
        treads
    }

    /// Which of `treads` is that of a contact under a component.
    fn tread_of(&self, treads: &[Tread], component: usize, contact: usize) -> Option<usize> {
        let is_own =
            |tread: &Tread| tread.component == component && self.wheels[tread.wheel].contact == contact;
        treads.iter().position(is_own)
    }

    /// Wheels of component `i` along a rail: those of a friction, a drive, a brake.
    pub fn wheels_of(&self, i: usize) -> Vec<usize> {
        match i.checked_sub(self.pull(0)) {
            None => i.checked_sub(self.traction(0)).map(|index| self.tractions[index]).into_iter().collect(),
            Some(index) => {
                let contacts = &self.pulls[index].contacts;
                (0..self.wheels.len()).filter(|&w| contacts.contains(&self.wheels[w].contact)).collect()
            }
        }
    }

    /// Component of rope or stop `i`.
    pub fn link(&self, i: usize) -> usize {
        self.pull(self.pulls.len()) + i
    }

    /// Number of the freedom of load `load`.
    pub fn loaded(&self, load: &Load) -> Option<usize> {
        self.freedom[load.body][load.freedom as usize]
    }

    /// The vertical components that `wheel` belongs to: one, or one a part.
    pub fn normals_of(&self, wheel: usize) -> Range<usize> {
        self.bearing[self.wheels[wheel].contact].clone()
    }

    /// Displacements and speeds of body `b` in all six freedoms at time `t`.
    pub fn body(&self, b: usize, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> ([f64; 6], [f64; 6]) {
        let body = &self.scene.bodies[b];
        if body.pinned.is_some() {
            return self.pinned(b, t, q, v);
        }
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

    fn pinned(&self, b: usize, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> ([f64; 6], [f64; 6]) {
        let (mut displacement, mut speed) = (self.kinematics.apply(b, q), self.kinematics.apply(b, v));
        displacement.iter_mut().zip(self.kinematics.held(b)).for_each(|(sum, held)| *sum += held);
        if let Some(profile) = &self.scene.bodies[self.kinematics.root(b)].motion {
            let at = profile.at(t);
            displacement[0] += at.x;
            speed[0] += at.v;
        }
        (displacement, speed)
    }

    /// Speed of wheel `w` along its rail, that of its hub.
    pub fn speed_along(&self, w: usize, at: &State) -> f64 {
        let wheel = &self.wheels[w];
        let (_, speed) = self.body(wheel.body, at.t, &at.q, &at.v);
        arm_rows(wheel.hub)[0].iter().zip(&speed).map(|(arm, speed)| arm * speed).sum()
    }

    /// The same of the wheels of vertical contact `i`.
    pub fn contact_speed(&self, i: usize, at: &State) -> f64 {
        self.speed_along(self.normals[i].wheels.start, at)
    }

    /// Number of the freedoms of bodies and spins, the first of all.
    pub fn body_freedoms(&self) -> usize {
        self.structure.first().map_or(self.freedoms, |range| range.start)
    }

    fn fill_matrices(&mut self) -> Result<(), Error> {
        let bodies = self.body_freedoms();
        let mut mass = DMatrix::zeros(bodies, bodies);
        for (b, body) in self.scene.bodies.iter().enumerate().filter(|(b, _)| !self.rides.has(*b)) {
            self.kinematics.add_mass(b, &body.mass_matrix(), &mut mass);
            let line = arm_rows(body.cg)[1].map(|arm| body.mass * arm);
            weigh(&mut self.gravity, self.scene, self.kinematics.terms(b), &line);
        }
        for mount in self.foundations.iter().filter_map(|foundation| foundation.on.as_ref()) {
            self.kinematics.add_mass(mount.body, &mount.mass, &mut mass);
            let terms = self.kinematics.terms(mount.body);
            weigh(&mut self.gravity, self.scene, terms, &mount.mass[1]);
        }
        let mut whole = mass.clone();
        if !self.rides.is_empty() {
            let rest = DVector::zeros(self.freedoms);
            let sums = (&mut whole, &mut rest.clone());
            self.rides.add(self, (0.0, &rest, &rest), sums, &mut Vec::new());
        }
        let own = self.freedom.iter().flatten().flatten().count();
        if let Some(idle) = first_idle(&whole, own) {
            for (body, numbers) in self.freedom.iter().enumerate() {
                if let Some(k) = numbers.iter().position(|number| *number == Some(idle)) {
                    return Err(Error::NoInertia { body, freedom: Freedom::ALL[k] });
                }
            }
        }
        for wheel in &self.wheels {
            if let (Some(number), Some(inertia)) = (wheel.spin, self.scene.wheels[wheel.kind].spin_inertia) {
                mass[(number, number)] = inertia;
            }
        }
        self.blocks.push(Block::bodies(mass));
        for (range, foundation) in self.structure.iter().zip(self.foundations) {
            if let Some(structure) = &foundation.structure {
                self.blocks.push(Block::structure(range.clone(), structure));
                let mount = foundation.on.as_ref();
                self.ties
                    .extend(mount.and_then(|mount| Tie::new(&self.kinematics, mount, range.clone(), bodies)));
            }
        }
        Ok(())
    }

    /// Probes of structure `s`. A vertical component is positive downwards, hence its weight is negative.
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
                entries.push(Entry { component, weight: -1.0 / normal.count(), wheel, probe, tread: None });
            }
        }
        for (i, &wheel) in self.laterals.iter().enumerate() {
            let contact = self.wheels[wheel].contact;
            if self.scene.contacts[contact].structure == s && self.foundations[s].parts.is_none() {
                let probe = Probe { rail: rail_of(contact, None), x: 0.0, axis: Axis::Lateral };
                entries.push(Entry { component: self.lateral(i), weight: 1.0, wheel, probe, tread: None });
            }
        }
        for component in self.drags().filter(|_| self.foundations[s].is_dragged) {
            let wheels = self.wheels_of(component);
            for &wheel in &wheels {
                let contact = self.wheels[wheel].contact;
                if self.scene.contacts[contact].structure == s {
                    let probe = Probe { rail: rail_of(contact, None), x: 0.0, axis: Axis::Longitudinal };
                    let tread = self.tread_of(&self.treads, component, contact);
                    entries.push(Entry { component, weight: 1.0 / wheels.len() as f64, wheel, probe, tread });
                }
            }
        }
        entries
    }
}

/// The first of `count` freedoms that moves no mass but what those before it move: where the factor L L^T of their mass
/// ends.
fn first_idle(mass: &DMatrix<f64>, count: usize) -> Option<usize> {
    let mut factor = DMatrix::<f64>::zeros(count, count);
    for i in 0..count {
        for j in 0..=i {
            let taken: f64 = (0..j).map(|k| factor[(i, k)] * factor[(j, k)]).sum();
            let left = mass[(i, j)] - taken;
            if j < i {
                factor[(i, j)] = left / factor[(j, j)];
            } else if left > IDLE * mass[(i, i)] && left.is_finite() {
                factor[(i, i)] = left.sqrt();
            } else {
                return Some(i);
            }
        }
    }
    None
}

/// Adds the weight of a mass that moves with a body, given by its line of y and the body's displacements.
fn weigh(gravity: &mut DVector<f64>, scene: &Scene, terms: &[Terms; 6], line: &[f64; 6]) {
    for (mass, terms) in line.iter().zip(terms) {
        for &(number, coefficient) in terms {
            gravity[number] -= scene.gravity * mass * coefficient;
        }
    }
}
