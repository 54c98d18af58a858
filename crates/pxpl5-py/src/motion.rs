//! Motions of the head: by name, from recordings, from arrays, or from a Python function.

use crate::arrays::{reals1, reals2};
use crate::errors::{Raised, wrong_setting};
use glam::{DQuat, DVec3};
use numpy::PyArray2;
use numpy::ndarray::{Array2, ArrayView1, ArrayView2};
use pxpl5::ExperimentFile;
use pxpl5::tracking::motion::{Columns, End, Motion as Moving, Recording, RecordingFormat};
use pxpl5::tracking::time::{nearest_ps, seconds};
use pxpl5::tracking::{Pose, SettingSink};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use std::collections::BTreeMap;
use std::fmt::{self, Write as _};
use std::path::PathBuf;
use std::sync::Arc;

/// A motion of the head, which has a pose at every instant of simulated time.
///
/// A pose has seven numbers: the position x, y, z in metres, and a unit quaternion w, i, j, k. The quaternion rotates
/// from the head's axes to the world's axes. Axes are right-handed with y upwards, and a head looks along its own -z
/// axis.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Motion {
    moving: Arc<dyn Moving + Send + Sync>,
    /// Python function that computes the poses of this motion, with the exception that the function has raised. `None`
    /// for other motions.
    pub(crate) called: Option<Arc<CallableMotion>>,
    about: String,
    origin: Origin,
}

/// The origin of a motion, from which the Python module `pickle` rebuilds the motion.
enum Origin {
    /// The name of the motion, which contains all its numbers, for example `pan:200`.
    Name,
    /// The text of a recording, with the user's names of the columns and the behaviour after the last sample.
    Text { text: Vec<u8>, columns: BTreeMap<String, String>, end: Option<String> },
    /// A Python function.
    Callable,
}

impl Motion {
    /// Reads the text of a recording. `about` names the recording in error messages.
    fn read(text: Vec<u8>, columns: BTreeMap<String, String>, end: Option<&str>, about: String) -> PyResult<Self> {
        let mut chosen = Columns::default();
        for (field, column) in &columns {
            chosen.map(field, column).map_err(wrong_setting)?;
        }
        let format = RecordingFormat { columns: chosen, ..RecordingFormat::default() };
        let recording =
            Recording::read_as(text.as_slice(), &format).map_err(|error| wrong_setting(format!("{about}: {error}")))?;
        let moving = Arc::new(recording.ending(end_named(end)?));
        let origin = Origin::Text { text, columns, end: end.map(str::to_owned) };
        Ok(Self { moving, called: None, about, origin })
    }
}

/// Rebuilds the motion of a recording from the parts that `Motion.__reduce__` returned, for the module `pickle`.
///
/// Raises :class:`pxpl5.SettingError` in the same cases as :meth:`pxpl5.Motion.recording`.
#[pyfunction]
pub(crate) fn motion_of_text(
    text: Vec<u8>,
    columns: BTreeMap<String, String>,
    end: Option<&str>,
    about: String,
) -> PyResult<Motion> {
    Motion::read(text, columns, end, about)
}

#[pymethods]
impl Motion {
    /// Creates a motion from its name: ``still``, ``pan:DEG_PER_S``, ``slide:M_PER_S``, ``sine:DEG:HZ``, ``pendulum``,
    /// ``synthetic:SEED``, or the path of a recording. A motion that walks through the scene needs the scene. The name
    /// of such a motion must be given to the experiment instead.
    ///
    /// Raises :class:`pxpl5.SettingError` with the expected and the found text.
    #[new]
    fn new(name: &str) -> PyResult<Self> {
        let moving = pxpl5::compare::motion(name).map_err(wrong_setting)?;
        Ok(Self { moving, called: None, about: name.to_owned(), origin: Origin::Name })
    }

    /// Reads a recorded motion from a file in the project's own format, or in the format of EuRoC or TUM. The contents
    /// of the file determine the format. With ``columns``, any table can be read.
    ///
    /// ``columns`` maps the quantities of a sample to columns by name or number. The quantities are ``t``, ``t_ms``,
    /// ``t_us`` or ``t_ns``; ``x``, ``y``, ``z`` or ``x_mm`` ..; and ``qw``, ``qx``, ``qy``, ``qz``. ``end`` is the
    /// behaviour after the last sample: ``hold``, ``loop``, or None if no run may continue after it.
    ///
    /// Raises :class:`pxpl5.SettingError` with line, column, and the expected and the found text.
    #[staticmethod]
    #[pyo3(signature = (path, *, columns = None, end = None))]
    fn recording(path: PathBuf, columns: Option<BTreeMap<String, String>>, end: Option<&str>) -> PyResult<Self> {
        let name = path.display().to_string();
        let text = std::fs::read(&path).map_err(|error| wrong_setting(format!("{name} cannot be opened: {error}")))?;
        Self::read(text, columns.unwrap_or_default(), end, name)
    }

