//! Self-excitation of a bogie at rest on influence tables that are not symmetric.
//!
//! A body on two wheels has the degrees of freedom q = (heave of the centre of mass, pitch). With the compliance G of
//! the rail at the two wheels, the spring k and the damper c to the ground of each wheel, and the arms B of the
//! wheels, its small motion obeys
//!
//! M q'' + c B^T B q' + B^T (G + I/k)^-1 B q = 0.
//!
//! A structure only stores energy: G is symmetric and positive, and no eigenvalue has a positive real part. If a
//! table is read with G(x, z) different from G(z, x), wheel forces do work in closed loops, so the motion can grow
//! without any excitation. The map first searches the bogie that grows fastest on AKISPL without dampers (its
//! place, the offset of its centre of mass and its radius of gyration), then bisects the damper that stops this
//! growth, and then evaluates the growth over place and damper for every reading. A last layer runs the simulator
//! itself on the AKISPL table.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, Matrix2, Matrix4};
use sim::{BodyDof, Channel, Foundation};
use splines::quality::{CouplingBlock, loop_work};
use splines::{Axis, Compliance, InfluenceBlock, ReadingMethod, TableReading};

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::spread;
use super::subject::MapSubject;
use formats::units::Dimension;
use foundations::influence_blocks;
use results::warning::RESIDUAL;

/// Largest growth rate that is treated as zero, relative to the frequency of the wheels on their springs.
const NONE: f64 = 1e-9;

/// Duration of a run, in times in which the motion grows by the factor e.
const EFOLDINGS: f64 = 6.0;
/// Initial vertical speed of a bogie, relative to gravity by the frequency of its wheels.
const INITIAL_SPEED: f64 = 1e-2;

/// A body on two wheels at rest.
#[derive(Clone, Copy)]
struct Bogie {
    /// Position of the middle between the wheels along the rail.
    x: f64,
    /// Distance of the centre of mass from this middle.
    offset: f64,
    /// Radius of gyration.
    gyration: f64,
    /// Half the wheel distance.
    half: f64,
    /// Stiffness and damper to the ground of a wheel.
    law: [f64; 2],
    mass: f64,
}

impl Bogie {
    /// Largest real part of the eigenvalues of M q'' + C q' + B^T (G + I/k)^-1 B q = 0, for the `compliance` G at its
    /// wheels, 2 x 2; `None` where G + I/k is singular.
    fn growth(&self, compliance: &DMatrix<f64>) -> Option<f64> {
        let [k, c] = self.law;
        let contact = Matrix2::new(
            compliance[(0, 0)] + 1.0 / k,
            compliance[(0, 1)],
            compliance[(1, 0)],
            compliance[(1, 1)] + 1.0 / k,
        );
        let stiffness = contact.try_inverse()?;
        // B: the displacement of each wheel per unit heave of the centre of mass and per unit pitch
        let arms = Matrix2::new(1.0, -self.half - self.offset, 1.0, self.half - self.offset);
        let mass = [self.mass, self.mass * self.gyration * self.gyration];
        let by_mass = |of: Matrix2<f64>| Matrix2::from_fn(|i, j| -of[(i, j)] / mass[i]);
        let spring = by_mass(arms.transpose() * stiffness * arms);
        if c == 0.0 {
            return Some(undamped_growth(-spring));
        }
        let damper = by_mass(arms.transpose() * arms * c);
        // the first-order system of (q, q')
        let mut system = Matrix4::zeros();
        for i in 0..2 {
            system[(i, i + 2)] = 1.0;
            for j in 0..2 {
                system[(i + 2, j)] = spring[(i, j)];
                system[(i + 2, j + 2)] = damper[(i, j)];
            }
        }
        Some(
            system
                .complex_eigenvalues()
                .iter()
                .map(|own| own.re)
                .fold(f64::MIN, f64::max),
        )
    }
}

/// Largest real part of the eigenvalues l of q'' + A q = 0.
///
/// They obey l^2 = -m with the eigenvalues m of A, so that re l = sqrt((|m| - re m) / 2). With the trace 2 a and the
/// determinant d of A, m = a +- sqrt(a^2 - d).
fn undamped_growth(of: Matrix2<f64>) -> f64 {
    let (a, d) = (0.5 * of.trace(), of.determinant());
    let discriminant = a * a - d;
    if discriminant < 0.0 {
        return (0.5 * (d.sqrt() - a)).max(0.0).sqrt();
    }
    // the smaller of two real eigenvalues; where it is negative, the equilibrium is statically unstable
    (discriminant.sqrt() - a).max(0.0).sqrt()
}

