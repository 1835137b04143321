//! The blocks of an influence grid. Each block relates displacements in one direction to loads in one direction.

use std::fmt;

use splines::Axis;

/// One block of an influence grid: the direction of the displacement and that of the load.
///
/// By Maxwell's reciprocity the transpose of a coupling block is the block with the two directions exchanged, so that
/// six of the nine pairs of directions suffice.
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
    /// All six blocks, the direct ones first.
    pub const ALL: [GridBlock; 6] = [
        GridBlock::Vertical,
        GridBlock::Lateral,
        GridBlock::Longitudinal,
        GridBlock::VerticalLateral,
        GridBlock::VerticalLongitudinal,
        GridBlock::LateralLongitudinal,
    ];

    /// The key of the block in grid files.
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

    /// The direct blocks of the direction of displacement and of the direction of load. For a direct block both are
    /// the block itself.
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

/// Directions of displacement and load of a block.
#[must_use]
pub const fn axes(block: GridBlock) -> (Axis, Axis) {
    match block {
        GridBlock::Vertical => (Axis::Vertical, Axis::Vertical),
        GridBlock::Lateral => (Axis::Lateral, Axis::Lateral),
        GridBlock::Longitudinal => (Axis::Longitudinal, Axis::Longitudinal),
        GridBlock::VerticalLateral => (Axis::Vertical, Axis::Lateral),
        GridBlock::VerticalLongitudinal => (Axis::Vertical, Axis::Longitudinal),
        GridBlock::LateralLongitudinal => (Axis::Lateral, Axis::Longitudinal),
    }
}
