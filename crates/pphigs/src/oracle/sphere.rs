//! Values of a sphere at a pixel: silhouette, square root and depth.

use crate::oracle::shade::two_s_complement;
use crate::oracle::widths::{ROOT_BITS, Widths};
use pxpl5_geometry::{GouraudSphere, SphereSetup};
use pxpl5_wire::format::COLOUR_FRACTION_BITS;

/// Number of upper bits of the square root from which a colour is computed.
const COLOUR_ROOT_BITS: u32 = 8;
const NORMAL_ROOT_BITS: u32 = 10;

/// Depth of a sphere at a pixel, and the square root from which depth and shading are computed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpherePoint {
    pub(crate) depth: u32,
    /// Square root of the silhouette expression, rounded down.
    root: u32,
    root_bits: u32,
}

impl SpherePoint {
    pub(crate) fn at(setup: &SphereSetup, x: i32, y: i32, widths: Widths) -> Option<Self> {
        let silhouette = u64::try_from(setup.silhouette.at(x, y)).ok()?;
        let missing = ROOT_BITS - widths.root_bits;
        let radicand = silhouette >> (u32::from(setup.root_shift) + 2 * missing) & ((1 << (2 * widths.root_bits)) - 1);
        let root = radicand.isqrt() as u32;
        let bulge = u64::from(root) << (u32::from(setup.depth_shift) + missing);
        let depth = (setup.depth.at(x, y) as u32).wrapping_sub(bulge as u32);
        Some(Self { depth: widths.stored_depth(depth), root, root_bits: widths.root_bits })
    }

    fn upper_root(&self, bits: u32) -> i32 {
        (self.root >> (self.root_bits - bits)) as i32
    }

    /// Returns the colour at a pixel: limit(linear + (upper bits of the root x factor >> 8)). A sum of 10 bits is
    /// limited to 8 bits.
    pub(crate) fn colour(&self, sphere: &GouraudSphere, x: i32, y: i32) -> [u8; 3] {
        let root = self.upper_root(COLOUR_ROOT_BITS);
        std::array::from_fn(|i| {
            let rise = (root * i32::from(sphere.root_factor[i].min(511))) >> 8;
            let sum = rise.wrapping_add(sphere.rgb[i].at(x, y) >> COLOUR_FRACTION_BITS);
            two_s_complement(sum, 10).clamp(0, 255) as u8
        })
    }

    pub(crate) fn normal_z(&self) -> i32 {
        self.upper_root(NORMAL_ROOT_BITS)
    }
}
