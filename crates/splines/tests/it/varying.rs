//! Readings of girders that are not one uniform span: several spans, a taper, a step, the printed table.

use crate::beam;

use std::sync::Arc;

use beam::near::{assert_at_most, assert_near};
use beam::printed::{STATIONS, VERTICAL, table};
use beam::{Beam, EI, chain, probe, read, tabulate};
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, ExactSurface, Flexibility, Influence, Probe, Rails, ReadingMethod,
    SplineTable, fit_beam,
};

fn grid(of: &dyn Compliance, places: &[f64]) -> DMatrix<f64> {
    let at: Vec<Probe> = places.iter().map(|&x| probe(Axis::Vertical, x)).collect();
    let mut out = Influence::zeros(at.len());
    of.fill(&at, &mut out).expect("within the table");
    out.value
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|k| from + (to - from) * k as f64 / (count - 1) as f64)
        .collect()
}

/// The surface without Green's function of the loaded element.
fn stiff(nodal: &DMatrix<f64>, stations: &[f64]) -> ExactSurface {
    let line = Rails::new(chain(stations, [0.0; 3], Flexibility::default())).expect("valid cells");
    ExactSurface::new(Arc::new(line), nodal.clone()).expect("fits")
}

/// The printed table within the span, relative to the largest value there, at midspan.
#[test]
fn printed_table_errs_by_its_reading_and_by_its_digits() {
    let beam = Beam::paper();
    let places = even(0.0, 60.0, 481);
    let n = places.len();
    let exact = DMatrix::from_fn(n, n, |i, j| beam.deflection(places[i], places[j]));
    let mid = beam.deflection(30.0, 30.0);
    let printed = table(&VERTICAL);
    let error = |of: &dyn Compliance| (grid(of, &places) - &exact).amax() / mid;
    let of =
        |what: &str| format!("printed table, {what}: largest error in the span / midspan's value");
    let akispl = read(ReadingMethod::Akispl, printed.clone());
    assert_near(of("AKISPL"), "prototype", 7.3e-2, error(&akispl), 0.02);
    let raised = fit_beam(0, &printed).expect("a beam on knife edges");
    assert_near(
        of("values and kernel"),
        "prototype",
        3.0e-3,
        error(&raised.surface),
        0.05,
    );
    let shapes = stiff(beam.surface(&STATIONS).nodal(), &STATIONS);
    assert_near(
        of("cubic shapes without kernel"),
        "prototype",
        3.9e-3,
        error(&shapes),
        0.02,
    );
    let under = grid(&akispl, &[23.5])[(0, 0)];
    assert_near(
        "printed table, AKISPL: give under a wheel at 23.5 ft, ft/lb",
        "prototype",
        9.19e-8,
        under,
        1e-3,
    );
    let true_one = beam.deflection(23.5, 23.5);
    assert_near(
        "the same, exact, ft/lb",
        "closed form",
        9.93e-8,
        true_one,
        1e-3,
    );
    assert_near(
        "its error",
        "prototype",
        -7.5e-2,
        under / true_one - 1.0,
        0.01,
    );
}

