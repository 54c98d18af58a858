//! Draws a scene as a PNG, one picture for each side: `draw SCENE-OR-FILE OUT.png [AZIMUTH ELEVATION]...`
//!
//! Without angles the example draws the first eight seconds of the scene's own head motion, one picture per second. A
//! plain Z-buffer in world units suffices for inspecting scenes, but not for comparing with the machine.

use std::error::Error;

use glam::{Mat4, Vec3};
use image::{Rgb, RgbImage};
use pxpl5_scene::{HeadMotion, HeadPath, Hmd, Scene, Sway, View, builtin, load};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().ok_or("draw SCENE-OR-FILE OUT.png [AZIMUTH ELEVATION]...")?;
    let out = arguments.next().ok_or("expected the name of a PNG file")?;
    let angles: Vec<f64> = arguments.map(|a| a.parse()).collect::<Result<_, _>>()?;
    let scene = if name.contains('.') { load(&name)? } else { builtin(&name)? };
    let motions = motions(&scene, &angles)?;
    let columns = if motions.len() == 8 { 4 } else { motions.len() as u32 };
    let rows = (motions.len() as u32).div_ceil(columns);
    let mut sheet = RgbImage::new(WIDTH * columns, HEIGHT * rows);
    let hmd = Hmd::unc();
    for (i, (motion, time_ps)) in motions.iter().enumerate() {
        let view = hmd.mono(&motion.pose(*time_ps));
        let picture = draw(&scene.posed(&scene.edits_at(*time_ps)), &view);
        let x = i as u32 % columns * WIDTH;
        let y = i as u32 / columns * HEIGHT;
        image::imageops::replace(&mut sheet, &picture, x.into(), y.into());
    }
    sheet.save(out)?;
    Ok(())
}

fn motions(scene: &Scene, angles: &[f64]) -> Result<Vec<(HeadMotion, u64)>, Box<dyn Error>> {
    if angles.is_empty() {
        let times = (0..8).map(|second| second * 1_000_000_000_000);
        return Ok(times.map(|time| (*scene.motion(), time)).collect());
    }
    let (target, radius) = scene.bounding_sphere();
    let distance = f64::from(radius) * 2.2;
    let motions = angles.chunks_exact(2).map(|pair| {
        let azimuth = pair[0].to_radians();
        let elevation = pair[1].to_radians();
        let arm = Vec3::new(
            (azimuth.sin() * elevation.cos() * distance) as f32,
            (elevation.sin() * distance) as f32,
            (azimuth.cos() * elevation.cos() * distance) as f32,
        );
        let eye = target + arm;
        HeadMotion::new(HeadPath::Still { eye, target }, Sway::none()).map(|m| (m, 0))
    });
    Ok(motions.collect::<Result<_, _>>()?)
}

struct Canvas {
    picture: RgbImage,
    depth: Vec<f32>,
}

fn draw(scene: &Scene, view: &View) -> RgbImage {
    let mut canvas = Canvas {
        picture: RgbImage::from_pixel(WIDTH, HEIGHT, Rgb(scene.lighting().background)),
        depth: vec![f32::INFINITY; (WIDTH * HEIGHT) as usize],
    };
    for structure in scene.structures() {
        let to_eye = structure.frame.to_eye(view);
        for triangle in &scene.triangles()[structure.triangles.clone()] {
            canvas.triangle(scene, view, to_eye, *triangle);
        }
    }
    for sphere in scene.spheres() {
        canvas.sphere(scene, view, *sphere);
    }
    canvas.picture
}

fn shade(scene: &Scene, normal: Vec3, colour: [u8; 3]) -> Vec3 {
    let light = scene.lighting();
    let bright = light.ambient + light.diffuse * normal.dot(light.towards_light).max(0.0);
    Vec3::from(colour.map(f32::from)) * bright
}

/// Returns the position of a point in the picture (pixels to the right and down), and 1 / distance.
fn screen(view: &View, eye: Vec3) -> Vec3 {
    let clip = view.projection * eye.extend(1.0);
    let x = (clip.x / clip.w + 1.0) * 0.5 * WIDTH as f32;
    let y = (1.0 - clip.y / clip.w) * 0.5 * HEIGHT as f32;
    Vec3::new(x, y, 1.0 / clip.w)
}

impl Canvas {
    fn plot(&mut self, x: i32, y: i32, distance: f32, colour: Vec3) {
        let slot = &mut self.depth[(y * WIDTH as i32 + x) as usize];
        if distance < *slot {
            *slot = distance;
            let rgb = colour.min(Vec3::splat(255.0)).to_array().map(|c| c as u8);
            self.picture.put_pixel(x as u32, y as u32, Rgb(rgb));
        }
    }

    fn triangle(&mut self, scene: &Scene, view: &View, to_eye: Mat4, triangle: [u32; 3]) {
        let corners = triangle.map(|corner| scene.vertices()[corner as usize]);
        let eye = corners.map(|v| to_eye.transform_point3(v.position));
        if eye.iter().any(|p| p.z > -0.01) {
            return;
        }
        let p = eye.map(|p| screen(view, p));
        let colours = corners.map(|v| shade(scene, v.normal, v.colour));
        let area = (p[1] - p[0]).truncate().perp_dot((p[2] - p[0]).truncate());
        if area >= 0.0 {
            return;
        }
        let low = p[0].min(p[1]).min(p[2]);
        let high = p[0].max(p[1]).max(p[2]);
        for y in low.y.max(0.0) as i32..=(high.y.min(HEIGHT as f32 - 1.0)) as i32 {
            for x in low.x.max(0.0) as i32..=(high.x.min(WIDTH as f32 - 1.0)) as i32 {
                let at = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                // The barycentric coordinate of a corner is proportional to the area over the opposite side.
                let [a, b, c] = [(1, 2), (2, 0), (0, 1)]
                    .map(|(i, j)| (p[j].truncate() - p[i].truncate()).perp_dot(at - p[i].truncate()) / area);
                if a >= 0.0 && b >= 0.0 && c >= 0.0 {
                    let distance = 1.0 / (p[0].z * a + p[1].z * b + p[2].z * c);
                    self.plot(x, y, distance, colours[0] * a + colours[1] * b + colours[2] * c);
                }
            }
        }
    }

    /// Draws a sphere without perspective distortion, as a disc with the normals of a sphere.
    fn sphere(&mut self, scene: &Scene, view: &View, sphere: pxpl5_scene::Sphere) {
        let centre = view.world_to_eye.transform_point3(sphere.centre);
        if centre.z > -sphere.radius {
            return;
        }
        let middle = screen(view, centre);
        let radius = sphere.radius * middle.z * view.projection.x_axis.x * WIDTH as f32 / 2.0;
        let back = view.world_to_eye.inverse();
        for y in (middle.y - radius).max(0.0) as i32..=(middle.y + radius).min(HEIGHT as f32 - 1.0) as i32 {
            for x in (middle.x - radius).max(0.0) as i32..=(middle.x + radius).min(WIDTH as f32 - 1.0) as i32 {
                let u = (x as f32 + 0.5 - middle.x) / radius;
                let v = (middle.y - y as f32 - 0.5) / radius;
                let w = 1.0 - u * u - v * v;
                if w >= 0.0 {
                    let normal = back.transform_vector3(Vec3::new(u, v, w.sqrt()));
                    let distance = -centre.z - sphere.radius * w.sqrt();
                    self.plot(x, y, distance, shade(scene, normal, sphere.colour));
                }
            }
        }
    }
}
