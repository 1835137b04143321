//! The exact surface against closed forms and the force method.

use crate::beam;

use std::sync::Arc;

use beam::{Beam, EI, Effect, Random, STRAIGHT, chain, probe};
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Error, ExactSurface, Flexibility, Influence, Probe, RailElement, Rails,
};

fn fill(surface: &dyn Compliance, at: &[Probe]) -> Influence {
    let mut out = Influence::zeros(at.len());
    surface.fill(at, &mut out).expect("probes on the rail");
    out
}

fn vertical(surface: &dyn Compliance, x: f64, z: f64) -> f64 {
    fill(
        surface,
        &[probe(Axis::Vertical, x), probe(Axis::Vertical, z)],
    )
    .value[(0, 1)]
}

fn largest_error(beam: &Beam, stations: &[f64], pairs: usize) -> f64 {
    let surface = beam.surface(stations);
    let (low, high) = (stations[0], stations[stations.len() - 1]);
    let mut random = Random::new(7);
    let (mut error, mut scale) = (0.0_f64, 0.0_f64);
    for _ in 0..pairs {
        let (x, z) = (random.between(low, high), random.between(low, high));
        let exact = beam.deflection(x, z);
        error = error.max((vertical(&surface, x, z) - exact).abs());
        scale = scale.max(exact.abs());
    }
    error / scale
}

/// Analytic.
#[test]
fn surface_is_exact_at_ten_thousand_pairs_overhangs_included() {
    let error = largest_error(&Beam::paper(), &[-15.0, 0.0, 60.0, 75.0], 10_000);
    assert!(error < 1e-13, "{error:e}");
    let error = largest_error(
        &Beam::paper(),
        &[-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0],
        10_000,
    );
    assert!(error < 1e-13, "{error:e}");
}

/// Analytic: the force method.
#[test]
fn surface_is_exact_for_shear_and_many_spans() {
    let timoshenko = Beam {
        c: 1.0 / EI,
        g: 2.5e-9,
        supports: vec![0.0, 60.0],
    };
    let error = largest_error(&timoshenko, &[-15.0, 0.0, 60.0, 75.0], 2000);
    assert!(error < 1e-13, "{error:e}");
    let spans = Beam {
        c: 1.0 / EI,
        g: 2.5e-9,
        supports: vec![0.0, 20.0, 65.0, 100.0],
    };
    let error = largest_error(&spans, &[-5.0, 0.0, 20.0, 65.0, 100.0, 110.0], 2000);
    assert!(error < 1e-12, "{error:e}");
    let shear = Beam {
        c: 0.0,
        g: 2.5e-9,
        supports: vec![0.0, 20.0, 65.0],
    };
    let error = largest_error(&shear, &[0.0, 20.0, 65.0], 500);
    assert!(error < 1e-13, "{error:e}");
}

/// Closed forms of the simply supported beam: L^3/48 EI + L/4 kGA at midspan.
#[test]
fn midspan_gives_the_textbook_value() {
    let beam = Beam {
        c: 1.0 / EI,
        g: 3e-9,
        supports: vec![0.0, 60.0],
    };
    let expected = 60.0_f64.powi(3) / (48.0 * EI) + 60.0 * 3e-9 / 4.0;
    let got = vertical(&beam.surface(&[0.0, 60.0]), 30.0, 30.0);
    assert!((got / expected - 1.0).abs() < 1e-14, "{got:e} {expected:e}");
}

