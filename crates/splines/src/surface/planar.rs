//! Fast path of the exact surface, for probes whose directions involve one bending plane or one bar each.
//!
//! Algorithm. (1) Evaluate at each probe the four shape functions N and the two entries each of far and near,
//! all cubics (`PlanarCubics`). (2) Sort the probes by element and direction, then by coordinate, so that
//! within an element b(p, q) = far(p) . near(q) for every p that is not before q. (3) For each element of a
//! probe and each element of another take the 4 x 4 block of the nodal compliance C once, and multiply it by
//! N(q) and N'(q) once for each q. (4) A pair then costs three scalar products: of four terms where the
//! elements differ, of six (C and b together) where they are the same.

use crate::compliance::{Influence, Partials};
use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{LocalPlace, PlanarCubics, PlanarPlace, Rails};
use crate::vector::dot4;

/// A probe with the values and slopes of the cubics of `PlanarCubics` at its place.
#[derive(Clone, Copy)]
pub(super) struct PlanarProbe {
    /// Position among the probes of the caller.
    who: usize,
    /// Number of the element and direction.
    block: usize,
    x: f64,
    index: [usize; 4],
    value: [f64; 8],
    slope: [f64; 8],
}

impl PlanarProbe {
    pub const EMPTY: PlanarProbe = PlanarProbe {
        who: 0,
        block: 0,
        x: 0.0,
        index: [0; 4],
        value: [0.0; 8],
        slope: [0.0; 8],
    };

    #[inline]
    fn set(&mut self, cubics: &PlanarCubics, block: usize, x: f64, at: LocalPlace) {
        (self.block, self.x, self.index) = (block, x, cubics.index);
        self.value = cubics.values(at);
        self.slope = cubics.slopes(at);
    }

    /// The shape functions alone.
    #[inline]
    fn shapes(cubics: &[f64; 8]) -> &[f64; 4] {
        cubics.first_chunk().expect("four of eight")
    }
}

/// Fills `out` if every probe has the planar form and returns whether it did; else `out` is untouched.
/// `nodal` is the nodal compliance, `size` x `size` by columns.
///
/// # Errors
/// As [`crate::Compliance::fill`].
pub(super) fn fill(
    rails: &Rails,
    nodal: &[f64],
    size: usize,
    at: &[Probe],
    probes: &mut [PlanarProbe],
    out: &mut Influence,
) -> Result<bool, Error> {
    for (k, (probe, p)) in probes.iter_mut().zip(at).enumerate() {
        let Some(PlanarPlace {
            cubics, block, at, ..
        }) = rails.planar(*p)?
        else {
            return Ok(false);
        };
        probe.set(cubics, block, p.x, at);
        probe.who = k;
    }
    if !probes.is_sorted_by(|a, b| (a.block, a.x) <= (b.block, b.x)) {
        probes.sort_unstable_by(|a, b| {
            a.block
                .cmp(&b.block)
                .then(a.x.total_cmp(&b.x))
                .then(a.who.cmp(&b.who))
        });
    }
    let n = at.len();
    let mut to = Output::of(out, n);
    let mut rest = &*probes;
    while let Some(first) = rest.first() {
        let (own, others) = rest.split_at(same_block(rest));
        let c = gather(nodal, size, first, first);
        for (k, q) in own.iter().enumerate() {
            let moved = [times(&c, &q.value), times(&c, &q.slope)];
            for p in &own[k..] {
                to.put(p, q, pair_in_element(p, q, &moved));
            }
            if !to.value[q.who * (n + 1)].is_finite() {
                let Probe { rail, x, axis } = at[q.who];
                return Err(Error::NoStiffness { rail, x, axis });
            }
        }
        let mut others = others;
        while let Some(second) = others.first() {
            let (block, beyond) = others.split_at(same_block(others));
            let c = gather(nodal, size, first, second);
            for q in own {
                let moved = [times(&c, &q.value), times(&c, &q.slope)];
                for p in block {
                    let (value, slope) =
                        (PlanarProbe::shapes(&p.value), PlanarProbe::shapes(&p.slope));
                    to.put(
                        p,
                        q,
                        [
                            dot4(value, &moved[0]),
                            dot4(slope, &moved[0]),
                            dot4(value, &moved[1]),
                        ],
                    );
                }
            }
            others = beyond;
        }
        rest = &rest[own.len()..];
    }
    Ok(true)
}

