//! The bound of the rounding of a grid: never below the error, not far above it, and never below the roundings that
//! every computation of the grid makes.
//!
//! It shows at places that hardly move although the ends of their member do: the load is there a difference of terms far
//! larger than itself.

use crate::common;

use common::probes;
use faer::fx128 as Wide;
use fea::{
    CrossSection, Error, FactoredFrame, GroundSpring, Member, Model, Rail, RailSegment, RigidLink,
    Support,
};
use splines::Axis;

/// Largest relative error of one rounding of a double.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// Largest |error of G_ij| / sqrt(G_ii G_jj) of the grid at the places `at`, and its bound.
fn compare(model: &Model, rail: &Rail, at: &[f64], exact: impl Fn(f64, f64) -> Wide) -> (f64, f64) {
    let frame = FactoredFrame::new(model, std::slice::from_ref(rail)).expect("sound");
    let grid = frame.grid(&probes(Axis::Vertical, at)).expect("certified");
    let mut worst = 0.0_f64;
    for (i, &x) in at.iter().enumerate() {
        for (j, &z) in at.iter().enumerate() {
            let error = (Wide::from(grid.value[(i, j)]) - exact(x, z)).0.abs();
            worst = worst.max(error / exact(x, x).0.sqrt() / exact(z, z).0.sqrt());
        }
    }
    (worst, grid.certificate.error_bound)
}

/// A beam of length 2.3 whose last end carries an arm of length a that is pinned at the origin; the rail runs over the
/// beam and in the gap beyond it, up to a second beam.
fn arm(a: f64, ei: f64) -> (Model, Rail) {
    let section = CrossSection {
        e: 1.0,
        g: 1.0,
        area: 1.0,
        iy: ei,
        iz: ei,
        j: ei,
        ..CrossSection::default()
    };
    let up = [0.0, 1.0, 0.0];
    let model = Model {
        points: vec![
            [-a - 2.3, 0.0, 0.0],
            [-a, 0.0, 0.0],
            [0.0; 3],
            [a, 0.0, 0.0],
            [a + 1.0, 0.0, 0.0],
        ],
        sections: vec![section],
        members: vec![Member::beam([0, 1], 0, up), Member::beam([3, 4], 0, up)],
        supports: vec![
            Support {
                point: 0,
                fixed: [true; 6],
            },
            Support {
                point: 2,
                fixed: [true, true, true, true, true, false],
            },
            Support {
                point: 3,
                fixed: [true; 6],
            },
        ],
        links: vec![RigidLink { from: 1, to: 2 }],
        up,
        ..Model::default()
    };
    let segments = [0, 1]
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .to_vec();
    (
        model,
        Rail {
            axis: [1.0, 0.0, 0.0],
            segments,
            ..Rail::default()
        },
    )
}

/// Analytic: the arm turns by one per moment k = EI (12 a^2 + 12 a l + 4 l^2)/l^3, and the rail at x from the pin moves
/// by x times that. In doubles the place is known to a rounding of a, in double-doubles to one of their own.
#[test]
fn bound_of_a_rail_that_turns_about_a_pin_is_never_below_its_error_and_sharp() {
    let (a, ei) = (0.3, 1.7);
    let (model, rail) = arm(a, ei);
    let wide = Wide::from;
    // The length of the beam is that between the points, whose coordinates are rounded.
    let l = wide(model.points[1][0]) - wide(model.points[0][0]);
    let own = wide(a);
    let k = wide(ei) * (wide(12.0) * own * (own + l) + wide(4.0) * l * l) / (l * l * l);
    let exact = |x: f64, z: f64| wide(x) * wide(z) / k;
    // Coefficients of many places are left in doubles up to a bound of 1e-12.
    let mut attained = 0.0_f64;
    for size in [1e-1, 3e-2, 1e-2] {
        let at: Vec<f64> = (0..17)
            .map(|k| -size / (1.0 + f64::from(k) / 16.0))
            .collect();
        let (error, bound) = compare(&model, &rail, &at, exact);
        assert!(
            error <= bound && bound < 1e-12,
            "{size}: {error:.1e}, bound {bound:.1e}"
        );
        assert!(
            bound > f64::EPSILON * a / size,
            "{size}: {error:.1e}, bound {bound:.1e}"
        );
        attained = attained.max(error / bound);
    }
    assert!(attained > 1.0 / 200.0, "{attained}");
    // Nearer to the pin double-doubles keep all digits, then as many as they have left.
    let mut last = 0.0;
    for power in [2, 6, 10, 14, 18, 20] {
        let size = 10f64.powi(-power);
        let at: Vec<f64> = (1..9).map(|k| -size / (1.0 + 0.1 * f64::from(k))).collect();
        let (error, bound) = compare(&model, &rail, &at, exact);
        assert!(error <= bound, "{size}: {error:.1e}, bound {bound:.1e}");
        assert!(
            power > 10 || bound < 2e-15,
            "{size}: {error:.1e}, bound {bound:.1e}"
        );
        // The last digit of a double-double of the size a is 2^-106 a.
        let least = a / size * 2f64.powi(-106);
        assert!(
            bound > least && bound >= last,
            "{size}: {bound:.1e}, at least {least:.1e}"
        );
        last = bound;
    }
    // Where no digit of the accuracy asked for is left, the places are refused.
    let frame = FactoredFrame::new(&model, &[rail]).expect("sound");
    let found = frame.grid(&probes(Axis::Vertical, &[-1e-24]));
    assert!(
        matches!(found, Err(Error::IllConditioned { bound, .. }) if bound > 1e-6),
        "{found:?}"
    );
}