/// External: independent computations of the paper's girder and of two equal spans.
#[test]
fn surface_reproduces_independent_values() {
    let one = Beam::paper().surface(&[-15.0, 0.0, 60.0, 75.0]);
    let two = Beam {
        c: 1.0 / EI,
        g: 0.0,
        supports: vec![0.0, 60.0, 120.0],
    };
    let two = two.surface(&[0.0, 60.0, 120.0]);
    let cases = [
        (&one, 7.5, 22.5, 4.0570527873985434e-8),
        (&one, 23.5, 23.5, 9.930324788073188e-8),
        (&one, 11.0, 52.3, 1.954720612552384e-8),
        (&one, -7.0, 33.0, -3.6619043870696926e-8),
        (&one, 31.0, 44.0, 7.976598321429928e-8),
        (&two, 30.0, 30.0, 23.0 / 1536.0 * 216_000.0 / EI),
        (&two, 30.0, 90.0, -9.0 / 1536.0 * 216_000.0 / EI),
        (&two, 24.0, 24.0, 7.607052896725441e-8),
        (&two, 15.0, 45.0, 3.1015100914191505e-8),
        (&two, 22.5, 22.5, 7.337977363720949e-8),
        (&two, 22.5, 97.5, -2.2708318695913934e-8),
    ];
    for (surface, x, z, expected) in cases {
        let got = vertical(surface, x, z);
        assert!(
            (got - expected).abs() < 1e-13 * 1.1e-7,
            "G({x}, {z}) = {got:e}, expected {expected:e}"
        );
    }
}

/// Analytic: central differences of the force method.
#[test]
fn slope_is_the_derivative_of_the_surface() {
    let beam = Beam {
        c: 1.0 / EI,
        g: 2e-9,
        supports: vec![0.0, 60.0],
    };
    let surface = beam.surface(&[-15.0, 0.0, 60.0, 75.0]);
    let mut random = Random::new(3);
    for _ in 0..500 {
        let (x, z) = (random.between(-14.0, 74.0), random.between(-14.0, 74.0));
        let out = fill(
            &surface,
            &[probe(Axis::Vertical, x), probe(Axis::Vertical, z)],
        );
        for (i, j, a, b) in [(0, 1, x, z), (1, 0, z, x), (0, 0, x, x), (1, 1, z, z)] {
            let step = 1e-3;
            // Right and left differences are averaged: on the diagonal the slope in shear jumps.
            let exact =
                (beam.deflection(a + step, b) - beam.deflection(a - step, b)) / (2.0 * step);
            if (a - b).abs() > step || a == b {
                assert!(
                    (out.slope[(i, j)] - exact).abs() < 1e-15,
                    "{a} {b}: {:e} {exact:e}",
                    out.slope[(i, j)]
                );
            }
        }
    }
}

/// Analytic: clamped beam with a central load; symmetry is bit for bit.
#[test]
fn clamped_element_has_its_closed_form_and_is_symmetric_to_the_last_bit() {
    let (l, c, g) = (20.0, 1.0 / EI, 4e-10);
    let flexibility = Flexibility {
        bending_z: c,
        shear_y: g,
        bending_y: 3.0 * c,
        torsion: 2e-10,
        axial: 1e-9,
        shear_z: g,
        tension: 0.0,
    };
    let line = Rails::new(chain(&[5.0, 25.0], [0.3, 3.0, -1.0], flexibility)).expect("valid");
    let straight = Rails::new(chain(&[5.0, 25.0], [0.0; 3], flexibility)).expect("valid");
    let middle = straight.clamped_green(0, 15.0, 15.0);
    let bending = l * l * l / 192.0;
    assert!((middle[1][1] / (c * bending + g * l / 4.0) - 1.0).abs() < 1e-14);
    assert!((middle[2][2] / (3.0 * c * bending + g * l / 4.0) - 1.0).abs() < 1e-14);
    assert!((middle[0][0] / (1e-9 * l / 4.0) - 1.0).abs() < 1e-14);
    let mut random = Random::new(11);
    for k in 0..2000 {
        let x = random.between(5.0, 25.0);
        let z = if k % 5 == 0 {
            x
        } else {
            random.between(5.0, 25.0)
        };
        let (there, back) = (line.clamped_green(0, x, z), line.clamped_green(0, z, x));
        for a in 0..3 {
            for b in 0..3 {
                assert_eq!(there[a][b].to_bits(), back[b][a].to_bits());
            }
        }
    }
}

