//! Static wheel loads of a bridge crane.

use crate::Error;
use crate::error::{Argument, count, least_zero, positive, within};

/// A bridge crane on two rails, its trolley as near to one of them as the hook can come.
///
/// Forces and lengths in any consistent units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crane {
    /// Weight of the lifted load with all that hangs on the rope, Q.
    pub lifted: f64,
    /// Weight of the trolley with its hoist, T.
    pub trolley: f64,
    /// Weight of the bridge with its end trucks, B, half on each rail.
    pub bridge: f64,
    /// From rail to rail, L.
    pub span: f64,
    /// The least distance of the hook from a rail, a.
    pub approach: f64,
    /// Wheels on one rail, n, loaded alike.
    pub wheels: u32,
}

/// Loads of one wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelLoads {
    /// On the rail that the trolley is near.
    pub near: f64,
    /// On the other rail.
    pub far: f64,
}

impl Crane {
    /// Loads of one wheel on either rail, the dead weights multiplied by `dead`, the lifted load by `hoist`.
    ///
    /// near = (d B/2 + (d T + h Q) (L - a)/L)/n, far = (d B/2 + (d T + h Q) a/L)/n. With `dead` = `hoist` = 1
    /// the static loads; with `hoist` = 0 the crane without load; with phi1 and phi2 group 1 of EN 1991-3.
    ///
    /// # Errors
    /// A weight that is negative, a span that is not positive, an approach beyond the span, no wheel, a factor
    /// that is negative; any of them not finite.
    ///
    /// # Source
    /// Statics.
    pub fn wheel_loads(&self, dead: f64, hoist: f64) -> Result<WheelLoads, Error> {
        let force = |force| least_zero(Argument::Force, force);
        let (lifted, trolley, bridge) = (force(self.lifted)?, force(self.trolley)?, force(self.bridge)?);
        let dead = least_zero(Argument::Factor, dead)?;
        let hoist = least_zero(Argument::Factor, hoist)?;
        let span = positive(Argument::Length, self.span)?;
        let approach = within(Argument::Length, self.approach, 0.0, span)?;
        let wheels = count(self.wheels)?;
        let half = dead * bridge / 2.0;
        let moving = dead * trolley + hoist * lifted;
        Ok(WheelLoads {
            near: (half + moving * (span - approach) / span) / wheels,
            far: (half + moving * approach / span) / wheels,
        })
    }

    /// All that stands on the rails, Q + T + B.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.lifted + self.trolley + self.bridge
    }
}