/// Analytic: a beam from -a to b, 1/EI = c, whose first end carries an arm pinned below the origin, on a spring k at its
/// last end. Bending moment (1 - x/b) s - <s - x>, force x/b in the spring: near the pin only the bending of the short
/// end and the rest of the turning move the rail.
#[test]
fn bound_of_a_beam_that_turns_about_a_pin_is_never_below_its_error_and_sharp() {
    let (a, b, stiffness) = (0.3, 9.7, 1.3);
    let mut attained = 0.0_f64;
    for c in [3e-4, 1e-4, 3e-5] {
        let iz = 1.0 / c;
        let section = CrossSection {
            e: 1.0,
            g: 1.0,
            area: 1.0,
            iy: 1.0,
            iz,
            j: 1.0,
            ..CrossSection::default()
        };
        let up = [0.0, 1.0, 0.0];
        let model = Model {
            points: vec![[-a, 0.0, 0.0], [0.0; 3], [b, 0.0, 0.0]],
            sections: vec![section],
            members: vec![Member::beam([0, 2], 0, up)],
            supports: vec![
                Support {
                    point: 1,
                    fixed: [true, true, true, true, true, false],
                },
                Support {
                    point: 2,
                    fixed: [false, false, true, true, true, false],
                },
            ],
            springs: vec![GroundSpring {
                point: 2,
                dof: fea::Dof::Uy,
                stiffness,
            }],
            links: vec![RigidLink { from: 0, to: 1 }],
            up,
            ..Model::default()
        };
        let rail = Rail {
            axis: [1.0, 0.0, 0.0],
            segments: vec![RailSegment {
                member: 0,
                offset: [0.0; 3],
            }],
            ..Rail::default()
        };
        let wide = Wide::from;
        let flexibility = wide(1.0) / wide(iz);
        let (a, b) = (wide(a), wide(b));
        let third = wide(1.0) / wide(3.0);
        let exact = |x: f64, z: f64| {
            let (x, z) = (wide(x.min(z)), wide(x.max(z)));
            let half = wide(0.5);
            // Integrals of s^2, of s <s - x>, and of <s - x> <s - z> up to b.
            let cube = |u: Wide| u * u * u * third;
            let one = |x: Wide| cube(b - x) + half * x * (b - x) * (b - x);
            let both = cube(b - z) + half * (z - x) * (b - z) * (b - z);
            let (r, q) = (wide(1.0) - x / b, wide(1.0) - z / b);
            let bent = r * q * (cube(b) + cube(a)) - r * one(z) - q * one(x) + both;
            flexibility * bent + x * z / (b * b * wide(stiffness))
        };
        // Where the spring moves the rail about as much as bending does.
        let size = 9.7 * (0.3_f64.powi(3) * c * stiffness / 3.0).sqrt();
        let at: Vec<f64> = (0..17)
            .map(|k| size * (0.3 + 0.05 * f64::from(k) + 0.001))
            .collect();
        let (error, bound) = compare(&model, &rail, &at, exact);
        assert!(
            error <= bound && bound < 1e-12,
            "{c}: {error:.1e}, bound {bound:.1e}"
        );
        // A load on the turning is a difference of two terms of the size a. Place, cubic and arm round each of them ten
        // times, and the error acts on the compliance 1/(k b^2) of the turning.
        let x = at[0];
        let turning = 1.0 / (9.7 * stiffness.sqrt());
        let least = 2.0 * 10.0 * UNIT * 2.0 * 0.3 * turning / exact(x, x).0.sqrt();
        assert!(
            bound > least,
            "{c}: {error:.1e}, bound {bound:.1e}, at least {least:.1e}"
        );
        attained = attained.max(error / bound);
    }
    assert!(attained > 1.0 / 200.0, "{attained}");
}

