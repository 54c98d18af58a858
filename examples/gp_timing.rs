//! Measures the clocks per triangle of the three kernels, their causes, and their dependence on each assumption. Also
//! computes the figures with the kernels on the boards.
//!
//! `cargo run --profile test --example gp_timing` prints the tables from which docs/gp-timing.md draws its conclusions.
//! With `--details`, it also prints more tables.

mod code_times;
#[path = "../crates/pphigs/tests/kernel/mod.rs"]
mod kernel;
#[path = "../crates/pphigs/tests/numbers/mod.rs"]
mod numbers;

use code_times::{code_times, strip_times};
use glam::Mat4;
use i860::timing::{DramTiming, FREEZES, Freeze};
use i860::{AddressProfile, Config, Profile, linear};
use kernel::{Bench, Strip, frame, strips, triangles};
use pxpl5::limit::LimitQuery;
use pxpl5::{CodeVersion, Experiment, Level, MachineConfig, PictureNumber, Pixels, Slats, Study, TestScene};
use pxpl5_geometry::kernel::{Kernel, KernelList, KernelPicture, KernelSurface, Schedule};
use pxpl5_geometry::sphere_kernel::SphereKernel;
use pxpl5_geometry::{Triangle, Viewport};
use pxpl5_gp::{CodeUse, GpTiming, Stage};
use pxpl5_sim::parameters::{ParameterTable, Value};
use pxpl5_wire::FieldParity;

const KERNELS: [(Kernel, &str); 3] =
    [(frame(Schedule::Straight), "straight"), (frame(Schedule::Compiled), "compiled"), (frame(Schedule::Dual), "dual")];
/// The program of Slats.
const SINGLE: Kernel = Kernel {
    surface: KernelSurface::Precomputed,
    picture: KernelPicture::Field,
    binned: false,
    both_eyes: true,
    ..frame(Schedule::Compiled)
};
/// Clocks in a microsecond (40 MHz, published).
const CLOCKS_PER_US: f64 = 40.0;
/// Freezes that memory causes. Without them, every access is a hit.
const MEMORY_ROWS: [Freeze; 11] = [
    Freeze::InstructionMiss,
    Freeze::InstructionMissBehindData,
    Freeze::LoadMissUse,
    Freeze::FloatingLoadMiss,
    Freeze::TransferDuringMiss,
    Freeze::AccessDuringMiss,
    Freeze::TlbMiss,
    Freeze::LoadPipeFull,
    Freeze::PipelinedLoadHit,
    Freeze::StorePipeFull,
    Freeze::AddressPipeFull,
];

fn scene() -> Vec<Triangle> {
    triangles(1000, 0.12, 1)
}

/// Returns the profile of one call over the scene, after a first call that fills the caches.
fn warm(kernel: Kernel, config: Config) -> Profile {
    let mut bench = Bench::new(kernel, Viewport::FRAME, config, &scene());
    bench.run();
    bench.cpu.clear_profile();
    bench.run();
    bench.profile()
}

fn cold(kernel: Kernel, config: Config) -> Profile {
    let mut bench = Bench::new(kernel, Viewport::FRAME, config, &scene());
    bench.run_cold();
    bench.profile()
}

fn per_triangle(profile: &Profile) -> f64 {
    profile.clocks() as f64 / scene().len() as f64
}

fn clocks(kernel: Kernel, config: Config) -> f64 {
    per_triangle(&warm(kernel, config))
}

fn without(rows: &[Freeze]) -> Config {
    let freezes = rows.iter().fold(Config::cycle().freezes, |rules, row| rules.without(*row));
    Config { freezes, ..Config::cycle() }
}

fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

fn head(cells: &[&str]) {
    row(&cells.iter().map(|c| (*c).to_owned()).collect::<Vec<_>>());
    row(&cells.iter().map(|_| "---".to_owned()).collect::<Vec<_>>());
}

