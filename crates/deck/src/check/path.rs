//! Comparison of static equilibria of the deck with the quasi-static sweep of the simulator.
//!
//! At each equilibrium of the simulator the static equations of the deck are linearised, with the small rotations of the
//! simulator. One Newton step is the distance to the equilibrium of the deck, and must be at most 1e-8. Where rounding moves
//! that equilibrium by more, every equation must hold instead: to 1e-8 of its scale, or to what the rounding of coordinates
//! makes of it. Then the equations are solved with finite rotations, as in ADAMS. What that changes is of second order in the
//! rotations theta, and the moment m g h theta of the weight, which the simulator leaves out. It is estimated by the first Newton
//! step, and must not exceed the estimate by more than a factor.

use std::collections::BTreeSet;

use adams::{AdamsModel, DataSet, EquationResidual, Equilibrium, RotationMeasure, StatementId};
use nalgebra::Vector3;
use sim::{Analysis, BodyDof, Channel, ContactForces, Foundation, Instant, Status};

use super::compare::{self, expected_values};
use super::poses::state;
use super::states::CheckCase;
use crate::DeckPlan;
use crate::Error;
use crate::words::ids::number;

/// Number of time intervals between the equilibria that are compared, with up to [`FEW`] wheels.
const INTERVALS: f64 = 40.0;
/// Least number of them.
const LEAST: f64 = 2.0;
/// Number of wheels above which fewer equilibria are compared: the work for each grows with the cube of the wheels.
const FEW: f64 = 20.0;
/// Limit of the residuals of equations, and of relative differences of displacements and forces, with the rotations of the
/// simulator. Its equilibria are as accurate as that.
pub const LIMIT: f64 = 1e-8;
/// Rounding errors of coordinates, relative to their size.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Largest ratio of the effect of finite rotations to its estimate.
pub const KNOWN: f64 = 2.0;
/// Largest number of equations that are named in a report.
const NAMED: usize = 3;

/// The equilibria of the simulator along the prescribed motion.
pub struct EquilibriumPath {
    /// The equilibria.
    pub cases: Vec<CheckCase>,
    /// The reason why the simulator did not compute all of them.
    pub failed: Option<String>,
}

/// Differences of equilibria.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EquilibriumDifference {
    /// Largest difference of the position of a body or wheel along its rail, relative to the largest coordinate.
    pub place: f64,
    /// Largest vertical or lateral difference of a body or wheel, relative to the largest displacement.
    pub height: f64,
    /// Largest difference of a wheel's vertical or lateral force, relative to the largest force.
    pub force: f64,
}

impl EquilibriumDifference {
    /// The largest of the differences.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.place.max(self.height).max(self.force)
    }

    fn include(&mut self, other: EquilibriumDifference) {
        self.place = self.place.max(other.place);
        self.height = self.height.max(other.height);
        self.force = self.force.max(other.force);
    }
}

/// Differences between the two paths.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepDifference {
    /// Number of equilibria compared: all, or those up to the first that differs.
    pub places: usize,
    /// Differences with the small rotations of the simulator.
    pub small: EquilibriumDifference,
    /// Their limits: 1e-8, and the rounding errors of coordinates; more at equilibria where every equation holds and the
    /// differences are larger ([`SweepDifference::ill_conditioned`]).
    pub limit: EquilibriumDifference,
    /// Number of equilibria that the equations of the deck determine less well: rounding of an equation moves them by more than
    /// 1e-8. Stiff wheels share a load by what rounding leaves of the heights of their rail.
    pub ill_conditioned: usize,
    /// Number of equilibria near which Newton's method finds none with finite rotations, as where contacts open and close by turns.
    pub far: usize,
    /// What finite rotations change.
    pub finite: EquilibriumDifference,
    /// Its estimate, to first order.
    pub estimate: EquilibriumDifference,
    /// Largest rotation of a body, rad.
    pub rotation: f64,
    /// Why the simulator computed no more equilibria: the comparison ends at the first that it does not find.
    pub stopped: Option<String>,
    /// What does not agree, and on which side, for the first equilibrium at which something does not.
    pub causes: Vec<String>,
}

impl SweepDifference {
    /// Limits of what finite rotations change.
    #[must_use]
    pub fn known(&self) -> EquilibriumDifference {
        EquilibriumDifference {
            place: KNOWN * self.estimate.place + self.limit.place,
            height: KNOWN * self.estimate.height + self.limit.height,
            force: KNOWN * self.estimate.force + self.limit.force,
        }
    }

    /// Whether all differences are within their limits.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.causes.is_empty()
            && within(&self.small, &self.limit)
            && within(&self.finite, &self.known())
    }
}

