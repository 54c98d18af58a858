//! Closed form of Rendering Control, which computes the times of one frame after the other.

use super::load::Load;
use super::renderer::Cost;
use crate::{no_form, pipeline_of, video_of};
use pphigs::{BIN_ENTRY_BYTES, RegionBinning, Shading, TransformCost};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{GpTiming, HostTiming};
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::CommandKind;
use pxpl5_run::{
    ClosedForm, DuePictures, Estimates, Experiment, ExperimentError, PictureResult, Pipeline, RenderingControl,
    Samples, Summary, WARM_UP_PICTURES, retraces,
};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Time, mix};
use pxpl5_wire::{MAX_MESSAGE_WORDS, PeriodNumber, RegionGrid, RegionId};

/// Number of slaves from which the closed form holds for any number of renderers. With fewer slaves, it holds for fewer
/// than [`MAX_RENDERERS_A_SLAVE`] renderers for each slave. Measured with `typical:2000` on 1 to 8 slaves and 2 to 24
/// renderers: the rate is then at most 10 % too high, and up to 37 % beyond.
const FEW_SLAVES: usize = 3;
const MAX_RENDERERS_A_SLAVE: usize = 4;

/// Number of words of a message between master and slaves, such as a token.
const ORDER_WORDS: f64 = 6.0;

/// The parameters that determine the times of Rendering Control on a machine.
#[derive(Clone, Debug)]
pub struct StereoModel {
    eyes: usize,
    slaves: f64,
    renderers: usize,
    gp: GpTiming,
    message_ns: f64,
    host_ns: f64,
    host: HostTiming,
    word_ns: f64,
    overhead_ns: f64,
    hop_ns: f64,
    clear: Cost,
    triangle: Cost,
    sphere: Cost,
    shade: Cost,
    copy_words: f64,
    fifo_words: f64,
    store_ns: f64,
    backing_regions: usize,
    /// Number of finished regions that a renderer can store while the frame buffer is not available.
    regions_stored: usize,
    field_ns: f64,
    /// Time for which the pixels of each region occupy a port of the frame buffer, in nanoseconds.
    copy_ns: Vec<f64>,
}

/// Times of one frame, in nanoseconds from the start of the machine.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StereoTimes {
    /// Start of each eye's TRANSFORM.
    pub transform_ns: [f64; 2],
    /// Times of the first word of the first copy and of the last word of the last copy of each eye's picture.
    pub copy_ns: [(f64, f64); 2],
    /// Time of the retrace at which the frame is first shown.
    pub shown_ns: f64,
}

impl StereoTimes {
    fn copy_length_ns(&self, eye: usize) -> f64 {
        self.copy_ns[eye].1 - self.copy_ns[eye].0
    }
}

fn mean_ms(frames: &[&StereoTimes], ns: impl Fn(&StereoTimes) -> f64) -> f64 {
    frames.iter().map(|frame| ns(frame)).sum::<f64>() / frames.len().max(1) as f64 * 1e-6
}

#[derive(Debug, Default)]
struct History {
    transformed: Vec<f64>,
    rendered: Vec<f64>,
    copied: Vec<f64>,
    /// Size of the bins of the previous picture on one slave, in bytes.
    bin_bytes: f64,
    /// Time between the instants at which the first and the last slave have sent all bins of the previous picture.
    first_free_ns: f64,
    edited_ns: f64,
    swapped_ns: f64,
    rendering: Renderers,
}

#[derive(Debug, Default)]
struct Renderers {
    /// Time from which the master can give each renderer its next region.
    idle_ns: Vec<f64>,
    /// Time at which each renderer has executed all commands so far.
    free_ns: Vec<f64>,
    /// Times at which the regions of each renderer were copied to the frame buffer.
    sent_ns: Vec<Vec<f64>>,
    /// Times until which the backing store of each renderer holds finished regions.
    stored_until_ns: Vec<Vec<f64>>,
    words: Vec<f64>,
    /// Three values for each of the latest regions of each renderer: the number of words before the region, the start
    /// of its first command, and the cost of its commands.
    started: Vec<Vec<(f64, f64, Cost)>>,
    ports_ns: [f64; 2],
}

