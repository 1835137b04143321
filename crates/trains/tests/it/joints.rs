//! Ends of members and of rails, and members that slope: closed forms.

use crate::common::{self, train};
use fea::{CrossSection, Dof, Effect, ForceComponent, Member, Model, Rail, RailSegment, Support};
use trains::{
    CaseEnvelopes, DeadLoads, EnvelopeValue, GirderResponse, Request, SpanExtreme, Structure,
    Train, TrainCase, TrainWheel, effects, envelopes,
};

const SECTION: CrossSection = CrossSection {
    e: 2.1e8,
    g: 8.1e7,
    area: 0.02,
    iy: 1e-4,
    iz: 1e-2,
    j: 1e-5,
    shear_y: None,
    shear_z: None,
    mass: 0.157,
};

fn wheel(x: f64, vertical: f64, longitudinal: f64) -> TrainWheel {
    TrainWheel {
        longitudinal,
        ..common::wheel(x, vertical)
    }
}

/// Members one behind another with a rail over them, each with its offset.
fn chain(
    points: &[[f64; 3]],
    orientation: [f64; 3],
    offsets: &[[f64; 3]],
    supports: &[(usize, &[Dof])],
) -> (Model, Rail) {
    let members = 0..offsets.len();
    let model = Model {
        points: points.to_vec(),
        sections: vec![SECTION],
        members: members
            .clone()
            .map(|k| Member::beam([k, k + 1], 0, orientation))
            .collect(),
        supports: supports
            .iter()
            .map(|&(point, held)| Support {
                point,
                fixed: Dof::ALL.map(|dof| held.contains(&dof)),
            })
            .collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let segment = |member| RailSegment {
        member,
        offset: offsets[member],
    };
    let rail = Rail {
        origin: offsets[0],
        axis: [1.0, 0.0, 0.0],
        segments: members.map(segment).collect(),
        ..Rail::default()
    };
    (model, rail)
}

fn solved(
    (model, rail): &(Model, Rail),
    dead: &DeadLoads,
    train: Train,
    ends: Vec<f64>,
    places: Vec<f64>,
) -> CaseEnvelopes {
    let structure = Structure::new(model, std::slice::from_ref(rail), false);
    let structure = structure.expect("the frame is stable");
    let request = Request {
        spans: vec![ends],
        places: vec![places],
        ..Request::default()
    };
    let case = TrainCase {
        trains: vec![train],
        dead: if dead.is_empty() { 0.0 } else { 1.0 },
        ..TrainCase::default()
    };
    let found = envelopes(&structure, dead, &[case], &request);
    found.expect("the train fits").remove(0)
}

fn extreme(found: &CaseEnvelopes, quantity: GirderResponse, is_max: bool) -> &SpanExtreme {
    let same = |e: &&SpanExtreme| (e.quantity, e.is_max) == (quantity, is_max);
    found
        .extremes
        .iter()
        .find(same)
        .expect("there is one of every quantity")
}

fn envelope(
    found: &CaseEnvelopes,
    x: f64,
    quantity: GirderResponse,
    is_max: bool,
) -> (usize, &EnvelopeValue) {
    let same = |(_, e): &(usize, &EnvelopeValue)| {
        (e.governing.x - x).abs() < 1e-9 && (e.quantity, e.is_max) == (quantity, is_max)
    };
    let all = found.envelopes.iter().enumerate();
    all.into_iter().find(same).expect("the place was asked for")
}

/// A bar with both ends clamped, 4 m along and 3 m up, under its own weight q. The part across it bends it, and the part along
/// it stretches the upper half and shortens the lower one: q cos^2 L^4/384 EI + q sin^2 L^2/8 EA downwards at its middle.
#[test]
fn weight_along_a_sloping_member_stretches_it() {
    let bar = chain(
        &[[0.0; 3], [4.0, 3.0, 0.0]],
        [0.0, 1.0, 0.0],
        &[[0.0; 3]],
        &[(0, &Dof::ALL), (1, &Dof::ALL)],
    );
    let dead = DeadLoads {
        gravity: 10.0,
        lines: Vec::new(),
    };
    let idle = train(vec![wheel(0.0, 0.0, 0.0)]);
    let found = solved(&bar, &dead, idle, vec![0.0, 4.0], vec![2.0]);
    let (q, l) = (10.0 * SECTION.mass, 5.0_f64);
    let known = q * 0.64 * l.powi(4) / (384.0 * SECTION.e * SECTION.iz)
        + q * 0.36 * l.powi(2) / (8.0 * SECTION.e * SECTION.area);
    let sag = extreme(&found, GirderResponse::VerticalDeflection, true);
    assert!(
        (sag.governing.value / known - 1.0).abs() < 1e-9,
        "{sag:?}, not {known}"
    );
    assert!(sag.bound >= sag.governing.value && sag.bound < known * (1.0 + 2e-9));
}

/// A level bar of 4 m under its own weight q, clamped at one end and joined to a fixed point at the other by a release: free to
/// slide and to turn there, the end sinks by q L^4/8EI; a hinge holds it.
#[test]
fn weight_moves_the_released_end_of_a_member() {
    let (q, l) = (10.0 * SECTION.mass, 4.0_f64);
    let ei = SECTION.e * SECTION.iz;
    let free = q * l.powi(4) / (8.0 * ei);
    for (released, known) in [(vec![Dof::Uy, Dof::Rz], free), (vec![Dof::Rz], 0.0)] {
        for end in [0, 1] {
            let (mut model, rail) = chain(
                &[[0.0; 3], [l, 0.0, 0.0]],
                [0.0, 1.0, 0.0],
                &[[0.0, 0.3, 0.0]],
                &[(0, &Dof::ALL), (1, &Dof::ALL)],
            );
            for dof in &released {
                model.members[0].releases[end][*dof as usize] = true;
            }
            let dead = DeadLoads {
                gravity: 10.0,
                lines: Vec::new(),
            };
            let idle = train(vec![wheel(0.0, 0.0, 0.0)]);
            let at = l * end as f64;
            let found = solved(&(model, rail), &dead, idle, vec![0.0, l], vec![at]);
            let (_, own) = envelope(&found, at, GirderResponse::VerticalDeflection, true);
            let value = own.governing.value;
            assert!(
                (value - known).abs() < 1e-9 * free,
                "{value}, not {known}, {released:?} at end {end}"
            );
        }
    }
}

/// The same bar with axes of its section at 45 degrees and a rail 1 m above it. In the plane of each axis it deflects by
/// v = q s^2 (L - s)^2/24 EI, turns by v', and moves along itself by q s (L - s)/2 EA. The rail moves by the rotation times
/// its arm as well, and so along +z where the bar turns about the normal in its vertical plane.
#[test]
fn a_rail_above_a_sloping_member_moves_with_its_rotation() {
    let half = 0.5_f64.sqrt();
    let bar = chain(
        &[[0.0; 3], [4.0, 3.0, 0.0]],
        [-0.6 * half, 0.8 * half, half],
        &[[0.0, 1.0, 0.0]],
        &[(0, &Dof::ALL), (1, &Dof::ALL)],
    );
    let dead = DeadLoads {
        gravity: 10.0,
        lines: Vec::new(),
    };
    let idle = train(vec![wheel(0.0, 0.0, 0.0)]);
    let places = vec![0.5, 1.0, 2.0, 3.0];
    let found = solved(&bar, &dead, idle, vec![0.0, 4.0], places.clone());
    let (q, l) = (10.0 * SECTION.mass, 5.0_f64);
    let stiffness = [SECTION.iz, SECTION.iy].map(|i| SECTION.e * i);
    for x in places {
        let s = x / 0.8;
        // Along local y and z the weight has the parts -0.8 q cos 45 and 0.8 q cos 45.
        let [vy, vz] = [0, 1].map(|k| {
            let load = [-0.8, 0.8][k] * half * q;
            let slope = 2.0 * s * (l - s) * (l - 2.0 * s);
            [(s * (l - s)).powi(2), slope].map(|of| load * of / (24.0 * stiffness[k]))
        });
        let along = -0.6 * q * s * (l - s) / (2.0 * SECTION.e * SECTION.area);
        // y = (u + z)/sqrt 2 and z = (z - u)/sqrt 2 with u = (-0.6, 0.8, 0). The arm times the rotation theta_u about u,
        // u x (0, 1, 0) = (0, 0, -0.6), and about z, (-1, 0, 0).
        let down = -(0.8 * half * (vy[0] - vz[0]) + 0.6 * along);
        let turned = half * (-vz[1] - vy[1]);
        let aside = half * (vy[0] + vz[0]) - 0.6 * turned;
        for (quantity, known) in [
            (GirderResponse::VerticalDeflection, down),
            (GirderResponse::LateralDeflection, aside),
        ] {
            let (_, own) = envelope(&found, x, quantity, true);
            let value = own.governing.value;
            assert!(
                (value - known).abs() < 1e-9 * down.abs().max(aside.abs()),
                "{quantity:?} at {x}: {value}, not {known}"
            );
        }
    }
    for is_max in [true, false] {
        let most = extreme(&found, GirderResponse::LateralDeflection, is_max);
        let beyond = if is_max { 1.0 } else { -1.0 } * (most.bound - most.governing.value);
        assert!((0.0..1e-13).contains(&beyond), "{most:?}");
    }
}

/// Two hinged spans of 6 m under tractions of 12 at 0.5 m above the axis, 3 m apart. The traction on one span leaves
/// the other without moment. With one just before the hinge the other one is at the middle of the second span, where its
/// couple of 6 makes the moment jump from -3 to 3. With both on the second span these are 0 and 6.
#[test]
fn an_envelope_at_a_wheel_has_both_sides_of_a_joint_under_another() {
    let above = [0.0, 0.5, 0.0];
    let mut girder = chain(
        &[[0.0; 3], [6.0, 0.0, 0.0], [12.0, 0.0, 0.0]],
        [0.0, 1.0, 0.0],
        &[above; 2],
        &[
            (0, &[Dof::Ux, Dof::Uy, Dof::Uz, Dof::Rx]),
            (1, &[Dof::Uy, Dof::Uz, Dof::Rx]),
            (2, &[Dof::Uy, Dof::Uz, Dof::Rx]),
        ],
    );
    girder.0.members[0].releases[1][Dof::Rz as usize] = true;
    for (force, known) in [(12.0, [6.0, -3.0]), (-12.0, [3.0, -6.0])] {
        // The last wheel, without load, keeps the second one from the far half of the span.
        let wheels = vec![
            wheel(0.0, 0.0, force),
            wheel(3.0, 0.0, force),
            wheel(5.9, 0.0, 0.0),
        ];
        let ends = vec![0.0, 6.0, 12.0];
        let found = solved(
            &girder,
            &DeadLoads::default(),
            train(wheels),
            ends,
            vec![9.0],
        );
        for (is_max, known) in [true, false].into_iter().zip(known) {
            let (_, own) = envelope(&found, 9.0, GirderResponse::VerticalMoment, is_max);
            let value = own.governing.value;
            assert!((value - known).abs() < 1e-9, "{value}, not {known}");
        }
    }
}

/// Wheels of 100, at least `gap` apart, on a cantilever of 5 m: with one at the tip and the others behind it, each at its
/// least distance, all of them shear the section just behind the last one, which is one position only.
#[test]
fn an_envelope_at_a_wheel_has_trains_that_touch() {
    for (clamped, count, gap) in [(1, 2, 2.0), (1, 3, 1.7), (0, 2, 2.1), (0, 3, 1.3)] {
        let (model, rail) = chain(
            &[[0.0; 3], [5.0, 0.0, 0.0]],
            [0.0, 1.0, 0.0],
            &[[0.0; 3]],
            &[(clamped, &Dof::ALL)],
        );
        let structure = Structure::new(&model, &[rail], false).expect("the bar is stable");
        let from_tip = |x: f64| if clamped == 1 { x } else { 5.0 - x };
        let touching = gap * (count - 1) as f64;
        let mut places = [touching - 0.1, touching].map(from_tip);
        places.sort_by(f64::total_cmp);
        let request = Request {
            spans: vec![vec![0.0, 5.0]],
            places: vec![places.to_vec()],
            ..Request::default()
        };
        let case = TrainCase {
            trains: vec![train(vec![wheel(0.0, 100.0, 0.0)]); count],
            gap,
            ..TrainCase::default()
        };
        let cases = [case];
        let found = envelopes(&structure, &DeadLoads::default(), &cases, &request);
        let found = found.expect("the trains fit").remove(0);
        for (from, wheels) in [(touching - 0.1, count - 1), (touching, count)] {
            let effect = Effect::InternalForce {
                member: 0,
                place: from_tip(from) / 5.0,
                component: ForceComponent::ShearY,
            };
            let named = effects(&structure, &DeadLoads::default(), &cases, &[vec![effect]]);
            let named = named.expect("the trains fit").remove(0).remove(0);
            let most = named
                .map(|of| of.value.abs())
                .into_iter()
                .fold(0.0, f64::max);
            assert!(
                (most - 100.0 * wheels as f64).abs() < 1e-9,
                "{most} in the named section at {from} from the tip"
            );

            let (is_max, sign) = if clamped == 1 {
                (false, -1.0)
            } else {
                (true, 1.0)
            };
            let (_, own) = envelope(
                &found,
                from_tip(from),
                GirderResponse::VerticalShear,
                is_max,
            );
            let (value, known) = (own.governing.value, sign * 100.0 * wheels as f64);
            assert!(
                (value - known).abs() < 1e-9,
                "{value}, not {known} at {from} from the tip"
            );
        }
    }
}

/// A rail 0.5 m above two bars that are hinged to each other: a wheel at the hinge that pushes along the rail with 10 loads
/// the bar on which it stands with a couple of 5, before which the moment is zero and behind which it is the couple.
#[test]
fn a_wheel_at_a_hinge_counts_on_both_sides_of_a_section_there() {
    for (member, end) in [(0, 1), (1, 0)] {
        let (mut model, rail) = chain(
            &[[0.0; 3], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]],
            [0.0, 1.0, 0.0],
            &[[0.0, 0.5, 0.0]; 2],
            &[(0, &Dof::ALL), (2, &Dof::ALL)],
        );
        model.members[member].releases[end][Dof::Rz as usize] = true;
        let structure = Structure::new(&model, &[rail], false).expect("the bars are stable");
        let case = TrainCase {
            trains: vec![train(vec![wheel(0.0, 0.0, 10.0)])],
            ..TrainCase::default()
        };
        let effect = Effect::InternalForce {
            member,
            place: end as f64,
            component: ForceComponent::BendingZ,
        };
        let found = effects(&structure, &DeadLoads::default(), &[case], &[vec![effect]]);
        let found = found.expect("the train fits");
        let mut values = found[0][0].each_ref().map(|of| of.value.abs());
        values.sort_by(f64::total_cmp);
        assert!(
            values[0] < 1e-9 && (values[1] - 5.0).abs() < 1e-9,
            "{values:?} in member {member}"
        );
        let at = found[0][0].iter().find(|of| of.value.abs() > 1.0);
        let at = at.expect("the couple").trains[0].position;
        assert!((at - 2.0).abs() < 1e-9, "{at}");
    }
}

