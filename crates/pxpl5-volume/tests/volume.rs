//! Tests of volumes and their reports on small displays: counts from formulas, and pixels of pictures.

use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::PathSettings;
use pxpl5_volume::compare::{ComparePoint, compare, variant_count};
use pxpl5_volume::pictures::{before_and_after, coloured, halftoned, sheet, tile_map};
use pxpl5_volume::spatialgl::{OneThread, Strobes, Threads};
use pxpl5_volume::{ProjectionKind, Volume, VolumeSettings};
use serde_json::Value;

/// Returns settings for 36 slices of 128 x 96 pixels.
fn small() -> VolumeSettings {
    let mut settings = VolumeSettings::paper();
    settings.display.slices = 36;
    settings.display.width = 128;
    settings.display.height = 96;
    settings
}

fn mig() -> Scene {
    builtin("mig").expect("built in")
}

fn drawn(settings: &VolumeSettings) -> Volume {
    Volume::draw(settings, &mig(), &OneThread).expect("valid")
}

/// Fields that every report must have.
const FIELDS: &str = "display clip projection seed renderer triangles slices_rendered passes draws draws_unbinned \
    bin_memberships fragments_generated fragments_accepted slices_empty tiles_occupied tile_occupancy_percent \
    queries stencil_clears bytes_unpacked bytes_packed bytes_sent waste_percent lit_voxels connected_percent \
    brightness_by_radius dead_zone_radius_px innermost_lit_px model_ms volumes_hz_serial volumes_hz_overlapped \
    outside_volume volume_hash overrides beyond_paper host_seconds";

#[test]
fn the_report_has_every_field_of_the_specification() {
    let report = serde_json::to_value(drawn(&small()).report()).expect("JSON");
    assert_eq!(report["schema"], "pxpl5-volume/1");
    for field in FIELDS.split(' ') {
        assert!(report.get(field).is_some(), "{field} is missing");
    }
    for part in ["cpu", "gpu", "bus"] {
        assert!(report["model_ms"][part]["ms"].as_f64() > Some(0.0));
        assert!(report["model_ms"][part]["definition"].as_str().is_some_and(|text| text.len() > 20));
    }
}

/// Checks the counts of 36 slices of 128 x 96 pixels. A pixel takes 4 bytes, or half a byte packed. There are 4 x 3
/// tiles of 32 px in 9 batches.
#[test]
fn counts_follow_from_the_display() {
    let report = drawn(&small()).report();
    assert_eq!(report.bytes_unpacked, 36 * 128 * 96 * 4);
    assert_eq!(report.bytes_packed, 36 * 128 * 96 / 2);
    assert!((report.waste_percent - 90.625).abs() < 1e-9);
    assert_eq!((report.queries, report.stencil_clears), (9 * 12, 9));
    // A packed tile has 32 x 32 / 2 bytes in each of 4 slices. The map of 12 tiles has 2 bytes.
    assert_eq!(report.bytes_sent, report.tiles_occupied * 4 * 512 + 9 * 2);
    assert_eq!(report.draws_unbinned, 36 * report.triangles);
    let rings: u64 = report.brightness_by_radius.lit_voxels.iter().sum();
    assert_eq!(rings, report.lit_voxels);
    assert!(report.beyond_paper.is_empty());
}

#[test]
fn mirrored_and_connected_volumes_are_marked_as_beyond_the_paper() {
    let mut settings = small();
    settings.set("draw.strobes", "mirror", "test").expect("valid");
    settings.set("draw.coverage", "connected", "test").expect("valid");
    let report = drawn(&settings).report();
    assert_eq!(report.beyond_paper, ["connected coverage", "mirrored strobes"]);
    assert_eq!(report.slices_rendered, 18);
    assert!(report.connected_percent > 99.999);
    assert!((report.waste_percent - 90.625).abs() < 1e-9);
}

#[test]
fn an_empty_scene_is_a_dark_volume() {
    let commands = pxpl5_volume::spatialgl::CommandBuffer::default();
    let volume = Volume::draw_commands(&small(), "nothing", commands, &OneThread).expect("valid");
    let report = volume.report();
    assert_eq!((report.lit_voxels, report.tiles_occupied, report.innermost_lit_px), (0, 0, None));
    assert_eq!(report.dead_zone_radius_px, Some(0), "exact planes can show any column");
    assert_eq!(report.slices_empty, 36);
}

#[test]
fn the_hash_depends_on_the_seed_and_not_on_threads() {
    let hash = |settings: &VolumeSettings| drawn(settings).report().volume_hash;
    let other = VolumeSettings { seed: 2, ..small() };
    let threads = Volume::draw(&small(), &mig(), &Threads::all()).expect("valid").report().volume_hash;
    assert_eq!(hash(&small()), threads);
    assert_ne!(hash(&small()), hash(&other));
}

