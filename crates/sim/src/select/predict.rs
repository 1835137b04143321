//! Prediction of the errors of the fidelities from the scene alone, before any dynamic run.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use splines::{Axis, Probe};

use super::distance::distance;
use super::fidelity::{Fidelity, MODES, contact_frequency};
use crate::run::run;
use crate::scene::wheel::LawValue;
use crate::{Analysis, BodyDof, Channel, Error, Extent, Foundation, Run, Scene, Structure};

/// Number of intervals of the quasi-static sweep, and of intervals per rail at which the mode shapes are sampled.
const SAMPLES: usize = 32;
const PLACES: usize = 64;
/// Upper limit of predicted errors; larger errors are not distinguished.
const MOST: f64 = 10.0;

/// Predicted relative errors of the fidelities of one structure, in the measure of [`distance`].
///
/// Here alpha = v k / omega of a mode (k = max |phi'| / max |phi| along the rail; v / (2 L f_1) for a simply
/// supported girder), r = (omega_b / omega)^2 (omega_b: frequency of a body on its contacts and the compliance of the
/// rail), p is the fraction of the vertical displacement of a wheel that is deflection of the rail, s is the fraction
/// of the deflection due to the modes left out, and T is the duration of the run:
#[derive(Clone, Debug, PartialEq)]
pub struct PredictedErrors {
    /// Error of a rigid structure: the difference between quasi-static sweeps without and with the deflection.
    pub deflection: f64,
    /// alpha / (1 - alpha) of the first mode: the error of the influence fidelity during a crossing.
    pub speed: f64,
    /// p (r / (1 - r) + r omega_b T / 2) of the first mode, times the fraction of the force that oscillates.
    pub ripple: f64,
    /// Changes of the loads relative to the weight, times p of the first mode, times T_1 / (pi ramp) limited to 1,
    /// times r limited to 1.
    pub step: f64,
    /// 1 - sqrt(1 - theta^2), where theta is the largest alpha of a mode: the error of the static deflection compared
    /// with the deflection under a load that moves along a track.
    pub track: f64,
    /// Predicted errors of rigid, influence and numbers of modes, in ascending order of cost.
    pub errors: Vec<(Fidelity, f64)>,
    /// Whether the structure is excited by nothing other than its wheels, their loads and their motion.
    pub is_complete: bool,
}

impl PredictedErrors {
    /// Predicted error of the fidelity `fidelity`; `None` where it was not predicted.
    #[must_use]
    pub fn of(&self, fidelity: Fidelity) -> Option<f64> {
        self.errors.iter().find(|(own, _)| *own == fidelity).map(|(_, error)| *error)
    }
}

/// Frequency and largest relative slope of a mode along the rails.
struct Mode {
    omega: f64,
    /// max |phi'| / max |phi|.
    k: f64,
}

