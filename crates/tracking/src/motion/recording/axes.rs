use glam::{DMat3, DQuat, DVec3};

use crate::pose::Pose;

/// The convention for the coordinate axes of a recording: the axes of the head or of its sensor, and the up direction
/// of the world.
///
/// This crate's axes are right-handed with y up and the view along -z. Two constant rotations W and B convert a
/// recorded pose (p, q) into these axes. The position becomes W p and the orientation W q B. W rotates the recorded
/// world axes to this crate's world axes. B rotates this crate's head axes to the recorded head axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The axes of this crate and of OpenGL. Head: x right, y up, looks along -z. World: y up.
    OpenGl,
    /// The axes of the TUM benchmark and of cameras in robotics (optical frames). Head: x right, y down, looks along
    /// +z. World: z up.
    Optical,
    /// The axes of the EuRoC sensor's inertial unit. Head: x up, y right, looks along +z. World: z up. The calibration
    /// of the EuRoC sensor gives the camera's axes relative to this unit.
    Euroc,
    /// The axes of robotics (ROS REP 103). Head: looks along +x, y left, z up. World: z up.
    Robot,
    /// The left-handed axes of Unity. Head: x right, y up, looks along +z. World: y up.
    Unity,
}

pxpl5_sim::parameters::named!(Axes, "convention for axes", Axes::NAMES);

impl Axes {
    /// Every axis convention with its name in experiment files.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("opengl", Self::OpenGl),
        ("optical", Self::Optical),
        ("euroc", Self::Euroc),
        ("robot", Self::Robot),
        ("unity", Self::Unity),
    ];

    /// Returns the name of the convention in experiment files and on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, axes)| *axes == self).map_or("", |(name, _)| name)
    }

    /// Returns the rotation W of [`Axes`], from the recorded world's axes to this crate's world axes.
    fn of_world(self) -> DQuat {
        match self {
            Self::OpenGl | Self::Unity => DQuat::IDENTITY,
            // The recorded axes are east, north, up: x stays, up becomes y, and north becomes -z.
            Self::Optical | Self::Euroc | Self::Robot => from_images(DVec3::X, DVec3::NEG_Z, DVec3::Y),
        }
    }

    /// Returns the rotation B of [`Axes`], from this crate's head axes (right, up, back) to the recorded head axes.
    fn of_head(self) -> DQuat {
        match self {
            Self::OpenGl | Self::Unity => DQuat::IDENTITY,
            Self::Optical => from_images(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
            Self::Euroc => from_images(DVec3::Y, DVec3::X, DVec3::NEG_Z),
            Self::Robot => from_images(DVec3::NEG_Y, DVec3::Z, DVec3::NEG_X),
        }
    }

    pub(super) fn convert(self, recorded: Pose) -> Pose {
        match self {
            Self::OpenGl => return recorded,
            // A mirror in z makes the axes right-handed. Turns about z stay, and all others change their direction.
            Self::Unity => {
                let (p, q) = (recorded.position, recorded.orientation);
                let orientation = DQuat::from_xyzw(-q.x, -q.y, q.z, q.w);
                return Pose { position: DVec3::new(p.x, p.y, -p.z), orientation };
            }
            _ => {}
        }
        let world = self.of_world();
        Pose {
            position: world * recorded.position,
            orientation: (world * recorded.orientation * self.of_head()).normalize(),
        }
    }
}

fn from_images(x: DVec3, y: DVec3, z: DVec3) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Conventions for the axes of recordings. The three vectors point to the right, up and ahead of the head, in the
    /// axes of the head. The last vector points up, in the axes of the world.
    const MEANING: [(Axes, [DVec3; 3], DVec3); 4] = [
        (Axes::OpenGl, [DVec3::X, DVec3::Y, DVec3::NEG_Z], DVec3::Y),
        (Axes::Optical, [DVec3::X, DVec3::NEG_Y, DVec3::Z], DVec3::Z),
        (Axes::Euroc, [DVec3::Y, DVec3::X, DVec3::Z], DVec3::Z),
        (Axes::Robot, [DVec3::NEG_Y, DVec3::Z, DVec3::X], DVec3::Z),
    ];

    /// In Unity a positive turn about y, which is up, is to the right, and a positive turn about x is down.
    #[test]
    fn a_left_handed_recording_becomes_right_handed() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let turned = |x: f64, y: f64| {
            let recorded = Pose { position: DVec3::Z, orientation: DQuat::from_xyzw(x, y, 0.0, half) };
            let Pose { position, orientation } = Axes::Unity.convert(recorded);
            assert_eq!(position, DVec3::NEG_Z, "a metre ahead");
            orientation * DVec3::NEG_Z
        };
        assert!(turned(0.0, half).distance(DVec3::X) < 1e-15, "right");
        assert!(turned(half, 0.0).distance(DVec3::NEG_Y) < 1e-15, "down");
    }

    #[test]
    fn converting_the_axes_of_a_recording_keeps_right_up_and_ahead() {
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