/// Independent computation: a finely divided element, its nodes released one by one, gives the same surface.
/// An inclined member with an offset outside both planes and all flexibilities at once.
#[test]
fn dividing_an_element_changes_nothing() {
    let flexibility = Flexibility {
        axial: 1.1e-9,
        torsion: 2.3e-10,
        bending_y: 5e-11,
        bending_z: 2.4e-11,
        shear_y: 2e-10,
        shear_z: 7e-10,
        tension: 0.0,
    };
    let frame = tilted();
    let offset = [0.4, 3.1, -1.2];
    let make = |stations: &[f64]| {
        let mut cells = chain(stations, offset, flexibility);
        for cell in &mut cells {
            cell.frame = frame;
            cell.length = (cell.x[1] - cell.x[0]) / frame[0][0];
        }
        cells
    };
    // The left end is clamped: C of the cantilever's free end from equilibrium and the section laws alone.
    let places = [0.0, 3.0, 4.5, 9.0, 14.0];
    let cantilever = |stations: &[f64]| {
        let cells = make(stations);
        let arms: Vec<f64> = stations.iter().map(|x| x / frame[0][0]).collect();
        let nodal = cantilever(&arms, &flexibility, frame);
        ExactSurface::new(Arc::new(Rails::new(cells).expect("valid")), nodal).expect("fits")
    };
    let (whole, cut) = (cantilever(&[0.0, 14.0]), cantilever(&places));
    let mut random = Random::new(5);
    for _ in 0..500 {
        let mut at = Vec::new();
        for axis in Axis::ALL {
            at.push(probe(axis, random.between(0.0, 14.0)));
            at.push(probe(axis, random.between(0.0, 14.0)));
        }
        let (a, b) = (fill(&whole, &at), fill(&cut, &at));
        let (value, slope) = (a.value.amax(), a.slope.amax());
        assert!(
            (&a.value - &b.value).amax() < 1e-13 * value,
            "{:e}",
            (&a.value - &b.value).amax() / value
        );
        assert!(
            (&a.slope - &b.slope).amax() < 1e-13 * slope,
            "{:e}",
            (&a.slope - &b.slope).amax() / slope
        );
        assert_eq!(a.value, a.value.transpose());
    }
}

fn tilted() -> [[f64; 3]; 3] {
    let (s, c) = 0.35_f64.sin_cos();
    let (p, q) = 0.6_f64.sin_cos();
    // Rows: a member rising along the rail, then rolled about itself.
    let (x, y, z) = ([c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]);
    let mix = |a: f64, b: f64| std::array::from_fn(|k| a * y[k] + b * z[k]);
    [x, mix(q, p), mix(-p, q)]
}

/// Compliance of places s along a cantilever clamped at s = 0, states in the rail frame: integrals of the
/// section laws, with the lever arm written out.
fn cantilever(s: &[f64], f: &Flexibility, frame: [[f64; 3]; 3]) -> DMatrix<f64> {
    let n = s.len();
    let mut out = DMatrix::zeros(6 * n, 6 * n);
    for i in 0..n {
        for j in 0..n {
            let (a, b) = (s[i].min(s[j]), s[i].max(s[j]));
            let (p, q) = (s[i], s[j]);
            let mut local = DMatrix::<f64>::zeros(6, 6);
            local[(0, 0)] = f.axial * a;
            local[(3, 3)] = f.torsion * a;
            // Integral of (p - t)(q - t) over 0..a, and so on.
            let both = a * a * (3.0 * b - a) / 6.0;
            let (left, right) = (p * a - a * a / 2.0, q * a - a * a / 2.0);
            local[(1, 1)] = f.bending_z * both + f.shear_y * a;
            local[(1, 5)] = f.bending_z * left;
            local[(5, 1)] = f.bending_z * right;
            local[(5, 5)] = f.bending_z * a;
            local[(2, 2)] = f.bending_y * both + f.shear_z * a;
            local[(2, 4)] = -f.bending_y * left;
            local[(4, 2)] = -f.bending_y * right;
            local[(4, 4)] = f.bending_y * a;
            let mut turn = DMatrix::<f64>::zeros(6, 6);
            for r in 0..3 {
                for c in 0..3 {
                    turn[(r, c)] = frame[r][c];
                    turn[(r + 3, c + 3)] = frame[r][c];
                }
            }
            let block = turn.transpose() * local * turn;
            out.view_mut((6 * i, 6 * j), (6, 6)).copy_from(&block);
        }
    }
    out
}

