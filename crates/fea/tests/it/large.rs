//! How far small displacements hold: estimates of [`fea::second_order_change`] beside the elastica, integrated exactly.

use std::f64::consts::PI;

use fea::{
    CrossSection, LargeDisplacements, LinearState, Member, Model, Omitted, Preload, Support,
};

/// A rod in its plane, EI and EA, straight without load and turned by `angle` at its start:
///
/// x' = (1 + e) cos t,    y' = (1 + e) sin t,    t' = M/EI,    M' = (1 + e) (Fx sin t - Fy cos t),    EA e = Fx cos t + Fy sin t
///
/// with the force F on the face that looks along the rod, constant without loads between the ends.
struct Rod {
    length: f64,
    ei: f64,
    /// 1/EA.
    stretch: f64,
    angle: f64,
}

impl Rod {
    /// x, y, angle and moment at the far end, by the force and the moment at the start; Runge and Kutta of order four.
    fn end(&self, [fx, fy]: [f64; 2], moment: f64) -> [f64; 4] {
        let steps = 2000;
        let h = self.length / f64::from(steps);
        let rate = |[_, _, t, m]: [f64; 4]| {
            let one = 1.0 + self.stretch * (fx * t.cos() + fy * t.sin());
            [
                one * t.cos(),
                one * t.sin(),
                m / self.ei,
                one * (fx * t.sin() - fy * t.cos()),
            ]
        };
        let plus = |a: [f64; 4], h: f64, b: [f64; 4]| std::array::from_fn(|k| a[k] + h * b[k]);
        let mut at = [0.0, 0.0, self.angle, moment];
        for _ in 0..steps {
            let a = rate(at);
            let b = rate(plus(at, 0.5 * h, a));
            let c = rate(plus(at, 0.5 * h, b));
            let d = rate(plus(at, h, c));
            at = std::array::from_fn(|k| at[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
        }
        at
    }
}

/// Newton's method for two unknowns with differences, from a start.
fn solve(f: impl Fn([f64; 2]) -> [f64; 2], mut x: [f64; 2], sizes: [f64; 2]) -> [f64; 2] {
    for _ in 0..30 {
        let at = f(x);
        let column = |k: usize| {
            let mut beside = x;
            beside[k] += 1e-6 * sizes[k];
            let moved = f(beside);
            [0, 1].map(|i| (moved[i] - at[i]) / (1e-6 * sizes[k]))
        };
        let ([a, c], [b, d]) = (column(0), column(1));
        let determinant = a * d - b * c;
        x = [
            x[0] - (d * at[0] - b * at[1]) / determinant,
            x[1] - (a * at[1] - c * at[0]) / determinant,
        ];
    }
    x
}

/// Deflection of the tip of a cantilever along x, of length 1 and EI = 1, under a force across it and one that presses it
/// along its first axis.
fn tip(across: f64, pressing: f64) -> [f64; 2] {
    let rod = Rod {
        length: 1.0,
        ei: 1.0,
        stretch: 0.0,
        angle: 0.0,
    };
    let force = [-pressing, across];
    // One unknown, the moment at the start, so that the tip has none; from small forces on.
    let mut moment = 0.0;
    for step in 1..=8 {
        let share = f64::from(step) / 8.0;
        let now = force.map(|f| share * f);
        let free = |m: f64| rod.end(now, m)[3];
        for _ in 0..20 {
            moment -= free(moment) * 1e-6 / (free(moment + 1e-6) - free(moment));
        }
    }
    let [x, y, ..] = rod.end(force, moment);
    [1.0 - x, y]
}

/// The cantilever under a force P at its tip across it, by elliptic integrals: with k^2 = (1 + sin t)/2 of the angle t of the tip
/// and sin f = 1/(k sqrt 2)
///
/// L sqrt(P/EI) = F(k, pi/2) - F(k, f) = a,    y = L - 2 L/a (E(k, pi/2) - E(k, f)),    x = L sqrt(2 sin t)/a.
///
/// Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945); Mattiasson, Int. J. Numer. Methods Eng. 17 (1981), has
/// 0.301720774 and 0.056433236 for P L^2/EI = 1.
#[test]
fn elastica_is_that_of_elliptic_integrals() {
    let integral = |of: &dyn Fn(f64) -> f64, from: f64, to: f64| {
        let parts = 2000;
        let h = (to - from) / f64::from(parts);
        let weight = |k: i32| {
            if k == 0 || k == parts {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        (0..=parts)
            .map(|k| weight(k) * of(from + h * f64::from(k)))
            .sum::<f64>()
            * h
            / 3.0
    };
    let closed = |p: f64| {
        let of_angle = |t: f64| {
            let k = (0.5 * (1.0 + t.sin())).sqrt();
            let from = (1.0 / (k * 2.0_f64.sqrt())).asin();
            let root = |f: f64| (1.0 - (k * f.sin()).powi(2)).sqrt();
            let first = integral(&|f| 1.0 / root(f), from, 0.5 * PI);
            (first, integral(&root, from, 0.5 * PI))
        };
        let (mut low, mut high) = (1e-6, 0.5 * PI - 1e-6);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if of_angle(middle).0 < p.sqrt() {
                low = middle
            } else {
                high = middle
            }
        }
        let (a, second) = of_angle(low);
        [1.0 - (2.0 * low.sin()).sqrt() / a, 1.0 - 2.0 * second / a]
    };
    for p in [0.5, 1.0, 2.0, 5.0] {
        let (found, known) = (tip(p, 0.0), closed(p));
        assert!(
            (0..2).all(|k| (found[k] - known[k]).abs() < 1e-9),
            "{p}: {found:?}, not {known:?}"
        );
    }
    let of_mattiasson = [0.056_433_236, 0.301_720_774];
    assert!((0..2).all(|k| (tip(1.0, 0.0)[k] - of_mattiasson[k]).abs() < 1e-8));
}

fn section(ei: f64, ea: f64) -> CrossSection {
    CrossSection {
        e: 1.0,
        g: 1.0,
        area: ea,
        iy: ei,
        iz: ei,
        j: ei,
        ..CrossSection::default()
    }
}

fn estimate(
    points: Vec<[f64; 3]>,
    section: CrossSection,
    clamped: &[usize],
    load: (usize, [f64; 3]),
) -> Omitted {
    let fixed = |point: &usize| Support {
        point: *point,
        fixed: [true; 6],
    };
    let model = Model {
        members: (1..points.len())
            .map(|k| Member::beam([k - 1, k], 0, [0.0, 0.0, 1.0]))
            .collect(),
        points,
        sections: vec![section],
        supports: clamped.iter().map(fixed).collect(),
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let none = Preload::default();
    let state = LinearState::new(&model, &[], &none).expect("it stands");
    let live = Preload {
        points: vec![load],
        ..Preload::default()
    };
    match state.compare(&live).expect("a force on a point") {
        LargeDisplacements::Found(omitted) => omitted,
        LargeDisplacements::Lost { part } => panic!("lost at {part}"),
    }
}

fn cantilever(force: [f64; 3]) -> Omitted {
    estimate(
        vec![[0.0; 3], [1.0, 0.0, 0.0]],
        section(1.0, 1e9),
        &[0],
        (1, force),
    )
}

/// Within a twentieth of the exact change, which the estimate has without any small parameter.
fn is_near(found: f64, exact: f64) {
    assert!(
        (found / exact.abs() - 1.0).abs() < 0.05,
        "{found}, not {exact}"
    );
}

/// Large rotations: deflections of the cantilever are smaller than those of first order, by 0.5 % to 26 %.
#[test]
fn a_cantilever_that_bends_far() {
    for p in [0.2, 0.5, 1.0, 2.0] {
        let linear = p / 3.0;
        let exact = (tip(p, 0.0)[1] - linear).abs().max(tip(p, 0.0)[0]);
        is_near(
            cantilever([0.0, p, 0.0]).deflection.relative(),
            exact / linear,
        );
    }
}

/// A column that is pressed and pushed across by a thousandth of EI/L^2: second order is nearly all.
#[test]
fn a_column_that_is_pressed() {
    for share in [0.01, 0.1, 0.3, 0.5] {
        let (q, p) = (0.001, share * PI * PI / 4.0);
        let found = cantilever([-p, q, 0.0]);
        is_near(found.deflection.relative(), tip(q, p)[1] / (q / 3.0) - 1.0);
        // The moment at the foot grows by the force times the deflection of the tip.
        is_near(found.moment.relative(), p * tip(q, p)[1] / q);
    }
}

/// Williams, Q. J. Mech. Appl. Math. 17 (1964): two members of 12.943 in that rise by 0.386 in to the load between them, with
/// clamped feet; EI = 9.27e3 lb in^2, EA = 1.885e6 lb.
fn toggle(load: f64) -> f64 {
    let (length, rise): (f64, f64) = (12.943, 0.386);
    let angle = (rise / length).asin();
    let rod = Rod {
        length,
        ei: 9.27e3,
        stretch: 1.0 / 1.885e6,
        angle,
    };
    let mut x = [0.0, 0.0];
    for step in 1..=10 {
        let now = load * f64::from(step) / 10.0;
        // The left half carries half of the load down to its foot.
        let missed = |[fx, moment]: [f64; 2]| {
            let [along, _, turned, _] = rod.end([fx, -0.5 * now], moment);
            [along - length * angle.cos(), turned - angle]
        };
        x = solve(missed, x, [1000.0, 100.0]);
    }
    rise - rod.end([x[0], -0.5 * load], x[1])[1]
}

/// The deflection flattens the toggle and lowers its resistance, by up to a fifth.
#[test]
fn the_toggle_of_williams() {
    let (length, rise): (f64, f64) = (12.943, 0.386);
    let half = (length * length - rise * rise).sqrt();
    let points = vec![[0.0; 3], [half, rise, 0.0], [2.0 * half, 0.0, 0.0]];
    let linear = toggle(1e-3) / 1e-3;
    for load in [0.5, 2.0, 8.0, 16.0] {
        let found = estimate(
            points.clone(),
            section(9.27e3, 1.885e6),
            &[0, 2],
            (1, [0.0, -load, 0.0]),
        );
        is_near(
            found.deflection.relative(),
            toggle(load) / (linear * load) - 1.0,
        );
    }
}

/// A narrow girder of length 10 that is loaded in its middle and pushed sideways by a thousandth of the load. Without warping it
/// buckles laterally at 16.94 sqrt(EI GJ)/L^2 (Timoshenko and Gere, 6.2). Up to there its sideways deflection grows as Ritz's method
/// has it, with forty sines each for deflection and twist and the energy 1/2 EI u''^2 + 1/2 GJ f'^2 + M f u''.
#[test]
fn a_narrow_girder_moves_sideways_before_it_buckles() {
    let narrow = CrossSection {
        e: 1.0,
        g: 1.0,
        area: 1e6,
        iy: 1.0,
        iz: 1e4,
        j: 0.5,
        ..CrossSection::default()
    };
    let point = |x: f64| [x, 0.0, 0.0];
    let fixed = |point: usize, longitudinal: bool| Support {
        point,
        fixed: [longitudinal, true, true, true, false, false],
    };
    let model = Model {
        points: vec![point(0.0), point(5.0), point(10.0)],
        sections: vec![narrow],
        members: vec![
            Member::beam([0, 1], 0, [0.0, 1.0, 0.0]),
            Member::beam([1, 2], 0, [0.0, 1.0, 0.0]),
        ],
        supports: vec![fixed(0, true), fixed(2, false)],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let critical = 16.94 * f64::sqrt(0.5) / 100.0;
    let none = Preload::default();
    let state = LinearState::new(&model, &[], &none).expect("it stands");
    for (share, growth) in [(0.2, 0.040_029), (0.5, 0.320_170), (0.7, 0.922_697)] {
        let load = share * critical;
        let live = Preload {
            points: vec![(1, [0.0, -load, 1e-3 * load])],
            ..Preload::default()
        };
        let LargeDisplacements::Found(omitted) = state.compare(&live).expect("forces on a point")
        else {
            panic!("lost at {share}");
        };
        let linear = 1e-3 * load * 1000.0 / 48.0;
        is_near(omitted.deflection.difference / linear, growth);
    }
    // Beyond the critical load it falls over.
    let live = Preload {
        points: vec![(1, [0.0, -1.3 * critical, 1e-3 * critical])],
        ..Preload::default()
    };
    let beyond = state.compare(&live).expect("forces on a point");
    assert!(
        matches!(beyond, LargeDisplacements::Lost { part } if (0.6..0.8).contains(&part))
            || matches!(beyond, LargeDisplacements::Found(omitted) if omitted.deflection.relative() > 10.0),
        "{beyond:?}"
    );
}
