//! Nine losses of contact: a wheel dropped on a rigid rail, against its closed form, by steps that do and do not look for them.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::dormand::dormand;
use common::near::{assert_at_most, assert_near};
use common::{GRAVITY, bogie, single};
use sim::{BodyDof, Channel, Damper, Foundation, Method, Scene, Status, Stepping};

/// A wheel let go `height` above the rail, by its sag at rest, with the damping ratio `zeta`.
#[derive(Clone, Copy)]
struct Wheel {
    zeta: f64,
    height: f64,
}

/// 2.4e6 lb on 1e8 lb/ft, without its damper and with that of 1e5 lb s/ft.
const PLAIN: Wheel = Wheel {
    zeta: 0.0,
    height: 2.0,
};

fn damped() -> Wheel {
    Wheel {
        zeta: 0.5 * 1e5 / (1e8 * 2.4e6 / GRAVITY).sqrt(),
        height: 4.0,
    }
}

/// Time by that of the wheel on its spring, by 2 pi; place below the rail and speed, the place by the sag at rest:
/// z'' = 1 - f, f = z + 2 zeta z' in contact, 0 off it.
type State = [f64; 2];

/// `t` after a touch with `speed`: z'' + 2 zeta z' + z = 1 in closed form.
fn pressed(zeta: f64, speed: f64, t: f64) -> State {
    let w = (1.0 - zeta * zeta).sqrt();
    let (sin, cos) = (w * t).sin_cos();
    // z - 1 from -1 with `speed`
    let across = (speed - zeta) / w;
    let decay = (-zeta * t).exp();
    [
        1.0 + decay * (across * sin - cos),
        decay * (w * (across * cos + sin) - zeta * (across * sin - cos)),
    ]
}

fn force(zeta: f64, [z, v]: State) -> f64 {
    z + 2.0 * zeta * v
}

/// Where the `losses`-th flight is three quarters over: time, place and speed; the largest place.
fn exact(Wheel { zeta, height }: Wheel, losses: usize) -> (f64, State, f64) {
    let mut speed = (2.0 * height).sqrt();
    let mut t = speed;
    let mut deepest = 0.0_f64;
    for loss in 1..=losses {
        // The force rises from a touch, and is zero once in what follows.
        let [mut low, mut high] = [1.0, 5.5];
        while high - low > 4.0 * f64::EPSILON * high {
            let middle = 0.5 * (low + high);
            if force(zeta, pressed(zeta, speed, middle)) > 0.0 {
                low = middle
            } else {
                high = middle
            }
            deepest = deepest.max(pressed(zeta, speed, middle)[0]);
        }
        deepest = (0..400)
            .map(|i| pressed(zeta, speed, 0.01 * f64::from(i))[0])
            .fold(deepest, f64::max);
        let [z, v] = pressed(zeta, speed, low);
        t += low;
        let flight = -v + (v * v - 2.0 * z).sqrt();
        if loss == losses {
            let own = 0.75 * flight;
            return (t + own, [z + own * (v + 0.5 * own), v + own], deepest);
        }
        t += flight;
        speed = v + flight;
    }
    (0.0, [0.0; 2], 0.0)
}

fn rate(zeta: f64, y: State, is_pressed: bool) -> State {
    [
        y[1],
        if is_pressed {
            1.0 - force(zeta, y)
        } else {
            1.0
        },
    ]
}

/// As one that does not look for events has it.
fn blind(zeta: f64, y: State) -> State {
    rate(zeta, y, y[0] > 0.0 && force(zeta, y) > 0.0)
}

/// A step of the classical Runge-Kutta method.
fn kutta(y: State, h: f64, rate: impl Fn(State) -> State) -> State {
    common::kutta::rk4(y, h, 1, |_, y| rate(y))
}

/// A step of generalised-alpha with spectral radius 0.8 at infinity: place, speed and acceleration.
///
/// # Source
/// J. Chung, G. M. Hulbert, A time integration algorithm for structural dynamics with improved numerical dissipation, Journal of
/// Applied Mechanics 60 (1993).
fn alpha(zeta: f64, [z, v, a]: [f64; 3], h: f64) -> [f64; 3] {
    let rho = 0.8;
    let (m, f) = ((2.0 * rho - 1.0) / (1.0 + rho), rho / (1.0 + rho));
    let (gamma, beta) = (0.5 - m + f, 0.25 * (1.0 - m + f) * (1.0 - m + f));
    let to = |next: f64| {
        let place = z + h * v + h * h * ((0.5 - beta) * a + beta * next);
        [place, v + h * ((1.0 - gamma) * a + gamma * next), next]
    };
    let mut next = a;
    for _ in 0..50 {
        let end = to(next);
        let mean = [(1.0 - f) * end[0] + f * z, (1.0 - f) * end[1] + f * v];
        let is_pressed = mean[0] > 0.0 && force(zeta, mean) > 0.0;
        let residual = (1.0 - m) * next + m * a - rate(zeta, mean, is_pressed)[1];
        let by = if is_pressed {
            (1.0 - f) * (beta * h * h + 2.0 * zeta * gamma * h)
        } else {
            0.0
        };
        let change = residual / (1.0 - m + by);
        next -= change;
        if change.abs() < 1e-14 {
            break;
        }
    }
    to(next)
}

