//! A give without some of its couplings, as engineers leave them out who treat each rail alone.

use crate::{Compliance, Error, Influence, Probe};

/// Which couplings of a give are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Couplings {
    /// Every one: a load on a rail moves all rails in all directions.
    #[default]
    All,
    /// Those within each rail: a load on a rail moves no other.
    WithinRails,
    /// None: a load moves its own rail in its own direction alone.
    None,
}

impl Couplings {
    /// Whether displacements at `p` by forces at `q` are kept.
    #[must_use]
    pub fn keep(self, p: &Probe, q: &Probe) -> bool {
        match self {
            Couplings::All => true,
            Couplings::WithinRails => p.rail == q.rail,
            Couplings::None => p.rail == q.rail && p.axis == q.axis,
        }
    }
}

/// A give whose couplings across groups of probes are zero:
///
/// G'(p, q) = G(p, q) where `couplings` keeps the pair, else 0.
///
/// Of a symmetric positive semidefinite G this is one too, since what is kept are diagonal blocks of G in some order of the
/// probes.
#[derive(Clone, Debug)]
pub struct Parted<C> {
    whole: C,
    couplings: Couplings,
}

impl<C: Compliance> Parted<C> {
    /// `whole` with `couplings` alone.
    #[must_use]
    pub const fn new(whole: C, couplings: Couplings) -> Self {
        Parted { whole, couplings }
    }
}

impl<C: Compliance> Compliance for Parted<C> {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.whole.fill(at, out)?;
        for (j, q) in at.iter().enumerate() {
            for (i, p) in at.iter().enumerate() {
                if !self.couplings.keep(p, q) {
                    (out.value[(i, j)], out.slope[(i, j)]) = (0.0, 0.0);
                }
            }
        }
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.whole.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.whole.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        self.whole.is_symmetric()
    }
}
