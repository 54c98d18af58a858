//! Closed form of Slats, which computes the times of one field.

use super::clumps;
use super::copies::{self, CopyTimes, MAX_RENDERERS, Queue};
use super::model::{FieldTimes, PerTriangle, REGIONS, SlatsModel};
use super::renderer::{Array, Times};
use super::senders::{self, Clumps};
use crate::{no_form, pipeline_of};
use multiversion::multiversion;
use pphigs::RegionBinning;
use pxpl5_run::{
    ClosedForm, Estimates, Experiment, ExperimentError, Slats, Summary, WARM_UP_PERIODS, WARM_UP_PICTURES,
};
use slats::CopySchedule;

impl SlatsModel {
    /// Returns the times of a field after many equal fields. With split copies, renderers first copy the lower half of
    /// the previous field.
    pub fn field(&self, triangles: f64, each: PerTriangle) -> FieldTimes {
        if self.gps > 1 {
            return self.field_of(&Clumps::uniform(self, triangles, each));
        }
        let [times] = fields_at_once(std::array::from_ref(self), triangles, each);
        times
    }

    fn field_of(&self, clumps: &Clumps) -> FieldTimes {
        let models = std::array::from_ref(self);
        let mut arrays = [Array::idle(); MAX_RENDERERS];
        let arrays = &mut arrays[..self.renderers];
        let bottom = begin(models, arrays);
        let done = senders::render(self, arrays, clumps).map(Times::all);
        let [times] = end(models, arrays, done, bottom);
        times
    }

    /// Returns the times of a field for each of many machines, identical to the results of [`field`](Self::field).
    ///
    /// For speed, sixteen successive machines are computed together if they have one graphics processor, equal numbers
    /// of renderers and channels, and the same program.
    pub fn fields(models: &[Self], triangles: f64, each: PerTriangle) -> Vec<FieldTimes> {
        let mut all = Vec::with_capacity(models.len());
        for some in models.chunks(TOGETHER) {
            match <&[Self; TOGETHER]>::try_from(some) {
                Ok(some) if some.iter().all(|model| model.gps == 1 && model.structure() == some[0].structure()) => {
                    all.extend(fields_together(some, triangles, each));
                }
                _ => all.extend(some.iter().map(|model| model.field(triangles, each))),
            }
        }
        all
    }
}

/// Number of machines that are computed together. Their times fill two registers of 512 bits.
///
/// Each step of the computation depends on the previous step, so two registers take little more time than one.
const TOGETHER: usize = 16;

/// Computes `fields_at_once` with the widest vector instructions of the host.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn fields_together(models: &[SlatsModel; TOGETHER], triangles: f64, each: PerTriangle) -> [FieldTimes; TOGETHER] {
    fields_at_once(models, triangles, each)
}

/// Returns the times of a field on `N` machines. Each machine has one graphics processor, and all machines have equal
/// values of [`SlatsModel::structure`].
#[inline(always)]
fn fields_at_once<const N: usize>(models: &[SlatsModel; N], triangles: f64, each: PerTriangle) -> [FieldTimes; N] {
    let mut arrays = [Array::idle(); MAX_RENDERERS];
    let arrays = &mut arrays[..models[0].renderers];
    let bottom = begin(models, arrays);
    let done = clumps::render(models, arrays, triangles, each);
    end(models, arrays, done, bottom)
}

fn of_previous(model: &SlatsModel) -> [Queue; MAX_RENDERERS] {
    model.layout(|region| region >= REGIONS / 2)
}

/// Copies of the lower half of the previous field.
struct Before<const N: usize> {
    /// Times from which the ports of the two frame buffers are free.
    free: [Times<N>; 2],
    /// Time at which each renderer has made its copies.
    ends: [Times<N>; MAX_RENDERERS],
}

/// With split copies, makes the renderers first copy the lower half of the previous field.
#[inline(always)]
fn begin<const N: usize>(models: &[SlatsModel; N], arrays: &mut [Array<N>]) -> Before<N> {
    let mut before = Before { free: [Times::all(f64::MIN); 2], ends: [Times::all(f64::MIN); MAX_RENDERERS] };
    if models[0].split {
        copy(models, arrays, Times::all(0.0), &of_previous(&models[0]), &mut before.free);
        arrays.iter().zip(&mut before.ends).for_each(|(array, end)| *end = array.free);
    }
    before
}

