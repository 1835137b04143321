//! Points of the unit hypercube, by the number of the run: Latin hypercubes and Sobol sequences.
//!
//! Every coordinate depends on the seed, the axis, the run and the number of runs alone, so that runs can be made in
//! any order and on any machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sobol::Sobol;
use sobol::params::JoeKuoD6;

/// Points of the open unit hypercube.
#[derive(Clone, Debug)]
pub(crate) enum UnitPoints {
    /// A Latin hypercube: by axis, the interval in which each run lies, and the generator of its place within it.
    Latin(Vec<(Vec<u32>, ChaCha8Rng)>),
    /// A Sobol sequence: by axis, the direction numbers and the shift.
    Sobol(Vec<(Vec<u64>, u64)>),
}

impl UnitPoints {
    /// A Latin hypercube of `count` points (McKay, Beckman and Conover, 1979): along each axis the unit interval is
    /// divided into `count` equal parts, in a random order, and each point lies at a random place of its part.
    pub fn latin(axes: usize, count: usize, seed: u64) -> UnitPoints {
        let axis = |axis: u64| {
            let mut order: Vec<u32> = (0..u32::try_from(count).unwrap_or(u32::MAX)).collect();
            let mut random = generator(seed, 2 * axis);
            // Fisher and Yates; a product of 64 bits and a length below 2^32 is uniform to 2^-32
            for last in (1..order.len()).rev() {
                let chosen = (u128::from(random.next_u64()) * (last as u128 + 1)) >> 64;
                order.swap(last, chosen as usize);
            }
            (order, generator(seed, 2 * axis + 1))
        };
        UnitPoints::Latin((0..axes as u64).map(axis).collect())
    }

    /// The Sobol sequence with the direction numbers of Joe and Kuo (2008), its binary digits shifted at random by the
    /// seed, the same shift for all points of an axis. The shift keeps the equal distribution over binary intervals.
    pub fn sobol(axes: usize, seed: u64) -> UnitPoints {
        let directions = Sobol::<u64>::init_direction_vals(axes, 64, &JoeKuoD6::minimal());
        let shifted = directions
            .into_iter()
            .enumerate()
            .map(|(axis, directions)| (directions, generator(seed, axis as u64).next_u64()));
        UnitPoints::Sobol(shifted.collect())
    }

    /// Coordinate of point `index`, counted from 0, along an axis: strictly between 0 and 1.
    pub fn coordinate(&self, axis: usize, index: usize) -> f64 {
        match self {
            UnitPoints::Latin(axes) => {
                let (order, random) = &axes[axis];
                let mut random = random.clone();
                // two words of 32 bits for each number
                random.set_word_pos(2 * index as u128);
                let part = f64::from(order[index]) + open_unit(random.next_u64());
                (part / order.len() as f64).min(1.0 - f64::EPSILON / 2.0)
            }
            UnitPoints::Sobol(axes) => {
                let (directions, shift) = &axes[axis];
                let gray = index ^ (index >> 1);
                let used = directions
                    .iter()
                    .enumerate()
                    .filter(|(bit, _)| gray >> bit & 1 == 1);
                open_unit(used.fold(*shift, |sum, (_, direction)| sum ^ direction))
            }
        }
    }
}

/// Generator number `stream` of a seed. The sequence of ChaCha is defined by its standard and does not change between versions.
fn generator(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(stream);
    random
}

/// A number strictly between 0 and 1 of 53 random bits.
fn open_unit(bits: u64) -> f64 {
    ((bits >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latin_points_have_one_coordinate_in_each_part() {
        let points = UnitPoints::latin(3, 1000, 7);
        for axis in 0..3 {
            let mut parts: Vec<usize> = (0..1000)
                .map(|run| (1000.0 * points.coordinate(axis, run)) as usize)
                .collect();
            parts.sort_unstable();
            assert!(parts.iter().enumerate().all(|(part, found)| part == *found));
        }
        let other = UnitPoints::latin(3, 1000, 8);
        assert!((0..1000).any(|run| points.coordinate(0, run) != other.coordinate(0, run)));
    }

    #[test]
    fn sobol_points_are_equally_distributed_over_binary_boxes() {
        // the first 2^k points of a (t, s)-sequence: one coordinate in each binary interval of length 2^-k, shifted or not
        let points = UnitPoints::sobol(5, 3);
        for axis in 0..5 {
            let mut parts: Vec<usize> = (0..256)
                .map(|run| (256.0 * points.coordinate(axis, run)) as usize)
                .collect();
            parts.sort_unstable();
            assert!(
                parts.iter().enumerate().all(|(part, found)| part == *found),
                "axis {axis}"
            );
        }
        // the first two axes are a (0, 2)-sequence: one point in each of 16 x 16 boxes
        let mut boxes: Vec<(usize, usize)> = (0..256)
            .map(|run| [0, 1].map(|axis| (16.0 * points.coordinate(axis, run)) as usize))
            .map(|[a, b]| (a, b))
            .collect();
        boxes.sort_unstable();
        boxes.dedup();
        assert_eq!(boxes.len(), 256);
    }

    #[test]
    fn sobol_points_without_their_shift_are_those_of_joe_and_kuo() {
        // source: Joe and Kuo, table of new-joe-kuo-6.21201, points 1 to 3 of three dimensions
        let known = [[0.5, 0.5, 0.5], [0.75, 0.25, 0.25], [0.25, 0.75, 0.75]];
        let UnitPoints::Sobol(axes) = UnitPoints::sobol(3, 1) else {
            panic!("a Sobol sequence")
        };
        let plain = UnitPoints::Sobol(
            axes.into_iter()
                .map(|(directions, _)| (directions, 0))
                .collect(),
        );
        for (index, point) in known.iter().enumerate() {
            for (axis, value) in point.iter().enumerate() {
                assert!((plain.coordinate(axis, index + 1) - value).abs() < 1e-15);
            }
        }
    }
}
