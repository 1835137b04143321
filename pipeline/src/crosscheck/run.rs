//! Running the other code and comparing.

use super::environment::{Environment, tail};
use super::error::Error;
use super::girder::{Girder, Quantity};
use super::outcome::{Difference, Outcome};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::io::Write;
use std::process::{Command, Stdio};

const SCRIPT: &str = include_str!("../../../fea/scikit_fem_girder.py");

/// A square grid: row deflection, column load.
pub type Grid = Vec<Vec<f64>>;

/// What the script answers.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Answer {
    /// Versions by package.
    pub versions: BTreeMap<String, String>,
    /// Finite elements used.
    pub elements: String,
    /// Grids by name; absent where a stiffness is unknown.
    pub influence: BTreeMap<String, Option<Grid>>,
}

/// Influence grids of a girder from scikit-fem.
///
/// # Errors
/// For an unusable girder, and where Python, its environment or the script fails.
pub fn influence(
    girder: &Girder,
    environment: &Environment,
    say: &mut dyn FnMut(&str),
) -> Result<Answer, Error> {
    girder.check()?;
    let python = environment.prepare(say)?;
    let missing = |source| Error::NoPython { program: python.clone(), source };
    let mut child = Command::new(&python)
        .args(["-I", "-c", SCRIPT])
        // One thread: the systems are small, and the sums keep their order.
        .envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1")))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(missing)?;
    let question = serde_json::to_vec(girder)?;
    // The script reads all before it writes; a script that died early is reported by its exit status.
    let written = child.stdin.take().map(|mut pipe| pipe.write_all(&question));
    let output = child.wait_with_output().map_err(missing)?;
    if !output.status.success() || !matches!(written, Some(Ok(()))) {
        return Err(Error::Script { output: tail(&output) });
    }
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// Compares influence grids of a girder with those of scikit-fem, entry by entry.
///
/// `ours` holds stations x stations grids; `tolerance` is relative to the largest entry of a grid. Where
/// nothing can be compared, the outcome is empty and does not agree.
///
/// # Errors
/// As [`influence`]; [`Error::Shape`] and [`Error::NotFinite`] for grids that cannot be compared.
pub fn crosscheck(
    girder: &Girder,
    ours: &[(Quantity, Grid)],
    tolerance: f64,
    environment: &Environment,
    say: &mut dyn FnMut(&str),
) -> Result<Outcome, Error> {
    girder.check()?;
    check(ours, girder.stations.len())?;
    let answer = influence(girder, environment, say)?;
    let theirs: Vec<(Quantity, Grid)> = Quantity::ALL
        .into_iter()
        .filter_map(|q| Some((q, answer.influence.get(q.name())?.clone()?)))
        .collect();
    check(&theirs, girder.stations.len())?;
    let version = answer.versions.get("scikit-fem").map_or("", String::as_str);
    let (differences, skipped) = compare(ours, &theirs, &girder.stations);
    Ok(Outcome {
        code: format!("scikit-fem {version}"),
        elements: answer.elements,
        tolerance,
        differences,
        skipped,
    })
}

fn check(grids: &[(Quantity, Grid)], stations: usize) -> Result<(), Error> {
    for (quantity, grid) in grids {
        let quantity = *quantity;
        if grid.len() != stations || grid.iter().any(|row| row.len() != stations) {
            return Err(Error::Shape { quantity, stations });
        }
        for (row, values) in grid.iter().enumerate() {
            if let Some(column) = values.iter().position(|v| !v.is_finite()) {
                return Err(Error::NotFinite { quantity, row, column });
            }
        }
    }
    Ok(())
}

/// Differences of the grids that both sides have, and the quantities that only one has.
pub(super) fn compare(
    ours: &[(Quantity, Grid)],
    theirs: &[(Quantity, Grid)],
    stations: &[f64],
) -> (Vec<Difference>, Vec<Quantity>) {
    let find = |side: &'_ [(Quantity, Grid)], q| side.iter().position(|(other, _)| *other == q);
    let largest = |q| {
        let grid = find(theirs, q).map(|i| &theirs[i].1);
        grid.into_iter().flatten().flatten().fold(0.0, |a: f64, v| a.max(v.abs()))
    };
    let (mut differences, mut skipped) = (Vec::new(), Vec::new());
    for quantity in Quantity::ALL {
        let (a, b) = match (find(ours, quantity), find(theirs, quantity)) {
            (Some(i), Some(j)) => (&ours[i].1, &theirs[j].1),
            (None, None) => continue,
            _ => {
                skipped.push(quantity);
                continue;
            }
        };
        let scale = match quantity.direct() {
            [a, b] if a == b => largest(a),
            [a, b] => match (largest(a), largest(b)) {
                (a, b) if a > 0.0 && b > 0.0 => (a * b).sqrt(),
                _ => largest(quantity),
            },
        };
        let mut worst =
            Difference { quantity, entries: 0, scale, at: [0.0; 2], ours: 0.0, theirs: 0.0, relative: -1.0 };
        for (i, (row, other)) in a.iter().zip(b).enumerate() {
            for (j, (ours, theirs)) in row.iter().zip(other).enumerate() {
                worst.entries += 1;
                let apart = (ours - theirs).abs();
                let relative = if apart == 0.0 { 0.0 } else { apart / scale };
                if relative > worst.relative {
                    worst = Difference {
                        at: [stations[i], stations[j]],
                        ours: *ours,
                        theirs: *theirs,
                        relative,
                        ..worst
                    };
                }
            }
        }
        if worst.entries > 0 {
            differences.push(worst);
        }
    }
    (differences, skipped)
}
