//! First and second derivatives by both places, of every compliance that has them.

use crate::beam;

use beam::printed::{LATERAL, STATIONS, VERTICAL, table};
use beam::{Beam, EI, Random, probe, read, tabulate};
use splines::{
    Axis, Differentiable, Error, FactoredTable, Influence, InfluenceBlock, Partials, Probe, Rank,
    ReadingMethod, SplineTable, TableReading,
};

const KINDS: [ReadingMethod; 4] = [
    ReadingMethod::Akispl,
    ReadingMethod::Symmetrised,
    ReadingMethod::Cubspl,
    ReadingMethod::Natural,
];
const UP: (usize, Axis) = (0, Axis::Vertical);
const SIDE: (usize, Axis) = (0, Axis::Lateral);

fn jet(of: &dyn Differentiable, p: Probe, q: Probe) -> Partials {
    of.partials(p, q).expect("on the rail")
}

fn along(p: Probe, step: f64) -> Probe {
    Probe { x: p.x + step, ..p }
}

/// Largest difference of each derivative from the central difference of the next lower one, relative to
/// `scale` over powers of a foot; and of value and slope from those of `fill`.
fn defects(of: &dyn Differentiable, p: Probe, q: Probe) -> [f64; 7] {
    let h = 1e-3;
    let got = jet(of, p, q);
    let by_p = [jet(of, along(p, -h), q), jet(of, along(p, h), q)];
    let by_q = [jet(of, p, along(q, -h)), jet(of, p, along(q, h))];
    let quotient =
        |pair: &[Partials; 2], of: fn(&Partials) -> f64| (of(&pair[1]) - of(&pair[0])) / (2.0 * h);
    let mut filled = Influence::zeros(2);
    of.fill(&[p, q], &mut filled).expect("on the rail");
    [
        got.value - filled.value[(0, 1)],
        got.p - filled.slope[(0, 1)],
        got.q - quotient(&by_q, |j| j.value),
        got.pp - quotient(&by_p, |j| j.p),
        got.pq - quotient(&by_q, |j| j.p),
        got.pq - quotient(&by_p, |j| j.q),
        got.qq - quotient(&by_q, |j| j.q),
    ]
    .map(f64::abs)
}

/// Simply supported beam of 60 ft: value, p, q, pp, pq, qq in closed form, p <= q.
fn closed(p: f64, q: f64) -> Partials {
    let l = 60.0;
    let (b, k) = (l - q, 1.0 / (6.0 * EI * l));
    let sum = l * l - b * b - p * p;
    Partials {
        value: k * p * b * sum,
        p: k * b * (sum - 2.0 * p * p),
        q: -k * p * (sum - 2.0 * b * b),
        pp: -6.0 * k * p * b,
        pq: -k * (sum - 2.0 * p * p - 2.0 * b * b),
        qq: -6.0 * k * p * b,
    }
}

fn close(a: Partials, b: Partials, share: f64) -> bool {
    // G ~ 1e-7 ft/lb over lengths of ~ 10 ft.
    let pairs = [
        (a.value, b.value, 1e-7),
        (a.p, b.p, 1e-8),
        (a.q, b.q, 1e-8),
        (a.pp, b.pp, 1e-9),
        (a.pq, b.pq, 1e-9),
        (a.qq, b.qq, 1e-9),
    ];
    pairs
        .iter()
        .all(|(a, b, size)| (a - b).abs() <= share * size)
}

fn swapped(j: Partials) -> Partials {
    Partials {
        value: j.value,
        p: j.q,
        q: j.p,
        pp: j.qq,
        pq: j.pq,
        qq: j.pp,
    }
}

/// Analytic: within an element, across elements, at stations, on the diagonal.
#[test]
fn surface_has_the_closed_derivatives_of_a_simple_beam() {
    let beam = Beam::paper();
    for stations in [&[0.0, 60.0][..], &[0.0, 15.0, 30.0, 60.0]] {
        let surface = beam.surface(stations);
        let mut random = Random::new(41);
        for k in 0..500 {
            let p = if k % 10 == 0 {
                15.0
            } else {
                random.between(0.0, 60.0)
            };
            let q = if k % 7 == 0 {
                p
            } else {
                random.between(p, 60.0)
            };
            let got = jet(&surface, probe(Axis::Vertical, p), probe(Axis::Vertical, q));
            assert!(
                close(got, closed(p, q), 1e-12),
                "{p} {q}: {got:?} {:?}",
                closed(p, q)
            );
            let back = jet(&surface, probe(Axis::Vertical, q), probe(Axis::Vertical, p));
            assert!(close(swapped(back), got, 1e-12), "{p} {q}");
        }
    }
}