/// Computes the copies of a field. `rendered` is the time at which the renderers have accepted all triangles. `cpu` is
/// the time at which the first graphics processor ends its work.
#[inline(always)]
fn end<const N: usize>(
    models: &[SlatsModel; N],
    arrays: &mut [Array<N>],
    [rendered, cpu]: [Times<N>; 2],
    Before { mut free, ends }: Before<N>,
) -> [FieldTimes; N] {
    let is_split = models[0].split;
    let of_top = models[0].layout(|region| !is_split || region < REGIONS / 2);
    let of_bottom = models[0].layout(|region| is_split && region >= REGIONS / 2);
    let message = Times::each(|i| models[i].message_ns);
    // The copy commands are prepared while the clumps are sent, and follow them.
    let ordered = rendered.later(cpu + message);
    let mut ready = [Times::all(f64::MAX); MAX_RENDERERS];
    arrays.iter().enumerate().for_each(|(r, array)| ready[r] = commanded(models, ordered, r).later(array.free));
    let mut top = copy(models, arrays, ordered, &of_top, &mut free);
    // A renderer may be ready for its top regions before another one asks for its last bottom region.
    for i in 0..N {
        let lane = |times: &[Times<N>; MAX_RENDERERS]| times.map(|time| time.0[i]);
        let (ready, ends) = (lane(&ready), lane(&ends));
        let last = ends.into_iter().fold(f64::MIN, f64::max) - models[i].region_ns;
        if is_split && ready.into_iter().fold(f64::MAX, f64::min) < last {
            let (model, ns) = (&models[i], [models[i].copy_order_ns(), models[i].region_ns]);
            top[i] = copies::overtaking(model.renderers, ns, [of_previous(model), of_top], ready, ends);
        }
    }
    // No closure here: a closure that is not inlined would lack the vector instructions.
    let bottom = if is_split {
        let retrace = Times::each(|i| models[i].field_ns);
        Some(copy(models, arrays, retrace.later(ordered + message), &of_bottom, &mut free))
    } else {
        None
    };
    std::array::from_fn(|i| models[i].times(rendered.0[i], top[i], bottom.map(|times| times[i])))
}

/// Copies regions to the frame buffers. From the time `from` on, the renderers receive their copy commands one after
/// the other.
#[inline(always)]
fn copy<const N: usize>(
    models: &[SlatsModel; N],
    arrays: &mut [Array<N>],
    from: Times<N>,
    queues: &[Queue; MAX_RENDERERS],
    free: &mut [Times<N>; 2],
) -> [CopyTimes; N] {
    for (renderer, array) in arrays.iter_mut().enumerate() {
        array.free = commanded(models, from, renderer).later(array.free);
    }
    copies::make(arrays, queues, Times::each(|i| models[i].region_ns), free)
}

/// Returns the time at which a renderer has received its copy commands, if the first renderer's are sent at `from`.
#[inline(always)]
fn commanded<const N: usize>(models: &[SlatsModel; N], from: Times<N>, renderer: usize) -> Times<N> {
    from + Times::each(|i| models[i].copy_order_ns()) * Times::all((renderer + 1) as f64)
}

pub(super) const CLOSED_FORM: ClosedForm =
    ClosedForm { summary: closed_form, estimates: Estimates { fields_needed, primitives_in_time } };

fn primitives_in_time(experiment: &Experiment) -> Option<u64> {
    let of_one = |experiment: &Experiment| -> Result<Summary, ExperimentError> {
        let (model, times) = steady_field(experiment)?;
        Ok(summary(experiment.fields, &model, times))
    };
    crate::primitives_in_time(experiment, of_one)
}

fn closed_form(experiment: &Experiment) -> Result<Summary, ExperimentError> {
    let (model, times) = steady_field(experiment)?;
    // All fields are equal here, and with a backup a late field delays others.
    if !times.in_time && pipeline_of::<Slats>(experiment)?.copy == CopySchedule::Backup {
        return Err(no_form("late fields with copy = backup").into());
    }
    Ok(summary(experiment.fields, &model, times))
}

/// Number of fields before the first evaluated picture. In two of these fields, the host's first view is sent and
/// drawn.
const FIELDS_BEFORE: u64 = WARM_UP_PERIODS;
const _: () = assert!(FIELDS_BEFORE >= WARM_UP_PICTURES as u64 + 2);

/// Returns the number of fields that an experiment needs. Returns `None` if pictures are late: all fields are equal, so
/// every picture would be late.
fn fields_needed(experiment: &Experiment) -> Option<u64> {
    let (_, times) = steady_field(experiment).ok()?;
    times.in_time.then_some(FIELDS_BEFORE + 1)
}

/// Returns the model of an experiment, and the times of a field after many equal fields.
///
/// If all clumps (groups of primitives) are equal, the computation uses the mean clump. Otherwise the computation uses
/// each clump of the first view.
fn steady_field(experiment: &Experiment) -> Result<(SlatsModel, FieldTimes), ExperimentError> {
    let pipeline: Slats = pipeline_of(experiment)?;
    let scene = experiment.scene();
    let model = SlatsModel::new(experiment.config(), pipeline)?.over(scene);
    let alike = pipeline.binning == RegionBinning::All && model.gp.guard_ns == 0 && scene.spheres().is_empty();
    let times = if alike {
        model.field(scene.triangles().len() as f64, PerTriangle { entries: 10.0, clipped: 0.0 })
    } else {
        model.field_of(&Clumps::of_scene(&model, experiment, pipeline.binning)?)
    };
    Ok((model, times))
}

fn summary(fields: u64, model: &SlatsModel, times: FieldTimes) -> Summary {
    let field_ms = model.field_ns * 1e-6;
    let due = model.due(times, fields);
    let shown = due.map_or(0, |due| due.shown);
    Summary {
        // Every shown picture has a latency of exactly one field.
        latencies_ms: std::iter::repeat_n(field_ms, shown as usize).collect(),
        field_ms,
        updates_hz: due.and_then(|due| due.updates_hz(field_ms)),
        due,
        region_copy_us: model.region_ns * 1e-3,
        first_copy_ms: length_ms(times.top),
        last_copy_ms: times.bottom.map_or(0.0, length_ms),
        copy_begins_ms: (times.top.begin_ns - model.transform_begins_ns()) * 1e-6,
        ..Summary::default()
    }
}

fn length_ms(copy: CopyTimes) -> f64 {
    (copy.end_ns - copy.begin_ns) * 1e-6
}
