//! Time from a model to its influence grid.

use fea::{
    BeamTheory, CrossSection, Girder, Member, Model, Preload, Rail, RailSegment, Support, grid,
    loaded_frame, surface,
};
use splines::{Axis, Probe};

fn main() {
    divan::main();
}

/// Sixty feet simply supported, two overhangs of fifteen.
fn girder() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        g: Some(1.661_538e9),
        area: Some(1.0),
        i_vertical: 9.528,
        i_lateral: Some(0.874_97),
        j: Some(0.6552),
        rail_height: 3.6615,
        theory: BeamTheory::EulerBernoulli,
        ..Girder::default()
    }
}

fn probes(axis: Axis, count: usize) -> Vec<Probe> {
    let step = 90.0 / (count - 1) as f64;
    (0..count)
        .map(|k| Probe {
            rail: 0,
            x: -15.0 + step * k as f64,
            axis,
        })
        .collect()
}

#[divan::bench(args = [7, 61, 400])]
fn vertical_grid(bencher: divan::Bencher, loads: usize) {
    let (model, rail) = girder().model_and_rail().expect("the numbers are sound");
    let rails = [rail];
    let at = probes(Axis::Vertical, loads);
    bencher.bench(|| grid(&model, &rails, &at));
}

#[divan::bench]
fn paper_surface(bencher: divan::Bencher) {
    let (model, rail) = girder().model_and_rail().expect("the numbers are sound");
    let rails = [rail];
    bencher.bench(|| surface(&model, &rails));
}

/// A runway with ten members in each bay, on columns of four members, all joints rigid.
fn runway(bays: usize) -> (Model, Rail) {
    let section = |i: f64| CrossSection {
        e: 4.32e9,
        g: 1.66e9,
        area: 0.6,
        iy: 0.3 * i,
        iz: i,
        j: 0.02,
        ..CrossSection::default()
    };
    let mut model = Model {
        sections: vec![section(4.0), section(1.5)],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let mut rail = Rail {
        axis: [1.0, 0.0, 0.0],
        ..Rail::default()
    };
    for k in 0..=10 * bays {
        model.points.push([4.0 * k as f64, 40.0, 0.0]);
        if k > 0 {
            rail.segments.push(RailSegment {
                member: model.members.len(),
                offset: [0.0, 3.0, 0.2],
            });
            model
                .members
                .push(Member::beam([k - 1, k], 0, [0.0, 1.0, 0.0]));
        }
    }
    for bay in 0..=bays {
        let mut above = 10 * bay;
        for level in (0..4).rev() {
            model
                .points
                .push([40.0 * bay as f64, 10.0 * f64::from(level), 0.0]);
            let below = model.points.len() - 1;
            model
                .members
                .push(Member::beam([below, above], 1, [0.0, 0.0, 1.0]));
            above = below;
        }
        model.supports.push(Support {
            point: above,
            fixed: [true; 6],
        });
    }
    (model, rail)
}

fn places(bays: usize, count: u32) -> Vec<Probe> {
    let end = 40.0 * bays as f64;
    let at = |k: u32| Probe {
        rail: 0,
        x: end * (f64::from(k) + 0.5) / f64::from(count),
        axis: Axis::Vertical,
    };
    (0..count).map(at).collect()
}

#[divan::bench(args = [10, 104, 1040], sample_count = 10)]
fn runway_400_loads(bencher: divan::Bencher, bays: usize) {
    let (model, rail) = runway(bays);
    let rails = [rail];
    let at = places(bays, 400);
    bencher.bench(|| grid(&model, &rails, &at));
}

/// Weights on all points of the rail, under which the columns have about a tenth of their critical load.
fn weights(bays: usize) -> Preload {
    let points = (0..=10 * bays)
        .map(|point| (point, [0.0, -2e3, 0.0]))
        .collect();
    Preload {
        points,
        ..Preload::default()
    }
}

/// The grid about a state that is known.
#[divan::bench(args = [20, 120], sample_count = 10)]
fn loaded_runway_800_loads(bencher: divan::Bencher, bays: usize) {
    let (model, rail) = runway(bays);
    let rails = [rail];
    let at = places(bays, 800);
    let loaded = loaded_frame(&model, &rails, &weights(bays)).expect("it stands");
    bencher.bench(|| grid(&loaded.model, &rails, &at));
}

/// The grid without a state, for comparison.
#[divan::bench(args = [20, 120], sample_count = 10)]
fn unloaded_runway_800_loads(bencher: divan::Bencher, bays: usize) {
    let (model, rail) = runway(bays);
    let rails = [rail];
    let at = places(bays, 800);
    bencher.bench(|| grid(&model, &rails, &at));
}

/// The grid with the search for the axial forces.
#[divan::bench(args = [20, 120], sample_count = 10)]
fn searched_runway_800_loads(bencher: divan::Bencher, bays: usize) {
    let (model, rail) = runway(bays);
    let rails = [rail];
    let (at, preload) = (places(bays, 800), weights(bays));
    bencher.bench(|| loaded_frame(&model, &rails, &preload).map(|loaded| loaded.frame.grid(&at)));
}
