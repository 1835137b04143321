//! A surface less what deflections of members under uniform loads account for.

use crate::compliance::{Compliance, Influence, PlaceDisplacements};
use crate::error::Error;
use crate::probe::Probe;

use super::exact::ExactSurface;

/// A surface G without the part of motions that are the deflections w of members with clamped ends under uniform loads:
///
/// G'(p, q) = G(p, q) - sum over planes of t^2 w(p) w(q),    p and q on the same member,
///
/// where t is the intensity of the load at which twice the strain energy of the deflection is one (or zero where the
/// motion does not exist). It is what natural modes leave of the static compliance if such deflections belong to their
/// unknowns.
///
/// Guarantee: positive semi-definite where `whole` is that of clamped members at least.
#[derive(Clone, Debug)]
pub struct ElementResidual {
    whole: ExactSurface,
    /// For each rail element the squares of t, along the local y and z axes of its member.
    squares: Vec<[f64; 2]>,
    /// Whether there is any such motion.
    is_less: bool,
}

impl ElementResidual {
    /// The surface `whole` without the deflections; `squares` has t^2 for each rail element along the local y and z axes
    /// of its member, force squared/length squared/energy.
    #[must_use]
    pub fn new(whole: ExactSurface, squares: Vec<[f64; 2]>) -> ElementResidual {
        let is_less = squares.iter().flatten().any(|&square| square != 0.0);
        ElementResidual {
            whole,
            squares,
            is_less,
        }
    }

    fn deflections(&self, at: &[Probe]) -> Result<Vec<Deflection>, Error> {
        at.iter()
            .map(|probe| self.whole.rails().uniform_load(*probe))
            .collect()
    }

    /// Takes the part of the motions from displacements of places under loads.
    fn take(
        &self,
        places: &[Deflection],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        let rails = self.whole.rails();
        for (probe, force) in loads {
            let (own, other) = rails.uniform_load(*probe)?;
            let squares = self.squares.get(own).copied().unwrap_or_default();
            for ((element, one), out) in places.iter().zip(out.iter_mut()) {
                if rails.clamped_on_one_member(*element, own).is_some() {
                    *out -= force
                        * (0..2)
                            .map(|k| squares[k] * one[k][0] * other[k][0])
                            .sum::<f64>();
                }
            }
        }
        Ok(())
    }
}

/// The element of a place, and the deflections there under both uniform loads, with slopes.
type Deflection = (usize, [[f64; 2]; 2]);

impl Compliance for ElementResidual {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.whole.fill(at, out)?;
        if !self.is_less {
            return Ok(());
        }
        let rails = self.whole.rails();
        for (j, &q) in at.iter().enumerate() {
            let (own, other) = rails.uniform_load(q)?;
            let squares = self.squares.get(own).copied().unwrap_or_default();
            for (i, &p) in at.iter().enumerate() {
                let (element, one) = rails.uniform_load(p)?;
                if rails.clamped_on_one_member(element, own).is_none() {
                    continue;
                }
                for k in 0..2 {
                    let factor = squares[k] * other[k][0];
                    out.value[(i, j)] -= one[k][0] * factor;
                    out.slope[(i, j)] -= one[k][1] * factor;
                }
            }
        }
        Ok(())
    }

    fn displacements(
        &self,
        at: &[Probe],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        self.whole.displacements(at, loads, out)?;
        if self.is_less {
            self.take(&self.deflections(at)?, loads, out)
        } else {
            Ok(())
        }
    }

    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        let whole = self.whole.at_places(at)?;
        if !self.is_less {
            return Ok(whole);
        }
        Ok(Box::new(LesserPlaces {
            of: self,
            whole,
            deflections: self.deflections(at)?,
        }))
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

/// Fixed places with the deflections there.
struct LesserPlaces<'a> {
    of: &'a ElementResidual,
    whole: Box<dyn PlaceDisplacements + 'a>,
    deflections: Vec<Deflection>,
}

impl PlaceDisplacements for LesserPlaces<'_> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        self.whole.under(loads, also, out)?;
        let (out, others) = out.split_at_mut(self.deflections.len());
        self.of.take(&self.deflections, loads, out)?;
        self.of.take(&self.of.deflections(also)?, loads, others)
    }
}
