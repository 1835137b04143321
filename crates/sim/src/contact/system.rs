//! The numbered scene with its force elements: M q'' + C q' + K q = f(t) - B^T F.
//!
//! The elements are ordered by kind: vertical contacts, flanges, frictions, drives, brakes, ropes and stops.

use std::ops::Range;

use splines::{Axis, Probe};

use super::candidates::Candidates;
use super::element::{ElementProbe, Fixed, GuardKind, Role};
use super::elements::ForceElement;
use super::probes::{Entry, Probes, TangentialContact};
use super::rope::RopeForce;
use super::vertical::Vertical;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::state::State;
use crate::{Channel, Error, Foundation, NormalLaw, Scene};

/// The numbered scene.
pub(crate) struct System<'a> {
    pub scene: &'a Scene,
    pub foundations: &'a [Foundation],
    pub mechanics: Mechanics<'a>,
    pub elements: Vec<ForceElement<'a>>,
    /// All elements.
    pub all: Candidates,
    /// Elements that depend on the heights of wheels.
    pub by_height: Candidates,
    /// Properties of each element that are the same at every state.
    pub fixed: Vec<Fixed>,
    /// Whether the rail below each vertical contact moves with degrees of freedom alone, without a compliance of its own,
    /// so that the rate of the penetration is a function of the motion.
    pub follows_motion: Vec<bool>,
    /// The first wheel of each element, if it acts on wheels.
    pub first_wheel: Vec<Option<usize>>,
    /// Degrees of freedom from the first to the last on which the row of each element depends.
    pub row_spans: Vec<Range<usize>>,
    pub probes: Probes,
    pub traits: Traits,
    /// Elements that guide wheels laterally, and springs between two points (ropes and stops).
    guides: Vec<usize>,
    springs: Vec<usize>,
    /// Element index of each rope.
    ropes: Vec<usize>,
    /// Elements whose guards are of kind `Touch`, and of kind `Corner`.
    touching: Vec<usize>,
    cornered: Vec<usize>,
}

/// Simplifications that apply to a scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Traits {
    /// Whether at least one wheel runs on an uneven rail.
    pub is_uneven: bool,
    /// Whether the rows of all elements are the same at every time and position.
    pub has_constant_rows: bool,
    /// Whether a structure consists of rigid parts that transfer wheels to one another, with one contact force per
    /// part.
    pub has_parts: bool,
    /// Whether the x of some body is prescribed, so that the slopes of the rails have a power.
    pub has_motions: bool,
    /// Whether vertical contacts are the only elements.
    pub is_vertical: bool,
    /// Whether every vertical law is linear.
    pub has_linear_laws: bool,
    /// Whether a damper acts between at least one wheel and its rail, so that its penetration is a state.
    pub has_memory: bool,
    /// Whether the law of at least one element depends on the heights of wheels.
    pub uses_heights: bool,
    /// Whether positions or rows change with the motion within a stage, so that its matrices depend on its solution.
    pub follows_motion: bool,
    /// Whether the compliance of every structure is symmetric.
    pub has_symmetric_rails: bool,
    /// Whether the linear contact equations are symmetric: see [`crate::contact::forces`].
    pub is_symmetric: bool,
}

