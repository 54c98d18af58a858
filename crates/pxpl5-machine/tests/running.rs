//! Tests of a running machine: programs, observations, and the guarantee that observing changes nothing.

use crate::rig::{
    Counted, FIRST_GP, MESSAGE, Notes, RENDERERS, SCREEN, SECOND_GP, Say, ScreenConfig, Script, build, config,
    copy_command, happenings, load, load_sender, machine, say, target, us, words,
};
use pxpl5_gp::{CodeVersion, Processor, RING_MEMORY, Stage};
use pxpl5_machine::{Board, Machine, Optimization, SameThread};
use pxpl5_sim::{Span, Time, TraceHash};
use pxpl5_wire::{Body, CopyPath, NodeId, PeriodNumber, PictureNumber, RegionPixels};
use std::collections::BTreeSet;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::Ordering;

#[test]
fn the_boards_have_the_ports_of_the_schematic() {
    let mut config = config(vec![Box::new(ScreenConfig::new(2)), Box::new(ScreenConfig::new(1))]);
    config.n_gps = 3;
    let machine = Machine::new(&config, 2, pxpl5_renderer::Layout::slats()).expect("valid");
    let ports = machine.ports();
    assert_eq!(ports.host, NodeId(0));
    assert_eq!(ports.gps, [1, 2, 3].map(NodeId));
    assert_eq!(ports.renderers, [4, 5].map(NodeId));
    assert_eq!(ports.displays, [[6, 7].map(NodeId), [8, 9].map(NodeId)], "as many ports as pictures");
    assert_eq!(ports.display(), [6, 7].map(NodeId));
    let boards = (0..10).map(|node| ports.board(NodeId(node)));
    let expected = [
        Board::Host,
        Board::Gp(0),
        Board::Gp(1),
        Board::Gp(2),
        Board::Renderer(0),
        Board::Renderer(1),
        Board::Display(0),
        Board::Display(0),
        Board::Display(1),
        Board::Display(1),
    ];
    assert!(boards.eq(expected));
    assert_eq!(machine.record().ring().n_nodes(), 10);
    assert_eq!(machine.processors().len(), 4, "the host's is one");
}

#[test]
fn boards_that_run_programs_are_found_by_name() {
    let mut machine = machine();
    load_sender(&mut machine, NodeId(0), Vec::new());
    load(&mut machine, SECOND_GP, |gp| async move {
        gp.spend(Span::from_us(3)).await;
        Ok(())
    });
    machine.switch_on();
    machine.run_until(us(10)).expect("it goes on");
    let programs = |board: Board| machine.board(board).map(|found| found.snapshot(us(10)).busy);
    assert_eq!(programs(Board::Host), Some(Span::ZERO));
    assert_eq!(programs(Board::Gp(0)), Some(Span::ZERO));
    assert_eq!(programs(Board::Gp(1)), Some(Span::from_us(3)));
    for none in [Board::Gp(2), Board::Renderer(0), Board::Display(0), Board::Ring] {
        assert!(programs(none).is_none(), "{none}");
    }
    assert_eq!(machine.processor(SECOND_GP, pxpl5_gp::Priority::Foreground).node(), SECOND_GP);
}

#[test]
fn a_run_can_be_paused_and_continued() {
    let mut machine = machine();
    say(&mut machine, &[(10, Say::Later { us: 5, picture: 1 })]);
    machine.switch_on();
    machine.run_until(us(10)).expect("it goes on");
    assert_eq!(machine.next_event_description().map(|next| next.time), Some(us(10)), "the end is not part of it");
    assert_eq!(machine.step_before(us(10)), Ok(None));
    assert_eq!(machine.step_before(us(11)), Ok(Some(us(10))));
    machine.run_until(us(16)).expect("it goes on");
    assert_eq!(machine.record().observation().arrivals.len(), 1);
}

