//! Tables of maps of where methods fail.

use crate::error::Error;
use crate::map::{Map, Maps, Sums, VERDICTS};
use crate::number::{number, whole};

/// Why girderway refuses points of a map.
const REASONS: [(&str, &str); 1] = [(
    "short-element",
    "elements shorter than 4e-8 of the span: even double-doubles cannot certify 1e-6, and doubles are wrong from 3e-4 on",
)];
/// Why it is wrong with a warning.
const WARNINGS: [(&str, &str); 2] = [
    ("excitation", "told to read by AKISPL, whose forces do work in a closed loop: the energy audit tells"),
    ("steps", "told to take equal steps, far too long ones: the energy audit tells"),
];

/// Numbers known from elsewhere: what, as it is known, digits of ours, map, and its findings.
const KNOWN: [(&str, &str, usize, &str, &[&str]); 9] = [
    (
        "k G at midspan, one wheel and two 32 in apart",
        "10.93, 21.74",
        5,
        "contact",
        &[
            "one wheel: k times the largest eigenvalue of G at midspan",
            "truck: k times the largest eigenvalue of G at midspan",
        ],
    ),
    (
        "k G = 1: one wheel; the middle of two, ft from the support",
        "4.94, 3.18",
        4,
        "contact",
        &[
            "one wheel: distance from the support where it is 1",
            "truck: distance from the support where it is 1",
        ],
    ),
    (
        "AKISPL: largest growth of a bogie, 1/s",
        "0.325 (random search)",
        3,
        "excitation",
        &["akispl: largest growth without dampers, 1/s"],
    ),
    ("where, ft, or as far from the other support", "43.5 or 16.5", 4, "excitation", &["akispl: where"]),
    (
        "damper of each wheel to the ground that stops it, lbf s/ft",
        "1.8e5",
        3,
        "excitation",
        &["akispl: damper of each wheel to the ground that stops it"],
    ),
    (
        "work of a closed loop of 2.4e6 lbf on two wheels, ft lbf",
        "30,789 (printed table)",
        5,
        "excitation",
        &["akispl: work of a closed loop of two wheels' forces"],
    ),
    (
        "Willis and Stokes, beta 100, 25, 10, 5, 2: factor",
        "1.0103, 1.0454, 1.1416, 1.3227, 1.7799",
        5,
        "lift-off",
        &[
            "girderway: factor at beta 100",
            "girderway: factor at beta 25",
            "girderway: factor at beta 10",
            "girderway: factor at beta 5",
            "girderway: factor at beta 2",
        ],
    ),
    (
        "lift-off, beta 10, 5, 2: x/L",
        "0.967, 0.869, 0.919",
        3,
        "lift-off",
        &[
            "girderway: x/L of lift-off at beta 10",
            "girderway: x/L of lift-off at beta 5",
            "girderway: x/L of lift-off at beta 2",
        ],
    ),
    (
        "growth a span at 300 ft/s, damper to the ground",
        "2.24",
        4,
        "steps",
        &["growth a span at the highest speed, the damper's force past the rail"],
    ),
];

fn cell(points: usize) -> String {
    if points == 0 { String::new() } else { whole(points) }
}

/// Maps by methods: points by verdict.
pub fn table(own: &Maps) -> String {
    let mut out =
        "| map | method | points | right | silently wrong | diverges | warned | refused |\n|---|---|---|---|---|---|---|---|\n"
            .to_owned();
    for map in &own.maps {
        for method in &map.methods {
            let [right, silent, diverges, warned, refused] =
                VERDICTS.map(|verdict| cell(method.points(verdict)));
            let bold = if method.is_girderway { "**" } else { "" };
            out += &format!(
                "| `{}` | {bold}{}{bold} | {} | {right} | {silent} | {diverges} | {warned} | {refused} |\n",
                map.name,
                method.method,
                cell(method.all()),
            );
        }
    }
    out
}

/// A map a row: girderway beside the others.
pub fn short(own: &Maps) -> String {
    let mut out = "| map | girderway: points | right | warned | refused | silently wrong | others: points | silently wrong | diverge |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
    let row = |name: &str, maps: &[Map]| {
        let (ours, others) = (Sums::of(maps, true), Sums::of(maps, false));
        format!(
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            cell(ours.points),
            cell(ours.right),
            cell(ours.warned),
            cell(ours.refused),
            ours.silent + ours.diverging,
            cell(others.points),
            cell(others.silent),
            cell(others.diverging),
        )
    };
    for map in &own.maps {
        out += &row(&format!("`{}`", map.name), std::slice::from_ref(map));
    }
    out + &row("all", &own.maps)
}

