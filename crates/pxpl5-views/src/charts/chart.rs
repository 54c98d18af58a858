//! Curves, points and bands over two axes, with their names: drawn by the crate `plotters`.

use super::look::Look;
use super::scale::{Axis, AxisScale};
use crate::markup::is_allowed;
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters::element::{PathElement, Polygon, Text};
use plotters::series::{DashedLineSeries, LineSeries};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color, FontFamily, IntoFont, RGBColor, TextStyle, WHITE};

type Fault<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as plotters::backend::DrawingBackend>::ErrorType>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plane<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<Axis, Axis>>;

/// What a chart is about.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxes {
    /// What stands above the chart.
    pub title: String,
    /// Name and unit of what goes to the right.
    pub across: String,
    /// Name and unit of what goes up.
    pub up: String,
}

/// A point with the interval in which its height lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPoint {
    /// Numbers across and up; where one is none (NaN) nothing is drawn and a line is broken.
    pub at: (f64, f64),
    /// Lower and upper end of its interval; no numbers where there is none.
    pub interval: (f64, f64),
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesLook {
    /// Joined, in their order.
    Line,
    /// Joined, each with a mark, their intervals as a band.
    Band,
    /// Each with a mark, its interval as an upright line.
    Points,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartSeries {
    /// What stands beside its colour.
    pub name: String,
    /// In the order in which they are joined.
    pub points: Vec<ChartPoint>,
    /// How they are drawn.
    pub look: SeriesLook,
}

/// How large a chart is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChartSize {
    /// For a screen: 960 x 480 pixels, text of 12, names to the right.
    Screen,
    /// For a column of a paper: so many millimetres wide, text of 7.5 points, names below.
    Column {
        /// Width in millimetres.
        width_mm: f64,
    },
}

/// A chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it is about.
    pub axes: ChartAxes,
    /// How the axis across goes.
    pub across: AxisScale,
    /// How the axis upwards goes.
    pub up: AxisScale,
    /// What it shows; the first of them lies at the bottom.
    pub series: Vec<ChartSeries>,
    /// How large it is.
    pub size: ChartSize,
}

/// Lengths of a drawing in its own units, which are whole: fine enough that no line shows a step.
#[derive(Clone, Copy, Debug)]
struct Measures {
    width: u32,
    height: u32,
    /// Height of text.
    em: u32,
    /// Width and height as the file says them.
    outer: (f64, f64, &'static str),
    names_below: bool,
}

/// Units of a pixel, and of a millimetre.
const UNITS_A_PIXEL: u32 = 10;
const UNITS_A_MM: f64 = 40.0;
/// A line of a column's text: 7.5 points of 25.4/72 mm.
const COLUMN_EM_MM: f64 = 7.5 * 25.4 / 72.0;
/// Height of a column's chart over its width, without names.
const COLUMN_HEIGHT: f64 = 0.66;
/// Height of a line of names, and their columns.
const NAME_HEIGHT_EM: f64 = 1.4;
const NAMES_A_LINE: usize = 2;

impl ChartSize {
    fn measures(self, names: usize) -> Measures {
        match self {
            Self::Screen => {
                let [width, height, em] = [960, 480, 12].map(|pixels| pixels * UNITS_A_PIXEL);
                Measures { width, height, em, outer: (960.0, 480.0, ""), names_below: false }
            }
            Self::Column { width_mm } => {
                let names_mm = COLUMN_EM_MM * NAME_HEIGHT_EM * names.div_ceil(NAMES_A_LINE) as f64;
                let height_mm = (width_mm * COLUMN_HEIGHT + names_mm).round();
                let [width, height, em] = [width_mm, height_mm, COLUMN_EM_MM].map(|mm| (mm * UNITS_A_MM) as u32);
                Measures { width, height, em, outer: (width_mm, height_mm, "mm"), names_below: true }
            }
        }
    }
}

impl Chart {
    /// The drawing as SVG, the same bytes everywhere.
    ///
    /// # Panics
    ///
    /// Never: text takes whatever is drawn.
    #[must_use]
    pub fn svg(&self) -> String {
        let measures = self.size.measures(self.series.len());
        let mut text = String::new();
        {
            let backend = SVGBackend::with_string(&mut text, (measures.width, measures.height));
            let root = backend.into_drawing_area();
            self.draw(&root, measures).and_then(|()| root.present()).expect("text takes whatever is drawn");
        }
        let inner = format!("width=\"{}\" height=\"{}\"", measures.width, measures.height);
        let (width, height, unit) = measures.outer;
        // plotters takes every character of a label.
        let text: String = text.chars().filter(|c| is_allowed(*c)).collect();
        text.replacen(&inner, &format!("width=\"{width}{unit}\" height=\"{height}{unit}\""), 1)
    }

