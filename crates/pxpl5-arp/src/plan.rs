//! Settings of a simulated walk of the viewer through a scene. Each setting has a path such as `priority.theta_deg`.

use crate::hall::Route;
use crate::settings::{PolicyKind, SourceKind, WalkSettings};
use address_recalculation::priority::Falloff;
use address_recalculation::{ArpConfig, CompositionOrder, Latch, Lens, LensPicture};
use pxpl5_sim::parameters::{Choice, PathSettings, SettingError, choose, tables_at};
use std::collections::BTreeMap;

pxpl5_sim::parameters::parameter_table! {
    /// Speed and length of the viewer's walk.
    pub struct WalkNumbers {
        /// Walking speed along the scene's path.
        m_per_s: f64 = 1.0, "m/s", Published, 0.0..=3.0 in 0.0..=100.0, "CPR05 4.2: a walker";
        /// Length of the viewer's walk, in frames.
        frames: 1_800, "frames", Assumed, 60..=100_000 in 1..=1_000_000, "half a minute; table 1 is compared over two minutes";
        /// Factor that multiplies length and width of the scene and its path. Heights stay the same.
        hall_scale: f64 = 1.0, "1", Assumed, 0.25..=4.0 in 0.01..=100.0, "not printed; 0.5 makes the gallery 20 m wide, eight cells of 2.5 m";
    }
}

/// Settings of a walk. Each setting has a path such as `priority.theta_deg`. Some defaults depend on other settings.
///
/// A *cascade* lets an update of a memory also update all more often drawn memories. By default, walks with the
/// policy `cells` have a cascade, and only the policy `cells` cuts objects. `priority.threshold` in pixels or texels overrides
/// `priority.theta_deg`.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkPlan {
    pub walk: WalkNumbers,
    chosen: WalkSettings,
    is_segmented: Option<bool>,
    has_cascade: Option<bool>,
    threshold: Option<ThresholdChoice>,
    pub route: Route,
    /// Settings that the user gave explicitly, each with its path such as `priority.cell_m`.
    pub given: BTreeMap<String, String>,
}

/// A threshold of the image error, in pixels or texels. The threshold becomes an angle when the display's resolution is
/// set.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ThresholdChoice {
    /// Threshold in pixels of the display. One pixel is the horizontal angle of view divided by the number of pixels in
    /// a line.
    Pixels(f64),
    /// Threshold in texels of a face. One texel is 90 degrees divided by the number of texels along an edge of the
    /// face.
    Texels(f64),
}

impl ThresholdChoice {
    fn degrees(self, display: &ArpConfig) -> f64 {
        match self {
            Self::Pixels(pixels) => pixels * display.timing.horizontal_deg / display.scan.visible_pixels as f64,
            Self::Texels(texels) => texels * 90.0 / display.timing.face_texels as f64,
        }
    }
}

/// Parses a threshold of the image error, such as `2px` or `2texels`.
fn threshold(text: &str) -> Result<ThresholdChoice, SettingError> {
    let expected = || SettingError::text("pixels of the display as 2px, or texels of a face as 2texels", text);
    let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    if let Some(pixels) = text.strip_suffix("px") {
        return number(pixels).map(ThresholdChoice::Pixels).ok_or_else(expected);
    }
    let texels = text.strip_suffix("texels").or_else(|| text.strip_suffix("texel"));
    texels.and_then(number).map(ThresholdChoice::Texels).ok_or_else(expected)
}

impl PathSettings for WalkPlan {
    const CHOICES: &'static [Choice<Self>] = &[
        Choice { path: "policy", set: |all, text| choose(&mut all.chosen.policy, &PolicyKind::ALL, text) },
        Choice { path: "segment", set: |all, text| is_on(&mut all.is_segmented, text) },
        Choice { path: "warp", set: |all, text| choose(&mut all.chosen.falloff, &Falloff::ALL, text) },
        Choice { path: "priority.cascade", set: |all, text| is_on(&mut all.has_cascade, text) },
        Choice { path: "priority.threshold", set: |all, text| threshold(text).map(|it| all.threshold = Some(it)) },
        Choice { path: "source", set: |all, text| source(text).map(|it| all.chosen.source = it) },
        Choice { path: "walk.route", set: |all, text| choose(&mut all.route, &Route::ALL, text) },
        Choice { path: "arp.latch", set: |all, text| choose(&mut all.chosen.display.latch, &Latch::ALL, text) },
        Choice { path: "arp.lens", set: |all, text| text.parse().map(|it| all.chosen.display.lens = it) },
        Choice {
            path: "arp.order",
            set: |all, text| choose(&mut all.chosen.display.order, &CompositionOrder::ALL, text),
        },
    ];

    tables_at! {
        "walk": walk,
        "priority": chosen.numbers,
        "arp": chosen.display.timing,
        "arp_scan": chosen.display.scan,
    }

    /// Records the setting for the report. Sets the number of memories of both the policy and the display, which must
    /// be equal.
    fn was_set(&mut self, path: &str, text: &str) {
        let memories = match path {
            "priority.memories" => Some(self.chosen.numbers.memories),
            "arp.display_memories" => Some(self.chosen.display.timing.display_memories),
            _ => None,
        };
        if let Some(memories) = memories {
            self.chosen = self.chosen.clone().with_memories(memories);
        }
        self.given.insert(path.to_owned(), text.to_owned());
    }
}

impl WalkPlan {
    /// Returns the default plan: objects cut at the borders of cells and warped, an ideal renderer, half a minute at 1
    /// m/s.
    pub fn usual() -> Self {
        Self {
            walk: WalkNumbers::PAPERS,
            chosen: WalkSettings::WARPED,
            is_segmented: None,
            has_cascade: None,
            threshold: None,
            route: Route::Scene,
            given: BTreeMap::new(),
        }
    }

    /// Returns the plan with a lens. `name` is the file from which the lens was read.
    #[must_use]
    pub fn behind(mut self, lens: Lens, name: &str) -> Self {
        self.chosen.display.lens = lens;
        self.given.insert("arp.lens".to_owned(), format!("table:{name}"));
        self
    }

    /// Returns the size and viewing angle of the display's picture. A lens table must match this size and this angle.
    pub fn picture(&self) -> LensPicture {
        self.chosen.display.picture()
    }

    /// Returns the complete settings. Settings that were not given have their default values.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`WalkSettings::check`].
    pub fn settings(&self) -> Result<WalkSettings, SettingError> {
        let mut settings = self.chosen.clone();
        // Fill in the defaults that depend on other settings.
        let is_of_cells = settings.policy == PolicyKind::Cells;
        settings.is_segmented = self.is_segmented.unwrap_or(is_of_cells);
        settings.has_cascade = self.has_cascade.unwrap_or(is_of_cells);
        if let Some(threshold) = self.threshold {
            settings.numbers.theta_deg = threshold.degrees(&settings.display);
        }
        if settings.policy == PolicyKind::Full {
            settings = settings.with_memories(1);
        }
        settings.check()?;
        Ok(settings)
    }
}

fn is_on(flag: &mut Option<bool>, text: &str) -> Result<(), SettingError> {
    choose(flag, &[("on", Some(true)), ("off", Some(false))], text)
}

/// Parses the speed of the renderer: `ideal`, or a number of triangles per second.
fn source(text: &str) -> Result<SourceKind, SettingError> {
    if text == "ideal" {
        return Ok(SourceKind::Ideal);
    }
    let rate = text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
    let timed = rate.map(|triangles_per_s| SourceKind::Timed { triangles_per_s });
    timed.ok_or_else(|| SettingError::text("ideal, or triangles a second", text))
}
