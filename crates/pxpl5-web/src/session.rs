//! An experiment that runs in short steps, with the functions that the web page needs.

use crate::files::Files;
use crate::pictures::{self, rgba};
use crate::state;
use pxpl5_lab::limit::{LimitQuery, Model, about};
use pxpl5_lab::{ExperimentFile, Plan};
use pxpl5_machine::Board;
use pxpl5_run::{BareHost, Experiment, KeptRecords, Pause, Stepper};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::SurfaceId;
use serde_json::{Value, json};
use std::sync::Arc;
use tracking::motion::{GrowingRecording, Recording};

/// Name of the recorded motion for a head that the visitor of the page moves. This recording grows during the run.
const LIVE: &str = "live.csv";

#[derive(Debug)]
pub(crate) struct Session {
    pub(crate) stepper: Stepper,
    /// True if all fields of the experiment have been simulated.
    is_over: bool,
    plan: Plan,
    /// Recorded motion of a head that the visitor moves, or `None` if the settings give the motion.
    moves: Option<GrowingRecording>,
}

impl Session {
    pub(crate) fn new(settings: &str, files: &Files) -> Result<Self, String> {
        let mut file = ExperimentFile::new();
        for (name, contents) in &files.0 {
            file = file.with_contents(name, contents.clone());
        }
        for setting in settings.lines().map(str::trim).filter(|setting| !setting.is_empty()) {
            file.set_text(setting, "settings").map_err(|error| error.to_string())?;
        }
        // Resolve all settings together. Then keep only recent records, because the page may run for hours.
        let plan = file.resolve().map_err(|error| error.to_string())?;
        let scene = plan.load_scene().map_err(|error| error.to_string())?;
        let experiment = plan.experiment(scene).host(BareHost).record_traffic(true).keep(KeptRecords::Recent);
        // A motion named `live.csv` grows during the run.
        let live =
            files.0.get(LIVE).filter(|_| settings.lines().any(|line| line.trim() == format!("head.motion={LIVE}")));
        let (experiment, moves) = match live {
            Some(begin) => moved_on_the_page(experiment, begin)?,
            None => (experiment, None),
        };
        let stepper = experiment.stepper().map_err(|error| error.to_string())?;
        Ok(Self { stepper, is_over: false, plan, moves })
    }

    pub(crate) fn moved(&self, rows: &str) -> Result<(), String> {
        let moves = self.moves.as_ref().ok_or("this head is not moved on the page")?;
        let more = Recording::read(rows.as_bytes()).map_err(|error| error.to_string())?;
        moves.extend(&more).map_err(|error| error.to_string())
    }

    pub(crate) fn run_to(&mut self, ps: u64) {
        // The end of the experiment is reported only if the run continues to a later instant.
        let pause = self.stepper.run_to(Time(ps).min(self.stepper.end() + Span(1)));
        self.note(&pause);
    }

    pub(crate) fn step(&mut self, of: &str) -> Result<(), String> {
        let pause = match of {
            "event" => self.stepper.step_event(),
            "line" => self.stepper.step_line(),
            "field" => self.stepper.step_period(),
            _ => return Err(format!("expected event, line or field, found {of:?}")),
        };
        self.note(&pause);
        Ok(())
    }

    fn note(&mut self, pause: &Pause) {
        self.is_over |= *pause == Pause::End || self.stepper.now() == self.stepper.end();
    }

    pub(crate) fn state(&self) -> Value {
        state::state(&self.stepper, self.is_over)
    }

    pub(crate) fn board(&self, name: &str) -> Result<Vec<String>, String> {
        let board = name.parse::<Board>().map_err(|error| error.to_string())?;
        state::board(&self.stepper, board).ok_or_else(|| format!("this machine has no {board}"))
    }

    pub(crate) fn seen(&self, surface: u16) -> Vec<u8> {
        self.stepper.seen(SurfaceId(surface)).map(|picture| rgba(&picture)).unwrap_or_default()
    }

    pub(crate) fn ideal(&self, surface: u16) -> Vec<u8> {
        self.stepper.ideal_picture(SurfaceId(surface)).map(|picture| rgba(picture.image())).unwrap_or_default()
    }

    pub(crate) fn outlines(&self, surface: u16) -> Vec<u8> {
        self.stepper.ideal_picture(SurfaceId(surface)).map(|picture| pictures::outlines(&picture)).unwrap_or_default()
    }

    /// Returns the number of primitives in the scene, and approximately the number that the pipeline shows in time, as
    /// JSON.
    ///
    /// The second number comes from the closed form of the pipeline. For a pipeline without a closed form, runs of
    /// decimated scenes find the number by bisection. The second number is null if the scene cannot be decimated.
    pub(crate) fn fitting(&self) -> Value {
        let experiment = self.stepper.experiment();
        let scene = experiment.scene();
        let primitives = scene.primitives() as u64;
        let in_time = experiment.estimates.and_then(|estimates| (estimates.primitives_in_time)(experiment));
        let in_time = in_time.or_else(|| self.fitting_by_runs());
        json!({"primitives": primitives, "in_time": in_time.filter(|in_time| *in_time < primitives)})
    }

