//! Pictures for Python: pixels for NumPy, and PNG for notebooks and files.

use crate::errors::wrong_setting;
use image::RgbImage;
use numpy::ndarray::Array3;
use numpy::{PyArray3, PyArrayMethods, PyReadonlyArray3};
use pxpl5::views::png_bytes;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

/// A picture with 8 bits each of red, green and blue for every pixel.
///
/// ``numpy.asarray(picture)`` and :attr:`array` give the pixels without a copy. A notebook displays the picture.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Picture {
    pixels: Py<PyArray3<u8>>,
    /// Texts that are stored in a PNG file of the picture, as pairs of keyword and text.
    texts: Vec<(String, String)>,
}

impl Picture {
    /// Creates a picture from an image without copying its pixels.
    pub(crate) fn of(py: Python<'_>, picture: RgbImage, texts: Vec<(&'static str, String)>) -> PyResult<Self> {
        let texts = texts.into_iter().map(|(key, text)| (key.to_owned(), text)).collect();
        let shape = (picture.height() as usize, picture.width() as usize, 3);
        let pixels = Array3::from_shape_vec(shape, picture.into_raw()).map_err(wrong_setting)?;
        Ok(Self { pixels: PyArray3::from_owned_array(py, pixels).unbind(), texts })
    }

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
    /// Creates a picture from an array of shape (height, width, 3) with values 0 to 255. An array is anything that
    /// ``numpy.asarray`` takes. The pixels are copied.
    ///
    /// Raises :class:`pxpl5.SettingError` with the expected and the found shape or type.
    #[new]
    fn new(py: Python<'_>, pixels: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mut array = py.import("numpy")?.call_method1("asarray", (pixels,)).map_err(wrong_setting)?;
        // Integers of another type are taken if all integers fit. A cast alone would change integers that do not fit.
        let bytes = array.call_method1("astype", ("uint8",));
        if let Ok(bytes) = bytes
            && matches!(array.getattr("dtype")?.getattr("kind")?.extract()?, 'i' | 'u')
            && py.import("numpy")?.call_method1("array_equal", (&bytes, &array))?.is_truthy()?
        {
            array = bytes;
        }
        let Ok(pixels) = array.extract::<PyReadonlyArray3<'_, u8>>() else {
            let (shape, element) = (array.getattr("shape")?, array.getattr("dtype")?);
            return Err(wrong_setting(format!(
                "pixels: expected shape (height, width, 3) with integers from 0 to 255, found {shape} of type {element}"
            )));
        };
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

    /// Returns the pixels for ``numpy.asarray``. The pixels are copied only if another element type is requested or
    /// ``copy`` is true.
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
        let texts: Vec<(&str, String)> = self.texts.iter().map(|(key, text)| (key.as_str(), text.clone())).collect();
        let bytes = py.detach(|| png_bytes(&picture, &texts)).map_err(wrong_setting)?;
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

    /// Returns the function and the arguments that make an equal picture, for the module ``pickle``.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let state = (self.pixels.bind(py), self.texts.clone()).into_pyobject(py)?;
        Ok((py.import("pxpl5._pickle")?.getattr("picture")?, state))
    }

    /// Returns a text that states the size of the picture in pixels.
    fn __repr__(&self, py: Python<'_>) -> String {
        let dims = self.pixels.bind(py).dims();
        format!("<pxpl5.Picture of {} x {} pixels>", dims[1], dims[0])
    }
}

/// Rebuilds a picture from the parts that `Picture.__reduce__` returned, for the module `pickle`.
///
/// Raises :class:`pxpl5.SettingError` in the same cases as :class:`pxpl5.Picture`.
#[pyfunction]
pub(crate) fn picture_of_parts(
    py: Python<'_>,
    pixels: &Bound<'_, PyAny>,
    texts: Vec<(String, String)>,
) -> PyResult<Picture> {
    Ok(Picture { texts, ..Picture::new(py, pixels)? })
}

/// Decodes the bytes of a PNG file and returns the picture. Text chunks of the file are ignored.
///
/// Raises :class:`pxpl5.SettingError` for bytes that are not a PNG file.
#[pyfunction]
pub(crate) fn picture_of_png(py: Python<'_>, bytes: &[u8]) -> PyResult<Picture> {
    let picture = py.detach(|| image::load_from_memory_with_format(bytes, image::ImageFormat::Png));
    Picture::of(py, picture.map_err(wrong_setting)?.into_rgb8(), Vec::new())
}
