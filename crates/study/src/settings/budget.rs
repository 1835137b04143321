//! The values that a study tries, and its limits of time.

/// The values that a study tries, and how much time it may take.
///
/// ```
/// use study::StudyBudget;
///
/// let budget = StudyBudget { modes: vec![1, 4, 16], limit: 2.0, ..StudyBudget::quick() };
/// assert!(budget.modes.len() < StudyBudget::full().modes.len());
/// assert_eq!(budget.repetitions, StudyBudget::quick().repetitions);
/// ```
#[derive(Clone, Debug)]
pub struct StudyBudget {
    /// Accuracies of adaptive steps, coarsest first.
    pub accuracies: Vec<f64>,
    /// Accuracy of settings in which something else varies.
    pub fine_accuracy: f64,
    /// Numbers of equal steps over the scene.
    pub steps: Vec<u32>,
    /// Numbers of modes.
    pub modes: Vec<usize>,
    /// Numbers of elements of each member.
    pub elements: Vec<usize>,
    /// Number of elements of the mesh that varies its accuracy, spread over the members.
    pub mesh_elements: usize,
    /// Numbers of rigid parts.
    pub parts: Vec<usize>,
    /// Numbers of stations of each rail.
    pub stations: Vec<usize>,
    /// Accuracy and number of modes of each pair of reference runs, coarsest first; pairs are run until one agrees.
    pub references: Vec<(f64, usize)>,
    /// The same with the number of elements of each member, for structures whose modes converge slowly.
    pub meshes: Vec<(f64, usize)>,
    /// Largest number of timed repetitions of a run.
    pub repetitions: usize,
    /// Thread time, s, that a run may take.
    pub limit: f64,
    /// Thread time, s, that all repetitions of a setting together may take. A longer run is not repeated.
    pub repetition_limit: f64,
    /// Smallest relative error of deflections and wheel forces that the study must resolve: the runs of a reference
    /// must agree ten times better.
    pub resolution: f64,
    /// Difference of the two runs of a reference from which no finer ones are made, relative to the largest that resolves
    /// `resolution`.
    pub margin: f64,
}

impl StudyBudget {
    /// The budget of a study for publication: minutes to an hour of computation.
    #[must_use]
    pub fn full() -> StudyBudget {
        StudyBudget {
            accuracies: vec![1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
            fine_accuracy: 1e-6,
            steps: vec![64, 256, 1024, 4096, 16384],
            modes: vec![1, 2, 3, 4, 6, 8, 12, 16, 24],
            elements: vec![1, 2, 4, 8],
            mesh_elements: 192,
            parts: vec![2, 4, 8, 16, 32, 64],
            stations: vec![5, 7, 13, 19, 37, 73, 145],
            references: vec![(1e-5, 8), (1e-6, 16), (1e-7, 32), (1e-8, 48), (1e-9, 64)],
            meshes: vec![(1e-4, 2), (1e-5, 4), (1e-6, 8)],
            repetitions: 9,
            limit: 20.0,
            repetition_limit: 20.0,
            resolution: 1e-4,
            margin: 1e-2,
        }
    }

    /// The budget of a first look: fewer values, coarser references.
    #[must_use]
    pub fn quick() -> StudyBudget {
        StudyBudget {
            accuracies: vec![1e-2, 1e-3, 1e-4],
            fine_accuracy: 1e-4,
            steps: vec![256, 1024],
            modes: vec![1, 2, 4, 8],
            elements: vec![1, 2],
            mesh_elements: 48,
            parts: vec![2, 4, 8],
            stations: vec![7, 19, 73],
            references: vec![(1e-4, 4), (1e-5, 8), (1e-6, 16)],
            meshes: vec![(1e-4, 2), (1e-5, 4)],
            repetitions: 3,
            limit: 5.0,
            repetition_limit: 0.5,
            resolution: 1e-2,
            margin: 0.1,
        }
    }
}
