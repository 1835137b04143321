//! One way to run a scene.

use sim::Method;

use formats::scene::{Reading, Scene, stepper_word};

/// What varies along a curve of a chart, everything else alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingFamily {
    /// Rails that do not give, by accuracy.
    Rigid,
    /// Chains of rigid parts, by their number.
    Parts,
    /// Influence without mass, by accuracy.
    Influence,
    /// Natural modes with the static give of the others, by their number.
    Modal,
    /// Natural modes alone, by their number.
    Pure,
    /// All modes of a mesh, by elements a member.
    Mesh,
    /// All modes of the mesh that "auto" takes as the top, by accuracy.
    Full,
    /// The scene's own foundations by one method, by accuracy.
    Adaptive(Method),
    /// The scene's own foundations by steps of one length.
    Fixed(Method),
    /// Influence read from tables, by stations a rail.
    Table(Reading),
    /// The scene as it is written, or on the foundations that "auto" chose where it asks for that.
    Written,
    /// The foundations that "auto" chose, at the accuracy of its last run.
    Auto,
    /// The scene as it is written, beside other methods on its own foundations.
    Stepping,
}

/// Which converged run errors are measured against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The structure with all that is known of it: its mass where it has one.
    Whole,
    /// The scene's own foundations.
    Own,
    /// The structure without mass, exactly.
    Massless,
}

impl Against {
    /// Its word in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Against::Whole => "whole",
            Against::Own => "own",
            Against::Massless => "massless",
        }
    }
}

/// One way to run a scene.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The curve it belongs to.
    pub family: SettingFamily,
    /// What varies along the curve, in words, such as `accuracy`.
    pub knob: &'static str,
    /// Its value.
    pub value: f64,
    /// The scene with everything set.
    pub scene: Scene,
    /// Stations a rail of the tables that are read; `None`: those of the specs.
    pub stations: Option<usize>,
}

impl SettingFamily {
    /// Its name in legends and files.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            SettingFamily::Rigid => "rigid".into(),
            SettingFamily::Parts => "parts".into(),
            SettingFamily::Influence => "influence".into(),
            SettingFamily::Modal => "modal".into(),
            SettingFamily::Pure => "modal, no residual".into(),
            SettingFamily::Mesh => "mesh".into(),
            SettingFamily::Full => "full".into(),
            SettingFamily::Adaptive(own) => stepper_word(own).into(),
            SettingFamily::Fixed(own) => format!("{}, equal steps", stepper_word(own)),
            SettingFamily::Table(Reading::Exact) => "exact surface".into(),
            SettingFamily::Table(reading) => format!("{} tables", reading.word()),
            SettingFamily::Written | SettingFamily::Stepping => "as written".into(),
            SettingFamily::Auto => "auto".into(),
        }
    }

    /// What its errors are measured against.
    #[must_use]
    pub const fn against(self) -> Against {
        match self {
            SettingFamily::Adaptive(_) | SettingFamily::Fixed(_) | SettingFamily::Stepping => Against::Own,
            SettingFamily::Table(_) => Against::Massless,
            _ => Against::Whole,
        }
    }

    /// Whether its modes are to leave out the static give of the others.
    #[must_use]
    pub const fn is_pure(self) -> bool {
        matches!(self, SettingFamily::Pure)
    }
}

impl Setting {
    /// In words, such as `modal, 4 modes`.
    #[must_use]
    pub fn label(&self) -> String {
        let Setting { family, knob, value, .. } = self;
        let value = if *value < 1.0 { format!("{value:e}") } else { value.to_string() };
        format!("{}, {knob} {value}", family.name())
    }
}
