//! The terms of the energy balance, to which every force element adds its own.

/// Energy stored in a scene at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Kinetic energy of bodies, wheels and structures.
    pub kinetic: f64,
    /// Potential energy of weight, zero where every body touches the unloaded rail.
    pub gravity: f64,
    /// Elastic energy between wheel and rail, flanges included.
    pub contact: f64,
    /// Elastic energy of the structures.
    pub structure: f64,
    /// Elastic energy of ropes and stops.
    pub ropes: f64,
}

impl Stored {
    /// Sum of all.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.contact + self.structure + self.ropes
    }
}

/// Energy lost and put in since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchanged {
    /// Lost in the dampers of contacts, ropes and stops.
    pub dampers: f64,
    /// Lost in sliding, brakes included.
    pub friction: f64,
    /// Lost as flanges let go, and gained as they take hold.
    pub flanges: f64,
    /// Lost as the parts of a structure hand wheels over, one force a part.
    pub handover: f64,
    /// Lost in the structures' damping.
    pub structure: f64,
    /// Lost where a contact opens or closes with a jump of its force.
    pub switches: f64,
    /// Put in by prescribed motions and drives.
    pub drives: f64,
    /// Put in by loads.
    pub loads: f64,
    /// Put in by hoisting.
    pub hoists: f64,
    /// Put in where wheels meet steps of uneven rails; what their slopes do is in `drives`, or the body's own.
    pub rail_steps: f64,
}

impl Exchanged {
    /// What left the scene, less what was put in.
    #[must_use]
    pub fn net_loss(&self) -> f64 {
        self.dampers + self.friction + self.flanges + self.handover + self.structure + self.switches
            - self.supplied()
    }

    /// Work put in by prescribed motions, drives, loads, hoisting and steps of rails.
    #[must_use]
    pub fn supplied(&self) -> f64 {
        self.drives + self.loads + self.hoists + self.rail_steps
    }

    /// Adds `weight` times `power`.
    pub(crate) fn add(&mut self, power: &Exchanged, weight: f64) {
        self.dampers += weight * power.dampers;
        self.friction += weight * power.friction;
        self.flanges += weight * power.flanges;
        self.handover += weight * power.handover;
        self.structure += weight * power.structure;
        self.switches += weight * power.switches;
        self.drives += weight * power.drives;
        self.loads += weight * power.loads;
        self.hoists += weight * power.hoists;
        self.rail_steps += weight * power.rail_steps;
    }
}
