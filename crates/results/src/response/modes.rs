//! Natural modes of a scene near the end of its run, with the names of the bodies that move in them.

use std::f64::consts::TAU;

use serde_json::{Value, json};
use sim::{Action, BodyDof, Channel, Foundation, NaturalMode, Run, Side, natural_modes};

use formats::scene::motion::SimulationInput;
use formats::scene::{Analysis, Scene};

/// Largest number of degrees of freedom of structures, not counting bodies, for which modes are computed.
const MAX_DOFS: usize = 40;

/// Fraction of the kinetic energy of a mode from which a degree of freedom is part of its name.
const NAMED: f64 = 0.15;

/// Largest difference of the logarithms of two frequencies for which an oscillation is attributed to a mode.
const NEAR: f64 = 0.1;

/// Time at which the positions of the bodies are taken, as a fraction of the run: the middle of its last quarter,
/// over which means and oscillations are evaluated.
const INSTANT: f64 = 0.875;

/// A natural mode of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneMode {
    /// Frequency, cycles per unit of time.
    pub hz: f64,
    /// The degrees of freedom with the largest kinetic energy, such as `ladle.Y + trolley.y`.
    pub name: String,
    /// Fraction of the kinetic energy of each degree of freedom, the largest first.
    pub fractions: Vec<(String, f64)>,
    /// Time of the run at which the bodies have the positions to which the mode belongs.
    pub time: f64,
    /// These positions along the track, by body.
    pub positions: Vec<(String, f64)>,
}

impl SceneMode {
    /// Modes of the bodies of `scene` on `foundations`, at their positions near the end of `run`, with at least one
    /// period within the run, lowest first. The list is empty if they cannot be computed or if events have changed
    /// ropes or loads.
    #[must_use]
    pub fn all(
        scene: &Scene,
        input: &SimulationInput,
        foundations: &[Foundation],
        run: &Run,
    ) -> Vec<SceneMode> {
        let dofs: usize = foundations.iter().map(Foundation::dofs).sum();
        let rules = &input.scene.actuators.rules;
        let changes_ropes =
            |action: &Action| matches!(action, Action::Hoist { .. } | Action::Release { .. });
        let changed = run.fired.iter().any(|fired| {
            rules
                .get(fired.rule)
                .is_some_and(|rule| rule.actions.iter().any(changes_ropes))
        });
        if scene.analysis != Analysis::Dynamic
            || !run.status.is_complete()
            || changed
            || dofs > MAX_DOFS
        {
            return Vec::new();
        }
        let Some([_, last]) = run.solution.function().range() else {
            return Vec::new();
        };
        let time = INSTANT * last;
        let place = |b: usize| {
            let channel = Channel::Displacement(b, BodyDof::X);
            run.solution.value(channel, time, Side::Before)
        };
        let places: Vec<f64> = (0..scene.bodies.len()).map(place).collect();
        let found = natural_modes(&input.scene, foundations, time, &places);
        let modes = found
            .ok()
            .flatten()
            .into_iter()
            .flatten()
            .map(|mode| SceneMode::new(scene, &mode, (time, &places)));
        modes.filter(|mode| mode.hz * last >= 1.0).collect()
    }

    fn new(scene: &Scene, mode: &NaturalMode, (time, places): (f64, &[f64])) -> SceneMode {
        let bodies = scene.bodies.iter().zip(places);
        let mut fractions: Vec<(String, f64)> = vec![("structures".to_owned(), mode.structures)];
        for (body, own) in scene.bodies.iter().zip(&mode.fraction) {
            let words = if body.in_space {
                ["X", "Y", "Z", "", "", ""]
            } else {
                ["x", "y", "z", "roll", "yaw", "pitch"]
            };
            fractions.extend(
                words
                    .iter()
                    .zip(own)
                    .map(|(word, fraction)| (format!("{}.{word}", body.name), *fraction)),
            );
        }
        fractions.sort_by(|a, b| b.1.total_cmp(&a.1));
        fractions.retain(|(_, fraction)| *fraction >= 0.01);
        let most = |(k, (_, fraction)): &(usize, &(String, f64))| *k == 0 || *fraction >= NAMED;
        let names: Vec<&str> = fractions
            .iter()
            .enumerate()
            .filter(most)
            .map(|(_, (name, _))| name.as_str())
            .collect();
        SceneMode {
            hz: mode.omega / TAU,
            name: names.join(" + "),
            fractions,
            time,
            positions: bodies.map(|(body, x)| (body.name.clone(), *x)).collect(),
        }
    }

    /// The mode of `modes` whose frequency is nearest to `hz`, if it is within about 10 %.
    #[must_use]
    pub fn of(modes: &[SceneMode], hz: f64) -> Option<&SceneMode> {
        let apart = |mode: &SceneMode| (mode.hz / hz).ln().abs();
        modes
            .iter()
            .min_by(|a, b| apart(a).total_cmp(&apart(b)))
            .filter(|mode| apart(mode) < NEAR)
    }

    /// As a member of a run's summary.
    #[must_use]
    pub fn json(&self) -> Value {
        let by_name = |all: &[(String, f64)]| -> Value {
            all.iter()
                .map(|(name, value)| (name.clone(), json!(value)))
                .collect()
        };
        json!({
            "hz": self.hz,
            "mode": self.name,
            "fractions": by_name(&self.fractions),
            "time": self.time,
            "positions": by_name(&self.positions),
        })
    }
}
