//! Restraints of bodies to their tracks: JOINT, JPRIM and MOTION statements.

use adams::{ArgumentValue, Statement};
use sim::Profile;

use crate::model::plan::{BodyPlan, DeckPlan, GROUND};
use crate::words::ids::{NextId, number};
use crate::words::text::{number as expression_number, plain};
use formats::scene::{BodyMotion, DOFS};

/// Euler angles of a marker whose z axis points along x, y or z of its part.
const MARKER_ANGLES: [[f64; 3]; 3] = [[90.0, 90.0, 0.0], [0.0, -90.0, 0.0], [0.0, 0.0, 0.0]];

/// All joints and motions, with the markers that they need.
pub(crate) fn statements(plan: &DeckPlan<'_>, markers: &mut NextId) -> Vec<Statement> {
    let mut out = Vec::new();
    // the revolute joints of spinning wheels have the first numbers
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

/// State of writing the statements that restrain bodies.
struct Restraints<'a> {
    joints: NextId,
    prims: NextId,
    markers: &'a mut NextId,
    /// Markers of the current body: part, axis, position, identifier.
    made: Vec<(u32, usize, [f64; 3], u32)>,
    out: &'a mut Vec<Statement>,
}

impl Restraints<'_> {
    /// Returns a marker on `part` at `at` whose z axis points along axis 0, 1 or 2; writes it unless it exists
    /// already.
    fn marker(&mut self, part: u32, at: [f64; 3], axis: usize, name: &str) -> u32 {
        let known = self
            .made
            .iter()
            .find(|made| (made.0, made.1, made.2) == (part, axis, at));
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
            statement = statement.with(
                "REULER",
                ArgumentValue::Degrees(MARKER_ANGLES[axis].to_vec()),
            );
        }
        self.out.push(statement);
        id
    }

    fn prim(&mut self, kind: &str, [i, j]: [u32; 2], name: String) {
        let id = self.prims.take();
        self.out.push(
            Statement::new("JPRIM", id)
                .named(plain(&name))
                .flag(kind)
                .reference("I", i)
                .reference("J", j),
        );
    }
}

/// Restrains those degrees of freedom of body `b` that its track restrains, and prescribes its travel.
///
/// A body that is restrained in z, roll and yaw has a PLANAR joint. Every other restrained displacement is one
/// INPLANE, and restrained rotations are one JPRIM ([`restrain_rotations`]).
fn restrain(plan: &DeckPlan<'_>, b: usize, restraints: &mut Restraints<'_>) {
    let (own, body) = (&plan.bodies[b], &plan.scene.bodies[b]);
    let start = plan.start.displacement[b];
    let mut restrained: [bool; 6] = std::array::from_fn(|i| !body.free[i]);
    restrained[0] = matches!(body.motion, BodyMotion::Held);
    let is_planar = restrained[2] && restrained[3] && restrained[4] && start[2] == 0.0;
    if is_planar {
        let id = restraints.joints.take();
        restraints.out.push(
            Statement::new("JOINT", id)
                .named(plain(&format!("plane_{}", body.name)))
                .remark(format!(
                    "{}: z, roll and yaw are held by its track",
                    body.name
                ))
                .flag("PLANAR")
                .reference("I", own.origin)
                .reference("J", own.track),
        );
    }
    let [height, side] = own.position;
    for axis in (0..3).filter(|&axis| restrained[axis] && !(is_planar && axis == 2)) {
        let mut at = [0.0, height, side];
        at[axis] += start[axis];
        let j = restraints.marker(GROUND, at, axis, &format!("hold_{}", body.name));
        restraints.prim(
            "INPLANE",
            [own.origin, j],
            format!("hold_{}_of_{}", DOFS[axis], body.name),
        );
    }
    let rotations: Vec<usize> = (0..3).filter(|&axis| restrained[3 + axis]).collect();
    restrain_rotations(own, &body.name, &rotations, is_planar, restraints);
    if let BodyMotion::Prescribed(profile) = &body.motion {
        restraints.out.push(
            Statement::new("MOTION", number(b))
                .named(plain(&format!("travel_{}", body.name)))
                .reference("I", own.origin)
                .reference("J", own.track)
                .flag("X")
                .flag("DISPLACEMENT")
                .function("FUNCTION", motion_expression(profile)),
        );
    }
}

