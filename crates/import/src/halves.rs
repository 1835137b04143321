//! Lines of three nodes: a straight one becomes two members that meet at its middle node.
//!
//! A uniform member that is divided at a point has the stiffness of the whole one, wherever the point is, because members
//! are exact beams.

use crate::structure::{ImportedMember, ImportedStructure};
use formats::text::fault::number;
use formats::vector::{dot, length, minus};

/// Largest distance of the middle node from the line between the ends, relative to its length, of a line that is straight.
/// The members go through the middle node, so that this is the error of no coordinate: it admits coordinates that were
/// rounded to few digits, and separates them from arcs.
const STRAIGHT: f64 = 1e-3;
/// Least distance of the middle node from either end, relative to the length.
const APART: f64 = 1e-3;

/// Checks that the middle node of a line is on the straight line between its ends and apart from both.
///
/// # Errors
/// It is not; the error consists of a message and a hint.
pub(crate) fn check_straight(ends: [[f64; 3]; 2], middle: [f64; 3]) -> Result<(), [String; 2]> {
    let [a, b] = ends;
    let along = minus(b, a);
    let whole = length(along);
    let own = minus(middle, a);
    let part = dot(own, along) / (whole * whole);
    let aside = length(minus(own, along.map(|component| component * part)));
    if !(APART..=1.0 - APART).contains(&part) {
        return Err([
            "must have its middle node between its ends".to_owned(),
            "check the order of its nodes".to_owned(),
        ]);
    }
    if !aside.is_finite() || aside > STRAIGHT * whole {
        return Err([
            format!(
                "must be straight, but its middle node is {} of its length off the line between its ends",
                number((1e4 * aside / whole).round() / 1e4)
            ),
            "divide curved members into short straight elements of two nodes".to_owned(),
        ]);
    }
    Ok(())
}

/// Adds a member as two that meet at the point `middle`. Each has the release of its own end.
pub(crate) fn push_halves(
    structure: &mut ImportedStructure,
    member: ImportedMember,
    middle: usize,
) {
    let [a, b] = member.points;
    let [at_a, at_b] = member.releases;
    let half = |points, releases| ImportedMember {
        points,
        releases,
        ..member.clone()
    };
    let halves = [
        half([a, middle], [at_a, [false; 6]]),
        half([middle, b], [[false; 6], at_b]),
    ];
    structure.members.extend(halves);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_nodes_are_on_the_line_between_the_ends() {
        let ends = [[1.0, 2.0, 0.0], [5.0, 2.0, 0.0]];
        for inside in [[3.0, 2.0, 0.0], [1.1, 2.0, 0.0], [4.0, 2.003, 0.0]] {
            assert_eq!(check_straight(ends, inside), Ok(()), "{inside:?}");
        }
        for outside in [
            [1.0, 2.0, 0.0],
            [5.0, 2.0, 0.0],
            [6.0, 2.0, 0.0],
            [3.0, 2.005, 0.0],
            [f64::NAN, 2.0, 0.0],
        ] {
            assert!(check_straight(ends, outside).is_err(), "{outside:?}");
        }
        assert!(check_straight([[0.0; 3]; 2], [0.0; 3]).is_err());
    }
}
