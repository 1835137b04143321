//! Deflection of clamped members under uniform loads, against the integral of Green's function.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, ElementMember, ElementResidual, Error, ExactSurface, Flexibility, Influence,
    MemberMotion, Probe, RailElement, RailShapes, Rails,
};

const X: [f64; 2] = [2.0, 8.5];
const AXES: [Axis; 3] = [Axis::Longitudinal, Axis::Vertical, Axis::Lateral];
/// Gauss quadrature on -1 to 1, exact to degree five.
const GAUSS: [[f64; 2]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0],
    [0.0, 8.0 / 9.0],
    [0.774_596_669_241_483_4, 5.0 / 9.0],
];

/// A rail above and beside a member whose local axes are turned about it, and a second rail on its axis.
fn rails(reversed: bool) -> Rails {
    let (c, s) = (0.8, 0.6);
    let element = |rail: usize, offset: [f64; 3]| RailElement {
        rail,
        x: X,
        ends: [2 * rail, 2 * rail + 1],
        length: X[1] - X[0],
        frame: [[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]],
        offset,
        flexibility: Flexibility {
            axial: 0.3,
            torsion: 0.2,
            bending_y: 0.7,
            bending_z: 0.4,
            shear_y: 1.9,
            shear_z: 1.1,
            tension: 0.0,
        },
        member: Some(ElementMember { id: 7, reversed }),
    };
    Rails::new(vec![element(0, [0.0, 0.7, -0.3]), element(1, [0.0; 3])])
        .expect("two sound elements")
}

fn clamped(reversed: bool) -> ExactSurface {
    ExactSurface::new(Arc::new(rails(reversed)), DMatrix::zeros(24, 24))
        .expect("no motion of the ends")
}

/// Displacement at `at` and its slope under a uniform load of intensity one along local axis `local` on the axis of the
/// member, by quadrature of the compliance on both sides of the place.
fn integral(compliance: &dyn Compliance, line: &Rails, at: Probe, local: usize) -> [f64; 2] {
    let direction = line.elements()[1].member_axes()[local];
    let mut sum = [0.0; 2];
    for [a, b] in [[X[0], at.x], [at.x, X[1]]] {
        for [place, weight] in GAUSS {
            let x = a + 0.5 * (b - a) * (1.0 + place);
            for (axis, part) in AXES.into_iter().zip(direction) {
                let mut influence = Influence::zeros(2);
                compliance
                    .fill(&[at, Probe { rail: 1, x, axis }], &mut influence)
                    .expect("on the rails");
                let factor = 0.5 * (b - a) * weight * part;
                sum[0] += factor * influence.value[(0, 1)];
                sum[1] += factor * influence.slope[(0, 1)];
            }
        }
    }
    sum
}

#[test]
fn deflection_under_a_uniform_load_is_the_integral_of_greens_function() {
    for reversed in [false, true] {
        let surface = clamped(reversed);
        let line = surface.rails();
        for axis in AXES {
            for x in [2.0, 2.9, 5.25, 7.0, 8.5] {
                let at = Probe { rail: 0, x, axis };
                let (element, planes) = line.uniform_load(at).expect("on the rail");
                assert_eq!(element, 0);
                for (plane, found) in planes.iter().enumerate() {
                    let wanted = integral(&surface, line, at, 1 + plane);
                    for k in 0..2 {
                        assert!(
                            (found[k] - wanted[k]).abs() < 1e-11,
                            "{axis:?} {x}: {found:?} {wanted:?}"
                        );
                    }
                }
            }
        }
    }
}

