//! Observations that remain after a run.

use crate::rig::{
    FIRST_GP, MESSAGE, RENDERERS, SCREEN, SECOND_GP, Say, Screen, ScreenConfig, build, config, copy_command,
    load_sender, machine, say, target, us, words,
};
use pxpl5_framebuffer::NtscDisplay;
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_machine::{Machine, Record, Shown, StageSpan, Transfer};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::Display;
use pxpl5_wire::{CopyPath, NodeId, PeriodNumber, PictureNumber, SurfaceId};

#[test]
fn a_record_has_the_boards_and_numbers_of_its_machine() {
    let mut second = ScreenConfig::new(2);
    second.name = "other";
    second.numbers.period_us = 30;
    let config = config(vec![Box::new(ScreenConfig::new(1)), Box::new(second)]);
    let machine = build(&config);
    let ports = machine.ports().clone();
    let record = machine.into_record();
    assert_eq!(*record.config(), config);
    assert_eq!(*record.ports(), ports);
    assert_eq!((record.ring().n_nodes(), record.renderers().len()), (7, 2));
    let nodes: Vec<&[NodeId]> = record.displays().iter().map(|display| display.nodes()).collect();
    assert_eq!(nodes, [[NodeId(5)], [NodeId(6)]]);
    assert_eq!(record.display().nodes(), [NodeId(5)]);
    assert_eq!([1, 7].map(|n| record.tick(PeriodNumber(n))), [us(100), us(700)], "periods of the first display");
    let labels: Vec<(u16, &str)> = record.surfaces().map(|(id, surface)| (id.0, surface.label)).collect();
    assert_eq!(labels, [(0, "screen"), (1, "other"), (2, "other")]);
    let surface = |id| record.surface(SurfaceId(id)).map(|surface| surface.label);
    assert_eq!([0, 1, 2, 3].map(surface), [Some("screen"), Some("other"), Some("other"), None]);
    assert_eq!(record.display_of_kind::<Screen>().map(Display::nodes), Some(&[NodeId(5)][..]));
    assert!(record.display_of_kind::<NtscDisplay>().is_none());
}

/// A region of fifteen messages takes 780 us (TR94).
#[test]
fn the_longest_message_takes_a_fifteenth_of_a_published_region() {
    let record = machine().into_record();
    assert_eq!(record.message_span() * 15, Span::from_us(780));
}

/// Returns a machine with a display of two ports, one millisecond after the start of the script.
fn run_script(script: &[(u64, Say)]) -> (Machine, [NodeId; 2]) {
    let config = config(vec![Box::new(ScreenConfig::new(2))]);
    let mut machine = Machine::new(&config, 2, pxpl5_renderer::Layout::slats()).expect("valid");
    let ports = machine.ports().display().try_into().expect("two ports");
    say(&mut machine, script);
    machine.switch_on();
    machine.run_until(us(1_000)).expect("it goes on");
    (machine, ports)
}

fn arrived(at: u64, port: u32, picture: u32) -> (u64, Say) {
    (at, Say::Arrived { surface: port, port, picture, first_us_ago: 5 })
}

fn swapped(at: u64, surface: u32, tick: u32) -> (u64, Say) {
    (at, Say::Swapped { surface, tick })
}

#[test]
fn a_port_shows_the_newest_picture_before_each_swap() {
    let (machine, [left, right]) = run_script(&[
        arrived(10, 0, 1),
        arrived(20, 0, 1),
        arrived(30, 1, 7),
        swapped(100, 0, 1),
        arrived(110, 0, 2),
        arrived(120, 0, 3),
        arrived(130, 0, 3),
        swapped(200, 0, 2),
        swapped(300, 0, 3),
        arrived(310, 0, 4),
        swapped(400, 1, 4),
        swapped(500, 0, 5),
        arrived(510, 1, 8),
    ]);
    let shown = |picture, first: u64, at: u64| Shown {
        picture: PictureNumber(picture),
        first_region_at: us(first),
        at: us(at),
    };
    let record = machine.record();
    assert_eq!(record.shown_by(left), [shown(1, 10, 100), shown(3, 120, 200), shown(4, 310, 500)]);
    assert_eq!(record.shown_by(right), [shown(7, 30, 400)]);
    assert!(record.shown_by(FIRST_GP).is_empty());
}

