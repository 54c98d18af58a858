//! Messages with renderer commands. The kinds of a message's commands are known from the start, but the words of the
//! commands are computed only when the words are read.

use crate::list::{DisplayList, PrimitiveCounts};
use crate::pass::{BinEntry, Encoder, Pass};
use crate::picture::Shading;
use crate::placed::PlacedStructure;
use pxpl5_geometry::{
    GouraudSphere, GouraudTriangle, LANES, Light, PhongSphere, PhongTriangle, SetupStats, SphereSetup, SurfaceVertex,
    Transform, TriangleLanes,
};
use pxpl5_renderer::{
    Clear, Command, CommandKind, CopyRegion, Layout, PhongSphereCommand, PhongTriangleCommand, PhongTriangleEncoder,
    SelectRegion, Shade, SphereBody, SphereCommand, TriangleCommand, TriangleEncoder,
};
use pxpl5_wire::{
    CommandContent, CommandList, CommandRun, CommandSink, CommandWords, CopyOrder, Linear, MAX_MESSAGE_WORDS, RegionId,
    RegionPlace, Word,
};
use std::ops::Range;
use std::sync::Arc;

/// The commands before and after a region's primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionEnvelope {
    /// True if the commands first select and clear the memory of the region.
    pub begin: bool,
    /// True if the renderer computes the colours of all pixels at the end. Only pictures with Phong shading have a
    /// command for this step.
    pub shade: bool,
    /// Copy of the region to the frame buffer after its primitives, or `None` if the region is not copied.
    pub copy: Option<CopyOrder>,
}

/// Returns the messages with the primitives of a region's bin and with the commands that `envelope` selects.
///
/// The number of messages is as small as their maximum length permits.
pub fn region_messages(pass: &Arc<Pass>, region: RegionId, context: u8, envelope: RegionEnvelope) -> Vec<CommandList> {
    if pass.counts(region).total() == 0 && !envelope.begin && pass.ending_words(envelope) == 0 {
        return Vec::new();
    }
    let parts = (0..).zip(Parts::new(pass, region, envelope));
    let words = || Arc::new(RegionWords { pass: Arc::clone(pass), region, context, envelope }) as Arc<dyn CommandWords>;
    let words = pass.picture().pixels.then(words);
    let list = |(number, part): (u32, RegionPart)| CommandList {
        runs: part.runs(pass, envelope),
        context,
        copies: envelope.copy.into_iter().filter(|_| part.ends).collect(),
        content: words.as_ref().map(|words| CommandContent::new(Arc::clone(words), number)),
    };
    parts.map(list).collect()
}

/// Returns a message that copies regions to a frame buffer, without drawing.
pub fn copy_message(layout: Layout, copies: Vec<CopyOrder>, pixels: bool) -> CommandList {
    let runs =
        copies.iter().flat_map(|_| [run(CommandKind::SelectRegion, 1), run(CommandKind::CopyRegion, 1)]).collect();
    let context = copies.first().map_or(0, |order| order.context);
    let content = pixels.then(|| CommandContent::new(Arc::new(CopyWords { layout, copies: copies.clone() }), 0));
    CommandList { runs, context, copies, content }
}

