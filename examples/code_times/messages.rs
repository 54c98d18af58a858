//! Measures the mean software time of a message, over all messages that a board receives and sends around its passes
//! over a scene. The time for the bin entries in a sent message is subtracted.

use super::{BOARDS, CodeUse, Rig, VIEWS, parts, picture, solve};
use pphigs::{BinHandoffWork, FrameView, Pass, RegionEnvelope, region_messages};
use pxpl5_gp::{CodeVersion, Fault, GpTiming, Processor, Work};
use pxpl5_machine::MachineConfig;
use pxpl5_renderer::CommandKind;
use pxpl5_run::ExperimentError;
use pxpl5_sim::Span;
use pxpl5_wire::{Body, CommandList, Message, NodeId, RegionId};
use std::sync::Arc;

/// Number of words of an order, and of a slave's report to the master, under Rendering Control.
const ORDER: u32 = 3;
/// Number of words of a token message under Rendering Control.
const TOKEN: u32 = 6;

/// Node number of the board at the other end of all messages of the measurement.
const OTHER: NodeId = NodeId(2);

/// Total time and number of a board's messages. A sent chain of messages counts as one message.
#[derive(Default)]
pub(super) struct Traffic {
    span: Span,
    messages: u64,
    /// Number of entries and sending time in nanoseconds for each bin that the board sent.
    handed: Vec<[f64; 2]>,
}

/// Returns the time in nanoseconds in which a slave with the token sends one bin entry. This time is the slope of a
/// least-squares line over all bins, or 0 if no bin was sent.
pub(super) fn token_entry_ns(scenes: &[Traffic]) -> f64 {
    let mut handed = scenes.iter().flat_map(|traffic| &traffic.handed).peekable();
    if handed.peek().is_none() { 0.0 } else { solve(handed.map(|[entries, ns]| ([*entries, 1.0], *ns))) }
}

impl Traffic {
    /// Returns the mean time of a message in nanoseconds. `token_entry_ns` is first subtracted for each entry of a sent
    /// bin.
    pub(super) fn message_ns(&self, token_entry_ns: f64) -> f64 {
        let [entries, ns] = self.handed.iter().fold([0.0; 2], |[n, sum], [entries, ns]| [n + entries, sum + ns]);
        (self.span.0 as f64 / 1e3 + ns - token_entry_ns * entries) / self.messages as f64
    }

    fn receive(&mut self, processor: &mut Processor, words: u32) -> Result<(), Fault> {
        let body = Body::Words(vec![0; words as usize].into());
        self.messages += 1;
        self.span += processor.receive_message(OTHER, &body)?;
        Ok(())
    }

    fn send(&mut self, processor: &mut Processor, bodies: &[(u32, Body)]) -> Result<(), Fault> {
        let source = processor.node();
        let message =
            |(words, body): &(u32, Body)| Message { source, destination: OTHER, words: *words, body: body.clone() };
        let messages: Vec<Message> = bodies.iter().map(message).collect();
        self.messages += 1;
        self.span += processor.send_chain(messages.iter().map(|message| (message, false)))?;
        Ok(())
    }

    fn send_words(&mut self, processor: &mut Processor, words: u32) -> Result<(), Fault> {
        self.send(processor, &[(words, Body::Words(vec![0; words as usize].into()))])
    }
}

fn commands(list: CommandList) -> (u32, Body) {
    (list.words(), Body::Commands(list))
}

pub(super) fn traffic(version: CodeVersion, of: CodeUse, scene: &str) -> Result<Traffic, ExperimentError> {
    let mut rig = Rig::new((version, of), scene, BOARDS)?;
    let mut traffic = Traffic::default();
    for number in 0..VIEWS {
        let view = rig.view(number);
        // Both pipelines are measured with the messages of their own protocol.
        match of {
            CodeUse::Pphigs => slave(&mut rig, of, &view, &mut traffic),
            _ => field(&mut rig, of, &view, &mut traffic),
        }
        .map_err(|error| ExperimentError::Scene(error.to_string()))?;
        if number == 0 {
            // The first view only fills the caches.
            traffic = Traffic::default();
        }
    }
    Ok(traffic)
}

