//! Displacements of fixed places under many loads, against influence coefficients of all pairs.

use crate::beam;

use std::sync::Arc;

use beam::Random;
use nalgebra::DMatrix;
use splines::{
    Axis, Compliance, Couplings, ElementMember, ElementResidual, Error, ExactSurface, Flexibility,
    Influence, MemberMotion, Probe, RailElement, RailShapes, Rails, ResidualFlexibility, Uncoupled,
};

const AXES: [Axis; 3] = [Axis::Longitudinal, Axis::Vertical, Axis::Lateral];
const X: [f64; 3] = [2.0, 8.5, 13.0];

/// Two rails of two elements each. The first elements are on one member, which runs against the rails and whose axes are
/// turned; the rails lie beside its axis, so that every direction bends it in both planes and twists it.
fn rails() -> Arc<Rails> {
    let element = |rail: usize, k: usize| RailElement {
        rail,
        x: [X[k], X[k + 1]],
        ends: [3 * rail + k, 3 * rail + k + 1],
        length: X[k + 1] - X[k],
        frame: [[1.0, 0.0, 0.0], [0.0, 0.8, 0.6], [0.0, -0.6, 0.8]],
        offset: [[0.0, 0.7, -0.3], [0.0, 0.2, 0.5]][rail],
        flexibility: Flexibility {
            axial: 0.3,
            torsion: 0.2,
            bending_y: 0.7,
            bending_z: 0.4,
            shear_y: 1.9,
            shear_z: 1.1,
            tension: 0.0,
        },
        member: Some(ElementMember {
            id: if k == 0 { 7 } else { rail },
            reversed: true,
        }),
    };
    Arc::new(
        Rails::new(vec![
            element(0, 0),
            element(0, 1),
            element(1, 0),
            element(1, 1),
        ])
        .expect("sound"),
    )
}

fn surface(random: &mut Random) -> ExactSurface {
    let half = DMatrix::from_fn(36, 36, |_, _| random.between(-1.0, 1.0));
    ExactSurface::new(rails(), &half * half.transpose()).expect("numbers")
}

fn compliances(random: &mut Random) -> Vec<Box<dyn Compliance>> {
    let whole = surface(random);
    let states = DMatrix::from_fn(36, 3, |_, _| random.between(-1.0, 1.0));
    // a motion between the ends of each member: the deflection under a uniform load
    let motion = MemberMotion {
        plane: 0,
        deflection: [0.0, 0.3, 0.2, -1.0, 0.5, 0.0, 0.0, 0.0, 0.0],
        rotation: [0.0, 1.0, -3.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    };
    let amplitudes = DMatrix::from_fn(4, 3, |_, _| random.between(-0.1, 0.1));
    let shapes = RailShapes::new(rails(), states).expect("six a state");
    let shapes = shapes
        .with_member_motions(vec![vec![motion]; 4], &amplitudes)
        .expect("one an element");
    vec![
        Box::new(whole.clone()),
        Box::new(Uncoupled::new(whole.clone(), Couplings::WithinRails)),
        Box::new(Uncoupled::new(whole.clone(), Couplings::None)),
        Box::new(ResidualFlexibility::new(whole.clone(), shapes)),
        Box::new(ElementResidual::new(whole, vec![[0.02, 0.01]; 4])),
        Box::new(Springs),
    ]
}

/// A compliance with nothing of its own for fixed places.
struct Springs;

impl Compliance for Springs {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        out.value = DMatrix::from_fn(at.len(), at.len(), |i, j| (at[i].x - at[j].x).cos());
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        None
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

fn random_probe(random: &mut Random) -> Probe {
    let axis = AXES[(3.0 * random.unit()) as usize % 3];
    Probe {
        rail: usize::from(random.unit() < 0.5),
        x: random.between(X[0], X[2]),
        axis,
    }
}

/// Identity: u = G F with the coefficients G of all pairs, for fixed places, ends of members and places of loads among
/// them, and for others that are given with the loads.
#[test]
fn displacements_of_fixed_places_are_coefficients_times_forces() {
    let random = &mut Random::new(11);
    for (kind, compliance) in compliances(random).iter().enumerate() {
        let mut places: Vec<Probe> = (0..30).map(|_| random_probe(random)).collect();
        places.extend(
            X.iter()
                .flat_map(|&x| AXES.map(|axis| Probe { rail: 1, x, axis })),
        );
        let prepared = compliance.at_places(&places).expect("on the rails");
        for _ in 0..20 {
            let mut loads: Vec<(Probe, f64)> = (0..9)
                .map(|_| (random_probe(random), random.between(-1.0, 1.0)))
                .collect();
            loads.push((places[3], 0.4));
            loads.push((
                Probe {
                    rail: 0,
                    ..places[places.len() - 4]
                },
                -0.7,
            ));
            let also: Vec<Probe> = (0..5)
                .map(|_| random_probe(random))
                .chain([loads[0].0])
                .collect();
            let all: Vec<Probe> = places
                .iter()
                .chain(&also)
                .copied()
                .chain(loads.iter().map(|load| load.0))
                .collect();
            let mut influence = Influence::zeros(all.len());
            compliance.fill(&all, &mut influence).expect("on the rails");
            let count = places.len() + also.len();
            let mut found = vec![f64::NAN; count];
            prepared
                .under(&loads, &also, &mut found)
                .expect("on the rails");
            for (i, found) in found.iter().enumerate() {
                let of =
                    |(j, load): (usize, &(Probe, f64))| influence.value[(i, count + j)] * load.1;
                let expected: f64 = loads.iter().enumerate().map(of).sum();
                let error = (found - expected).abs() / influence.value.amax();
                assert!(
                    error < 1e-13,
                    "{kind}: place {i} {:?}: {found}, not {expected}",
                    all[i]
                );
            }
        }
    }
}

/// Places and loads beyond their rails are refused, and so is memory of another size.
#[test]
fn places_and_loads_beyond_the_rails_are_refused() {
    let surface = surface(&mut Random::new(5));
    let at = |x: f64| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    assert_eq!(
        surface.at_places(&[at(14.0)]).err(),
        Some(Error::OffRail { rail: 0, x: 14.0 })
    );
    let prepared = surface.at_places(&[at(3.0)]).expect("on the rail");
    let refused = |loads: &[(Probe, f64)], also: &[Probe], size: usize| {
        prepared
            .under(loads, also, &mut vec![0.0; size])
            .expect_err("something is wrong")
    };
    assert_eq!(
        refused(&[(at(1.0), 1.0)], &[], 1),
        Error::OffRail { rail: 0, x: 1.0 }
    );
    assert_eq!(
        refused(&[], &[at(1.0)], 2),
        Error::OffRail { rail: 0, x: 1.0 }
    );
    assert_eq!(
        refused(&[], &[], 2),
        Error::EffectShape {
            rows: 2,
            columns: 1,
            expected: [1, 1]
        }
    );
}
