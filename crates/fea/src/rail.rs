//! Rails on members: how a rail is laid over the cells that carry it.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};
use splines::{Carrier, Cell, Line};

use crate::assembly::reach;
use crate::element::{Element, Matrix6, blocks, triad};
use crate::error::{Error, Fault, Item, Quantity};
use crate::freedoms::{Freedoms, Sum};
use crate::model::Model;
use crate::section::finite;

/// Rounding allowed between neighbouring segments, relative to the coordinates.
const SLACK: f64 = 1e-12;

/// A stretch of rail on one member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Index of the member.
    pub member: usize,
    /// Global vector from the member's axis to the rail, rigid.
    pub offset: [f64; 3],
}

/// A rail: a straight coordinate over the members that carry it.
///
/// The coordinate of a place is its distance from `origin` along `axis`. A segment covers the
/// projection of its member's flexible part; in a gap between two the rail moves rigidly with the
/// nearer end; where two meet, the first listed carries the place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rail {
    /// Where the coordinate is zero, global.
    pub origin: [f64; 3],
    /// Direction of increasing coordinate, global, any length.
    pub axis: [f64; 3],
    /// What carries the rail.
    pub segments: Vec<Segment>,
    /// Coordinates of output, increasing.
    pub stations: Vec<f64>,
}

/// Cells of all rails, and their end states.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub line: Line,
    /// Six sums a state, over the motions of the bodies.
    pub states: Vec<[Sum; 6]>,
}

/// A flexible cell with its order along the rail.
struct Span {
    segment: usize,
    x: [f64; 2],
    /// States of the arms' tips at its ends.
    tips: [usize; 2],
    offset: Vector3<f64>,
}

struct Builder<'a> {
    elements: &'a [Element],
    freedoms: &'a Freedoms,
    states: Vec<[Sum; 6]>,
    known: HashMap<(usize, usize, [u64; 3]), usize>,
}

/// Lays all rails.
pub(crate) fn lay(
    m: &Model,
    rails: &[Rail],
    elements: &[Element],
    freedoms: &Freedoms,
) -> Result<Layout, Error> {
    let mut builder = Builder { elements, freedoms, states: Vec::new(), known: HashMap::new() };
    let mut cells = Vec::new();
    for (index, rail) in rails.iter().enumerate() {
        builder.rail(m, index, rail, &mut cells)?;
    }
    Ok(Layout { line: Line::new(cells)?, states: builder.states })
}

