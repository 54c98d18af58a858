//! Published peak rates: triangles and spheres per second of the machine, triangles of a renderer, and operations of the
//! i860.

use super::measurement::{Measurement, Varied, figure};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result, detail, scene_named};
use glam::Vec3;
use i860::{Cpu, Ram, RunEnd, assemble};
use pphigs::Shading;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, RenderingControl};
use pxpl5_scene::{HeadMotion, Scene, SceneParts, Sphere, builtin};
use pxpl5_sim::figures::Basis;
use std::sync::Arc;

pub(super) const TITLE: &str = "Peak rates";

pub(super) const ABOUT: &str = "The scene `typical:N` is drawn for one eye: right-angled triangles of 18 pixels, spread evenly, that touch about \
1.3 regions each. J. Leech of the Pixel-Planes 5 team stated the rates on 3 April 1991 in the newsgroup sci.virtual-worlds and \
expected more from optimized code. He named neither the size of the machine nor that of the triangles.";

/// Parameters that limit the machine's triangle rate with Gouraud shading.
const OF_GOURAUD: Varied = Varied::ByEvents(&[
    FIFO_WORDS,
    "ring.source_channels",
    "ring.fifo_channels",
    "gp.triangle_ns",
    "renderer.triangle_clocks",
]);

/// Parameters that limit the machine's triangle rate with Phong shading.
const OF_PHONG: Varied = Varied::ByEvents(&[
    FIFO_WORDS,
    "ring.source_channels",
    "ring.fifo_channels",
    "gp.triangle_ns",
    "renderer.phong_triangle_clocks",
]);

/// Parameters that limit the rate of spheres. The ends of the range of clocks are the two programs for a root.
const OF_SPHERES: Varied = Varied::ByEvents(&["renderer.phong_sphere_clocks", "gp.sphere_ns"]);

/// Parameters that limit the triangle rate of a single renderer.
const OF_RENDERER: Varied = Varied::ByEvents(&[FIFO_WORDS, "renderer.phong_triangle_clocks", "renderer.shade_clocks"]);

/// Path of the depth of a renderer's input FIFO.
pub(super) const FIFO_WORDS: &str = "renderer.fifo_words";

const LEECH: (&str, &str) = ("Leech 1991", "whole machine");

const OF_RATES: &str = "Neither the machine nor the scene was chosen by these figures";

const CAUSE: &str = "Each of the 20 renderers has one region, so the region with the most work decides, and a full FIFO blocks a channel. The \
                     source states neither the size of the machine nor that of the triangles";

/// The rates, in the order of their numbers. There is no row R5: a goal of 1989 for the processors would be compared with
/// code of 1991 whose rate is an input. There is no row for Gouraud triangles of a renderer and none for a sum of tracker
/// and rendering from outside either, because no paper prints them.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        reason: OF_RATES,
        varied: OF_GOURAUD,
        cause: CAUSE,
        ..figure(
            ("R1", LEECH, 1.6e6, "triangles/s"),
            "Gouraud triangles a second",
            "typical:40000 mono on large: triangles of a frame times frames per second",
            |settings| triangle_rate(settings, "large", Shading::Gouraud),
        )
    },
    Measurement {
        range: Some(0.3e6),
        reason: OF_RATES,
        varied: OF_PHONG,
        cause: CAUSE,
        ..figure(
            ("R2", LEECH, 1.3e6, "triangles/s"),
            "Phong triangles a second: 1+ M, taken as more than 1 and less than the 1.6 M of Gouraud",
            "as R1 with Phong shading",
            |settings| triangle_rate(settings, "large", Shading::Phong),
        )
    },
    Measurement {
        reason: OF_RATES,
        varied: OF_PHONG,
        cause: "F89's rate is a round goal, for triangles of unnamed size",
        ..figure(
            ("R3", ("F89", "design goal"), 1e6, "triangles/s"),
            "Phong triangles a second on 32 processors and 16 renderers",
            "as R2 on design-maximum",
            |settings| triangle_rate(settings, "design-maximum", Shading::Phong),
        )
    },
    Measurement {
        reason: "The steps of the array's program and the bits of its numbers give the rate",
        varied: OF_RENDERER,
        cause: "The published rate is a round number of the design; the model's follows from the array's bit-serial program",
        ..figure(
            ("R4b", ("F89", "renderer"), 150e3, "triangles/s"),
            "Phong triangles a second of a renderer",
            "typical:20000 mono on small-hmd with one renderer: commands over the working time of the array; of 1,000 commands, 997 are triangles",
            renderer_rate,
        )
    },
    Measurement {
        basis: Basis::Derived("two operations a clock of 40 MHz"),
        ..figure(
            ("R7", ("i860PRM", "processor"), 80.0, "MFLOPS"),
            "single-precision peak of the i860 at 40 MHz",
            "100 iterations of a loop of 256 pipelined multiply-adds with warm caches: operations per time; the instructions of the loop take the rest",
            |_| i860_peak(),
        )
    },
    Measurement {
        reason: OF_RATES,
        varied: OF_SPHERES,
        cause: "The real program for spheres is unknown. Ours computes an exact root; a paraboloid gives the upper end of \
                the interval. Both are faster than the recollected rate, whose machine and spheres are not known",
        ..figure(
            ("R8", ("UNC, recollected", "whole machine"), 700e3, "spheres/s"),
            "Phong spheres a second",
            "20,000 spheres of 18 pixels, spread like the triangles of typical:N, mono on large",
            sphere_rate,
        )
    },
];