/// Independent: the force method, which uses no elements. Spans are equal unless stated.
#[test]
fn several_spans_are_exact_with_the_kernel_and_far_off_by_akispl() {
    let equal = |spans: usize| (0..=spans).map(|k| 40.0 * k as f64).collect::<Vec<f64>>();
    let cases: [(&str, Vec<f64>, usize, f64, f64); 7] = [
        ("2 spans", equal(2), 7, 0.0, 1.2e-14),
        ("2 unequal spans", vec![0.0, 45.0, 115.0], 3, 0.0, 1.1e-14),
        ("3 spans", equal(3), 10, 0.0, 4.6e-14),
        ("4 spans", equal(4), 9, 0.0, 8.3e-14),
        ("4 spans", equal(4), 13, 0.0, 8.3e-14),
        ("6 spans", equal(6), 13, 0.0, 3.3e-13),
        ("2 spans that shear", equal(2), 7, 4e-9, 4.8e-14),
    ];
    let (mut akispl, mut shapes) = ([f64::INFINITY, 0.0_f64], [f64::INFINITY, 0.0_f64]);
    for (name, supports, count, g, known) in cases {
        let beam = Beam {
            c: 1.0 / EI,
            g,
            supports: supports.clone(),
        };
        let end = supports[supports.len() - 1];
        // Stations at the supports and evenly between.
        let cells = (count - 1) / (supports.len() - 1);
        let mut stations = vec![0.0];
        for pair in supports.windows(2) {
            let cells = cells.max(2);
            stations.extend(
                (1..=cells).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / cells as f64),
            );
        }
        let places = even(0.0, end, 161);
        let n = places.len();
        let exact = DMatrix::from_fn(n, n, |i, j| beam.deflection(places[i], places[j]));
        let error = |of: &dyn Compliance| (grid(of, &places) - &exact).amax() / exact.amax();
        let surface = beam.surface(&stations);
        let mut found = error(&surface);
        if g == 0.0 {
            let raised = fit_beam(0, &tabulate(&beam, &stations)).expect("a beam on knife edges");
            found = found.max(error(&raised.surface));
            let [plain, cubic] = [
                error(&read(ReadingMethod::Akispl, tabulate(&beam, &stations))),
                error(&stiff(surface.nodal(), &stations)),
            ];
            println!(
                "{name}, {}: AKISPL {plain:.3}, shapes {cubic:.2e}",
                stations.len()
            );
            akispl = [akispl[0].min(plain), akispl[1].max(plain)];
            shapes = [shapes[0].min(cubic), shapes[1].max(cubic)];
        }
        let what = format!(
            "{name}, {} stations, with kernel: largest error / largest value",
            stations.len()
        );
        // Rounding errors of both computations: their order of magnitude is known, not their digits.
        assert_at_most(what, "force method", 10.0 * known, found);
    }
    println!("AKISPL {akispl:?}, shapes {shapes:?}");
    let of = |what: &str| format!("these spans, {what}: largest error / largest value");
    assert_near(of("AKISPL, least"), "prototype", 0.19, akispl[0], 0.1);
    assert_near(of("AKISPL, most"), "prototype", 0.28, akispl[1], 0.1);
    assert_near(
        of("cubic shapes, least"),
        "prototype",
        1.3e-2,
        shapes[0],
        0.05,
    );
    // The prototype has 6.1e-2. The value depends on the shortest of unequal spans: 6.1e-2 belongs to spans of less than
    // 1 to 6, which are not published; ours are 45 and 70 ft.
    assert_near(
        of("cubic shapes, most"),
        "regression",
        4.69e-2,
        shapes[1],
        0.01,
    );
}

/// Simply supported over 60 ft, EI(s) given, by virtual work: composite Simpson between kinks.
struct Span<'a> {
    give: &'a dyn Fn(f64) -> f64,
    breaks: Vec<f64>,
}

const L: f64 = 60.0;

impl Span<'_> {
    /// Moment at s under a unit force at z, or under a unit moment there, its derivative by z.
    fn moment(force: bool, s: f64, z: f64) -> f64 {
        match (force, s < z) {
            (true, true) => s * (L - z) / L,
            (true, false) => z * (L - s) / L,
            (false, true) => -s / L,
            (false, false) => (L - s) / L,
        }
    }

    fn integral(&self, of: impl Fn(f64) -> f64, kinks: &[f64]) -> f64 {
        let mut ends: Vec<f64> = self
            .breaks
            .iter()
            .chain(kinks)
            .copied()
            .chain([0.0, L])
            .collect();
        ends.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        for pair in ends.windows(2).filter(|pair| pair[1] - pair[0] > 1e-12) {
            let count = 32;
            let h = (pair[1] - pair[0]) / f64::from(count);
            for i in 0..count {
                let a = pair[0] + h * f64::from(i);
                // Just inside: values at kinks belong to this side.
                let (low, high) = (a + 1e-9 * h, a + h - 1e-9 * h);
                sum += h / 6.0 * (of(low) + 4.0 * of(a + 0.5 * h) + of(high));
            }
        }
        sum
    }

    fn coefficient(&self, at: bool, x: f64, load: bool, z: f64) -> f64 {
        self.integral(
            |s| Span::moment(at, s, x) * Span::moment(load, s, z) * (self.give)(s),
            &[x, z],
        )
    }

    fn grid(&self, places: &[f64]) -> DMatrix<f64> {
        let n = places.len();
        DMatrix::from_fn(n, n, |i, j| {
            self.coefficient(true, places[i], true, places[j])
        })
    }

    fn nodal(&self, stations: &[f64]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(6 * stations.len(), 6 * stations.len());
        for (i, &x) in stations.iter().enumerate() {
            for (j, &z) in stations.iter().enumerate() {
                for (a, at) in [(1, true), (5, false)] {
                    for (b, load) in [(1, true), (5, false)] {
                        out[(6 * i + a, 6 * j + b)] = self.coefficient(at, x, load, z);
                    }
                }
            }
        }
        out
    }

    /// Exact node states, and on each element Green's function of its mean flexibility, which is that of the
    /// harmonic mean of EI.
    fn mean(&self, stations: &[f64]) -> ExactSurface {
        let mut cells = chain(stations, [0.0; 3], Flexibility::default());
        for cell in &mut cells {
            let [a, b] = cell.x;
            let inside = |s: f64| if a < s && s < b { (self.give)(s) } else { 0.0 };
            cell.flexibility.bending_z = self.integral(inside, &[a, b]) / (b - a);
        }
        ExactSurface::new(
            Arc::new(Rails::new(cells).expect("valid cells")),
            self.nodal(stations),
        )
        .expect("fits")
    }
}

