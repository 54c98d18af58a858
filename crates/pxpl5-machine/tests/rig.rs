//! Test machine with two graphics processors, two renderers, a display controlled by messages, and a host line to the
//! display.

use image::RgbImage;
use pxpl5_gp::{Fault, Gp, GpTiming, Priority};
use pxpl5_machine::{Board, HostLine, Machine, MachineConfig};
use pxpl5_renderer::{CommandKind, Layout};
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Phase, Span, Time};
use pxpl5_wire::display::{Counter, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, Surface};
use pxpl5_wire::{
    Body, CommandList, CommandRun, CopyContent, CopyOrder, CopyPath, CopyTarget, Lines, NodeId, PeriodNumber,
    PictureNumber, RegionGrid, RegionId,
};
use std::cell::RefCell;
use std::rc::Rc;

/// Software cost of a message on the test machine's processors.
pub(crate) const MESSAGE: Span = Span::from_us(1);

pxpl5_sim::parameters::parameter_table! {
    /// Parameters of the test display.
    pub(crate) struct ScreenNumbers {
        /// Time between ticks.
        period_us: 100, "us", Assumed, 50..=200 in 1..=1_000_000, "made up";
    }
}

/// Configuration of a display with a number of surfaces. A display without surfaces is refused.
#[derive(Clone, Debug)]
pub(crate) struct ScreenConfig {
    pub(crate) name: &'static str,
    pub(crate) surfaces: usize,
    pub(crate) numbers: ScreenNumbers,
}

impl ScreenConfig {
    pub(crate) fn new(surfaces: usize) -> Self {
        Self { name: "screen", surfaces, numbers: ScreenNumbers::PAPERS }
    }
}

impl DisplayConfig for ScreenConfig {
    fn name(&self) -> &'static str {
        self.name
    }

    fn about(&self) -> &'static str {
        "does what messages say"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        vec![("screen", &self.numbers)]
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        vec![("screen", &mut self.numbers)]
    }

    fn check(&self) -> Result<(), SettingError> {
        if self.surfaces > 0 { Ok(()) } else { Err(SettingError::combination("a screen has a surface at least")) }
    }

    fn build(&self, nodes: &[NodeId], _word: Span) -> Result<Box<dyn Display>, SettingError> {
        self.check()?;
        let surface = Surface { label: self.name, title: self.name, width: 4, height: 2 };
        let surfaces = vec![surface; self.surfaces];
        let period = Span::from_us(self.numbers.period_us);
        Ok(Box::new(Screen { period, nodes: nodes.to_vec(), surfaces, pixels: 0 }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(self.clone())
    }
}

/// A test display. Each message to the display contains an output, which the display then emits.
#[derive(Debug)]
pub(crate) struct Screen {
    period: Span,
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    pixels: u64,
}

/// A message to the test display.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Say {
    /// Reports a region of a picture. Its first message arrived `first_us_ago` microseconds ago.
    Arrived { surface: u32, port: u32, picture: u32, first_us_ago: u32 },
    /// Reports a swap of a surface at a tick.
    Swapped { surface: u32, tick: u32 },
    /// Reports a swap of the part of a surface behind one port.
    Updated { surface: u32, port: u32, tick: u32 },
    /// Reports a region of a picture on the first surface and port, `us` microseconds from now.
    Later { us: u32, picture: u32 },
}

impl Say {
    pub(crate) fn body(self) -> Body {
        let words = match self {
            Self::Arrived { surface, port, picture, first_us_ago } => [0, surface, port, picture, first_us_ago],
            Self::Swapped { surface, tick } => [1, surface, tick, 0, 0],
            Self::Updated { surface, port, tick } => [2, surface, port, tick, 0],
            Self::Later { us, picture } => [3, us, picture, 0, 0],
        };
        Body::Words(words.into())
    }
}

impl Screen {
    fn arrived(&self, [surface, port, picture, first_us_ago]: [u32; 4], now: Time) -> DisplayOutput {
        DisplayOutput::RegionArrived {
            surface: surface as usize,
            target: target(self.nodes[port as usize], picture),
            first_part_at: Time(now.0 - Span::from_us(first_us_ago.into()).0),
            last_part_at: now,
        }
    }

    fn take(&self, words: &[u32], context: &mut DisplayContext) {
        let now = context.now();
        let tick = |number: u32| PeriodNumber(number.into());
        let output = match *words {
            [0, surface, port, picture, ago] => self.arrived([surface, port, picture, ago], now),
            [1, surface, number, ..] => {
                DisplayOutput::Swapped { surface: surface as usize, buffer: 1, tick: tick(number) }
            }
            [2, surface, port, number, _] => {
                let port = self.nodes[port as usize];
                DisplayOutput::Updated { surface: surface as usize, port, buffer: 1, tick: tick(number) }
            }
            [3, us, picture, ..] => {
                let event = DisplayEvent::Timer(picture.into());
                return context.schedule(now + Span::from_us(us.into()), Phase::Work, event);
            }
            _ => return,
        };
        context.output(now, output);
    }
}

