//! Irregularities of rails: steps, joints, dips, sinusoids and sampled profiles.

use std::f64::consts::FRAC_PI_2;

use sim::{Irregularity, Wave};
use splines::Axis;

use super::files::Files;
use super::profile::profile;
use super::rail::rail_among;
use crate::check::Check;
use crate::scene::raw::RawIrregularity;
use crate::spec::RailOutline;
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::Dimension;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Step,
    Joint,
    Dip,
    Sinusoid,
    Profile,
}

const KINDS: [(&str, Kind); 5] = [
    ("step", Kind::Step),
    ("joint", Kind::Joint),
    ("dip", Kind::Dip),
    ("sinusoid", Kind::Sinusoid),
    ("profile", Kind::Profile),
];

const DIRECTIONS: [(&str, Axis); 2] = [("vertical", Axis::Vertical), ("lateral", Axis::Lateral)];

impl Kind {
    /// Keys in addition to `rail`, `direction` and `kind`.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Kind::Step => &["x", "height"],
            Kind::Joint | Kind::Dip => &["x", "depth", "length"],
            Kind::Sinusoid => &["amplitude", "length", "phase", "range"],
            Kind::Profile => &["rows", "file", "columns", "scale"],
        }
    }
}

/// Reads the sum of all irregularities of each rail; empty if there are none.
pub(super) fn read(
    raw: &[RawIrregularity],
    rails: &[RailOutline],
    at: &Place<'_>,
    files: &mut Files<'_>,
    check: &mut Check<'_>,
) -> Vec<Irregularity> {
    if raw.is_empty() {
        return Vec::new();
    }
    let mut sums = vec![Irregularity::default(); rails.len()];
    for (index, raw) in raw.iter().enumerate() {
        let at = at.index(index);
        let rail = rail_among(raw.rail.as_ref(), rails, &at, check);
        let axis = match &raw.direction {
            Some(word) => check.faults.one_of(word, &at.key("direction"), &DIRECTIONS),
            None => Some(Axis::Vertical),
        };
        let kind = check.faults.require(&raw.kind, &at, "kind");
        let kind = kind.and_then(|kind| check.faults.one_of(kind, &at.key("kind"), &KINDS));
        let (Some(rail), Some(axis), Some(kind)) = (rail, axis, kind) else {
            continue;
        };
        if refuse_foreign_keys(raw, kind, &at, check) {
            continue;
        }
        let faults = check.faults.0.len();
        let shape = match kind {
            Kind::Profile => profile(raw, &at, files, check).map(|rows| table(axis, &rows)),
            Kind::Sinusoid => Some(sinusoid(raw, axis, &rails[rail], &at, check)),
            Kind::Step | Kind::Joint | Kind::Dip => {
                local(raw, kind, axis, &rails[rail], &at, check)
            }
        };
        if faults < check.faults.0.len() {
            continue;
        }
        match shape {
            Some(Ok(shape)) => sums[rail] = sums[rail].plus(&shape),
            Some(Err(error)) => check.faults.add(Fault::new(&at, error.to_string())),
            None => {}
        }
    }
    sums
}

