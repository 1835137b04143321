//! Errors of building the foundation of a structure and of running a scene on it.

use thiserror::Error;

/// The reason why a foundation cannot be built, or why a scene cannot run on it.
#[derive(Debug, Error)]
pub enum Error {
    /// The frame of a structure cannot be solved.
    #[error("{structure}: {source}")]
    Frame {
        /// Name of the structure.
        structure: String,
        /// The error of the solver.
        source: fea::Error,
    },
    /// The natural modes of a structure cannot be computed.
    #[error("{structure}: {source}{}", hint(source))]
    Modes {
        /// Name of the structure.
        structure: String,
        /// The error of the solver.
        source: fea::Error,
    },
    /// The tables or the rails of a structure cannot be used.
    #[error("{structure}: {source}")]
    Rails {
        /// Name of the structure.
        structure: String,
        /// The error in them.
        source: splines::Error,
    },
    /// A chain of rigid parts is a mechanism.
    #[error(transparent)]
    Chain(#[from] fea::Error),
    /// The rail of a chain of rigid parts cannot be made.
    #[error(transparent)]
    ChainRail(#[from] splines::Error),
    /// Rigid parts were requested for a structure that is not a straight girder.
    #[error("{structure}: rigid parts need a beam spec of a straight girder")]
    NoGirder {
        /// Name of the structure.
        structure: String,
    },
    /// Modes were requested for a structure that has no beam spec.
    #[error("{structure}: natural modes need a beam spec")]
    NoSpec {
        /// Name of the structure.
        structure: String,
    },
    /// The beam spec of a structure has not been solved.
    #[error("{structure}: its beam spec has not been solved")]
    Unsolved {
        /// Name of the structure.
        structure: String,
    },
    /// The exact influence surface of a structure has not been computed.
    #[error("{structure}: its influence surface has not been computed")]
    NoSurface {
        /// Name of the structure.
        structure: String,
    },
    /// The compliance of a structure along its rails is needed and cannot be evaluated.
    #[error("{structure}: its longitudinal compliance is not known  hint: omit `longitudinal`")]
    NoLongitudinal {
        /// Name of the structure.
        structure: String,
    },
    /// The windows in which a wheel passes between neighbouring rigid parts overlap.
    #[error("the hand-over windows of neighbouring parts overlap: shorten `blend`")]
    Windows,
    /// A quantity by which runs are judged cannot be computed.
    #[error("{0}")]
    Observed(String),
    /// The simulator refuses the scene.
    #[error(transparent)]
    Simulation(#[from] sim::Error),
}

/// Suggestion for the user about modes that cannot be computed.
fn hint(error: &fea::Error) -> &'static str {
    match error {
        fea::Error::NoMass => {
            "  hint: give its materials a density, or the girder `mass_per_length`"
        }
        fea::Error::TooManyModes { .. } | fea::Error::Elements { .. } => {
            "  hint: use \"modal\", or `modes` of \"ties\", to compute only the lowest modes, or use fewer `elements`"
        }
        _ => "",
    }
}

impl Error {
    /// Attributes an error of the frame solver to `structure`.
    pub fn frame(structure: &str) -> impl Fn(fea::Error) -> Error + '_ {
        move |source| Error::Frame {
            structure: structure.to_owned(),
            source,
        }
    }

    /// Attributes an error of the eigenvalue solver to `structure`.
    pub fn modes(structure: &str) -> impl Fn(fea::Error) -> Error + '_ {
        move |source| Error::Modes {
            structure: structure.to_owned(),
            source,
        }
    }

    /// Attributes an error in tables or rails to `structure`.
    pub fn rails(structure: &str) -> impl Fn(splines::Error) -> Error + '_ {
        move |source| Error::Rails {
            structure: structure.to_owned(),
            source,
        }
    }
}
