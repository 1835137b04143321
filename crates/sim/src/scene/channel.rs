//! The quantities that a history holds and that rules compare.

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
    /// Force along +x of a body's drive, or that its prescribed motion needs.
    Drive(usize),
    /// Force along +x of a body's brakes.
    Brake(usize),
    /// Rail coordinate of a wheel.
    Position(usize),
    /// Vertical force of a wheel on the rail.
    Vertical(usize),
    /// Lateral force of a wheel on the rail, +z.
    Lateral(usize),
    /// Force of a wheel on the rail along +x: its friction, and its shares of its body's drive and brake.
    Traction(usize),
    /// Penetration of a wheel into the rail, negative where it is off the rail.
    Penetration(usize),
    /// Downward deflection of the rail under a wheel.
    Deflection(usize),
    /// Angle of a wheel about z; rolling towards +x turns it negative.
    SpinAngle(usize),
    /// Angular speed of a wheel about z.
    SpinSpeed(usize),
    /// Moment about z that prescribes the spin of wheel i; zero where it is free.
    SpinMoment(usize),
    /// Tension of a rope.
    Tension(usize),
    /// Distance of the ends of a rope.
    Length(usize),
    /// Force of a stop.
    Stop(usize),
    /// Displacement of a gauge along its axis.
    Gauge(usize),
    /// One degree of freedom of a structure that is [recorded](crate::Foundation::recorded): structure, degree of
    /// freedom.
    Coordinate(usize, usize),
    /// Its second derivative by time; zero in a quasi-static run.
    Acceleration(usize, usize),
}
