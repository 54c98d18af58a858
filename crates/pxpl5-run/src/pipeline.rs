//! Pipelines as experiments see them.

use crate::cut::CutScene;
use crate::face_notes::FaceNotes;
use crate::keys::KeyValue;
use crate::picture_ends::PictureEnd;
use crate::views::{FrameStarts, Poses, ReportTimes, Views, ViewsWanted};
use address_recalculation::Latch;
use image::RgbImage;
use pphigs::{DisplayList, Shading};
use priority_rendering::Cell;
use pxpl5_display::{Aim, LightSpan};
use pxpl5_gp::{CodeUse, HostTiming};
use pxpl5_machine::{Arrival, ConfigError, LateRegion, Machine, MachineConfig, Record};
use pxpl5_renderer::Layout;
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, PeriodNumber, PictureNumber, SurfaceId, ViewNumber};
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

/// Where a part of the screen comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// One view, by its number in the pipeline's own count.
    View(ViewNumber),
    /// Places between those of two views.
    Between {
        /// The view at the begin.
        from: ViewNumber,
        /// The view at the end.
        to: ViewNumber,
        /// How much of the way, 0 to 1.
        part: f64,
        /// Whether places on the screen are interpolated, or positions in the view.
        on_screen: bool,
    },
}

/// What a pipeline is given to draw.
#[derive(Clone)]
pub struct Setup {
    /// The primitives that are drawn in every picture.
    pub list: Arc<DisplayList>,
    /// The host's answer to "which view now": transforms and edits.
    pub views: Views,
    /// The same for firmware that knows when a view will be seen.
    pub wanted: ViewsWanted,
    /// The head alone, for displays that turn with it.
    pub poses: Poses,
    /// Which structures of the scene move by themselves, or with the head.
    pub moving: Arc<[bool]>,
    /// The cells that each of them lies in, where the pipeline has cut the scene ([`Pipeline::cut`]); else empty.
    pub cells: Arc<[Vec<Cell>]>,
    /// Where pipelines that draw faces say what they drew.
    pub notes: FaceNotes,
    /// For which instant of what is shown from it a view is drawn, for firmware that knows when that is.
    pub aim: Aim,
    /// When the host has something new.
    pub reports: ReportTimes,
    /// When a host that waits for the pipeline begins a frame.
    pub starts: FrameStarts,
    /// How long the host takes for what it does, nanoseconds.
    pub host: HostTiming,
    /// Whether somebody may want pixels.
    pub pixels: bool,
}

/// One picture (a frame, or a field) and when it went through the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureTimes {
    /// Its number in the pipeline's own count.
    pub picture: PictureNumber,
    /// The view that it shows, or that its middle shows.
    pub view: ViewNumber,
    /// When its pose was sampled.
    pub sampled_at: Option<Time>,
    /// When TRANSFORM began to work for it.
    pub transform_at: Time,
    /// When the last of its pixels was in the display; `None` while some are missing.
    pub copied_at: Option<Time>,
    /// The retrace from which on it is shown, or when the beam meets the part that stands for it.
    pub shown_at: Time,
    /// Whether all of it was there, and in time.
    pub end: PictureEnd,
}

impl PictureTimes {
    /// Whether all of it was there in time: what was not has no latency.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.end == PictureEnd::Shown
    }
}

/// A program of a whole machine, and what its pictures' times are.
pub trait Pipeline: Any + Debug + Send + Sync {
    /// Name on the command line.
    fn name(&self) -> &'static str;

