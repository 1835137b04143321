//! What is off at a place.

use super::drive::held;
use super::place::Unknown;
use crate::code::View;
use crate::frame::Frame;
use crate::functions::{Function, Unary, atan2};
use crate::model::{Block, Constraint, Equation, Model, Owner};
use crate::space::{Vector, add, column, cross, dot, scale, subtract, vector};
use crate::{Error, Scalar};

/// Force and torque about the origin, on every part.
type Wrenches<T> = Vec<[Vector<T>; 2]>;

/// One number for each unknown, zero at equilibrium. Torn values are in the view; all other slots are found
/// here, and the reactions put into the view.
pub(super) fn balance<T: Scalar>(
    model: &Model,
    parts: &[Frame<T>],
    view: &mut View<'_, T>,
    unknowns: &[Unknown],
    multipliers: &[Vec<T>],
) -> Result<Vec<T>, Error> {
    let off = slots(model, view)?;
    let mut gaps = Vec::with_capacity(model.constraints.len());
    let mut on: Wrenches<T> = vec![[vector([0.0; 3]), vector([0.0; 3])]; model.parts.len()];
    for (k, constraint) in model.constraints.iter().enumerate() {
        let value = held(constraint, view)?;
        let (gap, wrench) = hold(constraint, view, &value, &multipliers[k]);
        apply(model, &mut on, parts, view, [constraint.i, constraint.j], &wrench, false);
        view.reactions[k] = Some(wrench);
        gaps.push(gap);
    }
    for load in &model.loads {
        let wrench = load.wrench(view);
        apply(model, &mut on, parts, view, [load.i, load.j], &wrench, load.alone());
    }
    let gravity = vector(model.gravity);
    for (k, part) in model.parts.iter().enumerate() {
        let weight = scale(&gravity, &T::constant(part.mass));
        let place = part.cm.map_or(&parts[k].origin, |cm| &view.frames[cm].origin);
        push(&mut on[k], &parts[k], place, &[weight, vector([0.0; 3])], 1.0);
    }
    unknowns
        .iter()
        .map(|unknown| {
            Ok(match *unknown {
                Unknown::Shift(part, axis) => on[part][0][axis].clone(),
                Unknown::Turn(part, axis) => on[part][1][axis].clone(),
                Unknown::Slot(slot) => off[slot].clone().unwrap_or(T::constant(0.0)),
                Unknown::Differential(diff) => model.slot_value(model.diffs[diff].slot, view)?,
                Unknown::Reaction(constraint, equation) => gaps[constraint][equation].clone(),
            })
        })
        .collect()
}

/// Finds all slots from the torn ones; what torn ones are off by. Rates are zero.
fn slots<T: Scalar>(model: &Model, view: &mut View<'_, T>) -> Result<Vec<Option<T>>, Error> {
    let mut off = vec![None; model.slots.len()];
    let rate = |slot: usize| matches!(model.slots[slot].owner, Owner::Rate(_));
    for block in &model.order {
        let (torn, rest): (&[usize], &[usize]) = match block {
            Block::Direct(slot) => (&[], std::slice::from_ref(slot)),
            Block::Loop { torn, rest } => (torn, rest),
        };
        for slot in torn.iter().chain(rest).copied().filter(|slot| rate(*slot)) {
            view.values[slot] = T::constant(0.0);
        }
        for slot in rest.iter().copied().filter(|slot| !rate(*slot)) {
            let value = model.slot_value(slot, view)?;
            view.values[slot] = value;
        }
        for slot in torn.iter().copied().filter(|slot| !rate(*slot)) {
            let value = model.slot_value(slot, view)?;
            off[slot] = Some(view.values[slot].minus(&value));
        }
    }
    Ok(off)
}

/// Adds a wrench at a place to what acts on a part.
fn push<T: Scalar>(
    on: &mut [Vector<T>; 2],
    part: &Frame<T>,
    place: &Vector<T>,
    wrench: &[Vector<T>; 2],
    sign: f64,
) {
    let flip = T::constant(sign);
    let (force, torque) = (scale(&wrench[0], &flip), scale(&wrench[1], &flip));
    let arm = subtract(place, &part.origin);
    on[1] = add(&on[1], &add(&torque, &cross(&arm, &force)));
    on[0] = add(&on[0], &force);
}

/// A wrench on the part of I at I, and the opposite on the part of J.
fn apply<T: Scalar>(
    model: &Model,
    on: &mut Wrenches<T>,
    parts: &[Frame<T>],
    view: &View<'_, T>,
    [i, j]: [usize; 2],
    wrench: &[Vector<T>; 2],
    alone: bool,
) {
    let place = &view.frames[i].origin;
    let (a, b) = (model.markers[i].part, model.markers[j].part);
    push(&mut on[a], &parts[a], place, wrench, 1.0);
    if !alone {
        push(&mut on[b], &parts[b], place, wrench, -1.0);
    }
}

/// Gaps of a constraint, and the wrench on I that its multipliers make.
fn hold<T: Scalar>(
    constraint: &Constraint,
    view: &View<'_, T>,
    held: &T,
    multipliers: &[T],
) -> (Vec<T>, [Vector<T>; 2]) {
    let (i, j) = (&view.frames[constraint.i], &view.frames[constraint.j]);
    let distance = subtract(&i.origin, &j.origin);
    let [mut force, mut torque] = [vector([0.0; 3]), vector([0.0; 3])];
    let mut gaps = Vec::with_capacity(multipliers.len());
    for (equation, multiplier) in constraint.equations.iter().zip(multipliers) {
        match *equation {
            Equation::Along(axis) => {
                let axis = column(&j.axes, axis);
                gaps.push(dot(&axis, &distance).minus(held));
                force = add(&force, &scale(&axis, multiplier));
            }
            Equation::Normal(a, b) => {
                let (a, b) = (column(&i.axes, a), column(&j.axes, b));
                gaps.push(dot(&a, &b));
                torque = add(&torque, &scale(&cross(&a, &b), multiplier));
            }
            Equation::About => {
                let x = column(&i.axes, 0);
                let (sin, cos) = (dot(&x, &column(&j.axes, 1)), dot(&x, &column(&j.axes, 0)));
                gaps.push(turned_less(&sin, &cos, held));
                torque = add(&torque, &scale(&column(&j.axes, 2), multiplier));
            }
        }
    }
    (gaps, [force, torque])
}

/// An angle by sine and cosine less another, from -pi to pi.
fn turned_less<T: Scalar>(sin: &T, cos: &T, held: &T) -> T {
    let one =
        |unary: Unary| Function::Unary(unary).value(std::slice::from_ref(held)).unwrap_or(T::constant(0.0));
    let (s, c) = (one(Unary::Sin), one(Unary::Cos));
    atan2(&sin.times(&c).minus(&cos.times(&s)), &cos.times(&c).plus(&sin.times(&s)))
}
