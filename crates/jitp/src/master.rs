//! The master, which stores the newest tracker report and orders the slaves to draw strips or blocks.

use crate::config::{DrawingSchedule, JitpConfig, Viewpoint, Wanted};
use crate::ordering::OrderAssemblyWork;
use crate::protocol::DrawingOrder;
use pphigs::{FrameView, PROGRAM_BYTES, TransformCost};
use pxpl5_gp::{Account, Fault, Firmware, Gp, Priority, Stage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::LightTimes;
use pxpl5_wire::{NodeId, PeriodNumber, PictureNumber, ViewNumber};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

#[derive(Debug, Default)]
struct MasterState {
    reports_until: Cell<Time>,
    done: RefCell<VecDeque<u32>>,
}

/// Returns the programs of the master, for both priorities of its board.
///
/// `pass` is the cost of TRANSFORM for a slave. `view_of` returns the predicted view for a request. The programs fail
/// with [`Fault::Protocol`] for an unknown message.
pub fn master(
    gp: &Gp,
    config: &JitpConfig,
    pass: TransformCost,
    view_of: impl FnMut(Wanted) -> FrameView + 'static,
) -> Vec<(Priority, Firmware)> {
    let state = Rc::new(MasterState::default());
    let listening = listen(gp.at_priority(Priority::Interrupt), Rc::clone(&state));
    let foreground = gp.at_priority(Priority::Foreground);
    let master = DrawingMaster { gp: foreground, config: config.clone(), pass, view_of, state };
    vec![(Priority::Interrupt, Box::pin(listening)), (Priority::Foreground, Box::pin(master.run()))]
}

async fn listen(gp: Gp, state: Rc<MasterState>) -> Result<(), Fault> {
    loop {
        let received = gp.receive().await;
        match DrawingOrder::read(&received, gp.node())? {
            DrawingOrder::Report { reports_until } => state.reports_until.set(reports_until),
            DrawingOrder::Done { slave } => state.done.borrow_mut().push_back(slave),
            other => return Err(Fault::Protocol { node: gp.node(), found: format!("at the master: {other:?}") }),
        }
    }
}

struct DrawingMaster<V> {
    gp: Gp,
    config: JitpConfig,
    pass: TransformCost,
    view_of: V,
    state: Rc<MasterState>,
}

impl<V: FnMut(Wanted) -> FrameView> DrawingMaster<V> {
    async fn run(mut self) -> Result<(), Fault> {
        self.gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
        match self.config.schedule {
            DrawingSchedule::Beam { viewpoint, racing, .. } => self.follow_the_beam(viewpoint, racing).await,
            DrawingSchedule::Roam { batch, .. } => self.roam(u64::from(batch)).await,
        }
    }

    fn view(&mut self, number: ViewNumber, shown_at: Time) -> FrameView {
        (self.view_of)(Wanted { number, reports_until: self.state.reports_until.get(), shown_at })
    }

    async fn follow_the_beam(&mut self, viewpoint: Viewpoint, racing: bool) -> Result<(), Fault> {
        let ahead = self.config.lead(racing);
        let first = self.gp.field().after(2);
        let mut prepared = first;
        let strips = self.config.grid().rows();
        for field in first.onwards() {
            for strip in 0..strips {
                // Send the orders for the fields whose preparation must begin before this strip.
                let order_at = before(self.config.deadline(field, strip), ahead);
                while viewpoint != Viewpoint::Strip && self.preparation_at(prepared, viewpoint, ahead) <= order_at {
                    self.gp.sleep_until(self.preparation_at(prepared, viewpoint, ahead)).await;
                    self.order_field(prepared, viewpoint).await?;
                    prepared = prepared.next();
                }
                // The master sends no order for a strip whose deadline has passed.
                self.gp.sleep_until(order_at).await;
                if self.gp.now() < self.config.deadline(field, strip) {
                    self.order_strip(field, strip, viewpoint).await?;
                }
            }
        }
        Ok(())
    }

    /// Returns the time at which slaves must begin to transform the display list for a field, so that the first strip
    /// is ready in time.
    ///
    /// With the timing table, the slaves have 1.5 times the TRANSFORM time, because they also draw strips during
    /// TRANSFORM. With i860 code, the slaves have a whole field, because the time of the code is unknown in advance
    /// (pphigs's kernels/order_rules.md).
    fn preparation_at(&self, field: PeriodNumber, viewpoint: Viewpoint, ahead: Span) -> Time {
        let first_strip = self.config.deadline(field, 0);
        if self.gp.runs_code() {
            return before(first_strip, ahead + self.config.field_time());
        }
        let views = if viewpoint == Viewpoint::Field { 1 } else { 2 };
        let span = self.pass.span(&self.gp.timing()) * views;
        before(first_strip, ahead + span + span / 2)
    }

    async fn order_field(&mut self, field: PeriodNumber, viewpoint: Viewpoint) -> Result<(), Fault> {
        let (begin, end) = self.config.ends(field);
        let at_begin = JitpConfig::view_number(field, 0);
        let picture = PictureNumber::drawn_for(field);
        self.gp.begin_view(Stage::Sample, picture, at_begin);
        self.gp.begin(Stage::Transform, picture, None);
        let views = match viewpoint {
            Viewpoint::Field => vec![self.view(at_begin, self.config.aimed_at_field(field))],
            _ => vec![self.view(at_begin, begin), self.view(JitpConfig::view_number(field, 1), end)],
        };
        let order = DrawingOrder::Field { field, views };
        self.gp.work(&OrderAssemblyWork(&order)).await?;
        let (words, body) = order.message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
        Ok(())
    }

    async fn order_strip(&mut self, field: PeriodNumber, strip: u32, viewpoint: Viewpoint) -> Result<(), Fault> {
        let own = viewpoint == Viewpoint::Strip;
        let number = JitpConfig::view_number(field, u64::from(strip));
        if own && self.config.is_middle(strip) {
            let picture = PictureNumber::drawn_for(field);
            self.gp.begin_view(Stage::Sample, picture, number);
            self.gp.begin(Stage::Transform, picture, None);
        }
        let view = if own { Some(self.view(number, self.config.aimed_at_strip(field, strip))) } else { None };
        let deadline = self.config.deadline(field, strip);
        let slave = self.config.slaves[strip as usize % self.config.slaves.len()];
        self.order(slave, &DrawingOrder::Strip { field, strip, deadline, view }).await
    }

    async fn order(&self, slave: NodeId, order: &DrawingOrder) -> Result<(), Fault> {
        self.gp.work(&OrderAssemblyWork(order)).await?;
        let (words, body) = order.message();
        self.gp.send(slave, words, body).await;
        Ok(())
    }

    /// Sends the next blocks and the newest view to each slave that has finished its earlier blocks.
    async fn roam(&mut self, batch: u64) -> Result<(), Fault> {
        let slaves = self.config.slaves.len();
        // At the start no slave has work, so all count as finished.
        self.state.done.borrow_mut().extend(0..slaves as u32);
        let mut flight = OrderTimes::new(slaves, u64::from(self.config.grid().regions()).div_ceil(batch));
        for update in PictureNumber::FIRST.onwards() {
            let slave = self.gp.until("a slave", || self.state.done.borrow_mut().pop_front()).await;
            let number = ViewNumber::taken_for(update);
            self.gp.begin_view(Stage::Sample, update, number);
            self.gp.begin(Stage::Transform, update, None);
            let shown_at = self.aimed_at_blocks(flight.ordered(slave as usize, self.gp.now()));
            let view = self.view(number, shown_at);
            if let Some(node) = self.config.slaves.get(slave as usize) {
                self.order(*node, &DrawingOrder::Blocks { update, step: update.0 * batch, view }).await?;
            }
        }
        Ok(())
    }

    fn aimed_at_blocks(&self, expected: Expected) -> Time {
        let first = self.gp.now() + expected.drawing;
        let beam = &self.config.beam;
        // Find the first retrace after the blocks have been drawn.
        let tick =
            self.gp.field().onwards().map(|field| beam.retrace(field)).find(|tick| *tick >= first).unwrap_or(first);
        self.config.aim.instant(&LightTimes { tick, first, last: first + expected.standing })
    }
}

/// Expected times of a batch of blocks: from the order until the blocks are visible (`drawing`), and from then until
/// newer blocks replace these blocks (`standing`).
struct Expected {
    drawing: Span,
    standing: Span,
}

struct OrderTimes {
    last_order_of: Vec<Option<Time>>,
    /// Times of the newest orders, oldest first. Together, these orders draw every block of the frame once.
    pass: VecDeque<Time>,
    orders_of_pass: usize,
}

impl OrderTimes {
    fn new(slaves: usize, orders_of_pass: u64) -> Self {
        Self { last_order_of: vec![None; slaves], pass: VecDeque::new(), orders_of_pass: orders_of_pass as usize }
    }

    /// Records an order and returns its expected times.
    ///
    /// The slave is expected to need as long as for its last order. The blocks are expected to stay visible until all
    /// blocks of the frame have been drawn again.
    fn ordered(&mut self, slave: usize, now: Time) -> Expected {
        self.pass.push_back(now);
        let oldest = if self.pass.len() > self.orders_of_pass { self.pass.pop_front() } else { None };
        let drawing = self.last_order_of[slave].replace(now).map_or(Span::ZERO, |at| now.since(at));
        Expected { drawing, standing: oldest.map_or(Span::ZERO, |at| now.since(at)) }
    }
}

fn before(time: Time, span: Span) -> Time {
    Time(time.0.saturating_sub(span.0))
}

#[cfg(test)]
mod tests;
