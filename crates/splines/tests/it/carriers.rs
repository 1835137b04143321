//! Several rails on one member, and influence lines of their loads, against closed forms.

use crate::beam;

use std::sync::Arc;

use beam::STRAIGHT;
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Differentiable, ElementMember, Error, ExactSurface, Flexibility,
    ForceComponent, Influence, InfluenceLines, InternalForce, Probe, RailElement, Rails,
};

const LENGTH: f64 = 10.0;

/// A rail element on a member of length 10 that is flexible in bending, shear, torsion and axially.
fn cell(rail: usize, ends: [usize; 2], offset: [f64; 3]) -> RailElement {
    RailElement {
        rail,
        x: [0.0, LENGTH],
        ends,
        length: LENGTH,
        frame: STRAIGHT,
        offset,
        flexibility: Flexibility {
            axial: 1e-7,
            torsion: 3e-6,
            bending_y: 5e-6,
            bending_z: 1e-6,
            shear_y: 2e-6,
            shear_z: 1e-6,
            tension: 0.0,
        },
        member: Some(ElementMember {
            id: 4,
            reversed: false,
        }),
    }
}

/// The same element seen from its other end: x starts there, y points up, z to the other side.
fn turned(cell: &RailElement) -> RailElement {
    let [x, y, z] = cell.offset;
    RailElement {
        offset: [-x, y, -z],
        member: Some(ElementMember {
            id: 4,
            reversed: true,
        }),
        ..cell.clone()
    }
}

/// Both ends of every element are held.
fn clamped(cells: Vec<RailElement>) -> ExactSurface {
    let line = Rails::new(cells).expect("sound cells");
    let size = 6 * line.state_count();
    ExactSurface::new(Arc::new(line), DMatrix::zeros(size, size)).expect("zeros")
}

fn probes(rail: usize, at: &[f64]) -> Vec<Probe> {
    Axis::ALL
        .iter()
        .flat_map(|&axis| at.iter().map(move |&x| Probe { rail, x, axis }))
        .collect()
}

fn filled(surface: &ExactSurface, at: &[Probe]) -> Influence {
    let mut out = Influence::zeros(at.len());
    surface.fill(at, &mut out).expect("on the rails");
    out
}

const PLACES: [f64; 4] = [1.0, 3.5, 5.0, 8.0];

#[test]
fn two_rails_in_one_place_are_one_rail_to_the_last_bit() {
    let offset = [0.2, 0.9, 0.4];
    let both = clamped(vec![cell(0, [0, 1], offset), cell(1, [2, 3], offset)]);
    let own = filled(&both, &probes(0, &PLACES));
    let mixed: Vec<Probe> = probes(0, &PLACES)
        .iter()
        .enumerate()
        .map(|(k, p)| Probe { rail: k % 2, ..*p })
        .collect();
    let mixed = filled(&both, &mixed);
    assert!(own.value == mixed.value && own.slope == mixed.slope);
}

#[test]
fn a_rail_read_backwards_is_the_same_rail() {
    let first = cell(0, [0, 1], [0.2, 0.9, 0.4]);
    let second = RailElement {
        rail: 1,
        ends: [2, 3],
        ..turned(&first)
    };
    let both = clamped(vec![first, second]);
    let ahead = probes(0, &PLACES);
    // Longitudinal and lateral change sign, and so do slopes.
    let mixed: Vec<Probe> = ahead
        .iter()
        .enumerate()
        .map(|(k, p)| {
            if k % 2 == 0 {
                *p
            } else {
                Probe {
                    rail: 1,
                    x: LENGTH - p.x,
                    ..*p
                }
            }
        })
        .collect();
    let (own, mixed) = (filled(&both, &ahead), filled(&both, &mixed));
    let sign = |k: usize| {
        if k % 2 == 1 && ahead[k].axis != Axis::Vertical {
            -1.0
        } else {
            1.0
        }
    };
    let way = |k: usize| if k % 2 == 1 { -1.0 } else { 1.0 };
    for i in 0..ahead.len() {
        for j in 0..ahead.len() {
            let (value, slope) = (
                mixed.value[(i, j)] * sign(i) * sign(j),
                mixed.slope[(i, j)] * sign(i) * sign(j),
            );
            assert!(
                (own.value[(i, j)] - value).abs() < 1e-15 * own.value.amax(),
                "({i}, {j})"
            );
            assert!(
                (own.slope[(i, j)] - slope * way(i)).abs() < 1e-15 * own.slope.amax(),
                "slope ({i}, {j})"
            );
        }
    }
    assert!(mixed.value == mixed.value.transpose());
}

