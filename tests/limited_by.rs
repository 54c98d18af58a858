//! The limiting resource of a machine: the chain of waits that ends with a picture, and how busy each kind of board is.

use pxpl5::{Experiment, MachineConfig, Measured, Pixels, RenderingControl, Report, Resource, scene};

fn report(scene: &str, boards: (u64, u64), fields: u64) -> Report {
    let mut machine = MachineConfig::small_hmd();
    machine.set("n_gps", boards.0).expect("in range");
    machine.set("n_renderers", boards.1).expect("in range");
    let scene = scene::builtin(scene).expect("built in");
    let experiment = Experiment::new(machine, RenderingControl::stereo(), scene).fields(fields).pixels(Pixels::Off);
    experiment.run().unwrap_or_else(|error| panic!("{error}")).report()
}

fn limit(report: &Report) -> Resource {
    let path = report.critical_path.as_ref().expect("pictures were shown");
    let shares: f64 = path.parts.iter().map(|part| part.share).sum();
    assert!((shares - 1.0).abs() < 1e-9, "each instant belongs to one resource: {shares}");
    assert_eq!(path.share(Resource::Other), 0.0, "every instant is explained: {path:?}");
    path.parts[0].resource
}

/// COPY of an eye takes 15.6 ms (TR94: 20 regions of 780 us) of the two fields of a frame, 33.37 ms: 46.8 % of the
/// time.
#[test]
fn the_aircraft_is_limited_by_copy_through_the_ports() {
    let report = report("mig", (30, 5), 240);
    assert_eq!(limit(&report), Resource::Ports);
    let utilisation = report.utilisation.expect("it ran");
    for port in &utilisation.ports.each {
        assert!((port.busy - 15.6 / 33.367).abs() < 0.01, "{port:?}");
    }
    assert!(utilisation.ring.channels.mean < 0.2 && utilisation.renderers.executing.max < 0.2, "{utilisation}");
    // 2 x 307,200 pixels in 33.37 ms are 18.4 million words a second. Commands are additional words.
    assert!((18.4e6..22e6).contains(&utilisation.ring.words_per_second), "{utilisation}");
    assert!((utilisation.ring.capacity - 160e6).abs() < 1.0, "8 channels of 20 million words a second");
}

/// The commands of 8,000 triangles and two eyes take the renderers 30.4 ms, and COPY of both eyes takes 31.2 ms.
/// Renderers that store finished regions draw meanwhile, so they are the limit only of more triangles.
#[test]
fn sixteen_thousand_typical_triangles_are_limited_by_the_renderers() {
    let report = report("typical:16000", (30, 5), 120);
    assert_eq!(limit(&report), Resource::Renderers);
    let renderers = report.utilisation.expect("it ran").renderers;
    assert!((0.85..1.0).contains(&renderers.executing.mean) && renderers.executing.idle == 0, "{renderers:?}");
    assert!(renderers.executing.mean + renderers.copying < 1.0, "no controller does both at a time: {renderers:?}");
}

/// One region holds most of the head, so one renderer works and those without a region wait.
#[test]
fn the_head_on_the_largest_machine_is_limited_by_one_renderer() {
    let report = report("head", (50, 20), 120);
    assert_eq!(limit(&report), Resource::Renderers);
    let path = report.critical_path.as_ref().expect("pictures were shown");
    assert!(path.limited_by.ends_with("renderer 0)"), "{}", path.limited_by);
    let executing = report.utilisation.expect("it ran").renderers.executing;
    assert!(executing.max > 0.97 && executing.busiest == 0 && executing.idle == 9, "{executing:?}");
}

/// The latency along the critical path equals the latency of the report: from the start of TRANSFORM to the retrace.
#[test]
fn the_links_of_the_critical_path_add_up_to_the_latency() {
    let report = report("full-screen:12", (13, 5), 60);
    let path = report.critical_path.expect("pictures were shown");
    let statistics = report.latency_ms.statistics;
    assert!(
        (statistics.min - 1e-6..=statistics.max + 1e-6).contains(&path.latency_ms),
        "{} {statistics:?}",
        path.latency_ms
    );
    assert!(path.pictures > 10 && !path.chain.is_empty());
}
