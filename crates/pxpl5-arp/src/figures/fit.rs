//! The side of a cell, fitted to one rate of table 1; the other rates are checked.

use super::rules::Rules;
use crate::error::ExperimentError;
use crate::walk::at_frames;
use crate::world::World;
use glam::DVec3;
use priority_rendering::{Cell, Cells, PriorityTiming};
use pxpl5_scene::Scene;
use tracking::motion::Walk;

/// Mean update rates of memories 0 to 3, Hz (table 1).
pub const RATES_HZ: [f64; 4] = [60.0, 39.25, 28.21, 16.15];

/// The memory whose rate the side of a cell is fitted to.
pub const RATE_FITTED: usize = 1;

/// Sides that are tried, tenths of a metre.
const TENTHS: std::ops::RangeInclusive<u32> = 15..=40;

/// Updates a second of each memory on a walk of a metre a second: the policy alone, nothing is drawn.
///
/// # Errors
///
/// As [`World::new`].
pub fn policy_rates_hz(
    scene: &Scene,
    path: &Walk,
    numbers: &PriorityTiming,
    has_cascade: bool,
    frames: u64,
) -> Result<Vec<f64>, ExperimentError> {
    let world = World::new(scene, numbers.cell_m)?;
    Ok(rates_hz(world.cells(), at_frames(path, 1.0, numbers.frame_hz), numbers, has_cascade, frames))
}

/// The same in a world with something in these cells, with the eye of each frame at a place of its own.
pub(super) fn rates_hz(
    held: impl IntoIterator<Item = Cell>,
    eye: impl Fn(u64) -> DVec3,
    numbers: &PriorityTiming,
    has_cascade: bool,
    frames: u64,
) -> Vec<f64> {
    let mut cells = Cells::new(numbers, held, has_cascade);
    let mut updates = vec![0_u64; numbers.memories as usize];
    for frame in 0..frames {
        let update = cells.frame(eye(frame));
        update.memories().for_each(|memory| updates[memory] += 1);
    }
    updates.into_iter().map(|count| count as f64 * numbers.frame_hz / frames as f64).collect()
}

/// The side of a cell, m, in steps of 0.1 m, that comes nearest to the rate of memory [`RATE_FITTED`], and the rates with it.
///
/// # Errors
///
/// As [`policy_rates_hz`].
pub fn fitted_cell_m(
    scene: &Scene,
    path: &Walk,
    rules: &Rules,
    frames: u64,
) -> Result<(f64, Vec<f64>), ExperimentError> {
    let mut best = (f64::NAN, Vec::new(), f64::INFINITY);
    for tenths in TENTHS {
        let cell_m = f64::from(tenths) / 10.0;
        let rates = policy_rates_hz(scene, path, &rules.numbers(cell_m), rules.has_cascade, frames)?;
        let error = (rates[RATE_FITTED] - RATES_HZ[RATE_FITTED]).abs();
        if error < best.2 {
            best = (cell_m, rates, error);
        }
    }
    Ok((best.0, best.1))
}
