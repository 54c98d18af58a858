//! A pipeline for experiments with the order of regions. A function of the user, the *policy*, decides which renderer
//! draws which region, and in which order.
//!
//! One graphics processor draws frames for a single eye and shows each frame when it is finished. The policy is called
//! after TRANSFORM, so it receives the final number of primitives in every region.

use crate::pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup};
use crate::pipelines::{picture, sampled_at, samples, shading_value, whole_picture};
use crate::result::picture_ends::PictureResult;
use pphigs::{DisplayList, FrameView, Pass, Picture, RegionEnvelope, Shading, Share, region_messages};
use pxpl5_gp::{Fault, Gp, Priority, Stage};
use pxpl5_machine::{Machine, Ports, Record};
use pxpl5_renderer::Layout;
use pxpl5_sim::parameters::KeyValue;
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{
    Body, CopyContent, CopyOrder, CopyPath, CopyTarget, Lines, NodeId, PictureNumber, RegionId, ViewNumber,
    swap_request,
};
use std::fmt::Debug;
use std::sync::Arc;

/// Data about a frame after TRANSFORM, which a policy receives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolicyFrame {
    /// Number of the frame, counted from 0.
    pub frame: PictureNumber,
    /// Simulated time at which the policy is called.
    pub time: Time,
    /// Number of regions in a row of the screen.
    pub columns: u32,
    /// Number of primitives in the bin of each region, row by row.
    pub primitives: Vec<u32>,
    /// Number of renderers in the machine.
    pub renderers: usize,
}

/// The decision of a policy for one region: the region, and the index of the renderer that draws the region.
pub type RegionAssignment = (RegionId, usize);

/// A function that assigns the regions of a frame to renderers.
///
/// ```
/// use pxpl5_run::{PolicyFrame, RegionAssignment, RegionPolicy};
/// use pxpl5_wire::RegionId;
///
/// /// Draws region after region, with one renderer after the other.
/// #[derive(Debug)]
/// struct InTurn;
///
/// impl RegionPolicy for InTurn {
///     fn name(&self) -> &str {
///         "in-turn"
///     }
///
///     fn assign(&self, frame: &PolicyFrame) -> Option<Vec<RegionAssignment>> {
///         let regions = 0..frame.primitives.len() as u16;
///         Some(regions.map(|region| (RegionId(region), usize::from(region) % frame.renderers)).collect())
///     }
/// }
/// ```
pub trait RegionPolicy: Debug + Send + Sync {
    /// Returns the name of the policy. The hash of an experiment's settings includes the name.
    fn name(&self) -> &str;

    /// Returns every region once with its renderer, in the order in which the regions are sent. Returns `None` to end
    /// the drawing. The run then continues without new pictures.
    ///
    /// The function must give the same answer for the same frame, because a run may be repeated, for example as a dry
    /// run.
    fn assign(&self, frame: &PolicyFrame) -> Option<Vec<RegionAssignment>>;
}

impl PolicyFrame {
    /// Checks that the assignments contain every region exactly once and only existing renderers.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the first wrong assignment.
    pub fn check(&self, assignments: &[RegionAssignment]) -> Result<(), SettingError> {
        let (regions, renderers) = (self.primitives.len(), self.renderers);
        let mut seen = vec![false; regions];
        for &(RegionId(region), renderer) in assignments {
            // An unknown region, a repeated region and an unknown renderer are errors.
            let is_seen = seen.get_mut(usize::from(region)).filter(|seen| !**seen && renderer < renderers);
            let Some(is_seen) = is_seen else {
                let expected = format!("each of {regions} regions once, for one of {renderers} renderers");
                return Err(SettingError::value("a policy", expected, format_args!("({region}, {renderer})")));
            };
            *is_seen = true;
        }
        match seen.iter().position(|seen| !seen) {
            Some(missing) => {
                let found = format_args!("none for region {missing}");
                Err(SettingError::value("a policy", format_args!("all {regions} regions"), found))
            }
            None => Ok(()),
        }
    }
}

/// A pipeline with one graphics processor, which draws one frame at a time. A [`RegionPolicy`] distributes the regions
/// of a frame among the renderers.
#[derive(Clone, Debug)]
pub struct PolicyPipeline {
    policy: Arc<dyn RegionPolicy>,
    shading: Shading,
}

impl PolicyPipeline {
    /// Creates a pipeline with a policy and a method of shading.
    pub const fn new(policy: Arc<dyn RegionPolicy>, shading: Shading) -> Self {
        Self { policy, shading }
    }
}

