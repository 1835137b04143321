//! Contact of wheel and rail: the vertical contact law, the flange and friction.

use crate::numerics::root::narrow;
use crate::numerics::step::step;

/// Penetration, relative to the depth of full damping, below which a contact without force is relaxed, and the relative accuracy
/// of larger ones.
const RELAXED: f64 = 1e-9;
const RELAXING: f64 = 1e-14;

/// Velocity on which the damper of a contact acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Damper {
    /// Rate of penetration: the damper acts between wheel and rail.
    #[default]
    Rail,
    /// Downward velocity of the wheel: the damper acts between wheel and ground, as in McConville's decks.
    Ground,
}

/// Vertical force of one wheel: F = k p^e + S(p) c r, never negative unless `bilateral`.
///
/// p is the penetration, r is the rate of the damper ([`Damper`]), and S(p) = STEP(p, 0, 0, depth, 1), or 1 where
/// `depth` is zero. Exponent 1 with depth 0 is the linear law; other values are the IMPACT function of ADAMS.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalLaw {
    /// Stiffness k, force per length^e, > 0.
    pub stiffness: f64,
    /// Exponent e, >= 1.
    pub exponent: f64,
    /// Damping constant c, force time per length, >= 0.
    pub damping: f64,
    /// Penetration from which the full damping acts, >= 0.
    pub depth: f64,
    /// Velocity on which the damper acts.
    pub damper: Damper,
    /// Whether the contact can transmit tension.
    pub bilateral: bool,
}

/// A force and its derivatives with respect to penetration and rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawValue {
    /// Force.
    pub force: f64,
    /// Derivative with respect to penetration.
    pub by_penetration: f64,
    /// Derivative with respect to the damper's rate.
    pub by_rate: f64,
}

impl NormalLaw {
    /// The linear law k p + c r.
    #[must_use]
    pub fn linear(stiffness: f64, damping: f64, damper: Damper) -> Self {
        NormalLaw {
            stiffness,
            exponent: 1.0,
            damping,
            depth: 0.0,
            damper,
            bilateral: false,
        }
    }

