//! The master GP: it follows the beam, keeps the newest tracking data and orders strips or blocks.

use crate::config::{Config, Schedule, Viewpoint, Wanted};
use crate::protocol::Order;
use pphigs::{Counts, FrameView};
use pxpl5_gp::{Account, Fault, Firmware, Gp, GpTiming, Priority, Stage};
use pxpl5_sim::{Span, Time};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

/// Bytes of program, stacks and message buffers on a GP (assumed).
pub(crate) const PROGRAM_BYTES: u64 = 1 << 20;

#[derive(Debug, Default)]
struct State {
    known: Cell<Time>,
    done: RefCell<VecDeque<u32>>,
}

/// The programs of the master for both levels of its board. `counts` are the primitives of the whole display list;
/// `view_of` predicts.
///
/// They fail with [`Fault::Protocol`] for a message that no board sends.
pub fn master(
    gp: &Gp,
    config: &Config,
    counts: Counts,
    view_of: impl FnMut(Wanted) -> FrameView + 'static,
) -> Vec<(Priority, Firmware)> {
    let state = Rc::new(State::default());
    let listening = listen(gp.at_priority(Priority::Interrupt), Rc::clone(&state));
    let foreground = gp.at_priority(Priority::Foreground);
    let master = Master { gp: foreground, config: config.clone(), counts, view_of, state };
    vec![(Priority::Interrupt, Box::pin(listening)), (Priority::Foreground, Box::pin(master.run()))]
}

async fn listen(gp: Gp, state: Rc<State>) -> Result<(), Fault> {
    loop {
        let received = gp.receive().await;
        match Order::read(&received, gp.node())? {
            Order::Report { known } => state.known.set(known),
            Order::Done { slave } => state.done.borrow_mut().push_back(slave),
            other => return Err(Fault::Protocol { node: gp.node(), found: format!("at the master: {other:?}") }),
        }
    }
}

struct Master<V> {
    gp: Gp,
    config: Config,
    counts: Counts,
    view_of: V,
    state: Rc<State>,
}

impl<V: FnMut(Wanted) -> FrameView> Master<V> {
    async fn run(mut self) -> Result<(), Fault> {
        self.gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
        match self.config.schedule {
            Schedule::Beam { viewpoint, racing, .. } => self.follow_the_beam(viewpoint, racing).await,
            Schedule::Roam { batch, .. } => self.roam(u64::from(batch)).await,
        }
        Ok(())
    }

    fn view(&mut self, number: u64, shown_at: Time) -> FrameView {
        (self.view_of)(Wanted { number, known: self.state.known.get(), shown_at })
    }

    async fn follow_the_beam(&mut self, viewpoint: Viewpoint, racing: bool) {
        let ahead = self.config.lead() + if racing { Span::ZERO } else { self.field_span() };
        let first = self.gp.field() + 2;
        let mut prepared = first;
        let strips = self.config.grid().rows();
        for field in first.. {
            for strip in 0..strips {
                let order_at = before(self.config.deadline(field, strip), ahead);
                while viewpoint != Viewpoint::Strip && self.preparation_at(prepared, viewpoint, ahead) <= order_at {
                    self.wait_until(self.preparation_at(prepared, viewpoint, ahead)).await;
                    self.order_field(prepared, viewpoint).await;
                    prepared += 1;
                }
                self.wait_until(order_at).await;
                if self.gp.now() < self.config.deadline(field, strip) {
                    self.order_strip(field, strip, viewpoint).await;
                }
            }
        }
    }

    fn field_span(&self) -> Span {
        self.config.deadline(2, 0).since(self.config.deadline(0, 0)) / 2
    }

    /// When slaves must begin to transform for a field: half again as early as that takes, since they draw meanwhile.
    fn preparation_at(&self, field: u64, viewpoint: Viewpoint, ahead: Span) -> Time {
        let views = if viewpoint == Viewpoint::Field { 1 } else { 2 };
        let span = transform_span(&self.gp.timing(), self.counts) * views;
        before(self.config.deadline(field, 0), ahead + span + span / 2)
    }

