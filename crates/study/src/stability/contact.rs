//! Stiffness by give against divergence: how contact forces are found.

use nalgebra::{DMatrix, DVector};
use sim::Instant;

use super::map::{Layer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::{finite, spread};
use super::subject::MapSubject;
use formats::units::Dimension;
use report::chart::{Series, Style};

/// Passes of an iteration that then takes what it has.
const PASSES: usize = 50;
/// Error that is none, and one that nobody overlooks.
const ALLOWED: f64 = 1e-6;
const OBVIOUS: f64 = 1e2;

/// Error of `PASSES` passes of F <- k (d - G F) from nothing: all wheels at once, or each with the newest forces.
fn iterated(give: &DMatrix<f64>, k: f64, wanted: &DVector<f64>, at_once: bool) -> f64 {
    let n = wanted.len();
    let d = give * wanted + wanted / k;
    let mut forces = DVector::zeros(n);
    for _ in 0..PASSES {
        if at_once {
            forces = (&d - give * &forces) * k;
        } else {
            for i in 0..n {
                let own: f64 = (0..n).map(|j| give[(i, j)] * forces[j]).sum();
                forces[i] = k * (d[i] - own);
            }
        }
    }
    (forces - wanted).amax() / wanted.amax()
}

/// Error of the force on a mass at rest after `PASSES` steps of length h, the rail's deflection that of the force one step
/// ago; it starts a thousandth off.
fn lagged(give: f64, k: f64, mass: f64, load: f64, h: f64) -> f64 {
    let mut z = load * (give + 1.0 / k);
    let (mut v, mut force) = (0.0, 1.001 * load);
    for _ in 0..PASSES {
        force = k * (z - give * force);
        v += h * (load - force) / mass;
        z += h * v;
    }
    (force - load).abs() / load
}

/// Error of the program's forces, or its message.
fn ours(
    subject: &MapSubject<'_>,
    offsets: &[f64],
    k: f64,
    x: f64,
    give: &DMatrix<f64>,
) -> Result<f64, String> {
    let wanted = DVector::from_element(offsets.len(), subject.load);
    let d = (give * &wanted)[0] + subject.load / k;
    // a body that neither turns nor tilts has one displacement: forces of it, not of even loads
    let law = subject.linear(k, 0.0);
    let scene = subject.crossing(subject.mass(), offsets, law, [x, 0.0, 1.0]).map_err(|e| e.to_string())?;
    let mut displacement = [0.0; 6];
    (displacement[0], displacement[1]) = (x, -d);
    let instant = Instant {
        time: 0.0,
        displacement: vec![displacement],
        speed: vec![[0.0; 6]],
        spin: vec![0.0; offsets.len()],
        penetration: vec![None; offsets.len()],
    };
    let found =
        sim::contact_forces(&scene, &[subject.foundation()], &[instant]).map_err(|e| e.to_string())?;
    let forces = DVector::from_vec(found.into_iter().next().map(|own| own.vertical).unwrap_or_default());
    if forces.len() != offsets.len() {
        return Err("no forces".to_owned());
    }
    // what is left of (G + I/k) F = d
    let left = give * &forces + &forces / k - DVector::from_element(offsets.len(), d);
    Ok(left.amax() / d.abs())
}

/// The map.
#[must_use]
pub fn map(subject: &MapSubject<'_>, points: usize) -> StabilityMap {
    let axes = [
        MapScale::new("place along the rail", &subject.unit(Dimension::LENGTH), false),
        MapScale::new("stiffness of a wheel", &subject.unit(Dimension::STIFFNESS), true),
    ];
    let mut map = StabilityMap::new(
        "contact",
        "Ways to find contact forces",
        axes,
        "Forces at rest after 50 passes or steps, against (G + I/k) F = d; the line is k times the largest eigenvalue of G = 1.",
    );
    let both: [(&str, Vec<f64>); 2] = [("one wheel", vec![0.0]), ("truck", subject.offsets.clone())];
    let stiffnesses = spread(1e-3 * subject.stiffness, 1e3 * subject.stiffness, points);
    let places: Vec<f64> =
        (0..points).map(|i| subject.span[0] + subject.length() * (i as f64 + 0.5) / points as f64).collect();
    for (who, offsets) in both.iter().take(if subject.offsets.len() > 1 { 2 } else { 1 }) {
        let of = |x: f64| {
            let at: Vec<f64> = offsets.iter().map(|own| x + own).collect();
            let give = subject.give(subject.surface, &at)?;
            let largest = give.clone().symmetric_eigenvalues().amax();
            Some((give, largest))
        };
        let mid = 0.5 * (subject.span[0] + subject.span[1]);
        if let Some((_, largest)) = of(mid) {
            map.find(
                format!("{who}: k times the largest eigenvalue of G at midspan"),
                subject.stiffness * largest,
            );
        }
        if let Some(x) = reach(subject, &|x| of(x).map_or(f64::NAN, |own| subject.stiffness * own.1)) {
            map.find(format!("{who}: distance from the support where it is 1"), x);
        }
        let methods = ["fixed point", "staggered", "lag of one step", "girderway, direct"];
        let mut layers: Vec<Layer> = methods
            .iter()
            .map(|name| Layer::new(format!("{name}, {who}"), name.starts_with("girderway")))
            .collect();
        let mut line = Vec::new();
        for &x in &places {
            let Some((give, largest)) = of(x) else { continue };
            line.push([x, 1.0 / largest]);
            let wanted = DVector::from_element(offsets.len(), subject.load);
            for &k in &stiffnesses {
                let load = subject.load * offsets.len() as f64;
                let found = [
                    Ok(iterated(&give, k, &wanted, true)),
                    Ok(iterated(&give, k, &wanted, false)),
                    Ok(lagged(
                        give.mean(),
                        k * offsets.len() as f64,
                        subject.mass() * offsets.len() as f64,
                        load,
                        1e-4,
                    )),
                    ours(subject, offsets, k, x, &give),
                ];
                for (index, (layer, found)) in layers.iter_mut().zip(found).enumerate() {
                    // what a lag leaves of its start: it need not have come to rest, but not have grown
                    let allowed = if index == 2 { 1e-3 } else { ALLOWED };
                    let (value, verdict) = match found {
                        Ok(error) => (error, MapVerdict::of(error, allowed, OBVIOUS)),
                        Err(why) => (0.0, MapVerdict::Refused(why)),
                    };
                    layer.cells.push(MapPoint { at: [x, k], value: finite(value), verdict });
                }
            }
        }
        let line = Series::new("k G = 1", Style::Line, inside(line, &stiffnesses));
        layers.iter_mut().for_each(|layer| layer.lines.push(line.clone()));
        map.layers.extend(layers);
    }
    map
}

/// The points of a line between the least and the largest of `values`.
fn inside(line: Vec<[f64; 2]>, values: &[f64]) -> Vec<[f64; 2]> {
    let (low, high) = (values.first().copied().unwrap_or(0.0), values.last().copied().unwrap_or(f64::MAX));
    line.into_iter().filter(|own| (low..=high).contains(&own[1])).collect()
}

/// Distance from the first support to where `value` first reaches 1.
fn reach(subject: &MapSubject<'_>, value: &dyn Fn(f64) -> f64) -> Option<f64> {
    let mid = 0.5 * subject.length();
    let (mut low, mut high) = (0.0, mid);
    let at = |share: f64| value(subject.span[0] + share);
    let starts_below = at(low) < 1.0 && at(high) > 1.0;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle) < 1.0 { low = middle } else { high = middle }
    }
    starts_below.then_some(low)
}
