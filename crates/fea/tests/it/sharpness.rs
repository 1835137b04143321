//! The error bound against the true errors of random girders: never below, and not far above.
//!
//! The truth is the force method in double-doubles (analytic): unit loads on the first and last support by
//! Macaulay's brackets, the supports between them redundant.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use common::{Stream, probes};
use faer::fx128 as Wide;
use fea::{BeamTheory, CrossSection, FactoredFrame, Member, Model, Rail, RailSegment, Support};
use splines::Axis;

/// A girder on supports, with flexibilities 1/EI and 1/kGA.
struct Truth {
    supports: Vec<Wide>,
    bending: Wide,
    shear: Wide,
}

impl Truth {
    /// Displacement at x under a unit load at z, with only the first and the last support.
    fn simple(&self, x: Wide, z: Wide) -> Wide {
        let (first, last) = (self.supports[0], self.supports[self.supports.len() - 1]);
        let l = last - first;
        let right = (z - first) / l;
        let left = Wide::from(1.0) - right;
        let bracket = |x: Wide, power: usize| {
            if x <= Wide::from(0.0) {
                Wide::from(0.0)
            } else {
                (1..power).fold(x, |p, _| p * x)
            }
        };
        let curve = |x: Wide, power: usize| {
            bracket(x - z, power)
                - left * bracket(x - first, power)
                - right * bracket(x - last, power)
        };
        let bent =
            |x: Wide| self.bending / Wide::from(6.0) * curve(x, 3) - self.shear * curve(x, 1);
        let tilt = (bent(last) - bent(first)) / l;
        bent(x) - bent(first) - tilt * (x - first)
    }

    /// Influence coefficients of the places `at`.
    fn grid(&self, at: &[f64]) -> Vec<Vec<Wide>> {
        let inner = &self.supports[1..self.supports.len() - 1];
        let at: Vec<Wide> = at.iter().map(|&x| Wide::from(x)).collect();
        let mut held: Vec<Vec<Wide>> = inner
            .iter()
            .map(|&a| {
                inner
                    .iter()
                    .chain(&at)
                    .map(|&b| self.simple(a, b))
                    .collect()
            })
            .collect();
        let across: Vec<Vec<Wide>> = held.iter().map(|row| row[inner.len()..].to_vec()).collect();
        eliminate(&mut held);
        let entry = |i: usize, j: usize| {
            let taken = (0..inner.len()).fold(Wide::from(0.0), |sum, k| {
                sum + across[k][i] * held[k][inner.len() + j]
            });
            self.simple(at[i], at[j]) - taken
        };
        (0..at.len())
            .map(|i| (0..at.len()).map(|j| entry(i, j)).collect())
            .collect()
    }
}

/// Gauss-Jordan elimination: solves for the columns beyond the square part of `rows`.
fn eliminate(rows: &mut [Vec<Wide>]) {
    for k in 0..rows.len() {
        let pivot = rows[k][k];
        rows[k].iter_mut().for_each(|value| *value /= pivot);
        let from = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let share = row[k];
            row.iter_mut()
                .zip(&from)
                .for_each(|(value, given)| *value -= share * *given);
        }
    }
}

