//! Head motion in a scene: the pose of a head at any simulated time. The same seed gives the same motion on every
//! computer.

use glam::{DMat3, DQuat, DVec3, Vec3};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use tracking::Pose;

use crate::config::{FIT_DISTANCE_RADII, WHOLE_DISTANCE_RADII};
use crate::sway::{self, Sway, Swing};
use crate::trig;

/// Greatest coordinate, distance or rate in the numbers of a motion. Assumed: enough for any run, and no product
/// overflows.
const LIMIT: f64 = 1e9;

/// The path of a head, to which sway can be added. Lengths are in metres, angles in degrees, and coordinates in the
/// world.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum HeadPath {
    /// The head stands still at `eye` and looks at `target`.
    Still {
        /// Position of the head in the world, metres.
        eye: Vec3,
        /// Point at which the head looks, metres, world coordinates.
        target: Vec3,
    },
    /// The head stands at `eye` and turns to the left (about +y) at a constant rate. At time 0 the head looks along -z.
    Pan {
        /// Position of the head in the world, metres.
        eye: Vec3,
        /// Turning rate of the head, degrees per second. A negative rate turns right.
        deg_per_s: f64,
    },
    /// The head circles around `target` in a horizontal plane and always looks at `target`. At time 0 the head is on
    /// the +z side.
    Orbit {
        /// Point at which the head looks, metres, world coordinates.
        target: Vec3,
        /// Radius of the circle, metres.
        distance: f64,
        /// Height of the circle above the target, metres.
        height: f64,
        /// Angular rate on the circle, degrees per second. With a positive rate the head moves towards +x first.
        deg_per_s: f64,
    },
    /// The head looks at `target` from the +z side. The added [`Sway`] moves the head around the target and changes the
    /// distance.
    Look {
        /// Point at which the head looks, metres, world coordinates.
        target: Vec3,
        /// Mean distance from the target, metres.
        distance: f64,
    },
    /// The head flies around `target` and always looks at `target`. The distance alternates between near and far, with
    /// five approaches in two laps.
    FlyThrough {
        /// Point at which the head looks, metres, world coordinates.
        target: Vec3,
        /// Least distance from the target, metres.
        nearest: f64,
        /// Greatest distance from the target, metres.
        farthest: f64,
        /// Duration of one lap around the target, seconds.
        lap_s: f64,
    },
}

/// The motion of a head: a path with added sway.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked", into = "Unchecked")]
pub struct HeadMotion {
    path: HeadPath,
    sway: Sway,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked {
    path: HeadPath,
    sway: Sway,
}

impl TryFrom<Unchecked> for HeadMotion {
    type Error = SettingError;

    fn try_from(unchecked: Unchecked) -> Result<Self, SettingError> {
        Self::new(unchecked.path, unchecked.sway)
    }
}

impl From<HeadMotion> for Unchecked {
    fn from(motion: HeadMotion) -> Self {
        Self { path: motion.path, sway: motion.sway }
    }
}

impl HeadMotion {
    /// The motion of a head that stands still at the origin and looks along -z.
    pub(crate) const STILL: Self =
        Self { path: HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z }, sway: Sway::none() };

    /// Creates the motion of a head that stands still at `eye` and looks at `target`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`HeadMotion::new`].
    pub fn still(eye: Vec3, target: Vec3) -> Result<Self, SettingError> {
        Self::new(HeadPath::Still { eye, target }, Sway::none())
    }

    /// Creates a motion after checking its numbers.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first number out of its range.
    pub fn new(path: HeadPath, sway: Sway) -> Result<Self, SettingError> {
        path.check()?;
        SettingError::require((0.0..=10.0).contains(&sway.scale), "sway scale", "0 to 10", sway.scale)?;
        Ok(Self { path, sway })
    }

    /// Creates the motion of a head that looks at a model with the published head speeds. The path is
    /// [`HeadPath::Look`], with sway of scale 1 and seed 1.
    ///
    /// The distance from `centre` is [`crate::config::FIT_DISTANCE_RADII`] times `radius` (metres). A model within
    /// `radius` of `centre` then roughly fills the default view.
    pub fn looking_at(centre: Vec3, radius: f64) -> Self {
        let path = HeadPath::Look { target: centre, distance: radius * FIT_DISTANCE_RADII };
        Self { path, sway: Sway { seed: 1, scale: 1.0 } }
    }

    /// Creates the motion of a head that looks at a model. The distance is so large that both eyes always see the whole
    /// model, with any seed. The distance is [`crate::config::WHOLE_DISTANCE_RADII`] times `radius` (metres).
    pub fn always_visible(centre: Vec3, radius: f64) -> Self {
        let path = HeadPath::Look { target: centre, distance: radius * WHOLE_DISTANCE_RADII };
        Self { path, sway: Sway { seed: 1, scale: 1.0 } }
    }

    /// Returns the path of the head without sway.
    pub fn path(&self) -> &HeadPath {
        &self.path
    }

    /// Returns the sway that is added to the path.
    pub fn sway(&self) -> &Sway {
        &self.sway
    }

