//! Tests of the papers' figures: fitted numbers, checked numbers, and the generated document.

use pxpl5_arp::figures::{Experiments, RATE_FITTED, RATES_HZ, Rules, Situation, all, definitions, markdown, verdict};
use pxpl5_arp::pictures::{ArpPicture, OF_FIGURES, all as all_pictures};
use pxpl5_sim::figures::{Basis, FigureRow};
use std::collections::BTreeSet;
use std::sync::LazyLock;

static FIGURES: LazyLock<(Experiments, Vec<FigureRow>)> = LazyLock::new(|| all().expect("experiments"));

fn rows(id: &str) -> Vec<&'static FigureRow> {
    FIGURES.1.iter().filter(|row| row.id == id).collect()
}

#[test]
fn the_side_of_a_cell_is_fitted_to_memory_1_and_the_threshold_to_the_width_of_tears() {
    let fitted: Vec<&FigureRow> = FIGURES.1.iter().filter(|row| matches!(row.basis, Basis::Fitted(_))).collect();
    assert_eq!(fitted.iter().map(|row| row.id).collect::<Vec<_>>(), ["A12", "A15"]);
    assert_eq!(fitted[0].published, RATES_HZ[RATE_FITTED]);
    assert!(fitted.iter().all(|row| row.is_met), "{fitted:?}");
}

#[test]
fn table_1_rates_never_rise_with_the_number_of_the_memory_and_memory_0_has_60_hz() {
    let tried = FIGURES.0.interpretations.ranked.iter().flat_map(|ranked| &ranked.tried);
    let all =
        tried.map(|tried| tried.best.rates_hz.to_vec()).chain(FIGURES.0.fits.iter().map(|fit| fit.rates_hz.clone()));
    for rates in all {
        // In a small hall, a memory may have no content, and then it is never drawn.
        assert!((rates[0] - 60.0).abs() < 1e-9, "{rates:?}");
        assert!(rates.windows(2).all(|pair| pair[0] >= pair[1]), "{rates:?}");
    }
}

/// The default rules predict a left-out rate best: the rings of memory 0 and of the others are fitted to two of three rates
/// and predict the third one.
///
/// Compares also with an independent program for the policy, which gave 40.6, 25.7 and 16.0 Hz, with an error of 5.5 %.
/// Its rules were equal rings, distances to occupied cells, and a straight walk through the middle of seven cells. With
/// doubling rings, and distances to the border of a block of cells, its errors were 4.7 to 6.4 % in all halls.
#[test]
fn the_default_rules_have_the_smallest_error_of_prediction() {
    let ranked = &FIGURES.0.interpretations.ranked;
    let of = |rules: Rules| ranked.iter().find(|ranked| ranked.rules == rules).expect("all are run");
    let double = Rules { inner_rings: 1, ring_growth: 2, has_cascade: false, ..Rules::USUAL };
    assert!((4.0..7.0).contains(&of(double).mean_error_percent), "{:?}", of(double));
    let least = ranked.iter().map(|ranked| ranked.mean_left_out_percent).fold(f64::INFINITY, f64::min);
    assert_eq!(of(Rules::USUAL).mean_left_out_percent, least);
    assert!(2.0 * least < of(double).mean_left_out_percent);
    assert_eq!(FIGURES.0.interpretations.usual().map(|(place, _)| place), Some(1));
    let held = of(Rules { to_held_cells: true, ..Rules { ring_growth: 1, ..double } });
    let straight = held.tried.iter().find(|tried| tried.situation == Situation::Straight).expect("run");
    let expected = [40.6, 25.7, 16.0];
    let rates = straight.best.rates_hz;
    assert!(
        expected.iter().zip(&rates[1..]).all(|(expected, found)| (found / expected - 1.0).abs() < 0.05),
        "{rates:?}"
    );
}

/// Checks that memory 1 is drawn as often as memory 0 if memory 0 holds only the user's cell.
#[test]
fn table_1_without_inner_rings_has_an_error_above_25_percent() {
    let ranked = &FIGURES.0.interpretations.ranked;
    let outside = ranked.iter().filter(|ranked| ranked.rules.inner_rings == 0);
    assert!(outside.clone().count() == 4 && outside.clone().all(|ranked| ranked.mean_error_percent > 25.0));
}

/// Checks predictions of three update rates. Each rate is left out once, and the rules are then chosen by the other two
/// rates.
#[test]
fn each_omitted_rate_is_predicted_by_the_rules_that_fit_the_other_two_rates_best() {
    let left_out = &FIGURES.0.interpretations.left_out;
    assert_eq!(left_out.iter().map(|one| one.memory).collect::<Vec<_>>(), [1, 2, 3]);
    for one in left_out {
        let others: Vec<usize> = [1, 2, 3].into_iter().filter(|memory| *memory != one.memory).collect();
        let all = FIGURES.0.interpretations.ranked.iter().flat_map(|ranked| &ranked.tried);
        let least = all.flat_map(|tried| &tried.trials).map(|trial| trial.error_percent(&others));
        assert_eq!(one.trial.error_percent(&others), least.fold(f64::INFINITY, f64::min));
    }
}

