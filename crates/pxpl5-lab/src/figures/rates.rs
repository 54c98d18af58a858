//! Published peak rates: triangles per second of the machine, a renderer and a processor, and operations of the i860.
//! The total latency from the pendulum rig is also in this module.

use super::group::{Measurement, free};
use super::measured::{FigureValue, Result, detail, scene_named};
use super::{Bench, Interpretation, PHOTODIODE_LINE};
use i860::{Cpu, Ram, RunEnd, assemble};
use pphigs::Shading;
use pxpl5_gp::Stage;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, RenderingControl};

pub(super) const TITLE: &str = "Peak rates";

pub(super) const ABOUT: &str = "The rates of triangles are measured with the scene `typical:N` for one eye. The triangles of the \
scene `typical:N` are right-angled, have 18 pixels, touch about 1.3 regions each, and are spread evenly. J. Leech of the \
Pixel-Planes 5 team stated the published rates on 3 April 1991 in the newsgroup sci.virtual-worlds. Leech expected further \
optimization of the code, and he stated neither the size of the machine nor the size of the triangles.\n\n\
The column *interval* shows how much the rates depend on single parameters. In each run for an interval, one parameter has \
the lowest or the highest value of its range. The varied parameters are the depth of the renderers' FIFO, the channels that a \
sender can use, and the channels for messages to FIFOs. The times of a triangle on a processor and on a renderer also vary. All \
runs simulate events.";

/// Parameters that limit the machine's triangle rate with Gouraud shading.
const OF_GOURAUD: &[&str] = &[
    "renderer.fifo_words",
    "ring.source_channels",
    "ring.fifo_channels",
    "gp.triangle_ns",
    "renderer.triangle_clocks",
];

/// Parameters that limit the machine's triangle rate with Phong shading.
const OF_PHONG: &[&str] = &[
    "renderer.fifo_words",
    "ring.source_channels",
    "ring.fifo_channels",
    "gp.triangle_ns",
    "renderer.phong_triangle_clocks",
];

/// Parameters that limit the triangle rate of a single renderer, with Gouraud shading and with Phong shading.
const OF_RENDERER: [&[&str]; 2] = [
    &["renderer.fifo_words", "renderer.triangle_clocks", "renderer.shade_clocks"],
    &["renderer.fifo_words", "renderer.phong_triangle_clocks", "renderer.shade_clocks"],
];

const LEECH: (&str, &str) = ("Leech 1991", "whole machine");

pub(super) fn measurements() -> Vec<Measurement> {
    let mut all = of_machine();
    all.extend(of_boards());
    all
}

fn of_machine() -> Vec<Measurement> {
    let cause = "Each of the 20 renderers has one region, so the region with the most work decides the rate. A full FIFO also \
                 blocks a channel of the ring. The newsgroup article states neither the size of the machine nor the size of the \
                 triangles.";
    vec![
        Measurement {
            figure: free(
                ("R1", LEECH.0, LEECH.1),
                "Gouraud triangles a second",
                (1.6e6, "triangles/s", None),
                "typical:40000 mono on large: the result is the number of triangles of a frame times the frames per second",
                cause,
            ),
            measure: |bench| triangle_rate(bench, "large", Shading::Gouraud),
            moved_by: OF_GOURAUD,
        },
        Measurement {
            figure: free(
                ("R2", LEECH.0, LEECH.1),
                "Phong triangles a second: 1+ M, taken as more than 1 and less than the 1.6 M of Gouraud",
                (1.3e6, "triangles/s", Some(0.3e6)),
                "as R1 with Phong shading",
                cause,
            ),
            measure: |bench| triangle_rate(bench, "large", Shading::Phong),
            moved_by: OF_PHONG,
        },
        Measurement {
            figure: free(
                ("R3", "F89", "design goal"),
                "Phong triangles a second on 32 processors and 16 renderers",
                (1e6, "triangles/s", None),
                "as R2 on design-maximum",
                cause,
            ),
            measure: |bench| triangle_rate(bench, "design-maximum", Shading::Phong),
            moved_by: OF_PHONG,
        },
    ]
}

