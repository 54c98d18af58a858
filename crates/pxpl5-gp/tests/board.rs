//! Tests of each promise of [`Gp`] and [`GpBoard`]. The expected times are sums of spans that the test sets. The
//! expected numbers of events follow from the waits that each event can end.

use pxpl5_gp::{
    Account, CodeVersion, Fault, Gp, GpBoard, GpEvent, GpOutput, GpTiming, Mark, OutOfMemory, PLACE_BITS, Priority,
    Processor, ProcessorFault, ProgramSnapshot, Stage, StageEdge, WaitingMessageInfo, Work,
};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::{Body, Message, NodeId, PeriodNumber, PictureNumber, RegionId, SurfaceId, ViewNumber};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

const BOARD: NodeId = NodeId(9);
const MESSAGE_NS: u64 = 1_000;
const CYCLE: Span = Span(25_000);
/// Pairs of a time and a number, which the programs of a test record.
type Notes = Rc<RefCell<Vec<(Time, u64)>>>;

fn note(notes: &Notes, gp: &Gp, value: u64) {
    notes.borrow_mut().push((gp.now(), value));
}

fn ns(ns: u64) -> Time {
    Time::ZERO + Span::from_ns(ns)
}

fn word(value: u32) -> (u32, Body) {
    (1, Body::Words([value].into()))
}

fn message(source: u16) -> GpEvent {
    let (words, body) = word(u32::from(source));
    GpEvent::Delivered(Message { source: NodeId(source), destination: BOARD, words, body })
}

/// Returns the acceptance event of the message at a place in a batch.
fn accepted(batch: u64, place: u64) -> GpEvent {
    GpEvent::Accepted(batch << PLACE_BITS | place)
}

struct Rig {
    board: GpBoard,
    bench: TestBench<GpEvent, GpOutput>,
}

impl Rig {
    fn new() -> Self {
        let timing = GpTiming { message_ns: MESSAGE_NS, memory_bytes: 1_000, bin_bytes: 300, ..GpTiming::PAPERS };
        let mut bench = TestBench::new();
        bench.feed(Time::ZERO, Phase::Work, GpEvent::Poll);
        Self { board: GpBoard::new(BOARD, timing, CYCLE), bench }
    }

    fn with<F>(mut self, priority: Priority, program: impl FnOnce(Gp) -> F) -> Self
    where
        F: Future<Output = Result<(), Fault>> + 'static,
    {
        let gp = self.board.handle_for(priority);
        self.board.load(priority, Box::pin(program(gp)));
        self
    }

    fn fed(mut self, at_ns: u64, event: GpEvent) -> Self {
        self.bench.feed(ns(at_ns), Phase::Arrive, event);
        self
    }

    fn run_to(&mut self, until_ns: u64) {
        let board = &mut self.board;
        self.bench.run_until(ns(until_ns), |event, context| board.handle(event, context));
    }

    /// Runs until no event is left. Returns the number of events.
    fn events(&mut self) -> u64 {
        self.run_to(1_000_000_000);
        self.bench.queue().events_taken()
    }

    fn marks(&mut self) -> Vec<Mark> {
        let mut marks = Vec::new();
        self.board.drain_marks(|mark| marks.push(mark));
        marks
    }
}

#[test]
fn messages_that_arrive_at_one_instant_are_processed_in_one_poll() {
    let notes = Notes::default();
    let program_notes = Rc::clone(&notes);
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        loop {
            let source = gp.next_message().await.source;
            note(&program_notes, &gp, source.0.into());
        }
    });
    rig = rig.fed(500, message(4)).fed(500, message(2)).fed(500, message(3)).fed(800, message(1));
    // The events are the first poll, four arrivals, and a poll for each of two instants.
    assert_eq!(rig.events(), 1 + 4 + 2);
    assert_eq!(*notes.borrow(), [(ns(500), 2), (ns(500), 3), (ns(500), 4), (ns(800), 1)]);
}

