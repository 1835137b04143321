//! Checks of a scene: validity of indices and ranges of numbers.
//!
//! This module contains all checks of a scene, because the types that it checks, such as a rope or a rule, do not
//! have access to the scene.

use super::actuators::{Actuators, Brake, Drive, PrescribedSpin};
use super::body::{Body, parents_first};
use super::dof::BodyDof;
use super::error::Error;
use super::foundation::Foundation;
use super::model::Scene;
use super::rope::{Rope, Stop};
use super::rule::{Action, Rule};
use super::wheel::Wheel;

impl Scene {
    /// Checks the indices and numbers of the scene for a run with `structures` structures.
    ///
    /// # Errors
    /// The first index that does not exist, or the first number that is out of range.
    pub fn check(&self, structures: usize) -> Result<(), Error> {
        positive("end time", self.end)?;
        positive("output interval", self.output_dt)?;
        positive("accuracy", self.accuracy)?;
        for body in &self.bodies {
            positive("mass", body.mass)?;
        }
        check_pins(&self.bodies)?;
        self.wheels.iter().try_for_each(check_wheel)?;
        for gauge in &self.gauges {
            if gauge.structure >= structures {
                return Err(Error::NoSuch {
                    what: "structure",
                    index: gauge.structure,
                });
            }
        }
        for contact in &self.contacts {
            for (what, index, count) in [
                ("body", contact.body, self.bodies.len()),
                ("structure", contact.structure, structures),
                ("wheel", contact.wheel, self.wheels.len()),
            ] {
                if index >= count {
                    return Err(Error::NoSuch { what, index });
                }
            }
            number(
                "wheels of a contact",
                "at least one",
                0.0,
                !contact.offsets.is_empty(),
            )?;
        }
        check_actuators(&self.actuators, self)
    }
}

/// Checks the bodies that carry structures, and the masses of these structures.
///
/// # Errors
/// A body that does not exist, or a mass that is not finite or has a negative diagonal entry.
pub(crate) fn check_carriers(scene: &Scene, foundations: &[Foundation]) -> Result<(), Error> {
    for foundation in foundations {
        let Some(mount) = &foundation.carrier else {
            continue;
        };
        if ![0, foundation.dofs()].contains(&mount.coupling.len()) {
            return Err(Error::NoSuch {
                what: "freedom of a structure",
                index: mount.coupling.len(),
            });
        }
        exists(scene, mount.body)?;
        if let Some(found) = mount
            .coupling
            .as_flattened()
            .iter()
            .copied()
            .find(|b| !b.is_finite())
        {
            return Err(Error::Number {
                what: "momentum of a structure",
                wanted: "finite",
                found,
            });
        }
        for (i, line) in mount.mass.iter().enumerate() {
            if let Some(found) = line
                .iter()
                .copied()
                .find(|m| !m.is_finite() || line[i] < 0.0)
            {
                return Err(Error::Number {
                    what: "mass of a structure",
                    wanted: "not negative",
                    found,
                });
            }
        }
    }
    Ok(())
}

/// Checks that every pin is on an existing body, that the pins form no cycle, and that a pinned body has no
/// translation of its own.
fn check_pins(bodies: &[Body]) -> Result<(), Error> {
    for (b, body) in bodies.iter().enumerate() {
        let Some(pin) = &body.pinned else { continue };
        if pin.body >= bodies.len() {
            return Err(Error::NoSuch {
                what: "body",
                index: pin.body,
            });
        }
        if body.motion.is_some() || body.free[..=BodyDof::Z as usize].contains(&true) {
            return Err(Error::Pinned { body: b });
        }
    }
    parents_first(bodies).map(|_| ())
}

fn check_wheel(wheel: &Wheel) -> Result<(), Error> {
    positive("wheel radius", wheel.radius)?;
    positive("wheel stiffness", wheel.normal.stiffness)?;
    let exponent = wheel.normal.exponent;
    number(
        "contact exponent",
        "at least 1",
        exponent,
        exponent >= 1.0 || exponent.is_nan(),
    )?;
    wheel
        .spin_inertia
        .map_or(Ok(()), |inertia| positive("spin inertia", inertia))
}

