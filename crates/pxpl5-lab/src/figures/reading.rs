//! Interpretations of the questions that the papers leave open about Rendering Control.

use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_renderer::RendererTiming;
use pxpl5_run::{FinishedRegions, RenderingControl, Summary, retraces};
use serde::Serialize;

/// Definition of the samples that a published mean latency averages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Samples {
    /// One sample for each frame, from the start of TRANSFORM of its first eye.
    FirstEye,
    /// One sample for each eye of a frame, from the start of that eye's TRANSFORM.
    EachEye,
}

/// Definition of a published latency in fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FieldCount {
    /// A time, in fields of 1001/60000 s.
    Exact,
    /// The number of retraces, including the one of the swap.
    Whole,
}

/// An interpretation: one answer to each question that the papers leave open about the figures of Rendering Control.
///
/// The first two answers concern the figures, the others the machine and the scenes. All figures are measured with
/// one interpretation. None is chosen for a single figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Reading {
    /// Definition of the samples of a mean latency.
    pub samples: Samples,
    /// Definition of a latency printed in fields.
    pub fields: FieldCount,
    /// Number of finished regions that a renderer keeps in its backing store, 1 to [`ROOM`] (`renderer.kept_bits`).
    pub kept: u64,
    /// The master's rule for a renderer whose region is finished while the frame buffer is not available.
    #[serde(serialize_with = "by_name")]
    pub finished: FinishedRegions,
    /// Preset of the machine that drew the application scenes.
    pub machine: &'static str,
    /// True if the application scenes were drawn without their back faces.
    pub culled: bool,
    /// Number of eyes, 1 or 2, whose entries fill the bins when 7,700 triangles are drawn (`gp.bin_bytes`).
    pub bins: u64,
}

fn by_name<S: serde::Serializer>(finished: &FinishedRegions, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(finished.name())
}

/// Number of regions that fit in a renderer's backing store: 4,096 bits a pixel, of which the colours of a region take
/// a block of 32.
pub const ROOM: u64 = RendererTiming::PAPERS.backing_regions();

impl Reading {
    /// The interpretation with which figures are measured. `pxpl5 readings` ranks this interpretation among the best,
    /// and no text contradicts it.
    pub const USUAL: Self = Self {
        samples: Samples::EachEye,
        fields: FieldCount::Whole,
        kept: ROOM,
        finished: FinishedRegions::Wait,
        machine: "large",
        culled: true,
        bins: 1,
    };

    /// The rules of TR94 alone, on a machine that never delays them. The theory behind figures 3 and 5 rests on this
    /// interpretation.
    pub const THEORY: Self = Self { kept: ROOM, finished: FinishedRegions::Store, ..Self::USUAL };

    /// Returns the interpretations that differ in the answer to one question.
    #[must_use]
    pub fn neighbours(&self) -> Vec<Self> {
        Self::all().into_iter().filter(|other| self.differences(other) == 1).collect()
    }

    /// Returns every combination of answers.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = vec![Self::USUAL];
        all = varied(&all, &MACHINES, |reading, machine| Self { machine, ..reading });
        all = varied(&all, &[false, true], |reading, culled| Self { culled, ..reading });
        all = varied(&all, &FinishedRegions::ALL, |reading, finished| Self { finished, ..reading });
        all = varied(&all, &KEPT, |reading, kept| Self { kept, ..reading });
        all = varied(&all, &[1, 2], |reading, bins| Self { bins, ..reading });
        all = varied(&all, &[Samples::FirstEye, Samples::EachEye], |reading, samples| Self { samples, ..reading });
        varied(&all, &[FieldCount::Exact, FieldCount::Whole], |reading, fields| Self { fields, ..reading })
    }

    /// Returns the answers in words, in the order of the questions.
    fn answers(&self) -> [String; 7] {
        let samples = if self.samples == Samples::FirstEye { "first eye" } else { "each eye" };
        let fields = if self.fields == FieldCount::Exact { "exact" } else { "whole fields" };
        let kept = if self.kept == ROOM { "room for all".to_owned() } else { format!("{} kept", self.kept) };
        let faces = if self.culled { "culled" } else { "all faces" };
        let bins = if self.bins == 1 { "bins of one eye" } else { "bins of both eyes" };
        let [samples, fields, machine, faces, bins] = [samples, fields, self.machine, faces, bins].map(str::to_owned);
        [samples, fields, kept, self.finished.name().to_owned(), machine, faces, bins]
    }

    /// Returns the answers that differ from those of another interpretation, in words.
    #[must_use]
    pub fn difference(&self, other: &Self) -> String {
        let both = self.answers().into_iter().zip(other.answers());
        both.filter(|(mine, others)| mine != others).map(|(mine, _)| mine).collect::<Vec<_>>().join(", ")
    }

    fn differences(&self, other: &Self) -> usize {
        self.answers().iter().zip(&other.answers()).filter(|(mine, others)| mine != others).count()
    }

    /// Returns the pipeline under this interpretation.
    #[must_use]
    pub const fn pipeline(&self) -> RenderingControl {
        RenderingControl { finished: self.finished, ..RenderingControl::stereo() }
    }

    /// Returns a machine for Rendering Control under this interpretation.
    ///
    /// # Errors
    ///
    /// Returns [`ConfigError`] for a number of regions beyond the parameter's limits.
    pub fn on(&self, mut machine: MachineConfig) -> Result<MachineConfig, ConfigError> {
        if self.kept != Self::USUAL.kept {
            machine.set("renderer.kept_bits", machine.renderer.backing_bits / self.kept)?;
        }
        if self.bins != Self::USUAL.bins {
            machine.set("gp.bin_bytes", self.bins * machine.gp.bin_bytes)?;
        }
        Ok(machine)
    }

    /// Returns the samples of the latency to the swap, in milliseconds.
    #[must_use]
    pub fn latencies_ms<'a>(&self, summary: &'a Summary) -> &'a [f64] {
        match self.samples {
            Samples::FirstEye => &summary.latencies_ms,
            Samples::EachEye => &summary.eye_swap_latencies_ms,
        }
    }

    /// Converts a latency in milliseconds to fields.
    #[must_use]
    pub fn fields_of(&self, latency_ms: f64, field_ms: f64) -> f64 {
        match self.fields {
            FieldCount::Exact => latency_ms / field_ms,
            FieldCount::Whole => retraces(latency_ms, field_ms),
        }
    }
}

/// Presets of machines that could have drawn the application scenes.
const MACHINES: [&str; 4] = ["small-hmd", "medium", "design-maximum", "large"];

/// Numbers of regions that a renderer may keep. The last one fills the backing store.
const KEPT: [u64; 4] = [1, 2, 3, ROOM];

/// Returns each interpretation with each answer to one question.
fn varied<A: Copy>(readings: &[Reading], answers: &[A], answer: impl Fn(Reading, A) -> Reading) -> Vec<Reading> {
    readings.iter().flat_map(|reading| answers.iter().map(|one| answer(*reading, *one))).collect()
}

impl std::fmt::Display for Reading {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.answers().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_combination_occurs_once_and_the_usual_one_is_among_them() {
        let all = Reading::all();
        assert_eq!(all.len(), 4 * 2 * 2 * 4 * 2 * 2 * 2);
        assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
        assert!(all.contains(&Reading::USUAL) && all.contains(&Reading::THEORY));
    }

    #[test]
    fn a_neighbour_answers_one_question_differently() {
        // Three other machines, three other numbers of regions, and five questions with two answers.
        assert_eq!(Reading::USUAL.neighbours().len(), 3 + 3 + 5);
    }
}
