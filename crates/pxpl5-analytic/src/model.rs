//! Parameters of Slats on a machine, and the results for a field.

use super::copies::{CopyTimes, MAX_RENDERERS, Queue};
use super::renderer::Cost;
use crate::{no_form, video_of};
use pphigs::TransformCost;
use pxpl5_gp::GpTiming;
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::CommandKind;
use pxpl5_run::{DuePictures, PictureResult, Pipeline, Slats, WARM_UP_PERIODS};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{PeriodNumber, RegionGrid};

pub(super) const REGIONS: usize = 20;

pub(super) const MAX_CHANNELS: usize = 8;

/// Number of ring channels that copies occupy, one for each frame buffer.
const COPY_CHANNELS: u64 = 2;

const EYES: f64 = 2.0;

/// Returns the time before the first triangle of TRANSFORM, for both eyes, in nanoseconds. `sphere_views` is the number
/// of structures with spheres.
fn begin_ns(gp: &GpTiming, structures: usize, sphere_views: usize) -> f64 {
    let [structures, sphere_views] = [structures, sphere_views].map(|n| EYES * n as f64);
    TransformCost { passes: 1.0, structures, sphere_views, ..TransformCost::default() }.ns(gp)
}

/// The parameters that determine the times of Slats on a machine.
#[derive(Clone, Debug)]
pub struct SlatsModel {
    pub(super) fifo_words: f64,
    pub(super) word_ns: f64,
    pub(super) overhead_ns: f64,
    pub(super) hop_ns: f64,
    pub(super) gp: GpTiming,
    pub(super) begin_ns: f64,
    pub(super) message_ns: f64,
    pub(super) command: Cost,
    pub(super) sphere: Cost,
    pub(super) select: Cost,
    pub(super) clear: Cost,
    pub(super) region_ns: f64,
    pub(super) field_ns: f64,
    /// Time from a retrace until the beam reaches the lower half of the picture, in nanoseconds.
    bottom_ns: f64,
    pub(super) renderers: usize,
    pub(super) gps: usize,
    pub(super) source_channels: usize,
    pub(super) fifo_channels: usize,
    pub(super) split: bool,
}

/// Times of a field, in nanoseconds after the retrace at which TRANSFORM begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldTimes {
    /// Time at which the renderers had accepted all triangles.
    pub rendered_ns: f64,
    /// Copies of the upper half of the picture, or of the whole picture if copies are not split.
    pub top: CopyTimes,
    /// Copies of the lower half of the picture after the retrace, if copies are split.
    pub bottom: Option<CopyTimes>,
    /// True if all copies ended before their deadlines.
    pub in_time: bool,
}

/// Mean work for one triangle in the picture of one eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerTriangle {
    /// Number of bin entries, which is the number of regions that the triangle touches.
    pub entries: f64,
    /// Fraction of triangles that the clipper cuts, 0 to 1.
    pub clipped: f64,
}

impl SlatsModel {
    /// Returns the model for a machine. If the machine runs i860 code, the times of this code are used. All triangles
    /// form one structure.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if there are too few renderers, or if messages to renderers leave fewer than two
    /// channels for split copies. Such copies would wait for each other, and the analytic level does not model this
    /// wait.
    pub fn new(config: &MachineConfig, program: Slats) -> Result<Self, SettingError> {
        // Each renderer holds as many regions as its memory layout permits.
        slats::Binding::new(config.n_renderers, program.properties().layout.plan().contexts, program.copy)?;
        // A variant of the program changes the machine, as in a run with events. The usual program changes nothing, and
        // sweeps make many models of it.
        let usual = Slats { copy: program.copy, ..Slats::whole() };
        let adapted = (program != usual).then(|| program.adapt(config.clone()));
        let config = adapted.as_ref().unwrap_or(config);
        // Split copies need channels that messages to renderers leave free.
        let ring = &config.ring;
        let to_renderers = ring.fifo_channels.min(ring.source_channels.saturating_mul(config.n_gps as u64));
        if program.copy.is_split() && to_renderers.saturating_add(COPY_CHANNELS) > ring.channels {
            let what = format!(
                "split copies that lack channels: ring.channels: expected at least {}, found {}",
                to_renderers.saturating_add(COPY_CHANNELS),
                ring.channels
            );
            return Err(no_form(&what));
        }
        // Geometry of the video scan.
        let video = video_of(config)?;
        let field_ns = video.retrace(PeriodNumber(1)).since(Time::ZERO).as_ms() * 1e6;
        let even = PeriodNumber(2);
        let bottom = video.line_start(2 * RegionGrid::FIELD.region_height, even);
        let messages = (15_360.0_f64 / 1_024.0).ceil();
        let word_ns = config.ring.word_ns as f64;
        Ok(Self {
            fifo_words: config.renderer.fifo_words as f64,
            word_ns,
            overhead_ns: config.ring.overhead_words as f64 * word_ns,
            hop_ns: config.ring.hop_ns as f64,
            gp: config.gp,
            begin_ns: begin_ns(&config.gp, 1, 0),
            message_ns: config.gp.message_ns as f64,
            command: Cost::of_command(&config.renderer, CommandKind::Triangle),
            sphere: Cost::of_command(&config.renderer, CommandKind::Sphere),
            select: Cost::of_command(&config.renderer, CommandKind::SelectRegion),
            clear: Cost::of_command(&config.renderer, CommandKind::Clear),
            region_ns: 15_360.0 * word_ns + messages * config.ring.overhead_words as f64 * word_ns,
            field_ns,
            bottom_ns: bottom.map_or(0.0, |at| at.since(video.retrace(even)).as_ms() * 1e6),
            renderers: config.n_renderers.min(MAX_RENDERERS),
            gps: config.n_gps,
            source_channels: (config.ring.source_channels.min(config.ring.fifo_channels).min(config.ring.channels)
                as usize)
                .clamp(1, MAX_CHANNELS),
            fifo_channels: (config.ring.fifo_channels.min(config.ring.channels) as usize).max(1),
            split: program.copy.is_split(),
        })
    }

