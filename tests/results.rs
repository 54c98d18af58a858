//! Tests that results, traces and films agree with the run.

use crate::support::{self, boards, video};
use pxpl5::views::results::{columns, csv};
use pxpl5::views::trace_export::{Events, Slice, Step, Trace, chrome};
use pxpl5::views::{Film, FilmSurfaces};
use pxpl5::{
    Experiment, Eye, Frameless, Jitp, LATENCY_PARTS, MachineConfig, Measured, Outcome, PeriodNumber, Pipeline, Pixels,
    RenderingControl, Report, Slats, Viewpoint, scene, side_by_side,
};
use pxpl5_framebuffer::seen_at;
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PictureNumber, SurfaceId};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::LazyLock;

fn experiment(pipeline: impl Pipeline + 'static, scene: &str, fields: u64) -> Experiment {
    let machine = if pipeline.name() == "slats" { MachineConfig::slats() } else { MachineConfig::small_hmd() };
    let scene = scene::builtin(scene).expect("built in");
    Experiment::new(machine, pipeline, scene).fields(fields)
}

fn run(pipeline: impl Pipeline + 'static, scene: &str, fields: u64) -> Outcome {
    experiment(pipeline, scene, fields).pixels(Pixels::Off).record_traffic(true).run().expect("runs")
}

static STEREO: LazyLock<Outcome> = LazyLock::new(|| run(RenderingControl::stereo(), "mig", 60));
static MONO: LazyLock<Outcome> = LazyLock::new(|| run(RenderingControl::mono(), "molecules", 60));
static SPLIT: LazyLock<Outcome> = LazyLock::new(|| run(Slats::split(), "full-screen:100", 30));
/// A run with so many triangles that every field misses its retrace.
static LATE: LazyLock<Outcome> = LazyLock::new(|| run(Slats::whole(), "full-screen:160", 30));

fn all() -> [&'static Outcome; 4] {
    [&STEREO, &MONO, &SPLIT, &LATE]
}

#[test]
fn the_parts_of_every_latency_add_up_to_the_picosecond() {
    for outcome in all() {
        let parts = outcome.latency_parts();
        assert_eq!(parts.len(), outcome.complete_pictures().count());
        for (parts, times) in parts.iter().zip(outcome.complete_pictures()) {
            assert_eq!(parts.picture, times.picture);
            assert_eq!(parts.published(), times.shown_at - times.transform_at);
            assert_eq!(Some(parts.begin), times.sampled_at);
            let video = video(outcome);
            let field = video.field_at(times.shown_at);
            let line = u32::try_from(field.0 % 2).expect("0 or 1");
            assert_eq!(Some(parts.end()), video.when(0, line, field));
        }
    }
}

/// Returns runs of pipelines that race the beam and do not swap.
fn racing() -> [Outcome; 3] {
    [
        run(Jitp::new(Viewpoint::Strip, true), "full-screen:2", 12),
        run(Jitp::new(Viewpoint::Field, false), "full-screen:2", 12),
        run(Frameless::new(), "full-screen:2", 6),
    ]
}

#[test]
fn without_a_swap_the_stages_belong_to_the_strip_that_meets_the_beam() {
    for outcome in racing() {
        let stages = outcome.stages();
        for (parts, times) in outcome.latency_parts().iter().zip(outcome.complete_pictures()) {
            assert_eq!(parts.published(), times.shown_at - times.transform_at);
            assert_eq!(parts.end(), times.shown_at);
            let [transform, render] = [Stage::Transform, Stage::Render].map(|stage| {
                let span = stages.iter().find(|s| (s.stage, s.picture) == (stage, times.picture)).expect("marked");
                (span.begin, span.end.expect("ended"))
            });
            assert_eq!(transform.0, times.transform_at);
            let path = [transform.0, transform.1, render.0, render.1, times.copied_at.expect("copied"), times.shown_at];
            assert!(path.is_sorted(), "{}: {path:?}", outcome.pipeline().name());
        }
    }
}