struct Drawing {
    ports: Ports,
    list: Arc<DisplayList>,
    picture: Picture,
    policy: Arc<dyn RegionPolicy>,
}

impl Drawing {
    fn assignments(
        &self,
        gp: &Gp,
        frame: PictureNumber,
        pass: &Pass,
    ) -> Result<Option<Vec<RegionAssignment>>, SettingError> {
        let grid = self.picture.viewport.grid();
        let regions = grid.regions() as u16;
        let about = PolicyFrame {
            frame,
            time: gp.now(),
            columns: grid.width.div_ceil(grid.region_width),
            primitives: (0..regions).map(|region| pass.counts(RegionId(region)).total()).collect(),
            renderers: self.ports.renderers.len(),
        };
        let Some(assignments) = self.policy.assign(&about) else { return Ok(None) };
        about.check(&assignments)?;
        Ok(Some(assignments))
    }
}

async fn firmware(gp: Gp, drawing: Drawing, mut view: impl FnMut(ViewNumber, Time) -> FrameView) -> Result<(), Fault> {
    let share = Share::new(Arc::clone(&drawing.list), 0, 1);
    let picture = drawing.picture;
    let frame_buffer = drawing.ports.display()[0];
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
        // A policy that returns nothing ends the drawing. A wrong answer is a fault of the program.
        let answer = drawing.assignments(&gp, frame, &pass);
        let answer = answer.map_err(|error| Fault::Protocol { node: gp.node(), found: error.to_string() })?;
        let Some(assignments) = answer else { return Ok(()) };
        let buffer = (frame.next().0 % 2) as u8;
        gp.begin(Stage::Render, frame, None);
        // Send each region to its renderer. The last message of a region contains the copy command.
        for (region, renderer) in &assignments {
            let envelope = envelope(&gp, &picture, (frame_buffer, buffer), *region, frame);
            for message in region_messages(&pass, *region, 0, envelope) {
                gp.clump_buffer_free().await;
                gp.send(drawing.ports.renderers[*renderer], message.words(), Body::Commands(message)).await;
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
    (frame_buffer, buffer): (NodeId, u8),
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
        "region-policy"
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        vec![("shading", shading_value(self.shading)), ("policy", KeyValue::Text(self.policy.name().into()))]
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties {
            shading: self.shading,
            ..PipelineProperties::new(
                Layout::rendering_control_phong(),
                "from the start of TRANSFORM to the retrace at which the frame is swapped in",
                "no frame is ever due: each is shown when it is finished",
            )
        }
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let ports = machine.ports().clone();
        let views = Arc::clone(&setup.views);
        let node = ports.gps[0];
        let gp = machine.processor(node, Priority::Foreground);
        let picture = picture(whole_picture(machine.record())?, self.shading, setup.pixels);
        let drawing = Drawing { ports, list: Arc::clone(&setup.list), picture, policy: Arc::clone(&self.policy) };
        let program = firmware(gp, drawing, move |number, time| views.newest(number, time));
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }
}

impl PictureRules for PolicyPipeline {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let shown = record.observation().frames(1).into_values();
        let begun = samples(record).zip(shown);
        let times = begun.map(|(mark, tick)| sampled_at(mark, None, record.tick(tick), PictureResult::Shown));
        times.filter(|times| times.shown_at < end).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> PolicyFrame {
        PolicyFrame {
            frame: PictureNumber::FIRST,
            time: Time::ZERO,
            columns: 2,
            primitives: vec![12, 0, 3],
            renderers: 2,
        }
    }

    #[test]
    fn a_policy_must_assign_every_region_once_to_an_existing_renderer() {
        let answer = |pairs: &[(u16, usize)]| -> Vec<RegionAssignment> {
            pairs.iter().map(|(region, renderer)| (RegionId(*region), *renderer)).collect()
        };
        assert_eq!(frame().check(&answer(&[(2, 0), (0, 1), (1, 1)])), Ok(()));
        let refusal = |pairs: &[(u16, usize)]| frame().check(&answer(pairs)).expect_err("refused").to_string();
        assert_eq!(refusal(&[(2, 0), (0, 1)]), "a policy: expected all 3 regions, found none for region 1");
        for (wrong, region, renderer) in [([(0, 0), (0, 1)], 0, 1), ([(0, 0), (3, 1)], 3, 1), ([(0, 0), (1, 2)], 1, 2)]
        {
            let expected = "a policy: expected each of 3 regions once, for one of 2 renderers";
            assert_eq!(refusal(&wrong), format!("{expected}, found ({region}, {renderer})"));
        }
    }
}