fn check_actuators(actuators: &Actuators, scene: &Scene) -> Result<(), Error> {
    actuators
        .ropes
        .iter()
        .try_for_each(|rope| check_rope(rope, scene))?;
    actuators
        .stops
        .iter()
        .try_for_each(|stop| check_stop(stop, scene))?;
    check_turns(&actuators.spins, scene)?;
    for &index in &actuators.hanging {
        let has_wheels = scene.contacts.iter().any(|contact| contact.body == index);
        if index >= scene.bodies.len() || has_wheels {
            return Err(Error::NoSuch {
                what: "body without wheels",
                index,
            });
        }
    }
    actuators
        .rules
        .iter()
        .try_for_each(|rule| check_rule(rule, scene))?;
    for load in &actuators.loads {
        is_free(scene, load.body, load.dof)?;
    }
    for (index, drive) in actuators.drives.iter().enumerate() {
        let is_second = actuators.drives[..index]
            .iter()
            .any(|earlier| earlier.body == drive.body);
        check_drive(drive, is_second, scene)?;
    }
    actuators
        .brakes
        .iter()
        .try_for_each(|brake| check_brake(brake, scene))
}

fn check_drive(drive: &Drive, is_second: bool, scene: &Scene) -> Result<(), Error> {
    is_free(scene, drive.body, BodyDof::X)?;
    number("drives of a body", "at most one", 2.0, !is_second)?;
    positive("gain of a drive", drive.gain)?;
    number(
        "largest force of a drive",
        "zero or above",
        drive.max_force,
        drive.max_force >= 0.0,
    )?;
    number(
        "end of a drive",
        "a time",
        drive.until,
        !drive.until.is_nan(),
    )?;
    drive
        .contacts
        .iter()
        .try_for_each(|&contact| has_contact(scene, drive.body, contact))
}

fn check_brake(brake: &Brake, scene: &Scene) -> Result<(), Error> {
    is_free(scene, brake.body, BodyDof::X)?;
    positive("speed of a brake", brake.speed)?;
    number(
        "start of a brake",
        "a time",
        brake.from,
        !brake.from.is_nan(),
    )?;
    for &contact in &brake.contacts {
        has_contact(scene, brake.body, contact)?;
        if scene.wheels[scene.contacts[contact].wheel]
            .friction
            .is_none()
        {
            return Err(Error::NoSuch {
                what: "friction of braked contact",
                index: contact,
            });
        }
    }
    Ok(())
}

fn check_turns(turns: &[PrescribedSpin], scene: &Scene) -> Result<(), Error> {
    for (index, turn) in turns.iter().enumerate() {
        let none = Error::NoSuch {
            what: "contact of a prescribed spin",
            index: turn.contact,
        };
        let contact = scene.contacts.get(turn.contact).ok_or(none)?;
        if turn.wheel >= contact.offsets.len() {
            return Err(Error::NoSuch {
                what: "wheel of a prescribed spin",
                index: turn.wheel,
            });
        }
        if scene
            .wheels
            .get(contact.wheel)
            .is_none_or(|kind| kind.friction.is_none())
        {
            return Err(Error::NoSuch {
                what: "friction of the contact that turns",
                index: turn.contact,
            });
        }
        let same =
            |other: &PrescribedSpin| (other.contact, other.wheel) == (turn.contact, turn.wheel);
        let is_second = turns[..index].iter().any(same);
        number(
            "prescribed spins of a wheel",
            "at most one",
            2.0,
            !is_second,
        )?;
    }
    Ok(())
}

fn check_rope(rope: &Rope, scene: &Scene) -> Result<(), Error> {
    for body in [rope.from.body, rope.to.body].into_iter().flatten() {
        exists(scene, body)?;
    }
    finite(
        "EA of a rope",
        "positive",
        rope.stiffness,
        rope.stiffness > 0.0,
    )?;
    finite(
        "damping of a rope",
        "zero or above",
        rope.damping,
        rope.damping >= 0.0,
    )?;
    finite(
        "length of a rope",
        "positive",
        rope.length,
        rope.length > 0.0,
    )?;
    let turns = rope.speed.turns().chain(rope.breaks()).chain([scene.end]);
    let shortest = turns
        .filter(|t| (0.0..=scene.end).contains(t))
        .map(|t| rope.length - rope.speed.integral(t))
        .fold(rope.length, f64::min);
    finite(
        "length of a rope that is hoisted",
        "positive until the end",
        shortest,
        shortest > 0.0,
    )
}

