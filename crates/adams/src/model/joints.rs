//! JOINT, JPRIM and MOTION statements to equations.

use super::Constraint;
use super::build::{Build, Pending, Target, missing};
use super::constraint::{self, Drive, Equation};
use super::fields::Fields;
use crate::code::Code;
use crate::{Error, Fault};

impl Build<'_> {
    pub(super) fn constraints(&mut self) -> Result<(), Error> {
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
        const PRIMITIVES: &[&str] =
            &["ATPOINT", "INLINE", "INPLANE", "ORIENTATION", "PARALLEL_AXES", "PERPENDICULAR"];
        for (keyword, kinds) in [("JOINT", JOINTS), ("JPRIM", PRIMITIVES)] {
            for fields in self.each(keyword) {
                let kind = fields.one_of(kinds)?.ok_or_else(|| fields.fault(Fault::Type))?;
                let (i, j) = (self.needed(&fields, "I")?, self.needed(&fields, "J")?);
                let equations = constraint::equations(kind);
                if equations.is_empty() {
                    return Err(fields.fault(Fault::Unsupported));
                }
                self.constrain(keyword, &fields, [i, j], equations, None)?;
            }
        }
        for fields in self.each("MOTION") {
            let (markers, equation) = self.motion(&fields)?;
            let level = fields.one_of(&["DISPLACEMENT", "VELOCITY", "ACCELERATION"])?;
            let start = match level {
                Some("VELOCITY") => Some(fields.number("ICDISP")?.unwrap_or(0.0)),
                Some("ACCELERATION") => return Err(fields.fault(Fault::Unsupported)),
                _ => None,
            };
            let drive = Drive { code: Code::Number(0.0), start };
            let index = self.constrain("MOTION", &fields, markers, vec![equation], Some(drive))?;
            let target = Target::Drive(index);
            self.pending.push(Pending { statement: fields.statement, argument: "FUNCTION", target });
        }
        Ok(())
    }

    fn constrain(
        &mut self,
        keyword: &'static str,
        fields: &Fields<'_>,
        [i, j]: [usize; 2],
        equations: Vec<Equation>,
        drive: Option<Drive>,
    ) -> Result<usize, Error> {
        let (id, index) = (fields.id()?, self.model.constraints.len());
        if self.model.markers[i].floating || self.model.markers[j].floating {
            return Err(fields.fault(Fault::Floating));
        }
        self.symbols.constraints.insert((keyword, id), index);
        self.model.constraints.push(Constraint { keyword, id, i, j, equations, drive });
        Ok(index)
    }

    /// Markers and equation of a motion: of a joint, or between two markers.
    fn motion(&self, fields: &Fields<'_>) -> Result<([usize; 2], Equation), Error> {
        if let Some(joint) = fields.reference("JOINT")? {
            let found = self.symbols.constraints.get(&("JOINT", joint));
            let index = *found.ok_or_else(|| missing(fields, "JOINT", joint))?;
            let joint = &self.model.constraints[index];
            let turns = !joint.equations.contains(&Equation::Normal(0, 1));
            let slides = !joint.equations.contains(&Equation::Along(2));
            let kind = match fields.one_of(&["ROTATIONAL", "TRANSLATIONAL"])? {
                Some("ROTATIONAL") if turns => Equation::About,
                Some("TRANSLATIONAL") if slides => Equation::Along(2),
                None if turns != slides => {
                    if turns {
                        Equation::About
                    } else {
                        Equation::Along(2)
                    }
                }
                _ => return Err(fields.fault(Fault::Type)),
            };
            return Ok(([joint.i, joint.j], kind));
        }
        let markers = [self.needed(fields, "I")?, self.needed(fields, "J")?];
        let equation = match fields.one_of(&["X", "Y", "Z", "B1", "B2", "B3"])? {
            Some("X") => Equation::Along(0),
            Some("Y") => Equation::Along(1),
            Some("Z") => Equation::Along(2),
            Some(_) => return Err(fields.fault(Fault::Unsupported)),
            None => return Err(fields.fault(Fault::Type)),
        };
        Ok((markers, equation))
    }
}
