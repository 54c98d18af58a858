//! Tests of settings by path: accepted values, and errors for other values.

use pxpl5_sim::parameters::{Parameter, PathSettings};
use pxpl5_volume::spatialgl::{BinTolerance, SliceClip};
use pxpl5_volume::{SettingError, VolumeSettings};

fn set(assignment: &str) -> Result<VolumeSettings, SettingError> {
    let mut settings = VolumeSettings::paper();
    settings.assign(assignment, "--set")?;
    settings.swept_display()?;
    settings.volume_config()?;
    Ok(settings)
}

fn refused(assignment: &str) -> String {
    set(assignment).expect_err(assignment).to_string()
}

#[test]
fn every_path_of_the_specification_is_a_setting() {
    let keys = VolumeSettings::paper().keys();
    for path in [
        "display.slices",
        "display.width",
        "display.spin_rpm",
        "clip.bias_px2",
        "jitter.eye_distance",
        "tile.size",
        "tile.batch",
        "gpu.readback_mb_s",
    ] {
        assert!(keys.iter().any(|key| key == path), "{path} is not among {keys:?}");
    }
}

#[test]
fn setting_each_number_to_the_value_of_the_paper_changes_nothing() {
    for Parameter { path, value, .. } in VolumeSettings::paper().numbers() {
        let settings = set(&format!("{path}={value}")).expect("the value that it has");
        assert_eq!(settings, VolumeSettings::paper(), "{path}");
        assert!(settings.overrides().is_empty());
    }
}

#[test]
fn each_clip_setting_includes_its_offset_or_bias() {
    for (text, expected) in [
        ("prism", SliceClip::Prism),
        ("user-planes", SliceClip::UserPlanes),
        ("exact", SliceClip::ShaderPlanes),
        ("tapered:1", SliceClip::Tapered(1.0)),
        ("parallel:0.25", SliceClip::Parallel(0.25)),
        ("hyperbolic:1", SliceClip::Hyperbolic(1.0)),
        ("hyperbolic", SliceClip::Hyperbolic(0.25)),
    ] {
        let settings = set(&format!("clip.variant={text}")).expect("valid");
        assert_eq!(settings.slice_clip(), expected);
    }
}

#[test]
fn overrides_list_the_differences_from_the_paper() {
    let settings = set("gpu.readback_mb_s=1000").expect("valid");
    let overrides = settings.overrides();
    assert_eq!(overrides.len(), 1);
    assert_eq!(overrides[0].path, "gpu.readback_mb_s");
    assert_eq!((overrides[0].value.whole(), overrides[0].papers.whole()), (Some(1000), Some(200)));
}

#[test]
fn a_tolerance_is_a_name_or_a_number_of_pixels() {
    assert_eq!(set("bins.tolerance=codes").expect("valid").bin_tolerance, BinTolerance::Codes);
    assert_eq!(set("bins.tolerance=1.5").expect("valid").bin_tolerance, BinTolerance::Pixels(1.5));
    assert!(refused("bins.tolerance=-1").contains("clip, codes or a number of pixels"));
}

/// Checks the errors for invalid inputs. Each error says what is wrong and where, and names the expected and the found
/// value.
#[test]
fn invalid_input_is_refused_with_the_expected_and_found_values() {
    for (assignment, parts) in [
        ("display.slices=397", ["display.slices", "even", "397"]),
        ("display.slices=2", ["display.slices", "4 to 4096", "2"]),
        ("display.width=770", ["display.width", "multiple of 8", "770"]),
        ("tile.size=12", ["tile.size", "multiple of 8", "12"]),
        ("tile.batch=0", ["tile.batch", "1 to 65536", "0"]),
        ("clip.variant=parallel:-1", ["clip.offset_px", "0 to", "-1"]),
        ("clip.variant=hyperbolic:-0.25", ["clip.bias_px2", "0 to", "-0.25"]),
        ("clip.bias_px2=nan", ["clip.bias_px2", "0 to", "nan"]),
        ("clip.variant=tapered:4", ["clip.offset_px", "0 to 3.04", "4"]),
        ("jitter.eye_distance=0.001", ["jitter.eye_distance", "more than 3.0", "0.384"]),
        ("draw.matrix=6", ["halftone.matrix", "2, 4, 8 or 16", "6"]),
        ("draw.samples=9", ["draw.samples", "1, 4 or 16", "9"]),
        ("draw.coverage=all", ["draw.coverage", "sampled or connected", "all"]),
        ("seed=-1", ["seed", "a whole number", "-1"]),
        ("display.slices=many", ["display.slices", "a whole number", "many"]),
        ("clip.variant=exact:1", ["clip.variant", "exact without a number", "exact:1"]),
        ("clip.bias", ["PATH=VALUE", "an equals sign", "clip.bias"]),
        ("clip.bias_px=1", ["--set", "clip.bias_px", "did you mean `clip.bias_px2`"]),
    ] {
        let message = refused(assignment);
        for part in parts {
            assert!(message.contains(part), "{assignment}: `{part}` is not in: {message}");
        }
    }
}
