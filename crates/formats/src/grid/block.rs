//! The blocks of an influence grid.

use std::fmt;

/// One block of an influence grid: the direction of the deflection and that of the load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum GridBlock {
    /// Vertical deflection from vertical loads.
    Vertical,
    /// Lateral deflection from lateral loads.
    Lateral,
    /// Longitudinal displacement from longitudinal loads.
    Longitudinal,
    /// Vertical deflection from lateral loads.
    VerticalLateral,
    /// Vertical deflection from longitudinal loads.
    VerticalLongitudinal,
    /// Lateral deflection from longitudinal loads.
    LateralLongitudinal,
}

impl GridBlock {
    /// All six, direct grids first.
    pub const ALL: [GridBlock; 6] = [
        GridBlock::Vertical,
        GridBlock::Lateral,
        GridBlock::Longitudinal,
        GridBlock::VerticalLateral,
        GridBlock::VerticalLongitudinal,
        GridBlock::LateralLongitudinal,
    ];

    /// Name of the grid in grid files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            GridBlock::Vertical => "vertical",
            GridBlock::Lateral => "lateral",
            GridBlock::Longitudinal => "longitudinal",
            GridBlock::VerticalLateral => "vertical_lateral",
            GridBlock::VerticalLongitudinal => "vertical_longitudinal",
            GridBlock::LateralLongitudinal => "lateral_longitudinal",
        }
    }

    /// The direct grids of the directions of deflection and of load.
    #[must_use]
    pub fn direct(self) -> [GridBlock; 2] {
        match self {
            GridBlock::VerticalLateral => [GridBlock::Vertical, GridBlock::Lateral],
            GridBlock::VerticalLongitudinal => [GridBlock::Vertical, GridBlock::Longitudinal],
            GridBlock::LateralLongitudinal => [GridBlock::Lateral, GridBlock::Longitudinal],
            direct => [direct, direct],
        }
    }
}

impl fmt::Display for GridBlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
