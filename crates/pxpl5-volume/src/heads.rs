//! Comparison of two displays for a moving viewer: the volume, and a head-mounted display of the same latency.
//!
//! A volume does not move, so a moving viewer sees another side of the volume without delay. The errors of a volume
//! come from the positions of its voxels. A head-mounted display draws each picture for a past pose of the head, so its
//! errors come from its latency.
//!
//! # Behaviour
//!
//! - The volume stands upright in front of the head. The middle of the volume is `viewer.distance_mm` ahead of the
//!   start of the motion, and the +z axis points towards the head. Both displays show the same scene at the position of
//!   the volume.
//! - Errors are evaluated at [`POINTS`] vertices of the scene, for both eyes. For the head-mounted display, the error
//!   is the angle between the drawn and the true position of a point. The point was drawn for the pose one latency ago.
//!   For the volume, the error is the angle between a point and the voxel that shows the point in the nearest slice.
//! - Dither makes the level of a colour correct only on average over the square of pixels that the dither matrix
//!   covers. The study reports the visual angle of this square.
//! - In pictures, each eye looks at the middle of the volume, upright. The picture of the head-mounted display is drawn
//!   for the pose of the eye one latency ago. This picture is then shifted by the error of its middle.
//!
//! # Not modelled
//!
//! A predicting tracker, tracker noise, and the pixels of the head-mounted display (their angle is reported). Roll of
//! the head in pictures. The resolution of the eye.

use crate::experiment::Volume;
use crate::numbers::ViewerNumbers;
use crate::pictures::{EyeView, grid};
use glam::{DMat4, DQuat, DVec2, DVec3};
use image::{Rgb, RgbImage};
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;
use spatialgl::{
    Bin, Coverage, FlatDisplay, HostRenderer, SliceImage, SliceRenderer, SliceWork, SpatialDisplay, Workers,
};
use tracking::Pose;
use tracking::motion::Motion;
use tracking::view::{Hmd, HmdConfig};

/// Number of scene vertices at which errors are evaluated. The number is assumed to be large enough: more points would
/// not change the mean.
pub const POINTS: usize = 512;

const PS_PER_S: f64 = 1e12;

/// Errors of the volume and of the head-mounted display at one instant, over all points and both eyes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeadSample {
    /// Time since the motion began, seconds.
    pub time_s: f64,
    /// Azimuth of the head around the volume, from its +z axis to its +x axis, degrees.
    pub azimuth_deg: f64,
    /// Elevation of the head above the volume's middle, degrees.
    pub elevation_deg: f64,
    /// Distance of the head from the volume's middle, millimetres.
    pub distance_mm: f64,
    /// Mean angle between the drawn and the true position of a point on the head-mounted display, in degrees. `None` if
    /// every point is behind the eye.
    pub hmd_mean_deg: Option<f64>,
    /// Largest angle between the drawn and the true position of a point on the head-mounted display, in degrees.
    pub hmd_worst_deg: Option<f64>,
    /// Mean distance between drawn and true positions on the head-mounted display, in pixels of this display.
    pub hmd_mean_px: Option<f64>,
    /// Mean distance between drawn and true positions on the head-mounted display, in millimetres at the points'
    /// distance.
    pub hmd_mean_mm: Option<f64>,
    /// Mean angle between a point and the voxel that shows the point, in degrees.
    pub voxel_mean_deg: f64,
    /// Largest angle between a point and the voxel that shows the point, in degrees.
    pub voxel_worst_deg: f64,
    /// Mean distance between a point and the voxel that shows the point, in millimetres perpendicular to the line of
    /// sight.
    pub voxel_mean_mm: f64,
    /// Visual angle of the square of pixels that the dither matrix covers, at the middle of the volume, in degrees.
    pub dither_cell_deg: f64,
}

/// The errors of a volume and of a head-mounted display during a motion of the head.
#[derive(Clone, Debug, Serialize)]
pub struct HeadStudy {
    /// Name and version of the JSON layout of this data.
    pub schema: &'static str,
    /// Name of the scene that the volume and the head-mounted display show.
    pub scene: String,
    /// Latency of the head-mounted display, milliseconds.
    pub latency_ms: f64,
    /// Origin of the latency: "the volume's" if the head-mounted display has the latency of the volume, or "given" if
    /// the user chose the latency.
    pub latency_is: &'static str,
    /// Latency with which the volume shows changes of the scene, in milliseconds, or `None` if no GPU drew the volume.
    pub volume_latency_ms: Option<f64>,
    /// Visual angle of a pixel in the middle of the head-mounted display, in degrees.
    pub hmd_pixel_deg: f64,
    /// Length of a voxel's edge within a slice, millimetres.
    pub voxel_mm: f64,
    /// Errors at each instant. The first instant is one latency after the beginning of the motion.
    pub samples: Vec<HeadSample>,
}

