//! The verdict on a run: all its checks in one table, and what was not checked.

use formats::scene::{Analysis, Scene};
use formats::units::Dimension;
use formats::verdict::{CheckKind, OmittedCheck, Verdict, VerdictCheck, checks_beyond_program};
use practice::clause::Evidence;
use practice::limit_choice::code_name;
use practice::limits::{LimitLoads, LimitedDisplacement};
use trains::WITHOUT_WARPING;

use crate::case_result::CaseResult;
use crate::codes::{AllowableDisplacement, StaticDeflection};
use crate::fatigue::FatigueResult;
use crate::girders::GirderStress;
use crate::warning::{RESIDUAL, doubts};

/// Why limits of deflections have no value.
const NO_SPAN: &str = "no span of the runway that is defined carries wheels in the run";
/// Loads of the checks that look at the run itself.
const OF_THE_RUN: &str = "forces of the run";

/// All checks of a run, worst first, and what was not checked. Limits are those of the codes that `practice.code` names, and
/// those of `practice.limits`.
#[must_use]
pub fn verdict(scene: &Scene, outcome: &CaseResult) -> Verdict {
    let mut checks = Vec::new();
    let mut omitted = Vec::new();
    limits(scene, outcome, &mut checks, &mut omitted);
    drifts(scene, outcome, &mut checks, &mut omitted);
    let stresses = outcome.girders().stresses.rows.iter();
    checks.extend(stresses.filter_map(|found| of_stress(scene, found)));
    checks.extend(
        outcome
            .fatigue
            .iter()
            .filter_map(|found| of_fatigue(scene, found)),
    );
    if scene.analysis == Analysis::Dynamic {
        let residual = outcome.run.audit.residual().abs();
        checks.push(of_calculation(
            "residual of the energy balance".to_owned(),
            residual,
            RESIDUAL,
        ));
    }
    for (structure, bound) in &outcome.error_bounds {
        let what = format!("bound of the relative error of influence coefficients, {structure}");
        checks.push(of_calculation(what, *bound, fea::DEFAULT_ACCURACY));
    }
    omitted.extend(doubts(scene, &outcome.columns));
    omitted.extend(undetermined(scene, outcome));
    omitted.extend(own_without_value(scene, outcome));
    omitted.extend(not_judged(scene, outcome));
    Verdict::new(checks, omitted)
}

/// What depends on forces that the run does not determine.
fn undetermined(scene: &Scene, outcome: &CaseResult) -> Option<OmittedCheck> {
    let worst = outcome.undetermined.first()?;
    let dimension = outcome
        .peaks
        .iter()
        .find(|peak| peak.column == worst.quantity)?
        .dimension;
    let reason = format!(
        "{}: the extreme of {} {}, and so are the forces, stresses and deflections that follow from such \
         bounces",
        worst.reason,
        worst.range(),
        scene.units.label(dimension)
    );
    Some(OmittedCheck::new(
        "largest values of bounces, which are not determined",
        reason,
    ))
}

/// Limits of static deflections.
fn limits(
    scene: &Scene,
    outcome: &CaseResult,
    checks: &mut Vec<VerdictCheck>,
    omitted: &mut Vec<OmittedCheck>,
) {
    let Some(practice) = &scene.practice else {
        return;
    };
    let names: Vec<&str> = practice
        .codes
        .iter()
        .map(|code| name_in_limits(code))
        .collect();
    let is_wanted = |allowable: &AllowableDisplacement| {
        let clause = &allowable.limit.clause;
        clause.evidence == Evidence::Given || names.contains(&code_name(clause.standard))
    };
    let all = outcome.codes.iter().flat_map(|codes| &codes.limits);
    for found in all {
        for allowable in found.limits.iter().filter(|allowable| is_wanted(allowable)) {
            // A run knows a tenth of the static wheel loads, but not the horizontal loads of the other codes.
            let limit = &allowable.limit;
            if found.displacement == LimitedDisplacement::RunwayLateral
                && limit.clause.evidence != Evidence::Given
                && limit.loads != LimitLoads::Tenth
            {
                let reason = format!(
                    "a run does not derive {}; use a design",
                    limit.loads.words()
                );
                let line = OmittedCheck::new(found.displacement.phrase(), reason)
                    .of_code(limit.clause.standard, Some(limit.clause.clause));
                if !omitted.contains(&line) {
                    omitted.push(line);
                }
                continue;
            }
            let mut check = of_limit(scene, found, allowable);
            let is_bound = scene.rails.iter().zip(&outcome.is_lateral_bound);
            if found.displacement == LimitedDisplacement::RunwayLateral
                && is_bound
                    .into_iter()
                    .any(|(rail, is)| *is && rail.name == found.rail)
            {
                check.bound = Some(WITHOUT_WARPING.to_owned());
            }
            match check.of_clause(&limit.clause).confirmed(&limit.clause) {
                Ok(check) => checks.push(check),
                Err(line) if omitted.contains(&line) => {}
                Err(line) => omitted.push(line),
            }
        }
    }
}

