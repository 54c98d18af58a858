//! A display list as it is seen at one moment, or between two.

use crate::config::Reading;
use glam::Mat4;
use pphigs::{Counts, DisplayList, EyeView, FrameView, ModelEdit, Placed, gouraud_sphere, place_all};
use pxpl5_geometry::{Outline, SetupStats, Viewport};
use pxpl5_renderer::{Command, Triangle};
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Subpixels of a pixel, the unit of outlines.
const SUBPIXELS: i32 = 1 << pxpl5_wire::format::SUBPIXEL_BITS;

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
    /// The transforms for T0 and T1 and the part of the way between, where places on the screen are interpolated.
    ends: Option<(Ends, f64)>,
    /// Made when first asked for; the strips of a conventional picture share them.
    outlines: OnceLock<Vec<Outline>>,
}

/// What a slave has transformed for the begin and the end of a field, or for one moment.
#[derive(Clone)]
pub(crate) struct Ends {
    pub(crate) views: Arc<[FrameView]>,
    placed: Arc<[Vec<Placed>; 2]>,
}

impl fmt::Debug for Drawing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Drawing").field("viewport", &self.viewport).finish_non_exhaustive()
    }
}

impl Ends {
    pub(crate) fn new(list: &DisplayList, views: Vec<FrameView>, viewport: Viewport) -> Self {
        let place = |view: Option<&FrameView>| view.map_or_else(Vec::new, |v| place_all(list, v, 0, viewport));
        let placed = Arc::new([place(views.first()), place(views.get(1))]);
        Self { views: views.into(), placed }
    }
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
        let ends = (reading == Reading::Screen).then(|| (ends.clone(), s));
        Self { ends, ..Self::of(list, &view, viewport) }
    }

    /// How many primitives meet each window, and how many meet any.
    pub(crate) fn count(&self, windows: &[Window]) -> (Vec<Counts>, Counts) {
        let (mut each, mut any) = (vec![Counts::default(); windows.len()], Counts::default());
        let lines = |end: usize| windows.iter().map(move |w| w.lines[end] * SUBPIXELS);
        let span = [lines(0).min().unwrap_or_default(), lines(1).max().unwrap_or_default() + SUBPIXELS];
        for outline in self.outlines.get_or_init(|| self.make_outlines()) {
            if outline.y.iter().all(|y| *y < span[0]) || outline.y.iter().all(|y| *y > span[1]) {
                continue;
            }
            let meets = |w: &Window| outline.meets(w.across, w.lines);
            any.triangles += u32::from(tally(windows, &mut each, &meets, |counts| &mut counts.triangles));
        }
        self.spheres(|sphere, _| {
            let meets = |w: &Window| sphere.meets(w.across, w.lines);
            any.spheres += u32::from(tally(windows, &mut each, &meets, |counts| &mut counts.spheres));
        });
        (each, any)
    }

    fn make_outlines(&self) -> Vec<Outline> {
        let (mut all, mut stats) = (Vec::new(), SetupStats::default());
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for number in place.structure.triangles.clone() {
                let corners = self.list.corners(number);
                let mut keep = |outline: &Outline| all.push(*outline);
                let on_screen = self
                    .on_screen(i)
                    .is_some_and(|(from, to, s)| from.outline_between(to, s, &corners, &mut stats, &mut keep));
                if !on_screen {
                    transform.outlines(&corners, &mut stats, keep);
                }
            }
        }
        all
    }

    /// The transforms of a structure at both ends, where places on the screen are interpolated.
    fn on_screen(&self, structure: usize) -> Option<(&pxpl5_geometry::Transform, &pxpl5_geometry::Transform, f64)> {
        let (ends, s) = self.ends.as_ref()?;
        let of = |end: usize| ends.placed[end].get(structure)?.transform.as_ref();
        Some((of(0)?, of(1)?, *s))
    }

    fn spheres(&self, mut sink: impl FnMut(&pxpl5_geometry::ScreenSphere, &Placed)) {
        let mut stats = SetupStats::default();
        for place in &self.placed {
            let Some(transform) = &place.transform else { continue };
            let seen = place.structure.spheres.clone().filter_map(|i| transform.sphere(&self.list.spheres[i], &mut stats));
            seen.collect::<Vec<_>>().iter().for_each(|sphere| sink(sphere, place));
        }
    }

    /// Calls `sink` with the command of each triangle that meets a window, in order.
    pub(crate) fn triangle_commands(&self, window: &Window, mut sink: impl FnMut(Command)) {
        let mut stats = SetupStats::default();
        for (i, place) in self.placed.iter().enumerate() {
            let Some(transform) = &place.transform else { continue };
            for number in place.structure.triangles.clone() {
                let (triangle, mut setup) = (self.list.triangle(number), SetupStats::default());
                let mut hand_over = |t: pxpl5_geometry::ScreenTriangle<pxpl5_geometry::LitColours>| {
                    if t.outline.meets(window.across, window.lines) {
                        let t = t.gouraud(&self.viewport, &mut setup);
                        sink(Command::Triangle(Triangle { edges: t.edges, depth: t.z, colour: t.rgb }));
                    }
                };
                let on_screen = self.on_screen(i).is_some_and(|(from, to, s)| {
                    from.gouraud_between(to, s, &triangle, &place.light, &mut stats, &mut hand_over)
                });
                if !on_screen {
                    transform.gouraud(&triangle, &place.light, &mut stats, hand_over);
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
