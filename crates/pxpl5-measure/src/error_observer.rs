//! Sums of pixel errors, updated during a run or computed after it.

use crate::distribution::Distribution;
use crate::errors::{CENTRE, FieldMisregistration, PixelErrors, Showing, grid, lattice};
use crate::eye_report::{Device, EyeReport, EyeSum};
use crate::moved::{Moved, moved};
use crate::raster::{offset, pose_of_field};
use crate::registration::{Evaluated, Evaluator, Lost, middle};
use crate::reproject::Move;
use crate::reprojector::Reprojector;
use crate::rows::Rows;
use crate::shown::{Drawn, Moment, Seen, Shown};
use pxpl5_run::{Cause, Estimator, Every, FinalResults, HeadViews, Reprojection, Warp};
use pxpl5_sim::Time;
use pxpl5_wire::display::{Display, PixelLight, ScanOrder};
use pxpl5_wire::{PeriodNumber, ViewNumber};
use std::collections::BTreeSet;
use std::sync::Arc;
use tracking::view::{Misregistration, RasterOffset};

/// Sums of the pixel errors of a run's pictures, for one display mode (as drawn, shifted, moved or delayed).
#[derive(Debug, Default)]
pub(crate) struct ErrorSum {
    /// Display mode of the pictures. `None` uses the mode of the head's display.
    showing: Option<Showing>,
    without: Option<Cause>,
    /// Time by which all prediction intervals are too long, in picoseconds.
    later_ps: i64,
    evaluation: Option<Evaluation>,
    /// First period of the result window. `None` while the window is unknown.
    window_from: Option<PeriodNumber>,
    collected: Option<Collected>,
}

impl ErrorSum {
    /// Creates an empty sum for pictures in the display mode `showing`. If `without` is set, pictures are evaluated as
    /// if this cause of error did not exist. Their prediction intervals are longer by `later_ps`, or shorter.
    pub(crate) fn of(showing: Showing, without: Option<Cause>, later_ps: i64) -> Self {
        Self { showing: Some(showing), without, later_ps, ..Self::default() }
    }

    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let Some(head) = run.head else { return };
        let showing = self.showing.unwrap_or_else(|| head.head().raster.into());
        let evaluation = self.evaluation.get_or_insert_with(|| Evaluation::begin(run, head, showing, self.without));
        let window_from = run.window.map(|window| window.first_period);
        if self.window_from != window_from {
            // The window has moved. All sums so far belong to periods before the window.
            self.window_from = window_from;
            self.collected = None;
        }
        let display = run.record.display();
        let collected = self.collected.get_or_insert_with(|| {
            let eye = EyeSum::keeping(run.samples, !display.light().is_instant(), showing.device(display));
            Collected::keeping(run.samples, eye)
        });
        evaluation.shown.take(run, head);
        let fields = evaluation.fields(run);
        // With a cause turned off or a wrong interval, recompute the poses that these fields show.
        if self.without.is_some() || self.later_ps != 0 {
            evaluation.replace_poses(run, head, &fields, (self.without, self.later_ps));
        }
        fields.for_each(|field| evaluation.evaluate(run, field, collected));
        evaluation.shown.discard(run);
    }

    /// Returns the pixel errors. Also returns an [`EyeReport`] if pixels are lit for more than an instant, or if a
    /// device moves pictures.
    pub(crate) fn result(self) -> (PixelErrors, Option<EyeReport>) {
        self.collected.map(Collected::result).unwrap_or_default()
    }
}

#[derive(Debug)]
struct Evaluation {
    evaluator: Evaluator,
    shown: Shown,
    content: Content,
    head: Arc<HeadViews>,
    /// True if the error is evaluated at the instant for which the pixel was drawn, instead of the instant at which the
    /// pixel is lit.
    at_one_instant: bool,
    /// First display period whose pixels are not evaluated yet.
    next: PeriodNumber,
}

