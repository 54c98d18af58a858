//! Set-up of spheres: the image of each sphere is one quadratic expression, exact under perspective.
//!
//! A pixel's ray is `t d`. Here d is linear in the pixel's coordinates and has z = -1, so t is the distance along -Z.
//! Let c be the centre and r the radius of the sphere, u = 1/t and D = c.c - r^2. Then the ray meets the sphere where
//!
//! ```text
//! D u^2 - 2 (d.c) u + d.d = 0,   u = (d.c + sqrt(Q)) / D,   Q = (d.c)^2 - D (d.d) = r^2 d.d - |d x c|^2
//! ```
//!
//! Q is a quadratic expression in the pixel's coordinates. Q is at least 0 exactly inside the sphere's image, which is
//! an ellipse. Depth is linear in u. Depth is therefore a plane minus a multiple of the root of Q. With a parallel
//! projection, `Q = r^2 - |p - c|^2`, and depth is a constant minus a multiple of the root of Q.
//!
//! **Not drawn, but counted:** spheres that the near plane cuts, including spheres around the eye. One quadratic
//! expression cannot represent the hole in such a sphere. Spheres whose image reaches beyond the far plane are not
//! drawn either. Spheres of radius 0 have no image and count as outside the picture.
//!
//! Newton steps compute all quotients and roots, as on an i860. [`crate::sphere_kernel`] has the i860 code of the same
//! computation.

use crate::bin::Range;
use crate::conic::{Conic, Ellipse};
use crate::lens::Lens;
use crate::newton::{reciprocal_double, reciprocal_root, root};
use crate::transform::Transform;
use crate::view::{FromWorld, dot};
use crate::{RegionMask, SetupStats, WorldSphere};

/// Largest absolute value of a sphere's eye coordinates and radius, so that squares cannot overflow.
pub(crate) const MAX_COORDINATE: f64 = 1e30;

/// The elliptic image of a sphere on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenSphere {
    /// Regions that the bounding box of the sphere's image overlaps. Near the corners of the box, the image itself may
    /// not touch a region.
    pub regions: RegionMask,
    /// Red, green and blue, 0 to 255 each.
    pub colour: [u8; 3],
    /// The sphere's image as a conic `Q = bulge^2`. The bulge is the depth by which the sphere's surface is nearer than
    /// the plane `depth`, in fixed-point units.
    pub(crate) conic: Conic,
    pub(crate) ellipse: Ellipse,
    /// Plane of depth through the silhouette: its value at the conic's centre, and its slopes per pixel along x and y.
    pub(crate) depth: [f64; 3],
    pub(crate) front: f64,
    /// Directions at the sphere's centre, as unit vectors: right, up, and towards the eye.
    pub(crate) axes: [[f64; 3]; 3],
}

impl ScreenSphere {
    /// Returns true if the bounding box of the sphere's image overlaps a rectangle.
    ///
    /// `across` has the first and the last pixel column of the rectangle, and `lines` its first and last line in the
    /// video frame.
    pub fn meets(&self, across: [i32; 2], lines: [i32; 2]) -> bool {
        self.ellipse.bounds().is_some_and(|[x, y]| overlaps(pixels(x), across) && overlaps(pixels(y), lines))
    }
}

fn overlaps(range: Range, [first, last]: [i32; 2]) -> bool {
    range.first <= last && range.last >= first
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let inverse = reciprocal_root(dot(v, v));
    v.map(|c| c * inverse)
}

/// Returns a unit vector that is perpendicular to `axis` and lies in the plane of `axis` and `v`.
fn across(v: [f64; 3], axis: [f64; 3]) -> [f64; 3] {
    let along = dot(v, axis);
    unit(std::array::from_fn(|i| v[i] - along * axis[i]))
}

#[derive(Clone, Copy, Debug)]
struct EyeSphere {
    centre: [f64; 3],
    radius: f64,
}

impl EyeSphere {
    /// Returns the sphere in eye coordinates, or `None` if a number is NaN or too large, or if the radius is negative.
    fn new(to_eye: &FromWorld, sphere: &WorldSphere) -> Option<Self> {
        let [x, y, z, _] = to_eye.point(sphere.centre).map(f64::from);
        let radius = f64::from(sphere.radius) * to_eye.scale();
        let fits = [x, y, z, radius].into_iter().all(|v| v.abs() <= MAX_COORDINATE);
        (radius >= 0.0 && fits).then_some(Self { centre: [x, y, z], radius })
    }

    /// Returns the greatest distance along -Z at which a ray from the eye touches the sphere, under perspective.
    fn farthest_tangent(&self) -> f64 {
        let inverse = reciprocal_double(dot(self.centre, self.centre));
        let shrink = 1.0 - (self.radius * self.radius) * inverse;
        let tilt = 1.0 - (self.centre[2] * self.centre[2]) * inverse;
        let square = shrink * tilt;
        let beside = if square > 0.0 { self.radius * root(square) } else { 0.0 };
        -self.centre[2] * shrink + beside
    }
}

enum Sight {
    Visible,
    Outside,
    AcrossNear,
    AcrossFar,
}