fn results() {
    println!("## Clocks per triangle and eye\n");
    head(&["condition", "straight", "compiled", "dual", "straight, us", "compiled, us", "dual, us", "compiled / dual"]);
    let conditions: [(&str, [f64; 3]); 5] = [
        ("steady state, caches and memory as they are", both(|k| clocks(k, Config::cycle()))),
        ("empty caches before every triangle", both(|k| per_triangle(&cold(k, Config::cycle())))),
        ("no instruction-cache misses", both(|k| clocks(k, without(&[Freeze::InstructionMiss])))),
        ("every access a hit", both(|k| clocks(k, without(&MEMORY_ROWS)))),
        ("issue only, no freeze at all", both(issue)),
    ];
    for (name, clocks) in conditions {
        let cells =
            clocks.map(|c| format!("{c:.0}")).into_iter().chain(clocks.map(|c| format!("{:.1}", c / CLOCKS_PER_US)));
        let factor = format!("{:.2}", clocks[1] / clocks[2]);
        row(&[name.to_owned()].into_iter().chain(cells).chain([factor]).collect::<Vec<_>>());
    }
}

/// Prints the clocks for Phong triangles, for which the published rate was measured.
fn phong() {
    println!("\n## Phong triangles, steady state\n");
    head(&["condition", "straight", "compiled", "dual"]);
    let of = |measure: &dyn Fn(Kernel) -> f64| {
        both(|kernel| measure(Kernel { surface: KernelSurface::Phong, ..kernel })).map(|clocks| format!("{clocks:.0}"))
    };
    let rows: [(&str, [String; 3]); 3] = [
        ("caches and memory as they are", of(&|k| clocks(k, Config::cycle()))),
        ("every access a hit", of(&|k| clocks(k, without(&MEMORY_ROWS)))),
        ("issue only, no freeze at all", of(&issue)),
    ];
    for (name, [straight, compiled, dual]) in rows {
        row(&[name.to_owned(), straight, compiled, dual]);
    }
}

/// Prints the clocks of the program of Slats for both eyes.
fn slats() {
    println!(
        "\n## The program of Slats\n\n\
         One pass of *single* makes the commands of both eyes, for the same triangles with precomputed colours and in fields.\n\
         Parallel eyes share y, 1 / w and the depth of each corner. An independent count of November 2026 had expected 2,481\n\
         clocks (31.0 us) without this sharing.\n"
    );
    head(&["condition", "parallel eyes, clocks", "us an eye", "other eyes, clocks", "us an eye"]);
    let field = Viewport::field(FieldParity::Odd);
    let clocks = |config: Config, turn: f32, issue: bool| {
        let mut right = kernel::view();
        right.model_view = Mat4::from_rotation_y(turn) * right.model_view;
        right.model_view.w_axis.x -= 0.1;
        let mut bench = Bench::for_both_eyes(SINGLE, &[kernel::view(), right], field, config, &scene());
        bench.run();
        bench.cpu.clear_profile();
        bench.run();
        let profile = bench.profile();
        (if issue { profile.issue } else { profile.clocks() }) as f64 / scene().len() as f64
    };
    for (name, rows, issue) in [
        ("steady state, caches and memory as they are", &[][..], false),
        ("every access a hit", &MEMORY_ROWS, false),
        ("issue only, no freeze at all", &[], true),
    ] {
        let cells = [0.0, 0.04].map(|turn| clocks(without(rows), turn, issue));
        let cells = cells.into_iter().flat_map(|c| [format!("{c:.0}"), format!("{:.1}", c / CLOCKS_PER_US / 2.0)]);
        row(&std::iter::once(name.to_owned()).chain(cells).collect::<Vec<_>>());
    }
}

fn both(measure: impl Fn(Kernel) -> f64) -> [f64; 3] {
    KERNELS.map(|(kernel, _)| measure(kernel))
}

