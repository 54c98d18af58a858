//! Debugger views of pixels: in a renderer's pixel array, and on a display surface.

use super::words::below;
use image::RgbImage;
use pxpl5::run::bit_of;
use pxpl5::snapshots::PixelArray;
use pxpl5::{Stepper, SurfaceId};
use std::fmt::Write as _;

const SIDE: u64 = 128;

fn array(stepper: &Stepper, renderer: u64) -> Result<(impl PixelArray, usize), String> {
    let number = below("renderer", &renderer.to_string(), stepper.record().renderers().len() as u64)? as usize;
    let found = stepper.array(number).map(|array| (array, number));
    found.ok_or_else(|| format!("renderer {number} has executed no commands that change pixels (or --pixels off)"))
}

/// Returns the contents of a pixel's memory as text, divided into named bit fields.
pub(super) fn pixel(stepper: &Stepper, renderer: u64, x: u64, y: u64) -> Result<String, String> {
    let x = below("column", &x.to_string(), SIDE)?;
    let y = below("row", &y.to_string(), SIDE)?;
    let (array, number) = array(stepper, renderer)?;
    let enabled = if bit_of(&array.enable(), x as u32, y as u32) { "enabled" } else { "not enabled" };
    let mut text = format!("renderer {number}, pixel ({x}, {y}): {enabled}\n");
    for field in stepper.pixel_fields(number, x as u32, y as u32).unwrap_or_default() {
        let last = field.first + field.width - 1;
        let digits = field.width.div_ceil(4) as usize;
        let _ = writeln!(text, "bits {:>3} to {last:>3}  {:<18} {:0digits$x}", field.first, field.name, field.value);
    }
    Ok(text)
}

/// Width and height in pixels of the block that one character of a map of enabled pixels represents.
const BLOCK: (u64, u64) = (2, 4);

/// Returns a map of the enabled pixels of a renderer. A character stands for 2 x 4 pixels: `#` if all are enabled, `+`
/// if some are enabled, `.` if none is enabled.
pub(super) fn enabled(stepper: &Stepper, renderer: u64) -> Result<String, String> {
    let (array, number) = array(stepper, renderer)?;
    let plane = array.enable();
    let count: u32 = plane.iter().map(|word| word.count_ones()).sum();
    let mut text = format!("renderer {number}: {count} of {} pixels enabled\n", SIDE * SIDE);
    // Each character stands for a block of 2 x 4 pixels.
    for row in 0..SIDE / BLOCK.1 {
        let line = (0..SIDE / BLOCK.0).map(|column| {
            let pixels = (0..BLOCK.0 * BLOCK.1).map(|n| (BLOCK.0 * column + n % BLOCK.0, BLOCK.1 * row + n / BLOCK.0));
            match pixels.map(|(x, y)| u64::from(bit_of(&plane, x as u32, y as u32))).sum() {
                0 => '.',
                all if all == BLOCK.0 * BLOCK.1 => '#',
                _ => '+',
            }
        });
        text.extend(line);
        text.push('\n');
    }
    Ok(text)
}

fn surface(stepper: &Stepper, label: &str) -> Result<SurfaceId, String> {
    let surfaces: Vec<(SurfaceId, &str)> =
        stepper.record().surfaces().map(|(id, surface)| (id, surface.label)).collect();
    let found = surfaces.iter().find(|(_, candidate)| *candidate == label).map(|(id, _)| *id);
    found.ok_or_else(|| {
        let labels: Vec<&str> = surfaces.iter().map(|(_, label)| *label).collect();
        format!("surface: expected {}, found `{label}`", labels.join(" or "))
    })
}

/// Describes the picture that the display's beam has drawn so far on the surface `label`. Saves the picture if `file`
/// is a name.
pub(super) fn seen(stepper: &Stepper, label: &str, file: Option<&str>) -> Result<String, String> {
    let id = surface(stepper, label)?;
    let picture = stepper.seen(id).ok_or_else(|| format!("{label} has no picture yet"))?;
    describe_picture(&picture, label, file)
}

/// Describes the ideal picture of the surface `label` at the current time. Saves the picture if `file` is a name.
pub(super) fn ideal(stepper: &Stepper, label: &str, file: Option<&str>) -> Result<String, String> {
    let id = surface(stepper, label)?;
    let ideal = stepper.ideal_picture(id).ok_or_else(|| format!("{label} has no ideal picture"))?;
    describe_picture(ideal.image(), label, file)
}

fn describe_picture(picture: &RgbImage, label: &str, file: Option<&str>) -> Result<String, String> {
    let (width, height) = picture.dimensions();
    // The pixel at the top left serves as the background colour.
    let background = picture.get_pixel(0, 0);
    let drawn = picture.pixels().filter(|pixel| *pixel != background).count();
    let mut text = format!("{label}: {width} x {height} pixels, {drawn} differ from the upper left pixel\n");
    if let Some(file) = file {
        picture.save_with_format(file, image::ImageFormat::Png).map_err(|error| format!("{file}: {error}"))?;
        let _ = writeln!(text, "written to {file}");
    }
    Ok(text)
}
