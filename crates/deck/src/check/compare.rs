//! Comparison of the equations of the deck with the values of the simulator.
//!
//! At each state the VARIABLEs and rates of the simulator are put into the expressions of the deck, and each expression
//! must give the value of the simulator. A loop in which every equation holds is solved, so that no loop is solved
//! here: wheels may be as stiff and as close together as they like. A difference belongs to one statement.

use adams::{AdamsModel, DataSet, GivenValues, ModelState};
use nalgebra::DMatrix;
use sim::Foundation;
use splines::{Axis, Influence, Probe};

use super::states::{CheckCase, fall};
use crate::Error;
use crate::words::ids::{VariableSlot, number, variable};
use crate::{DeckForm, DeckPlan};

/// Quantities that are compared: VARIABLEs and DIFFs of wheels, and the components of their GFORCEs.
pub const QUANTITIES: [&str; 15] = [
    "place", "rise", "shift", "penetr", "gap", "sideways", "down", "flange", "traction", "FX",
    "FY", "FZ", "TX", "TY", "TZ",
];
/// The first quantities are lengths, the others forces, and the last three moments.
const LENGTHS: usize = 6;
/// The first component of a GFORCE.
const FORCE: usize = 9;
/// The first moment.
const MOMENT: usize = 12;
/// Rounding errors of a length are at most this times the coordinates that it is computed from.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Change of penetrations, relative to the largest, at which iterations of the simulator end (`STAGNANT` and `SETTLED` in the
/// statics of `sim`): its force is that of its law at a penetration that differs by so much, and at rest so is its penetration
/// that of the heights.
const STAGNANT: f64 = 1e-9;
/// Difference of a flange force of the simulator from its law at the answer, relative to itself: the height of the wheel, by
/// which it is released, follows by iteration.
const LAW: f64 = 1e-6;
/// Largest number of statements that are named in a report.
const NAMED: usize = 3;

/// A statement whose value in the deck is not that of the simulator.
#[derive(Clone, Debug, PartialEq)]
pub struct WrongStatement {
    /// Keyword, identifier and name, such as `VARIABLE/105 (t_wheel1_press)`.
    pub statement: String,
    /// The quantity, one of [`QUANTITIES`].
    pub quantity: &'static str,
    /// The value that the deck gives.
    pub deck: f64,
    /// The value of the simulator.
    pub simulator: f64,
    /// Time of the state, s.
    pub time: f64,
    /// Difference relative to the largest value of the quantity.
    pub relative: f64,
}

/// Differences of values over many states.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckDifference {
    /// Description of the comparison.
    pub what: &'static str,
    /// Number of states.
    pub states: usize,
    /// Limit of the difference, relative to the largest value: of all forces for forces (moments are divided by the
    /// radius of the largest wheel), of the same quantity for lengths. To it come the rounding errors of coordinates,
    /// and what stiff wheels make of them.
    pub limit: f64,
    /// Largest difference of each of [`QUANTITIES`], relative to the same value.
    pub worst: [f64; QUANTITIES.len()],
    /// Largest force of all states.
    pub largest: f64,
    /// The statements that differ most, if any differ by more than the limit.
    pub wrong: Vec<WrongStatement>,
    /// Number of states at which the deck could not be evaluated, with the error at the first of them.
    pub failed: Option<(String, usize)>,
}

impl CheckDifference {
    /// Largest of the differences.
    #[must_use]
    pub fn largest_of_all(&self) -> f64 {
        self.worst.iter().fold(0.0, |most, value| most.max(*value))
    }

    /// Whether the differences are within the limit and the deck was evaluated at every state.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.failed.is_none() && self.wrong.is_empty()
    }
}

/// A value of the simulator that a statement of the deck must give.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ExpectedValue {
    /// Index in [`QUANTITIES`].
    quantity: usize,
    keyword: &'static str,
    id: u32,
    value: f64,
    /// The rounding error of the expression.
    rounding: f64,
}

/// The values of the simulator at one state.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedValues {
    /// VARIABLEs and rates, which are put into the expressions of the deck.
    pub given: GivenValues,
    values: Vec<ExpectedValue>,
}

