//! Elimination order of the bodies of a frame.
//!
//! The graph has a node for each body, not for each degree of freedom: its ordering is six times less work, and
//! the columns of a body stay together. A graph without loops has an order of its own. Of others two are computed, nested
//! dissection and approximate minimum degree; the elimination tree predicts the work of each, and the cheaper is used.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use super::forest::{LEAF, order_of_forest};
use super::graph::Graph;

/// Product of two sides, by that of equal ones, from which a separator of one node is as good as any.
const BALANCED: f64 = 0.9;
/// Number of loads for which the order is chosen.
const LOADS: f64 = 200.0;

/// The order of a forest, or the cheaper of nested dissection and approximate minimum degree, by the predicted work of the
/// factor and of some hundred loads; also the predicted operations of the factor with six unknowns for each body.
pub(crate) fn order(graph: &Graph) -> (Vec<usize>, f64) {
    if let Some(order) = order_of_forest(graph) {
        let work = Work::new(graph, &order);
        return (order, 216.0 * work.factor);
    }
    let mut best = nested_dissection(graph);
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
    let pattern =
        SymbolicSparseColMatRef::new_checked(n, n, &graph.starts, None, &graph.neighbours);
    let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
    let request = amd::order_maybe_unsorted_scratch::<usize>(n, graph.neighbours.len());
    let mut memory = MemBuffer::try_new(request).ok()?;
    let stack = MemStack::new(&mut memory);
    amd::order_maybe_unsorted(
        &mut forward,
        &mut inverse,
        pattern,
        amd::Control::default(),
        stack,
    )
    .ok()?;
    Some(forward)
}

/// Nested dissection by level structures: a set of nodes separates each part of the graph into two and comes last in the
/// order, again and again.
///
/// The nodes of a part are sorted by their distances from both ends of a longest way through it, and by the difference of
/// the two. Each place of a sorted list divides it into two sides; the nodes of one side that touch the other separate
/// them. Of all places, lists and sides that one is used whose separator S between the rests A and B has the least
/// |S| / (|A| |B|). In a building such separators run along its diagonals and are smaller than its planes.
///
/// # Source
/// George and Liu (1978), SIAM J. Numer. Anal. 15 (level structures); Leiserson and Rao (1999), J. ACM 46 (the ratio).
fn nested_dissection(graph: &Graph) -> Vec<usize> {
    let n = graph.len();
    let mut dissection = Dissection::new(graph);
    let mut reversed = Vec::with_capacity(n);
    // Parts that are not ordered yet; the last one comes last in the order.
    let mut open = vec![(0..n).collect::<Vec<usize>>()];
    while let Some(part) = open.pop() {
        if part.len() <= LEAF {
            reversed.extend(part.iter().rev());
            continue;
        }
        match dissection.divide(&part) {
            Division::Separated { sides, separator } => {
                reversed.extend(separator.iter().rev());
                open.extend(sides);
            }
            Division::Components(components) => open.extend(components),
            Division::Whole => reversed.extend(part.iter().rev()),
        }
    }
    reversed.reverse();
    reversed
}

/// What a part of a graph is divided into.
enum Division {
    /// Two sides, and the nodes between them.
    Separated {
        sides: [Vec<usize>; 2],
        separator: Vec<usize>,
    },
    /// Parts that nothing connects.
    Components(Vec<Vec<usize>>),
    /// Every node touches every other.
    Whole,
}

/// A place in a sorted list of nodes that divides it.
struct Cut {
    ratio: f64,
    sorted: Vec<usize>,
    place: usize,
    /// Whether the separator is taken from the second side.
    second: bool,
}

/// Dissection of a graph, with its scratch.
struct Dissection<'a> {
    graph: &'a Graph,
    /// Part that a node belongs to.
    part: Vec<usize>,
    parts: usize,
    /// Distance of each node from the start of the last search; valid within the part.
    distance: Vec<usize>,
    /// Place of each node in the sorted list; valid within the part.
    place: Vec<usize>,
}

