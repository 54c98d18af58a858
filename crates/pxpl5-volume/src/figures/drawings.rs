//! Figures 4 to 12 of the SpatialGL paper, drawn again. The model computes every pixel of the drawings.
//!
//! Some drawings are plans: the display seen from above, with +x to the right and +z up. The display of the plans has
//! few slices, so that a single slice is visible.

use crate::choices::{ClipKind, ProjectionKind};
use crate::experiment::Volume;
use crate::pictures::{grid, tiles_of_slice};
use crate::settings::VolumeSettings;
use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use spatialgl::{
    BinLayout, BinTolerance, ColouredVertex, DrawContext, SpatialDisplay, SweptDisplay, Tiling, Topology, VertexBuffer,
    Workers,
};

/// A figure of the SpatialGL paper, drawn again.
#[derive(Clone, Debug)]
pub struct FigureDrawing {
    /// Number of the figure in the SpatialGL paper.
    pub number: u32,
    /// Subject of the figure in the SpatialGL paper's caption, and meaning of the pixels.
    pub about: &'static str,
    /// Pixels of the drawing.
    pub picture: RgbImage,
}

/// Width and height of each drawing, pixels.
const SIDE: u32 = 256;

/// Number of slices per turn of the display in the plans (views from above).
const FEW_SLICES: u64 = 12;

const DARK: Rgb<u8> = Rgb([16, 16, 24]);
const LIT: Rgb<u8> = Rgb([240, 200, 80]);

const COLOURS: [[u8; 3]; 8] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
    [150, 150, 150],
];

/// Returns all nine drawings. The drawing of the tile query shows `scene`.
///
/// # Errors
///
/// Returns [`SettingError`] if the scene cannot be drawn.
pub fn drawings(scene: &Scene, workers: &dyn Workers) -> Result<Vec<FigureDrawing>, SettingError> {
    let drawing = |number, about, picture| FigureDrawing { number, about, picture };
    Ok(vec![
        drawing(4, "slice volume: the double wedge of one slice of 12, seen along the axis", plan(ClipKind::Exact)?),
        drawing(5, "slice orientation: where the signed distances from the two planes are positive", orientation()?),
        drawing(6, "taper: the wedge with room at the axis", plan(ClipKind::Tapered)?),
        drawing(7, "biased evaluation: both planes moved outwards", plan(ClipKind::Parallel)?),
        drawing(8, "hyperbola: a bias added to the product of both planes", plan(ClipKind::Hyperbolic)?),
        drawing(
            9,
            "sliver: a wall 20 px from the axis in slices that meet it ever more steeply; exact above, hyperbola below",
            sliver(workers)?,
        ),
        drawing(
            10,
            "bin planes: the eight sectors; opposite ones are one double wedge and have one colour",
            bin_plan(),
        ),
        drawing(
            11,
            "outcodes: rows are sectors 0 to 7, columns the planes x + z, x - z, x, z; white is positive; coloured, what a triangle touches",
            outcodes(),
        ),
        drawing(12, "tile query: tiles in which something was drawn, of slice 50", tile_query(scene, workers)?),
    ])
}

impl FigureDrawing {
    /// Returns all drawings on one sheet, three in a row.
    pub fn sheet(all: &[Self]) -> RgbImage {
        let framed: Vec<RgbImage> = all.iter().map(|drawing| framed(&drawing.picture)).collect();
        grid(&framed, 3)
    }
}

fn framed(picture: &RgbImage) -> RgbImage {
    RgbImage::from_fn(picture.width() + 4, picture.height() + 4, |x, y| {
        let is_inside = x >= 2 && y >= 2 && x < picture.width() + 2 && y < picture.height() + 2;
        if is_inside { *picture.get_pixel(x - 2, y - 2) } else { Rgb([96; 3]) }
    })
}

/// Returns a display of 12 slices with a radius of 64 px, a clip offset of 8 px and the corresponding bias of 64 px^2.
fn few(clip: ClipKind) -> Result<SweptDisplay, SettingError> {
    let mut settings = VolumeSettings { clip, projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() };
    settings.display.slices = FEW_SLICES;
    settings.display.width = 128;
    settings.display.height = 128;
    settings.clip_numbers.offset_px = 8.0;
    settings.clip_numbers.bias_px2 = 64.0;
    settings.swept_display()
}

/// Returns the world position of a pixel of the plan (view from above).
fn place(x: u32, y: u32) -> [f64; 3] {
    let half = f64::from(SIDE) / 2.0;
    let scale = 80.0 / half;
    [(f64::from(x) + 0.5 - half) * scale, 0.0, (half - f64::from(y) - 0.5) * scale]
}

