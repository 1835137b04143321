//! Straight girders, continuous over their supports.

use crate::error::{Error, Fault, Item, Quantity};
use crate::model::{Member, Model, Support};
use crate::rail::{Rail, Segment};
use crate::section::{Section, Theory, not_negative, positive};

/// A straight uniform girder along global x (y up), with a rail over its whole length.
///
/// Each support, at every span end, holds vertical, lateral and twist on the elastic axis; the first
/// also holds the length; slopes are free. What is `None` resists nothing (shear areas: rigid), and
/// directions that need it are refused.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Girder {
    /// Distances between supports, length.
    pub spans: Vec<f64>,
    /// Free ends before the first and after the last support, length; zero for none.
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
    /// Mass per length.
    pub mass_per_length: Option<f64>,
    /// Beam theory.
    pub theory: Theory,
    /// Stations of the rail; coordinate 0 is the first support.
    pub stations: Vec<f64>,
}

impl Girder {
    /// The girder as a frame of one member a span and overhang, and its rail.
    ///
    /// # Errors
    /// The first number that cannot be used.
    pub fn frame(&self) -> Result<(Model, Rail), Error> {
        self.check()?;
        let section = Section {
            e: self.e,
            g: self.g.unwrap_or(0.0),
            area: self.area.unwrap_or(0.0),
            iy: self.i_lateral.unwrap_or(0.0),
            iz: self.i_vertical,
            j: self.j.unwrap_or(0.0),
            shear_y: self.ka_vertical,
            shear_z: self.ka_lateral,
            mass: self.mass_per_length.unwrap_or(0.0),
        };
        let mut model = Model { up: [0.0, 1.0, 0.0], theory: self.theory, ..Model::default() };
        model.sections.push(section);
        let mut at = |x: f64| {
            model.points.push([x, 0.0, 0.0]);
            model.points.len() - 1
        };
        if self.overhangs[0] > 0.0 {
            at(-self.overhangs[0]);
        }
        let mut x = 0.0;
        let mut supported = vec![at(x)];
        for span in &self.spans {
            x += span;
            supported.push(at(x));
        }
        if self.overhangs[1] > 0.0 {
            at(x + self.overhangs[1]);
        }
        for (k, point) in supported.into_iter().enumerate() {
            model.supports.push(Support { point, fix: [k == 0, true, true, true, false, false] });
        }
        for k in 1..model.points.len() {
            model.members.push(Member::beam([k - 1, k], 0, model.up));
        }
        let offset = [0.0, self.rail_height, 0.0];
        let segments = (0..model.members.len()).map(|member| Segment { member, offset }).collect();
        let rail =
            Rail { origin: [0.0; 3], axis: [1.0, 0.0, 0.0], segments, stations: self.stations.clone() };
        Ok((model, rail))
    }

    fn check(&self) -> Result<(), Error> {
        let invalid = |item: Item| move |fault: Fault| Error::Invalid { item, fault };
        if self.spans.is_empty() {
            return Err(invalid(Item::Girder)(Fault::Empty { quantity: Quantity::Spans }));
        }
        for (k, &span) in self.spans.iter().enumerate() {
            positive(Quantity::Length, span).map_err(invalid(Item::Span(k)))?;
        }
        for (k, &overhang) in self.overhangs.iter().enumerate() {
            not_negative(Quantity::Length, overhang).map_err(invalid(Item::Overhang(k)))?;
        }
        let girder = invalid(Item::Girder);
        positive(Quantity::E, self.e).map_err(girder)?;
        positive(Quantity::Iz, self.i_vertical).map_err(girder)?;
        let optional = [
            (Quantity::G, self.g),
            (Quantity::Area, self.area),
            (Quantity::Iy, self.i_lateral),
            (Quantity::J, self.j),
            (Quantity::ShearY, self.ka_vertical),
            (Quantity::ShearZ, self.ka_lateral),
            (Quantity::Mass, self.mass_per_length.filter(|&mass| mass != 0.0)),
        ];
        for (quantity, value) in optional {
            value.map_or(Ok(()), |value| positive(quantity, value)).map_err(girder)?;
        }
        let shears = self.ka_vertical.is_some() || self.ka_lateral.is_some();
        if self.theory == Theory::Timoshenko && shears && self.g.is_none() {
            return Err(girder(Fault::NoShearModulus));
        }
        crate::section::finite(Quantity::Offset, &[self.rail_height]).map_err(girder)
    }
}
