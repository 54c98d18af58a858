//! The emulated machine in a browser. An experiment runs in short steps ([`pxpl5_run::Stepper`]), called through
//! wasm-bindgen, and a web page shows the state between steps.
//!
//! ```text
//!   address  #pipeline=slats&scene=mig&...  --> settings --> ExperimentFile --> Stepper     (this crate, compiled to wasm)
//!   page/    run, pause, step, slower  ----------> run_to, step       |
//!            eyes, ring, boards  <---- bytes and JSON ---------------+
//! ```
//!
//! Settings have the format of experiment files. The page and the command-line program therefore run the same
//! experiment and compute the same trace hash. The page has one [`WebMachine`] for each pipeline, all in one worker
//! thread of the browser. Models and recorded motions that a visitor drops onto the page are passed as [`Files`].
//! `scripts/site` builds the page. Building and testing this crate needs no browser.
//!
//! Pictures are returned as bytes: red, green, blue and 255 for each pixel, row by row from the top left.
//!
//! **Not here:** access to files, and threads. The tracker's reports stay in memory for the whole run.

mod catalog;
mod code;
mod diagram;
mod edges;
mod files;
mod glossary;
mod pictures;
mod session;
mod state;
mod volume;

pub use files::Files;

use pictures::Difference;
use pxpl5_wire::SurfaceId;
use session::Session;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Returns, as JSON, the pipelines, scenes, displays and motions that a visitor can choose, each with a name and a
/// description.
#[wasm_bindgen]
pub fn catalog() -> String {
    catalog::catalog().to_string()
}

/// Returns all terms of the glossary with their explanations, as JSON.
#[wasm_bindgen]
pub fn glossary() -> String {
    glossary::glossary().to_string()
}

/// An experiment that runs on the page, step by step.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebMachine(Session);

fn refused(error: String) -> JsError {
    JsError::new(&error)
}

#[wasm_bindgen]
impl WebMachine {
    /// Creates the machine of an experiment from its settings, written as in experiment files with one `key=value` per
    /// line. The settings may refer to the names in `files`.
    ///
    /// # Errors
    ///
    /// Returns a message that describes the invalid setting or file, or the reason why the experiment cannot run.
    #[wasm_bindgen(constructor)]
    pub fn new(settings: &str, files: &Files) -> Result<Self, JsError> {
        Session::new(settings, files).map(Self).map_err(refused)
    }

    /// Runs the machine until the instant `ps`, in picoseconds. An instant in the past has no effect.
    pub fn run_to(&mut self, ps: f64) {
        self.0.run_to(ps as u64);
    }

    /// Adds poses to the motion of a head that the visitor moves (`head.motion=live.csv`). `rows` is a recording with
    /// its header line. The last row of `rows` must not be earlier than the instant to which the machine runs next.
    ///
    /// # Errors
    ///
    /// Returns a message if a row is invalid or not later than existing rows, or if the visitor does not move the head
    /// of this experiment.
    pub fn moved(&self, rows: &str) -> Result<(), JsError> {
        self.0.moved(rows).map_err(refused)
    }

    /// Runs the machine for one step. `of` selects the length of the step: `event`, `line` (a scanline) or `field`.
    ///
    /// # Errors
    ///
    /// Returns a message if `of` is any other word.
    pub fn step(&mut self, of: &str) -> Result<(), JsError> {
        self.0.step(of).map_err(refused)
    }

    /// Returns the present instant of simulated time, in picoseconds.
    pub fn now(&self) -> f64 {
        self.0.stepper.now().0 as f64
    }

    /// Returns the state of the run as JSON: times in picoseconds, displays, failure and hashes.
    pub fn state(&self) -> String {
        self.0.state().to_string()
    }

    /// Returns the messages that occupy the channels of the ring as JSON, one entry for each channel. The entry of a
    /// free channel is null.
    pub fn channels(&self) -> String {
        state::channels(&self.0.stepper).to_string()
    }

    /// Returns the present state of each board as JSON.
    pub fn boards(&self) -> String {
        state::boards(&self.0.stepper).to_string()
    }

    /// Returns the time for which each renderer has executed commands so far, and then the time of copies of each
    /// renderer, in picoseconds.
    pub fn busy(&self) -> Vec<f64> {
        state::busy(&self.0.stepper)
    }

    /// Returns the messages that began after the instant `after_ps` (picoseconds) as JSON, at most `most` messages. If
    /// more messages began, only every n-th message is returned.
    pub fn messages(&self, after_ps: f64, most: usize) -> String {
        diagram::messages(&self.0.stepper, pxpl5_sim::Time(after_ps as u64), most).to_string()
    }

    /// Returns the regions that renderers are drawing or copying to displays, as JSON.
    pub fn regions(&self) -> String {
        diagram::regions(&self.0.stepper).to_string()
    }

    /// Returns the age of the shown picture as JSON: the time since the tracker measured the head for it, in milliseconds.
    /// The result is `null` before the first picture.
    pub fn age(&self) -> String {
        diagram::age(&self.0.stepper).to_string()
    }

    /// Returns the misregistration in the middle of the first eye's picture in the last field as JSON: the distance
    /// between the shown and the true place of the content, in pixels and in degrees. The result is `null` without a
    /// tracked head, and without a picture that was complete in time.
    pub fn misregistration(&self) -> String {
        state::misregistration(&self.0.stepper).to_string()
    }

    /// Returns the edges of the scene as lines: x, y and z of both ends in metres. The axes are those of the head at time
    /// zero: x to the right, y up, and the view along -z. The result is empty without a tracked head.
    pub fn edges(&self) -> Vec<f32> {
        edges::edges(&self.0.stepper)
    }

