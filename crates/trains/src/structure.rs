//! A structure prepared for envelopes: its rails, the members that carry them, and its influence lines.

use std::sync::OnceLock;

use fea::{Effect, FactoredFrame, ForceComponent, Model, Rail, Weight};
use nalgebra::Vector3;
use splines::{Axis, BeamColumn, ExactSurface, InfluenceLines, Probe, RailElement};

use crate::bent::{Bent, BentPlane};
use crate::error::Error;
use crate::line::{LineCell, Lines, Stretch, cubics};
use crate::train::{COMPONENTS, axis};

/// Error of the cubics along members under axial force, relative to the largest ordinate, that is negligible.
const BENT_ERROR: f64 = 1e-9;
/// Most parts into which one member is split for it.
const MOST_BENT_PARTS: f64 = 400.0;
/// Largest second derivative of an influence line or a deflection along a member, relative to its largest ordinate over the
/// square of the length: 48 of a member with both ends clamped under a load in the middle, rounded.
const MOST_BEND: f64 = 50.0;
/// A cubic through four nodes of Chebyshev on a part of length h errs by at most h^4 over this number times the fourth
/// derivative.
const CHEBYSHEV: f64 = 3072.0;

/// Fractions of a member that count as rounding.
const ROUNDING: f64 = 1e-12;

/// Number of quantities of a section: [`GirderResponse::ALL`].
pub(crate) const QUANTITIES: usize = 6;

/// The deflections, downwards and along +z.
pub(crate) const DEFLECTIONS: [GirderResponse; 2] = [
    GirderResponse::VerticalDeflection,
    GirderResponse::LateralDeflection,
];

/// An internal force of a member that carries a rail, or the deflection of the rail.
///
/// The vertical plane is that of the member's axis and up; in the lateral plane +z of the rail takes the place of down.
/// A moment is positive where it sags, shear is the derivative of the moment along the rail, a normal force is positive
/// in tension, torsion right-handed about the rail's x on the face that looks along +x. Deflections are positive
/// downwards and along +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum GirderResponse {
    /// Normal force.
    Normal,
    /// Torsional moment.
    Torsion,
    /// Shear force in the vertical plane.
    VerticalShear,
    /// Shear force in the lateral plane.
    LateralShear,
    /// Moment in the vertical plane.
    VerticalMoment,
    /// Moment in the lateral plane.
    LateralMoment,
    /// Deflection of the rail downwards.
    VerticalDeflection,
    /// Deflection of the rail along +z.
    LateralDeflection,
}

impl GirderResponse {
    /// All of them: six internal forces and two deflections.
    pub const ALL: [GirderResponse; QUANTITIES + 2] = [
        GirderResponse::Normal,
        GirderResponse::Torsion,
        GirderResponse::VerticalShear,
        GirderResponse::LateralShear,
        GirderResponse::VerticalMoment,
        GirderResponse::LateralMoment,
        GirderResponse::VerticalDeflection,
        GirderResponse::LateralDeflection,
    ];

    /// Moment, shear and deflection of the plane of a quantity; of the vertical plane for normal force and torsion.
    pub(crate) const fn coincident(self) -> [GirderResponse; 3] {
        match self {
            GirderResponse::LateralShear
            | GirderResponse::LateralMoment
            | GirderResponse::LateralDeflection => [
                GirderResponse::LateralMoment,
                GirderResponse::LateralShear,
                GirderResponse::LateralDeflection,
            ],
            _ => [
                GirderResponse::VerticalMoment,
                GirderResponse::VerticalShear,
                GirderResponse::VerticalDeflection,
            ],
        }
    }

    /// The shear force whose integral along the rail the moment is.
    pub(crate) const fn slope(self) -> Option<usize> {
        match self {
            GirderResponse::VerticalMoment => Some(GirderResponse::VerticalShear as usize),
            GirderResponse::LateralMoment => Some(GirderResponse::LateralShear as usize),
            _ => None,
        }
    }
}

