//! The display list of a scene: vertices, triangles, spheres, and the structures that the host can move.

use pxpl5_sim::parameters::SettingError;
use std::ops::Range;

use glam::{DMat4, DVec3, Mat4, Vec3};

use crate::edit::{Edit, Hinge};
use crate::motion::HeadMotion;
use tracking::view::View;

/// A corner of one or more triangles, with position, normal and colour.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Vertex {
    /// Position in the coordinates of the vertex's structure, metres.
    pub position: Vec3,
    /// Unit normal that points outwards from the surface.
    pub normal: Vec3,
    /// Diffuse colour: red, green and blue, 8 bits each.
    pub colour: [u8; 3],
}

/// A sphere, which a renderer draws as one primitive.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Sphere {
    /// Position of the centre in the coordinates of the sphere's structure, metres.
    pub centre: Vec3,
    /// Radius of the sphere, metres, above zero.
    pub radius: f32,
    /// Diffuse colour: red, green and blue, 8 bits each.
    pub colour: [u8; 3],
}

/// The coordinate system to which a structure is fixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Frame {
    /// The room, through which the head moves.
    World,
    /// The head of the viewer. The structure always appears at the same position in the view.
    Head,
}

impl Frame {
    /// Returns the matrix from the coordinates of this frame to eye coordinates.
    pub const fn to_eye(self, view: &View) -> Mat4 {
        match self {
            Self::World => view.world_to_eye,
            Self::Head => view.head_to_eye,
        }
    }
}

/// A part of a scene with a name and one model matrix: successive triangles and spheres.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Structure {
    /// Name of the structure for display. No result depends on the name.
    pub name: String,
    /// Range of the structure's vertices in [`Scene::vertices`]. Only triangles of this structure use these vertices.
    pub vertices: Range<usize>,
    /// Range of the structure's triangles in [`Scene::triangles`].
    pub triangles: Range<usize>,
    /// Range of the structure's spheres in [`Scene::spheres`].
    pub spheres: Range<usize>,
    /// Coordinate system to which the structure is fixed: the room or the head.
    pub frame: Frame,
    /// Motion of the structure as a function of time, or `None` for a structure that does not move by itself.
    pub hinge: Option<Hinge>,
    /// True if triangles that face away from the eye are not drawn. The corners of such a triangle run clockwise, seen
    /// from the eye. Culling changes no picture of a surface without holes that is seen from outside.
    pub culls_back_faces: bool,
}

/// The lighting of a scene: one directional light and ambient light.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lighting {
    /// Unit vector towards the light, world coordinates.
    pub towards_light: Vec3,
    /// Fraction of a surface's colour that ambient light makes visible, 0 to 1.
    pub ambient: f32,
    /// Fraction of a surface's colour that the directional light adds at perpendicular incidence, 0 to 1.
    pub diffuse: f32,
    /// Colour of pixels that no primitive covers: red, green and blue.
    pub background: [u8; 3],
}

impl Lighting {
    /// Returns a light from above and behind the viewer's right shoulder. Its direction is (2, 3, 6) / 7. The direction
    /// is assumed, and any direction would be plausible.
    pub fn over_the_shoulder() -> Self {
        Self {
            towards_light: Vec3::new(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0),
            ambient: 0.3,
            diffuse: 0.7,
            background: [16, 24, 48],
        }
    }
}

/// The contents of a scene before [`Scene::new`] checks them.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SceneParts {
    /// Name of the scene, as it appears in reports.
    pub name: String,
    /// Vertices that the triangles share.
    pub vertices: Vec<Vertex>,
    /// Triangles, each as the indices of three vertices, anticlockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Spheres in the order of drawing, after the triangles.
    pub spheres: Vec<Sphere>,
    /// Structures of the scene. In order, they contain all vertices, triangles and spheres. An empty list stands for a
    /// single structure with everything.
    pub structures: Vec<Structure>,
    /// Lighting and background colour of the scene.
    pub lighting: Lighting,
    /// Motion of a head that looks at this scene.
    pub motion: HeadMotion,
    /// Corners of a closed path on which a head can walk through the scene, as eye positions in metres. The list is
    /// empty if the scene has no path.
    pub path: Vec<Vec3>,
}

/// A scene with checked contents: every index is in range, every number is finite, every normal has unit length, and
/// every radius is above zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    parts: SceneParts,
    warnings: Vec<String>,
}

