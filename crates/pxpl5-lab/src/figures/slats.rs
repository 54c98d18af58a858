//! Figures of Slats: latency, copies, and the largest numbers of triangles.

use super::measurement::{CLUMP_RULE, LatencyDefinition, Measurement, SLATS, Varied, figure};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result, detail, rate_hz};
use crate::edges::to_other_retraces;
use crate::limit::LimitQuery;
use crate::study::Study;
use pxpl5_run::{Slats, Summary};
use pxpl5_sim::figures::Basis;
use std::sync::Arc;

const TR94: (&str, &str) = ("TR94", SLATS);
const I3D95: (&str, &str) = ("I3D95", SLATS);
const BOTH: (&str, &str) = ("TR94, I3D95", SLATS);

const OF_CLUMP: &str = "The time of a triangle is that of the project's code, without a fit. TR94 does not say when a clump's buffer is free. Our rule \
    was chosen among three by rows 12 and 13";
const OF_FIFO: &str = "Our FIFOs take a whole message, so renderers delay the next clump little. In TR94, the COPY optimisation \
                       saves 4.68 ms and allows 30 more triangles, so a triangle takes 156 us there. Our code and ring need less. \
                       FIFOs of 256 words would give both limits within 6 %, but rows R1 and R2 ask for at least 1,024 (docs/interpretations.md, Findings)";

const OF_FIELD: LatencyDefinition = LatencyDefinition {
    from: "retrace at which TRANSFORM of a field begins",
    to: "retrace at which its scan-out begins",
    eyes: "both eyes together",
    statistic: "mean, which equals least and greatest",
    sentence: "TR94: from the begin of the transformation to that of the scan-out",
};

const fn by_formula(figure: Measurement) -> Measurement {
    Measurement { varied: Varied::ByFormula, ..figure }
}

/// The figures of Slats, in the order of their numbers.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        basis: Basis::Derived("the pipeline's definition"),
        latency: Some(OF_FIELD),
        ..by_formula(figure(
            ("9", BOTH, 1.0, "fields"),
            "rendering latency, constant",
            "full-screen:100 on slats with the COPY optimisation",
            latency,
        ))
    },
    Measurement {
        basis: Basis::Derived("row 9 and the display's rate"),
        ..by_formula(figure(
            ("9b", BOTH, 60.0, "Hz"),
            "updates per second",
            "full-screen:100 on slats with the COPY optimisation",
            |settings| run(settings, 100, Slats::split()).map(|summary| rate_hz(&summary).into()),
        ))
    },
    Measurement {
        basis: Basis::Rule("a frame-buffer port serves in order of arrival"),
        reason: "Any other order gives 12 region times",
        ..by_formula(figure(
            ("10", TR94, 11.0, "region times"),
            "20 field regions to two frame buffers",
            "full-screen:60 on slats without the COPY optimisation: from the first to the last word, in units of 780 us",
            |settings| run(settings, 60, Slats::whole()).map(|s| (s.first_copy_ms * 1e3 / s.region_copy_us).into()),
        ))
    },
    Measurement {
        basis: Basis::Rule("odd renderers begin with the right eye"),
        reason: "Otherwise ten regions take six region times, 4.7 ms",
        ..by_formula(figure(
            ("11", I3D95, 3.9, "ms"),
            "half of them",
            "full-screen:100 on slats with the COPY optimisation: from the first to the last word of the bottom regions",
            |settings| Ok(run(settings, 100, Slats::split())?.last_copy_ms.into()),
        ))
    },
    Measurement {
        basis: Basis::Interpretation(CLUMP_RULE),
        reason: OF_CLUMP,
        cause: OF_FIFO,
        ..by_formula(figure(
            ("12", TR94, 110.0, "triangles"),
            "most triangles without the COPY optimisation",
            "limit of full-screen:N on slats",
            |settings| limit(settings, "slats", Slats::whole()),
        ))
    },
    Measurement {
        basis: Basis::Interpretation(CLUMP_RULE),
        reason: OF_CLUMP,
        cause: OF_FIFO,
        ..by_formula(figure(
            ("13", TR94, 140.0, "triangles"),
            "most triangles with the COPY optimisation",
            "limit of full-screen:N on slats",
            |settings| limit(settings, "slats", Slats::split()),
        ))
    },
    Measurement {
        basis: Basis::Fitted("gp.triangle_ns of slats-1995"),
        ..by_formula(figure(
            ("14", I3D95, 100.0, "triangles"),
            "most triangles with the COPY optimisation, code of 1995: about",
            "limit of full-screen:N on slats-1995",
            |settings| limit(settings, "slats-1995", Slats::split()),
        ))
    },
    Measurement {
        basis: Basis::Derived("a field less row 11"),
        ..by_formula(figure(
            ("15", I3D95, 12.8, "ms"),
            "time before the first copy in a field: about",
            "the largest scene of figure 13: the time from the retrace to the first word of the first copy",
            time_before_copy,
        ))
    },
];

fn run(settings: &FigureSettings, triangles: u32, pipeline: Slats) -> Result<Arc<Summary>> {
    settings.run(settings.machine("slats")?, pipeline, &format!("full-screen:{triangles}"), 40)
}

fn latency(settings: &FigureSettings) -> Result<FigureValue> {
    let summary = run(settings, 100, Slats::split())?;
    let fields = summary.latency_fields();
    let details = vec![detail("least", fields.min, "fields"), detail("greatest", fields.max, "fields")];
    Ok(FigureValue::with(fields.mean, details).beside(to_other_retraces(&summary)))
}

fn limit(settings: &FigureSettings, preset: &str, pipeline: Slats) -> Result<FigureValue> {
    let most = most(settings, preset, pipeline)?;
    let triangles = f64::from(most);
    let details = vec![detail("both eyes, 60 fields a second", triangles * 120.0, "triangles/s")];
    let at_limit = settings.run(settings.machine(preset)?, pipeline, &format!("full-screen:{most}"), 40)?;
    Ok(FigureValue::with(triangles, details).beside(to_other_retraces(&at_limit)))
}

/// Returns the largest number of triangles that Slats draws in time. The result is cached, because two figures need the
/// same search.
fn most(settings: &FigureSettings, preset: &str, pipeline: Slats) -> Result<u32> {
    let level = settings.level;
    let of_papers = LimitQuery::of_papers(settings.machine(preset)?, pipeline)?;
    let query = LimitQuery { level, looks_above: false, ..of_papers };
    let key = format!("{:?} {pipeline:?} {:?}", query.level, query.config);
    settings.applications.limit(key, || Ok(query.run(&mut settings.stop.clone())?.triangles))
}

fn time_before_copy(settings: &FigureSettings) -> Result<FigureValue> {
    let most = most(settings, "slats", Slats::split())?;
    let summary = run(settings, most, Slats::split())?;
    Ok(FigureValue::with(summary.copy_begins_ms, vec![detail("triangles", most.into(), "triangles")]))
}
