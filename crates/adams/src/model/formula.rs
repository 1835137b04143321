//! Expressions with their names resolved, and their evaluation.

use super::configuration::Configuration;
use super::load::AppliedForce;
use crate::expression::functions::{Function, power};
use crate::expression::{FactorOperator, TermOperator};
use crate::kinematics::vector::{Vector, norm, resolve};
use crate::kinematics::{Frame, Measure, measure};
use crate::tables::SplineFunction;
use crate::{AdamsFault, Scalar};
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::BTreeSet;

/// An expression that can be evaluated. Markers, loads and all else that it reads are indices into the model.
#[derive(Clone, Debug)]
pub(crate) enum Formula {
    Number(f64),
    /// TIME.
    Time,
    /// MODE.
    Mode,
    /// A kinematic function of the markers i, j, k and l; `None` is ground.
    Measure(Measure, [Option<usize>; 4]),
    /// A component of a load: 1 the magnitude of the force, 2 to 4 its components, 5 to 8 likewise for the
    /// torque.
    Load {
        load: usize,
        on_j: bool,
        component: usize,
        frame: Option<usize>,
    },
    /// A component of the reaction of a constraint, numbered as those of a load.
    Reaction {
        constraint: usize,
        on_j: bool,
        component: usize,
        frame: Option<usize>,
    },
    /// VARVAL or DIF1.
    Slot(usize),
    /// DIF.
    Differential(usize),
    /// AKISPL or CUBSPL.
    Spline {
        family: usize,
        order: usize,
        x: Box<Formula>,
        z: Box<Formula>,
    },
    /// IF: the test, and the values where it is negative, zero and positive.
    Choice(Box<[Formula; 4]>),
    Call(Function, Vec<Formula>),
    Sum(Vec<(TermOperator, Formula)>),
    Product(Vec<(FactorOperator, Formula)>),
    Power(Box<Formula>, Box<Formula>),
}

/// Everything that the value of a formula depends on.
pub(crate) struct Evaluation<'a, T> {
    pub loads: &'a [AppliedForce],
    pub families: &'a [SplineFunction],
    /// Frames, time and values of slots.
    pub at: Configuration<T>,
    /// Force and torque on I of each constraint, in ground axes; `None` where they are not known.
    pub reactions: Vec<Option<[Vector<T>; 2]>>,
    /// The families that were read beyond their values.
    pub beyond: RefCell<BTreeSet<usize>>,
}

impl<'a, T: Scalar> Evaluation<'a, T> {
    /// An evaluation on a configuration, with `constraints` reactions that are not known.
    pub fn new(
        loads: &'a [AppliedForce],
        families: &'a [SplineFunction],
        at: Configuration<T>,
        constraints: usize,
    ) -> Evaluation<'a, T> {
        let reactions = vec![None; constraints];
        Evaluation {
            loads,
            families,
            at,
            reactions,
            beyond: RefCell::new(BTreeSet::new()),
        }
    }
}

impl Formula {
    /// The value.
    ///
    /// # Errors
    /// The faults of functions and tables; [`AdamsFault::NotFiniteValue`] for a result that is not finite.
    pub fn value<T: Scalar>(&self, on: &Evaluation<'_, T>) -> Result<T, AdamsFault> {
        let out = self.part(on)?;
        if out.value().is_finite() {
            Ok(out)
        } else {
            Err(AdamsFault::NotFiniteValue)
        }
    }

    /// The value, which may be infinite or NaN.
    fn part<T: Scalar>(&self, on: &Evaluation<'_, T>) -> Result<T, AdamsFault> {
        match self {
            Formula::Number(value) => Ok(T::constant(*value)),
            Formula::Time => Ok(T::constant(on.at.time)),
            Formula::Mode => Ok(T::constant(on.at.mode)),
            Formula::Measure(what, markers) => {
                let same = markers[2] == markers[3];
                Ok(measure(
                    *what,
                    markers.map(|marker| on.at.frame(marker)),
                    same,
                ))
            }
            Formula::Load {
                load,
                on_j,
                component,
                frame,
            } => {
                let load = on.loads.get(*load).ok_or(AdamsFault::UnexpectedText)?;
                if let Some(slot) = load.direct(*component, *frame) {
                    let sign = if *on_j { -1.0 } else { 1.0 };
                    return Ok(
                        slot.map_or(T::constant(0.0), |slot| on.at.values[slot].scaled(sign))
                    );
                }
                Ok(component_of(
                    &load.wrench(&on.at),
                    *component,
                    on.at.frame(*frame),
                    *on_j,
                ))
            }
            Formula::Reaction {
                constraint,
                on_j,
                component,
                frame,
            } => {
                let wrench = on
                    .reactions
                    .get(*constraint)
                    .and_then(Option::as_ref)
                    .ok_or(AdamsFault::Reaction)?;
                Ok(component_of(wrench, *component, on.at.frame(*frame), *on_j))
            }
            Formula::Slot(index) => on
                .at
                .values
                .get(*index)
                .cloned()
                .ok_or(AdamsFault::UnexpectedText),
            Formula::Differential(index) => on
                .at
                .differentials
                .get(*index)
                .cloned()
                .ok_or(AdamsFault::UnexpectedText),
            Formula::Spline {
                family,
                order,
                x,
                z,
            } => interpolated(on, *family, *order, &x.part(on)?, &z.part(on)?),
            Formula::Choice(parts) => {
                let [test, below, zero, above] = parts.as_ref();
                match test.part(on)?.value().partial_cmp(&0.0) {
                    Some(Ordering::Less) => below.part(on),
                    Some(Ordering::Equal) => zero.part(on),
                    Some(Ordering::Greater) => above.part(on),
                    None => Err(AdamsFault::NotFiniteValue),
                }
            }
            Formula::Call(function, arguments) => {
                let all: Result<Vec<T>, AdamsFault> =
                    arguments.iter().map(|one| one.part(on)).collect();
                function.value(&all?)
            }
            Formula::Sum(terms) => sum(on, terms),
            Formula::Product(factors) => product(on, factors),
            Formula::Power(base, exponent) => Ok(power(&base.part(on)?, &exponent.part(on)?)),
        }
    }

