//! The members under the rails of every spec, solved when they are first needed and shared by all cases.

use std::sync::OnceLock;

use foundations::{SolvedModel, SolvedStructure};
use trains::MemberForces;

/// The members under the rails of the solved specs of a document.
pub(crate) struct SolvedMembers {
    known: Vec<SolvedStructure>,
    members: Vec<OnceLock<Result<MemberForces, trains::Error>>>,
}

impl SolvedMembers {
    /// The members of none of `known` are solved yet.
    pub fn new(known: &[SolvedStructure]) -> SolvedMembers {
        SolvedMembers {
            known: known.to_vec(),
            members: known.iter().map(|_| OnceLock::new()).collect(),
        }
    }

    /// The solved specs.
    pub fn known(&self) -> &[SolvedStructure] {
        &self.known
    }

    /// The members of a solution that is one of those known; `None` for another one.
    ///
    /// # Errors
    /// Those of [`MemberForces::new`].
    pub fn of(&self, solved: &SolvedModel) -> Option<Result<&MemberForces, trains::Error>> {
        let index = self
            .known
            .iter()
            .position(|entry| std::ptr::eq(&*entry.solution, solved))?;
        let members =
            self.members[index].get_or_init(|| MemberForces::new(&solved.model, &solved.rails));
        Some(members.as_ref().map_err(Clone::clone))
    }
}
