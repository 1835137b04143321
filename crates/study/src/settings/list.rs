//! The list of settings of a study.

use sim::Method;

use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::setting::{Setting, SettingFamily};
use formats::scene::{
    Analysis, Foundation, Handover, Origin, Scene, Structure, TableInterpolation,
};
use foundations::{SolvedModel, SolvedStructure, solution_of};

/// Properties of the structures of a scene that decide which settings exist.
#[derive(Clone, Copy, Debug)]
pub struct SceneKinds {
    /// Some structure has a beam spec and no ties: its foundation can vary.
    pub varies: bool,
    /// Every such structure has mass.
    pub has_mass: bool,
    /// Every such structure is a straight girder.
    pub is_girder: bool,
}

impl SceneKinds {
    /// The kinds of the structures of `scene`.
    #[must_use]
    pub fn of(scene: &Scene, known: &[SolvedStructure]) -> SceneKinds {
        let solved = || {
            let all = scene
                .structures
                .iter()
                .filter(|structure| varies(structure));
            all.filter_map(|structure| solution_of(known, &structure.origin))
        };
        let has_mass = |solved: &SolvedModel| {
            fea::rigid_mass(&solved.model).is_ok_and(|mass| mass[0][0] > 0.0)
        };
        SceneKinds {
            varies: solved().next().is_some(),
            has_mass: solved().all(has_mass),
            is_girder: solved().all(|solved| solved.girder.is_some()),
        }
    }
}

/// Whether a study can vary the foundation of a structure: it has a beam spec and no ties.
#[must_use]
pub fn varies(structure: &Structure) -> bool {
    let has_spec = matches!(structure.origin, Origin::Spec { .. });
    has_spec && !matches!(structure.foundation, Foundation::Ties { .. })
}

/// `scene` with every foundation that can vary replaced by that of `set`.
#[must_use]
pub fn with(scene: &Scene, set: impl Fn(&Structure) -> Foundation) -> Scene {
    let mut out = scene.clone();
    for structure in out
        .structures
        .iter_mut()
        .filter(|structure| varies(structure))
    {
        structure.foundation = set(structure);
        structure.auto = false;
        // rigid foundations and rigid parts have no compliance along the rails
        if matches!(
            structure.foundation,
            Foundation::Rigid | Foundation::Parts { .. }
        ) {
            structure.longitudinal = false;
        }
    }
    out
}

/// Least and largest number of elements of a member in a mesh whose time is measured.
const PER_MEMBER: [usize; 2] = [2, 64];

/// The scene on a mesh of about `count` elements, 2 to 64 of each member.
fn mesh(scene: &Scene, known: &[SolvedStructure], count: usize) -> Scene {
    with(scene, |structure| {
        let solved = solution_of(known, &structure.origin);
        let members = solved.map_or(1, |solved| solved.model.members.len());
        let elements = (count / members.max(1)).clamp(PER_MEMBER[0], PER_MEMBER[1]);
        Foundation::Full {
            elements,
            damping: structure.damping,
        }
    })
}

/// The most complete model of the structures, resolved to `detail`; the exact surface where they have no mass or the
/// analysis is quasi-static.
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

/// The scene on the exact influence surfaces of its structures, without mass.
#[must_use]
pub fn massless(scene: &Scene) -> Scene {
    let mut out = with(scene, |_| Foundation::Influence);
    for structure in out
        .structures
        .iter_mut()
        .filter(|structure| varies(structure))
    {
        structure.interpolation = TableInterpolation::Exact;
    }
    out
}

/// The settings of a study of `scene`, in which no foundation is left to "auto".
#[must_use]
pub fn settings(
    scene: &Scene,
    known: &[SolvedStructure],
    kinds: SceneKinds,
    budget: &StudyBudget,
) -> Vec<Setting> {
    let mut list = List {
        budget,
        dynamic: scene.analysis == Analysis::Dynamic,
        all: Vec::new(),
    };
    if kinds.varies {
        list.foundations(scene, known, kinds);
        list.tables(&massless(scene));
    }
    if list.dynamic {
        list.methods(scene);
    }
    list.all
}

/// Settings under construction.
struct List<'d> {
    budget: &'d StudyBudget,
    dynamic: bool,
    all: Vec<Setting>,
}

