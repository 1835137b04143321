//! Natural modes of a scene where its run ends, by the names of its bodies.

use std::f64::consts::TAU;

use serde_json::{Value, json};
use sim::{Action, Channel, Foundation, Freedom, NaturalMode, Run, natural_modes};

use formats::motion::Cast;
use formats::scene::{Analysis, Scene};

/// Most freedoms of structures, beside those of bodies, with which modes are found.
const MOST: usize = 40;

/// Share of a mode's kinetic energy from which a freedom belongs to its name.
const NAMED: f64 = 0.15;

/// Relative difference of frequencies up to which a wave is taken for that of a mode.
const NEAR: f64 = 0.1;

/// Where in the run the bodies stand for their modes: the middle of what counts as settled.
const WHERE: f64 = 0.875;

/// A natural mode of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneMode {
    /// Cycles per unit of time.
    pub hz: f64,
    /// What moves most, such as `ladle.Y + trolley.y`.
    pub name: String,
    /// Shares of the kinetic energy, the largest first.
    pub shares: Vec<(String, f64)>,
}

impl SceneMode {
    /// Modes of the bodies of `scene` on `foundations` where they are towards the end of `run`, of one wave at least in its
    /// time; none where they cannot be found, or where events have changed what hangs on ropes.
    #[must_use]
    pub fn all(scene: &Scene, cast: &Cast, foundations: &[Foundation], run: &Run) -> Vec<SceneMode> {
        let freedoms: usize = foundations.iter().map(Foundation::freedoms).sum();
        let rules = &cast.scene.actuators.rules;
        let lets_go = |action: &Action| matches!(action, Action::Hoist { .. } | Action::Release { .. });
        let changed = run
            .fired
            .iter()
            .any(|fired| rules.get(fired.rule).is_some_and(|rule| rule.actions.iter().any(lets_go)));
        if scene.analysis != Analysis::Dynamic || !run.status.is_complete() || changed || freedoms > MOST {
            return Vec::new();
        }
        let times = run.history.column(Channel::Time);
        let Some(last) = times.last() else { return Vec::new() };
        let at = times.iter().position(|t| *t >= WHERE * last).unwrap_or(times.len() - 1);
        let places: Vec<f64> = (0..scene.bodies.len())
            .map(|b| run.history.column(Channel::Displacement(b, Freedom::X)).get(at).copied())
            .map(Option::unwrap_or_default)
            .collect();
        let found = natural_modes(&cast.scene, foundations, times[at], &places);
        let modes = found.ok().flatten().into_iter().flatten().map(|mode| SceneMode::new(scene, &mode));
        modes.filter(|mode| mode.hz * last >= 1.0).collect()
    }

    fn new(scene: &Scene, mode: &NaturalMode) -> SceneMode {
        let mut shares: Vec<(String, f64)> = vec![("structures".to_owned(), mode.structures)];
        for (body, own) in scene.bodies.iter().zip(&mode.share) {
            let words = if body.in_space {
                ["X", "Y", "Z", "", "", ""]
            } else {
                ["x", "y", "z", "roll", "yaw", "pitch"]
            };
            shares
                .extend(words.iter().zip(own).map(|(word, share)| (format!("{}.{word}", body.name), *share)));
        }
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares.retain(|(_, share)| *share >= 0.01);
        let most = |(k, (_, share)): &(usize, &(String, f64))| *k == 0 || *share >= NAMED;
        let names: Vec<&str> =
            shares.iter().enumerate().filter(most).map(|(_, (name, _))| name.as_str()).collect();
        SceneMode { hz: mode.omega / TAU, name: names.join(" + "), shares }
    }

    /// The mode nearest to a wave of `hz` among `modes`, where one is near.
    #[must_use]
    pub fn of(modes: &[SceneMode], hz: f64) -> Option<&SceneMode> {
        let apart = |mode: &SceneMode| (mode.hz / hz).ln().abs();
        modes.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).filter(|mode| apart(mode) < NEAR)
    }

    /// As a member of a run's summary.
    #[must_use]
    pub fn json(&self) -> Value {
        let fractions: serde_json::Map<String, Value> =
            self.shares.iter().map(|(name, share)| (name.clone(), json!(share))).collect();
        json!({"hz": self.hz, "mode": self.name, "fractions": fractions})
    }
}
