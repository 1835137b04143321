//! Small numerical methods that know nothing of mechanics: dense products and systems, the linear complementarity
//! problem, roots of functions of one variable, and the STEP function with its integral.

pub(crate) mod complementarity;
pub(crate) mod dense;
pub(crate) mod root;
pub(crate) mod step;