fn issue(kernel: Kernel) -> f64 {
    warm(kernel, Config::cycle()).issue as f64 / scene().len() as f64
}

fn comparison() {
    println!("\n## Against the published figures\n");
    let kernels = both(|k| clocks(k, Config::cycle()));
    head(&["figure", "clocks", "straight / figure", "compiled / figure", "dual / figure"]);
    for (name, figure) in [
        ("optimised PPHIGS, 21.7 us (derived)", 870.0),
        ("design goal, 1M triangles/s over 32 processors, 32 us (derived)", 1280.0),
        ("Slats prototype of 1994, 34 us (derived)", 1360.0),
        ("Slats of 1995, 58 us (derived)", 2320.0),
    ] {
        let ratios = kernels.map(|clocks| format!("{:.2}", clocks / figure));
        row(&[vec![name.to_owned(), format!("{figure:.0}")], ratios.to_vec()].concat());
    }
    let [straight, compiled, dual] = kernels;
    let in_cache = both(|k| clocks(k, without(&[Freeze::InstructionMiss])));
    println!(
        "\n\
         Code that fits the instruction cache draws about 3 times as many triangles a second, a paper states. The dual\n\
         kernel, whose loops fit it, is {:.2} times as fast as the compiled kernel and {:.2} times as fast as the\n\
         straight one. Without misses of the instruction cache, the compiled kernel takes {:.0} clocks and the straight\n\
         kernel {:.0}.",
        compiled / dual,
        straight / dual,
        in_cache[1],
        in_cache[0],
    );
}

fn freeze_sensitivity() {
    println!("\n## Sensitivity to each freeze row\n");
    println!(
        "A *freeze* is a wait of the processor for one of the causes in the freeze table. Each line shows how the\n\
         clocks per triangle change if one row of that table is disabled; rows without effect are left out.\n"
    );
    head(&["row", "condition", "straight", "compiled", "dual"]);
    let base = both(|k| clocks(k, Config::cycle()));
    for freeze in &FREEZES {
        let off = both(|k| clocks(k, without(&[freeze.id])));
        let change = [0, 1, 2].map(|k| off[k] - base[k]);
        if change.iter().any(|c| c.abs() >= 0.05) {
            let cells = change.map(|c| format!("{c:+.1}"));
            row(&[vec![freeze.number.to_owned(), freeze.condition.to_owned()], cells.to_vec()].concat());
        }
    }
    let mut logicals = Config::cycle();
    logicals.freezes.logicals_delay_branches = true;
    let change = [0, 1, 2].map(|k| format!("{:+.1}", clocks(KERNELS[k].0, logicals) - base[k]));
    row(&[vec!["8, also logicals".into(), "open question".into()], change.to_vec()].concat());
}

fn dram_sensitivity() {
    println!("\n## Sensitivity to the memory\n");
    println!("This is the change of clocks per triangle at both ends of each parameter's allowed range:\n");
    head(&[
        "parameter",
        "default",
        "range",
        "straight, least",
        "straight, most",
        "compiled, least",
        "compiled, most",
        "dual, least",
        "dual, most",
    ]);
    let base = both(|k| clocks(k, Config::cycle()));
    for entry in DramTiming::PAPERS.entries() {
        let name = entry.info.name;
        let at = |kernel: usize, value: Value| {
            let mut dram = DramTiming::PAPERS;
            dram.set(name, value).expect("it is in the table");
            let config = Config { dram, ..Config::cycle() };
            format!("{:+.1}", clocks(KERNELS[kernel].0, config) - base[kernel])
        };
        let (low, high) = entry.info.range;
        let most = if name == "dma_interval" { Value::Whole(8) } else { high };
        let cells = [0, 1, 2].map(|kernel| vec![at(kernel, low), at(kernel, most)]).concat();
        row(&[vec![name.to_owned(), entry.value.to_string(), format!("{low} to {high}")], cells].concat());
    }
    println!(
        "\n\
         For `dma_interval`, \"most\" is 8 clocks, at which DMA moves half of the data rate of one ring channel. With 0,\n\
         no other device uses the bus."
    );
}

