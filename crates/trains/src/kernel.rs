//! What the deflection of a rail gains from a load that stands before the section on the same member.
//!
//! A load of force f and couple c at a distance d before the section changes the internal force there by -f and the
//! internal moment by -c + d t x f, t being the axis of the member. With its flexibilities B for bending and torsion and S
//! for stretch and shear, rotation and displacement gain
//!
//! theta(d) = B (-c d + t x f d^2/2),    u(d) = [B (-c d^2/2 + t x f d^3/6)] x t - S f d,
//!
//! and a point of the rail at the arm a from the axis moves by u + theta x a.

use nalgebra::Vector3;

use crate::error::Error;
use crate::structure::{Carrier, DEFLECTIONS, Structure, deflection_axis};

/// Slopes below this fraction of their parts are rounding.
const ROUNDING: f64 = 1e-12;

/// K(d) = k1 d + k2 d^2 + k3 d^3, a deflection by the distance d behind a load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Kernel([f64; 3]);

impl Kernel {
    pub fn at(&self, d: f64) -> f64 {
        let [a, b, c] = self.0;
        d * (a + d * (b + d * c))
    }

    /// The slope just behind the load.
    pub fn slope(&self) -> f64 {
        self.0[0]
    }

    /// The second derivative, constant and by the distance.
    pub fn second_derivative(&self) -> [f64; 2] {
        let [_, b, c] = self.0;
        [2.0 * b, 6.0 * c]
    }

    /// Bound of the size of the second derivative up to a distance.
    pub fn second(&self, d: f64) -> f64 {
        let [_, b, c] = self.0;
        2.0 * b.abs() + 6.0 * c.abs() * d
    }

    /// The cubic in t of K(d - rate t).
    pub fn passing(&self, d: f64, rate: f64) -> [f64; 4] {
        let [a, b, c] = self.0;
        let [slope, bend] = [a + d * (2.0 * b + d * 3.0 * c), b + 3.0 * c * d];
        [self.at(d), -rate * slope, rate * rate * bend, -rate * rate * rate * c]
    }
}

/// How a point of the rail over a carrier moves with the sections of its member.
#[derive(Clone, Debug)]
pub(crate) struct RailPoint {
    /// Axis of the member along the rail, and the principal axes of its section.
    pub axes: [Vector3<f64>; 3],
    /// Flexibilities for torsion, bending about both axes; stretch, shear along both axes. 0 where there is no stiffness.
    pub bending: [f64; 3],
    pub shear: [f64; 3],
    /// From the axis of the member to the rail.
    pub arm: Vector3<f64>,
    /// Global directions of the deflections downwards and along +z.
    pub directions: [Vector3<f64>; 2],
}

impl RailPoint {
    pub fn new(structure: &Structure, carrier: &Carrier) -> Result<RailPoint, Error> {
        let t = carrier.triad[0];
        let y = carrier.local[1];
        let section = &structure.model.sections[structure.model.members[carrier.member].section];
        let given = section.flexibility(structure.model.theory);
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let axes = &structure.rails[carrier.rail].axes;
        let offset = structure.frame.line()?.elements()[carrier.element].offset;
        Ok(RailPoint {
            axes: [t, y, t.cross(&y)],
            bending: [given.torsion, given.bending_y, given.bending_z].map(finite),
            shear: [given.axial, given.shear_y, given.shear_z].map(finite),
            arm: axes[0] * offset[0] + axes[1] * offset[1] + axes[2] * offset[2],
            directions: DEFLECTIONS.map(|quantity| {
                let (axis, sign) = deflection_axis(quantity);
                axes[axis.component()] * sign
            }),
        })
    }

    /// A vector whose components along the axes are multiplied by three flexibilities.
    fn scaled(&self, by: [f64; 3], v: &Vector3<f64>) -> Vector3<f64> {
        self.axes.iter().zip(by).map(|(axis, by)| axis * (by * axis.dot(v))).sum()
    }

    /// The kernels of both deflections for a force and a couple about the axis of the member.
    pub fn kernels(&self, force: &Vector3<f64>, couple: &Vector3<f64>) -> [Kernel; 2] {
        let t = self.axes[0];
        let turned = self.scaled(self.bending, couple) * -1.0;
        let bent = self.scaled(self.bending, &t.cross(force));
        let powers = [
            turned.cross(&self.arm) - self.scaled(self.shear, force),
            turned.cross(&t) * 0.5 + bent.cross(&self.arm) * 0.5,
            bent.cross(&t) / 6.0,
        ];
        // A slope that is only rounding is none: the rail has no kink under this load.
        let size = force.norm() * self.shear.iter().sum::<f64>() + turned.norm() * self.arm.norm();
        self.directions.map(|direction| {
            let [slope, second, third] = powers.map(|power| power.dot(&direction));
            Kernel([if slope.abs() > ROUNDING * size { slope } else { 0.0 }, second, third])
        })
    }
}
