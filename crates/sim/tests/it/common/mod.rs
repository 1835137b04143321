//! The paper's girder in closed form, and its bogie.

#![allow(dead_code)]

pub mod crane;
pub mod dormand;
pub mod hinged;
pub mod kutta;
pub mod modes;
#[path = "../../../../../tests/near.rs"]
pub mod near;
pub mod parts;
pub mod random;
pub mod space;

use std::sync::Arc;

use nalgebra::DMatrix;
use serde_json::Value;
use sim::{
    Analysis, Body, Contact, Damper, Foundation, MotionKind, NormalLaw, Profile, Scene, Wheel,
};
use splines::{
    Axis, Compliance, Error, ExactSurface, Flexibility, Influence, Probe, RailElement, Rails,
};

/// Span, ft, and bending stiffness, lb ft^2, of the paper's girder.
pub const SPAN: f64 = 60.0;
pub const EI: f64 = 9.528 * 4.32e9;
/// Weight of the bogie, lb; gravity, ft/s^2.
pub const WEIGHT: f64 = 4.8e6;
pub const GRAVITY: f64 = 32.174;

/// Simply supported beam with overhangs, closed form: analytic, independent of the splines crate.
pub struct ClosedForm;

/// Downward deflection at x for a unit downward load at z, and its slope.
///
/// # Source
/// Macaulay's method: EI w''' = jumps at the supports 0 and L and the load.
pub fn give(x: f64, z: f64) -> (f64, f64) {
    let cube = |a: f64| {
        if a > 0.0 {
            (a * a * a, 3.0 * a * a)
        } else {
            (0.0, 0.0)
        }
    };
    // Reactions up at 0 and L balance the load down at z.
    let (r0, rl) = ((SPAN - z) / SPAN, z / SPAN);
    let shape = |x: f64| {
        let ((c0, d0), (cl, dl), (cz, dz)) = (cube(x), cube(x - SPAN), cube(x - z));
        (
            (cz - r0 * c0 - rl * cl) / (6.0 * EI),
            (dz - r0 * d0 - rl * dl) / (6.0 * EI),
        )
    };
    let (at0, atl) = (shape(0.0).0, shape(SPAN).0);
    let (w, slope) = shape(x);
    let tilt = (atl - at0) / SPAN;
    (w - at0 - tilt * x, slope - tilt)
}

impl Compliance for ClosedForm {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let vertical = p.axis == Axis::Vertical && q.axis == Axis::Vertical;
                let (value, slope) = if vertical { give(p.x, q.x) } else { (0.0, 0.0) };
                out.value[(i, j)] = value;
                out.slope[(i, j)] = slope;
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        vec![0.0, SPAN]
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        Some([-15.0, 75.0])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

pub fn girder() -> Foundation {
    Foundation::massless(Box::new(ClosedForm), 1)
}

/// One wheel of kind 0 under the origin of body 0, on the first rail of structure 0.
pub fn single() -> Contact {
    Contact {
        body: 0,
        structure: 0,
        rail: 0,
        at: [0.0; 3],
        offsets: vec![0.0],
        wheel: 0,
    }
}

/// The paper's two-wheel bogie at constant `speed`.
pub fn bogie(speed: f64, end: f64, damper: Damper) -> Scene {
    let mass = WEIGHT / GRAVITY;
    Scene {
        gravity: GRAVITY,
        bodies: vec![Body {
            mass,
            inertia: [0.0, 0.0, mass * 1.5 * 1.5],
            cg: [0.0; 3],
            free: [false, true, false, false, false, true],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: Some(
                Profile::new(MotionKind::Speed, &[[0.0, speed]], 0.0, 0.0).expect("a valid table"),
            ),
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.25,
            normal: NormalLaw::linear(1e8, 1e5, damper),
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: [-4.0 / 3.0, 4.0 / 3.0]
            .map(|offset| Contact {
                body: 0,
                structure: 0,
                rail: 0,
                at: [0.0; 3],
                offsets: vec![offset],
                wheel: 0,
            })
            .to_vec(),
        gauges: Vec::new(),
        actuators: sim::Actuators::default(),
        analysis: Analysis::Dynamic,
        end,
        output_dt: 0.01 * end,
        output_parts: 1,
        accuracy: 1e-6,
    }
}

/// Columns time, z, pitch and both wheel forces of a reference.
///
/// External: scipy DOP853 at rtol 1e-12 on a closed-form influence function, `fea/bogie_reference.py`.
pub fn reference(text: &str) -> Vec<[f64; 5]> {
    let json: Value = serde_json::from_str(text).expect("the file is JSON");
    let column = |name: &str| -> Vec<f64> {
        json[name]
            .as_array()
            .expect("an array")
            .iter()
            .map(|v| v.as_f64().expect("a number"))
            .collect()
    };
    let (t, z, pitch, f1, f2) = (
        column("time"),
        column("z"),
        column("pitch"),
        column("F1"),
        column("F2"),
    );
    (0..t.len())
        .map(|i| [t[i], z[i], pitch[i], f1[i], f2[i]])
        .collect()
}

/// Stations of the exact surface.
const STATIONS: [f64; 4] = [-15.0, 0.0, SPAN, 75.0];

/// The girder as an exact surface: compliance of the states from the closed form [`give`] and its derivatives.
pub fn surface() -> ExactSurface {
    let mut nodal = DMatrix::zeros(24, 24);
    for (i, &x) in STATIONS.iter().enumerate() {
        for (j, &z) in STATIONS.iter().enumerate() {
            nodal[(6 * i + 1, 6 * j + 1)] = give(x, z).0;
            nodal[(6 * i + 5, 6 * j + 1)] = give(x, z).1;
            nodal[(6 * i + 1, 6 * j + 5)] = give(z, x).1;
            nodal[(6 * i + 5, 6 * j + 5)] = turn(x, z);
        }
    }
    let flexibility = Flexibility {
        bending_z: 1.0 / EI,
        ..Flexibility::default()
    };
    let cells = STATIONS.windows(2).enumerate().map(|(k, x)| RailElement {
        rail: 0,
        x: [x[0], x[1]],
        ends: [k, k + 1],
        length: x[1] - x[0],
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        flexibility,
        member: None,
    });
    ExactSurface::new(
        Arc::new(Rails::new(cells.collect()).expect("valid cells")),
        nodal,
    )
    .expect("the shape fits")
}

/// Rotation at x for a unit moment at z: the derivative of [`give`]'s slope by z.
fn turn(x: f64, z: f64) -> f64 {
    let (square, beyond) = (|a: f64| a.max(0.0).powi(2), |a: f64| a.max(0.0));
    // d/dz of w and w' with reactions (L - z)/L and z/L.
    let shape = |x: f64| {
        let cubes = (beyond(x).powi(3) - beyond(x - SPAN).powi(3)) / SPAN;
        let squares = 3.0 * (square(x) - square(x - SPAN)) / SPAN;
        (
            (cubes - 3.0 * square(x - z)) / (6.0 * EI),
            (squares - 6.0 * beyond(x - z)) / (6.0 * EI),
        )
    };
    shape(x).1 - (shape(SPAN).0 - shape(0.0).0) / SPAN
}