/// Whether no difference exceeds its limit.
fn within(found: &EquilibriumDifference, limit: &EquilibriumDifference) -> bool {
    found.place <= limit.place && found.height <= limit.height && found.force <= limit.force
}

/// The equilibria of the simulator along the prescribed motion; `None` if a body is free along its rail and therefore
/// has no static equilibrium.
///
/// # Errors
/// [`Error::Start`] for a scene that the simulator cannot set up.
pub fn sweep(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
) -> Result<Option<EquilibriumPath>, Error> {
    if plan.scene.bodies.iter().any(|body| body.motion.is_free()) {
        return Ok(None);
    }
    let mut scene = plan.input.scene.clone();
    scene.analysis = Analysis::QuasiStatic;
    let crowd = (FEW / plan.wheels.len().max(1) as f64).min(1.0);
    let intervals = (INTERVALS * crowd.powi(3)).round().max(LEAST);
    let times: Vec<f64> = (0..=intervals as usize)
        .map(|i| scene.end * (i as f64 / intervals))
        .collect();
    let mut out = EquilibriumPath {
        cases: Vec::new(),
        failed: None,
    };
    let (history, status) = sim::equilibria(&scene, foundations, &times).map_err(Error::Start)?;
    if let Status::Failed(t, error) = status {
        out.failed = Some(format!("t = {t} s, where the simulator stops: {error}"));
    }
    let times = history.column(Channel::Time);
    let speeds: Vec<Vec<f64>> = (0..plan.bodies.len())
        .map(|b| history.column(Channel::Speed(b, BodyDof::X)))
        .collect();
    let column = |channel: Channel| history.column(channel);
    let wheels = plan.wheels.len();
    let of_wheels = |channel: fn(usize) -> Channel| -> Vec<Vec<f64>> {
        (0..wheels).map(|w| column(channel(w))).collect()
    };
    let displacements: Vec<[Vec<f64>; 6]> = (0..plan.bodies.len())
        .map(|b| BodyDof::ALL.map(|dof| column(Channel::Displacement(b, dof))))
        .collect();
    let [vertical, lateral, traction, penetration] = [
        of_wheels(Channel::Vertical),
        of_wheels(Channel::Lateral),
        of_wheels(Channel::Traction),
        of_wheels(Channel::Penetration),
    ];
    for (i, time) in times.iter().enumerate() {
        let at = |columns: &[Vec<f64>]| -> Vec<f64> {
            columns
                .iter()
                .map(|column| column.get(i).copied().unwrap_or_default())
                .collect()
        };
        let penetration: Vec<f64> = {
            let all = at(&penetration);
            let first = |contact: &crate::model::plan::ContactPlan| all[contact.wheels.start];
            plan.contacts.iter().map(first).collect()
        };
        let instant = Instant {
            time: *time,
            displacement: displacements
                .iter()
                .map(|own| std::array::from_fn(|k| own[k].get(i).copied().unwrap_or_default()))
                .collect(),
            // wheels do not spin in statics: those that move along their rails slide
            speed: at(&speeds)
                .into_iter()
                .map(|along| [along, 0.0, 0.0, 0.0, 0.0, 0.0])
                .collect(),
            spin: vec![0.0; wheels],
            penetration: penetration.iter().copied().map(Some).collect(),
        };
        let forces = ContactForces {
            vertical: at(&vertical),
            lateral: at(&lateral),
            traction: at(&traction),
            slope_force: Vec::new(),
            approach: Vec::new(),
            penetration,
            compliance: nalgebra::DMatrix::zeros(0, 0),
        };
        out.cases.push(CheckCase {
            instant,
            forces,
            rate: vec![0.0; plan.contacts.len()],
            is_at_rest: true,
        });
    }
    Ok(Some(out))
}