/// At time zero there are the following events: a tick of the display, its signal to the first graphics processor, and
/// a poll of each of the three boards.
#[test]
fn events_are_counted() {
    let mut machine = machine();
    assert_eq!((machine.events(), machine.pending_events()), (0, 0));
    machine.switch_on();
    assert_eq!((machine.events(), machine.pending_events()), (0, 3 + 1));
    machine.run_until(us(1)).expect("it goes on");
    assert_eq!((machine.events(), machine.pending_events()), (3 + 1 + 1, 1), "the next tick waits");
    assert_eq!(machine.into_record().events(), 5);
}

/// Only the first processor receives retraces, and only retraces of the first display.
#[test]
fn the_first_display_is_the_sync_generator_of_the_first_processor() {
    let mut other = ScreenConfig::new(1);
    other.numbers.period_us = 30;
    let mut machine = build(&config(vec![Box::new(ScreenConfig::new(1)), Box::new(other)]));
    machine.switch_on();
    let all = happenings(&mut machine, us(301));
    let of = |wanted: &str| -> Vec<(Time, Board)> {
        all.iter().filter(|(_, _, what)| *what == wanted).map(|(time, board, _)| (*time, *board)).collect()
    };
    assert_eq!(of("retrace"), [0, 100, 200, 300].map(|at| (us(at), Board::Gp(0))));
    let ticks = |display| of("tick").into_iter().filter(move |(_, board)| *board == Board::Display(display));
    assert!(ticks(0).map(|(time, _)| time).eq([0, 100, 200, 300].map(us)));
    assert!(ticks(1).map(|(time, _)| time).eq((0..11).map(|n| us(30 * n))));
    assert_eq!(machine.processors()[1].snapshot(us(301)).period, PeriodNumber(3));
    assert_eq!(machine.processors()[2].snapshot(us(301)).period, PeriodNumber(0));
}

/// A status line counts the swaps of the part of a surface at one port.
#[test]
fn the_master_is_notified_of_each_swap_with_its_number() {
    let mut machine =
        Machine::new(&config(vec![Box::new(ScreenConfig::new(2))]), 2, pxpl5_renderer::Layout::slats()).expect("valid");
    let [left, right] = machine.ports().display().try_into().expect("two ports");
    let notes: Notes<(Time, [u64; 2])> = Notes::default();
    let seen = Rc::clone(&notes);
    load(&mut machine, FIRST_GP, |gp| async move {
        let status = || [left, right].map(|port| gp.status(port));
        loop {
            let before = status();
            let now = gp.until("a swap", || Some(status()).filter(|now| *now != before)).await;
            seen.borrow_mut().push((gp.now(), now));
        }
    });
    let swapped = |surface, tick| Say::Swapped { surface, tick };
    say(&mut machine, &[(10, swapped(0, 1)), (20, swapped(1, 2)), (30, swapped(1, 3))]);
    say(&mut machine, &[(40, Say::Updated { surface: 1, port: 0, tick: 4 })]);
    machine.switch_on();
    machine.run_until(us(50)).expect("it goes on");
    assert_eq!(*notes.borrow(), [(us(10), [1, 0]), (us(20), [1, 1]), (us(30), [1, 2]), (us(40), [2, 2])]);
    let swaps = machine.record().observation().swaps.iter();
    let found: Vec<_> = swaps.map(|swap| (swap.surface.0, swap.port, swap.number, swap.tick.0)).collect();
    assert_eq!(found, [(0, left, 0, 1), (1, right, 0, 2), (1, right, 1, 3), (1, left, 1, 4)]);
}

