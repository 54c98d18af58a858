//! All timing parameters of the board. The host workstation uses the same model with other parameters.

use crate::CodeVersion;
use pxpl5_sim::Span;
use pxpl5_sim::parameters::{ParameterTable, Value};

pxpl5_sim::parameters::parameter_table! {
    /// CPU times and memory sizes of a graphics processor.
    pub struct GpTiming {
        /// Size of the memory of one board.
        memory_bytes: 8_388_608, "bytes", Published, 8388608..=8388608 in 0..=1_073_741_824, "TR94: 8 MB";
        /// Part of the memory for the bins of Rendering Control. The two sets of bins (contexts) share this part.
        bin_bytes: 51_360, "bytes", Derived, 51_040..=51_680 in 0..=MAX, "TR94: the bins of 12 slaves hold 7,700 triangles that cover the screen. Each slave has 642 of them in 20 bins, with 4 bytes for a pointer. The value is twice as large if the bins hold 7,700 triangles for each eye";
        /// CPU time to send a batch of messages or to receive one message.
        message_ns: 12_000, "ns", Assumed, 10000..=25000 in 0..=MAX, "software of a message; the published latencies allow this range";
        /// CPU time of one triangle for one eye. In this time, the graphics processor transforms, lights and sets up
        /// the triangle, and makes its commands.
        triangle_ns: 21_700, "ns", Derived, 18000..=32000 in 0..=MAX, "870 clocks at 40 MHz for optimised PPHIGS; the design goal of 1 M a second over 32 GPs is 32 us (F89)";
        /// CPU time to put one entry into a bin.
        bin_entry_ns: 1_000, "ns", Assumed, 500..=2000 in 0..=MAX, "a pointer store and a count, partly out of cache";
        /// CPU time of each bin entry when a slave receives a token and sends the bin to its renderer.
        token_entry_ns: 0, "ns", Assumed, 0..=0 in 0..=MAX, "included in the time of a message, because no separate time was published; times of code count it separately";
        /// Additional CPU time of a triangle that needs clipping.
        guard_ns: 0, "ns", Assumed, 0..=0 in 0..=MAX, "included in the published time of a triangle; times of code count it separately";
        /// CPU time of one sphere for one eye.
        sphere_ns: 21_700, "ns", Assumed, 10000..=32000 in 0..=MAX, "the same as a triangle: one transformed centre instead of three vertices, and the set-up of a conic";
        /// CPU time to apply one edit of the host to the display list.
        edit_ns: 10_000, "ns", Assumed, 2000..=50000 in 0..=MAX, "a few hundred instructions of display-list traversal";
        /// CPU time to begin a pass over the display list.
        pass_ns: 5_000, "ns", Assumed, 1000..=20000 in 0..=MAX, "concatenate matrices, reset bins";
        /// CPU time to transform one structure of the display list for one eye, without its primitives.
        structure_ns: 0, "ns", Assumed, 0..=0 in 0..=MAX, "included in the time of a pass, because no time was published; times of code count it separately";
        /// Extra CPU time of each display-list structure that contains spheres, for each eye. The graphics processor
        /// spends this time to compute the view data that all spheres of the structure need.
        sphere_view_ns: 0, "ns", Assumed, 0..=0 in 0..=MAX, "included in the time of a pass, like the time of a structure; times of code count it separately";
    }
}

impl GpTiming {
    /// Timing of the Slats prototype of 1994: the times of this project's compiled code, to which nothing is fitted.
    pub const SLATS_1994: Self = Self::PAPERS.of_compiled_precomputed();

    /// Timing of the Slats prototype of 1994 by a fit: 32.0 us of CPU time for each triangle and eye. This time is
    /// fitted to the published limit of 110 triangles without the COPY optimization (TR94). Any time from 31.9 to 32.1
    /// us gives this limit.
    pub const SLATS_FITTED: Self = Self { triangle_ns: 32_000, sphere_ns: 32_000, bin_entry_ns: 0, ..Self::PAPERS };

