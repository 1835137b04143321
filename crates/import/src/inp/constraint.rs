//! Supports, rigid joints and releases: *BOUNDARY, *RIGID BODY, *MPC and *RELEASE.

use super::keyword::{InpField, KeywordBlock};
use super::model::{InpBoundary, InpModel, Joint, JointRequest, ReleaseRequest};
use super::values::{field, real, whole};
use crate::bdf::Omissions;
use crate::findings::{ImportFinding, ImportFindings};

/// Degrees of freedom that are temperatures: of solids and beams, and of further points in the thickness of shells.
///
/// # Source
/// Abaqus Analysis User's Guide, "Conventions"; CalculiX user's manual, *BOUNDARY.
const TEMPERATURES: std::ops::RangeInclusive<u64> = 11..=30;

impl InpModel {
    pub(super) fn read_boundary(
        &mut self,
        block: &KeywordBlock,
        omit: Omissions<'_>,
        findings: &mut ImportFindings,
    ) {
        // from degree of freedom 11 on they are temperatures
        let is_thermal = |line: &&Vec<InpField>| {
            let dof = line.get(1).and_then(|field| field.text.parse::<u64>().ok());
            dof.is_some_and(|dof| TEMPERATURES.contains(&dof))
        };
        let thermal: Vec<&Vec<InpField>> = block.data.iter().filter(is_thermal).collect();
        if let Some(first) = thermal.first().and_then(|line| line.first()) {
            let message = "is ignored at degrees of freedom from 11 on, which are temperatures";
            findings.warn(ImportFinding::new(first.at, block.label(), message));
            if thermal.len() == block.data.len() {
                return;
            }
        }
        if self.steps > 1 {
            let message =
                "is ignored in later steps: supports are those of the model and the first step";
            if omit.unused {
                findings.warn(ImportFinding::new(block.at, block.label(), message));
            } else {
                let hint = "supports are those of the model and the first step; --skip-unused ignores all others";
                let finding = ImportFinding::new(
                    block.at,
                    block.label(),
                    "must be in the model data or the first step",
                );
                findings.error(finding.hint(hint));
            }
            return;
        }
        if let Some(kind) = block
            .parameter("TYPE")
            .filter(|kind| !kind.text.eq_ignore_ascii_case("DISPLACEMENT"))
        {
            let finding = ImportFinding::new(kind.at, "*BOUNDARY: TYPE", "must be DISPLACEMENT");
            findings.error(finding.with_found(&kind.text));
            return;
        }
        for line in block.data.iter().filter(|line| !is_thermal(line)) {
            let Some(target) = field(block, line, 0, "node or set", findings) else {
                continue;
            };
            let Some(word) = field(block, line, 1, "degree of freedom", findings) else {
                continue;
            };
            let fix = match word.text.to_uppercase().as_str() {
                "ENCASTRE" => Some([true; 6]),
                "PINNED" => Some([true, true, true, false, false, false]),
                "XSYMM" => Some([true, false, false, false, true, true]),
                "YSYMM" => Some([false, true, false, true, false, true]),
                "ZSYMM" => Some([false, false, true, true, true, false]),
                "XASYMM" => Some([false, true, true, true, false, false]),
                "YASYMM" => Some([true, false, true, false, true, false]),
                "ZASYMM" => Some([true, true, false, false, false, true]),
                _ => restrained(block, line, omit, findings),
            };
            if let Some(fix) = fix {
                self.boundaries.push(InpBoundary {
                    target: target.clone(),
                    fix,
                });
            }
        }
    }

    pub(super) fn read_rigid_body(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        let Some(leader) = block.required("REFNODE", findings).cloned() else {
            return;
        };
        let sets = [("TIENSET", Joint::Rigid), ("PINNSET", Joint::Pinned)];
        let found: Vec<JointRequest> = sets
            .into_iter()
            .filter_map(|(name, joint)| Some((block.parameter(name)?, joint)))
            .map(|(set, joint)| JointRequest {
                joint,
                followers: set.clone(),
                leader: leader.clone(),
            })
            .collect();
        if found.is_empty() || block.parameter("ELSET").is_some() {
            let expected = "must specify its nodes by TIE NSET or PIN NSET only";
            findings.error(ImportFinding::new(block.at, block.label(), expected));
        }
        self.joints.extend(found);
    }

