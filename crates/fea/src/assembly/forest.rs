//! Elimination order of a graph without loops, such as that of a girder or of a runway on its columns.
//!
//! Of such a graph one node separates the parts beside it. The centre of a part, whose removal leaves no piece with more
//! than half of its nodes, comes last in the order, then the centres of the pieces, again and again: every path in the
//! elimination tree is as short as the logarithm of the number of nodes, and a piece touches at most as many nodes that
//! come later. This takes n log n operations, and no search for separators.
//!
//! # Source
//! Jordan, Sur les assemblages de lignes, Journal fuer die reine und angewandte Mathematik 70 (1869): the centre of a
//! tree.

use super::graph::Graph;

/// Number of nodes of a part that is not divided further.
pub(super) const LEAF: usize = 6;

/// No node.
const NONE: usize = usize::MAX;

/// The order; `None` if the graph has a loop.
pub(super) fn order_of_forest(graph: &Graph) -> Option<Vec<usize>> {
    let n = graph.len();
    let mut roots = roots_of_forest(graph)?;
    let mut pieces = Pieces {
        graph,
        is_ordered: vec![false; n],
        above: vec![NONE; n],
        size: vec![0; n],
    };
    let mut reached = Vec::with_capacity(n);
    let mut reversed = Vec::with_capacity(n);
    while let Some(root) = roots.pop() {
        pieces.reach(root, &mut reached);
        if reached.len() <= LEAF {
            for node in &reached {
                pieces.is_ordered[*node] = true;
            }
            reversed.extend_from_slice(&reached);
            continue;
        }
        let centre = pieces.centre(&reached);
        pieces.is_ordered[centre] = true;
        reversed.push(centre);
        roots.extend(
            graph
                .neighbours_of(centre)
                .iter()
                .filter(|other| !pieces.is_ordered[**other]),
        );
    }
    reversed.reverse();
    Some(reversed)
}

/// A node of each part of a graph; `None` if the graph has a loop: it has more edges than nodes that are not roots.
fn roots_of_forest(graph: &Graph) -> Option<Vec<usize>> {
    let n = graph.len();
    if graph.edge_count() >= n.max(1) {
        return None;
    }
    let (mut roots, mut is_reached, mut open) = (Vec::new(), vec![false; n], Vec::new());
    for root in 0..n {
        if is_reached[root] {
            continue;
        }
        roots.push(root);
        is_reached[root] = true;
        open.push(root);
        while let Some(node) = open.pop() {
            for &other in graph.neighbours_of(node) {
                if !std::mem::replace(&mut is_reached[other], true) {
                    open.push(other);
                }
            }
        }
    }
    (graph.edge_count() + roots.len() == n).then_some(roots)
}

/// The pieces of a graph without loops that remain when the ordered nodes are removed.
struct Pieces<'g> {
    graph: &'g Graph,
    is_ordered: Vec<bool>,
    /// The neighbour of each node on the way to the root of its piece, and the number of nodes behind it, with it.
    above: Vec<usize>,
    size: Vec<usize>,
}

impl Pieces<'_> {
    /// Writes the nodes of the piece of `root` into `reached`, each after the one above it.
    fn reach(&mut self, root: usize, reached: &mut Vec<usize>) {
        reached.clear();
        reached.push(root);
        self.above[root] = NONE;
        let mut next = 0;
        while let Some(&node) = reached.get(next) {
            next += 1;
            for &other in self.graph.neighbours_of(node) {
                if other != self.above[node] && !self.is_ordered[other] {
                    self.above[other] = node;
                    reached.push(other);
                }
            }
        }
    }

    /// The node of a piece whose removal leaves no part with more than half of the others.
    fn centre(&mut self, reached: &[usize]) -> usize {
        reached.iter().for_each(|node| self.size[*node] = 1);
        // from the ends to the root: the first node that has half of the nodes behind it, at the latest the root
        for &node in reached.iter().rev() {
            if 2 * self.size[node] >= reached.len() {
                return node;
            }
            self.size[self.above[node]] += self.size[node];
        }
        reached[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: every node is there once, also of a forest with lone nodes; a loop is refused.
    #[test]
    fn forests_are_ordered_and_loops_refused() {
        for n in [0, 1, 2, 7, 500] {
            // node k hangs on an earlier one, every tenth on none
            let edges: Vec<[usize; 2]> = (1..n)
                .filter(|k| k % 10 != 0)
                .map(|k| [k, (7 * k * k + 3) % k])
                .collect();
            let mut order = order_of_forest(&Graph::new(n, &edges)).expect("no loops");
            order.sort_unstable();
            assert!(order.into_iter().eq(0..n), "{n}");
        }
        assert!(order_of_forest(&Graph::new(3, &[[0, 1], [1, 2], [2, 0]])).is_none());
        assert!(order_of_forest(&Graph::new(9, &[[3, 4], [4, 5], [5, 3], [7, 8]])).is_none());
    }
}
