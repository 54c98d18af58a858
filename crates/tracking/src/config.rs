//! Every number of this crate, with unit, source, provenance and allowed range. The presets take their values from
//! these tables.
//!
//! Short names of sources:
//!
//! - PF: Polhemus Fastrak manual, revision G.
//! - VRPN: notes in UNC's VRPN library.
//! - WARD92: Ward et al., optical ceiling tracker, 1992.
//! - TR94: Cohen and Olano, UNC TR94-028.
//! - I3D95: Olano, Cohen, Mine and Bishop, I3D 1995.
//! - A95: Azuma and Bishop 1995.
//! - JITP: Mine and Bishop, UNC TR93-005.
//! - LIST83: List 1983, cited by JITP.

use crate::time::nearest_ps;
use pxpl5_sim::parameters::{ParameterTable, parameter_table};

pub(crate) fn ms_to_ps(ms: f64) -> u64 {
    nearest_ps(ms / 1e3)
}

/// The adjustable numbers of the trackers, the host's serial port and the prediction filters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tables {
    /// Numbers of the Polhemus Fastrak, a magnetic tracker.
    pub fastrak: Fastrak,
    /// Numbers of the Ascension Flock of Birds, a magnetic tracker.
    pub flock: Flock,
    /// Numbers of UNC's optical ceiling tracker.
    pub optical: Optical,
    /// Numbers of the Polhemus 3Space, a magnetic tracker.
    pub space: ThreeSpace,
    /// Numbers of an ideal tracker without error and delay.
    pub ideal: Ideal,
    /// Numbers of the host's serial port.
    pub host: HostPort,
    /// Assumptions of the prediction filters about noise and motion.
    pub filter: Filter,
    /// Limits by which the predictors accept or reject reports.
    pub gate: Gate,
}

impl Tables {
    /// The papers' values. Where no paper gives a value, the number is an assumption.
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

    /// Returns every parameter table with the name of the table.
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

