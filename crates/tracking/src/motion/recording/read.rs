use glam::{DQuat, DVec3};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::fmt::Display;

use super::axes::Axes;
use super::columns::{Column, Columns, of_line};
use super::decimal::scaled;
use super::pose_log;
use super::pose_log::Named;
use super::{FARTHEST_M, FASTEST, Jumps, LATEST_S, RecordingFormat, Sample};
use crate::pose::Pose;
use crate::rotation;
use crate::time::{PS_PER_S, span_s};

/// Columns of this crate's own files: time in seconds, position in metres, and the unit quaternion from head axes to
/// world axes, real part first.
const OWN: [&str; 8] = ["time_s", "x", "y", "z", "qw", "qx", "qy", "qz"];

/// Endings of the column names of a EuRoC ground truth file, without units, in the order of the file.
const EUROC: [&str; 8] = ["timestamp", "_x", "_y", "_z", "_w", "_x", "_y", "_z"];

/// Columns of a TUM trajectory file in their order, with the real part of the quaternion last. A TUM file has no
/// header.
const TUM: [&str; 8] = ["timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"];

/// Indices of the columns of a TUM line in the order of a sample: time, position, and the quaternion with its real part
/// first.
const TUM_ORDER: [usize; 8] = [0, 1, 2, 3, 7, 4, 5, 6];

/// Greatest difference between the length of a recorded quaternion and 1. Rounding to four decimals causes a much
/// smaller difference.
const LENGTH_TOLERANCE: f64 = 1e-2;

/// Fastest movement of a head between two samples, m/s: twice the fastest of four real recordings. Assumed, 5 to 20.
const MAX_M_PER_S: f64 = 8.0;
/// Fastest turn of a head between two samples, rad/s: 2,000 degrees, twice the fastest of four real recordings.
/// Assumed, 1,000 to 4,000 degrees.
const MAX_RAD_PER_S: f64 = 2_000.0 / PER_RAD;
const PER_RAD: f64 = 180.0 / std::f64::consts::PI;
/// Noise of a tracker. A shorter way shows no speed, because two samples may be only microseconds apart. Assumed.
const NOISE_M: f64 = 0.002;
const NOISE_RAD: f64 = 0.5 / PER_RAD;

struct Layout {
    /// Character between two columns, or `None` if white space separates the columns.
    separator: Option<char>,
    columns: [Column; 8],
    /// Exact number of columns in each line. `None` allows lines with any number of additional columns.
    n_fields: Option<usize>,
    axes: Axes,
    /// True if the first sample defines time 0. Its time stamp can then have any value.
    from_first: bool,
    /// Line number of the header, or 0 without a header. Samples begin after this line.
    begins_after: u64,
}

struct Line<'a> {
    number: u64,
    text: &'a str,
}

impl<'a> Line<'a> {
    fn fields(&self, separator: Option<char>) -> Vec<&'a str> {
        match separator {
            Some(separator) => self.text.split(separator).map(bare).collect(),
            None => self.text.split_whitespace().map(bare).collect(),
        }
    }
}

fn bare(field: &str) -> &str {
    field.trim().trim_matches('"')
}

pub(super) struct Samples {
    pub(super) samples: Vec<Sample>,
    /// Warnings about samples that were left out, and about samples that no head can reach.
    pub(super) warnings: Vec<String>,
}

pub(super) fn samples(text: &str, format: &RecordingFormat) -> Result<Samples, FileError> {
    let columns = &format.columns;
    // Number the lines from 1, and drop a byte order mark and empty lines.
    let lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
    let lines = lines.map(|(text, number)| Line { number, text: text.trim() }).filter(|line| !line.text.is_empty());
    let lines: Vec<Line<'_>> = lines.collect();
    if columns.is_empty() && lines.first().is_some_and(|first| pose_log::is_json(first.text)) {
        return of_json(&lines, format);
    }
    // Take the layout from the mapping, or recognize it from the first lines.
    let layout = if columns.is_empty() { recognised(&lines)? } else { mapped(&lines, columns)? };
    collect(&lines, &layout, format)
}

