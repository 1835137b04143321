//! Rails laid over the members that carry them: a line of rail elements and the states at their ends.
//!
//! The geometry is evaluated in double-doubles and then rounded: coordinates and offsets can be far larger than the
//! distance of a place from the end of its member. The double-doubles are kept for grids that need them.

use nalgebra::{Matrix3, Vector3};
use num_traits::Zero;
use splines::{ElementMember, RailElement, Rails};

use crate::assembly::{
    Bodies, Combination, Element, Extended, Geometry, Matrix6, Matrix12, Real, Released, Triad,
    block_diagonal, diagonal_blocks, end_motions, exact_sum, product, vector, without_rounding,
};
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
    /// The same to all digits.
    pub exact: ExactLayout,
}

/// Rail elements and states in double-doubles, in the order of those in doubles.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExactLayout {
    pub elements: Vec<RailElement<Extended>>,
    pub states: Vec<StateRows>,
    /// Error of the axes of each element, in roundings of double-doubles; 0 where they are exact.
    pub axes_error: Vec<f64>,
    /// Sizes of the numbers from which the coordinates of the ends of each element are computed; 0 where exact.
    pub coordinates: Vec<[f64; 2]>,
}

/// What the six displacements of a state are made of. Few grids need them to all digits, so that the rows are formed
/// when they do.
#[derive(Clone, Debug)]
pub(crate) enum StateRows {
    /// The tip of a rigid offset at a point, in the axes of a rail.
    Tip {
        point: usize,
        offset: Vector3<f64>,
        rail: Triad,
    },
    /// The flexible end of a member behind a release: number of the end, axes of its rail.
    Released {
        member: usize,
        end: usize,
        rail: Triad,
    },
}

impl StateRows {
    /// Axes of the rail.
    pub fn rail(&self) -> &Triad {
        match self {
            StateRows::Tip { rail, .. } | StateRows::Released { rail, .. } => rail,
        }
    }
}

impl ExactLayout {
    /// By how much the coordinates of the ends of an element change when they are rounded to doubles.
    pub fn rounding(&self, element: usize) -> [f64; 2] {
        self.elements[element]
            .x
            .map(|x| (x - Extended::from(x.double())).double().abs())
    }
}

/// A segment by its place along the rail.
struct Stretch {
    segment: usize,
    /// Coordinates of its ends, increasing.
    x: [Extended; 2],
    /// States of the tips of the rigid offsets at its ends.
    tips: [usize; 2],
    /// From the member to the rail, rail axes.
    offset: Vector3<Extended>,
}

struct Builder<'a> {
    points: &'a [[f64; 3]],
    elements: &'a [Element],
    bodies: &'a Bodies,
    states: Vec<[Combination; 6]>,
    exact: ExactLayout,
    /// The last tip at each point, on any rail: its state.
    last_tip: Vec<Option<usize>>,
    /// For each state, the tip before it at the same point, and the rail of the state.
    tip_before: Vec<(Option<usize>, usize)>,
}

/// The rail that is being laid.
struct Frame {
    index: usize,
    axes: Triad,
    origin: [f64; 3],
}

impl Layout {
    /// Lays all rails.
    ///
    /// # Errors
    /// An axis or segment that cannot be used; segments that overlap; a station that no segment covers.
    pub fn new(
        m: &Model,
        rails: &[Rail],
        elements: &[Element],
        bodies: &Bodies,
    ) -> Result<Layout, Error> {
        let segments = rails.iter().map(|rail| rail.segments.len()).sum::<usize>();
        let states = segments + rails.len();
        let mut builder = Builder {
            points: &m.points,
            elements,
            bodies,
            states: Vec::with_capacity(states),
            exact: ExactLayout {
                elements: Vec::with_capacity(segments),
                states: Vec::with_capacity(states),
                axes_error: Vec::with_capacity(segments),
                coordinates: Vec::with_capacity(segments),
            },
            last_tip: vec![None; m.points.len()],
            tip_before: Vec::with_capacity(states),
        };
        for (index, rail) in rails.iter().enumerate() {
            builder.lay(m, index, rail)?;
        }
        let line = Rails::new(builder.exact.elements.iter().map(rounded).collect())?;
        let rest = |x: Extended| (x - Extended::from(x.double())).double();
        let rests = builder
            .exact
            .elements
            .iter()
            .map(|element| element.x.map(rest))
            .collect();
        let line = line.with_rests(rests);
        Ok(Layout {
            line,
            states: builder.states,
            exact: builder.exact,
        })
    }
}

