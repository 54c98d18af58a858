/// Number of records below which a run discards nothing. A record, such as an arrival or a swap, takes about 80 bytes.
pub(crate) const MIN_RECORDS: usize = 32_768;

/// The records that a run keeps in memory.
///
/// The choice changes no time and no trace.
///
/// Two runs that differ only in this choice have the same statistics. Only the last digits of means over more than
/// [`KEPT_SAMPLES`](crate::KEPT_SAMPLES) pictures can differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KeptRecords {
    /// Keeps all time stamps, arrivals, swaps and pictures, for timelines, traces and lists of pictures. The
    /// observations of one field take 2 KB (Slats) to 100 KB (frameless rendering).
    #[default]
    Everything,
    /// Keeps statistics of the whole run, and all observations of its last pictures. Memory does not depend on the
    /// length of the run.
    ///
    /// The results for a tracked head need the streaming observer of
    /// [`Experiment::observed_by`](crate::Experiment::observed_by). Two kinds of runs keep everything nevertheless: a
    /// run that records messages, and a run of a pipeline that needs old records
    /// ([`PipelineProperties::can_discard_records`](crate::PipelineProperties::can_discard_records)).
    Statistics,
    /// The run keeps the same data as under [`KeptRecords::Statistics`], but messages may be recorded, and no streaming
    /// observer is used.
    ///
    /// A web page that displays a run for hours uses this choice. Pixel errors and messages are available only for the
    /// last periods.
    Recent,
}

impl KeptRecords {
    /// All choices of [`KeptRecords`], with their names in experiment files.
    pub const ALL: [(&str, Self); 3] =
        [("everything", Self::Everything), ("statistics", Self::Statistics), ("recent", Self::Recent)];
}

pxpl5_sim::parameters::named!(KeptRecords, "choice of observations", KeptRecords::ALL);
