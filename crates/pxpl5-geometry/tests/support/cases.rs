//! Hard cases: families of triangles, each with its view.

use super::random::Random;
use super::{at_pixel, pixel_view};
use glam::{Mat4, Quat, Vec3};
use pxpl5_geometry::{Triangle, ViewTransform};

/// A family of triangles with its view.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: &'static str,
    pub view: ViewTransform,
    pub triangles: Vec<Triangle>,
    /// True if the triangles tile a part of the screen. In a tiling, no pixel may belong to two triangles, and no pixel
    /// between triangles may be missing.
    pub tiling: bool,
}

const NEAR: f32 = 1.0;
const FAR: f32 = 16_384.0;

fn coloured(random: &mut Random, positions: [Vec3; 3]) -> Triangle {
    Triangle { positions, normals: [Vec3::Z; 3], colours: [random.colour(), random.colour(), random.colour()] }
}

fn case(name: &'static str, triangles: Vec<Triangle>) -> Case {
    Case { name, view: pixel_view(NEAR, FAR), triangles, tiling: false }
}

fn tiling(name: &'static str, triangles: Vec<Triangle>) -> Case {
    Case { tiling: true, ..case(name, triangles) }
}

fn many(seed: u64, count: usize, make: impl Fn(&mut Random) -> [Vec3; 3]) -> Vec<Triangle> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let positions = make(&mut random);
            coloured(&mut random, positions)
        })
        .collect()
}

/// Returns a random point on the screen, at one of a few distances.
fn anywhere(random: &mut Random) -> Vec3 {
    let x = random.between(0.0, 640.0);
    let y = random.between(0.0, 480.0);
    at_pixel(x, y, random.between(0.5, 8.0))
}

/// Returns a random point within `size` px of a place.
fn around(random: &mut Random, [x, y]: [f32; 2], size: f32) -> Vec3 {
    let dx = random.within(size);
    let dy = random.within(size);
    at_pixel(x + dx, y + dy, random.between(1.0, 1.2))
}

fn ordinary() -> Case {
    case(
        "ordinary, some 100 px",
        many(1, 200, |r| {
            let place = [r.between(20.0, 620.0), r.between(20.0, 460.0)];
            std::array::from_fn(|_| around(r, place, 14.0))
        }),
    )
}

fn large() -> Case {
    case("ordinary, as large as the screen", many(2, 12, |r| std::array::from_fn(|_| anywhere(r))))
}

/// Returns triangles with a length of 300 px and a width of `width` px, in any direction.
fn slivers(name: &'static str, width: f32) -> Case {
    let triangles = many(3, 100, |r| {
        let [dx, dy] = r.direction();
        let x = r.between(200.0, 440.0);
        let y = r.between(160.0, 320.0);
        [
            at_pixel(x - 150.0 * dx, y - 150.0 * dy, 1.0),
            at_pixel(x + 150.0 * dx, y + 150.0 * dy, 2.0),
            at_pixel(x - dy * width, y + dx * width, 1.5),
        ]
    });
    case(name, triangles)
}

/// Returns triangles around one corner, as a closed fan.
fn fan() -> Case {
    let mut random = Random::new(4);
    let hub = at_pixel(320.3, 240.7, 1.0);
    let count = 48;
    let rim: Vec<Vec3> = (0..count)
        .map(|n| {
            // Walk the border of a square once, with varying depth.
            let t = n as f32 * 4.0 / count as f32;
            let (x, y) = match t as u32 {
                0 => (t, 0.0),
                1 => (1.0, t - 1.0),
                2 => (3.0 - t, 1.0),
                _ => (0.0, 4.0 - t),
            };
            at_pixel(90.1 + x * 460.0, 13.3 + y * 450.0, random.between(0.5, 4.0))
        })
        .collect();
    let triangles = (0..count).map(|n| {
        let from = rim[n];
        let to = rim[(n + 1) % count];
        coloured(&mut random, [hub, from, to])
    });
    tiling("fan of 48 around one corner", triangles.collect())
}

