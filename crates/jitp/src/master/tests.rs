//! Tests of the master's orders to a slave, and of the times at which the orders are sent.

use super::*;
use crate::config::Beam;
use crate::rig::{FIELD_US, MASTER, ROW_US, Rig, SLAVE, config, us, view};
use pxpl5_gp::{CodeVersion, GpBoard};

#[test]
fn the_time_of_an_order_is_that_of_the_last_order_of_the_same_slave() {
    let mut flight = OrderTimes::new(2, 3);
    // A pass has three orders. Each pair has the slave and the time of an order.
    let orders = [(0, 100), (1, 130), (1, 190), (0, 260), (0, 400), (1, 430)];
    let expected = [(0, 0), (0, 0), (60, 0), (160, 160), (140, 270), (240, 240)];
    for ((slave, now), (drawing, standing)) in orders.into_iter().zip(expected) {
        let found = flight.ordered(slave, Time(now));
        assert_eq!((found.drawing, found.standing), (Span(drawing), Span(standing)), "{slave} at {now}");
    }
}

#[test]
fn times_before_the_start_are_clamped_to_zero() {
    assert_eq!(before(Time(5), Span(3)), Time(2));
    assert_eq!(before(Time(3), Span(5)), Time::ZERO);
}

/// Returns a board that runs the master program, with strips of 120 lines and racing.
fn master_of(viewpoint: Viewpoint, margin_ns: u64, code: Option<CodeVersion>, beam: Option<Beam>) -> Rig {
    let mut config = config(DrawingSchedule::Beam { viewpoint, racing: true, strip_rows: 120 });
    config.timing.margin_ns = margin_ns;
    config.beam = beam.unwrap_or(config.beam);
    let run_code = |board: &mut GpBoard, code| board.run_code(code, i860::Config::cycle(), &Rc::default());
    Rig::new(
        MASTER,
        |board| code.into_iter().for_each(|code| run_code(board, code)),
        |gp| master(gp, &config, TransformCost::PASS, |wanted| view(wanted.number.0)),
    )
}

/// Returns the orders that the master has sent to the slave, each with its time.
fn ordered(rig: &Rig) -> Vec<(Time, DrawingOrder)> {
    let sent = rig.sent_to(SLAVE).into_iter();
    sent.map(|(time, received)| (time, DrawingOrder::read(&received, SLAVE).expect("an order"))).collect()
}

/// Tests that the master sends the order for a field one field earlier if the boards run i860 code. Without code, the
/// order would come one strip and one margin before the field.
#[test]
fn with_i860_code_the_order_of_a_field_is_sent_one_field_earlier() {
    const MARGIN_US: u64 = 400;
    let mut rig = master_of(Viewpoint::Field, MARGIN_US * 1_000, Some(CodeVersion::Scheduled), None);
    rig.run_to(7 * FIELD_US);
    let mut fields = 0;
    for (time, order) in ordered(&rig) {
        let DrawingOrder::Field { field, .. } = order else { continue };
        let expected = us((field.0 - 1) * FIELD_US - 120 * ROW_US - MARGIN_US);
        assert!(time > expected && time < expected + Span::from_us(50), "{field:?}: {time} for {expected}");
        fields += 1;
    }
    assert!(fields > 3, "{fields}");
}

/// Tests a display that shows all lines at the retrace. With a margin of 0 ns, an order could only be sent at the
/// deadline of its strip, so there is no order.
#[test]
fn a_strip_is_not_ordered_if_its_deadline_has_come() {
    let retrace = |field: PeriodNumber| us(field.0 * FIELD_US);
    for (margin_ns, is_ordered) in [(0, false), (1, true)] {
        let at_once = Beam::new(move |field, _, _| retrace(field), retrace);
        let mut rig = master_of(Viewpoint::Strip, margin_ns, None, Some(at_once));
        rig.run_to(4 * FIELD_US);
        assert_eq!(!ordered(&rig).is_empty(), is_ordered, "{margin_ns} ns before");
    }
}
