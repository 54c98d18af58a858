//! Estimates of memory and time before a command starts. [`pxpl5::lab::estimate`] estimates runs. The formulas here
//! estimate volumes and walks. A volume is a scene drawn as slices for the spinning volumetric display. A walk is a
//! sequence of frames along a path of the viewer.
//!
//! The formulas use these quantities. Each constant in capital letters is defined and explained below.
//!
//! - `area = width * height` is the number of pixels of a slice.
//! - `drawn = ROWS * slices * width + AREAS * area` is the number of pixels that triangles and spheres touch.
//! - `targets` is the number of slices that all threads together draw at a time.
//! - `samples` is the number of samples for each pixel, as set by the user.
//! - `texels = 6 * face_texels * face_texels` is the number of texels of six cube faces.
//!
//! | estimate | formula |
//! |---|---|
//! | bytes of a volume, part 1 | `BASE + slices * area / 2 + SAMPLE * drawn` |
//! | bytes of a volume, part 2 | `targets * area * TARGET * samples + PRIMITIVE * primitives` |
//! | seconds to draw a volume | `samples * (SLICE_S * slices * primitives + DRAWN_S * drawn)` |
//! | seconds to pack a volume | `WORD_S * slices * area / 8` |
//! | bytes of a walk | `BASE + TEXEL * texels + FRAME * frames + WALKED * primitives` |
//! | seconds of a walk | `FACE_S * texels + FRAME_S * frames * primitives` |
//!
//! The memory of a volume includes all bits of all slices, although the operating system may allocate only pages with
//! data. If simulated renderers of Pixel-Planes 5 draw the volume, drawing takes `PLANES` times as long, and the memory
//! grows by `PLANES_BYTES`. The estimate multiplies all times by `BUSY`.
//!
//! The constants come from measured runs, which the tests below repeat: peak memory and processor time, rounded up.