fn back(times: &[f64], picture: usize, by: usize) -> f64 {
    picture.checked_sub(by).and_then(|i| times.get(i)).copied().unwrap_or(0.0)
}

fn copy_ns(grid: RegionGrid, region: RegionId, word_ns: f64, overhead_ns: f64) -> f64 {
    let [_, _, width, height] = grid.rectangle(region);
    let pixels = width * height;
    f64::from(pixels) * word_ns + f64::from(pixels.div_ceil(MAX_MESSAGE_WORDS)) * overhead_ns
}

impl StereoModel {
    /// Derives the parameters from the configuration of a machine.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the machine has no slaves, or if the closed form does not cover the machine.
    pub fn new(config: &MachineConfig, program: RenderingControl) -> Result<Self, SettingError> {
        if config.n_gps < 2 {
            return Err(SettingError::limits(
                "n_gps of Rendering Control (a master and slaves)",
                (2, 1_000),
                config.n_gps,
            ));
        }
        // One or two slaves are busy without a break. Each region costs them time that the closed form leaves out, and
        // with more renderers a frame has more regions at a time.
        let slaves = config.n_gps - 1;
        if slaves < FEW_SLAVES && config.n_renderers >= MAX_RENDERERS_A_SLAVE * slaves {
            return Err(no_form(&format!(
                "Rendering Control with {slaves} slaves and {} renderers, where its rate would be more than 10 % too high \
                 (expected {FEW_SLAVES} slaves, or fewer than {MAX_RENDERERS_A_SLAVE} renderers for each)",
                config.n_renderers
            )));
        }
        // Timing of messages and commands.
        let video = video_of(config)?;
        let phong = program.shading == Shading::Phong;
        let word_ns = config.ring.word_ns as f64;
        let overhead_ns = config.ring.overhead_words as f64 * word_ns;
        let grid = RegionGrid::FRAME;
        let regions = (0..grid.regions() as u16).map(RegionId);
        let kinds = if phong {
            [CommandKind::PhongTriangle, CommandKind::PhongSphere]
        } else {
            [CommandKind::Triangle, CommandKind::Sphere]
        };
        let [triangle, sphere] = kinds.map(|kind| Cost::of_command(&config.renderer, kind));
        let shade = Cost::of_command(&config.renderer, CommandKind::Shade);
        Ok(Self {
            eyes: program.properties().eyes,
            slaves: (config.n_gps - 1) as f64,
            renderers: config.n_renderers,
            gp: config.gp,
            message_ns: config.gp.message_ns as f64,
            host: config.host,
            host_ns: config.host.message_ns as f64 * 2.0 + config.host.link_span(100).as_ms() * 1e6,
            word_ns,
            overhead_ns,
            hop_ns: config.ring.hop_ns as f64,
            clear: Cost::of_command(&config.renderer, CommandKind::Clear),
            triangle,
            sphere,
            shade: if phong { shade } else { Cost::default() },
            copy_words: f64::from(CommandKind::CopyRegion.words()),
            fifo_words: config.renderer.fifo_words as f64,
            backing_regions: config.renderer.backing_regions() as usize,
            regions_stored: program.finished.stored(config.renderer.backing_regions()) as usize,
            store_ns: config.renderer.backing_block().as_ms() * 1e6,
            field_ns: video.retrace(PeriodNumber(1)).since(Time::ZERO).as_ms() * 1e6,
            copy_ns: regions.map(|region| copy_ns(grid, region, word_ns, overhead_ns)).collect(),
        })
    }

