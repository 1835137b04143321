//! The interface of every compliance: influence coefficients between any set of probes.

use nalgebra::DMatrix;

use crate::error::Error;
use crate::probe::Probe;

/// Influence coefficients of a set of n probes, and their slopes along the rail.
///
/// ```
/// use splines::Influence;
///
/// let out = Influence::zeros(3);
/// assert_eq!(out.value.shape(), (3, 3));
/// assert_eq!(out.slope.shape(), (3, 3));
/// ```
#[derive(Clone, Debug)]
pub struct Influence {
    /// n x n: `value[(i, j)]` is the displacement at probe i along its axis per unit force at probe j along
    /// its axis, length/force.
    pub value: DMatrix<f64>,
    /// n x n: `slope[(i, j)]` is the derivative of `value[(i, j)]` with respect to the coordinate of probe i,
    /// 1/force.
    pub slope: DMatrix<f64>,
}

impl Influence {
    /// Matrices of zeros for n probes.
    #[must_use]
    pub fn zeros(n: usize) -> Self {
        Influence {
            value: DMatrix::zeros(n, n),
            slope: DMatrix::zeros(n, n),
        }
    }

    /// Checks that both matrices are n x n.
    pub(crate) fn expect(&self, n: usize) -> Result<(), Error> {
        for matrix in [&self.value, &self.slope] {
            let (rows, columns) = matrix.shape();
            if (rows, columns) != (n, n) {
                return Err(Error::OutputShape {
                    rows,
                    columns,
                    expected: n,
                });
            }
        }
        Ok(())
    }
}

/// Probes whose displacements are evaluated together.
const GROUP: usize = 12;

/// Groups of probes that move along their rails together: a unit load of a group is the force `weight` on each of its members,
/// and its displacement the sum of those of its members, each times its weight.
///
/// Made for many evaluations by [`Compliance::fill_groups`], between which the coordinates of `probes` change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProbeGroups {
    /// Number of groups.
    pub count: usize,
    /// The probes of all groups.
    pub probes: Vec<Probe>,
    /// Which probe belongs to which group.
    pub members: Vec<GroupMember>,
}

/// A probe as part of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupMember {
    /// Index of the group.
    pub group: usize,
    /// Index of the probe among those of all groups.
    pub probe: usize,
    /// Force on the probe per unit load of the group.
    pub weight: f64,
}

impl ProbeGroups {
    /// Evaluates the coefficients between all probes, and sums them over the groups.
    pub(crate) fn sum(
        &self,
        compliance: &(impl Compliance + ?Sized),
        kept: &mut KeptProducts,
        out: &mut Influence,
    ) -> Result<(), Error> {
        out.expect(self.count)?;
        let (count, size) = (self.count, self.probes.len());
        let all = kept.influence.get_or_insert_with(|| Influence::zeros(size));
        compliance.fill(&self.probes, all)?;
        let (values, slopes) = (all.value.as_slice(), all.slope.as_slice());
        let (value, slope) = (out.value.as_mut_slice(), out.slope.as_mut_slice());
        value.fill(0.0);
        slope.fill(0.0);
        for column in &self.members {
            let span = column.probe * size..(column.probe + 1) * size;
            let (values, slopes) = (&values[span.clone()], &slopes[span]);
            for row in &self.members {
                let weight = row.weight * column.weight;
                let place = row.group + count * column.group;
                value[place] += weight * values[row.probe];
                slope[place] += weight * slopes[row.probe];
            }
        }
        Ok(())
    }
}

/// What [`Compliance::fill_groups`] keeps from call to call: products that are the same while all probes remain on their
/// elements. It belongs to one compliance and one list of groups; the results do not depend on what was kept.
#[derive(Clone, Debug, Default)]
pub struct KeptProducts {
    /// Coefficients between all probes, where they are evaluated one by one.
    pub(crate) influence: Option<Influence>,
    /// The half of an element and the direction of each probe.
    pub(crate) halves: Vec<ElementHalf>,
    /// All of these, each once in increasing order, and the coefficients c(p, q) of G = sum of c(p, q) r^p t^q between each
    /// two of them, row by row, where r belongs to the row and t to a column that is not behind it: `[q][p]`. r and t are the
    /// distances from the ends of the halves in lengths of the elements.
    pub(crate) blocks: Vec<ElementHalf>,
    pub(crate) bicubics: Vec<[[f64; 4]; 4]>,
    /// The parts of groups on one block each, in the order of the blocks, and the part of each member.
    pub(crate) parts: Vec<GroupPart>,
    pub(crate) part_of: Vec<usize>,
    /// Members in the order of their elements.
    pub(crate) order: Vec<usize>,
}