/// The first swap shows an empty buffer, which yields no picture.
#[test]
fn a_swap_before_any_region_shows_no_picture() {
    let (machine, [left, _]) = run_script(&[swapped(100, 0, 1), arrived(110, 0, 2), swapped(200, 0, 2)]);
    let pictures: Vec<u64> = machine.record().shown_by(left).iter().map(|shown| shown.picture.0).collect();
    assert_eq!(pictures, [2]);
}

#[test]
fn copying_is_a_stage_from_the_first_message_on() {
    let (machine, _) = run_script(&[arrived(300, 1, 4), arrived(400, 1, 4)]);
    let message = Span::from_us(780) / 15;
    let span = StageSpan {
        picture: PictureNumber(4),
        surface: Some(SurfaceId(1)),
        stage: Stage::Copy,
        begin: Time(us(300 - 5).0 - message.0),
        end: Some(us(400)),
    };
    assert_eq!(machine.record().stages(), [span]);
    assert_eq!(machine.record().observation().marks.iter().filter(|mark| mark.edge == StageEdge::Begin).count(), 0);
}

fn with_traffic() -> Record {
    let mut machine = machine();
    machine.record_traffic();
    let (length, list) = copy_command(CopyPath::FromPixelMemory, target(SCREEN, 1));
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 4, words(&[0; 4])), (RENDERERS[1], length, list)]);
    machine.switch_on();
    machine.run_until(us(1_500)).expect("it goes on");
    machine.into_record()
}

/// The first word of a message arrives 16 words and its hops after the grant. The last word arrives `words` word times
/// later.
#[test]
fn traffic_has_the_time_of_each_message_and_the_number_of_busy_channels() {
    let record = with_traffic();
    let traffic = record.observation().traffic.as_deref().expect("it was asked for");
    let word = Span::from_ns(50);
    let granted = Time::ZERO + MESSAGE + Span::from_ns(25);
    let begin = granted + word * 16 + word;
    let end = begin + word * 4;
    let first = Transfer { source: FIRST_GP, destination: SECOND_GP, words: 4, begin, end };
    assert_eq!(traffic.transfers[0], first);
    let granted = granted.max(Time::ZERO + MESSAGE * 2 + Span::from_ns(25)).max(end + Span::from_ns(25));
    let begin = granted + word * 16 + word * 3;
    let end = begin + word * 9;
    let second = Transfer { source: FIRST_GP, destination: RENDERERS[1], words: 9, begin, end };
    assert_eq!(traffic.transfers[1], second);
    // All later transfers belong to a region of 128 x 128 pixels in messages of 1,024 words.
    assert_eq!(traffic.transfers.len(), 2 + 16);
    let to_screen = |transfer: &Transfer| (transfer.source, transfer.destination) == (RENDERERS[1], SCREEN);
    assert!(traffic.transfers[2..].iter().all(to_screen));
    // The copy command arrives completely and starts at once, so it leaves the FIFO immediately.
    assert!(traffic.fifo_changes.iter().all(|(renderer, ..)| *renderer == 1));
    assert_eq!(traffic.fifo_changes.iter().map(|(_, _, words)| words).sum::<i64>(), 0, "nothing is left");
    assert!(traffic.fifo_changes.iter().any(|(_, time, words)| (*time, *words) == (end, 9)));
    let busy: Vec<u32> = traffic.busy_channels.iter().map(|(_, busy)| *busy).collect();
    assert!(busy.iter().all(|busy| *busy <= 1) && busy.contains(&1), "one message at a time: {busy:?}");
    assert!(machine().into_record().observation().traffic.is_none(), "it was not requested");
}
