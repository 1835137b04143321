//! REQUEST statements: wheels, bodies, forces on each rail, reactions of structures.

use adams::{ArgumentValue, Statement};
use splines::Axis;

use crate::Error;
use crate::model::compliance::{LoadedMarker, spline};
use crate::model::plan::DeckPlan;
use crate::statements::contact;
use crate::words::ids::{NextId, VariableSlot, variable};
use crate::words::remark;
use crate::words::text::{TermList, plain, value};
use formats::grid::effects::{Reaction, ReactionPoint};
use formats::scene::BodyMotion;
use foundations::{SolvedStructure, solution_of};

/// Largest number of reactions in one REQUEST, whose names must fit on a line.
const REACTIONS_PER_REQUEST: usize = 4;
/// Reaction per unit load up to which the reaction is treated as zero.
const NEGLIGIBLE: f64 = 1e-9;

/// All requests, and the SPLINEs that they use.
///
/// # Errors
/// Influence lines that do not form a valid SPLINE.
pub(crate) fn statements(
    plan: &DeckPlan<'_>,
    known: &[SolvedStructure],
    splines: &mut NextId,
) -> Result<Vec<Statement>, Error> {
    let mut ids = NextId::from(1);
    let mut out = Vec::new();
    for w in 0..plan.wheels.len() {
        out.push(wheel(plan, w, ids.take()));
    }
    for b in 0..plan.bodies.len() {
        out.push(body(plan, b, ids.take()));
    }
    let mut written = false;
    for (r, rail) in plan.scene.rails.iter().enumerate() {
        let on = |w: &usize| plan.datums[plan.wheels[*w].datum].rail == r;
        let wheels: Vec<usize> = (0..plan.wheels.len()).filter(on).collect();
        if wheels.is_empty() {
            continue;
        }
        let [mut down, mut side] = [TermList::default(), TermList::default()];
        for w in wheels {
            down.add(
                false,
                &value(variable(
                    plan.contacts[plan.wheels[w].contact].wheels.start,
                    VariableSlot::Press,
                )),
            );
            if plan.kind(w).flange.is_some() {
                side.add(false, &value(variable(w, VariableSlot::Flange)));
            }
        }
        let parts = vec![
            ("down".to_owned(), down.text()),
            ("lateral".to_owned(), side.text()),
        ];
        let mut statement = request(ids.take(), &format!("carried_by_{}", rail.name), parts);
        if !std::mem::replace(&mut written, true) {
            statement = statement.remark(remark::REACTION);
        }
        out.push(statement);
    }
    for s in 0..plan.compliances.len() {
        reactions(plan, known, s, splines, &mut ids, &mut out)?;
    }
    Ok(out)
}

/// A REQUEST of named expressions.
fn request(id: u32, name: &str, parts: Vec<(String, String)>) -> Statement {
    let quoted: Vec<String> = parts
        .iter()
        .map(|(name, _)| format!("\"{name}\""))
        .collect();
    let mut statement = Statement::new("REQUEST", id)
        .named(plain(name))
        .with("CNAMES", ArgumentValue::Word(quoted.join(", ")))
        .word("RESULTS_NAME", &plain(name));
    for (k, (_, text)) in parts.into_iter().enumerate() {
        statement = statement.function(&format!("F{}", k + 1), text);
    }
    statement
}

fn wheel(plan: &DeckPlan<'_>, w: usize, id: u32) -> Statement {
    let own = &plan.wheels[w];
    let first = plan.contacts[own.contact].wheels.start;
    let mut parts = Vec::new();
    let mut add =
        |name: &str, at: usize, slot| parts.push((name.to_owned(), value(variable(at, slot))));
    add("place", w, VariableSlot::Place);
    add("penetr", first, VariableSlot::Penetration);
    add("down", first, VariableSlot::Press);
    if plan.compliances[own.structure].is_flexible() {
        add("rise", w, VariableSlot::Rise);
    }
    if plan.kind(w).flange.is_some() {
        add("sideways", w, VariableSlot::Sideways);
        add("flange", w, VariableSlot::Flange);
    }
    if own.spin.is_some() {
        add("traction", w, VariableSlot::Traction);
    }
    request(id, &format!("wheel_{}", own.name), parts)
}

