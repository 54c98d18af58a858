//! Tests that timelines agree with the simulated run.

#[path = "../examples/figures/list.rs"]
mod list;

use crate::support::video;
use list::PIPELINE_FIGURES;
use proptest::prelude::*;
use pxpl5::views::timeline::{Bar, MAX_FIELDS, Timeline, TimelineOptions, svg};
use pxpl5::{
    Experiment, MachineConfig, Measured, Outcome, PeriodNumber, PictureNumber, Pixels, RenderingControl, Slats, scene,
};
use pxpl5_gp::Stage;
use pxpl5_sim::{Span, Time};
use std::sync::LazyLock;

fn outcome(pipeline: impl pxpl5::Pipeline + 'static, scene: &str, fields: u64) -> Outcome {
    let machine = if pipeline.name() == "slats" { MachineConfig::slats() } else { MachineConfig::small_hmd() };
    let scene = scene::builtin(scene).expect("built in");
    Experiment::new(machine, pipeline, scene).fields(fields).pixels(Pixels::Off).run().expect("runs")
}

static TRIVIAL: LazyLock<Outcome> = LazyLock::new(|| outcome(RenderingControl::stereo(), "full-screen:12", 40));
static SPLIT: LazyLock<Outcome> = LazyLock::new(|| outcome(Slats::split(), "full-screen:100", 20));

fn timeline(outcome: &Outcome) -> Timeline {
    Timeline::of(outcome, &TimelineOptions::default())
}

fn bars<'a>(timeline: &'a Timeline, row: &str) -> Vec<&'a Bar> {
    timeline.rows.iter().filter(|r| r.name == row).flat_map(|r| &r.bars).collect()
}

/// Time of COPY: 20 regions of 15 messages with 1,024 words and 16 words of overhead, 50 ns each (TR94: 780 us a
/// region).
const COPY: Span = Span(20 * 15 * (1_024 + 16) * 50_000);

/// Difference of paths on the ring. The first region may come from the farthest of five renderers and the last from the
/// nearest: four hops of 50 ns less.
const WAYS: Span = Span(4 * 50_000);

#[test]
fn a_copy_of_the_trivial_scene_takes_twenty_region_times() {
    let timeline = timeline(&TRIVIAL);
    for row in ["left frame buffer", "right frame buffer"] {
        for bar in bars(&timeline, row) {
            let span = bar.end - bar.begin;
            // The command of each region reaches its renderer a few microseconds after the previous region has left.
            assert!(span + WAYS >= COPY && span < COPY + Span::from_us(100), "{row}: {span}");
        }
    }
}

#[test]
fn the_dark_strip_covers_exactly_the_arrivals_of_regions() {
    let timeline = timeline(&TRIVIAL);
    for bar in bars(&timeline, "left frame buffer") {
        let received: Span = bar.receiving.iter().map(|(begin, end)| *end - *begin).sum();
        assert!(received + WAYS >= COPY, "{received} of {COPY}");
        assert_eq!(bar.receiving.first().map(|times| times.0), Some(bar.begin));
        assert_eq!(bar.receiving.last().map(|times| times.1), Some(bar.end));
    }
}

#[test]
fn in_a_split_copy_the_top_ends_before_the_retrace_and_the_bottom_begins_after_it() {
    let timeline = timeline(&SPLIT);
    let copies = bars(&timeline, "right frame buffer");
    assert!(copies.iter().any(|bar| bar.bottom == Some(true)));
    for bar in copies {
        let retrace = video(&SPLIT).retrace(bar.picture.period_drawn_for());
        match bar.bottom {
            Some(true) => assert!(bar.begin >= retrace),
            Some(false) => assert!(bar.end <= retrace),
            None => panic!("picture {} is copied in halves", bar.picture),
        }
    }
}

#[test]
fn the_path_of_the_chosen_picture_leads_from_its_sample_to_light() {
    for outcome in [&*TRIVIAL, &*SPLIT] {
        let timeline = timeline(outcome);
        assert!(timeline.arrows.len() >= 6);
        assert!(timeline.arrows.iter().all(|arrow| arrow.begin <= arrow.end));
        let times = outcome.pictures().iter().find(|t| Some(t.picture) == timeline.picture).expect("it was shown");
        let video = video(outcome);
        let field = video.field_at(times.shown_at);
        let light = video.when(0, u32::try_from(field.0 % 2).expect("0 or 1"), field).expect("visible");
        assert!(timeline.arrows.iter().any(|arrow| arrow.end == light), "no arrow ends at {light}");
        assert!(timeline.arrows.iter().all(|arrow| arrow.begin >= timeline.arrows[0].begin));
    }
}

