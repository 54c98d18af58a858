//! Conversion of a direction to the addresses and weights of four texels.

use crate::face::{CubeFace, FaceGeometry, TexelAddress, longest};
use crate::timing::ArpTiming;

/// Intersection of a direction with a face of the cube, as components of the direction along the face's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FaceHit {
    pub(crate) face: CubeFace,
    /// Component of the direction along the forward axis of the face. The component is greater than zero.
    pub(crate) forward: i64,
    /// Component of the direction to the right. Its magnitude is at most `forward`.
    pub(crate) right: i64,
    /// Component of the direction upwards. Its magnitude is at most `forward`.
    pub(crate) up: i64,
}

impl FaceHit {
    /// Returns the intersection of a direction with the face that the direction hits, or `None` for the zero vector.
    pub(crate) fn of(direction: [i64; 3]) -> Option<Self> {
        if direction == [0; 3] {
            return None;
        }
        let axis = longest(direction.map(i64::abs));
        let face = CubeFace::on(axis, direction[axis] < 0);
        let along = |axis: [i64; 3]| (0..3).map(|i| direction[i] * axis[i]).sum();
        Some(Self { face, forward: along(face.forward()), right: along(face.right()), up: along(face.up()) })
    }
}

/// The four texels from which the colour for a direction is interpolated, and their weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Footprint {
    /// Upper left, upper right, lower left and lower right texel.
    ///
    /// Without guard texels (a margin that repeats the neighbouring face), a texel beyond an edge belongs to the
    /// neighbouring face. One beyond a corner is `None`, and the mean of the other three replaces it.
    pub texels: [Option<TexelAddress>; 4],
    /// Horizontal and vertical distance from the upper left texel, as fractions from 0 to 1 inclusive. The unit is
    /// `2^-weight_bits`.
    pub fractions: [u32; 2],
    /// True if at least one of the four texels lies beyond an edge of the face that the direction hits.
    pub is_split: bool,
}

impl Footprint {
    /// Returns true if two of the texels lie in one memory bank, so that a second access is needed.
    pub fn has_conflict(&self) -> bool {
        let banks = self.texels.iter().flatten().fold([0; 4], |mut banks, texel| {
            banks[texel.bank() as usize] += 1;
            banks
        });
        self.is_split && banks.iter().any(|texels| *texels > 1)
    }

    /// Returns the weights of the four texels, in units of `4^-weight_bits`.
    pub const fn weights(&self, weight_bits: u64) -> [u32; 4] {
        let one = 1 << weight_bits;
        let [right, down] = self.fractions;
        [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down]
    }
}

/// The pipeline stages after the rotation of the viewing vector and before the display memories: face selection,
/// dividers and addresses.
#[derive(Clone, Copy, Debug)]
pub struct AddressUnit {
    pub geometry: FaceGeometry,
    /// Number of bits of the quotients that the dividers compute.
    pub quotient_bits: u64,
    /// Number of bits of each fraction in [`Footprint::fractions`], from which the weights of the four texels are
    /// computed. With 0, the pixel shows the nearest texel without interpolation.
    pub weight_bits: u64,
}

impl AddressUnit {
    pub const fn new(timing: &ArpTiming) -> Self {
        let geometry = FaceGeometry { texels: timing.face_texels as u32, guard: timing.guard_texels as u32 };
        Self { geometry, quotient_bits: timing.quotient_bits, weight_bits: timing.weight_bits }
    }

    /// Returns (1 + side / forward) / 2 in `quotient_bits` bits, rounded down. The value 1 becomes a word of all ones.
    fn quotient(&self, side: i64, forward: i64) -> i64 {
        let dividend = ((forward + side) as u128) << self.quotient_bits;
        let largest = (1 << self.quotient_bits) - 1;
        ((dividend / (2 * forward) as u128) as i64).min(largest)
    }

