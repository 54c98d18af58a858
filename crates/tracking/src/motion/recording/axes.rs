use glam::{DMat3, DQuat, DVec3};

use crate::pose::Pose;

/// What the axes of a recording mean: those of the head (or of the sensor on it), and which way is up in the world.
///
/// A pose is turned into this crate's axes (right-handed, y up, looking along -z) by two fixed rotations, one on each side:
/// position W p, orientation W q B, where W takes the recorded world's axes to ours and B our head's axes to the recorded ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Head: x right, y up, looks along -z. World: y up. This crate's own, and OpenGL's.
    OpenGl,
    /// Head: x right, y down, looks along +z, as an optical frame has it. World: z up. The TUM benchmark's.
    Optical,
    /// Head: x up, y right, looks along +z, as the inertial unit of the EuRoC sensor sits (its calibration gives the camera
    /// against it). World: z up.
    Euroc,
    /// Head: looks along +x, y left, z up. World: z up. Robotics' (ROS REP 103).
    Robot,
}

impl Axes {
    /// All of them, by the names under which experiments know them.
    pub const NAMES: [(&'static str, Self); 4] =
        [("opengl", Self::OpenGl), ("optical", Self::Optical), ("euroc", Self::Euroc), ("robot", Self::Robot)];

    /// Its name in experiment files and on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, axes)| *axes == self).map_or("", |(name, _)| name)
    }

    /// W: from the recorded world's axes to ours.
    fn of_world(self) -> DQuat {
        match self {
            Self::OpenGl => DQuat::IDENTITY,
            // East, north, up: x stays, up becomes y, and north -z.
            Self::Optical | Self::Euroc | Self::Robot => from_images(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        }
    }

    /// B: from our head's axes (right, up, back) to the recorded ones.
    fn of_head(self) -> DQuat {
        match self {
            Self::OpenGl => DQuat::IDENTITY,
            Self::Optical => from_images(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
            Self::Euroc => from_images(DVec3::Y, DVec3::X, DVec3::NEG_Z),
            Self::Robot => from_images(DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X),
        }
    }

    /// A recorded pose in this crate's axes.
    pub(super) fn convert(self, recorded: Pose) -> Pose {
        if self == Self::OpenGl {
            return recorded;
        }
        let world = self.of_world();
        Pose {
            position: world * recorded.position,
            orientation: (world * recorded.orientation * self.of_head()).normalize(),
        }
    }
}

/// The rotation that takes x, y and z to these.
fn from_images(x: DVec3, y: DVec3, z: DVec3) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Right, up and ahead of a head in the recorded head's own axes, and up of the recorded world, in words of each convention.
    const MEANING: [(Axes, [DVec3; 3], DVec3); 4] = [
        (Axes::OpenGl, [DVec3::X, DVec3::Y, DVec3::NEG_Z], DVec3::Y),
        (Axes::Optical, [DVec3::X, DVec3::NEG_Y, DVec3::Z], DVec3::Z),
        (Axes::Euroc, [DVec3::Y, DVec3::X, DVec3::Z], DVec3::Z),
        (Axes::Robot, [DVec3::NEG_Y, DVec3::Z, DVec3::X], DVec3::Z),
    ];

    #[test]
    fn right_up_and_ahead_stay_what_they_are() {
        let any = DQuat::from_xyzw(0.1, -0.7, 0.3, 0.5).normalize();
        for (axes, [right, up, ahead], world_up) in MEANING {
            let recorded = Pose { position: world_up * 3.0, orientation: any };
            let ours = axes.convert(recorded);
            assert!((ours.position - DVec3::Y * 3.0).length() < 1e-15, "{axes:?}: up");
            let world = axes.of_world();
            for (name, of_head, in_ours) in
                [("right", right, DVec3::X), ("up", up, DVec3::Y), ("ahead", ahead, DVec3::NEG_Z)]
            {
                let seen = world * (any * of_head);
                assert!((ours.orientation * in_ours - seen).length() < 1e-14, "{axes:?}: {name}");
            }
        }
    }
}