impl Lens {
    fn sight(&self, sphere: &EyeSphere) -> Sight {
        let front = -sphere.centre[2] - sphere.radius;
        let back = -sphere.centre[2] + sphere.radius;
        if self.is_before_near(front) {
            return if self.is_before_near(back) { Sight::Outside } else { Sight::AcrossNear };
        }
        if self.is_beyond_far(front) {
            return Sight::Outside;
        }
        // No point of the silhouette is farther away than the back of the sphere.
        if self.is_beyond_far(back) && self.is_beyond_far(self.deepest(sphere)) {
            return Sight::AcrossFar;
        }
        Sight::Visible
    }

    fn deepest(&self, sphere: &EyeSphere) -> f64 {
        if self.parallel { -sphere.centre[2] } else { sphere.farthest_tangent() }
    }

    fn picture(&self, sphere: &EyeSphere) -> (Conic, [f64; 3]) {
        let [cx, cy, cz] = sphere.centre;
        let r = sphere.radius;
        let [gx, gy] = self.step;
        let rr = r * r;
        if self.parallel {
            let conic = Conic {
                origin: self.pixel(cx, cy),
                constant: rr,
                x: 0.0,
                y: 0.0,
                xx: -(gx * gx),
                xy: 0.0,
                yy: -(gy * gy),
            };
            return (conic.scaled(self.reach * self.reach), [self.base + self.reach * cz, 0.0, 0.0]);
        }
        let inverse = reciprocal_double(-cz);
        let dx = cx * inverse;
        let dy = cy * inverse;
        let dd = (dx * dx + dy * dy) + 1.0;
        let conic = Conic {
            origin: self.pixel(dx, dy),
            constant: rr * dd,
            x: 2.0 * rr * gx * dx,
            y: 2.0 * rr * gy * dy,
            xx: gx * gx * (rr - (cy * cy + cz * cz)),
            xy: 2.0 * gx * gy * cx * cy,
            yy: gy * gy * (rr - (cx * cx + cz * cz)),
        };
        let square = dot(sphere.centre, sphere.centre);
        let k = self.reach * reciprocal_double(square - rr);
        // At the origin d = -c / c_z, so d.c = c.c / -c_z.
        let depth = self.base + k * (square * inverse);
        (conic.scaled(k * k), [depth, k * gx * cx, k * gy * cy])
    }

    fn axes(&self, sphere: &EyeSphere) -> [[f64; 3]; 3] {
        let towards = if self.parallel { [0.0, 0.0, 1.0] } else { unit(sphere.centre.map(|v| -v)) };
        [across([1.0, 0.0, 0.0], towards), across([0.0, 1.0, 0.0], towards), towards]
    }
}

impl Transform {
    /// Projects a sphere to the screen. If the sphere is not drawn, returns `None` and counts the reason.
    ///
    /// The model-view matrix must consist of a rotation, a translation and a uniform scale. The projection must be
    /// along -Z. For other projections, the sphere counts in [`SetupStats::spheres_unprojectable`].
    pub fn sphere(&self, sphere: &WorldSphere, stats: &mut SetupStats) -> Option<ScreenSphere> {
        stats.spheres += 1;
        // Count the reason for every sphere that is not drawn.
        let Some(lens) = &self.lens else {
            stats.spheres_unprojectable += 1;
            return None;
        };
        let Some(eye) = EyeSphere::new(&self.to_eye, sphere) else {
            stats.spheres_not_finite += 1;
            return None;
        };
        match lens.sight(&eye) {
            Sight::AcrossNear => stats.spheres_across_near += 1,
            Sight::AcrossFar => stats.spheres_across_far += 1,
            Sight::Outside => stats.spheres_outside += 1,
            Sight::Visible => return self.visible(lens, &eye, sphere.colour, stats),
        }
        None
    }

    fn visible(&self, lens: &Lens, eye: &EyeSphere, colour: [u8; 3], stats: &mut SetupStats) -> Option<ScreenSphere> {
        let (conic, depth) = lens.picture(eye);
        let ellipse = conic.ellipse();
        // Bin the sphere by the bounding box of its ellipse.
        let regions = ellipse.bounds().map_or(RegionMask::EMPTY, |bounds| {
            let [x, y] = bounds.map(pixels);
            self.binner.rectangle(x, y)
        });
        if regions.is_empty() {
            stats.spheres_outside += 1;
            return None;
        }
        stats.screen_spheres += 1;
        Some(ScreenSphere {
            regions,
            colour,
            conic,
            ellipse,
            depth,
            front: lens.depth(-eye.centre[2] - eye.radius),
            axes: lens.axes(eye),
        })
    }
}

/// Margin around a bounding box, in pixels. Rounding of the quadratic expression moves the silhouette by a smaller
/// distance.
pub(crate) const SLACK: f64 = 1.0 / 64.0;

/// Returns the pixels with centres from `low` to `high`. The centre of pixel 0 is at 0.
fn pixels([low, high]: [f64; 2]) -> Range {
    Range { first: near_screen((low - SLACK).ceil()) as i32, last: near_screen((high + SLACK).floor()) as i32 }
}

/// Limits a pixel coordinate, so that all computations after this function fit 32 bits.
fn near_screen(pixel: f64) -> f64 {
    pixel.clamp(-4096.0, 4096.0)
}
