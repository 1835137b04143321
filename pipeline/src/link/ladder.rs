//! Foundations on demand, for structures whose foundation is "auto".

use sim::{Choice, Ladder, Reason, Rung};
use splines::Compliance;

use super::{Solved, foundation, modal};
use crate::cases::{Known, solved_of};
use crate::exit::Failure;
use crate::scene::{Foundation, Scene, Structure};

/// Elements of the mesh at the top where they suffice, and fewest and most a member.
const ELEMENTS: usize = 192;
const A_MEMBER: [usize; 2] = [8, 64];

impl From<sim::Error> for Failure {
    fn from(error: sim::Error) -> Failure {
        Failure::Untrusted(error.to_string())
    }
}

/// Sets the foundation of every structure of `scene` that is "auto", and says why.
///
/// # Errors
/// A foundation that cannot be made; a scene that cannot start.
pub fn choose(
    scene: &mut Scene,
    cast: &sim::Scene,
    known: &[Known],
    lateral: bool,
) -> Result<Vec<Choice>, Failure> {
    let tolerances: Vec<Option<f64>> =
        scene.structures.iter().map(|structure| structure.auto.then_some(structure.tolerance)).collect();
    if tolerances.iter().all(Option::is_none) {
        return Ok(Vec::new());
    }
    let choices = sim::choose(cast, &tolerances, &mut Rungs { scene, known, lateral })?;
    for choice in &choices {
        let structure = &mut scene.structures[choice.structure];
        let solved = solved_of(known, &structure.origin);
        structure.foundation = at(structure, choice.rung, elements(solved));
    }
    Ok(choices)
}

/// Elements a member of the mesh at the top.
fn elements(solved: Option<&Solved>) -> usize {
    let members = solved.map_or(1, |solved| solved.model.members.len());
    (ELEMENTS / members.max(1)).clamp(A_MEMBER[0], A_MEMBER[1])
}

/// A solved structure at `rung` for vertical wheel forces; `damping` of its modes by critical, `finer` times as many
/// elements a member at the top as `"auto"` takes.
///
/// # Errors
/// A structure without mass where modes are asked for; too many unknowns.
pub fn rung_of(solved: &Solved, rung: Rung, damping: f64, finer: usize) -> Result<sim::Foundation, Failure> {
    let name = "structure";
    let rails = solved.rails.iter().enumerate();
    match (rung, &solved.surface) {
        (Rung::Modal(modes), _) => Ok(modal::lowest(name, solved, modes, damping, false.into())?.foundation),
        (Rung::Full, _) => {
            let finer = finer * elements(Some(solved));
            Ok(modal::full(name, solved, finer, damping, false.into())?.foundation)
        }
        (Rung::Influence, Some(surface)) => {
            Ok(sim::Foundation::influence(Box::new(surface.clone()), rails.len()))
        }
        (Rung::Influence, None) => Err(Failure::Untrusted(format!("{name}: its surface is not known"))),
        (Rung::Rigid, surface) => {
            let range = |rail| surface.as_ref().and_then(|surface| surface.range(rail));
            let extent = |(rail, _)| sim::Extent { range: range(rail), breaks: Vec::new() };
            Ok(sim::Foundation { rails: rails.map(extent).collect(), ..sim::Foundation::rigid() })
        }
    }
}

/// What a rung is in a scene.
fn at(structure: &Structure, rung: Rung, elements: usize) -> Foundation {
    let damping = structure.damping;
    match rung {
        Rung::Rigid => Foundation::Rigid,
        Rung::Influence => Foundation::Influence,
        Rung::Modal(modes) => Foundation::Modal { modes, damping },
        Rung::Full => Foundation::Full { elements, damping },
    }
}

struct Rungs<'a> {
    scene: &'a Scene,
    known: &'a [Known],
    lateral: bool,
}

impl Rungs<'_> {
    fn solved(&self, structure: usize) -> Option<&Solved> {
        solved_of(self.known, &self.scene.structures[structure].origin)
    }
}

impl Ladder for Rungs<'_> {
    type Error = Failure;

    fn has_mass(&mut self, structure: usize) -> Result<bool, Failure> {
        let Some(solved) = self.solved(structure) else { return Ok(false) };
        let modes = fea::refined_modes(&solved.model, &solved.rails, 1, 1e-3);
        Ok(!matches!(modes, Err(fea::Error::NoMass)))
    }

    fn foundation(&mut self, structure: usize, rung: Rung) -> Result<sim::Foundation, Failure> {
        let mut own = self.scene.structures[structure].clone();
        if own.auto {
            own.foundation = at(&own, rung, elements(self.solved(structure)));
        }
        foundation(&own, self.solved(structure), self.lateral)
    }
}

/// A rung in words.
#[must_use]
pub fn word(rung: Rung) -> String {
    match rung {
        Rung::Rigid => "rigid".to_owned(),
        Rung::Influence => "influence".to_owned(),
        Rung::Modal(modes) => format!("modal, {modes} modes"),
        Rung::Full => "full".to_owned(),
    }
}

/// Why a foundation was chosen, in a sentence without its stop.
#[must_use]
pub fn reason(choice: &Choice) -> String {
    let rung = word(choice.rung);
    match (choice.reason, choice.estimate) {
        (Reason::NoMass, _) => {
            format!("auto: {rung}; no mass given: the error of leaving it out is not known")
        }
        (Reason::QuasiStatic, _) => format!("auto: {rung}; a quasi-static sweep has no inertia"),
        (Reason::Sufficient, estimate) => format!(
            "auto: {rung}, the lowest rung tried whose estimated error, {:.1e}, is within the tolerance",
            estimate.unwrap_or_default()
        ),
        (Reason::Top, _) => {
            format!("auto: {rung}, as nothing lower was within the tolerance; its own error is not estimated")
        }
        (Reason::Unchecked, _) => {
            format!("auto: {rung}, which no higher rung could check: its error is not known")
        }
    }
}
