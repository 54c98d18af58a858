use super::{Contexts, Machine};
use crate::agenda::schedule_own;
use crate::event::Event;
use crate::observation::{Arrival, Observation, Swap};
use pxpl5_gp::GpEvent;
use pxpl5_sim::{EventQueue, Phase, Time};
use pxpl5_wire::display::{DisplayEvent, DisplayOutput};
use pxpl5_wire::{NodeId, PeriodNumber, SurfaceId};
use std::collections::BTreeMap;

impl Machine {
    pub(super) fn display_event(&mut self, now: Time, display: usize, event: DisplayEvent) {
        let Self { record, contexts: Contexts { display: context, .. }, queue, swaps, .. } = self;
        let first_surface = record.first_surface(display);
        record.displays[display].handle(event, context.at(now));
        schedule_own(queue, context, |event| Event::Display(display, event));
        // Record every output in the trace and in the observation.
        for (time, output) in context.drain_outputs() {
            match output {
                DisplayOutput::RegionArrived { surface, target, first_part_at, last_part_at } => {
                    let surface = SurfaceId((first_surface + surface) as u16);
                    let facts = [5, u64::from(surface.0), u64::from(target.region.0), target.picture.0];
                    record.hash.record(last_part_at, &facts);
                    record.observation.arrivals.push(Arrival { surface, target, first_part_at, last_part_at });
                }
                DisplayOutput::Swapped { surface, buffer, tick } => {
                    let port = record.ports.displays[display][surface];
                    let surface = SurfaceId((first_surface + surface) as u16);
                    record.hash.record(time, &[6, u64::from(surface.0), u64::from(buffer), tick.0]);
                    note_swap(&mut record.observation, queue, swaps, (time, surface, port, tick, buffer));
                }
                // A swap of a part of a surface. The part has its own port.
                DisplayOutput::Updated { surface, port, buffer, tick } => {
                    let surface = SurfaceId((first_surface + surface) as u16);
                    record.hash.record(time, &[7, u64::from(port.0), u64::from(buffer), tick.0]);
                    note_swap(&mut record.observation, queue, swaps, (time, surface, port, tick, buffer));
                }
            }
        }
    }
}

/// Records that port `port` of a surface shows buffer `buffer` from the display period `tick` on. Also signals the swap
/// to the first graphics processor.
fn note_swap(
    observation: &mut Observation,
    queue: &mut EventQueue<Event>,
    swaps: &mut BTreeMap<NodeId, u64>,
    (time, surface, port, tick, buffer): (Time, SurfaceId, NodeId, PeriodNumber, u8),
) {
    let so_far = swaps.entry(port).or_default();
    observation.swaps.push(Swap { surface, port, number: *so_far, tick, buffer });
    *so_far += 1;
    let status = GpEvent::Status { from: port, value: *so_far };
    queue.schedule(time, Phase::Arrive, Event::Gp(1, status));
}
