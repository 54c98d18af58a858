use super::plan::{Due, DuePolicy, Updates};
use address_recalculation::FaceScan;
use address_recalculation::priority::{ObjectView, Objects, PriorityTiming, Threshold};
use glam::DVec3;
use pphigs::{DisplayList, DisplayStructure};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, PictureNumber};
use std::collections::VecDeque;

/// Priority rendering by objects: assigns each structure to the slowest (least often updated) display memory in which
/// its image stays correct.
pub(super) struct ByObjects {
    scan: FaceScan,
    policy: Objects,
    threshold: Threshold,
    spheres: Vec<ObjectSphere>,
    cycle: u64,
    began: Option<(PeriodNumber, DVec3)>,
}

#[derive(Clone, Copy, Debug)]
struct ObjectSphere {
    centre: DVec3,
    radius_m: f64,
}

fn sphere_around(list: &DisplayList, structure: &DisplayStructure) -> ObjectSphere {
    let corners = list.triangles[structure.triangles.clone()].iter().flatten();
    let points = corners.map(|corner| (list.positions[*corner as usize].as_dvec3(), 0.0));
    let spheres = list.spheres[structure.spheres.clone()].iter();
    let all: Vec<(DVec3, f64)> =
        points.chain(spheres.map(|sphere| (sphere.centre.as_dvec3(), f64::from(sphere.radius)))).collect();
    // The bounding box covers vertices and spheres.
    let low = all.iter().fold(DVec3::INFINITY, |low, (at, radius)| low.min(*at - DVec3::splat(*radius)));
    let high = all.iter().fold(DVec3::NEG_INFINITY, |high, (at, radius)| high.max(*at + DVec3::splat(*radius)));
    if all.is_empty() {
        return ObjectSphere { centre: DVec3::ZERO, radius_m: 0.0 };
    }
    let centre = (low + high) / 2.0;
    // The radius reaches the farthest vertex or sphere surface.
    let radius_m = all.iter().map(|(at, radius)| centre.distance(*at) + radius).fold(0.0, f64::max);
    ObjectSphere { centre, radius_m }
}

impl ByObjects {
    pub(super) fn new(list: &DisplayList, scan: FaceScan, timing: &PriorityTiming) -> Self {
        let spheres: Vec<ObjectSphere> =
            list.structures.iter().map(|structure| sphere_around(list, structure)).collect();
        Self {
            policy: Objects::new(timing, spheres.len()),
            threshold: Threshold::of_degrees(timing.theta_deg),
            spheres,
            scan,
            cycle: 0,
            began: None,
        }
    }

    /// Returns the time, in seconds, for which the image of a structure stays correct while the eye moves. The time is
    /// 0 for a structure that moves by itself.
    fn period_s(&self, moves: bool, structure: usize, eye: DVec3, speed: f64) -> f64 {
        let ObjectSphere { centre, radius_m } = self.spheres[structure];
        let animation_s = if moves { 0.0 } else { f64::INFINITY };
        let seen = ObjectView { distance_m: eye.distance(centre), radius_m, speed, turn: 0.0, animation_s };
        self.threshold.period(&seen).least()
    }
}

impl DuePolicy for ByObjects {
    fn begin(&mut self, updates: &Updates, _: PictureNumber, now: Time) -> VecDeque<Due> {
        let field = self.scan.field_at(now);
        let eye = updates.setup.views.pose_at(now, now).position;
        // The first cycle has no earlier position, so the speed is 0.
        let speed = self.began.map_or(0.0, |(before, from)| {
            let seconds = self.scan.retrace(field).since(self.scan.retrace(before)).as_ms() * 1e-3;
            eye.distance(from) / seconds
        });
        let moves = |structure: usize| updates.moving.get(structure) == Some(&true);
        // The policy decides from the period of each structure.
        let periods: Vec<f64> = (0..self.spheres.len()).map(|i| self.period_s(moves(i), i, eye, speed)).collect();
        let update = self.policy.frame(self.cycle, &periods);
        self.cycle += 1;
        self.began = Some((field, eye));
        let due = update.memories().map(|memory| Due {
            memory,
            together: if update.together[memory] { update.together_bits() } else { 0 },
            structures: (0..self.spheres.len()).map(|i| self.policy.memory(i) == Some(memory)).collect(),
            at: now,
            view: None,
            warp: None,
        });
        due.collect()
    }
}
