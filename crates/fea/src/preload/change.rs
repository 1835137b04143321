//! How far first order holds for loads: what their axial forces would change, and how far the structure turns.

use splines::{Axis, Probe};

use super::forces::StateForces;
use super::given::{BodyLoads, Preload, RailForce};
use super::state::{buckled, point_motions, with_forces};
use crate::error::Error;
use crate::influence::{Effect, FactoredFrame};
use crate::model::{Model, Rail};
use splines::ForceComponent;

/// Estimates of what first order leaves out under given loads, each relative to the largest of its kind.
///
/// Deflection, force and moment are differences of second from first order, with the axial forces of first order. The
/// `rotation` says what large displacements do beside that: where a beam bends freely, its deflection is by about half of
/// the square of the largest rotation smaller than linear theory says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondOrderChange {
    /// Largest change of a displacement of a point or under a load on a rail, by the largest displacement.
    pub deflection: f64,
    /// Largest change of a normal or shear force at the ends of members and under loads on rails, by the largest one.
    pub force: f64,
    /// Largest change of a moment there, by the largest one.
    pub moment: f64,
    /// Largest rotation of a point, radian.
    pub rotation: f64,
}

impl SecondOrderChange {
    /// Estimate of the relative error of deflections: the change of second order, and half of the square of the rotation.
    #[must_use]
    pub fn of_displacements(&self) -> f64 {
        self.deflection + 0.5 * self.rotation * self.rotation
    }
}

/// What second order would change under `loads`: the axial forces N of first order under all of them, weight included, give
/// K + K_g(N), with which the forces on points and rails are solved once more. The changes are those of these forces
/// alone; internal forces are compared for forces on rails. A wheel does not move along with the rail that turns under it:
/// forces on rails have no stiffness of their arms here.
///
/// Two factorisations: this is an estimate, whose error is of the order of its square.
///
/// # Errors
/// As [`crate::FactoredFrame::new`]; [`Error::Buckled`] where the structure does not carry the loads in second order;
/// [`Error::Rail`] for a force beyond its rail.
///
/// ```
/// use fea::{CrossSection, Member, Model, Preload, RailForce, Rail, RailSegment, Support, second_order_change};
///
/// // A cantilever of 2 m pressed along its axis by a tenth of its critical load, and pushed across at its tip.
/// let section = CrossSection { e: 2.1e11, g: 8.1e10, area: 5e-3, iy: 8e-5, iz: 8e-5, j: 1e-4, ..CrossSection::default() };
/// let model = Model {
///     points: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
///     sections: vec![section],
///     members: vec![Member::beam([0, 1], 0, [0.0, 1.0, 0.0])],
///     supports: vec![Support { point: 0, fixed: [true; 6] }],
///     up: [0.0, 1.0, 0.0],
///     ..Model::default()
/// };
/// let segments = vec![RailSegment { member: 0, offset: [0.0; 3] }];
/// let rail = Rail { axis: [1.0, 0.0, 0.0], segments, ..Rail::default() };
/// let critical = (std::f64::consts::PI / 4.0).powi(2) * section.e * section.iz;
/// let rails = vec![RailForce { rail: 0, x: 2.0, force: [-0.1 * critical, -1e5, 0.0] }];
/// let change = second_order_change(&model, &[rail], &Preload { rails, ..Preload::default() })?;
/// // 3 (tan u - u)/u^3 - 1 with u = (pi/2) sqrt(0.1)
/// let u = 0.1_f64.sqrt() * std::f64::consts::FRAC_PI_2;
/// assert!((change.deflection - (3.0 * (u.tan() - u) / u.powi(3) - 1.0)).abs() < 1e-6);
/// # Ok::<(), fea::Error>(())
/// ```
pub fn second_order_change(
    m: &Model,
    rails: &[Rail],
    loads: &Preload,
) -> Result<SecondOrderChange, Error> {
    loads.check(m)?;
    let own = m.unloaded();
    let first = FactoredFrame::new(&own, rails)?;
    let BodyLoads { load, .. } = loads.loads(&own, &first)?;
    let BodyLoads { on_arms, .. } = Preload {
        rails: Vec::new(),
        ..loads.clone()
    }
    .loads(&own, &first)?;
    let forces = StateForces::new(&own, &first, &first.motions(&load), &on_arms);
    let model = with_forces(own.clone(), forces);
    let second = FactoredFrame::new(&model, rails).map_err(|error| buckled(&model, error))?;
    let live = Preload {
        acceleration: [0.0; 3],
        ..loads.clone()
    };
    let [before, after] = [
        Responses::new(&own, &first, &live)?,
        Responses::new(&model, &second, &live)?,
    ];
    Ok(SecondOrderChange {
        deflection: change(&before.displacements, &after.displacements),
        force: change(&before.forces, &after.forces),
        moment: change(&before.moments, &after.moments),
        rotation: before.rotation,
    })
}

