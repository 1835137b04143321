//! What a run writes beside the motion.

use practice::Repetition;

/// Which quantities of one kind are written as columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ColumnSelection {
    /// All of them where there are few.
    #[default]
    Few,
    /// All of them.
    All,
    /// None.
    None,
    /// Those with these names, or with names that continue one of these after a dot.
    Names(Vec<String>),
}

impl ColumnSelection {
    /// Whether the quantity `name` is selected, where `has_few` says whether there are few of its kind.
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

/// Whether `name` is `own`, or continues it after a dot.
pub(in crate::scene) fn belongs(name: &str, own: &str) -> bool {
    name.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// What a run writes beside the motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Output {
    /// Reactions of the ground.
    pub reactions: ColumnSelection,
    /// Internal forces at the sections that specs name.
    pub sections: ColumnSelection,
    /// Stresses at the points that specs give with sections.
    pub stresses: ColumnSelection,
    /// How fatigue is assessed from them.
    pub fatigue: Fatigue,
    /// Whether they include the effects of the structures' own weight.
    pub dead_load: bool,
    /// Ends of the spans whose deflections are assessed, where the scene gives them: index of the rail, coordinates.
    pub spans: Vec<(usize, Vec<f64>)>,
}

/// How fatigue is assessed from stress histories.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fatigue {
    /// Partial factor gamma_Ff on the stress ranges.
    pub loads: f64,
    /// Partial factor gamma_Mf on the fatigue strength.
    pub material: f64,
    /// Whether the history occurs once or repeats itself.
    pub history: Repetition,
    /// Number of runs in the design life; none: not known.
    pub crossings: Option<f64>,
}

impl Default for Fatigue {
    fn default() -> Fatigue {
        Fatigue { loads: 1.0, material: 1.0, history: Repetition::Once, crossings: None }
    }
}