/// Analytic: E I, its reciprocal, the length and the value are rounded. Green's function of a beam with clamped ends at
/// midspan is a difference of terms that are 3 and 2 times as large, each of which is rounded ten times.
#[test]
fn bound_is_never_below_the_roundings_that_every_grid_makes() {
    let (model, rail) = arm(0.3, 1.7);
    let frame = FactoredFrame::new(&model, &[rail]).expect("sound");
    let bound = |x: f64| {
        frame
            .grid(&probes(Axis::Vertical, &[x]))
            .expect("sound")
            .certificate
            .error_bound
    };
    assert!(
        bound(-1e-3) > 3.0 * UNIT && bound(-1e-3) < 10.0 * UNIT,
        "{:e}",
        bound(-1e-3) / UNIT
    );
    // The second beam is clamped at both ends.
    let (mut model, rail) = arm(0.3, 1.7);
    model.supports.push(Support {
        point: 4,
        fixed: [true; 6],
    });
    let frame = FactoredFrame::new(&model, &[rail]).expect("sound");
    let bound = |x: f64| {
        frame
            .grid(&probes(Axis::Vertical, &[x]))
            .expect("sound")
            .certificate
            .error_bound
    };
    let middle = bound(0.8);
    assert!(
        middle > (3.0 + 5.0 * 10.0) * UNIT && middle < 5.0 * 40.0 * UNIT,
        "{:e}",
        middle / UNIT
    );
}

/// Identity: points that are numbered ahead of a structure and do not belong to it change no bound.
#[test]
fn bound_does_not_depend_on_the_numbers_of_the_points() {
    let (model, rail) = arm(0.3, 1.7);
    let mut later = model.clone();
    let ahead = 6;
    later.points = (0..ahead)
        .map(|k| [f64::from(k), 5.0, 0.0])
        .chain(model.points.iter().copied())
        .collect();
    let by = ahead as usize;
    later
        .members
        .iter_mut()
        .for_each(|member| member.points = member.points.map(|point| point + by));
    later
        .supports
        .iter_mut()
        .for_each(|support| support.point += by);
    later
        .links
        .iter_mut()
        .for_each(|link| (link.from, link.to) = (link.from + by, link.to + by));
    later.supports.extend((0..by).map(|point| Support {
        point,
        fixed: [true; 6],
    }));
    let at: Vec<f64> = (0..17)
        .map(|k| -0.02 / (1.0 + f64::from(k) / 16.0))
        .collect();
    let [first, second] = [&model, &later].map(|model| {
        let frame = FactoredFrame::new(model, std::slice::from_ref(&rail)).expect("sound");
        frame.grid(&probes(Axis::Vertical, &at)).expect("certified")
    });
    let bounds = [&first, &second].map(|grid| grid.certificate.error_bound);
    assert!((bounds[0] / bounds[1] - 1.0).abs() < 1e-12, "{bounds:?}");
    assert!((first.value - &second.value).amax() < 1e-12 * second.value.amax());
}

