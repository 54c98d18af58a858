//! Slats with what the papers name as future work: a backup field, several graphics processors, more renderers.

use pxpl5::levels::Program;
use pxpl5::limit::{Growing, LimitQuery};
use pxpl5::scene::builtin;
use pxpl5::{Binning, Experiment, MachineConfig, Outcome, Pixels, Slats};

fn run(slats: Slats, scene: &str) -> Outcome {
    let scene = builtin(scene).expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), slats, scene).fields(20).pixels(Pixels::Off);
    experiment.run().expect("it runs")
}

fn limit(gps: usize, renderers: usize, slats: Slats, growing: Growing) -> u32 {
    let config = MachineConfig { n_gps: gps, n_renderers: renderers, ..MachineConfig::slats() };
    let query = LimitQuery { growing, ..LimitQuery::no_miss(config, Program::from(slats)) };
    query.search().expect("it runs").triangles
}

#[test]
fn a_complete_field_goes_to_the_other_buffer_and_is_shown() {
    let outcome = run(Slats::backup(), "full-screen:60");
    assert_eq!(outcome.report().missed_retraces, 0);
    // Even and odd lines each change buffers every second field: two fields from one buffer, two from the other.
    let buffers: Vec<u8> = outcome.observation().arrivals.iter().map(|arrival| arrival.target.buffer).collect();
    assert!(buffers.contains(&0) && buffers.contains(&1));
}

#[test]
fn an_incomplete_field_is_never_shown_with_a_backup() {
    let outcome = run(Slats::backup(), "full-screen:200");
    assert!(outcome.report().missed_retraces > 0);
    // Nothing was ever complete, so the first buffer stays on the screen and all regions went to the other one.
    assert!(outcome.machine().frame_buffers().iter().all(|board| board.displayed() == 0));
    assert!(outcome.observation().arrivals.iter().all(|arrival| arrival.target.buffer == 1));
}

#[test]
fn a_backup_costs_a_few_triangles_of_the_limit_of_a_whole_copy() {
    let (whole, backup) =
        (limit(1, 5, Slats::whole(), Growing::FullScreen), limit(1, 5, Slats::backup(), Growing::FullScreen));
    assert!(backup <= whole && whole - backup <= 10, "{whole} and {backup}");
}

#[test]
fn typical_triangles_sent_only_where_they_touch_raise_the_limit() {
    let touched = Slats { binning: Binning::Touched, ..Slats::split() };
    let (all, touched) = (limit(1, 5, Slats::split(), Growing::Typical), limit(1, 5, touched, Growing::Typical));
    assert!(touched > all, "{touched} and {all}");
}
