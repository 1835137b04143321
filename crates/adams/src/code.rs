//! Expressions with their names resolved, and their evaluation.

use crate::expression::{Factor, Sign};
use crate::frame::{Frame, Measure, measure};
use crate::functions::{Function, power};
use crate::model::Model;
use crate::space::{Vector, norm, resolve};
use crate::{Fault, Scalar};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// An expression that can be evaluated. Markers, loads and the rest are indices into a model.
#[derive(Clone, Debug)]
pub(crate) enum Code {
    Number(f64),
    Time,
    Mode,
    /// `None`: ground at its origin.
    Measure(Measure, [Option<usize>; 4]),
    /// A component of a load, from 1 (magnitude) to 8.
    Load {
        load: usize,
        on_j: bool,
        component: usize,
        frame: Option<usize>,
    },
    /// A reaction of a constraint, likewise.
    Reaction {
        constraint: usize,
        on_j: bool,
        component: usize,
        frame: Option<usize>,
    },
    /// An unknown: VARVAL or DIF1.
    Slot(usize),
    Differential(usize),
    Spline {
        family: usize,
        order: usize,
        x: Box<Code>,
        z: Box<Code>,
    },
    Choice(Box<[Code; 4]>),
    Call(Function, Vec<Code>),
    Sum(Vec<(Sign, Code)>),
    Product(Vec<(Factor, Code)>),
    Power(Box<Code>, Box<Code>),
}

/// What an expression is evaluated on.
pub(crate) struct View<'a, T> {
    pub model: &'a Model,
    pub time: f64,
    /// What MODE is: 4 in motion, 5 at rest.
    pub mode: f64,
    /// One a marker.
    pub frames: Vec<Frame<T>>,
    pub ground: Frame<T>,
    /// One a slot.
    pub values: Vec<T>,
    pub differentials: Vec<T>,
    /// Force and torque on I of each constraint, in ground axes, where they are known.
    pub reactions: Vec<Option<[Vector<T>; 2]>>,
    /// Families that were read beyond their values.
    pub beyond: RefCell<BTreeSet<usize>>,
}

impl<T: Scalar> View<'_, T> {
    pub fn frame(&self, marker: Option<usize>) -> &Frame<T> {
        marker.and_then(|k| self.frames.get(k)).unwrap_or(&self.ground)
    }
}

impl Code {
    /// The value.
    ///
    /// # Errors
    /// What a function refuses; a result that is not finite.
    pub fn value<T: Scalar>(&self, view: &View<'_, T>) -> Result<T, Fault> {
        let out = self.part(view)?;
        if out.value().is_finite() { Ok(out) } else { Err(Fault::Infinite) }
    }

