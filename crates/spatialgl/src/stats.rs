//! What is counted while a volume is drawn; every count is exact.

use crate::raster::SliceStats;
use serde::Serialize;

/// Counts of one volume.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct VolumeStats {
    /// Vertices that were transformed.
    pub vertices: u64,
    /// Triangles, lines and points.
    pub primitives: u64,
    /// Primitives with a corner where the display shows nothing.
    pub outside_volume: u64,
    /// Slices drawn; fewer than are shown, if some are mirrored.
    pub slices_rendered: u64,
    /// How often the commands are replayed for a slice.
    pub passes: u64,
    /// Samples taken of each pixel.
    pub samples: u64,
    /// Primitives issued for all slices and passes.
    pub draws: u64,
    /// What they would be without bins.
    pub draws_unbinned: u64,
    /// Entries in all bins.
    pub bin_memberships: u64,
    /// Fragments that reached the fragment program.
    pub fragments_generated: u64,
    /// Fragments that lie in their slice's volume.
    pub fragments_accepted: u64,
    /// Pixels added to connect intersections; beyond the paper.
    pub fragments_added: u64,
    /// Slices on which nothing was drawn.
    pub slices_empty: u64,
    /// Tiles of batches that hold something, which are packed and sent for every slice of their batch.
    pub tiles_occupied: u64,
    /// Occlusion queries: tiles of all batches.
    pub queries: u64,
    /// Stencil clears: one for each batch.
    pub stencil_clears: u64,
    /// Pixels that were halftoned and packed.
    pub pixels_packed: u64,
    /// Bytes of all slices with a word of 32 bits a pixel.
    pub bytes_unpacked: u64,
    /// Bytes of all slices packed.
    pub bytes_packed: u64,
    /// Bytes sent: the packed words of occupied tiles, and a bitmap of tiles for each batch.
    pub bytes_sent: u64,
    /// Counts of each slice drawn.
    pub slices: Vec<SliceStats>,
}

impl VolumeStats {
    /// Part of the queried tiles that were occupied, percent; all of them without tiles.
    #[must_use]
    pub fn tile_occupancy_percent(&self) -> f64 {
        if self.queries == 0 { 100.0 } else { 100.0 * self.tiles_occupied as f64 / self.queries as f64 }
    }

    pub(crate) fn add_slices(&mut self) {
        let slices = &self.slices;
        self.draws = slices.iter().map(|slice| slice.draws).sum();
        self.fragments_generated = slices.iter().map(|slice| slice.generated).sum();
        self.fragments_accepted = slices.iter().map(|slice| slice.accepted).sum();
        self.fragments_added = slices.iter().map(|slice| slice.added).sum();
        self.slices_empty = slices.iter().filter(|slice| slice.accepted + slice.added == 0).count() as u64;
    }
}
