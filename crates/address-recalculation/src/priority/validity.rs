//! Validity period of an object's image: the duration for which the error of the image stays below a threshold.

use serde::{Deserialize, Serialize};

/// Threshold for the angular error of an image, and the rules that compute the error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Largest accepted angular error in radians.
    pub angle: f64,
    pub translation: Translation,
    pub size: SizeRule,
    pub distance: Distance,
}

/// Rule for how far the eye may move before the direction of a point at distance d is wrong by the angle theta.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Translation {
    /// The eye may move by 2 d sin(theta / 2), a chord, as in a drawing in the papers on priority rendering.
    #[default]
    Chord,
    /// The eye may move by d sin(theta), which is the shortest movement that can change the direction by theta.
    Sine,
}

/// Rule for the apparent size of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SizeRule {
    /// The angle that a disc with the object's radius covers, perpendicular to the line of sight.
    #[default]
    Disc,
    /// The angle that the outline of the object's bounding sphere covers.
    Sphere,
}

/// Rule for measuring the distance to an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Distance {
    /// The distance of the object's nearest point.
    #[default]
    Nearest,
    /// The distance of the object's middle. This rule is inaccurate for long walls.
    Centre,
}

/// An object as seen from an eye position: its bounding sphere and its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectView {
    /// Distance between the eye and the middle of the bounding sphere, in metres.
    pub distance_m: f64,
    pub radius_m: f64,
    /// Speed of the object relative to the eye, in m/s.
    pub speed: f64,
    /// Speed of the object's rotation about its own axis, in rad/s.
    pub turn: f64,
    /// Duration for which an image of the animated object stays correct, in seconds. The duration is infinite for an
    /// object without animation.
    pub animation_s: f64,
}

/// Durations for which an image is right, in seconds, one for each cause of error. A duration is infinite if the cause
/// is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValidityPeriod {
    /// Duration until the motion of the eye makes the image wrong.
    pub translation_s: f64,
    /// Duration until the growth of the apparent size makes the image wrong.
    pub size_s: f64,
    /// Duration until the animation makes the image wrong, as given by the user.
    pub animation_s: f64,
    /// Duration until the rotation of the object makes the image wrong.
    pub turn_s: f64,
}

impl ValidityPeriod {
    /// Returns the shortest of the four durations. After this time the image must be drawn again.
    pub const fn least(&self) -> f64 {
        self.translation_s.min(self.size_s).min(self.animation_s).min(self.turn_s)
    }
}

impl Threshold {
    /// Returns the threshold for an angular error of `theta_deg` degrees, with the default rules: chord, disc and
    /// nearest point. These rules are the closest to the papers on priority rendering.
    pub fn of_degrees(theta_deg: f64) -> Self {
        let distance = Distance::Nearest;
        Self { angle: theta_deg.to_radians(), translation: Translation::Chord, size: SizeRule::Disc, distance }
    }

    /// Returns how far the eye may move, in metres, before the direction of a point is wrong by the threshold.
    /// `distance_m` is the point's distance.
    pub fn way(&self, distance_m: f64) -> f64 {
        match self.translation {
            Translation::Chord => 2.0 * distance_m * libm::sin(self.angle / 2.0),
            Translation::Sine => distance_m * libm::sin(self.angle),
        }
    }

    /// Returns how far the eye may move towards an object, in metres, before the object's apparent size is wrong by the
    /// threshold.
    ///
    /// With [`SizeRule::Sphere`], the result is 0 if the eye is inside the bounding sphere.
    pub fn max_approach(&self, distance_m: f64, radius_m: f64) -> f64 {
        let quarter = std::f64::consts::FRAC_PI_2;
        match self.size {
            SizeRule::Disc => {
                let angle = libm::atan2(radius_m, distance_m) + self.angle;
                // Beyond 90 degrees, the size stays valid until the eye reaches the object.
                if angle >= quarter { distance_m } else { distance_m - radius_m / libm::tan(angle) }
            }
            SizeRule::Sphere if distance_m <= radius_m => 0.0,
            SizeRule::Sphere => {
                let angle = libm::asin(radius_m / distance_m) + self.angle;
                if angle >= quarter { distance_m - radius_m } else { distance_m - radius_m / libm::sin(angle) }
            }
        }
    }

    /// Returns the duration, in seconds, for which the image of an object stays correct while the object rotates at
    /// `turn` rad/s.
    pub fn turn_s(&self, nearest_m: f64, radius_m: f64, turn: f64) -> f64 {
        let sine = nearest_m * libm::sin(self.angle) / (2.0 * radius_m);
        if turn == 0.0 || sine >= 1.0 || radius_m == 0.0 { f64::INFINITY } else { 2.0 / turn.abs() * libm::asin(sine) }
    }

    /// Returns the validity period of an object's image.
    ///
    /// A rotation of the head never makes an image wrong. If the eye is inside the bounding sphere, the image is wrong
    /// immediately.
    pub fn period(&self, object: &ObjectView) -> ValidityPeriod {
        let nearest = (object.distance_m - object.radius_m).max(0.0);
        let counted = if self.distance == Distance::Nearest { nearest } else { object.distance_m };
        // Inside the bounding sphere, images are never valid.
        if nearest == 0.0 {
            return ValidityPeriod { translation_s: 0.0, size_s: 0.0, animation_s: object.animation_s, turn_s: 0.0 };
        }
        ValidityPeriod {
            translation_s: time_of(self.way(counted), object.speed),
            size_s: time_of(self.max_approach(object.distance_m, object.radius_m), object.speed),
            animation_s: object.animation_s,
            turn_s: self.turn_s(nearest, object.radius_m, object.turn),
        }
    }
}

/// Returns the duration, in seconds, of a movement over `way_m` metres. The duration is infinite if the speed is 0.
fn time_of(way_m: f64, speed: f64) -> f64 {
    if speed == 0.0 { f64::INFINITY } else { way_m / speed.abs() }
}

/// Returns the index of the least often drawn memory that can hold an image with the validity period `period_s`. Of the
/// `memories` memories, memory k is drawn every 2^k frames.
pub fn level(period_s: f64, frame_s: f64, memories: usize) -> usize {
    let rests = |k: &usize| f64::from(1_u32 << k) * frame_s <= period_s;
    (0..memories).take_while(|k| *k == 0 || rests(k)).last().unwrap_or(0)
}
