use crate::bin::Binner;
use crate::clip::{self, ClipVertex, Corner, Guard};
use crate::lens::Lens;
use crate::light::{ModelLight, NormalRows};
use crate::newton;
use crate::outline::{Outline, SUBPIXELS};
use crate::screen::{self, ScreenTriangle, SurfaceNormals, VertexColours};
use crate::touch::Touch;
use crate::view::{Columns, FromWorld};
use crate::{Light, RegionMask, SetupStats, Triangle, ViewTransform, Viewport};
use glam::Vec3;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// The choice whether back faces are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Culling {
    /// All triangles are drawn.
    #[default]
    None,
    /// Back faces are not drawn. A back face is a triangle whose corners run clockwise in model coordinates, seen from
    /// the eye, even if a matrix mirrors the triangle.
    Back,
}

impl Culling {
    /// Both choices with their names in settings.
    pub const ALL: [(&str, Self); 2] = [("none", Self::None), ("back", Self::Back)];
}

pxpl5_sim::parameters::named!(Culling, "culling", Culling::ALL);

/// The transform of primitives for one view and one picture.
#[derive(Clone, Debug)]
pub struct Transform {
    pub(crate) viewport: Viewport,
    pub(crate) to_eye: FromWorld,
    pub(crate) normals: NormalRows,
    /// Projection of spheres, or `None` if the projection cannot show spheres.
    pub(crate) lens: Option<Lens>,
    pub(crate) to_clip: FromWorld,
    pub(crate) to_screen: ToScreen,
    pub(crate) guard: Guard,
    pub(crate) binner: Binner,
    /// Winding on the screen of the triangles that are not drawn. `None` if all triangles are drawn.
    pub(crate) dropped: Option<Turn>,
    /// True if planes are computed in single precision ([`Self::in_single_precision`]).
    pub(crate) is_single: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    Clockwise,
    Counterclockwise,
}

/// Map from a normalized device coordinate `v` to subpixels: `scale * v + centre`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToScreen {
    pub(crate) scale: [f32; 2],
    pub(crate) centre: [f32; 2],
}

/// A vertex on the screen: x and y in 1/16 px of the video frame, z as fixed-point depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Snapped {
    pub(crate) x: i32,
    pub(crate) y: i32,
    pub(crate) z: u32,
}

/// The corners of a triangle on the screen in two views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleEnds {
    from: [Snapped; 3],
    to: [Snapped; 3],
}

impl TriangleEnds {
    /// Returns the corners at an instant between the two views, in whole subpixels. `s` is 0 in the first view and 1 in
    /// the second view.
    fn at(&self, s: f64) -> [Snapped; 3] {
        std::array::from_fn(|i| Snapped {
            x: whole_between(self.from[i].x.into(), self.to[i].x.into(), s) as i32,
            y: whole_between(self.from[i].y.into(), self.to[i].y.into(), s) as i32,
            z: whole_between(self.from[i].z.into(), self.to[i].z.into(), s) as u32,
        })
    }

    /// Returns the smallest and largest distance of a corner from the top of the video frame, over both views, in 1/16
    /// px.
    pub fn y_range(&self) -> [i32; 2] {
        let ys = self.from.iter().chain(&self.to).map(|corner| corner.y);
        [ys.clone().min().unwrap_or_default(), ys.max().unwrap_or_default()]
    }
}

fn whole_between(from: f64, to: f64, s: f64) -> f64 {
    (from + (to - from) * s + 0.5).floor()
}

fn half_in_subpixels(pixels: u32) -> f32 {
    (pixels * SUBPIXELS as u32) as f32 * 0.5
}

impl ToScreen {
    fn new(viewport: &Viewport) -> Self {
        let x = half_in_subpixels(viewport.grid().width);
        let y = half_in_subpixels(viewport.frame_lines());
        Self { scale: [x, -y], centre: [x, y] }
    }

    /// Returns the guard band, which ends one pixel before [`screen::GUARD_PIXELS`] to allow for rounding.
    fn guard(&self) -> Guard {
        let limit = ((screen::GUARD_PIXELS - 1) * SUBPIXELS) as f32;
        Guard { x: (limit - self.centre[0]) / self.centre[0], y: (limit - self.centre[1]) / self.centre[1] }
    }

    /// Divides by w and rounds to subpixels. The vertex must be inside the guard band.
    #[inline(always)]
    pub(crate) fn snap(&self, [x, y, z, w]: [f32; 4]) -> Snapped {
        let inverse = newton::reciprocal(w);
        Snapped {
            x: screen::rounded_sum((x * inverse) * self.scale[0], self.centre[0]),
            y: screen::rounded_sum((y * inverse) * self.scale[1], self.centre[1]),
            z: screen::depth_fixed(f64::from(z) * f64::from(inverse * screen::DEPTH_SCALE)),
        }
    }

