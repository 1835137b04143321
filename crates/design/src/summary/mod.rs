//! `summary.json` of a design.

use formats::design::{Design, DesignSection};
use formats::verdict::add_definitions;
use serde_json::{Map, Value, json};
use trains::{Governing, SpanDeflection, SpanExtreme};

use crate::detail_rows::add_details;
use crate::outcome::{DesignResult, FatigueLoads, LimitCheck, ReactionExtremes};
use crate::state_json::{add_state, train_names};
use crate::verdict::verdict;
use crate::words::{kind_word, plane_word, quantity_word, side_word};

/// Name and version of the format.
pub const FORMAT: &str = "girderway-design-summary/1";

/// The summary of a design as JSON.
#[must_use]
pub fn summary(design: &Design, result: &DesignResult) -> Value {
    let verdict = verdict(design, result);
    let mut extremes = Vec::new();
    let mut deflections = Vec::new();
    for (index, case) in result.cases.iter().enumerate() {
        let of = OfCase {
            design,
            number: index + 1,
            names: train_names(design, index),
        };
        extremes.extend(
            case.envelopes
                .extremes
                .iter()
                .map(|extreme| of.span(extreme)),
        );
        extremes.extend(
            case.reactions
                .iter()
                .flat_map(|reaction| of.reaction(reaction)),
        );
        let sections = design.sections.iter().zip(&case.sections);
        extremes.extend(sections.flat_map(|(section, found)| of.section(section, found)));
        deflections.extend(
            case.envelopes
                .deflections
                .iter()
                .map(|deflection| of.deflection(deflection)),
        );
    }
    let cases: Vec<Value> = design
        .cases
        .iter()
        .enumerate()
        .map(|(index, case)| {
            let factors: Map<String, Value> =
                case.factors.iter().map(|(name, factor)| (name.clone(), json!(factor))).collect();
            json!({
                "case": index + 1,
                "name": case.name,
                "trains": case.trains.iter().map(|&train| &design.trains[train].name).collect::<Vec<_>>(),
                "gap": case.gap,
                "factors": factors,
            })
        })
        .collect();
    let mut summary = json!({
        "format": FORMAT,
        "name": design.name,
        "status": "done",
        "units": design.units.json(),
        "spec": design.spec_file,
        "error_bound": result.error_bound,
        "within": verdict.within(),
        "verdict": verdict,
        "cases": cases,
        "extremes": extremes,
        "deflections": deflections,
        "limits": result.limits.iter().map(limit).collect::<Vec<_>>(),
        "left_out": result.left_out.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "warnings": result.warnings,
    });
    if !result.fatigue.is_empty() {
        summary["fatigue"] = json!(result.fatigue.iter().map(fatigue).collect::<Vec<_>>());
    }
    add_details(&mut summary, design, result);
    if !design.spec.notes.is_empty() {
        summary["notes"] = json!(design.spec.notes);
    }
    summary
}

/// The JSON Schema of the summary of a design.
///
/// ```
/// assert_eq!(design::summary_schema()["properties"]["format"]["const"], "girderway-design-summary/1");
/// ```
#[must_use]
pub fn summary_schema() -> Value {
    let mut schema: Value = serde_json::from_str(include_str!("schema.json"))
        .expect("the schema is JSON, as the test of this function shows");
    add_definitions(&mut schema);
    schema
}

struct OfCase<'a> {
    design: &'a Design,
    number: usize,
    names: Vec<String>,
}

impl OfCase<'_> {
    fn span(&self, extreme: &SpanExtreme) -> Value {
        let rail = &self.design.spec.rails()[extreme.rail].name;
        let g = &extreme.governing;
        let mut out = json!({
            "case": self.number,
            "rail": rail,
            "span": extreme.span,
            "quantity": quantity_word(extreme.quantity),
            "plane": plane_word(extreme.quantity),
            "kind": kind_word(extreme.is_max),
            "value": g.value + 0.0,
            "x": g.x + 0.0,
            "side": side_word(g.side),
            "dead": g.dead + 0.0,
        });
        add_state(&mut out, &self.names, g);
        out["bound"] = json!(extreme.bound + 0.0);
        let [moment, shear, deflection] = g.coincident.map(|value| value + 0.0);
        out["coincident"] = json!({ "moment": moment, "shear": shear, "deflection": deflection });
        out
    }

    fn reaction(&self, reaction: &ReactionExtremes) -> [Value; 2] {
        [0, 1].map(|k| {
            let g = &reaction.extremes[k];
            let mut out = json!({
                "case": self.number,
                "quantity": "reaction",
                "support": reaction.name.support,
                "direction": reaction.name.direction,
                "kind": kind_word(k == 0),
                "value": g.value + 0.0,
                "dead": g.dead + 0.0,
            });
            add_state(&mut out, &self.names, g);
            out
        })
    }

    fn section(&self, section: &DesignSection, found: &[Governing; 2]) -> [Value; 2] {
        [0, 1].map(|k| {
            let g = &found[k];
            let word = formats::spec::COMPONENTS
                .iter()
                .find(|(_, component)| *component == section.component);
            let mut out = json!({
                "case": self.number,
                "section": section.name,
                "quantity": word.map_or("", |(word, _)| word),
                "kind": kind_word(k == 0),
                "value": g.value + 0.0,
                "dead": g.dead + 0.0,
            });
            add_state(&mut out, &self.names, g);
            out
        })
    }

    fn deflection(&self, found: &SpanDeflection) -> Value {
        let g = &found.governing;
        let length = found.ends[1] - found.ends[0];
        let mut out = json!({
            "case": self.number,
            "rail": self.design.spec.rails()[found.rail].name,
            "span": found.span,
            "plane": plane_word(found.quantity),
            "relative": g.value + 0.0,
            "x": g.x + 0.0,
            "span_length": length,
        });
        if g.value != 0.0 && (length / g.value).is_finite() {
            out["ratio"] = json!((length / g.value).abs());
        }
        add_state(&mut out, &self.names, g);
        out
    }
}

fn fatigue(loads: &FatigueLoads) -> Value {
    let [normal, shear] = loads.lambda;
    let [crane, hoist] = loads.dynamic;
    json!({
        "train": loads.train,
        "lambda": { "normal": normal, "shear": shear },
        "factors": { "crane": crane, "hoist": hoist },
        "wheels": loads.wheels.iter().map(|[n, s]| json!({ "normal": n, "shear": s })).collect::<Vec<_>>(),
        "code": "EN 1991-3:2006, 2.12.1",
    })
}

fn limit(check: &LimitCheck) -> Value {
    let mut out = json!({
        "case": check.case,
        "rail": check.rail,
        "span": check.span,
        "code": check.clause.standard,
        "edition": check.clause.edition,
        "clause": check.clause.clause,
        "source": check.clause.evidence.words(),
        "quantity": check.quantity,
        "formula": check.formula,
        "loads": check.loads,
        "value": check.value,
        "limit": check.limit,
        "within": check.within(),
        "x": check.x,
    });
    if let Some([from, to]) = check.ends {
        out["from"] = json!(from + 0.0);
        out["to"] = json!(to + 0.0);
    }
    if check.is_sampled {
        out["sampled"] = json!(true);
    }
    out
}