/// A bar that is clamped at one end carries a wheel of 100 at its tip as a shear force of 100 in the section there, or
/// not at all, whichever side of the section the wheel is on; at the clamped end always. It counts whatever the train may
/// go on to.
#[test]
fn a_wheel_at_the_end_of_a_rail_counts_on_both_sides_of_a_section_there() {
    for (clamped, reversed) in [(0, false), (1, false), (0, true), (1, true)] {
        let (mut model, rail) = chain(
            &[[0.0; 3], [2.0, 0.0, 0.0]],
            [0.0, 1.0, 0.0],
            &[[0.0; 3]],
            &[(clamped, &Dof::ALL)],
        );
        if reversed {
            model.members[0].points.reverse();
        }
        let structure = Structure::new(&model, &[rail], false).expect("the bar is stable");
        for enters in [false, true] {
            let case = TrainCase {
                trains: vec![Train {
                    enters,
                    ..train(vec![wheel(0.0, 100.0, 0.0)])
                }],
                ..TrainCase::default()
            };
            let shear = |point: usize| {
                let effect = Effect::InternalForce {
                    member: 0,
                    place: if (point == 1) != reversed { 1.0 } else { 0.0 },
                    component: ForceComponent::ShearY,
                };
                let found = effects(
                    &structure,
                    &DeadLoads::default(),
                    std::slice::from_ref(&case),
                    &[vec![effect]],
                );
                let found = found.expect("the train fits");
                let [most, least] = &found[0][0];
                [most, least].map(|of| (of.value, of.trains[0].position))
            };
            let tip = shear(1 - clamped);
            let sides = tip.map(|(value, _)| value.abs());
            let known = [sides[0].max(sides[1]), sides[0].min(sides[1])];
            assert!(
                (known[0] - 100.0).abs() < 1e-9 && known[1].abs() < 1e-9,
                "{tip:?} at the tip, {clamped} {reversed} {enters}"
            );
            // The force is that which the whole bar has with the wheel there.
            let inside = shear(clamped);
            let largest = |of: [(f64, f64); 2]| if of[0].0 > -of[1].0 { of[0] } else { of[1] };
            let (value, position) = largest(tip);
            let x = 2.0 * (1 - clamped) as f64;
            assert!((position - x).abs() < 1e-12, "{position}");
            assert!((value - largest(inside).0).abs() < 1e-9, "{inside:?}");
        }
    }
}

