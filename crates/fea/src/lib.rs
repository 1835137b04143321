//! Frames in space, and their influence functions along rails.
//!
//! A [`Model`] is points, sections, members, supports, springs, links and masses; a [`Girder`] is the short
//! form of a continuous beam. A [`Rail`] is a straight coordinate over some of the members. [`FactoredFrame::new`]
//! assembles and factors them once. The frame then answers any number of questions: a [`InfluenceGrid`] of influence
//! coefficients between chosen places, the [`CertifiedSurface::surface`] of whole rails, [`FactoredFrame::effects`] (reactions and
//! internal forces), [`FactoredFrame::modes`]. Every grid carries a [`Certificate`]: a bound of its error.
//!
//! Statics is linear with small displacements. Members are straight and uniform, and their stiffness is exact:
//! one member a span suffices, and no node is needed under a load. Units are consistent; the crate knows none.
//!
//! ```
//! use fea::{FactoredFrame, Girder};
//! use splines::{Axis, Probe};
//!
//! // A girder of 60 ft on two supports with overhangs of 15 ft; pounds and feet.
//! let girder = Girder {
//!     spans: vec![60.0],
//!     overhangs: [15.0, 15.0],
//!     e: 4.32e9,
//!     i_vertical: 9.528,
//!     ..Girder::default()
//! };
//! let (model, rail) = girder.model_and_rail()?;
//! let frame = FactoredFrame::new(&model, &[rail])?;
//!
//! // Deflections at three places per unit load at each of them: 3 x 3, ft/lb, positive up.
//! let at = [0.0, 15.0, 30.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
//! let grid = frame.grid(&at)?;
//! let midspan = 60.0_f64.powi(3) / (48.0 * 4.32e9 * 9.528);
//! assert!((grid.value[(2, 2)] / midspan - 1.0).abs() < 1e-13);
//! assert_eq!(grid.value[(1, 2)], grid.value[(2, 1)]);
//!
//! // No coefficient is wrong by more than this, relative to the diagonal.
//! assert!(grid.certificate.error_bound < 1e-12);
//! # Ok::<(), fea::Error>(())
//! ```
//!
//! Wings, lowest first: dof, error, model, assembly, factor, influence, modes, preload, large
//!
//! A file of one imports nothing of a later one:
//!
//! 1. `dof`, `error`: degrees of freedom, and what can be wrong;
//! 2. `model`: the structure as the caller describes it, plain values;
//! 3. `assembly`: elements, rigid bodies, elimination order, scaled stiffness;
//! 4. `factor`: sparse Cholesky in doubles and double-doubles, certificate, limits of memory;
//! 5. `influence`: rails laid over members, grids, surfaces, reactions and internal forces;
//! 6. `modes`: mass, natural modes, effects of inertia;
//! 7. `preload`: axial forces of a loaded state, critical factors, what such a state leaves out;
//! 8. `large`: finite displacements, and what the linear theories leave out.

mod assembly;
mod dof;
mod error;
mod factor;
mod influence;
mod large;
mod model;
mod modes;
mod preload;

pub use dof::{Dof, DofSet};
pub use error::{Buckling, EntryAttribute, EntryFault, Error, ModelEntry};
pub use factor::{Certificate, MEMORY_LIMIT};
pub use influence::{
    CertifiedSurface, DEFAULT_ACCURACY, Effect, FactoredFrame, InfluenceGrid, Reactions, Restraint,
    grid, point_compliance, surface,
};
pub use large::{LargeDisplacements, LargestDifference, LinearState, Omitted};
pub use model::{
    ArmStiffness, BeamTheory, CrossSection, Girder, GroundSpring, Member, MemberKind, Model,
    PointMass, Rail, RailSegment, RigidLink, Support, Taper,
};
pub use modes::{
    ExcitingForces, MOST_DENSE_UNKNOWNS, Mode, ModeInertia, Modes, RefinedModes, Weight,
    check_full_modes, excited_modes, full_modes, modes, refined_modes, rigid_mass,
};
pub use preload::{
    BucklingMode, Caution, CautionKind, CriticalFactor, LoadedFrame, MOST_CRITICAL, Preload,
    PreloadedState, RailForce, loaded_frame, preloaded,
};
pub use splines::ForceComponent;
