//! The side of a cell (square of the floor), fitted to one update rate in table 1 of the paper CPR05. The other rates
//! serve as checks.

use super::rules::Rules;
use crate::walk::at_frames;
use crate::world::World;
use address_recalculation::priority::{Cell, Cells, PriorityTiming};
use glam::DVec3;
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Walk;

/// Mean update rates of display memories 0 to 3, in Hz, as printed in table 1 of the paper CPR05.
pub const RATES_HZ: [f64; 4] = [60.0, 39.25, 28.21, 16.15];

/// Index of the memory whose update rate determines the side of a cell (square of the floor).
pub const RATE_FITTED: usize = 1;

/// Cell sides to try, in tenths of a metre.
const TENTHS: std::ops::RangeInclusive<u32> = 15..=40;

/// Returns the updates per second of each display memory for a viewer's walk at 1 m/s. Only the policy runs, and
/// nothing is drawn.
///
/// # Errors
///
/// Fails in the same cases as [`World::new`].
pub fn policy_rates_hz(
    scene: &Scene,
    path: &Walk,
    numbers: &PriorityTiming,
    has_cascade: bool,
    frames: u64,
) -> Result<Vec<f64>, SettingError> {
    let world = World::new(scene, numbers.cell_m)?;
    Ok(rates_hz(world.cells(), at_frames(path, 1.0, numbers.frame_hz), numbers, has_cascade, frames))
}

/// Returns the updates per second of each display memory for a set of occupied cells (squares of the floor). `eye`
/// returns the position of the eye in each frame.
pub(super) fn rates_hz(
    held: impl IntoIterator<Item = Cell>,
    eye: impl Fn(u64) -> DVec3,
    numbers: &PriorityTiming,
    has_cascade: bool,
    frames: u64,
) -> Vec<f64> {
    let mut cells = Cells::new(numbers, held, has_cascade);
    let mut updates = vec![0_u64; numbers.memories as usize];
    // Count the updates of each memory.
    for frame in 0..frames {
        let update = cells.frame(eye(frame));
        update.memories().for_each(|memory| updates[memory] += 1);
    }
    updates.into_iter().map(|count| count as f64 * numbers.frame_hz / frames as f64).collect()
}

/// Fits the side of a cell to table 1 of the paper CPR05: the update rate of memory [`RATE_FITTED`] comes nearest to
/// the printed rate. Returns the side in metres, and the update rates of all memories with this side.
///
/// The tested sides are multiples of 0.1 m.
///
/// # Errors
///
/// Fails in the same cases as [`policy_rates_hz`].
pub fn fitted_cell_m(scene: &Scene, path: &Walk, rules: &Rules, frames: u64) -> Result<(f64, Vec<f64>), SettingError> {
    // Keep the side of a cell with the smallest error, its rates and its error.
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