/// Identity: a single element whose member runs against it gives the same surface, in plane bending too (the
/// fast path).
#[test]
fn a_member_that_runs_against_its_only_element_changes_nothing() {
    let own = cell(0, [0, 1], [0.0; 3]);
    let back = RailElement {
        member: Some(ElementMember {
            id: 4,
            reversed: true,
        }),
        ..own.clone()
    };
    let at: Vec<Probe> = probes(0, &PLACES)
        .into_iter()
        .filter(|p| p.axis == Axis::Vertical)
        .collect();
    for at in [at, probes(0, &PLACES)] {
        let [own, back] = [&own, &back].map(|cell| filled(&clamped(vec![cell.clone()]), &at));
        let defect = (&own.value - &back.value).amax() / own.value.amax();
        assert!(defect < 1e-14, "{defect:e}");
        assert!((&own.slope - &back.slope).amax() < 1e-14 * own.slope.amax());
        assert!(back.value == back.value.transpose());
    }
}

/// Identity: second derivatives keep their sign when a rail is read backwards, slopes change it.
#[test]
fn derivatives_of_a_rail_read_backwards_change_the_sign_of_slopes_alone() {
    let first = cell(0, [0, 1], [0.2, 0.9, 0.4]);
    let second = RailElement {
        rail: 1,
        ends: [2, 3],
        ..turned(&first)
    };
    let both = clamped(vec![first, second]);
    for p in probes(0, &[1.0, 5.0]) {
        for q in probes(0, &[3.5, 5.0, 8.0]) {
            let own = both.partials(p, q).expect("on the rail");
            let turned = both
                .partials(
                    p,
                    Probe {
                        rail: 1,
                        x: LENGTH - q.x,
                        ..q
                    },
                )
                .expect("on the rail");
            let sign = if q.axis == Axis::Vertical { 1.0 } else { -1.0 };
            let pairs = [
                (own.value, turned.value),
                (own.p, turned.p),
                (own.q, -turned.q),
                (own.pp, turned.pp),
                (own.pq, -turned.pq),
                (own.qq, turned.qq),
            ];
            for (own, turned) in pairs {
                assert!(
                    (own - sign * turned).abs() < 1e-18,
                    "{p:?} {q:?} {own:e} {turned:e}"
                );
            }
        }
    }
}

#[test]
fn elements_of_other_members_are_independent_of_the_load() {
    let mut other = cell(1, [2, 3], [0.0; 3]);
    for carrier in [
        None,
        Some(ElementMember {
            id: 5,
            reversed: false,
        }),
    ] {
        other.member = carrier;
        let both = clamped(vec![cell(0, [0, 1], [0.0; 3]), other.clone()]);
        let at = [probes(0, &[4.0]), probes(1, &[4.0])].concat();
        let value = filled(&both, &at).value;
        assert!(
            value.view((0, 3), (3, 3)).amax() == 0.0 && value[(1, 1)] > 0.0 && value[(4, 4)] > 0.0
        );
    }
}

#[test]
fn elements_of_one_member_that_differ_are_refused() {
    let good = cell(0, [0, 1], [0.0; 3]);
    let longer = RailElement {
        rail: 1,
        length: 11.0,
        ..good.clone()
    };
    let softer = RailElement {
        rail: 1,
        flexibility: Flexibility::default(),
        ..good.clone()
    };
    for wrong in [longer, softer] {
        let found = Rails::new(vec![good.clone(), wrong]).err();
        assert_eq!(
            found,
            Some(Error::ElementMember {
                first: 0,
                second: 1
            })
        );
    }
}

/// Internal force of the clamped member at a section: with ends held, `ends` is minus the balance on the
/// first end.
fn held(line: Rails, place: f64, component: ForceComponent) -> InfluenceLines {
    let balance = component.balance(place * LENGTH);
    let ends = std::array::from_fn(|k| if k < 6 { -balance[k] } else { 0.0 });
    let rows = DMatrix::zeros(1, 6 * line.state_count());
    let section = InternalForce {
        member: 4,
        place,
        component,
        ends,
    };
    InfluenceLines::new(Arc::new(line), rows, vec![Some(section)]).expect("sound")
}

