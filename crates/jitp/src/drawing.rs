//! The primitives of a display list for one view, or interpolated between two views.

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

const SUBPIXELS: i32 = 1 << pxpl5_wire::format::SUBPIXEL_BITS;

/// Largest deviation, in subpixels, of a triangle's corner from a straight path on the screen. The path is curved if
/// positions are interpolated in eye space.
///
/// The limit is 8 pixels. A head that turns by 10 degrees during a field causes a deviation of 5 pixels, and real heads
/// do not turn so fast.
const CURVED: i32 = 8 * SUBPIXELS;

/// A rectangle of pixels: first and last column, first and last line of the video frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) across: [i32; 2],
    pub(crate) lines: [i32; 2],
}

/// A display list that is ready to be drawn for a strip of lines or a batch of blocks.
pub(crate) struct DrawnList {
    list: Arc<DisplayList>,
    viewport: Viewport,
    placed: Vec<PlacedStructure>,
    /// Data for the interpolation between two views. `None` for one view.
    between: Option<Between>,
    /// Triangles on the screen. If a field has one view, all strips share these triangles.
    outlines: OnceLock<Vec<Outline>>,
}

/// Two views, and the instant between them for which a display list is drawn.
struct Between {
    ends: Ends,
    /// The instant, from 0 (first view) to 1 (second view).
    part: f64,
    interpolation: Interpolation,
    /// The view at this instant.
    view: FrameView,
}

/// A transformed display list: for one view, or for the views at the start and at the end of a field.
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
    pub(crate) fn new(list: &DisplayList, views: Vec<FrameView>, viewport: Viewport) -> Self {
        let triangles = match &views[..] {
            [from, to] => triangle_ends(list, from, to, viewport),
            _ => Vec::new(),
        };
        Self { triangles: triangles.into(), views: views.into() }
    }
}

fn triangle_ends(
    list: &DisplayList,
    from: &FrameView,
    to: &FrameView,
    viewport: Viewport,
) -> Vec<Vec<Option<TriangleEnds>>> {
    let placed = place_all(list, from, 0, viewport).into_iter().zip(place_all(list, to, 0, viewport));
    placed.map(|(from, to)| structure_ends(list, &from, &to)).collect()
}

/// Returns the corners of a structure's triangles on the screen, in the views `from` and `to`. The entry of a triangle
/// is `None` if one of the views has no screen position for the triangle.
fn structure_ends(list: &DisplayList, from: &PlacedStructure, to: &PlacedStructure) -> Vec<Option<TriangleEnds>> {
    let numbers = from.structure.triangles.clone();
    numbers.map(|number| from.transform.as_ref()?.ends(to.transform.as_ref()?, &list.corners(number))).collect()
}

impl DrawnList {
    pub(crate) fn from_view(list: &Arc<DisplayList>, view: &FrameView, viewport: Viewport) -> Self {
        let placed = place_all(list, view, 0, viewport);
        Self { list: Arc::clone(list), viewport, placed, between: None, outlines: OnceLock::new() }
    }

    /// Prepares the display list for an instant between the two views of `ends`: 0 at the first view, 1 at the second
    /// view.
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

    /// Returns the number of primitives in each window, and the number of primitives in at least one window.
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

    /// Calls `sink` for each triangle on the screen that may touch the lines of the range `near`.
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

    /// Returns the data to interpolate triangle `k` of a structure: corners in both views, instant from 0 to 1, and
    /// kind of interpolation. Returns `None` if the triangle is not interpolated.
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

    /// Calls `sink` with the command of each triangle in the window, in the order of the display list. The number of
    /// commands equals the result of [`Self::count`] for this window.
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

    pub(crate) fn sphere_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        self.spheres(|sphere, place| {
            if sphere.meets(window.across, window.lines) {
                sink(gouraud_sphere(&sphere.gouraud(&self.viewport, &place.light, &mut SetupStats::default())));
            }
        });
    }

    /// Returns the work of interpolating the primitives near `windows`, or `None` if there is only one view.
    ///
    /// The i860 code reads the triangles of both views from the part `ends` of the board's memory, and writes commands
    /// to the part `commands`.
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

/// Returns a range of lines, in subpixels from the top of the video frame. Triangles outside this range cannot touch
/// the windows at any time of the field.
fn near(windows: &[Window]) -> [i32; 2] {
    let [top, bottom] = span(windows);
    [top - CURVED, bottom + CURVED]
}

/// Returns the top of the highest window and the bottom of the lowest window, in subpixels from the top of the video
/// frame.
fn span(windows: &[Window]) -> [i32; 2] {
    let top = windows.iter().map(|w| w.lines[0] * SUBPIXELS).min().unwrap_or_default();
    let bottom = windows.iter().map(|w| w.lines[1] * SUBPIXELS).max().unwrap_or_default() + SUBPIXELS;
    [top, bottom]
}

/// Returns true if a triangle stays outside the lines `top` to `bottom` during the whole field.
fn is_outside_lines(ends: &TriangleEnds, [top, bottom]: [i32; 2]) -> bool {
    let [least, greatest] = ends.y_range();
    least > bottom || greatest < top
}

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

/// Number of primitives in each window, and number of primitives in at least one window.
struct WindowCounts<'a> {
    windows: &'a [Window],
    /// Top of the highest window and bottom of the lowest window, in subpixels from the top of the video frame.
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

/// Returns the view between two views, by linear interpolation of the matrices: `s` is 0 at `from` and 1 at `to`.
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

fn matrix_between(from: &Mat4, to: &Mat4, s: f64) -> Mat4 {
    ((from.as_dmat4() * (1.0 - s)) + (to.as_dmat4() * s)).as_mat4()
}
