//! Options that describe a volume (a scene drawn as slices for a volumetric display). Each option is a short form of a
//! path of `--set`.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::whole;
use crate::progress::Progress;
use crate::scenes;
use crate::terminal::warn;
use crate::version::{VERSION, commit_text};
use clap::Args;
use image::RgbImage;
use pxpl5::lab::volumes::VolumeQuery;
use pxpl5::scene::Scene;
use pxpl5::views::png_bytes;
use pxpl5::volume::pixel_planes::supported;
use pxpl5::volume::spatialgl::Threads;
use pxpl5::volume::{RendererKind, Volume, VolumeSettings};
use pxpl5::{PathSettings, SceneChoice};
use std::num::NonZero;
use std::sync::Arc;

/// The scene of a volume, and the settings that differ from the paper's settings.
#[derive(Args, Debug)]
pub(super) struct VolumeSettingArgs {
    /// A built-in scene (see `pxpl5 scenes`) or a model file: .ply, .obj, .stl, .gltf, .glb or
    /// .pdb. The scene is centred on the axis, its farthest corner at 0.9 of the display's radius.
    #[arg(long, value_name = "NAME|FILE", default_value = "mig")]
    scene: String,
    /// Decimate the scene to at most N primitives, keeping its shape.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1, 4_294_967_295))]
    triangles: Option<u64>,
    #[command(flatten)]
    pub(super) settings: SettingOptions,
}

/// Settings of a volume (slices of a volumetric display), for commands that choose their own scenes.
#[derive(Args, Debug)]
pub(super) struct SettingOptions {
    /// Method of clipping the scene to a slice: prism, user-planes, exact, tapered:PX, parallel:PX or hyperbolic:PX2;
    /// default hyperbolic:0.25.
    #[arg(long, value_name = "CLIP")]
    clip: Option<String>,
    /// Projection of the scene onto a slice: orthographic, perspective or jittered; default jittered.
    #[arg(long, value_name = "PROJECTION")]
    projection: Option<String>,
    /// Seed of the jitter; default 1.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    seed: Option<String>,
    /// Number of samples of each pixel: 1, 4 or 16; default 1.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    samples: Option<String>,
    /// Pixels of a triangle or sphere that are drawn: sampled (pixels with their centre inside) or connected (beyond
    /// the paper: also a line along the cut); default sampled.
    #[arg(long, value_name = "COVERAGE")]
    coverage: Option<String>,
    /// Slices that are drawn: each slice, or mirror (half of the slices, beyond the paper); default each.
    #[arg(long, value_name = "STROBES")]
    strobes: Option<String>,
    /// Renderer of the volume: host or pixel-planes; default host. The SpatialGL paper does not describe the renderer
    /// pixel-planes, which supports only the hyperbolic clip and the orthographic projection.
    #[arg(long, value_name = "RENDERER")]
    on: Option<String>,
    /// Set any number or choice by its path, such as display.slices=200, clip.bias_px2=1, tile.size=16 or
    /// gpu.readback_mb_s=400; docs/volumetric.md lists all numbers; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Number of worker threads of the host; default: one for each core.
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1, 1024))]
    threads: Option<u64>,
    #[command(flatten)]
    pub(super) budget: BudgetArgs,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

pub(super) const SMALLER: &str = "draw fewer or smaller slices (--set display.slices, display.width, display.height)";

impl SettingOptions {
    /// Returns the settings of the SpatialGL paper after all options. `--set` is applied last. Prints a warning for
    /// each number outside its documented range.
    pub(super) fn gather(&self) -> Result<VolumeSettings, CliError> {
        let mut settings = VolumeSettings::paper();
        let options = [
            ("clip.variant", "--clip", &self.clip),
            ("projection", "--projection", &self.projection),
            ("seed", "--seed", &self.seed),
            ("draw.samples", "--samples", &self.samples),
            ("draw.coverage", "--coverage", &self.coverage),
            ("draw.strobes", "--strobes", &self.strobes),
            ("on", "--on", &self.on),
        ];
        // Options override the paper's settings, and `--set` overrides options.
        for (path, option, text) in options {
            text.as_ref().map(|text| settings.set(path, text, option)).transpose()?;
        }
        for assignment in &self.sets {
            settings.assign(assignment, "--set")?;
        }
        // Settings that contradict each other are refused before any drawing.
        settings.swept_display()?;
        settings.volume_config()?;
        if settings.renderer == RendererKind::PixelPlanes {
            supported(&settings)?;
        }
        warn(&settings.warnings(), self.quiet);
        Ok(settings)
    }

    pub(super) fn threads(&self) -> Threads {
        let asked = self.threads.and_then(|threads| NonZero::new(threads as usize));
        asked.map_or_else(Threads::all, Threads)
    }
}

impl VolumeSettingArgs {
    pub(super) fn load_scene(&self) -> Result<Arc<Scene>, CliError> {
        let scene = load(&self.scene, self.triangles)?;
        scenes::print_warnings(&scene, self.settings.quiet);
        Ok(scene)
    }

    pub(super) fn draw(&self, settings: &VolumeSettings) -> Result<Volume, CliError> {
        let study = self.query(settings)?;
        Progress::new("batches of slices", self.settings.quiet).run_within(self.settings.budget, SMALLER, &study)
    }

    pub(super) fn query(&self, settings: &VolumeSettings) -> Result<VolumeQuery, CliError> {
        Ok(VolumeQuery { settings: settings.clone(), scene: self.load_scene()?, threads: self.settings.threads() })
    }
}

/// Loads a scene by name or file, and scales it to fit into the display.
pub(crate) fn load(name: &str, triangles: Option<u64>) -> Result<Arc<Scene>, CliError> {
    Ok(scene_choice(name, triangles).load()?)
}

/// Returns the settings of a scene that is scaled to fit into the display. `name` is a built-in scene or a file.
pub(super) fn scene_choice(name: &str, triangles: Option<u64>) -> SceneChoice {
    let triangles = triangles.map(|triangles| triangles as usize);
    SceneChoice { name: name.to_owned(), triangles, ..SceneChoice::default() }
}

pub(super) fn png(picture: &RgbImage, volume: &Volume) -> Result<Vec<u8>, CliError> {
    png_bytes(picture, &origin(volume)).map_err(CliError::failure)
}

/// Returns the text chunks of a PNG file of a volume, which state the settings that reproduce the picture.
pub(super) fn origin(volume: &Volume) -> Vec<(&'static str, String)> {
    let settings = &volume.settings;
    let overrides: Vec<String> = settings.overrides().iter().map(|set| format!("{}={}", set.path, set.value)).collect();
    vec![
        ("version", VERSION.to_owned()),
        ("commit", commit_text().to_owned()),
        ("scene", volume.scene.clone()),
        ("clip", settings.clip_text()),
        ("projection", settings.projection_text().to_owned()),
        ("seed", settings.seed.to_string()),
        ("volume_hash", format!("{:016x}", volume.frame.planes.hash())),
        ("overrides", overrides.join(" ")),
        ("beyond_paper", settings.beyond_paper().join(", ")),
    ]
}
