//! PART and MARKER statements of ground, rails, bodies and spinning wheels.

use adams::Statement;

use crate::model::plan::{DeckPlan, GROUND};
use crate::model::start::{euler, rotated, rotation};
use crate::words::remark;
use crate::words::text::plain;
use formats::units::{Dimension, Force, Length, Scale, Units};

/// A pound (0.45359237 kg) and a kilogram in integer multiples of 1e-8 kg.
const POUND: u128 = 45_359_237;
const KILOGRAM: u128 = 100_000_000;

/// Mass of each spinning wheel as a fraction of the mass of its body.
const WHEEL_MASS: f64 = 1e-9;

/// All parts with their markers, and the revolute joints of spinning wheels.
pub(crate) fn statements(plan: &DeckPlan<'_>) -> Vec<Statement> {
    let mut out = ground(plan);
    for b in 0..plan.bodies.len() {
        body(plan, b, &mut out);
    }
    let mut written = false;
    for w in 0..plan.wheels.len() {
        wheel(plan, w, &mut written, &mut out);
    }
    out
}

fn marker(id: u32, part: u32, at: [f64; 3], name: &str) -> Statement {
    Statement::new("MARKER", id)
        .named(plain(name))
        .reference("PART", part)
        .numbers("QP", &at)
}

fn ground(plan: &DeckPlan<'_>) -> Vec<Statement> {
    let mut out = vec![
        Statement::new("PART", GROUND)
            .named("ground")
            .flag("GROUND"),
    ];
    for (d, datum) in plan.datums.iter().enumerate() {
        let [y, z] = datum.at;
        let name = &plan.scene.rails[datum.rail].name;
        let mut statement = marker(datum.marker, GROUND, [0.0, y, z], &format!("rail_{name}"));
        if d == 0 {
            statement = statement.remark(remark::FRAME);
        }
        out.push(statement);
    }
    for (plan_body, body) in plan.bodies.iter().zip(&plan.scene.bodies) {
        let [y, z] = plan_body.position;
        out.push(marker(
            plan_body.track,
            GROUND,
            [0.0, y, z],
            &format!("track_{}", body.name),
        ));
    }
    for wheel in &plan.wheels {
        let name = plain(&format!("float_{}", wheel.name));
        let statement = Statement::new("MARKER", wheel.float).named(name);
        out.push(statement.reference("PART", GROUND).flag("FLOATING"));
    }
    out
}

/// Position of the origin of body `b` and its rotation matrix at time 0.
fn place(plan: &DeckPlan<'_>, b: usize) -> ([f64; 3], [[f64; 3]; 3]) {
    let [x, y, z, roll, yaw, pitch] = plan.start.displacement[b];
    let [height, side] = plan.bodies[b].position;
    ([x, height + y, side + z], rotation([roll, yaw, pitch]))
}

fn placed(id: u32, name: &str, at: [f64; 3], turn: [[f64; 3]; 3]) -> Statement {
    let statement = Statement::new("PART", id)
        .named(plain(name))
        .numbers("QG", &at);
    let angles = euler(turn);
    if angles == [0.0; 3] {
        statement
    } else {
        statement.numbers("REULER", &angles)
    }
}

/// Adds the speed along the rail at time 0 to a PART statement.
fn moving(statement: Statement, speed: f64) -> Statement {
    if speed == 0.0 {
        statement
    } else {
        statement.numbers("VX", &[speed])
    }
}

fn body(plan: &DeckPlan<'_>, b: usize, out: &mut Vec<Statement>) {
    let (own, body) = (&plan.bodies[b], &plan.scene.bodies[b]);
    let (at, turn) = place(plan, b);
    let unit = mass_factor(plan.scene.units);
    let spinning = plan
        .wheels
        .iter()
        .filter(|wheel| wheel.body == b && wheel.spin.is_some())
        .count();
    let mass = body.mass * unit * (1.0 - WHEEL_MASS * spinning as f64);
    let statement = placed(own.part, &body.name, at, turn)
        .numbers("MASS", &[mass])
        .reference("CM", own.cm)
        .numbers("IP", &body.inertia.map(|inertia| inertia * unit));
    out.push(moving(statement, plan.start.speed[b]));
    out.push(marker(
        own.origin,
        own.part,
        [0.0; 3],
        &format!("{}_origin", body.name),
    ));
    out.push(marker(
        own.cm,
        own.part,
        body.cg,
        &format!("{}_cm", body.name),
    ));
    for (w, wheel) in plan
        .wheels
        .iter()
        .enumerate()
        .filter(|(_, wheel)| wheel.body == b)
    {
        out.push(marker(
            wheel.marker,
            own.part,
            wheel.hub,
            &format!("hub_{}", wheel.name),
        ));
        if let Some(tread) = wheel.tread {
            let [x, y, z] = wheel.hub;
            let at = [x, y - plan.kind(w).radius, z];
            out.push(marker(
                tread,
                own.part,
                at,
                &format!("tread_{}", wheel.name),
            ));
        }
    }
}

