//! What errors are measured in: groups of a run's columns.

use formats::scene::Scene;
use formats::units::Dimension;
use results::record::Column;

/// A group of columns that have one scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Deflections of bodies, of rails under wheels, and of gauges.
    Deflection,
    /// Vertical forces of wheels on rails.
    WheelForce,
    /// Lateral ones: flanges that strike make them the most sensitive of all.
    LateralForce,
    /// Forces of the ground, and sums of wheel forces by rail.
    Reaction,
    /// Moments of the ground and internal moments.
    Moment,
}

impl Quantity {
    /// All of them, in the order of charts.
    pub const ALL: [Quantity; Quantity::COUNT] = [
        Quantity::Deflection,
        Quantity::WheelForce,
        Quantity::LateralForce,
        Quantity::Reaction,
        Quantity::Moment,
    ];
    /// How many they are.
    pub const COUNT: usize = 5;
    /// How many of the first a study must tell: deflections and vertical wheel forces.
    pub const ASKED: usize = 2;

    /// Its word in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Quantity::Deflection => "deflection",
            Quantity::WheelForce => "wheel_force",
            Quantity::LateralForce => "lateral_force",
            Quantity::Reaction => "reaction",
            Quantity::Moment => "moment",
        }
    }

    /// Its name in pictures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Quantity::WheelForce => "wheel force",
            Quantity::LateralForce => "lateral wheel force",
            _ => self.word(),
        }
    }

    /// The group of a column of a run of `scene`; `own`: what the scene records by itself, else what its structures
    /// answer. Shears inside structures have none: they jump where a wheel passes.
    #[must_use]
    pub fn of(column: &Column, scene: &Scene, own: bool, is_reaction: bool) -> Option<Quantity> {
        let name = column.name.as_str();
        let ends = |part: &str| name.ends_with(part);
        if !own {
            return match column.dimension {
                Dimension::MOMENT => Some(Quantity::Moment),
                Dimension::FORCE if is_reaction => Some(Quantity::Reaction),
                _ => None,
            };
        }
        let is_gauge = || {
            let mut structures = scene.structures.iter();
            structures.any(|structure| {
                structure.gauges.iter().any(|gauge| name == format!("{}.{}", structure.name, gauge.name))
            })
        };
        match column.dimension {
            Dimension::LENGTH if ends(".deflection") || ends(".rail_deflection") || is_gauge() => {
                Some(Quantity::Deflection)
            }
            Dimension::FORCE if ends(".vertical") => Some(Quantity::WheelForce),
            Dimension::FORCE if ends(".lateral") => Some(Quantity::LateralForce),
            Dimension::FORCE if ends(".reaction") => Some(Quantity::Reaction),
            _ => None,
        }
    }
}
