use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Display;

/// Returns the duration of a film's frame as a fraction of a second, in the form that animated PNG needs.
///
/// Numerator and denominator have 16 bits each. The result is the fraction nearest to the duration of a display period.
pub fn frame_seconds(display: &dyn Display) -> (u16, u16) {
    // Ticks are rounded to picoseconds. Over this number of periods, the rounding is negligible.
    const PERIODS: u64 = 60_000;
    let span = display.tick(PeriodNumber(PERIODS)).since(Time::ZERO);
    let nearest = nearest_fraction(Fraction { over: span.0.into(), under: u128::from(PERIODS) * PS_PER_S });
    (nearest.over as u16, nearest.under as u16)
}

const PS_PER_S: u128 = 1_000_000_000_000;

/// Largest numerator and largest denominator that animated PNG can store.
const LIMIT: u128 = u16::MAX as u128;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fraction {
    over: u128,
    under: u128,
}

impl Fraction {
    /// Returns the difference to another fraction, multiplied by both denominators so that the result is an integer.
    const fn distance(self, other: Self) -> u128 {
        (self.over * other.under).abs_diff(other.over * self.under)
    }
}

/// Returns the fraction that is nearest to `exact` and has no numerator or denominator above [`LIMIT`]. Of equally near
/// fractions, the result has the smallest denominator.
fn nearest_fraction(exact: Fraction) -> Fraction {
    let beside = |under: u128| {
        let below = (exact.over * under / exact.under).min(LIMIT);
        [below, (below + 1).min(LIMIT)].map(|over| Fraction { over, under })
    };
    let nearer = |best: Fraction, other: Fraction| {
        let is_nearer = exact.distance(other) * best.under < exact.distance(best) * other.under;
        if is_nearer { other } else { best }
    };
    (1..=LIMIT).flat_map(beside).reduce(nearer).unwrap_or(exact)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_framebuffer::{FrameBufferConfig, HiResConfig, VideoTiming};
    use pxpl5_wire::NodeId;
    use pxpl5_wire::display::DisplayConfig;

    fn seconds(config: &dyn DisplayConfig) -> (u16, u16) {
        frame_seconds(config.build(&[NodeId(1)], pxpl5_sim::Span::from_ns(50)).expect("can be built").as_ref())
    }

    #[test]
    fn a_film_frame_of_the_ntsc_display_takes_one_field() {
        assert_eq!(seconds(&FrameBufferConfig::NTSC), (1_001, 60_000));
    }

    /// Tests the time of a field with half of 625 lines. A line takes 4004/63 us, so the field takes 143/7200 s.
    #[test]
    fn a_film_frame_of_a_display_with_625_lines_takes_the_time_of_its_field() {
        let video = VideoTiming { frame_lines: 625, ..FrameBufferConfig::NTSC.video };
        assert_eq!(seconds(&FrameBufferConfig { video, ..FrameBufferConfig::NTSC }), (143, 7_200));
    }

    #[test]
    fn a_frame_of_the_high_resolution_display_takes_a_72nd_of_a_second() {
        assert_eq!(seconds(&HiResConfig::PAPERS), (1, 72));
    }

    #[test]
    fn an_exact_fraction_is_found() {
        for (over, under) in [(1, 1), (65_535, 65_534), (1, 65_535), (65_535, 1), (355, 113), (2, 3)] {
            let exact = Fraction { over, under };
            assert_eq!(nearest_fraction(Fraction { over: over * 1_000, under: under * 1_000 }), exact);
        }
    }

    #[test]
    fn the_nearest_fraction_is_found() {
        for (over, under) in [(100_003, 100_019), (1, 1_000_003), (141_421_356, 100_000_000), (1_000_003, 70_001)] {
            let exact = Fraction { over, under };
            let found = nearest_fraction(exact);
            assert!(found.over <= LIMIT && (1..=LIMIT).contains(&found.under), "{found:?}");
            for other_under in (1..=LIMIT).step_by(7) {
                let other = Fraction { over: (over * other_under / under).min(LIMIT), under: other_under };
                for other in [other, Fraction { over: (other.over + 1).min(LIMIT), ..other }] {
                    assert!(exact.distance(found) * other.under <= exact.distance(other) * found.under, "{other:?}");
                }
            }
        }
    }

    #[test]
    fn times_beyond_the_largest_time_are_limited_to_it() {
        assert_eq!(nearest_fraction(Fraction { over: 100_000, under: 1 }), Fraction { over: 65_535, under: 1 });
    }
}
