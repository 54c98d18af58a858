//! The six faces of the cube around the eye, and which texel a direction is, in real numbers.

use serde::{Deserialize, Serialize};

/// A direction or a row of a matrix: x to the right, y up, z towards the viewer.
pub type Vector = [f64; 3];

/// A face of the cube, by the axis that it lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum CubeFace {
    /// To the right of a head that is not turned.
    PosX,
    /// To the left of that head.
    NegX,
    /// Over the head's crown.
    PosY,
    /// Under the head's feet.
    NegY,
    /// Behind the head's back.
    PosZ,
    /// Straight ahead of the head.
    NegZ,
}

impl CubeFace {
    /// All in the order of their indices.
    pub const ALL: [Self; 6] = [Self::PosX, Self::NegX, Self::PosY, Self::NegY, Self::PosZ, Self::NegZ];

    /// 0 for [`CubeFace::PosX`] to 5 for [`CubeFace::NegZ`].
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The axis from the eye through the middle of the face.
    #[must_use]
    pub const fn forward(self) -> [i64; 3] {
        match self {
            Self::PosX => [1, 0, 0],
            Self::NegX => [-1, 0, 0],
            Self::PosY => [0, 1, 0],
            Self::NegY => [0, -1, 0],
            Self::PosZ => [0, 0, 1],
            Self::NegZ => [0, 0, -1],
        }
    }

    /// The axis from the face's middle to its upper edge.
    #[must_use]
    pub const fn up(self) -> [i64; 3] {
        match self {
            Self::PosY => [0, 0, 1],
            Self::NegY => [0, 0, -1],
            _ => [0, 1, 0],
        }
    }

    /// The axis from the face's middle to its right edge, seen from inside: forward x up.
    #[must_use]
    pub const fn right(self) -> [i64; 3] {
        let f = self.forward();
        let u = self.up();
        [f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2], f[0] * u[1] - f[1] * u[0]]
    }

    /// The face that a direction meets: its longest component, on ties x before y before z; `None` of no direction.
    #[must_use]
    pub fn of(direction: Vector) -> Option<Self> {
        let is_finite = direction.iter().all(|component| component.is_finite());
        if !is_finite || direction == [0.0; 3] {
            return None;
        }
        let axis = longest(direction.map(f64::abs));
        Some(Self::on(axis, direction[axis] < 0.0))
    }

    /// The face on an axis (0 to 2), on its negative side or not.
    #[must_use]
    pub(crate) const fn on(axis: usize, is_negative: bool) -> Self {
        Self::ALL[2 * axis + is_negative as usize]
    }
}

/// The longest of three lengths, the first on ties.
pub(crate) fn longest<T: PartialOrd>([x, y, z]: [T; 3]) -> usize {
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

/// The components of a vector along an axis.
fn along(vector: Vector, axis: [i64; 3]) -> f64 {
    (0..3).map(|i| vector[i] * axis[i] as f64).sum()
}

/// Where a texel lies in the six faces of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TexelAddress {
    /// The face that it lies on.
    pub face: CubeFace,
    /// Column from the left edge of the face, guard texels included.
    pub column: u32,
    /// Row from the upper edge of the face, guard texels included.
    pub row: u32,
}

impl TexelAddress {
    /// The one of four interleaved memories that holds it: two neighbours never share one.
    #[must_use]
    pub const fn bank(self) -> u32 {
        self.column % 2 + 2 * (self.row % 2)
    }

    /// Its word within the face's part of its bank, for faces of so many texels.
    #[must_use]
    pub const fn word(self, face_texels: u32) -> u32 {
        self.row / 2 * (face_texels / 2) + self.column / 2
    }

    /// Its place in a buffer that holds face by face and row by row.
    #[must_use]
    pub const fn index(self, face_texels: u32) -> usize {
        ((self.face as u32 * face_texels + self.row) * face_texels + self.column) as usize
    }
}

/// Size of a face and of its guard: which directions its texels show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceGeometry {
    /// Texels along an edge, guard included.
    pub texels: u32,
    /// Guard texels on each side.
    pub guard: u32,
}

impl FaceGeometry {
    /// Texels along an edge without guard: those of 90 degrees.
    #[must_use]
    pub const fn inner(&self) -> u32 {
        self.texels - 2 * self.guard
    }

    /// Tangent of half the angle that a renderer draws a face with: texels / inner.
    #[must_use]
    pub fn tangent(&self) -> f64 {
        f64::from(self.texels) / f64::from(self.inner())
    }

    /// The face that a direction meets and the place there, from -1 to 1 to the right and down; `None` of no direction.
    #[must_use]
    pub fn place(&self, direction: Vector) -> Option<(CubeFace, [f64; 2])> {
        let face = CubeFace::of(direction)?;
        let forward = along(direction, face.forward());
        let right = along(direction, face.right()) / forward;
        let down = -along(direction, face.up()) / forward;
        Some((face, [right, down]))
    }

    /// The nearest texel of a direction, never one of the guard; `None` of no direction.
    #[must_use]
    pub fn texel(&self, direction: Vector) -> Option<TexelAddress> {
        let (face, place) = self.place(direction)?;
        let inner = f64::from(self.inner());
        let [column, row] = place.map(|p| self.guard + (((p + 1.0) / 2.0 * inner) as u32).min(self.inner() - 1));
        Some(TexelAddress { face, column, row })
    }

    /// The place of a direction between the middles of texels: face, column and row of the texel to the upper left plus
    /// the fractions towards its neighbours; `None` of no direction.
    #[must_use]
    pub fn between_texels(&self, direction: Vector) -> Option<(CubeFace, [f64; 2])> {
        let (face, place) = self.place(direction)?;
        Some((face, place.map(|p| f64::from(self.guard) + (p + 1.0) / 2.0 * f64::from(self.inner()) - 0.5)))
    }

    /// The direction of a texel's middle, not of unit length. Those of guard texels belong to a neighbouring face.
    #[must_use]
    pub fn direction(&self, texel: TexelAddress) -> Vector {
        let inner = f64::from(self.inner());
        let [u, v] =
            [texel.column, texel.row].map(|n| (2.0 * (f64::from(n) - f64::from(self.guard)) + 1.0) / inner - 1.0);
        let forward = texel.face.forward();
        let right = texel.face.right();
        let up = texel.face.up();
        [0, 1, 2].map(|i| forward[i] as f64 + u * right[i] as f64 - v * up[i] as f64)
    }

    /// Solid angle that a texel covers, in steradians; all that are not of the guard cover 4 pi.
    #[must_use]
    pub fn solid_angle(&self, texel: TexelAddress) -> f64 {
        let edge =
            |n: u32, next: f64| 2.0 * (f64::from(n) - f64::from(self.guard) + next) / f64::from(self.inner()) - 1.0;
        let [left, right] = [0.0, 1.0].map(|next| edge(texel.column, next));
        let [top, bottom] = [0.0, 1.0].map(|next| edge(texel.row, next));
        corner_angle(right, bottom) - corner_angle(left, bottom) - corner_angle(right, top) + corner_angle(left, top)
    }
}

/// Solid angle of the rectangle from the middle of a face to a place on it.
fn corner_angle(x: f64, y: f64) -> f64 {
    libm::atan2(x * y, libm::sqrt(x * x + y * y + 1.0))
}
