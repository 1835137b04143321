//! Limits of sizes and magnitudes of input files.
//!
//! A file beyond a limit is refused with the place of the value before memory is taken for it. The limits are far
//! above what runways need, so that a wrong digit cannot exhaust the memory of the machine.

/// A largest count.
pub(crate) struct Limit {
    /// The largest count that is accepted.
    pub most: usize,
    /// The reason, as a hint for the user.
    pub reason: &'static str,
}

/// Largest number of bytes of one input file. The influence grid of 2000 stations, three directions at 20 bytes a
/// number, has about this size.
pub(crate) const FILE_BYTES: u64 = 256 << 20;

/// Largest number of values of one JSON text, counted by its commas. Its tree takes about 64 bytes for each. The
/// influence grid of 2000 stations in three directions has 12 million numbers.
pub(crate) const VALUES: usize = 20_000_000;

/// Smallest and largest magnitude of a number that must be positive, in the units of its file, and the largest
/// magnitude of every other number. Between them lie all quantities of structures in every supported unit; products
/// of a few of them stay within double precision.
pub const MAGNITUDES: [f64; 2] = [1e-30, 1e30];

/// Smallest distance between two times of a table, in seconds and, where the times of the table exceed 1 s, relative
/// to the largest of them. Slopes over shorter intervals are rounding errors.
pub(crate) const TIME_RESOLUTION: f64 = 1e-12;

/// Largest number of bytes of the rows of a history, which are stored until the end of the run.
pub(crate) const HISTORY_BYTES: f64 = 2e9;

/// Estimated numbers in one row of a history: for the scene, for each body, and for each wheel.
pub(crate) const ROW_NUMBERS: [f64; 3] = [10.0, 20.0, 40.0];

/// Spans of a straight girder; each adds equations of six degrees of freedom.
pub(crate) const SPANS: Limit = Limit {
    most: 10_000,
    reason: "divide long runways at their expansion joints",
};

/// Stations of a rail. The grids have n x n numbers for each direction and each coupling.
pub(crate) const STATIONS: Limit = Limit {
    most: 2000,
    reason: "influence grids of n stations have up to 6 n^2 numbers; the results are exact between stations",
};

/// Rigid parts of the foundation "parts". Their compliance has 36 n^2 numbers, and all its eigenvectors are computed.
pub(crate) const PARTS: Limit = Limit {
    most: 500,
    reason: "the matrices of n parts have 36 n^2 numbers",
};

/// Elements of each member of the foundation "full". All modes of the mesh are computed.
pub(crate) const ELEMENTS: Limit = Limit {
    most: 1000,
    reason: "all modes of the mesh are computed; 8 to 64 elements of each member are usual",
};

/// Natural modes of the foundations "modal" and "ties". The modes are stored at every node of the mesh.
pub(crate) const MODES: Limit = Limit {
    most: 2000,
    reason: "5 to 50 modes are usual",
};

/// Wheels of a scene. Contact forces follow from matrices of n x n numbers for n wheels.
pub(crate) const WHEELS: Limit = Limit {
    most: 1000,
    reason: "the matrices of n wheels have n^2 numbers",
};

/// Bodies of a scene. The mass matrix has 36 n^2 numbers.
pub(crate) const BODIES: Limit = Limit {
    most: 500,
    reason: "the mass matrix of n bodies has up to 36 n^2 numbers",
};

/// Rows of a table over time and of the profile of a rail. Time steps end at every row.
pub(crate) const ROWS: Limit = Limit {
    most: 1_000_000,
    reason: "time steps end at every row: resample the table",
};

/// Trains of a design. Each stands in up to sixteen ways.
pub(crate) const TRAINS: Limit = Limit {
    most: 100,
    reason: "each train is analysed in up to 16 arrangements",
};

/// Wheels of a train of a design.
pub(crate) const TRAIN_WHEELS: Limit = Limit {
    most: 500,
    reason: "every wheel is moved along every member; cranes have 4 to 64 wheels",
};

/// Trains of a case of a design, which are tried in every order.
pub(crate) const CASE_TRAINS: Limit = Limit {
    most: 5,
    reason: "n trains have n! orders, and each train has two orientations",
};

/// Runs of a sweep. A shard of a larger one is a sweep of its own.
pub(crate) const SWEEP_RUNS: Limit = Limit {
    most: 10_000_000,
    reason: "the results of each run are a row of one table",
};

/// Axes of a sweep; the parameters of Sobol sequences are known for this number of dimensions.
pub(crate) const SWEEP_AXES: Limit = Limit {
    most: 100,
    reason: "each axis adds a dimension to the space that the runs must sample",
};
