//! SFORCE, VFORCE, GFORCE and BEAM statements to loads.

use super::build::Build;
use super::fields::Fields;
use super::load::{Kind, Law, Load};
use super::{Beam, Owner};
use crate::{Error, Fault};

impl<'a> Build<'a> {
    pub(super) fn loads(&mut self) -> Result<(), Error> {
        for kind in [Kind::Sforce, Kind::Vforce, Kind::Gforce, Kind::Beam] {
            for fields in self.each(kind.keyword()) {
                let index = self.model.loads.len();
                let id = fields.id()?;
                let i = self.needed(&fields, "I")?;
                let other = if matches!(kind, Kind::Vforce | Kind::Gforce) { "JFLOAT" } else { "J" };
                let j = self.needed(&fields, other)?;
                if self.model.markers[i].floating || (other == "J" && self.model.markers[j].floating) {
                    return Err(fields.fault(Fault::Floating));
                }
                let law = match kind {
                    Kind::Beam => Law::Beam(Box::new(Beam::read(&fields)?)),
                    Kind::Sforce => {
                        let slot = self.slot(&fields, "FUNCTION", Owner::Load(index, 0))?;
                        let alone = fields.flag("ACTIONONLY");
                        let twists = fields.one_of(&["TRANSLATIONAL", "ROTATIONAL"])? == Some("ROTATIONAL");
                        if twists { Law::Twist { slot, alone } } else { Law::Line { slot, alone } }
                    }
                    Kind::Vforce | Kind::Gforce => self.components(&fields, index, i, j)?,
                };
                self.symbols.loads.insert((kind, id), index);
                self.model.loads.push(Load { kind, id, i, j, law });
            }
        }
        Ok(())
    }

    fn components(&mut self, fields: &Fields<'a>, index: usize, i: usize, j: usize) -> Result<Law, Error> {
        let floating = &mut self.model.markers[j];
        if !floating.floating || floating.follows.replace(i).is_some() {
            return Err(fields.fault(Fault::Floating));
        }
        let rm = self.needed(fields, "RM")?;
        if self.model.markers[rm].floating {
            return Err(fields.fault(Fault::Floating));
        }
        let mut slots = [None; 6];
        for (k, name) in ["FX", "FY", "FZ", "TX", "TY", "TZ"].into_iter().enumerate() {
            if fields.flag(name) {
                slots[k] = Some(self.slot(fields, name, Owner::Load(index, k))?);
            }
        }
        if fields.flag("FUNCTION") {
            return Err(fields.fault(Fault::Unsupported));
        }
        if slots.iter().all(Option::is_none) {
            return Err(fields.lacks("FX"));
        }
        Ok(Law::Components { slots, rm })
    }
}
