//! A structure as a chain of rigid parts joined by beams, and the transfer of a wheel from one part to the next.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::{Compliance, Error, ExactSurface, Influence, PlaceDisplacements, Probe, Rails};

use super::structure::Shapes;
use crate::numerics::step::step;

/// The rigid parts under one rail.
///
/// Part j carries the rail from its left to its right end. Near the joint of two parts the reference line of the rail
/// changes from one part to the next by a STEP function over a window, which extends from centre to centre or over a
/// given length about the joint.
#[derive(Clone, Debug, PartialEq)]
pub struct PartChain {
    ends: Vec<f64>,
    windows: Vec<[f64; 2]>,
    first: usize,
}

impl PartChain {
    /// Parts between the increasing coordinates `ends`. The rail of part j is rail `first` + j of the line of parts.
    /// `window` is the length of the hand-over about each joint; `None`: from centre to centre.
    ///
    /// Returns `None` for fewer than one part, ends that do not increase, or windows that overlap.
    #[must_use]
    pub fn new(ends: Vec<f64>, first: usize, window: Option<f64>) -> Option<Self> {
        if ends.len() < 2 || !ends.windows(2).all(|pair| pair[0] < pair[1]) {
            return None;
        }
        let centre = |j: usize| 0.5 * (ends[j] + ends[j + 1]);
        let windows: Vec<[f64; 2]> = (0..ends.len() - 2)
            .map(|j| match window {
                Some(length) => [ends[j + 1] - 0.5 * length, ends[j + 1] + 0.5 * length],
                None => [centre(j), centre(j + 1)],
            })
            .collect();
        let slack = 1e-9 * (ends[ends.len() - 1] - ends[0]);
        if windows.iter().any(|w| w[0] >= w[1])
            || windows
                .windows(2)
                .any(|pair| pair[0][1] > pair[1][0] + slack)
        {
            return None;
        }
        Some(PartChain {
            ends,
            windows,
            first,
        })
    }

    /// Number of parts.
    #[must_use]
    pub fn count(&self) -> usize {
        self.ends.len() - 1
    }

    /// Rail index of part `j` in the line of parts.
    #[must_use]
    pub fn rail(&self, j: usize) -> usize {
        self.first + j
    }

    /// First and last coordinate.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.ends[0], self.ends[self.ends.len() - 1]]
    }

    /// Ends of the hand-over windows.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        self.windows.iter().flatten().copied().collect()
    }

    /// Weight of part `j` in the support of a wheel at `x`, and its slope. The weights of all parts sum to one.
    #[must_use]
    pub fn fraction(&self, j: usize, x: f64) -> [f64; 2] {
        let mut share = [1.0, 0.0];
        if j > 0 {
            let [a, b] = self.windows[j - 1];
            let (value, slope) = step(x, a, 0.0, b, 1.0);
            share = [value, slope];
        }
        if j + 1 < self.count() {
            let [a, b] = self.windows[j];
            let (value, slope) = step(x, a, 0.0, b, 1.0);
            share[0] -= value;
            share[1] -= slope;
        }
        share
    }

    /// Parts that carry a wheel at `x`, with their weights and slopes.
    fn carriers(&self, x: f64) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        let at = self.windows.partition_point(|window| window[1] <= x);
        (at..self.count().min(at + 2))
            .map(move |j| (j, self.fraction(j, x)))
            .filter(|(_, share)| share[0] != 0.0)
    }
}

/// Blended compliance of massless parts: G(p, q) = sum of s_a(p) s_b(q) G_ab(p, q) over the parts a and b that carry
/// p and q, with their weights s. It is symmetric and positive by construction.
pub struct BlendedParts {
    /// Compliance of the parts, each of which is a rail of its own.
    pub surface: ExactSurface,
    /// One chain per rail.
    pub chains: Vec<PartChain>,
}

/// Index of the probe that a part carries, with the weight of the part and its slope.
type Owner = (usize, [f64; 2]);

/// Probes on the parts that carry the points `at`, with their weights.
fn spread(chains: &[PartChain], at: &[Probe]) -> Result<(Vec<Probe>, Vec<Owner>), Error> {
    let (mut probes, mut owners) = (
        Vec::with_capacity(2 * at.len()),
        Vec::with_capacity(2 * at.len()),
    );
    for (i, probe) in at.iter().enumerate() {
        let chain = chains
            .get(probe.rail)
            .ok_or(Error::NoRail { rail: probe.rail })?;
        let [from, to] = chain.range();
        if !(probe.x >= from && probe.x <= to) {
            return Err(Error::OffRail {
                rail: probe.rail,
                x: probe.x,
            });
        }
        for (part, share) in chain.carriers(probe.x) {
            probes.push(Probe {
                rail: chain.rail(part),
                ..*probe
            });
            owners.push((i, share));
        }
    }
    Ok((probes, owners))
}