/// Returns the scheduled kernel for Phong triangles, either in strips or with separate corners.
const fn scheduled_phong(list: KernelList) -> Kernel {
    Kernel { surface: KernelSurface::Phong, list, ..frame(Schedule::Dual) }
}

/// Returns strips of `length` triangles each, about a thousand triangles in all.
fn strips_of(length: usize) -> Vec<Strip> {
    strips(&vec![length; 1000 / length], 0.12, 1)
}

/// Returns a bench after a first call that fills the caches, with an empty profile.
fn warm_strips(kernel: Kernel, config: Config, length: usize) -> Bench {
    let mut bench = Bench::of_strips(kernel, Viewport::FRAME, config, &strips_of(length));
    bench.run();
    bench.cpu.clear_profile();
    bench
}

fn strip_clocks(kernel: Kernel, config: Config, length: usize) -> f64 {
    let mut bench = warm_strips(kernel, config, length);
    bench.run();
    bench.profile().clocks() as f64 / (1000 / length * length) as f64
}

/// Prints the cost of a vertex and of a triangle in strips, and the lower bounds of the resources.
fn sharing() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n## Strips, steady state\n");
    println!(
        "If the display list has strips of triangles (T-meshes), each vertex forms a triangle with the two before it,\n\
         and each corner is transformed only once. These times include frames with bins and all tests, for triangles of\n\
         about 30 pixels. A batch has 76 triangles of 78 corners. The first two corners of a strip complete no\n\
         triangle, so the loop that makes commands skips them.\n"
    );
    let kernel = |surface| Kernel { surface, ..scheduled_phong(KernelList::Strips) };
    head(&[
        "triangles in a strip",
        "Phong: dual",
        "every access a hit",
        "straight",
        "Gouraud: dual",
        "every access a hit",
        "straight",
    ]);
    for length in [1000, 100, 20, 8, 4] {
        let cells = [KernelSurface::Phong, KernelSurface::Gouraud].map(|surface| {
            let dual = kernel(surface);
            let straight = Kernel { schedule: Schedule::Straight, ..dual };
            let hits = strip_clocks(dual, without(&MEMORY_ROWS), length);
            [strip_clocks(dual, Config::cycle(), length), hits, strip_clocks(straight, Config::cycle(), length)]
        });
        row(&[vec![length.to_string()], cells.concat().iter().map(|c| format!("{c:.0}")).collect()].concat());
    }
    steps();
    lower_bounds()
}

/// Prints the clocks by part of the code for Phong triangles, for one long strip and for triangles with separate
/// corners.
fn steps() {
    println!("\n### Clocks by step: one long strip, and triangles with separate corners (Phong, dual)\n");
    head(&["step", "strip", "own corners"]);
    let labels = ["start", "corners", "again", "finished", "bins", "doubt", "clipper"];
    let names = [
        "begin a batch",
        "corners",
        "set-up, words and the bin of one region",
        "triangles in doubt, in several regions or in none",
        "bins of these",
        "in doubt, but inside",
        "exact tests and the clipper",
    ];
    let all = [KernelList::Strips, KernelList::Triangles].map(|list| {
        let kernel = scheduled_phong(list);
        let mut bench = match list {
            KernelList::Strips => warm_strips(kernel, Config::cycle(), 1000),
            KernelList::Triangles => {
                let mut bench = Bench::new(kernel, Viewport::FRAME, Config::cycle(), &scene());
                bench.run();
                bench
            }
        };
        let base = bench.program.base;
        bench.cpu.watch(Some(AddressProfile::new(base, bench.program.bytes.len() / 4)));
        bench.run();
        let at = labels.map(|label| (label, bench.program.symbol(label).expect("label")));
        bench.cpu.watched().map(|watched| watched.by_label(&at)).unwrap_or_default()
    });
    for (label, name) in labels.into_iter().zip(names) {
        let clocks = |parts: &[(&str, u64)]| {
            let sum: u64 = parts.iter().filter(|part| part.0 == label).map(|part| part.1).sum();
            format!("{:.1}", sum as f64 / 1000.0)
        };
        row(&[name.to_owned(), clocks(&all[0]), clocks(&all[1])]);
    }
}

