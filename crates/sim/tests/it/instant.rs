//! Contact forces at given states, against planted answers and closed forms.

use crate::common;

use common::{GRAVITY, SPAN, WEIGHT, bogie, girder, give};
use sim::{Damper, Flange, Foundation, Friction, FrictionLaw, Instant, NormalLaw, contact_forces};

/// Instant of the bogie at `time`, `heave` and `pitch`.
fn instant(time: f64, heave: f64, pitch: f64) -> Instant {
    Instant {
        time,
        displacement: vec![[0.0, heave, 0.0, 0.0, 0.0, pitch]],
        speed: vec![[0.0, 0.3, 0.0, 0.0, 0.0, -0.1]],
        spin: vec![0.0; 2],
        penetration: vec![None; 2],
    }
}

/// Penetrations made from planted forces by the closed form of the girder give these forces back.
#[test]
fn planted_forces_come_back_from_their_penetrations() {
    let scene = bogie(5.0, 12.0, Damper::Rail);
    let planted = [2.1e6, 2.9e6];
    for (time, pitch) in [(2.0, 1e-3), (6.0, 0.0), (9.3, -4e-3)] {
        let mut at = instant(time, -0.3, pitch);
        let places = [5.0 * time - 4.0 / 3.0, 5.0 * time + 4.0 / 3.0];
        let approach = [0.3 + pitch * 4.0 / 3.0, 0.3 - pitch * 4.0 / 3.0];
        for i in 0..2 {
            let sag: f64 = (0..2)
                .map(|j| give(places[i], places[j]).0 * planted[j])
                .sum();
            at.penetration[i] = Some(approach[i] - sag);
        }
        let found = contact_forces(&scene, &[girder()], &[at])
            .expect("a valid scene")
            .remove(0);
        for i in 0..2 {
            assert!(
                (found.vertical[i] / planted[i] - 1.0).abs() < 1e-11,
                "{:?}",
                found.vertical
            );
            assert!((found.approach[i] - approach[i]).abs() < 1e-15);
            let slope: f64 = (0..2)
                .map(|j| give(places[i], places[j]).1 * planted[j])
                .sum();
            assert!((found.slope_force[i] - slope * planted[i]).abs() < 1e-9 * WEIGHT);
            for (j, place) in places.iter().enumerate() {
                assert!((found.compliance[(i, j)] - give(places[i], *place).0).abs() < 1e-20);
            }
        }
    }
}

/// A wheel with a damper to the rail stands 1e-6 ft beyond a support. There the rail is rigid, so that the force cannot
/// be found from a given penetration, but the force of the other wheel deflects and turns it: p = e - G F and p' = e' -
/// x' w', of which G F is small but not negligible.
#[test]
fn a_wheel_beside_a_support_feels_the_deflection_by_the_other_wheel() {
    let (k, c, speed) = (1e8, 1e5, 5.0);
    let scene = bogie(speed, 12.0, Damper::Rail);
    let half = 4.0 / 3.0;
    for shift in [1e-6, 1e-4] {
        let mut at = instant((half + shift) / speed, -0.05, 0.0);
        let places = [speed * at.time - half, speed * at.time + half];
        let planted = 2.9e6;
        let sag = |i: usize, own: f64| {
            give(places[i], places[0]).0 * own + give(places[i], places[1]).0 * planted
        };
        let slope =
            |own: f64| give(places[0], places[0]).1 * own + give(places[0], places[1]).1 * planted;
        let (mut own, mut p) = (0.0, 0.0);
        for _ in 0..20 {
            p = 0.05 - sag(0, own);
            // e' of the first wheel, at -4/3 ft: -(0.3 + 0.1 * 4/3)
            own = k * p + c * (-(0.3 + 0.1 * half) - speed * slope(own));
        }
        at.penetration = vec![Some(p), Some(0.05 - sag(1, own))];
        let found = contact_forces(&scene, &[girder()], &[at])
            .expect("a valid scene")
            .remove(0);
        assert!(
            (found.penetration[0] / p - 1.0).abs() < 1e-14,
            "{} {p}",
            found.penetration[0]
        );
        assert!(
            (found.vertical[0] / own - 1.0).abs() < 1e-12,
            "{} {own}",
            found.vertical[0]
        );
        assert!(
            (found.vertical[1] / planted - 1.0).abs() < 1e-11,
            "{}",
            found.vertical[1]
        );
        assert!((sag(0, own) / p).abs() > 1e-9, "the deflection counts");
    }
}

