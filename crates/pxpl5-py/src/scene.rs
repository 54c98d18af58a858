//! Scenes for Python: built-in scenes, model files and arrays.

use crate::arrays::{Count, reals2, wholes2};
use crate::errors::wrong_setting;
use crate::table::escaped;
use glam::Vec3;
use numpy::ndarray::{Array2, ArrayView1, ArrayView2};
use numpy::{PyArray2, PyReadonlyArray2};
use pxpl5::scene::{self, HeadMotion, Placement, SceneParts, Sphere, Vertex};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use std::path::PathBuf;
use std::sync::Arc;

/// An immutable scene: triangles and spheres in metres, with lighting and the motion of a viewer's head.
///
/// Axes are right-handed with y upwards. The default viewer looks along -z. Triangles are anticlockwise when seen from
/// outside.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Scene {
    pub(crate) scene: Arc<scene::Scene>,
}

impl Scene {
    pub(crate) fn of(scene: scene::Scene) -> Self {
        Self { scene: Arc::new(scene) }
    }
}

#[pymethods]
impl Scene {
    /// Returns a built-in scene, such as ``mig`` or ``full-screen:12``. :func:`pxpl5.builtin_scenes` lists all names.
    ///
    /// Raises :class:`pxpl5.SettingError` for an unknown name.
    #[staticmethod]
    fn builtin(py: Python<'_>, name: String) -> PyResult<Self> {
        py.detach(|| scene::builtin(&name)).map(Self::of).map_err(wrong_setting)
    }

    /// Loads a model file (PLY, OBJ, STL or PDB). The extension determines the format. The model is moved and scaled so
    /// that both eyes see the whole model. With ``fit=False``, the model keeps its coordinates, which are then in
    /// metres.
    ///
    /// Raises :class:`pxpl5.SettingError` with the file, the position in the file, and the expected and the found text.
    #[staticmethod]
    #[pyo3(signature = (path, *, fit = true))]
    fn load(py: Python<'_>, path: PathBuf, fit: bool) -> PyResult<Self> {
        let placement = if fit { Placement::Fitted } else { Placement::AsInFile };
        py.detach(|| scene::load_placed(path, placement)).map(Self::of).map_err(wrong_setting)
    }

    /// Creates a scene from arrays, which are copied. An array is anything that ``numpy.asarray`` takes, such as lists.
    ///
    /// - ``vertices``: shape (n, 3), metres; ``triangles``: shape (m, 3), indices of vertices from 0.
    /// - ``normals``: shape (n, 3), any length above 0; None for the mean of the adjacent triangles, weighted by area.
    /// - ``colours``: shape (n, 3), red, green and blue, 0 to 255; None for a light grey.
    /// - ``spheres``: shape (k, 4), centre and radius, metres; ``sphere_colours``: shape (k, 3), 0 to 255.
    /// - ``fit``: if true, the scene is moved and scaled like a model file. Otherwise the viewer stands where the whole
    ///   scene is visible.
    ///
    /// Raises :class:`pxpl5.SettingError` with the first invalid vertex, triangle or sphere.
    #[staticmethod]
    #[pyo3(signature = (vertices, triangles, *, normals = None, colours = None, spheres = None, sphere_colours = None,
                        fit = true, name = "arrays"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn from_arrays(
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
        colours: Option<&Bound<'_, PyAny>>,
        spheres: Option<&Bound<'_, PyAny>>,
        sphere_colours: Option<&Bound<'_, PyAny>>,
        fit: bool,
        name: &str,
    ) -> PyResult<Self> {
        let vertices = reals2("vertices", vertices, 3)?;
        let triangles = wholes2("triangles", triangles, 3)?;
        let normals = normals.map(|normals| reals2("normals", normals, 3)).transpose()?;
        let colours = colours.map(|colours| wholes2("colours", colours, 3)).transpose()?;
        let spheres = spheres.map(|spheres| reals2("spheres", spheres, 4)).transpose()?;
        let sphere_colours = sphere_colours.map(|colours| wholes2("sphere_colours", colours, 3)).transpose()?;
        let mut positions = points(vertices.as_array());
        let triangles = indices(triangles.as_array(), positions.len())?;
        let spheres = spheres.as_ref().map(PyReadonlyArray2::as_array);
        let mut balls: Vec<(Vec3, f32)> = spheres.iter().flat_map(|spheres| spheres.rows()).map(ball).collect();
        if fit {
            fit_into_view(&mut positions, &mut balls);
        }
        // Compute missing normals, and fill in missing colours.
        let normals = match &normals {
            Some(normals) => lengthened(points(normals.as_array()))?,
            None => mean_normals(&positions, &triangles),
        };
        let colours = rgb("colours", colours.as_ref().map(PyReadonlyArray2::as_array), positions.len())?;
        let of_spheres = rgb("sphere_colours", sphere_colours.as_ref().map(PyReadonlyArray2::as_array), balls.len())?;
        same_length("normals", normals.len(), positions.len())?;
        let corners = positions.iter().zip(&normals).zip(&colours);
        let vertices: Vec<Vertex> = corners
            .map(|((position, normal), colour)| Vertex { position: *position, normal: *normal, colour: *colour })
            .collect();
        let spheres: Vec<Sphere> = balls
            .iter()
            .zip(&of_spheres)
            .map(|((centre, radius), colour)| Sphere { centre: *centre, radius: *radius, colour: *colour })
            .collect();
        // The default viewer sees the whole scene.
        let (centre, radius) = ball_around(&positions, &balls);
        let motion = HeadMotion::always_visible(centre, f64::from(radius.max(f32::MIN_POSITIVE)));
        let parts = SceneParts { spheres, motion, ..SceneParts::of(name, vertices, triangles) };
        scene::Scene::new(parts).map(Self::of).map_err(wrong_setting)
    }

