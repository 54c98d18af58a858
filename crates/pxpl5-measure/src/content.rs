//! Ray casting into the scene. Finds the scene point that a pixel shows, and the position of this point at any time.

use glam::{DMat4, DVec3};
use pxpl5_scene::{Frame, Hinge, HmdConfig, Scene, Structure};
use pxpl5_sim::Time;

/// A visible point of the scene, in the coordinates of its object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Content {
    point: DVec3,
    /// Index in [`Contents`] of the structure to which the point is attached. `None` for a fixed point of the world.
    body: Option<usize>,
}

impl Content {
    /// Returns a point of the world that does not move.
    pub(crate) const fn fixed(point: DVec3) -> Self {
        Self { point, body: None }
    }
}

/// The primitives that rays can hit: all structures of the scene in world coordinates.
///
/// Structures fixed to the head are left out, because such structures are always displayed at the right position.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    bodies: Vec<Body>,
}

#[derive(Debug)]
struct Body {
    structure: usize,
    hinge: Option<Hinge>,
    patches: Vec<Patch>,
    spheres: Vec<(DVec3, f64)>,
}

/// A group of consecutive triangles with a bounding sphere, so that a ray can skip the group. Consecutive triangles of
/// a mesh are mostly neighbours.
#[derive(Debug)]
struct Patch {
    centre: DVec3,
    radius: f64,
    triangles: Vec<[DVec3; 3]>,
}

const PATCH: usize = 32;

/// A ray with the points `origin + t * direction`, where `t` is the depth in metres.
#[derive(Clone, Copy, Debug)]
struct Ray {
    origin: DVec3,
    direction: DVec3,
}

impl Contents {
    pub(crate) fn of(scene: &Scene) -> Self {
        let structures = scene.structures().iter().enumerate();
        let in_world = structures.filter(|(_, structure)| structure.frame == Frame::World);
        Self { bodies: in_world.map(|(place, structure)| Body::of(scene, place, structure)).collect() }
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Returns the nearest point that a ray from the eye hits, with moving objects placed for the time `objects_at`.
    ///
    /// `direction` is scaled to a depth of 1 m along the axis of the view. Returns `None` if the ray hits nothing
    /// between the near and the far plane.
    pub(crate) fn met(&self, origin: DVec3, direction: DVec3, objects_at: Time) -> Option<Content> {
        self.nearest(origin, direction, objects_at, |_| true).map(|(_, content)| content)
    }

    /// Returns the nearest hit, and its depth, among the structures whose entry in `structures` is true.
    pub(crate) fn hit_among(
        &self,
        origin: DVec3,
        direction: DVec3,
        objects_at: Time,
        structures: &[bool],
    ) -> Option<(f64, Content)> {
        self.nearest(origin, direction, objects_at, |structure| structures.get(structure) == Some(&true))
    }

    fn nearest(
        &self,
        origin: DVec3,
        direction: DVec3,
        objects_at: Time,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Option<(f64, Content)> {
        let hmd = HmdConfig::unc();
        let mut nearest = (hmd.far_m, None);
        // Test each structure in its own coordinates, up to the depth of the nearest hit so far.
        for (i, body) in self.bodies.iter().enumerate().filter(|(_, body)| is_wanted(body.structure)) {
            let to_body = body.model(objects_at).inverse();
            let ray = Ray { origin: to_body.transform_point3(origin), direction: to_body.transform_vector3(direction) };
            if let Some(depth) = body.met(&ray, (hmd.near_m, nearest.0)) {
                nearest = (depth, Some(Content { point: ray.origin + ray.direction * depth, body: Some(i) }));
            }
        }
        nearest.1.map(|content| (nearest.0, content))
    }

    pub(crate) fn place(&self, content: &Content, at: Time) -> DVec3 {
        let body = content.body.and_then(|body| self.bodies.get(body));
        body.map_or(content.point, |body| body.model(at).transform_point3(content.point))
    }
}

impl Body {
    fn of(scene: &Scene, place: usize, structure: &Structure) -> Self {
        let corner = |vertex: u32| scene.vertices()[vertex as usize].position.as_dvec3();
        let triangles = scene.triangles()[structure.triangles.clone()].iter();
        let triangles: Vec<[DVec3; 3]> = triangles.map(|triangle| triangle.map(corner)).collect();
        let spheres = scene.spheres()[structure.spheres.clone()].iter();
        Self {
            structure: place,
            hinge: structure.hinge,
            patches: triangles.chunks(PATCH).map(Patch::of).collect(),
            spheres: spheres.map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius))).collect(),
        }
    }

    fn model(&self, at: Time) -> DMat4 {
        self.hinge.map_or(DMat4::IDENTITY, |hinge| hinge.model(at.0).as_dmat4())
    }

    /// Returns the smallest depth, between `near` and `far`, at which a ray hits the structure. All depths are in
    /// metres.
    fn met(&self, ray: &Ray, (near, far): (f64, f64)) -> Option<f64> {
        let patches = self.patches.iter().filter(|patch| ray.passes(patch.centre, patch.radius));
        let of_triangles =
            patches.flat_map(|patch| &patch.triangles).filter_map(|triangle| ray.meets_triangle(triangle));
        let of_spheres = self.spheres.iter().filter_map(|(centre, radius)| ray.meets_sphere(*centre, *radius));
        of_triangles.chain(of_spheres).filter(|depth| (near..far).contains(depth)).min_by(f64::total_cmp)
    }
}