impl Dissection<'_> {
    fn new(graph: &Graph) -> Dissection<'_> {
        let n = graph.len();
        Dissection {
            graph,
            part: vec![0; n],
            parts: 0,
            distance: vec![0; n],
            place: vec![0; n],
        }
    }

    fn divide(&mut self, part: &[usize]) -> Division {
        self.mark(part);
        let mut reached = self.search(part[0]);
        if reached.len() < part.len() {
            let mut components = vec![reached];
            for &node in part {
                if self.distance[node] == usize::MAX {
                    reached = self.search(node);
                    components.push(reached);
                }
            }
            return Division::Components(components);
        }
        // The node that is farthest from any node lies at an end of the part.
        let end = reached[part.len() - 1];
        self.unreach(part);
        let from_first = self.search(end);
        let first: Vec<usize> = from_first.iter().map(|&node| self.distance[node]).collect();
        let mut best = None;
        self.find_cut(from_first.clone(), &mut best);
        // No separator is smaller than one node: where it lies near the middle, nothing better is looked for.
        let half = 0.5 * part.len() as f64;
        if let Some(cut) = best.take_if(|cut| cut.ratio * BALANCED * half * half <= 1.0) {
            return self.separate(cut);
        }
        self.unreach(part);
        let from_second = self.search(from_first[part.len() - 1]);
        let farthest = self.distance[from_second[part.len() - 1]];
        let difference = self.by_difference(&from_first, &first, farthest);
        for sorted in [from_second, difference] {
            self.find_cut(sorted, &mut best);
        }
        best.map_or(Division::Whole, |cut| self.separate(cut))
    }

    /// Makes the nodes a part of their own that no search has reached.
    fn mark(&mut self, part: &[usize]) {
        self.parts += 1;
        for &node in part {
            (self.part[node], self.distance[node]) = (self.parts, usize::MAX);
        }
    }

    fn unreach(&mut self, part: &[usize]) {
        part.iter()
            .for_each(|&node| self.distance[node] = usize::MAX);
    }

    /// Breadth-first search within a part: the nodes that are connected to `start`, by increasing distance.
    fn search(&mut self, start: usize) -> Vec<usize> {
        let own = self.part[start];
        self.distance[start] = 0;
        let mut reached = vec![start];
        let mut next = 0;
        while next < reached.len() {
            let node = reached[next];
            next += 1;
            for &other in self.graph.neighbours_of(node) {
                if self.part[other] == own && self.distance[other] == usize::MAX {
                    self.distance[other] = self.distance[node] + 1;
                    reached.push(other);
                }
            }
        }
        reached
    }

    /// The nodes by their distance `first` from one end less that from the other, at most `farthest`.
    fn by_difference(&self, nodes: &[usize], first: &[usize], farthest: usize) -> Vec<usize> {
        let keys: Vec<usize> = nodes
            .iter()
            .zip(first)
            .map(|(&node, first)| first + farthest - self.distance[node])
            .collect();
        let mut starts = vec![0; 2 * farthest + 2];
        keys.iter().for_each(|key| starts[key + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        let mut sorted = vec![0; nodes.len()];
        for (&node, key) in nodes.iter().zip(keys) {
            sorted[starts[key]] = node;
            starts[key] += 1;
        }
        sorted
    }

    /// Replaces the cut by the best place of a sorted list, if it is better.
    fn find_cut(&mut self, sorted: Vec<usize>, best: &mut Option<Cut>) {
        let n = sorted.len();
        let own = self.part[sorted[0]];
        sorted
            .iter()
            .enumerate()
            .for_each(|(k, &node)| self.place[node] = k);
        // Changes of the sizes of both separators from one place to the next.
        let mut changes = vec![[0_isize; 2]; n + 1];
        for (k, &node) in sorted.iter().enumerate() {
            let (mut low, mut high) = (k, k);
            for &other in self.graph.neighbours_of(node) {
                if self.part[other] == own {
                    (low, high) = (low.min(self.place[other]), high.max(self.place[other]));
                }
            }
            // The node touches the second side from the place after it on, and the first up to its own place.
            changes[k + 1][0] += 1;
            changes[high + 1][0] -= 1;
            changes[low + 1][1] += 1;
            changes[k + 1][1] -= 1;
        }
        let mut found = best
            .as_ref()
            .map_or((f64::INFINITY, None), |cut| (cut.ratio, None));
        let mut sizes = [0_isize; 2];
        for (place, change) in changes.iter().enumerate().take(n) {
            for second in [0, 1] {
                sizes[second] += change[second];
                let size = sizes[second] as usize;
                let sides = if second == 0 {
                    [place - size, n - place]
                } else {
                    [place, n - place - size]
                };
                let ratio = size as f64 / (sides[0] * sides[1]) as f64;
                // No sides give infinity, or no number.
                if ratio < found.0 {
                    found = (ratio, Some((place, second == 1)));
                }
            }
        }
        if let (ratio, Some((place, second))) = found {
            *best = Some(Cut {
                ratio,
                sorted,
                place,
                second,
            });
        }
    }

    fn separate(&mut self, cut: Cut) -> Division {
        let Cut {
            sorted,
            place,
            second,
            ..
        } = cut;
        let own = self.part[sorted[0]];
        sorted
            .iter()
            .enumerate()
            .for_each(|(k, &node)| self.place[node] = k);
        let mut sides = [
            Vec::with_capacity(place),
            Vec::with_capacity(sorted.len() - place),
        ];
        let mut separator = Vec::new();
        for (k, &node) in sorted.iter().enumerate() {
            let side = k >= place;
            let touches =
                |&other: &usize| self.part[other] == own && (self.place[other] >= place) != side;
            if side == second && self.graph.neighbours_of(node).iter().any(touches) {
                separator.push(node);
            } else {
                sides[usize::from(side)].push(node);
            }
        }
        Division::Separated { sides, separator }
    }
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
        order
            .iter()
            .enumerate()
            .for_each(|(k, &node)| place[node] = k);
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
        Work {
            factor: count.iter().map(|c| c * c).sum(),
            loads,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of points, each joined to its neighbours along the axes.
    fn lattice(sides: [usize; 3]) -> Graph {
        let [p, q, r] = sides;
        let id = |i: usize, j: usize, k: usize| (i * q + j) * r + k;
        let mut edges = Vec::new();
        for i in 0..p {
            for j in 0..q {
                for k in 0..r {
                    let next = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                    let inside = next
                        .into_iter()
                        .filter(|&(i, j, k)| i < p && j < q && k < r);
                    edges.extend(inside.map(|(a, b, c)| [id(i, j, k), id(a, b, c)]));
                }
            }
        }
        Graph::new(p * q * r, &edges)
    }

    #[test]
    fn every_order_holds_every_node_once() {
        for sides in [[1, 1, 1], [40, 1, 1], [7, 6, 5]] {
            let graph = lattice(sides);
            let degree = minimum_degree(&graph).expect("small");
            for mut order in [degree, nested_dissection(&graph), order(&graph).0] {
                order.sort_unstable();
                assert!(order.iter().copied().eq(0..graph.len()));
            }
        }
    }

    #[test]
    fn dissection_leaves_short_paths_in_a_chain() {
        // A chain ordered from end to end has paths of n/2 on average; dissection has about log2 n.
        let graph = lattice([1000, 1, 1]);
        let straight: Vec<usize> = (0..1000).collect();
        let total = |order: &[usize]| Work::new(&graph, order).total();
        assert!(total(&nested_dissection(&graph)) < 0.05 * total(&straight));
    }

    /// A runway on columns, a girder whose points are numbered at random, and a star: the order of a forest takes about as
    /// much work as the better of the others.
    #[test]
    fn orders_of_forests_are_as_good_as_the_others() {
        let runway: Vec<[usize; 2]> = (0..1000)
            .map(|k| [k, k + 1])
            .chain((0..400).map(|k| {
                if k % 4 == 0 {
                    [10 * (k / 4), 1001 + k]
                } else {
                    [1000 + k, 1001 + k]
                }
            }))
            .collect();
        let shuffled = |k: usize| (k * 617) % 1000;
        let girder: Vec<[usize; 2]> = (0..999).map(|k| [shuffled(k), shuffled(k + 1)]).collect();
        let star: Vec<[usize; 2]> = (1..300)
            .map(|k| [if k < 30 { 0 } else { k - 29 }, k])
            .collect();
        for (n, edges) in [(1401, runway), (1000, girder), (300, star)] {
            let graph = Graph::new(n, &edges);
            let others = [
                nested_dissection(&graph),
                minimum_degree(&graph).expect("small"),
            ];
            let least = others
                .map(|order| Work::new(&graph, &order).total())
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            let own = Work::new(&graph, &order_of_forest(&graph).expect("no loops")).total();
            assert!(own < 1.05 * least, "{n}: {own} for {least}");
        }
    }

    #[test]
    fn separators_run_along_the_diagonals_of_a_cube() {
        // A plane of the cube has 144 points, a diagonal one 108. Dissection by planes takes 1.1e7 operations.
        let graph = lattice([12, 12, 12]);
        assert!(Work::new(&graph, &nested_dissection(&graph)).factor < 5.5e6);
    }

    #[test]
    fn parts_that_nothing_connects_and_nodes_that_all_touch_are_ordered() {
        let mut edges: Vec<[usize; 2]> =
            (0..20).flat_map(|a| (0..a).map(move |b| [a, b])).collect();
        edges.extend((21..60).map(|k| [k, k + 1]));
        let mut order = nested_dissection(&Graph::new(80, &edges));
        order.sort_unstable();
        assert!(order.into_iter().eq(0..80));
    }
}
