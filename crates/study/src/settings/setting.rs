//! Settings: the scene with one foundation, one accuracy, one method.

use sim::Method;

use formats::scene::{Scene, TableInterpolation, stepper_word};

/// A family of settings: the points of one curve of a chart, along which one parameter varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingFamily {
    /// Rigid rails, over accuracy.
    Rigid,
    /// Chains of rigid parts, over their number.
    Parts,
    /// Influence surfaces without mass, over accuracy.
    Influence,
    /// Natural modes with the residual flexibility of the others, over their number.
    Modal,
    /// Natural modes without residual flexibility, over their number.
    ModalWithoutResidual,
    /// All modes of a mesh, over the number of elements of a member.
    Mesh,
    /// All modes of the mesh that is the highest fidelity of "auto", over accuracy.
    Full,
    /// The scene's own foundations by one method with adaptive steps, over accuracy.
    Adaptive(Method),
    /// The scene's own foundations by one method with equal steps, over their number.
    Fixed(Method),
    /// Influence coefficients read from tables, over the number of stations of a rail.
    Table(TableInterpolation),
    /// The scene as written; foundations that it leaves to "auto" are those that "auto" chose.
    Written,
    /// The foundations that "auto" chose, at the accuracy of its last run.
    Auto,
    /// The scene as written, compared with other methods on its own foundations.
    Stepping,
}

/// Kinds of converged references.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceKind {
    /// The most complete model of the structure: with mass where it has any.
    Whole,
    /// The scene's own foundations.
    Own,
    /// The exact influence surface of the structure, without mass.
    Massless,
}

impl ReferenceKind {
    /// The word of this kind in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            ReferenceKind::Whole => "whole",
            ReferenceKind::Own => "own",
            ReferenceKind::Massless => "massless",
        }
    }
}

/// One setting of a study: a scene with everything chosen.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The curve it belongs to.
    pub family: SettingFamily,
    /// Name of the parameter that varies along the curve, such as `accuracy`.
    pub parameter: &'static str,
    /// Value of this parameter.
    pub value: f64,
    /// The scene with this foundation, accuracy and method.
    pub scene: Scene,
    /// Number of stations of each rail of the tables that are read; `None`: those of the specs.
    pub stations: Option<usize>,
}

impl SettingFamily {
    /// The name of the family in legends and files.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            SettingFamily::Rigid => "rigid".into(),
            SettingFamily::Parts => "parts".into(),
            SettingFamily::Influence => "influence".into(),
            SettingFamily::Modal => "modal".into(),
            SettingFamily::ModalWithoutResidual => "modal, no residual".into(),
            SettingFamily::Mesh => "mesh".into(),
            SettingFamily::Full => "full".into(),
            SettingFamily::Adaptive(own) => stepper_word(own).into(),
            SettingFamily::Fixed(own) => format!("{}, equal steps", stepper_word(own)),
            SettingFamily::Table(TableInterpolation::Exact) => "exact surface".into(),
            SettingFamily::Table(reading) => format!("{} tables", reading.word()),
            SettingFamily::Written | SettingFamily::Stepping => "as written".into(),
            SettingFamily::Auto => "auto".into(),
        }
    }

    /// The kind of reference that its errors are measured against.
    #[must_use]
    pub const fn reference_kind(self) -> ReferenceKind {
        match self {
            SettingFamily::Adaptive(_) | SettingFamily::Fixed(_) | SettingFamily::Stepping => {
                ReferenceKind::Own
            }
            SettingFamily::Table(_) => ReferenceKind::Massless,
            _ => ReferenceKind::Whole,
        }
    }

    /// Whether the natural modes are used without residual flexibility.
    #[must_use]
    pub const fn omits_residual(self) -> bool {
        matches!(self, SettingFamily::ModalWithoutResidual)
    }
}

impl Setting {
    /// The setting in words, such as `modal, modes 4`.
    #[must_use]
    pub fn label(&self) -> String {
        let Setting {
            family,
            parameter,
            value,
            ..
        } = self;
        let value = if *value < 1.0 {
            format!("{value:e}")
        } else {
            value.to_string()
        };
        format!("{}, {parameter} {value}", family.name())
    }
}
