//! Pictures after a device has moved the pictures to the newest pose.

use crate::depth_warp::{DepthPicture, Drawing};
use crate::registration::{Evaluator, middle};
use crate::reproject::{Move, fill_row, move_row};
use crate::reprojector::Reprojector;
use crate::rows::Rows;
use crate::shown::{Drawn, Moment, Shown};
use image::RgbImage;
use pxpl5_run::{Every, FinalResults, HeadViews, Reprojection, Warp};
use pxpl5_wire::display::{Display, ScanOrder};
use pxpl5_wire::{PeriodNumber, REGION_SIZE};
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

#[derive(Debug)]
pub(crate) struct PictureMover<'a> {
    run: FinalResults<'a>,
    head: Arc<HeadViews>,
    evaluator: Evaluator,
    shown: Shown,
    setting: Reprojection,
    /// The depths that were computed last. They are kept because successive fields often show the same picture.
    latest: RefCell<Option<(Moment, Rows, Arc<DepthPicture>)>>,
}

impl<'a> PictureMover<'a> {
    pub(crate) fn new(run: FinalResults<'a>, head: &Arc<HeadViews>, setting: Reprojection) -> Self {
        let evaluator = Evaluator::new(&run, head);
        Self {
            evaluator,
            shown: Shown::of_run(&run, head),
            head: Arc::clone(head),
            setting,
            run,
            latest: RefCell::default(),
        }
    }

    /// Writes the moved rows that a field lights. Rows that show no drawn picture stay unchanged.
    pub(crate) fn move_rows(&self, screen: &RgbImage, field: PeriodNumber, out: &mut RgbImage) {
        let reprojector = self.reprojector(screen, field);
        if self.setting.by != Warp::Depth || !self.move_whole_rows(&reprojector, screen, field, out) {
            self.move_pieces(&reprojector, screen, field, out);
        }
    }

    fn reprojector(&self, screen: &RgbImage, field: PeriodNumber) -> Reprojector {
        let display = self.run.record.display();
        let mut reprojector = Reprojector::new(&self.head, self.setting, None);
        let rows = Rows::lit(display, field).of(screen.height());
        let places = rows.flat_map(|y| self.pieces(display, screen.width()).map(move |xs| [xs.start, y]));
        reprojector.begin(display, field, places);
        reprojector
    }

    /// Writes the moved rows of a field in pieces, because pieces of one row can show different pictures.
    fn move_pieces(&self, reprojector: &Reprojector, screen: &RgbImage, field: PeriodNumber, out: &mut RgbImage) {
        let display = self.run.record.display();
        for y in Rows::lit(display, field).of(screen.height()) {
            for xs in self.pieces(display, screen.width()) {
                self.move_piece(reprojector, screen, field, (y, xs), out);
            }
        }
    }

    /// Returns ranges of pixels in a row. All pixels of a range move to one pose. A range covers a region, or a single
    /// pixel if each column has its own pose.
    fn pieces(&self, display: &dyn Display, width: u32) -> impl Iterator<Item = Range<u32>> + use<> {
        let sideways = matches!(display.light().scan, ScanOrder::Right | ScanOrder::Left);
        let length = if sideways && self.setting.every == Every::Line { 1 } else { REGION_SIZE };
        (0..width).step_by(length as usize).map(move |x| x..(x + length).min(width))
    }