/// Lateral displacements of frames. The forces of a run are not the loads that the codes name: they can show that a limit is
/// exceeded, but not that it is kept.
fn drifts(
    scene: &Scene,
    outcome: &CaseResult,
    checks: &mut Vec<VerdictCheck>,
    omitted: &mut Vec<OmittedCheck>,
) {
    let codes = scene.practice.iter().flat_map(|practice| &practice.codes);
    let names: Vec<&str> = codes.map(|code| name_in_limits(code)).collect();
    let length = scene.units.label(Dimension::LENGTH);
    for drift in &outcome.response.drifts {
        let own = drift.limits.iter();
        for (clause, formula, most) in own.filter(|(c, ..)| names.contains(&code_name(c.standard)))
        {
            let check = VerdictCheck {
                formula: Some((*formula).to_owned()),
                rail: Some(drift.rail.clone()),
                x: Some(drift.x + 0.0),
                time: Some(drift.time),
                loads: Some(OF_THE_RUN.to_owned()),
                ..VerdictCheck::new(
                    LimitedDisplacement::FrameLateral.phrase(),
                    drift.value,
                    *most,
                    length.clone(),
                )
            };
            if check.passed() {
                let reason = format!(
                    "a run does not derive the loads of the code; its own forces displace rail {} by {:.0} % of {formula}",
                    drift.rail,
                    100.0 * check.utilisation
                );
                let line = OmittedCheck::new(LimitedDisplacement::FrameLateral.phrase(), reason);
                omitted.push(line.of_code(clause.standard, Some(clause.clause)));
            } else {
                checks.push(check.of_clause(clause));
            }
        }
    }
}

/// Limits of one's own that bear on nothing in a run.
fn own_without_value(scene: &Scene, outcome: &CaseResult) -> Vec<OmittedCheck> {
    let own = scene.practice.iter().flat_map(|practice| &practice.limits);
    let missing = own.filter(|limit| {
        let mut all = outcome.codes.iter().flat_map(|codes| &codes.limits);
        !all.any(|found| found.limits.iter().any(|known| known.limit == **limit))
    });
    missing
        .map(|limit| {
            let reason = match limit.displacement {
                LimitedDisplacement::Overhang => "a run does not judge overhangs; use a design",
                _ => NO_SPAN,
            };
            OmittedCheck::new(
                format!("own limit of the {}", limit.displacement.phrase()),
                reason,
            )
        })
        .collect()
}

/// The code whose limits a name means: those of EN 1991-3 are in EN 1993-6.
fn name_in_limits(code: &str) -> &str {
    match code_name(code) {
        "EN 1991-3" => "EN 1993-6",
        name => name,
    }
}

fn of_limit(
    scene: &Scene,
    found: &StaticDeflection,
    allowable: &AllowableDisplacement,
) -> VerdictCheck {
    let limit = &allowable.limit;
    let loads = match found.displacement {
        LimitedDisplacement::RunwayLateral => {
            "a tenth of the static wheel loads at the positions of the run, lateral"
        }
        _ => "static wheel loads at the positions of the run, trolley at its approach",
    };
    VerdictCheck {
        formula: Some(limit.formula()),
        rail: Some(found.rail.clone()),
        x: Some(found.x + 0.0),
        time: Some(found.time),
        loads: Some(loads.to_owned()),
        ..VerdictCheck::new(
            found.displacement.phrase(),
            found.value,
            allowable.value,
            scene.units.label(Dimension::LENGTH),
        )
    }
}