/// Source: fixed-end moments a b^2/L^2 and shears b^2 (3 a + b)/L^3 of a beam without shear.
#[test]
fn clamped_member_carries_fixed_end_moments_and_shears() {
    let mut own = cell(0, [0, 1], [0.0; 3]);
    own.flexibility.shear_y = 0.0;
    let back = RailElement {
        rail: 1,
        ends: [2, 3],
        ..turned(&own)
    };
    let line = Rails::new(vec![own, back]).expect("sound cells");
    let read = |component, place, probe| {
        let mut out = [0.0];
        held(line.clone(), place, component)
            .fill(probe, &mut out)
            .expect("on the rails");
        out[0]
    };
    for a in [2.0, 5.0, 7.5] {
        let b = LENGTH - a;
        for probe in [
            Probe {
                rail: 0,
                x: a,
                axis: Axis::Vertical,
            },
            Probe {
                rail: 1,
                x: b,
                axis: Axis::Vertical,
            },
        ] {
            let (moment, shear) = (a * b * b / 1e2, b * b * (3.0 * a + b) / 1e3);
            assert!((read(ForceComponent::BendingZ, 0.0, probe) - moment).abs() < 1e-13);
            assert!((read(ForceComponent::ShearY, 0.0, probe) - shear).abs() < 1e-13);
            // Beyond the load the shear is smaller by the load; at the load, by half of it.
            assert!((read(ForceComponent::ShearY, 1.0, probe) - shear + 1.0).abs() < 1e-13);
            assert!((read(ForceComponent::ShearY, a / LENGTH, probe) - shear + 0.5).abs() < 1e-13);
            let far = a * a * b / 1e2;
            assert!((read(ForceComponent::BendingZ, 1.0, probe) - far).abs() < 1e-13);
        }
    }
}

#[test]
fn unusable_effects_are_refused() {
    let line = Arc::new(Rails::new(vec![cell(0, [0, 1], [0.0; 3])]).expect("sound"));
    let made = |rows, sections| InfluenceLines::new(Arc::clone(&line), rows, sections);
    let shape = |rows, columns, expected| Error::EffectShape {
        rows,
        columns,
        expected,
    };
    assert_eq!(
        made(DMatrix::zeros(1, 12), vec![]).err(),
        Some(shape(1, 12, [0, 12]))
    );
    assert_eq!(
        made(DMatrix::zeros(1, 6), vec![None]).err(),
        Some(shape(1, 6, [1, 12]))
    );
    let beyond = InternalForce {
        member: 4,
        place: 1.1,
        component: ForceComponent::Axial,
        ends: [0.0; 12],
    };
    let found = made(DMatrix::zeros(2, 12), vec![None, Some(beyond)]).err();
    assert_eq!(found, Some(Error::EffectNumber { effect: 1 }));
    let nan = made(DMatrix::from_element(1, 12, f64::NAN), vec![None]).err();
    assert_eq!(nan, Some(Error::EffectNumber { effect: 0 }));
    let good = made(DMatrix::from_element(1, 12, f64::INFINITY), vec![None]).expect("sound");
    let at = |rail, x| Probe {
        rail,
        x,
        axis: Axis::Vertical,
    };
    assert_eq!(
        good.fill(at(0, 1.0), &mut [0.0; 2]).err(),
        Some(shape(2, 1, [1, 1]))
    );
    assert_eq!(
        good.fill(at(1, 1.0), &mut [0.0]).err(),
        Some(Error::NoRail { rail: 1 })
    );
    assert_eq!(
        good.fill(at(0, 11.0), &mut [0.0]).err(),
        Some(Error::OffRail { rail: 0, x: 11.0 })
    );
    let loose = Error::NoStiffness {
        rail: 0,
        x: 1.0,
        axis: Axis::Vertical,
    };
    assert_eq!(good.fill(at(0, 1.0), &mut [0.0]).err(), Some(loose));
    assert!(good.len() == 1 && !good.is_empty());
}