#[test]
fn an_event_that_ends_no_wait_does_not_wake_the_board() {
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        gp.spend(Span::from_ns(5_000)).await;
        gp.until("nothing", || None::<()>).await;
        Ok(())
    });
    rig = rig.fed(1_000, message(1)).fed(2_000, message(2)).fed(3_000, GpEvent::Retrace(PeriodNumber(7)));
    // The events are the first poll, three arrivals during work, and the end of the work.
    assert_eq!(rig.events(), 1 + 3 + 1);
}

#[test]
fn acceptances_wake_the_board_when_the_next_chain_can_start() {
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        let of = |value: u16| (NodeId(value), 1, word(u32::from(value)).1);
        gp.send_batch(vec![of(1), of(2), of(3)]).await;
        gp.send_batch(vec![of(4)]).await;
        gp.until("nothing", || None::<()>).await;
        Ok(())
    });
    rig = rig.fed(10_000, accepted(1, 2)).fed(11_000, accepted(1, 0)).fed(12_000, accepted(1, 1));
    rig = rig.fed(20_000, accepted(2, 0));
    // The events are the first poll, two software costs, four acceptances, and a poll at the acceptance after which the
    // DMA is free.
    assert_eq!(rig.events(), 1 + 2 + 4 + 1);
    let sent: Vec<_> = rig.bench.outputs.iter().map(|(time, GpOutput::Send { ticket, .. })| (*time, *ticket)).collect();
    let first = (0..3).map(|place| (ns(MESSAGE_NS) + CYCLE, 1 << PLACE_BITS | place));
    assert_eq!(sent, first.chain([(ns(12_000) + CYCLE, 2 << PLACE_BITS)]).collect::<Vec<_>>());
}

/// Sends a chain to receivers that accept their messages at intervals of 10 us in a given order. Returns the times at
/// which `draining`, `accepted` and `clump_buffer_free` end.
fn waits_of_a_chain(receivers: [u16; 3], order: [u64; 3]) -> Vec<(Time, u64)> {
    let notes = Notes::default();
    let program_notes = Rc::clone(&notes);
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        let of = |value: u16| (NodeId(value), 1, word(0).1);
        let ticket = gp.send_batch(receivers.map(of).into()).await;
        gp.draining(ticket).await;
        note(&program_notes, &gp, 1);
        gp.accepted(ticket).await;
        note(&program_notes, &gp, 2);
        gp.clump_buffer_free().await;
        note(&program_notes, &gp, 3);
        Ok(())
    });
    for (turn, place) in (1..).zip(order) {
        rig = rig.fed(turn * 10_000, accepted(1, place));
    }
    rig.events();
    notes.take()
}

#[test]
fn a_chain_is_accepted_when_all_receivers_have_taken_their_messages() {
    let [twenty, thirty] = [20_000, 30_000].map(ns);
    let all_at_the_end = [(thirty, 1), (thirty, 2), (thirty, 3)];
    assert_eq!(waits_of_a_chain([1, 1, 2], [0, 2, 1]), [(twenty, 1), (thirty, 2), (thirty, 3)]);
    assert_eq!(waits_of_a_chain([1, 1, 2], [0, 1, 2]), all_at_the_end);
    assert_eq!(waits_of_a_chain([1, 2, 3], [2, 0, 1]), all_at_the_end);
}

/// The interrupt program is polled first. It gets the progress of the other program at the same instant.
#[test]
fn a_program_reads_changes_of_another_program_at_once() {
    let notes = Notes::default();
    let (program_notes, done) = (Rc::clone(&notes), Rc::new(Cell::new(false)));
    let is_done = Rc::clone(&done);
    let rig = Rig::new().with(Priority::Foreground, |gp| async move {
        gp.spend(Span::from_ns(700)).await;
        done.set(true);
        gp.until("the end", || None::<()>).await;
        Ok(())
    });
    let mut rig = rig.with(Priority::Interrupt, |gp| async move {
        gp.until("the other program", || is_done.get().then_some(())).await;
        note(&program_notes, &gp, 1);
        Ok(())
    });
    rig.events();
    assert_eq!(*notes.borrow(), [(ns(700), 1)]);
}

