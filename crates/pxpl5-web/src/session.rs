//! A run in pieces, with what the page asks of it.

use crate::files::Files;
use crate::look;
use crate::pictures::{self, Difference, rgba};
use crate::volume::Volume;
use pxpl5_lab::ExperimentFile;
use pxpl5_machine::Board;
use pxpl5_run::{BareHost, Keep, Pause, Stepper};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, SurfaceId};
use serde_json::Value;

/// A running experiment.
#[derive(Debug)]
pub(crate) struct Session {
    stepper: Stepper,
    /// Whether all fields have been simulated.
    is_over: bool,
}

impl Session {
    /// Of settings as experiment files have them, one a line, with the contents of files that they may name.
    pub(crate) fn new(settings: &str, files: &Files) -> Result<Self, String> {
        let mut file = ExperimentFile::new();
        for (name, contents) in &files.0 {
            file = file.with_contents(name, contents.clone());
        }
        for setting in settings.lines().map(str::trim).filter(|setting| !setting.is_empty()) {
            file.set_text(setting, "settings").map_err(|error| error.to_string())?;
        }
        let plan = file.resolve().map_err(|error| error.to_string())?;
        let scene = plan.load_scene().map_err(|error| error.to_string())?;
        let experiment = plan.experiment(scene).host(BareHost).record_traffic(true).keep(Keep::Recent);
        let stepper = experiment.stepper().map_err(|error| error.to_string())?;
        Ok(Self { stepper, is_over: false })
    }

    pub(crate) fn run_for(&mut self, ps: u64) {
        self.run_to(self.stepper.now().0.saturating_add(ps));
    }

    pub(crate) fn run_to(&mut self, ps: u64) {
        // An instant behind the end is what says that the end has come.
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
        look::state(&self.stepper, self.is_over)
    }

    pub(crate) fn board(&self, name: &str) -> Result<Vec<String>, String> {
        let board: Board = name.parse()?;
        look::board(&self.stepper, board).ok_or_else(|| format!("this machine has no {board}"))
    }

    pub(crate) const fn stepper(&self) -> &Stepper {
        &self.stepper
    }

    pub(crate) fn seen(&self, surface: u16) -> Vec<u8> {
        self.stepper.seen(SurfaceId(surface)).map(|picture| rgba(&picture)).unwrap_or_default()
    }

    pub(crate) fn ideal(&self, surface: u16) -> Vec<u8> {
        self.stepper.ideal_picture(SurfaceId(surface)).map(|picture| rgba(picture.image())).unwrap_or_default()
    }

    pub(crate) fn difference(&self, surface: u16) -> Option<Difference> {
        Difference::of(&self.stepper, SurfaceId(surface))
    }

    pub(crate) fn faces(&self, eye: usize, memory: usize) -> Vec<u8> {
        let faces = Eye::BOTH.get(eye).and_then(|eye| pictures::faces(&self.stepper, *eye, memory));
        faces.unwrap_or_default()
    }

    /// The scene of the run on the spinning display.
    pub(crate) fn volume(&self) -> Result<Volume, String> {
        Volume::draw(self.stepper.experiment().scene())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_run::ExperimentError;

    fn new(settings: &str) -> Result<Session, String> {
        Session::new(settings, &Files::default())
    }

    const SETTINGS: &str = "pipeline=slats\nscene=full-screen:2\nfields=7\n";

    /// The page's hash is that of a run in one go, as the command prints it.
    #[test]
    fn a_run_of_the_page_has_the_trace_hash_of_the_run() {
        let mut session = new(SETTINGS).expect("known settings");
        while session.state()["over"] == false {
            session.run_for(7_000_000_000);
            let _ = (session.seen(0), pictures::renderer(session.stepper(), 0), look::timeline(session.stepper(), 4));
        }
        let plan = ExperimentFile::parse(
            &SETTINGS.replace("slats", "\"slats\"").replace("full-screen:2", "\"full-screen:2\""),
            "text",
        )
        .and_then(|file| file.resolve())
        .expect("an experiment");
        let outcome = match plan.experiment(plan.load_scene().expect("built in")).run() {
            Err(ExperimentError::TooShort { partial, .. }) => *partial,
            other => other.expect("it runs"),
        };
        assert_eq!(session.state()["trace_hash"], outcome.record().trace_hash().to_string());
        assert_eq!(session.state()["config_hash"], outcome.experiment().config_hash().to_string());
    }

    #[test]
    fn a_wrong_setting_is_refused_in_words() {
        for (settings, said) in [
            ("pipeline=slat", "slats"),
            ("pipeline=slats\nscene=migg", "the nearest is \"mig\""),
            ("pipeline=slats\nscene=mig\nfields=0", "fields"),
            ("nonsense", "expected path=value"),
            ("pipeline=slats\ndisplay=arp", "arp"),
        ] {
            let error = new(settings).expect_err(settings);
            assert!(error.contains(said), "{settings}: {error}");
        }
    }

    #[test]
    fn pictures_are_as_large_as_the_surfaces_that_the_state_names() {
        let mut session = new(SETTINGS).expect("known settings");
        session.run_for(60_000_000_000);
        for (number, surface) in session.state()["surfaces"].as_array().expect("a list").iter().enumerate() {
            let pixels = surface["width"].as_u64().expect("a number") * surface["height"].as_u64().expect("a number");
            assert_eq!(session.seen(number as u16).len() as u64, 4 * pixels);
            assert_eq!(session.ideal(number as u16).len() as u64, 4 * pixels);
        }
        assert!(session.seen(9).is_empty());
        assert!((0..9).any(|renderer| pictures::renderer(session.stepper(), renderer).len() == 128 * 128 * 4));
    }

    #[test]
    fn every_board_of_the_state_can_be_asked_and_no_other() {
        let mut session = new(SETTINGS).expect("known settings");
        session.run_for(40_000_000_000);
        let boards = look::boards(session.stepper());
        for board in boards.as_array().expect("a list") {
            let name = board["name"].as_str().expect("a name");
            assert!(!session.board(name).expect("it is there").is_empty(), "{name}");
        }
        assert!(session.board("gp 99").is_err() && session.board("cpu").is_err());
        assert!(session.step("pixel").is_err());
    }

    #[test]
    fn a_machine_that_fails_is_a_state() {
        let mut session = new("pipeline=slats\nscene=full-screen:200000\nfields=8\npixels=off").expect("known");
        session.run_for(200_000_000_000);
        let state = session.state();
        assert!(state["failure"].as_str().is_some_and(|error| error.contains("GP")), "{state}");
        session.run_for(1);
        assert_eq!(session.state()["failure"], state["failure"]);
    }
}
