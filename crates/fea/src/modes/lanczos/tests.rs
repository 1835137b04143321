//! Eigenvalues beside those of dense matrices.

use sprs::TriMat;

use super::*;
use crate::factor::Factor;
use crate::influence::FactoredFrame;
use crate::model::{BeamTheory, Girder, cut_members};
use crate::modes::decoupled::ExcitingForces;
use crate::modes::mass::ScaledMass;

/// Upper triangle of a matrix.
fn upper(dense: &DMatrix<f64>) -> CsMat<f64> {
    let n = dense.nrows();
    let mut out = TriMat::new((n, n));
    for j in 0..n {
        (0..=j)
            .filter(|&i| dense[(i, j)] != 0.0)
            .for_each(|i| out.add_triplet(i, j, dense[(i, j)]));
    }
    out.to_csc()
}

/// Stiffness of a chain, and a mass of which `massless` degrees of freedom have none.
fn pencil(n: usize, massless: usize) -> [DMatrix<f64>; 2] {
    let stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => 2.0 + 0.01 * (i % 5) as f64,
        1 => -1.0,
        _ => 0.0,
    });
    let mass = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
        _ if i.min(j) < massless => 0.0,
        0 => 4.0 + (i % 3) as f64,
        1 => 1.0,
        _ => 0.0,
    });
    [stiffness, mass]
}

fn factor_of(stiffness: &CsMat<f64>) -> Factor<f64> {
    Factor::new(stiffness).expect("positive definite")
}

#[test]
fn pairs_are_those_of_the_dense_pencil_massless_freedoms_too() {
    for (n, massless, count) in [
        (1, 0, 1),
        (6, 2, 3),
        (90, 0, 12),
        (90, 31, 20),
        (400, 150, 37),
    ] {
        let [stiffness, mass] = pencil(n, massless);
        // 1 / lambda are the eigenvalues of L^-1 M L^-T.
        let l = stiffness.clone().cholesky().expect("positive definite").l();
        let half = l.solve_lower_triangular(&mass).expect("regular");
        let whole = l
            .solve_lower_triangular(&half.transpose())
            .expect("regular");
        let mut exact: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
        exact.sort_by(|a, b| b.total_cmp(a));
        let [k, m] = [&stiffness, &mass].map(upper);
        let factor = factor_of(&k);
        let mut lanczos = Lanczos::new(Pencil {
            stiffness: &k,
            mass: &m,
            factor: PencilFactor::Own(&factor),
        });
        assert!(lanczos.converge(count));
        assert!(lanczos.pairs.converged >= count);
        let modes = lanczos.modes(count);
        for (i, (lambda, x)) in modes.iter().enumerate() {
            assert!(
                (lambda * exact[i] - 1.0).abs() < 1e-11,
                "{n}, {i}: {lambda} {}",
                1.0 / exact[i]
            );
            assert!((&stiffness * x - &mass * x * *lambda).norm() < 1e-10 * x.norm());
            for (j, (_, y)) in modes.iter().enumerate() {
                let unit = f64::from(u8::from(i == j));
                assert!((x.dot(&(&mass * y)) - unit).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_search_beyond_the_rank_of_the_mass_ends_with_all_there_are() {
    let [stiffness, mass] = pencil(90, 31);
    let [k, m] = [&stiffness, &mass].map(upper);
    let factor = factor_of(&k);
    let mut lanczos = Lanczos::new(Pencil {
        stiffness: &k,
        mass: &m,
        factor: PencilFactor::Own(&factor),
    });
    assert!(lanczos.converge(80));
    assert!(lanczos.pairs.exhausted);
    assert_eq!(lanczos.pairs.converged, 59);
}

#[test]
fn after_a_refresh_known_pairs_remain_and_others_follow() {
    let [stiffness, mass] = pencil(400, 0);
    let [k, m] = [&stiffness, &mass].map(upper);
    let factor = factor_of(&k);
    let mut lanczos = Lanczos::new(Pencil {
        stiffness: &k,
        mass: &m,
        factor: PencilFactor::Own(&factor),
    });
    assert!(lanczos.converge(5));
    let before = lanczos.converged_values();
    lanczos.restart_randomly();
    assert!(lanczos.converge(before.len() + 3));
    for (a, b) in before.iter().zip(lanczos.converged_values()) {
        assert!((a / b - 1.0).abs() < 1e-12);
    }
}

/// A deep girder of two spans, flexible in shear, in 128 parts: frequencies of bending, of shear and along the axis lie
/// over three decades.
#[test]
fn converged_pairs_stay_converged_after_a_restart() {
    let girder = Girder {
        spans: vec![4.2, 4.8],
        e: 210e9,
        g: Some(81e9),
        area: Some(0.08),
        i_vertical: 2.85e-3,
        ka_vertical: Some(0.032),
        mass_per_length: Some(629.0),
        theory: BeamTheory::Timoshenko,
        stations: vec![0.0, 9.0],
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("a girder on three supports");
    let parts = vec![128 / model.members.len(); model.members.len()];
    let (model, rails) = cut_members(&model, &[rail], &parts);
    let frame = FactoredFrame::new(&model, &rails).expect("it stands");
    let mass = ScaledMass::new(&model, &frame.elements, &frame.bodies, frame.stiffness())
        .expect("it has mass");
    let part = Part::moved_by(
        &ExcitingForces::vertical(),
        frame.rail_loads(),
        frame.stiffness(),
        &mass,
    );
    let factor = factor_of(&part.stiffness);
    let (stiffness, mass) = (&part.stiffness, &part.mass);
    let mut lanczos = Lanczos::new(Pencil {
        stiffness,
        mass,
        factor: PencilFactor::Own(&factor),
    });
    assert!(lanczos.converge(97));
    for _ in 0..2 {
        let before = lanczos.pairs.converged;
        lanczos.restart(before + 90);
        for _ in 0..16 {
            lanczos.step();
            lanczos.update_pairs();
            assert!(
                lanczos.pairs.converged >= before,
                "{} of {before}",
                lanczos.pairs.converged
            );
        }
    }
}
