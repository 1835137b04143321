//! Frames of straight members with closed forms: beams, trusses, portals, grillages, bends.

use fea::{
    BeamTheory, CrossSection, Dof, GroundSpring, Member, MemberKind, Model, RigidLink, Support,
    point_compliance,
};

const E: f64 = 2.1e11;
const G: f64 = 8.1e10;
const ALL: [bool; 6] = [true; 6];

fn section(area: f64, iy: f64, iz: f64, j: f64) -> CrossSection {
    CrossSection {
        e: E,
        g: G,
        area,
        iy,
        iz,
        j,
        ..CrossSection::default()
    }
}

/// Members in a row of points; y is up.
fn frame(
    points: &[[f64; 3]],
    members: &[([usize; 2], usize, [f64; 3])],
    sections: &[CrossSection],
) -> Model {
    Model {
        points: points.to_vec(),
        sections: sections.to_vec(),
        members: members
            .iter()
            .map(|&(ends, section, up)| Member::beam(ends, section, up))
            .collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

fn hold(model: &mut Model, point: usize, fix: [bool; 6]) {
    model.supports.push(Support { point, fixed: fix });
}

/// Displacement of `point` along degree of freedom `a` per unit load on `at` along degree of freedom `b`.
fn compliance(model: &Model, (point, a): (usize, Dof), (at, b): (usize, Dof)) -> f64 {
    let (c, _) = point_compliance(model, &[point, at]).expect("it stands");
    c[(a as usize, 6 + b as usize)]
}

fn own(model: &Model, point: usize, freedom: Dof) -> f64 {
    compliance(model, (point, freedom), (point, freedom))
}

fn near(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found / wanted - 1.0).abs() < tolerance,
        "{found:e} for {wanted:e}"
    );
}

/// A beam along x with points at `at`.
fn beam(at: &[f64], section: CrossSection) -> Model {
    let points: Vec<[f64; 3]> = at.iter().map(|&x| [x, 0.0, 0.0]).collect();
    let members: Vec<_> = (1..at.len())
        .map(|k| ([k - 1, k], 0, [0.0, 1.0, 0.0]))
        .collect();
    frame(&points, &members, &[section])
}

#[test]
fn macneal_and_harder_straight_beam_meets_its_theory() {
    // MacNeal and Harder (1985), Finite Elem. Anal. Des. 1: L = 6, 0.2 x 0.1, E = 1e7, nu = 0.3, unit loads at
    // the tip; published 3.0e-5, 0.1081, 0.4321 (extension, in plane, out of plane).
    let (e, g) = (1e7, 1e7 / 2.6);
    let (iz, iy) = (0.1 * 0.2_f64.powi(3) / 12.0, 0.2 * 0.1_f64.powi(3) / 12.0);
    let shear = Some(5.0 / 6.0 * 0.02);
    let section = CrossSection {
        e,
        g,
        area: 0.02,
        iy,
        iz,
        j: 4.57e-5,
        shear_y: shear,
        shear_z: shear,
        mass: 0.0,
    };
    for elements in [1, 6] {
        let at: Vec<f64> = (0..=elements)
            .map(|k| 6.0 * f64::from(k) / f64::from(elements))
            .collect();
        let mut model = beam(&at, section);
        model.theory = BeamTheory::Timoshenko;
        hold(&mut model, 0, ALL);
        let tip = at.len() - 1;
        for (freedom, published) in [(Dof::Ux, 3.0e-5), (Dof::Uy, 0.1081), (Dof::Uz, 0.4321)] {
            near(own(&model, tip, freedom), published, 5e-4);
        }
        // Analytic: P L^3/3EI + P L/kGA; T L/GJ.
        near(
            own(&model, tip, Dof::Uy),
            72.0 / (e * iz) + 6.0 / (g * 0.02 * 5.0 / 6.0),
            1e-11,
        );
        near(own(&model, tip, Dof::Rx), 6.0 / (g * 4.57e-5), 1e-12);
    }
}

