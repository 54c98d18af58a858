//! Linear functions that describe a triangle on a face: three edges, and the reciprocal of the distance along the
//! face's axis.

use glam::DVec3;

/// A linear function a x + b y + c over a face. x points right and y points down. Both coordinates are tangents of
/// angles from the face's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Linear {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) c: f64,
}

impl Linear {
    fn of(v: DVec3) -> Self {
        Self { x: v.x, y: v.y, c: v.z }
    }

    fn vector(self) -> DVec3 {
        DVec3::new(self.x, self.y, self.c)
    }

    /// Returns `b y + c`, the part of the function that is constant along a row.
    #[inline(always)]
    pub(crate) fn row(self, y: f64) -> f64 {
        self.y * y + self.c
    }

    pub(crate) fn sum(parts: [Self; 3], times: [f64; 3]) -> Self {
        Self::of(parts[0].vector() * times[0] + parts[1].vector() * times[1] + parts[2].vector() * times[2])
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Edges {
    /// Edge functions, positive inside the triangle. Function i belongs to the edge opposite to corner i.
    ///
    /// Function i divided by `determinant` is the barycentric coordinate of corner i divided by w.
    pub(crate) edges: [Linear; 3],
    /// Triple product of the corners: six times the volume of the pyramid between the eye and the triangle.
    pub(crate) determinant: f64,
}

impl Edges {
    /// Creates the functions from corners in a face's axes: x right, y down, z along the face's axis.
    ///
    /// Returns `None` if the plane of the triangle contains the eye.
    pub(crate) fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let edges = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = a.dot(edges[0]);
        if determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let sign = determinant.signum();
        Some(Self { edges: edges.map(|edge| Linear::of(edge * sign)), determinant: determinant.abs() })
    }

    /// Returns 1/w as a linear function over the face, for points of the triangle. w is the distance along the face's
    /// axis.
    pub(crate) fn reciprocal(&self) -> Linear {
        Linear::sum(self.edges, [1.0 / self.determinant; 3])
    }
}

/// An edge function, with constants that find the column at which the edge crosses a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub(crate) edge: Linear,
    /// True for left edges and horizontal upper edges. Points exactly on such an edge count as inside.
    has_edge: bool,
    /// Factor that converts the constant part of the edge function in a row to the column of the crossing, relative to
    /// `middle`.
    columns_of: f64,
    /// Column index of the face's middle, with a fraction.
    middle: f64,
}

impl Crossing {
    pub(crate) fn new(edge: Linear, columns: Columns) -> Self {
        let has_edge = edge.x > 0.0 || (edge.x == 0.0 && edge.y > 0.0);
        Self { edge, has_edge, columns_of: -1.0 / (edge.x * columns.step), middle: -columns.first / columns.step }
    }

    /// Returns true if a texel whose middle is at `x` lies on the inner side of the edge.
    #[inline(always)]
    fn takes(&self, x: f64, row: f64) -> bool {
        let value = self.edge.x * x + row;
        value > 0.0 || (value == 0.0 && self.has_edge)
    }

    /// Restricts a range of columns to the columns on the inner side of this edge.
    ///
    /// A quotient estimates the column at which the edge crosses the row. The function `takes` then finds the exact
    /// column. There is only one such column, because the rounded value of the edge function only rises or only falls
    /// along a row.
    #[inline(always)]
    pub(crate) fn narrow(&self, row: f64, columns: Columns, range: &mut [i64; 2]) {
        // A horizontal edge accepts the whole row or nothing.
        if self.edge.x == 0.0 {
            if !self.takes(0.0, row) {
                range[1] = range[0];
            }
            return;
        }
        // Estimate the crossing, then test the two nearest columns.
        let at = (row * self.columns_of + self.middle).clamp(range[0] as f64 - 1.0, range[1] as f64 + 1.0);
        let border = at.floor() as i64 + 1;
        let is_left = self.edge.x > 0.0;
        let sides = [border - 1, border].map(|column| self.takes(columns.middle(column), row));
        // The estimate is nearly always exact.
        let border = if sides == [!is_left, is_left] { border } else { self.search(border, row, columns, *range) };
        if is_left {
            range[0] = range[0].max(border);
        } else {
            range[1] = range[1].min(border);
        }
    }

    /// Finds the exact first or last column inside the edge, within a range. The search starts at the estimated column
    /// `from`.
    #[cold]
    #[inline(never)]
    fn search(&self, from: i64, row: f64, columns: Columns, range: [i64; 2]) -> i64 {
        let is_left = self.edge.x > 0.0;
        let is_before = |column: i64| self.takes(columns.middle(column), row) != is_left;
        let mut border = from.clamp(range[0] - 1, range[1] + 1);
        while border > range[0] && !is_before(border - 1) {
            border -= 1;
        }
        while border < range[1] && is_before(border) {
            border += 1;
        }
        border
    }
}

/// Middles of a face's columns or rows, as tangents of angles from the face's middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    pub(crate) first: f64,
    pub(crate) step: f64,
}

impl Columns {
    #[inline(always)]
    pub(crate) fn middle(self, column: i64) -> f64 {
        self.first + column as f64 * self.step
    }
}