const fn run(kind: CommandKind, count: u32) -> CommandRun {
    CommandRun { opcode: kind.opcode(), words_each: kind.words(), count }
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct RegionPart {
    select: bool,
    clear: bool,
    triangles: Range<u32>,
    spheres: Range<u32>,
    ends: bool,
}

/// The messages of a region: first all triangles, then all spheres.
struct Parts {
    triangles: Range<u32>,
    spheres: Range<u32>,
    words_each: [u32; 2],
    /// True if every message must select the region, because pixel memory holds several regions.
    selects: bool,
    clears_next: bool,
    ending_words: u32,
    has_ended: bool,
}

impl Parts {
    fn new(pass: &Pass, region: RegionId, envelope: RegionEnvelope) -> Self {
        let PrimitiveCounts { triangles, spheres } = pass.counts(region);
        Self {
            triangles: 0..triangles,
            spheres: 0..spheres,
            words_each: [pass.triangle_kind(), pass.sphere_kind()].map(CommandKind::words),
            selects: pass.picture().layout.plan().contexts > 1,
            clears_next: envelope.begin,
            ending_words: pass.ending_words(envelope),
            has_ended: false,
        }
    }
}

impl Parts {
    /// Returns message `number`. All messages between the first and the last message with triangles have the same
    /// length and are skipped in one step.
    fn skip_to(mut self, number: u32) -> Option<RegionPart> {
        if number == 0 {
            return self.next();
        }
        self.next()?;
        let select_words = CommandKind::SelectRegion.words() * u32::from(self.selects);
        let full = (MAX_MESSAGE_WORDS - select_words) / self.words_each[0];
        let skipped = (number - 1).min((self.triangles.len() as u32).saturating_sub(1) / full);
        self.triangles.start += skipped * full;
        self.nth((number - 1 - skipped) as usize)
    }
}

impl Iterator for Parts {
    type Item = RegionPart;

    /// Returns the next message, or `None` if that message would only select the region.
    fn next(&mut self) -> Option<RegionPart> {
        if self.has_ended {
            return None;
        }
        let clear = std::mem::take(&mut self.clears_next);
        let select = clear || self.selects;
        // Fill the message with as many primitives as fit. Spheres follow only after the last triangle.
        let mut room_words = MAX_MESSAGE_WORDS
            - CommandKind::SelectRegion.words() * u32::from(select)
            - CommandKind::Clear.words() * u32::from(clear);
        let triangles = take_run(&mut self.triangles, self.words_each[0], &mut room_words);
        let spheres = if self.triangles.is_empty() {
            take_run(&mut self.spheres, self.words_each[1], &mut room_words)
        } else {
            0..0
        };
        let holds_all = self.triangles.is_empty() && self.spheres.is_empty();
        self.has_ended = holds_all && self.ending_words <= room_words;
        let ends = self.has_ended;
        let says_something = clear || !triangles.is_empty() || !spheres.is_empty() || (ends && self.ending_words > 0);
        says_something.then_some(RegionPart { select, clear, triangles, spheres, ends })
    }
}

/// Takes the first primitives of `remaining`: as many commands of `words_each` words as fit into `room_words`.
fn take_run(remaining: &mut Range<u32>, words_each: u32, room_words: &mut u32) -> Range<u32> {
    let end = remaining.start + (remaining.end - remaining.start).min(*room_words / words_each);
    let taken = std::mem::replace(&mut remaining.start, end)..end;
    *room_words -= (taken.end - taken.start) * words_each;
    taken
}

impl RegionPart {
    fn runs(&self, pass: &Pass, envelope: RegionEnvelope) -> Vec<CommandRun> {
        let all = [
            (CommandKind::SelectRegion, u32::from(self.select)),
            (CommandKind::Clear, u32::from(self.clear)),
            (pass.triangle_kind(), self.triangles.len() as u32),
            (pass.sphere_kind(), self.spheres.len() as u32),
            (CommandKind::Shade, u32::from(self.ends && pass.shades(envelope))),
            (CommandKind::CopyRegion, u32::from(self.ends && envelope.copy.is_some())),
        ];
        all.into_iter().filter(|(_, count)| *count > 0).map(|(kind, count)| run(kind, count)).collect()
    }
}

impl Pass {
    pub(crate) const fn triangle_kind(&self) -> CommandKind {
        match self.picture().shading {
            Shading::Gouraud | Shading::Precomputed => CommandKind::Triangle,
            Shading::Phong => CommandKind::PhongTriangle,
        }
    }

    pub(crate) const fn sphere_kind(&self) -> CommandKind {
        match self.picture().shading {
            Shading::Gouraud | Shading::Precomputed => CommandKind::Sphere,
            Shading::Phong => CommandKind::PhongSphere,
        }
    }

    fn shades(&self, envelope: RegionEnvelope) -> bool {
        envelope.shade && self.picture().shading == Shading::Phong
    }

    fn ending_words(&self, envelope: RegionEnvelope) -> u32 {
        CommandKind::Shade.words() * u32::from(self.shades(envelope))
            + CommandKind::CopyRegion.words() * u32::from(envelope.copy.is_some())
    }

    /// Returns the size of the commands of all primitives on the screen, in bytes. Each command is stored once, because
    /// bins hold pointers to commands (TR94).
    pub fn command_bytes(&self) -> u64 {
        let PrimitiveCounts { triangles, spheres } = self.screen_counts();
        bytes(self.triangle_kind(), triangles) + bytes(self.sphere_kind(), spheres)
    }
}

/// Size in bytes of one entry of a bin. An entry is a pointer, because each command is stored once for all regions
/// (TR94).
pub const BIN_ENTRY_BYTES: u64 = 4;

/// Bytes of a graphics processor's memory for program, stacks and message buffers. The number is the same in every
/// pipeline.
///
/// Assumed: no paper gives the number. Each graphics processor of TR94 has 8 MB, so an error of a megabyte has little
/// effect.
pub const PROGRAM_BYTES: u64 = 1 << 20;

fn bytes(kind: CommandKind, count: u32) -> u64 {
    4 * u64::from(kind.words()) * u64::from(count)
}

/// The words of a region's messages, which are computed only when a message is read.
#[derive(Debug)]
struct RegionWords {
    pass: Arc<Pass>,
    region: RegionId,
    context: u8,
    envelope: RegionEnvelope,
}

impl CommandWords for RegionWords {
    fn append_words(&self, part: u32, out: &mut Vec<Word>) {
        let part = self.part(part);
        self.append_with(&part, self.pass.triangles_in(self.region, &part.triangles), out);
    }

    fn append_visible(&self, part: u32, out: &mut dyn CommandSink) -> bool {
        let part = self.part(part);
        let triangles = self.pass.triangles_touching(self.region, &part.triangles);
        let draws = !triangles.is_empty() || !part.spheres.is_empty();
        if draws || part.clear || (part.ends && self.pass.ending_words(self.envelope) > 0) {
            self.append_with(&part, &triangles, out);
        }
        draws
    }

    fn place(&self) -> Option<RegionPlace> {
        let viewport = &self.pass.picture().viewport;
        Some(RegionPlace { frame_buffer: None, lines: viewport.lines(), grid: viewport.grid(), region: self.region })
    }
}

impl RegionWords {
    /// Returns the content of message `number`, which is empty if the message does not exist.
    fn part(&self, number: u32) -> RegionPart {
        Parts::new(&self.pass, self.region, self.envelope).skip_to(number).unwrap_or_default()
    }

    /// Appends all commands of a message. `triangles` may be fewer than the triangles of the message.
    fn append_with(&self, part: &RegionPart, triangles: &[BinEntry], out: &mut dyn CommandSink) {
        let picture = self.pass.picture();
        // Start of the region: context and clear.
        if part.select {
            let [left, top, _, _] = picture.viewport.grid().rectangle(self.region);
            let select = SelectRegion { context: self.context, left: left as u16, top: top as u16 };
            append(&Command::SelectRegion(select), &picture.layout, out.words());
        }
        if part.clear {
            append(&Command::Clear(Clear { colour: rgb(self.pass.background()) }), &picture.layout, out.words());
        }
        // Primitives of the region.
        self.triangles(triangles, out);
        self.spheres(&part.spheres, out.words());
        // End of the region: shading and copy.
        if part.ends && self.pass.shades(self.envelope) {
            append(
                &Command::Shade(shade(self.pass.light(), self.pass.share().list().is_matte)),
                &picture.layout,
                out.words(),
            );
        }
        if let Some(order) = self.envelope.copy.filter(|_| part.ends) {
            append(&Command::CopyRegion(CopyRegion { target: order.target }), &picture.layout, out.words());
        }
    }

    fn triangles(&self, mut entries: &[BinEntry], out: &mut dyn CommandSink) {
        for (place, transform) in self.pass.drawn() {
            let end = place.structure.triangles.end;
            let (here, rest) = entries.split_at(entries.partition_point(|entry| (entry.triangle as usize) < end));
            entries = rest;
            match self.pass.encoder() {
                _ if here.is_empty() => {}
                Some(Encoder::Gouraud(encoder)) => self.gouraud(here, place, transform, encoder, out),
                Some(Encoder::Phong(encoder)) => self.phong(here, place, transform, encoder, out),
                None => {}
            }
        }
    }

    fn gouraud(
        &self,
        entries: &[BinEntry],
        place: &PlacedStructure,
        transform: &Transform,
        encoder: &TriangleEncoder,
        out: &mut dyn CommandSink,
    ) {
        let list = self.pass.share().list();
        let picture = self.pass.picture();
        let mut stats = SetupStats::default();
        if transform.is_single() {
            for entry in entries {
                let triangle = list.triangle(entry.triangle as usize);
                let of_piece = pick(entry, |sink| {
                    transform.single_precision(&triangle, &mut stats, |_, expressions| sink(expressions));
                });
                encoder.encode(&of_piece.map_or(NOWHERE, gouraud_triangle), out.words());
            }
            return;
        }
        let light = place.light_of_corners(picture.shading);
        let vertices = place.vertices(list, transform);
        let mut batches = SetupBatches {
            entries,
            list,
            first: vertices.first,
            vertices: vertices.colours(list, transform, picture.shading, light),
            lanes: TriangleLanes::default(),
        };
        while let Some(some) = batches.next() {
            match some {
                SetupBatch::Unclipped(entries, lanes) => {
                    let expressions = transform.gouraud_lanes(lanes, &mut stats);
                    // If the sink accepts batches, it needs no words.
                    if !out.triangles(&expressions.batch(entries.len())) {
                        let words = out.words();
                        (0..entries.len()).for_each(|i| encoder.encode(&gouraud_triangle(expressions.get(i)), words));
                    }
                }
                // A clipped triangle is clipped again to find its piece.
                SetupBatch::Clipped(entry) => {
                    let triangle = list.triangle(entry.triangle as usize);
                    let piece = pick(entry, |sink| transform.gouraud(&triangle, light, &mut stats, sink));
                    let piece = piece.map(|piece| piece.gouraud(&picture.viewport, &mut stats));
                    encoder.encode(&piece.map_or(NOWHERE, gouraud_triangle), out.words());
                }
            }
        }
    }

    fn phong(
        &self,
        entries: &[BinEntry],
        place: &PlacedStructure,
        transform: &Transform,
        encoder: &PhongTriangleEncoder,
        out: &mut dyn CommandSink,
    ) {
        let list = self.pass.share().list();
        let picture = self.pass.picture();
        let mut stats = SetupStats::default();
        let vertices = place.vertices(list, transform);
        let mut batches = SetupBatches {
            entries,
            list,
            first: vertices.first,
            vertices: vertices.normals(list, transform),
            lanes: TriangleLanes::default(),
        };
        while let Some(some) = batches.next() {
            match some {
                SetupBatch::Unclipped(entries, lanes) => {
                    let expressions = transform.phong_lanes(lanes, &mut stats);
                    let colour = |entry: &BinEntry| list.colours[list.triangles[entry.triangle as usize][0] as usize];
                    let mut colours = [0; LANES];
                    colours.iter_mut().zip(entries).for_each(|(out, entry)| *out = rgb(colour(entry)));
                    // If the sink accepts batches, it needs no words.
                    if !out.triangles(&expressions.batch(entries.len(), colours)) {
                        let words = out.words();
                        for (i, entry) in entries.iter().enumerate() {
                            encoder.encode(&phong_triangle(expressions.get(i, colour(entry))), words);
                        }
                    }
                }
                // A clipped triangle is clipped again to find its piece.
                SetupBatch::Clipped(entry) => {
                    let triangle = list.triangle(entry.triangle as usize);
                    let piece = pick(entry, |sink| transform.phong(&triangle, &mut stats, sink));
                    let piece = piece.map(|piece| piece.phong(&picture.viewport, &mut stats));
                    encoder.encode(&piece.map_or(PHONG_NOWHERE, phong_triangle), out.words());
                }
            }
        }
    }

    fn spheres(&self, spheres: &Range<u32>, out: &mut Vec<Word>) {
        if spheres.is_empty() {
            return;
        }
        let range = spheres.start as usize..spheres.end as usize;
        let mut numbers = &self.pass.bin(self.region).spheres[range];
        let picture = self.pass.picture();
        let list = self.pass.share().list();
        let mut stats = SetupStats::default();
        for (place, transform) in self.pass.drawn() {
            // Spheres are sorted by number, so a structure's spheres are consecutive.
            let end = place.structure.spheres.end;
            let (here, rest) = numbers.split_at(numbers.partition_point(|number| (*number as usize) < end));
            numbers = rest;
            for number in here {
                let Some(sphere) = transform.sphere(&list.spheres[*number as usize], &mut stats) else { continue };
                let command = match picture.shading {
                    Shading::Gouraud | Shading::Precomputed => {
                        gouraud_sphere(&sphere.gouraud(&picture.viewport, &place.light, &mut stats))
                    }
                    Shading::Phong => phong_sphere(&sphere.phong(&picture.viewport, &mut stats)),
                };
                append(&command, &picture.layout, out);
            }
        }
    }
}

/// Appends the words of a command. Encoding cannot fail, because the machine's configuration refuses a layout of pixel
/// memory that lacks a bit field of the commands.
fn append(command: &Command, layout: &Layout, out: &mut Vec<Word>) {
    let encoded = command.encode(layout, out);
    debug_assert!(encoded.is_ok(), "{encoded:?}");
}

/// Converts light and highlight to the number formats of the shading command, for an eye that looks along -z.
///
/// Without a light all intensities are zero. Matte surfaces have no highlight.
pub fn shade(light: Option<&Light>, is_matte: bool) -> Shade {
    let Some(light) = light else { return Shade::default() };
    let towards = light.direction;
    let half = unit([towards[0], towards[1], towards[2] + 1.0]);
    Shade {
        light: fixed_direction(towards),
        half: fixed_direction(half),
        ambient: fixed_part(light.ambient),
        diffuse: fixed_part(light.diffuse),
        specular: if is_matte { 0 } else { SPECULAR },
    }
}

/// Entries of a bin, in order, in batches of up to [`LANES`] triangles.
struct SetupBatches<'a> {
    entries: &'a [BinEntry],
    list: &'a DisplayList,
    /// The structure's vertices, with colours (Gouraud shading) or normals (Phong shading).
    vertices: &'a [SurfaceVertex],
    first: usize,
    lanes: TriangleLanes<'a>,
}

