//! A head, its tracker and a predictor in front of a pipeline.

use crate::fingerprint::Fingerprint;
use crate::raster::Raster;
use std::fmt;
use std::sync::Arc;
use tracking::ConfigError;
use tracking::motion::Motion;
use tracking::predict::{Predictor, PredictorConfig, PredictorKind};
use tracking::tracker::{TrackerConfig, TrackerModel};

/// Why a head cannot be simulated.
pub type HeadError = ConfigError;

/// A head, its tracker, a predictor, and the display before its eyes.
#[derive(Clone)]
pub struct Head {
    pub(crate) motion: Arc<dyn Motion + Send + Sync>,
    pub(crate) tracker: TrackerModel,
    predictor: PredictorConfig,
    pub(crate) seed: u64,
    raster: Raster,
}

impl fmt::Debug for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Head")
            .field("tracker", self.tracker.config())
            .field("predictor", &self.predictor)
            .field("seed", &self.seed)
            .field("raster", &self.raster)
            .finish_non_exhaustive()
    }
}

impl Head {
    /// A head that moves, a tracker and a predictor that knows the tracker's noise.
    ///
    /// # Errors
    ///
    /// [`HeadError`] names the setting, what was expected and what was found.
    pub fn new(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorKind,
        seed: u64,
    ) -> Result<Self, HeadError> {
        let predictor = PredictorConfig::for_tracker(predictor, &tracker);
        Self::predicted_by(motion, tracker, predictor, seed)
    }

    /// The same with a predictor whose numbers are not those of the papers.
    ///
    /// # Errors
    ///
    /// As [`Head::new`].
    pub fn predicted_by(
        motion: Arc<dyn Motion + Send + Sync>,
        tracker: TrackerConfig,
        predictor: PredictorConfig,
        seed: u64,
    ) -> Result<Self, HeadError> {
        predictor.build()?;
        Ok(Self { motion, tracker: TrackerModel::new(tracker)?, predictor, seed, raster: Raster::Plain })
    }

    /// Puts a raster before its eyes.
    #[must_use]
    pub const fn before(mut self, raster: Raster) -> Self {
        self.raster = raster;
        self
    }

    /// How the raster before its eyes shows the picture.
    #[must_use]
    pub const fn raster(&self) -> Raster {
        self.raster
    }

    /// Name of everything that it is, the motion included.
    #[must_use]
    pub fn fingerprint(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        let mut add = |key: &str, value: &dyn fmt::Display| hash.setting(key, value);
        self.motion.identify(&mut add);
        self.tracker.config().identify(&mut add);
        self.predictor.identify(&mut add);
        hash.setting("seed", self.seed);
        hash.setting("raster", self.raster);
        hash
    }

    /// Whether poses are predicted.
    #[must_use]
    pub fn predicts(&self) -> bool {
        self.predictor.kind != PredictorKind::None
    }

    /// The predictor.
    #[must_use]
    pub const fn predictor_kind(&self) -> PredictorKind {
        self.predictor.kind
    }

    /// The tracker.
    #[must_use]
    pub const fn tracker(&self) -> &TrackerModel {
        &self.tracker
    }

    /// The motion, in the tracker's coordinates.
    #[must_use]
    pub fn motion(&self) -> &(dyn Motion + Send + Sync) {
        self.motion.as_ref()
    }

    pub(crate) fn without_prediction(&self) -> Self {
        Self { predictor: PredictorConfig { kind: PredictorKind::None, ..self.predictor }, ..self.clone() }
    }

    pub(crate) fn build_predictor(&self) -> Box<dyn Predictor> {
        self.predictor.build().expect("checked by Head::new")
    }
}
