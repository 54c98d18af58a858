//! A pipeline of one's own, complete: one graphics processor draws mono frames, each shown as soon as it is finished.
//!
//! `docs/guide/own-pipeline.md` explains it. It ends in assertions; `cargo run --release --example own_pipeline`.

use pphigs::{Around, Binning, DisplayList, FrameView, Picture, Shading, Share, region_messages};
use pxpl5::pipelines::{PictureTimes, Setup};
use pxpl5::{ConfigError, Experiment, Eye, LateRegion, Machine, MachineConfig, Pipeline, Pixels, Ports, scene};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Fault, Gp, Priority, Stage};
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, CopyOrder, CopyTarget, Lines, RegionId, swap_request};
use std::sync::Arc;

/// One processor, one frame at a time: the simplest thing that can work.
#[derive(Debug)]
struct OneAtATime;

const PICTURE: Picture = Picture {
    viewport: Viewport::FRAME,
    shading: Shading::Phong,
    binning: Binning::Touched,
    layout: Layout::rendering_control_phong(),
    pixels: true,
};

/// The firmware. Every `.await` costs simulated time or waits.
async fn firmware(
    gp: Gp,
    ports: Ports,
    list: Arc<DisplayList>,
    mut view: impl FnMut(u64, Time) -> FrameView,
) -> Result<(), Fault> {
    let (share, frame_buffer) = (Share::new(list, 0, 1), ports.frame_buffers[0]);
    for frame in 0.. {
        // TRANSFORM: what is computed is real, its time comes from the timing table.
        gp.begin(Stage::Sample, frame, None);
        gp.begin(Stage::Transform, frame, None);
        let pass = share.transform(&view(frame, gp.now()), 0, PICTURE);
        let counts = share.counts();
        gp.spend(Span::from_ns(gp.timing().triangle_ns) * u64::from(counts.triangles)).await;
        gp.spend(Span::from_ns(gp.timing().bin_entry_ns) * pass.entries()).await;
        gp.end(Stage::Transform, frame, None);

        // RENDER and COPY: every region goes to one renderer, which copies it when it is drawn and tells us.
        let (grid, buffer) = (PICTURE.viewport.grid(), ((frame + 1) % 2) as u8);
        for region in (0..grid.regions() as u16).map(RegionId) {
            let target = CopyTarget { frame_buffer, buffer, lines: Lines::Frame, grid, region, picture: frame };
            let copy = CopyOrder { target, context: 0, through_backing: true, acknowledge: Some(gp.node()) };
            let around = Around { begin: true, shade: true, copy: Some(copy) };
            let renderer = ports.renderers[usize::from(region.0) % ports.renderers.len()];
            for message in region_messages(&pass, region, 0, around) {
                gp.clump_buffer_free().await;
                gp.send(renderer, message.words(), Body::Commands(message)).await;
            }
        }
        for _ in 0..grid.regions() {
            gp.receive().await;
        }

        // Swap at the next retrace, and wait for it.
        let request = gp.send(frame_buffer, 2, Body::Words(swap_request(buffer))).await;
        gp.accepted(request).await;
        gp.until("the swap", || (gp.status(frame_buffer) > frame).then_some(())).await;
    }
    Ok(())
}

impl Pipeline for OneAtATime {
    fn name(&self) -> &'static str {
        "one-at-a-time"
    }

    fn eyes(&self) -> usize {
        1
    }

    fn layout(&self) -> Layout {
        PICTURE.layout
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError> {
        let (ports, views) = (machine.ports().clone(), setup.views.clone());
        let gp = machine.processor(ports.gps[0], Priority::Foreground);
        let node = ports.gps[0];
        let program = firmware(gp, ports, Arc::clone(&setup.list), move |frame, time| views(frame, time));
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }

    fn pictures(&self, machine: &Machine, end: Time) -> Vec<PictureTimes> {
        let shown = machine.observation().swap_fields(1);
        let begun = machine.observation().marks.iter().filter(|mark| mark.stage == Stage::Sample);
        let times = begun.zip(shown).map(|(mark, field)| PictureTimes {
            picture: mark.picture,
            view: mark.picture,
            sampled_at: Some(mark.time),
            transform_at: mark.time,
            copied_at: None,
            shown_at: machine.video().retrace(field),
            complete: true,
        });
        times.filter(|times| times.shown_at < end).collect()
    }

    fn late_regions(&self, _: &Machine, _: Time) -> Vec<LateRegion> {
        Vec::new()
    }

    fn missed_retraces(&self, _: &[PictureTimes]) -> u64 {
        0
    }

    fn latency_definition(&self) -> &'static str {
        "from the start of TRANSFORM to the retrace at which the frame is swapped in"
    }

    fn missed_definition(&self) -> &'static str {
        "frames are shown whenever they are finished, so none is missed"
    }

    fn picture(&self, machine: &Machine, eye: Eye) -> Option<image::RgbImage> {
        Some(machine.frame_buffers().get(eye.index())?.displayed_frame().picture())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mig = scene::builtin("mig")?;
    let experiment = Experiment::new(MachineConfig::small_hmd(), OneAtATime, mig).fields(60).pixels(Pixels::Lazy);
    let outcome = experiment.run()?;

    // TRANSFORM takes at least 417 x 21.7 us = 9.05 ms, and COPY at least 300 x 52 us = 15.6 ms, one after the other:
    // more than a field and less than two, so a frame that starts just after a retrace is shown at the second one.
    let latency = outcome.latency_ms();
    assert!(latency.min >= 9.05 + 15.6, "{latency:?}");
    assert!((outcome.latency_fields().mean - 2.0).abs() < 1e-4, "{latency:?}");

    // The aircraft is there: not all pixels have the colour of the first one.
    let picture = outcome.picture(Eye::Left).ok_or("no picture")?;
    assert!(picture.pixels().any(|pixel| pixel != picture.get_pixel(0, 0)));
    Ok(())
}

#[test]
fn it_runs_and_its_assertions_hold() {
    main().expect("its assertions hold");
}
