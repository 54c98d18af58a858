//! Timing of messages, event by event.
//!
//! A signal leaves its board one cycle of the 40 MHz clock after its cause. A message of w words arrives 16 + w word
//! times after its grant, plus one hop for each port that it passes.

use crate::rig::{
    FIRST_GP, MESSAGE, RENDERERS, SCREEN, SECOND_GP, Say, ScreenConfig, build, config, copy_command, happenings, load,
    load_sender, machine, say, target, us, words,
};
use pxpl5_machine::{Board, Machine};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, CopyPath, NodeId, RegionPixels};

/// Cycle of the boards' 40 MHz clock (TR94).
const CYCLE: Span = Span::from_ns(25);

/// Time of a word, at 20 million words per second (TR94, F89).
const WORD: Span = Span::from_ns(50);

/// Returns all events except polls of programs, ticks and their signals.
fn seen(machine: &mut Machine, until: Time) -> Vec<(Time, Board, &'static str)> {
    let mut all = happenings(machine, until);
    all.retain(|(_, _, what)| !["programs continue", "tick", "retrace"].contains(what));
    all
}

#[test]
fn a_message_goes_from_a_processor_over_the_ring_to_another() {
    let mut machine = machine();
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 4, words(&[7; 4]))]);
    machine.switch_on();
    let sent = Time::ZERO + MESSAGE;
    let asked = sent + CYCLE;
    let arrived = asked + WORD * (16 + 4) + Span::from_ns(50);
    let expected = [
        (sent, Board::Gp(0), "work may end"),
        (asked, Board::Ring, "a board asks for a channel"),
        (asked, Board::Ring, "arbitration"),
        (arrived, Board::Gp(1), "message delivered"),
        (arrived, Board::Gp(0), "message accepted by its receiver"),
    ];
    assert_eq!(seen(&mut machine, us(50)), expected);
}

#[test]
fn the_sender_is_notified_at_the_instant_of_arrival() {
    let mut machine = machine();
    load_sender(&mut machine, SECOND_GP, vec![(NodeId(0), 1, words(&[7]))]);
    machine.switch_on();
    let all = seen(&mut machine, us(50));
    let [.., delivered, accepted] = &all[..] else { panic!("{all:?}") };
    // The host follows the last of six ports on the ring, so a message from port 2 passes four hops.
    let arrived = Time::ZERO + MESSAGE + CYCLE + WORD * (16 + 1) + Span::from_ns(4 * 50);
    assert_eq!(*delivered, (arrived, Board::Host, "message delivered"));
    assert_eq!(*accepted, (arrived, Board::Gp(1), "message accepted by its receiver"));
}

/// A chain sends to several receivers at the same time.
#[test]
fn each_message_of_a_chain_requests_its_own_channel() {
    let mut machine = machine();
    load(&mut machine, FIRST_GP, |gp| async move {
        gp.send_batch(vec![(SECOND_GP, 1, words(&[1])), (NodeId(0), 1, words(&[2]))]).await;
        gp.until("nothing", || None).await
    });
    machine.switch_on();
    let all = seen(&mut machine, us(50));
    assert_eq!(all.iter().filter(|(_, _, what)| *what == "a board asks for a channel").count(), 2);
    let delivered = all.iter().filter(|(_, _, what)| *what == "message delivered");
    assert_eq!(delivered.map(|(_, board, _)| *board).collect::<Vec<_>>(), [Board::Gp(1), Board::Host]);
}

/// Two messages of one board leave its port one after the other.
#[test]
fn the_second_message_of_a_board_requests_a_channel_after_the_first_message_is_accepted() {
    let mut machine = machine();
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 1, words(&[1])), (SECOND_GP, 1, words(&[2]))]);
    machine.switch_on();
    let all = seen(&mut machine, us(50));
    let asked: Vec<Time> = all.iter().filter(|(_, _, what)| what.contains("asks")).map(|(time, ..)| *time).collect();
    // The second chain waits until the first chain's message is accepted, which happens at its arrival.
    let accepted = Time::ZERO + MESSAGE + CYCLE + WORD * 17 + Span::from_ns(50);
    assert_eq!(asked, [us(1) + CYCLE, (Time::ZERO + MESSAGE * 2).max(accepted) + CYCLE]);
}

fn whats(machine: &mut Machine, of: Board) -> Vec<&'static str> {
    let all = happenings(machine, us(1_000));
    all.into_iter().filter(|(_, board, _)| *board == of).map(|(_, _, what)| what).collect()
}

/// A region takes sixteen messages of 1,024 words. The last one is acknowledged.
#[test]
fn a_renderer_copies_the_requested_region() {
    for (way, stored) in [(CopyPath::FromPixelMemory, false), (CopyPath::ThroughBacking, true)] {
        let mut machine = machine();
        let (length, list) = copy_command(way, target(SCREEN, 0));
        load_sender(&mut machine, FIRST_GP, vec![(RENDERERS[1], length, list)]);
        machine.switch_on();
        let mut expected = vec!["message announced", "copy command begins"];
        expected.extend(stored.then_some("region in the backing store"));
        expected.push("message accepted by its receiver");
        let found = whats(&mut machine, Board::Renderer(1));
        assert_eq!(found, expected);
        let stats = [0, 1].map(|board| machine.record().renderers()[board].stats());
        assert_eq!(stats.map(|stats| (stats.commands, stats.regions_copied)), [(0, 0), (1, 1)]);
        let screen = &machine.record().displays()[0];
        assert_eq!(screen.counters()[0].count, 16, "messages of a region");
    }
}

