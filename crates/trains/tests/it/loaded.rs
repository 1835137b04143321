//! Trains on members under axial force: closed forms, and states that are evaluated one by one.

use std::f64::consts::PI;

use crate::common::{self, train};
use fea::{BeamTheory, Effect, FactoredFrame, ForceComponent, Girder, Model, Rail};
use splines::{Axis, Probe};
use trains::{
    CaseEnvelopes, DeadLoads, GirderResponse, Governing, Request, SpanExtreme, Structure,
    TrainCase, TrainWheel, envelopes,
};

fn wheel(x: f64, vertical: f64, lateral: f64) -> TrainWheel {
    TrainWheel {
        lateral,
        ..common::wheel(x, vertical)
    }
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

/// The girder with the axial force n in all its members.
fn loaded(girder: &Girder, n: f64) -> (Model, Rail) {
    let (mut model, rail) = girder.model_and_rail().expect("the girder is valid");
    model
        .members
        .iter_mut()
        .for_each(|member| member.tension = n);
    (model, rail)
}

/// Timoshenko and Gere (1961), section 1.3: under F at mid-span the deflection is F l^3/(48 EI) 3 (tan u - u)/u^3 and the
/// moment F l/4 tan(u)/u, u = (pi/2) sqrt(P/P_E), and the hyperbolic functions in tension; both are largest there.
#[test]
fn one_wheel_on_a_simple_beam() {
    let (l, ei, f) = (6.0, 5.0, 3.0);
    let girder = Girder {
        spans: vec![l],
        e: ei,
        i_vertical: 1.0,
        ..Girder::default()
    };
    for ratio in [0.1, 0.5, 0.9, -1.0, -10.0] {
        let n = -ratio * PI * PI * ei / (l * l);
        let (model, rail) = loaded(&girder, n);
        let structure = Structure::new(&model, &[rail], false).expect("the girder is stable");
        let case = TrainCase {
            trains: vec![train(vec![wheel(0.0, f, 0.0)])],
            ..TrainCase::default()
        };
        let request = Request {
            spans: vec![vec![0.0, l]],
            ..Request::default()
        };
        let found = envelopes(&structure, &DeadLoads::default(), &[case], &request)
            .expect("it fits")
            .remove(0);
        let u = 0.5 * PI * f64::abs(ratio).sqrt();
        let tangent = if ratio > 0.0 { u.tan() } else { u.tanh() };
        let deflection = f * l.powi(3) / (48.0 * ei) * 3.0 * (tangent - u).abs() / u.powi(3);
        let moment = 0.25 * f * l * tangent / u;
        for (quantity, known) in [
            (GirderResponse::VerticalDeflection, deflection),
            (GirderResponse::VerticalMoment, moment),
        ] {
            let found = extreme(&found, 1, quantity, true);
            let value = found.governing.value;
            assert!(
                (value / known - 1.0).abs() < 1e-9,
                "{quantity:?} at {ratio}: {value}, not {known}"
            );
            assert!((found.governing.x - 0.5 * l).abs() < 1e-4, "{found:?}");
            assert!(
                found.bound >= value && found.bound - value <= 1e-9 * value,
                "{found:?}"
            );
        }
    }
}

/// A structure whose states are evaluated one by one, exactly, by the frame.
struct Reference<'a> {
    model: &'a Model,
    frame: FactoredFrame,
    /// Coordinates of the ends of the members.
    ends: Vec<f64>,
    gravity: f64,
}