#[derive(Debug)]
enum Content {
    Plain,
    /// The display shifts the raster. The first value estimates poses. The second value is the raster offset of the
    /// current field, if the field has an offset.
    ShiftedRaster(Estimator, Option<RasterOffset>),
    Ideal(Estimator),
    Reprojected(Reprojector),
    DelayedVideo,
}

impl Showing {
    /// Returns the device that moves pictures, with the numbers of pixels and poses per second that the device needs on
    /// `display`. Returns `None` if no device moves pictures.
    fn device(self, display: &dyn Display) -> Option<Device> {
        let setting = match self {
            Self::RasterOffset => Reprojection::VDRT,
            Self::Reprojected(setting) => setting,
            Self::Plain | Self::Ideal | Self::DelayedVideo => return None,
        };
        let surface = display.surfaces().first()?;
        // Ticks are whole picoseconds, so the rate is a mean over many periods.
        const PERIODS: u64 = 60_000;
        let seconds = display.tick(PeriodNumber(PERIODS)).since(Time::ZERO).as_ms() * 1e-3;
        let periods_per_s = PERIODS as f64 / seconds;
        let [columns, lines] = [surface.width, surface.height / Rows::lit(display, PeriodNumber::FIRST).distance];
        // Strips follow each other in the direction of the scan.
        let along =
            if matches!(display.light().scan, ScanOrder::Right | ScanOrder::Left) { columns } else { surface.height };
        // A global scan lights all pixels at once, so the device can use only one pose per period.
        let poses = match (setting.every, display.light().scan) {
            (_, ScanOrder::Global) | (Every::Field, _) => 1,
            (Every::Strip, _) => along.div_ceil(Every::STRIP),
            (Every::Line, _) if along == columns => columns,
            (Every::Line, _) => lines,
        };
        Some(Device {
            setting,
            pixels_per_s: f64::from(columns) * f64::from(lines) * periods_per_s,
            poses_per_s: f64::from(poses) * periods_per_s,
        })
    }
}

impl Evaluation {
    fn begin(run: &FinalResults<'_>, head: &Arc<HeadViews>, showing: Showing, without: Option<Cause>) -> Self {
        let estimator = Estimator::new(head, without);
        let content = match showing {
            Showing::Plain => Content::Plain,
            Showing::RasterOffset => Content::ShiftedRaster(estimator, None),
            Showing::Ideal => Content::Ideal(estimator),
            Showing::Reprojected(setting) => Content::Reprojected(Reprojector::new(head, setting, without)),
            Showing::DelayedVideo => Content::DelayedVideo,
        };
        Self {
            evaluator: Evaluator::new(run, head),
            shown: Shown::begin(run, head),
            content,
            head: Arc::clone(head),
            at_one_instant: without == Some(Cause::ScanOut),
            next: PeriodNumber::FIRST,
        }
    }

    /// Returns the next periods of the result window to evaluate. Their results can no longer change.
    fn fields(&mut self, run: &FinalResults<'_>) -> impl Iterator<Item = PeriodNumber> + Clone + use<> {
        let fields = run.periods_from(self.next);
        self.next = self.next.max(run.until);
        fields
    }

    /// Replaces the poses of all visible views. The new poses are the poses that the run would have had without one
    /// cause of error, and with prediction intervals that are longer by some picoseconds.
    fn replace_poses(
        &mut self,
        run: &FinalResults<'_>,
        head: &Arc<HeadViews>,
        fields: &(impl Iterator<Item = PeriodNumber> + Clone),
        changed: (Option<Cause>, i64),
    ) {
        let display = run.record.display();
        let shown = &self.shown;
        // Find all views that some evaluated pixel shows.
        let of_field = |field: PeriodNumber| {
            let pixels = grid(display, field).into_iter();
            pixels.flat_map(move |(x, y, at)| shown.views_at(run, [x, y], field, at))
        };
        let seen: BTreeSet<ViewNumber> = fields.clone().flat_map(of_field).collect();
        self.shown.replace_poses(head, &seen, changed);
    }

