//! Tests of a slave: the fields that it stores, and the strips that it draws.

use super::*;
use crate::config::Interpolation;
use crate::rig::{RENDERER, Rig, SLAVE, config, list, us, view};
use pxpl5_gp::GpTiming;
use pxpl5_sim::Span;

const TRIANGLES: usize = 10;
const DUAL: Viewpoint = Viewpoint::Dual(Interpolation::Screen);

/// Returns a test bench with a slave, and the fields that both programs of the slave use.
fn slave_of(viewpoint: Viewpoint) -> (Rig, SharedFields) {
    let config = config(DrawingSchedule::Beam { viewpoint, racing: false, strip_rows: 120 });
    let list = list(TRIANGLES);
    let share = Share::new(Arc::clone(&list), 0, 1);
    let state = SharedFields::default();
    let one = |gp: Gp| Slave {
        gp,
        config: config.clone(),
        share: share.clone(),
        pass: TransformCost::pass_over(&list, share.counts()),
        state: Rc::clone(&state),
        transforms: Transforms::default(),
        index: 0,
    };
    let rig = Rig::new(
        SLAVE,
        |_| {},
        |gp| {
            let [drawing, preparing] =
                [Priority::Interrupt, Priority::Foreground].map(|level| one(gp.at_priority(level)));
            vec![(Priority::Interrupt, Box::pin(drawing.draw())), (Priority::Foreground, Box::pin(preparing.prepare()))]
        },
    );
    (rig, state)
}

fn order_of_field(field: u64, views: u64) -> DrawingOrder {
    DrawingOrder::Field { field: PeriodNumber(field), views: (0..views).map(view).collect() }
}

fn order_of_strip(field: u64, deadline: Time, view: Option<FrameView>) -> DrawingOrder {
    DrawingOrder::Strip { field: PeriodNumber(field), strip: 0, deadline, view }
}

const LATE: Time = us(1_000_000);

/// Simulates `us` microseconds, and returns the number of messages to the renderer in this time.
fn drawn_after(rig: &mut Rig, us: u64) -> usize {
    let before = rig.sent_to(RENDERER).len();
    rig.run_to(rig.us + us);
    rig.sent_to(RENDERER).len() - before
}

#[test]
fn a_strip_waits_for_the_transforms_of_its_field() {
    let (mut rig, _) = slave_of(Viewpoint::Field);
    rig.deliver(&order_of_field(1, 1));
    rig.run_to(50);
    rig.deliver(&order_of_strip(1, LATE, None));
    assert_eq!(drawn_after(&mut rig, 100), 0, "ten triangles take 217 us");
    assert!(drawn_after(&mut rig, 1_000) > 0);
}

#[test]
fn the_last_three_fields_stay_transformed() {
    let (mut rig, state) = slave_of(Viewpoint::Field);
    for newest in 1..8 {
        rig.deliver(&order_of_field(newest, 1));
        rig.run_to(rig.us + 1_000);
        assert_eq!(state.borrow().transformed.len() as u64, newest.min(3));
        for field in 1..=newest {
            rig.deliver(&order_of_strip(field, LATE, None));
            assert_eq!(drawn_after(&mut rig, 1_000) > 0, field + 3 > newest, "{field} of {newest}");
        }
    }
}

/// Tests that a new field never overwrites one of the stored fields. The board's memory has one part for each stored
/// field and one for the new field. Dual lists need a fifth part for interpolated strips.
#[test]
fn a_new_field_never_overwrites_a_stored_transformed_field() {
    assert_eq!(OF_STRIP, MemoryPart::of(4, 5));
    for (viewpoint, views, of) in [(Viewpoint::Field, 1, 4), (DUAL, 2, 5)] {
        let (mut rig, state) = slave_of(viewpoint);
        let of_fields: Vec<MemoryPart> = (0..4).map(|part| MemoryPart::of(part, of)).collect();
        let parts = || state.borrow().transformed.iter().map(|field| field.2).collect::<Vec<_>>();
        for newest in 1..12 {
            let stay = parts();
            rig.deliver(&order_of_field(newest, views));
            rig.run_to(rig.us + 2_000);
            let next = parts().pop().expect("transformed");
            assert!(of_fields.contains(&next) && !stay.contains(&next), "{viewpoint:?}: {next:?} beside {stay:?}");
        }
    }
}

/// Tests an order with one view under dual lists, which normally have two views for each field.
#[test]
fn with_dual_lists_a_field_with_one_view_is_drawn_from_this_view() {
    let messages = [Viewpoint::Field, DUAL].map(|viewpoint| {
        let (mut rig, _) = slave_of(viewpoint);
        rig.deliver(&order_of_field(1, 1));
        rig.deliver(&order_of_strip(1, LATE, None));
        drawn_after(&mut rig, 2_000)
    });
    assert!(messages[0] > 0 && messages[0] == messages[1], "{messages:?}");
}

/// Tests that a strip is drawn only if its TRANSFORM ends before its deadline. The end of TRANSFORM follows from the
/// timing table.
#[test]
fn a_strip_is_drawn_only_if_its_transform_ends_before_the_deadline() {
    let timing = GpTiming::PAPERS;
    let work = timing.message_ns + timing.pass_ns + TRIANGLES as u64 * timing.triangle_ns;
    let transformed = us(100) + Span::from_ns(work);
    for (deadline, is_drawn) in [(transformed, false), (transformed + Span(1), true)] {
        let (mut rig, _) = slave_of(Viewpoint::Strip);
        rig.run_to(100);
        rig.deliver(&order_of_strip(1, deadline, Some(view(1))));
        assert_eq!(drawn_after(&mut rig, 2_000) > 0, is_drawn, "{deadline}");
    }
}
