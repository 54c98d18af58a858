//! The view of an eye: the matrices from world to clip coordinates, and the picture.

use crate::newton;
use crate::regions::RegionMask;
use glam::{Mat4, Vec3};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{Lines, REGION_SIZE, RegionGrid};
use serde::{Deserialize, Serialize};

/// Largest width of a picture in pixels, and largest height in lines of the video frame.
///
/// Together, this limit and [`crate::GUARD_PIXELS`] ensure that edge expressions fit 32 bits.
pub const MAX_PICTURE: u32 = 2048;

/// The matrices of one eye.
///
/// Eye coordinates are right-handed, and the eye looks along -Z. Depth is 0 at the near plane and 1 at the far plane,
/// as in `Mat4::perspective_rh` and `Mat4::orthographic_rh`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewTransform {
    /// Matrix from world coordinates to eye coordinates. For lighting and spheres, the matrix must consist of a
    /// rotation, a translation and a uniform scale.
    pub model_view: Mat4,
    /// Matrix from eye coordinates to clip coordinates.
    pub projection: Mat4,
}

/// A picture: its division into regions, and its lines of the video frame (all, even or odd).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "PictureFields", into = "PictureFields")]
pub struct Viewport {
    grid: RegionGrid,
    lines: Lines,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PictureFields {
    grid: RegionGrid,
    lines: Lines,
}

impl Viewport {
    /// A whole NTSC video frame: 640 x 480 in 20 regions (TR94).
    pub const FRAME: Self = Self { grid: RegionGrid::FRAME, lines: Lines::Frame };

    /// Returns one NTSC field: 640 x 240 in 10 regions (TR94). Row r of the even field is line 2r of the video frame,
    /// and row r of the odd field is line 2r + 1.
    pub const fn field(parity: pxpl5_wire::FieldParity) -> Self {
        Self { grid: RegionGrid::FIELD, lines: Lines::Field(parity) }
    }

    /// Creates a picture with any size and any regions.
    ///
    /// # Errors
    /// Returns a [`SettingError`] if a size is zero or too large, or if there are more regions than a [`RegionMask`]
    /// can hold.
    pub fn new(grid: RegionGrid, lines: Lines) -> Result<Self, SettingError> {
        let step = Self { grid, lines }.line_step();
        let frame_lines = grid.height.saturating_mul(step);
        if !is_one_to(MAX_PICTURE, grid.width) || !is_one_to(MAX_PICTURE, frame_lines) {
            let expected = format_args!("1 to {MAX_PICTURE} pixels by 1 to {MAX_PICTURE} frame lines");
            return Err(SettingError::value("picture", expected, format_args!("{} x {frame_lines}", grid.width)));
        }
        let width = grid.region_width;
        let height = grid.region_height;
        if !is_one_to(REGION_SIZE, width) || !is_one_to(REGION_SIZE, height) {
            let expected = format_args!("1 to {REGION_SIZE} pixels by 1 to {REGION_SIZE} lines");
            return Err(SettingError::value("region", expected, format_args!("{width} x {height}")));
        }
        if grid.regions() > RegionMask::CAPACITY {
            let expected = format_args!("at most {} regions", RegionMask::CAPACITY);
            return Err(SettingError::value("picture", expected, grid.regions()));
        }
        Ok(Self { grid, lines })
    }

    pub const fn grid(&self) -> RegionGrid {
        self.grid
    }

    /// Returns the lines of the video frame that the picture contains: all, even or odd.
    pub const fn lines(&self) -> Lines {
        self.lines
    }

    /// Returns the distance between rows of the picture, in lines of the video frame: 1 for a whole video frame, 2 for
    /// a field.
    pub const fn line_step(&self) -> u32 {
        match self.lines {
            Lines::Frame => 1,
            Lines::Field(_) => 2,
        }
    }

    /// Returns the line of the video frame on which the picture's first row lies: 0 or 1.
    pub const fn first_line(&self) -> u32 {
        match self.lines {
            Lines::Frame => 0,
            Lines::Field(parity) => parity.first_line(),
        }
    }

    /// Returns the height of the video frame to which the picture belongs, in lines.
    pub const fn frame_lines(&self) -> u32 {
        self.grid.height * self.line_step()
    }
}

fn is_one_to(most: u32, size: u32) -> bool {
    (1..=most).contains(&size)
}

impl TryFrom<PictureFields> for Viewport {
    type Error = SettingError;

    fn try_from(fields: PictureFields) -> Result<Self, SettingError> {
        Self::new(fields.grid, fields.lines)
    }
}

impl From<Viewport> for PictureFields {
    fn from(viewport: Viewport) -> Self {
        Self { grid: viewport.grid, lines: viewport.lines }
    }
}

/// The columns of a 4 x 4 matrix.
///
/// Products are computed in the same order on every computer. The library glam computes products in different orders
/// with and without vector instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Columns(pub(crate) [[f32; 4]; 4]);

impl Columns {
    pub(crate) fn from_matrix(matrix: &Mat4) -> Self {
        Self(matrix.to_cols_array_2d())
    }

