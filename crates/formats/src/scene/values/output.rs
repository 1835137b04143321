//! Output of a run in addition to the motion.

use practice::Repetition;

/// Selection of the quantities of one kind that are written as columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ColumnSelection {
    /// All of them if their number is small.
    #[default]
    Few,
    /// All of them.
    All,
    /// None.
    None,
    /// Those with these names, or with names that consist of one of these followed by a dot and a suffix.
    Names(Vec<String>),
}

impl ColumnSelection {
    /// Whether the quantity `name` is selected. `few` specifies whether the number of quantities of its kind is
    /// small.
    #[must_use]
    pub fn selects(&self, name: &str, few: bool) -> bool {
        match self {
            ColumnSelection::Few => few,
            ColumnSelection::All => true,
            ColumnSelection::None => false,
            ColumnSelection::Names(all) => all.iter().any(|own| belongs(name, own)),
        }
    }
}

/// Whether `name` is `own`, or `own` followed by a dot and a suffix.
pub(in crate::scene) fn belongs(name: &str, own: &str) -> bool {
    name.strip_prefix(own)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Output of a run in addition to the motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Reactions of the ground.
    pub reactions: ColumnSelection,
    /// Internal forces at the sections named in specs.
    pub sections: ColumnSelection,
    /// Stresses at the points that specs define for sections.
    pub stresses: ColumnSelection,
    /// Parameters of the fatigue assessment from these stresses.
    pub fatigue: Fatigue,
    /// Whether reactions, internal forces and stresses include the effects of the self-weight of the structures.
    pub dead_load: bool,
    /// Ends of the spans whose deflections are assessed, if the scene specifies them: index of the rail, coordinates.
    pub spans: Vec<(usize, Vec<f64>)>,
}

/// Parameters of the fatigue assessment from stress histories.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fatigue {
    /// Partial factor gamma_Ff on the stress ranges.
    pub loads: f64,
    /// Partial factor gamma_Mf on the fatigue strength.
    pub material: f64,
    /// Whether the history occurs once or is repeated.
    pub history: Repetition,
    /// Number of runs in the design life; none if it is unknown.
    pub crossings: Option<f64>,
}

impl Default for Fatigue {
    fn default() -> Fatigue {
        Fatigue {
            loads: 1.0,
            material: 1.0,
            history: Repetition::Once,
            crossings: None,
        }
    }
}