fn check_stop(stop: &Stop, scene: &Scene) -> Result<(), Error> {
    exists(scene, stop.body)?;
    stop.against
        .map_or(Ok(()), |bearer| exists(scene, bearer))?;
    finite(
        "stiffness of a stop",
        "positive",
        stop.stiffness,
        stop.stiffness > 0.0,
    )?;
    finite(
        "damping of a stop",
        "zero or above",
        stop.damping,
        stop.damping >= 0.0,
    )?;
    finite(
        "side of a stop",
        "1 or -1",
        stop.side,
        stop.side.abs() == 1.0,
    )?;
    finite(
        "axis of a stop",
        "0, 1 or 2",
        stop.axis as f64,
        stop.axis < 3,
    )
}

/// Checks the numbers of the condition and the existence of the actuators that the actions switch.
fn check_rule(rule: &Rule, scene: &Scene) -> Result<(), Error> {
    let actuators = &scene.actuators;
    let speeds = rule.actions.iter().filter_map(|action| match *action {
        Action::Drive { speed, .. } => speed,
        Action::Hoist { speed, .. } => Some(speed),
        _ => None,
    });
    let numbers = rule
        .when
        .terms
        .iter()
        .map(|(_, factor)| *factor)
        .chain([rule.when.level]);
    if let Some(found) = numbers.chain(speeds).find(|number| !number.is_finite()) {
        return Err(Error::Number {
            what: "number of a rule",
            wanted: "finite",
            found,
        });
    }
    let missing = |what, index| Err(Error::NoSuch { what, index });
    for action in &rule.actions {
        match *action {
            Action::Brake { body, .. }
                if actuators.brakes.iter().all(|brake| brake.body != body) =>
            {
                return missing("brake of body", body);
            }
            Action::Drive { body, .. }
                if actuators.drives.iter().all(|drive| drive.body != body) =>
            {
                return missing("drive of body", body);
            }
            Action::Hoist { rope, .. } | Action::Release { rope }
                if rope >= actuators.ropes.len() =>
            {
                return missing("rope", rope);
            }
            _ => {}
        }
    }
    Ok(())
}

fn number(what: &'static str, wanted: &'static str, found: f64, holds: bool) -> Result<(), Error> {
    if holds {
        Ok(())
    } else {
        Err(Error::Number {
            what,
            wanted,
            found,
        })
    }
}

fn finite(what: &'static str, wanted: &'static str, found: f64, holds: bool) -> Result<(), Error> {
    number(what, wanted, found, holds && found.is_finite())
}

fn positive(what: &'static str, found: f64) -> Result<(), Error> {
    finite(what, "positive", found, found > 0.0)
}

fn exists(scene: &Scene, index: usize) -> Result<(), Error> {
    if index < scene.bodies.len() {
        Ok(())
    } else {
        Err(Error::NoSuch {
            what: "body",
            index,
        })
    }
}

fn is_free(scene: &Scene, body: usize, freedom: BodyDof) -> Result<(), Error> {
    let owner = scene.bodies.get(body).ok_or(Error::NoSuch {
        what: "body",
        index: body,
    })?;
    let is_free = owner.free[freedom as usize] && (freedom != BodyDof::X || owner.motion.is_none());
    if is_free {
        Ok(())
    } else {
        Err(Error::NotFree { body, dof: freedom })
    }
}

/// Checks that contact `index` belongs to `body` and that its wheels have no spin of their own, free or prescribed.
fn has_contact(scene: &Scene, body: usize, index: usize) -> Result<(), Error> {
    let contact = scene.contacts.get(index).ok_or(Error::NoSuch {
        what: "contact",
        index,
    })?;
    if contact.body != body {
        return Err(Error::NoSuch {
            what: "wheel of the body on contact",
            index,
        });
    }
    let kind = scene.wheels.get(contact.wheel).ok_or(Error::NoSuch {
        what: "wheel",
        index: contact.wheel,
    })?;
    let turns = scene
        .actuators
        .spins
        .iter()
        .any(|turn| turn.contact == index);
    if turns || kind.spin_inertia.is_some() && kind.friction.is_some() {
        return Err(Error::Spins { contact: index });
    }
    Ok(())
}
