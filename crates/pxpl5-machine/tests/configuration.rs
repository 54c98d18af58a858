//! Tests of a machine's configuration: paths of parameters, limits, and parameters that identify a machine.

use crate::rig::{ScreenConfig, ScreenNumbers, config};
use pxpl5_machine::MachineConfig;
use pxpl5_sim::Span;
use pxpl5_sim::parameters::{Parameter, SettingErrorKind, Value};

pxpl5_sim::parameters::parameter_table! {
    struct Numbers {
        /// A time.
        step_ns: 500, "ns", Assumed, 100..=900 in 10..=1_000, "made up";
    }
}

pxpl5_sim::parameters::parameter_table! {
    struct Others {
        /// A fraction.
        share: f64 = 0.5, "", Assumed, 0.0..=1.0, "made up";
    }
}

fn usual() -> MachineConfig {
    MachineConfig::small_hmd()
}

fn changed(path: &str, value: impl Into<Value>) -> MachineConfig {
    let mut config = usual();
    config.set(path, value).expect(path);
    config
}

#[test]
fn parameters_of_all_boards_are_listed_in_order() {
    let mut config = usual();
    config.add_firmware_table("slats", Box::new(Numbers::PAPERS));
    let paths: Vec<String> = config.parameters().into_iter().map(|parameter| parameter.path).collect();
    let mut tables: Vec<&str> = paths.iter().filter_map(|path| Some(path.rsplit_once('.')?.0)).collect();
    tables.dedup();
    let [first, second, .., host, firmware] = &tables[..] else { panic!("{tables:?}") };
    assert_eq!([*first, *second, *host, *firmware], ["ring", "gp", "host", "slats"]);
    for table in ["renderer", "video", "i860.dram", i860::CHIP_PATH] {
        assert!(tables.contains(&table), "{table} of {tables:?}");
    }
    let settings: Vec<String> = config.settings().into_iter().map(|(path, _)| path).collect();
    assert_eq!(settings[..2], ["n_gps", "n_renderers"]);
    assert_eq!(settings[2..], paths);
    assert_eq!(config.settings()[..2], [("n_gps".to_owned(), 13.into()), ("n_renderers".to_owned(), 5.into())]);
}

#[test]
fn a_parameter_is_found_by_its_path_even_if_tables_share_a_name() {
    let config = changed("host.message_ns", 30_000);
    assert_eq!((config.host.message_ns, config.gp.message_ns), (30_000, usual().gp.message_ns));
    let expected = [("host.message_ns".to_owned(), 30_000.into())];
    assert_eq!(config.overrides().into_iter().collect::<Vec<_>>(), expected);
    assert_eq!(changed("n_renderers", 7).boards(), [13, 7]);
    assert_eq!(changed("n_gps", 7.0).boards(), [7, 5], "a whole number, however it is written");
}

#[test]
fn every_listed_parameter_can_be_set_or_is_refused_with_the_reason() {
    let mut config = usual();
    config.add_firmware_table("slats", Box::new(Numbers::PAPERS));
    for Parameter { path, value, read_only, .. } in config.parameters() {
        let set = config.set(&path, value);
        assert_eq!(set.is_ok(), !read_only, "{path}");
        assert_eq!(read_only, path.starts_with(i860::CHIP_PATH), "{path}");
        if let Err(error) = set {
            let expected = format!("{path} is {value} in every machine (");
            assert!(error.kind == SettingErrorKind::ReadOnly && error.to_string().starts_with(&expected), "{error}");
        }
    }
    assert_eq!(config.parameters().len(), config.settings().len() - 2);
}

