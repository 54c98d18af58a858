//! What a run keeps of what was observed.

/// What is kept of a run. No time, trace or statistic depends on it but in the last digits of means over more than
/// [`KEPT_SAMPLES`](crate::KEPT_SAMPLES) pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Keep {
    /// Every mark, arrival, swap and picture: for timelines, traces, and lists of pictures. 2 KB (Slats) to 100 KB (frameless) a
    /// field.
    #[default]
    Everything,
    /// Statistics of the whole run, and everything of its last pictures: memory and time a field do not depend on the length of
    /// the run. What is said of a head is summed up too, by whoever was handed in ([`Experiment::summed_by`](crate::Experiment::summed_by)); a
    /// report of a run with a head and without such a one says that this is missing. A run whose messages are recorded keeps everything, and
    /// so does a pipeline that cannot do without ([`Pipeline::can_forget`](crate::Pipeline::can_forget)).
    Statistics,
    /// As [`Keep::Statistics`], where messages are recorded too, and without sums of a head: what a page needs that shows a run as it goes on
    /// for hours. Of such a run pixel errors can be told of its last pictures alone, and traffic of its last periods.
    Recent,
}
