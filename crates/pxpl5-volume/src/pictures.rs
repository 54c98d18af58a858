//! Pictures of a volume: all slices, one slice before and after halftoning, tiles, and the view of an eye.

use crate::experiment::Volume;
use crate::settings::VolumeSettings;
use image::imageops::{self, FilterType};
use image::{GenericImage, Rgb, RgbImage};
use pxpl5_sim::parameters::SettingError;
use spatialgl::perspecta::{Camera, PictureLight, ViewOptions, film, view_planes, view_undithered};
use spatialgl::{SpatialDisplay, Strobes, Tiling, Workers};

/// Number of thumbnails per row of a sheet: 22 x 18 thumbnails show the SpatialGL paper's 396 slices.
pub const SHEET_COLUMNS: u32 = 22;

/// Distance from one thumbnail of a sheet to the next, in pixels.
const THUMBNAIL: u32 = 64;

/// Fraction of the lit pixels in a view that stay below white at the chosen exposure.
const BELOW_WHITE: f64 = 0.98;

/// Number of batches of slices side by side in the picture of all tiles ([`tile_map`]).
const MAP_COLUMNS: u32 = 11;

/// The position of an eye in front of a volume, and the options of its view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeView {
    /// Position of the eye and size of its picture.
    pub camera: Camera,
    /// Options of the view, such as a range of angles in which nothing is shown.
    pub options: ViewOptions,
    /// True if the view shows the colours before halftoning.
    pub is_undithered: bool,
}

impl EyeView {
    /// Creates the view of an eye four radii away, with a picture of `side` x `side` pixels.
    pub fn around(settings: &VolumeSettings, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Self {
        let camera = Camera::around(settings.radius(), azimuth_deg, elevation_deg, side);
        let phase_deg = settings.sweep.phase_deg;
        let options = ViewOptions { phase_deg, rotation: settings.rotation, ..ViewOptions::default() };
        Self { camera, options, is_undithered: false }
    }

    /// Checks that the camera can view a display with these settings.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the number that is out of range.
    pub fn check(&self, settings: &VolumeSettings) -> Result<(), SettingError> {
        let display = &settings.display;
        self.camera.check_before([display.width as u32, display.height as u32])
    }

    /// Returns the light that reaches the eye during one turn of the screen.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the camera is invalid.
    pub fn light(&self, volume: &Volume, workers: &dyn Workers) -> Result<PictureLight, SettingError> {
        let undithered = match self.is_undithered {
            true => view_undithered(&volume.frame, &self.camera, self.options, workers)?,
            false => None,
        };
        match undithered {
            Some(light) => Ok(light),
            None => Ok(view_planes(&volume.frame.planes, &self.camera, self.options, workers)?),
        }
    }

    /// Returns the picture with the exposure `exposure`. With `None`, the picture has the exposure that
    /// [`Self::exposure`] returns.
    ///
    /// # Errors
    ///
    /// The same as [`Self::light`].
    pub fn picture(
        &self,
        volume: &Volume,
        exposure: Option<f64>,
        workers: &dyn Workers,
    ) -> Result<RgbImage, SettingError> {
        let light = self.light(volume, workers)?;
        Ok(light.picture(exposure.unwrap_or_else(|| light.exposure(BELOW_WHITE))))
    }

    /// Returns the exposure at which 98 % of the lit pixels stay below white.
    ///
    /// # Errors
    ///
    /// The same as [`Self::light`].
    pub fn exposure(&self, volume: &Volume, workers: &dyn Workers) -> Result<f64, SettingError> {
        Ok(self.light(volume, workers)?.exposure(BELOW_WHITE))
    }

    /// Returns pictures of the volume from viewpoints on a circle around the volume, all with the same exposure.
    pub fn film<'a>(
        &self,
        volume: &'a Volume,
        frames: u32,
        workers: &'a dyn Workers,
    ) -> impl Iterator<Item = Result<RgbImage, SettingError>> + use<'a> {
        film(&volume.frame.planes, self.camera, self.options, frames, workers)
    }
}

/// Returns all slices as thumbnails, row by row.
pub fn sheet(volume: &Volume) -> RgbImage {
    let slices = volume.frame.planes.slices();
    let columns = SHEET_COLUMNS.min(slices);
    let mut all = RgbImage::from_pixel(columns * THUMBNAIL, slices.div_ceil(columns) * THUMBNAIL, Rgb([48; 3]));
    let [width, height] = volume.frame.planes.size();
    let longest = width.max(height);
    let inner = THUMBNAIL - 2;
    let side = |length: u32| (length * inner / longest).max(1);
    for k in 0..slices {
        let thumbnail = imageops::thumbnail(&halftoned(volume, k), side(width), side(height));
        let place = (k % columns * THUMBNAIL + 1, k / columns * THUMBNAIL + 1);
        // A thumbnail is smaller than its place, so copying cannot fail.
        let _ = all.copy_from(&thumbnail, place.0, place.1);
    }
    all
}

/// Returns a slice after halftoning, with each channel of a pixel on or off.
///
/// # Panics
/// Panics if there is no such slice ([`Volume::check_slice`]).
pub fn halftoned(volume: &Volume, slice: u32) -> RgbImage {
    let planes = &volume.frame.planes;
    let [width, height] = planes.size();
    let mut picture = RgbImage::new(width, height);
    for (at, word) in (0u32..).zip(planes.slice(slice)).filter(|(_, word)| **word != 0) {
        let row = at / (width / 8);
        let left = at % (width / 8) * 8;
        for pixel in 0..8 {
            let bits = spatialgl::pixel_of_word(*word, pixel);
            picture.put_pixel(left + pixel, row, Rgb([0, 1, 2].map(|channel| 255 * (bits >> channel & 1))));
        }
    }
    picture
}

