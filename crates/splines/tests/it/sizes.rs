//! Green's function of a clamped member, and the sizes of its terms by which rounding errors are bounded, against
//! closed forms and the laws that hold for every beam.

use crate::beam;

use std::sync::Arc;

use beam::{Beam, chain, coupled, probe};
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Couplings, Differentiable, ElementResidual, Error, ExactSurface, Flexibility,
    Influence, InfluenceLines, Probe, RailElement, RailShapes, Rails, ResidualFlexibility,
    RoundingSizes, Uncoupled,
};

/// One element from 0 to `length`, its rail at `offset` from the axis.
fn rails(length: f64, offset: [f64; 3], flexibility: Flexibility) -> Rails {
    Rails::new(chain(&[0.0, length], offset, flexibility)).expect("a sound element")
}

/// Sizes at the fraction s of the element, where places and axes are exact.
fn sizes(rails: &Rails, axis: Axis, s: f64) -> RoundingSizes {
    rails.rounding_sizes(0, axis, [s, 1.0 - s], [0.0; 2], true)
}

/// Analytic: under a force at a, nearer to the first end, the reactions V = b^2 (l + 2 a)/l^3 and m0 = a b^2/l^2 give
/// the deflection c (m0 a^2/2 - V a^3/6) = c a^3 b^3/(3 l^3). The sum of both terms is c a^3 b^2 (2 l + a)/(3 l^3).
#[test]
fn sizes_of_bending_are_the_sums_of_the_terms_of_its_closed_form() {
    let (l, c) = (8.0, 0.3);
    let rails = rails(
        l,
        [0.0; 3],
        Flexibility {
            bending_z: c,
            bending_y: 2.0 * c,
            ..Flexibility::default()
        },
    );
    for s in [0.0, 0.1, 0.3, 0.5, 0.55, 0.8, 0.97] {
        let near = l * f64::min(s, 1.0 - s);
        let far = l - near;
        let size = c * near.powi(3) * far.powi(2) * (2.0 * l + near) / (3.0 * l.powi(3));
        let value = c * (near * far).powi(3) / (3.0 * l.powi(3));
        for (axis, factor) in [(Axis::Vertical, 1.0), (Axis::Lateral, 2.0)] {
            let found = sizes(&rails, axis, s).green;
            assert!(
                (found - factor * size).abs() <= 1e-14 * size,
                "{axis:?} {s}: {found}, not {size}"
            );
            let own = rails.clamped_green(0, s * l, s * l)[axis.component()][axis.component()];
            assert!(
                (own - factor * value).abs() <= 1e-13 * value,
                "{axis:?} {s}: {own}, not {value}"
            );
        }
    }
}

/// Analytic: at midspan V = 1/2 and m0 = l/8 whatever the shear, so that the terms are g l/4 and 5 c l^3/192. A rail at
/// height h makes a force along it a moment h; with k = c l^2/(c l^2 + 12 g) its terms are h^2 c l (4 + 5 k)/16, and
/// the bar adds l/(4 EA). Across it the rail adds the twist h^2 l/(4 GJ).
#[test]
fn sizes_at_midspan_have_their_closed_forms_with_shear_twist_and_arms() {
    let (l, h) = (5.0, 0.7);
    let f = Flexibility {
        axial: 0.02,
        torsion: 0.05,
        bending_y: 0.4,
        bending_z: 0.3,
        shear_y: 0.11,
        shear_z: 0.23,
        tension: 0.0,
    };
    let rails = rails(l, [0.0, h, 0.0], f);
    let force = |c: f64, g: f64| 5.0 * c * l.powi(3) / 192.0 + g * l / 4.0;
    let stiff = f.bending_z * l * l / (f.bending_z * l * l + 12.0 * f.shear_y);
    let along = h * h * f.bending_z * l * (4.0 + 5.0 * stiff) / 16.0 + f.axial * l / 4.0;
    let expected = [
        (Axis::Vertical, force(f.bending_z, f.shear_y)),
        (
            Axis::Lateral,
            force(f.bending_y, f.shear_z) + h * h * f.torsion * l / 4.0,
        ),
        (Axis::Longitudinal, along),
    ];
    for (axis, size) in expected {
        let found = sizes(&rails, axis, 0.5).green;
        assert!(
            (found / size - 1.0).abs() < 1e-14,
            "{axis:?}: {found}, not {size}"
        );
    }
}

