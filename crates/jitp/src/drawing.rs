//! The primitives of a display list as seen in one view, or interpolated between two views.

use crate::config::Interpolation;
use glam::Mat4;
use pphigs::{
    DisplayList, EyeView, FrameView, MemoryPart, ModelEdit, Picture, PlacedStructure, PrimitiveCounts, Share,
    StripInterpolation, gouraud_sphere, place_all,
};
use pxpl5_geometry::{Outline, ScreenSphere, ScreenTriangle, SetupStats, TriangleEnds, VertexColours, Viewport};
use pxpl5_renderer::{Command, TriangleCommand};
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Number of subpixels along the side of a pixel. Coordinates of outlines are in subpixels.
const SUBPIXELS: i32 = 1 << pxpl5_wire::format::SUBPIXEL_BITS;

/// Largest deviation, in subpixels, between a straight line and the path of a triangle's corner on the screen. The path
/// is curved if positions are interpolated in eye space.
///
/// The limit is 8 pixels. A head that turns by 10 degrees during a field causes a deviation of 5 pixels, and real heads
/// do not turn so fast.
const CURVED: i32 = 8 * SUBPIXELS;

/// A rectangle of pixels. `across` has its first and last column, and `lines` has its first and last line of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) across: [i32; 2],
    pub(crate) lines: [i32; 2],
}

/// The display list as it is drawn for a strip of lines or for a batch of blocks.
pub(crate) struct DrawnList {
    list: Arc<DisplayList>,
    viewport: Viewport,
    placed: Vec<PlacedStructure>,
    /// Instant between two views for which the list is drawn. `None` if the list has only one view.
    between: Option<Between>,
    /// Triangles on the screen, computed at the first use. All strips of a conventional picture share these triangles.
    outlines: OnceLock<Vec<Outline>>,
}

/// An instant between two views of a display list, with the data to interpolate the list for this instant.
struct Between {
    ends: Ends,
    /// Position of this instant on a scale from the first view (0) to the second view (1).
    part: f64,
    interpolation: Interpolation,
    /// View at this instant, with interpolated matrices.
    view: FrameView,
}

/// The transformed display list, either for the start and the end of a field, or for one instant only.
#[derive(Clone)]
pub(crate) struct Ends {
    pub(crate) views: Arc<[FrameView]>,
    triangles: Arc<[Vec<Option<TriangleEnds>>]>,
}

impl fmt::Debug for DrawnList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DrawnList").field("viewport", &self.viewport).finish_non_exhaustive()
    }
}

impl Ends {
    /// Transforms the list for `views`. `views` has one view, or two views for the start and the end of a field.
    pub(crate) fn new(list: &DisplayList, views: Vec<FrameView>, viewport: Viewport) -> Self {
        let triangles = match &views[..] {
            [from, to] => triangle_ends(list, from, to, viewport),
            _ => Vec::new(),
        };
        Self { triangles: triangles.into(), views: views.into() }
    }
}

/// Returns the screen positions of the corners of each structure's triangles, in both views.
fn triangle_ends(
    list: &DisplayList,
    from: &FrameView,
    to: &FrameView,
    viewport: Viewport,
) -> Vec<Vec<Option<TriangleEnds>>> {
    let placed = place_all(list, from, 0, viewport).into_iter().zip(place_all(list, to, 0, viewport));
    placed.map(|(from, to)| structure_ends(list, &from, &to)).collect()
}

/// Returns the screen positions of the corners of one structure's triangles, in both views. The result is `None` for a
/// triangle without a position in one of the views.
fn structure_ends(list: &DisplayList, from: &PlacedStructure, to: &PlacedStructure) -> Vec<Option<TriangleEnds>> {
    let numbers = from.structure.triangles.clone();
    numbers.map(|number| from.transform.as_ref()?.ends(to.transform.as_ref()?, &list.corners(number))).collect()
}

impl DrawnList {
    /// Prepares the display list for drawing from one view.
    pub(crate) fn from_view(list: &Arc<DisplayList>, view: &FrameView, viewport: Viewport) -> Self {
        let placed = place_all(list, view, 0, viewport);
        Self { list: Arc::clone(list), viewport, placed, between: None, outlines: OnceLock::new() }
    }

    /// Prepares the display list for drawing at position `s` between two views.
    pub(crate) fn between(
        list: &Arc<DisplayList>,
        ends: &Ends,
        s: f64,
        interpolation: Interpolation,
        viewport: Viewport,
    ) -> Self {
        let view = interpolated(&ends.views[0], &ends.views[1], s);
        let drawn = Self::from_view(list, &view, viewport);
        Self { between: Some(Between { ends: ends.clone(), part: s, interpolation, view }), ..drawn }
    }