    fn evaluate(&mut self, run: &FinalResults<'_>, field: PeriodNumber, collected: &mut Collected) {
        let display = run.record.display();
        // With a shifted raster, first find the offset of this field.
        if let Content::ShiftedRaster(estimator, of_field) = &mut self.content {
            let pose = pose_of_field(run, &self.shown, field);
            *of_field = pose.map(|pose| offset(estimator, display, field, &pose));
        }
        let pixels = grid(display, field);
        if let Content::Reprojected(reprojector) = &mut self.content {
            let places = pixels.iter().chain(&lattice(display, field)).map(|(x, y, _)| [*x, *y]).collect::<Vec<_>>();
            reprojector.begin(display, field, places.into_iter());
        }
        let light = display.light();
        let mut of_field = Vec::new();
        let mut centre = None;
        // Evaluate every pixel of the grid.
        for (i, (x, y, at)) in pixels.into_iter().enumerate() {
            // The pixel's content is fixed when the pixel begins to shine. Its position is evaluated at the middle of
            // the time in which it shines.
            let pixel = Pixel { place: [x, y], begins: at, light: at + light.centre() };
            let error = match &self.content {
                Content::Reprojected(reprojector) => self.moved_error(run, reprojector, field, pixel, collected),
                _ => {
                    let seen = self.seen(run, field, pixel);
                    self.smear(&seen, pixel, &light, &mut collected.eye);
                    self.error(pixel, &seen, collected)
                }
            };
            let Some(error) = error else { continue };
            of_field.push(error);
            if i == CENTRE {
                centre = Some(error);
            }
        }
        self.survey(run, field, collected);
        let begin = display.tick(field);
        collected.take(field, begin, &of_field, centre);
    }

    fn seen(&mut self, run: &FinalResults<'_>, field: PeriodNumber, Pixel { place, begins, light }: Pixel) -> Seen {
        match &mut self.content {
            Content::Plain | Content::DelayedVideo | Content::Reprojected(_) => {
                self.shown.seen(run, place, field, begins)
            }
            // Only whole views can be shifted. An interpolated picture or faces have no single pose.
            Content::ShiftedRaster(_, offset) => match self.shown.seen(run, place, field, begins) {
                Seen::Complete(Drawn::View(moment)) => {
                    let shift = offset.map(|offset| offset.shift_px(&self.evaluator.view, begins.0));
                    shift.map_or(Seen::Nothing, |shift| Seen::Complete(Drawn::ShiftedRaster(moment, shift)))
                }
                Seen::Complete(_) => Seen::Nothing,
                other => other,
            },
            Content::Ideal(estimator) => {
                let pose = estimator.pose(begins, light);
                Seen::Complete(Drawn::View(Moment { pose, objects_at: light, measured_at: None }))
            }
        }
    }

    /// Returns the error of a pixel. If the pixel shows no complete picture, returns `None` and increments the counter for
    /// the reason.
    fn error(&self, pixel: Pixel, seen: &Seen, collected: &mut Collected) -> Option<Misregistration> {
        let errors = &mut collected.errors;
        // Each reason has its own counter.
        let not_evaluated = match seen {
            Seen::Nothing => &mut errors.empty,
            Seen::Incomplete => &mut errors.incomplete,
            Seen::Before => &mut errors.before,
            Seen::Complete(drawn) => return Some(collected.count(self.error_of(pixel, drawn))),
        };
        *not_evaluated += 1;
        None
    }

