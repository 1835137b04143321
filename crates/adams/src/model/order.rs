//! The order in which the slots are evaluated, and the algebraic loops among them.

use std::collections::BTreeSet;

/// Slots that are found together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Block {
    /// A slot that follows from those before it.
    Direct(usize),
    /// An algebraic loop. Given values of the torn slots, the `rest` follows in order; the unknowns are the
    /// torn values, and the equations say that each equals its own expression.
    Loop { torn: Vec<usize>, rest: Vec<usize> },
}

/// Orders the slots into blocks so that each block reads only itself and the blocks before it.
///
/// `needs[k]` are the slots that the expression of slot k reads. Slots that read each other form a strongly
/// connected component of this graph. Each such component becomes a loop, whose torn slots are chosen
/// greedily until the rest has no cycle. Slots with `implicit[k]` are always torn; those with `preferred[k]`
/// are torn before others.
///
/// # Source
/// Strongly connected components: R. Tarjan, SIAM Journal on Computing 1(2), 1972; here by two searches
/// (Kosaraju).
pub(crate) fn order(
    needs: &[BTreeSet<usize>],
    implicit: &[bool],
    preferred: &[bool],
) -> Vec<Block> {
    let all: BTreeSet<usize> = (0..needs.len()).collect();
    components(needs, &all)
        .into_iter()
        .map(|group| {
            let first = group.first().copied().unwrap_or(0);
            if group.len() == 1 && !implicit[first] && !needs[first].contains(&first) {
                return Block::Direct(first);
            }
            let (torn, rest) = tear(needs, implicit, preferred, group.into_iter().collect());
            Block::Loop { torn, rest }
        })
        .collect()
}

/// The torn slots of a loop, and its other slots in order.
fn tear(
    needs: &[BTreeSet<usize>],
    implicit: &[bool],
    preferred: &[bool],
    group: BTreeSet<usize>,
) -> (Vec<usize>, Vec<usize>) {
    let (mut torn, mut left): (BTreeSet<usize>, BTreeSet<usize>) =
        group.iter().partition(|k| implicit[**k]);
    loop {
        let groups = components(needs, &left);
        let closed =
            |group: &Vec<usize>| group.len() > 1 || group.iter().any(|k| needs[*k].contains(k));
        let Some(group) = groups.iter().find(|group| closed(group)) else {
            return (torn.into_iter().collect(), groups.concat());
        };
        // A slot that reads itself must be torn. Otherwise the one that most others read is torn, the first
        // of equals.
        let inside: BTreeSet<usize> = group.iter().copied().collect();
        let uses = |k: usize| {
            inside
                .iter()
                .filter(|other| needs[**other].contains(&k))
                .count()
        };
        let rank = |k: usize| {
            (
                needs[k].contains(&k),
                preferred[k],
                uses(k),
                std::cmp::Reverse(k),
            )
        };
        let Some(best) = inside.iter().copied().max_by_key(|k| rank(*k)) else {
            return (torn.into_iter().collect(), groups.concat());
        };
        torn.insert(best);
        left.remove(&best);
    }
}

/// The strongly connected components among `nodes`, each after those that it needs.
fn components(needs: &[BTreeSet<usize>], nodes: &BTreeSet<usize>) -> Vec<Vec<usize>> {
    // The slots that read each slot: the reversed graph.
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); needs.len()];
    for &k in nodes {
        for &need in needs[k].intersection(nodes) {
            users[need].push(k);
        }
    }
    // The order in which a depth-first search of the reversed graph finishes, with a stack instead of
    // recursion.
    let mut seen = BTreeSet::new();
    let mut finished: Vec<usize> = Vec::new();
    for &root in nodes {
        if !seen.insert(root) {
            continue;
        }
        let mut stack = vec![(root, 0)];
        while let Some((k, next)) = stack.pop() {
            if let Some(&user) = users[k].get(next) {
                stack.push((k, next + 1));
                if seen.insert(user) {
                    stack.push((user, 0));
                }
            } else {
                finished.push(k);
            }
        }
    }
    // A search of the graph from the last finished slot reaches exactly one component, and so on.
    let mut out: Vec<Vec<usize>> = Vec::new();
    let mut left = nodes.clone();
    for &root in finished.iter().rev() {
        if !left.remove(&root) {
            continue;
        }
        let (mut group, mut stack) = (vec![root], vec![root]);
        while let Some(k) = stack.pop() {
            for need in needs[k].iter().copied() {
                if left.remove(&need) {
                    group.push(need);
                    stack.push(need);
                }
            }
        }
        group.sort_unstable();
        out.push(group);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Block, order};
    use std::collections::BTreeSet;

    #[test]
    fn loops_are_cut_at_variables_and_the_rest_follows_in_order() {
        // 0 and 1 variables, 2 and 3 forces on them, 4 reads all, 5 reads itself.
        let lists: [&[usize]; 6] = [&[2, 3], &[2, 3], &[0], &[1], &[0, 1, 2], &[5]];
        let needs: Vec<BTreeSet<usize>> = lists
            .iter()
            .map(|list| list.iter().copied().collect())
            .collect();
        let blocks = order(
            &needs,
            &[false; 6],
            &[true, true, false, false, false, false],
        );
        assert_eq!(blocks.len(), 3);
        let at = |wanted: &Block| blocks.iter().position(|block| block == wanted);
        let both = |rest: [usize; 2]| {
            at(&Block::Loop {
                torn: vec![0, 1],
                rest: rest.to_vec(),
            })
        };
        let pair = both([2, 3]).or(both([3, 2])).expect("two variables");
        assert!(
            at(&Block::Loop {
                torn: vec![5],
                rest: vec![]
            })
            .is_some()
        );
        assert!(at(&Block::Direct(4)) > Some(pair));
    }
}
