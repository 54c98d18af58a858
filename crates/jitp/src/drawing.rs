//! A display list as it is seen at one moment, or between two.

use crate::config::Reading;
use glam::Mat4;
use pphigs::{Counts, DisplayList, EyeView, FrameView, ModelEdit, Placed, gouraud_sphere, place_all};
use pxpl5_geometry::{LitColours, Outline, ScreenSphere, ScreenTriangle, SetupStats, TriangleEnds, Viewport};
use pxpl5_renderer::{Command, Triangle};
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Subpixels of a pixel, the unit of outlines.
const SUBPIXELS: i32 = 1 << pxpl5_wire::format::SUBPIXEL_BITS;

/// How far a corner that is interpolated in the view may leave the straight way on the screen, in subpixels: a turn by
/// 10 degrees in a field, far above the peak of a head, makes 5 pixels.
const CURVED: i32 = 8 * SUBPIXELS;

/// A rectangle of pixels: first and last pixel across, first and last line of the frame down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) across: [i32; 2],
    pub(crate) lines: [i32; 2],
}

/// Everything that a strip or a batch of blocks is drawn from.
pub(crate) struct Drawing {
    list: Arc<DisplayList>,
    viewport: Viewport,
    placed: Vec<Placed>,
    /// The places at T0 and T1, the part of the way between, and which of the two readings holds.
    ends: Option<(Ends, f64, Reading)>,
    /// Made when first asked for; the strips of a conventional picture share them.
    outlines: OnceLock<Vec<Outline>>,
}

/// What a slave has transformed for the begin and the end of a field, or for one moment.
#[derive(Clone)]
pub(crate) struct Ends {
    pub(crate) views: Arc<[FrameView]>,
    triangles: Arc<[Vec<Option<TriangleEnds>>]>,
}

impl fmt::Debug for Drawing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Drawing").field("viewport", &self.viewport).finish_non_exhaustive()
    }
}

impl Ends {
    /// `views` holds one view, or those of the begin and of the end.
    pub(crate) fn new(list: &DisplayList, views: Vec<FrameView>, viewport: Viewport) -> Self {
        let triangles = match &views[..] {
            [from, to] => triangle_ends(list, from, to, viewport),
            _ => Vec::new(),
        };
        Self { triangles: triangles.into(), views: views.into() }
    }
}

/// The triangles of each structure in both views.
fn triangle_ends(
    list: &DisplayList,
    from: &FrameView,
    to: &FrameView,
    viewport: Viewport,
) -> Vec<Vec<Option<TriangleEnds>>> {
    let placed = place_all(list, from, 0, viewport).into_iter().zip(place_all(list, to, 0, viewport));
    let of_structure = |(from, to): (Placed, Placed)| {
        let numbers = from.structure.triangles.clone();
        let ends = |number| from.transform.as_ref()?.ends(to.transform.as_ref()?, &list.corners(number));
        numbers.map(ends).collect()
    };
    placed.map(of_structure).collect()
}

impl Drawing {
    /// As one view shows it.
    pub(crate) fn of(list: &Arc<DisplayList>, view: &FrameView, viewport: Viewport) -> Self {
        let placed = place_all(list, view, 0, viewport);
        Self { list: Arc::clone(list), viewport, placed, ends: None, outlines: OnceLock::new() }
    }

    /// At the part `s` of the way between two views.
    pub(crate) fn between(list: &Arc<DisplayList>, ends: &Ends, s: f64, reading: Reading, viewport: Viewport) -> Self {
        let view = interpolated(&ends.views[0], &ends.views[1], s);
        Self { ends: Some((ends.clone(), s, reading)), ..Self::of(list, &view, viewport) }
    }

    /// How many primitives meet each window, and how many meet any.
    pub(crate) fn count(&self, windows: &[Window]) -> (Vec<Counts>, Counts) {
        let (mut each, mut any) = (vec![Counts::default(); windows.len()], Counts::default());
        let lines = |end: usize| windows.iter().map(move |w| w.lines[end] * SUBPIXELS);
        let span = [lines(0).min().unwrap_or_default(), lines(1).max().unwrap_or_default() + SUBPIXELS];
        let mut tally_outline = |outline: &Outline| {
            if outline.y.iter().all(|y| *y < span[0]) || outline.y.iter().all(|y| *y > span[1]) {
                return;
            }
            let meets = |w: &Window| outline.meets(w.across, w.lines);
            any.triangles += u32::from(tally(windows, &mut each, &meets, |counts| &mut counts.triangles));
        };
        if self.ends.is_some() {
            self.each_outline([span[0] - CURVED, span[1] + CURVED], tally_outline);
        } else {
            self.outlines.get_or_init(|| self.make_outlines()).iter().for_each(&mut tally_outline);
        }
        self.spheres(|sphere, _| {
            let meets = |w: &Window| sphere.meets(w.across, w.lines);
            any.spheres += u32::from(tally(windows, &mut each, &meets, |counts| &mut counts.spheres));
        });
        (each, any)
    }