    /// Returns the times of successive frames. `loads` has the work for each eye of each frame.
    pub fn frames(&self, loads: &[Load]) -> Vec<StereoTimes> {
        let mut history = History::default();
        history.rendering.idle_ns = vec![0.0; self.renderers];
        history.rendering.free_ns = vec![0.0; self.renderers];
        history.rendering.sent_ns = vec![Vec::new(); self.renderers];
        history.rendering.stored_until_ns = vec![Vec::new(); self.renderers];
        history.rendering.words = vec![0.0; self.renderers];
        history.rendering.started = vec![Vec::new(); self.renderers];
        loads.chunks(self.eyes).enumerate().map(|(frame, eyes)| self.frame(&mut history, frame, eyes)).collect()
    }

    fn transit_ns(&self) -> f64 {
        self.overhead_ns + ORDER_WORDS * self.word_ns + self.hop_ns * self.slaves / 2.0
    }

    /// Returns the time of a message from one processor to another, including the software on both sides, in
    /// nanoseconds.
    fn order_ns(&self) -> f64 {
        2.0 * self.message_ns + self.transit_ns()
    }

    fn frame(&self, history: &mut History, frame: usize, eyes: &[Load]) -> StereoTimes {
        let mut times = StereoTimes::default();
        let first = frame * self.eyes;
        // SEND begins after two events: the host receives the end of the previous EDIT, and the host's application
        // finishes.
        let application_ns = self.host.application_span(mix(frame as u64)).as_ms() * 1e6;
        let sent_ns = history.edited_ns + self.order_ns() + application_ns + self.host_ns;
        // EDIT of the first eye also waits until earlier pictures have passed TRANSFORM, RENDER and COPY.
        let ready =
            [back(&history.transformed, first, 1), back(&history.rendered, first, 2), back(&history.copied, first, 3)];
        let mut begin_ns = ready.into_iter().fold(sent_ns, f64::max) + self.order_ns();
        for (eye, load) in eyes.iter().enumerate() {
            let picture = first + eye;
            if eye == 0 {
                history.edited_ns = begin_ns + self.transit_ns() + self.slaves * self.message_ns;
            } else {
                let ready = [back(&history.rendered, picture, 2), back(&history.copied, picture, 3), history.edited_ns];
                begin_ns = begin_ns.max(ready.into_iter().fold(0.0, f64::max) + self.order_ns());
            }
            // TRANSFORM waits if the bins of two pictures do not fit.
            let bin_bytes = self.bin_bytes(load);
            times.transform_ns[eye] = begin_ns;
            if history.bin_bytes + bin_bytes > self.gp.bin_bytes as f64 {
                let freed_ns = back(&history.rendered, picture, 1);
                times.transform_ns[eye] = begin_ns.max(freed_ns - history.first_free_ns);
                begin_ns = begin_ns.max(freed_ns);
            }
            history.bin_bytes = bin_bytes;
            history.first_free_ns = self.first_free_ns(load);
            begin_ns += self.transform_ns(load);
            // The master receives the answers of all slaves one after the other.
            let known_ns = begin_ns + self.message_ns + self.transit_ns() + self.slaves * self.message_ns;
            history.transformed.push(known_ns);
            // COPY needs the frame buffer, and the completed COPY of the previous eye.
            let available_ns = history.swapped_ns.max(back(&history.copied, picture, 1));
            let start_ns = known_ns.max(back(&history.rendered, picture, 1));
            let (rendered_ns, copy) = self.render(&mut history.rendering, load, eye, start_ns, available_ns);
            history.rendered.push(rendered_ns);
            history.copied.push(copy.1 + self.transit_ns() + self.message_ns);
            times.copy_ns[eye] = copy;
        }
        let requested_ns = history.copied[history.copied.len() - 1] + self.message_ns + self.transit_ns();
        times.shown_ns = (requested_ns.max(history.swapped_ns + 1.0) / self.field_ns).ceil() * self.field_ns;
        history.swapped_ns = times.shown_ns;
        times
    }

    /// Returns the number of bin entries of the slave with the most primitives.
    fn entries(&self, load: &Load) -> f64 {
        let primitives = self.largest_share(load.triangles) + self.largest_share(load.spheres);
        load.entries() * primitives / (load.triangles + load.spheres).max(1.0)
    }

