//! Sparse sums: entries given in any order, added up column by column.

use sprs::CsMat;

use crate::real::Real;

/// Entries of a square matrix, several of which may fall on one place.
#[derive(Debug)]
pub(crate) struct Triplets<T> {
    n: usize,
    entries: Vec<(u32, u32, T)>,
}

impl<T: Real> Triplets<T> {
    /// No entry yet, room for `count`; at most 2^32 rows.
    pub fn new(n: usize, count: usize) -> Triplets<T> {
        Triplets { n, entries: Vec::with_capacity(count) }
    }

    pub fn add(&mut self, row: usize, column: usize, value: T) {
        self.entries.push((row as u32, column as u32, value));
    }

    /// The sums, rows increasing within each column; entries of one place add up in the order given.
    pub fn sum(self) -> CsMat<T> {
        let n = self.n;
        let mut ends = vec![0_usize; n + 1];
        self.entries.iter().for_each(|entry| ends[entry.1 as usize + 1] += 1);
        (0..n).for_each(|column| ends[column + 1] += ends[column]);
        let mut next = ends.clone();
        let mut sorted = vec![(0_u32, T::zero()); self.entries.len()];
        for (row, column, value) in self.entries {
            let place = &mut next[column as usize];
            sorted[*place] = (row, value);
            *place += 1;
        }
        let mut starts = Vec::with_capacity(n + 1);
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        // Place of each row in the column at hand; beyond its start if it has one.
        let mut place = vec![usize::MAX; n];
        let mut order: Vec<(u32, T)> = Vec::new();
        for column in 0..n {
            starts.push(rows.len());
            order.clear();
            for &(row, value) in &sorted[ends[column]..ends[column + 1]] {
                match order.get_mut(place[row as usize]) {
                    Some(known) if known.0 == row => known.1 += value,
                    _ => {
                        place[row as usize] = order.len();
                        order.push((row, value));
                    }
                }
            }
            order.sort_unstable_by_key(|entry| entry.0);
            rows.extend(order.iter().map(|entry| entry.0 as usize));
            values.extend(order.iter().map(|entry| entry.1));
        }
        starts.push(rows.len());
        CsMat::new_csc((n, n), starts, rows, values)
    }
}

#[cfg(test)]
mod tests {
    use super::Triplets;

    #[test]
    fn entries_of_one_place_add_up_wherever_they_stand() {
        let given =
            [(2, 0, 1.0), (0, 3, 2.0), (1, 1, 3.0), (2, 0, 4.0), (0, 0, 5.0), (0, 3, -2.5), (3, 3, 6.0)];
        let mut triplets = Triplets::new(4, given.len());
        given.iter().for_each(|&(row, column, value)| triplets.add(row, column, value));
        let found: Vec<_> = triplets.sum().iter().map(|(&value, place)| (place, value)).collect();
        let wanted = [((0, 0), 5.0), ((2, 0), 5.0), ((1, 1), 3.0), ((0, 3), -0.5), ((3, 3), 6.0)];
        assert_eq!(found, wanted);
    }
}
