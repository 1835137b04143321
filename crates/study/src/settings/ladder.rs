//! The settings of a study.

use sim::Method;

use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::setting::{Setting, SettingFamily};
use formats::scene::{Analysis, Foundation, Handover, Origin, Reading, Scene, Structure};
use foundations::{SolvedStructure, solution_of};

/// What a scene's structures can be.
#[derive(Clone, Copy, Debug)]
pub struct SceneKinds {
    /// Some structure has a beam spec whose foundation may vary: no ties.
    pub varies: bool,
    /// Every such structure has mass.
    pub has_mass: bool,
    /// Every such structure is a straight girder.
    pub is_girder: bool,
}

impl SceneKinds {
    /// Of the structures of `scene`.
    #[must_use]
    pub fn of(scene: &Scene, known: &[SolvedStructure]) -> SceneKinds {
        let solved = || {
            let all = scene.structures.iter().filter(|structure| varies(structure));
            all.filter_map(|structure| solution_of(known, &structure.origin))
        };
        let has_mass = |solved| foundations::excited_modes(solved, 1).is_ok_and(|modes| modes.is_some());
        SceneKinds {
            varies: solved().next().is_some(),
            has_mass: solved().all(has_mass),
            is_girder: solved().all(|solved| solved.girder.is_some()),
        }
    }
}

/// Whether the foundation of a structure is the study's to vary.
#[must_use]
pub fn varies(structure: &Structure) -> bool {
    let has_spec = matches!(structure.origin, Origin::Spec { .. });
    has_spec && !matches!(structure.foundation, Foundation::Ties { .. })
}

/// `scene` with every foundation that may vary set by `set`.
#[must_use]
pub fn with(scene: &Scene, set: impl Fn(&Structure) -> Foundation) -> Scene {
    let mut out = scene.clone();
    for structure in out.structures.iter_mut().filter(|structure| varies(structure)) {
        structure.foundation = set(structure);
        structure.auto = false;
        // neither gives way along the rails
        if matches!(structure.foundation, Foundation::Rigid | Foundation::Parts { .. }) {
            structure.longitudinal = false;
        }
    }
    out
}

/// The mesh that "auto" takes as the top.
fn mesh(scene: &Scene, known: &[SolvedStructure]) -> Scene {
    with(scene, |structure| {
        let elements = foundations::mesh_elements(solution_of(known, &structure.origin));
        Foundation::Full { elements, damping: structure.damping }
    })
}

/// The structure with all that is known of it, to such a detail; without mass, the exact surface.
#[must_use]
pub fn whole(scene: &Scene, kinds: SceneKinds, detail: MeshDetail) -> Scene {
    if !kinds.has_mass || scene.analysis != Analysis::Dynamic {
        return massless(scene);
    }
    with(scene, |structure| {
        let damping = structure.damping;
        match detail {
            MeshDetail::Modes(modes) => Foundation::Modal { modes, damping },
            MeshDetail::Mesh(elements) => Foundation::Full { elements, damping },
        }
    })
}

/// The structure without mass, exactly.
#[must_use]
pub fn massless(scene: &Scene) -> Scene {
    let mut out = with(scene, |_| Foundation::Influence);
    for structure in out.structures.iter_mut().filter(|structure| varies(structure)) {
        structure.reading = Reading::Exact;
    }
    out
}

/// The settings of a study of `scene`, whose foundations are chosen.
#[must_use]
pub fn settings(
    scene: &Scene,
    known: &[SolvedStructure],
    kinds: SceneKinds,
    depth: &StudyBudget,
) -> Vec<Setting> {
    let mut list = List { depth, dynamic: scene.analysis == Analysis::Dynamic, all: Vec::new() };
    if kinds.varies {
        list.foundations(scene, known, kinds);
        list.tables(&massless(scene));
    }
    if list.dynamic {
        list.methods(scene);
    }
    list.all
}

