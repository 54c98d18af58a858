//! Settings of a simulated walk of the viewer through a scene. Each setting has a path such as `priority.theta_deg`.

use crate::hall::Route;
use crate::settings::{PolicyKind, SourceKind, WalkSettings};
use address_recalculation::priority::Falloff;
use address_recalculation::{ArpConfig, CompositionOrder, Latch, Lens, LensPicture};
use pxpl5_sim::parameters::{Entry, ParameterInfo, ParameterTable, SettingError, Value};
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

/// Paths of the settings that are choices, not numbers.
const CHOICES: [&str; 10] = [
    "policy",
    "segment",
    "warp",
    "priority.cascade",
    "priority.threshold",
    "source",
    "walk.route",
    "arp.latch",
    "arp.lens",
    "arp.order",
];

/// Settings of a walk by path. Some defaults depend on other settings.
///
/// A *cascade* lets an update of a memory also update all more often drawn memories. By default, only walks with warped
/// cells have a cascade, and only the policy `cells` cuts objects. `priority.threshold` in pixels or texels overrides
/// `priority.theta_deg`.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkPlan {
    /// Speed and length of the viewer's walk.
    pub walk: WalkNumbers,
    chosen: WalkSettings,
    is_segmented: Option<bool>,
    has_cascade: Option<bool>,
    threshold: Option<ThresholdChoice>,
    route: Route,
    given: BTreeMap<String, String>,
}

/// A threshold in pixels or texels. The threshold becomes an angle when the display's resolution is set.
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

/// Parses a threshold such as `2px` or `2texels`.
fn threshold(text: &str) -> Result<ThresholdChoice, String> {
    let expected = || "pixels of the display as 2px, or texels of a face as 2texels".to_owned();
    let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    if let Some(pixels) = text.strip_suffix("px") {
        return number(pixels).map(ThresholdChoice::Pixels).ok_or_else(expected);
    }
    let texels = text.strip_suffix("texels").or_else(|| text.strip_suffix("texel"));
    texels.and_then(number).map(ThresholdChoice::Texels).ok_or_else(expected)
}

/// A table of parameters, with the first part of the paths of these parameters.
type NamedTable<'a> = (&'static str, &'a dyn ParameterTable);

impl WalkPlan {
    /// Returns the default plan: objects cut at the borders of cells and warped, an ideal renderer, half a minute at 1
    /// m/s.
    #[must_use]
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

    fn tables(&self) -> [NamedTable<'_>; 4] {
        [
            ("walk", &self.walk),
            ("priority", &self.chosen.numbers),
            ("arp", &self.chosen.display.timing),
            ("arp_scan", &self.chosen.display.scan),
        ]
    }

    /// Returns the names of all settings that [`Self::set`] accepts. A name is a path, such as `walk.route`.
    #[must_use]
    pub fn keys(&self) -> Vec<String> {
        let numbers = self.numbers().into_iter().map(|(path, _)| path);
        CHOICES.iter().map(|key| (*key).to_owned()).chain(numbers).collect()
    }

    /// Returns all numeric settings by path, with their current values.
    #[must_use]
    pub fn numbers(&self) -> Vec<(String, Entry)> {
        let tables = self.tables().into_iter();
        let all = tables.flat_map(|(prefix, table)| table.entries().into_iter().map(move |entry| (prefix, entry)));
        all.map(|(prefix, entry)| (format!("{prefix}.{}", entry.info.name), entry)).collect()
    }

    /// Returns the settings that the user gave explicitly, by path.
    #[must_use]
    pub const fn given(&self) -> &BTreeMap<String, String> {
        &self.given
    }

    /// Sets the setting at a path. `place` names the source of the value in errors, such as `--set`.
    ///
    /// # Errors
    ///
    /// [`SettingError`] with the most similar path, or with the allowed values.
    pub fn set(&mut self, path: &str, text: &str, place: &str) -> Result<(), SettingError> {
        let done = match path {
            "policy" => choose(&mut self.chosen.policy, &PolicyKind::ALL, text),
            "warp" => choose(&mut self.chosen.falloff, &Falloff::ALL, text),
            "arp.latch" => choose(&mut self.chosen.display.latch, &Latch::ALL, text),
            "arp.order" => choose(&mut self.chosen.display.order, &CompositionOrder::ALL, text),
            "segment" => is_on(text).map(|is_on| self.is_segmented = Some(is_on)),
            "walk.route" => choose(&mut self.route, &Route::ALL, text),
            "priority.threshold" => threshold(text).map(|threshold| self.threshold = Some(threshold)),
            "priority.cascade" => is_on(text).map(|is_on| self.has_cascade = Some(is_on)),
            "source" => source(text).map(|source| self.chosen.source = source),
            "arp.lens" => text.parse().map_err(|_| Lens::FORMS.to_owned()).map(|lens| self.chosen.display.lens = lens),
            _ => self.set_number(path, text, place)?,
        };
        done.map_err(|expected| wrong(path, text, place, expected))?;
        // Record the setting for the report.
        self.given.insert(path.to_owned(), text.to_owned());
        Ok(())
    }

