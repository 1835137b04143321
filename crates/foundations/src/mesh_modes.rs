//! Natural modes of one mesh of a structure, and those that its solution keeps for later runs.

use std::sync::Arc;

use fea::RefinedModes;
use formats::kept::KeptValues;
use splines::ExactSurface;

use crate::error::Error;
use crate::mount::Excitation;

/// Modes of one mesh that wheels can excite, and the static compliance from which the retained modes are subtracted.
pub(super) struct MeshModes {
    pub refined: RefinedModes,
    pub excited: Vec<fea::Mode>,
    pub compliance: StaticCompliance,
    /// Whether `excited` contains every mode of the mesh that wheels can excite.
    pub is_whole: bool,
}

/// Static compliance of the structure before modes are subtracted.
pub(super) enum StaticCompliance {
    /// Compliance of the members as given, used with the lowest modes, whose shapes the mesh resolves.
    Given(ExactSurface),
    /// Compliance of the subdivided members, used with all modes of a mesh.
    Subdivided(ExactSurface),
}

/// What modes of a structure are asked for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum ModeRequest {
    /// At least the lowest `count` modes with frequencies within `accuracy`.
    Lowest {
        count: usize,
        accuracy: f64,
        excitation: Excitation,
    },
    /// All modes of a mesh of `elements` elements for each member.
    Whole {
        elements: usize,
        has_dampers: bool,
        excitation: Excitation,
    },
}

/// Natural modes of a structure that have been computed, for all runs on it. Each depends on the request alone, so that
/// results do not depend on the order in which runs are made.
#[derive(Default)]
pub struct ComputedModes {
    kept: KeptValues<ModeRequest, Arc<MeshModes>>,
}

impl ComputedModes {
    /// The modes of a request, which `compute` computes unless they are known.
    pub(super) fn get(
        &self,
        request: ModeRequest,
        compute: impl FnOnce() -> Result<MeshModes, Error>,
    ) -> Result<Arc<MeshModes>, Error> {
        self.kept.get(&request, || compute().map(Arc::new))
    }
}
