//! Functions with which a program receives messages from the inbox and sends messages in chains. The message software
//! needs CPU time for each received message and each sent chain.
//!
//! This time is `message_ns` of the timing table, or the time of i860 code on the board's processor
//! ([`Processor::receive_message`], [`Processor::send_chain`]).

use crate::firmware::{Batch, ChainLink, Fault, Gp, Received, Ticket};
use crate::processor::Processor;
use crate::work::Work;
use pxpl5_sim::Span;
use pxpl5_wire::{Body, Message, NodeId};

/// A chain of messages that the DMA sends together. [`Gp::prepare`] makes the chain and spends its CPU time, and
/// [`Gp::start`] sends it.
#[derive(Debug)]
pub struct Chain(Vec<ChainLink>);

impl Gp {
    /// Waits for the next message in order of arrival, and spends the CPU time of its reception.
    #[inline]
    pub async fn receive(&self) -> Received {
        let received = self.next_message().await;
        self.pay_for(&received).await;
        received
    }

    /// Waits for the next message in order of arrival. The program must spend the CPU time of its reception later, with
    /// [`Gp::pay_for`].
    #[inline]
    pub async fn next_message(&self) -> Received {
        self.until("a message", || self.shared.borrow_mut().inbox.pop_front()).await
    }

    /// Takes the next message if one has arrived. The program must spend the CPU time of its reception later, with
    /// [`Gp::pay_for`].
    #[inline]
    pub fn take_message(&self) -> Option<Received> {
        self.shared.borrow_mut().inbox.pop_front()
    }

    /// Spends the CPU time of the reception of a message.
    #[inline]
    pub async fn pay_for(&self, received: &Received) {
        let span = self.reception_time(received).await;
        self.spend(span).await;
    }

    #[inline]
    async fn reception_time(&self, received: &Received) -> Span {
        self.software_time(|processor| processor.receive_message(received.source, &received.body)).await
    }