    fn fitting_by_runs(&self) -> Option<u64> {
        let whole = Arc::clone(self.stepper.experiment().scene());
        let triangles = u32::try_from(whole.triangles().len()).ok().filter(|triangles| *triangles > 0)?;
        let model = Model::new(self.plan.scene.clone(), whole);
        let query = LimitQuery { model: Some(model), head: None, ..LimitQuery::of_plan(&self.plan) };
        about(triangles, |triangles| query.reached(triangles)).ok().map(u64::from)
    }
}

/// Replaces the experiment's head motion by a growing motion, which begins with the recording `begin`. The future of
/// this motion is unknown, so a predictor is refused.
fn moved_on_the_page(experiment: Experiment, begin: &[u8]) -> Result<(Experiment, Option<GrowingRecording>), String> {
    let Some(head) = experiment.head.as_ref().cloned() else { return Ok((experiment, None)) };
    if head.predicts() {
        return Err("a head that is moved now is not known ahead: expected head.predict=none".to_owned());
    }
    let begin = Recording::read(begin).map_err(|error| error.to_string())?;
    let moves = GrowingRecording::new(begin);
    let head = Arc::unwrap_or_clone(head).with_motion(Arc::new(moves.clone()));
    Ok((experiment.head(head), Some(moves)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_run::ExperimentError;

    fn new(settings: &str) -> Result<Session, String> {
        Session::new(settings, &Files::default())
    }

    const SETTINGS: &str = "pipeline=slats\nscene=full-screen:2\nfields=7\n";

    /// Tests that a run of the web page in several steps has the trace hash of a single run.
    #[test]
    fn a_run_on_the_page_has_the_trace_hash_of_the_command() {
        let mut session = new(SETTINGS).expect("known settings");
        while session.state()["over"] == false {
            session.run_to(session.stepper.now().0 + 7_000_000_000);
            let _ = (session.seen(0), pictures::renderer(&session.stepper, 0), state::timeline(&session.stepper, 4));
        }
        let text = SETTINGS.replace("slats", "\"slats\"").replace("full-screen:2", "\"full-screen:2\"");
        let plan = ExperimentFile::parse(&text, "text").and_then(|file| file.resolve()).expect("an experiment");
        let outcome = match plan.experiment(plan.load_scene().expect("built in")).run() {
            Err(ExperimentError::TooShort { partial, .. }) => *partial,
            other => other.expect("it runs"),
        };
        assert_eq!(session.state()["trace_hash"], outcome.record().trace_hash().to_string());
        assert_eq!(session.state()["config_hash"], outcome.experiment().config_hash().to_string());
    }

    /// Returns row `n` of a recording with 60 samples per second, in the format of the web page.
    fn row(n: u64) -> String {
        let half = f64::sin(n as f64 / 9.0) / 8.0;
        format!("{:.6},0,0,0,{:.9},0,{:.9},0\n", n as f64 / 60.0, half.cos(), half.sin())
    }

    fn rows(numbers: impl Iterator<Item = u64>) -> String {
        format!("time_s,x,y,z,qw,qx,qy,qz\n{}", numbers.map(row).collect::<String>())
    }

    fn with_file(name: &str, rows: String) -> Files {
        Files([(name.to_owned(), rows.into_bytes().into())].into_iter().collect())
    }

    /// Tests that a run with live head motion can be repeated: the recording of this motion gives the same run.
    #[test]
    fn a_run_with_live_head_motion_equals_a_run_with_a_recording_of_this_motion() {
        for pipeline in
            ["slats", "rendering-control", "jitp-scanline", "frameless", "arp-full-line", "arp-priority-pixel"]
        {
            let display = if pipeline.starts_with("arp") { "arp" } else { "ntsc" };
            let settings = |motion: &str| {
                format!(
                    "pipeline={pipeline}\ndisplay={display}\nscene=full-screen:2\nfields=9\nhead.motion={motion}\nhead.end=hold\n\
                     head.tracker=fastrak\nhead.predict=none\n"
                )
            };
            let mut live = Session::new(&settings(LIVE), &with_file(LIVE, rows(0..1))).expect("known");
            for field in 1..=10 {
                live.moved(&rows(field..field + 1)).expect("later");
                live.run_to(field * 16_666_600_000);
            }
            let mut recorded =
                Session::new(&settings("recorded.csv"), &with_file("recorded.csv", rows(0..11))).expect("known");
            recorded.run_to(10 * 16_666_600_000);
            assert_eq!(live.state()["trace_hash"], recorded.state()["trace_hash"], "{pipeline}");
            assert_eq!(live.seen(0), recorded.seen(0), "{pipeline}");
        }
    }

    #[test]
    fn moving_the_head_back_in_time_or_in_another_mode_is_refused() {
        let settings =
            "pipeline=slats\nscene=full-screen:2\nfields=9\nhead.motion=live.csv\nhead.end=hold\nhead.predict=none\n";
        let session = Session::new(settings, &with_file(LIVE, rows(0..3))).expect("known");
        assert!(session.moved(&rows(2..3)).is_err_and(|error| error.contains("expected samples after")));
        assert!(session.moved("nothing").is_err());
        assert!(session.moved(&rows(3..5)).is_ok());
        assert!(new(SETTINGS).expect("known").moved(&rows(1..2)).is_err());
        let predicted = settings.replace("none", "velocity");
        let error = Session::new(&predicted, &with_file(LIVE, rows(0..1))).expect_err("it is not known ahead");
        assert!(error.contains("head.predict=none"), "{error}");
    }

    #[test]
    fn a_wrong_setting_is_refused_with_a_message() {
        for (settings, expected) in [
            ("pipeline=slat", "slats"),
            ("pipeline=slats\nscene=migg", "there is no scene `migg`; did you mean `mig`?"),
            ("pipeline=slats\nscene=mig\nfields=0", "fields"),
            ("nonsense", "expected path=value"),
            ("pipeline=slats\ndisplay=arp", "arp"),
        ] {
            let error = new(settings).expect_err(settings);
            assert!(error.contains(expected), "{settings}: {error}");
        }
    }

    #[test]
    fn pictures_have_the_sizes_of_the_listed_surfaces() {
        let mut session = new(SETTINGS).expect("known settings");
        session.run_to(60_000_000_000);
        for (number, surface) in session.state()["surfaces"].as_array().expect("a list").iter().enumerate() {
            let pixels = surface["width"].as_u64().expect("a number") * surface["height"].as_u64().expect("a number");
            assert_eq!(session.seen(number as u16).len() as u64, 4 * pixels);
            assert_eq!(session.ideal(number as u16).len() as u64, 4 * pixels);
        }
        assert!(session.seen(9).is_empty());
        assert!((0..9).any(|renderer| pictures::renderer(&session.stepper, renderer).len() == 128 * 128 * 4));
    }

    #[test]
    fn every_listed_board_has_a_snapshot_and_an_unknown_board_is_refused() {
        let mut session = new(SETTINGS).expect("known settings");
        session.run_to(40_000_000_000);
        let boards = state::boards(&session.stepper);
        for board in boards.as_array().expect("a list") {
            let name = board["name"].as_str().expect("a name");
            assert!(!session.board(name).expect("it is there").is_empty(), "{name}");
        }
        assert!(session.board("gp 99").is_err() && session.board("cpu").is_err());
        assert!(session.step("pixel").is_err());
    }

    /// Tests the number of triangles that the page reports for a scene that is too large. So many triangles are drawn in
    /// time, and twice as many are not.
    #[test]
    fn a_scene_that_is_too_heavy_is_reported_with_a_size_that_fits() {
        let misses_all = |settings: &str| {
            let mut session = new(settings).expect("known");
            session.run_to(500_000_000_000);
            assert_eq!(session.state()["now_ps"], 500_000_000_000_u64);
            (state::misses_all(&session.stepper), session.fitting())
        };
        // A number from formulas may be 5 % too large (docs/speed.md).
        for (scene, percent) in [("pipeline=slats\nscene=mig", 95), ("pipeline=jitp-scanline\nscene=aircraft", 100)] {
            let (misses, fitting) = misses_all(&format!("{scene}\nfields=60\npixels=off"));
            assert!(misses, "{scene}");
            let in_time = fitting["in_time"].as_u64().expect("a number");
            let with = |n: u64| misses_all(&format!("{scene}\ntriangles={n}\nfields=60\npixels=off")).0;
            assert!(!with(in_time * percent / 100) && with(2 * in_time), "{fitting}");
        }
        assert!(!misses_all("pipeline=slats\nscene=full-screen:2\nfields=60\npixels=off").0);
    }

    #[test]
    fn a_failed_machine_is_reported_as_a_state() {
        let mut session = new("pipeline=slats\nscene=full-screen:200000\nfields=8\npixels=off").expect("known");
        session.run_to(200_000_000_000);
        let state = session.state();
        assert!(state["failure"].as_str().is_some_and(|error| error.contains("GP")), "{state}");
        session.run_to(200_000_000_001);
        assert_eq!(session.state()["failure"], state["failure"]);
    }
}