/// One to six spans, cut at random places, some with a very short element; both theories.
fn girder(stream: &mut Stream) -> (Model, Rail, Truth) {
    let pick = |stream: &mut Stream, of: &[usize]| of[(stream.next() * of.len() as f64) as usize];
    let mut section = CrossSection {
        e: 4.32e9,
        g: 1.66e9,
        ..CrossSection::default()
    };
    section.iz = 10f64.powf(stream.between(-2.0, 2.0));
    let theory = if stream.next() < 0.5 {
        BeamTheory::EulerBernoulli
    } else {
        BeamTheory::Timoshenko
    };
    section.shear_y = Some(section.iz.sqrt() * stream.between(0.1, 1.0));
    let spans = pick(stream, &[1, 1, 2, 3, 4, 6]);
    let mut supports = vec![0.0];
    let mut cuts = vec![0.0];
    if stream.next() < 0.5 {
        cuts.insert(0, -stream.between(2.0, 20.0));
    }
    for _ in 0..spans {
        let from = supports[supports.len() - 1];
        let span = 10f64.powf(stream.between(0.9, 2.0));
        for _ in 1..pick(stream, &[1, 1, 1, 2, 4, 12]) {
            cuts.push(from + span * stream.next());
        }
        if stream.next() < 0.05 {
            let place = from + span * stream.between(0.1, 0.9);
            cuts.extend([place, place + span * 10f64.powf(stream.between(-6.0, -2.0))]);
        }
        supports.push(from + span);
        cuts.push(from + span);
    }
    if stream.next() < 0.5 {
        cuts.push(supports[spans] + stream.between(2.0, 20.0));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let members: Vec<Member> = (1..cuts.len())
        .map(|k| Member::beam([k - 1, k], 0, [0.0, 1.0, 0.0]))
        .collect();
    let held = |x: f64| {
        cuts.iter()
            .position(|&cut| cut == x)
            .expect("supports are cuts")
    };
    let model = Model {
        points: cuts.iter().map(|&x| [x, 0.0, 0.0]).collect(),
        sections: vec![section],
        supports: supports
            .iter()
            .map(|&x| Support {
                point: held(x),
                fixed: [x == 0.0, true, true, true, false, false],
            })
            .collect(),
        up: [0.0, 1.0, 0.0],
        theory,
        ..Model::default()
    };
    let segments = (0..members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    let rail = Rail {
        axis: [1.0, 0.0, 0.0],
        segments,
        ..Rail::default()
    };
    let one = Wide::from(1.0);
    let shear = match (theory, section.shear_y) {
        (BeamTheory::Timoshenko, Some(area)) => one / (Wide::from(section.g) * Wide::from(area)),
        _ => Wide::from(0.0),
    };
    let truth = Truth {
        supports: supports.iter().map(|&x| Wide::from(x)).collect(),
        bending: one / (Wide::from(section.e) * Wide::from(section.iz)),
        shear,
    };
    (Model { members, ..model }, rail, truth)
}

/// Largest |error of G_ij| / sqrt(G_ii G_jj), and its bound; `None` if the frame is refused.
fn compare(stream: &mut Stream) -> Option<(f64, f64)> {
    let (model, rail, truth) = girder(stream);
    let (first, last) = (model.points[0][0], model.points[model.points.len() - 1][0]);
    let at: Vec<f64> = (0..6).map(|_| stream.between(first, last)).collect();
    let frame = FactoredFrame::new(&model, &[rail]).ok()?;
    let grid = frame
        .grid(&probes(Axis::Vertical, &at))
        .expect("on the rail");
    let exact = truth.grid(&at);
    let mut worst = 0.0_f64;
    for (i, row) in exact.iter().enumerate() {
        for (j, &entry) in row.iter().enumerate() {
            let error = (Wide::from(grid.value[(i, j)]) - entry).0.abs();
            worst = worst.max(error / (row[i].0 * exact[j][j].0).sqrt());
        }
    }
    Some((worst, grid.certificate.error_bound))
}

#[test]
fn bound_is_never_below_the_true_error_of_ten_thousand_girders_and_sharp() {
    let mut stream = Stream::new(11);
    let (mut ratios, mut refused) = (Vec::new(), 0);
    for case in 0..10_000 {
        let Some((error, bound)) = compare(&mut stream) else {
            refused += 1;
            continue;
        };
        assert!(error <= bound, "girder {case}: {error:.2e} > {bound:.2e}");
        ratios.push(bound / error.max(f64::MIN_POSITIVE));
    }
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[(share * (ratios.len() - 1) as f64) as usize];
    println!(
        "bound/error: least {:.1}, median {:.1}, 99th {:.1}, most {:.1e}; refused {refused}",
        at(0.0),
        at(0.5),
        at(0.99),
        at(1.0)
    );
    assert!(
        at(0.5) <= 100.0 && at(0.99) <= 1e4 && refused <= 100,
        "{} {} {refused}",
        at(0.5),
        at(0.99)
    );
}
