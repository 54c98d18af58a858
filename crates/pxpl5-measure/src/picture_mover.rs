//! Pictures after a device has moved them to the newest pose.

use crate::registration::{Evaluator, Warped, middle};
use crate::reproject::{Move, fill_row, move_row};
use crate::reprojector::Reprojector;
use crate::shown::Shown;
use image::RgbImage;
use pxpl5_run::{Every, FinalResults, HeadViews, Reprojection, Warp};
use pxpl5_wire::display::{Display, Scan};
use pxpl5_wire::{PeriodNumber, REGION_SIZE};
use std::ops::Range;
use std::sync::Arc;

/// A device and the run whose pictures it moves.
#[derive(Debug)]
pub(crate) struct PictureMover<'a> {
    run: FinalResults<'a>,
    head: Arc<HeadViews>,
    evaluator: Evaluator,
    shown: Shown,
    setting: Reprojection,
}

impl<'a> PictureMover<'a> {
    pub(crate) fn new(run: FinalResults<'a>, head: &Arc<HeadViews>, setting: Reprojection) -> Self {
        let evaluator = Evaluator::new(&run, head);
        Self { evaluator, shown: Shown::of_run(&run, head), head: Arc::clone(head), setting, run }
    }

    /// Writes the moved rows that a field lights. Rows without a drawn picture stay unchanged.
    pub(crate) fn move_rows(&self, screen: &RgbImage, field: PeriodNumber, out: &mut RgbImage) {
        let display = self.run.record.display();
        let (first_row, distance) = display.rows_lit(field);
        let rows = || (first_row..screen.height()).step_by(distance as usize);
        let mut reprojector = Reprojector::new(&self.head, self.setting, None);
        let places = rows().flat_map(|y| self.pieces(display, screen.width()).map(move |xs| [xs.start, y]));
        reprojector.begin(display, field, places);
        for y in rows() {
            for xs in self.pieces(display, screen.width()) {
                self.move_piece(&reprojector, screen, field, (y, xs), out);
            }
        }
    }

    /// Returns the ranges of pixels in a row that have one pose: one range per region, or single pixels if each column
    /// has its own pose.
    fn pieces(&self, display: &dyn Display, width: u32) -> impl Iterator<Item = Range<u32>> + use<> {
        let sideways = matches!(display.light().scan, Scan::Right | Scan::Left);
        let length = if sideways && self.setting.every == Every::Line { 1 } else { REGION_SIZE };
        (0..width).step_by(length as usize).map(move |x| x..(x + length).min(width))
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
        let rows = display.rows_lit(field);
        let x = xs.start.midpoint(xs.end - 1);
        let lit = display.lights(0, x, y, field);
        let drawn = lit.and_then(|at| self.shown.drawn(&self.run, [x, y], field, at));
        let (Some(drawn), Some(newest)) = (drawn, reprojector.newest(display, [xs.start, y])) else {
            xs.for_each(|x| out.put_pixel(x, y, *screen.get_pixel(x, y)));
            return;
        };
        let moment = self.evaluator.moment(&drawn);
        if self.setting.by == Warp::Depth {
            let from = |x| match self.evaluator.warped(&moment, &newest.pose, middle(x, y)) {
                Warped::Seen(_, from) => Some(from),
                Warped::Beyond | Warped::Hidden => None,
            };
            fill_row(screen, rows, (y, xs), from, out);
            return;
        }
        let moved = Move::between(self.setting.by, &self.evaluator.view, &moment.pose, &newest.pose);
        move_row(screen, rows, (y, xs), (&self.evaluator.view, &moved), out);
    }
}
