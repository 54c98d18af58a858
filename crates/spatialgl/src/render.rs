//! A volume from a recording: bins, batches of slices, tile queries, halftone and packing.

use crate::bin::{BinTolerance, Binning};
use crate::command::CommandBuffer;
use crate::error::SpatialError;
use crate::frame::{BitPlanes, ColourSample, VolumeFrame, words_of_slice};
use crate::halftone::{Halftone, bits_above};
use crate::image::SliceImage;
use crate::pack::packed_word;
use crate::projection::Size;
use crate::raster::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::stats::VolumeStats;
use crate::tile::{TileGrid, Tiling};
use crate::view::{SliceView, SpatialDisplay};
use crate::workers::{Task, Workers};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Which slices of a turn are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strobes {
    /// Each slice is drawn for itself.
    #[default]
    Each,
    /// The first half is drawn, and the other half shows it turned over, jitter included. **Beyond the paper.**
    Mirror,
}

/// How a volume is made of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeConfig {
    /// How primitives are sorted before slices are drawn.
    pub binning: Binning,
    /// How far from a plane a vertex counts for both its sides.
    pub bin_tolerance: BinTolerance,
    /// Tiles and batches.
    pub tiling: Tiling,
    /// From eight bits to one.
    pub halftone: Halftone,
    /// What of a primitive is drawn.
    pub coverage: Coverage,
    /// Which slices are drawn.
    pub strobes: Strobes,
    /// Whether the colours before halftoning are kept.
    pub keeps_colours: bool,
}

impl VolumeConfig {
    /// The paper's algorithms, with bins that lose nothing and Bayer's matrix of 8 x 8.
    ///
    /// # Panics
    /// Never: the matrix has a valid size.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            binning: Binning::AllPlanes,
            bin_tolerance: BinTolerance::OfTheClip,
            tiling: Tiling::PAPER,
            halftone: Halftone::bayer(8).expect("a valid size"),
            coverage: Coverage::Sampled,
            strobes: Strobes::Each,
            keeps_colours: false,
        }
    }

    /// The same picture by brute force: every slice draws everything, and every pixel is packed and sent.
    #[must_use]
    pub fn plain() -> Self {
        Self { binning: Binning::Off, tiling: Tiling::OFF, ..Self::paper() }
    }
}

/// Draws a volume. The result does not depend on the workers, nor on bins and tiles.
///
/// # Errors
///
/// [`SpatialError::Setting`] if tiles or batches have a size that they cannot have.
pub fn render_volume(
    display: &dyn SpatialDisplay,
    commands: &CommandBuffer,
    config: &VolumeConfig,
    renderer: &dyn SliceRenderer,
    workers: &dyn Workers,
) -> Result<VolumeFrame, SpatialError> {
    config.tiling.check()?;
    let size = display.target_size();
    let shown = display.views().len();
    let drawn = if config.strobes == Strobes::Mirror { shown.div_ceil(2) } else { shown };
    let bins = Bins::of(display, commands, config);
    let volume = Volume { commands, config, renderer, bins: &bins, size, scratch: Mutex::new(Vec::new()) };
    let mut planes = BitPlanes::dark(size, shown as u32);
    let mut batches = volume.batches(&display.views()[..drawn], &mut planes);
    let tasks = batches.iter_mut().map(|batch| Box::new(|| volume.draw(batch)) as Task<'_>).collect();
    workers.run(tasks);
    let mut stats = volume.count(display, &batches);
    let colours = batches.into_iter().flat_map(|batch| batch.colours).collect();
    stats.passes = display.views().first().map_or(0, |view| u64::from(view.volume.passes()));
    mirror(&mut planes, drawn as u32);
    Ok(VolumeFrame { planes, stats, colours: config.keeps_colours.then_some(colours) })
}

/// The primitives that each group of slices draws.
struct Bins {
    lists: BTreeMap<u64, Vec<u32>>,
    memberships: u64,
}

impl Bins {
    fn of(display: &dyn SpatialDisplay, commands: &CommandBuffer, config: &VolumeConfig) -> Self {
        let layout = display.bins();
        let groups: Vec<u64> = commands
            .primitives
            .iter()
            .map(|primitive| {
                let (corners, used) = commands.corners_of(primitive);
                layout.groups(&corners[..used], config.binning, config.bin_tolerance, primitive.extra())
            })
            .collect();
        let mut lists = BTreeMap::new();
        for view in display.views() {
            let drawn_by = |i: &u32| groups[*i as usize] & view.bins != 0;
            lists.entry(view.bins).or_insert_with(|| (0..groups.len() as u32).filter(drawn_by).collect());
        }
        let memberships = groups.iter().map(|groups| u64::from(groups.count_ones())).sum();
        Self { lists, memberships }
    }
}

/// What is the same for all batches.
struct Volume<'a> {
    commands: &'a CommandBuffer,
    config: &'a VolumeConfig,
    renderer: &'a dyn SliceRenderer,
    bins: &'a Bins,
    size: Size,
    /// Clean targets that no batch uses.
    scratch: Mutex<Vec<SliceImage>>,
}

/// Slices that are drawn, queried and packed together, and what came of them.
struct Batch<'a> {
    views: &'a [SliceView],
    words: Vec<&'a mut [u32]>,
    slices: Vec<SliceStats>,
    occupied: Vec<u32>,
    colours: Vec<Vec<ColourSample>>,
}

