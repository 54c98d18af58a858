//! Slats: one field.

use super::copies::{CopyTimes, Queue, copy_all};
use super::load::Load;
use super::renderer::{Array, Commands, Cost, Fifo, later};
use crate::{pipeline_of, video_of};
use pphigs::{RegionBinning, TransformCost};
use pxpl5_geometry::Viewport;
use pxpl5_gp::GpTiming;
use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_renderer::CommandKind;
use pxpl5_run::{
    ClosedForm, DuePictures, Estimates, Experiment, ExperimentError, PictureEnd, Pipeline, Samples, Slats, Summary,
    WARM_UP_PERIODS, WARM_UP_PICTURES,
};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, PeriodNumber, RegionGrid};
use slats::CLUMP;

/// Renderers that are looked at one by one; more than there are field regions never hold one.
const MOST_RENDERERS: usize = 20;

/// Field regions of both eyes.
const REGIONS: usize = 20;

/// Slats on a machine, reduced to numbers.
#[derive(Clone, Debug)]
pub struct SlatsModel {
    fifo: Fifo,
    overhead_ns: f64,
    hop_ns: f64,
    gp: GpTiming,
    message_ns: f64,
    command: Cost,
    select: Cost,
    clear: Cost,
    region_ns: f64,
    field_ns: f64,
    /// From a retrace to the scan of the first line of the bottom regions.
    bottom_ns: f64,
    renderers: usize,
    gps: usize,
    source_channels: usize,
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
    /// Reduces a machine; the program's code is applied first.
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
            fifo: Fifo { depth_words: config.renderer.fifo_words as f64, word_ns },
            overhead_ns: config.ring.overhead_words as f64 * word_ns,
            hop_ns: config.ring.hop_ns as f64,
            gp: config.gp,
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

    /// A field in the steady state: renderers begin with the bottom regions of the field before.
    #[must_use]
    pub fn field(&self, triangles: f64, each: PerTriangle) -> FieldTimes {
        let mut arrays = [Array::busy_until(0.0); MOST_RENDERERS];
        if self.split {
            let mut queues = self.queues(|region| region >= REGIONS / 2, 0.0);
            copy_all(&mut queues[..self.renderers], self.region_ns);
            for (array, queue) in arrays.iter_mut().zip(&queues).take(self.renderers) {
                *array = Array::busy_until(queue.ready_ns);
            }
        }
        let rendered_ns = self.render(&mut arrays, triangles, each);
        let commanded_ns = rendered_ns + self.message_ns;
        let mut queues = self.queues(|region| !self.split || region < REGIONS / 2, commanded_ns);
        for (queue, array) in queues.iter_mut().zip(&arrays) {
            queue.ready_ns = queue.ready_ns.max(array.free_ns);
        }
        let top = copy_all(&mut queues[..self.renderers], self.region_ns);
        let bottom = self.split.then(|| self.bottom(&queues, commanded_ns + self.message_ns));
        let bottom_in_time = bottom.is_none_or(|times| times.end_ns <= self.field_ns + self.bottom_ns);
        FieldTimes { rendered_ns, top, bottom, in_time: top.end_ns <= self.field_ns && bottom_in_time }
    }