/// The values that the deck must give at `case`; `size` is the size of the coordinates that come to those of the scene
/// where the rails are on a moving part.
///
/// Contact forces are those of the simulator. Displacements of rails, and the forces F du/dx along them, are computed
/// from values and derivatives of the tables.
///
/// # Errors
/// [`Error::Compliance`] for a wheel beyond its rail.
pub fn expected_values(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    case: &CheckCase,
    size: f64,
) -> Result<ExpectedValues, Error> {
    let rails = displacements(plan, foundations, case)?;
    let mut out = ExpectedValues {
        given: GivenValues::default(),
        values: Vec::new(),
    };
    for w in 0..plan.wheels.len() {
        wheel(plan, case, w, &rails, size, &mut out);
    }
    for (c, contact) in plan.contacts.iter().enumerate() {
        let Some(id) = contact.diff else { continue };
        out.given.rates.insert(id, case.rate[c]);
        if plan.form != DeckForm::Paper {
            let rounding = ROUNDING * (size + plan.kind(contact.wheels.start).radius);
            out.values.push(ExpectedValue {
                quantity: 4,
                keyword: "DIFF",
                id,
                value: 0.0,
                rounding,
            });
        }
    }
    Ok(out)
}

/// The values of wheel `w`.
fn wheel(
    plan: &DeckPlan<'_>,
    case: &CheckCase,
    w: usize,
    rails: &[RailDisplacement],
    size: f64,
    out: &mut ExpectedValues,
) {
    let rail = &rails[w];
    let (own, kind, forces) = (&plan.wheels[w], plan.kind(w), &case.forces);
    let contact = &plan.contacts[own.contact];
    let penetration = forces.penetration[own.contact];
    let (down, side, along) = (forces.vertical[w], forces.lateral[w], forces.traction[w]);
    let arm = kind.radius - penetration;
    let [x, y, z, roll, yaw, pitch] = case.instant.displacement[own.body];
    let [hx, hy, hz] = own.hub;
    let [height, lateral] = plan.bodies[own.body].position;
    let turned =
        (roll.abs() + yaw.abs() + pitch.abs()) * (hx.abs() + hy.abs() + hz.abs() + kind.radius);
    let by_place = ROUNDING * (size + x.abs() + hx.abs() + turned);
    let by_rise = rail.rise_rounding.of(by_place);
    let by_shift = rail.shift_rounding.of(by_place);
    let by_height = by_contact_rise(plan, own.contact, rails, by_place)
        + ROUNDING
            * (size + height.abs() + y.abs() + hy.abs() + kind.radius + turned + rail.rise.abs());
    let by_side = by_shift
        + ROUNDING * (size + lateral.abs() + z.abs() + hz.abs() + turned + rail.shift.abs());
    let rate = if contact.diff.is_some() {
        case.rate[own.contact]
    } else {
        fall(plan, &case.instant, own.contact)
    };
    let law = kind.normal.at(penetration, rate);
    let by_press = law.by_penetration.abs() * by_height;
    let by_flange = kind
        .flange
        .as_ref()
        .map_or(0.0, |flange| flange.stiffness * by_side);
    let mut add = |quantity: usize, slot: VariableSlot, value: f64, rounding: f64| {
        let id = variable(w, slot);
        let given = match quantity {
            6 => down,
            7 => side,
            _ => value,
        };
        out.given.variables.insert(id, given);
        out.values.push(ExpectedValue {
            quantity,
            keyword: "VARIABLE",
            id,
            value,
            rounding,
        });
    };
    add(
        0,
        VariableSlot::Place,
        place(case, own.body, own.hub),
        by_place,
    );
    let is_flexible = plan.compliances[own.structure].is_flexible();
    if is_flexible {
        add(1, VariableSlot::Rise, rail.rise, by_rise);
    }
    if contact.wheels.start == w {
        let deepest = forces
            .penetration
            .iter()
            .fold(0.0_f64, |most, p| most.max(p.abs()));
        let settled = if case.is_at_rest {
            STAGNANT * deepest
        } else {
            0.0
        };
        add(
            3,
            VariableSlot::Penetration,
            penetration,
            by_height + settled,
        );
        // The expression is compared with the simulator's law, not with the force that its iteration leaves. This hides no
        // difference of the deck: the force of the simulator is compared with its own law.
        let left = law.by_penetration.abs() * STAGNANT * deepest;
        let press = if (law.force - down).abs() <= left {
            law.force
        } else {
            down
        };
        add(6, VariableSlot::Press, press, by_press);
    }
    if let Some(flange) = &kind.flange {
        if is_flexible {
            add(2, VariableSlot::Shift, rail.shift, by_shift);
        }
        let from_rail = z + roll * (hy - arm) - yaw * hx - rail.shift;
        add(5, VariableSlot::Sideways, from_rail, by_side);
        // As with the vertical force, the expression is compared with the law.
        let law = flange.stiffness * flange.fraction(arm).0 * flange.overlap(from_rail);
        let is_law = (law - side).abs() <= LAW * law.abs();
        add(
            7,
            VariableSlot::Flange,
            if is_law { law } else { side },
            by_flange,
        );
    }
    if let (Some(_), Some(friction)) = (own.spin, &kind.friction) {
        let [vx, vy, vz, by_roll, by_yaw, by_pitch] = case.instant.speed[own.body].map(f64::abs);
        let turns = by_roll + by_yaw + by_pitch;
        let arms = hx.abs() + hy.abs() + hz.abs();
        let spins = turns + case.instant.spin[w].abs();
        let speeds = vx + vy + vz + turns * arms + spins * kind.radius;
        // Where the rails move, they turn at up to 1 rad/s, and the coordinates are multiplied by that.
        let by_slip =
            friction.coefficient * down.abs() / friction.slip * ROUNDING * (speeds + size);
        add(8, VariableSlot::Traction, along, by_slip);
    }
    let slope = if plan.form == DeckForm::Factored {
        rail.along
    } else {
        0.0
    };
    let along_rounding = if slope == 0.0 {
        0.0
    } else {
        rail.along_rounding.of(by_place)
    };
    let components = [slope - along, down, -side, arm * side, 0.0, -arm * along];
    for (k, value) in components.into_iter().enumerate() {
        out.values.push(ExpectedValue {
            quantity: FORCE + k,
            keyword: "GFORCE",
            id: number(w),
            value,
            rounding: if k == 0 { along_rounding } else { 0.0 },
        });
    }
}