/// Analytic: in shear alone G = g a (L - c)/L: a kink under one's own load, the mean of both slopes, and a
/// mixed derivative of -g/L beside its delta function.
#[test]
fn slope_in_shear_jumps_under_its_own_load() {
    let beam = Beam {
        c: 0.0,
        g: 2e-9,
        supports: vec![0.0, 60.0],
    };
    let surface = beam.surface(&[0.0, 20.0, 60.0]);
    for (p, q) in [
        (10.0, 40.0),
        (40.0, 10.0),
        (25.0, 31.0),
        (33.0, 33.0),
        (7.0, 7.0),
    ] {
        let got = jet(&surface, probe(Axis::Vertical, p), probe(Axis::Vertical, q));
        let slope = |own: f64, other: f64| {
            let sides = [-2e-9 * other / 60.0, 2e-9 * (60.0 - other) / 60.0];
            if own == other {
                0.5 * (sides[0] + sides[1])
            } else {
                sides[usize::from(own < other)]
            }
        };
        let expected = Partials {
            value: 2e-9 * f64::min(p, q) * (60.0 - f64::max(p, q)) / 60.0,
            p: slope(p, q),
            q: slope(q, p),
            pp: 0.0,
            pq: -2e-9 / 60.0,
            qq: 0.0,
        };
        assert!(close(got, expected, 1e-12), "{p} {q}: {got:?} {expected:?}");
    }
}

/// Differences: bending, shear, several spans; a rail outside both planes of an inclined girder, all nine
/// pairs of axes.
#[test]
fn surfaces_have_the_derivatives_of_their_values() {
    let spans = Beam {
        c: 1.0 / EI,
        g: 2.5e-9,
        supports: vec![0.0, 20.0, 65.0, 100.0],
    };
    let spans = spans.surface(&[-5.0, 0.0, 20.0, 65.0, 100.0, 110.0]);
    let coupled = beam::coupled();
    let mut random = Random::new(43);
    for _ in 0..300 {
        for (surface, low, high, axes) in [
            (&spans, -4.9, 109.9, &Axis::ALL[1..2]),
            (&coupled, -14.9, 74.9, &Axis::ALL[..]),
        ] {
            let (x, z) = (random.between(low, high), random.between(low, high));
            let far = |x: f64| {
                surface
                    .rails()
                    .breaks(0)
                    .iter()
                    .all(|b| (b - x).abs() > 2e-3)
            };
            if (x - z).abs() < 2e-3 || !far(x) || !far(z) {
                continue;
            }
            for &a in axes {
                for &b in axes {
                    let found = defects(surface, probe(a, x), probe(b, z));
                    let allowed = [1e-20, 1e-21, 1e-15, 1e-15, 1e-15, 1e-15, 1e-15];
                    for (found, allowed) in found.iter().zip(allowed) {
                        assert!(*found < allowed, "{a:?} {b:?} {x} {z}: {found:e}");
                    }
                }
            }
        }
    }
}

/// Tables of two coupled directions.
fn sheets() -> Vec<InfluenceBlock> {
    let couple = table(&VERTICAL).values() * 0.7;
    let couple = SplineTable::new(STATIONS.to_vec(), STATIONS.to_vec(), couple).expect("a table");
    vec![
        InfluenceBlock {
            deflection: UP,
            load: UP,
            table: table(&VERTICAL),
        },
        InfluenceBlock {
            deflection: SIDE,
            load: UP,
            table: couple,
        },
        InfluenceBlock {
            deflection: SIDE,
            load: SIDE,
            table: table(&LATERAL),
        },
    ]
}