/// The parameters of a study of a moving head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadStudyConfig {
    /// Latency of the head-mounted display, milliseconds, or `None` for the latency of the volume.
    pub latency_ms: Option<f64>,
    /// Duration of the study, in seconds.
    pub seconds: f64,
    /// Number of instants at which errors are evaluated, 2 or more.
    pub instants: u32,
}

/// A moving head in front of a volume, for the comparison of the volume with a head-mounted display.
#[derive(Debug)]
pub struct HeadComparison<'a> {
    volume: &'a Volume,
    motion: &'a dyn Motion,
    viewer: ViewerNumbers,
    /// Matrix from the world coordinates of the motion, in metres, to the coordinates of the volume, in pixels.
    into_volume: DMat4,
    latency_ps: u64,
    /// Points of the scene, each with the voxel that shows the point, in pixels of the volume.
    points: Vec<[DVec3; 2]>,
}

impl Volume {
    /// Returns the latency with which the volume shows changes of the scene, in milliseconds. The latency is the
    /// model's time for one volume, plus two mean waits. The first wait is half a turn until strobe 0 (the first flash
    /// of a turn). The second wait is a quarter turn until the screen reaches the changed plane. Returns `None` if the
    /// volume was not drawn by a GPU.
    pub fn latency_ms(&self) -> Option<f64> {
        let turn_ms = 60e3 / self.settings.display.spin_rpm as f64;
        let serial_hz = self.bounds.is_none().then(|| self.time().serial_hz())?;
        Some(1e3 / serial_hz + turn_ms * 0.75)
    }
}

impl<'a> HeadComparison<'a> {
    /// Places a volume in front of a moving head.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the latency is out of range (0 to 10,000 ms), or if it is missing.
    pub fn new(volume: &'a Volume, motion: &'a dyn Motion, latency_ms: Option<f64>) -> Result<Self, SettingError> {
        let wrong = |found: String| {
            let expected = "0 to 10000 ms, because no pipeline runs here that would give a latency";
            SettingError::value("latency", expected, found)
        };
        // The default is the latency of the volume itself.
        let latency_ms = latency_ms.or_else(|| volume.latency_ms()).ok_or_else(|| wrong("none".to_owned()))?;
        if !(0.0..=10_000.0).contains(&latency_ms) {
            return Err(wrong(latency_ms.to_string()));
        }
        let viewer = volume.settings.viewer;
        let points = points(volume);
        let latency_ps = (latency_ms * 1e9) as u64;
        Ok(Self { volume, motion, viewer, into_volume: placed(&motion.pose(0), volume, &viewer), latency_ps, points })
    }

    fn view(&self) -> Result<Hmd, SettingError> {
        let width = self.viewer.hmd_width_px as u32;
        let (width_px, height_px, horizontal_fov_deg) = (width, width * 3 / 4, self.viewer.hmd_angle_deg);
        Hmd::new(HmdConfig { width_px, height_px, horizontal_fov_deg, ..HmdConfig::unc() })
            .map_err(|error| SettingError::value("viewer", "a head-mounted display that can be", error))
    }

    fn millimetres_per_pixel(&self) -> f64 {
        self.viewer.diameter_mm / self.volume.settings.display.width as f64
    }

    /// Returns the pose of an eye. `side` is -1 for the left eye and 1 for the right eye.
    fn eye(&self, time_ps: u64, side: f64) -> Pose {
        let head = self.motion.pose(time_ps);
        let across = head.orientation * DVec3::X * (side * self.viewer.eye_separation_mm / 2e3);
        Pose { position: head.position + across, ..head }
    }

    /// Evaluates the errors at every instant.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the duration is out of range, if there are fewer than two instants, or if the
    /// head-mounted view is invalid.
    pub fn study(&self, question: &HeadStudyConfig) -> Result<HeadStudy, SettingError> {
        let view = self.view()?;
        let samples = self.instants(question)?.into_iter().map(|time_ps| self.sample(time_ps, &view)).collect();
        let volume_latency_ms = self.volume.latency_ms();
        let is_own = question.latency_ms.is_none();
        Ok(HeadStudy {
            schema: "pxpl5-volume-head/1",
            scene: self.volume.scene.clone(),
            latency_ms: self.latency_ps as f64 / 1e9,
            latency_is: if is_own { "the volume's" } else { "given" },
            volume_latency_ms,
            hmd_pixel_deg: (1.0 / view.focal_px()).atan().to_degrees(),
            voxel_mm: self.millimetres_per_pixel(),
            samples,
        })
    }

