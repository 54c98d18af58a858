//! All pictures of a run, one for each display period, as an iterator.

use crate::background::{Progress, recv, spawn};
use crate::errors::{failed_run, wrong_setting};
use crate::picture::Picture;
use crate::policy::PythonFunctions;
use crate::stepper::wait;
use image::RgbImage;
use pxpl5::ExperimentError;
use pxpl5::views::{Film, PictureError};
use pyo3::prelude::*;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Maximum number of computed pictures that wait for Python.
const WAITING: usize = 4;

/// An iterator over the pictures of a run, one for each display period. A separate thread runs the experiment.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Frames {
    pictures: Mutex<Option<Receiver<Result<RgbImage, PictureError>>>>,
    progress: Arc<Progress>,
    checks: PythonFunctions,
}

impl Frames {
    /// Starts a thread that runs the experiment of a film and sends the pictures to this iterator.
    pub(crate) fn start(film: Film, progress: Arc<Progress>, checks: PythonFunctions) -> PyResult<Self> {
        let (sender, pictures) = sync_channel(WAITING);
        spawn("pxpl5-frames", move || {
            // The run ends when the receiver of the pictures no longer exists.
            let result = film.each(|_, picture| sender.send(Ok(picture)).is_ok());
            if let Err(error) = result {
                let _ = sender.send(Err(error));
            }
        })?;
        Ok(Self { pictures: Mutex::new(Some(pictures)), progress, checks })
    }
}

#[pymethods]
impl Frames {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    /// Returns the next picture, or ends the iteration.
    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Picture>> {
        let Some(pictures) = self.pictures.lock().unwrap_or_else(PoisonError::into_inner).take() else {
            return Ok(None);
        };
        let mut pictures = pictures;
        loop {
            let found = py.detach(|| recv(&mut pictures));
            // Ctrl-C drops the receiver, which ends the run. A caller such as `list` checks for Ctrl-C nowhere else.
            py.check_signals().inspect_err(|_| self.progress.stop())?;
            match found {
                Ok(Ok(picture)) => {
                    // If a motion or a policy has raised an exception, there are no more pictures.
                    self.checks.check().inspect_err(|_| self.progress.stop())?;
                    *self.pictures.lock().unwrap_or_else(PoisonError::into_inner) = Some(pictures);
                    return Picture::of(py, picture, Vec::new()).map(Some);
                }
                Ok(Err(error)) => {
                    self.checks.check()?;
                    return Err(exception(error));
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    self.checks.check()?;
                    return Ok(None);
                }
            }
        }
    }
}

pub(crate) fn film_bytes(
    py: Python<'_>,
    film: Film,
    texts: Vec<(String, String)>,
    progress: &Arc<Progress>,
    checks: &PythonFunctions,
) -> PyResult<Vec<u8>> {
    let (sender, result) = sync_channel(1);
    spawn("pxpl5-film", move || {
        let texts: Vec<(&str, String)> = texts.iter().map(|(key, text)| (key.as_str(), text.clone())).collect();
        let mut bytes = Vec::new();
        let _ = sender.send(film.write(&texts, &mut bytes).map(|()| bytes));
    })?;
    let result = wait(py, result, &progress.stop_flag());
    checks.check()?;
    result?.map_err(exception)
}

fn exception(error: PictureError) -> PyErr {
    match error {
        PictureError::Run(_) | PictureError::Experiment(ExperimentError::Run { .. }) => failed_run(error),
        error => wrong_setting(error),
    }
}
