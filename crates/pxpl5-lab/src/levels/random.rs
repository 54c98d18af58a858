//! Random experiments that every level of detail supports.
//!
//! The experiments run Rendering Control and Slats on NTSC displays without a tracker. Their machines and scenes are
//! small enough for the cycle level. Parameters lie anywhere in the ranges of their sources. The number of an
//! experiment determines all of its settings.

use pphigs::RegionBinning;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Pixels, RenderingControl, Slats, Summary, TestScene};
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::SplitMix64;
use std::sync::Arc;

/// Numbers of display fields in a run of Rendering Control and in a run of Slats. The first number suffices for a dozen
/// frames at 20 Hz after the warm-up.
const FIELDS: (u64, u64) = (48, 14);

/// Returns the random experiment `number` without pixels. Even numbers give experiments with Rendering Control, odd
/// numbers give experiments with Slats.
///
/// # Errors
///
/// [`ExperimentError::Scene`] never occurs, because the scenes are built in. [`ExperimentError::Config`] never occurs,
/// because the parameters exist.
pub fn experiment(number: u64) -> Result<Experiment, ExperimentError> {
    let mut random = SplitMix64::new(number << 8 | 0x1e);
    let experiment = if number.is_multiple_of(2) { stereo(&mut random)? } else { slats(&mut random)? };
    Ok(experiment.pixels(Pixels::Off))
}

fn stereo(random: &mut SplitMix64) -> Result<Experiment, ExperimentError> {
    let machine = machine("small-hmd", random, (4, 24))?;
    // One of three kinds of scenes: the aircraft, screen-filling triangles, small triangles.
    let scene = match random.between(0, 2) {
        0 => builtin("mig")?.decimated(random.between(100, 417) as usize)?,
        1 => TestScene::FullScreen.with_triangles(random.between(1, 30) as u32),
        _ => TestScene::Typical.with_triangles(random.between(20, 600) as u32),
    };
    let seed = random.between(1, 99);
    Ok(Experiment::new(machine, RenderingControl::stereo(), scene).fields(FIELDS.0).seed(seed))
}

fn slats(random: &mut SplitMix64) -> Result<Experiment, ExperimentError> {
    let preset = random.element(&["slats", "slats-1995"]);
    let machine = machine(preset, random, (1, 12))?;
    let binning = random.element(&[RegionBinning::All, RegionBinning::Touched]);
    let program = Slats { binning, ..random.element(&[Slats::whole(), Slats::split()]) };
    // Larger machines get larger scenes.
    let triangles = random.between(5, 50 + 10 * machine.n_gps as u64) as u32;
    let scene: Scene = TestScene::Typical.with_triangles(triangles);
    Ok(Experiment::new(machine, program, Arc::new(scene)).fields(FIELDS.1))
}

/// Changes a preset at random: the numbers of boards, ring parameters within the ranges of their sources, and the size of
/// the FIFO chips.
/// At least two ring channels remain for the transfer of finished regions, because the analytic level requires two
/// channels.
fn machine(preset: &str, random: &mut SplitMix64, gps: (u64, u64)) -> Result<MachineConfig, ExperimentError> {
    let mut machine = MachineConfig::preset(preset)?;
    machine.n_gps = random.between(gps.0, gps.1) as usize;
    machine.n_renderers = random.between(5, 20) as usize;
    machine.set("ring.source_channels", random.between(1, 2))?;
    machine.set("ring.fifo_channels", random.between(5, 6))?;
    machine.set("renderer.fifo_words", random.element(&[256_u64, 512, 1_024, 2_048]))?;
    Ok(machine)
}

/// Returns the time that is compared between levels, in milliseconds
/// ([`PipelineProperties::compared_ms`](pxpl5_run::PipelineProperties::compared_ms)). The value is NaN if no picture was
/// shown in time.
pub fn compared_ms(experiment: &Experiment, summary: &Summary) -> f64 {
    if summary.latencies_ms.is_empty() {
        return f64::NAN;
    }
    (experiment.pipeline().properties().compared_ms)(summary)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_experiment_can_be_run_and_follows_from_its_number() {
        for number in 0..400 {
            let [one, other] = [experiment(number), experiment(number)].map(|made| made.expect("in range"));
            assert_eq!(one.config_hash(), other.config_hash());
            assert!(one.config().check().is_ok(), "{number}");
        }
    }
}
