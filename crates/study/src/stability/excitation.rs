//! Tables that are not symmetric: bogies that shake themselves.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, Matrix2, Matrix4};
use sim::{Channel, Foundation, Freedom};
use splines::check::{Strip, work};
use splines::{Axis, Compliance, Kind, Reading, Sheet};

use super::map::{Layer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::spread;
use super::subject::MapSubject;
use formats::units::Dimension;
use foundations::influence_blocks;
use results::warning::RESIDUAL;

/// Growth, 1/time by the frequency of the wheels on their springs, that is none.
const NONE: f64 = 1e-9;

/// Time of a run by that of growth by e.
const EFOLDINGS: f64 = 6.0;
/// Speed that a bogie is struck with, by gravity and the frequency of its wheels.
const STRUCK: f64 = 1e-2;

/// A body on two wheels at rest.
#[derive(Clone, Copy)]
struct Bogie {
    /// Place of the middle between the wheels.
    x: f64,
    /// How far the centre of mass is from there.
    offset: f64,
    /// Radius of gyration.
    gyration: f64,
    /// Half the distance of the wheels.
    half: f64,
    /// Stiffness and damper to the ground of a wheel.
    law: [f64; 2],
    mass: f64,
}

impl Bogie {
    /// Largest real part of the eigenvalues of M q'' + C q' + B^T (G + I/k)^-1 B q = 0.
    fn growth(&self, give: &DMatrix<f64>) -> Option<f64> {
        let [k, c] = self.law;
        let contact =
            Matrix2::new(give[(0, 0)] + 1.0 / k, give[(0, 1)], give[(1, 0)], give[(1, 1)] + 1.0 / k);
        let stiffness = contact.try_inverse()?;
        // displacement of each wheel by that of the centre of mass and the pitch
        let arms = Matrix2::new(1.0, -self.half - self.offset, 1.0, self.half - self.offset);
        let mass = [self.mass, self.mass * self.gyration * self.gyration];
        let by_mass = |of: Matrix2<f64>| Matrix2::from_fn(|i, j| -of[(i, j)] / mass[i]);
        let spring = by_mass(arms.transpose() * stiffness * arms);
        if c == 0.0 {
            return Some(undamped(-spring));
        }
        let damper = by_mass(arms.transpose() * arms * c);
        let mut system = Matrix4::zeros();
        for i in 0..2 {
            system[(i, i + 2)] = 1.0;
            for j in 0..2 {
                system[(i + 2, j)] = spring[(i, j)];
                system[(i + 2, j + 2)] = damper[(i, j)];
            }
        }
        Some(system.complex_eigenvalues().iter().map(|own| own.re).fold(f64::MIN, f64::max))
    }
}

/// Largest real part of the eigenvalues l of q'' + A q = 0, l^2 = -m: with the eigenvalues m of A of trace 2 a and
/// determinant d, re l = sqrt((|m| - re m) / 2).
fn undamped(of: Matrix2<f64>) -> f64 {
    let (a, d) = (0.5 * of.trace(), of.determinant());
    let apart = a * a - d;
    if apart < 0.0 {
        return (0.5 * (d.sqrt() - a)).max(0.0).sqrt();
    }
    // the smaller of two real ones; negative: it falls over
    (apart.sqrt() - a).max(0.0).sqrt()
}

/// The map; why there is none.
///
/// # Errors
/// A truck of one wheel; a table that no reading takes.
pub fn map(subject: &MapSubject<'_>, points: usize) -> Result<StabilityMap, String> {
    let (Some(first), Some(last)) = (subject.offsets.first(), subject.offsets.last()) else {
        return Err("a truck without wheels".to_owned());
    };
    let half = 0.5 * (last - first);
    if half <= 0.0 {
        return Err("a truck of one wheel cannot pitch".to_owned());
    }
    let axes = [
        MapScale::new("place of the bogie", &subject.unit(Dimension::LENGTH), false),
        MapScale::new("damper of a wheel to the ground", &subject.unit(Dimension::DAMPING), true),
    ];
    let mut map = StabilityMap::new(
        "excitation",
        "A bogie at rest on tables: does it shake itself?",
        axes,
        "Two wheels under a body whose centre of mass is where growth is largest; wrong where the motion grows: structures \
         only take energy, a table that is not symmetric gives some.",
    );
    let tables =
        influence_blocks(subject.structure, Some(subject.solved)).map_err(|failure| failure.to_string())?;
    let read = |kind: Kind| Reading::new(kind, &tables).map_err(|error| error.to_string());
    let (akispl, cubspl, natural) = (read(Kind::Akispl)?, read(Kind::Cubspl)?, read(Kind::Natural)?);
    let readings: [(&str, &dyn Compliance, bool); 4] = [
        ("akispl", &akispl, false),
        ("cubspl", &cubspl, false),
        ("natural splines", &natural, true),
        ("girderway, exact", subject.surface, true),
    ];
    let omega = (subject.stiffness / subject.mass()).sqrt();
    let bogie = |x: f64, offset: f64, gyration: f64, c: f64| Bogie {
        x,
        offset,
        gyration,
        half,
        law: [subject.stiffness, c],
        mass: 2.0 * subject.mass(),
    };
    let inner = subject.length() - 2.0 * half;
    let place = |i: usize, count: usize| subject.span[0] + half + inner * (i as f64 + 0.5) / count as f64;
    let growth = |of: &dyn Compliance, own: Bogie| {
        let give = subject.give(of, &[own.x - half, own.x + half])?;
        own.growth(&give)
    };
    // where it is worst without dampers: a coarse search, then finer ones about the best
    let mut worst = (f64::MIN, [0.5, 0.0, 0.5]);
    let at = |[place, offset, gyration]: [f64; 3]| {
        let x = subject.span[0] + half + inner * place;
        bogie(x, half * offset, half * 0.3 * 30.0_f64.powf(gyration), 0.0)
    };
    let mut look = |share: [f64; 3]| {
        if let Some(found) = growth(&akispl, at(share)).filter(|found| *found > worst.0) {
            worst = (found, share);
        }
        worst.1
    };
    let mut best = [0.5, 0.0, 0.5];
    for i in 0..80 {
        for j in 0..8 {
            for k in 0..10 {
                let middle = |own: i32, count: i32| (f64::from(own) + 0.5) / f64::from(count);
                best = look([middle(i, 80), 2.0 * middle(j, 8) - 1.0, middle(k, 10)]);
            }
        }
    }
    let mut reach = [1.0 / 80.0, 1.0 / 4.0, 1.0 / 10.0];
    for _ in 0..10 {
        let centre = best;
        for i in -2..=2 {
            for j in -2..=2 {
                for k in -2..=2 {
                    let moved = |axis: usize, by: i32| centre[axis] + reach[axis] * f64::from(by) / 2.0;
                    let share = [moved(0, i), moved(1, j), moved(2, k)];
                    let inside = (0.0..=1.0).contains(&share[0])
                        && (-1.0..=1.0).contains(&share[1])
                        && (0.0..=1.0).contains(&share[2]);
                    if inside {
                        best = look(share);
                    }
                }
            }
        }
        reach = reach.map(|own| 0.6 * own);
    }
    let (largest, at) = (worst.0, at(worst.1));
    map.find("akispl: largest growth without dampers, 1/s", largest);
    map.find("akispl: where", at.x);
    map.find("akispl: distance of the centre of mass from the middle", at.offset);
    map.find("akispl: radius of gyration", at.gyration);
    let needed = {
        let (mut low, mut high) = (0.0, 100.0 * subject.stiffness / omega);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            let found = growth(&akispl, Bogie { law: [subject.stiffness, middle], ..at });
            if found.is_some_and(|found| found > NONE * omega) { low = middle } else { high = middle }
        }
        high
    };
    map.find("akispl: damper of each wheel to the ground that stops it", needed);
    for (name, compliance, _) in &readings {
        let strip = Strip::direct(*compliance, (0, Axis::Vertical));
        let places: Vec<f64> =
            (0..=600).map(|i| subject.span[0] + subject.length() * f64::from(i) / 600.0).collect();
        let found = work(&strip, 2.0 * half, &places).map_err(|error| error.to_string())?;
        map.find(
            format!("{name}: work of a closed loop of two wheels' forces"),
            found.work * subject.load * subject.load,
        );
        if found.stored > 0.0 {
            map.find(format!("{name}: the same by the energy stored"), found.work / found.stored);
        }
    }
    let dampers = spread(1e-3 * needed, 10.0 * needed, points);
    for (name, compliance, is_ours) in readings {
        let mut cells = Vec::new();
        for i in 0..points {
            let x = place(i, points);
            for &c in &dampers {
                let Some(value) = growth(compliance, Bogie { x, law: [subject.stiffness, c], ..at }) else {
                    continue;
                };
                let verdict = if value <= NONE * omega { MapVerdict::Right } else { MapVerdict::Wrong };
                cells.push(MapPoint { at: [x, c], value, verdict });
            }
        }
        let method = if is_ours && !name.starts_with("girderway") {
            format!("girderway, {name}")
        } else {
            name.to_owned()
        };
        map.layers.push(Layer::new(method, is_ours).with(cells));
    }
    let mut cells = Vec::new();
    for &c in &dampers {
        let own = Bogie { law: [subject.stiffness, c], ..at };
        let growth = growth(&akispl, own).unwrap_or_default();
        let (value, verdict) = match told(subject, &tables, own, growth) {
            Ok((_, residual)) if residual > RESIDUAL => (residual, MapVerdict::Warned),
            Ok((grown, residual)) => (residual, if grown { MapVerdict::Wrong } else { MapVerdict::Right }),
            Err(why) => (0.0, MapVerdict::Refused(why)),
        };
        cells.push(MapPoint { at: [at.x, c], value, verdict });
    }
    map.layers.push(Layer::new("girderway told to read by akispl, worst place", true).with(cells));
    Ok(map)
}