/// Identity: a place that cannot move has no error, and adds nothing to the bound of the others.
#[test]
fn a_place_on_a_clamped_end_adds_nothing_to_the_bound() {
    let (model, rail) = arm(0.3, 1.7);
    let clamped = model.points[0][0];
    let frame = FactoredFrame::new(&model, &[rail]).expect("sound");
    let mut at: Vec<f64> = (0..17)
        .map(|k| -0.02 / (1.0 + f64::from(k) / 16.0))
        .collect();
    let without = frame
        .grid(&probes(Axis::Vertical, &at))
        .expect("certified")
        .certificate
        .error_bound;
    at.push(clamped);
    let with = frame.grid(&probes(Axis::Vertical, &at)).expect("certified");
    assert_eq!(with.value[(17, 17)], 0.0);
    assert!(
        (with.certificate.error_bound / without - 1.0).abs() < 1e-12,
        "{with:?}",
        with = with.certificate
    );
}

/// An oblique beam with clamped ends, released in bending about its local z axis at the point 0 or 1, as a member from
/// point 0 to 1 or from 1 to 0. The rail runs from point 0 to 1.
fn released(at: usize, is_reversed: bool) -> (Model, Rail) {
    let section = CrossSection {
        e: 1.3,
        g: 0.7,
        area: 2.0,
        iy: 0.9,
        iz: 1.1,
        j: 0.4,
        ..CrossSection::default()
    };
    let mut member = Member::beam(
        if is_reversed { [1, 0] } else { [0, 1] },
        0,
        [0.0, 1.0, 0.0],
    );
    member.releases[at ^ usize::from(is_reversed)] = [false, false, false, false, true, true];
    let model = Model {
        points: vec![[0.0; 3], [3.1, 1.7, 0.9]],
        sections: vec![section],
        members: vec![member],
        supports: [0, 1]
            .map(|point| Support {
                point,
                fixed: [true; 6],
            })
            .to_vec(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let segments = vec![RailSegment {
        member: 0,
        offset: [-0.17, 0.31, 0.0],
    }];
    (
        model,
        Rail {
            axis: [3.1, 1.7, 0.9],
            segments,
            ..Rail::default()
        },
    )
}

/// Identity: a beam is the same beam when its ends are numbered the other way round: it has the same bound.
#[test]
fn bound_of_a_released_beam_does_not_depend_on_the_order_of_its_ends() {
    let length = (3.1_f64 * 3.1 + 1.7 * 1.7 + 0.9 * 0.9).sqrt();
    for (axis, end) in [
        (Axis::Vertical, 0),
        (Axis::Vertical, 1),
        (Axis::Lateral, 0),
        (Axis::Lateral, 1),
    ] {
        for fraction in [0.1, 0.25, 0.4, 0.6, 0.9] {
            // Coefficients of many places are left in doubles.
            let at = probes(axis, &[fraction * length; 17]);
            let [one, other] = [false, true].map(|is_reversed| {
                let (model, rail) = released(end, is_reversed);
                FactoredFrame::new(&model, &[rail])
                    .expect("sound")
                    .grid(&at)
                    .expect("certified")
            });
            let bounds = [&one, &other].map(|grid| grid.certificate.error_bound);
            assert!(
                bounds[0] > 100.0 * UNIT && bounds[0] < 1e-12,
                "{axis:?} {fraction}: {bounds:?}"
            );
            assert!(
                (bounds[0] / bounds[1] - 1.0).abs() < 1e-9,
                "{axis:?} {fraction}: {bounds:?}"
            );
            if axis == Axis::Lateral {
                continue;
            }
            // Vertical coefficients of few places are in double-doubles; their ends add what exceeds four roundings.
            let beyond = [false, true].map(|is_reversed| {
                let (model, rail) = released(end, is_reversed);
                let grid = FactoredFrame::new(&model, &[rail])
                    .expect("sound")
                    .grid(&at[..1]);
                grid.expect("certified").certificate.error_bound / (4.0 * UNIT) - 1.0
            });
            assert!(
                beyond[0] > 1e-11 && beyond[0] < 1e-7,
                "{axis:?} {fraction}: {beyond:?}"
            );
            assert!(
                (beyond[0] / beyond[1] - 1.0).abs() < 1e-4,
                "{axis:?} {fraction}: {beyond:?}"
            );
            let apart = (one.value[(0, 0)] / other.value[(0, 0)] - 1.0).abs();
            assert!(
                apart < bounds[0] + bounds[1],
                "{axis:?} {fraction}: {apart:e}"
            );
        }
    }
}
