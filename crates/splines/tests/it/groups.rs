//! Coefficients of groups of probes that move together, against sums of the coefficients of all pairs.

use crate::beam;

use std::sync::Arc;

use beam::Random;
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, ElementMember, Error, ExactSurface, Flexibility, GroupMember, Influence,
    KeptProducts, Probe, ProbeGroups, RailElement, Rails,
};

const AXES: [Axis; 3] = [Axis::Longitudinal, Axis::Vertical, Axis::Lateral];
const X: [f64; 4] = [2.0, 8.5, 13.0, 21.0];

/// Which special elements a surface has.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Special {
    None,
    /// The second element of the first rail is under an axial force.
    Tension,
    /// The first elements of both rails are one member.
    SharedMember,
}

/// Two rails of three elements each, the last a rigid arm. The members of the second rail run against it, and all lie beside
/// the rails, so that every direction bends them in both planes and twists them.
fn surface(random: &mut Random, special: Special) -> ExactSurface {
    let element = |rail: usize, k: usize| RailElement {
        rail,
        x: [X[k], X[k + 1]],
        ends: if k == 2 {
            [3 * rail + 2; 2]
        } else {
            [3 * rail + k, 3 * rail + k + 1]
        },
        length: X[k + 1] - X[k] + 0.1,
        frame: [[1.0, 0.0, 0.0], [0.0, 0.8, 0.6], [0.0, -0.6, 0.8]],
        offset: [[0.0, 0.7, -0.3], [0.0, 0.2, 0.5]][rail],
        flexibility: Flexibility {
            axial: 0.3,
            torsion: 0.2,
            bending_y: 0.7,
            bending_z: 0.4,
            shear_y: 1.9,
            shear_z: 1.1,
            tension: if special == Special::Tension && (rail, k) == (0, 1) {
                0.2
            } else {
                0.0
            },
        },
        member: Some(ElementMember {
            id: if special == Special::SharedMember && k == 0 {
                9
            } else {
                3 * rail + k
            },
            reversed: rail == 1,
        }),
    };
    let elements = [0, 1]
        .into_iter()
        .flat_map(|rail| [0, 1, 2].map(|k| element(rail, k)))
        .collect();
    let half = DMatrix::from_fn(36, 36, |_, _| random.between(-1.0, 1.0));
    ExactSurface::new(
        Arc::new(Rails::new(elements).expect("sound")),
        &half * half.transpose(),
    )
    .expect("numbers")
}

/// Groups of one to four probes in any directions on both rails; some probes are in two groups, and some stand at one place.
fn groups(random: &mut Random) -> ProbeGroups {
    let (mut probes, mut members) = (Vec::new(), Vec::new());
    for group in 0..9 {
        for k in 0..=group % 4 {
            let x = X[0] + 0.6 * (group + k) as f64;
            probes.push(Probe {
                rail: group % 2,
                x,
                axis: AXES[(group + k / 2) % 3],
            });
            members.push(GroupMember {
                group,
                probe: probes.len() - 1,
                weight: random.between(-1.0, 1.0),
            });
        }
    }
    for (group, probe) in [(8, 0), (3, 2)] {
        members.push(GroupMember {
            group,
            probe,
            weight: random.between(-1.0, 1.0),
        });
    }
    ProbeGroups {
        count: 9,
        probes,
        members,
    }
}

/// Identity: value = A G A^T and slope = A dG A^T with the weights A of the probes in the groups, on the way over both ends of
/// elements and to them.
#[test]
fn coefficients_of_groups_are_sums_of_those_of_their_probes() {
    let random = &mut Random::new(3);
    for special in [Special::None, Special::Tension, Special::SharedMember] {
        let surface = surface(random, special);
        let mut groups = groups(random);
        let mut weights = DMatrix::zeros(groups.count, groups.probes.len());
        for member in &groups.members {
            weights[(member.group, member.probe)] += member.weight;
        }
        let (mut kept, mut found) = (KeptProducts::default(), Influence::zeros(groups.count));
        let mut all = Influence::zeros(groups.probes.len());
        let start: Vec<f64> = groups.probes.iter().map(|probe| probe.x).collect();
        // Forward, over the ends, and back.
        for step in (0..60).chain((0..60).step_by(7).rev()) {
            for (probe, start) in groups.probes.iter_mut().zip(&start) {
                let x = start + 0.25 * f64::from(step);
                // The last of them stop at an end.
                probe.x = if step > 50 { x.min(X[2]) } else { x.min(X[3]) };
            }
            surface
                .fill_groups(&groups, &mut kept, &mut found)
                .expect("on the rails");
            surface
                .fill(&groups.probes, &mut all)
                .expect("on the rails");
            for (found, all, what) in [
                (&found.value, &all.value, "value"),
                (&found.slope, &all.slope, "slope"),
            ] {
                let expected = &weights * all * weights.transpose();
                let error = (found - expected).amax() / all.amax();
                assert!(
                    error < 1e-13,
                    "{special:?}, step {step}: {what} differs by {error:e}"
                );
            }
        }
    }
}

/// A group beyond its rail and one in whose direction the structure has no stiffness are refused, also where others of its
/// members have stiffness; the next call at other places is not harmed.
#[test]
fn groups_without_rail_or_stiffness_are_refused() {
    let whole = surface(&mut Random::new(5), Special::None);
    let mut nodal = whole.nodal().clone();
    // The twist of the first node has no stiffness: forces beside the axis on the first element are not held.
    (0..36).for_each(|k| (nodal[(3, k)], nodal[(k, 3)]) = (0.0, 0.0));
    nodal[(3, 3)] = f64::INFINITY;
    let surface = ExactSurface::new(Arc::clone(whole.rails()), nodal).expect("numbers");
    let probe = |x: f64| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    let member = |probe: usize| GroupMember {
        group: 0,
        probe,
        weight: 0.5,
    };
    let mut groups = ProbeGroups {
        count: 1,
        probes: vec![probe(9.0), probe(10.0)],
        members: vec![member(0), member(1)],
    };
    let (mut kept, mut out) = (KeptProducts::default(), Influence::zeros(1));
    assert_eq!(surface.fill_groups(&groups, &mut kept, &mut out), Ok(()));
    let known = out.value[(0, 0)];
    groups.probes[1].x = 6.0;
    let refused = surface.fill_groups(&groups, &mut kept, &mut out);
    assert_eq!(
        refused,
        Err(Error::NoStiffness {
            rail: 0,
            x: 6.0,
            axis: Axis::Vertical
        })
    );
    groups.probes[1].x = 22.0;
    assert_eq!(
        surface.fill_groups(&groups, &mut kept, &mut out),
        Err(Error::OffRail { rail: 0, x: 22.0 })
    );
    groups.probes[1].x = 10.0;
    assert_eq!(surface.fill_groups(&groups, &mut kept, &mut out), Ok(()));
    assert_eq!(out.value[(0, 0)], known);
    assert!(
        surface
            .fill_groups(&groups, &mut kept, &mut Influence::zeros(2))
            .is_err()
    );
}
