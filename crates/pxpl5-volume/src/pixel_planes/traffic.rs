//! The ring messages of a volume: the commands for every region of every slice, and the packed tiles that renderers
//! send.

use super::renderer::{PixelPlanesRenderer, SliceLoad};
use pxpl5_wire::{REGION_SIZE, Word};
use spatialgl::perspecta::batch_messages;
use spatialgl::{Size, SliceView, Tiling, VolumeFrame};
use std::sync::Arc;

/// The ring messages of one volume. The model assumes that the occupied tiles are known when a region is copied,
/// because the machine has no occlusion query.
#[derive(Clone, Debug)]
pub struct SliceTraffic {
    pub(super) size: Size,
    /// Maps of the tiles that will be sent, one message each.
    pub(super) maps: Vec<Arc<[Word]>>,
    pub(super) slices: Vec<SliceMessages>,
}

#[derive(Clone, Debug)]
pub(super) struct SliceMessages {
    pub(super) load: SliceLoad,
    /// Tiles of each region, one message each.
    pub(super) tiles: Vec<Vec<Arc<[Word]>>>,
}

impl SliceTraffic {
    /// Returns the messages for the slices of a volume that a renderer has drawn. Returns `None` if the tiles cannot be
    /// sent (see [`spatialgl::perspecta::volume_messages`]).
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
                // A tile that overlaps two regions is sent with the region of its upper left corner.
                let [left, top, ..] = tiling.grid(size).rectangle(tile.tile);
                let region = top / REGION_SIZE * columns + left / REGION_SIZE;
                slices[tile.slice as usize].tiles[region as usize].push(tile.words);
            }
        }
        Some(Self { size, maps, slices })
    }

    /// Returns the number of tiles that are sent, summed over all slices.
    pub fn tiles(&self) -> u64 {
        self.slices.iter().flat_map(|slice| &slice.tiles).map(|region| region.len() as u64).sum()
    }

    /// Returns the number of regions with at least one tile to send. Each of these regions is copied to the backing
    /// store.
    pub fn copies(&self) -> u64 {
        self.slices.iter().flat_map(|slice| &slice.tiles).filter(|region| !region.is_empty()).count() as u64
    }
}
