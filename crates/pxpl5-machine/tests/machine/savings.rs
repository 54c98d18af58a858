//! What a machine does that gives up a saving, and how savings are named. That none changes a result the workspace's `tests/savings.rs` shows.

use crate::rig::{FIRST_GP, SECOND_GP, happenings, load, load_sender, machine, us, words};
use pxpl5_gp::Priority;
use pxpl5_machine::{Board, Saving};
use pxpl5_sim::{Span, Time};

#[test]
fn a_saving_is_known_by_the_name_that_it_prints() {
    for saving in Saving::ALL {
        assert_eq!(saving.name().parse(), Ok(saving));
        assert_eq!(saving.to_string(), saving.name());
        // As commands name things: words of small letters.
        assert!(saving.name().bytes().all(|b| b == b'-' || b.is_ascii_lowercase()));
    }
    let all = Saving::ALL.map(Saving::name).join(", ");
    assert_eq!("sleep".parse::<Saving>(), Err(format!("expected {all}, found \"sleep\"")));
}

/// The boards' clock of 40 MHz: forty edges in a microsecond.
#[test]
fn without_sleep_every_board_is_asked_at_every_edge() {
    let mut machine = machine();
    machine.give_up(Saving::IdleBoards);
    machine.switch_on();
    let all = happenings(&mut machine, us(1));
    let edges = all.iter().filter(|(_, _, what)| *what == "edge of the boards' clock");
    assert!(edges.map(|(time, board, _)| (*time, *board)).eq((0..40).map(|n| (Time(25_000 * n), Board::Ring))));
}

#[test]
fn without_the_computed_end_every_word_is_an_event() {
    let mut machine = machine();
    machine.give_up(Saving::Transfers);
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 4, words(&[0; 4]))]);
    machine.switch_on();
    let all = happenings(&mut machine, us(50));
    assert_eq!(all.iter().filter(|(_, _, what)| *what == "a word has passed").count(), 16 + 4, "overhead and words");
}

#[test]
fn processors_give_up_what_is_theirs() {
    for given_up in [None, Some(Saving::JointWork)] {
        let mut machine = machine();
        given_up.into_iter().for_each(|saving| machine.give_up(saving));
        let at_once = machine.processor(FIRST_GP, Priority::Interrupt).pays_at_once();
        assert_eq!(at_once, given_up.is_none());
    }
}

/// Work of 10 us that a message delays by 1 us.
#[test]
fn without_delayed_work_each_delay_announces_the_end_anew() {
    let ends = |saving: Option<Saving>| {
        let mut machine = machine();
        saving.into_iter().for_each(|saving| machine.give_up(saving));
        load(&mut machine, FIRST_GP, |gp| async move {
            gp.spend(Span::from_us(10)).await;
            gp.until("nothing", || None).await
        });
        let interrupts = machine.processor(FIRST_GP, Priority::Interrupt);
        let program = async move {
            loop {
                interrupts.receive().await;
            }
        };
        machine.load(FIRST_GP, Priority::Interrupt, Box::pin(program));
        load_sender(&mut machine, SECOND_GP, vec![(FIRST_GP, 1, words(&[1])); 3]);
        machine.switch_on();
        let all = happenings(&mut machine, us(50));
        let ends = all.iter().filter(|(_, board, what)| (*board, *what) == (Board::Gp(0), "work may end"));
        (ends.count(), machine.processors()[1].busy())
    };
    let (kept, busy) = ends(None);
    let (announced, busy_then) = ends(Some(Saving::DelayedWork));
    assert_eq!((busy, busy_then), (Span::from_us(13), Span::from_us(13)));
    assert!(kept < announced, "{kept} and {announced} events");
}
