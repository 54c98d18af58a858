//! Drawing of slices on the emulated pixel arrays, region by region.

use super::command::{SliceCorner, SliceTriangle};
use super::halftone::{halftone_clocks, halftone_words};
use crate::settings::VolumeSettings;
use crate::{ClipKind, ProjectionKind};
use pxpl5_renderer::{BitSerial, Clear, Command, CommandKind, Lanes, Layout, PixelArray, SelectRegion};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::format::SUBPIXEL_BITS;
use pxpl5_wire::{REGION_SIZE, Word};
use serde::Serialize;
use spatialgl::{Combine, HalfWedge, SliceImage, SliceRenderer, SliceStats, SliceView, SliceWork};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// The model of the pixel array that draws the slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrayKind {
    /// The fast array, which computes with whole numbers instead of single bits, and only for the pixels that a command
    /// touches.
    Lanes,
    /// The reference model of the array, which executes one bit of one instruction at a time. The model skips only
    /// steps that cannot change a result.
    BitSerial,
}

/// Work of all renderers for a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RendererWork {
    /// Number of regions that were cleared and drawn.
    pub regions: u64,
    /// Number of slice triangles. A triangle counts once for each slice that draws the triangle.
    pub triangles: u64,
    /// Number of triangle commands. A triangle counts once for each region that the triangle touches in a slice.
    pub commands: u64,
    /// Number of omitted triangles. A triangle is omitted if it has no area on the sub-pixel grid, or if the
    /// coefficients of its planes have too many bits for the machine.
    pub left_out: u64,
    /// Number of clocks for clears, triangles and halftones.
    pub clocks: u64,
    /// Number of ring words of all commands.
    pub command_words: u64,
}

/// A renderer of slices with a hyperbolic clip and an orthographic projection. If several triangles cover a pixel, the
/// last triangle determines the colour of the pixel.
///
/// A pixel counts as drawn if its colour is not black, because the arrays have no stencil.
#[derive(Debug)]
pub struct PixelPlanesRenderer {
    layout: Layout,
    wedge: HalfWedge,
    bias: f64,
    kind: ArrayKind,
    work: Mutex<RendererWork>,
    loads: Mutex<HashMap<ViewKey, SliceLoad>>,
}

/// The work of a renderer for one slice.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SliceLoad {
    /// Number of triangles that can have pixels in the slice.
    pub triangles: u64,
    /// Number of triangle commands in each region, row by row from the top left.
    pub commands: Vec<u32>,
}

/// The bits of a slice's view matrix, used as a key that distinguishes the slices of a display.
type ViewKey = [u64; 16];

fn key_of(view: &SliceView) -> ViewKey {
    view.view.to_cols_array().map(f64::to_bits)
}

/// Checks that the renderers can draw with these settings.
///
/// # Errors
///
/// [`SettingError`] names the setting that the renderers do not support.
pub fn supported(settings: &VolumeSettings) -> Result<(), SettingError> {
    let rules = [
        (settings.clip == ClipKind::Hyperbolic, "clip", "hyperbolic, which is one quadratic", settings.clip_text()),
        (
            settings.projection == ProjectionKind::Orthographic,
            "projection",
            "orthographic",
            settings.projection_text().to_owned(),
        ),
        (settings.combine == Combine::Last, "draw.combine", "last", "another".to_owned()),
        (settings.draw.samples == 1, "draw.samples", "1", settings.draw.samples.to_string()),
        (settings.coverage == spatialgl::Coverage::Sampled, "draw.coverage", "sampled", "connected".to_owned()),
    ];
    // Report the first setting that is not supported.
    match rules.into_iter().find(|(holds, ..)| !holds) {
        None => Ok(()),
        Some((_, what, expected, found)) => {
            Err(SettingError::value(what, format_args!("{expected} on Pixel-Planes 5"), found))
        }
    }
}

