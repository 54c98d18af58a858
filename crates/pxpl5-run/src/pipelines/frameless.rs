use super::jitp::{TABLES, config, load, whole_pass};
use super::{ntsc, sampled_at, samples};
use crate::keys::PipelineSettings;
use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use crate::result::picture_ends::PictureResult;
use jitp::{BlockOrder, DrawingSchedule, JitpConfig};
use pphigs::TransformCost;
use pxpl5_framebuffer::Video;
use pxpl5_gp::Priority;
use pxpl5_machine::{Arrival, Machine, Record};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{Key, KeyValue, KeyValues, SettingError};
use pxpl5_wire::{CopyTarget, PictureNumber, RegionGrid, RegionId};
use std::collections::BTreeMap;
use std::sync::Arc;
use tracking::view::RandomOrder;

/// The pipeline of frameless rendering, which draws small blocks of pixels in a random order.
///
/// Each batch of blocks uses the newest view and is shown immediately, without a swap. Every block is drawn once before
/// any block is drawn again. The papers update single pixels, but a message with a single pixel would take 17 words on
/// the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frameless {
    /// Width and height of a block, 4 to 128 pixels.
    pub block: u32,
    /// Number of blocks that are drawn with one view. With 0, the pipeline chooses the number at which the ring and the
    /// graphics processors are equally busy.
    pub batch: u32,
    /// Seed of the random order of blocks.
    pub seed: u64,
}

impl Frameless {
    /// Creates a pipeline with blocks of 16 x 16 pixels. The message of such a block has 16 words of overhead and 256
    /// words of pixels.
    pub const fn new() -> Self {
        Self { block: 16, batch: 0, seed: 1 }
    }

    /// Returns the number of blocks that are drawn with one view. With the default number, the ring sends the blocks of
    /// all slaves in the same time as one slave transforms the scene.
    fn batch(&self, record: &Record, pass: TransformCost, runs_code: bool) -> u32 {
        if self.batch > 0 {
            return self.batch;
        }
        if runs_code {
            return BATCH_OF_CODE;
        }
        let ports = record.ports();
        let ring = record.ring().timing();
        let timing = record.config().gp;
        // A slave spends the software time of three messages in addition to its pass.
        let slave_ns = pass.ns(&timing) + 3 * timing.message_ns;
        let block_ns = ring.occupancy(self.block * self.block).0 / 1_000;
        let slaves = ports.gps.len().saturating_sub(1).max(1) as u64;
        // The ring sends the blocks of all slaves while one slave transforms.
        (slave_ns / (slaves * block_ns)).clamp(MIN_BATCH, MAX_BATCH) as u32
    }

    /// Returns the number of blocks of a picture.
    pub fn blocks(&self) -> u32 {
        self.grid().regions()
    }

    fn grid(&self) -> RegionGrid {
        RegionGrid { region_width: self.block, region_height: self.block, ..RegionGrid::FRAME }
    }

    fn order(&self) -> Result<BlockOrder, SettingError> {
        let order = RandomOrder::new(self.blocks(), self.seed)?;
        Ok(BlockOrder::new(move |step| RegionId(order.pixel(step) as u16)))
    }
}

impl Default for Frameless {
    fn default() -> Self {
        Self::new()
    }
}

/// Smallest and largest number of blocks in a batch (assumed). In smaller batches, the master would be the bottleneck,
/// because each order takes 24 us. In larger batches, the view would become too old.
const MIN_BATCH: u64 = 4;
const MAX_BATCH: u64 = 64;

/// Number of blocks in a batch at the cycle level (assumed; see kernels/order_rules.md in the crate pphigs). The number
/// is fixed, because the time of the code is unknown in advance.
const BATCH_OF_CODE: u32 = 16;

fn next_light(video: &Video, target: &CopyTarget, after: Time) -> Time {
    let now = video.field_at(after);
    let reached = now.until(now.after(3)).filter_map(|field| video.reaches(target, field)).find(|at| *at >= after);
    reached.unwrap_or(after)
}

impl Pipeline for Frameless {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        vec![
            ("block", KeyValue::Whole(self.block.into())),
            ("batch", KeyValue::Whole(self.batch.into())),
            ("order_seed", KeyValue::Whole(self.seed)),
        ]
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties {
            knows_when_seen: true,
            without_code: None,
            has_one_pose: false,
            can_discard_records: true,
            ..PipelineProperties::new(
                Layout::slats(),
                "from the order of a batch of blocks, for which the newest pose is taken, to the first light of its last block",
                "no picture is ever due: each block is shown when it arrives, and there are no frames",
            )
        }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        if !(4..=128).contains(&self.block) {
            return Err(SettingError::limits("block of frameless rendering, pixels", (4, 128), self.block));
        }
        let master = machine.record().ports().gps[0];
        let runs_code = machine.processor(master, Priority::Foreground).runs_code();
        let batch = self.batch(machine.record(), whole_pass(setup), runs_code);
        let schedule = DrawingSchedule::Roam { block: self.block, batch, order: self.order()? };
        let config = config(self.name(), machine.record(), schedule, Layout::slats(), setup.pixels)?;
        let config = JitpConfig { aim: setup.aim, ..config };
        load(machine, setup, &config);
        Ok(())
    }
}

