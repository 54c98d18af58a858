use super::ExperimentFile;
use super::motion::MotionChoice;
use super::read::{beside, wrong};
use glam::{Mat4, Vec3};
use pxpl5_scene::{Edit, Format, Placement, Scene};
use pxpl5_sim::parameters::SettingError;
use std::path::Path;
use std::sync::Arc;

/// The scene of an experiment: its name or file, its number of primitives, and the motion of the head in front of the
/// scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneChoice {
    /// Name of a built-in scene, or path of a model file.
    pub name: String,
    /// Placement of a model file: fitted into the view, or at its own coordinates. Built-in scenes are never moved.
    pub placement: Placement,
    /// Number of primitives to which the scene is reduced. `None` keeps all primitives.
    pub triangles: Option<usize>,
    /// True if the back faces of all structures of the scene are removed.
    pub culled: bool,
    /// Place, size and surroundings of the scene.
    pub model: ModelPlace,
    /// Motion of the head without a tracker.
    pub motion: MotionChoice,
    /// Contents of the model file ([`ExperimentFile::with_contents`]), which replace the file on this computer.
    pub contents: Option<Arc<[u8]>>,
}

/// The place of a scene in its world: the keys `model.*`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModelPlace {
    /// Coordinates of the middle of the scene's bounding box in metres. `None` keeps a coordinate.
    pub at_m: [Option<f64>; 3],
    /// Length of the longest side of the bounding box in metres. `None` keeps the size.
    pub size_m: Option<f64>,
    /// Turn about the vertical axis in degrees, to the left as seen from above.
    pub turn_deg: Option<f64>,
    /// True if the scene `room` is added, whose walls surround the viewer.
    pub in_room: bool,
}

/// Distance of the walls of the scene `room` from the viewer, m.
const ROOM_WALL_M: f32 = 2.0;
/// Distance of the walls that `model.room` adds, relative to the farthest point of the scene, and at least in metres
/// (assumed, so that a viewer can walk).
const BEHIND_THE_SCENE: f32 = 1.5;
const MIN_WALL_M: f32 = 4.0;

const AT: [&str; 3] = ["model.x", "model.y", "model.z"];

impl ModelPlace {
    fn read(file: &ExperimentFile) -> Result<Self, SettingError> {
        let number = |key: &str| file.number(key);
        Ok(Self {
            at_m: [number(AT[0])?, number(AT[1])?, number(AT[2])?],
            size_m: number("model.size")?,
            turn_deg: number("model.turn")?,
            in_room: file.flag("model.room")?.unwrap_or(false),
        })
    }

    fn of(&self, scene: Arc<Scene>) -> Result<Arc<Scene>, SettingError> {
        if *self == Self::default() {
            return Ok(scene);
        }
        let placed = scene.placed(self.at_m, self.size_m, self.turn_deg.unwrap_or(0.0));
        if !self.in_room {
            return Ok(Arc::new(placed));
        }
        // The walls stand around the start of the viewer, behind the scene.
        let viewer = placed.motion().pose(0).position.as_vec3();
        let (middle, radius) = placed.bounding_sphere();
        let size = ((viewer.distance(middle) + radius) * BEHIND_THE_SCENE).max(MIN_WALL_M) / ROOM_WALL_M;
        let model = Mat4::from_translation(viewer) * Mat4::from_scale(Vec3::splat(size));
        let room = pxpl5_scene::builtin("room")?.posed(&[Edit { structure: 0, model }]);
        let whole = placed.together_with(&room)?;
        Ok(Arc::new(whole))
    }
}

impl SceneChoice {
    pub(super) fn read(file: &ExperimentFile) -> Result<Self, SettingError> {
        let how = "a built-in scene (`pxpl5 scenes` lists them) or a model file (.ply, .obj, .stl, .pdb, .gltf, .glb)";
        let name = file.text("scene")?.ok_or_else(|| SettingError::missing("scene", how))?;
        let folder = file.get("scene").map(|setting| setting.folder.clone()).unwrap_or_default();
        let name = if is_file(name) { beside(&folder, name) } else { name.to_owned() };
        let triangles = file.whole("triangles")?.map(|n| n as usize);
        let placement = if file.flag("fit")?.unwrap_or(true) { Placement::Fitted } else { Placement::AsInFile };
        // The key `fit` is an error for built-in scenes, because they are in the view already.
        if let (Some(setting), false) = (file.get("fit"), is_file(&name)) {
            return Err(wrong("fit", setting, "nothing: only model files are fitted into the view"));
        }
        let culled = file.flag("cull")?.unwrap_or(false);
        let contents = file.contents(&name).cloned();
        let model = ModelPlace::read(file)?;
        Ok(Self { name, placement, triangles, culled, model, motion: MotionChoice::read(file)?, contents })
    }

    /// Generates the scene or reads its file.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for an unknown scene or an unusable file.
    pub fn load(&self) -> Result<Arc<Scene>, SettingError> {
        self.prepared(Arc::new(self.load_whole()?))
    }

    /// Returns the corners of the scene's closed path. The list is empty for a model file, which has no path.
    pub(super) fn path(&self) -> Result<Vec<glam::Vec3>, SettingError> {
        if is_file(&self.name) { Ok(Vec::new()) } else { Ok(pxpl5_scene::builtin(&self.name)?.path().to_vec()) }
    }

    pub(crate) fn load_whole(&self) -> Result<Scene, SettingError> {
        let whole = match (&self.contents, Format::of_path(Path::new(&self.name))) {
            (Some(bytes), Some(format)) => pxpl5_scene::placed_from_bytes(bytes, format, &self.name, self.placement)?,
            _ if is_file(&self.name) => pxpl5_scene::load_placed(&self.name, self.placement)?,
            _ => pxpl5_scene::builtin(&self.name)?,
        };
        Ok(if self.culled { whole.culled() } else { whole })
    }

    /// Returns the scene `whole` with the number of primitives and the head motion of these settings.
    pub(crate) fn prepared(&self, whole: Arc<Scene>) -> Result<Arc<Scene>, SettingError> {
        let decimated = whole.clone();
        self.prepared_by(whole, |n| decimated.decimated(n))
    }

    /// Prepares the scene as [`prepared`](Self::prepared) does, but reduces the number of primitives with the function
    /// `decimated`.
    pub(crate) fn prepared_by(
        &self,
        whole: Arc<Scene>,
        decimated: impl FnOnce(usize) -> Result<Scene, SettingError>,
    ) -> Result<Arc<Scene>, SettingError> {
        // A scene with no more primitives than requested is drawn whole.
        let scene = match self.triangles {
            Some(n) if n < whole.primitives() => Arc::new(decimated(n)?),
            _ => whole,
        };
        let scene = self.model.of(scene)?;
        // The scene's own motion needs no copy of the scene.
        if self.motion == MotionChoice::default() {
            return Ok(scene);
        }
        let motion = self.motion.motion(&scene)?;
        let warnings = scene.warnings().to_vec();
        let parts = Arc::unwrap_or_clone(scene).into_parts();
        Ok(Arc::new(Scene::new(pxpl5_scene::SceneParts { motion, ..parts })?.with_warnings(warnings)))
    }
}

/// Returns true if a scene's name is the path of a file, which contains a separator or a file extension. A file
/// extension has a letter. The built-in scene `typical:1.5` has no file extension, because no letter follows its dot.
pub(crate) fn is_file(name: &str) -> bool {
    let extension = Path::new(name).extension().map(|end| end.to_string_lossy().contains(char::is_alphabetic));
    name.contains(['/', std::path::MAIN_SEPARATOR]) || extension == Some(true)
}