/// Returns a slice before halftoning, with all 256 levels.
///
/// # Panics
/// The same as [`halftoned`].
pub fn coloured(volume: &Volume, slice: u32) -> RgbImage {
    let [width, height] = volume.frame.planes.size();
    let background = volume.commands.background();
    let mut picture = RgbImage::from_pixel(width, height, Rgb(background));
    let Some(colours) = &volume.frame.colours else { return picture };
    let drawn = colours.len() as u32;
    // A mirrored slice has no colours of its own.
    let is_mirrored = volume.settings.strobes == Strobes::Mirror && slice >= drawn;
    for sample in &colours[(slice % drawn) as usize] {
        let x = sample.pixel % width;
        let column = if is_mirrored { width - 1 - x } else { x };
        picture.put_pixel(column, sample.pixel / width, Rgb(sample.colour));
    }
    picture
}

/// Returns a slice before and after halftoning, side by side.
///
/// # Panics
/// The same as [`halftoned`].
pub fn before_and_after(volume: &Volume, slice: u32) -> RgbImage {
    beside(&[coloured(volume, slice), halftoned(volume, slice)])
}

/// Returns a picture of the tiles of every batch of slices, row by row. Each tile is shown as a square of 3 x 3 pixels.
/// Tiles with lit pixels are white. Returns `None` if the volume was drawn without tiles.
pub fn tile_map(volume: &Volume) -> Option<RgbImage> {
    let tile = u32::try_from(volume.settings.tile.size).ok().filter(|tile| *tile > 0)?;
    let colours = volume.frame.colours.as_ref()?;
    let [width, height] = volume.display.target_size();
    let grid = [width.div_ceil(tile), height.div_ceil(tile)];
    let batch = volume.settings.tile.batch as usize;
    let batches = colours.chunks(batch);
    let rows = (batches.len() as u32).div_ceil(MAP_COLUMNS);
    let columns = MAP_COLUMNS.min(batches.len() as u32);
    let mut map = RgbImage::from_pixel(columns * (grid[0] + 1), rows * (grid[1] + 1), Rgb([64, 64, 96]));
    for (i, slices) in (0u32..).zip(batches) {
        // A line of one pixel separates the batches.
        let place = [i % MAP_COLUMNS * (grid[0] + 1), i / MAP_COLUMNS * (grid[1] + 1)];
        fill(&mut map, place, grid, Rgb([0; 3]));
        for sample in slices.iter().flatten() {
            let x = sample.pixel % width / tile;
            let y = sample.pixel / width / tile;
            map.put_pixel(place[0] + x, place[1] + y, Rgb([255; 3]));
        }
    }
    // Enlarge the map, since a tile is a single pixel.
    let scale = 3;
    let [map_width, map_height] = [map.width() * scale, map.height() * scale];
    Some(imageops::resize(&map, map_width, map_height, FilterType::Nearest))
}

fn fill(picture: &mut RgbImage, [left, top]: [u32; 2], [width, height]: [u32; 2], colour: Rgb<u8>) {
    for y in top..top + height {
        for x in left..left + width {
            picture.put_pixel(x, y, colour);
        }
    }
}

/// Returns a slice with its tiles. Occupied tiles, which are sent, are lighter than empty tiles. Drawn pixels are
/// white.
///
/// # Panics
/// The same as [`halftoned`].
pub fn tiles_of_slice(volume: &Volume, slice: u32, tiling: Tiling) -> RgbImage {
    let picture = coloured(volume, slice);
    let grid = tiling.grid(volume.display.target_size());
    let mut shown = RgbImage::new(picture.width(), picture.height());
    for tile in 0..grid.tiles() {
        let [left, top, right, bottom] = grid.rectangle(tile);
        // A tile is occupied if any of its pixels is lit.
        let places = || (top..bottom).flat_map(move |y| (left..right).map(move |x| (x, y)));
        let is_lit = |(x, y): (u32, u32)| picture.get_pixel(x, y).0 != [0; 3];
        let is_occupied = places().any(is_lit);
        for (x, y) in places() {
            let is_edge = x == left || y == top;
            let colour = match (is_lit((x, y)), is_occupied, is_edge) {
                (true, ..) => [255; 3],
                (false, true, false) => [64, 96, 64],
                (false, true, true) => [96, 144, 96],
                (false, false, true) => [48; 3],
                (false, false, false) => [16; 3],
            };
            shown.put_pixel(x, y, Rgb(colour));
        }
    }
    shown
}

/// Returns the pictures side by side as one picture, which is as high as the highest picture.
pub fn beside(pictures: &[RgbImage]) -> RgbImage {
    grid(pictures, pictures.len().max(1) as u32)
}

/// Returns the pictures in rows of `columns` as one picture. Each cell of this grid is as large as the largest picture.
pub fn grid(pictures: &[RgbImage], columns: u32) -> RgbImage {
    let width = pictures.iter().map(RgbImage::width).max().unwrap_or(1);
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(1);
    let rows = (pictures.len() as u32).div_ceil(columns).max(1);
    let mut all = RgbImage::new(width * columns, height * rows);
    for (i, picture) in (0u32..).zip(pictures) {
        // Every picture fits its place, so copying cannot fail.
        let _ = all.copy_from(picture, i % columns * width, i / columns * height);
    }
    all
}
