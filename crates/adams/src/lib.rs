//! The ADAMS data-set language: statements, SPLINE tables, function expressions and their execution.
//!
//! The crate reads and writes whole data sets (`.adm`), resolves every reference, and executes a data set: it
//! computes forces at a given state, static equilibrium and the quasi-static path. It does not integrate
//! motion. It depends on no other crate of this workspace, so that its results check the simulator
//! independently, and it opens no file: callers pass text.
//!
//! A mass of 2 kg on a spring of 1000 N/m is in equilibrium where the spring carries its weight:
//!
//! ```
//! use adams::{DataSet, AdamsModel};
//!
//! let text = "mass on a spring
//! UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
//! PART/1, GROUND
//! MARKER/1, PART=1
//! PART/2, MASS=2, CM=2, IP=1,1,1
//! MARKER/2, PART=2
//! JOINT/1, TRANSLATIONAL, I=2, J=1
//! SFORCE/1, TRANSLATIONAL, ACTIONONLY, I=2, J=1, FUNCTION=-1000*DZ(2,1)
//! ACCGRAV/KGRAV=-9.80665
//! END";
//! let model = AdamsModel::new(&DataSet::read(text)?)?;
//! let rest = model.equilibrium(0.0, &model.initial())?;
//! let height = rest.state.parts[&2].origin.z;
//! assert!((height + 2.0 * 9.80665 / 1000.0).abs() < 1e-12);
//! # Ok::<(), adams::Error>(())
//! ```
//!
//! # Order of the wings
//!
//! Wings, lowest first: keyword, error, number, expression, language, tables, view, kinematics, model, solve
//!
//! A file imports from its own wing and from those before it, never from a later one.
//!
//! 1. `keyword`, `error`, `number`: words, errors and numbers, which all wings use.
//! 2. `expression`: function expressions as trees, their functions, dual numbers.
//! 3. `language`: lines, statements, data sets, units.
//! 4. `tables`: SPLINE statements and how AKISPL and CUBSPL interpolate them.
//! 5. `view`: the same tables in the command language of Adams View.
//! 6. `kinematics`: vectors, poses, frames, and what DX to WZ measure.
//! 7. `model`: a data set with every reference resolved.
//! 8. `solve`: linear and nonlinear equations, algebraic loops, static equilibrium.

mod keyword;

pub mod error;
pub mod number;

pub mod expression;

mod language;

pub mod tables;

pub mod view;

mod kinematics;

mod model;

mod solve;

pub use error::{AdamsFault, Error};
pub use expression::functions;
pub use expression::{Dual, Expression, Scalar};
pub use keyword::{Keyword, StatementId};
pub use kinematics::{ModelState, Pose};
pub use language::{
    AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits, ArgumentValue, DataSet, Statement,
    StatementArgument,
};
pub use model::AdamsModel;
pub use solve::{
    ConstraintReaction, EquationResidual, Equilibrium, GivenValues, Load, NewtonStep,
    RotationMeasure, SolvedModelState, SubstitutedValues, Substitution,
};
pub use tables::{Spline, SplineFunction, SplineMethod, SplineReading, SplineValues, Tables};
