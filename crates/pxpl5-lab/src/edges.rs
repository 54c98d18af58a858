//! Warnings about results that lie near an edge, where a small change of a parameter moves them by a whole field.
//!
//! A display shows a picture at a retrace, so a copy that ends just before one could as well end just after it. Whole
//! fields have an edge of their own: a latency just above a whole number counts as one field more. Source of both:
//! docs/numerics.md, chapter "Time".

use pxpl5_run::{Outcome, Summary};

/// Distance from an edge in fields below which a result counts as near it.
pub const NEAR_FIELDS: f64 = 0.05;

/// Returns how near the pictures of a run come to another retrace, in fields. A picture would be shown a field later if
/// its last COPY ended later by the first number, and a field earlier if its COPY ended earlier by the second number.
/// `None` if no picture was shown. For fields that are drawn at once (Slats), an earlier copy changes nothing, and the
/// second number is NaN.
pub(crate) fn to_other_retraces(summary: &Summary) -> Option<[f64; 2]> {
    let field_ms = summary.field_ms;
    if summary.eye_latencies_ms.is_empty() {
        let wait = 1.0 - (summary.copy_begins_ms + summary.first_copy_ms) / field_ms;
        return (wait.is_finite() && !summary.latencies_ms.is_empty()).then_some([wait, f64::NAN]);
    }
    // The last eye of a picture is copied last.
    let eyes = (summary.eye_latencies_ms.len() / summary.latencies_ms.len().max(1)).max(1);
    let pairs = summary.eye_swap_latencies_ms.iter().zip(summary.eye_latencies_ms.iter());
    let waits = pairs.skip(eyes - 1).step_by(eyes).map(|(swap, copy)| (swap - copy) / field_ms);
    let [least, greatest] = waits.fold([f64::INFINITY, 0.0], |[low, high], wait| [wait.min(low), wait.max(high)]);
    // Exact sums of picoseconds become fields of rounded milliseconds, which can exceed a whole field.
    least.is_finite().then_some([least, (1.0 - greatest).max(0.0)])
}

/// Returns a warning for each statistic of a run that lies within [`NEAR_FIELDS`] of an edge. A pipeline that draws each
/// part of a picture for its own instant has no such edge.
pub fn near_edges(outcome: &Outcome) -> Vec<String> {
    if outcome.pipeline().properties().knows_when_seen { Vec::new() } else { of_summary(&outcome.summary()) }
}

fn of_summary(summary: &Summary) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some([later, earlier]) = to_other_retraces(summary) {
        let mut near = |distance: f64, what: &str| {
            if (0.0..NEAR_FIELDS).contains(&distance) {
                warnings.push(format!(
                    "a copy ends within {distance:.3} field of {what} retrace: a small change moves a latency by a whole field"
                ));
            }
        };
        near(later, "a missed");
        near(earlier, "an earlier");
    }
    let beyond = summary.eye_swap_latencies_ms.iter().map(|ms| ms / summary.field_ms);
    let near = beyond.map(|fields| (fields - fields.round()).abs()).filter(|distance| *distance < NEAR_FIELDS);
    let (count, least) = near.fold((0, f64::INFINITY), |(count, least), distance| (count + 1, distance.min(least)));
    if count > 0 {
        warnings.push(format!(
            "{count} of {} latencies of eyes lie within {least:.3} field of a whole number: eye_retraces counts them as one \
             field more or less",
            summary.eye_swap_latencies_ms.len()
        ));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::Samples;

    /// Returns the summary of one stereo picture. Each eye has a latency to the swap and a time to the end of its COPY, in
    /// fields of 10 ms.
    fn summary(to_swap: [f64; 2], to_copy: [f64; 2]) -> Summary {
        let ms = |fields: &[f64]| fields.iter().map(|fields| fields * 10.0).collect::<Samples>();
        Summary {
            latencies_ms: ms(&to_swap[..1]),
            field_ms: 10.0,
            updates_hz: None,
            due: None,
            eye_latencies_ms: ms(&to_copy),
            eye_swap_latencies_ms: ms(&to_swap),
            eye_retraces: Samples::default(),
            region_copy_us: 780.0,
            first_copy_ms: 3.0,
            last_copy_ms: 3.0,
            copy_begins_ms: 6.6,
        }
    }

    #[test]
    fn a_copy_just_before_or_just_after_a_retrace_and_an_eye_near_a_whole_field_give_a_warning_each() {
        let far = summary([4.3, 3.3], [3.2, 2.9]);
        let [later, earlier] = to_other_retraces(&far).expect("shown");
        assert!((later - 0.4).abs() < 1e-9 && (earlier - 0.6).abs() < 1e-9, "{later} {earlier}");
        assert_eq!(of_summary(&far), [""; 0]);
        assert!(of_summary(&summary([4.3, 3.3], [3.2, 3.26]))[0].contains("within 0.040 field of a missed retrace"));
        assert!(of_summary(&summary([4.3, 3.3], [3.2, 2.33]))[0].contains("within 0.030 field of an earlier retrace"));
        assert!(of_summary(&summary([4.3, 3.03], [3.2, 2.5]))[0].starts_with("1 of 2 latencies"));
    }

    #[test]
    fn a_field_of_slats_is_near_only_the_retrace_that_it_would_miss() {
        let slats = Summary {
            eye_latencies_ms: Samples::default(),
            eye_swap_latencies_ms: Samples::default(),
            ..summary([1.0, 1.0], [1.0, 1.0])
        };
        assert!(of_summary(&slats)[0].contains("within 0.040 field of a missed retrace"));
    }
}