#[test]
fn surfaces_of_all_displays_are_numbered_consecutively() {
    let mut machine = build(&config(vec![Box::new(ScreenConfig::new(3)), Box::new(ScreenConfig::new(2))]));
    let second = machine.ports().displays[1][0];
    let script = [
        Say::Arrived { surface: 1, port: 0, picture: 1, first_us_ago: 0 },
        Say::Updated { surface: 1, port: 0, tick: 1 },
    ];
    load_sender(&mut machine, FIRST_GP, script.map(|say| (second, 5, say.body())).into());
    // `Swapped` identifies the port by the number of the surface. The second display has one port.
    load_sender(&mut machine, SECOND_GP, vec![(second, 5, Say::Swapped { surface: 0, tick: 2 }.body())]);
    machine.switch_on();
    machine.run_until(us(50)).expect("it goes on");
    let observation = machine.record().observation();
    assert_eq!(observation.arrivals[0].surface.0, 3 + 1);
    let surfaces: BTreeSet<(u64, u16)> = observation.swaps.iter().map(|swap| (swap.tick.0, swap.surface.0)).collect();
    assert_eq!(surfaces, [(1, 3 + 1), (2, 3)].into());
}

#[test]
fn a_machine_is_at_rest_if_only_displays_have_events() {
    let mut machine = machine();
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 1, words(&[1]))]);
    machine.switch_on();
    assert!(!machine.is_at_rest(), "programs are about to begin");
    machine.run_until(us(1)).expect("it goes on");
    assert!(!machine.is_at_rest(), "a program works");
    machine.run_until(us(50)).expect("it goes on");
    assert!(machine.is_at_rest());
}

#[test]
fn a_machine_with_an_event_at_every_edge_also_comes_to_rest() {
    let mut machine = machine();
    machine.disable(Optimization::IdleBoards);
    say(&mut machine, &[(60, Say::Later { us: 30, picture: 1 })]);
    machine.switch_on();
    // Each clock edge polls the ring, which arbitrates in the same instant.
    machine.run_until(us(50)).expect("it goes on");
    assert!(machine.is_at_rest(), "an edge, a tick and a line");
    machine.run_until(us(70)).expect("it goes on");
    assert!(machine.is_at_rest(), "an edge, a tick and a timer");
}

/// Returns the trace hash of a run in which three boards send at the same instants, and the order of the senders.
fn shuffled(seed: Option<u64>) -> (TraceHash, Vec<Board>) {
    let mut machine = machine();
    if let Some(seed) = seed {
        machine.shuffle_ties(seed);
    }
    let nodes = [NodeId(0), FIRST_GP, SECOND_GP];
    for (i, node) in nodes.into_iter().enumerate() {
        let sent = vec![(nodes[(i + 1) % 3], 2, words(&[1, 2])); 4];
        load_sender(&mut machine, node, sent);
    }
    machine.switch_on();
    let all = happenings(&mut machine, us(200));
    let first = all.iter().filter(|(time, _, what)| *time == Time::ZERO && *what == "programs continue");
    let first = first.map(|(_, board, _)| *board).collect();
    (machine.into_record().trace_hash(), first)
}

#[test]
fn the_order_of_simultaneous_events_does_not_change_the_trace() {
    let (hash, first) = shuffled(None);
    // The first processor is polled twice, because it received the retrace.
    assert_eq!(first[..3], [Board::Host, Board::Gp(0), Board::Gp(1)], "in the order of their ports");
    assert_ne!(hash, TraceHash::default());
    let others: Vec<_> = (0..20).map(|seed| shuffled(Some(seed))).collect();
    assert!(others.iter().all(|(other, _)| *other == hash));
    assert!(others.iter().any(|(_, order)| *order != first));
}

#[test]
fn traces_differ_if_a_message_differs_in_content_time_or_receiver() {
    let trace = |node: NodeId, receiver: NodeId, length: usize, wait: u64| {
        let mut machine = machine();
        load(&mut machine, node, |gp| async move {
            gp.spend(Span::from_us(wait)).await;
            gp.send(receiver, length as u32, words(&vec![0; length])).await;
            gp.until("nothing", || None).await
        });
        machine.switch_on();
        machine.run_until(us(50)).expect("it goes on");
        machine.record().trace_hash()
    };
    let usual = trace(FIRST_GP, SECOND_GP, 2, 1);
    assert_eq!(usual, trace(FIRST_GP, SECOND_GP, 2, 1));
    let others = [
        trace(FIRST_GP, NodeId(0), 2, 1),
        trace(FIRST_GP, SECOND_GP, 3, 1),
        trace(FIRST_GP, SECOND_GP, 2, 2),
        trace(NodeId(0), SECOND_GP, 2, 1),
    ];
    assert!(others.iter().all(|other| *other != usual));
}