/// Identity: no value exceeds the sum of its terms, nor do values of two places the geometric mean of theirs, in both
/// halves of a member and from either end.
#[test]
fn no_value_exceeds_the_size_of_its_terms() {
    let rails = Arc::clone(coupled().rails());
    let [first, last] = rails.range(0).expect("a rail");
    let (mut closest, mut places) = (f64::INFINITY, 0);
    for k in 1..40 {
        let x = first + (last - first) * f64::from(k) / 40.0;
        for axis in Axis::ALL {
            let row = rails.row(probe(axis, x)).expect("on the rail");
            let [from, to] = rails.elements()[row.element].x;
            let fractions = [(x - from) / (to - from), (to - x) / (to - from)];
            let sizes = rails.rounding_sizes(row.element, axis, fractions, [0.0; 2], true);
            let a = axis.component();
            let own = rails.clamped_green(row.element, x, x)[a][a];
            assert!(
                own <= sizes.green * (1.0 + 1e-13),
                "{axis:?} at {x}: {own:e} and {:e}",
                sizes.green
            );
            if own > 0.0 {
                closest = closest.min(sizes.green / own);
                places += 1;
            }
            for (&index, &value) in row.indices().iter().zip(row.values()) {
                let state = usize::from(index / 6 != rails.elements()[row.element].ends[0]);
                let size = sizes.row[6 * state + index % 6];
                assert!(
                    value.abs() <= size * (1.0 + 1e-13),
                    "{axis:?} at {x}: {value:e} and {size:e}"
                );
            }
        }
    }
    // Near an end shear and the bar leave one term of one sign; nothing larger is claimed than what is summed.
    assert!(closest < 2.0 && places > 50, "{closest} at {places} places");
}

/// The coupled element above, measured in units of length that are `unit` times as small.
fn scaled(unit: f64) -> Rails {
    let (s, t) = (0.6, 0.8);
    let element = RailElement {
        rail: 0,
        x: [2.0 * unit, 10.0 * unit],
        ends: [0, 1],
        length: 10.0 * unit,
        frame: [[t, s, 0.0], [-s * t, t * t, s], [s * s, -s * t, t]],
        offset: [0.1 * unit, 3.0 * unit, 0.5 * unit],
        flexibility: Flexibility {
            axial: 0.7,
            torsion: 0.9 / (unit * unit),
            bending_y: 0.4 / (unit * unit),
            bending_z: 0.1 / (unit * unit),
            shear_y: 0.3,
            shear_z: 0.2,
            tension: 0.0,
        },
        member: None,
    };
    Rails::new(vec![element]).expect("a sound element")
}

/// Identity: in units of length that are half as long every displacement per force is twice the number, and so is every
/// sum of its terms. Powers of two change no digit.
#[test]
fn sizes_and_values_change_with_the_unit_of_length_as_displacements_do() {
    let (one, other) = (scaled(1.0), scaled(2.0));
    for k in 0..=16 {
        let s = f64::from(k) / 16.0;
        for axis in Axis::ALL {
            let (a, b) = (sizes(&one, axis, s), sizes(&other, axis, s));
            assert_eq!(2.0 * a.green, b.green, "{axis:?} at {s}");
            for dof in 0..12 {
                // Displacements by displacements have no unit; those by rotations are lengths.
                let factor = if dof % 6 < 3 { 1.0 } else { 2.0 };
                assert_eq!(factor * a.row[dof], b.row[dof], "{axis:?} at {s}, {dof}");
            }
            for z in [0.0, 0.25, 0.5, 0.875] {
                let [x, z] = [s, z].map(|s| 2.0 + 8.0 * s);
                let (a, b) = (
                    one.clamped_green(0, x, z),
                    other.clamped_green(0, 2.0 * x, 2.0 * z),
                );
                assert_eq!(a.map(|row| row.map(|value| 2.0 * value)), b);
            }
        }
    }
}

/// Identity: Green's function of single values and that with derivatives are the same function, for loads that are
/// forces, moments, thrusts and twists at once, at both halves, at the middle and at equal distances from both ends.
#[test]
fn green_functions_with_and_without_derivatives_agree() {
    let rails = scaled(1.0);
    let places: Vec<f64> = (0..=16).map(|k| 2.0 + 0.5 * f64::from(k)).collect();
    for &x in &places {
        for &z in &places {
            let green = rails.clamped_green(0, x, z);
            let own = |x: f64, a: usize| rails.clamped_green(0, x, x)[a][a];
            for p in Axis::ALL {
                for q in Axis::ALL {
                    let (a, b) = (p.component(), q.component());
                    let rows =
                        [probe(p, x), probe(q, z)].map(|at| rails.row(at).expect("on the rail"));
                    let found = rails.clamped_between(&rows[0], &rows[1]);
                    let size = (own(x, a) * own(z, b)).sqrt();
                    assert!(
                        (found - green[a][b]).abs() <= 1e-13 * size,
                        "{p:?} {x} {q:?} {z}: {found:e}"
                    );
                }
            }
        }
    }
}

