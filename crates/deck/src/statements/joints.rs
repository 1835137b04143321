//! What restraints bodies to their tracks: JOINT, JPRIM and MOTION statements.

use adams::{ArgumentValue, Statement};
use sim::Profile;

use crate::model::plan::{DeckPlan, GROUND};
use crate::words::ids::{NextId, number};
use crate::words::text::{number as expression_number, plain};
use formats::scene::{BodyMotion, DOFS};

/// Angles of a marker whose z points along x, y or z of its part.
const ALONG: [[f64; 3]; 3] = [[90.0, 90.0, 0.0], [0.0, -90.0, 0.0], [0.0, 0.0, 0.0]];

/// All joints and motions, with the markers that they need.
pub(crate) fn statements(plan: &DeckPlan<'_>, markers: &mut NextId) -> Vec<Statement> {
    let mut out = Vec::new();
    // axles have the first numbers
    let mut restraints = Restraints {
        joints: NextId::from(number(plan.wheels.len())),
        prims: NextId::from(1),
        markers,
        made: Vec::new(),
        out: &mut out,
    };
    for b in 0..plan.bodies.len() {
        restraints.made.clear();
        restrain(plan, b, &mut restraints);
    }
    out
}

/// The statements that restrain bodies, as they are written.
struct Restraints<'a> {
    joints: NextId,
    prims: NextId,
    markers: &'a mut NextId,
    /// Markers of the present body: part, axis, position, identifier.
    made: Vec<(u32, usize, [f64; 3], u32)>,
    out: &'a mut Vec<Statement>,
}

impl Restraints<'_> {
    /// A marker on `part` at `at` whose z points along axis 0, 1 or 2.
    fn marker(&mut self, part: u32, at: [f64; 3], axis: usize, name: &str) -> u32 {
        let known = self.made.iter().find(|made| (made.0, made.1, made.2) == (part, axis, at));
        if let Some(made) = known {
            return made.3;
        }
        let id = self.markers.take();
        self.made.push((part, axis, at, id));
        let word = DOFS[axis];
        let mut statement = Statement::new("MARKER", id)
            .named(plain(&format!("{name}_z_along_{word}")))
            .reference("PART", part)
            .numbers("QP", &at);
        if axis != 2 {
            statement = statement.with("REULER", ArgumentValue::Degrees(ALONG[axis].to_vec()));
        }
        self.out.push(statement);
        id
    }

    fn prim(&mut self, kind: &str, [i, j]: [u32; 2], name: String) {
        let id = self.prims.take();
        self.out.push(
            Statement::new("JPRIM", id).named(plain(&name)).flag(kind).reference("I", i).reference("J", j),
        );
    }
}