/// Executes the code for the messages of a slave in one frame:
///
/// - The slave receives the frame's head pose from the host.
/// - The slave receives permission for EDIT and for TRANSFORM, and reports the end of each.
/// - For each eye, the slave receives the token of every region and passes the token on.
fn slave(rig: &mut Rig, of: CodeUse, view: &FrameView, traffic: &mut Traffic) -> Result<(), Fault> {
    let regions = picture(of).viewport.grid().regions() as u16;
    // The host's view, then the master's permission, then the slave's report.
    traffic.receive(&mut rig.processor, 1 + view.to_words().len() as u32)?;
    traffic.receive(&mut rig.processor, ORDER)?;
    traffic.send_words(&mut rig.processor, ORDER)?;
    // Each eye has its own TRANSFORM, report and tokens.
    for eye in 0..2 {
        if eye > 0 {
            traffic.receive(&mut rig.processor, ORDER)?;
        }
        let pass = rig.share.transform(view, eye, picture(of));
        pass.run_code(&mut rig.processor, eye as u8)?;
        traffic.send_words(&mut rig.processor, ORDER + u32::from(regions))?;
        for region in (0..regions).map(RegionId) {
            token(&mut rig.processor, &pass, eye as u8, region, traffic)?;
        }
    }
    Ok(())
}

/// Executes the code for one token. The slave receives the token, sends the bin of the region, and passes the token on.
/// The slave is neither the first nor the last slave that gets the token.
fn token(
    processor: &mut Processor,
    pass: &Arc<Pass>,
    context: u8,
    region: RegionId,
    traffic: &mut Traffic,
) -> Result<(), Fault> {
    let envelope = RegionEnvelope::default();
    // Receive the token, send the bin of the region, and pass the token on.
    traffic.receive(processor, TOKEN)?;
    let span = BinHandoffWork { pass, context, view: 0, region, envelope }.by_code(&GpTiming::PAPERS, processor)?;
    traffic.handed.push([pass.counts(region).total().into(), span.0 as f64 / 1e3]);
    for list in region_messages(pass, region, context, envelope) {
        traffic.send(processor, &[commands(list)])?;
    }
    traffic.send_words(processor, TOKEN)
}

/// Executes the code for the messages of one display field under Slats. The board receives the head pose. The board
/// then sends a chain of messages for each clump to the regions of both eyes. Finally, the board sends two chains of
/// copy commands to all renderers.
fn field(rig: &mut Rig, of: CodeUse, view: &FrameView, traffic: &mut Traffic) -> Result<(), Fault> {
    let regions = picture(of).viewport.grid().regions() as u16;
    traffic.receive(&mut rig.processor, view.to_words().len() as u32)?;
    // Each clump is transformed and sent to all regions of both eyes as one chain.
    for clump in parts(of, &rig.share) {
        let passes = [0, 1].map(|eye| clump.transform(view, eye, picture(of)));
        if passes[0].run_code_for_both(&passes[1], &mut rig.processor, 0)?.is_none() {
            for pass in &passes {
                pass.run_code(&mut rig.processor, 0)?;
            }
        }
        let lists = passes.iter().flat_map(|pass| {
            let of_region = |region| region_messages(pass, RegionId(region), 0, RegionEnvelope::default());
            (0..regions).flat_map(of_region).map(commands)
        });
        traffic.send(&mut rig.processor, &lists.collect::<Vec<_>>())?;
    }
    // A field ends with one chain of copy commands for each eye.
    for _ in 0..2 {
        let words = CommandKind::SelectRegion.words() + CommandKind::CopyRegion.words();
        let copies = vec![(words, Body::Words(vec![0; words as usize].into())); MachineConfig::slats().n_renderers];
        traffic.send(&mut rig.processor, &copies)?;
    }
    Ok(())
}