/// Checks the samples that a program supplies, by the same rules as the lines of a file in this crate's own format.
/// Errors give the number of a sample, counted from 1, as the number of a line.
pub(super) fn given_samples(given: impl IntoIterator<Item = (f64, Pose)>) -> Result<Samples, FileError> {
    // The shortest decimal form of a number is read back as the same number.
    let text = |(time_s, Pose { position: p, orientation: q }): (f64, Pose)| {
        [time_s, p.x, p.y, p.z, q.w, q.x, q.y, q.z].map(|number| number.to_string()).join(",")
    };
    let texts: Vec<String> = given.into_iter().map(text).collect();
    let lines: Vec<Line<'_>> = texts.iter().zip(1..).map(|(text, number)| Line { number, text }).collect();
    let layout = Layout {
        separator: Some(','),
        columns: in_order(&OWN, [0, 1, 2, 3, 4, 5, 6, 7], 0),
        n_fields: Some(8),
        axes: Axes::OpenGl,
        from_first: false,
        begins_after: 0,
    };
    collect(&lines, &layout, &RecordingFormat::default())
}

fn of_json(lines: &[Line<'_>], format: &RecordingFormat) -> Result<Samples, FileError> {
    let read = lines.iter().map(|line| Ok((line.number, pose_log::json_fields(line.number, line.text)?)));
    let read: Vec<(u64, ([String; 8], Column))> = read.collect::<Result<_, FileError>>()?;
    let time = &read.first().ok_or_else(no_sample)?.1.1;
    let columns = pose_log::json_columns(time);
    let texts: Vec<(u64, String)> = read.iter().map(|(number, (fields, _))| (*number, fields.join("\t"))).collect();
    let lines: Vec<Line<'_>> = texts.iter().map(|(number, text)| Line { number: *number, text }).collect();
    let layout = Layout {
        separator: Some('\t'),
        columns,
        n_fields: Some(8),
        axes: Axes::OpenGl,
        from_first: true,
        begins_after: 0,
    };
    collect(&lines, &layout, format)
}

fn collect(lines: &[Line<'_>], layout: &Layout, format: &RecordingFormat) -> Result<Samples, FileError> {
    let axes = format.axes.unwrap_or(layout.axes);
    let mut first_ps = None;
    let mut samples: Vec<Sample> = Vec::new();
    let mut repeated = Lines::default();
    let mut fast = Fast::of(format.jumps);
    for line in lines.iter().filter(|line| line.number > layout.begins_after && !line.text.starts_with('#')) {
        if fast.leaves_out() && layout.has_no_pose(line) {
            fast.lines.add(line, "no pose".to_owned());
            continue;
        }
        let (stamp_ps, pose) = layout.sample(line)?;
        let origin_ps = if layout.from_first { *first_ps.get_or_insert(stamp_ps) } else { 0 };
        let t_ps = layout.time(line, stamp_ps - origin_ps, samples.last())?;
        // Public ground truth files contain pairs of samples with one time stamp: the tracker reported twice within one
        // tick of its clock.
        if samples.last().is_some_and(|(before_ps, _)| *before_ps == t_ps) {
            repeated.add(line, String::new());
            continue;
        }
        let sample = (t_ps, axes.convert(pose));
        if fast.keeps(line, &mut samples, &sample)? {
            samples.push(sample);
        }
    }
    let warnings = repeated.repeated().into_iter().chain(fast.warning(samples.len())).collect();
    if samples.is_empty() { Err(no_sample()) } else { Ok(Samples { samples, warnings }) }
}

/// Number of lines of one kind, with the number of the first line and a text about it.
#[derive(Default)]
struct Lines {
    count: usize,
    first: Option<(u64, String)>,
}

impl Lines {
    fn add(&mut self, line: &Line<'_>, about: String) {
        self.count += 1;
        self.first.get_or_insert((line.number, about));
    }

    /// Returns the warning about lines that repeat the time of the line before.
    fn repeated(&self) -> Option<String> {
        let (line, _) = self.first.as_ref()?;
        Some(match self.count {
            1 => format!("line {line} repeats the time of the line before: its pose is left out"),
            count => {
                format!("{count} lines repeat the time of the line before, first line {line}: their poses are left out")
            }
        })
    }
}

/// The lines in which the head moves faster than a head can.
struct Fast {
    jumps: Jumps,
    lines: Lines,
    /// Pose of the line before, if this line was left out.
    left_out: Option<Pose>,
}

impl Fast {
    fn of(jumps: Jumps) -> Self {
        Self { jumps, lines: Lines::default(), left_out: None }
    }

    fn leaves_out(&self) -> bool {
        self.jumps == Jumps::LeaveOut
    }

    /// Returns true if a sample becomes a part of the recording.
    ///
    /// # Errors
    ///
    /// Fails for a speed that no recording has, unless such samples are left out.
    fn keeps(&mut self, line: &Line<'_>, samples: &mut Vec<Sample>, sample: &Sample) -> Result<bool, FileError> {
        let Some((before_ps, before)) = samples.last() else { return Ok(true) };
        let seconds = span_s(*before_ps, sample.0);
        let moved_m = (sample.1.position - before.position).length();
        let turned = rotation::difference(before.orientation, sample.1.orientation).length();
        let speeds =
            [(moved_m, MAX_M_PER_S, NOISE_M, "m/s", 1.0), (turned, MAX_RAD_PER_S, NOISE_RAD, "deg/s", PER_RAD)];
        let fast = speeds.into_iter().find(|(way, most, noise, ..)| *way > most * seconds && way > noise);
        // A tracker that has lost the head repeats its pose, and after some time this pose is no longer too fast.
        let is_lost = self.left_out == Some(sample.1);
        if fast.is_none() && !is_lost {
            self.left_out = None;
            return Ok(true);
        }
        let speed = fast.map(|(way, _, _, unit, per)| format!("{:.0} {unit}", way * per / seconds));
        self.lines.add(line, speed.unwrap_or_default());
        if !self.leaves_out() {
            let too_fast = [(moved_m / seconds, "m/s"), (turned / seconds, "rad/s")]
                .into_iter()
                .find(|(found, _)| *found > FASTEST);
            return too_fast.map_or(Ok(true), |(found, unit)| {
                let expected = format!("at most {FASTEST:e} m/s and {FASTEST:e} rad/s from the line before");
                Err(out_of_range(format_args!("line {}", line.number), expected, format_args!("{found:e} {unit}")))
            });
        }
        // Zeros at the beginning are the lost poses, and not the poses after them.
        let zero = Pose { position: DVec3::ZERO, ..*before };
        if samples.iter().all(|(_, pose)| *pose == zero) {
            samples.clear();
            return Ok(true);
        }
        self.left_out = Some(sample.1);
        Ok(false)
    }

    fn warning(&self, kept: usize) -> Option<String> {
        let (line, speed) = self.lines.first.as_ref()?;
        let count = match self.lines.count {
            1 => format!("line {line}: the head moves too fast ({speed})"),
            count => format!("{count} lines in which the head moves too fast, first line {line} ({speed})"),
        };
        let done = match self.jumps {
            Jumps::LeaveOut => "left out",
            Jumps::Keep => "a head stays below 8 m/s and 2,000 deg/s; head.jumps = \"leave-out\" leaves such lines out",
        };
        let units = if 10 * self.lines.count > kept { "; are positions in metres and times in seconds?" } else { "" };
        Some(format!("{count}: {done}{units}"))
    }
}

fn recognised(lines: &[Line<'_>]) -> Result<Layout, FileError> {
    let first = lines.first().ok_or_else(no_sample)?;
    let header: Vec<&str> = first.text.trim_start_matches('#').split(',').map(bare).collect();
    // Case 1: the header of a EuRoC ground truth.
    if first.text.starts_with('#') && is_euroc(&header) {
        let names: [&str; 8] = std::array::from_fn(|i| header[i]);
        let columns = in_order(&names, [0, 1, 2, 3, 4, 5, 6, 7], 9);
        let (separator, axes, begins_after) = (Some(','), Axes::Euroc, first.number);
        return Ok(Layout { separator, columns, n_fields: None, axes, from_first: true, begins_after });
    }
    // Case 2: a header with the names of all columns in any order.
    let names = Line { number: first.number, text: first.text.trim_start_matches('#').trim() };
    let separator = separator_of(&names);
    let names = names.fields(separator);
    if let Some(Named { columns, axes, counts_from_run }) = pose_log::named(first.number, &names)? {
        // A line of this crate's own files has no other fields.
        let n_fields = (counts_from_run && names.len() == OWN.len()).then_some(OWN.len());
        let begins_after = first.number;
        return Ok(Layout { separator, columns, n_fields, axes, from_first: !counts_from_run, begins_after });
    }
    // Case 3: a TUM trajectory, whose first line without `#` has eight numbers.
    let numbers = lines.iter().find(|line| !line.text.starts_with('#')).ok_or_else(no_sample)?;
    let fields = numbers.fields(None);
    if fields.len() == TUM.len() && fields.iter().all(|field| field.parse::<f64>().is_ok()) {
        let columns = in_order(&TUM, TUM_ORDER, 0);
        let axes = Axes::Optical;
        return Ok(Layout { separator: None, columns, n_fields: Some(8), axes, from_first: true, begins_after: 0 });
    }
    Err(of_line(first.number, FORMATS, first.text))
}

/// Returns the character that separates the columns, or `None` for white space.
fn separator_of(line: &Line<'_>) -> Option<char> {
    [',', ';', '\t'].into_iter().find(|separator| line.text.contains(*separator))
}

/// Returns true for the header of a EuRoC ground truth file. Columns after the first eight (velocity, biases) have no
/// effect.
fn is_euroc(header: &[&str]) -> bool {
    let name = |column: &str| column.split('[').next().unwrap_or_default().trim().to_owned();
    header.len() >= EUROC.len() && header.iter().zip(EUROC).all(|(column, end)| name(column).ends_with(end))
}

fn in_order(names: &[&str; 8], order: [usize; 8], time_places: i32) -> [Column; 8] {
    let places = |slot| if slot == 0 { time_places } else { 0 };
    std::array::from_fn(|slot| {
        let (index, name) = (order[slot], names[order[slot]].to_owned());
        Column { index, name, places: places(slot), is_negated: false }
    })
}

fn mapped(lines: &[Line<'_>], columns: &Columns) -> Result<Layout, FileError> {
    let first = lines.first().ok_or_else(no_sample)?;
    let separator = separator_of(first);
    // A first line of numbers alone is a sample, not a header.
    let header = Line { number: first.number, text: first.text.trim_start_matches('#').trim() };
    let fields = header.fields(separator);
    let has_header = !fields.iter().all(|field| field.parse::<f64>().is_ok());
    let names = if has_header { fields } else { Vec::new() };
    if !has_header && !columns.are_numbers() {
        return Err(of_line(first.number, FORMATS, first.text));
    }
    Ok(Layout {
        separator,
        columns: columns.in_header(first.number, &names)?,
        n_fields: None,
        axes: Axes::OpenGl,
        from_first: true,
        begins_after: if has_header { first.number } else { 0 },
    })
}

impl Layout {
    /// Parses a line into its time stamp in picoseconds and its pose in the recorded axes.
    fn sample(&self, line: &Line<'_>) -> Result<(i128, Pose), FileError> {
        let fields = line.fields(self.separator);
        let needed = self.columns.iter().map(|column| column.index + 1).max().unwrap_or_default();
        // Check the number of fields before any field is read.
        let expected = self.n_fields.unwrap_or(needed);
        let found = fields.len();
        if found < needed || self.n_fields.is_some_and(|exact| exact != found) {
            return Err(of_line(line.number, format_args!("{expected} fields"), found));
        }
        // The time is parsed exactly, the other fields as floating point.
        let [time, numbers @ ..] = &self.columns;
        let stamp_ps = scaled(fields[time.index], 12 - time.places);
        let stamp_ps = stamp_ps.ok_or_else(|| not_a_number(line, time, fields[time.index]))?;
        let mut values = [0.0; 7];
        for (value, column) in values.iter_mut().zip(numbers) {
            *value = number(line, column, fields[column.index])?;
        }
        if let Some((found_m, column)) =
            values.iter().zip(numbers).take(3).find(|(metres, _)| metres.abs() > FARTHEST_M)
        {
            let expected = format!("-{FARTHEST_M:e} to {FARTHEST_M:e} m");
            return Err(out_of_range(place(line, &column.name), expected, format_args!("{found_m:e} m")));
        }
        let [x, y, z, qw, qx, qy, qz] = values;
        let orientation = self.unit_quaternion(line, DQuat::from_xyzw(qx, qy, qz, qw))?;
        Ok((stamp_ps, Pose { position: DVec3::new(x, y, z), orientation }))
    }

    /// Returns true if the quaternion of a line is zero or not a number, as some trackers write after losing the head.
    fn has_no_pose(&self, line: &Line<'_>) -> bool {
        let fields = line.fields(self.separator);
        let number = |column: &Column| fields.get(column.index)?.parse::<f64>().ok();
        self.columns[4..].iter().all(|column| number(column).is_some_and(|number| number == 0.0 || number.is_nan()))
    }

    fn unit_quaternion(&self, line: &Line<'_>, q: DQuat) -> Result<DQuat, FileError> {
        let found = q.length();
        if (found - 1.0).abs() <= LENGTH_TOLERANCE {
            return Ok(q.normalize());
        }
        let names: Vec<&str> = self.columns[4..].iter().map(|column| column.name.as_str()).collect();
        Err(out_of_range(place(line, &names.join(",")), "a quaternion of length 1", found))
    }

    /// Returns the time stamp of a sample. Checks that the time is not earlier than the time of the previous sample and
    /// is not above the greatest allowed time.
    fn time(&self, line: &Line<'_>, t_ps: i128, previous: Option<&Sample>) -> Result<u64, FileError> {
        let place = || place(line, &self.columns[0].name);
        let found_s = t_ps as f64 / PS_PER_S as f64;
        if let Some((previous_ps, _)) = previous.filter(|(previous_ps, _)| t_ps < i128::from(*previous_ps)) {
            let previous_s = *previous_ps as f64 / PS_PER_S as f64;
            let expected = format!("{previous_s} s or more, the time of the line before");
            return Err(out_of_range(place(), expected, format_args!("{found_s} s")));
        }
        let latest_ps = LATEST_S as i128 * i128::from(PS_PER_S);
        let in_range = u64::try_from(t_ps).ok().filter(|_| t_ps <= latest_ps);
        in_range.ok_or_else(|| out_of_range(place(), format_args!("0 to {LATEST_S} s"), format_args!("{found_s} s")))
    }
}

fn number(line: &Line<'_>, column: &Column, text: &str) -> Result<f64, FileError> {
    let parsed = text.parse().ok().filter(|x: &f64| x.is_finite());
    let number = parsed.ok_or_else(|| not_a_number(line, column, text))?;
    let sign = if column.is_negated { -1.0 } else { 1.0 };
    // A product of tens is exact and equal on every host. Columns have at most nine places.
    let unit: f64 = std::iter::repeat_n(10.0, column.places.unsigned_abs() as usize).product();
    Ok(sign * if column.places < 0 { number * unit } else { number / unit })
}

fn not_a_number(line: &Line<'_>, column: &Column, found: &str) -> FileError {
    let error = FileError::new(FileErrorKind::Syntax, "a finite number", format_args!("{found:?}"));
    error.at(place(line, &column.name))
}

const FORMATS: &str = "the columns time_s,x,y,z,qw,qx,qy,qz, a EuRoC file (#timestamp [ns],p_RS_R_x [m],...), a TUM file (eight numbers \
                       separated by spaces), a pose log (predicted_display_time,position_x,...,orientation_w as CSV or JSON lines) or a \
                       mapping of columns";

fn place(line: &Line<'_>, column: &str) -> String {
    format!("line {}, {column}", line.number)
}

fn no_sample() -> FileError {
    FileError::new(FileErrorKind::Empty, "at least one sample", "none")
}

fn out_of_range(place: impl Display, expected: impl Display, found: impl Display) -> FileError {
    FileError::new(FileErrorKind::Number, expected, found).at(place)
}
