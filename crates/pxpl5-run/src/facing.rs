//! A place for a head's motion from which the head faces the scene as long as it can.

use glam::{DQuat, DVec3, Vec3};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use std::f64::consts::{PI, TAU};
use tracking::Pose;
use tracking::motion::Motion;
use tracking::rotation;
use tracking::view::Hmd;

/// Number of instants of the run at which the head's direction is looked up.
const INSTANTS: u64 = 400;

/// Returns a pose of the motion, and the pose in the scene to which it corresponds ([`HeadPlace::Content`](crate::HeadPlace)).
/// Both poses are upright, so what is level in the motion stays level in the scene.
pub(crate) fn content(motion: &dyn Motion, scene: &Scene, hmd: &Hmd, until: Time) -> (Pose, Pose) {
    let poses: Vec<Pose> = (0..INSTANTS).map(|n| motion.pose(until.0 / INSTANTS * n)).collect();
    let position = poses.iter().map(|pose| pose.position).sum::<DVec3>() / INSTANTS as f64;
    let yaws: Vec<f64> = poses.iter().map(yaw).collect();
    // The direction that has the most others in the middle half of the picture beside it.
    let reach = hmd.config().horizontal_fov_deg.to_radians() / 4.0;
    let beside = |middle: f64| yaws.iter().filter(|yaw| wrapped(**yaw - middle).abs() <= reach).count();
    let most = yaws.iter().map(|yaw| beside(*yaw)).max().unwrap_or(0);
    // Several directions can be as good. The one in their middle leaves the same time at both sides.
    let best: Vec<f64> = yaws.iter().copied().filter(|yaw| beside(*yaw) == most).collect();
    let facing = best.get(best.len() / 2).copied().unwrap_or(0.0);
    let begin = scene.motion().pose(0);
    let way = middle(scene) - begin.position;
    // From the middle of a room, every direction shows content.
    let towards = match DVec3::new(way.x, 0.0, way.z).try_normalize() {
        Some(way) => yaw(&Pose::facing(DQuat::from_rotation_arc(DVec3::NEG_Z, way))),
        None => yaw(&begin),
    };
    (
        Pose { position, orientation: rotation::about_y(facing) },
        Pose { position: begin.position, orientation: rotation::about_y(towards) },
    )
}

/// Returns the middle of the box around the first structure. Later structures can surround the viewer.
fn middle(scene: &Scene) -> DVec3 {
    let Some(first) = scene.structures().first() else { return DVec3::ZERO };
    let vertices = scene.vertices()[first.vertices.clone()].iter().map(|vertex| vertex.position);
    let points = vertices.chain(scene.spheres()[first.spheres.clone()].iter().map(|sphere| sphere.centre));
    let (low, high) = points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    if low.x > high.x { DVec3::ZERO } else { ((low + high) / 2.0).as_dvec3() }
}

/// Returns the direction of a head about the vertical axis, in radians. A positive angle is to the left.
fn yaw(pose: &Pose) -> f64 {
    rotation::to_yaw_pitch_roll(pose.orientation).0
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * ((angle + PI) / TAU).floor()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_scene::builtin;
    use tracking::motion::Recording;

    /// Tests a head that looks to the left for a quarter of the run and then ahead, before an aircraft. Placed by its
    /// content, the head faces the aircraft in the longer part, at the eye's place in the scene.
    #[test]
    fn a_head_faces_the_content_for_the_longer_part_of_its_motion() {
        let scene = builtin("aircraft").expect("built in");
        let look = |yaw: f64| Pose { orientation: rotation::about_y(yaw), ..Pose::at(DVec3::new(4.0, 1.0, 2.0)) };
        let samples = [(0.0, look(1.5)), (0.5, look(1.5)), (0.51, look(0.2)), (2.0, look(0.2))];
        let motion = Recording::from_samples(samples).expect("ascending");
        let (from, to) = content(&motion, &scene, &Hmd::unc(), Time(2_000_000_000_000));
        assert!(
            (yaw(&from) - 0.2).abs() < 1e-9 && from.position.distance(DVec3::new(4.0, 1.0, 2.0)) < 1e-9,
            "{from:?}"
        );
        let centre = to.view_of(middle(&scene));
        assert!(centre.x.abs() < 1e-6 && centre.z < 0.0, "the content is ahead: {centre}");
        assert_eq!(to.position, scene.motion().pose(0).position);
    }
}
