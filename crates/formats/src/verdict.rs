//! The verdict: one table of all checks of a design or of a run, and a list of what was not checked.

use std::collections::BTreeMap;
use std::fmt;

use practice::clause::{CodeClause, Evidence};
use practice::limit_choice::code_name;
use practice::scope::checks_beyond;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;

/// Whether a structure may be used as it is, as far as it was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub enum VerdictResult {
    /// A code, a limit or a strength was named, and every check that was done passed.
    #[serde(rename = "ok")]
    Ok,
    /// A check failed.
    #[serde(rename = "not ok")]
    NotOk,
    /// There was nothing to check against.
    #[serde(rename = "not checked")]
    NotChecked,
}

/// Whether a check passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CheckResult {
    /// What was applied does not exceed the limit.
    Pass,
    /// What was applied exceeds the limit.
    Fail,
}

/// What a check judges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckKind {
    /// The structure, against a limit or a strength.
    Structure,
    /// The calculation itself: the bound of its rounding errors, or its energy balance.
    Calculation,
}

/// A check: what was applied against its limit or strength.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct VerdictCheck {
    /// What is checked, such as `vertical deflection`.
    pub check: String,
    /// Design code; absent for limits of one's own and for the calculation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<String>,
    /// Edition of the code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edition: Option<String>,
    /// Clause of the code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clause: Option<String>,
    /// How the value of the code was confirmed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Limit in symbols, such as `L/600, at most 25 mm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Number of the load case, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub case: Option<usize>,
    /// Name of the rail.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rail: Option<String>,
    /// Number of the span of the plane of the check, from 1; 0 and one more than the last for overhangs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub span: Option<usize>,
    /// Rail coordinate of the largest value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Position of the first train.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<f64>,
    /// Time of the largest value in a run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Loads that were applied.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loads: Option<String>,
    /// Factors of these loads, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub factors: BTreeMap<String, f64>,
    /// The value.
    pub applied: f64,
    /// Its limit or strength.
    pub limit: f64,
    /// Unit of both; `1` for ratios.
    pub unit: String,
    /// Value over limit.
    pub utilisation: f64,
    /// Whether the value is the largest of chosen states only.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub sampled: bool,
    /// Whether the check passed.
    pub result: CheckResult,
    /// Why the value is an upper bound, so that a failed check may be one of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bound: Option<String>,
    /// Whether it judges the structure or the calculation.
    #[serde(skip)]
    pub kind: CheckKind,
}

impl VerdictCheck {
    /// A check of `applied` against `limit`, both not negative, without the members that do not apply to every check.
    #[must_use]
    pub fn new(
        check: impl Into<String>,
        applied: f64,
        limit: f64,
        unit: impl Into<String>,
    ) -> VerdictCheck {
        let utilisation = applied / limit;
        VerdictCheck {
            check: check.into(),
            code: None,
            edition: None,
            clause: None,
            source: None,
            formula: None,
            case: None,
            rail: None,
            span: None,
            x: None,
            position: None,
            time: None,
            loads: None,
            factors: BTreeMap::new(),
            applied,
            limit,
            unit: unit.into(),
            utilisation,
            sampled: false,
            result: if applied <= limit {
                CheckResult::Pass
            } else {
                CheckResult::Fail
            },
            bound: None,
            kind: CheckKind::Structure,
        }
    }

    /// The same check with code, edition, clause and source; a limit of one's own has a source alone.
    #[must_use]
    pub fn of_clause(self, clause: &CodeClause) -> VerdictCheck {
        let of_code = |text: &str| (clause.evidence != Evidence::Given).then(|| text.to_owned());
        VerdictCheck {
            code: of_code(clause.standard),
            edition: of_code(clause.edition),
            clause: of_code(clause.clause),
            source: Some(clause.evidence.words().to_owned()),
            ..self
        }
    }

    /// The check, unless it passed by a limit that no source confirms: such a limit can fail a structure, but not accept it.
    ///
    /// # Errors
    /// What stands among the checks that were not done instead.
    pub fn confirmed(self, clause: &CodeClause) -> Result<VerdictCheck, OmittedCheck> {
        if clause.evidence != Evidence::Memory || !self.passed() {
            return Ok(self);
        }
        let reason = format!(
            "the limit {} is from memory: no published source confirms it",
            self.formula.as_deref().unwrap_or_default()
        );
        Err(OmittedCheck::new(self.check, reason).of_code(clause.standard, Some(clause.clause)))
    }

