//! A crane as codes describe it: weights, span, approach, wheels and speeds, from the scene and its run.

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
    pub crane: practice::Crane,
    /// Whether that approach is the smallest in the run, because the scene gives none.
    pub approach_is_found: bool,
    /// Lateral coordinates of its rails.
    pub across: [f64; 2],
    /// Indices of its wheels on each rail.
    pub wheels: [Vec<usize>; 2],
    /// Distances from the foremost wheel to each wheel of the first rail.
    pub pairs: Vec<f64>,
    /// Driven wheels on each rail.
    pub driven: [usize; 2],
    /// Least friction coefficient of the driven wheels.
    pub friction: Option<f64>,
    /// Free play sideways, both ways together, of each rail's flanges; `None`: a rail without.
    pub play: [Option<f64>; 2],
    /// Speeds of bridge, trolley and hoist: rated, else the largest commanded.
    pub speeds: [Option<f64>; 3],
    /// Stiffness of the end stops that it meets, together.
    pub buffers: f64,
    /// The first buffer between it and another crane.
    pub between: Option<Between>,
    /// Weights that stand where they are on the bridge: place across the track, weight.
    pub fixed: Vec<[f64; 2]>,
    /// The trolley's line on the bridge: place across the track of its coordinate 0, and its slope.
    pub line: Option<[f64; 2]>,
}

/// A buffer between two cranes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Index of the stop.
    pub stop: usize,
    /// Its stiffness.
    pub stiffness: f64,
    /// Weight of the other crane without loads on ropes.
    pub weight: f64,
    /// Largest speed that the other is commanded.
    pub speed: f64,
}

/// To metres and newtons.
#[must_use]
pub(super) fn to_si(units: Units) -> Scale {
    Scale { from: units, to: Units::SI }
}

impl CraneData {
    /// Of the crane that `practice` names.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(
        scene: &Scene,
        practice: &Practice,
        cast: &SimulationInput,
        record: &NamedColumns,
    ) -> Result<CraneData, Error> {
        let layout = ScenePositions::new(scene)?;
        let g = scene.gravity;
        let all: Vec<(usize, [f64; 3])> =
            (0..scene.bodies.len()).map(|body| root_body(scene, body)).collect();
        let mut fixed: Vec<[f64; 2]> = scene
            .bodies
            .iter()
            .zip(&all)
            .filter(|(_, (root, _))| *root == practice.crane)
            .map(|(body, (_, arm))| [body.cg[2] + arm[2], body.mass * g])
            .collect();
        for mount in layout.carried(practice.crane) {
            let mass = mount.mass[1][1];
            if mass > 0.0 {
                // a roll about x moves what lies at z by -z
                fixed.push([0.0 - mount.mass[1][3] / mass, mass * g]);
            }
        }
        let weight = |counts: &dyn Fn(usize) -> bool| -> f64 {
            (0..all.len()).filter(|body| counts(*body)).map(|body| scene.bodies[body].mass * g).sum()
        };
        let across = practice.rails.map(|rail| mean_lateral_position(scene, practice.crane, rail));
        let line = practice.trolley.and_then(|trolley| {
            let (_, axle) = layout.track(trolley)?;
            let [_, _, off] = layout.rotated(trolley, scene.bodies[trolley].cg);
            Some([axle.origin[2] + off, axle.along[2]])
        });
        let wheels = practice.rails.map(|rail| {
            let wheels = cast.wheels.iter().enumerate();
            let own = wheels.filter(|(_, wheel)| all[wheel.body].0 == practice.crane && wheel.rail == rail);
            own.map(|(index, _)| index).collect::<Vec<usize>>()
        });
        let kinds = wheels
            .each_ref()
            .map(|own| own.iter().map(|w| &scene.wheels[cast.wheels[*w].kind]).collect::<Vec<_>>());
        let driven = kinds.each_ref().map(|own| own.iter().filter(|kind| kind.driven).count());
        let frictions = kinds.iter().flatten().filter(|kind| kind.driven);
        let friction = frictions.filter_map(|kind| Some(kind.friction.as_ref()?.mu)).reduce(f64::min);
        let play = kinds.each_ref().map(|own| {
            let flanges = own.iter().filter_map(|kind| Some(2.0 * kind.lateral.as_ref()?.clearance));
            flanges.reduce(f64::max)
        });
        let trucks = scene
            .trucks
            .iter()
            .filter(|truck| all[truck.body].0 == practice.crane && truck.rail == practice.rails[0]);
        let mut places: Vec<f64> = trucks
            .flat_map(|truck| truck.wheel_offsets().into_iter().map(|x| x + all[truck.body].1[0]))
            .collect();
        places.sort_by(|a, b| b.total_cmp(a));
        let pairs = places.iter().map(|x| places[0] - x).collect();
        let nearest = practice.trolley.zip(line).map(|(trolley, [origin, slope])| {
            let places = record.part(&scene.bodies[trolley].name, "x").iter().map(|x| origin + slope * x);
            places.flat_map(|z| across.map(|rail| (z - rail).abs())).fold(f64::INFINITY, f64::min)
        });
        let span = (across[0] - across[1]).abs();
        let crane = practice::Crane {
            lifted: weight(&|body| practice.loads.contains(&body)),
            trolley: weight(&|body| practice.trolley == Some(all[body].0)),
            bridge: fixed.iter().map(|[_, weight]| weight).sum(),
            span,
            approach: practice.approach.or(nearest).unwrap_or(0.5 * span).min(span),
            wheels: u32::try_from(wheels[0].len().max(wheels[1].len())).unwrap_or(u32::MAX),
        };
        Ok(CraneData {
            crane,
            approach_is_found: practice.approach.is_none() && nearest.is_some(),
            across,
            wheels,
            pairs,
            driven,
            friction,
            play,
            speeds: speeds(scene, practice),
            buffers: end_stops(scene, practice).map(|stop| stop.stiffness).sum(),
            between: between(scene, practice, &layout),
            fixed,
            line,
        })
    }

    /// From the foremost to the last wheel.
    #[must_use]
    pub fn base(&self) -> f64 {
        self.pairs.last().copied().unwrap_or_default()
    }

    /// What statics puts on the rails with trolley and load at `z` across the track, by the lever.
    #[must_use]
    pub fn at_rest(&self, z: Option<f64>) -> [f64; 2] {
        let [first, second] = self.across;
        let moving = z.map(|z| [z, self.crane.trolley + self.crane.lifted]);
        let (mut sum, mut far) = (0.0, 0.0);
        for [z, weight] in self.fixed.iter().copied().chain(moving) {
            sum += weight;
            far += weight * (z - first) / (second - first);
        }
        [sum - far, far]
    }
}