    fn bin_bytes(&self, load: &Load) -> f64 {
        self.entries(load) * BIN_ENTRY_BYTES as f64
    }

    /// Returns the time between the instants at which the first and the last slave have sent all their bins of a
    /// picture.
    ///
    /// A region's token starts at one slave and moves from slave to slave as fast as renderers accept commands. With
    /// fewer renderers than slaves, some slaves finish early. The first slave finishes when each token has visited as
    /// many slaves as there are renderers.
    fn first_free_ns(&self, load: &Load) -> f64 {
        let drawing_ns = load.entries() / load.bins.len().max(1) as f64 * self.triangle.ns;
        drawing_ns * (1.0 - self.renderers as f64 / self.slaves).max(0.0)
    }

    /// Returns the time of TRANSFORM on the slave with the most primitives, in nanoseconds.
    fn transform_ns(&self, load: &Load) -> f64 {
        let triangles = self.largest_share(load.triangles);
        let spheres = self.largest_share(load.spheres);
        let clipped = load.clipped * triangles / load.triangles.max(1.0);
        let Load { structures, sphere_views, .. } = *load;
        let entries = self.entries(load);
        TransformCost { passes: 1.0, structures, sphere_views, triangles, spheres, clipped, entries }.ns(&self.gp)
    }

    fn largest_share(&self, primitives: f64) -> f64 {
        (primitives / self.slaves).ceil()
    }

    /// Computes RENDER and COPY of one eye.
    ///
    /// Returns the time at which the master receives the report of the last accepted command. Also returns the times of
    /// the first and the last copied word.
    fn render(
        &self,
        all: &mut Renderers,
        load: &Load,
        eye: usize,
        start_ns: f64,
        available_ns: f64,
    ) -> (f64, (f64, f64)) {
        // The heaviest regions go first.
        let mut regions: Vec<usize> = (0..load.bins.len()).collect();
        regions.sort_by(|a, b| load.primitives_in(*b).total_cmp(&load.primitives_in(*a)));
        let mut rendered_ns = start_ns;
        let mut copy = (f64::INFINITY, 0.0_f64);
        let mut master_ns = start_ns;
        for region in regions {
            // Send the token to the renderer that is idle first.
            let r = earliest(&all.idle_ns);
            let token_ns = master_ns.max(all.idle_ns[r]).max(start_ns) + self.message_ns;
            master_ns = token_ns;
            let walk_ns = self.walk_ns(&load.bins[region]);
            let arrived_ns = token_ns + self.transit_ns() + walk_ns;
            let (accepted_ns, executed_ns) = self.execute(all, r, token_ns, arrived_ns, &load.bins[region]);
            let heard_ns = accepted_ns + self.transit_ns() + self.message_ns;
            rendered_ns = rendered_ns.max(heard_ns);
            // The copy begins later if the frame buffer is not available yet.
            let is_late = token_ns >= available_ns;
            all.stored_until_ns[r].retain(|until| *until > token_ns);
            let is_stored = !is_late && all.stored_until_ns[r].len() < self.regions_stored;
            let ordered_ns = if is_late { 0.0 } else { available_ns + self.order_ns() };
            let ready_ns = if is_stored { executed_ns } else { executed_ns.max(ordered_ns) };
            if is_stored {
                all.stored_until_ns[r].push(available_ns);
            }
            let waits = !is_late && !is_stored;
            all.idle_ns[r] = if waits { heard_ns.max(available_ns + self.message_ns) } else { heard_ns };
            // Finished regions go to the backing store, which holds a few regions, and from there to the frame buffer,
            // one by one.
            all.free_ns[r] =
                ready_ns.max(back(&all.sent_ns[r], all.sent_ns[r].len(), self.backing_regions)) + self.store_ns;
            let sent_ns = all.sent_ns[r].last().copied().unwrap_or(0.0);
            let begin_ns = all.free_ns[r].max(ordered_ns).max(sent_ns).max(all.ports_ns[eye]);
            all.ports_ns[eye] = begin_ns + self.copy_ns[region];
            all.sent_ns[r].push(all.ports_ns[eye]);
            copy = (copy.0.min(begin_ns), copy.1.max(all.ports_ns[eye]));
        }
        (rendered_ns, copy)
    }

