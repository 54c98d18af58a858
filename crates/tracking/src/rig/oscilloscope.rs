/// A step of an oscilloscope channel from low to high or from high to low.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScopeEdge {
    /// Instant of the step, ps of simulated time.
    pub t_ps: u64,
    /// Level of the channel after the step: true is high.
    pub high: bool,
}

/// The trace of one oscilloscope channel. The level is low before the first step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScopeTrace {
    /// Name of the signal on this channel.
    pub name: &'static str,
    edges: Vec<ScopeEdge>,
}

impl ScopeTrace {
    /// Creates a trace from pairs of an instant (ps) and a level, in order of time. Each level lasts until the next
    /// instant.
    pub fn sampled(name: &'static str, samples: impl IntoIterator<Item = (u64, bool)>) -> Self {
        let mut edges: Vec<ScopeEdge> = Vec::new();
        for (t_ps, high) in samples {
            if high != edges.last().is_some_and(|last| last.high) {
                edges.push(ScopeEdge { t_ps, high });
            }
        }
        Self { name, edges }
    }

    /// Creates a trace that changes its level at each of the instants `instants` (ps).
    pub fn toggling(name: &'static str, mut instants: Vec<u64>) -> Self {
        instants.sort_unstable();
        let edges = instants.into_iter().enumerate().map(|(i, t_ps)| ScopeEdge { t_ps, high: i % 2 == 0 });
        Self { name, edges: edges.collect() }
    }

    /// Creates a trace with a pulse at each of the instants `instants` (ps). A pulse has the width `width_ps` and is
    /// centred on the instant.
    pub(super) fn pulsing(name: &'static str, instants: impl Iterator<Item = u64>, width_ps: u64) -> Self {
        let ends = instants.flat_map(|t| [t.saturating_sub(width_ps / 2), t.saturating_add(width_ps / 2)]);
        Self::toggling(name, ends.collect())
    }

    /// Returns the steps of the trace in order of time.
    pub fn edges(&self) -> &[ScopeEdge] {
        &self.edges
    }

    /// Returns the level of the trace at an instant. At a step, the result is the new level.
    pub fn level(&self, t_ps: u64) -> bool {
        let after = self.edges.partition_point(|edge| edge.t_ps <= t_ps);
        after > 0 && self.edges[after - 1].high
    }

    /// Returns the trace as a time series of levels 0 and 1 at `from`, `from + step`, ... before `to`. A step of 0
    /// counts as 1 ps.
    pub fn samples(&self, from_ps: u64, to_ps: u64, step_ps: u64) -> impl Iterator<Item = (u64, f64)> {
        (from_ps..to_ps)
            .step_by(usize::try_from(step_ps.max(1)).unwrap_or(usize::MAX))
            .map(|t_ps| (t_ps, f64::from(u8::from(self.level(t_ps)))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_toggling_line_is_low_then_high_then_low() {
        let trace = ScopeTrace::toggling("screen", vec![30, 10]);
        assert_eq!([9, 10, 29, 30].map(|t| trace.level(t)), [false, true, true, false]);
    }

    #[test]
    fn a_sampled_line_has_an_edge_where_its_level_changes() {
        let trace = ScopeTrace::sampled("screen", [(5, false), (10, true), (20, true), (30, false)]);
        assert_eq!(trace, ScopeTrace::toggling("screen", vec![10, 30]));
    }

    #[test]
    fn a_pulse_is_centred_on_its_time() {
        let trace = ScopeTrace::pulsing("low point", [100, 200].into_iter(), 10);
        assert_eq!([94, 95, 104, 105, 195].map(|t| trace.level(t)), [false, true, true, false, true]);
    }

    #[test]
    fn samples_of_a_trace_are_its_levels_at_the_sample_times() {
        let trace = ScopeTrace::toggling("screen", vec![10, 30]);
        let levels: Vec<f64> = trace.samples(0, 50, 10).map(|(_, v)| v).collect();
        assert_eq!(levels, [0.0, 1.0, 1.0, 0.0, 0.0]);
    }
}
