//! Measurements of a volume: connectedness of surfaces, number of lit pixels by radius, and the dark zone at the axis.

use crate::command::CommandBuffer;
use crate::curve::plane_curve;
use crate::frame::{BitPlanes, ColourSample, VolumeFrame};
use crate::raster::Bin;
use crate::view::{SliceView, SpatialDisplay};
use glam::DVec3;
use serde::Serialize;

/// Counts of sample points along the curves in which the slices intersect a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Connected {
    /// Number of samples inside the image. Neighbouring samples are at most a pixel apart.
    pub samples: u64,
    /// Number of shown samples. A sample is shown if its pixel, or one of the eight neighbouring pixels, is drawn.
    pub shown: u64,
}

impl Connected {
    /// Returns the percentage of samples that are shown. The result is 100 if there are no samples.
    pub fn percent(&self) -> f64 {
        if self.samples == 0 { 100.0 } else { 100.0 * self.shown as f64 / self.samples as f64 }
    }
}

/// Measures how connected the surfaces of a mesh appear on a swept display. Returns `None` if the frame was made
/// without its colours ([`VolumeConfig::keeps_colours`](crate::VolumeConfig::keeps_colours)), because gaps that the
/// dither makes would then count as gaps in surfaces.
pub fn connected(display: &dyn SpatialDisplay, commands: &CommandBuffer, frame: &VolumeFrame) -> Option<Connected> {
    let colours = frame.colours.as_ref()?;
    let size = display.target_size();
    let all = Bin::new(commands, (0..commands.primitives() as u32).collect());
    let mut found = Connected::default();
    for (view, drawn) in display.views().iter().zip(colours) {
        // A sample counts as shown if it lies in a drawn pixel or next to one.
        let around = Around::new(size, drawn);
        each_curve(view, commands, &all, |ends| {
            around.samples(view, ends, |_, is_shown| {
                found.samples += 1;
                found.shown += u64::from(is_shown);
            });
        });
    }
    Some(found)
}

fn each_curve(view: &SliceView, commands: &CommandBuffer, all: &Bin, mut each: impl FnMut([[f64; 3]; 2])) {
    // Clusters away from the slice are skipped.
    let row = view.view.transpose().z_axis.to_array();
    for primitive in all.clusters().flat_map(|cluster| cluster.reaching(&row, [0.0, 0.0])) {
        let Some(triangle) = commands.triangle(primitive) else { continue };
        let local = triangle.corners.map(|corner| view.local(DVec3::from_array(corner)).to_array());
        if let Some((ends, _)) = plane_curve(local) {
            each(ends);
        }
    }
}

