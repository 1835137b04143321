//! Words of specs and grid files for beam theories, degrees of freedom and internal forces.

use fea::{Component, Freedom, Theory};

/// Words of the beam theories.
pub const THEORIES: [(&str, Theory); 2] =
    [("euler-bernoulli", Theory::EulerBernoulli), ("timoshenko", Theory::Timoshenko)];

/// The word of a beam theory in files.
#[must_use]
pub const fn theory_word(theory: Theory) -> &'static str {
    match theory {
        Theory::EulerBernoulli => "euler-bernoulli",
        Theory::Timoshenko => "timoshenko",
    }
}

/// Words of the degrees of freedom of points and of the ends of members.
pub(super) const FREEDOMS: [(&str, Freedom); 6] = [
    ("ux", Freedom::Ux),
    ("uy", Freedom::Uy),
    ("uz", Freedom::Uz),
    ("rx", Freedom::Rx),
    ("ry", Freedom::Ry),
    ("rz", Freedom::Rz),
];

/// Words of the components of an internal force, in the member's local axes.
pub const COMPONENTS: [(&str, Component); 6] = [
    ("N", Component::Axial),
    ("Vy", Component::ShearY),
    ("Vz", Component::ShearZ),
    ("Mx", Component::Torsion),
    ("My", Component::BendingY),
    ("Mz", Component::BendingZ),
];