impl Reference<'_> {
    /// A response at x, `beside` the coordinate by a negligible distance, to loads (coordinate, downwards, along +z).
    fn value(&self, quantity: GirderResponse, x: f64, loads: &[(f64, f64, f64)]) -> f64 {
        let both = |load: &(f64, f64, f64)| {
            [
                (Axis::Vertical, load.0, -load.1),
                (Axis::Lateral, load.0, load.2),
            ]
        };
        let all = loads
            .iter()
            .flat_map(both)
            .filter(|(_, _, force)| *force != 0.0);
        let (at, forces): (Vec<Probe>, Vec<f64>) = all
            .map(|(axis, x, force)| (Probe { rail: 0, x, axis }, force))
            .unzip();
        let sum = |of: &dyn Fn(usize) -> f64| {
            forces
                .iter()
                .enumerate()
                .map(|(k, f)| f * of(k))
                .sum::<f64>()
        };
        let weight = self.frame.weight(self.model, [0.0, -self.gravity, 0.0]);
        let deflection = match quantity {
            GirderResponse::VerticalDeflection => Some((Axis::Vertical, -1.0)),
            GirderResponse::LateralDeflection => Some((Axis::Lateral, 1.0)),
            _ => None,
        };
        if let Some((axis, sign)) = deflection {
            let own = Probe { rail: 0, x, axis };
            let all: Vec<Probe> = at.iter().copied().chain([own]).collect();
            let grid = self.frame.grid(&all).expect("all is resisted").value;
            let mut dead = self
                .frame
                .displacements_of_weight(&weight, &[own])
                .expect("it is on the rail")[0];
            // the deflection of the member itself between held ends
            let line = self.frame.line().expect("there is a rail");
            let (_, [along_y, _]) = line.uniform_load(own).expect("it is on the rail");
            dead -= self.gravity * self.model.sections[0].mass * along_y[0];
            return sign * (sum(&|k| grid[(k, all.len() - 1)]) + dead);
        }
        let (component, sign) = match quantity {
            GirderResponse::VerticalShear => (ForceComponent::ShearY, -1.0),
            GirderResponse::LateralShear => (ForceComponent::ShearZ, 1.0),
            GirderResponse::VerticalMoment => (ForceComponent::BendingZ, 1.0),
            GirderResponse::LateralMoment => (ForceComponent::BendingY, 1.0),
            GirderResponse::Torsion => (ForceComponent::Torsion, 1.0),
            _ => (ForceComponent::Axial, 1.0),
        };
        let member = self
            .ends
            .windows(2)
            .position(|ends| x < ends[1])
            .unwrap_or(self.ends.len() - 2);
        let [from, to] = [self.ends[member], self.ends[member + 1]];
        let place = ((x - from) / (to - from)).clamp(0.0, 1.0);
        let effect = Effect::InternalForce {
            member,
            place,
            component,
        };
        let live = self
            .frame
            .effects(self.model, &[effect], &at)
            .expect("all is resisted");
        let dead = self
            .frame
            .effects_of_weight(self.model, &weight, &[effect])
            .expect("it exists")[0];
        sign * (sum(&|k| live[(0, k)]) + dead)
    }
}

const STEP: f64 = 1e-9;