#[test]
fn unknown_paths_name_the_nearest_path_and_invalid_numbers_are_refused() {
    let mut config = usual();
    for (wrong, nearest) in [
        ("ring.word_nss", "ring.word_ns"),
        ("n_gp", "n_gps"),
        ("ring.message_ns", "gp.message_ns"),
        ("host.word_ns", "ring.word_ns"),
    ] {
        let error = config.set(wrong, 5).expect_err(wrong);
        assert_eq!((&*error.found, &*error.nearest), (wrong, nearest));
        assert_eq!(error.to_string(), format!("there is no parameter `{wrong}`; did you mean `{nearest}`?"));
    }
    let error = config.set("n_gps", 1.5).expect_err("a fraction");
    assert_eq!(error.to_string(), "n_gps must be a whole number, found 1.5");
    let error = config.set("ring.word_ns", 1.5).expect_err("a fraction");
    assert_eq!(error.to_string(), "ring.word_ns must be a whole number, found 1.5");
    assert_eq!(config, usual(), "nothing changed");
}

#[test]
fn parameters_of_firmware_are_stored_once_and_found_by_type() {
    let mut config = usual();
    assert!(config.firmware_table::<Numbers>().is_none());
    config.add_firmware_table("first", Box::new(Numbers::PAPERS));
    config.add_firmware_table("second", Box::new(Others::PAPERS));
    config.set("first.step_ns", 700).expect("known");
    config.add_firmware_table("first", Box::new(Numbers::PAPERS));
    assert_eq!(config.firmware.len(), 2, "it was there already");
    let copy = config.clone();
    config.set("first.step_ns", 800).expect("known");
    assert_eq!(copy.firmware_table::<Numbers>().map(|table| table.step_ns), Some(700), "a copy of its own");
    assert_eq!(config.firmware_table::<Numbers>().map(|table| table.step_ns), Some(800));
    assert_eq!(config.firmware_table::<Others>().map(|table| table.share), Some(0.5));
}

/// Names of experiments depend on the parameters of the machine. Parameters of firmware and of the i860 were added
/// later. They appear in a name only if they were changed.
#[test]
fn the_identity_of_a_machine_includes_later_parameters_only_if_they_were_changed() {
    let telling = |config: &MachineConfig| -> Vec<String> {
        config.identifying_parameters().into_iter().map(|parameter| parameter.path).collect()
    };
    let all: Vec<String> = usual().parameters().into_iter().map(|parameter| parameter.path).collect();
    let own: Vec<String> = all.into_iter().filter(|path| !path.starts_with("i860.")).collect();
    assert_eq!(telling(&usual()), own);
    let mut other = usual();
    other.add_firmware_table("slats", Box::new(Numbers::PAPERS));
    let path =
        other.parameters().into_iter().map(|parameter| parameter.path).find(|path| path.starts_with("i860.dram."));
    let path = path.expect("a memory");
    assert_eq!(telling(&other), own, "as the papers have it");
    other.set("slats.step_ns", 600).expect("known");
    other.set(&path, 77).expect("known");
    let mut expected: std::collections::BTreeSet<String> = own.iter().cloned().collect();
    expected.extend([path, "slats.step_ns".to_owned()]);
    assert_eq!(telling(&other).into_iter().collect::<std::collections::BTreeSet<_>>(), expected);
    other.set("ring.word_ns", 51).expect("known");
    assert!(telling(&other).contains(&"ring.word_ns".to_owned()));
}

#[test]
fn two_machines_are_equal_only_if_no_board_parameter_or_display_differs() {
    let screen = |name| ScreenConfig { name, ..ScreenConfig::new(1) };
    let base = config(vec![Box::new(screen("one"))]);
    assert_eq!(base, base.clone());
    let differs = |change: &dyn Fn(&mut MachineConfig)| {
        let mut other = base.clone();
        change(&mut other);
        assert_ne!(other, base);
        assert_ne!(base, other);
    };
    differs(&|other| other.preset = "large".to_owned());
    differs(&|other| other.n_gps += 1);
    differs(&|other| other.n_renderers += 1);
    differs(&|other| other.code = None);
    differs(&|other| other.i860.replacement_seed += 1);
    differs(&|other| other.ring.word_ns += 1);
    differs(&|other| other.displays = vec![Box::new(screen("two"))]);
    differs(&|other| other.displays.push(Box::new(screen("one"))));
    differs(&|other| other.displays.clear());
}

