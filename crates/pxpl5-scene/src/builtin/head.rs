//! A human head: the surface of [`super::head_shape`], sampled at the crossings of meridians and parallels.

use glam::DVec3;

use super::head_shape::{EYE, EYE_RADIUS, distance, normal};
use super::solid::Colour;
use crate::config::FIT_RADIUS_M;
use crate::import::Mesh;
use crate::motion::HeadMotion;
use crate::scene::{Scene, SceneParts, bounding_sphere};
use crate::trig;
use std::sync::OnceLock;

/// Number of vertices on each parallel. The head has 2 x 156 x 191 = 59,592 triangles, including 156 at each pole.
const MERIDIANS: usize = 156;
/// Number of rings of vertices (parallels) between crown and neck.
const PARALLELS: usize = 191;

const SKIN: Colour = [226, 178, 150];
const LIPS: Colour = [196, 104, 100];
const HAIR: Colour = [84, 56, 38];
const WHITE: Colour = [240, 238, 232];
const IRIS: Colour = [64, 110, 140];
const PUPIL: Colour = [18, 16, 20];

/// Returns the head. Only the first call of a process generates the head, because this takes some tenths of a second.
pub(super) fn scene() -> Scene {
    static HEAD: OnceLock<Scene> = OnceLock::new();
    HEAD.get_or_init(generate).clone()
}