struct List<'d> {
    depth: &'d StudyBudget,
    dynamic: bool,
    all: Vec<Setting>,
}

impl List<'_> {
    fn add(&mut self, family: SettingFamily, knob: &'static str, value: f64, scene: Scene) {
        self.all.push(Setting { family, knob, value, scene, stations: None });
    }

    fn by_accuracy(&mut self, family: SettingFamily, scene: &Scene) {
        // equilibria know no accuracy
        let all = if self.dynamic { self.depth.accuracies.as_slice() } else { &[self.depth.fine] };
        for &accuracy in all {
            self.add(family, "accuracy", accuracy, Scene { accuracy, ..scene.clone() });
        }
    }

    fn foundations(&mut self, scene: &Scene, known: &[SolvedStructure], kinds: SceneKinds) {
        let scene = &Scene { stepping: sim::Stepping::default(), ..scene.clone() };
        let fine = Scene { accuracy: self.depth.fine, ..massless(scene) };
        self.by_accuracy(SettingFamily::Rigid, &with(&fine, |_| Foundation::Rigid));
        if kinds.is_girder {
            for &count in &self.depth.parts {
                let handover = Handover::Blend { length: None };
                let scene = with(&fine, |_| Foundation::Parts { count, handover, damping: 0.0 });
                self.add(SettingFamily::Parts, "parts", count as f64, scene);
            }
        }
        self.by_accuracy(SettingFamily::Influence, &fine);
        if kinds.has_mass && self.dynamic {
            for family in [SettingFamily::Modal, SettingFamily::Pure] {
                for &modes in &self.depth.modes {
                    let scene = with(&fine, |own| Foundation::Modal { modes, damping: own.damping });
                    self.add(family, "modes", modes as f64, scene);
                }
            }
            for &elements in &self.depth.elements {
                let scene = with(&fine, |own| Foundation::Full { elements, damping: own.damping });
                self.add(SettingFamily::Mesh, "elements", elements as f64, scene);
            }
            self.by_accuracy(SettingFamily::Full, &mesh(scene, known));
        }
    }

    fn tables(&mut self, scene: &Scene) {
        let (accuracy, stepping) = (self.depth.fine, sim::Stepping::default());
        let exact = Scene { accuracy, stepping, ..scene.clone() };
        let rails = scene.structures.iter().filter(|own| varies(own)).flat_map(|own| &own.rails);
        let stations = rails.map(|rail| rail.stations.len()).max().unwrap_or(0);
        self.add(SettingFamily::Table(Reading::Exact), "stations", stations as f64, exact);
        for reading in [Reading::Natural, Reading::Akispl, Reading::Cubspl] {
            for &count in &self.depth.stations {
                let (accuracy, stepping) = (self.depth.fine, sim::Stepping::default());
                let mut scene = Scene { accuracy, stepping, ..scene.clone() };
                for structure in scene.structures.iter_mut().filter(|structure| varies(structure)) {
                    structure.reading = reading;
                }
                let family = SettingFamily::Table(reading);
                let stations = Some(count);
                self.all.push(Setting { family, knob: "stations", value: count as f64, scene, stations });
            }
        }
    }

    fn methods(&mut self, scene: &Scene) {
        for method in [Method::Sdirk4, Method::Radau, Method::Series] {
            for &accuracy in &self.depth.accuracies {
                let stepping = sim::Stepping { method, step: None };
                let scene = Scene { accuracy, stepping, ..scene.clone() };
                self.add(SettingFamily::Adaptive(method), "accuracy", accuracy, scene);
            }
        }
        for method in [Method::Sdirk4, Method::Radau, Method::Gauss2, Method::Gauss3] {
            for &count in &self.depth.steps {
                let stepping = sim::Stepping { method, step: Some(scene.end / f64::from(count)) };
                let scene = Scene { accuracy: self.depth.fine, stepping, ..scene.clone() };
                self.add(SettingFamily::Fixed(method), "steps", f64::from(count), scene);
            }
        }
    }
}
