use crate::tracker::TrackerReport;

/// How the host finds the low point in the bob's positions. The paper does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detection {
    /// The bob has passed the vertical. It is seen by the first report after the low point, 0 to 1 report late, and
    /// noise of a millimetre hardly matters, since the bob is at its fastest.
    Crossing,
    /// The vertical velocity, a difference of two reports, has turned from down to up: half a report to one and a half
    /// late. The arc is flat there, so even 0.1 mm of noise gives wrong low points: for noiseless trackers.
    VelocitySign,
}

impl Detection {
    /// How late, at most, the low point is seen, in halves of a report interval.
    pub(super) fn half_intervals_late(self) -> u64 {
        match self {
            Self::Crossing => 2,
            Self::VelocitySign => 3,
        }
    }

    pub(super) fn start(self, dead_ps: u64) -> Detector {
        Detector { how: self, dead_ps, dead_until_ps: 0, last: None }
    }
}

/// Follows the reports. After a low point it is deaf for a quarter of a swing.
#[derive(Clone, Debug)]
pub(super) struct Detector {
    how: Detection,
    dead_ps: u64,
    dead_until_ps: u64,
    /// Sign (true is positive) and height of the last report.
    last: Option<(bool, f64)>,
}

impl Detector {
    pub(super) fn sees_low_point(&mut self, report: &TrackerReport) -> bool {
        if !report.pose.is_finite() {
            return false;
        }
        let x = report.pose.position.x;
        let height = report.pose.position.y;
        let positive = match self.how {
            Detection::Crossing => x > 0.0,
            Detection::VelocitySign => self.last.is_some_and(|(_, last)| height > last),
        };
        let before = self.last.replace((positive, height));
        let turned = match (self.how, before) {
            (_, None) => false,
            (Detection::Crossing, Some((was, _))) => was != positive,
            (Detection::VelocitySign, Some((was, _))) => !was && positive,
        };
        let seen = turned && report.measured_ps >= self.dead_until_ps;
        if seen {
            self.dead_until_ps = report.measured_ps + self.dead_ps;
        }
        seen
    }
}
