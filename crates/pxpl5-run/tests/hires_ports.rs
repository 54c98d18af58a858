//! Tests of the ports of the high-resolution frame buffer: the number of pictures a second that the ports can receive.

use pxpl5_framebuffer::HiResConfig;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Outcome, Pixels, RenderingControl};
use pxpl5_scene::builtin;

/// Rate of the display's scans.
const SCANS_HZ: f64 = 72.0;

/// A region of 128 x 128 words in 16 messages, each with 16 word times of overhead, at 50 ns a word.
const REGION_S: f64 = 16.0 * (1_024.0 + 16.0) * 50e-9;

fn run(ports: u64) -> Outcome {
    let config = HiResConfig { ports, ..HiResConfig::PAPERS };
    let machine = MachineConfig { displays: vec![Box::new(config)], ..MachineConfig::preset("large").expect("listed") };
    let scene = builtin("typical:20").expect("built in");
    let experiment = Experiment::new(machine, RenderingControl::mono(), scene).fields(120).pixels(Pixels::Lazy);
    experiment.run().expect("it is small")
}

/// Returns the pictures a second for a picture of 80 regions. Each picture takes a whole number of scans.
fn allowed_hz(ports: f64) -> f64 {
    SCANS_HZ / ((80.0 / ports).ceil() * REGION_S * SCANS_HZ).ceil()
}

#[test]
fn one_port_carries_14_4_pictures_a_second_and_two_carry_more() {
    let [one, two] = [1, 2].map(|ports| run(ports).updates_hz().expect("pictures are shown"));
    assert!((allowed_hz(1.0) - 14.4).abs() < 1e-9 && (allowed_hz(2.0) - 24.0).abs() < 1e-9);
    assert!((one - allowed_hz(1.0)).abs() < 0.2, "{one} Hz");
    assert!(two > 1.3 * one && two < allowed_hz(2.0) + 0.2, "{two} Hz");
}

#[test]
fn regions_sent_through_two_ports_make_the_same_picture_as_through_one_port() {
    let [one, two] = [1, 2].map(|ports| {
        let outcome = run(ports);
        let display = outcome.record().display();
        assert_eq!(display.faults(), (0, None));
        display.shown(0).expect("a surface")
    });
    assert!(one == two && one.pixels().any(|pixel| *pixel != *one.get_pixel(0, 0)));
}