impl Builder<'_> {
    fn rail(&mut self, m: &Model, index: usize, rail: &Rail, cells: &mut Vec<Cell>) -> Result<(), Error> {
        let item = Item::Rail(index);
        let invalid = |fault| Error::Invalid { item, fault };
        finite(Quantity::Coordinate, &rail.origin).map_err(invalid)?;
        finite(Quantity::Coordinate, &rail.axis).map_err(invalid)?;
        if rail.segments.is_empty() {
            return Err(invalid(Fault::Empty { quantity: Quantity::Segments }));
        }
        let axis = Vector3::from(rail.axis);
        let size = axis.norm();
        let frame = (size > 0.0)
            .then(|| triad(axis / size, Vector3::from(m.up)))
            .flatten()
            .ok_or(invalid(Fault::Axis))?;
        let origin = Vector3::from(rail.origin);
        let mut spans = Vec::with_capacity(rail.segments.len());
        for (segment, given) in rail.segments.iter().enumerate() {
            let at = |fault| Error::Invalid { item: Item::Segment { rail: index, segment }, fault };
            let element =
                self.elements.get(given.member).ok_or(at(Fault::NoMember { member: given.member }))?;
            finite(Quantity::Offset, &given.offset).map_err(at)?;
            let along = |k: usize| (frame * (element.ends[k] - origin))[0];
            let (mut x, mut order) = ([along(0), along(1)], [0, 1]);
            if x[1] < x[0] {
                x.swap(0, 1);
                order.swap(0, 1);
            }
            if x[1] - x[0] <= 1e-9 * element.length {
                return Err(at(Fault::NoExtent));
            }
            let mut local = element.axes * frame.transpose();
            if order[0] == 1 {
                local.row_mut(0).neg_mut();
                local.row_mut(2).neg_mut();
            }
            let offset = frame * Vector3::from(given.offset);
            let (length, flexibility) = (element.length, element.flexibility);
            let tips = order.map(|end| self.tip(index, given.member, end, &frame));
            let ends = [0, 1].map(|k| self.end(given.member, order[k], tips[k], &frame));
            cells.push(Cell {
                rail: index,
                x,
                ends,
                length,
                frame: std::array::from_fn(|i| std::array::from_fn(|j| local[(i, j)])),
                offset: offset.into(),
                flexibility,
                carrier: Some(Carrier { member: given.member, reversed: order[0] == 1 }),
            });
            spans.push(Span { segment, x, tips, offset });
        }
        fill_gaps(index, spans, cells)?;
        stations(index, &rail.stations)
    }

    /// State of the tip of the arm at an end of a member.
    fn tip(&mut self, rail: usize, member: usize, end: usize, frame: &Matrix3<f64>) -> usize {
        let element = &self.elements[member];
        let (point, offset) = (element.points[end], element.offsets[end]);
        let key = (rail, point, [offset.x, offset.y, offset.z].map(|x| (x + 0.0).to_bits()));
        let next = self.states.len();
        let state = *self.known.entry(key).or_insert(next);
        if state == next {
            let motion = blocks(frame) * self.freedoms.motion(point, &offset);
            let columns = 6 * self.freedoms.body[point];
            self.states.push(std::array::from_fn(|i| {
                let mut sum = Sum::default();
                (0..6).for_each(|k| sum.add(columns + k, motion[(i, k)]));
                sum
            }));
        }
        state
    }

    /// State of an end of a member, after its releases.
    fn end(&mut self, member: usize, end: usize, tip: usize, frame: &Matrix3<f64>) -> usize {
        let element = &self.elements[member];
        let Some(released) = element.released.as_deref().filter(|released| released.ends[end]) else {
            return tip;
        };
        let local = released.recovery * reach(element, self.freedoms);
        let back: Matrix6 = blocks(frame) * element.rotation().transpose();
        let motion = back * local.fixed_rows::<6>(6 * end);
        self.states.push(std::array::from_fn(|i| {
            let mut sum = Sum::default();
            for k in 0..12 {
                sum.add(6 * self.freedoms.body[element.points[k / 6]] + k % 6, motion[(i, k)]);
            }
            sum
        }));
        self.states.len() - 1
    }
}

/// Rigid arms between neighbouring segments; refuses overlaps.
fn fill_gaps(rail: usize, mut spans: Vec<Span>, cells: &mut Vec<Cell>) -> Result<(), Error> {
    let largest = spans.iter().flat_map(|span| span.x).fold(0.0_f64, |a, x| a.max(x.abs()));
    let slack = SLACK * largest;
    spans.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
    for pair in spans.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        let gap = [before.x[1], after.x[0]];
        if gap[0] > gap[1] + slack {
            let (first, second) = (before.segment.min(after.segment), before.segment.max(after.segment));
            let item = Item::Segment { rail, segment: second };
            return Err(Error::Invalid { item, fault: Fault::Overlap { segment: first, x: gap[1] } });
        }
        if gap[1] - gap[0] <= slack {
            continue;
        }
        let middle = 0.5 * (gap[0] + gap[1]);
        let reach = after.offset - Vector3::x() * (gap[1] - middle);
        for (x, state, offset) in
            [([gap[0], middle], before.tips[1], before.offset), ([middle, gap[1]], after.tips[0], reach)]
        {
            cells.push(Cell {
                rail,
                x,
                ends: [state; 2],
                length: x[1] - x[0],
                frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                offset: offset.into(),
                flexibility: Default::default(),
                carrier: None,
            });
        }
    }
    Ok(())
}

fn stations(rail: usize, given: &[f64]) -> Result<(), Error> {
    for (station, &value) in given.iter().enumerate() {
        let invalid = |fault| Error::Invalid { item: Item::Station { rail, station }, fault };
        finite(Quantity::Station, &[value]).map_err(invalid)?;
        if station > 0 && value <= given[station - 1] {
            return Err(invalid(Fault::Unsorted { value }));
        }
    }
    Ok(())
}