/// Rejects keys that belong to other kinds and returns whether there are any.
fn refuse_foreign_keys(
    raw: &RawIrregularity,
    kind: Kind,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> bool {
    let given = [
        ("x", raw.x.is_some()),
        ("height", raw.height.is_some()),
        ("depth", raw.depth.is_some()),
        ("amplitude", raw.amplitude.is_some()),
        ("length", raw.length.is_some()),
        ("phase", raw.phase.is_some()),
        ("range", raw.range.is_some()),
        ("rows", raw.rows.is_some()),
        ("file", raw.file.is_some()),
        ("columns", raw.columns.is_some()),
        ("scale", raw.scale.is_some()),
    ];
    let word = KINDS
        .iter()
        .find(|(_, other)| *other == kind)
        .map_or("", |(word, _)| *word);
    let foreign = given
        .into_iter()
        .filter(|(key, given)| *given && !kind.keys().contains(key));
    let mut some = false;
    for (key, _) in foreign {
        let fault = Fault::new(
            &at.key(key),
            format!("`{key}` is not a key of the kind \"{word}\""),
        )
        .at_key();
        check
            .faults
            .add(fault.hint(format!("its keys are {}", kind.keys().join(", "))));
        some = true;
    }
    some
}

fn table(axis: Axis, rows: &[[f64; 2]]) -> Result<Irregularity, sim::Error> {
    if axis == Axis::Lateral {
        Irregularity::new(&[], rows)
    } else {
        Irregularity::new(rows, &[])
    }
}

/// Reads a step, a joint or a dip.
fn local(
    raw: &RawIrregularity,
    kind: Kind,
    axis: Axis,
    rail: &RailOutline,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Result<Irregularity, sim::Error>> {
    let (key, size) = if kind == Kind::Step {
        ("height", &raw.height)
    } else {
        ("depth", &raw.depth)
    };
    let x = check.faults.require(&raw.x, at, "x").copied();
    let size = check.faults.require(size, at, key).copied();
    let half = match kind {
        Kind::Step => 0.0,
        _ => {
            0.5 * check.required_positive(
                raw.length,
                at,
                "length",
                Dimension::LENGTH,
                "distance from end to end",
            )
        }
    };
    let (x, size) = (x?, size?);
    let x = check.number(x, &at.key("x"), Dimension::LENGTH);
    let size = check.number(size, &at.key(key), Dimension::LENGTH);
    on_rail([x - half, x + half], rail, &at.key("x"), check);
    Some(match kind {
        Kind::Joint => table(axis, &[[x - half, 0.0], [x, -size], [x + half, 0.0]]),
        Kind::Dip => {
            // the dip -size (1 + cos)/2 about x is the sum of a constant and a sinusoid, and is zero at both ends
            let (from, to) = (x - half, x + half);
            let low = -0.5 * size;
            let level = table(axis, &[[from, 0.0], [from, low], [to, low], [to, 0.0]]);
            let wave = Wave {
                amplitude: -low,
                length: 2.0 * half,
                phase: FRAC_PI_2,
                range: [from, to],
            };
            level.and_then(|level| Ok(level.plus(&Irregularity::wave(axis, wave)?)))
        }
        _ => table(axis, &[[x, 0.0], [x, size]]),
    })
}

fn sinusoid(
    raw: &RawIrregularity,
    axis: Axis,
    rail: &RailOutline,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Result<Irregularity, sim::Error> {
    let amplitude = check
        .faults
        .require(&raw.amplitude, at, "amplitude")
        .copied()
        .unwrap_or_default();
    let amplitude = check.number(amplitude, &at.key("amplitude"), Dimension::LENGTH);
    let length = check.required_positive(
        raw.length,
        at,
        "length",
        Dimension::LENGTH,
        "distance from crest to crest",
    );
    let phase = check.number(
        raw.phase.unwrap_or_default(),
        &at.key("phase"),
        Dimension::NUMBER,
    );
    let place = at.key("range");
    let range = match raw.range {
        None => [f64::NEG_INFINITY, f64::INFINITY],
        Some(given) => {
            let range = [0, 1].map(|k| check.number(given[k], &place.index(k), Dimension::LENGTH));
            if given[1] <= given[0] {
                let fault = Fault::new(
                    &place.index(1),
                    format!("must be above {}", number(given[0])),
                );
                check.faults.add(
                    fault
                        .got(number(given[1]))
                        .hint("first and last coordinate"),
                );
            }
            on_rail(range, rail, &place, check);
            range
        }
    };
    Irregularity::wave(
        axis,
        Wave {
            amplitude,
            length,
            phase,
            range,
        },
    )
}

fn on_rail(range: [f64; 2], rail: &RailOutline, at: &Place<'_>, check: &mut Check<'_>) {
    let [first, last] = rail.range;
    if range[0] < first || range[1] > last {
        let found = if range[0] == range[1] {
            number(range[0])
        } else {
            format!("from {} to {}", number(range[0]), number(range[1]))
        };
        let fault = Fault::new(at, format!("must lie on rail {}", rail.name)).got(found);
        check
            .faults
            .add(fault.hint(format!("the rail extends from {first} to {last}")));
    }
}