/// All points in one paragraph.
pub fn total(own: &Maps) -> String {
    let (ours, others) = (Sums::of(&own.maps, true), Sums::of(&own.maps, false));
    let silent = ours.silent + ours.diverging;
    format!(
        "In all, {} points of girderway: {} right, {} wrong with a warning, {} refused, {} silently wrong. Of {} points of other methods {} are silently wrong and {} diverge.",
        whole(ours.points),
        whole(ours.right),
        whole(ours.warned),
        whole(ours.refused),
        if silent == 0 { "none".to_owned() } else { whole(silent) },
        whole(others.points),
        whole(others.silent),
        whole(others.diverging),
    )
}

fn told<'a>(of: &[(&str, &'a str)], map: &str) -> Option<&'a str> {
    of.iter().find(|(name, _)| *name == map).map(|(_, why)| *why)
}

/// Where girderway refuses or warns, and why that is right.
///
/// # Errors
/// Points refused or warned of for a reason that nobody wrote down.
pub fn refusals(own: &Maps) -> Result<String, Error> {
    let mut out =
        "| map | points | message of the first, of the last | why |\n|---|---|---|---|\n".to_owned();
    for map in &own.maps {
        let ours = Sums::of([map], true);
        let reason = |known: &[(&str, &'static str)]| {
            told(known, &map.name).ok_or_else(|| Error::Reason(map.name.clone()))
        };
        if ours.warned > 0 {
            out += &format!("| `{}` | {} warned | | {} |\n", map.name, ours.warned, reason(&WARNINGS)?);
        }
        if ours.refused > 0 {
            let messages = map.methods.iter().filter(|own| own.is_girderway).flat_map(|own| &own.messages);
            let all: Vec<&str> = messages.map(|own| own.message.as_str()).collect();
            let ends = match all.as_slice() {
                [] => String::new(),
                [only] => (*only).to_owned(),
                [first, .., last] => format!("{first}; {last}"),
            };
            out +=
                &format!("| `{}` | {} refused | {ends} | {} |\n", map.name, ours.refused, reason(&REASONS)?);
        }
    }
    Ok(out)
}

/// Numbers known from elsewhere beside those found.
///
/// # Errors
/// A number that the maps do not have.
pub fn numbers(own: &Maps) -> Result<String, Error> {
    let mut out = "| number | published or found elsewhere | here |\n|---|---|---|\n".to_owned();
    for (what, known, digits, map, findings) in KNOWN {
        let found = own.maps.iter().find(|own| own.name == map);
        let mut cells = Vec::new();
        for finding in findings {
            let value = found.and_then(|map| map.found.iter().find(|own| own.what == *finding));
            let value = value.ok_or_else(|| Error::Reason(format!("{map}: {finding}")))?.value;
            cells.push(number(value, digits));
        }
        out += &format!("| {what} | {known} | {} |\n", cells.join(", "));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::{numbers, refusals, total};
    use crate::map::Maps;

    fn maps(name: &str, counts: &Value) -> Maps {
        let method = json!({ "method": "m", "is_girderway": true, "counts": counts, "messages": [] });
        let maps = json!([{ "name": name, "found": [], "methods": [method] }]);
        serde_json::from_value(json!({ "command": "c", "maps": maps })).expect("maps")
    }

    #[test]
    fn points_that_are_silently_wrong_are_told() {
        let told = total(&maps("contact", &json!({ "right": 2, "silently wrong": 1, "diverges": 3 })));
        assert!(
            told.starts_with(
                "In all, 6 points of girderway: 2 right, 0 wrong with a warning, 0 refused, 4 silently"
            ),
            "{told}"
        );
    }

    #[test]
    fn refusals_without_a_reason_and_numbers_that_are_not_there_make_no_page() {
        assert!(refusals(&maps("short-element", &json!({ "refused": 2 }))).is_ok());
        assert!(refusals(&maps("contact", &json!({ "refused": 2 }))).is_err());
        assert!(refusals(&maps("contact", &json!({ "wrong, with a warning": 2 }))).is_err());
        assert!(numbers(&maps("contact", &json!({}))).is_err());
    }
}