#[test]
fn stages_are_reported_with_their_times_pictures_and_views() {
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        gp.begin(Stage::Edit, PictureNumber(3), None);
        gp.spend(Span::from_ns(400)).await;
        gp.end(Stage::Edit, PictureNumber(3), Some(SurfaceId(1)));
        gp.begin_view(Stage::Transform, PictureNumber(4), ViewNumber(8));
        gp.mark(Stage::Copy, PictureNumber(5), None, StageEdge::End, ns(100));
        Ok(())
    });
    rig.run_to(1_000);
    let mark = |time, picture, stage, edge| {
        let picture = PictureNumber(picture);
        Mark { time, node: BOARD, picture, surface: None, stage, edge, view: None }
    };
    let expected = [
        mark(ns(0), 3, Stage::Edit, StageEdge::Begin),
        Mark { surface: Some(SurfaceId(1)), ..mark(ns(400), 3, Stage::Edit, StageEdge::End) },
        Mark { view: Some(ViewNumber(8)), ..mark(ns(400), 4, Stage::Transform, StageEdge::Begin) },
        mark(ns(100), 5, Stage::Copy, StageEdge::End),
    ];
    assert_eq!(rig.marks(), expected);
    assert_eq!(rig.marks(), [], "they are taken once");
}

#[test]
fn a_stage_that_ends_with_a_chain_ends_at_its_acceptance() {
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        for picture in [1, 2] {
            let (words, body) = word(picture);
            let ticket = gp.send(NodeId(1), words, body).await;
            gp.end_when_accepted(ticket, Stage::Render, PictureNumber(picture.into()));
        }
        Ok(())
    });
    rig = rig.fed(10_000, accepted(1, 0)).fed(20_000, accepted(2, 0));
    rig.run_to(15_000);
    let ended = |mark: &Mark| (mark.time, mark.picture, mark.stage, mark.edge);
    let [first, second] = [(ns(10_000), 1), (ns(20_000), 2)]
        .map(|(time, picture)| (time, PictureNumber(picture), Stage::Render, StageEdge::End));
    assert_eq!(rig.marks().iter().map(ended).collect::<Vec<_>>(), [first]);
    rig.run_to(30_000);
    assert_eq!(rig.marks().iter().map(ended).collect::<Vec<_>>(), [second]);
}

#[test]
fn a_program_reads_retraces_and_status_lines() {
    let notes = Notes::default();
    let program_notes = Rc::clone(&notes);
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        assert_eq!((gp.node(), gp.field(), gp.status(NodeId(5))), (BOARD, PeriodNumber::FIRST, 0));
        let field = gp.retrace().await;
        note(&program_notes, &gp, field.0);
        gp.until("two swaps", || (gp.status(NodeId(5)) == 2).then_some(())).await;
        note(&program_notes, &gp, gp.status(NodeId(6)));
        gp.until("three swaps", || (gp.status(NodeId(5)) == 3).then_some(())).await;
        note(&program_notes, &gp, gp.field().0);
        Ok(())
    });
    // The current period ends no wait for a retrace.
    rig = rig.fed(50, GpEvent::Retrace(PeriodNumber::FIRST)).fed(100, GpEvent::Retrace(PeriodNumber(1)));
    for (at, from, value) in [(200, 5, 1), (300, 6, 7), (400, 5, 2), (500, 5, 3)] {
        rig = rig.fed(at, GpEvent::Status { from: NodeId(from), value });
    }
    rig.events();
    assert_eq!(*notes.borrow(), [(ns(100), 1), (ns(400), 7), (ns(500), 1)]);
}

