use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{MagneticDistortion, SerialLine, SerialRead, TrackerFault};
use crate::config::{self as table, Tables};

/// Settings of a tracker, its cable and the host's serial port.
///
/// The presets take every number from [`crate::config`].
///
/// The tracker begins measurement n (called a solution) at sync signal n, at the time n x receivers / rate. The
/// measurement is ready for the cable `sync_to_output_ps` after this signal. At this instant, the measured position has
/// the age `position_latency_ps`, and the measured orientation has the age `orientation_latency_ps`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackerConfig {
    /// Name of the tracker, shown in reports of a run.
    pub name: String,
    /// Measurements per second over all receivers, 1 to 10,000.
    pub rate_hz: u32,
    /// Number of receivers that share the measurement rate, 1 to 16. The record of the head's receiver is sent first.
    pub receivers: u32,
    /// Time from the tracker's sync signal to the first character on the cable, ps.
    pub sync_to_output_ps: u64,
    /// Time from the instant at which the position was true to the first character of its report on the cable, ps. At
    /// most `sync_to_output_ps`.
    pub position_latency_ps: u64,
    /// Time from the instant at which the orientation was true to the first character of its report on the cable, ps.
    /// At most `sync_to_output_ps`.
    pub orientation_latency_ps: u64,
    /// Random position error that changes with each report (white noise), rms along each axis, m.
    pub position_noise_m: f64,
    /// Random orientation error that changes with each report (white noise), rms about each axis, degrees.
    pub orientation_noise_deg: f64,
    /// Constant position error, m. Each run draws the error once from its seed. The value is the root mean square along
    /// each axis, over all seeds.
    pub position_bias_m: f64,
    /// Constant orientation error, degrees. Each run draws the error once from its seed. The value is the root mean
    /// square about each axis, over all seeds.
    pub orientation_bias_deg: f64,
    /// Gain a of the tracker's low-pass filter, above 0. The filter replaces its output x' by a x + (1 - a) x' at each
    /// measurement x. A gain of 1 turns the filter off.
    pub filter_gain: f64,
    /// The serial cable from tracker to host, or `None` if the latencies already include the time on the cable.
    pub serial: Option<SerialLine>,
    /// Method by which the host's Unix kernel reads the serial port.
    pub host: SerialRead,
    /// Time from the first report to the crash of a host with a patched Unix kernel, which handles an interrupt for
    /// each character. `None` if such a host never crashes. TR94 reports the crash for the Flock of Birds.
    pub crashes_patched_host_after_ps: Option<u64>,
    /// Distortion by metal near a magnetic tracker, or `None` without distortion.
    pub distortion: Option<MagneticDistortion>,
    /// Injected faults. If two random faults hit one report, the first in this list applies. The list is empty for a
    /// healthy tracker.
    pub faults: Vec<TrackerFault>,
}

impl TrackerConfig {
    /// Returns true if the reports have random errors, which differ with the seed.
    pub fn is_random(&self) -> bool {
        [self.position_noise_m, self.orientation_noise_deg, self.position_bias_m, self.orientation_bias_deg] != [0.0; 4]
    }

    /// Returns the Polhemus Fastrak above a steel floor, with its transmitter at the origin, one receiver, its filter off
    /// and 115,200 baud. The host's Unix kernel is patched so that each character on the serial port causes an interrupt.
    pub fn fastrak() -> Self {
        Self::fastrak_by(&Tables::PAPERS)
    }

