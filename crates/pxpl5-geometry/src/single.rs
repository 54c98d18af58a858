//! Set-up of triangles in single precision, as the program of Slats does it (kernels/slats_rules.md).
//!
//! The words of these expressions equal the words of kernels/single.s, bit for bit. Corners, regions and covered pixels
//! are those of the other code, except for corners beyond the guard band: they are not clipped.

use crate::clip;
use crate::newton;
use crate::outline::Outline;
use crate::plane;
use crate::screen::{self, ScreenTriangle, VertexColours};
use crate::transform::{Snapped, Transform, Turn};
use crate::view::{Columns, FromWorld};
use crate::{Culling, DEPTH_NEAR, GouraudTriangle, Light, RegionMask, SetupStats, Touch, Triangle};
use crate::{ViewTransform, Viewport};
use glam::Vec3;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{Linear, format};

/// Width of the guard band in subpixels: 4096 px.
pub(crate) const BAND: f32 = 65_536.0;

/// Greatest coordinate of a corner that is not left to the clipper, in subpixels.
const FARTHEST: f32 = (1_u64 << 40) as f32;

/// Greatest constant of an edge between corners beyond the guard band, in 1/256 square px. It becomes 2^30 in the
/// expression. The other two terms are below 2^28 at every pixel, so they cannot change the sign.
const MOST: f64 = (1_u64 << 34) as f64;

const ROUND: f32 = 12_582_912.0;

/// A corner in subpixels from the left border and from the first line of the picture, and its depth.
#[derive(Clone, Copy, Debug)]
struct Corner {
    x: f32,
    y: f32,
    depth: f32,
}

impl Corner {
    fn reach(self) -> f32 {
        self.x.abs().max(self.y.abs())
    }
}

impl Transform {
    /// Prepares the transform of the program for Slats: a matrix that is not relative to the eye, and planes in single
    /// precision ([`Self::single_precision`]).
    ///
    /// # Errors
    /// Returns a [`SettingError`] if a matrix contains NaN or an infinity.
    pub fn in_single_precision(
        view: &ViewTransform,
        viewport: Viewport,
        culling: Culling,
    ) -> Result<Self, SettingError> {
        let [projection, model_view] = [&view.projection, &view.model_view].map(Columns::from_matrix);
        let to_clip = FromWorld::relative_to(Vec3::ZERO, &projection, &model_view);
        Ok(Self { to_clip, is_single: true, ..Self::new(view, viewport, culling)? })
    }

    fn first_subline(&self) -> f32 {
        16.0 * self.viewport.first_line() as f32
    }

    /// Returns a corner, or `None` if it is left to the clipper.
    fn single_corner(&self, position: Vec3) -> Option<Corner> {
        let [x, y, z, w] = self.to_clip.point(position);
        // Comparisons with NaN are false.
        if !(z >= 0.0 && w >= clip::MIN_W) {
            return None;
        }
        let inverse = newton::reciprocal(w);
        let [scale, centre] = [self.to_screen.scale, self.to_screen.centre];
        let corner = Corner {
            x: ((x * inverse) * scale[0] + (centre[0] + ROUND)) - ROUND,
            y: ((y * inverse) * scale[1] + (centre[1] + ROUND)) - (ROUND + self.first_subline()),
            depth: (z * (inverse * screen::DEPTH_SCALE)).min(screen::DEPTH_SCALE) + DEPTH_NEAR as f32,
        };
        (corner.x.abs() <= FARTHEST && corner.y.abs() <= FARTHEST).then_some(corner)
    }

    fn single_corners(&self, positions: &[Vec3; 3]) -> Option<[Corner; 3]> {
        let [p, q, r] = positions.map(|position| self.single_corner(position));
        Some([p?, q?, r?])
    }

    /// Returns a corner on the screen, or `None` if it is beyond the guard band or left to the clipper.
    pub(crate) fn single_vertex(&self, position: Vec3) -> Option<Snapped> {
        self.single_corner(position).filter(|corner| corner.reach() <= BAND).map(|corner| self.snapped(corner))
    }

    fn snapped(&self, Corner { x, y, depth }: Corner) -> Snapped {
        Snapped { x: x as i32, y: (y + self.first_subline()) as i32, z: depth as u32 }
    }

    /// Returns the regions that a triangle touches, or `None` if it is left to the clipper. A triangle with a corner
    /// beyond the guard band counts for all regions.
    pub(crate) fn single_touch(&self, positions: &[Vec3; 3]) -> Option<Touch> {
        self.single_corners(positions).map(|corners| self.touch_of(&corners))
    }

    fn touch_of(&self, corners: &[Corner; 3]) -> Touch {
        if corners.iter().all(|corner| corner.reach() <= BAND) {
            return self.touch_snapped(corners.map(|corner| self.snapped(corner)));
        }
        let twice_area = Sides::between(corners).twice_area();
        let turn = if twice_area < 0.0 { Turn::Counterclockwise } else { Turn::Clockwise };
        match self.dropped {
            _ if twice_area == 0.0 => Touch::Degenerate,
            Some(dropped) if dropped == turn => Touch::BackFacing,
            _ => {
                let regions = self.viewport.grid().regions();
                Touch::from_mask(RegionMask::with_bits(u128::MAX >> (RegionMask::CAPACITY - regions)))
            }
        }
    }

