//! The exact influence surface of a structure along its rails.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::groups;
use super::places::{
    AppliedLoads, NodalValues, SurfacePlaces, restrained_row, restrained_row_into,
};
use super::planar::{self, PlanarProbe};
use crate::compliance::{
    Compliance, Differentiable, Influence, KeptProducts, Partials, PlaceDisplacements, ProbeGroups,
};
use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{Rails, ShapeRow};
use crate::vector::dot4;

/// Exact influence coefficients at any place of any rail. Copies share their numbers.
///
/// The loaded element with its ends held is superposed with the structure under the holding forces reversed:
///
/// G(p, q) = N(p) C N(q)^T + \[p and q on one member\] b(p, q),
///
/// with the shape rows N of the elements (1 x 12 each), the compliance C of the node states, and Green's
/// function b of the element clamped at both ends. Elements of two rails on one member share its Green's
/// function.
///
/// Guarantee: exact for piecewise uniform Euler-Bernoulli and Timoshenko members loaded at the rail, whatever
/// the number of elements (4e-15 of the largest entry on the paper's girder); positive semi-definite where C
/// is, being a Gram matrix plus Green's function of a clamped beam; once continuously differentiable along a
/// rail in bending, and twice except at the ends of elements.
///
/// # Source
/// Przemieniecki, Theory of Matrix Structural Analysis (1968), section 10.
///
/// ```
/// use std::sync::Arc;
///
/// use nalgebra::DMatrix;
/// use splines::{Axis, RailElement, Compliance, Flexibility, Influence, Rails, Probe, ExactSurface};
///
/// // A cantilever of length 10 with 1/EI = 1e-3: state 0 is clamped, state 1 free.
/// let (l, c) = (10.0, 1e-3);
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, l],
///     ends: [0, 1],
///     length: l,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility { bending_z: c, ..Flexibility::default() },
///     member: None,
/// };
/// // Compliance of the free end: uy is degree of freedom 7, rz is 11.
/// let mut nodal = DMatrix::zeros(12, 12);
/// nodal[(7, 7)] = c * l * l * l / 3.0;
/// nodal[(7, 11)] = c * l * l / 2.0;
/// nodal[(11, 7)] = c * l * l / 2.0;
/// nodal[(11, 11)] = c * l;
/// let surface = ExactSurface::new(Arc::new(Rails::new(vec![element])?), nodal)?;
///
/// // A load inside the element needs no node there: the deflection under it is c x^3/3.
/// let wheel = Probe { rail: 0, x: 4.0, axis: Axis::Vertical };
/// let mut out = Influence::zeros(1);
/// surface.fill(&[wheel], &mut out)?;
/// assert!((out.value[(0, 0)] - c * 64.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ExactSurface {
    rails: Arc<Rails>,
    /// Shared by all copies: its size grows with the square of the number of states.
    nodal: Arc<DMatrix<f64>>,
}

impl ExactSurface {
    /// The surface of the rails `line` whose node states have the compliance `nodal`.
    ///
    /// `nodal` is 6 S x 6 S with S = `line.states()`: entry (i, j) is the displacement of degree of freedom i
    /// per unit load on degree of freedom j, in the frames of the rails. Its symmetric part is used. An
    /// infinite diagonal entry marks a degree of freedom without stiffness; probes that need it are refused.
    ///
    /// # Errors
    /// A wrong shape; an entry that is not a number, or infinite off the diagonal.
    pub fn new(line: Arc<Rails>, nodal: DMatrix<f64>) -> Result<ExactSurface, Error> {
        let expected = 6 * line.state_count();
        let (rows, columns) = nodal.shape();
        if rows != expected || columns != expected {
            return Err(Error::NodalShape {
                rows,
                columns,
                expected,
            });
        }
        let mut nodal = nodal;
        for column in 0..expected {
            for row in 0..=column {
                let mean = 0.5 * nodal[(row, column)] + 0.5 * nodal[(column, row)];
                if !(mean.is_finite() || (row == column && mean == f64::INFINITY)) {
                    return Err(Error::NodalNumber { row, column });
                }
                nodal[(row, column)] = mean;
                nodal[(column, row)] = mean;
            }
        }
        Ok(ExactSurface {
            rails: line,
            nodal: Arc::new(nodal),
        })
    }

