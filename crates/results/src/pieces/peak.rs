//! Largest and smallest values over a run, and when they occur.

use piecewise::{Extreme, Lobatto, Polynomial, between};

use super::bounds::Bounds;
use super::load_pieces::Instant;

/// Signs with which the largest and the smallest values are the largest.
pub(crate) const SIGNS: [f64; 2] = [1.0, -1.0];

/// Differences, relative to a value, that are rounding.
const ROUNDING: f64 = 1e-13;

/// A load that stands at a section: its index, and whether the section is just behind it.
pub(crate) type OwnLoad = Option<(usize, bool)>;

/// The largest of sign times a value so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Peak {
    pub signed: f64,
    pub at: Instant,
    pub own: OwnLoad,
    /// Whether it was found since it was made.
    pub is_new: bool,
}

impl Peak {
    /// Before any value is known.
    pub const NONE: Peak = Peak {
        signed: f64::NEG_INFINITY,
        at: Instant {
            piece: 0,
            share: 0.0,
        },
        own: None,
        is_new: false,
    };

    /// A value to be exceeded.
    pub fn above(signed: f64) -> Peak {
        Peak {
            signed,
            ..Peak::NONE
        }
    }

    /// What a larger value must exceed.
    fn floor(&self) -> f64 {
        if self.signed == f64::NEG_INFINITY {
            self.signed
        } else {
            self.signed + ROUNDING * self.signed.abs()
        }
    }
}

/// The largest value and that of the negatives, as [`super::bounds::Bounds::is_within`] takes them.
pub(crate) fn known(peaks: &[Peak; 2]) -> [f64; 2] {
    [0, 1].map(|kind: usize| peaks[kind].signed)
}

/// A part of a piece, from a share of it to another one, and the loads that stand at the section at either end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub ends: [f64; 2],
    pub own: [OwnLoad; 2],
}

/// A whole piece.
pub(crate) const WHOLE: Part = Part {
    ends: [0.0, 1.0],
    own: [None; 2],
};

/// Offers the polynomial through the values at the nodes of a piece to the largest and the smallest value.
pub(crate) fn offer_piece(peaks: &mut [Peak; 2], piece: (usize, &Lobatto), values: &[f64]) {
    offer_part(peaks, piece, values, WHOLE);
}

/// Offers a part of the polynomial through the values at the nodes of a piece.
pub(crate) fn offer_part(
    peaks: &mut [Peak; 2],
    (piece, nodes): (usize, &Lobatto),
    values: &[f64],
    part: Part,
) {
    let bounds = Bounds::through(values.iter().copied());
    if bounds.high <= peaks[0].floor() && -bounds.low <= peaks[1].floor() {
        return;
    }
    let mut polynomial = nodes.polynomial(values);
    if part.ends != WHOLE.ends {
        polynomial = polynomial.part(part.ends);
    }
    offer_polynomial(peaks, piece, &polynomial, part);
}

/// Offers the polynomial of a part of a piece, by the share of the part.
pub(crate) fn offer_polynomial(
    peaks: &mut [Peak; 2],
    piece: usize,
    polynomial: &Polynomial,
    Part { ends, own }: Part,
) {
    for (peak, sign) in peaks.iter_mut().zip(SIGNS) {
        let found = match sign > 0.0 {
            true => polynomial.largest_above(peak.floor()),
            false => polynomial.times(-1.0).largest_above(peak.floor()),
        };
        if let Some(Extreme { share, value }) = found {
            let own = match share {
                0.0 => own[0],
                1.0 => own[1],
                _ => None,
            };
            let share = between(ends, share);
            *peak = Peak {
                signed: value,
                at: Instant { piece, share },
                own,
                is_new: true,
            };
        }
    }
}