    fn draw<'a>(&self, root: &Area<'a>, measures: Measures) -> Result<(), Fault<'a>> {
        root.fill(&WHITE)?;
        let em = f64::from(measures.em);
        let (plane, names) = if measures.names_below {
            let lines = self.series.len().div_ceil(NAMES_A_LINE) as f64;
            root.split_vertically(f64::from(measures.height) - lines * NAME_HEIGHT_EM * em)
        } else {
            root.split_horizontally(f64::from(measures.width) - 18.0 * em)
        };
        self.draw_plane(&plane, measures)?;
        let columns = if measures.names_below { NAMES_A_LINE } else { 1 };
        let column = f64::from(names.dim_in_pixel().0) / columns as f64;
        for (i, series) in self.series.iter().enumerate() {
            let x = em * 1.2 + column * (i % columns) as f64;
            let first = if measures.names_below { 0.6 } else { 3.6 };
            let y = em * (first + NAME_HEIGHT_EM * (i / columns) as f64);
            draw_name(&names, Look::of(i, measures.em), series, (x as i32, y as i32))?;
        }
        Ok(())
    }

    fn draw_plane<'a>(&self, area: &Area<'a>, measures: Measures) -> Result<(), Fault<'a>> {
        let em = f64::from(measures.em);
        let all = || self.series.iter().flat_map(|series| &series.points);
        let across = Axis::reaching(&self.across, all().map(|point| point.at.0));
        let up = all().flat_map(|point| [point.at.1, point.interval.0, point.interval.1]);
        let up = Axis::reaching(&self.up, up);
        let widest = up.marks().iter().map(|mark| up.label(*mark).chars().count()).max().unwrap_or(1);
        let mut builder = ChartBuilder::on(area);
        if !self.axes.title.is_empty() {
            builder.caption(&self.axes.title, (FontFamily::SansSerif, em * 1.2));
        }
        builder.margin(em * 0.6).x_label_area_size(em * 3.2).y_label_area_size(em * (2.4 + 0.6 * widest as f64));
        let mut plane = builder.build_cartesian_2d(across.clone(), up.clone())?;
        plane
            .configure_mesh()
            .light_line_style(WHITE.mix(0.0))
            .bold_line_style(RGBColor(0xdd, 0xdd, 0xdd).stroke_width(measures.em / 12))
            .axis_style(BLACK.stroke_width(measures.em / 12))
            .set_all_tick_mark_size(measures.em / 3)
            .label_style((FontFamily::SansSerif, em))
            .axis_desc_style((FontFamily::SansSerif, em))
            .x_label_formatter(&|place| across.label(*place))
            .y_label_formatter(&|place| up.label(*place))
            .x_desc(&self.axes.across)
            .y_desc(&self.axes.up)
            .draw()?;
        for (i, series) in self.series.iter().enumerate() {
            draw_series(&mut plane, Look::of(i, measures.em), series, (&across, &up))?;
        }
        Ok(())
    }
}

/// A point of the plane: places on both axes, and the ends of the interval's.
#[derive(Clone, Copy)]
struct Placed {
    at: (f64, f64),
    interval: Option<(f64, f64)>,
}

/// Runs of points that all have a place.
fn runs(points: &[ChartPoint], axes: (&Axis, &Axis)) -> Vec<Vec<Placed>> {
    let placed = |point: &ChartPoint| {
        let at = (axes.0.place(point.at.0), axes.1.place(point.at.1));
        let (low, high) = (axes.1.place(point.interval.0), axes.1.place(point.interval.1));
        let interval = (low.is_finite() && high.is_finite()).then_some((low, high));
        (at.0.is_finite() && at.1.is_finite()).then_some(Placed { at, interval })
    };
    let all: Vec<_> = points.iter().map(placed).collect();
    all.split(Option::is_none)
        .map(|run| run.iter().copied().flatten().collect())
        .filter(|run: &Vec<_>| !run.is_empty())
        .collect()
}

fn draw_series<'a>(
    plane: &mut Plane<'a, '_>,
    look: Look,
    series: &ChartSeries,
    axes: (&Axis, &Axis),
) -> Result<(), Fault<'a>> {
    for run in runs(&series.points, axes) {
        let bounded: Vec<_> = run.iter().filter_map(|point| Some((point.at.0, point.interval?))).collect();
        match series.look {
            SeriesLook::Band if bounded.len() > 1 => {
                let lower = bounded.iter().map(|(x, (low, _))| (*x, *low));
                let upper = bounded.iter().rev().map(|(x, (_, high))| (*x, *high));
                plane.draw_series([Polygon::new(lower.chain(upper).collect::<Vec<_>>(), look.colour.mix(0.2))])?;
            }
            SeriesLook::Points | SeriesLook::Band => {
                let upright = |(x, (low, high)): &(f64, (f64, f64))| vec![(*x, *low), (*x, *high)];
                plane.draw_series(bounded.iter().map(|point| PathElement::new(upright(point), look.stroke())))?;
            }
            SeriesLook::Line => {}
        }
        let places = || run.iter().map(|point| point.at);
        if series.look != SeriesLook::Points {
            match look.dashes() {
                None => plane.draw_series(LineSeries::new(places(), look.stroke()))?,
                Some((on, off)) => {
                    let at = places().collect::<Vec<_>>().into_iter();
                    plane.draw_series(DashedLineSeries::new(at, on, off, look.stroke()))?
                }
            };
        }
        if series.look != SeriesLook::Line {
            places().try_for_each(|at| look.mark(plane.plotting_area(), at))?;
        }
    }
    Ok(())
}

/// A sample of a series and its name.
fn draw_name<'a>(area: &Area<'a>, look: Look, series: &ChartSeries, (x, y): (i32, i32)) -> Result<(), Fault<'a>> {
    let em = look.em as i32;
    if series.look == SeriesLook::Points {
        look.mark(area, (x + em, y))?;
    } else {
        let ends = vec![(x, y), (x + 2 * em, y)];
        match look.dashes() {
            None => area.draw(&PathElement::new(ends, look.stroke()))?,
            Some((on, off)) => {
                area.draw(&plotters::element::DashedPathElement::new(ends, on, off, look.stroke()))?;
            }
        }
        if series.look == SeriesLook::Band {
            look.mark(area, (x + em, y))?;
        }
    }
    let style = TextStyle::from((FontFamily::SansSerif, f64::from(look.em)).into_font());
    area.draw(&Text::new(series.name.clone(), (x + em * 5 / 2, y), style.pos(Pos::new(HPos::Left, VPos::Center))))
}
