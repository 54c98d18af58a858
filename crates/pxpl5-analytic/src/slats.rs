//! Slats: one field.

use super::clumps::{self, MOST_CHANNELS};
use super::copies::{self, CopyTimes, MOST_RENDERERS, Queue};
use super::load::Load;
use super::renderer::{Array, Cost, Times};
use crate::{pipeline_of, video_of};
use multiversion::multiversion;
use pphigs::{RegionBinning, TransformCost};
use pxpl5_geometry::Viewport;
use pxpl5_gp::GpTiming;
use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_renderer::CommandKind;
use pxpl5_run::{
    ClosedForm, DuePictures, Estimates, Experiment, ExperimentError, PictureEnd, Pipeline, Samples, Slats, Summary,
    WARM_UP_PERIODS, WARM_UP_PICTURES,
};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, PeriodNumber, RegionGrid};

/// Field regions of both eyes.
pub(super) const REGIONS: usize = 20;

/// Eyes, for each of which a structure is put in its place.
const EYES: f64 = 2.0;

/// The beginning of a pass over so many structures, of which some have spheres, for both eyes.
fn begin_ns(gp: &GpTiming, structures: usize, sphere_views: usize) -> f64 {
    let [structures, sphere_views] = [structures, sphere_views].map(|n| EYES * n as f64);
    TransformCost { passes: 1.0, structures, sphere_views, ..TransformCost::default() }.ns(gp)
}

/// Slats on a machine, reduced to numbers.
#[derive(Clone, Debug)]
pub struct SlatsModel {
    pub(super) fifo_words: f64,
    pub(super) word_ns: f64,
    pub(super) overhead_ns: f64,
    pub(super) hop_ns: f64,
    gp: GpTiming,
    /// The beginning of a pass.
    pub(super) begin_ns: f64,
    pub(super) message_ns: f64,
    pub(super) command: Cost,
    pub(super) select: Cost,
    pub(super) clear: Cost,
    region_ns: f64,
    field_ns: f64,
    /// From a retrace to the scan of the first line of the bottom regions.
    bottom_ns: f64,
    renderers: usize,
    pub(super) gps: usize,
    pub(super) source_channels: usize,
    split: bool,
}

/// When things happened, in nanoseconds after the retrace at which the field's view was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldTimes {
    /// The last clump was accepted.
    pub rendered_ns: f64,
    /// Copy of the top regions, or of all.
    pub top: CopyTimes,
    /// Copy of the bottom regions of a split copy, after the retrace.
    pub bottom: Option<CopyTimes>,
    /// Whether everything came before its deadline.
    pub in_time: bool,
}

/// What a triangle is for one eye, in the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerTriangle {
    /// Entries in bins.
    pub entries: f64,
    /// Part of the triangles that the clipper cuts, 0 to 1.
    pub clipped: f64,
}

