//! The list of the kinds of force elements.

use std::ops::Deref;

use super::active::ActiveSet;
use super::brake::BrakeForce;
use super::drive::DriveForce;
use super::element::{At, Coupling, Element, Law, Query};
use super::energy::{Exchanged, Stored};
use super::flange::FlangeContact;
use super::rope::RopeForce;
use super::stop::StopForce;
use super::traction::Traction;
use super::vertical::Vertical;
use crate::mechanics::assembly::Mechanics;

/// Generates the enum of all kinds, the constructor of all elements of a scene, and the dispatch to the kinds.
macro_rules! force_elements {
    ($($(#[$doc:meta])* $kind:ident($element:ty),)+) => {
        /// One unknown scalar force.
        pub(crate) enum ForceElement<'a> {
            $($(#[$doc])* $kind($element),)+
        }

        impl<'a> ForceElement<'a> {
            /// All elements of a scene, kind by kind.
            pub fn all(mechanics: &Mechanics<'a>) -> Vec<ForceElement<'a>> {
                let mut all = Vec::new();
                $(all.extend(<$element>::all(mechanics).into_iter().map(ForceElement::$kind));)+
                all
            }
        }

        /// Methods of the innermost loops with static dispatch, without a lookup in a virtual table.
        impl ForceElement<'_> {
            /// [`Element::law`].
            #[inline]
            pub fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law> {
                match self {
                    $(ForceElement::$kind(element) => element.law(query, couplings),)+
                }
            }

            /// [`Element::may_act`].
            #[inline]
            pub fn may_act(&self, at: &At, h: f64) -> bool {
                match self {
                    $(ForceElement::$kind(element) => element.may_act(at, h),)+
                }
            }

            /// [`Element::switch`].
            #[inline]
            pub fn switch(&self, at: &At, active: &ActiveSet) -> Option<f64> {
                match self {
                    $(ForceElement::$kind(element) => element.switch(at, active),)+
                }
            }

            /// [`Element::stored`].
            #[inline]
            pub fn stored(&self, at: &At, energy: &mut Stored) {
                match self {
                    $(ForceElement::$kind(element) => element.stored(at, energy),)+
                }
            }

            /// [`Element::power`].
            #[inline]
            pub fn power(&self, at: &At, power: &mut Exchanged) {
                match self {
                    $(ForceElement::$kind(element) => element.power(at, power),)+
                }
            }

            /// [`Element::boundary`].
            #[inline]
            pub fn boundary(&self, at: &At) -> f64 {
                match self {
                    $(ForceElement::$kind(element) => element.boundary(at),)+
                }
            }

            /// [`Element::resistance`].
            #[inline]
            pub fn resistance(&self, at: &At, b: usize) -> f64 {
                match self {
                    $(ForceElement::$kind(element) => element.resistance(at, b),)+
                }
            }
        }

        impl<'a> Deref for ForceElement<'a> {
            type Target = dyn Element + 'a;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(ForceElement::$kind(element) => element,)+
                }
            }
        }
    };
}

// Vertical contacts must be first: a vertical contact and its wheel group have the same index.
force_elements! {
    /// A wheel on its rail.
    Vertical(Vertical<'a>),
    /// The flange of a wheel.
    Flange(FlangeContact<'a>),
    /// Friction below a wheel that spins.
    Traction(Traction<'a>),
    /// A drive.
    Drive(DriveForce<'a>),
    /// A braked contact.
    Brake(BrakeForce<'a>),
    /// A rope.
    Rope(RopeForce<'a>),
    /// A stop.
    Stop(StopForce<'a>),
}