#[test]
fn a_request_for_more_memory_than_available_stops_the_program() {
    let asked = |account, bytes| {
        Rig::new().with(Priority::Foreground, move |gp| async move {
            gp.reserve(Account::Program, 600, None)?;
            assert!(gp.has_room_for_bins(0, 300) && !gp.has_room_for_bins(0, 301));
            gp.reserve(Account::Bins(1), 200, Some(RegionId(4)))?;
            assert!(gp.has_room_for_bins(0, 100) && !gp.has_room_for_bins(0, 101));
            gp.reserve(account, bytes, Some(RegionId(4)))
        })
    };
    let mut fits = asked(Account::Bins(0), 100);
    fits.run_to(0);
    assert_eq!((fits.board.fault(), fits.board.memory_peak_bytes()), (None, 900));
    let mut is_too_much = asked(Account::DisplayList, 201);
    is_too_much.run_to(0);
    let fault = OutOfMemory {
        gp: BOARD,
        account: Account::DisplayList,
        region: Some(RegionId(4)),
        needed_bytes: 201,
        available_bytes: 200,
    };
    assert_eq!(is_too_much.board.fault(), Some(&Fault::Memory(fault)));
    assert_eq!(is_too_much.board.memory_peak_bytes(), 800);
    assert!(format!("{:?}", is_too_much.board).contains("OutOfMemory"), "who prints a board sees what stopped it");
}

#[test]
fn a_message_can_be_received_without_cpu_time() {
    let notes = Notes::default();
    let program_notes = Rc::clone(&notes);
    let mut rig = Rig::new().with(Priority::Interrupt, |gp| async move {
        assert!(gp.take_message().is_none());
        gp.until("a field", || (gp.field() == PeriodNumber(1)).then_some(())).await;
        let sources = [gp.take_message(), gp.take_message(), gp.take_message()];
        let sources = sources.map(|received| received.map_or(0, |received| u64::from(received.source.0)));
        sources.iter().for_each(|source| note(&program_notes, &gp, *source));
        // A chain without messages counts as accepted.
        gp.accepted(gp.send_batch(Vec::new()).await).await;
        note(&program_notes, &gp, 1);
        Ok(())
    });
    rig = rig.fed(100, message(3)).fed(200, message(8)).fed(300, GpEvent::Retrace(PeriodNumber(1)));
    rig.events();
    let paid = ns(300 + MESSAGE_NS);
    assert_eq!(*notes.borrow(), [(ns(300), 3), (ns(300), 8), (ns(300), 0), (paid, 1)]);
}

/// The foreground program works for 3 us from the start. A message at 1 us takes 0.5 us of the interrupt program.
fn interrupted() -> Rig {
    let rig = Rig::new().with(Priority::Foreground, |gp| async move {
        gp.spend(Span::from_ns(3_000)).await;
        gp.send_batch(vec![(NodeId(2), 1, word(0).1), (NodeId(1), 1, word(0).1)]).await;
        gp.send(NodeId(1), 1, word(0).1).await;
        gp.until("the end", || None::<()>).await;
        Ok(())
    });
    let rig = rig.with(Priority::Interrupt, |gp| async move {
        gp.next_message().await;
        gp.spend(Span::from_ns(500)).await;
        gp.until("nothing more", || None::<()>).await;
        Ok(())
    });
    rig.fed(1_000, message(4))
        .fed(1_200, message(6))
        .fed(1_250, message(5))
        .fed(2_000, GpEvent::Retrace(PeriodNumber(3)))
}

