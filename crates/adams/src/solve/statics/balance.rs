//! The equations of static equilibrium.

use super::iterate::{RotationMeasure, Unknown};
use super::motion::prescribed;
use crate::expression::functions::{Function, UnaryFunction, atan2};
use crate::kinematics::Frame;
use crate::kinematics::vector::{Vector, add, column, cross, dot, scale, subtract, vector};
use crate::model::{AdamsModel, Block, Constraint, Equation, Evaluation, Owner};
use crate::{Error, Scalar};
use nalgebra::{Matrix3, Vector3};

/// The force on every part, and the torque about its origin, in ground axes.
type Wrenches<T> = Vec<[Vector<T>; 2]>;

/// The residuals, one for each unknown: the force along a translation, the torque about a rotation, the error
/// of a torn slot, DIF1 of a DIF, and the gap of the equation that a reaction enforces.
///
/// With small rotations, lever arms are those without rotation. The values of torn slots are in `on`. All other slots and the reactions are computed here and stored in
/// `on`.
pub(super) fn balance<T: Scalar>(
    model: &AdamsModel,
    parts: &[Frame<T>],
    on: &mut Evaluation<'_, T>,
    unknowns: &[Unknown],
    multipliers: &[Vec<T>],
    measure: RotationMeasure,
) -> Result<Vec<T>, Error> {
    let turned: Vec<Turned> = match measure {
        RotationMeasure::Finite => vec![None; parts.len()],
        RotationMeasure::Small => parts.iter().map(back).collect(),
    };
    let errors = slots(model, on)?;
    let mut gaps = Vec::with_capacity(model.constraints.len());
    let mut wrenches: Wrenches<T> = vec![[vector([0.0; 3]), vector([0.0; 3])]; model.parts.len()];
    for (k, constraint) in model.constraints.iter().enumerate() {
        let value = prescribed(constraint, on)?;
        let of = |marker: usize| turned[model.markers[marker].part].as_ref();
        let (gap, wrench) = constrain(
            constraint,
            on,
            &value,
            &multipliers[k],
            [of(constraint.i), of(constraint.j)],
        );
        apply(
            model,
            &mut wrenches,
            (parts, &turned),
            on,
            [constraint.i, constraint.j],
            &wrench,
            false,
        );
        on.reactions[k] = Some(wrench);
        gaps.push(gap);
    }
    for load in &model.loads {
        let wrench = load.wrench(&on.at);
        apply(
            model,
            &mut wrenches,
            (parts, &turned),
            on,
            [load.i, load.j],
            &wrench,
            load.action_only(),
        );
    }
    let gravity = vector(model.gravity);
    for (k, part) in model.parts.iter().enumerate() {
        let weight = scale(&gravity, &T::constant(part.mass));
        let place = part
            .cm
            .map_or(&parts[k].origin, |cm| &on.at.frames[cm].origin);
        add_wrench(
            &mut wrenches[k],
            (&parts[k], turned[k].as_ref()),
            place,
            &[weight, vector([0.0; 3])],
            1.0,
        );
    }
    unknowns
        .iter()
        .map(|unknown| {
            Ok(match *unknown {
                Unknown::Translation(part, axis) => wrenches[part][0][axis].clone(),
                Unknown::Rotation(part, axis) => wrenches[part][1][axis].clone(),
                Unknown::Slot(slot) => errors[slot].clone().unwrap_or(T::constant(0.0)),
                Unknown::Differential(diff) => model.slot_value(model.diffs[diff].slot, on)?,
                Unknown::Reaction(constraint, equation) => gaps[constraint][equation].clone(),
            })
        })
        .collect()
}

/// Computes all slots from the torn ones, and returns the errors of the torn ones. DIF1 is zero.
fn slots<T: Scalar>(
    model: &AdamsModel,
    on: &mut Evaluation<'_, T>,
) -> Result<Vec<Option<T>>, Error> {
    let mut errors = vec![None; model.slots.len()];
    let rate = |slot: usize| matches!(model.slots[slot].owner, Owner::Rate(_));
    for block in &model.order {
        let (torn, rest): (&[usize], &[usize]) = match block {
            Block::Direct(slot) => (&[], std::slice::from_ref(slot)),
            Block::Loop { torn, rest } => (torn, rest),
        };
        for slot in torn.iter().chain(rest).copied().filter(|slot| rate(*slot)) {
            on.at.values[slot] = T::constant(0.0);
        }
        for slot in rest.iter().copied().filter(|slot| !rate(*slot)) {
            let value = model.slot_value(slot, on)?;
            on.at.values[slot] = value;
        }
        for slot in torn.iter().copied().filter(|slot| !rate(*slot)) {
            let value = model.slot_value(slot, on)?;
            errors[slot] = Some(on.at.values[slot].minus(&value));
        }
    }
    Ok(errors)
}

/// The inverse of the axes of a part, which takes lever arms back to the part without rotation; `None` with finite
/// rotations, where arms are what they are.
type Turned = Option<Matrix3<f64>>;

