//! A scene whose objects are cut at the borders of cells.

use crate::cube_faces::Corner;
use address_recalculation::priority::{Cell, Segmentation};
use glam::DVec3;
use pxpl5_scene::{Frame, Lighting, Scene, Structure, Vertex};
use pxpl5_sim::parameters::SettingError;
use std::collections::BTreeMap;
use std::ops::Range;

/// The part of an object that lies in one cell of the scene's floor plan.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Index of the object from which the segment was cut.
    pub object: usize,
    pub cell: Cell,
    /// Triangles as indices into [`World::vertices`].
    pub triangles: Vec<[u32; 3]>,
}

/// A part of the world that keeps its name when it is cut into segments.
#[derive(Clone, Debug)]
pub struct Object {
    pub name: String,
    /// Range of the object's segments in [`World::segments`].
    pub segments: Range<usize>,
}

/// A vertex on a cut. Several segments share this vertex.
#[derive(Clone, Debug)]
pub struct SharedVertex {
    /// Index into [`World::vertices`].
    pub vertex: u32,
    /// Indices of the segments that have this vertex, at least two.
    pub segments: Vec<usize>,
}

/// Meaning of the colours in which triangles are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tint {
    /// The shaded colours of the scene.
    #[default]
    Shaded,
    Objects,
    Cells,
}

/// A scene whose objects are cut at the borders of cells.
#[derive(Clone, Debug)]
pub struct World {
    /// Positions in metres. The vertices of each object are followed by the vertices that its cuts add.
    pub vertices: Vec<DVec3>,
    /// Shaded colours of the vertices.
    pub colours: Vec<u32>,
    /// All segments, in the order of objects.
    pub segments: Vec<Segment>,
    pub objects: Vec<Object>,
    /// Vertices that several segments of an object share.
    pub shared: Vec<SharedVertex>,
    /// Background colour, 0x00RRGGBB.
    pub background: u32,
    pub tint: Tint,
}

impl World {
    /// Cuts a scene into cells with a side of `side_m` metres.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the scene has spheres, moving objects or objects fixed to the head, or if the
    /// scene cannot be cut.
    pub fn new(scene: &Scene, side_m: f64) -> Result<Self, SettingError> {
        check_is_static(scene)?;
        let mut world = Self {
            vertices: Vec::new(),
            colours: Vec::new(),
            segments: Vec::new(),
            objects: Vec::new(),
            shared: Vec::new(),
            background: packed(scene.lighting().background.map(f64::from)),
            tint: Tint::Shaded,
        };
        for structure in scene.structures() {
            world.add(scene, structure, side_m)?;
        }
        world.shared = shared(&world.segments);
        Ok(world)
    }

    fn add(&mut self, scene: &Scene, structure: &Structure, side_m: f64) -> Result<(), SettingError> {
        let first = self.vertices.len() as u32;
        let own = &scene.vertices()[structure.vertices.clone()];
        // Cut the structure, and interpolate the colours of the vertices that cuts created.
        let places: Vec<DVec3> = own.iter().map(|vertex| vertex.position.as_dvec3()).collect();
        let begin = structure.vertices.start as u32;
        let triangles: Vec<[u32; 3]> =
            scene.triangles()[structure.triangles.clone()].iter().map(|three| three.map(|i| i - begin)).collect();
        let cut = Segmentation::new(&places, &triangles, side_m)?;
        let mut colours: Vec<[f64; 3]> = own.iter().map(|vertex| shaded(vertex, scene.lighting())).collect();
        for made in &cut.cuts {
            let [from, to] = made.between.map(|i| colours[i as usize]);
            colours.push([0, 1, 2].map(|part| from[part] + (to[part] - from[part]) * made.share));
        }
        // Append everything with indices of the whole world.
        self.vertices.extend(&cut.vertices);
        self.colours.extend(colours.into_iter().map(packed));
        let object = self.objects.len();
        let segments = self.segments.len();
        self.segments.extend(cut.segments.into_iter().map(|(cell, triangles)| {
            let triangles = triangles.into_iter().map(|three| three.map(|i| i + first)).collect();
            Segment { object, cell, triangles }
        }));
        self.objects.push(Object { name: structure.name.clone(), segments: segments..self.segments.len() });
        Ok(())
    }

