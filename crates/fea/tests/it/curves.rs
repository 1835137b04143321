//! Curved, twisted and bedded members as chains of straight ones: the order of convergence to closed forms.

use crate::common;

use common::near::assert_near;
use std::f64::consts::{FRAC_PI_2, PI};

use fea::{CrossSection, Dof, GroundSpring, Member, Model, Support, point_compliance};

const ALL: [bool; 6] = [true; 6];

/// Chords of a curve with the parameter t from 0 to 1, with orientations.
fn chain(
    count: usize,
    at: impl Fn(f64) -> [f64; 3],
    up: impl Fn(f64) -> [f64; 3],
    section: CrossSection,
) -> Model {
    let share = |k: f64| k / count as f64;
    Model {
        points: (0..=count).map(|k| at(share(k as f64))).collect(),
        sections: vec![section],
        members: (0..count)
            .map(|k| Member::beam([k, k + 1], 0, up(share(k as f64 + 0.5))))
            .collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

fn compliance(model: &Model, point: usize, a: Dof, b: Dof) -> f64 {
    let (c, _) = point_compliance(model, &[point]).expect("it stands");
    c[(a as usize, b as usize)]
}

/// Checks the error against `wanted` at the finest chain, and the order over the last halving.
fn converges(
    wanted: f64,
    counts: [usize; 2],
    order: f64,
    tolerance: f64,
    found: impl Fn(usize) -> f64,
) {
    let errors = counts.map(|count| (found(count) / wanted - 1.0).abs());
    let seen = (errors[0] / errors[1]).log2() / (counts[1] as f64 / counts[0] as f64).log2();
    assert!(
        errors[1] < tolerance && (seen - order).abs() < 0.1,
        "{errors:?}, order {seen}"
    );
}

fn quarter(count: usize, r: f64, section: CrossSection) -> Model {
    let mut model = chain(
        count,
        |t| [r * (FRAC_PI_2 * t).sin(), r * (FRAC_PI_2 * t).cos(), 0.0],
        |_| [0.0, 0.0, 1.0],
        section,
    );
    model.supports.push(Support {
        point: 0,
        fixed: ALL,
    });
    model
}

#[test]
fn quarter_circle_in_its_plane_follows_castigliano() {
    // Analytic, thin arc clamped at its top, load along the radius of the free end: M = P R cos(t) at the angle t
    // from the top, N = P cos(t): integrals pi/4 P R^3/EI and pi/4 P R/EA.
    // The beam of MacNeal and Harder (1985): R 4.22, 0.1 x 0.2, E 1e7; its thick-beam 0.08734 is 1.4 % lower.
    let (r, e, i, area) = (4.22_f64, 1e7, 0.1 * 0.2_f64.powi(3) / 12.0, 0.02);
    let wanted = 0.25 * PI * (r.powi(3) / (e * i) + r / (e * area));
    assert!((wanted / 0.08734 - 1.0).abs() < 0.02);
    let section = CrossSection {
        e,
        g: 4e6,
        area,
        iy: i,
        iz: i,
        j: i,
        ..CrossSection::default()
    };
    converges(wanted, [20, 40], 2.0, 5e-4, |count| {
        compliance(&quarter(count, r, section), count, Dof::Ux, Dof::Ux)
    });
}

#[test]
fn quarter_circle_out_of_its_plane_bends_and_twists() {
    // Analytic (Castigliano): P R^3 (pi/4 /EI + (3 pi/4 - 2)/GJ).
    let (r, e, g, i, j) = (4.22_f64, 1e7, 4e6, 0.2 * 0.1_f64.powi(3) / 12.0, 4.57e-5);
    let wanted = r.powi(3) * (0.25 * PI / (e * i) + (0.75 * PI - 2.0) / (g * j));
    // MacNeal and Harder (1985): 0.5022.
    assert!((wanted / 0.5022 - 1.0).abs() < 0.01, "{wanted}");
    let section = CrossSection {
        e,
        g,
        area: 0.02,
        iy: i,
        iz: i,
        j,
        ..CrossSection::default()
    };
    converges(wanted, [20, 40], 2.0, 5e-4, |count| {
        compliance(&quarter(count, r, section), count, Dof::Uz, Dof::Uz)
    });
}

#[test]
fn ring_between_two_forces_flattens_and_widens() {
    // Timoshenko, Strength of Materials II: (pi/4 - 2/pi) and (2/pi - 1/2) of P R^3/EI; a quarter, by symmetry.
    let (r, e, i) = (2.0_f64, 2e11, 1e-6);
    // Axially rigid, except for 1e-9 of the bending.
    let section = CrossSection {
        e,
        g: 8e10,
        area: 1e3,
        iy: i,
        iz: i,
        j: i,
        ..CrossSection::default()
    };
    let build = |count: usize| {
        let mut model = chain(
            count,
            |t| [r * (FRAC_PI_2 * t).sin(), r * (FRAC_PI_2 * t).cos(), 0.0],
            |_| [0.0, 0.0, 1.0],
            section,
        );
        model.supports.push(Support {
            point: 0,
            fixed: [true, false, true, true, true, true],
        });
        model.supports.push(Support {
            point: count,
            fixed: [false, true, true, true, true, true],
        });
        model
    };
    // Half the force acts on the quarter, and its end moves by half the flattening.
    let unit = r.powi(3) / (e * i);
    converges(
        (0.25 * PI - 2.0 / PI) * unit,
        [20, 40],
        2.0,
        1e-2,
        |count| compliance(&build(count), 0, Dof::Uy, Dof::Uy),
    );
    converges((2.0 / PI - 0.5) * unit, [20, 40], 2.0, 1e-2, |count| {
        let model = build(count);
        let (c, _) = point_compliance(&model, &[0, count]).expect("it stands");
        c[(6 + Dof::Ux as usize, Dof::Uy as usize)].abs()
    });
}

#[test]
fn twisted_strip_follows_the_rotating_axes() {
    // MacNeal and Harder (1985): L 12, 1.1 x 0.32, 90 degrees of twist, E 29e6; published 0.005424 and 0.001754,
    // shear included. Analytic, without shear: integral of (L - x)^2 (cos^2/I_1 + sin^2/I_2)/E.
    let (l, e) = (12.0_f64, 29e6);
    let (wide, thin) = (0.32 * 1.1_f64.powi(3) / 12.0, 1.1 * 0.32_f64.powi(3) / 12.0);
    let section = CrossSection {
        e,
        g: 29e6 / 2.44,
        area: 0.352,
        iy: thin,
        iz: wide,
        j: 0.01,
        ..CrossSection::default()
    };
    let build = |count: usize| {
        let mut model = chain(
            count,
            |t| [l * t, 0.0, 0.0],
            |t| [0.0, (FRAC_PI_2 * t).cos(), (FRAC_PI_2 * t).sin()],
            section,
        );
        model.supports.push(Support {
            point: 0,
            fixed: ALL,
        });
        model
    };
    // integral of (L - x)^2 cos^2(pi x/2L) = L^3 (1/6 + 1/pi^2), of sin^2: L^3 (1/6 - 1/pi^2).
    let (cos, sin) = (1.0 / 6.0 + 1.0 / (PI * PI), 1.0 / 6.0 - 1.0 / (PI * PI));
    for (freedom, near, far, published) in [
        (Dof::Uy, wide, thin, 0.001_754),
        (Dof::Uz, thin, wide, 0.005_424),
    ] {
        let wanted = l.powi(3) / e * (cos / near + sin / far);
        assert!(
            (wanted / published - 1.0).abs() < 0.01,
            "{wanted} for {published}"
        );
        converges(wanted, [24, 48], 2.0, 1e-2, |count| {
            compliance(&build(count), count, freedom, freedom)
        });
    }
}

#[test]
fn bedded_rail_sinks_as_hetenyi_says() {
    // Hetenyi, Beams on Elastic Foundation (1946): w = P/(8 EI b^3), b^4 = u/4EI, on springs of u a at spacing a:
    // 136RE rail, E 30e6 psi, I 94.9 in^4, u 3000 psi.
    let (ei, u) = (30e6 * 94.9, 3000.0_f64);
    let b = (u / (4.0 * ei)).powf(0.25);
    let wanted = 1.0 / (8.0 * ei * b.powi(3));
    let length = 24.0 / b;
    let found = |count: usize| {
        let section = CrossSection {
            e: 30e6,
            iz: 94.9,
            ..CrossSection::default()
        };
        let mut model = chain(
            count,
            |t| [length * (t - 0.5), 0.0, 0.0],
            |_| [0.0, 1.0, 0.0],
            section,
        );
        for point in 0..=count {
            let share = if point == 0 || point == count {
                0.5
            } else {
                1.0
            };
            let stiffness = share * u * length / count as f64;
            model.springs.push(GroundSpring {
                point,
                dof: Dof::Uy,
                stiffness,
            });
        }
        compliance(&model, count / 2, Dof::Uy, Dof::Uy)
    };
    // Lumped springs: the error of the lattice sum falls with the fourth power.
    converges(wanted, [96, 192], 4.0, 1e-5, found);
}

/// A rail of EI 1.47e7 lb ft^2 on a pad of 3000 psi, springs 3 in apart, feet: the compliance under a wheel and at
/// wheels beside it.
#[test]
fn a_rail_on_its_pad_gives_more_than_the_girder_and_spreads() {
    let (ei, u) = (1.47e7, 3000.0 * 144.0);
    let (a, count) = (0.25, 320);
    let length = a * count as f64;
    let section = CrossSection {
        e: ei,
        iz: 1.0,
        ..CrossSection::default()
    };
    let mut model = chain(
        count,
        |t| [length * (t - 0.5), 0.0, 0.0],
        |_| [0.0, 1.0, 0.0],
        section,
    );
    for point in 0..=count {
        let share = if point == 0 || point == count {
            0.5
        } else {
            1.0
        };
        model.springs.push(GroundSpring {
            point,
            dof: Dof::Uy,
            stiffness: share * u * a,
        });
    }
    let middle = count / 2;
    // 32 in are 10.67 springs: the mean of the values at the springs before and after
    let (c, _) =
        point_compliance(&model, &[middle, middle + 10, middle + 11, 0]).expect("it stands");
    let at = |i: usize| c[(1, 6 * i + 1)];
    assert_near(
        "rail on its pad: give, 1 / (8 EI b^3), ft/lb",
        "prototype",
        3.4e-7,
        at(0),
        5e-3,
    );
    assert_near(
        "by that of the girder at midspan",
        "prototype",
        3.0,
        at(0) / (60.0_f64.powi(3) / (48.0 * 9.528 * 4.32e9)),
        0.05,
    );
    let beside = at(1) + (at(2) - at(1)) * (32.0 / 12.0 / a - 10.0);
    assert_near(
        "32 in beside it, by that",
        "prototype",
        0.65,
        beside / at(0),
        5e-3,
    );
    // Hetenyi, for an endless rail.
    assert_near(
        "at a free end of the rail, by that",
        "prototype",
        4.0,
        c[(19, 19)] / at(0),
        0.05,
    );
}

#[test]
fn pinned_semicircle_pushes_outward_by_one_over_pi() {
    // Timoshenko, Strength of Materials II: thrust P/pi of a two-hinged semicircular arch under a load at its
    // crown; here by reciprocity: displacement of the crown per outward force over that of the foot.
    let (r, e, i) = (10.0_f64, 2e11, 1e-4);
    let section = CrossSection {
        e,
        g: 8e10,
        area: 1e5,
        iy: i,
        iz: i,
        j: i,
        ..CrossSection::default()
    };
    let found = |count: usize| {
        let mut model = chain(
            count,
            |t| [-r * (PI * t).cos(), r * (PI * t).sin(), 0.0],
            |_| [0.0, 0.0, 1.0],
            section,
        );
        model.supports.push(Support {
            point: 0,
            fixed: [true, true, true, true, true, false],
        });
        model.supports.push(Support {
            point: count,
            fixed: [false, true, true, true, true, false],
        });
        let (c, _) = point_compliance(&model, &[count / 2, count]).expect("it stands");
        (c[(1, 6)] / c[(6, 6)]).abs()
    };
    converges(1.0 / PI, [20, 40], 2.0, 5e-3, found);
}
