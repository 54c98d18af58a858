use super::plan::{Due, DuePolicy, Plan, Updates};
use address_recalculation::{CubeFace, FaceScan};
use pphigs::oracle::ideal_picture_of;
use pphigs::{DisplayList, FrameView};
use pxpl5_machine::HostLine;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{
    Body, MAX_MESSAGE_WORDS, PeriodNumber, PictureNumber, PixelSource, REGION_SIZE, RegionId, RegionPixels, Word,
};
use rendering_control::cube::{FaceUpdate, Faces, face_view};
use rendering_control::{Drawn, HostAction};
use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// Time before a retrace at which the ideal renderer requests views: one picosecond, the shortest time of the
/// simulation.
const BEFORE_RETRACE: Span = Span(1);

/// Source of ideal cube faces. At each retrace, the source writes the updates that a policy requests into the display
/// memories.
///
/// Views, policies, the widths of numbers in bits, and the messages to the display are the same as on the machine.
/// Drawing takes no time and sends no ring messages.
pub(super) struct IdealFaces {
    pub(super) plan: Plan,
    pub(super) faces: Arc<Faces>,
    pub(super) list: Arc<DisplayList>,
    pub(super) scan: FaceScan,
    pub(super) next: PictureNumber,
}

impl fmt::Debug for IdealFaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("IdealFaces").field("faces", &self.faces).field("next", &self.next).finish_non_exhaustive()
    }
}

impl HostLine for IdealFaces {
    fn next(&self, after: Time) -> Option<Time> {
        let field = self.scan.field_at(after + BEFORE_RETRACE);
        Some(before(&self.scan, field.next()))
    }

    fn messages(&mut self, now: Time) -> Vec<(usize, Body)> {
        let mut messages = Vec::new();
        while let HostAction::Send(update) = (self.plan)(self.next, now) {
            self.next = self.next.next();
            messages.extend(self.draw(update));
        }
        messages
    }
}

fn before(scan: &FaceScan, field: PeriodNumber) -> Time {
    Time(scan.retrace(field).0.saturating_sub(BEFORE_RETRACE.0))
}

impl IdealFaces {
    /// Draws the cube faces of an update and returns the messages to the display: an announcement, the regions, and the
    /// swap.
    fn draw(&self, update: FaceUpdate) -> Vec<(usize, Body)> {
        let port = usize::from(update.memory);
        let regions: Vec<RegionId> = (0..self.faces.regions()).map(RegionId).collect();
        let announcement = update.announcement(self.faces.face_texels(), &regions).map(Body::Words);
        let list = self.faces.warped.placed(&self.list, &update);
        let drawn = Arc::new(DrawnCube { list, update, surfaces: Arc::clone(&self.faces), faces: Default::default() });
        let parts = self.faces.content.words() * REGION_SIZE * REGION_SIZE / MAX_MESSAGE_WORDS;
        // Each region is a lazy pixel source, split into messages of the maximum size.
        let of_region = |region: RegionId| {
            let target = self.faces.target(&drawn.update, 0, region);
            let image: Arc<dyn PixelSource> = Arc::new(DrawnRegion { cube: Arc::clone(&drawn), region });
            (0..parts).map(move |part| Body::Pixels(RegionPixels { target, image: Arc::clone(&image), part, parts }))
        };
        // The display expects the announcement first and the request for a swap last.
        let [begin, swap] = announcement;
        let pixels = regions.iter().copied().flat_map(of_region);
        [begin].into_iter().chain(pixels).chain([swap]).map(|body| (port, body)).collect()
    }
}

pub(super) struct All {
    pub(super) structures: Arc<[bool]>,
}

impl DuePolicy for All {
    fn begin(&mut self, _: &Updates, _: PictureNumber, now: Time) -> VecDeque<Due> {
        [Due::newest(Arc::clone(&self.structures), now)].into()
    }
}

/// The cube faces of an update. A face is computed when one of its regions is first read.
#[derive(Debug)]
struct DrawnCube {
    list: Arc<DisplayList>,
    update: FaceUpdate,
    surfaces: Arc<Faces>,
    faces: [OnceLock<DrawnFace>; CubeFace::ALL.len()],
}

/// Colours (0x00RRGGBB) and depths (24 bits) of a cube face, row by row.
#[derive(Debug)]
struct DrawnFace {
    colours: Vec<Word>,
    depths: Vec<Word>,
}

impl DrawnCube {
    fn face(&self, number: usize) -> &DrawnFace {
        self.faces[number].get_or_init(|| {
            let FaceUpdate { view, structures, .. } = &self.update;
            let eyes = view.eyes.iter().map(|ahead| face_view(ahead, CubeFace::ALL[number])).collect();
            let view = FrameView { eyes, ..view.clone() };
            let is_held = |structure: usize| structures.get(structure) == Some(&true);
            let ideal = ideal_picture_of(&self.list, is_held, &view, 0, &self.surfaces.picture);
            let colours = ideal.image().pixels().map(|pixel| {
                let [red, green, blue] = pixel.0;
                Word::from_be_bytes([0, red, green, blue])
            });
            DrawnFace { colours: colours.collect(), depths: ideal.depths().to_vec() }
        })
    }
}

#[derive(Debug)]
struct DrawnRegion {
    cube: Arc<DrawnCube>,
    region: RegionId,
}

impl PixelSource for DrawnRegion {
    fn pixels(&self) -> Arc<[Word]> {
        let surfaces = &self.cube.surfaces;
        let (face, region) = surfaces.on_view(self.region);
        let [left, top, width, height] = surfaces.picture.viewport.grid().rectangle(region).map(|v| v as usize);
        let face = self.cube.face(face);
        let across = surfaces.face_texels() as usize;
        let cut = |all: &[Word]| -> Vec<Word> {
            let row = |y: usize| y * across + left..y * across + left + width;
            (top..top + height).flat_map(|y| all[row(y)].iter().copied()).collect()
        };
        surfaces.content.of(cut(&face.colours).into(), || cut(&face.depths))
    }
}
