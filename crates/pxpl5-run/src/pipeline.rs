use crate::result::picture_ends::PictureResult;
use crate::result::summary::Summary;
use crate::views::ViewSource;
use image::RgbImage;
use pphigs::{DisplayList, Shading};
use pxpl5_gp::{CodeUse, HostTiming};
use pxpl5_machine::{Arrival, LateRegion, Machine, MachineConfig, Record};
use pxpl5_renderer::Layout;
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::KeyValue;
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Time, mix};
use pxpl5_wire::display::{Aim, Coverage, LightTimes};
use pxpl5_wire::{CopyTarget, PeriodNumber, PictureNumber, SurfaceId, ViewNumber};
use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

/// The view or views from which a part of the screen was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// One view, by its number as counted by the pipeline.
    View(ViewNumber),
    /// Interpolation between two views.
    Between {
        /// View at the start of the interpolation.
        from: ViewNumber,
        /// View at the end of the interpolation.
        to: ViewNumber,
        /// Weight of the view `to`, from 0 to 1.
        part: f64,
        /// True if screen positions are interpolated. False if positions in the coordinates of the view are
        /// interpolated, before projection.
        on_screen: bool,
    },
}

/// Input of a pipeline: the scene as a display list, and the source of views.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Primitives that are drawn in every picture.
    pub list: Arc<DisplayList>,
    /// Source of views, poses and tracker reports.
    pub views: Arc<dyn ViewSource>,
    /// Scene from which the display list was made ([`Pipeline::prepare`]).
    pub scene: Arc<Scene>,
    /// Instant for which a picture's view is drawn, within the time in which the picture is displayed. Examples are the
    /// middle and the first pixel.
    ///
    /// Only firmware that computes the display times of its views uses this setting.
    pub aim: Aim,
    /// Times of the host's operations, in nanoseconds.
    pub host: HostTiming,
    /// Seed of the host's computing times.
    pub seed: u64,
    /// True if the host begins a frame only when a tracker report arrives.
    pub on_demand: bool,
    /// True if pixels may be computed.
    pub pixels: bool,
}

impl Setup {
    /// Returns the time at which a host that is ready at the instant `ready` begins its next frame. Returns `None` if
    /// the host begins no more frames.
    ///
    /// The host's application computes before each frame. With frames on demand, the first report at which the host is
    /// ready asks for the frame.
    pub fn frame_start(&self, ready: Time) -> Option<Time> {
        let asked = if self.on_demand { self.views.report_from(ready)? } else { ready };
        Some(asked + self.host.application_span(mix(self.seed ^ mix(asked.0))))
    }
}

/// Times of one picture, which is a frame or a field, on its way through the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureTimes {
    /// Number of the picture, as counted by the pipeline.
    pub picture: PictureNumber,
    /// View that the picture shows. If the picture shows several views, this is the view at the middle of the picture.
    pub view: ViewNumber,
    /// Time at which the head's pose for the picture was sampled.
    pub sampled_at: Option<Time>,
    /// Time at which TRANSFORM began for the picture.
    pub transform_at: Time,
    /// Time at which the last pixel of the picture arrived at the display. `None` while pixels are missing.
    pub copied_at: Option<Time>,
    /// Time of the retrace at which the display begins to show the picture.
    ///
    /// If pictures are shown without a swap, this is the time at which the beam reaches a part of the picture. The
    /// pipeline selects this part, for example the middle line.
    pub shown_at: Time,
    /// Result of the picture: shown, late or incomplete.
    pub end: PictureResult,
    /// Layer of the display, such as a display memory, in which the picture replaces the last picture. 0 for a display
    /// that shows one picture at a time.
    pub layer: usize,
}

impl PictureTimes {
    /// Returns true if the picture was complete in time. Other pictures have no latency.
    pub fn is_shown(&self) -> bool {
        self.end == PictureResult::Shown
    }
}

/// Properties of a pipeline that the same settings always give.
#[derive(Clone, Copy, Debug)]
pub struct PipelineProperties {
    /// Number of pictures drawn at the same time, each for one surface of the first display: 1, or 2 for two eyes.
    pub eyes: usize,
    /// Layout of pixel memory.
    pub layout: Layout,
    /// Method of shading. The default is Gouraud: colours are computed at the corners.
    pub shading: Shading,
    /// Directions that a picture shows. The display must have the same coverage
    /// ([`DisplayConfig::coverage`](pxpl5_wire::display::DisplayConfig::coverage)).
    pub coverage: Coverage,
    /// Kind of i860 code that the pipeline uses, which determines the times of the code. The default is the code of the
    /// graphics library PPHIGS.
    pub code_use: CodeUse,
    /// Short description of the graphics processors' work that has no i860 code. `None` if all work has code.
    ///
    /// At the cycle level, the times of work without code come from the timing table.
    pub without_code: Option<&'static str>,
    /// True if the firmware itself computes the time at which a view will be seen.
    pub knows_when_seen: bool,
    /// True if a whole picture is drawn for one head pose. Only such a picture can be shifted by the display to correct
    /// the pose.
    pub has_one_pose: bool,
    /// True if [`PictureRules::pictures`] and [`PictureRules::late_regions`] need no old records.
    ///
    /// After [`Machine::discard_before`], both methods must give the same results for times after the discarded
    /// records. Only then can a long run discard records.
    pub can_discard_records: bool,
    /// Sentence that defines latency for this pipeline.
    pub latency_definition: &'static str,
    /// Sentence that defines two times: when a picture is due, and up to when the picture is in time. For pipelines
    /// without due pictures, the sentence states why no picture is due.
    pub due_definition: &'static str,
    /// Function that returns the time, in milliseconds, by which levels of detail are compared. The default is the mean
    /// latency.
    pub compared_ms: fn(&Summary) -> f64,
}