/// Bogies with the wheels of the scene's truck on its span.
struct BogieFamily<'s, 'a> {
    subject: &'s MapSubject<'a>,
    /// Half the wheel distance.
    half: f64,
    /// Length of the span along which the middle of a bogie can be.
    inner: f64,
    /// Frequency of a wheel on its spring, radian/s.
    omega: f64,
}

impl BogieFamily<'_, '_> {
    /// Growth rate of `bogie` on a rail of this `compliance`.
    fn growth(&self, compliance: &dyn Compliance, bogie: Bogie) -> Option<f64> {
        let matrix = self
            .subject
            .compliance(compliance, &[bogie.x - self.half, bogie.x + self.half])?;
        bogie.growth(&matrix)
    }

    /// A bogie without dampers from three parameters: its position (0 to 1 along the span), the offset of its centre
    /// of mass (-1 to 1, in half wheel distances) and its radius of gyration (0 to 1: 0.3 to 9 half wheel distances,
    /// logarithmically).
    fn candidate(&self, [place, offset, gyration]: [f64; 3]) -> Bogie {
        Bogie {
            x: self.subject.span[0] + self.half + self.inner * place,
            offset: self.half * offset,
            gyration: self.half * 0.3 * 30.0_f64.powf(gyration),
            half: self.half,
            law: [self.subject.stiffness, 0.0],
            mass: 2.0 * self.subject.mass(),
        }
    }

    /// The middle of part `i` of `count` equal parts of the range of positions of a bogie.
    fn place(&self, i: usize, count: usize) -> f64 {
        self.subject.span[0] + self.half + self.inner * (i as f64 + 0.5) / count as f64
    }

    /// The bogie whose motion grows fastest without dampers, and its growth rate.
    ///
    /// A grid of 80 x 8 x 10 candidates is evaluated first; then ten grids of 5 x 5 x 5 about the best candidate so
    /// far, each 0.6 times as wide as the one before.
    fn fastest_growing(&self, compliance: &dyn Compliance) -> (f64, Bogie) {
        let mut largest = f64::MIN;
        let mut best = [0.5, 0.0, 0.5];
        let mut consider = |parameters: [f64; 3], best: &mut [f64; 3]| {
            let growth = self.growth(compliance, self.candidate(parameters));
            if let Some(growth) = growth.filter(|growth| *growth > largest) {
                largest = growth;
                *best = parameters;
            }
        };
        let middle = |i: i32, count: i32| (f64::from(i) + 0.5) / f64::from(count);
        for (i, j, k) in triples(0..80, 0..8, 0..10) {
            consider(
                [middle(i, 80), 2.0 * middle(j, 8) - 1.0, middle(k, 10)],
                &mut best,
            );
        }
        let mut width = [1.0 / 80.0, 1.0 / 4.0, 1.0 / 10.0];
        for _ in 0..10 {
            let centre = best;
            for (i, j, k) in triples(-2..3, -2..3, -2..3) {
                let moved = |axis: usize, by: i32| centre[axis] + width[axis] * f64::from(by) / 2.0;
                let parameters = [moved(0, i), moved(1, j), moved(2, k)];
                let is_inside = (0.0..=1.0).contains(&parameters[0])
                    && (-1.0..=1.0).contains(&parameters[1])
                    && (0.0..=1.0).contains(&parameters[2]);
                if is_inside {
                    consider(parameters, &mut best);
                }
            }
            width = width.map(|own| 0.6 * own);
        }
        (largest, self.candidate(best))
    }

