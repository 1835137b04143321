//! Settings of the solver: UNITS, ACCGRAV, INTEGRATOR, OUTPUT, and the command file.

use adams::Statement;

use crate::model::plan::DeckPlan;
use crate::words::remark;
use formats::scene::Analysis;

/// Upper limit of ERROR of the integrator.
const MAX_ERROR: f64 = 1e-3;

/// UNITS and ACCGRAV.
pub(crate) fn head(plan: &DeckPlan<'_>) -> Vec<Statement> {
    let mut units = plan
        .scene
        .units
        .to_adams()
        .statement()
        .remark(remark::UNITS);
    if plan.form == crate::DeckForm::Paper {
        units = units.remark(remark::PAPER);
    }
    let gravity = Statement::without_id("ACCGRAV")
        .numbers("IGRAV", &[0.0])
        .numbers("JGRAV", &[-plan.scene.gravity])
        .numbers("KGRAV", &[0.0]);
    vec![units, gravity]
}

/// INTEGRATOR, OUTPUT and RESULTS.
pub(crate) fn tail(plan: &DeckPlan<'_>) -> Vec<Statement> {
    let integrator = Statement::without_id("INTEGRATOR")
        .remark(remark::INTEGRATOR)
        .flag("GSTIFF")
        .flag("SI2")
        .numbers("ERROR", &[plan.scene.accuracy.min(MAX_ERROR)])
        .numbers("HMAX", &[plan.scene.dt]);
    let output = Statement::without_id("OUTPUT")
        .flag("REQSAVE")
        .flag("GRSAVE");
    let results = Statement::without_id("RESULTS").flag("XRF");
    vec![integrator, output, results]
}

/// The command file that runs the data set `model`, a file name without its extension.
pub(crate) fn commands(plan: &DeckPlan<'_>, model: &str) -> String {
    let (end, dt) = (
        adams::number::write(plan.scene.end),
        adams::number::write(plan.scene.dt),
    );
    // a static analysis is not run first: the scene starts in equilibrium, and a body that is free along its rail has
    // no static equilibrium
    let simulate = match plan.scene.analysis {
        Analysis::Dynamic => "SIMULATE/DYNAMIC",
        Analysis::QuasiStatic => "SIMULATE/STATIC",
    };
    format!("file/model={model}\n{simulate}, END={end}, DTOUT={dt}\nstop\n")
}
