//! Wheel forces on a girder that is flexible in shear, with a damper between wheel and rail, which feels the slope of the
//! rail: full meshes against the modes of the Timoshenko beam in closed form.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use sim::{
    Channel, Damper, Dynamics, Extent, Foundation, MotionKind, NormalLaw, Profile, Scene, Shapes,
    Structure,
};
use splines::{Axis, Compliance, Error, Influence, Probe};

use super::crossings::foundation;
use crate::common::{EI, SPAN, bogie, give};

const MASS: f64 = 15.2;
/// Shear stiffness G As, force, and square of the radius of gyration.
const SHEAR: f64 = 1.66e9 * 0.1;
const GYRATION: f64 = 9.528;
/// Harmonics of the reference, two modes each: with 60 the forces differ by 1e-6 of the weight.
const HARMONICS: usize = 240;

const SPEC: &str = r#"{"format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
    "girder": {"spans": [60], "E": 4.32e9, "G": 1.66e9, "A": 1, "I_vertical": 9.528, "kA_vertical": 0.1,
    "mass_per_length": 15.2}, "stations": [0, 60]}"#;

/// Natural modes w = a sin(k x), rotation b cos(k x) of the beam on two supports: wavenumber k, frequency omega, a.
///
/// (G As k^2 - m omega^2) a = G As k b,    (EI k^2 + G As - m r^2 omega^2) b = G As k a
///
/// Source: Timoshenko, Vibration Problems in Engineering (1955), section 55.
fn closed_form() -> Vec<[f64; 3]> {
    let of_harmonic = |n: usize| {
        let k = n as f64 * PI / SPAN;
        let [p, q, c] = [SHEAR * k * k, EI * k * k + SHEAR, SHEAR * k];
        let (m, j) = (MASS, MASS * GYRATION);
        let half = 0.5 * (p / m + q / j);
        let product = (p * q - c * c) / (m * j);
        let upper = half + (half * half - product).sqrt();
        [product / upper, upper].map(|square| {
            let ratio = (p - m * square) / c;
            [
                k,
                square.sqrt(),
                (2.0 / (SPAN * (m + j * ratio * ratio))).sqrt(),
            ]
        })
    };
    (1..=HARMONICS).flat_map(of_harmonic).collect()
}

struct Sines(Vec<[f64; 3]>);

impl Shapes for Sines {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        for ([k, _, a], (value, slope)) in self.0.iter().zip(value.iter_mut().zip(slope)) {
            (*value, *slope) = (a * (k * at.x).sin(), a * k * (k * at.x).cos());
        }
        Ok(())
    }
}

/// Static compliance of the beam without the part of the modes.
struct Rest(Vec<[f64; 3]>);

