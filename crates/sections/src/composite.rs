//! A girder and its rail as one plane section.

/// Area and second moments of area about its own centroid, of a part or of a whole section, in any unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneSection {
    /// Area.
    pub area: f64,
    /// Second moment of area for vertical bending.
    pub i_vertical: f64,
    /// Second moment of area for lateral bending.
    pub i_lateral: f64,
}

impl PlaneSection {
    /// The section of a girder and a rail of the same modulus whose centroid lies `height` above that of the girder, in its
    /// vertical plane, and the height of the common centroid above that of the girder.
    ///
    /// A = Ag + Ar, e = Ar d/A, Iv = Ig + Ir + (Ag Ar/A) d^2 for the height d, Il = Ig + Ir (plane sections remain plane, no slip).
    ///
    /// ```
    /// use sections::PlaneSection;
    ///
    /// // a bar of 1 x 2 upright on an equal one is a bar of 1 x 4
    /// let bar = PlaneSection { area: 2.0, i_vertical: 8.0 / 12.0, i_lateral: 2.0 / 12.0 };
    /// let (both, shift) = bar.with_rail(&bar, 2.0);
    /// assert!((both.i_vertical - 64.0 / 12.0).abs() < 1e-14);
    /// assert_eq!((both.area, shift), (4.0, 1.0));
    /// ```
    #[must_use]
    pub fn with_rail(&self, rail: &PlaneSection, height: f64) -> (PlaneSection, f64) {
        let area = self.area + rail.area;
        let shift = height * (rail.area / area);
        let parallel = self.area * shift * height;
        let whole = PlaneSection {
            area,
            i_vertical: self.i_vertical + rail.i_vertical + parallel,
            i_lateral: self.i_lateral + rail.i_lateral,
        };
        (whole, shift)
    }
}
