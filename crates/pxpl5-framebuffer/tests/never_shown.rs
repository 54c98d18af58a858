//! Compares the number of lines that were overwritten before the beam had shown them with a model. The model checks
//! every pixel. A pixel of the old picture is shown if the beam scans it after the old word and before the new word
//! arrives.

use crate::support::{Board, MESSAGE, colour, n_parts, target};
use proptest::prelude::*;
use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, PeriodNumber, RegionGrid};

const FIELDS: u64 = 8;

/// The arrival of a region relative to the beam, given for one word of the region. `later` is the time from the beam to
/// this word.
#[derive(Clone, Copy, Debug)]
struct Met {
    field: u64,
    /// Row of the word, in thousandths of the region's height. The next field, `last`, selects the last pixel of the
    /// row instead of the first pixel.
    row: u32,
    last: bool,
    /// Delay of the word after the beam, in picoseconds.
    later: i64,
}

fn met(fields: std::ops::Range<u64>) -> impl Strategy<Value = Met> {
    let later = prop_oneof![-2_i64..=2, -3_000_000_000_i64..3_000_000_000];
    let all = (fields, 0..1_000_u32, any::<bool>(), later);
    all.prop_map(|(field, row, last, later)| Met { field, row, last, later })
}

/// A region that is written twice, and the word time in units of 50 ns.
#[derive(Clone, Copy, Debug)]
struct Place(CopyTarget, u64);

impl Place {
    fn rectangle(self) -> [u32; 4] {
        self.0.grid.rectangle(self.0.region)
    }

    /// Returns the line of the frame for a row of the region.
    fn line(self, row: u32) -> u32 {
        let row = self.rectangle()[1] + row;
        match self.0.lines {
            Lines::Frame => row,
            Lines::Field(FieldParity::Even) => 2 * row,
            Lines::Field(FieldParity::Odd) => 2 * row + 1,
        }
    }

    /// Returns the arrival time of the word of pixel `i` in picoseconds after the last word of the first message. The
    /// time of a message is the arrival time of its last word. The earlier words arrive one word time apart.
    fn comes(self, i: u32) -> i64 {
        let [_, _, width, height] = self.rectangle();
        let message_end = (width * height).min((i / 1_024 + 1) * 1_024);
        let slowness = self.1 as i64;
        slowness * (MESSAGE.0 as i64 * i64::from(i / 1_024) - 50_000 * i64::from(message_end - 1 - i))
    }

    /// Returns the arrival time of the first message of a picture. With this time, one word has the distance from the
    /// beam that [`Met`] gives.
    fn begins(self, board: &Board, met: Met) -> i64 {
        let [left, _, width, height] = self.rectangle();
        let row = met.row * height / 1_000;
        let column = if met.last { width - 1 } else { 0 };
        let (x, y) = (left + column, self.line(row));
        let video = board.device.video();
        let beam = video.when(x, y, PeriodNumber(met.field)).or_else(|| video.when(x, y, PeriodNumber(met.field + 1)));
        beam.expect("one of two fields has the line").0 as i64 + met.later - self.comes(row * width + column)
    }

    /// Returns the number of rows of the older picture that no field has shown completely.
    fn never_shown(self, board: &Board, [older, newer]: [i64; 2]) -> u64 {
        let [left, _, width, height] = self.rectangle();
        let shows = |field, row: u32| {
            (0..width).all(|column| {
                let comes = self.comes(row * width + column);
                let scanned = board.device.video().when(left + column, self.line(row), PeriodNumber(field));
                scanned.is_some_and(|at| older + comes <= at.0 as i64 && (at.0 as i64) < newer + comes)
            })
        };
        (0..height).filter(|row| !(0..FIELDS).any(|field| shows(field, *row))).count() as u64
    }
}

fn places() -> impl Strategy<Value = Place> {
    let cut = RegionGrid { width: 611, height: 233, region_width: 100, region_height: 67 };
    let grids = prop_oneof![
        Just((Lines::Frame, RegionGrid::FRAME)),
        Just((Lines::Field(FieldParity::Even), RegionGrid::FIELD)),
        Just((Lines::Field(FieldParity::Odd), RegionGrid::FIELD)),
        Just((Lines::Field(FieldParity::Odd), cut)),
        // Regions of one message. During the arrival, the beam can reach any row of the region.
        (1..9_u32).prop_map(|region_height| {
            (Lines::Field(FieldParity::Even), RegionGrid { region_height, ..RegionGrid::FIELD })
        }),
    ];
    let slowness = prop_oneof![Just(1), Just(2), Just(4)];
    (grids, any::<prop::sample::Index>(), slowness).prop_map(|((lines, grid), region, slowness)| {
        Place(target(0, lines, grid, region.index(grid.regions() as usize) as u16, 0), slowness)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 1 << 16, ..ProptestConfig::default() })]

    #[test]
    fn a_line_is_never_shown_if_no_field_shows_all_its_pixels(
        place in places(), older in met(1..4), newer in met(1..6),
    ) {
        let mut board = Board::slow(place.1);
        board.retraces(0..=FIELDS);
        let begins = [older, newer].map(|met| place.begins(&board, met));
        let message = (MESSAGE * place.1).0 as i64;
        let length = message * i64::from(n_parts(&place.0) - 1);
        // The port takes one region at a time.
        prop_assume!(begins[0] > 0 && begins[0] + length + message <= begins[1]);
        for (picture, begin) in (0..).zip(begins) {
            let target = CopyTarget { picture: pxpl5_wire::PictureNumber(picture), ..place.0 };
            board.region(Time((begin + length) as u64), target, &colour(1));
        }
        let expected = place.never_shown(&board, begins);
        board.run();
        prop_assert_eq!(board.device.stats().lines_never_shown, expected);
    }
}
