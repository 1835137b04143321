//! A worked case and classical results.

use crate::common::{self, wheel};
use fea::{BeamTheory, Effect, Girder};
use trains::{
    CaseEnvelopes, DeadLoads, GirderResponse, Request, SpanExtreme, Structure, Train, TrainCase,
    envelopes,
};

fn train(wheels: &[(f64, f64)]) -> Train {
    let wheels = wheels.iter().map(|&(x, force)| wheel(x, force)).collect();
    Train {
        turned: true,
        reverses: true,
        ..common::train(wheels)
    }
}

fn supports(girder: &Girder) -> Vec<f64> {
    let mut x = vec![0.0];
    girder
        .spans
        .iter()
        .for_each(|span| x.push(x[x.len() - 1] + span));
    x
}

fn solve(girder: &Girder, trains: Vec<Train>, dead: &DeadLoads, places: Vec<f64>) -> CaseEnvelopes {
    let (model, rail) = girder.model_and_rail().expect("the girder is valid");
    let structure = Structure::new(&model, &[rail], false).expect("the girder is stable");
    let effects = structure
        .frame()
        .restraints(&model)
        .into_iter()
        .map(|hold| vec![Effect::Reaction(hold)])
        .collect();
    let request = Request {
        spans: vec![supports(girder)],
        places: vec![places],
        effects,
        ..Request::default()
    };
    let factor = if dead.is_empty() { 0.0 } else { 1.0 };
    let case = TrainCase {
        trains,
        dead: factor,
        ..TrainCase::default()
    };
    envelopes(&structure, dead, &[case], &request)
        .expect("the train fits")
        .remove(0)
}

fn extreme(
    found: &CaseEnvelopes,
    span: usize,
    quantity: GirderResponse,
    is_max: bool,
) -> &SpanExtreme {
    let same = |e: &&SpanExtreme| (e.span, e.quantity, e.is_max) == (span, quantity, is_max);
    found
        .extremes
        .iter()
        .find(same)
        .expect("there is an extreme for every span")
}

/// HEB 400 over 6, 7.5 and 6 m, two wheels of 180 kN, 3.6 m apart. Numbers of an independent Timoshenko model of
/// finite elements of 0.05 m, given to six digits.
#[test]
fn runway_over_three_spans() {
    let girder = Girder {
        spans: vec![6.0, 7.5, 6.0],
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.01978),
        i_vertical: 5.768e-4,
        ka_vertical: Some(0.007),
        theory: BeamTheory::Timoshenko,
        ..Girder::default()
    };
    let found = solve(
        &girder,
        vec![train(&[(0.0, 180.0), (3.6, 180.0)])],
        &DeadLoads::default(),
        vec![6.0, 9.75],
    );
    let largest = extreme(&found, 2, GirderResponse::VerticalMoment, true);
    assert!(
        (largest.governing.value - 241.2377).abs() < 5e-5,
        "{largest:?}"
    );
    assert!((largest.governing.x - 9.2442).abs() < 5e-5);
    let at = |x: f64, is_max: bool| {
        let same = |e: &&trains::EnvelopeValue| {
            e.governing.x == x && e.quantity == GirderResponse::VerticalMoment && e.is_max == is_max
        };
        found
            .envelopes
            .iter()
            .find(same)
            .expect("the place was asked for")
            .governing
            .value
    };
    assert!((at(9.75, true) - 233.048).abs() < 5e-4);
    assert!((at(6.0, false) + 195.174).abs() < 5e-4);
    // Reactions: longitudinal, vertical, lateral and twist of the first support, then three of each other.
    let vertical: Vec<[f64; 2]> = [1, 4]
        .map(|k: usize| [&found.effects[k][0], &found.effects[k][1]].map(|g| g.value))
        .to_vec();
    for (found, known) in vertical
        .iter()
        .flatten()
        .zip([235.687, -28.335, 317.259, -26.143])
    {
        assert!((found - known).abs() < 1e-3, "{found}, not {known}");
    }
    let sag = extreme(&found, 2, GirderResponse::VerticalDeflection, true);
    assert!((sag.governing.value - 9.385e-3).abs() < 1e-6, "{sag:?}");
    assert!(sag.bound >= sag.governing.value && sag.bound < sag.governing.value * (1.0 + 1e-9));
}

