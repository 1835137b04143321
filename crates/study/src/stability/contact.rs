//! Methods that solve for contact forces at rest, against the product of wheel stiffness and rail compliance.
//!
//! The exact forces of wheels on springs k solve (G + I/k) F = d, with the compliance G of the rail at the wheels and
//! the imposed displacements d. Three methods that iterate instead are compared with it: a fixed point F <- k (d - G
//! F) over all wheels at once, the same wheel by wheel with the newest forces ("staggered"), and a time integration
//! in which the rail deflects under the forces of the step before. All three converge only where k times the largest
//! eigenvalue of G is less than about 1.

use nalgebra::{DMatrix, DVector};
use sim::Instant;

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::{finite, spread};
use super::subject::MapSubject;
use formats::units::Dimension;
use report::chart::{Series, Style};

/// Methods, in the order of layers.
const METHODS: [&str; 4] = [
    "fixed point",
    "staggered",
    "lag of one step",
    "girderway, direct",
];
/// Passes after which an iteration stops with the forces that it has.
const PASSES: usize = 50;
/// Largest relative error that counts as right.
const ALLOWED: f64 = 1e-6;
/// Smallest relative error that a user certainly notices.
const OBVIOUS: f64 = 1e2;

/// Relative error of the forces after `PASSES` passes of F <- k (d - G F) from F = 0, either of all wheels at once or
/// wheel by wheel with the newest forces; `exact` are the forces that solve the equation.
fn iterated(compliance: &DMatrix<f64>, k: f64, exact: &DVector<f64>, at_once: bool) -> f64 {
    let n = exact.len();
    let d = compliance * exact + exact / k;
    let mut forces = DVector::zeros(n);
    for _ in 0..PASSES {
        if at_once {
            forces = (&d - compliance * &forces) * k;
        } else {
            for i in 0..n {
                let own: f64 = (0..n).map(|j| compliance[(i, j)] * forces[j]).sum();
                forces[i] = k * (d[i] - own);
            }
        }
    }
    (forces - exact).amax() / exact.amax()
}

/// Relative error of the force on a mass at rest after `PASSES` steps of length h, in which the rail deflects under
/// the force of the step before. The force starts a thousandth above its exact value `load`.
fn lagged(compliance: f64, k: f64, mass: f64, load: f64, h: f64) -> f64 {
    let mut z = load * (compliance + 1.0 / k);
    let (mut v, mut force) = (0.0, 1.001 * load);
    for _ in 0..PASSES {
        force = k * (z - compliance * force);
        v += h * (load - force) / mass;
        z += h * v;
    }
    (force - load).abs() / load
}

/// Largest residual of (G + I/k) F = d for the forces F that the simulator solves for, relative to d; its message
/// where it refuses.
fn residual_of_simulator(
    subject: &MapSubject<'_>,
    offsets: &[f64],
    k: f64,
    x: f64,
    compliance: &DMatrix<f64>,
) -> Result<f64, String> {
    let even = DVector::from_element(offsets.len(), subject.load);
    let d = (compliance * &even)[0] + subject.load / k;
    // the body neither pitches nor rolls: all wheels have the same displacement d, and their loads are not even
    let law = subject.linear(k, 0.0);
    let scene = subject
        .crossing(subject.mass(), offsets, law, [x, 0.0, 1.0])
        .map_err(|e| e.to_string())?;
    let mut displacement = [0.0; 6];
    (displacement[0], displacement[1]) = (x, -d);
    let instant = Instant {
        time: 0.0,
        displacement: vec![displacement],
        speed: vec![[0.0; 6]],
        spin: vec![0.0; offsets.len()],
        penetration: vec![None; offsets.len()],
    };
    let solved = sim::contact_forces(&scene, &[subject.foundation()], &[instant])
        .map_err(|e| e.to_string())?;
    let forces = DVector::from_vec(
        solved
            .into_iter()
            .next()
            .map(|own| own.vertical)
            .unwrap_or_default(),
    );
    if forces.len() != offsets.len() {
        return Err("no forces".to_owned());
    }
    let residual = compliance * &forces + &forces / k - DVector::from_element(offsets.len(), d);
    Ok(residual.amax() / d.abs())
}

/// The compliance of the rail under some wheels, and its largest eigenvalue.
fn compliance_at(subject: &MapSubject<'_>, offsets: &[f64], x: f64) -> Option<(DMatrix<f64>, f64)> {
    let at: Vec<f64> = offsets.iter().map(|own| x + own).collect();
    let compliance = subject.compliance(subject.surface, &at)?;
    let largest = compliance.clone().symmetric_eigenvalues().amax();
    Some((compliance, largest))
}