    /// Whether the force is linear in penetration and rate.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.exponent == 1.0 && (self.depth == 0.0 || self.damping == 0.0)
    }

    /// Whether the penetration is a state variable, because a damper acts between wheel and rail.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.damping > 0.0 && self.damper == Damper::Rail
    }

    /// Whether a damper acts between wheel and ground.
    pub(crate) fn is_grounded(&self) -> bool {
        self.damping > 0.0 && self.damper == Damper::Ground
    }

    /// Force of the law at penetration `p` and rate `r`, not clipped. The spring force is continued as an odd
    /// function to negative penetration, so that the equations remain smooth in a step in which the contact ends,
    /// until the time of separation is located.
    #[must_use]
    pub fn at(&self, p: f64, r: f64) -> LawValue {
        let (spring, by_spring) = if self.exponent == 1.0 {
            (self.stiffness * p, self.stiffness)
        } else {
            let power = p.abs().powf(self.exponent - 1.0);
            (
                self.stiffness * p * power,
                self.stiffness * self.exponent * power,
            )
        };
        let (ramp, by_ramp) = if self.depth > 0.0 {
            step(p, 0.0, 0.0, self.depth, 1.0)
        } else {
            (1.0, 0.0)
        };
        LawValue {
            force: spring + self.damping * ramp * r,
            by_penetration: by_spring + self.damping * by_ramp * r,
            by_rate: self.damping * ramp,
        }
    }

    /// The elastic part of the force at penetration `p`.
    #[must_use]
    pub fn spring(&self, p: f64) -> f64 {
        if self.exponent == 1.0 {
            self.stiffness * p
        } else {
            self.stiffness * p * p.abs().powf(self.exponent - 1.0)
        }
    }

    /// Elastic energy at penetration `p`: k |p|^(e+1)/(e+1).
    #[must_use]
    pub fn energy(&self, p: f64) -> f64 {
        if self.exponent == 1.0 {
            return 0.5 * self.stiffness * p * p;
        }
        self.stiffness * p.abs().powf(self.exponent + 1.0) / (self.exponent + 1.0)
    }

    /// What is left of a penetration `p` >= 0 after a `time` without force.
    ///
    /// Spring and damper between wheel and rail then follow k p^e + S(p) c p' = 0. Where S = 1,
    ///
    /// p(t) = p (1 + (e - 1) (k/c) p^(e-1) t)^(-1/(e-1)),
    ///
    /// or p exp(-k t/c) for e = 1. Below the depth d, p follows from the time
    ///
    /// t = (c/k) [3 u^(3-e)/((3 - e) d^2) - 2 u^(4-e)/((4 - e) d^3)] between u = p(t) and u = p.
    pub(crate) fn relaxed(&self, p: f64, time: f64) -> f64 {
        let (rate, power) = (self.stiffness / self.damping, self.exponent - 1.0);
        // the integral of u^(-1-power) from u to `to`, without loss of digits where the power is small
        let integral = |u: f64, to: f64, power: f64| match power {
            0.0 => (to / u).ln(),
            _ => u.powf(-power) * -(-power * (to / u).ln()).exp_m1() / power,
        };
        let above = (p > self.depth).then(|| {
            let grown = power * rate * p.powf(power) * time;
            let logarithm = if power == 0.0 {
                rate * time
            } else {
                grown.ln_1p() / power
            };
            p * (-logarithm).exp()
        });
        if let Some(left) = above.filter(|left| *left >= self.depth) {
            return left;
        }
        let top = p.min(self.depth);
        let time = time - above.map_or(0.0, |_| integral(self.depth, p, power) / rate);
        let beyond = |share: f64| {
            let [square, cube] =
                [2.0, 3.0].map(|n| integral(share * top, top, power - n) / self.depth.powf(n));
            (3.0 * square - 2.0 * cube) / rate - time
        };
        let ends = [beyond(RELAXED), -time];
        if top == 0.0 || ends[0] <= 0.0 {
            return 0.0;
        }
        let share = |part: f64| RELAXED + part * (1.0 - RELAXED);
        let [_, part] = narrow(ends, RELAXING, |part| Some(beyond(share(part))));
        share(part) * top
    }

    /// Penetration at rest under `force` >= 0.
    #[must_use]
    pub fn penetration(&self, force: f64) -> f64 {
        (force / self.stiffness).powf(1.0 / self.exponent)
    }
}

/// Flange: beyond a clearance the rail head exerts a lateral force, until the wheel has climbed off the rail.
///
/// L = k S(h) (|e| - clearance) sign(e), where e is the lateral displacement of the wheel relative to the rail, h is
/// the height of the wheel centre above the rail, and S(h) = `STEP(h, release[0], 1, release[1], 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Flange {
    /// Stiffness k, force per length, > 0.
    pub stiffness: f64,
    /// Clearance on either side, >= 0.
    pub clearance: f64,
    /// Heights of the wheel centre above the rail between which the flange force decreases to zero; `None`: it never
    /// decreases.
    pub release: Option<[f64; 2]>,
}

impl Flange {
    /// Fraction S(h) of the flange force that acts at height `h`, and its slope.
    #[must_use]
    pub fn fraction(&self, h: f64) -> (f64, f64) {
        self.release
            .map_or((1.0, 0.0), |[from, to]| step(h, from, 1.0, to, 0.0))
    }

    /// Signed lateral penetration beyond the clearance.
    #[must_use]
    pub fn overlap(&self, e: f64) -> f64 {
        e.signum() * (e.abs() - self.clearance).max(0.0)
    }
}

/// Dependence of friction on the sliding velocity s, as a fraction of mu N.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionLaw {
    /// STEP(s, -slip, -1, slip, 1), which is +-1 for |s| >= slip: the cubic law of the decks of the paper.
    #[default]
    Step,
    /// tanh(s / slip), which is 76 % at |s| = slip: a smooth approximation of Coulomb's law, with an error below 5e-9
    /// for |s| >= 10 slip. [`Brake`](crate::Brake) uses the same law.
    Coulomb,
}