    /// Returns a position along one axis of the face, relative to the middles of texels, in units of
    /// `2^-quotient_bits`.
    ///
    /// It is the number of guard texels plus the quotient times the number of inner texels, minus half a texel for
    /// interpolation. Since a rounded quotient stands for the middle of its interval, half of its last bit is added.
    fn place(&self, quotient: i64) -> i64 {
        let half = if self.weight_bits == 0 { 0 } else { 1 << (self.quotient_bits - 1) };
        let inner = i64::from(self.geometry.inner());
        (i64::from(self.geometry.guard) << self.quotient_bits) + quotient * inner + inner / 2 - half
    }

    /// Returns the fractional part of a position in texels, from 0 to 1 inclusive, in `weight_bits` bits. Halves are
    /// rounded up.
    pub(crate) const fn fraction(&self, place: i64) -> u32 {
        let below = self.quotient_bits - self.weight_bits;
        let fraction = place & ((1 << self.quotient_bits) - 1);
        let half = (1 << below) >> 1;
        ((fraction + half) >> below) as u32
    }

    /// Returns the texels and weights for a direction from [`crate::MatrixWords::turn`]. Returns `None` for the zero
    /// vector.
    pub fn footprint(&self, direction: [i64; 3]) -> Option<Footprint> {
        let met = FaceHit::of(direction)?;
        // Positions in texels with `quotient_bits` fractional bits.
        let across = self.place(self.quotient(met.right, met.forward));
        let down = self.place(self.quotient(-met.up, met.forward));
        let column = across >> self.quotient_bits;
        let row = down >> self.quotient_bits;
        if self.weight_bits == 0 {
            let texel = TexelAddress { face: met.face, column: column as u32, row: row as u32 };
            return Some(Footprint { texels: [Some(texel); 4], fractions: [0, 0], is_split: false });
        }
        let fractions = [self.fraction(across), self.fraction(down)];
        Some(self.around(met.face, [column, row], fractions))
    }

    /// Returns the footprint of four texels whose upper left texel has this column and row. Texels of the footprint can
    /// lie beyond the edges of the face.
    pub(crate) fn around(&self, face: CubeFace, [column, row]: [i64; 2], fractions: [u32; 2]) -> Footprint {
        let places = [[column, row], [column + 1, row], [column, row + 1], [column + 1, row + 1]];
        let size = i64::from(self.geometry.texels);
        let is_split = places.iter().flatten().any(|n| !(0..size).contains(n));
        Footprint { texels: places.map(|place| self.texel_or_neighbour(face, place)), fractions, is_split }
    }

    /// Returns the texel at this column and row, which can lie beyond the edges of the face.
    ///
    /// Beyond an edge, the result is the neighbouring face's texel in the same direction. Beyond a corner, the result
    /// is `None`.
    fn texel_or_neighbour(&self, face: CubeFace, [column, row]: [i64; 2]) -> Option<TexelAddress> {
        let size = i64::from(self.geometry.texels);
        let inside = [column, row].map(|n| (0..size).contains(&n));
        match inside {
            [true, true] => Some(TexelAddress { face, column: column as u32, row: row as u32 }),
            [false, false] => None,
            _ => self.nearest(self.middle(face, [column, row])),
        }
    }

    /// Returns the direction of a texel's middle as integers. The texel can lie beyond the edges of the face.
    fn middle(&self, face: CubeFace, place: [i64; 2]) -> [i64; 3] {
        let inner = i64::from(self.geometry.inner());
        let [u, v] = place.map(|n| 2 * (n - i64::from(self.geometry.guard)) + 1 - inner);
        let forward = face.forward();
        let right = face.right();
        let up = face.up();
        [0, 1, 2].map(|i| inner * forward[i] + u * right[i] - v * up[i])
    }

    /// Returns the texel that a direction with integer components hits. The computation is exact.
    fn nearest(&self, direction: [i64; 3]) -> Option<TexelAddress> {
        let met = FaceHit::of(direction)?;
        let inner = i64::from(self.geometry.inner());
        let [column, row] = [met.right, -met.up].map(|side| {
            let n = (met.forward + side) * inner / (2 * met.forward);
            self.geometry.guard + n.min(inner - 1) as u32
        });
        Some(TexelAddress { face: met.face, column, row })
    }
}
