//! What a host asks for next: all of the scene in one memory, or what a policy finds due.

use crate::face_notes::{FaceNote, FaceNotes};
use crate::pipeline::Setup;
use address_recalculation::Scan;
use cube_control::{FaceUpdate, Planned};
use glam::{DMat3, DVec3, Mat4};
use pphigs::{DisplayList, DisplayStructure, EyeView, FrameView};
use priority_rendering::{Objects, PriorityTiming, SeenObject, Threshold};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber, ViewNumber};
use std::collections::VecDeque;
use std::sync::Arc;

/// What all plans have in common: views, starts, and where updates are noted.
pub(super) struct Updates {
    pub(super) setup: Setup,
    pub(super) projection: Mat4,
    pub(super) notes: FaceNotes,
    /// Updates of each memory so far.
    sent: Vec<u64>,
}

impl Updates {
    pub(super) fn new(setup: &Setup, projection: Mat4, memories: usize) -> Self {
        Self { setup: setup.clone(), projection, notes: setup.notes.clone(), sent: vec![0; memories] }
    }

    /// The next update of a memory, from where the eye is known to be now.
    fn of_memory(&mut self, number: PictureNumber, now: Time, due: &Due) -> FaceUpdate {
        let view = (self.setup.views)(ViewNumber::taken_for(number), now);
        let buffer = (self.sent[due.memory] + 1) % 2;
        self.sent[due.memory] += 1;
        self.notes.write(FaceNote {
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
            view: ahead(&view, self.projection),
            structures: due.structures.to_vec(),
        }
    }
}

/// A memory that is to be drawn.
#[derive(Clone, Debug)]
struct Due {
    memory: usize,
    together: u8,
    structures: Arc<[bool]>,
    at: Time,
}

/// The view of an eye in the same place that is not turned: world axes are its own.
fn ahead(view: &FrameView, projection: Mat4) -> FrameView {
    let place = view.eyes.first().map_or(DVec3::ZERO, |eye| place(&eye.world_to_eye));
    let eye =
        EyeView { world_to_eye: Mat4::from_translation(-place.as_vec3()), head_to_eye: Mat4::IDENTITY, projection };
    FrameView { eyes: vec![eye], ..view.clone() }
}

/// Where an eye is whose matrix turns and moves the world.
fn place(world_to_eye: &Mat4) -> DVec3 {
    let matrix = world_to_eye.as_dmat4();
    -(DMat3::from_mat4(matrix).transpose() * matrix.w_axis.truncate())
}

/// One memory, all of it drawn in every update, one after the other.
pub(super) struct Full {
    updates: Updates,
    structures: Arc<[bool]>,
}

impl Full {
    pub(super) fn new(updates: Updates) -> Self {
        let structures = vec![true; updates.setup.list.structures.len()].into();
        Self { updates, structures }
    }

