//! The graph of the bodies of a frame, which have an edge where an element joins them.

/// Neighbours of each node, in compressed rows, sorted and without repetition.
pub(crate) struct Graph {
    pub starts: Vec<usize>,
    pub neighbours: Vec<usize>,
}

impl Graph {
    pub fn new(n: usize, edges: &[[usize; 2]]) -> Graph {
        let mut starts = vec![0; n + 1];
        for &[a, b] in edges {
            starts[a + 1] += 1;
            starts[b + 1] += 1;
        }
        for k in 0..n {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![0; 2 * edges.len()];
        for &[a, b] in edges {
            for (from, to) in [(a, b), (b, a)] {
                neighbours[next[from]] = to;
                next[from] += 1;
            }
        }
        // Sort the neighbours of each node and drop repetitions.
        let mut kept = 0;
        for k in 0..n {
            let (from, to) = (starts[k], starts[k + 1]);
            neighbours[from..to].sort_unstable();
            starts[k] = kept;
            for i in from..to {
                if i == from || neighbours[i] != neighbours[i - 1] {
                    neighbours[kept] = neighbours[i];
                    kept += 1;
                }
            }
        }
        starts[n] = kept;
        neighbours.truncate(kept);
        Graph { starts, neighbours }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.neighbours.len() / 2
    }

    /// Nodes that share an edge with node `k`.
    pub fn neighbours_of(&self, k: usize) -> &[usize] {
        &self.neighbours[self.starts[k]..self.starts[k + 1]]
    }
}