    /// The smallest damper of each wheel to the ground that stops the growth of `bogie`, by bisection.
    fn stopping_damper(&self, compliance: &dyn Compliance, bogie: Bogie) -> f64 {
        let (mut low, mut high) = (0.0, 100.0 * self.subject.stiffness / self.omega);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            let growth = self.growth(
                compliance,
                Bogie {
                    law: [self.subject.stiffness, middle],
                    ..bogie
                },
            );
            if growth.is_some_and(|growth| growth > NONE * self.omega) {
                low = middle
            } else {
                high = middle
            }
        }
        high
    }

    /// Growth over place and damper of bogies that are otherwise `bogie`: wrong where the motion grows.
    fn growth_over_span(
        &self,
        compliance: &dyn Compliance,
        bogie: Bogie,
        dampers: &[f64],
        points: usize,
    ) -> Vec<MapPoint> {
        let mut map_points = Vec::new();
        for x in (0..points).map(|i| self.place(i, points)) {
            for &c in dampers {
                let own = Bogie {
                    x,
                    law: [self.subject.stiffness, c],
                    ..bogie
                };
                let Some(value) = self.growth(compliance, own) else {
                    continue;
                };
                let verdict = if value <= NONE * self.omega {
                    MapVerdict::Right
                } else {
                    MapVerdict::Wrong
                };
                map_points.push(MapPoint {
                    at: [x, c],
                    value,
                    verdict,
                });
            }
        }
        map_points
    }

    /// Runs of the simulator on the AKISPL `tables` with `bogie` and each of the `dampers`: whether the motion grows,
    /// and whether the energy residual of the run gives a warning.
    fn simulated(
        &self,
        akispl: &dyn Compliance,
        tables: &[InfluenceBlock],
        bogie: Bogie,
        dampers: &[f64],
    ) -> Vec<MapPoint> {
        let point = |&c: &f64| {
            let own = Bogie {
                law: [self.subject.stiffness, c],
                ..bogie
            };
            let growth = self.growth(akispl, own).unwrap_or_default();
            let (value, verdict) = match run_on_akispl(self.subject, tables, own, growth) {
                Ok((_, residual)) if residual > RESIDUAL => (residual, MapVerdict::Warned),
                Ok((has_grown, residual)) => (
                    residual,
                    if has_grown {
                        MapVerdict::Wrong
                    } else {
                        MapVerdict::Right
                    },
                ),
                Err(why) => (0.0, MapVerdict::Refused(why)),
            };
            MapPoint {
                at: [bogie.x, c],
                value,
                verdict,
            }
        };
        dampers.iter().map(point).collect()
    }
}

/// All triples of three ranges, the last index fastest.
fn triples(
    first: std::ops::Range<i32>,
    second: std::ops::Range<i32>,
    third: std::ops::Range<i32>,
) -> impl Iterator<Item = (i32, i32, i32)> {
    first.flat_map(move |i| {
        let third = third.clone();
        second
            .clone()
            .flat_map(move |j| third.clone().map(move |k| (i, j, k)))
    })
}

/// The map of growth over place and damper, with the bogie that grows fastest on AKISPL.
///
/// # Errors
/// A truck of one wheel; a table that no reading accepts. The text says which.
pub fn map(subject: &MapSubject<'_>, points: usize) -> Result<StabilityMap, String> {
    let (Some(first), Some(last)) = (subject.offsets.first(), subject.offsets.last()) else {
        return Err("a truck without wheels".to_owned());
    };
    let half = 0.5 * (last - first);
    if half <= 0.0 {
        return Err("a truck of one wheel cannot pitch".to_owned());
    }
    let mut map = empty_map(subject);
    let tables = influence_blocks(subject.structure, Some(subject.solved))
        .map_err(|failure| failure.to_string())?;
    let read =
        |kind: ReadingMethod| TableReading::new(kind, &tables).map_err(|error| error.to_string());
    let (akispl, cubspl, natural) = (
        read(ReadingMethod::Akispl)?,
        read(ReadingMethod::Cubspl)?,
        read(ReadingMethod::Natural)?,
    );
    let readings: [(&str, &dyn Compliance, bool); 4] = [
        ("akispl", &akispl, false),
        ("cubspl", &cubspl, false),
        ("natural splines", &natural, true),
        ("girderway, exact", subject.surface, true),
    ];
    let family = BogieFamily {
        subject,
        half,
        inner: subject.length() - 2.0 * half,
        omega: (subject.stiffness / subject.mass()).sqrt(),
    };
    let (growth, worst) = family.fastest_growing(&akispl);
    map.note("akispl: largest growth without dampers, 1/s", growth);
    map.note("akispl: position", worst.x);
    map.note(
        "akispl: distance of the centre of mass from the middle",
        worst.offset,
    );
    map.note("akispl: radius of gyration", worst.gyration);
    let needed = family.stopping_damper(&akispl, worst);
    map.note(
        "akispl: damper of each wheel to the ground that stops it",
        needed,
    );
    for (name, compliance, _) in &readings {
        note_loop_work(&mut map, subject, name, *compliance, 2.0 * half)?;
    }
    let dampers = spread(1e-3 * needed, 10.0 * needed, points);
    for (name, compliance, is_ours) in readings {
        let method = if is_ours && !name.starts_with("girderway") {
            format!("girderway, {name}")
        } else {
            name.to_owned()
        };
        let map_points = family.growth_over_span(compliance, worst, &dampers, points);
        map.layers
            .push(MapLayer::new(method, is_ours).with(map_points));
    }
    let map_points = family.simulated(&akispl, &tables, worst, &dampers);
    map.layers
        .push(MapLayer::new("girderway, akispl, worst position", true).with(map_points));
    Ok(map)
}