/// A member under a rail, or a part of one under axial force, described along the rail.
#[derive(Clone, Debug)]
pub(crate) struct Carrier {
    /// Index of the rail.
    pub rail: usize,
    /// Index of its rail element.
    pub element: usize,
    /// Number of its stretch of rail.
    pub stretch: usize,
    /// Index of the member.
    pub member: usize,
    /// Coordinates of its ends.
    pub x: [f64; 2],
    /// Its length.
    pub length: f64,
    /// Place of its first end on the whole member, counted along the rail, and the length of the whole.
    pub start: f64,
    pub whole: f64,
    /// What the axial force does to moments; `None` without.
    pub bent: Option<Box<Bent>>,
    /// Whether its own local x runs against the rail.
    pub reversed: bool,
    /// Along the member in the direction of the rail, normal to it in the plane of up, and t cross u; global.
    pub triad: [Vector3<f64>; 3],
    /// Its local axes, global.
    pub local: [Vector3<f64>; 3],
}

impl Carrier {
    /// Distance along the member from its end at the smaller coordinate.
    pub fn place(&self, x: f64) -> f64 {
        ((x - self.x[0]) * self.rate()).clamp(0.0, self.length)
    }

    /// Rail coordinate of a place.
    pub fn coordinate(&self, s: f64) -> f64 {
        if s >= self.length {
            self.x[1]
        } else {
            self.x[0] + s / self.rate()
        }
    }

    /// The whole member, if this is its first part.
    pub fn whole_from_first(&self) -> Option<Carrier> {
        let is_whole = self.length == self.whole;
        let x = if is_whole {
            self.x
        } else {
            [self.x[0], self.x[0] + self.whole / self.rate()]
        };
        (self.start == 0.0).then(|| Carrier {
            x,
            length: self.whole,
            ..self.clone()
        })
    }

    /// The fraction of the whole member, in the direction of its own local x, at a place.
    pub fn fraction(&self, s: f64) -> f64 {
        let along = if self.start == 0.0 {
            s / self.whole
        } else {
            (self.start + s) / self.whole
        };
        if self.reversed { 1.0 - along } else { along }
    }

    /// Rail coordinate at a fraction of the whole member in the direction of its own local x; also beyond the ends of this
    /// part.
    fn coordinate_at_fraction(&self, fraction: f64) -> f64 {
        let along = if self.reversed {
            1.0 - fraction
        } else {
            fraction
        };
        self.coordinate_on_whole(along * self.whole)
    }

    /// Rail coordinate at a place of the whole member, counted along the rail; also beyond the ends of this part.
    fn coordinate_on_whole(&self, s: f64) -> f64 {
        let own = s - self.start;
        // beyond this part, for which the end would be taken
        if own > self.length {
            self.x[0] + own / self.rate()
        } else {
            self.coordinate(own)
        }
    }

    /// Length of the member per length of rail.
    pub fn rate(&self) -> f64 {
        self.length / (self.x[1] - self.x[0])
    }

    /// By how much the quantities of a section change where a load (force and couple, global) has been passed, without axial
    /// force.
    pub fn jump(&self, force: &Vector3<f64>, couple: &Vector3<f64>) -> [f64; QUANTITIES] {
        let [t, u, z] = &self.triad;
        let mut out = [0.0; QUANTITIES];
        out[GirderResponse::Normal as usize] = -force.dot(t);
        out[GirderResponse::Torsion as usize] = -couple.dot(t);
        out[GirderResponse::VerticalShear as usize] = force.dot(u);
        out[GirderResponse::LateralShear as usize] = -force.dot(z);
        out[GirderResponse::VerticalMoment as usize] = -couple.dot(z);
        out[GirderResponse::LateralMoment as usize] = -couple.dot(u);
        out
    }

    /// By how much a load changes the quantities where it has been passed, under the axial force of the member.
    pub fn jump_of_load(&self, force: &Vector3<f64>, couple: &Vector3<f64>) -> [f64; QUANTITIES] {
        let given = self.jump(force, couple);
        self.bent.as_ref().map_or(given, |bent| bent.jump(given))
    }

    /// The quantities by the six components of the internal force of the member in its own axes, as the structural
    /// solver gives them for the face that looks along its local x.
    pub fn quantities(&self, own: [f64; 6]) -> [f64; QUANTITIES] {
        let vector =
            |k: usize| -> Vector3<f64> { (0..3).map(|i| self.local[i] * own[k + i]).sum() };
        // The part before the section feels minus jump: the force on its face balances what it carries.
        let sign = if self.reversed { 1.0 } else { -1.0 };
        self.jump(&(sign * vector(0)), &(sign * vector(3)))
    }