#[test]
fn one_element_does_not_lock_at_any_slenderness() {
    // Analytic: P L^3/3EI + P L/kGA, for h/L from 1 to 1e-6.
    for power in 0..=6 {
        let h = 10f64.powi(-power);
        let (iz, area) = (h.powi(4) / 12.0, 5.0 / 6.0 * h * h);
        let mut model = beam(
            &[0.0, 1.0],
            CrossSection {
                shear_y: Some(area),
                ..section(h * h, iz, iz, iz)
            },
        );
        model.theory = BeamTheory::Timoshenko;
        hold(&mut model, 0, ALL);
        near(
            own(&model, 1, Dof::Uy),
            1.0 / (3.0 * E * iz) + 1.0 / (G * area),
            1e-12,
        );
    }
}

#[test]
fn beams_under_a_central_load_give_the_textbook_fractions() {
    // Timoshenko, Strength of Materials: 1/48, 1/192 and 7/768 of P L^3/EI.
    let i = 3e-4;
    let simple = [true, true, true, true, false, false];
    for (left, right, fraction) in [
        (simple, simple, 48.0),
        (ALL, ALL, 192.0),
        (ALL, simple, 768.0 / 7.0),
    ] {
        let mut model = beam(&[0.0, 4.0, 8.0], section(0.01, i, i, i));
        hold(&mut model, 0, left);
        hold(&mut model, 2, right);
        near(own(&model, 1, Dof::Uy), 512.0 / (fraction * E * i), 1e-12);
    }
}

#[test]
fn elastic_support_shares_the_load_with_the_beam() {
    // Analytic: P/(48 EI/L^3 + k).
    let (i, k) = (3e-4, 5e6);
    let mut model = beam(&[0.0, 4.0, 8.0], section(0.01, i, i, i));
    hold(&mut model, 0, [true, true, true, true, false, false]);
    hold(&mut model, 2, [false, true, true, true, false, false]);
    model.springs.push(GroundSpring {
        point: 1,
        dof: Dof::Uy,
        stiffness: k,
    });
    near(
        own(&model, 1, Dof::Uy),
        1.0 / (48.0 * E * i / 512.0 + k),
        1e-12,
    );
}

#[test]
fn rotational_spring_lies_between_hinge_and_clamp() {
    // Analytic: cantilever on a spring: P L^3/3EI + P L^2/k.
    let (i, k) = (3e-4, 4e7);
    let mut model = beam(&[0.0, 5.0], section(0.01, i, i, i));
    hold(&mut model, 0, [true, true, true, true, true, false]);
    model.springs.push(GroundSpring {
        point: 0,
        dof: Dof::Rz,
        stiffness: k,
    });
    near(
        own(&model, 1, Dof::Uy),
        125.0 / (3.0 * E * i) + 25.0 / k,
        1e-12,
    );
}

#[test]
fn shaft_held_at_both_ends_twists_by_its_parts() {
    // Analytic: T a b/(GJ L).
    let j = 2e-5;
    let mut model = beam(&[0.0, 1.5, 6.0], section(0.01, 1e-4, 1e-4, j));
    hold(&mut model, 0, ALL);
    hold(&mut model, 2, ALL);
    near(own(&model, 1, Dof::Rx), 1.5 * 4.5 / (G * j * 6.0), 1e-12);
}

#[test]
fn inclined_principal_axes_bend_sideways() {
    // Analytic: v = P L^3/3E (cos^2/I1 + sin^2/I2), w = P L^3/3E sin cos (1/I1 - 1/I2).
    let (i1, i2, angle) = (6e-4, 1e-4, 0.4_f64);
    let (sin, cos) = angle.sin_cos();
    let mut model = frame(
        &[[0.0; 3], [3.0, 0.0, 0.0]],
        &[([0, 1], 0, [0.0, cos, sin])],
        &[section(0.01, i2, i1, 1e-4)],
    );
    hold(&mut model, 0, ALL);
    let unit = 27.0 / (3.0 * E);
    near(
        own(&model, 1, Dof::Uy),
        unit * (cos * cos / i1 + sin * sin / i2),
        1e-12,
    );
    let side = compliance(&model, (1, Dof::Uz), (1, Dof::Uy));
    near(side, unit * sin * cos * (1.0 / i1 - 1.0 / i2), 1e-12);
}

