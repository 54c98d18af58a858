use crate::tracker::TrackerReport;

/// The method by which the host detects that the pendulum passes its lowest point, from the reported positions. I3D95
/// does not state the method that was used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detection {
    /// The host detects that the pendulum has crossed the vertical. The first report after the lowest point shows the
    /// crossing, at most one report interval late. Noise of a millimetre has little effect, because the pendulum is
    /// fastest at its lowest point.
    Crossing,
    /// The host detects that the vertical velocity has turned from down to up. The velocity is a difference of two
    /// reports, so the detection is half to one and a half report intervals late. The arc is flat at the lowest point,
    /// so even 0.1 mm of noise causes wrong detections. This method suits trackers without noise.
    VelocitySign,
}

impl Detection {
    pub(super) fn greatest_delay_half_intervals(self) -> u64 {
        match self {
            Self::Crossing => 2,
            Self::VelocitySign => 3,
        }
    }

    pub(super) fn start(self, dead_ps: u64) -> Detector {
        Detector { how: self, dead_ps, dead_until_ps: 0, last: None }
    }
}

/// A detector of the pendulum's passes through its lowest point in a sequence of reports. For a quarter of a swing
/// after each detected pass, the detector ignores passes, because noise could cause them.
#[derive(Clone, Debug)]
pub(super) struct Detector {
    how: Detection,
    dead_ps: u64,
    dead_until_ps: u64,
    /// A sign and the height of the pendulum, both from the last report. The sign is `true` for a positive x
    /// ([`Detection::Crossing`]) or an upward movement ([`Detection::VelocitySign`]).
    last: Option<(bool, f64)>,
}

impl Detector {
    pub(super) fn detects_low_point(&mut self, report: &TrackerReport) -> bool {
        if !report.pose.is_finite() {
            return false;
        }
        // A crossing changes the sign of x. The velocity method compares the height with the height in the last report.
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
        // Noise near the low point could trigger again, so a dead time follows each detection.
        let seen = turned && report.measured_ps >= self.dead_until_ps;
        if seen {
            self.dead_until_ps = report.measured_ps + self.dead_ps;
        }
        seen
    }
}