    /// Writes the rows of a field, moved by the depths of their pixels, if the field shows one picture of one pose.
    /// Returns false without writing if the field shows several pictures, or if a row has several poses.
    fn move_whole_rows(
        &self,
        reprojector: &Reprojector,
        screen: &RgbImage,
        field: PeriodNumber,
        out: &mut RgbImage,
    ) -> bool {
        let display = self.run.record.display();
        if matches!(display.light().scan, ScanOrder::Right | ScanOrder::Left) && self.setting.every != Every::Field {
            return false;
        }
        let Some(drawn_for) = self.only_moment(screen, field) else { return false };
        let rows = Rows::lit(display, field);
        let newest = |row: u32| reprojector.newest(display, [0, row]).map(|newest| newest.pose);
        let poses: Option<Vec<_>> = rows.of(screen.height()).map(newest).collect();
        let Some(poses) = poses else { return false };
        let depths = self.depths(&drawn_for, [screen.width(), screen.height()], rows);
        let drawing =
            Drawing { picture: screen, depths: &depths, view: &self.evaluator.view, rows, drawn_for: &drawn_for.pose };
        // Successive rows of one pose are moved together.
        let mut row = 0;
        for same in poses.chunk_by(|a, b| a == b) {
            let next = row + same.len() as u32;
            drawing.move_rows(&same[0], row..next, out);
            row = next;
        }
        true
    }

    /// Returns the pose and the time for which all pixels of a field were drawn. Returns `None` if the pixels differ in
    /// pose or time, or if a pixel shows no complete picture.
    fn only_moment(&self, screen: &RgbImage, field: PeriodNumber) -> Option<Moment> {
        let display = self.run.record.display();
        let mut only: Option<Moment> = None;
        for y in Rows::lit(display, field).of(screen.height()) {
            for xs in self.pieces(display, screen.width()) {
                let x = xs.start.midpoint(xs.end - 1);
                let at = display.lights(0, x, y, field)?;
                let Drawn::View(moment) = self.shown.drawn(&self.run, [x, y], field, at)? else { return None };
                let first = *only.get_or_insert(moment);
                if !first.is_same_picture(&moment) {
                    return None;
                }
            }
        }
        only
    }

    /// Returns the depths of a picture's rows. The depth of each pixel comes from one ray, which is cast only once for
    /// a picture.
    fn depths(&self, drawn_for: &Moment, size: [u32; 2], rows: Rows) -> Arc<DepthPicture> {
        let mut latest = self.latest.borrow_mut();
        if let Some((moment, of_rows, depths)) = &*latest
            && moment.is_same_picture(drawn_for)
            && *of_rows == rows
        {
            return Arc::clone(depths);
        }
        let depth = |x, y| self.evaluator.depth(drawn_for, middle(x, y)) as f32;
        let depths = Arc::new(DepthPicture::of_field(size, rows, depth));
        *latest = Some((*drawn_for, rows, Arc::clone(&depths)));
        depths
    }

