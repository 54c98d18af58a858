//! A short name for contents: 128-bit FNV-1a (Fowler, Noll, Vo), the same on every host. It finds accidents, not malice.

use pxpl5_scene::{Frame, Scene};
use std::fmt::{self, Write};

const OFFSET_BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

/// The hash of some contents; shown as 32 hexadecimal digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Fingerprint(u128);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(OFFSET_BASIS)
    }
}

impl Fingerprint {
    /// Of some bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        let mut fingerprint = Self::default();
        fingerprint.add(bytes);
        fingerprint
    }

    /// Of everything in a scene that can be seen or that takes time: primitives, structures, light and motion; not its
    /// name.
    #[must_use]
    pub fn of_scene(scene: &Scene) -> Self {
        let mut all = Self::default();
        for vertex in scene.vertices() {
            all.numbers(&vertex.position.to_array());
            all.numbers(&vertex.normal.to_array());
            all.add(&vertex.colour);
        }
        scene.triangles().iter().flatten().for_each(|corner| all.add(&corner.to_le_bytes()));
        for sphere in scene.spheres() {
            all.numbers(&sphere.centre.to_array());
            all.numbers(&[sphere.radius]);
            all.add(&sphere.colour);
        }
        for structure in scene.structures() {
            let frame = if structure.frame == Frame::Head { "head" } else { "world" };
            let ranges = (&structure.vertices, &structure.triangles, &structure.spheres);
            all.add(format!("{frame} {ranges:?} {:?}", structure.hinge).as_bytes());
        }
        all.add(format!("{:?} {:?}", scene.lighting(), scene.motion().path()).as_bytes());
        all.add(&scene.motion().sway().scale.to_le_bytes());
        all
    }

    /// Of a value by what `Debug` shows of it.
    #[must_use]
    pub fn of_debug(value: &impl fmt::Debug) -> Self {
        let mut all = Self::default();
        // Adding bytes cannot fail.
        let _ = write!(all, "{value:?}");
        all
    }

    /// Adds a setting: its key and its value, written out.
    pub fn setting(&mut self, key: &str, value: impl fmt::Display) {
        // Adding bytes cannot fail.
        let _ = writeln!(self, "{key}={value}");
    }

    /// Adds bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |hash, byte| (hash ^ u128::from(*byte)).wrapping_mul(PRIME));
    }

    fn numbers(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|number| self.add(&number.to_le_bytes()));
    }
}

impl Write for Fingerprint {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.add(text.as_bytes());
        Ok(())
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
    fn it_agrees_with_the_published_vectors_of_fnv_1a() {
        // From the test vectors of the reference program (128 bits): "" and "a".
        assert_eq!(Fingerprint::of(b"").to_string(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(Fingerprint::of(b"a").to_string(), "d228cb696f1a8caf78912b704e4a8964");
    }

    #[test]
    fn a_scene_with_one_triangle_less_has_another_fingerprint() {
        let mig = pxpl5_scene::builtin("mig").expect("built in");
        let shorter = mig.truncated(416).expect("it has 417");
        assert_ne!(Fingerprint::of_scene(&mig), Fingerprint::of_scene(&shorter));
        assert_eq!(Fingerprint::of_scene(&mig), Fingerprint::of_scene(&mig.clone()));
    }
}