enum SetupBatch<'a> {
    /// Triangles whose edges and planes are computed together. A triangle without area takes the place of an invisible
    /// triangle.
    Unclipped(&'a [BinEntry], &'a TriangleLanes<'a>),
    Clipped(&'a BinEntry),
}

impl SetupBatches<'_> {
    fn next(&mut self) -> Option<SetupBatch<'_>> {
        self.lanes.clear();
        for entry in self.entries.iter().take(LANES) {
            if entry.piece.is_none() {
                self.lanes.push_nothing();
                continue;
            }
            let [a, b, c] = self.list.triangles[entry.triangle as usize].map(|number| number as usize - self.first);
            if !self.lanes.push([&self.vertices[a], &self.vertices[b], &self.vertices[c]]) {
                break;
            }
        }
        // If the first entry needs clipping, it forms a separate batch.
        let (now, later) = self.entries.split_at(self.lanes.len().max(1).min(self.entries.len()));
        self.entries = later;
        match now {
            [] => None,
            [alone, ..] if self.lanes.is_empty() => Some(SetupBatch::Clipped(alone)),
            some => Some(SetupBatch::Unclipped(some, &self.lanes)),
        }
    }
}

/// Returns the piece of a clipped triangle to which `entry` refers, or `None` if the triangle is invisible. `clip`
/// produces all pieces of the triangle.
#[cold]
fn pick<T>(entry: &BinEntry, clip: impl FnOnce(&mut dyn FnMut(T))) -> Option<T> {
    let mut pieces = Vec::new();
    clip(&mut |piece| pieces.push(piece));
    pieces.into_iter().nth(entry.piece?.into())
}

