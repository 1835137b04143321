//! Keywords for beam theories, degrees of freedom and internal forces in specs and grid files.

use fea::{BeamTheory, Dof, ForceComponent};

/// Keywords of the beam theories.
pub const THEORIES: [(&str, BeamTheory); 2] = [
    ("euler-bernoulli", BeamTheory::EulerBernoulli),
    ("timoshenko", BeamTheory::Timoshenko),
];

/// The keyword of a beam theory in files.
#[must_use]
pub const fn theory_word(theory: BeamTheory) -> &'static str {
    match theory {
        BeamTheory::EulerBernoulli => "euler-bernoulli",
        BeamTheory::Timoshenko => "timoshenko",
    }
}

/// Keywords of the degrees of freedom of points and of the ends of members.
pub(super) const DOF_WORDS: [(&str, Dof); 6] = [
    ("ux", Dof::Ux),
    ("uy", Dof::Uy),
    ("uz", Dof::Uz),
    ("rx", Dof::Rx),
    ("ry", Dof::Ry),
    ("rz", Dof::Rz),
];

/// Keywords of the components of an internal force, in the local axes of the member.
pub const COMPONENTS: [(&str, ForceComponent); 6] = [
    ("N", ForceComponent::Axial),
    ("Vy", ForceComponent::ShearY),
    ("Vz", ForceComponent::ShearZ),
    ("Mx", ForceComponent::Torsion),
    ("My", ForceComponent::BendingY),
    ("Mz", ForceComponent::BendingZ),
];
