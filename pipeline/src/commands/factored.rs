//! `girderway splines --form factored`: curves whose products sum to G.

use serde_json::{Map, Value, json};
use splines::{ExactSurface, Rank};

use crate::cli::SplinesArgs;
use crate::exit::Failure;
use crate::progress::Progress;
use formats::grid::GridRail;
use formats::tables::{self, TableSet};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Input;

/// Converts tables to the factored form. Its error is printed to standard error and added to `summary`.
///
/// # Errors
/// The tables have no factored form.
pub(super) fn factored(
    args: &SplinesArgs,
    set: &TableSet,
    exact: Option<&(ExactSurface, Vec<GridRail>)>,
    input: &Input,
    progress: &Progress,
    summary: &mut Map<String, Value>,
) -> Result<TableSet, Failure> {
    let rank = match (args.rank, args.tolerance.filter(|_| args.reading.is_none())) {
        (Some(rank), _) => Rank::Count(usize::from(rank)),
        (None, Some(tolerance)) => Rank::Tolerance(tolerance),
        (None, None) => Rank::Full,
    };
    let refused = |why: tables::FactorError| {
        Failure::from(Diagnostic::of_file(
            &input.display_name,
            format!("has no factored form: {why}"),
        ))
    };
    let factoring = tables::factor(&tables::expand(set), rank).map_err(refused)?;
    for id in &factoring.skipped {
        progress.say(&format!(
            "note: SPLINE/{id} is omitted: it is zero or has fewer than four stations"
        ));
    }
    let ranks: Vec<String> = factoring
        .ranks
        .iter()
        .map(|[kept, of]| format!("{kept} of {of}"))
        .collect();
    progress.say(&format!("factored form: {} products", ranks.join(", ")));
    progress.say(&format!(
        "  error at the stations: {}",
        factoring.stations.message()
    ));
    let between = exact.and_then(|(surface, rails)| factoring.deviation_from(surface, rails));
    match &between {
        Some(found) => progress.say(&format!(
            "  error against the exact surface: {}",
            found.message()
        )),
        None => progress.say("  error between stations: unknown (needs a grid file)"),
    }
    let ranks: Vec<Value> = factoring
        .ranks
        .iter()
        .map(|[kept, of]| json!({ "retained": kept, "of": of }))
        .collect();
    let between = between.map(|found| found.json());
    let object = json!({ "ranks": ranks, "at_stations": factoring.stations.json(), "against_surface": between });
    summary.insert("factored".into(), object);
    Ok(factoring.set)
}
