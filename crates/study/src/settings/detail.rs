//! How fine the mesh or the modes of a reference are.

/// How finely a structure with mass is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshDetail {
    /// So many of its lowest natural modes, and the static give of all others.
    Modes(usize),
    /// All modes of a mesh of so many elements a member.
    Mesh(usize),
}

impl MeshDetail {
    /// The same by half as many.
    pub(crate) const fn half(self) -> MeshDetail {
        match self {
            MeshDetail::Modes(count) => MeshDetail::Modes(count / 2),
            MeshDetail::Mesh(count) => MeshDetail::Mesh(count / 2),
        }
    }
}
