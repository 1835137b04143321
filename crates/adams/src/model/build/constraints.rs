//! JOINT, JPRIM and MOTION statements to equations.

use super::super::arguments::Arguments;
use super::super::constraint::{self, Constraint, Equation, PrescribedMotion};
use super::super::formula::Formula;
use super::context::{Build, Pending, Target, missing};
use crate::{AdamsFault, Error};

/// The types of JOINT.
const JOINTS: &[&str] = &[
    "REVOLUTE",
    "TRANSLATIONAL",
    "FIXED",
    "PLANAR",
    "CYLINDRICAL",
    "SPHERICAL",
    "HOOKE",
    "UNIVERSAL",
    "CONVEL",
    "SCREW",
    "RACKPIN",
];

/// The types of JPRIM.
const PRIMITIVES: &[&str] = &[
    "ATPOINT",
    "INLINE",
    "INPLANE",
    "ORIENTATION",
    "PARALLEL_AXES",
    "PERPENDICULAR",
];

/// Reads all constraints.
pub(super) fn read(build: &mut Build<'_>) -> Result<(), Error> {
    for (keyword, kinds) in [("JOINT", JOINTS), ("JPRIM", PRIMITIVES)] {
        for arguments in build.each(keyword) {
            let kind = arguments
                .one_of(kinds)?
                .ok_or_else(|| arguments.fault(AdamsFault::Type))?;
            let (i, j) = (
                build.required_marker(&arguments, "I")?,
                build.required_marker(&arguments, "J")?,
            );
            let equations = constraint::equations(kind);
            if equations.is_empty() {
                return Err(arguments.fault(AdamsFault::Unsupported));
            }
            constrain(build, keyword, &arguments, [i, j], equations, None)?;
        }
    }
    for arguments in build.each("MOTION") {
        let (markers, equation) = motion(build, &arguments)?;
        let level = arguments.one_of(&["DISPLACEMENT", "VELOCITY", "ACCELERATION"])?;
        let start = match level {
            Some("VELOCITY") => Some(arguments.number("ICDISP")?.unwrap_or(0.0)),
            Some("ACCELERATION") => return Err(arguments.fault(AdamsFault::Unsupported)),
            _ => None,
        };
        let motion = PrescribedMotion {
            formula: Formula::Number(0.0),
            start,
        };
        let index = constrain(
            build,
            "MOTION",
            &arguments,
            markers,
            vec![equation],
            Some(motion),
        )?;
        let target = Target::Motion(index);
        build.pending.push(Pending {
            statement: arguments.statement,
            argument: "FUNCTION",
            target,
        });
    }
    Ok(())
}

/// Adds a constraint between two markers, and returns its index.
fn constrain(
    build: &mut Build<'_>,
    keyword: &'static str,
    arguments: &Arguments<'_>,
    [i, j]: [usize; 2],
    equations: Vec<Equation>,
    motion: Option<PrescribedMotion>,
) -> Result<usize, Error> {
    let (id, index) = (arguments.id()?, build.model.constraints.len());
    if build.model.markers[i].floating || build.model.markers[j].floating {
        return Err(arguments.fault(AdamsFault::Floating));
    }
    build.symbols.constraints.insert((keyword, id), index);
    build.model.constraints.push(Constraint {
        keyword,
        id,
        i,
        j,
        equations,
        motion,
    });
    Ok(index)
}

/// The markers and the equation of a MOTION, which acts on a joint or between two markers.
fn motion(build: &Build<'_>, arguments: &Arguments<'_>) -> Result<([usize; 2], Equation), Error> {
    if let Some(joint) = arguments.reference("JOINT")? {
        let found = build.symbols.constraints.get(&("JOINT", joint));
        let index = *found.ok_or_else(|| missing(arguments, "JOINT", joint))?;
        let joint = &build.model.constraints[index];
        let rotates = !joint.equations.contains(&Equation::Normal(0, 1));
        let slides = !joint.equations.contains(&Equation::Along(2));
        let kind = match arguments.one_of(&["ROTATIONAL", "TRANSLATIONAL"])? {
            Some("ROTATIONAL") if rotates => Equation::About,
            Some("TRANSLATIONAL") if slides => Equation::Along(2),
            None if rotates != slides => {
                if rotates {
                    Equation::About
                } else {
                    Equation::Along(2)
                }
            }
            _ => return Err(arguments.fault(AdamsFault::Type)),
        };
        return Ok(([joint.i, joint.j], kind));
    }
    let markers = [
        build.required_marker(arguments, "I")?,
        build.required_marker(arguments, "J")?,
    ];
    let equation = match arguments.one_of(&["X", "Y", "Z", "B1", "B2", "B3"])? {
        Some("X") => Equation::Along(0),
        Some("Y") => Equation::Along(1),
        Some("Z") => Equation::Along(2),
        Some(_) => return Err(arguments.fault(AdamsFault::Unsupported)),
        None => return Err(arguments.fault(AdamsFault::Type)),
    };
    Ok((markers, equation))
}
