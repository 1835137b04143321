//! The subject of stability maps: the first straight girder of a scene, and the wheels of a truck on it.

use sim::{Damper, Foundation, MotionKind, NormalLaw, Profile};
use splines::{Axis, Compliance, ExactSurface, Influence, Probe};

use formats::scene::{Scene, Structure};
use formats::units::{Dimension, Units};
use foundations::SolvedModel;
use foundations::{SolvedStructure, solution_of};

/// A straight girder and the wheels on it, in the units of the scene.
pub struct MapSubject<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// Units of all numbers.
    pub units: Units,
    /// Acceleration of gravity.
    pub gravity: f64,
    /// The structure.
    pub structure: &'a Structure,
    /// Its solution: model, grid, surface.
    pub solved: &'a SolvedModel,
    /// Its exact surface.
    pub surface: &'a ExactSurface,
    /// The girder.
    pub girder: &'a fea::Girder,
    /// Coordinates of the supports of its longest span.
    pub span: [f64; 2],
    /// Weight that each wheel carries.
    pub load: f64,
    /// Stiffness of a wheel.
    pub stiffness: f64,
    /// Damper of a wheel.
    pub damping: f64,
    /// Offsets of the wheels of one truck from their mean, ascending.
    pub offsets: Vec<f64>,
}

impl<'a> MapSubject<'a> {
    /// The first straight girder of `scene` under a truck.
    ///
    /// # Errors
    /// What is missing in the scene, in words.
    pub fn of(scene: &'a Scene, known: &'a [SolvedStructure]) -> Result<MapSubject<'a>, String> {
        let find = |truck: &'a formats::scene::Truck| {
            let structure = &scene.structures[scene.rails[truck.rail].structure];
            let solved = solution_of(known, &structure.origin)?;
            Some((
                truck,
                structure,
                solved,
                solved.girder.as_ref()?,
                solved.surface.as_ref()?,
            ))
        };
        let first = scene.trucks.iter().find_map(find);
        let (truck, structure, solved, girder, surface) = first.ok_or(
            "stability maps need a truck on a straight girder, the short form of a beam spec",
        )?;
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

    /// Length of the longest span.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    /// Mass that a wheel carries: load by gravity.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.load / self.gravity
    }

    /// Label of the unit of `dimension`.
    #[must_use]
    pub fn unit(&self, dimension: Dimension) -> String {
        self.units.label(dimension)
    }

    /// Vertical compliance matrix for the places `at` along the rail, n x n: entry (i, j) is the deflection at place
    /// i under a unit load at place j, both downward. `None` where `compliance` has no answer at a place.
    #[must_use]
    pub fn compliance(
        &self,
        compliance: &dyn Compliance,
        at: &[f64],
    ) -> Option<nalgebra::DMatrix<f64>> {
        let probes: Vec<Probe> = at
            .iter()
            .map(|&x| Probe {
                rail: 0,
                x,
                axis: Axis::Vertical,
            })
            .collect();
        let mut out = Influence::zeros(at.len());
        compliance.fill(&probes, &mut out).ok()?;
        Some(out.value)
    }

    /// Deflection at x under a unit load there, both downward; not a number beyond the rail.
    #[must_use]
    pub fn flexibility(&self, x: f64) -> f64 {
        self.compliance(self.surface, &[x])
            .map_or(f64::NAN, |matrix| matrix[(0, 0)])
    }

    /// The exact influence surface of the girder as a foundation without mass.
    #[must_use]
    pub fn foundation(&self) -> Foundation {
        Foundation::massless(Box::new(self.surface.clone()), 1)
    }

    /// A scene of one body of `mass` on wheels at `offsets` that starts at `x0`, moves at constant `speed` and ends
    /// at the time `end`.
    ///
    /// # Errors
    /// A speed or a place that is not finite.
    pub fn crossing(
        &self,
        mass: f64,
        offsets: &[f64],
        law: NormalLaw,
        [x0, speed, end]: [f64; 3],
    ) -> Result<sim::Scene, sim::Error> {
        crossing(self.gravity, mass, offsets, law, [x0, speed, end])
    }

    /// The law of a linear wheel whose contact can pull, with its damper to the ground.
    #[must_use]
    pub fn linear(&self, stiffness: f64, damping: f64) -> NormalLaw {
        NormalLaw {
            bilateral: true,
            ..NormalLaw::linear(stiffness, damping, Damper::Ground)
        }
    }
}

/// As [`MapSubject::crossing`], under any `gravity`.
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
        motion: Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], x0, speed)?),
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
        output_parts: 1,
        accuracy: 1e-6,
    })
}
