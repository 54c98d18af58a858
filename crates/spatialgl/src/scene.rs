//! Conversion of scenes of the crate `pxpl5-scene` to draw calls. A scene is centred on the axis and scaled to a given
//! radius, and its spheres become triangles.

use crate::command::CommandBuffer;
use crate::context::{ColouredVertex, DrawContext, Topology, TwoSidedLight, VertexBuffer};
use glam::{DMat4, DVec3};
use pxpl5_scene::{Scene, Sphere};
use pxpl5_sim::parameters::SettingError;

/// Number of facets of a sphere from pole to pole. There are twice as many facets around the sphere.
const SPHERE_ROWS: u32 = 12;

/// Distance of the farthest point of a scene from the axis, as a fraction of the display's radius.
pub const SCENE_REACH: f64 = 0.9;

/// Records the draw calls of a scene for a display of this radius. The middle of the scene's box is at the origin, and
/// its farthest point at [`SCENE_REACH`] times the radius. If `lit` is true, the scene is shaded by its own light. The
/// background stays dark.
///
/// # Errors
///
/// Returns a [`SettingError`] if a vertex of the scene is not finite.
pub fn record_scene(scene: &Scene, radius: f64, lit: bool) -> Result<CommandBuffer, SettingError> {
    let (centre, reach) = scene.bounding_sphere();
    // A scene of a single point is not scaled.
    let scale = if reach > 0.0 { SCENE_REACH * radius / f64::from(reach) } else { 1.0 };
    let mut context = DrawContext::default();
    context.model_view = DMat4::from_scale(DVec3::splat(scale)) * DMat4::from_translation(-centre.as_dvec3());
    if lit {
        let lighting = scene.lighting();
        context.light = Some(TwoSidedLight {
            direction: lighting.towards_light.as_dvec3(),
            ambient: f64::from(lighting.ambient),
            diffuse: f64::from(lighting.diffuse),
        });
    }
    draw_triangles(&mut context, scene)?;
    for sphere in scene.spheres() {
        draw_sphere(&mut context, sphere)?;
    }
    Ok(context.present())
}

fn draw_triangles(context: &mut DrawContext, scene: &Scene) -> Result<(), SettingError> {
    let vertices = scene.vertices().iter().map(|v| ColouredVertex {
        position: v.position.as_dvec3(),
        normal: v.normal.as_dvec3(),
        colour: v.colour,
    });
    let buffer = VertexBuffer::new(vertices.collect())?;
    context.draw_indexed(&buffer, scene.triangles().as_flattened(), Topology::Triangles)
}

fn draw_sphere(context: &mut DrawContext, sphere: &Sphere) -> Result<(), SettingError> {
    let (vertices, indices) =
        tessellated_sphere(sphere.centre.as_dvec3(), f64::from(sphere.radius), SPHERE_ROWS, sphere.colour);
    context.draw_indexed(&VertexBuffer::new(vertices)?, &indices, Topology::Triangles)
}

/// Returns vertices and triangle indices of a sphere with `rows` x `2 rows` facets. Vertex (a, b) has the polar angle
/// pi a / rows from +y, and the azimuth pi b / rows from +x to +z.
pub fn tessellated_sphere(centre: DVec3, radius: f64, rows: u32, colour: [u8; 3]) -> (Vec<ColouredVertex>, Vec<u32>) {
    let columns = 2 * rows;
    let mut vertices = Vec::new();
    for a in 0..=rows {
        let (sin, cos) = crate::angle::sin_cos_of_turn(i64::from(a), 2 * rows);
        for b in 0..columns {
            let (across, along) = crate::angle::sin_cos_of_turn(i64::from(b), columns);
            let normal = DVec3::new(sin * along, cos, sin * across);
            vertices.push(ColouredVertex { position: centre + radius * normal, normal, colour });
        }
    }
    // Each facet is two triangles, but only one at the poles.
    let mut indices = Vec::new();
    for a in 0..rows {
        for b in 0..columns {
            let here = a * columns + b;
            let beside = a * columns + (b + 1) % columns;
            let below = here + columns;
            let across = beside + columns;
            if a > 0 {
                indices.extend([here, below, beside]);
            }
            if a + 1 < rows {
                indices.extend([beside, below, across]);
            }
        }
    }
    (vertices, indices)
}
