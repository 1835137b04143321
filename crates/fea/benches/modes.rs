//! Times of natural modes: runways and buildings.

use divan::{Bencher, black_box};
use fea::{CrossSection, FactoredFrame, Girder, Member, Model, Support};

fn main() {
    divan::main();
}

/// Spans of 30 ft, each of four members.
fn runway(bays: usize) -> Model {
    let girder = Girder {
        spans: vec![7.5; 4 * bays],
        e: 4.32e9,
        g: Some(1.66e9),
        area: Some(1.0),
        i_vertical: 9.5,
        i_lateral: Some(0.9),
        j: Some(0.66),
        mass_per_length: Some(26.4),
        ..Girder::default()
    };
    let (mut model, _) = girder.model_and_rail().expect("sound");
    model.supports.retain(|support| support.point % 4 == 0);
    model
}

/// A building of cubes of 5 m, one member an edge.
fn building(sides: [usize; 3]) -> Model {
    let [p, q, r] = sides;
    let section = CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.013,
        iy: 3.1e-5,
        iz: 8.7e-5,
        j: 2.3e-5,
        mass: 111.0,
        ..CrossSection::default()
    };
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        sections: vec![section],
        ..Model::default()
    };
    let id = |i: usize, j: usize, k: usize| (i * q + j) * r + k;
    let member = |points| Member::beam(points, 0, [0.3, 0.5, 0.81]);
    for i in 0..p {
        for j in 0..q {
            for k in 0..r {
                model
                    .points
                    .push([5.0 * i as f64, 5.0 * j as f64, 5.0 * k as f64]);
                let next = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                let inside = next
                    .into_iter()
                    .filter(|&(i, j, k)| i < p && j < q && k < r);
                model
                    .members
                    .extend(inside.map(|(a, b, c)| member([id(i, j, k), id(a, b, c)])));
                if j == 0 {
                    model.supports.push(Support {
                        point: id(i, j, k),
                        fixed: [true; 6],
                    });
                }
            }
        }
    }
    model
}

/// Twenty modes of runways of about 10,000 and 100,000 degrees of freedom, factor not counted.
#[divan::bench(args = [440, 4400], sample_count = 5)]
fn runways(bencher: Bencher, bays: usize) {
    let model = runway(bays);
    let frame = FactoredFrame::new(&model, &[]).expect("sound");
    bencher.bench_local(|| black_box(frame.modes(&model, 20).expect("sound")));
}

/// Twenty modes of a building of about 10,000 degrees of freedom, factor not counted.
#[divan::bench(args = [[12, 12, 12]], sample_count = 5)]
fn buildings(bencher: Bencher, sides: [usize; 3]) {
    let model = building(sides);
    let frame = FactoredFrame::new(&model, &[]).expect("sound");
    bencher.bench_local(|| black_box(frame.modes(&model, 20).expect("sound")));
}
