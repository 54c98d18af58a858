//! From a direction in words to the four texels that show it and their weights.

use crate::face::{CubeFace, FaceGeometry, TexelAddress, longest};
use crate::timing::ArpTiming;

/// Where a direction meets a face: the lengths of its components along the face's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Meeting {
    /// The face that the direction meets.
    pub(crate) face: CubeFace,
    /// Along its axis, above zero.
    pub(crate) forward: i64,
    /// To its right, at most as long.
    pub(crate) right: i64,
    /// Up, at most as long.
    pub(crate) up: i64,
}

impl Meeting {
    /// The face that a direction in words meets; `None` of no direction.
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

/// The texels that show a direction, and how they are weighed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Footprint {
    /// Upper left, upper right, lower left, lower right. Beyond the edge of a face without guard those of the neighbouring
    /// face; `None` for the one beyond a corner, which is the mean of the other three.
    pub texels: [Option<TexelAddress>; 4],
    /// Fractions to the right and down, in parts of 2^weight_bits; both ends included.
    pub fractions: [u32; 2],
    /// Whether a texel lies on another face.
    pub is_split: bool,
}

impl Footprint {
    /// Whether two of its texels lie in one bank, which costs a second access.
    #[must_use]
    pub fn has_conflict(&self) -> bool {
        let banks = self.texels.iter().flatten().fold([0; 4], |mut banks, texel| {
            banks[texel.bank() as usize] += 1;
            banks
        });
        self.is_split && banks.iter().any(|texels| *texels > 1)
    }

    /// Weights of the four texels, in parts of 4^weight_bits.
    #[must_use]
    pub const fn weights(&self, weight_bits: u64) -> [u32; 4] {
        let one = 1 << weight_bits;
        let [right, down] = self.fractions;
        [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down]
    }
}

/// Everything between the matrix and the memories: faces, dividers, addresses.
#[derive(Clone, Copy, Debug)]
pub struct AddressUnit {
    /// Size of the faces.
    pub geometry: FaceGeometry,
    /// Bits of a quotient.
    pub quotient_bits: u64,
    /// Bits of a fraction, 0 for the nearest texel.
    pub weight_bits: u64,
}

impl AddressUnit {
    /// The unit of a display with these numbers.
    #[must_use]
    pub const fn new(timing: &ArpTiming) -> Self {
        let geometry = FaceGeometry { texels: timing.face_texels as u32, guard: timing.guard_texels as u32 };
        Self { geometry, quotient_bits: timing.quotient_bits, weight_bits: timing.weight_bits }
    }

    /// (1 + side / forward) / 2 in `quotient_bits` bits, rounded down, all ones for 1.
    fn quotient(&self, side: i64, forward: i64) -> i64 {
        let dividend = ((forward + side) as u128) << self.quotient_bits;
        let largest = (1 << self.quotient_bits) - 1;
        ((dividend / (2 * forward) as u128) as i64).min(largest)
    }

    /// Places between the middles of texels, in parts of 2^quotient_bits: guard + quotient x inner, less half a texel for
    /// four of them. A quotient rounded down stands for the middle of its interval, so half of its last bit is added.
    fn place(&self, quotient: i64) -> i64 {
        let half = if self.weight_bits == 0 { 0 } else { 1 << (self.quotient_bits - 1) };
        let inner = i64::from(self.geometry.inner());
        (i64::from(self.geometry.guard) << self.quotient_bits) + quotient * inner + inner / 2 - half
    }

    /// The fraction of a place in `weight_bits` bits, halves rounded up, up to one.
    pub(crate) const fn fraction(&self, place: i64) -> u32 {
        let below = self.quotient_bits - self.weight_bits;
        let fraction = place & ((1 << self.quotient_bits) - 1);
        let half = (1 << below) >> 1;
        ((fraction + half) >> below) as u32
    }

    /// The footprint of a direction in words, as [`crate::MatrixWords::turn`] gives it; `None` of no direction.
    #[must_use]
    pub fn footprint(&self, direction: [i64; 3]) -> Option<Footprint> {
        let met = Meeting::of(direction)?;
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

    /// The four texels from one on, some of which may lie beyond the face's edges.
    pub(crate) fn around(&self, face: CubeFace, [column, row]: [i64; 2], fractions: [u32; 2]) -> Footprint {
        let places = [[column, row], [column + 1, row], [column, row + 1], [column + 1, row + 1]];
        let size = i64::from(self.geometry.texels);
        let is_split = places.iter().flatten().any(|n| !(0..size).contains(n));
        Footprint { texels: places.map(|place| self.texel_or_neighbour(face, place)), fractions, is_split }
    }

    /// A texel of a face; beyond an edge the one of the neighbour that its middle's direction meets, beyond a corner none.
    fn texel_or_neighbour(&self, face: CubeFace, [column, row]: [i64; 2]) -> Option<TexelAddress> {
        let size = i64::from(self.geometry.texels);
        let inside = [column, row].map(|n| (0..size).contains(&n));
        match inside {
            [true, true] => Some(TexelAddress { face, column: column as u32, row: row as u32 }),
            [false, false] => None,
            _ => self.nearest(self.middle(face, [column, row])),
        }
    }

    /// The direction of a texel's middle in whole numbers, on the face or beside it.
    fn middle(&self, face: CubeFace, place: [i64; 2]) -> [i64; 3] {
        let inner = i64::from(self.geometry.inner());
        let [u, v] = place.map(|n| 2 * (n - i64::from(self.geometry.guard)) + 1 - inner);
        let forward = face.forward();
        let right = face.right();
        let up = face.up();
        [0, 1, 2].map(|i| inner * forward[i] + u * right[i] - v * up[i])
    }

    /// The nearest texel of a direction in whole numbers, exactly.
    fn nearest(&self, direction: [i64; 3]) -> Option<TexelAddress> {
        let met = Meeting::of(direction)?;
        let inner = i64::from(self.geometry.inner());
        let [column, row] = [met.right, -met.up].map(|side| {
            let n = (met.forward + side) * inner / (2 * met.forward);
            self.geometry.guard + n.min(inner - 1) as u32
        });
        Some(TexelAddress { face: met.face, column, row })
    }
}
