use pxpl5_sim::parameters::SettingError;
use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use super::Motion;
use super::synthetic::Synthetic;
use crate::error::check;
use crate::identity::{SettingSink, write_vector};
use crate::pose::Pose;
use crate::time::seconds;

/// Distance along the path from a walking head to the point at which the head looks, m. The distance is assumed. The
/// head turns towards a corner before it reaches the corner. At 1 m/s and a square corner the head turns at up to 76
/// degrees per second, which a real head can do.
const AHEAD_M: f64 = 1.5;

/// Least distance between two successive corners of a path, m. At a smaller distance, rounding errors would falsify the
/// direction from one corner to the next.
const MIN_LEG_M: f64 = 1e-3;

/// A head that walks at constant speed along a closed path. The head is at the first corner at time 0. The head looks
/// at a point of the path ahead. After [`Self::with_glances`] the head also looks around.
#[derive(Clone, Debug)]
pub struct Walk {
    corners: Arc<[DVec3]>,
    /// Distance along the path from the first corner to each corner, m. The last element is the length of the closed
    /// path.
    ways: Vec<f64>,
    m_per_s: f64,
    glances: Option<Synthetic>,
}

impl Walk {
    /// Creates a walk along the positions `corners` and back to the first corner, at a speed of -100 to 100 m/s. A
    /// negative speed reverses the direction.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if the speed is out of range or a coordinate exceeds 1e6 m. Fewer than two corners, or
    /// successive corners less than 1 mm apart, are errors too.
    pub fn new(corners: &[DVec3], m_per_s: f64) -> Result<Self, SettingError> {
        check("speed of the walk", m_per_s, -100.0, 100.0)?;
        for coordinate in corners.iter().flat_map(DVec3::to_array) {
            check("coordinate of the path", coordinate, -1e6, 1e6)?;
        }
        check("corners of the path", corners.len() as f64, 2.0, 1e6)?;
        // Sum up the lengths of the straight parts, including the part from the last corner back to the first.
        let mut ways = vec![0.0];
        for (i, corner) in corners.iter().enumerate() {
            let leg = corner.distance(corners[(i + 1) % corners.len()]);
            check("leg of the path", leg, MIN_LEG_M, 1e7)?;
            ways.push(ways[i] + leg);
        }
        Ok(Self { corners: corners.into(), ways, m_per_s, glances: None })
    }

    /// Returns the same walk with a head that also looks around. The glances come from [`Synthetic::recorded_use`] with
    /// the seed `seed`.
    #[must_use]
    pub fn with_glances(mut self, seed: u64) -> Self {
        self.glances = Some(Synthetic::recorded_use(seed));
        self
    }

    /// Returns the length of the closed path, m.
    pub fn length_m(&self) -> f64 {
        self.ways[self.corners.len()]
    }

    /// Returns the position (m) at a distance along the path from the first corner. A negative distance, or a distance
    /// longer than the closed path, wraps around.
    pub fn place(&self, way_m: f64) -> DVec3 {
        let way = rounded(way_m, self.length_m());
        // Find the straight part of the path, and the fraction of this part.
        let leg = self.ways.partition_point(|begin| *begin <= way).clamp(1, self.corners.len()) - 1;
        let share = ((way - self.ways[leg]) / (self.ways[leg + 1] - self.ways[leg])).clamp(0.0, 1.0);
        self.corners[leg].lerp(self.corners[(leg + 1) % self.corners.len()], share)
    }
}

fn rounded(way: f64, round: f64) -> f64 {
    let rest = libm::fmod(way, round);
    if rest < 0.0 { rest + round } else { rest }
}

/// Returns the orientation of an upright head at `eye` that looks at `point`. If both positions are equal, the head
/// looks along -z.
fn looking_at(eye: DVec3, point: DVec3) -> DQuat {
    let back = (eye - point).normalize_or(DVec3::Z);
    let right = DVec3::Y.cross(back).normalize_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize()
}

impl Motion for Walk {
    fn pose(&self, t_ps: u64) -> Pose {
        let way = self.m_per_s * seconds(t_ps);
        let position = self.place(way);
        let ahead = looking_at(position, self.place(way + AHEAD_M.copysign(self.m_per_s)));
        let glance = self.glances.as_ref().map_or(DQuat::IDENTITY, |head| head.pose(t_ps).orientation);
        Pose { position, orientation: (ahead * glance).normalize() }
    }

    fn identify(&self, settings: &mut SettingSink) {
        let Self { corners, ways: _, m_per_s, glances } = self;
        settings("motion", &"walk");
        settings("motion.m_per_s", m_per_s);
        corners.iter().for_each(|corner| write_vector(settings, "motion.corner", *corner));
        if let Some(glances) = glances {
            glances.identify(settings);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::PS_PER_S;

    fn square() -> Walk {
        let corners = [[0.0, 1.7, 0.0], [4.0, 1.7, 0.0], [4.0, 1.7, 4.0], [0.0, 1.7, 4.0]].map(DVec3::from_array);
        Walk::new(&corners, 1.0).expect("a path")
    }

    #[test]
    fn positions_on_a_walk_follow_the_path() {
        let walk = square();
        assert_eq!(walk.length_m(), 16.0);
        assert!(walk.pose(5 * PS_PER_S).position.distance(DVec3::new(4.0, 1.7, 1.0)) < 1e-12);
        assert!(walk.pose(16 * PS_PER_S).position.distance(DVec3::new(0.0, 1.7, 0.0)) < 1e-12);
        assert!(walk.place(-1.0).distance(DVec3::new(0.0, 1.7, 1.0)) < 1e-12);
    }

    #[test]
    fn the_gaze_follows_the_path_and_turns_without_a_jump() {
        let walk = square();
        let gaze = |t_ps: u64| walk.pose(t_ps).orientation * DVec3::NEG_Z;
        assert!(gaze(PS_PER_S).distance(DVec3::X) < 1e-12);
        assert!(gaze(4 * PS_PER_S).distance(DVec3::Z) < 1e-12);
        // 0.75 m before a square corner, the point ahead is 0.75 m beyond the corner: half of the turn is done.
        let half = DVec3::new(1.0, 0.0, 1.0).normalize();
        assert!(gaze(13 * PS_PER_S / 4).distance(half) < 1e-12);
        // The fastest turn is 2 v / AHEAD_M rad/s, when half of the turn is done: 0.0222 rad per frame.
        for frame in 0..960_u64 {
            let [before, after] = [frame, frame + 1].map(|n| gaze(n * PS_PER_S / 60));
            assert!(before.angle_between(after) < 2.0 / AHEAD_M / 60.0 * 1.01, "{frame}");
        }
    }

    #[test]
    fn looking_around_changes_the_gaze_and_not_the_path() {
        let around = square().with_glances(3);
        let poses = [around.pose(PS_PER_S), square().pose(PS_PER_S)];
        assert_eq!(poses[0].position, poses[1].position);
        assert!(poses[0].angle_deg(&poses[1]) > 0.1);
    }

    #[test]
    fn an_invalid_path_is_refused() {
        assert!(Walk::new(&[], 1.0).is_err());
        assert!(Walk::new(&[DVec3::ZERO], 1.0).is_err());
        assert!(Walk::new(&[DVec3::ZERO, DVec3::ZERO], 1.0).is_err());
        assert!(Walk::new(&[DVec3::ZERO, DVec3::X * 1e7], 1.0).is_err());
        assert!(Walk::new(&[DVec3::ZERO, DVec3::X * f64::NAN], 1.0).is_err());
        assert!(Walk::new(&[DVec3::ZERO, DVec3::X], f64::NAN).is_err());
    }
}