    /// Timing of the Slats code of 1995: 59.8 us of CPU time for each triangle and eye. This time is fitted to the
    /// published limit of about 100 triangles with the COPY optimization (I3D95). Any time from 59.5 to 60.0 us gives a
    /// limit of exactly 100 triangles. The program of 1995 was another one: the compiled code of this project takes
    /// about half of this time.
    pub const SLATS_1995: Self = Self { triangle_ns: 59_800, sphere_ns: 59_800, bin_entry_ns: 0, ..Self::PAPERS };

    /// Timing of Slats with code that fits in the instruction cache.
    pub const SLATS_OPTIMISED: Self = Self::SLATS_1994.optimised();

    /// Returns this timing with a third of the time of a triangle and of a sphere. I3D95 names the factor for code that
    /// fits in the instruction cache.
    #[must_use]
    pub const fn optimised(self) -> Self {
        Self { triangle_ns: self.triangle_ns / 3, sphere_ns: self.sphere_ns / 3, ..self }
    }
}

/// Source of the times of i860 code.
const OF_CODE: &str = "mean time of this project's i860 code over three scenes (docs/gp-timing.md; the example gp_timing \
                       and the tests of pxpl5-lab measure it again)";

impl GpTiming {
    /// Returns the source of a time that is not in the table of the papers but in another table of this module. Returns
    /// `None` for all other times.
    pub fn source_of(name: &str, value: Value) -> Option<&'static str> {
        const OTHERS: [(GpTiming, &str); 8] = [
            (GpTiming::SLATS_1994, OF_CODE),
            (GpTiming::PAPERS.of_scheduled_phong(), OF_CODE),
            (GpTiming::PAPERS.of_scheduled_precomputed(), OF_CODE),
            (GpTiming::PAPERS.of_compiled_gouraud(), OF_CODE),
            (GpTiming::PAPERS.of_scheduled_gouraud(), OF_CODE),
            (
                GpTiming::SLATS_OPTIMISED,
                "a third of the time of compiled code, the gain of code that fits the cache (I3D95)",
            ),
            (GpTiming::SLATS_FITTED, "fitted to the limit of 110 triangles (TR94, figure 12)"),
            (GpTiming::SLATS_1995, "fitted to the limit of 100 triangles (I3D95, figure 14)"),
        ];
        let has = |table: &Self| table.get(name).ok() == Some(value);
        OTHERS.iter().find(|(table, _)| has(table) && !has(&Self::PAPERS)).map(|(_, source)| *source)
    }
}

/// A pipeline with its own i860 code for triangles and spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeUse {
    /// PPHIGS: whole frames, Phong shading, commands in bins.
    Pphigs,
    /// Slats: fields, precomputed colours, clumps of thirty triangles, and one pass for both eyes.
    Slats,
    /// Slats with commands for touched regions only: as `Slats`, with bins and a separate pass for each eye.
    SlatsTouched,
    /// Slats with lighting on the graphics processor: fields, clumps of thirty triangles, and a separate pass for each
    /// eye.
    SlatsLit,
}

impl CodeUse {
    /// Returns true if this version of the code draws triangles with planes in single precision.
    pub const fn is_single(self, version: CodeVersion) -> bool {
        matches!((self, version), (Self::Slats, CodeVersion::Compiled))
    }
}

