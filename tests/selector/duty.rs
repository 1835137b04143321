//! Random crossings of simply supported girders, the same ones every time: the distribution is that of
//! `docs/verification.md`.

use std::f64::consts::PI;

use formats::spec::Spec;
use formats::text::source::Source;
use foundations::{SolvedModel, solve};
use sim::{
    Actuators, Analysis, Body, BodyDof, Contact, Damper, Load, MotionKind, NormalLaw, Profile, Scene,
    Schedule, Wheel,
};

const GRAVITY: f64 = 32.174;

/// SplitMix64: Steele, Lea and Flood (2014), Fast splittable pseudorandom number generators.
pub struct Dice(pub u64);

impl Dice {
    /// Evenly in [0, 1).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 2.0_f64.powi(53)
    }

    fn even(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Evenly in the logarithm.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn coin(&mut self) -> bool {
        self.share() < 0.5
    }
}

/// What a crane does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Wheels far softer than the girder.
    Soft,
    /// A crawl.
    Slow,
    /// A fast crossing.
    Quick,
    /// A light body on hard wheels that a load strikes.
    Struck,
}

/// One scene, and what carries it.
pub struct Duty {
    pub kind: Kind,
    pub solved: SolvedModel,
    /// Of the girder's modes, by critical.
    pub damping: f64,
    pub tolerance: f64,
    pub scene: Scene,
    /// v / (2 L f_1), mass by m L, sqrt(k / M) / omega_1.
    pub numbers: [f64; 3],
}

/// Scene number `index` of a seed.
pub fn duty(seed: u64, index: u64) -> Duty {
    let mut dice = Dice((seed << 40) + (index << 20));
    let kind = match dice.share() {
        share if share < 0.22 => Kind::Soft,
        share if share < 0.48 => Kind::Slow,
        share if share < 0.67 => Kind::Quick,
        _ => Kind::Struck,
    };
    let span = dice.decades(20.0, 100.0);
    let (inertia, line) = (dice.decades(1.0, 20.0), dice.decades(5.0, 50.0));
    let omega = (PI / span).powi(2) * (4.32e9 * inertia / line).sqrt();
    let tolerance = if dice.coin() { 1e-2 } else { 1e-3 };
    let light = kind == Kind::Struck;
    let mass = if light { dice.decades(0.1, 0.3) } else { dice.decades(0.1, 10.0) };
    // Give of the girder by that of the wheels, near 2 mass frequency^2.
    let give = match kind {
        Kind::Soft => tolerance * dice.decades(0.01, 0.5),
        Kind::Slow => dice.decades(0.02, 1.0),
        Kind::Quick => dice.decades(0.1, 30.0),
        Kind::Struck => 2.0 * mass * dice.decades(80.0, 200.0).powi(2),
    };
    let frequency = (give / (2.0 * mass)).sqrt();
    let alpha = match kind {
        Kind::Soft => dice.decades(0.003, 0.5),
        Kind::Slow => dice.decades(0.003, 0.02),
        Kind::Quick => dice.decades(0.05, 0.5),
        Kind::Struck => dice.decades(0.003, 0.1),
    };
    let damping = if dice.coin() { 0.0 } else { dice.decades(1e-3, 5e-2) };
    let wheel_damping = if dice.coin() { 0.0 } else { dice.even(0.02, 0.2) };
    let two = dice.coin();
    let base = if two { dice.even(0.1, 0.3) } else { 0.0 };

    let speed = alpha * span * omega / PI;
    let (first, last) = match kind {
        // About midspan, for a part of the girder's period.
        Kind::Struck => {
            let start = span * dice.even(0.4, 0.6);
            (start, start + speed * dice.even(0.05, 0.15) * 2.0 * PI / omega)
        }
        _ => (span * base / 2.0, span * (1.0 - base / 2.0)),
    };
    let end = ((last.min(span * (1.0 - base / 2.0))) - first) / speed * (1.0 - 1e-9);
    let weight = mass * line * span * GRAVITY;
    let struck = light || dice.share() < 0.25 && kind != Kind::Slow;
    let mut actuators = Actuators::default();
    if struck {
        let at = end * dice.even(0.1, 0.4);
        // A quarter come on over up to half of the run.
        let ramp = if dice.share() < 0.25 { dice.decades(0.01, 0.5) * end } else { 1e-6 * end };
        let value = Schedule::new(&[[at, 0.0], [at + ramp, -weight * dice.even(0.3, 1.0)]]);
        actuators.loads.push(Load { body: 0, dof: BodyDof::Y, value: value.expect("times increase") });
    }
    let count = if two { 2.0 } else { 1.0 };
    let (body_mass, stiffness) =
        (mass * line * span, mass * line * span * (frequency * omega).powi(2) / count);
    let c = 2.0 * wheel_damping * (stiffness * body_mass / count).sqrt();
    let ends: &[f64] = if two { &[-0.5, 0.5] } else { &[0.0] };
    let scene = Scene {
        gravity: GRAVITY,
        bodies: vec![Body {
            mass: body_mass,
            inertia: [0.0, 0.0, body_mass * (0.5 * span * base).powi(2)],
            cg: [0.0; 3],
            free: [false, true, false, false, false, two],
            start: [first, 0.0, 0.0, 0.0, 0.0, 0.0],
            start_speed: [0.0; 6],
            motion: Some(
                Profile::new(MotionKind::Speed, &[[0.0, speed]], first, 0.0).expect("a valid table"),
            ),
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.0,
            normal: NormalLaw::linear(stiffness, c, Damper::Rail),
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: ends
            .iter()
            .map(|end| Contact {
                body: 0,
                structure: 0,
                rail: 0,
                at: [end * base * span, 0.0, 0.0],
                offsets: vec![0.0],
                wheel: 0,
            })
            .collect(),
        gauges: Vec::new(),
        actuators,
        analysis: Analysis::Dynamic,
        end,
        output_dt: end / 200.0,
        accuracy: 1e-3,
    };
    let solved = girder(span, inertia, line);
    Duty { kind, solved, damping, tolerance, scene, numbers: [alpha, mass, frequency] }
}

fn girder(span: f64, inertia: f64, line: f64) -> SolvedModel {
    let text = format!(
        r#"{{"format": "girderway-beam/1", "name": "girder", "units": {{"length": "ft", "force": "lbf", "time": "s"}},
        "theory": "euler-bernoulli",
        "girder": {{"spans": [{span}], "E": 4.32e9, "I_vertical": {inertia}, "mass_per_length": {line}}},
        "stations": [0, {span}]}}"#
    );
    let spec = Spec::read(&Source { name: "girder.json".to_owned(), text }, None).expect("a girder");
    solve(&spec).expect("it stands")
}