/// A rail element in doubles.
fn rounded(element: &RailElement<Extended>) -> RailElement {
    let RailElement {
        rail,
        ends,
        flexibility,
        member,
        ..
    } = *element;
    RailElement {
        rail,
        x: element.x.map(Real::double),
        ends,
        length: element.length.double(),
        frame: element.frame.map(|row| row.map(Real::double)),
        offset: element.offset.map(Real::double),
        flexibility,
        member,
    }
}

impl Builder<'_> {
    /// Lays one rail: a rail element for each segment, rigid ones in the gaps.
    fn lay(&mut self, m: &Model, index: usize, rail: &Rail) -> Result<(), Error> {
        rail.check(index)?;
        let axis = vector::<Extended>(rail.axis);
        let size = axis.dot(&axis).root();
        let axes = (size > Extended::zero())
            .then(|| Triad::new(axis / size, vector(m.up)))
            .flatten()
            .ok_or(Error::Invalid {
                entry: ModelEntry::Rail(index),
                fault: EntryFault::Axis,
            })?;
        let frame = Frame {
            index,
            axes,
            origin: rail.origin,
        };
        let mut stretches = Vec::with_capacity(rail.segments.len());
        for (segment, given) in rail.segments.iter().enumerate() {
            let invalid = |fault| Error::Invalid {
                entry: ModelEntry::Segment {
                    rail: index,
                    segment,
                },
                fault,
            };
            stretches.push(self.lay_segment(&frame, segment, given).map_err(invalid)?);
        }
        self.fill_gaps(&frame, stretches)?;
        rail.check_stations(index)
    }

    /// The rail element of a segment: local axes and ends of its member, turned about local y if the member
    /// runs against the rail.
    fn lay_segment(
        &mut self,
        frame: &Frame,
        segment: usize,
        given: &RailSegment,
    ) -> Result<Stretch, EntryFault> {
        let member = given.member;
        let element = self
            .elements
            .get(member)
            .ok_or(EntryFault::NoMember { member })?;
        finite(EntryAttribute::Offset, &given.offset)?;
        let Geometry {
            axes: own_axes,
            axes_error,
            length,
            ..
        } = &element.geometry;
        let axes = &frame.axes.axes;
        let from_origin = [0, 1].map(|end| {
            let (point, offset) = (self.points[element.points[end]], element.offsets[end]);
            Vector3::from(std::array::from_fn(|k| {
                exact_sum([point[k], -frame.origin[k], offset[k]])
            }))
        });
        let along = |k: usize| (axes * from_origin[k])[0];
        let (mut x, mut order) = ([along(0), along(1)], [0, 1]);
        if x[1] < x[0] {
            x.swap(0, 1);
            order.swap(0, 1);
        }
        if (x[1] - x[0]).double() <= NO_EXTENT * length.double() {
            return Err(EntryFault::NoExtent);
        }
        let reversed = order[0] == 1;
        let error = axes_error
            .iter()
            .fold(frame.axes.error, |sum, error| sum + error);
        // Local axes of the member in rail axes; a half turn about y lets it run along the rail.
        let mut local = if error == 0.0 {
            let [own, rail] = [own_axes, axes].map(|axes| axes.map(Real::double));
            (own * rail.transpose()).map(Extended::from)
        } else {
            own_axes * axes.transpose()
        };
        if reversed {
            local.row_mut(0).neg_mut();
            local.row_mut(2).neg_mut();
        }
        let offset = axes * vector::<Extended>(given.offset);
        let (length, flexibility) = (*length, element.flexibility);
        let tips = order.map(|end| self.tip(frame, member, end));
        let ends = [0, 1].map(|k| self.end(frame, member, order[k], tips[k]));
        self.exact.elements.push(RailElement {
            rail: frame.index,
            x,
            ends,
            length,
            frame: std::array::from_fn(|i| std::array::from_fn(|j| local[(i, j)])),
            offset: offset.into(),
            flexibility,
            member: Some(ElementMember {
                id: member,
                reversed,
            }),
        });
        self.exact.axes_error.push(error);
        let size = |place: &Vector3<Extended>| place.iter().map(|x| x.double().abs()).sum::<f64>();
        self.exact
            .coordinates
            .push(order.map(|end| size(&from_origin[end])));
        Ok(Stretch {
            segment,
            x,
            tips,
            offset,
        })
    }

    /// State of the tip of the rigid offset at an end of a member; segments that meet there share it.
    fn tip(&mut self, frame: &Frame, member: usize, end: usize) -> usize {
        let element = &self.elements[member];
        let (point, offset) = (element.points[end], element.offsets[end]);
        let mut known = self.last_tip[point];
        while let Some(state) = known {
            let (before, rail) = self.tip_before[state];
            if rail == frame.index
                && matches!(&self.exact.states[state], StateRows::Tip { offset: other, .. } if *other == offset)
            {
                return state;
            }
            known = before;
        }
        let state = self.states.len();
        self.tip_before
            .push((self.last_tip[point].replace(state), frame.index));
        self.push_tip(frame, point, &offset);
        state
    }

    fn push_tip(&mut self, frame: &Frame, point: usize, offset: &Vector3<f64>) {
        let rail = frame.axes;
        self.exact.states.push(StateRows::Tip {
            point,
            offset: *offset,
            rail,
        });
        let rows = if rail.error == 0.0 {
            // Axes along those of the coordinates only exchange the entries.
            let axes = diagonal_blocks(&rail.axes.map(Real::double));
            let motion = product(&axes, &self.bodies.motion(point, offset));
            self.bodies.combinations(point, &motion)
        } else {
            // Doubles keep the exact zeros of axes that are only rounding.
            let clean = without_rounding(&rail.axes, 4.0 * f64::EPSILON);
            let lost = if clean == rail.axes { 0.0 } else { 4.0 };
            let (value, sizes) = turned_motion(self.bodies, point, offset, &clean, lost);
            self.bodies
                .sized_combinations(point, &value.map(Real::double), &sizes)
        };
        self.states.push(rows);
    }

    /// State of a flexible end of a member: that of the tip, or a new one behind a release.
    fn end(&mut self, frame: &Frame, member: usize, end: usize, tip: usize) -> usize {
        let element = &self.elements[member];
        let Some(released) = element
            .released
            .as_deref()
            .filter(|released| released.ends[end])
        else {
            return tip;
        };
        let clean = without_rounding(&frame.axes.axes, 4.0 * f64::EPSILON);
        let axes = clean.map(Real::double);
        let rows = released_rows(element, released, self.bodies, end, &axes, frame.axes.error);
        self.states.push(rows);
        self.tip_before.push((None, frame.index));
        self.exact.states.push(StateRows::Released {
            member,
            end,
            rail: frame.axes,
        });
        self.states.len() - 1
    }

    /// Fills each gap between neighbouring segments with two rigid rail elements that meet in the middle, each
    /// following the nearer tip; refuses segments that overlap.
    fn fill_gaps(&mut self, frame: &Frame, mut stretches: Vec<Stretch>) -> Result<(), Error> {
        let largest = stretches
            .iter()
            .flat_map(|stretch| stretch.x)
            .fold(0.0_f64, |a, x| a.max(x.double().abs()));
        let tolerance = Extended::from(TOLERANCE * largest);
        let farthest = self
            .exact
            .coordinates
            .iter()
            .flatten()
            .fold(0.0_f64, |a, &x| a.max(x));
        stretches.sort_by(|a, b| a.x[0].double().total_cmp(&b.x[0].double()));
        for pair in stretches.windows(2) {
            let (before, after) = (&pair[0], &pair[1]);
            let gap = [before.x[1], after.x[0]];
            if gap[0] > gap[1] + tolerance {
                let (first, second) = (
                    before.segment.min(after.segment),
                    before.segment.max(after.segment),
                );
                let item = ModelEntry::Segment {
                    rail: frame.index,
                    segment: second,
                };
                let fault = EntryFault::Overlap {
                    segment: first,
                    x: gap[1].double(),
                };
                return Err(Error::Invalid { entry: item, fault });
            }
            if gap[1] - gap[0] <= tolerance {
                continue;
            }
            // A double, so that it is the same place in both precisions.
            let middle = Extended::from((Extended::from(0.5) * (gap[0] + gap[1])).double());
            let mut from_middle = after.offset;
            from_middle.x -= gap[1] - middle;
            let parts = [
                rigid(frame.index, [gap[0], middle], before.tips[1], before.offset),
                rigid(frame.index, [middle, gap[1]], after.tips[0], from_middle),
            ];
            self.exact.elements.extend(parts);
            self.exact.axes_error.extend([frame.axes.error; 2]);
            self.exact.coordinates.extend([[farthest; 2]; 2]);
        }
        Ok(())
    }
}