impl<'a> System<'a> {
    /// Numbers a scene.
    ///
    /// # Errors
    /// Every error that [`Mechanics::new`] reports.
    pub fn new(scene: &'a Scene, foundations: &'a [Foundation]) -> Result<Self, Error> {
        let mechanics = Mechanics::new(scene, foundations)?;
        let elements = ForceElement::all(&mechanics);
        let with = |role: Role| {
            (0..elements.len())
                .filter(|&i| elements[i].role() == role)
                .collect()
        };
        let (guides, springs) = (with(Role::Guides), with(Role::Spring));
        let guarded = |kind: GuardKind| {
            (0..elements.len())
                .filter(|&i| elements[i].guard_kind() == Some(kind))
                .collect()
        };
        let (touching, cornered) = (guarded(GuardKind::Touch), guarded(GuardKind::Corner));
        let is_rope = |i: &usize| matches!(elements[*i], ForceElement::Rope(_));
        let ropes = (0..elements.len()).filter(is_rope).collect();
        let probes = find_probes(&mechanics, &elements);
        let traits = find_traits(&mechanics, &elements);
        let fixed = elements
            .iter()
            .map(|element| Fixed::of(&**element))
            .collect();
        let follows_motion = find_moved_rails(&mechanics);
        let mut by_height = Candidates::all(elements.len());
        by_height.choose(|i| elements[i].uses_height());
        let first_wheel = elements
            .iter()
            .map(|element| first_wheel(&mechanics, element))
            .collect();
        let row_spans = (0..elements.len())
            .map(|i| row_span(&mechanics, &elements, &probes, i))
            .collect();
        Ok(System {
            scene,
            foundations,
            mechanics,
            all: Candidates::all(elements.len()),
            by_height,
            elements,
            fixed,
            follows_motion,
            first_wheel,
            row_spans,
            probes,
            traits,
            guides,
            springs,
            ropes,
            touching,
            cornered,
        })
    }

    /// Number of vertical contacts, which are the first elements.
    pub fn verticals(&self) -> usize {
        self.mechanics.groups.len()
    }

    /// Vertical contact `i`.
    pub fn vertical(&self, i: usize) -> &Vertical<'a> {
        match &self.elements[i] {
            ForceElement::Vertical(vertical) => vertical,
            _ => unreachable!("vertical contacts are the first elements"),
        }
    }

    /// Normal law of one wheel of vertical contact `i`.
    pub fn law(&self, i: usize) -> &'a NormalLaw {
        &self.scene.wheels[self.mechanics.groups[i].kind].normal
    }

    /// Elements that guide wheels laterally.
    pub fn guides(&self) -> &[usize] {
        &self.guides
    }

    /// Springs between two points: ropes and stops.
    pub fn springs(&self) -> &[usize] {
        &self.springs
    }

    /// Elements whose guards are of the given kind.
    pub fn guarded(&self, kind: GuardKind) -> &[usize] {
        match kind {
            GuardKind::Touch => &self.touching,
            GuardKind::Corner => &self.cornered,
        }
    }

    /// Rope `index` of the scene with the index of its element.
    pub fn rope(&self, index: usize) -> Option<(usize, &RopeForce<'a>)> {
        let element = *self.ropes.get(index)?;
        match &self.elements[element] {
            ForceElement::Rope(rope) => Some((element, rope)),
            _ => None,
        }
    }

    /// Index in the scene of the stop whose element is `i`; `None` for other elements.
    pub fn stop(&self, i: usize) -> Option<usize> {
        match &self.elements[i] {
            ForceElement::Stop(stop) => Some(stop.index()),
            _ => None,
        }
    }

    /// Friction force below wheel `w` at `at`; zero where the wheel has no friction element.
    pub fn friction_of(&self, w: usize, at: &State) -> f64 {
        let is_own = |element: &ForceElement| match element {
            ForceElement::Traction(traction) => traction.wheel() == w,
            _ => false,
        };
        self.elements
            .iter()
            .position(is_own)
            .map_or(0.0, |i| at.force[i])
    }

    /// Speed along the rail of the wheels of vertical contact `i`.
    pub fn contact_speed(&self, i: usize, at: &State) -> f64 {
        self.mechanics
            .speed_along(self.mechanics.groups[i].wheels.start, at)
    }

    /// The state zero.
    pub fn state(&self) -> State {
        let slots = self.verticals() + self.probes.sliding.len();
        State::zeros(self.mechanics.dofs, slots, self.elements.len())
    }
}

