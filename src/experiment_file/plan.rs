//! A checked experiment.

use super::head::HeadChoice;
use super::motion::MotionChoice;
use super::read::wrong;
use super::{ExperimentFile, FileError, keys};
use crate::config::MachineConfig;
use crate::experiment::{Experiment, FIELDS_RANGE, Pixels};
use crate::head_to_light::FIELDS_WITH_HEAD;
use crate::levels::{Level, Program};
use crate::measure::Measure;
use crate::pipelines::{Code, Frameless, Interpolation, Jitp, RenderingControl, Slats, Viewpoint};
use pphigs::{Binning, Shading};
use pxpl5_scene::Scene;
use slats::CopySchedule;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The pipelines by name, each as its papers describe it.
pub const PIPELINES: [(&str, Program); 11] = [
    ("rendering-control", Program::RenderingControl(RenderingControl::stereo())),
    ("slats", Program::Slats(Slats::split())),
    ("frameless", Program::Frameless(Frameless::new())),
    ("jitp-field", jitp(Viewpoint::Field, false)),
    ("jitp-field-racing", jitp(Viewpoint::Field, true)),
    ("jitp-scanline", jitp(Viewpoint::Strip, false)),
    ("jitp-scanline-racing", jitp(Viewpoint::Strip, true)),
    ("jitp-dual-screen", jitp(Viewpoint::Dual(Interpolation::Screen), false)),
    ("jitp-dual-screen-racing", jitp(Viewpoint::Dual(Interpolation::Screen), true)),
    ("jitp-dual-view", jitp(Viewpoint::Dual(Interpolation::View), false)),
    ("jitp-dual-view-racing", jitp(Viewpoint::Dual(Interpolation::View), true)),
];

const fn jitp(viewpoint: Viewpoint, racing: bool) -> Program {
    Program::Jitp(Jitp::new(viewpoint, racing))
}

impl Program {
    /// Its pipeline's name, as in [`PIPELINES`].
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.pipeline().name()
    }

    /// The name that it shares with its variants.
    #[must_use]
    pub const fn family(&self) -> &'static str {
        match self {
            Self::RenderingControl(_) => "rendering-control",
            Self::Slats(_) => "slats",
            Self::Jitp(_) => "jitp",
            Self::Frameless(_) => "frameless",
        }
    }

    /// The preset of the machine on which its papers ran it, or could have.
    #[must_use]
    pub const fn preset(&self) -> &'static str {
        match self {
            Self::Slats(_) => "slats",
            Self::RenderingControl(_) | Self::Jitp(_) | Self::Frameless(_) => "small-hmd",
        }
    }

    /// Whether all of a picture is drawn for one pose, so that a raster can be shifted by what that was wrong.
    #[must_use]
    pub const fn has_one_pose(&self) -> bool {
        match self {
            Self::RenderingControl(_) | Self::Slats(_) => true,
            Self::Jitp(jitp) => matches!(jitp.viewpoint, Viewpoint::Field),
            Self::Frameless(_) => false,
        }
    }

    fn read(file: &ExperimentFile) -> Result<Self, FileError> {
        let missing = FileError::Missing { key: "pipeline", how: "a pipeline, such as slats" };
        let program = file.choice("pipeline", &PIPELINES)?.ok_or(missing)?;
        program.refuse_others(file)?;
        Ok(match program {
            Self::RenderingControl(default) => Self::RenderingControl(RenderingControl {
                mono: file.flag("mono")?.unwrap_or(default.mono),
                shading: file.choice("shading", &SHADINGS)?.unwrap_or(default.shading),
            }),
            Self::Slats(default) => Self::Slats(Slats {
                copy: file.choice("copy", &COPIES)?.unwrap_or(default.copy),
                binning: file.choice("binning", &BINNINGS)?.unwrap_or(default.binning),
                code: file.choice("code", &CODES)?,
            }),
            Self::Jitp(default) => {
                let rows = file.integer("strip_rows", 1..=128)?;
                Self::Jitp(Jitp { strip_rows: rows.map_or(default.strip_rows, |rows| rows as u32), ..default })
            }
            Self::Frameless(default) => Self::Frameless(Frameless {
                block: file.integer("block", 4..=128)?.map_or(default.block, |pixels| pixels as u32),
                batch: file.integer("batch", 0..=u64::from(u16::MAX))?.map_or(default.batch, |blocks| blocks as u32),
                seed: file.integer("order_seed", 0..=MAX_SEED)?.unwrap_or(default.seed),
            }),
        })
    }

    /// Keys of other pipelines.
    fn refuse_others(&self, file: &ExperimentFile) -> Result<(), FileError> {
        for (path, setting) in &file.settings {
            let applies_to = keys::find(path).and_then(|key| key.applies_to);
            if let Some(applies_to) = applies_to.filter(|family| *family != self.family()) {
                let (place, key) = (setting.place.clone(), path.clone());
                return Err(FileError::NotApplicable { place, key, pipeline: self.name(), applies_to });
            }
        }
        Ok(())
    }
}

