//! Where within a step something happens at which it must end: breaks of rails, changes of sign of the elements'
//! guards.

use super::step::Step;
use crate::Error;
use crate::contact::element::{Guard, GuardKind};
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::numerics::root::narrow;

/// Force by which a step may end beyond an event, relative to the largest contact force.
pub(crate) const OVERSHOOT: f64 = 1e-9;

/// Distance to a break of a rail, relative to 1 + |x|, within which a rolling wheel is at it; the least, and for each
/// unit of the error that a step may make.
const SLACK: f64 = 1e-11;
const SLACK_BY_ERROR: f64 = 1e-4;

/// A step may start as many times as far before a break and cross it: what ends there has passed all breaks that
/// near, and every stage is beyond them.
const PASSED: f64 = 8.0;

/// Fraction of a step to which the place of a touch is found.
const TOUCH_WIDTH: f64 = 1e-4;

/// Slack of breaks for steps of the error `tolerance`, or of a fixed length.
pub(crate) fn break_slack(tolerance: f64, is_fixed: bool) -> f64 {
    if is_fixed { SLACK } else { SLACK.max(SLACK_BY_ERROR * tolerance) }
}

/// Whether guesses of where a step meets a break are good enough to begin with: the slack is more than rounding.
pub(crate) fn can_predict(slack: f64) -> bool {
    slack > SLACK
}

/// Length of the step from time `start` that ends where a wheel with prescribed motion meets a break of its rail, if
/// the step of length `h` would pass it.
pub(crate) fn prescribed_break(system: &System, start: f64, h: f64) -> Option<f64> {
    let mechanics = &system.mechanics;
    let mut best: Option<f64> = None;
    for (b, body) in system.scene.bodies.iter().enumerate() {
        let Some(profile) = &body.motion else { continue };
        let (x0, x1) = (profile.at(start).x, profile.at(start + h).x);
        for wheel in mechanics.wheels.iter().filter(|w| mechanics.kinematics.root(w.body) == b) {
            let contact = &system.scene.contacts[wheel.contact];
            let offset = mechanics.kinematics.constant(wheel.body)[0];
            let ahead = wheel.hub[0] + offset;
            let foundation = &system.foundations[contact.structure];
            for place in foundation.breaks_between(contact.rail, x0 + ahead, x1 + ahead) {
                let target = place - ahead;
                let slack = 1e-9 * (1.0 + target.abs());
                if (x0 - target) * (x1 - target) >= 0.0 || (x0 - target).abs() < slack {
                    continue;
                }
                // A little before the break: there the rail's slope is still that of the rail element the wheel is on.
                let length = root(|s| profile.at(start + s * h).x - target) * h
                    - 4.0 * f64::EPSILON * (start + h).abs();
                if length > 0.0 && length < h * (1.0 - 1e-9) && best.is_none_or(|known| length < known) {
                    best = Some(length);
                }
            }
        }
    }
    best
}

/// Fraction of the step just taken at which a freely rolling wheel meets a break of its rail, and the wheel, if the
/// step passes one: the root of the wheel's place on the interpolant, less half of the `slack`. Repeated, the step
/// ends before the break, where the rail's slope is still that of the rail element the wheel comes from.
pub(crate) fn rolling_break(step: &mut Step, slack: f64) -> Option<(f64, usize)> {
    let system = step.system();
    let mechanics = &system.mechanics;
    if !mechanics.moves_freely {
        return None;
    }
    let mut first: Option<(f64, usize)> = None;
    let places = step.solver.geometry().places();
    for (w, wheel) in mechanics.wheels.iter().enumerate() {
        if system.scene.bodies[mechanics.kinematics.root(wheel.body)].motion.is_some() {
            continue;
        }
        let contact = &system.scene.contacts[wheel.contact];
        let [x0, x1] = [&step.from, &step.to].map(|at| places.of_wheel(mechanics, w, &at.q));
        for place in system.foundations[contact.structure].breaks_between(contact.rail, x0, x1) {
            let slack = slack * (1.0 + place.abs());
            // Within the slack a step may start before the break and cross it, or end beyond it.
            let is_there = (x0 - place).abs() < PASSED * slack || (x1 - place).abs() < slack;
            if (x0 - place) * (x1 - place) >= 0.0 || is_there {
                continue;
            }
            let aim = place - 0.5 * slack * (x1 - x0).signum();
            let (from, to, probe) = (&step.from, &step.to, &mut step.probe);
            let fraction = root(|fraction| {
                probe.interpolate(from, to, fraction);
                places.of_wheel(mechanics, w, &probe.q) - aim
            });
            if first.is_none_or(|(known, _)| fraction < known) {
                first = Some((fraction, w));
            }
        }
    }
    first
}

