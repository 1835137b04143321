//! Straight girders, continuous over their supports.

use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry, finite, not_negative, positive};
use crate::model::rail::{Rail, RailSegment};
use crate::model::section::{BeamTheory, CrossSection};
use crate::model::structure::{Member, Model, Support};

/// A straight uniform girder along global x (y up) over supports, with one rail over its whole length.
///
/// A support stands at every end of a span. Each fixes the vertical and the lateral displacement and the
/// twist at the elastic axis; the first also fixes the displacement along x; slopes are free. A stiffness
/// that is `None` is absent, except that an absent shear area is rigid in shear. Loads in a direction that
/// needs an absent stiffness are refused.
///
/// # Example
/// ```
/// use fea::{FactoredFrame, Girder};
/// use splines::{Axis, Probe};
///
/// // Two spans of 60 ft with overhangs of 15 ft that bend vertically; pounds and feet.
/// let girder = Girder {
///     spans: vec![60.0, 60.0],
///     overhangs: [15.0, 15.0],
///     e: 4.32e9,
///     i_vertical: 9.528,
///     ..Girder::default()
/// };
/// let (model, rail) = girder.model_and_rail()?;
/// assert_eq!(model.members.len(), 4);
/// let frame = FactoredFrame::new(&model, &[rail])?;
/// let tips = [-15.0, 135.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let grid = frame.grid(&tips)?;
/// assert!((grid.value[(0, 0)] / grid.value[(1, 1)] - 1.0).abs() < 1e-12);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Girder {
    /// Distances between supports, length, each positive.
    pub spans: Vec<f64>,
    /// Lengths of the free ends before the first and after the last support; zero for none.
    pub overhangs: [f64; 2],
    /// Young's modulus, force/length^2.
    pub e: f64,
    /// Shear modulus, force/length^2.
    pub g: Option<f64>,
    /// Area, length^2.
    pub area: Option<f64>,
    /// Second moment of area for vertical bending, length^4.
    pub i_vertical: f64,
    /// Second moment of area for lateral bending, length^4.
    pub i_lateral: Option<f64>,
    /// Torsion constant, length^4.
    pub j: Option<f64>,
    /// Effective shear area for vertical loads, length^2.
    pub ka_vertical: Option<f64>,
    /// Effective shear area for lateral loads, length^2.
    pub ka_lateral: Option<f64>,
    /// Height of the rail above the elastic axis, length.
    pub rail_height: f64,
    /// Mass per length, force time^2/length^2.
    pub mass_per_length: Option<f64>,
    /// Beam theory.
    pub theory: BeamTheory,
    /// Stations of the rail; coordinate 0 is the first support.
    pub stations: Vec<f64>,
}

impl Girder {
    /// The girder as a model with one member for each span and overhang, and its rail.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the first number that cannot be used.
    pub fn model_and_rail(&self) -> Result<(Model, Rail), Error> {
        self.check()?;
        let mut model = Model {
            up: [0.0, 1.0, 0.0],
            theory: self.theory,
            sections: vec![self.section()],
            ..Model::default()
        };
        let supported = self.place_points(&mut model.points);
        for (k, point) in supported.into_iter().enumerate() {
            model.supports.push(Support {
                point,
                fixed: [k == 0, true, true, true, false, false],
            });
        }
        for k in 1..model.points.len() {
            model.members.push(Member::beam([k - 1, k], 0, model.up));
        }
        let offset = [0.0, self.rail_height, 0.0];
        let segments = (0..model.members.len())
            .map(|member| RailSegment { member, offset })
            .collect();
        let rail = Rail {
            origin: [0.0; 3],
            axis: [1.0, 0.0, 0.0],
            segments,
            stations: self.stations.clone(),
        };
        Ok((model, rail))
    }

    fn section(&self) -> CrossSection {
        CrossSection {
            e: self.e,
            g: self.g.unwrap_or(0.0),
            area: self.area.unwrap_or(0.0),
            iy: self.i_lateral.unwrap_or(0.0),
            iz: self.i_vertical,
            j: self.j.unwrap_or(0.0),
            shear_y: self.ka_vertical,
            shear_z: self.ka_lateral,
            mass: self.mass_per_length.unwrap_or(0.0),
        }
    }

    /// Appends the ends of all spans and overhangs along x; returns the indices of the supported points.
    fn place_points(&self, points: &mut Vec<[f64; 3]>) -> Vec<usize> {
        let mut place = |x: f64| {
            points.push([x, 0.0, 0.0]);
            points.len() - 1
        };
        if self.overhangs[0] > 0.0 {
            place(-self.overhangs[0]);
        }
        let mut x = 0.0;
        let mut supported = vec![place(x)];
        for span in &self.spans {
            x += span;
            supported.push(place(x));
        }
        if self.overhangs[1] > 0.0 {
            place(x + self.overhangs[1]);
        }
        supported
    }

    fn check(&self) -> Result<(), Error> {
        let invalid =
            |item: ModelEntry| move |fault: EntryFault| Error::Invalid { entry: item, fault };
        if self.spans.is_empty() {
            return Err(invalid(ModelEntry::Girder)(EntryFault::Empty {
                quantity: EntryAttribute::Spans,
            }));
        }
        for (k, &span) in self.spans.iter().enumerate() {
            positive(EntryAttribute::Length, span).map_err(invalid(ModelEntry::Span(k)))?;
        }
        for (k, &overhang) in self.overhangs.iter().enumerate() {
            not_negative(EntryAttribute::Length, overhang)
                .map_err(invalid(ModelEntry::Overhang(k)))?;
        }
        let girder = invalid(ModelEntry::Girder);
        positive(EntryAttribute::E, self.e).map_err(girder)?;
        positive(EntryAttribute::Iz, self.i_vertical).map_err(girder)?;
        let optional = [
            (EntryAttribute::G, self.g),
            (EntryAttribute::Area, self.area),
            (EntryAttribute::Iy, self.i_lateral),
            (EntryAttribute::J, self.j),
            (EntryAttribute::ShearY, self.ka_vertical),
            (EntryAttribute::ShearZ, self.ka_lateral),
            (
                EntryAttribute::Mass,
                self.mass_per_length.filter(|&mass| mass != 0.0),
            ),
        ];
        for (quantity, value) in optional {
            value
                .map_or(Ok(()), |value| positive(quantity, value))
                .map_err(girder)?;
        }
        let shears = self.ka_vertical.is_some() || self.ka_lateral.is_some();
        if self.theory == BeamTheory::Timoshenko && shears && self.g.is_none() {
            return Err(girder(EntryFault::NoShearModulus));
        }
        finite(EntryAttribute::Offset, &[self.rail_height]).map_err(girder)
    }
}
