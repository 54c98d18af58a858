//! Golden images: the pictures of each pipeline for built-in scenes must be equal to the bit on every host.
//!
//! A piece of each picture is in `tests/golden/` for inspection. A fingerprint of the whole picture is in
//! `tests/golden/fingerprints.txt`. On a mismatch, `target/images/` gets a triptych: expected, difference, actual. The
//! files change only by `PXPL5_UPDATE_IMAGES=1 cargo test -p pxpl5 --test main images`, and must then be inspected.

use crate::support::boards;
use image::{Rgb, RgbImage, imageops};
use pxpl5::{
    Experiment, Eye, MachineConfig, Measured, Outcome, PeriodNumber, Pipeline, RegionBinning, RenderingControl, Slats,
    scene,
};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const UPDATE: &str = "PXPL5_UPDATE_IMAGES";

/// A scene and the stored piece of its frames: left, top, width, height.
struct Subject {
    scene: &'static str,
    piece: [u32; 4],
    /// Number of fields, enough for [`pxpl5::WARM_UP_PICTURES`] and one more picture.
    fields: u64,
}

const SUBJECTS: [Subject; 4] = [
    Subject { scene: "mig", piece: [200, 120, 256, 200], fields: 60 },
    // Under Slats, a picture of this scene takes four fields. After this number of fields, both halves of the frame
    // have been drawn.
    Subject { scene: "molecules", piece: [180, 130, 240, 180], fields: 90 },
    Subject { scene: "head", piece: [120, 60, 320, 260], fields: 160 },
    Subject { scene: "full-screen:12", piece: [288, 208, 64, 64], fields: 60 },
];

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("tmp lies in target").join("images");
    std::fs::create_dir_all(&folder).expect("target can be written");
    folder.join(name)
}

/// Returns the 64-bit FNV-1a hash of size and bytes.
fn fingerprint(picture: &RgbImage) -> String {
    let size = [picture.width(), picture.height()].map(u32::to_le_bytes);
    let bytes = size.as_flattened().iter().chain(picture.as_raw());
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3));
    format!("{hash:016x}")
}

fn fingerprints() -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(golden("fingerprints.txt")).unwrap_or_default();
    text.lines()
        .filter_map(|line| line.split_once(' '))
        .map(|(hash, name)| (name.to_owned(), hash.to_owned()))
        .collect()
}

/// Returns the stored piece of a frame, or its lines in a field.
fn piece(picture: &RgbImage, [left, top, width, height]: [u32; 4]) -> RgbImage {
    let step = 480 / picture.height();
    let top = top / step;
    let height = height / step;
    imageops::crop_imm(picture, left, top, width, height).to_image()
}

/// Returns three pictures side by side: expected, difference (white where equal, black otherwise), actual.
fn triptych(expected: &RgbImage, actual: &RgbImage) -> RgbImage {
    let width = expected.width().max(actual.width());
    let height = expected.height().max(actual.height());
    let differs = |x, y| expected.get_pixel_checked(x, y) != actual.get_pixel_checked(x, y);
    let difference = RgbImage::from_fn(width, height, |x, y| Rgb([if differs(x, y) { 0 } else { 255 }; 3]));
    let mut out = RgbImage::new(3 * width, height);
    for (column, panel) in [expected, &difference, actual].into_iter().enumerate() {
        imageops::replace(&mut out, panel, i64::from(width) * column as i64, 0);
    }
    out
}

/// Compares a picture with the stored one. Returns a description of the difference, if any.
fn check(name: &str, picture: &RgbImage, subject: &Subject, fingerprints: &BTreeMap<String, String>) -> Option<String> {
    let actual = piece(picture, subject.piece);
    let Ok(expected) = image::open(golden(&format!("{name}.png"))) else {
        return Some(format!("{name}: there is no golden image; {UPDATE}=1 makes one"));
    };
    let expected = expected.into_rgb8();
    if expected != actual {
        let at = scratch(&format!("{name}.png"));
        triptych(&expected, &actual).save(&at).expect("target can be written");
        return Some(format!("{name}: see {} (expected, difference, actual)", at.display()));
    }
    if fingerprints.get(name) != Some(&fingerprint(picture)) {
        let at = scratch(&format!("{name}-whole.png"));
        picture.save(&at).expect("target can be written");
        let [left, top, width, height] = subject.piece;
        return Some(format!(
            "{name}: differs outside of the {width} x {height} pixels at {left}, {top} that are kept; see {}",
            at.display()
        ));
    }
    None
}

