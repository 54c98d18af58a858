//! Programs of a slave: EDIT and TRANSFORM in the foreground, and an interrupt program that handles tokens.

use crate::config::RenderingControlConfig;
use crate::master::copy_order;
use crate::protocol::{StageOrder, Token};
use crate::rules::EyeDrawing;
use pphigs::{
    BIN_ENTRY_BYTES, BinHandoffWork, EditWork, FrameView, PROGRAM_BYTES, Pass, RegionEnvelope, Share, TransformWork,
    region_messages,
};
use pxpl5_gp::{Account, Fault, Gp, Priority, Received, Stage};
use pxpl5_wire::{Body, NodeId, PictureNumber, RegionId};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// The data that the two programs of a slave share.
#[derive(Debug, Default)]
struct SlaveState {
    views: VecDeque<FrameView>,
    /// The first frame for which the master has not permitted EDIT.
    next_edit: PictureNumber,
    next_transform: EyeDrawing,
    /// The two sets of bins. `None` stands for an empty set.
    bins: [Option<Arc<Pass>>; 2],
    regions_left: [u32; 2],
}

impl SlaveState {
    /// Fills the set of bins `context`. The bins stay until the slave has received a token for each region.
    fn fill(&mut self, context: usize, pass: Arc<Pass>, regions: u32) {
        self.bins[context] = Some(pass);
        self.regions_left[context] = regions;
    }

    /// Counts a token for the set of bins `context`. After the last token, the function empties the set and returns
    /// true.
    fn count_token(&mut self, context: usize) -> bool {
        self.regions_left[context] -= 1;
        let is_last = self.regions_left[context] == 0;
        if is_last {
            self.bins[context] = None;
        }
        is_last
    }
}

type SharedSlaveState = Rc<RefCell<SlaveState>>;

/// Returns the programs of a slave, for both priorities of its board. `index` is the index of the slave.
///
/// Each program fails with [`Fault::Memory`] if the display list, commands or bins do not fit into memory. A program
/// fails with [`Fault::Protocol`] for an unknown message.
pub fn slave(
    gp: &Gp,
    config: &RenderingControlConfig,
    share: Share,
    index: usize,
) -> [(Priority, impl Future<Output = Result<(), Fault>> + use<>); 2] {
    let state = SharedSlaveState::default();
    [Priority::Interrupt, Priority::Foreground].map(|level| {
        let gp = gp.at_priority(level);
        let config = config.clone();
        let share = share.clone();
        let state = Rc::clone(&state);
        let program = async move {
            match level {
                Priority::Foreground => transform_program(gp, config, share, state).await,
                Priority::Interrupt => token_program(gp, config, index, state).await,
            }
        };
        (level, program)
    })
}

async fn transform_program(
    gp: Gp,
    config: RenderingControlConfig,
    share: Share,
    state: SharedSlaveState,
) -> Result<(), Fault> {
    // Reserve memory and load the display list before the first frame.
    gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
    gp.reserve(Account::DisplayList, share.bytes(), None)?;
    gp.install(|processor| share.install(processor))?;
    for frame in PictureNumber::FIRST.onwards() {
        let view = edit(&gp, &config, &state, frame).await?;
        // Each eye waits for the master's permission.
        for eye in 0..config.eyes() {
            let drawing = config.first_of(frame).after(eye);
            gp.until("leave to TRANSFORM", || (state.borrow().next_transform > drawing).then_some(())).await;
            transform(&gp, &config, &share, &state, &view, drawing).await?;
        }
    }
    Ok(())
}

/// Applies the edits of a frame, and reports the end of EDIT to the master.
async fn edit(
    gp: &Gp,
    config: &RenderingControlConfig,
    state: &SharedSlaveState,
    frame: PictureNumber,
) -> Result<FrameView, Fault> {
    gp.until("leave to EDIT", || (state.borrow().next_edit > frame).then_some(())).await;
    let view = gp.until("SEND of the frame", || state.borrow_mut().views.pop_front()).await;
    gp.begin(Stage::Edit, frame, None);
    gp.work(&EditWork(&view)).await?;
    gp.end(Stage::Edit, frame, None);
    send_to_master(gp, config, &StageOrder::Edited(frame)).await;
    Ok(view)
}

/// Transforms all primitives of the slave, and puts their commands into bins.
///
/// If the bins of two drawings do not fit into memory together, TRANSFORM waits until RENDER of the previous drawing
/// has freed its bins. The simulated program has the number of entries in advance. A real program would estimate this
/// number from the previous drawing.
async fn transform(
    gp: &Gp,
    config: &RenderingControlConfig,
    share: &Share,
    state: &SharedSlaveState,
    view: &FrameView,
    drawing: EyeDrawing,
) -> Result<(), Fault> {
    let frame = config.frame_of(drawing);
    let eye = config.eye_of(drawing);
    let pass = share.transform(view, eye.index(), config.picture);
    let context = (drawing.0 % 2) as u8;
    // Bins alternate between two contexts, one of which may still be in use by RENDER.
    wait_for_bins(gp, state, &pass, context).await;
    gp.begin(Stage::Transform, frame, Some(eye));
    reserve_bins(gp, &pass, context)?;
    let passes = std::slice::from_ref(&pass);
    gp.work(&TransformWork { passes, context, begins: true }).await?;
    // The master sorts regions by these numbers of entries.
    let regions = config.grid().regions() as u16;
    let entries = (0..regions).map(|region| pass.counts(RegionId(region)).total()).collect();
    state.borrow_mut().fill(usize::from(context), pass, config.grid().regions());
    gp.end(Stage::Transform, frame, Some(eye));
    send_to_master(gp, config, &StageOrder::Transformed(drawing, entries)).await;
    Ok(())
}

