//! Charts of curves, points and bands over two axes, drawn by the crate `plotters`.

use super::appearance::Appearance;
use super::scale::{Axis, AxisScale};
use crate::markup::is_allowed;
use crate::svg::DARK;
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

/// Title and axis labels of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxes {
    /// Title above the chart.
    pub title: String,
    /// Label of the horizontal axis, with the unit.
    pub across: String,
    /// Label of the vertical axis, with the unit.
    pub up: String,
}

/// A point with the confidence interval of its vertical value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPoint {
    /// Horizontal and vertical value. If either value is NaN, the point is not drawn and a line has a gap.
    pub at: (f64, f64),
    /// Lower and upper end of the confidence interval. NaN means that there is no interval.
    pub interval: (f64, f64),
    /// True for a hollow marker. The point's value is then not comparable with the values of filled markers.
    pub is_hollow: bool,
}

/// The style in which the points of a series are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeriesStyle {
    /// A line that joins the points in the order of [`ChartSeries::points`].
    Line,
    /// A line with a marker at each point. The confidence intervals form a band.
    Band,
    /// A marker at each point, without a line. Each confidence interval is a vertical line.
    Points,
}

/// A named series of points.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartSeries {
    /// Name in the legend.
    pub name: String,
    /// Points, in the order in which a line joins them.
    pub points: Vec<ChartPoint>,
    /// Style of the points.
    pub style: SeriesStyle,
}

impl ChartPoint {
    /// Returns a filled point without an interval.
    pub const fn at(at: (f64, f64)) -> Self {
        Self { at, interval: (f64::NAN, f64::NAN), is_hollow: false }
    }
}

impl ChartSeries {
    /// Returns a curve through the points. A point with NaN leaves a gap in the line.
    pub fn line(name: &str, points: &[(f64, f64)]) -> Self {
        let points = points.iter().copied().map(ChartPoint::at).collect();
        Self { name: name.to_owned(), points, style: SeriesStyle::Line }
    }

    /// Returns a series of one point.
    pub fn point(name: &str, point: ChartPoint) -> Self {
        Self { name: name.to_owned(), points: vec![point], style: SeriesStyle::Points }
    }
}

/// Size of a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ChartSize {
    /// Size for a screen: 960 x 480 pixels, text height of 12 pixels, legend on the right.
    Screen,
    /// Size for a column of a paper: text height of 7.5 points, legend below the chart.
    Column {
        /// Width of the chart in millimetres.
        width_mm: f64,
    },
}

/// A chart that can be drawn as SVG.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Title and axis labels.
    pub axes: ChartAxes,
    /// Scale of the horizontal axis.
    pub across: AxisScale,
    /// Scale of the vertical axis.
    pub up: AxisScale,
    /// Series to draw. Later series cover earlier series.
    pub series: Vec<ChartSeries>,
    /// Size of the chart.
    pub size: ChartSize,
}

/// Lengths of a chart as integers, in drawing units. These units are so small that rounding is invisible.
#[derive(Clone, Copy, Debug)]
struct Measures {
    width: u32,
    height: u32,
    em: u32,
    /// Width and height of the chart, and the unit of these two lengths in the SVG file.
    outer: (f64, f64, &'static str),
    names_below: bool,
}

/// Number of drawing units per pixel.
const UNITS_A_PIXEL: u32 = 10;
/// Number of drawing units per millimetre.
const UNITS_A_MM: f64 = 40.0;
/// Height of text in a paper's column, in millimetres: 7.5 points of 25.4/72 mm.
const COLUMN_EM_MM: f64 = 7.5 * 25.4 / 72.0;
/// Ratio of height to width of a chart in a column, without the legend.
const COLUMN_HEIGHT: f64 = 0.66;
/// Height of a row of the legend, relative to the height of text.
const NAME_HEIGHT_EM: f64 = 1.4;
/// Number of entries in a row of the legend.
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
                // The legend adds its lines to the height.
                let height_mm = (width_mm * COLUMN_HEIGHT + names_mm).round();
                let [width, height, em] = [width_mm, height_mm, COLUMN_EM_MM].map(|mm| (mm * UNITS_A_MM) as u32);
                Measures { width, height, em, outer: (width_mm, height_mm, "mm"), names_below: true }
            }
        }
    }
}