impl SlatsModel {
    /// Reduces a machine; the program's code is applied first. Triangles are of one structure.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] for too few renderers.
    pub fn new(config: &MachineConfig, program: Slats) -> Result<Self, ConfigError> {
        let contexts = usize::from(program.layout().plan().contexts.max(1));
        if config.n_renderers < REGIONS.div_ceil(contexts) {
            let error = slats::SlatsConfigError::TooFewRenderers {
                found: config.n_renderers,
                expected: REGIONS.div_ceil(contexts),
            };
            return Err(ConfigError::Board(error.to_string()));
        }
        if program.code.is_some() {
            return Self::new(&program.adapt(config.clone()), Slats { code: None, ..program });
        }
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
            select: Cost::of_command(&config.renderer, CommandKind::SelectRegion),
            clear: Cost::of_command(&config.renderer, CommandKind::Clear),
            region_ns: 15_360.0 * word_ns + messages * config.ring.overhead_words as f64 * word_ns,
            field_ns,
            bottom_ns: bottom.map_or(0.0, |at| at.since(video.retrace(even)).as_ms() * 1e6),
            renderers: config.n_renderers.min(MOST_RENDERERS),
            gps: config.n_gps,
            source_channels: (config.ring.source_channels.min(config.ring.fifo_channels).min(config.ring.channels)
                as usize)
                .clamp(1, MOST_CHANNELS),
            split: program.copy.is_split(),
        })
    }

    /// The same for the structures of a scene.
    #[must_use]
    pub fn over(self, scene: &Scene) -> Self {
        let sphere_views = scene.structures().iter().filter(|structure| !structure.spheres.is_empty()).count();
        Self { begin_ns: begin_ns(&self.gp, scene.structures().len(), sphere_views), ..self }
    }

    /// A field in the steady state: renderers begin with the bottom regions of the field before.
    #[must_use]
    pub fn field(&self, triangles: f64, each: PerTriangle) -> FieldTimes {
        let [times] = fields_at_once(std::array::from_ref(self), triangles, each);
        times
    }

    /// The same of many machines, in their order: exactly what [`field`](Self::field) gives of each. Sixteen after another that have as
    /// many boards and channels and the same program go through it together, which is faster.
    #[must_use]
    pub fn fields(models: &[Self], triangles: f64, each: PerTriangle) -> Vec<FieldTimes> {
        let mut all = Vec::with_capacity(models.len());
        for some in models.chunks(TOGETHER) {
            match <&[Self; TOGETHER]>::try_from(some) {
                Ok(some) if some.iter().all(|model| model.structure() == some[0].structure()) => {
                    all.extend(fields_together(some, triangles, each));
                }
                _ => all.extend(some.iter().map(|model| model.field(triangles, each))),
            }
        }
        all
    }

    /// What decides how many messages there are, and in which order they go.
    const fn structure(&self) -> (usize, usize, usize, bool) {
        (self.renderers, self.gps, self.source_channels, self.split)
    }

    /// Field after field like this one: one is begun at every retrace at which the one before is done with its commands.
    fn due(&self, times: FieldTimes, fields: u64) -> Option<DuePictures> {
        let copied_ns = times.bottom.unwrap_or(times.top).end_ns;
        // A field is scanned during the one after that in which it is drawn.
        let end = PictureEnd::of(copied_ns <= 2.0 * self.field_ns, times.in_time);
        let messages = if self.split { 2.0 } else { 1.0 };
        let apart = ((times.rendered_ns + messages * self.message_ns) / self.field_ns).ceil().max(1.0);
        let begun = (WARM_UP_PERIODS..fields).step_by(apart as usize);
        DuePictures::count(begun.map(|field| (PeriodNumber(field), end)), 1, PeriodNumber(fields))
    }

    /// The copies that each renderer makes, of the regions for which `wanted` holds.
    fn layout(&self, wanted: impl Fn(usize) -> bool) -> [Queue; MOST_RENDERERS] {
        let mut queues = [Queue::default(); MOST_RENDERERS];
        let per_half = REGIONS / 4;
        // Left and right eye by turns; the odd renderers of a split copy begin right.
        let regions = (0..REGIONS).zip((0..self.renderers).cycle());
        for (region, renderer) in regions.filter(|(region, _)| wanted(*region)) {
            let right = (region / per_half) % 2 == 1;
            queues[renderer].push(right);
        }
        for queue in queues.iter_mut().take(self.renderers).skip(1).step_by(2).filter(|_| self.split) {
            *queue = queue.reversed();
        }
        queues
    }

    /// Whether what ends then is in time.
    fn times(&self, rendered_ns: f64, top: CopyTimes, bottom: Option<CopyTimes>) -> FieldTimes {
        let bottom_in_time = bottom.is_none_or(|times| times.end_ns <= self.field_ns + self.bottom_ns);
        FieldTimes { rendered_ns, top, bottom, in_time: top.end_ns <= self.field_ns && bottom_in_time }
    }

    /// TRANSFORM of a clump of so many triangles for both eyes.
    pub(super) fn clump_ns(&self, triangles: f64, each: PerTriangle) -> f64 {
        let both_eyes = EYES * triangles;
        let [entries, clipped] = [each.entries, each.clipped].map(|n| both_eyes * n);
        TransformCost { triangles: both_eyes, entries, clipped, ..TransformCost::default() }.ns(&self.gp)
    }
}

/// Configurations that are computed together: two registers of 512 bits, or four of 256. Each step waits for the one before, so twice as
/// many as fit one register go together in little more time.
const TOGETHER: usize = 16;