    /// Its keys and their values, as they take effect: with the name, everything that it is.
    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        Vec::new()
    }

    /// Pictures that it draws at a time, each for a surface of the first display: 1, or 2 for two eyes.
    fn eyes(&self) -> usize;

    /// How it divides pixel memory.
    fn layout(&self) -> Layout;

    /// Where it computes colours: at the corners, unless said.
    fn shading(&self) -> Shading {
        Shading::Gouraud
    }

    /// Use that the pipeline makes of the i860 code, for the times of the code: PPHIGS, unless said otherwise.
    fn code_use(&self) -> CodeUse {
        CodeUse::Pphigs
    }

    /// The machine with what the pipeline's variant changes in it, such as the time of its code.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        config
    }

    /// Whether it draws faces of a cube around the head, for a display that takes them
    /// ([`DisplayConfig::takes_faces`](pxpl5_display::DisplayConfig::takes_faces)), and before what such a display latches the
    /// orientation.
    fn draws_faces(&self) -> Option<Latch> {
        None
    }

    /// The scene as its host loads it, cut into pieces that are drawn at different times; `None` where it loads what it is given.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] for a scene that cannot be cut.
    fn cut(&self, _scene: &Arc<Scene>, _config: &MachineConfig) -> Result<Option<CutScene>, ConfigError> {
        Ok(None)
    }

    /// What its graphics processors do without i860 code, in a few words; `None` where all of it is code. At the cycle level that takes the
    /// times of the table.
    fn without_code(&self, _config: &MachineConfig) -> Option<&'static str> {
        Some("what its firmware does besides messages")
    }

    /// Loads its programs onto the boards.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] when the machine is not one on which it can run.
    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError>;

    /// The pictures that were begun and, at `end`, are shown or have missed their time, in order.
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes>;

    /// Periods of the first display before `end` in which what was drawn earlier is shown in a direction of their own: each is a picture
    /// for which nothing had to be drawn, and a run that shows some has shown something.
    fn turned_periods(&self, _record: &Record, _end: Time) -> u64 {
        0
    }

    /// Whether [`Pipeline::pictures`] and [`Pipeline::late_regions`] give the same for what happened later when records before an
    /// instant have been given up ([`Machine::forget_before`]): only then can a long run do without them.
    fn can_forget(&self) -> bool {
        false
    }

    /// Regions that missed their deadline before `end`.
    fn late_regions(&self, _record: &Record, _end: Time) -> Vec<LateRegion> {
        Vec::new()
    }

    /// Periods of the first display from one picture to the next that is due; `None` where none ever is. All counts and
    /// rates follow from it and from [`Pipeline::pictures`]: see [`DuePictures`](crate::DuePictures).
    fn periods_a_picture(&self, _record: &Record) -> Option<u64> {
        None
    }

    /// What latency means here, in a sentence.
    fn latency_definition(&self) -> &'static str;

    /// When a picture is due here, and what it takes to be in time; or why none ever is.
    fn due_definition(&self) -> &'static str;

    /// How many entries of [`Pipeline::pictures`] make a whole picture.
    fn updates_per_picture(&self, _record: &Record) -> f64 {
        1.0
    }

    /// Whether its firmware itself says when a view will be seen.
    fn knows_when_seen(&self) -> bool {
        false
    }

    /// Whether all of a picture is drawn for one pose, so that a raster can be shifted by what that was wrong.
    fn has_one_pose(&self) -> bool {
        true
    }

    /// Which of a picture's copies an arrival belongs to, where they are timed apart: 0, or 1 for the second.
    fn copy_part(&self, _arrival: &Arrival) -> u8 {
        0
    }

    /// The view that a part of a picture shows; `views` gives the view of a picture as in [`PictureTimes`], `aim` the instant that
    /// the part was drawn for.
    fn source(
        &self,
        _record: &Record,
        target: &CopyTarget,
        views: &BTreeMap<PictureNumber, ViewNumber>,
        _aim: Aim,
    ) -> Option<Source> {
        views.get(&target.picture).copied().map(Source::View)
    }

    /// When that which is drawn of a picture's view is shown: until the next picture takes its place, or the run ends.
    fn shown(&self, record: &Record, times: &PictureTimes, next: Option<&PictureTimes>) -> LightSpan {
        let first = record.display().period_at(times.shown_at);
        let next = next.map(|next| record.display().period_at(next.shown_at));
        let periods = next.map_or(self.periods_a_picture(record).unwrap_or(1), |next| next.since(first));
        light_span(record, first, periods)
    }

    /// When the light of a picture's middle comes.
    fn light(&self, record: &Record, times: &PictureTimes) -> Time {
        let display = record.display();
        display.middle_light(0, display.period_at(times.shown_at)).unwrap_or(times.shown_at)
    }

    /// What stands before a viewer of a surface at the end of the run.
    fn picture(&self, record: &Record, surface: SurfaceId) -> Option<RgbImage> {
        let display = record.display();
        display.seen(surface.index(), display.last_seen()?)
    }
}

/// When the first surface lights in so many periods of the first display, at least one.
pub(crate) fn light_span(record: &Record, first: PeriodNumber, periods: u64) -> LightSpan {
    let display = record.display();
    let tick = display.tick(first);
    let last = first.after(periods.max(1) - 1);
    LightSpan {
        tick,
        first: display.first_light(0, first).unwrap_or(tick),
        last: display.last_light(0, last).unwrap_or_else(|| display.tick(last.next())),
    }
}
