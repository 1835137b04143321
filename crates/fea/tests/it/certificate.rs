//! The error bound against true errors of ill-conditioned chains (analytic).

use crate::common;

use common::probes;
use fea::{CrossSection, Error, FactoredFrame, Girder, Member, Model, Rail, RailSegment, Support};
use splines::Axis;

/// A simply supported beam of length 60 cut at the given places, none at midspan.
fn chain(cuts: &[f64]) -> (Model, Rail) {
    let points = cuts.iter().map(|&x| [x, 0.0, 0.0]).collect();
    let section = CrossSection {
        e: 4.32e9,
        iz: 9.528,
        ..CrossSection::default()
    };
    let members: Vec<Member> = (1..cuts.len())
        .map(|k| Member::beam([k - 1, k], 0, [0.0, 1.0, 0.0]))
        .collect();
    let supports = [0, cuts.len() - 1]
        .map(|point| Support {
            point,
            fixed: [point == 0, true, true, true, false, false],
        })
        .to_vec();
    let segments = (0..members.len())
        .map(|member| RailSegment {
            member,
            offset: [0.0; 3],
        })
        .collect();
    let rail = Rail {
        axis: [1.0, 0.0, 0.0],
        segments,
        ..Rail::default()
    };
    (
        Model {
            points,
            sections: vec![section],
            members,
            supports,
            up: [0.0, 1.0, 0.0],
            ..Model::default()
        },
        rail,
    )
}

/// True relative error at 31 ft and its bound; `None` if the frame is refused.
fn check(cuts: &[f64]) -> Option<(f64, f64)> {
    let (model, rail) = chain(cuts);
    let frame = match FactoredFrame::new(&model, &[rail]) {
        Ok(frame) => frame,
        Err(Error::IllConditioned { .. } | Error::Mechanism { .. }) => return None,
        Err(other) => panic!("{other}"),
    };
    let x = 31.0_f64;
    let exact = x * x * (60.0 - x).powi(2) / (3.0 * 60.0 * 4.32e9 * 9.528);
    let grid = frame.grid(&probes(Axis::Vertical, &[x])).expect("solvable");
    Some((
        (grid.value[(0, 0)] / exact - 1.0).abs(),
        grid.certificate.error_bound,
    ))
}

#[test]
fn even_chains_keep_nine_digits() {
    for elements in [2, 3, 16, 64, 256, 1024, 2048, 8192, 32_768] {
        let cuts: Vec<f64> = (0..=elements)
            .map(|k| 60.0 * f64::from(k) / f64::from(elements))
            .collect();
        let (error, bound) = check(&cuts).expect("double-doubles suffice");
        assert!(
            error <= bound && bound < 1e-9,
            "{elements} elements: {error:.1e}, bound {bound:.1e}"
        );
    }
}

#[test]
fn short_elements_keep_nine_digits_down_to_a_millionth_or_are_refused() {
    for power in 1..12 {
        let short = 60.0 * 10f64.powi(-power);
        match check(&[0.0, 20.0, 20.0 + short, 60.0]) {
            Some((error, bound)) => {
                assert!(
                    error <= bound && bound < 1e-6,
                    "{short:.0e}: {error:.1e}, bound {bound:.1e}"
                );
                assert!(power > 6 || bound < 1e-9, "{short:.0e}: {bound:.1e}");
            }
            None => assert!(power > 6, "{short:.0e} refused"),
        }
    }
}

