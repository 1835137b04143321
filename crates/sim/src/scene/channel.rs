//! Quantities that a history records and that rules compare.

use super::dof::BodyDof;

/// One quantity of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Channel {
    /// Time.
    Time,
    /// Displacement of a body in one degree of freedom.
    Displacement(usize, BodyDof),
    /// Speed of a body in one degree of freedom.
    Speed(usize, BodyDof),
    /// Force along +x of the drive of a body, or the force required by its prescribed motion.
    Drive(usize),
    /// Force along +x of a body's brakes.
    Brake(usize),
    /// Rail coordinate of a wheel.
    Position(usize),
    /// Vertical force of a wheel on the rail.
    Vertical(usize),
    /// Lateral force of a wheel on the rail, +z.
    Lateral(usize),
    /// Force of a wheel on the rail along +x: its friction and its parts of the drive and brake forces of the body.
    Traction(usize),
    /// Penetration of a wheel into the rail, negative where there is a gap.
    Penetration(usize),
    /// Downward deflection of the rail under a wheel.
    Deflection(usize),
    /// Angle of a wheel about z; rolling towards +x is a negative rotation.
    SpinAngle(usize),
    /// Angular velocity of a wheel about z.
    SpinSpeed(usize),
    /// Moment about z that is required for the prescribed spin of a wheel; zero where the spin is free.
    SpinMoment(usize),
    /// Tension of a rope.
    Tension(usize),
    /// Distance between the ends of a rope.
    Length(usize),
    /// Force of a stop.
    Stop(usize),
    /// Displacement of a gauge along its axis.
    Gauge(usize),
    /// One degree of freedom of a [recorded](crate::Foundation::recorded) structure: index of the structure, index of
    /// the degree of freedom.
    Coordinate(usize, usize),
    /// Second time derivative of such a degree of freedom; zero in a quasi-static run.
    Acceleration(usize, usize),
}
