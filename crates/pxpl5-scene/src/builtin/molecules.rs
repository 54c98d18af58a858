//! A scene of molecules: myoglobin as atoms, myoglobin as a ribbon, and a water molecule.
//!
//! The coordinates of myoglobin are Protein Data Bank entry 1MBN by H. C. Watson, 1969, unchanged in `assets/1mbn.pdb`.

use glam::DVec3;

use super::solid::{Colour, Solid};
use crate::config::FIT_RADIUS_M;
use crate::import::{Atom, Source, read_atoms};
use crate::motion::HeadMotion;
use crate::scene::{Lighting, Scene, SceneParts, Sphere, bounding_sphere};

static MYOGLOBIN: &[u8] = include_bytes!("../../assets/1mbn.pdb");

/// Number of cross-sections of the ribbon: (2,620 triangles - 2 for each of 2 ends) / 8 + 1.
const SECTIONS: usize = 328;

/// Half the distance between the centres of the two myoglobin molecules, Ångström. The radius of each molecule is
/// about 25.
const APART: f64 = 25.0;

/// Greatest distance between alpha carbons three residues apart that counts as a helix, Ångström. The distance is 5.0
/// in an ideal alpha helix and above 8 in an extended chain. The distance in a helix is derived from a rise of 1.5 and
/// a turn of 100 degrees per residue, at a radius of 2.3.
const HELIX_STEP: f64 = 6.2;

pub(super) fn scene() -> Scene {
    let source = Source { name: "1mbn.pdb", bytes: MYOGLOBIN, folder: None };
    let atoms = read_atoms(&source).expect("pxpl5-scene: the stored molecule is sound");
    // Atoms are on the left, the ribbon of the same molecule on the right.
    let (centre, _) = bounding_sphere(atoms.iter().map(|a| (a.position, a.element.radius)));
    let mut spheres: Vec<Sphere> = atoms
        .iter()
        .map(|a| sphere(a.position - centre - DVec3::X * APART, a.element.radius, a.element.colour))
        .collect();
    spheres.extend(water());
    let mut solid = Solid::default();
    ribbon(&mut solid, &backbone(&atoms, DVec3::X * APART - centre));
    fitted(solid, spheres)
}

fn sphere(centre: DVec3, radius: f64, colour: Colour) -> Sphere {
    Sphere { centre: centre.as_vec3(), radius: radius as f32, colour }
}

/// Returns a water molecule, one oxygen and two hydrogens, below and between the two myoglobins. The bonds are 0.957
/// Ångström long at 104.5 degrees.
fn water() -> [Sphere; 3] {
    let oxygen = DVec3::new(0.0, -20.0, 6.0);
    // The offsets are 0.957 times sine and cosine of 52.25 degrees.
    let [right, left] = [1.0, -1.0].map(|side| oxygen + DVec3::new(side * 0.7567, -0.5859, 0.0));
    [sphere(oxygen, 1.52, [240, 24, 24]), sphere(right, 1.20, [255, 255, 255]), sphere(left, 1.20, [255, 255, 255])]
}

/// A residue (amino acid) of the protein's chain, with the position and shape of the ribbon at this residue.
struct Residue {
    alpha: DVec3,
    /// Direction across the ribbon, from the carbonyl carbon to its oxygen. In a helix this direction is parallel to
    /// the axis, so the ribbon lies flat on the helix.
    across: DVec3,
    /// Half the width of the ribbon, Ångström.
    width: f64,
}

fn backbone(atoms: &[Atom], shift: DVec3) -> Vec<Residue> {
    let alphas = positions(atoms, "CA", shift);
    let carbons = positions(atoms, "C", shift);
    let oxygens = positions(atoms, "O", shift);
    let mut across = DVec3::X;
    let mut residues = Vec::with_capacity(alphas.len());
    for (i, &alpha) in alphas.iter().enumerate() {
        // Directions of successive residues must not flip, or the ribbon would twist.
        let mut direction = (oxygens[i] - carbons[i]).normalize_or(across);
        if direction.dot(across) < 0.0 {
            direction = -direction;
        }
        across = direction;
        let width = if in_helix(&alphas, i) { 1.5 } else { 0.45 };
        residues.push(Residue { alpha, across, width });
    }
    residues
}

/// Returns the positions of all atoms named `name`, moved by `shift`, in Ångström. Each residue (amino acid) has one
/// such atom.
fn positions(atoms: &[Atom], name: &str, shift: DVec3) -> Vec<DVec3> {
    let named = atoms.iter().filter(|a| a.name == name);
    named.map(|a| a.position + shift).collect()
}

fn in_helix(alphas: &[DVec3], i: usize) -> bool {
    let first = i.saturating_sub(3);
    let last = (i + 3).min(alphas.len() - 1);
    (first..=last.saturating_sub(3)).any(|j| (alphas[j + 3] - alphas[j]).length() < HELIX_STEP)
}