    /// Whether the value depends on nothing but TIME.
    pub fn is_function_of_time(&self) -> bool {
        match self {
            Formula::Number(_) | Formula::Time | Formula::Mode => true,
            Formula::Measure(..)
            | Formula::Load { .. }
            | Formula::Reaction { .. }
            | Formula::Slot(_) => false,
            Formula::Differential(_) => false,
            Formula::Spline { x, z, .. } | Formula::Power(x, z) => {
                x.is_function_of_time() && z.is_function_of_time()
            }
            Formula::Choice(parts) => parts.iter().all(Formula::is_function_of_time),
            Formula::Call(_, parts) => parts.iter().all(Formula::is_function_of_time),
            Formula::Sum(parts) => parts.iter().all(|(_, part)| part.is_function_of_time()),
            Formula::Product(parts) => parts.iter().all(|(_, part)| part.is_function_of_time()),
        }
    }

    /// Adds the slots whose values the formula reads.
    pub fn needs(&self, loads: &[AppliedForce], out: &mut BTreeSet<usize>) {
        match self {
            Formula::Number(_)
            | Formula::Time
            | Formula::Mode
            | Formula::Measure(..)
            | Formula::Differential(_) => {}
            Formula::Reaction { .. } => {}
            Formula::Slot(slot) => {
                out.insert(*slot);
            }
            Formula::Load {
                load,
                component,
                frame,
                ..
            } => {
                if let Some(load) = loads.get(*load) {
                    match load.direct(*component, *frame) {
                        Some(slot) => out.extend(slot),
                        None => out.extend(load.part(*component)),
                    }
                }
            }
            Formula::Spline { x, z, .. } | Formula::Power(x, z) => {
                x.needs(loads, out);
                z.needs(loads, out);
            }
            Formula::Choice(parts) => parts.iter().for_each(|part| part.needs(loads, out)),
            Formula::Call(_, parts) => parts.iter().for_each(|part| part.needs(loads, out)),
            Formula::Sum(parts) => parts.iter().for_each(|(_, part)| part.needs(loads, out)),
            Formula::Product(parts) => parts.iter().for_each(|(_, part)| part.needs(loads, out)),
        }
    }
}

/// The value of a family at (x, z), with a note if that is beyond its values.
fn interpolated<T: Scalar>(
    on: &Evaluation<'_, T>,
    family: usize,
    order: usize,
    x: &T,
    z: &T,
) -> Result<T, AdamsFault> {
    let table = on.families.get(family).ok_or(AdamsFault::UnexpectedText)?;
    if !(x.value().is_finite() && z.value().is_finite()) {
        return Err(AdamsFault::NotFiniteValue);
    }
    let read = table.read(x.value(), z.value(), order)?;
    if read.extrapolated {
        on.beyond.borrow_mut().insert(family);
    }
    Ok(T::compose(read.value, &[(read.by_x, x), (read.by_z, z)]))
}

/// The sum of terms from left to right.
fn sum<T: Scalar>(
    on: &Evaluation<'_, T>,
    terms: &[(TermOperator, Formula)],
) -> Result<T, AdamsFault> {
    let mut sum: Option<T> = None;
    for (sign, term) in terms {
        let term = term.part(on)?;
        sum = Some(match (sum, sign) {
            (None, TermOperator::Plus) => term,
            (None, TermOperator::Minus) => term.negated(),
            (Some(sum), TermOperator::Plus) => sum.plus(&term),
            (Some(sum), TermOperator::Minus) => sum.minus(&term),
        });
    }
    Ok(sum.unwrap_or(T::constant(0.0)))
}

/// The product of factors from left to right.
fn product<T: Scalar>(
    on: &Evaluation<'_, T>,
    factors: &[(FactorOperator, Formula)],
) -> Result<T, AdamsFault> {
    let mut product: Option<T> = None;
    for (factor, part) in factors {
        let part = part.part(on)?;
        product = Some(match (product, factor) {
            (None, _) => part,
            (Some(product), FactorOperator::Times) => product.times(&part),
            (Some(product), FactorOperator::Over) => product.over(&part),
        });
    }
    Ok(product.unwrap_or(T::constant(1.0)))
}

/// A component of a force and torque in the axes of `frame`: 1 |F|, 2 to 4 F, 5 |T|, 6 to 8 T. On J the
/// components have the opposite sign; magnitudes have none.
fn component_of<T: Scalar>(
    wrench: &[Vector<T>; 2],
    component: usize,
    frame: &Frame<T>,
    on_j: bool,
) -> T {
    let vector = &wrench[usize::from(component > 4)];
    match (component - 1) % 4 {
        0 => norm(vector),
        axis => resolve(&frame.axes, vector)[axis - 1].scaled(if on_j { -1.0 } else { 1.0 }),
    }
}
