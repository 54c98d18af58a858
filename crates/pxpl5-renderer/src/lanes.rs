//! Fast pixel array that computes with whole numbers instead of single bits. Its results equal the results of
//! [`crate::BitSerial`] in every bit.

mod bounds;
mod columns;
mod ellipse;
mod enable;
mod general;
mod large;
mod painter;
mod roots;
mod shade;
mod shape;
mod slim;
mod sphere;
mod template;
mod triangle;
mod values;
mod whole;

use crate::array::{ArrayFault, Executed, OutputRegion, PIXELS, PixelArray, Plane};
use crate::controller::{Controller, FieldBits};
use crate::isa::{BACKING_BLOCKS, opcode};
use crate::layout::Layout;
use crate::simd::{PresentVectors, Vectors};
use columns::{ContextColumns, PixelColumns};
use enable::Enable;
use pxpl5_wire::{CommandContent, CommandSink, REGION_SIZE, TriangleBatch, Word};
use std::sync::Arc;
use template::Templates;

/// Pixel array that keeps a 32-bit word for each bit field (such as depth or colour) of each pixel.
///
/// It recognizes whole commands of its layout, and touches only the pixels that they can change. All other instructions
/// are executed on all pixels, one bit field after the other.
#[derive(Clone, Debug)]
pub struct Lanes {
    layout: Layout,
    vectors: PresentVectors,
    templates: Templates,
    controller: Controller,
    columns: PixelColumns,
    /// Columns (arrays of words) of the context that was used last. A context is the part of pixel memory that holds
    /// one region.
    selected: Option<ContextColumns>,
    enable: Enable,
    backing: Vec<Option<Box<[u64]>>>,
    operands: [Vec<u64>; 2],
    faults: u64,
}

impl Lanes {
    /// Creates an array in which all bits are zero. The array recognizes the commands of `layout`, and executes them
    /// faster than single instructions.
    pub fn new(layout: &Layout) -> Self {
        Self::with_vectors(layout, Vectors::best())
    }

    /// Creates an array whose memory is all zero. The array computes with the vector instructions `vectors`, or with
    /// portable code if the computer lacks these instructions.
    pub fn with_vectors(layout: &Layout, vectors: Vectors) -> Self {
        Self {
            layout: *layout,
            vectors: PresentVectors::or_portable(vectors),
            templates: Templates::new(layout),
            controller: Controller::default(),
            columns: PixelColumns::new(layout),
            selected: None,
            enable: Enable::new(),
            backing: vec![None; usize::from(BACKING_BLOCKS)],
            operands: [vec![0; PIXELS], vec![0; PIXELS]],
            faults: 0,
        }
    }

    fn run(&mut self, words: &[Word]) -> Result<Executed, ArrayFault> {
        let mut executed = Executed::default();
        let mut position = 0;
        while position < words.len() {
            position += self.step(words, position, &mut executed)?;
        }
        Ok(executed)
    }

    fn step(&mut self, words: &[Word], position: usize, executed: &mut Executed) -> Result<usize, ArrayFault> {
        if words[position] >> 24 == u32::from(opcode::ENABLE_ALL)
            && let Some(used) = self.whole_command(&words[position..], executed)
        {
            return Ok(used);
        }
        let (instruction, used) = self.controller.fetch(words, position)?;
        self.instruction(&instruction, executed).map_err(|kind| ArrayFault { position, kind })?;
        executed.instructions += 1;
        executed.clocks += u64::from(instruction.clocks());
        Ok(used)
    }

    fn colour(&self, field: FieldBits, width: u32, height: u32) -> Arc<[Word]> {
        if let Some(column) = self.columns.find(field.first, field.width) {
            return rectangle(&self.columns.values(column).0, width, height);
        }
        let mut values = vec![0; PIXELS];
        self.columns.gather(field, &mut values);
        rectangle(&values.iter().map(|v| *v as Word).collect::<Vec<_>>(), width, height)
    }
}

impl Lanes {
    /// Returns the depths of the upper left `width` x `height` pixels of the selected context (region in pixel memory),
    /// row by row.
    ///
    /// A depth has as many bits as Z has in the layout.
    pub(crate) fn read_depth(&self, width: u32, height: u32) -> Arc<[Word]> {
        let depth = self.controller.bits(self.layout.plan().z);
        depth.map_or_else(|_| Arc::default(), |field| self.colour(field, width, height))
    }
}

struct Drawing<'a> {
    array: &'a mut Lanes,
    words: &'a mut Vec<Word>,
    outputs: Result<Vec<OutputRegion>, ArrayFault>,
}

impl Drawing<'_> {
    fn execute(&mut self) {
        if let Ok(outputs) = &mut self.outputs
            && !self.words.is_empty()
        {
            match self.array.execute(self.words) {
                Ok(executed) => outputs.extend(executed.outputs),
                Err(fault) => self.outputs = Err(fault),
            }
        }
        self.words.clear();
    }
}

