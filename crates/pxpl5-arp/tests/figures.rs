//! The papers' figures: which are fitted, which are checked, and that the document says what comes out.

use pxpl5_arp::figures::{Experiments, RATE_FITTED, RATES_HZ, Row, Standing, all, markdown};
use pxpl5_arp::pictures::{OF_FIGURES, Picture, all as all_pictures};
use std::collections::BTreeSet;
use std::sync::LazyLock;

static FIGURES: LazyLock<(Experiments, Vec<Row>)> = LazyLock::new(|| all().expect("experiments"));

fn rows(id: &str) -> Vec<&'static Row> {
    FIGURES.1.iter().filter(|row| row.id == id).collect()
}

#[test]
fn table_1_the_side_of_a_cell_is_fitted_to_memory_1_and_to_nothing_else() {
    let fitted: Vec<&Row> = FIGURES.1.iter().filter(|row| row.standing == Standing::Fitted).collect();
    assert_eq!(fitted.len(), 1);
    assert_eq!((fitted[0].id, fitted[0].published), ("A12", RATES_HZ[RATE_FITTED]));
    assert!(fitted[0].is_met, "{fitted:?}");
}

#[test]
fn table_1_checked_rates_fall_from_memory_to_memory_and_memory_0_is_drawn_in_every_frame() {
    for fit in &FIGURES.0.fits {
        assert_eq!(fit.rates_hz[0], 60.0, "{fit:?}");
        assert!(fit.rates_hz.windows(2).all(|pair| pair[0] >= pair[1]), "{fit:?}");
    }
}

#[test]
fn table_1_with_no_inner_rings_the_third_rate_is_out_by_more_than_with_one() {
    // The specification excludes q = 0: its second rate is as fast as its first.
    let error = |fit: usize| (FIGURES.0.fits[fit].rates_hz[2] / RATES_HZ[2] - 1.0).abs();
    assert!(error(0) > error(1), "{:?}", FIGURES.0.fits);
}

#[test]
fn table_2_cutting_moves_segments_outwards_and_saves() {
    let [cut, uncut] = [rows("A13"), rows("A14")].map(|rows| rows.iter().map(|row| row.ours).collect::<Vec<f64>>());
    assert!(cut[0] < uncut[0] && cut[3] > uncut[3], "{cut:?} {uncut:?}");
    assert!((cut.iter().sum::<f64>() - uncut.iter().sum::<f64>()).abs() < 1e-6, "nothing is lost");
}

#[test]
fn what_the_tables_print_gives_the_derived_numbers() {
    assert!(FIGURES.1.iter().filter(|row| row.standing == Standing::Formula).all(|row| row.is_met));
}

#[test]
fn point_objects_are_drawn_6_and_13_times_less_often_as_computed_by_hand() {
    // 1 / (p0 + p1 / 2 + p2 / 4 + p3 / 8), p from the squares of 10.8650, 21.7300 and 43.4599 m over 100 m.
    let borders = [10.8650_f64, 21.7300, 43.4599].map(|metres| (metres / 100.0).powi(2));
    let mean =
        borders[0] + (borders[1] - borders[0]) / 2.0 + (borders[2] - borders[1]) / 4.0 + (1.0 - borders[2]) / 8.0;
    assert!((FIGURES.0.reductions[0] * mean - 1.0).abs() < 2e-3, "{:?}", FIGURES.0.reductions);
    assert!((FIGURES.0.reductions[1] - 13.40).abs() < 0.03);
}

#[test]
fn size_decides_with_the_sphere_from_1_41_on_and_never_with_the_disc() {
    for row in &FIGURES.0.sizes {
        assert!(row.size_s[0] > row.translation_s, "{row:?}");
        assert_eq!(row.size_s[1] < row.translation_s, row.size_over_distance > 1.411, "{row:?}");
    }
}

#[test]
fn a_straight_edge_bends_on_the_screen_and_is_straight_through_the_lens() {
    let [screen, eye] = FIGURES.0.lens_px;
    assert!(screen > 10.0 && eye < 1.0, "{screen} {eye}");
}

#[test]
fn slow_memories_miss_first() {
    for slowed in &FIGURES.0.slowed {
        assert!(slowed.missed.windows(2).all(|pair| pair[0] <= pair[1]), "{slowed:?}");
    }
}

#[test]
fn there_is_a_row_of_every_experiment_and_every_picture_of_the_papers_figures() {
    let experiments: BTreeSet<&str> = FIGURES.1.iter().map(|row| row.experiment).collect();
    assert_eq!(experiments.into_iter().collect::<Vec<_>>(), ["E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8", "E9"]);
    let pictures = all_pictures(&FIGURES.0).expect("drawn");
    let names: BTreeSet<&str> = pictures
        .iter()
        .map(|picture| match picture {
            Picture::Pixels(name, _) | Picture::Drawing(name, _) => name.as_str(),
        })
        .collect();
    for (experiment, _, expected) in OF_FIGURES {
        assert!(expected.iter().all(|name| names.contains(name)), "{experiment}: {names:?}");
    }
}

#[test]
fn pictures_that_must_be_the_same_are_the_same_in_every_bit() {
    assert_eq!((FIGURES.0.composite_differs, FIGURES.0.turned_differ), (0, 0));
}

#[test]
fn the_document_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/address-recalculation.md");
    let kept = std::fs::read_to_string(path).expect("docs/address-recalculation.md");
    let how = "stale: run `pxpl5 arp figures --write docs/address-recalculation.md`";
    assert!(kept == markdown(&FIGURES.0, &FIGURES.1), "{how}");
}