    /// Returns the cells that contain segments (parts of objects). A cell is returned once for each of its segments.
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        self.segments.iter().map(|segment| segment.cell)
    }

    /// Returns the triangles of the segments (parts of objects) with these indices. `place` returns the position at
    /// which a vertex is drawn.
    pub fn triangles<'a>(
        &'a self,
        segments: &'a [usize],
        place: impl Fn(DVec3) -> DVec3 + 'a,
    ) -> impl Iterator<Item = [Corner; 3]> + 'a {
        let all = segments.iter().flat_map(move |i| self.segments[*i].triangles.iter().map(move |three| (*i, three)));
        all.map(move |(segment, three)| {
            let tint = self.tint_of(segment);
            three.map(|i| {
                let colour = tint.unwrap_or(self.colours[i as usize]);
                Corner { place: place(self.vertices[i as usize]), colour }
            })
        })
    }

    fn tint_of(&self, segment: usize) -> Option<u32> {
        let Segment { object, cell, .. } = &self.segments[segment];
        match self.tint {
            Tint::Shaded => None,
            Tint::Objects => Some(distinct(*object as u64)),
            Tint::Cells => Some(distinct((cell.x + 1_000_000) as u64 * 31 + (cell.z + 1_000_000) as u64)),
        }
    }

    /// Returns the centre of the bounding box of a range of segments (parts of objects), and the distance to their
    /// farthest vertex in metres.
    pub fn bounding_sphere(&self, segments: Range<usize>) -> (DVec3, f64) {
        let corners = self.segments[segments].iter().flat_map(|segment| segment.triangles.iter().flatten());
        let places: Vec<DVec3> = corners.map(|i| self.vertices[*i as usize]).collect();
        let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let centre = (low + high) / 2.0;
        (centre, places.iter().map(|place| place.distance(centre)).fold(0.0, f64::max))
    }
}

/// Returns a colour for a number. The hue changes by the golden ratio from one number to the next, so the colours of
/// neighbouring numbers differ.
fn distinct(number: u64) -> u32 {
    let hue = (number as f64 * 0.618_033_988_749_895).fract() * 6.0;
    packed([0.0, 2.0, 4.0].map(|shift| 70.0 + 160.0 * (((hue + shift) % 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0)))
}

fn check_is_static(scene: &Scene) -> Result<(), SettingError> {
    let refused = |expected: &'static str, found: String| {
        Err(SettingError::scene(&format!("scene {}", scene.name()), expected, found))
    };
    if !scene.spheres().is_empty() {
        return refused("triangles alone: faces have no spheres", format!("{} spheres", scene.spheres().len()));
    }
    for structure in scene.structures() {
        if structure.frame == Frame::Head {
            return refused("structures fixed to the world", format!("{}, fixed to the head", structure.name));
        }
        if structure.hinge.is_some() {
            return refused("structures that do not move", format!("{}, on a hinge", structure.name));
        }
    }
    Ok(())
}

/// Returns the shaded colour of a vertex, with components from 0 to 255.
fn shaded(vertex: &Vertex, light: &Lighting) -> [f64; 3] {
    let square = f64::from(vertex.normal.dot(light.towards_light)).max(0.0);
    let part = f64::from(light.ambient) + f64::from(light.diffuse) * square;
    vertex.colour.map(|colour| f64::from(colour) * part)
}

fn packed(parts: [f64; 3]) -> u32 {
    parts.iter().fold(0, |colour, part| colour << 8 | part.round().clamp(0.0, 255.0) as u32)
}

fn shared(segments: &[Segment]) -> Vec<SharedVertex> {
    // Collect the segments of each vertex. Vertices of one segment repeat, so compare with the last entry.
    let mut holders: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (number, segment) in segments.iter().enumerate() {
        for vertex in segment.triangles.iter().flatten() {
            let held = holders.entry(*vertex).or_default();
            if held.last() != Some(&number) {
                held.push(number);
            }
        }
    }
    let shared = holders.into_iter().filter(|(_, segments)| segments.len() > 1);
    shared.map(|(vertex, segments)| SharedVertex { vertex, segments }).collect()
}
