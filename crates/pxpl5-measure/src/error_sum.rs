//! Sums of pixel errors, updated during a run or computed after it.

use crate::distribution::Distribution;
use crate::errors::{CENTRE, FieldMisregistration, PixelErrors, Showing, grid};
use crate::raster::{offset, pose_of_field};
use crate::registration::{Evaluator, middle};
use crate::shown::{Drawn, Moment, Seen, Shown};
use pxpl5_run::{Cause, Estimator, FinalResults, HeadViews};
use pxpl5_sim::Time;
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::collections::BTreeSet;
use std::sync::Arc;
use tracking::view::{Misregistration, RasterOffset};

/// Sums the errors of a run's pictures as they are displayed.
#[derive(Debug, Default)]
pub(crate) struct ErrorSum {
    /// Display mode of the pictures. `None` uses the mode of the head's display.
    showing: Option<Showing>,
    without: Option<Cause>,
    judging: Option<Evaluation>,
    /// First period of the result window, as far as known.
    window_from: Option<PeriodNumber>,
    collected: Option<Collected>,
}

impl ErrorSum {
    /// Creates a sum with a given display mode, optionally with one cause of error turned off.
    pub(crate) fn of(showing: Showing, without: Option<Cause>) -> Self {
        Self { showing: Some(showing), without, ..Self::default() }
    }

    /// Evaluates the periods that are final.
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let Some(head) = run.head else { return };
        let showing = self.showing.unwrap_or_else(|| head.head().raster().into());
        let judging = self.judging.get_or_insert_with(|| Evaluation::begin(run, head, showing, self.without));
        let window_from = run.window.map(|window| window.first_period);
        if self.window_from != window_from {
            // The window has moved: everything summed so far lies before it.
            self.window_from = window_from;
            self.collected = None;
        }
        let collected = self.collected.get_or_insert_with(|| Collected::keeping(run.samples));
        judging.shown.take(run, head);
        let fields = judging.fields(run);
        // With a cause turned off, recompute the poses that these fields show.
        if let Some(cause) = self.without {
            judging.replace_poses(run, head, &fields, cause);
        }
        fields.for_each(|field| judging.judge(run, field, collected));
        judging.shown.forget(run);
    }

    pub(crate) fn said(self) -> PixelErrors {
        self.collected.map(Collected::said).unwrap_or_default()
    }
}

/// State of the evaluation of a run's pixels.
#[derive(Debug)]
struct Evaluation {
    judge: Evaluator,
    shown: Shown,
    content: Content,
    /// True if a pixel is evaluated at the instant it was drawn for, instead of the instant of its light.
    at_one_instant: bool,
    /// First period that is not evaluated yet.
    next: PeriodNumber,
}

/// Display mode of the pixels under evaluation.
#[derive(Debug)]
enum Content {
    Plain,
    /// The display shifts the raster. The offset is that of the current field, if the field has one.
    AdvancedMotion(Estimator, Option<RasterOffset>),
    Ideal(Estimator),
}

impl Evaluation {
    fn begin(run: &FinalResults<'_>, head: &Arc<HeadViews>, showing: Showing, without: Option<Cause>) -> Self {
        let estimator = Estimator::new(head, without);
        let content = match showing {
            Showing::Plain => Content::Plain,
            Showing::RasterOffset => Content::AdvancedMotion(estimator, None),
            Showing::Ideal => Content::Ideal(estimator),
        };
        Self {
            judge: Evaluator::new(run, head),
            shown: Shown::begin(run, head),
            content,
            at_one_instant: without == Some(Cause::ScanOut),
            next: PeriodNumber::FIRST,
        }
    }

    /// Returns the periods of the window that are final and not evaluated yet.
    fn fields(&mut self, run: &FinalResults<'_>) -> impl Iterator<Item = PeriodNumber> + Clone + use<> {
        let fields = run.periods_from(self.next);
        self.next = self.next.max(run.until);
        fields
    }

    /// Replaces the poses of the visible views by those that the run would have had without one cause of error.
    fn replace_poses(
        &mut self,
        run: &FinalResults<'_>,
        head: &Arc<HeadViews>,
        fields: &(impl Iterator<Item = PeriodNumber> + Clone),
        cause: Cause,
    ) {
        let display = run.record.display();
        let shown = &self.shown;
        // Find all views that some evaluated pixel shows.
        let of_field = |field: PeriodNumber| {
            let pixels = grid(display, field).into_iter();
            pixels.flat_map(move |(x, y, at)| shown.views_at(run, [x, y], field, at))
        };
        let seen: BTreeSet<ViewNumber> = fields.clone().flat_map(of_field).collect();
        self.shown.replace_poses(head, &seen, cause);
    }

