//! Natural modes against published frequencies, on the published meshes.

use std::f64::consts::PI;

use fea::{BeamTheory, CrossSection, DofSet, Member, Model, Modes, PointMass, Support, modes};

const PLANE: DofSet = [false, false, true, true, true, false];

fn beam(points: [usize; 2], orientation: [f64; 3]) -> Member {
    Member::beam(points, 0, orientation)
}

fn solve(model: &Model, count: usize) -> Modes {
    let solved = modes(model, &[], count).expect("sound");
    assert_eq!(solved.modes.len(), count);
    assert!(
        solved.count_below_shift >= count,
        "only {} counted",
        solved.count_below_shift
    );
    solved
}

fn hertz(modes: &Modes) -> Vec<f64> {
    modes
        .modes
        .iter()
        .map(|mode| mode.omega / (2.0 * PI))
        .collect()
}

/// A square or round steel section.
fn section(area: f64, second: f64, j: f64, shear: Option<f64>) -> CrossSection {
    let e = 200e9;
    let (shear_y, shear_z) = (shear, shear);
    CrossSection {
        e,
        g: e / 2.6,
        area,
        iy: second,
        iz: second,
        j,
        shear_y,
        shear_z,
        mass: 8000.0 * area,
    }
}

/// A chain of `count` members over 10 m, z lateral.
fn chain(count: usize, section: CrossSection, theory: BeamTheory) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        theory,
        sections: vec![section],
        ..Model::default()
    };
    model
        .points
        .extend((0..=count).map(|k| [10.0 * k as f64 / count as f64, 0.0, 0.0]));
    model
        .members
        .extend((0..count).map(|k| beam([k, k + 1], [0.0, 1.0, 0.0])));
    model
}

/// Pin-ended double cross in its plane: eight arms of 5 m, 0.125 m square, four members each.
///
/// Source: NAFEMS, Selected Benchmarks for Natural Frequency Analysis (1987), test FV2.
fn double_cross(arm: usize) -> Model {
    let side = 0.125_f64;
    let section = section(side * side, side.powi(4) / 12.0, 0.141 * side.powi(4), None);
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        sections: vec![section],
        ..Model::default()
    };
    model.points.push([0.0; 3]);
    for k in 0..8 {
        let (sin, cos) = (f64::from(k) * PI / 4.0).sin_cos();
        let mut last = 0;
        for i in 1..=arm {
            let r = 5.0 * i as f64 / arm as f64;
            model.points.push([r * cos, r * sin, 0.0]);
            let point = model.points.len() - 1;
            model.members.push(beam([last, point], [0.0, 0.0, 1.0]));
            last = point;
        }
        model.supports.push(Support {
            point: last,
            fixed: [true, true, false, false, false, false],
        });
    }
    model
        .supports
        .extend((0..model.points.len()).map(|point| Support {
            point,
            fixed: PLANE,
        }));
    model
}

#[test]
fn nafems_fv2_double_cross() {
    let target = [
        11.336, 17.709, 17.709, 17.709, 17.709, 17.709, 17.709, 17.709, 45.345, 57.390, 57.390,
        57.390, 57.390, 57.390, 57.390, 57.390,
    ];
    // The targets are those of inextensible arms: where the centre moves (modes 2, 3, 10, 11) the extension of
    // the arms lowers them by 1.6e-3 and 5.5e-3. Four cubic members an arm add up to 6.2e-3, sixteen 3e-5.
    let coarse = hertz(&solve(&double_cross(4), 16));
    let fine = hertz(&solve(&double_cross(16), 16));
    println!("coarse {coarse:.3?}\nfine {fine:.3?}");
    for (k, target) in target.into_iter().enumerate() {
        let room = if [1, 2, 9, 10].contains(&k) {
            6e-3
        } else {
            1e-4
        };
        assert!(
            (fine[k] / target - 1.0).abs() < room,
            "mode {}: {} {target}",
            k + 1,
            fine[k]
        );
        assert!(
            (coarse[k] / target - 1.0).abs() < 6.5e-3,
            "mode {}: {} {target}",
            k + 1,
            coarse[k]
        );
    }
}

/// Source: NAFEMS, Selected Benchmarks for Natural Frequency Analysis (1987), test FV4: five members, masses of
/// 10,000 kg and 1000 kg on rigid arms of 2 m.
#[test]
fn nafems_fv4_cantilever_with_masses_off_its_axis() {
    let (r, count) = (0.25_f64, 5);
    let round = section(PI * r * r, PI * r.powi(4) / 4.0, PI * r.powi(4) / 2.0, None);
    let mut model = chain(count, round, BeamTheory::EulerBernoulli);
    model.supports.push(Support {
        point: 0,
        fixed: [true; 6],
    });
    for (mass, arm) in [(10_000.0, 2.0), (1000.0, -2.0)] {
        model.masses.push(PointMass {
            point: count,
            mass,
            inertia: [0.0; 3],
            offset: [0.0, arm, 0.0],
        });
    }
    let found = hertz(&solve(&model, 6));
    println!("{found:.4?}");
    for (k, target) in [1.723, 1.727, 7.413, 9.972, 18.155, 26.957]
        .into_iter()
        .enumerate()
    {
        assert!(
            (found[k] / target - 1.0).abs() < 2e-3,
            "mode {}: {} {target}",
            k + 1,
            found[k]
        );
    }
}