/// Returns a grid with random displacements of the corners. Neighbours have their common edge in opposite directions.
fn grid(name: &'static str, step: f32, jitter: f32) -> Case {
    let mut random = Random::new(5);
    let columns = 40_usize;
    let rows = 30_usize;
    let vertices: Vec<Vec3> = (0..=rows * (columns + 1) + columns)
        .map(|n| {
            let column = n % (columns + 1);
            let row = n / (columns + 1);
            let x = 8.5 + column as f32 * step + random.within(jitter);
            let y = 8.5 + row as f32 * step + random.within(jitter);
            at_pixel(x, y, 1.0 + (n % 7) as f32 * 0.25)
        })
        .collect();
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let first = row * (columns + 1) + column;
            let below = first + columns + 1;
            let corners = [first, first + 1, below, below + 1].map(|n| vertices[n]);
            for [a, b, c] in [[0, 1, 2], [3, 2, 1]] {
                triangles.push(coloured(&mut random, [corners[a], corners[b], corners[c]]));
            }
        }
    }
    tiling(name, triangles)
}

fn region_borders() -> Case {
    let triangles = many(6, 60, |r| {
        std::array::from_fn(|_| {
            let x = r.integer(0, 5) * 128;
            let y = r.integer(0, 3) * 128;
            at_pixel(x as f32, y as f32, 1.0)
        })
    });
    case("corners on region borders", triangles)
}

fn pixel_centres() -> Case {
    let triangles = many(7, 200, |r| {
        let x = r.integer(20, 600);
        let y = r.integer(20, 440);
        std::array::from_fn(|_| {
            let dx = r.integer(0, 12);
            let dy = r.integer(0, 12);
            at_pixel((x + dx) as f32 + 0.5, (y + dy) as f32 + 0.5, 1.0)
        })
    });
    case("corners on pixel centres", triangles)
}

fn across_near() -> Case {
    let triangles = many(8, 40, |r| {
        let behind = Vec3::new(r.within(2.0), r.within(2.0), r.between(-0.9, 3.0));
        [anywhere(r), anywhere(r), behind]
    });
    case("across the near plane and the eye", triangles)
}

fn across_everything() -> Case {
    let triangles = many(9, 100, |r| {
        std::array::from_fn(|_| Vec3::new(r.within(1.0) * 1e6, r.within(1.0) * 1e6, r.within(1.0) * 1e6))
    });
    case("across eye and screen by 10^6", triangles)
}

fn off_screen() -> Case {
    let triangles = many(10, 100, |r| [far_off_screen(r), far_off_screen(r), anywhere(r)]);
    case("10^6 px beyond the screen", triangles)
}

/// Returns a random point within 10^6 px of the screen's middle.
fn far_off_screen(random: &mut Random) -> Vec3 {
    let x = 320.0 + random.within(1.0) * 1e6;
    let y = 240.0 + random.within(1.0) * 1e6;
    at_pixel(x, y, 1.0)
}

/// Returns a fan whose rim lies some guard bands of 4,096 px from pixel (0, 0), at several distances from the eye.
fn beyond_the_band(name: &'static str, bands: f32) -> Case {
    let mut random = Random::new(16);
    let hub = at_pixel(300.25, 200.75, 1.0);
    let corners: [[f32; 2]; 8] =
        [[-1.0, -1.0], [0.25, -1.0], [1.0, -1.0], [1.0, 0.5], [1.0, 1.0], [-0.5, 1.0], [-1.0, 1.0], [-1.0, 0.25]];
    let rim = corners.map(|[x, y]| at_pixel(x * bands * 4096.0, y * bands * 4096.0, random.between(0.5, 4.0)));
    let triangles = (0..rim.len()).map(|n| coloured(&mut random, [hub, rim[n], rim[(n + 1) % rim.len()]]));
    tiling(name, triangles.collect())
}

fn depth_range() -> Case {
    let triangles = many(11, 60, |r| {
        let place = [r.between(50.0, 590.0), r.between(50.0, 430.0)];
        std::array::from_fn(|_| {
            let power = r.integer(-19, 9);
            let dx = r.within(40.0);
            let dy = r.within(40.0);
            at_pixel(place[0] + dx, place[1] + dy, f32::from_bits(((power + 127) as u32) << 23))
        })
    });
    Case { view: pixel_view(1e-3, 1e6), ..case("depth from 10^-3 to 10^6", triangles) }
}