/// Restrains the degrees of freedom of body `b` that its track holds, and prescribes its travel.
///
/// A body held in z, roll and yaw has a PLANAR joint. Other held displacements are one INPLANE each. Three held rotations
/// are an ORIENTATION, two are PARALLEL_AXES with the axis that remains free, one is a PERPENDICULAR of two axes.
fn restrain(plan: &DeckPlan<'_>, b: usize, restraints: &mut Restraints<'_>) {
    let (own, body) = (&plan.bodies[b], &plan.scene.bodies[b]);
    let name = &body.name;
    let [height, side] = own.position;
    let start = plan.start.displacement[b];
    let prescribed = matches!(body.motion, BodyMotion::Prescribed(_));
    let mut held: [bool; 6] = std::array::from_fn(|i| !body.free[i]);
    held[0] = matches!(body.motion, BodyMotion::Held);
    let planar = held[2] && held[3] && held[4] && start[2] == 0.0;
    if planar {
        let id = restraints.joints.take();
        restraints.out.push(
            Statement::new("JOINT", id)
                .named(plain(&format!("plane_{name}")))
                .remark(format!("{name}: z, roll and yaw are held by its track"))
                .flag("PLANAR")
                .reference("I", own.origin)
                .reference("J", own.track),
        );
    }
    let zero = [0.0, height, side];
    for axis in (0..3).filter(|&axis| held[axis] && !(planar && axis == 2)) {
        let mut at = zero;
        at[axis] += start[axis];
        let j = restraints.marker(GROUND, at, axis, &format!("hold_{name}"));
        restraints.prim("INPLANE", [own.origin, j], format!("hold_{}_of_{name}", DOFS[axis]));
    }
    let turns: Vec<usize> = (0..3).filter(|&axis| held[3 + axis]).collect();
    let both = |restraints: &mut Restraints<'_>, axis: usize| {
        let i = restraints.marker(own.part, [0.0; 3], axis, name);
        let j = restraints.marker(GROUND, zero, axis, &format!("track_{name}"));
        [i, j]
    };
    match turns[..] {
        [_, _, _] if !planar => {
            restraints.prim("ORIENTATION", [own.origin, own.track], format!("hold_turns_of_{name}"))
        }
        [a, c] if !planar => {
            let pair = both(restraints, 3 - a - c);
            restraints.prim("PARALLEL_AXES", pair, format!("hold_two_turns_of_{name}"));
        }
        [] => {}
        _ if planar && turns.len() == 2 => {}
        _ => {
            // roll: the body's y keeps off z; yaw: its x keeps off z; pitch: its x keeps off y
            let axis = turns.last().copied().unwrap_or_default();
            let [own_axis, ground_axis] = [[1, 2], [0, 2], [0, 1]][axis];
            let i = restraints.marker(own.part, [0.0; 3], own_axis, name);
            let j = restraints.marker(GROUND, zero, ground_axis, &format!("track_{name}"));
            restraints.prim("PERPENDICULAR", [i, j], format!("hold_{}_of_{name}", DOFS[3 + axis]));
        }
    }
    if prescribed && let BodyMotion::Prescribed(profile) = &body.motion {
        restraints.out.push(
            Statement::new("MOTION", number(b))
                .named(plain(&format!("travel_{name}")))
                .reference("I", own.origin)
                .reference("J", own.track)
                .flag("X")
                .flag("DISPLACEMENT")
                .function("FUNCTION", motion_expression(profile)),
        );
    }
}

/// Position along the rail as an expression of TIME: the exact polynomial of each interval of the profile, selected by
/// nested IFs.
///
/// Position is continuous, so that it does not matter to which interval a break belongs. The IFs are nested as a binary
/// tree: a table of n rows takes log2 n comparisons.
pub(crate) fn motion_expression(profile: &Profile) -> String {
    let mut starts = vec![0.0];
    starts.extend_from_slice(profile.breaks());
    let pieces: Vec<(f64, String)> = (0..starts.len())
        .map(|k| (starts[k], piece(profile, starts[k], starts.get(k + 1).copied())))
        .collect();
    tree(&pieces)
}

fn tree(pieces: &[(f64, String)]) -> String {
    match pieces {
        [] => "0.0".to_owned(),
        [(_, only)] => only.clone(),
        _ => {
            let (before, after) = pieces.split_at(pieces.len() / 2);
            let (start, first) = &after[0];
            let time = format!("TIME-{}", expression_number(*start));
            format!("IF({time}:{},{first},{})", tree(before), tree(after))
        }
    }
}

/// x + v s + a s^2/2 + j s^3/6, with s the time since the start of the interval.
fn piece(profile: &Profile, start: f64, end: Option<f64>) -> String {
    let at = profile.at(start);
    // within the interval acceleration is linear in time
    let middle = end.map_or(start + 1.0, |end| f64::midpoint(start, end));
    let jerk = (profile.at(middle).a - at.a) / (middle - start);
    let s = if start == 0.0 { "TIME".to_owned() } else { format!("(TIME-{})", expression_number(start)) };
    let mut text = adams::number::write(at.x);
    for (power, factor) in [(1, at.v), (2, at.a / 2.0), (3, jerk / 6.0)] {
        if factor != 0.0 {
            text.push_str(&format!("+{}*{s}", expression_number(factor)));
            if power > 1 {
                text.push_str(&format!("**{power}"));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::motion_expression;
    use sim::{MotionKind, Profile};

    #[test]
    fn a_speed_table_is_a_polynomial_a_stretch() {
        let table = [[0.0, 0.0], [4.0, 6.0], [8.0, 6.0]];
        let profile = Profile::new(MotionKind::Speed, &table, 20.0, 0.0).expect("a valid table");
        assert_eq!(
            motion_expression(&profile),
            "IF(TIME-4.0:20.0+0.75*TIME**2,32.0+6.0*(TIME-4.0),IF(TIME-8.0:32.0+6.0*(TIME-4.0),\
             56.0+6.0*(TIME-8.0),56.0+6.0*(TIME-8.0)))"
        );
    }
}