    /// Returns the same motion with the seed `seed` for its sway.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.sway.seed = seed;
        self
    }

    /// Returns the pose of the head at simulated time `time_ps`, in picoseconds.
    ///
    /// The pose is computed in double precision with software trigonometry. The pose is then rounded to single
    /// precision, as are all coordinates of a scene. The time is exact to 2 ns after 200 days.
    pub fn pose(&self, time_ps: u64) -> Pose {
        let seconds = time_ps as f64 * 1e-12;
        let swing = self.sway.swing_at(seconds);
        let (eye, gaze) = self.path.eye_and_gaze(seconds, &swing);
        let exact = Pose { position: eye, orientation: (gaze * swing.gaze()).normalize() };
        exact.in_single_precision()
    }
}

impl HeadPath {
    fn check(&self) -> Result<(), SettingError> {
        match *self {
            HeadPath::Still { eye, target } => {
                check_point("eye", eye)?;
                check_point("target", target)
            }
            HeadPath::Pan { eye, deg_per_s } => {
                check_point("eye", eye)?;
                check_either_sign("deg_per_s", deg_per_s)
            }
            HeadPath::Orbit { target, distance, height, deg_per_s } => {
                check_point("target", target)?;
                check_length("distance", distance)?;
                check_either_sign("height", height)?;
                check_either_sign("deg_per_s", deg_per_s)
            }
            HeadPath::Look { target, distance } => {
                check_point("target", target)?;
                check_length("distance", distance)
            }
            HeadPath::FlyThrough { target, nearest, farthest, lap_s } => {
                check_point("target", target)?;
                check_length("nearest", nearest)?;
                SettingError::require(farthest >= nearest, "farthest", "at least nearest", farthest)?;
                check_length("farthest", farthest)?;
                check_length("lap_s", lap_s)
            }
        }
    }

    /// Returns the position of the head, and the orientation towards its target. The sway of the gaze is not included.
    fn eye_and_gaze(&self, seconds: f64, swing: &Swing) -> (DVec3, DQuat) {
        match *self {
            HeadPath::Still { eye, target } => facing(eye.as_dvec3(), target.as_dvec3()),
            // A pan is the only path whose gaze has no target point.
            HeadPath::Pan { eye, deg_per_s } => (eye.as_dvec3(), sway::turn_about(DVec3::Y, deg_per_s * seconds)),
            HeadPath::Orbit { target, distance, height, deg_per_s } => {
                let arm = direction(deg_per_s * seconds, 0.0) * distance + DVec3::Y * height;
                facing(target.as_dvec3() + arm, target.as_dvec3())
            }
            HeadPath::Look { target, distance } => {
                let arm = direction(swing.azimuth_deg, swing.elevation_deg) * distance;
                let target = target.as_dvec3();
                facing(target + arm * swing.distance_factor, target)
            }
            HeadPath::FlyThrough { target, nearest, farthest, lap_s } => {
                let arm = fly_through_arm(seconds / lap_s, nearest, farthest);
                facing(target.as_dvec3() + arm, target.as_dvec3())
            }
        }
    }
}

fn check_point(what: &'static str, point: Vec3) -> Result<(), SettingError> {
    // The maximum of a vector's elements ignores NaN, so NaN is tested separately.
    let reach = if point.is_nan() { f64::NAN } else { f64::from(point.abs().max_element()) };
    SettingError::require(reach <= LIMIT, what, "coordinates of at most 1e9", reach)
}

/// Checks that a distance or duration is above zero and within the limit.
fn check_length(what: &'static str, length: f64) -> Result<(), SettingError> {
    SettingError::require((1e-9..=LIMIT).contains(&length), what, "1e-9 to 1e9", length)
}

/// Checks that a height or rate, which may be negative, is within the limit.
fn check_either_sign(what: &'static str, number: f64) -> Result<(), SettingError> {
    SettingError::require(number.abs() <= LIMIT, what, "-1e9 to 1e9", number)
}

/// Returns the vector from the target to the head after a number of laps. A lap has two and a half approaches to the
/// target, each from a different side and height.
fn fly_through_arm(laps: f64, nearest: f64, farthest: f64) -> DVec3 {
    let middle = (farthest + nearest) / 2.0;
    let half = (farthest - nearest) / 2.0;
    let distance = middle + half * trig::cos_turns(2.5 * laps);
    let elevation_deg = 12.0 + 28.0 * trig::sin_turns(1.5 * laps);
    direction(360.0 * laps, elevation_deg) * distance
}

/// Returns a unit vector that is rotated by `azimuth_deg` from +z towards +x and then raised by `elevation_deg`.
fn direction(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let (sin_a, cos_a) = trig::sin_cos_deg(azimuth_deg);
    let (sin_e, cos_e) = trig::sin_cos_deg(elevation_deg);
    DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e)
}

/// Returns the position and orientation of an upright head at `eye` that looks at `target`. If both positions are
/// equal, the head looks along -z. If the head looks straight up, its lower side points towards +z.
fn facing(eye: DVec3, target: DVec3) -> (DVec3, DQuat) {
    let back = (eye - target).normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    let axes = DMat3::from_cols(right, back.cross(right), back);
    (eye, DQuat::from_mat3(&axes).normalize())
}