#[test]
fn a_slats_picture_shows_a_view_that_had_reached_the_processor() {
    let timeline = timeline(&SPLIT);
    let send = bars(&timeline, "host").into_iter().find(|bar| timeline.is_chosen(bar)).expect("in the drawing");
    let work = bars(&timeline, "graphics processors").into_iter().find(|bar| timeline.is_chosen(bar)).expect("there");
    assert!(send.end < work.begin);
    let newer = SPLIT.stages().into_iter().filter(|s| s.stage == Stage::Send && s.picture == send.picture.next());
    assert!(newer.map(|s| s.end.expect("sent")).all(|end| end + Span::from_us(12) > work.begin));
}

#[test]
fn every_drawing_is_well_formed_and_the_same_twice() {
    for outcome in [&*TRIVIAL, &*SPLIT] {
        let drawing = svg(outcome, &TimelineOptions::default());
        assert_eq!(drawing, svg(outcome, &TimelineOptions::default()));
        let document = roxmltree::Document::parse(&drawing).expect("XML");
        let ids: Vec<_> = document.descendants().filter_map(|node| node.attribute("id")).collect();
        for used in drawing.split("url(#").skip(1).filter_map(|rest| rest.split(')').next()) {
            assert!(ids.contains(&used), "{used} is used but not defined");
        }
        let text: String = document.descendants().filter_map(|node| node.text()).collect();
        for fact in ["config_hash", "seed: 1", "level: transaction", "version: "] {
            assert!(text.contains(fact), "{fact} is missing");
        }
    }
}

#[test]
fn the_retrace_lines_of_a_timeline_are_at_the_computed_positions() {
    let timeline = timeline(&TRIVIAL);
    let drawing = svg(&TRIVIAL, &TimelineOptions::default());
    let document = roxmltree::Document::parse(&drawing).expect("XML");
    let is_line = |node: &roxmltree::Node| node.attribute("class") == Some("retrace") && node.has_tag_name("path");
    let places = document.descendants().filter(is_line).filter_map(|node| node.attribute("d"));
    let found: Vec<f64> = places.map(|d| d[1..].split(' ').next().expect("x").parse().expect("a number")).collect();
    // The axis is 960 - 172 - 14 units long. Retrace n is at n x 1001/60000 s.
    let fields = timeline.retraces.len() - 1;
    let expected = (0..=fields).map(|n| 172.0 + 774.0 * n as f64 / fields as f64);
    // The last line belongs to the legend.
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 0.011, "{found} instead of {expected}");
    }
    assert_eq!(found.len(), fields + 2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn every_request_gives_a_drawing(
        picture in proptest::option::of(prop_oneof![0u64..60, any::<u64>()]),
        first_field in proptest::option::of(prop_oneof![0u64..60, any::<u64>()]),
        fields in proptest::option::of(any::<u64>()),
        without_host: bool,
        title in proptest::option::of(any::<String>()),
    ) {
        let options = TimelineOptions {
            picture: picture.map(PictureNumber),
            first_field: first_field.map(PeriodNumber),
            fields,
            without_host,
            title,
        };
        let timeline = Timeline::of(&SPLIT, &options);
        prop_assert!(timeline.retraces.len() as u64 <= MAX_FIELDS + 1);
        prop_assert!(roxmltree::Document::parse(&svg(&SPLIT, &options)).is_ok());
    }

    #[test]
    fn bars_in_a_lane_do_not_hide_each_other(first in 0u64..30) {
        let options = TimelineOptions { first_field: Some(PeriodNumber(first)), fields: Some(8), ..TimelineOptions::default() };
        let timeline = Timeline::of(&TRIVIAL, &options);
        // Bars that overlap by less than three of the drawing's 794 units may share a lane.
        let touching = Span((timeline.to - timeline.from).0 / 264);
        for row in &timeline.rows {
            for (i, bar) in row.bars.iter().enumerate() {
                let others = row.bars[..i].iter().filter(|other| other.lane == bar.lane);
                let hidden = |other: &Bar| other.end.since(bar.begin.max(other.begin));
                prop_assert!(others.map(hidden).all(|overlap| overlap <= touching));
                prop_assert!(bar.lane < row.lanes && bar.begin < timeline.to && bar.end >= timeline.from);
            }
        }
    }
}