    /// The six components of the internal force in the axes of the member, by the quantities.
    fn components(&self, quantities: [f64; QUANTITIES]) -> [f64; 6] {
        let [normal, torsion, vertical, lateral, sagging, sideways] = quantities;
        let [t, u, z] = &self.triad;
        let sign = if self.reversed { 1.0 } else { -1.0 };
        let force = (u * vertical - t * normal - z * lateral) * sign;
        let couple = (t * torsion + z * sagging + u * sideways) * -sign;
        std::array::from_fn(|k| {
            if k < 3 {
                self.local[k].dot(&force)
            } else {
                self.local[k - 3].dot(&couple)
            }
        })
    }
}

/// A rail element on the member of a carrier: where loads on it stand on the member.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnMember<'s> {
    /// The rail element as a carrier.
    pub other: &'s Carrier,
    pub stretch: &'s Stretch,
    /// Place along the carrier at the first coordinate of the element, and its change by the coordinate.
    pub start: f64,
    pub rate: f64,
}

/// An end of a stretch of rail that is the place of a section: a load there is beyond the section, or on the other side of it,
/// which no other position on the stretch has.
#[derive(Clone, Debug)]
pub(crate) struct Tip {
    pub rail: usize,
    pub x: f64,
    /// Whether it is the first (0) or the last (1) end of the stretch.
    pub end: usize,
    /// What the effect of each component of a unit load changes by where the load is on the other side.
    pub change: [f64; COMPONENTS],
}

/// A rail with the frame of its coordinates.
#[derive(Clone, Debug)]
pub(crate) struct RailFrame {
    /// Global directions of x, y and z.
    pub axes: [Vector3<f64>; 3],
    pub origin: Vector3<f64>,
    /// First and last coordinate.
    pub range: [f64; 2],
    /// Rail elements by increasing coordinate.
    pub stretches: Vec<Stretch>,
    /// Whether the structure resists forces along x, y and z.
    pub resists: [bool; 3],
}

/// A structure solved once, of which any influence line can be asked.
///
/// # Example
/// ```
/// use fea::Girder;
/// use trains::Structure;
///
/// let girder = Girder { spans: vec![8.0, 8.0], e: 2.1e8, i_vertical: 5e-4, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let structure = Structure::new(&model, &[rail], false)?;
/// assert_eq!(structure.range(0), [0.0, 16.0]);
/// # Ok::<(), trains::Error>(())
/// ```
#[derive(Debug)]
pub struct Structure {
    pub(crate) model: Model,
    pub(crate) frame: FactoredFrame,
    pub(crate) rails: Vec<RailFrame>,
    pub(crate) carriers: Vec<Carrier>,
    /// Whether every rail has a twin at a distance of one length unit along +z, rail number + number of rails.
    twins: bool,
    surface: OnceLock<Result<ExactSurface, fea::Error>>,
    unit_weight: OnceLock<Weight>,
}

