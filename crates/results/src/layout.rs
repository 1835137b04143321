//! Positions of bodies and wheels at one row of a record, in the frame of the tracks on the ground: x along the track, y up
//! from the unloaded rails, z to the right.

use sim::{CarriedRail, Carrier};

use crate::columns::NamedColumns;
use formats::scene::{Scene, Truck, root_body};
use foundations::Error;

/// Computes the positions of a scene's bodies, with the lines of those rails that bodies carry.
pub struct ScenePositions<'s> {
    scene: &'s Scene,
    mounts: Vec<Option<Carrier>>,
}

impl<'s> ScenePositions<'s> {
    /// The positions of the bodies of `scene`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(scene: &'s Scene) -> Result<ScenePositions<'s>, Error> {
        let mounts = scene.structures.iter().map(foundations::mount).collect::<Result<_, _>>()?;
        Ok(ScenePositions { scene, mounts })
    }

    /// The structures that `body` carries, with their mass and the lines of their rails relative to its origin.
    pub fn carried(&self, body: usize) -> impl Iterator<Item = &Carrier> {
        self.mounts.iter().flatten().filter(move |mount| mount.body == body)
    }

    /// The line of a rail of the scene on the body that carries it; `None` for a rail on the ground.
    #[must_use]
    pub fn rail_line(&self, rail: usize) -> Option<(usize, CarriedRail)> {
        let own = &self.scene.rails[rail];
        let mount = self.mounts[own.structure].as_ref()?;
        Some((mount.body, *mount.rails.get(own.rail)?))
    }

    /// The line along which a body moves on its carrier, the mean of its rails; `None` for a body on the ground.
    #[must_use]
    pub fn track(&self, body: usize) -> Option<(usize, CarriedRail)> {
        let rails = &self.scene.bodies[body].track;
        let lines: Vec<(usize, CarriedRail)> =
            rails.iter().filter_map(|rail| self.rail_line(*rail)).collect();
        let (carrier, first) = *lines.first()?;
        let mean = |k: usize| lines.iter().map(|(_, axle)| axle.origin[k] / lines.len() as f64).sum();
        Some((carrier, CarriedRail { origin: [mean(0), mean(1), mean(2)], along: first.along }))
    }

    /// Position of the origin of a body at a row of the record.
    #[must_use]
    pub fn origin(&self, record: &NamedColumns, body: usize, row: usize) -> [f64; 3] {
        let own = &self.scene.bodies[body];
        let at = |part: &str| record.part(&own.name, part).get(row).copied().unwrap_or_default();
        if own.in_space {
            return ["X", "Y", "Z"].map(at);
        }
        if let Some((to, pin)) = own.pinned {
            let base = self.origin(record, to, row);
            let arm = self.rotated(to, pin);
            return [0, 1, 2].map(|k| base[k] + arm[k]);
        }
        let moved = [at("x"), self.radius(body) - at("deflection"), at("z")];
        let Some((carrier, axle)) = self.track(body) else { return moved };
        let base = self.origin(record, carrier, row);
        let own = self.rotated(body, [0.0, moved[1], moved[2]]);
        [0, 1, 2].map(|k| base[k] + axle.origin[k] + axle.along[k] * moved[0] + own[k])
    }

    /// A vector in the axes of a body as one in the axes of the tracks on the ground; small rotations are left out.
    #[must_use]
    pub fn rotated(&self, body: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.track(root_body(self.scene, body).0) {
            Some((_, CarriedRail { along: [a, _, c], .. })) => [a * x - c * z, y, c * x + a * z],
            None => [x, y, z],
        }
    }

    /// Height of a body's origin over its rails where its wheels just touch them.
    fn radius(&self, body: usize) -> f64 {
        let truck = self.scene.trucks.iter().find(|truck| root_body(self.scene, truck.body).0 == body);
        truck.map_or(0.0, |truck| self.scene.wheels[truck.wheel].radius - truck.at[1])
    }

    /// Vectors from a body's origin to each wheel of one of its trucks, in the axes of the body.
    #[must_use]
    pub fn wheels(&self, truck: &Truck) -> Vec<[f64; 3]> {
        truck.wheel_offsets().into_iter().map(|x| [x, truck.at[1], truck.at[2]]).collect()
    }
}
