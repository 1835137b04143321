//! What holds bodies to their tracks: JOINT, JPRIM and MOTION statements.

use adams::{ArgumentValue, Statement};

use crate::model::plan::{DeckPlan, GROUND};
use crate::model::travel;
use crate::words::ids::{NextId, number};
use crate::words::name::plain;
use formats::scene::{Along, FREEDOMS};

/// Angles of a marker whose z points along x, y or z of its part.
const ALONG: [[f64; 3]; 3] = [[90.0, 90.0, 0.0], [0.0, -90.0, 0.0], [0.0, 0.0, 0.0]];

/// All of them; markers that they need are among them.
pub(crate) fn statements(plan: &DeckPlan<'_>, markers: &mut NextId) -> Vec<Statement> {
    let mut out = Vec::new();
    // axles have the first numbers
    let mut holds = Holds {
        joints: NextId::from(number(plan.wheels.len())),
        prims: NextId::from(1),
        markers,
        made: Vec::new(),
        out: &mut out,
    };
    for b in 0..plan.bodies.len() {
        holds.made.clear();
        hold(plan, b, &mut holds);
    }
    out
}

struct Holds<'a> {
    joints: NextId,
    prims: NextId,
    markers: &'a mut NextId,
    /// Markers made for the body at hand: part, axis, place, identifier.
    made: Vec<(u32, usize, [f64; 3], u32)>,
    out: &'a mut Vec<Statement>,
}

impl Holds<'_> {
    /// A marker on `part` at `at` whose z points along axis 0, 1 or 2.
    fn marker(&mut self, part: u32, at: [f64; 3], axis: usize, name: &str) -> u32 {
        let known = self.made.iter().find(|made| (made.0, made.1, made.2) == (part, axis, at));
        if let Some(made) = known {
            return made.3;
        }
        let id = self.markers.take();
        self.made.push((part, axis, at, id));
        let word = FREEDOMS[axis];
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

fn hold(plan: &DeckPlan<'_>, b: usize, holds: &mut Holds<'_>) {
    let (own, body) = (&plan.bodies[b], &plan.scene.bodies[b]);
    let name = &body.name;
    let [height, side] = own.datum;
    let start = plan.start.displacement[b];
    let prescribed = matches!(body.motion, Along::Prescribed(_));
    let mut held: [bool; 6] = std::array::from_fn(|i| !body.free[i]);
    held[0] = matches!(body.motion, Along::Held);
    let planar = held[2] && held[3] && held[4] && start[2] == 0.0;
    if planar {
        let id = holds.joints.take();
        holds.out.push(
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
        let j = holds.marker(GROUND, at, axis, &format!("hold_{name}"));
        holds.prim("INPLANE", [own.origin, j], format!("hold_{}_of_{name}", FREEDOMS[axis]));
    }
    let turns: Vec<usize> = (0..3).filter(|&axis| held[3 + axis]).collect();
    let both = |holds: &mut Holds<'_>, axis: usize| {
        let i = holds.marker(own.part, [0.0; 3], axis, name);
        let j = holds.marker(GROUND, zero, axis, &format!("track_{name}"));
        [i, j]
    };
    match turns[..] {
        [_, _, _] if !planar => {
            holds.prim("ORIENTATION", [own.origin, own.track], format!("hold_turns_of_{name}"))
        }
        [a, c] if !planar => {
            let pair = both(holds, 3 - a - c);
            holds.prim("PARALLEL_AXES", pair, format!("hold_two_turns_of_{name}"));
        }
        [] => {}
        _ if planar && turns.len() == 2 => {}
        _ => {
            // roll: the body's y keeps off z; yaw: its x keeps off z; pitch: its x keeps off y
            let axis = turns.last().copied().unwrap_or_default();
            let [own_axis, ground_axis] = [[1, 2], [0, 2], [0, 1]][axis];
            let i = holds.marker(own.part, [0.0; 3], own_axis, name);
            let j = holds.marker(GROUND, zero, ground_axis, &format!("track_{name}"));
            holds.prim("PERPENDICULAR", [i, j], format!("hold_{}_of_{name}", FREEDOMS[3 + axis]));
        }
    }
    if prescribed && let Along::Prescribed(profile) = &body.motion {
        holds.out.push(
            Statement::new("MOTION", number(b))
                .named(plain(&format!("travel_{name}")))
                .reference("I", own.origin)
                .reference("J", own.track)
                .flag("X")
                .flag("DISPLACEMENT")
                .function("FUNCTION", travel::expression(profile)),
        );
    }
}
