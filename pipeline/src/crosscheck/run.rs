//! Execution of another code and comparison of its grids.

use super::environment::Environment;
use super::error::Error;
use super::girder::PlainGirder;
use super::outcome::{BlockDifference, PeerOutcome};
use super::peer::{FLOOR, Peer, PeerAnswer, PeerMeasure, PlainGrid, Station};
use formats::grid::block::GridBlock;
use serde::Serialize;

/// Computes the influence grids of a girder with scikit-fem.
///
/// # Errors
/// The girder is invalid, or Python, its environment or the script fails.
pub fn influence(
    girder: &PlainGirder,
    environment: &Environment,
    say: &mut dyn FnMut(&str),
) -> Result<PeerAnswer, Error> {
    girder.check()?;
    Peer::ScikitFem.ask(girder, environment, say)
}

/// Compares influence grids of a girder with those of scikit-fem, entry by entry.
///
/// `ours` contains grids of size stations x stations; `tolerance` is relative to the largest entry of a grid. If no
/// grid can be compared, the outcome is empty and does not agree.
///
/// # Errors
/// The errors of [`influence`]; [`Error::Shape`] and [`Error::NotFinite`] for grids that cannot be compared.
pub fn crosscheck(
    girder: &PlainGirder,
    ours: &[(GridBlock, PlainGrid)],
    tolerance: f64,
    environment: &Environment,
    say: &mut dyn FnMut(&str),
) -> Result<PeerOutcome, Error> {
    girder.check()?;
    let stations: Vec<Station> = girder.stations.iter().map(|x| (0, *x)).collect();
    let mut outcome = ask(Peer::ScikitFem, girder, ours, &stations, environment, say)?;
    outcome.tolerance = tolerance;
    outcome.own_tolerances.clear();
    Ok(outcome)
}

/// Runs a code and compares its grids with `ours`, entry by entry.
///
/// `ours` contains grids at all `stations`; the other code may return grids at some of them. `question` is the input
/// of its script.
///
/// # Errors
/// The errors of [`Peer::ask`]; [`Error::Shape`], [`Error::NotFinite`] and [`Error::Stations`] for grids that cannot
/// be compared.
pub fn ask(
    peer: Peer,
    question: &impl Serialize,
    ours: &[(GridBlock, PlainGrid)],
    stations: &[Station],
    environment: &Environment,
    say: &mut dyn FnMut(&str),
) -> Result<PeerOutcome, Error> {
    check(ours, stations.len())?;
    let answer = peer.ask(question, environment, say)?;
    let mut theirs: Vec<(GridBlock, PlainGrid)> = GridBlock::ALL
        .into_iter()
        .filter_map(|q| Some((q, answer.influence.get(q.name())?.clone()?)))
        .collect();
    let chosen = answer
        .stations
        .clone()
        .unwrap_or_else(|| (0..stations.len()).collect());
    if chosen.iter().any(|index| *index >= stations.len()) {
        return Err(Error::Stations { code: peer.name() });
    }
    let places: Vec<Station> = chosen.iter().map(|index| stations[*index]).collect();
    check(&theirs, places.len())?;
    let ours = part(ours, &chosen);
    let (differences, skipped) = compare(&ours, &theirs, &places, peer.measure());
    theirs.retain(|(quantity, _)| !skipped.contains(quantity));
    let version = |name: &str| answer.versions.get(name).map_or("", String::as_str);
    let code = match peer {
        Peer::Solid => {
            format!(
                "gmsh {} and scikit-fem {}",
                version("gmsh"),
                version("scikit-fem")
            )
        }
        _ => format!("{} {}", peer.name(), version(peer.name())),
    };
    Ok(PeerOutcome {
        peer,
        code,
        elements: answer.elements,
        theory: None,
        tolerance: answer.tolerance.unwrap_or(peer.tolerance()),
        own_tolerances: GridBlock::ALL
            .into_iter()
            .filter_map(|q| Some((q, *answer.tolerances.get(q.name())?)))
            .filter(|(_, own)| own.is_finite())
            .collect(),
        differences,
        skipped,
        stations: places,
        notes: answer.notes,
        theirs,
        chosen,
    })
}

/// Restricts grids to some of their stations.
#[must_use]
pub fn part(grids: &[(GridBlock, PlainGrid)], chosen: &[usize]) -> Vec<(GridBlock, PlainGrid)> {
    let pick = |row: &Vec<f64>| chosen.iter().map(|j| row[*j]).collect();
    grids
        .iter()
        .map(|(quantity, grid)| (*quantity, chosen.iter().map(|i| pick(&grid[*i])).collect()))
        .collect()
}