    pub(crate) fn cell(&self, row: usize, column: usize) -> f64 {
        f64::from(self.0[column][row])
    }

    /// Returns true if all elements in `cells` are zero. Each entry of `cells` is a row and a column.
    pub(crate) fn is_zero_at(&self, cells: &[(usize, usize)]) -> bool {
        cells.iter().all(|&(row, column)| self.cell(row, column) == 0.0)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.0.iter().flatten().all(|v| v.is_finite())
    }

    fn times(&self, v: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|row| {
            let terms: [f64; 4] = std::array::from_fn(|column| self.cell(row, column) * v[column]);
            ((terms[0] + terms[1]) + terms[2]) + terms[3]
        })
    }

    /// Returns the point that an affine matrix maps to the origin, or the origin if no such point exists.
    fn origin(&self) -> Vec3 {
        let [x, y, z, t] = self.0.map(|c| [c[0], c[1], c[2]].map(f64::from));
        let determinant = dot(x, cross(y, z));
        let solved = [cross(y, z), cross(z, x), cross(x, y)].map(|row| (-dot(row, t) / determinant) as f32);
        let origin = Vec3::from_array(solved);
        if origin.is_finite() { origin } else { Vec3::ZERO }
    }
}

/// A map from points of the world to eye or clip coordinates, computed relative to the eye.
///
/// For a point p far from the world's origin, `A p + t` loses precision, because the sum is a difference of two large
/// numbers. The code computes `A (p - o) + t'` instead. Here o is the eye's position, and `t' = A o + t` is computed in
/// double precision. The error of the subtraction `p - o` is at most half the last bit of its result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FromWorld {
    columns: [[f32; 4]; 4],
    origin: Vec3,
}

impl FromWorld {
    pub(crate) fn to_eye(model_view: &Columns) -> Self {
        let identity = Columns::from_matrix(&Mat4::IDENTITY);
        Self::to_clip(&identity, model_view)
    }

    pub(crate) fn to_clip(projection: &Columns, model_view: &Columns) -> Self {
        Self::relative_to(model_view.origin(), projection, model_view)
    }

    pub(crate) fn relative_to(origin: Vec3, projection: &Columns, model_view: &Columns) -> Self {
        let [x, y, z] = origin.to_array().map(f64::from);
        let axes_and_eye = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]];
        let columns = axes_and_eye.map(|v| projection.times(model_view.times(v)).map(|v| v as f32));
        Self { columns, origin }
    }

    /// Returns the rows x, y, z and w of the matrix. The matrix applies to points relative to [`Self::origin`].
    pub(crate) fn rows(&self) -> [[f32; 4]; 4] {
        std::array::from_fn(|row| self.columns.map(|column| column[row]))
    }

    pub(crate) const fn origin(&self) -> Vec3 {
        self.origin
    }

    #[inline(always)]
    pub(crate) fn point(&self, p: Vec3) -> [f32; 4] {
        let [x, y, z] = [p.x - self.origin.x, p.y - self.origin.y, p.z - self.origin.z];
        let [cx, cy, cz, ct] = &self.columns;
        std::array::from_fn(|i| ((cx[i] * x + cy[i] * y) + cz[i] * z) + ct[i])
    }

    /// Returns the greatest factor by which the map stretches an axis. Returns NaN if the factor is 0 or not finite.
    pub(crate) fn scale(&self) -> f64 {
        let squares = self.columns[..3].iter().map(|&[x, y, z, _]| {
            let axis = [x, y, z].map(f64::from);
            dot(axis, axis)
        });
        newton::root(squares.fold(0.0, f64::max))
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_impossible_size_are_refused_with_the_found_size() {
        assert!(refusal(0, 480, 128).contains("found 0 x 480"));
        assert!(refusal(640, u32::MAX, 128).contains("4294967295"));
        assert!(refusal(640, 480, 0).contains("found 0 x 128"));
        assert!(refusal(640, 480, 129).contains("found 129 x 128"));
        assert!(refusal(2048, 480, 8).contains("found 1024"));
    }

    fn refusal(width: u32, height: u32, region_width: u32) -> String {
        let grid = RegionGrid { width, height, region_width, region_height: 128 };
        Viewport::new(grid, Lines::Frame).unwrap_err().to_string()
    }

    #[test]
    fn the_design_maximum_of_1280_x_1024_is_accepted() {
        let grid = RegionGrid { width: 1280, height: 1024, ..RegionGrid::FRAME };
        assert!(Viewport::new(grid, Lines::Frame).is_ok());
    }

    #[test]
    fn rows_of_a_field_are_every_second_line_of_the_frame() {
        let odd = Viewport::field(pxpl5_wire::FieldParity::Odd);
        assert_eq!((odd.line_step(), odd.first_line(), odd.frame_lines()), (2, 1, 480));
    }
}
