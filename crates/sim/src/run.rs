//! Simulation of one scene from start to end.

use std::ops::ControlFlow;

use nalgebra::DVector;
use piecewise::Side;

use crate::contact::solver::{RailMemory, Solver};
use crate::contact::system::System;
use crate::instant::hang::{equilibrate, place_below_ropes};
use crate::instant::settle::{settle, settle_start};
use crate::instant::springs::acting_springs;
use crate::instant::uneven::{follow_rigid_rails, locate_wheels};
use crate::mechanics::state::State;
use crate::record::energy::Audit;
use crate::record::history::History;
use crate::record::recorder::Recorder;
use crate::record::solution::{Solution, SolutionBuilder};
use crate::time::events::prescribed_break;
use crate::time::outcome::{Counts, FirstImpact};
use crate::time::passage::crossing;
use crate::time::samples::Samples;
use crate::time::step::BOUNCES;
use crate::time::stepper::{Failure, Stepper};
use crate::{Action, Analysis, Body, Error, Fired, Foundation, Method, Scene, Stepping};

/// Relative error allowed in a step, per unit of the accuracy required of the run. In crossings of the girder in the
/// paper with accuracies from 1e-2 to 1e-7, the error of the run was 0.3 to 0.75 of the required accuracy at 5 ft/s,
/// and 0.03 of it at 100 ft/s.
const LOCAL_PER_GLOBAL: f64 = 3.0;

/// Methods that repeat a run which cannot continue, in order, each with a factor on the accuracy of the scene. Runs fail
/// in this way sporadically, where one-sided contacts with a damper between wheel and rail open and close; another
/// sequence of steps passes the place.
const ALTERNATIVES: [(Method, f64); 6] = [
    (Method::Sdirk4, 1.0),
    (Method::Radau, 0.5),
    (Method::Sdirk4, 0.5),
    (Method::Radau, 0.25),
    (Method::Sdirk4, 0.25),
    (Method::Sdirk4, 0.125),
];

/// Steps after which a run is judged by its progress: it is given up if at the mean and at the latest rate its rest would take so
/// many steps, or a hundredth of them at a rate of ten million in a unit of time. Wheels of cranes take some ten thousand in a
/// second, and a million at the accuracy of references; one of a few milligrams on a stiff rail vibrates ten million times.
const JUDGED: usize = 20_000;
const MOST_STEPS: f64 = 1e8;
const FAST: f64 = 1e7;

/// Number of values in a solution from which it is expected how many there will be, and the most that a run may store: 4 GB.
const MANY_VALUES: usize = 100_000_000;
const MOST_VALUES: f64 = 5e8;

/// Length of the first step that is tried, relative to the run.
const FIRST: f64 = 1e-4;

/// Times that differ by less, relative to them, are the same.
const SAME_TIME: f64 = 1e-14;

/// Accuracy of static equilibria between those that are solved, per unit of that of the scene, and the coarsest accuracy of the
/// scene that counts.
const REST: f64 = 1e-2;
const COARSEST: f64 = 1e-4;

/// Least number of intervals of a quasi-static run.
const INTERVALS: f64 = 64.0;

/// Fraction of an interval within which a static equilibrium is one at its end.
const INSIDE: f64 = 1e-9;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// The end time was reached.
    Done,
    /// A rule ended the run.
    Ended(Fired),
    /// The caller stopped the run.
    Stopped,
    /// The steps became too small at this time.
    StepTooSmall(f64),
    /// The run was given up: at the rate of its steps it would have taken millions of them.
    TooManySteps {
        /// The time reached.
        time: f64,
        /// Number of steps up to it.
        steps: usize,
        /// Number of steps that the whole run would take.
        expected: f64,
    },
    /// The run was given up: at the rate at which it grew, its solution would not have fitted into memory.
    TooLarge {
        /// The time reached.
        time: f64,
        /// Number of values that were stored up to it.
        stored: usize,
        /// Number of values that the whole run would store.
        expected: f64,
    },
    /// Evaluating the scene failed at this time, for example because a wheel left its structure.
    Failed(f64, Error),
}

