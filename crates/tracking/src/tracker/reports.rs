use glam::{DQuat, DVec3};

use super::report::TrackerReport;
use super::{SerialRead, TrackerConfig, TrackerFault, TrackerModel};
use crate::motion::Motion;
use crate::pose::Pose;
use crate::random::{below, bits, normal_pair, stream, unit};
use crate::rotation;

impl TrackerModel {
    /// Returns the reports that the host receives while the head follows `motion`, in order of arrival. The sequence
    /// ends if a fault makes the tracker fail permanently. The same (model, motion, seed) gives the same sequence on
    /// every computer.
    pub fn reports<M: Motion>(&self, motion: M, seed: u64) -> Reports<M> {
        Reports::new(self.clone(), motion, seed)
    }
}

/// Iterator over the reports of a tracker in order of arrival: see [`TrackerModel::reports`].
#[derive(Clone, Debug)]
pub struct Reports<M> {
    model: TrackerModel,
    motion: M,
    noise: u64,
    bias: (DVec3, DVec3),
    faults: u64,
    poll_phase_ps: u64,
    next_solution: u64,
    filtered: Option<Pose>,
    line_free_ps: u64,
    silent_from_ps: u64,
    crashes: bool,
}

impl<M: Motion> Reports<M> {
    fn new(model: TrackerModel, motion: M, seed: u64) -> Self {
        let config = model.config();
        // The seed determines the phase of the host's polling.
        let poll_phase_ps = match config.host {
            SerialRead::Polled { period_ps } => below(bits(stream(seed, 1), 0), period_ps),
            SerialRead::InterruptPerCharacter => 0,
        };
        let silence = config.faults.iter().filter_map(|fault| match fault {
            TrackerFault::Silence { from_ps } => Some(*from_ps),
            _ => None,
        });
        Self {
            noise: stream(seed, 2),
            bias: bias(config, stream(seed, 4)),
            faults: stream(seed, 3),
            poll_phase_ps,
            next_solution: 0,
            filtered: None,
            line_free_ps: 0,
            silent_from_ps: silence.min().unwrap_or(u64::MAX),
            crashes: config.host == SerialRead::InterruptPerCharacter,
            model,
            motion,
        }
    }

    /// Skips all measurements whose sync signal is before the instant `from_ps`. The tracker's own filter starts at
    /// this instant.
    pub fn from(self, from_ps: u64) -> Self {
        Self { next_solution: self.model.solution_at(from_ps), ..self }
    }

    /// Computes a measurement with distortion, noise and filter. The result includes the instants at which its position
    /// and orientation were true.
    fn solve(&mut self, solution: u64, output_ps: u64) -> TrackerReport {
        let config = self.model.config();
        let position_measured_ps = output_ps - config.position_latency_ps;
        let measured_ps = output_ps - config.orientation_latency_ps;
        // Latency can differ between position and orientation.
        let mut pose = self.motion.pose(measured_ps);
        if position_measured_ps != measured_ps {
            pose.position = self.motion.pose(position_measured_ps).position;
        }
        // Errors apply in the order of the signal: metal, bias, noise, filter.
        if let Some(distortion) = config.distortion {
            pose = distortion.distort(&pose);
        }
        let pose = self.filter(self.with_noise(self.with_bias(pose), solution));
        TrackerReport { solution, measured_ps, position_measured_ps, arrives_ps: output_ps, pose }
    }

    fn with_bias(&self, pose: Pose) -> Pose {
        let (offset, turn) = self.bias;
        if offset == DVec3::ZERO && turn == DVec3::ZERO {
            return pose;
        }
        Pose { position: pose.position + offset, orientation: rotation::exp(turn) * pose.orientation }
    }

    fn with_noise(&self, pose: Pose, solution: u64) -> Pose {
        let config = self.model.config();
        if config.position_noise_m == 0.0 && config.orientation_noise_deg == 0.0 {
            return pose;
        }
        let [(a, b), (c, d), (e, f)] =
            core::array::from_fn(|i| normal_pair(self.noise, solution.wrapping_mul(3) + i as u64));
        let turn = DVec3::new(d, e, f) * config.orientation_noise_deg.to_radians();
        Pose {
            position: pose.position + DVec3::new(a, b, c) * config.position_noise_m,
            orientation: rotation::exp(turn) * pose.orientation,
        }
    }

    fn filter(&mut self, pose: Pose) -> Pose {
        let gain = self.model.config().filter_gain;
        let filtered = match self.filtered {
            Some(old) if gain < 1.0 => old.interpolate(&pose, gain),
            _ => pose,
        };
        self.filtered = Some(filtered);
        filtered
    }