    /// The result in a word: `pass`, `FAIL`, or `FAIL (bound)` where the value is an upper bound.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match (self.result, &self.bound) {
            (CheckResult::Pass, _) => "pass",
            (CheckResult::Fail, None) => "FAIL",
            (CheckResult::Fail, Some(_)) => "FAIL (bound)",
        }
    }

    /// Whether the check passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.result == CheckResult::Pass
    }

    /// Code and clause in one phrase, such as `EN 1993-6:2007, Table 7.2 a`; empty for limits of one's own.
    #[must_use]
    pub fn reference(&self) -> String {
        let parts = [self.code.as_deref(), self.clause.as_deref()];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Rail and span in one phrase, such as `rail north, span 2`; empty where neither is known.
    #[must_use]
    pub fn place(&self) -> String {
        let rail = self.rail.as_deref().map(rail_phrase);
        let span = self.span.map(|span| format!("span {span}"));
        let case = self.case.map(|case| format!("case {case}"));
        let parts = [rail, span, case];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// A rail in a sentence: `rail north`; the rail of a straight girder, whose name is `rail`, is `the rail`.
#[must_use]
pub fn rail_phrase(name: &str) -> String {
    if name == "rail" {
        "the rail".to_owned()
    } else if name.starts_with("rail") {
        name.to_owned()
    } else {
        format!("rail {name}")
    }
}

/// A check that was not done, with the reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct OmittedCheck {
    /// What was not checked.
    pub check: String,
    /// Design code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<String>,
    /// Clause of the code.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clause: Option<String>,
    /// Why it was not checked.
    pub reason: String,
}

impl OmittedCheck {
    /// A check of no code that was not done.
    #[must_use]
    pub fn new(check: impl Into<String>, reason: impl Into<String>) -> OmittedCheck {
        OmittedCheck {
            check: check.into(),
            code: None,
            clause: None,
            reason: reason.into(),
        }
    }

    /// The same check as one of a code.
    #[must_use]
    pub fn of_code(self, code: impl Into<String>, clause: Option<&str>) -> OmittedCheck {
        OmittedCheck {
            code: Some(code.into()),
            clause: clause.map(str::to_owned),
            ..self
        }
    }
}

/// The checks of a code that the program does not do.
#[must_use]
pub fn checks_beyond_program(code: &str) -> Vec<OmittedCheck> {
    let each = checks_beyond(code_name(code)).iter();
    each.map(|(check, clause)| {
        OmittedCheck::new(*check, "girderway does not do this check").of_code(code, *clause)
    })
    .collect()
}

impl fmt::Display for OmittedCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.check)?;
        let parts: Vec<&str> = [self.code.as_deref(), self.clause.as_deref()]
            .into_iter()
            .flatten()
            .collect();
        if !parts.is_empty() {
            write!(f, " ({})", parts.join(" "))?;
        }
        write!(f, ": {}", self.reason)
    }
}

/// All checks, worst first, and what was not checked.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Verdict {
    /// The result of all checks.
    pub result: VerdictResult,
    /// The checks by falling utilisation.
    pub checks: Vec<VerdictCheck>,
    /// What was not checked.
    pub not_checked: Vec<OmittedCheck>,
}

impl Verdict {
    /// Sorts the checks and draws the result from them.
    ///
    /// ```
    /// use formats::verdict::{VerdictCheck, Verdict, VerdictResult};
    ///
    /// let checks = vec![VerdictCheck::new("vertical deflection", 8.0, 10.0, "mm"), VerdictCheck::new("direct stress", 240.0, 235.0, "N/mm2")];
    /// let verdict = Verdict::new(checks, Vec::new());
    /// assert_eq!(verdict.result, VerdictResult::NotOk);
    /// assert_eq!(verdict.checks[0].check, "direct stress");
    /// assert_eq!(verdict.banner(), "NOT OK: direct stress, 102 % of the limit");
    /// ```
    #[must_use]
    pub fn new(mut checks: Vec<VerdictCheck>, not_checked: Vec<OmittedCheck>) -> Verdict {
        checks.sort_by(|a, b| b.utilisation.total_cmp(&a.utilisation));
        let judges = checks
            .iter()
            .any(|check| check.kind == CheckKind::Structure);
        let result = if !checks.iter().all(VerdictCheck::passed) {
            VerdictResult::NotOk
        } else if judges {
            VerdictResult::Ok
        } else {
            VerdictResult::NotChecked
        };
        Verdict {
            result,
            checks,
            not_checked,
        }
    }