impl Structure {
    /// Solves a model with its rails. `eccentric` asks for influence lines of loads beside the rails.
    ///
    /// # Errors
    /// A model or a rail that cannot be used, or a structure that can move without strain.
    pub fn new(model: &Model, rails: &[Rail], eccentric: bool) -> Result<Structure, Error> {
        let own: Vec<Rail> = rails
            .iter()
            .map(|rail| Rail {
                stations: Vec::new(),
                ..rail.clone()
            })
            .collect();
        let up = Vector3::from(model.up);
        let mut all = own.clone();
        if eccentric {
            all.extend(own.iter().map(|rail| beside(rail, &up)));
        }
        let frame = FactoredFrame::new(model, &all)?;
        let mut frames: Vec<RailFrame> = rails
            .iter()
            .enumerate()
            .map(|(index, rail)| rail_frame(index, rail, &up, &frame))
            .collect::<Result<_, _>>()?;
        let all = frames.iter_mut().flat_map(|rail| &mut rail.stretches);
        all.enumerate()
            .for_each(|(number, stretch)| stretch.number = number);
        let mut carriers = Vec::new();
        for stretch in frames.iter().flat_map(|rail| &rail.stretches) {
            let element = &frame.line()?.elements()[stretch.element];
            let Some(member) = element
                .member
                .filter(|_| element.ends[0] != element.ends[1])
            else {
                continue;
            };
            let axes = &frames[stretch.rail].axes;
            let global = |v: [f64; 3]| axes[0] * v[0] + axes[1] * v[1] + axes[2] * v[2];
            let t = global(element.frame[0]);
            let across = up - t * t.dot(&up);
            let u = if across.norm() > 1e-9 * up.norm() {
                across.normalize()
            } else {
                global(element.frame[1])
            };
            let triad = [t, u, t.cross(&u)];
            let local = element.member_axes().map(global);
            let [start, length] = if stretch.is_whole() {
                [0.0, element.length]
            } else {
                let rate = element.length / (element.x[1] - element.x[0]);
                [
                    (stretch.x[0] - element.x[0]) * rate,
                    (stretch.x[1] - stretch.x[0]) * rate,
                ]
            };
            carriers.push(Carrier {
                rail: stretch.rail,
                element: stretch.element,
                stretch: stretch.number,
                member: member.id,
                x: stretch.x,
                length,
                start,
                whole: element.length,
                bent: bent(element, &triad, &local, length),
                reversed: element.is_reversed(),
                triad,
                local,
            });
        }
        Ok(Structure {
            model: model.clone(),
            frame,
            rails: frames,
            carriers,
            twins: eccentric,
            surface: OnceLock::new(),
            unit_weight: OnceLock::new(),
        })
    }

    /// Number of rails.
    #[must_use]
    pub fn rail_count(&self) -> usize {
        self.rails.len()
    }

    /// Error of influence lines, moments and deflections along members under axial force, relative to the largest ordinate:
    /// 2 u^2 (50 + u^2)/(3072 m^4) for a member in m parts with u^2 = (lambda L)^2. Zero without axial forces.
    ///
    /// # Errors
    /// None that a structure without rails has not given before.
    pub fn error_of_lines(&self) -> Result<f64, Error> {
        let elements = self.frame.line()?.elements();
        let of = |element: &RailElement| {
            let count = bent_parts(element);
            if count == 0 {
                0.0
            } else {
                bent_error(bend_square(element), count as f64)
            }
        };
        Ok(elements.iter().map(of).fold(0.0, f64::max))
    }

    /// The structural solver with the factored stiffness.
    #[must_use]
    pub fn frame(&self) -> &FactoredFrame {
        &self.frame
    }

    /// First and last coordinate of a rail.
    #[must_use]
    pub fn range(&self, rail: usize) -> [f64; 2] {
        self.rails[rail].range
    }

