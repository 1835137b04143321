//! The terms of the energy balance, to which every force element contributes.

/// Energy stored in a scene at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Kinetic energy of bodies, wheels and structures.
    pub kinetic: f64,
    /// Potential energy of weight; zero where every body touches the unloaded rail.
    pub gravity: f64,
    /// Elastic energy between wheel and rail, flanges included.
    pub contact: f64,
    /// Elastic energy of the structures.
    pub structure: f64,
    /// Elastic energy of ropes and stops.
    pub ropes: f64,
}

impl Stored {
    /// Sum of all terms.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.contact + self.structure + self.ropes
    }
}

/// Energy lost and supplied since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchanged {
    /// Lost in the dampers of contacts, ropes and stops.
    pub dampers: f64,
    /// Lost in sliding, brakes included.
    pub friction: f64,
    /// Lost when flanges are released, and gained when they engage.
    pub flanges: f64,
    /// Lost at the transfer of wheels between the parts of a structure that has one force per part.
    pub handover: f64,
    /// Lost by the damping of the structures.
    pub structure: f64,
    /// Lost when a contact opens or closes with a jump of its force.
    pub switches: f64,
    /// Supplied by prescribed motions and drives.
    pub drives: f64,
    /// Supplied by loads.
    pub loads: f64,
    /// Supplied by hoisting.
    pub hoists: f64,
    /// Supplied at steps of uneven rails; the work of rail slopes is included in `drives` or in the energy of the
    /// body.
    pub rail_steps: f64,
}

impl Exchanged {
    /// Energy that left the scene, minus the energy supplied.
    #[must_use]
    pub fn net_loss(&self) -> f64 {
        self.dampers + self.friction + self.flanges + self.handover + self.structure + self.switches
            - self.supplied()
    }

    /// Work supplied by prescribed motions, drives, loads, hoisting and rail steps.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every term is a different power of two, so that sums show which terms they contain, and with what sign.
    fn exchanged() -> Exchanged {
        Exchanged {
            dampers: 1.0,
            friction: 2.0,
            flanges: 4.0,
            handover: 8.0,
            structure: 16.0,
            switches: 32.0,
            drives: 64.0,
            loads: 128.0,
            hoists: 256.0,
            rail_steps: 512.0,
        }
    }

    #[test]
    fn every_term_counts_once_as_a_loss_or_as_supplied() {
        assert_eq!(exchanged().supplied(), 64.0 + 128.0 + 256.0 + 512.0);
        assert_eq!(exchanged().net_loss(), 63.0 - 960.0);
        let stored = Stored {
            kinetic: 1.0,
            gravity: 2.0,
            contact: 4.0,
            structure: 8.0,
            ropes: 16.0,
        };
        assert_eq!(stored.total(), 31.0);
    }

    #[test]
    fn every_power_is_added_with_its_weight() {
        let mut sum = exchanged();
        sum.add(&exchanged(), 0.5);
        assert_eq!(
            (sum.supplied(), sum.net_loss()),
            (1.5 * 960.0, 1.5 * (63.0 - 960.0))
        );
        sum.add(&exchanged(), -1.5);
        assert_eq!(sum, Exchanged::default());
    }
}
