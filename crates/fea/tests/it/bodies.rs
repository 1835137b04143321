//! Rigid bodies of linked points on supports at several of their points, against their kinematics (analytic).

use fea::{Dof, GroundSpring, Model, RigidLink, Support, point_compliance};

/// A plane body of the points `places`, free in its plane and on `guides` (point, degree of freedom).
fn body(places: &[[f64; 2]], guides: &[(usize, Dof)]) -> Model {
    let mut model = Model {
        points: places.iter().map(|[x, y]| [*x, *y, 0.0]).collect(),
        links: (1..places.len())
            .map(|to| RigidLink { from: to - 1, to })
            .collect(),
        supports: vec![Support {
            point: 0,
            fixed: [false, false, true, true, true, false],
        }],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    for &(point, dof) in guides {
        let mut fixed = [false; 6];
        fixed[dof as usize] = true;
        model.supports.push(Support { point, fixed });
    }
    model
}

/// A body guided up and down at one point and along x at another turns about the pole, where the normals of both motions
/// meet: the velocity at r from the pole is theta e_z cross r. With a spring k at s from it, which resists the vertical
/// motion there, a unit load that has the moment m about the pole turns it by m/(k s_x^2).
#[test]
fn body_guided_at_two_points_turns_about_its_pole() {
    let places = [
        [0.4, 0.3],
        [2.0, -1.0],
        [-1.0, 1.5],
        [3.0, 4.0],
        [-2.0, 0.7],
    ];
    let stiffness = 250.0;
    // The lines of both guides are those of the other coordinate: the pole is at x of the vertical guide's normal.
    for (across, along) in [(1, 2), (2, 1), (3, 1), (1, 4)] {
        let pole = [places[along][0], places[across][1]];
        let mut model = body(&places, &[(across, Dof::Ux), (along, Dof::Uy)]);
        let sprung = 0;
        model.springs.push(GroundSpring {
            point: sprung,
            dof: Dof::Uy,
            stiffness,
        });
        let arm = |point: usize| [places[point][0] - pole[0], places[point][1] - pole[1]];
        let turning = stiffness * arm(sprung)[0].powi(2);
        let points = [0, 1, 2, 3, 4];
        let (compliance, certificate) =
            point_compliance(&model, &points).expect("one motion, one spring");
        // Displacements ux, uy and rotation rz per unit rotation about the pole; also moments of unit loads.
        let motion = |point: usize| [-arm(point)[1], arm(point)[0], 1.0];
        for (a, i) in points.iter().flat_map(|&a| (0..3).map(move |i| (a, i))) {
            for (b, j) in points.iter().flat_map(|&b| (0..3).map(move |j| (b, j))) {
                let expected = motion(a)[i] * motion(b)[j] / turning;
                let dof = |k: usize| if k < 2 { k } else { 5 };
                let found = compliance[(6 * a + dof(i), 6 * b + dof(j))];
                assert!(
                    (found - expected).abs() < 1e-13 * 36.0 / turning,
                    "guides {across} {along}: {found} at {a} {i} under {b} {j}, not {expected}"
                );
            }
        }
        assert!(certificate.error_bound < 1e-13, "{certificate:?}");
    }
}

/// Three parallel guides hold a body as two of them do: the third is a combination of the others where the points are on
/// one line, and its constraint adds nothing. In doubles such points are on their line up to rounding.
#[test]
fn guides_that_say_the_same_hold_a_body_once() {
    let line = |s: f64| [0.1 + 0.7 * s, 0.2 + 0.3 * s];
    let places = [line(0.0), line(1.0), line(1.7), line(-2.3), [5.0, 1.0]];
    let spring = GroundSpring {
        point: 4,
        dof: Dof::Ux,
        stiffness: 40.0,
    };
    let of = |guided: &[usize]| {
        let guides: Vec<(usize, Dof)> = guided.iter().map(|&point| (point, Dof::Uy)).collect();
        let mut model = body(&places, &guides);
        model.springs.push(spring);
        point_compliance(&model, &[0, 3, 4]).expect("held").0
    };
    let (two, three, four) = (of(&[0, 1]), of(&[0, 1, 2]), of(&[3, 2, 1, 0]));
    assert!((two[(12, 12)] - 1.0 / 40.0).abs() < 1e-16);
    for found in [&three, &four] {
        assert!((found - &two).amax() < 1e-14, "{:e}", (found - &two).amax());
    }
}