impl List<'_> {
    fn add(&mut self, family: SettingFamily, parameter: &'static str, value: f64, scene: Scene) {
        self.all.push(Setting {
            family,
            parameter,
            value,
            scene,
            stations: None,
        });
    }

    /// One setting for each accuracy.
    fn by_accuracy(&mut self, family: SettingFamily, scene: &Scene) {
        // an equilibrium has no accuracy that could vary
        let all = if self.dynamic {
            self.budget.accuracies.as_slice()
        } else {
            &[self.budget.fine_accuracy]
        };
        for &accuracy in all {
            self.add(
                family,
                "accuracy",
                accuracy,
                Scene {
                    accuracy,
                    ..scene.clone()
                },
            );
        }
    }

    /// Settings that vary the foundation.
    fn foundations(&mut self, scene: &Scene, known: &[SolvedStructure], kinds: SceneKinds) {
        let scene = &Scene {
            stepping: sim::Stepping::default(),
            ..scene.clone()
        };
        let fine = Scene {
            accuracy: self.budget.fine_accuracy,
            ..massless(scene)
        };
        self.by_accuracy(SettingFamily::Rigid, &with(&fine, |_| Foundation::Rigid));
        if kinds.is_girder {
            for &count in &self.budget.parts {
                let handover = Handover::Blend { length: None };
                let scene = with(&fine, |own| Foundation::Parts {
                    count,
                    handover,
                    damping: own.damping,
                });
                self.add(SettingFamily::Parts, "parts", count as f64, scene);
            }
        }
        self.by_accuracy(SettingFamily::Influence, &fine);
        if kinds.has_mass && self.dynamic {
            for family in [SettingFamily::Modal, SettingFamily::ModalWithoutResidual] {
                for &modes in &self.budget.modes {
                    let scene = with(&fine, |own| Foundation::Modal {
                        modes,
                        damping: own.damping,
                    });
                    self.add(family, "modes", modes as f64, scene);
                }
            }
            for &elements in &self.budget.elements {
                let scene = with(&fine, |own| Foundation::Full {
                    elements,
                    damping: own.damping,
                });
                self.add(SettingFamily::Mesh, "elements", elements as f64, scene);
            }
            self.by_accuracy(
                SettingFamily::Full,
                &mesh(scene, known, self.budget.mesh_elements),
            );
        }
    }

    /// Settings that read influence coefficients from tables.
    fn tables(&mut self, scene: &Scene) {
        let (accuracy, stepping) = (self.budget.fine_accuracy, sim::Stepping::default());
        let exact = Scene {
            accuracy,
            stepping,
            ..scene.clone()
        };
        let rails = scene
            .structures
            .iter()
            .filter(|own| varies(own))
            .flat_map(|own| &own.rails);
        let stations = rails.map(|rail| rail.stations.len()).max().unwrap_or(0);
        self.add(
            SettingFamily::Table(TableInterpolation::Exact),
            "stations",
            stations as f64,
            exact,
        );
        for reading in [
            TableInterpolation::Natural,
            TableInterpolation::Akispl,
            TableInterpolation::Cubspl,
        ] {
            for &count in &self.budget.stations {
                let (accuracy, stepping) = (self.budget.fine_accuracy, sim::Stepping::default());
                let mut scene = Scene {
                    accuracy,
                    stepping,
                    ..scene.clone()
                };
                for structure in scene
                    .structures
                    .iter_mut()
                    .filter(|structure| varies(structure))
                {
                    structure.interpolation = reading;
                }
                let family = SettingFamily::Table(reading);
                let stations = Some(count);
                self.all.push(Setting {
                    family,
                    parameter: "stations",
                    value: count as f64,
                    scene,
                    stations,
                });
            }
        }
    }

    /// Settings that vary the method of integration.
    fn methods(&mut self, scene: &Scene) {
        for method in [Method::Sdirk4, Method::Radau, Method::Series] {
            for &accuracy in &self.budget.accuracies {
                let stepping = sim::Stepping { method, step: None };
                let scene = Scene {
                    accuracy,
                    stepping,
                    ..scene.clone()
                };
                self.add(SettingFamily::Adaptive(method), "accuracy", accuracy, scene);
            }
        }
        for method in [
            Method::Sdirk4,
            Method::Radau,
            Method::Gauss2,
            Method::Gauss3,
        ] {
            for &count in &self.budget.steps {
                let stepping = sim::Stepping {
                    method,
                    step: Some(scene.end / f64::from(count)),
                };
                let scene = Scene {
                    accuracy: self.budget.fine_accuracy,
                    stepping,
                    ..scene.clone()
                };
                self.add(
                    SettingFamily::Fixed(method),
                    "steps",
                    f64::from(count),
                    scene,
                );
            }
        }
    }
}