/// Two spans and an overhang with shear, lateral bending and a high rail, under compression and under tension: what governs
/// has its value when evaluated by itself, and no state of a dense sample is beyond the enclosure.
#[test]
fn extremes_enclose_all_states() {
    let girder = Girder {
        spans: vec![6.0, 7.5],
        overhangs: [0.0, 1.5],
        rail_height: 0.3,
        ..small_girder()
    };
    let wheels = vec![wheel(0.0, 180.0, 12.0), wheel(2.0, 140.0, -9.0)];
    for n in [-1500.0, 2500.0] {
        let (model, rail) = loaded(&girder, n);
        let structure = Structure::new(&model, std::slice::from_ref(&rail), false).expect("stable");
        let error = structure.error_of_lines().expect("there is a rail");
        assert!(error > 0.0 && error <= 1e-9, "{error}");
        let case = TrainCase {
            trains: vec![train(wheels.clone())],
            dead: 1.0,
            ..TrainCase::default()
        };
        let dead = DeadLoads {
            gravity: 9.81,
            lines: Vec::new(),
        };
        let request = Request {
            spans: vec![vec![0.0, 6.0, 13.5]],
            places: vec![vec![2.2, 9.1]],
            ..Request::default()
        };
        let found = envelopes(&structure, &dead, &[case], &request)
            .expect("it fits")
            .remove(0);
        let frame = FactoredFrame::new(&model, &[rail]).expect("stable");
        let reference = Reference {
            model: &model,
            frame,
            ends: vec![0.0, 6.0, 13.5, 15.0],
            gravity: 9.81,
        };
        let loads = |position: f64| -> Vec<(f64, f64, f64)> {
            wheels
                .iter()
                .map(|w| (position + w.x, w.vertical, w.lateral))
                .collect()
        };
        let at_state = |quantity: GirderResponse, state: &Governing| {
            let position = state.trains[0].position;
            // The wheels may stand just before or just behind the section, which may be the end of a member.
            let near = |x: f64, step: f64, most: f64| {
                [-step, 0.0, step].map(|by| (x + by).clamp(0.0, most))
            };
            let sections = near(state.x, STEP, 15.0);
            let positions = near(position, 2.0 * STEP, 13.0);
            let all = sections.map(|x| positions.map(|p| reference.value(quantity, x, &loads(p))));
            all.into_iter().flatten().collect::<Vec<f64>>()
        };
        let mut sizes = std::collections::BTreeMap::new();
        for e in &found.extremes {
            let size: &mut f64 = sizes.entry(e.quantity).or_default();
            *size = size.max(e.governing.value.abs());
        }
        for e in found.extremes.iter().filter(|e| sizes[&e.quantity] > 1e-9) {
            let size = sizes[&e.quantity];
            let values = at_state(e.quantity, &e.governing);
            let off = values
                .iter()
                .map(|v| (v - e.governing.value).abs() / size)
                .fold(f64::INFINITY, f64::min);
            assert!(off < 2e-9, "{n}: off by {off:e}: {e:?}, {values:?}");
            let open = (e.bound - e.governing.value).abs() / size;
            assert!(open <= 1e-9, "{n}: open by {open:e}: {e:?}");
        }
        for e in found
            .envelopes
            .iter()
            .filter(|e| sizes.get(&e.quantity).is_some_and(|size| *size > 1e-9))
        {
            let values = at_state(e.quantity, &e.governing);
            let off = values
                .iter()
                .map(|v| (v - e.governing.value).abs())
                .fold(f64::INFINITY, f64::min);
            assert!(off < 2e-9 * sizes[&e.quantity], "{n}: {e:?}, {values:?}");
        }
        let spans = [[0.0, 6.0], [6.0, 13.5], [13.5, 15.0]];
        for quantity in &GirderResponse::ALL[2..] {
            for (span, [from, to]) in spans.iter().enumerate() {
                let [most, least] =
                    [true, false].map(|is_max| extreme(&found, span + 1, *quantity, is_max).bound);
                let slack = 2e-9 * sizes[quantity];
                for section in 0..=12 {
                    let x = (from + (to - from) * f64::from(section) / 12.0)
                        .clamp(from + 1e-6, to - 1e-6);
                    for k in 0..=26 {
                        let value = reference.value(*quantity, x, &loads(0.5 * f64::from(k)));
                        assert!(
                            value <= most + slack && value >= least - slack,
                            "{quantity:?} {x} {k}: {value}"
                        );
                    }
                }
            }
        }
    }
}

/// Two trains on one rail: the bounds hold for states drawn at random, and what governs has its value.
#[test]
fn extremes_of_two_trains_hold() {
    let girder = Girder {
        spans: vec![6.0, 7.5],
        e: 2.1e8,
        i_vertical: 5e-4,
        ..Girder::default()
    };
    let (model, rail) = loaded(&girder, -2500.0);
    let structure = Structure::new(&model, std::slice::from_ref(&rail), false).expect("stable");
    let one = || train(vec![wheel(0.0, 100.0, 0.0), wheel(1.5, 80.0, 0.0)]);
    let case = TrainCase {
        trains: vec![one(), one()],
        gap: 0.5,
        ..TrainCase::default()
    };
    let request = Request {
        spans: vec![vec![0.0, 6.0, 13.5]],
        ..Request::default()
    };
    let found = envelopes(&structure, &DeadLoads::default(), &[case], &request)
        .expect("it fits")
        .remove(0);
    let frame = FactoredFrame::new(&model, &[rail]).expect("stable");
    let reference = Reference {
        model: &model,
        frame,
        ends: vec![0.0, 6.0, 13.5],
        gravity: 0.0,
    };
    let mut random = fastrand::Rng::with_seed(11);
    let quantities = [
        GirderResponse::VerticalShear,
        GirderResponse::VerticalMoment,
        GirderResponse::VerticalDeflection,
    ];
    for _ in 0..3000 {
        let first = 10.0 * random.f64();
        let second = first + 2.0 + (10.0 - first) * random.f64();
        if second > 12.0 {
            continue;
        }
        let loads = [
            (first, 100.0, 0.0),
            (first + 1.5, 80.0, 0.0),
            (second, 100.0, 0.0),
            (second + 1.5, 80.0, 0.0),
        ];
        let x = 13.5 * random.f64();
        for quantity in quantities {
            let value = reference.value(quantity, x, &loads);
            let span = if x < 6.0 { 1 } else { 2 };
            let [most, least] =
                [true, false].map(|is_max| extreme(&found, span, quantity, is_max).bound);
            let slack = 1e-8 * most.abs().max(least.abs());
            assert!(
                value <= most + slack && value >= least - slack,
                "{quantity:?} {x}: {value}"
            );
        }
    }
    let largest = |q: GirderResponse| {
        let same = found.extremes.iter().filter(|e| e.quantity == q);
        same.map(|e| e.governing.value.abs()).fold(0.0, f64::max)
    };
    for e in found
        .extremes
        .iter()
        .filter(|e| quantities.contains(&e.quantity))
    {
        let open = (e.bound - e.governing.value).abs() / largest(e.quantity);
        assert!(open < 1e-9, "{e:?}");
    }
}

