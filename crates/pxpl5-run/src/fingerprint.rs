//! Hashes of contents: 128-bit FNV-1a (Fowler, Noll, Vo), the same on every computer. The hash detects accidental
//! changes, but not malicious changes.

use glam::Vec3;
use pxpl5_scene::{Frame, HeadPath, Hinge, Lighting, Scene, Sphere, Structure, Vertex};
use std::fmt::{self, Write};
use std::num::ParseIntError;
use std::ops::Range;
use std::str::FromStr;

const OFFSET_BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// A 128-bit hash of settings or of a scene, printed as 32 hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Fingerprint(u128);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(OFFSET_BASIS)
    }
}

impl Fingerprint {
    /// Returns the 128-bit FNV-1a hash of `bytes`.
    pub fn of(bytes: &[u8]) -> Self {
        let mut fingerprint = Self::default();
        fingerprint.add(bytes);
        fingerprint
    }

    /// Returns a hash of everything in a scene that affects pictures or times: primitives, structures, light and
    /// motion.
    ///
    /// The hash omits the scene's name. The hash also omits the seed of the motion, because this seed is a setting of
    /// the experiment.
    ///
    /// Numbers are hashed with the least significant byte first. A list is hashed as its length (64 bits), then its
    /// entries. The value of an enum is hashed as a byte, counted from 0 in the order of declaration.
    pub fn of_scene(scene: &Scene) -> Self {
        let mut all = Self::default();
        // The order of these lines defines the hash, so it must not change.
        all.length(scene.vertices());
        scene.vertices().iter().for_each(|vertex| all.vertex(vertex));
        all.length(scene.triangles());
        scene.triangles().iter().flatten().for_each(|corner| all.add(&corner.to_le_bytes()));
        all.length(scene.spheres());
        scene.spheres().iter().for_each(|sphere| all.sphere(sphere));
        all.length(scene.structures());
        scene.structures().iter().for_each(|structure| all.structure(structure));
        all.lighting(scene.lighting());
        all.path(scene.motion().path());
        all.reals(&[scene.motion().sway().scale]);
        all
    }

    /// Adds the line `key = value` to the hash.
    pub fn setting(&mut self, key: &str, value: impl fmt::Display) {
        // Writing to the hash cannot fail.
        let _ = writeln!(self, "{key}={value}");
    }

    /// Adds bytes to the hash.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(PRIME));
    }

    fn length<T>(&mut self, list: &[T]) {
        self.add(&(list.len() as u64).to_le_bytes());
    }

    fn floats(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|number| self.add(&number.to_le_bytes()));
    }

    fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|number| self.add(&number.to_le_bytes()));
    }

    fn vector(&mut self, vector: Vec3) {
        self.floats(&vector.to_array());
    }

    fn range(&mut self, range: &Range<usize>) {
        self.add(&(range.start as u64).to_le_bytes());
        self.add(&(range.end as u64).to_le_bytes());
    }

    fn vertex(&mut self, vertex: &Vertex) {
        let Vertex { position, normal, colour } = vertex;
        self.vector(*position);
        self.vector(*normal);
        self.add(colour);
    }

    fn sphere(&mut self, sphere: &Sphere) {
        let Sphere { centre, radius, colour } = sphere;
        self.vector(*centre);
        self.floats(&[*radius]);
        self.add(colour);
    }

    /// Adds a structure to the hash, without its name. The name affects neither pictures nor times.
    fn structure(&mut self, structure: &Structure) {
        // The pattern lists all fields, so a new field cannot be forgotten.
        let Structure { name: _, vertices, triangles, spheres, frame, hinge, culls_back_faces } = structure;
        self.range(vertices);
        self.range(triangles);
        self.range(spheres);
        self.add(&[match frame {
            Frame::World => 0,
            Frame::Head => 1,
        }]);
        // This byte distinguishes a structure without hinge from the numbers of a hinge.
        self.add(&[u8::from(hinge.is_some()) | u8::from(*culls_back_faces) << 1]);
        if let Some(Hinge { point, axis, amplitude_deg, period_ps, phase_turns }) = hinge {
            self.vector(*point);
            self.vector(*axis);
            self.reals(&[*amplitude_deg]);
            self.add(&period_ps.to_le_bytes());
            self.reals(&[*phase_turns]);
        }
    }

    fn lighting(&mut self, lighting: &Lighting) {
        let Lighting { towards_light, ambient, diffuse, background } = lighting;
        self.vector(*towards_light);
        self.floats(&[*ambient, *diffuse]);
        self.add(background);
    }

    fn path(&mut self, path: &HeadPath) {
        match path {
            HeadPath::Still { eye, target } => {
                self.add(&[0]);
                self.vector(*eye);
                self.vector(*target);
            }
            HeadPath::Pan { eye, deg_per_s } => {
                self.add(&[1]);
                self.vector(*eye);
                self.reals(&[*deg_per_s]);
            }
            HeadPath::Orbit { target, distance, height, deg_per_s } => {
                self.add(&[2]);
                self.vector(*target);
                self.reals(&[*distance, *height, *deg_per_s]);
            }
            HeadPath::Look { target, distance } => {
                self.add(&[3]);
                self.vector(*target);
                self.reals(&[*distance]);
            }
            HeadPath::FlyThrough { target, nearest, farthest, lap_s } => {
                self.add(&[4]);
                self.vector(*target);
                self.reals(&[*nearest, *farthest, *lap_s]);
            }
        }
    }
}

impl Write for Fingerprint {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.add(text.as_bytes());
        Ok(())
    }
}

impl FromStr for Fingerprint {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, ParseIntError> {
        u128::from_str_radix(text, 16).map(Self)
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_agrees_with_the_published_vectors_of_fnv_1a() {
        // These values are test vectors of the reference program for 128 bits: "" and "a".
        assert_eq!(Fingerprint::of(b"").to_string(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Fingerprint::of(b"a").to_string(), "d228cb696f1a8caf78912b704e4a8964");
    }

    #[test]
    fn a_scene_with_one_triangle_less_has_another_fingerprint() {
        let mig = pxpl5_scene::builtin("mig").expect("built in");
        let shorter = mig.decimated(416).expect("it has 417");
        assert_ne!(Fingerprint::of_scene(&mig), Fingerprint::of_scene(&shorter));
        assert_eq!(Fingerprint::of_scene(&mig), Fingerprint::of_scene(&mig.clone()));
    }
}