    /// Divides a corner of a clipped triangle by w and rounds it to subpixels. Returns `None` if w is so near 0 that
    /// the corner is still outside the guard band.
    ///
    /// An original vertex gets the same result as in an unclipped triangle. A corner that clipping has made is computed
    /// in double precision.
    fn snap_corner<const N: usize>(&self, Corner { clip, cut, .. }: &Corner<N>) -> Option<Snapped> {
        let limit = f64::from(screen::GUARD_PIXELS * SUBPIXELS);
        if clip[3] < f64::from(clip::MIN_W) {
            return None;
        }
        let inverse = newton::reciprocal_double(clip[3]);
        let x = (clip[0] * inverse) * f64::from(self.scale[0]) + f64::from(self.centre[0]);
        let y = (clip[1] * inverse) * f64::from(self.scale[1]) + f64::from(self.centre[1]);
        if x.abs() > limit || y.abs() > limit {
            return None;
        }
        if !cut {
            return Some(self.snap(clip.map(|v| v as f32)));
        }
        let z = screen::depth_fixed(clip[2] * inverse * f64::from(screen::DEPTH_SCALE));
        Some(Snapped { x: x.round_ties_even() as i32, y: y.round_ties_even() as i32, z })
    }
}

pub(crate) struct Assembled {
    pub(crate) outline: Outline,
    /// True if corners 1 and 2 of the input were exchanged.
    swapped: bool,
}

impl Assembled {
    /// Arranges corners in clockwise order, or returns `None` if the triangle has no area. The result has no regions
    /// yet.
    #[inline(always)]
    pub(crate) fn clockwise([p, q, r]: [Snapped; 3]) -> Option<Self> {
        let mut outline =
            Outline { x: [p.x, q.x, r.x], y: [p.y, q.y, r.y], z: [p.z, q.z, r.z], regions: RegionMask::EMPTY };
        let twice_area = outline.twice_area();
        let swapped = twice_area < 0;
        if swapped {
            outline.x.swap(1, 2);
            outline.y.swap(1, 2);
            outline.z.swap(1, 2);
        }
        (twice_area != 0).then_some(Self { outline, swapped })
    }

    #[inline(always)]
    pub(crate) fn order<T>(&self, [p, q, r]: [T; 3]) -> [T; 3] {
        if self.swapped { [p, r, q] } else { [p, q, r] }
    }
}

/// Returns true if a view mirrors triangles, so that their winding changes.
///
/// The test is the sign of the determinant of the map from model coordinates to x, y and w. With a parallel projection,
/// w is constant, and depth replaces w. A view along -Z without mirroring has a negative determinant.
fn is_mirrored(view: &ViewTransform) -> bool {
    let matrix = view.projection * view.model_view;
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| matrix.row(row).truncate().as_dvec3());
    let of_perspective = x.cross(y).dot(w);
    let determinant = if of_perspective == 0.0 { x.cross(y).dot(z) } else { of_perspective };
    determinant > 0.0
}

impl Transform {
    /// Prepares the transform for a view and a picture.
    ///
    /// # Errors
    /// Returns a [`SettingError`] if a matrix contains NaN or an infinity.
    pub fn new(view: &ViewTransform, viewport: Viewport, culling: Culling) -> Result<Self, SettingError> {
        let model_view = Columns::from_matrix(&view.model_view);
        let projection = Columns::from_matrix(&view.projection);
        // Reject NaN and infinities here, so that later steps need no test for them.
        for (matrix, columns) in [("model-view", &model_view), ("projection", &projection)] {
            if !columns.is_finite() {
                let name = format!("{matrix} matrix");
                return Err(SettingError::value(&name, "finite numbers", "NaN or infinity"));
            }
        }
        let to_screen = ToScreen::new(&viewport);
        let to_eye = FromWorld::to_eye(&model_view);
        Ok(Self {
            viewport,
            to_clip: FromWorld::to_clip(&projection, &model_view),
            normals: NormalRows::new(&to_eye),
            to_eye,
            lens: Lens::from_projection(&projection, viewport.grid().width, viewport.frame_lines()),
            guard: to_screen.guard(),
            to_screen,
            binner: Binner::new(&viewport),
            // A mirroring view reverses the winding of back faces on the screen.
            dropped: match culling {
                Culling::None => None,
                Culling::Back if is_mirrored(view) => Some(Turn::Counterclockwise),
                Culling::Back => Some(Turn::Clockwise),
            },
            is_single: false,
        })
    }

