//! Members with an axial force, against the closed forms of the theory of second order.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{DMatrix, Matrix4, Vector4};
use splines::{
    Axis, BeamColumn, Compliance, Differentiable, ElementFunctions, ExactSurface, Flexibility,
    Influence, Probe, RailElement, Rails,
};

const L: f64 = 3.0;

fn element(flexibility: Flexibility) -> RailElement {
    RailElement {
        rail: 0,
        x: [0.0, L],
        ends: [0, 1],
        length: L,
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        flexibility,
        member: None,
    }
}

/// The vertical plane with 1/EI = c, 1/kGA = g and the axial force n.
fn vertical(c: f64, g: f64, tension: f64) -> Flexibility {
    Flexibility {
        bending_z: c,
        shear_y: g,
        tension,
        ..Flexibility::default()
    }
}

/// Stiffness of the plane over (v, theta) at both ends.
fn stiffness(f: &Flexibility) -> Matrix4<f64> {
    let column = BeamColumn::new(f.bending_z, f.shear_y, f.tension, L);
    let [opposite, equal] = column.rotational_stiffness();
    let (near, far) = (0.5 * (equal + opposite), 0.5 * (equal - opposite));
    let (a, b) = (2.0 * equal / (L * L) + column.chord_stiffness(), equal / L);
    Matrix4::new(
        a, b, -a, b, b, near, -b, far, -a, -b, a, -b, b, far, -b, near,
    )
}

/// The surface of one element with the degrees of freedom `free` of (v, theta) at both ends.
fn surface(f: Flexibility, free: &[usize]) -> ExactSurface {
    let k = stiffness(&f);
    let inverse = DMatrix::from_fn(free.len(), free.len(), |i, j| k[(free[i], free[j])])
        .try_inverse()
        .expect("not singular");
    let dofs = [1, 5, 7, 11];
    let mut nodal = DMatrix::zeros(12, 12);
    for (i, &a) in free.iter().enumerate() {
        for (j, &b) in free.iter().enumerate() {
            nodal[(dofs[a], dofs[b])] = inverse[(i, j)];
        }
    }
    ExactSurface::new(
        Arc::new(Rails::new(vec![element(f)]).expect("sound")),
        nodal,
    )
    .expect("sound")
}

fn at(x: f64) -> Probe {
    Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    }
}

fn value(surface: &ExactSurface, x: f64, z: f64) -> f64 {
    let mut out = Influence::zeros(2);
    surface
        .fill(&[at(x), at(z)], &mut out)
        .expect("on the rail");
    out.value[(0, 1)]
}

const PINNED: [usize; 2] = [1, 3];

/// Closed form: 3 (tan u - u)/u^3 with u = pi/2 sqrt(P/P_E), Timoshenko and Gere (1961), section 1.3; in tension the
/// hyperbolic tangent. With GA = 10 P_E by Engesser's equation: P/P_E = 0.1 and 0.5 give 1.120065 and 2.184620.
#[test]
fn midspan_deflection_of_the_pinned_beam_has_the_closed_ratio() {
    let euler = PI * PI / (L * L);
    for (p, known) in [
        (0.1, 1.10965),
        (0.5, 1.98629),
        (0.9, 9.87123),
        (-1.0, 0.505945),
        (-10.0, 0.0971106),
    ] {
        let u = 0.5 * PI * f64::sqrt(f64::abs(p));
        let exact = if p > 0.0 { u.tan() - u } else { u - u.tanh() } * 3.0 / u.powi(3);
        let found = value(
            &surface(vertical(1.0, 0.0, -p * euler), &PINNED),
            0.5 * L,
            0.5 * L,
        );
        let ratio = found * 48.0 / L.powi(3);
        assert!(
            (ratio / exact - 1.0).abs() < 1e-13,
            "{p}: {ratio}, not {exact}"
        );
        assert!(
            (ratio / known - 1.0).abs() < 5e-6,
            "{p}: {ratio}, not {known}"
        );
    }
    let g = 0.1 / euler;
    let first = value(&surface(vertical(1.0, g, 0.0), &PINNED), 0.5 * L, 0.5 * L);
    assert!((first / (L.powi(3) / 48.0 + 0.25 * L * g) - 1.0).abs() < 1e-14);
    for (p, known) in [(0.1, 1.120065), (0.5, 2.184620)] {
        let ratio = value(
            &surface(vertical(1.0, g, -p * euler), &PINNED),
            0.5 * L,
            0.5 * L,
        ) / first;
        assert!((ratio - known).abs() < 6e-7, "{p}: {ratio}, not {known}");
    }
}