impl Compliance for Rest {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let (mut value, mut slope) = give(p.x, q.x);
                let [low, high] = [p.x.min(q.x), p.x.max(q.x)];
                value += low * (SPAN - high) / (SPAN * SHEAR);
                // At the load itself the slope is the mean of both sides.
                let side = if p.x < q.x {
                    1.0
                } else if p.x > q.x {
                    0.0
                } else {
                    0.5
                };
                slope += (side - q.x / SPAN) / SHEAR;
                for [k, omega, a] in &self.0 {
                    let other = a * a * (k * q.x).sin() / (omega * omega);
                    value -= (k * p.x).sin() * other;
                    slope -= k * (k * p.x).cos() * other;
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

fn reference() -> Foundation {
    let modes = closed_form();
    let omega: Vec<f64> = modes.iter().map(|mode| mode[1]).collect();
    Foundation {
        compliance: Some(Box::new(Rest(modes.clone()))),
        structure: Some(Structure {
            dynamics: Dynamics::Modes {
                ratio: vec![0.0; omega.len()],
                omega,
            },
            shapes: Box::new(Sines(modes)),
        }),
        rails: vec![Extent {
            range: Some([0.0, SPAN]),
            breaks: vec![0.0, SPAN],
        }],
        ..Foundation::default()
    }
}

/// A mass on a spring and a damper whose crossing takes about fourteen periods of the beam.
fn crossing() -> Scene {
    let mut scene = bogie(100.0, 0.45, Damper::Rail);
    // From rest, so that no shock sets out along the beam.
    let speed = [[0.0, 0.0], [0.1, 100.0]];
    scene.bodies[0].motion =
        Some(Profile::new(MotionKind::Speed, &speed, 0.0, 10.0).expect("a valid table"));
    scene.bodies[0].mass = 100.0;
    scene.bodies[0].inertia = [0.0; 3];
    scene.bodies[0].free[5] = false;
    scene.wheels[0].normal = NormalLaw {
        bilateral: true,
        ..NormalLaw::linear(2e6, 2e4, Damper::Rail)
    };
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene.gauges.clear();
    scene.output_dt = scene.end / 2000.0;
    scene.accuracy = 1e-8;
    scene
}

fn wheel_force(foundation: Foundation) -> Vec<f64> {
    let run = sim::run(&crossing(), &[foundation], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert!(run.status.is_complete());
    run.history.column(Channel::Vertical(0))
}

/// The meshes use the modes that they resolve, after a step of inverse iteration that makes their slopes continuous. What
/// is left is the part of the modes beyond: the dynamic part of a mode in the deflection under the wheel falls with the
/// square of its number, and the sum of what is left out with the length of the elements.
#[test]
fn wheel_forces_on_a_sheared_girder_converge_with_the_mesh() {
    let wanted = wheel_force(reference());
    let weight = 100.0 * 32.174;
    let errors = [4, 8, 16, 32].map(|elements| {
        let found = wheel_force(foundation(SPEC, Some(elements)));
        let pairs = found.iter().zip(&wanted);
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / weight
    });
    println!("errors by the weight: {errors:?}");
    let orders = [0, 1, 2].map(|k| (errors[k] / errors[k + 1]).log2());
    assert!(
        errors[0] < 1e-4 && orders.iter().all(|order| *order > 0.9),
        "{errors:?}, orders {orders:?}"
    );
}

/// Values and slopes, also on a node; and what the modes leave is positive semi-definite.
#[test]
fn static_compliance_of_the_mesh_is_that_of_the_beam() {
    // In elements, and on the node at midspan.
    let probes = [7.0, 15.0, 30.0, 31.0, 52.0].map(|x| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    });
    let total = |foundation: &Foundation| {
        let mut out = Influence::zeros(probes.len());
        let compliance = foundation
            .compliance
            .as_ref()
            .expect("residual flexibility");
        compliance.fill(&probes, &mut out).expect("on the rail");
        let structure = foundation.structure.as_ref().expect("modes");
        let Dynamics::Modes { omega, .. } = &structure.dynamics else {
            panic!("modes")
        };
        let rows = probes.map(|probe| {
            let (mut value, mut slope) = (vec![0.0; omega.len()], vec![0.0; omega.len()]);
            structure
                .shapes
                .row(probe, &mut value, &mut slope)
                .expect("on the rail");
            [value, slope]
        });
        for i in 0..probes.len() {
            for j in 0..probes.len() {
                let sum = |k: usize| -> f64 {
                    let modes = omega.iter().zip(&rows[i][k]).zip(&rows[j][0]);
                    modes.map(|((omega, a), b)| a * b / (omega * omega)).sum()
                };
                out.value[(i, j)] += sum(0);
                out.slope[(i, j)] += sum(1);
            }
        }
        [out.value, out.slope]
    };
    let residual_of = |foundation: &Foundation| {
        let places: Vec<Probe> = (1..60)
            .map(|x| Probe {
                rail: 0,
                x: f64::from(x),
                axis: Axis::Vertical,
            })
            .collect();
        let mut out = Influence::zeros(places.len());
        foundation
            .compliance
            .as_ref()
            .expect("given")
            .fill(&places, &mut out)
            .expect("on the rail");
        out.value.symmetric_eigenvalues().min()
    };
    let exact = total(&reference());
    let mesh = foundation(SPEC, Some(6));
    for (found, exact) in total(&mesh).iter().zip(&exact) {
        let error = (found - exact).amax() / exact.amax();
        assert!(error < 1e-9, "{error:e}");
    }
    assert!(
        residual_of(&mesh) > -1e-12 * exact[0].amax(),
        "the residual flexibility is not negative"
    );
}
