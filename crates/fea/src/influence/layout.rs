//! Rails laid over the members that carry them: a line of rail elements and the states at their ends.

use std::collections::HashMap;

use nalgebra::{Matrix3, Vector3};
use splines::{ElementMember, RailElement, Rails};

use crate::assembly::{Bodies, Combination, Element, Matrix6, diagonal_blocks, transformation, triad};
use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry, finite};
use crate::model::{Model, Rail, RailSegment};

/// Rounding allowed between neighbouring segments, relative to the coordinates.
const TOLERANCE: f64 = 1e-12;
/// Extent of a member along its rail, relative to its length, at which it counts as zero.
const NO_EXTENT: f64 = 1e-9;

/// The rail elements of all rails, and the states at their ends.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub line: Rails,
    /// For each state its three displacements and three rotations, in the axes of its rail, over the motions
    /// of the bodies.
    pub states: Vec<[Combination; 6]>,
}

/// A segment by its place along the rail.
struct Stretch {
    segment: usize,
    /// Coordinates of its ends, increasing.
    x: [f64; 2],
    /// States of the tips of the rigid offsets at its ends.
    tips: [usize; 2],
    /// From the member to the rail, rail axes.
    offset: Vector3<f64>,
}

struct Builder<'a> {
    elements: &'a [Element],
    bodies: &'a Bodies,
    states: Vec<[Combination; 6]>,
    /// State of each tip: by rail, point, and bits of the offset.
    tips: HashMap<(usize, usize, [u64; 3]), usize>,
}

impl Layout {
    /// Lays all rails.
    ///
    /// # Errors
    /// An axis or segment that cannot be used; segments that overlap; a station that no segment covers.
    pub fn new(m: &Model, rails: &[Rail], elements: &[Element], bodies: &Bodies) -> Result<Layout, Error> {
        let mut builder = Builder { elements, bodies, states: Vec::new(), tips: HashMap::new() };
        let mut cells = Vec::new();
        for (index, rail) in rails.iter().enumerate() {
            builder.lay(m, index, rail, &mut cells)?;
        }
        Ok(Layout { line: Rails::new(cells)?, states: builder.states })
    }
}