/// Waits until the bins of a pass fit into memory, or until the other set of bins is empty. `context` is the set of
/// bins of the pass.
async fn wait_for_bins(gp: &Gp, state: &SharedSlaveState, pass: &Pass, context: u8) {
    let regions = (0..pass.picture().viewport.grid().regions() as u16).map(RegionId);
    let bytes = regions.map(|region| u64::from(pass.counts(region).total()) * BIN_ENTRY_BYTES).sum();
    let other = usize::from(context ^ 1);
    let fits = || gp.has_room_for_bins(context, bytes) || state.borrow().bins[other].is_none();
    gp.until("room in the bins", || fits().then_some(())).await;
}

/// Reserves memory for commands and bins. If the bins do not fit, the error names the region whose bin has no room.
fn reserve_bins(gp: &Gp, pass: &Pass, context: u8) -> Result<(), Fault> {
    gp.reserve(Account::Commands(context), pass.command_bytes(), None)?;
    let mut bytes = 0;
    for region in 0..pass.picture().viewport.grid().regions() as u16 {
        bytes += u64::from(pass.counts(RegionId(region)).total()) * BIN_ENTRY_BYTES;
        gp.reserve(Account::Bins(context), bytes, Some(RegionId(region)))?;
    }
    Ok(())
}

/// Runs the interrupt program, which receives views, permissions and tokens.
async fn token_program(
    gp: Gp,
    config: RenderingControlConfig,
    index: usize,
    state: SharedSlaveState,
) -> Result<(), Fault> {
    loop {
        let received = gp.next_message().await;
        let order = StageOrder::read(&received, gp.node());
        // `walk` spends the software cost of a token. The software cost of other messages is spent here.
        if let Ok(StageOrder::Token(token)) = order {
            walk(&gp, &config, index, &state, &received, token).await?;
            continue;
        }
        gp.pay_for(&received).await;
        match order? {
            StageOrder::Send(view) => state.borrow_mut().views.push_back(view),
            StageOrder::Edit(frame) => {
                let state = &mut *state.borrow_mut();
                state.next_edit = frame.next();
                state.next_transform = config.first_of(frame).after(1);
            }
            StageOrder::Transform(drawing) => state.borrow_mut().next_transform = drawing.after(1),
            other => return Err(Fault::Protocol { node: gp.node(), found: format!("at a slave: {other:?}") }),
        }
    }
}

/// Sends this slave's bin for the token's region, then sends the token to the next slave.
async fn walk(
    gp: &Gp,
    config: &RenderingControlConfig,
    index: usize,
    state: &SharedSlaveState,
    received: &Received,
    token: Token,
) -> Result<(), Fault> {
    let renderer = config.renderers[usize::from(token.renderer)];
    let context = (token.drawing.0 % 2) as u8;
    // Get the bins of this drawing's context.
    let pass = state.borrow().bins[usize::from(context)].clone();
    let envelope = envelope(config, token);
    let handing = pass.as_ref().map(|pass| BinHandoffWork { pass, context, view: 0, region: token.region, envelope });
    let lists = pass.as_ref().map_or_else(Vec::new, |pass| region_messages(pass, token.region, 0, envelope));
    // The frame buffer in the message shows observers for which eye the renderer draws.
    let frame_buffer = config.target(token.drawing, token.region).frame_buffer;
    let lists = lists.into_iter().map(|list| list.for_frame_buffer(frame_buffer));
    let messages = lists.map(|list| (renderer, list.words(), Body::Commands(list)));
    // Spend the cost of the token, send the bin, and pass the token on in the background.
    gp.answer(received, handing.as_ref(), messages, passed_on(config, index, token)).await?;
    free_bins(gp, state, token.drawing)
}

/// Returns the message with the token for the next slave. The last slave's message reports to the master that all
/// commands were accepted.
fn passed_on(config: &RenderingControlConfig, index: usize, token: Token) -> (NodeId, u32, Body) {
    let last = token.slaves_left == 1;
    let next = Token { slaves_left: token.slaves_left - 1, ..token };
    let (receiver, order) = if last {
        (config.master, StageOrder::Accepted(next))
    } else {
        (config.slaves[(index + 1) % config.slaves.len()], StageOrder::Token(next))
    };
    let (words, body) = order.message();
    (receiver, words, body)
}

/// Frees a drawing's commands and bins after the last token of the drawing.
fn free_bins(gp: &Gp, state: &SharedSlaveState, drawing: EyeDrawing) -> Result<(), Fault> {
    let context = (drawing.0 % 2) as u8;
    if state.borrow_mut().count_token(usize::from(context)) {
        gp.reserve(Account::Commands(context), 0, None)?;
        gp.reserve(Account::Bins(context), 0, None)?;
    }
    Ok(())
}

/// Returns the commands that this slave adds to its bin. The first slave adds the commands at the start of the region,
/// and the last slave the commands at its end.
fn envelope(config: &RenderingControlConfig, token: Token) -> RegionEnvelope {
    let last = token.slaves_left == 1;
    RegionEnvelope {
        begin: usize::from(token.slaves_left) == config.slaves.len(),
        shade: last,
        copy: token.end.way().filter(|_| last).map(|way| copy_order(config, token.drawing, token.region, way)),
    }
}

async fn send_to_master(gp: &Gp, config: &RenderingControlConfig, order: &StageOrder) {
    let (words, body) = order.message();
    gp.send(config.master, words, body).await;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_context_is_empty_when_a_token_of_each_of_its_regions_has_been_here() {
        let mut state = SlaveState { regions_left: [3, 2], ..SlaveState::default() };
        let tokens = [(0, false), (1, false), (0, false), (0, true), (1, true)];
        for (context, is_last) in tokens {
            assert_eq!(state.count_token(context), is_last, "{context}");
        }
    }
}
