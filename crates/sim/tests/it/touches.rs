//! Energy where flanges touch and separate inside steps.

use std::ops::ControlFlow;

use sim::{
    Body, Contact, Damper, Flange, Foundation, GapCause, Method, NormalLaw, Run, Scene, Wheel,
    run_by,
};

/// A body of 10 t that swings between the flanges of one wheel on a rigid rail, by `method`.
fn between_flanges(method: Method, accuracy: f64) -> Run {
    let mut wheel = Wheel::new(0.5, NormalLaw::linear(1e8, 0.0, Damper::Rail));
    wheel.flange = Some(Flange {
        stiffness: 1e7,
        clearance: 0.01,
        release: None,
    });
    let mut scene = Scene {
        bodies: vec![Body {
            start_speed: [0.0, 0.0, 0.3, 0.0, 0.0, 0.0],
            ..Body::new(1e4, [1.0; 3])
        }],
        wheels: vec![wheel],
        contacts: vec![Contact::new(0, [0.0; 3])],
        end: 4.0,
        accuracy,
        ..Scene::default()
    };
    scene.bodies[0].free = [false, true, true, false, false, false];
    run_by(method, &scene, &[Foundation::rigid()], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene")
}

/// Identity: nothing is lost; the sums by cause are the imbalance at the end. By SDIRK4, whose errors between flanges are small
/// here, the largest gaps, in order, are those of steps that end at a flange.
#[test]
fn energy_of_a_body_between_flanges_is_kept_and_gaps_are_attributed() {
    for (method, accuracy) in [Method::Sdirk4, Method::Esdirk5]
        .into_iter()
        .flat_map(|method| [1e-3, 1e-4, 1e-5].map(|accuracy| (method, accuracy)))
    {
        let run = between_flanges(method, accuracy);
        assert!(run.status.is_complete());
        let audit = &run.audit;
        assert!(
            audit.residual() < accuracy,
            "{accuracy}: {:e} ({:?})",
            audit.residual(),
            audit.gaps
        );
        let gaps = &audit.gaps;
        let sum = gaps.steps + gaps.flanges + gaps.contacts + gaps.breaks;
        let end = audit.end.total() + audit.exchanged.net_loss() - audit.start.total();
        assert!(
            (sum - end).abs() <= 1e-9 * audit.peak_stored,
            "{accuracy}: {sum:e} {end:e}"
        );
        assert!(
            gaps.largest
                .windows(2)
                .all(|pair| pair[0].energy.abs() >= pair[1].energy.abs())
        );
        if method == Method::Esdirk5 {
            continue;
        }
        let at_flange = |gap: &sim::EnergyGap| gap.cause == GapCause::Flange(0);
        assert!(gaps.largest.iter().all(at_flange), "{accuracy}: {gaps:?}");
        assert!(gaps.flanges.abs() > 0.5 * sum.abs(), "{accuracy}: {gaps:?}");
    }
}
