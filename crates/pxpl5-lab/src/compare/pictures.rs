//! Pictures of a vertical edge while the head turns (pans), with conventional and with just-in-time pixels. The
//! pictures are shown as computed and as seen on the display.

use glam::{DVec2, DVec3, Vec3};
use image::{Rgb, RgbImage};
use pxpl5_framebuffer::{FrameBufferConfig, NtscDisplay, Video};
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Head, Jitp, Pixels, Viewpoint};
use pxpl5_scene::{HeadMotion, Lighting, Scene, SceneParts, Vertex};
use pxpl5_wire::{FieldParity, PeriodNumber};
use std::sync::Arc;
use tracking::motion::{Motion, Pan};
use tracking::predict::PredictorKind;
use tracking::time::span_s;
use tracking::tracker::TrackerConfig;
use tracking::view::Hmd;

/// Four pictures of one display field. Each has 640 x 240 pixels, with one row for each line of the field.
#[derive(Clone, Debug)]
pub struct EdgePictures {
    /// Picture in which all lines are drawn for one instant. The edge is vertical.
    pub conventional: RgbImage,
    /// The conventional picture as seen by an eye that turns during the scan. The edge is slanted.
    pub conventional_seen: RgbImage,
    /// Picture in which each line is drawn for the instant at which the display shows the line. The edge is slanted.
    pub just_in_time: RgbImage,
    /// The just-in-time picture as seen by an eye that turns during the scan. The edge is vertical.
    pub just_in_time_seen: RgbImage,
}

/// Number of the field in the pictures. At this field, the pipelines are full and the predictor has received many
/// reports.
const FIELD: PeriodNumber = PeriodNumber(40);

const DISTANCE_M: f32 = 2.0;

/// Returns a scene with a white wall on the left of a vertical edge, and nothing on the right of the edge. The edge
/// lies straight ahead (along -z). At the start, the viewer faces a direction `yaw_deg` to the left of the edge.
pub fn edge_scene(yaw_deg: f64) -> Scene {
    let vertex =
        |x: f32, y: f32| Vertex { position: Vec3::new(x, y, -DISTANCE_M), normal: Vec3::Z, colour: [255, 255, 255] };
    // The wall is far larger than the view, so only its right edge is visible.
    let vertices = vec![vertex(-9.0, -9.0), vertex(0.0, -9.0), vertex(0.0, 9.0), vertex(-9.0, 9.0)];
    // The pan starts beside the edge, so that the edge is in the middle at the evaluated field.
    let (sin, cos) = yaw_deg.to_radians().sin_cos();
    let target = DVec3::new(-sin, 0.0, -cos).as_vec3();
    let motion = HeadMotion::still(Vec3::ZERO, target);
    Scene::new(SceneParts {
        lighting: Lighting { background: [0; 3], ..Lighting::over_the_shoulder() },
        motion: motion.expect("a still head is in range"),
        ..SceneParts::of("edge", vertices, vec![[0, 1, 2], [0, 2, 3]])
    })
    .expect("a quadrangle is a scene")
}

/// Draws the vertical edge of the scene [`edge_scene`] on a machine while the head turns. The tracker is perfect and
/// the head's velocity is constant. The pictures therefore differ only in the instant for which each line is drawn.
///
/// # Errors
///
/// Fails in the same cases as [`Experiment::run`].
pub fn edge_pictures(config: &MachineConfig, deg_per_s: f64) -> Result<EdgePictures, ExperimentError> {
    let (conventional, conventional_seen) = draw(config, deg_per_s, Viewpoint::Field)?;
    let (just_in_time, just_in_time_seen) = draw(config, deg_per_s, Viewpoint::Strip)?;
    Ok(EdgePictures { conventional, conventional_seen, just_in_time, just_in_time_seen })
}

/// Returns two pictures of a field: as scanned by the display, and as seen by a turning eye.
fn draw(config: &MachineConfig, deg_per_s: f64, viewpoint: Viewpoint) -> Result<(RgbImage, RgbImage), ExperimentError> {
    let video = FrameBufferConfig::NTSC.video.video()?;
    // Start the pan so that the edge is in the middle of the screen in the middle of the field.
    let middle = video.when(320, 240 + FieldParity::of_field(FIELD).first_line(), FIELD).unwrap_or_default();
    let scene = edge_scene(-deg_per_s * middle.0 as f64 * 1e-12);
    let pan = Arc::new(Pan::at(deg_per_s));
    let head = Head::new(pan, TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1)?;
    let outcome = Experiment::new(config.clone(), Jitp::new(viewpoint, true), scene)
        .head(head)
        .fields(FIELD.after(2).since(PeriodNumber::FIRST))
        .pixels(Pixels::Lazy)
        .run()?;
    // Read the field as the display scanned it.
    let scanned = outcome.record().display_of_kind::<NtscDisplay>().and_then(|ntsc| ntsc.boards().first()?.seen(FIELD));
    let black = || RgbImage::new(video.width(), video.height() / 2);
    let picture = scanned.map_or_else(black, |field| field.picture());
    // Compute the picture that the turning eye sees.
    let seen = as_seen(&picture, FIELD, &video, &Pan::at(deg_per_s));
    Ok((picture, seen))
}

/// Converts a scanned field to the picture that a turning eye sees, with one row for each line of the field. Each pixel
/// moves to its position relative to the head at the instant at which the middle of the field is lit. Pixels without
/// content are black.
pub fn as_seen(picture: &RgbImage, field: PeriodNumber, video: &Video, motion: &dyn Motion) -> RgbImage {
    let view = Hmd::unc();
    let parity = FieldParity::of_field(field).first_line();
    let when = |x: u32, row: u32| video.when(x, 2 * row + parity, field).unwrap_or_default().0;
    let middle_ps = when(video.width() / 2, video.height() / 4);
    // A head turns by hundredths of a degree during a line, so the angular velocity at the middle serves the whole
    // field.
    let rate = motion.angular_velocity(middle_ps);
    let fixed = motion.pose(middle_ps);
    let of_head = fixed.orientation.conjugate() * rate;
    let moved = |x: u32, row: u32| {
        let place = DVec2::new(f64::from(x) + 0.5, f64::from(2 * row + parity) + 0.5);
        let flat = (place - view.centre_px()) / view.focal_px();
        let turn = tracking::rotation::exp(of_head * span_s(middle_ps, when(x, row)));
        let seen = view.project(turn * DVec3::new(flat.x, -flat.y, -1.0)).unwrap_or(place);
        seen - place
    };
    // Each pixel of the result is looked up at its position before the head's turn.
    RgbImage::from_fn(picture.width(), picture.height(), |x, row| {
        let way = moved(x, row);
        let from = (f64::from(x) - way.x, f64::from(row) - way.y / 2.0);
        let from_x = from.0.round();
        let from_row = from.1.round();
        let inside = from_x >= 0.0 && from_row >= 0.0;
        let pixel = inside.then(|| picture.get_pixel_checked(from_x as u32, from_row as u32)).flatten();
        pixel.copied().unwrap_or(Rgb([0; 3]))
    })
}