    /// Creates a recorded motion from arrays: anything that ``numpy.asarray`` takes. ``times_s`` has shape (n,), with
    /// rising times in seconds from the start of the run. ``positions`` has shape (n, 3), in metres. ``quaternions``
    /// has shape (n, 4) with w, x, y, z. Positions are interpolated linearly and orientations by slerp. ``end`` is as
    /// in :meth:`recording`.
    ///
    /// Raises :class:`pxpl5.SettingError` with the line number of the invalid sample. The first sample has line number
    /// 2.
    #[staticmethod]
    #[pyo3(signature = (times_s, positions, quaternions, *, end = None))]
    fn from_arrays(
        times_s: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        quaternions: &Bound<'_, PyAny>,
        end: Option<&str>,
    ) -> PyResult<Self> {
        let times_s = reals1("times_s", times_s)?;
        let positions = reals2("positions", positions, 3)?;
        let quaternions = reals2("quaternions", quaternions, 4)?;
        let text = own_format(&times_s.as_array(), &positions.as_array(), &quaternions.as_array())?;
        Self::read(text.into_bytes(), BTreeMap::new(), end, "arrays".to_owned())
    }

    /// Creates a motion from a Python function. ``pose(time_s)`` must return (x, y, z, w, i, j, k) for an instant in
    /// seconds, and always the same pose for the same instant. Another thread calls the function a few thousand times
    /// for each second of simulated time. The hash of the experiment covers ``name`` and the poses at 512 instants of
    /// the first 64 s.
    ///
    /// An exception of the function ends the run, and the run raises this exception.
    #[staticmethod]
    #[pyo3(signature = (pose, *, name = "callable"))]
    fn from_callable(pose: Py<PyAny>, name: &str) -> Self {
        let called = Arc::new(CallableMotion { pose, name: name.to_owned(), raised: Raised::default() });
        Self { moving: called.clone(), called: Some(called), about: name.to_owned(), origin: Origin::Callable }
    }

    /// Returns the poses at the instants ``times_s``, an array of shape (n,) in seconds, 0 or later. The result has
    /// shape (n, 7): x, y, z, w, i, j, k.
    ///
    /// Raises any exception of a Python function that computes the motion.
    fn poses<'py>(&self, py: Python<'py>, times_s: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let times_s = reals1("times_s", times_s)?;
        let times = times_s.as_array();
        if let Some(wrong) = times.iter().find(|time| !(0.0..=MAX_TIME_S).contains(*time)) {
            return Err(wrong_setting(format!("times_s: expected 0 to {MAX_TIME_S} seconds, found {wrong}")));
        }
        let poses: Vec<f64> = times.iter().flat_map(|time| numbers(&self.moving.pose(nearest_ps(*time)))).collect();
        self.check()?;
        let poses = Array2::from_shape_vec((times.len(), 7), poses).map_err(wrong_setting)?;
        Ok(PyArray2::from_owned_array(py, poses))
    }

    /// Returns the time in seconds at which the motion ends, if no run may continue after this time. Returns None for a
    /// motion without an end.
    #[getter]
    fn ends_s(&self) -> Option<f64> {
        self.moving.ends_ps().map(seconds)
    }

    /// Returns a table with the origin and the end of the motion, and a drawing of its first seconds, for notebooks.
    fn _repr_html_(slf: &Bound<'_, Self>) -> PyResult<String> {
        slf.py().import("pxpl5._html")?.call_method1("motion", (slf, &slf.get().about))?.extract()
    }

    /// Returns the function and the arguments that make an equal motion, for the module ``pickle``.
    ///
    /// A motion that a Python function computes can be pickled if ``pickle`` can store this function.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let restore = |name: &str| py.import("pxpl5._pickle")?.getattr(name);
        match (&self.origin, &self.called) {
            (Origin::Text { text, columns, end }, _) => {
                let state = (PyBytes::new(py, text), columns.clone(), end.clone(), self.about.clone());
                Ok((restore("recording")?, state.into_pyobject(py)?))
            }
            (_, Some(called)) => {
                Ok((restore("callable_motion")?, (called.pose.clone_ref(py), &called.name).into_pyobject(py)?))
            }
            _ => Ok((restore("named_motion")?, (&self.about,).into_pyobject(py)?)),
        }
    }

    /// Returns a text that describes the origin of the motion.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Motion {}>", self.about)
    }
}

impl Motion {
    /// Moves the head of an experiment by this motion.
    pub(crate) fn set_in(&self, file: &mut ExperimentFile) -> PyResult<()> {
        let set = match self.origin {
            Origin::Name => file.set("head.motion", self.about.as_str(), "a motion"),
            Origin::Text { .. } | Origin::Callable => file.set_motion(Arc::clone(&self.moving)),
        };
        set.map_err(wrong_setting)
    }