    /// Returns the table called `name`, so that its numbers can be changed. Returns `None` if no table has this name.
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

/// Tables of numbers without keys `tracking.*`, with the names of the tables. The tables have head speeds, the pendulum
/// rig that measures latency, NTSC video, and the head-mounted display of the papers. The keys `hmd.*` and `display`
/// change the head-mounted display of an experiment.
pub const FACTS: [(&str, &dyn ParameterTable); 4] = [
    ("head", &HeadSpeeds::PAPERS),
    ("rig", &RigNumbers::PAPERS),
    ("ntsc", &Ntsc::PAPERS),
    ("view", &HeadMountedView::PAPERS),
];

parameter_table! {
    /// The Polhemus Fastrak, a magnetic tracker.
    pub struct Fastrak {
        /// Number of measurements that the Fastrak makes per second. All receivers share these measurements.
        rate: 120, "Hz", Published, 120..=120 in 1..=10000, "PF";
        /// Time from the Fastrak's sync signal to the first character on the serial cable.
        sync_to_output: f64 = 5.5, "ms", Published, 5.5..=5.5 in 0.0..=10000.0, "PF";
        /// Effective latency of the Fastrak, from the middle of the measurement to the first character on the serial
        /// cable.
        latency: f64 = 3.75, "ms", Published, 3.75..=5.5 in 0.0..=10000.0, "PF";
        /// Length of the text that the Fastrak sends for one measurement.
        record: 47, "bytes", Published, 8..=200 in 1..=1000, "PF";
        /// Rate of the Fastrak's serial cable.
        baud: 115200, "baud", Published, 300..=115200 in 300..=1000000, "PF";
        /// Gain a of the Fastrak's low-pass filter, which replaces its output x' by a x + (1 - a) x' at each
        /// measurement x. The filter adds a delay of dt (1 - a) / a, where dt is the time between measurements. A gain
        /// of 1 turns the filter off.
        filter_gain: f64 = 1.0, "1", Assumed, 0.05..=1.0 in 0.000001..=1.0, "PF describes the filter, with an apparent latency of 4.2 ms at 0.95 and of 162 ms at 0.05; the project assumes that the filter is off";
        /// Random position error of the Fastrak that changes with each report, rms along each axis.
        position_noise: f64 = 0.2, "mm", Assumed, 0.0..=0.8 in 0.0..=10000.0, "PF gives no value; assumed below the tracker's static accuracy";
        /// Random orientation error of the Fastrak that changes with each report, rms about each axis.
        orientation_noise: f64 = 0.03, "deg", Assumed, 0.0..=0.15 in 0.0..=90.0, "PF gives no value; assumed below the tracker's static accuracy";
        /// Constant position error of the Fastrak. Each run draws the error once from its seed. The value is the root
        /// mean square along each axis, over all seeds.
        position_bias: f64 = 0.8, "mm", Published, 0.0..=2.0 in 0.0..=10000.0, "PF";
        /// Constant orientation error of the Fastrak. Each run draws the error once from its seed. The value is the
        /// root mean square about each axis, over all seeds.
        orientation_bias: f64 = 0.15, "deg", Published, 0.0..=0.5 in 0.0..=90.0, "PF";
        /// Position error that metal in the floor causes at 1 m from the Fastrak's transmitter, as for the 3Space.
        bowl: f64 = 20.0, "mm", Assumed, 0.0..=200.0 in 0.0..=1000.0, "TR94 describes the bowl of both Polhemus trackers, not its depth";
        /// Distance from the Fastrak's transmitter at which the error by metal is half of `bowl` times the squared
        /// distance in metres.
        bowl_reach: f64 = 2.0, "m", Assumed, 0.5..=10.0 in 0.001..=1000.0, "keeps the error finite out of range";
    }
}

parameter_table! {
    /// The Ascension Flock of Birds, a magnetic tracker.
    pub struct Flock {
        /// Measurement rate of the Flock of Birds.
        rate: 100, "Hz", Published, 10..=144 in 1..=10000, "VRPN";
        /// Position latency of the Flock of Birds with its filters off.
        position_latency: f64 = 7.5, "ms", Published, 7.5..=30.0 in 0.0..=10000.0, "VRPN";
        /// Orientation latency of the Flock of Birds with its filters off.
        orientation_latency: f64 = 2.0, "ms", Published, 2.0..=30.0 in 0.0..=10000.0, "VRPN";
        /// Random position error of the Flock of Birds that changes with each report, rms along each axis.
        position_noise: f64 = 0.5, "mm", Assumed, 0.0..=2.5 in 0.0..=10000.0, "none published: less than the static accuracy";
        /// Random orientation error of the Flock of Birds that changes with each report, rms about each axis.
        orientation_noise: f64 = 0.1, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "none published: less than the static accuracy";
        /// Constant position error of the Flock of Birds. Each run draws the error once from its seed. The value is the
        /// root mean square along each axis, over all seeds.
        position_bias: f64 = 2.5, "mm", Published, 0.0..=5.0 in 0.0..=10000.0, "Ascension data sheet";
        /// Constant orientation error of the Flock of Birds. Each run draws the error once from its seed. The value is
        /// the root mean square about each axis, over all seeds.
        orientation_bias: f64 = 0.5, "deg", Published, 0.0..=1.0 in 0.0..=90.0, "Ascension data sheet";
        /// Time from the first report of a Flock of Birds to the crash of the host. Only a host whose Unix kernel is
        /// patched to receive every character at once crashes.
        crash: f64 = 1000.0, "ms", Assumed, 0.0..=600000.0, "TR94 says that it crashes, not when";
    }
}

parameter_table! {
    /// UNC's optical ceiling tracker.
    pub struct Optical {
        /// Measurement rate of the optical ceiling tracker.
        rate: 60, "Hz", Assumed, 20..=100 in 1..=10000, "WARD92 gives 20-100";
        /// Latency of the optical ceiling tracker, from the measurement to the output of its report.
        latency: f64 = 33.0, "ms", Published, 20.0..=60.0 in 0.0..=10000.0, "I3D95; WARD92 gives 20-60";
        /// Random position error of the optical ceiling tracker that changes with each report, rms along each axis.
        position_noise: f64 = 1.5, "mm", Assumed, 0.6..=2.0 in 0.0..=10000.0, "at most WARD92's resolution of 2 mm, at least 2/sqrt(12); between by the angle's";
        /// Random orientation error of the optical ceiling tracker that changes with each report, rms about each axis.
        orientation_noise: f64 = 0.15, "deg", Assumed, 0.06..=0.2 in 0.0..=90.0, "at most WARD92's resolution of 0.2 deg, at least 0.2/sqrt(12); with 0.1 to 0.15 prediction cuts the error 2 to 3 times below 80 ms, as A95 measured on this tracker";
        /// Constant position error of the optical ceiling tracker. Each run draws the error once from its seed. The
        /// value is the root mean square along each axis, over all seeds.
        position_bias: f64 = 0.0, "mm", Assumed, 0.0..=5.0 in 0.0..=10000.0, "WARD92 gives none; 0 for a calibrated ceiling";
        /// Constant orientation error of the optical ceiling tracker. Each run draws the error once from its seed. The
        /// value is the root mean square about each axis, over all seeds.
        orientation_bias: f64 = 0.0, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "WARD92 gives none; 0 for a calibrated ceiling";
    }
}

parameter_table! {
    /// The Polhemus 3Space, a magnetic tracker, above a steel floor.
    pub struct ThreeSpace {
        /// Number of measurements that the 3Space makes per second. All receivers share these measurements.
        rate: 60, "Hz", Assumed, 30..=60 in 1..=10000, "usual figure of the product";
        /// Latency of the 3Space, from measurement to output.
        latency: f64 = 28.5, "ms", Assumed, 10.0..=90.0 in 0.0..=10000.0, "tens of milliseconds";
        /// Random position error of the 3Space that changes with each report, rms along each axis.
        position_noise: f64 = 0.5, "mm", Assumed, 0.0..=2.5 in 0.0..=10000.0, "as the Flock";
        /// Random orientation error of the 3Space that changes with each report, rms about each axis.
        orientation_noise: f64 = 0.1, "deg", Assumed, 0.0..=0.5 in 0.0..=90.0, "as the Flock";
        /// Constant position error of the 3Space. Each run draws the error once from its seed. The value is the root
        /// mean square along each axis, over all seeds.
        position_bias: f64 = 2.5, "mm", Assumed, 0.0..=5.0 in 0.0..=10000.0, "as the Flock";
        /// Constant orientation error of the 3Space. Each run draws the error once from its seed. The value is the root
        /// mean square about each axis, over all seeds.
        orientation_bias: f64 = 0.5, "deg", Assumed, 0.0..=1.0 in 0.0..=90.0, "as the Flock";
        /// Position error that metal in the floor causes at 1 m from the transmitter. With this error, measured
        /// positions on a flat surface form a bowl.
        bowl: f64 = 20.0, "mm", Assumed, 0.0..=200.0 in 0.0..=1000.0, "TR94 describes the bowl of both Polhemus trackers, not its depth";
        /// Distance from the transmitter at which the position error by metal is half of `bowl` times the squared
        /// distance in metres. Much farther away, the error is nearly constant.
        bowl_reach: f64 = 2.0, "m", Assumed, 0.5..=10.0 in 0.001..=1000.0, "keeps the error finite out of range";
    }
}

parameter_table! {
    /// An ideal tracker without error and delay.
    pub struct Ideal {
        /// Measurement rate of the ideal tracker.
        rate: 1000, "Hz", Assumed, 1..=10000 in 1..=10000, "well above all trackers";
    }
}

parameter_table! {
    /// The host's serial port, through which a report reaches the program.
    pub struct HostPort {
        /// Bits on the serial cable for each byte: start bit, 8 data bits, stop bit.
        byte_bits: 10, "bits", Derived, 10..=11 in 1..=100, "47 x 10 / 115200 = 4.08 ms and / 9600 = 49 ms, the times of PF";
        /// Interval at which the host's Unix kernel polls the serial port.
        poll: f64 = 30.0, "ms", Published, 1.0..=100.0 in 0.001..=10000.0, "TR94";
    }
}

parameter_table! {
    /// Published measurements of head motion.
    pub struct HeadSpeeds {
        /// Typical speed of a fast head turn.
        typical_turn: f64 = 200.0, "deg/s", Published, 0.0..=370.0, "JITP, LIST83";
        /// Peak speed of a head turn.
        peak_turn: f64 = 370.0, "deg/s", Published, 200.0..=600.0, "JITP, LIST83";
        /// Mean angular speed of the head in recorded traces of headset use.
        mean_turn: f64 = 40.0, "deg/s", Published, 40.0..=40.0, "17 minutes of recorded use";
        /// 95th percentile of the head's angular speed in recorded traces of headset use.
        turn_95: f64 = 114.0, "deg/s", Published, 114.0..=114.0, "17 minutes of recorded use";
        /// 99.9th percentile of the head's angular speed in recorded traces of headset use.
        turn_999: f64 = 283.0, "deg/s", Published, 283.0..=283.0, "17 minutes of recorded use";
        /// Mean translation speed of the head in recorded traces of headset use.
        mean_translation: f64 = 0.37, "m/s", Published, 0.37..=0.37, "17 minutes of recorded use";
        /// Frequency below which 95 % of the energy of a head's yaw lies.
        yaw_energy_95: f64 = 0.14, "Hz", Published, 0.14..=0.14, "17 minutes of recorded use";
        /// Frequency below which practically all energy of a head's yaw lies.
        yaw_energy_all: f64 = 2.0, "Hz", Published, 2.0..=2.0, "17 minutes of recorded use";
    }
}

parameter_table! {
    /// The pendulum rig that measures latency. Light detectors show the instants at which the pendulum passes its low
    /// point.
    pub struct RigNumbers {
        /// Length of the pendulum's arm.
        pendulum_arm: f64 = 0.5, "m", Assumed, 0.1..=2.0 in 0.001..=1000.0, "I3D95 gives none";
        /// Greatest angle of the pendulum from the vertical.
        pendulum_amplitude: f64 = 20.0, "deg", Assumed, 1.0..=90.0 in 0.001..=179.0, "I3D95 gives none";
        /// Standard gravity.
        gravity: f64 = 9.80665, "m/s^2", Published, 9.78..=9.84, "CGPM 1901";
        /// Width of the light beam at the pendulum. The LED's beam is interrupted when the pendulum passes its low
        /// point.
        led_beam: f64 = 2.0, "mm", Assumed, 0.1..=20.0, "I3D95 gives none";
        /// Index of the visible scanline that the photodiode on the screen covers.
        photodiode_line: 120, "lines", Assumed, 0..=239, "middle of a 240-line field; I3D95 gives none";
    }
}

parameter_table! {
    /// NTSC video timing of the displays that a viewer sees.
    pub struct Ntsc {
        /// Time from one vertical retrace to the next.
        field: f64 = 16.683333333333334, "ms", Published, 16.68..=16.69, "NTSC, 1001/60000 s";
        /// Time from one scanline to the next.
        line: f64 = 63.55555555555556, "us", Published, 63.55..=63.56, "NTSC, 4004/63 us";
    }
}

parameter_table! {
    /// The pictures and the eyes of the papers' head-mounted display. An experiment changes these numbers with its keys
    /// `hmd` and `display`.
    pub struct HeadMountedView {
        /// Distance between the viewer's eyes.
        eye_separation_m: f64 = 0.064, "m", Assumed, 0.054..=0.074 in 0.0..=1.0, "mean of adults";
        /// Angle between the left and the right edge of an eye's picture.
        horizontal_fov_deg: f64 = 60.0, "deg", Assumed, 30.0..=100.0 in 1.0..=170.0, "published in JITP's example";
        /// Number of pixels across a picture. Pixels are square.
        width_px: 640, "px", Published, 640..=640 in 1..=65536, "TR94";
        /// Number of pixels from the top to the bottom of a picture.
        height_px: 480, "px", Published, 480..=480 in 1..=65536, "TR94";
        /// Distance from the eye to the plane in front of which nothing is drawn.
        near_m: f64 = 0.05, "m", Assumed, 0.01..=0.3 in 0.000001..=1000000.0, "nearer than a hand";
        /// Distance from the eye to the plane behind which nothing is drawn.
        far_m: f64 = 50.0, "m", Assumed, 10.0..=1000.0 in 0.000001..=1000000000.0, "24 bits of depth give steps of 1.2 um at 1 m";
    }
}

parameter_table! {
    /// Assumptions of the prediction filters about noise and motion.
    pub struct Filter {
        /// Strength of random changes of the head's acceleration, as the position filter assumes it. The filter treats
        /// jerk (the change of acceleration) as white noise. The value is the root of the spectral density of this
        /// noise.
        position_jerk: f64 = 0.4, "m/s^3/sqrt(Hz)", Assumed, 0.01..=1000.0 in 0.000001..=1000000.0, "least mean error 50 ms ahead, flat from 0.2 to 0.6; used where the filter is not tuned";
        /// Strength of random changes of the head's angular acceleration, as the orientation filter assumes it. The
        /// filter treats angular jerk as white noise. The value is the root of the spectral density of this noise.
        orientation_jerk: f64 = 14.0, "rad/s^3/sqrt(Hz)", Assumed, 0.1..=10000.0 in 0.000001..=1000000.0, "least mean error 50 ms ahead, flat from 10 to 20; used where the filter is not tuned";
        /// Rate at which the position filter lets the head's velocity decay (Singer 1970). 0 keeps it.
        velocity_decay: f64 = 0.0, "1/s", Assumed, 0.0..=1000.0 in 0.0..=1000.0, "0 where the filter is not tuned";
        /// Rate at which the position filter lets the head's acceleration decay. 0 keeps it.
        acceleration_decay: f64 = 0.0, "1/s", Assumed, 0.0..=1000.0 in 0.0..=1000.0, "0 where the filter is not tuned";
        /// Rate at which the orientation filter lets the head's angular velocity decay. 0 keeps it.
        turn_decay: f64 = 0.0, "1/s", Assumed, 0.0..=1000.0 in 0.0..=1000.0, "0 where the filter is not tuned";
        /// Rate at which the orientation filter lets the head's angular acceleration decay. 0 keeps it.
        turn_acceleration_decay: f64 = 0.0, "1/s", Assumed, 0.0..=1000.0 in 0.0..=1000.0, "0 where the filter is not tuned";
        /// Standard deviation that a filter assumes for the head's speed before the first report.
        start_speed: f64 = 1.0, "m/s", Assumed, 0.01..=10.0 in 0.000001..=1000.0, "above the mean translation speed";
        /// Standard deviation that a filter assumes for the head's acceleration before the first report.
        start_acceleration: f64 = 5.0, "m/s^2", Assumed, 0.01..=100.0 in 0.000001..=10000.0, "half of gravity";
        /// Standard deviation that a filter assumes for the head's angular velocity before the first report.
        start_turn: f64 = 2.0, "rad/s", Assumed, 0.01..=20.0 in 0.000001..=1000.0, "the 95th percentile of recorded traces";
        /// Standard deviation that a filter assumes for the head's angular acceleration before the first report.
        start_turn_acceleration: f64 = 20.0, "rad/s^2", Assumed, 0.01..=1000.0 in 0.000001..=100000.0, "100 ms to reach the above";
        /// Number of reports from the older to the newer of the two poses whose difference gives a velocity. With 1,
        /// the two poses are from successive reports.
        baseline: 4, "reports", Assumed, 1..=16, "noise of the velocity falls with it, delay rises";
        /// Longest time for which a predictor extrapolates, forwards or backwards from the newest measurement. For other
        /// instants the predictor returns its estimate for the instant of the newest measurement.
        horizon: f64 = 500.0, "ms", Assumed, 1.0..=10000.0, "2.5 times the longest measured prediction";
    }
}

parameter_table! {
    /// Limits by which a predictor accepts or rejects reports.
    pub struct Gate {
        /// Fastest translation of the head that a predictor accepts. A report that implies a faster translation is
        /// rejected.
        speed: f64 = 8.0, "m/s", Assumed, 1.0..=100.0, "20 times the mean of recorded traces";
        /// Fastest turn of the head that a predictor accepts. A report that implies a faster turn is rejected.
        turn: f64 = 1000.0, "deg/s", Assumed, 370.0..=10000.0, "2.7 times the peak of LIST83";
        /// Greatest distance between two successive reported positions of a still head, caused by noise. The predictor
        /// subtracts this value from the reported distance before it compares the speed with the limit `speed`.
        distance: f64 = 30.0, "mm", Assumed, 1.0..=1000.0, "40 standard deviations of a difference of two Flock reports, or 8 of one whose bias were noise";
        /// Greatest angle between two successive reported orientations of a still head, caused by noise. The predictor
        /// subtracts this value from the reported angle before it compares the turn with the limit `turn`.
        angle: f64 = 6.0, "deg", Assumed, 0.1..=90.0, "40 standard deviations of a difference of two Flock reports, or 8 of one whose bias were noise";
        /// Number of successive reports that a predictor rejects after a jump of the pose. The predictor accepts the
        /// pose of the next report and restarts.
        patience: 5, "reports", Assumed, 1..=100, "42 ms at 120 Hz";
        /// Time without reports after which a filter restarts with unknown velocities.
        gap: f64 = 250.0, "ms", Assumed, 10.0..=10000.0, "30 reports at 120 Hz; longer than any planned prediction";
        /// Least time between two accepted reports. A report that follows sooner is rejected.
        interval: f64 = 0.05, "ms", Assumed, 0.0..=1.0, "half the period of the fastest rate of a tracker";
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_published_tracking_value_is_in_its_range() {
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
