use super::{SerialRead, TrackerConfig, TrackerFault};
use crate::error::{check, contradiction};
use crate::time::{PS_PER_S, tick_ps};
use pxpl5_sim::parameters::SettingError;

/// Greatest latency or polling interval that settings may have, ps.
const LONGEST_PS: u64 = 10 * PS_PER_S;

/// A tracker whose settings have been checked.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackerModel {
    config: TrackerConfig,
}

impl TrackerModel {
    /// Checks the settings and creates the tracker.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if a setting is out of range or contradicts another setting.
    pub fn new(config: TrackerConfig) -> Result<Self, SettingError> {
        check_times(&config)?;
        check("position noise, m", config.position_noise_m, 0.0, 10.0)?;
        check("orientation noise, deg", config.orientation_noise_deg, 0.0, 90.0)?;
        check("position bias, m", config.position_bias_m, 0.0, 10.0)?;
        check("orientation bias, deg", config.orientation_bias_deg, 0.0, 90.0)?;
        check("filter gain", config.filter_gain, 1e-6, 1.0)?;
        if let Some(serial) = config.serial {
            check("record, bytes", f64::from(serial.record_bytes), 1.0, 1000.0)?;
            check("bits of a byte", f64::from(serial.byte_bits), 1.0, 100.0)?;
            check("line rate, baud", f64::from(serial.baud), 300.0, 1e6)?;
        }
        config.distortion.map_or(Ok(()), |d| d.check())?;
        config.faults.iter().try_for_each(TrackerFault::check)?;
        Ok(Self { config })
    }

    /// Returns the settings of the tracker, which are all within their ranges.
    pub fn config(&self) -> &TrackerConfig {
        &self.config
    }

    /// Returns the time between measurements of the head's receiver, rounded down to a picosecond.
    pub fn period_ps(&self) -> u64 {
        PS_PER_S * u64::from(self.config.receivers) / u64::from(self.config.rate_hz)
    }

    /// Returns the time between two reports, ps. The result is a multiple of the measurement period, long enough to
    /// transfer the records of all receivers.
    pub fn report_interval_ps(&self) -> u64 {
        let transfer_ps = self.config.serial.map_or(0, |s| s.transfer_ps(self.config.receivers));
        self.period_ps() * transfer_ps.div_ceil(self.period_ps()).max(1)
    }

    /// Returns the delay that the tracker's own filter adds for a steady motion, ps: period x (1 - a) / a. Time stamps
    /// do not include this delay.
    pub fn filter_delay_ps(&self) -> u64 {
        let gain = self.config.filter_gain;
        (self.period_ps() as f64 * (1.0 - gain) / gain) as u64
    }

    /// Returns the time that the record of the head's receiver takes on the cable, ps.
    pub fn transfer_ps(&self) -> u64 {
        self.config.serial.map_or(0, |serial| serial.transfer_ps(1))
    }

    /// Returns the instant of sync signal `n`, ps, or `None` beyond the end of simulated time.
    pub(super) fn sync_ps(&self, n: u64) -> Option<u64> {
        tick_ps(n, self.config.receivers, self.config.rate_hz)
    }

    /// Returns the index of the first measurement whose sync signal is at or after `t_ps`.
    pub(super) fn solution_at(&self, t_ps: u64) -> u64 {
        let per_ps = u128::from(t_ps) * u128::from(self.config.rate_hz);
        let n = (per_ps / (u128::from(PS_PER_S) * u128::from(self.config.receivers))) as u64;
        if self.sync_ps(n).is_some_and(|sync| sync < t_ps) { n + 1 } else { n }
    }
}

fn check_times(config: &TrackerConfig) -> Result<(), SettingError> {
    check("tracker rate, Hz", f64::from(config.rate_hz), 1.0, 10_000.0)?;
    check("receivers", f64::from(config.receivers), 1.0, 16.0)?;
    let longest = LONGEST_PS as f64;
    check("sync to output, ps", config.sync_to_output_ps as f64, 0.0, longest)?;
    if config.position_latency_ps.max(config.orientation_latency_ps) > config.sync_to_output_ps {
        return Err(contradiction("a latency is longer than the time from sync to output"));
    }
    if let SerialRead::Polled { period_ps } = config.host {
        check("poll period, ps", period_ps as f64, 1.0, longest)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracker::SerialLine;

    fn model(config: TrackerConfig) -> TrackerModel {
        TrackerModel::new(config).unwrap()
    }

    #[test]
    fn the_first_solution_at_or_after_a_sync_is_the_solution_of_this_sync() {
        for config in [TrackerConfig::fastrak(), TrackerConfig { receivers: 3, ..TrackerConfig::fastrak() }] {
            let tracker = model(config);
            for n in [0, 1, 2, 7, 1_000_003] {
                let sync = tracker.sync_ps(n).unwrap();
                assert_eq!(tracker.solution_at(sync), n);
                assert_eq!(tracker.solution_at(sync + 1), n + 1);
            }
        }
    }

    #[test]
    fn every_preset_passes_the_check() {
        for config in [
            TrackerConfig::fastrak(),
            TrackerConfig::flock_of_birds(),
            TrackerConfig::flock_of_birds_on_patched_host(),
            TrackerConfig::optical_ceiling(),
            TrackerConfig::polhemus_3space(),
            TrackerConfig::ideal(),
        ] {
            assert!(TrackerModel::new(config).is_ok());
        }
    }

    #[test]
    fn invalid_settings_of_a_tracker_are_errors() {
        let good = TrackerConfig::fastrak;
        let bad = [
            TrackerConfig { rate_hz: 0, ..good() },
            TrackerConfig { receivers: 0, ..good() },
            TrackerConfig { filter_gain: 0.0, ..good() },
            TrackerConfig { filter_gain: f64::NAN, ..good() },
            TrackerConfig { position_noise_m: -1.0, ..good() },
            TrackerConfig { orientation_bias_deg: f64::NAN, ..good() },
            TrackerConfig { position_latency_ps: u64::MAX, ..good() },
            TrackerConfig { host: SerialRead::Polled { period_ps: 0 }, ..good() },
            TrackerConfig { serial: Some(SerialLine { baud: 0, ..SerialLine::fastrak() }), ..good() },
            TrackerConfig { faults: vec![TrackerFault::RandomDropout { probability: 1.0 }], ..good() },
            TrackerConfig { faults: vec![TrackerFault::Dropout { from_ps: 2, to_ps: 1 }], ..good() },
        ];
        for config in bad {
            assert!(TrackerModel::new(config.clone()).is_err(), "{config:?}");
        }
    }

    #[test]
    fn a_configuration_is_read_back_from_a_file_and_unknown_keys_are_refused() {
        let config = TrackerConfig::polhemus_3space();
        let text = serde_json::to_string(&config).unwrap();
        assert_eq!(serde_json::from_str::<TrackerConfig>(&text).unwrap(), config);
        let odd = text.replacen("rate_hz", "rate_hertz", 1);
        assert!(serde_json::from_str::<TrackerConfig>(&odd).is_err());
    }
}
