//! Random command lists for tests. The same seed gives the same lists on every computer.

use crate::command::{
    Clear, Command, LoadBacking, PhongSphereCommand, PhongTriangleCommand, SelectRegion, Shade, SphereBody,
    SphereCommand, StoreBacking, TriangleCommand,
};
use crate::isa::ArrayInstruction;
use crate::layout::Layout;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{Linear, Quadratic, Word};

#[derive(Clone, Copy, Debug)]
pub struct Random(SplitMix64);

impl Random {
    pub const fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed.wrapping_mul(0xd129_0d3b_3f4b_7ec5)))
    }

    #[allow(clippy::should_implement_trait)] // The iterator would never end, and every caller would have to unwrap.
    pub const fn next(&mut self) -> u64 {
        self.0.bits()
    }

    pub const fn below(&mut self, n: u64) -> u64 {
        self.0.below(n)
    }

    /// Returns a two's complement number of `bits` bits, 1 to 32.
    pub const fn signed(&mut self, bits: u32) -> i32 {
        (self.next() as i32) >> (32 - bits)
    }

    pub(crate) const fn between(&mut self, low: i64, high: i64) -> i64 {
        low + self.below((high - low) as u64) as i64
    }

    /// Returns a random list of words: mostly commands of the layout, some single instructions and, rarely, invalid
    /// words.
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
        // Flip one bit of every 16th list, so that some lists are invalid.
        if self.below(16) == 0 && !words.is_empty() {
            let at = self.below(words.len() as u64) as usize;
            words[at] ^= 1 << self.below(32);
        }
        words
    }

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

    /// Returns a vector of roughly unit length, in the format of [`Shade::light`].
    fn vector(&mut self) -> [i16; 3] {
        std::array::from_fn(|_| self.between(-1500, 1500) as i16)
    }

    /// Returns the edge expressions of a triangle of random size around a random pixel. Returns three arbitrary
    /// expressions with a probability of 1/10.
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

    /// Returns a random linear expression, whose values at the pixels of a screen have about `bits` bits.
    fn plane(&mut self, bits: u32) -> Linear {
        Linear { a: self.signed(bits - 9), b: self.signed(bits - 9), c: self.signed(bits) }
    }

    /// Returns the silhouette expression of an ellipse around a random pixel. Returns an arbitrary quadratic expression
    /// with a probability of 1/8.
    fn silhouette(&mut self) -> Quadratic {
        if self.below(8) == 0 {
            let [xx, xy, yy, x, y, one] = std::array::from_fn(|_| (self.next() as i64) >> 20);
            return Quadratic { xx, xy, yy, x, y, one };
        }
        // An ellipse with its middle at (x, y), where its value is scale * r^2.
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

/// Returns a command that draws the same shape in other colours and with the same depths. The depth test then fails at
/// every pixel that `command` has drawn.
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

/// Returns the edge expression of the line from `p` to `q`, with the inside on the left. Points are in sixteenths of a
/// pixel. Coefficients are truncated to 32 bits.
fn edge(p: [i64; 2], q: [i64; 2]) -> Linear {
    let dx = q[0] - p[0];
    let dy = q[1] - p[1];
    let c = dy * p[0] - dx * p[1];
    Linear { a: -dy as i32, b: dx as i32, c: c.div_euclid(16) as i32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn random_commands_occur_in_the_intended_shares() {
        let layout = Layout::rendering_control_phong();
        let mut random = Random::new(1);
        let mut counts = BTreeMap::new();
        for _ in 0..4000 {
            let name = format!("{:?}", random.command(&layout).kind());
            *counts.entry(name).or_insert(0) += 1;
        }
        for backing in ["WaitBacking", "StoreBacking", "LoadBacking"] {
            let count = counts.remove(backing).unwrap_or(0);
            assert!((35..110).contains(&count), "{backing} {count}");
        }
        let shares: BTreeMap<_, _> = counts.iter().map(|(name, count)| (&name[..], (count + 100) / 200)).collect();
        let expected = [
            ("Clear", 1),
            ("PhongSphere", 2),
            ("PhongTriangle", 4),
            ("SelectRegion", 1),
            ("Shade", 1),
            ("Sphere", 3),
            ("Triangle", 7),
        ];
        assert_eq!(shares, BTreeMap::from(expected));
    }

    #[test]
    fn random_lists_have_repeated_commands_instructions_and_wrong_words() {
        let layout = Layout::slats();
        let mut random = Random::new(2);
        let mut wrong = 0;
        let mut commands = 0;
        for _ in 0..1000 {
            let words = random.list(&layout);
            wrong += u32::from(ArrayInstruction::decode_all(&words).is_err());
            commands += words.iter().filter(|word| **word >> 24 == 1).count();
        }
        // At most one list in 16 is invalid, and a flipped bit often changes only a number. A list has one to four
        // commands. The layout of Slats lacks a third of the kinds of commands.
        assert!((5..63).contains(&wrong), "{wrong}");
        assert!((1000..3000).contains(&commands), "{commands}");
        let lengths: BTreeSet<usize> = (0..300)
            .map(|_| {
                let mut words = Vec::new();
                random.instructions(&mut words);
                ArrayInstruction::decode_all(&words).expect("all are legal").len()
            })
            .collect();
        assert_eq!(lengths, (1..=6).collect());
    }

    #[test]
    fn repainting_keeps_the_shape_and_changes_the_colour() {
        let layout = Layout::rendering_control_phong();
        let mut random = Random::new(3);
        for _ in 0..200 {
            let command = random.command(&layout);
            let again = repainted(command);
            let differs = match (command, again) {
                (Command::Triangle(a), Command::Triangle(b)) => (a.edges, a.depth) == (b.edges, b.depth) && a != b,
                (Command::PhongTriangle(a), Command::PhongTriangle(b)) => {
                    PhongTriangleCommand { colour: b.colour, ..a } == b && a != b
                }
                (Command::Sphere(a), Command::Sphere(b)) => a.body == b.body && a != b,
                (Command::PhongSphere(a), Command::PhongSphere(b)) => {
                    PhongSphereCommand { colour: b.colour, ..a } == b && a != b
                }
                (a, b) => a == b,
            };
            assert!(differs, "{command:?} {again:?}");
        }
    }

    #[test]
    fn an_edge_is_zero_at_its_ends_and_positive_on_its_left() {
        let mut random = Random::new(4);
        for _ in 0..1000 {
            let [p, q] = [(); 2].map(|()| [random.between(-900, 900), random.between(-900, 900)]);
            let e = edge(p, q);
            let at = |[x, y]: [i64; 2]| i64::from(e.a) * x + i64::from(e.b) * y + 16 * i64::from(e.c);
            // The constant is truncated to whole pixels.
            assert!((-15..=0).contains(&at(p)) && (-15..=0).contains(&at(q)), "{p:?} {q:?} {e:?}");
            let left = [p[0] - 40 * (q[1] - p[1]).signum(), p[1] + 40 * (q[0] - p[0]).signum()];
            assert!(p == q || at(left) > 0, "{p:?} {q:?} {e:?}");
        }
    }

    /// Tests the share of random edges that form a triangle. The sum of a triangle's three edge expressions has no
    /// slope.
    #[test]
    fn most_random_edges_belong_to_triangles_of_any_size() {
        let mut random = Random::new(5);
        let mut sizes = BTreeMap::new();
        for _ in 0..4000 {
            let edges = random.edges();
            let sum = |f: fn(&Linear) -> i32| edges.iter().map(|e| i64::from(f(e))).sum::<i64>();
            if (sum(|e| e.a), sum(|e| e.b)) != (0, 0) {
                continue;
            }
            let longest = edges.iter().map(|e| e.a.unsigned_abs().max(e.b.unsigned_abs())).max();
            *sizes.entry(longest.and_then(u32::checked_ilog10)).or_insert(0) += 1;
        }
        // Nine of ten results are triangles, from less than one pixel to thousands of pixels.
        assert!((3500..3700).contains(&sizes.values().sum::<u32>()), "{sizes:?}");
        assert!((1..=5).all(|digits| sizes.get(&Some(digits)).copied().unwrap_or(0) > 30), "{sizes:?}");
    }

    /// Tests the share of random silhouettes that are ellipses. At the middle of an ellipse both slopes are 0, and the
    /// value is the scale times the squared radius.
    #[test]
    fn most_silhouettes_are_ellipses_around_a_pixel() {
        let mut random = Random::new(6);
        let mut radii = [0; 4];
        let mut tilted = 0;
        for _ in 0..4000 {
            let q = random.silhouette();
            let scale = -q.xx;
            if scale <= 0 || q.yy != q.xx || !(scale as u64).is_power_of_two() {
                continue;
            }
            assert!(q.xy.abs() <= scale / 2, "{q:?}");
            tilted += u32::from(q.xy != 0);
            let determinant = 4 * scale * scale - q.xy * q.xy;
            let [x, y] = [2 * scale * q.x + q.xy * q.y, 2 * scale * q.y + q.xy * q.x];
            assert_eq!((x % determinant, y % determinant), (0, 0), "{q:?}");
            let [x, y] = [x / determinant, y / determinant];
            assert!((-20..660).contains(&x) && (-20..500).contains(&y), "{q:?} {x} {y}");
            let square = q.at(x as i32, y as i32);
            let radius = (square / scale).isqrt();
            assert_eq!(scale * radius * radius, square, "{q:?}");
            assert!((1..500).contains(&radius), "{q:?} {radius}");
            radii[(radius >= 2) as usize + (radius >= 10) as usize + (radius >= 60) as usize] += 1;
        }
        // Seven of eight results are ellipses, in four size classes. The sizes start at 1 pixel and go up to 2, 10, 60
        // and 500 pixels.
        assert!(radii.iter().sum::<i32>() > 3300 && radii.iter().all(|count| *count > 400), "{radii:?}");
        assert!(tilted > 2500, "{tilted}");
    }

    #[test]
    fn random_numbers_cover_their_ranges() {
        let layout = Layout::slats();
        let mut random = Random::new(7);
        let mut places = BTreeSet::new();
        let mut blocks = BTreeSet::new();
        for _ in 0..2000 {
            if let Command::SelectRegion(select) = random.select(&layout) {
                places.insert((select.context, select.left / 128, select.top));
                assert_eq!(select.left % 128, 0);
            }
            match random.backing() {
                Command::StoreBacking(StoreBacking { block, address })
                | Command::LoadBacking(LoadBacking { block, address }) => {
                    blocks.insert(block);
                    assert!(address <= 176);
                }
                _ => {}
            }
        }
        assert_eq!((places.len(), blocks.len()), (4 * 5 * 4, 3));
        let vectors: BTreeSet<i16> = (0..500).flat_map(|_| random.vector()).collect();
        assert!(vectors.len() > 900 && vectors.iter().all(|v| (-1500..1500).contains(v)));
        // The slopes of a plane use about nine bits less than its values.
        let planes: Vec<Linear> = (0..500).map(|_| random.plane(32)).collect();
        assert!(planes.iter().all(|p| p.a.unsigned_abs() <= 1 << 22 && p.b.unsigned_abs() <= 1 << 22));
        assert!(planes.iter().any(|p| p.a.abs() > 1 << 21) && planes.iter().any(|p| p.c.abs() > 1 << 30));
        let wild: Vec<Linear> = (0..500).map(|_| random.wild()).collect();
        let constant = wild.iter().filter(|e| (e.a, e.b) == (0, 0)).count();
        assert!((90..200).contains(&constant), "{constant}");
        assert!(wild.iter().any(|e| e.a.unsigned_abs() > 1 << 30) && wild.iter().any(|e| e.a != 0 && e.a.abs() < 9));
        let shades: Vec<Shade> = (0..50).map(|_| random.shade()).collect();
        assert!(shades.windows(2).all(|two| two[0] != two[1]));
        let spheres: Vec<SphereCommand> = (0..50).map(|_| random.sphere()).collect();
        let phong: Vec<PhongSphereCommand> = (0..50).map(|_| random.phong_sphere()).collect();
        assert!(spheres.windows(2).all(|two| two[0] != two[1] && two[0].body != two[1].body));
        assert!(phong.windows(2).all(|two| two[0] != two[1]));
        let triangles: Vec<TriangleCommand> = (0..50).map(|_| random.triangle()).collect();
        let with_normals: Vec<PhongTriangleCommand> = (0..50).map(|_| random.phong_triangle()).collect();
        assert!(triangles.windows(2).all(|two| two[0] != two[1]));
        assert!(with_normals.windows(2).all(|two| two[0] != two[1]));
    }
}