/// Displacements of the rail under a wheel.
#[derive(Clone, Copy, Debug, Default)]
struct RailDisplacement {
    /// Upwards.
    rise: f64,
    /// Lateral.
    shift: f64,
    /// Force along the rail due to its slopes.
    along: f64,
    /// What `along`, `rise` and `shift` are computed from.
    along_rounding: TermSizes,
    rise_rounding: TermSizes,
    shift_rounding: TermSizes,
}

/// Sizes of the terms of a displacement, sum over j of G(i, j) F_j.
#[derive(Clone, Copy, Debug, Default)]
struct TermSizes {
    /// Sum of (|G(i, j)| + (G(i, i) G(j, j))^(1/2)) |F_j|. Products of curves are at most as large as the second term,
    /// and may cancel.
    sum: f64,
    /// Sum of the derivatives by the coordinates of both i and j.
    by_place: f64,
}

impl TermSizes {
    /// The rounding error of the displacement where coordinates have the error `by_place`.
    fn of(self, by_place: f64) -> f64 {
        ROUNDING * self.sum + by_place * self.by_place
    }
}

/// The largest rounding error of the displacements of the rail under the wheels of contact `c`.
fn by_contact_rise(
    plan: &DeckPlan<'_>,
    c: usize,
    rails: &[RailDisplacement],
    by_place: f64,
) -> f64 {
    let wheels = plan.contacts[c].wheels.clone();
    wheels
        .map(|w| rails[w].rise_rounding.of(by_place))
        .fold(0.0, f64::max)
}

/// The largest force along the rails due to their slopes at the given states, relative to the largest vertical force.
///
/// # Errors
/// [`Error::Compliance`] for a wheel beyond its rail.
pub fn largest_along(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    cases: &[CheckCase],
) -> Result<f64, Error> {
    let (mut along, mut largest) = (0.0_f64, f64::MIN_POSITIVE);
    for case in cases {
        for (w, rail) in displacements(plan, foundations, case)?.iter().enumerate() {
            along = along.max(rail.along.abs());
            largest = largest.max(case.forces.vertical[w].abs());
        }
    }
    Ok(along / largest)
}