/// Analytic: a rail at height h above the axis moves longitudinally by -h times the slope; both couplings
/// follow.
#[test]
fn rail_above_the_axis_couples_vertical_and_longitudinal() {
    let beam = Beam::paper();
    let plain = beam.surface(&[0.0, 60.0]);
    let h = 3.5;
    let flexibility = Flexibility {
        bending_z: beam.c,
        ..Flexibility::default()
    };
    let line = Rails::new(chain(&[0.0, 60.0], [0.0, h, 0.0], flexibility)).expect("valid");
    let surface = ExactSurface::new(Arc::new(line), plain.nodal().clone()).expect("fits");
    let mut random = Random::new(9);
    for _ in 0..200 {
        let (x, z) = (random.between(0.0, 60.0), random.between(0.0, 60.0));
        let at = [probe(Axis::Vertical, x), probe(Axis::Longitudinal, z)];
        let got = fill(&surface, &at).value;
        let coupling = -h * beam.give(Effect::Force, x, Effect::Moment, z);
        let along = h * h * beam.give(Effect::Moment, z, Effect::Moment, z);
        assert!(
            (got[(0, 1)] - coupling).abs() < 1e-21,
            "{:e} {coupling:e}",
            got[(0, 1)]
        );
        assert!(
            (got[(1, 1)] - along).abs() < 1e-21,
            "{:e} {along:e}",
            got[(1, 1)]
        );
        assert!((got[(0, 0)] - beam.deflection(x, x)).abs() < 1e-20);
    }
}

/// Analytic: a shaft of torsional flexibility t held at both ends, the rail h above it.
#[test]
fn rail_above_the_axis_moves_sideways_by_twist() {
    let (h, t, l) = (3.0, 2e-10, 40.0);
    let flexibility = Flexibility {
        torsion: t,
        ..Flexibility::default()
    };
    let line = Rails::new(chain(&[0.0, l], [0.0, h, 0.0], flexibility)).expect("valid");
    let surface = ExactSurface::new(Arc::new(line), DMatrix::zeros(12, 12)).expect("fits");
    let got = fill(
        &surface,
        &[probe(Axis::Lateral, 10.0), probe(Axis::Lateral, 25.0)],
    );
    let expected = h * h * t * 10.0 * 15.0 / l;
    assert!((got.value[(0, 1)] / expected - 1.0).abs() < 1e-14);
    // The slope jumps under one's own force from h^2 t (l - x)/l to -h^2 t x/l; the result is their mean.
    let mean = 0.5 * h * h * t * (30.0 - 10.0) / l;
    assert!((got.slope[(0, 0)] / mean - 1.0).abs() < 1e-13);
}

/// Smallest eigenvalue of random layouts, relative to the largest.
#[test]
fn surface_is_positive_and_symmetric_to_the_last_bit() {
    let surface = Beam {
        c: 1.0 / EI,
        g: 1e-9,
        supports: vec![0.0, 60.0],
    };
    let surface = surface.surface(&[-15.0, 0.0, 30.0, 60.0, 75.0]);
    let mut random = Random::new(21);
    for n in [2, 4, 8, 16, 24] {
        for _ in 0..200 {
            let at: Vec<Probe> = (0..n)
                .map(|_| probe(Axis::Vertical, random.between(-15.0, 75.0)))
                .collect();
            let value = fill(&surface, &at).value;
            assert_eq!(value, value.transpose());
            let eigenvalues = value.symmetric_eigenvalues();
            assert!(eigenvalues.min() > -1e-14 * eigenvalues.max());
        }
    }
}

fn arm(rail: usize, x: [f64; 2], end: usize) -> RailElement {
    let frame = STRAIGHT;
    RailElement {
        rail,
        x,
        ends: [end, end],
        length: 0.0,
        frame,
        offset: [-0.5, 2.0, 0.0],
        flexibility: Flexibility::default(),
        member: None,
    }
}