impl PixelPlanesRenderer {
    /// Creates renderers for a display with these settings.
    ///
    /// # Errors
    ///
    /// The same as [`supported`].
    pub fn new(settings: &VolumeSettings, kind: ArrayKind) -> Result<Self, SettingError> {
        supported(settings)?;
        let wedge = HalfWedge::new(settings.display.slices as u32, settings.radius());
        let work = Mutex::new(RendererWork::default());
        let layout = Layout::rendering_control_phong();
        let loads = Mutex::new(HashMap::new());
        Ok(Self { layout, wedge, bias: settings.clip_numbers.bias_px2, kind, work, loads })
    }

    /// Returns the work that these renderers have done so far.
    pub fn work(&self) -> RendererWork {
        *self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the work of the last drawing of each of these slices. The work is zero for a slice that was never drawn.
    pub fn loads(&self, views: &[SliceView]) -> Vec<SliceLoad> {
        let loads = self.loads.lock().unwrap_or_else(PoisonError::into_inner);
        views.iter().map(|view| loads.get(&key_of(view)).cloned().unwrap_or_default()).collect()
    }

    /// Returns commands for the triangles that can have pixels in the slice, each with the pixels that the triangle can
    /// touch. The second value is the number of omitted triangles.
    fn commands(&self, work: SliceWork<'_>, view: &SliceView, size: [u32; 2]) -> (Vec<Placed>, u64) {
        let mut placed = Vec::new();
        let mut left_out = 0;
        let reach = self.half_thickness();
        for primitive in work.bin.primitives() {
            let Some(triangle) = work.commands.triangle(*primitive) else { continue };
            let local = triangle.corners.map(|corner| view.local(corner.into()));
            // Triangles on one side of the slab have no pixels.
            if local.iter().all(|p| p.z > reach) || local.iter().all(|p| p.z < -reach) {
                continue;
            }
            let corners = [0, 1, 2].map(|i| snapped(local[i].to_array(), triangle.colours[i], size));
            match SliceTriangle::of_corners(corners, size, self.wedge, self.bias) {
                Some(command) => placed.push(Placed { command, bounds: bounds(&corners) }),
                None => left_out += 1,
            }
        }
        (placed, left_out)
    }

    /// Returns slightly more than half the thickness of the slice's volume at the rim, where the volume is thickest.
    fn half_thickness(&self) -> f64 {
        spatialgl::SliceClip::Hyperbolic(self.bias).reach(self.wedge) + 1e-6
    }

    fn region(&self, [left, top]: [u32; 2], placed: &[Placed], image: &mut SliceImage) -> RendererWork {
        let [width, height] = image.size();
        let within = [REGION_SIZE.min(width - left), REGION_SIZE.min(height - top)];
        let mut words = Vec::new();
        self.encode(Command::SelectRegion(SelectRegion { context: 0, left: left as u16, top: top as u16 }), &mut words);
        self.encode(Command::Clear(Clear { colour: 0 }), &mut words);
        // Only the triangles that touch the region are sent.
        let touching = placed.iter().filter(|one| one.touches([left, top]));
        let mut commands = 0;
        for one in touching {
            one.command.encode(&self.layout, &mut words);
            commands += 1;
        }
        let mut work = RendererWork { regions: 1, commands, ..RendererWork::default() };
        work.command_words = (words.len() + halftone_words(&self.layout).len()) as u64;
        // An empty region needs no execution.
        if commands == 0 {
            work.clocks = self.empty_clocks();
            return work;
        }
        let (clocks, colours) = self.execute(&words, within);
        work.clocks = clocks + halftone_clocks(&self.layout);
        for (at, colour) in (0u32..).zip(colours.iter()).filter(|(_, colour)| **colour != 0) {
            let [_, red, green, blue] = colour.to_be_bytes();
            image.draw_pixel(left + at % within[0], top + at / within[0], [red, green, blue], Combine::Last);
        }
        work
    }

    fn execute(&self, words: &[Word], [width, height]: [u32; 2]) -> (u64, std::sync::Arc<[Word]>) {
        match self.kind {
            ArrayKind::Lanes => run(&mut Lanes::new(&self.layout), words, width, height),
            ArrayKind::BitSerial => run(&mut BitSerial::new(&self.layout).skipping(), words, width, height),
        }
    }

    /// Returns the number of clocks for a region without triangles. The renderer also selects, clears and halftones an
    /// empty region.
    fn empty_clocks(&self) -> u64 {
        self.clocks(CommandKind::SelectRegion) + self.clocks(CommandKind::Clear) + halftone_clocks(&self.layout)
    }

    fn clocks(&self, kind: CommandKind) -> u64 {
        u64::from(kind.clocks(&self.layout).expect("pxpl5-volume: neither command waits for anything"))
    }

    fn encode(&self, command: Command, words: &mut Vec<Word>) {
        command.encode(&self.layout, words).expect("pxpl5-volume: every layout has the fields to select and clear");
    }
}

/// Executes a list of commands, and returns the number of clocks and the colours. This crate made the commands, so
/// every command is valid.
fn run(array: &mut impl PixelArray, words: &[Word], width: u32, height: u32) -> (u64, std::sync::Arc<[Word]>) {
    let clocks = array.execute(words).expect("pxpl5-volume: commands of our own").clocks;
    (clocks, array.read_colour(width, height))
}

/// A command, and the rectangle of pixels that the command can touch: left, top, right, bottom. All four sides belong
/// to the rectangle.
struct Placed {
    command: SliceTriangle,
    bounds: [i32; 4],
}

impl Placed {
    fn touches(&self, corner: [u32; 2]) -> bool {
        let [left, top] = corner.map(|side| side as i32);
        let side = REGION_SIZE as i32;
        let [x0, y0, x1, y1] = self.bounds;
        x0 < left + side && x1 >= left && y0 < top + side && y1 >= top
    }
}

fn bounds(corners: &[SliceCorner; 3]) -> [i32; 4] {
    let along = |axis: usize| corners.map(|corner| corner.place[axis].div_euclid(1 << SUBPIXEL_BITS));
    let least = |values: [i32; 3]| values[0].min(values[1]).min(values[2]);
    let most = |values: [i32; 3]| values[0].max(values[1]).max(values[2]);
    [least(along(0)), least(along(1)), most(along(0)), most(along(1))]
}

/// Rounds a corner (u, v, s) of a triangle in a slice to the sub-pixel grid of the slice's image.
fn snapped([u, v, s]: [f64; 3], colour: [f64; 3], size: [u32; 2]) -> SliceCorner {
    let steps = f64::from(1 << SUBPIXEL_BITS);
    let [half_width, half_height] = size.map(|side| f64::from(side) / 2.0);
    let place = [u + half_width, half_height - v].map(|place| (place * steps).round() as i32);
    SliceCorner { place, off: s, colour }
}

impl SliceRenderer for PixelPlanesRenderer {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats {
        let size = image.size();
        let (placed, left_out) = self.commands(work, view, size);
        let mut done = RendererWork { triangles: placed.len() as u64, left_out, ..RendererWork::default() };
        let mut load = SliceLoad { triangles: done.triangles, commands: Vec::new() };
        // Every region is cleared and halftoned, even without triangles.
        for top in (0..size[1]).step_by(REGION_SIZE as usize) {
            for left in (0..size[0]).step_by(REGION_SIZE as usize) {
                let region = self.region([left, top], &placed, image);
                load.commands.push(region.commands as u32);
                done = done.and(region);
            }
        }
        self.loads.lock().unwrap_or_else(PoisonError::into_inner).insert(key_of(view), load);
        // Slices are drawn on several threads, and their work is added up.
        let mut total = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        *total = total.and(done);
        let drawn = image.marked();
        SliceStats { draws: placed.len() as u64, generated: drawn, accepted: drawn, added: 0 }
    }
}

impl RendererWork {
    const fn and(self, other: Self) -> Self {
        Self {
            regions: self.regions + other.regions,
            triangles: self.triangles + other.triangles,
            commands: self.commands + other.commands,
            left_out: self.left_out + other.left_out,
            clocks: self.clocks + other.clocks,
            command_words: self.command_words + other.command_words,
        }
    }
}