fn gouraud_triangle(t: GouraudTriangle) -> TriangleCommand {
    TriangleCommand { edges: t.edges, depth: t.z, colour: t.rgb }
}

fn phong_triangle(t: PhongTriangle) -> PhongTriangleCommand {
    PhongTriangleCommand { edges: t.edges, depth: t.z, normal: t.normal, colour: rgb(t.colour) }
}

/// Returns the command of a sphere with Gouraud shading.
pub fn gouraud_sphere(s: &GouraudSphere) -> Command {
    Command::Sphere(SphereCommand {
        body: body(&s.setup),
        colour: s.rgb,
        root_factor: s.root_factor.map(|factor| factor.min(511) as i16),
    })
}

const fn body(s: &SphereSetup) -> SphereBody {
    SphereBody { silhouette: s.silhouette, root_shift: s.root_shift, depth: s.depth, depth_shift: s.depth_shift }
}

fn phong_sphere(s: &PhongSphere) -> Command {
    Command::PhongSphere(PhongSphereCommand { body: body(&s.setup), normal: s.normal, colour: rgb(s.colour) })
}

/// The command of an invisible triangle, whose edges exclude every pixel.
const NOWHERE: TriangleCommand =
    TriangleCommand { edges: [Linear::constant(-1); 3], depth: Linear::constant(0), colour: [Linear::constant(0); 3] };