    /// Returns the time in which a region's token visits all slaves, in nanoseconds.
    fn walk_ns(&self, bin: &[f64; 2]) -> f64 {
        let senders = (bin[0] + bin[1]).min(self.slaves).max(2.0_f64.min(self.slaves));
        let handed_over_ns = self.gp.token_entry_ns as f64 * (bin[0] + bin[1]);
        self.slaves * (2.0 * self.message_ns + self.transit_ns()) + senders * self.message_ns + handed_over_ns
    }

    /// Returns two times: when the renderer has accepted the last word of a region, and when the renderer has executed
    /// all commands.
    fn execute(&self, all: &mut Renderers, r: usize, token_ns: f64, arrived_ns: f64, bin: &[f64; 2]) -> (f64, f64) {
        let [triangles, spheres] = *bin;
        // Commands of the region: clear, draw, shade and copy.
        let drawing_ns = triangles * self.triangle.ns + spheres * self.sphere.ns;
        let drawing_words = triangles * self.triangle.words + spheres * self.sphere.words;
        let words = self.clear.words + drawing_words + self.shade.words + self.copy_words;
        // The first word follows the token through two message routines.
        let first_ns = token_ns + self.transit_ns() + 2.0 * self.message_ns;
        let start_ns = first_ns.max(all.free_ns[r]);
        let rate = Cost { words: words.max(1.0), ns: self.clear.ns + drawing_ns };
        all.started[r].push((all.words[r], start_ns, rate));
        all.words[r] += words;
        // The last word enters when it has arrived and the FIFO has room.
        let wire_ns = arrived_ns.max(first_ns + words * self.word_ns);
        let accepted_ns = wire_ns.max(self.room_ns(all, r));
        let last_ns = if triangles > 0.0 { self.triangle.ns } else { self.clear.ns };
        let executed_ns = (start_ns + self.clear.ns + drawing_ns).max(accepted_ns + last_ns) + self.shade.ns;
        (accepted_ns, executed_ns)
    }

    /// Returns the time at which the FIFO has room for the last word.
    ///
    /// At this time, the command starts whose words lie one FIFO depth before the last word.
    fn room_ns(&self, all: &mut Renderers, r: usize) -> f64 {
        let word = all.words[r] - 1.0 - self.fifo_words;
        let started = &mut all.started[r];
        while started.len() > 1 && started[1].0 <= word {
            started.remove(0);
        }
        let (before, start_ns, rate) = started[0];
        if word < before { f64::MIN } else { start_ns + (word - before) / rate.words * rate.ns }
    }
}

fn earliest(times: &[f64]) -> usize {
    (1..times.len()).fold(0, |best, i| if times[i] < times[best] { i } else { best })
}

/// Returns the work of a scene for both eyes, frame after frame. A new frame begins at every second field.
///
/// # Errors
///
/// Returns [`ExperimentError::Scene`] if the scene has no primitives.
pub fn stereo_loads(experiment: &Experiment) -> Result<Vec<Load>, ExperimentError> {
    let still = experiment.scene().structures().iter().all(|s| s.frame == pxpl5_scene::Frame::Head);
    let frames = (experiment.fields / 2).max(1);
    let video = video_of(experiment.config())?;
    let times: Vec<u64> =
        if still { vec![0] } else { (0..frames).map(|frame| video.retrace(PeriodNumber(2 * frame)).0).collect() };
    let mut loads = Load::of_views(experiment, Viewport::FRAME, RegionBinning::Touched, &times)?;
    while (loads.len() as u64) < 2 * frames {
        loads.extend_from_within(0..2);
    }
    Ok(loads)
}

pub(super) const CLOSED_FORM: ClosedForm =
    ClosedForm { summary: closed_form, estimates: Estimates { fields_needed, primitives_in_time } };

