//! The result of a check as a table of text and as JSON.

use serde_json::{Map, Value, json};

use super::{COMPONENTS, CheckReport};

impl CheckReport {
    /// The lines of a table.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let count = &self.states;
        let mut lines = vec![
            format!(
                "{} states: all wheels are loaded in {}, none in {}; flanges touch in {}, wheels slide in {}",
                count.all, count.loaded, count.off, count.flange, count.slide
            ),
            format!(
                "{:<34} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8}",
                "difference / largest force", "states", "FX", "FY", "FZ", "TX", "TZ", "limit"
            ),
        ];
        for row in &self.forces {
            let [fx, fy, fz, tx, _, tz] = row.worst;
            let limit = row
                .limit
                .map_or_else(|| "-".to_owned(), |limit| format!("{limit:.0e}"));
            lines.push(format!(
                "{:<34} {:>7} {fx:>9.1e} {fy:>9.1e} {fz:>9.1e} {tx:>9.1e} {tz:>9.1e} {limit:>8}",
                row.what, row.states
            ));
            if let Some((why, count)) = &row.failed {
                lines.push(format!(
                    "  the deck could not be solved at {count} of these states: {why}"
                ));
            }
        }
        match &self.path {
            None => lines.push("no quasi-static path: a body is free along its rail".to_owned()),
            Some(path) => {
                let [height, force] = path.relative();
                lines.push(format!(
                    "quasi-static path, {} positions: heights differ by {height:.1e} of the largest, forces by \
                     {force:.1e}; limit {:.0e}",
                    path.places,
                    path.limit()
                ));
                lines.extend(path.failed.as_ref().map(|why| format!("  {why}")));
            }
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
                let worst = COMPONENTS.iter().zip(row.worst);
                let worst: Map<String, Value> = worst
                    .map(|(name, worst)| ((*name).to_owned(), json!(worst)))
                    .collect();
                let failed = row
                    .failed
                    .as_ref()
                    .map(|(why, count)| json!({ "why": why, "count": count }));
                json!({
                    "what": row.what, "states": row.states, "asked": row.limit, "difference": worst,
                    "largest_force": row.largest, "failed": failed, "holds": row.holds(),
                })
            })
            .collect();
        let path = self.path.as_ref().map(|path| {
            let [height, force] = path.relative();
            json!({
                "places": path.places, "asked": path.limit(), "height": height, "force": force,
                "failed": path.failed, "holds": path.holds(),
            })
        });
        let count = &self.states;
        json!({
            "format": "girderway-deck-check/1", "holds": self.holds(),
            "states": {
                "all": count.all, "pressing": count.loaded, "off": count.off, "flange": count.flange,
                "slide": count.slide,
            },
            "forces": rows, "path": path,
        })
    }
}
