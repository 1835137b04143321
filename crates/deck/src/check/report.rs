//! The result of a check as a table of text and as JSON.

use serde_json::{Map, Value, json};

use super::{CheckReport, EquilibriumDifference, QUANTITIES, SweepDifference};

/// The vertical force among the quantities.
const DOWN: usize = 6;

impl CheckReport {
    /// The lines of a table.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let count = &self.states;
        // the vertical force is always shown, others where a digit differs
        let is_used = |k: usize| k == DOWN || { self.forces.iter().any(|row| row.worst[k] > 0.0) };
        let used: Vec<usize> = (0..QUANTITIES.len()).filter(|&k| is_used(k)).collect();
        let mut head = format!("{:<34} {:>7}", "difference / largest value", "states");
        for &k in &used {
            head += &format!(" {:>8}", QUANTITIES[k]);
        }
        let mut lines = vec![
            format!(
                "{} states: all wheels are loaded in {}, none in {}, each in at least {}; flanges touch in {}, wheels slide in {}",
                count.all, count.loaded, count.off, count.each, count.flange, count.slide
            ),
            format!("{head} {:>7}", "limit"),
        ];
        for row in &self.forces {
            let mut line = format!("{:<34} {:>7}", row.what, row.states);
            for &k in &used {
                line += &format!(" {:>8.1e}", row.worst[k]);
            }
            lines.push(format!("{line} {:>7.0e}", row.limit));
            if let Some((why, count)) = &row.failed {
                lines.push(format!(
                    "  deck: it could not be evaluated at {count} of these states: {why}"
                ));
            }
            for wrong in &row.wrong {
                lines.push(format!(
                    "  deck: {} gives {} = {:.9e}, the simulator {:.9e}, at t = {:.4} s",
                    wrong.statement, wrong.quantity, wrong.deck, wrong.simulator, wrong.time
                ));
            }
        }
        match &self.path {
            None => lines.push("no quasi-static path: a body is free along its rail".to_owned()),
            Some(path) => path_lines(path, &mut lines),
        }
        if self.missing_along > 0.0 {
            lines.push(format!(
                "  this form leaves out the force along the rail, F du/dx: up to {:.1e} of the largest force at these \
                 positions; the comparison leaves it out on both sides",
                self.missing_along
            ));
        }
        lines
    }

    /// The result as a JSON object.
    #[must_use]
    pub fn json(&self) -> Value {
        let rows: Vec<Value> = self
            .forces
            .iter()
            .map(|row| {
                let worst = QUANTITIES.iter().zip(row.worst);
                let worst: Map<String, Value> = worst
                    .map(|(name, worst)| ((*name).to_owned(), json!(worst)))
                    .collect();
                let failed = row
                    .failed
                    .as_ref()
                    .map(|(why, count)| json!({ "why": why, "count": count }));
                let wrong: Vec<Value> = row
                    .wrong
                    .iter()
                    .map(|one| {
                        json!({
                            "statement": one.statement, "quantity": one.quantity, "deck": one.deck,
                            "simulator": one.simulator, "time": one.time,
                        })
                    })
                    .collect();
                json!({
                    "wrong": wrong,
                    "what": row.what, "states": row.states, "asked": row.limit, "difference": worst,
                    "largest_force": row.largest, "failed": failed, "holds": row.holds(),
                })
            })
            .collect();
        let path = self.path.as_ref().map(|path| {
            let of = |one: &EquilibriumDifference| {
                json!({ "place": one.place, "height": one.height, "force": one.force })
            };
            json!({
                "places": path.places, "asked": of(&path.limit), "difference": of(&path.small),
                "finite": of(&path.finite), "estimate": of(&path.estimate), "known": of(&path.known()),
                "rotation": path.rotation, "ill_conditioned": path.ill_conditioned, "without_finite": path.far, "stopped": path.stopped, "causes": path.causes, "holds": path.holds(),
            })
        });
        let count = &self.states;
        json!({
            "format": "girderway-deck-check/1", "holds": self.holds(),
            "states": {
                "all": count.all, "pressing": count.loaded, "each": count.each, "off": count.off, "flange": count.flange,
                "slide": count.slide,
            },
            "forces": rows, "path": path, "missing_along": self.missing_along,
        })
    }
}

/// The lines of the quasi-static path.
fn path_lines(path: &SweepDifference, lines: &mut Vec<String>) {
    let (small, limit, finite, known) = (&path.small, &path.limit, &path.finite, path.known());
    lines.push(format!(
        "quasi-static path, {} positions: heights differ by {:.1e} of the largest (limit {:.1e}), forces by {:.1e} \
         (limit {:.1e})",
        path.places, small.height, limit.height, small.force, limit.force
    ));
    lines.push(format!(
        "  finite rotations as in ADAMS, up to {:.1e} rad, change heights by {:.1e} and forces by {:.1e}; estimated from \
         theta^2 and m g h theta: {:.1e} and {:.1e} (limit {:.1e} and {:.1e})",
        path.rotation,
        finite.height,
        finite.force,
        path.estimate.height,
        path.estimate.force,
        known.height,
        known.force
    ));
    if path.ill_conditioned > 0 {
        lines.push(format!(
            "  at {} of the positions rounding moves the equilibrium of the deck by more than 1e-8; every equation holds there to \
             within its rounding",
            path.ill_conditioned
        ));
    }
    if path.far > 0 {
        lines.push(format!(
            "  at {} of the positions no equilibrium with finite rotations is near; the comparison leaves them out",
            path.far
        ));
    }
    if small.place > limit.place {
        lines.push(format!(
            "  places along the rail differ by {:.1e}",
            small.place
        ));
    }
    if let Some(why) = &path.stopped {
        lines.push(format!("  the comparison ends at {why}"));
    }
    lines.extend(path.causes.iter().map(|why| format!("  {why}")));
}