    /// Answers a message: spends the CPU time of its reception, does `work`, sends `messages` one by one, and finally
    /// sends `last` in the background. Before each of `messages`, the function waits for a free clump buffer (the
    /// memory for outgoing messages).
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Processor`] if i860 code does not return.
    pub async fn answer(
        &self,
        received: &Received,
        work: Option<&impl Work>,
        messages: impl Iterator<Item = (NodeId, u32, Body)>,
        last: (NodeId, u32, Body),
    ) -> Result<(), Fault> {
        // Nothing happens between two steps except at a full clump buffer, so one event ends them together.
        let mut due = self.reception_time(received).await;
        if let Some(work) = work {
            due = self.spend_before_code(due).await + self.answer_time(work)?;
        }
        // Each message needs the clump buffer. Only `last` is sent without a wait.
        for message in messages {
            if !self.is_clump_buffer_free() {
                self.spend(std::mem::take(&mut due)).await;
                self.clump_buffer_free().await;
            }
            self.send_after(std::mem::take(&mut due), message).await;
        }
        self.send_after(due, last).await;
        Ok(())
    }

    /// Spends `due` if the board runs i860 code, and returns the time that the program must still spend. The code of the
    /// next step must begin at its own instant, because the code of the board's other program changes the caches too.
    #[inline]
    async fn spend_before_code(&self, due: Span) -> Span {
        if !self.runs_code() {
            return due;
        }
        self.spend(due).await;
        Span::ZERO
    }

    /// Sends one message in the background. Before, the program spends `due`, the CPU time of its earlier work, and the
    /// CPU time of the message software.
    #[inline]
    async fn send_after(&self, due: Span, message: (NodeId, u32, Body)) {
        let due = self.spend_before_code(due).await;
        let chain = self.unheld([message]);
        let span = due + self.chain_time(&chain).await;
        self.spend(span).await;
        self.start(chain);
    }

    /// Sends one message in the background, after all earlier messages. The program spends the CPU time of the message
    /// software.
    #[inline]
    pub async fn send(&self, destination: NodeId, words: u32, body: Body) -> Ticket {
        let chain = self.pay_for_chain(self.unheld([(destination, words, body)])).await;
        self.start(chain)
    }

    /// Sends several messages as one chain in the background, after the acceptance of the previous chain. The CPU time
    /// is the same as for one message. The DMA sends messages to different receivers at the same time.
    #[inline]
    pub async fn send_batch(&self, batch: Vec<(NodeId, u32, Body)>) -> Ticket {
        let chain = self.prepare(batch).await;
        self.start(chain)
    }

    /// Sends groups of messages as one chain, like [`Gp::send_batch`]. Each group has one receiver, whose port stays
    /// reserved from its first to its last message, so that nothing from another board can arrive in between.
    #[inline]
    pub async fn send_groups(&self, groups: Vec<(NodeId, Vec<(u32, Body)>)>) -> Ticket {
        let links = groups.into_iter().flat_map(|(destination, group)| {
            // The last message of a group releases the port of the receiver.
            let last = group.len().saturating_sub(1);
            let numbered = (0..).zip(group);
            numbered.map(move |(place, (words, body))| (destination, words, body, place < last))
        });
        let chain = self.pay_for_chain(self.chain(links)).await;
        self.start(chain)
    }

    /// Makes a chain of messages, and spends the CPU time of the message software. [`Gp::start`] sends the chain.
    #[inline]
    pub async fn prepare(&self, batch: Vec<(NodeId, u32, Body)>) -> Chain {
        self.pay_for_chain(self.unheld(batch)).await
    }

    /// Passes a chain of messages to the DMA, which sends the chain after all earlier chains.
    #[inline]
    pub fn start(&self, Chain(links): Chain) -> Ticket {
        let shared = &mut *self.shared.borrow_mut();
        if links.is_empty() {
            return Ticket(shared.issued);
        }
        shared.issued += 1;
        let ticket = Ticket(shared.issued);
        shared.batches.push_back(Batch { ticket, links });
        ticket
    }

    #[inline]
    fn unheld(&self, batch: impl IntoIterator<Item = (NodeId, u32, Body)>) -> Chain {
        self.chain(batch.into_iter().map(|(destination, words, body)| (destination, words, body, false)))
    }

    /// Makes a chain of messages. Each item has the receiver, the number of words, and the content of a message. The
    /// boolean is true if the receiver's port stays reserved for the next message of the chain.
    #[inline]
    fn chain(&self, batch: impl Iterator<Item = (NodeId, u32, Body, bool)>) -> Chain {
        let source = self.node();
        let links = batch.map(|(destination, words, body, hold)| ChainLink {
            message: Message { source, destination, words, body },
            hold,
        });
        Chain(links.collect())
    }

    #[inline]
    async fn pay_for_chain(&self, chain: Chain) -> Chain {
        let span = self.chain_time(&chain).await;
        self.spend(span).await;
        chain
    }

    #[inline]
    async fn chain_time(&self, chain: &Chain) -> Span {
        self.software_time(|processor| processor.send_chain(chain.0.iter().map(|link| (&link.message, link.hold))))
            .await
    }

    /// Returns and counts the CPU time of the message software: `message_ns` of the timing table, or the time of `code`
    /// on boards that run i860 code. The program must spend this time. If the code fails, the board stops and the
    /// function never returns.
    #[inline]
    async fn software_time(&self, code: impl FnOnce(&mut Processor) -> Result<Span, Fault>) -> Span {
        let span = {
            let shared = &mut *self.shared.borrow_mut();
            let span = match &mut shared.processor {
                Some(processor) => code(processor),
                None => Ok(Span::from_ns(shared.timing.message_ns)),
            };
            shared.message_software += span.as_ref().copied().unwrap_or(Span::ZERO);
            span
        };
        match span {
            Ok(span) => span,
            Err(fault) => self.stop(fault).await,
        }
    }

    /// Stops the board because of a fault in its message software. This future never completes.
    async fn stop(&self, fault: Fault) -> Span {
        self.shared.borrow_mut().software_fault = Some(fault);
        std::future::pending().await
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::Priority;
    use crate::{CodeVersion, GpBoard, GpEvent, GpOutput, GpTiming};
    use pxpl5_sim::{Phase, TestBench, Time};

    async fn echo(gp: Gp) -> Result<(), Fault> {
        loop {
            let received = gp.receive().await;
            gp.send(received.source, 1, received.body).await;
        }
    }

    /// Waits forever, so that messages stay in the inbox until the interrupt program reads them.
    async fn wait(gp: Gp) -> Result<(), Fault> {
        gp.until("nothing", || None::<()>).await;
        Ok(())
    }

    fn board(message_ns: u64, code: bool) -> GpBoard {
        let mut board = GpBoard::new(NodeId(9), GpTiming { message_ns, ..GpTiming::PAPERS }, Span(25_000));
        if code {
            board.run_code(CodeVersion::Compiled, i860::Config::cycle(), &std::rc::Rc::default());
        }
        let gp = board.handle_for(Priority::Interrupt);
        board.load(Priority::Interrupt, Box::pin(echo(gp)));
        let gp = board.handle_for(Priority::Foreground);
        board.load(Priority::Foreground, Box::pin(wait(gp)));
        board
    }

    /// Sends messages of `lengths` words to a board. Returns the CPU time of the board and the number of its replies.
    fn fed(board: &mut GpBoard, lengths: &[usize]) -> (Span, usize) {
        let mut bench: TestBench<GpEvent, GpOutput> = TestBench::new();
        for (number, words) in (1..).zip(lengths) {
            let body = Body::Words(vec![7; *words].into());
            let message = Message { source: NodeId(2), destination: NodeId(9), words: *words as u32, body };
            bench.feed(Time(number * 1_000_000_000), Phase::Arrive, GpEvent::Delivered(message));
            bench.feed(
                Time(number * 1_000_000_000 + 900_000_000),
                Phase::Arrive,
                GpEvent::Accepted(number << crate::PLACE_BITS),
            );
        }
        bench.run(|event, context| board.handle(event, context));
        (board.busy(), bench.outputs.len())
    }

    #[test]
    fn with_code_a_message_takes_the_time_of_the_code() {
        let lengths = [1, 2, 100, 3];
        let [one, other] = [1_000, 5_000].map(|message_ns| fed(&mut board(message_ns, true), &lengths));
        assert_eq!(one, other);
        let mut processor = Processor::new(NodeId(9), 8 << 20, CodeVersion::Compiled, i860::Config::cycle());
        let mut expected = Span::ZERO;
        for words in lengths {
            let body = Body::Words(vec![7; words].into());
            let message = Message { source: NodeId(9), destination: NodeId(2), words: 1, body: body.clone() };
            expected += processor.receive_message(NodeId(2), &body).expect("it returns");
            expected += processor.send_chain([(&message, false)].into_iter()).expect("it returns");
        }
        assert_eq!(one, (expected, 4));
        assert_eq!(fed(&mut board(1_000, false), &lengths), (Span::from_ns(8_000), 4));
    }

    #[test]
    fn a_fault_of_the_boards_software_stops_all_its_programs() {
        let mut board = board(1_000, true);
        let (_, sent) = fed(&mut board, &[1, 1025, 1]);
        assert_eq!(sent, 1, "what came later is not answered");
        let fault = board.fault().expect("it stopped").to_string();
        assert_eq!(fault, "node 9: unexpected message of 1025 words from node 2");
        assert!(board.blocked().is_none() && board.snapshot(Time(4_000_000_000)).programs.is_empty());
    }
}
