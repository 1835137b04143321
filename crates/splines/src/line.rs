//! Rails made of cells: which cell carries a place, and how it moves.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::kernel::{Arm, Kernel, free};
use crate::lean::Found;
use crate::row::{Fraction, Row, Terms, terms};
use crate::{Cell, Error, Probe};

/// Rounding allowed in coordinates and frames, relative.
const SLACK: f64 = 1e-12;
const SQUARE: f64 = 1e-9;

/// Cells of any number of rails, ready for look-up.
#[derive(Clone, Debug)]
pub struct Line {
    cells: Vec<Cell>,
    ready: Vec<Ready>,
    tracks: Vec<Track>,
    states: usize,
    /// Whether a member carries more than one cell.
    shared: bool,
}

/// A cell prepared for evaluation.
#[derive(Clone, Debug)]
struct Ready {
    /// Shape rows along x, y, z, from the first time that they are asked for.
    terms: [OnceLock<Terms>; 3],
    /// Axes in which nothing resists.
    free: [bool; 3],
    /// `None` for a rigid arm.
    kernel: Option<Kernel>,
    /// First cell on the same member.
    group: usize,
}

/// One rail: its cells by increasing x.
#[derive(Clone, Debug)]
struct Track {
    rail: usize,
    slack: f64,
    cells: Vec<Span>,
    index: Index,
}

/// Equal shares of a rail, as many as cells: which cells begin in each, so that a search looks at few.
#[derive(Clone, Debug)]
struct Index {
    start: f64,
    scale: f64,
    /// Cells that begin before share k; one more than shares.
    before: Vec<u32>,
}

impl Index {
    fn new(cells: &[Span]) -> Index {
        let shares = cells.len();
        let start = cells[0].x[0];
        let mut index = Index {
            start,
            scale: shares as f64 / (cells[shares - 1].x[1] - start),
            before: vec![0; shares + 1],
        };
        for span in cells {
            let share = index.share(span.x[0]);
            index.before[share + 1] += 1;
        }
        for k in 0..shares {
            index.before[k + 1] += index.before[k];
        }
        index
    }

    /// Never decreases with x.
    #[inline]
    fn share(&self, x: f64) -> usize {
        let share = ((x - self.start) * self.scale) as i32;
        (share.max(0) as usize).min(self.before.len() - 2)
    }