// Times of primitives that follow from i860 code (derived from code). They are means over the three application scenes,
// measured by examples/code_times. A test of pxpl5-lab compares these constants with the code.
//
// `message_ns` is the time of kernels/ring.s for a message or a chain, which differs between scenes
// (docs/gp-timing.md). It is also the time of kernels/token.s for a token without entries. `token_entry_ns` is the time
// for each entry of a token.
//
// `pass_ns` is the time at the start of a pass for work that does not belong to structures: to reset bins, and to load
// code into the caches. A structure with culling takes 3.2 us more than other structures. The table does not contain
// this difference.
impl GpTiming {
    /// Returns this timing table with the times that triangles and spheres take in i860 code. `version` is the version
    /// of the code, and `of` is its pipeline.
    ///
    /// PPHIGS has times only for scheduled code, which fits in the instruction cache like all PPHIGS code in the
    /// papers.
    #[must_use]
    pub const fn of_code(self, version: CodeVersion, of: CodeUse) -> Self {
        match (of, version) {
            (CodeUse::Pphigs, _) => self.of_scheduled_phong(),
            (CodeUse::Slats, CodeVersion::Scheduled) => self.of_scheduled_precomputed(),
            (CodeUse::Slats, _) => self.of_compiled_precomputed(),
            (CodeUse::SlatsTouched, CodeVersion::Scheduled) => self.of_scheduled_touched(),
            (CodeUse::SlatsTouched, _) => self.of_compiled_touched(),
            (CodeUse::SlatsLit, CodeVersion::Scheduled) => self.of_scheduled_gouraud(),
            (CodeUse::SlatsLit, _) => self.of_compiled_gouraud(),
        }
    }

    /// Returns this timing table with the times of triangles and spheres in PPHIGS: scheduled code, Phong
    /// triangles, whole frames, and commands in bins.
    #[must_use]
    pub const fn of_scheduled_phong(self) -> Self {
        Self {
            message_ns: 5_133,
            triangle_ns: 16_088,
            sphere_ns: 48_406,
            guard_ns: 213_466,
            bin_entry_ns: 1_914,
            token_entry_ns: 525,
            edit_ns: 4_117,
            pass_ns: 29_734,
            structure_ns: 98_708,
            sphere_view_ns: 21_397,
            ..self
        }
    }

    /// Returns this timing table with the times of triangles and spheres in Slats: compiled code in single precision
    /// (slats_rules.md), fields, and precomputed vertex colours. A clump has thirty triangles, and one pass makes the
    /// commands of both eyes.
    #[must_use]
    pub const fn of_compiled_precomputed(self) -> Self {
        Self {
            message_ns: 16_166,
            triangle_ns: 27_361,
            sphere_ns: 77_890,
            guard_ns: 212_090,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 9_470,
            structure_ns: 98_551,
            sphere_view_ns: 32_422,
            ..self
        }
    }

    /// Returns this timing table with the times of triangles and spheres in Slats: scheduled code, fields, and
    /// precomputed vertex colours. Triangles are sent in clumps.
    #[must_use]
    pub const fn of_scheduled_precomputed(self) -> Self {
        Self {
            message_ns: 20_246,
            triangle_ns: 17_362,
            sphere_ns: 78_164,
            guard_ns: 218_040,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 26_581,
            structure_ns: 98_757,
            sphere_view_ns: 24_897,
            ..self
        }
    }

    /// Returns this timing table with the times of Slats with commands for touched regions only: compiled code, fields,
    /// precomputed vertex colours, bins, and a pass for each eye.
    #[must_use]
    pub const fn of_compiled_touched(self) -> Self {
        Self {
            message_ns: 9_929,
            triangle_ns: 30_903,
            sphere_ns: 55_571,
            // The fit gives less than 0, because an entry of a triangle that is cut costs less than the mean entry.
            guard_ns: 0,
            bin_entry_ns: 17_306,
            edit_ns: 4_117,
            pass_ns: 22_793,
            structure_ns: 98_735,
            sphere_view_ns: 27_156,
            ..self
        }
    }

    /// Returns this timing table with the times of Slats in scheduled code that sends commands only to the touched
    /// regions. Otherwise, the program is that of [`Self::of_compiled_touched`].
    #[must_use]
    pub const fn of_scheduled_touched(self) -> Self {
        Self {
            message_ns: 12_446,
            triangle_ns: 18_036,
            sphere_ns: 68_804,
            guard_ns: 144_903,
            bin_entry_ns: 7_318,
            edit_ns: 4_117,
            pass_ns: 31_690,
            structure_ns: 98_749,
            sphere_view_ns: 22_759,
            ..self
        }
    }

