//! How long an image stays right: an object's validity period.

use serde::{Deserialize, Serialize};

/// The angle by which an image may be wrong, and how it is reckoned with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// How much may be wrong, radians.
    pub angle: f64,
    /// How far the eye may go before a point is off by that angle.
    pub translation: Translation,
    /// What an object's growing size is taken for.
    pub size: SizeRule,
    /// The distance that counts.
    pub distance: Distance,
}

/// How far the eye may go before a point at distance d is off by theta.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Translation {
    /// 2 d sin(theta / 2), as the paper's figure draws it.
    #[default]
    Chord,
    /// d sin(theta): no movement at all turns a point by more.
    Sine,
}

/// What an object's growing size is taken for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SizeRule {
    /// That of a disc across the line of sight.
    #[default]
    Disc,
    /// That of the bounding sphere's outline.
    Sphere,
}

/// The distance of an object that counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Distance {
    /// That of its nearest point.
    #[default]
    Nearest,
    /// That of its middle, which misjudges long walls.
    Centre,
}

/// An object as an eye sees it: its bounding sphere and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenObject {
    /// Distance of the sphere's middle from the eye, m.
    pub distance_m: f64,
    /// Radius of the sphere, m.
    pub radius_m: f64,
    /// Speed relative to the eye, m/s.
    pub speed: f64,
    /// How fast it turns about itself, rad/s.
    pub turn: f64,
    /// How long its animation lets an image stand, s; infinite without any.
    pub animation_s: f64,
}

/// For how long an image is right, seconds, by what could make it wrong; infinite where nothing does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValidityPeriod {
    /// The object's place, seen from a moving eye.
    pub translation_s: f64,
    /// Its size as it comes nearer.
    pub size_s: f64,
    /// Its animation, as the user states it.
    pub animation_s: f64,
    /// Its turning about itself.
    pub turn_s: f64,
}

impl ValidityPeriod {
    /// The least of all: when the image must be drawn again at the latest.
    #[must_use]
    pub const fn least(&self) -> f64 {
        self.translation_s.min(self.size_s).min(self.animation_s).min(self.turn_s)
    }
}

impl Threshold {
    /// Chord, disc, nearest point: what stands in the paper, or is nearest to it.
    #[must_use]
    pub fn of_degrees(theta_deg: f64) -> Self {
        let distance = Distance::Nearest;
        Self { angle: theta_deg.to_radians(), translation: Translation::Chord, size: SizeRule::Disc, distance }
    }

    /// How far the eye may go, m, before a point at a distance is off by the angle.
    #[must_use]
    pub fn way(&self, distance_m: f64) -> f64 {
        match self.translation {
            Translation::Chord => 2.0 * distance_m * libm::sin(self.angle / 2.0),
            Translation::Sine => distance_m * libm::sin(self.angle),
        }
    }

    /// How far the eye may go towards an object, m, before its size is off by the angle; 0 inside of the bounding sphere of
    /// [`SizeRule::Sphere`].
    #[must_use]
    pub fn way_of_size(&self, distance_m: f64, radius_m: f64) -> f64 {
        let quarter = std::f64::consts::FRAC_PI_2;
        match self.size {
            SizeRule::Disc => {
                let angle = libm::atan2(radius_m, distance_m) + self.angle;
                if angle >= quarter { distance_m } else { distance_m - radius_m / libm::tan(angle) }
            }
            SizeRule::Sphere if distance_m <= radius_m => 0.0,
            SizeRule::Sphere => {
                let angle = libm::asin(radius_m / distance_m) + self.angle;
                if angle >= quarter { distance_m - radius_m } else { distance_m - radius_m / libm::sin(angle) }
            }
        }
    }

    /// For how long an image of an object turning at `turn` rad/s is right, s.
    #[must_use]
    pub fn turn_s(&self, nearest_m: f64, radius_m: f64, turn: f64) -> f64 {
        let sine = nearest_m * libm::sin(self.angle) / (2.0 * radius_m);
        if turn == 0.0 || sine >= 1.0 || radius_m == 0.0 { f64::INFINITY } else { 2.0 / turn.abs() * libm::asin(sine) }
    }

    /// For how long an object's image is right. A turn of the head never makes it wrong; from inside of the bounding sphere
    /// it is wrong at once.
    #[must_use]
    pub fn period(&self, object: &SeenObject) -> ValidityPeriod {
        let nearest = (object.distance_m - object.radius_m).max(0.0);
        let counted = if self.distance == Distance::Nearest { nearest } else { object.distance_m };
        if nearest == 0.0 {
            return ValidityPeriod { translation_s: 0.0, size_s: 0.0, animation_s: object.animation_s, turn_s: 0.0 };
        }
        ValidityPeriod {
            translation_s: time_of(self.way(counted), object.speed),
            size_s: time_of(self.way_of_size(object.distance_m, object.radius_m), object.speed),
            animation_s: object.animation_s,
            turn_s: self.turn_s(nearest, object.radius_m, object.turn),
        }
    }
}

/// Seconds for a way; for ever at rest.
fn time_of(way_m: f64, speed: f64) -> f64 {
    if speed == 0.0 { f64::INFINITY } else { way_m / speed.abs() }
}

/// The slowest of `memories` in which an image that is right for `period_s` can stay: memory k is drawn every 2^k frames.
#[must_use]
pub fn level(period_s: f64, frame_s: f64, memories: usize) -> usize {
    let rests = |k: &usize| f64::from(1_u32 << k) * frame_s <= period_s;
    (0..memories).take_while(|k| *k == 0 || rests(k)).last().unwrap_or(0)
}