/// Predicts the errors of the fidelities of `structure`. Two quasi-static sweeps of the scene, with the structure at
/// influence and rigid, yield the static deflections, forces and wheel positions. From these and the frequencies and
/// shapes of the lowest modes, the function estimates the error of neglecting the inertia of all modes from a given
/// one on. `foundations` contains the structure at influence, and `motion` its lowest modes. Returns `None` where a
/// sweep fails, or where the wheels on the structure carry no load.
pub(super) fn predict(
    scene: &Scene,
    foundations: &mut [Foundation],
    structure: usize,
    motion: &Structure,
) -> Option<PredictedErrors> {
    let soft = sweep(scene, foundations).ok()?;
    let rails = foundations[structure].rails.clone();
    let Foundation { carrier: on, irregularities, .. } = &foundations[structure];
    let (on, irregularities) = (on.clone(), irregularities.clone());
    let rigid = Foundation { rails, carrier: on, irregularities, ..Foundation::rigid() };
    let own = std::mem::replace(&mut foundations[structure], rigid);
    let hard = sweep(scene, foundations);
    foundations[structure] = own;
    let give = distance(&hard.ok()?, &soft, scene).min(MOST);
    let crossing = Crossing::of(scene, structure, &soft)?;
    let modes = modes(motion, &foundations[structure].rails)?;
    let shares = shares(motion, &crossing.places)?;
    let load = steps(scene);

    let turn = crossing.speed * modes[0].k;
    let beta = (turn / crossing.omega).min(1.0);
    // The deflection under a wheel that crosses a girder grows with the square of time, so the excitation is
    // proportional to beta^2.
    let oscillating =
        crossing.share * beta * beta + load.share * (2.0 / (crossing.omega * load.ramp)).min(1.0);
    let rigid = give * (1.0 + turn * crossing.damping);
    // Errors after the first `kept` modes are modelled: speed, ripple, step, track, and the resulting error of
    // heights and forces.
    let left = |kept: usize| -> Option<[f64; 5]> {
        let (mode, s) = (modes.get(kept)?, *shares.get(kept)?);
        let alpha = |mode: &Mode| crossing.speed * mode.k / mode.omega;
        let a = alpha(mode);
        let speed = if a < 1.0 { (a / (1.0 - a)).min(MOST) } else { MOST };
        let theta = modes[kept..].iter().map(alpha).fold(0.0, f64::max);
        let track = 1.0 - (1.0 - theta * theta).max(0.0).sqrt();
        let r = (crossing.omega / mode.omega).powi(2);
        let resonance = if r < 0.5 { r / (1.0 - r) } else { 1.0 };
        let p = crossing.share * s;
        let phase = 0.5 * r * p * crossing.omega * scene.end;
        let ripple = oscillating * (p * resonance + phase).min(2.0);
        let ramp = (2.0 / (mode.omega * load.ramp)).min(1.0);
        let step = load.share * p * ramp * r.min(1.0);
        let damper = 1.0 + mode.omega * crossing.damping;
        let force = crossing.softness * damper * (mode.omega / crossing.contact).powi(2).min(1.0);
        let weight = crossing.share.max(force) * s;
        Some([speed, ripple, step, track, weight * speed.max(track) + ripple + step])
    };
    let [speed, ripple, step, track, influence] = left(0)?;
    let mut errors = vec![(Fidelity::Rigid, rigid), (Fidelity::Influence, influence)];
    errors.extend(MODES.iter().filter_map(|&m| Some((Fidelity::Modal(m), left(m)?[4]))));
    errors.iter_mut().for_each(|(_, error)| *error = error.min(MOST));
    let is_complete = is_complete(scene, foundations);
    let are_known = errors.iter().all(|(_, error)| error.is_finite());
    are_known.then_some(PredictedErrors { deflection: give, speed, ripple, step, track, errors, is_complete })
}

/// Whether the predictors cover everything that excites the structure.
fn is_complete(scene: &Scene, foundations: &[Foundation]) -> bool {
    let Scene { actuators, bodies, .. } = scene;
    let steady = |profile: &crate::Profile| profile.breaks().iter().all(|&t| t >= scene.end);
    let plain = |f: &Foundation| {
        f.carrier.is_none() && f.parts.is_none() && f.irregularities.is_empty() && !f.is_loaded_along
    };
    foundations.iter().all(plain)
        && actuators.drives.is_empty()
        && actuators.brakes.is_empty()
        && actuators.ropes.is_empty()
        && actuators.stops.is_empty()
        && actuators.spins.is_empty()
        && actuators.rules.is_empty()
        && actuators.loads.iter().all(|load| load.dof == BodyDof::Y)
        && scene.wheels.iter().all(|wheel| wheel.flange.is_none() && wheel.friction.is_none())
        && bodies.iter().all(|body| {
            body.start[1..].iter().chain(&body.start_speed).all(|value| *value == 0.0)
                && body.motion.as_ref().is_some_and(|profile| steady(profile) && profile.at(0.0).a == 0.0)
        })
}

/// Quasi-static sweep over the duration of the run.
fn sweep(scene: &Scene, foundations: &[Foundation]) -> Result<Run, Error> {
    let (analysis, output_dt) = (Analysis::QuasiStatic, scene.end / SAMPLES as f64);
    let still = Scene { analysis, output_dt, ..scene.clone() };
    run(&still, foundations, &mut |_| ControlFlow::Continue(()))
}

/// Quantities of the wheels on one structure, taken from the quasi-static sweep.
struct Crossing {
    /// Largest speed of a wheel.
    speed: f64,
    /// Largest fraction of the rail deflection in the vertical displacement of a wheel, and largest ratio of
    /// deflection to penetration.
    share: f64,
    softness: f64,
    /// Highest frequency of a body on its contacts and the compliance of the rail, and on its contacts alone.
    omega: f64,
    contact: f64,
    /// Largest c / k of a damper between wheel and rail.
    damping: f64,
    /// Positions of the wheels.
    places: Vec<Probe>,
}

