//! Data for the block diagram and the guided tours of the page. The data are stages of processors, messages, regions
//! that are being drawn or copied, and the age of the shown picture.

use pxpl5_gp::StageEdge;
use pxpl5_machine::{Board, Record};
use pxpl5_run::{PictureTimes, Stepper};
use pxpl5_sim::Time;
use pxpl5_views::palette::class_of;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, RegionPlace};
use serde_json::{Value, json};

/// Returns the name of the stage that a board's processor executes now, in the papers' words and in lower case. Returns
/// `None` between two stages.
pub(crate) fn stage(stepper: &Stepper, board: Board) -> Option<&'static str> {
    let ports = stepper.record().ports();
    let marks = &stepper.record().observation().marks;
    let last = marks.iter().rev().find(|mark| mark.time <= stepper.now() && ports.board(mark.node) == board)?;
    (last.edge == StageEdge::Begin).then(|| class_of(last.stage))
}

/// Returns the ring messages that began after an instant, including messages that still occupy a channel. The result
/// has at most `most` messages. If more messages began, only every n-th message is returned.
pub(crate) fn messages(stepper: &Stepper, after: Time, most: usize) -> Value {
    let record = stepper.record();
    let name = |node| record.ports().board(node).to_string();
    // A channel is granted before the first word arrives. The start time identifies a message only within one list.
    let done = record.observation().traffic.as_deref().into_iter().flat_map(|traffic| &traffic.transfers);
    let mut all: Vec<(Time, String, String, u32)> = done
        .filter(|transfer| transfer.begin > after && transfer.begin <= stepper.now())
        .map(|transfer| (transfer.begin, name(transfer.source), name(transfer.destination), transfer.words))
        .collect();
    all.sort();
    let stride = all.len().div_ceil(most.max(1)).max(1);
    let some = all.iter().step_by(stride);
    some.map(|(begin, from, to, words)| json!({"begin_ps": begin.0, "from": from, "to": to, "words": words})).collect()
}

/// Returns the regions that renderers are drawing, then the regions that renderers are copying to displays.
///
/// Each region has its stage (`render` or `copy`), its renderer, the index of its surface, and a rectangle in pixels.
/// `works` is false while the renderer of the region waits for more commands or for the copy command. `lines` is `[0,
/// 1]` if the region covers all lines of the frame. Otherwise `lines` has the first line of the field and the distance
/// between two lines of the field. `surface` is null for a region of a cube face.
pub(crate) fn regions(stepper: &Stepper) -> Value {
    let record = stepper.record();
    let snapshots = || (0..record.renderers().len()).filter_map(|number| Some((number, stepper.renderer(number)?)));
    let drawn = snapshots()
        .filter_map(|(number, snapshot)| Some(region(record, "render", number, snapshot.works(), snapshot.drawing?)));
    let copied = snapshots()
        .filter_map(|(number, board)| Some(region(record, "copy", number, true, place_of(board.copying?.target))));
    drawn.chain(copied).collect()
}

/// Returns the last regions that renderers have drawn, as in [`regions`], each with the time in which its renderer
/// executed commands for it, in microseconds.
pub(crate) fn loads(stepper: &Stepper) -> Value {
    let record = stepper.record();
    // Ten stereo pairs of 20 regions. Pipelines that draw strips have so many that their text would need 200 MB.
    let loads = record.observation().drawn.iter().rev().take(400).map(|(number, drawn)| {
        json!({"region": region(record, "drawn", *number, false, place_of(drawn.target)), "executed_us": drawn.executed.as_ms() * 1e3})
    });
    loads.collect()
}

const fn place_of(CopyTarget { frame_buffer, lines, grid, region, .. }: CopyTarget) -> RegionPlace {
    RegionPlace { frame_buffer: Some(frame_buffer), lines, grid, region }
}

