//! Supports that the user adds to a model on the command line.

use std::str::FromStr;

use super::structure::ImportedStructure;

/// A request to restrain degrees of freedom of a set of points, parsed from `SET=ux,uy,uz`.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportRequest {
    set: String,
    fix: [bool; 6],
}

impl FromStr for SupportRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<SupportRequest, String> {
        let (set, list) = text
            .rsplit_once('=')
            .ok_or("must be SET=DOF,DOF,..., such as feet=ux,uy,uz")?;
        let mut fix = [false; 6];
        for word in list.split(',') {
            let index = ["ux", "uy", "uz", "rx", "ry", "rz"]
                .iter()
                .position(|known| *known == word.trim());
            let index =
                index.ok_or_else(|| format!("`{word}` must be one of ux, uy, uz, rx, ry, rz"))?;
            fix[index] = true;
        }
        Ok(SupportRequest {
            set: set.to_owned(),
            fix,
        })
    }
}

/// Restrains the points of a set.
///
/// # Errors
/// The structure does not have the set. The error consists of a message and a hint.
pub fn restrain(
    asked: &SupportRequest,
    structure: &mut ImportedStructure,
) -> Result<(), [String; 2]> {
    let Some((_, set)) = structure
        .point_sets
        .iter()
        .find(|(name, _)| *name == asked.set)
    else {
        let names: Vec<&str> = structure
            .point_sets
            .iter()
            .take(20)
            .map(|(name, _)| name.as_str())
            .collect();
        let hint = format!(
            "known point sets: {}",
            if names.is_empty() {
                "none".to_owned()
            } else {
                names.join(", ")
            }
        );
        return Err([
            format!("refers to the set {}, which does not exist", asked.set),
            hint,
        ]);
    };
    for point in set {
        let support = structure.supports.entry(*point).or_default();
        for (dof, fix) in asked.fix.iter().enumerate() {
            support[dof] |= fix;
        }
    }
    Ok(())
}
