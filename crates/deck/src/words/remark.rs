//! Remarks on frequent errors in data sets of this kind. Each remark is written once, at the statement that it
//! concerns.

use crate::words::form::DeckForm;
use crate::words::text::number;

/// At the UNITS statement.
pub(crate) const UNITS: &str = "Units: MASS, IP and the tables are in these units. ADAMS reconciles force, mass and \
length by itself; Adams View does not convert SPLINEs that have no_units.";

/// At a rail's marker.
pub(crate) const FRAME: &str = "Frame of a rail: x along the rail, y up, origin at rail coordinate 0. Tables are \
evaluated at DX in this frame; with a different origin they would be \
evaluated at shifted positions.";

/// At the first displacement of a rail.
pub(crate) const CROSS: &str = "Cross terms: the force of wheel j is multiplied by G(x_i, x_j), which depends on \
both positions, and not by G(x_j, x_j).";

/// At the first vertical force or penetration.
pub(crate) const START: &str = "IC: static equilibrium at the first instant. IC = 0 of a gap would cause a \
penetration of a whole radius, and the corresponding force, in the first iteration.";

/// At the first state of a penetration.
pub(crate) const GAP: &str = "Gap rate: the damper acts between wheel and rail, on the rate of penetration, DIF1. VY \
alone would act relative to ground and neglect the velocity of the rail.";

/// Where velocities are taken.
pub(crate) const VELOCITY: &str = "VX..VZ have all four markers: without the fourth marker the time derivative is \
taken in ground, which is wrong if the rail is on a moving body.";

/// At a law with an exponent.
pub(crate) const EXPONENT: &str = "Exponent: k is a force per length^e. With e above 1 the force at a \
penetration below 1 is less than k p; k of one law is not valid for another.";

/// At the linear law.
pub(crate) const LINEAR: &str = "Exponent 1: the force is k p + c p', never negative. IMPACT with e = 1.1 and the \
same k would be softer, by a factor of 0.69 at p = 0.024.";

/// At a bilateral law.
pub(crate) const BILATERAL: &str = "Bilateral: this contact also transmits tension.";

/// At the requests of reactions.
pub(crate) const REACTION: &str = "Reactions: JFLOAT on ground exerts no reaction on any part. The load on the \
girder and the reactions of its supports are available only from these REQUESTs.";

/// At the forces along the rail.
pub(crate) const SLOPE: &str = "Slope: the contact force is normal to the deflected rail; its component along the \
rail is F du/dx. Without it a body that rolls freely gains energy.";

/// Where there is no force along the rail.
pub(crate) const NO_SLOPE: &str = "Slope: AKISPL of a family has no iord, so the force along the rail, F du/dx, is \
missing. It matters where x is free; the form factored has it.";

/// At a spinning wheel.
pub(crate) const SPIN: &str =
    "The part of a spinning wheel has 1e-9 of the mass of its body, so that no part is without mass.";

/// At the integrator.
pub(crate) const INTEGRATOR: &str = "GSTIFF with SI2: the error control includes velocities, which determine the \
damping forces, and small steps at impacts do not make the Jacobian ill conditioned. HHT does not control the error \
of DIFF states.";

/// At the GFORCE of the first wheel.
pub(crate) const FORCE: &str =
    "GFORCE: acts on the wheel at I, with components along the axes of RM, the marker of the rail.";

/// At the paper's form.
pub(crate) const PAPER: &str = "The form of the paper, for comparison only: linear force that also acts in tension, \
damper to ground with three markers in VY, AKISPL(x_j, x_j) in the cross terms, IC = 0.";

/// At the tables of a structure.
pub(crate) fn tables(form: DeckForm, range: [f64; 2]) -> Vec<String> {
    let [first, last] = range.map(number);
    let read = match form {
        DeckForm::Akispl | DeckForm::Paper => {
            "Tables: x is the position of the load (Akima), z that of the deflection (linear); off the stations \
             G(x, z) and G(z, x) differ."
        }
        DeckForm::Symmetrised => {
            "Tables: x is the position of the load (Akima), z that of the deflection (linear); G(x, z) and \
             G(z, x) are averaged, which is symmetric, but not positive everywhere."
        }
        DeckForm::Factored => {
            "Tables: G(x, z) = sum of phi_k(x) phi_k(z), one SPLINE per product: symmetric and positive everywhere. \
             Products below 1e-6 of the largest entry are omitted."
        }
    };
    let beyond = format!(
        "Range: rail coordinates {first} to {last}. Beyond them the SPLINE extrapolates, by rules on which its \
         documents disagree: the wheels must stay inside."
    );
    vec![read.to_owned(), beyond]
}
