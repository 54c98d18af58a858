//! Validity period of an object: the time for which its image stays right.

use serde::{Deserialize, Serialize};

/// Largest accepted angular error of an image, and the rules for computing it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Largest accepted angular error in radians.
    pub angle: f64,
    /// Rule for the distance that the eye may move before a point is wrong.
    pub translation: Translation,
    /// Rule for the apparent size of an object.
    pub size: SizeRule,
    /// Rule for the distance of an object.
    pub distance: Distance,
}

/// Rule for the distance that the eye may move before a point at distance d is off by the angle theta.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Translation {
    /// 2 d sin(theta / 2), as in the paper's figure.
    #[default]
    Chord,
    /// d sin(theta), the shortest movement that can move a point by theta.
    Sine,
}

/// Rule for the apparent size of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SizeRule {
    /// The size of a disc perpendicular to the line of sight.
    #[default]
    Disc,
    /// The size of the bounding sphere's outline.
    Sphere,
}

/// Rule for the distance of an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Distance {
    /// The distance of its nearest point.
    #[default]
    Nearest,
    /// The distance of its middle. Inaccurate for long walls.
    Centre,
}

/// An object as seen from an eye: its bounding sphere and its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectView {
    /// Distance between the eye and the sphere's middle, in metres.
    pub distance_m: f64,
    /// Radius of the sphere in metres.
    pub radius_m: f64,
    /// Speed relative to the eye in m/s.
    pub speed: f64,
    /// Speed of rotation about its own axis in rad/s.
    pub turn: f64,
    /// Time for which its animation keeps an image right, in seconds. Infinite without animation.
    pub animation_s: f64,
}

/// Time for which an image is right, in seconds, separately for each cause of error. Infinite if a cause is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValidityPeriod {
    /// Limit from the motion of the eye.
    pub translation_s: f64,
    /// Limit from the growth of the apparent size.
    pub size_s: f64,
    /// Time limit from the animation, as given by the user.
    pub animation_s: f64,
    /// Limit from the rotation of the object.
    pub turn_s: f64,
}

impl ValidityPeriod {
    /// Returns the smallest of all limits: the time until the image must be redrawn.
    #[must_use]
    pub const fn least(&self) -> f64 {
        self.translation_s.min(self.size_s).min(self.animation_s).min(self.turn_s)
    }
}

impl Threshold {
    /// Returns a threshold with the default rules: chord, disc and nearest point. They follow the paper as closely as
    /// possible.
    #[must_use]
    pub fn of_degrees(theta_deg: f64) -> Self {
        let distance = Distance::Nearest;
        Self { angle: theta_deg.to_radians(), translation: Translation::Chord, size: SizeRule::Disc, distance }
    }

    /// Returns how far the eye may move, in metres, before a point at a distance is off by the threshold.
    #[must_use]
    pub fn way(&self, distance_m: f64) -> f64 {
        match self.translation {
            Translation::Chord => 2.0 * distance_m * libm::sin(self.angle / 2.0),
            Translation::Sine => distance_m * libm::sin(self.angle),
        }
    }

    /// Returns how far the eye may move towards an object, in metres, before its size is off by the threshold.
    ///
    /// With [`SizeRule::Sphere`], the result is 0 inside the bounding sphere.
    #[must_use]
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

    /// Returns the time in seconds for which the image of an object that rotates at `turn` rad/s is right.
    #[must_use]
    pub fn turn_s(&self, nearest_m: f64, radius_m: f64, turn: f64) -> f64 {
        let sine = nearest_m * libm::sin(self.angle) / (2.0 * radius_m);
        if turn == 0.0 || sine >= 1.0 || radius_m == 0.0 { f64::INFINITY } else { 2.0 / turn.abs() * libm::asin(sine) }
    }

    /// Returns the validity period of an object's image.
    ///
    /// A rotation of the head never makes an image wrong. From inside the bounding sphere, an image is wrong
    /// immediately.
    #[must_use]
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

/// Returns the time in seconds for a distance, infinite at speed 0.
fn time_of(way_m: f64, speed: f64) -> f64 {
    if speed == 0.0 { f64::INFINITY } else { way_m / speed.abs() }
}

/// Returns the slowest of `memories` memories that suits an image right for `period_s`. Memory k is drawn every 2^k
/// frames.
#[must_use]
pub fn level(period_s: f64, frame_s: f64, memories: usize) -> usize {
    let rests = |k: &usize| f64::from(1_u32 << k) * frame_s <= period_s;
    (0..memories).take_while(|k| *k == 0 || rests(k)).last().unwrap_or(0)
}
