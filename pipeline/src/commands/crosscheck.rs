//! `girderway crosscheck`: the same girder in an independent FE code.

use fea::{Girder, Theory};

use crate::cli::{Crosscheck, Global};
use crate::crosscheck::{self, Environment};
use crate::exit::{Exit, Failure};
use crate::inputs::Inputs;
use crate::link;
use crate::output;
use crate::progress::Progress;
use crate::spec::Spec;

/// Largest difference, relative to the largest entry of a grid, that counts as agreement.
const TOLERANCE: f64 = 1e-9;

/// Solves the spec here and in scikit-fem and compares every grid, entry by entry.
///
/// # Errors
/// What is wrong with the spec; a structure that does not stand; a difference; nothing that could be compared.
pub fn run(args: &Crosscheck, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let (_, source) = Inputs::open(&args.spec)?;
    let spec = Spec::read(&source, None)?;
    let Some(girder) = spec.girder() else {
        let why = "nothing to compare: the cross-check takes straight girders, the short form of a spec";
        return Err(Failure::Differs(format!("{}: {why}", source.name)));
    };
    let solved = link::solve(&spec).map_err(|error| spec.refuse(&source, &error))?;
    let ours: Vec<_> = solved
        .grid
        .blocks
        .iter()
        .map(|(quantity, block)| {
            let rows = block.row_iter().map(|row| row.iter().copied().collect()).collect();
            (*quantity, rows)
        })
        .collect();
    let compared = Environment::of_user().and_then(|environment| {
        let mut say = |message: &str| progress.say(message);
        crosscheck::crosscheck(&stiffnesses(girder), &ours, TOLERANCE, &environment, &mut say)
    });
    let outcome = compared.map_err(|error| Failure::Differs(format!("nothing compared: {error}")))?;
    let text = if global.json { output::json(&outcome.json()) } else { outcome.table() };
    output::print(&text)?;
    Ok(if outcome.agrees() { Exit::Done } else { Exit::Differs })
}

/// A girder as plain stiffnesses.
fn stiffnesses(girder: &Girder) -> crosscheck::Girder {
    let sheared = girder.theory == Theory::Timoshenko;
    let shear = |area: Option<f64>| area.zip(girder.g).filter(|_| sheared).map(|(area, g)| g * area);
    crosscheck::Girder {
        spans: girder.spans.clone(),
        overhangs: girder.overhangs,
        stations: girder.stations.clone(),
        rail_height: girder.rail_height,
        axial: girder.area.map(|area| girder.e * area),
        bending_vertical: Some(girder.e * girder.i_vertical),
        bending_lateral: girder.i_lateral.map(|moment| girder.e * moment),
        torsion: girder.j.zip(girder.g).map(|(j, g)| g * j),
        shear_vertical: shear(girder.ka_vertical),
        shear_lateral: shear(girder.ka_lateral),
    }
}