/// Returns the time at which the last board ended a stage of a picture.
fn end_of(outcome: &Outcome, stage: Stage, surface: Option<SurfaceId>, picture: PictureNumber) -> Time {
    let marks = outcome.observation().marks.iter();
    let ends = marks.filter(|m| (m.stage, m.surface, m.picture, m.edge) == (stage, surface, picture, StageEdge::End));
    ends.map(|mark| mark.time).max().expect("marked")
}

/// Returns the index of a part in [`LATENCY_PARTS`].
fn part(name: &str) -> usize {
    LATENCY_PARTS.iter().position(|part| part.name == name).expect("a part")
}

#[test]
fn a_stage_is_the_time_between_its_two_marks() {
    let outcome = &*STEREO;
    for (parts, times) in STEREO.latency_parts().iter().zip(STEREO.steady_pictures()) {
        let copied_at = times.copied_at.expect("copied");
        assert_eq!(parts.spans[part("wait_for_retrace")], times.shown_at - copied_at);
        let rendered_at = end_of(outcome, Stage::Render, Some(Eye::Right.into()), times.picture);
        let rest: Span = parts.spans[part("wait_for_copy")] + parts.spans[part("copy")];
        assert_eq!(rest, copied_at - rendered_at);
        let transformed_at = end_of(outcome, Stage::Transform, Some(Eye::Left.into()), times.picture);
        assert_eq!(parts.spans[part("transform")], transformed_at - times.transform_at);
        let sent_at = end_of(outcome, Stage::Send, None, times.picture);
        assert_eq!(parts.spans[part("send")], sent_at - times.sampled_at.expect("sampled"));
    }
}

fn mean_ms(report: &Report, of: &str, until: &str) -> f64 {
    let found = report.latency_by_eye_ms.iter().find(|entry| (entry.of.as_str(), entry.until) == (of, until));
    found.expect("listed").statistics.statistics.mean
}

#[test]
fn the_latencies_of_the_eyes_equal_the_times_between_their_events() {
    let outcome = &*STEREO;
    let report = outcome.report();
    // The latency of a frame is the latency of the pair: from its first TRANSFORM to the swap.
    assert!((mean_ms(&report, "pair", "swap") - report.latency_ms.statistics.mean).abs() < 1e-9);
    let pictures = outcome.steady_pictures().iter();
    let to_copy: Vec<f64> =
        pictures.map(|times| (times.copied_at.expect("copied") - times.transform_at).as_ms()).collect();
    let expected = to_copy.iter().sum::<f64>() / to_copy.len() as f64;
    assert!((mean_ms(&report, "pair", "end_of_copy") - expected).abs() < 1e-9);
    // Both eyes are swapped in at the same instant, so their latencies differ by the time between their TRANSFORMs.
    let [at_swap, at_light] =
        ["swap", "light"].map(|until| mean_ms(&report, "left", until) - mean_ms(&report, "right", until));
    assert!(at_swap > 0.0 && (at_light - at_swap).abs() < 1e-9);
    assert!(SPLIT.report().latency_by_eye_ms.is_empty());
}

#[test]
fn csv_starts_with_column_names_and_has_the_latency_of_the_report() {
    for outcome in all() {
        let text = csv(outcome);
        let report = outcome.report();
        let rows = rows(&text);
        assert_eq!(rows.len(), outcome.pictures().len());
        // A picture that was not complete in time has no latency.
        assert!(rows.iter().all(|row| row["latency_ps"].is_some() == (row["complete"] == Some(1))));
        let steady = rows.iter().filter(|row| row["steady"] == Some(1));
        let latencies: Vec<f64> = steady.filter_map(|row| Some(row["latency_ps"]? as f64 * 1e-9)).collect();
        assert_eq!(latencies.len() as u64, report.latency_ms.statistics.n);
        let mean = latencies.iter().sum::<f64>() / latencies.len() as f64;
        assert!(latencies.is_empty() || (mean - report.latency_ms.statistics.mean).abs() < 1e-9);
        let incomplete = rows.iter().filter(|row| row["complete"] == Some(0)).count();
        assert_eq!(incomplete, outcome.pictures().iter().filter(|times| !times.is_shown()).count());
    }
}

