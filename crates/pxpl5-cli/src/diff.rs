//! The command `pxpl5 diff`, which compares two results.

use crate::error::CliError;
use crate::report::files::Files;
use crate::terminal::print;
use clap::Args;
use pxpl5::Study;
use pxpl5::lab::diff::{Changed, DiffQuery, Differences};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const REPORT_FILE: &str = "report.json";

/// Compare two results: settings, numbers and pictures.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 diff out/slats out/rendering-control
  pxpl5 diff out/a/report.json out/b/report.json --least 5 --json

A result is a folder that `pxpl5 run --out` wrote, or its report.json. Pictures are compared if the manifests of both folders list them.")]
pub(crate) struct DiffArgs {
    /// First result: a folder of `pxpl5 run --out`, or its report.json.
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Second result: a folder of `pxpl5 run --out`, or its report.json.
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Leave out numbers that differ by less than this percentage.
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0)]
    least: f64,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

#[derive(Debug)]
struct PictureDifference {
    name: String,
    sizes: [[u32; 2]; 2],
    /// Number of pixels that differ. `None` if the pictures have different sizes.
    differing: Option<u64>,
    /// Largest difference of a colour component, 0 to 255. `None` if the pictures have different sizes.
    largest: Option<u8>,
}

pub(crate) fn run(args: DiffArgs) -> Result<(), CliError> {
    let study = DiffQuery { reports: [report(&args.a)?, report(&args.b)?] };
    let mut found = study.run(&mut ())?;
    found.results.retain(|changed| changed.percent.is_none_or(|percent| percent.abs() >= args.least));
    let pictures = pictures(&args.a, &args.b)?;
    if args.json {
        let mut object = serde_json::to_value(&found).map_err(CliError::failure)?;
        object["schema"] = Value::from("pxpl5-diff/1");
        let picture = |PictureDifference { name, sizes, differing, largest }: &PictureDifference| json!({"name": name, "sizes": sizes, "differing": differing, "largest": largest});
        object["pictures"] = pictures.iter().map(picture).collect();
        return print(&format!("{object:#}\n"));
    }
    print(&text(&found, &pictures))
}

/// Reads the report of a result, which is a report file or a folder of `pxpl5 run --out`.
fn report(path: &Path) -> Result<Value, CliError> {
    let file = if path.is_dir() { path.join(REPORT_FILE) } else { path.to_owned() };
    let name = file.display();
    // In a folder, only a report that belongs to the folder's run counts.
    let read = if path.is_dir() {
        Files::of(path, false)?.first(REPORT_FILE)
    } else {
        std::fs::read(path).map_err(|error| error.to_string())
    };
    let bytes = read.map_err(|error| CliError::usage(format!("{name}: {error}; expected a {REPORT_FILE}")))?;
    let report: Value = serde_json::from_slice(&bytes).map_err(|error| CliError::usage(format!("{name}: {error}")))?;
    match report["schema"].as_str() {
        Some(schema) if schema.starts_with("pxpl5-report/") => Ok(report),
        found => Err(CliError::usage(format!(
            "{name}: expected the schema pxpl5-report, found {}; `pxpl5 run --out` writes it",
            found.unwrap_or("none")
        ))),
    }
}

/// Compares the pictures of two folders. The manifest (list of files) of each folder names the pictures. A result that
/// is a single file has no pictures.
fn pictures(a: &Path, b: &Path) -> Result<Vec<PictureDifference>, CliError> {
    if !(a.is_dir() && b.is_dir()) {
        return Ok(Vec::new());
    }
    let [of_a, of_b] = [Files::of(a, false)?, Files::of(b, false)?];
    let mut all = Vec::new();
    for name in of_a.names().filter(|name| name.ends_with(".png")) {
        // A picture that has changed since its run is left out with a warning.
        if let Some(pair) = of_a.read(name).zip(of_b.read(name)) {
            all.push(picture(name, [(a, pair.0), (b, pair.1)])?);
        }
    }
    all.sort_by(|one, other| one.name.cmp(&other.name));
    Ok(all)
}

fn picture(name: &str, files: [(&Path, Vec<u8>); 2]) -> Result<PictureDifference, CliError> {
    let decoded = files.map(|(folder, bytes)| {
        let refused = |error| CliError::usage(format!("{}: {error}", folder.join(name).display()));
        image::load_from_memory(&bytes).map(image::DynamicImage::into_rgb8).map_err(refused)
    });
    let [a, b] = decoded;
    let (a, b) = (a?, b?);
    let sizes = [&a, &b].map(|picture| [picture.width(), picture.height()]);
    let same_size = sizes[0] == sizes[1];
    let pairs = || a.pixels().zip(b.pixels());
    let distance = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or_default()
    };
    let differing = same_size.then(|| pairs().filter(|pair| distance(*pair) > 0).count() as u64);
    let largest = same_size.then(|| pairs().map(distance).max().unwrap_or_default());
    Ok(PictureDifference { name: name.to_owned(), sizes, differing, largest })
}

fn text(found: &Differences, pictures: &[PictureDifference]) -> String {
    let mut text = String::new();
    let trace = if found.same_trace { "The traces are equal." } else { "The traces differ." };
    let _ = writeln!(text, "{trace} {} results are equal, {} differ.", found.equal, found.results.len());
    for (title, changes) in [("Settings", &found.settings), ("Results", &found.results)] {
        if !changes.is_empty() {
            let _ = writeln!(text, "\n{title}");
            changes.iter().for_each(|changed| text.push_str(&line(changed)));
        }
    }
    if !pictures.is_empty() {
        let _ = writeln!(text, "\nPictures");
    }
    // Pictures of different sizes have no count of differing pixels.
    for PictureDifference { name, sizes: [a, b], differing, largest } in pictures {
        let all = u64::from(a[0]) * u64::from(a[1]);
        let _ = match differing {
            Some(0) => writeln!(text, "{name}: equal"),
            Some(count) => writeln!(
                text,
                "{name}: {count} of {all} pixels differ, by at most {} of 255",
                largest.unwrap_or_default()
            ),
            None => writeln!(text, "{name}: {} x {} and {} x {} pixels", a[0], a[1], b[0], b[1]),
        };
    }
    text
}

/// Formats the difference of one value as a line. Long texts are shortened.
fn line(changed: &Changed) -> String {
    let cell = |value: &Option<Value>| match value {
        None | Some(Value::Null) => "-".to_owned(),
        Some(Value::String(text)) => text.chars().take(40).collect(),
        Some(Value::Number(number)) if number.is_f64() => format!("{:.4}", number.as_f64().unwrap_or(f64::NAN)),
        Some(other) => other.to_string(),
    };
    let percent = changed.percent.map_or_else(String::new, |percent| format!("  {percent:+.1} %"));
    format!("{:<44} {:>16} {:>16}{percent}\n", changed.key, cell(&changed.a), cell(&changed.b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_shows_the_relative_change_and_a_dash_for_a_missing_number() {
        let changed = Changed::new("latency_ms.mean", Some(&Value::from(20.0)), Some(&Value::from(25.0)));
        assert!(line(&changed).ends_with("20.0000          25.0000  +25.0 %\n"), "{}", line(&changed));
        let missing = Changed::new("latency_ms.mean", Some(&Value::from(20.0)), None);
        assert!(line(&missing).ends_with("20.0000                -\n"), "{}", line(&missing));
    }
}