fn body(plan: &DeckPlan<'_>, b: usize, id: u32) -> Statement {
    let own = &plan.bodies[b];
    let (i, j) = (own.origin, own.track);
    let name = &plan.scene.bodies[b].name;
    let mut parts = Vec::new();
    for (word, function) in [("x", "DX"), ("y", "DY"), ("z", "DZ")] {
        parts.push((word.to_owned(), format!("{function}({i},{j},{j})")));
    }
    for (k, (word, function)) in [("roll", "AX"), ("yaw", "AY"), ("pitch", "AZ")]
        .into_iter()
        .enumerate()
    {
        if plan.scene.bodies[b].free[3 + k] {
            parts.push((word.to_owned(), format!("{function}({i},{j})")));
        }
    }
    if matches!(plan.scene.bodies[b].motion, BodyMotion::Prescribed(_)) {
        parts.push((
            "drive".to_owned(),
            format!("MOTION({},0,2,{j})", crate::words::ids::number(b)),
        ));
    }
    request(id, &format!("motion_of_{name}"), parts)
}

/// Friction of the wheels along the rails of structure `s`. Decks have no compliance along rails, so that these forces
/// are in reactions alone.
fn tractions(plan: &DeckPlan<'_>, s: usize) -> Vec<LoadedMarker> {
    let slides = |w: &usize| {
        let wheel = &plan.wheels[*w];
        wheel.structure == s && wheel.spin.is_some() && plan.kind(*w).friction.is_some()
    };
    (0..plan.wheels.len())
        .filter(slides)
        .map(|w| LoadedMarker {
            direction: plan.direction(w, Axis::Longitudinal),
            place: value(variable(w, VariableSlot::Place)),
            force: value(variable(w, VariableSlot::Traction)),
            negative: false,
        })
        .collect()
}

/// Reactions of the ground on structure `s`: sums of forces times influence lines. Each influence line is a SPLINE at
/// the stations.
fn reactions(
    plan: &DeckPlan<'_>,
    known: &[SolvedStructure],
    s: usize,
    splines: &mut NextId,
    ids: &mut NextId,
    out: &mut Vec<Statement>,
) -> Result<(), Error> {
    let structure = &plan.scene.structures[s];
    let effects =
        solution_of(known, &structure.origin).and_then(|solved| solved.grid.effects.as_ref());
    let Some(effects) = effects.filter(|_| plan.compliances[s].is_flexible()) else {
        return Ok(());
    };
    let mut loads = contact::loads(plan, s);
    loads.extend(tractions(plan, s));
    let mut named = Vec::new();
    for reaction in &effects.reactions {
        let name = label(reaction);
        let mut sum = TermList::default();
        let mut lines: Vec<(crate::model::compliance::RailAxis, u32)> = Vec::new();
        for load in &loads {
            let Some(line) = line(plan, s, reaction, load) else {
                continue;
            };
            let known = lines
                .iter()
                .find(|(direction, _)| *direction == load.direction)
                .map(|(_, id)| *id);
            let id = match known {
                Some(id) => id,
                None => {
                    let id = splines.take();
                    let rail = &structure.rails[load.direction.0];
                    let full = format!(
                        "{}_{name}_from_{}_{}",
                        structure.name,
                        rail.name,
                        crate::model::compliance::word(load.direction.1)
                    );
                    out.push(spline(
                        id,
                        &full,
                        rail.stations.clone(),
                        Vec::new(),
                        vec![line],
                    )?);
                    lines.push((load.direction, id));
                    id
                }
            };
            sum.add(
                load.negative,
                &format!("{}*AKISPL({},0,{id})", load.force, load.place),
            );
        }
        if !lines.is_empty() {
            named.push((name, sum.text()));
        }
    }
    for (k, parts) in named.chunks(REACTIONS_PER_REQUEST).enumerate() {
        out.push(request(
            ids.take(),
            &format!("reactions_of_{}_{}", structure.name, k + 1),
            parts.to_vec(),
        ));
    }
    Ok(())
}

/// Influence line of a reaction along the rail of a load; `None` if the load has no effect on the reaction.
fn line(
    plan: &DeckPlan<'_>,
    s: usize,
    reaction: &Reaction,
    load: &LoadedMarker,
) -> Option<Vec<f64>> {
    let (rail, axis): (usize, Axis) = load.direction;
    let rails = &plan.scene.structures[s].rails;
    let first: usize = rails[..rail].iter().map(|rail| rail.stations.len()).sum();
    let (_, all) = reaction.lines.iter().find(|(known, _)| *known == axis)?;
    let own = all.get(first..first + rails[rail].stations.len())?;
    own.iter()
        .any(|value| value.abs() > NEGLIGIBLE)
        .then(|| own.to_vec())
}

/// The name of a reaction, such as `uy_60` for a girder and `uy_p12` for a frame.
fn label(reaction: &Reaction) -> String {
    let place = match reaction.at {
        ReactionPoint::Along(x) => plain(&format!("{x}")),
        ReactionPoint::Point(point) => format!("p{point}"),
    };
    let spring = if reaction.spring.is_some() {
        "_spring"
    } else {
        ""
    };
    format!(
        "{}_{}{spring}",
        reaction.dof,
        place.chars().take(8).collect::<String>()
    )
}
