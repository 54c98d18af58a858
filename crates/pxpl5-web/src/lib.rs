//! The machine in a browser. An experiment runs in pieces ([`pxpl5_run::Stepper`]) behind wasm-bindgen, and a page
//! shows its state.
//!
//! ```text
//!   address  #pipeline=slats&scene=mig&...  --> settings --> ExperimentFile --> Stepper     (this crate, compiled to wasm)
//!   page/    run, pause, step, slower  ----------> run_for, step_*   |
//!            eyes, ring, boards  <---- bytes and JSON ---------------+
//! ```
//!
//! Settings have the format of experiment files. Page and command thus run the same experiment and get the same trace
//! hash. A page has a [`WebMachine`] for each pipeline, in a worker of the browser. The page reads the state of the
//! machine between two pieces of the run. Models and recordings that a visitor drops onto the page are passed as
//! [`Files`]. `scripts/site` builds the page. Building and testing this crate needs no browser.
//!
//! Pictures are returned as bytes: red, green, blue and 255 for each pixel, row by row from the top left.
//!
//! **Not here:** files and threads. The tracker's reports for a head stay in memory for the whole run.

mod catalog;
mod code;
mod diagram;
mod files;
mod glossary;
mod look;
mod pictures;
mod session;
mod volume;

pub use files::Files;

use session::Session;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Returns all choices as JSON: pipelines, scenes, displays and motions, each with name and description.
#[wasm_bindgen]
#[must_use]
pub fn catalog() -> String {
    catalog::catalog().to_string()
}

/// Returns all terms of the glossary with their sentences, as JSON.
#[wasm_bindgen]
#[must_use]
pub fn glossary() -> String {
    glossary::glossary().to_string()
}

/// A running experiment of the page.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebMachine(Session);

fn refused(error: String) -> JsError {
    JsError::new(&error)
}

#[wasm_bindgen]
impl WebMachine {
    /// Builds the experiment from settings, with one `key=value` a line as in experiment files. The settings may name
    /// files in `files`.
    ///
    /// # Errors
    ///
    /// A message about the invalid setting, file or experiment.
    #[wasm_bindgen(constructor)]
    pub fn new(settings: &str, files: &Files) -> Result<Self, JsError> {
        Session::new(settings, files).map(Self).map_err(refused)
    }

    /// Runs for `ps` picoseconds of simulated time, or to the end.
    pub fn run_for(&mut self, ps: f64) {
        self.0.run_for(ps as u64);
    }

    /// Runs to an instant in picoseconds. For an instant in the past, nothing happens.
    pub fn run_to(&mut self, ps: f64) {
        self.0.run_to(ps as u64);
    }

    /// Extends the motion of a head that is moved on the page (`head.motion=live.csv`). `rows` is a recording with its
    /// header line. The last row must not be earlier than the instant to which the machine runs next.
    ///
    /// # Errors
    ///
    /// A message for invalid rows, for rows that are not later than earlier ones, and for a head that is not moved on
    /// the page.
    pub fn moved(&self, rows: &str) -> Result<(), JsError> {
        self.0.moved(rows).map_err(refused)
    }

    /// Runs for one `event`, `line` or `field`.
    ///
    /// # Errors
    ///
    /// A message for any other word.
    pub fn step(&mut self, of: &str) -> Result<(), JsError> {
        self.0.step(of).map_err(refused)
    }

    /// Returns the simulated instant in picoseconds.
    #[must_use]
    pub fn now(&self) -> f64 {
        self.0.stepper().now().0 as f64
    }

    /// Returns the state of the run as JSON: times in picoseconds, surfaces and failures.
    #[must_use]
    pub fn state(&self) -> String {
        self.0.state().to_string()
    }

    /// Returns the message on each channel of the ring as JSON. A free channel is null.
    #[must_use]
    pub fn channels(&self) -> String {
        look::channels(self.0.stepper()).to_string()
    }

    /// Returns a description of each board as JSON.
    #[must_use]
    pub fn boards(&self) -> String {
        look::boards(self.0.stepper()).to_string()
    }

    /// Returns the messages that began after an instant in picoseconds as JSON, at most `most`. If there are more, every
    /// n-th is returned.
    #[must_use]
    pub fn messages(&self, after_ps: f64, most: usize) -> String {
        diagram::messages(self.0.stepper(), pxpl5_sim::Time(after_ps as u64), most).to_string()
    }

    /// Returns the regions that renderers are sending to displays, as JSON.
    #[must_use]
    pub fn regions(&self) -> String {
        diagram::regions(self.0.stepper()).to_string()
    }