/// Analytic: the deflection under a uniform load, as a motion of its member by polynomials, on a rail above and beside the
/// member; shapes have the sum of such motions.
#[test]
fn shapes_with_member_motions_deflect_between_their_ends() {
    for reversed in [false, true] {
        let line = Arc::new(rails(reversed));
        let (length, flexibility) = (X[1] - X[0], line.elements()[0].flexibility);
        let motion = |plane: usize| {
            let (c, g) = [
                (flexibility.bending_z, flexibility.shear_y),
                (flexibility.bending_y, flexibility.shear_z),
            ][plane];
            let (bending, shear) = (c * length.powi(4) / 24.0, g * length * length / 2.0);
            let turn = 2.0 * bending / length;
            let mut out = MemberMotion {
                plane,
                deflection: [0.0; 9],
                rotation: [0.0; 9],
            };
            out.deflection[1..5].copy_from_slice(&[
                shear,
                bending - shear,
                -2.0 * bending,
                bending,
            ]);
            out.rotation[1..4].copy_from_slice(&[turn, -3.0 * turn, 2.0 * turn]);
            out
        };
        // A motion of degree eight as well, known by its polynomials alone.
        let rest = [0.7, -1.0, 0.2, 2.0, -0.3, 0.9];
        let mut steep = MemberMotion {
            plane: 1,
            deflection: [0.0; 9],
            rotation: [0.0; 9],
        };
        for (p, c) in rest.iter().enumerate() {
            (steep.deflection[p + 1], steep.rotation[p + 1]) =
                (steep.deflection[p + 1] + c, c * 0.5);
            (steep.deflection[p + 3], steep.rotation[p + 2]) =
                (steep.deflection[p + 3] - c, -0.2 * c);
        }
        steep.rotation[8] = -steep.rotation.iter().sum::<f64>();
        let motions = vec![
            vec![motion(0), motion(1), steep],
            vec![motion(0), motion(1), steep],
        ];
        let amplitudes = DMatrix::from_fn(6, 2, |k, r| (3.0 * k as f64 + r as f64).cos());
        let states = DMatrix::from_fn(24, 2, |k, r| (k as f64 - 7.0 * r as f64).sin());
        let bare =
            RailShapes::new(Arc::clone(&line), states).expect("six degrees of freedom a state");
        let moved = bare
            .clone()
            .with_member_motions(motions.clone(), &amplitudes)
            .expect("three an element");
        let wrong = bare
            .clone()
            .with_member_motions(motions.clone(), &DMatrix::zeros(3, 2));
        assert_eq!(
            wrong.err(),
            Some(Error::NodalShape {
                rows: 3,
                columns: 2,
                expected: 6
            })
        );
        for (rail, axis) in [
            (0, Axis::Vertical),
            (0, Axis::Longitudinal),
            (1, Axis::Lateral),
        ] {
            for x in [2.0, 3.1, 5.25, 7.9, 8.5] {
                let at = Probe { rail, x, axis };
                let rows = [&bare, &moved].map(|shapes| {
                    let (mut value, mut slope) = ([0.0; 2], [0.0; 2]);
                    shapes.row(at, &mut value, &mut slope).expect("on the rail");
                    [value, slope]
                });
                let (element, [y, z]) = line.uniform_load(at).expect("on the rail");
                let own = line.member_motion(at, &steep).expect("on the rail");
                let known = [0, 1]
                    .map(|plane| line.member_motion(at, &motion(plane)).expect("on the rail"));
                for k in 0..2 {
                    assert!(
                        (known[0][k] - y[k]).abs() < 1e-12 && (known[1][k] - z[k]).abs() < 1e-12
                    );
                    for shape in 0..2 {
                        let factor = |motion: usize| amplitudes[(3 * element + motion, shape)];
                        let wanted = factor(0) * y[k] + factor(1) * z[k] + factor(2) * own[k];
                        assert!(
                            (rows[1][k][shape] - rows[0][k][shape] - wanted).abs() < 1e-12,
                            "{at:?}"
                        );
                    }
                }
            }
        }
    }
}

/// A uniform load does work on its own deflection alone: without that motion nothing of it is left, and what is left is
/// positive semi-definite.
#[test]
fn a_surface_without_the_deflection_does_not_deflect_under_the_load() {
    let surface = clamped(false);
    let line = Arc::clone(surface.rails());
    let length = X[1] - X[0];
    let flexibility = line.elements()[0].flexibility;
    let squares = [
        (flexibility.bending_z, flexibility.shear_y),
        (flexibility.bending_y, flexibility.shear_z),
    ]
    .map(|(c, g)| 1.0 / (c * length.powi(5) / 720.0 + g * length.powi(3) / 12.0));
    let rest = ElementResidual::new(surface.clone(), vec![squares; 2]);
    for axis in AXES {
        let at = Probe {
            rail: 0,
            x: 3.7,
            axis,
        };
        for local in [1, 2] {
            let [before, after] = [
                integral(&surface, &line, at, local),
                integral(&rest, &line, at, local),
            ];
            assert!(
                after.iter().all(|value| value.abs() < 1e-10),
                "{axis:?} {local}: {before:?} {after:?}"
            );
        }
    }
    let places: Vec<Probe> = (0..20)
        .flat_map(|k| {
            AXES.map(|axis| Probe {
                rail: 0,
                x: 2.2 + 0.3 * f64::from(k),
                axis,
            })
        })
        .collect();
    let mut out = Influence::zeros(places.len());
    rest.fill(&places, &mut out).expect("on the rail");
    assert!(out.value.symmetric_eigenvalues().min() > -1e-11 * out.value.amax());
}
