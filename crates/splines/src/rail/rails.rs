//! Rails made of elements, ready for evaluation at any place.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use super::element::{LocalPlace, RailElement};
use super::green::{ClampedElement, SeparatedLoad};
use super::interior::uniform_load;
use super::load::AxisLoad;
use super::member_motion::MemberMotion;
use super::planar::{PlanarCubics, PlanarPlace};
use super::rounding::RoundingSizes;
use super::row::ShapeRow;
use super::shape::ShapeCubics;
use super::track::{Span, Track};
use crate::error::Error;
use crate::probe::{Axis, Probe};

/// Elements of any number of rails, checked and indexed.
///
/// It evaluates the two functions of an element at any coordinate: the shape row N(x) ([`Rails::row`]) and
/// Green's function b(x, z) of the element clamped at both ends ([`Rails::clamped_green`]).
///
/// ```
/// use splines::{Axis, RailElement, Flexibility, Rails, Probe};
///
/// let element = |k: usize, x: [f64; 2]| RailElement {
///     rail: 0,
///     x,
///     ends: [k, k + 1],
///     length: x[1] - x[0],
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility { bending_z: 2.0, ..Flexibility::default() },
///     member: None,
/// };
/// let rail = Rails::new(vec![element(0, [0.0, 4.0]), element(1, [4.0, 10.0])])?;
/// assert_eq!(rail.state_count(), 3);
/// assert_eq!(rail.breaks(0), [0.0, 4.0, 10.0]);
/// assert_eq!(rail.row(Probe { rail: 0, x: 7.0, axis: Axis::Vertical })?.element, 1);
/// // Midspan deflection of a clamped beam, l^3/(192 EI), under a vertical force.
/// assert!((rail.clamped_green(0, 2.0, 2.0)[1][1] - 2.0 * 4.0_f64.powi(3) / 192.0).abs() < 1e-15);
/// # Ok::<(), splines::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Rails {
    elements: Vec<RailElement>,
    /// What rounding took from the coordinates of their ends.
    rests: Vec<[f64; 2]>,
    prepared: Vec<Prepared>,
    tracks: Vec<Track>,
    states: usize,
    /// Whether some member has more than one element.
    shares_members: bool,
}

/// An element prepared for evaluation.
#[derive(Clone, Debug)]
struct Prepared {
    /// Cubics along x, y and z, computed when they are first needed.
    cubics: [OnceLock<AxisCubics>; 3],
    /// Rail directions in which the element has no stiffness.
    without_stiffness: [bool; 3],
    /// `None` for a rigid arm.
    clamped: Option<ClampedElement>,
    /// Index of the first element of the same member.
    group: usize,
}

/// Shape functions along one rail direction, and the planar form where it exists.
#[derive(Clone, Debug)]
struct AxisCubics {
    shapes: ShapeCubics,
    planar: Option<Box<PlanarCubics>>,
}

impl AxisCubics {
    // Kept out of line: it runs once, beside a look-up that runs for every probe.
    #[cold]
    #[inline(never)]
    fn new(element: &RailElement, axis: usize) -> AxisCubics {
        let shapes = ShapeCubics::new(element, axis);
        let planar = PlanarCubics::new(element, axis, &shapes).map(Box::new);
        AxisCubics { shapes, planar }
    }
}

