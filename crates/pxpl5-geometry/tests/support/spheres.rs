//! Comparison of spheres with exact integers.

use super::exact::{cross, fixed};
use super::native::region_of;
use super::random::Random;
use super::{HEIGHT, WIDTH, at_pixel, pixel_view};
use glam::Vec3;
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive};
use pxpl5_geometry::{
    Culling, DEPTH_FAR, DEPTH_NEAR, ScreenSphere, SetupStats, SphereSetup, Transform, Viewport, WorldSphere,
};
use pxpl5_wire::format;

const NEAR: f32 = 1.0;
const FAR: f32 = 16_384.0;

#[derive(Clone, Debug)]
pub struct SphereCase {
    pub name: &'static str,
    pub spheres: Vec<WorldSphere>,
}

#[derive(Clone, Debug, Default)]
pub struct SphereRow {
    pub exact: u64,
    pub wrong: u64,
    /// Largest depth error in units of pixel depth.
    pub depth: f64,
    /// Largest depth error as a share of the distance from the sphere's middle to its silhouette.
    pub depth_of_bulge: f64,
    /// Bits of the silhouette's largest value in the touched regions, including the sign.
    pub bits: u32,
    pub stats: SetupStats,
}

/// Returns the view of all cases.
pub fn transform() -> Transform {
    Transform::new(&pixel_view(NEAR, FAR), Viewport::FRAME, Culling::None).expect("a finite view")
}

/// The quadratic `r^2 d.d - |d x c|^2` on an integer scale, with the coefficients of x^2, xy, y^2, x, y and 1.
pub struct ExactSphere {
    coefficients: [BigInt; 6],
    centre: [f64; 3],
    radius: f64,
}

impl ExactSphere {
    pub fn new(sphere: &WorldSphere) -> Self {
        let c = sphere.centre.to_array().map(fixed);
        let r = fixed(sphere.radius);
        let values = [[0, 0], [1, 0], [0, 1], [2, 0], [0, 2], [1, 1]];
        let [one, right, down, right_2, down_2, diagonal] = values.map(|[x, y]| bulge(&c, &r, x, y));
        // The coefficients follow from six values by differences. Twice the coefficients of the squares are even.
        let e = right - &one;
        let f = down - &one;
        let xx: BigInt = (right_2 - &one - &e * 2) / 2;
        let yy: BigInt = (down_2 - &one - &f * 2) / 2;
        let xy: BigInt = diagonal - &one - &e - &f;
        let x = e - &xx;
        let y = f - &yy;
        Self {
            coefficients: [xx, xy, yy, x, y, one],
            centre: sphere.centre.to_array().map(f64::from),
            radius: f64::from(sphere.radius),
        }
    }

    pub fn value(&self, x: i32, y: i32) -> BigInt {
        let [xx, xy, yy, dx, dy, one] = &self.coefficients;
        (xx * x + xy * y + dx) * x + (yy * y + dy) * y + one
    }

    pub fn covers(&self, x: i32, y: i32) -> bool {
        !self.value(x, y).is_negative()
    }

    /// Returns the depth in units of pixel depth, at a covered pixel.
    pub fn depth(&self, x: i32, y: i32) -> f64 {
        let d = ray(x, y).map(|v| f64::from(v) / 1920.0);
        let q = self.value(x, y).to_f64().unwrap_or(f64::MAX) / (1920.0 * 1920.0) * 2_f64.powi(-298);
        let inverse = (dot(d, self.centre) + q.sqrt()) / (dot(self.centre, self.centre) - self.radius * self.radius);
        pixel_depth(inverse)
    }
}

/// Returns the direction of the ray through a pixel's centre, times 1920.
fn ray(x: i32, y: i32) -> [i32; 3] {
    [6 * x - 1917, 1916 - 8 * y, -1920]
}

