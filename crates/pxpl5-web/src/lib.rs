//! The machine in a browser: an experiment in pieces ([`pxpl5_run::Stepper`]) behind wasm-bindgen, and the page that shows it.
//!
//! ```text
//!   address  #pipeline=slats&scene=mig&...  --> settings --> ExperimentFile --> Stepper     (this crate, compiled to wasm)
//!   page/    run, pause, step, slower  ----------> run_for, step_*   |
//!            eyes, ring, boards  <---- bytes and JSON ---------------+
//! ```
//!
//! Settings are those of experiment files, so that the page and the command run the same experiment and find the same trace hash. A page
//! holds one [`WebMachine`]; everything that it shows is asked for between two pieces of the run. `scripts/site` builds the page; the crate
//! builds and its tests run without a browser.
//!
//! **Not here:** files and threads. Models that are dropped onto the page, a head that follows the mouse, and the timeline's drawing are
//! not there yet.

mod catalog;
mod look;
mod session;

use session::Session;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// What there is to choose, as JSON: pipelines, scenes, displays and motions, each with its name and what it is.
#[wasm_bindgen]
#[must_use]
pub fn catalog() -> String {
    catalog::catalog().to_string()
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
    /// Builds the experiment of some settings, one `key=value` a line, as in experiment files.
    ///
    /// # Errors
    ///
    /// What is wrong with a setting, or with the experiment, in words.
    #[wasm_bindgen(constructor)]
    pub fn new(settings: &str) -> Result<Self, JsError> {
        Session::new(settings).map(Self).map_err(refused)
    }

    /// Runs for so many picoseconds of simulated time, or to the end.
    pub fn run_for(&mut self, ps: f64) {
        self.0.run_for(ps as u64);
    }

    /// Runs to an instant, picoseconds; one that has passed is reached at once.
    pub fn run_to(&mut self, ps: f64) {
        self.0.run_to(ps as u64);
    }

    /// Goes on by one `event`, `line` or `field`.
    ///
    /// # Errors
    ///
    /// For another word.
    pub fn step(&mut self, of: &str) -> Result<(), JsError> {
        self.0.step(of).map_err(refused)
    }

    /// The machine as it stands, as JSON: time, boards, ring, what failed. Times are in picoseconds.
    #[must_use]
    pub fn state(&self) -> String {
        self.0.state().to_string()
    }

    /// What one board does (`gp 3`, `renderer 0`, `host`), line by line.
    ///
    /// # Errors
    ///
    /// For a board that the machine does not have.
    pub fn board(&self, name: &str) -> Result<String, JsError> {
        self.0.board(name).map(|lines| lines.join("\n")).map_err(refused)
    }

    /// What stands before a viewer of a surface, as far as the beam has drawn: red, green, blue, 255 for each pixel, row by row; empty
    /// where nothing can be said.
    #[must_use]
    pub fn seen(&self, surface: u16) -> Vec<u8> {
        self.0.seen(surface)
    }

    /// What should stand there now, in the same form; empty where there is none.
    #[must_use]
    pub fn ideal(&self, surface: u16) -> Vec<u8> {
        self.0.ideal(surface)
    }

    /// Which pixels of a renderer are enabled: 128 rows of 16 bytes, the leftmost pixel of eight in the lowest bit; empty before its
    /// first command.
    #[must_use]
    pub fn enabled(&self, renderer: usize) -> Vec<u8> {
        self.0.enabled(renderer)
    }
}