/// A cantilever of two members of length L under P at the tip of a rail that runs over its axis as far as the first, and b
/// beside it along the second. Over the first member w = P s^2 (6 L - s)/6 EI, and w - w(L) s/L is least at
/// s = L (6 - sqrt 21)/3, however far the second one moves as it twists by P b L/GJ.
#[test]
fn a_chord_ends_on_its_own_side_of_a_step_of_the_rail() {
    let (l, b, p) = (3.0, 0.4, 50.0);
    let points = [[0.0; 3], [l, 0.0, 0.0], [2.0 * l, 0.0, 0.0]];
    for clamped in [0, 2] {
        let beside = [0.0, 0.0, b];
        let mut offsets = [[0.0; 3], beside];
        let mut ends = vec![0.0, l];
        let mut forces = [0.0, p];
        if clamped == 2 {
            offsets.reverse();
            ends = vec![l, 2.0 * l];
            forces.reverse();
        }
        let bar = chain(&points, [0.0, 1.0, 0.0], &offsets, &[(clamped, &Dof::ALL)]);
        let wheels = vec![wheel(0.0, forces[0], 0.0), wheel(2.0 * l, forces[1], 0.0)];
        let found = solved(&bar, &DeadLoads::default(), train(wheels), ends, Vec::new());
        let r = (6.0 - 21.0_f64.sqrt()) / 3.0;
        let known =
            p * l.powi(3) / (6.0 * SECTION.e * SECTION.iz) * (6.0 * r * r - r.powi(3) - 5.0 * r);
        let own = found
            .deflections
            .iter()
            .find(|d| d.quantity == GirderResponse::VerticalDeflection);
        let own = &own.expect("there is a span").governing;
        assert!(
            (own.value / known - 1.0).abs() < 1e-5,
            "{own:?}, not {known}"
        );
        let x = if clamped == 0 { r * l } else { (2.0 - r) * l };
        assert!((own.x - x).abs() < 1e-2 * l, "{own:?}");
    }
}

