//! Messages of renderer commands: which kinds are in them, and their words on demand.

use crate::list::Counts;
use crate::pass::{Pass, ScreenTriangles, Shading};
use pxpl5_geometry::{self as geometry, GouraudSphere, SetupStats};
use pxpl5_renderer::{
    Clear, Command, CommandKind, CopyRegion, Layout, PhongSphere, PhongTriangle, SelectRegion, Shade, Sphere, Triangle,
};
use pxpl5_wire::{CommandList, CommandRun, CommandWords, CopyOrder, MAX_MESSAGE_WORDS, RegionId, Word};
use std::ops::Range;
use std::sync::Arc;

/// What is sent around a bin's primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Around {
    /// Select the region's context and clear it first.
    pub begin: bool,
    /// Shade all pixels afterwards, where the picture is shaded at the pixels.
    pub shade: bool,
    /// Copy the region afterwards.
    pub copy: Option<CopyOrder>,
}

/// The messages that hold a region's bin and what is sent around it, as few as their length allows.
#[must_use]
pub fn region_messages(pass: &Arc<Pass>, region: RegionId, context: u8, around: Around) -> Vec<CommandList> {
    let counts = pass.counts(region);
    let mut packer = Packer { pass, region, context, part: Part::default(), words: 0, lists: Vec::new() };
    packer.select(around.begin);
    packer.primitives(pass.triangle_kind(), counts.triangles, |part| &mut part.triangles);
    packer.primitives(pass.sphere_kind(), counts.spheres, |part| &mut part.spheres);
    packer.end(around);
    packer.lists
}

/// A message that only copies regions, each from its context.
#[must_use]
pub fn copy_message(layout: Layout, copies: Vec<CopyOrder>, pixels: bool) -> CommandList {
    let runs =
        copies.iter().flat_map(|_| [run(CommandKind::SelectRegion, 1), run(CommandKind::CopyRegion, 1)]).collect();
    let context = copies.first().map_or(0, |order| order.context);
    let content = pixels.then(|| Arc::new(Copies { layout, copies: copies.clone() }) as Arc<dyn CommandWords>);
    CommandList { runs, context, copies, content }
}

const fn run(kind: CommandKind, count: u32) -> CommandRun {
    CommandRun { opcode: kind.opcode(), words_each: kind.words(), count }
}

/// What one message holds of a region.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Part {
    select: bool,
    clear: bool,
    triangles: Range<u32>,
    spheres: Range<u32>,
    shade: bool,
    copy: Option<CopyOrder>,
}

/// Fills messages one after the other.
struct Packer<'a> {
    pass: &'a Arc<Pass>,
    region: RegionId,
    context: u8,
    part: Part,
    words: u32,
    lists: Vec<CommandList>,
}

impl Packer<'_> {
    fn select(&mut self, clear: bool) {
        let selecting = clear || self.pass.picture().layout.plan().contexts > 1;
        self.part.select = selecting;
        self.part.clear = clear;
        self.words = CommandKind::SelectRegion.words() * u32::from(selecting);
        self.words += CommandKind::Clear.words() * u32::from(clear);
    }

    fn primitives(&mut self, kind: CommandKind, count: u32, range: impl Fn(&mut Part) -> &mut Range<u32>) {
        let mut sent = 0;
        while sent < count {
            let fits = (MAX_MESSAGE_WORDS - self.words) / kind.words();
            if fits == 0 {
                self.finish();
                continue;
            }
            let n = fits.min(count - sent);
            *range(&mut self.part) = sent..sent + n;
            self.words += n * kind.words();
            sent += n;
        }
    }

    fn end(&mut self, around: Around) {
        let shade = around.shade && self.pass.picture().shading == Shading::Phong;
        let words = CommandKind::Shade.words() * u32::from(shade)
            + CommandKind::CopyRegion.words() * u32::from(around.copy.is_some());
        if self.words + words > MAX_MESSAGE_WORDS {
            self.finish();
        }
        self.part.shade = shade;
        self.part.copy = around.copy;
        self.words += words;
        self.finish();
    }

    /// Closes a message, unless it would only select.
    fn finish(&mut self) {
        let part = std::mem::take(&mut self.part);
        let selected = CommandKind::SelectRegion.words() * u32::from(part.select);
        if self.words > selected {
            self.lists.push(self.list(part));
        }
        self.select(false);
    }

    fn list(&self, part: Part) -> CommandList {
        let (pass, region) = (Arc::clone(self.pass), self.region);
        let runs = part.runs(&pass);
        let copies = part.copy.into_iter().collect();
        let words = RegionWords { pass, region, context: self.context, part };
        let content = words.pass.picture().pixels.then(|| Arc::new(words) as Arc<dyn CommandWords>);
        CommandList { runs, context: self.context, copies, content }
    }
}

