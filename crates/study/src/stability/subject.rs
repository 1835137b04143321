//! What maps are made for: a straight girder and a wheel on it, of a scene.

use sim::{Damper, Foundation, Given, NormalLaw, Profile};
use splines::{Axis, Compliance, Influence, Probe, Surface};

use formats::scene::{Scene, Structure};
use formats::units::{Dimension, Units};
use foundations::SolvedModel;
use foundations::{SolvedStructure, solution_of};

/// A straight girder and the wheels on it.
pub struct MapSubject<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// Units of all numbers.
    pub units: Units,
    /// Gravity.
    pub gravity: f64,
    /// The structure.
    pub structure: &'a Structure,
    /// What is known of it.
    pub solved: &'a SolvedModel,
    /// Its exact surface.
    pub surface: &'a Surface,
    /// The girder.
    pub girder: &'a fea::Girder,
    /// First and last support of its longest span.
    pub span: [f64; 2],
    /// Weight that each wheel carries.
    pub load: f64,
    /// Stiffness and damper of a wheel.
    pub stiffness: f64,
    /// Damper of a wheel.
    pub damping: f64,
    /// Wheels of one truck, by their offsets from their mean.
    pub offsets: Vec<f64>,
}

impl<'a> MapSubject<'a> {
    /// The first straight girder of `scene` under a truck.
    ///
    /// # Errors
    /// What the scene lacks, in words.
    pub fn of(scene: &'a Scene, known: &'a [SolvedStructure]) -> Result<MapSubject<'a>, String> {
        let find = |truck: &'a formats::scene::Truck| {
            let structure = &scene.structures[scene.rails[truck.rail].structure];
            let solved = solution_of(known, &structure.origin)?;
            Some((truck, structure, solved, solved.girder.as_ref()?, solved.surface.as_ref()?))
        };
        let found = scene.trucks.iter().find_map(find);
        let (truck, structure, solved, girder, surface) =
            found.ok_or("stability maps need a truck on a straight girder, the short form of a beam spec")?;
        let wheels: usize = scene
            .trucks
            .iter()
            .filter(|own| own.body == truck.body)
            .map(|own| own.wheel_offsets().len())
            .sum();
        let mut offsets = truck.wheel_offsets();
        let mean = offsets.iter().sum::<f64>() / offsets.len().max(1) as f64;
        offsets.iter_mut().for_each(|own| *own -= mean);
        offsets.sort_by(f64::total_cmp);
        let law = &scene.wheels[truck.wheel].vertical;
        let mut span = [0.0, 0.0];
        let mut at = 0.0;
        for length in &girder.spans {
            if *length > span[1] - span[0] {
                span = [at, at + length];
            }
            at += length;
        }
        Ok(MapSubject {
            name: &scene.name,
            units: scene.units,
            gravity: scene.gravity,
            structure,
            solved,
            surface,
            girder,
            span,
            load: scene.bodies[truck.body].mass * scene.gravity / wheels.max(1) as f64,
            stiffness: law.k,
            damping: law.c,
            offsets,
        })
    }

    /// Length of the span.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    /// Mass that a wheel carries.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.load / self.gravity
    }

    /// Unit of `dimension`.
    #[must_use]
    pub fn unit(&self, dimension: Dimension) -> String {
        self.units.label(dimension)
    }

    /// Downward give at the places of `at` under unit loads down there, by `compliance`.
    #[must_use]
    pub fn give(&self, compliance: &dyn Compliance, at: &[f64]) -> Option<nalgebra::DMatrix<f64>> {
        let probes: Vec<Probe> = at.iter().map(|&x| Probe { rail: 0, x, axis: Axis::Vertical }).collect();
        let mut out = Influence::zeros(at.len());
        compliance.fill(&probes, &mut out).ok()?;
        Some(out.value)
    }

    /// Give at x under a unit load there.
    #[must_use]
    pub fn at(&self, x: f64) -> f64 {
        self.give(self.surface, &[x]).map_or(f64::NAN, |give| give[(0, 0)])
    }

    /// The girder without mass, exactly.
    #[must_use]
    pub fn foundation(&self) -> Foundation {
        Foundation::influence(Box::new(self.surface.clone()), 1)
    }

    /// A scene of one body of `mass` on wheels at `offsets`, from `x0` at `speed` until `end`.
    ///
    /// # Errors
    /// A motion that is none.
    pub fn crossing(
        &self,
        mass: f64,
        offsets: &[f64],
        law: NormalLaw,
        [x0, speed, end]: [f64; 3],
    ) -> Result<sim::Scene, sim::Error> {
        crossing(self.gravity, mass, offsets, law, [x0, speed, end])
    }

    /// A linear wheel that holds on to the rail, with its damper to the ground.
    #[must_use]
    pub fn linear(&self, stiffness: f64, damping: f64) -> NormalLaw {
        NormalLaw { bilateral: true, ..NormalLaw::linear(stiffness, damping, Damper::Ground) }
    }
}

/// A scene of one body of `mass` under `gravity` on wheels at `offsets`, from `x0` at `speed` until `end`.
///
/// # Errors
/// A motion that is none.
pub(super) fn crossing(
    gravity: f64,
    mass: f64,
    offsets: &[f64],
    law: NormalLaw,
    [x0, speed, end]: [f64; 3],
) -> Result<sim::Scene, sim::Error> {
    let contact = |offset: &f64| sim::Contact {
        body: 0,
        structure: 0,
        rail: 0,
        at: [0.0; 3],
        offsets: vec![*offset],
        wheel: 0,
    };
    let body = sim::Body {
        mass,
        inertia: [0.0; 3],
        cg: [0.0; 3],
        free: [false, true, false, false, false, false],
        start: [x0, 0.0, 0.0, 0.0, 0.0, 0.0],
        start_speed: [0.0; 6],
        motion: Some(Profile::new(Given::Speed, &[[0.0, speed]], x0, speed)?),
        pinned: None,
    };
    Ok(sim::Scene {
        gravity,
        bodies: vec![body],
        wheels: vec![sim::Wheel {
            radius: 1.0,
            normal: law,
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: offsets.iter().map(contact).collect(),
        gauges: Vec::new(),
        actuators: sim::Actuators::default(),
        analysis: sim::Analysis::Dynamic,
        end,
        output_dt: end,
        accuracy: 1e-6,
    })
}