/// The inverse of the axes of a part.
fn back<T: Scalar>(part: &Frame<T>) -> Turned {
    Matrix3::from_fn(|i, j| part.axes[i][j].value()).try_inverse()
}

/// Adds a force and torque at a point, times a sign, to those on a part.
fn add_wrench<T: Scalar>(
    total: &mut [Vector<T>; 2],
    (part, turned): (&Frame<T>, Option<&Matrix3<f64>>),
    place: &Vector<T>,
    wrench: &[Vector<T>; 2],
    sign: f64,
) {
    let sign = T::constant(sign);
    let (force, torque) = (scale(&wrench[0], &sign), scale(&wrench[1], &sign));
    let arm = subtract(place, &part.origin);
    let arm = match turned {
        None => arm,
        // The arm of a point of the part does not depend on the unknowns.
        Some(back) => vector((back * Vector3::from_fn(|row, _| arm[row].value())).into()),
    };
    total[1] = add(&total[1], &add(&torque, &cross(&arm, &force)));
    total[0] = add(&total[0], &force);
}

/// Adds a force and torque at I to the part of I, and the opposite to the part of J unless the load acts on I
/// only.
fn apply<T: Scalar>(
    model: &AdamsModel,
    wrenches: &mut Wrenches<T>,
    (parts, turned): (&[Frame<T>], &[Turned]),
    on: &Evaluation<'_, T>,
    [i, j]: [usize; 2],
    wrench: &[Vector<T>; 2],
    action_only: bool,
) {
    let place = &on.at.frames[i].origin;
    let (a, b) = (model.markers[i].part, model.markers[j].part);
    let on_part = |k: usize| (&parts[k], turned[k].as_ref());
    add_wrench(&mut wrenches[a], on_part(a), place, wrench, 1.0);
    if !action_only {
        add_wrench(&mut wrenches[b], on_part(b), place, wrench, -1.0);
    }
}

/// An axis of a marker as it is without rotation of its part.
fn unturned<T: Scalar>(axis: &Vector<T>, turned: Option<&Matrix3<f64>>) -> Vector<T> {
    match turned {
        None => axis.clone(),
        Some(back) => vector((back * Vector3::from_fn(|row, _| axis[row].value())).into()),
    }
}

/// The gaps of the equations of a constraint, and the force and torque on I that its multipliers make. `turned` has
/// the inverse axes of the parts of I and J with small rotations.
fn constrain<T: Scalar>(
    constraint: &Constraint,
    on: &Evaluation<'_, T>,
    prescribed: &T,
    multipliers: &[T],
    turned: [Option<&Matrix3<f64>>; 2],
) -> (Vec<T>, [Vector<T>; 2]) {
    let (i, j) = (&on.at.frames[constraint.i], &on.at.frames[constraint.j]);
    let distance = subtract(&i.origin, &j.origin);
    let [mut force, mut torque] = [vector([0.0; 3]), vector([0.0; 3])];
    let mut gaps = Vec::with_capacity(multipliers.len());
    for (equation, multiplier) in constraint.equations.iter().zip(multipliers) {
        match *equation {
            Equation::Along(axis) => {
                let axis = column(&j.axes, axis);
                gaps.push(dot(&axis, &distance).minus(prescribed));
                force = add(&force, &scale(&axis, multiplier));
            }
            Equation::Normal(a, b) => {
                let (a, b) = (column(&i.axes, a), column(&j.axes, b));
                let (of_a, of_b) = (unturned(&a, turned[0]), unturned(&b, turned[1]));
                // To first order in small rotations; with finite ones this is the product of a and b.
                let turns = dot(&a, &of_b).minus(&dot(&of_a, &of_b));
                gaps.push(turns.plus(&dot(&of_a, &b)));
                let normal = cross(&of_a, &of_b);
                torque = add(&torque, &scale(&normal, multiplier));
            }
            Equation::About => {
                let x = column(&i.axes, 0);
                let (sin, cos) = (dot(&x, &column(&j.axes, 1)), dot(&x, &column(&j.axes, 0)));
                gaps.push(angle_difference(&sin, &cos, prescribed));
                torque = add(&torque, &scale(&column(&j.axes, 2), multiplier));
            }
        }
    }
    (gaps, [force, torque])
}

/// The difference between an angle, given by its sine and cosine, and another angle, from -pi to pi.
fn angle_difference<T: Scalar>(sin: &T, cos: &T, other: &T) -> T {
    let one = |unary: UnaryFunction| {
        Function::Unary(unary)
            .value(std::slice::from_ref(other))
            .unwrap_or(T::constant(0.0))
    };
    let (s, c) = (one(UnaryFunction::Sin), one(UnaryFunction::Cos));
    atan2(
        &sin.times(&c).minus(&cos.times(&s)),
        &cos.times(&c).plus(&sin.times(&s)),
    )
}
