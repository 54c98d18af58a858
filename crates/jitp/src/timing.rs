pxpl5_sim::parameters::parameter_table! {
    /// Times of just-in-time firmware.
    pub struct JitpTiming {
        /// CPU time to interpolate one triangle of the dual display list for a strip and to set the triangle up.
        interpolate_ns: 7_000, "ns", Assumed, 3000..=15000 in 0..=MAX, "a third of the 21.7 us of a triangle, because the work is only three interpolations and the set-up, without transform, light and clip";
        /// Time that is added to the slaves' time for a strip. The sum is the time from the order of the strip to its
        /// deadline.
        margin_ns: 400_000, "ns", Assumed, 100000..=2000000 in 0..=MAX, "messages of 12 us at the master and at the slave, drawing, five transfers of a line, and the wait for busy renderers";
    }
}