impl Status {
    /// Whether the run reached its end time, or a rule that ends it.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        matches!(self, Status::Done | Status::Ended(_))
    }
}

/// Results of a run.
/// ```
/// use std::ops::ControlFlow;
/// use sim::{Body, Contact, Damper, Foundation, NormalLaw, Scene, Wheel};
///
/// // A wheel dropped from 0.1 m onto a rigid rail.
/// let mut scene = Scene {
///     bodies: vec![Body { start: [0.0, 0.1, 0.0, 0.0, 0.0, 0.0], ..Body::new(1000.0, [1.0; 3]) }],
///     wheels: vec![Wheel::new(0.5, NormalLaw::linear(1e7, 0.0, Damper::Rail))],
///     contacts: vec![Contact::new(0, [0.0; 3])],
///     ..Scene::default()
/// };
/// scene.bodies[0].free = [false, true, false, false, false, false];
/// let run = sim::run(&scene, &[Foundation::rigid()], &mut |_| ControlFlow::Continue(()))?;
/// assert!(run.status.is_complete() && run.counts.events > 0);
/// // Nothing is lost but at rounding.
/// assert!(run.audit.residual() < 1e-5);
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Run {
    /// How the run ended.
    pub status: Status,
    /// Every channel as a function of time.
    pub solution: Solution,
    /// Rows of it at the output times.
    pub history: History,
    /// Rules that acted, in order of time.
    pub fired: Vec<Fired>,
    /// The energy audit; zeros for a quasi-static sweep.
    pub audit: Audit,
    /// Counts of the work done.
    pub counts: Counts,
    /// The method of integration; `None` for a quasi-static sweep.
    pub method: Option<Method>,
    /// Number of bounces of the wheels over which the errors of steps add up: those of the least damped wheel, of which
    /// damping forgets all but the last 1/(2 pi zeta). `accuracy` holds up to [`Run::BOUNCES`] of them; zero for a
    /// quasi-static sweep and for steps of a fixed length.
    pub bounces: f64,
    /// The first strike of a flange or a stop. Runs of different accuracy part there.
    pub strike: Option<FirstImpact>,
    /// The method that could not continue, and the time at which it stopped, if the run was repeated with another.
    pub abandoned: Option<(Method, f64)>,
}

impl Run {
    /// Number of bounces up to which the error of a run stays below the accuracy of its scene. In longer runs the error per
    /// bounce is at most the accuracy divided by this number.
    pub const BOUNCES: f64 = BOUNCES;
}

