//! The paper's girder as two rigid halves joined by a beam: three ways to hand a wheel over.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::parts::{CENTRES, STATES, arms, basis, beam, chain, massive, stiffness};
use common::{EI, WEIGHT, bogie};
use nalgebra::DMatrix;
use sim::{
    Analysis, BlendedParts, BodyDof, Channel, Damper, Extent, Foundation, PartChain, Scene, Status,
};
use splines::{Axis, Compliance, ExactSurface, Influence, Probe};

fn parts() -> ExactSurface {
    let flexible = stiffness().try_inverse().expect("the beam holds the parts");
    let states = basis() * flexible * basis().transpose();
    let mut nodal = DMatrix::zeros(12, 12);
    for (i, &row) in STATES.iter().enumerate() {
        for (j, &column) in STATES.iter().enumerate() {
            nodal[(row, column)] = states[(i, j)];
        }
    }
    ExactSurface::new(arms(&CENTRES), nodal).expect("two states")
}

fn blended(window: Option<f64>) -> BlendedParts {
    BlendedParts {
        surface: parts(),
        chains: vec![chain(window)],
    }
}

/// One force a part and wheel.
fn separate(window: f64) -> Foundation {
    let chain = chain(Some(window));
    let extent = Extent {
        range: Some(chain.range()),
        breaks: chain.breaks(),
    };
    Foundation {
        compliance: Some(Box::new(parts())),
        parts: Some(vec![chain]),
        rails: vec![extent],
        ..Foundation::default()
    }
}

/// Deflection of the trunnion over the crossing, quasi-static; sample 50 is midspan.
fn sweep(mut scene: Scene, foundation: Foundation) -> Vec<f64> {
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = scene.end / 100.0;
    let run =
        sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run.history
        .column(Channel::Displacement(0, BodyDof::Y))
        .iter()
        .map(|y| -y)
        .collect()
}

fn crossing() -> Scene {
    bogie(5.0, 12.0, Damper::Rail)
}

#[test]
fn central_load_on_two_halves_meets_the_closed_form() {
    for window in [None, Some(60.0), Some(10.0)] {
        let mut give = Influence::zeros(1);
        let at = [Probe {
            rail: 0,
            x: 30.0,
            axis: Axis::Vertical,
        }];
        blended(window).fill(&at, &mut give).expect("on the rail");
        // Analytic: moment P/2 30 on each part, pure bending of the beam between: P 30^2 45/(4 EI) = 1.18073 ft;
        // with two wheels' springs 1.2047 ft, the 1.205 of the published comparison.
        let deflection = WEIGHT * give.value[(0, 0)];
        let wanted = WEIGHT * 30.0 * 30.0 * 45.0 / (4.0 * EI);
        assert!(
            (deflection - wanted).abs() < 1e-12,
            "{deflection} for {wanted}"
        );
        assert!((deflection + WEIGHT / 2e8 - 1.205).abs() < 5e-4);
    }
}

/// The coefficients of all places and loads, multiplied by the loads, are the displacements under them, also where some
/// places are prepared and others are not.
#[test]
fn displacements_under_loads_are_sums_of_coefficients() {
    let probe = |x: f64| Probe {
        rail: 0,
        x,
        axis: Axis::Vertical,
    };
    let places = [0.0, 7.0, 22.0, 30.0, 41.5, 60.0].map(probe);
    let loads = [(probe(12.0), -3.0), (probe(29.0), -2.0), (probe(55.0), 1.5)];
    for window in [None, Some(60.0), Some(10.0)] {
        let parts = blended(window);
        let all: Vec<Probe> = places
            .iter()
            .copied()
            .chain(loads.iter().map(|load| load.0))
            .collect();
        let mut give = Influence::zeros(all.len());
        parts.fill(&all, &mut give).expect("on the rail");
        let of = |i: usize| -> f64 {
            loads
                .iter()
                .enumerate()
                .map(|(j, load)| give.value[(i, places.len() + j)] * load.1)
                .sum()
        };
        let wanted: Vec<f64> = (0..places.len()).map(of).collect();
        let size = wanted
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let (mut direct, mut prepared) = (vec![1.0; places.len()], vec![1.0; places.len()]);
        parts
            .displacements(&places, &loads, &mut direct)
            .expect("on the rail");
        let fixed = parts.at_places(&places[..4]).expect("on the rail");
        fixed
            .under(&loads, &places[4..], &mut prepared)
            .expect("on the rail");
        for (k, wanted) in wanted.iter().enumerate() {
            for found in [direct[k], prepared[k]] {
                assert!(
                    (found - wanted).abs() < 1e-13 * size,
                    "{found} for {wanted} at {}",
                    places[k].x
                );
            }
        }
    }
}