/// Analytic: rigid motion of a node state.
#[test]
fn rigid_arm_moves_with_its_state() {
    let line = Rails::new(vec![arm(0, [10.0, 11.0], 0)]).expect("valid");
    let nodal = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![
        1.0, 2.0, 3.0, 4.0, 5.0, 6.0,
    ]));
    let surface = ExactSurface::new(Arc::new(line), nodal).expect("fits");
    let at = [
        probe(Axis::Vertical, 10.75),
        probe(Axis::Longitudinal, 10.0),
        probe(Axis::Lateral, 11.0),
    ];
    let got = fill(&surface, &at);
    // theta x (r, 2, 0), r = x - 10.5: (-2 tz, r tz, 2 tx - r ty).
    assert_eq!(got.value[(0, 0)], 2.0 + 0.25 * 0.25 * 6.0);
    assert_eq!(got.value[(0, 1)], -2.0 * 0.25 * 6.0);
    assert_eq!(got.value[(1, 1)], 1.0 + 4.0 * 6.0);
    assert_eq!(got.value[(2, 2)], 3.0 + 4.0 * 4.0 + 0.25 * 5.0);
    assert_eq!(got.slope[(0, 0)], 0.25 * 6.0);
    assert_eq!(got.slope[(0, 1)], -2.0 * 6.0);
}

#[test]
fn first_listed_element_carries_the_place_where_two_meet() {
    let earlier = Rails::new(vec![arm(0, [0.0, 1.0], 0), arm(0, [1.0, 2.0], 1)]).expect("valid");
    let later = Rails::new(vec![arm(0, [1.0, 2.0], 1), arm(0, [0.0, 1.0], 0)]).expect("valid");
    let at = probe(Axis::Vertical, 1.0);
    assert_eq!(earlier.row(at).map(|row| row.element), Ok(0));
    assert_eq!(later.row(at).map(|row| row.element), Ok(0));
    assert_eq!(later.row(at).expect("on the rail").indices(), &[7, 11]);
    assert_eq!(
        later.row(probe(Axis::Vertical, 0.5)).map(|row| row.element),
        Ok(1)
    );
    assert_eq!(later.breaks(0), vec![0.0, 1.0, 2.0]);
    assert_eq!(later.range(0), Some([0.0, 2.0]));
    assert_eq!(later.range(1), None);
}

#[test]
fn probes_off_the_rail_are_refused() {
    let line = Rails::new(vec![
        arm(3, [0.0, 1.0], 0),
        arm(3, [2.0, 3.0], 1),
        arm(7, [2.0, 3.0], 1),
    ])
    .expect("valid");
    let row = |rail, x| {
        line.row(Probe {
            rail,
            x,
            axis: Axis::Vertical,
        })
        .map(|row| row.element)
    };
    assert_eq!(row(0, 0.5), Err(Error::NoRail { rail: 0 }));
    assert_eq!(row(3, -0.1), Err(Error::OffRail { rail: 3, x: -0.1 }));
    assert_eq!(row(3, 1.5), Err(Error::OffRail { rail: 3, x: 1.5 }));
    assert_eq!(row(3, 3.1), Err(Error::OffRail { rail: 3, x: 3.1 }));
    assert!(matches!(
        row(3, f64::NAN),
        Err(Error::OffRail { rail: 3, .. })
    ));
    assert_eq!(row(3, 3.0 + 1e-13), Ok(1));
    assert_eq!(row(7, 2.5), Ok(2));
}

#[test]
fn missing_stiffness_is_refused_only_where_it_is_needed() {
    let loose = Flexibility {
        axial: f64::INFINITY,
        torsion: f64::INFINITY,
        ..Flexibility::default()
    };
    let row = |offset, axis| {
        let line = Rails::new(chain(&[0.0, 10.0], offset, loose)).expect("valid");
        line.row(probe(axis, 4.0)).map(|_| ())
    };
    let refused = |axis| {
        Err(Error::NoStiffness {
            rail: 0,
            x: 4.0,
            axis,
        })
    };
    assert_eq!(row([0.0; 3], Axis::Vertical), Ok(()));
    assert_eq!(row([0.0; 3], Axis::Lateral), Ok(()));
    assert_eq!(
        row([0.0; 3], Axis::Longitudinal),
        refused(Axis::Longitudinal)
    );
    assert_eq!(row([0.0, 2.0, 0.0], Axis::Vertical), Ok(()));
    assert_eq!(row([0.0, 2.0, 0.0], Axis::Lateral), refused(Axis::Lateral));
    assert_eq!(
        row([0.0, 0.0, 2.0], Axis::Vertical),
        refused(Axis::Vertical)
    );
    let line = Rails::new(chain(&[0.0, 10.0], [0.0, 2.0, 0.0], loose)).expect("valid");
    let kernel = line.clamped_green(0, 4.0, 5.0);
    assert_eq!(
        (kernel[0][0], kernel[2][2], kernel[1][1]),
        (f64::INFINITY, f64::INFINITY, 0.0)
    );
}