/// Whether the motion has grown in a run of the program on AKISPL for `EFOLDINGS` times the time in which it grows by e,
/// or, where it does not, for as many periods; and the energy residual of the run, from which on the program warns.
fn told(subject: &MapSubject<'_>, tables: &[Sheet], own: Bogie, growth: f64) -> Result<(bool, f64), String> {
    let reading = Reading::new(Kind::Akispl, tables).map_err(|error| error.to_string())?;
    let [k, c] = own.law;
    let omega = (2.0 * k / own.mass).sqrt();
    let end = EFOLDINGS / growth.max(0.01 * omega);
    let at = [-own.half - own.offset, own.half - own.offset];
    let scene = subject.crossing(own.mass, &at, subject.linear(k, c), [own.x + own.offset, 0.0, end]);
    let mut scene = scene.map_err(|error| error.to_string())?;
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[5] = true;
    body.inertia[2] = own.mass * own.gyration * own.gyration;
    body.start_speed[1] = STRUCK * subject.gravity / omega;
    scene.accuracy = 1e-6;
    scene.output_dt = end / 1000.0;
    let foundation = Foundation::influence(Box::new(reading), 1);
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()));
    let run = run.map_err(|error| error.to_string())?;
    if !run.status.is_complete() {
        return Err(results::run_error::status(&run.status).1.unwrap_or_default());
    }
    let speed = run.history.column(Channel::Speed(0, Freedom::Y));
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    let tenth = (speed.len() / 10).max(1);
    let grown = largest(&speed[speed.len() - tenth..]) > 2.0 * largest(&speed[..tenth]);
    Ok((grown, run.audit.residual()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_without_dampers_is_the_limit_of_small_ones() {
        let give = |skew: f64| DMatrix::from_row_slice(2, 2, &[2e-8, 1.5e-8 + skew, 1.5e-8 - skew, 1.8e-8]);
        let mut grown = 0;
        for skew in [0.0, 1e-10, 4e-9, 1.4e-8, 2e-8, 3e-8] {
            let own = Bogie { x: 0.0, offset: 0.7, gyration: 1.4, half: 1.3, law: [1e8, 0.0], mass: 1.5e5 };
            let [without, nearly] = [0.0, 1e-7].map(|c| {
                let growth = Bogie { law: [1e8, c], ..own }.growth(&give(skew));
                growth.expect("a contact that gives")
            });
            assert!((without - nearly.max(0.0)).abs() < 1e-6, "{skew}: {without} {nearly}");
            grown += usize::from(without > 0.0);
        }
        assert!((1..5).contains(&grown), "some grow, some do not: {grown}");
    }
}