fn update(name: &str, picture: &RgbImage, subject: &Subject) {
    std::fs::create_dir_all(golden("")).expect("the project can be written");
    piece(picture, subject.piece).save(golden(&format!("{name}.png"))).expect("the project can be written");
    picture.save(scratch(&format!("{name}-whole.png"))).expect("target can be written");
}

/// Returns the newest picture alone: a frame of Rendering Control or a field of Slats. A field interlaced with the
/// previous one would show two poses of a moving scene.
fn shown(outcome: &Outcome, eye: Eye) -> RgbImage {
    let newest = outcome.pictures().last().expect("it has shown some").picture;
    let frame_buffer = &boards(outcome)[eye.index()];
    match outcome.pipeline().name() {
        "slats" => {
            let last = frame_buffer.last_seen().expect("a field was scanned");
            let n = last.field().0 - (last.field().0 ^ newest.period_drawn_for().0) % 2;
            frame_buffer.seen(PeriodNumber(n)).expect("the last fields are remembered").picture()
        }
        _ => outcome.picture(eye).expect("pixels are on"),
    }
}

/// Returns the pictures of both eyes with their names.
fn pictures(pipeline: Arc<dyn Pipeline>, config: &MachineConfig, subject: &Subject) -> Vec<(String, RgbImage)> {
    let scene = scene::builtin(subject.scene).expect("built in");
    let name = format!("{}-{}", pipeline.name(), subject.scene.replace(':', "-"));
    let outcome = Experiment::with(config.clone(), pipeline, scene.into()).fields(subject.fields).run();
    let outcome = outcome.unwrap_or_else(|error| panic!("{name}: {error}"));
    Eye::BOTH.map(|eye| (format!("{name}-{eye:?}").to_lowercase(), shown(&outcome, eye))).into()
}

fn compare(pipeline: impl Pipeline + Copy + 'static, config: &MachineConfig) {
    let expected = fingerprints();
    let mut wrong = String::new();
    let mut fresh = expected.clone();
    let updating = std::env::var_os(UPDATE).is_some();
    for subject in &SUBJECTS {
        for (name, picture) in pictures(Arc::new(pipeline), config, subject) {
            if updating {
                update(&name, &picture, subject);
                fresh.insert(name, fingerprint(&picture));
            } else if let Some(what) = check(&name, &picture, subject, &expected) {
                let _ = writeln!(wrong, "{what}");
            }
        }
    }
    if updating {
        let lines: String = fresh.iter().map(|(name, hash)| format!("{hash} {name}\n")).collect();
        std::fs::write(golden("fingerprints.txt"), lines).expect("the project can be written");
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

/// Returns a machine with more boards, because the published machine can draw only 140 triangles in time. Pictures that
/// miss their retrace are shown later in their place.
fn many_boards() -> MachineConfig {
    let published = MachineConfig::preset("slats-optimised").expect("listed");
    MachineConfig { n_gps: 32, ..published }
}

fn drawn_by(n_gps: usize, pipeline: Arc<dyn Pipeline>, subject: &Subject) -> Vec<(String, RgbImage)> {
    pictures(pipeline, &MachineConfig { n_gps, ..MachineConfig::small_hmd() }, subject)
}

#[test]
fn the_picture_of_a_still_scene_does_not_depend_on_the_number_of_processors() {
    let subject = &SUBJECTS[3];
    let control = Arc::new(RenderingControl::stereo());
    let slats = Arc::new(Slats::split());
    for n_gps in [3, 13] {
        assert!(
            drawn_by(n_gps, control.clone(), subject) == drawn_by(2, control.clone(), subject),
            "rendering control with {n_gps}"
        );
        assert!(drawn_by(n_gps, slats.clone(), subject) == drawn_by(1, slats.clone(), subject), "Slats with {n_gps}");
    }
}

/// A single test covers all pipelines, because two simultaneous updates would lose half of the fingerprints.
#[test]
fn both_pipelines_show_the_golden_images_to_both_eyes() {
    compare(RenderingControl::stereo(), &MachineConfig::small_hmd());
    compare(Slats { binning: RegionBinning::Touched, ..Slats::split() }, &many_boards());
}