impl Rails {
    /// Checks and sorts elements. A rail may have gaps; where two of its elements meet, the one listed first
    /// carries the common place. A gap or overlap below 1e-12 of the rail's largest coordinate counts as
    /// rounding.
    ///
    /// # Errors
    /// No element; a number that is not finite; `x` not increasing; a flexible element with a length that is
    /// not positive, a frame that is not a rotation or a negative flexibility; elements of one rail that
    /// overlap; elements of one member that differ in length or flexibility.
    pub fn new(elements: Vec<RailElement>) -> Result<Rails, Error> {
        if elements.is_empty() {
            return Err(Error::NoElements);
        }
        let mut prepared = Vec::with_capacity(elements.len());
        let mut states = 0;
        let mut shares_members = false;
        let mut first: BTreeMap<usize, usize> = BTreeMap::new();
        for (index, element) in elements.iter().enumerate() {
            element.check(index)?;
            states = states.max(element.ends[0].max(element.ends[1]) + 1);
            let rigid = element.is_rigid_arm();
            let carrier = element.member.filter(|_| !rigid);
            let group = carrier.map_or(index, |carrier| *first.entry(carrier.id).or_insert(index));
            shares_members |= group != index;
            let same = |a: &RailElement| {
                a.length == element.length && a.flexibility == element.flexibility
            };
            if group != index && !same(&elements[group]) {
                return Err(Error::ElementMember {
                    first: group,
                    second: index,
                });
            }
            let without = element.without_stiffness();
            let along = |axis: usize| {
                let uses = AxisLoad::new(element, &element.frame, axis).uses();
                !rigid
                    && uses
                        .iter()
                        .zip(without)
                        .any(|(&used, missing)| used && missing)
            };
            prepared.push(Prepared {
                cubics: Default::default(),
                without_stiffness: [0, 1, 2].map(along),
                clamped: (!rigid).then(|| ClampedElement::new(element)),
                group,
            });
        }
        let tracks = Track::all(&elements)?;
        let rests = vec![[0.0; 2]; elements.len()];
        Ok(Rails {
            elements,
            rests,
            prepared,
            tracks,
            states,
            shares_members,
        })
    }

    /// The same rails, the ends of whose elements are at `x` + `rests`: at coordinates that doubles do not hold. A place
    /// near such an end keeps the digits of its distance from it.
    ///
    /// `rests` has an entry for each element, each less than the spacing of doubles at its coordinate; a list of another
    /// length is ignored.
    #[must_use]
    pub fn with_rests(mut self, rests: Vec<[f64; 2]>) -> Rails {
        if rests.len() == self.elements.len() {
            self.tracks
                .iter_mut()
                .for_each(|track| track.set_rests(&rests));
            self.rests = rests;
        }
        self
    }

    /// What rounding took from the coordinates of the ends of each element ([`Rails::with_rests`]).
    #[must_use]
    pub fn rests(&self) -> &[[f64; 2]] {
        &self.rests
    }

    /// The elements, in the order given.
    #[must_use]
    pub fn elements(&self) -> &[RailElement] {
        &self.elements
    }

    /// Number of node states: one more than the largest state index.
    #[must_use]
    pub fn state_count(&self) -> usize {
        self.states
    }

    /// Shape row N(x) of the element that carries a probe, along the probe's axis.
    ///
    /// Guarantee: exact for a uniform Euler-Bernoulli or Timoshenko member without load between its ends.
    ///
    /// # Errors
    /// A rail that does not exist; a coordinate without an element; a direction in which the element has no
    /// stiffness.
    ///
    /// # Source
    /// Przemieniecki, Theory of Matrix Structural Analysis (1968), chapter 5.
    pub fn row(&self, p: Probe) -> Result<ShapeRow, Error> {
        let mut row = ShapeRow::EMPTY;
        self.row_into(p, &mut row)?;
        Ok(row)
    }

    /// Index of the element that carries a probe.
    ///
    /// # Errors
    /// As [`Rails::row`].
    pub fn element_at(&self, p: Probe) -> Result<usize, Error> {
        Ok(self.stiff_span(p)?.element)
    }

    /// [`Rails::row`] into memory that the caller has.
    pub(crate) fn row_into(&self, p: Probe, row: &mut ShapeRow) -> Result<(), Error> {
        let span = self.stiff_span(p)?;
        let axis = p.axis.component();
        let place = span.local(p.x);
        row.element = span.element;
        row.axis = axis;
        row.place = place.on_member(span.length, span.reversed);
        row.rate = if span.reversed {
            -span.length * span.scale
        } else {
            span.length * span.scale
        };
        row.evaluate(&self.cubics(span.element, axis).shapes, place, span.scale);
        Ok(())
    }

