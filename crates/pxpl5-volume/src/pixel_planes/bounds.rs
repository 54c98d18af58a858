//! Volumes per second as a function of the numbers of renderers and graphics processors: the bound of each part alone.

use super::renderer::RendererWork;
use super::traffic::SliceTraffic;
use pxpl5_gp::GpTiming;
use pxpl5_renderer::RendererTiming;
use pxpl5_renderer::isa::timing::CLOCK_HZ;
use pxpl5_ring::RingTiming;
use pxpl5_wire::MAX_MESSAGE_WORDS;
use serde::Serialize;
use spatialgl::{Tiling, VolumeFrame};

/// The times that each part needs for a volume if it never waits, milliseconds.
///
/// ```text
/// renderers   (clocks of clears, triangles and halftones + copies x backing block) / 40 MHz / renderers
/// ring in     (command words + overhead of messages) t_word / channels that may end at renderers
/// ring out    (words of occupied tiles + overhead of one message each) t_word / channels
/// port        (the same words) t_word: the display takes one message after the other
/// processors  (slice triangles t_triangle + commands t_bin_entry) / processors
/// ```
///
/// A slice triangle costs a processor the same as a triangle of a frame (assumed: the six coefficients of the hyperbola
/// replace depth).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SliceBounds {
    /// Work of the renderers for the volume.
    pub work: RendererWork,
    /// Number of tiles sent. Each tile is sent with its words.
    pub tiles: u64,
    /// Number of words of a tile.
    pub tile_words: u64,
    /// Number of regions with at least one tile to send. Each moves to the backing store first, and its renderer waits
    /// for this move.
    pub copies: u64,
}

/// The bounds for certain numbers of boards.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundRow {
    /// Number of renderers that share the slices.
    pub renderers: u64,
    /// Number of graphics processors that share the triangles.
    pub processors: u64,
    /// Bounds in milliseconds: renderers, ring (both directions), the display's port, processors.
    pub ms: [f64; 4],
    /// Volumes per second if only the slowest part limits the rate.
    pub volumes_hz: f64,
    /// Slowest part: `renderers`, `ring`, `port` or `processors`. Of equal parts, the first.
    pub limited_by: &'static str,
}

impl SliceBounds {
    /// Computes the bounds of a volume that renderers drew. Occupied tiles are sent for every slice of their batch.
    /// Without `traffic`, when the tiles cannot be sent, no region is copied.
    #[must_use]
    pub fn of(work: RendererWork, frame: &VolumeFrame, tiling: Tiling, traffic: Option<&SliceTraffic>) -> Self {
        let tile_words = tiling.grid(frame.planes.size()).words(0);
        let packed = frame.stats.pixels_packed / 8 / tile_words.max(1);
        let tiles = traffic.map_or(packed, SliceTraffic::tiles);
        Self { work, tiles, tile_words, copies: traffic.map_or(0, SliceTraffic::copies) }
    }

    /// Returns the bounds for these numbers of renderers and graphics processors, each 1 or more.
    #[must_use]
    pub fn with(&self, renderers: u64, processors: u64) -> BoundRow {
        let clocks = self.work.clocks + self.copies * RendererTiming::PAPERS.backing_block_clocks;
        let renderer_ms = clocks as f64 / CLOCK_HZ as f64 * 1e3 / renderers.max(1) as f64;
        let gp = GpTiming::PAPERS;
        let gp_ns = self.work.triangles * gp.triangle_ns + self.work.commands * gp.bin_entry_ns;
        let gp_ms = gp_ns as f64 / 1e6 / processors.max(1) as f64;
        let ms = [renderer_ms, self.ring_ms(), self.port_ms(), gp_ms];
        let names = ["renderers", "ring", "port", "processors"];
        let slowest = (1..ms.len()).fold(0, |slowest, part| if ms[part] > ms[slowest] { part } else { slowest });
        BoundRow { renderers, processors, ms, volumes_hz: 1e3 / ms[slowest], limited_by: names[slowest] }
    }

    /// Returns the bound of the ring. Commands and tiles share its channels, of which renderers may hold six at a time.
    fn ring_ms(&self) -> f64 {
        let ring = RingTiming::PAPERS;
        let messages = self.work.command_words.div_ceil(u64::from(MAX_MESSAGE_WORDS)).max(self.work.regions);
        let words_in = self.work.command_words + messages * ring.overhead_words;
        let alone = milliseconds(words_in) / ring.fifo_channels as f64;
        let together = milliseconds(words_in + self.words_out()) / ring.channels as f64;
        alone.max(together)
    }

    /// Returns the bound of the display's port, which receives one message at a time.
    fn port_ms(&self) -> f64 {
        milliseconds(self.words_out())
    }

    /// Returns the number of words of all occupied tiles, including the overhead of each message.
    fn words_out(&self) -> u64 {
        self.tiles * (self.tile_words + RingTiming::PAPERS.overhead_words)
    }
}

fn milliseconds(words: u64) -> f64 {
    (words * RingTiming::PAPERS.word_ns) as f64 / 1e6
}
