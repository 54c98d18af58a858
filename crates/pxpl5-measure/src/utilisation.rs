//! Share of time for which each board was busy, over a whole run.

use pxpl5_gp::GpUse;
use pxpl5_machine::Record;
use pxpl5_run::Stepper;
use pxpl5_sim::{Span, Time};
use serde::Serialize;
use std::fmt;

/// Share of time for which boards were busy, 0 to 1, from the start of the machine to the end of the run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Utilisation {
    /// Duration of the run, to which the shares refer, in milliseconds of simulated time.
    pub of_ms: f64,
    /// Share of time for which the host's CPU was busy.
    pub host: f64,
    /// Shares of time for which the graphics processors were busy, including the master.
    pub gps: GpUtilisation,
    /// Shares of time for which the renderers' controllers were busy.
    pub renderers: RendererUtilisation,
    /// Share of time for which the ring's channels were occupied, and the ring's data rate.
    pub ring: RingUtilisation,
    /// Shares of time for which the ring ports of displays were busy, in the order of the displays.
    pub ports: PortUtilisation,
}

/// Shares of time for which the boards of one kind were busy, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// Mean share over all boards.
    pub mean: f64,
    /// Share of the busiest board.
    pub max: f64,
    /// Index of the busiest board, counted from 0.
    pub busiest: usize,
    /// Number of boards that were busy for less than 1 % of the time.
    pub idle: usize,
}

impl Shares {
    /// Returns the shares of `time` for which boards were busy. `spans` has the busy time of each board. Returns `None`
    /// if there is no board or if `time` is zero.
    pub fn of(spans: impl IntoIterator<Item = Span>, time: Time) -> Option<Self> {
        let shares: Vec<f64> = spans.into_iter().map(|span| share(span, time)).collect();
        let (busiest, max) = shares.iter().copied().enumerate().rev().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        let idle = shares.iter().filter(|share| **share < IDLE).count();
        (time > Time::ZERO).then_some(Self { mean, max, busiest, idle })
    }
}

/// Share of the time below which a board counts as idle (assumed: the messages of a board without work take less time).
const IDLE: f64 = 0.01;

/// Shares of CPU time of the graphics processors, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GpUtilisation {
    /// Share of time for all work of the CPUs.
    pub busy: Shares,
    /// Mean share of time for work such as EDIT and TRANSFORM.
    pub work: f64,
    /// Mean share of time for the software that receives and sends messages.
    pub messages: f64,
    /// Mean share of time for sending bins to renderers. A graphics processor sends a bin when it has the token of the
    /// bin's region.
    pub tokens: f64,
}

/// Shares of time of the renderers' controllers, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RendererUtilisation {
    /// Share of time in which a renderer's controller executed commands.
    pub executing: Shares,
    /// Mean share of time in which a copy command occupied a renderer's controller.
    pub copying: f64,
    /// Mean share of time in which a renderer's controller waited for commands.
    pub waiting: f64,
}

/// Share of time in which channels of the ring were occupied, and data rates in words per second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RingUtilisation {
    /// Share of time in which a channel was occupied, including overhead and stalls.
    pub channels: Shares,
    /// Number of words per second that the ring carried in messages, without overhead.
    pub words_per_second: f64,
    /// Number of words per second that all channels of the ring together could carry.
    pub capacity: f64,
}

/// Shares of time for which the ring ports of displays were busy, 0 to 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PortUtilisation {
    /// Mean and maximum over all ports of the share of time for which a port was busy.
    pub busy: Shares,
    /// Share of time for which each port was busy.
    pub each: Vec<PortShare>,
}

/// Share of time for which one port was busy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PortShare {
    /// Title of the surface whose pixels the port receives, or the display's name with the port's index.
    pub port: String,
    /// Share of time in which messages arrived, 0 to 1.
    pub busy: f64,
}

impl Utilisation {
    /// Returns the shares of time for which the boards were busy in a finished run. Returns `None` for a machine that
    /// has not run.
    pub fn of(record: &Record) -> Option<Self> {
        Self::until(record, record.elapsed(), record.processors_used())
    }

    /// Returns the shares of time for which the boards were busy from the start of a run up to now. Returns `None` at
    /// time zero.
    ///
    /// The time of a message on the ring is added when the message ends.
    pub fn so_far(run: &Stepper) -> Option<Self> {
        Self::until(run.record(), run.now(), &run.machine().processors_used(run.now()))
    }

