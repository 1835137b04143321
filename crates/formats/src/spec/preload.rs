//! The preload of a spec: forces under which the structure is at rest, and about whose state everything is computed.

use std::sync::{Arc, Mutex, PoisonError};

use fea::{MemberKind, Model, Preload, PreloadedState, Rail, RailForce, Taper};

use super::raw::{RawPreload, RawPreloadLoad, RawSpec};
use super::references::Points;
use crate::check::Check;
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::{Dimension, STANDARD_GRAVITY, Scale, Units};

/// Share of the bending stiffness of a member by which the mean of an axial force that varies by its weight may err.
const WEIGHT_ERROR: f64 = 1e-3;
/// By which part of w L^3/EI the mean of one part errs, w being the weight along the member per length.
const MEAN_ERROR: f64 = 0.05;
/// Most parts into which a member is cut for its own weight.
const MOST_PARTS: f64 = 16.0;
/// Difference of coordinates, relative to the length of the girder, that counts as none.
const ROUNDING: f64 = 1e-9;

/// Forces under which a structure is at rest, in the units of the spec.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecPreload {
    /// Whether everything that has mass weighs.
    pub weight: bool,
    /// Acceleration of gravity, a magnitude.
    pub gravity: f64,
    /// Forces on points, global.
    pub loads: Vec<(usize, [f64; 3])>,
    /// Forces of wheels at rest, in a scene that asks for them.
    pub wheels: Vec<RailForce>,
    solved: SolvedState,
}

/// The last solved state of a preload: many ask for it, one solves it. Copies share it.
#[derive(Clone, Debug, Default)]
struct SolvedState(Arc<Mutex<Option<Known>>>);

/// Model and preload that were solved, and their state.
#[derive(Debug)]
struct Known {
    model: Model,
    preload: Preload,
    state: Result<Arc<PreloadedState>, fea::Error>,
}

/// What is kept of earlier answers makes no difference.
impl PartialEq for SolvedState {
    fn eq(&self, _: &SolvedState) -> bool {
        true
    }
}

impl SpecPreload {
    /// A preload of wheels alone.
    #[must_use]
    pub fn of_wheels(gravity: f64) -> SpecPreload {
        SpecPreload {
            weight: false,
            gravity,
            loads: Vec::new(),
            wheels: Vec::new(),
            solved: SolvedState::default(),
        }
    }

    /// The weight and the given loads, without wheels, on a model whose upward direction is `up`.
    #[must_use]
    pub fn without_wheels(&self, up: [f64; 3]) -> Preload {
        Preload {
            rails: Vec::new(),
            ..self.forces(up)
        }
    }

    /// The preload on a model whose upward direction is `up`.
    fn forces(&self, up: [f64; 3]) -> Preload {
        Preload {
            points: self.loads.clone(),
            rails: self.wheels.clone(),
            ..Preload::weight(up, if self.weight { self.gravity } else { 0.0 })
        }
    }

    /// The state of `model` under the preload.
    ///
    /// # Errors
    /// As [`fea::preloaded`].
    pub(super) fn state(
        &self,
        model: &Model,
        rails: &[Rail],
    ) -> Result<Arc<PreloadedState>, fea::Error> {
        let preload = self.forces(model.up);
        let mut known = self.solved.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known
            .as_ref()
            .filter(|known| known.model == *model && known.preload == preload)
        {
            return known.state.clone();
        }
        let state = fea::preloaded(model, rails, &preload).map(Arc::new);
        *known = Some(Known {
            model: model.clone(),
            preload,
            state: state.clone(),
        });
        state
    }
}