/// Measures how similar the gaps of neighbouring slices are. For each pair of neighbours, the percentages of shown
/// samples in each row are correlated over the rows of the image. The result is the mean over all pairs: 1 for a
/// pattern that all slices share, near 0 for noise.
///
/// Returns `None` for frames without colours, as [`connected`] does, and for volumes without gaps.
pub fn gap_correlation(display: &dyn SpatialDisplay, commands: &CommandBuffer, frame: &VolumeFrame) -> Option<f64> {
    let colours = frame.colours.as_ref()?;
    let size = display.target_size();
    let all = Bin::new(commands, (0..commands.primitives() as u32).collect());
    let rows: Vec<Vec<Connected>> = display
        .views()
        .iter()
        .zip(colours)
        .map(|(view, drawn)| rows_of_slice(view, commands, &all, &Around::new(size, drawn), size[1]))
        .collect();
    // Pairs without gaps have no correlation and are left out.
    let pairs = rows.windows(2).filter_map(|pair| correlation(&pair[0], &pair[1]));
    let (sum, count) = pairs.fold((0.0, 0u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

fn rows_of_slice(
    view: &SliceView,
    commands: &CommandBuffer,
    all: &Bin,
    around: &Around,
    height: u32,
) -> Vec<Connected> {
    let mut rows = vec![Connected::default(); height as usize];
    each_curve(view, commands, all, |ends| {
        around.samples(view, ends, |y, is_shown| {
            rows[y as usize].samples += 1;
            rows[y as usize].shown += u64::from(is_shown);
        });
    });
    rows
}

/// Returns Pearson's correlation of the percentages of shown samples in two slices, over the rows that have samples in
/// both slices. Returns `None` if the percentage is constant in either slice.
fn correlation(one: &[Connected], other: &[Connected]) -> Option<f64> {
    let both: Vec<[f64; 2]> = one
        .iter()
        .zip(other)
        .filter(|(a, b)| a.samples > 0 && b.samples > 0)
        .map(|(a, b)| [a.percent(), b.percent()])
        .collect();
    let count = both.len() as f64;
    let mean = [0, 1].map(|i| both.iter().map(|pair| pair[i]).sum::<f64>() / count);
    // Covariance of two columns, not divided by the count.
    let product = |i: usize, j: usize| both.iter().map(|pair| (pair[i] - mean[i]) * (pair[j] - mean[j])).sum::<f64>();
    let spread = (product(0, 0) * product(1, 1)).sqrt();
    (spread > 0.0).then(|| product(0, 1) / spread)
}

/// The drawn pixels of a slice, each enlarged to include its eight neighbours.
struct Around {
    size: [u32; 2],
    near: Vec<bool>,
}

impl Around {
    fn new(size: [u32; 2], drawn: &[ColourSample]) -> Self {
        let [width, height] = size;
        let mut near = vec![false; width as usize * height as usize];
        for sample in drawn {
            let x = sample.pixel % width;
            let y = sample.pixel / width;
            // Mark the pixel and its eight neighbours inside the image.
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    near[(row * width + column) as usize] = true;
                }
            }
        }
        Self { size, near }
    }

    /// Calls `each` for every sample inside the image along a curve. The arguments of `each` are the row of the sample,
    /// and a boolean that is true if the sample is shown.
    fn samples(&self, view: &SliceView, ends: [[f64; 3]; 2], mut each: impl FnMut(u32, bool)) {
        let [from, to] = ends.map(|end| pixel_of(view, end, self.size));
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let steps = length.ceil().max(1.0);
        for i in 0..steps as u32 {
            // Samples are in the middle of each step, so no point is counted for two triangles.
            let t = (f64::from(i) + 0.5) / steps;
            let [x, y] = [0, 1].map(|axis| from[axis] * (1.0 - t) + to[axis] * t);
            if x >= 0.0 && y >= 0.0 && x < f64::from(self.size[0]) && y < f64::from(self.size[1]) {
                each(y as u32, self.near[y as usize * self.size[0] as usize + x as usize]);
            }
        }
    }
}

fn pixel_of(view: &SliceView, local: [f64; 3], size: [u32; 2]) -> [f64; 2] {
    let clip = view.projection * DVec3::from_array(local).extend(1.0);
    let [width, height] = size.map(f64::from);
    [(clip.x / clip.w + 1.0) * width / 2.0, (1.0 - clip.y / clip.w) * height / 2.0]
}

/// Returns, for each ring around the axis, the number of lit pixels in all slices. Rings are `ring` pixels wide, and
/// distances are measured from the middle column.
pub fn brightness_by_radius(planes: &BitPlanes, ring: u32) -> Vec<u64> {
    let [width, _] = planes.size();
    let radius = width / 2;
    let mut rings = vec![0; radius.div_ceil(ring.max(1)) as usize];
    for (x, lit) in (0..width).zip(lit_by_column(planes)) {
        let distance = if x < radius { radius - 1 - x } else { x - radius };
        rings[(distance / ring.max(1)) as usize] += lit;
    }
    rings
}

/// Returns the radius in pixels around the axis within which no pixel of any slice is lit. Returns `None` if no pixel
/// is lit.
pub fn innermost_lit_radius(planes: &BitPlanes) -> Option<u32> {
    brightness_by_radius(planes, 1).iter().position(|lit| *lit > 0).map(|radius| radius as u32)
}

/// Returns the radius in pixels of the display's dead zone around the axis. In the dead zone, no slice can show any
/// point of any scene.
///
/// Each column of pixels is tested at two points, one on each side of the axis, at half of the volume's height. The
/// column belongs to the dead zone if no slice accepts either of the two points. Returns `None` if no slice accepts any
/// column.
pub fn dead_zone_radius(display: &dyn SpatialDisplay) -> Option<u32> {
    let to_world: Vec<_> = display.views().iter().map(|view| view.view.inverse()).collect();
    let is_shown = |column: &u32| {
        let radius = f64::from(*column) + 0.5;
        let sides = [radius, -radius].map(|x| DVec3::new(x, 0.0, 0.0));
        to_world
            .iter()
            .enumerate()
            .any(|(view, to_world)| sides.iter().any(|local| display.accepts(view, to_world.transform_point3(*local))))
    };
    (0..display.target_size()[0] / 2).find(is_shown)
}

fn lit_by_column(planes: &BitPlanes) -> Vec<u64> {
    let row = (planes.size()[0] / 8) as usize;
    let mut columns = vec![0; row * 8];
    for (at, word) in planes.words.iter().enumerate().filter(|(_, word)| **word != 0) {
        let lit = word | word >> 8 | word >> 16;
        for pixel in 0..8 {
            columns[at % row * 8 + pixel] += u64::from(lit >> (7 - pixel) & 1);
        }
    }
    columns
}
