//! Elimination order of the bodies of a frame.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Approximate minimum degree order of a graph of `n` nodes: the nodes in the order of elimination, or
/// their given order where memory does not suffice.
///
/// Ordering the graph of bodies, not of freedoms, is six times less work and leaves bodies whole.
///
/// # Source
/// Amestoy, Davis and Duff (1996), SIAM J. Matrix Anal. Appl. 17.
pub(crate) fn order(n: usize, edges: &[[usize; 2]]) -> Vec<usize> {
    let mut pairs: Vec<(usize, usize)> = edges.iter().map(|&[a, b]| (a.max(b), a.min(b))).collect();
    pairs.extend((0..n).map(|k| (k, k)));
    pairs.sort_unstable();
    pairs.dedup();
    let mut starts = vec![0; n + 1];
    for &(column, _) in &pairs {
        starts[column + 1] += 1;
    }
    for k in 0..n {
        starts[k + 1] += starts[k];
    }
    let rows: Vec<usize> = pairs.iter().map(|pair| pair.1).collect();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
    let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
    let request = amd::order_maybe_unsorted_scratch::<usize>(n, rows.len());
    let done = MemBuffer::try_new(request).is_ok_and(|mut memory| {
        let stack = MemStack::new(&mut memory);
        amd::order_maybe_unsorted(&mut forward, &mut inverse, pattern, amd::Control::default(), stack).is_ok()
    });
    if done { forward } else { (0..n).collect() }
}