    /// Returns the number of primitives that touch each window, and the number of primitives that touch at least one
    /// window.
    pub(crate) fn count(&self, windows: &[Window]) -> (Vec<PrimitiveCounts>, PrimitiveCounts) {
        let mut tallies = WindowCounts::new(windows);
        if self.between.is_some() {
            self.each_outline(near(windows), |outline| tallies.add_outline(outline));
        } else {
            let outlines = self.outlines.get_or_init(|| self.make_outlines());
            outlines.iter().for_each(|outline| tallies.add_outline(outline));
        }
        self.spheres(|sphere, _| tallies.add_sphere(sphere));
        (tallies.each, tallies.any)
    }

    fn make_outlines(&self) -> Vec<Outline> {
        let mut all = Vec::new();
        self.each_outline([i32::MIN, i32::MAX], |outline| all.push(*outline));
        all
    }

    /// Calls `sink` for each triangle on the screen. The function leaves out triangles that cannot touch the range of
    /// lines `near` (see the function [`near`]).
    fn each_outline(&self, near: [i32; 2], mut sink: impl FnMut(&Outline)) {
        let mut stats = SetupStats::default();
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for (k, number) in place.structure.triangles.clone().enumerate() {
                match self.ends_of(i, k) {
                    Some((ends, ..)) if is_outside_lines(ends, near) => {}
                    Some((ends, s, Interpolation::Screen)) => transform.outline_between(ends, s, &mut stats, &mut sink),
                    _ => transform.outlines(&self.list.corners(number), &mut stats, &mut sink),
                }
            }
        }
    }

    /// Returns data to interpolate the triangle with index `k` of a structure. The data are the triangle's positions in
    /// both views, the position of the drawn instant between the views (0 to 1), and the mode of interpolation.
    ///
    /// Returns `None` if the triangle is not interpolated.
    fn ends_of(&self, structure: usize, k: usize) -> Option<(&TriangleEnds, f64, Interpolation)> {
        let Between { ends, part, interpolation, .. } = self.between.as_ref()?;
        Some((ends.triangles.get(structure)?.get(k)?.as_ref()?, *part, *interpolation))
    }

    fn spheres(&self, mut sink: impl FnMut(&ScreenSphere, &PlacedStructure)) {
        let mut stats = SetupStats::default();
        for place in &self.placed {
            let Some(transform) = &place.transform else { continue };
            let seen =
                place.structure.spheres.clone().filter_map(|i| transform.sphere(&self.list.spheres[i], &mut stats));
            seen.collect::<Vec<_>>().iter().for_each(|sphere| sink(sphere, place));
        }
    }

    /// Calls `sink` with the command of each triangle that touches the window, in the order of the display list. The
    /// window must be a window of an earlier call of [`Self::count`], so that the number of commands equals the count.
    pub(crate) fn triangle_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        let near = near(std::slice::from_ref(window));
        let mut stats = SetupStats::default();
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for (k, number) in place.structure.triangles.clone().enumerate() {
                let triangle = self.list.triangle(number);
                // A triangle with positions in both views is interpolated. Every other triangle is drawn in the list's
                // own view.
                match self.ends_of(i, k) {
                    Some((ends, ..)) if is_outside_lines(ends, near) => {}
                    Some((ends, s, Interpolation::Screen)) => {
                        transform.gouraud_between(ends, s, &triangle, &place.light, &mut stats, |t| {
                            sink_if_met(t, window, &self.viewport, &mut sink);
                        });
                    }
                    _ => transform.gouraud(&triangle, &place.light, &mut stats, |t| {
                        sink_if_met(t, window, &self.viewport, &mut sink);
                    }),
                }
            }
        }
    }

    /// Calls `sink` with the command of each sphere that touches the window, in the order of the display list.
    pub(crate) fn sphere_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        self.spheres(|sphere, place| {
            if sphere.meets(window.across, window.lines) {
                sink(gouraud_sphere(&sphere.gouraud(&self.viewport, &place.light, &mut SetupStats::default())));
            }
        });
    }

    /// Returns the work of interpolating the primitives near `windows` (rectangles of the screen). Returns `None` if
    /// there is only one view.
    ///
    /// The last parameter has two parts of the board's memory, `ends` and `commands`. The part `ends` holds the
    /// triangles of both views. The part `commands` receives the commands of the interpolated primitives.
    pub(crate) fn interpolating<'a>(
        &'a self,
        share: &'a Share,
        windows: &[Window],
        picture: Picture,
        [ends, commands]: [MemoryPart; 2],
    ) -> Option<StripInterpolation<'a>> {
        let between = self.between.as_ref()?;
        let [from, to] = between.ends.views.as_ref() else { return None };
        Some(StripInterpolation {
            share,
            views: [from, to],
            between: &between.view,
            part_of_way: between.part,
            in_eye_space: between.interpolation == Interpolation::View,
            near: near(windows),
            picture,
            ends,
            commands,
        })
    }

    pub(crate) fn background(&self) -> [u8; 3] {
        self.list.background
    }
}