#[test]
fn a_snapshot_shows_the_remaining_work_and_the_waiting_messages() {
    let mut rig = interrupted();
    let program = |priority, waits_for, left_ns: Option<u64>| ProgramSnapshot {
        priority,
        waits_for,
        work_left: left_ns.map(Span::from_ns),
    };
    const WORK: &str = "the end of its own work";
    let snapshot = rig.board.snapshot(Time::ZERO);
    assert_eq!(
        snapshot.programs,
        [Priority::Interrupt, Priority::Foreground].map(|priority| program(priority, "", None))
    );

    rig.run_to(400);
    let programs = |rig: &Rig, at_ns| rig.board.snapshot(ns(at_ns)).programs;
    let waits = program(Priority::Interrupt, "a message", None);
    assert_eq!(programs(&rig, 900), [waits, program(Priority::Foreground, WORK, Some(2_100))]);

    // The foreground program is suspended while the interrupt program works.
    rig.run_to(1_260);
    let both = [program(Priority::Interrupt, WORK, Some(200)), program(Priority::Foreground, WORK, Some(2_000))];
    assert_eq!(programs(&rig, 1_300), both);
    let ends = [program(Priority::Interrupt, WORK, None), program(Priority::Foreground, WORK, Some(2_000))];
    assert_eq!(programs(&rig, 1_500), ends, "at the instant at which it ends");
    let mail = |arrived_ns, source| WaitingMessageInfo { arrived: ns(arrived_ns), source: NodeId(source) };
    assert_eq!(rig.board.snapshot(ns(1_300)).inbox, [mail(1_200, 6), mail(1_250, 5)]);

    rig.run_to(10_000);
    let snapshot = rig.board.snapshot(ns(10_000));
    assert_eq!((snapshot.unaccepted, snapshot.chains), (vec![NodeId(2), NodeId(1)], vec![1]));
    assert_eq!((snapshot.busy, snapshot.period), (Span::from_ns(3_000 + 500 + 2 * MESSAGE_NS), PeriodNumber(3)));
    assert_eq!(rig.board.busy(), snapshot.busy);
    let waits = program(Priority::Interrupt, "nothing more", None);
    assert_eq!(snapshot.programs, [waits, program(Priority::Foreground, "the end", None)]);
    assert_eq!(rig.board.blocked(), Some("the end"));
}

#[test]
fn a_snapshot_shows_each_account_of_the_memory() {
    let mut rig = Rig::new().with(Priority::Foreground, |gp| async move {
        for (bytes, account) in (1..).zip(Account::ALL) {
            gp.reserve(account, bytes, None)?;
        }
        // The numbers use contexts 0 and 1 in turn, so number 2 uses context 0.
        gp.reserve(Account::Commands(2), 30, None)?;
        gp.reserve(Account::Bins(3), 60, None)
    });
    rig.run_to(0);
    let held: Vec<u64> = rig.board.snapshot(Time::ZERO).memory.into_iter().map(|(_, bytes)| bytes).collect();
    assert_eq!(held, [1, 2, 30, 4, 5, 60]);
    assert_eq!(rig.board.memory_peak_bytes(), held.iter().sum::<u64>());
}

/// Work that runs two instructions of code.
struct Code(Arc<i860::Program>);

impl Work for Code {
    fn by_table(&self, _: &GpTiming) -> Span {
        Span::ZERO
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        processor.call(&self.0, "start", &[], 10)
    }
}

#[test]
fn breakpoints_need_a_processor() {
    let program = Arc::new(i860::assemble("code", 0x1000, "start: bri r1\n nop").expect("it can be assembled"));
    for code in [None, Some(CodeVersion::Compiled)] {
        let mut board = GpBoard::new(BOARD, GpTiming::PAPERS, CYCLE);
        if let Some(version) = code {
            board.run_code(version, i860::Config::cycle(), &Rc::default());
        }
        board.break_at(&[0x1000].into());
        let gp = board.handle_for(Priority::Foreground);
        let work = Code(Arc::clone(&program));
        board.load(Priority::Foreground, Box::pin(async move { gp.work(&work).await }));
        let mut rig = Rig { board, ..Rig::new() };
        rig.run_to(1_000_000);
        let addresses: Vec<u32> = rig.board.take_hits().iter().map(|hit| hit.address).collect();
        let expected: &[u32] = if code.is_some() { &[0x1000] } else { &[] };
        assert_eq!((&addresses[..], rig.board.take_hits().len()), (expected, 0));
        let memory = rig.board.with_processor(Processor::memory_bytes);
        assert_eq!(memory, code.map(|_| 8 << 20), "of a board as built");
    }
}

