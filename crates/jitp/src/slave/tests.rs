//! Tests of a slave on its board: the fields that it stores, and the strips that it draws.

use super::*;
use crate::config::Interpolation;
use crate::rig::{RENDERER, Rig, SLAVE, config, list, us, view};
use pxpl5_gp::GpTiming;
use pxpl5_sim::Span;

const TRIANGLES: usize = 10;
const DUAL: Viewpoint = Viewpoint::Dual(Interpolation::Screen);

/// Returns a bench with a slave, and the state shared by its two programs.
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

/// Runs for `us` microseconds, and returns the number of messages that were sent to the renderer in this time.
fn drawn_after(rig: &mut Rig, us: u64) -> usize {
    let before = rig.sent_to(RENDERER).len();
    rig.run_to(rig.us + us);
    rig.sent_to(RENDERER).len() - before
}

/// If the field of a strip is still being transformed, the strip must be drawn as soon as the field is ready.
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

/// Each stored field and the next field have their own parts of memory. These parts do not overlap. If strips are
/// interpolated between two views, the last part is for these strips.
#[test]
fn fields_that_stay_transformed_lie_apart() {
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

/// Strips are normally interpolated between two views. If an order has only one view, the slave must use this view.
#[test]
fn a_field_of_one_view_is_drawn_from_it() {
    let messages = [Viewpoint::Field, DUAL].map(|viewpoint| {
        let (mut rig, _) = slave_of(viewpoint);
        rig.deliver(&order_of_field(1, 1));
        rig.deliver(&order_of_strip(1, LATE, None));
        drawn_after(&mut rig, 2_000)
    });
    assert!(messages[0] > 0 && messages[0] == messages[1], "{messages:?}");
}

/// TRANSFORM of a strip ends after the times of a message, a pass and its triangles. The strip must be drawn only if
/// TRANSFORM ends before the strip's deadline.
#[test]
fn a_strip_that_is_transformed_when_its_beam_is_there_is_not_drawn() {
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
