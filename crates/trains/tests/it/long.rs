//! Long continuous girders, far from whose sections the influence lines are joined.

use fea::Girder;
use trains::{
    CaseEnvelopes, DeadLoads, GirderResponse, Request, Structure, Train, TrainCase, TrainWheel,
    envelopes,
};

/// Extremes over one span of a girder of equal spans under one or two trains, in four spans around `middle`.
fn found(spans: usize, middle: usize, trains: usize) -> CaseEnvelopes {
    let girder = Girder {
        spans: vec![6.0; spans],
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.02),
        i_vertical: 5.8e-4,
        i_lateral: Some(1.1e-4),
        j: Some(3.6e-6),
        rail_height: 0.3,
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("a girder");
    let structure = Structure::new(&model, &[rail], false).expect("a structure");
    let wheel = |x: f64, vertical: f64| TrainWheel {
        rail: 0,
        x,
        vertical,
        lateral: 0.1 * vertical,
        longitudinal: 12.0,
        eccentricity: 0.0,
    };
    let train = Train {
        wheels: vec![wheel(0.0, 180.0), wheel(3.6, 140.0)],
        ends: [0.4; 2],
        turned: true,
        reverses: true,
        enters: false,
    };
    let case = TrainCase {
        trains: vec![train; trains],
        gap: 0.5,
        ..TrainCase::default()
    };
    let ends = (middle - 1..=middle + 1)
        .map(|span| 6.0 * span as f64)
        .collect();
    let request = Request {
        spans: vec![ends],
        ..Request::default()
    };
    envelopes(&structure, &DeadLoads::default(), &[case], &request)
        .expect("envelopes")
        .remove(0)
}

/// Physical identity: a girder feels nothing of supports many spans away. 31 spans are too few for anything to be joined. Normal forces do not die out and are left out.
#[test]
fn a_span_in_the_middle_does_not_feel_how_long_the_girder_is() {
    for trains in [1, 2] {
        let [short, long] =
            [(31, 15), (63, 31)].map(|(spans, middle)| found(spans, middle, trains));
        assert_eq!(short.extremes.len(), long.extremes.len());
        let mut compared = 0;
        for (a, b) in short.extremes.iter().zip(&long.extremes) {
            assert_eq!(
                (a.span, a.quantity, a.is_max),
                (b.span, b.quantity, b.is_max)
            );
            if a.quantity == GirderResponse::Normal {
                continue;
            }
            let same = short
                .extremes
                .iter()
                .filter(|other| other.quantity == a.quantity);
            let size = same
                .map(|other| other.governing.value.abs())
                .fold(0.0, f64::max);
            // Fifteen spans of the shorter girder die out by 0.27^15 = 3e-9 at the rails' ends, squared on the way back.
            let gap = (a.governing.value - b.governing.value).abs();
            assert!(
                gap <= 1e-12 * size,
                "{:?} of span {}: {} and {}",
                a.quantity,
                a.span,
                a.governing.value,
                b.governing.value
            );
            let beyond = if b.is_max {
                b.governing.value - b.bound
            } else {
                b.bound - b.governing.value
            };
            assert!(
                beyond <= 1e-12 * size,
                "{:?} of span {} is beyond its bound",
                b.quantity,
                b.span
            );
            compared += 1;
        }
        assert!(compared >= 28, "{compared}");
    }
}
