//! Every number of this crate with unit, source, standing and allowed range. Presets take their values from here.
//!
//! Short names of sources: PF = Polhemus Fastrak manual rev. G; VRPN = notes in UNC's VRPN library; WARD92 = Ward et
//! al., optical ceiling tracker, 1992; TR94 = Cohen and Olano, UNC TR94-028; I3D95 = Olano, Cohen, Mine and Bishop,
//! I3D 1995; A95 = Azuma and Bishop 1995; JITP = Mine and Bishop, UNC TR93-005; LIST83 = List 1983, cited by JITP.

use crate::time::nearest_ps;
use parameters::{ParameterTable, parameter_table};

/// A span of a table in milliseconds, in picoseconds.
pub(crate) fn ms_to_ps(ms: f64) -> u64 {
    nearest_ps(ms / 1e3)
}

/// The numbers of trackers, of the host's port and of predictors, as an experiment may change them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The Polhemus Fastrak, magnetic.
    pub fastrak: Fastrak,
    /// Ascension Flock of Birds.
    pub flock: Flock,
    /// UNC's optical ceiling tracker.
    pub optical: Optical,
    /// The Polhemus 3Space, magnetic.
    pub space: ThreeSpace,
    /// The tracker without error and delay.
    pub ideal: Ideal,
    /// The host's serial port.
    pub host: HostPort,
    /// What prediction filters believe.
    pub filter: Filter,
    /// Which reports are believed.
    pub gate: Gate,
}

impl Tables {
    /// The values that the papers give or allow.
    pub const PAPERS: Self = Self {
        fastrak: Fastrak::PAPERS,
        flock: Flock::PAPERS,
        optical: Optical::PAPERS,
        space: ThreeSpace::PAPERS,
        ideal: Ideal::PAPERS,
        host: HostPort::PAPERS,
        filter: Filter::PAPERS,
        gate: Gate::PAPERS,
    };

