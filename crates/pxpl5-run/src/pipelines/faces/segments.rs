//! Segmentation at load time: cuts a scene into segments that each lie in one cell of the world.

use address_recalculation::priority::{Cell, CutVertex, Segmentation};
use glam::{DVec3, Vec3};
use pxpl5_machine::Attachment;
use pxpl5_scene::{Frame, Scene, SceneParts, Sphere, Structure, Vertex};
use pxpl5_sim::parameters::SettingError;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

/// A scene, and the square cells of the world in which each structure lies.
#[derive(Clone, Debug)]
pub struct SegmentedScene {
    /// Scene that is loaded instead of the original scene.
    pub scene: Arc<Scene>,
    /// Cells (squares of the floor) of each structure. A segment has one cell. A structure that was not cut has all
    /// cells that the structure touches. A moving structure has no cell.
    pub cells: Arc<[Vec<Cell>]>,
}

impl SegmentedScene {
    /// Cuts structures at the borders of square cells with a side of `side_m` metres.
    ///
    /// A cut through an edge creates one vertex that all adjacent segments share, so no gap opens between the segments.
    /// The colour and normal of this vertex are interpolated. A sphere is not cut and belongs to the cell of its
    /// centre. A moving structure stays whole.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the scene cannot be cut: see [`Segmentation::new`].
    pub fn segmented(scene: &Scene, side_m: f64) -> Result<Self, SettingError> {
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

    /// Leaves the scene uncut and finds the cells that each structure touches.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`SegmentedScene::segmented`].
    pub fn whole(scene: &Arc<Scene>, side_m: f64) -> Result<Self, SettingError> {
        let cells = scene.structures().iter().map(|structure| cells(scene, structure, side_m));
        Ok(Self { scene: Arc::clone(scene), cells: cells.collect::<Result<Vec<_>, _>>()?.into() })
    }
}

impl Attachment for SegmentedScene {}

/// Returns true if a structure moves by itself or with the head. Such a structure has no fixed position in the world.
pub(crate) const fn moves(structure: &Structure) -> bool {
    structure.hinge.is_some() || matches!(structure.frame, Frame::Head)
}

fn cells(scene: &Scene, structure: &Structure, side_m: f64) -> Result<Vec<Cell>, SettingError> {
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

/// Cuts the triangles of a structure at the borders of cells. Vertex indices are relative to the structure's first
/// vertex.
fn cut(scene: &Scene, structure: &Structure, side_m: f64) -> Result<Segmentation, SettingError> {
    let own = &scene.vertices()[structure.vertices.clone()];
    let places: Vec<DVec3> = own.iter().map(|vertex| vertex.position.as_dvec3()).collect();
    let first = structure.vertices.start as u32;
    let triangles = scene.triangles()[structure.triangles.clone()].iter();
    let triangles: Vec<[u32; 3]> = triangles.map(|corners| corners.map(|corner| corner - first)).collect();
    Segmentation::new(&places, &triangles, side_m)
}

/// A scene of segments (parts of structures in one cell), under construction.
struct Pieces {
    parts: SceneParts,
    cells: Vec<Vec<Cell>>,
}

impl Pieces {
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

    fn add_segments(&mut self, scene: &Scene, structure: &Structure, side_m: f64) -> Result<(), SettingError> {
        let cut = cut(scene, structure, side_m)?;
        // Append the vertices of the cuts. A cut may depend on earlier cuts, so the order matters.
        let mut vertices = scene.vertices()[structure.vertices.clone()].to_vec();
        for (place, made) in cut.vertices[vertices.len()..].iter().zip(&cut.cuts) {
            vertices.push(between(&vertices, *place, made));
        }
        // Assign each sphere to the cell of its centre.
        let mut spheres: BTreeMap<Cell, Vec<Sphere>> = BTreeMap::new();
        for sphere in &scene.spheres()[structure.spheres.clone()] {
            spheres.entry(cell_of(sphere, side_m)).or_default().push(*sphere);
        }
        let in_cells: BTreeSet<Cell> = cut.segments.keys().chain(spheres.keys()).copied().collect();
        // Each cell with primitives becomes a structure of its own.
        for cell in in_cells {
            let triangles = cut.segments.get(&cell).map_or(&[][..], Vec::as_slice);
            let (vertices, triangles) = own_vertices(&vertices, triangles);
            self.add(structure, &vertices, &triangles, spheres.get(&cell).map_or(&[][..], Vec::as_slice));
            self.cells.push(vec![cell]);
        }
        Ok(())
    }

    /// Adds a structure with the vertices `vertices`, the triangles `triangles` and the spheres `spheres`. All other
    /// properties are copied from the structure `like`.
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

    fn finish(self) -> Result<SegmentedScene, SettingError> {
        let scene = Scene::new(self.parts).map_err(|error| error.at("segments"))?;
        Ok(SegmentedScene { scene: Arc::new(scene), cells: self.cells.into() })
    }
}

fn appended<T>(all: &mut Vec<T>, more: impl Iterator<Item = T>) -> Range<usize> {
    let first = all.len();
    all.extend(more);
    first..all.len()
}

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

/// Returns the vertices that any of the triangles uses, in order, and the triangles with renumbered vertices.
fn own_vertices(all: &[Vertex], triangles: &[[u32; 3]]) -> (Vec<Vertex>, Vec<[u32; 3]>) {
    let named: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let numbers: BTreeMap<u32, u32> = named.iter().copied().zip(0..).collect();
    let vertices = named.iter().map(|vertex| all[*vertex as usize]).collect();
    (vertices, triangles.iter().map(|corners| corners.map(|corner| numbers[&corner])).collect())
}
