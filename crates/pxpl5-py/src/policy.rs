//! A pipeline in which a Python function decides which renderer draws which region, and in which order. This function
//! is called the policy.
//!
//! The firmware of this pipeline is that of docs/guide/own-pipeline.md. One graphics processor draws frames for a
//! single eye and shows each frame as soon as it is finished. TRANSFORM ends before the policy is called, so the policy
//! knows the number of primitives in every region.

use crate::errors::wrong_setting;
use pxpl5::firmware::{
    Body, CopyContent, CopyOrder, CopyPath, CopyTarget, DisplayList, Fault, FrameView, Gp, Layout, Lines, Pass,
    Picture, PictureNumber, Priority, RegionBinning, RegionEnvelope, RegionId, Shading, Share, Stage, ViewNumber,
    Viewport, region_messages, swap_request,
};
use pxpl5::{
    ConfigError, Fingerprint, KeyValue, Machine, PictureResult, PictureTimes, Pipeline, Ports, Record, Setup, Span,
    Time,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// A policy (a Python function that assigns regions to renderers), with the exception that it has raised, if any.
pub(crate) struct Asked {
    policy: Py<PyAny>,
    raised: Mutex<Option<PyErr>>,
}

/// Decision of a policy for one region: the index of the region, and the index of the renderer that draws it.
type Assignment = (u16, usize);

impl Asked {
    pub(crate) fn new(policy: Py<PyAny>) -> Self {
        Self { policy, raised: Mutex::default() }
    }

    /// Returns true if the policy has raised an exception that is not yet reported.
    pub(crate) fn has_raised(&self) -> bool {
        self.raised.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Raises the exception that the policy has raised, if there is one.
    pub(crate) fn check(&self) -> PyResult<()> {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner).take();
        raised.map_or(Ok(()), Err)
    }

    /// Calls the policy for a frame and returns the renderer for each region, in the order of drawing. Returns `None`
    /// if the policy raises an exception.
    fn assignments(&self, frame: PictureNumber, now: Time, pass: &Pass, renderers: usize) -> Option<Vec<Assignment>> {
        let grid = pass.picture().viewport.grid();
        let regions = grid.regions() as u16;
        let primitives: Vec<u32> = (0..regions).map(|region| pass.counts(RegionId(region)).total()).collect();
        // Describe the frame in a dictionary, and call the policy with it.
        let asked = Python::attach(|py| -> PyResult<Vec<Assignment>> {
            let about = PyDict::new(py);
            about.set_item("frame", frame.0)?;
            about.set_item("time_s", now.since(Time::ZERO).as_ms() * 1e-3)?;
            about.set_item("columns", grid.width.div_ceil(grid.region_width))?;
            about.set_item("primitives", primitives)?;
            about.set_item("renderers", renderers)?;
            let found: Vec<Assignment> = self.policy.call1(py, (about,))?.extract(py)?;
            checked(found, regions, renderers)
        });
        asked.map_err(|error| *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error)).ok()
    }
}

/// Checks that the assignments contain every region exactly once and only existing renderers.
fn checked(found: Vec<Assignment>, regions: u16, renderers: usize) -> PyResult<Vec<Assignment>> {
    let mut seen = vec![false; usize::from(regions)];
    for (region, renderer) in &found {
        // An unknown region, a repeated region and an unknown renderer are errors.
        let known = seen.get_mut(usize::from(*region)).filter(|seen| !**seen);
        let Some(known) = known.filter(|_| *renderer < renderers) else {
            return Err(wrong_setting(format!(
                "a policy: expected each of {regions} regions once, for one of {renderers} renderers, found ({region}, {renderer})"
            )));
        };
        *known = true;
    }
    match seen.iter().position(|seen| !seen) {
        Some(missing) => {
            Err(wrong_setting(format!("a policy: expected all {regions} regions, found none for region {missing}")))
        }
        None => Ok(found),
    }
}

/// A pipeline with one graphics processor, which draws one frame at a time. A policy (a Python function) distributes
/// the regions over the renderers.
pub(crate) struct PolicyPipeline {
    asked: Arc<Asked>,
    phong: bool,
    /// Number derived from the name of the policy. It distinguishes policies in the configuration hash.
    name: u64,
}

impl PolicyPipeline {
    pub(crate) fn new(asked: Arc<Asked>, phong: bool) -> Self {
        let name = Python::attach(|py| {
            let name = asked.policy.getattr(py, "__qualname__").and_then(|name| name.extract::<String>(py));
            name.unwrap_or_else(|_| "callable".to_owned())
        });
        let digits = Fingerprint::of(name.as_bytes()).to_string();
        let number = digits.get(..15).and_then(|digits| u64::from_str_radix(digits, 16).ok());
        Self { asked, phong, name: number.unwrap_or_default() }
    }