    fn instants(&self, question: &HeadStudyConfig) -> Result<Vec<u64>, SettingError> {
        let HeadStudyConfig { seconds, instants, .. } = *question;
        let wrong = |what, expected: &str, found: String| SettingError::value(what, expected, found);
        if !(seconds > 0.0 && seconds <= 3600.0) {
            return Err(wrong("length", "above 0 s and at most an hour", seconds.to_string()));
        }
        if instants < 2 {
            return Err(wrong("instants", "2 or more", instants.to_string()));
        }
        // The first instant must have a picture, which is drawn one latency earlier.
        let step = seconds * PS_PER_S / f64::from(instants - 1);
        Ok((0..instants).map(|i| self.latency_ps + (f64::from(i) * step) as u64).collect())
    }

    fn sample(&self, time_ps: u64, view: &Hmd) -> HeadSample {
        let mut hmd = Mean::default();
        let mut hmd_px = Mean::default();
        let mut hmd_mm = Mean::default();
        let mut voxel = Mean::default();
        let mut voxel_mm = Mean::default();
        let from_volume = self.into_volume.inverse();
        // Both displays are evaluated from the same eye positions.
        for side in [-1.0, 1.0] {
            let seen_from = self.eye(time_ps, side);
            let drawn_for = self.eye(time_ps - self.latency_ps, side);
            let eye = self.into_volume.transform_point3(seen_from.position);
            for [point, shown] in &self.points {
                let distance_mm = (*point - eye).length() * self.millimetres_per_pixel();
                let angle = angle_between(*point - eye, *shown - eye);
                voxel.add(angle.to_degrees());
                voxel_mm.add(angle * distance_mm);
                if let Some(error) =
                    view.misregistration_at(from_volume.transform_point3(*point), &drawn_for, &seen_from)
                {
                    hmd.add(error.degrees);
                    hmd_px.add(error.pixels);
                    hmd_mm.add(error.degrees.to_radians() * distance_mm);
                }
            }
        }
        let head = self.into_volume.transform_point3(self.motion.pose(time_ps).position);
        let [azimuth_deg, elevation_deg] = around(head);
        let cell = self.volume.settings.draw.matrix as f64 / head.length();
        HeadSample {
            time_s: time_ps as f64 / PS_PER_S,
            azimuth_deg,
            elevation_deg,
            distance_mm: head.length() * self.millimetres_per_pixel(),
            hmd_mean_deg: hmd.mean(),
            hmd_worst_deg: hmd.worst(),
            hmd_mean_px: hmd_px.mean(),
            hmd_mean_mm: hmd_mm.mean(),
            voxel_mean_deg: voxel.mean().unwrap_or(0.0),
            voxel_worst_deg: voxel.worst().unwrap_or(0.0),
            voxel_mean_mm: voxel_mm.mean().unwrap_or(0.0),
            dither_cell_deg: (cell / 2.0).atan().to_degrees() * 2.0,
        }
    }

    /// Returns the views of both eyes, left and right. The upper row shows the volume, and the lower row the
    /// head-mounted display. [`EyeView::picture`] describes `exposure`.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if `side` is not a multiple of 8, or if an eye is inside the display.
    pub fn picture(
        &self,
        time_ps: u64,
        side: u32,
        exposure: f64,
        workers: &dyn Workers,
    ) -> Result<RgbImage, SettingError> {
        let mut shown = Vec::new();
        for eye in [-1.0, 1.0] {
            shown.push(self.eye_view(time_ps, eye, side)?.picture(self.volume, Some(exposure), workers)?);
        }
        for eye in [-1.0, 1.0] {
            shown.push(self.head_mounted(time_ps, eye, side)?);
        }
        Ok(grid(&shown, 2))
    }

    /// Returns the exposure that suits the left eye's view at an instant. Exposure is the brightness of one lit pixel
    /// of the volume, and all pictures use the same exposure.
    pub fn exposure(&self, time_ps: u64, side: u32, workers: &dyn Workers) -> Result<f64, SettingError> {
        self.eye_view(time_ps, -1.0, side)?.exposure(self.volume, workers)
    }

    /// Returns the instants of the frames of a film.
    ///
    /// # Errors
    ///
    /// The same as [`Self::study`].
    pub fn film_instants(&self, question: &HeadStudyConfig, frames: u32) -> Result<Vec<u64>, SettingError> {
        self.instants(&HeadStudyConfig { instants: frames, ..*question })
    }

    fn eye_view(&self, time_ps: u64, side: f64, picture_px: u32) -> Result<EyeView, SettingError> {
        let eye = self.into_volume.transform_point3(self.eye(time_ps, side).position);
        let [azimuth_deg, elevation_deg] = around(eye);
        let mut view = EyeView::around(&self.volume.settings, azimuth_deg, elevation_deg, picture_px);
        view.camera.distance = eye.length();
        view.check(&self.volume.settings)?;
        Ok(view)
    }