/// The pixels of a region are computed once, although sixteen messages carry them.
#[test]
fn a_worker_computes_the_pixels_of_a_copied_region_only_once() {
    for computes in [false, true] {
        let mut machine = machine();
        if computes {
            machine.compute_all_pixels(Box::new(SameThread::default()));
        }
        let copies = RENDERERS.map(|renderer| {
            let (length, list) = copy_command(CopyPath::FromPixelMemory, target(SCREEN, 1));
            (renderer, length, list)
        });
        load_sender(&mut machine, FIRST_GP, copies.into());
        let image = Arc::new(Counted::default());
        let part = |part| {
            Body::Pixels(RegionPixels { target: target(SCREEN, 2), image: Arc::clone(&image) as _, part, parts: 16 })
        };
        machine.plug_host_line(Box::new(Script(vec![(us(3), part(0)), (us(4), part(1))])));
        machine.switch_on();
        machine.run_until(us(3_000)).expect("it goes on");
        assert_eq!(image.asked.load(Ordering::Relaxed), u64::from(computes));
        assert_eq!(machine.finish_pixels(), if computes { 3 } else { 0 });
        assert_eq!(machine.finish_pixels(), 0, "it is over");
    }
}

#[test]
fn marks_of_programs_are_observed_and_traced() {
    let run = |picture| {
        let mut machine = machine();
        load(&mut machine, SECOND_GP, move |gp| async move {
            gp.spend(Span::from_us(2)).await;
            gp.begin(Stage::Render, PictureNumber(picture), None);
            gp.until("nothing", || None).await
        });
        machine.switch_on();
        machine.run_until(us(5)).expect("it goes on");
        let marks = machine.record().observation().marks.clone();
        assert_eq!(marks.len(), 1);
        assert_eq!((marks[0].time, marks[0].node, marks[0].picture.0), (us(2), SECOND_GP, picture));
        machine.into_record().trace_hash()
    };
    assert_ne!(run(1), run(2));
}

/// Only graphics processors take their times from i860 code. No code exists for the host.
#[test]
fn code_determines_the_time_of_messages_on_its_board() {
    let busy = |code: Option<CodeVersion>, runs: bool| {
        let mut config = config(vec![Box::new(ScreenConfig::new(1))]);
        config.code = code;
        let mut machine = build(&config);
        if runs {
            machine.run_code();
        }
        load_sender(&mut machine, FIRST_GP, vec![(NodeId(0), 1, words(&[1]))]);
        machine.switch_on();
        machine.run_until(us(90)).expect("it goes on");
        let versions: Vec<_> =
            machine.processors().iter().map(|board| board.with_processor(Processor::version)).collect();
        assert_eq!(versions, [None, code.filter(|_| runs), code.filter(|_| runs)]);
        machine.processors()[1].busy()
    };
    assert_eq!(busy(Some(CodeVersion::Compiled), false), MESSAGE);
    assert_eq!(busy(None, true), MESSAGE);
    assert_ne!(busy(Some(CodeVersion::Compiled), true), MESSAGE);
}

#[test]
fn breakpoints_stop_the_boards_that_run_the_code() {
    let mut machine = machine();
    machine.run_code();
    machine.break_at(&RING_MEMORY.step_by(4).collect());
    load_sender(&mut machine, SECOND_GP, vec![(NodeId(0), 1, words(&[1]))]);
    machine.switch_on();
    machine.run_until(us(90)).expect("it goes on");
    let hits = machine.take_hits();
    assert!(!hits.is_empty() && hits.iter().all(|hit| hit.gp == SECOND_GP));
    assert!(machine.take_hits().is_empty(), "they were taken");
}