/// Source: NAFEMS, Selected Benchmarks for Natural Frequency Analysis (1987), test FV5: 2 m square, five members.
/// The closed forms, and the results of its "exact beam element" on the mesh of five.
#[test]
fn nafems_fv5_deep_beam() {
    let side = 2.0_f64;
    let area = side * side;
    // Torsion of a square: Timoshenko and Goodier, Theory of Elasticity (1970), section 109; shear: Cowper
    // (1966), J. Appl. Mech. 33, 10 (1 + nu) / (12 + 11 nu).
    let second = side.powi(4) / 12.0;
    let j = 0.1406 * side.powi(4);
    let square = section(area, second, j, Some(area * 13.0 / 15.3));
    let held = |count: usize| {
        let mut model = chain(count, square, BeamTheory::Timoshenko);
        model.supports.push(Support {
            point: 0,
            fixed: [true, true, true, true, false, false],
        });
        model.supports.push(Support {
            point: count,
            fixed: [false, true, true, false, false, false],
        });
        model
    };
    let closed = [
        42.650, 42.650, 71.20, 125.0, 148.15, 148.15, 213.61, 283.47, 283.47,
    ];
    let five = [
        42.710, 42.710, 71.495, 125.51, 150.76, 150.76, 221.57, 301.08, 301.08,
    ];
    let (coarse, fine) = (hertz(&solve(&held(5), 9)), hertz(&solve(&held(80), 9)));
    println!("coarse {coarse:.3?}\nfine {fine:.3?}");
    for k in 0..9 {
        // Members deflect in bending under their own inertia, which the published element leaves out.
        if [2, 3, 6].contains(&k) {
            assert!(
                (coarse[k] / five[k] - 1.0).abs() < 5e-5,
                "mode {}: {} {}",
                k + 1,
                coarse[k],
                five[k]
            );
        } else {
            let errors = [coarse[k], five[k]].map(|found| (found - closed[k]).abs());
            assert!(
                errors[0] < 0.2 * errors[1],
                "mode {}: {} {}",
                k + 1,
                coarse[k],
                five[k]
            );
        }
        assert!(
            (fine[k] / closed[k] - 1.0).abs() < 3e-4,
            "mode {}: {} {}",
            k + 1,
            fine[k],
            closed[k]
        );
    }
}

/// Ten bays of 20 ft, nine storeys of 10 ft; A = 3, I = 1, E = 432,000, mass 3 a length, one member each.
fn bathe_and_wilson(lumped: bool) -> Modes {
    let mass = if lumped { 0.0 } else { 3.0 };
    let section = CrossSection {
        e: 432_000.0,
        area: 3.0,
        iy: 1.0,
        iz: 1.0,
        mass,
        ..CrossSection::default()
    };
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        sections: vec![section],
        ..Model::default()
    };
    for storey in 0..=9 {
        for bay in 0..=10 {
            let point = model.points.len();
            model
                .points
                .push([20.0 * f64::from(bay), 10.0 * f64::from(storey), 0.0]);
            let fix = if storey == 0 { [true; 6] } else { PLANE };
            model.supports.push(Support { point, fixed: fix });
            if storey > 0 {
                model
                    .members
                    .push(beam([point - 11, point], [1.0, 0.0, 0.0]));
                if bay > 0 {
                    model
                        .members
                        .push(beam([point - 1, point], [0.0, 1.0, 0.0]));
                }
            }
        }
    }
    assert_eq!((model.points.len(), model.members.len()), (110, 189));
    if lumped {
        for member in &model.members {
            let length = if member.points[1] - member.points[0] == 1 {
                20.0
            } else {
                10.0
            };
            model.masses.extend(member.points.map(|point| PointMass {
                point,
                mass: 1.5 * length,
                inertia: [0.0; 3],
                offset: [0.0; 3],
            }));
        }
    }
    solve(&model, 3)
}

/// The published eigenvalues are those of masses lumped at the joints.
///
/// Source: Bathe and Wilson (1972), J. Eng. Mech. Div. ASCE 98, 1471-1485; Peterson, EASE2 Example Problem
/// Manual (1981), for the last digits of the second and third.
#[test]
fn bathe_and_wilson_frame() {
    let (lumped, consistent) = (bathe_and_wilson(true), bathe_and_wilson(false));
    for (k, target) in [0.589_541, 5.526_96, 16.5879].into_iter().enumerate() {
        let [lumped, consistent] = [&lumped, &consistent].map(|modes| modes.modes[k].omega.powi(2));
        println!("{lumped:.7} {consistent:.7} {target}");
        assert!((lumped / target - 1.0).abs() < 2e-6, "{lumped} {target}");
        assert!(
            consistent > lumped && consistent < 1.013 * lumped,
            "{consistent} {lumped}"
        );
    }
}
