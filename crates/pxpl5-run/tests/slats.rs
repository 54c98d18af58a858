//! Tests of COPY under Slats: top regions come before bottom ones, and a backup field is shown for a missed retrace.

use pxpl5_framebuffer::NtscDisplay;
use pxpl5_machine::{Arrival, MachineConfig};
use pxpl5_run::{Experiment, Outcome, Pixels, Slats};
use pxpl5_scene::builtin;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{FieldParity, Lines, PeriodNumber, PictureNumber, RegionGrid};
use std::collections::BTreeMap;

fn run(slats: Slats, scene: &str) -> Outcome {
    let scene = builtin(scene).expect("built in");
    let mut machine = MachineConfig::slats();
    machine.displays[0].remember(40);
    let experiment = Experiment::new(machine, slats, scene).fields(30).pixels(Pixels::Off);
    experiment.run().unwrap_or_else(|error| panic!("{slats:?}: {error}"))
}

fn is_top(arrival: &Arrival) -> bool {
    u32::from(arrival.target.region.0) < RegionGrid::FIELD.columns()
}

/// Returns the regions of both eyes, by picture.
fn by_picture(outcome: &Outcome) -> BTreeMap<PictureNumber, Vec<Arrival>> {
    let mut pictures: BTreeMap<PictureNumber, Vec<Arrival>> = BTreeMap::new();
    for arrival in &outcome.observation().arrivals {
        pictures.entry(arrival.target.picture).or_default().push(*arrival);
    }
    pictures
}

/// TR94: the graphics processor sends all top regions before any bottom region. The order also holds for late top
/// regions, with more triangles than the limit.
#[test]
fn no_bottom_region_of_a_field_is_copied_before_all_top_ones() {
    for slats in [Slats::split(), Slats::backup()] {
        for triangles in [60, 147, 160, 200] {
            let outcome = run(slats, &format!("full-screen:{triangles}"));
            let message = outcome.record().ring().timing().occupancy(1_024);
            let mut fields = 0;
            for (picture, regions) in by_picture(&outcome) {
                let (top, bottom): (Vec<Arrival>, Vec<Arrival>) = regions.into_iter().partition(is_top);
                let Some(begin) = bottom.iter().map(|arrival| arrival.begins_at(message)).min() else { continue };
                let copied = top.iter().map(|arrival| arrival.last_part_at).max().expect("top regions");
                assert!(
                    top.len() == 10 && begin > copied,
                    "{slats:?}, {triangles}: {picture:?}, {begin:?}, {copied:?}"
                );
                fields += 1;
            }
            assert!(fields > 5, "{slats:?}, {triangles}: {fields}");
        }
    }
}

/// Checks each field that the beam of an eye scans. The whole field must come from one picture with the lines of the
/// field: the newest picture whose top regions had arrived before the retrace.
///
/// No pixel may arrive behind the beam, and no newer picture may be written into the displayed buffer.
#[test]
fn with_a_backup_only_complete_fields_are_shown() {
    for scene in ["full-screen:147", "full-screen:160", "full-screen:200", "typical:147", "typical:160", "typical:200"]
    {
        let outcome = run(Slats::backup(), scene);
        let display: &NtscDisplay = outcome.record().display_of_kind().expect("an NTSC display");
        let pictures = by_picture(&outcome);
        let mut seen_pictures = [Vec::new(), Vec::new()];
        for field in (8..28).map(PeriodNumber) {
            let parity = FieldParity::of_field(field);
            let [begins, ends] = [field, field.next()].map(|field| display.video().retrace(field));
            // Time of the software for five acknowledgements and for the request, plus their time on the ring.
            let on_its_way = Span::from_ns(6 * 12_000 + 28_000);
            let of_lines = |arrival: &&Arrival| arrival.target.lines == Lines::Field(parity);
            let top_at = |regions: &[Arrival]| {
                let top: Vec<_> = regions.iter().filter(|arrival| is_top(arrival)).filter(of_lines).collect();
                (top.len() == 10).then(|| top.iter().map(|arrival| arrival.last_part_at).max().unwrap_or(Time::ZERO))
            };
            let complete = pictures.iter().filter_map(|(picture, regions)| Some((picture, top_at(regions)?)));
            let complete: Vec<_> = complete.filter(|(_, at)| *at < begins).collect();
            let seen = display.boards().iter().map(|board| board.seen(field).expect("it was scanned"));
            let seen: Vec<_> = seen.collect();
            // The newest picture is expected, or the picture before, if the request could no longer arrive in time.
            let may_be_seen = |picture: &PictureNumber| seen[0].buffer() == pictures[picture][0].target.buffer;
            let newest =
                complete.iter().rev().take(2).find(|(picture, at)| *at + on_its_way < begins || may_be_seen(picture));
            let Some((picture, _)) = newest else { continue };
            let regions = &pictures[picture];
            let buffer = regions[0].target.buffer;
            assert_eq!(regions.len(), 20, "{scene}, {field:?}: all regions of {picture:?}");
            for seen in &seen {
                assert_eq!(seen.buffer(), buffer, "{scene}, {field:?}: {picture:?}");
                assert_eq!(seen.late_regions().len(), 0, "{scene}, {field:?}: {picture:?}");
            }
            let newer = pictures.range(picture.next()..).flat_map(|(_, regions)| regions).filter(of_lines);
            let torn = newer.filter(|arrival| arrival.target.buffer == buffer && arrival.first_part_at < ends);
            assert_eq!(torn.count(), 0, "{scene}, {field:?}: {picture:?}");
            seen_pictures[parity as usize].push(**picture);
        }
        // Fields of both parities show new pictures until the end.
        for of_lines in &mut seen_pictures {
            assert!(of_lines.len() >= 9, "{scene}: {of_lines:?}");
            of_lines.dedup();
            assert!(of_lines.len() >= 4, "{scene}: {of_lines:?}");
        }
    }
}

/// A late field is shown at a later retrace of its lines. A retrace at which no new field is shown counts as missed.
#[test]
fn with_a_backup_a_late_field_is_shown_later_and_retraces_without_a_new_field_are_missed() {
    let shown = |scene: &str| {
        let outcome = run(Slats::backup(), scene);
        let periods = outcome.pictures().iter().filter(|times| times.is_shown()).map(|times| {
            let period = outcome.record().display().period_at(times.shown_at);
            (times.picture.period_drawn_for(), period)
        });
        (periods.collect::<Vec<_>>(), outcome.due())
    };
    let (in_time, due) = shown("full-screen:140");
    assert!(in_time.len() > 20 && in_time.iter().all(|(drawn_for, shown)| drawn_for == shown), "{in_time:?}");
    assert_eq!(due.map(|due| due.not_shown()), Some(0));
    // 10 and 37 % more than the limit of the split copy.
    for scene in ["full-screen:210", "full-screen:260"] {
        let (periods, due) = shown(scene);
        let late = periods.iter().filter(|(drawn_for, shown)| shown.0 == drawn_for.0 + 2).count();
        assert!(late > 3, "{scene}: {periods:?}");
        assert!(
            periods.iter().all(|(drawn_for, shown)| (shown.0 - drawn_for.0).is_multiple_of(2)),
            "{scene}: {periods:?}"
        );
        assert!(due.is_some_and(|due| due.shown > 0 && due.not_shown() > 0), "{scene}: {due:?}");
    }
}
