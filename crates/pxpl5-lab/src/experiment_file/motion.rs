//! The head motion of an experiment in which the head has no tracker.

use super::ExperimentFile;
use super::read::wrong;
use glam::Vec3;
use pxpl5_scene::config::FIT_DISTANCE_RADII;
use pxpl5_scene::{HeadMotion, HeadPath, Scene, Sway};
use pxpl5_sim::parameters::SettingError;

/// The motion of a head without a tracker, in front of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionChoice {
    /// Path of the head. `None` for the scene's own path.
    pub path: Option<PathChoice>,
    /// Scale factor of the head's random sway, 0 to 10. `None` for the default of the path.
    pub sway: Option<f64>,
}

/// A path of the head relative to the scene's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathChoice {
    /// The head stands still in front of the scene.
    Still {
        /// Distance from the scene's centre in metres. `None` fits the scene into the view.
        distance: Option<f64>,
    },
    /// The head faces the scene and moves back and forth.
    Look {
        /// Distance from the scene's centre in metres. `None` fits the scene into the view.
        distance: Option<f64>,
    },
    /// The head circles around the scene.
    Orbit {
        /// Distance from the scene's centre in metres. `None` fits the scene into the view.
        distance: Option<f64>,
        /// Rate of the circular motion in degrees per second.
        deg_per_s: f64,
    },
    /// The head stays in front of the scene and turns.
    Pan {
        /// Rate of the head's turn in degrees per second.
        deg_per_s: f64,
    },
}

/// Default rate of a turning head in degrees per second: the mean of recorded head motion (see `pxpl5_scene::config`).
const DEG_PER_S: f64 = pxpl5_scene::config::MEAN_HEAD_SPEED_DEG_PER_S;

impl MotionChoice {
    pub(super) fn read(file: &ExperimentFile) -> Result<Self, SettingError> {
        let distance = file.number("motion.distance")?;
        let rate = file.number("motion.deg_per_s")?;
        let deg_per_s = rate.unwrap_or(DEG_PER_S);
        let paths = [
            ("scene", None),
            ("still", Some(PathChoice::Still { distance })),
            ("look", Some(PathChoice::Look { distance })),
            ("orbit", Some(PathChoice::Orbit { distance, deg_per_s })),
            ("pan", Some(PathChoice::Pan { deg_per_s })),
        ];
        let path = file.choice("motion.path", &paths)?.flatten();
        let takes_distance = !matches!(path, None | Some(PathChoice::Pan { .. }));
        let takes_rate = matches!(path, Some(PathChoice::Orbit { .. } | PathChoice::Pan { .. }));
        // A setting without effect is an error, not ignored.
        for (key, taken) in [("motion.distance", takes_distance), ("motion.deg_per_s", takes_rate)] {
            if let (Some(setting), false) = (file.get(key), taken) {
                return Err(wrong(key, setting, "nothing: this motion.path does not take it"));
            }
        }
        Ok(Self { path, sway: file.number("motion.sway")? })
    }

    pub(super) fn motion(&self, scene: &Scene) -> Result<HeadMotion, SettingError> {
        let own = scene.motion();
        let path = self.path.map_or(*own.path(), |path| path.around(scene));
        // A replaced path loses the scene's own sway.
        let own_scale = if self.path.is_none() { own.sway().scale } else { 0.0 };
        let scale = match self.path {
            Some(PathChoice::Look { .. }) => self.sway.unwrap_or(1.0),
            _ => self.sway.unwrap_or(own_scale),
        };
        HeadMotion::new(path, Sway { seed: own.sway().seed, scale }).map_err(|error| error.at("motion"))
    }
}

impl PathChoice {
    fn around(self, scene: &Scene) -> HeadPath {
        let (target, radius) = scene.bounding_sphere();
        let fitted = f64::from(radius) * FIT_DISTANCE_RADII;
        match self {
            Self::Still { distance } => HeadPath::Still { eye: before(target, distance.unwrap_or(fitted)), target },
            Self::Look { distance } => HeadPath::Look { target, distance: distance.unwrap_or(fitted) },
            Self::Orbit { distance, deg_per_s } => {
                HeadPath::Orbit { target, distance: distance.unwrap_or(fitted), height: 0.0, deg_per_s }
            }
            Self::Pan { deg_per_s } => HeadPath::Pan { eye: before(target, fitted), deg_per_s },
        }
    }
}

fn before(target: Vec3, distance: f64) -> Vec3 {
    target + Vec3::Z * distance as f32
}
