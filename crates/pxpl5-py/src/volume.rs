//! Scenes drawn as slices for a spinning volumetric display.

use crate::arrays::Count;
use crate::background::study;
use crate::catalogue::python;
use crate::errors::wrong_setting;
use crate::picture::Picture;
use crate::scene::Scene;
use numpy::PyArray3;
use numpy::ndarray::Array3;
use pxpl5::PathSettings;
use pxpl5::lab::volumes::{VolumeFigureQuery, VolumeQuery};
use pxpl5::volume::pictures::{EyeView, coloured, halftoned, sheet};
use pxpl5::volume::spatialgl::Threads;
use pxpl5::volume::{Volume as Native, VolumeSettings};
use pyo3::prelude::*;
use std::sync::Arc;

/// A scene drawn for a spinning volumetric display, as the slices of one turn of its screen.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Volume {
    volume: Arc<Native>,
}

/// Returns the paths of all settings of the volumetric display, in order.
#[pyfunction]
pub(crate) fn volume_keys() -> Vec<String> {
    VolumeSettings::paper().keys()
}

/// Compares the published values of the SpatialGL paper with the values of the model. Returns a dictionary. ``figures``
/// has a row for each value, and ``shown`` has the paper's statements without numbers and the measurements that test
/// them.
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
    python(py, &study(py, progress, VolumeFigureQuery { scenes })?.map_err(wrong_setting)?)
}

#[pymethods]
impl Volume {
    /// Draws a scene for the volumetric display. ``assignments`` are settings ``PATH=VALUE``. All other settings have
    /// the values of the SpatialGL paper. :func:`pxpl5.volume_keys` lists the paths.
    ///
    /// Raises :class:`pxpl5.SettingError` with the path, and the expected and the found text.
    #[staticmethod]
    fn draw(py: Python<'_>, scene: &Scene, assignments: Vec<String>) -> PyResult<Self> {
        let mut settings = VolumeSettings::paper();
        for assignment in &assignments {
            settings.assign(assignment, "Volume").map_err(wrong_setting)?;
        }
        let query = VolumeQuery { settings, scene: Arc::clone(&scene.scene), threads: Threads::all() };
        let drawn = study(py, None, query)?;
        Ok(Self { volume: Arc::new(drawn.map_err(wrong_setting)?) })
    }

    /// Returns the report of the drawing as a dictionary: counts, occupancy, times of the modelled display, and the
    /// hash of the volume.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &py.detach(|| self.volume.report()))
    }

    /// Returns the number of slices in one turn of the display.
    #[getter]
    fn slices(&self) -> u32 {
        self.volume.frame.planes.slices()
    }

    /// Returns a copy of the bits of a slice as an array of shape (height, width, 3), uint8. The values for red, green
    /// and blue are 0 or 1.
    ///
    /// Raises :class:`pxpl5.SettingError` for a slice that does not exist.
    fn bits<'py>(&self, py: Python<'py>, slice: Count) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let slice = self.volume.check_slice(slice.small()).map_err(wrong_setting)?;
        let planes = &self.volume.frame.planes;
        let [width, height] = planes.size();
        let bits = py.detach(|| {
            Array3::from_shape_fn((height as usize, width as usize, 3), |(y, x, colour)| {
                planes.pixel(slice, x as u32, y as u32) >> colour & 1
            })
        });
        Ok(PyArray3::from_owned_array(py, bits))
    }

    /// Returns the slice with index ``number`` as a picture after halftoning. If ``undithered`` is true, the picture
    /// has the colours before halftoning.
    ///
    /// Raises :class:`pxpl5.SettingError` for a slice that does not exist.
    #[pyo3(signature = (number, *, undithered = false))]
    fn slice(&self, py: Python<'_>, number: Count, undithered: bool) -> PyResult<Picture> {
        let number = self.volume.check_slice(number.small()).map_err(wrong_setting)?;
        let volume = &self.volume;
        let picture = py.detach(|| if undithered { coloured(volume, number) } else { halftoned(volume, number) });
        Picture::of(py, picture, Vec::new())
    }

    /// Returns one picture with small versions of all slices, arranged in rows.
    fn sheet(&self, py: Python<'_>) -> PyResult<Picture> {
        let picture = py.detach(|| sheet(&self.volume));
        Picture::of(py, picture, Vec::new())
    }

    /// Returns the view of an eye during one turn of the display, from a distance of four radii of the display. The
    /// azimuth grows from +z to +x. Azimuth and elevation are in degrees, and the picture is ``size`` pixels wide and
    /// high.
    ///
    /// Raises :class:`pxpl5.SettingError` if the eye can see nothing of the display.
    #[pyo3(signature = (azimuth_deg = 40.0, elevation_deg = 25.0, *, size = Count(512)), text_signature = "($self, azimuth_deg=40.0, elevation_deg=25.0, *, size=512)")]
    fn view(&self, py: Python<'_>, azimuth_deg: f64, elevation_deg: f64, size: Count) -> PyResult<Picture> {
        let size = size.small();
        if !(1..=8192).contains(&size) {
            return Err(wrong_setting(format!("size: expected 1 to 8192 pixels, found {size}")));
        }
        let view = EyeView::around(&self.volume.settings, azimuth_deg, elevation_deg, size);
        let picture =
            py.detach(|| view.picture(&self.volume, None, &Threads::all()).map_err(|error| error.to_string()));
        Picture::of(py, picture.map_err(wrong_setting)?, Vec::new())
    }

    /// Returns a view of the volume as PNG data, for notebooks.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyBytes>> {
        self.view(py, 40.0, 25.0, Count(384))?.png(py)
    }

    /// Returns a text that states the scene and the number of slices.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Volume of {}: {} slices>", self.volume.scene, self.slices())
    }
}
