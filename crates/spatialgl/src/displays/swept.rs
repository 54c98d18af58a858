//! A screen that rotates about the axis y and shows a slice at each of N angles.

use crate::angle::sin_cos_of_turn;
use crate::bin::BinLayout;
use crate::clip::{HalfWedge, SliceClip};
use crate::projection::{Projection, Size, matrix_of_rows};
use crate::slice_volume::{TieRule, WedgePlanes};
use crate::view::{PixelFormat, SliceView, SpatialDisplay};
use glam::{DMat4, DVec3};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// The direction in which the screen spins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    #[default]
    XToZ,
    ZToX,
}

impl Rotation {
    pub const ALL: [(&'static str, Self); 2] = [("x-to-z", Self::XToZ), ("z-to-x", Self::ZToX)];
}

pxpl5_sim::parameters::named!(Rotation, "sense of rotation", Rotation::ALL);

/// The parameters of a display that sweeps a volume with a spinning screen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweptConfig {
    /// Number of slices per turn, which must be even.
    pub slices: u32,
    /// Width of an image in pixels, a multiple of 8. Half of the width is the radius of the display.
    pub width: u32,
    pub height: u32,
    /// Angle of slice 0, radians.
    pub phase: f64,
    pub rotation: Rotation,
    pub clip: SliceClip,
    /// Rule for points that lie exactly in the planes between slices.
    pub ties: TieRule,
    /// Number of fraction bits in the evaluation of boundary planes, or `None` for double precision.
    pub plane_fraction_bits: Option<u32>,
    pub projection: Projection,
}

impl SweptConfig {
    /// Returns the display of the SpatialGL paper with this clip and projection: 396 slices (published) of 768 x 768
    /// pixels (assumed).
    pub const fn perspecta(clip: SliceClip, projection: Projection) -> Self {
        Self {
            slices: 396,
            width: 768,
            height: 768,
            phase: 0.0,
            rotation: Rotation::XToZ,
            clip,
            ties: TieRule::HalfOpen,
            plane_fraction_bits: None,
            projection,
        }
    }

    /// Returns the radius of the display in pixels, which is half the width of the image.
    pub fn radius(&self) -> f64 {
        f64::from(self.width) / 2.0
    }

    pub fn half_wedge(&self) -> HalfWedge {
        HalfWedge::new(self.slices, self.radius())
    }

    fn check(&self) -> Result<(), SettingError> {
        let slices = self.slices;
        SettingError::require((4..=65_536).contains(&slices), "display.slices", "4 to 65536", slices)?;
        SettingError::require(slices.is_multiple_of(2), "display.slices", "an even number", slices)?;
        let width = self.width;
        SettingError::require((8..=4096).contains(&width), "display.width", "8 to 4096", width)?;
        SettingError::require(width.is_multiple_of(8), "display.width", "a multiple of 8", width)?;
        SettingError::require((1..=4096).contains(&self.height), "display.height", "1 to 4096", self.height)?;
        SettingError::require(self.phase.is_finite(), "display.phase", "a finite angle", self.phase)?;
        // Clip and projection depend on the display's radius.
        let bits = self.plane_fraction_bits.unwrap_or(0);
        SettingError::require(bits <= 52, "clip.plane_fraction_bits", "0 to 52", bits)?;
        let wedge = self.half_wedge();
        self.clip.check(wedge)?;
        self.projection.check(wedge.radius, self.clip.reach(wedge))
    }
}

/// A display whose slices are arranged around an axis, with any number of slices.
#[derive(Clone, Debug)]
pub struct SweptDisplay {
    config: SweptConfig,
    views: Vec<SliceView>,
    bins: BinLayout,
}

impl SweptDisplay {
    /// Creates the views of all slices, with their slice volumes, eyes and bins.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the invalid number, the expected range and the found value.
    pub fn new(config: SweptConfig) -> Result<Self, SettingError> {
        config.check()?;
        let bins = BinLayout::double_wedges(config.clip.tolerance(config.half_wedge()));
        let views = (0..config.slices).map(|k| view(&config, k)).collect();
        Ok(Self { config, views, bins })
    }

    pub const fn config(&self) -> &SweptConfig {
        &self.config
    }
}

impl SpatialDisplay for SweptDisplay {
    fn views(&self) -> &[SliceView] {
        &self.views
    }

