//! The measured workloads and the project's own goals for them.

use crate::opengl::OpenGl;
use crate::peers::{Euc, Ours, Retrofire, views};
use crate::timing::{Fallible, Measured, Way, in_turns};
use pxpl5::{
    Experiment, Level, MachineConfig, NtscDisplay, Optimization, PeriodNumber, Pixels, RenderingControl, Slats,
    Workstation, scene, scene::Scene,
};
use pxpl5_analytic::{PerTriangle, SlatsModel};
use pxpl5_renderer::Lanes;
use std::hint::black_box;

/// A line of the table of goals.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) work: String,
    pub(crate) goal: Option<f64>,
    pub(crate) unit: &'static str,
    /// True if a larger value is better.
    pub(crate) is_rate: bool,
    pub(crate) measured: f64,
    pub(crate) spread: f64,
    /// Description of the work in README, if README shows the line.
    pub(crate) summary: Option<&'static str>,
}

impl Row {
    pub(crate) fn is_missed(&self) -> bool {
        self.goal.is_some_and(|goal| if self.is_rate { self.measured < goal } else { self.measured > goal })
    }
}

/// An optimization of the simulator with its effect.
pub(crate) struct OptimizationRow {
    pub(crate) saving: Optimization,
    pub(crate) work: &'static str,
    pub(crate) with_ms: f64,
    pub(crate) without_ms: f64,
}

/// Triangles that cover the screen. Each has an entry in every region of a field, and none is clipped.
const FULL_SCREEN: PerTriangle = PerTriangle { entries: 10.0, clipped: 0.0 };

/// NTSC fields in a second of real time.
const FIELD_HZ: f64 = 60_000.0 / 1_001.0;

fn mig(triangles: usize) -> Fallible<Scene> {
    Ok(scene::builtin("mig")?.decimated(triangles)?)
}

/// Returns a machine of the papers with the given numbers of boards, and with memory for every scene here.
fn machine(n_gps: usize, n_renderers: usize) -> MachineConfig {
    let mut config = MachineConfig { n_gps, n_renderers, ..MachineConfig::small_hmd() };
    config.gp.memory_bytes = 1 << 28;
    config.gp.bin_bytes = 1 << 28;
    config
}

fn stereo(machine: MachineConfig, scene: Scene) -> Experiment {
    Experiment::new(machine, RenderingControl::stereo(), scene).pixels(Pixels::Off).host(Workstation::with_threads(0))
}

/// Returns the scene `head` of 59,592 triangles in stereo.
pub(crate) fn head() -> Fallible<Experiment> {
    Ok(stereo(MachineConfig::small_hmd(), scene::builtin("head")?))
}

fn slats(triangles: usize) -> Fallible<Experiment> {
    let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), mig(triangles)?);
    Ok(experiment.pixels(Pixels::Off).host(Workstation::with_threads(0)))
}

/// Runs a number of fields without reading pixels, and returns this number.
fn fields(experiment: &Experiment, fields: u64) -> Fallible<f64> {
    let mut machine = experiment.build()?;
    let end = machine.record().tick(PeriodNumber(fields));
    machine.run_until(end)?;
    black_box(machine.finish_pixels());
    Ok(fields as f64)
}

/// Runs a number of fields, and returns the number of stereo pairs that were shown.
fn pairs(experiment: &Experiment, fields: u64) -> Fallible<f64> {
    Ok(experiment.clone().fields(fields).run()?.pictures().len() as f64)
}

/// Runs a number of fields, and reads the left eye's last picture in every `every`-th field.
fn looking(experiment: &Experiment, all: u64, every: Option<u64>) -> Fallible<f64> {
    let mut machine = experiment.build()?;
    for field in (1..=all).filter(|field| *field == all || every.is_some_and(|every| field % every == 0)) {
        let end = machine.record().tick(PeriodNumber(field));
        machine.run_until(end)?;
        if every.is_some_and(|every| field % every == 0) {
            let display = machine.record().display_of_kind::<NtscDisplay>().ok_or("a machine without NTSC")?;
            black_box(display.boards()[0].last_seen().map(|seen| seen.picture()));
        }
    }
    black_box(machine.finish_pixels());
    Ok(all as f64)
}