/// The displacements of the rails under all wheels.
fn displacements(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    case: &CheckCase,
) -> Result<Vec<RailDisplacement>, Error> {
    let forces = &case.forces;
    let mut out = vec![RailDisplacement::default(); plan.wheels.len()];
    for (s, foundation) in foundations.iter().enumerate() {
        let Some(compliance) = &foundation.compliance else {
            continue;
        };
        let (mut probes, mut loads) = (Vec::new(), Vec::new());
        for (w, wheel) in plan
            .wheels
            .iter()
            .enumerate()
            .filter(|(_, wheel)| wheel.structure == s)
        {
            let x = place(case, wheel.body, wheel.hub);
            let mut add = |axis: Axis, load: f64| {
                probes.push(Probe {
                    rail: wheel.rail,
                    x,
                    axis,
                });
                loads.push((w, axis, load));
            };
            add(Axis::Vertical, -forces.vertical[w]);
            if plan.kind(w).flange.is_some() {
                add(Axis::Lateral, forces.lateral[w]);
            }
        }
        let mut influence = Influence::zeros(probes.len());
        compliance.fill(&probes, &mut influence)?;
        for (i, &(w, axis, own)) in loads.iter().enumerate() {
            let of = |matrix: &DMatrix<f64>| -> f64 {
                loads
                    .iter()
                    .enumerate()
                    .map(|(j, (_, _, load))| matrix[(i, j)] * load)
                    .sum()
            };
            let moved = of(&influence.value);
            let mut sizes = TermSizes::default();
            for (j, (_, _, load)) in loads.iter().enumerate() {
                let (value, slope) = (&influence.value, &influence.slope);
                let product = (value[(i, i)] * value[(j, j)]).abs().sqrt();
                sizes.sum += (value[(i, j)].abs() + product) * load.abs();
                sizes.by_place += (slope[(i, j)].abs() + slope[(j, i)].abs()) * load.abs();
            }
            match axis {
                Axis::Lateral => (out[w].shift, out[w].shift_rounding) = (moved, sizes),
                _ => (out[w].rise, out[w].rise_rounding) = (moved, sizes),
            }
            out[w].along += own * of(&influence.slope);
            if plan.form != DeckForm::Factored {
                continue;
            }
            // Between two stations a product of curves changes by about its size, and its slope by about that slope.
            let stations = compliance.breaks(plan.wheels[w].rail);
            let spacing = stations
                .windows(2)
                .fold(f64::INFINITY, |least, pair| least.min(pair[1] - pair[0]));
            let rounding = &mut out[w].along_rounding;
            rounding.sum += own.abs() * (sizes.by_place + sizes.sum / spacing);
            rounding.by_place += own.abs() * sizes.by_place / spacing;
        }
    }
    Ok(out)
}

/// Rail coordinate of a wheel.
fn place(case: &CheckCase, body: usize, hub: [f64; 3]) -> f64 {
    let [x, _, _, _, yaw, pitch] = case.instant.displacement[body];
    x + hub[0] + yaw * hub[2] - pitch * hub[1]
}

/// Compares the values that the data set gives at `states` with the expected ones.
///
/// # Errors
/// A data set that cannot be executed.
pub fn compare(
    plan: &DeckPlan<'_>,
    set: &DataSet,
    (what, limit): (&'static str, f64),
    states: impl Iterator<Item = Result<(ModelState, ExpectedValues), Error>>,
) -> Result<CheckDifference, Error> {
    let model = AdamsModel::new(set)?;
    let mut out = CheckDifference {
        what,
        states: 0,
        limit,
        worst: [0.0; QUANTITIES.len()],
        largest: 0.0,
        wrong: Vec::new(),
        failed: None,
    };
    let mut tally = Tally::new(plan);
    let mut substitution = None;
    for one in states {
        let (state, expected) = one?;
        out.states += 1;
        if substitution.is_none() {
            let given = &expected.given.variables;
            substitution = Some(model.substitution(|id| given.contains_key(&id))?);
        }
        let found = substitution
            .as_ref()
            .expect("set before")
            .at(&state, &expected.given);
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                let (_, count) = out.failed.get_or_insert_with(|| (error.to_string(), 0));
                *count += 1;
                continue;
            }
        };
        for expected in &expected.values {
            let value = match expected.keyword {
                "GFORCE" => found
                    .loads
                    .get(&("GFORCE", expected.id))
                    .map(|load| load.components[expected.quantity - FORCE]),
                "DIFF" => found.differentials.get(&expected.id).copied(),
                _ => found.variables.get(&expected.id).copied(),
            };
            tally.add(expected, value, state.time);
        }
        let known = |id: u32| (1..=number(plan.wheels.len() - 1)).contains(&id);
        let more = found
            .loads
            .keys()
            .find(|(keyword, id)| *keyword != "GFORCE" || !known(*id));
        if let Some((keyword, id)) = more {
            let why = format!("{keyword}/{id} is in the deck alone: the scene has no such force");
            out.failed.get_or_insert((why, 0)).1 += 1;
        }
    }
    tally.close(set, &mut out);
    Ok(out)
}

