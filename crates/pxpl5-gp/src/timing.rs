//! Every number of the board, and of the host that runs on the same model.

use pxpl5_sim::Span;

parameters::parameter_table! {
    /// Times and sizes of a graphics processor and of the code that it runs.
    pub struct GpTiming {
        /// Memory of a board.
        memory_bytes: 8_388_608, "bytes", Published, 8388608..=8388608 in 0..=1_073_741_824, "TR94: 8 MB";
        /// Part of the memory in which the bins of Rendering Control are kept, those of both contexts together.
        bin_bytes: 51_360, "bytes", Derived, 51_040..=51_680 in 0..=MAX, "TR94: the bins of 12 slaves hold 7,700 triangles that cover the screen: 642 a slave in 20 bins, 4 bytes a pointer; printed to three digits. If they hold so many for each eye it is twice that";
        /// CPU time to send a batch of messages or to receive one.
        message_ns: 12_000, "ns", Assumed, 10000..=25000 in 0..=MAX, "software of a message; the range is what the published latencies allow";
        /// CPU time of one triangle and eye: transform, light, set up, make commands.
        triangle_ns: 21_700, "ns", Derived, 18000..=32000 in 0..=MAX, "870 clocks at 40 MHz for optimised PPHIGS; 1M/32 GPs gives 32 us as design figure";
        /// CPU time of one entry in a bin.
        bin_entry_ns: 1_000, "ns", Assumed, 500..=2000 in 0..=MAX, "a pointer store and a count, partly out of cache";
        /// CPU time besides of a triangle that the clipper cuts.
        guard_ns: 0, "ns", Assumed, 0..=0 in 0..=MAX, "part of the time of a triangle in what was published; times of code count it by itself";
        /// CPU time of one sphere and eye.
        sphere_ns: 21_700, "ns", Assumed, 10000..=32000 in 0..=MAX, "one centre to transform instead of three vertices, but a conic to set up; taken as a triangle";
        /// CPU time to apply one edit to the display list.
        edit_ns: 10_000, "ns", Assumed, 2000..=50000 in 0..=MAX, "a few hundred instructions of display-list traversal";
        /// CPU time to begin a pass over the display list.
        pass_ns: 5_000, "ns", Assumed, 1000..=20000 in 0..=MAX, "concatenate matrices, reset bins";
    }
}

impl GpTiming {
    /// The Slats prototype of 1994: 30.0 us per triangle and eye, fitted to the limit of 110 triangles without the COPY
    /// optimisation (TR94). 29.8 to 30.1 us give exactly 110.
    pub const SLATS_1994: Self = Self { triangle_ns: 30_000, sphere_ns: 30_000, bin_entry_ns: 0, ..Self::PAPERS };

    /// The Slats code of 1995: 55.8 us per triangle and eye, fitted to the limit of about 100 triangles with the COPY
    /// optimisation (I3D95). 55.4 to 56.3 us give exactly 100.
    pub const SLATS_1995: Self = Self { triangle_ns: 55_800, sphere_ns: 55_800, bin_entry_ns: 0, ..Self::PAPERS };

    /// Slats with code that fits the instruction cache: a third of the time of 1994 (I3D95).
    pub const SLATS_OPTIMISED: Self = Self {
        triangle_ns: Self::SLATS_1994.triangle_ns / 3,
        sphere_ns: Self::SLATS_1994.sphere_ns / 3,
        ..Self::SLATS_1994
    };
}

// Times of primitives that follow from i860 code (derived from code): means over the three application scenes as
// `pxpl5_lab::code_times` measures them; its test holds these constants to the code. `message_ns` is what kernels/ring.s takes for a message
// or a chain, with the bins that tokens hand over: from 7.2 us (head) to 16.0 us under PPHIGS, 12.7 to 24.4 us under Slats.
// `pass_ns` is the beginning of a pass over one structure, as most scenes have it; at the cycle level several take more.
impl GpTiming {
    /// This table with the times of the scheduled code for Phong triangles of a frame, in bins: PPHIGS.
    #[must_use]
    pub const fn of_scheduled_phong(self) -> Self {
        Self {
            message_ns: 10_720,
            triangle_ns: 16_088,
            sphere_ns: 48_406,
            guard_ns: 213_466,
            bin_entry_ns: 1_914,
            edit_ns: 4_117,
            pass_ns: 127_721,
            ..self
        }
    }

    /// This table with the times of the compiled code for Gouraud triangles of a field, thirty in a clump: Slats.
    #[must_use]
    pub const fn of_compiled_gouraud(self) -> Self {
        Self {
            message_ns: 17_298,
            triangle_ns: 53_963,
            sphere_ns: 77_953,
            guard_ns: 133_222,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 227_882,
            ..self
        }
    }

    /// The same of the scheduled code.
    #[must_use]
    pub const fn of_scheduled_gouraud(self) -> Self {
        Self {
            message_ns: 20_132,
            triangle_ns: 20_295,
            sphere_ns: 78_420,
            guard_ns: 226_560,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 233_093,
            ..self
        }
    }
}

parameters::parameter_table! {
    /// Times of the host workstation and of its link to the ring.
    pub struct HostTiming {
        /// Rate of the link from the host to the ring.
        link_bytes_per_s: 5_000_000, "bytes/s", Assumed, 4000000..=10000000 in 1_000..=MAX, "a workstation's parallel interface";
        /// CPU time of the host to send or receive a message.
        message_ns: 20_000, "ns", Assumed, 10000..=100000 in 0..=MAX, "a system call";
        /// Time between two poses of the scene's own motion that the host sends unasked; with a tracker it sends what that delivers.
        view_period_ns: 16_683_333, "ns", Assumed, 8333333..=50000000 in 1_000..=MAX, "a tracker at about the field rate; TR94 gives 20 to 120 Hz";
    }
}

impl HostTiming {
    /// Time of `words` words on the link, rounded down to a picosecond.
    #[must_use]
    pub const fn link_span(&self, words: u32) -> Span {
        Span((words as u128 * 4 * 1_000_000_000_000 / self.link_bytes_per_s as u128) as u64)
    }

    /// The host as a board: only its software costs and the size of its memory matter.
    #[must_use]
    pub const fn board(&self) -> GpTiming {
        GpTiming { message_ns: self.message_ns, ..GpTiming::PAPERS }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parameters::ParameterTable;

    #[test]
    fn every_number_lies_in_its_range() {
        assert_eq!(GpTiming::PAPERS.out_of_range(), []);
        assert_eq!(HostTiming::PAPERS.out_of_range(), []);
    }

    /// The fits are what the papers' limits ask for, whatever the range of PPHIGS.
    #[test]
    fn every_preset_is_within_the_limits() {
        for preset in [GpTiming::SLATS_1994, GpTiming::SLATS_1995, GpTiming::SLATS_OPTIMISED] {
            assert_eq!(preset.check(), Ok(()));
        }
    }
}
