//! Natural modes of scenes at rest, against closed forms and the eigenvalues of matrices written out for the case.

use crate::common;

use common::GRAVITY;
use common::crane::{BRIDGE, TROLLEY, body, carried, crane_of};
use common::near::assert_near;
use common::space::{self, G};
use nalgebra::{Matrix3, SymmetricEigen};
use sim::{Actuators, Body, BodyDof, NaturalMode, Rope, RopeEnd, Scene, Schedule, natural_modes};

const LADLE: f64 = 31_700.0;
const EA: f64 = 2.8e8;
const LENGTH: f64 = 40.0;

/// Bridge and trolley with the freedoms given, and a ladle at rest below the middle of the trolley.
fn crane(bridge: &[BodyDof], trolley: &[BodyDof]) -> Scene {
    let mut scene = crane_of(
        body(BRIDGE, [1e6, 4e6, 4e6], bridge),
        body(TROLLEY, [9e4, 2e5, 2e5], trolley),
        1.0,
    );
    scene
        .bodies
        .push(body(LADLE, [0.0; 3], &[BodyDof::X, BodyDof::Y, BodyDof::Z]));
    scene.actuators.hanging = vec![2];
    scene.actuators.ropes = vec![Rope {
        from: RopeEnd {
            body: Some(1),
            at: [0.0; 3],
        },
        to: RopeEnd {
            body: Some(2),
            at: [0.0; 3],
        },
        stiffness: EA,
        damping: 7e4,
        length: LENGTH,
        speed: Schedule::new(&[[0.0, 0.0]]).expect("a valid table"),
    }];
    scene
}

fn found(scene: &Scene) -> Vec<NaturalMode> {
    let foundations = [
        sim::Foundation::rigid(),
        carried([0.0, 0.0, 1.0], [0.0, 3.0, 0.0]),
    ];
    let place: Vec<f64> = scene
        .bodies
        .iter()
        .map(|body: &Body| body.start[0])
        .collect();
    natural_modes(scene, &foundations, 0.0, &place)
        .expect("a scene at rest")
        .expect("few freedoms")
}

/// Analytic: sqrt(g/l) twice and sqrt(k/m) of a mass on an elastic rope.
#[test]
fn a_hung_mass_swings_and_bounces() {
    let (m, l0, ea) = (1000.0, 8.0, 1e6);
    let stretched = l0 * (1.0 + m * G / ea);
    let actuators = Actuators {
        ropes: vec![space::rope(ea, l0, [None, Some(0)])],
        hanging: vec![0],
        ..Actuators::default()
    };
    let scene = space::scene(
        vec![space::body(m, [true; 3], [0.0; 3], [0.0; 3])],
        actuators,
        1.0,
        1e-6,
    );
    let modes = natural_modes(&scene, &[], 0.0, &[0.0])
        .expect("at rest")
        .expect("three freedoms");
    let swing = (G / stretched).sqrt();
    let wanted = [swing, swing, (ea / l0 / m).sqrt()];
    assert_eq!(modes.len(), 3);
    for (mode, wanted) in modes.iter().zip(wanted) {
        assert!(
            (mode.omega / wanted - 1.0).abs() < 1e-6,
            "{} {wanted}",
            mode.omega
        );
    }
    assert!(modes[2].fraction[0][1] > 1.0 - 1e-9, "{:?}", modes[2]);
}

/// A ladle of 1,020 kip on elastic ropes, feet and pounds.
#[test]
fn a_ladle_on_its_ropes_bounces_at_a_few_hertz() {
    for (stiffness, known) in [(5e6, 1.9), (5e7, 6.0)] {
        let weight = 1.02e6;
        let mass = weight / GRAVITY;
        let actuators = Actuators {
            ropes: vec![space::rope(stiffness * 40.0, 40.0, [None, Some(0)])],
            hanging: vec![0],
            ..Actuators::default()
        };
        let mut scene = space::scene(
            vec![space::body(mass, [true; 3], [0.0; 3], [0.0; 3])],
            actuators,
            1.0,
            1e-6,
        );
        scene.gravity = GRAVITY;
        let modes = natural_modes(&scene, &[], 0.0, &[0.0])
            .expect("at rest")
            .expect("three freedoms");
        let what = format!(
            "ladle of 1,020 kip on ropes of {stiffness:e} lb/ft: frequency, Hz (one digit, its weight not told)"
        );
        assert_near(
            what,
            "prototype",
            known,
            modes[2].omega / (2.0 * std::f64::consts::PI),
            0.06,
        );
    }
}

/// Independent: three masses on springs in a row, the bridge's wheels, the trolley's wheels and the rope; dampers do not count.
#[test]
fn a_crane_bounces_as_three_masses_in_a_row() {
    let scene = crane(&[BodyDof::Y], &[BodyDof::Y]);
    let wheels = 4.0 * scene.wheels[0].normal.stiffness;
    let rope = EA / LENGTH;
    let stiffness = Matrix3::new(
        2.0 * wheels,
        -wheels,
        0.0, //
        -wheels,
        wheels + rope,
        -rope, //
        0.0,
        -rope,
        rope,
    );
    let masses = [BRIDGE, TROLLEY, LADLE];
    let scaled = Matrix3::from_fn(|i, j| stiffness[(i, j)] / (masses[i] * masses[j]).sqrt());
    let mut wanted: Vec<f64> = SymmetricEigen::new(scaled)
        .eigenvalues
        .iter()
        .map(|w| w.sqrt())
        .collect();
    wanted.sort_by(f64::total_cmp);
    let modes = found(&scene);
    let upright: Vec<&NaturalMode> = modes
        .iter()
        .filter(|mode| mode.fraction[2][0] + mode.fraction[2][2] < 0.5)
        .collect();
    assert_eq!(upright.len(), 3, "{modes:?}");
    for (mode, wanted) in upright.iter().zip(wanted) {
        assert!(
            (mode.omega / wanted - 1.0).abs() < 1e-6,
            "{} {wanted}",
            mode.omega
        );
        let sum: f64 = mode.fraction.iter().flatten().sum();
        assert!((sum + mode.structures - 1.0).abs() < 1e-9, "{sum}");
    }
    assert!(upright[0].fraction[2][1] > 0.9, "{:?}", upright[0]);
}

/// Analytic: a ladle below a crane that rolls freely swings with g (1 + m/M)/l along the runway, and with g/l across; the
/// crane's own way along x is held by nothing and is no mode.
#[test]
fn a_ladle_swings_faster_below_a_crane_that_rolls() {
    let modes = found(&crane(&[BodyDof::X], &[]));
    let length = LENGTH * (1.0 + LADLE * GRAVITY / EA);
    let across = (GRAVITY / length).sqrt();
    let along = across * (1.0 + LADLE / (BRIDGE + TROLLEY)).sqrt();
    assert_eq!(modes.len(), 3, "{modes:?}");
    for (mode, wanted) in modes.iter().zip([across, along]) {
        assert!(
            (mode.omega / wanted - 1.0).abs() < 1e-6,
            "{} {wanted}",
            mode.omega
        );
    }
}
