//! Natural modes against closed forms.

use std::f64::consts::PI;

use fea::{
    Error, Freedom, Freedoms6, Kind, Link, Mass, Member, Model, Modes, Rail, Section, Segment, Spring,
    Support, Theory, modes,
};
use splines::{Axis, Probe};

mod common;

const L: f64 = 7.3;
const FIXED: Freedoms6 = [true; 6];

/// A steel box: every number matters.
fn section() -> Section {
    Section {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.013,
        iy: 3.1e-5,
        iz: 8.7e-5,
        j: 2.3e-5,
        shear_y: Some(0.0061),
        shear_z: Some(0.0047),
        mass: 111.0,
    }
}

fn beam(points: [usize; 2]) -> Member {
    Member {
        points,
        kind: Kind::Beam,
        section: 0,
        orientation: [0.0, 1.0, 0.0],
        offsets: [[0.0; 3]; 2],
        releases: [[false; 6]; 2],
    }
}

/// A straight chain of equal members along x; ends held as given.
fn chain(count: usize, theory: Theory, ends: [Freedoms6; 2]) -> Model {
    let mut model = Model { up: [0.0, 1.0, 0.0], theory, ..Model::default() };
    model.sections.push(section());
    for k in 0..=count {
        model.points.push([L * k as f64 / count as f64, 0.0, 0.0]);
    }
    model.members.extend((0..count).map(|k| beam([k, k + 1])));
    for (fix, point) in ends.into_iter().zip([0, count]) {
        if fix.contains(&true) {
            model.supports.push(Support { point, fix });
        }
    }
    model
}

/// A chain that bends in its x-y plane alone.
fn plane(count: usize, theory: Theory, ends: [Freedoms6; 2]) -> Model {
    let mut model = chain(count, theory, ends);
    let fix = [true, false, true, true, true, false];
    model.supports.extend((0..=count).map(|point| Support { point, fix }));
    model
}

const PINNED: Freedoms6 = [false, true, false, false, false, false];
const FREE: Freedoms6 = [false; 6];

/// The rail along the whole chain, and its modes.
fn solve(model: &Model, count: usize) -> Modes {
    let segments = (0..model.members.len()).map(|member| Segment { member, offset: [0.0; 3] }).collect();
    let rail = Rail { origin: [0.0; 3], axis: [1.0, 0.0, 0.0], segments, stations: vec![0.0, L] };
    modes(model, &[rail], count).expect("sound")
}

fn omega(model: &Model, mode: usize) -> f64 {
    solve(model, mode + 1).modes[mode].omega
}

/// Root of a function that changes its sign between two numbers.
fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    assert!(f(a) * f(b) < 0.0, "no change of sign between {a} and {b}");
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        if f(a) * f(middle) <= 0.0 { b = middle } else { a = middle }
    }
    0.5 * (a + b)
}

/// omega = k^2 sqrt(EI/m) of an Euler-Bernoulli beam whose k L is given.
fn bending(kl: f64) -> f64 {
    let s = section();
    (kl / L).powi(2) * (s.e * s.iz / s.mass).sqrt()
}

/// Source: Blevins, Formulas for Natural Frequency and Mode Shape (1979), table 8-1.
fn roots(ends: &str) -> Vec<f64> {
    let characteristic = move |x: f64, ends: &str| match ends {
        "clamped-free" => x.cos() + 1.0 / x.cosh(),
        "clamped-clamped" => x.cos() - 1.0 / x.cosh(),
        _ => x.tan() - x.tanh(),
    };
    (1..=3)
        .map(|k| {
            let k = f64::from(k);
            match ends {
                "pinned-pinned" => k * PI,
                "clamped-free" => root(|x| characteristic(x, ends), (k - 1.0) * PI + 1e-9, k * PI),
                "clamped-clamped" => root(|x| characteristic(x, ends), k * PI, (k + 1.0) * PI - 0.1),
                _ => root(|x| characteristic(x, ends), k * PI + 0.01, (k + 0.49) * PI),
            }
        })
        .collect()
}

#[test]
fn frequencies_of_uniform_beams_converge_with_order_four() {
    let cases = [
        ("pinned-pinned", [PINNED, PINNED]),
        ("clamped-free", [FIXED, FREE]),
        ("clamped-clamped", [FIXED, FIXED]),
        ("clamped-pinned", [FIXED, PINNED]),
    ];
    for (name, ends) in cases {
        for (mode, kl) in roots(name).into_iter().enumerate() {
            let exact = bending(kl);
            let errors = [4, 8, 16, 32]
                .map(|count| omega(&plane(count, Theory::EulerBernoulli, ends), mode) / exact - 1.0);
            assert!(errors.iter().all(|&error| error > 0.0), "{name} {mode}: not from above {errors:?}");
            for pair in errors.windows(2).skip(usize::from(mode > 0)) {
                let order = (pair[0] / pair[1]).log2();
                println!("{name} mode {mode}: {:.2e} -> {:.2e}, order {order:.3}", pair[0], pair[1]);
                assert!((order - 4.0).abs() < 0.25, "{name} mode {mode}: order {order} of {errors:?}");
            }
        }
    }
}