/// Whether wheel `w` stands at a break of its rail at `at`, with its distance ahead to the break at most.
pub(crate) fn at_break(solver: &Solver, w: usize, at: &State, slack: f64) -> Option<f64> {
    let system = solver.system();
    let x = solver.geometry().places().of_wheel(&system.mechanics, w, &at.q);
    let near = PASSED * slack * (1.0 + x.abs());
    let contact = &system.scene.contacts[system.mechanics.wheels[w].contact];
    let foundation = &system.foundations[contact.structure];
    foundation.breaks_between(contact.rail, x - near, x + near).next().map(|_| near)
}

/// The guards of one kind of all elements at `at`, to which the geometry belongs.
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

/// Fraction of the step just taken at which an element first touches or lets go, if one does by more than a force of
/// [`OVERSHOOT`] of `largest`: the first root on the interpolant of the touch guards, which were `before` at its start.
///
/// # Errors
/// What the rails refuse.
pub(crate) fn first_touch(step: &mut Step, before: &[Guard], largest: f64) -> Result<Option<f64>, Error> {
    if before.is_empty() {
        return Ok(None);
    }
    let slack = OVERSHOOT * largest;
    // Guards that change their sign, and where they have: there their distance to it is positive.
    let mut passes: Vec<(usize, f64)> = Vec::new();
    let mut ends = [f64::NEG_INFINITY; 2];
    let after = guards(step.solver, GuardKind::Touch, &step.to);
    for (index, (before, Guard { value: now, stiffness })) in before.iter().zip(after).enumerate() {
        let (before, slack) = (before.value, slack / stiffness);
        if before * now < 0.0 && before.abs().min(now.abs()) > slack {
            let aim = 0.5 * slack * now.signum();
            passes.push((index, aim));
            for (end, value) in ends.iter_mut().zip([before, now]) {
                *end = end.max((value - aim) * aim.signum());
            }
        }
    }
    if passes.is_empty() {
        return Ok(None);
    }
    let mut failure = None;
    let [_, first] = narrow(ends, TOUCH_WIDTH, |fraction| {
        let is_solved = step.look_at(fraction).unwrap_or_else(|error| {
            failure = Some(error);
            false
        });
        is_solved.then(|| {
            let now = guards(step.solver, GuardKind::Touch, &step.probe);
            let beyond = passes.iter().map(|&(index, aim)| (now[index].value - aim) * aim.signum());
            beyond.fold(f64::NEG_INFINITY, f64::max)
        })
    });
    if let Some(error) = failure {
        return Err(error);
    }
    step.return_to_end()?;
    Ok(Some(first))
}

/// The first element that must begin or cease to act within the step, if one must: the fraction of the step at which it
/// does, and the force by which the step has gone too far; `largest` is the largest force.
///
/// Forces of contacts that remember their penetration relax faster than the interpolant follows: for them the
/// fraction is the secant of the forces at both ends, for all others the root on the interpolant. Repeated, both end
/// within [`OVERSHOOT`] beyond the event.
///
/// # Errors
/// What the rails refuse.
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
    Ok(first)
}

/// Fraction of the step at which the switch guard of element `i` reaches `aim` on the interpolant.
fn root_on_interpolant(step: &mut Step, i: usize, aim: f64) -> Result<f64, Error> {
    let beyond =
        |solver: &Solver, at: &State| solver.switch_guard(i, &solver.frame(at)).unwrap_or(-1.0) - aim;
    // The geometry is that of the end: the value at the start is a guess.
    let [start, end] = [&step.from, &step.to].map(|at| beyond(step.solver, at));
    if end <= 0.0 {
        return Ok(1.0);
    }
    let mut failure = None;
    let [_, fraction] = narrow([start.min(-aim), end], 1e-12, |fraction| {
        let value = step.look_at(fraction).map(|solved| solved.then(|| beyond(step.solver, &step.probe)));
        value.unwrap_or_else(|error| {
            failure = Some(error);
            None
        })
    });
    failure.map_or(Ok(fraction), Err)
}

/// Fraction of the step at which a law reaches or leaves a corner, if one does by more than [`OVERSHOOT`] of the force
/// `largest`: the secant of its guard at both ends.
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
    fractions.min_by(f64::total_cmp)
}

/// Root in (0, 1) of a function with opposite signs at the ends, from the side of 0.
fn root(mut f: impl FnMut(f64) -> f64) -> f64 {
    let ends = [f(0.0), f(1.0)];
    narrow(ends, 1e-15, |at| Some(f(at)))[0]
}
