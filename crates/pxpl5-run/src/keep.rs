//! Choice of the observations that a run keeps.

/// Choice of the observations that a run keeps. The choice changes no time and no trace. Statistics change only in the
/// last digits of means over more than [`KEPT_SAMPLES`](crate::KEPT_SAMPLES) pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Keep {
    /// All marks, arrivals, swaps and pictures, for timelines, traces and lists of pictures. A field takes 2 KB (Slats)
    /// to 100 KB (frameless).
    #[default]
    Everything,
    /// Statistics of the whole run, and all observations of its last pictures. Memory, and computing time per field, do
    /// not depend on the length of the run.
    ///
    /// The streaming observer of [`Experiment::observed_by`](crate::Experiment::observed_by) computes the results for a
    /// tracked head. Without an observer, the report marks these results as missing. Two kinds of runs keep everything
    /// nevertheless: a run that records messages, and a run of a pipeline that needs old records
    /// ([`Pipeline::can_discard_records`](crate::Pipeline::can_discard_records)).
    Statistics,
    /// Like [`Keep::Statistics`], but also with recorded messages, and without a streaming observer. A page that
    /// displays a run for hours uses this choice. Pixel errors are available for the last pictures only, and traffic
    /// for the last periods only.
    Recent,
}