    fn part<T: Scalar>(&self, view: &View<'_, T>) -> Result<T, Fault> {
        let slot = |index: usize| view.values.get(index).cloned().ok_or(Fault::Text);
        match self {
            Code::Number(value) => Ok(T::constant(*value)),
            Code::Time => Ok(T::constant(view.time)),
            Code::Mode => Ok(T::constant(view.mode)),
            Code::Measure(what, markers) => {
                let same = markers[2] == markers[3];
                Ok(measure(*what, markers.map(|marker| view.frame(marker)), same))
            }
            Code::Load { load, on_j, component, frame } => {
                let load = view.model.loads.get(*load).ok_or(Fault::Text)?;
                let flip = if *on_j { -1.0 } else { 1.0 };
                if let Some(slot) = load.direct(*component, *frame) {
                    return Ok(slot.map_or(T::constant(0.0), |slot| view.values[slot].scaled(flip)));
                }
                Ok(component_of(&load.wrench(view), *component, view.frame(*frame))
                    .scaled(sign(flip, *component)))
            }
            Code::Reaction { constraint, on_j, component, frame } => {
                let wrench =
                    view.reactions.get(*constraint).and_then(Option::as_ref).ok_or(Fault::Reaction)?;
                let flip = if *on_j { -1.0 } else { 1.0 };
                Ok(component_of(wrench, *component, view.frame(*frame)).scaled(sign(flip, *component)))
            }
            Code::Slot(index) => slot(*index),
            Code::Differential(index) => view.differentials.get(*index).cloned().ok_or(Fault::Text),
            Code::Spline { family, order, x, z } => {
                let (x, z) = (x.part(view)?, z.part(view)?);
                let table = view.model.families.get(*family).ok_or(Fault::Text)?;
                if !(x.value().is_finite() && z.value().is_finite()) {
                    return Err(Fault::Infinite);
                }
                let read = table.read(x.value(), z.value(), *order)?;
                if read.beyond {
                    view.beyond.borrow_mut().insert(*family);
                }
                Ok(T::compose(read.value, &[(read.by_x, &x), (read.by_z, &z)]))
            }
            Code::Choice(parts) => {
                let [test, below, zero, above] = parts.as_ref();
                let test = test.part(view)?.value();
                if test.is_nan() {
                    return Err(Fault::Infinite);
                }
                (if test < 0.0 {
                    below
                } else if test > 0.0 {
                    above
                } else {
                    zero
                })
                .part(view)
            }
            Code::Call(function, arguments) => {
                let all: Result<Vec<T>, Fault> = arguments.iter().map(|one| one.part(view)).collect();
                function.value(&all?)
            }
            Code::Sum(terms) => {
                let mut sum: Option<T> = None;
                for (sign, term) in terms {
                    let term = term.part(view)?;
                    sum = Some(match (sum, sign) {
                        (None, Sign::Plus) => term,
                        (None, Sign::Minus) => term.negated(),
                        (Some(sum), Sign::Plus) => sum.plus(&term),
                        (Some(sum), Sign::Minus) => sum.minus(&term),
                    });
                }
                Ok(sum.unwrap_or(T::constant(0.0)))
            }
            Code::Product(factors) => {
                let mut product: Option<T> = None;
                for (factor, part) in factors {
                    let part = part.part(view)?;
                    product = Some(match (product, factor) {
                        (None, _) => part,
                        (Some(product), Factor::Times) => product.times(&part),
                        (Some(product), Factor::Over) => product.over(&part),
                    });
                }
                Ok(product.unwrap_or(T::constant(1.0)))
            }
            Code::Power(base, exponent) => Ok(power(&base.part(view)?, &exponent.part(view)?)),
        }
    }

    /// Whether the value depends on TIME alone.
    pub fn of_time(&self) -> bool {
        match self {
            Code::Number(_) | Code::Time | Code::Mode => true,
            Code::Measure(..) | Code::Load { .. } | Code::Reaction { .. } | Code::Slot(_) => false,
            Code::Differential(_) => false,
            Code::Spline { x, z, .. } | Code::Power(x, z) => x.of_time() && z.of_time(),
            Code::Choice(parts) => parts.iter().all(Code::of_time),
            Code::Call(_, parts) => parts.iter().all(Code::of_time),
            Code::Sum(parts) => parts.iter().all(|(_, part)| part.of_time()),
            Code::Product(parts) => parts.iter().all(|(_, part)| part.of_time()),
        }
    }

    /// The slots whose values this one needs.
    pub fn needs(&self, model: &Model, out: &mut BTreeSet<usize>) {
        match self {
            Code::Number(_) | Code::Time | Code::Mode | Code::Measure(..) | Code::Differential(_) => {}
            Code::Reaction { .. } => {}
            Code::Slot(slot) => {
                out.insert(*slot);
            }
            Code::Load { load, component, frame, .. } => {
                if let Some(load) = model.loads.get(*load) {
                    match load.direct(*component, *frame) {
                        Some(slot) => out.extend(slot),
                        None => out.extend(load.part(*component)),
                    }
                }
            }
            Code::Spline { x, z, .. } | Code::Power(x, z) => {
                x.needs(model, out);
                z.needs(model, out);
            }
            Code::Choice(parts) => parts.iter().for_each(|part| part.needs(model, out)),
            Code::Call(_, parts) => parts.iter().for_each(|part| part.needs(model, out)),
            Code::Sum(parts) => parts.iter().for_each(|(_, part)| part.needs(model, out)),
            Code::Product(parts) => parts.iter().for_each(|(_, part)| part.needs(model, out)),
        }
    }
}

/// Magnitudes have no sign.
fn sign(flip: f64, component: usize) -> f64 {
    if component == 1 || component == 5 { 1.0 } else { flip }
}

/// 1 |F|, 2..4 F, 5 |T|, 6..8 T.
fn component_of<T: Scalar>(wrench: &[Vector<T>; 2], component: usize, frame: &Frame<T>) -> T {
    let vector = &wrench[usize::from(component > 4)];
    match (component - 1) % 4 {
        0 => norm(vector),
        axis => resolve(&frame.axes, vector)[axis - 1].clone(),
    }
}