/// Closed form: the tip of a cantilever in tension resists u^3/(u - tanh u) EI/L^3, u = L sqrt(T/EI).
#[test]
fn tip_of_a_cantilever_in_tension_has_the_closed_stiffness() {
    for (u, known) in [(1.0_f64, 4.194528), (3.0, 13.466702), (10.0, 111.111111)] {
        let found = value(&surface(vertical(1.0, 0.0, u * u / (L * L)), &[2, 3]), L, L);
        let stiffness = L.powi(3) / found;
        assert!(
            (stiffness * (u - u.tanh()) / u.powi(3) - 1.0).abs() < 1e-13,
            "{u}: {stiffness}"
        );
        assert!(
            (stiffness / known - 1.0).abs() < 1e-6,
            "{u}: {stiffness}, not {known}"
        );
    }
}

/// The flexibilities of a member that bends in both planes, is turned and has an offset.
fn inclined(tension: f64) -> RailElement {
    let [c, s] = [0.8, 0.6];
    RailElement {
        frame: [[c, s, 0.0], [-s * c, c * c, s], [s * s, -s * c, c]],
        offset: [0.1, -0.3, 0.2],
        x: [0.0, c * L],
        flexibility: Flexibility {
            bending_z: 1.0,
            bending_y: 2.5,
            shear_y: 0.05,
            shear_z: 0.02,
            axial: 0.01,
            torsion: 0.4,
            tension,
        },
        ..element(Flexibility::default())
    }
}

/// Identity: reciprocity to the last bit, and slopes and second derivatives those of the values.
#[test]
fn surface_is_symmetric_and_its_derivatives_are_those_of_its_values() {
    for tension in [-0.7, 2.0, 9.0] {
        let planar = surface(vertical(1.0, 0.05, tension), &PINNED);
        let mut nodal = DMatrix::from_fn(12, 12, |i, j| 1.0 / (1.0 + (i + j) as f64));
        nodal += DMatrix::identity(12, 12);
        let line = Arc::new(Rails::new(vec![inclined(tension)]).expect("a rotation"));
        let spatial = ExactSurface::new(line, nodal).expect("symmetric");
        for (surface, end) in [(&planar, L), (&spatial, 0.8 * L)] {
            let mut out = Influence::zeros(2);
            for (x, z) in [(0.31, 0.82), (0.74, 0.12), (0.02, 0.97), (0.55, 0.48)] {
                let axes = if end == L {
                    [Axis::Vertical; 2]
                } else {
                    [Axis::Vertical, Axis::Lateral]
                };
                let probes = [(x, axes[0]), (z, axes[1])].map(|(x, axis)| Probe {
                    rail: 0,
                    x: x * end,
                    axis,
                });
                surface.fill(&probes, &mut out).expect("on the rail");
                assert_eq!(out.value[(0, 1)], out.value[(1, 0)]);
                let [p, q] = probes;
                let found = surface.partials(p, q).expect("on the rail");
                assert!((found.value - out.value[(0, 1)]).abs() < 1e-13, "{tension}");
                let step = 1e-5;
                let moved = |dx: f64, dz: f64| {
                    let [p, q] = [Probe { x: p.x + dx, ..p }, Probe { x: q.x + dz, ..q }];
                    surface.partials(p, q).expect("on the rail")
                };
                let [up, down] = [moved(step, 0.0), moved(-step, 0.0)];
                let [right, left] = [moved(0.0, step), moved(0.0, -step)];
                let half = 0.5 / step;
                for (name, exact, difference) in [
                    ("p", found.p, (up.value - down.value) * half),
                    ("q", found.q, (right.value - left.value) * half),
                    ("pp", found.pp, (up.p - down.p) * half),
                    ("pq", found.pq, (right.p - left.p) * half),
                    ("qq", found.qq, (right.q - left.q) * half),
                ] {
                    let size = 1.0 + exact.abs();
                    assert!(
                        (exact - difference).abs() < 2e-8 * size,
                        "{tension} {name}: {exact}, not {difference}"
                    );
                }
                assert!((out.slope[(0, 1)] - found.p).abs() < 1e-12);
            }
        }
    }
}