/// Runs `scene` on `foundations`, one for each structure. `watch` receives the time reached and may stop the run.
///
/// A dynamic run starts in static equilibrium of y, roll and pitch of the bodies that wheels can carry, unless a body
/// on wheels has a starting displacement in these degrees of freedom. It is integrated in force form by adaptive
/// steps of [`Method::Auto`], and the times at which contacts open and close are located. The relative error of
/// displacements per unit of motion is close to `scene.accuracy`. A quasi-static run computes a static equilibrium at
/// every output time.
///
/// # Errors
/// A scene that cannot be set up: see [`Error`]. A failure during the run ends it with a [`Status`] instead.
pub fn run(
    scene: &Scene,
    foundations: &[Foundation],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, Error> {
    run_by(Method::default(), scene, foundations, watch)
}

/// Same as [`run`], by a given [`Method`] or with steps of a fixed length. A quasi-static run does not use the
/// method.
///
/// If [`Method::Auto`] cannot continue because no step is small enough, the whole run is repeated with other methods and
/// down to an eighth of the accuracy until it reaches the end; [`Run::method`] is the method of the result.
///
/// # Errors
/// Those of [`run`], [`Error::Method`] if the method does not suit the scene, and [`Error::Number`] if the step is
/// not positive.
pub fn run_by(
    stepping: impl Into<Stepping>,
    scene: &Scene,
    foundations: &[Foundation],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, Error> {
    let stepping = stepping.into();
    let first = attempt(stepping, scene, foundations, watch)?;
    let abandoned = match (stepping.method, &first.status, first.method) {
        (Method::Auto, Status::StepTooSmall(t), Some(method)) => (method, *t),
        _ => return Ok(first),
    };
    let is_repetition = |&(method, factor): &(Method, f64)| factor == 1.0 && method == abandoned.0;
    for (method, factor) in ALTERNATIVES
        .into_iter()
        .filter(|alternative| !is_repetition(alternative))
    {
        let finer = Scene {
            accuracy: factor * scene.accuracy,
            ..scene.clone()
        };
        match attempt(Stepping { method, ..stepping }, &finer, foundations, watch) {
            Ok(run) if run.status.is_complete() || run.status == Status::Stopped => {
                return Ok(Run {
                    abandoned: Some(abandoned),
                    ..run
                });
            }
            _ => {}
        }
    }
    Ok(first)
}

/// Runs a scene once. See [`run_by`].
fn attempt(
    stepping: Stepping,
    scene: &Scene,
    foundations: &[Foundation],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, Error> {
    let Stepping { method, step } = stepping;
    let system = System::new(scene, foundations)?;
    method.check(&system)?;
    let method = method.chosen(&system);
    if let Some(found) = step.filter(|step| !(*step > 0.0 && step.is_finite())) {
        return Err(Error::Number {
            what: "step",
            wanted: "positive",
            found,
        });
    }
    let mut method = method;
    if method == Method::Series {
        if step.is_none()
            && scene.analysis == Analysis::Dynamic
            && let Some(crossed) =
                crossing::run(&system, starting(&system), placed(&system), watch)?
        {
            return Ok(Run {
                status: if crossed.is_stopped {
                    Status::Stopped
                } else {
                    Status::Done
                },
                history: rows(scene, &crossed.solution, false),
                solution: crossed.solution,
                fired: Vec::new(),
                audit: crossed.audit,
                counts: crossed.counts,
                method: Some(Method::Series),
                bounces: crossed.bounces,
                strike: None,
                abandoned: None,
            });
        }
        method = Method::Radau;
    }
    let mut state = starting(&system);
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    locate_wheels(&mut solver, &state)?;
    state.v.fill(0.0);
    place_below_ropes(&mut solver, &mut state)?;
    match scene.analysis {
        Analysis::QuasiStatic => sweep(&system, &mut solver, state, watch),
        Analysis::Dynamic => integrate(
            Stepping { method, step },
            &system,
            &mut solver,
            state,
            watch,
        ),
    }
}

/// The static equilibria of a scene at given times, as rows of a history, up to the first time without one. All bodies must
/// have prescribed places.
///
/// A quasi-static [`run`] also follows what happens between its rows, which takes longer.
///
/// # Errors
/// A scene that cannot be set up: see [`Error`].
pub fn equilibria(
    scene: &Scene,
    foundations: &[Foundation],
    times: &[f64],
) -> Result<(History, Status), Error> {
    let system = System::new(scene, foundations)?;
    let mut state = starting(&system);
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    locate_wheels(&mut solver, &state)?;
    state.v.fill(0.0);
    place_below_ropes(&mut solver, &mut state)?;
    let mut recorder = Recorder::new(&system);
    let (mut rows, mut status) = (Vec::new(), Status::Done);
    for &t in times {
        let mut row = Vec::new();
        state.t = t;
        let found = locate_wheels(&mut solver, &state)
            .and_then(|()| equilibrate(&mut solver, &mut state))
            .and_then(|()| solver.instant(&mut state).map(|_| ()))
            .and_then(|()| recorder.row(&system, solver.geometry(), &state, &mut row));
        if let Err(error) = found {
            status = Status::Failed(t, error);
            break;
        }
        rows.extend(row);
    }
    Ok((History::of(recorder.channels().to_vec(), rows), status))
}

/// The state with the starting displacements and speeds of the bodies.
fn starting(system: &System) -> State {
    let mut state = system.state();
    set(system, &mut state.q, |body| body.start);
    set(system, &mut state.v, |body| body.start_speed);
    state
}

/// Checks that `scene` has a static equilibrium at its start on `foundations`, without integrating it. A scene with a
/// body that starts at a given displacement needs none.
///
/// Whether forces of one-sided contacts can balance the weights does not depend on the stiffness of rails, except
/// through the slopes of rails and the forces of flanges and springs. On [`Foundation::rigid`] the check needs the
/// scene alone. It is left open where a stop or a rope holds a body on wheels: its force follows the rotation of the body,
/// and thereby the rails.
///
/// ```
/// use sim::{Body, Contact, Damper, Error, Foundation, NormalLaw, Scene, Wheel};
///
/// // Both wheels are on one side of the centre of mass.
/// let mut scene = Scene {
///     bodies: vec![Body::new(1000.0, [1.0; 3])],
///     wheels: vec![Wheel::new(0.5, NormalLaw::linear(1e7, 0.0, Damper::Rail))],
///     contacts: vec![Contact::new(0, [1.0, 0.0, 0.0]), Contact::new(0, [2.0, 0.0, 0.0])],
///     ..Scene::default()
/// };
/// scene.bodies[0].free = [false, true, false, false, false, true];
/// scene.gravity = 9.81;
/// let found = sim::check_equilibrium(&scene, &[Foundation::rigid()]);
/// let Err(Error::NoEquilibrium { fall: Some(fall), .. }) = found else { panic!("it stands") };
/// // The end with x < 0 sinks.
/// assert!(fall.body == 0 && fall.motion[5] > 0.0);
/// ```
///
/// # Errors
/// [`Error::NoEquilibrium`], and those of a scene that cannot be set up.
pub fn check_equilibrium(scene: &Scene, foundations: &[Foundation]) -> Result<(), Error> {
    let system = System::new(scene, foundations)?;
    if scene.analysis == Analysis::Dynamic && placed(&system) {
        return Ok(());
    }
    let mut state = system.state();
    set(&system, &mut state.q, |body| body.start);
    let mut solver = Solver::new(&system, RailMemory::Known)?;
    locate_wheels(&mut solver, &state)?;
    place_below_ropes(&mut solver, &mut state)?;
    match equilibrate(&mut solver, &mut state) {
        Err(Error::NoEquilibrium { .. }) if acting_springs(&solver, &state).next().is_some() => {
            Ok(())
        }
        found => found,
    }
}

/// Sets the entries of every body's degrees of freedom to the six values that `of` returns for the body.
fn set(system: &System, values: &mut DVector<f64>, of: impl Fn(&Body) -> [f64; 6]) {
    for (body, numbers) in system
        .scene
        .bodies
        .iter()
        .zip(&system.mechanics.kinematics.numbers)
    {
        for (number, value) in numbers.iter().zip(of(body)) {
            if let Some(number) = *number {
                values[number] = value;
            }
        }
    }
}

/// Whether any body on wheels starts at a given displacement instead of in static equilibrium.
fn placed(system: &System) -> bool {
    system.scene.bodies.iter().enumerate().any(|(b, body)| {
        system.mechanics.wheels.iter().any(|wheel| wheel.body == b)
            && [1, 3, 5]
                .iter()
                .any(|&i| body.free[i] && body.start[i] != 0.0)
    })
}

/// Integrates the equations of motion from `state`, which holds the starting displacements of the scene.
fn integrate(
    stepping: Stepping,
    system: &System,
    solver: &mut Solver,
    mut state: State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, Error> {
    let scene = system.scene;
    begin(system, solver, &mut state)?;
    let first = FIRST * scene.end;
    let mut stepper = Stepper::new(
        solver,
        state,
        stepping,
        LOCAL_PER_GLOBAL * scene.accuracy,
        first,
    )?;
    let step = stepper.step();
    // steps of a fixed length may be far more accurate than the scene asks for
    let accuracy = stepping.step.map_or(scene.accuracy, |_| 0.0);
    let mut samples = Samples::new(step.solver, &step.to, step.propagated(), accuracy)?;
    let mut fired = Vec::new();
    let status = advance(scene, &mut stepper, &mut samples, &mut fired, watch)?;
    let solution = samples.finish();
    Ok(Run {
        history: rows(scene, &solution, matches!(status, Status::Ended(_))),
        status,
        solution,
        fired,
        audit: stepper.audit(),
        counts: stepper.counts(),
        method: Some(stepping.method),
        bounces: stepper.bounces(),
        strike: stepper.strike(),
        abandoned: None,
    })
}

/// Sets `state` to the start of a dynamic run: static equilibrium unless a body has a given displacement, with the
/// starting speeds, and the elements that are active and the forces that act with them.
fn begin(system: &System, solver: &mut Solver, state: &mut State) -> Result<(), Error> {
    let is_placed = placed(system);
    if !is_placed {
        equilibrate(solver, state)?;
    }
    set(system, &mut state.v, |body| body.start_speed);
    if system.traits.is_uneven {
        follow_rigid_rails(solver, state);
    }
    let is_settled = if is_placed {
        settle(solver, state)?
    } else {
        settle_start(solver, state)?
    };
    if is_settled {
        Ok(())
    } else {
        Err(Error::NoEquilibrium {
            time: 0.0,
            fall: None,
        })
    }
}

/// Takes steps to the end of the scene, recording samples at the output times and executing rules; returns how the
/// run ended.
fn advance(
    scene: &Scene,
    stepper: &mut Stepper,
    samples: &mut Samples,
    fired: &mut Vec<Fired>,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Status, Error> {
    let due = stepper.due()?;
    let (now, ends) = stepper.act(due)?;
    fired.extend(now);
    if ends {
        return Ok(ended(scene, fired));
    }
    let mut judged = (0, 0.0);
    for limit in scene.breaks() {
        while stepper.times()[1] < limit * (1.0 - 1e-14) {
            samples.begin(stepper);
            let done = stepper.advance(limit);
            let [from, to] = stepper.times();
            match done {
                Ok(()) => {}
                Err(Failure::TooSmall) => return Ok(Status::StepTooSmall(from)),
                Err(Failure::Refused(error)) => return Ok(Status::Failed(from, error)),
            }
            let due = stepper.due()?;
            samples.take(stepper)?;
            if !due.is_empty() {
                let (now, ends) = match stepper.act(due) {
                    Ok(acted) => acted,
                    Err(error) => return Ok(Status::Failed(to, error)),
                };
                fired.extend(now);
                if ends {
                    return Ok(ended(scene, fired));
                }
            }
            if watch(to).is_break() {
                return Ok(Status::Stopped);
            }
            let stored = samples.stored();
            let expected = stored as f64 * scene.end / to;
            if stored > MANY_VALUES && expected > MOST_VALUES {
                return Ok(Status::TooLarge {
                    time: to,
                    stored,
                    expected,
                });
            }
            let steps = stepper.counts().steps;
            if steps >= judged.0 + JUDGED {
                let latest = (steps - judged.0) as f64 / (to - judged.1);
                let rate = latest.min(steps as f64 / to);
                let expected = rate * (scene.end - to);
                let most = if rate > FAST {
                    0.01 * MOST_STEPS
                } else {
                    MOST_STEPS
                };
                if expected > most {
                    return Ok(Status::TooManySteps {
                        time: to,
                        steps,
                        expected,
                    });
                }
                judged = (steps, to);
            }
        }
    }
    Ok(Status::Done)
}

/// The status after the first rule that ended the run.
fn ended(scene: &Scene, fired: &[Fired]) -> Status {
    let rules = &scene.actuators.rules;
    let last = fired
        .iter()
        .find(|fired| rules[fired.rule].actions.contains(&Action::End));
    last.map_or(Status::Done, |fired| Status::Ended(*fired))
}

/// Rows of a solution at the output times, and at its end where `with_end` asks for it.
fn rows(scene: &Scene, solution: &Solution, with_end: bool) -> History {
    let [_, end] = solution.function().range().unwrap_or_default();
    let mut times = Vec::new();
    let mut next = 0;
    while scene.output_time(next) <= end * (1.0 + SAME_TIME) {
        times.push(scene.output_time(next));
        next += 1;
    }
    if with_end && times.last().is_none_or(|last| *last < end) {
        times.push(end);
    }
    solution.history(times)
}

/// Finds static equilibria from the start to the end, between the times at which a wheel passes a break of its rail or a motion
/// or a load has a corner.
fn sweep(
    system: &System,
    solver: &mut Solver,
    mut state: State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, Error> {
    let scene = system.scene;
    if let Some(body) =
        (0..scene.bodies.len()).find(|&b| system.mechanics.kinematics.numbers[b][0].is_some())
    {
        return Err(Error::NotPrescribed { body });
    }
    let mut counts = Counts::default();
    let mut rest = |t: f64, recorder: &mut Recorder, row: &mut Vec<f64>| -> Result<(), Error> {
        counts.steps += 1;
        state.t = t;
        locate_wheels(solver, &state)?;
        equilibrate(solver, &mut state)?;
        solver.instant(&mut state)?;
        recorder.row(system, solver.geometry(), &state, row)
    };
    let (mut recorder, mut row) = (Recorder::new(system), Vec::new());
    rest(0.0, &mut recorder, &mut row)?;
    let accuracy = REST * scene.accuracy.min(COARSEST);
    let mut builder = SolutionBuilder::new(recorder, accuracy, &row, None);
    let mut rows = vec![row];
    let mut status = Status::Done;
    let mut from = 0.0;
    'all: for limit in scene.breaks() {
        while from < limit {
            let left = (limit - from).min(scene.end / INTERVALS);
            let length = prescribed_break(system, from, left).unwrap_or(left);
            let to = if length >= (limit - from) * (1.0 - 1e-12) {
                limit
            } else {
                from + length
            };
            // rows are solved themselves
            while scene.output_time(rows.len() as u64) <= to {
                let (mut row, t) = (Vec::new(), scene.output_time(rows.len() as u64));
                match rest(t, builder.recorder(), &mut row) {
                    Ok(()) => rows.push(row),
                    Err(error) => {
                        status = Status::Failed(t, error);
                        break 'all;
                    }
                }
            }
            let mut failed = from;
            let mut evaluate = |share: f64, recorder: &mut Recorder, row: &mut Vec<f64>| {
                // each side of a break has values of its own
                let inside = share.clamp(INSIDE, 1.0 - INSIDE);
                failed = from + inside * (to - from);
                rest(failed, recorder, row).map(|()| true)
            };
            match builder.follow([from, to], from == 0.0, &mut evaluate) {
                Ok(()) => {}
                Err(error) => {
                    status = Status::Failed(failed, error);
                    break 'all;
                }
            }
            from = to;
            if watch(from).is_break() {
                status = Status::Stopped;
                break 'all;
            }
        }
    }
    let solution = builder.finish();
    if status == Status::Done
        && let Some(last) = rows.last()
        && last[0] < scene.end
    {
        let mut row = Vec::new();
        solution.row(scene.end, Side::Before, &mut row);
        rows.push(row);
    }
    Ok(Run {
        history: History::of(solution.channels().to_vec(), rows.concat()),
        solution,
        status,
        fired: Vec::new(),
        audit: Audit::default(),
        counts,
        method: None,
        bounces: 0.0,
        strike: None,
        abandoned: None,
    })
}
