use crate::oracle::picture::{DepthBuffer, IdealPicture};
use crate::oracle::shade::{Paint, Surface, component, normal};
use crate::oracle::sphere::SpherePoint;
use crate::oracle::widths::Widths;
use crate::{DisplayList, FrameView, Picture, PlacedStructure, Shading, place_all, shade};
use pxpl5_geometry::{GouraudTriangle, Outline, RegionMask, SetupStats, Transform};
use pxpl5_wire::Linear;
use pxpl5_wire::format::SUBPIXEL_BITS;
use std::ops::Range;

/// Returns the ideal picture of a display list for one eye of a view. `eye` is 0 for a single or left eye, 1 for a
/// right eye.
///
/// `picture` defines the lines, the shading and the layout of pixel memory. `picture.binning` and `picture.pixels` have
/// no effect.
///
/// # Panics
///
/// Panics if the view has no eye.
pub fn ideal_picture(list: &DisplayList, view: &FrameView, eye: usize, picture: &Picture) -> IdealPicture {
    ideal_picture_of(list, |_| true, view, eye, picture)
}

/// Returns the ideal picture of some structures. `chosen` returns true for the index of a structure that is drawn.
///
/// # Panics
///
/// Panics if the view has no eye.
pub fn ideal_picture_of(
    list: &DisplayList,
    chosen: impl Fn(usize) -> bool,
    view: &FrameView,
    eye: usize,
    picture: &Picture,
) -> IdealPicture {
    let placed = place_all(list, view, eye, picture.viewport);
    let widths = Widths::of_layout(&picture.layout);
    let raster = Raster { list, picture, widths };
    let grid = picture.viewport.grid();
    let mut buffer = DepthBuffer::new(grid.width, grid.height, widths.stored_depth(u32::MAX));
    // Draw the primitives in the order of the display list. The buffer keeps the nearest primitive of each pixel.
    for (_, place) in placed.iter().enumerate().filter(|(number, _)| chosen(*number)) {
        let Some(transform) = &place.transform else { continue };
        let placed = Placed { place, transform };
        place.structure.triangles.clone().for_each(|number| raster.triangle(&placed, number, &mut buffer));
        place.structure.spheres.clone().for_each(|number| raster.sphere(&placed, number, &mut buffer));
    }
    // Phong surfaces are shaded at the end, as on the machine.
    let shade = shade(placed.first().map(|first| &first.light), list.is_matte);
    buffer.finish(list.background, |paint| paint.colour(&shade), |stored| widths.sent_depth(stored))
}

struct Raster<'a> {
    list: &'a DisplayList,
    picture: &'a Picture,
    widths: Widths,
}

struct Placed<'a> {
    place: &'a PlacedStructure,
    transform: &'a Transform,
}

impl Raster<'_> {
    fn triangle(&self, Placed { place, transform }: &Placed<'_>, number: usize, buffer: &mut DepthBuffer) {
        let viewport = &self.picture.viewport;
        let triangle = self.list.triangle(number);
        // The counts of clipped, dropped and flattened primitives are the same as on the machine, so they are not
        // needed here.
        let mut stats = SetupStats::default();
        let light = place.light_of_corners(self.picture.shading);
        let mut lit = |outline: &Outline, planes: &GouraudTriangle| {
            self.inside(outline, &planes.edges, |x, y| {
                let paint = || Paint::Lit(planes.rgb.map(|plane| component(&plane, x, y)));
                buffer.draw([x, y], number, self.depth(&planes.z, x, y), paint);
            });
        };
        match self.picture.shading {
            Shading::Gouraud | Shading::Precomputed if transform.is_single() => {
                transform.single_precision(&triangle, &mut stats, |seen, planes| lit(&seen.outline, &planes));
            }
            Shading::Gouraud | Shading::Precomputed => transform.gouraud(&triangle, light, &mut stats, |seen| {
                lit(&seen.outline, &seen.gouraud(viewport, &mut SetupStats::default()));
            }),
            Shading::Phong => transform.phong(&triangle, &mut stats, |seen| {
                let planes = seen.phong(viewport, &mut SetupStats::default());
                self.inside(&seen.outline, &planes.edges, |x, y| {
                    let normal = planes.normal.map(|plane| normal(&plane, x, y));
                    let paint = || Paint::Surface(Surface { normal, colour: planes.colour });
                    buffer.draw([x, y], number, self.depth(&planes.z, x, y), paint);
                });
            }),
        }
    }

    fn sphere(&self, Placed { place, transform }: &Placed<'_>, sphere: usize, buffer: &mut DepthBuffer) {
        let viewport = &self.picture.viewport;
        // Spheres are numbered after all triangles.
        let number = self.list.triangles.len() + sphere;
        let mut stats = SetupStats::default();
        let Some(seen) = transform.sphere(&self.list.spheres[sphere], &mut stats) else { return };
        match self.picture.shading {
            Shading::Gouraud | Shading::Precomputed => {
                let planes = seen.gouraud(viewport, &place.light, &mut stats);
                self.around(seen.regions, |x, y| {
                    if let Some(point) = SpherePoint::at(&planes.setup, x, y, self.widths) {
                        buffer.draw([x, y], number, point.depth, || Paint::Lit(point.colour(&planes, x, y)));
                    }
                });
            }
            Shading::Phong => {
                let planes = seen.phong(viewport, &mut stats);
                self.around(seen.regions, |x, y| {
                    if let Some(point) = SpherePoint::at(&planes.setup, x, y, self.widths) {
                        let [across, up] = planes.normal.map(|plane| normal(&plane, x, y));
                        let normal = [across, up, point.normal_z()];
                        let paint = || Paint::Surface(Surface { normal, colour: planes.colour });
                        buffer.draw([x, y], number, point.depth, paint);
                    }
                });
            }
        }
    }

    fn depth(&self, plane: &Linear, x: i32, y: i32) -> u32 {
        self.widths.stored_depth(plane.at(x, y) as u32)
    }

    fn inside(&self, outline: &Outline, edges: &[Linear; 3], mut sink: impl FnMut(i32, i32)) {
        let viewport = &self.picture.viewport;
        let grid = viewport.grid();
        let across = between(&outline.x, [0, 1], grid.width);
        let every_line = [viewport.first_line() as i32, viewport.line_step() as i32];
        for y in between(&outline.y, every_line, grid.height) {
            for x in across.clone() {
                if edges.iter().all(|edge| edge.at(x, y) >= 0) {
                    sink(x, y);
                }
            }
        }
    }

    fn around(&self, regions: RegionMask, mut sink: impl FnMut(i32, i32)) {
        let grid = self.picture.viewport.grid();
        for region in regions.iter() {
            let [left, top, width, height] = grid.rectangle(region).map(|v| v as i32);
            for y in top..top + height {
                (left..left + width).for_each(|x| sink(x, y));
            }
        }
    }
}

/// Returns the columns or rows that a triangle may cover, plus one column or row at each end.
///
/// `corners` are the positions of the triangle's corners in subpixels. Row r is line `first + r * step` of the frame.
/// The picture has `count` rows.
fn between(corners: &[i32; 3], [first, step]: [i32; 2], count: u32) -> Range<i32> {
    let low = corners.iter().copied().fold(i32::MAX, i32::min) >> SUBPIXEL_BITS;
    let high = corners.iter().copied().fold(i32::MIN, i32::max) >> SUBPIXEL_BITS;
    let begin = (low - first).div_euclid(step) - 1;
    let end = (high - first).div_euclid(step) + 2;
    let count = count as i32;
    begin.clamp(0, count)..end.clamp(0, count)
}