    fn head_mounted(&self, time_ps: u64, side: f64, picture_px: u32) -> Result<RgbImage, SettingError> {
        let then = time_ps - self.latency_ps;
        // Draw the scene for the position of the eye one latency before.
        let view = self.eye_view(then, side, picture_px)?;
        let camera = view.camera;
        let azimuth = camera.azimuth_deg.to_radians();
        let elevation = camera.elevation_deg.to_radians();
        let display = FlatDisplay::around(camera.size, azimuth, elevation, camera.distance, camera.focal)?;
        let commands = &self.volume.commands;
        let bin = Bin::new(commands, (0..commands.primitives() as u32).collect());
        let mut drawn = SliceImage::new(camera.size);
        let work = SliceWork { commands, bin: &bin, coverage: Coverage::Sampled };
        HostRenderer.render(work, &display.views()[0], &mut drawn);
        // Shift the picture by the angle that its middle has moved since then.
        let middle = self.into_volume.inverse().transform_point3(DVec3::ZERO);
        let then = direction(&self.eye(then, side), middle);
        let now = direction(&self.eye(time_ps, side), middle);
        let dark = RgbImage::new(picture_px, picture_px);
        let (Some(then), Some(now)) = (then, now) else { return Ok(dark) };
        Ok(moved(&drawn, (then - now) * camera.focal))
    }
}

/// Returns the position of a point in a flat picture seen from the head. The picture has focal length 1, with x to the
/// right and y down. Returns `None` if the point is behind the head.
fn direction(head: &Pose, point: DVec3) -> Option<DVec2> {
    let seen = head.view_of(point);
    (seen.z < -1e-6).then(|| DVec2::new(seen.x, -seen.y) / -seen.z)
}

fn moved(image: &SliceImage, by: DVec2) -> RgbImage {
    let [width, height] = image.size();
    let by = by.round();
    RgbImage::from_fn(width, height, |x, y| {
        let source = DVec2::new(f64::from(x), f64::from(y)) - by;
        let inside = source.cmpge(DVec2::ZERO).all() && source.x < f64::from(width) && source.y < f64::from(height);
        Rgb(if inside { image.pixel(source.x as u32, source.y as u32) } else { [0; 3] })
    })
}

/// Returns the matrix from world coordinates in metres to coordinates of an upright volume in pixels. The volume stands
/// in front of the head.
fn placed(head: &Pose, volume: &Volume, viewer: &ViewerNumbers) -> DMat4 {
    let ahead = head.orientation * DVec3::NEG_Z;
    let yaw = DQuat::from_rotation_y(libm::atan2(-ahead.x, -ahead.z));
    let middle = head.position + yaw * DVec3::NEG_Z * (viewer.distance_mm / 1e3);
    let pixels_per_metre = volume.settings.display.width as f64 / viewer.diameter_mm * 1e3;
    let turn = DMat4::from_quat(yaw.conjugate());
    DMat4::from_scale(DVec3::splat(pixels_per_metre)) * turn * DMat4::from_translation(-middle)
}

/// Returns azimuth and elevation of a position in degrees. The azimuth runs from +z to +x, and the elevation is above
/// the horizon.
fn around(place: DVec3) -> [f64; 2] {
    let level = libm::hypot(place.x, place.z);
    [libm::atan2(place.x, place.z).to_degrees(), libm::atan2(place.y, level).to_degrees()]
}

/// Returns vertices of the scene that the display can show, each with the voxel that shows the vertex. The vertices are
/// evenly spread over the scene's list of vertices.
fn points(volume: &Volume) -> Vec<[DVec3; 2]> {
    let shown: Vec<DVec3> = volume
        .commands
        .positions()
        .iter()
        .map(|position| DVec3::from_array(*position))
        .filter(|point| volume.display.shows(*point))
        .collect();
    let step = shown.len().div_ceil(POINTS).max(1);
    shown.iter().step_by(step).filter_map(|point| Some([*point, voxel_of(volume, *point)?])).collect()
}

/// Returns the voxel that shows a point: the middle of the pixel in the nearest slice of the first half turn.
fn voxel_of(volume: &Volume, point: DVec3) -> Option<DVec3> {
    let views = volume.display.views();
    let half = &views[..views.len().div_ceil(2)];
    let off = |view: &spatialgl::SliceView| view.local(point).z.abs();
    let nearest = half.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let clip = nearest.projection * nearest.local(point).extend(1.0);
    let half_size = volume.display.target_size().map(|side| f64::from(side) / 2.0);
    let u = (clip.x / clip.w * half_size[0]).floor() + 0.5;
    let v = (clip.y / clip.w * half_size[1]).floor() + 0.5;
    Some(nearest.view.inverse().transform_point3(DVec3::new(u, v, 0.0)))
}

fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    most: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.most = self.most.max(value);
        self.count += 1;
    }

    fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }

    fn worst(&self) -> Option<f64> {
        (self.count > 0).then_some(self.most)
    }
}