fn generate() -> Scene {
    let mut mesh = grid();
    // Scale the head to the radius of the built-in models about the origin.
    let (centre, radius) = bounding_sphere(mesh.positions.iter().map(|&p| (p, 0.0)));
    for position in &mut mesh.positions {
        *position = (*position - centre) * (FIT_RADIUS_M / radius);
    }
    let parts = SceneParts {
        motion: HeadMotion::looking_at(glam::Vec3::ZERO, FIT_RADIUS_M),
        ..SceneParts::of("head", mesh.vertices(), mesh.triangles)
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

fn grid() -> Mesh {
    let mut mesh = Mesh::default();
    let crown = push_hit(&mut mesh, Ray::new(0.0, 0.0));
    for parallel in 0..PARALLELS {
        push_parallel(&mut mesh, (parallel as f64 + 1.0) / (PARALLELS as f64 + 1.0));
    }
    let base = push_hit(&mut mesh, Ray::new(1.0, 0.0));
    // Join neighbouring parallels, and close both poles with fans.
    for m in 0..MERIDIANS {
        mesh.fan(&[crown, grid_index(0, m), grid_index(0, m + 1)]);
        for p in 0..PARALLELS - 1 {
            mesh.fan(&[grid_index(p, m), grid_index(p + 1, m), grid_index(p + 1, m + 1), grid_index(p, m + 1)]);
        }
        mesh.fan(&[base, grid_index(PARALLELS - 1, m + 1), grid_index(PARALLELS - 1, m)]);
    }
    mesh
}

/// Returns the index of the vertex where a parallel meets a meridian. Index 0 is the crown.
fn grid_index(parallel: usize, meridian: usize) -> u32 {
    (1 + parallel * MERIDIANS + meridian % MERIDIANS) as u32
}

/// Adds the vertices of one parallel: first from the back of the head to the face, then the mirror images.
fn push_parallel(mesh: &mut Mesh, down: f64) {
    const HALF: usize = MERIDIANS / 2;
    let first = mesh.positions.len();
    for meridian in 0..=HALF {
        push_hit(mesh, Ray::new(down, meridian as f64 / MERIDIANS as f64));
    }
    // Mirror the half in reverse order, without its two end points.
    let mirrored = DVec3::new(-1.0, 1.0, 1.0);
    for meridian in (first + 1..first + HALF).rev() {
        let position = mesh.positions[meridian];
        let normal = mesh.normals[meridian];
        mesh.push(position * mirrored, normal * mirrored, mesh.colours[meridian]);
    }
}

fn push_hit(mesh: &mut Mesh, ray: Ray) -> u32 {
    let point = ray.hit();
    mesh.push(point, normal(point), colour(point))
}

/// A ray outwards from the spine, a curve inside head and neck ([`SPINE`]). The ray meets the surface of the head at
/// one vertex.
struct Ray {
    origin: DVec3,
    direction: DVec3,
}

/// Origins and inclinations of rays from the crown to the lower end of the neck, one ray in each row. The first number
/// is the position from crown (0) to lower end (1). The second number is the height of the origin in centimetres, and
/// the third number is the downward angle in degrees.
const SPINE: [(f64, f64, f64); 8] = [
    (0.0, 2.5, -90.0),
    (0.24, 2.5, -24.0),
    (0.36, 1.6, 0.0),
    (0.50, -3.0, 0.0),
    (0.66, -8.2, 0.0),
    (0.76, -9.8, 8.0),
    (0.92, -15.8, 10.0),
    (1.0, -16.5, 90.0),
];

impl Ray {
    /// Creates a ray. `down` runs from 0 at the crown to 1 at the lower end of the neck. `round` is the angle around
    /// the vertical axis, as a fraction of a turn from the back of the head. Equal steps of `round` give denser rays at
    /// the face.
    fn new(down: f64, round: f64) -> Self {
        // Interpolate origin and inclination between two rows of the spine.
        let above = SPINE.windows(2).find(|pair| down <= pair[1].0);
        let pair = above.unwrap_or(&SPINE[6..]);
        let t = (down - pair[0].0) / (pair[1].0 - pair[0].0);
        let (sin_e, cos_e) = trig::sin_cos_deg(between(pair[0].2, pair[1].2, t));
        let turns = round + 0.075 * trig::sin_turns(round);
        let sin = trig::sin_turns(turns);
        let cos = trig::cos_turns(turns);
        let height = between(pair[0].1, pair[1].1, t);
        Self {
            origin: DVec3::new(0.0, height, -1.0 + 0.13 * height.min(0.0)),
            direction: DVec3::new(-sin * cos_e, -sin_e, -cos * cos_e),
        }
    }

    /// Returns the outermost point of the surface on the ray. The search starts outside the head and steps inwards
    /// along the ray. When a step ends inside the head, this step is bisected.
    fn hit(&self) -> DVec3 {
        let mut outside = 24.0;
        let mut inside = 24.0;
        while inside > 0.0 {
            let d = distance(self.point(inside));
            if d < 0.0 {
                break;
            }
            outside = inside;
            inside -= (d * 0.7).max(0.02);
        }
        // The last step is a few millimetres at most, so 16 halvings reach a tenth of a micrometre.
        for _ in 0..16 {
            let middle = (inside + outside) / 2.0;
            if distance(self.point(middle)) < 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        self.point((inside + outside) / 2.0)
    }

    fn point(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }
}

fn between(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

/// Returns the colour of a point on the head. Painted patches have soft edges, because the grid of vertices is too
/// coarse for hard edges.
fn colour(point: DVec3) -> Colour {
    // The head is symmetric, so one half is enough.
    let p = DVec3::new(point.x.abs(), point.y, point.z);
    let eye_depth = (p - EYE).length() - EYE_RADIUS - 0.05;
    let layers = [
        (HAIR, hair(p), 0.35),
        (HAIR, brow(p), 0.2),
        (LIPS, lips(p), 0.2),
        (WHITE, eye_depth.max(EYE.z - p.z), 0.08),
        (IRIS, eye_depth.max(off_axis(p) - 0.62), 0.12),
        (PUPIL, eye_depth.max(off_axis(p) - 0.27), 0.12),
    ];
    layers.into_iter().fold(SKIN, |under, (over, outside, edge)| {
        // Blend over a soft edge of the width `edge`.
        let share = (0.5 - outside / edge / 2.0).clamp(0.0, 1.0);
        [0, 1, 2].map(|k| {
            let under = f64::from(under[k]);
            let over = f64::from(over[k]);
            (under + (over - under) * share + 0.5) as u8
        })
    })
}

// Each function below returns the approximate distance of a point from a painted patch, in centimetres, positive
// outside.

/// Returns the distance of a point from the axis of the gaze, in centimetres. The axis points slightly downwards.
fn off_axis(p: DVec3) -> f64 {
    DVec3::new(p.x - EYE.x, p.y - EYE.y + 0.05, 0.0).length()
}

fn lips(p: DVec3) -> f64 {
    let across = p.x / 2.3;
    let half_height = 0.85 * (1.0 - across * across).max(0.0);
    ((p.y + 5.85).abs() - half_height).max(7.0 - p.z)
}

/// Returns the distance of a point from a painted eyebrow, an arch that becomes thinner outwards, in centimetres.
fn brow(p: DVec3) -> f64 {
    let off_middle = (p.x - 3.2) / 2.0;
    let middle = 2.5 + 0.3 * (1.0 - off_middle * off_middle);
    let half_height = 0.36 - 0.06 * (p.x - 1.2);
    let end = (1.2 - p.x).max(p.x - 5.3);
    ((p.y - middle).abs() - half_height).max(end).max(5.0 - p.z)
}

/// Returns the distance of a point from the hair, in centimetres. The border of the hair runs from the forehead over
/// the temples, around the ears and to the nape.
fn hair(p: DVec3) -> f64 {
    let hairline = 8.2 - 0.05 * p.x * p.x;
    let behind = p.z - 2.0 + (hairline - p.y).max(0.0) * 0.3;
    let scalp = (hairline - p.y).min(behind).max(-7.5 - p.y);
    let ear = (6.8 - p.x).max(-4.4 - p.z).max(p.y - 3.0);
    scalp.max(-ear)
}