    /// Returns the model for a scene with several structures.
    #[must_use]
    pub fn over(self, scene: &Scene) -> Self {
        let sphere_views = scene.structures().iter().filter(|structure| !structure.spheres.is_empty()).count();
        Self { begin_ns: begin_ns(&self.gp, scene.structures().len(), sphere_views), ..self }
    }

    /// Returns the parameters that determine the number and order of messages. Only machines with equal values of these
    /// parameters can be computed together.
    pub(super) const fn structure(&self) -> (usize, usize, usize, bool) {
        (self.renderers, self.gps, self.source_channels, self.split)
    }

    /// Counts the pictures that are due and shown in `fields` fields, if each field has the times `times`.
    ///
    /// A field begins at the first retrace after the previous field is finished.
    pub(super) fn due(&self, times: FieldTimes, fields: u64) -> Option<DuePictures> {
        let copied_ns = times.bottom.unwrap_or(times.top).end_ns;
        // A field is drawn in one field and scanned in the next, so its scan ends two fields after its view was taken.
        let end = PictureResult::of(copied_ns <= 2.0 * self.field_ns, times.in_time);
        let messages = if self.split { 2.0 } else { 1.0 };
        let apart = ((times.rendered_ns + messages * self.message_ns) / self.field_ns).ceil().max(1.0);
        // Fields before the window fill the pipeline.
        let begun = (WARM_UP_PERIODS % apart as u64..fields).step_by(apart as usize);
        DuePictures::count(begun.map(|field| (PeriodNumber(field), end)), 1, PeriodNumber(fields))
    }

    /// Returns the copies that each renderer makes, for the regions for which `wanted` returns true.
    pub(super) fn layout(&self, wanted: impl Fn(usize) -> bool) -> [Queue; MAX_RENDERERS] {
        let mut queues = [Queue::default(); MAX_RENDERERS];
        let per_half = REGIONS / 4;
        // Alternate between left and right eye. Odd renderers of a split copy begin with the right eye if possible.
        let regions = (0..REGIONS).zip((0..self.renderers).cycle());
        for (region, renderer) in regions.filter(|(region, _)| wanted(*region)) {
            let right = (region / per_half) % 2 == 1;
            queues[renderer].push(right);
        }
        for (renderer, queue) in queues.iter_mut().enumerate().take(self.renderers) {
            *queue = queue.alternated(self.split && renderer % 2 == 1);
        }
        queues
    }

    /// Returns the times of a field, and checks the deadlines of its copies.
    pub(super) fn times(&self, rendered_ns: f64, top: CopyTimes, bottom: Option<CopyTimes>) -> FieldTimes {
        let bottom_in_time = bottom.is_none_or(|times| times.end_ns <= self.field_ns + self.bottom_ns);
        FieldTimes { rendered_ns, top, bottom, in_time: top.end_ns <= self.field_ns && bottom_in_time }
    }

    /// Returns the time from the retrace to the begin of TRANSFORM, in nanoseconds. Before, the first of several
    /// processors prepares the messages that clear the regions, and the view of the others.
    pub(super) fn transform_begins_ns(&self) -> f64 {
        if self.gps > 1 { 2.0 * self.message_ns } else { 0.0 }
    }

    /// Returns the time of a message with copy commands for two regions, of 11 words each, in nanoseconds.
    pub(super) fn copy_order_ns(&self) -> f64 {
        self.overhead_ns + 2.0 * 11.0 * self.word_ns
    }

    /// Returns the time of TRANSFORM for `triangles` triangles and both eyes, in nanoseconds.
    pub(super) fn clump_ns(&self, triangles: f64, each: PerTriangle) -> f64 {
        let both_eyes = EYES * triangles;
        let [entries, clipped] = [each.entries, each.clipped].map(|n| both_eyes * n);
        TransformCost { triangles: both_eyes, entries, clipped, ..TransformCost::default() }.ns(&self.gp)
    }
}