/// Identity: a nodal compliance acts by its symmetric part, every entry of it, and is refused for a single one that is
/// not a number.
#[test]
fn nodal_compliance_acts_by_its_symmetric_part() {
    let line = Arc::new(rails(
        10.0,
        [0.2, 1.0, -0.3],
        Flexibility {
            bending_z: 0.1,
            ..Flexibility::default()
        },
    ));
    let given = DMatrix::from_fn(12, 12, |i, j| (1 + 3 * i + 5 * j + i * j) as f64);
    let half = (&given + given.transpose()) * 0.5;
    let surface = ExactSurface::new(Arc::clone(&line), given.clone()).expect("numbers");
    assert_eq!(surface.nodal(), &half);
    for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
        let mut spoiled = given.clone();
        spoiled[(i, j)] = f64::NAN;
        let (row, column) = (i.min(j), i.max(j));
        assert_eq!(
            ExactSurface::new(Arc::clone(&line), spoiled).err(),
            Some(Error::NodalNumber { row, column })
        );
    }
}

/// What a compliance reports of itself beside its values.
fn reported(of: &dyn Compliance) -> (bool, Vec<f64>, Option<[f64; 2]>, Vec<f64>) {
    (of.is_symmetric(), of.breaks(0), of.range(0), of.breaks(1))
}

/// Identity: an exact surface is symmetric, and what is left of it has its symmetry, its elements and its extent.
#[test]
fn remainders_of_a_surface_report_its_symmetry_elements_and_extent() {
    let surface = Beam::paper().surface(&[-15.0, 0.0, 60.0, 75.0]);
    let expected = (
        true,
        vec![-15.0, 0.0, 60.0, 75.0],
        Some([-15.0, 75.0]),
        Vec::new(),
    );
    let line = Arc::clone(surface.rails());
    let shapes = RailShapes::new(line, DMatrix::from_element(24, 1, 1e-5)).expect("six a state");
    let parted: Vec<Box<dyn Compliance>> = vec![
        Box::new(surface.clone()),
        Box::new(Uncoupled::new(surface.clone(), Couplings::None)),
        Box::new(ResidualFlexibility::new(surface.clone(), shapes)),
        Box::new(ElementResidual::new(surface.clone(), vec![[1e3, 0.0]; 3])),
    ];
    for of in &parted {
        assert_eq!(reported(of.as_ref()), expected);
        let at = [-3.0, 20.0, 47.0].map(|x| probe(Axis::Vertical, x));
        let mut out = Influence::zeros(3);
        of.fill(&at, &mut out).expect("on the rail");
        assert_eq!(out.value, out.value.transpose());
    }
}

/// Analytic: a clamped member under the load w per length deflects by w x^2 (l - x)^2/(24 EI) and stores half of
/// w^2 l^5/(720 EI). Without this motion the compliance at midspan is l^3/EI (1/192 - 720/384^2).
#[test]
fn clamped_member_without_its_deflection_under_uniform_load_has_its_closed_form() {
    let (l, c) = (12.0_f64, 0.3);
    let flexibility = Flexibility {
        bending_z: c,
        bending_y: 3.0 * c,
        ..Flexibility::default()
    };
    let whole = ExactSurface::new(
        Arc::new(rails(l, [0.0; 3], flexibility)),
        DMatrix::zeros(12, 12),
    )
    .expect("an element with both ends held");
    let square = |c: f64| 720.0 / (c * l.powi(5));
    let left = ElementResidual::new(whole.clone(), vec![[square(c), square(3.0 * c)]]);
    let at: Vec<Probe> = [Axis::Vertical, Axis::Lateral]
        .iter()
        .flat_map(|&axis| [0.25 * l, 0.5 * l].map(|x| probe(axis, x)))
        .collect();
    let (mut all, mut out) = (Influence::zeros(4), Influence::zeros(4));
    whole.fill(&at, &mut all).expect("on the rail");
    left.fill(&at, &mut out).expect("on the rail");
    let shape = |x: f64| x * x * (l - x).powi(2) / 24.0;
    let slope = |x: f64| x * (l - x) * (l - 2.0 * x) / 12.0;
    for (i, p) in at.iter().enumerate() {
        for (j, q) in at.iter().enumerate() {
            let c = if i < 2 { c } else { 3.0 * c };
            let part = if p.axis == q.axis {
                c * c * square(c) * shape(q.x)
            } else {
                0.0
            };
            let value = all.value[(i, j)] - part * shape(p.x);
            assert!(
                (out.value[(i, j)] - value).abs() < 1e-13 * c * l.powi(3),
                "{p:?} {q:?}"
            );
            let value = all.slope[(i, j)] - part * slope(p.x);
            assert!(
                (out.slope[(i, j)] - value).abs() < 1e-13 * c * l * l,
                "{p:?} {q:?}"
            );
        }
    }
    let middle = c * l.powi(3) * (1.0 / 192.0 - 720.0 / 384_f64.powi(2));
    assert!(
        (out.value[(1, 1)] / middle - 1.0).abs() < 1e-12,
        "{:e}",
        out.value[(1, 1)]
    );
}

