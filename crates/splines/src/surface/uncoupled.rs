//! A compliance without some of its couplings, as in models that treat each rail or each direction alone.

use crate::compliance::{Compliance, Influence, PlaceDisplacements};
use crate::error::Error;
use crate::probe::Probe;

/// Which couplings of a compliance are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Couplings {
    /// All: a load on a rail moves all rails in all directions.
    #[default]
    All,
    /// Those within each rail: a load on a rail moves no other rail.
    WithinRails,
    /// None: a load moves its own rail, in its own direction alone.
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

/// A compliance without the couplings between groups of probes:
///
/// G'(p, q) = G(p, q) where `couplings` keeps the pair, else 0.
///
/// Guarantee: G' is symmetric and positive semi-definite where G is, since in some order of the probes it
/// consists of diagonal blocks of G.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::{Axis, Compliance, Couplings, Influence, ReadingMethod, Uncoupled, Probe, TableReading, InfluenceBlock, SplineTable};
///
/// // Two rails whose deflections are all one, whatever the load.
/// let x = vec![0.0, 1.0, 2.0, 3.0];
/// let table = SplineTable::new(x.clone(), x, DMatrix::from_element(4, 4, 1.0))?;
/// let block = |deflection, load| InfluenceBlock {
///     deflection: (deflection, Axis::Vertical),
///     load: (load, Axis::Vertical),
///     table: table.clone(),
/// };
/// let whole = TableReading::new(ReadingMethod::Natural, &[block(0, 0), block(0, 1), block(1, 1)])?;
///
/// let at = [0, 1].map(|rail| Probe { rail, x: 1.0, axis: Axis::Vertical });
/// let mut out = Influence::zeros(2);
/// whole.fill(&at, &mut out)?;
/// assert_eq!(out.value[(0, 1)], 1.0);
/// Uncoupled::new(whole, Couplings::WithinRails).fill(&at, &mut out)?;
/// assert_eq!(out.value[(0, 1)], 0.0);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Uncoupled<C> {
    whole: C,
    couplings: Couplings,
}

impl<C: Compliance> Uncoupled<C> {
    /// `whole` with the given couplings alone.
    #[must_use]
    pub const fn new(whole: C, couplings: Couplings) -> Self {
        Uncoupled { whole, couplings }
    }

    /// Indices of the probes in groups between which no couplings are kept.
    fn groups(&self, at: &[Probe]) -> Vec<Vec<usize>> {
        let mut out: Vec<Vec<usize>> = Vec::new();
        for (i, probe) in at.iter().enumerate() {
            match out
                .iter_mut()
                .find(|group| self.couplings.keep(&at[group[0]], probe))
            {
                Some(group) => group.push(i),
                None => out.push(vec![i]),
            }
        }
        out
    }

    /// The loads whose couplings with a probe are kept.
    fn loads_of(&self, probe: &Probe, loads: &[(Probe, f64)]) -> Vec<(Probe, f64)> {
        loads
            .iter()
            .filter(|load| self.couplings.keep(probe, &load.0))
            .copied()
            .collect()
    }
}

/// Fixed places, group by group.
struct UncoupledPlaces<'a, C> {
    of: &'a Uncoupled<C>,
    groups: Vec<PlaceGroup<'a>>,
}

struct PlaceGroup<'a> {
    /// One of its probes.
    first: Probe,
    places: Box<dyn PlaceDisplacements + 'a>,
    /// Indices of its places among all.
    indices: Vec<usize>,
}

impl<C: Compliance> PlaceDisplacements for UncoupledPlaces<'_, C> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        let count = out.len() - also.len();
        let mut is_done = vec![false; also.len()];
        for PlaceGroup {
            first,
            places,
            indices,
        } in &self.groups
        {
            let own: Vec<usize> = (0..also.len())
                .filter(|i| self.of.couplings.keep(first, &also[*i]))
                .collect();
            let others: Vec<Probe> = own.iter().map(|i| also[*i]).collect();
            let mut values = vec![0.0; indices.len() + own.len()];
            places.under(&self.of.loads_of(first, loads), &others, &mut values)?;
            let all = indices.iter().copied().chain(own.iter().map(|i| count + i));
            all.zip(values).for_each(|(i, value)| out[i] = value);
            own.into_iter().for_each(|i| is_done[i] = true);
        }
        // probes that no place is coupled with
        for i in (0..also.len()).filter(|i| !is_done[*i]) {
            let on = self.of.loads_of(&also[i], loads);
            self.of
                .whole
                .displacements(&also[i..=i], &on, &mut out[count + i..=count + i])?;
        }
        Ok(())
    }
}

impl<C: Compliance> Compliance for Uncoupled<C> {
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

    /// Each group of probes between which couplings are kept, with the loads in it, is evaluated on its own.
    fn displacements(
        &self,
        at: &[Probe],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        for group in self.groups(at) {
            let places: Vec<Probe> = group.iter().map(|i| at[*i]).collect();
            let on = self.loads_of(&places[0], loads);
            let mut own = vec![0.0; places.len()];
            self.whole.displacements(&places, &on, &mut own)?;
            group
                .into_iter()
                .zip(own)
                .for_each(|(i, value)| out[i] = value);
        }
        Ok(())
    }

    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        let prepared = |indices: Vec<usize>| {
            let places: Vec<Probe> = indices.iter().map(|i| at[*i]).collect();
            Ok(PlaceGroup {
                first: places[0],
                places: self.whole.at_places(&places)?,
                indices,
            })
        };
        let groups = self
            .groups(at)
            .into_iter()
            .map(prepared)
            .collect::<Result<_, Error>>()?;
        Ok(Box::new(UncoupledPlaces { of: self, groups }))
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