fn of_boards() -> Vec<Measurement> {
    let of_renderer = "typical:20000 mono on small-hmd with one renderer: the result is the number of commands divided by the working time of the array. Of 1,000 commands, 997 are triangles.";
    let of_array = "The published rate is a round number, and its source states neither the shading nor the state of the \
                    machine. The rate of the model follows from the bit-serial program of the pixel array.";
    vec![
        Measurement {
            figure: free(
                ("R4", "TR94", "renderer"),
                "triangles a second of a renderer, Gouraud",
                (150e3, "triangles/s", None),
                of_renderer,
                of_array,
            ),
            measure: |bench| renderer_rate(bench, Shading::Gouraud),
            moved_by: OF_RENDERER[0],
        },
        Measurement {
            figure: free(
                ("R4b", "TR94", "renderer"),
                "the same with Phong shading",
                (150e3, "triangles/s", None),
                of_renderer,
                of_array,
            ),
            measure: |bench| renderer_rate(bench, Shading::Phong),
            moved_by: OF_RENDERER[1],
        },
        Measurement {
            figure: free(
                ("R5", "F89", "processor"),
                "triangles a second of a processor: 1 M over 32",
                (31_250.0, "triangles/s", None),
                "typical:2000 mono on small-hmd with one slave: the result is the number of triangles divided by the time of TRANSFORM",
                "The published figure is the design rate of the whole machine divided by its number of processors. The optimised \
                 code from 1991 is faster than the design rate. The parameter `gp.triangle_ns` has its own source, which \
                 describes the optimised code.",
            ),
            measure: processor_rate,
            moved_by: &["gp.triangle_ns", "gp.bin_entry_ns"],
        },
        Measurement {
            figure: free(
                ("R6", "I3D95", "pendulum"),
                "tracker and rendering measured together from outside",
                (90.0, "ms", None),
                "the rig of figure 17 with the optical tracker on the bob: the result is the time from the instant at which the bob is at its lowest point to the light under the photodiode",
                "The position of the photodiode on the screen and the detection of the low point are not published.",
            ),
            measure: rig_total,
            moved_by: &["renderer.fifo_words", "ring.source_channels", PHOTODIODE_LINE],
        },
        Measurement {
            figure: free(
                ("R7", "i860PRM", "processor"),
                "single-precision peak of the i860 at 40 MHz",
                (80.0, "MFLOPS", None),
                "The i860 runs 100 iterations of a loop of 256 pipelined multiply-adds with warm caches. The result is the number of operations per time. The loop instructions take the rest of the time.",
                "",
            ),
            measure: |_| i860_peak(),
            moved_by: &[],
        },
    ]
}

/// Number of triangles in a frame.
const TRIANGLES: u64 = 40_000;

/// Number of display fields in a run, which suffice for 15 to 20 frames.
const FIELDS: u64 = 44;

fn drawn(machine: MachineConfig, shading: Shading, triangles: u64, fields: u64) -> Result<Outcome> {
    let pipeline = RenderingControl { shading, mono: true, ..Interpretation::USUAL.pipeline() };
    let experiment = Experiment::new(machine, pipeline, scene_named(&format!("typical:{triangles}"))?);
    experiment.fields(fields).pixels(Pixels::Off).run()
}

fn triangle_rate(bench: &Bench, preset: &str, shading: Shading) -> Result<FigureValue> {
    let hz = drawn(bench.machine(preset)?, shading, TRIANGLES, FIELDS)?.updates_hz().unwrap_or(f64::NAN);
    Ok(FigureValue::with(TRIANGLES as f64 * hz, vec![detail("frames a second", hz, "Hz")]))
}

/// Measures the rate at which a renderer executes commands, over the time in which its pixel array works. All but 80 of
/// the 26,000 commands of a frame are triangles.
fn renderer_rate(bench: &Bench, shading: Shading) -> Result<FigureValue> {
    let machine = MachineConfig { n_renderers: 1, ..bench.machine("small-hmd")? };
    let outcome = drawn(machine, shading, TRIANGLES / 2, 2 * FIELDS)?;
    // Idle time of the array does not count.
    let rates = outcome.record().renderers().iter().map(|renderer| {
        let busy_s = renderer.busy().0 as f64 / 1e12;
        renderer.stats().commands as f64 / busy_s
    });
    Ok(rates.sum::<f64>().into())
}

/// Measures the rate at which a processor transforms triangles, over the time of TRANSFORM. The first frame is left
/// out.
fn processor_rate(bench: &Bench) -> Result<FigureValue> {
    let triangles = 2_000;
    let machine = MachineConfig { n_gps: 2, ..bench.machine("small-hmd")? };
    let outcome = drawn(machine, Shading::Phong, triangles, 60)?;
    let stages = outcome.stages();
    // The first frame includes the start.
    let transforms = stages.iter().filter(|span| span.stage == Stage::Transform).skip(1);
    let spans_s: Vec<f64> = transforms.filter_map(|span| Some((span.end? - span.begin).as_ms() / 1e3)).collect();
    let mean_s = spans_s.iter().sum::<f64>() / spans_s.len() as f64;
    Ok((triangles as f64 / mean_s).into())
}

fn rig_total(bench: &Bench) -> Result<FigureValue> {
    let measured = bench.rig_measurement()?;
    let [tracking, rendering] = [measured.outside.tracking, measured.outside.rendering].map(|part| part.mean * 1e3);
    let details = vec![detail("tracking", tracking, "ms"), detail("rendering", rendering, "ms")];
    Ok(FigureValue::with(measured.outside.total.mean * 1e3, details))
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
            other => return Err(failed(format!("expected the end of the loop, found {other:?}"))),
        }
    }
    // Each multiply-add counts as two operations.
    let operations = f64::from(2 * TURNS) * MULTIPLY_ADDS as f64;
    Ok((operations / clocks as f64 * 40.0).into())
}

const CODE: u32 = 0x1000;