/// Compares the equilibria of the deck with those of the simulator.
///
/// # Errors
/// A data set that cannot be executed.
pub fn path(
    plan: &DeckPlan<'_>,
    set: &DataSet,
    foundations: &[Foundation],
    sweep: &EquilibriumPath,
) -> Result<SweepDifference, Error> {
    let model = AdamsModel::new(set)?;
    let held = held(plan);
    let scales = Scales::of(plan, &sweep.cases);
    let strict = scales.limit(plan);
    let mut out = SweepDifference {
        places: 0,
        small: EquilibriumDifference::default(),
        limit: strict,
        ill_conditioned: 0,
        far: 0,
        finite: EquilibriumDifference::default(),
        estimate: EquilibriumDifference::default(),
        rotation: scales.rotation,
        stopped: sweep.failed.clone(),
        causes: Vec::new(),
    };
    for case in &sweep.cases {
        let mut given = expected_values(plan, foundations, case, 0.0)?.given;
        given.held.clone_from(&held);
        let guess = state(plan, case, None);
        let expected = Positions::of_case(plan, case);
        let moved_to =
            |found: &Equilibrium| scales.difference(&Positions::of_deck(plan, found), &expected);
        out.places += 1;
        let step = model.newton_step(&guess, &given, RotationMeasure::Small, LIMIT)?;
        let moved = step.as_ref().map(|step| moved_to(&step.after));
        let is_near = moved.is_some_and(|moved| within(&moved, &strict));
        out.small.include(moved.unwrap_or_default());
        if !(is_near && step.is_some_and(|step| step.is_solved)) {
            let equations = model.imbalance(&guess, &given, RotationMeasure::Small, LIMIT)?;
            if equations.iter().any(|one| !one.holds) {
                out.causes
                    .extend(causes(set, case.instant.time, &equations, moved));
                return Ok(out);
            }
            out.ill_conditioned += usize::from(!is_near);
            out.limit.include(moved.unwrap_or_default());
        }
        let first = model.newton_step(&guess, &given, RotationMeasure::Finite, LIMIT)?;
        let last = model.equilibrium_near(&guess, &given, RotationMeasure::Finite)?;
        if let (Some(first), Some(last)) = (first, last) {
            out.estimate.include(moved_to(&first.after));
            out.finite.include(moved_to(&last));
        } else {
            out.far += 1;
        }
    }
    Ok(out)
}

/// The equations of the deck that the equilibrium of the simulator does not satisfy, and how far that of the deck is.
fn causes(
    set: &DataSet,
    time: f64,
    equations: &[EquationResidual],
    moved: Option<EquilibriumDifference>,
) -> Vec<String> {
    let name = |id: &StatementId| compare::statement(set, &id.keyword.to_string(), id.id);
    let wrong = equations.iter().filter(|one| !one.holds);
    let named = wrong.take(NAMED).map(|one| {
        format!(
            "deck: {} has a {} that is off by {:.3e}",
            name(&one.statement),
            one.quantity,
            one.residual
        )
    });
    let away = moved.map_or_else(String::new, |moved| {
        format!(
            ", whose heights differ by {:.1e} and forces by {:.1e} to first order",
            moved.height, moved.force
        )
    });
    let head =
        format!("at t = {time} s the equilibrium of the simulator is none of the deck{away}");
    std::iter::once(head).chain(named).collect()
}

/// The freedoms of parts that the statics of the simulator leaves where they are: z, yaw and the spins of wheels, and roll
/// and pitch where no wheel resists them. Between flanges nothing determines z and yaw.
fn held(plan: &DeckPlan<'_>) -> BTreeSet<(u32, usize)> {
    let mut out = BTreeSet::new();
    for (b, body) in plan.bodies.iter().enumerate() {
        let arms = |axis: usize| {
            plan.contacts
                .iter()
                .filter(|contact| plan.wheels[contact.wheels.start].body == b)
                .map(|contact| {
                    let hubs = contact.wheels.clone().map(|w| plan.wheels[w].hub[axis]);
                    hubs.sum::<f64>()
                })
                .fold(0.0_f64, |most, arm| most.max(arm.abs()))
        };
        let free = plan.scene.bodies[b].free;
        out.extend(
            [2, 4]
                .into_iter()
                .filter(|&k| free[k])
                .map(|k| (body.part, k)),
        );
        for (rotation, axis) in [(3, 2), (5, 0)] {
            if free[rotation] && arms(axis) == 0.0 {
                out.insert((body.part, rotation));
            }
        }
    }
    for wheel in &plan.wheels {
        if let Some((part, _)) = wheel.spin {
            out.insert((part, 5));
        }
    }
    out
}

/// Positions of bodies and wheels in ground, and forces of wheels.
struct Positions {
    points: Vec<Vector3<f64>>,
    forces: Vec<[f64; 2]>,
}

impl Positions {
    /// Those of the simulator.
    fn of_case(plan: &DeckPlan<'_>, case: &CheckCase) -> Positions {
        let pose = |b: usize| {
            let [x, y, z, roll, yaw, pitch] = case.instant.displacement[b];
            let [height, side] = plan.bodies[b].position;
            (
                Vector3::new(x, height + y, side + z),
                Vector3::new(roll, yaw, pitch),
            )
        };
        let bodies = (0..plan.bodies.len()).map(|b| pose(b).0);
        let hubs = plan.wheels.iter().map(|wheel| {
            let (origin, turn) = pose(wheel.body);
            let hub = Vector3::from(wheel.hub);
            origin + hub + turn.cross(&hub)
        });
        Positions {
            points: bodies.chain(hubs).collect(),
            forces: (0..plan.wheels.len())
                .map(|w| [case.forces.vertical[w], case.forces.lateral[w]])
                .collect(),
        }
    }