const PHONG_NOWHERE: PhongTriangleCommand =
    PhongTriangleCommand { edges: NOWHERE.edges, depth: NOWHERE.depth, normal: NOWHERE.colour, colour: 0 };

fn fixed_direction(v: [f32; 3]) -> [i16; 3] {
    v.map(|c| (c * 1024.0) as i16)
}

fn fixed_part(part: f32) -> u8 {
    (part * 256.0).clamp(0.0, 255.0) as u8
}

/// Intensity of a highlight, 0 to 255 (assumed: a slightly glossy surface).
const SPECULAR: u8 = 96;

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 { v.map(|c| c / length) } else { [0.0, 0.0, 1.0] }
}

fn rgb([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b)
}

#[derive(Debug)]
struct CopyWords {
    layout: Layout,
    copies: Vec<CopyOrder>,
}

impl CommandWords for CopyWords {
    fn append_words(&self, _: u32, out: &mut Vec<Word>) {
        for order in &self.copies {
            let [left, top, _, _] = order.target.grid.rectangle(order.target.region);
            let select = SelectRegion { context: order.context, left: left as u16, top: top as u16 };
            append(&Command::SelectRegion(select), &self.layout, out);
            append(&Command::CopyRegion(CopyRegion { target: order.target }), &self.layout, out);
        }
    }
}
