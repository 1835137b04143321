//! Numbers at random that are the same in every run.

/// Xorshift64*; not zero.
///
/// # Source
/// S. Vigna, An experimental exploration of Marsaglia's xorshift generators, scrambled (2016).
pub struct Random(pub u64);

impl Random {
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        low + (high - low)
            * ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64)
    }
}
