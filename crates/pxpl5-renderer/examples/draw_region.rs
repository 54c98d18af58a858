//! Draws a few triangles and spheres on one region and writes PNG files.
//!
//! ```text
//! cargo run --release -p pxpl5-renderer --example draw_region -- DIRECTORY
//! ```

use pxpl5_renderer::{
    Clear, Command, Lanes, Layout, PhongSphereCommand, PhongTriangleCommand, PixelArray, SelectRegion, Shade,
    SphereBody, SphereCommand, TriangleCommand,
};
use pxpl5_wire::{Linear, Quadratic};
use std::error::Error;
use std::path::Path;

/// Screen position of the region's left border, in pixels.
const LEFT: i32 = 256;
const TOP: i32 = 128;

type ScreenPoint = [f64; 2];

/// Returns the expression of the edge from p to q, whose value is positive on the left of the edge. The points are in
/// sixteenths of a pixel, and the expression is evaluated at pixel centres.
fn edge(p: ScreenPoint, q: ScreenPoint) -> Linear {
    let a = -(q[1] - p[1]) * 16.0;
    let b = (q[0] - p[0]) * 16.0;
    let c = -a * (p[0] - 0.5) - b * (p[1] - 0.5);
    Linear { a: a.round() as i32, b: b.round() as i32, c: c.floor() as i32 }
}

/// Returns the plane with the given values at the vertices.
fn plane(v: [ScreenPoint; 3], values: [f64; 3], scale: f64) -> Linear {
    let [x1, y1] = [v[1][0] - v[0][0], v[1][1] - v[0][1]];
    let [x2, y2] = [v[2][0] - v[0][0], v[2][1] - v[0][1]];
    let d1 = values[1] - values[0];
    let d2 = values[2] - values[0];
    let det = x1 * y2 - x2 * y1;
    let a = (d1 * y2 - d2 * y1) / det;
    let b = (d2 * x1 - d1 * x2) / det;
    let c = values[0] + a * (0.5 - v[0][0]) + b * (0.5 - v[0][1]);
    Linear { a: (a * scale).round() as i32, b: (b * scale).round() as i32, c: (c * scale).round() as i32 }
}

fn place(v: [ScreenPoint; 3]) -> [ScreenPoint; 3] {
    v.map(|[x, y]| [x + f64::from(LEFT), y + f64::from(TOP)])
}

fn edges(v: [ScreenPoint; 3]) -> [Linear; 3] {
    [edge(v[0], v[1]), edge(v[1], v[2]), edge(v[2], v[0])]
}

/// Factor from a depth of 0 to 1 to the depth expression of 24 + 8 bits.
const DEPTH: f64 = 2_147_483_647.0;

fn triangle(v: [ScreenPoint; 3], depth: [f64; 3], colours: [[f64; 3]; 3]) -> Command {
    let v = place(v);
    let colour = [0, 1, 2].map(|i| plane(v, colours.map(|c| c[i]), 4096.0));
    Command::Triangle(TriangleCommand { edges: edges(v), depth: plane(v, depth, DEPTH), colour })
}

fn phong_triangle(v: [ScreenPoint; 3], depth: [f64; 3], normals: [[f64; 3]; 3], colour: u32) -> Command {
    let v = place(v);
    let normal = [0, 1, 2].map(|i| plane(v, normals.map(|n| n[i] * 1000.0), 1024.0));
    Command::PhongTriangle(PhongTriangleCommand { edges: edges(v), depth: plane(v, depth, DEPTH), normal, colour })
}

/// A sphere without perspective, with a radius r < 64 pixels. The unit of silhouette and root is 2^-`fraction` of a
/// square pixel.
struct FlatSphere {
    centre: ScreenPoint,
    radius: f64,
    depth: f64,
}

impl FlatSphere {
    fn body(&self) -> SphereBody {
        let [x, y] = [self.centre[0] + f64::from(LEFT) - 0.5, self.centre[1] + f64::from(TOP) - 0.5];
        // The root at the middle of the sphere is 4000, so 4000^2 = r^2 scale / 2^shift.
        let shift = 10_u8;
        let r = self.radius;
        let scale = 4000.0_f64.powi(2) * 1024.0 / (r * r);
        let silhouette = Quadratic {
            xx: -scale.round() as i64,
            xy: 0,
            yy: -scale.round() as i64,
            x: (2.0 * x * scale).round() as i64,
            y: (2.0 * y * scale).round() as i64,
            one: ((r * r - x * x - y * y) * scale).round() as i64,
        };
        let depth = Linear::constant((self.depth * DEPTH) as i32);
        SphereBody { silhouette, root_shift: shift, depth, depth_shift: 14 }
    }