#[test]
fn three_bars_carry_by_the_cube_of_the_cosine() {
    // Timoshenko, Strength of Materials I: P L/(EA (1 + 2 cos^3 a)).
    let angle = 0.6_f64;
    let (l, area) = (2.0, 1e-3);
    let side = l * angle.tan();
    let points = [[0.0; 3], [0.0, l, 0.0], [-side, l, 0.0], [side, l, 0.0]];
    let mut model = frame(&points, &[], &[section(area, 0.0, 0.0, 0.0)]);
    for k in 1..4 {
        model.members.push(Member {
            kind: MemberKind::Truss,
            ..Member::beam([0, k], 0, [0.0; 3])
        });
        hold(&mut model, k, ALL);
    }
    near(
        own(&model, 0, Dof::Uy),
        l / (E * area * (1.0 + 2.0 * angle.cos().powi(3))),
        1e-12,
    );
}

/// A portal of height h and width l, with clamped or pinned feet; axially nearly rigid.
fn portal(h: f64, l: f64, [column, girder]: [f64; 2], clamped: bool) -> Model {
    let points = [[0.0; 3], [0.0, h, 0.0], [l, h, 0.0], [l, 0.0, 0.0]];
    let members = [
        ([0, 1], 0, [1.0, 0.0, 0.0]),
        ([1, 2], 1, [0.0, 1.0, 0.0]),
        ([3, 2], 0, [1.0, 0.0, 0.0]),
    ];
    let mut model = frame(
        &points,
        &members,
        &[column, girder].map(|i| section(1e6 * i, i, i, i)),
    );
    for foot in [0, 3] {
        hold(&mut model, foot, [true, true, true, true, true, clamped]);
    }
    model
}

#[test]
fn portals_sway_as_slope_deflection_says() {
    // Analytic, k = (I_g/l)/(I_c/h): clamped P h^3 (2 + 3 k)/(12 E I_c (1 + 6 k)), pinned P h^3 (1 + 2 k)/(12 E I_c k).
    let (h, l, column, girder) = (5.0, 8.0, 2e-4, 5e-4);
    let k = (girder / l) / (column / h);
    let unit = h * h * h / (12.0 * E * column);
    let clamped = own(&portal(h, l, [column, girder], true), 1, Dof::Ux);
    let pinned = own(&portal(h, l, [column, girder], false), 1, Dof::Ux);
    // Axial strains are 1e-6 of the bending.
    near(clamped, unit * (2.0 + 3.0 * k) / (1.0 + 6.0 * k), 1e-5);
    near(pinned, unit * (1.0 + 2.0 * k) / k, 1e-5);
}

#[test]
fn bent_cantilever_bends_and_twists() {
    // Analytic: P (a^3 + b^3)/3EI + P b^2 a/GJ.
    let (a, b, i, j) = (3.0, 2.0, 2e-5, 3e-5);
    let points = [[0.0; 3], [a, 0.0, 0.0], [a, 0.0, b]];
    let up = [0.0, 1.0, 0.0];
    let mut model = frame(
        &points,
        &[([0, 1], 0, up), ([1, 2], 0, up)],
        &[section(0.01, i, i, j)],
    );
    hold(&mut model, 0, ALL);
    let wanted = (a * a * a + b * b * b) / (3.0 * E * i) + b * b * a / (G * j);
    near(own(&model, 2, Dof::Uy), wanted, 1e-12);
}