#[test]
fn overrides_list_the_differences_from_the_preset() {
    assert!(usual().overrides().is_empty());
    let mut config = changed("n_gps", 24);
    assert_eq!(config.overrides(), [("n_gps".to_owned(), 24.into())].into());
    config.displays = vec![Box::new(ScreenConfig::new(1))];
    assert_eq!(config.overrides().len(), 1, "the other display's are as in its papers");
    config.set("screen.period_us", 60).expect("known");
    assert_eq!(config.overrides().get("screen.period_us"), Some(&60.into()));
    config.preset = "a file".to_owned();
    assert!(config.overrides().is_empty(), "it has no preset to differ from");
}

/// A value outside its range causes no warning if the preset has the same value. A value within its range never causes
/// a warning.
#[test]
fn changed_values_outside_their_range_cause_warnings() {
    let slats = MachineConfig::slats();
    let outside: Vec<Parameter> = slats.parameters().into_iter().filter(|parameter| !parameter.is_in_range()).collect();
    assert!(outside.iter().any(|parameter| parameter.path == "gp.bin_entry_ns"), "Slats has no bins");
    assert!(slats.out_of_range().is_empty());
    let mut config = slats;
    config.set("gp.triangle_ns", 31_000).expect("known");
    assert!(config.out_of_range().is_empty(), "within 18 to 32 us");
    config.set("gp.triangle_ns", 33_000).expect("known");
    let [found] = &config.out_of_range()[..] else { panic!("one") };
    assert_eq!((&found.path[..], found.is_in_range()), ("gp.triangle_ns", false));
    let expected = "gp.triangle_ns = 33000 ns is outside its range, 18000 to 32000 ns (derived: 870 clocks at 40 MHz";
    assert!(found.warning().starts_with(expected), "{}", found.warning());
}

#[test]
fn tables_are_listed_with_their_prefix() {
    let listed: Vec<Parameter> = Parameter::of_table("some", &Numbers::PAPERS, true).collect();
    let [Parameter { path, info, value, read_only }] = &listed[..] else { panic!("one number") };
    assert_eq!((&path[..], info.name, *value, *read_only), ("some.step_ns", "step_ns", 500.into(), true));
}

/// NTSC has 525 lines of 63.5556 us in two fields, which gives 59.94 fields per second.
#[test]
fn the_period_of_a_machine_is_the_period_of_its_first_display() {
    let field = usual().period().expect("it can be built");
    assert!((field.as_ms() - 1001.0 / 60.0).abs() < 1e-3, "{field:?}");
    let mut other = ScreenConfig::new(1);
    other.numbers = ScreenNumbers { period_us: 30 };
    let screens = config(vec![Box::new(other), Box::new(ScreenConfig::new(1))]);
    assert_eq!(screens.period(), Ok(Span::from_us(30)));
    let none = config(Vec::new());
    assert_eq!(none.period().expect_err("no display").to_string(), "a machine needs a display; found none");
}

#[test]
fn an_impossible_machine_is_refused_with_the_parameter_and_its_limits() {
    let refusal = |config: MachineConfig| config.check().expect_err("refused").to_string();
    for (path, limits) in [("n_gps", "1 to 1000"), ("n_renderers", "1 to 1000"), ("ring.channels", "1 to 64")] {
        for found in [0, 1_001] {
            assert_eq!(refusal(changed(path, found)), format!("{path} must be {limits}, found {found}"));
        }
    }
    changed("n_gps", 1_000).check().expect("a thousand is allowed");
    let error = changed("ring.channels", 65).check().expect_err("refused");
    assert_eq!((error.kind, &*error.name), (SettingErrorKind::Limits, "ring.channels"));
    let mut firmware = usual();
    firmware.add_firmware_table("slats", Box::new(Numbers { step_ns: 5 }));
    assert_eq!(refusal(firmware), "slats.step_ns must be 10 to 1000, found 5");
    assert_eq!(refusal(config(Vec::new())), "a machine needs a display; found none");
    assert_eq!(refusal(config(vec![Box::new(ScreenConfig::new(0))])), "a screen has a surface at least");
}