impl Scene {
    /// Checks the contents in `parts` and creates a scene from these contents.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first part of the scene that breaks a rule.
    pub fn new(mut parts: SceneParts) -> Result<Self, SettingError> {
        if parts.structures.is_empty() {
            parts.structures.push(structure_of_all(&parts));
        }
        parts.check()?;
        Ok(Self { parts, warnings: Vec::new() })
    }

    /// Returns the same scene with these warnings about its file. They replace all earlier warnings.
    #[must_use]
    pub fn with_warnings(mut self, warnings: Vec<String>) -> Self {
        self.warnings = warnings;
        self
    }

    /// Returns warnings about the file from which the scene was read, one sentence each. The warnings concern content
    /// that may have been misinterpreted. The list is empty for a scene without a file.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Returns the name of the scene, as it appears in reports.
    pub fn name(&self) -> &str {
        &self.parts.name
    }

    /// Returns the vertices of all structures, one structure after the other.
    pub fn vertices(&self) -> &[Vertex] {
        &self.parts.vertices
    }

    /// Returns the number of triangles and spheres.
    pub fn primitives(&self) -> usize {
        self.parts.triangles.len() + self.parts.spheres.len()
    }

    /// Returns all triangles, each as three indices into [`Self::vertices`], anticlockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.parts.triangles
    }

    /// Returns the spheres of all structures, one structure after the other.
    pub fn spheres(&self) -> &[Sphere] {
        &self.parts.spheres
    }

    /// Returns the structures of the scene, at least one. Together, the structures contain all triangles and spheres,
    /// in the order of the lists of triangles and spheres.
    pub fn structures(&self) -> &[Structure] {
        &self.parts.structures
    }

    /// Returns the lighting and the background colour of the scene.
    pub fn lighting(&self) -> &Lighting {
        &self.parts.lighting
    }

    /// Returns the motion of a head that looks at this scene. The scene stays in view for any duration.
    pub fn motion(&self) -> &HeadMotion {
        &self.parts.motion
    }

    /// Returns the corners of a closed path on which a head can walk through the scene, as eye positions in metres. The
    /// list is empty if the scene has no path.
    pub fn path(&self) -> &[Vec3] {
        &self.parts.path
    }

    /// Returns the same scene with back-face culling in all structures. Culling is correct for surfaces without holes
    /// that are seen from outside. The inner side of an open surface becomes invisible.
    #[must_use]
    pub fn culled(mut self) -> Self {
        self.parts.structures.iter_mut().for_each(|structure| structure.culls_back_faces = true);
        self
    }

    /// Returns the scene turned about the vertical axis by `turn_deg` degrees, scaled and moved. The longest side of
    /// its bounding box then has `size_m` metres, and the middle of this box is at `at`. Whatever is `None` stays.
    #[must_use]
    pub fn placed(&self, at: [Option<f64>; 3], size_m: Option<f64>, turn_deg: f64) -> Self {
        let of_spheres = self.spheres().iter().map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius)));
        let points = self.vertices().iter().map(|vertex| (vertex.position.as_dvec3(), 0.0));
        let (low, high) = bounds(points.chain(of_spheres));
        let (middle, longest) = ((low + high) / 2.0, (high - low).max_element());
        let to = DVec3::new(at[0].unwrap_or(middle.x), at[1].unwrap_or(middle.y), at[2].unwrap_or(middle.z));
        // A scene of a single point has no size.
        let scale = size_m.filter(|_| longest > 0.0).map_or(1.0, |size| size / longest);
        let (sin, cos) = libm::sincos(turn_deg.to_radians());
        let turn =
            DMat4::from_cols_array(&[cos, 0.0, -sin, 0.0, 0.0, 1.0, 0.0, 0.0, sin, 0.0, cos, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let model = DMat4::from_translation(to)
            * turn
            * DMat4::from_scale(DVec3::splat(scale))
            * DMat4::from_translation(-middle);
        let edits = (0..self.structures().len()).map(|structure| Edit { structure, model: model.as_mat4() });
        self.posed(&edits.collect::<Vec<_>>())
    }

    /// Returns the scene together with the structures of `other`. Name, lighting and motion of the head stay.
    ///
    /// # Errors
    ///
    /// Fails if both together have more vertices than an index can count.
    pub fn together_with(self, other: &Self) -> Result<Self, SettingError> {
        let Self { mut parts, warnings } = self;
        let [vertices, triangles, spheres] = [parts.vertices.len(), parts.triangles.len(), parts.spheres.len()];
        let first = u32::try_from(vertices).unwrap_or(u32::MAX);
        parts.vertices.extend_from_slice(other.vertices());
        parts
            .triangles
            .extend(other.triangles().iter().map(|corners| corners.map(|corner| corner.saturating_add(first))));
        parts.spheres.extend_from_slice(other.spheres());
        let later = |range: &Range<usize>, by: usize| range.start + by..range.end + by;
        parts.structures.extend(other.structures().iter().map(|structure| Structure {
            vertices: later(&structure.vertices, vertices),
            triangles: later(&structure.triangles, triangles),
            spheres: later(&structure.spheres, spheres),
            ..structure.clone()
        }));
        Ok(Self::new(parts)?.with_warnings(warnings))
    }

    /// Returns the contents of the scene. After changes, [`Scene::new`] can make a scene from these contents again.
    pub fn into_parts(self) -> SceneParts {
        self.parts
    }

    /// Returns the changed model matrices of a frame that begins at simulated time `time_ps` (picoseconds). The list
    /// has one matrix for each structure with a motion of its own.
    pub fn edits_at(&self, time_ps: u64) -> Vec<Edit> {
        let structures = self.structures().iter().enumerate();
        structures
            .filter_map(|(structure, s)| {
                let model = s.hinge?.model(time_ps);
                Some(Edit { structure, model })
            })
            .collect()
    }

    /// Returns a copy of the scene whose positions and normals are transformed by the matrices in `edits`. Renderers
    /// without model matrices, such as a reference renderer, can draw the copy.
    ///
    /// The matrices may only rotate, move and scale uniformly. Matrices for structures that the scene does not have are
    /// ignored.
    pub fn posed(&self, edits: &[Edit]) -> Scene {
        let mut posed = self.clone();
        for edit in edits {
            if let Some(structure) = self.structures().get(edit.structure) {
                posed.parts.move_structure(structure, &edit.model);
            }
        }
        posed
    }

    /// Returns the centre of the scene's bounding box, and the distance from this centre to the farthest point, metres.
    pub fn bounding_sphere(&self) -> (Vec3, f32) {
        let points = self.vertices().iter().map(|v| (v.position.as_dvec3(), 0.0));
        let spheres = self.spheres().iter();
        let balls = spheres.map(|s| (s.centre.as_dvec3(), f64::from(s.radius)));
        let (centre, radius) = bounding_sphere(points.chain(balls));
        (centre.as_vec3(), radius as f32)
    }
}

