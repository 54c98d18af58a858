//! A swept-wing jet fighter similar to the MiG-17, with 417 triangles.
//!
//! The length is along z with the nose at +z. +y is up, and +x is the left of the aircraft. Lengths are first in metres
//! and roughly as in the real aircraft, which is 11 m long. The finished model is scaled to a radius of 2 m.

use glam::DVec3;

use super::solid::{Colour, Solid};
use crate::edit::Hinge;
use crate::import::Mesh;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Lighting, Scene, SceneParts, bounding_sphere};
use crate::sway::Sway;
use crate::trig;

const SILVER: Colour = [214, 220, 228];
const BELLY: Colour = [164, 174, 188];
const RED: Colour = [224, 36, 30];
const DARK: Colour = [34, 32, 36];
const DUCT: Colour = [70, 66, 66];
const GLASS: Colour = [90, 170, 226];
const STEEL: Colour = [140, 136, 132];

/// Radius to which the finished aircraft is scaled, metres. Assumed, 0.5 to 8. A flight around this aircraft passes at
/// several metres per second.
pub(super) const RADIUS_M: f64 = 2.0;

const SIDES: usize = 14;

pub(super) fn scene() -> Scene {
    let mut solid = Solid::default();
    fuselage(&mut solid); // 280 triangles
    wing(&mut solid, 1.0); // 23 triangles
    wing(&mut solid, -1.0); // 23 triangles
    fin(&mut solid); // 10 triangles
    ventral_fin(&mut solid); // 10 triangles
    canopy(&mut solid); // 24 triangles
    boom(&mut solid); // 3 triangles
    // Moving control surfaces are structures of their own.
    solid.end_structure("airframe", None);
    for (name, side) in [("left aileron", 1.0), ("right aileron", -1.0)] {
        aileron(&mut solid, name, side); // 8 triangles
    }
    for (name, side) in [("left tailplane", 1.0), ("right tailplane", -1.0)] {
        tailplane(&mut solid, name, side); // 10 triangles
    }
    rudder(&mut solid); // 8 triangles
    finish(solid)
}

