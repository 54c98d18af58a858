//! Scaling of a hall, and routes of the viewer through the hall.

use glam::{DVec3, Vec3};
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use tracking::motion::Walk;

/// The path of the viewer through a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Route {
    /// The path that belongs to the scene.
    #[default]
    Scene,
    /// A path back and forth along z through the middle of the scene.
    Straight,
    /// A path back and forth between two opposite corners.
    Diagonal,
    /// A path around the middle, halfway between the middle and the walls.
    Round,
}

impl Route {
    pub const ALL: [(&str, Self); 4] =
        [("scene", Self::Scene), ("straight", Self::Straight), ("diagonal", Self::Diagonal), ("round", Self::Round)];
}

/// Distance between routes and walls, as a fraction of the hall's side.
const MARGIN: f64 = 0.015;

/// Returns the path of a route through a scene. The scene's own path defines the height of the eye.
///
/// # Errors
///
/// Returns a [`SettingError`] if the scene has no path of its own.
pub fn path_of(scene: &Scene, route: Route) -> Result<Walk, SettingError> {
    // The scene's own path defines the height of the eye.
    let own: Vec<DVec3> = scene.path().iter().map(|corner| corner.as_dvec3()).collect();
    if own.len() < 2 {
        let expected = "a path to walk along, as gallery and gallery:full have";
        return Err(SettingError::scene(&format!("scene {}", scene.name()), expected, "none"));
    }
    // All other routes are derived from the bounding box of the scene.
    let places = || scene.vertices().iter().map(|vertex| vertex.position.as_dvec3());
    let low = places().fold(DVec3::INFINITY, DVec3::min);
    let high = places().fold(DVec3::NEG_INFINITY, DVec3::max);
    let at = |x: f64, z: f64| DVec3::new(low.x + (high.x - low.x) * x, own[0].y, low.z + (high.z - low.z) * z);
    let [near, far] = [MARGIN, 1.0 - MARGIN];
    let corners = match route {
        Route::Scene => own,
        Route::Straight => vec![at(0.5, near), at(0.5, far)],
        Route::Diagonal => vec![at(near, near), at(far, far)],
        Route::Round => vec![at(0.25, 0.25), at(0.75, 0.25), at(0.75, 0.75), at(0.25, 0.75)],
    };
    Walk::new(&corners, 1.0)
}

/// Returns a copy of a scene with its length, width and path multiplied by `factor`. Heights stay the same.
///
/// # Errors
///
/// Returns a [`SettingError`] if the result is invalid, for example because coordinates are too large.
pub fn scaled(scene: &Scene, factor: f64) -> Result<Scene, SettingError> {
    let mut parts = scene.clone().into_parts();
    let factor = factor as f32;
    let on_plan = |place: Vec3| Vec3::new(place.x * factor, place.y, place.z * factor);
    // Scale the vertices, spheres and path in x and z.
    for vertex in &mut parts.vertices {
        vertex.position = on_plan(vertex.position);
        // Normals scale by the inverse, so that they stay perpendicular to the surface.
        let normal = Vec3::new(vertex.normal.x / factor, vertex.normal.y, vertex.normal.z / factor);
        vertex.normal = normal.normalize_or(vertex.normal);
    }
    for sphere in &mut parts.spheres {
        sphere.centre = on_plan(sphere.centre);
    }
    parts.path.iter_mut().for_each(|corner| *corner = on_plan(*corner));
    Scene::new(parts).map_err(|error| {
        let expected = "a scene that can be scaled by walk.hall_scale";
        SettingError::scene(&format!("scene {}", scene.name()), expected, error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_scene::builtin;

    /// Tests the built-in gallery at half its size. The original is 40 m wide and 4 m high, and its path begins at
    /// (-16, -15). The heights must not change.
    #[test]
    fn a_scaled_hall_keeps_its_height_and_the_height_of_the_eyes() {
        let scene = builtin("gallery").expect("built in");
        let half = scaled(&scene, 0.5).expect("a scene");
        let reach = half.vertices().iter().fold(Vec3::ZERO, |reach, vertex| reach.max(vertex.position));
        assert_eq!(reach, Vec3::new(10.0, 4.0, 10.0));
        assert_eq!(half.path()[0], Vec3::new(-8.0, 1.7, -7.5));
        assert!(half.vertices().iter().all(|vertex| (vertex.normal.length() - 1.0).abs() < 1e-6));
    }

    #[test]
    fn routes_stay_in_the_hall_at_the_height_of_the_eyes() {
        let scene = builtin("gallery").expect("built in");
        for (name, route) in Route::ALL {
            let path = path_of(&scene, route).expect("a path");
            for step in 0..200 {
                let place = path.place(path.length_m() * f64::from(step) / 200.0);
                assert!(
                    place.x.abs() < 20.0 && place.z.abs() < 20.0 && (place.y - 1.7).abs() < 1e-6,
                    "{name}: {place}"
                );
            }
        }
        // The path leads back and forth between points 0.6 m from both walls.
        let straight = path_of(&scene, Route::Straight).expect("a path");
        assert!((straight.length_m() - 2.0 * 38.8).abs() < 1e-6, "{}", straight.length_m());
        assert!(path_of(&builtin("mig").expect("built in"), Route::Straight).is_err(), "no eyes");
    }
}