/// Runs a number of fields, and returns the number of events.
fn events(experiment: &Experiment, fields: u64) -> Fallible<f64> {
    let mut machine = experiment.build()?;
    let end = machine.record().tick(PeriodNumber(fields));
    machine.run_until(end)?;
    Ok(machine.events() as f64)
}

fn row(work: &str, goal: Option<f64>, unit: &'static str, is_rate: bool, value: f64, measured: &Measured) -> Row {
    Row { work: work.to_owned(), goal, unit, is_rate, measured: value, spread: measured.spread(), summary: None }
}

fn time_ms(work: &str, goal: Option<f64>, measured: &Measured) -> Row {
    row(work, goal, " ms", false, measured.best() * 1e3, measured)
}

fn rate(work: &str, goal: Option<f64>, unit: &'static str, measured: &Measured) -> Row {
    row(work, goal, unit, true, 1.0 / measured.best(), measured)
}

/// Returns the ratio of two workloads that were measured in turns.
fn ratio(work: &str, goal: Option<f64>, one: &Measured, other: &Measured) -> Row {
    row(work, goal, "", false, one.best() / other.best(), one)
}

/// Returns a line that README shows too, under another description.
const fn in_readme(summary: &'static str, mut row: Row) -> Row {
    row.summary = Some(summary);
    row
}

pub(crate) fn goals(rounds: usize, opengl: Option<&str>) -> Fallible<Vec<Row>> {
    let mut rows = heads(rounds)?;
    rows.extend(pictures(rounds, opengl)?);
    rows.extend(aircraft(rounds)?);
    rows.extend(growth(rounds)?);
    rows.extend(looks(rounds)?);
    rows.extend(analytic(rounds)?);
    Ok(rows)
}

/// Measures the scene `head` in stereo on the machine.
fn heads(rounds: usize) -> Fallible<Vec<Row>> {
    const FIELDS: u64 = 480;
    let off = head()?;
    let all = off.clone().pixels(Pixels::All);
    let measured =
        in_turns(rounds, vec![Way::new("off", || pairs(&off, FIELDS)), Way::new("all", || pairs(&all, FIELDS))])?;
    Ok(vec![
        time_ms("a stereo pair of the head, no pixels", Some(4.5), &measured[0]),
        in_readme(
            "a stereo pair of 59,592 triangles on the emulated machine, all pixels, on one thread",
            time_ms("a stereo pair of the head, all pixels, on one thread", Some(12.0), &measured[1]),
        ),
    ])
}

/// Measures one eye's picture without the machine, beside `euc` and `retrofire`. The installed OpenGL is measured too,
/// if a program for it is given.
fn pictures(rounds: usize, opengl: Option<&str>) -> Fallible<Vec<Row>> {
    let head = scene::builtin("head")?;
    let views = views(&head);
    let mut euc = Euc::new(&head);
    let mut retrofire = Retrofire::new(&head);
    let mut ours = Ours::new(&head, Lanes::new);
    let mut opengl = opengl.map(|program| OpenGl::new(program, &head, &views)).transpose()?;
    let each = views.len() as f64;
    let mut ways = vec![
        Way::new("euc", || {
            views.iter().for_each(|view| euc.draw(&head, view));
            Ok(each)
        }),
        Way::new("ours", || {
            views.iter().for_each(|view| ours.draw(view));
            Ok(each)
        }),
        Way::new("retrofire", || {
            views.iter().for_each(|view| retrofire.draw(&head, view));
            Ok(each)
        }),
    ];
    ways.extend(opengl.as_mut().map(|opengl| Way::elsewhere("opengl", || opengl.draw())));
    let measured = in_turns(rounds, ways)?;
    agree("euc", euc.covered() as f64, ours.covered() as f64)?;
    agree("retrofire", retrofire.covered() as f64, ours.covered() as f64)?;
    let mut rows = vec![
        time_ms("one eye of the head, `euc` 0.5", None, &measured[0]),
        time_ms("the same, ours, without the machine", None, &measured[1]),
        in_readme(
            "one eye of them without the machine, relative to `euc`",
            ratio("time relative to `euc`", Some(0.42), &measured[1], &measured[0]),
        ),
        time_ms("the same, `retrofire` 0.4", None, &measured[2]),
        ratio("time relative to `retrofire`", None, &measured[1], &measured[2]),
    ];
    if let Some((opengl, measured_there)) = opengl.zip(measured.get(3)) {
        agree(&opengl.renderer, opengl.covered, ours.covered() as f64)?;
        rows.push(time_ms(&format!("the same, OpenGL on one thread, {}", opengl.renderer), None, measured_there));
        rows.push(in_readme(
            "the same, relative to OpenGL by llvmpipe on one thread",
            ratio("time relative to that", Some(0.22), &measured[1], measured_there),
        ));
    }
    Ok(rows)
}