fn finish(mut solid: Solid) -> Scene {
    // Hinges move and scale together with the vertices.
    let balls = solid.mesh.positions.iter().map(|&p| (p, 0.0));
    let (centre, radius) = bounding_sphere(balls);
    let scale = RADIUS_M / radius;
    for position in &mut solid.mesh.positions {
        *position = (*position - centre) * scale;
    }
    for hinge in solid.structures.iter_mut().filter_map(|s| s.hinge.as_mut()) {
        hinge.point = ((hinge.point.as_dvec3() - centre) * scale).as_vec3();
    }
    let parts = SceneParts {
        name: "mig".to_owned(),
        vertices: solid.mesh.vertices(),
        triangles: solid.mesh.triangles,
        spheres: Vec::new(),
        structures: solid.structures,
        lighting: Lighting { background: [92, 140, 200], ..Lighting::over_the_shoulder() },
        motion: fly_through(),
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

/// Returns the motion of a head around the aircraft. At the nearest point, the head is closer to the centre than the
/// tips of the wings, so the aircraft is larger than the view. At the farthest point, five radii of the aircraft away,
/// the aircraft appears small.
pub(super) fn fly_through() -> HeadMotion {
    let path = HeadPath::FlyThrough {
        target: glam::Vec3::ZERO,
        nearest: 0.65 * RADIUS_M,
        farthest: 5.0 * RADIUS_M,
        lap_s: 20.0,
    };
    HeadMotion::new(path, Sway { seed: 1, scale: 1.0 }).expect("pxpl5-scene: constants are in range")
}

/// Returns a closed cross-section of the fuselage: an ellipse at height `y` and at `z` along the fuselage. Its points
/// run anticlockwise seen from the nose.
fn ring(z: f64, y: f64, width: f64, height: f64) -> Vec<DVec3> {
    let points = (0..SIDES).map(|i| {
        let turns = (i as f64 + 0.5) / SIDES as f64;
        let x = trig::cos_turns(turns);
        let up = trig::sin_turns(turns);
        DVec3::new(x * width, y + up * height, z)
    });
    points.collect()
}

fn fuselage(solid: &mut Solid) {
    // (z, y, half width, half height) of each ring, from the jet pipe to the intake.
    let stations = [
        (-5.6, 0.16, 0.50, 0.52),
        (-4.4, 0.12, 0.64, 0.68),
        (-2.4, 0.04, 0.80, 0.86),
        (-0.4, 0.0, 0.86, 0.92),
        (1.8, 0.0, 0.84, 0.90),
        (3.6, -0.02, 0.74, 0.80),
        (5.0, -0.06, 0.58, 0.62),
        (5.6, -0.08, 0.48, 0.50),
    ];
    let rings: Vec<Vec<DVec3>> = stations.map(|(z, y, w, h)| ring(z, y, w, h)).into();
    solid.skin(&rings, SILVER);
    let whole = 0..solid.mesh.positions.len();
    // Paint the belly and the nose.
    solid.paint(whole.clone(), BELLY, |p| p.y < -0.35);
    solid.paint(whole, RED, |p| p.z > 5.5);
    // The jet pipe and the intake are hollow, each with a dark cone inside.
    let [pipe, intake] = [&rings[0], &rings[7]];
    let deep_pipe = ring(-4.9, 0.14, 0.42, 0.44);
    solid.skin(&[deep_pipe.clone(), pipe.clone()], STEEL);
    solid.cone(&reversed(deep_pipe), DVec3::new(0.0, 0.14, -5.3), DARK);
    let deep_intake = ring(4.9, -0.07, 0.40, 0.42);
    solid.skin(&[intake.clone(), deep_intake.clone()], DUCT);
    solid.cone(&deep_intake, DVec3::new(0.0, -0.07, 5.35), DARK);
}

fn reversed(mut section: Vec<DVec3>) -> Vec<DVec3> {
    section.reverse();
    section
}

struct Cut {
    leading: DVec3,
    trailing: DVec3,
    thickness: DVec3,
}

impl Cut {
    fn new(leading: [f64; 3], chord: f64, thickness: [f64; 3]) -> Self {
        let leading = DVec3::from_array(leading);
        Self { leading, trailing: leading - DVec3::Z * chord, thickness: DVec3::from_array(thickness) }
    }

    fn thickest(&self) -> DVec3 {
        self.leading.lerp(self.trailing, 0.38)
    }

    /// Returns the four corners of a pointed cross-section: leading edge, upper side, trailing edge, lower side.
    fn diamond(&self) -> Vec<DVec3> {
        let middle = self.thickest();
        vec![self.leading, middle + self.thickness, self.trailing, middle - self.thickness]
    }

    fn blunt(&self) -> Vec<DVec3> {
        let middle = self.thickest();
        let edge = self.thickness * 0.3;
        vec![self.leading, middle + self.thickness, self.trailing + edge, self.trailing - edge, middle - self.thickness]
    }

    fn wedge_behind(&self, chord: f64) -> Vec<DVec3> {
        let edge = self.thickness * 0.3;
        vec![self.trailing + edge, self.trailing - DVec3::Z * chord, self.trailing - edge]
    }
}

/// Adds a wing or fin between cross-sections that run from root to tip. If `turned` is true, the points of each
/// cross-section are reversed, because a surface on the right side is a mirror image.
fn surface(solid: &mut Solid, sections: Vec<Vec<DVec3>>, turned: bool, colour: Colour, tip: Colour) {
    let sections: Vec<Vec<DVec3>> = if turned { sections.into_iter().map(reversed).collect() } else { sections };
    let first = solid.mesh.positions.len();
    solid.plates(&sections, colour);
    let end = &sections[sections.len() - 1];
    let farthest = end[0];
    solid.face(end, tip);
    let last = solid.mesh.positions.len();
    // Paint the tip of the surface too.
    solid.paint(first..last, tip, |p| (p - farthest).length() < 1.7 && same_span(p, farthest));
}

fn same_span(a: DVec3, b: DVec3) -> bool {
    (a.x.abs() - b.x.abs()).abs() < 0.01 && (a.y - b.y).abs() < 0.1
}

// Cross-sections of the wing from root to tip: span x, z of the leading edge, chord.
const WING_SWEEP: [(f64, f64, f64); 3] = [(0.5, 2.3, 3.1), (2.9, -0.15, 2.25), (4.9, -2.35, 1.45)];

/// Returns the cross-section of the wing with index `station`, counted from the root. The wing is slightly lower at its
/// tip (anhedral).
fn wing_cut(side: f64, station: usize) -> Cut {
    let (x, z, chord) = WING_SWEEP[station];
    Cut::new([side * x, -0.05 - 0.05 * x, z], chord, [0.0, 0.17 - 0.026 * x, 0.0])
}

fn wing(solid: &mut Solid, side: f64) {
    let sections: Vec<Vec<DVec3>> = (0..3).map(|station| wing_cut(side, station).blunt()).collect();
    surface(solid, sections, side < 0.0, SILVER, RED);
}

/// Adds a control surface: a wedge behind the blunt trailing edge of a wing or fin. `cuts` are the cross-sections at
/// the two ends of the wedge, and `chords` the lengths of the wedge at these ends. The blunt edge is the hinge. Returns
/// a point on the hinge and its direction.
fn flap(solid: &mut Solid, cuts: [&Cut; 2], chords: [f64; 2], turned: bool) -> (DVec3, DVec3) {
    let mut sections = [cuts[0].wedge_behind(chords[0]), cuts[1].wedge_behind(chords[1])];
    if turned {
        sections = sections.map(reversed);
    }
    solid.plates(&sections, RED);
    solid.face(&reversed(sections[0].clone()), RED);
    solid.face(&sections[1], RED);
    (cuts[0].trailing, cuts[1].trailing - cuts[0].trailing)
}

fn aileron(solid: &mut Solid, name: &str, side: f64) {
    let (point, axis) = flap(solid, [&wing_cut(side, 1), &wing_cut(side, 2)], [0.5, 0.36], side < 0.0);
    // The axis points outwards along the span, so equal turns deflect left and right in opposite directions.
    solid.end_structure(name, Some(hinge(point, axis, 20.0, 4, 0.0)));
}

fn tailplane(solid: &mut Solid, name: &str, side: f64) {
    let root = Cut::new([side * 0.06, 1.75, -4.55], 1.35, [0.0, 0.09, 0.0]);
    let tip = Cut::new([side * 1.95, 1.75, -6.0], 0.75, [0.0, 0.05, 0.0]);
    surface(solid, vec![root.diamond(), tip.diamond()], side < 0.0, SILVER, RED);
    let pivot = root.leading.lerp(root.trailing, 0.6);
    solid.end_structure(name, Some(hinge(pivot, DVec3::X, 8.0, 6, 0.25)));
}

fn fin_cuts() -> [Cut; 2] {
    [Cut::new([0.0, 0.55, -2.7], 2.3, [0.12, 0.0, 0.0]), Cut::new([0.0, 2.75, -4.95], 0.95, [0.06, 0.0, 0.0])]
}

fn fin(solid: &mut Solid) {
    let [root, tip] = fin_cuts();
    surface(solid, vec![root.diamond(), tip.diamond()], true, SILVER, RED);
}

fn rudder(solid: &mut Solid) {
    let [root, tip] = fin_cuts();
    let (point, axis) = flap(solid, [&root, &tip], [0.62, 0.4], true);
    solid.end_structure("rudder", Some(hinge(point, axis, 18.0, 5, 0.5)));
}

fn ventral_fin(solid: &mut Solid) {
    let root = Cut::new([0.0, -0.45, -3.6], 1.7, [0.06, 0.0, 0.0]);
    let tip = Cut::new([0.0, -0.98, -4.3], 0.9, [0.03, 0.0, 0.0]);
    surface(solid, vec![root.diamond(), tip.diamond()], false, BELLY, BELLY);
}

/// Returns five points on the upper half of an ellipse with centre height `base`, at `z` along the fuselage.
fn arch(z: f64, base: f64, width: f64, height: f64) -> [DVec3; 5] {
    [0.0, 1.0, 2.0, 3.0, 4.0].map(|eighths| {
        let turns = eighths / 8.0;
        DVec3::new(trig::cos_turns(turns) * width, base + trig::sin_turns(turns) * height, z)
    })
}

fn canopy(solid: &mut Solid) {
    let arches = [arch(1.0, 0.62, 0.42, 0.62), arch(2.1, 0.58, 0.48, 0.74), arch(3.0, 0.56, 0.44, 0.62)];
    let back = DVec3::new(0.0, 0.88, -0.6);
    let front = DVec3::new(0.0, 0.62, 3.9);
    let mut part = Mesh::default();
    for &point in arches.iter().flatten() {
        part.push(point, DVec3::ZERO, GLASS);
    }
    let [back, front] = [back, front].map(|p| part.push(p, DVec3::ZERO, GLASS));
    // Join back point, three arches and front point.
    for i in 0..4 {
        part.fan(&[back, i + 1, i]);
        part.fan(&[i, i + 1, i + 6, i + 5]);
        part.fan(&[i + 5, i + 6, i + 11, i + 10]);
        part.fan(&[i + 10, i + 11, front]);
    }
    solid.append(part);
}

fn boom(solid: &mut Solid) {
    let section = [(0.06, -0.04), (0.0, 0.07), (-0.06, -0.04)].map(|(x, y)| DVec3::new(0.3 + x, 0.42 + y, 5.0));
    solid.cone(&section, DVec3::new(0.3, 0.42, 6.7), STEEL);
}

fn hinge(point: DVec3, axis: DVec3, amplitude_deg: f64, period_s: u64, phase_turns: f64) -> Hinge {
    Hinge {
        point: point.as_vec3(),
        axis: axis.as_vec3(),
        amplitude_deg,
        period_ps: period_s * 1_000_000_000_000,
        phase_turns,
    }
}
