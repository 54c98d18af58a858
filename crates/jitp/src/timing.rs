//! Every number of this firmware that is not the processor's.

parameters::parameter_table! {
    /// Times of just-in-time firmware.
    pub struct JitpTiming {
        /// CPU time to interpolate one triangle of the dual display list for a strip and to set it up.
        interpolate_ns: 7_000, "ns", Assumed, 3000..=15000 in 0..=MAX, "a third of a triangle's 21.7 us: no transform, light or clip, only three interpolations and the set-up";
        /// From the order of a strip to its beam, beyond the slaves' own time for it.
        margin_ns: 400_000, "ns", Assumed, 100000..=2000000 in 0..=MAX, "messages of 12 us at the master and at the slave, drawing, five transfers of a line, and the wait for busy renderers";
    }
}