/// Returns a case with a rotated view of a model, like the view of a user. The model has the size `size` and the
/// position `place`.
fn placed(name: &'static str, seed: u64, size: f32, place: Vec3) -> Case {
    let random = &mut Random::new(seed);
    let triangles = (0..100)
        .map(|_| {
            let centre = Vec3::new(random.within(1.0), random.within(0.8), random.within(0.5));
            let corners = std::array::from_fn(|_| {
                let offset = Vec3::new(random.within(0.06), random.within(0.06), random.within(0.06));
                place + (centre + offset) * size
            });
            coloured(random, corners)
        })
        .collect();
    let turn = Quat::from_xyzw(0.1, 0.2, 0.05, 0.973).normalize();
    let back = Mat4::from_translation(Vec3::new(0.0, 0.0, -3.0 * size));
    Case {
        view: ViewTransform {
            model_view: back * Mat4::from_quat(turn) * Mat4::from_translation(-place),
            projection: Mat4::perspective_rh(0.8, 4.0 / 3.0, 0.1 * size, 100.0 * size),
        },
        ..case(name, triangles)
    }
}

fn degenerate() -> Case {
    let triangles = many(12, 60, |r| {
        let a = anywhere(r);
        let b = anywhere(r);
        match r.integer(0, 3) {
            0 => [a, a, b],
            1 => [a, b, (a + b) * 0.5],
            2 => [a, a, a],
            _ => [a, a * 2.0, b],
        }
    });
    case("degenerate and zero area", triangles)
}

/// Returns a wall that extends away from the eye and is seen almost edge-on.
fn edge_on() -> Case {
    let triangles = many(13, 60, |r| {
        let x = r.between(100.0, 540.0);
        let y = r.between(10.0, 200.0);
        [
            at_pixel(x, y, 1.0 / 512.0),
            at_pixel(x + r.between(0.0, 2.0), y + 20.0, 16.0),
            at_pixel(x, y + 250.0, 1.0 / 512.0),
        ]
    });
    case("walls seen edge-on, near to far", triangles)
}

/// Returns triangles with a length of 4,000 px and a thickness of half a subpixel. Their depth goes from far to near
/// across the thickness, so their slopes exceed every format.
fn overflowing() -> Case {
    let mut random = Random::new(15);
    let triangles = (0..20)
        .map(|n| {
            let y = 20.0 * n as f32 + 10.0;
            let corners = [[-1500.0, 7.0, 16.0], [2500.0, 9.0, 16.0], [1500.0, 9.0, 1.0 / 512.0]]
                .map(|[x, subpixel, scale]| at_pixel(x, y + subpixel / 16.0, scale));
            coloured(&mut random, corners)
        })
        .collect();
    Case { view: pixel_view(1.875, FAR), ..case("half a subpixel thick, near to far", triangles) }
}

/// Returns all families of triangles. Ordinary families come first, then the hard families.
pub fn all() -> Vec<Case> {
    vec![
        ordinary(),
        large(),
        slivers("slivers, 1 px wide", 1.0),
        slivers("slivers, 1/10 px", 0.1),
        slivers("slivers, 1/100 px", 0.01),
        slivers("slivers, 1/1000 px", 0.001),
        fan(),
        grid("grid, cells of 15 px", 15.0, 5.0),
        grid("grid, cells of 1 px", 1.0, 0.3),
        pixel_centres(),
        region_borders(),
        across_near(),
        across_everything(),
        off_screen(),
        edge_on(),
        overflowing(),
        depth_range(),
        placed("model of 10^6 units", 14, 1e6, Vec3::ZERO),
        placed("model of 10^-6 units", 14, 1e-6, Vec3::ZERO),
        placed("10^3 from the origin", 14, 1.0, Vec3::new(1e3, -1e3, 1e3)),
        placed("10^5 from the origin", 14, 1.0, Vec3::new(1e5, -1e5, 1e5)),
        placed("10^6 from the origin", 14, 1.0, Vec3::new(1e6, -1e6, 1e6)),
        degenerate(),
    ]
}

/// Returns the families that are drawn by the program of Slats: all families, and corners beyond the guard band.
pub fn single() -> Vec<Case> {
    let [one, two, four] = [("corners at 1 guard band", 1.0), ("at 2 guard bands", 2.0), ("at 4 guard bands", 4.0)]
        .map(|(name, bands)| beyond_the_band(name, bands));
    all().into_iter().chain([one, two, four]).collect()
}
