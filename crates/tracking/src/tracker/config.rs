use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Fault, HostLine, MagneticDistortion, SerialLine};
use crate::config as table;

/// Settings of a tracker, its cable and the host's port. Presets take every number from [`crate::config`].
///
/// Solution n is begun at the n-th sync (floor of n x receivers / rate) and is ready for the cable
/// `sync_to_output_ps` later; a latency counts back from there to the instant at which the pose was true.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrackerConfig {
    /// Name of the tracker, shown in reports of a run.
    pub name: String,
    /// Solutions a second over all receivers, 1 to 10,000.
    pub rate_hz: u32,
    /// Receivers that share the rate, 1 to 16. The head's is the first to be sent.
    pub receivers: u32,
    /// From sync to the first character on the cable.
    pub sync_to_output_ps: u64,
    /// Age of a position when its first character is sent, at most `sync_to_output_ps`.
    pub position_latency_ps: u64,
    /// Age of an orientation when its first character is sent, at most `sync_to_output_ps`.
    pub orientation_latency_ps: u64,
    /// White noise of each axis, rms, m.
    pub position_noise_m: f64,
    /// White noise about each axis, rms, degrees.
    pub orientation_noise_deg: f64,
    /// a of the tracker's filter x' = a x + (1 - a) x'; 1 is no filter. Above 0.
    pub filter_gain: f64,
    /// The cable; `None` when the latency above includes it.
    pub serial: Option<SerialLine>,
    /// How the host's kernel looks at the port that the cable ends in.
    pub host: HostLine,
    /// From the first report to the crash of a host that interrupts per character; `None` never crashes. TR94 tells
    /// of the Flock that it does.
    pub crashes_patched_host_after_ps: Option<u64>,
    /// What metal near a magnetic tracker does; `None` for none.
    pub distortion: Option<MagneticDistortion>,
    /// Faults to inject, in order of precedence; empty for a healthy tracker.
    pub faults: Vec<Fault>,
}

impl TrackerConfig {
    /// Polhemus Fastrak, one receiver, filter off, 115,200 baud, patched kernel.
    pub fn fastrak() -> Self {
        let latency_ps = table::ms_to_ps(table::Fastrak::PAPERS.latency);
        Self {
            sync_to_output_ps: table::ms_to_ps(table::Fastrak::PAPERS.sync_to_output),
            position_latency_ps: latency_ps,
            orientation_latency_ps: latency_ps,
            serial: Some(SerialLine::fastrak()),
            ..Self::ideal()
                .named("Polhemus Fastrak", table::Fastrak::PAPERS.rate)
                .with_noise(table::Fastrak::PAPERS.position_noise, table::Fastrak::PAPERS.orientation_noise)
        }
    }

    /// Ascension Flock of Birds, filters off, on the unpatched kernel: the patched one crashes with it.
    pub fn flock_of_birds() -> Self {
        let position_latency_ps = table::ms_to_ps(table::Flock::PAPERS.position_latency);
        Self {
            sync_to_output_ps: position_latency_ps,
            position_latency_ps,
            orientation_latency_ps: table::ms_to_ps(table::Flock::PAPERS.orientation_latency),
            host: HostLine::unix(),
            crashes_patched_host_after_ps: Some(table::ms_to_ps(table::Flock::PAPERS.crash)),
            ..Self::ideal()
                .named("Ascension Flock of Birds", table::Flock::PAPERS.rate)
                .with_noise(table::Flock::PAPERS.position_noise, table::Flock::PAPERS.orientation_noise)
        }
    }

    /// The Flock on a patched host, which dies of it after a second: for fault injection.
    pub fn flock_of_birds_on_patched_host() -> Self {
        Self { host: HostLine::InterruptPerCharacter, ..Self::flock_of_birds() }
    }

    /// UNC optical ceiling tracker: 33 ms in all.
    pub fn optical_ceiling() -> Self {
        Self::ideal()
            .named("UNC optical ceiling tracker", table::Optical::PAPERS.rate)
            .with_noise(table::Optical::PAPERS.position_noise, table::Optical::PAPERS.orientation_noise)
            .with_latency_ps(table::ms_to_ps(table::Optical::PAPERS.latency))
    }

    /// Polhemus 3Space above a steel floor, transmitter at the origin, unpatched kernel.
    pub fn polhemus_3space() -> Self {
        Self {
            host: HostLine::unix(),
            distortion: Some(MagneticDistortion::floor_below(DVec3::ZERO)),
            ..Self::ideal()
                .named("Polhemus 3Space", table::Space::PAPERS.rate)
                .with_noise(table::Space::PAPERS.position_noise, table::Space::PAPERS.orientation_noise)
                .with_latency_ps(table::ms_to_ps(table::Space::PAPERS.latency))
        }
    }

    /// No error, no delay, 1,000 reports a second.
    pub fn ideal() -> Self {
        Self {
            name: "ideal".to_owned(),
            rate_hz: table::Ideal::PAPERS.rate as u32,
            receivers: 1,
            sync_to_output_ps: 0,
            position_latency_ps: 0,
            orientation_latency_ps: 0,
            position_noise_m: 0.0,
            orientation_noise_deg: 0.0,
            filter_gain: 1.0,
            serial: None,
            host: HostLine::InterruptPerCharacter,
            crashes_patched_host_after_ps: None,
            distortion: None,
            faults: Vec::new(),
        }
    }

    /// The same with one latency for position and orientation, counted from sync to output.
    pub fn with_latency_ps(self, latency_ps: u64) -> Self {
        Self {
            sync_to_output_ps: latency_ps,
            position_latency_ps: latency_ps,
            orientation_latency_ps: latency_ps,
            ..self
        }
    }

    /// The same tracker without noise: what it reports is where the head was.
    pub fn without_noise(self) -> Self {
        Self { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..self }
    }

    /// The same tracker without latency: the host knows a measurement at the instant at which it is made.
    pub fn without_latency(self) -> Self {
        Self { serial: None, ..self.without_polling().with_latency_ps(0) }
    }

    /// The same tracker on a host whose kernel takes every character as it comes.
    pub fn without_polling(self) -> Self {
        Self { host: HostLine::InterruptPerCharacter, crashes_patched_host_after_ps: None, ..self }
    }

    fn named(self, name: &str, rate_hz: u64) -> Self {
        Self { name: name.to_owned(), rate_hz: rate_hz as u32, ..self }
    }

    fn with_noise(self, position_mm: f64, orientation_deg: f64) -> Self {
        Self { position_noise_m: position_mm / 1e3, orientation_noise_deg: orientation_deg, ..self }
    }
}
