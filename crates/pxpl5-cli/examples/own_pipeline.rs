//! A complete example of a pipeline in a crate outside pxpl5. One graphics processor draws mono frames and shows each
//! frame when it is finished. The example is also a command `pxpl5` that includes this pipeline.
//!
//! `docs/guide/own-pipeline.md` explains the example. To run it:
//! `cargo run --release -p pxpl5-cli --example own_pipeline -- run --pipeline one-at-a-time --scene mig`.

use pxpl5_cli::pxpl5::device::Display;
use pxpl5_cli::pxpl5::firmware::{
    Body, CopyContent, CopyOrder, CopyPath, CopyTarget, DisplayList, Fault, FrameView, Gp, Layout, Lines, Picture,
    PictureNumber, Priority, RegionBinning, RegionEnvelope, RegionId, Shading, Share, Stage, ViewNumber, Viewport,
    region_messages, swap_request,
};
use pxpl5_cli::pxpl5::{
    Goal, Key, KeyValue, KeyValues, LimitCriterion, Machine, PictureResult, PictureRules, PictureTimes, Pipeline,
    PipelineEntry, PipelineProperties, PipelineSettings, Ports, Record, Registry, SettingError, Setup, Span, TestScene,
    Time,
};
use std::process::ExitCode;
use std::sync::Arc;

/// A simple pipeline: one processor draws one frame at a time.
#[derive(Debug)]
struct OneAtATime {
    shading: Shading,
}

impl OneAtATime {
    /// Returns a picture with the size of the display's first surface, such as 640 x 480 pixels.
    fn picture(&self, display: &dyn Display) -> Result<Picture, SettingError> {
        let grid = display.surfaces()[0].grid();
        Ok(Picture {
            viewport: Viewport::new(grid, Lines::Frame)?,
            shading: self.shading,
            binning: RegionBinning::Touched,
            layout: self.properties().layout,
            pixels: true,
        })
    }
}

// ANCHOR: firmware
/// The firmware. Every `.await` takes simulated time or waits.
async fn firmware(
    gp: Gp,
    ports: Ports,
    list: Arc<DisplayList>,
    picture: Picture,
    mut view: impl FnMut(ViewNumber, Time) -> FrameView,
) -> Result<(), Fault> {
    let share = Share::new(list, 0, 1);
    let frame_buffer = ports.display()[0];
    for frame in PictureNumber::FIRST.onwards() {
        // TRANSFORM: the code transforms the triangles. The timing table gives the time of this work.
        gp.begin(Stage::Sample, frame, None);
        gp.begin(Stage::Transform, frame, None);
        let view = view(ViewNumber::taken_for(frame), gp.now());
        let pass = share.transform(&view, 0, picture);
        let counts = share.counts();
        gp.spend(Span::from_ns(gp.timing().triangle_ns) * u64::from(counts.triangles)).await;
        gp.spend(Span::from_ns(gp.timing().bin_entry_ns) * pass.entries()).await;
        gp.end(Stage::Transform, frame, None);

        // RENDER and COPY: one renderer draws each region, copies the region and sends an acknowledgement.
        let grid = picture.viewport.grid();
        let buffer = (frame.next().0 % 2) as u8;
        for region in (0..grid.regions() as u16).map(RegionId) {
            let target = CopyTarget { frame_buffer, buffer, lines: Lines::Frame, grid, region, picture: frame };
            let copy = CopyOrder {
                target,
                context: 0,
                way: CopyPath::ThroughBacking,
                acknowledge: Some(gp.node()),
                content: CopyContent::Colour,
            };
            let envelope = RegionEnvelope { begin: true, shade: true, copy: Some(copy) };
            let renderer = ports.renderers[usize::from(region.0) % ports.renderers.len()];
            for message in region_messages(&pass, region, 0, envelope) {
                gp.clump_buffer_free().await;
                gp.send(renderer, message.words(), Body::Commands(message)).await;
            }
        }
        for _ in 0..grid.regions() {
            gp.receive().await;
        }

        // Request the swap at the next retrace, and wait for the swap.
        let request = gp.send(frame_buffer, 2, Body::Words(swap_request(buffer))).await;
        gp.accepted(request).await;
        gp.until("the swap", || (gp.status(frame_buffer) > frame.0).then_some(())).await;
    }
    Ok(())
}
// ANCHOR_END: firmware

impl Pipeline for OneAtATime {
    fn name(&self) -> &'static str {
        ONE_AT_A_TIME.name
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let shading = if self.shading == Shading::Phong { "phong" } else { "gouraud" };
        vec![("shading", KeyValue::Name(shading))]
    }

    fn properties(&self) -> PipelineProperties {
        let latency = "from the start of TRANSFORM to the retrace at which the frame is swapped in";
        let due = "no frame is ever due: each is shown when it is finished";
        PipelineProperties::new(Layout::rendering_control_phong(), latency, due)
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let ports = machine.ports().clone();
        let views = Arc::clone(&setup.views);
        let node = ports.gps[0];
        let gp = machine.processor(node, Priority::Foreground);
        let view = move |number, time| views.newest(number, time);
        let picture = self.picture(machine.record().display())?;
        let program = firmware(gp, ports, Arc::clone(&setup.list), picture, view);
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }
}

impl PictureRules for OneAtATime {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let shown = record.observation().frames(1).into_values();
        let begun = record.observation().marks.iter().filter(|mark| mark.stage == Stage::Sample);
        let times = begun.zip(shown).map(|(mark, tick)| PictureTimes {
            picture: mark.picture,
            view: ViewNumber::taken_for(mark.picture),
            sampled_at: Some(mark.time),
            transform_at: mark.time,
            copied_at: None,
            shown_at: record.tick(tick),
            end: PictureResult::Shown,
            layer: 0,
        });
        times.filter(|times| times.shown_at < end).collect()
    }
}

// ANCHOR: entry
const ONE_AT_A_TIME: PipelineEntry = PipelineEntry {
    name: "one-at-a-time",
    family: "one-at-a-time",
    about: "one processor, one frame at a time",
    preset: "small-hmd",
    keys: &[Key::new("shading", "method of shading", KeyValues::Names(&["phong", "gouraud"]))],
    build: |settings| {
        let gouraud = settings.name("shading") == Some("gouraud");
        Arc::new(OneAtATime { shading: if gouraud { Shading::Gouraud } else { Shading::Phong } })
    },
    limit: |_: &PipelineSettings| LimitCriterion {
        goal: Goal::LatencyFields(2.5),
        scene: TestScene::Typical,
        fields: 40,
    },
    tables: &[],
    closed_form: None,
    compared: true,
};
// ANCHOR_END: entry

// ANCHOR: main
fn main() -> ExitCode {
    let mut registry: Registry = (*pxpl5_cli::pxpl5::registry()).clone();
    registry.add(ONE_AT_A_TIME);
    pxpl5_cli::main(Arc::new(registry))
}
// ANCHOR_END: main
