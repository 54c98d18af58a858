//! The presets, compared with published numbers.

use pxpl5_gp::{CodeVersion, GpTiming};
use pxpl5_machine::{MachineConfig, PRESETS};

/// Sources are TR94 (small-hmd, slats), I3D95 (slats-1995, slats-optimised, large) and F89 (design-maximum).
///
/// The published limits of 110 triangles per field (TR94) and 100 (I3D95) correspond to 30.0 and 55.8 us. Code that
/// fits into the cache takes a third of the time.
#[test]
fn presets_have_the_boards_and_times_that_were_published() {
    let expected = [
        ("small-hmd", [13, 5], 21_700),
        ("slats", [1, 5], 30_000),
        ("slats-1995", [1, 5], 55_800),
        ("slats-optimised", [1, 5], 10_000),
        ("medium", [24, 10], 21_700),
        ("design-maximum", [32, 16], 21_700),
        ("large", [50, 20], 21_700),
    ];
    assert_eq!(PRESETS.map(|preset| preset.name), expected.map(|(name, ..)| name));
    for (name, boards, triangle_ns) in expected {
        let config = MachineConfig::preset(name).expect("it is listed");
        assert_eq!(config.preset, name);
        assert_eq!((config.boards(), config.gp.triangle_ns), (boards, triangle_ns), "{name}");
        assert_eq!(config.displays.iter().map(|display| display.name()).collect::<Vec<_>>(), ["ntsc"]);
        assert!(config.firmware.is_empty());
    }
    assert_eq!(MachineConfig::small_hmd(), MachineConfig::preset("small-hmd").expect("listed"));
    assert_eq!(MachineConfig::slats(), MachineConfig::preset("slats").expect("listed"));
}

#[test]
fn an_unknown_preset_names_the_nearest() {
    let error = MachineConfig::preset("larg").expect_err("misspelt");
    assert_eq!(error.to_string(), "there is no machine `larg`; did you mean `large`? (`pxpl5 machines` lists all)");
}

/// Slats uses Gouraud shading (TR94), and Rendering Control uses Phong shading. The compiled code does not fit into the
/// cache.
#[test]
fn times_of_code_are_those_of_the_code_that_a_preset_runs() {
    for preset in PRESETS {
        let before = MachineConfig::preset(preset.name).expect("it is listed");
        let after = before.clone().with_times_of_code();
        let expected = match preset.name {
            "slats" | "slats-1995" => before.gp.of_compiled_precomputed(),
            "slats-optimised" => before.gp.of_scheduled_precomputed(),
            _ => before.gp.of_scheduled_phong(),
        };
        assert_eq!(after.gp, expected, "{}", preset.name);
        assert_ne!(after.gp, before.gp);
        assert_eq!(MachineConfig { gp: before.gp, ..after }, before, "the rest stays");
    }
    let mut without = MachineConfig::slats();
    without.code = None;
    assert_eq!(without.with_times_of_code().gp, GpTiming::SLATS_1994.of_compiled_precomputed());
    let mut compiled = MachineConfig::small_hmd();
    compiled.code = Some(CodeVersion::Compiled);
    assert_eq!(compiled.with_times_of_code().gp, GpTiming::PAPERS.of_scheduled_phong());
}

#[test]
fn code_is_named() {
    let named = |code| MachineConfig { code, ..MachineConfig::slats() }.code_name();
    let versions = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];
    assert_eq!(versions.map(|version| named(Some(version))), ["unoptimised", "compiled", "scheduled"]);
    assert_eq!(named(None), "none");
}