/// Prints the smallest possible number of instruction pairs beside that of the schedules.
fn lower_bounds() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n### Lower bound of the resources (Phong, dual)\n");
    println!(
        "An instruction pair has a floating-point slot and a core slot, and a product of doubles needs two slots. The\n\
         table counts what the operations of a linear stretch (code without branches) need. No schedule has fewer pairs\n\
         than the larger of the two. One stretch transforms three corners: these are one triangle with corners of its\n\
         own, or three triangles of a strip.\n"
    );
    head(&["linear stretch", "floating-point slots", "core slots", "least pairs", "pairs of the schedule"]);
    for (list, name) in [(KernelList::Strips, "strip"), (KernelList::Triangles, "own corners")] {
        for (slots, part) in linear::slots(&scheduled_phong(list).source())?.iter().zip(["three corners", "set-up"]) {
            let least = slots.floating.max(slots.core);
            let cells = [slots.floating, slots.core, least, slots.pairs].map(|n| n.to_string());
            row(&[vec![format!("{name}: {part}")], cells.to_vec()].concat());
        }
    }
    println!(
        "\n\
         Three effects make the kernel slower than its slots require. Values occupy the 30 registers until the\n\
         floating-point pipelines have finished. Each of the two loops removes the other from the instruction cache,\n\
         and a larger batch would not fit the data cache. Finally, an edge that two triangles of a strip share is\n\
         computed for each of them."
    );
    Ok(())
}

/// Returns the mean time of TRANSFORM for a field of Slats, in microseconds.
fn transform_us(preset: &str, level: Level, triangles: u32) -> Result<f64, Box<dyn std::error::Error>> {
    let small = TestScene::Typical.with_triangles(triangles);
    let experiment = Experiment::new(MachineConfig::preset(preset)?, Slats::split(), small).fields(12).level(level);
    let stages = experiment.pixels(Pixels::Off).run()?.stages();
    let steady = stages.iter().filter(|span| span.stage == Stage::Transform && span.picture > PictureNumber(4));
    let times: Vec<f64> = steady.filter_map(|span| Some((span.end? - span.begin).as_ms() * 1e3)).collect();
    Ok(times.iter().sum::<f64>() / times.len() as f64)
}

/// Returns the time per triangle and eye on the board: the additional time for ten more triangles in a clump, for two
/// eyes.
fn on_board_us(preset: &str, level: Level) -> Result<f64, Box<dyn std::error::Error>> {
    Ok((transform_us(preset, level, 30)? - transform_us(preset, level, 20)?) / 20.0)
}