/// Errors of the four methods of [`METHODS`] for wheels of the stiffness `k` at the place `x`.
fn errors(
    subject: &MapSubject<'_>,
    offsets: &[f64],
    k: f64,
    x: f64,
    compliance: &DMatrix<f64>,
) -> [Result<f64, String>; 4] {
    let exact = DVector::from_element(offsets.len(), subject.load);
    let count = offsets.len() as f64;
    [
        Ok(iterated(compliance, k, &exact, true)),
        Ok(iterated(compliance, k, &exact, false)),
        Ok(lagged(
            compliance.mean(),
            k * count,
            subject.mass() * count,
            subject.load * count,
            1e-4,
        )),
        residual_of_simulator(subject, offsets, k, x, compliance),
    ]
}

/// The layers of all methods for wheels at `offsets`; `who` is the name of these wheels in the map.
fn layers(
    subject: &MapSubject<'_>,
    who: &str,
    offsets: &[f64],
    places: &[f64],
    stiffnesses: &[f64],
) -> Vec<MapLayer> {
    let mut layers: Vec<MapLayer> = METHODS
        .iter()
        .map(|name| MapLayer::new(format!("{name}, {who}"), name.starts_with("girderway")))
        .collect();
    let mut line = Vec::new();
    for &x in places {
        let Some((compliance, largest)) = compliance_at(subject, offsets, x) else {
            continue;
        };
        line.push([x, 1.0 / largest]);
        for &k in stiffnesses {
            let all = errors(subject, offsets, k, x, &compliance);
            for (index, (layer, result)) in layers.iter_mut().zip(all).enumerate() {
                // the lagged run starts with an error of 1e-3, which must not grow but need not have decayed
                let allowed = if index == 2 { 1e-3 } else { ALLOWED };
                let (value, verdict) = match result {
                    Ok(error) => (error, MapVerdict::of(error, allowed, OBVIOUS)),
                    Err(why) => (0.0, MapVerdict::Refused(why)),
                };
                layer.points.push(MapPoint {
                    at: [x, k],
                    value: finite(value),
                    verdict,
                });
            }
        }
    }
    let line = Series::new("k G = 1", Style::Line, within(line, stiffnesses));
    layers
        .iter_mut()
        .for_each(|layer| layer.lines.push(line.clone()));
    layers
}

/// The map of wheel stiffness against place, for one wheel and, where the scene's truck has several, for the truck.
#[must_use]
pub fn map(subject: &MapSubject<'_>, points: usize) -> StabilityMap {
    let axes = [
        MapScale::new(
            "position along the rail",
            &subject.unit(Dimension::LENGTH),
            false,
        ),
        MapScale::new(
            "stiffness of a wheel",
            &subject.unit(Dimension::STIFFNESS),
            true,
        ),
    ];
    let mut map = StabilityMap::new(
        "contact",
        "Methods of solving for contact forces",
        axes,
        "Forces at rest after 50 passes or steps, compared with the solution of (G + I/k) F = d. On the line, k \
         times the largest eigenvalue of G is 1.",
    );
    let both: [(&str, Vec<f64>); 2] =
        [("one wheel", vec![0.0]), ("truck", subject.offsets.clone())];
    let stiffnesses = spread(1e-3 * subject.stiffness, 1e3 * subject.stiffness, points);
    let places: Vec<f64> = (0..points)
        .map(|i| subject.span[0] + subject.length() * (i as f64 + 0.5) / points as f64)
        .collect();
    for (who, offsets) in both
        .iter()
        .take(if subject.offsets.len() > 1 { 2 } else { 1 })
    {
        let gain = |x: f64| Some(subject.stiffness * compliance_at(subject, offsets, x)?.1);
        let mid = 0.5 * (subject.span[0] + subject.span[1]);
        if let Some(gain) = gain(mid) {
            map.note(
                format!("{who}: k times the largest eigenvalue of G at midspan"),
                gain,
            );
        }
        if let Some(x) = first_crossing_of_one(subject, &|x| gain(x).unwrap_or(f64::NAN)) {
            map.note(format!("{who}: distance from the support where it is 1"), x);
        }
        map.layers
            .extend(layers(subject, who, offsets, &places, &stiffnesses));
    }
    map
}

/// The points of a line whose ordinates lie between the first and the last of the ascending `values`.
fn within(line: Vec<[f64; 2]>, values: &[f64]) -> Vec<[f64; 2]> {
    let (low, high) = (
        values.first().copied().unwrap_or(0.0),
        values.last().copied().unwrap_or(f64::MAX),
    );
    line.into_iter()
        .filter(|own| (low..=high).contains(&own[1]))
        .collect()
}

/// Distance from the first support at which `value`, which grows towards midspan, reaches 1, by bisection; `None`
/// where it does not cross 1 between support and midspan.
fn first_crossing_of_one(subject: &MapSubject<'_>, value: &dyn Fn(f64) -> f64) -> Option<f64> {
    let mid = 0.5 * subject.length();
    let (mut low, mut high) = (0.0, mid);
    let at = |distance: f64| value(subject.span[0] + distance);
    let is_bracketed = at(low) < 1.0 && at(high) > 1.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle) < 1.0 {
            low = middle
        } else {
            high = middle
        }
    }
    is_bracketed.then_some(low)
}
