//! The verdict on a design: all its checks in one table, and what was not checked.

use formats::design::Design;
use formats::units::Dimension;
use formats::verdict::{
    CheckKind, OmittedCheck, Verdict, VerdictCheck, checks_beyond_program, rail_phrase,
};

use practice::limits::LimitedDisplacement;
use trains::WITHOUT_WARPING;

use crate::outcome::{DesignResult, LimitCheck, StressCheck};

/// Largest bound of the relative error of influence coefficients with which a design is accepted.
const MAX_ERROR_BOUND: f64 = fea::DEFAULT_ACCURACY;

/// All checks of a design, worst first, and what was not checked.
#[must_use]
pub fn verdict(design: &Design, result: &DesignResult) -> Verdict {
    let length = design.units.label(Dimension::LENGTH);
    let mut checks = Vec::new();
    let mut omitted = Vec::new();
    for limit in &result.limits {
        let mut check = of_limit(limit, &length);
        let is_bound = |rail: &str| {
            let index = design.spec.rails().iter().position(|own| own.name == rail);
            index.is_some_and(|index| result.is_lateral_bound[index])
        };
        if limit.quantity == LimitedDisplacement::RunwayLateral.phrase() && is_bound(&limit.rail) {
            check.bound = Some(WITHOUT_WARPING.to_owned());
        }
        match check.confirmed(&limit.clause) {
            Ok(check) => checks.push(check),
            Err(line) if omitted.contains(&line) => {}
            Err(line) => omitted.push(line),
        }
    }
    checks.extend(
        result
            .stresses
            .iter()
            .map(|stress| of_stress(design, stress)),
    );
    omitted.extend(result.stresses.iter().filter_map(unproved));
    checks.push(VerdictCheck {
        kind: CheckKind::Calculation,
        ..VerdictCheck::new(
            "bound of the relative error of influence coefficients",
            result.error_bound,
            MAX_ERROR_BOUND,
            "1",
        )
    });
    omitted.extend(result.left_out.iter().cloned());
    omitted.extend(beyond(design));
    Verdict::new(checks, omitted)
}

fn of_limit(limit: &LimitCheck, length: &str) -> VerdictCheck {
    let check = VerdictCheck {
        formula: Some(limit.formula.clone()),
        case: Some(limit.case),
        rail: Some(limit.rail.clone()),
        span: Some(limit.span),
        x: Some(limit.x + 0.0),
        position: limit.position.map(|position| position + 0.0),
        loads: Some(limit.loads.to_owned()),
        sampled: limit.is_sampled,
        ..VerdictCheck::new(limit.quantity, limit.value.abs(), limit.limit, length)
    };
    check.of_clause(&limit.clause)
}

fn of_stress(design: &Design, stress: &StressCheck) -> VerdictCheck {
    let case = &design.cases[stress.case - 1];
    let g = &stress.governing;
    let lateral = stress
        .lateral_section
        .map_or_else(String::new, |own| format!("; {}", own.phrase()));
    VerdictCheck {
        case: Some(stress.case),
        rail: Some(stress.rail.clone()),
        span: Some(stress.span),
        x: Some(g.x + 0.0),
        position: g.trains.first().map(|train| train.position + 0.0),
        loads: Some(format!("loads of the case, dead load included{lateral}")),
        factors: case.factors.iter().cloned().collect(),
        sampled: stress.fibre.is_some(),
        formula: Some(
            if stress.fibre.is_some() {
                "f_y"
            } else {
                "f_y/sqrt(3)"
            }
            .to_owned(),
        ),
        source: Some("yield strength given in the spec".to_owned()),
        ..VerdictCheck::new(
            stress.quantity,
            stress.value.abs(),
            stress.strength,
            design.units.label(Dimension::STRESS),
        )
    }
}

/// A sampled stress below its strength whose upper bound is above.
fn unproved(stress: &StressCheck) -> Option<OmittedCheck> {
    let bound = stress
        .bound
        .filter(|bound| *bound > 1.0 && stress.utilisation() <= 1.0)?;
    let check = format!(
        "{} of {} in all states, case {}",
        stress.quantity,
        rail_phrase(&stress.rail),
        stress.case
    );
    let reason = format!(
        "the largest of the evaluated states uses {:.0} % of the strength; no state is proved to exceed {:.0} %",
        100.0 * stress.utilisation(),
        100.0 * bound
    );
    Some(OmittedCheck::new(check, reason))
}

/// Checks of the named code that the program does not do; where no code is named, one line that says so.
fn beyond(design: &Design) -> Vec<OmittedCheck> {
    let Some(code) = &design.practice.code else {
        let reason = "the design names no code";
        return vec![OmittedCheck::new("checks of a design code", reason)];
    };
    checks_beyond_program(code)
}
