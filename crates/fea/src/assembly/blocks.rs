//! Sums of 6 x 6 blocks over the columns of pairs of bodies, and the sparse matrix of their unknowns.

use sprs::CsMat;

use crate::assembly::element::Matrix6;
use crate::assembly::precision::Real;

/// Columns of a body.
const COLUMNS: usize = 6;

/// The unknowns among the columns of a body.
struct Places {
    /// The first unknown.
    first: usize,
    count: usize,
    /// Their columns; the first `count` are valid.
    columns: [usize; COLUMNS],
}

impl Places {
    fn new(unknown: &[Option<usize>]) -> Places {
        let mut out = Places {
            first: 0,
            count: 0,
            columns: [0; COLUMNS],
        };
        for (column, place) in unknown
            .iter()
            .enumerate()
            .filter_map(|(k, place)| Some((k, (*place)?)))
        {
            if out.count == 0 {
                out.first = place;
            }
            out.columns[out.count] = column;
            out.count += 1;
        }
        out
    }

    /// Each unknown with its column.
    fn unknowns(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (self.first..).zip(self.columns[..self.count].iter().copied())
    }
}

/// A symmetric matrix over the columns of all bodies, six for each, as the sum of the blocks that are added to it.
///
/// Entries of the same place are added in the order in which they are given.
#[derive(Debug)]
pub(crate) struct BlockSums<T: Real> {
    /// Diagonal block of each body.
    own: Vec<Matrix6<T>>,
    /// Two different bodies, and a block over the columns of the first (rows) and of the second.
    couplings: Vec<([usize; 2], Matrix6<T>)>,
}

impl<T: Real> BlockSums<T> {
    /// Zero over the columns of `bodies`, with room for some couplings.
    pub fn new(bodies: usize, couplings: usize) -> BlockSums<T> {
        BlockSums {
            own: vec![Matrix6::zeros(); bodies],
            couplings: Vec::with_capacity(couplings),
        }
    }

    /// Adds a symmetric block to the columns of one body.
    pub fn add_own(&mut self, body: usize, block: &Matrix6<T>) {
        self.own[body] += block;
    }

    /// Adds a block between two different bodies, and its transpose.
    pub fn add_coupling(&mut self, bodies: [usize; 2], block: Matrix6<T>) {
        self.couplings.push((bodies, block));
    }

    /// The pairs of bodies with a block between them; a pair may be named several times.
    pub fn pairs(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.couplings.iter().map(|coupling| coupling.0)
    }

    /// The three rotational columns of the diagonal block of a body.
    pub fn rotational(&self, body: usize) -> [[T; 3]; 3] {
        let block = &self.own[body];
        std::array::from_fn(|i| std::array::from_fn(|j| block[(3 + i, 3 + j)]))
    }

    /// The upper triangle of S K S by compressed columns, rows increasing within each; K is the matrix over the unknowns.
    ///
    /// `unknown` is the unknown of each column of the bodies, if it is one, `scale` the diagonal of S, powers of two. The
    /// unknowns of a body adjoin each other in the order of its columns.
    ///
    /// The columns of a body are made together. The couplings to bodies that come before it in the order are added up, one
    /// block for each of these, and the blocks are written one below the other, the own one last. A sum of exactly zero
    /// has no place, except on the diagonal.
    pub fn upper(&self, unknown: &[Option<usize>], scale: &[f64]) -> CsMat<T> {
        let places: Vec<Places> = unknown.chunks_exact(COLUMNS).map(Places::new).collect();
        let mut order: Vec<usize> = (0..self.own.len())
            .filter(|&body| places[body].count > 0)
            .collect();
        order.sort_unstable_by_key(|&body| places[body].first);
        let (starts, sorted) = self.by_later_body(&places);

        let n = scale.len();
        let most = 36 * sorted.len() + 21 * order.len();
        let (mut rows, mut values) = (Vec::with_capacity(most), Vec::with_capacity(most));
        let mut column_starts = Vec::with_capacity(n + 1);
        let mut blocks: Vec<(usize, Matrix6<T>)> = Vec::new();
        // Index of each body in `blocks`, valid if the block there is of this body.
        let mut index = vec![usize::MAX; self.own.len()];
        for body in order {
            blocks.clear();
            for &coupling in &sorted[starts[body]..starts[body + 1]] {
                let (pair, block) = &self.couplings[coupling];
                let (before, block) = if pair[1] == body {
                    (pair[0], *block)
                } else {
                    (pair[1], block.transpose())
                };
                match blocks.get_mut(index[before]) {
                    Some((known, sum)) if *known == before => *sum += block,
                    _ => {
                        index[before] = blocks.len();
                        blocks.push((before, block));
                    }
                }
            }
            // Places change: the indices are of no more use.
            blocks.iter().for_each(|block| index[block.0] = usize::MAX);
            blocks.sort_unstable_by_key(|block| places[block.0].first);
            blocks.push((body, self.own[body]));
            for (column, j) in places[body].unknowns() {
                column_starts.push(rows.len());
                let to = T::from(scale[column]);
                for (other, block) in &blocks {
                    let entries = &block.data.0[j];
                    for (row, i) in places[*other]
                        .unknowns()
                        .take_while(|&(row, _)| row <= column)
                    {
                        let sum = entries[i];
                        if sum != T::zero() || row == column {
                            rows.push(row);
                            values.push(T::from(scale[row]) * sum * to);
                        }
                    }
                }
            }
        }
        column_starts.push(rows.len());
        CsMat::new_csc((n, n), column_starts, rows, values)
    }