/// The largest moment of a simple beam under two equal wheels is P (L - a/2)^2/(2 L), at L/2 - a/4.
#[test]
fn two_wheels_on_a_simple_beam() {
    let girder = Girder {
        spans: vec![10.0],
        e: 2.1e8,
        i_vertical: 5e-4,
        ..Girder::default()
    };
    let found = solve(
        &girder,
        vec![train(&[(0.0, 90.0), (3.0, 90.0)])],
        &DeadLoads::default(),
        Vec::new(),
    );
    let largest = &extreme(&found, 1, GirderResponse::VerticalMoment, true).governing;
    assert!(
        (largest.value - 90.0 * 8.5 * 8.5 / 20.0).abs() < 1e-11,
        "{largest:?}"
    );
    assert!((largest.x - 4.25).abs() < 1e-9, "{largest:?}");
    let shear = &extreme(&found, 1, GirderResponse::VerticalShear, true).governing;
    assert!(
        (shear.value - 90.0 * (1.0 + 0.7)).abs() < 1e-11,
        "{shear:?}"
    );
}

/// With a dead load w the largest moment of one wheel P on a simple beam is at midspan: P L/4 + w L^2/8.
#[test]
fn dead_load_adds_its_own() {
    let girder = Girder {
        spans: vec![8.0],
        e: 2.1e8,
        i_vertical: 5e-4,
        mass_per_length: Some(0.2),
        ..Girder::default()
    };
    let dead = DeadLoads {
        gravity: 10.0,
        lines: vec![1.0],
    };
    let found = solve(&girder, vec![train(&[(0.0, 100.0)])], &dead, vec![4.0]);
    let largest = &extreme(&found, 1, GirderResponse::VerticalMoment, true).governing;
    assert!(
        (largest.value - (200.0 + 3.0 * 8.0)).abs() < 1e-10,
        "{largest:?}"
    );
    assert!((largest.dead - 24.0).abs() < 1e-11 && (largest.x - 4.0).abs() < 1e-9);
    let sag = &extreme(&found, 1, GirderResponse::VerticalDeflection, true).governing;
    let stiffness = 2.1e8 * 5e-4;
    let known = 100.0 * 512.0 / (48.0 * stiffness) + 5.0 * 3.0 * 4096.0 / (384.0 * stiffness);
    assert!(
        (sag.value / known - 1.0).abs() < 1e-9,
        "{sag:?}, not {known}"
    );
    // The smallest moment: wheel at a support, dead load alone.
    let least = &extreme(&found, 1, GirderResponse::VerticalMoment, false).governing;
    assert!(least.value.abs() < 1e-11, "{least:?}");
}

/// At the middle support of two equal spans L the shear force jumps. Analytic, by the equation of three moments: a wheel P
/// beside the support causes a shear of P on its side and none on the other, where each wheel position has the same sign;
/// a dead load w has 5/8 w L of opposite signs.
#[test]
fn shear_envelopes_have_both_sides_of_a_support() {
    let (length, load, dead) = (8.0, 100.0, 3.0);
    let girder = Girder {
        spans: vec![length, length],
        e: 2.1e8,
        i_vertical: 5e-4,
        mass_per_length: Some(0.2),
        ..Girder::default()
    };
    let loads = DeadLoads {
        gravity: 10.0,
        lines: vec![1.0],
    };
    let found = solve(&girder, vec![train(&[(0.0, load)])], &loads, vec![length]);
    let of_dead = 0.625 * dead * length;
    for (is_max, sign) in [(true, 1.0), (false, -1.0)] {
        let is_own = |e: &trains::EnvelopeValue| {
            (e.governing.x, e.quantity, e.is_max) == (length, GirderResponse::VerticalShear, is_max)
        };
        let index = found
            .envelopes
            .iter()
            .position(is_own)
            .expect("the place was asked for");
        let one = &found.envelopes[index].governing;
        let (_, other) = found
            .other_sides
            .iter()
            .find(|(of, _)| *of == index)
            .expect("two members meet");
        assert!(
            (one.value - sign * (load + of_dead)).abs() < 1e-9,
            "{one:?}"
        );
        assert!((other.value + sign * of_dead).abs() < 1e-9, "{other:?}");
        assert!(one.side != other.side && one.x == other.x);
    }
}