/// The first wheel on which `element` acts.
fn first_wheel(mechanics: &Mechanics, element: &ForceElement) -> Option<usize> {
    element
        .channels(mechanics)
        .into_iter()
        .find_map(|(channel, _)| match channel {
            Channel::Vertical(wheel) | Channel::Lateral(wheel) | Channel::Traction(wheel) => {
                Some(wheel)
            }
            _ => None,
        })
}

/// Degrees of freedom from the first to the last on which the row of element `i` depends: those of its body, the
/// spins of the body's wheels, and those of the structures on which it has probes; a multiple of four of them where
/// there are as many, because products are formed four entries at a time.
fn row_span(
    mechanics: &Mechanics,
    elements: &[ForceElement],
    probes: &Probes,
    i: usize,
) -> Range<usize> {
    let Some(body) = elements[i].body(mechanics) else {
        return 0..mechanics.dofs;
    };
    let own = mechanics
        .kinematics
        .terms(body)
        .iter()
        .flatten()
        .map(|&(number, _)| number);
    let spins = mechanics
        .wheels
        .iter()
        .filter(|wheel| wheel.body == body)
        .filter_map(|wheel| wheel.spin);
    let on = |s: &usize| probes.entries[*s].iter().any(|entry| entry.element == i);
    let structures = (0..probes.entries.len())
        .filter(on)
        .flat_map(|s| mechanics.structures[s].clone());
    let numbers = own.chain(spins).chain(structures);
    let hull = |known: Option<Range<usize>>, number: usize| {
        let known = known.unwrap_or(number..number + 1);
        Some(known.start.min(number)..known.end.max(number + 1))
    };
    let Range { start, end } = numbers.fold(None, hull).unwrap_or(0..0);
    let fours = start + (end - start).next_multiple_of(4);
    start..if fours <= mechanics.dofs { fours } else { end }
}

/// Lists the probes of all elements.
fn find_probes(mechanics: &Mechanics, elements: &[ForceElement]) -> Probes {
    let of_elements: Vec<Vec<ElementProbe>> = elements
        .iter()
        .map(|element| element.probes(mechanics))
        .collect();
    let slides = mechanics.has_sliding_rails();
    let sliding: Vec<usize> = (0..elements.len())
        .filter(|&i| slides && elements[i].is_tangential())
        .collect();
    let verticals = mechanics.groups.len();
    let slot = |i: usize| {
        let place = || {
            sliding
                .iter()
                .position(|&element| element == i)
                .map(|k| verticals + k)
        };
        if i < verticals { Some(i) } else { place() }
    };
    let slots = (0..elements.len()).map(slot).collect();
    let contact_of = |wheel: usize| mechanics.wheels[wheel].contact;
    let structure_of = |wheel: usize| mechanics.scene.contacts[contact_of(wheel)].structure;
    // Wheels of one contact have the same motion along the rail, so one tangential contact represents them.
    let mut tangential: Vec<TangentialContact> = Vec::new();
    let find = |all: &[TangentialContact], element: usize, wheel: usize| {
        let same = |known: &TangentialContact| {
            known.element == element && contact_of(known.wheel) == contact_of(wheel)
        };
        all.iter().position(same)
    };
    for (element, probes) in of_elements.iter().enumerate() {
        for &ElementProbe { wheel, axis, .. } in probes {
            let is_dragged = mechanics.foundations[structure_of(wheel)].is_loaded_along;
            if axis == Axis::Longitudinal
                && is_dragged
                && find(&tangential, element, wheel).is_none()
            {
                tangential.push(TangentialContact { element, wheel });
            }
        }
    }
    let entries_of = |s: usize| {
        let foundation = &mechanics.foundations[s];
        let mut entries = Vec::new();
        for (element, probes) in of_elements.iter().enumerate() {
            for &ElementProbe {
                wheel,
                weight,
                axis,
                part,
            } in probes
            {
                let complies = match axis {
                    Axis::Vertical => true,
                    Axis::Lateral => foundation.parts.is_none(),
                    Axis::Longitudinal => foundation.is_loaded_along,
                };
                if structure_of(wheel) != s || !complies {
                    continue;
                }
                let rail = mechanics.scene.contacts[contact_of(wheel)].rail;
                let rail = match (&foundation.parts, part) {
                    (Some(chains), Some(part)) => chains[rail].rail(part),
                    _ => rail,
                };
                let own = if axis == Axis::Longitudinal {
                    find(&tangential, element, wheel)
                } else {
                    None
                };
                let probe = Probe { rail, x: 0.0, axis };
                entries.push(Entry {
                    element,
                    weight,
                    wheel,
                    probe,
                    tangential: own,
                });
            }
        }
        entries
    };
    let entries: Vec<Vec<Entry>> = (0..mechanics.foundations.len()).map(entries_of).collect();
    let is_direct = |entries: &Vec<Entry>| {
        entries.len() == elements.len()
            && entries
                .iter()
                .enumerate()
                .all(|(i, entry)| entry.element == i && entry.weight == -1.0)
    };
    let is_direct = entries.iter().map(is_direct).collect();
    let states = (0..elements.len()).filter(|&i| slot(i).is_some()).collect();
    Probes {
        entries,
        is_direct,
        tangential,
        slots,
        sliding,
        states,
    }
}

