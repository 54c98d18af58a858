//! Exact counts of the work for one volume.

use crate::raster::SliceStats;
use serde::Serialize;

/// Counts of the primitives, slices and passes of a drawn volume.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct VolumeStats {
    pub vertices: u64,
    /// Number of triangles, lines and points.
    pub primitives: u64,
    /// Number of primitives with a corner outside the display's volume.
    pub outside_volume: u64,
    /// Number of slices drawn. If slices are mirrored, more slices are shown than drawn.
    pub slices_rendered: u64,
    /// Number of drawing passes per slice, each of which replays the recorded commands.
    pub passes: u64,
    /// Number of samples per pixel of a slice.
    pub samples: u64,
    /// Number of primitives drawn, summed over all slices and passes.
    pub draws: u64,
    /// Number of primitives that would be drawn without bins.
    pub draws_unbinned: u64,
    /// Number of entries in all bins. A primitive in several bins counts in each of these bins.
    pub bin_memberships: u64,
    /// Number of fragments that reached the fragment program.
    pub fragments_generated: u64,
    /// Number of fragments that lie in the volume of their slice.
    pub fragments_accepted: u64,
    /// Number of pixels added to close gaps in the intersections of surfaces with slices. Added pixels are beyond the
    /// SpatialGL paper.
    pub fragments_added: u64,
    /// Number of slices on which nothing was drawn.
    pub slices_empty: u64,
    /// Number of occupied tiles, summed over all batches of slices. An occupied tile is packed and sent for every slice
    /// of its batch.
    pub tiles_occupied: u64,
    /// Number of occlusion queries: one for each tile of each batch of slices.
    pub queries: u64,
    /// Number of stencil clears: one for each batch of slices.
    pub stencil_clears: u64,
    pub pixels_packed: u64,
    /// Size of all drawn slices with a 32-bit word per pixel, bytes.
    pub bytes_unpacked: u64,
    /// Size of all drawn slices in packed form, bytes.
    pub bytes_packed: u64,
    /// Number of bytes sent: the packed words of occupied tiles, and a bitmap of tiles for each batch.
    pub bytes_sent: u64,
    pub slices: Vec<SliceStats>,
}

impl VolumeStats {
    /// Returns the percentage of queried tiles that were occupied. The result is 100 without tiles.
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