    /// Whether no check failed.
    #[must_use]
    pub fn within(&self) -> bool {
        self.result != VerdictResult::NotOk
    }

    /// Whether there was nothing to check against, or a check of a named code was not done.
    #[must_use]
    pub fn is_incomplete(&self) -> bool {
        self.result == VerdictResult::NotChecked
            || self.not_checked.iter().any(|one| one.code.is_some())
    }

    /// Of each check of each clause the one with the highest utilisation, in the order of utilisation.
    #[must_use]
    pub fn worst(&self) -> Vec<&VerdictCheck> {
        let mut out: Vec<&VerdictCheck> = Vec::new();
        for check in &self.checks {
            let same = |known: &&VerdictCheck| {
                (&known.check, &known.code, &known.clause)
                    == (&check.check, &check.code, &check.clause)
            };
            if !out.iter().any(same) {
                out.push(check);
            }
        }
        out
    }

    /// The verdict in one line, without a period.
    #[must_use]
    pub fn banner(&self) -> String {
        match self.result {
            VerdictResult::NotOk => {
                let worst = self.checks.iter().find(|check| !check.passed());
                worst.map_or_else(String::new, |check| {
                    let parts = [check.check.clone(), check.place(), check.reference()];
                    let parts: Vec<String> =
                        parts.into_iter().filter(|part| !part.is_empty()).collect();
                    format!(
                        "NOT OK: {}, {:.0} % of the limit",
                        parts.join(", "),
                        100.0 * check.utilisation
                    )
                })
            }
            VerdictResult::NotChecked => "NOT CHECKED: no code or limit is named".to_owned(),
            VerdictResult::Ok => {
                let structural = |check: &&VerdictCheck| check.kind == CheckKind::Structure;
                let done = self.checks.iter().filter(structural).count();
                let checks = if done == 1 { "check" } else { "checks" };
                let mut codes: Vec<(&str, usize)> = Vec::new();
                let named = self
                    .not_checked
                    .iter()
                    .filter_map(|one| one.code.as_deref());
                // An edition behind a colon names the same code.
                for code in named.map(code_name) {
                    match codes.iter_mut().find(|known| known.0 == code) {
                        Some(known) => known.1 += 1,
                        None => codes.push((code, 1)),
                    }
                }
                let mut out = format!("OK for {done} {checks}");
                for (code, count) in codes {
                    let checks = if count == 1 { "check" } else { "checks" };
                    out.push_str(&format!("; {count} {checks} of {code} not done"));
                }
                out
            }
        }
    }
}

/// Adds the definitions of a verdict to the JSON Schema of a summary.
pub fn add_definitions(schema: &mut Value) {
    let mut own = SchemaSettings::default()
        .for_serialize()
        .into_generator()
        .into_root_schema_for::<Verdict>()
        .to_value();
    let Some(root) = own.as_object_mut() else {
        return;
    };
    let others = root.remove("$defs").unwrap_or_default();
    root.retain(|key, _| !matches!(key.as_str(), "$schema" | "title"));
    schema["$defs"]["Verdict"] = own;
    for (name, one) in others.as_object().into_iter().flatten() {
        schema["$defs"][name] = one.clone();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_calculation_alone_is_no_verdict() {
        let own = VerdictCheck {
            kind: CheckKind::Calculation,
            ..VerdictCheck::new("error bound", 1e-14, 1e-6, "1")
        };
        let verdict = Verdict::new(vec![own], Vec::new());
        assert_eq!(verdict.result, VerdictResult::NotChecked);
        assert!(verdict.within() && verdict.is_incomplete());
    }

    #[test]
    fn ok_never_stands_alone_where_a_check_of_a_code_is_missing() {
        let one = OmittedCheck::new("welds", "not calculated").of_code("EN 1993-6:2007", None);
        let verdict = Verdict::new(
            vec![VerdictCheck::new("vertical deflection", 1.0, 2.0, "mm")],
            vec![one],
        );
        assert_eq!(verdict.result, VerdictResult::Ok);
        assert_eq!(
            verdict.banner(),
            "OK for 1 check; 1 check of EN 1993-6 not done"
        );
    }

    #[test]
    fn a_value_that_is_no_number_does_not_pass() {
        assert!(!VerdictCheck::new("vertical deflection", f64::NAN, 1.0, "m").passed());
    }
}
