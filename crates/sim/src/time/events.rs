//! Location of the events at which a step must end: breaks of rails and sign changes of the guards of elements.

use piecewise::Polynomial;

use super::step::Step;
use crate::Error;
use crate::contact::element::{Guard, GuardKind};
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::root::{behind, narrow};

/// Force by which a step may overshoot an event, relative to the largest contact force.
pub(crate) const OVERSHOOT: f64 = 1e-9;

/// Distance to a break of a rail, relative to 1 + |x|, within which a rolling wheel is regarded as being at the
/// break. The first constant is the minimum, the second the value per unit of step tolerance.
const SLACK: f64 = 1e-11;
const SLACK_BY_ERROR: f64 = 1e-4;

/// Multiple of the slack before a break within which a step may start and cross the break without being cut there. A
/// step that ends beyond the break has passed all breaks within this distance, and all its stages are beyond them.
const PASSED: f64 = 8.0;

/// Least fraction of a step to which it is shortened for the corner of a law.
const NEAREST: f64 = 0.1;

/// Tolerance of the position of a touch, as a fraction of the step.
const TOUCH_WIDTH: f64 = 1e-4;

/// Errors of the forces, relative to the largest, and of the heights of the wheels, relative to themselves, in the states at which
/// a touch is sought. They move a flange beside its rail by as much of the deflection, and of the radius times the roll, which
/// is far less than what the flange moves in the tolerance of the position.
const TOUCH_SLACK: [f64; 2] = [1e-8, 1e-5];

/// The largest of some forces that is rounding beside the others, by which nothing is scaled.
pub(crate) fn rounding_among(forces: impl Iterator<Item = f64>) -> f64 {
    OVERSHOOT * forces.fold(0.0, f64::max)
}

/// Slack of breaks for steps of the relative error `tolerance` or, if `is_fixed`, of a fixed length.
pub(crate) fn break_slack(tolerance: f64, is_fixed: bool) -> f64 {
    if is_fixed {
        SLACK
    } else {
        SLACK.max(SLACK_BY_ERROR * tolerance)
    }
}

/// Whether the extrapolated position of a break is accurate enough for the first trial of a step: this is so if the
/// slack exceeds rounding.
pub(crate) fn can_predict(slack: f64) -> bool {
    slack > SLACK
}

/// Length of the step from time `start` that ends where a wheel with prescribed motion meets a break of its rail, if
/// a step of length `h` would pass the break.
///
/// Breaks are tried in the order in which the wheel meets them. When one is known to shorten the step, those that x
/// does not reach within the shorter step are left out.
pub(crate) fn prescribed_break(system: &System, start: f64, h: f64) -> Option<f64> {
    let mechanics = &system.mechanics;
    let mut best: Option<f64> = None;
    for (b, body) in system.scene.bodies.iter().enumerate() {
        let Some(profile) = &body.motion else {
            continue;
        };
        let (x0, x1) = (profile.at(start).x, profile.at(start + h).x);
        for wheel in mechanics
            .wheels
            .iter()
            .filter(|w| mechanics.kinematics.root(w.body) == b)
        {
            let contact = &system.scene.contacts[wheel.contact];
            let offset = mechanics.kinematics.constant(wheel.body)[0];
            let ahead = wheel.hub[0] + offset;
            let mut reach =
                best.map_or(f64::INFINITY, |length| profile.reach(start, start + length));
            let (from, to) = (x0 + ahead, x1 + ahead);
            for place in mechanics
                .breaks
                .between(contact.structure, contact.rail, from, to)
            {
                let target = place - ahead;
                let slack = 1e-9 * (1.0 + target.abs());
                if (x0 - target).abs() > reach + slack {
                    break;
                }
                if (x0 - target) * (x1 - target) >= 0.0 || (x0 - target).abs() < slack {
                    continue;
                }
                // The step ends slightly before the break, where the slope of the rail is still that of the current
                // rail element.
                let length = root(|s| profile.at(start + s * h).x - target) * h
                    - 4.0 * f64::EPSILON * (start + h).abs();
                if length > 0.0
                    && length < h * (1.0 - 1e-9)
                    && best.is_none_or(|known| length < known)
                {
                    best = Some(length);
                    reach = profile.reach(start, start + length);
                }
            }
        }
    }
    best
}

