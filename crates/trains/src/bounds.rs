//! Bounds of the responses of a passage over thirds of its carrier, by which most pieces are left out of a search.
//!
//! At the ends of a third a response is bounded by its Bernstein coefficients. Between them a force of one state is
//! constant and a moment linear, except for the steps J and the jumps of the shear V at wheels that can stand there; a
//! deflection bends by its second derivative k, with jumps of the slope g at wheels, and under axial force moments and
//! shear forces bend as well:
//!
//! force <= its ends + sum J,    moment <= its ends + sum J + h/4 sum V,    deflection <= its ends + k h^2/8 + h/4 sum g.

use crate::bent::FIRST;
use crate::pieces::Piece;
use crate::polynomial::Polynomial;
use crate::section::{Passage, WheelOnMember};
use crate::structure::{GirderResponse, QUANTITIES};

/// Parts of a carrier.
const PARTS: usize = 3;
/// By how much bounds are enlarged for rounding, relative to their size.
const ROUNDING: f64 = 1e-12;

/// Bounds of sign times each response, by part of the carrier, response, sign and piece.
#[derive(Clone, Debug)]
pub(crate) struct Bounds {
    values: Vec<f64>,
    /// The largest of them over the pieces.
    most: Vec<f64>,
    /// By direction and piece: bounds of plus and minus the second derivative of a deflection along the member.
    second: [Vec<[f64; 2]>; 2],
    /// By quantity and piece: bounds of the size of the second derivative of a force along a member under axial force between
    /// wheels; empty without.
    bent: Vec<Vec<f64>>,
    pieces: usize,
    length: f64,
}

impl Bounds {
    /// The bounds of the `wanted` responses; the others are not bounded.
    pub fn new(passage: &Passage, wanted: &[bool; GirderResponse::ALL.len()]) -> Bounds {
        let pieces = passage.pieces.list.len();
        let length = passage.on.length();
        let responses = GirderResponse::ALL.len();
        let mut values = vec![f64::INFINITY; PARTS * responses * 2 * pieces];
        let second: [Vec<[f64; 2]>; 2] = [0, 1].map(|direction| {
            let known = passage.deflections[direction].is_some() && wanted[QUANTITIES + direction];
            (0..pieces)
                .map(|piece| {
                    if known {
                        second(passage, piece, direction)
                    } else {
                        [0.0; 2]
                    }
                })
                .collect()
        });
        let bent: Vec<Vec<f64>> = match passage.on.bent() {
            Some(_) => (0..QUANTITIES)
                .map(|k| match wanted[k] {
                    true => bent_seconds(passage, k),
                    false => vec![0.0; pieces],
                })
                .collect(),
            None => Vec::new(),
        };
        for k in (0..responses).filter(|k| wanted[*k]) {
            for piece in 0..pieces {
                let mut ends = [[f64::NEG_INFINITY; 2]; PARTS + 1];
                for (station, ends) in ends.iter_mut().enumerate() {
                    let s = length * station as f64 / PARTS as f64;
                    passage.parts(piece, k, s, |part| {
                        ends[0] = ends[0].max(part.bound(1.0));
                        ends[1] = ends[1].max(part.bound(-1.0));
                    });
                }
                for part in 0..PARTS {
                    let more = margin(passage, piece, k, part);
                    for sign in 0..2 {
                        let [a, b] = [ends[part][sign], ends[part + 1][sign]];
                        let own = match k.checked_sub(QUANTITIES) {
                            Some(direction) => bulge(second[direction][piece], sign),
                            None => bent.get(k).map_or(0.0, |of| of[piece]),
                        };
                        let bulge = own * (length / PARTS as f64).powi(2) / 8.0;
                        let more = more + bulge;
                        let size = a.abs().max(b.abs()) + more;
                        values[((part * responses + k) * 2 + sign) * pieces + piece] =
                            a.max(b) + more + ROUNDING * size;
                    }
                }
            }
        }
        let largest = |own: &[f64]| own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let most = values.chunks(pieces.max(1)).map(largest).collect();
        Bounds {
            values,
            most,
            second,
            bent,
            pieces,
            length,
        }
    }

    /// A bound of minus the second derivative of sign times response k in a piece, at least 0: by how much a state can
    /// bulge over its chord between wheels.
    pub fn bulge(&self, k: usize, sign: f64, piece: usize) -> f64 {
        match k.checked_sub(QUANTITIES) {
            Some(direction) => bulge(self.second[direction][piece], usize::from(sign < 0.0)),
            None => self.bent.get(k).map_or(0.0, |of| of[piece]),
        }
    }

    /// Bounds of sign times response k around place s, by piece.
    pub fn near(&self, k: usize, sign: f64, s: f64) -> &[f64] {
        self.of_part(self.part(s), k, sign)
    }

    /// The largest of the bounds of sign times response k around place s.
    pub fn most_near(&self, k: usize, sign: f64, s: f64) -> f64 {
        self.most[self.row(self.part(s), k, sign)]
    }

    /// The bound of sign times response k over the carrier in a piece.
    pub fn over_all(&self, k: usize, sign: f64, piece: usize) -> f64 {
        (0..PARTS)
            .map(|part| self.of_part(part, k, sign)[piece])
            .fold(f64::NEG_INFINITY, f64::max)
    }