    pub(super) fn next(&mut self, number: PictureNumber, now: Time) -> Planned {
        match (self.updates.setup.starts)(now) {
            None => Planned::Nothing,
            Some(start) if start > now => Planned::Wait(start),
            Some(_) => {
                let due = Due { memory: 0, together: 0, structures: Arc::clone(&self.structures), at: now };
                Planned::Send(self.updates.of_memory(number, now, &due))
            }
        }
    }
}

/// Priority rendering by objects: a structure is in the slowest memory in which its image stays right.
///
/// A cycle begins when every memory that the cycle before found due has been sent, but not in the field in which that one began; the
/// memories that are due then are sent in rising order. With a machine that is fast enough a cycle is a field, and begins with it.
pub(super) struct ByObjects {
    updates: Updates,
    scan: Scan,
    policy: Objects,
    threshold: Threshold,
    spheres: Vec<ObjectSphere>,
    pending: VecDeque<Due>,
    cycle: u64,
    /// The field at whose begin the last cycle began, and where the eye was.
    began: Option<(PeriodNumber, DVec3)>,
}

/// A sphere around a structure that does not move.
#[derive(Clone, Copy, Debug)]
struct ObjectSphere {
    centre: DVec3,
    radius_m: f64,
}

/// The sphere around the middle of a structure's box that holds all of it.
fn sphere_around(list: &DisplayList, structure: &DisplayStructure) -> ObjectSphere {
    let corners = list.triangles[structure.triangles.clone()].iter().flatten();
    let points = corners.map(|corner| (list.positions[*corner as usize].as_dvec3(), 0.0));
    let spheres = list.spheres[structure.spheres.clone()].iter();
    let all: Vec<(DVec3, f64)> =
        points.chain(spheres.map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius)))).collect();
    let low = all.iter().fold(DVec3::INFINITY, |low, (at, radius)| low.min(*at - DVec3::splat(*radius)));
    let high = all.iter().fold(DVec3::NEG_INFINITY, |high, (at, radius)| high.max(*at + DVec3::splat(*radius)));
    if all.is_empty() {
        return ObjectSphere { centre: DVec3::ZERO, radius_m: 0.0 };
    }
    let centre = (low + high) / 2.0;
    let radius_m = all.iter().map(|(at, radius)| centre.distance(*at) + radius).fold(0.0, f64::max);
    ObjectSphere { centre, radius_m }
}

impl ByObjects {
    pub(super) fn new(updates: Updates, scan: Scan, timing: &PriorityTiming) -> Self {
        let list = &updates.setup.list;
        let spheres: Vec<ObjectSphere> =
            list.structures.iter().map(|structure| sphere_around(list, structure)).collect();
        Self {
            policy: Objects::new(timing, spheres.len()),
            threshold: Threshold::of_degrees(timing.theta_deg),
            spheres,
            updates,
            scan,
            pending: VecDeque::new(),
            cycle: 0,
            began: None,
        }
    }

    pub(super) fn next(&mut self, number: PictureNumber, now: Time) -> Planned {
        if let Some(due) = self.pending.pop_front() {
            return Planned::Send(self.updates.of_memory(number, now, &due));
        }
        let field = self.scan.field_at(now);
        let next = self.scan.retrace(field.next());
        if self.began.is_some_and(|(began, _)| began >= field) {
            return Planned::Wait(next);
        }
        self.begin_cycle(field, now);
        self.pending
            .pop_front()
            .map_or(Planned::Wait(next), |due| Planned::Send(self.updates.of_memory(number, now, &due)))
    }

    /// Asks the policy what is due.
    fn begin_cycle(&mut self, field: PeriodNumber, now: Time) {
        let known = (self.updates.setup.poses)(now, now);
        let eye = known.position;
        // Without a cycle before there is no speed yet.
        let speed = self.began.map_or(0.0, |(before, from)| {
            let seconds = self.scan.retrace(field).since(self.scan.retrace(before)).as_ms() * 1e-3;
            eye.distance(from) / seconds
        });
        let periods: Vec<f64> = (0..self.spheres.len()).map(|i| self.period_s(i, eye, speed)).collect();
        let update = self.policy.frame(self.cycle, &periods);
        self.cycle += 1;
        self.began = Some((field, eye));
        for memory in update.memories() {
            let structures = (0..self.spheres.len()).map(|i| self.policy.memory(i) == Some(memory)).collect();
            let together = if update.together[memory] { update.together_bits() } else { 0 };
            self.pending.push_back(Due { memory, together, structures, at: now });
        }
    }

    /// For how long the image of a structure is right; one that moves by itself is never.
    fn period_s(&self, structure: usize, eye: DVec3, speed: f64) -> f64 {
        let ObjectSphere { centre, radius_m } = self.spheres[structure];
        let moves = self.updates.setup.moving.get(structure) == Some(&true);
        let animation_s = if moves { 0.0 } else { f64::INFINITY };
        let seen = SeenObject { distance_m: eye.distance(centre), radius_m, speed, turn: 0.0, animation_s };
        self.threshold.period(&seen).least()
    }
}