    fn bottom(&self, tops: &[Queue; MOST_RENDERERS], prepared_ns: f64) -> CopyTimes {
        let mut queues = self.queues(|region| region >= REGIONS / 2, self.field_ns.max(prepared_ns));
        for (queue, top) in queues.iter_mut().zip(tops) {
            queue.ready_ns = queue.ready_ns.max(top.ready_ns);
        }
        copy_all(&mut queues[..self.renderers], self.region_ns)
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

    /// Copies of the regions for which `wanted` holds; the commands go out one after the other from `from_ns` on.
    fn queues(&self, wanted: impl Fn(usize) -> bool, from_ns: f64) -> [Queue; MOST_RENDERERS] {
        let mut queues: [Queue; MOST_RENDERERS] = std::array::from_fn(|_| Queue::default());
        let per_half = REGIONS / 4;
        // Left and right eye by turns; the odd renderers of a split copy begin right.
        let regions = (0..REGIONS).zip((0..self.renderers).cycle());
        for (region, renderer) in regions.filter(|(region, _)| wanted(*region)) {
            let right = (region / per_half) % 2 == 1;
            queues[renderer].push(u8::from(right));
        }
        let each_ns = self.overhead_ns + 2.0 * 11.0 * self.fifo.word_ns;
        for (index, queue) in queues.iter_mut().enumerate().take(self.renderers) {
            if self.split && index % 2 == 1 {
                queue.boards[..queue.len].reverse();
            }
            queue.ready_ns = from_ns + each_ns * (index + 1) as f64;
        }
        queues
    }

    /// TRANSFORM and RENDER: clumps of all GPs by turns; when the last one was accepted.
    fn render(&self, arrays: &mut [Array; MOST_RENDERERS], triangles: f64, each: PerTriangle) -> f64 {
        let share = triangles / self.gps as f64;
        let clumps = (share / CLUMP as f64).ceil().max(1.0) as usize;
        let mut chain = Chain { released_ns: [0.0; MOST_RENDERERS], accepted_ns: 0.0, draining_ns: 0.0 };
        let mut cpu_ns = TransformCost { passes: 1.0, ..TransformCost::default() }.ns(&self.gp);
        for clump in 0..clumps {
            let count = (share - (clump * CLUMP) as f64).min(CLUMP as f64);
            // The one clump buffer is written again when all renderers have begun with what was in it.
            cpu_ns = cpu_ns.max(chain.draining_ns) + self.clump_ns(count, each);
            cpu_ns = cpu_ns.max(chain.accepted_ns) + self.message_ns;
            self.send(arrays, &mut chain, cpu_ns, count * each.entries / 10.0, clump == 0);
        }
        chain.accepted_ns
    }

    /// TRANSFORM of a clump of so many triangles for both eyes.
    fn clump_ns(&self, triangles: f64, each: PerTriangle) -> f64 {
        let both_eyes = 2.0 * triangles;
        let [entries, clipped] = [each.entries, each.clipped].map(|n| both_eyes * n);
        TransformCost { triangles: both_eyes, entries, clipped, ..TransformCost::default() }.ns(&self.gp)
    }

    /// The messages of one clump of every GP, as many at a time as a port drives channels.
    fn send(&self, arrays: &mut [Array; MOST_RENDERERS], chain: &mut Chain, from_ns: f64, count: f64, first: bool) {
        let mut channels = Channels::new(self.source_channels);
        let mut granted_ns = from_ns;
        let of_first = self.commands(count, first);
        let of_others = self.commands(count, false);
        chain.accepted_ns = from_ns;
        // A round is a region of every renderer.
        for round in (0..REGIONS).step_by(self.renderers) {
            let renderers = arrays.iter_mut().zip(&mut chain.released_ns).take(self.renderers.min(REGIONS - round));
            for (renderer, (array, released_ns)) in renderers.enumerate() {
                let latency_ns = self.hop_ns * (renderer + self.gps) as f64;
                granted_ns = later(later(granted_ns, channels.take_first()), *released_ns);
                let mut accepted_ns = array.take(granted_ns + self.overhead_ns + latency_ns, &of_first);
                *released_ns = accepted_ns - latency_ns;
                channels.put(*released_ns);
                chain.accepted_ns = later(chain.accepted_ns, accepted_ns);
                // Several GPs share the ports of the renderers: their messages follow each other.
                for _ in 1..self.gps {
                    let begin_ns = later(granted_ns, *released_ns);
                    accepted_ns = array.take(begin_ns + self.overhead_ns + latency_ns, &of_others);
                    *released_ns = accepted_ns - latency_ns;
                    chain.accepted_ns = later(chain.accepted_ns, accepted_ns);
                }
            }
            if round == 0 {
                chain.draining_ns = chain.accepted_ns;
            }
        }
    }

    fn commands(&self, count: f64, clearing: bool) -> Commands {
        let clear = if clearing { self.clear } else { Cost::default() };
        let head = Cost { words: self.select.words + clear.words, ns: self.select.ns + clear.ns };
        Commands::new(self.fifo, head, count, self.command)
    }
}

/// Messages of clumps on their way.
struct Chain {
    /// When each renderer's port was free again.
    released_ns: [f64; MOST_RENDERERS],
    /// When the last message of the last clump was accepted.
    accepted_ns: f64,
    /// When every renderer had accepted its first message of that clump.
    draining_ns: f64,
}

/// Channels that a ring can have; a power of two.
const MOST_CHANNELS: usize = 8;

/// When the channels of a port are free, soonest first, from a place on that goes round.
struct Channels {
    free_ns: [f64; MOST_CHANNELS],
    first: usize,
    number: usize,
}

impl Channels {
    const fn new(number: usize) -> Self {
        Self { free_ns: [f64::MIN; MOST_CHANNELS], first: 0, number }
    }

    fn take_first(&mut self) -> f64 {
        self.first += 1;
        self.free_ns[(self.first - 1) % MOST_CHANNELS]
    }

    /// Gives the channel that was taken back. It is nearly always the last one to be free.
    fn put(&mut self, free_ns: f64) {
        let mut place = self.first + self.number - 1;
        while place > self.first && self.free_ns[(place - 1) % MOST_CHANNELS] > free_ns {
            self.free_ns[place % MOST_CHANNELS] = self.free_ns[(place - 1) % MOST_CHANNELS];
            place -= 1;
        }
        self.free_ns[place % MOST_CHANNELS] = free_ns;
    }
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
    let model = SlatsModel::new(experiment.config(), pipeline)?;
    let scene = experiment.scene();
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
