//! Every number of this crate with unit, source, standing and allowed range. Presets take their values from here.
//!
//! Short names of sources: PF = Polhemus Fastrak manual rev. G; VRPN = notes in UNC's VRPN library; WARD92 = Ward et
//! al., optical ceiling tracker, 1992; TR94 = Cohen and Olano, UNC TR94-028; I3D95 = Olano, Cohen, Mine and Bishop,
//! I3D 1995; JITP = Mine and Bishop, UNC TR93-005; LIST83 = List 1983, cited by JITP.

/// How far a number can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Printed in a paper or manual.
    Published,
    /// Follows by arithmetic from published figures.
    Derived,
    /// Engineering judgement; the range says what the published figures allow.
    Assumed,
}

/// One number of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// What it is.
    pub name: &'static str,
    /// Default value.
    pub value: f64,
    /// Unit of value and range.
    pub unit: &'static str,
    /// Paper, manual or formula.
    pub source: &'static str,
    /// Trust.
    pub standing: Standing,
    /// Least and greatest sensible value.
    pub range: (f64, f64),
}

impl Parameter {
    /// The value of a parameter in milliseconds, in picoseconds.
    pub(crate) fn ms_to_ps(&self) -> u64 {
        crate::time::nearest_ps(self.value / 1e3)
    }
}

macro_rules! parameters {
    ($($id:ident = $name:literal, $value:literal $unit:literal, $standing:ident $source:literal, $low:literal..$high:literal;)*) => {
        $(
            #[doc = concat!($name, ": ", stringify!($value), " ", $unit, " (", $source, ").")]
            pub const $id: Parameter = Parameter {
                name: $name, value: $value, unit: $unit, source: $source,
                standing: Standing::$standing, range: ($low, $high),
            };
        )*
        /// All of them, in the order of this file.
        pub const TABLE: &[Parameter] = &[$($id),*];
    };
}