/// Checks that two renderers draw the same picture: the numbers of covered pixels may differ by 2 %.
fn agree(peer: &str, theirs: f64, own: f64) -> Fallible<()> {
    let is_same = (theirs / own - 1.0).abs() < 0.02;
    is_same.then_some(()).ok_or_else(|| format!("{peer} covers {theirs} pixels, we {own}").into())
}

/// Measures the aircraft on the large machine, under Slats, and with code on the i860s.
fn aircraft(rounds: usize) -> Fallible<Vec<Row>> {
    let large = stereo(machine(50, 20), mig(417)?);
    let slats_off = slats(140)?;
    let slats_all = slats_off.clone().pixels(Pixels::All);
    let preset = MachineConfig::preset("slats-optimised")?;
    let slats_code = Experiment::new(preset, Slats::split(), mig(110)?).level(Level::Cycle);
    let slats_code = slats_code.pixels(Pixels::Off).host(Workstation::with_threads(0));
    let mig_code = stereo(MachineConfig::small_hmd(), mig(417)?).level(Level::Cycle);
    let measured = in_turns(
        rounds,
        vec![
            Way::new("large", || pairs(&large, 360)),
            Way::new("events", || events(&large, 60)),
            Way::new("slats", || fields(&slats_off, 480)),
            Way::new("slats, all", || fields(&slats_all, 240)),
            Way::new("slats, code", || fields(&slats_code, 48)),
            Way::new("mig, code", || fields(&mig_code, 24)),
        ],
    )?;
    let [large, event, slats_off, slats_all, slats_code, mig_code] = &measured[..] else { return Ok(Vec::new()) };
    let mut of_real_time = rate("the Mig at the cycle level", Some(3.4), " times real time", mig_code);
    of_real_time.measured /= FIELD_HZ;
    Ok(vec![
        time_ms("a stereo pair of the Mig on 50 GPs and 20 renderers", Some(1.2), large),
        row("an event of it, each by itself", Some(70.0), " ns", false, event.best() * 1e9, event),
        in_readme(
            "fields of Slats, 140 triangles, no pixels (the real machine: 60 fields/s)",
            rate("Slats, 140 triangles, no pixels", Some(11_000.0), " fields/s", slats_off),
        ),
        rate("the same, all pixels, on one thread", Some(4_000.0), " fields/s", slats_all),
        rate("Slats, 110 triangles, cycle level", Some(412.0), " fields/s", slats_code),
        of_real_time,
    ])
}

/// Measures the same scene on machines with more boards.
fn growth(rounds: usize) -> Fallible<Vec<Row>> {
    const FIELDS: u64 = 120;
    let scene = scene::builtin("head")?.decimated(10_000)?;
    let machines = [(13, 5), (50, 5), (13, 20)].map(|(gps, renderers)| stereo(machine(gps, renderers), scene.clone()));
    let ways = machines.iter().map(|experiment| Way::new("", || pairs(experiment, FIELDS))).collect();
    let measured = in_turns(rounds, ways)?;
    Ok(vec![
        ratio("10,000 triangles, a pair: 50 GPs relative to 13", Some(1.40), &measured[1], &measured[0]),
        ratio("20 renderers relative to 5", Some(1.12), &measured[2], &measured[0]),
    ])
}

