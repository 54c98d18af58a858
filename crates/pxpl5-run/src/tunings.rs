use crate::fingerprint::Fingerprint;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use tracking::motion::Motion;
use tracking::predict::{PredictorConfig, Tuned, training_seed, tune};
use tracking::tracker::TrackerModel;

/// Hash of motion, tracker and predictor; prediction interval in picoseconds; seed of the noise.
type Key = (Fingerprint, u64, u64);

/// A cache of tuned predictors, by head motion, settings and prediction interval.
///
/// Equal inputs have equal results, so the cache changes no result. All runs of a comparison share one cache
/// ([`Head::sharing_tunings`](crate::Head::sharing_tunings)).
#[derive(Debug, Default)]
pub struct Tunings {
    cached: Mutex<BTreeMap<Key, Arc<OnceLock<Tuned>>>>,
}

impl Tunings {
    /// Returns the tuned predictor from the cache. If the cache does not contain the predictor, tunes the predictor
    /// first. Threads that request the same predictor wait for one result.
    pub(crate) fn tuned(
        &self,
        motion: &(dyn Motion + Send + Sync),
        tracker: &TrackerModel,
        interval_ps: u64,
        base: &PredictorConfig,
        evaluated_seed: u64,
    ) -> Tuned {
        let mut hash = Fingerprint::default();
        motion.identify(&mut |key, value| hash.setting(key, value));
        hash.setting("tracker", format_args!("{:?}", tracker.config()));
        hash.setting("predictor", format_args!("{base:?}"));
        // The seed of the evaluated run matters only because the training must use another seed.
        let key = (hash, interval_ps, training_seed(evaluated_seed));
        // The map is locked only to find the place. The place itself waits for the result.
        let place = Arc::clone(self.cached.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default());
        *place.get_or_init(|| tuned_once(motion, tracker, interval_ps, base, evaluated_seed))
    }

    /// Returns the number of predictors in the cache.
    pub fn len(&self) -> usize {
        self.cached.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// Returns true if the cache has no predictor.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

pub(crate) fn tuned_once(
    motion: &(dyn Motion + Send + Sync),
    tracker: &TrackerModel,
    interval_ps: u64,
    base: &PredictorConfig,
    evaluated_seed: u64,
) -> Tuned {
    tune(motion, tracker, interval_ps, base, evaluated_seed).expect("checked by Head::new")
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracking::motion::{Pan, Synthetic};
    use tracking::predict::PredictorKind;
    use tracking::tracker::TrackerConfig;

    const INTERVAL_PS: u64 = 40_000_000_000;

    /// Tests that a tuning from the cache equals a new tuning, for different motions, trackers, intervals and seeds.
    #[test]
    fn a_tuning_from_the_cache_equals_a_new_tuning() {
        let tunings = Tunings::default();
        let still: [Box<dyn Motion + Send + Sync>; 3] =
            [Box::new(Pan::at(200.0)), Box::new(Pan::at(-30.0)), Box::new(Synthetic::recorded_use(3))];
        let mut made = 0;
        for motion in &still {
            for tracker in [TrackerConfig::optical_ceiling(), TrackerConfig::fastrak()] {
                let tracker = TrackerModel::new(tracker).expect("a preset");
                let base = PredictorConfig::for_tracker(PredictorKind::ConstantVelocity, tracker.config());
                let avoided = training_seed(1);
                for (interval_ps, seed) in [(INTERVAL_PS, 1), (2 * INTERVAL_PS, 1), (INTERVAL_PS, avoided)] {
                    let shared = || tunings.tuned(motion.as_ref(), &tracker, interval_ps, &base, seed);
                    let alone = tuned_once(motion.as_ref(), &tracker, interval_ps, &base, seed);
                    made += 1;
                    assert_eq!((shared(), shared(), tunings.len()), (alone, alone, made));
                }
            }
        }
    }

    #[test]
    fn seeds_not_used_for_training_share_a_tuning() {
        let tunings = Tunings::default();
        let tracker = TrackerModel::new(TrackerConfig::optical_ceiling()).expect("a preset");
        let base = PredictorConfig::for_tracker(PredictorKind::ConstantVelocity, tracker.config());
        let motion = Pan::at(200.0);
        let all = [1, 2, 3].map(|seed| tunings.tuned(&motion, &tracker, INTERVAL_PS, &base, seed));
        assert!(all.iter().all(|one| *one == all[0]) && tunings.len() == 1);
        let kalman = PredictorConfig { kind: PredictorKind::ConstantAcceleration, ..base };
        assert!(tunings.tuned(&motion, &tracker, INTERVAL_PS, &kalman, 1) != all[0] && tunings.len() == 2);
    }
}