/// Returns `r^2 d.d - |d x c|^2` for the ray d of a pixel, and a sphere's centre c and radius r.
fn bulge(c: &[BigInt; 3], r: &BigInt, x: i32, y: i32) -> BigInt {
    let d = ray(x, y).map(BigInt::from);
    let dd: BigInt = d.iter().map(|v| v * v).sum();
    let squares: BigInt = cross(&d, c).iter().map(|v| v * v).sum();
    r * r * dd - squares
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn pixel_depth(u: f64) -> f64 {
    let projection = pixel_view(NEAR, FAR).projection.to_cols_array_2d();
    let depth = -f64::from(projection[2][2]) + f64::from(projection[3][2]) * u;
    (f64::from(DEPTH_NEAR) + depth * f64::from(DEPTH_FAR - DEPTH_NEAR)) / 256.0
}

/// Returns the depth at a pixel that the renderer draws, or `None` at other pixels.
pub fn native(setup: &SphereSetup, x: i32, y: i32) -> Option<u32> {
    let value = setup.silhouette.at(x, y);
    (value >= 0).then(|| {
        let radicand = (value >> setup.root_shift) as u64 & 0xff_ffff;
        let depth = setup.depth.at(x, y).wrapping_sub((radicand.isqrt() as i32) << setup.depth_shift);
        depth as u32 >> format::Z_FRACTION_BITS
    })
}

fn family(name: &'static str, seed: u64, pixels: f32, count: usize, on_centre: bool) -> SphereCase {
    let mut random = Random::new(seed);
    let spheres = (0..count).map(|_| {
        let mut x = random.between(20.0, 620.0);
        let mut y = random.between(20.0, 460.0);
        if on_centre {
            x = x.trunc() + 0.5;
            y = y.trunc() + 0.5;
        }
        let scale = 2.0;
        let centre = at_pixel(x, y, scale);
        // At the distance of the centre, a pixel is 3 * scale wide.
        WorldSphere { centre, radius: pixels * 3.0 * scale, colour: random.colour() }
    });
    SphereCase { name, spheres: spheres.collect() }
}

fn beside_the_eye() -> SphereCase {
    let mut random = Random::new(30);
    let spheres = (0..12).map(|_| {
        let centre = Vec3::new(random.between(-20.0, 20.0), random.between(-20.0, 20.0), random.between(-40.0, -4.0));
        let radius = (-centre.z - 1.1) * random.between(0.3, 0.999);
        WorldSphere { centre, radius, colour: [255; 3] }
    });
    SphereCase { name: "beside the eye, long ellipses", spheres: spheres.collect() }
}

/// Returns a sphere with its centre on the eye's axis.
fn on_axis(z: f32, radius: f32) -> WorldSphere {
    WorldSphere { centre: Vec3::new(0.0, 0.0, z), radius, colour: [255; 3] }
}

fn not_drawn() -> SphereCase {
    SphereCase {
        name: "behind the eye, around it, across near and far",
        spheres: vec![
            on_axis(50.0, 10.0),
            on_axis(0.0, 10.0),
            on_axis(-5.0, 4.5),
            on_axis(-16_390.0, 100.0),
            on_axis(-20_000.0, 100.0),
            on_axis(f32::NAN, 1.0),
            on_axis(-5.0, -1.0),
            on_axis(-5.0, f32::INFINITY),
        ],
    }
}

/// Returns all families of spheres. Families with increasing size come first, then families of spheres that are hard or
/// not drawn.
pub fn all() -> Vec<SphereCase> {
    vec![
        family("1/1000 px, on pixel centres", 20, 0.001, 100, true),
        family("1/1000 px, anywhere", 21, 0.001, 100, false),
        family("1/10 px, on pixel centres", 22, 0.1, 100, true),
        family("1 px", 23, 1.0, 100, false),
        family("10 px", 24, 10.0, 100, false),
        family("100 px", 25, 100.0, 12, false),
        family("319 px, larger than the screen is high", 26, 319.0, 6, false),
        beside_the_eye(),
        not_drawn(),
    ]
}

/// Compares each sphere of a family with exact integers, pixel by pixel.
pub fn measure(case: &SphereCase) -> SphereRow {
    let transform = transform();
    let mut row = SphereRow::default();
    for sphere in &case.spheres {
        if let Some(screen) = transform.sphere(sphere, &mut row.stats) {
            row.compare(sphere, &screen);
        }
    }
    row
}

impl SphereRow {
    fn compare(&mut self, sphere: &WorldSphere, screen: &ScreenSphere) {
        let setup = screen.phong(&Viewport::FRAME, &mut self.stats).setup;
        let exact = ExactSphere::new(sphere);
        let bulge = Self::bulge(sphere);
        let small = sphere.radius < 300.0;
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let touched = screen.regions.contains(region_of(x, y));
                // Skip pixels outside the touched regions of small spheres. No such pixel is covered, because the image
                // of a small sphere has only a few pixels. The tests check all pixels.
                if !touched && small {
                    continue;
                }
                let value = setup.silhouette.at(x, y);
                if touched {
                    self.bits = self.bits.max(65 - value.unsigned_abs().leading_zeros());
                }
                let wanted = exact.covers(x, y);
                let found = native(&setup, x, y).filter(|_| touched);
                self.exact += u64::from(wanted);
                self.wrong += u64::from(wanted != found.is_some());
                if let (true, Some(depth)) = (wanted, found) {
                    let error = (f64::from(depth) + 0.5 - exact.depth(x, y)).abs();
                    self.depth = self.depth.max(error);
                    self.depth_of_bulge = self.depth_of_bulge.max((error - 1.0).max(0.0) / bulge);
                }
            }
        }
    }

    /// Returns the distance from the front to the silhouette on the axis, in units of pixel depth.
    fn bulge(sphere: &WorldSphere) -> f64 {
        let t = f64::from(-sphere.centre.z);
        let r = f64::from(sphere.radius);
        pixel_depth(t / (t * t - r * r)) - pixel_depth(1.0 / (t - r))
    }
}
