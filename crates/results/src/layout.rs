//! Positions of bodies and wheels at one row of the columns, in the frame of the tracks on the ground: x along the
//! track, y up from the unloaded rails, z to the right.

use sim::{CarriedRail, Carrier};

use crate::columns::NamedColumns;
use formats::scene::{Scene, Truck, root_body};
use foundations::Error;

/// Computes the positions of the bodies of a scene, taking into account the rails that other bodies carry.
pub struct ScenePositions<'s> {
    scene: &'s Scene,
    carriers: Vec<Option<Carrier>>,
}

impl<'s> ScenePositions<'s> {
    /// The positions of the bodies of `scene`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(scene: &'s Scene) -> Result<ScenePositions<'s>, Error> {
        let carriers = scene
            .structures
            .iter()
            .map(foundations::mount)
            .collect::<Result<_, _>>()?;
        Ok(ScenePositions { scene, carriers })
    }

    /// The structures that `body` carries, with their mass and the lines of their rails relative to its origin.
    pub fn carried(&self, body: usize) -> impl Iterator<Item = &Carrier> {
        self.carriers
            .iter()
            .flatten()
            .filter(move |carrier| carrier.body == body)
    }

    /// The carrier of a rail of the scene and the line of the rail relative to it; `None` for a rail on the ground.
    #[must_use]
    pub fn rail_line(&self, rail: usize) -> Option<(usize, CarriedRail)> {
        let own = &self.scene.rails[rail];
        let carrier = self.carriers[own.structure].as_ref()?;
        Some((carrier.body, *carrier.rails.get(own.rail)?))
    }

    /// The carrier of a body and the line along which the body moves relative to it, the mean of its rails; `None`
    /// for a body on the ground.
    #[must_use]
    pub fn track(&self, body: usize) -> Option<(usize, CarriedRail)> {
        let rails = &self.scene.bodies[body].track;
        let lines: Vec<(usize, CarriedRail)> = rails
            .iter()
            .filter_map(|rail| self.rail_line(*rail))
            .collect();
        let (carrier, first) = *lines.first()?;
        let mean = |k: usize| {
            lines
                .iter()
                .map(|(_, line)| line.origin[k] / lines.len() as f64)
                .sum()
        };
        Some((
            carrier,
            CarriedRail {
                origin: [mean(0), mean(1), mean(2)],
                along: first.along,
            },
        ))
    }

    /// Position of the origin of a body at a row of the record.
    #[must_use]
    pub fn origin(&self, record: &NamedColumns, body: usize, row: usize) -> [f64; 3] {
        let own = &self.scene.bodies[body];
        let at = |part: &str| {
            record
                .part(&own.name, part)
                .get(row)
                .copied()
                .unwrap_or_default()
        };
        if own.in_space {
            return ["X", "Y", "Z"].map(at);
        }
        if let Some((to, pin)) = own.pinned {
            let base = self.origin(record, to, row);
            let arm = self.rotated(to, pin);
            return [0, 1, 2].map(|k| base[k] + arm[k]);
        }
        let moved = [at("x"), self.height(body) - at("deflection"), at("z")];
        let Some((carrier, line)) = self.track(body) else {
            return moved;
        };
        let base = self.origin(record, carrier, row);
        let own = self.rotated(body, [0.0, moved[1], moved[2]]);
        [0, 1, 2].map(|k| base[k] + line.origin[k] + line.along[k] * moved[0] + own[k])
    }

    /// Transforms a vector from the axes of a body to the axes of the tracks on the ground; small rotations are
    /// neglected.
    #[must_use]
    pub fn rotated(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.track(root_body(self.scene, body).0) {
            Some((
                _,
                CarriedRail {
                    along: [a, _, c], ..
                },
            )) => [a * x - c * z, y, c * x + a * z],
            None => [x, y, z],
        }
    }

    /// Height of the origin of a body over its rails at which its wheels touch them without load.
    fn height(&self, body: usize) -> f64 {
        let truck = self
            .scene
            .trucks
            .iter()
            .find(|truck| root_body(self.scene, truck.body).0 == body);
        truck.map_or(0.0, |truck| {
            self.scene.wheels[truck.wheel].radius - truck.at[1]
        })
    }

    /// Vectors from the origin of a body to each wheel of one of its trucks, in the axes of the body.
    #[must_use]
    pub fn wheels(&self, truck: &Truck) -> Vec<[f64; 3]> {
        truck
            .wheel_offsets()
            .into_iter()
            .map(|x| [x, truck.at[1], truck.at[2]])
            .collect()
    }
}
