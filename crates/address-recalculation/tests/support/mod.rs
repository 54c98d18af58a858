//! Faces and head orientations for tests.

pub(crate) mod bench;

use address_recalculation::{ArpConfig, CubeFace, DEPTH_FARTHEST, FaceSet, Orientation, TexelAddress, Vector};
use glam::DQuat;
use pxpl5_sim::SplitMix64;

pub(crate) fn turned(quaternion: DQuat) -> Orientation {
    Orientation::from_quaternion(quaternion.to_array()).expect("a rotation")
}

/// Returns the addresses of all texels of faces, including guard texels.
pub(crate) fn texels(size: u32) -> impl Iterator<Item = TexelAddress> {
    CubeFace::ALL.into_iter().flat_map(move |face| {
        (0..size).flat_map(move |row| (0..size).map(move |column| TexelAddress { face, column, row }))
    })
}

/// Returns faces of random colours. A third of the texels are empty, and many depths are equal.
pub(crate) fn noise(config: &ArpConfig, random: &mut SplitMix64) -> FaceSet {
    let mut faces = FaceSet::new(config.geometry().texels, config.format());
    for texel in texels(config.geometry().texels) {
        let bits = random.bits();
        let depth = match bits % 3 {
            0 => DEPTH_FARTHEST,
            1 => (bits >> 60) as u32 * 0x1111,
            _ => (bits >> 32) as u32 & DEPTH_FARTHEST,
        };
        faces.set(texel, bits as u32 >> 8, depth);
    }
    faces
}

/// Returns faces whose colour depends on the direction, at one depth.
pub(crate) fn painted(config: &ArpConfig, depth: u32, colour: impl Fn(Vector) -> u32) -> FaceSet {
    let geometry = config.geometry();
    let mut faces = FaceSet::new(geometry.texels, config.format());
    for texel in texels(geometry.texels) {
        faces.set(texel, colour(geometry.direction(texel)), depth);
    }
    faces
}
