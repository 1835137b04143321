//! Errors of the calculation as faults of the design's files, where a user can mend them.

use formats::design::Design;
use formats::spec::SolveError;
use formats::text::fault::{Basis, Fault, Faults};
use formats::text::inputs::{Input, Inputs};
use formats::text::place::{Path, Step};
use splines::Axis;

/// The error of a design for an error of the calculation: a fault with its place in the design or its spec where one
/// caused it, and no solution otherwise.
pub(crate) fn solve_error(error: &trains::Error, design: &Design, inputs: &Inputs) -> SolveError {
    let path = |steps: &[(&str, usize)]| {
        let each = steps
            .iter()
            .flat_map(|(key, index)| [Step::Key((*key).to_owned()), Step::Index(*index)]);
        Path(each.collect())
    };
    let fault = |path: Path, expected: String, hint: &str| Fault {
        path,
        at_key: false,
        expected,
        found: None,
        hint: Some(hint.to_owned()),
        basis: Basis::Several,
    };
    let fault = match error {
        trains::Error::NoRoom { case } => fault(
            path(&[("cases", *case)]),
            "its trains must fit on the rails together".to_owned(),
            "fewer trains, a smaller gap, or \"enters\": true",
        ),
        trains::Error::Ring { case } => fault(
            path(&[("cases", *case)]),
            "the order of its trains on shared rails is cyclic, which cannot be solved exactly"
                .to_owned(),
            "leave out a train that shares a rail with only some of the others",
        ),
        trains::Error::NoStiffness { train, wheel, axis } => fault(
            path(&[("trains", *train), ("wheels", *wheel)]),
            format!(
                "must have no {} force: the structure has no stiffness in this direction on this rail",
                word(*axis)
            ),
            "specify the stiffness in this direction: A, I_lateral, J in the short form",
        ),
        trains::Error::TooLong { train, .. } | trains::Error::Wheel { train, .. } => fault(
            path(&[("trains", *train)]),
            error.to_string(),
            "check its wheels and its rail",
        ),
        trains::Error::Frame(error) => {
            let source = inputs.find(&design.spec_file).map(Input::source);
            return match source {
                Some(Ok(source)) => design.spec.locate_error(&source, error),
                _ => SolveError::NoSolution(error.to_string()),
            };
        }
        trains::Error::Function(error) => return SolveError::NoSolution(error.to_string()),
    };
    match inputs.all().first().map(Input::source) {
        Some(Ok(source)) => SolveError::Input(source.diagnose(&Faults(vec![fault]))),
        _ => SolveError::NoSolution(error.to_string()),
    }
}

/// `longitudinal`, `vertical` or `lateral`.
const fn word(axis: Axis) -> &'static str {
    match axis {
        Axis::Longitudinal => "longitudinal",
        Axis::Vertical => "vertical",
        Axis::Lateral => "lateral",
    }
}