/// The largest differences so far.
struct Tally {
    /// Largest magnitude of each quantity; moments are divided by the radius.
    largest: [f64; QUANTITIES.len()],
    /// Largest difference of each quantity, without rounding errors.
    worst: [f64; QUANTITIES.len()],
    /// Largest difference of each statement in each quantity beyond its rounding error.
    statements: std::collections::BTreeMap<(&'static str, u32, usize), (f64, WrongStatement)>,
    radius: f64,
}

impl Tally {
    fn new(plan: &DeckPlan<'_>) -> Tally {
        let radius = (0..plan.wheels.len())
            .map(|w| plan.kind(w).radius)
            .fold(f64::MIN_POSITIVE, f64::max);
        Tally {
            largest: [0.0; QUANTITIES.len()],
            worst: [0.0; QUANTITIES.len()],
            statements: std::collections::BTreeMap::new(),
            radius,
        }
    }

    fn add(&mut self, expected: &ExpectedValue, found: Option<f64>, time: f64) {
        let k = expected.quantity;
        let scale = if k < MOMENT { 1.0 } else { 1.0 / self.radius };
        self.largest[k] = self.largest[k].max(expected.value.abs() * scale);
        let found = found.filter(|value| value.is_finite()).unwrap_or(f64::MAX);
        let difference = (found - expected.value).abs() * scale;
        self.worst[k] = self.worst[k].max(difference);
        let beyond = difference - expected.rounding;
        if beyond <= 0.0 {
            return;
        }
        let key = (expected.keyword, expected.id, k);
        let known = self.statements.get(&key).map_or(0.0, |(beyond, _)| *beyond);
        if beyond > known {
            let wrong = WrongStatement {
                statement: String::new(),
                quantity: QUANTITIES[k],
                deck: found,
                simulator: expected.value,
                time,
                relative: 0.0,
            };
            self.statements.insert(key, (beyond, wrong));
        }
    }

    /// Sets the relative differences and the statements that differ by more than the limit.
    fn close(self, set: &DataSet, out: &mut CheckDifference) {
        let forces = &self.largest[LENGTHS..];
        out.largest = forces.iter().copied().fold(0.0, f64::max);
        let scale = |k: usize| {
            let own = match k {
                // The gap of a DIFF is zero where its equation holds; it is measured by penetrations.
                4 => self.largest[3],
                k if k < LENGTHS => self.largest[k],
                _ => out.largest,
            };
            own.max(f64::MIN_POSITIVE)
        };
        for (k, worst) in self.worst.iter().enumerate() {
            out.worst[k] = (worst / scale(k)).min(f64::MAX);
        }
        for ((keyword, id, k), (beyond, wrong)) in self.statements {
            let relative = (beyond / scale(k)).min(f64::MAX);
            if relative > out.limit {
                out.wrong.push(WrongStatement {
                    statement: statement(set, keyword, id),
                    relative,
                    ..wrong
                });
            }
        }
        out.wrong.sort_by(|a, b| b.relative.total_cmp(&a.relative));
        out.wrong.truncate(NAMED);
    }
}

/// Keyword, identifier and name of a statement of the data set.
pub fn statement(set: &DataSet, keyword: &str, id: u32) -> String {
    let own = set
        .statements
        .iter()
        .find(|one| one.keyword == keyword && one.id == Some(id));
    match own.map(|one| &one.name) {
        Some(Some(name)) => format!("{keyword}/{id} ({name})"),
        Some(None) => format!("{keyword}/{id}"),
        None => format!("{keyword}/{id}, which the deck does not have"),
    }
}
