//! Data of a crane as design codes define them: weights, span, approach, wheels and speeds, from the scene and its
//! run.

use sim::Action;

use crate::columns::NamedColumns;
use crate::layout::ScenePositions;
use formats::scene::motion::SimulationInput;
use formats::scene::{BodyMotion, Practice, Scene, end_stops, mean_lateral_position, root_body};
use formats::units::{Dimension, Scale, Units};
use foundations::Error;

/// A crane on two rails, in the units of its scene.
#[derive(Clone, Debug, PartialEq)]
pub struct CraneData {
    /// Weights and span, with the trolley at its nearest approach to a rail.
    pub model: practice::Crane,
    /// Whether that approach is the smallest one in the run, because the scene does not specify it.
    pub approach_is_from_run: bool,
    /// Lateral coordinates of its rails.
    pub rail_positions: [f64; 2],
    /// Indices of its wheels on each rail.
    pub wheels: [Vec<usize>; 2],
    /// Distances from the foremost wheel to each wheel of the first rail.
    pub wheel_distances: Vec<f64>,
    /// Number of driven wheels on each rail.
    pub driven: [usize; 2],
    /// Smallest friction coefficient of the driven wheels.
    pub friction: Option<f64>,
    /// Total lateral play of the flanges on each rail; `None` for a rail without flanges.
    pub flange_play: [Option<f64>; 2],
    /// Speeds of bridge, trolley and hoist: rated speeds, or the largest commanded speeds where none are specified.
    pub speeds: [Option<f64>; 3],
    /// Sum of the stiffnesses of the end stops in front of the crane.
    pub stop_stiffness: f64,
    /// The first buffer between the crane and another crane.
    pub buffer: Option<CraneBuffer>,
    /// Weights at fixed positions on the bridge: (lateral coordinate, weight).
    pub fixed_weights: Vec<[f64; 2]>,
    /// Lateral coordinate of the trolley as a linear function of its rail coordinate: value at 0, and slope.
    pub trolley_line: Option<[f64; 2]>,
}

/// A buffer between two cranes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CraneBuffer {
    /// Index of the stop.
    pub stop: usize,
    /// Its stiffness.
    pub stiffness: f64,
    /// Weight of the other crane without suspended loads.
    pub weight: f64,
    /// Largest commanded speed of the other crane.
    pub speed: f64,
}

/// Conversion factors from `units` to metres and newtons.
#[must_use]
pub(super) fn to_si(units: Units) -> Scale {
    Scale {
        from: units,
        to: Units::SI,
    }
}

/// Root of each body of a scene, and the vector from the origin of the root to that of the body.
type Roots = [(usize, [f64; 3])];

