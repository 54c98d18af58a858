//! Options of `pxpl5 arp` that describe the walk of a viewer. Each option is a short form of a path of `--set`.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::plain;
use crate::output::OutputFolder;
use crate::scenes;
use crate::settings::table_of;
use crate::terminal::warn;
use clap::Args;
use pxpl5::arp::WalkPlan;
use pxpl5::arp::address_recalculation::{ArpConfig, Lens};
use pxpl5::arp::pictures::ArpPicture;
use pxpl5::scene::{Placement, Scene};
use pxpl5::sweep::leaves;
use pxpl5::views::png_bytes;
use pxpl5::{PathSettings, SceneChoice};
use pxpl5_sim::parameters::assignment_of;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The scene of a walk (frames seen along a path), and the settings that differ from their defaults.
#[derive(Args, Debug)]
pub(super) struct WalkArgs {
    /// A TOML file of settings by path, including `scene`; options override the file.
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// A built-in scene with a path (gallery, gallery:full); default gallery.
    #[arg(long, value_name = "NAME|FILE")]
    scene: Option<String>,
    /// Policy, which decides when an object is drawn again: full, objects or cells; default cells.
    #[arg(long, value_name = "POLICY")]
    policy: Option<String>,
    /// Cut objects at the borders of cells (square areas of the scene): on or off; default on with cells, off with
    /// objects.
    #[arg(long, value_name = "ON|OFF")]
    segment: Option<String>,
    /// Region warping, which moves vertices near a cut to close gaps. The movement decreases with the distance from the
    /// cut: none (no warping), linear, smoothstep or step; default linear.
    #[arg(long, value_name = "FALLOFF")]
    warp: Option<String>,
    /// Rate at which the display reads the head's orientation: for each field, line or pixel; default field.
    #[arg(long, value_name = "LATCH")]
    latch: Option<String>,
    /// Lens before the eye: flat, radial:K1, radial:K1:K2, equidistant, or table:FILE with a vector for each pixel;
    /// default flat.
    #[arg(long, value_name = "LENS", allow_hyphen_values = true)]
    lens: Option<String>,
    /// Renderer of the cube faces: ideal, or a number of triangles per second; default ideal.
    #[arg(long, value_name = "SOURCE")]
    source: Option<String>,
    /// Set any number or choice by its path, such as priority.theta_deg=0.1, priority.cell_m=8,
    /// priority.ring_growth=1, priority.threshold=2px, priority.cascade=off, arp.face_texels=1024,
    /// walk.route=straight, walk.hall_scale=0.5 or walk.frames=3600; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    #[command(flatten)]
    pub(super) budget: BudgetArgs,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Advice for a walk that would take too long.
pub(super) const FEWER_FRAMES: &str = "walk fewer frames (--set walk.frames)";

/// Path of a setting whose value can name a file with a lens table.
const LENS: &str = "arp.lens";

/// Settings as tuples of path, value, and the file or option that gave the value.
type GivenSettings = Vec<(String, String, String)>;

impl WalkArgs {
    /// Returns the scene and all settings of the walk. Prints a warning for each number outside its documented range.
    pub(super) fn gather(&self) -> Result<(Arc<Scene>, WalkPlan), CliError> {
        let (scene, given) = self.given()?;
        let mut plan = WalkPlan::usual();
        let mut table = None;
        // A lens table is read last, because its size depends on the picture that the other settings choose.
        for (path, value, place) in &given {
            match value.strip_prefix("table:").filter(|_| path == LENS) {
                Some(file) => table = Some(file),
                None => plan.set(path, value, place)?,
            }
        }
        if let Some(file) = table {
            let lens = read_lens(Path::new(file), &plan)?;
            plan = plan.behind(lens, file);
        }
        // Check all settings together before the scene is loaded.
        plan.settings()?;
        warn(&plan.warnings(), self.quiet);
        let name = self.scene.clone().unwrap_or(scene);
        let scene = SceneChoice { name, placement: Placement::AsInFile, ..SceneChoice::default() }.load()?;
        scenes::print_warnings(&scene, self.quiet);
        Ok((scene, plan))
    }

    /// Returns the settings of the address recalculation display. `lens` and `sets` are the values of the options
    /// `--lens` and `--set`.
    pub(super) fn of_display(lens: Option<&String>, sets: &[String]) -> Result<ArpConfig, CliError> {
        let mut plan = WalkPlan::usual();
        lens.map(|lens| plan.set(LENS, lens, "--lens")).transpose()?;
        for assignment in sets {
            plan.assign(assignment, "--set")?;
        }
        Ok(plan.settings()?.display)
    }

    /// Returns the name of the scene, and all settings in the order in which they apply: file, options, `--set`.
    fn given(&self) -> Result<(String, GivenSettings), CliError> {
        let mut given = GivenSettings::new();
        let mut scene = "gallery".to_owned();
        if let Some(path) = &self.file {
            let (file, place) = table_of(path)?;
            // Settings of the file come first, so that later settings override them.
            for (path, value) in leaves(file) {
                match path.as_str() {
                    "scene" => scene = plain(&value),
                    _ => given.push((path, plain(&value), place.clone())),
                }
            }
        }
        // Each option stands for one path.
        let options = [
            ("policy", "--policy", &self.policy),
            ("segment", "--segment", &self.segment),
            ("warp", "--warp", &self.warp),
            ("arp.latch", "--latch", &self.latch),
            (LENS, "--lens", &self.lens),
            ("source", "--source", &self.source),
        ];
        for (path, option, text) in options {
            given.extend(text.iter().map(|text| (path.to_owned(), text.clone(), option.to_owned())));
        }
        // `--set` comes last and overrides everything else.
        for assignment in &self.sets {
            let (path, value) = assignment_of(assignment, "--set")?;
            given.push((path.to_owned(), value.to_owned(), "--set".to_owned()));
        }
        Ok((scene, given))
    }
}

fn read_lens(path: &Path, plan: &WalkPlan) -> Result<Lens, CliError> {
    let failed = |error: &dyn std::fmt::Display| CliError::usage(format!("{}: {error}", path.display()));
    let file = File::open(path).map_err(|error| failed(&error))?;
    Lens::read(BufReader::new(file), &plan.picture()).map_err(|error| failed(&error))
}

/// Writes pictures as PNG files into a folder. Each file also holds the settings that reproduce the picture.
pub(crate) fn put(
    folder: &mut OutputFolder,
    pictures: &[ArpPicture],
    origin: &[(&'static str, String)],
) -> Result<(), CliError> {
    for picture in pictures {
        match picture {
            ArpPicture::Pixels(name, pixels) => {
                let png = png_bytes(pixels, origin).map_err(CliError::failure)?;
                folder.put(&format!("{name}.png"), &png)?;
            }
            ArpPicture::Drawing(name, text) => folder.put(&format!("{name}.svg"), text.as_bytes())?,
        }
    }
    Ok(())
}