#[test]
fn infinite_nodal_compliance_refuses_the_probes_that_need_it() {
    let line =
        Arc::new(Rails::new(chain(&[0.0, 10.0], [0.0; 3], Flexibility::default())).expect("valid"));
    let mut nodal = DMatrix::identity(12, 12);
    nodal[(2, 2)] = f64::INFINITY;
    let surface = ExactSurface::new(line.clone(), nodal.clone()).expect("fits");
    let mut out = Influence::zeros(1);
    assert_eq!(
        surface.fill(&[probe(Axis::Vertical, 4.0)], &mut out),
        Ok(())
    );
    let refused = Error::NoStiffness {
        rail: 0,
        x: 4.0,
        axis: Axis::Lateral,
    };
    assert_eq!(
        surface.fill(&[probe(Axis::Lateral, 4.0)], &mut out),
        Err(refused)
    );
    nodal[(2, 2)] = f64::NAN;
    assert!(matches!(
        ExactSurface::new(line.clone(), nodal),
        Err(Error::NodalNumber { row: 2, column: 2 })
    ));
    let small = ExactSurface::new(line, DMatrix::zeros(6, 6));
    assert!(matches!(
        small,
        Err(Error::NodalShape {
            rows: 6,
            columns: 6,
            expected: 12
        })
    ));
    let mut wrong = Influence::zeros(3);
    let refused = Error::OutputShape {
        rows: 3,
        columns: 3,
        expected: 1,
    };
    assert_eq!(
        surface.fill(&[probe(Axis::Vertical, 4.0)], &mut wrong),
        Err(refused)
    );
}

#[test]
fn unusable_elements_are_refused() {
    let good = chain(&[0.0, 10.0], [0.0; 3], Flexibility::default()).remove(0);
    let refuse = |cells: Vec<RailElement>| Rails::new(cells).map(|_| ()).expect_err("refused");
    assert_eq!(refuse(vec![]), Error::NoElements);
    assert_eq!(
        refuse(vec![RailElement {
            x: [2.0, 2.0],
            ..good.clone()
        }]),
        Error::ElementExtent {
            cell: 0,
            x: [2.0, 2.0]
        }
    );
    assert_eq!(
        refuse(vec![RailElement {
            x: [0.0, f64::INFINITY],
            ..good.clone()
        }]),
        Error::ElementNumber { cell: 0 }
    );
    assert_eq!(
        refuse(vec![RailElement {
            offset: [f64::NAN, 0.0, 0.0],
            ..good.clone()
        }]),
        Error::ElementNumber { cell: 0 }
    );
    assert_eq!(
        refuse(vec![RailElement {
            length: 0.0,
            ..good.clone()
        }]),
        Error::ElementLength {
            cell: 0,
            length: 0.0
        }
    );
    let left_handed = [STRAIGHT[0], STRAIGHT[2], STRAIGHT[1]];
    assert_eq!(
        refuse(vec![RailElement {
            frame: left_handed,
            ..good.clone()
        }]),
        Error::ElementFrame { cell: 0 }
    );
    let negative = Flexibility {
        shear_y: -1.0,
        ..Flexibility::default()
    };
    assert_eq!(
        refuse(vec![
            good.clone(),
            RailElement {
                rail: 1,
                flexibility: negative,
                ..good.clone()
            }
        ]),
        Error::ElementFlexibility { cell: 1 }
    );
    let over = RailElement {
        x: [9.0, 12.0],
        ..good.clone()
    };
    assert_eq!(
        refuse(vec![over, good]),
        Error::Overlap {
            rail: 0,
            first: 1,
            second: 0,
            x: 9.0
        }
    );
}