#[test]
fn a_run_that_showed_nothing_yet_is_drawn_from_its_start() {
    let scene = scene::builtin("full-screen:12").expect("built in");
    let run = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(400);
    let error = run.clone().fields(2).run().expect_err("too short");
    assert!(error.to_string().contains("simulate more fields"), "{error}");
    let options = TimelineOptions { picture: Some(PictureNumber(u64::MAX)), ..TimelineOptions::default() };
    let timeline = Timeline::of(&TRIVIAL, &options);
    assert_eq!((timeline.from, timeline.picture, timeline.arrows.len()), (Time::ZERO, None, 0));
}

#[test]
fn the_figures_in_the_documents_are_fresh() {
    for figure in PIPELINE_FIGURES {
        let path = format!("{}/docs/figures/{}.svg", env!("CARGO_MANIFEST_DIR"), figure.name);
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        let options =
            TimelineOptions { title: Some(figure.title()), fields: figure.fields, ..TimelineOptions::default() };
        let drawn = svg(&figure.run().expect("its experiment runs"), &options);
        assert!(kept == drawn, "{path} is stale: cargo run --release --example figures");
    }
}

fn run_of_figure(name: &str) -> Outcome {
    let figure = PIPELINE_FIGURES.iter().find(|figure| figure.name.contains(name)).expect("there");
    figure.run().expect("runs")
}

/// Each of TR94's figures 3, 5 and 6 must show the effect for which it was drawn.
#[test]
fn each_published_figure_shows_the_effect_for_which_it_was_drawn() {
    // A frame takes two fields, so the frame buffers are the bottleneck.
    assert!((run_of_figure("trivial").report().updates_hz.expect("two pictures") - 30.0).abs() < 0.1);
    assert!((run_of_figure("balanced").report().updates_hz.expect("two pictures") - 30.0).abs() < 0.1);
    for slats in [run_of_figure("whole"), run_of_figure("split")] {
        assert_eq!(slats.report().missed_retraces, Some(0));
        assert!((slats.report().latency_fields.statistics.mean - 1.0).abs() < 1e-9);
    }
}

/// The viewer walks sideways through a hall that lies in all four memories. Each memory has a row of its own, and a
/// heading in the trace.
#[test]
fn each_display_memory_has_a_row_with_received_and_shown_pictures() {
    let registry = pxpl5::registry();
    let entry = registry.pipeline("arp-cells").expect("listed");
    let config = registry.machine_of(MachineConfig::preset(entry.preset).expect("a preset"));
    let pipeline = (entry.build)(&pxpl5::PipelineSettings::default());
    let hall = std::sync::Arc::new(scene::builtin("gallery").expect("built in"));
    let motion = std::sync::Arc::new(pxpl5::tracking::motion::Slide::right_at(1.0));
    let tracker = pxpl5::tracking::tracker::TrackerConfig::ideal();
    let head = pxpl5::Head::new(motion, tracker, pxpl5::tracking::predict::PredictorKind::None, 1).expect("in range");
    let experiment = Experiment::with(config, pipeline, hall).fields(60).pixels(Pixels::Off).head(head);
    let outcome = experiment.run().expect("it runs");
    let options = TimelineOptions { fields: Some(12), ..TimelineOptions::default() };
    let timeline = Timeline::of(&outcome, &options);
    let history = pxpl5::run::FaceHistory::held(outcome.record()).expect("a display with faces");
    let mut received = 0;
    for k in 0..4 {
        let row = timeline.rows.iter().find(|row| row.name == format!("arp port {k}")).expect("a row a memory");
        received += row.bars.len();
        // Content of the memory from swap to swap, according to the firmware's record.
        let swapped = |at: Time| history.memory(k).iter().find(|shown| outcome.record().tick(shown.from) == at);
        for shown in &row.shown {
            let noted = swapped(shown.begin).expect("a swap");
            assert_eq!(noted.note.picture, shown.picture, "memory {k}");
        }
        assert!(row.shown.windows(2).all(|pair| pair[0].end == pair[1].begin), "memory {k}");
        assert!(row.bars.windows(2).all(|pair| pair[0].picture < pair[1].picture), "memory {k}");
    }
    assert!(received > 8, "{received}");
    assert!(timeline.rows.iter().all(|row| row.name != "display"), "no row for all memories together");
    let drawing = svg(&outcome, &options);
    assert!(drawing.contains("arp port 3") && drawing.contains("shows "));
    let trace = pxpl5::views::trace_export::Trace::of(&outcome);
    let shown = trace.tracks.iter().filter(|track| track.name == "shown").count();
    let memories = (0..4).filter(|k| !history.memory(*k).is_empty()).count();
    assert_eq!(shown, memories);
}
