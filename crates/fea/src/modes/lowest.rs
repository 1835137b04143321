//! The lowest natural modes, with a proof that none is missing.

use nalgebra::DVector;

use crate::error::Error;
use crate::factor::Factor;
use crate::influence::FactoredFrame;
use crate::model::{Model, Rail};
use crate::modes::all::{MOST_DENSE_UNKNOWNS, spectrum};
use crate::modes::decoupled::{ExcitingForces, Part};
use crate::modes::lanczos::{Lanczos, Pencil, PencilFactor};
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
/// Error of a frequency (eps times condition) that is accepted from a factor in doubles: of modes that are asked for,
/// and of modes that are the degrees of freedom of a simulation, whose members are cut for the same error.
const DOUBLES_SUFFICE: [f64; 2] = [1e-9, 1e-6];
/// Most searches, each continued after a count that found more.
const ATTEMPTS: usize = 12;
/// Number of unknowns for each mode up to which dense matrices are faster than the search.
const DENSE_UNKNOWNS_PER_MODE: usize = 6;
/// Number of unknowns up to which dense matrices are always faster.
const FEW_UNKNOWNS: usize = 100;

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
    /// # Errors
    /// As [`FactoredFrame::excited_modes`].
    pub fn modes(&self, m: &Model, count: usize) -> Result<Modes, Error> {
        let in_groups = false;
        self.lowest_of_all(m, Asked { count, in_groups })
    }

    /// [`FactoredFrame::modes`]; where the last of them has a frequency that further modes share, to a relative difference of
    /// 1e-6 in its square, these are returned too.
    pub(super) fn modes_in_groups(&self, m: &Model, count: usize) -> Result<Modes, Error> {
        let in_groups = true;
        self.lowest_of_all(m, Asked { count, in_groups })
    }

    fn lowest_of_all(&self, m: &Model, asked: Asked) -> Result<Modes, Error> {
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, self.stiffness())?;
        self.lowest_of(&Part::whole(self, &mass), &mass, asked, DOUBLES_SUFFICE[0])
    }

    /// The `count` lowest modes among those of the unknowns that `forces` can move; `m` is the model that the frame
    /// was made of. Modes of the other unknowns do not move under these forces.
    ///
    /// Small problems are solved with dense matrices. Otherwise shift-invert block Lanczos finds the modes. Then
    /// L D L^T of K - sigma^2 M is formed, with sigma between the last frequency and the next: its negative pivots
    /// count the modes below sigma. If rounding does not allow the count, dense matrices show that none is missing,
    /// provided that there are at most [`MOST_DENSE_UNKNOWNS`] unknowns.
    ///
    /// # Errors
    /// [`Error::Mechanism`] for a degree of freedom with mass that nothing stiffens; [`Error::NoMass`];
    /// [`Error::Modes`] for modes that could not be found or counted.
    ///
    /// # Source
    /// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15.
    pub fn excited_modes(
        &self,
        m: &Model,
        forces: &ExcitingForces,
        count: usize,
    ) -> Result<Modes, Error> {
        self.lowest_excited(m, forces, count, 0.0)
    }

    /// [`FactoredFrame::excited_modes`], whose frequencies may have the relative error `error` by rounding if that is
    /// more than 1e-6.
    pub(super) fn lowest_excited(
        &self,
        m: &Model,
        forces: &ExcitingForces,
        count: usize,
        error: f64,
    ) -> Result<Modes, Error> {
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, self.stiffness())?;
        let part = Part::moved_by(forces, self.rail_loads(), self.stiffness(), &mass);
        let asked = Asked {
            count,
            in_groups: false,
        };
        self.lowest_of(&part, &mass, asked, error.max(DOUBLES_SUFFICE[1]))
    }

    /// The lowest modes of `part`; its frequencies may have the relative error `error`.
    fn lowest_of(
        &self,
        part: &Part,
        mass: &ScaledMass,
        asked: Asked,
        error: f64,
    ) -> Result<Modes, Error> {
        let Asked { count, .. } = asked;
        let norms = self.norms(mass)?;
        let suffices = self.certificate().condition * f64::EPSILON < error;
        let is_small = part.len() <= FEW_UNKNOWNS.max(DENSE_UNKNOWNS_PER_MODE * count);
        let pairs = if suffices && is_small && part.len() <= MOST_DENSE_UNKNOWNS {
            dense(part, asked)
        } else {
            match self.lanczos(part, asked, suffices) {
                Err(error @ Error::Modes { .. }) if part.len() <= MOST_DENSE_UNKNOWNS => {
                    dense(part, asked).or(Err(error))
                }
                found => found,
            }
        };
        let (pairs, shown) = pairs?;
        let mode = |(lambda, phi)| self.mode(part, mass, norms, lambda, &phi);
        Ok(self.collect_modes(pairs.into_iter().map(mode).collect(), shown, mass))
    }

    /// The lowest modes by Lanczos, counted. Inverse iterations need many solves: where doubles suffice, the factor
    /// is in doubles.
    fn lanczos(
        &self,
        part: &Part,
        asked: Asked,
        doubles_suffice: bool,
    ) -> Result<(Pairs, Count), Error> {
        let double = if doubles_suffice {
            Factor::new(&part.stiffness).ok()
        } else {
            None
        };
        let factor = match &double {
            Some(factor) => PencilFactor::Own(factor),
            None => PencilFactor::OfFrame(self.solver(), part),
        };
        let mut lanczos = Lanczos::new(Pencil {
            stiffness: &part.stiffness,
            mass: &part.mass,
            factor,
        });
        let cut = search(&mut lanczos, asked.count)?;
        let found = asked
            .listed(&lanczos.converged_values())
            .min(lanczos.pairs.converged);
        let next = lanczos
            .converged_values()
            .get(found)
            .map(|lambda| lambda.sqrt());
        Ok((
            lanczos.modes(found),
            Count {
                shift: cut.lambda.sqrt(),
                below: cut.below,
                next,
            },
        ))
    }
}