    /// Returns true if an injected fault causes the loss of measurement `solution`. All measurements within a dropout
    /// interval are skipped in one step.
    fn is_lost(&mut self, solution: u64, sync_ps: u64) -> bool {
        for (i, fault) in self.model.config().faults.iter().enumerate() {
            match *fault {
                // Skip the whole interval at once.
                TrackerFault::Dropout { from_ps, to_ps } if (from_ps..to_ps).contains(&sync_ps) => {
                    self.next_solution = self.model.solution_at(to_ps);
                    return true;
                }
                TrackerFault::RandomDropout { probability } if self.occurs(i, solution, probability) => return true,
                _ => {}
            }
        }
        false
    }

    fn occurs(&self, fault: usize, solution: u64, probability: f64) -> bool {
        unit(bits(stream(self.faults, fault as u64), solution)) < probability
    }

    /// Damages the report by the first injected fault (NaN values or a jump of the pose) that applies to this report.
    fn corrupt(&self, report: &mut TrackerReport) {
        for (i, fault) in self.model.config().faults.iter().enumerate() {
            match *fault {
                TrackerFault::NotANumber { probability } if self.occurs(i, report.solution, probability) => {
                    report.pose = Pose { position: DVec3::NAN, orientation: DQuat::NAN };
                    return;
                }
                TrackerFault::Jump { probability, distance_m, angle_deg }
                    if self.occurs(i, report.solution, probability) =>
                {
                    // The direction of a jump depends only on the seed, the fault and the measurement.
                    let draws = stream(stream(self.faults, i as u64), report.solution);
                    report.pose.position += random_direction(draws, 0) * distance_m;
                    let turn = rotation::exp(random_direction(draws, 2) * angle_deg.to_radians());
                    report.pose.orientation = turn * report.pose.orientation;
                    return;
                }
                _ => {}
            }
        }
    }

    /// Sends a finished measurement at `ready_ps` if the cable is free. Returns the instant at which the host receives
    /// the measurement, or `None` if the cable is busy.
    fn send(&mut self, ready_ps: u64) -> Option<u64> {
        if ready_ps < self.line_free_ps {
            return None;
        }
        let config = self.model.config();
        // The cable is busy until the records of all receivers are sent. The head's record is complete earlier.
        let busy_ps = config.serial.map_or(0, |serial| serial.transfer_ps(config.receivers));
        self.line_free_ps = ready_ps.saturating_add(busy_ps);
        let complete_ps = ready_ps.saturating_add(self.model.transfer_ps());
        Some(config.host.seen_ps(complete_ps, self.poll_phase_ps))
    }

    /// Schedules the crash of a host with a patched Unix kernel. The time until the crash counts from the arrival of
    /// the first report.
    fn schedule_crash(&mut self, arrives_ps: u64) {
        if let Some(after_ps) = self.model.config().crashes_patched_host_after_ps.filter(|_| self.crashes) {
            self.silent_from_ps = self.silent_from_ps.min(arrives_ps.saturating_add(after_ps));
            self.crashes = false;
        }
    }
}

fn bias(config: &TrackerConfig, seed: u64) -> (DVec3, DVec3) {
    let [(a, b), (c, d), (e, f)] = core::array::from_fn(|i| normal_pair(seed, i as u64));
    let turn = DVec3::new(d, e, f) * config.orientation_bias_deg.to_radians();
    (DVec3::new(a, b, c) * config.position_bias_m, turn)
}

impl<M: Motion> Iterator for Reports<M> {
    type Item = TrackerReport;

    fn next(&mut self) -> Option<TrackerReport> {
        loop {
            let solution = self.next_solution;
            // Stop beyond the end of simulated time, or when the tracker has failed permanently.
            let sync_ps = self.model.sync_ps(solution)?;
            let output_ps = sync_ps.checked_add(self.model.config().sync_to_output_ps)?;
            if output_ps >= self.silent_from_ps {
                return None;
            }
            self.next_solution += 1;
            if self.is_lost(solution, sync_ps) {
                continue;
            }
            // Measure even if the cable is busy, because the tracker's filter advances with every measurement.
            let mut report = self.solve(solution, output_ps);
            // A busy cable drops the measurement.
            let Some(arrives_ps) = self.send(output_ps) else { continue };
            report.arrives_ps = arrives_ps;
            self.corrupt(&mut report);
            self.schedule_crash(arrives_ps);
            if arrives_ps >= self.silent_from_ps {
                return None;
            }
            return Some(report);
        }
    }
}

fn random_direction(seed: u64, first: u64) -> DVec3 {
    let (x, y) = normal_pair(seed, first);
    let (z, _) = normal_pair(seed, first + 1);
    DVec3::new(x, y, z).normalize_or(DVec3::Y)
}