    fn error_of(&self, pixel: Pixel, drawn: &Drawn) -> Evaluated {
        let place = middle(pixel.place[0], pixel.place[1]);
        let moment = self.evaluator.moment(drawn);
        if matches!(self.content, Content::DelayedVideo)
            && let Some(measured_at) = moment.measured_at
        {
            // The camera moves with the head. The picture of the camera is shown with the drawn picture for the same
            // measurement of the head.
            let content = self.evaluator.content(drawn, place);
            return self.evaluator.error_between(place, &content, measured_at, moment.objects_at);
        }
        let evaluated_at = if self.at_one_instant { drawn.instant(pixel.light) } else { pixel.light };
        self.evaluator.error(place, drawn, evaluated_at)
    }

    /// Returns the error of a pixel that a device moves to the newest pose. A pixel that the device leaves empty has the
    /// error of the picture without the device. Returns `None` if the pixel shows no complete picture.
    fn moved_error(
        &self,
        run: &FinalResults<'_>,
        reprojector: &Reprojector,
        field: PeriodNumber,
        pixel: Pixel,
        collected: &mut Collected,
    ) -> Option<Misregistration> {
        // Without a newest pose, the device cannot move the picture.
        let Some(newest) = reprojector.newest(run.record.display(), pixel.place) else {
            collected.errors.unfilled += 1;
            return self.error(pixel, &self.shown.seen(run, pixel.place, field, pixel.begins), collected);
        };
        let by = reprojector.setting.by;
        let found = moved((&self.evaluator, &self.shown, run), (by, &newest.pose), pixel.place, field, pixel.begins);
        let (content, drawn) = match found {
            Moved::Shows(content, drawn) => (content, drawn),
            Moved::NotComplete(seen) => return self.error(pixel, &seen, collected),
            Moved::Lost(_) => {
                collected.errors.unfilled += 1;
                return self.error(pixel, &self.shown.seen(run, pixel.place, field, pixel.begins), collected);
            }
        };
        collected.eye.pose(newest.measured_at, pixel.light);
        self.smear_of(&content, pixel, &run.record.display().light(), &mut collected.eye);
        let evaluated_at = if self.at_one_instant { drawn.instant(pixel.light) } else { pixel.light };
        let place = middle(pixel.place[0], pixel.place[1]);
        Some(collected.count(self.evaluator.error_of(place, &content, evaluated_at)))
    }

    fn smear(&self, seen: &Seen, pixel: Pixel, light: &PixelLight, eye: &mut EyeSum) {
        let Seen::Complete(drawn) = seen else { return };
        if !light.is_instant() {
            self.smear_of(&self.evaluator.content(drawn, middle(pixel.place[0], pixel.place[1])), pixel, light, eye);
        }
    }

    fn smear_of(&self, content: &crate::content::Content, pixel: Pixel, light: &PixelLight, eye: &mut EyeSum) {
        if light.is_instant() {
            return;
        }
        let from = Time(pixel.light.0.saturating_sub(light.width().0 / 2));
        if let Some(px) = self.evaluator.way_px(content, from, from + light.width()) {
            eye.smeared(px);
        }
    }