impl Part {
    fn runs(&self, pass: &Pass) -> Vec<CommandRun> {
        let all = [
            (CommandKind::SelectRegion, u32::from(self.select)),
            (CommandKind::Clear, u32::from(self.clear)),
            (pass.triangle_kind(), self.triangles.len() as u32),
            (pass.sphere_kind(), self.spheres.len() as u32),
            (CommandKind::Shade, u32::from(self.shade)),
            (CommandKind::CopyRegion, u32::from(self.copy.is_some())),
        ];
        all.into_iter().filter(|(_, count)| *count > 0).map(|(kind, count)| run(kind, count)).collect()
    }
}

impl Pass {
    pub(crate) const fn triangle_kind(&self) -> CommandKind {
        match self.picture().shading {
            Shading::Gouraud => CommandKind::Triangle,
            Shading::Phong => CommandKind::PhongTriangle,
        }
    }

    pub(crate) const fn sphere_kind(&self) -> CommandKind {
        match self.picture().shading {
            Shading::Gouraud => CommandKind::Sphere,
            Shading::Phong => CommandKind::PhongSphere,
        }
    }

    /// Bytes of the renderer commands of all screen primitives, each held once (TR94: bins point to them).
    #[must_use]
    pub fn command_bytes(&self) -> u64 {
        let Counts { triangles, spheres } = self.screen_counts();
        let bytes = |kind: CommandKind, n: u32| 4 * u64::from(kind.words()) * u64::from(n);
        bytes(self.triangle_kind(), triangles) + bytes(self.sphere_kind(), spheres)
    }
}

/// Makes the words of one message.
#[derive(Debug)]
struct RegionWords {
    pass: Arc<Pass>,
    region: RegionId,
    context: u8,
    part: Part,
}

impl CommandWords for RegionWords {
    fn append_words(&self, out: &mut Vec<Word>) {
        self.each(|command| append(&command, &self.pass.picture().layout, out));
    }
}

/// A layout that lacks what a command needs is refused when the machine is configured.
fn append(command: &Command, layout: &Layout, out: &mut Vec<Word>) {
    let encoded = command.encode(layout, out);
    debug_assert!(encoded.is_ok(), "{encoded:?}");
}

impl RegionWords {
    fn each(&self, mut sink: impl FnMut(Command)) {
        let picture = self.pass.picture();
        if self.part.select {
            let [left, top, _, _] = picture.viewport.grid().rectangle(self.region);
            sink(Command::SelectRegion(SelectRegion { context: self.context, left: left as u16, top: top as u16 }));
        }
        if self.part.clear {
            sink(Command::Clear(Clear { colour: rgb(self.pass.background()) }));
        }
        self.triangles(&mut sink);
        self.spheres(&mut sink);
        if self.part.shade {
            sink(Command::Shade(self.shade()));
        }
        if let Some(order) = &self.part.copy {
            sink(Command::CopyRegion(CopyRegion { target: order.target }));
        }
    }