/// A damper to ground: (G + 1/k) F = e + (c/k) r, solved here by Cramer's rule.
#[test]
fn forces_of_a_grounded_damper_solve_their_linear_system() {
    let scene = bogie(5.0, 12.0, Damper::Ground);
    let at = instant(6.0, -0.5, 2e-3);
    let (a, b) = (SPAN / 2.0 - 4.0 / 3.0, SPAN / 2.0 + 4.0 / 3.0);
    let (k, c) = (1e8, 1e5);
    let right = [
        (0.5 + 2e-3 * 4.0 / 3.0, -0.3 - 0.1 * 4.0 / 3.0),
        (0.5 - 2e-3 * 4.0 / 3.0, -0.3 + 0.1 * 4.0 / 3.0),
    ]
    .map(|(e, r)| e + c / k * r);
    let (aa, ab, bb) = (give(a, a).0 + 1.0 / k, give(a, b).0, give(b, b).0 + 1.0 / k);
    let det = aa * bb - ab * ab;
    let expected = [
        (right[0] * bb - right[1] * ab) / det,
        (right[1] * aa - right[0] * ab) / det,
    ];
    let found = contact_forces(&scene, &[girder()], &[at])
        .expect("a valid scene")
        .remove(0);
    for i in 0..2 {
        assert!(
            (found.vertical[i] / expected[i] - 1.0).abs() < 1e-12,
            "{:?} {expected:?}",
            found.vertical
        );
    }
}

/// A wheel in the air takes no force, and says how far it is from the rail.
#[test]
fn open_contacts_have_no_force() {
    for damper in [Damper::Rail, Damper::Ground] {
        let scene = bogie(5.0, 12.0, damper);
        let found =
            contact_forces(&scene, &[girder()], &[instant(6.0, 0.2, 0.0)]).expect("a valid scene");
        assert_eq!(found[0].vertical, [0.0, 0.0]);
        assert!(found[0].penetration.iter().all(|p| (p + 0.2).abs() < 1e-15));
    }
}

/// One wheel on a rigid rail: IMPACT, flange and friction by their closed forms.
#[test]
fn flange_and_friction_follow_their_laws_on_a_rigid_rail() {
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.bodies[0].free = [true, true, true, false, false, false];
    scene.bodies[0].motion = None;
    scene.contacts.truncate(1);
    scene.contacts[0].at = [0.0; 3];
    scene.contacts[0].offsets = vec![0.0];
    scene.wheels[0].normal = NormalLaw {
        exponent: 1.1,
        depth: 1e-2,
        ..NormalLaw::linear(1e8, 1e5, Damper::Rail)
    };
    scene.wheels[0].flange = Some(Flange {
        stiffness: 1e8,
        clearance: 0.04,
        release: None,
    });
    scene.wheels[0].friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: 0.2,
        slip: 0.1,
    });
    scene.wheels[0].spin_inertia = Some(WEIGHT / GRAVITY);
    let at = Instant {
        time: 0.0,
        displacement: vec![[3.0, -0.05, -0.06, 0.0, 0.0, 0.0]],
        speed: vec![[2.0, -0.5, 0.0, 0.0, 0.0, 0.0]],
        spin: vec![-1.5],
        penetration: vec![None],
    };
    let found = contact_forces(&scene, &[Foundation::rigid()], &[at])
        .expect("a valid scene")
        .remove(0);
    let vertical = 1e8 * 0.05_f64.powf(1.1) + 1e5 * 0.5;
    // sliding velocity 2 - 1.5 (1.25 - 0.05) is 0.2, beyond the slip velocity
    assert!((found.vertical[0] / vertical - 1.0).abs() < 1e-13);
    assert!(
        (found.lateral[0] + 2e6).abs() < 1e-5,
        "{}",
        found.lateral[0]
    );
    assert!((found.traction[0] / (0.2 * vertical) - 1.0).abs() < 1e-13);
}