/// Restrains the rotations of a body about the axes `rotations`; a PLANAR joint already restrains roll and yaw.
///
/// Three restrained rotations are an ORIENTATION, two are PARALLEL_AXES with the remaining free axis, and one is a
/// PERPENDICULAR of two axes.
fn restrain_rotations(
    own: &BodyPlan,
    name: &str,
    rotations: &[usize],
    is_planar: bool,
    restraints: &mut Restraints<'_>,
) {
    let [height, side] = own.position;
    let zero = [0.0, height, side];
    let pair = |axes: [usize; 2], restraints: &mut Restraints<'_>| {
        let i = restraints.marker(own.part, [0.0; 3], axes[0], name);
        let j = restraints.marker(GROUND, zero, axes[1], &format!("track_{name}"));
        [i, j]
    };
    match rotations[..] {
        [_, _, _] if !is_planar => restraints.prim(
            "ORIENTATION",
            [own.origin, own.track],
            format!("hold_turns_of_{name}"),
        ),
        [a, c] if !is_planar => {
            let markers = pair([3 - a - c; 2], restraints);
            restraints.prim(
                "PARALLEL_AXES",
                markers,
                format!("hold_two_turns_of_{name}"),
            );
        }
        [] => {}
        _ if is_planar && rotations.len() == 2 => {}
        _ => {
            // roll: y of the body stays perpendicular to z of the track; yaw: x to z; pitch: x to y
            let axis = rotations.last().copied().unwrap_or_default();
            let markers = pair([[1, 2], [0, 2], [0, 1]][axis], restraints);
            restraints.prim(
                "PERPENDICULAR",
                markers,
                format!("hold_{}_of_{name}", DOFS[3 + axis]),
            );
        }
    }
}

/// Position along the rail as an expression of TIME: the exact polynomial of each interval of the profile, selected
/// by nested IFs.
///
/// The position is continuous, so that a break may belong to either of its intervals. The IFs are nested as a binary
/// tree: a table of n rows needs log2 n comparisons.
pub(crate) fn motion_expression(profile: &Profile) -> String {
    let mut starts = vec![0.0];
    starts.extend_from_slice(profile.breaks());
    let pieces: Vec<(f64, String)> = (0..starts.len())
        .map(|k| {
            (
                starts[k],
                piece(profile, starts[k], starts.get(k + 1).copied()),
            )
        })
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

/// The polynomial x + v s + a s^2/2 + j s^3/6 of one interval, where s is the time since its start.
fn piece(profile: &Profile, start: f64, end: Option<f64>) -> String {
    let at = profile.at(start);
    // within an interval the acceleration is linear in time
    let middle = end.map_or(start + 1.0, |end| f64::midpoint(start, end));
    let jerk = (profile.at(middle).a - at.a) / (middle - start);
    let s = if start == 0.0 {
        "TIME".to_owned()
    } else {
        format!("(TIME-{})", expression_number(start))
    };
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
    fn a_speed_table_is_a_polynomial_in_each_interval() {
        let table = [[0.0, 0.0], [4.0, 6.0], [8.0, 6.0]];
        let profile = Profile::new(MotionKind::Speed, &table, 20.0, 0.0).expect("a valid table");
        assert_eq!(
            motion_expression(&profile),
            "IF(TIME-4.0:20.0+0.75*TIME**2,32.0+6.0*(TIME-4.0),IF(TIME-8.0:32.0+6.0*(TIME-4.0),\
             56.0+6.0*(TIME-8.0),56.0+6.0*(TIME-8.0)))"
        );
    }
}