/// Half of a rail element, and the direction of probes on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ElementHalf {
    pub element: usize,
    pub axis: usize,
    /// Which end is nearer, 0 or 1.
    pub end: usize,
}

/// The members of a group on one half of an element: sums of the powers r^p of their places times their weights, and of
/// the derivatives of these by the coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroupPart {
    pub group: usize,
    pub block: usize,
    pub value: [f64; 4],
    pub slope: [f64; 4],
}

/// Compliance of a structure at its rails: displacements per unit force between any set of probes.
///
/// Implementations are [`crate::ExactSurface`] (exact), [`crate::TableReading`] and [`crate::FactoredTable`] (tables of
/// values), [`crate::Uncoupled`] and [`crate::ResidualFlexibility`] (another compliance with something left out). A caller may
/// write its own:
///
/// ```
/// use splines::{Axis, Compliance, Error, Influence, Probe};
///
/// /// Elastic foundation without any beam: only the loaded place moves, by 1/k.
/// struct Springs {
///     k: f64,
/// }
///
/// impl Compliance for Springs {
///     fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
///         out.slope.fill(0.0);
///         for (i, p) in at.iter().enumerate() {
///             for (j, q) in at.iter().enumerate() {
///                 out.value[(i, j)] = if p == q { 1.0 / self.k } else { 0.0 };
///             }
///         }
///         Ok(())
///     }
///     fn breaks(&self, _rail: usize) -> Vec<f64> {
///         Vec::new()
///     }
///     fn range(&self, _rail: usize) -> Option<[f64; 2]> {
///         None
///     }
///     fn is_symmetric(&self) -> bool {
///         true
///     }
/// }
///
/// let at = [1.0, 2.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let mut out = Influence::zeros(2);
/// Springs { k: 4.0 }.fill(&at, &mut out)?;
/// assert_eq!(out.value[(0, 0)], 0.25);
/// assert_eq!(out.value[(0, 1)], 0.0);
/// # Ok::<(), Error>(())
/// ```
pub trait Compliance: Send + Sync {
    /// Writes the coefficients of the n probes `at` into `out`, whose matrices already are n x n.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction in which the structure has
    /// no stiffness; matrices of another size.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error>;

    /// Writes the displacements at the probes `at` under forces: `out[i]` = sum over j of G(at i, load j) F_j. Each load is
    /// a place and direction with its force.
    ///
    /// # Errors
    /// Those of [`Compliance::fill`].
    fn displacements(
        &self,
        at: &[Probe],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        for (at, out) in at.chunks(GROUP).zip(out.chunks_mut(GROUP)) {
            let all: Vec<Probe> = at
                .iter()
                .copied()
                .chain(loads.iter().map(|load| load.0))
                .collect();
            let mut influence = Influence::zeros(all.len());
            self.fill(&all, &mut influence)?;
            for (i, out) in out.iter_mut().enumerate() {
                let of =
                    |(j, load): (usize, &(Probe, f64))| influence.value[(i, at.len() + j)] * load.1;
                *out = loads.iter().enumerate().map(of).sum();
            }
        }
        Ok(())
    }

    /// Writes the coefficients of groups of probes into `out`, whose matrices are `groups.count` x `groups.count`:
    ///
    /// `value[(g, h)]` = sum of w_i w_j G(i, j) over the members i of g and j of h, and `slope[(g, h)]` the derivative of this
    /// by a common motion of the members of g. What serves the next call is kept in `kept`.
    ///
    /// Guarantee: the sums of [`Compliance::fill`] up to rounding.
    ///
    /// # Errors
    /// Those of [`Compliance::fill`].
    fn fill_groups(
        &self,
        groups: &ProbeGroups,
        kept: &mut KeptProducts,
        out: &mut Influence,
    ) -> Result<(), Error> {
        groups.sum(self, kept, out)
    }