    async fn wait_until(&self, time: Time) {
        while self.gp.now() < time {
            self.gp.spend(time.since(self.gp.now())).await;
        }
    }

    async fn order_field(&mut self, field: u64, viewpoint: Viewpoint) {
        let (begin, end) = self.config.ends(field);
        let number = |i| Config::view_number(field, i);
        self.gp.begin_view(Stage::Sample, field, number(0));
        self.gp.begin(Stage::Transform, field, None);
        let views = match viewpoint {
            Viewpoint::Field => vec![self.view(number(0), begin)],
            _ => vec![self.view(number(0), begin), self.view(number(1), end)],
        };
        self.gp.spend(Span::from_ns(self.gp.timing().pass_ns)).await;
        let (words, body) = Order::Field { field, views }.message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
    }

    async fn order_strip(&mut self, field: u64, strip: u32, viewpoint: Viewpoint) {
        let own = viewpoint == Viewpoint::Strip;
        let number = Config::view_number(field, u64::from(strip));
        if own && self.config.is_middle(strip) {
            self.gp.begin_view(Stage::Sample, field, number);
            self.gp.begin(Stage::Transform, field, None);
        }
        let view = if own { Some(self.view(number, self.config.middle(field, strip))) } else { None };
        let deadline = self.config.deadline(field, strip);
        let slave = self.config.slaves[strip as usize % self.config.slaves.len()];
        let (words, body) = Order::Strip { field, strip, deadline, view }.message();
        self.gp.send(slave, words, body).await;
    }

    /// Gives every slave that is done the next blocks, with the newest view.
    async fn roam(&mut self, batch: u64) {
        let slaves = self.config.slaves.len();
        self.state.done.borrow_mut().extend(0..slaves as u32);
        let mut flight = Flight::new(slaves, u64::from(self.config.grid().regions()).div_ceil(batch));
        for update in 0.. {
            let slave = self.gp.until("a slave", || self.state.done.borrow_mut().pop_front()).await;
            self.gp.begin_view(Stage::Sample, update, update);
            self.gp.begin(Stage::Transform, update, None);
            let shown_at = self.gp.now() + flight.ordered(slave as usize, self.gp.now());
            let view = self.view(update, shown_at);
            let (words, body) = Order::Blocks { update, step: update * batch, view }.message();
            if let Some(node) = self.config.slaves.get(slave as usize) {
                self.gp.send(*node, words, body).await;
            }
        }
    }
}

/// How long orders have been on their way lately.
struct Flight {
    last_order_of: Vec<Option<Time>>,
    /// Orders of the last pass, oldest first.
    pass: VecDeque<Time>,
    orders_of_pass: usize,
}

impl Flight {
    fn new(slaves: usize, orders_of_pass: u64) -> Self {
        Self { last_order_of: vec![None; slaves], pass: VecDeque::new(), orders_of_pass: orders_of_pass as usize }
    }

    /// From an order to the middle of the time in which its blocks are seen: as long as this slave's last order took,
    /// and half a pass.
    fn ordered(&mut self, slave: usize, now: Time) -> Span {
        self.pass.push_back(now);
        let oldest = if self.pass.len() > self.orders_of_pass { self.pass.pop_front() } else { None };
        let drawing = self.last_order_of[slave].replace(now).map_or(Span::ZERO, |at| now.since(at));
        drawing + oldest.map_or(Span::ZERO, |at| now.since(at)) / 2
    }
}

/// CPU time of one TRANSFORM of everything.
pub(crate) fn transform_span(timing: &GpTiming, counts: Counts) -> Span {
    let Counts { triangles, spheres } = counts;
    let primitives = timing.triangle_ns * u64::from(triangles) + timing.sphere_ns * u64::from(spheres);
    Span::from_ns(timing.pass_ns + primitives)
}

fn before(time: Time, span: Span) -> Time {
    Time(time.0.saturating_sub(span.0))
}