impl PictureRules for Frameless {
    /// Returns one entry for each batch of blocks. The last block to arrive defines the times of its batch.
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let Ok(display) = ntsc(record, self.name()) else { return Vec::new() };
        let observation = record.observation();
        let video = display.video();
        let last = last_blocks(&observation.arrivals);
        // An update is complete when its number of arrived blocks equals the number of blocks of the largest update.
        let batch = observation.most_regions_of_a_picture().max(1);
        let times = samples(record).filter_map(|mark| {
            let (blocks, copied_at, target) = last.get(&mark.picture)?;
            let shown_at = next_light(video, target, *copied_at);
            Some(sampled_at(mark, Some(*copied_at), shown_at, PictureResult::of(*blocks == batch, true)))
        });
        let mut times: Vec<_> = times.filter(|times| times.is_shown() && times.shown_at <= end).collect();
        // The order in which updates are shown may differ from the order of their numbers.
        times.sort_by_key(|times| (times.shown_at, times.picture));
        times
    }

    fn light(&self, _: &Record, times: &PictureTimes) -> Time {
        times.shown_at
    }

    fn updates_per_picture(&self, record: &Record) -> f64 {
        f64::from(self.blocks()) / f64::from(record.observation().most_regions_of_a_picture().max(1))
    }
}

/// Returns for each batch the number of arrived blocks, and the time and target of the last arrival.
///
/// If two blocks arrive at the same instant, the block with the higher port and region counts as the last. The result
/// is therefore independent of the order of the records.
fn last_blocks(arrivals: &[Arrival]) -> BTreeMap<PictureNumber, (u32, Time, CopyTarget)> {
    let mut last: BTreeMap<PictureNumber, (u32, Time, CopyTarget)> = BTreeMap::new();
    for Arrival { last_part_at, target, .. } in arrivals {
        let (count, at, of) = last.entry(target.picture).or_insert((0, *last_part_at, *target));
        *count += 1;
        if (*last_part_at, target.frame_buffer, target.region) > (*at, of.frame_buffer, of.region) {
            (*at, *of) = (*last_part_at, *target);
        }
    }
    last
}

pub(super) const ENTRY: PipelineEntry = PipelineEntry {
    name: "frameless",
    family: "frameless",
    about: "blocks in random order, each with the newest view, shown at once (frameless rendering, 1994)",
    preset: "small-hmd",
    keys: &[
        Key::new("block", "width and height of a block", KeyValues::Whole(4, 128))
            .with_unit("pixels")
            .with_default("16"),
        Key::new(
            "batch",
            "number of blocks drawn with one view; 0 keeps ring and processors equally busy",
            KeyValues::Whole(0, 65_535),
        )
        .with_default("0"),
        Key::new("order_seed", "seed of the order of the blocks", KeyValues::Whole(0, i64::MAX as u64))
            .with_default("1"),
    ],
    build,
    limit: |_| LimitCriterion { goal: Goal::RateHz(30.0), scene: TestScene::FullScreen, fields: 24 },
    tables: TABLES,
    closed_form: None,
    compared: true,
};

fn build(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let new = Frameless::new();
    Arc::new(Frameless {
        block: settings.whole("block").map_or(new.block, |block| block as u32),
        batch: settings.whole("batch").map_or(new.batch, |batch| batch as u32),
        seed: settings.whole("order_seed").unwrap_or(new.seed),
    })
}

#[cfg(test)]
mod tests {
    use super::last_blocks;
    use pxpl5_machine::Arrival;
    use pxpl5_sim::Time;
    use pxpl5_wire::{CopyTarget, Lines, NodeId, PictureNumber, RegionGrid, RegionId, SurfaceId};

    /// Returns a block of update 3 that arrives at `port` after `ns` nanoseconds.
    fn block(port: u16, region: u16, ns: u64) -> Arrival {
        let target = CopyTarget {
            frame_buffer: NodeId(port),
            buffer: 0,
            lines: Lines::Frame,
            grid: RegionGrid { region_width: 16, region_height: 16, ..RegionGrid::FRAME },
            region: RegionId(region),
            picture: PictureNumber(3),
        };
        let at = Time(ns * 1_000);
        Arrival { surface: SurfaceId(port - 20), target, first_part_at: at, last_part_at: at }
    }

    #[test]
    fn the_order_of_simultaneous_arrivals_does_not_change_the_last_block_of_a_pass() {
        let [a, b, c] = [block(20, 7, 90), block(20, 9, 100), block(21, 4, 100)];
        for order in [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
            let last = last_blocks(&order);
            assert_eq!(last.into_iter().collect::<Vec<_>>(), [(PictureNumber(3), (3, c.last_part_at, c.target))]);
        }
    }
}