    /// Prepares the displacements at the probes `at` for loads that change from call to call, with the values of
    /// [`Compliance::displacements`] up to rounding.
    ///
    /// # Errors
    /// Those of [`Compliance::fill`] for the probes.
    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        Ok(Box::new(Repeated {
            compliance: self,
            at: at.to_vec(),
        }))
    }

    /// Coordinates along `rail` where derivatives of the surface may jump (supports, hinges, stations),
    /// increasing.
    fn breaks(&self, rail: usize) -> Vec<f64>;

    /// First and last coordinate of `rail`; `None` where the rail does not exist or has no end.
    fn range(&self, rail: usize) -> Option<[f64; 2]>;

    /// Whether `value[(i, j)]` = `value[(j, i)]` for all probes (Maxwell's reciprocal theorem). A solver may
    /// then compute half of the matrix.
    fn is_symmetric(&self) -> bool;

    /// Whether, between two breaks of a rail, the place of a probe enters `value` by polynomials of at most the third degree, also
    /// where another probe on the same rail element keeps its distance from it.
    fn is_cubic(&self) -> bool {
        false
    }
}

/// Displacements of fixed places under loads that change from call to call, made by [`Compliance::at_places`].
pub trait PlaceDisplacements: Send + Sync {
    /// Writes the displacements of the places under loads into `out`, then those of the probes `also`, which may be others
    /// at each call. `out` has one entry for each.
    ///
    /// # Errors
    /// Those of [`Compliance::displacements`].
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error>;
}

/// Places with nothing prepared: the compliance is evaluated at each call.
struct Repeated<'a, C: ?Sized> {
    compliance: &'a C,
    at: Vec<Probe>,
}

impl<C: Compliance + ?Sized> PlaceDisplacements for Repeated<'_, C> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        let all: Vec<Probe> = self.at.iter().chain(also).copied().collect();
        self.compliance.displacements(&all, loads, out)
    }
}

/// Value and partial derivatives of G(p, q), up to the second order, for one pair of probes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Partials {
    /// G(p, q): displacement at p along its axis per unit force at q along its axis, length/force.
    pub value: f64,
    /// dG/dp, by the coordinate of p, 1/force.
    pub p: f64,
    /// dG/dq, by the coordinate of q, 1/force.
    pub q: f64,
    /// d2G/dp2, 1/(force length).
    pub pp: f64,
    /// d2G/dp dq, 1/(force length).
    pub pq: f64,
    /// d2G/dq2, 1/(force length).
    pub qq: f64,
}

impl Partials {
    /// The derivatives of G(q, p) from those of G(p, q).
    #[inline]
    pub(crate) fn swapped(self) -> Partials {
        Partials {
            value: self.value,
            p: self.q,
            q: self.p,
            pp: self.qq,
            pq: self.pq,
            qq: self.pp,
        }
    }

    #[inline]
    pub(crate) fn mean(self, other: Partials) -> Partials {
        Partials {
            value: 0.5 * (self.value + other.value),
            p: 0.5 * (self.p + other.p),
            q: 0.5 * (self.q + other.q),
            pp: 0.5 * (self.pp + other.pp),
            pq: 0.5 * (self.pq + other.pq),
            qq: 0.5 * (self.qq + other.qq),
        }
    }

    #[inline]
    pub(crate) fn scaled(self, factor: f64) -> Partials {
        Partials {
            value: factor * self.value,
            p: factor * self.p,
            q: factor * self.q,
            pp: factor * self.pp,
            pq: factor * self.pq,
            qq: factor * self.qq,
        }
    }

    #[inline]
    pub(crate) fn add(&mut self, other: Partials) {
        self.value += other.value;
        self.p += other.p;
        self.q += other.q;
        self.pp += other.pp;
        self.pq += other.pq;
        self.qq += other.qq;
    }
}

/// A compliance that can be differentiated twice, one pair of probes at a time.
pub trait Differentiable: Compliance {
    /// Value and partial derivatives up to the second order.
    ///
    /// `value` and `p` are those of [`Compliance::fill`]. Where a derivative does not exist, the convention
    /// is that of `fill`: where a slope jumps, every derivative is the mean of both sides; at the end of a
    /// rail element it is that of the element which carries the place. The delta function that `pq` contains
    /// where the slope jumps under one's own load (in shear, torsion and axially) is left out.
    ///
    /// # Errors
    /// As [`Compliance::fill`].
    fn partials(&self, p: Probe, q: Probe) -> Result<Partials, Error>;
}
