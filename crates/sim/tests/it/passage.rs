//! Crossings by power series against the general steppers and outside references.

use crate::common;

use std::ops::ControlFlow;

use common::{WEIGHT, bogie, girder, reference, surface};
use sim::{
    BodyDof, Channel, Contact, Damper, Error, Foundation, Method, Run, Scene, Status, run_by,
};

fn solved(method: Method, scene: &Scene, foundation: Foundation) -> Run {
    let run = run_by(method, scene, &[foundation], &mut |_| {
        ControlFlow::Continue(())
    });
    let run = run.expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// Largest difference of a column, by its largest entry; by 1e-3 where that is less.
fn apart(a: &Run, b: &Run, channel: Channel) -> f64 {
    let (a, b) = (a.history.column(channel), b.history.column(channel));
    assert_eq!(a.len(), b.len());
    assert!(
        a.iter().chain(&b).all(|value| value.is_finite()),
        "{channel:?}"
    );
    let size = b.iter().fold(1e-3_f64, |max, x| max.max(x.abs()));
    a.iter()
        .zip(&b)
        .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
        / size
}

/// `count` wheels of the bogie's stiffness in all, 2 ft apart.
fn on_wheels(count: u32, mut scene: Scene) -> Scene {
    let middle = 0.5 * f64::from(count - 1);
    scene.wheels[0].normal.stiffness *= 2.0 / f64::from(count);
    scene.wheels[0].normal.damping *= 2.0 / f64::from(count);
    let pattern = scene.contacts[0].clone();
    scene.contacts = (0..count)
        .map(|i| Contact {
            offsets: vec![2.0 * (f64::from(i) - middle)],
            ..pattern.clone()
        })
        .collect();
    scene.bodies[0].free[5] = count > 1;
    scene
}

/// Independent: the same scenes by Radau at accuracy 1e-10.
#[test]
fn every_column_and_energy_is_that_of_the_general_stepper() {
    let exact = || Foundation::massless(Box::new(surface()), 1);
    let scenes = [
        (
            bogie(100.0, 0.55, Damper::Ground),
            exact as fn() -> Foundation,
        ),
        (bogie(20.0, 0.5, Damper::Ground), girder),
        (on_wheels(1, bogie(30.0, 0.4, Damper::Ground)), exact),
        (on_wheels(4, bogie(-20.0, 0.3, Damper::Ground)), exact),
        (on_wheels(6, bogie(40.0, 0.5, Damper::Ground)), exact),
        (bogie(20.0, 0.5, Damper::Ground), Foundation::rigid),
        (bogie(0.0, 0.5, Damper::Ground), exact),
    ];
    for (index, (mut scene, foundation)) in scenes.into_iter().enumerate() {
        scene.bodies[0].start_speed[1] = -0.5;
        if scene.bodies[0]
            .motion
            .as_ref()
            .is_some_and(|motion| motion.at(1.0).x <= 0.0)
        {
            scene.bodies[0].motion = Some(
                sim::Profile::new(sim::MotionKind::Speed, &[[0.0, -20.0]], 40.0, 0.0)
                    .expect("a valid table"),
            );
        }
        scene.accuracy = 1e-10;
        let (found, wanted) = (
            solved(Method::Series, &scene, foundation()),
            solved(Method::Radau, &scene, foundation()),
        );
        assert_eq!(found.method, Some(Method::Series), "{index}");
        for channel in [
            Channel::Time,
            Channel::Displacement(0, BodyDof::X),
            Channel::Displacement(0, BodyDof::Y),
            Channel::Speed(0, BodyDof::Y),
            Channel::Position(0),
            Channel::Vertical(0),
            Channel::Penetration(0),
            Channel::Deflection(0),
        ] {
            let off = apart(&found, &wanted, channel);
            assert!(off < 1e-8, "{index} {channel:?}: {off:.1e}");
        }
        let drive = found.history.column(Channel::Drive(0));
        let other = wanted.history.column(Channel::Drive(0));
        let off = drive
            .iter()
            .zip(&other)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()));
        assert!(off < 1e-8 * WEIGHT, "{index}: drive {off:.1e}");
        let scale = wanted.audit.peak_stored;
        for (a, b) in [
            (found.audit.start.total(), wanted.audit.start.total()),
            (found.audit.end.kinetic, wanted.audit.end.kinetic),
            (found.audit.end.gravity, wanted.audit.end.gravity),
            (found.audit.end.contact, wanted.audit.end.contact),
            (found.audit.end.structure, wanted.audit.end.structure),
            (
                found.audit.exchanged.dampers,
                wanted.audit.exchanged.dampers,
            ),
            (found.audit.exchanged.drives, wanted.audit.exchanged.drives),
        ] {
            assert!(
                (a - b).abs() < 1e-7 * scale,
                "{index}: {a} for {b} of {scale}"
            );
        }
        assert!(
            found.audit.residual() < 1e-8,
            "{index}: {:.1e}",
            found.audit.residual()
        );
    }
}