/// A step of the classical Runge-Kutta method that ends at every event within it and goes on from there.
fn located(zeta: f64, mut y: State, is_pressed: &mut bool, h: f64) -> State {
    let mut left = h;
    loop {
        let own = *is_pressed;
        let step = |h: f64| kutta(y, h, |y| rate(zeta, y, own));
        let over = |y: State| {
            if own {
                force(zeta, y) <= 0.0
            } else {
                y[0] >= 0.0 && y[1] > 0.0
            }
        };
        if !over(step(left)) {
            return step(left);
        }
        let [mut low, mut high] = [0.0, left];
        while high - low > 4.0 * f64::EPSILON * left {
            let middle = 0.5 * (low + high);
            if over(step(middle)) {
                high = middle
            } else {
                low = middle
            }
        }
        y = step(high);
        left -= high;
        *is_pressed = !own;
    }
}

/// Error of the place at the end, by the deepest one.
struct Judge {
    wheel: Wheel,
    end: f64,
    wanted: State,
    deepest: f64,
}

impl Judge {
    fn new(wheel: Wheel) -> Judge {
        let (end, wanted, deepest) = exact(wheel, 9);
        Judge {
            wheel,
            end,
            wanted,
            deepest,
        }
    }

    fn begin(&self) -> State {
        [-self.wheel.height, 0.0]
    }

    fn error(&self, place: f64) -> f64 {
        (place - self.wanted[0]).abs() / self.deepest
    }

    /// Steps of about this length.
    fn steps(&self, length: f64) -> (u32, f64) {
        let count = (self.end / length).round();
        (count as u32, self.end / count)
    }

    fn plain(&self, length: f64) -> f64 {
        let (count, h) = self.steps(length);
        self.error(
            (0..count).fold(self.begin(), |y, _| {
                kutta(y, h, |y| blind(self.wheel.zeta, y))
            })[0],
        )
    }

    fn located(&self, length: f64) -> f64 {
        let (count, h) = self.steps(length);
        let mut is_pressed = false;
        let step = |y, _| located(self.wheel.zeta, y, &mut is_pressed, h);
        self.error((0..count).fold(self.begin(), step)[0])
    }

    fn alpha(&self, length: f64) -> f64 {
        let (count, h) = self.steps(length);
        let begin = [-self.wheel.height, 0.0, 1.0];
        self.error((0..count).fold(begin, |y, _| alpha(self.wheel.zeta, y, h))[0])
    }

    fn adaptive(&self, tolerance: f64) -> f64 {
        let zeta = self.wheel.zeta;
        let ended = dormand(
            self.begin(),
            self.end,
            [tolerance, 1e-9],
            |y| blind(zeta, y),
            |_, _| (),
        );
        println!("RK45 {tolerance:e}: {} rates", ended.rates);
        self.error(ended.y[0])
    }

    /// The same wheel in the simulator.
    fn ours(&self, stepping: Stepping, accuracy: f64) -> (f64, sim::Run) {
        let (scene, second, foot) = self.scene(accuracy);
        let stepping = Stepping {
            step: stepping.step.map(|step| step * second),
            ..stepping
        };
        let run = sim::run_by(stepping, &scene, &[Foundation::rigid()], &mut |_| {
            ControlFlow::Continue(())
        })
        .expect("a valid scene");
        assert_eq!(run.status, Status::Done);
        let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
        (
            self.error(-y.last().copied().unwrap_or(f64::NAN) / foot),
            run,
        )
    }

    /// The scene with its unit of time and of length.
    fn scene(&self, accuracy: f64) -> (Scene, f64, f64) {
        let second = (2.4e6 / (GRAVITY * 1e8_f64)).sqrt();
        let foot = 2.4e6 / 1e8;
        let mut scene = bogie(0.0, self.end * second, Damper::Rail);
        scene.contacts = vec![single()];
        let body = &mut scene.bodies[0];
        body.mass = 2.4e6 / GRAVITY;
        (body.motion, body.free) = (None, [false, true, false, false, false, false]);
        body.start[1] = self.wheel.height * foot;
        scene.wheels[0].normal.damping = 2.0 * self.wheel.zeta * second * 1e8;
        scene.accuracy = accuracy;
        (scene, second, foot)
    }
}

