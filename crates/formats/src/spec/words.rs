//! Words of specs and grid files for beam theories, degrees of freedom and internal forces.

use fea::{BeamTheory, Dof, ForceComponent};

/// Words of the beam theories.
pub const THEORIES: [(&str, BeamTheory); 2] =
    [("euler-bernoulli", BeamTheory::EulerBernoulli), ("timoshenko", BeamTheory::Timoshenko)];

/// The word of a beam theory in files.
#[must_use]
pub const fn theory_word(theory: BeamTheory) -> &'static str {
    match theory {
        BeamTheory::EulerBernoulli => "euler-bernoulli",
        BeamTheory::Timoshenko => "timoshenko",
    }
}

/// Words of the degrees of freedom of points and of the ends of members.
pub(super) const FREEDOMS: [(&str, Dof); 6] =
    [("ux", Dof::Ux), ("uy", Dof::Uy), ("uz", Dof::Uz), ("rx", Dof::Rx), ("ry", Dof::Ry), ("rz", Dof::Rz)];

/// Words of the components of an internal force, in the member's local axes.
pub const COMPONENTS: [(&str, ForceComponent); 6] = [
    ("N", ForceComponent::Axial),
    ("Vy", ForceComponent::ShearY),
    ("Vz", ForceComponent::ShearZ),
    ("Mx", ForceComponent::Torsion),
    ("My", ForceComponent::BendingY),
    ("Mz", ForceComponent::BendingZ),
];
