//! A simply supported beam in its natural modes, in closed form.

use std::f64::consts::PI;

use sim::{
    Analysis, Body, Damper, Dynamics, Extent, Foundation, Gauge, MotionKind, NormalLaw, Profile,
    Scene, Shapes, Structure, Wheel,
};
use splines::{Axis, Compliance, Error, Influence, Probe};

use super::{EI, SPAN, give, single};

/// Mass per length, slug/ft.
pub const MASS: f64 = 15.2;

/// omega_r = (r pi / L)^2 sqrt(EI / m).
pub fn omega(r: usize) -> f64 {
    let wave = r as f64 * PI / SPAN;
    wave * wave * (EI / MASS).sqrt()
}

/// phi_r = sqrt(2 / m L) sin(r pi x / L), of modal mass 1, and its slope.
fn shape(r: usize, x: f64) -> (f64, f64) {
    let wave = r as f64 * PI / SPAN;
    let size = (2.0 / (MASS * SPAN)).sqrt();
    (size * (wave * x).sin(), size * wave * (wave * x).cos())
}

struct Sines;

impl Shapes for Sines {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        for (k, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            (*value, *slope) = shape(k + 1, at.x);
        }
        Ok(())
    }
}

/// What `modes` sines leave of the static give.
struct Rest {
    modes: usize,
}

impl Compliance for Rest {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let (mut value, mut slope) = give(p.x, q.x);
                for r in 1..=self.modes {
                    let ((a, da), (b, _)) = (shape(r, p.x), shape(r, q.x));
                    value -= a * b / omega(r).powi(2);
                    slope -= da * b / omega(r).powi(2);
                }
                (out.value[(i, j)], out.slope[(i, j)]) = (value, slope);
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        vec![0.0, SPAN]
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        Some([0.0, SPAN])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// The beam in `modes` undamped modes, with or without the static give of the others.
pub fn beam(modes: usize, with_rest: bool) -> Foundation {
    let omega: Vec<f64> = (1..=modes).map(omega).collect();
    Foundation {
        compliance: with_rest.then(|| Box::new(Rest { modes }) as Box<dyn Compliance>),
        structure: (modes > 0).then(|| Structure {
            dynamics: Dynamics::Modes {
                ratio: vec![0.0; omega.len()],
                omega,
            },
            shapes: Box::new(Sines),
        }),
        rails: vec![Extent {
            range: Some([0.0, SPAN]),
            breaks: vec![0.0, SPAN],
        }],
        ..Foundation::default()
    }
}

/// A mass on a spring that crosses the beam: `mass` by m L, `frequency` of mass and spring by omega_1, `alpha` =
/// v / (2 L f_1). A gauge stands at midspan.
pub fn oscillator(mass: f64, frequency: f64, alpha: f64) -> Scene {
    let speed = alpha * SPAN * omega(1) / PI;
    let mass = mass * MASS * SPAN;
    let stiffness = mass * (frequency * omega(1)).powi(2);
    Scene {
        gravity: 32.174,
        bodies: vec![Body {
            mass,
            inertia: [0.0; 3],
            cg: [0.0; 3],
            free: [false, true, false, false, false, false],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: Some(
                Profile::new(MotionKind::Speed, &[[0.0, speed]], 0.0, 0.0).expect("a valid table"),
            ),
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.0,
            normal: NormalLaw {
                bilateral: true,
                ..NormalLaw::linear(stiffness, 0.0, Damper::Rail)
            },
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: vec![single()],
        gauges: vec![Gauge {
            structure: 0,
            probe: Probe {
                rail: 0,
                x: SPAN / 2.0,
                axis: Axis::Vertical,
            },
        }],
        actuators: sim::Actuators::default(),
        analysis: Analysis::Dynamic,
        end: SPAN / speed,
        output_dt: SPAN / speed / 2000.0,
        output_parts: 1,
        accuracy: 1e-8,
    }
}
