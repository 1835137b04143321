//! What the deflection of a rail gains from a load that stands before the section on the same member.
//!
//! A load of force f and couple c at a distance d before the section changes the internal force there by -f and the
//! internal moment by -c + d t x f, t being the axis of the member. With its flexibilities B for bending and torsion and S
//! for stretch and shear, rotation and displacement gain
//!
//! theta(d) = B (-c d + t x f d^2/2),    u(d) = [B (-c d^2/2 + t x f d^3/6)] x t - S f d,
//!
//! and a point of the rail at the arm a from the axis moves by u + theta x a. Under an axial force N each plane has its
//! mu = 1 + N/kGA, and 1/2 and 1/6 become C2 and C3/mu of `splines::BeamColumn`: then k1 is exact, and k2 and k3 are those of
//! the straight line through two values of (K(d) - k1 d)/d^2.

use nalgebra::Vector3;

use crate::error::Error;
use crate::structure::{Carrier, DEFLECTIONS, Structure, deflection_axis};

/// The nodes of Chebyshev for a straight line.
const NODES_OF_TWO: [f64; 2] = [0.146_446_609_406_726_24, 0.853_553_390_593_273_8];
/// Terms of the series of the functions of an axial force on a short part.
const TERMS: i32 = 12;
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
        [
            self.at(d),
            -rate * slope,
            rate * rate * bend,
            -rate * rate * rate * c,
        ]
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
    /// mu by which stretch and shear along both axes are stiffer under axial force, and lambda^2 of torsion and bending about
    /// both axes.
    pub stiffening: [f64; 3],
    squares: [f64; 3],
    /// Length of the part of a member under axial force.
    part: Option<f64>,
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
        let shear = [given.axial, given.shear_y, given.shear_z].map(finite);
        let tension = if carrier.bent.is_some() {
            structure.model.members[carrier.member].tension
        } else {
            0.0
        };
        let stiffening = [1.0, 1.0 + shear[1] * tension, 1.0 + shear[2] * tension];
        let bending = [given.torsion, given.bending_y, given.bending_z].map(finite);
        let offset = structure.frame.line()?.elements()[carrier.element].offset;
        Ok(RailPoint {
            axes: [t, y, t.cross(&y)],
            bending,
            shear,
            stiffening,
            squares: [
                0.0,
                bending[1] * tension / stiffening[2],
                bending[2] * tension / stiffening[1],
            ],
            part: carrier.bent.is_some().then_some(carrier.length),
            arm: axes[0] * offset[0] + axes[1] * offset[1] + axes[2] * offset[2],
            directions: DEFLECTIONS.map(|quantity| {
                let (axis, sign) = deflection_axis(quantity);
                axes[axis.component()] * sign
            }),
        })
    }

    /// A vector whose components along the axes are multiplied by three flexibilities.
    fn scaled(&self, by: [f64; 3], v: &Vector3<f64>) -> Vector3<f64> {
        self.axes
            .iter()
            .zip(by)
            .map(|(axis, by)| axis * (by * axis.dot(v)))
            .sum()
    }

    /// The kernels of both deflections for a force and a couple about the axis of the member.
    pub fn kernels(&self, force: &Vector3<f64>, couple: &Vector3<f64>) -> [Kernel; 2] {
        let t = self.axes[0];
        let shear = std::array::from_fn(|k| self.shear[k] / self.stiffening[k]);
        let turned = self.scaled(self.bending, couple) * -1.0;
        let bent = self.scaled(self.bending, &t.cross(force));
        let first = turned.cross(&self.arm) - self.scaled(shear, force);
        let [second, third] = match self.part {
            None => [
                turned.cross(&t) * 0.5 + bent.cross(&self.arm) * 0.5,
                bent.cross(&t) / 6.0,
            ],
            Some(length) => {
                let [low, high] = NODES_OF_TWO.map(|node| node * length);
                let [at_low, at_high] = [low, high].map(|d| self.curved(&turned, &bent, d));
                let slope = (at_high - at_low) / (high - low);
                [at_low - slope * low, slope]
            }
        };
        // A slope that is only rounding is none: the rail has no kink under this load.
        let size = force.norm() * self.shear.iter().sum::<f64>() + turned.norm() * self.arm.norm();
        self.directions.map(|direction| {
            let [slope, second, third] = [first, second, third].map(|power| power.dot(&direction));
            Kernel([
                if slope.abs() > ROUNDING * size {
                    slope
                } else {
                    0.0
                },
                second,
                third,
            ])
        })
    }

    /// (K(d) - k1 d)/d^2 under axial force, by the rates of turning and bending without it.
    fn curved(&self, turned: &Vector3<f64>, bent: &Vector3<f64>, d: f64) -> Vector3<f64> {
        let t = self.axes[0];
        let mut out = Vector3::zeros();
        for (k, axis) in self.axes.iter().enumerate() {
            // about the axis y the member bends along z, and the other way round
            let mu = self.stiffening[[0, 2, 1][k]];
            let [c2, c3] = curved_powers(self.squares[k] * d * d);
            let [own, of_force] = [axis * axis.dot(turned), axis * axis.dot(bent)];
            out += (own * c2 + of_force * (c3 * d / mu)).cross(&t) / mu;
            out += (own * (c3 * self.squares[k] * d) + of_force * (c2 / mu)).cross(&self.arm);
        }
        out
    }
}

/// (cosh x - 1)/x^2 and (sinh x - x)/x^3 with x^2 = z, small.
fn curved_powers(z: f64) -> [f64; 2] {
    let (mut second, mut third, mut term) = (0.0, 0.0, 0.5);
    for k in 1..TERMS {
        second += term;
        third += term / f64::from(2 * k + 1);
        term *= z / f64::from((2 * k + 1) * (2 * k + 2));
    }
    [second, third]
}