    /// Coordinates at which members that carry the rail begin or end, increasing.
    #[must_use]
    pub fn member_ends(&self, rail: usize) -> Vec<f64> {
        let stretches = self.rails[rail].stretches.iter();
        let carried = stretches.filter(|own| self.carriers.iter().any(|c| c.stretch == own.number));
        let mut all: Vec<f64> = carried.flat_map(Stretch::ends_of_element).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|b, a| *b - *a <= self.slack());
        all
    }

    /// Differences of coordinates that count as rounding.
    pub(crate) fn slack(&self) -> f64 {
        let ends = self.rails.iter().flat_map(|rail| rail.range);
        1e-12 * ends.fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// Rail coordinate of the place on each rail that is opposite to coordinate 0 of `first`.
    pub(crate) fn shifts(&self, first: usize) -> Vec<f64> {
        let origin = self.rails[first].origin;
        self.rails
            .iter()
            .map(|rail| (origin - rail.origin).dot(&rail.axes[0]))
            .collect()
    }

    /// The rail elements on the member of a carrier, its own included.
    pub(crate) fn on_member<'s>(
        &'s self,
        carrier: &'s Carrier,
    ) -> impl Iterator<Item = OnMember<'s>> + 's {
        let others = self
            .carriers
            .iter()
            .filter(|other| other.member == carrier.member);
        others.filter_map(|other| {
            let same = other.reversed == carrier.reversed;
            let first = if same {
                other.start
            } else {
                other.whole - other.start - other.length
            };
            let middle = first + 0.5 * other.length - carrier.start;
            if middle < 0.0 || middle > carrier.length {
                return None;
            }
            Some(OnMember {
                other,
                stretch: self.stretch(other),
                start: if same {
                    other.start
                } else {
                    other.whole - other.start
                } - carrier.start,
                rate: if same { other.rate() } else { -other.rate() },
            })
        })
    }

    /// Whether the structure resists a component of load on a rail.
    pub(crate) fn resists(&self, rail: usize, component: usize) -> bool {
        (component < 3 || self.twins) && self.rails[rail].resists[axis(component).component()]
    }

    /// Force and couple about the axis of a carrier per unit of a component of load at a rail of its member, global.
    pub(crate) fn load(
        &self,
        stretch: &Stretch,
        component: usize,
    ) -> Result<[Vector3<f64>; 2], Error> {
        let axes = &self.rails[stretch.rail].axes;
        let element = &self.frame.line()?.elements()[stretch.element];
        let offset =
            axes[0] * element.offset[0] + axes[1] * element.offset[1] + axes[2] * element.offset[2];
        let zero = Vector3::zeros();
        Ok(match component {
            3 => [zero, axes[2].cross(&axes[0])],
            4 => [zero, axes[2].cross(&axes[1])],
            k => [axes[k], offset.cross(&axes[k])],
        })
    }

    /// The forces of a unit acceleration upwards.
    pub(crate) fn unit_weight(&self) -> &Weight {
        let up = Vector3::from(self.model.up).normalize();
        self.unit_weight
            .get_or_init(|| self.frame.weight(&self.model, up.into()))
    }

    /// The exact influence surface of the rails and their twins.
    pub(crate) fn surface(&self) -> Result<&ExactSurface, Error> {
        let made = self
            .surface
            .get_or_init(|| self.frame.surface().map(|certified| certified.surface));
        made.as_ref().map_err(|error| Error::Frame(error.clone()))
    }

    /// Influence lines from a function that writes `groups` times N responses at a probe. A cell is split at the
    /// coordinates that `split` gives for a stretch of rail. Components that are not `used` stay zero.
    pub(crate) fn lines<const N: usize>(
        &self,
        used: [bool; COMPONENTS],
        groups: usize,
        split: impl Fn(&Stretch) -> Vec<f64>,
        mut value: impl FnMut(Probe, &mut [f64]) -> Result<(), splines::Error>,
    ) -> Result<Vec<Lines<N>>, Error> {
        let mut out = vec![
            Lines {
                rails: vec![Vec::new(); self.rails.len()]
            };
            groups
        ];
        let mut twin = vec![0.0; groups * N];
        for (index, rail) in self.rails.iter().enumerate() {
            let components: Vec<usize> = (0..COMPONENTS)
                .filter(|&k| used[k] && self.resists(index, k))
                .collect();
            for stretch in &rail.stretches {
                for x in parts(stretch.x, split(stretch), self.slack()) {
                    let empty = LineCell {
                        x,
                        stretch: Some(stretch.number),
                        begins_inside: stretch.inner[0] && x[0] == stretch.x[0],
                        cubics: [[[0.0; 4]; N]; COMPONENTS],
                    };
                    out.iter_mut()
                        .for_each(|lines| lines.rails[index].push(empty.clone()));
                    for &component in &components {
                        let found = cubics(x, groups * N, |x, out| {
                            let probe = Probe {
                                rail: index,
                                x,
                                axis: axis(component),
                            };
                            value(probe, out)?;
                            if component >= 3 {
                                value(
                                    Probe {
                                        rail: index + self.rails.len(),
                                        ..probe
                                    },
                                    &mut twin,
                                )?;
                                out.iter_mut()
                                    .zip(&twin)
                                    .for_each(|(own, twin)| *own = twin - *own);
                            }
                            Ok::<(), splines::Error>(())
                        })?;
                        for (lines, all) in out.iter_mut().zip(found.chunks(N)) {
                            let cell = lines.rails[index].last_mut().expect("it was added above");
                            cell.cubics[component].copy_from_slice(all);
                        }
                    }
                }
            }
        }
        Ok(out)
    }

    /// Influence lines of the six quantities of a section just inside the first end of each of the carriers.
    pub(crate) fn end_lines(
        &self,
        carriers: &[Carrier],
        used: [bool; COMPONENTS],
    ) -> Result<Vec<Lines<QUANTITIES>>, Error> {
        let effects: Vec<Effect> = carriers.iter().flat_map(end_effects).collect();
        let lines = self.frame.influence_lines(&self.model, &effects)?;
        let mut all = self.lines(
            used,
            carriers.len(),
            |_| Vec::new(),
            |probe, out| lines.fill(probe, out),
        )?;
        for (carrier, lines) in carriers.iter().zip(&mut all) {
            let cells = lines.rails.iter_mut().flatten();
            for component in cells.flat_map(|cell| &mut cell.cubics) {
                let own: [[f64; 4]; QUANTITIES] = *component;
                for p in 0..4 {
                    let moved = carrier.quantities(own.map(|cubic| cubic[p]));
                    component
                        .iter_mut()
                        .zip(moved)
                        .for_each(|(cubic, value)| cubic[p] = value);
                }
            }
        }
        Ok(all)
    }

    /// Influence lines of sums of effects, which may jump at the sections of internal forces; all of these are the same
    /// [`section_of`].
    pub(crate) fn effect_lines_of(
        &self,
        sums: &[Vec<Effect>],
        used: [bool; COMPONENTS],
    ) -> Result<Vec<Lines<1>>, Error> {
        if used == [false; COMPONENTS] {
            return self.lines(used, sums.len(), |_| Vec::new(), |_, _| Ok(()));
        }
        let lines: InfluenceLines = self.frame.influence_lines(&self.model, &sums.concat())?;
        let cut = sums.first().and_then(|sum| section_of(sum));
        let mut parts = vec![0.0; lines.len()];
        let split = |stretch: &Stretch| {
            let carrier = self.carriers.iter().find(|c| c.stretch == stretch.number);
            let here = carrier
                .zip(cut)
                .filter(|(carrier, (member, _))| carrier.member == *member);
            let place = here.map(|(carrier, (_, place))| carrier.coordinate_at_fraction(place));
            place.into_iter().collect()
        };
        let value = |probe: Probe, out: &mut [f64]| {
            lines.fill(probe, &mut parts)?;
            let mut rest = &parts[..];
            for (sum, out) in sums.iter().zip(out) {
                let (own, others) = rest.split_at(sum.len());
                (*out, rest) = (own.iter().sum(), others);
            }
            Ok(())
        };
        self.lines(used, sums.len(), split, value)
    }

    /// The rails, each with the coordinate, at which a wheel is at the section of a sum of effects.
    pub(crate) fn at_section(&self, effects: &[Effect]) -> Vec<(usize, f64)> {
        let Some((member, place)) = section_of(effects) else {
            return Vec::new();
        };
        let slack = self.slack();
        let own = self.carriers.iter().filter(|c| c.member == member);
        own.map(|carrier| (carrier, carrier.coordinate_at_fraction(place)))
            .filter(|(carrier, x)| carrier.x[0] - slack <= *x && *x <= carrier.x[1] + slack)
            .map(|(carrier, x)| (carrier.rail, x))
            .collect()
    }

    /// The ends of stretches of rail at which a load on the stretch can be on either side of a section of a sum of effects: at the
    /// end of a rail, or where the member of the section is hinged to the next.
    pub(crate) fn tips(&self, effects: &[Effect]) -> Result<Vec<Tip>, Error> {
        let mut out = Vec::new();
        for effect in effects {
            let Effect::InternalForce {
                member,
                place,
                component,
            } = *effect
            else {
                continue;
            };
            for carrier in self.carriers.iter().filter(|c| c.member == member) {
                for (end, s) in [0.0, carrier.length].into_iter().enumerate() {
                    if (carrier.fraction(s) - place).abs() > ROUNDING {
                        continue;
                    }
                    let stretch = self.stretch(carrier);
                    let mut change = [0.0; COMPONENTS];
                    for (load, change) in change.iter_mut().enumerate() {
                        let [force, couple] = self.load(stretch, load)?;
                        let jump = carrier.components(carrier.jump_of_load(&force, &couple));
                        let passed = jump[component as usize];
                        *change = if end == 0 { passed } else { -passed };
                    }
                    out.push(Tip {
                        rail: carrier.rail,
                        x: carrier.x[end],
                        end,
                        change,
                    });
                }
            }
        }
        Ok(out)
    }

    /// The stretch of rail that a carrier carries.
    fn stretch(&self, carrier: &Carrier) -> &Stretch {
        let mut stretches = self.rails[carrier.rail].stretches.iter();
        let own = stretches.find(|stretch| stretch.number == carrier.stretch);
        own.expect("a carrier is made from a stretch of its rail")
    }

    /// Coordinates just within a stretch of rail between two others: where it meets the next one, the two need not move
    /// alike.
    pub(crate) fn just_within(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let slack = 2.0 * self.slack();
        [from + slack, to - slack]
    }

    /// Influence line of a sum of effects.
    pub(crate) fn effect_line(
        &self,
        effects: &[Effect],
        used: [bool; COMPONENTS],
    ) -> Result<Lines<1>, Error> {
        Ok(self.effect_lines_of(&[effects.to_vec()], used)?.remove(0))
    }

    /// Influence line of the deflection of a rail at x, downwards or along +z.
    pub(crate) fn deflection_line(
        &self,
        rail: usize,
        x: f64,
        quantity: GirderResponse,
        used: [bool; COMPONENTS],
    ) -> Result<Lines<1>, Error> {
        let surface = self.surface()?;
        let (axis, sign) = deflection_axis(quantity);
        let displacement = surface.displacement_lines(&[Probe { rail, x, axis }])?;
        let value = |probe: Probe, out: &mut [f64]| {
            displacement.fill(probe, out)?;
            out[0] *= sign;
            Ok(())
        };
        Ok(self
            .lines(used, 1, |stretch| self.opposite(rail, &[x], stretch), value)?
            .remove(0))
    }

    /// The coordinates on a stretch that are opposite to places of a rail on the same member.
    pub(crate) fn opposite(&self, rail: usize, places: &[f64], stretch: &Stretch) -> Vec<f64> {
        let Some(carrier) = self.carriers.iter().find(|c| c.stretch == stretch.number) else {
            return Vec::new();
        };
        let on = |x: f64| {
            let here = |c: &&Carrier| c.rail == rail && c.x[0] <= x && x <= c.x[1];
            self.carriers
                .iter()
                .find(here)
                .filter(|here| here.member == carrier.member)
        };
        let place = |&x: &f64| {
            let here = on(x)?;
            let s = here.start + here.place(x);
            Some(
                carrier.coordinate_on_whole(if here.reversed == carrier.reversed {
                    s
                } else {
                    carrier.whole - s
                }),
            )
        };
        places.iter().filter_map(place).collect()
    }
}

