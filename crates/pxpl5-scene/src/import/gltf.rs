//! Reader of glTF 2.0 files. It follows the nodes of the scene, and reads the primitives of their meshes.
//!
//! Indices and positions in buffers are checked when they are used, so that no file causes a panic. The existing
//! libraries gltf and gltf-json are not used: one panics at an index beyond a list, and the other refuses a file for a
//! part that is never drawn.

mod buffers;
mod container;
mod document;
#[cfg(feature = "files")]
mod host;
mod json;
mod numbers;

use std::collections::BTreeSet;

use glam::{DMat3, DMat4, DQuat, DVec3};
use pxpl5_sim::parameters::FileError;
use serde::Deserialize;
use serde_json::Value;

use self::buffers::Buffers;
use self::container::Chunks;
use self::document::Document;
use self::json::{COMPRESSION, Extensions, Mesh, Node, Primitive, Root, SceneNodes, Whole, parsed};
use self::numbers::{ComponentType, Numbers};
use super::Source;
use super::model::{Model, Places, counted, direction, push_with_slow_growth};
use crate::config::{DEFAULT_COLOUR, MAX_COORDINATE};

/// Extensions that need no warning, and that a file may even require. They concern only materials, textures, lights and
/// descriptions. `KHR_mesh_quantization` allows other types of numbers, which the importer can read.
const HARMLESS: [&str; 9] = [
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "KHR_lights_punctual",
    "KHR_xmp_json_ld",
    "KHR_animation_pointer",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "EXT_lights_image_based",
];
const HARMLESS_PREFIX: &str = "KHR_materials_";

/// Paths of the base colour within a material. It is white if the material does not state it.
const BASE_COLOURS: [&str; 2] =
    ["/pbrMetallicRoughness/baseColorFactor", "/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor"];

fn is_harmless(extension: &str) -> bool {
    HARMLESS.contains(&extension) || extension.starts_with(HARMLESS_PREFIX)
}

pub(super) fn read(source: &Source<'_>) -> Result<Model, FileError> {
    let mut model = Model::new(Places::Single(Vec::new()));
    let chunks = Chunks::of(source)?;
    let parsed_bytes = chunks.parsed_bytes();
    model.check_reading_bytes(source, parsed_bytes)?;
    let text = chunks.text();
    let root = chunks.parse(source, &text)?;
    check_extensions(source, &root)?;
    let buffers = Buffers::of(source, root.list("buffers"), chunks.binary);
    model.more_file_bytes = buffers.file_bytes;
    let held = parsed_bytes.saturating_add(buffers.decoded_bytes);
    let extensions = root.names("extensionsUsed").collect();
    let document = Document { source, root, buffers };
    let mut reader =
        Reader { document: &document, held, model, skipped: 0, skinned: 0, has_targets: false, extensions };
    reader.scene()?;
    Ok(reader.finished())
}

fn check_extensions(source: &Source<'_>, root: &Root) -> Result<(), FileError> {
    let mut required = root.names("extensionsRequired").enumerate();
    if let Some((number, name)) = required.find(|(_, name)| !is_harmless(name)) {
        let expected = match COMPRESSION.contains(&name.as_str()) {
            true => "a mesh without compression (other programs can decompress the file)",
            false => "an extension of materials, textures or lights, or KHR_mesh_quantization",
        };
        let part = format!("extensionsRequired[{number}]");
        return Err(source.part(part, expected, super::source::excerpt(&name)));
    }
    Ok(())
}

/// Types of numbers that vectors may have. Types other than F32 need `KHR_mesh_quantization`, except for colours.
const OF_VECTORS: [ComponentType; 5] =
    [ComponentType::F32, ComponentType::I8, ComponentType::U8, ComponentType::I16, ComponentType::U16];
const OF_INDICES: [ComponentType; 3] = [ComponentType::U8, ComponentType::U16, ComponentType::U32];

struct Reader<'a> {
    document: &'a Document<'a>,
    /// Number of bytes that the parsed JSON and the decoded buffers take in memory.
    held: usize,
    model: Model,
    /// Number of glTF primitives that were not read, because they consist of points or lines.
    skipped: usize,
    /// Number of nodes whose meshes are deformed by a skin.
    skinned: usize,
    has_targets: bool,
    /// Names of the extensions that the file announces, and of those of the nodes and primitives that are drawn.
    extensions: BTreeSet<String>,
}