    /// Returns the Polhemus Fastrak with the numbers of `tables`.
    pub fn fastrak_by(tables: &Tables) -> Self {
        let latency_ps = table::ms_to_ps(tables.fastrak.latency);
        Self {
            sync_to_output_ps: table::ms_to_ps(tables.fastrak.sync_to_output),
            position_latency_ps: latency_ps,
            orientation_latency_ps: latency_ps,
            serial: Some(SerialLine::fastrak_by(tables)),
            filter_gain: tables.fastrak.filter_gain,
            distortion: Some(MagneticDistortion::floor_below(
                [tables.fastrak.bowl, tables.fastrak.bowl_reach],
                DVec3::ZERO,
            )),
            ..Self::ideal_by(tables)
                .named("Polhemus Fastrak", tables.fastrak.rate)
                .with_noise(tables.fastrak.position_noise, tables.fastrak.orientation_noise)
                .with_bias(tables.fastrak.position_bias, tables.fastrak.orientation_bias)
        }
    }

    /// Returns the Ascension Flock of Birds with its filters off, on a host with an unpatched Unix kernel. A patched
    /// Unix kernel crashes with this tracker.
    pub fn flock_of_birds() -> Self {
        Self::flock_of_birds_by(&Tables::PAPERS)
    }

    /// Returns the Ascension Flock of Birds with the numbers of `tables`.
    pub fn flock_of_birds_by(tables: &Tables) -> Self {
        let position_latency_ps = table::ms_to_ps(tables.flock.position_latency);
        Self {
            sync_to_output_ps: position_latency_ps,
            position_latency_ps,
            orientation_latency_ps: table::ms_to_ps(tables.flock.orientation_latency),
            host: SerialRead::unix_by(tables),
            crashes_patched_host_after_ps: Some(table::ms_to_ps(tables.flock.crash)),
            ..Self::ideal_by(tables)
                .named("Ascension Flock of Birds", tables.flock.rate)
                .with_noise(tables.flock.position_noise, tables.flock.orientation_noise)
                .with_bias(tables.flock.position_bias, tables.flock.orientation_bias)
        }
    }

    /// Returns the Flock of Birds on a host with a patched Unix kernel. The host crashes one second after the first
    /// report. This preset is for fault injection.
    pub fn flock_of_birds_on_patched_host() -> Self {
        Self::flock_of_birds_on_patched_host_by(&Tables::PAPERS)
    }

    /// Returns the Flock of Birds on a host with a patched Unix kernel, with the numbers of `tables`. Some time after
    /// the first report, this host crashes. The parameter `flock.crash` of `tables` is this time.
    pub fn flock_of_birds_on_patched_host_by(tables: &Tables) -> Self {
        Self { host: SerialRead::InterruptPerCharacter, ..Self::flock_of_birds_by(tables) }
    }

    /// Returns UNC's optical ceiling tracker, with a total latency of 33 ms.
    pub fn optical_ceiling() -> Self {
        Self::optical_ceiling_by(&Tables::PAPERS)
    }

    /// Returns UNC's optical ceiling tracker with the numbers of `tables`.
    pub fn optical_ceiling_by(tables: &Tables) -> Self {
        Self::ideal_by(tables)
            .named("UNC optical ceiling tracker", tables.optical.rate)
            .with_noise(tables.optical.position_noise, tables.optical.orientation_noise)
            .with_bias(tables.optical.position_bias, tables.optical.orientation_bias)
            .with_latency_ps(table::ms_to_ps(tables.optical.latency))
    }

    /// Returns the Polhemus 3Space above a steel floor, with its transmitter at the origin. The host's Unix kernel is
    /// unpatched and polls the serial port.
    pub fn polhemus_3space() -> Self {
        Self::polhemus_3space_by(&Tables::PAPERS)
    }

    /// Returns the Polhemus 3Space with the numbers of `tables`.
    pub fn polhemus_3space_by(tables: &Tables) -> Self {
        Self {
            host: SerialRead::unix_by(tables),
            distortion: Some(MagneticDistortion::floor_below(
                [tables.space.bowl, tables.space.bowl_reach],
                DVec3::ZERO,
            )),
            ..Self::ideal_by(tables)
                .named("Polhemus 3Space", tables.space.rate)
                .with_noise(tables.space.position_noise, tables.space.orientation_noise)
                .with_bias(tables.space.position_bias, tables.space.orientation_bias)
                .with_latency_ps(table::ms_to_ps(tables.space.latency))
        }
    }

