//! Positions of the wheels: travel of bodies, rail coordinates, heights, and the pieces of uneven rails.

use nalgebra::DVector;

use crate::Travel;
use crate::mechanics::assembly::Mechanics;

/// Positions of the wheels at one state.
#[derive(Clone)]
pub(crate) struct Places {
    /// Travel of each body whose x is prescribed.
    pub travel: Vec<Travel>,
    /// Rail coordinate of each wheel.
    pub x: Vec<f64>,
    /// Piece of the uneven rail on which each wheel runs; it changes when a wheel passes a corner, never within a
    /// step.
    pub piece: Vec<usize>,
    /// Height of each wheel's centre above its rail in the last solution.
    pub height: Vec<f64>,
}

impl Places {
    pub fn new(mechanics: &Mechanics) -> Self {
        let count = mechanics.wheels.len();
        let mut places = Places {
            travel: vec![Travel::default(); mechanics.scene.bodies.len()],
            x: vec![0.0; count],
            piece: vec![0; count],
            height: vec![0.0; count],
        };
        places.reset_heights(mechanics);
        places
    }

    /// Sets every height to the wheel's radius.
    pub fn reset_heights(&mut self, mechanics: &Mechanics) {
        for (height, wheel) in self.height.iter_mut().zip(&mechanics.wheels) {
            *height = mechanics.scene.wheels[wheel.kind].radius;
        }
    }

    /// Updates the prescribed travel to time `t`.
    pub fn travel_to(&mut self, mechanics: &Mechanics, t: f64) {
        for (travel, body) in self.travel.iter_mut().zip(&mechanics.scene.bodies) {
            if let Some(profile) = &body.motion {
                *travel = profile.at(t);
            }
        }
    }

    /// Updates travel and rail coordinates to (t, q).
    pub fn move_to(&mut self, mechanics: &Mechanics, t: f64, q: &DVector<f64>) {
        self.travel_to(mechanics, t);
        let mut moved = 0.0;
        for w in 0..mechanics.wheels.len() {
            if !mechanics.follows_in_contact(w) {
                moved = self.motion_of_wheel(mechanics, w, q);
            }
            self.x[w] = mechanics.coordinates[w].constant + moved;
        }
    }

    /// Rail coordinate of wheel `w` at the degrees of freedom `q`, with the prescribed travel of the last update.
    pub fn of_wheel(&self, mechanics: &Mechanics, w: usize, q: &DVector<f64>) -> f64 {
        mechanics.coordinates[w].constant + self.motion_of_wheel(mechanics, w, q)
    }

    /// The part of the rail coordinate of wheel `w` that depends on time and degrees of freedom. It is the same for
    /// all wheels of a contact.
    fn motion_of_wheel(&self, mechanics: &Mechanics, w: usize, q: &DVector<f64>) -> f64 {
        let coordinate = &mechanics.coordinates[w];
        let travel = coordinate.driven.map_or(0.0, |root| self.travel[root].x);
        let moved: f64 = coordinate
            .terms
            .iter()
            .map(|&(number, share)| share * q[number])
            .sum();
        travel + moved
    }
}
