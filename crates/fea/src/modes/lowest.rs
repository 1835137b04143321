//! The lowest natural modes, with a proof that none is missing.

use crate::error::Error;
use crate::factor::{Factor, Solver};
use crate::influence::FactoredFrame;
use crate::model::{Model, Rail};
use crate::modes::lanczos::{Lanczos, Pencil};
use crate::modes::mass::ScaledMass;
use crate::modes::mode::{Count, Modes};

/// Smallest distance, relative to lambda, of two eigenvalues between which a count is taken.
const LEAST_GAP: f64 = 1e-6;
/// Fractions of a gap at which the count is tried, in this order.
const PLACES: [f64; 6] = [0.5, 0.4, 0.6, 0.25, 0.75, 0.1];
/// Number of eigenvalues beyond those asked for among which a gap is looked for.
const MOST_EXTRA: usize = 64;
/// Number of gaps that are tried at a time.
const GAPS: usize = 3;
/// Number of further eigenvalues that are computed if none of the gaps can be used.
const STEP: usize = 8;
/// Error of a frequency (eps times condition) that is accepted from a factor in doubles.
const DOUBLES_SUFFICE: f64 = 1e-9;
/// Most searches, each continued after a count that found more.
const ATTEMPTS: usize = 12;

/// The `count` lowest modes of a frame: K phi = omega^2 M phi, M the consistent mass of the members (mass per
/// length of their sections) and the rigid masses.
///
/// Guarantee: no mode is missing ([`Modes::count_below_shift`]). Fewer are returned if fewer frequencies are finite.
///
/// # Errors
/// As [`FactoredFrame::new`] and [`FactoredFrame::modes`].
pub fn modes(m: &Model, rails: &[Rail], count: usize) -> Result<Modes, Error> {
    FactoredFrame::new(m, rails)?.modes(m, count)
}

impl FactoredFrame {
    /// [`modes`] of a frame that is already factored; `m` is the model that the frame was made of.
    ///
    /// Shift-invert block Lanczos finds the modes. Then L D L^T of K - sigma^2 M is formed, with sigma between
    /// the last frequency and the next: its negative pivots count the modes below sigma.
    ///
    /// # Errors
    /// [`Error::Mechanism`] for a degree of freedom with mass that nothing stiffens; [`Error::NoMass`];
    /// [`Error::Modes`] for modes that could not be found or counted.
    ///
    /// # Source
    /// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15.
    pub fn modes(&self, m: &Model, count: usize) -> Result<Modes, Error> {
        let (stiffness, solver) = (self.stiffness(), self.solver());
        // Inverse iterations need many solves: double-doubles only where doubles would cost digits.
        let double = match solver {
            Solver::Extended(_) if self.certificate().condition * f64::EPSILON < DOUBLES_SUFFICE => {
                Factor::new(&stiffness.upper).ok().map(Solver::Double)
            }
            _ => None,
        };
        let factor = double.as_ref().unwrap_or(solver);
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, stiffness)?;
        let norms = self.norms(&mass)?;
        let pencil = Pencil { stiffness: &stiffness.upper, mass: &mass.upper, factor };
        let mut lanczos = Lanczos::new(pencil);
        let cut = search(&mut lanczos, count)?;
        let found = count.min(lanczos.pairs.converged);
        let next = lanczos.converged_values().get(found).map(|lambda| lambda.sqrt());
        let mode = |(lambda, phi)| self.mode(&mass, norms, lambda, &phi);
        let modes = lanczos.modes(found).into_iter().map(mode).collect();
        Ok(self.collect_modes(modes, Count { shift: cut.lambda.sqrt(), below: cut.below, next }, &mass))
    }
}

/// A shift, and the number of eigenvalues below it.
struct Cut {
    lambda: f64,
    below: usize,
}

/// Finds the `count` lowest eigenvalues, and a shift below which all are known.
///
/// One eigenvalue more than asked for is computed. In a gap behind the last one asked for the eigenvalues
/// below a shift are counted. If the count agrees, the search ends. If more were counted than found, some are
/// missing: the iteration starts again from random vectors orthogonal to all that are known. If no gap can be
/// used, more eigenvalues are computed, until a gap turns up among them.
///
/// # Errors
/// [`Error::Modes`] if the counts never agree.
fn search(lanczos: &mut Lanczos<'_>, count: usize) -> Result<Cut, Error> {
    let fail = |known: usize| Error::Modes { asked: count, found: known.min(count) };
    let mut need = count + 1;
    for _ in 0..ATTEMPTS {
        let complete = lanczos.converge(need);
        let known = lanczos.converged_values();
        match first_count(lanczos, gaps(&known, count, lanczos.pairs.exhausted)) {
            Err(()) => return Err(fail(known.len())),
            Ok(Some((cut, below))) if cut.below == below => return Ok(cut),
            Ok(Some((cut, below))) if cut.below > below => {
                lanczos.restart_randomly();
                need = known.len() + (cut.below - below);
            }
            Ok(Some(_)) => return Err(fail(known.len())),
            Ok(None) if complete && !lanczos.pairs.exhausted && known.len() < count + MOST_EXTRA => {
                need = known.len() + STEP;
            }
            Ok(None) => break,
        }
    }
    Err(fail(lanczos.converged_values().len()))
}

/// A count in the first gap in which rounding allows one, and the number of eigenvalues known below that gap;
/// fails if a matrix cannot be factored.
fn first_count(lanczos: &Lanczos<'_>, gaps: Vec<Gap>) -> Result<Option<(Cut, usize)>, ()> {
    for Gap { below, low, high } in gaps {
        for place in PLACES {
            let lambda = low + place * (high - low);
            if let Some(found) = lanczos.count_below(lambda).map_err(|_| ())? {
                return Ok(Some((Cut { lambda, below: found }, below)));
            }
        }
    }
    Ok(None)
}

/// An interval without known eigenvalues, and the number of those below it.
struct Gap {
    below: usize,
    low: f64,
    high: f64,
}

/// Gaps in which to count: those above the first `count` eigenvalues, the nearest first. If there is none
/// within `MOST_EXTRA` further eigenvalues, those below.
fn gaps(known: &[f64], count: usize, exhausted: bool) -> Vec<Gap> {
    let wide = |&cut: &usize| known[cut] - known[cut - 1] > LEAST_GAP * known[cut];
    let between = |cut: usize| Gap { below: cut, low: known[cut - 1], high: known[cut] };
    let mut out: Vec<Gap> = (count.max(1)..known.len()).filter(wide).take(GAPS).map(between).collect();
    if let Some(&last) = known.last().filter(|_| exhausted) {
        out.push(Gap { below: known.len(), low: last, high: 3.0 * last });
    }
    if out.is_empty() && known.len() >= count + MOST_EXTRA {
        out.extend((1..count).rev().filter(wide).take(GAPS).map(between));
        out.push(Gap { below: 0, low: 0.0, high: known[0] });
    }
    out
}