impl<'a> Volume<'a> {
    fn batches(&self, views: &'a [SliceView], planes: &'a mut BitPlanes) -> Vec<Batch<'a>> {
        let batch = self.config.tiling.batch as usize;
        let mut words = planes.words.chunks_mut(words_of_slice(self.size));
        let batches = views.chunks(batch).map(|views| Batch {
            views,
            words: words.by_ref().take(views.len()).collect(),
            slices: Vec::new(),
            occupied: Vec::new(),
            colours: Vec::new(),
        });
        batches.collect()
    }

    fn draw(&self, batch: &mut Batch<'_>) {
        let mut images: Vec<SliceImage> = batch.views.iter().map(|_| self.target()).collect();
        for (view, image) in batch.views.iter().zip(&mut images) {
            let bin = &self.bins.lists[&view.bins];
            let work = SliceWork { commands: self.commands, bin, coverage: self.config.coverage };
            batch.slices.push(self.renderer.render(work, view, image));
        }
        let grid = self.config.tiling.grid(self.size);
        batch.occupied = (0..grid.tiles()).filter(|tile| self.is_occupied(&grid, *tile, &images)).collect();
        for (image, words) in images.iter_mut().zip(&mut batch.words) {
            if self.config.keeps_colours {
                batch.colours.push(samples(image));
            }
            for tile in &batch.occupied {
                pack_tile(image, grid.rectangle(*tile), &self.config.halftone, words);
                self.clean_tile(image, grid.rectangle(*tile));
            }
        }
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner).append(&mut images);
    }

    fn target(&self) -> SliceImage {
        let used = self.scratch.lock().unwrap_or_else(PoisonError::into_inner).pop();
        used.unwrap_or_else(|| {
            let mut image = SliceImage::new(self.size);
            if self.commands.background != [0; 3] {
                image.clear(self.commands.background);
            }
            image
        })
    }

    /// Without tiles everything is; with a background that is not dark too.
    fn is_occupied(&self, grid: &TileGrid, tile: u32, images: &[SliceImage]) -> bool {
        let all = self.config.tiling.tile.is_none() || self.commands.background != [0; 3];
        all || images.iter().any(|image| grid.is_marked(image, tile))
    }

    fn clean_tile(&self, image: &mut SliceImage, rectangle: [u32; 4]) {
        image.clear_rectangle(rectangle, self.commands.background);
    }

    fn count(&self, display: &dyn SpatialDisplay, batches: &[Batch<'_>]) -> VolumeStats {
        let mut stats = VolumeStats::default();
        let tiling = self.config.tiling;
        let grid = tiling.grid(self.size);
        let [width, height] = self.size.map(u64::from);
        for batch in batches {
            let slices = batch.views.len() as u64;
            let words: u64 = batch.occupied.iter().map(|tile| grid.words(*tile)).sum();
            stats.slices_rendered += slices;
            stats.slices.extend(&batch.slices);
            stats.pixels_packed += words * 8 * slices;
            stats.bytes_sent += words * 4 * slices;
            if tiling.tile.is_some() {
                stats.tiles_occupied += batch.occupied.len() as u64;
                stats.queries += u64::from(grid.tiles());
                stats.stencil_clears += 1;
                stats.bytes_sent += u64::from(grid.tiles().div_ceil(8));
            }
        }
        stats.bytes_unpacked = stats.slices_rendered * width * height * 4;
        stats.bytes_packed = stats.slices_rendered * width * height / 2;
        stats.vertices = self.commands.vertices() as u64;
        stats.primitives = self.commands.primitives() as u64;
        stats.bin_memberships = self.bins.memberships;
        let views = batches.iter().flat_map(|batch| batch.views);
        stats.draws_unbinned = views.map(|view| u64::from(view.volume.passes()) * stats.primitives).sum();
        stats.outside_volume = outside(display, self.commands);
        stats.add_slices();
        stats
    }
}

/// Primitives with a corner where the display shows nothing.
fn outside(display: &dyn SpatialDisplay, commands: &CommandBuffer) -> u64 {
    let is_shown: Vec<bool> = commands.positions.iter().map(|p| display.shows(DVec3::from_array(*p))).collect();
    let is_outside = |corners: &[u32]| corners.iter().any(|i| !is_shown[*i as usize]);
    commands.primitives.iter().filter(|primitive| is_outside(primitive.corners())).count() as u64
}

/// Halftones and packs a rectangle, the sides of which are multiples of 8 from the left.
fn pack_tile(image: &SliceImage, [left, top, right, bottom]: [u32; 4], halftone: &Halftone, words: &mut [u32]) {
    let width = image.size()[0];
    for y in top..bottom {
        for x in (left..right).step_by(8) {
            let thresholds = halftone.eight(x, y);
            let at = (y * width + x) as usize;
            let [red, green, blue] = image.eight(at).map(|values| bits_above(values, thresholds));
            words[at / 8] = packed_word(red, green, blue);
        }
    }
}

/// The pixels that were drawn on, with their colours.
fn samples(image: &SliceImage) -> Vec<ColourSample> {
    let [width, height] = image.size();
    let drawn = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|(x, y)| image.is_marked(*x, *y));
    drawn.map(|(x, y)| ColourSample { pixel: y * width + x, colour: image.pixel(x, y) }).collect()
}

/// Shows the first slices turned over in the place of those that were not drawn.
fn mirror(planes: &mut BitPlanes, drawn: u32) {
    let row = (planes.size()[0] / 8) as usize;
    for k in drawn..planes.slices() {
        let source = planes.slice(k - drawn).to_vec();
        let turned = source.chunks(row).flat_map(|row| row.iter().rev());
        let turned = turned.map(|word| word.reverse_bits().swap_bytes());
        for (word, source) in planes.slice_mut(k).iter_mut().zip(turned) {
            *word = source;
        }
    }
}
