//! What errors are measured in: groups of a run's columns.

use formats::scene::Scene;
use formats::units::Dimension;
use results::record::HistoryColumn;

/// A group of columns that have one scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorGroup {
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

impl ErrorGroup {
    /// All of them, in the order of charts.
    pub const ALL: [ErrorGroup; ErrorGroup::COUNT] = [
        ErrorGroup::Deflection,
        ErrorGroup::WheelForce,
        ErrorGroup::LateralForce,
        ErrorGroup::Reaction,
        ErrorGroup::Moment,
    ];
    /// How many they are.
    pub const COUNT: usize = 5;
    /// How many of the first a study must tell: deflections and vertical wheel forces.
    pub const ASKED: usize = 2;

    /// Its word in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            ErrorGroup::Deflection => "deflection",
            ErrorGroup::WheelForce => "wheel_force",
            ErrorGroup::LateralForce => "lateral_force",
            ErrorGroup::Reaction => "reaction",
            ErrorGroup::Moment => "moment",
        }
    }

    /// Its name in pictures.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            ErrorGroup::WheelForce => "wheel force",
            ErrorGroup::LateralForce => "lateral wheel force",
            _ => self.word(),
        }
    }

    /// The group of a column of a run of `scene`; `own`: what the scene records by itself, else what its structures
    /// answer. Shears inside structures have none: they jump where a wheel passes.
    #[must_use]
    pub fn of(column: &HistoryColumn, scene: &Scene, own: bool, is_reaction: bool) -> Option<ErrorGroup> {
        let name = column.name.as_str();
        let ends = |part: &str| name.ends_with(part);
        if !own {
            return match column.dimension {
                Dimension::MOMENT => Some(ErrorGroup::Moment),
                Dimension::FORCE if is_reaction => Some(ErrorGroup::Reaction),
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
                Some(ErrorGroup::Deflection)
            }
            Dimension::FORCE if ends(".vertical") => Some(ErrorGroup::WheelForce),
            Dimension::FORCE if ends(".lateral") => Some(ErrorGroup::LateralForce),
            Dimension::FORCE if ends(".reaction") => Some(ErrorGroup::Reaction),
            _ => None,
        }
    }
}
