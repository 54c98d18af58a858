//! Reader of a raster, which is the correction that a display applies to pictures during the scan. The raster is plain
//! (no correction), the raster offset of VDRT, or a device that moves pictures.

use super::ExperimentFile;
use super::read::{not_applicable, wrong};
use pxpl5_run::{Coverage, Every, Pipeline, Raster, Reprojection, Warp};
use pxpl5_sim::parameters::SettingError;
use toml::Value;

/// Key of the part of a scan (a field, a strip or a line) for which a device that moves pictures uses a new pose.
pub(super) const EVERY: &str = "head.reprojection.every";
pub(super) const LATENCY: &str = "head.reprojection.latency_us";

const RASTER: &str = "head.raster";

/// A value of the key `head.raster`: a raster without parameters, or a device that moves pictures.
#[derive(Clone, Copy)]
enum Named {
    Raster(Raster),
    Device(Warp),
}

/// Reads the raster (the correction of pictures during the scan). A raster offset requires a pipeline in which each
/// picture has one head pose.
pub(super) fn read(file: &ExperimentFile, pipeline: &dyn Pipeline) -> Result<Raster, SettingError> {
    let plain = Raster::ALL.map(|(name, raster)| (name, Named::Raster(raster)));
    let devices = Warp::ALL.map(|(name, by)| (name, Named::Device(by)));
    let names: Vec<(&str, Named)> = plain.into_iter().chain(devices).collect();
    let named = file.choice(RASTER, &names)?.unwrap_or(Named::Raster(Raster::Plain));
    // The error names the key with its value, because other values of the key are valid.
    let refused = |applies_to: &str| {
        let place = file.get(RASTER).map(|setting| setting.place.clone()).unwrap_or_default();
        let key =
            format!("{RASTER} = {}", file.get(RASTER).map(|it| super::read::plain(&it.value)).unwrap_or_default());
        Err(not_applicable(&key, pipeline.name(), applies_to).at(place))
    };
    match named {
        Named::Raster(Raster::Vdrt) if !pipeline.properties().has_one_pose => {
            refused("rendering-control, slats and jitp-field, whose pictures are of one pose")
        }
        Named::Device(Warp::Depth) if pipeline.properties().coverage == Coverage::Surroundings => refused(
            "pipelines whose pictures are of one eye; faces around the head are several pictures, of which the turn is left: rotation",
        ),
        Named::Raster(raster) => {
            // Numbers of a device have no effect without a device.
            refuse_numbers(file)?;
            Ok(raster)
        }
        Named::Device(by) => {
            let every = file.choice(EVERY, &Every::ALL)?.unwrap_or(Every::Field);
            let latency_us = file.whole(LATENCY)?.unwrap_or(every.usual_latency_us());
            Ok(Raster::Reprojected(Reprojection { by, every, latency_us }))
        }
    }
}

/// Returns an error if the file sets a parameter of a device that moves pictures, but selects no such device.
fn refuse_numbers(file: &ExperimentFile) -> Result<(), SettingError> {
    for key in [EVERY, LATENCY] {
        if let Some(setting) = file.get(key) {
            return Err(wrong(key, setting, "nothing: head.raster is no shift, rotation or depth"));
        }
    }
    Ok(())
}

pub(super) fn settings(raster: Raster) -> Vec<(String, Value)> {
    let Raster::Reprojected(Reprojection { by, every, latency_us }) = raster else {
        return vec![(RASTER.to_owned(), Value::from(raster.to_string()))];
    };
    let name = |(name, _): &(&'static str, _)| *name;
    let by = Warp::ALL.iter().find(|(_, candidate)| *candidate == by).map_or("", name);
    let every = Every::ALL.iter().find(|(_, candidate)| *candidate == every).map_or("", |(name, _)| name);
    vec![
        (RASTER.to_owned(), Value::from(by)),
        (EVERY.to_owned(), Value::from(every)),
        (LATENCY.to_owned(), Value::from(latency_us as i64)),
    ]
}