impl Chart {
    /// Returns the chart as SVG. The bytes are the same on every computer.
    ///
    /// # Panics
    ///
    /// Never panics, because a string accepts all output.
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
        // `plotters` copies all characters of a label, so characters that XML forbids are removed here.
        let text: String = text.chars().filter(|c| is_allowed(*c)).collect();
        let text = text.replacen(&inner, &format!("width=\"{width}{unit}\" height=\"{height}{unit}\""), 1);
        text.replacen('>', &format!(">\n<style>{DARK}</style>"), 1)
    }

    fn draw<'a>(&self, root: &Area<'a>, measures: Measures) -> Result<(), Fault<'a>> {
        root.fill(&WHITE)?;
        let em = f64::from(measures.em);
        // The legend is below the chart or on its right.
        let (plane, names) = if measures.names_below {
            let lines = self.series.len().div_ceil(NAMES_A_LINE) as f64;
            root.split_vertically(f64::from(measures.height) - lines * NAME_HEIGHT_EM * em)
        } else {
            // A letter is 0.42 em wide in the mean. Longer names than the 50 letters of a level of modelling are cut.
            let letters = self.series.iter().map(|series| series.name.chars().count()).max().unwrap_or(0).min(50);
            root.split_horizontally(f64::from(measures.width) - (5.0 + 0.42 * letters as f64) * em)
        };
        self.draw_plane(&plane, measures)?;
        // Each entry of the legend has a line sample and a name.
        let (columns, first) = if measures.names_below { (NAMES_A_LINE, 0.6) } else { (1, 3.6) };
        let column = f64::from(names.dim_in_pixel().0) / columns as f64;
        for (i, series) in self.series.iter().enumerate() {
            let x = em * 1.2 + column * (i % columns) as f64;
            let y = em * (first + NAME_HEIGHT_EM * (i / columns) as f64);
            draw_name(&names, Appearance::of(i, measures.em), series, (x as i32, y as i32))?;
        }
        Ok(())
    }

    fn draw_plane<'a>(&self, area: &Area<'a>, measures: Measures) -> Result<(), Fault<'a>> {
        let em = f64::from(measures.em);
        // Find the ranges of both axes from all points and intervals.
        let all = || self.series.iter().flat_map(|series| &series.points);
        let across = Axis::reaching(&self.across, all().map(|point| point.at.0));
        let up = all().flat_map(|point| [point.at.1, point.interval.0, point.interval.1]);
        let up = Axis::reaching(&self.up, up);
        // The widest label decides the space left of the vertical axis.
        let widest = up.marks().iter().map(|mark| up.label(*mark).chars().count()).max().unwrap_or(1);
        let mut builder = ChartBuilder::on(area);
        if !self.axes.title.is_empty() {
            builder.caption(&self.axes.title, (FontFamily::SansSerif, em * 1.2));
        }
        // The last number of the horizontal axis is centred below the right edge, so half of it lies beyond.
        let left = em * (2.4 + 0.6 * widest as f64);
        builder.margin(em * 0.6).margin_right(em * 1.8).x_label_area_size(em * 3.2).y_label_area_size(left);
        let mut plane = builder.build_cartesian_2d(across.clone(), up.clone())?;
        // Draw the axes first, because the series lie above the mesh.
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
            draw_series(&mut plane, Appearance::of(i, measures.em), series, (&across, &up))?;
        }
        Ok(())
    }
}

#[derive(Clone, Copy)]
struct Placed {
    at: (f64, f64),
    interval: Option<(f64, f64)>,
    is_hollow: bool,
}