/// Parses the table of a CSV file.
fn rows(text: &str) -> Vec<BTreeMap<String, Option<u64>>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let expected: Vec<String> = columns().into_iter().map(|column| column.name).collect();
    assert_eq!(names, expected);
    lines.map(|line| row(&names, line)).collect()
}

fn row(names: &[&str], line: &str) -> BTreeMap<String, Option<u64>> {
    let values: Vec<Option<u64>> = line.split(',').map(|value| value.parse().ok()).collect();
    assert_eq!(values.len(), names.len());
    names.iter().map(|name| (*name).to_owned()).zip(values).collect()
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_equals_csv() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let mut bytes = Vec::new();
    pxpl5::views::results::parquet(&STEREO, &mut bytes).expect("written");
    let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).expect("Parquet");
    let metadata = reader.metadata().file_metadata().key_value_metadata().expect("there").clone();
    let hash = metadata.iter().find(|entry| entry.key == "pxpl5.config_hash").and_then(|entry| entry.value.clone());
    assert_eq!(hash, Some(STEREO.report().config_hash));
    let found: Vec<BTreeMap<String, Option<u64>>> = reader
        .get_row_iter(None)
        .expect("rows")
        .map(|row| {
            let value = |field: &Field| if let Field::Long(v) = field { u64::try_from(*v).ok() } else { None };
            row.expect("a row").get_column_iter().map(|(name, field)| (name.clone(), value(field))).collect()
        })
        .collect();
    assert_eq!(found, rows(&csv(&STEREO)));
}

/// Returns all slices of a trace that are part of a flow, with the id and the step of the flow.
fn flow_slices(trace: &Trace) -> Vec<(u64, Step, &Slice)> {
    let slices = trace.tracks.iter().filter_map(|t| if let Events::Slices(s) = &t.events { Some(s) } else { None });
    slices.flatten().filter_map(|slice| slice.flow.map(|flow| (flow.id, flow.step, slice))).collect()
}

#[test]
fn a_trace_has_an_instant_at_every_retrace() {
    let trace = Trace::of(&SPLIT);
    let track = trace.tracks.iter().find(|track| track.name == "retraces").expect("a track");
    let Events::Instants(retraces) = &track.events else { panic!("{:?}", track.events) };
    assert_eq!(retraces.len() as u64, SPLIT.fields() + 1);
    for (n, (time, name)) in (0..).zip(retraces) {
        // The period of 1001/60000 s is rounded down to picoseconds.
        assert_eq!((time.0, name.clone()), (n * 1_001_000_000_000_000 / 60_000, format!("retrace {n}")));
    }
}

#[test]
fn flows_lead_from_send_to_the_first_field_that_shows_the_picture() {
    for outcome in all() {
        let trace = Trace::of(outcome);
        let slices = flow_slices(&trace);
        for times in outcome.steady_pictures() {
            let of_picture = slices.iter().filter(|(id, ..)| *id == times.picture.next().0);
            let (last, steps): (Vec<&(u64, Step, &Slice)>, Vec<_>) =
                of_picture.partition(|(_, step, _)| *step == Step::Last);
            assert_eq!(last.len(), 1, "picture {}", times.picture);
            assert_eq!(last[0].2.begin, times.shown_at);
            let first = steps.iter().find(|(_, step, _)| *step == Step::First).expect("a first step");
            assert!(first.2.name.starts_with("SEND") || outcome.pipeline().name() == "slats");
            assert!(steps.iter().any(|(.., slice)| slice.name.starts_with("TRANSFORM")));
            assert!(steps.iter().any(|(.., slice)| slice.name.starts_with("RENDER")));
        }
    }
}

#[test]
fn the_counters_of_a_trace_stay_within_the_limits_of_the_machine() {
    for outcome in all() {
        let machine = outcome.record();
        let mut highest: BTreeMap<String, i64> = BTreeMap::new();
        for track in Trace::of(outcome).tracks {
            let Events::Counter(values) = track.events else { continue };
            assert!(values.iter().all(|(_, value)| *value >= 0), "{}", track.name);
            highest.insert(track.name, values.iter().map(|(_, value)| *value).max().unwrap_or_default());
        }
        let channels = machine.ring().stats().channel_busy.len() as i64;
        assert!((1..=channels).contains(&highest["busy channels"]));
        for renderer in 0..machine.renderers().len() {
            // The FIFO holds 1,024 words (assumed: a message of maximum size).
            assert!((1..=1_024).contains(&highest[&format!("FIFO words of renderer {renderer}")]));
        }
    }
}