use pxpl5::arp::WalkPlan;
use pxpl5::lab::estimate::{BASE, BUSY, PRIMITIVE};
pub(crate) use pxpl5::lab::estimate::{Estimate, RunWork, Study};
use pxpl5::scene::Scene;
use pxpl5::volume::{RendererKind, VolumeSettings};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VolumeWork {
    pub(crate) slices: u64,
    pub(crate) width: u64,
    pub(crate) height: u64,
    pub(crate) batch: u64,
    pub(crate) samples: u64,
    pub(crate) primitives: u64,
    pub(crate) threads: u64,
    pub(crate) is_pixel_planes: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WalkWork {
    pub(crate) frames: u64,
    pub(crate) primitives: u64,
    /// Number of texels along one edge of a cube face.
    pub(crate) face_texels: u64,
    /// True if the command also draws the pictures of the walk.
    pub(crate) has_pictures: bool,
}

/// Bytes for each pixel in the buffer of a slice while the slice is drawn: three colour channels and one stencil bit.
const TARGET: f64 = 3.125;
/// Bytes for one pixel that a triangle or sphere covers, including unused capacity of the list of covered pixels.
const SAMPLE: f64 = 12.0;
/// Estimated number of pixels that triangles and spheres touch in each column of a slice.
const ROWS: f64 = 2.0;
/// Estimated number of touched pixels in addition to `ROWS`, over all slices together, in multiples of the pixels of
/// one slice.
const AREAS: f64 = 2.0;
/// Seconds to process one primitive for one slice.
const SLICE_S: f64 = 30e-9;
/// Seconds to process one covered pixel.
const DRAWN_S: f64 = 100e-9;
/// Seconds to pack eight pixels of a slice into a byte, and to read this byte.
const WORD_S: f64 = 1e-9;

/// Factor on the time if simulated renderers of Pixel-Planes 5 draw the volume.
const PLANES: f64 = 15.0;
/// Memory in bytes of the simulated pixel arrays of Pixel-Planes 5.
const PLANES_BYTES: f64 = 60e6;

/// Bytes for one texel of a cube face.
const TEXEL: f64 = 10.0;
/// Bytes for one frame of a walk.
const FRAME: f64 = 3e3;
/// Bytes for one primitive of the scene of a walk.
const WALKED: f64 = 2e3;
/// Seconds to process one texel of a cube face.
const FACE_S: f64 = 15e-9;
/// Seconds to process one primitive for one frame of a walk.
const FRAME_S: f64 = 65e-9;
/// Bytes for one texel of a cube face in the pictures of a walk.
const DRAWN_TEXEL: f64 = 90.0;
/// Seconds to draw the pictures of a walk without its frames and texels.
const PICTURES_S: f64 = 0.5;
/// Seconds to draw one texel of a cube face for the pictures of a walk.
const DRAWN_FACE_S: f64 = 150e-9;
/// Seconds to process one primitive for one frame for the pictures of a walk.
const DRAWN_FRAME_S: f64 = 600e-9;

impl VolumeWork {
    /// Returns the quantities that determine the cost of a volume, which `threads` threads draw. The settings must be
    /// valid.
    pub(crate) fn of(settings: &VolumeSettings, scene: &Scene, threads: usize) -> Self {
        Self {
            slices: settings.display.slices,
            width: settings.display.width,
            height: settings.display.height,
            batch: settings.tile.batch,
            samples: settings.draw.samples,
            primitives: scene.primitives() as u64,
            threads: threads as u64,
            is_pixel_planes: settings.renderer == RendererKind::PixelPlanes,
        }
    }

    pub(crate) fn estimate(&self) -> Estimate {
        let [slices, width, height] = [self.slices, self.width, self.height].map(|number| number as f64);
        let [samples, primitives] = [self.samples, self.primitives].map(|number| number as f64);
        let area = width * height;
        let drawn = ROWS * slices * width + AREAS * area;
        // One thread draws a batch of slices, so threads beyond the number of batches are idle.
        let targets = (self.threads * self.batch).min(self.slices) as f64;
        let bytes =
            BASE + slices * area / 2.0 + SAMPLE * drawn + targets * area * TARGET * samples + PRIMITIVE * primitives;
        let (bytes, times) = if self.is_pixel_planes { (bytes + PLANES_BYTES, PLANES) } else { (bytes, 1.0) };
        let seconds =
            times * samples * (SLICE_S * slices * primitives + DRAWN_S * drawn) + WORD_S * slices * area / 8.0;
        Estimate { bytes, seconds: BUSY * seconds }
    }
}

impl WalkWork {
    pub(crate) fn of(plan: &WalkPlan, scene: &Scene, has_pictures: bool) -> Self {
        let face_texels = plan.settings().map_or(0, |settings| settings.display.timing.face_texels);
        Self { frames: plan.walk.frames, primitives: scene.primitives() as u64, face_texels, has_pictures }
    }

    pub(crate) fn estimate(&self) -> Estimate {
        let [frames, primitives] = [self.frames, self.primitives].map(|number| number as f64);
        let texels = 6.0 * (self.face_texels as f64).powi(2);
        let bytes = BASE + TEXEL * texels + FRAME * frames + WALKED * primitives;
        let seconds = FACE_S * texels + FRAME_S * frames * primitives;
        let (more_bytes, more_seconds) = match self.has_pictures {
            true => (DRAWN_TEXEL * texels, PICTURES_S + DRAWN_FACE_S * texels + DRAWN_FRAME_S * frames * primitives),
            false => (0.0, 0.0),
        };
        Estimate { bytes: bytes + more_bytes, seconds: BUSY * (seconds + more_seconds) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: VolumeWork = VolumeWork {
        slices: 396,
        width: 768,
        height: 768,
        batch: 4,
        samples: 1,
        primitives: 59_592,
        threads: 1,
        is_pixel_planes: false,
    };
    const MIG: VolumeWork = VolumeWork { primitives: 417, ..PAPER };

    /// Measured costs of the command `volume`. Each row has the work, the peak memory in MB (`ru_maxrss`), and the CPU
    /// time in seconds (`ru_utime + ru_stime`). The program was compiled with opt-level 1.
    const VOLUMES: [(VolumeWork, f64, f64); 9] = [
        (PAPER, 127.4, 0.85),
        (MIG, 36.0, 0.21),
        (VolumeWork { slices: 40, ..PAPER }, 47.5, 0.34),
        (VolumeWork { slices: 4, width: 2048, height: 2048, ..PAPER }, 92.0, 0.44),
        (VolumeWork { slices: 1024, width: 1024, height: 1024, ..PAPER }, 452.4, 1.95),
        (VolumeWork { slices: 1024, width: 256, height: 256, ..MIG }, 25.8, 0.15),
        (VolumeWork { samples: 4, ..PAPER }, 138.3, 2.96),
        (VolumeWork { samples: 16, ..MIG }, 68.4, 2.23),
        (VolumeWork { slices: 198, is_pixel_planes: true, ..MIG }, 97.3, 5.4),
    ];

    /// Measured costs as in `VOLUMES`, of volumes that were not used to fit the constants of the estimates. The scenes
    /// are molecules, a head, a sphere and the Mig. The program was compiled with the profile `dist`.
    const HELD_OUT: [(VolumeWork, f64, f64); 4] = [
        (VolumeWork { primitives: 3_839, ..PAPER }, 178.9, 1.06),
        (VolumeWork { slices: 800, width: 512, height: 512, ..PAPER }, 112.6, 0.52),
        (VolumeWork { slices: 200, width: 1024, height: 512, primitives: 10_000, ..PAPER }, 73.7, 0.11),
        (VolumeWork { slices: 600, samples: 4, ..MIG }, 48.6, 0.56),
    ];

    /// Measured costs of walks: the work, the peak memory in MB, and the processor time in seconds, measured like
    /// [`VOLUMES`].
    const WALKS: [(WalkWork, f64, f64); 8] = [
        (WALK, 36.8, 0.05),
        (WalkWork { frames: 1_800, ..WALK }, 41.6, 0.13),
        (WalkWork { frames: 600, primitives: 1_480, ..WALK }, 36.5, 0.09),
        (WalkWork { frames: 60, face_texels: 2_048, ..WALK }, 251.2, 0.38),
        // With pictures, in a program of the profile `dev`.
        (WalkWork { frames: 600, has_pictures: true, ..WALK }, 194.9, 2.03),
        (WalkWork { frames: 3_000, has_pictures: true, ..WALK }, 199.6, 4.76),
        (WalkWork { frames: 600, primitives: 1_480, has_pictures: true, ..WALK }, 195.3, 2.45),
        (WalkWork { frames: 60, face_texels: 2_048, has_pictures: true, ..WALK }, 2_031.9, 7.46),
    ];
    const WALK: WalkWork = WalkWork { frames: 120, primitives: 740, face_texels: 512, has_pictures: false };

    /// Tests that estimates of memory are from 0.8 to 5 times the measured memory. An estimate may be too high, because
    /// the process reserves memory for dark slices and does not use it.
    #[test]
    fn estimates_of_memory_are_0_8_to_5_times_the_memory_of_volumes_and_walks() {
        let volumes =
            VOLUMES.iter().map(|(work, megabytes, _)| (format!("{work:?}"), work.estimate().bytes, *megabytes));
        let walks = WALKS.iter().map(|(work, megabytes, _)| (format!("{work:?}"), work.estimate().bytes, *megabytes));
        for (work, bytes, megabytes) in volumes.chain(walks) {
            let ratio = bytes / 1e6 / megabytes;
            assert!((0.8..5.0).contains(&ratio), "{work}: {ratio} times {megabytes} MB");
        }
    }

    #[test]
    fn the_time_of_volumes_and_walks_is_estimated_within_a_factor_of_five() {
        let volumes = VOLUMES.iter().map(|(work, _, seconds)| (format!("{work:?}"), work.estimate().seconds, *seconds));
        let walks = WALKS.iter().map(|(work, _, seconds)| (format!("{work:?}"), work.estimate().seconds, *seconds));
        for (work, estimated, seconds) in volumes.chain(walks) {
            let ratio = estimated / seconds;
            assert!((0.2..5.0).contains(&ratio), "{work}: {ratio} times {seconds} s");
        }
    }

    /// Tests the estimates on volumes that were not used to fit the constants.
    ///
    /// An estimate of memory may be too high by the bits of all slices. The process reserves memory for dark slices and
    /// does not use it. An estimate of time may be up to 12 times too high, because programs of the profile
    /// `dist` are faster.
    #[test]
    fn estimates_hold_for_volumes_outside_the_calibration() {
        for (work, megabytes, seconds) in HELD_OUT {
            let Estimate { bytes, seconds: estimated } = work.estimate();
            let bits = (work.slices * work.width * work.height) as f64 / 2e6;
            let (memory, time) = (bytes / 1e6, estimated / seconds);
            assert!(
                (0.8 * megabytes..2.0 * megabytes + bits).contains(&memory),
                "{work:?}: {memory} for {megabytes} MB"
            );
            assert!((0.5..12.0).contains(&time), "{work:?}: {time} times {seconds} s");
        }
    }
}