    /// The couplings of unknowns, sorted by the later one of their bodies and otherwise as given: the start of each body in
    /// the list, and the list.
    fn by_later_body(&self, places: &[Places]) -> (Vec<usize>, Vec<usize>) {
        let later = |pair: [usize; 2]| {
            let [a, b] = pair.map(|body| &places[body]);
            (a.count > 0 && b.count > 0).then_some(if a.first > b.first {
                pair[0]
            } else {
                pair[1]
            })
        };
        let mut starts = vec![0; self.own.len() + 1];
        self.pairs()
            .filter_map(later)
            .for_each(|body| starts[body + 1] += 1);
        (0..self.own.len()).for_each(|body| starts[body + 1] += starts[body]);
        let mut next = starts.clone();
        let mut sorted = vec![0; starts[self.own.len()]];
        for (coupling, pair) in self.pairs().enumerate() {
            if let Some(body) = later(pair) {
                sorted[next[body]] = coupling;
                next[body] += 1;
            }
        }
        (starts, sorted)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::AddAssign;

    use nalgebra::DMatrix;

    use super::*;

    /// Sums over all columns, of which some are unknowns, against a dense matrix to which each block is added; several blocks
    /// between the same bodies, in both directions.
    #[test]
    fn blocks_of_one_place_add_up_wherever_they_stand() {
        let mut random = fastrand::Rng::with_seed(3);
        for _ in 0..40 {
            let bodies = 2 + random.usize(..6);
            let mut sums = BlockSums::<f64>::new(bodies, 0);
            let mut dense = DMatrix::<f64>::zeros(6 * bodies, 6 * bodies);
            for _ in 0..3 * bodies {
                // Small integers add up without rounding; many are zero.
                let block = Matrix6::from_fn(|_, _| f64::from(random.i32(-1..3).max(0)));
                let pair = [random.usize(..bodies), random.usize(..bodies)];
                let [row, column] = pair.map(|body| 6 * body);
                if pair[0] == pair[1] {
                    let block = block + block.transpose();
                    sums.add_own(pair[0], &block);
                    dense.fixed_view_mut::<6, 6>(row, row).add_assign(&block);
                } else {
                    sums.add_coupling(pair, block);
                    dense.fixed_view_mut::<6, 6>(row, column).add_assign(&block);
                    dense
                        .fixed_view_mut::<6, 6>(column, row)
                        .add_assign(&block.transpose());
                }
            }
            let mut order: Vec<usize> = (0..bodies).collect();
            random.shuffle(&mut order);
            let (mut unknown, mut columns) = (vec![None; 6 * bodies], Vec::new());
            for body in order {
                for k in (0..6).filter(|_| random.u8(..4) > 0) {
                    unknown[6 * body + k] = Some(columns.len());
                    columns.push(6 * body + k);
                }
            }
            let scale: Vec<f64> = columns
                .iter()
                .map(|&column| [0.5, 1.0, 4.0][column % 3])
                .collect();
            let upper = sums.upper(&unknown, &scale);
            assert!(upper.iter().all(|(_, (i, j))| i <= j), "the upper triangle");
            for j in 0..columns.len() {
                assert!(upper.get(j, j).is_some(), "the diagonal has places");
                for i in 0..=j {
                    let wanted = scale[i] * dense[(columns[i], columns[j])] * scale[j];
                    assert_eq!(upper.get(i, j).copied().unwrap_or(0.0), wanted);
                }
            }
        }
    }
}