impl<'a> Reader<'a> {
    /// Reads all meshes of the default scene.
    ///
    /// If the file names no default scene, the first scene is read. If the file has no scenes, all nodes without a
    /// parent are read.
    fn scene(&mut self) -> Result<(), FileError> {
        let Document { source, root, .. } = self.document;
        let (scenes, nodes) = (root.list("scenes"), root.list("nodes"));
        let number = root.scene.map_or(0, |scene| scene.0);
        let roots: Vec<usize> = match scenes.get(number) {
            Some(text) => {
                let scene: SceneNodes = parsed(source, &format!("scenes[{number}]"), text)?;
                scene.nodes.into_iter().flatten().map(|node| node.0).collect()
            }
            None if root.scene.is_some() => {
                let found = format!("{} scenes", scenes.len());
                return Err(source.part("scene", format!("a scene with the index {number}"), found));
            }
            None => self.roots_of(nodes.len())?,
        };
        // Each node waits at most once, so the list of waiting nodes is not longer than the list of nodes.
        let mut visited = vec![false; nodes.len()];
        let mut visit = |number: usize| match visited.get_mut(number).map(|node| std::mem::replace(node, true)) {
            Some(false) => Ok(number),
            // Nodes form trees. A node with two parents could otherwise multiply the model, and a circle of nodes would
            // have no end.
            Some(true) => {
                let found = "a second parent or a circle";
                Err(source.part(format!("nodes[{number}]"), "a node with at most one parent", found))
            }
            None => {
                let found = format!("{} nodes", nodes.len());
                Err(source.part(format!("nodes[{number}]"), "a node with this index", found))
            }
        };
        // Nodes that wait, with the transform of their parent. A list instead of recursion allows any depth.
        let mut waiting: Vec<(usize, DMat4)> = Vec::new();
        for root in roots.into_iter().rev() {
            waiting.push((visit(root)?, DMat4::IDENTITY));
        }
        while let Some((number, parent)) = waiting.pop() {
            let node: Node = parsed(source, &format!("nodes[{number}]"), nodes[number])?;
            let to_world = parent * transform(source, number, &node)?;
            for child in node.children.iter().flatten().rev() {
                waiting.push((visit(child.0)?, to_world));
            }
            self.node(node, to_world)?;
        }
        Ok(())
    }

    /// Returns the indices of all nodes without a parent.
    fn roots_of(&self, count: usize) -> Result<Vec<usize>, FileError> {
        let mut is_child = vec![false; count];
        for number in 0..count {
            let node: Node = self.document.object("nodes", number)?;
            for child in node.children.into_iter().flatten() {
                if let Some(is_child) = is_child.get_mut(child.0) {
                    *is_child = true;
                }
            }
        }
        Ok((0..count).filter(|&node| !is_child[node]).collect())
    }

    fn node(&mut self, node: Node, to_world: DMat4) -> Result<(), FileError> {
        let Some(number) = node.mesh.map(|mesh| mesh.0) else { return Ok(()) };
        self.note(node.extensions);
        let mesh: Mesh<'_> = self.document.object("meshes", number)?;
        // The joints of a skin determine the place of a mesh, and the node of the mesh does not. Without joints the
        // mesh stays as it is.
        let to_world = if node.skin.is_some() { DMat4::IDENTITY } else { to_world };
        self.skinned += usize::from(node.skin.is_some());
        for (of_mesh, text) in mesh.primitives.iter().flatten().enumerate() {
            let part = format!("meshes[{number}].primitives[{of_mesh}]");
            let primitive: Primitive<'_> = parsed(self.document.source, &part, text)?;
            self.has_targets |= primitive.targets.is_some_and(|targets| targets.get().contains('{'));
            self.primitive(&part, primitive, to_world)?;
        }
        Ok(())
    }

    fn note(&mut self, extensions: Extensions) {
        self.extensions.extend(extensions.into_iter().flatten().map(|(name, _)| name));
    }

