//! Elimination order of the bodies of a frame.
//!
//! The graph has a node for each body, not for each degree of freedom: its ordering is six times less work, and
//! the columns of a body stay together. Two orders are computed, nested dissection and approximate minimum
//! degree; the elimination tree predicts the work of each, and the cheaper is used.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Number of bodies at which dissection stops.
const LEAF: usize = 6;
/// Number of loads for which the order is chosen.
const LOADS: f64 = 200.0;

/// Neighbours of each node, in compressed rows, sorted and without repetition.
pub(crate) struct Graph {
    starts: Vec<usize>,
    neighbours: Vec<usize>,
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

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn neighbours_of(&self, k: usize) -> &[usize] {
        &self.neighbours[self.starts[k]..self.starts[k + 1]]
    }
}

/// The cheaper of nested dissection at the coordinates `at` and approximate minimum degree, by the predicted
/// work of the factor and of some hundred loads; also the predicted operations of the factor with six
/// unknowns for each body.
pub(crate) fn order(graph: &Graph, at: &[[f64; 3]]) -> (Vec<usize>, f64) {
    let mut best = nested_dissection(graph, at);
    let mut least = Work::new(graph, &best);
    if graph.len() > LEAF
        && let Some(order) = minimum_degree(graph)
    {
        let work = Work::new(graph, &order);
        if work.total() < least.total() {
            (best, least) = (order, work);
        }
    }
    (best, 216.0 * least.factor)
}

/// Approximate minimum degree; `None` if the memory does not suffice.
///
/// # Source
/// Amestoy, Davis and Duff (1996), SIAM J. Matrix Anal. Appl. 17.
fn minimum_degree(graph: &Graph) -> Option<Vec<usize>> {
    let n = graph.len();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &graph.starts, None, &graph.neighbours);
    let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
    let request = amd::order_maybe_unsorted_scratch::<usize>(n, graph.neighbours.len());
    let mut memory = MemBuffer::try_new(request).ok()?;
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(&mut forward, &mut inverse, pattern, amd::Control::default(), stack).ok()?;
    Some(forward)
}

/// Nested dissection: divides the nodes into halves across their longest extent, again and again. The nodes of
/// the first half that touch the second separate the two and come last in the order.
///
/// # Source
/// George (1973), SIAM J. Numer. Anal. 10; Heath and Raghavan (1995), SIAM J. Matrix Anal. Appl. 16.
fn nested_dissection(graph: &Graph, at: &[[f64; 3]]) -> Vec<usize> {
    let n = graph.len();
    let mut nodes: Vec<usize> = (0..n).collect();
    let mut side = vec![0_usize; n];
    let mut reversed = Vec::with_capacity(n);
    // Ranges of `nodes` that are not ordered yet; the last one comes last in the order.
    let mut open = vec![(0, n)];
    let mut mark = 0;
    while let Some((from, to)) = open.pop() {
        let part = &mut nodes[from..to];
        if part.len() <= LEAF {
            reversed.extend(part.iter().rev());
            continue;
        }
        let axis = longest_extent(part, at);
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&a, &b| at[a][axis].total_cmp(&at[b][axis]).then(a.cmp(&b)));
        mark += 1;
        part[half..].iter().for_each(|&k| side[k] = mark);
        // Within the first half: inner nodes first, then those that touch the second half.
        let (mut inner, mut edge) = (0, half);
        while inner < edge {
            if graph.neighbours_of(part[inner]).iter().any(|&other| side[other] == mark) {
                edge -= 1;
                part.swap(inner, edge);
            } else {
                inner += 1;
            }
        }
        part[edge..half].sort_unstable();
        reversed.extend(part[edge..half].iter().rev());
        open.push((from, from + edge));
        open.push((from + half, to));
    }
    reversed.reverse();
    reversed
}

/// Axis along which the nodes extend farthest.
fn longest_extent(part: &[usize], at: &[[f64; 3]]) -> usize {
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for &k in part {
        for (axis, [low, high]) in range.iter_mut().enumerate() {
            *low = low.min(at[k][axis]);
            *high = high.max(at[k][axis]);
        }
    }
    let extent = range.map(|[low, high]| high - low);
    (0..3).fold(0, |a, b| if extent[b] > extent[a] { b } else { a })
}

/// Predicted operations, in units of one pair of bodies.
struct Work {
    /// Operations of the factor.
    factor: f64,
    /// Operations of `LOADS` forward solves and of their products.
    loads: f64,
}

impl Work {
    fn total(&self) -> f64 {
        6.0 * self.factor + self.loads
    }

    /// Builds the elimination tree. A column with c entries costs c^2 operations in the factor; a load
    /// costs the entries of the columns on its path to the root, and a product of two loads the length of
    /// their common path.
    fn new(graph: &Graph, order: &[usize]) -> Work {
        let n = graph.len();
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        let none = usize::MAX;
        let (mut parent, mut seen, mut count) = (vec![none; n], vec![none; n], vec![1.0; n]);
        for (k, &node) in order.iter().enumerate() {
            seen[k] = k;
            for &other in graph.neighbours_of(node) {
                let mut i = place[other];
                while i < k && seen[i] != k {
                    seen[i] = k;
                    count[i] += 1.0;
                    if parent[i] == none {
                        parent[i] = k;
                    }
                    i = parent[i];
                }
            }
        }
        let (mut depth, mut below) = (vec![1.0; n], count.clone());
        for k in (0..n).rev().filter(|&k| parent[k] != none) {
            depth[k] += depth[parent[k]];
            below[k] += below[parent[k]];
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n.max(1) as f64;
        let loads = 2.0 * LOADS * mean(&below) + LOADS * LOADS / 6.0 * mean(&depth);
        Work { factor: count.iter().map(|c| c * c).sum(), loads }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of points a unit apart.
    fn lattice(sides: [usize; 3]) -> (Graph, Vec<[f64; 3]>) {
        let [p, q, r] = sides;
        let id = |i: usize, j: usize, k: usize| (i * q + j) * r + k;
        let (mut edges, mut at) = (Vec::new(), Vec::new());
        for i in 0..p {
            for j in 0..q {
                for k in 0..r {
                    at.push([i as f64, j as f64, k as f64]);
                    let next = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                    let inside = next.into_iter().filter(|&(i, j, k)| i < p && j < q && k < r);
                    edges.extend(inside.map(|(a, b, c)| [id(i, j, k), id(a, b, c)]));
                }
            }
        }
        (Graph::new(at.len(), &edges), at)
    }

    #[test]
    fn every_order_holds_every_node_once() {
        for sides in [[1, 1, 1], [40, 1, 1], [7, 6, 5]] {
            let (graph, at) = lattice(sides);
            let degree = minimum_degree(&graph).expect("small");
            for mut order in [degree, nested_dissection(&graph, &at), order(&graph, &at).0] {
                order.sort_unstable();
                assert!(order.iter().copied().eq(0..graph.len()));
            }
        }
    }

    #[test]
    fn dissection_leaves_short_paths_in_a_chain() {
        // A chain ordered from end to end has paths of n/2 on average; dissection has about log2 n.
        let (graph, at) = lattice([1000, 1, 1]);
        let straight: Vec<usize> = (0..1000).collect();
        let total = |order: &[usize]| Work::new(&graph, order).total();
        assert!(total(&nested_dissection(&graph, &at)) < 0.05 * total(&straight));
    }
}
