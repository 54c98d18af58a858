//! Segmentation at load time: a scene in pieces, each of which lies in one cell of the world.

use glam::{DVec3, Vec3};
use priority_rendering::{Cell, CutVertex, PriorityError, Segmentation};
use pxpl5_scene::{Frame, Scene, SceneParts, Sphere, Structure, Vertex};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// A scene, and where each of its structures lies among square cells.
#[derive(Clone, Debug)]
pub struct CutScene {
    /// What is loaded in the place of the scene that was given.
    pub scene: Arc<Scene>,
    /// The cells of each structure: one of a segment, all of what was not cut, none of what moves by itself or with the head.
    pub cells: Arc<[Vec<Cell>]>,
}

impl CutScene {
    /// Structures cut at the borders of cells of this side, m. A cut through an edge makes one place, from which all pieces that share
    /// the edge take their vertex: they meet bit for bit. Its colour and its normal are interpolated. A sphere is not cut, and
    /// belongs to the cell of its centre; what moves stays whole.
    ///
    /// # Errors
    ///
    /// [`PriorityError`] for what cannot be cut: see [`Segmentation::new`].
    pub fn segmented(scene: &Scene, side_m: f64) -> Result<Self, PriorityError> {
        let mut pieces = Pieces::of(scene);
        for structure in scene.structures() {
            if moves(structure) {
                pieces.add_whole(scene, structure);
            } else {
                pieces.add_segments(scene, structure, side_m)?;
            }
        }
        pieces.finish()
    }

    /// The scene as it is, with the cells that each structure touches.
    ///
    /// # Errors
    ///
    /// As [`CutScene::segmented`].
    pub fn whole(scene: &Arc<Scene>, side_m: f64) -> Result<Self, PriorityError> {
        let cells = scene.structures().iter().map(|structure| cells(scene, structure, side_m));
        Ok(Self { scene: Arc::clone(scene), cells: cells.collect::<Result<Vec<_>, _>>()?.into() })
    }
}

/// Whether a structure has no place in the world that it keeps.
pub(crate) const fn moves(structure: &Structure) -> bool {
    structure.hinge.is_some() || matches!(structure.frame, Frame::Head)
}

fn cells(scene: &Scene, structure: &Structure, side_m: f64) -> Result<Vec<Cell>, PriorityError> {
    if moves(structure) {
        return Ok(Vec::new());
    }
    let cut = cut(scene, structure, side_m)?;
    let of_spheres = scene.spheres()[structure.spheres.clone()].iter().map(|sphere| cell_of(sphere, side_m));
    let all: BTreeSet<Cell> = cut.segments.into_keys().chain(of_spheres).collect();
    Ok(all.into_iter().collect())
}

fn cell_of(sphere: &Sphere, side_m: f64) -> Cell {
    Cell::of(f64::from(sphere.centre.x), f64::from(sphere.centre.z), side_m)
}

/// The triangles of a structure, whose vertices are counted from its own first one.
fn cut(scene: &Scene, structure: &Structure, side_m: f64) -> Result<Segmentation, PriorityError> {
    let own = &scene.vertices()[structure.vertices.clone()];
    let places: Vec<DVec3> = own.iter().map(|vertex| vertex.position.as_dvec3()).collect();
    let first = structure.vertices.start as u32;
    let triangles = scene.triangles()[structure.triangles.clone()].iter();
    let triangles: Vec<[u32; 3]> = triangles.map(|corners| corners.map(|corner| corner - first)).collect();
    Segmentation::new(&places, &triangles, side_m)
}

/// A scene that is put together of segments.
struct Pieces {
    parts: SceneParts,
    cells: Vec<Vec<Cell>>,
}

impl Pieces {
    /// No piece of a scene.
    fn of(scene: &Scene) -> Self {
        let parts = SceneParts {
            vertices: Vec::new(),
            triangles: Vec::new(),
            spheres: Vec::new(),
            structures: Vec::new(),
            ..scene.clone().into_parts()
        };
        Self { parts, cells: Vec::new() }
    }

