//! Errors and deadlocks that stop a machine.

use crate::rig::{
    FIRST_GP, MESSAGE, RENDERERS, SCREEN, SECOND_GP, Say, ScreenConfig, build, config, copy_command, load, load_sender,
    machine, say, target, us, words,
};
use pxpl5_gp::Fault;
use pxpl5_machine::{Blocked, Board, DEADLOCK_TICKS, Machine, RunError};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyPath, NodeId};

const LONG: Time = Time(100_000 * 1_000_000);

fn load_waiting(machine: &mut Machine, node: NodeId) {
    load(machine, node, |gp| async move { gp.until("Godot", || None).await });
}

/// Period 0 contains the polls at the start, so the second tick is the first idle tick.
#[test]
fn programs_that_wait_for_ever_are_a_deadlock_after_the_stated_periods() {
    let mut machine = machine();
    load_waiting(&mut machine, FIRST_GP);
    machine.switch_on();
    machine.run_until(us(100 * 100 + 1)).expect("it goes on for a while");
    assert_eq!(machine.idle_ticks(), 99);
    let error = machine.run_until(LONG).expect_err("nothing can happen");
    let time = us(100 * (1 + DEADLOCK_TICKS));
    let blocked = vec![Blocked { board: Board::Gp(0), waits_on: None, waits_for: "Godot".to_owned() }];
    assert_eq!(error, RunError::Deadlock { time, blocked });
    let expected = format!("nothing can happen any more at {time}: GP 0 waits for Godot;");
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.time(), time);
    assert_eq!(machine.failure(), Some(&error));
    assert_eq!(machine.step_before(LONG), Err(error), "it goes on no more");
}

#[test]
fn a_program_that_waits_for_retraces_and_a_machine_without_programs_are_no_deadlock() {
    for waits in [false, true] {
        let mut machine = machine();
        if waits {
            load(&mut machine, FIRST_GP, |gp| async move {
                loop {
                    gp.retrace().await;
                }
            });
        }
        machine.switch_on();
        machine.run_until(us(100 * 1_000)).expect("it goes on");
        assert!(machine.failure().is_none());
        assert!(machine.idle_ticks() > DEADLOCK_TICKS, "nothing but ticks");
    }
}

/// A message in every hundredth period prevents a deadlock. A message on a host line does not.
#[test]
fn a_board_that_receives_messages_is_not_deadlocked() {
    let run = |works: bool| {
        let mut machine = machine();
        load_waiting(&mut machine, FIRST_GP);
        if works {
            load(&mut machine, SECOND_GP, |gp| async move {
                loop {
                    gp.spend(Span::from_us(100 * 100)).await;
                    gp.send(NodeId(0), 1, words(&[1])).await;
                }
            });
        }
        let message = Say::Arrived { surface: 0, port: 0, picture: 1, first_us_ago: 0 };
        say(&mut machine, &[1, 2, 3, 4].map(|n| (100 * 50 * n + 7, message)));
        machine.switch_on();
        machine.run_until(us(100 * 500))
    };
    assert_eq!(run(true), Ok(()));
    assert_eq!(run(false).map_err(|error| error.time()), Err(us(100 * (1 + DEADLOCK_TICKS))));
}

/// TRANSFORM of a large scene on one processor takes longer than the time after which the machine detects a deadlock.
///
/// The machine must not report a deadlock before the work ends. After the work, the program still waits, and the
/// machine is deadlocked.
#[test]
fn long_work_is_no_deadlock() {
    let ticks = 3 * DEADLOCK_TICKS;
    let run = |until: u64| {
        let mut machine = machine();
        load_waiting(&mut machine, FIRST_GP);
        load(&mut machine, SECOND_GP, move |gp| async move {
            gp.spend(Span::from_us(100 * ticks - 50)).await;
            Ok(())
        });
        machine.switch_on();
        machine.run_until(us(100 * until + 1)).map_err(|error| error.time())
    };
    assert_eq!(run(ticks), Ok(()));
    assert_eq!(run(2 * ticks), Err(us(100 * (ticks + DEADLOCK_TICKS))));
}

