//! Roles of the keywords that do not define the structure: which of them are left out, and why others are refused.

/// Why a keyword that does not define the structure may be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeywordRole {
    /// It is left out without a warning: titles and the frame of steps.
    Frame,
    /// It is left out with a warning: loads, solutions and output requests.
    Request,
    /// It cannot change the linear static stiffness, and is left out where the user asks for this.
    NoStiffness,
}

const FRAME: &[&str] = &[
    "HEADING",
    "PREPRINT",
    "STEP",
    "END STEP",
    "END PART",
    "ASSEMBLY",
    "END ASSEMBLY",
    "END INSTANCE",
    "RESTART",
];

const REQUESTS: &[&str] = &[
    "STATIC",
    "FREQUENCY",
    "DYNAMIC",
    "BUCKLE",
    "STEADY STATE DYNAMICS",
    "MODAL DYNAMIC",
    "PERTURBATION",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "ENERGY OUTPUT",
    "CONTACT OUTPUT",
    "NODE PRINT",
    "EL PRINT",
    "NODE FILE",
    "EL FILE",
    "ENERGY PRINT",
    "ENERGY FILE",
    "MODAL PRINT",
    "MODAL FILE",
    "SECTION PRINT",
    "SECTION FILE",
    "FILE FORMAT",
    "FILE OUTPUT",
    "MONITOR",
    "PRINT",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "AMPLITUDE",
    "TEMPERATURE",
    "FIELD",
    "CONTROLS",
    "TIME POINTS",
    "SECTION POINTS",
];

const NO_STIFFNESS: &[&str] = &[
    "PLASTIC",
    "DAMPING",
    "MODAL DAMPING",
    "GLOBAL DAMPING",
    "EXPANSION",
    "CONDUCTIVITY",
    "SPECIFIC HEAT",
    "CREEP",
    "DASHPOT",
    "SURFACE",
    "INITIAL CONDITIONS",
    "PHYSICAL CONSTANTS",
    "RATE DEPENDENT",
    "FAIL STRAIN",
    "FAIL STRESS",
    "CYCLIC HARDENING",
    "BASE MOTION",
    "DESIGN PARAMETER",
    "DESIGN RESPONSE",
];

/// The role of a keyword; `None` if it may be part of the structure, or is not known.
#[must_use]
pub fn role(name: &str) -> Option<KeywordRole> {
    if FRAME.contains(&name) {
        Some(KeywordRole::Frame)
    } else if REQUESTS.contains(&name) {
        Some(KeywordRole::Request)
    } else {
        NO_STIFFNESS
            .contains(&name)
            .then_some(KeywordRole::NoStiffness)
    }
}

/// What a keyword that is refused does to the model if it is left out; `None` if only the user can know this.
#[must_use]
pub fn loss(name: &str) -> Option<&'static str> {
    (name == "NORMAL").then_some(
        "the normal turns the sections of beams at its nodes, so that --skip NORMAL changes the model unless the normals \
         agree with n1 of the sections",
    )
}

/// Advice for a keyword that is refused: what the reader supports instead.
#[must_use]
pub fn advice(name: &str) -> &'static str {
    match name {
        "EQUATION" | "COUPLING" | "KINEMATIC" | "DISTRIBUTING" | "KINEMATIC COUPLING" | "TIE" => {
            "supported links are *RIGID BODY with NSET and *MPC BEAM, TIE and PIN"
        }
        "NORMAL" => "state the direction n1 on the second data line of the section",
        "ORIENTATION" | "SYSTEM" | "TRANSFORM" => {
            "coordinates and directions must refer to the global axes"
        }
        "SHELL SECTION" | "SHELL GENERAL SECTION" | "MEMBRANE SECTION" => {
            "shells and membranes are not supported"
        }
        "CONNECTOR SECTION" | "CONNECTOR BEHAVIOR" | "CONNECTOR ELASTICITY" => {
            "supported springs are SPRING1 and SPRINGA"
        }
        "BEAM SECTION OFFSET" | "BEAM ADDED INERTIA" | "BEAM FLUID INERTIA" => {
            "the nodes of beams must be on their centroidal axes"
        }
        _ => "a beam spec consists of members, rigid links, masses and springs to ground",
    }
}