/// Finds the first break of a rail that a freely rolling wheel passes in the step just taken. Returns the fraction of
/// the step and the wheel. The fraction is the root of the position of the wheel on the interpolant, at half of the
/// `slack` before the break. When the step is repeated until no break is passed, it ends before the break, where the
/// slope of the rail is still that of the rail element that the wheel is leaving.
///
/// Breaks are tried in the order in which the wheel meets them. When one is known to be passed, those that the wheel
/// does not reach before it on the interpolant are left out.
pub(crate) fn rolling_break(step: &mut Step, slack: f64) -> Option<(f64, usize)> {
    let system = step.system();
    let mechanics = &system.mechanics;
    if !mechanics.moves_freely {
        return None;
    }
    let mut first: Option<(f64, usize)> = None;
    let places = step.solver.geometry().places();
    for (w, wheel) in mechanics.wheels.iter().enumerate() {
        if system.scene.bodies[mechanics.kinematics.root(wheel.body)]
            .motion
            .is_some()
        {
            continue;
        }
        let contact = &system.scene.contacts[wheel.contact];
        let (from, to, probe) = (&step.from, &step.to, &mut step.probe);
        let [x0, x1] = [from, to].map(|at| places.of_wheel(mechanics, w, &at.q));
        let (mut reach, mut of_step) = (f64::INFINITY, None);
        for place in mechanics
            .breaks
            .between(contact.structure, contact.rail, x0, x1)
        {
            let slack = slack * (1.0 + place.abs());
            if (x0 - place).abs() > reach + slack {
                break;
            }
            // A step that starts or ends within the slack of the break is not cut.
            let is_there = (x0 - place).abs() < PASSED * slack || (x1 - place).abs() < slack;
            if (x0 - place) * (x1 - place) >= 0.0 || is_there {
                continue;
            }
            let aim = place - 0.5 * slack * (x1 - x0).signum();
            // The position is linear in q, so its Bernstein coefficients are the positions at those of q.
            let position: &Polynomial = of_step.get_or_insert_with(|| {
                Polynomial::new((0..6).map(|k| {
                    probe.set_coefficient(from, to, k);
                    places.of_wheel(mechanics, w, &probe.q)
                }))
            });
            let fraction = root(|fraction| position.value(fraction) - aim);
            if first.is_none_or(|(known, _)| fraction < known) {
                first = Some((fraction, w));
            }
            let passed = position.part([0.0, first.map_or(1.0, |(known, _)| known)]);
            let [low, high] = passed.bounds();
            reach = (high - x0).max(x0 - low);
        }
    }
    first
}

/// Distance, relative to 1 + |x|, within which a wheel is at a break.
pub(crate) fn at_break_within(slack: f64) -> f64 {
    PASSED * slack
}

/// The distance within which wheel `w` is at a break of its rail in the state `at`; `None` if there is no break
/// within this distance.
pub(crate) fn at_break(solver: &Solver, w: usize, at: &State, slack: f64) -> Option<f64> {
    let system = solver.system();
    let x = solver
        .geometry()
        .places()
        .of_wheel(&system.mechanics, w, &at.q);
    let near = at_break_within(slack) * (1.0 + x.abs());
    let contact = &system.scene.contacts[system.mechanics.wheels[w].contact];
    let breaks = &system.mechanics.breaks;
    (breaks
        .between(contact.structure, contact.rail, x - near, x + near)
        .len()
        > 0)
    .then_some(near)
}

/// Values of the guards of one kind of all elements in the state `at`, for which the geometry must be current.
pub(crate) fn guards(solver: &Solver, kind: GuardKind, at: &State) -> Vec<Guard> {
    let (system, mut all) = (solver.system(), Vec::new());
    let guarded = system.guarded(kind);
    if guarded.is_empty() {
        return all;
    }
    let frame = solver.frame(at);
    for &i in guarded {
        system.elements[i].guards(&frame.at(i), &mut |guard| all.push(guard));
    }
    all
}

/// Fraction of the step just taken at which an element first touches or separates, if a guard changes its sign by
/// more than the force [`OVERSHOOT`] times `largest`. The result is the first root of the touch guards on the
/// interpolant; `before` are their values at the start of the step. If it is found, the step must be repeated: the geometry
/// of the solver is that of a state inside it.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn first_touch(
    step: &mut Step,
    before: &[Guard],
    largest: f64,
) -> Result<Option<f64>, Error> {
    if before.is_empty() {
        return Ok(None);
    }
    let slack = OVERSHOOT * largest;
    // Guards that change their sign, with the target value of each. The signed distance to the target is positive
    // where the guard has passed it.
    let mut passes: Vec<(usize, f64)> = Vec::new();
    let mut ends = [f64::NEG_INFINITY; 2];
    let after = guards(step.solver, GuardKind::Touch, &step.to);
    for (index, (old, new)) in before.iter().zip(&after).enumerate() {
        let slack = slack / new.stiffness;
        if old.value * new.value < 0.0 && old.value.abs().min(new.value.abs()) > slack {
            let aim = 0.5 * slack * new.value.signum();
            passes.push((index, aim));
            for (end, guards) in ends.iter_mut().zip([before, &after]) {
                *end = end.max((straight(step.solver, index, guards) - aim) * aim.signum());
            }
        }
    }
    if passes.is_empty() {
        return Ok(None);
    }
    let mut failure = None;
    let first = behind(ends, TOUCH_WIDTH, |fraction| {
        let is_solved = step
            .look_within(fraction, TOUCH_SLACK)
            .unwrap_or_else(|error| {
                failure = Some(error);
                false
            });
        is_solved.then(|| {
            let now = guards(step.solver, GuardKind::Touch, &step.probe);
            let beyond = passes
                .iter()
                .map(|&(index, aim)| (straight(step.solver, index, &now) - aim) * aim.signum());
            beyond.fold(f64::NEG_INFINITY, f64::max)
        })
    });
    failure.map_or(Ok(Some(first)), Err)
}