pub(super) const SHADINGS: [(&str, Shading); 2] = [("phong", Shading::Phong), ("gouraud", Shading::Gouraud)];
pub(super) const COPIES: [(&str, CopySchedule); 3] =
    [("whole", CopySchedule::Whole), ("split", CopySchedule::Split), ("backup", CopySchedule::Backup)];
pub(super) const BINNINGS: [(&str, Binning); 2] = [("all", Binning::All), ("touched", Binning::Touched)];
pub(super) const CODES: [(&str, Code); 3] =
    [("1994", Code::Of1994), ("1995", Code::Of1995), ("optimised", Code::Optimised)];
pub(super) const PIXELS: [(&str, Pixels); 3] = [("off", Pixels::Off), ("lazy", Pixels::Lazy), ("all", Pixels::All)];

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneChoice {
    /// A built-in scene's name or a model file's path.
    pub name: String,
    /// How many primitives are kept; `None` for all.
    pub triangles: Option<usize>,
    /// How the head moves.
    pub motion: MotionChoice,
}

/// Extensions of model files.
const MODEL_FILES: [&str; 4] = ["ply", "obj", "pdb", "ent"];

impl SceneChoice {
    fn read(file: &ExperimentFile) -> Result<Self, FileError> {
        let how = "a built-in scene (`pxpl5 scenes` lists them) or a model file (.ply, .obj, .pdb)";
        let name = file.text("scene")?.ok_or(FileError::Missing { key: "scene", how })?;
        let folder = file.get("scene").map(|setting| setting.folder.clone()).unwrap_or_default();
        let name = if is_file(name) { beside(&folder, name) } else { name.to_owned() };
        let triangles = file.integer("triangles", 1..=u64::from(u32::MAX))?.map(|n| n as usize);
        Ok(Self { name, triangles, motion: MotionChoice::read(file)? })
    }

    /// Generates it or reads its file.
    ///
    /// # Errors
    ///
    /// [`FileError`] for an unknown scene, an unusable file, or more primitives to keep than there are.
    pub fn load(&self) -> Result<Arc<Scene>, FileError> {
        self.prepared(Arc::new(self.load_whole()?))
    }

    pub(crate) fn load_whole(&self) -> Result<Scene, FileError> {
        Ok(if is_file(&self.name) { pxpl5_scene::load(&self.name)? } else { pxpl5_scene::builtin(&self.name)? })
    }

    /// The whole scene cut and moved as chosen.
    pub(crate) fn prepared(&self, whole: Arc<Scene>) -> Result<Arc<Scene>, FileError> {
        let scene = match self.triangles {
            Some(n) => Arc::new(whole.truncated(n)?),
            None => whole,
        };
        if self.motion == MotionChoice::default() {
            return Ok(scene);
        }
        let motion = self.motion.motion(&scene)?;
        let parts = Arc::unwrap_or_clone(scene).into_parts();
        Ok(Arc::new(Scene::new(pxpl5_scene::SceneParts { motion, ..parts })?))
    }
}

/// Whether a scene's name is a path: it has a model file's extension, or a separator.
fn is_file(name: &str) -> bool {
    let extension = Path::new(name).extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    name.contains(['/', std::path::MAIN_SEPARATOR]) || extension.is_some_and(|e| MODEL_FILES.contains(&e.as_str()))
}

pub(super) fn beside(folder: &Path, name: &str) -> String {
    let path: PathBuf = folder.join(name);
    path.display().to_string()
}

/// What a run writes beside its report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The last pictures, PNG.
    pub pictures: bool,
    /// A timeline, SVG.
    pub timeline: bool,
    /// The measured quantities, CSV.
    pub csv: bool,
}

/// The published figure that an experiment reproduces.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// Its number, if it has one.
    pub figure: Option<u64>,
    /// The paper.
    pub source: Option<String>,
    /// Which measured quantity it is about.
    pub quantity: Measure,
    /// Its value.
    pub value: f64,
}

impl Published {
    fn read(file: &ExperimentFile) -> Result<Option<Self>, FileError> {
        let Some(value) = file.number("published.value")? else { return Ok(None) };
        let missing = FileError::Missing { key: "published.quantity", how: "the quantity that was published" };
        let name = file.text("published.quantity")?.ok_or(missing)?;
        let quantity = measure(file, "published.quantity", name)?;
        let source = file.text("published.source")?.map(str::to_owned);
        Ok(Some(Self { figure: file.integer("published.figure", 0..=999)?, source, quantity, value }))
    }
}

fn measure(file: &ExperimentFile, key: &str, name: &str) -> Result<Measure, FileError> {
    let wrong = |nearest: &str| match file.get(key) {
        Some(setting) => wrong(key, setting, &format!("a quantity that is measured (the nearest is {nearest})")),
        None => FileError::Missing { key: "measure", how: "quantities that are measured" },
    };
    Measure::named(name).map_err(wrong)
}