impl CraneData {
    /// The data of the crane that `practice` names. The approach of the trolley is taken from the columns `record`
    /// where the scene does not specify it.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(
        scene: &Scene,
        practice: &Practice,
        input: &SimulationInput,
        record: &NamedColumns,
    ) -> Result<CraneData, Error> {
        let layout = ScenePositions::new(scene)?;
        let roots: Vec<(usize, [f64; 3])> = (0..scene.bodies.len())
            .map(|body| root_body(scene, body))
            .collect();
        let fixed_weights = fixed_weights(scene, practice.crane, &layout, &roots);
        let rail_positions = practice
            .rails
            .map(|rail| mean_lateral_position(scene, practice.crane, rail));
        let trolley_line = practice
            .trolley
            .and_then(|trolley| trolley_line(scene, trolley, &layout));
        let wheels = practice.rails.map(|rail| {
            let wheels = input.wheels.iter().enumerate();
            let own = wheels
                .filter(|(_, wheel)| roots[wheel.body].0 == practice.crane && wheel.rail == rail);
            own.map(|(index, _)| index).collect::<Vec<usize>>()
        });
        let kinds = wheels.each_ref().map(|own| {
            own.iter()
                .map(|w| &scene.wheels[input.wheels[*w].kind])
                .collect::<Vec<_>>()
        });
        let driven = kinds
            .each_ref()
            .map(|own| own.iter().filter(|kind| kind.driven).count());
        let frictions = kinds.iter().flatten().filter(|kind| kind.driven);
        let friction = frictions
            .filter_map(|kind| Some(kind.friction.as_ref()?.mu))
            .reduce(f64::min);
        let flange_play = kinds.each_ref().map(|own| {
            let flanges = own
                .iter()
                .filter_map(|kind| Some(2.0 * kind.lateral.as_ref()?.clearance));
            flanges.reduce(f64::max)
        });
        let nearest = practice
            .trolley
            .zip(trolley_line)
            .map(|(trolley, [origin, slope])| {
                let places = record
                    .part(&scene.bodies[trolley].name, "x")
                    .iter()
                    .map(|x| origin + slope * x);
                places
                    .flat_map(|z| rail_positions.map(|rail| (z - rail).abs()))
                    .fold(f64::INFINITY, f64::min)
            });
        let weight = |counts: &dyn Fn(usize) -> bool| -> f64 {
            let bodies = (0..roots.len()).filter(|body| counts(*body));
            bodies
                .map(|body| scene.bodies[body].mass * scene.gravity)
                .sum()
        };
        let span = (rail_positions[0] - rail_positions[1]).abs();
        let model = practice::Crane {
            lifted: weight(&|body| practice.loads.contains(&body)),
            trolley: weight(&|body| practice.trolley == Some(roots[body].0)),
            bridge: fixed_weights.iter().map(|[_, weight]| weight).sum(),
            span,
            approach: practice
                .approach
                .or(nearest)
                .unwrap_or(0.5 * span)
                .min(span),
            wheels: u32::try_from(wheels[0].len().max(wheels[1].len())).unwrap_or(u32::MAX),
        };
        Ok(CraneData {
            model,
            approach_is_from_run: practice.approach.is_none() && nearest.is_some(),
            rail_positions,
            wheels,
            wheel_distances: wheel_distances(scene, practice, &roots),
            driven,
            friction,
            flange_play,
            speeds: speeds(scene, practice),
            stop_stiffness: end_stops(scene, practice).map(|stop| stop.stiffness).sum(),
            buffer: crane_buffer(scene, practice, &layout),
            fixed_weights,
            trolley_line,
        })
    }

    /// Distance from the foremost to the last wheel.
    #[must_use]
    pub fn wheel_base(&self) -> f64 {
        self.wheel_distances.last().copied().unwrap_or_default()
    }

    /// Static vertical forces of both rails with trolley and load at the lateral coordinate `z`, by equilibrium of
    /// moments; without trolley and load for `None`.
    #[must_use]
    pub fn static_rail_forces(&self, z: Option<f64>) -> [f64; 2] {
        let [first, second] = self.rail_positions;
        let moving = z.map(|z| [z, self.model.trolley + self.model.lifted]);
        let (mut sum, mut far) = (0.0, 0.0);
        for [z, weight] in self.fixed_weights.iter().copied().chain(moving) {
            sum += weight;
            far += weight * (z - first) / (second - first);
        }
        [sum - far, far]
    }
}

/// Weights at fixed positions on the bridge, with the structures that it carries: (lateral coordinate, weight).
fn fixed_weights(
    scene: &Scene,
    crane: usize,
    layout: &ScenePositions,
    roots: &Roots,
) -> Vec<[f64; 2]> {
    let g = scene.gravity;
    let mut weights: Vec<[f64; 2]> = scene
        .bodies
        .iter()
        .zip(roots)
        .filter(|(_, (root, _))| *root == crane)
        .map(|(body, (_, arm))| [body.cg[2] + arm[2], body.mass * g])
        .collect();
    for mount in layout.carried(crane) {
        let mass = mount.mass[1][1];
        if mass > 0.0 {
            // a roll about x moves a mass at z vertically by -z
            weights.push([0.0 - mount.mass[1][3] / mass, mass * g]);
        }
    }
    weights
}

/// Lateral coordinate of the trolley on the bridge as a linear function of its rail coordinate: value at 0, and
/// slope.
fn trolley_line(scene: &Scene, trolley: usize, layout: &ScenePositions) -> Option<[f64; 2]> {
    let (_, line) = layout.track(trolley)?;
    let [_, _, offset] = layout.rotated(trolley, scene.bodies[trolley].cg);
    Some([line.origin[2] + offset, line.along[2]])
}

