//! Parameters of the policies that decide when the display memories are drawn.

use pxpl5_sim::parameters::{ParameterTable, SettingError};

pxpl5_sim::parameters::parameter_table! {
    /// Parameters of the policies: accepted image error, cells, warping and rates of memories.
    pub struct PriorityTiming {
        /// Largest accepted angle between the displayed and the correct direction of a point.
        theta_deg: f64 = 0.3515625, "deg", Assumed, 0.09..=0.88 in 1e-9..=90.0, "CPR05 2.2: the spacing of pixels in the display memory, not printed; 90/256, so that tears are 3.75 pixels of 60/640 deg (CPR05 5: a few). Range: one such pixel to five texels of 90/512 deg";
        /// Number of rings of cells (squares of the floor) around the viewer's cell in the most often drawn memory.
        inner_rings: 2, "rings", Derived, 0..=2 in 0..=100, "the rules that predict a left-out rate of table 1 best (docs/address-recalculation.md); with 0, the second memory of table 1 would be as fast as the first";
        /// Number of rings of cells of each memory, divided by the number of rings of cells of the memory that is drawn
        /// twice as often. Memory 1 holds one ring.
        ring_growth: 1, "1", Derived, 1..=2 in 1..=8, "equal rings, the rules that predict a left-out rate of table 1 best; 2 gives rings that double";
        /// Choice of the distance from the eye that determines when a memory is due. With 0, the distance ends at the
        /// border beyond which the cells of the memory lie. With 1, the distance ends at the memory's nearest occupied
        /// cell.
        to_held_cells: 0, "1", Assumed, 0..=1, "not printed; `pxpl5 arp interpretations` ranks both";
        /// Side of a cell, which is a square of the floor.
        cell_m: f64 = 2.5, "m", Derived, 1.0..=100.0 in 1e-3..=1e6, "fitted to one rate of table 1";
        /// Distance from a border within which warping moves vertices. The distance is at most the side of a cell.
        falloff_m: f64 = 0.0, "m", Assumed, 0.0..=100.0 in 0.0..=1e6, "not printed; 0 means the side of a cell";
        /// Frames per second, which is the rate of the most often drawn memory.
        frame_hz: f64 = 60.0, "Hz", Published, 60.0..=60.0 in 1.0..=1000.0, "CPR05 4.2";
        /// Number of display memories with different rates.
        memories: 4, "memories", Published, 1..=8, "CPR05 tables 1 and 2";
    }
}

impl PriorityTiming {
    /// Checks that all parameters are within their limits. The falloff (distance over which warping decreases) must not
    /// be longer than the side of a cell.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the parameter, its expected and its found value.
    pub fn check(&self) -> Result<(), SettingError> {
        ParameterTable::check(self).map_err(|error| error.in_table("priority"))?;
        if self.falloff_m > self.cell_m {
            let expected = format_args!("at most a cell's side of {} m", self.cell_m);
            return Err(SettingError::value("priority.falloff_m", expected, self.falloff_m));
        }
        Ok(())
    }

    /// Returns the distance from a border within which warping moves vertices, in metres. If the parameter `falloff_m`
    /// is 0, the result is the side of a cell.
    pub const fn falloff_length_m(&self) -> f64 {
        if self.falloff_m == 0.0 { self.cell_m } else { self.falloff_m }
    }

    pub fn frame_s(&self) -> f64 {
        1.0 / self.frame_hz
    }
}