/// Friction along the rail: T = mu N S(s) against the sliding velocity s, where S is the [`FrictionLaw`].
///
/// The law is regularised: friction is zero at s = 0, so a wheel under a small force creeps slowly instead of
/// sticking.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Law S(s).
    pub law: FrictionLaw,
    /// Friction coefficient mu, >= 0.
    pub coefficient: f64,
    /// Sliding velocity that is the scale of the law, > 0.
    pub slip: f64,
}

impl Friction {
    /// Fraction of mu N at sliding velocity `s`, from -1 to 1, and its slope.
    #[must_use]
    pub fn fraction(&self, s: f64) -> (f64, f64) {
        match self.law {
            FrictionLaw::Step => step(s, -self.slip, -1.0, self.slip, 1.0),
            FrictionLaw::Coulomb => {
                let share = (s / self.slip).tanh();
                (share, (1.0 - share * share) / self.slip)
            }
        }
    }
}

/// One kind of wheel.
/// ```
/// use sim::{Damper, Flange, NormalLaw, Wheel};
///
/// let mut wheel = Wheel::new(0.4, NormalLaw::linear(1e9, 1e6, Damper::Rail));
/// wheel.flange = Some(Flange { stiffness: 1e8, clearance: 0.01, release: None });
/// // 200 kN press it in by 0.2 mm.
/// assert!((wheel.normal.penetration(200e3) - 0.2e-3).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel {
    /// Radius, > 0.
    pub radius: f64,
    /// Vertical contact.
    pub normal: NormalLaw,
    /// Flange; `None` where the wheel has none.
    pub flange: Option<Flange>,
    /// Friction along the rail; `None` where the wheel has none.
    pub friction: Option<Friction>,
    /// Moment of inertia about the axle. `None`: the wheel rolls without inertia and transmits no traction.
    pub spin_inertia: Option<f64>,
}