fn check(grids: &[(GridBlock, PlainGrid)], stations: usize) -> Result<(), Error> {
    for (quantity, grid) in grids {
        let quantity = *quantity;
        if grid.len() != stations || grid.iter().any(|row| row.len() != stations) {
            return Err(Error::Shape { quantity, stations });
        }
        for (row, values) in grid.iter().enumerate() {
            if let Some(column) = values.iter().position(|v| !v.is_finite()) {
                return Err(Error::NotFinite {
                    quantity,
                    row,
                    column,
                });
            }
        }
    }
    Ok(())
}

/// Scale of the relative difference of each entry of a grid: sqrt(`rows[i]` `columns[j]`), but at least `least`.
struct Scale {
    rows: Vec<f64>,
    columns: Vec<f64>,
    least: f64,
}

impl Scale {
    fn new(quantity: GridBlock, grids: &[(GridBlock, PlainGrid)], measure: PeerMeasure) -> Scale {
        let find = |q| {
            grids
                .iter()
                .find(|(known, _)| *known == q)
                .map(|(_, grid)| grid)
        };
        let largest = |q| {
            find(q)
                .into_iter()
                .flatten()
                .flatten()
                .fold(0.0, |a: f64, v: &f64| a.max(v.abs()))
        };
        let [row, column] = quantity.direct();
        let whole = match (largest(row), largest(column)) {
            (a, b) if a > 0.0 && b > 0.0 => (a * b).sqrt(),
            _ => largest(quantity),
        };
        let diagonal = |q| {
            find(q)
                .into_iter()
                .flat_map(|g| g.iter().enumerate().map(|(i, row)| row[i]))
        };
        let sides: [Vec<f64>; 2] = match measure {
            PeerMeasure::Largest => [Vec::new(), Vec::new()],
            PeerMeasure::Diagonal => [row, column].map(|q| diagonal(q).collect()),
        };
        let [rows, columns] = sides;
        let least = if measure == PeerMeasure::Largest || rows.is_empty() || columns.is_empty() {
            whole
        } else {
            FLOOR * whole
        };
        Scale {
            rows,
            columns,
            least,
        }
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        match (self.rows.get(i), self.columns.get(j)) {
            (Some(a), Some(b)) => (a.max(0.0) * b.max(0.0)).sqrt().max(self.least),
            _ => self.least,
        }
    }
}

/// Compares the grids that both codes have. Also returns the quantities that only one of them has.
pub(super) fn compare(
    ours: &[(GridBlock, PlainGrid)],
    theirs: &[(GridBlock, PlainGrid)],
    stations: &[Station],
    measure: PeerMeasure,
) -> (Vec<BlockDifference>, Vec<GridBlock>) {
    let find =
        |side: &'_ [(GridBlock, PlainGrid)], q| side.iter().position(|(other, _)| *other == q);
    let (mut differences, mut skipped) = (Vec::new(), Vec::new());
    for quantity in GridBlock::ALL {
        let (a, b) = match (find(ours, quantity), find(theirs, quantity)) {
            (Some(i), Some(j)) => (&ours[i].1, &theirs[j].1),
            (None, None) => continue,
            _ => {
                skipped.push(quantity);
                continue;
            }
        };
        let scale = Scale::new(quantity, theirs, measure);
        let mut worst = BlockDifference {
            relative: -1.0,
            ..BlockDifference::none(quantity)
        };
        let mut profile = Vec::with_capacity(a.len());
        let mut entries = 0;
        for (i, (row, other)) in a.iter().zip(b).enumerate() {
            let mut largest = 0.0_f64;
            for (j, (ours, theirs)) in row.iter().zip(other).enumerate() {
                entries += 1;
                let apart = (ours - theirs).abs();
                let by = scale.at(i, j);
                let relative = if apart == 0.0 { 0.0 } else { apart / by };
                largest = largest.max(relative);
                if relative > worst.relative {
                    let [at, load] = [stations[i], stations[j]];
                    worst = BlockDifference {
                        rails: [at.0, load.0],
                        at: [at.1, load.1],
                        scale: by,
                        ours: *ours,
                        theirs: *theirs,
                        relative,
                        ..BlockDifference::none(quantity)
                    };
                }
            }
            profile.push(largest);
        }
        if entries > 0 {
            differences.push(BlockDifference {
                entries,
                profile,
                ..worst
            });
        }
    }
    (differences, skipped)
}

/// Compares other grids of this program with the grids of the other code in `outcome`.
#[must_use]
pub fn again(outcome: &PeerOutcome, ours: &[(GridBlock, PlainGrid)]) -> Vec<BlockDifference> {
    compare(
        &part(ours, &outcome.chosen),
        &outcome.theirs,
        &outcome.stations,
        outcome.peer.measure(),
    )
    .0
}
