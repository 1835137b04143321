//! Replacement of the differential equations of a deck by one backward Euler step, as in a stiff integrator.
//!
//! At given penetrations p the forces F are ill conditioned: where wheels are close to each other, G F = e - p is
//! nearly singular, and tables interpolated by AKISPL may even have negative eigenvalues. Within an implicit step of
//! length h the rate is DIF1 = (DIF - previous value)/h, and the matrix G + 1/(k + c/h) is well conditioned.

use adams::{ArgumentValue, DataSet, Statement};

use crate::DeckPlan;
use crate::model::plan::ContactPlan;

/// First identifier of the VARIABLEs that replace DIF.
const FIRST: u32 = 900_000_000;

/// Identifier of the VARIABLE that replaces DIF(`id`).
#[must_use]
pub const fn variable(id: u32) -> u32 {
    FIRST + id
}

/// Length of the time step as a fraction of c/k where the damper has a ramp.
const RAMPED: f64 = 0.3;

/// Length of the time step of each contact: c/k, so that damper and spring have equal weight, and less where the
/// damper has a ramp, so that the solution is unique for a steep ramp.
#[must_use]
pub fn lengths(plan: &DeckPlan<'_>) -> Vec<f64> {
    let length = |contact: &ContactPlan| {
        let law = &plan.kind(contact.wheels.start).normal;
        let fraction = if law.depth > 0.0 { RAMPED } else { 1.0 };
        fraction * law.damping / law.stiffness
    };
    plan.contacts.iter().map(length).collect()
}

/// Replaces every implicit DIFF by a VARIABLE for its value at the end of the time step. Its DIF is then the value
/// before the step.
pub fn discretise(plan: &DeckPlan<'_>, set: &mut DataSet) {
    for (contact, length) in plan.contacts.iter().zip(lengths(plan)) {
        let Some(id) = contact.diff else { continue };
        let implicit = |one: &&mut Statement| {
            one.keyword == "DIFF" && one.id == Some(id) && one.get("IMPLICIT").is_some()
        };
        let Some(diff) = set.statements.iter_mut().find(implicit) else {
            continue;
        };
        let Some(ArgumentValue::Function(residual)) = diff.get("FUNCTION").cloned() else {
            continue;
        };
        diff.arguments.retain(|argument| argument.name == "IC");
        *diff = diff.clone().function("FUNCTION", "0.0");
        let start = match diff.get("IC") {
            Some(ArgumentValue::Numbers(all)) => all.first().copied().unwrap_or_default(),
            _ => 0.0,
        };
        let own = variable(id);
        let now = format!("VARVAL({own})");
        let rate = format!("(({now}-PAST({id}))/{})", adams::number::write(length));
        let replaced = |text: &str| {
            let text = text.replace(' ', "");
            let text = text
                .replace(&format!("DIF1({id})"), &rate)
                .replace(&format!("DIF({id})"), &now);
            text.replace(&format!("PAST({id})"), &format!("DIF({id})"))
        };
        for argument in set.statements.iter_mut().flat_map(|one| &mut one.arguments) {
            if let ArgumentValue::Function(text) = &mut argument.value {
                *text = replaced(text);
            }
        }
        let function = format!("{now}-({})", replaced(&residual));
        set.statements.push(
            Statement::new("VARIABLE", own)
                .numbers("IC", &[start])
                .function("FUNCTION", function),
        );
    }
}
