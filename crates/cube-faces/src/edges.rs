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

/// An edge, and about where it crosses a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub(crate) edge: Linear,
    /// Whether the edge itself belongs to the inner side: that of the larger x, then of the larger y.
    has_edge: bool,
    /// Columns for each unit of the row's constant part, and the column of the middle.
    columns_of: f64,
    middle: f64,
}

impl Crossing {
    pub(crate) fn new(edge: Linear, columns: Columns) -> Self {
        let has_edge = edge.x > 0.0 || (edge.x == 0.0 && edge.y > 0.0);
        Self { edge, has_edge, columns_of: -1.0 / (edge.x * columns.step), middle: -columns.first / columns.step }
    }

    /// Whether a middle at x of a row belongs to the inner side.
    #[inline(always)]
    fn takes(&self, x: f64, row: f64) -> bool {
        let value = self.edge.x * x + row;
        value > 0.0 || (value == 0.0 && self.has_edge)
    }

    /// Narrows a range of columns to those that this edge takes; columns have their middles at `first + column * step`.
    ///
    /// `takes` is monotone along a row, also as it is rounded: the crossing is found to within a column or two, and the
    /// function itself decides.
    #[inline(always)]
    pub(crate) fn narrow(&self, row: f64, columns: Columns, range: &mut [i64; 2]) {
        if self.edge.x == 0.0 {
            if !self.takes(0.0, row) {
                range[1] = range[0];
            }
            return;
        }
        let at = (row * self.columns_of + self.middle).clamp(range[0] as f64 - 1.0, range[1] as f64 + 1.0);
        let border = at.floor() as i64 + 1;
        let is_left = self.edge.x > 0.0;
        let sides = [border - 1, border].map(|column| self.takes(columns.middle(column), row));
        // Nearly always the border lies between these two.
        let border = if sides == [!is_left, is_left] { border } else { self.search(border, row, columns, *range) };
        if is_left {
            range[0] = range[0].max(border);
        } else {
            range[1] = range[1].min(border);
        }
    }

    /// The border from a column on, within a range.
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
