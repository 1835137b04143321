//! Where bodies and wheels are at one row of a record, in the frame of the tracks on the ground: x along, y up from the
//! unloaded rails, z to the right.

use sim::{Axle, Mount};

use crate::record::NamedColumns;
use formats::scene::{Scene, Truck, seat};
use foundations::Error;

/// A scene with the places of the rails that ride on bodies.
pub struct ScenePositions<'s> {
    scene: &'s Scene,
    mounts: Vec<Option<Mount>>,
}

impl<'s> ScenePositions<'s> {
    /// Of `scene`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(scene: &'s Scene) -> Result<ScenePositions<'s>, Error> {
        let mounts = scene.structures.iter().map(foundations::mount).collect::<Result<_, _>>()?;
        Ok(ScenePositions { scene, mounts })
    }

    /// Structures that ride on `body`, with their mass and their rails from its origin.
    pub fn carried(&self, body: usize) -> impl Iterator<Item = &Mount> {
        self.mounts.iter().flatten().filter(move |mount| mount.body == body)
    }

    /// Rail of the scene as a line on the body that carries it; `None` on the ground.
    #[must_use]
    pub fn axle(&self, rail: usize) -> Option<(usize, Axle)> {
        let own = &self.scene.rails[rail];
        let mount = self.mounts[own.structure].as_ref()?;
        Some((mount.body, *mount.rails.get(own.rail)?))
    }

    /// The line that a body rides along on its carrier: the mean of its rails; `None` on the ground.
    #[must_use]
    pub fn track(&self, body: usize) -> Option<(usize, Axle)> {
        let rails = &self.scene.bodies[body].track;
        let lines: Vec<(usize, Axle)> = rails.iter().filter_map(|rail| self.axle(*rail)).collect();
        let (carrier, first) = *lines.first()?;
        let mean = |k: usize| lines.iter().map(|(_, axle)| axle.origin[k] / lines.len() as f64).sum();
        Some((carrier, Axle { origin: [mean(0), mean(1), mean(2)], along: first.along }))
    }

    /// Origin of a body at a row.
    #[must_use]
    pub fn origin(&self, record: &NamedColumns, body: usize, row: usize) -> [f64; 3] {
        let own = &self.scene.bodies[body];
        let at = |part: &str| record.part(&own.name, part).get(row).copied().unwrap_or_default();
        if own.in_space {
            return ["X", "Y", "Z"].map(at);
        }
        if let Some((to, pin)) = own.pinned {
            let base = self.origin(record, to, row);
            let arm = self.turned(to, pin);
            return [0, 1, 2].map(|k| base[k] + arm[k]);
        }
        let moved = [at("x"), self.radius(body) - at("deflection"), at("z")];
        let Some((carrier, axle)) = self.track(body) else { return moved };
        let base = self.origin(record, carrier, row);
        let own = self.turned(body, [0.0, moved[1], moved[2]]);
        [0, 1, 2].map(|k| base[k] + axle.origin[k] + axle.along[k] * moved[0] + own[k])
    }

    /// An arm along a body's x, y and z as one along those of the tracks on the ground, small rotations left out.
    #[must_use]
    pub fn turned(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.track(seat(self.scene, body).0) {
            Some((_, Axle { along: [a, _, c], .. })) => [a * x - c * z, y, c * x + a * z],
            None => [x, y, z],
        }
    }

    /// Height of a body's origin over its rails where the wheels just touch: the radius of its wheels.
    fn radius(&self, body: usize) -> f64 {
        let truck = self.scene.trucks.iter().find(|truck| seat(self.scene, truck.body).0 == body);
        truck.map_or(0.0, |truck| self.scene.wheels[truck.wheel].radius - truck.at[1])
    }

    /// From a body's origin to each wheel of one of its trucks, along its own x, y and z.
    #[must_use]
    pub fn wheels(&self, truck: &Truck) -> Vec<[f64; 3]> {
        truck.wheel_offsets().into_iter().map(|x| [x, truck.at[1], truck.at[2]]).collect()
    }
}