/// The shares of the parts in loads.
fn carried(chains: &[PartChain], loads: &[(Probe, f64)]) -> Result<Vec<(Probe, f64)>, Error> {
    let at: Vec<Probe> = loads.iter().map(|(probe, _)| *probe).collect();
    let (probes, owners) = spread(chains, &at)?;
    Ok(probes
        .into_iter()
        .zip(owners)
        .map(|(probe, (i, share))| (probe, share[0] * loads[i].1))
        .collect())
}

/// Writes the displacements of places by those of the parts that carry them.
fn blend(owners: &[Owner], moved: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for ((i, share), moved) in owners.iter().zip(moved) {
        out[*i] += share[0] * moved;
    }
}

impl Compliance for BlendedParts {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let (probes, owners) = spread(&self.chains, at)?;
        let mut inner = Influence::zeros(probes.len());
        self.surface.fill(&probes, &mut inner)?;
        out.value.fill(0.0);
        out.slope.fill(0.0);
        for (r, &(i, row)) in owners.iter().enumerate() {
            for (c, &(j, column)) in owners.iter().enumerate() {
                let value = inner.value[(r, c)];
                out.value[(i, j)] += row[0] * column[0] * value;
                out.slope[(i, j)] += column[0] * (row[0] * inner.slope[(r, c)] + row[1] * value);
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
        let (probes, owners) = spread(&self.chains, at)?;
        let mut moved = vec![0.0; probes.len()];
        self.surface
            .displacements(&probes, &carried(&self.chains, loads)?, &mut moved)?;
        blend(&owners, &moved, out);
        Ok(())
    }

    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        let (probes, owners) = spread(&self.chains, at)?;
        let places = self.surface.at_places(&probes)?;
        Ok(Box::new(BlendedPlaces {
            places,
            owners,
            count: at.len(),
            chains: &self.chains,
        }))
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.chains
            .get(rail)
            .map_or_else(Vec::new, PartChain::breaks)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.chains.get(rail).map(PartChain::range)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// Displacements of fixed places of blended parts: those of the places on the parts, with the weights of the parts, under
/// the shares of the parts in the loads.
struct BlendedPlaces<'a> {
    places: Box<dyn PlaceDisplacements + 'a>,
    owners: Vec<Owner>,
    count: usize,
    chains: &'a [PartChain],
}

impl PlaceDisplacements for BlendedPlaces<'_> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        let (others, owners) = spread(self.chains, also)?;
        let mut moved = vec![0.0; self.owners.len() + others.len()];
        self.places
            .under(&carried(self.chains, loads)?, &others, &mut moved)?;
        let (own, others) = moved.split_at(self.owners.len());
        let (out, also) = out.split_at_mut(self.count);
        blend(&self.owners, own, out);
        blend(&owners, others, also);
        Ok(())
    }
}

/// Shape functions of the degrees of freedom of the parts. The node state of every part is `basis` times the degrees
/// of freedom.
pub struct PartShapes {
    /// The parts, each of which is a rigid arm and a rail of its own.
    pub line: Arc<Rails>,
    /// Matrix with one row per node state (six per part) and one column per degree of freedom.
    pub basis: DMatrix<f64>,
    /// One chain per rail, whose reference line is blended.
    pub chains: Vec<PartChain>,
    /// Whether probes refer to the rails of the individual parts, each with a force of its own, instead of the
    /// blended rail.
    pub separate: bool,
}

impl Shapes for PartShapes {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        value.fill(0.0);
        slope.fill(0.0);
        let carriers = if self.separate {
            vec![(at, [1.0, 0.0])]
        } else {
            let (probes, owners) = spread(&self.chains, &[at])?;
            probes
                .into_iter()
                .zip(owners.into_iter().map(|(_, share)| share))
                .collect()
        };
        for (probe, share) in carriers {
            let row = self.line.row(probe)?;
            for ((&state, shape), shape_slope) in
                row.indices().iter().zip(row.values()).zip(row.slopes())
            {
                for k in 0..value.len() {
                    value[k] += share[0] * shape * self.basis[(state, k)];
                    slope[k] +=
                        (share[0] * shape_slope + share[1] * shape) * self.basis[(state, k)];
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::PartChain;

    #[test]
    fn shares_add_to_one_and_their_slopes_to_zero() {
        let chain =
            PartChain::new(vec![-15.0, 10.0, 30.0, 75.0], 0, None).expect("increasing ends");
        for i in 0..=90 {
            let x = f64::from(i) - 15.0;
            let sums = (0..3)
                .map(|j| chain.fraction(j, x))
                .fold([0.0, 0.0], |s, w| [s[0] + w[0], s[1] + w[1]]);
            assert!((sums[0] - 1.0).abs() < 1e-14 && sums[1].abs() < 1e-14);
            let carried: f64 = chain.carriers(x).map(|(_, share)| share[0]).sum();
            assert!((carried - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_window_of_a_given_length_is_centred_on_the_joint() {
        let chain =
            PartChain::new(vec![-15.0, 30.0, 75.0], 0, Some(60.0)).expect("increasing ends");
        assert_eq!(chain.breaks(), vec![0.0, 60.0]);
        assert_eq!(chain.fraction(1, 30.0)[0], 0.5);
    }
}