fn small_girder() -> Girder {
    Girder {
        spans: vec![5.0, 4.0],
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.0198),
        i_vertical: 5.768e-4,
        i_lateral: Some(1.08e-4),
        j: Some(3.6e-6),
        ka_vertical: Some(0.007),
        ka_lateral: Some(0.012),
        mass_per_length: Some(0.155),
        theory: BeamTheory::Timoshenko,
        ..Girder::default()
    }
}

fn solved(model: &Model, rails: &[Rail], dead: &DeadLoads) -> CaseEnvelopes {
    let structure = Structure::new(model, rails, false).expect("stable");
    let wheels = vec![wheel(0.0, 180.0, 12.0), wheel(1.2, 140.0, -9.0)];
    let case = TrainCase {
        trains: vec![train(wheels)],
        dead: 1.0,
        ..TrainCase::default()
    };
    let request = Request {
        spans: vec![vec![0.0, 5.0, 9.0]],
        places: vec![vec![2.2, 5.0, 7.1]],
        ..Request::default()
    };
    envelopes(&structure, dead, &[case], &request)
        .expect("it fits")
        .remove(0)
}

/// Identity: a load along the rail at the height of the axis is the weight of the girder.
#[test]
fn load_along_the_rail_is_the_weight() {
    let (model, rail) = loaded(&small_girder(), -2000.0);
    let rails = [rail];
    let weight = solved(
        &model,
        &rails,
        &DeadLoads {
            gravity: 10.0,
            lines: Vec::new(),
        },
    );
    let line = solved(
        &model,
        &rails,
        &DeadLoads {
            gravity: 0.0,
            lines: vec![1.55],
        },
    );
    for (a, b) in weight.envelopes.iter().zip(&line.envelopes) {
        let size = 1e-9
            * weight
                .envelopes
                .iter()
                .filter(|e| e.quantity == a.quantity)
                .map(|e| e.governing.dead.abs())
                .fold(1e-12, f64::max);
        assert!(
            (a.governing.dead - b.governing.dead).abs() < 3.0 * size,
            "{a:?}, not {b:?}"
        );
    }
}

/// Identity: extremes do not depend on the direction in which members run.
#[test]
fn members_that_run_backwards_change_nothing() {
    let (model, rail) = loaded(&small_girder(), -2000.0);
    let mut backwards = model.clone();
    backwards.members[1].points.reverse();
    let dead = DeadLoads {
        gravity: 10.0,
        lines: Vec::new(),
    };
    let [one, other] =
        [&model, &backwards].map(|model| solved(model, std::slice::from_ref(&rail), &dead));
    for (a, b) in one.extremes.iter().zip(&other.extremes) {
        let size = one
            .extremes
            .iter()
            .filter(|e| e.quantity == a.quantity)
            .map(|e| e.governing.value.abs())
            .fold(1e-9, f64::max);
        assert!(
            (a.governing.value - b.governing.value).abs() < 2e-9 * size,
            "{a:?}, not {b:?}"
        );
    }
    assert_eq!(one.extremes.len(), other.extremes.len());
}