/// Adds a ribbon with a rectangular cross-section along the chain. Its colour changes from blue at the beginning to red
/// at the end.
fn ribbon(solid: &mut Solid, chain: &[Residue]) {
    let sections: Vec<Vec<DVec3>> = (0..SECTIONS).map(|i| section(chain, part_of_chain(i)).to_vec()).collect();
    let first = solid.mesh.positions.len();
    solid.plates(&sections, [0; 3]);
    // Each of the four plates has two vertices per section.
    for vertex in first..solid.mesh.positions.len() {
        let along = (vertex - first) / 2 % SECTIONS;
        solid.mesh.colours[vertex] = rainbow(part_of_chain(along));
    }
    let mut start = sections[0].clone();
    start.reverse();
    solid.face(&start, rainbow(0.0));
    solid.face(&sections[SECTIONS - 1], rainbow(1.0));
}

fn part_of_chain(section: usize) -> f64 {
    section as f64 / (SECTIONS - 1) as f64
}

/// Returns the four corners of the ribbon's cross-section at `place`, a fraction of the chain from 0 to 1. The corners
/// run anticlockwise seen from the chain's end.
fn section(chain: &[Residue], place: f64) -> [DVec3; 4] {
    let along = place * (chain.len() - 1) as f64;
    let i = (along as usize).min(chain.len() - 2);
    let t = along - i as f64;
    // The residue before the position and the three after it, limited to the chain.
    let near = [0, 1, 2, 3].map(|k| &chain[(i + k).saturating_sub(1).min(chain.len() - 1)]);
    let alphas = near.map(|residue| residue.alpha);
    let centre = spline(alphas, t);
    let forward = (spline(alphas, t + 0.01) - spline(alphas, t - 0.01)).normalize_or(DVec3::Z);
    // `across` must be perpendicular to the chain.
    let across = spline(near.map(|residue| residue.across), t);
    let across = (across - forward * across.dot(forward)).normalize_or(DVec3::X);
    let width = near[1].width + (near[2].width - near[1].width) * t;
    let wide = across * width;
    let thick = forward.cross(across) * 0.3;
    [wide + thick, thick - wide, -wide - thick, wide - thick].map(|corner| centre + corner)
}

/// Evaluates a uniform cubic B-spline. The spline passes near its points, not through them, which smooths the zigzag of
/// a chain.
fn spline(p: [DVec3; 4], t: f64) -> DVec3 {
    let u = 1.0 - t;
    let weights = [u * u * u, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * u * u * u - 6.0 * u * u + 4.0, t * t * t];
    p.iter().zip(weights).map(|(&p, w)| p * (w / 6.0)).sum()
}

/// Returns a colour of the sequence blue, cyan, green, yellow, red. `place` runs from 0 for blue to 1 for red.
fn rainbow(place: f64) -> Colour {
    const STOPS: [[f64; 3]; 5] =
        [[40.0, 70.0, 240.0], [30.0, 200.0, 230.0], [50.0, 210.0, 70.0], [250.0, 220.0, 40.0], [235.0, 40.0, 40.0]];
    let along = place.clamp(0.0, 1.0) * 4.0;
    let i = (along as usize).min(3);
    let t = along - i as f64;
    [0, 1, 2].map(|k| (STOPS[i][k] + (STOPS[i + 1][k] - STOPS[i][k]) * t) as u8)
}

// Scales ribbon and spheres to the radius of the built-in models, and makes a scene.
fn fitted(mut solid: Solid, mut spheres: Vec<Sphere>) -> Scene {
    let points = solid.mesh.positions.iter().map(|&p| (p, 0.0));
    let balls = spheres.iter().map(|s| (s.centre.as_dvec3(), f64::from(s.radius)));
    let (centre, radius) = bounding_sphere(points.chain(balls));
    let scale = FIT_RADIUS_M / radius;
    for position in &mut solid.mesh.positions {
        *position = (*position - centre) * scale;
    }
    for sphere in &mut spheres {
        sphere.centre = ((sphere.centre.as_dvec3() - centre) * scale).as_vec3();
        sphere.radius = (f64::from(sphere.radius) * scale) as f32;
    }
    let parts = SceneParts {
        name: "molecules".to_owned(),
        vertices: solid.mesh.vertices(),
        triangles: solid.mesh.triangles,
        spheres,
        structures: Vec::new(),
        lighting: Lighting::over_the_shoulder(),
        // The molecules are half as high as wide, so the head can be nearer than it is to a ball. The molecules then
        // fill the width of the view.
        motion: HeadMotion::looking_at(glam::Vec3::ZERO, 0.8 * FIT_RADIUS_M),
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}
