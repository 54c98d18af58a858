//! Tests that a run in pieces equals an uninterrupted run. Neither the division into pieces nor the reading of state
//! changes the trace or a picture.

use crate::support::{self, outcome};
use pxpl5::Board;
use pxpl5::{
    DisplayEntry, Experiment, ExperimentFile, MachineConfig, Measured, Outcome, PeriodNumber, PipelineEntry, Slats,
    Span, SurfaceId, Time, registry, scene,
};
use pxpl5::{Pause, Stepper};
use pxpl5_renderer::PixelArray;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Returns an experiment from settings, or `None` if the pipeline does not run on the display.
fn experiment(settings: &[&str]) -> Option<Experiment> {
    let mut file = ExperimentFile::new();
    settings.iter().for_each(|setting| file.set_text(setting, "test").expect("known"));
    let plan = file.resolve().ok()?;
    let experiment = plan.experiment(plan.load_scene().expect("built in")).record_traffic(true);
    experiment.build().is_ok().then_some(experiment)
}

/// A generator of random numbers (xorshift).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % n
    }
}

/// Advances the run by a random kind of step.
fn step(stepper: &mut Stepper, dice: &mut Dice) {
    match dice.below(6) {
        0 => stepper.run_to(stepper.now() + Span::from_us(dice.below(5_000))),
        1 => (0..dice.below(200)).map(|_| stepper.step_event()).last().unwrap_or(Pause::Reached),
        2 => stepper.step_line(),
        3 => stepper.step_period(),
        4 => {
            let boards = [Board::Host, Board::Gp(0), Board::Gp(1), Board::Renderer(0), Board::Display(0), Board::Ring];
            stepper.step_board(boards[dice.below(6) as usize])
        }
        _ => {
            let channels = dice.below(4) as usize;
            stepper.run_until(stepper.end(), |stepper, _| stepper.channels().len() > channels)
        }
    };
}

/// Reads the state of all boards, and sometimes pictures and pixel memory.
fn read_snapshots(stepper: &Stepper, dice: &mut Dice) {
    let processors = (0..60).map(Board::Gp).chain([Board::Host]).filter_map(|board| stepper.processor(board));
    assert!(processors.count() > 1);
    let renderers = stepper.record().renderers().len();
    for renderer in (0..renderers).filter_map(|number| stepper.renderer(number)) {
        assert!(renderer.fifo_words.is_some_and(|words| words <= renderer.fifo_depth_words), "{renderer:?}");
    }
    let most = stepper.record().config().ring.channels as usize;
    assert!(stepper.channels().len() <= most);
    let _ = (stepper.machine().blocked(), stepper.record().trace_hash(), stepper.record().stages());
    if dice.below(12) == 0 {
        let _ = stepper.array(dice.below(renderers as u64) as usize);
        let _ = stepper.seen(SurfaceId(0));
        let _ = stepper.ideal_picture(SurfaceId(0));
    }
}

fn in_pieces(experiment: &Experiment, seed: u64) -> Outcome {
    let mut dice = Dice(seed);
    let mut stepper = experiment.stepper().expect("it can be built");
    while stepper.now() < stepper.end() {
        step(&mut stepper, &mut dice);
        read_snapshots(&stepper, &mut dice);
    }
    outcome(stepper.finish(), "stepped")
}

fn assert_same(whole: &Outcome, pieces: &Outcome, name: &str) {
    assert_eq!(whole.record().trace_hash(), pieces.record().trace_hash(), "{name}");
    assert_eq!(whole.pictures(), pieces.pictures(), "{name}");
    assert_eq!(whole.record().events(), pieces.record().events(), "{name}");
    for (surface, _) in whole.record().surfaces() {
        assert!(whole.picture(surface) == pieces.picture(surface), "{name}: {surface:?}");
    }
}

