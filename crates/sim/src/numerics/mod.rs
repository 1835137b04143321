//! General numerical methods that do not depend on mechanics: dense products and linear systems, the linear
//! complementarity problem, least squares with coefficients that are not negative, root finding in one variable, cubic polynomials, and the STEP function with its integral.

pub(crate) mod complementarity;
pub(crate) mod cubic;
pub(crate) mod dense;
pub(crate) mod lu;
pub(crate) mod nonnegative;
pub(crate) mod propagator;
pub(crate) mod root;
pub(crate) mod step;
