//! Scenes as the slices of a spinning volumetric display.

use crate::attended::attended;
use crate::catalogue::python;
use crate::errors::wrong_setting;
use crate::picture::Picture;
use crate::scene::Scene;
use numpy::PyArray3;
use numpy::ndarray::Array3;
use pxpl5::volume::pictures::{Look, coloured, halftoned, sheet};
use pxpl5::volume::spatialgl::Threads;
use pxpl5::volume::{Volume as Native, VolumeSettings, figures};
use pyo3::prelude::*;
use std::sync::Arc;

/// A volume that has been drawn: the slices of one turn of a spinning screen.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Volume {
    volume: Arc<Native>,
}

/// Paths of everything that decides what a volume is, in order.
#[pyfunction]
pub(crate) fn volume_keys() -> Vec<String> {
    VolumeSettings::paper().keys()
}

/// The figures of the SpatialGL paper beside the model's: a dictionary with figures and shown.
///
/// Raises :class:`pxpl5.SettingError` for a scene that cannot be drawn.
#[pyfunction]
#[pyo3(signature = (scenes, progress = None))]
pub(crate) fn volume_figures<'py>(
    py: Python<'py>,
    scenes: Vec<PyRef<'py, Scene>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let scenes: Vec<_> = scenes.iter().map(|scene| Arc::clone(&scene.scene)).collect();
    let all = attended(py, progress, false, move |told| {
        figures::all(&scenes, &Threads::all(), |done, of| told.tell(done, of)).map_err(|error| error.to_string())
    })?;
    python(py, &all.map_err(wrong_setting)?)
}

#[pymethods]
impl Volume {
    /// Draws a scene with settings ``PATH=VALUE``; what is not set is as in the paper. See :func:`pxpl5.volume_keys`.
    ///
    /// Raises :class:`pxpl5.SettingError` with the path, what was expected and what was found.
    #[staticmethod]
    fn draw(py: Python<'_>, scene: &Scene, assignments: Vec<String>) -> PyResult<Self> {
        let mut settings = VolumeSettings::paper();
        for assignment in &assignments {
            settings.assign(assignment, "Volume").map_err(wrong_setting)?;
        }
        let scene = Arc::clone(&scene.scene);
        let drawn = attended(py, None, false, move |_| {
            Native::draw(&settings, &scene, &Threads::all()).map_err(|error| error.to_string())
        })?;
        Ok(Self { volume: Arc::new(drawn.map_err(wrong_setting)?) })
    }

    /// Everything as numbers: counts, occupancy, times of the model, and the hash of the volume.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &py.detach(|| self.volume.report()))
    }

    /// How many slices a turn has.
    #[getter]
    fn slices(&self) -> u32 {
        self.volume.frame.planes.slices()
    }

    /// The pixels of a slice that are lit, by colour: shape (height, width, 3), uint8, 0 or 1 of red, green and blue. A copy.
    ///
    /// Raises :class:`pxpl5.SettingError` for a slice that there is not.
    fn bits<'py>(&self, py: Python<'py>, slice: u32) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let slice = self.volume.check_slice(slice).map_err(wrong_setting)?;
        let planes = &self.volume.frame.planes;
        let [width, height] = planes.size();
        let bits = py.detach(|| {
            Array3::from_shape_fn((height as usize, width as usize, 3), |(y, x, colour)| {
                planes.pixel(slice, x as u32, y as u32) >> colour & 1
            })
        });
        Ok(PyArray3::from_owned_array(py, bits))
    }

    /// A slice as a picture: after halftoning, or, undithered, in its colours before.
    ///
    /// Raises :class:`pxpl5.SettingError` for a slice that there is not.
    #[pyo3(signature = (number, *, undithered = false))]
    fn slice(&self, py: Python<'_>, number: u32, undithered: bool) -> PyResult<Picture> {
        let number = self.volume.check_slice(number).map_err(wrong_setting)?;
        let volume = &self.volume;
        let picture = py.detach(|| if undithered { coloured(volume, number) } else { halftoned(volume, number) });
        Picture::of(py, picture, Vec::new())
    }

    /// All slices as thumbnails, row by row.
    fn sheet(&self, py: Python<'_>) -> PyResult<Picture> {
        let picture = py.detach(|| sheet(&self.volume));
        Picture::of(py, picture, Vec::new())
    }

    /// What an eye sees of one turn, four radii away: azimuth from +z to +x and elevation in degrees, ``size`` pixels wide and high.
    ///
    /// Raises :class:`pxpl5.SettingError` for an eye that sees nothing.
    #[pyo3(signature = (azimuth_deg = 40.0, elevation_deg = 25.0, *, size = 512))]
    fn view(&self, py: Python<'_>, azimuth_deg: f64, elevation_deg: f64, size: u32) -> PyResult<Picture> {
        if !(1..=8192).contains(&size) {
            return Err(wrong_setting(format!("size: expected 1 to 8192 pixels, found {size}")));
        }
        let look = Look::around(&self.volume.settings, azimuth_deg, elevation_deg, size);
        let picture =
            py.detach(|| look.picture(&self.volume, None, &Threads::all()).map_err(|error| error.to_string()));
        Picture::of(py, picture.map_err(wrong_setting)?, Vec::new())
    }

    /// For notebooks: what an eye sees.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyBytes>> {
        self.view(py, 40.0, 25.0, 384)?.png(py)
    }

    /// What it shows, and how many slices it has.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Volume of {}: {} slices>", self.volume.scene, self.slices())
    }
}