#[test]
fn accuracy_that_nothing_meets_is_refused_with_what_can_be_had() {
    let cuts: Vec<f64> = (0..=8192).map(|k| 60.0 * f64::from(k) / 8192.0).collect();
    let (model, rail) = chain(&cuts);
    match FactoredFrame::with_accuracy(&model, &[rail], 1e-14) {
        Err(Error::IllConditioned { bound, asked, .. }) => {
            assert!(bound < 1e-11 && asked == 1e-14, "{bound:.1e}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn grids_whose_evaluation_cannot_keep_the_digits_are_refused() {
    let (model, rail) = chain(&[0.0, 60.0]);
    let frame = FactoredFrame::with_accuracy(&model, &[rail], 1e-16)
        .expect("double-doubles suffice for the factor");
    assert!(matches!(
        frame.grid(&probes(Axis::Vertical, &[31.0])),
        Err(Error::IllConditioned { .. })
    ));
}

#[test]
fn bound_is_never_below_the_true_error_of_random_chains() {
    let mut stream = common::Stream::new(3);
    let mut trusted = 0;
    for elements in [5, 20, 50, 200] {
        let mut cuts: Vec<f64> = (1..elements).map(|_| stream.between(0.0, 60.0)).collect();
        cuts.extend([0.0, 60.0]);
        cuts.sort_by(f64::total_cmp);
        if let Some((error, bound)) = check(&cuts) {
            assert!(error <= bound, "{elements}: {error:.1e} > {bound:.1e}");
            trusted += 1;
        }
    }
    assert_eq!(trusted, 4);
}

#[test]
fn short_girders_are_certified_to_ten_digits() {
    for spans in [vec![60.0], vec![60.0, 60.0], vec![30.0, 40.0, 50.0, 60.0]] {
        let girder = Girder {
            spans,
            overhangs: [15.0; 2],
            e: 4.32e9,
            i_vertical: 9.528,
            ..Girder::default()
        };
        let (model, rail) = girder.model_and_rail().expect("sound");
        let certificate = FactoredFrame::new(&model, &[rail])
            .expect("solvable")
            .certificate();
        assert!(certificate.error_bound < 1e-10, "{certificate:?}");
    }
}

/// Independent: the compliance of all free points is the inverse of the stiffness, whose condition follows from its
/// entries. The estimate is a lower bound but for the scales, which are powers of two, and seldom below a third.
#[test]
fn condition_is_that_of_the_scaled_stiffness_within_a_factor_of_three() {
    let mut stream = common::Stream::new(5);
    let mut extremes = [f64::INFINITY, 0.0_f64];
    for case in 0..60 {
        let count = 3 + case % 4;
        let mut place = |scale: f64| [0, 1, 2].map(|_| stream.between(-scale, scale));
        let points: Vec<[f64; 3]> = (0..count).map(|_| place(4.0)).collect();
        let section = CrossSection {
            e: 10.0,
            g: 4.0,
            area: 10f64.powf(stream.between(-1.0, 2.0)),
            iy: 10f64.powf(stream.between(-1.0, 1.0)),
            iz: 1.0,
            j: 0.7,
            ..CrossSection::default()
        };
        let mut members: Vec<Member> = (1..count)
            .map(|k| Member::beam([k - 1, k], 0, [0.3, 1.0, 0.2]))
            .collect();
        members.push(Member::beam([0, count - 1], 0, [0.3, 1.0, 0.2]));
        let supports = vec![Support {
            point: 0,
            fixed: [true; 6],
        }];
        let model = Model {
            points,
            sections: vec![section],
            members,
            supports,
            up: [0.0, 1.0, 0.0],
            ..Model::default()
        };
        let free: Vec<usize> = (1..count).collect();
        let (compliance, certificate) = fea::point_compliance(&model, &free).expect("sound");
        let stiffness = compliance.clone().try_inverse().expect("positive");
        let scale = |k: usize| stiffness[(k, k)].sqrt();
        let norm = |of: &dyn Fn(usize, usize) -> f64| {
            let n = stiffness.nrows();
            (0..n)
                .map(|j| (0..n).map(|i| of(i, j).abs()).sum::<f64>())
                .fold(0.0, f64::max)
        };
        let exact = norm(&|i, j| stiffness[(i, j)] / scale(i) / scale(j))
            * norm(&|i, j| compliance[(i, j)] * scale(i) * scale(j));
        let ratio = certificate.condition / exact;
        extremes = [extremes[0].min(ratio), extremes[1].max(ratio)];
    }
    assert!(extremes[0] > 1.0 / 3.0 && extremes[1] < 3.0, "{extremes:?}");
}