    /// Number of cells that begin at x or before.
    #[inline]
    fn upto(&self, cells: &[Span], x: f64) -> usize {
        let share = self.share(x);
        let [low, high] = [self.before[share] as usize, self.before[share + 1] as usize];
        let here = &cells[low..high];
        // Mostly there is one: no search.
        if let [one] = here {
            low + usize::from(one.x[0] <= x)
        } else {
            low + here.partition_point(|span| span.x[0] <= x)
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Span {
    x: [f64; 2],
    /// Inverse of the extent in x.
    scale: f64,
    /// Place of `x[0]` along the member, and the way from there to `x[1]`.
    start: f64,
    length: f64,
    cell: usize,
    /// At `x[0]` the cell before this one, listed earlier, carries the probe.
    yields: bool,
}

impl Span {
    /// Where in the cell x is, taken within it.
    #[inline]
    fn fraction(&self, x: f64) -> Fraction {
        let r = ((x - self.x[0]) * self.scale).max(0.0);
        if r <= 0.5 {
            Fraction { end: 0, r }
        } else {
            Fraction { end: 1, r: ((self.x[1] - x) * self.scale).max(0.0) }
        }
    }
}

impl Line {
    /// Checks and sorts the cells. Rails may have gaps; where two cells of a rail meet, the first listed
    /// carries the shared place. A gap or overlap below 1e-12 of the rail's largest coordinate is rounding.
    ///
    /// # Errors
    /// No cell; a number that is not finite; `x` not increasing; a flexible cell with a length that is not
    /// positive, a frame that is not a rotation or a negative flexibility; cells of one rail that overlap;
    /// cells of one member that differ in length or flexibility.
    pub fn new(cells: Vec<Cell>) -> Result<Line, Error> {
        if cells.is_empty() {
            return Err(Error::NoCells);
        }
        let mut ready = Vec::with_capacity(cells.len());
        let mut states = 0;
        let mut shared = false;
        let mut first: BTreeMap<usize, usize> = BTreeMap::new();
        for (index, cell) in cells.iter().enumerate() {
            check(index, cell)?;
            states = states.max(cell.ends[0].max(cell.ends[1]) + 1);
            let arm = cell.ends[0] == cell.ends[1];
            let carrier = cell.carrier.filter(|_| !arm);
            let group = carrier.map_or(index, |carrier| *first.entry(carrier.member).or_insert(index));
            shared |= group != index;
            let same = |a: &Cell| a.length == cell.length && a.flexibility == cell.flexibility;
            if group != index && !same(&cells[group]) {
                return Err(Error::CellCarrier { first: group, second: index });
            }
            let loads = [0, 1, 2].map(|axis| Arm::new(cell, axis));
            let free = free(cell);
            let loose = |load: &Arm| !arm && load.uses().iter().zip(free).any(|(&used, free)| used && free);
            ready.push(Ready {
                terms: Default::default(),
                free: loads.each_ref().map(loose),
                kernel: (!arm).then(|| Kernel::new(cell)),
                group,
            });
        }
        let tracks = tracks(&cells)?;
        Ok(Line { cells, ready, tracks, states, shared })
    }

    /// The cells, as given.
    #[must_use]
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// One more than the largest state index.
    #[must_use]
    pub fn states(&self) -> usize {
        self.states
    }

    /// Shape row of a probe: N(x) of its cell, along its axis.
    ///
    /// Exact for a uniform Euler-Bernoulli or Timoshenko member without load between its ends.
    ///
    /// # Errors
    /// No such rail; no cell there; or the cell needs a stiffness that its section has not.
    ///
    /// # Source
    /// Timoshenko shapes: Przemieniecki, Theory of Matrix Structural Analysis (1968), chapter 5.
    pub fn row(&self, p: Probe) -> Result<Row, Error> {
        let mut row = Row::EMPTY;
        self.row_into(p, &mut row)?;
        Ok(row)
    }

    pub(crate) fn row_into(&self, p: Probe, row: &mut Row) -> Result<(), Error> {
        let span = self.stiff(p)?;
        let axis = p.axis.component();
        let place = span.fraction(p.x);
        row.cell = span.cell;
        row.axis = axis;
        row.s = span.start + place.along() * span.length;
        row.rate = span.length * span.scale;
        row.evaluate(self.terms(span.cell, axis), place, span.scale);
        Ok(())
    }

    /// Where a probe stands that needs one plane or one bar; `None` where it needs more.
    #[inline]
    pub(crate) fn lean(&self, p: Probe) -> Result<Option<Found<'_>>, Error> {
        let span = self.stiff(p)?;
        let axis = p.axis.component();
        let found = |lean| {
            let (block, at) = (3 * span.cell + axis, span.fraction(p.x));
            Found { lean, block, at, scale: span.scale }
        };
        Ok(self.terms(span.cell, axis).lean().map(found))
    }

    /// The cell that carries a probe, where in it, and the inverse of the cell's extent in x.
    pub(crate) fn place(&self, p: Probe) -> Result<(usize, Fraction, f64), Error> {
        self.stiff(p).map(|span| (span.cell, span.fraction(p.x), span.scale))
    }

    /// The rows at both ends of a cell along an axis; slopes by the share of the cell.
    pub(crate) fn end_rows(&self, cell: usize, axis: usize) -> [Row; 2] {
        [0, 1].map(|end| {
            let mut row = Row::EMPTY;
            row.evaluate(self.terms(cell, axis), Fraction { end, r: 0.0 }, 1.0);
            row
        })
    }

    /// The row of a probe and second derivatives of its values by x.
    pub(crate) fn bends(&self, p: Probe) -> Result<(Row, [[f64; 4]; 3]), Error> {
        let row = self.row(p)?;
        let span = self.find(p.rail, p.x)?;
        let terms = self.terms(row.cell, row.axis);
        Ok((row, Row::bends(terms, span.fraction(p.x), span.scale)))
    }

    fn terms(&self, cell: usize, axis: usize) -> &Terms {
        self.ready[cell].terms[axis].get_or_init(|| terms(&self.cells[cell], axis))
    }

    /// What rounding can spoil at a probe: [`Line::row`], the magnitudes behind each of its values, and
    /// the magnitude behind the clamped cell's own give there. A value errs by some roundings of its magnitude.
    ///
    /// # Errors
    /// As [`Line::row`].
    pub fn magnitudes(&self, p: Probe) -> Result<(Row, Vec<f64>, f64), Error> {
        let row = self.row(p)?;
        let ready = &self.ready[row.cell];
        let place = self.find(p.rail, p.x)?.fraction(p.x);
        let own = ready.kernel.as_ref().map_or(0.0, |kernel| kernel.magnitude(row.axis, row.s));
        let magnitudes = self.terms(row.cell, row.axis).magnitudes(place).collect();
        Ok((row, magnitudes, own))
    }

    /// Green's function of the cell clamped at both ends: `[i][j]` is the displacement along axis i at rail
    /// coordinate x per unit force along axis j at z, with the rail's offset.
    ///
    /// x and z are taken within the cell. Guarantee: `kernel(c, x, z)[i][j] == kernel(c, z, x)[j][i]` to the
    /// last bit; positive semi-definite. Zero for a rigid arm or a cell that does not exist; infinite in a
    /// direction that nothing resists.
    ///
    /// # Source
    /// theta' = m/EI, m' = -V, v' = theta + V/kGA, clamped at both ends (Cowper 1966, J. Appl. Mech. 33).
    #[must_use]
    pub fn kernel(&self, cell: usize, x: f64, z: f64) -> [[f64; 3]; 3] {
        let mut out = [[0.0; 3]; 3];
        let (Some(ready), Some(given)) = (self.ready.get(cell), self.cells.get(cell)) else { return out };
        let Some(kernel) = &ready.kernel else { return out };
        let (s, t) = (given.place(x), given.place(z));
        for (a, row) in out.iter_mut().enumerate() {
            for (b, entry) in row.iter_mut().enumerate() {
                *entry = if kernel.is_free(a, b) { f64::INFINITY } else { kernel.pair(a, s, b, t).value };
            }
        }
        out
    }

    pub(crate) fn kernel_of(&self, cell: usize) -> Option<&Kernel> {
        self.ready.get(cell).and_then(|ready| ready.kernel.as_ref())
    }

    pub(crate) fn has_shared_members(&self) -> bool {
        self.shared
    }

    /// Kernels of two cells, where one member carries both.
    pub(crate) fn kernels_of_one_member(&self, a: usize, b: usize) -> Option<[&Kernel; 2]> {
        let (a, b) = (self.ready.get(a)?, self.ready.get(b)?);
        Some([a.kernel.as_ref()?, b.kernel.as_ref()?]).filter(|_| a.group == b.group)
    }

    /// Ends of the cells of `rail`, increasing, each once.
    #[must_use]
    pub fn breaks(&self, rail: usize) -> Vec<f64> {
        let mut out: Vec<f64> = Vec::new();
        if let Some(track) = self.track(rail) {
            out.extend(track.cells.iter().flat_map(|span| span.x));
            out.sort_by(f64::total_cmp);
            out.dedup_by(|b, a| *b - *a <= track.slack);
        }
        out
    }

    /// First and last coordinate of `rail`; `None` where it has no cell.
    #[must_use]
    pub fn range(&self, rail: usize) -> Option<[f64; 2]> {
        let cells = &self.track(rail)?.cells;
        Some([cells.first()?.x[0], cells.last()?.x[1]])
    }

    fn track(&self, rail: usize) -> Option<&Track> {
        match self.tracks.get(rail) {
            Some(track) if track.rail == rail => Some(track),
            _ => self.tracks.binary_search_by_key(&rail, |t| t.rail).ok().map(|k| &self.tracks[k]),
        }
    }

    /// The cell that carries a probe, if it resists along the probe's axis.
    #[inline]
    fn stiff(&self, p: Probe) -> Result<&Span, Error> {
        let span = self.find(p.rail, p.x)?;
        if self.ready[span.cell].free[p.axis.component()] {
            return Err(Error::Unstiffened { rail: p.rail, x: p.x, axis: p.axis });
        }
        Ok(span)
    }

    fn find(&self, rail: usize, x: f64) -> Result<&Span, Error> {
        let Track { slack, cells, index, .. } = self.track(rail).ok_or(Error::NoRail { rail })?;
        let after = index.upto(cells, x);
        if let Some(k) = after.checked_sub(1) {
            let span = &cells[k];
            if x == span.x[0] && span.yields {
                return Ok(&cells[k - 1]);
            }
            if x <= span.x[1] + slack {
                return Ok(span);
            }
        }
        match cells.get(after) {
            Some(span) if span.x[0] - x <= *slack => Ok(span),
            _ => Err(Error::OffRail { rail, x }),
        }
    }
}

fn tracks(cells: &[Cell]) -> Result<Vec<Track>, Error> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&a, &b| {
        let (p, q) = (&cells[a], &cells[b]);
        p.rail.cmp(&q.rail).then(p.x[0].total_cmp(&q.x[0])).then(a.cmp(&b))
    });
    let mut tracks: Vec<Track> = Vec::new();
    for same in order.chunk_by(|&a, &b| cells[a].rail == cells[b].rail) {
        let rail = cells[same[0]].rail;
        let largest = same.iter().flat_map(|&k| cells[k].x).fold(0.0_f64, |a, x| a.max(x.abs()));
        let slack = SLACK * largest;
        let span = |cell: usize, yields| {
            let Cell { x, length, .. } = cells[cell];
            let (start, length) = if cells[cell].is_reversed() { (length, -length) } else { (0.0, length) };
            Span { x, scale: 1.0 / (x[1] - x[0]), start, length, cell, yields }
        };
        let mut spans = vec![span(same[0], false)];
        for pair in same.windows(2) {
            let (before, cell) = (pair[0], pair[1]);
            let (end, start) = (cells[before].x[1], cells[cell].x[0]);
            if end > start + slack {
                return Err(Error::Overlap { rail, first: before, second: cell, x: start });
            }
            spans.push(span(cell, end >= start && before < cell));
        }
        tracks.push(Track { rail, slack, index: Index::new(&spans), cells: spans });
    }
    Ok(tracks)
}

