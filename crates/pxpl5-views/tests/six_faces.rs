//! Test of a display with more surfaces than ports. The display has six faces of a cube and shows them in turn from one
//! board.

use image::RgbImage;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Outcome, Pixels, RenderingControl};
use pxpl5_scene::builtin;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Span, Time};
use pxpl5_views::timeline::{Timeline, TimelineOptions, svg};
use pxpl5_views::trace_export::Trace;
use pxpl5_wire::display::{
    BufferReceipt, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, DoubleBuffer, Surface,
};
use pxpl5_wire::{NodeId, PeriodNumber, SurfaceId};

/// Labels and titles of the six faces.
const FACES: [(&str, &str); 6] = [
    ("front", "front face"),
    ("right", "right face"),
    ("back", "back face"),
    ("left", "left face"),
    ("up", "upper face"),
    ("down", "lower face"),
];

/// A display in which each picture is for the next face. A period takes a hundredth of a second.
#[derive(Debug)]
struct Cube {
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    board: DoubleBuffer,
}

const PERIOD: Span = Span(10_000_000_000);

impl Display for Cube {
    fn name(&self) -> &'static str {
        "cube"
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        Time::ZERO + PERIOD * period.0
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        PeriodNumber(time.0 / PERIOD.0)
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        let at = context.now() + Span::from_ns(50);
        match event {
            DisplayEvent::Tick(tick) => {
                if let Some(buffer) = self.board.swap(context.now()) {
                    context.output(at, DisplayOutput::Swapped { surface: 0, buffer, tick });
                }
            }
            DisplayEvent::Delivered { body, .. } => {
                if let BufferReceipt::Region(pixels, first_part_at) = self.board.receive(body, context.now()) {
                    let target = pixels.target;
                    let surface = (target.picture.0 % 6) as usize;
                    let last_part_at = context.now();
                    let arrived = DisplayOutput::RegionArrived { surface, target, first_part_at, last_part_at };
                    context.output(at, arrived);
                }
            }
            DisplayEvent::Timer(_) => {}
        }
    }

    fn lights(&self, _: usize, _: u32, _: u32, period: PeriodNumber) -> Option<Time> {
        Some(self.tick(period))
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

    fn counters(&self) -> Vec<pxpl5_wire::display::Counter> {
        Vec::new()
    }

    fn faults(&self) -> (u64, Option<String>) {
        (0, None)
    }
}

#[derive(Debug)]
struct CubeConfig;

impl DisplayConfig for CubeConfig {
    fn name(&self) -> &'static str {
        "cube"
    }

    fn about(&self) -> &'static str {
        "six faces of a cube"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        Vec::new()
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        Vec::new()
    }

    fn ports(&self, _: usize) -> usize {
        1
    }

    fn check(&self) -> Result<(), SettingError> {
        Ok(())
    }

    fn build(&self, nodes: &[NodeId], _word: Span) -> Result<Box<dyn Display>, SettingError> {
        let surfaces = FACES.map(|(label, title)| Surface { label, title, width: 256, height: 256 }).to_vec();
        Ok(Box::new(Cube { nodes: nodes.to_vec(), surfaces, board: DoubleBuffer::new(256, 256) }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(Self)
    }
}

fn outcome() -> Outcome {
    let config = MachineConfig { displays: vec![Box::new(CubeConfig)], ..MachineConfig::small_hmd() };
    let scene = builtin("full-screen:1").expect("built in");
    let experiment = Experiment::new(config, RenderingControl::mono(), scene).fields(60);
    experiment.pixels(Pixels::Off).record_traffic(true).run().expect("runs")
}

#[test]
fn a_timeline_has_a_row_for_each_face_and_hatches_all_but_the_first() {
    let outcome = outcome();
    let options = TimelineOptions { fields: Some(16), ..TimelineOptions::default() };
    let timeline = Timeline::of(&outcome, &options);
    let faces = timeline.rows.iter().filter(|row| FACES.iter().any(|(_, title)| *title == row.name));
    let mut copied = 0;
    for (face, row) in (0..).zip(faces) {
        assert!(
            row.bars.iter().all(|bar| bar.surface == Some(SurfaceId(face)) && bar.picture.0 % 6 == u64::from(face))
        );
        copied += row.bars.len();
    }
    assert!(copied > 2, "{copied}");
    let drawing = svg(&outcome, &options);
    roxmltree::Document::parse(&drawing).expect("XML");
    assert!(drawing.contains(">front</text>") && drawing.contains(">other surfaces</text>"));
    assert!(drawing.contains("copy-right") && drawing.contains("CB of "), "the back face's copies");
}

#[test]
fn a_trace_has_groups_for_the_port_and_for_each_face() {
    let trace = Trace::of(&outcome());
    assert_eq!(tracks(&trace, "cube port 0"), ["messages in"]);
    for (_, title) in FACES {
        assert!(tracks(&trace, title).contains(&"COPY"), "{title}");
    }
    assert_eq!(tracks(&trace, "video"), ["retraces", "displayed"]);
}

fn tracks<'a>(trace: &'a Trace, group: &str) -> Vec<&'a str> {
    let tracks = trace.tracks.iter().filter(|track| trace.groups[track.group] == group);
    tracks.map(|track| track.name.as_str()).collect()
}