/// Rows of the flexible end of a member behind a release, in rail axes.
pub(crate) fn released_rows<T: Real>(
    element: &Element<T>,
    released: &Released<T>,
    bodies: &Bodies<T>,
    end: usize,
    axes: &Matrix3<T>,
    axes_error: f64,
) -> [Combination<T>; 6] {
    let (motions, sizes) = end_motions(element, bodies);
    let local = released.recovery * block_diagonal(&motions);
    let to_rail: Matrix6<T> = diagonal_blocks(axes) * element.rotation().transpose();
    let motion = to_rail * local.fixed_rows::<6>(6 * end);
    // Rounding of the axes, of the recovery and of its products.
    let error = axes_error * (Extended::ROUNDING / T::ROUNDING);
    let error = element
        .axes_error
        .iter()
        .fold(error, |sum, error| sum + error);
    let magnitudes = |m: &Matrix3<T>| m.map(|x| x.double().abs());
    let products = magnitudes(axes) * magnitudes(&element.axes).transpose();
    let turned = diagonal_blocks(&products.map(|x| x + error));
    let recovery = released.recovery.map(|x| x.double().abs()) * released.growth;
    let bulk = turned * (recovery * block_diagonal(&sizes)).fixed_rows::<6>(6 * end);
    let pair = bodies.pair(element.points);
    std::array::from_fn(|i| {
        let mut row = Combination::default();
        (0..12).for_each(|k| row.add_sized(6 * pair[k / 6] + k % 6, motion[(i, k)], bulk[(i, k)]));
        row
    })
}

