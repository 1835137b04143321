//! Wheel forces of a bogie that rolls over a table: what the kinks of its reading strike out of it.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;
#[path = "../../splines/tests/beam/printed.rs"]
mod printed;

use std::ops::ControlFlow;

use common::{bogie, give, surface};
use nalgebra::DMatrix;
use sim::{Channel, Damper, Foundation, Status};
use splines::{Axis, Kind, Reading, Sheet, Table};

fn akispl(full: bool) -> Foundation {
    let x = printed::STATIONS.to_vec();
    let table = if full {
        let values = DMatrix::from_fn(7, 7, |i, j| give(x[i], x[j]).0);
        Table::new(x.clone(), x, values).expect("stations increase")
    } else {
        printed::table(&printed::VERTICAL)
    };
    let way = (0, Axis::Vertical);
    let reading = Reading::new(Kind::Akispl, &[Sheet { deflection: way, load: way, table }]);
    Foundation::influence(Box::new(reading.expect("a table")), 1)
}

/// Largest share by which the force of a wheel differs from half the weight until the bogie is at 56 ft.
fn swing(foundation: Foundation, speed: f64, damped: bool) -> f64 {
    let end = 56.0 / speed;
    let mut scene = bogie(speed, end, Damper::Ground);
    if !damped {
        scene.wheels[0].normal.damping = 0.0;
    }
    scene.accuracy = 1e-5;
    scene.output_dt = end / 8000.0;
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("valid");
    assert_eq!(run.status, Status::Done);
    let mut worst = 0.0_f64;
    for wheel in 0..2 {
        for force in run.history.column(Channel::Vertical(wheel)) {
            worst = worst.max((force / 2.4e6 - 1.0).abs());
        }
    }
    worst
}

#[test]
fn scratch() {
    for speed in [1.0, 2.5, 5.0, 10.0, 20.0] {
        let exact = || Foundation::influence(Box::new(surface()), 1);
        println!("{speed}: exact {:.5} {:.5}; printed {:.5} {:.5}; full {:.5} {:.5}", swing(exact(), speed, false), swing(exact(), speed, true),
        swing(akispl(false), speed, false), swing(akispl(false), speed, true), swing(akispl(true), speed, false), swing(akispl(true), speed, true));
    }
}