/// What loads do to a frame.
struct Responses {
    displacements: Vec<f64>,
    forces: Vec<f64>,
    moments: Vec<f64>,
    rotation: f64,
}

impl Responses {
    fn new(m: &Model, frame: &FactoredFrame, loads: &Preload) -> Result<Responses, Error> {
        let BodyLoads { load, .. } = loads.loads(m, frame)?;
        let points = point_motions(frame, &frame.motions(&load));
        let size = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>().sqrt();
        let rotation = points
            .iter()
            .map(|motion| size(&motion[3..]))
            .fold(0.0, f64::max);
        let mut out = Responses {
            displacements: points
                .iter()
                .flat_map(|motion| motion[..3].to_vec())
                .collect(),
            forces: Vec::new(),
            moments: Vec::new(),
            rotation,
        };
        let (probes, sizes): (Vec<Probe>, Vec<f64>) =
            loads.rails.iter().flat_map(components).unzip();
        if probes.is_empty() {
            return Ok(out);
        }
        let sum = |row: &dyn Fn(usize) -> f64| {
            sizes
                .iter()
                .enumerate()
                .map(|(k, f)| f * row(k))
                .sum::<f64>()
        };
        if loads.points.is_empty() {
            let grid = frame.grid(&probes)?.value;
            out.displacements
                .extend((0..probes.len()).map(|i| sum(&|k| grid[(i, k)])));
        }
        let effects = sections(frame, loads)?;
        let value = frame.effects(m, &effects, &probes)?;
        for (i, effect) in effects.iter().enumerate() {
            let own = sum(&|k| value[(i, k)]);
            match effect {
                Effect::InternalForce {
                    component:
                        ForceComponent::Axial | ForceComponent::ShearY | ForceComponent::ShearZ,
                    ..
                } => out.forces.push(own),
                _ => out.moments.push(own),
            }
        }
        Ok(out)
    }
}

/// The components of a force on a rail that are not zero.
fn components(given: &RailForce) -> Vec<(Probe, f64)> {
    let RailForce { rail, x, force } = *given;
    let all = Axis::ALL.map(|axis| (axis, force[axis.component()]));
    all.into_iter()
        .filter(|(_, f)| *f != 0.0)
        .map(|(axis, f)| (Probe { rail, x, axis }, f))
        .collect()
}

/// The internal forces at both ends of all members and under the loads on rails.
fn sections(frame: &FactoredFrame, loads: &Preload) -> Result<Vec<Effect>, Error> {
    let mut places: Vec<(usize, f64)> = (0..frame.elements.len())
        .flat_map(|member| [(member, 0.0), (member, 1.0)])
        .collect();
    for given in &loads.rails {
        let elements = frame.line()?.elements().iter();
        let on =
            elements.filter(|e| e.rail == given.rail && e.x[0] <= given.x && given.x <= e.x[1]);
        places.extend(on.filter_map(|e| {
            Some((
                e.member?.id,
                (e.place_on_member(given.x) / e.length).clamp(0.0, 1.0),
            ))
        }));
    }
    let of = |(member, place)| {
        ForceComponent::ALL.map(|component| Effect::InternalForce {
            member,
            place,
            component,
        })
    };
    Ok(places.into_iter().flat_map(of).collect())
}

/// The largest change, relative to the largest value; 0 where all are zero.
fn change(before: &[f64], after: &[f64]) -> f64 {
    let largest = before
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let changes = before.iter().zip(after).map(|(a, b)| (a - b).abs());
    if largest == 0.0 {
        0.0
    } else {
        changes.fold(0.0, f64::max) / largest
    }
}
