//! Sets and reads the settings of a volume by a path, such as `clip.variant`.

use crate::choices::{ClipKind, ProjectionKind, RendererKind};
use crate::settings::VolumeSettings;
use pxpl5_sim::parameters::{Choice, PathSettings, SettingError, choose, tables_at};
use spatialgl::{BinTolerance, Binning, Combine, Coverage, Rotation, Strobes, TieRule};

impl PathSettings for VolumeSettings {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { path: "on", set: |all, text| choose(&mut all.renderer, &RendererKind::ALL, text) },
        Choice { path: "clip.variant", set: Self::set_clip },
        Choice { path: "clip.ties", set: |all, text| choose(&mut all.ties, &TieRule::ALL, text) },
        Choice { path: "projection", set: |all, text| choose(&mut all.projection, &ProjectionKind::ALL, text) },
        Choice { path: "seed", set: |all, text| whole(&mut all.seed, text) },
        Choice { path: "bins.planes", set: |all, text| choose(&mut all.binning, &Binning::ALL, text) },
        Choice { path: "bins.tolerance", set: Self::set_tolerance },
        Choice { path: "draw.coverage", set: |all, text| choose(&mut all.coverage, &Coverage::ALL, text) },
        Choice { path: "draw.strobes", set: |all, text| choose(&mut all.strobes, &Strobes::ALL, text) },
        Choice { path: "draw.combine", set: |all, text| choose(&mut all.combine, &Combine::ALL, text) },
        Choice {
            path: "draw.lit",
            set: |all, text| choose(&mut all.is_lit, &[("true", true), ("false", false)], text),
        },
        Choice { path: "display.rotation", set: |all, text| choose(&mut all.rotation, &Rotation::ALL, text) },
    ];

    tables_at! {
        "display": display,
        "display": sweep,
        "clip": clip_numbers,
        "jitter": jitter,
        "eye": eye,
        "tile": tile,
        "draw": draw,
        "gpu": gpu,
        "viewer": viewer,
    }
}

impl VolumeSettings {
    /// Parses a clip as `NAME` or `NAME:NUMBER`. The number is the clip's offset or bias.
    fn set_clip(&mut self, text: &str) -> Result<(), SettingError> {
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => (name, Some(number)),
            None => (text, None),
        };
        let clip: ClipKind = name.parse()?;
        // Only some clips have a number, and the number belongs to one of two settings.
        let own = match clip {
            ClipKind::Tapered | ClipKind::Parallel => Some(&mut self.clip_numbers.offset_px),
            ClipKind::Hyperbolic => Some(&mut self.clip_numbers.bias_px2),
            _ => None,
        };
        match (own, number) {
            (Some(own), Some(number)) => {
                *own = number.parse().map_err(|_| SettingError::text(format_args!("a number after {name}:"), text))?;
            }
            (None, Some(_)) => return Err(SettingError::text(format_args!("{name} without a number"), text)),
            (_, None) => {}
        }
        self.clip = clip;
        Ok(())
    }

    /// Parses the tolerance of bins: `clip`, `codes` or a number of pixels.
    fn set_tolerance(&mut self, text: &str) -> Result<(), SettingError> {
        if let Ok(pixels) = text.parse::<f64>()
            && pixels.is_finite()
            && pixels >= 0.0
        {
            self.bin_tolerance = BinTolerance::Pixels(pixels);
            return Ok(());
        }
        choose(&mut self.bin_tolerance, &BinTolerance::ALL, text)
            .map_err(|_| SettingError::text("clip, codes or a number of pixels from 0 on", text))
    }
}

fn whole(number: &mut u64, text: &str) -> Result<(), SettingError> {
    *number = text.parse().map_err(|_| SettingError::text("a whole number of 0 to 2^64 - 1", text))?;
    Ok(())
}