    /// Returns this timing table with the times of triangles and spheres in Slats with lighting: compiled code, fields,
    /// and Gouraud triangles. A clump has thirty triangles.
    #[must_use]
    pub const fn of_compiled_gouraud(self) -> Self {
        Self {
            message_ns: 17_298,
            triangle_ns: 53_963,
            sphere_ns: 77_953,
            guard_ns: 133_222,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 12_739,
            structure_ns: 98_826,
            sphere_view_ns: 31_622,
            ..self
        }
    }

    /// Returns this timing table with the times of triangles and spheres in Slats with lighting: code scheduled by
    /// hand, fields, and Gouraud triangles. Triangles are sent in clumps.
    #[must_use]
    pub const fn of_scheduled_gouraud(self) -> Self {
        Self {
            message_ns: 20_132,
            triangle_ns: 20_295,
            sphere_ns: 78_420,
            guard_ns: 226_560,
            bin_entry_ns: 0,
            edit_ns: 4_117,
            pass_ns: 25_343,
            structure_ns: 98_832,
            sphere_view_ns: 25_584,
            ..self
        }
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Times of the host workstation and of the link between host and ring.
    pub struct HostTiming {
        /// Data rate of the link from the host to the ring.
        link_bytes_per_s: 5_000_000, "bytes/s", Assumed, 4000000..=10000000 in 1_000..=MAX, "a workstation's parallel interface";
        /// CPU time of the host to send or receive one message.
        message_ns: 20_000, "ns", Assumed, 10_000..=10_000_000 in 0..=MAX, "no source: at least a system call, at most a tick of a Unix clock of 100 Hz. A host that writes PHIGS edits and matrices through a driver may need milliseconds";
        /// Time between two successive poses that the host sends, if the scene defines the motion of the head. With a
        /// tracker, this time has no effect, because the host sends the tracker's reports.
        view_period_ns: 16_683_333, "ns", Assumed, 8333333..=50000000 in 1_000..=MAX, "about 60 Hz: TR94 needs new tracking data 60 times a second. WARD92 gives 20 to 100 Hz, PF 120 Hz";
        /// Mean time of the application on the host between the EDIT of a frame and the next frame. This time has an
        /// effect only if the host waits for EDIT.
        application_ns: 0, "ns", Assumed, 0..=20000000 in 0..=MAX, "0: the host asks at once; within the range, and with the jitter, a trivial scene keeps its printed 30 frames/s";
        /// Greatest deviation of the application's time from its mean. The time of each frame is chosen from a uniform
        /// distribution. The deviation must not exceed the mean.
        application_jitter_ns: 0, "ns", Assumed, 0..=10000000 in 0..=MAX, "a tick of a Unix clock of 100 Hz";
    }
}

impl HostTiming {
    /// Returns the time of `words` words on the link, rounded down to a picosecond.
    pub const fn link_span(&self, words: u32) -> Span {
        Span((words as u128 * 4 * 1_000_000_000_000 / self.link_bytes_per_s as u128) as u64)
    }

    /// Returns the application's time for one frame, from a uniform distribution around the mean. `drawn` is a random
    /// 64-bit number that selects the time.
    pub const fn application_span(&self, drawn: u64) -> Span {
        let jitter = if self.application_jitter_ns < self.application_ns {
            self.application_jitter_ns
        } else {
            self.application_ns
        };
        let spread = (drawn as u128 * (2 * jitter as u128 + 1)) >> 64;
        Span::from_ns(self.application_ns - jitter + spread as u64)
    }