fn region(record: &Record, stage: &str, number: usize, works: bool, place: RegionPlace) -> Value {
    // The surfaces of a display are its frame buffers, in the order of their ports.
    let surface_of = |port: NodeId| {
        record.displays().iter().find_map(|display| {
            display.nodes().iter().position(|node| *node == port).map(|place| place % display.surfaces().len())
        })
    };
    let lines = match place.lines {
        Lines::Frame => [0, 1],
        Lines::Field(FieldParity::Even) => [0, 2],
        Lines::Field(FieldParity::Odd) => [1, 2],
    };
    json!({
        "stage": stage, "renderer": number, "works": works, "surface": place.frame_buffer.and_then(surface_of),
        "rectangle": place.grid.rectangle(place.region), "lines": lines,
    })
}

/// Returns the age of the shown picture in milliseconds: the time since the tracker measured the head for it, or without a
/// tracker, since the pose was sampled. The result is `null` before the first picture. The result is also `null` for a pipeline whose picture combines several samples.
///
/// The field that the beam draws now is not yet evaluated. A picture in this field counts as shown if it is complete.
/// An incomplete picture counts as shown only if the previous picture was shown, and if the missing regions can still
/// arrive ahead of the beam.
pub(crate) fn age(stepper: &Stepper) -> Value {
    let (now, record) = (stepper.now(), stepper.record());
    let field = stepper.period();
    // Evaluate the present field as if it were finished.
    let mut pictures = stepper.experiment().pipeline().pictures(record, record.tick(field.next()));
    pictures.retain(|times| times.shown_at <= now);
    let in_progress = |times: &PictureTimes| times.copied_at.is_none() && times.shown_at >= record.tick(field);
    let shown = match pictures.as_slice() {
        [.., before, last] if in_progress(last) && before.is_shown() => Some(last),
        all => all.iter().rev().find(|times| times.is_shown()),
    };
    let Some(times) = shown else { return Value::Null };
    let Some(sampled) = times.sampled_at.filter(|at| *at <= now) else { return Value::Null };
    // The host samples the newest report, which the tracker has measured some time before.
    let report = stepper.head().and_then(|head| {
        let of_view = head.sampled().into_iter().rfind(|pose| pose.number == times.view);
        of_view?.measured_at
    });
    let begun = report.unwrap_or(sampled);
    json!({"picture": times.picture.0, "age_ms": now.since(begun).as_ms(), "shown_ms": times.shown_at.since(begun).as_ms()})
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::Files;
    use crate::session::Session;
    use std::collections::BTreeSet;

    fn session(pipeline: &str) -> Session {
        let settings = format!("pipeline={pipeline}\nscene=aircraft\nfields=60\n");
        Session::new(&settings, &Files::default()).expect("known settings")
    }

    /// Tests the order of the stages in TR94: TRANSFORM, then commands on the ring, then RENDER, then COPY.
    #[test]
    fn stages_messages_and_regions_appear_in_the_order_of_the_paper() {
        let mut session = session("rendering-control");
        let mut first = [None; 4];
        for step in 1..20_000_u64 {
            session.run_to(step * 20_000_000);
            let stepper = &session.stepper;
            let seen = [
                stage(stepper, Board::Gp(1)) == Some("transform"),
                stepper
                    .channels()
                    .iter()
                    .any(|on| matches!(stepper.record().ports().board(on.destination), Board::Renderer(_))),
                in_stage(stepper, "render") > 0,
                in_stage(stepper, "copy") > 0,
            ];
            first.iter_mut().zip(seen).filter(|(at, seen)| at.is_none() && *seen).for_each(|(at, _)| *at = Some(step));
            if first.iter().all(Option::is_some) {
                break;
            }
        }
        let [transform, commands, drawn, copied] = first.map(|at| at.expect("it happens"));
        assert!(transform < commands && commands <= drawn && drawn < copied, "{first:?}");
    }

    /// Returns the number of regions that are now in the stage `stage`.
    fn in_stage(stepper: &Stepper, stage: &str) -> usize {
        let all = regions(stepper);
        all.as_array().expect("a list").iter().filter(|region| region["stage"] == stage).count()
    }

    /// Tests that a renderer copies the regions that it has drawn, to the frame buffer of the same eye. A region takes
    /// 20 triangles of 258 clocks, 129 us together. Snapshots 20 us apart therefore show every region.
    #[test]
    fn a_region_is_copied_by_the_renderer_that_drew_it_and_where_it_was_drawn() {
        let settings = "pipeline=rendering-control\nscene=full-screen:20\nfields=60\n";
        let mut session = Session::new(settings, &Files::default()).expect("known settings");
        let [mut drawn, mut copied] = [BTreeSet::new(), BTreeSet::new()];
        for step in 1..10_000_u64 {
            session.run_to(step * 20_000_000);
            for region in regions(&session.stepper).as_array().expect("a list") {
                assert!(region["surface"].as_u64().is_some_and(|surface| surface < 2), "{region}");
                let place = ["renderer", "surface", "rectangle", "lines"].map(|key| region[key].to_string());
                if region["stage"] == "render" {
                    drawn.insert(place);
                } else {
                    assert!(drawn.contains(&place), "{region}");
                    copied.insert(place);
                }
            }
        }
        // A stereo pair of frames has 2 x 20 regions.
        assert!(copied.len() >= 40, "{}", copied.len());
        let loads = loads(&session.stepper);
        let mut us = loads.as_array().expect("a list").iter().filter_map(|load| load["executed_us"].as_f64());
        // Clearing and shading the pixels add to the time of the triangles, and take less than it.
        assert!(us.clone().count() >= 40 && us.all(|us| (129.0..258.0).contains(&us)), "{loads}");
    }

    #[test]
    fn messages_after_a_time_are_listed_up_to_the_requested_number() {
        let mut session = session("slats");
        session.run_to(100_000_000_000);
        let after = Time(90_000_000_000);
        let all = messages(&session.stepper, after, usize::MAX);
        let all = all.as_array().expect("a list");
        assert!(all.len() > 20);
        assert!(all.iter().all(|message| message["begin_ps"].as_u64().is_some_and(|begin| begin > after.0)));
        let few = messages(&session.stepper, after, 5);
        assert!((3..=5).contains(&few.as_array().expect("a list").len()));
    }

    #[test]
    fn a_region_lies_within_the_picture_of_its_eye() {
        let mut session = session("slats");
        let mut seen = 0;
        for step in 1..400_u64 {
            session.run_to(50_000_000_000 + step * 200_000_000);
            for region in regions(&session.stepper).as_array().expect("a list") {
                let [left, top, width, height] =
                    [0, 1, 2, 3].map(|n| region["rectangle"][n].as_u64().expect("a number"));
                let lines = region["lines"][1].as_u64().expect("a number");
                assert!(left + width <= 640 && (top + height) * lines <= 480, "{region}");
                assert!(region["surface"].as_u64().is_some_and(|surface| surface < 2), "{region}");
                seen += 1;
            }
        }
        assert!(seen > 100, "{seen}");
    }

    /// Tests the age of the shown picture under Slats: one field at the retrace (TR94), and two fields before the next
    /// retrace. Behind a tracker that measures every millisecond without delay, the age begins at a whole millisecond.
    #[test]
    fn under_slats_a_picture_is_one_field_old_when_it_is_shown() {
        // A field of NTSC takes 1001/60000 s.
        let field_ms = 1001.0 / 60.0;
        for (tracker, step_ms) in [("", 0.0), ("head.motion=still\nhead.tracker=ideal\nhead.predict=none\n", 1.0)] {
            let mut session = session(&format!("slats\n{tracker}"));
            assert_eq!(age(&session.stepper), Value::Null);
            for step in 0..40 {
                let at_ms = 12.0 * field_ms + 1.0 + f64::from(step);
                session.run_to((at_ms * 1e9) as u64);
                let sampled_ms = ((at_ms / field_ms).floor() - 1.0) * field_ms;
                let measured_ms = sampled_ms - sampled_ms % f64::max(step_ms, 1e-9);
                let found = age(&session.stepper)["age_ms"].as_f64().expect("a picture is shown");
                assert!((found - (at_ms - measured_ms)).abs() < 1e-3, "{found} ms at {at_ms} ms, {tracker}");
            }
        }
    }
}
