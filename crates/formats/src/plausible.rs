//! Values beyond which an input is probably in another unit than that of its file, or a slip: one table for specs, designs and
//! scenes, in SI units. Each is far outside of what is built; what is usual stands in the warning.

// Structures.

/// Young's moduli, N/m2. The range includes rigid arms a hundred times as stiff as steel.
pub const MODULI: [f64; 2] = [2e9, 2e13];

/// G/E of isotropic materials is 1/3 to 1/2, of timber along its fibres 1/20.
pub const SHEAR_TO_YOUNG: [f64; 2] = [0.01, 1.0];

/// Densities of structures with their equipment, kg/m3.
pub const DENSITIES: [f64; 2] = [50.0, 4e4];

/// Yield strengths, N/m2: from wrought iron with a large factor to wires.
pub const STRENGTHS: [f64; 2] = [5e7, 2.5e9];

/// I^(1/4)/L, with the second moment of area I of a girder and its longest span L. Rolled girders have 1/20 to 1/100.
pub const STIFFNESSES: [f64; 2] = [1.0 / 400.0, 0.5];

/// I/A^2, with the larger second moment of area I and the area A of a section. A solid square has 1/12, rolled sections and
/// boxes about 1 to 10; truss members of two slender chords have more.
pub const SHAPES: [f64; 2] = [1e-3, 1e3];

/// Largest effective shear area over the area of a section; a solid rectangle has 5/6.
pub const SHEAR_AREA: f64 = 1.0;

/// Ratio of a property to that of the rolled section of the same girder above which one of them is wrong.
pub const BESIDE_ROLLED: f64 = 3.0;

/// Difference of a stated property from that of the section beside it, relative, above which one of the two is doubtful.
/// Tables of rolled sections differ by less than 1 % from the formulas.
pub const DIFFERENCE: f64 = 0.05;

/// Estimated relative error of the flexibility of a tapered member that is accepted without a word.
pub const TAPER_ERROR: f64 = 0.01;

/// Largest height of a rail above the axis of its girder, as a fraction of the longest span.
pub const RAIL_HEIGHT: f64 = 0.5;

/// Largest gap between two segments of a rail, as a fraction of the shorter segment. Gaps over column seats are shorter.
pub const GAP: f64 = 0.5;

/// Largest span of a girder, m. The longest runway beams have about 40 m, bridges of gantry cranes 150 m.
pub const SPAN: f64 = 200.0;

// Loads and trains.

/// Acceleration of gravity, m/s2: from that of the moon to three times that of the earth.
pub const GRAVITIES: [f64; 2] = [1.0, 30.0];

/// Largest dead load along a rail, N/m. The heaviest rails have 1.7 kN/m; girders of mills with walkways about 20 kN/m.
pub const RAIL_WEIGHT: f64 = 1e5;

/// Vertical wheel loads, N: from a monorail trolley of 100 kg to twice the largest wheel loads of ladle cranes, about 1 MN.
pub const WHEEL_LOADS: [f64; 2] = [200.0, 2e6];

/// Largest ratio of the lateral force of a wheel to its vertical force, and of the longitudinal force of a train to its
/// vertical forces: more than friction transmits.
pub const HORIZONTAL: f64 = 1.0;

/// Largest ratio of the buffer force of a train to its vertical forces. Buffers stop cranes with less than 1 g.
pub const BUFFER: f64 = 5.0;

/// Largest ratio of the weights of a crane to the vertical forces of its train: on one rail stand about half of them, and at
/// least a tenth.
pub const CRANE_WEIGHT: f64 = 20.0;

/// Smallest distance of two wheels on a rail, m. Trolleys of monorail hoists have 0.1 m.
pub const WHEEL_DISTANCE: f64 = 0.02;

/// Largest distance from the outermost wheel to the end of a train, m.
pub const TRAIN_END: f64 = 30.0;

/// Largest eccentricity of wheel loads, m. Rails of the largest cranes have heads of 0.15 m.
pub const ECCENTRICITY: f64 = 1.0;

/// Largest factor on a load.
pub const LOAD_FACTOR: f64 = 10.0;

/// Largest limit of one's own on a deflection, as a fraction of the longest span; codes have 1/200 to 1/1000.
pub const OWN_LIMIT: f64 = 0.05;

/// Rated hoisting speeds, m/s. Container cranes have up to 3 m/s without load.
pub const HOIST_SPEEDS: [f64; 2] = [1e-4, 4.0];

// Scenes.

/// Radii of wheels, m.
pub const RADII: [f64; 2] = [0.01, 2.0];

/// Stiffness of the contact of a wheel, N/m: from soft suspensions to ten times Hertz's contact of steel.
pub const WHEEL_STIFFNESS: [f64; 2] = [1e3, 5e10];

/// Wheel load due to the weight of the body alone over the square of the wheel diameter, N/m2. Fully loaded steel wheels bear
/// a third of it.
pub const WHEEL_PRESSURE: f64 = 3e6;

/// Penetration of wheels at the start, relative to their radius, above which their stiffness is implausible.
pub const PENETRATION: f64 = 0.25;

/// Distance beyond its outer wheels at which a body may support a structure, as a fraction of the distance between the outer
/// wheels.
pub const OVERHANG: f64 = 0.1;

/// Strain beyond which a rope breaks, for strands of 2000 N/mm2.
pub const BREAKING_STRAIN: f64 = 0.03;

/// Rotation of a body, rad, above which small rotations are no longer those of a rigid body: levers err by half its square.
pub const LARGE_ROTATION: f64 = 0.1;

/// Whether a value lies in a range.
#[must_use]
pub fn is_within(range: [f64; 2], value: f64) -> bool {
    (range[0]..=range[1]).contains(&value)
}