/// Checks that 2 texels are 3.75 pixels, and that one texel is 1.875 pixels.
///
/// The nearest border is one cell side away. If the update of a memory is late by a frame of 16.7 mm, its tears grow by
/// the angle of this distance.
#[test]
fn a_threshold_in_pixels_gives_the_side_of_a_cell() {
    let rows = &FIGURES.0.thresholds;
    let row = |name: &str| rows.iter().find(|row| row.threshold == name).expect("listed");
    assert!((row("2 texels").at_once_px - 3.75).abs() < 1e-9 && (row("1 texel").at_once_px - 1.875).abs() < 1e-9);
    for row in rows {
        let late = (1.0 / 60.0 / row.cell_m).to_degrees() / 0.09375;
        assert!((row.frame_late_px - row.at_once_px - late).abs() < 1e-9, "{row:?}");
    }
    assert!((row("1 texel").cell_m / row("2 texels").cell_m - 2.0).abs() < 1e-9);
}

/// Checks the limits: the tangent of the sphere's angular radius is 1/2, 1 and 2. The diameters are 2 sin(atan(x))
/// times the distance.
///
/// The default rule measures the eye's movement by its chord. This rule makes the diameters smaller by a fraction of
/// theta.
#[test]
fn a8_the_published_limit_lies_between_the_limits_of_two_definitions() {
    let expected = [0.5_f64, 1.0, 2.0].map(|tangent| {
        let sine = tangent.atan().sin();
        [2.0 * sine, 2.0 * sine / (1.0 - sine)]
    });
    for (limit, [middle, nearest]) in FIGURES.0.size_limits.iter().zip(expected) {
        assert!((limit.of_middle / middle - 1.0).abs() < 0.01, "{limit:?} {middle}");
        assert!((limit.of_nearest / nearest - 1.0).abs() < 0.03, "{limit:?} {nearest}");
    }
    let row = rows("A8")[0];
    assert!(row.is_met && verdict(row) == "within" && (4.6..5.0).contains(&row.simulated), "{row:?}");
}

#[test]
fn table_2_cutting_moves_segments_outwards_and_saves_draws() {
    let [cut, uncut] =
        [rows("A13"), rows("A14")].map(|rows| rows.iter().map(|row| row.simulated).collect::<Vec<f64>>());
    assert!(cut[0] < uncut[0] && cut[3] > uncut[3], "{cut:?} {uncut:?}");
    assert!((cut.iter().sum::<f64>() - uncut.iter().sum::<f64>()).abs() < 1e-6, "nothing is lost");
}

/// Checks that the definitions D1 to D5 equal the values that were computed by hand.
#[test]
fn definitions_are_derived_numbers_and_not_rows_of_results() {
    let all = definitions();
    let values = |id: &str| all.iter().filter(|one| one.id == id).map(|one| one.value).collect::<Vec<f64>>();
    let near = |id: &str, expected: &[f64]| {
        let found = values(id);
        let is_near = |(found, expected): (&f64, &f64)| (found - expected).abs() <= 1e-3 * expected.abs();
        assert!(found.len() == expected.len() && found.iter().zip(expected).all(is_near), "{id}: {found:?}");
    };
    near("D1", &[1.0, 16.67, 1.529, 25.48, 2.127, 35.45, 3.715, 61.92]);
    near("D2", &[183.0, 213.0]);
    near("D3", &[7_335.0, 10_676.93, 31.3]);
    near("D4", &[33.197, 16.456]);
    near("D5", &[45.6]);
    near("A17", &[0.65]);
    assert!(["D1", "D2"].iter().all(|id| rows(id).is_empty()), "a row could have come out otherwise");
}

#[test]
fn point_objects_are_drawn_6_and_13_times_less_often() {
    // The factor is 1 / (p0 + p1 / 2 + p2 / 4 + p3 / 8). p follows from the squares of 10.8650, 21.7300 and 43.4599 m
    // over 100 m.
    let borders = [10.8650_f64, 21.7300, 43.4599].map(|metres| (metres / 100.0).powi(2));
    let mean =
        borders[0] + (borders[1] - borders[0]) / 2.0 + (borders[2] - borders[1]) / 4.0 + (1.0 - borders[2]) / 8.0;
    assert!((FIGURES.0.reductions[0] * mean - 1.0).abs() < 2e-3, "{:?}", FIGURES.0.reductions);
    assert!((FIGURES.0.reductions[1] - 13.40).abs() < 0.03);
}

#[test]
fn a_straight_edge_bends_on_the_screen_and_is_straight_through_the_lens() {
    let [screen, eye] = FIGURES.0.lens_px;
    assert!(screen > 10.0 && eye < 1.0, "{screen} {eye}");
}

#[test]
fn every_experiment_has_a_row_and_every_listed_picture_is_drawn() {
    let experiments: BTreeSet<&str> = FIGURES.1.iter().map(|row| row.experiment).collect();
    assert_eq!(experiments.into_iter().collect::<Vec<_>>(), ["E1", "E2", "E3", "E4", "E5", "E6", "E7", "E8", "E9"]);
    let pictures = all_pictures(&FIGURES.0).expect("drawn");
    let names: BTreeSet<&str> = pictures
        .iter()
        .map(|picture| match picture {
            ArpPicture::Pixels(name, _) | ArpPicture::Drawing(name, _) => name.as_str(),
        })
        .collect();
    for (experiment, _, expected) in OF_FIGURES {
        assert!(expected.iter().all(|name| names.contains(name)), "{experiment}: {names:?}");
    }
}

#[test]
fn pictures_of_equal_content_are_equal_bit_for_bit() {
    assert_eq!((FIGURES.0.composite_differs, FIGURES.0.turned_differ), (0, 0));
}

#[test]
fn the_document_is_fresh() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/address-recalculation.md");
    let kept = std::fs::read_to_string(path).expect("docs/address-recalculation.md");
    let how = "stale: run `pxpl5 figures --group address-recalculation --write docs/address-recalculation.md`";
    assert!(kept == markdown(&FIGURES.0, &FIGURES.1), "{how}");
}