/// The first buffer between the crane and another body.
fn between(scene: &Scene, practice: &Practice, layout: &ScenePositions) -> Option<Between> {
    let met = scene.stops.iter().enumerate().find_map(|(index, stop)| {
        let meeting = stop.points.first()?;
        let pair = [stop.against?, meeting.body];
        let other = pair.into_iter().find(|body| *body != practice.crane)?;
        pair.contains(&practice.crane).then_some((index, stop.stiffness, other))
    });
    let (stop, stiffness, other) = met?;
    let own = scene.bodies.iter().enumerate().filter(|(body, _)| root_body(scene, *body).0 == other);
    let mass: f64 = own.map(|(_, body)| body.mass).sum();
    let carried: f64 = layout.carried(other).map(|mount| mount.mass[1][1]).sum();
    let speed = driven(scene, other).unwrap_or_default();
    Some(Between { stop, stiffness, weight: (mass + carried) * scene.gravity, speed })
}

/// The largest speed that a body's drive is commanded.
fn driven(scene: &Scene, body: usize) -> Option<f64> {
    let BodyMotion::Driven(drive) = &scene.bodies[body].motion else { return None };
    drive.speed.breaks().map(|t| drive.speed.at(t).abs()).reduce(f64::max)
}

/// Rated speeds, else the largest that drives and hoists are commanded.
fn speeds(scene: &Scene, practice: &Practice) -> [Option<f64>; 3] {
    let switched =
        scene.events.iter().flat_map(|event| &event.rule.actions).filter_map(|action| match action {
            Action::Hoist { speed, .. } => Some(speed.abs()),
            _ => None,
        });
    let tables = scene.ropes.iter().flat_map(|rope| rope.speed.breaks().map(|t| rope.speed.at(t).abs()));
    let hoist = tables.chain(switched).fold(0.0, f64::max);
    let found =
        [driven(scene, practice.crane), practice.trolley.and_then(|body| driven(scene, body)), Some(hoist)];
    let each =
        practice.speeds.iter().zip(found).map(|(given, found)| given.or(found.filter(|speed| *speed > 0.0)));
    let mut out = [None; 3];
    out.iter_mut().zip(each).for_each(|(out, speed)| *out = speed);
    out
}

impl CraneData {
    /// Names and values for a summary or a report.
    #[must_use]
    pub fn list(&self) -> Vec<(&'static str, f64, Dimension)> {
        let mut list = vec![
            ("lifted", self.crane.lifted, Dimension::FORCE),
            ("trolley", self.crane.trolley, Dimension::FORCE),
            ("bridge", self.crane.bridge, Dimension::FORCE),
            ("span", self.crane.span, Dimension::LENGTH),
            ("approach", self.crane.approach, Dimension::LENGTH),
            ("wheels", f64::from(self.crane.wheels), Dimension::NUMBER),
            ("wheel_base", self.base(), Dimension::LENGTH),
            ("driven_wheels", (self.driven[0] + self.driven[1]) as f64, Dimension::NUMBER),
        ];
        let words = ["bridge_speed", "trolley_speed", "hoist_speed"];
        let speeds = words.into_iter().zip(self.speeds);
        list.extend(speeds.filter_map(|(word, speed)| Some((word, speed?, Dimension::SPEED))));
        list
    }
}