    /// The row of a probe, and the second derivatives of its values by x.
    pub(crate) fn row_with_second_derivatives(
        &self,
        p: Probe,
    ) -> Result<(ShapeRow, [[f64; 4]; 3]), Error> {
        let row = self.row(p)?;
        let span = self.span(p.rail, p.x)?;
        let shapes = &self.cubics(row.element, row.axis).shapes;
        Ok((row, shapes.second_derivatives(span.local(p.x), span.scale)))
    }

    /// The place of a probe whose direction involves one plane or one bar; `None` where it involves more.
    #[inline]
    pub(crate) fn planar(&self, p: Probe) -> Result<Option<PlanarPlace<'_>>, Error> {
        let span = self.stiff_span(p)?;
        let axis = p.axis.component();
        let found = |cubics| {
            let (block, at) = (3 * span.element + axis, span.local(p.x));
            PlanarPlace {
                cubics,
                block,
                at,
                scale: span.scale,
            }
        };
        Ok(self.cubics(span.element, axis).planar.as_deref().map(found))
    }

    /// The cubics of the shape functions of an element along a rail direction.
    pub(crate) fn shape_cubics(&self, element: usize, axis: usize) -> &ShapeCubics {
        &self.cubics(element, axis).shapes
    }

    /// The rows at both ends of an element along a rail direction; slopes by the fraction of the element.
    pub(crate) fn end_rows(&self, element: usize, axis: usize) -> [ShapeRow; 2] {
        [0, 1].map(|end| {
            let mut row = ShapeRow::EMPTY;
            row.evaluate(
                &self.cubics(element, axis).shapes,
                LocalPlace { end, r: 0.0 },
                1.0,
            );
            row
        })
    }

    fn cubics(&self, element: usize, axis: usize) -> &AxisCubics {
        self.prepared[element].cubics[axis]
            .get_or_init(|| AxisCubics::new(&self.elements[element], axis))
    }

    /// The element that carries a probe, and for uniform loads of intensity one on its member, along its local y axis
    /// and along its local z axis, the displacement at the probe along its axis with the ends of the member clamped, and
    /// the derivative of this displacement by the rail coordinate.
    ///
    /// ```
    /// use splines::{Axis, RailElement, Flexibility, Rails, Probe};
    ///
    /// let element = RailElement {
    ///     rail: 0,
    ///     x: [0.0, 8.0],
    ///     ends: [0, 1],
    ///     length: 8.0,
    ///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ///     offset: [0.0; 3],
    ///     flexibility: Flexibility { bending_z: 3.0, ..Flexibility::default() },
    ///     member: None,
    /// };
    /// let rail = Rails::new(vec![element])?;
    /// let (_, [y, z]) = rail.uniform_load(Probe { rail: 0, x: 4.0, axis: Axis::Vertical })?;
    /// // l^4/(384 EI) at midspan.
    /// assert!((y[0] - 8.0_f64.powi(4) * 3.0 / 384.0).abs() < 1e-12);
    /// assert_eq!((y[1], z), (0.0, [0.0; 2]));
    /// # Ok::<(), splines::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Rails::row`].
    pub fn uniform_load(&self, p: Probe) -> Result<(usize, [[f64; 2]; 2]), Error> {
        let span = self.stiff_span(p)?;
        Ok((span.element, self.uniform_load_on(span, p)))
    }

    /// The displacements of [`Rails::uniform_load`] where the element that carries the probe is known.
    pub(crate) fn uniform_load_on(&self, span: &Span, p: Probe) -> [[f64; 2]; 2] {
        let Some(clamped) = self.clamped(span.element) else {
            return [[0.0; 2]; 2];
        };
        let s = span.local(p.x).on_member(span.length, span.reversed).s;
        let rate = if span.reversed {
            -span.length * span.scale
        } else {
            span.length * span.scale
        };
        let out = uniform_load(
            &self.elements[span.element],
            clamped.load(p.axis.component()),
            s,
        );
        out.map(|[value, slope]| [value, slope * rate])
    }

    /// Displacement at a probe along its axis by a motion of the member that carries it, and its derivative by the rail
    /// coordinate.
    ///
    /// # Errors
    /// As [`Rails::row`].
    pub fn member_motion(&self, p: Probe, motion: &MemberMotion) -> Result<[f64; 2], Error> {
        let span = self.stiff_span(p)?;
        let element = &self.elements[span.element];
        if element.is_rigid_arm() {
            return Ok([0.0; 2]);
        }
        let LocalPlace { end, r } = span.local(p.x);
        let at = if (end == 0) == span.reversed {
            1.0 - r
        } else {
            r
        };
        let polynomial = motion.of_rail(element, p.axis.component());
        let (mut value, mut slope) = (0.0, 0.0);
        for c in polynomial.into_iter().rev() {
            slope = slope * at + value;
            value = value * at + c;
        }
        let scale = if span.reversed {
            -span.scale
        } else {
            span.scale
        };
        Ok([value, scale * slope])
    }

    /// Sizes of the terms behind [`Rails::row`] and Green's function at a place of an element, for bounds of rounding
    /// errors; all zero for an element that does not exist.
    ///
    /// `fractions` are the distances of the place from the first and the last end, in lengths of the element. `axes`
    /// is the error of the axes of the element in roundings, 0 where they are exact. `shift` is the error of the
    /// place, length. `doubles` says that the functions are those of doubles, in which components of loads that are
    /// only rounding count as zero.
    #[must_use]
    pub fn rounding_sizes(
        &self,
        element: usize,
        axis: Axis,
        [first, last]: [f64; 2],
        [axes, shift]: [f64; 2],
        doubles: bool,
    ) -> RoundingSizes {
        let Some(given) = self.elements.get(element) else {
            return RoundingSizes::default();
        };
        let place = if first <= last {
            LocalPlace { end: 0, r: first }
        } else {
            LocalPlace { end: 1, r: last }
        };
        let place = LocalPlace {
            r: place.r.max(0.0),
            ..place
        };
        let errors = [axes, shift / (given.x[1] - given.x[0])];
        RoundingSizes::new(
            given,
            self.clamped(element),
            axis.component(),
            place,
            errors,
            if doubles { 1.0 } else { 0.0 },
        )
    }

    /// Green's function of element `element` clamped at both ends, 3 x 3: `[i][j]` is the displacement along
    /// axis i at rail coordinate x per unit force along axis j at z, both at the rail's offset, length/force.
    ///
    /// Coordinates beyond the element count as its ends. The result is zero for a rigid arm or an element
    /// that does not exist, and infinite in a direction in which the section has no stiffness.
    ///
    /// Guarantee: `kernel(c, x, z)[i][j] == kernel(c, z, x)[j][i]` to the last bit; positive semi-definite.
    ///
    /// # Source
    /// theta' = m/EI, m' = -V, v' = theta + V/kGA, clamped at both ends: Cowper, J. Appl. Mech. 33 (1966).
    #[must_use]
    pub fn clamped_green(&self, element: usize, x: f64, z: f64) -> [[f64; 3]; 3] {
        let mut out = [[0.0; 3]; 3];
        let (Some(given), Some(clamped)) = (self.elements.get(element), self.clamped(element))
        else {
            return out;
        };
        let scale = 1.0 / (given.x[1] - given.x[0]);
        let rest = self.rests[element];
        let [s, t] = [x, z].map(|x| {
            let distances = [(x - given.x[0]) - rest[0], (given.x[1] - x) + rest[1]];
            LocalPlace::by_distances(distances, scale).on_member(given.length, given.is_reversed())
        });
        for (a, row) in out.iter_mut().enumerate() {
            for (b, entry) in row.iter_mut().enumerate() {
                *entry = if clamped.is_without_stiffness(a, b) {
                    f64::INFINITY
                } else {
                    clamped.pair(a, s, clamped, b, t).value
                };
            }
        }
        out
    }

    /// Green's function between two probes on one member, with both ends of the member held: displacement at the place
    /// of row `p` along its axis per unit force at that of `q`, length/force. Zero where they are on different members.
    ///
    /// Guarantee: it keeps its digits near both ends of the member, where it vanishes.
    #[must_use]
    pub fn clamped_between(&self, p: &ShapeRow, q: &ShapeRow) -> f64 {
        self.clamped_on_one_member(p.element, q.element)
            .map_or(0.0, |[own, other]| {
                own.value(p.axis, p.place, other, q.axis, q.place)
            })
    }

    /// [`Rails::clamped_between`] for all pairs of rows whose elements belong to one member: calls `each` with the indices
    /// i >= j of two rows and the value, length/force. What belongs to one place is evaluated once.
    ///
    /// Both functions agree up to the rounding of their terms.
    ///
    /// # Source
    /// b(s, t) = near(s) . far(t): see `SeparatedLoad` in `rail/green.rs`.
    pub fn clamped_pairs(&self, rows: &[&ShapeRow], mut each: impl FnMut(usize, usize, f64)) {
        let mut loads: Vec<SeparatedLoad> = Vec::with_capacity(rows.len());
        for (i, row) in rows.iter().enumerate() {
            let Some(clamped) = self.clamped(row.element) else {
                (0..=i).for_each(|j| each(i, j, 0.0));
                continue;
            };
            loads.push(clamped.separated(row.axis, row.place, 1.0, 1.0));
            for (j, other) in loads.iter().enumerate() {
                each(i, j, loads[i].value_with(other));
            }
        }
    }

    /// Green's function of a clamped element; `None` for a rigid arm or an element that does not exist.
    pub(crate) fn clamped(&self, element: usize) -> Option<&ClampedElement> {
        self.prepared
            .get(element)
            .and_then(|prepared| prepared.clamped.as_ref())
    }

    /// Whether some member has more than one element.
    pub(crate) fn shares_members(&self) -> bool {
        self.shares_members
    }

    /// Green's functions of two elements that belong to one member; `None` where they do not.
    pub(crate) fn clamped_on_one_member(&self, a: usize, b: usize) -> Option<[&ClampedElement; 2]> {
        let (a, b) = (self.prepared.get(a)?, self.prepared.get(b)?);
        Some([a.clamped.as_ref()?, b.clamped.as_ref()?]).filter(|_| a.group == b.group)
    }

    /// Ends of the elements of `rail`, increasing, each once; none where the rail does not exist.
    #[must_use]
    pub fn breaks(&self, rail: usize) -> Vec<f64> {
        self.track(rail).map_or(Vec::new(), Track::breaks)
    }

    /// First and last coordinate of `rail`; `None` where it has no element.
    #[must_use]
    pub fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.track(rail).map(Track::range)
    }

    fn track(&self, rail: usize) -> Option<&Track> {
        match self.tracks.get(rail) {
            Some(track) if track.rail == rail => Some(track),
            _ => self
                .tracks
                .binary_search_by_key(&rail, |t| t.rail)
                .ok()
                .map(|k| &self.tracks[k]),
        }
    }

    /// The element that carries a coordinate.
    fn span(&self, rail: usize, x: f64) -> Result<&Span, Error> {
        self.track(rail).ok_or(Error::NoRail { rail })?.find(x)
    }

    /// The element that carries a probe, if it has stiffness along the probe's axis.
    #[inline]
    pub(crate) fn stiff_span(&self, p: Probe) -> Result<&Span, Error> {
        let span = self.span(p.rail, p.x)?;
        if self.prepared[span.element].without_stiffness[p.axis.component()] {
            return Err(Error::NoStiffness {
                rail: p.rail,
                x: p.x,
                axis: p.axis,
            });
        }
        Ok(span)
    }
}
