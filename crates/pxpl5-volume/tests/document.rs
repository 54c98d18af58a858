//! Tests of the paper's figures. Every formula gives the printed value, statements without numbers are confirmed, and
//! the document is up to date.

use pxpl5_scene::builtin;
use pxpl5_volume::figures::{FigureDrawing, VolumeFigures, all, drawings, markdown};
use pxpl5_volume::spatialgl::Threads;
use std::sync::{Arc, LazyLock};

static FIGURES: LazyLock<VolumeFigures> = LazyLock::new(|| {
    let scenes = ["mig", "head", "molecules"].map(|name| Arc::new(builtin(name).expect("built in")));
    all(&scenes, &Threads::all(), &mut ()).expect("valid scenes")
});

#[test]
fn every_figure_of_the_specification_has_a_row() {
    let defined = FIGURES.definitions.iter().map(|row| row.id);
    let ids: Vec<&str> = FIGURES.figures.iter().map(|row| row.id).chain(defined).collect();
    for id in [
        "P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8", "P9", "P10", "P11", "P13", "P14", "P15", "P16", "P17", "P18",
        "P19", "P20", "D1", "D2", "D3", "D4", "D5", "D6", "D7", "D8", "D9", "D10", "D11", "D12",
    ] {
        assert!(ids.contains(&id), "{id} is not among {ids:?}");
    }
    assert_eq!((ids[0], FIGURES.definitions[0].id), ("P2", "P1"), "printed ones first, by number");
}

/// Checks that all figures without a scene agree with the paper. Figures measured on a scene must be listed as missed
/// if they do not agree.
#[test]
fn every_figure_that_needs_no_scene_is_met() {
    for row in FIGURES.figures.iter().filter(|row| row.scene.is_none()) {
        assert!(row.is_met, "{row:?}");
    }
}

/// Checks the numbers that no run can change: inputs that the paper states, and results of plain arithmetic. They have
/// no verdict.
#[test]
fn a_number_independent_of_runs_is_a_definition_without_verdict() {
    let inputs = ["P1", "P6", "P13", "P16", "P18", "P20", "D12"];
    for id in inputs {
        assert!(FIGURES.definitions.iter().any(|row| row.id == id), "{id} is a definition");
        assert!(FIGURES.figures.iter().all(|row| row.id != id), "{id} is no row");
    }
    let text = markdown(&FIGURES);
    let (_, list) = text.split_once("## Definitions").expect("a list of them");
    let (list, _) = list.split_once("\n## ").expect("what follows");
    assert!(!list.contains("| met |") && !list.contains("missed"));
    assert_eq!(list.matches("\n| ").count(), FIGURES.definitions.len() + 1);
}

#[test]
fn statements_of_the_paper_without_numbers_are_listed() {
    assert!(FIGURES.shown.len() >= 7);
    for shown in &FIGURES.shown {
        assert!(shown.holds, "{shown:?}");
    }
}

#[test]
fn missed_rows_are_called_missed() {
    let text = markdown(&FIGURES);
    let missed = FIGURES.figures.iter().filter(|row| !row.is_met).count();
    assert_eq!(text.matches(" **missed** |").count(), missed);
    assert_eq!(text.contains("## Missed"), missed > 0);
}

#[test]
fn the_document_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/volumetric.md");
    let kept = std::fs::read_to_string(path).expect("it is there");
    assert!(kept == markdown(&FIGURES), "stale: run `pxpl5 figures --group volumetric --write docs/volumetric.md`");
}

/// Checks the drawings of figures 4 to 12. The enlarged volumes have more pixels in the colour of slice 1 than the
/// exact one. The tapered volume has fewer at the rim.
#[test]
fn the_drawings_agree_with_their_captions() {
    let drawn = drawings(&builtin("mig").expect("built in"), &Threads::all()).expect("valid");
    let numbers: Vec<u32> = drawn.iter().map(|drawing| drawing.number).collect();
    assert_eq!(numbers, [4, 5, 6, 7, 8, 9, 10, 11, 12]);
    let of_slice = |number: u32| {
        let drawing = drawn.iter().find(|drawing| drawing.number == number).expect("drawn");
        let own = drawing.picture.pixels().filter(|pixel| [[240, 200, 80], [255; 3]].contains(&pixel.0));
        own.count()
    };
    assert!(of_slice(4) < of_slice(8) && of_slice(8) < of_slice(7));
    assert!(of_slice(4) < of_slice(6) && of_slice(6) < of_slice(7));
    assert_eq!(FigureDrawing::sheet(&drawn).dimensions(), (3 * 260, 3 * 260));
}
