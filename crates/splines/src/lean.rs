//! Influence of probes that need one plane of bending or one bar each: the common case, kept short.
//!
//! In order of place along the cell, the clamped cell's own give of a pair is a product of what belongs to the
//! farther probe and what belongs to the nearer one, two terms: b(p, q) = far(p) . near(q), p not before q. These
//! are cubics as the shapes are. So a pair costs three products of six terms (value and both slopes), and all
//! else is done once a probe.

use crate::kernel::sides;
use crate::row::{Fraction, Group};
use crate::{Cell, Error, Influence, Jet2, Line, Probe};

/// Eight cubics of a cell along one axis: four shapes, two far and two near sides of its kernel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lean {
    index: [usize; 4],
    /// By the distance r from either end of the cell: `[end][p]` are the coefficients of r^p.
    value: [[[f64; 8]; 4]; 2],
    /// The same of the derivatives by x.
    slope: [[[f64; 8]; 3]; 2],
}

impl Lean {
    /// `None` where the cell needs more along this axis.
    pub fn new(cell: &Cell, axis: usize, group: &Group) -> Option<Lean> {
        // Along x the far side of a member that runs against the cell is its near one.
        let [first, last] = sides(cell, axis)?;
        let turn = |[a, b, c, d]: [[f64; 4]; 4]| [c, d, a, b];
        let ends = if cell.is_reversed() { [turn(last), turn(first)] } else { [first, last] };
        let value: [[[f64; 8]; 4]; 2] = [0, 1].map(|end| {
            let shape = &group.cubic[end];
            std::array::from_fn(|p| {
                std::array::from_fn(|k| if k < 4 { shape[p][k] } else { ends[end][k - 4][p] })
            })
        });
        let rate = 1.0 / (cell.x[1] - cell.x[0]);
        let slope = [(0, rate), (1, -rate)]
            .map(|(end, rate)| [1.0, 2.0, 3.0].map(|p: f64| value[end][p as usize].map(|x| rate * p * x)));
        Some(Lean { index: group.index, value, slope })
    }

    /// Second derivatives by x; `scale` = 1/(extent in x).
    fn bend(&self, Fraction { end, r }: Fraction, scale: f64) -> [f64; 8] {
        let scale = if end == 0 { scale } else { -scale };
        let [_, b, c] = &self.slope[end];
        std::array::from_fn(|k| scale * (b[k] + 2.0 * r * c[k]))
    }
}

/// A probe: values and slopes of the cubics at its place.
#[derive(Clone, Copy)]
pub(crate) struct Seat {
    /// Index of the probe.
    who: usize,
    /// Number of the cell and axis.
    block: usize,
    x: f64,
    index: [usize; 4],
    value: [f64; 8],
    slope: [f64; 8],
}

impl Seat {
    pub const EMPTY: Seat =
        Seat { who: 0, block: 0, x: 0.0, index: [0; 4], value: [0.0; 8], slope: [0.0; 8] };

    #[inline]
    pub fn place(&mut self, lean: &Lean, block: usize, x: f64, Fraction { end, r }: Fraction) {
        (self.block, self.x, self.index) = (block, x, lean.index);
        let [a, b, c, d] = &lean.value[end];
        self.value = std::array::from_fn(|k| a[k] + r * (b[k] + r * (c[k] + r * d[k])));
        let [a, b, c] = &lean.slope[end];
        self.slope = std::array::from_fn(|k| a[k] + r * (b[k] + r * c[k]));
    }
}

/// Fills `out` if every probe is that simple; else says so, `out` untouched.
///
/// # Errors
/// As [`crate::Compliance::fill`].
pub(crate) fn fill(
    line: &Line,
    nodal: &[f64],
    size: usize,
    at: &[Probe],
    seats: &mut [Seat],
    out: &mut Influence,
) -> Result<bool, Error> {
    for (k, (seat, p)) in seats.iter_mut().zip(at).enumerate() {
        let Some(Found { lean, block, at, .. }) = line.lean(*p)? else { return Ok(false) };
        seat.place(lean, block, p.x, at);
        seat.who = k;
    }
    if !seats.is_sorted_by(|a, b| (a.block, a.x) <= (b.block, b.x)) {
        seats
            .sort_unstable_by(|a, b| a.block.cmp(&b.block).then(a.x.total_cmp(&b.x)).then(a.who.cmp(&b.who)));
    }
    let n = at.len();
    let mut to = Target { n, value: out.value.as_mut_slice(), slope: out.slope.as_mut_slice() };
    let mut rest = &*seats;
    while let Some(first) = rest.first() {
        let (own, others) = rest.split_at(run(rest));
        let c = gather(nodal, size, first, first);
        for (k, q) in own.iter().enumerate() {
            let y = [times(&c, &q.value), times(&c, &q.slope)];
            for p in &own[k..] {
                to.put(p, q, pair(p, q, &y));
            }
            if !to.value[q.who * (n + 1)].is_finite() {
                let Probe { rail, x, axis } = at[q.who];
                return Err(Error::Unstiffened { rail, x, axis });
            }
        }
        let mut others = others;
        while let Some(second) = others.first() {
            let (block, beyond) = others.split_at(run(others));
            let c = gather(nodal, size, first, second);
            for q in own {
                let y = [times(&c, &q.value), times(&c, &q.slope)];
                for p in block {
                    to.put(p, q, [dot(&p.value, &y[0]), dot(&p.slope, &y[0]), dot(&p.value, &y[1])]);
                }
            }
            others = beyond;
        }
        rest = &rest[own.len()..];
    }
    Ok(true)
}