/// Runs every pair in one of three random divisions into pieces. `PXPL5_ALL_CASES=1` runs every pair in all three.
#[test]
fn a_stepped_run_equals_an_uninterrupted_run_for_every_pipeline_on_every_display() {
    let registry = registry();
    let pairs: Vec<_> = registry
        .pipelines()
        .iter()
        .flat_map(|pipeline| registry.displays().iter().map(move |display| (pipeline, display)))
        .collect();
    let check = |(number, (pipeline, display)): (usize, &(&PipelineEntry, &DisplayEntry))| {
        let pipeline = format!("pipeline={}", pipeline.name);
        let display = format!("display={}", display.name);
        let settings = [pipeline.as_str(), display.as_str(), "scene=full-screen:2", "fields=7"];
        let experiment = experiment(&settings)?;
        let whole = outcome(experiment.run(), "stepped");
        let plain = outcome(experiment.clone().record_traffic(false).run(), "stepped");
        assert_eq!(plain.record().trace_hash(), whole.record().trace_hash(), "{settings:?}");
        assert_eq!(plain.pictures(), whole.pictures(), "{settings:?}");
        assert!(plain.record().events() <= whole.record().events(), "{settings:?}");
        let is_run = |seed: &u64| *seed == 1 + number as u64 % 3 || support::runs_all_cases();
        (1..4)
            .filter(is_run)
            .for_each(|seed| assert_same(&whole, &in_pieces(&experiment, seed), &format!("{settings:?}, {seed}")));
        Some([pipeline, display])
    };
    let ran: BTreeSet<String> = pairs.par_iter().enumerate().filter_map(check).flatten_iter().collect();
    let all = registry.pipelines().len() + registry.displays().len();
    assert_eq!(ran.len(), all, "each was run at least once: {ran:?}");
}

#[test]
fn a_stepped_run_equals_an_uninterrupted_run_for_a_tracked_head_with_prediction() {
    let settings = ["pipeline=slats", "scene=full-screen:2", "fields=7", "head.motion=synthetic:3"];
    let experiment = experiment(&settings).expect("it can be built");
    assert_same(&outcome(experiment.run(), "stepped"), &in_pieces(&experiment, 9), "head");
}

fn slats() -> Experiment {
    let mig = scene::builtin("mig").expect("built in");
    let mut machine = MachineConfig::slats();
    machine.displays.iter_mut().for_each(|display| display.remember(8));
    Experiment::new(machine, Slats::whole(), mig).fields(6).record_traffic(true)
}

#[test]
fn a_line_step_ends_when_the_next_line_begins_to_light() {
    let mut stepper = slats().stepper().expect("it can be built");
    stepper.run_to(stepper.record().tick(PeriodNumber(3)));
    // Odd fields scan the odd lines.
    for line in [1, 3, 5] {
        assert_eq!(stepper.step_line(), Pause::Reached);
        assert_eq!(Some(stepper.now()), stepper.record().display().lights(0, 0, line, PeriodNumber(3)));
    }
    let last = stepper.record().display().lights(0, 0, 479, PeriodNumber(3)).expect("an odd line");
    stepper.run_to(last);
    stepper.step_line();
    assert_eq!(stepper.now(), stepper.record().tick(PeriodNumber(4)));
}

#[test]
fn a_stepped_event_has_its_own_time_and_the_name_of_its_board() {
    let mut stepper = slats().stepper().expect("it can be built");
    assert_eq!(stepper.step_board(Board::Renderer(3)), Pause::Reached);
    let last = stepper.last().expect("an event");
    assert_eq!((last.board, last.time), (Board::Renderer(3), stepper.now()));
    assert!(stepper.now() > Time::ZERO);
    let next = stepper.machine().next_event_description().expect("the machine is at work");
    stepper.step_event();
    assert_eq!(stepper.last(), Some(next));
}

/// The picture at an instant has all pixels that the beam has drawn by then, and none that it draws later.
#[test]
fn partial_pictures_equal_those_of_the_whole_run() {
    let whole = outcome(slats().run(), "stepped");
    let mut stepper = slats().stepper().expect("it can be built");
    let mut lit = 0;
    for us in (30_000..82_000).step_by(6_131) {
        let at = Time::ZERO + Span::from_us(us);
        stepper.run_to(at);
        for surface in 0..2 {
            let seen = stepper.seen(SurfaceId(surface)).expect("an eye");
            let expected = whole.record().display().seen_at(usize::from(surface), at).expect("it is remembered");
            assert!(seen == expected, "{surface} at {us} us");
            lit += seen.pixels().filter(|pixel| pixel.0 != seen.get_pixel(0, 0).0).count();
        }
    }
    assert!(lit > 1_000, "{lit} pixels of the aircraft");
}

