//! Loss of contact of a rigid mass that crosses a beam without mass (the problem of Willis and Stokes).
//!
//! The beam deflects by y = g(s) F under the mass, at the fraction s = v t / L of the span. With y and F relative to
//! the static midspan deflection S = P L^3 / 48 E I and to the weight P, the motion is y'' = 16 beta (1 - F), beta =
//! g L^2 / (16 v^2 S). For small beta the force becomes negative before the end of the span: the mass leaves the
//! rail. A simulator whose contact can pull continues without a message; with a one-sided contact, contact is lost at
//! the same position.

use std::ops::ControlFlow;

use sim::{Channel, Status};

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::spread;
use super::subject::MapSubject;
use report::chart::{Series, Style};

/// Error of the largest midspan deflection, relative to the static one, that counts as right.
const ALLOWED: f64 = 2e-3;
/// An error above all errors of this map, which has no verdict of divergence.
const OBVIOUS: f64 = 1e3;
/// Runge-Kutta steps of the reference over the span.
const STEPS: usize = 40_000;
/// Fraction of the span at which a passage ends.
const LAST: f64 = 0.98;
/// Number of samples of a passage.
const SAMPLES: f64 = 4000.0;
/// Stiffness of a wheel relative to that of the span at midspan: practically rigid.
const RIGID: f64 = 3e4;

/// One passage of the mass.
#[derive(Clone, Copy, Debug)]
struct Passage {
    /// Largest midspan deflection relative to the static one S, before contact is lost.
    factor: f64,
    /// Fraction of the span at which the force becomes negative; 1 where it does not.
    lost: f64,
}

/// Deflection at x under a force at z, both fractions of a simply supported span, relative to the deflection at
/// midspan under the same force there.
fn flexibility(x: f64, z: f64) -> f64 {
    let (a, c) = if x < z { (x, z) } else { (z, x) };
    let q = 1.0 - c;
    8.0 * a * q * (1.0 - a * a - q * q)
}

