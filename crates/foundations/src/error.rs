//! Why a solved structure cannot be made a foundation.

use thiserror::Error;

/// Why a foundation cannot be built, or why a scene cannot run on it.
#[derive(Debug, Error)]
pub enum Error {
    /// The frame of a structure cannot be solved.
    #[error("{structure}: {source}")]
    Frame {
        /// Name of the structure.
        structure: String,
        /// What the solver refuses.
        source: fea::Error,
    },
    /// The natural modes of a structure cannot be found.
    #[error("{structure}: {source}{}", hint(source))]
    Modes {
        /// Name of the structure.
        structure: String,
        /// What the solver refuses.
        source: fea::Error,
    },
    /// The tables or the rails of a structure cannot be used.
    #[error("{structure}: {source}")]
    Rails {
        /// Name of the structure.
        structure: String,
        /// What is wrong with them.
        source: splines::Error,
    },
    /// A chain of rigid parts does not stand.
    #[error(transparent)]
    Chain(#[from] fea::Error),
    /// The rail of a chain of rigid parts cannot be made.
    #[error(transparent)]
    ChainRail(#[from] splines::Error),
    /// Rigid parts are asked for of a structure that is no straight girder.
    #[error("{structure}: parts need a beam spec of a straight girder")]
    NoGirder {
        /// Name of the structure.
        structure: String,
    },
    /// Modes are asked for of a structure that has no beam spec.
    #[error("{structure}: modes need a beam spec")]
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
    /// The exact surface of a structure is not known.
    #[error("{structure}: its surface is not known")]
    NoSurface {
        /// Name of the structure.
        structure: String,
    },
    /// The compliance of a structure along its rails is asked for and not known.
    #[error("{structure}: its give along the rails is not known  hint: leave `longitudinal` out")]
    NoLongitudinal {
        /// Name of the structure.
        structure: String,
    },
    /// The windows in which neighbouring rigid parts hand a wheel over overlap.
    #[error("the hand-over windows of neighbouring parts overlap: shorten `blend`")]
    Windows,
    /// The simulator refuses the scene.
    #[error(transparent)]
    Simulation(#[from] sim::Error),
}

/// What the user may do about modes that cannot be found.
fn hint(error: &fea::Error) -> &'static str {
    match error {
        fea::Error::NoMass => "  hint: give its materials a density, or the girder `mass_per_length`",
        fea::Error::TooManyModes { .. } => {
            "  hint: \"modal\" takes the lowest modes alone, as `modes` of \"ties\" does; or fewer `elements`"
        }
        _ => "",
    }
}

impl Error {
    /// A frame of `structure` that cannot be solved.
    pub fn frame(structure: &str) -> impl Fn(fea::Error) -> Error + '_ {
        move |source| Error::Frame { structure: structure.to_owned(), source }
    }

    /// Modes of `structure` that cannot be found.
    pub fn modes(structure: &str) -> impl Fn(fea::Error) -> Error + '_ {
        move |source| Error::Modes { structure: structure.to_owned(), source }
    }

    /// Tables or rails of `structure` that cannot be used.
    pub fn rails(structure: &str) -> impl Fn(splines::Error) -> Error + '_ {
        move |source| Error::Rails { structure: structure.to_owned(), source }
    }
}
