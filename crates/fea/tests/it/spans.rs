//! Continuous girders against the force method: primary structure on the first and last support, the
//! others redundant; flexibilities by virtual work, integrals of M m/EI and V v/GA (analytic).

use crate::common;

use common::{Stream, probes};
use fea::{BeamTheory, Girder, grid, surface};
use nalgebra::DMatrix;
use splines::{Axis, Compliance, Influence};

/// A girder in the form that the force method uses.
struct Primary {
    supports: Vec<f64>,
    bending: f64,
    shear: f64,
}

impl Primary {
    fn length(&self) -> f64 {
        self.supports[self.supports.len() - 1]
    }

    /// Moment and shear at s, on the side `side` (+1 right, -1 left) of it, under a unit load at z.
    fn section(&self, s: f64, side: f64, z: f64) -> [f64; 2] {
        let l = self.length();
        let right = z / l;
        let beyond = |place: f64| {
            if s > place || (s == place && side > 0.0) {
                1.0
            } else {
                0.0
            }
        };
        let forces = [(0.0, 1.0 - right), (l, right), (z, -1.0)];
        let shear = forces
            .iter()
            .map(|&(place, force)| force * beyond(place))
            .sum();
        let moment = forces
            .iter()
            .map(|&(place, force)| force * beyond(place) * (s - place))
            .sum();
        [moment, shear]
    }

    fn simple(&self, x: f64, z: f64) -> f64 {
        let mut cuts = [0.0, self.length(), x, z];
        cuts.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        for pair in cuts.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            for (s, side, weight) in [(a, 1.0, 1.0), (0.5 * (a + b), 1.0, 4.0), (b, -1.0, 1.0)] {
                let (p, q) = (self.section(s, side, x), self.section(s, side, z));
                let density = p[0] * q[0] * self.bending + p[1] * q[1] * self.shear;
                sum += weight * (b - a) / 6.0 * density;
            }
        }
        sum
    }

    fn grid(&self, at: &[f64]) -> DMatrix<f64> {
        let inner = &self.supports[1..self.supports.len() - 1];
        let simple = DMatrix::from_fn(at.len(), at.len(), |i, j| self.simple(at[i], at[j]));
        let between = DMatrix::from_fn(inner.len(), inner.len(), |i, j| {
            self.simple(inner[i], inner[j])
        });
        let across = DMatrix::from_fn(inner.len(), at.len(), |i, j| self.simple(inner[i], at[j]));
        if inner.is_empty() {
            return simple;
        }
        let solved = between.lu().solve(&across).expect("supports differ");
        simple - across.transpose() * solved
    }
}

const CASES: [(&[f64], [f64; 2]); 6] = [
    (&[60.0, 60.0], [0.0, 0.0]),
    (&[45.0, 70.0], [15.0, 0.0]),
    (&[40.0, 60.0, 40.0], [10.0, 12.0]),
    (&[50.0, 50.0, 50.0, 50.0], [0.0, 0.0]),
    (&[30.0, 55.0, 45.0, 60.0], [8.0, 0.0]),
    (&[45.0, 45.0, 60.0, 45.0, 30.0, 45.0], [15.0, 15.0]),
];

/// Largest error of grid and surface, relative to the largest entry, over all cases.
fn worst(theory: BeamTheory) -> f64 {
    let mut worst = 0.0_f64;
    for (spans, overhangs) in CASES {
        let girder = Girder {
            spans: spans.to_vec(),
            overhangs,
            e: 4.32e9,
            g: Some(1.661_538e9),
            i_vertical: 9.528,
            ka_vertical: Some(0.35),
            theory,
            ..Girder::default()
        };
        let mut supports = vec![0.0];
        for span in spans {
            supports.push(supports[supports.len() - 1] + span);
        }
        let shear = if theory == BeamTheory::Timoshenko {
            1.0 / (1.661_538e9 * 0.35)
        } else {
            0.0
        };
        let primary = Primary {
            supports,
            bending: 1.0 / (4.32e9 * 9.528),
            shear,
        };
        let mut stream = Stream::new(7);
        let mut at: Vec<f64> = (0..60)
            .map(|_| stream.between(-overhangs[0], primary.length() + overhangs[1]))
            .collect();
        at.extend(&primary.supports);
        let exact = primary.grid(&at);
        let (model, rail) = girder.model_and_rail().expect("sound");
        let rails = [rail];
        let probes = probes(Axis::Vertical, &at);
        let value = grid(&model, &rails, &probes).expect("solvable").value;
        let mut out = Influence::zeros(at.len());
        surface(&model, &rails)
            .expect("solvable")
            .surface
            .fill(&probes, &mut out)
            .expect("on the rail");
        let grid_error = (&value - &exact).amax() / exact.amax();
        let surface_error = (&out.value - &exact).amax() / exact.amax();
        worst = worst.max(grid_error).max(surface_error);
    }
    worst
}

#[test]
fn euler_bernoulli_girders_agree_with_the_force_method_to_1e_12() {
    assert!(worst(BeamTheory::EulerBernoulli) < 1e-12);
}

#[test]
fn timoshenko_girders_agree_with_the_force_method_to_1e_12() {
    assert!(worst(BeamTheory::Timoshenko) < 1e-12);
}

#[test]
fn two_equal_spans_give_23_over_1536() {
    // Midspan deflection of a two-span beam, G EI/L^3 = 23/1536 and -9/1536 (analytic).
    let girder = Girder {
        spans: vec![60.0, 60.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("sound");
    let value = grid(&model, &[rail], &probes(Axis::Vertical, &[30.0, 90.0]))
        .expect("solvable")
        .value;
    let unit = 60.0_f64.powi(3) / (4.32e9 * 9.528);
    assert!((value[(0, 0)] / unit - 23.0 / 1536.0).abs() < 1e-15);
    assert!((value[(0, 1)] / unit + 9.0 / 1536.0).abs() < 1e-15);
}