/// Classical results for trains that fit on a simple beam entirely: the moment under a wheel is largest where midspan halves
/// the distance of the wheel from the resultant of the train. Analytic: with the resultant R at a distance e from the wheel,
/// the moment is R (L/2 - e/2)^2/L less the moment of the wheels before it.
#[test]
fn classical_trains_on_a_simple_beam() {
    let length = 20.0;
    let girder = Girder {
        spans: vec![length],
        e: 2.1e8,
        i_vertical: 5e-4,
        ..Girder::default()
    };
    let trains: [&[(f64, f64)]; 4] = [
        &[(0.0, 90.0), (3.0, 90.0), (6.0, 90.0)],
        &[(0.0, 90.0), (3.0, 90.0), (6.0, 90.0), (9.0, 90.0)],
        // The truck HS20 of AASHTO, in kN and m.
        &[(0.0, 35.0), (4.3, 145.0), (8.6, 145.0)],
        &[(0.0, 210.0), (1.1, 180.0), (5.2, 180.0), (6.3, 210.0)],
    ];
    for wheels in trains {
        let found = solve(
            &girder,
            vec![train(wheels)],
            &DeadLoads::default(),
            Vec::new(),
        );
        let largest = &extreme(&found, 1, GirderResponse::VerticalMoment, true).governing;
        let total: f64 = wheels.iter().map(|(_, force)| force).sum();
        let centre = wheels.iter().map(|(x, force)| x * force).sum::<f64>() / total;
        let under = |&(x, _): &(f64, f64)| {
            let place = 0.5 * (length + x - centre);
            let before: f64 = wheels
                .iter()
                .filter(|(other, _)| *other < x)
                .map(|(other, force)| force * (x - other))
                .sum();
            total * (length - place + x - centre) / length * place - before
        };
        let known = wheels.iter().map(under).fold(0.0, f64::max);
        assert!(
            (largest.value / known - 1.0).abs() < 1e-13,
            "{} instead of {known}",
            largest.value
        );
        let equal = wheels.iter().all(|(_, force)| *force == wheels[0].1);
        if let (true, 3) = (equal, wheels.len()) {
            assert!((known - (3.0 * 90.0 * length / 4.0 - 90.0 * 3.0)).abs() < 1e-10);
        }
        if let (true, 4) = (equal, wheels.len()) {
            assert!(
                (known - (360.0 / length * 9.25 * 9.25 - 270.0)).abs() < 1e-10,
                "{known}"
            );
        }
    }
}

/// The extremes of trains of single wheels on a simple beam of 10 m, in any order with a gap.
fn single_wheels(trains: Vec<Train>, gap: f64, ordered: bool) -> CaseEnvelopes {
    let (structure, request) = beam(10.0, 0.0);
    let case = TrainCase {
        trains,
        gap,
        ordered,
        ..TrainCase::default()
    };
    envelopes(&structure, &DeadLoads::default(), &[case], &request)
        .expect("the trains fit")
        .remove(0)
}

