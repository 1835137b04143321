//! Trucks: which wheels carry a body, where, on which rail.

/// Wheels under a body on one rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Truck {
    /// Its name; `<body>.truck<n>` where the scene gives none.
    pub name: String,
    /// Index of its body.
    pub body: usize,
    /// Index of its rail in the scene's list.
    pub rail: usize,
    /// Index of its kind of wheel in the scene's list.
    pub wheel: usize,
    /// Position of its origin relative to the body's, in the rail frame, length.
    pub at: [f64; 3],
    /// Wheels and equalisers on which the body rests, in the order of the file.
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
    /// Offset along the rail of the wheel, or of the equaliser's pin, which is the mean of its ends.
    #[must_use]
    pub fn offset(&self) -> f64 {
        match self {
            Node::Wheel(offset) => *offset,
            Node::Equaliser(ends) => f64::midpoint(ends[0].offset(), ends[1].offset()),
        }
    }

    /// Offsets of the wheels below, with the fraction of this node's load that each carries.
    #[must_use]
    pub fn wheels(&self) -> Vec<(f64, f64)> {
        match self {
            Node::Wheel(offset) => vec![(*offset, 1.0)],
            Node::Equaliser(ends) => {
                let below = ends.iter().flat_map(Node::wheels);
                below.map(|(offset, share)| (offset, share / 2.0)).collect()
            }
        }
    }
}

impl Truck {
    /// Offsets along the rail of all wheels from the body's origin, in the order of the file.
    #[must_use]
    pub fn wheel_offsets(&self) -> Vec<f64> {
        self.tree.iter().flat_map(Node::wheels).map(|(offset, _)| self.at[0] + offset).collect()
    }
}
