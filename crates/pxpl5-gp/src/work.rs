//! CPU work whose time comes from the timing table or from i860 code.

use crate::firmware::{Fault, Gp};
use crate::processor::{Processor, ProcessorFault};
use crate::timing::GpTiming;
use pxpl5_sim::Span;

/// A unit of CPU work. Its time comes from the timing table, or from a run of i860 code.
pub trait Work {
    /// Returns the CPU time of the work according to the timing table.
    fn by_table(&self, timing: &GpTiming) -> Span;

    /// Runs the work as i860 code on the board's processor, and returns its time. A part of the work without code takes
    /// its time from the timing table.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not return.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault>;

    /// Returns the number of vertices that the work transforms: corners of triangles and centres of spheres. Each
    /// vertex counts once for each view. Most kinds of work transform no vertices, so the default is 0.
    fn vertex_transforms(&self) -> u64 {
        0
    }
}

impl Gp {
    /// Does a unit of work. The program spends its CPU time.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Processor`] if the code of the work does not return.
    pub async fn work(&self, work: &impl Work) -> Result<(), Fault> {
        let span = self.time_of(work)?;
        self.spend(span).await;
        Ok(())
    }

    /// Returns the CPU time of a unit of work that answers a message, and counts it in
    /// [`GpUse::tokens`](crate::GpUse::tokens). The program must spend this time.
    pub(crate) fn answer_time(&self, work: &impl Work) -> Result<Span, Fault> {
        let span = self.time_of(work)?;
        self.shared.borrow_mut().answer_work += span;
        Ok(span)
    }

    /// Returns the CPU time of a unit of work, and counts the transformed vertices.
    fn time_of(&self, work: &impl Work) -> Result<Span, Fault> {
        let shared = &mut *self.shared.borrow_mut();
        shared.vertex_transforms += work.vertex_transforms();
        Ok(match &mut shared.processor {
            Some(processor) => work.by_code(&shared.timing, processor)?,
            None => work.by_table(&shared.timing),
        })
    }

    /// Returns true if the time of this board's work comes from i860 code.
    pub fn runs_code(&self) -> bool {
        self.shared.borrow().processor.is_some()
    }

    /// Calls `image`, which writes data to the memory of the i860. Does not call `image` on boards without i860 code.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Processor`] if the data do not fit.
    pub fn install(&self, image: impl FnOnce(&mut Processor) -> Result<(), ProcessorFault>) -> Result<(), Fault> {
        let shared = &mut *self.shared.borrow_mut();
        Ok(shared.processor.as_deref_mut().map_or(Ok(()), image)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CodeVersion, GpBoard, GpEvent, Priority};
    use pxpl5_sim::{Phase, TestBench};
    use pxpl5_wire::NodeId;
    use std::sync::Arc;

    const SCHEDULED: Option<CodeVersion> = Some(CodeVersion::Scheduled);

    /// Test work: i860 code with a loop of so many iterations, or with a trap if there is no number.
    struct Turns(Option<u32>);

    impl Work for Turns {
        fn by_table(&self, timing: &GpTiming) -> Span {
            Span::from_ns(timing.triangle_ns)
        }

        fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
            let source = "again: adds -1, r16, r16\n btne r0, r16, again\n bri r1\n nop\nwrong: trap r0, r0, r0";
            let program = Arc::new(i860::assemble("turns", 0x1000, source).unwrap_or_else(|e| panic!("{e}")));
            let entry = if self.0.is_some() { "again" } else { "wrong" };
            processor.call(&program, entry, &[(16, self.0.unwrap_or_default())], 1_000)
        }
    }

    fn run(timing: GpTiming, code: Option<CodeVersion>, turns: Option<u32>) -> GpBoard {
        let mut board = GpBoard::new(NodeId(5), timing, Span(25_000));
        if let Some(version) = code {
            board.run_code(version, i860::Config::cycle(), &std::rc::Rc::default());
        }
        let gp = board.handle_for(Priority::Foreground);
        board.load(Priority::Foreground, Box::pin(async move { gp.work(&Turns(turns)).await }));
        let mut bench: TestBench<GpEvent, crate::GpOutput> = TestBench::new();
        bench.feed(pxpl5_sim::Time::ZERO, Phase::Work, GpEvent::Poll);
        bench.run(|event, context| board.handle(event, context));
        board
    }

    #[test]
    fn a_board_without_code_spends_the_time_of_the_table() {
        let board = run(GpTiming::PAPERS, None, None);
        assert_eq!((board.busy(), board.fault()), (Span::from_ns(21_700), None));
    }

    #[test]
    fn a_board_with_code_spends_its_clocks() {
        let [ten, twenty] = [10, 20].map(|turns| run(GpTiming::PAPERS, SCHEDULED, Some(turns)).busy());
        // A turn takes two instructions and the two clocks of a taken btne.
        assert_eq!(twenty.0 - ten.0, 10 * 4 * Processor::CLOCK.0);
    }

    /// Regression test: a timing table that differs from the published table by one nanosecond must not turn off the
    /// i860 code.
    #[test]
    fn a_changed_time_per_triangle_still_runs_the_code() {
        let table = run(GpTiming::PAPERS, SCHEDULED, Some(10)).busy();
        let changed = GpTiming { triangle_ns: GpTiming::PAPERS.triangle_ns + 1, ..GpTiming::PAPERS };
        assert_eq!(run(changed, SCHEDULED, Some(10)).busy(), table);
    }

    #[test]
    fn without_code_a_changed_time_per_triangle_is_spent() {
        let board = run(GpTiming { triangle_ns: 30_000, ..GpTiming::PAPERS }, None, None);
        assert_eq!(board.busy(), Span::from_ns(30_000));
    }

    #[test]
    fn a_trap_stops_the_program_and_names_the_board_and_the_address() {
        let board = run(GpTiming::PAPERS, SCHEDULED, None);
        let fault = board.fault().expect("it trapped").to_string();
        assert_eq!(fault, "graphics processor at node 5: trap at 0x00001010: trap instruction");
    }

    /// Writes a word to the i860's memory at `address`, and checks that the word can be read.
    async fn install(gp: Gp, address: u32) -> Result<(), crate::Fault> {
        gp.install(|processor| processor.write(address, &[7]))?;
        gp.install(|processor| {
            assert_eq!(processor.read(address, 1)?, [7]);
            Ok(())
        })
    }

    #[test]
    fn installing_an_image_needs_a_processor_and_enough_memory() {
        for (code, address, fault) in [
            (SCHEDULED, 0x2000, None),
            (SCHEDULED, 8 << 20, Some("graphics processor at node 5: no memory for 1 words at 0x00800000")),
            (None, 8 << 20, None),
        ] {
            let mut board = GpBoard::new(NodeId(5), GpTiming::PAPERS, Span(25_000));
            if let Some(version) = code {
                board.run_code(version, i860::Config::cycle(), &std::rc::Rc::default());
            }
            let gp = board.handle_for(Priority::Foreground);
            board.load(Priority::Foreground, Box::pin(install(gp, address)));
            let mut bench: TestBench<GpEvent, crate::GpOutput> = TestBench::new();
            bench.feed(pxpl5_sim::Time::ZERO, Phase::Work, GpEvent::Poll);
            bench.run(|event, context| board.handle(event, context));
            assert_eq!(board.fault().map(ToString::to_string).as_deref(), fault);
            let installed = board.with_processor(|processor| processor.read(0x2000, 1) == Ok(vec![7]));
            assert_eq!(installed, code.map(|_| fault.is_none()));
        }
    }
}