/// Axis of a deflection, and the sign with which it counts.
pub(crate) fn deflection_axis(quantity: GirderResponse) -> (Axis, f64) {
    if quantity == GirderResponse::LateralDeflection {
        (Axis::Lateral, 1.0)
    } else {
        (Axis::Vertical, -1.0)
    }
}

/// The section of the internal forces in a sum of effects: its member and place.
pub(crate) fn section_of(effects: &[Effect]) -> Option<(usize, f64)> {
    effects.iter().find_map(|effect| match *effect {
        Effect::InternalForce { member, place, .. } => Some((member, place)),
        Effect::Reaction(_) => None,
    })
}

/// The six components of the internal force just inside the end of a carrier at its smaller coordinate.
pub(crate) fn end_effects(carrier: &Carrier) -> [Effect; 6] {
    let place = carrier.fraction(0.0);
    ForceComponent::ALL.map(|component| Effect::InternalForce {
        member: carrier.member,
        place,
        component,
    })
}

/// The larger |lambda^2| L^2 of the planes of an element that an axial force bends; 0 where none does.
fn bend_square(element: &RailElement) -> f64 {
    if element.flexibility.tension == 0.0 || element.ends[0] == element.ends[1] {
        return 0.0;
    }
    planes_of(element)
        .map(f64::abs)
        .into_iter()
        .fold(0.0, f64::max)
        * element.length
        * element.length
}

