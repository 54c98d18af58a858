//! Results of the display before an eye: the smear of lit pixels, and empty pixels after a device has moved pictures.

use crate::distribution::Distribution;
use crate::percentiles::Percentiles;
use pxpl5_run::{KEPT_SAMPLES, Reprojection, Warp};
use pxpl5_sim::Time;
use serde::Serialize;

/// Smear of the lit pixels, and results of a device that moves pictures.
///
/// The report exists if pixels are lit for more than an instant, or if a device moves pictures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EyeReport {
    /// Distance that the content of a pixel moves across the screen while the pixel is lit, in pixels. `None` if pixels
    /// are lit for an instant.
    pub smear_px: Option<Percentiles>,
    /// Results of the device that moves pictures. `None` if the display has no such device.
    pub reprojection: Option<ReprojectionReport>,
}

/// Results of a device that moves pictures to the newest pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReprojectionReport {
    /// Setting of the device: the method of moving, the part of a scan that gets one pose, and the latency.
    pub device: Reprojection,
    /// Number of pixels that the device computes per second for one eye.
    pub pixels_per_s: f64,
    /// Number of poses that the device uses per second.
    pub poses_per_s: f64,
    /// Age of the newest pose when the pixel is lit: time since the measurement of the pose, in milliseconds.
    pub pose_age_ms: Percentiles,
    /// Number of checked pixels. For each of these pixels, the evaluation searched the picture for the pixel's content.
    pub checked_pixels: u64,
    /// Share of the checked pixels, 0 to 1, whose content lies beyond the edge of the picture. `None` if no pixel was
    /// checked.
    pub empty_share: Option<f64>,
    /// Share of the checked pixels, 0 to 1, whose content is hidden by nearer objects in the picture. `None` unless the
    /// device uses depth.
    pub disoccluded_share: Option<f64>,
}

/// Setting of a device that moves pictures, and the numbers of pixels and poses per second that it needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Device {
    pub(crate) setting: Reprojection,
    pub(crate) pixels_per_s: f64,
    pub(crate) poses_per_s: f64,
}

#[derive(Debug)]
pub(crate) struct EyeSum {
    smear: Option<Distribution>,
    device: Option<Device>,
    age_ms: Distribution,
    checked: u64,
    beyond: u64,
    hidden: u64,
}

impl EyeSum {
    /// Creates empty sums. Percentiles of smears and of pose ages are exact for up to `limit` values each, which stay
    /// in memory. `smears` is true if pixels are lit for more than an instant.
    pub(crate) fn keeping(limit: usize, smears: bool, device: Option<Device>) -> Self {
        // The limit is the same in every run. Beyond the limit, numbers are summed in another way, which can change the
        // last digit of a mean.
        let limit = limit.min(KEPT_SAMPLES);
        let smear = smears.then(|| Distribution::keeping(limit));
        Self { smear, device, age_ms: Distribution::keeping(limit), checked: 0, beyond: 0, hidden: 0 }
    }

    pub(crate) fn smeared(&mut self, px: f64) {
        self.smear.iter_mut().for_each(|smear| smear.push(px));
    }

    pub(crate) fn pose(&mut self, measured_at: Option<Time>, light: Time) {
        if let Some(measured_at) = measured_at {
            self.age_ms.push((light.0 as f64 - measured_at.0 as f64) * 1e-9);
        }
    }

    /// Counts a pixel after the evaluation has searched the picture for the pixel's content.
    pub(crate) fn add_pixel(&mut self, is_beyond: bool, is_hidden: bool) {
        self.checked += 1;
        self.beyond += u64::from(is_beyond);
        self.hidden += u64::from(is_hidden);
    }

    /// Returns the report of the added values. `None` if pixels are lit for an instant only and no device moves
    /// pictures.
    pub(crate) fn result(self) -> Option<EyeReport> {
        let share = |count: u64| (self.checked > 0).then(|| count as f64 / self.checked as f64);
        let reprojection = self.device.map(|device| ReprojectionReport {
            device: device.setting,
            pixels_per_s: device.pixels_per_s,
            poses_per_s: device.poses_per_s,
            pose_age_ms: self.age_ms.percentiles(),
            checked_pixels: self.checked,
            empty_share: share(self.beyond),
            disoccluded_share: share(self.hidden).filter(|_| device.setting.by == Warp::Depth),
        });
        let smear_px = self.smear.map(|smear| smear.percentiles());
        (smear_px.is_some() || reprojection.is_some()).then_some(EyeReport { smear_px, reprojection })
    }
}