/// Splits the points of a series at each point without a position (NaN), where a line has a gap.
fn runs(points: &[ChartPoint], axes: (&Axis, &Axis)) -> Vec<Vec<Placed>> {
    let placed = |point: &ChartPoint| {
        let at = (axes.0.place(point.at.0), axes.1.place(point.at.1));
        let (low, high) = (axes.1.place(point.interval.0), axes.1.place(point.interval.1));
        let interval = (low.is_finite() && high.is_finite()).then_some((low, high));
        let is_hollow = point.is_hollow;
        (at.0.is_finite() && at.1.is_finite()).then_some(Placed { at, interval, is_hollow })
    };
    let all: Vec<_> = points.iter().map(placed).collect();
    all.split(Option::is_none)
        .map(|run| run.iter().copied().flatten().collect())
        .filter(|run: &Vec<_>| !run.is_empty())
        .collect()
}

fn draw_series<'a>(
    plane: &mut Plane<'a, '_>,
    appearance: Appearance,
    series: &ChartSeries,
    axes: (&Axis, &Axis),
) -> Result<(), Fault<'a>> {
    // A gap in the points interrupts lines and bands.
    for run in runs(&series.points, axes) {
        let bounded: Vec<_> = run.iter().filter_map(|point| Some((point.at.0, point.interval?))).collect();
        // Intervals lie below the line and the marks.
        match series.style {
            SeriesStyle::Band if bounded.len() > 1 => {
                let lower = bounded.iter().map(|(x, (low, _))| (*x, *low));
                let upper = bounded.iter().rev().map(|(x, (_, high))| (*x, *high));
                plane
                    .draw_series([Polygon::new(lower.chain(upper).collect::<Vec<_>>(), appearance.colour.mix(0.2))])?;
            }
            SeriesStyle::Points | SeriesStyle::Band => {
                let upright = |(x, (low, high)): &(f64, (f64, f64))| vec![(*x, *low), (*x, *high)];
                plane.draw_series(bounded.iter().map(|point| PathElement::new(upright(point), appearance.stroke())))?;
            }
            SeriesStyle::Line => {}
        }
        let places = || run.iter().map(|point| point.at);
        if matches!(series.style, SeriesStyle::Line | SeriesStyle::Band) {
            match appearance.dashes() {
                None => plane.draw_series(LineSeries::new(places(), appearance.stroke()))?,
                Some((on, off)) => {
                    let at = places().collect::<Vec<_>>().into_iter();
                    plane.draw_series(DashedLineSeries::new(at, on, off, appearance.stroke()))?
                }
            };
        }
        if series.style != SeriesStyle::Line {
            let area = plane.plotting_area();
            run.iter().try_for_each(|point| appearance.hollow(point.is_hollow).mark(area, point.at))?;
        }
    }
    Ok(())
}

fn draw_name<'a>(
    area: &Area<'a>,
    appearance: Appearance,
    series: &ChartSeries,
    (x, y): (i32, i32),
) -> Result<(), Fault<'a>> {
    // The sample consists of a mark, of a line, or of both, as in the chart.
    let em = appearance.em as i32;
    // A series without a single comparable point has a hollow sample.
    let appearance = appearance.hollow(!series.points.is_empty() && series.points.iter().all(|point| point.is_hollow));
    if series.style == SeriesStyle::Points {
        appearance.mark(area, (x + em, y))?;
    } else {
        let ends = vec![(x, y), (x + 2 * em, y)];
        match appearance.dashes() {
            None => area.draw(&PathElement::new(ends, appearance.stroke()))?,
            Some((on, off)) => {
                area.draw(&plotters::element::DashedPathElement::new(ends, on, off, appearance.stroke()))?;
            }
        }
        if series.style == SeriesStyle::Band {
            appearance.mark(area, (x + em, y))?;
        }
    }
    // The name stands to the right of the sample.
    let style = TextStyle::from((FontFamily::SansSerif, f64::from(appearance.em)).into_font());
    area.draw(&Text::new(series.name.clone(), (x + em * 5 / 2, y), style.pos(Pos::new(HPos::Left, VPos::Center))))
}
