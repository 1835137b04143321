//! Time integration of a scene: `stepper` and `step`.

use sim::{Method, Stepping};

use crate::check::Check;
use crate::scene::motion::simulation_input;
use crate::scene::raw::RawScene;
use crate::scene::values::scene::{Analysis, STEPPERS, Scene, stepper_word};
use crate::scene::values::structure::{Foundation, Handover, Origin, Structure};
use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the method and the step. The Gauss method requires a fixed step, because it conserves energy only with equal
/// steps.
pub(super) fn read(raw: &RawScene, root: &Place<'_>, check: &mut Check<'_>) -> Stepping {
    let place = root.key("stepper");
    let word = raw
        .stepper
        .as_ref()
        .and_then(|word| check.faults.one_of(word, &place, &STEPPERS));
    let method = word.unwrap_or_default();
    let length = root.key("step");
    let step = check.optional_positive(
        raw.step,
        &length,
        Dimension::TIME,
        "leave it out for adaptive steps",
    );
    if matches!(method, Method::Gauss2 | Method::Gauss3) && step.is_none() {
        let fault = Fault::new(root, "missing key `step`");
        check
            .faults
            .add(fault.hint("\"gauss2\" and \"gauss3\" use a constant step size"));
    }
    Stepping { method, step }
}

/// Whether the spec of a structure gives it mass.
fn has_mass(structure: &Structure) -> bool {
    matches!(&structure.origin, Origin::Spec { spec, .. } if spec.has_mass())
}

/// Rejects a method that is not applicable to a scene without other faults.
pub(super) fn suits(scene: &Scene, root: &Place<'_>, faults: &mut Faults) {
    let method = scene.stepping.method;
    if scene.analysis == Analysis::QuasiStatic
        || matches!(method, Method::Auto | Method::Sdirk4 | Method::Esdirk5)
    {
        return;
    }
    let Ok(cast) = simulation_input(scene) else {
        return;
    };
    let rigid: Vec<sim::Foundation> = scene
        .structures
        .iter()
        .map(|structure| sim::Foundation {
            irregularities: structure.irregularities.clone(),
            ..sim::Foundation::rigid()
        })
        .collect();
    let wanted = match method.suits(&cast.scene, &rigid) {
        Err(sim::Error::Method { wanted, .. }) => Some(wanted),
        _ => scene
            .structures
            .iter()
            .find_map(|structure| match structure.foundation {
                Foundation::Parts {
                    handover: Handover::PerPart { .. },
                    ..
                } => Some("one contact force per wheel"),
                Foundation::Parts { .. } if has_mass(structure) => {
                    Some("natural modes, or massless parts")
                }
                Foundation::Ties {
                    has_mass: true, c, ..
                } if c > 0.0 => Some("ties without dampers"),
                _ => None,
            }),
    };
    if let Some(wanted) = wanted {
        let word = stepper_word(method);
        let fault =
            Fault::new(&root.key("stepper"), format!("needs {wanted}")).got(format!("\"{word}\""));
        faults.add(
            fault.hint("\"sdirk4\" and \"esdirk5\" can integrate every scene; \"auto\" chooses a suitable method"),
        );
    }
}