#[test]
fn recorded_messages_equal_the_counters_of_the_boards() {
    for outcome in all() {
        let machine = outcome.record();
        let traffic = outcome.observation().traffic.as_deref().expect("recorded");
        for (renderer, node) in machine.renderers().iter().zip(&machine.ports().renderers) {
            let to: u64 = traffic.transfers.iter().filter(|t| t.destination == *node).map(|t| u64::from(t.words)).sum();
            // One message may have begun to arrive at the end of the run.
            let begun = renderer.stats().words - to;
            assert!(begun <= 1_024, "{begun} words were never accepted");
        }
        let busy: Span = machine.ring().stats().channel_busy.iter().copied().sum();
        let mut steps = traffic.busy_channels.clone();
        steps.push((outcome.end(), 0));
        let counted: u64 = steps.windows(2).map(|pair| (pair[1].0 - pair[0].0).0 * u64::from(pair[0].1)).sum();
        // The ring counts messages that have ended, and the counter also includes those in transfer.
        let tolerance = 8 * 8_000_000_000;
        assert!(counted >= busy.0 && counted < busy.0 + tolerance, "{counted} and {}", busy.0);
    }
}

#[test]
fn recording_traffic_changes_no_result() {
    let quiet = experiment(Slats::split(), "full-screen:100", 30).pixels(Pixels::Off).run().expect("runs");
    assert_eq!(quiet.record().trace_hash(), SPLIT.record().trace_hash());
    assert!(has_messages(&SPLIT));
    assert!(!has_messages(&quiet));
}

fn has_messages(outcome: &Outcome) -> bool {
    Trace::of(outcome).tracks.iter().any(|track| track.name == "messages in")
}

#[test]
fn the_file_of_a_trace_has_its_slices_to_the_picosecond() {
    // Each picture has slices of all kinds.
    let outcome = run(RenderingControl::mono(), "molecules", support::sample_or_all(20, 60));
    let trace = Trace::of(&outcome);
    let mut bytes = Vec::new();
    chrome(&trace, &mut bytes).expect("memory can be written");
    let json: Value = serde_json::from_slice(&bytes).expect("JSON");
    assert_eq!(json["otherData"]["config_hash"], outcome.report().config_hash);
    // The text is decimal and not rounded.
    let text = String::from_utf8(bytes).expect("UTF-8");
    let written = text.lines().filter(|line| line.contains("\"ph\":\"X\""));
    let written: Vec<(u64, u64)> =
        written.map(|line| (ps(line, "ts").expect("ts"), ps(line, "dur").expect("dur"))).collect();
    let slices = trace.tracks.iter().filter_map(|t| if let Events::Slices(s) = &t.events { Some(s) } else { None });
    let expected: Vec<(u64, u64)> = slices.flatten().map(|s| (s.begin.0, (s.end - s.begin).0)).collect();
    assert!(expected.len() > 1_000);
    assert_eq!(written, expected);
    let events = json["traceEvents"].as_array().expect("array");
    let [begun, ended] = ["s", "f"].map(|kind| events.iter().filter(|event| event["ph"] == kind).count());
    assert_eq!(begun, ended, "every flow that begins ends");
}

/// Returns a time of a JSON line in picoseconds. The line has microseconds with six decimals.
fn ps(line: &str, key: &str) -> Option<u64> {
    let rest = line.split(&format!("\"{key}\":")).nth(1)?;
    let (whole, decimals) = rest.split(['}', ',']).next()?.split_once('.')?;
    Some(whole.parse::<u64>().ok()? * 1_000_000 + decimals.parse::<u64>().ok()?)
}