    /// Returns the outlines in the ideal picture of a surface at the present instant. The ideal picture has no latency.
    /// Each pixel has four bytes: red, green, blue and opacity. Pixels outside the outlines are transparent. The result
    /// is empty if the surface has no ideal picture.
    pub fn outlines(&self, surface: u16) -> Vec<u8> {
        self.0.outlines(surface)
    }

    /// Returns a description of one board, such as `gp 3`, `renderer 0` or `host`, with one fact per line.
    ///
    /// # Errors
    ///
    /// Returns a message if the machine does not have this board.
    pub fn board(&self, name: &str) -> Result<String, JsError> {
        self.0.board(name).map(|lines| lines.join("\n")).map_err(refused)
    }

    /// Returns the parts of one pixel's memory in a renderer, such as colour and depth, with one part per line. The
    /// text is empty before the renderer's first command, and for a position outside the pixel array.
    pub fn pixel(&self, renderer: usize, x: u32, y: u32) -> String {
        state::pixel(&self.0.stepper, renderer, x, y).unwrap_or_default().join("\n")
    }

    /// Returns the picture on a surface as a viewer sees it now, drawn up to the beam's present position. The result is
    /// empty if no picture is available.
    pub fn seen(&self, surface: u16) -> Vec<u8> {
        self.0.seen(surface)
    }

    /// Returns the ideal picture of a surface at the present instant, without latency, as bytes. The result is empty if
    /// the surface has no ideal picture.
    pub fn ideal(&self, surface: u16) -> Vec<u8> {
        self.0.ideal(surface)
    }

    /// Returns a heat map of the differences between the seen and the ideal picture of a surface. Black means equal,
    /// and larger differences are red, yellow and white. The result is empty without an ideal picture.
    pub fn heat(&self, surface: u16) -> Vec<u8> {
        Difference::of(&self.0.stepper, SurfaceId(surface)).map(|difference| difference.heat).unwrap_or_default()
    }

    /// Returns the difference between the seen and the ideal picture of a surface as JSON. The object has the
    /// percentage of pixels that differ, and the mean difference over all pixels in per cent. The difference at a pixel
    /// is the largest of the differences of red, green and blue. The result is `null` without an ideal picture.
    pub fn difference(&self, surface: u16) -> String {
        let difference = Difference::of(&self.0.stepper, SurfaceId(surface));
        difference.map_or_else(|| "null".to_owned(), |difference| difference.numbers().to_string())
    }

    /// Returns the 128 x 128 pixels of a renderer as bytes. Enabled pixels are green, and other pixels have the colours
    /// in their memory. The result is empty before the renderer's first command.
    pub fn renderer(&self, renderer: usize) -> Vec<u8> {
        pictures::renderer(&self.0.stepper, renderer)
    }

    /// Returns the six faces of a cube around the head, as an eye's display memory holds the faces. `eye` is 0 or 1.
    /// The faces form a cross of 512 x 384 pixels. Without `memory`, all memories are combined: each texel is the
    /// nearest texel of all memories. The result is empty for a display without such memories.
    pub fn faces(&self, eye: usize, memory: Option<usize>) -> Vec<u8> {
        pictures::faces(&self.0.stepper, eye, memory).unwrap_or_default()
    }

    /// Returns a timeline of the last `fields` display periods as SVG.
    pub fn timeline(&self, fields: u32) -> String {
        state::timeline(&self.0.stepper, u64::from(fields))
    }

    /// Returns, as JSON, the parts of the latency for each of the last complete pictures. The result has at most `most`
    /// pictures.
    pub fn latencies(&self, most: usize) -> String {
        state::latencies(&self.0.stepper, most).to_string()
    }

    /// Returns true if pictures after the warm-up were due, and no recent picture was complete in time.
    pub fn misses_all(&self) -> bool {
        state::misses_all(&self.0.stepper)
    }

    /// Returns, as JSON, the share of time for which each kind of board was busy, the waits that delayed the last
    /// pictures, and the load of the regions that were drawn lately. Shares are 0 to 1, and values that were not measured
    /// are null.
    pub fn limits(&self) -> String {
        state::limits(&self.0.stepper).to_string()
    }

    /// Returns the number of triangles and spheres in the scene, followed by the number that the pipeline shows in
    /// time, as JSON. The second number is null if the scene cannot be decimated. The search for the second number can
    /// take some seconds.
    pub fn fitting(&self) -> String {
        self.0.fitting().to_string()
    }

    /// Draws the scene of this experiment for a spinning volumetric display.
    ///
    /// # Errors
    ///
    /// Returns a message if the scene cannot be drawn.
    pub fn volume(&self) -> Result<WebVolume, JsError> {
        volume::Volume::draw(self.0.stepper.experiment().scene()).map(WebVolume).map_err(refused)
    }
}

/// A scene drawn for the spinning volumetric display of the SpatialGL paper, with 396 slices per turn.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebVolume(volume::Volume);

#[wasm_bindgen]
impl WebVolume {
    /// Returns the number of slices, followed by the width and the height of a slice in pixels.
    pub fn size(&self) -> Vec<u32> {
        self.0.size().to_vec()
    }

    /// Returns the slice with index `number` as bytes. The value of each colour of a pixel is 0 or 255, because the
    /// display has one bit for each colour.
    pub fn slice(&self, number: u32) -> Vec<u8> {
        self.0.slice(number)
    }

    /// Returns the view of an eye during one turn of the display. The eye's position is given by an azimuth and an
    /// elevation in degrees. The picture is `side` pixels wide and high.
    ///
    /// # Errors
    ///
    /// Returns a message if the eye can see nothing of the display.
    pub fn seen(&self, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Result<Vec<u8>, JsError> {
        self.0.seen(azimuth_deg, elevation_deg, side).map_err(refused)
    }
}
