//! Interpretations of the papers: answers to the questions that the papers leave open about Rendering Control.

use pxpl5_machine::MachineConfig;
use pxpl5_renderer::RendererTiming;
use pxpl5_run::{FinishedRegions, RenderingControl, Summary, retraces};
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;

/// Definition of the samples whose mean is a printed latency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LatencySamples {
    /// Each frame gives one sample, which begins with TRANSFORM of the first eye.
    FirstEye,
    /// Each eye of a frame gives one sample, which begins with TRANSFORM of this eye.
    EachEye,
}

/// Definition of the unit "field" in a published latency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FieldCount {
    /// The latency divided by 1001/60000 s.
    Exact,
    /// The number of retraces during the latency, including the retrace of the swap.
    Whole,
}

/// One answer to each question that the papers leave open about the figures of Rendering Control.
///
/// The members `samples` and `fields` define the published latencies. All other members concern the machine and the
/// scenes. All figures are measured with the same interpretation, so that no answer is chosen for a single figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Interpretation {
    /// Definition of the samples whose mean is a printed latency.
    pub samples: LatencySamples,
    /// Definition of the unit "field" in a published latency.
    pub fields: FieldCount,
    /// Number of finished regions that a renderer keeps in its backing store, 1 to [`ROOM`] (`renderer.kept_bits`).
    pub kept: u64,
    /// The master's rule for a renderer with a finished region while the frame buffer is not available.
    #[serde(serialize_with = "by_name")]
    pub finished: FinishedRegions,
    /// Preset of the machine that drew the application scenes.
    pub machine: &'static str,
    /// True if the back faces of the application scenes were removed before drawing.
    pub culled: bool,
    /// Number of eyes (1 or 2) with entries in the bins when 7,700 triangles fill the bins (`gp.bin_bytes`).
    pub bins: u64,
}

fn by_name<S: serde::Serializer>(finished: &FinishedRegions, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(finished.name())
}

/// Number of regions that fit in a renderer's backing store. The store has 4,096 bits per pixel, and the colours of a
/// region take 32 bits per pixel.
pub const ROOM: u64 = RendererTiming::PAPERS.backing_regions();

impl Interpretation {
    /// The interpretation with which figures are measured. The text of the papers decides the definition of a field and
    /// the rule for finished regions. Figures decide the samples, the machine, culling and the bins, so the rows that
    /// depend on these answers are marked (see docs/decisions.md).
    pub const USUAL: Self = Self {
        samples: LatencySamples::EachEye,
        fields: FieldCount::Exact,
        kept: ROOM,
        finished: FinishedRegions::Store,
        machine: "large",
        culled: true,
        bins: 1,
    };

    /// Returns the interpretations that differ from `self` in the answer to exactly one question.
    pub fn neighbours(&self) -> Vec<Self> {
        Self::all().into_iter().filter(|other| self.differences(other) == 1).collect()
    }

