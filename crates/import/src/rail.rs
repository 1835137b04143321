//! Rails along members that the user adds to a structure on the command line.

use std::str::FromStr;

use super::structure::{ImportedMember, ImportedRail, ImportedStructure};
use formats::vector::{dot, length, minus, parallel, unit};

/// A request for a rail, parsed from `NAME=12,23,30-35` or `NAME=SET`, optionally followed by `/offset=X,Y,Z` and
/// `/axis=X,Y,Z`.
#[derive(Clone, Debug, PartialEq)]
pub struct RailRequest {
    name: String,
    items: Vec<Item>,
    offset: [f64; 3],
    axis: Option<[f64; 3]>,
}

#[derive(Clone, Debug, PartialEq)]
enum Item {
    /// Range of element numbers, ends included.
    Elements([u64; 2]),
    /// Name of a set of members.
    Set(String),
}

/// Reads three numbers separated by commas.
///
/// # Errors
/// The text does not consist of three finite numbers.
pub fn triple(text: &str) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|part| part.is_finite()) => Ok([x, y, z]),
        _ => Err("must be three numbers, such as 0,0,1".to_owned()),
    }
}

impl FromStr for RailRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<RailRequest, String> {
        let example = "must be NAME=ELEMENTS, such as runway=12,23,30-35, or NAME=SET";
        let (name, rest) = text.split_once('=').ok_or(example)?;
        if name.is_empty() || name.contains('.') {
            return Err("the name of a rail must not be empty or contain dots".to_owned());
        }
        let mut parts = rest.split('/');
        let list = parts.next().unwrap_or_default();
        let items: Option<Vec<Item>> = list
            .split(',')
            .map(|item| Item::read(item.trim()))
            .collect();
        let mut asked = RailRequest {
            name: name.to_owned(),
            items: items.ok_or(example)?,
            offset: [0.0; 3],
            axis: None,
        };
        for part in parts {
            match part.split_once('=') {
                Some(("offset", value)) => {
                    asked.offset = triple(value).map_err(|why| format!("offset {why}"))?
                }
                Some(("axis", value)) => {
                    asked.axis = Some(triple(value).map_err(|why| format!("axis {why}"))?)
                }
                _ => return Err(format!("`/{part}` must be /offset=X,Y,Z or /axis=X,Y,Z")),
            }
        }
        Ok(asked)
    }
}

impl Item {
    fn read(text: &str) -> Option<Item> {
        if let Ok(id) = text.parse() {
            return Some(Item::Elements([id, id]));
        }
        if let Some((from, to)) = text.split_once('-')
            && let (Ok(from), Ok(to)) = (from.parse(), to.parse())
        {
            return Some(Item::Elements([from, to]));
        }
        (!text.is_empty()).then(|| Item::Set(text.to_owned()))
    }
}