impl PipelineProperties {
    /// Creates properties with a layout of pixel memory, the definition of latency, and the definition of due pictures.
    /// All other properties have their defaults.
    pub fn new(layout: Layout, latency_definition: &'static str, due_definition: &'static str) -> Self {
        Self {
            eyes: 1,
            layout,
            shading: Shading::Gouraud,
            coverage: Coverage::View,
            code_use: CodeUse::Pphigs,
            without_code: Some("all work of its firmware except messages"),
            knows_when_seen: false,
            has_one_pose: true,
            can_discard_records: false,
            latency_definition,
            due_definition,
            compared_ms: |summary| summary.latency_ms().mean,
        }
    }
}

/// A set of programs for all boards of a machine, which define how the machine draws. [`PictureRules`] defines the
/// times and contents of the pictures.
pub trait Pipeline: PictureRules + Any + Debug + Send + Sync {
    /// Returns the name of the pipeline on the command line.
    fn name(&self) -> &'static str;

    /// Returns the settings of the pipeline with their current values. Name and settings together identify the
    /// pipeline.
    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        Vec::new()
    }

    /// Returns the properties of the pipeline.
    fn properties(&self) -> PipelineProperties;

    /// Returns the configuration of the machine with the changes that this variant of the pipeline needs. For example,
    /// a variant with a different version of the i860 code changes the times of triangles.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        config
    }

    /// Returns the scene in the form that the pipeline draws. The default is the unchanged scene. A pipeline can attach
    /// data about the scene to the machine, for [`Pipeline::load`].
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for a scene that the pipeline cannot draw.
    fn prepare(&self, scene: &Arc<Scene>, _machine: &mut Machine) -> Result<Arc<Scene>, SettingError> {
        Ok(Arc::clone(scene))
    }

    /// Loads the pipeline's programs onto the boards.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the pipeline cannot run on the machine.
    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError>;
}

/// The rules that determine the times and contents of a pipeline's pictures.
pub trait PictureRules {
    /// Returns the pictures that were begun and that, at `end`, are shown or have missed their deadline. The list is in
    /// the order in which the pictures are shown.
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes>;

    /// Returns the regions that missed their deadline before `end`.
    fn late_regions(&self, _record: &Record, _end: Time) -> Vec<LateRegion> {
        Vec::new()
    }

    /// Returns the number of periods of the first display from one due picture to the next. Returns `None` if no
    /// picture is ever due.
    ///
    /// All counts and rates follow from this number and from [`PictureRules::pictures`]: see
    /// [`DuePictures`](crate::DuePictures).
    fn periods_a_picture(&self, _record: &Record) -> Option<u64> {
        None
    }

    /// Returns the number of entries in the list of [`PictureRules::pictures`] that together make one whole picture.
    /// The number is 1 unless the pipeline draws a picture in several updates.
    fn updates_per_picture(&self, _record: &Record) -> f64 {
        1.0
    }

    /// Returns the index of the copy (stage COPY) to which the arrival of a region belongs: 0, or 1 for the second
    /// copy. Each copy is timed separately.
    fn copy_part(&self, _arrival: &Arrival) -> u8 {
        0
    }

    /// Returns the view that a part of a picture shows. `views` maps the number of each picture to its view, as in
    /// [`PictureTimes`]. `aim` is the instant for which the part was drawn.
    fn source(
        &self,
        _record: &Record,
        target: &CopyTarget,
        views: &BTreeMap<PictureNumber, ViewNumber>,
        _aim: Aim,
    ) -> Option<Source> {
        views.get(&target.picture).copied().map(Source::View)
    }

    /// Returns the time span in which a picture is shown. The span ends when the next picture replaces the shown
    /// picture, or when the run ends.
    fn shown(&self, record: &Record, times: &PictureTimes, next: Option<&PictureTimes>) -> LightTimes {
        let first = record.display().period_at(times.shown_at);
        let next = next.map(|next| record.display().period_at(next.shown_at));
        let periods = next.map_or(self.periods_a_picture(record).unwrap_or(1), |next| next.since(first));
        light_span(record, first, periods)
    }

    /// Returns the time at which the middle of a picture is lit.
    fn light(&self, record: &Record, times: &PictureTimes) -> Time {
        let display = record.display();
        display.middle_light(0, display.period_at(times.shown_at)).unwrap_or(times.shown_at)
    }

    /// Returns the picture that the viewer of a surface sees at the end of the run.
    fn picture(&self, record: &Record, surface: SurfaceId) -> Option<RgbImage> {
        let display = record.display();
        display.seen(surface.index(), display.last_seen()?)
    }
}

/// Returns the time span in which the first surface is lit, over `periods` periods of the first display. `periods` must
/// be at least 1.
pub(crate) fn light_span(record: &Record, first: PeriodNumber, periods: u64) -> LightTimes {
    let display = record.display();
    let tick = display.tick(first);
    let last = first.after(periods.max(1) - 1);
    LightTimes {
        tick,
        first: display.first_light(0, first).unwrap_or(tick),
        last: display.last_light(0, last).unwrap_or_else(|| display.tick(last.next())),
    }
}