#[test]
fn each_waiting_board_is_listed_with_the_cause_of_its_wait() {
    let mut machine = machine();
    load_waiting(&mut machine, NodeId(0));
    // Both renderers copy to the same frame buffer. One of them occupies the port, so the other copy cannot begin.
    let copies = RENDERERS.map(|renderer| {
        let (length, list) = copy_command(CopyPath::FromPixelMemory, target(SCREEN, 1));
        (renderer, length, list)
    });
    load_sender(&mut machine, SECOND_GP, copies.into());
    machine.switch_on();
    // A region takes 16 messages of (1,024 + 16) words of 50 ns: 832 us.
    machine.run_until(us(500)).expect("it goes on");
    let blocked = machine.blocked();
    let boards: Vec<Board> = blocked.iter().map(|wait| wait.board).collect();
    assert_eq!(boards[..4], [Board::Host, Board::Gp(1), Board::Renderer(0), Board::Renderer(1)], "{blocked:?}");
    let programs = [&blocked[0], &blocked[1]].map(ToString::to_string);
    assert_eq!(programs, ["host waits for Godot", "GP 1 waits for nothing"]);
    assert_eq!(blocked[2].waits_for, "frame buffer at node 5 to take region 0");
    assert_eq!(blocked[2].waits_on, Some(Board::Display(0)));
    // Two messages carry pixels to one port. One message occupies the port. The other message waits for the renderer
    // that sends the first message.
    let messages = &blocked[4..];
    assert_eq!(messages.len(), machine.record().ring().waiting().len(), "and the ring's messages");
    let pairs: Vec<_> = messages.iter().map(|wait| (wait.board, wait.waits_on)).collect();
    let [one, other] = [Board::Renderer(0), Board::Renderer(1)];
    assert!(pairs.contains(&(one, Some(other))) || pairs.contains(&(other, Some(one))), "{pairs:?}");
    machine.run_until(us(3_000)).expect("it goes on");
    assert_eq!(machine.blocked().len(), 2, "programs alone");
}

#[test]
fn a_fault_of_a_program_stops_the_machine_with_its_board_and_time() {
    let mut machine = machine();
    let fault = Fault::Protocol { node: SECOND_GP, found: "nonsense".to_owned() };
    let raised = fault.clone();
    load(&mut machine, SECOND_GP, |gp| async move {
        gp.spend(Span::from_us(7)).await;
        Err(raised)
    });
    machine.switch_on();
    let error = machine.run_until(LONG).expect_err("a fault");
    assert_eq!(error, RunError::Fault { board: Board::Gp(1), time: us(7), fault: fault.clone() });
    assert_eq!(error.to_string(), format!("GP 1 stopped at {}: {fault}", us(7)));
    assert_eq!((error.time(), machine.step_before(LONG)), (us(7), Err(error.clone())));
}

/// Messages have at most 1,024 words (derived), and the test machine has six ports.
#[test]
fn a_message_too_long_for_the_ring_stops_the_machine() {
    for (receiver, length, reason) in
        [(SECOND_GP, 1_025, "expected 1 to 1024 words, found 1025"), (NodeId(6), 1, "there is no ring port 6")]
    {
        let mut machine = machine();
        load_sender(&mut machine, FIRST_GP, vec![(receiver, length, words(&[1]))]);
        machine.switch_on();
        let error = machine.run_until(LONG).expect_err("refused");
        // The board sends its request one cycle after the software cost. The ring refuses the request one word time
        // later.
        assert_eq!(error.time(), Time::ZERO + MESSAGE + Span::from_ns(25 + 50));
        let RunError::Ring { error: found, .. } = &error else { panic!("{error}") };
        assert!(found.to_string().contains(reason), "{found}");
        assert_eq!(error.to_string(), format!("ring, at {}: {found}", error.time()));
    }
}

#[test]
fn an_impossible_machine_is_not_built() {
    let mut wrong = config(vec![Box::new(ScreenConfig::new(1))]);
    wrong.n_gps = 0;
    let error = Machine::new(&wrong, 1, pxpl5_renderer::Layout::slats()).expect_err("no processor");
    assert_eq!(error.to_string(), "n_gps must be 1 to 1000, found 0");
    let built = build(&config(vec![Box::new(ScreenConfig::new(1))]));
    assert!(built.failure().is_none());
}
