//! Remarks on frequent errors in data sets of this kind. Each remark is written once, at the statement that it
//! concerns.

use crate::words::form::DeckForm;
use crate::words::text::number;

/// At the UNITS statement.
pub(crate) const UNITS: &str = "Units: MASS, IP and the tables are in these units. ADAMS reconciles force, mass and \
length by itself; Adams View does not convert SPLINEs that have no_units.";

/// At a rail's marker.
pub(crate) const FRAME: &str = "Frame of a rail: x along the rail, y up, origin at rail coordinate 0. Tables are \
read by DX in this frame; an origin elsewhere would shift them unnoticed.";

/// At the first displacement of a rail.
pub(crate) const CROSS: &str = "Cross terms: the force of wheel j is multiplied by G(x_i, x_j), of both places, not \
by the G(x_j, x_j) of its own.";

/// At the first vertical force or penetration.
pub(crate) const START: &str = "IC: static equilibrium at the first instant. IC = 0 of a gap would be a penetration \
of a whole radius, and a force to match, in the first iteration.";

/// At the first state of a penetration.
pub(crate) const GAP: &str = "Gap rate: the damper acts between wheel and rail, on the rate of penetration, DIF1. VY \
alone would damp against the ground and leave out the rail's own velocity.";

/// Where velocities are taken.
pub(crate) const VELOCITY: &str = "VX..VZ carry all four markers: without the fourth the time derivative is taken in \
ground, which is wrong as soon as the rail rides on a moving body.";

/// At a law with an exponent.
pub(crate) const EXPONENT: &str = "Exponent: k is a force per length^e. With e above 1 the force at a given \
penetration below 1 is less than k p; do not exchange k between laws.";

/// At the linear law.
pub(crate) const LINEAR: &str = "Exponent 1: the force is k p + c p', never negative. IMPACT with e = 1.1 and the \
same k would be softer: 0.69 of it at p = 0.024.";

/// At a bilateral law.
pub(crate) const BILATERAL: &str =
    "Bilateral: this contact transmits tension where the wheel lifts.";

/// At the requests of reactions.
pub(crate) const REACTION: &str = "Reactions: JFLOAT on ground gives no reaction on any part. The girder's load and \
its supports' reactions are only here.";

/// At the forces along the rail.
pub(crate) const SLOPE: &str = "Slope: the contact force is normal to the deflected rail; its part along the rail is \
F du/dx. Without it a body that rolls freely gains energy.";

/// Where there is no force along the rail.
pub(crate) const NO_SLOPE: &str = "Slope: AKISPL of a family has no iord, so the force along the rail, F du/dx, is \
missing. It matters where x is free; the form factored has it.";

/// At a spinning wheel.
pub(crate) const SPIN: &str =
    "A wheel with spin takes 1e-9 of its body's mass, so that no part is without mass.";

/// At the integrator.
pub(crate) const INTEGRATOR: &str = "GSTIFF with SI2: velocities, on which the dampers depend, are under error control too, \
and steps may become small at impacts without an ill-conditioned Jacobian. HHT has no error control of DIFF states.";

/// At the GFORCE of the first wheel.
pub(crate) const FORCE: &str =
    "GFORCE: on the wheel at I, along the axes of RM, the rail's marker.";

/// At the paper's form.
pub(crate) const PAPER: &str = "The paper's own form, for comparison only: linear force that also pulls, damper against the \
ground with three markers in VY, AKISPL(x_j, x_j) in the cross terms, IC = 0.";

/// At the tables of a structure.
pub(crate) fn tables(form: DeckForm, range: [f64; 2]) -> Vec<String> {
    let [first, last] = range.map(number);
    let read = match form {
        DeckForm::Akispl | DeckForm::Paper => {
            "Tables: x is where the load stands (Akima), z where the deflection is taken (linear); off the stations \
             G(x, z) and G(z, x) differ."
        }
        DeckForm::Symmetrised => {
            "Tables: x is where the load stands (Akima), z where the deflection is taken (linear); read both ways \
             and averaged, hence symmetric, but not positive everywhere."
        }
        DeckForm::Factored => {
            "Tables: G(x, z) = sum of phi_k(x) phi_k(z), one SPLINE a product: symmetric and positive everywhere. \
             Products below 1e-6 of the largest entry are left out."
        }
    };
    let beyond = format!(
        "Range: rail coordinates {first} to {last}. Beyond them the SPLINE extrapolates, by rules on which its \
         documents disagree: keep the wheels inside."
    );
    vec![read.to_owned(), beyond]
}