/// Measures the cost of lazy pixels: when pictures are read, and when none is read.
fn looks(rounds: usize) -> Fallible<Vec<Row>> {
    const FIELDS: u64 = 120;
    let off = head()?;
    let lazy = off.clone().pixels(Pixels::Lazy);
    let measured = in_turns(
        rounds,
        vec![
            Way::new("off", || looking(&off, FIELDS, None)),
            Way::new("no reader", || looking(&lazy, FIELDS, None)),
            Way::new("one of 120", || looking(&lazy, FIELDS, Some(120))),
            Way::new("one of 60", || looking(&lazy, FIELDS, Some(60))),
        ],
    )?;
    let part = |work, goal, way: usize| ratio(work, goal, &measured[way], &measured[0]);
    Ok(vec![
        part("head, lazy pixels never read, relative to pixels off", Some(1.02), 1),
        part("the same, one eye's field of 120 is looked at", Some(1.10), 2),
        part("the same, one of 60", None, 3),
    ])
}

fn analytic(rounds: usize) -> Fallible<Vec<Row>> {
    const CONFIGURATIONS: u64 = 20_000;
    let one_by_one = || {
        let mut machine = MachineConfig::slats();
        let mut in_time = 0;
        for i in 0..CONFIGURATIONS {
            machine.gp.triangle_ns = 20_000 + i;
            in_time += u64::from(SlatsModel::new(&machine, Slats::split())?.field(140.0, FULL_SCREEN).in_time);
        }
        black_box(in_time);
        Ok(CONFIGURATIONS as f64)
    };
    let together = || {
        let mut machine = MachineConfig::slats();
        let mut in_time = 0;
        for begin in (0..CONFIGURATIONS).step_by(80) {
            let models: Result<Vec<_>, _> = (begin..begin + 80)
                .map(|i| {
                    machine.gp.triangle_ns = 20_000 + i;
                    SlatsModel::new(&machine, Slats::split())
                })
                .collect();
            in_time += SlatsModel::fields(&models?, 140.0, FULL_SCREEN).iter().filter(|times| times.in_time).count();
        }
        black_box(in_time);
        Ok(CONFIGURATIONS as f64)
    };
    let measured = in_turns(rounds, vec![Way::new("one by one", one_by_one), Way::new("eight together", together)])?;
    let unit = " configurations/s";
    Ok(vec![
        rate("analytic level, Slats, one by one", None, unit, &measured[0]),
        rate("the same, sixteen together", Some(4e6), unit, &measured[1]),
    ])
}

/// Returns the number of fields of a run without an optimization. The number is small for the slowest runs.
const fn fields_without(saving: Optimization) -> u64 {
    if matches!(saving, Optimization::IdleBoards | Optimization::Transfers) { 2 } else { 48 }
}

pub(crate) fn optimizations(rounds: usize) -> Fallible<Vec<OptimizationRow>> {
    let works = [
        ("Mig, Rendering Control", stereo(MachineConfig::small_hmd(), mig(417)?)),
        ("Slats, 140 triangles", slats(140)?),
    ];
    let mut rows = Vec::new();
    for saving in Optimization::ALL {
        for (work, experiment) in &works {
            let pixels = if saving == Optimization::EmptyRegions { Pixels::All } else { Pixels::Off };
            let level = if saving == Optimization::RepeatedCode { Level::Cycle } else { Level::Transaction };
            let with = experiment.clone().pixels(pixels).level(level);
            let without = with.clone().without(saving);
            let all = fields_without(saving);
            let measured = in_turns(
                rounds,
                vec![Way::new("with", || fields(&with, all)), Way::new("without", || fields(&without, all))],
            )?;
            let [with_ms, without_ms] = [0, 1].map(|way: usize| measured[way].best() * 1e3);
            rows.push(OptimizationRow { saving, work, with_ms, without_ms });
        }
    }
    Ok(rows)
}