    /// Counts the screen positions of a field that show a part of the scene, and those that a device leaves empty.
    fn survey(&self, run: &FinalResults<'_>, field: PeriodNumber, collected: &mut Collected) {
        let display = run.record.display();
        let view = &self.evaluator.view;
        for (i, (x, y, at)) in lattice(display, field).into_iter().enumerate() {
            // A ray into the scene costs much more than a move of the picture, so only some positions get rays.
            let has_ray = i as u64 % RAY_EVERY == field.0 % RAY_EVERY;
            let place = middle(x, y);
            let drawn = match (&self.content, self.shown.seen(run, [x, y], field, at)) {
                (Content::Ideal(_), _) => {
                    Drawn::View(Moment { pose: self.head.truth(at), objects_at: at, measured_at: None })
                }
                (_, Seen::Complete(drawn)) => drawn,
                _ => continue,
            };
            let is_covered = if has_ray { self.evaluator.is_covered(&drawn, place) } else { None };
            collected.covered += u64::from(is_covered == Some(true));
            collected.surveyed += u64::from(is_covered.is_some());
            // Find the place in the drawn picture that the pixel shows. This place can lie beyond the edge of the
            // picture.
            let eye = &mut collected.eye;
            match &self.content {
                Content::ShiftedRaster(_, Some(offset)) => {
                    let arrived = self.head.report_by(display.tick(field));
                    eye.pose(arrived.and_then(|arrived| self.head.measured_at(arrived)), at);
                    eye.add_pixel(!view.contains(place - offset.shift_px(view, at.0)), false);
                }
                Content::Reprojected(reprojector) if reprojector.setting.by == Warp::Depth => {
                    let Some(newest) = reprojector.newest(display, [x, y]).filter(|_| has_ray) else { continue };
                    let now = (Warp::Depth, &newest.pose);
                    match moved((&self.evaluator, &self.shown, run), now, [x, y], field, at) {
                        Moved::Lost(lost) => eye.add_pixel(lost == Lost::Beyond, lost == Lost::Hidden),
                        Moved::Shows(..) => eye.add_pixel(false, false),
                        Moved::NotComplete(_) => {}
                    }
                }
                Content::Reprojected(reprojector) => {
                    let Some(newest) = reprojector.newest(display, [x, y]) else { continue };
                    let pose = self.evaluator.moment(&drawn).pose;
                    let from = Move::between(reprojector.setting.by, view, &pose, &newest.pose).source(view, place);
                    eye.add_pixel(!from.is_some_and(|from| view.contains(from)), false);
                }
                _ => {}
            }
        }
    }
}

/// One of this number of surveyed positions gets a ray into the scene.
const RAY_EVERY: u64 = 4;

/// A pixel of a field: the position of the pixel, the start of the time for which the pixel is lit, and the middle of
/// this time.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    place: [u32; 2],
    begins: Time,
    light: Time,
}

#[derive(Debug)]
struct Collected {
    grid: [Distribution; 2],
    centre: [Distribution; 2],
    fields_kept: usize,
    errors: PixelErrors,
    eye: EyeSum,
    /// Number of surveyed screen positions, and of those that show a part of the scene.
    surveyed: u64,
    covered: u64,
}

/// Number of pixel errors that are kept individually, for each field that is kept. For
/// [`KEPT_SAMPLES`](pxpl5_run::KEPT_SAMPLES) fields, the kept errors take 4 MiB in pixels and 4 MiB in degrees.
const KEPT_OF_GRID: usize = 8;

impl Collected {
    fn keeping(fields: usize, eye: EyeSum) -> Self {
        let both = |limit| [Distribution::keeping(limit), Distribution::keeping(limit)];
        let grid = both(fields.saturating_mul(KEPT_OF_GRID));
        Self {
            grid,
            centre: both(fields),
            fields_kept: fields,
            errors: PixelErrors::default(),
            eye,
            surveyed: 0,
            covered: 0,
        }
    }

    fn count(&mut self, found: Evaluated) -> Misregistration {
        self.errors.outside += u64::from(found.is_outside);
        self.errors.behind += u64::from(found.is_behind);
        found.error
    }

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

    fn result(self) -> (PixelErrors, Option<EyeReport>) {
        let eye = self.eye.result();
        let [pixels, degrees] = self.grid;
        let [centre_px, centre_deg] = self.centre.map(|errors| errors.percentiles());
        let of_grid = pixels.percentiles();
        let errors = PixelErrors {
            evaluated: of_grid.n,
            pixels: of_grid,
            degrees: degrees.percentiles(),
            centre_px,
            centre_deg,
            all_px: pixels.kept().to_vec(),
            covered_share: (self.surveyed > 0).then(|| self.covered as f64 / self.surveyed as f64),
            ..self.errors
        };
        (errors, eye)
    }
}

