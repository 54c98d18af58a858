//! Pictures for Python: pixels for NumPy, and PNG for notebooks and files.

use crate::errors::wrong_setting;
use image::RgbImage;
use numpy::ndarray::Array3;
use numpy::{PyArray3, PyArrayMethods, PyReadonlyArray3};
use pxpl5::views::png_bytes;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// A picture with 8 bits each of red, green and blue for every pixel.
///
/// ``numpy.asarray(picture)`` and :attr:`array` give the pixels without a copy. A notebook displays the picture.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Picture {
    pixels: Py<PyArray3<u8>>,
    /// Texts that are stored in a PNG file of the picture, as pairs of keyword and text.
    texts: Vec<(&'static str, String)>,
}

impl Picture {
    /// Creates a picture from an image without copying its pixels.
    pub(crate) fn of(py: Python<'_>, picture: RgbImage, texts: Vec<(&'static str, String)>) -> PyResult<Self> {
        let shape = (picture.height() as usize, picture.width() as usize, 3);
        let pixels = Array3::from_shape_vec(shape, picture.into_raw()).map_err(wrong_setting)?;
        Ok(Self { pixels: PyArray3::from_owned_array(py, pixels).unbind(), texts })
    }

    /// Returns a copy of the picture's pixels.
    fn copied(&self, py: Python<'_>) -> PyResult<RgbImage> {
        let pixels = self.pixels.bind(py);
        let height = pixels.dims()[0];
        let width = pixels.dims()[1];
        let bytes = pixels.to_vec().map_err(wrong_setting)?;
        let picture = RgbImage::from_raw(width as u32, height as u32, bytes);
        picture.ok_or_else(|| wrong_setting("a picture has three bytes a pixel"))
    }
}

#[pymethods]
impl Picture {
    /// Creates a picture from an array of shape (height, width, 3), uint8. The pixels are copied.
    #[new]
    fn new(py: Python<'_>, pixels: PyReadonlyArray3<'_, u8>) -> PyResult<Self> {
        let pixels = pixels.as_array();
        if pixels.dim().2 != 3 || pixels.is_empty() {
            let found = pixels.dim();
            return Err(wrong_setting(format!("pixels: expected shape (height, width, 3), found {found:?}")));
        }
        Ok(Self { pixels: PyArray3::from_array(py, &pixels).unbind(), texts: Vec::new() })
    }

    /// Returns the pixels as an array of shape (height, width, 3), uint8, with rows from the top. The array shares the
    /// picture's memory.
    #[getter]
    fn array<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<u8>> {
        self.pixels.bind(py).clone()
    }

    /// Returns the pixels for ``numpy.asarray``. They are copied only if another element type is requested or ``copy``
    /// is true.
    #[pyo3(signature = (dtype = None, copy = None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let own = self.pixels.bind(py).clone().into_any();
        match (dtype, copy) {
            (Some(dtype), _) => own.call_method1("astype", (dtype,)),
            (None, Some(true)) => own.call_method0("copy"),
            (None, _) => Ok(own),
        }
    }

    /// Returns the picture as PNG data. The PNG texts state the origin of the picture.
    ///
    /// Raises :class:`pxpl5.SettingError` if the picture cannot be encoded.
    pub(crate) fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let picture = self.copied(py)?;
        let bytes = py.detach(|| png_bytes(&picture, &self.texts)).map_err(wrong_setting)?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Returns the picture as PNG, for notebooks.
    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        self.png(py)
    }

    /// Writes the picture as a PNG file.
    ///
    /// Raises OSError if the file cannot be written.
    fn save(&self, py: Python<'_>, path: std::path::PathBuf) -> PyResult<()> {
        let bytes = self.png(py)?;
        Ok(std::fs::write(path, bytes.as_bytes())?)
    }

    /// Returns a text that states the size of the picture in pixels.
    fn __repr__(&self, py: Python<'_>) -> String {
        let dims = self.pixels.bind(py).dims();
        format!("<pxpl5.Picture of {} x {} pixels>", dims[1], dims[0])
    }
}
