//! `girderway splines --reading --tolerance`: tables at the fewest stations that satisfy the tolerance.

use serde_json::{Map, Value};
use splines::{Axis, ExactSurface};

use crate::cli::SplinesArgs;
use crate::exit::Failure;
use crate::progress::Progress;
use formats::grid::block::GridBlock;
use formats::grid::{self, StationGrid};
use formats::text::fault::{Fault, Faults};
use formats::text::place::Place;
use formats::text::source::Source;
use study::stations::{self, StationGoal};
use study::table_quality::TableReadingMethod;

/// Returns the grid at the fewest stations that satisfy the tolerance. The stations are printed to standard error and
/// added to `summary`.
///
/// # Errors
/// The grid has no surface or not all requested directions, or no number of stations satisfies the tolerance.
pub(super) fn chosen(
    args: &SplinesArgs,
    (manner, tolerance): (TableReadingMethod, f64),
    source: &Source,
    (grid, surface): (&StationGrid, Option<&ExactSurface>),
    progress: &Progress,
    summary: &mut Map<String, Value>,
) -> Result<StationGrid, Failure> {
    let root = Place::root();
    let refuse = |fault: Fault| Failure::Input(source.diagnose(&Faults(vec![fault])));
    let Some(surface) = surface else {
        let fault = Fault::new(
            &root,
            "has no `surface` (exact influence function between stations)",
        );
        return Err(refuse(
            fault.hint("`girderway fea SPEC -o GRID.json` writes one"),
        ));
    };
    let mut axes: Vec<Axis> = args
        .directions
        .iter()
        .map(|direction| Axis::from(*direction))
        .collect();
    axes.sort_unstable();
    axes.dedup();
    if axes.is_empty() {
        axes = if manner == TableReadingMethod::Exact {
            vec![Axis::Vertical]
        } else {
            stations::usual(grid)
        };
    }
    for axis in &axes {
        let direct = GridBlock::ALL
            .into_iter()
            .find(|quantity| grid::axes(*quantity) == (*axis, *axis));
        if direct.is_none_or(|quantity| grid.block(quantity).is_none()) {
            let wrong = format!("has no {} grid", stations::word(*axis));
            return Err(refuse(Fault::new(&root.key("influence"), wrong)));
        }
    }
    let goal = StationGoal {
        method: manner,
        tolerance,
        axes,
    };
    let stage = progress.stage("stations");
    let found = stations::choose(grid, surface, &goal);
    drop(stage);
    let choice = found.map_err(|error| match error {
        splines::Error::TooFewStations { most, error } => Failure::Differs(format!(
            "{}: error {error:.2e} with the maximum of {most} stations; with shear, torsional or axial flexibility the \
             error of table interpolation decreases only linearly with the station spacing. Increase --tolerance, \
             choose another --reading, or restrict --directions",
            manner.word()
        )),
        splines::Error::NoBeamFit => refuse(
            Fault::new(&root.key("influence"), "is not that of a uniform beam in bending on rigid supports")
                .hint("the exact influence function cannot be derived from the tables; use this grid file, which contains it"),
        ),
        other => refuse(Fault::new(&root.key("surface"), other.to_string())),
    })?;
    for line in choice.lines(&goal) {
        progress.say(&line);
    }
    if let Value::Object(found) = choice.json(&goal) {
        summary.extend(found);
    }
    Ok(choice.grid)
}