/// A simple beam with an overhang behind it, and a request for its ends, its span and its reactions.
fn beam(span: f64, overhang: f64) -> (Structure, Request) {
    let girder = Girder {
        spans: vec![span],
        overhangs: [0.0, overhang],
        e: 2.1e8,
        i_vertical: 1e-3,
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("the girder is valid");
    let structure = Structure::new(&model, &[rail], false).expect("the girder is stable");
    let up = |hold: &fea::Restraint| hold.dof == fea::Dof::Uy;
    let holds = structure.frame().restraints(&model).into_iter().filter(up);
    let request = Request {
        spans: vec![vec![0.0, span]],
        places: vec![vec![0.0, span, span + overhang]],
        effects: holds.map(|hold| vec![Effect::Reaction(hold)]).collect(),
        ..Request::default()
    };
    (structure, request)
}

/// Statics: two wheels of 100 kN with a metre of train behind each meet back to back, as only one of them is turned:
/// M = 200 L/4 = 500 kN m, and V = 200 kN with both over a support. A response to a single wheel does not tell its turns.
#[test]
fn trains_that_differ_by_their_ends_alone_are_turned() {
    let of = || Train {
        ends: [0.0, 1.0],
        ..train(&[(0.0, 100.0)])
    };
    let found = single_wheels(vec![of(), of()], 0.0, false);
    let value = |quantity| extreme(&found, 1, quantity, true).governing.value;
    assert!((value(GirderResponse::VerticalMoment) - 500.0).abs() < 1e-9);
    assert!((value(GirderResponse::VerticalShear) - 200.0).abs() < 1e-9);
}

/// Statics: a second train that enters stays off the rail as long as the first needs all of it, so that the first alone
/// governs: the reaction at either end is its 100 kN. Without room to leave, it was 81 kN at the far end.
#[test]
fn trains_that_enter_lower_no_extreme() {
    let heavy = Train {
        enters: true,
        ..train(&[(0.0, 100.0)])
    };
    let light = Train {
        enters: true,
        ..train(&[(0.0, 1.0)])
    };
    let found = single_wheels(vec![heavy.clone(), light.clone()], 2.0, true);
    assert_eq!(found.effects.len(), 2);
    // behind the first by two metres, the second adds to the reaction ahead of it alone: 1 (10 - 2)/10
    for (effect, known) in found.effects.iter().zip([100.8, 100.0]) {
        assert!((effect[0].value - known).abs() < 1e-9, "{effect:?}");
        assert!(effect[1].value.abs() < 1e-9, "{effect:?}");
    }
    // a train as long as the rail leaves the other one no place on it
    let long = train(&[(0.0, 100.0), (10.0, 100.0)]);
    for order in [[&long, &light], [&light, &long]] {
        let found = single_wheels(order.map(Clone::clone).to_vec(), 2.0, false);
        for effect in &found.effects {
            assert!((effect[0].value - 100.0).abs() < 1e-9, "{effect:?}");
        }
    }
}

/// Statics: a wheel at the tip of an overhang has its load as the shear just before it, whether or not the train may go
/// on beyond the rail; and at the first support its reaction just behind it.
#[test]
fn a_wheel_that_enters_counts_at_the_ends_of_its_rail() {
    let (structure, request) = beam(6.0, 2.0);
    for enters in [true, false] {
        let case = TrainCase {
            trains: vec![Train {
                enters,
                ..train(&[(0.0, 100.0)])
            }],
            ..TrainCase::default()
        };
        let found = envelopes(&structure, &DeadLoads::default(), &[case], &request)
            .expect("the train fits")
            .remove(0);
        for x in [0.0, 8.0] {
            let own = found.envelopes.iter().find(|e| {
                e.is_max && e.quantity == GirderResponse::VerticalShear && e.governing.x == x
            });
            let value = own.expect("the end is a place").governing.value;
            assert!((value - 100.0).abs() < 1e-9, "{enters} {x}: {value}");
        }
    }
}
