//! Tests of the figures of the paper that follow from definitions and formulas.

use spatialgl::perspecta::figures::{definitions, formulas, packing};

/// Tests the definitions of the figures against the printed numbers of the SpatialGL paper. The
/// expected values of D5, D7 and D12 were computed by hand for 396 slices of 768 x 768 pixels.
#[test]
fn the_definitions_of_the_figures_have_the_printed_numbers_of_the_paper() {
    let all = definitions();
    let values = |id: &str| all.iter().filter(|one| one.id == id).map(|one| one.value).collect::<Vec<_>>();
    for (id, expected) in [("P1", 396.0), ("P6", 32.0), ("P8", 90.625), ("P13", 4.0), ("P16", 32.0), ("P18", 4.0)] {
        assert_eq!(values(id), [expected], "{id}");
    }
    assert_eq!(values("P20"), [6.0, 9.0, 18.0]);
    assert_eq!(values("D5"), [116_785_152.0]);
    let expected = [934_281_216.0, 2_359_296.0, 116_785_152.0, 11.678_515_2, 512.0, 175.177_728];
    let found = values("D7");
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-9), "{found:?}");
    assert!(values("D12").iter().zip([200.0 / 3.0, 80.0]).all(|(value, expected)| (value - expected).abs() < 1e-9));
}

#[test]
fn the_derived_formulas_and_packing_figures_are_met() {
    for figure in formulas().into_iter().chain(packing()) {
        assert!(figure.is_met, "{figure:?}");
    }
}