/// Returns the centre of the bounding box around balls (centre, radius), and the distance from this centre to the
/// farthest point of a ball. Without balls the centre and the distance are zero.
pub(crate) fn bounding_sphere(balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> (DVec3, f64) {
    let (low, high) = bounds(balls.clone());
    if low.x > high.x {
        return (DVec3::ZERO, 0.0);
    }
    let middle = (low + high) / 2.0;
    let reaches = balls.map(|(centre, radius)| length(centre - middle) + radius);
    (middle, reaches.fold(0.0, f64::max))
}

/// Returns the lowest and the highest corner of the box around balls (centre, radius). Without balls, both are infinite.
fn bounds(balls: impl Iterator<Item = (DVec3, f64)>) -> (DVec3, DVec3) {
    let inverted = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    balls.fold(inverted, |(low, high), (centre, radius)| (low.min(centre - radius), high.max(centre + radius)))
}

/// Returns the length of a vector. The result is correct even if the square of the length exceeds the range of f64.
fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    if largest > 0.0 { (v / largest).length() * largest } else { 0.0 }
}

fn structure_of_all(parts: &SceneParts) -> Structure {
    Structure {
        name: parts.name.clone(),
        vertices: 0..parts.vertices.len(),
        triangles: 0..parts.triangles.len(),
        spheres: 0..parts.spheres.len(),
        frame: Frame::World,
        hinge: None,
        culls_back_faces: false,
    }
}