/// The passage by Runge-Kutta 4 with [`STEPS`] equal steps: y'' = 16 beta (1 - F), F = y / g(s).
///
/// # Source
/// G. G. Stokes, Discussion of a differential equation relating to the breaking of railway bridges, Trans. Cambridge
/// Phil. Soc. 8 (1849), 707-735: with beta = g L^2 / (16 v^2 S).
fn reference(beta: f64) -> Passage {
    let h = 1.0 / STEPS as f64;
    let force = |s: f64, y: f64| {
        let own = flexibility(s, s);
        if own > 1e-12 { y / own } else { 1.0 }
    };
    let slope = |s: f64, [y, v]: [f64; 2]| [v, 16.0 * beta * (1.0 - force(s, y))];
    // near the support g = 16 s^2 (0/0 in F): a path that begins level has y = 16 F s^2, so 32 F = 16 beta (1 - F)
    let mut s = (1e-3 / h).round() * h;
    let own = beta / (beta + 2.0);
    let mut state = [16.0 * own * s * s, 32.0 * own * s];
    let mut out = Passage {
        factor: 0.0,
        lost: 1.0,
    };
    while s < LAST {
        let add = |a: [f64; 2], b: [f64; 2], by: f64| [a[0] + by * b[0], a[1] + by * b[1]];
        let k1 = slope(s, state);
        let k2 = slope(s + 0.5 * h, add(state, k1, 0.5 * h));
        let k3 = slope(s + 0.5 * h, add(state, k2, 0.5 * h));
        let k4 = slope(s + h, add(state, k3, h));
        for i in 0..2 {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        s += h;
        if state[0] < 0.0 {
            out.lost = s;
            break;
        }
        out.factor = out.factor.max(force(s, state[0]) * flexibility(0.5, s));
    }
    out
}

/// The passage by the simulator, on a stiff wheel whose contact can pull where `pulls`, and the smallest force
/// relative to the weight.
fn simulated(subject: &MapSubject<'_>, beta: f64, pulls: bool) -> Result<(Passage, f64), String> {
    let length = subject.length();
    let mid = 0.5 * (subject.span[0] + subject.span[1]);
    let midspan = subject.flexibility(mid);
    let mass = subject.mass();
    let speed = (subject.gravity * length * length / (16.0 * beta * subject.load * midspan)).sqrt();
    let stiffness = RIGID / midspan;
    // half of critical damping: oscillations of the wheel itself decay
    let damping = (stiffness * mass).sqrt();
    let law = sim::NormalLaw {
        bilateral: pulls,
        damper: sim::Damper::Rail,
        ..subject.linear(stiffness, damping)
    };
    let scene = subject.crossing(
        mass,
        &[0.0],
        law,
        [subject.span[0], speed, LAST * length / speed],
    );
    let mut scene = scene.map_err(|error| error.to_string())?;
    scene.output_dt = scene.end / SAMPLES;
    let probe = splines::Probe {
        rail: 0,
        x: mid,
        axis: splines::Axis::Vertical,
    };
    scene.gauges.push(sim::Gauge {
        structure: 0,
        probe,
    });
    let run = sim::run(&scene, &[subject.foundation()], &mut |_| {
        ControlFlow::Continue(())
    });
    let run = run.map_err(|error| error.to_string())?;
    if run.status != Status::Done {
        return Err(results::run_error::status(&run.status)
            .1
            .unwrap_or_default());
    }
    let static_deflection = subject.load * midspan;
    let forces = run.history.column(Channel::Vertical(0));
    let first = forces.iter().position(|force| *force <= 0.0);
    let gauge = run.history.column(Channel::Gauge(0));
    let until = gauge.iter().take(first.unwrap_or(gauge.len()));
    let deepest = until.fold(0.0_f64, |most, own| most.max(-own));
    let lost = first.map_or(1.0, |at| LAST * at as f64 / (forces.len() - 1) as f64);
    let least = forces.iter().fold(f64::MAX, |least, own| least.min(*own)) / subject.load;
    Ok((
        Passage {
            factor: deepest / static_deflection,
            lost,
        },
        least,
    ))
}

/// The map of the place where contact is lost against beta, and factors at five values of beta as numbers.
#[must_use]
pub fn map(subject: &MapSubject<'_>, points: usize) -> StabilityMap {
    let axes = [
        MapScale::new("beta = g L^2 / (16 v^2 S)", "", true),
        MapScale::new("position of loss of contact / span (1: none)", "", false),
    ];
    let mut map = StabilityMap::new(
        "lift-off",
        "Loss of contact of a rigid mass that crosses a beam without mass",
        axes,
        "Compared with Stokes' equation, integrated by 40,000 steps of Runge-Kutta 4. A bilateral contact pulls the \
         wheel down after contact should be lost: wrong. The one-sided contact is right if it never pulls, the \
         deflection before the loss of contact is within 2e-3 of the static one, and the position of the loss is \
         within 1e-2 of the span. The passage ends at 0.98 of the span; the wheel is 30,000 times as stiff as the \
         span.",
    );
    for beta in [100.0, 25.0, 10.0, 5.0, 2.0] {
        let right = reference(beta);
        let own = simulated(subject, beta, false);
        for (who, passage) in [
            ("Stokes", Some(right)),
            ("girderway", own.ok().map(|own| own.0)),
        ] {
            let Some(passage) = passage else { continue };
            map.note(format!("{who}: factor at beta {beta}"), passage.factor);
            if passage.lost < 1.0 {
                map.note(
                    format!("{who}: x/L of lift-off at beta {beta}"),
                    passage.lost,
                );
            }
        }
    }
    let mut layers = [("bilateral contact", false), ("girderway, one-sided", true)]
        .map(|(method, ours)| MapLayer::new(method, ours));
    let mut lost = Vec::new();
    for beta in spread(1.0, 200.0, points) {
        let right = reference(beta);
        lost.push([beta, right.lost]);
        for (layer, pulls) in layers.iter_mut().zip([true, false]) {
            let (at, value, verdict) = match simulated(subject, beta, pulls) {
                Ok((own, least)) => {
                    let apart = (own.factor - right.factor)
                        .abs()
                        .max(0.2 * (own.lost - right.lost).abs());
                    let error = if least < -1e-6 { 1.0 } else { apart };
                    (own.lost, error, MapVerdict::of(error, ALLOWED, OBVIOUS))
                }
                Err(why) => (right.lost, 0.0, MapVerdict::Refused(why)),
            };
            layer.points.push(MapPoint {
                at: [beta, at],
                value,
                verdict,
            });
        }
    }
    let line = Series::new("by Stokes' equation", Style::Line, lost);
    layers
        .iter_mut()
        .for_each(|layer| layer.lines.push(line.clone()));
    map.layers.extend(layers);
    map
}