/// Builds a rail along members.
///
/// The axis of the rail is the requested one. By default it is the horizontal component of the direction from the
/// middle of the first member to the middle of the last one, or, for a single member, from its end a to its end b.
/// The origin is the member end with the smallest coordinate along the axis, and the stations are at the points of
/// the members.
///
/// # Errors
/// A member does not exist, the axis is along the upward direction, or a member is perpendicular to the axis. The
/// error consists of a message and a hint.
pub fn rail_along_members(
    asked: &RailRequest,
    up: [f64; 3],
    structure: &ImportedStructure,
) -> Result<ImportedRail, [String; 2]> {
    let members = members(asked, structure)?;
    let middle = |member: usize| {
        let [a, b] = structure.ends(member);
        [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
    };
    let (Some(&first), Some(&last)) = (members.first(), members.last()) else {
        return Err([
            "contains no members".to_owned(),
            "specify elements or a set".to_owned(),
        ]);
    };
    let [a, b] = structure.ends(first);
    let along = if first == last {
        minus(b, a)
    } else {
        minus(middle(last), middle(first))
    };
    let hint = "specify it by /axis=X,Y,Z";
    let axis = asked
        .axis
        .or_else(|| horizontal(along, up))
        .and_then(unit)
        .filter(|axis| !parallel(*axis, up));
    let axis = axis.ok_or_else(|| {
        [
            "must have an axis that is not parallel to the upward direction".to_owned(),
            hint.to_owned(),
        ]
    })?;
    let mut ends: Vec<[f64; 3]> = Vec::new();
    for &member in &members {
        let ImportedMember { id, section, .. } = &structure.members[member];
        let section = structure.sections.get(*section);
        if let Some(section) = section.filter(|section| !section.missing.is_empty()) {
            let missing = section.missing.join(" and no ");
            return Err([
                format!(
                    "must not contain element {id}, because its section {} has no {missing}",
                    section.name
                ),
                "specify it: wheels load members between their ends".to_owned(),
            ]);
        }
        let [a, b] = structure.ends(member);
        if dot(minus(b, a), axis).abs() <= 1e-9 * length(minus(b, a)) {
            let id = structure.members[member].id;
            return Err([
                format!("must not contain element {id}, which is perpendicular to it"),
                "omit elements along which no wheel can run, or specify the axis by /axis=X,Y,Z"
                    .to_owned(),
            ]);
        }
        ends.extend([a, b]);
    }
    let origin = ends
        .iter()
        .copied()
        .min_by(|a, b| dot(minus(*a, *b), axis).total_cmp(&0.0))
        .unwrap_or(a);
    let place = |at: [f64; 3]| dot(minus(at, origin), axis);
    let range = ends.iter().map(|end| place(*end)).fold(0.0, f64::max);
    let mut stations: Vec<f64> = members
        .iter()
        .flat_map(|member| structure.members[*member].points)
        .map(|point| place(structure.points[point].at).clamp(0.0, range))
        .collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup_by(|b, a| *b - *a <= 1e-9 * range);
    if stations.iter().any(|station| !station.is_finite()) || range <= 0.0 {
        return Err([
            "must have coordinates within the range of double precision".to_owned(),
            hint.to_owned(),
        ]);
    }
    Ok(ImportedRail {
        name: asked.name.clone(),
        origin,
        axis,
        members,
        offset: asked.offset,
        stations,
    })
}

/// Component of a direction normal to `up`; `None` if its length is at most a tenth of that of the direction.
fn horizontal(along: [f64; 3], up: [f64; 3]) -> Option<[f64; 3]> {
    let up = unit(up)?;
    let rise = dot(along, up);
    let horizontal = minus(along, up.map(|part| part * rise));
    (length(horizontal) > 0.1 * length(along)).then_some(horizontal)
}

/// Members of a rail in the order of the request, without duplicates.
fn members(asked: &RailRequest, structure: &ImportedStructure) -> Result<Vec<usize>, [String; 2]> {
    let mut members: Vec<usize> = Vec::new();
    let mut named = vec![false; structure.members.len()];
    for item in &asked.items {
        let found: Vec<usize> = match item {
            Item::Elements([from, to]) => (0..structure.members.len())
                .filter(|&index| (from..=to).contains(&&structure.members[index].id))
                .collect(),
            Item::Set(name) => {
                let set = structure
                    .cell_sets
                    .iter()
                    .find(|(known, _)| known.eq_ignore_ascii_case(name));
                set.map(|(_, set)| set.clone()).unwrap_or_default()
            }
        };
        if found.is_empty() {
            let names: Vec<&str> = structure
                .cell_sets
                .iter()
                .map(|(name, _)| name.as_str())
                .collect();
            let what = match item {
                Item::Elements([from, to]) if from == to => {
                    format!("refers to element {from}, which is not a member")
                }
                Item::Elements([from, to]) => {
                    format!("refers to elements {from}-{to}, none of which is a member")
                }
                Item::Set(name) => format!("refers to the set {name}, which does not exist"),
            };
            return Err([what, format!("known element sets: {}", names.join(", "))]);
        }
        for member in found {
            if !std::mem::replace(&mut named[member], true) {
                members.push(member);
            }
        }
    }
    Ok(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rails_are_read_from_the_command_line() {
        let asked: RailRequest = "runway=12,30-35,girder/offset=0,0.5,0/axis=1,0,0"
            .parse()
            .expect("a rail");
        assert_eq!(asked.name, "runway");
        assert_eq!(
            asked.items,
            [
                Item::Elements([12, 12]),
                Item::Elements([30, 35]),
                Item::Set("girder".to_owned())
            ]
        );
        assert_eq!(
            (asked.offset, asked.axis),
            ([0.0, 0.5, 0.0], Some([1.0, 0.0, 0.0]))
        );
        for text in [
            "runway",
            "=1",
            "a.b=1",
            "a=",
            "a=1,,2",
            "a=1/offset=1,2",
            "a=1/height=3",
            "a=1/axis=1,2,nan",
        ] {
            assert!(text.parse::<RailRequest>().is_err(), "{text}");
        }
    }
}