impl CommandSink for Drawing<'_> {
    fn words(&mut self) -> &mut Vec<Word> {
        self.words
    }

    fn triangles(&mut self, batch: &TriangleBatch<'_>) -> bool {
        // Execute the collected words first, to keep the order of the commands.
        self.execute();
        self.outputs.is_err() || self.array.batch(batch).is_some()
    }
}

fn rectangle(pixels: &[Word], width: u32, height: u32) -> Arc<[Word]> {
    const WIDTH: usize = REGION_SIZE as usize;
    let width = WIDTH.min(width as usize);
    let height = WIDTH.min(height as usize);
    if width == WIDTH {
        return pixels[..width * height].into();
    }
    pixels.chunks(WIDTH).take(height).flat_map(|row| &row[..width]).copied().collect()
}

impl PixelArray for Lanes {
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault> {
        self.run(words).inspect_err(|_| self.faults += 1)
    }

    fn draw(&mut self, commands: &CommandContent, room: &mut Vec<Word>) -> Vec<OutputRegion> {
        room.clear();
        let mut drawing = Drawing { array: self, words: room, outputs: Ok(Vec::new()) };
        commands.append_visible(&mut drawing);
        drawing.execute();
        drawing.outputs.unwrap_or_default()
    }

    fn plane(&self, bit: usize) -> Plane {
        self.columns.plane(bit)
    }

    fn set_plane(&mut self, bit: usize, plane: &Plane) {
        self.columns.set_plane(bit, plane);
    }

    fn enable(&self) -> Plane {
        self.enable.plane()
    }