    /// Raises the exception that the motion's Python function has raised since the last check, if any.
    pub(crate) fn check(&self) -> PyResult<()> {
        match &self.called {
            Some(called) => called.raised.check(),
            None => Ok(()),
        }
    }
}

/// A motion whose poses a Python function computes.
pub(crate) struct CallableMotion {
    pose: Py<PyAny>,
    name: String,
    pub(crate) raised: Raised,
}

impl CallableMotion {
    fn asked(&self, t_ps: u64) -> PyResult<Pose> {
        let found: [f64; 7] = Python::attach(|py| {
            let answer = self.pose.call1(py, (seconds(t_ps),))?;
            answer.extract(py).map_err(|_| {
                let expected = "expected seven numbers, x, y, z and a unit quaternion w, i, j, k";
                wrong_setting(format!("{} at {} s: {expected}, found {}", self.name, seconds(t_ps), answer.bind(py)))
            })
        })?;
        let [x, y, z, w, i, j, k] = found;
        let turn = DQuat::from_xyzw(i, j, k, w);
        let length = turn.length();
        if !found.iter().all(|number| number.is_finite()) || (length - 1.0).abs() > UNIT {
            let expected = "expected seven finite numbers, x, y, z and a unit quaternion w, i, j, k";
            return Err(wrong_setting(format!("{} at {} s: {expected}, found {found:?}", self.name, seconds(t_ps))));
        }
        Ok(Pose { position: DVec3::new(x, y, z), orientation: turn.normalize() })
    }
}

/// Greatest time of a pose in seconds. The limit is due to times in picoseconds with 64 bits.
const MAX_TIME_S: f64 = 1.8e7;

/// Largest allowed difference between 1 and the length of a quaternion from Python. Quaternions may therefore be
/// rounded to a few digits.
const UNIT: f64 = 1e-3;

impl fmt::Debug for CallableMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CallableMotion").field("name", &self.name).finish_non_exhaustive()
    }
}

impl Moving for CallableMotion {
    /// Returns the pose that the Python function computes. After an exception, the head stands still until the run
    /// ends.
    fn pose(&self, t_ps: u64) -> Pose {
        if self.raised.is_there() {
            return Pose::IDENTITY;
        }
        self.asked(t_ps).unwrap_or_else(|error| {
            self.raised.keep(error);
            Pose::IDENTITY
        })
    }

    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &format_args!("callable {}", self.name));
        for sample in 0..SAMPLES {
            let pose = numbers(&self.pose(sample * SAMPLE_PS)).map(|number| number.to_string()).join(" ");
            settings("motion.pose", &pose);
        }
    }
}

/// Number of samples of a Python motion in the hash of the experiment, an eighth of a second apart. The samples stand
/// for the function, whose code cannot be hashed.
const SAMPLES: u64 = 512;
const SAMPLE_PS: u64 = 125_000_000_000;

fn numbers(pose: &Pose) -> [f64; 7] {
    let [x, y, z] = pose.position.to_array();
    let [i, j, k, w] = pose.orientation.to_array();
    [x, y, z, w, i, j, k]
}

fn end_named(name: Option<&str>) -> PyResult<End> {
    let Some(name) = name else { return Ok(End::default()) };
    let found = End::NAMES.iter().find(|(candidate, _)| *candidate == name).map(|(_, end)| *end);
    let names: Vec<&str> = End::NAMES.iter().map(|(name, _)| *name).collect();
    found.ok_or_else(|| wrong_setting(format!("end: expected {}, found {name}", names.join(" or "))))
}

/// Converts arrays to text in the project's own format for recorded motions, from which the same numbers are read.
fn own_format(
    times_s: &ArrayView1<'_, f64>,
    positions: &ArrayView2<'_, f64>,
    quaternions: &ArrayView2<'_, f64>,
) -> PyResult<String> {
    let n = times_s.len();
    if positions.dim() != (n, 3) || quaternions.dim() != (n, 4) {
        let found = format!("{:?} and {:?}", positions.dim(), quaternions.dim());
        return Err(wrong_setting(format!(
            "positions and quaternions: expected shapes ({n}, 3) and ({n}, 4), found {found}"
        )));
    }
    // The text has one header line and then one line for each sample.
    let mut text = String::from("time_s,x,y,z,qw,qx,qy,qz\n");
    for ((time, position), turn) in times_s.iter().zip(positions.rows()).zip(quaternions.rows()) {
        let values = [*time].into_iter().chain(position.iter().copied()).chain(turn.iter().copied());
        let values: Vec<String> = values.map(|value| value.to_string()).collect();
        let _ = writeln!(text, "{}", values.join(","));
    }
    Ok(text)
}