/// Distances from the foremost wheel of the crane to each of its wheels on the first rail.
fn wheel_distances(scene: &Scene, practice: &Practice, roots: &Roots) -> Vec<f64> {
    let trucks = scene
        .trucks
        .iter()
        .filter(|truck| roots[truck.body].0 == practice.crane && truck.rail == practice.rails[0]);
    let mut places: Vec<f64> = trucks
        .flat_map(|truck| {
            truck
                .wheel_offsets()
                .into_iter()
                .map(|x| x + roots[truck.body].1[0])
        })
        .collect();
    places.sort_by(|a, b| b.total_cmp(a));
    places.iter().map(|x| places[0] - x).collect()
}

/// The first buffer between the crane and another body.
fn crane_buffer(
    scene: &Scene,
    practice: &Practice,
    layout: &ScenePositions,
) -> Option<CraneBuffer> {
    let met = scene.stops.iter().enumerate().find_map(|(index, stop)| {
        let meeting = stop.points.first()?;
        let pair = [stop.against?, meeting.body];
        let other = pair.into_iter().find(|body| *body != practice.crane)?;
        pair.contains(&practice.crane)
            .then_some((index, stop.stiffness, other))
    });
    let (stop, stiffness, other) = met?;
    let own = scene
        .bodies
        .iter()
        .enumerate()
        .filter(|(body, _)| root_body(scene, *body).0 == other);
    let mass: f64 = own.map(|(_, body)| body.mass).sum();
    let carried: f64 = layout.carried(other).map(|mount| mount.mass[1][1]).sum();
    let speed = commanded_speed(scene, other).unwrap_or_default();
    Some(CraneBuffer {
        stop,
        stiffness,
        weight: (mass + carried) * scene.gravity,
        speed,
    })
}

/// Largest commanded speed of the drive of a body.
fn commanded_speed(scene: &Scene, body: usize) -> Option<f64> {
    let BodyMotion::Driven(drive) = &scene.bodies[body].motion else {
        return None;
    };
    drive
        .speed
        .breaks()
        .map(|t| drive.speed.at(t).abs())
        .reduce(f64::max)
}

/// Rated speeds of bridge, trolley and hoist, or the largest speeds commanded to drives and hoists where none are
/// specified.
fn speeds(scene: &Scene, practice: &Practice) -> [Option<f64>; 3] {
    let switched = scene
        .events
        .iter()
        .flat_map(|event| &event.rule.actions)
        .filter_map(|action| match action {
            Action::Hoist { speed, .. } => Some(speed.abs()),
            _ => None,
        });
    let tables = scene
        .ropes
        .iter()
        .flat_map(|rope| rope.speed.breaks().map(|t| rope.speed.at(t).abs()));
    let hoist = tables.chain(switched).fold(0.0, f64::max);
    let commanded = [
        commanded_speed(scene, practice.crane),
        practice
            .trolley
            .and_then(|body| commanded_speed(scene, body)),
        Some(hoist),
    ];
    std::array::from_fn(|k| practice.speeds[k].or(commanded[k].filter(|speed| *speed > 0.0)))
}

impl CraneData {
    /// Names and values for a summary or a report.
    #[must_use]
    pub fn list(&self) -> Vec<(&'static str, f64, Dimension)> {
        let mut list = vec![
            ("lifted", self.model.lifted, Dimension::FORCE),
            ("trolley", self.model.trolley, Dimension::FORCE),
            ("bridge", self.model.bridge, Dimension::FORCE),
            ("span", self.model.span, Dimension::LENGTH),
            ("approach", self.model.approach, Dimension::LENGTH),
            ("wheels", f64::from(self.model.wheels), Dimension::NUMBER),
            ("wheel_base", self.wheel_base(), Dimension::LENGTH),
            (
                "driven_wheels",
                (self.driven[0] + self.driven[1]) as f64,
                Dimension::NUMBER,
            ),
        ];
        let words = ["bridge_speed", "trolley_speed", "hoist_speed"];
        let speeds = words.into_iter().zip(self.speeds);
        list.extend(speeds.filter_map(|(word, speed)| Some((word, speed?, Dimension::SPEED))));
        list
    }
}
