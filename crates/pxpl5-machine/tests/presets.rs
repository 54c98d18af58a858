//! The presets, compared with published numbers.

use pxpl5_gp::{CodeUse, CodeVersion, GpTiming};
use pxpl5_machine::{MachineConfig, PRESETS};

/// Sources are TR94 (small-hmd, slats), I3D95 (slats-1995, slats-optimised, large) and F89 (design-maximum).
///
/// The time of `slats` is that of its code, and code that fits into the cache takes a third of it. The published limit of
/// 100 triangles per field (I3D95) corresponds to a time of 59.8 us.
#[test]
fn presets_have_the_boards_and_times_that_were_published() {
    let expected = [
        ("small-hmd", [13, 5], 21_700),
        ("slats", [1, 5], GpTiming::PAPERS.of_compiled_precomputed().triangle_ns),
        ("slats-1995", [1, 5], 59_800),
        ("slats-optimised", [1, 5], GpTiming::PAPERS.of_compiled_precomputed().triangle_ns / 3),
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
    assert_eq!(error.to_string(), "there is no machine `larg`; did you mean `large`?");
}

/// The version `Compiled` is the code that did not fit the cache.
#[test]
fn the_times_of_i860_code_depend_on_the_chosen_version_of_the_code() {
    let compiled = MachineConfig::slats();
    let scheduled = MachineConfig::preset("slats-optimised").expect("it is listed");
    let expected = [
        (&compiled, CodeUse::Slats, GpTiming::SLATS_1994.of_compiled_precomputed()),
        (&compiled, CodeUse::SlatsLit, GpTiming::SLATS_1994.of_compiled_gouraud()),
        (&scheduled, CodeUse::Slats, GpTiming::SLATS_OPTIMISED.of_scheduled_precomputed()),
        (&scheduled, CodeUse::SlatsLit, GpTiming::SLATS_OPTIMISED.of_scheduled_gouraud()),
        (&compiled, CodeUse::Pphigs, GpTiming::SLATS_1994.of_scheduled_phong()),
    ];
    for (before, of, times) in expected {
        let after = before.clone().with_times_of_code(of);
        assert_eq!(after.gp, times, "{} {of:?}", before.preset);
        assert_eq!(MachineConfig { gp: before.gp, ..after }, *before, "the rest stays");
    }
    // The machine `slats` has the times of its code already, and can have those of the papers instead.
    let slats = |preset: &str| MachineConfig::preset(preset).expect("it is listed").with_times_of_papers();
    assert_eq!(compiled.clone().with_times_of_code(CodeUse::Slats), compiled);
    assert_eq!(slats("slats").gp, GpTiming::SLATS_FITTED);
    // I3D95 expects a third of the time for code that fits in the instruction cache.
    assert_eq!(slats("slats-optimised").gp.triangle_ns, GpTiming::SLATS_FITTED.triangle_ns / 3);
    assert_eq!(slats("slats-1995"), MachineConfig::preset("slats-1995").expect("it is listed"));
    let without = MachineConfig { code: None, ..compiled.clone() };
    assert_eq!(without.with_times_of_code(CodeUse::Slats).gp, compiled.with_times_of_code(CodeUse::Slats).gp);
}

#[test]
fn a_machine_states_the_name_of_its_code_version() {
    let named = |code| MachineConfig { code, ..MachineConfig::slats() }.code_name();
    let versions = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];
    assert_eq!(versions.map(|version| named(Some(version))), ["unoptimised", "compiled", "scheduled"]);
    assert_eq!(named(None), "none");
}