/// Analytic: a bar between held ends, f a (l - b)/l for a <= b, along its rail; with its derivatives, whose jump under
/// the load is given by the mean of both sides.
#[test]
fn bar_between_held_ends_has_its_closed_form_along_the_rail() {
    let (l, f) = (7.0, 0.3);
    let rails = Arc::new(rails(
        l,
        [0.0; 3],
        Flexibility {
            axial: f,
            ..Flexibility::default()
        },
    ));
    let bar = ExactSurface::new(rails, DMatrix::zeros(12, 12)).expect("both ends held");
    let along = |x: f64| probe(Axis::Longitudinal, x);
    for (x, z) in [
        (1.0, 2.5),
        (2.5, 1.0),
        (6.0, 0.5),
        (3.0, 3.0),
        (0.0, 4.0),
        (6.9, 6.95),
    ] {
        let mut out = Influence::zeros(2);
        bar.fill(&[along(x), along(z)], &mut out)
            .expect("on the rail");
        let (a, b) = (f64::min(x, z), f64::max(x, z));
        assert!(
            (out.value[(0, 1)] - f * a * (l - b) / l).abs() < 1e-15,
            "{x} {z}"
        );
        let slope = |own: f64, other: f64| match own.total_cmp(&other) {
            std::cmp::Ordering::Less => f * (l - other) / l,
            std::cmp::Ordering::Greater => -f * other / l,
            std::cmp::Ordering::Equal => 0.5 * f * (l - 2.0 * other) / l,
        };
        let found = bar.partials(along(x), along(z)).expect("on the rail");
        for (found, expected) in [
            (out.slope[(0, 1)], slope(x, z)),
            (found.p, slope(x, z)),
            (found.q, slope(z, x)),
            (found.pq, -f / l),
            (found.pp, 0.0),
            (found.qq, 0.0),
        ] {
            assert!(
                (found - expected).abs() < 1e-15,
                "{x} {z}: {found}, not {expected}"
            );
        }
    }
}

/// A direction in which a node state has no stiffness is refused by values and by derivatives, beside a rail on the axis
/// and above it.
#[test]
fn states_without_stiffness_are_refused_by_values_and_derivatives() {
    let flexibility = Flexibility {
        bending_z: 0.1,
        bending_y: 0.2,
        torsion: 0.3,
        axial: 0.4,
        ..Flexibility::default()
    };
    for offset in [[0.0; 3], [0.3, 1.0, -0.5]] {
        let mut nodal = DMatrix::identity(12, 12);
        nodal[(7, 7)] = f64::INFINITY;
        let line = Arc::new(rails(10.0, offset, flexibility));
        let surface =
            ExactSurface::new(line, nodal).expect("an infinite diagonal entry is allowed");
        let at = probe(Axis::Vertical, 4.0);
        let refused = Error::NoStiffness {
            rail: 0,
            x: 4.0,
            axis: Axis::Vertical,
        };
        assert_eq!(
            surface.fill(&[at], &mut Influence::zeros(1)),
            Err(refused.clone())
        );
        assert_eq!(surface.partials(at, at).err(), Some(refused));
        let side = probe(Axis::Lateral, 4.0);
        assert_eq!(
            surface.fill(&[side], &mut Influence::zeros(1)),
            Ok(()),
            "sideways it is held"
        );
    }
}

#[test]
fn influence_lines_count_their_effects() {
    let line = Arc::new(rails(
        8.0,
        [0.0; 3],
        Flexibility {
            bending_z: 1.0,
            ..Flexibility::default()
        },
    ));
    for count in [0, 1, 3] {
        let lines = InfluenceLines::new(
            Arc::clone(&line),
            DMatrix::zeros(count, 12),
            vec![None; count],
        );
        let lines = lines.expect("zeros");
        assert_eq!((lines.len(), lines.is_empty()), (count, count == 0));
        let mut out = vec![1.0; count];
        lines
            .fill(probe(Axis::Vertical, 3.0), &mut out)
            .expect("on the rail");
        assert!(out.iter().all(|effect| *effect == 0.0));
        let wrong = Error::EffectShape {
            rows: count + 1,
            columns: 1,
            expected: [count, 1],
        };
        assert_eq!(
            lines.fill(probe(Axis::Vertical, 3.0), &mut vec![0.0; count + 1]),
            Err(wrong)
        );
    }
}
