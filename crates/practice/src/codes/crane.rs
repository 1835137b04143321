//! Static wheel loads of a bridge crane.

use crate::Error;
use crate::error::{Argument, count, non_negative, positive, within};

/// A bridge crane on two rails, with its trolley at the closest approach to one of them.
///
/// Forces and lengths are in any consistent units.
///
/// ```
/// use practice::Crane;
///
/// let crane = Crane { lifted: 200.0, trolley: 40.0, bridge: 190.0, span: 23.0, approach: 1.2, wheels: 2 };
/// let wheel = crane.wheel_loads(1.0, 1.0)?;
/// assert!((2.0 * (wheel.near + wheel.far) - crane.weight()).abs() < 1e-9);
/// # Ok::<(), practice::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crane {
    /// Weight Q of the lifted load, with everything that hangs on the rope.
    pub lifted: f64,
    /// Weight T of the trolley with its hoist.
    pub trolley: f64,
    /// Weight B of the bridge with its end trucks; each rail carries half.
    pub bridge: f64,
    /// Distance L of the rails.
    pub span: f64,
    /// Hook approach a: the smallest distance of the hook from a rail.
    pub approach: f64,
    /// Number n of wheels on one rail; all carry the same load.
    pub wheels: u32,
}

/// The load of one wheel on either rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticWheelLoads {
    /// On the rail near the trolley.
    pub near: f64,
    /// On the other rail.
    pub far: f64,
}

impl Crane {
    /// The load of one wheel on either rail, with the factor d (`dead`) on the dead weights and h (`hoist`)
    /// on the lifted load.
    ///
    /// near = (d B/2 + (d T + h Q) (L - a)/L)/n, far = (d B/2 + (d T + h Q) a/L)/n. Factors of one give the
    /// static loads, `hoist` = 0 those of the crane without load, phi1 and phi2 those of load group 1 of EN
    /// 1991-3.
    ///
    /// # Errors
    /// [`Error::Range`] for a weight or factor that is negative, a span that is not positive, an approach
    /// beyond the span, no wheel, or any number that is not finite.
    ///
    /// # Source
    /// Statics.
    pub fn wheel_loads(&self, dead: f64, hoist: f64) -> Result<StaticWheelLoads, Error> {
        let force = |force| non_negative(Argument::Force, force);
        let (lifted, trolley, bridge) = (
            force(self.lifted)?,
            force(self.trolley)?,
            force(self.bridge)?,
        );
        let dead = non_negative(Argument::Factor, dead)?;
        let hoist = non_negative(Argument::Factor, hoist)?;
        let span = positive(Argument::Length, self.span)?;
        let approach = within(Argument::Length, self.approach, 0.0, span)?;
        let wheels = count(self.wheels)?;
        let half = dead * bridge / 2.0;
        let moving = dead * trolley + hoist * lifted;
        Ok(StaticWheelLoads {
            near: (half + moving * (span - approach) / span) / wheels,
            far: (half + moving * approach / span) / wheels,
        })
    }

    /// The total weight on the rails, Q + T + B.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.lifted + self.trolley + self.bridge
    }
}