    fn make_outlines(&self) -> Vec<Outline> {
        let mut all = Vec::new();
        self.each_outline([i32::MIN, i32::MAX], |outline| all.push(*outline));
        all
    }

    /// Calls `sink` for each screen triangle, but for some that cannot be between two distances from the frame's top.
    fn each_outline(&self, [top, bottom]: [i32; 2], mut sink: impl FnMut(&Outline)) {
        let mut stats = SetupStats::default();
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for (k, number) in place.structure.triangles.clone().enumerate() {
                match self.ends_of(i, k) {
                    Some((ends, ..)) if ends.y_range()[0] > bottom || ends.y_range()[1] < top => {}
                    Some((ends, s, Reading::Screen)) => transform.outline_between(ends, s, &mut stats, &mut sink),
                    _ => transform.outlines(&self.list.corners(number), &mut stats, &mut sink),
                }
            }
        }
    }

    /// The ends of a structure's k-th triangle, where it has a place on the screen at both.
    fn ends_of(&self, structure: usize, k: usize) -> Option<(&TriangleEnds, f64, Reading)> {
        let (ends, s, reading) = self.ends.as_ref()?;
        Some((ends.triangles.get(structure)?.get(k)?.as_ref()?, *s, *reading))
    }

    fn spheres(&self, mut sink: impl FnMut(&ScreenSphere, &Placed)) {
        let mut stats = SetupStats::default();
        for place in &self.placed {
            let Some(transform) = &place.transform else { continue };
            let seen =
                place.structure.spheres.clone().filter_map(|i| transform.sphere(&self.list.spheres[i], &mut stats));
            seen.collect::<Vec<_>>().iter().for_each(|sphere| sink(sphere, place));
        }
    }

    /// Calls `sink` with the command of each triangle that meets a window, in order.
    pub(crate) fn triangle_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        let mut stats = SetupStats::default();
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for (k, number) in place.structure.triangles.clone().enumerate() {
                let (triangle, mut setup) = (self.list.triangle(number), SetupStats::default());
                let hand_over = |t: ScreenTriangle<LitColours>| {
                    if t.outline.meets(window.across, window.lines) {
                        let t = t.gouraud(&self.viewport, &mut setup);
                        sink(Command::Triangle(Triangle { edges: t.edges, depth: t.z, colour: t.rgb }));
                    }
                };
                match self.ends_of(i, k) {
                    Some((ends, s, Reading::Screen)) => {
                        transform.gouraud_between(ends, s, &triangle, &place.light, &mut stats, hand_over);
                    }
                    _ => transform.gouraud(&triangle, &place.light, &mut stats, hand_over),
                }
            }
        }
    }

    /// Calls `sink` with the command of each sphere that meets a window, in order.
    pub(crate) fn sphere_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        self.spheres(|sphere, place| {
            if sphere.meets(window.across, window.lines) {
                sink(gouraud_sphere(&sphere.gouraud(&self.viewport, &place.light, &mut SetupStats::default())));
            }
        });
    }

    pub(crate) fn background(&self) -> [u8; 3] {
        self.list.background
    }
}

fn tally(
    windows: &[Window],
    each: &mut [Counts],
    meets: &dyn Fn(&Window) -> bool,
    field: impl Fn(&mut Counts) -> &mut u32,
) -> bool {
    let mut any = false;
    for (window, counts) in windows.iter().zip(each) {
        if meets(window) {
            *field(counts) += 1;
            any = true;
        }
    }
    any
}

/// Positions in the view lie on straight lines between two views where the matrices do:
/// (M0 p) (1 - s) + (M1 p) s = (M0 (1 - s) + M1 s) p.
fn interpolated(from: &FrameView, to: &FrameView, s: f64) -> FrameView {
    let mix = |a: &Mat4, b: &Mat4| ((a.as_dmat4() * (1.0 - s)) + (b.as_dmat4() * s)).as_mat4();
    let eye = |(a, b): (&EyeView, &EyeView)| EyeView {
        world_to_eye: mix(&a.world_to_eye, &b.world_to_eye),
        head_to_eye: mix(&a.head_to_eye, &b.head_to_eye),
        projection: a.projection,
    };
    let edit = |(a, b): (&ModelEdit, &ModelEdit)| ModelEdit { structure: a.structure, model: mix(&a.model, &b.model) };
    FrameView {
        number: from.number,
        eyes: from.eyes.iter().zip(&to.eyes).map(eye).collect(),
        edits: from.edits.iter().zip(&to.edits).map(edit).collect(),
    }
}
