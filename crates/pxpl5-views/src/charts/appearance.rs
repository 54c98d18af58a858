//! Colours, dashes and markers that distinguish the series of a chart.

use plotters::backend::DrawingBackend;
use plotters::coord::CoordTranslate;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::element::{Circle, Cross, TriangleMarker};
use plotters::style::{Color, RGBColor, ShapeStyle};

/// Colours that are distinguishable with any colour vision (Okabe and Ito 2008, with a darker yellow). If a chart has
/// more series than colours, the additional series have dashed lines.
const COLOURS: [u32; 8] = [0x00_0000, 0xe6_9f00, 0x56_b4e9, 0x00_9e73, 0x00_72b2, 0xd5_5e00, 0xcc_79a7, 0xb8_a900];

/// Lengths of dashes and gaps, in tenths of the height of text. `None` is a solid line.
const DASHES: [Option<(u32, u32)>; 3] = [None, Some((5, 3)), Some((2, 3))];

#[derive(Clone, Copy, Debug)]
pub(super) struct Appearance {
    place: usize,
    pub(super) colour: RGBColor,
    pub(super) em: u32,
    /// True if the marker is hollow. A hollow marker is drawn as a wide ring.
    is_hollow: bool,
}

impl Appearance {
    pub(super) fn of(place: usize, em: u32) -> Self {
        let [_, red, green, blue] = COLOURS[place % COLOURS.len()].to_be_bytes();
        Self { place, colour: RGBColor(red, green, blue), em, is_hollow: false }
    }

    pub(super) const fn hollow(self, is_hollow: bool) -> Self {
        Self { is_hollow, ..self }
    }

    pub(super) fn stroke(&self) -> ShapeStyle {
        self.colour.stroke_width(self.em / 8)
    }

    pub(super) fn dashes(&self) -> Option<(u32, u32)> {
        let dashes = DASHES[self.place / COLOURS.len() % DASHES.len()];
        dashes.map(|(on, off)| (on * self.em / 10, off * self.em / 10))
    }

    /// Draws the marker of the series. The markers of successive series are a disc, a triangle, a cross and a ring, and
    /// then repeat, moved by one where the colours repeat.
    pub(super) fn mark<B, C>(
        &self,
        area: &DrawingArea<B, C>,
        at: C::From,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>>
    where
        B: DrawingBackend,
        C: CoordTranslate,
    {
        let size = self.em * 3 / 8;
        if self.is_hollow {
            return area.draw(&Circle::new(at, size * 3 / 2, self.stroke()));
        }
        match (self.place + self.place / COLOURS.len()) % 4 {
            0 => area.draw(&Circle::new(at, size, self.colour.filled())),
            1 => area.draw(&TriangleMarker::new(at, size, self.colour.filled())),
            2 => area.draw(&Cross::new(at, size, self.stroke())),
            _ => area.draw(&Circle::new(at, size, self.stroke())),
        }
    }
}
