//! A uniform stretch of rail.

/// Flexibilities of a member's section: reciprocals, so that zero means rigid.
///
/// Local x runs along the member; `bending_z` and `shear_y` belong to the local x-y plane,
/// `bending_y` and `shear_z` to x-z. `f64::INFINITY` means that nothing resists.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flexibility {
    /// 1/(E A), per force.
    pub axial: f64,
    /// 1/(G J), per force length^2.
    pub torsion: f64,
    /// 1/(E Iy), per force length^2.
    pub bending_y: f64,
    /// 1/(E Iz), per force length^2.
    pub bending_z: f64,
    /// 1/(G Asy), per force.
    pub shear_y: f64,
    /// 1/(G Asz), per force.
    pub shear_z: f64,
}

/// A uniform stretch of rail, carried by one member (or part of one) between two end states.
///
/// A state is the displacement u and rotation theta (six freedoms, ux uy uz rx ry rz) of a flexible
/// end, in the frame of the cell's rail. At `x[0]` the cell joins state `ends[0]`, at `x[1]` `ends[1]`.
/// The rail at x moves by u(x) + theta(x) cross `offset`.
///
/// Where `ends[0] == ends[1]` the cell is a rigid arm of that one state: the rail at x moves by
/// u + theta cross (`offset` + (x - `x[0]`) e_x), and `length`, `frame`, `flexibility` say nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Which rail.
    pub rail: usize,
    /// First and last rail coordinate, increasing.
    pub x: [f64; 2],
    /// Indices of the end states.
    pub ends: [usize; 2],
    /// Length of the member's stretch, > 0; longer than `x[1] - x[0]` where the member is inclined.
    pub length: f64,
    /// Rows: the member's local axes in the rail frame; local x runs from `ends[0]` to `ends[1]`.
    pub frame: [[f64; 3]; 3],
    /// From the flexible axis to the rail, in the rail frame.
    pub offset: [f64; 3],
    /// Section flexibilities.
    pub flexibility: Flexibility,
}