fn check(index: usize, cell: &Cell) -> Result<(), Error> {
    let numbers = cell.x.iter().chain(&cell.offset);
    if numbers.copied().any(|x| !x.is_finite()) || cell.ends.iter().any(|&end| end > u32::MAX as usize) {
        return Err(Error::CellNumber { cell: index });
    }
    if cell.x[0] >= cell.x[1] {
        return Err(Error::CellExtent { cell: index, x: cell.x });
    }
    if cell.ends[0] == cell.ends[1] {
        return Ok(());
    }
    if !(cell.length > 0.0 && cell.length.is_finite()) {
        return Err(Error::CellLength { cell: index, length: cell.length });
    }
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [x, y, z] = cell.frame;
    let third = {
        let c = crate::kernel::cross(x, y);
        [c[0] - z[0], c[1] - z[1], c[2] - z[2]]
    };
    let defects = [dot(x, x) - 1.0, dot(y, y) - 1.0, dot(x, y), dot(third, third).sqrt()];
    if defects.iter().any(|d| d.abs() > SQUARE || d.is_nan()) {
        return Err(Error::CellFrame { cell: index });
    }
    let f = &cell.flexibility;
    let all = [f.axial, f.torsion, f.bending_y, f.bending_z, f.shear_y, f.shear_z];
    if all.iter().any(|x| *x < 0.0 || x.is_nan()) {
        return Err(Error::CellFlexibility { cell: index });
    }
    Ok(())
}
