//! The six faces of the cube around the eye, and the mapping from directions to texels in floating point.

use serde::{Deserialize, Serialize};

/// A direction or a row of a matrix. x points to the right, y up, and z backwards, opposite to the initial view.
pub type Vector = [f64; 3];

/// A face of the cube around the eye, named by the axis through the middle of the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum CubeFace {
    /// Face to the right of a head in its initial orientation.
    PosX,
    /// Face to the left of a head in its initial orientation.
    NegX,
    /// Face above a head in its initial orientation.
    PosY,
    /// Face below a head in its initial orientation.
    NegY,
    /// Face behind a head in its initial orientation.
    PosZ,
    /// Face in front of a head in its initial orientation.
    NegZ,
}

impl CubeFace {
    /// All faces in the order of their indices.
    pub const ALL: [Self; 6] = [Self::PosX, Self::NegX, Self::PosY, Self::NegY, Self::PosZ, Self::NegZ];

    /// Column and row of each face in a cross of 4 x 3 faces, in the order of [`Self::ALL`]. The middle row shows the
    /// faces left, ahead, right and behind. The faces above and below the viewer adjoin the face ahead.
    pub const CROSS: [(u32, u32); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (3, 1), (1, 1)];

    /// Returns the index of the face: 0 for [`CubeFace::PosX`] to 5 for [`CubeFace::NegZ`].
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns the axis from the eye through the middle of the face.
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

    /// Returns the axis from the face's middle to its upper edge.
    pub const fn up(self) -> [i64; 3] {
        match self {
            Self::PosY => [0, 0, 1],
            Self::NegY => [0, 0, -1],
            _ => [0, 1, 0],
        }
    }

    /// Returns the axis from the face's middle to its right edge, seen from inside the cube: the cross product of
    /// forward and up.
    pub const fn right(self) -> [i64; 3] {
        let f = self.forward();
        let u = self.up();
        [f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2], f[0] * u[1] - f[1] * u[0]]
    }

    /// Returns the face that a direction hits, or `None` for the zero vector.
    ///
    /// The longest component selects the face. Among equally long components, x precedes y, and y precedes z.
    pub fn of(direction: Vector) -> Option<Self> {
        let is_finite = direction.iter().all(|component| component.is_finite());
        if !is_finite || direction == [0.0; 3] {
            return None;
        }
        let axis = longest(direction.map(f64::abs));
        Some(Self::on(axis, direction[axis] < 0.0))
    }

    /// Returns the face on an axis (0 to 2), on the negative or positive side of the eye.
    pub(crate) const fn on(axis: usize, is_negative: bool) -> Self {
        Self::ALL[2 * axis + is_negative as usize]
    }
}

/// Returns the index of the longest of three lengths. Of several equal lengths, the first counts as the longest.
pub(crate) fn longest<T: PartialOrd>([x, y, z]: [T; 3]) -> usize {
    if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    }
}

fn along(vector: Vector, axis: [i64; 3]) -> f64 {
    (0..3).map(|i| vector[i] * axis[i] as f64).sum()
}

/// Face, column and row of a texel in a buffer of six faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TexelAddress {
    pub face: CubeFace,
    /// Column from the left edge of the face, including guard texels (a margin that repeats the neighbouring face).
    pub column: u32,
    /// Row from the upper edge of the face, including guard texels (a margin that repeats the neighbouring face).
    pub row: u32,
}

impl TexelAddress {
    /// Returns the bank (0 to 3) that holds the texel. Neighbouring texels lie in different banks.
    pub const fn bank(self) -> u32 {
        self.column % 2 + 2 * (self.row % 2)
    }

    /// Returns the index of the texel's word within its bank, counted from the first word of the face in this bank. A
    /// face has `face_texels` texels along an edge.
    pub const fn word(self, face_texels: u32) -> u32 {
        self.row / 2 * (face_texels / 2) + self.column / 2
    }

    /// Returns the index of the texel in a buffer that stores texels face by face, and row by row within a face.
    pub const fn index(self, face_texels: u32) -> usize {
        ((self.face as u32 * face_texels + self.row) * face_texels + self.column) as usize
    }
}