/// Draws the volumes of three neighbouring slices, seen from above. The volume of slice 1 is bright, and the volumes of
/// its neighbours are darker. Overlaps of enlarged volumes are white.
fn plan(clip: ClipKind) -> Result<RgbImage, SettingError> {
    let display = few(clip)?;
    let views = display.views();
    Ok(RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let point = place(x, y);
        let is_outside = point[0].hypot(point[2]) > 64.0;
        // Colour a point by the slices that accept it.
        match [0, 1, 2].map(|k: usize| views[k].accepts(point.into())) {
            _ if is_outside => Rgb([32, 32, 40]),
            [false, true, false] => LIT,
            [_, true, _] => Rgb([255, 255, 255]),
            [true, ..] => Rgb([40, 70, 100]),
            [.., true] => Rgb([70, 100, 40]),
            _ => DARK,
        }
    }))
}

/// Draws the disc of a display seen from above, to show the volume of one slice.
///
/// Two vertical planes through the axis bound a slice. Between the planes lie two opposite wedges (a double wedge).
/// Points are red on the positive side of the first plane, and green on the positive side of the second plane. So the
/// wedge on the positive side of both planes is yellow, and the opposite wedge is dark.
fn orientation() -> Result<RgbImage, SettingError> {
    let display = few(ClipKind::Exact)?;
    let spatialgl::SliceVolume::Wedge(planes, _) = display.views()[1].volume else {
        return Ok(RgbImage::new(SIDE, SIDE));
    };
    Ok(RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let [px, _, pz] = place(x, y);
        let positive = [planes.a, planes.b].map(|plane| plane[0] * px + plane[1] * pz >= 0.0);
        Rgb([64 + 160 * u8::from(positive[0]), 64 + 160 * u8::from(positive[1]), 64])
    }))
}

/// Draws the wall z = 20 in slices 20, 50, 70 and 90 of 396. From each of these slices to the next, the exact volume
/// contains fewer pixels of the wall.
fn sliver(workers: &dyn Workers) -> Result<RgbImage, SettingError> {
    let wall = [[-380.0, -64.0, 20.0], [380.0, -64.0, 20.0], [380.0, 64.0, 20.0], [-380.0, 64.0, 20.0]];
    let mut columns = Vec::new();
    for clip in [ClipKind::Exact, ClipKind::Hyperbolic] {
        let buffer = VertexBuffer::new(wall.map(|corner| ColouredVertex::new(corner.into(), [255; 3])).to_vec())?;
        let mut context = DrawContext::default();
        context.draw(&buffer, 0..4, Topology::TriangleFan)?;
        let settings = VolumeSettings { clip, projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() };
        let volume = Volume::draw_commands(&settings, "wall", context.present(), workers)?;
        for slice in [20, 50, 70, 90] {
            let whole = crate::pictures::coloured(&volume, slice);
            let part = imageops::crop_imm(&whole, 384, 376, 64, 16).to_image();
            columns.push(imageops::resize(&part, SIDE, SIDE / 8, FilterType::Nearest));
        }
    }
    // Draw a line between the rows.
    let mut picture = grid(&columns, 1);
    for row in 1..8 {
        for x in 0..SIDE {
            picture.put_pixel(x, row * SIDE / 8, Rgb([96, 96, 120]));
        }
    }
    Ok(picture)
}

fn bin_plan() -> RgbImage {
    let layout = BinLayout::double_wedges(0.0);
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        // The signs of a point determine its sector.
        let code = layout.code(place(x, y));
        let sector = layout.regions.iter().position(|region| region.signs == code);
        sector.map_or(DARK, |sector| {
            let shade = if sector < 4 { 1.0 } else { 0.6 };
            Rgb(COLOURS[sector % 4].map(|level| (f64::from(level) * shade) as u8))
        })
    })
}

/// Draws a diagram with a row for each sector of the disc. A test triangle over sectors 0, 1 and 7 marks the sectors
/// that it touches.
fn outcodes() -> RgbImage {
    let layout = BinLayout::double_wedges(0.0);
    let triangle = [[3.3, -50.2, 2.1], [9.7, -50.2, -4.4], [5.1, 60.6, 6.3]];
    let touched = layout.touched_regions(&triangle, BinTolerance::Codes);
    let cell = SIDE / 8;
    RgbImage::from_fn(SIDE, SIDE, |x, y| {
        let sector = (y / cell) as usize;
        let column = x / cell;
        let is_gap = x % cell < 2 || y % cell < 2;
        let is_touched = touched >> sector & 1 == 1;
        // Four columns of signs, a gap, then three columns for touched sectors.
        match column {
            _ if is_gap => DARK,
            0..=3 => Rgb([if layout.regions[sector].signs >> (3 - column) & 1 == 1 { 240 } else { 60 }; 3]),
            5..=7 if is_touched => Rgb(COLOURS[sector % 4]),
            _ => DARK,
        }
    })
}

fn tile_query(scene: &Scene, workers: &dyn Workers) -> Result<RgbImage, SettingError> {
    let volume = Volume::draw(&VolumeSettings::paper(), scene, workers)?;
    let whole = tiles_of_slice(&volume, 50, Tiling::PAPER);
    Ok(imageops::resize(&whole, SIDE, SIDE, FilterType::Triangle))
}