impl Crossing {
    fn of(scene: &Scene, structure: usize, soft: &Run) -> Option<Crossing> {
        let contacts = scene.contacts.iter().flat_map(|contact| contact.offsets.iter().map(move |_| contact));
        let (mut share, mut softness, mut speed, mut damping) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut stiffness = vec![0.0; scene.bodies.len()];
        let mut places = Vec::new();
        let dt = scene.end / SAMPLES as f64;
        for (w, contact) in contacts.enumerate().filter(|(_, contact)| contact.structure == structure) {
            let column = |channel| soft.history.column(channel);
            let [x, force] = [column(Channel::Position(w)), column(Channel::Vertical(w))];
            let [give, penetration] = [column(Channel::Deflection(w)), column(Channel::Penetration(w))];
            for pair in x.windows(2) {
                speed = speed.max((pair[1] - pair[0]).abs() / dt);
            }
            let mut stiffest = 0.0_f64;
            for i in (0..x.len()).filter(|&i| force[i] > 0.0 && penetration[i] > 0.0) {
                let give = give[i].max(0.0);
                share = share.max(give / (give + penetration[i]));
                softness = softness.max(give / penetration[i]);
                let law = &scene.wheels[contact.wheel].normal;
                let LawValue { by_penetration: k, by_rate: c, .. } = law.at(penetration[i], 0.0);
                if law.has_memory() {
                    damping = damping.max(c / k);
                }
                stiffest = stiffest.max(1.0 / (1.0 / k + give / force[i]));
            }
            stiffness[contact.body] += stiffest;
            places.extend(x.iter().map(|&x| Probe { rail: contact.rail, x, axis: Axis::Vertical }));
        }
        let bodies = scene.bodies.iter().zip(stiffness);
        let omega = bodies.map(|(body, k)| (k / body.mass).sqrt()).fold(0.0, f64::max);
        let contact = contact_frequency(scene, structure);
        (omega > 0.0 && contact > 0.0).then_some(Crossing {
            speed,
            share,
            softness,
            omega,
            contact,
            damping,
            places,
        })
    }
}

fn modes(motion: &Structure, rails: &[Extent]) -> Option<Vec<Mode>> {
    let omega = motion.dynamics.frequencies();
    let n = omega.len();
    let (mut value, mut slope) = (vec![0.0; n], vec![0.0; n]);
    let (mut values, mut slopes) = (vec![0.0_f64; n], vec![0.0_f64; n]);
    for (rail, extent) in rails.iter().enumerate() {
        let [from, to] = extent.range?;
        for i in 0..=PLACES {
            let x = from + (to - from) * i as f64 / PLACES as f64;
            motion.shapes.row(Probe { rail, x, axis: Axis::Vertical }, &mut value, &mut slope).ok()?;
            for j in 0..n {
                values[j] = values[j].max(value[j].abs());
                slopes[j] = slopes[j].max(slope[j].abs());
            }
        }
    }
    let k = |j: usize| if values[j] > 0.0 { slopes[j] / values[j] } else { 0.0 };
    (n > 0).then(|| (0..n).map(|j| Mode { omega: omega[j], k: k(j) }).collect())
}

/// Largest deflection at `places` due to the modes from the i-th on, relative to that of all modes, one entry per
/// number of modes removed. Modes beyond those of `motion` are not included.
fn shares(motion: &Structure, places: &[Probe]) -> Option<Vec<f64>> {
    let omega = motion.dynamics.frequencies();
    let n = omega.len();
    let (mut value, mut slope, mut out) = (vec![0.0; n], vec![0.0; n], vec![0.0_f64; n + 1]);
    for &place in places {
        motion.shapes.row(place, &mut value, &mut slope).ok()?;
        let mut rest = 0.0;
        for j in (0..n).rev() {
            rest += (value[j] / omega[j]).powi(2);
            out[j] = out[j].max(rest);
        }
    }
    let most = out[0];
    (most > 0.0).then(|| out.into_iter().map(|rest| rest / most).collect())
}

/// Changes of the loads over time.
struct Steps {
    /// Largest sum of load changes on one body, relative to its weight.
    share: f64,
    /// Duration of the shortest load change, > 0.
    ramp: f64,
}

fn steps(scene: &Scene) -> Steps {
    let (mut share, mut ramp) = (0.0_f64, f64::INFINITY);
    for (b, body) in scene.bodies.iter().enumerate() {
        let mut sum = 0.0;
        for load in scene.actuators.loads.iter().filter(|load| load.body == b) {
            let mut times: Vec<f64> = load.value.breaks().filter(|&t| t > 0.0 && t < scene.end).collect();
            times.extend([0.0, scene.end]);
            times.sort_by(f64::total_cmp);
            for pair in times.windows(2).filter(|pair| pair[1] > pair[0]) {
                let change = (load.value.at(pair[1]) - load.value.at(pair[0])).abs();
                sum += change;
                if change > 0.0 {
                    ramp = ramp.min(pair[1] - pair[0]);
                }
            }
        }
        share = share.max(sum / (body.mass * scene.gravity).max(f64::MIN_POSITIVE));
    }
    Steps { share: share.min(MOST), ramp: if ramp.is_finite() { ramp } else { PI * scene.end } }
}