#[test]
fn bogie_at_midspan_depends_on_the_hand_over_as_an_independent_script_says() {
    // External: scipy script with its own chain of parts; the five digits it printed.
    let datum = |window| Foundation::massless(Box::new(blended(window)), 1);
    let mut impact = crossing();
    impact.wheels[0].normal.exponent = 1.1;
    for (name, scene, foundation, wanted) in [
        ("blended over 60 ft", crossing(), datum(Some(60.0)), 1.19775),
        (
            "blended from centre to centre",
            crossing(),
            datum(None),
            1.19543,
        ),
        ("one force a part", crossing(), separate(60.0), 1.12311),
        (
            "one force a part, exponent 1.1",
            impact,
            separate(60.0),
            1.13777,
        ),
    ] {
        let found = sweep(scene, foundation)[50];
        println!("{name}: {found:.5} for {wanted}");
        assert!((found - wanted).abs() < 1e-5, "{name}: {found}");
    }
}

#[test]
fn parts_with_mass_stand_where_massless_parts_stand() {
    let massless = sweep(
        crossing(),
        Foundation::massless(Box::new(blended(Some(60.0))), 1),
    );
    for (with, without) in sweep(crossing(), massive(1.0)).iter().zip(&massless) {
        assert!((with - without).abs() < 1e-10, "{with} for {without}");
    }
}

#[test]
fn undamped_parts_with_mass_keep_their_energy() {
    for factor in [0.1, 1.0] {
        let mut scene = crossing();
        scene.wheels[0].normal.damping = 0.0;
        let run = sim::run(&scene, &[massive(factor)], &mut |_| {
            ControlFlow::Continue(())
        })
        .expect("valid");
        assert_eq!(run.status, Status::Done);
        println!("{:?} residual {:.1e}", run.counts, run.audit.residual());
        assert!(run.audit.residual() < 1e-6, "{}", run.audit.residual());
    }
}

/// `count` equal parts over the girder, the datum blended from centre to centre.
fn many(count: usize) -> BlendedParts {
    let ends: Vec<f64> = (0..=count)
        .map(|j| -15.0 + 90.0 * j as f64 / count as f64)
        .collect();
    let centres: Vec<f64> = ends
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect();
    let l = 90.0 / count as f64;
    let beam = beam(l);
    let mut chain = DMatrix::zeros(2 * count, 2 * count);
    for j in 0..count - 1 {
        let mut block = chain.view_mut((2 * j, 2 * j), (4, 4));
        block += beam;
    }
    // Bordered by the supports, which hold v + rotation (x - centre) of the part above them.
    let mut bordered = DMatrix::zeros(2 * count + 2, 2 * count + 2);
    bordered
        .view_mut((0, 0), (2 * count, 2 * count))
        .copy_from(&(chain / EI));
    for (s, x) in [0.0, 60.0].into_iter().enumerate() {
        let part = ends[1..count].partition_point(|&end| end < x);
        for (freedom, value) in [(2 * part, 1.0), (2 * part + 1, x - centres[part])] {
            bordered[(freedom, 2 * count + s)] = value;
            bordered[(2 * count + s, freedom)] = value;
        }
    }
    let flexible = bordered.try_inverse().expect("two supports hold the chain") / EI;
    let state = |i: usize| 6 * (i / 2) + [1, 5][i % 2];
    let mut nodal = DMatrix::zeros(6 * count, 6 * count);
    for i in 0..2 * count {
        for j in 0..2 * count {
            nodal[(state(i), state(j))] = flexible[(i, j)];
        }
    }
    BlendedParts {
        surface: ExactSurface::new(arms(&centres), nodal).expect("six freedoms a part"),
        chains: vec![PartChain::new(ends, 0, None).expect("windows meet")],
    }
}

#[test]
fn largest_error_over_the_crossing_falls_with_the_square_of_the_number_of_parts() {
    let exact = sweep(crossing(), common::girder());
    let points: Vec<[f64; 2]> = [6, 12, 24, 48, 96, 192]
        .map(|count| {
            let found = sweep(crossing(), Foundation::massless(Box::new(many(count)), 1));
            let error = found
                .iter()
                .zip(&exact)
                .fold(0.0_f64, |max, (f, e)| max.max((f - e).abs()));
            println!("{count} parts: {error:.3e} ft");
            [
                f64::from(u32::try_from(count).expect("small")).ln(),
                error.ln(),
            ]
        })
        .to_vec();
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let slope = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    println!("order {:.3}", -slope);
    assert!((-slope - 2.0).abs() < 0.15, "order {}", -slope);
}