/// Checks that the pixels of pictures equal the bit planes and the colours. Mirrored slices are shown reversed.
#[test]
fn the_pixels_of_a_slice_picture_equal_the_bit_planes_and_the_colours() {
    for strobes in [Strobes::Each, Strobes::Mirror] {
        let settings = VolumeSettings { strobes, projection: ProjectionKind::Orthographic, ..small() };
        let volume = drawn(&settings);
        for slice in [0, 7, 17, 18, 35] {
            let after = halftoned(&volume, slice);
            let before = coloured(&volume, slice);
            let mut lit = 0;
            for (x, y, pixel) in after.enumerate_pixels() {
                let bits = volume.frame.planes.pixel(slice, x, y);
                assert_eq!(pixel.0, [0, 1, 2].map(|c| 255 * (bits >> c & 1)));
                let is_lit = bits != 0;
                lit += u32::from(is_lit);
                assert!(
                    !is_lit || before.get_pixel(x, y).0 != [0; 3],
                    "slice {slice}: lit at {x}, {y} without a colour"
                );
            }
            assert!(lit > 0 || slice == 0, "slice {slice} is dark");
        }
        let both = before_and_after(&volume, 7);
        assert_eq!(both.dimensions(), (256, 96));
    }
}

/// Checks that a sheet has rows of 22 thumbnails of 64 px. The number of white pixels of a tile map must equal the
/// number of occupied tiles.
#[test]
fn a_sheet_has_a_thumbnail_for_each_slice_and_a_map_marks_each_occupied_tile() {
    let volume = drawn(&small());
    assert_eq!(sheet(&volume).dimensions(), (22 * 64, 2 * 64));
    let map = tile_map(&volume).expect("there are tiles");
    let white = map.pixels().filter(|pixel| pixel.0 == [255; 3]).count() as u64;
    assert_eq!(white, 9 * volume.frame.stats.tiles_occupied, "3 x 3 pixels a tile");
    let mut settings = small();
    settings.set("tile.size", "0", "test").expect("valid");
    assert!(tile_map(&drawn(&settings)).is_none());
}

#[test]
fn a_missing_slice_is_refused() {
    let volume = drawn(&small());
    assert_eq!(volume.check_slice(35), Ok(35));
    let error = volume.check_slice(36).expect_err("36 slices");
    assert_eq!(error.to_string(), "slice: expected 0 to 35, found 36");
}

struct Steps(Vec<(u64, u64)>);

impl Watcher for Steps {
    fn progress(&mut self, done: u64, of: u64) {
        self.0.push((done, of));
    }
}

/// Checks the variants of a comparison: six clips with three projections, and three further variants. Passes are as
/// published (P5), and clips with enlarged volumes accept at least as many fragments.
#[test]
fn a_comparison_has_a_row_and_a_picture_for_each_variant() {
    let viewpoint = ComparePoint { azimuth_deg: 40.0, elevation_deg: 25.0, side: 32 };
    let mut steps = Steps(Vec::new());
    let comparison = compare(&small(), &mig(), Some(viewpoint), &OneThread, &mut steps).expect("valid");
    assert_eq!(comparison.variants.len() as u64, variant_count());
    assert_eq!(steps.0, (1..=21).map(|done| (done, 21)).collect::<Vec<_>>());
    assert_eq!(comparison.pictures.len(), 21);
    let passes: Vec<u64> = comparison.variants.iter().step_by(3).take(6).map(|row| row.passes).collect();
    assert_eq!(passes, [1, 2, 1, 2, 1, 1]);
    let of = |clip: &str, projection: &str| {
        comparison
            .variants
            .iter()
            .find(|row| row.clip.starts_with(clip) && row.projection == projection)
            .expect("a row")
    };
    for projection in ["orthographic", "perspective", "jittered"] {
        let exact = of("exact", projection).fragments_accepted;
        let hyperbola = of("hyperbolic", projection).fragments_accepted;
        let parallel = of("parallel", projection).fragments_accepted;
        let prism = of("prism", projection).fragments_accepted;
        assert!(exact < hyperbola && hyperbola < parallel && parallel < prism);
        assert!(of("exact", projection).brightness_over_exact.iter().flatten().all(|ratio| *ratio == 1.0));
    }
    assert_eq!(comparison.clips_and_projections().expect("pictures").dimensions(), (3 * 32, 6 * 32));
    assert_eq!(comparison.samples_and_coverage().expect("pictures").dimensions(), (5 * 32, 32));
    let json: Value = serde_json::to_value(&comparison).expect("JSON");
    assert_eq!(json["schema"], "pxpl5-volume-comparison/1");
    assert_eq!(json["variants"][20]["beyond_paper"][0], "connected coverage");
}
