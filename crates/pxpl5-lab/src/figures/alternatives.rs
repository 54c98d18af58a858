//! Published figures under other assumptions: times of executed code, other rules, sizes of chips, and times of the host.

use super::groups::row_of;
use super::interpretation::Interpretation;
use super::measurement::Measurement;
use super::rates;
use super::settings::FigureSettings;
use super::topics::{all, at_all_levels};
use super::value::DEVIATION;
use crate::error::StudyError;
use crate::estimate::Estimate;
use crate::interpretations::{InterpretationQuery, Interpretations};
use crate::parallel;
use crate::study::{Study, check};
use pxpl5_run::{FinishedRegions, Level};
use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::{SharedWatcher, Watcher};
use serde::Serialize;

/// Published figures under other assumptions than in [`Figures`](super::Figures).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alternatives {
    /// Rows of Rendering Control, Slats and the head, with the times of executed i860 code.
    pub of_code: Vec<FigureRow>,
    /// Rows that depend on the interpretation, with the other rule for finished regions.
    pub other_rule: Vec<FigureRow>,
    /// Rates and limits for each size of a renderer's FIFO.
    pub fifo: Vec<Effect>,
    /// Latency of the pendulum rig for several durations of a message, and of the application, on the host.
    pub host: Vec<Effect>,
    /// Fit of the model to the published figures of Rendering Control, for each interpretation of the papers.
    pub interpretations: Interpretations,
    /// Latencies of the fly-throughs for several times of the application on the host, at the analytic level.
    pub application: Vec<Effect>,
}

/// Values of some figures with changed parameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Paths and values of the parameters.
    pub changes: Vec<(&'static str, u64)>,
    /// Numbers of the figures with their values and standard deviations, which are NaN for a single number.
    pub figures: Vec<(&'static str, f64, f64)>,
}

/// Number of seeds for each application scene in the ranking of interpretations of the papers.
const SEEDS: u64 = 2;
/// Number of frames for each seed in the ranking of interpretations of the papers.
const FRAMES: u64 = 60;
/// Number of interpretations that are simulated with events, those that the formulas find likeliest.
const SIMULATED: usize = 20;

/// Sizes of FIFO chips that were sold from 1988 to 1990, in words (recollected).
const CHIPS: [u64; 4] = [256, 512, 1_024, 2_048];
/// Rates and limits that depend on the size of the FIFO.
const OF_FIFO: [&str; 6] = ["R1", "R2", "R3", "12", "13", "14"];

/// Times of the host in milliseconds for one message, or for the application.
const HOST_MS: [u64; 4] = [2, 4, 6, 8];

/// Mean times of the application in milliseconds. Assumed: from no application to a loop of 25 frames a second.
const MEANS_MS: [u64; 5] = [0, 10, 20, 30, 40];
/// Jitters of the application's time in milliseconds, at most the mean. Assumed: up to 30 ms, the period at which a Unix
/// host polled its serial ports (TR94).
const JITTERS_MS: [u64; 4] = [0, 10, 20, 30];

/// The measurement of the published figures under other assumptions.
#[derive(Clone, Debug)]
pub struct AlternativeQuery {
    /// Settings of all measurements.
    pub settings: FigureSettings,
}

impl Study for AlternativeQuery {
    type Report = Alternatives;

    fn estimate(&self, threads: usize) -> Estimate {
        let settings = self.settings.clone().with_mig(SEEDS, FRAMES);
        InterpretationQuery { settings, best: SIMULATED }.estimate(threads)
    }

    /// Measures all members in parallel.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Alternatives, StudyError> {
        let watcher = SharedWatcher::new(watcher, 6);
        let settings = &FigureSettings { stop: watcher.stop(), ..self.settings.clone() };
        let rows = |settings: &FigureSettings, figures: Vec<&Measurement>| {
            let rows = parallel::map(&figures, |figure| row_of(figure, settings));
            rows.into_iter().collect::<Result<Vec<_>, _>>()
        };
        let of_code = || watcher.part(|| rows(&settings.clone().with_times_of_code(), at_all_levels().collect()));
        let other_rule = || {
            let other = Interpretation { finished: FinishedRegions::Wait, ..settings.interpretation };
            watcher.part(|| rows(&settings.with(other), all().filter(|figure| figure.is_interpreted).collect()))
        };
        let effects = |settings: &FigureSettings, ends: &[Vec<(&'static str, u64)>], ids: &[&'static str]| {
            watcher.part(|| effects(settings, ends, ids))
        };
        let fifo = || effects(settings, &CHIPS.map(|words| vec![(rates::FIFO_WORDS, words)]), &OF_FIFO);
        let ms = |path| HOST_MS.map(|ms| vec![(path, ms * MS)]);
        let host = || effects(settings, &[ms("host.message_ns"), ms(APPLICATION)].concat(), &["17"]);
        let ranking = InterpretationQuery { settings: settings.clone().with_mig(SEEDS, FRAMES), best: SIMULATED };
        let interpretations = || watcher.part(|| ranking.run(&mut watcher.stop()));
        let of_application = || {
            let times = MEANS_MS.iter().flat_map(|mean| JITTERS_MS.iter().map(move |jitter| (*mean, *jitter)));
            // A jitter greater than the mean would need negative times.
            let times = times.filter(|(mean, jitter)| jitter <= mean);
            let ends = times.map(|(mean, jitter)| vec![(APPLICATION, mean * MS), (JITTER, jitter * MS)]);
            let settings = FigureSettings { level: Level::Analytic, ..ranking.settings.clone() };
            effects(&settings, &ends.collect::<Vec<_>>(), &["7", "7b", "7c"])
        };
        let both = || parallel::both(other_rule, of_code);
        let ((other_rule, of_code), ((fifo, host), (interpretations, times))) = parallel::both(both, || {
            parallel::both(|| parallel::both(fifo, host), || parallel::both(interpretations, of_application))
        });
        // After a stop, the ranking is unfinished.
        check(&watcher.stop())?;
        Ok(Alternatives {
            of_code: of_code?,
            other_rule: other_rule?,
            fifo: fifo?,
            host: host?,
            interpretations: interpretations?,
            application: times?,
        })
    }
}

const APPLICATION: &str = "host.application_ns";
const JITTER: &str = "host.application_jitter_ns";
const MS: u64 = 1_000_000;

/// Measures the figures `ids` with the changes of each element of `ends`.
fn effects(
    settings: &FigureSettings,
    ends: &[Vec<(&'static str, u64)>],
    ids: &[&'static str],
) -> Result<Vec<Effect>, StudyError> {
    let effect = |changes: &Vec<(&'static str, u64)>| {
        let moved = settings.with_changes(changes.iter().map(|(path, value)| ((*path).to_owned(), *value)));
        let figure = |id: &&'static str| {
            let measured = moved.measure(id).map_err(StudyError::of_figure(id))?;
            Ok::<_, StudyError>((*id, measured.value, measured.detail(DEVIATION).unwrap_or(f64::NAN)))
        };
        Ok(Effect { changes: changes.clone(), figures: ids.iter().map(figure).collect::<Result<_, _>>()? })
    };
    parallel::map(ends, effect).into_iter().collect()
}