/// Whether the rail below each vertical contact has no compliance of its own, and is neither carried nor divided into
/// parts.
fn find_moved_rails(mechanics: &Mechanics) -> Vec<bool> {
    let is_grounded = mechanics.carried.is_empty() && mechanics.couplings.is_empty();
    let follows = |contact: usize| {
        let own = &mechanics.foundations[mechanics.scene.contacts[contact].structure];
        is_grounded && own.compliance.is_none() && own.parts.is_none() && own.carrier.is_none()
    };
    mechanics
        .groups
        .iter()
        .map(|group| follows(group.contact))
        .collect()
}

/// Determines which simplifications apply.
fn find_traits(mechanics: &Mechanics, elements: &[ForceElement]) -> Traits {
    let is_uneven = (0..mechanics.wheels.len()).any(|w| mechanics.irregularity(w).is_some());
    let is_vertical = elements.len() == mechanics.groups.len();
    let has_constant_rows = !mechanics.moves_freely
        && !is_uneven
        && is_vertical
        && mechanics
            .foundations
            .iter()
            .all(|foundation| foundation.structure.is_none());
    let scene = mechanics.scene;
    let laws = || {
        scene
            .contacts
            .iter()
            .map(|contact| &scene.wheels[contact.wheel].normal)
    };
    let ratio = |law: &NormalLaw| law.damping / law.stiffness;
    let grounded = laws().find(|law| !law.has_memory());
    let mut compliances = mechanics
        .foundations
        .iter()
        .filter_map(|f| f.compliance.as_ref());
    let has_symmetric_rails = compliances.all(|compliance| compliance.is_symmetric());
    let is_symmetric = !mechanics.moves_freely
        && has_symmetric_rails
        && grounded.is_none_or(|first| {
            laws().all(|law| {
                if law.has_memory() {
                    ratio(first) == 0.0
                } else {
                    ratio(law) == ratio(first)
                }
            })
        });
    let has_linear_laws = laws().all(NormalLaw::is_linear);
    let uses_heights = elements.iter().any(|element| element.uses_height());
    let follows_motion = mechanics.moves_freely
        || !mechanics.carried.is_empty()
        || elements.iter().any(|element| element.follows_motion());
    Traits {
        is_uneven,
        has_constant_rows,
        has_parts: mechanics
            .foundations
            .iter()
            .any(|foundation| foundation.parts.is_some()),
        has_motions: scene.bodies.iter().any(|body| body.motion.is_some()),
        is_vertical,
        has_linear_laws,
        has_memory: laws().any(NormalLaw::has_memory),
        uses_heights,
        follows_motion,
        has_symmetric_rails,
        is_symmetric,
    }
}