impl Patch {
    fn of(triangles: &[[DVec3; 3]]) -> Self {
        let corners = || triangles.iter().flatten().copied();
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = (low + high) / 2.0;
        let radius = corners().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
        // Enlarge the sphere slightly, so that rounding leaves no corner outside.
        Self { centre, radius: radius * (1.0 + 1e-9), triangles: triangles.to_vec() }
    }
}

impl Ray {
    /// Returns true if the ray, extended to a whole line, passes within `radius` of the point `centre`.
    fn passes(&self, centre: DVec3, radius: f64) -> bool {
        let way = centre - self.origin;
        let along = way.dot(self.direction);
        way.length_squared() - along * along / self.direction.length_squared() <= radius * radius
    }

    /// Returns the depth at which the ray hits a triangle from either side (Moeller and Trumbore 1997).
    fn meets_triangle(&self, [a, b, c]: &[DVec3; 3]) -> Option<f64> {
        let ab = b - a;
        let ac = c - a;
        let normal = self.direction.cross(ac);
        let determinant = ab.dot(normal);
        if determinant == 0.0 {
            return None;
        }
        // `u` and `v` are barycentric coordinates of the hit.
        let way = self.origin - a;
        let u = way.dot(normal) / determinant;
        let across = way.cross(ab);
        let v = self.direction.dot(across) / determinant;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(across) / determinant)
    }

    fn meets_sphere(&self, centre: DVec3, radius: f64) -> Option<f64> {
        let way = centre - self.origin;
        let squared = self.direction.length_squared();
        let along = way.dot(self.direction);
        let under = along * along - squared * (way.length_squared() - radius * radius);
        (under >= 0.0).then(|| (along - under.sqrt()) / squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(name: &str) -> (Contents, Scene) {
        let scene = pxpl5_scene::builtin(name).expect("built in");
        (Contents::of(&scene), scene)
    }

    #[test]
    fn a_ray_meets_the_same_triangle_as_a_test_of_every_triangle() {
        let (contents, scene) = contents("mig");
        let (centre, radius) = scene.bounding_sphere();
        let eye = centre.as_dvec3() + DVec3::Z * 3.0 * f64::from(radius);
        let mut met = 0;
        for i in -10..=10 {
            for j in -5..=5 {
                let direction = DVec3::new(f64::from(i) * 0.015, f64::from(j) * 0.015, -1.0);
                let ray = Ray { origin: eye, direction };
                // The rudder is at the start of its swing at time 0, so it must be placed like all other structures.
                let posed = scene.posed(&scene.edits_at(0));
                let corner = |v: u32| posed.vertices()[v as usize].position.as_dvec3();
                let all = posed.triangles().iter().filter_map(|t| ray.meets_triangle(&t.map(corner)));
                let expected = all.filter(|depth| *depth > 0.05).min_by(f64::total_cmp);
                let found = contents.met(eye, direction, Time::ZERO);
                let depth = found.map(|content| (contents.place(&content, Time::ZERO) - eye).z / direction.z);
                assert_eq!(depth.is_some(), expected.is_some(), "{i} {j}");
                if let Some((depth, expected)) = depth.zip(expected) {
                    assert!((depth - expected).abs() < 1e-5, "{i} {j}: {depth} {expected}");
                    met += 1;
                }
            }
        }
        assert!(met > 10, "the aircraft is in view: {met}");
    }

    #[test]
    fn a_ray_meets_only_the_selected_structures() {
        let (contents, scene) = contents("mig");
        let (centre, radius) = scene.bounding_sphere();
        let eye = centre.as_dvec3() + DVec3::Z * 3.0 * f64::from(radius);
        let all = vec![true; scene.structures().len()];
        let none = vec![false; all.len()];
        let directions = (-10..=10).map(|i| DVec3::new(f64::from(i) * 0.015, 0.0, -1.0));
        let met: Vec<_> = directions.filter_map(|d| Some((d, contents.met(eye, d, Time::ZERO)?))).collect();
        assert!(!met.is_empty());
        for (direction, content) in met {
            let of = |structures: &[bool]| contents.hit_among(eye, direction, Time::ZERO, structures);
            assert_eq!(of(&all).map(|(_, content)| content), Some(content));
            assert_eq!(of(&none), None);
            let depth = (contents.place(&content, Time::ZERO) - eye).z / direction.z;
            assert!((of(&all).expect("met").0 - depth).abs() < 1e-9);
        }
    }

    #[test]
    fn a_ray_hits_a_triangle_only_inside_its_edges_at_the_depth_of_its_plane() {
        let triangle = [DVec3::new(0.0, 0.0, -3.0), DVec3::new(2.0, 0.0, -3.0), DVec3::new(0.0, 1.0, -3.0)];
        let origin = DVec3::new(0.5, 0.25, 1.0);
        for i in -20..=20 {
            for j in -20..=20 {
                let at = DVec3::new(f64::from(i) * 0.13 + 0.01, f64::from(j) * 0.11 + 0.01, -3.0);
                // 1 m of depth is half of the distance to the plane.
                let ray = Ray { origin, direction: (at - origin) / 2.0 };
                let is_inside = at.x >= 0.0 && at.y >= 0.0 && at.x / 2.0 + at.y <= 1.0;
                let found = ray.meets_triangle(&triangle);
                assert_eq!(found.is_some(), is_inside, "{at}");
                assert!(found.is_none_or(|depth| (depth - 2.0).abs() < 1e-12), "{at}: {found:?}");
            }
        }
    }

    /// Tests the distance of a line from a sphere's centre against the smallest distance among 20,001 points of the
    /// line.
    #[test]
    fn a_ray_passes_a_sphere_at_the_smallest_distance_and_enters_a_sphere_at_its_surface() {
        let centre = DVec3::new(0.5, -1.0, -6.0);
        for i in -10..=10 {
            for j in -10..=10 {
                let origin = DVec3::new(0.3, 0.2, 0.7);
                let direction = DVec3::new(f64::from(i) * 0.1, f64::from(j) * 0.1, -2.0);
                let ray = Ray { origin, direction };
                let at = |t: f64| origin + direction * t;
                let least = (0..=20_000).map(|n| at(f64::from(n) * 5e-4).distance(centre)).fold(f64::MAX, f64::min);
                assert!(!ray.passes(centre, least * 0.999) && ray.passes(centre, least * 1.001), "{direction}");
                let radius = 1.2;
                let entered = ray.meets_sphere(centre, radius);
                if (least - radius).abs() > 0.01 {
                    assert_eq!(entered.is_some(), least < radius, "{direction}");
                }
                if let Some(t) = entered {
                    assert!((at(t).distance(centre) - radius).abs() < 1e-6, "{direction}");
                    assert!((at(t) - centre).dot(direction) <= 1e-6, "on the near side: {direction}");
                }
            }
        }
    }

    #[test]
    fn the_bounding_sphere_of_a_patch_is_centred_on_its_bounding_box_and_contains_all_corners() {
        let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let triangles =
            [[corner(1.0, 2.0, 3.0), corner(4.0, 2.5, 3.1), corner(2.0, 7.0, 3.2)], [corner(3.0, 3.0, -5.0); 3]];
        let patch = Patch::of(&triangles);
        assert!(patch.centre.distance(corner(2.5, 4.5, -0.9)) < 1e-12, "{}", patch.centre);
        let greatest = triangles.iter().flatten().map(|corner| corner.distance(patch.centre)).fold(0.0, f64::max);
        assert!(patch.radius > greatest && patch.radius < greatest * (1.0 + 1e-6), "{} {greatest}", patch.radius);
    }

    #[test]
    fn a_ray_hits_a_sphere_at_its_nearest_point() {
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z };
        assert_eq!(ray.meets_sphere(DVec3::NEG_Z * 5.0, 2.0), Some(3.0));
        assert_eq!(ray.meets_sphere(DVec3::new(2.1, 0.0, -5.0), 2.0), None);
    }

    #[test]
    fn a_ray_does_not_hit_objects_fixed_to_the_head() {
        let (contents, _) = contents("full-screen:4");
        assert_eq!(contents.met(DVec3::ZERO, DVec3::NEG_Z, Time::ZERO), None);
    }
}