impl Display for Screen {
    fn name(&self) -> &'static str {
        "screen"
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        Time::ZERO + self.period * period.0
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        PeriodNumber(time.0 / self.period.0)
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        match event {
            DisplayEvent::Delivered { body: Body::Words(words), .. } => self.take(&words, context),
            DisplayEvent::Delivered { .. } => self.pixels += 1,
            DisplayEvent::Timer(picture) => {
                let now = context.now();
                context.output(now, self.arrived([0, 0, picture as u32, 0], now));
            }
            DisplayEvent::Tick(_) => {}
        }
    }

    fn lights(&self, _: usize, _: u32, _: u32, _: PeriodNumber) -> Option<Time> {
        None
    }

    fn shown(&self, _: usize) -> Option<RgbImage> {
        None
    }

    fn seen(&self, _: usize, _: PeriodNumber) -> Option<RgbImage> {
        None
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        None
    }

    fn counters(&self) -> Vec<Counter> {
        vec![Counter { name: "messages of pixels", count: self.pixels }]
    }

    fn faults(&self) -> (u64, Option<String>) {
        (0, None)
    }
}

/// Returns the only region of a picture of 128 x 128 pixels, which takes sixteen messages.
pub(crate) fn target(frame_buffer: NodeId, picture: u32) -> CopyTarget {
    CopyTarget {
        frame_buffer,
        buffer: 0,
        lines: Lines::Frame,
        grid: RegionGrid { width: 128, height: 128, region_width: 128, region_height: 128 },
        region: RegionId(0),
        picture: PictureNumber(picture.into()),
    }
}

/// Returns the length in words and the list of a command that copies a region.
pub(crate) fn copy_command(way: CopyPath, target: CopyTarget) -> (u32, Body) {
    let words = CommandKind::CopyRegion.words();
    let order = CopyOrder { target, context: 0, way, content: CopyContent::Colour, acknowledge: None };
    let run = CommandRun { opcode: CommandKind::CopyRegion as u8, words_each: words, count: 1 };
    (words, Body::Commands(CommandList { runs: vec![run], context: 0, copies: vec![order], content: None }))
}

/// A host line that delivers given messages at given instants, in the order of time.
#[derive(Debug)]
pub(crate) struct Script(pub(crate) Vec<(Time, Body)>);

impl HostLine for Script {
    fn next(&self, after: Time) -> Option<Time> {
        self.0.iter().map(|(time, _)| *time).find(|time| *time > after)
    }

    fn messages(&mut self, now: Time) -> Vec<(usize, Body)> {
        self.0.iter().filter(|(time, _)| *time == now).map(|(_, body)| (0, body.clone())).collect()
    }
}

pub(crate) fn us(us: u64) -> Time {
    Time::ZERO + Span::from_us(us)
}

/// Returns a configuration with the ports: host 0, graphics processors 1 and 2, renderers 3 and 4, then displays.
pub(crate) fn config(displays: Vec<Box<dyn DisplayConfig>>) -> MachineConfig {
    let papers = MachineConfig::small_hmd();
    let gp = GpTiming { message_ns: MESSAGE.0 / 1_000, ..papers.gp };
    MachineConfig { n_gps: 2, n_renderers: 2, gp, displays, ..papers }
}

pub(crate) const FIRST_GP: NodeId = NodeId(1);
pub(crate) const SECOND_GP: NodeId = NodeId(2);
pub(crate) const RENDERERS: [NodeId; 2] = [NodeId(3), NodeId(4)];
pub(crate) const SCREEN: NodeId = NodeId(5);

/// Builds a machine for one picture at a time, not switched on.
pub(crate) fn build(config: &MachineConfig) -> Machine {
    Machine::new(config, 1, Layout::slats()).expect("it is a valid machine")
}

/// Builds a machine with a display of one surface.
pub(crate) fn machine() -> Machine {
    build(&config(vec![Box::new(ScreenConfig::new(1))]))
}

/// Loads a program in the foreground of a board.
pub(crate) fn load<F>(machine: &mut Machine, node: NodeId, program: impl FnOnce(Gp) -> F)
where
    F: Future<Output = Result<(), Fault>> + 'static,
{
    let gp = machine.processor(node, Priority::Foreground);
    machine.load(node, Priority::Foreground, Box::pin(program(gp)));
}

/// Loads a program that sends messages one after the other and then waits forever.
pub(crate) fn load_sender(machine: &mut Machine, node: NodeId, messages: Vec<(NodeId, u32, Body)>) {
    load(machine, node, |gp| async move {
        for (destination, words, body) in messages {
            gp.send(destination, words, body).await;
        }
        gp.until("nothing", || None).await
    });
}

/// Sends messages to the display at given instants over a host line.
pub(crate) fn say(machine: &mut Machine, script: &[(u64, Say)]) {
    let script = script.iter().map(|(at, say)| (us(*at), say.body())).collect();
    machine.plug_host_line(Box::new(Script(script)));
}

pub(crate) fn words(words: &[u32]) -> Body {
    Body::Words(words.into())
}

/// Returns all events up to an instant, except polls of programs: time, board and description.
pub(crate) fn happenings(machine: &mut Machine, until: Time) -> Vec<(Time, Board, &'static str)> {
    let mut all = Vec::new();
    loop {
        let next = machine.next_event_description();
        let Some(time) = machine.step_before(until).expect("it goes on") else { return all };
        let next = next.expect("something happened");
        assert_eq!(next.time, time, "the predicted event is the next event");
        all.push((next.time, next.board, next.what));
    }
}

/// A list in which programs record what they observe.
pub(crate) type Notes<T> = Rc<RefCell<Vec<T>>>;

/// Pixels of a region, with a count of their reads.
#[derive(Debug, Default)]
pub(crate) struct Counted {
    pub(crate) asked: std::sync::atomic::AtomicU64,
}

impl pxpl5_wire::PixelSource for Counted {
    fn pixels(&self) -> std::sync::Arc<[u32]> {
        self.asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        vec![0; 128 * 128].into()
    }
}