    /// Returns a component of the normal, which is 1 at the rim, as a plane.
    fn across(&self, axis: usize, scale: f64) -> Linear {
        let origin = f64::from([LEFT, TOP][axis]);
        let step = scale / self.radius;
        let c = (0.5 - self.centre[axis] - origin) * step;
        let step = step.round() as i32;
        let (a, b) = if axis == 0 { (step, 0) } else { (0, step) };
        Linear { a, b, c: c.round() as i32 }
    }

    /// Returns the linear part of a colour component `c` (0 to 255) under a light.
    fn component(&self, c: f64, light: [f64; 3]) -> Linear {
        let x = self.across(0, light[0] * c * 4096.0);
        let y = self.across(1, light[1] * c * 4096.0);
        Linear { a: x.a, b: y.b, c: x.c.wrapping_add(y.c) }
    }

    fn gouraud(&self, colour: [f64; 3], light: [f64; 3]) -> Command {
        Command::Sphere(SphereCommand {
            body: self.body(),
            colour: colour.map(|c| self.component(c, light)),
            root_factor: colour.map(|c| (light[2] * c * 256.0 / 250.0) as i16),
        })
    }

    fn phong(&self, colour: u32) -> Command {
        Command::PhongSphere(PhongSphereCommand {
            body: self.body(),
            normal: [self.across(0, 1000.0 * 1024.0), self.across(1, 1000.0 * 1024.0)],
            colour,
        })
    }
}

const fn ball(x: f64, y: f64, radius: f64, depth: f64) -> FlatSphere {
    FlatSphere { centre: [x, y], radius, depth }
}

fn gouraud_picture() -> Vec<Command> {
    let light = [-0.5, -0.5, 0.7];
    // Colours avoid 0 and 255, because a component that is rounded beyond the range wraps around.
    let corners = [[2.0, 2.0, 250.0], [250.0, 2.0, 2.0], [2.0, 250.0, 2.0]];
    vec![
        triangle([[10.0, 8.0], [120.0, 30.0], [30.0, 118.0]], [0.5, 0.5, 0.5], corners),
        triangle([[2.0, 60.0], [126.0, 70.0], [4.0, 64.0]], [0.3, 0.6, 0.3], [[250.0; 3]; 3]),
        ball(80.0, 78.0, 40.0, 0.52).gouraud([255.0, 180.0, 60.0], light),
        ball(110.0, 100.0, 20.0, 0.51).gouraud([90.0, 180.0, 255.0], light),
        ball(20.0, 20.0, 2.5, 0.2).gouraud([255.0, 255.0, 255.0], light),
        ball(130.0, 4.0, 24.0, 0.2).gouraud([120.0, 255.0, 120.0], light),
    ]
}

fn phong_picture() -> Vec<Command> {
    let normals = [[-0.7, -0.5, 0.5], [0.7, -0.3, 0.6], [0.0, 0.8, 0.6]];
    vec![
        phong_triangle([[4.0, 6.0], [124.0, 20.0], [40.0, 124.0]], [0.5, 0.6, 0.5], normals, 0x30_90_ff),
        ball(84.0, 84.0, 36.0, 0.52).phong(0xff_60_40),
        ball(30.0, 96.0, 20.0, 0.3).phong(0x60_ff_80),
        Command::Shade(Shade {
            light: [-400, -500, 800],
            half: [-210, -260, 970],
            ambient: 40,
            diffuse: 200,
            specular: 200,
        }),
    ]
}

fn draw(layout: &Layout, commands: &[Command]) -> Result<Vec<u32>, Box<dyn Error>> {
    let mut words = Vec::new();
    let select = SelectRegion { context: 0, left: LEFT as u16, top: TOP as u16 };
    Command::SelectRegion(select).encode(layout, &mut words)?;
    Command::Clear(Clear { colour: 0x20_20_38 }).encode(layout, &mut words)?;
    for command in commands {
        command.encode(layout, &mut words)?;
    }
    let mut array = Lanes::new(layout);
    array.execute(&words)?;
    Ok(array.read_colour(128, 128).to_vec())
}

fn save(path: &Path, pixels: &[u32]) -> Result<(), Box<dyn Error>> {
    let mut picture = image::RgbImage::new(128, 128);
    for (to, from) in picture.pixels_mut().zip(pixels) {
        let [_, red, green, blue] = from.to_be_bytes();
        *to = image::Rgb([red, green, blue]);
    }
    Ok(picture.save(path)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    let directory = Path::new(&directory);
    save(&directory.join("gouraud.png"), &draw(&Layout::rendering_control_phong(), &gouraud_picture())?)?;
    save(&directory.join("slats.png"), &draw(&Layout::slats(), &gouraud_picture())?)?;
    save(&directory.join("phong.png"), &draw(&Layout::rendering_control_phong(), &phong_picture())?)
}