    fn set_enable(&mut self, plane: &Plane) {
        self.enable.set_plane(plane);
    }

    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]> {
        let colour = self.controller.bits(self.layout.plan().colour);
        colour.map_or_else(|_| Arc::default(), |field| self.colour(field, width, height))
    }

    fn reset(&mut self) {
        self.controller = Controller::default();
        self.columns.clear();
        self.enable.fill(false);
        self.backing.fill(None);
        self.faults = 0;
    }

    fn faults(&self) -> u64 {
        self.faults
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::{Clear, Command, CommandKind, PhongTriangleCommand, SelectRegion, TriangleCommand};
    use crate::conformance::Random;
    use pxpl5_wire::{CommandWords, LANES, LinearLanes};

    const WHOLE: [CommandKind; 6] = [
        CommandKind::Clear,
        CommandKind::Triangle,
        CommandKind::PhongTriangle,
        CommandKind::Sphere,
        CommandKind::PhongSphere,
        CommandKind::Shade,
    ];

    #[test]
    fn every_drawing_command_is_executed_as_a_whole() {
        for layout in [Layout::rendering_control_phong(), Layout::slats(), Layout::slats_quarters()] {
            let mut lanes = Lanes::new(&layout);
            for kind in WHOLE {
                let mut words = Vec::new();
                let possible = Command::blank(kind).encode(&layout, &mut words).is_ok();
                let used = possible.then(|| lanes.whole_command(&words, &mut Executed::default()));
                assert_eq!(used, possible.then_some(Some(words.len())), "{kind:?}");
            }
        }
    }

    #[test]
    fn a_command_for_another_layout_still_runs_instruction_by_instruction() {
        let ours = Layout::rendering_control_phong();
        let theirs = Layout::slats();
        let mut lanes = Lanes::new(&ours);
        let mut words = Vec::new();
        Command::blank(CommandKind::Sphere).encode(&theirs, &mut words).unwrap();
        assert_eq!(lanes.whole_command(&words, &mut Executed::default()), None);
        let executed = lanes.execute(&words).unwrap();
        let clocks = CommandKind::Sphere.clocks(&theirs).unwrap();
        assert_eq!(executed.clocks, u64::from(clocks));
    }

    #[derive(Debug)]
    struct SomeTriangles {
        layout: Layout,
        edges: [LinearLanes; 3],
        planes: [LinearLanes; 4],
        colours: Option<[Word; LANES]>,
    }

    impl SomeTriangles {
        fn random(layout: Layout, random: &mut Random, with_normals: bool) -> Self {
            // The edges are lines through the region, and expressions that sometimes overflow.
            let edge = |random: &mut Random| LinearLanes {
                a: [(); LANES].map(|()| random.signed(9)),
                b: [(); LANES].map(|()| random.signed(9)),
                c: [(); LANES].map(|()| random.signed(16)),
            };
            let plane = |random: &mut Random| LinearLanes {
                a: [(); LANES].map(|()| random.signed(22)),
                b: [(); LANES].map(|()| random.signed(22)),
                c: [(); LANES].map(|()| random.signed(32)),
            };
            let edges = [(); 3].map(|()| edge(random));
            let planes = [(); 4].map(|()| plane(random));
            Self {
                layout,
                edges,
                planes,
                colours: with_normals.then(|| [(); LANES].map(|()| random.signed(24) as Word)),
            }
        }

        /// Returns triangles that are a few columns wide and at least as high. Some of them cross the borders of the
        /// region.
        fn slim(layout: Layout, random: &mut Random, with_normals: bool) -> Self {
            let mut all = Self::random(layout, random, with_normals);
            for i in 0..LANES {
                // Positions are in 1/16 pixel. The height of the shape is at least its width.
                let place = [128, 64].map(|origin| 16 * (origin + (random.signed(9) & 127)));
                let tall = [6, 6, 10, 13][random.below(4) as usize];
                let mut corners = [(); 3].map(|()| [place[0] + random.signed(6), place[1] + random.signed(tall)]);
                let [[ax, ay], [bx, by], [cx, cy]] = corners;
                // Edges are positive inside the triangle only for one order of the corners.
                if (bx - ax) * (cy - ay) < (cx - ax) * (by - ay) {
                    corners.swap(1, 2);
                }
                for e in 0..3 {
                    let ([px, py], [qx, qy]) = (corners[e], corners[(e + 1) % 3]);
                    all.edges[e].a[i] = -16 * (qy - py);
                    all.edges[e].b[i] = 16 * (qx - px);
                    all.edges[e].c[i] = (qy - py) * px - (qx - px) * py;
                }
            }
            all
        }

        fn append(&self, command: Command, out: &mut Vec<Word>) {
            command.encode(&self.layout, out).expect("the layout has what it needs");
        }

        fn begin(&self, out: &mut Vec<Word>) {
            self.append(Command::SelectRegion(SelectRegion { context: 0, left: 128, top: 64 }), out);
            self.append(Command::Clear(Clear { colour: 0x12_34_56 }), out);
        }

        fn triangle(&self, i: usize) -> Command {
            let edges = self.edges.map(|edge| edge.get(i));
            let [depth, components @ ..] = self.planes.map(|plane| plane.get(i));
            match self.colours {
                None => Command::Triangle(TriangleCommand { edges, depth, colour: components }),
                Some(colours) => {
                    let colour = colours[i] & 0xff_ffff;
                    Command::PhongTriangle(PhongTriangleCommand { edges, depth, normal: components, colour })
                }
            }
        }
    }

    impl CommandWords for SomeTriangles {
        fn append_words(&self, _: u32, out: &mut Vec<Word>) {
            self.begin(out);
            (0..LANES).for_each(|i| self.append(self.triangle(i), out));
            self.append(self.triangle(3), out);
        }

        fn append_visible(&self, _: u32, out: &mut dyn CommandSink) -> bool {
            self.begin(out.words());
            let batch = TriangleBatch { len: LANES, edges: &self.edges, planes: &self.planes, colours: self.colours };
            assert!(out.triangles(&batch), "the layout has such triangles");
            self.append(self.triangle(3), out.words());
            true
        }
    }

    /// Draws `rounds` batches, each from command words and from a list of triangles, with all vector units of this
    /// computer. Checks that the pixels are equal, and returns the number of drawn pixels.
    fn covered_alike(rounds: u32, some: fn(Layout, &mut Random, bool) -> SomeTriangles) -> usize {
        let mut random = Random::new(20);
        let mut covered = 0;
        for round in 0..rounds {
            let with_normals = round % 2 == 1;
            let layout = if with_normals { Layout::rendering_control_phong() } else { Layout::slats() };
            let list = CommandContent::new(Arc::new(some(layout, &mut random, with_normals)), 0);
            let mut words = Vec::new();
            list.append_words(&mut words);
            // Every vector unit of this computer must give the same bits.
            for vectors in Vectors::available() {
                let mut by_words = Lanes::with_vectors(&layout, vectors);
                by_words.execute(&words).expect("whole commands");
                let mut by_batch = Lanes::with_vectors(&layout, vectors);
                assert!(by_batch.draw(&list, &mut Vec::new()).is_empty());
                for bit in 0..crate::isa::MEMORY_BITS as usize {
                    assert_eq!(by_batch.plane(bit), by_words.plane(bit), "bit {bit} on {vectors:?}");
                }
                covered += by_words.read_colour(128, 128).iter().filter(|colour| **colour != 0x12_34_56).count();
            }
        }
        covered
    }

    #[test]
    fn triangles_without_words_draw_the_pixels_of_their_commands() {
        let covered = covered_alike(40, SomeTriangles::random);
        assert!(covered > 10_000, "{covered}");
    }

    #[test]
    fn slim_triangles_without_words_draw_the_pixels_of_their_commands() {
        let covered = covered_alike(200, SomeTriangles::slim);
        assert!(covered > 1_000, "{covered}");
    }

    #[test]
    fn a_faulty_word_is_named_and_counted_and_ends_the_list() {
        let mut lanes = Lanes::new(&Layout::slats());
        let mut words = Vec::new();
        Command::blank(CommandKind::Clear).encode(&Layout::slats(), &mut words).unwrap();
        let at = words.len();
        words.extend([0xff00_0000, 0x0100_0000]);
        let fault = lanes.execute(&words).unwrap_err();
        assert_eq!(fault.position, at);
        assert_eq!(fault.to_string(), format!("word {at}: no instruction has this opcode"));
        assert_eq!(lanes.faults(), 1);
    }
}
