//! Axial forces of members, and stiffness of rigid arms, in a motion of the bodies.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, SVector, Vector3};

use super::given::ArmForce;
use crate::assembly::{Element, Real, end_displacements};
use crate::influence::FactoredFrame;
use crate::model::{ArmStiffness, Model};

/// Forces of a member in a motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MemberForces {
    /// Axial force, positive in tension: the mean over the length.
    pub axial: f64,
    /// Largest bending moment at its ends.
    pub moment: f64,
    /// Angle by which the line between its ends turns.
    pub turned: f64,
}

/// What the motions of the bodies under a preload say.
pub(super) struct StateForces {
    pub members: Vec<MemberForces>,
    pub arms: Vec<ArmStiffness>,
}

impl StateForces {
    /// The forces of `frame` in motions of the references of its bodies; `on_arms` are the forces of the preload itself.
    pub fn new(
        m: &Model,
        frame: &FactoredFrame,
        motions: &[SVector<f64, 6>],
        on_arms: &[ArmForce],
    ) -> StateForces {
        let mut arms = Arms::default();
        on_arms
            .iter()
            .for_each(|given| arms.add(given.body, &given.arm, &given.force));
        let bodies = &frame.bodies;
        let members = frame.elements.iter().map(|element| {
            let (forces, ends) = member_forces(element, frame, motions);
            for (end, force) in ends.into_iter().enumerate() {
                let point = element.points[end];
                let arm = bodies.arms[point].map(Real::double) + element.offsets[end];
                arms.add(bodies.of_point[point], &arm, &-force);
            }
            forces
        });
        let members = members.collect();
        for spring in m.springs.iter().filter(|spring| (spring.dof as usize) < 3) {
            let body = bodies.of_point[spring.point];
            let motion = bodies.motion(spring.point, &Vector3::zeros()) * motions[body];
            let mut force = Vector3::zeros();
            force[spring.dof as usize] = -spring.stiffness * motion[spring.dof as usize];
            arms.add(body, &bodies.arms[spring.point].map(Real::double), &force);
        }
        StateForces {
            members,
            arms: arms.of_bodies(frame),
        }
    }
}

/// Forces of a member and, at its ends, the forces on it, global.
fn member_forces(
    element: &Element,
    frame: &FactoredFrame,
    motions: &[SVector<f64, 6>],
) -> (MemberForces, [Vector3<f64>; 2]) {
    let Some(tips) = end_displacements(element, &frame.bodies, motions) else {
        return (MemberForces::default(), [Vector3::zeros(); 2]);
    };
    let force = element.stiffness() * tips;
    let moment = [4, 5, 10, 11]
        .into_iter()
        .fold(0.0_f64, |most, k| most.max(force[k].abs()));
    let across = (tips[7] - tips[1]).hypot(tips[8] - tips[2]);
    let global =
        |k: usize| element.axes.transpose() * Vector3::new(force[k], force[k + 1], force[k + 2]);
    let forces = MemberForces {
        axial: force[6],
        moment,
        turned: across / element.length,
    };
    (forces, [global(0), global(6)])
}

/// Sums of the stiffness of rigid arms, by body.
#[derive(Default)]
struct Arms {
    of: BTreeMap<usize, Matrix3<f64>>,
}

impl Arms {
    /// Adds that of a force at the tip of an arm: (F . r) I - (F r^T + r F^T)/2.
    fn add(&mut self, body: usize, arm: &Vector3<f64>, force: &Vector3<f64>) {
        if *arm == Vector3::zeros() || *force == Vector3::zeros() {
            return;
        }
        let product = force * arm.transpose();
        let own = Matrix3::identity() * force.dot(arm) - (product + product.transpose()) * 0.5;
        *self.of.entry(body).or_insert_with(Matrix3::zeros) += own;
    }

    fn of_bodies(self, frame: &FactoredFrame) -> Vec<ArmStiffness> {
        let of = self
            .of
            .into_iter()
            .filter(|(_, stiffness)| *stiffness != Matrix3::zeros());
        let arm = |(body, stiffness): (usize, Matrix3<f64>)| ArmStiffness {
            point: frame.bodies.list[body].reference,
            stiffness: std::array::from_fn(|i| std::array::from_fn(|j| stiffness[(i, j)])),
        };
        of.map(arm).collect()
    }
}
