//! A triangle as linear functions over a face: three edges and the reciprocal of the distance along the axis.

use glam::DVec3;

/// A function a x + b y + c over a face, x to the right and y down in tangents from its middle.
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

    /// The constant part along a row.
    #[inline(always)]
    pub(crate) fn row(self, y: f64) -> f64 {
        self.y * y + self.c
    }

    /// The sum of some, each times a number.
    pub(crate) fn sum(parts: [Self; 3], times: [f64; 3]) -> Self {
        Self::of(parts[0].vector() * times[0] + parts[1].vector() * times[1] + parts[2].vector() * times[2])
    }
}

/// A triangle on a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edges {
    /// Positive inside of each edge; each opposite to the corner of its number, whose share divided by w it is, times `determinant`.
    pub(crate) edges: [Linear; 3],
    /// Twice the area that the triangle's pyramid spans.
    pub(crate) determinant: f64,
}

impl Edges {
    /// Of corners in a face's axes: x to the right, y down, z along the face's axis. `None` of a triangle that is seen edge-on.
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

    /// 1/w, where the plane of the triangle is met.
    pub(crate) fn reciprocal(&self) -> Linear {
        Linear::sum(self.edges, [1.0 / self.determinant; 3])
    }
}

impl Linear {
    /// Whether a middle at x of a row belongs to the inner side; on the edge itself that of the larger x, then of the larger y.
    #[inline(always)]
    fn takes(self, x: f64, row: f64) -> bool {
        let value = self.x * x + row;
        value > 0.0 || (value == 0.0 && (self.x > 0.0 || (self.x == 0.0 && self.y > 0.0)))
    }
}

/// An edge, and about where it crosses a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub(crate) edge: Linear,
    /// Columns for each unit of the row's constant part, and the column of the middle.
    columns_of: f64,
    middle: f64,
}

impl Crossing {
    pub(crate) fn new(edge: Linear, columns: Columns) -> Self {
        Self { edge, columns_of: -1.0 / (edge.x * columns.step), middle: -columns.first / columns.step }
    }

    /// Narrows a range of columns to those that this edge takes; columns have their middles at `first + column * step`.
    ///
    /// `takes` is monotone along a row, also as it is rounded: the crossing is found to within a column or two, and the
    /// function itself decides.
    #[inline(always)]
    pub(crate) fn narrow(&self, row: f64, columns: Columns, range: &mut [i64; 2]) {
        if self.edge.x == 0.0 {
            if !self.edge.takes(0.0, row) {
                range[1] = range[0];
            }
            return;
        }
        let at = (row * self.columns_of + self.middle).clamp(range[0] as f64 - 1.0, range[1] as f64 + 1.0);
        let mut border = at.floor() as i64;
        let takes = |column: i64| self.edge.takes(columns.middle(column), row);
        if self.edge.x > 0.0 {
            while border > range[0] && takes(border - 1) {
                border -= 1;
            }
            while border < range[1] && !takes(border) {
                border += 1;
            }
            range[0] = range[0].max(border);
        } else {
            while border < range[1] && takes(border) {
                border += 1;
            }
            while border > range[0] && !takes(border - 1) {
                border -= 1;
            }
            range[1] = range[1].min(border);
        }
    }
}

/// Middles of the columns (or rows) of a face, in tangents.
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
