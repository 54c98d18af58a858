use super::*;
use proptest::prelude::*;

const WORD: Span = Span(50_000);

/// Reference model of the FIFO, which handles one word at a time.
struct ReferenceFifo {
    depth: usize,
    held: VecDeque<Time>,
    last_word_at: Time,
    free_at: Time,
}

impl ReferenceFifo {
    fn message(&mut self, begins: Time, commands: &[(u32, u64)]) -> (Time, Vec<Time>) {
        self.last_word_at = self.last_word_at.max(begins);
        let mut starts = Vec::new();
        for (words, ns) in commands {
            for _ in 0..*words {
                // Word n enters the FIFO when word n - depth has left the FIFO.
                let room =
                    if self.held.len() < self.depth { Time::ZERO } else { self.held[self.held.len() - self.depth] };
                self.last_word_at = self.last_word_at.max(room) + WORD;
                self.held.push_back(Time(u64::MAX));
            }
            // A command starts when it is complete and the previous command has ended. All its words then leave.
            let start = self.free_at.max(self.last_word_at);
            let n = self.held.len();
            self.held.iter_mut().skip(n - *words as usize).for_each(|left| *left = start);
            self.free_at = start + Span::from_ns(*ns);
            starts.push(start);
        }
        (self.last_word_at, starts)
    }
}

fn message(fifo: &mut InputFifo, begins: Time, work: impl IntoIterator<Item = CommandBatch>) -> Progress {
    work.into_iter().for_each(|work| fifo.take(work));
    fifo.message(begins)
}

fn work(runs: &[(u32, u64, u32)]) -> Vec<CommandBatch> {
    let run = |(words_each, ns, count): &(u32, u64, u32)| CommandBatch {
        words_each: *words_each,
        count: *count,
        span_each: Some(Span::from_ns(*ns)),
    };
    runs.iter().map(run).collect()
}

proptest! {
    #[test]
    fn the_closed_form_agrees_with_one_word_at_a_time(
        depth in 40u32..300,
        messages in proptest::collection::vec(
            (0u64..40_000, proptest::collection::vec((1u32..40, 0u64..9_000, 1u32..25), 1..9)), 1..12)
    ) {
        let mut fifo = InputFifo::new(depth, WORD);
        let mut reference =
            ReferenceFifo { depth: depth as usize, held: VecDeque::new(), last_word_at: Time::ZERO, free_at: Time::ZERO };
        let mut begins = Time::ZERO;
        for (gap_ns, runs) in messages {
            begins = begins.max(reference.last_word_at) + Span::from_ns(gap_ns);
            let accepted = message(&mut fifo, begins, work(&runs)).accepted;
            let commands: Vec<_> =
                runs.iter().flat_map(|(words, ns, count)| vec![(*words, *ns); *count as usize]).collect();
            prop_assert_eq!(accepted, Some(reference.message(begins, &commands).0));
            prop_assert_eq!(fifo.free_at, Some(reference.free_at));
        }
    }

    #[test]
    fn a_run_takes_the_time_of_its_single_commands(count in 1u32..60, words in 1u32..40, ns in 0u64..9_000) {
        let mut runs = InputFifo::new(448, WORD);
        let mut singles = InputFifo::new(448, WORD);
        let run = CommandBatch { words_each: words, count, span_each: Some(Span::from_ns(ns)) };
        let single = CommandBatch { count: 1, ..run };
        let a = message(&mut runs, Time(7), [run]);
        let b = message(&mut singles, Time(7), vec![single; count as usize]);
        prop_assert_eq!(a, b);
    }
}

#[test]
fn words_behind_a_copy_enter_until_the_fifo_is_full() {
    let mut fifo = InputFifo::new(100, WORD);
    let copy = CommandBatch { words_each: 10, count: 1, span_each: None };
    let triangle = CommandBatch { words_each: 30, count: 1, span_each: Some(Span::from_ns(6_675)) };
    let first = message(&mut fifo, Time::ZERO, [copy]);
    assert_eq!(first, Progress { accepted: Some(Time(500_000)), blocks: Some(Time(500_000)) });
    // The copy's words left when it started, so three triangles (90 words) enter.
    let second = message(&mut fifo, Time(500_000), [CommandBatch { count: 3, ..triangle }]);
    assert_eq!(second.accepted, Some(Time(500_000 + 90 * 50_000)));
    // For twenty words of the next triangle, there is no room before the copy ends.
    assert_eq!(message(&mut fifo, Time(5_000_000), [triangle]).accepted, None);
    let resumed = fifo.resume(Time(80_000_000));
    assert_eq!(resumed.accepted, Some(Time(80_000_000 + 20 * 50_000)));
}

#[test]
fn the_rest_of_a_clump_enters_the_fifo_after_the_copy() {
    let mut fifo = InputFifo::new(100, WORD);
    let copy = CommandBatch { words_each: 10, count: 1, span_each: None };
    let clump = CommandBatch { words_each: 30, count: 5, span_each: Some(Span::from_ns(6_675)) };
    message(&mut fifo, Time::ZERO, [copy]);
    assert_eq!(message(&mut fifo, Time(500_000), [clump]).accepted, None);
    // The FIFO has room for 100 of the 150 words. When the copy ends, the first triangle makes room for 30 more
    // words. The second triangle makes room for the last 20 words, 6.675 us later.
    let resumed = fifo.resume(Time(80_000_000));
    assert_eq!(resumed.accepted, Some(Time(80_000_000 + 6_675_000 + 20 * 50_000)));
    // The controller is free after the fifth triangle.
    assert_eq!(fifo.free_at, Some(Time(80_000_000 + 5 * 6_675_000)));
}

#[test]
fn a_run_of_zero_commands_changes_no_time() {
    let run = |count, ns| CommandBatch { words_each: 29, count, span_each: Some(Span::from_ns(ns)) };
    let accepted = |runs: &[CommandBatch]| {
        let mut fifo = InputFifo::new(100, WORD);
        (message(&mut fifo, Time::ZERO, runs.to_vec()).accepted, fifo.free_at)
    };
    let [some, none] = [run(9, 6_675), run(0, 9_000)];
    assert_eq!(accepted(&[none, some, none, some]), accepted(&[some, some]));
}

#[test]
fn a_clump_of_thirty_triangles_stalls_its_sender_until_its_last_word_fits_into_the_fifo() {
    // 30 commands have 29 words and take 6.675 us each. The first command starts when its 29 words have entered
    // (1.45 us). Word k >= 448 waits for the start of the command with word k - 448. The last word (869) therefore
    // waits for the start of command floor((869 - 448) / 29) = 14 at 1.45 + 14 x 6.675 us. This start makes room
    // for 29 words. The last word is the 16th of these words (421 - 406 + 1), so it enters 16 word times after this
    // start.
    let mut fifo = InputFifo::new(448, WORD);
    let clump = CommandBatch { words_each: 29, count: 30, span_each: Some(Span::from_ns(6_675)) };
    let accepted = message(&mut fifo, Time::ZERO, [clump]).accepted;
    assert_eq!(accepted, Some(Time(1_450_000 + 14 * 6_675_000 + 16 * 50_000)));
}
