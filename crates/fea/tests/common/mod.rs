//! What several test files share.
#![allow(dead_code)]

use fea::{Girder, Theory};
use splines::{Axis, Probe};

/// McConville's girder: 60 ft simply supported, overhangs of 15 ft; pounds and feet.
pub fn paper() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        g: Some(1.661_538e9),
        area: Some(1.0),
        i_vertical: 9.528,
        i_lateral: Some(0.874_97),
        j: Some(0.6552),
        rail_height: 3.6615,
        theory: Theory::EulerBernoulli,
        stations: vec![-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0],
        ..Girder::default()
    }
}

pub fn probes(axis: Axis, at: &[f64]) -> Vec<Probe> {
    at.iter().map(|&x| Probe { rail: 0, x, axis }).collect()
}

/// A repeatable stream of numbers in 0..1 (splitmix64).
pub struct Stream(pub u64);

impl Stream {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}
