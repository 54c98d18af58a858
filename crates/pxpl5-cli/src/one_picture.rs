//! The option `--picture`: one picture of a run, and why it took its time.

use crate::error::CliError;
use crate::numbers::dash;
use pxpl5::run::in_ms as ms;
use pxpl5::{CriticalPath, Outcome, PictureNumber, PictureResult, PictureTimes, Report, Time};
use std::fmt::Write;

/// Returns the times of a picture, or an error with the pictures of the run.
pub(crate) fn find(outcome: &Outcome, number: u64) -> Result<&PictureTimes, CliError> {
    let pictures = outcome.pictures();
    pictures.iter().find(|times| times.picture == PictureNumber(number)).ok_or_else(|| {
        let numbers = || pictures.iter().map(|times| times.picture.0);
        CliError::failure(match numbers().min().zip(numbers().max()) {
            Some((first, last)) => format!("--picture: expected one of the pictures {first} to {last}, found {number}"),
            None => "--picture: no picture was begun in this run; simulate more fields".to_owned(),
        })
    })
}

/// Returns the span from the head pose of a picture to the end of the period in which it is first shown.
pub(crate) fn span(outcome: &Outcome, times: &PictureTimes) -> [Time; 2] {
    let record = outcome.record();
    let after = record.display().period_at(times.shown_at).next();
    [times.sampled_at.unwrap_or(times.transform_at).min(times.transform_at), record.tick(after)]
}

/// Explains a picture: its instants, and its waits beside those of the last pictures of the run.
pub(crate) fn text(outcome: &Outcome, report: &Report, times: &PictureTimes) -> String {
    let result = match times.end {
        PictureResult::Shown => "was shown",
        PictureResult::Late => "came too late",
        PictureResult::Incomplete => "was incomplete when its time on the screen ended",
    };
    let mut text = format!("\nPicture {} {result}:\n", times.picture);
    let field = format!("shown, from field {}", outcome.record().display().period_at(times.shown_at));
    let instants = [
        ("pose sampled", times.sampled_at),
        ("TRANSFORM begins", Some(times.transform_at)),
        ("last pixel arrives", times.copied_at),
        (if times.is_shown() { &field } else { "due" }, Some(times.shown_at)),
    ];
    for (what, at) in instants {
        let _ = writeln!(text, "  {what:<28} {}", at.map_or_else(dash, ms));
    }
    let Some(path) = CriticalPath::of_picture(outcome, times) else { return text };
    let usual = report.critical_path.as_ref();
    let heads = ["waits, from TRANSFORM on", "this picture", "last pictures"];
    let _ = writeln!(text, "  {:<50} {:>14} {:>14}", heads[0], heads[1], heads[2]);
    for part in &path.parts {
        let of_usual = usual.and_then(|usual| usual.parts.iter().find(|other| other.resource == part.resource));
        let of_usual = of_usual.map_or_else(dash, |other| format!("{:.3} ms", other.ms));
        let _ = writeln!(text, "  {:<50} {:>11.3} ms {of_usual:>14}", part.resource.about(), part.ms);
    }
    let _ = writeln!(text, "  back from the screen: {}", path.chain.join("; "));
    text
}