fn push([pixels, degrees]: &mut [Distribution; 2], error: &Misregistration) {
    pixels.push(error.pixels);
    degrees.push(error.degrees);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use pxpl5_machine::MachineConfig;
    use pxpl5_run::{Experiment, Head, KeptRecords, PipelineSettings, Pixels, Registry, StreamingObserver};
    use pxpl5_scene::builtin;
    use std::any::Any;
    use tracking::motion::Synthetic;
    use tracking::predict::PredictorKind;
    use tracking::tracker::TrackerConfig;

    /// A streaming observer that counts the views in memory after each step of a run.
    #[derive(Debug, Default)]
    struct Watched {
        sum: ErrorSum,
        held: Vec<usize>,
    }

    impl StreamingObserver for Watched {
        fn take(&mut self, results: &FinalResults<'_>) {
            self.sum.take(results);
            self.held.extend(self.sum.evaluation.iter().map(|evaluation| evaluation.shown.held()));
        }

        fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
            Box::new(self.held)
        }
    }

    /// Tests that the number of views in memory does not grow during a run that discards records.
    ///
    /// Records are discarded when there are enough of them, and again when their number has doubled. Each run is more
    /// than twice as long as the time until this first happens, so it also happens a second time.
    ///
    /// On an address recalculation display, the number of updates in each field depends on the motion. There the second
    /// half of the run needs at most twice the memory of the first half.
    #[test]
    fn the_memory_of_the_observer_does_not_grow_with_the_run() {
        for (name, scene, fields) in [
            ("slats", "sphere:10", 500),
            ("rendering-control", "sphere:10", 1_000),
            ("arp-full-line", "gallery", 2_500),
        ] {
            let pipeline = (Registry::of_papers().pipeline(name).expect("listed").build)(&PipelineSettings::default());
            let config = pipeline.adapt(MachineConfig::small_hmd());
            let motion = Arc::new(Synthetic::recorded_use(3));
            let head =
                Head::new(motion, TrackerConfig::fastrak(), PredictorKind::ConstantVelocity, 7).expect("in range");
            let experiment = Experiment::with(config, pipeline, Arc::new(builtin(scene).expect("built in"))).head(head);
            let experiment = experiment.fields(fields).pixels(Pixels::Off).keep(KeptRecords::Statistics);
            let outcome = experiment.observed_by(Some(|| Box::<Watched>::default())).run().expect("it runs");
            let held: &Vec<usize> = outcome.observed().expect("watched");
            let (first, second) = held.split_at(held.len() / 2);
            let [first, second] = [first, second].map(|half| half.iter().max().copied().expect("several steps"));
            let most = if name == "arp-full-line" { 2 * first } else { held[0] };
            assert!(first.max(second) <= most, "{name}: {held:?}");
        }
    }

    /// Tests an observer that stores three fields one by one and counts five. In field n, the middle pixel has an error
    /// of n pixels and n/8 degrees.
    #[test]
    fn a_limited_number_of_fields_is_kept_and_all_are_counted() {
        let mut collected = Collected::keeping(3, EyeSum::keeping(3, false, None));
        for field in 1..=5 {
            let error = Misregistration { offset_px: DVec2::ZERO, pixels: field as f64, degrees: field as f64 / 8.0 };
            let of_field = [error, Misregistration { pixels: 0.0, degrees: 0.0, ..error }];
            collected.take(PeriodNumber(field), Time(field), &of_field, Some(error));
        }
        let (result, eye) = collected.result();
        assert_eq!(eye, None);
        let kept: Vec<u64> = result.by_field.iter().map(|error| error.field.0).collect();
        assert_eq!(kept, [1, 2, 3]);
        assert_eq!(
            (result.evaluated, result.pixels.n, result.degrees.n, result.centre_px.n, result.centre_deg.n),
            (10, 10, 10, 5, 5)
        );
        assert!((result.centre_px.mean - 3.0).abs() < 1e-12 && (result.centre_deg.mean - 3.0 / 8.0).abs() < 1e-12);
        assert!((result.degrees.mean - 1.5 / 8.0).abs() < 1e-12, "half of them are 0");
    }
}
