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

/// The member that carries a cell.
///
/// Cells of one member, on different rails, are the same stretch of steel: a force on one of them bends
/// the other between its ends too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Carrier {
    /// Identity of the member; only whether two are equal counts.
    pub member: usize,
    /// Whether the member's own local x runs against the cell's: the cell's local axes are then the
    /// member's turned by half a turn about local y.
    pub reversed: bool,
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
    /// The member whose whole flexible part the cell stands on; `None` is one that no other cell shares.
    pub carrier: Option<Carrier>,
}

impl Cell {
    /// Whether the member runs against the cell.
    #[must_use]
    pub fn is_reversed(&self) -> bool {
        self.carrier.is_some_and(|carrier| carrier.reversed)
    }

    /// Place along the member, 0..=`length` in the direction of the member's own local x, of rail
    /// coordinate x, taken within the cell.
    #[must_use]
    pub fn place(&self, x: f64) -> f64 {
        let [first, last] = self.x;
        let r = if x >= last { 1.0 } else { ((x - first) / (last - first)).clamp(0.0, 1.0) };
        if self.is_reversed() { (1.0 - r) * self.length } else { r * self.length }
    }

    /// Rows: the member's own local axes in the rail frame; those of `frame`, turned where the member
    /// runs against the cell.
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let [x, y, z] = self.frame;
        if self.is_reversed() { [x.map(|a| -a), y, z.map(|a| -a)] } else { self.frame }
    }
}
