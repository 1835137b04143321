//! Properties of doubly symmetric I sections with parallel flanges and root fillets.

use std::f64::consts::PI;

/// Dimensions of an I section with parallel flanges, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionDimensions {
    /// Height over the flanges.
    pub height: f64,
    /// Width of the flanges.
    pub width: f64,
    /// Thickness of the web.
    pub web: f64,
    /// Thickness of the flanges.
    pub flange: f64,
    /// Radius of the fillets between web and flanges.
    pub radius: f64,
}

/// Properties of a rolled section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RolledProperties {
    /// Area, mm2.
    pub area: f64,
    /// Second moment of area for bending in the plane of the web, mm4.
    pub i_strong: f64,
    /// Second moment of area for bending in the plane of the flanges, mm4.
    pub i_weak: f64,
    /// Torsion constant, mm4.
    pub j: f64,
    /// Elastic shear area for forces along the web, mm2.
    pub shear_web: f64,
    /// Elastic shear area for forces along the flanges, mm2.
    pub shear_flanges: f64,
}

impl SectionDimensions {
    /// Properties of the section of height h, width b, web t, flange T and root radius r.
    ///
    /// - A = 2 b T + (h - 2 T) t + (4 - pi) r^2.
    /// - Second moments: the exact sum over the rectangles and the four fillets, which are squares of side r without a quarter circle.
    ///   A fillet has the area (1 - pi/4) r^2, its centroid (10 - 3 pi)/(12 - 3 pi) r from web and flange, and the
    ///   second moment (1/3 - pi/16 - 1/(9 (4 - pi))) r^4 about its centroid.
    /// - J = 2/3 (b - 0.63 T) T^3 + 1/3 (h - 2 T) t^3 + 2 a D^4, a = (t/T) (0.145 + 0.1 r/T),
    ///   D = ((r + t/2)^2 + (r + T)^2 - r^2)/(2 r + T), the diameter of the largest circle at the junction.
    /// - Elastic shear areas: (h - T) t along the web, 5/6 of 2 b T along the flanges. They are not the areas for resistance of the codes.
    ///
    /// # Source
    /// M. H. El Darwish, B. G. Johnston: Torsion of structural shapes, J. Struct. Div. ASCE 91 (ST1), 1965 (J).
    #[must_use]
    pub fn properties(&self) -> RolledProperties {
        let SectionDimensions {
            height,
            width,
            web,
            flange,
            radius,
        } = *self;
        let clear = height - 2.0 * flange;
        let fillet = (1.0 - PI / 4.0) * radius.powi(2);
        let own = (1.0 / 3.0 - PI / 16.0 - 1.0 / (9.0 * (4.0 - PI))) * radius.powi(4);
        let centroid = (10.0 - 3.0 * PI) / (12.0 - 3.0 * PI) * radius;
        let strong = 4.0 * (own + fillet * (0.5 * clear - centroid).powi(2));
        let weak = 4.0 * (own + fillet * (0.5 * web + centroid).powi(2));
        RolledProperties {
            area: 2.0 * width * flange + clear * web + 4.0 * fillet,
            i_strong: (width * height.powi(3) - (width - web) * clear.powi(3)) / 12.0 + strong,
            i_weak: (2.0 * flange * width.powi(3) + clear * web.powi(3)) / 12.0 + weak,
            j: self.torsion(clear),
            shear_web: (height - flange) * web,
            shear_flanges: 5.0 / 6.0 * 2.0 * width * flange,
        }
    }

    /// The torsion constant of El Darwish and Johnston.
    fn torsion(&self, clear: f64) -> f64 {
        let SectionDimensions {
            width,
            web,
            flange,
            radius,
            ..
        } = *self;
        let circle = ((radius + 0.5 * web).powi(2) + (radius + flange).powi(2) - radius.powi(2))
            / (2.0 * radius + flange);
        let junction = web / flange * (0.145 + 0.1 * radius / flange);
        2.0 / 3.0 * (width - 0.63 * flange) * flange.powi(3)
            + clear * web.powi(3) / 3.0
            + 2.0 * junction * circle.powi(4)
    }
}
