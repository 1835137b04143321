//! Fibres of the members under the rails of a structure, and their largest stresses at the rows of a history.

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

/// The largest stress of either sign over the rows at one place, and its row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowStress {
    pub size: f64,
    pub row: usize,
}

/// The largest stresses over the rows of a history, by section, and beside each load.
#[derive(Clone, Debug, Default)]
pub(super) struct StressRows {
    /// By section of the members; empty where stresses are not wanted.
    pub sections: Vec<RowStress>,
    /// By load, side (before, behind) and index in [`StressedSections::all`].
    pub wheels: Vec<RowStress>,
    count: usize,
}

impl StressRows {
    /// Without rows, for a number of sections of members and of loads.
    pub fn new(stressed: &StressedSections, sections: usize, loads: usize) -> StressRows {
        let count = stressed.all.len();
        let sections = if count == 0 { 0 } else { sections };
        let none = RowStress::default();
        StressRows {
            sections: vec![none; sections],
            wheels: vec![none; 2 * loads * count],
            count,
        }
    }

    /// Index in [`StressRows::wheels`].
    pub fn wheel(&self, (load, is_behind): (usize, bool), stressed: usize) -> usize {
        (2 * load + usize::from(is_behind)) * self.count + stressed
    }

    /// Adds the forces of a section at a row.
    pub fn add_section(
        &mut self,
        section: usize,
        own: Option<(usize, &Fibres)>,
        row: usize,
        values: &[f64],
    ) {
        if let Some((_, fibres)) = own {
            add(&mut self.sections[section], fibres, row, values);
        }
    }

    /// Adds the forces beside a load at a row.
    pub fn add_wheel(
        &mut self,
        load: (usize, bool),
        own: Option<(usize, &Fibres)>,
        row: usize,
        values: &[f64],
    ) {
        if let Some((index, fibres)) = own {
            let at = self.wheel(load, index);
            add(&mut self.wheels[at], fibres, row, values);
        }
    }
}

fn add(known: &mut RowStress, fibres: &Fibres, row: usize, values: &[f64]) {
    let size = fibres
        .worst(DIRECT.map(|k| values[k]))
        .map_or(0.0, |worst| worst.value().abs());
    if size > known.size {
        *known = RowStress { size, row };
    }
}