#[test]
fn a_renderers_answer_is_an_event_of_the_ring() {
    let mut machine = machine();
    let (length, list) = copy_command(CopyPath::FromPixelMemory, target(SCREEN, 0));
    load_sender(&mut machine, FIRST_GP, vec![(RENDERERS[0], length, list)]);
    machine.switch_on();
    let all = happenings(&mut machine, us(1_000));
    let answers: Vec<_> = all.iter().filter(|(_, _, what)| what.starts_with("a renderer says")).collect();
    assert_eq!(answers.iter().map(|(_, board, _)| *board).collect::<Vec<_>>(), [Board::Ring]);
    assert_eq!(machine.record().renderers()[0].stats().regions_copied, 1);
    assert_eq!(machine.record().ring().refusals().count, 0);
}

/// The sender of commands is notified when the renderer has the last word: one hop per port after the grant, without a
/// stall.
#[test]
fn a_sender_continues_when_the_fifo_of_the_renderer_has_the_message() {
    let mut machine = machine();
    let (length, list) = copy_command(CopyPath::FromPixelMemory, target(SCREEN, 0));
    load_sender(&mut machine, FIRST_GP, vec![(RENDERERS[0], length, list)]);
    machine.switch_on();
    let all = happenings(&mut machine, us(500));
    let accepted = all.iter().find(|(_, _, what)| *what == "message accepted by its receiver");
    let hops = u64::from(RENDERERS[0].0 - FIRST_GP.0);
    let at = Time::ZERO + MESSAGE + CYCLE + WORD * (16 + u64::from(length)) + Span::from_ns(50) * hops;
    assert_eq!(accepted.map(|(time, board, _)| (*time, *board)), Some((at, Board::Gp(0))));
}

#[test]
fn a_message_for_a_later_display_reaches_its_port() {
    let displays: Vec<Box<dyn pxpl5_wire::display::DisplayConfig>> =
        vec![Box::new(ScreenConfig::new(2)), Box::new(ScreenConfig::new(1))];
    let mut machine = build(&config(displays));
    let second = machine.ports().displays[1][0];
    let message = Say::Arrived { surface: 0, port: 0, picture: 9, first_us_ago: 0 };
    load_sender(&mut machine, FIRST_GP, vec![(second, 5, message.body())]);
    machine.switch_on();
    assert!(whats(&mut machine, Board::Display(1)).contains(&"message delivered"));
    let [arrival] = &machine.record().observation().arrivals[..] else { panic!("one region") };
    assert_eq!((arrival.surface.0, arrival.target.frame_buffer), (2, second), "two surfaces are the first display's");
}

#[test]
fn a_host_line_bypasses_the_ring_and_delivers_all_its_words() {
    let mut machine = machine();
    let message = |picture| Say::Arrived { surface: 0, port: 0, picture, first_us_ago: 0 };
    say(&mut machine, &[(10, message(1)), (20, message(2)), (20, message(3)), (30, Say::Later { us: 5, picture: 4 })]);
    machine.switch_on();
    let lines = whats(&mut machine, Board::Display(0));
    assert_eq!(lines.iter().filter(|what| what.contains("line past the ring")).count(), 3, "instants");
    assert_eq!(lines.iter().filter(|what| **what == "own timer").count(), 1);
    let record = machine.into_record();
    let arrivals = record.observation().arrivals.iter();
    let found: Vec<_> = arrivals.map(|arrival| (arrival.last_part_at, arrival.target.picture.0)).collect();
    assert_eq!(found, [(us(10), 1), (us(20), 2), (us(20), 3), (us(35), 4)]);
    assert_eq!(record.ring().stats().messages, 0);
}

#[test]
fn messages_of_a_host_line_enter_the_trace() {
    let hash = |body: Body| {
        let mut machine = machine();
        machine.plug_host_line(Box::new(crate::rig::Script(vec![(us(10), body)])));
        machine.switch_on();
        machine.run_until(us(50)).expect("it goes on");
        machine.record().trace_hash()
    };
    let image = || std::sync::Arc::new(crate::rig::Counted::default());
    let pixels =
        |picture, part| Body::Pixels(RegionPixels { target: target(SCREEN, picture), image: image(), part, parts: 16 });
    let all = [words(&[9, 1]), words(&[9, 2]), words(&[9]), pixels(1, 0), pixels(1, 1), pixels(2, 0)].map(hash);
    for (i, one) in all.iter().enumerate() {
        assert!(all[i + 1..].iter().all(|other| one != other), "the {i}th is like another");
    }
}
