//! Errors of the forces of wheels, relative to the size of the force of each wheel.

use super::events::rounding_among;
use crate::Channel;
use crate::contact::system::System;

/// An element that is a force of a wheel.
struct Share {
    wheel: usize,
    element: usize,
    divisor: f64,
    /// 0 for the vertical force, 1 for the lateral force, 2 for friction.
    axis: usize,
}

/// The size S of the vertical force of each wheel: the larger of its static load and its largest force so far. Lateral
/// forces and friction are measured by the S of their wheel.
pub(crate) struct WheelForces {
    shares: Vec<Share>,
    size: Vec<f64>,
    /// Scratch: the forces or their errors, one triple for each wheel.
    sums: Vec<[f64; 3]>,
}

impl WheelForces {
    /// Begins with the forces of the elements at the start. A wheel without force there, but for rounding, begins with an equal
    /// share of the total weight.
    pub fn new(system: &System, force: &[f64]) -> Self {
        let mut shares = Vec::new();
        for (element, own) in system.elements.iter().enumerate() {
            for (channel, divisor) in own.channels(&system.mechanics) {
                let (wheel, axis) = match channel {
                    Channel::Vertical(wheel) => (wheel, 0),
                    Channel::Lateral(wheel) => (wheel, 1),
                    Channel::Traction(wheel) => (wheel, 2),
                    _ => continue,
                };
                shares.push(Share {
                    wheel,
                    element,
                    divisor,
                    axis,
                });
            }
        }
        let count = system.mechanics.wheels.len();
        let weight: f64 = system
            .scene
            .bodies
            .iter()
            .map(|body| body.mass * system.scene.gravity)
            .sum();
        let mut forces = WheelForces {
            shares,
            size: vec![0.0; count],
            sums: vec![[0.0; 3]; count],
        };
        forces.grow(force);
        let rounding = rounding_among(forces.size.iter().copied());
        forces
            .size
            .iter_mut()
            .filter(|size| **size <= rounding)
            .for_each(|size| *size = weight / count as f64);
        forces
    }

    fn add_up(&mut self, force: &[f64]) {
        self.sums.fill([0.0; 3]);
        for share in &self.shares {
            self.sums[share.wheel][share.axis] += force[share.element] / share.divisor;
        }
    }

    /// Increases the sizes to the forces of the elements at the end of a step.
    pub fn grow(&mut self, force: &[f64]) {
        self.add_up(force);
        for (size, sums) in self.size.iter_mut().zip(&self.sums) {
            *size = size.max(sums[0].abs());
        }
    }

    /// The size of the force of an element, the S of its wheels; 0 for an element that is no force of a wheel.
    pub fn size(&self, element: usize) -> f64 {
        let own = self.shares.iter().filter(|share| share.element == element);
        own.map(|share| share.divisor * self.size[share.wheel])
            .fold(0.0, f64::max)
    }

    /// Largest error of a wheel force relative to S, from the errors of the forces of the elements.
    pub fn relative(&mut self, errors: &[f64]) -> f64 {
        self.add_up(errors);
        let mut largest = 0.0_f64;
        for (size, sums) in self
            .size
            .iter()
            .zip(&self.sums)
            .filter(|(size, _)| **size > 0.0)
        {
            largest = sums
                .iter()
                .fold(largest, |max, sum| max.max(sum.abs() / size));
        }
        largest
    }
}