/// External: `fea/bogie_reference.py`. Energy: identity.
#[test]
fn errors_stay_below_the_accuracy_asked() {
    for (speed, end, text) in [
        (
            5.0,
            12.0,
            include_str!("../../../../fea/reference/bogie_s1.json"),
        ),
        (
            100.0,
            0.55,
            include_str!("../../../../fea/reference/bogie_s2.json"),
        ),
    ] {
        let wanted = reference(text);
        let peak = wanted.iter().fold(0.0_f64, |max, row| max.max(row[1]));
        for power in 2..=8 {
            let mut scene = bogie(speed, end, Damper::Ground);
            scene.accuracy = 10_f64.powi(-power);
            let run = solved(
                Method::Series,
                &scene,
                Foundation::massless(Box::new(surface()), 1),
            );
            assert_eq!(run.method, Some(Method::Series));
            let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
            let error = wanted
                .iter()
                .zip(y)
                .fold(0.0_f64, |max, (row, y)| max.max((y + row[1]).abs()))
                / peak;
            assert!(
                error < 1.0 * scene.accuracy,
                "{speed} ft/s: {error:.1e} at {:.0e}",
                scene.accuracy
            );
            let residual = run.audit.residual();
            assert!(
                residual < 0.1 * scene.accuracy,
                "{speed} ft/s: energy to {residual:.1e}"
            );
            assert!(
                run.counts.steps < 150 && run.counts.rejected == 0,
                "{:?}",
                run.counts
            );
        }
    }
}

/// Independent: the same scene by Radau at accuracy 1e-10. The slope of the rail under a standing wheel is not a rate
/// of its deflection divided by a speed.
#[test]
fn a_standing_body_has_the_drive_force_of_the_general_stepper() {
    for damper in [Damper::Ground, Damper::Rail] {
        let mut scene = bogie(20.0, 0.5, damper);
        scene.wheels[0].normal.damping = if damper == Damper::Rail { 0.0 } else { 1e5 };
        scene.bodies[0].start_speed[1] = -0.5;
        let table = [[0.0, 0.0]];
        scene.bodies[0].motion = Some(
            sim::Profile::new(sim::MotionKind::Speed, &table, 17.0, 0.0).expect("a valid table"),
        );
        scene.accuracy = 1e-10;
        let found = solved(Method::Series, &scene, girder());
        let wanted = solved(Method::Radau, &scene, girder());
        assert_eq!(found.method, Some(Method::Series));
        let largest = wanted
            .history
            .column(Channel::Drive(0))
            .iter()
            .fold(0.0_f64, |max, x| max.max(x.abs()));
        assert!(largest > 1e-3 * WEIGHT, "{largest}");
        for channel in [
            Channel::Drive(0),
            Channel::Vertical(0),
            Channel::Displacement(0, BodyDof::Y),
        ] {
            let off = apart(&found, &wanted, channel);
            assert!(off < 1e-7, "{damper:?} {channel:?}: {off:.1e}");
        }
    }
}

/// At 100 ft/s a wheel leaves the girder beyond 57 ft.
#[test]
fn radau_takes_over_where_a_wheel_lifts() {
    let scene = bogie(100.0, 0.62, Damper::Ground);
    let run = solved(Method::Series, &scene, girder());
    assert_eq!(run.method, Some(Method::Radau));
    assert!(run.counts.events > 0);
    let same = solved(Method::Radau, &scene, girder());
    assert_eq!(run.history, same.history);
}

#[test]
fn series_refuse_what_they_cannot_take() {
    let refused = |scene: &Scene| {
        let found = run_by(Method::Series, scene, &[girder()], &mut |_| {
            ControlFlow::Continue(())
        });
        matches!(
            found,
            Err(Error::Method {
                method: Method::Series,
                ..
            })
        )
    };
    assert!(refused(&bogie(20.0, 1.0, Damper::Rail)));
    assert!(refused(&on_wheels(9, bogie(20.0, 1.0, Damper::Ground))));
    let mut scene = bogie(20.0, 1.0, Damper::Ground);
    let table = [[0.0, 5.0], [1.0, 6.0]];
    scene.bodies[0].motion =
        Some(sim::Profile::new(sim::MotionKind::Speed, &table, 0.0, 0.0).expect("a valid table"));
    assert!(refused(&scene));
}

#[test]
fn a_run_that_is_stopped_says_so() {
    let scene = bogie(100.0, 0.55, Damper::Ground);
    let mut steps = 0;
    let run = run_by(Method::Series, &scene, &[girder()], &mut |_| {
        steps += 1;
        if steps == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let run = run.expect("a valid scene");
    assert_eq!((run.status, run.counts.steps), (Status::Stopped, 3));
    assert!(run.history.len() > 2 && run.history.len() < 101);
}
