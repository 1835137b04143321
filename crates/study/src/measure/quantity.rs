//! Groups of columns in which errors are measured.

use formats::scene::Scene;
use formats::units::Dimension;
use results::columns::HistoryColumn;

/// A group of columns whose errors are relative to one common largest value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorGroup {
    /// Deflections of bodies, of rails under wheels, and of gauges.
    Deflection,
    /// Vertical forces of wheels on rails.
    WheelForce,
    /// Lateral forces of wheels on rails; impacts of flanges make them the most sensitive group.
    LateralForce,
    /// Reactions of supports, and sums of wheel forces on a rail.
    Reaction,
    /// Moments of supports and internal moments.
    Moment,
}

impl ErrorGroup {
    /// All groups, in the order of charts.
    pub const ALL: [ErrorGroup; ErrorGroup::COUNT] = [
        ErrorGroup::Deflection,
        ErrorGroup::WheelForce,
        ErrorGroup::LateralForce,
        ErrorGroup::Reaction,
        ErrorGroup::Moment,
    ];
    /// Number of groups.
    pub const COUNT: usize = 5;
    /// Number of leading groups that a study must resolve: deflections and vertical wheel forces.
    pub const REQUIRED: usize = 2;

    /// The word of the group in files.
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

    /// The name of the group in charts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            ErrorGroup::WheelForce => "wheel force",
            ErrorGroup::LateralForce => "lateral wheel force",
            _ => self.word(),
        }
    }

    /// The group of a column of a run of `scene`; `own`: whether the scene records the column itself, else it is a
    /// response of a structure. Shear forces inside structures belong to no group: they jump where a wheel passes.
    #[must_use]
    pub fn of(
        column: &HistoryColumn,
        scene: &Scene,
        own: bool,
        is_reaction: bool,
    ) -> Option<ErrorGroup> {
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
                structure
                    .gauges
                    .iter()
                    .any(|gauge| name == format!("{}.{}", structure.name, gauge.name))
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