impl Wheel {
    /// A wheel of `radius` with the vertical law `normal`, without flange and friction; it rolls without inertia.
    #[must_use]
    pub fn new(radius: f64, normal: NormalLaw) -> Self {
        Wheel {
            radius,
            normal,
            flange: None,
            friction: None,
            spin_inertia: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Damper, Flange, Friction, FrictionLaw, NormalLaw};

    /// IMPACT(x, v, x1, k, e, c, d) of the SolidWorks Motion and ADAMS help, written out independently.
    fn impact(x: f64, v: f64, x1: f64, k: f64, e: f64, c: f64, d: f64) -> f64 {
        if x >= x1 {
            return 0.0;
        }
        let t = ((x - (x1 - d)) / d).clamp(0.0, 1.0);
        (k * (x1 - x).powf(e) - (c - c * t * t * (3.0 - 2.0 * t)) * v).max(0.0)
    }

    #[test]
    fn power_law_with_a_ramped_damper_is_the_impact_function() {
        let law = NormalLaw {
            stiffness: 1e8,
            exponent: 1.1,
            damping: 1e5,
            depth: 1e-2,
            damper: Damper::Rail,
            bilateral: false,
        };
        for (p, rate) in [(0.003, 0.5), (0.02, -1.0), (0.05, 2.0)] {
            let theirs = impact(1.25 - p, -rate, 1.25, 1e8, 1.1, 1e5, 1e-2);
            assert!((law.at(p, rate).force - theirs).abs() < 1e-7 * theirs);
        }
    }

    #[test]
    fn derivatives_of_the_law_are_derivatives() {
        let law = NormalLaw {
            stiffness: 1e8,
            exponent: 1.5,
            damping: 1e5,
            depth: 2e-2,
            damper: Damper::Rail,
            bilateral: false,
        };
        let (p, r, h) = (0.007, 0.3, 1e-7);
        let at = law.at(p, r);
        let by_p = (law.at(p + h, r).force - law.at(p - h, r).force) / (2.0 * h);
        let by_r = (law.at(p, r + h).force - law.at(p, r - h).force) / (2.0 * h);
        assert!((at.by_penetration / by_p - 1.0).abs() < 1e-6);
        assert!((at.by_rate / by_r - 1.0).abs() < 1e-6);
    }

    /// Against steps of the classical Runge-Kutta method of k p^e + S(p) c p' = 0.
    #[test]
    fn penetrations_without_force_relax() {
        for (exponent, depth) in [
            (1.0, 0.0),
            (1.0, 1e-3),
            (1.0000001, 1e-3),
            (1.1, 1e-3),
            (1.5, 0.0),
            (2.0, 4e-3),
            (3.0, 4e-3),
            (3.5, 1e-3),
        ] {
            let law = NormalLaw {
                exponent,
                depth,
                ..NormalLaw::linear(1e8, 1e5, Damper::Rail)
            };
            let rate = |p: f64| -law.spring(p) / law.at(p, 0.0).by_rate;
            let (mut p, h, count) = (3e-3, 2e-7, 20_000);
            for k in 0..count {
                let left = law.relaxed(3e-3, h * f64::from(k));
                assert!(
                    (left - p).abs() < 1e-9 * 3e-3,
                    "{exponent} {depth} {k}: {left} for {p}"
                );
                if p < 0.05 * depth {
                    break;
                }
                let a = rate(p);
                let b = rate(p + 0.5 * h * a);
                let c = rate(p + 0.5 * h * b);
                p += h / 6.0 * (a + 2.0 * (b + c) + rate(p + h * c));
            }
            if exponent < 3.0 && depth > 0.0 {
                assert_eq!(law.relaxed(3e-3, 1e3), 0.0);
            }
            assert_eq!(law.relaxed(0.0, 1.0), 0.0);
        }
    }

    #[test]
    fn penetration_at_rest_inverts_the_spring() {
        let mut law = NormalLaw::linear(1e8, 0.0, Damper::Rail);
        law.exponent = 1.1;
        // Analytic: (5e6/1e8)^(1/1.1) = 0.065652 ft, the rigid rail of the paper.
        assert!((law.penetration(5e6) - 0.065_652).abs() < 1e-6);
        assert!((law.spring(law.penetration(5e6)) - 5e6).abs() < 1e-6);
    }

    #[test]
    fn flange_has_free_play_and_lets_go_between_the_release_heights() {
        let flange = Flange {
            stiffness: 1e8,
            clearance: 0.04,
            release: Some([1.25, 1.385]),
        };
        assert_eq!(flange.overlap(0.03), 0.0);
        assert!((flange.overlap(-0.05) + 0.01).abs() < 1e-15);
        assert_eq!(flange.fraction(1.2).0, 1.0);
        assert_eq!(flange.fraction(1.4).0, 0.0);
        assert!((flange.fraction(1.3175).0 - 0.5).abs() < 1e-12);
    }

    #[test]
    fn friction_is_odd_and_full_beyond_the_slip_velocity() {
        let friction = Friction {
            law: FrictionLaw::Step,
            coefficient: 0.2,
            slip: 0.1,
        };
        assert_eq!(friction.fraction(0.2).0, 1.0);
        assert_eq!(friction.fraction(-0.2).0, -1.0);
        assert!(friction.fraction(0.0).0.abs() < 1e-15);
    }

    #[test]
    fn coulomb_friction_is_odd_and_nearly_full_at_ten_slip_velocities() {
        let friction = Friction {
            law: FrictionLaw::Coulomb,
            coefficient: 0.2,
            slip: 0.1,
        };
        assert_eq!(friction.fraction(0.0), (0.0, 10.0));
        assert_eq!(friction.fraction(0.03).0, -friction.fraction(-0.03).0);
        // Analytic: tanh 1 = 0.761594, 1 - tanh 10 = 4.1e-9.
        assert!((friction.fraction(0.1).0 - 0.761_594_156).abs() < 1e-9);
        let short = 1.0 - friction.fraction(1.0).0;
        assert!(short > 0.0 && short < 4.2e-9);
        let (s, h) = (0.07, 1e-6);
        let difference = (friction.fraction(s + h).0 - friction.fraction(s - h).0) / (2.0 * h);
        assert!((friction.fraction(s).1 / difference - 1.0).abs() < 1e-7);
        assert_eq!(friction.fraction(1e300), (1.0, 0.0));
    }
}