fn primitives_in_time(experiment: &Experiment) -> Option<u64> {
    crate::primitives_in_time(experiment, closed_form)
}

fn closed_form(experiment: &Experiment) -> Result<Summary, ExperimentError> {
    let (model, frames) = frames_of(experiment)?;
    Ok(model.summary(&frames, experiment.fields))
}

fn fields_needed(experiment: &Experiment) -> Option<u64> {
    let first_frames = experiment.clone().fields(2 * (WARM_UP_PICTURES as u64 + 1));
    let (model, frames) = frames_of(&first_frames).ok()?;
    let frame = frames.get(WARM_UP_PICTURES)?;
    Some((frame.shown_ns / model.field_ns).round() as u64 + 1)
}

fn frames_of(experiment: &Experiment) -> Result<(StereoModel, Vec<StereoTimes>), ExperimentError> {
    let pipeline: RenderingControl = pipeline_of(experiment)?;
    let model = StereoModel::new(experiment.config(), pipeline)?;
    let mut loads = stereo_loads(experiment)?;
    if pipeline.mono {
        loads = loads.into_iter().step_by(2).collect();
    }
    let frames = model.frames(&loads);
    Ok((model, frames))
}

impl StereoModel {
    /// Returns the results for the frames that are shown in the first `fields` fields, without the warm-up.
    pub fn summary(&self, frames: &[StereoTimes], fields: u64) -> Summary {
        // Frames of the warm-up do not count.
        let end_ns = fields as f64 * self.field_ns;
        let shown: Vec<_> = frames.iter().filter(|frame| frame.shown_ns < end_ns).skip(WARM_UP_PICTURES).collect();
        let due = self.due(frames, fields);
        let field_ms = self.field_ns * 1e-6;
        let of_eyes = |end: fn(&StereoTimes, usize) -> f64| -> Samples {
            let eyes = shown.iter().flat_map(|frame| (0..self.eyes).map(move |eye| (frame, eye)));
            eyes.map(|(frame, eye)| (end(frame, eye) - frame.transform_ns[eye]) * 1e-6).collect()
        };
        let eye_swap_latencies_ms = of_eyes(|frame, _| frame.shown_ns);
        Summary {
            latencies_ms: shown.iter().map(|frame| (frame.shown_ns - frame.transform_ns[0]) * 1e-6).collect(),
            field_ms,
            updates_hz: due.and_then(|due| due.updates_hz(field_ms)),
            due,
            eye_latencies_ms: of_eyes(|frame, eye| frame.copy_ns[eye].1),
            eye_retraces: eye_swap_latencies_ms.iter().map(|ms| retraces(*ms, field_ms)).collect(),
            eye_swap_latencies_ms,
            region_copy_us: self.copy_ns.iter().sum::<f64>() / self.copy_ns.len() as f64 * 1e-3,
            first_copy_ms: mean_ms(&shown, |frame| frame.copy_length_ns(0)),
            last_copy_ms: if self.eyes > 1 { mean_ms(&shown, |frame| frame.copy_length_ns(1)) } else { 0.0 },
            copy_begins_ms: mean_ms(&shown, |frame| frame.copy_ns[0].0 - frame.transform_ns[0]),
        }
    }

    /// Counts the frames that are due and shown. Frames are due at the rate at which the pixels of all eyes can be
    /// copied.
    fn due(&self, frames: &[StereoTimes], fields: u64) -> Option<DuePictures> {
        let every = (self.eyes as f64 * self.copy_ns.iter().sum::<f64>() / self.field_ns).ceil() as u64;
        let field_of = |frame: &StereoTimes| PeriodNumber((frame.shown_ns / self.field_ns).round() as u64);
        // Frames after the last computed frame are unknown.
        let computed_to =
            frames.last().map_or(PeriodNumber::FIRST, |last| field_of(last).next()).min(PeriodNumber(fields));
        DuePictures::count(frames.iter().map(|frame| (field_of(frame), PictureResult::Shown)), every, computed_to)
    }
}
