//! A generator of pseudorandom numbers with the same sequence on every machine.

/// The generator SplitMix64.
///
/// # Source
/// Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator with the given seed.
    #[must_use]
    pub const fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// The next number, uniformly distributed in [`from`, `to`).
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        // 53 bits are represented exactly by a double
        let unit = (z >> 11) as f64 / (1_u64 << 53) as f64;
        from + (to - from) * unit
    }

    /// The next number, uniformly distributed in [-`size`, `size`).
    pub fn around(&mut self, size: f64) -> f64 {
        self.between(-size, size)
    }
}