/// Slope of ln(error) by ln(step) by least squares, steps halved each time.
fn order(errors: &[f64]) -> f64 {
    let middle = 0.5 * (errors.len() - 1) as f64;
    let (above, below) =
        errors
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(above, below), (i, error)| {
                let x = middle - i as f64;
                (above + x * error.log2(), below + x * x)
            });
    above / below
}

fn show(name: &str, errors: &[f64]) {
    let text: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("{name}: {}, order {:.2}", text.join(" "), order(errors));
}

/// Steps times frequency, from 0.192 to 0.003.
fn lengths() -> Vec<f64> {
    (0..7).map(|i| 0.192 * 0.5_f64.powi(i)).collect()
}

#[test]
fn nine_losses_of_contact_cost_steps_their_order_unless_they_are_located() {
    for (name, wheel, own) in [("undamped", PLAIN, 2.57), ("damped", damped(), 0.579)] {
        let judge = Judge::new(wheel);
        let errors = |of: fn(&Judge, f64) -> f64| -> Vec<f64> {
            lengths().into_iter().map(|h| of(&judge, h)).collect()
        };
        let (plain, located, alpha) = (
            errors(Judge::plain),
            errors(Judge::located),
            errors(Judge::alpha),
        );
        show(&format!("{name}, Runge-Kutta 4"), &plain);
        show("located", &located);
        show("generalised-alpha", &alpha);
        // The prototype has orders of 2 undamped and 1 damped. The fit over seven halvings is as erratic as the errors: they
        // fall by -4 to 3 powers of two a halving with the damper, whose force jumps where the wheel lands, and by 1 to 4.5
        // without it.
        let what = format!("{name}, Runge-Kutta 4 without location: order in the steps, erratic");
        assert_near(what, "regression", own, order(&plain), 0.02);
        assert_near(
            format!("{name}, Runge-Kutta 4 with location: order in the steps"),
            "prototype",
            4.0,
            order(&located[4..]),
            0.05,
        );
        assert_at_most(
            format!("{name}, Runge-Kutta 4 with location, step x frequency 0.003: error"),
            "prototype",
            6e-11,
            located[6],
        );
        if wheel.zeta > 0.0 {
            assert_near(
                "damped, generalised-alpha 0.8: order in the steps",
                "prototype",
                1.0,
                order(&alpha),
                0.2,
            );
        } else {
            assert_near(
                "undamped, Runge-Kutta 4 without location, step x frequency 0.012: error",
                "prototype",
                3e-5,
                plain[4],
                0.2,
            );
            // The prototype has 4e-4. Its height of fall and absolute tolerance are not published; ours are 2 sags and 1e-9.
            // Heights of 0.5 to 8 sags give 0.4e-4 to 6.5e-4.
            assert_near(
                "undamped, RK45 without location, rtol 1e-6: error",
                "regression",
                5.7e-4,
                judge.adaptive(1e-6),
                0.02,
            );
        }
    }
}

/// What steps of [`Method`] err by where contacts are located, and the adaptive run at the accuracy that RK45 is given.
#[test]
fn the_simulator_keeps_its_order_over_nine_losses_of_contact() {
    for (name, wheel) in [("undamped", PLAIN), ("damped", damped())] {
        let judge = Judge::new(wheel);
        let short = [0.384, 0.192, 0.096, 0.048].as_slice();
        // Radau has three nodes with a damper between wheel and rail
        let radau = if wheel.zeta > 0.0 {
            (5.0, short)
        } else {
            (9.0, [1.6, 0.8, 0.4].as_slice())
        };
        for (method, (wanted, steps)) in [(Method::Sdirk4, (4.0, short)), (Method::Radau, radau)] {
            // below 1e-9 of accuracy the places of events end what shorter steps gain
            let error = |h: &f64| {
                judge
                    .ours(
                        Stepping {
                            method,
                            step: Some(*h),
                        },
                        1e-10,
                    )
                    .0
            };
            let errors: Vec<f64> = steps.iter().map(error).collect();
            show(&format!("{name}, {method:?}"), &errors);
            assert_near(
                format!("{name}, simulator, {method:?}: order in the steps"),
                "theory",
                wanted,
                order(&errors),
                0.1,
            );
        }
        let (error, run) = judge.ours(Stepping::default(), 1e-6);
        println!("{name}: {:?} by {:?}", run.counts, run.method);
        assert_eq!(run.counts.events, 18);
        assert_at_most(
            format!("{name}, simulator, accuracy 1e-6 (RK45 without location, rtol 1e-6): error"),
            "prototype",
            4e-4,
            error,
        );
    }
}