    /// Returns the name of the scene, as it appears in reports.
    #[getter]
    fn name(&self) -> &str {
        self.scene.name()
    }

    /// Returns a copy of the positions of the vertices in metres, as an array of shape (n, 3), float32.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        table(py, self.scene.vertices().iter().map(|vertex| vertex.position.to_array()))
    }

    /// Returns a copy of the normals of the vertices, which have unit length, as an array of shape (n, 3), float32.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        table(py, self.scene.vertices().iter().map(|vertex| vertex.normal.to_array()))
    }

    /// Returns a copy of the colours of the vertices (red, green and blue) as an array of shape (n, 3), uint8.
    #[getter]
    fn colours<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u8>> {
        table(py, self.scene.vertices().iter().map(|vertex| vertex.colour))
    }

    /// Returns a copy of the triangles as indices of vertices, in an array of shape (m, 3), uint32.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        table(py, self.scene.triangles().iter().copied())
    }

    /// Returns a copy of the spheres (centre and radius in metres) as an array of shape (k, 4), float32.
    #[getter]
    fn spheres<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f32>> {
        table(py, self.scene.spheres().iter().map(|s| [s.centre.x, s.centre.y, s.centre.z, s.radius]))
    }

    /// Returns a simplified scene with at most ``primitives`` triangles and spheres, 1 or more. The shape of the scene
    /// stays similar.
    ///
    /// Raises :class:`pxpl5.SettingError` if the scene has fewer than ``primitives`` primitives.
    fn decimated(&self, py: Python<'_>, primitives: Count) -> PyResult<Self> {
        py.detach(|| self.scene.decimated(primitives.size())).map(Self::of).map_err(wrong_setting)
    }

    /// Returns the scene with back-face culling: triangles that face away from the eye are not drawn. The picture of a
    /// scene of closed surfaces does not change.
    fn culled(&self) -> Self {
        Self::of(scene::Scene::clone(&self.scene).culled())
    }

    /// Returns a table of the scene's size and the numbers of its primitives, for notebooks.
    fn _repr_html_(&self) -> String {
        let scene = &self.scene;
        let (centre, radius) = scene.bounding_sphere();
        let rows = [
            ("triangles", scene.triangles().len().to_string()),
            ("spheres", scene.spheres().len().to_string()),
            ("vertices", scene.vertices().len().to_string()),
            ("structures", scene.structures().len().to_string()),
            ("centre", format!("{:.3}, {:.3}, {:.3} m", centre.x, centre.y, centre.z)),
            ("radius", format!("{radius:.3} m")),
        ];
        let rows: String =
            rows.iter().map(|(name, value)| format!("<tr><td>{name}</td><td>{value}</td></tr>")).collect();
        format!("<table><caption>{}</caption><tbody>{rows}</tbody></table>", escaped(scene.name()))
    }

    /// Returns the function and the arguments that make an equal scene, for the module ``pickle``.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let text = serde_json::to_vec(&scene::Scene::clone(&self.scene).into_parts()).map_err(wrong_setting)?;
        let state = (PyBytes::new(py, &text), self.scene.warnings().to_vec());
        Ok((py.import("pxpl5._pickle")?.getattr("scene")?, state.into_pyobject(py)?))
    }

    /// Returns a text that states the name of the scene and its numbers of triangles and spheres.
    fn __repr__(&self) -> String {
        let scene = &self.scene;
        format!(
            "<pxpl5.Scene {}: {} triangles, {} spheres>",
            scene.name(),
            scene.triangles().len(),
            scene.spheres().len()
        )
    }
}

/// Returns a NumPy array of shape (rows, N) from rows of N values each.
fn table<'py, T: numpy::Element + Copy + Default, const N: usize>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [T; N]>,
) -> Bound<'py, PyArray2<T>> {
    let count = rows.len();
    let values: Vec<T> = rows.flatten().collect();
    let array = Array2::from_shape_vec((count, N), values).unwrap_or_default();
    PyArray2::from_owned_array(py, array)
}

