//! Slats on the emulated machine.

use super::{PictureTimes, Pipeline, Setup};
use crate::config::{ConfigError, MachineConfig};
use crate::machine::Machine;
use crate::observation::{Arrival, LateRegion, deadline};
use image::RgbImage;
use pphigs::{Binning, Share};
use pxpl5_gp::{CodeVersion, GpTiming, Priority, Stage};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_wire::{Eye, RegionGrid};
use slats::{Config, Copy, host, processor};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Which code runs on the GP: only its time differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// The prototype of 1994 (TR94).
    Of1994,
    /// The code of 1995 (I3D95).
    Of1995,
    /// A third of the time of 1994: code that fits the instruction cache (I3D95).
    Optimised,
}

impl Code {
    const fn timing(self) -> GpTiming {
        match self {
            Self::Of1994 => GpTiming::SLATS_1994,
            Self::Of1995 => GpTiming::SLATS_1995,
            Self::Optimised => GpTiming::SLATS_OPTIMISED,
        }
    }

    const fn version(self) -> CodeVersion {
        match self {
            Self::Of1994 | Self::Of1995 => CodeVersion::Compiled,
            Self::Optimised => CodeVersion::Scheduled,
        }
    }
}

/// One new image every field (TR94, I3D95).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slats {
    /// When regions are copied.
    pub copy: Copy,
    /// Who gets the commands of a clump.
    pub binning: Binning,
    /// The code, where it is not that of the machine's preset.
    pub code: Option<Code>,
}

impl Slats {
    /// The prototype with the COPY optimisation (TR94).
    #[must_use]
    pub const fn split() -> Self {
        Self { copy: Copy::Split, binning: Binning::All, code: None }
    }

    /// The prototype without the COPY optimisation (TR94).
    #[must_use]
    pub const fn whole() -> Self {
        Self { copy: Copy::Whole, binning: Binning::All, code: None }
    }

    /// Whole copies into the other buffer, so that the last complete field stands in for one that is late.
    #[must_use]
    pub const fn backup() -> Self {
        Self { copy: Copy::Backup, binning: Binning::All, code: None }
    }

    fn config(&self, machine: &Machine, pixels: bool) -> Config {
        let ports = machine.ports();
        Config {
            host: ports.host,
            processors: ports.gps.clone(),
            renderers: ports.renderers.clone(),
            frame_buffers: [ports.frame_buffers[0], ports.frame_buffers[1]],
            copy: self.copy,
            binning: self.binning,
            layout: self.layout(),
            pixels,
        }
    }

    fn is_due_before_retrace(&self, arrival: &Arrival) -> bool {
        let top = u32::from(arrival.target.region.0) < RegionGrid::FIELD.columns();
        !self.copy.is_split() || top
    }
}

impl Pipeline for Slats {
    fn name(&self) -> &'static str {
        "slats"
    }

    fn eyes(&self) -> usize {
        2
    }

    fn layout(&self) -> Layout {
        Layout::slats()
    }

    /// The code decides the times per primitive, by the table and by what runs, and nothing else.
    fn adapt(&self, config: MachineConfig) -> MachineConfig {
        let Some(code) = self.code else { return config };
        let GpTiming { triangle_ns, sphere_ns, bin_entry_ns, .. } = code.timing();
        let gp = GpTiming { triangle_ns, sphere_ns, bin_entry_ns, ..config.gp };
        MachineConfig { gp, code: Some(code.version()), ..config }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError> {
        let config = self.config(machine, setup.pixels);
        let binding = config.check().map_err(|error| ConfigError::Board(error.to_string()))?;
        let (foreground, views) = (Priority::Foreground, setup.views.clone());
        let gp = machine.processor(config.host, foreground);
        let program = host(gp, config.clone(), setup.host, move |update, time| views(update, time));
        machine.load(config.host, foreground, Box::pin(program));
        for (index, node) in config.processors.iter().enumerate() {
            let gp = machine.processor(*node, foreground);
            let share = Share::new(Arc::clone(&setup.list), index, config.processors.len());
            for (level, program) in processor(&gp, &config, &binding, share, index) {
                machine.load(*node, level, Box::pin(program));
            }
        }
        Ok(())
    }

    fn pictures(&self, machine: &Machine, end: Time) -> Vec<PictureTimes> {
        let observation = machine.observation();
        let late: BTreeSet<u64> = self.late_regions(machine, end).iter().map(|region| region.field).collect();
        let mut arrivals: BTreeMap<u64, (usize, Time)> = BTreeMap::new();
        for arrival in &observation.arrivals {
            let entry = arrivals.entry(arrival.target.picture).or_default();
            *entry = (entry.0 + 1, entry.1.max(arrival.last_part_at));
        }
        let leader = machine.ports().gps[0];
        let begun = observation.marks.iter().filter(|mark| mark.stage == Stage::Sample && mark.node == leader);
        let times = begun.map(|mark| {
            let (regions, copied_at) = arrivals.get(&mark.picture).copied().unwrap_or_default();
            let whole = regions == 2 * RegionGrid::FIELD.regions() as usize;
            PictureTimes {
                picture: mark.picture,
                view: mark.view.unwrap_or(mark.picture),
                sampled_at: Some(mark.time),
                transform_at: mark.time,
                copied_at: whole.then_some(copied_at),
                shown_at: machine.video().retrace(mark.picture),
                complete: whole && !late.contains(&mark.picture),
            }
        });
        // A field whose bottom half is still being scanned is judged by the next run.
        let judged = |times: &PictureTimes| machine.video().retrace(times.picture + 1) <= end;
        times.filter(judged).collect()
    }

    fn late_regions(&self, machine: &Machine, end: Time) -> Vec<LateRegion> {
        let arrivals = machine.observation().arrivals.iter().filter(|arrival| arrival.last_part_at < end);
        let late = arrivals.filter_map(|arrival| {
            let due = deadline(machine.video(), &arrival.target, self.is_due_before_retrace(arrival));
            let region = LateRegion {
                field: arrival.target.picture,
                eye: Eye::BOTH[arrival.board.min(1)],
                region: arrival.target.region.0,
                lateness: arrival.last_part_at.since(due),
            };
            (arrival.last_part_at > due).then_some(region)
        });
        late.collect()
    }

    /// Fields of which something was late or missing, and fields that were left out.
    fn missed_retraces(&self, pictures: &[PictureTimes]) -> u64 {
        let (Some(first), Some(last)) = (pictures.first(), pictures.last()) else { return 0 };
        let complete = pictures.iter().filter(|times| times.complete).count() as u64;
        last.picture - first.picture + 1 - complete
    }

    fn latency_definition(&self) -> &'static str {
        "from the retrace at which the newest view is taken and TRANSFORM starts to the retrace from which on the field is scanned out"
    }

    fn missed_definition(&self) -> &'static str {
        "fields of which a region came after its deadline (the retrace; for the bottom regions of a split copy the scan of their first line), or that were left out"
    }

    fn picture(&self, machine: &Machine, eye: Eye) -> Option<RgbImage> {
        let frame_buffer = machine.frame_buffers().get(eye.index())?;
        let last = frame_buffer.last_seen()?;
        let before = frame_buffer.seen(last.field().checked_sub(1)?)?;
        Some(last.interlaced_with(&before))
    }
}
