//! The register for the head's orientation, and the checks of matrices.

use crate::face::Vector;
use crate::lens::signed_word;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;

/// Largest accepted deviation from a rotation matrix, measured in the scalar products of the rows.
const TOLERANCE: f64 = 1e-3;

/// A matrix from head axes to world axes, which was checked to be a rotation. The columns of the matrix are the axes of
/// the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    rows: [Vector; 3],
}

impl Orientation {
    /// The initial orientation, which is valid until the first matrix arrives.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };

    /// Creates a rotation from the rows of its matrix.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the matrix is not finite, or deviates from a rotation by more than 1e-3.
    pub fn new(rows: [Vector; 3]) -> Result<Self, SettingError> {
        let refused = |what: String| Err(SettingError::value("orientation", "a rotation within 1e-3", what));
        if let Some(component) = rows.iter().flatten().find(|component| !component.is_finite()) {
            return refused(format!("a component of {component}"));
        }
        // The products of rows must equal the products of an orthonormal matrix.
        for i in 0..3 {
            for j in 0..=i {
                let product = dot(rows[i], rows[j]);
                if (product - f64::from(u8::from(i == j))).abs() > TOLERANCE {
                    return refused(format!("rows {j} and {i} with a product of {product}"));
                }
            }
        }
        // A negative determinant means a reflection.
        let determinant = dot(rows[0], cross(rows[1], rows[2]));
        if determinant < 0.0 { refused(format!("a reflection, determinant {determinant}")) } else { Ok(Self { rows }) }
    }

    /// Creates a rotation from a quaternion (x, y, z, w) of any length that maps head axes to world axes.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the quaternion is not finite or has length zero.
    pub fn from_quaternion(quaternion: [f64; 4]) -> Result<Self, SettingError> {
        let length = libm::sqrt(quaternion.iter().map(|component| component * component).sum());
        let [x, y, z, w] = quaternion.map(|component| component / length);
        Self::new([
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ])
    }

    pub const fn rows(&self) -> [Vector; 3] {
        self.rows
    }

    /// Rotates a vector from head axes to world axes.
    pub fn turn(&self, vector: Vector) -> Vector {
        self.rows.map(|row| dot(row, vector))
    }

    /// Returns the nine words of the matrix register. The words are signed and have `matrix_bits` bits. The largest
    /// word represents 1, and halves are rounded to even.
    pub fn words(&self, matrix_bits: u64) -> MatrixWords {
        MatrixWords(self.rows.map(|row| row.map(|component| signed_word(component, matrix_bits))))
    }
}

/// The nine signed words of the matrix register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatrixWords(
    /// The three rows of the matrix, three words each.
    pub [[i32; 3]; 3],
);

impl MatrixWords {
    /// Rotates a vector of words to world axes. The sums of products keep all bits.
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

/// The orientations that have arrived, each with the time at which it became valid.
///
/// A matrix that is not a rotation is refused and counted, and the previous matrix stays valid.
#[derive(Clone, Debug)]
pub struct OrientationLatch {
    matrix_bits: u64,
    /// Matrices in the order of arrival. The list is never empty, because it starts with the initial orientation at
    /// time zero.
    loaded: Vec<(Time, MatrixWords)>,
    loads: u64,
    refused: u64,
}

impl OrientationLatch {
    /// Creates a register that contains the initial orientation. Each component of a matrix has `matrix_bits` bits.
    pub fn new(matrix_bits: u64) -> Self {
        let first = (Time::ZERO, Orientation::IDENTITY.words(matrix_bits));
        Self { matrix_bits, loaded: vec![first], loads: 0, refused: 0 }
    }

    /// Loads the rows of a matrix that arrives at `now`. Calls must be in the order of time.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Orientation::new`]. A refused matrix is counted and does not replace the previous
    /// matrix.
    pub fn load(&mut self, rows: [Vector; 3], now: Time) -> Result<(), SettingError> {
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

    /// Returns the matrix that the display reads at `time`: the last matrix that had arrived.
    pub fn at(&self, time: Time) -> MatrixWords {
        let after = self.loaded.partition_point(|(arrived, _)| *arrived <= time);
        self.loaded[after.saturating_sub(1)].1
    }

    /// Discards matrices that the display can no longer read at `time` or later.
    pub fn discard_before(&mut self, time: Time) {
        let after = self.loaded.partition_point(|(arrived, _)| *arrived <= time);
        self.loaded.drain(..after.saturating_sub(1));
    }

    /// Returns the number of accepted matrices and the number of refused matrices.
    pub const fn counts(&self) -> [u64; 2] {
        [self.loads, self.refused]
    }
}