    /// Sets a setting from text of the form `path=value`, as after `--set`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Self::set`]. Also an error if the text has no equals sign.
    pub fn assign(&mut self, assignment: &str, place: &str) -> Result<(), SettingError> {
        match assignment.split_once('=') {
            Some((path, text)) => self.set(path.trim(), text.trim(), place),
            None => Err(wrong("PATH=VALUE", assignment, place, "an equals sign".to_owned())),
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
    #[must_use]
    pub fn picture(&self) -> LensPicture {
        self.chosen.display.picture()
    }

    #[must_use]
    pub const fn route(&self) -> Route {
        self.route
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
        let is_warped = is_of_cells && settings.is_segmented && settings.falloff != Falloff::None;
        settings.has_cascade = self.has_cascade.unwrap_or(is_warped);
        if let Some(threshold) = self.threshold {
            settings.numbers.theta_deg = threshold.degrees(&settings.display);
        }
        if settings.policy == PolicyKind::Full {
            settings = settings.with_memories(1);
        }
        settings.check()?;
        Ok(settings)
    }

    /// Sets a number in the table of parameters that has this path.
    ///
    /// # Errors
    ///
    /// The outer error reports an unknown path. The inner error describes the valid values.
    fn set_number(&mut self, path: &str, text: &str, place: &str) -> Result<Result<(), String>, SettingError> {
        let Some((_, Entry { info, value: now })) = self.numbers().into_iter().find(|(key, _)| key == path) else {
            return Err(SettingError::unknown_path("key", path, self.keys()).at(place));
        };
        // Parse the value as the type of the parameter.
        let is_real = matches!(now, Value::Real(_));
        let value = if is_real { text.parse().map(Value::Real).ok() } else { text.parse().map(Value::Whole).ok() };
        let Some(value) = value.filter(|value| Entry { info, value: *value }.is_within_limits()) else {
            return Ok(Err(expected_of(info)));
        };
        let name = info.name;
        let prefix = path.split('.').next().unwrap_or_default();
        let table: &mut dyn ParameterTable = match prefix {
            "walk" => &mut self.walk,
            "priority" => &mut self.chosen.numbers,
            "arp" => &mut self.chosen.display.timing,
            _ => &mut self.chosen.display.scan,
        };
        let done = table.set(name, value).map_err(|_| expected_of(info));
        // The policy and the display must have the same number of memories.
        if let ("priority.memories" | "arp.display_memories", Value::Whole(memories)) = (path, value) {
            self.chosen = self.chosen.clone().with_memories(memories);
        }
        Ok(done)
    }
}

fn expected_of(info: &ParameterInfo) -> String {
    let (least, most) = info.limits;
    let kind = if matches!(info.papers, Value::Whole(_)) { "a whole number" } else { "a number" };
    format!("{kind} of {least} to {most} {}", info.unit)
}

fn choose<T: Copy>(choice: &mut T, all: &[(&'static str, T)], text: &str) -> Result<(), String> {
    let found = all.iter().find(|(name, _)| *name == text);
    let names = || all.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    *choice = found.ok_or_else(names)?.1;
    Ok(())
}

fn is_on(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("on or off".to_owned()),
    }
}

/// Parses the speed of the renderer: `ideal`, or a number of triangles per second.
fn source(text: &str) -> Result<SourceKind, String> {
    if text == "ideal" {
        return Ok(SourceKind::Ideal);
    }
    let rate = text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
    let timed = rate.map(|triangles_per_s| SourceKind::Timed { triangles_per_s });
    timed.ok_or_else(|| "ideal, or triangles a second".to_owned())
}

fn wrong(key: &str, found: &str, place: &str, expected: String) -> SettingError {
    SettingError::value(key, expected, found).at(place)
}
