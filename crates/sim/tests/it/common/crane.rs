//! A bridge on two runways with a trolley on it.

use sim::{
    Body, BodyDof, CarriedRail, Carrier, Contact, Damper, Foundation, MotionKind, Profile, Scene,
};

use super::bogie;

/// Masses.
pub const BRIDGE: f64 = 23_300.0;
pub const TROLLEY: f64 = 14_000.0;
/// Half the distances of the bridge's wheels along and across the runway.
pub const BASE: [f64; 2] = [12.0, 40.0];
/// Half the distance of the trolley's rails, half the distance of its wheels along them.
pub const GAUGE: f64 = 6.0;
pub const AXLES: f64 = 5.0;

pub fn body(mass: f64, inertia: [f64; 3], free: &[BodyDof]) -> Body {
    let mut is_free = [false; 6];
    free.iter()
        .for_each(|freedom| is_free[*freedom as usize] = true);
    Body {
        mass,
        inertia,
        cg: [0.0; 3],
        free: is_free,
        start: [0.0; 6],
        start_speed: [0.0; 6],
        motion: None,
        pinned: None,
    }
}

/// Rails of the trolley on body 0: along `along`, where x = 0 the trolley is at `at` of the bridge.
pub fn mount(along: [f64; 3], at: [f64; 3]) -> Carrier {
    // Analytic: z = x cross y for a level x.
    let across = [-along[2], 0.0, along[0]];
    let rail = |side: f64| CarriedRail {
        origin: [0, 1, 2].map(|k| at[k] + side * across[k]),
        along,
    };
    Carrier {
        body: 0,
        rails: vec![rail(-GAUGE), rail(GAUGE)],
        mass: [[0.0; 6]; 6],
        coupling: Vec::new(),
    }
}

/// Rigid girders on body 0.
pub fn carried(along: [f64; 3], at: [f64; 3]) -> Foundation {
    Foundation {
        carrier: Some(mount(along, at)),
        ..Foundation::rigid()
    }
}

/// A bridge on four wheels and a trolley on four, bilateral and undamped.
pub fn crane_of(bridge: Body, trolley: Body, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    scene.wheels[0].normal.stiffness = 1e7;
    scene.wheels[0].normal.damping = 0.0;
    scene.wheels[0].normal.bilateral = true;
    let four = |body: usize, [x, z]: [f64; 2]| {
        [(-x, -z), (x, -z), (-x, z), (x, z)].map(|(x, z)| Contact {
            body,
            structure: body,
            rail: usize::from(z > 0.0),
            at: [x, scene.wheels[0].radius, z],
            offsets: vec![0.0],
            wheel: 0,
        })
    };
    scene.contacts = [four(0, BASE), four(1, [AXLES, GAUGE])].concat();
    scene.bodies = vec![bridge, trolley];
    scene.accuracy = 1e-9;
    scene
}

/// The same with usual inertias.
pub fn crane(bridge: &[BodyDof], trolley: &[BodyDof], end: f64) -> Scene {
    crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], bridge),
        body(TROLLEY, [9e4, 2e5, 2e5], trolley),
        end,
    )
}

pub fn travelling(speed: f64, x0: f64) -> Option<Profile> {
    Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], x0, speed).expect("a valid table"))
}