    fn primitive(&mut self, part: &str, primitive: Primitive<'_>, to_world: DMat4) -> Result<(), FileError> {
        let document = self.document;
        let mode = match primitive.mode.map_or(4, |mode| mode.0) {
            0..=3 => {
                self.skipped += 1;
                return Ok(());
            }
            4 => Mode::Triangles,
            5 => Mode::TriangleStrip,
            6 => Mode::TriangleFan,
            other => return Err(document.source.part(format!("{part}.mode"), "0 to 6", other)),
        };
        self.note(primitive.extensions);
        let Some(positions) = primitive.attributes.positions else {
            return Err(document.source.part(format!("{part}.attributes"), "POSITION", document.none()));
        };
        let positions = self.numbers(positions, &[3], &OF_VECTORS)?;
        let normals =
            primitive.attributes.normals.map(|normals| self.numbers(normals, &[3], &OF_VECTORS)).transpose()?;
        let colours = primitive.attributes.colours.map(|colours| self.numbers(colours, &[3, 4], &OF_VECTORS));
        let colours = colours.transpose()?;
        for (name, other) in [("NORMAL", &normals), ("COLOR_0", &colours)] {
            if let Some(other) = other.as_ref().filter(|other| other.count != positions.count) {
                let expected = format!("{} items, as many as POSITION", positions.count);
                let found = other.count.to_string();
                return Err(document.source.part(format!("{part}.attributes.{name}"), expected, found));
            }
        }
        let indices = primitive.indices.map(|indices| self.numbers(indices, &[1], &OF_INDICES)).transpose()?;
        let base = self.base_colour(part, primitive.material, colours.is_some())?;
        let vertices = PrimitiveVertices { positions, normals, colours, base, to_world, part };
        let corners = Corners { indices, vertices: vertices.positions.count, mode };
        // Check that there is memory for the whole primitive before any part of the primitive is added.
        let flat = vertices.normals.is_none();
        let triangles = corners.triangles(document.source, part)?;
        let points = if flat { triangles.saturating_mul(3) } else { vertices.positions.count };
        let more =
            points.saturating_mul(BYTES_OF_POINT).saturating_add(triangles.saturating_mul(size_of::<[u32; 3]>()));
        self.model.check_reading_bytes(document.source, self.held.saturating_add(more))?;
        match flat {
            true => self.push_flat(&vertices, &corners, triangles),
            false => self.push_smooth(&vertices, &corners, triangles),
        }
    }