    pub(super) fn read_mpc(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        for line in &block.data {
            let Some(word) = field(block, line, 0, "type", findings) else {
                continue;
            };
            let joint = match word.text.to_uppercase().as_str() {
                "BEAM" => Joint::Rigid,
                "PIN" => Joint::Pinned,
                "TIE" => Joint::Tied,
                other => {
                    let finding =
                        ImportFinding::new(word.at, "*MPC: type", "must be BEAM, TIE or PIN");
                    findings.error(finding.with_found(other));
                    continue;
                }
            };
            let followers = field(block, line, 1, "first node", findings).cloned();
            let leader = field(block, line, 2, "second node", findings).cloned();
            if line.len() > 3 {
                findings.error(ImportFinding::new(
                    line[3].at,
                    "*MPC",
                    "must have two nodes or sets",
                ));
            }
            if let (Some(followers), Some(leader)) = (followers, leader) {
                self.joints.push(JointRequest {
                    joint,
                    followers,
                    leader,
                });
            }
        }
    }

    pub(super) fn read_release(&mut self, block: &KeywordBlock, findings: &mut ImportFindings) {
        for line in &block.data {
            let Some(target) = field(block, line, 0, "element or set", findings) else {
                continue;
            };
            let Some(end) = field(block, line, 1, "end", findings) else {
                continue;
            };
            let end = match end.text.to_uppercase().as_str() {
                "S1" => 0,
                "S2" => 1,
                other => {
                    let finding = ImportFinding::new(end.at, "*RELEASE: end", "must be S1 or S2");
                    findings.error(finding.with_found(other));
                    continue;
                }
            };
            let Some(words) = field(block, line, 2, "rotations", findings) else {
                continue;
            };
            let mut release = [false; 6];
            for word in words.text.to_uppercase().split('-') {
                match word {
                    "M1" => release[4] = true,
                    "M2" => release[5] = true,
                    "T" => release[3] = true,
                    "ALLM" => release[3..].fill(true),
                    other => {
                        let expected = "must be ALLM, or M1, M2 and T joined by hyphens";
                        let finding = ImportFinding::new(words.at, "*RELEASE: rotations", expected);
                        findings.error(finding.with_found(other));
                    }
                }
            }
            self.releases.push(ReleaseRequest {
                target: target.clone(),
                end,
                release,
            });
        }
    }
}

/// Reads the first and last degree of freedom and the displacement of a boundary condition, which must be 0. If what
/// cannot change the stiffness is left out, a support with another displacement is kept at rest.
fn restrained(
    block: &KeywordBlock,
    line: &[InpField],
    omit: Omissions<'_>,
    findings: &mut ImportFindings,
) -> Option<[bool; 6]> {
    let first = whole(block, line, 1, "degree of freedom", findings)?;
    let is_given = line.get(2).is_some_and(|field| !field.text.is_empty());
    let last = if is_given {
        whole(block, line, 2, "last degree of freedom", findings)?
    } else {
        first
    };
    let displacement = real(block, line, 3, ("displacement", Some(0.0)), findings)?;
    if displacement != 0.0 {
        let finding = ImportFinding::new(line[0].at, "*BOUNDARY: displacement", "must be 0");
        if !omit.unused {
            let hint = "prescribed displacements are not supported; --skip-unused takes them as 0";
            findings.error(finding.with_found(displacement).hint(hint));
            return None;
        }
        let message = "is ignored: the displacement of the support is taken as 0";
        findings.warn(
            ImportFinding::new(line[0].at, "*BOUNDARY: displacement", message)
                .with_found(displacement),
        );
    }
    if first > last || last > 6 {
        let expected = "must be degrees of freedom from 1 to 6";
        findings.error(ImportFinding::new(line[0].at, "*BOUNDARY", expected));
        return None;
    }
    Some([1, 2, 3, 4, 5, 6].map(|dof| (first..=last).contains(&dof)))
}
