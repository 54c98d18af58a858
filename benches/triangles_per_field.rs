//! Searches the largest number of triangles that Slats draws in every field: for the prototype, its variants, and
//! experiments beyond them. Prints each limit once and measures the time of the search.

#![allow(missing_docs, reason = "criterion_group! makes functions without documentation")]

use criterion::{Criterion, criterion_group, criterion_main};
use pxpl5::limit::LimitQuery;
use pxpl5::{Level, MachineConfig, RegionBinning, Slats, Study, TestScene};
use std::time::Duration;

fn machine(preset: &str, n_gps: usize, n_renderers: usize) -> MachineConfig {
    let preset = MachineConfig::preset(preset).expect("listed");
    MachineConfig { n_gps, n_renderers, ..preset }
}

/// Returns a query with triangles that cover the screen.
fn all(config: MachineConfig, slats: Slats) -> LimitQuery {
    LimitQuery::of_papers(config, slats).expect("Slats is known")
}

/// Returns a query with small triangles, spread over the screen.
fn typical(config: MachineConfig, slats: Slats) -> LimitQuery {
    let mut query = all(config, slats);
    query.criterion.scene = TestScene::Typical;
    query
}

fn queries() -> Vec<(&'static str, LimitQuery)> {
    let touched = Slats { binning: RegionBinning::Touched, ..Slats::split() };
    vec![
        ("prototype, whole copy (published 110)", all(machine("slats", 1, 5), Slats::whole())),
        ("prototype, split copy (published 140)", all(machine("slats", 1, 5), Slats::split())),
        ("code of 1995 (published about 100)", all(machine("slats-1995", 1, 5), Slats::split())),
        ("optimised code", all(machine("slats-optimised", 1, 5), Slats::split())),
        ("backup field", all(machine("slats", 1, 5), Slats::backup())),
        ("two GPs", all(machine("slats", 2, 5), Slats::split())),
        ("ten renderers", all(machine("slats", 1, 10), Slats::split())),
        ("four GPs, ten renderers", all(machine("slats", 4, 10), Slats::split())),
        ("typical triangles, all regions", typical(machine("slats", 1, 5), Slats::split())),
        ("typical triangles, touched regions", typical(machine("slats", 1, 5), touched)),
        ("the same, four GPs, ten renderers", typical(machine("slats", 4, 10), touched)),
    ]
}

/// Late fields of these searches have no closed form, so their time is that of a search with events.
const BY_EVENTS: [&str; 1] = ["backup field"];

fn limits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("triangles-per-field");
    group.sample_size(10).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_secs(1));
    for (name, query) in queries() {
        let limit = query.run(&mut ()).expect("it runs");
        println!("{name}: {} triangles", limit.triangles);
        let level = if BY_EVENTS.contains(&name) { Level::Transaction } else { Level::Analytic };
        let timed = LimitQuery { level, ..query };
        group.bench_function(name, |bench| bench.iter(|| timed.run(&mut ()).expect("it runs")));
    }
    group.finish();
}

criterion_group!(benches, limits);
criterion_main!(benches);
