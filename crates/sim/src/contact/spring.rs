//! The force law of ropes and stops: a one-sided spring with a damper, F = k p + c p' where p > 0 and F > 0.

use super::active::ActiveSet;
use super::element::{At, Law, Query, Spring, Where};
use super::energy::{Exchanged, Stored};
use super::rows::RowMut;
use crate::mechanics::point::PointPair;
use crate::numerics::dense::dot;

/// Rounding error of a stretch or penetration, relative to the positions from which it is computed.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Spring {
    /// Force for the stretch or penetration `p` and its rate, without the one-sided limit.
    pub fn force(&self, p: f64, rate: f64) -> f64 {
        self.stiffness * p + self.damping * rate
    }

    /// Switching margin at `p` and `rate`: the smaller of the total force and the spring force, because the force of
    /// the damper may jump when the spring begins to act. The spring must not act if the margin is negative.
    pub fn margin(&self, p: f64, rate: f64) -> f64 {
        self.force(p, rate).min(self.stiffness * p)
    }
}

/// Law of an active spring.
pub(crate) fn law(query: &Query) -> Option<Law> {
    let spring = &query.local.spring;
    query.is_active.then(|| Law {
        force: spring.force(query.penetration(), query.rate),
        by_penetration: spring.stiffness,
        by_rate: spring.damping,
        by_other: None,
    })
}

/// Switching function of a spring: its margin reduced by the noise of its positions.
pub(crate) fn switch(at: &At, active: &ActiveSet) -> f64 {
    let spring = &at.local().spring;
    let margin = spring.margin(at.approach(), at.rate());
    if active.has(at.index) {
        -margin - spring.noise
    } else {
        margin - spring.noise
    }
}

/// Adds the elastic energy of an active spring.
pub(crate) fn stored(at: &At, energy: &mut Stored) {
    if at.force() != 0.0 {
        let p = at.approach();
        energy.ropes += 0.5 * at.local().spring.stiffness * p * p;
    }
}

/// Adds the power dissipated by the damper of an active spring.
pub(crate) fn dissipate(at: &At, power: &mut Exchanged) {
    power.dampers += at.local().spring.damping * at.rate() * at.rate();
}

/// Contribution of an active spring to the force required for the prescribed motion of root body `b`.
pub(crate) fn resistance(points: &PointPair, at: &At, b: usize) -> f64 {
    let state = at.state;
    let by_travel = points.by_travel(
        at.mechanics,
        b,
        (state.t, &state.q),
        at.local().spring.direction,
    );
    by_travel * at.force()
}

/// Writes the row of a pair of points whose `approach` increases along `direction`; `rate` is its rate due to
/// prescribed motions.
pub(crate) fn write_row(
    points: &PointPair,
    at: &Where,
    direction: [f64; 3],
    [approach, rate]: [f64; 2],
    row: &mut RowMut,
) {
    row.approach.fill(0.0);
    points.add_row(at.mechanics, (at.t, at.q), direction, row.approach);
    row.rate.copy_from_slice(row.approach);
    *row.approach_offset = approach - dot(row.approach, at.q.as_slice());
    *row.rate_offset = rate;
}
