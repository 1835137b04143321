//! The two functions of one element in a number type of the caller's, for values to more digits than doubles have.

use super::element::{LocalPlace, RailElement};
use super::green::ClampedElement;
use super::load::AxisLoad;
use super::shape::shape_values;
use crate::probe::Axis;
use crate::vector::RealNumber;

/// Shape functions and Green's function of one rail element, in the number type T.
///
/// They are the same formulas as those of [`crate::Rails`], without preparation for many evaluations.
///
/// ```
/// use splines::{Axis, ElementFunctions, Flexibility, RailElement};
///
/// let element = RailElement {
///     rail: 0,
///     x: [0.0, 8.0],
///     ends: [0, 1],
///     length: 8.0,
///     frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
///     offset: [0.0; 3],
///     flexibility: Flexibility { bending_z: 1.0, ..Flexibility::default() },
///     member: None,
/// };
/// let functions = ElementFunctions::new(element);
/// // Midspan of a clamped beam: half of the displacements of both ends, and l^3/(192 EI) between them.
/// let shapes = functions.shapes(Axis::Vertical, 4.0);
/// assert_eq!([shapes[1], shapes[7]], [0.5, 0.5]);
/// let own = functions.clamped_green(Axis::Vertical, 4.0, &functions, Axis::Vertical, 4.0);
/// assert!((own - 512.0_f64 / 192.0).abs() < 1e-14);
/// ```
#[derive(Clone, Debug)]
pub struct ElementFunctions<T> {
    element: RailElement<T>,
    /// 1/(extent in x).
    scale: T,
    /// `None` for a rigid arm.
    clamped: Option<ClampedElement<T>>,
}

impl<T: RealNumber> ElementFunctions<T> {
    /// The functions of an element whose numbers are sound: [`crate::Rails::new`] checks those of its doubles.
    #[must_use]
    pub fn new(element: RailElement<T>) -> ElementFunctions<T> {
        let clamped = (!element.is_rigid_arm()).then(|| ClampedElement::new(&element));
        ElementFunctions {
            scale: T::from(1.0) / (element.x[1] - element.x[0]),
            element,
            clamped,
        }
    }

    /// The element.
    #[must_use]
    pub fn element(&self) -> &RailElement<T> {
        &self.element
    }

    /// Displacement of the rail at coordinate x along `axis` by each degree of freedom of the first end, then of
    /// the last; for a rigid arm the last six are zero. Coordinates beyond the element count as its ends.
    #[must_use]
    pub fn shapes(&self, axis: Axis, x: T) -> [T; 12] {
        let axis = axis.component();
        let load = AxisLoad::new(&self.element, &self.element.frame, axis);
        shape_values(&self.element, axis, &load, self.local(x))
    }

    /// Displacement along `axis` at x under a unit force along `other_axis` at z of `other`, an element of the
    /// same member or this one, with both ends of the member held, length/force. Zero for a rigid arm, and without
    /// what the section has no stiffness for.
    #[must_use]
    pub fn clamped_green(
        &self,
        axis: Axis,
        x: T,
        other: &ElementFunctions<T>,
        other_axis: Axis,
        z: T,
    ) -> T {
        let (Some(own), Some(loaded)) = (&self.clamped, &other.clamped) else {
            return T::from(0.0);
        };
        let place = |of: &ElementFunctions<T>, x: T| {
            of.local(x)
                .on_member(of.element.length, of.element.is_reversed())
        };
        own.value(
            axis.component(),
            place(self, x),
            loaded,
            other_axis.component(),
            place(other, z),
        )
    }

    fn local(&self, x: T) -> LocalPlace<T> {
        LocalPlace::of(x, self.element.x, self.scale)
    }
}
