//! The resolution of a structure with mass in a reference.

/// How a structure with mass is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshDetail {
    /// This number of its lowest natural modes, with the residual flexibility of all others.
    Modes(usize),
    /// All modes of a mesh with this number of elements in each member.
    Mesh(usize),
}

impl MeshDetail {
    /// The same with half the number.
    pub(crate) const fn half(self) -> MeshDetail {
        match self {
            MeshDetail::Modes(count) => MeshDetail::Modes(count / 2),
            MeshDetail::Mesh(count) => MeshDetail::Mesh(count / 2),
        }
    }
}