    fn picture(&self) -> Picture {
        Picture {
            viewport: Viewport::FRAME,
            shading: if self.phong { Shading::Phong } else { Shading::Gouraud },
            binning: RegionBinning::Touched,
            layout: Layout::rendering_control_phong(),
            pixels: true,
        }
    }
}

impl fmt::Debug for PolicyPipeline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PolicyPipeline").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Everything that the firmware needs to draw a frame.
struct Drawing {
    ports: Ports,
    list: Arc<DisplayList>,
    picture: Picture,
    asked: Arc<Asked>,
}

async fn firmware(gp: Gp, drawing: Drawing, mut view: impl FnMut(ViewNumber, Time) -> FrameView) -> Result<(), Fault> {
    let Drawing { ports, list, picture, asked } = drawing;
    let share = Share::new(list, 0, 1);
    let frame_buffer = ports.display()[0];
    for frame in PictureNumber::FIRST.onwards() {
        gp.begin(Stage::Sample, frame, None);
        gp.begin(Stage::Transform, frame, None);
        let view = view(ViewNumber::taken_for(frame), gp.now());
        let pass = share.transform(&view, 0, picture);
        let counts = share.counts();
        // TRANSFORM takes the times that the table has for triangles and bin entries.
        gp.spend(Span::from_ns(gp.timing().triangle_ns) * u64::from(counts.triangles)).await;
        gp.spend(Span::from_ns(gp.timing().bin_entry_ns) * pass.entries()).await;
        gp.end(Stage::Transform, frame, None);
        // After an exception, the firmware stops drawing, and the run ends at the next field.
        let Some(assignments) = asked.assignments(frame, gp.now(), &pass, ports.renderers.len()) else { return Ok(()) };
        let buffer = (frame.next().0 % 2) as u8;
        gp.begin(Stage::Render, frame, None);
        // Send each region to its renderer. The last message of a region contains the copy command.
        for (region, renderer) in &assignments {
            let envelope = envelope(&gp, &picture, (frame_buffer, buffer), RegionId(*region), frame);
            for message in region_messages(&pass, RegionId(*region), 0, envelope) {
                gp.clump_buffer_free().await;
                gp.send(ports.renderers[*renderer], message.words(), Body::Commands(message)).await;
            }
        }
        gp.end(Stage::Render, frame, None);
        // Wait until every copy is acknowledged, then until the frame buffers are swapped.
        for _ in &assignments {
            gp.receive().await;
        }
        let request = gp.send(frame_buffer, 2, Body::Words(swap_request(buffer))).await;
        gp.accepted(request).await;
        gp.until("the swap", || (gp.status(frame_buffer) > frame.0).then_some(())).await;
    }
    Ok(())
}

fn envelope(
    gp: &Gp,
    picture: &Picture,
    (frame_buffer, buffer): (pxpl5::firmware::NodeId, u8),
    region: RegionId,
    frame: PictureNumber,
) -> RegionEnvelope {
    let grid = picture.viewport.grid();
    let target = CopyTarget { frame_buffer, buffer, lines: Lines::Frame, grid, region, picture: frame };
    let acknowledge = Some(gp.node());
    let copy =
        CopyOrder { target, context: 0, way: CopyPath::ThroughBacking, acknowledge, content: CopyContent::Colour };
    RegionEnvelope { begin: true, shade: true, copy: Some(copy) }
}

impl Pipeline for PolicyPipeline {
    fn name(&self) -> &'static str {
        "python-policy"
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let shading = if self.phong { "phong" } else { "gouraud" };
        vec![("shading", KeyValue::Name(shading)), ("policy", KeyValue::Whole(self.name))]
    }

    fn eyes(&self) -> usize {
        1
    }

    fn layout(&self) -> Layout {
        self.picture().layout
    }

    fn shading(&self) -> Shading {
        self.picture().shading
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError> {
        let ports = machine.ports().clone();
        let views = Arc::clone(&setup.views);
        let node = ports.gps[0];
        let gp = machine.processor(node, Priority::Foreground);
        let picture = Picture { pixels: setup.pixels, ..self.picture() };
        let drawing = Drawing { ports, list: Arc::clone(&setup.list), picture, asked: Arc::clone(&self.asked) };
        let program = firmware(gp, drawing, move |number, time| views(number, time));
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }

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
        });
        times.filter(|times| times.shown_at < end).collect()
    }

    fn latency_definition(&self) -> &'static str {
        "from the start of TRANSFORM to the retrace at which the frame is swapped in"
    }

    fn due_definition(&self) -> &'static str {
        "no frame is ever due: each is shown when it is finished"
    }
}
