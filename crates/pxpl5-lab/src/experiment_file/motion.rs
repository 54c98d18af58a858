//! The motion of the head in front of the scene. A head without a tracker follows this motion without delay.

use super::ExperimentFile;
use super::read::wrong;
use glam::Vec3;
use pxpl5_scene::config::{FIT_DISTANCE_RADII, MEAN_HEAD_SPEED_DEG_PER_S};
use pxpl5_scene::{HeadMotion, HeadPath, Scene, Sway};
use pxpl5_sim::parameters::SettingError;

/// A path of the head relative to the scene's centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PathChoice {
    /// The path that belongs to the scene.
    #[default]
    Scene,
    /// The head stands still in front of the scene.
    Still,
    /// The head faces the scene and moves back and forth.
    Look,
    /// The head circles around the scene.
    Orbit,
    /// The head stays in front of the scene and turns.
    Pan,
}

impl PathChoice {
    /// All paths with their names in experiment files.
    pub const ALL: [(&str, Self); 5] = [
        ("scene", Self::Scene),
        ("still", Self::Still),
        ("look", Self::Look),
        ("orbit", Self::Orbit),
        ("pan", Self::Pan),
    ];
}

pxpl5_sim::parameters::named!(PathChoice, "path of the head", PathChoice::ALL);

/// The motion of a head in front of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotionChoice {
    /// Path of the head.
    pub path: PathChoice,
    /// Distance from the scene's centre in metres, for the paths still, look and orbit. `None` means the distance at
    /// which the scene fits into the view.
    pub distance: Option<f64>,
    /// Rate of the turn in degrees per second, for the paths orbit and pan. `None` means the mean rate of recorded head
    /// motions.
    pub deg_per_s: Option<f64>,
    /// Factor on the head's random sway, 0 to 10. `None` means the default of the path.
    pub sway: Option<f64>,
}

const PATH: &str = "head.path";
const DISTANCE: &str = "head.distance";
const RATE: &str = "head.deg_per_s";
const SWAY: &str = "head.sway";

/// Keys of the motion in front of the scene. All other keys of the table `head` need a tracked head.
pub(super) const KEYS: [&str; 4] = [PATH, DISTANCE, RATE, SWAY];

impl MotionChoice {
    pub(super) fn read(file: &ExperimentFile) -> Result<Self, SettingError> {
        let path = file.choice(PATH, &PathChoice::ALL)?.unwrap_or_default();
        let takes_distance = !matches!(path, PathChoice::Scene | PathChoice::Pan);
        let takes_rate = matches!(path, PathChoice::Orbit | PathChoice::Pan);
        // A setting without effect is an error, not ignored.
        for (key, taken) in [(DISTANCE, takes_distance), (RATE, takes_rate)] {
            if let (Some(setting), false) = (file.get(key), taken) {
                return Err(wrong(key, setting, "nothing: this head.path does not take it"));
            }
        }
        let deg_per_s = file.number(RATE)?.or(takes_rate.then_some(MEAN_HEAD_SPEED_DEG_PER_S));
        Ok(Self { path, distance: file.number(DISTANCE)?, deg_per_s, sway: file.number(SWAY)? })
    }

    pub(super) fn motion(&self, scene: &Scene) -> Result<HeadMotion, SettingError> {
        let own = scene.motion();
        // If the path is replaced, the scene's own sway has no effect.
        let usual = match self.path {
            PathChoice::Scene => own.sway().scale,
            PathChoice::Look => 1.0,
            PathChoice::Still | PathChoice::Orbit | PathChoice::Pan => 0.0,
        };
        let sway = Sway { seed: own.sway().seed, scale: self.sway.unwrap_or(usual) };
        HeadMotion::new(self.path_around(scene), sway).map_err(|error| error.at("head"))
    }

    fn path_around(&self, scene: &Scene) -> HeadPath {
        let (target, radius) = scene.bounding_sphere();
        let distance = self.distance.unwrap_or(f64::from(radius) * FIT_DISTANCE_RADII);
        let deg_per_s = self.deg_per_s.unwrap_or(MEAN_HEAD_SPEED_DEG_PER_S);
        // The head begins on the +z side.
        let eye = target + Vec3::Z * distance as f32;
        match self.path {
            PathChoice::Scene => *scene.motion().path(),
            PathChoice::Still => HeadPath::Still { eye, target },
            PathChoice::Look => HeadPath::Look { target, distance },
            PathChoice::Orbit => HeadPath::Orbit { target, distance, height: 0.0, deg_per_s },
            PathChoice::Pan => HeadPath::Pan { eye, deg_per_s },
        }
    }
}