    /// Returns the shares of time for which the boards were busy from the start of the machine to an instant. `used` is
    /// the CPU time of the host and of each graphics processor up to this instant.
    fn until(record: &Record, time: Time, used: &[GpUse]) -> Option<Self> {
        let (host, gps) = used.split_first()?;
        let mean = |spans: &mut dyn Iterator<Item = Span>| mean_share(spans, time);
        let renderers = record.renderers();
        // A renderer executes, copies or waits. The share of waiting is the remainder.
        let executing = Shares::of(renderers.iter().map(|board| board.busy_at(time)), time)?;
        let copying = mean(&mut renderers.iter().map(|board| board.copying_at(time)));
        let timing = record.ring().timing();
        let stats = record.ring().stats();
        let word_s = timing.word().as_ms() / 1e3;
        Some(Self {
            of_ms: time.since(Time::ZERO).as_ms(),
            host: share(host.busy, time),
            gps: GpUtilisation {
                busy: Shares::of(gps.iter().map(|gp| gp.busy), time)?,
                work: mean(&mut gps.iter().map(|gp| gp.work())),
                messages: mean(&mut gps.iter().map(|gp| gp.messages)),
                tokens: mean(&mut gps.iter().map(|gp| gp.tokens)),
            },
            renderers: RendererUtilisation { executing, copying, waiting: (1.0 - executing.mean - copying).max(0.0) },
            ring: RingUtilisation {
                channels: Shares::of(stats.channel_busy.iter().copied(), time)?,
                words_per_second: stats.words as f64 * 1e3 / time.since(Time::ZERO).as_ms(),
                capacity: timing.channels as f64 / word_s,
            },
            ports: PortUtilisation::of(record, time)?,
        })
    }
}

impl PortUtilisation {
    fn of(record: &Record, time: Time) -> Option<Self> {
        let mut each = Vec::new();
        let mut spans = Vec::new();
        for (display, ports) in record.displays().iter().zip(&record.ports().displays) {
            let is_one_each = ports.len() == display.surfaces().len();
            for (number, port) in ports.iter().enumerate() {
                let title = display.surfaces().get(number).filter(|_| is_one_each).map(|surface| surface.title);
                let port_name = title.map_or_else(|| format!("{} port {number}", display.name()), str::to_owned);
                let span = record.ring().receiving(*port);
                each.push(PortShare { port: port_name, busy: share(span, time) });
                spans.push(span);
            }
        }
        Some(Self { busy: Shares::of(spans, time)?, each })
    }
}

impl fmt::Display for Utilisation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { gps, renderers, ring, ports, .. } = self;
        writeln!(
            f,
            "Busy GPs: {} (work {}, messages {}, tokens {})",
            shares_text(&gps.busy, "GP"),
            percent(gps.work),
            percent(gps.messages),
            percent(gps.tokens)
        )?;
        writeln!(
            f,
            "Busy renderers: {} (copying {}, waiting for commands {})",
            shares_text(&renderers.executing, "renderer"),
            percent(renderers.copying),
            percent(renderers.waiting)
        )?;
        writeln!(
            f,
            "Busy ring: {} ({:.1} of {:.0} million words a second)",
            shares_text(&ring.channels, "channel"),
            ring.words_per_second / 1e6,
            ring.capacity / 1e6
        )?;
        let ports: Vec<String> =
            ports.each.iter().map(|port| format!("{} {}", port.port, percent(port.busy))).collect();
        write!(f, "Busy ports: {}; host {}", ports.join(", "), percent(self.host))
    }
}

fn shares_text(shares: &Shares, board: &str) -> String {
    let idle = if shares.idle > 0 { format!(", {} idle", shares.idle) } else { String::new() };
    format!("mean {}, {board} {} {}{idle}", percent(shares.mean), shares.busiest, percent(shares.max))
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

fn share(span: Span, time: Time) -> f64 {
    (span.0 as f64 / time.0 as f64).min(1.0)
}

fn mean_share(spans: &mut dyn Iterator<Item = Span>, time: Time) -> f64 {
    let (count, sum) = spans.fold((0usize, 0.0), |(count, sum), span| (count + 1, sum + share(span, time)));
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_name_the_first_busiest_board_and_count_the_idle_ones() {
        let spans = [10, 90, 0, 90].map(Span);
        let shares = Shares::of(spans, Time(100)).expect("four boards");
        assert_eq!(shares, Shares { mean: 0.475, max: 0.9, busiest: 1, idle: 1 });
    }

    #[test]
    fn without_time_or_boards_there_are_no_shares() {
        assert_eq!(Shares::of([], Time(100)), None);
        assert_eq!(Shares::of([Span(0)], Time::ZERO), None);
    }

    /// Tests a busy time that exceeds the time of the run. A message counts at its end, so it may end a few
    /// microseconds after the run.
    #[test]
    fn the_busy_share_of_a_board_is_at_most_one() {
        assert_eq!(share(Span(101), Time(100)), 1.0);
    }
}