    fn target_size(&self) -> Size {
        [self.config.width, self.config.height]
    }

    fn pixel_format(&self) -> PixelFormat {
        PixelFormat::Rgb1
    }

    fn bins(&self) -> BinLayout {
        self.bins.clone()
    }

    fn shows(&self, point: DVec3) -> bool {
        let radius = self.config.radius();
        let half_height = f64::from(self.config.height) / 2.0;
        point.x * point.x + point.z * point.z <= radius * radius && point.y.abs() <= half_height
    }
}

fn view(config: &SweptConfig, k: u32) -> SliceView {
    let size = [config.width, config.height];
    let wedge = config.half_wedge();
    let reach = config.clip.reach(wedge);
    // The rows rotate the world by the angle of slice k about y.
    let (sin, cos) = direction(config, 2 * i64::from(k));
    let rows = [[cos, 0.0, sin, 0.0], [0.0, 1.0, 0.0, 0.0], [-sin, 0.0, cos, 0.0], [0.0, 0.0, 0.0, 1.0]];
    let eye = config.projection.eye(k, wedge.radius, reach);
    // A small tolerance prevents rounding errors from rejecting primitives that touch the slice.
    let slack = reach * (1.0 + 1e-9) + 1e-6;
    let volume = config.clip.volume(boundaries(config, k), config.ties, wedge);
    let view: DMat4 = matrix_of_rows(rows);
    SliceView {
        view,
        projection: eye.clip_matrix(size, reach),
        volume,
        bins: double_wedges(config, k),
        hides: false,
        window: eye.window_rows(size, reach),
        reach: Some([-slack, slack]),
        magnification: 1.0,
    }
}

/// Returns sine and cosine of an angle around the axis. The angle is counted from slice 0, in steps of half the angle
/// between slices.
///
/// They are computed for only one of two opposite directions, so these are exact negatives of each other, for every
/// angle of slice 0.
fn direction(config: &SweptConfig, half_slices: i64) -> (f64, f64) {
    let signed = if config.rotation == Rotation::XToZ { half_slices } else { -half_slices };
    if config.phase == 0.0 {
        return sin_cos_of_turn(signed, 2 * config.slices);
    }
    let half_turn = i64::from(config.slices);
    let within = signed.rem_euclid(half_turn);
    let is_turned = signed.div_euclid(half_turn).rem_euclid(2) == 1;
    let angle = std::f64::consts::PI * within as f64 / half_turn as f64 + config.phase;
    let (sin, cos) = libm::sincos(angle);
    if is_turned { (-sin, -cos) } else { (sin, cos) }
}

/// Returns the two boundary planes of slice k. Plane A is L_k, and plane B is -L_(k+1), with L_k(p) = z cos b_k - x sin
/// b_k. The angle b_k is the angle of slice k minus half the angle between slices.
fn boundaries(config: &SweptConfig, k: u32) -> WedgePlanes {
    let (sin, cos) = direction(config, 2 * i64::from(k) - 1);
    let (next_sin, next_cos) = direction(config, 2 * i64::from(k) + 1);
    let fraction_bits = config.plane_fraction_bits;
    match config.rotation {
        Rotation::XToZ => WedgePlanes { a: [-sin, cos], b: [next_sin, -next_cos], fraction_bits },
        Rotation::ZToX => WedgePlanes { a: [sin, -cos], b: [-next_sin, next_cos], fraction_bits },
    }
}

/// Returns the bins that the wedge of slice `k` overlaps, one bit each. A bin is a double wedge of 45 degrees.
fn double_wedges(config: &SweptConfig, k: u32) -> u64 {
    let slices = f64::from(config.slices);
    let centre = if config.rotation == Rotation::XToZ { f64::from(k) } else { -f64::from(k) };
    let phase_slices = config.phase / std::f64::consts::TAU * slices;
    let eighth = |boundary: f64| 8.0 * (centre + boundary + phase_slices) / slices;
    let first = (eighth(-0.5) + 1e-12).floor() as i64;
    let last = (eighth(0.5) - 1e-12).ceil() as i64;
    let overlapped = (first..last.max(first + 1)).take(4);
    overlapped.fold(0, |bins, j| bins | 1 << j.rem_euclid(4))
}