    fn triangles(&self, sink: &mut impl FnMut(Command)) {
        if self.part.triangles.is_empty() {
            return;
        }
        let (viewport, mut stats) = (&self.pass.picture().viewport, SetupStats::default());
        let range = self.part.triangles.start as usize..self.part.triangles.end as usize;
        let numbers = self.pass.bin(self.region)[0][range].iter().map(|n| *n as usize);
        match &self.pass.screen().triangles {
            ScreenTriangles::Gouraud(all) => numbers.for_each(|n| {
                let t = all[n].gouraud(viewport, &mut stats);
                sink(Command::Triangle(Triangle { edges: t.edges, depth: t.z, colour: t.rgb }));
            }),
            ScreenTriangles::Phong(all) => numbers.for_each(|n| {
                let t = all[n].phong(viewport, &mut stats);
                let colour = rgb(t.colour);
                sink(Command::PhongTriangle(PhongTriangle { edges: t.edges, depth: t.z, normal: t.normal, colour }));
            }),
        }
    }

    fn spheres(&self, sink: &mut impl FnMut(Command)) {
        if self.part.spheres.is_empty() {
            return;
        }
        let (picture, mut stats) = (self.pass.picture(), SetupStats::default());
        let range = self.part.spheres.start as usize..self.part.spheres.end as usize;
        let all = &self.pass.screen().spheres;
        for n in &self.pass.bin(self.region)[1][range] {
            let (sphere, light) = &all[*n as usize];
            sink(match picture.shading {
                Shading::Gouraud => gouraud_sphere(&sphere.gouraud(&picture.viewport, light, &mut stats)),
                Shading::Phong => phong_sphere(&sphere.phong(&picture.viewport, &mut stats)),
            });
        }
    }

    /// Light and highlight in the formats of the command; the eye looks along -z.
    fn shade(&self) -> Shade {
        let Some(light) = self.pass.light() else { return Shade::default() };
        let towards = light.direction;
        let half = unit([towards[0], towards[1], towards[2] + 1.0]);
        let fixed = |v: [f32; 3]| v.map(|c| (c * 1024.0) as i16);
        let share = |part: f32| (part * 256.0).clamp(0.0, 255.0) as u8;
        Shade {
            light: fixed(towards),
            half: fixed(half),
            ambient: share(light.ambient),
            diffuse: share(light.diffuse),
            specular: SPECULAR,
        }
    }
}

/// The command of a sphere with Gouraud shading.
#[must_use]
pub fn gouraud_sphere(s: &GouraudSphere) -> Command {
    Command::Sphere(Sphere {
        silhouette: s.setup.silhouette,
        root_shift: s.setup.root_shift,
        depth: s.setup.depth,
        depth_shift: s.setup.depth_shift,
        colour: s.rgb,
        root_factor: s.root_factor.map(|factor| factor.min(511) as i16),
    })
}

fn phong_sphere(s: &geometry::PhongSphere) -> Command {
    Command::PhongSphere(PhongSphere {
        silhouette: s.setup.silhouette,
        root_shift: s.setup.root_shift,
        depth: s.setup.depth,
        depth_shift: s.setup.depth_shift,
        normal: s.normal,
        colour: rgb(s.colour),
    })
}

/// White of a highlight, of 255 (assumed: a slightly glossy surface).
const SPECULAR: u8 = 96;

fn unit(v: [f32; 3]) -> [f32; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    if length > 0.0 { v.map(|c| c / length) } else { [0.0, 0.0, 1.0] }
}

fn rgb([r, g, b]: [u8; 3]) -> u32 {
    u32::from(r) << 16 | u32::from(g) << 8 | u32::from(b)
}

/// Words of a message that only copies.
#[derive(Debug)]
struct Copies {
    layout: Layout,
    copies: Vec<CopyOrder>,
}

impl CommandWords for Copies {
    fn append_words(&self, out: &mut Vec<Word>) {
        for order in &self.copies {
            let [left, top, _, _] = order.target.grid.rectangle(order.target.region);
            let select = SelectRegion { context: order.context, left: left as u16, top: top as u16 };
            append(&Command::SelectRegion(select), &self.layout, out);
            append(&Command::CopyRegion(CopyRegion { target: order.target }), &self.layout, out);
        }
    }
}