/// A checked experiment: everything is known, nothing contradicts.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// A line for people.
    pub title: Option<String>,
    /// The pipeline.
    pub program: Program,
    /// The machine.
    pub machine: MachineConfig,
    /// The scene.
    pub scene: SceneChoice,
    /// Fields to simulate; default 120.
    pub fields: u64,
    /// Seed of the head motion; default 1.
    pub seed: u64,
    /// Level of modelling; default transaction.
    pub level: Level,
    /// The head with its tracker; default the scene's own motion, seen without delay.
    pub head: Option<HeadChoice>,
    /// Which pixels are computed; default those that are looked at.
    pub pixels: Pixels,
    /// Quantities for tables and rows.
    pub measure: Vec<Measure>,
    /// What is written.
    pub output: Outputs,
    /// What it is compared with.
    pub published: Option<Published>,
}

/// Seeds that TOML can write.
const MAX_SEED: u64 = i64::MAX as u64;

impl ExperimentFile {
    /// Checks all settings together.
    ///
    /// # Errors
    ///
    /// [`FileError`] names the first setting that is wrong or missing.
    pub fn resolve(&self) -> Result<Plan, FileError> {
        let program = Program::read(self)?;
        let seed = self.integer("seed", 0..=MAX_SEED)?.unwrap_or(1);
        let head = HeadChoice::read(self, &program, seed)?;
        let most_fields = if head.is_some() { FIELDS_WITH_HEAD } else { FIELDS_RANGE.1 };
        let names = self.texts("measure")?;
        let measure = |names: Vec<String>| names.iter().map(|name| measure(self, "measure", name)).collect();
        Ok(Plan {
            title: self.text("title")?.map(str::to_owned),
            program,
            machine: self.machine(&program)?,
            scene: SceneChoice::read(self)?,
            fields: self.integer("fields", FIELDS_RANGE.0..=most_fields)?.unwrap_or(120),
            seed,
            level: self.level(&program, head.is_some())?,
            head,
            pixels: self.choice("pixels", &PIXELS)?.unwrap_or(Pixels::Lazy),
            measure: names.map_or_else(|| Ok(Measure::usual()), measure)?,
            output: Outputs {
                pictures: self.flag("output.pictures")?.unwrap_or(true),
                timeline: self.flag("output.timeline")?.unwrap_or(true),
                csv: self.flag("output.csv")?.unwrap_or(true),
            },
            published: Published::read(self)?,
        })
    }

    fn level(&self, program: &Program, has_head: bool) -> Result<Level, FileError> {
        let choices = Level::ALL.map(|level| (level.name(), level));
        let level = self.choice("level", &choices)?.unwrap_or(Level::Transaction);
        let has_form = matches!(program, Program::RenderingControl(_) | Program::Slats(_)) && !has_head;
        match self.get("level").filter(|_| level == Level::Analytic && !has_form) {
            Some(setting) => Err(wrong("level", setting, "transaction or cycle for this pipeline or a head.motion")),
            None => Ok(level),
        }
    }

    fn machine(&self, program: &Program) -> Result<MachineConfig, FileError> {
        let config = |place: &str| {
            let place = place.to_owned();
            move |error| FileError::Config { place, error }
        };
        let preset = self.text("machine.preset")?.unwrap_or(program.preset());
        let place = self.get("machine.preset").map_or("machine", |setting| &setting.place);
        let machine = MachineConfig::preset(preset).map_err(config(place))?;
        let mut machine = program.pipeline().adapt(machine);
        let adapted = machine.parameters();
        for (path, setting) in &self.settings {
            let Some(parameter) = path.strip_prefix("machine.").filter(|path| *path != "preset") else { continue };
            let value = self.integer(path, 0..=u64::MAX)?.unwrap_or_default();
            let changed = adapted.iter().any(|own| own.path == parameter && own.value != value);
            if let (true, true, Some(code)) = (changed, CODE_SETS.contains(&parameter), self.get("code")) {
                let (place, other) = (setting.place.clone(), format!("code = {}", super::read::plain(&code.value)));
                return Err(FileError::Conflict { place, key: path.clone(), other });
            }
            machine.set(parameter, value).map_err(config(&setting.place))?;
        }
        machine.check().map_err(config("machine"))?;
        Ok(machine)
    }
}

/// What [`Slats::code`] decides.
const CODE_SETS: [&str; 3] = ["gp.triangle_ns", "gp.sphere_ns", "gp.bin_entry_ns"];

impl Plan {
    /// Generates or reads the scene.
    ///
    /// # Errors
    ///
    /// As [`SceneChoice::load`].
    pub fn load_scene(&self) -> Result<Arc<Scene>, FileError> {
        self.scene.load()
    }

    /// Name of the level of modelling.
    #[must_use]
    pub fn level_name(&self) -> String {
        self.level.name().to_owned()
    }

    /// The experiment with the scene loaded.
    #[must_use]
    pub fn experiment(&self, scene: Arc<Scene>) -> Experiment {
        self.case(scene).experiment().pixels(self.pixels).level(self.level)
    }
}
