//! The shape of a human head as a signed distance function in centimetres. The axis +x points to the left of the head,
//! +y points up, and +z points ahead of the face.
//!
//! The distance is negative inside the head. Proportions follow the usual rules of drawing. The eyes are half-way
//! between crown and chin, the face is five eyes wide, and the ears reach from brow to nose. The functions use only
//! arithmetic and square roots, so all hosts agree.

use glam::DVec3;

const fn xyz(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Centre of the left eyeball, centimetres.
pub(super) const EYE: DVec3 = xyz(3.15, 0.75, 6.6);
pub(super) const EYE_RADIUS: f64 = 1.3;

/// Returns the signed distance of a point from the surface of the head, centimetres. The head is symmetric in x. Near
/// the surface the error is about a tenth of the distance.
pub(super) fn distance(point: DVec3) -> f64 {
    let p = xyz(point.x.abs(), point.y, point.z);
    let mut d = skull(p);
    d = join(d, neck(p), 2.2);
    d = join(d, nose(p), 0.7);
    d = face(d, p);
    ears(d, p)
}

fn skull(p: DVec3) -> f64 {
    let cranium = ellipsoid(p, xyz(0.0, 3.2, -1.4), xyz(7.35, 8.3, 9.2));
    let face = ellipsoid(p, xyz(0.0, -3.2, 2.3), xyz(5.7, 7.4, 6.0));
    let jaw = capsule(p, xyz(4.9, -5.6, 0.2), xyz(1.4, -9.4, 5.6), 1.5, 1.35);
    let chin = ellipsoid(p, xyz(0.0, -9.5, 6.3), xyz(1.9, 1.35, 1.5));
    let forehead = ellipsoid(p, xyz(0.0, 4.6, 2.2), xyz(6.1, 5.6, 5.9));
    let d = join(cranium, face, 2.5);
    let d = join(d, forehead, 1.5);
    join(join(d, jaw, 2.0), chin, 1.6)
}

fn neck(p: DVec3) -> f64 {
    let column = capsule(p, xyz(0.0, -4.0, -2.4), xyz(0.0, -17.0, -3.6), 4.9, 5.5);
    let shoulders = capsule(p, xyz(0.0, -18.2, -3.8), xyz(6.0, -19.6, -4.4), 4.6, 3.4);
    let throat = ellipsoid(p, xyz(0.0, -12.4, 1.7), xyz(1.0, 1.5, 0.9));
    let d = join(join(column, shoulders, 3.0), throat, 1.5);
    // Cut off the neck horizontally at the bottom, with a soft edge.
    meet(d, -18.0 - p.y, 1.2)
}

fn nose(p: DVec3) -> f64 {
    let bridge = capsule(p, xyz(0.0, 1.6, 7.8), xyz(0.0, -2.3, 9.9), 0.75, 0.95);
    let tip = ellipsoid(p, xyz(0.0, -2.55, 10.1), xyz(0.95, 0.8, 0.85));
    let wing = ellipsoid(p, xyz(1.25, -2.85, 8.7), xyz(0.75, 0.7, 1.05));
    join(join(bridge, tip, 0.5), wing, 0.9)
}

/// Adds brows, eye sockets, eyes, cheekbones and mouth to `d`, the distance from skull, neck and nose.
fn face(d: f64, p: DVec3) -> f64 {
    let brow = capsule(p, xyz(1.3, 2.2, 7.7), xyz(5.0, 2.3, 5.9), 0.75, 0.5);
    let cheekbone = ellipsoid(p, xyz(4.0, -2.4, 4.9), xyz(1.9, 1.4, 1.9));
    let socket = ellipsoid(p, xyz(3.2, 0.7, 8.6), xyz(1.95, 1.25, 1.9));
    let mut d = join(join(d, brow, 1.0), cheekbone, 2.4);
    d = carve(d, socket, 0.9);
    d = join(d, eyelids(p), 0.6);
    d = join(d, (p - EYE).length() - EYE_RADIUS, 0.06);
    mouth(d, p)
}

fn eyelids(p: DVec3) -> f64 {
    let shell = (p - EYE).length() - (EYE_RADIUS + 0.2);
    let slit = ellipsoid(p, xyz(3.2, 0.65, 8.4), xyz(1.5, 0.5, 1.9));
    carve(shell, slit, 0.12)
}

fn mouth(d: f64, p: DVec3) -> f64 {
    let muzzle = ellipsoid(p, xyz(0.0, -5.6, 6.2), xyz(2.6, 2.3, 2.2));
    let upper = capsule(p, xyz(0.35, -5.25, 8.35), xyz(2.0, -5.75, 7.45), 0.42, 0.2);
    let lower = capsule(p, xyz(0.0, -6.35, 8.25), xyz(1.7, -6.0, 7.55), 0.5, 0.22);
    let parting = capsule(p, xyz(0.0, -5.82, 8.9), xyz(2.3, -5.85, 7.6), 0.14, 0.1);
    let fold = capsule(p, xyz(0.0, -7.5, 8.9), xyz(1.3, -7.4, 8.5), 0.6, 0.4);
    let d = join(d, muzzle, 1.4);
    let d = carve(d, fold, 0.9);
    let d = join(join(d, upper, 0.3), lower, 0.35);
    carve(d, parting, 0.25)
}

/// Adds the ears to `d`, the distance from the head without ears. Each ear is a bowl whose front edge lies on the skull
/// and whose rear edge stands away from the skull.
fn ears(d: f64, p: DVec3) -> f64 {
    let q = p - xyz(7.35, -0.2, -1.3);
    // The ear leans back, so its top is further behind than its lobe. Its rear edge is turned outwards.
    let q = xyz(q.x + 0.45 * q.z, q.y + 0.22 * q.z, q.z + 0.22 * q.y);
    let flap = ellipsoid(q, xyz(0.2, 0.0, 0.0), xyz(0.75, 3.1, 1.75));
    let bowl = ellipsoid(q, xyz(1.05, 0.35, 0.25), xyz(0.75, 2.1, 1.0));
    let lobe = ellipsoid(q, xyz(0.25, -2.6, 0.5), xyz(0.6, 0.9, 0.8));
    let ear = join(carve(flap, bowl, 0.35), lobe, 0.5);
    join(d, ear, 0.45)
}

/// Returns the distance from the union of two solids. `a` and `b` are the distances from the two solids. The edge
/// between the solids is rounded over a width `k`.
fn join(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

/// Returns the distance from the intersection of two solids. `a` and `b` are the distances from the two solids. The
/// edge between the solids is rounded over a width `k`.
fn meet(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, -b, k)
}

/// Returns the distance from the solid of distance `a` after the solid of distance `b` is cut out. The edge of the cut
/// is rounded over a width `k`.
fn carve(a: f64, b: f64, k: f64) -> f64 {
    meet(a, -b, k)
}

/// Returns a first-order estimate of the distance from an ellipsoid. The estimate is exact at the surface.
fn ellipsoid(p: DVec3, centre: DVec3, radii: DVec3) -> f64 {
    let scaled = (p - centre) / radii;
    let reach = scaled.length();
    let slope = (scaled / radii).length();
    if slope > 0.0 { reach * (reach - 1.0) / slope } else { -radii.min_element() }
}

/// Returns the distance from a rounded rod between the points `a` and `b`. The rod's radius changes linearly from
/// `from` at `a` to `to` at `b`.
fn capsule(p: DVec3, a: DVec3, b: DVec3, from: f64, to: f64) -> f64 {
    let ap = p - a;
    let ab = b - a;
    let t = (ap.dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (ap - ab * t).length() - (from + (to - from) * t)
}

/// Returns the outward unit normal at a point, computed from central differences of the distance function.
pub(super) fn normal(p: DVec3) -> DVec3 {
    const STEP: f64 = 0.02;
    let differences = DVec3::AXES.map(|axis| distance(p + axis * STEP) - distance(p - axis * STEP));
    DVec3::from_array(differences).normalize_or(DVec3::Y)
}