/// The levels of a FIFO are compared with the record of traffic, whose sums cover the whole run.
#[test]
fn the_contents_of_a_fifo_agree_with_the_record_of_traffic() {
    let whole = outcome(slats().run(), "stepped");
    let traffic = whole.record().observation().traffic.as_deref().expect("it was recorded");
    let courses: Vec<_> = (0..4).map(|renderer| traffic.fifo_words(renderer)).collect();
    let mut stepper = slats().stepper().expect("it can be built");
    let mut most = 0;
    for step in 0..400 {
        stepper.run_to(Time::ZERO + Span::from_us(40_000 + step * 37));
        for (renderer, course) in courses.iter().enumerate() {
            let expected = course.iter().take_while(|change| change.0 <= stepper.now()).last().map_or(0, |last| last.1);
            let found =
                stepper.renderer(renderer).and_then(|snapshot| snapshot.fifo_words).expect("traffic is recorded");
            assert_eq!(i64::from(found), expected, "renderer {renderer} at {}", stepper.now());
            most = most.max(found);
        }
    }
    assert!(most > 30, "a triangle has waited: {most}");
}

#[test]
fn the_array_shows_all_sent_commands_when_the_last_command_has_started() {
    let mut stepper = slats().stepper().expect("it can be built");
    stepper.run_to(stepper.record().tick(PeriodNumber(4)));
    let started = |stepper: &Stepper, at: Time| stepper.record().renderers()[0].snapshot(at).fifo_words == Some(0);
    let end = stepper.end();
    let pause = stepper.run_until(end, |stepper, _| {
        stepper.renderer(0).is_some_and(|snapshot| snapshot.stands_at_copy) && started(stepper, stepper.now())
    });
    assert_eq!(pause, Pause::Reached);
    let sent = stepper.record().renderers()[0].pixel_memory().expect("pixels are wanted");
    let executed = stepper.array(0).expect("commands have started");
    assert!((0..208).all(|bit| sent.plane(bit) == executed.plane(bit)));
    assert!((0..208).any(|bit| executed.plane(bit).iter().any(|word| *word != 0)));
}

#[test]
fn breakpoints_show_registers_and_change_no_trace() {
    let settings = ["pipeline=slats", "scene=mig", "triangles=12", "fields=6", "level=cycle", "pixels=off"];
    let experiment = experiment(&settings).expect("it can be built");
    let whole = outcome(experiment.run(), "stepped");
    let mut stepper = experiment.stepper().expect("it can be built");
    let kernel = |stepper: &Stepper, gp: usize| {
        let board = stepper.machine().board(Board::Gp(gp))?;
        board.with_processor(|processor| processor.programs().find_map(|program| program.symbol("start")))?
    };
    stepper.run_until(stepper.end(), |stepper, _| (0..8).any(|gp| kernel(stepper, gp).is_some()));
    let address = (0..8).find_map(|gp| kernel(&stepper, gp)).expect("a kernel has run");
    stepper.break_at(BTreeSet::from([address]));
    let mut met = 0;
    while let Pause::Breakpoints(hits) = stepper.run_to(stepper.end()) {
        assert!(hits.iter().all(|hit| hit.address == address && hit.state.pc == address), "{hits:?}");
        assert_eq!(hits[0].into_call, Span::ZERO, "the entry comes first");
        met += hits.len();
    }
    assert!(met > 10, "{met}");
    assert_eq!(outcome(stepper.finish(), "stepped").record().trace_hash(), whole.record().trace_hash());
}

#[test]
fn a_stepper_stops_at_the_end_and_reports_it() {
    let mut stepper = slats().stepper().expect("it can be built");
    assert_eq!(stepper.run_to(stepper.end() + Span(1)), Pause::End);
    assert_eq!(stepper.now(), stepper.end());
    assert_eq!(stepper.step_event(), Pause::End);
    assert_eq!(stepper.run_to(Time::ZERO), Pause::Reached);
    assert_eq!(stepper.now(), stepper.end(), "time does not go back");
}