fn frames(bytes: &[u8]) -> (png::Info<'static>, Vec<Vec<u8>>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("PNG");
    let n = reader.info().animation_control().expect("animated").num_frames;
    let frames = (0..n).map(|_| {
        let mut frame = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut frame).expect("a frame");
        assert_eq!(reader.info().frame_control().map(|f| (f.delay_num, f.delay_den)), Some((1_001, 60_000)));
        frame
    });
    let frames = frames.collect();
    (reader.info().clone(), frames)
}

/// Returns a short run that keeps all of its fields.
fn remembered() -> (Experiment, Outcome) {
    let mut machine = MachineConfig::slats();
    machine.displays[0].remember(100);
    let scene = scene::builtin("mig").and_then(|scene| scene.decimated(100)).expect("built in");
    let experiment = Experiment::new(machine, Slats::split(), scene).fields(12);
    let outcome = experiment.run().expect("runs");
    (experiment, outcome)
}

#[test]
fn a_film_shows_every_field_at_the_true_rate() {
    let (experiment, outcome) = remembered();
    let mut bytes = Vec::new();
    Film::new(experiment, PeriodNumber(6), 4, FilmSurfaces::All)
        .write(&[("seed", "1".to_owned())], &mut bytes)
        .expect("written");
    let (info, frames) = frames(&bytes);
    assert_eq!((info.width, info.height, frames.len()), (1_280, 480, 4));
    assert!(info.utf8_text.iter().any(|text| text.keyword == "pxpl5 seed"));
    for (field, frame) in (6..).zip(frames) {
        let [left, right] = [0, 1].map(|board: usize| {
            let [before, now] =
                [field - 1, field].map(|n| boards(&outcome)[board].seen(PeriodNumber(n)).expect("remembered"));
            now.interlaced_with(&before)
        });
        assert!(frame == side_by_side(&left, &right).into_raw(), "field {field}");
    }
}

/// Returns some pixels of a row.
fn pixels(picture: &image::RgbImage, y: u32, x: std::ops::Range<u32>) -> Vec<image::Rgb<u8>> {
    x.map(|x| *picture.get_pixel(x, y)).collect()
}

#[test]
fn below_the_beam_a_viewer_still_sees_the_last_field_with_the_same_lines() {
    let (_, outcome) = remembered();
    let board = &boards(&outcome)[0];
    let fields: Vec<_> = (7..10).map(|n| board.seen(PeriodNumber(n)).expect("remembered")).collect();
    let video = video(&outcome);
    let [oldest, before, now] = [0, 1, 2].map(|i| fields[i].picture());
    // Field 9 scans the odd lines. The beam is at pixel 320 of line 201.
    let at = video.when(320, 201, PeriodNumber(9)).expect("scanned");
    let screen = seen_at(video, at, &fields);
    assert_eq!(pixels(&screen, 199, 0..640), pixels(&now, 99, 0..640));
    assert_eq!(pixels(&screen, 201, 0..321), pixels(&now, 100, 0..321));
    assert_eq!(pixels(&screen, 201, 321..640), pixels(&oldest, 100, 321..640));
    assert_eq!(pixels(&screen, 203, 0..640), pixels(&oldest, 101, 0..640));
    assert_eq!(pixels(&screen, 200, 0..640), pixels(&before, 100, 0..640));
    // One picosecond earlier, the pixel under the beam is still the old one.
    let earlier = seen_at(video, Time(at.0 - 1), &fields);
    assert_eq!(earlier.get_pixel(320, 201), oldest.get_pixel(320, 100));
    assert_ne!(now, oldest, "the head moves");
}

#[test]
fn the_documents_define_every_column() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/guide/latency.md")).expect("there");
    for column in columns() {
        let row = text.lines().find(|line| line.starts_with(&format!("| `{}` |", column.name)));
        assert!(row.is_some(), "{} is not in docs/guide/latency.md", column.name);
    }
    for part in LATENCY_PARTS {
        let row = text.lines().find(|line| line.starts_with(&format!("| `{}_ps` |", part.name))).expect("a row");
        assert_eq!(row.contains("| yes |"), part.published, "{}", part.name);
    }
}