    fn judge(&mut self, run: &FinalResults<'_>, field: PeriodNumber, collected: &mut Collected) {
        // With a shifted raster, first find the offset of this field.
        if let Content::AdvancedMotion(estimator, of_field) = &mut self.content {
            let pose = pose_of_field(run, &self.shown, field);
            *of_field = pose.map(|pose| offset(estimator, run.record.display(), field, &pose));
        }
        let mut of_field = Vec::new();
        let mut centre = None;
        // Evaluate every pixel of the grid.
        for (i, (x, y, at)) in grid(run.record.display(), field).into_iter().enumerate() {
            let seen = self.seen(run, [x, y], field, at);
            let Some(error) = self.error([x, y], at, seen, collected) else { continue };
            of_field.push(error);
            if i == CENTRE {
                centre = Some(error);
            }
        }
        let begin = run.record.display().tick(field);
        collected.take(field, begin, &of_field, centre);
    }

    fn seen(&mut self, run: &FinalResults<'_>, place: [u32; 2], field: PeriodNumber, at: Time) -> Seen {
        match &mut self.content {
            Content::Plain => self.shown.seen(run, place, field, at),
            // Only whole views can be shifted. An interpolated picture or faces have no single pose.
            Content::AdvancedMotion(_, offset) => match self.shown.seen(run, place, field, at) {
                Seen::Complete(Drawn::View(moment)) => {
                    let shift = offset.map(|offset| offset.shift_px(&self.judge.view, at.0));
                    shift.map_or(Seen::Nothing, |shift| Seen::Complete(Drawn::AdvancedMotion(moment, shift)))
                }
                Seen::Complete(_) => Seen::Nothing,
                other => other,
            },
            Content::Ideal(estimator) => {
                Seen::Complete(Drawn::View(Moment { pose: estimator.pose(at, at), objects_at: at }))
            }
        }
    }

    /// Returns the error of a pixel. If there is none, increments the counter of the reason.
    fn error(&self, [x, y]: [u32; 2], at: Time, seen: Seen, collected: &mut Collected) -> Option<Misregistration> {
        let errors = &mut collected.errors;
        // Each reason has its own counter.
        let (error, unjudged) = match seen {
            Seen::Nothing => (None, &mut errors.empty),
            Seen::Incomplete => (None, &mut errors.incomplete),
            Seen::Before => (None, &mut errors.before),
            Seen::Complete(drawn) => {
                let evaluated_at = if self.at_one_instant { drawn.instant(at) } else { at };
                (self.judge.error(middle(x, y), &drawn, evaluated_at), &mut errors.behind)
            }
        };
        *unjudged += u64::from(error.is_none());
        error
    }
}

/// Errors collected so far.
#[derive(Debug)]
struct Collected {
    grid: [Distribution; 2],
    centre: [Distribution; 2],
    fields_kept: usize,
    /// Counters, and the errors of each field.
    errors: PixelErrors,
}

/// Number of grid values kept for each kept field. The limit corresponds to 4 MiB for pixels and 4 MiB for degrees.
const KEPT_OF_GRID: usize = 8;

impl Collected {
    fn keeping(fields: usize) -> Self {
        let both = |limit| [Distribution::keeping(limit), Distribution::keeping(limit)];
        let grid = both(fields.saturating_mul(KEPT_OF_GRID));
        Self { grid, centre: both(fields), fields_kept: fields, errors: PixelErrors::default() }
    }

    /// Adds the errors of a field that begins at the instant `begin`.
    fn take(
        &mut self,
        field: PeriodNumber,
        begin: Time,
        of_field: &[Misregistration],
        centre: Option<Misregistration>,
    ) {
        of_field.iter().for_each(|error| push(&mut self.grid, error));
        let Some(centre) = centre else { return };
        push(&mut self.centre, &centre);
        if self.errors.by_field.len() < self.fields_kept {
            let mean_px = of_field.iter().map(|error| error.pixels).sum::<f64>() / of_field.len() as f64;
            let time_s = begin.since(Time::ZERO).as_ms() * 1e-3;
            self.errors.by_field.push(FieldMisregistration { field, time_s, mean_px, centre_px: centre.pixels });
        }
    }