/// The value of touch guard `index` with an overlap p replaced by p + k G p, the overlap with a rigid rail. Where a flange
/// touches, its rail gives way, so that its overlap grows slower than its clearance shrank by the factor 1 + k G; without
/// this kink at the root, its search takes two thirds of the evaluations.
fn straight(solver: &Solver, index: usize, guards: &[Guard]) -> f64 {
    let Guard { value, stiffness } = guards[index];
    let element = solver.system().guarded(GuardKind::Touch)[index];
    if value > 0.0 {
        value * (1.0 + stiffness * solver.geometry().own_compliance(element))
    } else {
        value
    }
}

/// Finds the first element that must become active or inactive within the step. Returns the fraction of the step at
/// which it does and the force by which the step has overshot it; `largest` is the largest force.
///
/// The forces of contacts whose penetration is a state relax faster than the interpolant can follow. For these the
/// fraction is found from the secant of the forces at both ends of the step; for all others it is the root on the
/// interpolant. When repeated, both end within [`OVERSHOOT`] beyond the event. Where a contact opens and closes within a
/// step, or closes and opens, the fraction is the first stage at which it should have been switched.
///
/// # Errors
/// Any error from evaluating the rails.
pub(crate) fn first_switch(step: &mut Step, largest: f64) -> Result<Option<(f64, f64)>, Error> {
    let aim = 0.5 * OVERSHOOT * largest;
    let mut first: Option<(f64, f64)> = None;
    let (mut has_looked, mut next) = (false, 0);
    while let Some((i, excess)) = step.solver.next_switch(next, &step.to) {
        next = i + 1;
        let noise = step.solver.geometry().local()[i].spring.noise;
        let fraction = if step.solver.remembers(i) {
            let start = step.from.force[i].max(0.0);
            ((start + aim) / (start + excess)).min(1.0)
        } else {
            has_looked = true;
            root_on_interpolant(step, i, aim + noise)?
        };
        if first.is_none_or(|(known, _)| fraction < known) {
            first = Some((fraction, excess - 2.0 * noise));
        }
    }
    if has_looked {
        step.return_to_end()?;
    }
    let passed = step.passed_switch(OVERSHOOT * largest);
    Ok(passed
        .filter(|(share, _)| first.is_none_or(|(known, _)| *share < known))
        .or(first))
}

/// Fraction of the step at which the switch guard of element `i` reaches the value `aim` on the interpolant.
fn root_on_interpolant(step: &mut Step, i: usize, aim: f64) -> Result<f64, Error> {
    let beyond = |solver: &Solver, at: &State| {
        solver.switch_guard(i, &solver.frame(at)).unwrap_or(-1.0) - aim
    };
    // The geometry is that of the end of the step, so the value at the start is approximate.
    let [start, end] = [&step.from, &step.to].map(|at| beyond(step.solver, at));
    if end <= 0.0 {
        return Ok(1.0);
    }
    let mut failure = None;
    let [_, fraction] = narrow([start.min(-aim), end], 1e-12, |fraction| {
        let value = step
            .look_at(fraction)
            .map(|solved| solved.then(|| beyond(step.solver, &step.probe)));
        value.unwrap_or_else(|error| {
            failure = Some(error);
            None
        })
    });
    failure.map_or(Ok(fraction), Err)
}

/// Fraction of the step at which a contact law reaches or leaves a corner, if its guard passes zero by more than
/// [`OVERSHOOT`] of the force `largest`. The fraction is found from the secant of the guard at both ends, but is at least
/// [`NEAREST`]: a guard may first move away from a corner beside which the step begins.
pub(crate) fn first_corner(step: &Step, largest: f64) -> Option<f64> {
    if step.system().guarded(GuardKind::Corner).is_empty() {
        return None;
    }
    let slack = OVERSHOOT * largest;
    let [from, to] = [&step.from, &step.to].map(|at| guards(step.solver, GuardKind::Corner, at));
    let fractions = from.iter().zip(&to).filter_map(|(from, to)| {
        let (from, to) = (from.value, to.value);
        let passes = from * to < 0.0 && from.abs() > slack && to.abs() > slack;
        passes.then(|| (from.abs() + 0.5 * slack) / (from.abs() + to.abs()))
    });
    let first = fractions.min_by(f64::total_cmp)?;
    Some(first.max(NEAREST))
}

/// Root in (0, 1) of a function with opposite signs at the ends; the returned value lies on the side of 0.
fn root(mut f: impl FnMut(f64) -> f64) -> f64 {
    let ends = [f(0.0), f(1.0)];
    narrow(ends, 1e-15, |at| Some(f(at)))[0]
}
