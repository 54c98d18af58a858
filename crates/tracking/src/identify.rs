//! The settings of trackers and predictors as keys and values, from which the names of experiments derive.

use pxpl5_sim::parameters::{Entry, ParameterTable};

use crate::config::HostPort;
use crate::identity::{SettingSink, write_vector};
use crate::predict::{Decay, PredictorConfig};
use crate::tracker::{MagneticDistortion, SerialLine, SerialRead, TrackerConfig, TrackerFault};

impl TrackerConfig {
    /// Writes every setting of the tracker to `settings`, each as a key and a value.
    pub fn identify(&self, settings: &mut SettingSink) {
        let Self {
            name,
            rate_hz,
            receivers,
            sync_to_output_ps,
            position_latency_ps,
            orientation_latency_ps,
            position_noise_m,
            orientation_noise_deg,
            position_bias_m,
            orientation_bias_deg,
            filter_gain,
            serial,
            host,
            crashes_patched_host_after_ps,
            distortion,
            faults,
        } = self;
        settings("tracker", name);
        settings("tracker.rate_hz", rate_hz);
        settings("tracker.receivers", receivers);
        settings("tracker.sync_to_output_ps", sync_to_output_ps);
        settings("tracker.position_latency_ps", position_latency_ps);
        settings("tracker.orientation_latency_ps", orientation_latency_ps);
        settings("tracker.position_noise_m", position_noise_m);
        settings("tracker.orientation_noise_deg", orientation_noise_deg);
        settings("tracker.position_bias_m", position_bias_m);
        settings("tracker.orientation_bias_deg", orientation_bias_deg);
        settings("tracker.filter_gain", filter_gain);
        if let Some(SerialLine { record_bytes, baud, byte_bits }) = serial {
            settings("tracker.serial.record_bytes", record_bytes);
            settings("tracker.serial.baud", baud);
            // Earlier versions always used ten bits. An experiment with this usual value keeps its old name, so the key
            // is left out.
            if u64::from(*byte_bits) != HostPort::PAPERS.byte_bits {
                settings("tracker.serial.byte_bits", byte_bits);
            }
        }
        match host {
            SerialRead::Polled { period_ps } => settings("tracker.host.polled_ps", period_ps),
            SerialRead::InterruptPerCharacter => settings("tracker.host", &"interrupt-per-character"),
        }
        if let Some(after_ps) = crashes_patched_host_after_ps {
            settings("tracker.crashes_patched_host_after_ps", after_ps);
        }
        if let Some(distortion) = distortion {
            write_distortion(settings, distortion);
        }
        faults.iter().for_each(|fault| write_fault(settings, fault));
    }
}

fn write_distortion(settings: &mut SettingSink, distortion: &MagneticDistortion) {
    let MagneticDistortion { transmitter_m, towards_metal, depth_per_m2, reach_m } = distortion;
    write_vector(settings, "tracker.distortion.transmitter_m", *transmitter_m);
    write_vector(settings, "tracker.distortion.towards_metal", *towards_metal);
    settings("tracker.distortion.depth_per_m2", depth_per_m2);
    settings("tracker.distortion.reach_m", reach_m);
}

fn write_fault(settings: &mut SettingSink, fault: &TrackerFault) {
    match fault {
        TrackerFault::Silence { from_ps } => settings("tracker.fault.silence", from_ps),
        TrackerFault::Dropout { from_ps, to_ps } => {
            settings("tracker.fault.dropout", &format_args!("{from_ps} {to_ps}"))
        }
        TrackerFault::RandomDropout { probability } => settings("tracker.fault.random_dropout", probability),
        TrackerFault::NotANumber { probability } => settings("tracker.fault.not_a_number", probability),
        TrackerFault::Jump { probability, distance_m, angle_deg } => {
            settings("tracker.fault.jump", &format_args!("{probability} {distance_m} {angle_deg}"));
        }
    }
}

impl PredictorConfig {
    /// Writes every setting of the predictor to `settings`, each as a key and a value.
    pub fn identify(&self, settings: &mut SettingSink) {
        let Self {
            kind,
            position_baseline,
            orientation_baseline,
            position_noise_m,
            orientation_noise_deg,
            position_jerk,
            orientation_jerk,
            position_decay,
            orientation_decay,
            check_ps,
            horizon_ps,
            start,
            gate,
        } = self;
        settings("predictor", &kind.name());
        settings("predictor.position_baseline", position_baseline);
        settings("predictor.orientation_baseline", orientation_baseline);
        settings("predictor.position_noise_m", position_noise_m);
        settings("predictor.orientation_noise_deg", orientation_noise_deg);
        settings("predictor.position_jerk", position_jerk);
        settings("predictor.orientation_jerk", orientation_jerk);
        settings("predictor.start_speed", &start.speed);
        settings("predictor.start_acceleration", &start.acceleration);
        settings("predictor.start_turn", &start.turn);
        settings("predictor.start_turn_acceleration", &start.turn_acceleration);
        settings("predictor.horizon_ps", horizon_ps);
        for (name, decay) in [("position", position_decay), ("orientation", orientation_decay)] {
            if *decay != Decay::NONE {
                settings(
                    &format!("predictor.{name}_decay"),
                    &format_args!("{} {}", decay.velocity, decay.acceleration),
                );
            }
        }
        if *check_ps != [0; 2] {
            settings("predictor.check_ps", &format_args!("{} {}", check_ps[0], check_ps[1]));
        }
        // The gate was no setting in earlier versions, so only changed numbers are written.
        gate.entries().iter().for_each(|entry| write_unusual(settings, "predictor.gate", entry));
    }
}

/// Passes a parameter to `settings` only if the parameter's value differs from the papers' value. Earlier versions
/// passed no such parameters. With the papers' values, an experiment therefore keeps the hash of its settings from
/// earlier versions.
fn write_unusual(settings: &mut SettingSink, of: &str, entry: &Entry) {
    if entry.value != entry.info.papers {
        settings(&format!("{of}.{}", entry.info.name), &entry.value);
    }
}
