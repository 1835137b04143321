//! Trucks: the wheels that carry a body, their positions and their rail.

/// Wheels under a body on one rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Truck {
    /// Its name; by default `<body>.truck<n>`.
    pub name: String,
    /// Index of its body.
    pub body: usize,
    /// Index of its rail in the scene's list.
    pub rail: usize,
    /// Index of its wheel type in the list of the scene.
    pub wheel: usize,
    /// Position of its origin relative to that of the body, in the rail frame, length.
    pub at: [f64; 3],
    /// Wheels and equalisers that support the body, in the order of the file.
    pub tree: Vec<Node>,
}

/// A wheel, or a massless equaliser pinned at the mean of its two ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A wheel at this offset along the rail from the truck's origin, length.
    Wheel(f64),
    /// A lever with a node at each end.
    Equaliser(Box<[Node; 2]>),
}

impl Node {
    /// Longitudinal offset of the wheel, or of the pin of the equaliser, which is the mean of its ends.
    #[must_use]
    pub fn offset(&self) -> f64 {
        match self {
            Node::Wheel(offset) => *offset,
            Node::Equaliser(ends) => f64::midpoint(ends[0].offset(), ends[1].offset()),
        }
    }

    /// Offsets of the wheels below this node, with the fraction of its load that each wheel carries.
    #[must_use]
    pub fn wheels(&self) -> Vec<(f64, f64)> {
        match self {
            Node::Wheel(offset) => vec![(*offset, 1.0)],
            Node::Equaliser(ends) => {
                let below = ends.iter().flat_map(Node::wheels);
                below
                    .map(|(offset, fraction)| (offset, fraction / 2.0))
                    .collect()
            }
        }
    }
}

impl Truck {
    /// Longitudinal offsets of all wheels from the origin of the body, in the order of the file.
    #[must_use]
    pub fn wheel_offsets(&self) -> Vec<f64> {
        self.tree
            .iter()
            .flat_map(Node::wheels)
            .map(|(offset, _)| self.at[0] + offset)
            .collect()
    }
}
