//! Public names: each is read as it is written, and an unknown name has an error with the valid names.

use pxpl5::arp::address_recalculation::{Latch, Lens};
use pxpl5::firmware::{Culling, Stage, StageEdge};
use pxpl5::run::FacePolicy;
use pxpl5::tracking::motion::{Axes, Columns, End};
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::{
    Aim, Board, Cause, Code, CodeVersion, CopySchedule, DisplayEntry, Every, Eye, Fingerprint, FinishedRegions,
    HeadPlace, KeptRecords, Level, Measure, Optimization, PRESETS, PipelineEntry, Pixels, Provenance, QUANTITIES,
    Raster, RegionBinning, Registry, Reprojection, Resource, SettingError, SlatsLighting, TestScene, TraceHash, Warp,
};
use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::{Debug, Display};
use std::str::FromStr;

/// Checks that each value is read from the text that it writes, that no two values have the same text, and that other
/// texts are errors.
fn round_trip<T>(values: impl IntoIterator<Item = T>)
where
    T: Display + FromStr<Err: Error> + PartialEq + Debug,
{
    let mut names = BTreeSet::new();
    for value in values {
        let name = value.to_string();
        assert!(!name.is_empty() && names.insert(name.clone()), "{value:?}: {name:?} is empty or taken");
        assert_eq!(name.parse::<T>().unwrap_or_else(|error| panic!("{name}: {error}")), value);
        // Only the complete name is accepted.
        for other in [format!("{name}x"), format!(" {name}"), String::new()] {
            let error = other.parse::<T>().expect_err("no name");
            assert!(!error.to_string().is_empty());
        }
    }
    assert!(!names.is_empty());
}

/// Checks names of a list of pairs: the name in the list is the text of the value.
fn listed<T>(pairs: impl IntoIterator<Item = (&'static str, T)>)
where
    T: Display + FromStr<Err = SettingError> + PartialEq + Debug,
{
    let pairs: Vec<_> = pairs.into_iter().collect();
    pairs.iter().for_each(|(name, value)| assert_eq!(*name, value.to_string()));
    round_trip(pairs.into_iter().map(|(_, value)| value));
}

#[test]
fn every_public_name_is_parsed_as_printed() {
    // Names in settings of experiments.
    round_trip(Level::ALL);
    listed(Pixels::ALL);
    listed(KeptRecords::ALL);
    round_trip(Optimization::ALL);
    round_trip(TestScene::ALL);
    listed(Aim::ALL);
    listed(HeadPlace::ALL);
    round_trip(Cause::ALL);
    // Names in settings of pipelines.
    listed(CopySchedule::ALL);
    listed(RegionBinning::ALL);
    listed(SlatsLighting::ALL);
    listed(Code::ALL);
    round_trip(FinishedRegions::ALL);
    listed(FacePolicy::ALL);
    listed(Culling::ALL);
    // Names of boards and machines.
    round_trip([Board::Host, Board::Gp(12), Board::Renderer(0), Board::Display(1), Board::Ring]);
    round_trip(PRESETS);
    round_trip(CodeVersion::ALL);
    listed(Latch::ALL);
    round_trip(Eye::BOTH);
    // Names of devices after the frame buffer.
    listed(Warp::ALL);
    listed(Every::ALL);
    let devices = Warp::ALL.into_iter().flat_map(|(_, by)| Every::ALL.map(|(_, every)| Reprojection::new(by, every)));
    round_trip(devices.clone());
    round_trip(devices.map(Raster::Reprojected).chain([Raster::Plain, Raster::Vdrt]));
    // Names of heads and trackers.
    round_trip(PredictorKind::ALL);
    listed(End::NAMES);
    listed(Axes::NAMES);
    let lenses = [Lens::Flat, Lens::Equidistant, Lens::Radial { k1: 0.25, k2: -1.0 / 3.0 }];
    for lens in lenses {
        assert_eq!(lens.to_string().parse::<Lens>().expect("as written"), lens);
    }
    let columns: Columns = "t_ns=stamp,x=px".parse().expect("a mapping");
    assert_eq!(columns.to_string(), "t_ns=stamp,x=px");
    // Names of results.
    round_trip(QUANTITIES.iter().map(|quantity| Measure::named(quantity.name).expect("listed")));
    round_trip(Resource::ALL);
    listed(Stage::ALL);
    listed(StageEdge::ALL);
    listed(Provenance::ALL);
    assert_eq!("00f0".parse::<TraceHash>().map(|hash| hash.to_string()), Ok("00000000000000f0".to_owned()));
    let hash = Fingerprint::of(b"a");
    assert_eq!(hash.to_string().parse(), Ok(hash));
}

#[test]
fn every_pipeline_and_display_of_the_papers_is_found_by_its_name() {
    let registry = Registry::of_papers();
    for entry in registry.pipelines() {
        assert_eq!(entry.to_string().parse::<PipelineEntry>().expect("listed").name, entry.name);
    }
    for entry in registry.displays() {
        assert_eq!(entry.to_string().parse::<DisplayEntry>().expect("listed").name, entry.name);
    }
    let error = "slat".parse::<PipelineEntry>().map(|entry| entry.name).expect_err("no pipeline").to_string();
    assert_eq!(error, "there is no pipeline `slat`; did you mean `slats`?");
    let error = registry.display("ntcs").map(|entry| entry.name).expect_err("no display").to_string();
    assert_eq!(
        error,
        "there is no display `ntcs`; did you mean `ntsc`? (expected ntsc, hires, oled-90, lcd-120, panel or arp)"
    );
}

#[test]
fn every_choice_of_volumes_is_parsed_as_printed() {
    use pxpl5::volume::spatialgl::{BinTolerance, Binning, Combine, Coverage, Rotation, Strobes, TieRule};
    listed(TieRule::ALL);
    listed(Binning::ALL);
    listed(BinTolerance::ALL);
    listed(Coverage::ALL);
    listed(Strobes::ALL);
    listed(Combine::ALL);
    listed(Rotation::ALL);
}