/// The modes that are asked for.
#[derive(Clone, Copy)]
struct Asked {
    count: usize,
    /// Whether those of equal frequency are all returned where one of them is.
    in_groups: bool,
}

impl Asked {
    /// How many of all eigenvalues, increasing, are returned.
    fn listed(&self, all: &[f64]) -> usize {
        let next = (self.count.max(1)..all.len())
            .find(|&next| !self.in_groups || is_wide(all, next))
            .unwrap_or(all.len());
        if self.count == 0 { 0 } else { next }
    }
}

/// Whether the eigenvalue with some index is not equal to the one before it.
fn is_wide(all: &[f64], index: usize) -> bool {
    all[index] - all[index - 1] > LEAST_GAP * all[index]
}

/// Eigenvalues lambda and their vectors.
type Pairs = Vec<(f64, DVector<f64>)>;

/// The lowest modes from dense matrices, which give all of them.
///
/// # Errors
/// [`Error::Modes`] if the matrices have no factor or no eigenvalues in doubles.
fn dense(part: &Part, asked: Asked) -> Result<(Pairs, Count), Error> {
    let mut pairs = spectrum(&part.stiffness, &part.mass, usize::MAX).ok_or(Error::Modes {
        asked: asked.count,
        found: 0,
    })?;
    let all: Vec<f64> = pairs.iter().map(|pair| pair.0).collect();
    let count = asked.listed(&all);
    let next = pairs.get(count).map(|pair| pair.0);
    pairs.truncate(count);
    let last = pairs.last().map_or(0.0, |pair| pair.0);
    // In the middle of the gap behind the last mode, which may be of no width.
    let shift = next.map_or(2.0 * last, |next| 0.5 * (last + next)).sqrt();
    let below = pairs.iter().filter(|pair| pair.0.sqrt() < shift).count();
    Ok((
        pairs,
        Count {
            shift,
            below,
            next: next.map(f64::sqrt),
        },
    ))
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
    let fail = |known: usize| Error::Modes {
        asked: count,
        found: known.min(count),
    };
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
            Ok(None)
                if complete && !lanczos.pairs.exhausted && known.len() < count + MOST_EXTRA =>
            {
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
                return Ok(Some((
                    Cut {
                        lambda,
                        below: found,
                    },
                    below,
                )));
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
    let wide = |&cut: &usize| is_wide(known, cut);
    let between = |cut: usize| Gap {
        below: cut,
        low: known[cut - 1],
        high: known[cut],
    };
    let mut out: Vec<Gap> = (count.max(1)..known.len())
        .filter(wide)
        .take(GAPS)
        .map(between)
        .collect();
    if let Some(&last) = known.last().filter(|_| exhausted) {
        out.push(Gap {
            below: known.len(),
            low: last,
            high: 3.0 * last,
        });
    }
    if out.is_empty() && known.len() >= count + MOST_EXTRA {
        out.extend((1..count).rev().filter(wide).take(GAPS).map(between));
        out.push(Gap {
            below: 0,
            low: 0.0,
            high: known[0],
        });
    }
    out
}