fn wheel(plan: &DeckPlan<'_>, w: usize, written: &mut bool, out: &mut Vec<Statement>) {
    let wheel = &plan.wheels[w];
    let Some((part, centre)) = wheel.spin else {
        return;
    };
    let unit = mass_factor(plan.scene.units);
    let (origin, turn) = place(plan, wheel.body);
    let arm = rotated(turn, wheel.hub);
    let at = std::array::from_fn(|i| origin[i] + arm[i]);
    let inertia = plan.kind(w).spin_inertia.unwrap_or_default() * unit;
    let mut statement = placed(part, &wheel.name, at, turn)
        .numbers(
            "MASS",
            &[plan.scene.bodies[wheel.body].mass * unit * WHEEL_MASS],
        )
        .reference("CM", centre)
        .numbers("IP", &[0.0, 0.0, inertia]);
    if !*written {
        *written = true;
        statement = statement.remark(remark::SPIN);
    }
    out.push(moving(statement, plan.start.speed[wheel.body]));
    out.push(marker(
        centre,
        part,
        [0.0; 3],
        &format!("centre_{}", wheel.name),
    ));
    out.push(
        Statement::new("JOINT", crate::words::ids::number(w))
            .named(plain(&format!("axle_{}", wheel.name)))
            .flag("REVOLUTE")
            .reference("I", centre)
            .reference("J", wheel.marker),
    );
}

/// The scene's unit of mass, force time^2 / length, in the mass unit of [`Units::to_adams`].
///
/// ADAMS computes F UCF = M a by the units of its UNITS statement. With masses in that unit F = m a holds in the
/// units of the scene: 1 lbf s^2/ft = 1 slug, 1 lbf s^2/in = 386.0886 lb, 1 N s^2/mm = 1000 kg. The relative error is
/// below 4e-16.
#[must_use]
pub(crate) fn mass_factor(units: Units) -> f64 {
    match units.to_adams().mass {
        adams::AdamsMassUnit::Slug => {
            let slugs = Units {
                length: Length::Foot,
                force: Force::Pound,
            };
            Scale {
                from: units,
                to: slugs,
            }
            .factor(Dimension::MASS)
        }
        adams::AdamsMassUnit::Pound => {
            let kilograms = Scale {
                from: units,
                to: Units::SI,
            }
            .factor(Dimension::MASS);
            kilograms * (KILOGRAM as f64) / (POUND as f64)
        }
        _ => Scale {
            from: units,
            to: Units::SI,
        }
        .factor(Dimension::MASS),
    }
}

#[cfg(test)]
mod tests {
    use super::mass_factor;
    use formats::units::{Force, Length, Units};

    #[test]
    fn mass_factors_follow_from_the_definitions_of_units() {
        // 1 lbf = 0.45359237 kg x 9.80665 m/s^2; 1 in = 0.0254 m
        for (length, force, expected) in [
            (Length::Foot, Force::Pound, 1.0),
            (Length::Foot, Force::Kip, 1000.0),
            (Length::Foot, Force::Newton, 1.0 / 4.448_221_615_260_5),
            (Length::Inch, Force::Pound, 9.80665 / 0.0254),
            (Length::Inch, Force::Kip, 9806.65 / 0.0254),
            (Length::Metre, Force::Newton, 1.0),
            (Length::Metre, Force::Kilonewton, 1e3),
            (Length::Millimetre, Force::Newton, 1e3),
            (Length::Millimetre, Force::Kilonewton, 1e6),
            (Length::Metre, Force::Pound, 4.448_221_615_260_5),
        ] {
            let found = mass_factor(Units { length, force });
            assert!(
                (found / expected - 1.0).abs() < 8e-16,
                "{length:?} {force:?}: {found} {expected}"
            );
        }
    }
}