    /// Returns the numbers of a glTF accessor, which describes an array of vectors or indices.
    ///
    /// # Errors
    ///
    /// Fails if the accessor does not exist, has no bytes, or does not have one of the allowed types.
    fn numbers(
        &self,
        accessor: Whole,
        components: &[usize],
        kinds: &[ComponentType],
    ) -> Result<Numbers<'a>, FileError> {
        Numbers::of(self.document, accessor.0, components, kinds)
    }

    /// Adds a glTF primitive that has normals: all its vertices, and the triangles between these vertices.
    fn push_smooth(
        &mut self,
        vertices: &PrimitiveVertices<'_>,
        corners: &Corners<'_>,
        triangles: usize,
    ) -> Result<(), FileError> {
        let first = self.model.places.len() as u32;
        for vertex in 0..vertices.positions.count {
            self.push(vertices, vertex)?;
        }
        for triangle in 0..triangles {
            let corners = vertices.oriented(corners.triangle(self.document.source, vertices.part, triangle)?);
            if is_triangle(corners) {
                push_with_slow_growth(&mut self.model.triangles, corners.map(|corner| first + corner));
            }
        }
        Ok(())
    }

    /// Adds the triangles of a glTF primitive without normals, each with three new vertices. The format demands that
    /// these triangles are flat.
    fn push_flat(
        &mut self,
        vertices: &PrimitiveVertices<'_>,
        corners: &Corners<'_>,
        triangles: usize,
    ) -> Result<(), FileError> {
        for triangle in 0..triangles {
            let corners = vertices.oriented(corners.triangle(self.document.source, vertices.part, triangle)?);
            if !is_triangle(corners) {
                continue;
            }
            let first = self.model.places.len() as u32;
            for corner in corners {
                self.push(vertices, corner as usize)?;
            }
            push_with_slow_growth(&mut self.model.triangles, [first, first + 1, first + 2]);
        }
        Ok(())
    }

    fn push(&mut self, vertices: &PrimitiveVertices<'_>, vertex: usize) -> Result<(), FileError> {
        let place = vertices.place(vertex);
        if place.is_nan() || place.abs().max_element() > MAX_COORDINATE {
            let part = format!("{}.attributes.POSITION", vertices.part);
            let expected = format!("coordinates between -{MAX_COORDINATE:e} and {MAX_COORDINATE:e}");
            let found = format!("({}, {}, {}) at vertex {vertex}", place.x, place.y, place.z);
            return Err(self.document.source.part(part, expected, found));
        }
        let before = self.model.places.len();
        // A list stays empty until the first value that differs from its default.
        let normal = vertices.normal(vertex);
        if normal != glam::Vec3::ZERO || !self.model.normals.is_empty() {
            self.model.normals.resize(before, glam::Vec3::ZERO);
            push_with_slow_growth(&mut self.model.normals, normal);
        }
        let colour = vertices.colour(vertex);
        if colour != DEFAULT_COLOUR || !self.model.colours.is_empty() {
            self.model.colours.resize(before, DEFAULT_COLOUR);
            push_with_slow_growth(&mut self.model.colours, colour);
        }
        match &mut self.model.places {
            Places::Single(places) => push_with_slow_growth(places, place.as_vec3()),
            Places::Double(places) => push_with_slow_growth(places, place),
        }
        Ok(())
    }

    /// Returns the base colour of a primitive in linear light. `None` stands for [`DEFAULT_COLOUR`], the colour of a
    /// primitive without a material and without colours of its vertices.
    fn base_colour(
        &self,
        part: &str,
        material: Option<Whole>,
        has_colours: bool,
    ) -> Result<Option<[f64; 3]>, FileError> {
        let Some(Whole(number)) = material else {
            return Ok(has_colours.then_some([1.0; 3]));
        };
        let count = self.document.root.list("materials").len();
        if number >= count {
            let expected = format!("a material with the index {number}");
            return Err(self.document.source.part(format!("{part}.material"), expected, format!("{count} materials")));
        }
        let material: Value = self.document.object("materials", number)?;
        let Some(factor) = BASE_COLOURS.iter().find_map(|path| material.pointer(path)) else {
            return Ok(Some([1.0; 3]));
        };
        let factor = <[f64; 4]>::deserialize(factor).map_err(|error| {
            self.document.source.part(format!("materials[{number}]"), "a base colour of four numbers", error)
        });
        factor.map(|[red, green, blue, _]| Some([red, green, blue]))
    }

    fn finished(mut self) -> Model {
        let root = &self.document.root;
        let mut warn = |count: usize, noun: &str, what: &str| {
            if count > 0 {
                self.model.warnings.push(format!("{}: {what}", counted(count, noun)));
            }
        };
        warn(self.skipped, "primitive", "points and lines are not read");
        warn(
            root.list("textures").len(),
            "texture",
            "not read, so surfaces have the colours of materials and vertices",
        );
        warn(self.skinned, "skin", "not applied, so the mesh has the pose in which it was made");
        warn(root.list("animations").len(), "animation", "not read");
        warn(usize::from(self.has_targets), "mesh with morph targets", "the targets are not read");
        for name in self.extensions.iter().filter(|name| !is_harmless(name) && !COMPRESSION.contains(&name.as_str())) {
            let warning = format!("the extension {name} is not read: other programs may draw the model differently");
            self.model.warnings.push(warning);
        }
        self.model
    }
}

/// Number of bytes of a point with its normal and its colour.
const BYTES_OF_POINT: usize = 2 * size_of::<glam::Vec3>() + 3;

/// Returns the transform from a node to its parent.
fn transform(source: &Source<'_>, number: usize, node: &Node) -> Result<DMat4, FileError> {
    if let Some(matrix) = node.matrix {
        return Ok(DMat4::from_cols_array(&matrix));
    }
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from_array);
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from_array);
    let rotation = match node.rotation {
        None => DQuat::IDENTITY,
        Some(rotation) => {
            let quaternion = DQuat::from_array(rotation);
            if quaternion.length_squared() == 0.0 {
                let part = format!("nodes[{number}].rotation");
                return Err(source.part(part, "a quaternion of length 1", format!("{rotation:?}")));
            }
            quaternion.normalize()
        }
    };
    Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation))
}