    /// All tables with their names.
    pub fn all(&self) -> [(&'static str, &dyn ParameterTable); 8] {
        [
            ("fastrak", &self.fastrak),
            ("flock", &self.flock),
            ("optical", &self.optical),
            ("space", &self.space),
            ("ideal", &self.ideal),
            ("host", &self.host),
            ("filter", &self.filter),
            ("gate", &self.gate),
        ]
    }

    /// The table of that name, to change its numbers; `None` if there is none.
    pub fn named_mut(&mut self, name: &str) -> Option<&mut dyn ParameterTable> {
        Some(match name {
            "fastrak" => &mut self.fastrak,
            "flock" => &mut self.flock,
            "optical" => &mut self.optical,
            "space" => &mut self.space,
            "ideal" => &mut self.ideal,
            "host" => &mut self.host,
            "filter" => &mut self.filter,
            "gate" => &mut self.gate,
            _ => return None,
        })
    }
}

/// Tables of facts with their names: what heads, the measuring rig, the video and the picture of the papers are. No number
/// of them is a setting of a tracked head.
pub const FACTS: [(&str, &dyn ParameterTable); 4] = [
    ("head", &HeadSpeeds::PAPERS),
    ("rig", &RigNumbers::PAPERS),
    ("ntsc", &Ntsc::PAPERS),
    ("view", &HeadMountedView::PAPERS),
];

parameter_table! {
    /// The Polhemus Fastrak, a magnetic tracker.
    pub struct Fastrak {
        /// Fastrak rate over all receivers.
        rate: 120, "Hz", Published, 120..=120 in 1..=10000, "PF";
        /// Fastrak, sync to first character.
        sync_to_output: f64 = 5.5, "ms", Published, 5.5..=5.5 in 0.0..=10000.0, "PF";
        /// Fastrak effective latency, middle of the measurement to first character.
        latency: f64 = 3.75, "ms", Published, 3.75..=5.5 in 0.0..=10000.0, "PF";
        /// Fastrak ASCII record.
        record: 47, "bytes", Published, 8..=200 in 1..=1000, "PF";
        /// Fastrak line rate.
        baud: 115200, "baud", Published, 300..=115200 in 300..=1000000, "PF";
        /// Gain a of the Fastrak's filter x' = a x + (1 - a) x', which adds a delay of dt (1 - a) / a at dt between solutions; 1 is off.
        filter_gain: f64 = 1.0, "1", Assumed, 0.05..=1.0 in 0.000001..=1.0, "PF describes the filter: 4.2 ms of apparent latency at 0.95, 162 ms at 0.05; that it is off is assumed";
        /// Fastrak position noise from report to report, rms of each axis.
        position_noise: f64 = 0.2, "mm", Assumed, 0.0..=0.8 in 0.0..=10000.0, "PF gives none: less than its static accuracy";
        /// Fastrak orientation noise from report to report, rms about each axis.
        orientation_noise: f64 = 0.03, "deg", Assumed, 0.0..=0.15 in 0.0..=90.0, "PF gives none: less than its static accuracy";
        /// Fastrak static accuracy of a position, rms of each axis: a bias, the same in every report of a run.
        position_bias: f64 = 0.8, "mm", Published, 0.0..=2.0 in 0.0..=10000.0, "PF";
        /// Fastrak static accuracy of an orientation, rms about each axis: a bias, the same in every report of a run.
        orientation_bias: f64 = 0.15, "deg", Published, 0.0..=0.5 in 0.0..=90.0, "PF";
    }
}

parameter_table! {
    /// The Ascension Flock of Birds, a magnetic tracker.
    pub struct Flock {
        /// Flock of Birds rate.
        rate: 100, "Hz", Published, 10..=144 in 1..=10000, "VRPN";
        /// Flock of Birds position latency, filters off.
        position_latency: f64 = 7.5, "ms", Published, 7.5..=30.0 in 0.0..=10000.0, "VRPN";
        /// Flock of Birds orientation latency, filters off.
        orientation_latency: f64 = 2.0, "ms", Published, 2.0..=30.0 in 0.0..=10000.0, "VRPN";
        /// Flock of Birds position noise from report to report, rms of each axis.
        position_noise: f64 = 0.5, "mm", Assumed, 0.0..=2.5 in 0.0..=10000.0, "none published: less than the static accuracy";
        /// Flock of Birds orientation noise from report to report, rms about each axis.
        orientation_noise: f64 = 0.1, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "none published: less than the static accuracy";
        /// Flock of Birds static accuracy of a position, rms of each axis: a bias, the same in every report of a run.
        position_bias: f64 = 2.5, "mm", Published, 0.0..=5.0 in 0.0..=10000.0, "Ascension data sheet";
        /// Flock of Birds static accuracy of an orientation, rms about each axis: a bias, the same in every report of a run.
        orientation_bias: f64 = 0.5, "deg", Published, 0.0..=1.0 in 0.0..=90.0, "Ascension data sheet";
        /// Time from the first report to the crash of a patched host with the Flock.
        crash: f64 = 1000.0, "ms", Assumed, 0.0..=600000.0, "TR94 says that it crashes, not when";
    }
}

parameter_table! {
    /// UNC's optical ceiling tracker.
    pub struct Optical {
        /// Optical ceiling tracker rate.
        rate: 60, "Hz", Assumed, 20..=100 in 1..=10000, "WARD92 gives 20-100";
        /// Optical ceiling tracker latency.
        latency: f64 = 33.0, "ms", Published, 20.0..=60.0 in 0.0..=10000.0, "I3D95; WARD92 gives 20-60";
        /// Optical ceiling tracker position noise from report to report, rms of each axis.
        position_noise: f64 = 1.5, "mm", Assumed, 0.6..=2.0 in 0.0..=10000.0, "at most WARD92's resolution of 2 mm, at least 2/sqrt(12); between by the angle's";
        /// Optical ceiling tracker orientation noise from report to report, rms about each axis.
        orientation_noise: f64 = 0.15, "deg", Assumed, 0.06..=0.2 in 0.0..=90.0, "at most WARD92's resolution of 0.2 deg, at least 0.2/sqrt(12); with 0.1 to 0.15 prediction cuts the error 2 to 3 times below 80 ms, as A95 measured on this tracker";
        /// Optical ceiling tracker static error of a position, rms of each axis: a bias, the same in every report of a run.
        position_bias: f64 = 0.0, "mm", Assumed, 0.0..=5.0 in 0.0..=10000.0, "WARD92 gives none; 0 for a calibrated ceiling";
        /// Optical ceiling tracker static error of an orientation, rms about each axis: a bias, the same in every report of a run.
        orientation_bias: f64 = 0.0, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "WARD92 gives none; 0 for a calibrated ceiling";
    }
}

parameter_table! {
    /// The Polhemus 3Space, a magnetic tracker, above a steel floor.
    pub struct ThreeSpace {
        /// 3Space rate over all receivers.
        rate: 60, "Hz", Assumed, 30..=60 in 1..=10000, "usual figure of the product";
        /// 3Space latency.
        latency: f64 = 28.5, "ms", Assumed, 10.0..=90.0 in 0.0..=10000.0, "tens of milliseconds";
        /// 3Space position noise from report to report, rms of each axis.
        position_noise: f64 = 0.5, "mm", Assumed, 0.0..=2.5 in 0.0..=10000.0, "as the Flock";
        /// 3Space orientation noise from report to report, rms about each axis.
        orientation_noise: f64 = 0.1, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "as the Flock";
        /// 3Space static accuracy of a position, rms of each axis: a bias, the same in every report of a run.
        position_bias: f64 = 2.5, "mm", Assumed, 0.0..=5.0 in 0.0..=10000.0, "as the Flock";
        /// 3Space static accuracy of an orientation, rms about each axis: a bias, the same in every report of a run.
        orientation_bias: f64 = 0.5, "deg", Assumed, 0.0..=1.0 in 0.0..=90.0, "as the Flock";
        /// Depth of the bowl that metal makes of a plane, at 1 m from the transmitter.
        bowl: f64 = 20.0, "mm", Assumed, 0.0..=200.0 in 0.0..=1000.0, "TR94 describes the bowl, not its depth";
        /// Distance at which the bowl has half the depth of its parabola.
        bowl_reach: f64 = 2.0, "m", Assumed, 0.5..=10.0 in 0.001..=1000.0, "keeps the error finite out of range";
    }
}

parameter_table! {
    /// The tracker without error and delay.
    pub struct Ideal {
        /// Ideal tracker rate.
        rate: 1000, "Hz", Assumed, 1..=10000 in 1..=10000, "well above all trackers";
    }
}

parameter_table! {
    /// How the host hears of a report.
    pub struct HostPort {
        /// Bits on the line for a byte (start, 8 data, stop).
        byte_bits: 10, "bits", Derived, 10..=11 in 1..=100, "47 x 10 / 115200 = 4.08 ms and / 9600 = 49 ms, the times of PF";
        /// Time between looks of the kernel at the serial line.
        poll: f64 = 30.0, "ms", Published, 1.0..=100.0 in 0.001..=10000.0, "TR94";
    }
}

parameter_table! {
    /// How heads move, by published measurements.
    pub struct HeadSpeeds {
        /// Typical speed of a fast head turn.
        typical_turn: f64 = 200.0, "deg/s", Published, 0.0..=370.0, "JITP, LIST83";
        /// Peak speed of a head turn.
        peak_turn: f64 = 370.0, "deg/s", Published, 200.0..=600.0, "JITP, LIST83";
        /// Mean angular speed of recorded headset traces.
        mean_turn: f64 = 40.0, "deg/s", Published, 40.0..=40.0, "17 minutes of recorded use";
        /// 95th percentile of the angular speed of those traces.
        turn_95: f64 = 114.0, "deg/s", Published, 114.0..=114.0, "17 minutes of recorded use";
        /// 99.9th percentile of the angular speed of those traces.
        turn_999: f64 = 283.0, "deg/s", Published, 283.0..=283.0, "17 minutes of recorded use";
        /// Mean translation speed of those traces.
        mean_translation: f64 = 0.37, "m/s", Published, 0.37..=0.37, "17 minutes of recorded use";
        /// Frequency below which 95 % of the yaw energy lies.
        yaw_energy_95: f64 = 0.14, "Hz", Published, 0.14..=0.14, "17 minutes of recorded use";
        /// Frequency below which practically all yaw energy lies.
        yaw_energy_all: f64 = 2.0, "Hz", Published, 2.0..=2.0, "17 minutes of recorded use";
    }
}

parameter_table! {
    /// The pendulum that measures latency, and what detects its low point.
    pub struct RigNumbers {
        /// Arm of the measuring pendulum.
        pendulum_arm: f64 = 0.5, "m", Assumed, 0.1..=2.0 in 0.001..=1000.0, "TR94 gives none";
        /// Greatest angle of the measuring pendulum.
        pendulum_amplitude: f64 = 20.0, "deg", Assumed, 1.0..=90.0 in 0.001..=179.0, "TR94 gives none";
        /// Standard gravity.
        gravity: f64 = 9.80665, "m/s^2", Published, 9.78..=9.84, "CGPM 1901";
        /// Width of the LED's beam at the pendulum.
        led_beam: f64 = 2.0, "mm", Assumed, 0.1..=20.0, "TR94 gives none";
        /// Visible line of the screen under the photodiode.
        photodiode_line: 120, "lines", Assumed, 0..=239, "middle of a 240-line field; TR94 gives none";
    }
}

parameter_table! {
    /// The video that heads look at.
    pub struct Ntsc {
        /// Time from one vertical retrace to the next.
        field: f64 = 16.683333333333334, "ms", Published, 16.68..=16.69, "NTSC, 1001/60000 s";
        /// Time from one scanline to the next.
        line: f64 = 63.55555555555556, "us", Published, 63.55..=63.56, "NTSC, 4004/63 us";
    }
}

parameter_table! {
    /// The picture of a head-mounted display.
    pub struct HeadMountedView {
        /// Width of the head-mounted display.
        width: 640, "px", Published, 1..=16384, "TR94";
        /// Height of the head-mounted display.
        height: 480, "px", Published, 1..=16384, "TR94";
        /// Horizontal angle of view.
        horizontal_angle: f64 = 60.0, "deg", Published, 1.0..=170.0, "JITP";
    }
}

parameter_table! {
    /// What the prediction filters believe.
    pub struct Filter {
        /// White jerk of the position filter, root of its spectral density.
        position_jerk: f64 = 0.4, "m/s^3/sqrt(Hz)", Assumed, 0.01..=1000.0 in 0.000001..=1000000.0, "least mean error 50 ms ahead, flat from 0.2 to 0.6; used where the filter is not tuned";
        /// White jerk of the orientation filter, root of its spectral density.
        orientation_jerk: f64 = 14.0, "rad/s^3/sqrt(Hz)", Assumed, 0.1..=10000.0 in 0.000001..=1000000.0, "least mean error 50 ms ahead, flat from 10 to 20; used where the filter is not tuned";
        /// Standard deviation of the speed at the start of a filter.
        start_speed: f64 = 1.0, "m/s", Assumed, 0.01..=10.0 in 0.000001..=1000.0, "above the mean translation speed";
        /// Standard deviation of the acceleration at the start of a filter.
        start_acceleration: f64 = 5.0, "m/s^2", Assumed, 0.01..=100.0 in 0.000001..=10000.0, "half of gravity";
        /// Standard deviation of the angular velocity at the start of a filter.
        start_turn: f64 = 2.0, "rad/s", Assumed, 0.01..=20.0 in 0.000001..=1000.0, "the 95th percentile of recorded traces";
        /// Standard deviation of the angular acceleration at the start of a filter.
        start_turn_acceleration: f64 = 20.0, "rad/s^2", Assumed, 0.01..=1000.0 in 0.000001..=100000.0, "100 ms to reach the above";
        /// Reports between the points of a difference (1 takes neighbours).
        baseline: 4, "reports", Assumed, 1..=16, "noise of the velocity falls with it, delay rises";
        /// Longest prediction; beyond it the last pose is given.
        horizon: f64 = 500.0, "ms", Assumed, 1.0..=10000.0, "2.5 times the longest measured prediction";
    }
}

parameter_table! {
    /// Which reports are believed.
    pub struct Gate {
        /// Fastest believable translation.
        speed: f64 = 8.0, "m/s", Assumed, 1.0..=100.0, "20 times the mean of recorded traces";
        /// Fastest believable turn.
        turn: f64 = 1000.0, "deg/s", Assumed, 370.0..=10000.0, "2.7 times the peak of LIST83";
        /// Distance that noise alone may jump.
        distance: f64 = 30.0, "mm", Assumed, 1.0..=1000.0, "40 standard deviations of a difference of two Flock reports, or 8 of one whose bias were noise";
        /// Angle that noise alone may jump.
        angle: f64 = 6.0, "deg", Assumed, 0.1..=90.0, "40 standard deviations of a difference of two Flock reports, or 8 of one whose bias were noise";
        /// Rejected jumps in a row after which the new place is believed.
        patience: 5, "reports", Assumed, 1..=100, "42 ms at 120 Hz";
        /// Silence after which velocities are forgotten.
        gap: f64 = 250.0, "ms", Assumed, 10.0..=10000.0, "30 reports at 120 Hz; longer than any planned prediction";
        /// Least time between two reports.
        interval: f64 = 0.05, "ms", Assumed, 0.0..=1.0, "half the period of the fastest rate of a tracker";
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_lies_in_its_range() {
        for (name, table) in Tables::PAPERS.all().into_iter().chain(FACTS) {
            assert_eq!(table.out_of_range(), [], "{name}");
        }
    }

    #[test]
    fn every_parameter_names_unit_and_source() {
        let tables = Tables::PAPERS.all().into_iter().chain(FACTS);
        let infos = tables.flat_map(|(_, table)| table.infos());
        assert!(infos.into_iter().all(|info| !info.unit.is_empty() && !info.source.is_empty()));
    }

    #[test]
    fn milliseconds_become_whole_picoseconds() {
        assert_eq!(ms_to_ps(Fastrak::PAPERS.latency), 3_750_000_000);
    }
}
