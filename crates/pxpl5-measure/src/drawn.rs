use glam::DVec2;
use pxpl5_sim::Time;
use std::sync::Arc;
use tracking::Pose;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub(crate) pose: Pose,
    pub(crate) objects_at: Time,
    /// Time at which the tracker measured the newest report from which the pose was computed. `None` before the first
    /// report, or if unknown.
    pub(crate) measured_at: Option<Time>,
}

impl Moment {
    pub(crate) fn is_same_picture(&self, other: &Self) -> bool {
        self.pose == other.pose && self.objects_at == other.objects_at
    }
}

#[derive(Clone, Debug)]
pub(crate) enum Drawn {
    View(Moment),
    Between {
        from: Moment,
        to: Moment,
        part: f64,
        on_screen: bool,
    },
    /// A picture that the display shifts during scan-out (raster offset).
    ShiftedRaster(Moment, DVec2),
    /// Six faces of a cube around the eye, read in the direction that the display latched (sampled and held). The pixel
    /// shows the nearest scene point of all display memories.
    Faces(FacesSeen),
}

/// The display memories and the direction from which a pixel of an address recalculation display was read.
#[derive(Clone, Debug)]
pub(crate) struct FacesSeen {
    /// For each display memory, in ascending order: the eye's pose in this memory, turned to the latched direction, and
    /// a flag for each structure of the scene. A flag is true if the memory holds the structure.
    pub(crate) memories: Vec<(Moment, Arc<[bool]>)>,
    /// Instant for which the latched direction was predicted.
    pub(crate) aimed_at: Time,
}

impl Drawn {
    /// Returns the instant for which the pixel was drawn. For a shifted picture, the result is the instant at which the
    /// pixel is lit.
    pub(crate) fn instant(&self, light: Time) -> Time {
        match self {
            Self::View(moment) => moment.objects_at,
            Self::Between { from, to, part, .. } => {
                let ahead_ps = to.objects_at.since(from.objects_at).0 as f64 * part;
                Time(from.objects_at.0 + ahead_ps as u64)
            }
            Self::ShiftedRaster(..) => light,
            Self::Faces(faces) => faces.aimed_at,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn a_pixel_between_two_poses_is_drawn_for_the_interpolated_pose() {
        let moment = |at: u64| Moment { pose: Pose::facing(DQuat::IDENTITY), objects_at: Time(at), measured_at: None };
        let light = Time(9_000);
        for (part, expected) in [(0.0, 1_000), (0.25, 1_500), (0.5, 2_000), (1.0, 3_000)] {
            let between = Drawn::Between { from: moment(1_000), to: moment(3_000), part, on_screen: false };
            assert_eq!(between.instant(light), Time(expected), "{part}");
        }
        assert_eq!(Drawn::View(moment(7)).instant(light), Time(7));
        assert_eq!(Drawn::ShiftedRaster(moment(7), DVec2::ONE).instant(light), light);
        let faces = FacesSeen { memories: Vec::new(), aimed_at: Time(5) };
        assert_eq!(Drawn::Faces(faces).instant(light), Time(5));
    }
}