impl Builder<'_> {
    /// Lays one rail: a rail element for each segment, rigid ones in the gaps.
    fn lay(
        &mut self,
        m: &Model,
        index: usize,
        rail: &Rail,
        cells: &mut Vec<RailElement>,
    ) -> Result<(), Error> {
        rail.check(index)?;
        let axis = Vector3::from(rail.axis);
        let size = axis.norm();
        let axes = (size > 0.0)
            .then(|| triad(axis / size, Vector3::from(m.up)))
            .flatten()
            .ok_or(Error::Invalid { entry: ModelEntry::Rail(index), fault: EntryFault::Axis })?;
        let origin = Vector3::from(rail.origin);
        let mut stretches = Vec::with_capacity(rail.segments.len());
        for (segment, given) in rail.segments.iter().enumerate() {
            let invalid =
                |fault| Error::Invalid { entry: ModelEntry::Segment { rail: index, segment }, fault };
            let (stretch, cell) =
                self.lay_segment([index, segment], given, &axes, &origin).map_err(invalid)?;
            stretches.push(stretch);
            cells.push(cell);
        }
        fill_gaps(index, stretches, cells)?;
        rail.check_stations(index)
    }

    /// The rail element of a segment: local axes and ends of its member, turned about local y if the member
    /// runs against the rail.
    fn lay_segment(
        &mut self,
        [rail, segment]: [usize; 2],
        given: &RailSegment,
        axes: &Matrix3<f64>,
        origin: &Vector3<f64>,
    ) -> Result<(Stretch, RailElement), EntryFault> {
        let member = given.member;
        let element = self.elements.get(member).ok_or(EntryFault::NoMember { member })?;
        finite(EntryAttribute::Offset, &given.offset)?;
        let along = |k: usize| (axes * (element.ends[k] - origin))[0];
        let (mut x, mut order) = ([along(0), along(1)], [0, 1]);
        if x[1] < x[0] {
            x.swap(0, 1);
            order.swap(0, 1);
        }
        if x[1] - x[0] <= NO_EXTENT * element.length {
            return Err(EntryFault::NoExtent);
        }
        let reversed = order[0] == 1;
        // Local axes of the member in rail axes; a half turn about y lets it run along the rail.
        let mut local = element.axes * axes.transpose();
        if reversed {
            local.row_mut(0).neg_mut();
            local.row_mut(2).neg_mut();
        }
        let offset = axes * Vector3::from(given.offset);
        let (length, flexibility) = (element.length, element.flexibility);
        let tips = order.map(|end| self.tip(rail, member, end, axes));
        let ends = [0, 1].map(|k| self.end(member, order[k], tips[k], axes));
        let cell = RailElement {
            rail,
            x,
            ends,
            length,
            frame: std::array::from_fn(|i| std::array::from_fn(|j| local[(i, j)])),
            offset: offset.into(),
            flexibility,
            member: Some(ElementMember { id: member, reversed }),
        };
        Ok((Stretch { segment, x, tips, offset }, cell))
    }

    /// State of the tip of the rigid offset at an end of a member; segments that meet there share it.
    fn tip(&mut self, rail: usize, member: usize, end: usize, axes: &Matrix3<f64>) -> usize {
        let element = &self.elements[member];
        let (point, offset) = (element.points[end], element.offsets[end]);
        // Adding 0.0 turns -0.0 into 0.0, so that equal offsets have equal bits.
        let key = (rail, point, [offset.x, offset.y, offset.z].map(|x| (x + 0.0).to_bits()));
        let next = self.states.len();
        let state = *self.tips.entry(key).or_insert(next);
        if state == next {
            let motion = diagonal_blocks(axes) * self.bodies.motion(point, &offset);
            self.states.push(self.bodies.combinations(point, &motion));
        }
        state
    }

    /// State of a flexible end of a member: that of the tip, or a new one behind a release.
    fn end(&mut self, member: usize, end: usize, tip: usize, axes: &Matrix3<f64>) -> usize {
        let element = &self.elements[member];
        let Some(released) = element.released.as_deref().filter(|released| released.ends[end]) else {
            return tip;
        };
        let local = released.recovery * transformation(element, self.bodies);
        let to_rail: Matrix6 = diagonal_blocks(axes) * element.rotation().transpose();
        let motion = to_rail * local.fixed_rows::<6>(6 * end);
        let pair = self.bodies.pair(element.points);
        self.states.push(std::array::from_fn(|i| {
            let mut row = Combination::default();
            (0..12).for_each(|k| row.add(6 * pair[k / 6] + k % 6, motion[(i, k)]));
            row
        }));
        self.states.len() - 1
    }
}

/// Fills each gap between neighbouring segments with two rigid rail elements that meet in the middle, each
/// following the nearer tip; refuses segments that overlap.
fn fill_gaps(rail: usize, mut stretches: Vec<Stretch>, cells: &mut Vec<RailElement>) -> Result<(), Error> {
    let largest = stretches.iter().flat_map(|stretch| stretch.x).fold(0.0_f64, |a, x| a.max(x.abs()));
    let tolerance = TOLERANCE * largest;
    stretches.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
    for pair in stretches.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        let gap = [before.x[1], after.x[0]];
        if gap[0] > gap[1] + tolerance {
            let (first, second) = (before.segment.min(after.segment), before.segment.max(after.segment));
            let item = ModelEntry::Segment { rail, segment: second };
            return Err(Error::Invalid {
                entry: item,
                fault: EntryFault::Overlap { segment: first, x: gap[1] },
            });
        }
        if gap[1] - gap[0] <= tolerance {
            continue;
        }
        let middle = 0.5 * (gap[0] + gap[1]);
        let from_middle = after.offset - Vector3::x() * (gap[1] - middle);
        cells.push(rigid(rail, [gap[0], middle], before.tips[1], before.offset));
        cells.push(rigid(rail, [middle, gap[1]], after.tips[0], from_middle));
    }
    Ok(())
}

/// A rail element that moves rigidly with one state.
fn rigid(rail: usize, x: [f64; 2], state: usize, offset: Vector3<f64>) -> RailElement {
    RailElement {
        rail,
        x,
        ends: [state; 2],
        length: x[1] - x[0],
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: offset.into(),
        flexibility: Default::default(),
        member: None,
    }
}
