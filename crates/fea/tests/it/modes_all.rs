//! All modes of a mesh: against the search for the lowest, and against the static compliance that they add up to.

use crate::common;

use common::{mill, paper, probes};
use fea::{BeamTheory, Error, ExcitingForces, FactoredFrame, check_full_modes, full_modes, modes};
use splines::Axis;

/// Two algorithms that share only the matrices: dense eigenvalues, and block Lanczos with a count.
#[test]
fn lowest_of_all_modes_are_those_that_the_search_finds() {
    let (mut model, rail) = mill(BeamTheory::Timoshenko);
    for section in &mut model.sections {
        section.mass = 3.0;
    }
    let all = FactoredFrame::new(&model, std::slice::from_ref(&rail))
        .and_then(|frame| frame.all_modes(&model))
        .expect("a building of bars with mass");
    let lowest = modes(&model, &[rail], 30).expect("a building of bars with mass");
    assert!(all.modes.len() > 100 && all.next.is_none());
    for (a, b) in all.modes.iter().zip(&lowest.modes) {
        assert!(
            (a.omega / b.omega - 1.0).abs() < 1e-9,
            "{} {}",
            a.omega,
            b.omega
        );
        let largest = b
            .states
            .iter()
            .flatten()
            .fold(0.0_f64, |max, u| max.max(u.abs()));
        let sign = a
            .states
            .iter()
            .flatten()
            .zip(b.states.iter().flatten())
            .map(|(a, b)| a * b)
            .sum::<f64>();
        for (a, b) in a.states.iter().flatten().zip(b.states.iter().flatten()) {
            assert!((a * sign.signum() - b).abs() < 1e-6 * largest);
        }
    }
}

/// Statics: without the part of all modes the influence surface is that of rail elements between fixed ends, which
/// is zero at nodes.
#[test]
fn all_modes_carry_every_load_at_the_nodes() {
    let mut girder = paper();
    girder.mass_per_length = Some(15.2);
    let (model, rail) = girder.model_and_rail().expect("a girder on two supports");
    let refined = full_modes(&model, &[rail], &ExcitingForces::vertical(), 8).expect("it has mass");
    let frame = FactoredFrame::new(&refined.model, &refined.rails).expect("it stands");
    let surface = frame.surface().expect("it has a rail").surface;
    let rest = refined.modes.residual(&surface).expect("the same frame");
    let largest = surface.nodal().amax();
    let at = probes(Axis::Vertical, &[7.5, 15.0, 30.0, 45.0]);
    let mut influence = splines::Influence::zeros(at.len());
    splines::Compliance::fill(&rest, &at, &mut influence).expect("on the rail");
    // All places are nodes of eight elements over 60 ft.
    let left = influence.value.amax();
    println!(
        "{} modes leave {left:.1e} of {largest:.1e}",
        refined.modes.modes.len()
    );
    assert!(left < 1e-9 * largest);
}

#[test]
fn too_many_unknowns_are_refused_before_they_are_solved() {
    let mut girder = paper();
    girder.mass_per_length = Some(15.2);
    let (model, rail) = girder.model_and_rail().expect("a girder on two supports");
    let rails = [rail];
    let refused =
        full_modes(&model, &rails, &ExcitingForces::vertical(), 1000).expect_err("6,000 unknowns");
    assert!(
        matches!(refused, Error::TooManyModes { unknowns, most: 3000 } if unknowns > 3000),
        "{refused}"
    );
    // the check without a factor counts the same unknowns
    let check =
        |elements: usize| check_full_modes(&model, &rails, &ExcitingForces::vertical(), elements);
    assert_eq!(check(1000), Err(refused));
    assert_eq!(check(500), Ok(()));
    assert!(matches!(
        check(1_000_000),
        Err(Error::Elements { most: 100_000, .. })
    ));
}
