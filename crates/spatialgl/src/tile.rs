//! Tiles of slices, and the queries that find the occupied tiles.

use crate::image::SliceImage;
use crate::projection::Size;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// The division of slice images into tiles, and the number of slices per query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tiling {
    /// Side of a tile in pixels, a multiple of 8. With `None` there are no tiles, and every pixel is packed and sent.
    pub tile: Option<u32>,
    /// Number of slices in a batch. The slices of a batch share one clear of the stencil and the queries of tiles.
    pub batch: u32,
}

impl Tiling {
    /// Tiles of 32 x 32 pixels and queries after every 4 slices, both published in the SpatialGL paper.
    pub const PAPER: Self = Self { tile: Some(32), batch: 4 };

    /// Setting without tiles: every pixel of every slice is packed and sent.
    pub const OFF: Self = Self { tile: None, batch: 4 };

    /// Checks that tiles are whole words wide and that batches contain at least one slice.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the invalid number, the expected range and the found value.
    pub fn check(self) -> Result<(), SettingError> {
        if let Some(tile) = self.tile {
            SettingError::require((8..=4096).contains(&tile), "tile.size", "8 to 4096", tile)?;
            SettingError::require(tile.is_multiple_of(8), "tile.size", "a multiple of 8", tile)?;
        }
        SettingError::require(self.batch >= 1, "tile.batch", "1 or more", self.batch)
    }

    /// Returns the grid of tiles of an image. Without tiles, the grid has one tile that covers the whole image.
    pub fn grid(self, size: Size) -> TileGrid {
        let tile = self.tile.unwrap_or_else(|| size[0].max(size[1]).next_multiple_of(8));
        TileGrid { size, tile, columns: size[0].div_ceil(tile), rows: size[1].div_ceil(tile) }
    }
}

/// The tiles of an image, row by row from the top left. Tiles at the right and lower edges may be smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileGrid {
    size: Size,
    tile: u32,
    columns: u32,
    rows: u32,
}

impl TileGrid {
    pub const fn tiles(&self) -> u32 {
        self.columns * self.rows
    }

    /// Returns left, top, right and bottom of a tile in pixels. Right and bottom are exclusive.
    pub fn rectangle(&self, tile: u32) -> [u32; 4] {
        let left = tile % self.columns * self.tile;
        let top = tile / self.columns * self.tile;
        [left, top, (left + self.tile).min(self.size[0]), (top + self.tile).min(self.size[1])]
    }

    /// Returns the number of words in a tile. A word has eight pixels.
    pub fn words(&self, tile: u32) -> u64 {
        let [left, top, right, bottom] = self.rectangle(tile);
        u64::from((right - left) / 8) * u64::from(bottom - top)
    }

    pub(crate) fn mark(&self, image: &SliceImage, tiles: &mut [bool]) {
        let row_bytes = self.size[0] as usize / 8;
        let tile_bytes = self.tile as usize / 8;
        let rows_of_tiles = image.stencil.chunks(row_bytes * self.tile as usize);
        let mut any = vec![0u8; row_bytes];
        for (rows, tiles) in rows_of_tiles.zip(tiles.chunks_mut(self.columns as usize)) {
            // Combine the stencil rows of one row of tiles, then read the bytes of each tile once.
            any.fill(0);
            for row in rows.chunks_exact(row_bytes) {
                any.iter_mut().zip(row).for_each(|(any, byte)| *any |= byte);
            }
            for (is_marked, bytes) in tiles.iter_mut().zip(any.chunks(tile_bytes)) {
                *is_marked |= bytes.iter().any(|byte| *byte != 0);
            }
        }
    }
}