/// Work that takes this many nanoseconds by the table.
struct BinHandoffWork(u64);

impl Work for BinHandoffWork {
    fn by_table(&self, _: &GpTiming) -> Span {
        Span::from_ns(self.0)
    }

    fn by_code(&self, timing: &GpTiming, _: &mut Processor) -> Result<Span, ProcessorFault> {
        Ok(self.by_table(timing))
    }
}

/// A request for the interrupt program: the arrival time, the time of the work if any, and the number of answers before
/// the last answer.
type Order = (u64, Option<u64>, usize);

/// Returns the sent messages with their times, and the busy time. The foreground program alternates between work and a
/// message. Message n is accepted `delays[n]` hundreds of nanoseconds after its departure. The delays repeat
/// cyclically.
fn answers(orders: &[Order], foreground: &[u64], delays: &[u64]) -> (Vec<(Time, u16, u64)>, Span) {
    let all = Rc::new(RefCell::new(orders.to_vec()));
    let mut rig = Rig::new().with(Priority::Interrupt, |gp| async move {
        loop {
            let received = gp.next_message().await;
            let (_, work, count) = all.borrow_mut().remove(0);
            let messages = (0..count as u16).map(|n| (NodeId(1 + n), 1, word(0).1));
            let work = work.map(|hundreds| BinHandoffWork(100 * hundreds));
            gp.answer(&received, work.as_ref(), messages, (NodeId(0), 1, word(0).1)).await?;
        }
    });
    let spans = foreground.to_vec();
    rig = rig.with(Priority::Foreground, |gp| async move {
        for span in spans {
            gp.spend(Span::from_ns(100 * span)).await;
            gp.send(NodeId(8), 1, word(0).1).await;
        }
        gp.until("nothing", || None::<()>).await;
        Ok(())
    });
    rig = orders.iter().fold(rig, |rig, (at, ..)| rig.fed(100 * at, message(7)));
    let mut accepted = 0;
    while let Some(next) = rig.bench.queue().next_time() {
        rig.run_to(next.0 / 1_000);
        while let Some((time, GpOutput::Send { ticket, .. })) = rig.bench.outputs.get(accepted) {
            let (at, event) =
                (*time + Span::from_ns(100 * delays[accepted % delays.len()]), GpEvent::Accepted(*ticket));
            rig.bench.feed(at, Phase::Arrive, event);
            accepted += 1;
        }
    }
    let sent = rig.bench.outputs.iter();
    let sent = sent.map(|(time, GpOutput::Send { message, ticket, .. })| (*time, message.destination.0, *ticket));
    (sent.collect(), rig.board.busy())
}

/// Reception and work take 0.3 us together, and the messages follow. The second message begins at the acceptance of the
/// first message. This is a cycle and 0.1 us after the end of the first message's software.
#[test]
fn an_answer_takes_the_software_time_of_one_received_message_and_of_each_sent_message() {
    for (count, expected_ns) in [(0, vec![3_300]), (1, vec![3_300, 4_300]), (2, vec![3_300, 4_425, 5_425])] {
        let (sent, busy) = answers(&[(10, Some(3), count)], &[], &[1]);
        let times: Vec<Time> = sent.iter().map(|(time, ..)| *time).collect();
        assert_eq!(times, expected_ns.into_iter().map(|at| ns(at) + CYCLE).collect::<Vec<_>>());
        assert_eq!(busy, Span::from_ns(300 + (count as u64 + 2) * MESSAGE_NS));
    }
}