/// Differences, between stations: every reading of tables, coupled directions too.
#[test]
fn readings_have_the_derivatives_of_their_values() {
    let mut readings: Vec<Box<dyn Differentiable>> = Vec::new();
    for kind in KINDS {
        readings.push(Box::new(
            TableReading::new(kind, &sheets()).expect("consistent"),
        ));
    }
    readings.push(Box::new(
        FactoredTable::new(&sheets(), Rank::Full).expect("consistent"),
    ));
    let mut random = Random::new(47);
    for _ in 0..200 {
        let (x, z) = (random.between(-14.9, 74.9), random.between(-14.9, 74.9));
        let far = |x: f64| STATIONS.iter().all(|b| (b - x).abs() > 2e-3);
        if !far(x) || !far(z) {
            continue;
        }
        for reading in &readings {
            for (a, b) in [
                (Axis::Vertical, Axis::Vertical),
                (Axis::Vertical, Axis::Lateral),
            ] {
                let found = defects(reading.as_ref(), probe(a, x), probe(b, z));
                let allowed = [1e-20, 1e-21, 1e-14, 1e-14, 1e-14, 1e-14, 1e-14];
                for (found, allowed) in found.iter().zip(allowed) {
                    assert!(*found < allowed, "{x} {z}: {found:e}");
                }
            }
        }
    }
}

/// The convention at stations: each derivative is the mean of its limits from both sides.
#[test]
fn derivatives_at_stations_are_the_mean_of_both_sides() {
    let near = 1e-7;
    let given = tabulate(&Beam::paper(), &STATIONS);
    for kind in KINDS {
        let reading = read(kind, given.clone());
        for (x, z) in [(15.0, 22.0), (22.0, 15.0), (30.0, 45.0), (15.0, 15.0)] {
            let at =
                |p: f64, q: f64| jet(&reading, probe(Axis::Vertical, p), probe(Axis::Vertical, q));
            let got = at(x, z);
            let sides = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
            let sides = sides.map(|[a, b]| at(x + a * near, z + b * near));
            let mean = |of: fn(&Partials) -> f64| sides.iter().map(of).sum::<f64>() / 4.0;
            let expected = Partials {
                value: mean(|j| j.value),
                p: mean(|j| j.p),
                q: mean(|j| j.q),
                pp: mean(|j| j.pp),
                pq: mean(|j| j.pq),
                qq: mean(|j| j.qq),
            };
            assert!(
                close(got, expected, 1e-6),
                "{kind:?} {x} {z}: {got:?} {expected:?}"
            );
        }
    }
}

/// Natural and factored readings are twice continuously differentiable, the exact surface of a beam in
/// bending too.
#[test]
fn smooth_evaluators_have_no_kinks() {
    let beam = Beam::paper();
    let given = tabulate(&beam, &STATIONS);
    let natural = read(ReadingMethod::Natural, given.clone());
    let factored = FactoredTable::new(
        &[InfluenceBlock {
            deflection: UP,
            load: UP,
            table: given,
        }],
        Rank::Full,
    );
    let factored = factored.expect("one table");
    let surface = beam.surface(&STATIONS);
    for of in [&natural as &dyn Differentiable, &factored, &surface] {
        for (p, q) in [(15.0, 15.0), (30.0, 50.0), (22.0, 22.0), (-7.0, 45.0)] {
            let at = |p: f64, q: f64| jet(of, probe(Axis::Vertical, p), probe(Axis::Vertical, q));
            for (a, b) in [(1e-8, 0.0), (-1e-8, 0.0), (0.0, 1e-8), (0.0, -1e-8)] {
                assert!(close(at(p + a, q + b), at(p, q), 1e-6), "{p} {q}");
            }
        }
    }
}

#[test]
fn derivatives_refuse_what_filling_refuses() {
    let surface = Beam::paper().surface(&STATIONS);
    let reading = read(ReadingMethod::Symmetrised, table(&VERTICAL));
    let good = probe(Axis::Vertical, 3.0);
    for of in [&surface as &dyn Differentiable, &reading] {
        for bad in [probe(Axis::Vertical, 75.1), probe(Axis::Vertical, f64::NAN)] {
            assert!(matches!(of.partials(good, bad), Err(Error::OffRail { .. })));
            assert!(matches!(of.partials(bad, good), Err(Error::OffRail { .. })));
        }
        assert!(matches!(
            of.partials(good, Probe { rail: 4, ..good }),
            Err(Error::NoRail { rail: 4 })
        ));
    }
    assert!(matches!(
        reading.partials(good, probe(Axis::Lateral, 3.0)),
        Err(Error::NoStiffness { .. })
    ));
}