/// As wide as the processor is.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn fields_together(models: &[SlatsModel; TOGETHER], triangles: f64, each: PerTriangle) -> [FieldTimes; TOGETHER] {
    fields_at_once(models, triangles, each)
}

/// Fields of machines of the same structure.
#[inline(always)]
fn fields_at_once<const N: usize>(models: &[SlatsModel; N], triangles: f64, each: PerTriangle) -> [FieldTimes; N] {
    let is_split = models[0].split;
    let of_top = models[0].layout(|region| !is_split || region < REGIONS / 2);
    let of_bottom = models[0].layout(|region| is_split && region >= REGIONS / 2);
    let mut arrays = [Array::idle(); MOST_RENDERERS];
    let arrays = &mut arrays[..models[0].renderers];
    let message = Times::each(|i| models[i].message_ns);
    if is_split {
        // Of the field before.
        copy(models, arrays, Times::all(0.0), &of_bottom);
    }
    let rendered = clumps::render(models, arrays, triangles, each);
    let top = copy(models, arrays, rendered + message, &of_top);
    // No closure around lanes: what is not inlined is compiled for any processor.
    let bottom = if is_split {
        let retrace = Times::each(|i| models[i].field_ns);
        Some(copy(models, arrays, retrace.later(rendered + message + message), &of_bottom))
    } else {
        None
    };
    std::array::from_fn(|i| models[i].times(rendered.0[i], top[i], bottom.map(|times| times[i])))
}

/// Copies by renderers to which the commands for them go out one after the other from an instant on.
#[inline(always)]
fn copy<const N: usize>(
    models: &[SlatsModel; N],
    arrays: &mut [Array<N>],
    from: Times<N>,
    queues: &[Queue; MOST_RENDERERS],
) -> [CopyTimes; N] {
    let each = Times::<N>::each(|i| models[i].overhead_ns + 2.0 * 11.0 * models[i].word_ns);
    for (renderer, array) in arrays.iter_mut().enumerate() {
        let commanded = from + each * Times::all((renderer + 1) as f64);
        array.free = commanded.later(array.free);
    }
    copies::make(arrays, queues, Times::each(|i| models[i].region_ns))
}

/// An experiment with Slats at the analytic level.
pub(super) const CLOSED_FORM: ClosedForm =
    ClosedForm { summary: closed_form, estimates: Estimates { fields_needed, triangles_in_time } };

fn triangles_in_time(experiment: &Experiment) -> Option<u64> {
    crate::triangles_in_time(experiment, closed_form)
}

fn closed_form(experiment: &Experiment) -> Result<Summary, ExperimentError> {
    let (model, times) = steady_field(experiment)?;
    Ok(summary(experiment.length(), &model, times))
}

/// Fields before the first picture behind the warm-up: the warm-up's, one in which the host's first view is under way, and
/// the one that it is drawn in.
const FIELDS_BEFORE: u64 = WARM_UP_PICTURES as u64 + 2;

/// A field that comes too late does so always.
fn fields_needed(experiment: &Experiment) -> Option<u64> {
    let (_, times) = steady_field(experiment).ok()?;
    times.in_time.then_some(FIELDS_BEFORE + 1)
}

fn steady_field(experiment: &Experiment) -> Result<(SlatsModel, FieldTimes), ExperimentError> {
    let pipeline: Slats = pipeline_of(experiment)?;
    let scene = experiment.scene();
    let model = SlatsModel::new(experiment.config(), pipeline)?.over(scene);
    let triangles = (scene.triangles().len() + scene.spheres().len()) as f64;
    let binned = pipeline.binning == RegionBinning::Touched;
    let mut each = PerTriangle { entries: 10.0, clipped: 0.0 };
    if binned || model.gp.guard_ns > 0 {
        let loads = Load::of_views(experiment, Viewport::field(FieldParity::Even), pipeline.binning, &[0])?;
        let all = triangles.max(1.0) * loads.len() as f64;
        each.clipped = loads.iter().map(|load| load.clipped).sum::<f64>() / all;
        if binned {
            each.entries = loads.iter().map(Load::entries).sum::<f64>() / all;
        }
    }
    let times = model.field(triangles, each);
    Ok((model, times))
}

