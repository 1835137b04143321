//! SFORCE, VFORCE, GFORCE and BEAM statements to loads.

use super::super::arguments::Arguments;
use super::super::beam::Beam;
use super::super::data::Owner;
use super::super::load::{AppliedForce, COMPONENTS, Law, LoadKind};
use super::context::Build;
use crate::{AdamsFault, Error};

/// Reads all loads.
pub(super) fn read(build: &mut Build<'_>) -> Result<(), Error> {
    for kind in [
        LoadKind::Sforce,
        LoadKind::Vforce,
        LoadKind::Gforce,
        LoadKind::Beam,
    ] {
        for arguments in build.each(kind.keyword()) {
            let index = build.model.loads.len();
            let id = arguments.id()?;
            let i = build.required_marker(&arguments, "I")?;
            let other = if matches!(kind, LoadKind::Vforce | LoadKind::Gforce) {
                "JFLOAT"
            } else {
                "J"
            };
            let j = build.required_marker(&arguments, other)?;
            if build.model.markers[i].floating || (other == "J" && build.model.markers[j].floating)
            {
                return Err(arguments.fault(AdamsFault::Floating));
            }
            let law = match kind {
                LoadKind::Beam => Law::Beam(Box::new(Beam::read(&arguments)?)),
                LoadKind::Sforce => {
                    let slot = build.slot(&arguments, "FUNCTION", Owner::Load(index, 0))?;
                    let action_only = arguments.flag("ACTIONONLY");
                    let torque =
                        arguments.one_of(&["TRANSLATIONAL", "ROTATIONAL"])? == Some("ROTATIONAL");
                    if torque {
                        Law::Torque { slot, action_only }
                    } else {
                        Law::Force { slot, action_only }
                    }
                }
                LoadKind::Vforce | LoadKind::Gforce => components(build, &arguments, index, i, j)?,
            };
            build.symbols.loads.insert((kind, id), index);
            build.model.loads.push(AppliedForce {
                kind,
                id,
                i,
                j,
                law,
            });
        }
    }
    Ok(())
}

/// The components of a VFORCE or GFORCE. Its JFLOAT must be a floating marker that no other load uses.
fn components<'a>(
    build: &mut Build<'a>,
    arguments: &Arguments<'a>,
    index: usize,
    i: usize,
    j: usize,
) -> Result<Law, Error> {
    let floating = &mut build.model.markers[j];
    if !floating.floating || floating.follows.replace(i).is_some() {
        return Err(arguments.fault(AdamsFault::Floating));
    }
    let rm = build.required_marker(arguments, "RM")?;
    if build.model.markers[rm].floating {
        return Err(arguments.fault(AdamsFault::Floating));
    }
    let mut slots = [None; 6];
    for (k, name) in COMPONENTS.into_iter().enumerate() {
        if arguments.flag(name) {
            slots[k] = Some(build.slot(arguments, name, Owner::Load(index, k))?);
        }
    }
    if arguments.flag("FUNCTION") {
        return Err(arguments.fault(AdamsFault::Unsupported));
    }
    if slots.iter().all(Option::is_none) {
        return Err(arguments.missing_argument("FX"));
    }
    Ok(Law::Components { slots, rm })
}
