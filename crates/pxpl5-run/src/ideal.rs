use crate::display_list::display_list_for;
use crate::experiment::Experiment;
use crate::head_views::HeadViews;
use crate::pipeline::PipelineProperties;
use crate::result::outcome::Outcome;
use crate::scene_views::{SceneViews, hmd_on, view};
use crate::views::ViewSource;
use pphigs::oracle::IdealPicture;
use pphigs::{Picture, RegionBinning};
use pxpl5_geometry::Viewport;
use pxpl5_machine::Record;
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, Lines, SurfaceId, ViewNumber};

impl Outcome {
    /// Returns the picture that a surface would show at `time` if drawing took no time. Returns `None` for a surface
    /// that does not exist.
    ///
    /// The head has its true pose at this time. Shading, and the widths of all numbers in bits, are the same as in the
    /// pipeline.
    ///
    /// For a still scene and a still head, every complete picture of the machine equals this picture. The only
    /// exceptions are pixels where several primitives have exactly the same depth ([`IdealPicture::ties`]).
    pub fn ideal_picture(&self, surface: impl Into<SurfaceId>, time: Time) -> Option<IdealPicture> {
        ideal_picture(self.experiment(), self.record(), self.head().map(AsRef::as_ref), surface.into(), time)
    }
}

pub(crate) fn ideal_picture(
    experiment: &Experiment,
    record: &Record,
    head: Option<&HeadViews>,
    surface: SurfaceId,
    time: Time,
) -> Option<IdealPicture> {
    let scene = experiment.scene();
    let surface = surface.index();
    let properties = experiment.pipeline().properties();
    let PipelineProperties { eyes, layout, shading, .. } = properties;
    let surfaces = record.display().surfaces();
    // The pipeline may draw fewer eyes than the display has surfaces.
    let size = surfaces.get(surface).filter(|_| surface < eyes)?;
    let list = display_list_for(scene, &properties, record.config()).ok()?;
    let hmd = hmd_on(record.display(), &experiment.hmd);
    // A tracked head is at its true pose, not at the predicted one.
    let view = match head {
        Some(head) => view(scene, &hmd, eyes, ViewNumber::FIRST, time, &head.truth(time).in_single_precision()),
        None => SceneViews::new(scene, experiment.seed, hmd, eyes).newest(ViewNumber::FIRST, time),
    };
    let drawn = |viewport| {
        let picture = Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: true };
        pphigs::oracle::ideal_picture(&list, &view, surface, &picture)
    };
    // The program of Slats computes the planes of each field in single precision, so their rounding depends on the
    // field.
    if list.is_single {
        let fields = [FieldParity::Even, FieldParity::Odd].map(|parity| drawn(Viewport::field(parity)));
        return Some(IdealPicture::interlaced(&fields));
    }
    Some(drawn(Viewport::new(size.grid(), Lines::Frame).ok()?))
}
