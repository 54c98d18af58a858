//! Random numbers that are the same on every host.

/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From `low` to `high`, in 2^24 steps.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.bits() >> 40) as f32 / 16_777_216.0)
    }

    /// From `-spread` to `spread`.
    pub fn within(&mut self, spread: f32) -> f32 {
        self.between(-spread, spread)
    }

    /// An integer from `low` to `high`, both included.
    pub fn integer(&mut self, low: i32, high: i32) -> i32 {
        low + (self.bits() % (high - low + 1) as u64) as i32
    }

    pub fn colour(&mut self) -> [u8; 3] {
        let bits = self.bits();
        [bits as u8, (bits >> 8) as u8, (bits >> 16) as u8]
    }

    /// A direction in the plane, of length 1 within rounding.
    pub fn direction(&mut self) -> [f32; 2] {
        loop {
            let x = self.between(-1.0, 1.0);
            let y = self.between(-1.0, 1.0);
            let square = x * x + y * y;
            if (0.01..=1.0).contains(&square) {
                let inverse = 1.0 / square.sqrt();
                return [x * inverse, y * inverse];
            }
        }
    }
}
