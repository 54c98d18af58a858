//! A test bench of one board with programs of this firmware.

use crate::config::{Beam, DrawingSchedule, JitpConfig};
use crate::protocol::DrawingOrder;
use crate::timing::JitpTiming;
use glam::{Mat4, Vec3};
use pphigs::{DisplayList, DisplayStructure, EyeView, FrameView, ModelFrame};
use pxpl5_geometry::Culling;
use pxpl5_gp::{BoardBench, Firmware, Gp, GpBoard, GpEvent, GpTiming, Priority, Received};
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::Aim;
use pxpl5_wire::{Message, NodeId, PeriodNumber, ViewNumber};
use std::sync::Arc;

pub(crate) const MASTER: NodeId = NodeId(1);
pub(crate) const SLAVE: NodeId = NodeId(2);
pub(crate) const RENDERER: NodeId = NodeId(3);
pub(crate) const FIELD_US: u64 = 20_000;
pub(crate) const ROW_US: u64 = 50;
/// Time from the cause of an output signal until the signal leaves the board, in picoseconds.
pub(crate) const CYCLE: Span = Span(25_000);

pub(crate) const fn us(us: u64) -> Time {
    Time(us * 1_000_000)
}

/// Returns a configuration of a master, a slave and a renderer. The beam takes 20 ms for a field and 50 us for a row.
pub(crate) fn config(schedule: DrawingSchedule) -> JitpConfig {
    let retrace = |field: PeriodNumber| us(field.0 * FIELD_US);
    JitpConfig {
        host: NodeId(0),
        master: MASTER,
        slaves: vec![SLAVE],
        renderers: vec![RENDERER],
        frame_buffer: NodeId(4),
        schedule,
        beam: Beam::new(move |field, row, _| retrace(field) + Span::from_us(u64::from(row) * ROW_US), retrace),
        aim: Aim::default(),
        layout: Layout::slats(),
        pixels: false,
        timing: JitpTiming::PAPERS,
    }
}

/// Returns a display list of triangles in the middle of the picture.
pub(crate) fn list(triangles: usize) -> Arc<DisplayList> {
    let structure =
        DisplayStructure { triangles: 0..triangles, spheres: 0..0, frame: ModelFrame::World, culling: Culling::None };
    Arc::new(DisplayList {
        positions: vec![Vec3::new(-0.1, -0.1, -2.0), Vec3::new(0.1, -0.1, -2.0), Vec3::new(0.0, 0.1, -2.0)],
        normals: vec![Vec3::Z; 3],
        colours: vec![[200; 3]; 3],
        triangles: vec![[0, 1, 2]; triangles],
        structures: vec![structure],
        towards_light: Vec3::Z,
        ..DisplayList::default()
    })
}

pub(crate) fn view(number: u64) -> FrameView {
    let projection = Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.1, 100.0);
    let eye = EyeView { world_to_eye: Mat4::IDENTITY, head_to_eye: Mat4::IDENTITY, projection };
    FrameView { number: ViewNumber(number), eyes: vec![eye], edits: Vec::new() }
}

/// A board whose messages are accepted a microsecond after they are sent.
pub(crate) struct Rig {
    pub(crate) bench: BoardBench,
    pub(crate) us: u64,
}

impl Rig {
    pub(crate) fn new(
        node: NodeId,
        prepare: impl FnOnce(&mut GpBoard),
        programs: impl FnOnce(&Gp) -> Vec<(Priority, Firmware)>,
    ) -> Self {
        let mut board = GpBoard::new(node, GpTiming::PAPERS, CYCLE);
        prepare(&mut board);
        let gp = board.handle_for(Priority::Foreground);
        programs(&gp).into_iter().for_each(|(level, program)| board.load(level, program));
        Self { bench: BoardBench::new(board), us: 0 }
    }

    pub(crate) fn deliver(&mut self, order: &DrawingOrder) {
        let (words, body) = order.message();
        let message = Message { source: MASTER, destination: SLAVE, words, body };
        self.bench.feed(us(self.us), GpEvent::Delivered(message));
    }

    pub(crate) fn run_to(&mut self, until_us: u64) {
        while self.us < until_us {
            self.us += 1;
            let now = us(self.us);
            if self.us.is_multiple_of(FIELD_US) {
                self.bench.feed(now, GpEvent::Retrace(PeriodNumber(self.us / FIELD_US)));
            }
            self.bench.accept_all(now);
            self.bench.run_until(now);
        }
        assert_eq!(self.bench.board.fault(), None);
    }

    /// Returns the messages to the board `node`, each with the time at which it was sent.
    pub(crate) fn sent_to(&self, node: NodeId) -> Vec<(Time, Received)> {
        let to_node = self.bench.sent().filter(|(_, message)| message.destination == node);
        to_node.map(|(time, m)| (time, Received { arrived: time, source: m.source, body: m.body.clone() })).collect()
    }
}
