//! Bodies in space, ropes and floors.

use sim::{Actuators, Analysis, Body, Rope, RopeEnd, Scene, Schedule, Stop};

pub const G: f64 = 9.80665;

/// A point mass with some of X, Y and Z free.
pub fn body(mass: f64, free: [bool; 3], start: [f64; 3], speed: [f64; 3]) -> Body {
    Body {
        mass,
        inertia: [0.0; 3],
        cg: [0.0; 3],
        free: [free[0], free[1], free[2], false, false, false],
        start: [start[0], start[1], start[2], 0.0, 0.0, 0.0],
        start_speed: [speed[0], speed[1], speed[2], 0.0, 0.0, 0.0],
        motion: None,
        pinned: None,
    }
}

/// A rope of constant length between the origins of two bodies; of space where there is no body.
pub fn rope(stiffness: f64, length: f64, ends: [Option<usize>; 2]) -> Rope {
    let [from, to] = ends.map(|body| RopeEnd { body, at: [0.0; 3] });
    let still = Schedule::new(&[[0.0, 0.0]]).expect("one row");
    Rope {
        from,
        to,
        stiffness,
        damping: 0.0,
        length,
        speed: still,
    }
}

/// A floor below body 0 at the height `place`.
pub fn floor(place: f64, stiffness: f64) -> Stop {
    Stop {
        body: 0,
        against: None,
        at: [0.0; 3],
        axis: 1,
        place,
        side: -1.0,
        stiffness,
        damping: 0.0,
    }
}

/// Bodies without wheels.
pub fn scene(bodies: Vec<Body>, actuators: Actuators, end: f64, accuracy: f64) -> Scene {
    Scene {
        gravity: G,
        bodies,
        wheels: Vec::new(),
        contacts: Vec::new(),
        gauges: Vec::new(),
        actuators,
        analysis: Analysis::Dynamic,
        end,
        output_dt: end / 1000.0,
        output_parts: 1,
        accuracy,
    }
}