    /// The rails and their elements.
    #[must_use]
    pub fn rails(&self) -> &Arc<Rails> {
        &self.rails
    }

    /// Compliance of the node states, 6 S x 6 S.
    #[must_use]
    pub fn nodal(&self) -> &DMatrix<f64> {
        &self.nodal
    }

    /// The general path: N C N^T for all pairs, then Green's function of the pairs in one element, then that
    /// of pairs in two elements of one member. Values are computed for i >= j and mirrored.
    fn assemble(
        &self,
        at: &[Probe],
        rows: &mut [ShapeRow],
        order: &mut [usize],
        out: &mut Influence,
    ) -> Result<(), Error> {
        let n = at.len();
        let size = self.nodal.nrows();
        let nodal = self.nodal.as_slice();
        let value = out.value.as_mut_slice();
        let slope = out.slope.as_mut_slice();
        for (i, p) in at.iter().enumerate() {
            self.rails.row_into(*p, &mut rows[i])?;
            order[i] = i;
        }
        // Probes of one element and direction have the same degrees of freedom: one product C N(q) serves
        // them all.
        let block = |row: &ShapeRow| (row.element, row.axis);
        if !rows.is_sorted_by_key(block) {
            order.sort_unstable_by_key(|&i| block(&rows[i]));
        }
        for j in 0..n {
            let load = &rows[j];
            let mut last = None;
            let mut moved = [[0.0; 4]; 3];
            for &i in order.iter() {
                let row = &rows[i];
                if last != Some(block(row)) {
                    last = Some(block(row));
                    moved = product(
                        nodal,
                        size,
                        row.index_chunks(),
                        load.index_chunks(),
                        load.chunks()[0],
                    );
                }
                let [values, slopes] = row.chunks();
                slope[i + n * j] = dot_chunks(slopes, &moved);
                if i >= j {
                    value[i + n * j] = dot_chunks(values, &moved);
                }
            }
        }
        self.add_elements(at, rows, out)?;
        if self.rails.shares_members() {
            self.add_shared_members(rows, out);
        }
        Ok(())
    }

    /// The shape row of a probe in whose direction the structure has stiffness.
    pub(super) fn restrained_row(&self, at: Probe) -> Result<ShapeRow, Error> {
        restrained_row(&self.rails, &self.nodal, at)
    }

    /// Adds Green's function between probes in one element and mirrors the values.
    fn add_elements(
        &self,
        at: &[Probe],
        rows: &[ShapeRow],
        out: &mut Influence,
    ) -> Result<(), Error> {
        let n = at.len();
        let value = out.value.as_mut_slice();
        let slope = out.slope.as_mut_slice();
        for j in 0..n {
            let clamped = self.rails.clamped(rows[j].element);
            for i in j..n {
                let (p, q) = (&rows[i], &rows[j]);
                if let Some(clamped) = clamped.filter(|_| p.element == q.element) {
                    let green = clamped.pair(p.axis, p.place, clamped, q.axis, q.place);
                    value[i + n * j] += green.value;
                    slope[i + n * j] += green.p * p.rate;
                    if i != j {
                        slope[j + n * i] += green.q * q.rate;
                    }
                }
                value[j + n * i] = value[i + n * j];
            }
            if !value[j + n * j].is_finite() {
                return Err(Error::NoStiffness {
                    rail: at[j].rail,
                    x: at[j].x,
                    axis: at[j].axis,
                });
            }
        }
        Ok(())
    }

