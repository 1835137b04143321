//! How far a study goes.

/// Values that a study tries, and what it may cost.
#[derive(Clone, Debug)]
pub struct StudyBudget {
    /// Accuracies of adaptive steps, coarsest first.
    pub accuracies: Vec<f64>,
    /// Accuracy where something else varies.
    pub fine: f64,
    /// Numbers of equal steps.
    pub steps: Vec<u32>,
    /// Numbers of modes.
    pub modes: Vec<usize>,
    /// Elements a member.
    pub elements: Vec<usize>,
    /// Numbers of rigid parts.
    pub parts: Vec<usize>,
    /// Stations a rail.
    pub stations: Vec<usize>,
    /// Accuracies of references and, where structures have mass, their modes: one after the other until two runs agree.
    pub references: Vec<(f64, usize)>,
    /// The same with elements a member, where modes do not agree.
    pub meshes: Vec<(f64, usize)>,
    /// Most repetitions of a run.
    pub repetitions: usize,
    /// Seconds that a run may take, and all repetitions of a setting.
    pub limit: f64,
    /// Error of deflections and wheel forces down to which the study must tell: the references must agree ten times better.
    pub resolution: f64,
}

impl StudyBudget {
    /// For a picture to print.
    #[must_use]
    pub fn full() -> StudyBudget {
        StudyBudget {
            accuracies: vec![1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
            fine: 1e-6,
            steps: vec![64, 256, 1024, 4096, 16384],
            modes: vec![1, 2, 3, 4, 6, 8, 12, 16, 24],
            elements: vec![1, 2, 4, 8],
            parts: vec![2, 4, 8, 16, 32, 64],
            stations: vec![5, 7, 13, 19, 37, 73, 145],
            references: vec![(1e-5, 8), (1e-6, 16), (1e-7, 32), (1e-8, 48), (1e-9, 64)],
            meshes: vec![(1e-4, 2), (1e-5, 4), (1e-6, 8)],
            repetitions: 9,
            limit: 20.0,
            resolution: 1e-4,
        }
    }

    /// For a first look.
    #[must_use]
    pub fn quick() -> StudyBudget {
        StudyBudget {
            accuracies: vec![1e-2, 1e-3, 1e-4],
            fine: 1e-4,
            steps: vec![256, 1024],
            modes: vec![1, 2, 4, 8],
            elements: vec![1, 2],
            parts: vec![2, 8, 32],
            stations: vec![7, 19, 73],
            references: vec![(1e-4, 4), (1e-5, 8), (1e-6, 16)],
            meshes: vec![(1e-4, 2), (1e-5, 4)],
            repetitions: 3,
            limit: 5.0,
            resolution: 1e-2,
        }
    }
}