/// Number of triangles in a frame.
const TRIANGLES: u64 = 40_000;

/// Number of display fields in a run, which suffice for 15 to 20 frames.
const FIELDS: u64 = 44;

fn drawn(
    settings: &FigureSettings,
    machine: MachineConfig,
    shading: Shading,
    scene: Arc<Scene>,
    fields: u64,
) -> Result<Outcome> {
    let pipeline = RenderingControl { shading, mono: true, ..settings.interpretation.pipeline() };
    let experiment = Experiment::new(machine, pipeline, scene).fields(fields).pixels(Pixels::Off);
    Ok(experiment.stopped_by(settings.stop.clone()).run()?)
}

/// Measures the number of primitives that a machine draws in a second. The result is cached, because the tables of
/// intervals and of FIFO sizes share it.
fn rate(
    settings: &FigureSettings,
    preset: &str,
    shading: Shading,
    scene: &str,
    primitives: u64,
) -> Result<FigureValue> {
    let machine = settings.machine(preset)?;
    settings.applications.value(format!("{scene} {shading:?} {machine:?} {:?}", settings.interpretation), || {
        let scene = if scene == SPHERES { spheres()? } else { scene_named(scene)? };
        let hz = drawn(settings, machine, shading, scene, FIELDS)?.updates_hz().unwrap_or(f64::NAN);
        Ok(FigureValue::with(primitives as f64 * hz, vec![detail("frames a second", hz, "Hz")]))
    })
}

pub(super) fn triangle_rate(settings: &FigureSettings, preset: &str, shading: Shading) -> Result<FigureValue> {
    rate(settings, preset, shading, &format!("typical:{TRIANGLES}"), TRIANGLES)
}

fn sphere_rate(settings: &FigureSettings) -> Result<FigureValue> {
    rate(settings, "large", Shading::Phong, SPHERES, TRIANGLES / 2)
}

const SPHERES: &str = "spheres";

/// Returns a scene with a sphere in place of each triangle of `typical:20000`, as wide as the triangle.
fn spheres() -> Result<Arc<Scene>> {
    let triangles = builtin(&format!("typical:{}", TRIANGLES / 2))?;
    let corners = triangles.vertices().chunks(3).map(|corners| [0, 1, 2].map(|corner| corners[corner].position));
    let sphere = |[corner, right, up]: [Vec3; 3]| Sphere {
        centre: (right + up) / 2.0,
        radius: right.distance(corner) / 2.0,
        colour: [200; 3],
    };
    let parts = SceneParts {
        spheres: corners.map(sphere).collect(),
        motion: HeadMotion::still(Vec3::ZERO, Vec3::NEG_Z)?,
        ..SceneParts::of(SPHERES, Vec::new(), Vec::new())
    };
    Ok(Arc::new(Scene::new(parts)?))
}

/// Measures the rate at which a renderer executes commands, over the time in which its pixel array works. All but 80 of
/// the 26,000 commands of a frame are triangles.
fn renderer_rate(settings: &FigureSettings) -> Result<FigureValue> {
    let machine = MachineConfig { n_renderers: 1, ..settings.machine("small-hmd")? };
    let scene = scene_named(&format!("typical:{}", TRIANGLES / 2))?;
    let outcome = drawn(settings, machine, Shading::Phong, scene, 2 * FIELDS)?;
    // Idle time of the array does not count.
    let rates = outcome.record().renderers().iter().map(|renderer| {
        let busy_s = renderer.busy().0 as f64 / 1e12;
        renderer.stats().commands as f64 / busy_s
    });
    Ok(rates.sum::<f64>().into())
}

const TURNS: u32 = 100;
const MULTIPLY_ADDS: usize = 256;

/// Measures the floating-point operations of the i860 in millions per second, at a clock of 40 MHz.
fn i860_peak() -> Result<FigureValue> {
    let failed = |reason: String| ExperimentError::Scene(format!("the peak of the i860: {reason}"));
    let body = "m12apm.ss f8, f9, f0\n".repeat(MULTIPLY_ADDS);
    let source = format!("begin: or {TURNS}, r0, r16\nagain: {body}adds -1, r16, r16\nbtne r0, r16, again\nend: nop");
    // The loop is unrolled, so that its branch costs little.
    let program = assemble("peak.s", CODE, &source).map_err(|error| failed(error.to_string()))?;
    let end = program.symbol("end").ok_or_else(|| failed("the loop has no end".to_owned()))?;
    let mut ram = Ram::new(0, 0x4000);
    ram.load(CODE, &program.bytes).map_err(|error| failed(error.to_string()))?;
    let mut cpu = Cpu::new(i860::Config::cycle());
    let mut clocks = 0;
    // The first run fills the cache.
    for _ in 0..2 {
        cpu.state.pc = CODE;
        let before = cpu.clocks();
        match cpu.run(&mut ram, Some(end), 1_000_000) {
            RunEnd::Stopped => clocks = cpu.clocks() - before,
            other => return Err(failed(format!("expected the end of the loop, found {other:?}")).into()),
        }
    }
    // Each multiply-add counts as two operations.
    let operations = f64::from(2 * TURNS) * MULTIPLY_ADDS as f64;
    Ok((operations / clocks as f64 * 40.0).into())
}

const CODE: u32 = 0x1000;
