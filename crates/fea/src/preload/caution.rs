//! What the state of a preload leaves out, where it may matter.

use std::f64::consts::PI;

use super::forces::MemberForces;
use crate::assembly::Element;
use crate::model::{MemberKind, Model};

/// Ratio from which what is left out is named.
const NOTED: f64 = 0.1;
/// (lambda l) of a member in tension from which rounding between its ends is named: doubles lose a factor exp(lambda l/2), here
/// 3e5, which leaves ten digits.
const SLENDER: f64 = 25.0;

/// Something that the state of a preload leaves out, and that may matter for a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caution {
    /// Index of the member.
    pub member: usize,
    /// What is left out.
    pub kind: CautionKind,
    /// The ratio that says how much it matters; from 0.1 (1 for `TrussBuckles`, 25 for `Slender`) it is named.
    pub ratio: f64,
}

/// What the state of a preload leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CautionKind {
    /// Moments in the member, lateral-torsional buckling: largest moment at its ends by pi sqrt(EI_min GJ)/L.
    Moments,
    /// The part of the axial force in twist (Wagner): |N| i_p^2/GJ.
    Twist,
    /// A truss in compression stays straight: its axial force by its own Euler load.
    TrussBuckles,
    /// Where theories of shear under axial force differ: |N|/(G As).
    Shear,
    /// Digits between the ends of a member in strong tension: L sqrt(N/EI_min).
    Slender,
}

impl Caution {
    /// All that is to be named of a loaded model whose members have the forces `forces`.
    pub(super) fn all(m: &Model, elements: &[Element], forces: &[MemberForces]) -> Vec<Caution> {
        let mut out = Vec::new();
        for (member, (element, forces)) in elements.iter().zip(forces).enumerate() {
            let own = &m.members[member];
            let section = &m.sections[own.section];
            let (n, l) = (own.tension, element.length);
            let least = section.iy.min(section.iz);
            let mut add = |kind: CautionKind, ratio: f64, from: f64| {
                if ratio > from && ratio.is_finite() {
                    out.push(Caution {
                        member,
                        kind,
                        ratio,
                    });
                }
            };
            if own.kind == MemberKind::Beam {
                let gj = section.g * section.j;
                let bending = section.e * least;
                add(
                    CautionKind::Moments,
                    forces.moment * l / (PI * (bending * gj).sqrt()),
                    NOTED,
                );
                let polar = section.gyration_squared(section.iy + section.iz);
                add(CautionKind::Twist, n.abs() * polar / gj, NOTED);
                let f = &element.flexibility;
                add(
                    CautionKind::Shear,
                    n.abs() * f.shear_y.max(f.shear_z),
                    NOTED,
                );
                add(
                    CautionKind::Slender,
                    l * (n.max(0.0) / bending).sqrt(),
                    SLENDER,
                );
            } else if own.kind != MemberKind::Cable && n < 0.0 {
                let euler = PI * PI * section.e * least / (l * l);
                add(CautionKind::TrussBuckles, -n / euler, 1.0);
            }
        }
        out
    }
}
