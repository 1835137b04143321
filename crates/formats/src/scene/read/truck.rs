//! Trucks: the wheels that carry a body, their positions and their rail.

use super::rail::rail_named;
use crate::check::Check;
use crate::scene::raw::{RawNode, RawTruck};
use crate::scene::values::body::Body;
use crate::scene::values::scene::SceneRail;
use crate::scene::values::truck::{Node, Truck};
use crate::scene::values::wheel::WheelKind;
use crate::text::fault::{Fault, Faults, number};
use crate::text::names::{check_name, names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

pub(super) fn read(
    raw: &RawTruck,
    number: usize,
    at: &Place<'_>,
    bodies: &[Body],
    rails: &[SceneRail],
    wheels: &[WheelKind],
    check: &mut Check<'_>,
) -> Option<Truck> {
    let named = names(bodies, |body| &body.name);
    let body = named_or_only(&raw.body, &named, "body", ("body", at), check.faults);
    let kinds = names(wheels, |wheel| &wheel.name);
    let wheel = named_or_only(
        &raw.wheel,
        &kinds,
        "wheel type",
        ("wheel", at),
        check.faults,
    );
    let rail = read_rail(raw, at, body.map(|body| &bodies[body]), rails, check);
    let place = at.key("at");
    let position = check.vector(raw.at.unwrap_or_default(), &place, Dimension::LENGTH);
    let tree = read_tree(raw, at, check);
    if let Some(name) = &raw.name {
        check_name(name, &at.key("name"), check.faults);
    }
    let body = body?;
    let name = raw
        .name
        .clone()
        .unwrap_or_else(|| format!("{}.truck{number}", bodies[body].name));
    Some(Truck {
        name,
        body,
        rail: rail?,
        wheel: wheel?,
        at: position,
        tree,
    })
}

/// Number of wheels of a truck as written.
pub(super) fn count(raw: &RawTruck) -> usize {
    fn below(node: &RawNode) -> usize {
        match node {
            RawNode::Wheel(_) => 1,
            RawNode::Equaliser(ends) => ends.iter().map(below).sum(),
        }
    }
    raw.tree
        .as_ref()
        .map_or(1, |tree| tree.iter().map(below).sum())
}

/// Index of the item that the truck names under a key or, if it names none, of the only existing item.
fn named_or_only(
    name: &Option<String>,
    known: &[(&str, usize)],
    what: &str,
    (key, at): (&str, &Place<'_>),
    faults: &mut Faults,
) -> Option<usize> {
    match (name, known) {
        (None, [(_, only)]) => Some(*only),
        _ => {
            let name = faults.require(name, at, key)?;
            resolve(name, known, what, &at.key(key), faults)
        }
    }
}

fn read_rail(
    raw: &RawTruck,
    at: &Place<'_>,
    body: Option<&Body>,
    rails: &[SceneRail],
    check: &mut Check<'_>,
) -> Option<usize> {
    match (&raw.rail, body.map(|body| &body.track[..]), rails) {
        (Some(name), ..) => rail_named(name, rails, &at.key("rail"), check.faults),
        (None, Some([only]), _) => Some(*only),
        (None, _, [_]) => Some(0),
        // if there is no rail, the faults of the structures have already been reported
        (None, _, []) => None,
        (None, ..) => {
            let known: Vec<&str> = rails.iter().map(|rail| rail.name.as_str()).collect();
            let fault = Fault::new(at, "missing key `rail`");
            check
                .faults
                .add(fault.hint(format!("the scene has several: {}", known.join(", "))));
            None
        }
    }
}

fn read_tree(raw: &RawTruck, at: &Place<'_>, check: &mut Check<'_>) -> Vec<Node> {
    let Some(tree) = &raw.tree else {
        return vec![Node::Wheel(0.0)];
    };
    let place = at.key("tree");
    if tree.is_empty() {
        check.faults.add(
            Fault::new(&place, "must have at least one wheel")
                .got("an empty list")
                .of_value(),
        );
    }
    let nodes = tree.iter().enumerate().map(|(index, node)| {
        let at = place.index(index);
        let node = read_node(node, &at, check);
        let below = node.wheels();
        if below.iter().any(|(_, fraction)| (fraction - below[0].1).abs() > 1e-12) {
            let fault = Fault::new(&at, "all wheels under one equaliser must carry equal loads");
            let hint =
                "both ends need the same number of wheels; for unequal loads use a body that is `pinned`";
            check.faults.add(fault.got(fractions(&below)).hint(hint));
        }
        node
    });
    nodes.collect()
}

/// Fractions of the load of an equaliser that its wheels carry.
fn fractions(below: &[(f64, f64)]) -> String {
    below
        .iter()
        .map(|(_, fraction)| format!("1/{}", number(1.0 / fraction)))
        .collect::<Vec<_>>()
        .join(", ")
}

fn read_node(raw: &RawNode, at: &Place<'_>, check: &mut Check<'_>) -> Node {
    match raw {
        RawNode::Wheel(offset) => Node::Wheel(check.number(*offset, at, Dimension::LENGTH)),
        RawNode::Equaliser(children) => {
            let mut nodes = Vec::new();
            for (index, child) in children.iter().enumerate() {
                nodes.push(read_node(child, &at.index(index), check));
            }
            match <[Node; 2]>::try_from(nodes) {
                Ok(ends) => {
                    if ends[0].offset() == ends[1].offset() {
                        let fault = Fault::new(
                            at,
                            "the two ends of an equaliser must have different offsets",
                        )
                        .got(number(ends[0].offset()));
                        check.faults.add(fault);
                    }
                    Node::Equaliser(Box::new(ends))
                }
                Err(nodes) => {
                    let fault = Fault::new(at, "an equaliser must have two ends").got(nodes.len());
                    check.faults.add(fault.hint(
                        "numbers are wheels; nest lists in pairs, such as [[-6, -2], [2, 6]]",
                    ));
                    Node::Wheel(0.0)
                }
            }
        }
    }
}