    /// Returns true if planes are computed in single precision ([`Self::in_single_precision`]).
    pub const fn is_single(&self) -> bool {
        self.is_single
    }

    pub const fn viewport(&self) -> &Viewport {
        &self.viewport
    }

    /// Finds the regions that a triangle touches. Calls `sink` with these regions, once for each resulting screen
    /// triangle.
    ///
    /// Clipping can make several screen triangles. [`Self::gouraud`] and [`Self::phong`] give the same triangles in the
    /// same order.
    #[inline]
    pub fn bin(&self, positions: &[Vec3; 3], stats: &mut SetupStats, mut sink: impl FnMut(RegionMask)) {
        stats.triangles += 1;
        if self.is_single
            && let Some(touch) = self.single_touch(positions)
        {
            return touch.count(stats).into_iter().for_each(sink);
        }
        let clip = positions.map(|p| self.to_clip.point(p));
        if clip.iter().all(|c| self.guard.contains(*c)) {
            let corners = clip.map(|c| self.to_screen.snap(c));
            if let Some(whole) = self.assemble(corners, stats) {
                sink(whole.outline.regions);
            }
            return;
        }
        let corners = clip.map(|clip| ClipVertex { clip, extra: [] });
        self.clipped(&corners, stats, |piece, _| sink(piece.outline.regions));
    }

    /// Transforms a triangle like [`Self::bin`], but calls `sink` with the corners on the screen.
    #[inline]
    pub fn outlines(&self, positions: &[Vec3; 3], stats: &mut SetupStats, mut sink: impl FnMut(&Outline)) {
        self.triangle(positions, |_| [0.0; 3], stats, |outline, _| sink(&outline));
    }

