//! The register that holds the head's orientation, and what it refuses.

use crate::error::ArpError;
use crate::face::Vector;
use crate::lens::signed_word;
use pxpl5_sim::Time;

/// How far rows may be from unit length and from each other's right angles.
const TOLERANCE: f64 = 1e-3;

/// A rotation from head axes into world axes, checked: its columns are the head's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    rows: [Vector; 3],
}

impl Orientation {
    /// The head that is not turned: what the latch holds before the first matrix.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// A rotation given by the rows of its matrix.
    ///
    /// # Errors
    ///
    /// [`ArpError::Orientation`] for what is not finite, or no rotation within 1e-3: stretched, sheared or mirrored.
    pub fn new(rows: [Vector; 3]) -> Result<Self, ArpError> {
        let refused = |what: String| Err(ArpError::Orientation(what));
        if let Some(component) = rows.iter().flatten().find(|component| !component.is_finite()) {
            return refused(format!("a component of {component}"));
        }
        for i in 0..3 {
            for j in 0..=i {
                let product = dot(rows[i], rows[j]);
                if (product - f64::from(u8::from(i == j))).abs() > TOLERANCE {
                    return refused(format!("rows {j} and {i} with a product of {product}"));
                }
            }
        }
        let determinant = dot(rows[0], cross(rows[1], rows[2]));
        if determinant < 0.0 { refused(format!("a reflection, determinant {determinant}")) } else { Ok(Self { rows }) }
    }

    /// The rotation of a quaternion (x, y, z, w) that turns head axes into world axes; it need not be of unit length.
    ///
    /// # Errors
    ///
    /// [`ArpError::Orientation`] for one that is not finite, or too short to have a direction.
    pub fn from_quaternion(quaternion: [f64; 4]) -> Result<Self, ArpError> {
        let length = libm::sqrt(quaternion.iter().map(|component| component * component).sum());
        let [x, y, z, w] = quaternion.map(|component| component / length);
        Self::new([
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ])
    }

    /// The rows of the matrix.
    #[must_use]
    pub const fn rows(&self) -> [Vector; 3] {
        self.rows
    }

    /// A vector of the head in world axes.
    #[must_use]
    pub fn turn(&self, vector: Vector) -> Vector {
        self.rows.map(|row| dot(row, vector))
    }

    /// The nine words of the matrix register, signed, of so many bits, the largest for 1, rounded to even.
    #[must_use]
    pub fn words(&self, matrix_bits: u64) -> MatrixWords {
        MatrixWords(self.rows.map(|row| row.map(|component| signed_word(component, matrix_bits))))
    }
}

/// The nine words of the matrix register, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatrixWords(
    /// Rows of signed words.
    pub [[i32; 3]; 3],
);

impl MatrixWords {
    /// The vector in world axes, sums of products kept in full.
    #[must_use]
    pub fn turn(&self, vector: [i32; 3]) -> [i64; 3] {
        self.0.map(|row| (0..3).map(|i| i64::from(row[i]) * i64::from(vector[i])).sum())
    }
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The orientations that have come, each with the instant from which on it can be latched.
///
/// Nonsense is refused and counted, and the last good one stays.
#[derive(Clone, Debug)]
pub struct OrientationLatch {
    matrix_bits: u64,
    /// In the order of their instants; never empty, the first counts from the beginning of time.
    loaded: Vec<(Time, MatrixWords)>,
    loads: u64,
    refused: u64,
}

impl OrientationLatch {
    /// A latch of words of so many bits that holds a head that is not turned.
    #[must_use]
    pub fn new(matrix_bits: u64) -> Self {
        let first = (Time::ZERO, Orientation::IDENTITY.words(matrix_bits));
        Self { matrix_bits, loaded: vec![first], loads: 0, refused: 0 }
    }

    /// Takes the rows of a matrix that arrive at an instant, not before any that came earlier.
    ///
    /// # Errors
    ///
    /// As [`Orientation::new`]; the matrix is counted and changes nothing.
    pub fn load(&mut self, rows: [Vector; 3], now: Time) -> Result<(), ArpError> {
        match Orientation::new(rows) {
            Ok(orientation) => {
                self.loads += 1;
                self.loaded.push((now, orientation.words(self.matrix_bits)));
                Ok(())
            }
            Err(error) => {
                self.refused += 1;
                Err(error)
            }
        }
    }

    /// The words that are latched at an instant: the last that had arrived by then.
    #[must_use]
    pub fn at(&self, time: Time) -> MatrixWords {
        let after = self.loaded.partition_point(|(arrived, _)| *arrived <= time);
        self.loaded[after.saturating_sub(1)].1
    }

    /// Forgets what can no longer be latched at an instant or later.
    pub fn forget_before(&mut self, time: Time) {
        let after = self.loaded.partition_point(|(arrived, _)| *arrived <= time);
        self.loaded.drain(..after.saturating_sub(1));
    }

    /// Matrices that were taken, and those that were refused.
    #[must_use]
    pub const fn counts(&self) -> [u64; 2] {
        [self.loads, self.refused]
    }
}