/// lambda^2 of the planes in which `bending_z` and `bending_y` act.
fn planes_of(element: &RailElement) -> [f64; 2] {
    let f = &element.flexibility;
    [(f.bending_z, f.shear_y), (f.bending_y, f.shear_z)].map(|(bending, shear)| {
        if bending.is_finite() && shear.is_finite() {
            BeamColumn::new(bending, shear, f.tension, 1.0_f64).square()
        } else {
            0.0
        }
    })
}

/// What the cubics over m parts of a member with (lambda L)^2 err by: those of influence lines, whose fourth derivative is
/// lambda^2 times the second, and as much again for those of moments and deflections along a part.
fn bent_error(square: f64, parts: f64) -> f64 {
    2.0 * square * (MOST_BEND + square) / (CHEBYSHEV * parts.powi(4))
}

/// Number of parts in which an element is taken because an axial force bends the cubics along it; 0 without.
fn bent_parts(element: &RailElement) -> usize {
    let square = bend_square(element);
    if square == 0.0 {
        return 0;
    }
    (bent_error(square, 1.0) / BENT_ERROR)
        .powf(0.25)
        .ceil()
        .clamp(1.0, MOST_BENT_PARTS) as usize
}

/// What the axial force of an element does to moments along a part of it.
fn bent(
    element: &RailElement,
    triad: &[Vector3<f64>; 3],
    local: &[Vector3<f64>; 3],
    length: f64,
) -> Option<Box<Bent>> {
    if bend_square(element) == 0.0 {
        return None;
    }
    let [about_z, about_y] = planes_of(element);
    let [_, u, z] = triad;
    let f = &element.flexibility;
    let plane = |axis: &Vector3<f64>, square: f64, shear: f64| BentPlane {
        direction: [z.dot(axis), u.dot(axis)],
        square,
        stiffening: if square == 0.0 {
            1.0
        } else {
            1.0 + shear * f.tension
        },
    };
    let planes = [
        plane(&local[2], about_z, f.shear_y),
        plane(&local[1], about_y, f.shear_z),
    ];
    Some(Box::new(Bent::new(planes, length)))
}

