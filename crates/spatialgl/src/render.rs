//! Rendering of a volume from recorded graphics commands: bins, batches of slices, tile queries, halftoning and
//! packing.

use crate::bin::{BinTolerance, Binning};
use crate::command::CommandBuffer;
use crate::frame::{BitPlanes, ColourSample, VolumeFrame, words_of_slice};
use crate::halftone::{Halftone, bits_above};
use crate::image::SliceImage;
use crate::pack::packed_word;
use crate::projection::Size;
use crate::raster::{Bin, Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::stats::VolumeStats;
use crate::tile::{TileGrid, Tiling};
use crate::view::{SliceView, SpatialDisplay};
use crate::workers::{Task, Workers};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Rule that selects the slices to draw in a turn of the screen. All other slices are mirrored copies of drawn slices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strobes {
    #[default]
    Each,
    /// The slices of the first half turn are drawn. The slices of the second half turn are mirror images of these
    /// slices, including the jitter. **Beyond the SpatialGL paper.**
    Mirror,
}

impl Strobes {
    pub const ALL: [(&'static str, Self); 2] = [("each", Self::Each), ("mirror", Self::Mirror)];
}

pxpl5_sim::parameters::named!(Strobes, "choice of strobes", Strobes::ALL);

/// The choices for drawing a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeConfig {
    pub binning: Binning,
    pub bin_tolerance: BinTolerance,
    pub tiling: Tiling,
    pub halftone: Halftone,
    pub coverage: Coverage,
    pub strobes: Strobes,
    pub keeps_colours: bool,
}

impl VolumeConfig {
    /// Returns settings with the algorithms of the SpatialGL paper: bins, tiles, and all slices of a turn drawn. The
    /// bins have a tolerance, so that no fragment is lost. The dither matrix has 8 x 8 elements.
    ///
    /// # Panics
    /// Never panics, because the matrix has a valid size.
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

    /// Returns settings that draw the same picture without optimizations: every slice draws everything, and every pixel
    /// is packed and sent.
    pub fn plain() -> Self {
        Self { binning: Binning::Off, tiling: Tiling::OFF, ..Self::paper() }
    }
}

/// Draws a volume. The workers, bins and tiles do not change the resulting bits.
///
/// # Errors
///
/// Returns a [`SettingError`] if the size of tiles or batches is invalid.
pub fn render_volume(
    display: &dyn SpatialDisplay,
    commands: &CommandBuffer,
    config: &VolumeConfig,
    renderer: &dyn SliceRenderer,
    workers: &dyn Workers,
) -> Result<VolumeFrame, SettingError> {
    config.tiling.check()?;
    let size = display.target_size();
    let shown = display.views().len();
    let drawn = if config.strobes == Strobes::Mirror { shown.div_ceil(2) } else { shown };
    let bins = Bins::of(display, commands, config);
    let volume = Volume { commands, config, renderer, bins: &bins, size, scratch: Mutex::new(Vec::new()) };
    let mut planes = BitPlanes::dark(size, shown as u32);
    // The second part of the words belongs to mirrored slices.
    let (first, second) = planes.words.split_at_mut(drawn * words_of_slice(size));
    let mut batches = volume.batches(&display.views()[..drawn], first, second);
    // Draw the batches, each as an independent task.
    let tasks = batches.iter_mut().map(|batch| Box::new(|| volume.draw(batch)) as Task<'_>).collect();
    workers.run(tasks);
    let mut stats = volume.count(display, &batches);
    let colours = batches.into_iter().flat_map(|batch| batch.colours).collect();
    stats.samples = u64::from(renderer.samples());
    stats.passes = display.views().first().map_or(0, |view| u64::from(view.volume.passes()));
    Ok(VolumeFrame { planes, stats, colours: config.keeps_colours.then_some(colours) })
}

struct Bins {
    lists: BTreeMap<u64, Bin>,
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
        // Slices with the same groups share one list.
        let mut lists = BTreeMap::new();
        for view in display.views() {
            let drawn_by = |i: &u32| groups[*i as usize] & view.bins != 0;
            let list = || Bin::new(commands, (0..groups.len() as u32).filter(drawn_by).collect());
            lists.entry(view.bins).or_insert_with(list);
        }
        let memberships = groups.iter().map(|groups| u64::from(groups.count_ones())).sum();
        Self { lists, memberships }
    }
}

/// Memory for the packed pixels of a slice, and of its mirror image if there is one. All pixels are dark at first.
struct SliceWords<'a> {
    own: &'a mut [u32],
    turned: Option<&'a mut [u32]>,
    row: usize,
}

impl SliceWords<'_> {
    #[inline(always)]
    fn set(&mut self, row: usize, column: usize, word: u32) {
        self.own[row * self.row + column] = word;
        if let Some(turned) = &mut self.turned {
            turned[(row + 1) * self.row - 1 - column] = word.reverse_bits().swap_bytes();
        }
    }
}