    /// Adds Green's function of the member between two different elements of it.
    #[cold]
    fn add_shared_members(&self, rows: &[ShapeRow], out: &mut Influence) {
        for (j, q) in rows.iter().enumerate() {
            for (i, p) in rows
                .iter()
                .enumerate()
                .skip(j + 1)
                .filter(|(_, p)| p.element != q.element)
            {
                let Some([own, other]) = self.rails.clamped_on_one_member(p.element, q.element)
                else {
                    continue;
                };
                let green = own.pair(p.axis, p.place, other, q.axis, q.place);
                out.value[(i, j)] += green.value;
                out.value[(j, i)] = out.value[(i, j)];
                out.slope[(i, j)] += green.p * p.rate;
                out.slope[(j, i)] += green.q * q.rate;
            }
        }
    }
}

/// C N(q)^T at the degrees of freedom `row`, from those of the load and its shape functions, four at a time.
#[inline]
fn product(
    nodal: &[f64],
    size: usize,
    row: &[[usize; 4]],
    load: &[[usize; 4]],
    shapes: &[[f64; 4]],
) -> [[f64; 4]; 3] {
    let mut out = [[0.0; 4]; 3];
    for (dofs, s) in load.iter().zip(shapes) {
        let [a, b, c, d] = dofs.map(|dof| &nodal[dof * size..(dof + 1) * size]);
        for (sum, places) in out.iter_mut().zip(row) {
            let moved: [f64; 4] = std::array::from_fn(|k| {
                let k = places[k];
                (s[0] * a[k] + s[1] * b[k]) + (s[2] * c[k] + s[3] * d[k])
            });
            *sum = std::array::from_fn(|k| sum[k] + moved[k]);
        }
    }
    out
}

/// Scalar product, four entries at a time.
fn dot_chunks(a: &[[f64; 4]], b: &[[f64; 4]; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| dot4(x, y)).sum()
}

impl Compliance for ExactSurface {
    /// `value` is symmetric to the last bit. Where a slope jumps (under one's own force in shear, in torsion
    /// and axially), `slope` is the mean of both sides. Up to 16 probes need no allocation.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let n = at.len();
        out.expect(n)?;
        if !self.rails.shares_members() {
            let (nodal, size) = (self.nodal.as_slice(), self.nodal.nrows());
            let mut fast = |probes: &mut [PlanarProbe]| {
                planar::fill(&self.rails, nodal, size, at, probes, out)
            };
            let done = match n {
                0..=2 => fast(&mut [PlanarProbe::EMPTY; 2][..n]),
                3..=8 => fast(&mut [PlanarProbe::EMPTY; 8][..n]),
                9..=16 => fast(&mut [PlanarProbe::EMPTY; 16][..n]),
                _ => fast(&mut vec![PlanarProbe::EMPTY; n]),
            };
            if done? {
                return Ok(());
            }
        }
        match n {
            0..=2 => self.assemble(at, &mut [ShapeRow::EMPTY; 2][..n], &mut [0; 2][..n], out),
            3..=8 => self.assemble(at, &mut [ShapeRow::EMPTY; 8][..n], &mut [0; 8][..n], out),
            9..=16 => self.assemble(at, &mut [ShapeRow::EMPTY; 16][..n], &mut [0; 16][..n], out),
            _ => self.assemble(at, &mut vec![ShapeRow::EMPTY; n], &mut vec![0; n], out),
        }
    }

    /// Between two halves of elements N(p) C N(q)^T is bicubic; its coefficients are kept while probes are on both.
    fn fill_groups(
        &self,
        of: &ProbeGroups,
        kept: &mut KeptProducts,
        out: &mut Influence,
    ) -> Result<(), Error> {
        out.expect(of.count)?;
        if groups::fill(&self.rails, &self.nodal, of, kept, out)? {
            Ok(())
        } else {
            of.sum(self, kept, out)
        }
    }

    /// The nodal displacements under all loads are computed once, where they are needed.
    fn displacements(
        &self,
        at: &[Probe],
        loads: &[(Probe, f64)],
        out: &mut [f64],
    ) -> Result<(), Error> {
        let size = self.nodal.nrows();
        let mut loaded = AppliedLoads::new(size);
        let mut row = ShapeRow::EMPTY;
        for (probe, force) in loads {
            restrained_row_into(&self.rails, &self.nodal, *probe, &mut row)?;
            loaded.add(&row, *force);
        }
        let dofs: NodalValues<usize> = (0..size).filter(|dof| loaded.forces[*dof] != 0.0).collect();
        let mut moved = NodalValues::from_elem(f64::NAN, size);
        for (probe, out) in at.iter().zip(out) {
            restrained_row_into(&self.rails, &self.nodal, *probe, &mut row)?;
            for &dof in row.indices() {
                if moved[dof].is_nan() {
                    let column = self.nodal.column(dof);
                    moved[dof] = dofs.iter().map(|&k| column[k] * loaded.forces[k]).sum();
                }
            }
            let nodal = row
                .indices()
                .iter()
                .zip(row.values())
                .map(|(&dof, value)| value * moved[dof]);
            *out = nodal.sum::<f64>() + loaded.on_member(&self.rails, &row);
        }
        Ok(())
    }

    fn at_places<'a>(&'a self, at: &[Probe]) -> Result<Box<dyn PlaceDisplacements + 'a>, Error> {
        Ok(Box::new(SurfacePlaces::new(&self.rails, &self.nodal, at)?))
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.rails.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.rails.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }

    /// Functions of a member under axial force are no polynomials.
    fn is_cubic(&self) -> bool {
        self.rails
            .elements()
            .iter()
            .all(|element| element.flexibility.tension == 0.0)
    }
}