    fn move_piece(
        &self,
        reprojector: &Reprojector,
        screen: &RgbImage,
        field: PeriodNumber,
        (y, xs): (u32, Range<u32>),
        out: &mut RgbImage,
    ) {
        let display = self.run.record.display();
        let rows = Rows::lit(display, field);
        // All pixels of the range have one pose, so the middle pixel represents them.
        let x = xs.start.midpoint(xs.end - 1);
        let lit = display.lights(0, x, y, field);
        let drawn = lit.and_then(|at| self.shown.drawn(&self.run, [x, y], field, at));
        // Without a drawn picture or a pose, the pixels stay where they are.
        let (Some(drawn), Some(newest)) = (drawn, reprojector.newest(display, [xs.start, y])) else {
            xs.for_each(|x| out.put_pixel(x, y, *screen.get_pixel(x, y)));
            return;
        };
        let moment = self.evaluator.moment(&drawn);
        // With depth, each pixel has its own displacement.
        if self.setting.by == Warp::Depth {
            let from = |x| self.evaluator.warped(&moment, &newest.pose, middle(x, y)).ok().map(|(_, from)| from);
            fill_row(screen, rows, (y, xs), from, out);
            return;
        }
        let moved = Move::between(self.setting.by, &self.evaluator.view, &moment.pose, &newest.pose);
        move_row(screen, rows, (y, xs), (&self.evaluator.view, &moved), out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use image::Rgb;
    use pxpl5_machine::MachineConfig;
    use pxpl5_run::{Experiment, Head, PipelineSettings, Pixels, Registry};
    use pxpl5_scene::builtin;
    use tracking::motion::{Motion, Slide};
    use tracking::predict::PredictorKind;
    use tracking::tracker::TrackerConfig;
    use tracking::{Pose, SettingSink};

    /// A head that moves to the right at 1 m/s and turns to the left at 1 rad/s.
    #[derive(Clone, Copy, Debug)]
    struct SlidingTurn;

    impl Motion for SlidingTurn {
        fn pose(&self, t_ps: u64) -> Pose {
            let turn = tracking::rotation::about_y(t_ps as f64 * 1e-12 - 0.35);
            Pose { orientation: turn, ..Slide::right_at(1.0).pose(t_ps) }
        }
        fn identify(&self, settings: &mut SettingSink) {
            settings("motion", &"sliding turn");
        }
        fn velocity(&self, t_ps: u64) -> DVec3 {
            Slide::right_at(1.0).velocity(t_ps)
        }
        fn angular_velocity(&self, _: u64) -> DVec3 {
            DVec3::Y
        }
    }

    /// Tests a picture that is moved with its depths against rays into the scene. The two pictures may differ at the
    /// edges of objects, and elsewhere by one pixel because of rounding.
    #[test]
    fn a_moved_mesh_with_depth_agrees_with_rays_from_both_poses() {
        let registry = Registry::of_papers();
        let pipeline = (registry.pipeline("jitp-field").expect("listed").build)(&PipelineSettings::default());
        let motion = Arc::new(SlidingTurn);
        let head = Head::new(motion, TrackerConfig::ideal(), PredictorKind::None, 1).expect("in range");
        let scene = Arc::new(builtin("gallery").expect("built in"));
        let experiment = Experiment::with(MachineConfig::small_hmd(), pipeline, scene).head(head);
        let outcome = experiment.fields(24).pixels(Pixels::Off).run().expect("it is small");
        let run = outcome.final_results();
        let places = |x: u32, y: u32| Rgb([(x >> 8) as u8 + 1 + 8 * (y >> 8) as u8, x as u8, y as u8]);
        let screen = RgbImage::from_fn(640, 480, places);
        let place = |pixel: &Rgb<u8>| {
            let [high, x, y] = pixel.0.map(u32::from);
            (high > 0).then(|| [(high - 1) % 8 * 256 + x, (high - 1) / 8 * 256 + y])
        };
        for (every, field) in [(Every::Field, 20), (Every::Strip, 21), (Every::Line, 21)] {
            // Without prediction, a picture has the pose at which its drawing began. The newest pose is later.
            let setting = Reprojection { by: Warp::Depth, every, latency_us: 0 };
            let mover = PictureMover::new(run, run.head.expect("a head"), setting);
            let field = PeriodNumber(field);
            let reprojector = mover.reprojector(&screen, field);
            let [mut found, mut expected] = [RgbImage::new(640, 480), RgbImage::new(640, 480)];
            assert!(mover.move_whole_rows(&reprojector, &screen, field, &mut found), "one pose");
            mover.move_pieces(&reprojector, &screen, field, &mut expected);
            let [mut same, mut seen, mut black, mut moved] = [0_u32; 4];
            let lit = Rows::lit(run.record.display(), field);
            for y in lit.of(480) {
                for x in 0..640 {
                    match (place(found.get_pixel(x, y)), place(expected.get_pixel(x, y))) {
                        (Some(a), Some(b)) => {
                            seen += 1;
                            moved += u32::from(b[0].abs_diff(x) > 3);
                            same += u32::from(a[0].abs_diff(b[0]) <= 1 && a[1].abs_diff(b[1]) <= lit.distance);
                        }
                        (None, None) => {}
                        _ => black += 1,
                    }
                }
            }
            assert!(seen > 140_000 && f64::from(same) > 0.995 * f64::from(seen), "{every:?}: {same} of {seen}");
            assert!(moved > 100_000, "{every:?}: {moved} are moved by more than three columns");
            assert!(black < 2_000, "{every:?}: {black}");
        }
    }
}