/// Returns true if the three corners are different vertices. Triangle strips contain triangles with equal corners to
/// join separate parts.
fn is_triangle([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// The vertices of a glTF primitive (a part of a mesh), with the transform from its node to the world.
struct PrimitiveVertices<'a> {
    positions: Numbers<'a>,
    normals: Option<Numbers<'a>>,
    colours: Option<Numbers<'a>>,
    base: Option<[f64; 3]>,
    to_world: DMat4,
    part: &'a str,
}

impl PrimitiveVertices<'_> {
    fn place(&self, vertex: usize) -> DVec3 {
        self.to_world.transform_point3(DVec3::from_array(self.positions.vector(vertex)))
    }

    /// Returns the unit normal of a vertex in world coordinates, or zero for a vertex without a normal.
    ///
    /// Normals are transformed by the matrix of cofactors, which is the transposed inverse times the determinant. This
    /// matrix exists for every transform. The determinant's sign is removed, so that a mirrored normal points outwards.
    fn normal(&self, vertex: usize) -> glam::Vec3 {
        let Some(normals) = &self.normals else { return glam::Vec3::ZERO };
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_mat4(self.to_world);
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let sign = if self.is_mirrored() { -1.0 } else { 1.0 };
        direction(cofactors * DVec3::from_array(normals.vector(vertex)) * sign)
    }

    fn is_mirrored(&self) -> bool {
        DMat3::from_mat4(self.to_world).determinant() < 0.0
    }

    /// Returns the corners of a triangle in anticlockwise order. The corners are reversed if the transform mirrors.
    fn oriented(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.is_mirrored() { [a, c, b] } else { [a, b, c] }
    }

    fn colour(&self, vertex: usize) -> [u8; 3] {
        let Some(base) = self.base else { return DEFAULT_COLOUR };
        let factor = self.colours.as_ref().map_or([1.0; 3], |colours| colours.vector(vertex));
        std::array::from_fn(|part| encoded(base[part] * factor[part]))
    }
}

/// Returns a component of a colour in linear light as 8 bits of sRGB, by the transfer function of IEC 61966-2-1.
fn encoded(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let part = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 };
    (part * 255.0 + 0.5) as u8
}

/// The way in which the corners of a primitive make triangles.
#[derive(Clone, Copy)]
enum Mode {
    Triangles,
    TriangleStrip,
    TriangleFan,
}

/// The corners of the triangles of a glTF primitive (a part of a mesh).
struct Corners<'a> {
    /// Indices of the vertices at the corners. `None` if the corners are all vertices in their order.
    indices: Option<Numbers<'a>>,
    vertices: usize,
    mode: Mode,
}

impl Corners<'_> {
    fn count(&self) -> usize {
        self.indices.as_ref().map_or(self.vertices, |indices| indices.count)
    }

    /// Returns the number of triangles.
    ///
    /// # Errors
    ///
    /// Fails if the corners do not make whole triangles, or if there are more vertices than 32 bits can number.
    fn triangles(&self, source: &Source<'_>, part: &str) -> Result<usize, FileError> {
        let count = self.count();
        if u32::try_from(self.vertices).is_err() {
            let found = self.vertices.to_string();
            return Err(source.part(part, "at most 4294967295 vertices", found));
        }
        match self.mode {
            Mode::Triangles if count.is_multiple_of(3) => Ok(count / 3),
            Mode::Triangles => Err(source.part(part, "three corners for each triangle", format!("{count} corners"))),
            _ => Ok(count.saturating_sub(2)),
        }
    }

    fn triangle(&self, source: &Source<'_>, part: &str, n: usize) -> Result<[u32; 3], FileError> {
        // The corners have the order that section 3.7.2.1 of the specification defines.
        let corners = match self.mode {
            Mode::TriangleStrip => [n, n + 1 + n % 2, n + 2 - n % 2],
            Mode::TriangleFan => [n + 1, n + 2, 0],
            _ => [3 * n, 3 * n + 1, 3 * n + 2],
        };
        let mut vertices = [0; 3];
        for (vertex, corner) in vertices.iter_mut().zip(corners) {
            let index = self.indices.as_ref().map_or(corner, |indices| indices.number(corner, 0) as usize);
            if index >= self.vertices {
                let expected = format!("an index of one of {} vertices", self.vertices);
                return Err(source.part(format!("{part}.indices"), expected, index.to_string()));
            }
            *vertex = index as u32;
        }
        Ok(vertices)
    }
}
