//! Plans by which a host requests updates of display memories: the whole scene in one memory, or the memories that a
//! policy selects.

use crate::pipeline::Setup;
use crate::pipelines::faces::latched_head::lights_of;
use crate::pipelines::faces::requests::{RequestedUpdate, RequestedUpdates};
use crate::pipelines::faces::segments::moves;
use address_recalculation::FaceScan;
use glam::{DMat3, DVec3, Mat3, Mat4};
use pphigs::{EyeView, FrameView, ModelFrame};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use rendering_control::cube::{FaceUpdate, FaceWarp};
use rendering_control::{HostAction, frames};
use std::collections::VecDeque;
use std::sync::Arc;

pub(super) type Plan = Box<dyn FnMut(PictureNumber, Time) -> HostAction<FaceUpdate>>;

pub(super) struct Updates {
    pub(super) setup: Setup,
    /// Scan of the display if updates are shown at the next retrace. Views are then predicted for the time at which the
    /// next field is lit.
    seen_next: Option<FaceScan>,
    pub(super) projection: Mat4,
    pub(super) notes: Arc<RequestedUpdates>,
    /// Flag of each structure of the scene: true if the structure moves by itself or with the head.
    pub(super) moving: Vec<bool>,
    sent: Vec<u64>,
    /// True if any structure is attached to the head. The position of such a structure depends on the head's direction.
    has_head_frame: bool,
}

impl Updates {
    pub(super) fn new(
        setup: &Setup,
        seen_next: Option<FaceScan>,
        notes: &Arc<RequestedUpdates>,
        projection: Mat4,
        memories: usize,
    ) -> Self {
        let has_head_frame = setup.list.structures.iter().any(|structure| structure.frame == ModelFrame::Head);
        let moving = setup.scene.structures().iter().map(moves).collect();
        let (setup, notes) = (setup.clone(), Arc::clone(notes));
        Self { setup, seen_next, projection, notes, moving, sent: vec![0; memories], has_head_frame }
    }

    pub(super) fn view(&self, number: PictureNumber, now: Time) -> FrameView {
        let (view, Setup { views, aim, .. }) = (ViewNumber::taken_for(number), &self.setup);
        match self.seen_next {
            None => views.newest(view, now),
            Some(scan) => views.view_at(view, now, aim.instant(&lights_of(&scan, scan.field_at(now).next()))),
        }
    }

    /// Returns the next update of a display memory, drawn from the eye position that is known at `now`.
    fn of_memory(&mut self, number: PictureNumber, now: Time, due: &Due) -> FaceUpdate {
        let view = due.view.clone().unwrap_or_else(|| self.view(number, now));
        // The two buffers of a memory take turns.
        let buffer = (self.sent[due.memory] + 1) % 2;
        self.sent[due.memory] += 1;
        // Later code uses this record to find the update that each swap has shown.
        self.notes.write(RequestedUpdate {
            picture: number,
            view: view.number,
            memory: due.memory,
            due_at: due.at,
            structures: Arc::clone(&due.structures),
        });
        FaceUpdate {
            number,
            memory: due.memory as u8,
            buffer: buffer as u8,
            together: due.together,
            view: self.ahead(&view),
            structures: due.structures.to_vec(),
            warp: due.warp,
        }
    }

    /// Returns a view with the same eye position as `view`, but without the rotation of the head. The axes of the
    /// returned view are the axes of the world.
    ///
    /// Structures attached to the head are drawn for the newest direction of the head. Until the next update, these
    /// structures turn with the faces.
    fn ahead(&self, view: &FrameView) -> FrameView {
        let eye = view.eyes.first();
        let place = eye.map_or(DVec3::ZERO, |eye| place(&eye.world_to_eye));
        let turned = |eye: &EyeView| Mat4::from_mat3(Mat3::from_mat4(eye.world_to_eye).transpose()) * eye.head_to_eye;
        let head_to_eye = eye.filter(|_| self.has_head_frame).map_or(Mat4::IDENTITY, turned);
        let world_to_eye = Mat4::from_translation(-place.as_vec3());
        FrameView { eyes: vec![EyeView { world_to_eye, head_to_eye, projection: self.projection }], ..view.clone() }
    }
}

/// A display memory that must be redrawn, and the content of its update.
#[derive(Clone, Debug)]
pub(super) struct Due {
    pub(super) memory: usize,
    pub(super) together: u8,
    pub(super) structures: Arc<[bool]>,
    pub(super) at: Time,
    /// View for the update. `None` selects the newest view at the time of sending.
    pub(super) view: Option<FrameView>,
    pub(super) warp: Option<FaceWarp>,
}

impl Due {
    /// Returns an update of the only display memory, which contains `structures` and is drawn from the newest view.
    pub(super) const fn newest(structures: Arc<[bool]>, at: Time) -> Self {
        Self { memory: 0, together: 0, structures, at, view: None, warp: None }
    }
}

pub(super) fn place(world_to_eye: &Mat4) -> DVec3 {
    let matrix = world_to_eye.as_dmat4();
    -(DMat3::from_mat4(matrix).transpose() * matrix.w_axis.truncate())
}

/// Returns a plan for a single display memory. Each update redraws all structures. The next update begins when the
/// previous update ends.
pub(super) fn full(mut updates: Updates, structures: Arc<[bool]>) -> Plan {
    let setup = updates.setup.clone();
    let all = move |number, now| updates.of_memory(number, now, &Due::newest(Arc::clone(&structures), now));
    Box::new(frames(move |ready| setup.frame_start(ready), all))
}

pub(super) trait DuePolicy {
    /// Returns the display memories to redraw, in the order of sending. The first memory gets the update number
    /// `number`.
    fn begin(&mut self, updates: &Updates, number: PictureNumber, now: Time) -> VecDeque<Due>;
}

/// A plan for priority rendering: in each cycle, a policy selects the display memories to redraw.
///
/// A cycle begins when all display memories of the previous cycle have been sent, but never in the field in which the
/// previous cycle began. The selected memories are sent in ascending order. On a machine that is fast enough, each
/// cycle lasts one field and begins with the field.
pub(super) struct Cycles {
    updates: Updates,
    scan: FaceScan,
    policy: Box<dyn DuePolicy>,
    pending: VecDeque<Due>,
    began: Option<PeriodNumber>,
}

impl Cycles {
    pub(super) fn plan(updates: Updates, scan: FaceScan, policy: Box<dyn DuePolicy>) -> Plan {
        let mut cycles = Self { updates, scan, policy, pending: VecDeque::new(), began: None };
        Box::new(move |number, now| cycles.next(number, now))
    }

    fn next(&mut self, number: PictureNumber, now: Time) -> HostAction<FaceUpdate> {
        if self.pending.is_empty() {
            let field = self.scan.field_at(now);
            if self.began.is_some_and(|began| began >= field) {
                return HostAction::Wait(self.scan.retrace(field.next()));
            }
            self.began = Some(field);
            self.pending = self.policy.begin(&self.updates, number, now);
        }
        match self.pending.pop_front() {
            Some(due) => HostAction::Send(self.updates.of_memory(number, now, &due)),
            None => HostAction::Wait(self.scan.retrace(self.scan.field_at(now).next())),
        }
    }
}
