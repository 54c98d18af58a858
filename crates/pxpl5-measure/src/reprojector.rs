//! Poses to which a device moves pictures. Each part of a scan (field, strip or line) has its own newest pose.

use crate::rows::Rows;
use pxpl5_run::{Cause, Estimator, Every, HeadViews, Reprojection};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::{Display, ScanOrder};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;
use tracking::Pose;

#[derive(Clone, Copy, Debug)]
pub(crate) struct NewestPose {
    /// Pose of the head, predicted for the middle of the time in which the part of the scan is lit.
    pub(crate) pose: Pose,
    /// Time at which the tracker measured the newest report from which the pose was computed. `None` before the first
    /// report.
    pub(crate) measured_at: Option<Time>,
}

/// A source of the newest head pose for each part of a scan: a field, a strip or a line.
pub(crate) struct Reprojector {
    pub(crate) setting: Reprojection,
    estimator: Estimator,
    head: Arc<HeadViews>,
    poses: BTreeMap<u32, NewestPose>,
}

impl fmt::Debug for Reprojector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reprojector").field("setting", &self.setting).finish_non_exhaustive()
    }
}

impl Reprojector {
    pub(crate) fn new(head: &Arc<HeadViews>, setting: Reprojection, without: Option<Cause>) -> Self {
        let estimator = Estimator::new(head, without);
        Self { setting, estimator, head: Arc::clone(head), poses: BTreeMap::new() }
    }

    /// Determines the poses of a field's parts that contain any of the pixels `places`. Fields must come in ascending
    /// order.
    pub(crate) fn begin(&mut self, display: &dyn Display, field: PeriodNumber, places: impl Iterator<Item = [u32; 2]>) {
        let parts: BTreeSet<u32> = places.map(|place| part(display, self.setting.every, place)).collect();
        let light = |part: u32| Some((part, lit(display, self.setting.every, part, field)?));
        let mut lit: Vec<_> = parts.into_iter().filter_map(light).collect();
        // A predictor follows reports in the order of their arrival.
        lit.sort_by_key(|(_, (first, _))| *first);
        let latency = Span::from_us(self.setting.latency_us);
        let centre = display.light().centre();
        self.poses.clear();
        for (part, (first, last)) in lit {
            let reports_until = Time(first.0.saturating_sub(latency.0));
            let aim = Time(first.0.midpoint(last.0)) + centre;
            let report = self.head.report_by(reports_until);
            let measured_at = report.and_then(|arrived| self.head.measured_at(arrived));
            self.poses.insert(part, NewestPose { pose: self.estimator.pose(reports_until, aim), measured_at });
        }
    }

    /// Returns the newest pose of the part that contains a pixel. Returns `None` if no pixel of this part was among the
    /// pixels of the last call of `begin`.
    pub(crate) fn newest(&self, display: &dyn Display, place: [u32; 2]) -> Option<&NewestPose> {
        self.poses.get(&part(display, self.setting.every, place))
    }
}

/// Returns the index of the part of a scan that contains a pixel. `every` is the kind of parts: field, strip or line.
fn part(display: &dyn Display, every: Every, [x, y]: [u32; 2]) -> u32 {
    let along = match display.light().scan {
        ScanOrder::Down | ScanOrder::Up => y,
        ScanOrder::Right | ScanOrder::Left => x,
        ScanOrder::Global => return 0,
    };
    match every {
        Every::Field => 0,
        Every::Strip => along / Every::STRIP,
        Every::Line => along,
    }
}

/// Returns the times at which the first and the last pixel of a part of a scan are lit. `None` if no pixel is lit.
fn lit(display: &dyn Display, every: Every, part: u32, field: PeriodNumber) -> Option<(Time, Time)> {
    let surface = display.surfaces().first()?;
    let size = [surface.width, surface.height];
    let scan = display.light().scan;
    // First and last line of the part, counted in the direction of the scan.
    let [from, to] = match every {
        Every::Strip if scan != ScanOrder::Global => [part * Every::STRIP, (part + 1) * Every::STRIP - 1],
        Every::Line if scan != ScanOrder::Global => [part; 2],
        _ => [0, u32::MAX],
    };
    let sideways = matches!(scan, ScanOrder::Right | ScanOrder::Left);
    let whole = [0, u32::MAX];
    let [xs, ys] = if sideways { [[from, to], whole] } else { [whole, [from, to]] };
    let rows = Rows::lit(display, field);
    // A scan lights pixels monotonically, so the corners of the part have the first and the last light.
    let corners = xs.into_iter().flat_map(|x| ys.into_iter().map(move |y| [x.min(size[0] - 1), y.min(size[1] - 1)]));
    let lights = corners.filter_map(|[x, y]| display.lights(0, x, rows.beside(y), field));
    let all: Vec<Time> = lights.collect();
    Some((*all.iter().min()?, *all.iter().max()?))
}