/// The same cantilever under a line load q on its rail: at the joint the axis is down by 17 q L^4/24 EI, and the rail beside
/// it by q b^2 L^2/GJ more.
#[test]
fn dead_load_deflects_both_sides_of_a_step_of_the_rail() {
    let (l, b, q) = (3.0_f64, 0.4, 10.0);
    let points = [[0.0; 3], [l, 0.0, 0.0], [2.0 * l, 0.0, 0.0]];
    let offsets = [[0.0; 3], [0.0, 0.0, b]];
    let bar = chain(&points, [0.0, 1.0, 0.0], &offsets, &[(0, &Dof::ALL)]);
    let dead = DeadLoads {
        gravity: 0.0,
        lines: vec![q],
    };
    let idle = train(vec![wheel(0.0, 0.0, 0.0)]);
    let found = solved(&bar, &dead, idle, vec![0.0, 2.0 * l], vec![l]);
    let (index, own) = envelope(&found, l, GirderResponse::VerticalDeflection, true);
    let (_, other) = found
        .other_sides
        .iter()
        .find(|(of, _)| *of == index)
        .expect("two members meet");
    let axis = 17.0 * q * l.powi(4) / (24.0 * SECTION.e * SECTION.iz);
    let aside = q * (b * l).powi(2) / (SECTION.g * SECTION.j);
    for (value, known) in [(own.governing.value, axis + aside), (other.value, axis)] {
        assert!((value / known - 1.0).abs() < 1e-9, "{value}, not {known}");
    }
}