fn board() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n## On the board: the cycle level\n");
    println!(
        "At the cycle level the kernels run on the boards of the machine, and no number is fitted. Slats draws fields\n\
         without bins, and the caches keep their contents during the run. The triangles are small and touch 1.3 regions\n\
         each on average. In the presets of 1994 and 1995 *single* runs, and `slats-optimised` runs the *dual* kernel.\n\
         Beside it stands the transaction level with its timing table. The table of `slats` is the time of this code,\n\
         and only the table of `slats-1995` is fitted:\n"
    );
    head(&["preset", "kernel", "us per triangle and eye: table", "cycle level", "published"]);
    for (preset, kernel, published) in [
        ("slats", "single", "34 (derived)"),
        ("slats-1995", "single", "58 (derived)"),
        ("slats-optimised", "dual", "a third of 34"),
    ] {
        let [table, cycle] = [on_board_us(preset, Level::Transaction)?, on_board_us(preset, Level::Cycle)?];
        row(&[preset.into(), kernel.into(), format!("{table:.1}"), format!("{cycle:.1}"), published.into()]);
    }
    println!();
    head(&["most triangles per field", "kernel", "table", "cycle level", "the same, full-screen", "published"]);
    for (name, preset, slats, kernel, published) in [
        ("figure 12: without the COPY optimisation", "slats", Slats::whole(), "single", "110"),
        ("figure 13: with it", "slats", Slats::split(), "single", "140"),
        ("figure 14: with it, code of 1995", "slats-1995", Slats::split(), "single", "100"),
        ("optimised code, without it", "slats-optimised", Slats::whole(), "dual", "-"),
        ("optimised code, with it", "slats-optimised", Slats::split(), "dual", "-"),
    ] {
        let machine = MachineConfig::preset(preset)?;
        let limit = |level, scene| {
            let mut query = LimitQuery { level, ..LimitQuery::of_papers(machine.clone(), slats)? };
            query.criterion.scene = scene;
            query.run(&mut ()).map(|limit| limit.triangles.to_string())
        };
        let table = limit(Level::Transaction, TestScene::FullScreen)?;
        let cycle = [TestScene::Typical, TestScene::FullScreen].map(|scene| limit(Level::Cycle, scene));
        let [small, full] = cycle;
        row(&[name.into(), kernel.into(), table, small?, full?, published.into()]);
    }
    println!(
        "\n\
         These limits are those of the first comparison: the rules of *single* (kernels/slats_rules.md) had been written\n\
         before it. They do not depend on the size of the triangles, because no triangle is clipped and Slats sends each\n\
         one to all regions. Figure 14 stays open. The program of 1995 drew fewer triangles than that of 1994 and was\n\
         another one; light on the GP would explain 7 to 9 us of the difference."
    );
    Ok(())
}

/// Prints the timing table from the code beside the published and fitted table.
fn table_of_code() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n## The timing table from the code\n");
    println!(
        "These are mean times over the three application scenes; *scenes* is the range of their means\n\
         (examples/code_times). The preset `slats` has the times of *single* by default, and `slats-optimised` a third of\n\
         them for triangles and spheres; the others have published or fitted times. `machine.times = \"code\"` selects the\n\
         times of the code for every preset, and `\"papers\"` the time fitted to figure 12 for `slats`.\n"
    );
    head(&[
        "code",
        "triangle, us",
        "scenes, us",
        "cut by the clipper, besides, us",
        "sphere, us",
        "entry in a bin, us",
        "beginning of a pass, us",
        "a structure of it and eye, us",
        "spheres of a structure and eye, besides, us",
        "edit, us",
        "entry handed over, us",
        "message or chain, us",
        "scenes, us",
        "table, triangle, us",
    ]);
    for (name, version, of, table) in [
        ("PPHIGS: scheduled, Phong, frames in bins", CodeVersion::Scheduled, CodeUse::Pphigs, GpTiming::PAPERS),
        ("Slats: single, precomputed colours, fields", CodeVersion::Compiled, CodeUse::Slats, GpTiming::SLATS_1994),
        (
            "Slats: scheduled, precomputed colours, fields",
            CodeVersion::Scheduled,
            CodeUse::Slats,
            GpTiming::SLATS_OPTIMISED,
        ),
        ("Slats: compiled, light on the GP, fields", CodeVersion::Compiled, CodeUse::SlatsLit, GpTiming::SLATS_1994),
        (
            "Slats: scheduled, light on the GP, fields",
            CodeVersion::Scheduled,
            CodeUse::SlatsLit,
            GpTiming::SLATS_OPTIMISED,
        ),
    ] {
        let times = code_times(version, of)?;
        let us = |ns: f64| format!("{:.2}", ns * 1e-3);
        let [least, greatest] = times.triangle_range_ns.map(us);
        let [least_message, greatest_message] = times.message_range_ns.map(us);
        row(&[
            name.to_owned(),
            us(times.triangle_ns),
            format!("{least} to {greatest}"),
            us(times.guard_ns),
            us(times.sphere_ns),
            us(times.entry_ns),
            us(times.pass_ns),
            us(times.structure_ns),
            us(times.sphere_view_ns),
            us(times.edit_ns),
            us(times.token_entry_ns),
            us(times.message_ns),
            format!("{least_message} to {greatest_message}"),
            us(table.triangle_ns as f64),
        ]);
    }
    Ok(())
}

