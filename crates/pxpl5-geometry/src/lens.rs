//! The part of a projection that spheres need.

use crate::view::Columns;

/// How eye coordinates become pixels and depths, as far as spheres need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    /// Whether the projection is parallel, so that distance does not shrink.
    pub(crate) parallel: bool,
    /// Eye units per pixel along x and along y (negative: y grows downwards), at distance 1 under perspective.
    pub(crate) step: [f64; 2],
    /// Eye x and y of the centre of the frame's pixel (0, 0), at distance 1 under perspective.
    pub(crate) corner: [f64; 2],
    /// Depth is `constant + slope u`, u = 1/t under perspective, -t under a parallel projection.
    pub(crate) constant: f64,
    pub(crate) slope: f64,
}

impl Lens {
    /// `None` unless the matrix is a perspective or parallel projection along -Z, possibly off centre.
    pub(crate) fn from_projection(projection: &Columns, width: u32, lines: u32) -> Option<Self> {
        if !projection.is_zero_at(&[(0, 1), (1, 0), (2, 0), (2, 1), (3, 0), (3, 1)]) {
            return None;
        }
        let parallel = match (projection.cell(3, 2), projection.cell(3, 3)) {
            (-1.0, 0.0) if projection.is_zero_at(&[(0, 3), (1, 3)]) => false,
            (0.0, 1.0) if projection.is_zero_at(&[(0, 2), (1, 2)]) => true,
            _ => return None,
        };
        let [shift_x, shift_y, slope, constant] = if parallel {
            [-projection.cell(0, 3), -projection.cell(1, 3), projection.cell(2, 2), projection.cell(2, 3)]
        } else {
            [projection.cell(0, 2), projection.cell(1, 2), projection.cell(2, 3), -projection.cell(2, 2)]
        };
        let [half_x, half_y] = [width, lines].map(|n| f64::from(n) * 0.5);
        let scale_x = projection.cell(0, 0);
        let scale_y = projection.cell(1, 1);
        let lens = Self {
            parallel,
            step: [1.0 / (half_x * scale_x), -1.0 / (half_y * scale_y)],
            corner: [(0.5 / half_x - 1.0 + shift_x) / scale_x, (1.0 - 0.5 / half_y + shift_y) / scale_y],
            constant,
            slope,
        };
        (scale_x > 0.0 && scale_y > 0.0 && lens.slope < 0.0).then_some(lens)
    }

    /// Depth at distance t along -Z.
    pub(crate) fn depth(&self, t: f64) -> f64 {
        let u = if self.parallel { -t } else { 1.0 / t };
        self.constant + self.slope * u
    }
}