    /// Transforms and lights a triangle. Calls `sink` for each resulting screen triangle that touches a region.
    #[inline]
    pub fn gouraud(
        &self,
        triangle: &Triangle,
        light: &Light,
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<VertexColours>),
    ) {
        let lighting = ModelLight::new(&self.normals, light);
        self.triangle(
            &triangle.positions,
            |i| lighting.corner_colour(triangle, i),
            stats,
            |outline, colours| {
                sink(lit_triangle(outline, colours));
            },
        );
    }

    /// Transforms a triangle and its normals. Calls `sink` for each resulting screen triangle that touches a region.
    #[inline]
    pub fn phong(
        &self,
        triangle: &Triangle,
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<SurfaceNormals>),
    ) {
        let normals = crate::light::facing_normals(&self.normals, &triangle.positions, &triangle.normals);
        let colour = triangle.colours[0];
        self.triangle(
            &triangle.positions,
            |i| normals[i],
            stats,
            |outline, n| {
                sink(normal_triangle(outline, n, colour));
            },
        );
    }

    /// Transforms a triangle. `extra` returns a corner's colour or normal, and is called only for visible triangles.
    #[inline(always)]
    fn triangle(
        &self,
        positions: &[Vec3; 3],
        extra: impl Fn(usize) -> [f32; 3],
        stats: &mut SetupStats,
        mut sink: impl FnMut(Outline, [[f32; 3]; 3]),
    ) {
        stats.triangles += 1;
        let clip = positions.map(|p| self.to_clip.point(p));
        // Fast path: a triangle inside the guard band needs no clipping.
        if clip.iter().all(|c| self.guard.contains(*c)) {
            let corners = clip.map(|c| self.to_screen.snap(c));
            if let Some(whole) = self.assemble(corners, stats) {
                sink(whole.outline, whole.order([0, 1, 2]).map(&extra));
            }
            return;
        }
        let corners = std::array::from_fn(|i| ClipVertex { clip: clip[i], extra: extra(i) });
        self.clipped(&corners, stats, |piece, extras| sink(piece.outline, extras));
    }

    /// Returns the corners of a triangle on the screen in two views: this view and the view `end`. Both views must have
    /// the same viewport.
    ///
    /// Returns `None` if a corner is outside the guard band in one of the views.
    pub fn ends(&self, end: &Self, positions: &[Vec3; 3]) -> Option<TriangleEnds> {
        Some(TriangleEnds { from: self.snap_unclipped(positions)?, to: end.snap_unclipped(positions)? })
    }

    fn snap_unclipped(&self, positions: &[Vec3; 3]) -> Option<[Snapped; 3]> {
        let clip = positions.map(|p| self.to_clip.point(p));
        clip.iter().all(|c| self.guard.contains(*c)).then(|| clip.map(|c| self.to_screen.snap(c)))
    }

    /// Lights a triangle whose corners are interpolated between two views, with the light of this view. `s` is 0 in the
    /// first view and 1 in the second view.
    pub fn gouraud_between(
        &self,
        ends: &TriangleEnds,
        s: f64,
        triangle: &Triangle,
        light: &Light,
        stats: &mut SetupStats,
        mut sink: impl FnMut(ScreenTriangle<VertexColours>),
    ) {
        stats.triangles += 1;
        if let Some(whole) = self.assemble(ends.at(s), stats) {
            let lighting = ModelLight::new(&self.normals, light);
            let colours = whole.order([0, 1, 2]).map(|i| lighting.corner_colour(triangle, i));
            sink(lit_triangle(whole.outline, colours));
        }
    }

    /// Calls `sink` with the corners of a triangle that are interpolated between two views, as in
    /// [`Self::gouraud_between`] but without colours.
    pub fn outline_between(&self, ends: &TriangleEnds, s: f64, stats: &mut SetupStats, mut sink: impl FnMut(&Outline)) {
        stats.triangles += 1;
        if let Some(whole) = self.assemble(ends.at(s), stats) {
            sink(&whole.outline);
        }
    }

    /// Returns the corners in clockwise order with the touched regions. If the triangle is not drawn, returns `None`
    /// and counts the reason.
    #[inline(always)]
    fn assemble(&self, corners: [Snapped; 3], stats: &mut SetupStats) -> Option<Assembled> {
        let whole = Assembled::clockwise(corners);
        let regions = self.touch(whole.as_ref()).count(stats)?;
        let mut whole = whole?;
        whole.outline.regions = regions;
        Some(whole)
    }

    pub(crate) fn touch_snapped(&self, corners: [Snapped; 3]) -> Touch {
        self.touch(Assembled::clockwise(corners).as_ref())
    }

    /// Returns the regions that a triangle touches. The triangle must be inside the guard band. `whole` is `None` if
    /// the triangle has no area.
    #[inline(always)]
    fn touch(&self, whole: Option<&Assembled>) -> Touch {
        let Some(whole) = whole else { return Touch::Degenerate };
        let turn = if whole.swapped { Turn::Counterclockwise } else { Turn::Clockwise };
        if self.dropped == Some(turn) {
            return Touch::BackFacing;
        }
        Touch::from_mask(self.binner.triangle(&whole.outline))
    }

    /// Clips a triangle and splits the resulting polygon into triangles. Calls `sink` for each of these triangles that
    /// touches a region.
    #[inline(never)]
    fn clipped<const N: usize>(
        &self,
        corners: &[ClipVertex<N>; 3],
        stats: &mut SetupStats,
        mut sink: impl FnMut(Assembled, [[f32; N]; 3]),
    ) {
        // Drop triangles that clipping cannot handle or would remove completely.
        let clip = corners.map(|v| v.clip);
        if !clip::representable(&clip) {
            stats.not_finite += 1;
            return;
        }
        if clip::all_outside(&clip) {
            stats.outside += 1;
            return;
        }
        stats.clipped += 1;
        let polygon = self.guard.clip(corners);
        let [first, rest @ ..] = polygon.corners() else {
            return;
        };
        // The polygon is convex, so a fan around its first corner covers it.
        for pair in rest.windows(2) {
            let piece = [*first, pair[0], pair[1]];
            if let Some(assembled) = self.piece(&piece, stats) {
                let extras = piece.map(|corner| corner.extra.map(|v| v as f32));
                let extras = assembled.order(extras);
                sink(assembled, extras);
            }
        }
    }

    fn piece<const N: usize>(&self, piece: &[Corner<N>; 3], stats: &mut SetupStats) -> Option<Assembled> {
        let [p, q, r] = piece.each_ref().map(|corner| self.to_screen.snap_corner(corner));
        match [p, q, r] {
            [Some(p), Some(q), Some(r)] => self.assemble([p, q, r], stats),
            _ => {
                stats.not_finite += 1;
                None
            }
        }
    }
}

#[inline(always)]
fn lit_triangle(outline: Outline, colours: [[f32; 3]; 3]) -> ScreenTriangle<VertexColours> {
    ScreenTriangle { outline, surface: VertexColours(colours.map(|c| c.map(screen::colour_fixed))) }
}

#[inline(always)]
fn normal_triangle(outline: Outline, normals: [[f32; 3]; 3], colour: [u8; 3]) -> ScreenTriangle<SurfaceNormals> {
    ScreenTriangle {
        outline,
        surface: SurfaceNormals { normals: normals.map(|n| n.map(screen::normal_fixed)), colour },
    }
}