impl SceneParts {
    /// Creates the contents of a scene with one structure. The lighting is [`Lighting::over_the_shoulder`], and the head
    /// stands still at the origin and looks along -z.
    pub fn of(name: &str, vertices: Vec<Vertex>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            name: name.to_owned(),
            vertices,
            triangles,
            spheres: Vec::new(),
            structures: Vec::new(),
            lighting: Lighting::over_the_shoulder(),
            motion: HeadMotion::STILL,
            path: Vec::new(),
        }
    }

    fn move_structure(&mut self, structure: &Structure, model: &Mat4) {
        let model: DMat4 = model.as_dmat4();
        for vertex in &mut self.vertices[structure.vertices.clone()] {
            let normal = model.transform_vector3(vertex.normal.as_dvec3());
            vertex.position = model.transform_point3(vertex.position.as_dvec3()).as_vec3();
            vertex.normal = normal.normalize_or(DVec3::Y).as_vec3();
        }
        // The matrix scales uniformly, so the scale of one axis is also the scale of the radii.
        let scale = model.x_axis.truncate().length();
        for sphere in &mut self.spheres[structure.spheres.clone()] {
            sphere.centre = model.transform_point3(sphere.centre.as_dvec3()).as_vec3();
            sphere.radius = (f64::from(sphere.radius) * scale) as f32;
        }
    }

    fn check(&self) -> Result<(), SettingError> {
        self.check_structures()?;
        self.check_vertices()?;
        self.check_spheres()?;
        self.check_path()?;
        self.structures.iter().try_for_each(|s| self.check_triangles(s))
    }

    fn fault(&self, what: &'static str, index: usize, expected: impl ToString, found: impl ToString) -> SettingError {
        let part = format!("scene {}: {what} {index}", self.name);
        SettingError::scene(&part, expected.to_string(), found.to_string())
    }

    fn check_vertices(&self) -> Result<(), SettingError> {
        for (i, v) in self.vertices.iter().enumerate() {
            if !v.position.is_finite() {
                return Err(self.fault("vertex", i, "a finite position", v.position));
            }
            // f32 keeps a unit length to about 1e-7. The tolerance of 1e-3 accepts normals that other programs wrote
            // with few digits.
            let length = v.normal.length();
            if length.is_nan() || (length - 1.0).abs() > 1e-3 {
                return Err(self.fault("vertex", i, "a normal of length 1", length));
            }
        }
        Ok(())
    }

    fn check_spheres(&self) -> Result<(), SettingError> {
        for (i, s) in self.spheres.iter().enumerate() {
            if !(s.centre.is_finite() && s.radius.is_finite() && s.radius > 0.0) {
                let found = format!("{} and {}", s.centre, s.radius);
                let expected = "a finite centre and a radius above 0";
                return Err(self.fault("sphere", i, expected, found));
            }
        }
        Ok(())
    }

    fn check_path(&self) -> Result<(), SettingError> {
        match self.path.iter().position(|corner| !corner.is_finite()) {
            Some(i) => Err(self.fault("corner of the path", i, "a finite place", self.path[i])),
            None => Ok(()),
        }
    }

    fn check_structures(&self) -> Result<(), SettingError> {
        // Taken in order, the structures must divide each of the three lists without gaps.
        let mut ends = [0; 3];
        for (i, s) in self.structures.iter().enumerate() {
            for (range, end) in [&s.vertices, &s.triangles, &s.spheres].into_iter().zip(&mut ends) {
                if range.start != *end || range.end < range.start {
                    let expected = format!("a range from {end}");
                    return Err(self.fault("structure", i, expected, format!("{range:?}")));
                }
                *end = range.end;
            }
            self.check_hinge(i, s)?;
        }
        let expected = [self.vertices.len(), self.triangles.len(), self.spheres.len()];
        if ends != expected {
            let last = self.structures.len().saturating_sub(1);
            let expected = format!("ends at {expected:?} (vertices, triangles, spheres)");
            return Err(self.fault("structure", last, expected, format!("{ends:?}")));
        }
        Ok(())
    }

    fn check_hinge(&self, index: usize, structure: &Structure) -> Result<(), SettingError> {
        let Some(hinge) = structure.hinge else {
            return Ok(());
        };
        let axis = hinge.axis.length();
        let finite = hinge.point.is_finite() && hinge.amplitude_deg.is_finite();
        if finite && hinge.phase_turns.is_finite() && axis > 0.0 && axis.is_finite() && hinge.period_ps > 0 {
            return Ok(());
        }
        let expected = "a hinge of finite numbers, an axis and a period above 0";
        Err(self.fault("structure", index, expected, format!("{hinge:?}")))
    }

    fn check_triangles(&self, structure: &Structure) -> Result<(), SettingError> {
        for i in structure.triangles.clone() {
            for corner in self.triangles[i] {
                if !structure.vertices.contains(&(corner as usize)) {
                    let expected = format!("vertices from {:?}", structure.vertices);
                    return Err(self.fault("triangle", i, expected, corner));
                }
            }
        }
        Ok(())
    }
}
