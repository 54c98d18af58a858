//! The machine in a browser: an experiment in pieces ([`pxpl5_run::Stepper`]) behind wasm-bindgen, and the page that shows it.
//!
//! ```text
//!   address  #pipeline=slats&scene=mig&...  --> settings --> ExperimentFile --> Stepper     (this crate, compiled to wasm)
//!   page/    run, pause, step, slower  ----------> run_for, step_*   |
//!            eyes, ring, boards  <---- bytes and JSON ---------------+
//! ```
//!
//! Settings are those of experiment files, so that the page and the command run the same experiment and find the same trace hash. A page
//! holds a [`WebMachine`] for each pipeline that it shows, in a worker of the browser; everything that it shows is asked for between two
//! pieces of the run. Models and recordings that are dropped onto the page come as [`Files`]. `scripts/site` builds the page; the crate
//! builds and its tests run without a browser.
//!
//! Bytes of pictures are red, green, blue, 255 for each pixel, row by row from the left top.
//!
//! **Not here:** files and threads; what follows a head keeps the reports of its tracker for the whole run.

mod catalog;
mod code;
mod files;
mod glossary;
mod look;
mod pictures;
mod session;
mod volume;

pub use files::Files;

use session::Session;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// What there is to choose, as JSON: pipelines, scenes, displays and motions, each with its name and what it is.
#[wasm_bindgen]
#[must_use]
pub fn catalog() -> String {
    catalog::catalog().to_string()
}

/// Every term of the glossary with its sentence, as JSON.
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
    /// Builds the experiment of some settings, one `key=value` a line, as in experiment files; they may name some files.
    ///
    /// # Errors
    ///
    /// What is wrong with a setting, with a file, or with the experiment, in words.
    #[wasm_bindgen(constructor)]
    pub fn new(settings: &str, files: &Files) -> Result<Self, JsError> {
        Session::new(settings, files).map(Self).map_err(refused)
    }

    /// Runs for so many picoseconds of simulated time, or to the end.
    pub fn run_for(&mut self, ps: f64) {
        self.0.run_for(ps as u64);
    }

    /// Runs to an instant, picoseconds; one that has passed is reached at once.
    pub fn run_to(&mut self, ps: f64) {
        self.0.run_to(ps as u64);
    }

    /// Says how a head goes on that is moved on the page (`head.motion=live.csv`): rows of a recording with its head line, the last of which is
    /// not before the instant to which the machine runs next.
    ///
    /// # Errors
    ///
    /// For rows that are none, that are not later than those before, and for another head.
    pub fn moved(&self, rows: &str) -> Result<(), JsError> {
        self.0.moved(rows).map_err(refused)
    }

    /// Goes on by one `event`, `line` or `field`.
    ///
    /// # Errors
    ///
    /// For another word.
    pub fn step(&mut self, of: &str) -> Result<(), JsError> {
        self.0.step(of).map_err(refused)
    }

    /// The simulated instant, picoseconds.
    #[must_use]
    pub fn now(&self) -> f64 {
        self.0.stepper().now().0 as f64
    }

    /// Where the run stands, as JSON: time, surfaces, what failed. Times are in picoseconds.
    #[must_use]
    pub fn state(&self) -> String {
        self.0.state().to_string()
    }

    /// The message on each channel of the ring, or null, as JSON.
    #[must_use]
    pub fn channels(&self) -> String {
        look::channels(self.0.stepper()).to_string()
    }

    /// A line for each board, as JSON.
    #[must_use]
    pub fn boards(&self) -> String {
        look::boards(self.0.stepper()).to_string()
    }

    /// What one board does (`gp 3`, `renderer 0`, `host`), line by line.
    ///
    /// # Errors
    ///
    /// For a board that the machine does not have.
    pub fn board(&self, name: &str) -> Result<String, JsError> {
        self.0.board(name).map(|lines| lines.join("\n")).map_err(refused)
    }

    /// The fields of a pixel's memory in a renderer, line by line; empty before its first command, and beside the array.
    #[must_use]
    pub fn pixel(&self, renderer: usize, x: u32, y: u32) -> String {
        look::pixel(self.0.stepper(), renderer, x, y).unwrap_or_default().join("\n")
    }

    /// What stands before a viewer of a surface, as far as the beam has drawn; empty where nothing can be said.
    #[must_use]
    pub fn seen(&self, surface: u16) -> Vec<u8> {
        self.0.seen(surface)
    }

    /// What should stand there now, in the same form; empty where there is none.
    #[must_use]
    pub fn ideal(&self, surface: u16) -> Vec<u8> {
        self.0.ideal(surface)
    }

    /// A heat map of how far both differ: black not at all, red, yellow, white; empty where there is no ideal picture.
    #[must_use]
    pub fn heat(&self, surface: u16) -> Vec<u8> {
        self.0.difference(surface).map(|difference| difference.heat).unwrap_or_default()
    }

    /// The same as numbers, as JSON: percent of the pixels that differ, and mean of their largest differences in percent; `null` where
    /// there is no ideal picture.
    #[must_use]
    pub fn difference(&self, surface: u16) -> String {
        self.0.difference(surface).map_or_else(|| "null".to_owned(), |difference| difference.numbers().to_string())
    }

    /// The 128 x 128 pixels of a renderer: colours in its memory, enabled pixels green; empty before its first command.
    #[must_use]
    pub fn renderer(&self, renderer: usize) -> Vec<u8> {
        pictures::renderer(self.0.stepper(), renderer)
    }

    /// The six faces that a display memory shows to an eye, 0 or 1, as a cross of 512 x 384; empty where there is none.
    #[must_use]
    pub fn faces(&self, eye: usize, memory: usize) -> Vec<u8> {
        self.0.faces(eye, memory)
    }

    /// The last periods as the papers draw them, as SVG.
    #[must_use]
    pub fn timeline(&self, fields: u32) -> String {
        look::timeline(self.0.stepper(), u64::from(fields))
    }

    /// Where the latency of the last complete pictures went, as JSON.
    #[must_use]
    pub fn latencies(&self, most: usize) -> String {
        look::latencies(self.0.stepper(), most).to_string()
    }

    /// The scene of this experiment on the spinning display.
    ///
    /// # Errors
    ///
    /// What is wrong with the scene, in words.
    pub fn volume(&self) -> Result<WebVolume, JsError> {
        self.0.volume().map(WebVolume).map_err(refused)
    }
}

/// A scene on the display of the SpatialGL paper: 396 slices of a turn.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebVolume(volume::Volume);

#[wasm_bindgen]
impl WebVolume {
    /// Slices, and width and height of one in pixels.
    #[must_use]
    pub fn size(&self) -> Vec<u32> {
        self.0.size().to_vec()
    }

    /// A slice as its three bits a pixel light it.
    #[must_use]
    pub fn slice(&self, number: u32) -> Vec<u8> {
        self.0.slice(number)
    }

    /// What an eye sees of a turn, from an azimuth and an elevation in degrees, `side` pixels wide and high.
    ///
    /// # Errors
    ///
    /// For an eye that sees nothing.
    pub fn seen(&self, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Result<Vec<u8>, JsError> {
        self.0.seen(azimuth_deg, elevation_deg, side).map_err(refused)
    }
}