/// The parts of a stretch between the places that are inside it.
fn parts(x: [f64; 2], mut split: Vec<f64>, slack: f64) -> Vec<[f64; 2]> {
    split.retain(|at| *at > x[0] + slack && *at < x[1] - slack);
    split.push(x[1]);
    split.sort_by(f64::total_cmp);
    split.dedup_by(|b, a| *b - *a <= slack);
    let mut from = x[0];
    split
        .into_iter()
        .map(|to| [std::mem::replace(&mut from, to), to])
        .collect()
}

/// The rail displaced by one unit of length along its +z.
fn beside(rail: &Rail, up: &Vector3<f64>) -> Rail {
    let mut twin = rail.clone();
    let z = Vector3::from(rail.axis)
        .cross(up)
        .try_normalize(0.0)
        .unwrap_or_else(Vector3::zeros);
    for segment in &mut twin.segments {
        segment.offset = (Vector3::from(segment.offset) + z).into();
    }
    twin
}

fn rail_frame(
    index: usize,
    rail: &Rail,
    up: &Vector3<f64>,
    frame: &FactoredFrame,
) -> Result<RailFrame, Error> {
    let x = Vector3::from(rail.axis).normalize();
    let y = (up - x * x.dot(up)).normalize();
    let elements = frame.line()?.elements().iter().enumerate();
    let own = elements.filter(|(_, element)| element.rail == index);
    let mut stretches: Vec<Stretch> = own
        .flat_map(|(element, given)| {
            let count = bent_parts(given).max(1);
            let at = move |k: usize| match k {
                _ if k == count => given.x[1],
                0 => given.x[0],
                _ => given.x[0] + (given.x[1] - given.x[0]) * k as f64 / count as f64,
            };
            (0..count).map(move |k| Stretch {
                rail: index,
                element,
                number: 0,
                x: [at(k), at(k + 1)],
                inner: [k > 0, k + 1 < count],
            })
        })
        .collect();
    stretches.sort_by(|a, b| a.x[0].total_cmp(&b.x[0]));
    let range = [stretches[0].x[0], stretches[stretches.len() - 1].x[1]];
    let resists = [0, 1, 2].map(|component| frame.resists(index, axis(component)));
    Ok(RailFrame {
        axes: [x, y, x.cross(&y)],
        origin: Vector3::from(rail.origin),
        range,
        stretches,
        resists,
    })
}
