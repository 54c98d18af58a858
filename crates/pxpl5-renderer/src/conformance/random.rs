//! Random lists of words, the same for the same number on every host.

use crate::command::{
    Clear, Command, LoadBacking, PhongSphereCommand, PhongTriangleCommand, SelectRegion, Shade, SphereBody,
    SphereCommand, StoreBacking, TriangleCommand,
};
use crate::isa::ArrayInstruction;
use crate::layout::Layout;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{Linear, Quadratic, Word};

/// Random numbers, and lists of words made with them.
#[derive(Clone, Copy, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// Each seed gives another sequence.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed.wrapping_mul(0xd129_0d3b_3f4b_7ec5)))
    }

    /// The next 64 bits.
    #[allow(clippy::should_implement_trait)] // An iterator that never ends would make every caller unwrap.
    pub const fn next(&mut self) -> u64 {
        self.0.bits()
    }

    /// A number from 0 to `n` - 1.
    pub const fn below(&mut self, n: u64) -> u64 {
        self.0.below(n)
    }

    /// A two's complement number of `bits` bits, 1 to 32.
    pub const fn signed(&mut self, bits: u32) -> i32 {
        (self.next() as i32) >> (32 - bits)
    }

    /// A number from `low` to `high` - 1.
    pub(crate) const fn between(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low) as u64) as i64
    }

    /// A list: mostly commands of the layout, some single instructions, some words that mean nothing.
    pub fn list(&mut self, layout: &Layout) -> Vec<Word> {
        let mut words = Vec::new();
        let mut last = self.command(layout);
        for _ in 0..1 + self.below(4) {
            match self.below(8) {
                0 => self.instructions(&mut words),
                1 | 2 => last = repainted(last),
                _ => last = self.command(layout),
            }
            last.encode(layout, &mut words).unwrap_or(());
        }
        if self.below(16) == 0 && !words.is_empty() {
            let at = self.below(words.len() as u64) as usize;
            words[at] ^= 1 << self.below(32);
        }
        words
    }

    /// Legal instructions with random operands.
    fn instructions(&mut self, words: &mut Vec<Word>) {
        let mut wanted = 1 + self.below(6);
        while wanted > 0 {
            let opcode = 1 + self.below(0x6f) as u32;
            let mut trial = vec![opcode << 24 | self.next() as u32 & 0x3f_ffff];
            trial.extend((0..12).map(|_| self.next() as u32));
            if let Ok((instruction, _)) = ArrayInstruction::decode(&trial, 0) {
                instruction.encode(words);
                wanted -= 1;
            }
        }
    }

    fn command(&mut self, layout: &Layout) -> Command {
        match self.below(20) {
            0 => Command::Clear(Clear { colour: self.next() as u32 }),
            1 => self.select(layout),
            2 => Command::Shade(self.shade()),
            3..=5 => Command::Sphere(self.sphere()),
            6..=7 => Command::PhongSphere(self.phong_sphere()),
            8..=11 => Command::PhongTriangle(self.phong_triangle()),
            12 => self.backing(),
            _ => Command::Triangle(self.triangle()),
        }
    }

    fn select(&mut self, layout: &Layout) -> Command {
        let context = self.below(layout.plan().contexts.into()) as u8;
        let left = 128 * self.below(5) as u16;
        let top = [0, 120, 128, 384][self.below(4) as usize];
        Command::SelectRegion(SelectRegion { context, left, top })
    }

    fn backing(&mut self) -> Command {
        let block = self.below(3) as u8;
        let address = self.below(177) as u8;
        match self.below(3) {
            0 => Command::WaitBacking,
            1 => Command::StoreBacking(StoreBacking { block, address }),
            _ => Command::LoadBacking(LoadBacking { block, address }),
        }
    }

    fn triangle(&mut self) -> TriangleCommand {
        let colour = [self.plane(20), self.plane(20), self.plane(20)];
        TriangleCommand { edges: self.edges(), depth: self.plane(32), colour }
    }

    fn phong_triangle(&mut self) -> PhongTriangleCommand {
        let normal = [self.plane(22), self.plane(22), self.plane(22)];
        let colour = self.next() as u32;
        PhongTriangleCommand { edges: self.edges(), depth: self.plane(32), normal, colour }
    }

    fn sphere(&mut self) -> SphereCommand {
        let body = self.sphere_body();
        let colour = [self.plane(20), self.plane(20), self.plane(20)];
        let root_factor = std::array::from_fn(|_| self.between(-512, 512) as i16);
        SphereCommand { body, colour, root_factor }
    }

    fn phong_sphere(&mut self) -> PhongSphereCommand {
        let body = self.sphere_body();
        PhongSphereCommand { body, normal: [self.plane(22), self.plane(22)], colour: self.next() as u32 }
    }

    fn sphere_body(&mut self) -> SphereBody {
        SphereBody {
            silhouette: self.silhouette(),
            root_shift: self.below(25) as u8,
            depth: self.plane(32),
            depth_shift: self.below(21) as u8,
        }
    }

    fn shade(&mut self) -> Shade {
        let light = self.vector();
        let half = self.vector();
        let [ambient, diffuse, specular, ..] = self.next().to_le_bytes();
        Shade { light, half, ambient, diffuse, specular }
    }

    /// About a unit vector, in the format of [`Shade::light`].
    fn vector(&mut self) -> [i16; 3] {
        std::array::from_fn(|_| self.between(-1500, 1500) as i16)
    }

    /// Edges of a triangle around a random pixel, of all sizes; sometimes degenerate, sometimes wild.
    fn edges(&mut self) -> [Linear; 3] {
        if self.below(10) == 0 {
            return std::array::from_fn(|_| self.wild());
        }
        let size = [16, 64, 256, 2_000, 20_000, 200_000][self.below(6) as usize];
        let x = self.between(-16 * 32, 16 * 672);
        let y = self.between(-16 * 32, 16 * 672);
        let [p, q, r] = std::array::from_fn(|_| [x + self.between(-size, size), y + self.between(-size, size)]);
        let flip = self.below(2) == 0;
        if flip { [edge(q, p), edge(r, q), edge(p, r)] } else { [edge(p, q), edge(q, r), edge(r, p)] }
    }

    fn wild(&mut self) -> Linear {
        match self.below(4) {
            0 => Linear::constant(self.next() as i32),
            _ => {
                let bits = 32 - self.below(32) as u32;
                Linear { a: self.signed(bits), b: self.signed(bits), c: self.signed(bits) }
            }
        }
    }

    /// A plane whose values use about `bits` bits over a screen.
    fn plane(&mut self, bits: u32) -> Linear {
        Linear { a: self.signed(bits - 9), b: self.signed(bits - 9), c: self.signed(bits) }
    }

    /// An ellipse around a random pixel, or anything.
    fn silhouette(&mut self) -> Quadratic {
        if self.below(8) == 0 {
            let [xx, xy, yy, x, y, one] = std::array::from_fn(|_| (self.next() as i64) >> 20);
            return Quadratic { xx, xy, yy, x, y, one };
        }
        let radius = [2, 10, 60, 500][self.below(4) as usize];
        let x = self.between(-20, 660);
        let y = self.between(-20, 500);
        let r = self.between(1, radius);
        let scale = 1 << self.below(20);
        let tilt = self.between(-scale / 2, scale / 2 + 1);
        Quadratic {
            xx: -scale,
            xy: tilt,
            yy: -scale,
            x: 2 * scale * x - tilt * y,
            y: 2 * scale * y - tilt * x,
            one: scale * (r * r - x * x - y * y) + tilt * x * y,
        }
    }
}

/// The same shape in other colours: all depths are equal, so that none is nearer.
fn repainted(command: Command) -> Command {
    match command {
        Command::Triangle(mut t) => {
            t.colour.rotate_left(1);
            Command::Triangle(t)
        }
        Command::PhongTriangle(t) => Command::PhongTriangle(PhongTriangleCommand { colour: !t.colour, ..t }),
        Command::Sphere(mut s) => {
            s.colour.rotate_left(1);
            Command::Sphere(s)
        }
        Command::PhongSphere(s) => Command::PhongSphere(PhongSphereCommand { colour: !s.colour, ..s }),
        other => other,
    }
}

/// The edge from p to q, in sixteenths of a pixel, inside on its left; cut to 32 bits.
fn edge(p: [i64; 2], q: [i64; 2]) -> Linear {
    let dx = q[0] - p[0];
    let dy = q[1] - p[1];
    let c = dy * p[0] - dx * p[1];
    Linear { a: -dy as i32, b: dx as i32, c: c.div_euclid(16) as i32 }
}