/// Identity: the general path, the path of one plane and the functions of one element are the same function.
#[test]
fn all_forms_of_the_functions_agree() {
    for tension in [-0.9, 3.0, 8.0] {
        for given in [element(vertical(1.0, 0.05, tension)), inclined(tension)] {
            let functions = ElementFunctions::new(given.clone());
            let end = given.x[1];
            let line = Rails::new(vec![given]).expect("sound");
            for axis in [Axis::Longitudinal, Axis::Vertical, Axis::Lateral] {
                for x in [0.1, 0.45, 0.8].map(|x| x * end) {
                    let row = line.row(Probe { rail: 0, x, axis }).expect("on the rail");
                    let all = functions.shapes(axis, x);
                    for (&k, value) in row.indices().iter().zip(row.values()) {
                        assert!(
                            (all[k] - value).abs() < 1e-13 * (1.0 + value.abs()),
                            "{tension} {axis:?} {k}"
                        );
                    }
                    for z in [0.2, 0.7].map(|z| z * end) {
                        for other in [Axis::Vertical, Axis::Lateral] {
                            let own = functions.clamped_green(axis, x, &functions, other, z);
                            let same = line.clamped_green(0, x, z)[axis as usize][other as usize];
                            assert!(
                                (own - same).abs() < 1e-14,
                                "{axis:?} {other:?}: {own}, not {same}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Identity: Green's function of the clamped member is what remains when the motion of its ends is taken from that of a
/// longer chain: two elements joined at the load are one element with the load between its ends.
#[test]
fn load_inside_an_element_equals_load_on_a_node() {
    let (c, g) = (1.0, 0.07);
    for tension in [-3.0, -0.6, 0.8, 9.0] {
        let f = vertical(c, g, tension);
        let whole = surface(f, &PINNED);
        for z in [0.2, 0.5, 0.9].map(|z| z * L) {
            // The middle node of two parts of lengths z and L - z, pinned at the outer ends.
            let part = |length: f64| {
                let column = BeamColumn::new(c, g, tension, length);
                let [opposite, equal] = column.rotational_stiffness();
                let (near, far) = (0.5 * (equal + opposite), 0.5 * (equal - opposite));
                (
                    2.0 * equal / (length * length) + column.chord_stiffness(),
                    equal / length,
                    near,
                    far,
                )
            };
            let ((a1, b1, n1, f1), (a2, b2, n2, f2)) = (part(z), part(L - z));
            // Unknowns: outer rotations, then deflection and rotation of the node.
            #[rustfmt::skip]
            let k = Matrix4::new(
                n1, 0.0, -b1, f1,
                0.0, n2, b2, f2,
                -b1, b2, a1 + a2, b2 - b1,
                f1, f2, b2 - b1, n1 + n2,
            );
            let u = k.try_inverse().expect("stable") * Vector4::new(0.0, 0.0, 1.0, 0.0);
            let found = value(&whole, z, z);
            assert!(
                (found / u[2] - 1.0).abs() < 1e-12,
                "{tension} {z}: {found}, not {}",
                u[2]
            );
        }
    }
}

/// Limits: with a vanishing axial force everything is that of the member without one, to rounding.
#[test]
fn vanishing_force_gives_the_cubic_element() {
    for (c, g) in [(1.0, 0.0), (1.0, 0.3), (0.0, 0.3)] {
        let free: &[usize] = if c == 0.0 { &[] } else { &PINNED };
        let surfaces = [1e-30, -1e-30, 0.0].map(|n| surface(vertical(c, g, n), free));
        let mut random = 0.37;
        for _ in 0..200 {
            random = (random * 997.0 + 0.1) % 1.0;
            let (x, z) = (random * L, (random * 31.0 % 1.0) * L);
            let [plus, minus, none] = surfaces.each_ref().map(|surface| value(surface, x, z));
            assert!(
                (plus - none).abs() < 3e-15 * L.powi(3) && (minus - none).abs() < 3e-15 * L.powi(3)
            );
        }
    }
}

/// Identity: a compressed clamped member has a positive Green's function until it buckles, at 4 pi^2 EI/L^2.
#[test]
fn clamped_member_is_positive_until_it_buckles() {
    let critical = 4.0 * PI * PI / (L * L);
    let line = |share: f64| {
        Rails::new(vec![element(vertical(1.0, 0.0, -share * critical))]).expect("sound")
    };
    for share in [0.5, 0.999] {
        let n = 15;
        let places: Vec<f64> = (1..=n)
            .map(|k| L * f64::from(k) / f64::from(n + 1))
            .collect();
        let line = line(share);
        let g = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            line.clamped_green(0, places[i], places[j])[1][1]
        });
        assert!(g.symmetric_eigenvalues().min() > 0.0, "{share}");
    }
    assert!(line(1.001).clamped_green(0, 0.5 * L, 0.5 * L)[1][1] < 0.0);
}

/// Shear that is softer than the compression, and forces that are no numbers, are refused.
#[test]
fn unstable_shear_is_refused() {
    for tension in [-4.0, f64::NAN, f64::INFINITY] {
        assert!(Rails::new(vec![element(vertical(1.0, 0.3, tension))]).is_err());
    }
    assert!(Rails::new(vec![element(vertical(1.0, 0.3, -3.0))]).is_ok());
}
