//! Wheel types: radius, contact laws, friction, spin.

/// A wheel type, which several trucks can share.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelKind {
    /// Its name.
    pub name: String,
    /// Radius of the tread.
    pub radius: f64,
    /// Vertical contact of the tread.
    pub vertical: TreadContact,
    /// Contact of the flange; none if the wheel has no lateral contact.
    pub lateral: Option<FlangeContact>,
    /// Longitudinal friction; none if the wheel rolls without tangential force.
    pub friction: Option<Friction>,
    /// Moment of inertia about the axle, mass length^2; none if the spin follows from rolling without slip.
    pub spin_inertia: Option<f64>,
    /// Whether the drive of its body acts on it. Friction limits the drive force.
    pub driven: bool,
    /// Whether the brake of its body acts on it.
    pub braked: bool,
}

/// Vertical contact: force from penetration and its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreadContact {
    /// Law of the contact force.
    pub law: NormalForceLaw,
    /// Stiffness, force per length^exponent (exponent 1 for the linear law).
    pub k: f64,
    /// Damping, force per speed.
    pub c: f64,
    /// Velocity on which the damper acts.
    pub damper: DamperVelocity,
    /// Whether the contact can transmit tension.
    pub bilateral: bool,
}

/// Law of a vertical contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalForceLaw {
    /// N = k p + c dp/dt for the penetration p.
    Linear,
    /// IMPACT of ADAMS: N = k p^exponent + STEP(p, 0, 0, depth, c) dp/dt.
    Impact {
        /// Exponent of the penetration, at least 1.
        exponent: f64,
        /// Penetration at which the damping coefficient becomes c, length.
        depth: f64,
    },
}

/// The velocity on which the damper of a contact acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DamperVelocity {
    /// Velocity of the wheel relative to the rail.
    Rail,
    /// Absolute velocity of the wheel.
    Ground,
}

/// Flange contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlangeContact {
    /// Stiffness, force / length.
    pub k: f64,
    /// Clearance on either side, length, not negative.
    pub clearance: f64,
    /// Heights of the wheel centre above the rail between which the flange force decreases to zero; none if it is
    /// released when the tread lifts off.
    pub release: Option<[f64; 2]>,
}

/// Dependence of friction on the sliding speed s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionLaw {
    /// STEP(s, -slip, -1, slip, 1).
    Step,
    /// tanh(s / slip).
    Coulomb,
}

/// Longitudinal friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Dependence on the sliding speed.
    pub law: FrictionLaw,
    /// Coefficient of friction, above 0.
    pub mu: f64,
    /// Sliding speed at which friction is full (STEP) or 76 % of mu N (tanh), length / time, above 0.
    pub slip: f64,
}

/// Default exponent of IMPACT.
pub const DEFAULT_IMPACT_EXPONENT: f64 = 1.1;