impl Differentiable for ExactSurface {
    /// `pp` jumps where elements of different bending stiffness meet (the value of the element that carries
    /// the probe is given), and under one's own load where an offset makes it a moment (the mean is given).
    fn partials(&self, p: Probe, q: Probe) -> Result<Partials, Error> {
        let (nodal, size) = (self.nodal.as_slice(), self.nodal.nrows());
        if !self.rails.shares_members()
            && let Some(derivatives) = planar::derivatives(&self.rails, nodal, size, p, q)?
        {
            return Ok(derivatives);
        }
        let (a, a2) = self.rails.row_with_second_derivatives(p)?;
        let (b, b2) = self.rails.row_with_second_derivatives(q)?;
        let ([a0, a1], [b0, b1]) = (a.chunks(), b.chunks());
        let moved = [b0, b1, &b2[..b0.len()]]
            .map(|shapes| product(nodal, size, a.index_chunks(), b.index_chunks(), shapes));
        let a2 = &a2[..a0.len()];
        let mut out = Partials {
            value: dot_chunks(a0, &moved[0]),
            p: dot_chunks(a1, &moved[0]),
            q: dot_chunks(a0, &moved[1]),
            pp: dot_chunks(a2, &moved[0]),
            pq: dot_chunks(a1, &moved[1]),
            qq: dot_chunks(a0, &moved[2]),
        };
        if let Some([own, other]) = self.rails.clamped_on_one_member(a.element, b.element) {
            let green = own.pair(a.axis, a.place, other, b.axis, b.place);
            let second = own.second_derivatives(a.axis, a.place, other, b.axis, b.place);
            out.value += green.value;
            out.p += green.p * a.rate;
            out.q += green.q * b.rate;
            out.pp += second.pp * a.rate * a.rate;
            out.pq += second.pq * a.rate * b.rate;
            out.qq += second.qq * b.rate * b.rate;
        }
        for (row, at) in [(&a, p), (&b, q)] {
            if row
                .indices()
                .iter()
                .any(|&k| self.nodal[(k, k)] == f64::INFINITY)
            {
                return Err(Error::NoStiffness {
                    rail: at.rail,
                    x: at.x,
                    axis: at.axis,
                });
            }
        }
        Ok(out)
    }
}
