//! Energy of a bogie that rolls freely in the sag it makes: kept by a symmetric give, not by tables as they are read.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;
#[path = "../../splines/tests/beam/printed.rs"]
mod printed;

use std::ops::ControlFlow;

use common::{GRAVITY, WEIGHT, bogie, surface};
use sim::{Channel, Damper, Foundation, Freedom, Run, Status};
use splines::{Axis, Kind, Reading, Sheet};

/// Where the bogie is let go, ft; two turns end one cycle.
const START: f64 = 12.0;

/// The bogie without dampers and without a drive for `end` seconds.
fn rolling(foundation: Foundation, end: f64, accuracy: f64) -> Run {
    let mut scene = bogie(0.0, end, Damper::Ground);
    scene.wheels[0].normal.damping = 0.0;
    let body = &mut scene.bodies[0];
    body.motion = None;
    body.free[0] = true;
    body.start[0] = START;
    scene.accuracy = accuracy;
    scene.output_dt = 1e-3 * end;
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("the bogie stands");
    assert_eq!(run.status, Status::Done);
    run
}

fn printed_table(kind: Kind) -> Foundation {
    let way = (0, Axis::Vertical);
    let sheet = Sheet { deflection: way, load: way, table: printed::table(&printed::VERTICAL) };
    Foundation::influence(Box::new(Reading::new(kind, &[sheet]).expect("a table")), 1)
}

/// Time of the `count`-th turn.
fn turn(run: &Run, count: usize) -> f64 {
    let [t, v] = [Channel::Time, Channel::Speed(0, Freedom::X)].map(|channel| run.history.column(channel));
    // Released at rest, it heads for midspan: the first turn is that at the far side.
    let turns = (1..v.len()).filter(|&i| t[i] > 1.0 && v[i - 1] * v[i] <= 0.0);
    turns.map(|i| t[i]).nth(count - 1).expect("it turns that often")
}

fn largest_kinetic(run: &Run) -> f64 {
    let v = run.history.column(Channel::Speed(0, Freedom::X));
    v.iter().fold(0.0_f64, |max, v| max.max(0.5 * WEIGHT / GRAVITY * v * v))
}

#[test]
fn bogie_in_its_own_well_keeps_its_energy_for_three_cycles_and_a_half_and_not_on_akispl() {
    let exact = || Foundation::influence(Box::new(surface()), 1);
    let end = turn(&rolling(exact(), 160.0, 1e-4), 7);
    let run = rolling(exact(), end, 1e-8);
    let drift = run.audit.end.total() - run.audit.start.total();
    println!("exact: {end:.1} s, {drift:.2e} of {:.3e} ft lb, {:?}", largest_kinetic(&run), run.counts);
    assert!(run.audit.imbalance < 1e-9 * largest_kinetic(&run), "{}", run.audit.imbalance);

    let natural = rolling(printed_table(Kind::Natural), end, 1e-6);
    println!("printed table, natural: {:.2e} ft lb", natural.audit.end.total() - natural.audit.start.total());
    assert!(natural.audit.imbalance < 1e-7 * largest_kinetic(&natural));

    // Forth and back make up for each other but for the bounce: the largest error on the way tells.
    for accuracy in [1e-5, 1e-6] {
        let akispl = rolling(printed_table(Kind::Akispl), end, accuracy);
        let change = akispl.audit.end.total() - akispl.audit.start.total();
        let (kinetic, largest) = (largest_kinetic(&akispl), akispl.audit.imbalance);
        println!(
            "printed table, AKISPL, accuracy {accuracy:.0e}: up to {largest:.0} of {kinetic:.3e} ft lb on the way \
             ({:.1} %), {change:.0} at the end, {:?}",
            100.0 * largest / kinetic,
            akispl.counts
        );
        assert!(largest > 0.02 * kinetic, "{largest}");
    }
}