    /// Computes the expressions of a triangle with precomputed colours. Calls `sink` once, or for each piece if the
    /// triangle is clipped, unless it touches no region.
    ///
    /// The transform must come from [`Self::in_single_precision`]. Pieces have the planes of [`Self::gouraud`].
    pub fn single_precision(
        &self,
        triangle: &Triangle,
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<VertexColours>, GouraudTriangle),
    ) {
        // Single precision cannot clip, so such a triangle goes the exact way, and its flattened planes are counted.
        let Some(corners) = self.single_corners(&triangle.positions) else {
            let mut of_planes = SetupStats::default();
            self.gouraud(triangle, &Light::NONE, stats, |piece| {
                sink(piece, piece.gouraud(&self.viewport, &mut of_planes));
            });
            stats.flattened_planes += of_planes.flattened_planes;
            return;
        };
        stats.triangles += 1;
        let Some(regions) = self.touch_of(&corners).count(stats) else { return };
        // Exchange two corners of a triangle with a negative area, so that its edge expressions are positive inside.
        let order = if Sides::between(&corners).twice_area() < 0.0 { [0, 2, 1] } else { [0, 1, 2] };
        let [p, q, r] = order.map(|i| self.snapped(corners[i]));
        let outline = Outline { x: [p.x, q.x, r.x], y: [p.y, q.y, r.y], z: [p.z, q.z, r.z], regions };
        let colours = order.map(|i| triangle.colours[i].map(|part| u16::from(part) << 8));
        let expressions = self.expressions(&order.map(|i| corners[i]), &colours);
        sink(ScreenTriangle { outline, surface: VertexColours(colours) }, expressions);
    }

    fn expressions(&self, corners: &[Corner; 3], colours: &[[u16; 3]; 3]) -> GouraudTriangle {
        let [p, q, r] = corners;
        let step = self.viewport.line_step();
        let planes = Planes::new(corners, step as f32);
        let edges = [(p, q), (q, r), (r, p)].map(|(from, to)| edge(from, to, step as i32));
        let rgb = [0, 1, 2].map(|part| planes.through(colours.map(|colour| screen::colour_value(colour[part]))));
        GouraudTriangle { edges, z: planes.through(corners.map(|corner| corner.depth)), rgb }
    }
}

/// Returns the expression of an edge over the rows of the picture, which lie `step` lines apart.
fn edge(from: &Corner, to: &Corner, step: i32) -> Linear {
    let [x, y, to_x, to_y] = [from.x, from.y, to.x, to.y].map(|v| f64::from(v) - 8.0);
    let [mut dx, mut dy] = [to_x - x, to_y - y];
    let mut constant = x * to_y - to_x * y;
    let owns = dy < 0.0 || (dy == 0.0 && dx > 0.0);
    let reach = from.reach().max(to.reach());
    if reach > BAND {
        let factor = f64::from(newton::reciprocal(reach) * BAND);
        [dx, dy] = [dx * factor, dy * factor];
        constant = newton::whole((constant * factor).clamp(-MOST, MOST)) as f64;
    }
    let [a, b] = [-dy, dx].map(plane::rounded);
    let k = constant as i64 - i64::from(!owns);
    Linear { a, b: b * step, c: (k >> format::SUBPIXEL_BITS) as i32 }
}

/// Sides of a triangle from corner 0 to corners 1 and 2.
struct Sides {
    x: [f32; 2],
    y: [f32; 2],
}

impl Sides {
    fn between([p, q, r]: &[Corner; 3]) -> Self {
        Self { x: [q.x - p.x, r.x - p.x], y: [q.y - p.y, r.y - p.y] }
    }

    fn twice_area(&self) -> f64 {
        f64::from(self.x[0]) * f64::from(self.y[1]) - f64::from(self.y[0]) * f64::from(self.x[1])
    }
}

/// Values that all planes of a triangle share.
struct Planes {
    sides: Sides,
    /// Slopes for each pixel and for each row of the picture, per unit of a cross product.
    unit: [f32; 2],
    /// Way from corner 0 to the middle of pixel (0, 0), in pixels and rows.
    way: [f32; 2],
}

impl Planes {
    fn new(corners: &[Corner; 3], step: f32) -> Self {
        let sides = Sides::between(corners);
        let per_pixel = newton::reciprocal(sides.twice_area() as f32) * 16.0;
        let way = [(8.0 - corners[0].x) / 16.0, (8.0 - corners[0].y) / (16.0 * step)];
        Self { sides, unit: [per_pixel, per_pixel * step], way }
    }

    fn through(&self, v: [f32; 3]) -> Linear {
        let Sides { x, y } = &self.sides;
        let [first, second] = [v[1] - v[0], v[2] - v[0]];
        let slope_x = (first * y[1] - second * y[0]) * self.unit[0];
        let slope_y = (second * x[0] - first * x[1]) * self.unit[1];
        let origin = (v[0] + slope_x * self.way[0]) + slope_y * self.way[1];
        let [a, b, c] = [slope_x, slope_y, origin].map(|value| plane::rounded(value.into()));
        Linear { a, b, c }
    }
}
