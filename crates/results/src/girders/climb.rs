//! A value that is refined along a rail and over time in turn.
//!
//! Between sections or places without a load a quantity is smooth along the rail where it is a deflection, or where dead load and
//! inertia act along the members. From the place of a large value the search goes to the largest value between the places beside it
//! at the same time, then to the largest one at that place in the piece of time and those beside it, and so on.

use piecewise::{Extreme, Lobatto};

use super::girder::LoadedGirders;
use super::value::GirderValue;
use crate::pieces::{Instant, LoadState};

/// Degree of polynomials along a rail.
const DEGREE: usize = 8;

/// Largest number of rounds along the rail and over time.
const ROUNDS: usize = 8;

/// Gain, relative to the value, below which no other round follows.
const GAIN: f64 = 1e-9;

/// Sign times the quantity that is refined, at a coordinate and in a state.
pub(super) type Value<'a> = dyn Fn(f64, &LoadState<'_>) -> Option<f64> + 'a;

impl LoadedGirders<'_> {
    /// The largest value near to one that is known, between the coordinates `near`.
    pub fn climb(&self, near: [f64; 2], from: GirderValue, value: &Value<'_>) -> GirderValue {
        let mut found = from;
        for _ in 0..ROUNDS {
            let before = found.signed;
            self.along(near, &mut found, value);
            if found.signed <= before + GAIN * before.abs() {
                break;
            }
            self.over_time(&mut found, value);
        }
        found
    }

    fn along(&self, [from, to]: [f64; 2], found: &mut GirderValue, value: &Value<'_>) {
        let state = self.pieces.at(found.at);
        for [a, b] in [[from, found.x], [found.x, to]] {
            if b <= a {
                continue;
            }
            let at = |share: f64| a + share * (b - a);
            let nodes = Lobatto::of(DEGREE);
            let values: Option<Vec<f64>> = nodes
                .nodes()
                .iter()
                .map(|share| value(at(*share), &state))
                .collect();
            let Some(values) = values else { return };
            let Some(Extreme { share, .. }) = nodes.polynomial(&values).largest_above(found.signed)
            else {
                continue;
            };
            let x = at(share);
            if let Some(signed) = value(x, &state).filter(|signed| *signed > found.signed) {
                *found = GirderValue {
                    signed,
                    x,
                    own: None,
                    ..*found
                };
            }
        }
    }

    fn over_time(&self, found: &mut GirderValue, value: &Value<'_>) {
        let (x, own) = (found.x, found.at.piece);
        let last = self.pieces.pieces.len() - 1;
        for index in own.saturating_sub(1)..=(own + 1).min(last) {
            let piece = &self.pieces.pieces[index];
            let of_node = |k: usize| value(x, &self.pieces.at_node(piece, k));
            let values: Option<Vec<f64>> = (0..=piece.degree).map(of_node).collect();
            let Some(values) = values else { continue };
            let largest = piece
                .nodes()
                .polynomial(&values)
                .largest_above(found.signed);
            let Some(Extreme { share, .. }) = largest else {
                continue;
            };
            let at = Instant {
                piece: index,
                share,
            };
            let state = self.pieces.at(at);
            if let Some(signed) = value(x, &state).filter(|signed| *signed > found.signed) {
                *found = GirderValue {
                    signed,
                    at,
                    own: None,
                    ..*found
                };
            }
        }
    }
}