/// Prints the clocks of just-in-time pixels and frameless rendering outside of TRANSFORM.
fn strips_and_blocks() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n## Strips and blocks\n");
    println!(
        "Just-in-time pixels need these clocks for a strip of one line, with the triangles of `aircraft`\n\
         (examples/code_times). Frameless rendering finds the triangles of its blocks with the same code, whose rules\n\
         are windows_rules.md, between_rules.md and order_rules.md in crates/pphigs/kernels. A strip that is\n\
         interpolated between two views begins with a new pass over the triangles. In the timing table, an interpolated\n\
         triangle takes `jitp.interpolate_ns`, for which 280 clocks are assumed.\n"
    );
    head(&[
        "code",
        "box compared",
        "entry of a window besides",
        "five windows of a strip",
        "places in two views",
        "triangle far from the strip",
        "near, on the screen, besides",
        "near, in the view, besides",
        "order of a strip",
        "with a view",
        "of blocks",
        "of a field, two views",
    ]);
    for version in [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled] {
        let times = strip_times(version)?;
        let [screen, view] = times.interpolated_ns;
        let of_triangles =
            [times.box_ns, times.entry_ns, times.windows_ns, times.ends_ns, times.passed_ns, screen, view];
        let clocks =
            of_triangles.into_iter().chain(times.order_ns).map(|ns| format!("{:.0}", ns * 1e-3 * CLOCKS_PER_US));
        row(&std::iter::once(version.name().to_owned()).chain(clocks).collect::<Vec<_>>());
    }
    Ok(())
}

fn sizes() {
    println!("\n## Size of the code\n");
    head(&["kernel", "bytes"]);
    for (kernel, name) in KERNELS {
        let program = kernel::program(kernel);
        let clipper = program.symbol("clipper").expect("label");
        row(&[name.to_owned(), (clipper - program.base).to_string()]);
    }
    let single = kernel::program(SINGLE);
    row(&["single".into(), (single.symbol("clipper").expect("label") - single.base).to_string()]);
    let program = kernel::program(frame(Schedule::Dual));
    let at = |label: &str| program.symbol(label).expect("label");
    let end = at("clipper");
    row(&["clipper".into(), (program.base + program.bytes.len() as u32 - end).to_string()]);
    for (surface, name) in [(KernelSurface::Gouraud, "spheres, Gouraud"), (KernelSurface::Phong, "spheres, Phong")] {
        let source = SphereKernel { surface, picture: KernelPicture::Frame, keeps_boxes: false }.source();
        let program = i860::assemble("sphere", 0, &source).expect("the tests assemble it");
        row(&[name.into(), program.bytes.len().to_string()]);
    }
    row(&["dual, loop over corners".into(), (at("again") - at("corners")).to_string()]);
    row(&["dual, loop over commands".into(), (at("finished") - at("again")).to_string()]);
    row(&["dual, out of the loops".into(), (end - at("finished")).to_string()]);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    results();
    slats();
    comparison();
    board()?;
    table_of_code()?;
    sizes();
    if std::env::args().any(|argument| argument == "--details") {
        phong();
        freeze_sensitivity();
        dram_sensitivity();
        sharing()?;
        strips_and_blocks()?;
    }
    Ok(())
}