    /// Returns an ideal tracker without error and delay, with 1,000 reports per second.
    pub fn ideal() -> Self {
        Self::ideal_by(&Tables::PAPERS)
    }

    /// Returns the ideal tracker with the numbers of `tables`.
    pub fn ideal_by(tables: &Tables) -> Self {
        Self {
            name: "ideal".to_owned(),
            rate_hz: tables.ideal.rate as u32,
            receivers: 1,
            sync_to_output_ps: 0,
            position_latency_ps: 0,
            orientation_latency_ps: 0,
            position_noise_m: 0.0,
            orientation_noise_deg: 0.0,
            position_bias_m: 0.0,
            orientation_bias_deg: 0.0,
            filter_gain: 1.0,
            serial: None,
            host: SerialRead::InterruptPerCharacter,
            crashes_patched_host_after_ps: None,
            distortion: None,
            faults: Vec::new(),
        }
    }

    /// Returns the same tracker with the latency `latency_ps` for both position and orientation. The time from the sync
    /// signal to the first character becomes equal to the latency.
    pub fn with_latency_ps(self, latency_ps: u64) -> Self {
        Self {
            sync_to_output_ps: latency_ps,
            position_latency_ps: latency_ps,
            orientation_latency_ps: latency_ps,
            ..self
        }
    }

    /// Returns the same tracker with reports that arrive `added_ps` later, as if its cable were longer.
    pub fn with_added_latency_ps(self, added_ps: u64) -> Self {
        let later = |latency_ps: u64| latency_ps.saturating_add(added_ps);
        Self {
            sync_to_output_ps: later(self.sync_to_output_ps),
            position_latency_ps: later(self.position_latency_ps),
            orientation_latency_ps: later(self.orientation_latency_ps),
            ..self
        }
    }

    /// Returns the same tracker without noise and bias.
    pub fn without_noise(self) -> Self {
        Self {
            position_noise_m: 0.0,
            orientation_noise_deg: 0.0,
            position_bias_m: 0.0,
            orientation_bias_deg: 0.0,
            ..self
        }
    }

    /// Returns the same tracker without latency: the host receives a measurement at the instant of measuring.
    pub fn without_latency(self) -> Self {
        Self { serial: None, ..self.without_polling().with_latency_ps(0) }
    }

    /// Returns the same tracker on a host with a patched Unix kernel, which receives every character immediately,
    /// without polling.
    pub fn without_polling(self) -> Self {
        Self { host: SerialRead::InterruptPerCharacter, crashes_patched_host_after_ps: None, ..self }
    }

    /// Returns the same tracker on a host with an unpatched Unix kernel, which polls the serial port. The value
    /// `host.poll` of `tables` is the polling interval.
    pub fn with_polling_by(self, tables: &Tables) -> Self {
        Self { host: SerialRead::unix_by(tables), ..self }
    }

    fn named(self, name: &str, rate_hz: u64) -> Self {
        Self { name: name.to_owned(), rate_hz: rate_hz as u32, ..self }
    }

    fn with_noise(self, position_mm: f64, orientation_deg: f64) -> Self {
        Self { position_noise_m: position_mm / 1e3, orientation_noise_deg: orientation_deg, ..self }
    }

    fn with_bias(self, position_mm: f64, orientation_deg: f64) -> Self {
        Self { position_bias_m: position_mm / 1e3, orientation_bias_deg: orientation_deg, ..self }
    }

    /// Returns the same tracker without bias, metal distortion and faults, which are errors that a filter cannot
    /// remove.
    pub fn without_systematic_errors(self) -> Self {
        Self { position_bias_m: 0.0, orientation_bias_deg: 0.0, distortion: None, faults: Vec::new(), ..self }
    }
}
