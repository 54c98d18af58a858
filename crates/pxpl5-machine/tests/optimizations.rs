//! Behaviour of a machine with a disabled optimization, and names of optimizations.
//!
//! The workspace's `tests/optimizations.rs` shows that no optimization changes a result.

use crate::rig::{FIRST_GP, SECOND_GP, happenings, load_sender, machine, us, words};
use pxpl5_machine::{Board, Optimization};
use pxpl5_sim::Time;

#[test]
fn an_optimization_is_parsed_from_the_name_that_it_prints() {
    for saving in Optimization::ALL {
        assert_eq!(saving.name().parse(), Ok(saving));
        assert_eq!(saving.to_string(), saving.name());
        // Names on the command line consist of small letters and hyphens.
        assert!(saving.name().bytes().all(|b| b == b'-' || b.is_ascii_lowercase()));
    }
    let error = "idle-board".parse::<Optimization>().expect_err("no optimization");
    let [first @ .., last] = Optimization::ALL.map(Optimization::name);
    assert_eq!(error.to_string(), format!("expected {} or {last}, found `idle-board`", first.join(", ")));
    // The most similar name comes first.
    let error = "transfer".parse::<Optimization>().expect_err("no optimization");
    assert!(error.to_string().starts_with("expected transfers, "), "{error}");
}

/// The boards' clock of 40 MHz has forty edges per microsecond.
#[test]
fn with_idle_boards_polled_the_ring_is_polled_at_every_clock_edge() {
    let mut machine = machine();
    machine.disable(Optimization::IdleBoards);
    machine.switch_on();
    let all = happenings(&mut machine, us(1));
    let edges = all.iter().filter(|(_, _, what)| *what == "edge of the boards' clock");
    assert!(edges.map(|(time, board, _)| (*time, *board)).eq((0..40).map(|n| (Time(25_000 * n), Board::Ring))));
}

#[test]
fn without_transfers_in_closed_form_every_word_is_an_event() {
    let mut machine = machine();
    machine.disable(Optimization::Transfers);
    load_sender(&mut machine, FIRST_GP, vec![(SECOND_GP, 4, words(&[0; 4]))]);
    machine.switch_on();
    let all = happenings(&mut machine, us(50));
    assert_eq!(all.iter().filter(|(_, _, what)| *what == "a word has passed").count(), 16 + 4, "overhead and words");
}
