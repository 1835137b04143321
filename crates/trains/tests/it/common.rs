//! Wheels and trains of the tests.

use trains::{Train, TrainWheel};

/// A wheel on the first rail with a vertical force.
pub fn wheel(x: f64, vertical: f64) -> TrainWheel {
    TrainWheel {
        rail: 0,
        x,
        vertical,
        lateral: 0.0,
        longitudinal: 0.0,
        eccentricity: 0.0,
    }
}

/// A train that is on the rail with all its wheels and stands one way only.
pub fn train(wheels: Vec<TrainWheel>) -> Train {
    Train {
        wheels,
        ends: [0.0; 2],
        turned: false,
        reverses: false,
        enters: false,
    }
}