/// One pair with its derivatives, if both probes are that simple.
///
/// # Errors
/// As [`crate::Jets::jet`].
pub(crate) fn jet(
    line: &Line,
    nodal: &[f64],
    size: usize,
    p: Probe,
    q: Probe,
) -> Result<Option<Jet2>, Error> {
    let mut both = [(Seat::EMPTY, [0.0; 8]); 2];
    for ((seat, bend), at) in both.iter_mut().zip([p, q]) {
        let Some(Found { lean, block, at: place, scale }) = line.lean(at)? else { return Ok(None) };
        seat.place(lean, block, at.x, place);
        *bend = lean.bend(place, scale);
        if seat.index.iter().any(|&k| nodal[k * (size + 1)] == f64::INFINITY) {
            return Err(Error::Unstiffened { rail: at.rail, x: at.x, axis: at.axis });
        }
    }
    let [p, q] = &both;
    let same = p.0.block == q.0.block;
    let ordered = |p: &(Seat, [f64; 8]), q: &(Seat, [f64; 8])| {
        let c = gather(nodal, size, &q.0, &p.0);
        let loads = [&q.0.value, &q.0.slope, &q.1];
        let y = loads.map(|load| times(&c, load));
        let with = |row: &[f64; 8], k: usize| {
            let own = if same { row[4] * loads[k][6] + row[5] * loads[k][7] } else { 0.0 };
            dot(row, &y[k]) + own
        };
        Jet2 {
            value: with(&p.0.value, 0),
            p: with(&p.0.slope, 0),
            q: with(&p.0.value, 1),
            pp: with(&p.1, 0),
            pq: with(&p.0.slope, 1),
            qq: with(&p.0.value, 2),
        }
    };
    Ok(Some(if same && p.0.x == q.0.x {
        ordered(p, q).mean(ordered(q, p).swapped())
    } else if p.0.x < q.0.x {
        ordered(q, p).swapped()
    } else {
        ordered(p, q)
    }))
}

/// A probe's cell, and where in it.
pub(crate) struct Found<'a> {
    pub lean: &'a Lean,
    /// Number of the cell and axis.
    pub block: usize,
    pub at: Fraction,
    /// 1/(extent in x).
    pub scale: f64,
}

/// Number of seats in front that share their cell and axis.
#[inline]
fn run(seats: &[Seat]) -> usize {
    seats.iter().position(|seat| seat.block != seats[0].block).unwrap_or(seats.len())
}

/// Where the coefficients go.
struct Target<'a> {
    n: usize,
    value: &'a mut [f64],
    slope: &'a mut [f64],
}

impl Target<'_> {
    /// Value, slope by p and slope by q.
    #[inline]
    fn put(&mut self, p: &Seat, q: &Seat, [value, by_p, by_q]: [f64; 3]) {
        let (there, back) = (p.who + self.n * q.who, q.who + self.n * p.who);
        self.value[there] = value;
        self.value[back] = value;
        self.slope[there] = by_p;
        self.slope[back] = by_q;
    }
}

/// A pair in one cell, p not before q; at one place the mean of both sides.
#[inline]
fn pair(p: &Seat, q: &Seat, y: &[[f64; 4]; 2]) -> [f64; 3] {
    // Far sides of p and near ones of q.
    let six = |p: &[f64; 8], y: &[f64; 4], q: &[f64; 8]| {
        let two: [f64; 2] = std::array::from_fn(|k| p[k] * y[k] + p[2 + k] * y[2 + k] + p[4 + k] * q[6 + k]);
        two[0] + two[1]
    };
    let value = six(&p.value, &y[0], &q.value);
    let by_p = six(&p.slope, &y[0], &q.value);
    let by_q = six(&p.value, &y[1], &q.slope);
    let mean = 0.5 * (by_p + by_q);
    if p.x == q.x { [value, mean, mean] } else { [value, by_p, by_q] }
}

/// Compliance between the freedoms of two cells: row k belongs to freedom k of the first.
#[inline]
fn gather(nodal: &[f64], size: usize, first: &Seat, second: &Seat) -> [[f64; 4]; 4] {
    let columns = [0, 1, 2, 3].map(|k| &nodal[first.index[k] * size..(first.index[k] + 1) * size]);
    let [a, b, c, d] = second.index;
    columns.map(|column| [column[a], column[b], column[c], column[d]])
}

#[inline]
fn times(c: &[[f64; 4]; 4], shares: &[f64; 8]) -> [f64; 4] {
    let mut out = c[0].map(|x| shares[0] * x);
    for (column, share) in c.iter().zip(shares).skip(1) {
        for (sum, x) in out.iter_mut().zip(column) {
            *sum += share * x;
        }
    }
    out
}

#[inline]
fn dot(a: &[f64; 8], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3])
}