/// Reads the member `preload`. `girder` has the coordinates of the points of the short form; `points` are those of the
/// general form.
pub(super) fn read(
    raw: &RawSpec,
    root: &Place<'_>,
    girder: Option<&[f64]>,
    points: &Points<'_>,
    has_mass: bool,
    check: &mut Check<'_>,
) -> Option<SpecPreload> {
    let given: &RawPreload = raw.preload.as_ref()?;
    let at = root.key("preload");
    let weight = given.weight.unwrap_or(false);
    let gravity = match given.gravity {
        Some(gravity) => check.not_negative(
            gravity,
            &at.key("gravity"),
            Dimension::ACCELERATION,
            "a magnitude: it always acts downwards",
        ),
        None => {
            STANDARD_GRAVITY
                * Scale {
                    from: Units::SI,
                    to: check.scale.to,
                }
                .factor(Dimension::LENGTH)
        }
    };
    let list = at.key("loads");
    let mut loads = Vec::new();
    for (index, load) in given.loads.iter().flatten().enumerate() {
        let here = list.index(index);
        let point = match girder {
            Some(places) => point_of_girder(load, places, &here, check),
            None => point_of_frame(load, points, &here, check),
        };
        let force = check.faults.require(&load.force, &here, "force").copied();
        let force = force.map(|force| check.vector(force, &here.key("force"), Dimension::FORCE));
        loads.extend(point.zip(force));
    }
    if given.loads.as_ref().is_none_or(Vec::is_empty) && !(weight && has_mass) {
        let fault = if weight {
            Fault::new(&at, "needs `loads` or a structure with mass")
                .hint("the weight follows from densities, masses per length and `masses`")
        } else {
            Fault::new(&at, "must have `weight` or `loads`").of_value()
        };
        check.faults.add(fault);
    }
    Some(SpecPreload {
        weight,
        gravity,
        loads,
        wheels: Vec::new(),
        solved: SolvedState::default(),
    })
}

fn point_of_frame(
    load: &RawPreloadLoad,
    points: &Points<'_>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    if load.x.is_some() {
        let fault = Fault::new(&at.key("x"), "`x` is a key of the short form").at_key();
        check
            .faults
            .add(fault.hint("in the general form a load has a `point`"));
    }
    points.one(&load.point, "point", at, check)
}

fn point_of_girder(
    load: &RawPreloadLoad,
    places: &[f64],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    if load.point.is_some() {
        let fault = Fault::new(&at.key("point"), "`point` is a key of the general form").at_key();
        check.faults.add(
            fault.hint("in the short form a load has the coordinate `x` of a support or an end"),
        );
    }
    let x = *check.faults.require(&load.x, at, "x")?;
    let place = at.key("x");
    let own = check.number(x, &place, Dimension::LENGTH);
    let length = places.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let found = places
        .iter()
        .position(|known| (known - own).abs() <= ROUNDING * length);
    if found.is_none() && !places.is_empty() {
        let fault = Fault::new(&place, "must be a support or an end of the girder").got(number(x));
        check.faults.add(
            fault.hint("for a force at another position, use the general form with a point there"),
        );
    }
    found
}

/// The tapers of the members with those added that are cut because their weight makes their axial force vary: into as many
/// parts as keep the error of the mean forces, which falls with the square of their number, below a thousandth of the
/// bending stiffness.
pub(super) fn cut_for_weight(
    model: &Model,
    tapers: &[Option<Taper>],
    preload: &SpecPreload,
) -> Vec<Option<Taper>> {
    let size = model.up.iter().map(|a| a * a).sum::<f64>().sqrt();
    if !preload.weight || size == 0.0 {
        return tapers.to_vec();
    }
    let cut = |(index, taper): (usize, &Option<Taper>)| {
        let member = &model.members[index];
        if taper.is_some() || member.kind != MemberKind::Beam {
            return *taper;
        }
        let section = &model.sections[member.section];
        let end =
            |end: usize, k: usize| model.points[member.points[end]][k] + member.offsets[end][k];
        let along: [f64; 3] = std::array::from_fn(|k| end(1, k) - end(0, k));
        let length = along.iter().map(|a| a * a).sum::<f64>().sqrt();
        let rise = along
            .iter()
            .zip(model.up)
            .map(|(a, up)| a * up)
            .sum::<f64>()
            .abs()
            / size;
        let second = [section.iy, section.iz]
            .into_iter()
            .filter(|i| *i > 0.0)
            .fold(f64::INFINITY, f64::min);
        // The weight along the member is that of its rise.
        let varying =
            section.mass * preload.gravity * rise * length * length / (section.e * second);
        let parts = (MEAN_ERROR * varying / WEIGHT_ERROR)
            .sqrt()
            .ceil()
            .min(MOST_PARTS);
        (parts > 1.0).then_some(Taper {
            section: member.section,
            parts: parts as usize,
        })
    };
    tapers.iter().enumerate().map(cut).collect()
}