/// Value and derivatives of one pair, if both probes have the planar form.
///
/// # Errors
/// As [`crate::Differentiable::partials`].
pub(super) fn derivatives(
    rails: &Rails,
    nodal: &[f64],
    size: usize,
    p: Probe,
    q: Probe,
) -> Result<Option<Partials>, Error> {
    // Each probe with its second derivatives.
    let mut both = [(PlanarProbe::EMPTY, [0.0; 8]); 2];
    for ((probe, second), at) in both.iter_mut().zip([p, q]) {
        let Some(PlanarPlace {
            cubics,
            block,
            at: local,
            scale,
        }) = rails.planar(at)?
        else {
            return Ok(None);
        };
        probe.set(cubics, block, at.x, local);
        *second = cubics.second_derivatives(local, scale);
        if probe
            .index
            .iter()
            .any(|&k| nodal[k * (size + 1)] == f64::INFINITY)
        {
            return Err(Error::NoStiffness {
                rail: at.rail,
                x: at.x,
                axis: at.axis,
            });
        }
    }
    let [p, q] = &both;
    let same = p.0.block == q.0.block;
    // p not before q.
    let ordered = |p: &(PlanarProbe, [f64; 8]), q: &(PlanarProbe, [f64; 8])| {
        let c = gather(nodal, size, &q.0, &p.0);
        let loads = [&q.0.value, &q.0.slope, &q.1];
        let moved = loads.map(|load| times(&c, load));
        let with = |row: &[f64; 8], k: usize| {
            let own = if same {
                row[4] * loads[k][6] + row[5] * loads[k][7]
            } else {
                0.0
            };
            dot4(PlanarProbe::shapes(row), &moved[k]) + own
        };
        Partials {
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

/// Number of probes in front that share their element and direction.
#[inline]
fn same_block(probes: &[PlanarProbe]) -> usize {
    probes
        .iter()
        .position(|probe| probe.block != probes[0].block)
        .unwrap_or(probes.len())
}

/// The matrices of an [`Influence`], by columns.
pub(super) struct Output<'a> {
    n: usize,
    pub value: &'a mut [f64],
    pub slope: &'a mut [f64],
}

impl Output<'_> {
    /// Those of `out`, which are n x n.
    pub fn of(out: &mut Influence, n: usize) -> Output<'_> {
        Output {
            n,
            value: out.value.as_mut_slice(),
            slope: out.slope.as_mut_slice(),
        }
    }

    /// Adds the value of a pair of the groups i and j and its slopes by both; once for the pair of a part with itself.
    #[inline]
    pub fn add(&mut self, [i, j]: [usize; 2], value: f64, [by_i, by_j]: [f64; 2], is_itself: bool) {
        let (there, back) = (i + self.n * j, j + self.n * i);
        self.value[there] += value;
        self.slope[there] += by_i;
        if !is_itself {
            self.value[back] += value;
            self.slope[back] += by_j;
        }
    }

    /// Stores the value of a pair and its slopes by p and by q.
    #[inline]
    fn put(&mut self, p: &PlanarProbe, q: &PlanarProbe, [value, by_p, by_q]: [f64; 3]) {
        let (there, back) = (p.who + self.n * q.who, q.who + self.n * p.who);
        self.value[there] = value;
        self.value[back] = value;
        self.slope[there] = by_p;
        self.slope[back] = by_q;
    }
}

/// Value and slopes of a pair in one element, p not before q, by C N(q) and C N'(q). At one place the slopes
/// are the mean of both sides.
#[inline]
fn pair_in_element(p: &PlanarProbe, q: &PlanarProbe, moved: &[[f64; 4]; 2]) -> [f64; 3] {
    // N(p) C N(q) + far(p) . near(q) as six terms in two sums.
    let six = |p: &[f64; 8], y: &[f64; 4], q: &[f64; 8]| {
        let two: [f64; 2] =
            std::array::from_fn(|k| p[k] * y[k] + p[2 + k] * y[2 + k] + p[4 + k] * q[6 + k]);
        two[0] + two[1]
    };
    let value = six(&p.value, &moved[0], &q.value);
    let by_p = six(&p.slope, &moved[0], &q.value);
    let by_q = six(&p.value, &moved[1], &q.slope);
    let mean = 0.5 * (by_p + by_q);
    if p.x == q.x {
        [value, mean, mean]
    } else {
        [value, by_p, by_q]
    }
}

/// The nodal compliance between the degrees of freedom of two elements: row k belongs to that number k of the
/// first.
#[inline]
fn gather(nodal: &[f64], size: usize, first: &PlanarProbe, second: &PlanarProbe) -> [[f64; 4]; 4] {
    let columns = [0, 1, 2, 3].map(|k| &nodal[first.index[k] * size..(first.index[k] + 1) * size]);
    let [a, b, c, d] = second.index;
    columns.map(|column| [column[a], column[b], column[c], column[d]])
}

/// Product of the shape functions at a load with a block of the nodal compliance.
#[inline]
fn times(c: &[[f64; 4]; 4], shapes: &[f64; 8]) -> [f64; 4] {
    let mut out = c[0].map(|x| shapes[0] * x);
    for (column, shape) in c.iter().zip(shapes).skip(1) {
        for (sum, x) in out.iter_mut().zip(column) {
            *sum += shape * x;
        }
    }
    out
}