    fn said(self) -> PixelErrors {
        let [pixels, degrees] = self.grid;
        let [centre_px, centre_deg] = self.centre.map(|errors| errors.percentiles());
        let of_grid = pixels.percentiles();
        PixelErrors {
            judged: of_grid.n,
            pixels: of_grid,
            degrees: degrees.percentiles(),
            centre_px,
            centre_deg,
            all_px: pixels.kept().to_vec(),
            ..self.errors
        }
    }
}

/// Adds an error in pixels to the first distribution, and in degrees to the second.
fn push([pixels, degrees]: &mut [Distribution; 2], error: &Misregistration) {
    pixels.push(error.pixels);
    degrees.push(error.degrees);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use pxpl5_machine::MachineConfig;
    use pxpl5_run::{Experiment, Head, Keep, PipelineSettings, Pixels, Registry, StreamingObserver};
    use pxpl5_scene::builtin;
    use std::any::Any;
    use tracking::motion::Synthetic;
    use tracking::predict::PredictorKind;
    use tracking::tracker::TrackerConfig;

    /// A streaming observer that records the number of held views after each step of a run.
    #[derive(Debug, Default)]
    struct Watched {
        sum: ErrorSum,
        held: Vec<usize>,
    }

    impl StreamingObserver for Watched {
        fn take(&mut self, settled: &FinalResults<'_>) {
            self.sum.take(settled);
            self.held.extend(self.sum.judging.iter().map(|judging| judging.shown.held()));
        }

        fn said(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
            Box::new(self.held)
        }
    }

    /// A run that discards its records holds no more views at its end than after the first time it discarded records.
    #[test]
    fn what_is_held_of_a_run_does_not_grow_with_it() {
        for (name, scene, fields) in [
            ("slats", "sphere:10", 1_000),
            ("rendering-control", "sphere:10", 1_000),
            ("arp-full-line", "gallery", 2_000),
        ] {
            let pipeline = (Registry::of_papers().pipeline(name).expect("listed").build)(&PipelineSettings::default());
            let config = pipeline.adapt(MachineConfig::small_hmd());
            let motion = Arc::new(Synthetic::recorded_use(3));
            let head =
                Head::new(motion, TrackerConfig::fastrak(), PredictorKind::ConstantVelocity, 7).expect("in range");
            let experiment = Experiment::with(config, pipeline, Arc::new(builtin(scene).expect("built in"))).head(head);
            let experiment = experiment.fields(fields).pixels(Pixels::Off).keep(Keep::Statistics);
            let outcome = experiment.observed_by(Some(|| Box::<Watched>::default())).run().expect("it runs");
            let held: &Vec<usize> = outcome.said().expect("watched");
            assert!(held.len() > 1 && held.iter().all(|later| *later <= held[0]), "{name}: {held:?}");
        }
    }

    /// Evaluates five fields with a limit of three. The middle pixel of field n has an error of n pixels and n/8
    /// degrees.
    #[test]
    fn so_many_fields_are_kept_one_by_one_and_all_of_them_counted() {
        let mut collected = Collected::keeping(3);
        for field in 1..=5 {
            let error = Misregistration { offset_px: DVec2::ZERO, pixels: field as f64, degrees: field as f64 / 8.0 };
            let of_field = [error, Misregistration { pixels: 0.0, degrees: 0.0, ..error }];
            collected.take(PeriodNumber(field), Time(field), &of_field, Some(error));
        }
        let said = collected.said();
        let kept: Vec<u64> = said.by_field.iter().map(|error| error.field.0).collect();
        assert_eq!(kept, [1, 2, 3]);
        assert_eq!(
            (said.judged, said.pixels.n, said.degrees.n, said.centre_px.n, said.centre_deg.n),
            (10, 10, 10, 5, 5)
        );
        assert!((said.centre_px.mean - 3.0).abs() < 1e-12 && (said.centre_deg.mean - 3.0 / 8.0).abs() < 1e-12);
        assert!((said.degrees.mean - 1.5 / 8.0).abs() < 1e-12, "half of them are 0");
    }
}
