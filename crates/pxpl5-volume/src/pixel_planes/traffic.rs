//! What a volume sends over the ring: commands of every region of every slice, and the packed tiles that come of them.

use super::renderer::{PixelPlanesRenderer, SliceLoad};
use perspecta::batch_messages;
use pxpl5_wire::{REGION_SIZE, Word};
use spatialgl::{Size, SliceView, Tiling, VolumeFrame};
use std::sync::Arc;

/// The messages of one volume. Which tiles hold something is taken as known when a region is copied: the machine has no query.
#[derive(Clone, Debug)]
pub struct SliceTraffic {
    /// Width and height of a slice, pixels.
    pub(super) size: Size,
    /// Maps of tiles, a message each.
    pub(super) maps: Vec<Arc<[Word]>>,
    /// The slices in their order.
    pub(super) slices: Vec<SliceMessages>,
}

/// What one slice sends.
#[derive(Clone, Debug)]
pub(super) struct SliceMessages {
    pub(super) load: SliceLoad,
    /// The tiles of each region, a message each.
    pub(super) tiles: Vec<Vec<Arc<[Word]>>>,
}

impl SliceTraffic {
    /// The messages of a volume that a renderer has drawn, of the slices that it has drawn. `None` if its tiles cannot be sent (see
    /// [`perspecta::volume_messages`]).
    #[must_use]
    pub fn of(
        renderer: &PixelPlanesRenderer,
        views: &[SliceView],
        frame: &VolumeFrame,
        tiling: Tiling,
    ) -> Option<Self> {
        let size = frame.planes.size();
        let loads = renderer.loads(views);
        let batches = batch_messages(&frame.planes, tiling, views.len() as u32)?;
        let columns = size[0].div_ceil(REGION_SIZE);
        let regions = (columns * size[1].div_ceil(REGION_SIZE)) as usize;
        let empty = |load| SliceMessages { load, tiles: vec![Vec::new(); regions] };
        let mut slices: Vec<SliceMessages> = loads.into_iter().map(empty).collect();
        let mut maps = Vec::new();
        for batch in batches {
            maps.push(batch.map);
            for tile in batch.tiles {
                // A tile that lies in two regions leaves with the one that has its corner.
                let [left, top, ..] = tiling.grid(size).rectangle(tile.tile);
                let region = top / REGION_SIZE * columns + left / REGION_SIZE;
                slices[tile.slice as usize].tiles[region as usize].push(tile.words);
            }
        }
        Some(Self { size, maps, slices })
    }

    /// Tiles that are sent, for all slices.
    #[must_use]
    pub fn tiles(&self) -> u64 {
        self.slices.iter().flat_map(|slice| &slice.tiles).map(|region| region.len() as u64).sum()
    }

    /// Regions of which any tile is sent: each goes through the backing store.
    #[must_use]
    pub fn copies(&self) -> u64 {
        self.slices.iter().flat_map(|slice| &slice.tiles).filter(|region| !region.is_empty()).count() as u64
    }
}