fn same_length(name: &str, found: usize, expected: usize) -> PyResult<()> {
    if found == expected {
        return Ok(());
    }
    Err(wrong_setting(format!("{name}: expected {expected} rows, one for each, found {found}")))
}

fn points(array: ArrayView2<'_, f64>) -> Vec<Vec3> {
    array.rows().into_iter().map(|row| Vec3::new(row[0] as f32, row[1] as f32, row[2] as f32)).collect()
}

fn indices(array: ArrayView2<'_, i64>, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    // An index that is negative or has no vertex is an error.
    let corner = |number: usize, found: i64| {
        let index = u32::try_from(found).ok().filter(|index| (*index as usize) < vertices);
        index.ok_or_else(|| {
            let expected = format!("an index of one of {vertices} vertices");
            wrong_setting(format!("triangle {number}: expected {expected}, found {found}"))
        })
    };
    let rows = array.rows().into_iter().enumerate();
    rows.map(|(n, row)| Ok([corner(n, row[0])?, corner(n, row[1])?, corner(n, row[2])?])).collect()
}

/// Converts a row of x, y, z and radius to a sphere.
fn ball(row: ArrayView1<'_, f64>) -> (Vec3, f32) {
    (Vec3::new(row[0] as f32, row[1] as f32, row[2] as f32), row[3] as f32)
}

/// Default colour of surfaces: light grey.
const GREY: [u8; 3] = [200, 200, 200];

fn rgb(name: &str, array: Option<ArrayView2<'_, i64>>, expected: usize) -> PyResult<Vec<[u8; 3]>> {
    let Some(array) = array else { return Ok(vec![GREY; expected]) };
    same_length(name, array.nrows(), expected)?;
    let part = |number: usize, found: i64| {
        u8::try_from(found)
            .map_err(|_| wrong_setting(format!("{name}, row {number}: expected 0 to 255, found {found}")))
    };
    let rows = array.rows().into_iter().enumerate();
    rows.map(|(n, row)| Ok([part(n, row[0])?, part(n, row[1])?, part(n, row[2])?])).collect()
}

/// Scales normals to unit length, or raises an exception for a normal without direction.
fn lengthened(normals: Vec<Vec3>) -> PyResult<Vec<Vec3>> {
    let unit = normals.iter().enumerate().map(|(number, normal)| {
        let found = normal.try_normalize();
        found.ok_or_else(|| wrong_setting(format!("normal {number}: expected a length above 0, found {normal}")))
    });
    unit.collect()
}

/// Returns a normal for each vertex: the mean of the normals of adjacent triangles, weighted by area, as for model
/// files. A vertex without a triangle has an upward normal.
fn mean_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let twice_area = (b - a).cross(c - a);
        corners.iter().for_each(|corner| sums[*corner as usize] += twice_area);
    }
    sums.into_iter().map(|sum| sum.normalize_or(Vec3::Y)).collect()
}

/// Returns the centre of the bounding box, and the largest distance of a point of the scene from this centre. Both are
/// 0 for an empty scene.
fn ball_around(positions: &[Vec3], balls: &[(Vec3, f32)]) -> (Vec3, f32) {
    let all = positions.iter().map(|position| (*position, 0.0)).chain(balls.iter().copied());
    let low = all.clone().fold(Vec3::INFINITY, |low, (centre, radius)| low.min(centre - radius));
    let high = all.clone().fold(Vec3::NEG_INFINITY, |high, (centre, radius)| high.max(centre + radius));
    if low.cmpgt(high).any() {
        return (Vec3::ZERO, 0.0);
    }
    let middle = (low + high) / 2.0;
    (middle, all.map(|(centre, radius)| centre.distance(middle) + radius).fold(0.0, f32::max))
}

/// Moves the centre of the scene to the origin, and scales the scene to the radius of scaled model files.
fn fit_into_view(positions: &mut [Vec3], balls: &mut [(Vec3, f32)]) {
    let (middle, radius) = ball_around(positions, balls);
    if radius <= 0.0 || !radius.is_finite() {
        return;
    }
    let scale = scene::config::IMPORT_RADIUS_M as f32 / radius;
    positions.iter_mut().for_each(|position| *position = (*position - middle) * scale);
    for (centre, radius) in balls {
        *centre = (*centre - middle) * scale;
        *radius *= scale;
    }
}

/// Rebuilds a scene from the JSON text that `Scene.__reduce__` returned, for the module `pickle`.
///
/// Raises :class:`pxpl5.SettingError` for text that does not describe a valid scene.
#[pyfunction]
pub(crate) fn scene_of_json(text: &[u8], warnings: Vec<String>) -> PyResult<Scene> {
    let parts: SceneParts = serde_json::from_slice(text).map_err(wrong_setting)?;
    Ok(Scene::of(scene::Scene::new(parts).map_err(wrong_setting)?.with_warnings(warnings)))
}
