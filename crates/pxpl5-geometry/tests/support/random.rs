//! Random numbers that are the same on every host.

use pxpl5_sim::SplitMix64;

#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    pub fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// Returns a number from `low` to `high`, in 2^24 steps.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.0.unit()
    }

    /// Returns a number from `-spread` to `spread`.
    pub fn within(&mut self, spread: f32) -> f32 {
        self.between(-spread, spread)
    }

    /// Returns an integer from `low` to `high`, both included.
    pub fn integer(&mut self, low: i32, high: i32) -> i32 {
        low + (self.0.below((high - low + 1) as u64)) as i32
    }

    pub fn colour(&mut self) -> [u8; 3] {
        let bits = self.bits();
        [bits as u8, (bits >> 8) as u8, (bits >> 16) as u8]
    }

    /// Returns a direction in the plane, of length 1 within rounding.
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