    /// Returns the timing table of the board that models the host. The host model uses only two values of the table:
    /// the CPU time to send or receive a message, and the memory size.
    pub const fn board(&self) -> GpTiming {
        GpTiming { message_ns: self.message_ns, ..GpTiming::PAPERS }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the fitted times per triangle: 32.0 us fits the published limit of 110 triangles (1994), and 59.8 us fits
    /// 100 triangles (1995). Slats has no bins, so a bin entry takes no time.
    #[test]
    fn the_fitted_times_of_slats_follow_from_its_published_limits() {
        let presets = [GpTiming::SLATS_FITTED, GpTiming::SLATS_1995];
        let times = presets.map(|preset| [preset.triangle_ns, preset.sphere_ns, preset.bin_entry_ns]);
        assert_eq!(times, [32_000, 59_800].map(|ns| [ns, ns, 0]));
    }

    /// I3D95 expects a third of the time for code that fits the instruction cache. Each other time of a preset has a
    /// source of its own, and times of the papers keep theirs.
    #[test]
    fn each_time_of_a_preset_of_slats_states_its_source() {
        let source = |ns: u64| GpTiming::source_of("triangle_ns", ns.into()).expect("not of the papers");
        assert!(source(GpTiming::SLATS_1994.triangle_ns).contains("i860 code"));
        assert!(source(GpTiming::SLATS_1994.triangle_ns / 3).contains("a third"));
        assert!(source(32_000).contains("110 triangles") && source(59_800).contains("100 triangles"));
        assert_eq!(GpTiming::source_of("triangle_ns", GpTiming::PAPERS.triangle_ns.into()), None);
        assert_eq!(GpTiming::source_of("triangle_ns", 12_345.into()), None);
    }

    /// Tests the timing tables with times of i860 code. They must replace every time of the published table that i860
    /// code determines.
    #[test]
    fn tables_of_code_replace_every_time_of_code() {
        let mut before = GpTiming::PAPERS;
        for entry in GpTiming::PAPERS.entries() {
            before.set(entry.info.name, 1.into()).expect("a number of nanoseconds or bytes");
        }
        let times = |table: GpTiming| {
            [
                table.message_ns,
                table.triangle_ns,
                table.sphere_ns,
                table.guard_ns,
                table.edit_ns,
                table.pass_ns,
                table.structure_ns,
                table.sphere_view_ns,
            ]
        };
        let tables = [before.of_scheduled_phong(), before.of_compiled_gouraud(), before.of_scheduled_gouraud()];
        for table in tables {
            assert!(times(table).iter().all(|ns| *ns > 1_000), "{table:?}");
        }
        assert!(tables[0].bin_entry_ns > 100 && tables[0].token_entry_ns > 100);
        assert_eq!([tables[1].bin_entry_ns, tables[2].bin_entry_ns], [0, 0], "Slats has no bins");
    }

    #[test]
    fn the_applications_time_varies_around_its_mean_and_is_never_negative() {
        let host = |application_ns, application_jitter_ns| HostTiming {
            application_ns,
            application_jitter_ns,
            ..HostTiming::PAPERS
        };
        let ends = |host: HostTiming| [0, 1 << 63, u64::MAX].map(|drawn| host.application_span(drawn));
        assert_eq!(ends(HostTiming::PAPERS), [Span::ZERO; 3], "it asks at once");
        assert_eq!(ends(host(5_000, 0)), [Span::from_ns(5_000); 3]);
        assert_eq!(ends(host(5_000, 2_000)), [3_000, 5_000, 7_000].map(Span::from_ns));
        assert_eq!(ends(host(5_000, 9_000)), [0, 5_000, 10_000].map(Span::from_ns), "the spread ends at the mean");
    }

    #[test]
    fn a_word_on_the_hosts_link_takes_the_time_of_four_bytes() {
        // 5 MB/s give 800 ns per word, and 3 bytes per second give 4/3 s.
        assert_eq!(HostTiming::PAPERS.link_span(7), Span::from_ns(5_600));
        let slow = HostTiming { link_bytes_per_s: 3, ..HostTiming::PAPERS };
        assert_eq!(slow.link_span(1), Span(1_333_333_333_333));
        let host = HostTiming { message_ns: 77, ..HostTiming::PAPERS };
        assert_eq!(host.board(), GpTiming { message_ns: 77, ..GpTiming::PAPERS });
    }
}
