//! Tests of parameter tables through their public interface.

use pxpl5_sim::parameters::{ParameterTable, Provenance, SettingErrorKind, Value, parameter_table};

parameter_table! {
    /// A table with whole and real numbers, with and without limits.
    struct Table {
        /// A published time with limits wider than its range.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94";
        /// A cost whose range also serves as its limits.
        send_ns: 12_000, "ns", Assumed, 10_000..=25_000, "a reason";
        /// A measured error.
        noise: f64 = 2.5, "mm", Derived, 0.0..=5.0 in 0.0..=1000.0, "a data sheet";
    }
}

#[test]
fn a_parameter_is_found_by_name_and_an_unknown_name_gives_the_nearest_name() {
    let mut table = Table::PAPERS;
    table.set("send_ns", Value::Whole(10_000)).expect("known");
    table.set("noise", Value::Real(0.5)).expect("known");
    assert_eq!(table.get("send_ns"), Ok(Value::Whole(10_000)));
    assert_eq!(table.noise, 0.5);
    let error = table.set("sned_ns", Value::Whole(1)).expect_err("unknown");
    assert_eq!(error.to_string(), "there is no parameter `sned_ns`; did you mean `send_ns`?");
}

#[test]
fn integers_stay_exact_and_accept_no_fraction() {
    let mut table = Table::PAPERS;
    table.set("word_ns", Value::Whole(u64::MAX)).expect("known");
    assert_eq!(table.get("word_ns"), Ok(Value::Whole(u64::MAX)));
    let error = table.set("word_ns", Value::Real(1.5)).expect_err("a fraction");
    assert_eq!(error.to_string(), "word_ns must be a whole number, found 1.5");
    assert_eq!(table.word_ns, u64::MAX, "a refused value changes nothing");
}

#[test]
fn a_value_within_its_limits_is_accepted_and_listed_if_out_of_its_range() {
    let table = Table { word_ns: 25, ..Table::PAPERS };
    let names: Vec<_> = table.out_of_range().iter().map(|entry| entry.info.name).collect();
    assert_eq!(names, ["word_ns"]);
    assert_eq!(table.check(), Ok(()));
}

#[test]
fn a_parameter_at_its_limits_is_accepted_and_a_parameter_one_beyond_is_refused() {
    for (word_ns, is_possible) in [(0, false), (1, true), (1_000_000, true), (1_000_001, false)] {
        assert_eq!(Table { word_ns, ..Table::PAPERS }.check().is_ok(), is_possible, "{word_ns}");
    }
}

#[test]
fn a_parameter_without_limits_is_limited_to_its_range() {
    for (send_ns, is_possible) in [(9_999, false), (10_000, true), (25_000, true), (25_001, false)] {
        assert_eq!(Table { send_ns, ..Table::PAPERS }.check().is_ok(), is_possible, "{send_ns}");
    }
}

#[test]
fn an_error_states_the_expected_and_found_values() {
    let error = Table { noise: f64::NAN, ..Table::PAPERS }.check().expect_err("NaN is in no range");
    assert_eq!(error.to_string(), "noise must be 0 to 1000, found NaN");
    assert_eq!((error.kind, &*error.name), (SettingErrorKind::Limits, "noise"));
}

#[test]
fn tables_of_different_types_are_listed_together() {
    parameter_table! {
        /// A second table with one number.
        struct Other {
            /// A count.
            n_channels: 8, "channels", Published, 8..=8, "TR94";
        }
    }
    let tables: [&dyn ParameterTable; 2] = [&Table::PAPERS, &Other::PAPERS];
    let entries: Vec<_> = tables.iter().flat_map(|table| table.entries()).collect();
    let values: Vec<_> = entries.iter().map(|entry| entry.value.to_string()).collect();
    assert_eq!(values, ["50", "12000", "2.5", "8"]);
    assert_eq!(entries[2].info.provenance, Provenance::Derived);
}

#[test]
fn two_tables_are_equal_if_all_their_numbers_are_equal() {
    assert_eq!(Table::PAPERS, Table::PAPERS);
    assert_ne!(Table { noise: 2.6, ..Table::PAPERS }, Table::PAPERS);
}

#[test]
fn every_preset_is_in_range() {
    assert_eq!(Table::PAPERS.out_of_range(), []);
}