    fn add_whole(&mut self, scene: &Scene, structure: &Structure) {
        let first = structure.vertices.start as u32;
        let triangles = scene.triangles()[structure.triangles.clone()].iter();
        let triangles: Vec<[u32; 3]> = triangles.map(|corners| corners.map(|corner| corner - first)).collect();
        let vertices = &scene.vertices()[structure.vertices.clone()];
        self.add(structure, vertices, &triangles, &scene.spheres()[structure.spheres.clone()]);
        self.cells.push(Vec::new());
    }

    fn add_segments(&mut self, scene: &Scene, structure: &Structure, side_m: f64) -> Result<(), PriorityError> {
        let cut = cut(scene, structure, side_m)?;
        let mut vertices = scene.vertices()[structure.vertices.clone()].to_vec();
        for (place, made) in cut.vertices[vertices.len()..].iter().zip(&cut.cuts) {
            vertices.push(between(&vertices, *place, made));
        }
        let mut spheres: BTreeMap<Cell, Vec<Sphere>> = BTreeMap::new();
        for sphere in &scene.spheres()[structure.spheres.clone()] {
            spheres.entry(cell_of(sphere, side_m)).or_default().push(*sphere);
        }
        let in_cells: BTreeSet<Cell> = cut.segments.keys().chain(spheres.keys()).copied().collect();
        for cell in in_cells {
            let triangles = cut.segments.get(&cell).map_or(&[][..], Vec::as_slice);
            let (vertices, triangles) = own_vertices(&vertices, triangles);
            self.add(structure, &vertices, &triangles, spheres.get(&cell).map_or(&[][..], Vec::as_slice));
            self.cells.push(vec![cell]);
        }
        Ok(())
    }

    /// A structure like another one, of these primitives.
    fn add(&mut self, like: &Structure, vertices: &[Vertex], triangles: &[[u32; 3]], spheres: &[Sphere]) {
        let first = self.parts.vertices.len() as u32;
        let structure = Structure {
            vertices: appended(&mut self.parts.vertices, vertices.iter().copied()),
            triangles: appended(&mut self.parts.triangles, triangles.iter().map(|corners| corners.map(|i| i + first))),
            spheres: appended(&mut self.parts.spheres, spheres.iter().copied()),
            ..like.clone()
        };
        self.parts.structures.push(structure);
    }

    fn finish(self) -> Result<CutScene, PriorityError> {
        let scene = Scene::new(self.parts).map_err(|error| PriorityError(format!("segments: {error}")))?;
        Ok(CutScene { scene: Arc::new(scene), cells: self.cells.into() })
    }
}

/// The places at which elements were added.
fn appended<T>(all: &mut Vec<T>, more: impl Iterator<Item = T>) -> Range<usize> {
    let first = all.len();
    all.extend(more);
    first..all.len()
}

/// A vertex of a cut.
fn between(vertices: &[Vertex], place: DVec3, made: &CutVertex) -> Vertex {
    let [from, to] = made.between.map(|i| vertices[i as usize]);
    let share = made.share as f32;
    let part = |i: usize| {
        let [from, to] = [from, to].map(|end| f64::from(end.colour[i]));
        (from + (to - from) * made.share).round().clamp(0.0, 255.0) as u8
    };
    let normal: Vec3 = from.normal.lerp(to.normal, share).normalize_or(from.normal);
    Vertex { position: place.as_vec3(), normal, colour: [0, 1, 2].map(part) }
}

/// The vertices that some triangles name, in their order, and the triangles in their numbers.
fn own_vertices(all: &[Vertex], triangles: &[[u32; 3]]) -> (Vec<Vertex>, Vec<[u32; 3]>) {
    let named: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let numbers: BTreeMap<u32, u32> = named.iter().copied().zip(0..).collect();
    let vertices = named.iter().map(|vertex| all[*vertex as usize]).collect();
    (vertices, triangles.iter().map(|corners| corners.map(|corner| numbers[&corner])).collect())
}