    /// Returns the age of the shown picture as JSON: the milliseconds since its pose was sampled. `null` before the
    /// first picture.
    #[must_use]
    pub fn age(&self) -> String {
        diagram::age(self.0.stepper()).to_string()
    }

    /// Returns the outlines of the ideal picture of a surface for the present instant, as bytes with transparency.
    /// Empty if the surface has no ideal picture.
    #[must_use]
    pub fn outlines(&self, surface: u16) -> Vec<u8> {
        self.0.outlines(surface)
    }

    /// Returns a description of one board (`gp 3`, `renderer 0`, `host`), one fact a line.
    ///
    /// # Errors
    ///
    /// A message for a board that the machine does not have.
    pub fn board(&self, name: &str) -> Result<String, JsError> {
        self.0.board(name).map(|lines| lines.join("\n")).map_err(refused)
    }

    /// Returns the fields of a pixel's memory in a renderer, one a line. The text is empty before the renderer's first
    /// command, and outside the array.
    #[must_use]
    pub fn pixel(&self, renderer: usize, x: u32, y: u32) -> String {
        look::pixel(self.0.stepper(), renderer, x, y).unwrap_or_default().join("\n")
    }

    /// Returns the picture on a surface as the viewer sees it now, up to the beam. Empty if no picture is available.
    #[must_use]
    pub fn seen(&self, surface: u16) -> Vec<u8> {
        self.0.seen(surface)
    }

    /// Returns the ideal picture of a surface for the present instant, as bytes. Empty if the surface has none.
    #[must_use]
    pub fn ideal(&self, surface: u16) -> Vec<u8> {
        self.0.ideal(surface)
    }

    /// Returns a heat map of the differences between the seen picture and the ideal one. Black means equal, then red,
    /// yellow and white follow. Empty without an ideal picture.
    #[must_use]
    pub fn heat(&self, surface: u16) -> Vec<u8> {
        self.0.difference(surface).map(|difference| difference.heat).unwrap_or_default()
    }

    /// Returns the difference between the seen picture and the ideal one as JSON. The object has the percentage of
    /// pixels that differ, and the mean of their largest differences in per cent. `null` without an ideal picture.
    #[must_use]
    pub fn difference(&self, surface: u16) -> String {
        self.0.difference(surface).map_or_else(|| "null".to_owned(), |difference| difference.numbers().to_string())
    }

    /// Returns the 128 x 128 pixels of a renderer: the colours in its memory, with enabled pixels in green. Empty
    /// before its first command.
    #[must_use]
    pub fn renderer(&self, renderer: usize) -> Vec<u8> {
        pictures::renderer(self.0.stepper(), renderer)
    }

    /// Returns the six faces of a display memory for an eye, 0 or 1, as a cross of 512 x 384 pixels. Without a number,
    /// the memories are joined: each texel is the nearest of all. Empty without such a memory.
    #[must_use]
    pub fn faces(&self, eye: usize, memory: Option<usize>) -> Vec<u8> {
        self.0.faces(eye, memory)
    }

    /// Returns the last `fields` periods as a timeline in SVG.
    #[must_use]
    pub fn timeline(&self, fields: u32) -> String {
        look::timeline(self.0.stepper(), u64::from(fields))
    }

    /// Returns the latency parts of the last complete pictures, at most `most`, as JSON.
    #[must_use]
    pub fn latencies(&self, most: usize) -> String {
        look::latencies(self.0.stepper(), most).to_string()
    }

    /// Draws the scene of this experiment for the spinning display.
    ///
    /// # Errors
    ///
    /// A message if the scene cannot be drawn.
    pub fn volume(&self) -> Result<WebVolume, JsError> {
        self.0.volume().map(WebVolume).map_err(refused)
    }
}

/// A scene on the display of the SpatialGL paper, with 396 slices a turn.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebVolume(volume::Volume);

#[wasm_bindgen]
impl WebVolume {
    /// Returns the number of slices, and the width and height of a slice in pixels.
    #[must_use]
    pub fn size(&self) -> Vec<u32> {
        self.0.size().to_vec()
    }

    /// Returns a slice as bytes. Each pixel is lit by its three bits.
    #[must_use]
    pub fn slice(&self, number: u32) -> Vec<u8> {
        self.0.slice(number)
    }

    /// Returns the view of an eye over one turn, for an azimuth and an elevation in degrees. The picture is `side`
    /// pixels wide and high.
    ///
    /// # Errors
    ///
    /// A message for an eye that sees nothing.
    pub fn seen(&self, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Result<Vec<u8>, JsError> {
        self.0.seen(azimuth_deg, elevation_deg, side).map_err(refused)
    }
}