/// Number of texels of a face, with and without guard texels (a margin that repeats the neighbouring face). These
/// numbers define the direction of each texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceGeometry {
    /// Texels along an edge, including guard texels.
    pub texels: u32,
    /// Number of guard texels on each side of the face. Guard texels repeat the content of the neighbouring face.
    pub guard: u32,
}

impl FaceGeometry {
    /// Returns the number of texels along an edge, without the guard texels at both ends. These inner texels cover 90
    /// degrees.
    pub const fn inner(&self) -> u32 {
        self.texels - 2 * self.guard
    }

    /// Returns the tangent of half the viewing angle with which a renderer draws a face: `texels` /
    /// [`inner`](Self::inner).
    pub fn tangent(&self) -> f64 {
        f64::from(self.texels) / f64::from(self.inner())
    }

    /// Returns the face that a direction hits, and the position on this face. The position runs from -1 to 1 to the
    /// right and downwards.
    ///
    /// Returns `None` for the zero vector.
    pub fn place(&self, direction: Vector) -> Option<(CubeFace, [f64; 2])> {
        let face = CubeFace::of(direction)?;
        let forward = along(direction, face.forward());
        let right = along(direction, face.right()) / forward;
        let down = -along(direction, face.up()) / forward;
        Some((face, [right, down]))
    }

    /// Returns the texel that a direction hits. This texel is never a guard texel (a copy of a texel of the
    /// neighbouring face). Returns `None` for the zero vector.
    pub fn texel(&self, direction: Vector) -> Option<TexelAddress> {
        let (face, place) = self.place(direction)?;
        let inner = f64::from(self.inner());
        let [column, row] = place.map(|p| self.guard + (((p + 1.0) / 2.0 * inner) as u32).min(self.inner() - 1));
        Some(TexelAddress { face, column, row })
    }

    /// Returns the face that a direction hits, and the position relative to the middles of the face's texels. Returns
    /// `None` for the zero vector.
    ///
    /// The integer parts of the position are column and row of the upper left texel. The fractions are the distances
    /// from this texel to the right and downwards.
    pub fn between_texels(&self, direction: Vector) -> Option<(CubeFace, [f64; 2])> {
        let (face, place) = self.place(direction)?;
        Some((face, place.map(|p| f64::from(self.guard) + (p + 1.0) / 2.0 * f64::from(self.inner()) - 0.5)))
    }

    /// Returns the direction of a texel's middle. The vector does not have unit length. Directions of guard texels hit
    /// a neighbouring face.
    pub fn direction(&self, texel: TexelAddress) -> Vector {
        let inner = f64::from(self.inner());
        let [u, v] =
            [texel.column, texel.row].map(|n| (2.0 * (f64::from(n) - f64::from(self.guard)) + 1.0) / inner - 1.0);
        let forward = texel.face.forward();
        let right = texel.face.right();
        let up = texel.face.up();
        [0, 1, 2].map(|i| forward[i] as f64 + u * right[i] as f64 - v * up[i] as f64)
    }

    /// Returns the solid angle of a texel in steradians. All texels together, except guard texels, cover 4 pi.
    pub fn solid_angle(&self, texel: TexelAddress) -> f64 {
        let edge =
            |n: u32, next: f64| 2.0 * (f64::from(n) - f64::from(self.guard) + next) / f64::from(self.inner()) - 1.0;
        let [left, right] = [0.0, 1.0].map(|next| edge(texel.column, next));
        let [top, bottom] = [0.0, 1.0].map(|next| edge(texel.row, next));
        corner_angle(right, bottom) - corner_angle(left, bottom) - corner_angle(right, top) + corner_angle(left, top)
    }
}

/// Returns the solid angle of a rectangle on a face. One corner is the middle of the face, and the opposite corner is
/// (x, y).
fn corner_angle(x: f64, y: f64) -> f64 {
    libm::atan2(x * y, libm::sqrt(x * x + y * y + 1.0))
}