fn of_stress(scene: &Scene, found: &GirderStress) -> Option<VerdictCheck> {
    let strength = found.yield_strength?;
    Some(VerdictCheck {
        rail: Some(scene.rails[found.rail].name.clone()),
        span: Some(found.span),
        x: Some(found.x + 0.0),
        time: Some(found.time),
        loads: Some(OF_THE_RUN.to_owned()),
        formula: Some("f_y".to_owned()),
        source: Some("yield strength given in the spec".to_owned()),
        ..VerdictCheck::new(
            "direct stress",
            found.value.abs(),
            strength,
            scene.units.label(Dimension::STRESS),
        )
    })
}

/// Damage of the service life, where the scene gives the number of runs.
fn of_fatigue(scene: &Scene, found: &FatigueResult) -> Option<VerdictCheck> {
    let factors = [
        ("gamma_Ff", scene.output.fatigue.loads),
        ("gamma_Mf", scene.output.fatigue.material),
    ];
    Some(VerdictCheck {
        loads: Some(format!("{OF_THE_RUN}, repeated over the service life")),
        factors: factors.map(|(name, value)| (name.to_owned(), value)).into(),
        formula: Some(format!("detail {}", found.detail.word())),
        ..VerdictCheck::new(
            format!("fatigue damage at {}", found.column),
            found.life?,
            1.0,
            "1",
        )
    })
}

fn of_calculation(what: String, value: f64, limit: f64) -> VerdictCheck {
    VerdictCheck {
        kind: CheckKind::Calculation,
        ..VerdictCheck::new(what, value, limit, "1")
    }
}

/// What is not judged: checks of the named codes that the program does not do, limits without a value, and what no limit
/// bears on.
fn not_judged(scene: &Scene, outcome: &CaseResult) -> Vec<OmittedCheck> {
    let mut out = Vec::new();
    let codes = scene
        .practice
        .as_ref()
        .map_or(&[][..], |practice| &practice.codes);
    let has_limits = scene
        .practice
        .as_ref()
        .is_some_and(|practice| !practice.limits.is_empty());
    if codes.is_empty() {
        let reason = if has_limits {
            "the scene names no code"
        } else {
            "the scene names no code and no limits; specify `practice.code` or `practice.limits`"
        };
        out.push(OmittedCheck::new("checks of a design code", reason));
    }
    for code in codes {
        let name = name_in_limits(code);
        let checked = outcome.codes.iter().flat_map(|codes| &codes.limits);
        let has_any = checked
            .flat_map(|found| &found.limits)
            .any(|allowable| code_name(allowable.limit.clause.standard) == name);
        if !has_any {
            let reason = format!("{NO_SPAN}, or the code has no limits or needs a `class`");
            out.push(
                OmittedCheck::new("limits of deflections", reason).of_code(code.clone(), None),
            );
        }
        let reason = "a run compares them with the limit by `record`, without a verdict";
        let mut limits = outcome.response.drifts.iter().flat_map(|d| &d.limits);
        let has_drift = limits.any(|(clause, ..)| code_name(clause.standard) == name);
        if !has_drift {
            let line = OmittedCheck::new(LimitedDisplacement::FrameLateral.phrase(), reason);
            out.push(line.of_code(code.clone(), None));
        }
        for check in [
            LimitedDisplacement::GaugeChange.phrase(),
            LimitedDisplacement::HeightDifference.phrase(),
        ] {
            out.push(OmittedCheck::new(check, reason).of_code(code.clone(), None));
        }
        out.extend(checks_beyond_program(code));
    }
    if let Some(first) = outcome.response.first_uplift() {
        let count = outcome.response.uplifts.len();
        let reason = format!(
            "wheels are without contact {count} times, first {} at {:.4} s; no limit bears on this",
            first.wheel, first.time
        );
        out.push(OmittedCheck::new("uplift of wheels", reason));
    }
    let unlimited = outcome.fatigue.iter().filter(|found| found.life.is_none());
    out.extend(unlimited.map(|found| {
        let reason = "the scene does not give the number of runs of the service life";
        OmittedCheck::new(format!("fatigue damage at {}", found.column), reason)
    }));
    out
}
