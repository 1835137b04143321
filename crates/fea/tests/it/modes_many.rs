//! Natural modes of frames with many equal frequencies: none is missing, none is found twice.

use fea::{BeamTheory, CrossSection, Member, Model, Modes, PointMass, Support, modes};

use crate::common;
use common::Stream;

fn section() -> CrossSection {
    CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 6e-3,
        iy: 9e-6,
        iz: 9e-6,
        j: 1.2e-5,
        mass: 47.0,
        ..CrossSection::default()
    }
}

fn beam(points: [usize; 2]) -> Member {
    Member::beam(points, 0, [0.31, 1.0, 0.17])
}

/// Towers side by side, each of two braces of four members from the ground to a mass at the top.
fn towers(count: usize) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    model.sections.push(section());
    for tower in 0..count {
        let x = 10.0 * tower as f64;
        for k in 0..=8 {
            let s = f64::from(k) - 4.0;
            model.points.push([x + s, 4.0 - s.abs(), 0.0]);
        }
        let first = 9 * tower;
        model
            .members
            .extend((first..first + 8).map(|k| beam([k, k + 1])));
        model.masses.push(PointMass {
            point: first + 4,
            mass: 30.0,
            inertia: [1.0; 3],
            offset: [0.0; 3],
        });
        model
            .supports
            .extend([first, first + 8].map(|point| Support {
                point,
                fixed: [true; 6],
            }));
    }
    model
}

/// A frame of one bay and many storeys with identical crossed braces, of two members each.
fn braced(storeys: usize) -> Model {
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    let stout = CrossSection {
        area: 0.05,
        iy: 1e-3,
        iz: 1e-3,
        j: 1.5e-3,
        mass: 390.0,
        ..section()
    };
    model.sections = vec![section(), stout];
    for storey in 0..=storeys {
        for x in [0.0, 6.0] {
            model.points.push([x, 4.0 * storey as f64, 0.0]);
        }
    }
    let stout = |points: [usize; 2]| Member {
        section: 1,
        ..beam(points)
    };
    for storey in 1..=storeys {
        let [a, b, c, d] = [2 * storey - 2, 2 * storey - 1, 2 * storey, 2 * storey + 1];
        model
            .members
            .extend([stout([a, c]), stout([b, d]), stout([c, d])]);
        for (from, to) in [(a, d), (b, c)] {
            let (p, q) = (model.points[from], model.points[to]);
            let last = (1..6).fold(from, |last, k| {
                let share = f64::from(k) / 6.0;
                model
                    .points
                    .push(std::array::from_fn(|i| p[i] + share * (q[i] - p[i])));
                model.members.push(beam([last, model.points.len() - 1]));
                model.points.len() - 1
            });
            model.members.push(beam([last, to]));
        }
    }
    model.supports.extend([0, 1].map(|point| Support {
        point,
        fixed: [true; 6],
    }));
    model
}

fn solve(model: &Model, count: usize) -> Modes {
    let solved = modes(model, &[], count).expect("sound");
    let worst = solved
        .modes
        .iter()
        .map(|mode| mode.residual)
        .fold(0.0, f64::max);
    assert!(worst < 1e-10, "residual {worst}");
    solved
}

#[test]
fn every_copy_of_a_multiple_frequency_is_found() {
    let one = solve(&towers(1), 6);
    for copies in [7, 40] {
        let all = solve(&towers(copies), 5 * copies);
        assert_eq!(all.count_below_shift, 5 * copies);
        for (k, mode) in all.modes.iter().enumerate() {
            assert!(
                (mode.omega / one.modes[k / copies].omega - 1.0).abs() < 1e-10,
                "mode {k}"
            );
        }
        assert!(
            all.next
                .is_some_and(|next| (next / one.modes[5].omega - 1.0).abs() < 1e-10)
        );
    }
}

#[test]
fn a_part_of_a_cluster_is_given_with_the_count_of_all_or_of_those_before() {
    let copies = 60;
    let one = solve(&towers(1), 3);
    // A count within the first cluster, which is small enough to be found whole, and within one that is not.
    let few = solve(&towers(copies), 10);
    assert_eq!((few.modes.len(), few.count_below_shift), (10, copies));
    let copies = 80;
    let many = solve(&towers(copies), copies + 5);
    assert_eq!(many.modes.len(), copies + 5);
    assert!(
        [copies, 2 * copies].contains(&many.count_below_shift),
        "{}",
        many.count_below_shift
    );
    for (k, mode) in many.modes.iter().enumerate() {
        assert!(
            (mode.omega / one.modes[k / copies].omega - 1.0).abs() < 1e-10,
            "mode {k}"
        );
    }
}

#[test]
fn hundreds_of_nearly_equal_modes_of_braces_are_all_found() {
    let model = braced(40);
    let solved = solve(&model, 200);
    assert_eq!((solved.modes.len(), solved.count_below_shift), (200, 200));
    let omegas: Vec<f64> = solved.modes.iter().map(|mode| mode.omega).collect();
    assert!(omegas.is_sorted());
    let near = omegas
        .windows(2)
        .filter(|pair| pair[1] < 1.001 * pair[0])
        .count();
    println!("{near} of 199 neighbours within 0.1 %");
    assert!(near > 100, "not much of a cluster: {near}");
    // A search for fewer modes finds the same ones.
    for count in [1, 17, 60] {
        let fewer = solve(&model, count);
        assert_eq!(fewer.modes.len(), count);
        for (mode, omega) in fewer.modes.iter().zip(&omegas) {
            assert!((mode.omega / omega - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn modes_of_random_frames_are_those_of_all_their_modes() {
    let mut stream = Stream::new(20_240_607);
    for _ in 0..20 {
        let mut model = braced(2);
        for point in &mut model.points[2..] {
            point
                .iter_mut()
                .for_each(|x| *x += stream.between(-0.2, 0.2));
        }
        let all = modes(&model, &[], 10_000).expect("sound");
        assert!(
            all.next.is_none() && all.modes.len() > 100,
            "{}",
            all.modes.len()
        );
        let count = 1 + (stream.between(0.0, 40.0) as usize);
        let few = solve(&model, count);
        for (a, b) in few.modes.iter().zip(&all.modes) {
            assert!(
                (a.omega / b.omega - 1.0).abs() < 1e-9,
                "{} {}",
                a.omega,
                b.omega
            );
        }
    }
}
