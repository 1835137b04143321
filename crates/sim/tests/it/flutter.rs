//! Bogies that shake themselves on tables that are not symmetric: eigenvalues at rest, runs, and trains that do not.

use crate::common;
use crate::printed;

use std::ops::ControlFlow;

use common::near::{assert_at_most, assert_near};
use common::random::Random;
use common::{GRAVITY, WEIGHT, bogie, surface};
use nalgebra::{DMatrix, Matrix2, Matrix4};
use sim::{BodyDof, Channel, Damper, Foundation, MotionKind, Profile, Run};
use splines::{Axis, Compliance, Influence, InfluenceBlock, Probe, ReadingMethod, TableReading};

const K: f64 = 1e8;

/// Place of its middle, half of its base, distance of its centre of mass from the middle, radius of gyration, ft.
type Bogie = [f64; 4];

const PUBLISHED: Bogie = [43.5, 4.0 / 3.0, 0.69, 4.95];

fn akispl() -> TableReading {
    let way = (0, Axis::Vertical);
    let sheet = InfluenceBlock {
        deflection: way,
        load: way,
        table: printed::table(&printed::VERTICAL),
    };
    TableReading::new(ReadingMethod::Akispl, &[sheet]).expect("a table")
}

fn block(of: &dyn Compliance, at: &[f64]) -> DMatrix<f64> {
    let probes: Vec<Probe> = at
        .iter()
        .map(|&x| Probe {
            rail: 0,
            x,
            axis: Axis::Vertical,
        })
        .collect();
    let mut out = Influence::zeros(at.len());
    of.fill(&probes, &mut out).expect("on the table");
    out.value
}

/// Growth, 1/s, and frequency, radian/s, of the worst eigenvalue of M q'' + C q' + B^T (G + I/k)^-1 B q = 0, dampers
/// of the wheels to the ground.
fn worst(of: &dyn Compliance, [x, half, offset, gyration]: Bogie, damping: f64) -> [f64; 2] {
    let give = block(of, &[x - half, x + half]);
    let contact = Matrix2::new(
        give[(0, 0)] + 1.0 / K,
        give[(0, 1)],
        give[(1, 0)],
        give[(1, 1)] + 1.0 / K,
    );
    let stiffness = contact.try_inverse().expect("wheels give");
    let arms = Matrix2::new(1.0, -half - offset, 1.0, half - offset);
    let mass = [WEIGHT / GRAVITY, WEIGHT / GRAVITY * gyration * gyration];
    let (spring, damper) = (
        arms.transpose() * stiffness * arms,
        arms.transpose() * arms * damping,
    );
    let mut system = Matrix4::zeros();
    for i in 0..2 {
        system[(i, i + 2)] = 1.0;
        for j in 0..2 {
            system[(i + 2, j)] = -spring[(i, j)] / mass[i];
            system[(i + 2, j + 2)] = -damper[(i, j)] / mass[i];
        }
    }
    let all = system.complex_eigenvalues();
    let found = all
        .iter()
        .max_by(|a, b| a.re.total_cmp(&b.re))
        .expect("four eigenvalues");
    [found.re, found.im.abs()]
}

/// The same bogie let go beside its rest for `end` seconds; it holds on to the rail.
fn run(foundation: Foundation, [x, half, offset, gyration]: Bogie, end: f64) -> Run {
    let mut scene = bogie(0.0, end, Damper::Ground);
    (
        scene.wheels[0].normal.damping,
        scene.wheels[0].normal.bilateral,
    ) = (0.0, true);
    for (contact, at) in scene.contacts.iter_mut().zip([-half, half]) {
        contact.offsets = vec![at];
    }
    let body = &mut scene.bodies[0];
    // the origin is the middle; its centre of mass lies ahead
    body.cg = [offset, 0.0, 0.0];
    body.inertia = [0.0, 0.0, WEIGHT / GRAVITY * gyration * gyration];
    body.start[0] = x;
    body.start_speed[1] = 1e-3;
    body.motion =
        Some(Profile::new(MotionKind::Speed, &[[0.0, 0.0]], x, 0.0).expect("a valid table"));
    (scene.accuracy, scene.output_dt) = (1e-8, 0.002);
    sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("it stands")
}