/// Rows of the tip of a rigid offset, in rail axes.
pub(crate) fn tip_rows<T: Real>(
    bodies: &Bodies<T>,
    point: usize,
    offset: &Vector3<f64>,
    rail: &Triad,
) -> [Combination<Extended>; 6] {
    let offset = offset.map(T::from);
    let (value, sizes) = turned_motion(bodies, point, &offset, &rail.axes, 1.0 + rail.error);
    bodies.sized_combinations(point, &value, &sizes)
}

/// Motion of the tip of a rigid offset in the axes given, and the sizes of its entries; `error` is that of the axes in
/// roundings.
fn turned_motion<T: Real>(
    bodies: &Bodies<T>,
    point: usize,
    offset: &Vector3<T>,
    axes: &Matrix3<Extended>,
    error: f64,
) -> (Matrix6<Extended>, Matrix6) {
    let motion = bodies.exact_motion(point, offset);
    let value = product(&diagonal_blocks(axes), &motion);
    let all = diagonal_blocks(&Matrix3::from_element(error)) * motion.map(|x| x.double().abs());
    (value, value.map(|x| x.double().abs()) + all)
}

/// A rail element that moves rigidly with one state.
fn rigid(
    rail: usize,
    x: [Extended; 2],
    state: usize,
    offset: Vector3<Extended>,
) -> RailElement<Extended> {
    let [zero, one] = [0.0, 1.0].map(Extended::from);
    RailElement {
        rail,
        x,
        ends: [state; 2],
        length: x[1] - x[0],
        frame: [[one, zero, zero], [zero, one, zero], [zero, zero, one]],
        offset: offset.into(),
        flexibility: Default::default(),
        member: None,
    }
}

/// From the flexible ends of a member, local axes, to the ends of a rail element on it, rail axes.
pub(crate) fn to_rail_axes<T: Real>(cell: &RailElement<T>) -> Matrix12<T> {
    let axes = cell.member_axes();
    let back = Matrix3::from_fn(|i, j| axes[j][i]);
    let mut out = Matrix12::zeros();
    for end in 0..2 {
        let own = if cell.is_reversed() { 1 - end } else { end };
        out.fixed_view_mut::<6, 6>(6 * end, 6 * own)
            .copy_from(&diagonal_blocks(&back));
    }
    out
}