    /// Those of the deck; a part or force that is missing counts as far away.
    fn of_deck(plan: &DeckPlan<'_>, found: &Equilibrium) -> Positions {
        let far = || Vector3::repeat(f64::MAX.sqrt());
        let pose = |b: usize| found.state.parts.get(&plan.bodies[b].part);
        let bodies = (0..plan.bodies.len()).map(|b| pose(b).map_or_else(far, |pose| pose.origin));
        let hubs = plan.wheels.iter().map(|wheel| {
            pose(wheel.body).map_or_else(far, |pose| {
                pose.origin + pose.rotation * Vector3::from(wheel.hub)
            })
        });
        let force = |w: usize| {
            let load = found.solution.loads.get(&("GFORCE", number(w)));
            load.map_or([f64::MAX.sqrt(); 2], |load| {
                [load.components[1], -load.components[2]]
            })
        };
        Positions {
            points: bodies.chain(hubs).collect(),
            forces: (0..plan.wheels.len()).map(force).collect(),
        }
    }
}

/// Sizes relative to which differences are measured.
struct Scales {
    coordinate: f64,
    displacement: f64,
    force: f64,
    rotation: f64,
}

impl Scales {
    fn of(plan: &DeckPlan<'_>, cases: &[CheckCase]) -> Scales {
        let mut out = Scales {
            coordinate: f64::MIN_POSITIVE,
            displacement: f64::MIN_POSITIVE,
            force: f64::MIN_POSITIVE,
            rotation: 0.0,
        };
        for case in cases {
            let forces = [&case.forces.vertical, &case.forces.lateral];
            for force in forces.into_iter().flatten() {
                out.force = out.force.max(force.abs());
            }
            let mut moved = |hub: [f64; 3], b: usize| {
                let [x, y, z, roll, yaw, pitch] = case.instant.displacement[b];
                let turn = Vector3::new(roll, yaw, pitch);
                let by = turn.cross(&Vector3::from(hub));
                out.coordinate = out.coordinate.max((x + hub[0]).abs());
                out.displacement = out.displacement.max((y + by.y).abs()).max((z + by.z).abs());
                out.rotation = out.rotation.max(turn.norm());
            };
            (0..plan.bodies.len()).for_each(|b| moved([0.0; 3], b));
            plan.wheels
                .iter()
                .for_each(|wheel| moved(wheel.hub, wheel.body));
        }
        out
    }

    /// Limits of differences that both programs make by rounding.
    fn limit(&self, plan: &DeckPlan<'_>) -> EquilibriumDifference {
        // Heights and lateral coordinates are computed from those of bodies, hubs and radii.
        let mut size = self.displacement;
        for (w, wheel) in plan.wheels.iter().enumerate() {
            let [height, side] = plan.bodies[wheel.body].position;
            let [_, y, z] = wheel.hub.map(f64::abs);
            size = size.max(height.abs() + y + plan.kind(w).radius);
            size = size.max(side.abs() + z);
        }
        let rounding = ROUNDING * (size + self.rotation * self.coordinate);
        let stiffness = (0..plan.wheels.len()).map(|w| {
            let kind = plan.kind(w);
            let side = kind.flange.as_ref().map_or(0.0, |flange| flange.stiffness);
            let depth = kind.normal.penetration(self.force);
            kind.normal.at(depth, 0.0).by_penetration.max(side)
        });
        let stiffest = stiffness.fold(0.0, f64::max);
        EquilibriumDifference {
            place: LIMIT,
            height: LIMIT + rounding / self.displacement,
            force: LIMIT + stiffest * rounding / self.force,
        }
    }

    fn difference(&self, found: &Positions, expected: &Positions) -> EquilibriumDifference {
        let mut out = EquilibriumDifference::default();
        for (a, b) in found.points.iter().zip(&expected.points) {
            let d = (a - b).abs();
            out.include(EquilibriumDifference {
                place: d.x / self.coordinate,
                height: d.y.max(d.z) / self.displacement,
                force: 0.0,
            });
        }
        for (a, b) in found.forces.iter().zip(&expected.forces) {
            let d = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            out.include(EquilibriumDifference {
                force: d / self.force,
                ..EquilibriumDifference::default()
            });
        }
        out
    }
}