/// Growth of the pitching between two thirds of a run's ends, by the largest speeds there.
fn grown(run: &Run, omega: f64) -> f64 {
    let [t, v] = [Channel::Time, Channel::Speed(0, BodyDof::Pitch)]
        .map(|channel| run.history.column(channel));
    let end = t[t.len() - 1];
    let wave = 2.0 * std::f64::consts::PI / omega;
    let largest = |from: f64| {
        let inside = (0..t.len()).filter(|&i| (from..from + wave).contains(&t[i]));
        let peak = inside
            .max_by(|&i, &j| v[i].abs().total_cmp(&v[j].abs()))
            .expect("samples");
        (t[peak], v[peak].abs())
    };
    let (a, b) = (largest(0.4 * end), largest(end - 1.5 * wave));
    (b.1 / a.1).ln() / (b.0 - a.0)
}

#[test]
fn akispl_shakes_an_uneven_bogie_and_the_exact_surface_does_not() {
    let table = akispl();
    let [growth, omega] = worst(&table, PUBLISHED, 0.0);
    assert_near(
        "AKISPL, bogie at 43.5 ft, centre of mass 0.69 ft ahead, gyration 4.95 ft: growth, 1/s",
        "prototype",
        0.325,
        growth,
        0.01,
    );
    assert_near(
        "the same by its frequency: negative damping",
        "prototype",
        0.0335,
        growth / omega.hypot(growth),
        0.01,
    );
    assert_near(
        "time in which it doubles, s",
        "prototype",
        2.1,
        2.0_f64.ln() / growth,
        0.02,
    );
    let stops = |damping: f64| worst(&table, PUBLISHED, damping)[0] <= 1e-12;
    let (mut low, mut high) = (0.0, 1e6);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stops(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    assert_near(
        "damper of each wheel to the ground that stops it, lb s/ft",
        "prototype",
        1.8e5,
        high,
        0.06,
    );
    // a run against its eigenvalue: 0.4251 and 0.4254 for a bogie of 10 ft base
    let own = run(Foundation::massless(Box::new(akispl()), 1), PUBLISHED, 14.0);
    assert_near(
        "growth seen in a run by that of the eigenvalue (bogie of 10 ft base there)",
        "prototype",
        0.4251 / 0.4254,
        grown(&own, omega) / growth,
        1e-2,
    );
    let exact = worst(&surface(), PUBLISHED, 0.0)[0];
    assert_at_most("exact surface: growth, 1/s", "symmetry", 1e-10, exact);
    let still = run(
        Foundation::massless(Box::new(surface()), 1),
        PUBLISHED,
        14.0,
    );
    assert_at_most(
        "exact surface: growth seen in a run, 1/s",
        "symmetry",
        1e-3,
        grown(&still, omega),
    );
}

/// Trains of 2 to 6 equal masses, each on its wheel: eigenvalues of (G + I/k)^-1 that are not real and positive. Bogies
/// whose centre of mass is in the middle.
#[test]
fn even_bogies_and_trains_of_equal_wheels_do_not_shake() {
    let table = akispl();
    let mut random = Random(7);
    let (mut found, mut tried) = (0, 0);
    for _ in 0..20_000 {
        let n = random.between(2.0, 6.999) as usize;
        let at: Vec<f64> = (0..n).map(|_| random.between(0.0, 60.0)).collect();
        let give = block(&table, &at);
        let contact = give * K + DMatrix::identity(n, n);
        let Some(schur) = nalgebra::Schur::try_new(contact, 1e-14, 1000) else {
            continue;
        };
        let all = schur.complex_eigenvalues();
        tried += 1;
        found += usize::from(
            all.iter()
                .any(|own| own.im.abs() > 1e-6 * own.norm() || own.re <= 0.0),
        );
    }
    assert!(tried > 19_900, "{tried}");
    assert_at_most(
        "AKISPL: trains of equal masses on their wheels, of 20,000, that shake or fall",
        "prototype",
        0.0,
        found as f64,
    );
    let mut largest = 0.0_f64;
    for _ in 0..20_000 {
        let half = random.between(1.0, 8.0);
        let own = [
            random.between(half, 60.0 - half),
            half,
            0.0,
            random.between(0.3, 3.0) * half,
        ];
        let [growth, omega] = worst(&table, own, 0.0);
        largest = largest.max(growth / omega.hypot(growth));
    }
    assert_at_most(
        "AKISPL: largest growth of 20,000 bogies with their mass in the middle, by frequency",
        "prototype",
        1e-9,
        largest,
    );
}
