//! Fibres of the members under the rails of a structure.

use design::{Fibres, GirderSections};
use fea::Effect;
use formats::scene::Scene;
use formats::spec::Spec;
use trains::{GirderResponse, MemberForces};

use foundations::SolvedModel;

/// Indices of the quantities that cause direct stress: normal force, vertical and lateral moment.
pub(super) const DIRECT: [usize; 3] = [
    GirderResponse::Normal as usize,
    GirderResponse::VerticalMoment as usize,
    GirderResponse::LateralMoment as usize,
];

/// A section under a rail whose stresses are known.
#[derive(Clone, Debug)]
pub(super) struct RailFibres {
    /// Index in the list of rails.
    pub rail: usize,
    pub fibres: Fibres,
}

/// The sections of a structure whose stresses are wanted; empty where the scene does not ask for them.
#[derive(Clone, Debug, Default)]
pub(super) struct StressedSections {
    /// Each section of each rail once.
    pub all: Vec<RailFibres>,
    /// By member under a rail: the index of its section, where there is one.
    pub of_member: Vec<Option<usize>>,
    /// Rails of the scene, and what keeps sections under them from having stresses.
    pub lacks: Vec<(usize, String)>,
}

impl StressedSections {
    /// The sections of all `rails` of the structure that `spec` describes, each by its index in the scene and in the structure.
    pub fn new(
        scene: &Scene,
        spec: &Spec,
        solved: &SolvedModel,
        members: &MemberForces,
        rails: &[[usize; 2]],
    ) -> StressedSections {
        let Some(lateral) = scene.lateral_section else {
            return StressedSections::default();
        };
        let sections = GirderSections::new(spec, lateral, &solved.model, &solved.rails);
        let mut out = StressedSections::default();
        for [in_scene, rail] in rails {
            let lacks = sections.lacks_stress(*rail);
            out.lacks
                .extend(lacks.into_iter().map(|why| (*in_scene, why)));
        }
        for (index, member) in members.members().enumerate() {
            let own = match members.effects(index, 0.0)[0] {
                Effect::InternalForce { member: own, .. } => sections.of(member.rail, own),
                Effect::Reaction(_) => None,
            };
            let rail = rails.iter().position(|[_, rail]| *rail == member.rail);
            let found = rail.zip(own);
            out.of_member.push(found.map(|(rail, fibres)| {
                let known = out
                    .all
                    .iter()
                    .position(|known| known.rail == rail && known.fibres == *fibres);
                known.unwrap_or_else(|| {
                    out.all.push(RailFibres {
                        rail,
                        fibres: fibres.clone(),
                    });
                    out.all.len() - 1
                })
            }));
        }
        out
    }

    /// The section of a member and its index.
    pub fn of(&self, member: usize) -> Option<(usize, &Fibres)> {
        let index = (*self.of_member.get(member)?)?;
        Some((index, &self.all[index].fibres))
    }
}