fn summary(fields: u64, model: &SlatsModel, times: FieldTimes) -> Summary {
    let pictures = fields.saturating_sub(FIELDS_BEFORE).max(1);
    let field_ms = model.field_ns * 1e-6;
    let due = model.due(times, fields);
    Summary {
        latencies_ms: std::iter::repeat_n(field_ms, if times.in_time { pictures as usize } else { 0 }).collect(),
        field_ms,
        updates_hz: due.and_then(|due| due.updates_hz(field_ms)),
        due,
        eye_latencies_ms: Samples::default(),
        eye_swap_latencies_ms: Samples::default(),
        eye_retraces: Samples::default(),
        region_copy_us: model.region_ns * 1e-3,
        first_copy_ms: length_ms(times.top),
        last_copy_ms: times.bottom.map_or(0.0, length_ms),
        copy_begins_ms: times.top.begin_ns * 1e-6,
    }
}

fn length_ms(copy: CopyTimes) -> f64 {
    (copy.end_ns - copy.begin_ns) * 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A machine for Slats with some of its numbers changed.
    fn model(gps: usize, renderers: usize, numbers: [u64; 5], split: bool) -> SlatsModel {
        let mut config = MachineConfig { n_gps: gps, n_renderers: renderers, ..MachineConfig::slats() };
        let [triangle_ns, message_ns, fifo_words, word_ns, hop_ns] = numbers;
        config.gp.triangle_ns = triangle_ns;
        config.gp.guard_ns = 3 * triangle_ns;
        config.gp.structure_ns = 5 * triangle_ns;
        config.gp.message_ns = message_ns;
        config.renderer.fifo_words = fifo_words;
        config.ring.word_ns = word_ns;
        config.ring.hop_ns = hop_ns;
        let program = if split { Slats::split() } else { Slats::whole() };
        SlatsModel::new(&config, program).expect("in range")
    }

    /// The Mig has six structures, without spheres; molecules are one, with spheres. Nothing but the processor is waited for.
    #[test]
    fn a_structure_takes_its_time_for_both_eyes() {
        let rendered_ns = |scene: &str, gp: GpTiming| {
            let machine = MachineConfig { gp, ..MachineConfig::slats() };
            let model = SlatsModel::new(&machine, Slats::whole()).expect("in range");
            let scene = pxpl5_scene::builtin(scene).expect("built in");
            model.over(&scene).field(30.0, PerTriangle { entries: 10.0, clipped: 0.0 }).rendered_ns
        };
        let published = MachineConfig::slats().gp;
        let of_code = GpTiming { structure_ns: 90_000, sphere_view_ns: 7_000, ..published };
        for (scene, expected_ns) in [("mig", 2.0 * 6.0 * 90_000.0), ("molecules", 2.0 * 97_000.0)] {
            let found_ns = rendered_ns(scene, of_code) - rendered_ns(scene, published);
            assert!((found_ns - expected_ns).abs() < 1e-3, "{scene}: {found_ns} ns");
        }
    }

    fn numbers() -> impl Strategy<Value = [u64; 5]> {
        (1_000u64..60_000, 0u64..90_000, 64u64..2_000, 10u64..200, 0u64..100)
            .prop_map(|(triangle, message, fifo, word, hop)| [triangle, message, fifo, word, hop])
    }

    proptest! {
        /// To the last bit, in any number, and where not all are of the same structure.
        #[test]
        fn machines_that_are_computed_together_are_what_they_are_alone(
            gps in 1usize..5,
            renderers in 5usize..23,
            all in proptest::collection::vec(numbers(), 1..50),
            other in 0usize..40,
            split: bool,
            triangles in 1.0f64..400.0,
            entries in 1.0f64..12.0,
            clipped in 0.0f64..1.0,
        ) {
            let of = |(i, numbers): (usize, &[u64; 5])| model(gps, renderers, *numbers, split != (i == other));
            let models: Vec<SlatsModel> = all.iter().enumerate().map(of).collect();
            let each = PerTriangle { entries, clipped };
            let alone: Vec<FieldTimes> = models.iter().map(|model| model.field(triangles, each)).collect();
            prop_assert_eq!(SlatsModel::fields(&models, triangles, each), alone);
        }
    }
}