    /// Returns all combinations of answers to the open questions.
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::USUAL];
        all = varied(&all, &MACHINES, |interpretation, machine| Self { machine, ..interpretation });
        all = varied(&all, &[false, true], |interpretation, culled| Self { culled, ..interpretation });
        all = varied(&all, &FinishedRegions::ALL, |interpretation, finished| Self { finished, ..interpretation });
        all = varied(&all, &KEPT, |interpretation, kept| Self { kept, ..interpretation });
        all = varied(&all, &[1, 2], |interpretation, bins| Self { bins, ..interpretation });
        all = varied(&all, &[LatencySamples::FirstEye, LatencySamples::EachEye], |interpretation, samples| Self {
            samples,
            ..interpretation
        });
        varied(&all, &[FieldCount::Exact, FieldCount::Whole], |interpretation, fields| Self {
            fields,
            ..interpretation
        })
    }

    fn answers(&self) -> [String; 7] {
        let samples = if self.samples == LatencySamples::FirstEye { "first eye" } else { "each eye" };
        let fields = if self.fields == FieldCount::Exact { "exact" } else { "whole fields" };
        let kept = if self.kept == ROOM { "room for all".to_owned() } else { format!("{} kept", self.kept) };
        let faces = if self.culled { "culled" } else { "all faces" };
        let bins = if self.bins == 1 { "bins of one eye" } else { "bins of both eyes" };
        let [samples, fields, machine, faces, bins] = [samples, fields, self.machine, faces, bins].map(str::to_owned);
        [samples, fields, kept, self.finished.name().to_owned(), machine, faces, bins]
    }

    /// Returns the answers of `self`, in words, that differ from the answers of `other`.
    pub fn difference(&self, other: &Self) -> String {
        let both = self.answers().into_iter().zip(other.answers());
        both.filter(|(mine, others)| mine != others).map(|(mine, _)| mine).collect::<Vec<_>>().join(", ")
    }

    fn differences(&self, other: &Self) -> usize {
        self.answers().iter().zip(&other.answers()).filter(|(mine, others)| mine != others).count()
    }

    /// Returns the pipeline Rendering Control with the rules of this interpretation.
    pub const fn pipeline(&self) -> RenderingControl {
        RenderingControl { finished: self.finished, ..RenderingControl::stereo() }
    }

    /// Adapts a machine for Rendering Control to this interpretation.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if `kept` is outside the limits of its parameter.
    pub fn on(&self, mut machine: MachineConfig) -> Result<MachineConfig, SettingError> {
        if self.kept != Self::USUAL.kept {
            machine.set("renderer.kept_bits", machine.renderer.backing_bits / self.kept)?;
        }
        if self.bins != Self::USUAL.bins {
            machine.set("gp.bin_bytes", self.bins * machine.gp.bin_bytes)?;
        }
        Ok(machine)
    }

    /// Returns the latency samples of a run in milliseconds, for frames or for eyes. Each latency ends at the swap.
    pub fn latencies_ms<'a>(&self, summary: &'a Summary) -> &'a [f64] {
        match self.samples {
            LatencySamples::FirstEye => &summary.latencies_ms,
            LatencySamples::EachEye => &summary.eye_swap_latencies_ms,
        }
    }

    /// Converts a latency in milliseconds to fields, by this interpretation's definition of the unit "field".
    pub fn fields_of(&self, latency_ms: f64, field_ms: f64) -> f64 {
        match self.fields {
            FieldCount::Exact => latency_ms / field_ms,
            FieldCount::Whole => retraces(latency_ms, field_ms),
        }
    }
}

/// Presets of machines that could have drawn the application scenes.
const MACHINES: [&str; 4] = ["small-hmd", "medium", "design-maximum", "large"];

/// Possible numbers of finished regions in a renderer's backing store. The last number fills the store.
const KEPT: [u64; 4] = [1, 2, 3, ROOM];

/// Returns one copy of each interpretation for each answer in `answers`. The function `answer` sets the answer in a
/// copy.
fn varied<A: Copy>(
    interpretations: &[Interpretation],
    answers: &[A],
    answer: impl Fn(Interpretation, A) -> Interpretation,
) -> Vec<Interpretation> {
    interpretations.iter().flat_map(|interpretation| answers.iter().map(|one| answer(*interpretation, *one))).collect()
}

impl std::fmt::Display for Interpretation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.answers().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_combination_of_answers_is_one_interpretation_and_the_usual_interpretation_is_in_the_list() {
        let all = Interpretation::all();
        assert_eq!(all.len(), 4 * 2 * 2 * 4 * 2 * 2 * 2);
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert!(all.contains(&Interpretation::USUAL));
    }

    #[test]
    fn a_neighbouring_interpretation_differs_in_the_answer_to_one_question() {
        // The neighbours are three other machines, three other numbers of regions, and the other answer to each of five
        // questions.
        assert_eq!(Interpretation::USUAL.neighbours().len(), 3 + 3 + 5);
    }
}