    fn of_part(&self, part: usize, k: usize, sign: f64) -> &[f64] {
        let first = self.row(part, k, sign) * self.pieces;
        &self.values[first..first + self.pieces]
    }

    /// The part in which a place lies.
    fn part(&self, s: f64) -> usize {
        ((s / self.length * PARTS as f64) as usize).min(PARTS - 1)
    }

    /// Number of the list of bounds by piece.
    fn row(&self, part: usize, k: usize, sign: f64) -> usize {
        (part * GirderResponse::ALL.len() + k) * 2 + usize::from(sign < 0.0)
    }
}

/// Bounds of plus and minus the second derivative of a deflection in a piece, by distance along the member. It is linear
/// between wheels, as a moment is, so that the ends and both sides of each wheel tell for all.
fn second(passage: &Passage, piece: usize, direction: usize) -> [f64; 2] {
    let Some(pieces) = &passage.deflections[direction] else {
        return [0.0; 2];
    };
    let length = passage.on.length();
    let time = passage.pieces.list[piece].length();
    let wheels = passage.wheels(piece);
    let [_, _, c, d] = &pieces.list[piece].cubics;
    let base = |place: &Polynomial| {
        let own = Polynomial::new(d).times(place);
        Polynomial::default()
            .plus(&Polynomial::new(c), 2.0 / length.powi(2))
            .plus(&own, 6.0 / length.powi(3))
    };
    let mut out = [f64::NEG_INFINITY; 2];
    let mut offer = |second: &Polynomial| {
        out[0] = out[0].max(second.bound(time));
        out[1] = out[1].max(Polynomial::default().plus(second, -1.0).bound(time));
    };
    let place = |wheel: &WheelOnMember| Polynomial::new(&[wheel.start, wheel.rate]);
    let ends = [Polynomial::new(&[0.0]), Polynomial::new(&[length])];
    if wheels.iter().any(|wheel| wheel.rate != wheels[0].rate) {
        // Wheels that move against each other: with any of them passed.
        ends.iter().for_each(|end| offer(&base(end)));
        let more: f64 = wheels
            .iter()
            .map(|wheel| wheel.kernel(direction).second(length))
            .sum();
        return out.map(|bound| bound + more);
    }
    let mut at = |place_of: &Polynomial, passed: usize| {
        let bent = |sum: Polynomial, wheel: &WheelOnMember| {
            let distance = place_of.plus(&place(wheel), -1.0);
            let [constant, slope] = wheel.kernel(direction).second_derivative();
            sum.plus(&Polynomial::new(&[constant]), 1.0)
                .plus(&distance, slope)
        };
        offer(&wheels[..passed].iter().fold(base(place_of), bent));
    };
    at(&ends[0], 0);
    at(&ends[1], wheels.len());
    for (index, wheel) in wheels.iter().enumerate() {
        at(&place(wheel), index);
        at(&place(wheel), index + 1);
    }
    out
}

/// Bounds of the size of the second derivative of quantity k, by piece, between wheels.
fn bent_seconds(passage: &Passage, k: usize) -> Vec<f64> {
    let Some((bent, factors)) = passage
        .on
        .bent()
        .and_then(|bent| Some((bent, bent.second(k)?)))
    else {
        return vec![0.0; passage.pieces.list.len()];
    };
    let of = |(index, piece): (usize, &Piece<QUANTITIES>)| {
        let h = piece.length();
        let size = |cubic: &[f64; 4]| cubic.iter().rev().fold(0.0, |sum, c| sum * h + c.abs());
        let of_ends = factors
            .iter()
            .zip(&piece.cubics[FIRST..])
            .map(|(factor, cubic)| factor * size(cubic));
        let wheels = passage
            .wheels(index)
            .iter()
            .map(|wheel| bent.bend(wheel.behind(k)));
        of_ends.sum::<f64>() + wheels.sum::<f64>()
    };
    passage.pieces.list.iter().enumerate().map(of).collect()
}

/// Minus the second derivative of a deflection (sign 0) or of its negative (1) at most, by bounds of plus and minus.
fn bulge([above, below]: [f64; 2], sign: usize) -> f64 {
    if sign == 0 {
        below.max(0.0)
    } else {
        above.max(0.0)
    }
}

/// By how much sign times response k, apart from the bulge of a deflection, can exceed its values at the ends of a part of the carrier.
fn margin(passage: &Passage, piece: usize, k: usize, part: usize) -> f64 {
    let length = passage.on.length();
    let h = length / PARTS as f64;
    let time = passage.pieces.list[piece].length();
    let [from, to] = [part as f64 * h, (part + 1) as f64 * h];
    let within = passage.wheels(piece).iter().filter(|wheel| {
        let ends = [wheel.start, wheel.start + wheel.rate * time];
        ends[0].min(ends[1]) <= to + ROUNDING * length
            && ends[0].max(ends[1]) >= from - ROUNDING * length
    });
    if let Some(direction) = k.checked_sub(QUANTITIES) {
        return within
            .map(|w| w.kernel(direction).slope().abs())
            .sum::<f64>()
            * h
            / 4.0;
    }
    within
        .map(|wheel| {
            let [jump, kink, ..] = wheel.behind(k);
            jump.abs() + kink.abs() * h / 4.0
        })
        .sum()
}