#[test]
fn tapers_and_steps_err_by_what_is_left_of_them_within_a_cell() {
    let tent = |s: f64| 2.0 - (2.0 * s / L - 1.0).abs();
    let taper = Span {
        give: &|s: f64| 1.0 / (EI * tent(s)),
        breaks: vec![0.5 * L],
    };
    let step = Span {
        give: &|s: f64| 1.0 / (EI * if (20.0..40.0).contains(&s) { 2.0 } else { 1.0 }),
        breaks: vec![20.0, 40.0],
    };
    let places = even(0.0, L, 97);
    let exact = taper.grid(&places);
    let error = |of: &dyn Compliance, exact: &DMatrix<f64>| {
        (grid(of, &places) - exact).amax() / exact.amax()
    };
    let table = |of: &Span<'_>, stations: &[f64]| {
        SplineTable::new(stations.to_vec(), stations.to_vec(), of.grid(stations))
            .expect("stations increase")
    };
    let of = |what: &str, n: usize| {
        format!(
            "EI doubled linearly to midspan, {what}, {n} stations: largest error / largest value"
        )
    };
    for (n, akispl, shapes, mean, raised) in [
        (5, 8.1e-2, 6.6e-3, 1.4e-3, 1.02e-2),
        (9, 1.9e-2, 8.8e-4, 1.4e-4, 1.26e-3),
        (13, 9.0e-3, 2.6e-4, 3.2e-5, 3.56e-4),
    ] {
        let stations = even(0.0, L, n);
        let own = table(&taper, &stations);
        let found = [
            error(&read(ReadingMethod::Akispl, own.clone()), &exact),
            error(&stiff(&taper.nodal(&stations), &stations), &exact),
            error(&taper.mean(&stations), &exact),
            fit_beam(0, &own).map_or(f64::NAN, |lift| error(&lift.surface, &exact)),
        ];
        println!("taper {n}: {found:?}");
        assert_near(of("AKISPL", n), "prototype", akispl, found[0], 0.05);
        assert_near(of("cubic shapes", n), "prototype", shapes, found[1], 0.05);
        assert_near(
            of("kernel of the mean", n),
            "prototype",
            mean,
            found[2],
            0.06,
        );
        // The prototype errs by 8.4e-3, 5.8e-4 and 1.2e-4: it gives each cell the EI that its stations imply. Ours gives the
        // whole table one EI, because it takes the girder for a uniform one, and reports by the misfit that it is not. A
        // girder that varies is to be given as a frame.
        assert_near(
            of("values and kernel", n),
            "regression",
            raised,
            found[3],
            0.01,
        );
    }
    let exact = step.grid(&places);
    let stations = even(0.0, L, 5);
    let of = |what: &str| {
        format!("EI twice as large from 20 to 40 ft, {what}: largest error / largest value")
    };
    let [shapes, mean] = [
        error(&stiff(&step.nodal(&stations), &stations), &exact),
        error(&step.mean(&stations), &exact),
    ];
    println!("step: shapes {shapes:e}, mean {mean:e}");
    assert_near(
        of("cubic shapes, 5 stations"),
        "prototype",
        8.4e-3,
        shapes,
        0.05,
    );
    assert_near(
        of("kernel of the mean, 5 stations"),
        "prototype",
        1.2e-2,
        mean,
        0.05,
    );
    let breaks = [0.0, 20.0, 40.0, 60.0];
    assert_at_most(
        of("stations at the steps"),
        "virtual work",
        5.5e-7,
        error(&step.mean(&breaks), &exact),
    );
}