#[test]
fn crossing_beams_share_by_their_stiffness() {
    // Analytic: P/(48 EI_1/L_1^3 + 48 EI_2/L_2^3), no moment between them.
    let (i1, i2) = (4e-4, 1e-4);
    let points = [
        [-4.0, 0.0, 0.0],
        [0.0; 3],
        [4.0, 0.0, 0.0],
        [0.0, 0.0, -2.5],
        [0.0, 0.0, 2.5],
    ];
    let up = [0.0, 1.0, 0.0];
    let members = [
        ([0, 1], 0, up),
        ([1, 2], 0, up),
        ([3, 1], 1, up),
        ([1, 4], 1, up),
    ];
    let tiny = 1e-14;
    let mut model = frame(
        &points,
        &members,
        &[section(1.0, i1, i1, tiny), section(1.0, i2, i2, tiny)],
    );
    hold(&mut model, 0, [true, true, true, true, false, false]);
    hold(&mut model, 2, [false, true, true, true, false, false]);
    hold(&mut model, 3, [false, true, false, false, false, true]);
    hold(&mut model, 4, [false, true, false, false, false, true]);
    let stiffness = 48.0 * E * (i1 / 512.0 + i2 / 125.0);
    near(own(&model, 1, Dof::Uy), 1.0 / stiffness, 1e-9);
}

#[test]
fn hinged_girder_of_gerber_hangs_on_its_cantilevers() {
    // Analytic: a span of b hung on two cantilevers of a: P/2 each: P b^3/48EI + (P/4) a^3/3EI * 2 / 2.
    let (a, b, i) = (3.0, 4.0, 2e-4);
    let mut model = beam(
        &[0.0, a, a + 0.5 * b, a + b, 2.0 * a + b],
        section(0.01, i, i, i),
    );
    hold(&mut model, 0, ALL);
    hold(&mut model, 4, ALL);
    model.members[1].releases[0][Dof::Rz as usize] = true;
    model.members[2].releases[1][Dof::Rz as usize] = true;
    let wanted = b * b * b / (48.0 * E * i) + 0.5 * a * a * a / (3.0 * E * i);
    near(own(&model, 2, Dof::Uy), wanted, 1e-12);
}

#[test]
fn bracket_on_a_rigid_link_turns_its_column() {
    // Analytic: column of height h, a link of length r at its head; vertical unit load at the link's end:
    // h/EA + r (r h/EI).
    let (h, r, area, i) = (6.0, 0.8, 0.02, 3e-4);
    let points = [[0.0; 3], [0.0, h, 0.0], [r, h, 0.0]];
    let mut model = frame(
        &points,
        &[([0, 1], 0, [1.0, 0.0, 0.0])],
        &[section(area, i, i, i)],
    );
    model.links.push(RigidLink { from: 1, to: 2 });
    hold(&mut model, 0, ALL);
    near(
        own(&model, 2, Dof::Uy),
        h / (E * area) + r * r * h / (E * i),
        1e-12,
    );
}

#[test]
fn rigid_links_carry_over_pattern_loads_of_a_stepped_column() {
    // Analytic: crane column, stiff below, slender above: head sway under a unit load at the head,
    // (h^3 - u^3)/3EI_l + u^3/3EI_u with u the upper length.
    let (h, u, lower, upper) = (12.0, 4.0, 2e-3, 3e-4);
    let points = [[0.0; 3], [0.0, h - u, 0.0], [0.0, h, 0.0]];
    let along = [1.0, 0.0, 0.0];
    let sections = [
        section(1.0, lower, lower, 1e-3),
        section(1.0, upper, upper, 1e-3),
    ];
    let mut model = frame(
        &points,
        &[([0, 1], 0, along), ([1, 2], 1, along)],
        &sections,
    );
    hold(&mut model, 0, ALL);
    let wanted = (h.powi(3) - u.powi(3)) / (3.0 * E * lower) + u.powi(3) / (3.0 * E * upper);
    near(own(&model, 2, Dof::Ux), wanted, 1e-12);
}
