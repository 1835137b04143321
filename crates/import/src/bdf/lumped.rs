//! Mass of elements lumped at their ends.
//!
//! NASTRAN lumps the mass of bars, beams, rods and tubes unless PARAM COUPMASS is above 0: half of it is at each end of
//! the flexible part, in translation. Half of the inertia in twist of a CBEAM is there too. A beam spec has it as rigid
//! masses, whose moments of inertia are about the global axes. By default this is done for rods and tubes alone: the mass of a
//! beam acts along it, so that its own weight bends it, whatever the number of elements.
//!
//! # Source
//! NASTRAN quick reference guides, parameter COUPMASS.

use std::collections::BTreeMap;

use crate::findings::{FilePlace, ImportFinding, ImportFindings};
use crate::structure::{ImportedMass, ImportedStructure, MASS_RANGE, MassDistribution};
use formats::text::number::number;
use formats::vector::{length, minus};

/// Mass of a member.
#[derive(Clone, Copy, Debug, Default)]
pub struct MemberMass {
    /// Position of the card of the element.
    pub card: FilePlace,
    /// Mass per length.
    pub per_length: f64,
    /// Moment of inertia per length about the axis of the member.
    pub twist: f64,
}

/// Deviation of the axis of a member from a global axis that is taken for rounding.
const ALIGNED: f64 = 1e-9;

/// Adds the masses of members at their ends; `masses` has one entry for each member, zero where its mass is distributed.
pub fn add(
    structure: &mut ImportedStructure,
    masses: &[MemberMass],
    mass: MassDistribution,
    findings: &mut ImportFindings,
) {
    // ends of several members at one place have one mass; the key of the place has the bits of its coordinates
    let mut places: BTreeMap<(usize, [u64; 3]), ImportedMass> = BTreeMap::new();
    let mut skew: Option<(FilePlace, usize)> = None;
    for (index, mass) in masses
        .iter()
        .enumerate()
        .filter(|(_, mass)| mass.per_length > 0.0)
    {
        let ends = structure.ends(index);
        let along = minus(ends[1], ends[0]);
        let half = 0.5 * length(along);
        let axis = (0..3).find(|&k| along[k].abs() >= (1.0 - ALIGNED) * 2.0 * half);
        let member = &structure.members[index];
        for end in [0, 1] {
            // adding zero removes the sign of a negative zero
            let offset = member.offsets[end].map(|part| part + 0.0);
            let point = member.points[end];
            let entry = places
                .entry((point, offset.map(f64::to_bits)))
                .or_insert(ImportedMass {
                    point,
                    mass: 0.0,
                    inertia: [0.0; 3],
                    offset,
                });
            entry.mass += mass.per_length * half;
            if let Some(axis) = axis {
                entry.inertia[axis] += mass.twist * half;
            }
        }
        if axis.is_none() && mass.twist > 0.0 {
            skew.get_or_insert((mass.card, 0)).1 += 1;
        }
    }
    if let Some(wrong) = places.values().find_map(ImportedMass::beyond_magnitudes) {
        let heaviest = masses
            .iter()
            .max_by(|a, b| a.per_length.total_cmp(&b.per_length));
        let at = heaviest.map_or(FilePlace::default(), |mass| mass.card);
        let finding = ImportFinding::new(at, "mass of elements", MASS_RANGE);
        findings.error(finding.with_found(number(wrong)));
        return;
    }
    let first = masses.iter().find(|mass| mass.per_length > 0.0);
    if let Some(first) = first {
        let of_rods = "the mass of rods and tubes is lumped at their ends, as in NASTRAN unless PARAM COUPMASS is \
                       positive";
        let of_all = "the mass of elements is lumped at their ends, as in NASTRAN unless PARAM COUPMASS is positive";
        let message = if mass == MassDistribution::LumpedRods {
            of_rods
        } else {
            of_all
        };
        let finding = ImportFinding::new(first.card, "mass", message);
        findings.warn(finding.hint("use --mass distributed to distribute it along all elements"));
    }
    if let Some((card, count)) = skew {
        let message =
            format!("is ignored for {count} CBEAM that are not parallel to a global axis");
        findings.warn(ImportFinding::new(card, "torsional inertia", message));
    }
    structure.masses.extend(places.into_values());
}