parameters! {
    FASTRAK_RATE = "Fastrak rate over all receivers", 120.0 "Hz", Published "PF", 120.0..120.0;
    FASTRAK_SYNC_TO_OUTPUT = "Fastrak, sync to first character", 5.5 "ms", Published "PF", 5.5..5.5;
    FASTRAK_LATENCY = "Fastrak effective latency, middle of the measurement to first character", 3.75 "ms", Published "PF", 3.75..5.5;
    FASTRAK_RECORD = "Fastrak ASCII record", 47.0 "bytes", Published "PF", 8.0..200.0;
    FASTRAK_BAUD = "Fastrak line rate", 115200.0 "baud", Published "PF", 300.0..115200.0;
    FASTRAK_POSITION_NOISE = "Fastrak position error, rms of each axis", 0.8 "mm", Assumed "static accuracy taken as white noise", 0.0..2.0;
    FASTRAK_ORIENTATION_NOISE = "Fastrak orientation error, rms about each axis", 0.15 "deg", Assumed "static accuracy taken as white noise", 0.0..0.5;
    SERIAL_BITS = "bits on the line for a byte (start, 8 data, stop)", 10.0 "bits", Derived "47 x 10 / 115200 = 4.08 ms and / 9600 = 49 ms, the times of PF", 10.0..11.0;

    FLOCK_RATE = "Flock of Birds rate", 100.0 "Hz", Published "VRPN", 10.0..144.0;
    FLOCK_POSITION_LATENCY = "Flock of Birds position latency, filters off", 7.5 "ms", Published "VRPN", 7.5..30.0;
    FLOCK_ORIENTATION_LATENCY = "Flock of Birds orientation latency, filters off", 2.0 "ms", Published "VRPN", 2.0..30.0;
    FLOCK_POSITION_NOISE = "Flock of Birds position error, rms of each axis", 2.5 "mm", Published "Ascension data sheet", 0.0..5.0;
    FLOCK_ORIENTATION_NOISE = "Flock of Birds orientation error, rms about each axis", 0.5 "deg", Published "Ascension data sheet", 0.0..1.0;
    FLOCK_CRASH = "time from the first report to the crash of a patched host with the Flock", 1000.0 "ms", Assumed "TR94 says that it crashes, not when", 0.0..600000.0;

    OPTICAL_RATE = "optical ceiling tracker rate", 60.0 "Hz", Assumed "WARD92 gives 20-100", 20.0..100.0;
    OPTICAL_LATENCY = "optical ceiling tracker latency", 33.0 "ms", Published "I3D95; WARD92 gives 20-60", 20.0..60.0;
    OPTICAL_POSITION_NOISE = "optical ceiling tracker position error, rms of each axis", 2.0 "mm", Published "WARD92", 0.0..5.0;
    OPTICAL_ORIENTATION_NOISE = "optical ceiling tracker orientation error, rms about each axis", 0.2 "deg", Published "WARD92", 0.0..1.0;

    SPACE_RATE = "3Space rate over all receivers", 60.0 "Hz", Assumed "usual figure of the product", 30.0..60.0;
    SPACE_LATENCY = "3Space latency", 28.5 "ms", Assumed "tens of milliseconds", 10.0..90.0;
    SPACE_POSITION_NOISE = "3Space position error, rms of each axis", 2.5 "mm", Assumed "as the Flock", 0.0..5.0;
    SPACE_ORIENTATION_NOISE = "3Space orientation error, rms about each axis", 0.5 "deg", Assumed "as the Flock", 0.0..1.0;
    SPACE_BOWL = "depth of the bowl that metal makes of a plane, at 1 m from the transmitter", 20.0 "mm", Assumed "TR94 describes the bowl, not its depth", 0.0..200.0;
    SPACE_BOWL_REACH = "distance at which the bowl has half the depth of its parabola", 2.0 "m", Assumed "keeps the error finite out of range", 0.5..10.0;

    IDEAL_RATE = "ideal tracker rate", 1000.0 "Hz", Assumed "well above all trackers", 1.0..10000.0;

    HOST_POLL = "time between looks of the kernel at the serial line", 30.0 "ms", Published "TR94", 1.0..100.0;

    HEAD_TYPICAL = "typical speed of a fast head turn", 200.0 "deg/s", Published "JITP, LIST83", 0.0..370.0;
    HEAD_PEAK = "peak speed of a head turn", 370.0 "deg/s", Published "JITP, LIST83", 200.0..600.0;
    TRACE_MEAN = "mean angular speed of recorded headset traces", 40.0 "deg/s", Published "17 minutes of recorded use", 40.0..40.0;
    TRACE_P95 = "95th percentile of the angular speed of those traces", 114.0 "deg/s", Published "17 minutes of recorded use", 114.0..114.0;
    TRACE_P999 = "99.9th percentile of the angular speed of those traces", 283.0 "deg/s", Published "17 minutes of recorded use", 283.0..283.0;
    TRACE_TRANSLATION = "mean translation speed of those traces", 0.37 "m/s", Published "17 minutes of recorded use", 0.37..0.37;
    TRACE_YAW_95 = "frequency below which 95 % of the yaw energy lies", 0.14 "Hz", Published "17 minutes of recorded use", 0.14..0.14;
    TRACE_YAW_ALL = "frequency below which practically all yaw energy lies", 2.0 "Hz", Published "17 minutes of recorded use", 2.0..2.0;

    PENDULUM_ARM = "arm of the measuring pendulum", 0.5 "m", Assumed "TR94 gives none", 0.1..2.0;
    PENDULUM_AMPLITUDE = "greatest angle of the measuring pendulum", 20.0 "deg", Assumed "TR94 gives none", 1.0..90.0;
    GRAVITY = "standard gravity", 9.80665 "m/s^2", Published "CGPM 1901", 9.78..9.84;
    LED_BEAM = "width of the LED's beam at the pendulum", 2.0 "mm", Assumed "TR94 gives none", 0.1..20.0;
    PHOTODIODE_LINE = "visible line of the screen under the photodiode", 120.0 "lines", Assumed "middle of a 240-line field; TR94 gives none", 0.0..239.0;

    NTSC_FIELD = "time from one vertical retrace to the next", 16.683333333333334 "ms", Published "NTSC, 1001/60000 s", 16.68..16.69;
    NTSC_LINE = "time from one scanline to the next", 63.55555555555556 "us", Published "NTSC, 4004/63 us", 63.55..63.56;

    VIEW_WIDTH = "width of the head-mounted display", 640.0 "px", Published "TR94", 1.0..16384.0;
    VIEW_HEIGHT = "height of the head-mounted display", 480.0 "px", Published "TR94", 1.0..16384.0;
    VIEW_ANGLE = "horizontal angle of view", 60.0 "deg", Published "JITP", 1.0..170.0;

    JERK_POSITION = "white jerk of the position filter, root of its spectral density", 0.4 "m/s^3/sqrt(Hz)", Assumed "least mean error 50 ms ahead, flat from 0.2 to 0.6", 0.01..1000.0;
    JERK_ORIENTATION = "white jerk of the orientation filter, root of its spectral density", 14.0 "rad/s^3/sqrt(Hz)", Assumed "least mean error 50 ms ahead, flat from 10 to 20", 0.1..10000.0;
    START_SPEED = "standard deviation of the speed at the start of a filter", 1.0 "m/s", Assumed "above the mean translation speed", 0.01..10.0;
    START_ACCELERATION = "standard deviation of the acceleration at the start of a filter", 5.0 "m/s^2", Assumed "half of gravity", 0.01..100.0;
    START_TURN = "standard deviation of the angular velocity at the start of a filter", 2.0 "rad/s", Assumed "the 95th percentile of recorded traces", 0.01..20.0;
    START_TURN_ACCELERATION = "standard deviation of the angular acceleration at the start of a filter", 20.0 "rad/s^2", Assumed "100 ms to reach the above", 0.01..1000.0;
    BASELINE = "reports between the points of a difference (1 takes neighbours)", 4.0 "reports", Assumed "noise of the velocity falls with it, delay rises", 1.0..16.0;
    GATE_SPEED = "fastest believable translation", 8.0 "m/s", Assumed "20 times the mean of recorded traces", 1.0..100.0;
    GATE_TURN = "fastest believable turn", 1000.0 "deg/s", Assumed "2.7 times the peak of LIST83", 370.0..10000.0;
    GATE_DISTANCE = "distance that noise alone may jump", 30.0 "mm", Assumed "8 standard deviations of a difference of two Flock reports", 1.0..1000.0;
    GATE_ANGLE = "angle that noise alone may jump", 6.0 "deg", Assumed "8 standard deviations of a difference of two Flock reports", 0.1..90.0;
    GATE_PATIENCE = "rejected jumps in a row after which the new place is believed", 5.0 "reports", Assumed "42 ms at 120 Hz", 1.0..100.0;
    GATE_GAP = "silence after which velocities are forgotten", 250.0 "ms", Assumed "30 reports at 120 Hz; longer than any planned prediction", 10.0..10000.0;
    GATE_INTERVAL = "least time between two reports", 0.05 "ms", Assumed "half the period of the fastest rate of a tracker", 0.0..1.0;
    HORIZON = "longest prediction; beyond it the last pose is given", 500.0 "ms", Assumed "2.5 times the longest measured prediction", 1.0..10000.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_lies_in_its_range() {
        for p in TABLE {
            assert!(p.range.0 <= p.value && p.value <= p.range.1, "{}", p.name);
        }
    }

    #[test]
    fn every_parameter_names_unit_and_source() {
        assert!(TABLE.iter().all(|p| !p.unit.is_empty() && !p.source.is_empty()));
    }

    #[test]
    fn milliseconds_become_whole_picoseconds() {
        assert_eq!(FASTRAK_LATENCY.ms_to_ps(), 3_750_000_000);
    }
}