/// Returns the range of lines near the windows, as two distances from the frame's top in subpixels. A triangle outside
/// this range cannot touch the windows at any time of the field.
fn near(windows: &[Window]) -> [i32; 2] {
    let [top, bottom] = span(windows);
    [top - CURVED, bottom + CURVED]
}

/// Returns the distance of the highest window's top from the frame's top, and the distance of the lowest window's
/// bottom, in subpixels.
fn span(windows: &[Window]) -> [i32; 2] {
    let top = windows.iter().map(|w| w.lines[0] * SUBPIXELS).min().unwrap_or_default();
    let bottom = windows.iter().map(|w| w.lines[1] * SUBPIXELS).max().unwrap_or_default() + SUBPIXELS;
    [top, bottom]
}

/// Returns true if a triangle stays outside a range of lines during the whole field. `top` and `bottom` are the limits
/// of the range, as distances from the frame's top.
fn is_outside_lines(ends: &TriangleEnds, [top, bottom]: [i32; 2]) -> bool {
    let [least, greatest] = ends.y_range();
    least > bottom || greatest < top
}

/// Calls `sink` with the command of a triangle, if the triangle touches the window.
fn sink_if_met(
    triangle: ScreenTriangle<VertexColours>,
    window: &Window,
    viewport: &Viewport,
    sink: &mut impl FnMut(Command),
) {
    if triangle.outline.meets(window.across, window.lines) {
        let shaded = triangle.gouraud(viewport, &mut SetupStats::default());
        sink(Command::Triangle(TriangleCommand { edges: shaded.edges, depth: shaded.z, colour: shaded.rgb }));
    }
}

/// Numbers of the primitives that touch windows: a count for each window, and a count over all windows.
struct WindowCounts<'a> {
    windows: &'a [Window],
    /// Distance of the highest window's top from the frame's top, and distance of the lowest window's bottom, in
    /// subpixels.
    span: [i32; 2],
    each: Vec<PrimitiveCounts>,
    any: PrimitiveCounts,
}

impl<'a> WindowCounts<'a> {
    fn new(windows: &'a [Window]) -> Self {
        Self {
            windows,
            span: span(windows),
            each: vec![PrimitiveCounts::default(); windows.len()],
            any: PrimitiveCounts::default(),
        }
    }

    fn add_outline(&mut self, outline: &Outline) {
        let [top, bottom] = self.span;
        if outline.y.iter().all(|y| *y < top) || outline.y.iter().all(|y| *y > bottom) {
            return;
        }
        let mut met = false;
        for (window, counts) in self.windows.iter().zip(&mut self.each) {
            if outline.meets(window.across, window.lines) {
                counts.triangles += 1;
                met = true;
            }
        }
        self.any.triangles += u32::from(met);
    }

    fn add_sphere(&mut self, sphere: &ScreenSphere) {
        let mut met = false;
        for (window, counts) in self.windows.iter().zip(&mut self.each) {
            if sphere.meets(window.across, window.lines) {
                counts.spheres += 1;
                met = true;
            }
        }
        self.any.spheres += u32::from(met);
    }
}

/// Returns the view at position `s` between two views. The function interpolates all elements of the matrices linearly.
///
/// Positions in eye space then move on straight lines: (M0 p) (1 - s) + (M1 p) s = (M0 (1 - s) + M1 s) p.
pub(crate) fn interpolated(from: &FrameView, to: &FrameView, s: f64) -> FrameView {
    let eyes = from.eyes.iter().zip(&to.eyes).map(|(a, b)| EyeView {
        world_to_eye: matrix_between(&a.world_to_eye, &b.world_to_eye, s),
        head_to_eye: matrix_between(&a.head_to_eye, &b.head_to_eye, s),
        projection: a.projection,
    });
    let edits = from
        .edits
        .iter()
        .zip(&to.edits)
        .map(|(a, b)| ModelEdit { structure: a.structure, model: matrix_between(&a.model, &b.model, s) });
    FrameView { number: from.number, eyes: eyes.collect(), edits: edits.collect() }
}

/// Interpolates the elements of two matrices: `s` is 0 at `from` and 1 at `to`.
fn matrix_between(from: &Mat4, to: &Mat4, s: f64) -> Mat4 {
    ((from.as_dmat4() * (1.0 - s)) + (to.as_dmat4() * s)).as_mat4()
}