struct Volume<'a> {
    commands: &'a CommandBuffer,
    config: &'a VolumeConfig,
    renderer: &'a dyn SliceRenderer,
    bins: &'a Bins,
    size: Size,
    scratch: Mutex<Vec<SliceImage>>,
}

struct Batch<'a> {
    views: &'a [SliceView],
    words: Vec<SliceWords<'a>>,
    slices: Vec<SliceStats>,
    occupied: Vec<u32>,
    colours: Vec<Vec<ColourSample>>,
}

impl<'a> Volume<'a> {
    fn batches(&self, views: &'a [SliceView], first: &'a mut [u32], second: &'a mut [u32]) -> Vec<Batch<'a>> {
        let slice = words_of_slice(self.size);
        let row = (self.size[0] / 8) as usize;
        // Each slice of the second half mirrors the slice with the same index in the first half.
        let mut turned = second.chunks_mut(slice);
        let mut words = first.chunks_mut(slice).map(|own| SliceWords { own, turned: turned.next(), row });
        let batches = views.chunks(self.config.tiling.batch as usize).map(|views| Batch {
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
        // One query finds the tiles that are occupied in any slice of the batch.
        let grid = self.config.tiling.grid(self.size);
        batch.occupied = self.occupied(&grid, &images);
        for (image, words) in images.iter_mut().zip(&mut batch.words) {
            if self.config.keeps_colours {
                batch.colours.push(samples(image));
            }
            for tile in &batch.occupied {
                self.pack_tile(image, grid.rectangle(*tile), words);
            }
        }
        // The images are clean again and can be reused.
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

    /// Returns the indices of the occupied tiles of a batch. All tiles count as occupied without tiling, or if the
    /// background is not dark.
    fn occupied(&self, grid: &TileGrid, images: &[SliceImage]) -> Vec<u32> {
        let mut marked = vec![!self.is_sparse(); grid.tiles() as usize];
        for image in images.iter().filter(|_| self.is_sparse()) {
            grid.mark(image, &mut marked);
        }
        (0..).zip(marked).filter(|(_, is_marked)| *is_marked).map(|(tile, _)| tile).collect()
    }

    /// Returns true if pixels without fragments are dark and can be skipped.
    fn is_sparse(&self) -> bool {
        self.config.tiling.tile.is_some() && self.commands.background == [0; 3]
    }

    /// Halftones and packs a rectangle of pixels, and then makes these pixels dark again. The left and right sides of
    /// the rectangle are multiples of 8.
    fn pack_tile(&self, image: &mut SliceImage, rectangle: [u32; 4], words: &mut SliceWords<'_>) {
        let [left, top, right, bottom] = rectangle;
        let width = image.size()[0];
        let is_sparse = self.is_sparse();
        for y in top..bottom {
            // Skip rows and words without fragments.
            if is_sparse && !image.is_marked_between((y * width + left) as usize, (y * width + right) as usize) {
                continue;
            }
            for x in (left..right).step_by(8) {
                let at = (y * width + x) as usize;
                if is_sparse && !image.is_marked_at(at) {
                    continue;
                }
                let thresholds = self.config.halftone.eight(x, y);
                let [red, green, blue] = image.eight(at).map(|values| bits_above(values, thresholds));
                words.set(y as usize, x as usize / 8, packed_word(red, green, blue));
                if is_sparse {
                    image.darken_eight(at);
                }
            }
        }
        if !is_sparse {
            image.clear_rectangle(rectangle, self.commands.background);
        }
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
        // The sizes of a full transfer count every pixel of every drawn slice.
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

fn outside(display: &dyn SpatialDisplay, commands: &CommandBuffer) -> u64 {
    let is_shown: Vec<bool> = commands.positions.iter().map(|p| display.shows(DVec3::from_array(*p))).collect();
    let is_outside = |corners: &[u32]| corners.iter().any(|i| !is_shown[*i as usize]);
    commands.primitives.iter().filter(|primitive| is_outside(primitive.corners())).count() as u64
}

fn samples(image: &SliceImage) -> Vec<ColourSample> {
    let width = image.size()[0];
    let mut samples = Vec::new();
    for (at, byte) in (0u32..).zip(&image.stencil).filter(|(_, byte)| **byte != 0) {
        // Visit the marked pixels of a byte of the stencil.
        let mut rest = *byte;
        while rest != 0 {
            let pixel = at * 8 + rest.trailing_zeros();
            rest &= rest - 1;
            samples.push(ColourSample { pixel, colour: image.pixel(pixel % width, pixel / width) });
        }
    }
    samples
}
