//! What an ideal renderer would show in an outcome's place.

use crate::display_list::{display_list_for, hmd_before, view, views};
use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::outcome::Outcome;
use pphigs::{Picture, RegionBinning};
use pxpl5_geometry::Viewport;
use pxpl5_machine::Record;
use pxpl5_oracle::IdealPicture;
use pxpl5_sim::Time;
use pxpl5_wire::{Lines, SurfaceId, ViewNumber};

impl Outcome {
    /// What a viewer of a surface should see of the scene as it is at a time: all lines of it, drawn by an ideal renderer
    /// with the shading and the widths of the pipeline. The head is where the scene's own motion has it at that time, or a
    /// tracked head truly is.
    ///
    /// Of a still scene and a still head every complete picture of the machine is this one, but for its
    /// [ties](IdealPicture::ties). `None` for a surface that the first display or the pipeline does not have.
    #[must_use]
    pub fn ideal_picture(&self, surface: impl Into<SurfaceId>, time: Time) -> Option<IdealPicture> {
        ideal_picture(self.experiment(), self.record(), self.head().map(AsRef::as_ref), surface.into(), time)
    }
}

/// The same of an experiment that is still running.
pub(crate) fn ideal_picture(
    experiment: &Experiment,
    record: &Record,
    head: Option<&HeadViews>,
    surface: SurfaceId,
    time: Time,
) -> Option<IdealPicture> {
    let pipeline = experiment.pipeline();
    let scene = experiment.scene();
    let surface = surface.index();
    let eyes = pipeline.eyes();
    let surfaces = record.display().surfaces();
    let size = surfaces.get(surface).filter(|_| surface < eyes)?;
    let list = display_list_for(scene, pipeline.shading()).ok()?;
    let hmd = hmd_before(surfaces.first());
    let view = match head {
        Some(head) => view(scene, &hmd, eyes, ViewNumber::FIRST, time, &head.truth(time).in_single_precision()),
        None => views(scene, experiment.seed_of_motion(), hmd, eyes).0(ViewNumber::FIRST, time),
    };
    let viewport = Viewport::new(size.grid(), Lines::Frame).ok()?;
    let layout = pipeline.layout();
    let shading = pipeline.shading();
    let picture = Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: true };
    Some(pxpl5_oracle::ideal_picture(&list, &view, surface, &picture))
}