/// The map without numbers and layers.
fn empty_map(subject: &MapSubject<'_>) -> StabilityMap {
    let axes = [
        MapScale::new(
            "position of the bogie",
            &subject.unit(Dimension::LENGTH),
            false,
        ),
        MapScale::new(
            "damper of a wheel to the ground",
            &subject.unit(Dimension::DAMPING),
            true,
        ),
    ];
    StabilityMap::new(
        "excitation",
        "Self-excitation of a bogie at rest on influence tables",
        axes,
        "Two wheels under a body with the centre of mass of largest growth; wrong where the motion grows: a \
         structure only stores energy, but a table that is not symmetric supplies energy.",
    )
}

/// Notes the largest work of a closed loop of the forces of two wheels at the distance `spacing`, and its ratio to
/// the energy stored: zero for a symmetric compliance.
fn note_loop_work(
    map: &mut StabilityMap,
    subject: &MapSubject<'_>,
    name: &str,
    compliance: &dyn Compliance,
    spacing: f64,
) -> Result<(), String> {
    let block = CouplingBlock::direct(compliance, (0, Axis::Vertical));
    let places: Vec<f64> = (0..=600)
        .map(|i| subject.span[0] + subject.length() * f64::from(i) / 600.0)
        .collect();
    let largest = loop_work(&block, spacing, &places).map_err(|error| error.to_string())?;
    map.note(
        format!("{name}: work of a closed loop of two wheels' forces"),
        largest.work * subject.load * subject.load,
    );
    if largest.stored > 0.0 {
        map.note(
            format!("{name}: the same relative to the stored energy"),
            largest.work / largest.stored,
        );
    }
    Ok(())
}

/// Runs the simulator with one bogie on the AKISPL table for [`EFOLDINGS`] times the time in which its motion grows
/// by the factor e. A growth rate below a hundredth of the frequency of the wheels is replaced by this hundredth,
/// which limits the duration of the run.
///
/// Returns whether the speed in the last tenth of the run is more than twice that in the first, and the energy
/// residual of the run.
fn run_on_akispl(
    subject: &MapSubject<'_>,
    tables: &[InfluenceBlock],
    own: Bogie,
    growth: f64,
) -> Result<(bool, f64), String> {
    let reading =
        TableReading::new(ReadingMethod::Akispl, tables).map_err(|error| error.to_string())?;
    let [k, c] = own.law;
    let omega = (2.0 * k / own.mass).sqrt();
    let end = EFOLDINGS / growth.max(0.01 * omega);
    let at = [-own.half - own.offset, own.half - own.offset];
    let scene = subject.crossing(
        own.mass,
        &at,
        subject.linear(k, c),
        [own.x + own.offset, 0.0, end],
    );
    let mut scene = scene.map_err(|error| error.to_string())?;
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[5] = true;
    body.inertia[2] = own.mass * own.gyration * own.gyration;
    body.start_speed[1] = INITIAL_SPEED * subject.gravity / omega;
    scene.accuracy = 1e-6;
    scene.output_dt = end / 1000.0;
    let foundation = Foundation::massless(Box::new(reading), 1);
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()));
    let run = run.map_err(|error| error.to_string())?;
    if !run.status.is_complete() {
        return Err(results::run_error::status(&run.status)
            .1
            .unwrap_or_default());
    }
    let speed = run.history.column(Channel::Speed(0, BodyDof::Y));
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    let tenth = (speed.len() / 10).max(1);
    let has_grown = largest(&speed[speed.len() - tenth..]) > 2.0 * largest(&speed[..tenth]);
    Ok((has_grown, run.audit.residual()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_without_dampers_is_the_limit_of_small_ones() {
        let compliance = |skew: f64| {
            DMatrix::from_row_slice(2, 2, &[2e-8, 1.5e-8 + skew, 1.5e-8 - skew, 1.8e-8])
        };
        let mut growing = 0;
        for skew in [0.0, 1e-10, 4e-9, 1.4e-8, 2e-8, 3e-8] {
            let own = Bogie {
                x: 0.0,
                offset: 0.7,
                gyration: 1.4,
                half: 1.3,
                law: [1e8, 0.0],
                mass: 1.5e5,
            };
            let [without, nearly] = [0.0, 1e-7].map(|c| {
                let growth = Bogie {
                    law: [1e8, c],
                    ..own
                }
                .growth(&compliance(skew));
                growth.expect("a flexible contact")
            });
            assert!(
                (without - nearly.max(0.0)).abs() < 1e-6,
                "{skew}: {without} {nearly}"
            );
            growing += usize::from(without > 0.0);
        }
        assert!(
            (1..5).contains(&growing),
            "some grow, some do not: {growing}"
        );
    }
}
