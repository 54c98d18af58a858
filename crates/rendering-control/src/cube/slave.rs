//! Programs of a slave: EDIT and TRANSFORM in the foreground, and an interrupt program that handles tokens.

use crate::cube::config::CubeControlConfig;
use crate::cube::faces::{CubePass, context_of};
use crate::cube::master::copy_order;
use crate::cube::protocol::{Token, UpdateOrder};
use crate::cube::update::FaceUpdate;
use pphigs::{BinHandoffWork, DisplayList, EditWork, PROGRAM_BYTES, Pass, RegionEnvelope, Share, region_messages};
use pxpl5_gp::{Account, Fault, Gp, Priority, Received, Stage};
use pxpl5_wire::{Body, CommandList, NodeId, PictureNumber, RegionId, SurfaceId};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// The data that the two programs of a slave share.
#[derive(Debug, Default)]
struct SlaveState {
    updates: VecDeque<FaceUpdate>,
    /// The first update for which the master has not permitted EDIT.
    next_edit: PictureNumber,
    /// The two sets of bins. `None` stands for an empty set.
    bins: [Option<CubePass>; 2],
    /// For each set of bins, the number of tokens that this slave has received.
    tokens: [u16; 2],
}

impl SlaveState {
    /// Counts a token for the set of bins `context`. After the last of the update's `of` tokens, the function empties
    /// the set and returns true.
    fn count_token(&mut self, context: usize, of: u16) -> bool {
        self.tokens[context] += 1;
        let is_last = self.tokens[context] == of;
        if is_last {
            self.tokens[context] = 0;
            self.bins[context] = None;
        }
        is_last
    }
}

type SharedSlaveState = Rc<RefCell<SlaveState>>;

/// Returns the two programs of a slave, with their priorities. `index` is the index of the slave.
///
/// A program fails with [`Fault::Memory`] if display list, commands or bins do not fit into memory. A program fails
/// with [`Fault::Protocol`] for an invalid message.
pub fn slave(
    gp: &Gp,
    config: &CubeControlConfig,
    share: Share,
    index: usize,
) -> [(Priority, impl Future<Output = Result<(), Fault>> + use<>); 2] {
    let state = SharedSlaveState::default();
    // Tokens interrupt TRANSFORM.
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
    config: CubeControlConfig,
    share: Share,
    state: SharedSlaveState,
) -> Result<(), Fault> {
    // Reserve memory for the program and the display list.
    gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
    gp.reserve(Account::DisplayList, share.bytes(), None)?;
    gp.install(|processor| share.install(processor))?;
    let mut installed = Arc::clone(share.list());
    loop {
        let update = Arc::new(edit(&gp, &config, &state).await?);
        place_vertices(&gp, &CubePass::placed(&config, &share, &update), &mut installed)?;
        transform(&gp, &config, &share, &state, &update).await?;
    }
}

/// Stores the displaced vertices of an update in the board's memory. The displacement takes no simulated time.
fn place_vertices(gp: &Gp, share: &Share, installed: &mut Arc<DisplayList>) -> Result<(), Fault> {
    if !Arc::ptr_eq(installed, share.list()) {
        gp.install(|processor| share.install(processor))?;
        *installed = Arc::clone(share.list());
    }
    Ok(())
}

/// Applies the edits of the next update, and reports the end of EDIT to the master.
async fn edit(gp: &Gp, config: &CubeControlConfig, state: &SharedSlaveState) -> Result<FaceUpdate, Fault> {
    let update = gp.until("SEND of an update and leave to EDIT", || next_edit(&mut state.borrow_mut())).await;
    let number = update.number;
    gp.begin(Stage::Edit, number, None);
    gp.work(&EditWork(&update.view)).await?;
    gp.end(Stage::Edit, number, None);
    send_to_master(gp, config, &UpdateOrder::Edited(number)).await;
    Ok(update)
}

fn next_edit(state: &mut SlaveState) -> Option<FaceUpdate> {
    let may_begin = state.updates.front()?.number < state.next_edit;
    if may_begin { state.updates.pop_front() } else { None }
}

/// Transforms the primitives of an update, and puts their commands into the bins of the faces.
///
/// If the bins of two updates do not fit into memory, TRANSFORM waits until RENDER of the previous update has freed its
/// bins.
async fn transform(
    gp: &Gp,
    config: &CubeControlConfig,
    share: &Share,
    state: &SharedSlaveState,
    update: &Arc<FaceUpdate>,
) -> Result<(), Fault> {
    let number = update.number;
    let context = context_of(number);
    let surface = Some(SurfaceId(0));
    let pass = CubePass::new(config, share, update);
    let account = context as u8;
    let other_is_empty = || state.borrow().bins[context ^ 1].is_none();
    let has_room = || gp.has_room_for_bins(account, pass.bin_bytes()) || other_is_empty();
    // Wait for memory, or until the other context is empty.
    gp.until("room in the bins", || has_room().then_some(())).await;
    gp.begin(Stage::Transform, number, surface);
    gp.reserve(Account::Commands(account), pass.command_bytes(), None)?;
    gp.reserve(Account::Bins(account), pass.bin_bytes(), None)?;
    // Do the work, then publish the bins and report to the master.
    gp.work(&pass).await?;
    let entries = pass.entries(config);
    state.borrow_mut().bins[context] = Some(pass);
    gp.end(Stage::Transform, number, surface);
    send_to_master(gp, config, &UpdateOrder::Transformed(number, entries)).await;
    Ok(())
}

/// Runs the interrupt program, which receives updates, permissions for EDIT, and tokens.
async fn token_program(gp: Gp, config: CubeControlConfig, index: usize, state: SharedSlaveState) -> Result<(), Fault> {
    loop {
        let received = gp.next_message().await;
        let order = UpdateOrder::read(&received, gp.node());
        // `walk` spends the time to receive a token. The time to receive other messages is spent below.
        if let Ok(UpdateOrder::Token(token)) = order {
            walk(&gp, &config, index, &state, &received, token).await?;
            continue;
        }
        gp.pay_for(&received).await;
        match order? {
            UpdateOrder::Send(update) => state.borrow_mut().updates.push_back(update),
            UpdateOrder::Edit(update) => state.borrow_mut().next_edit = update.next(),
            other => return Err(Fault::Protocol { node: gp.node(), found: format!("at a slave: {other:?}") }),
        }
    }
}

/// Sends this slave's bin for the token's region, then sends the token to the next slave.
async fn walk(
    gp: &Gp,
    config: &CubeControlConfig,
    index: usize,
    state: &SharedSlaveState,
    received: &Received,
    token: Token,
) -> Result<(), Fault> {
    // Send the bin to the renderer, then pass the token on.
    let renderer = config.renderers[usize::from(token.renderer)];
    let bin = TokenBin::of(config, state, token);
    let lists = bin.as_ref().map_or_else(Vec::new, TokenBin::messages);
    let messages = lists.into_iter().map(|list| (renderer, list.words(), Body::Commands(list)));
    let handing = bin.as_ref().map(TokenBin::handing);
    gp.answer(received, handing.as_ref(), messages, passed_on(config, index, token)).await?;
    free_bins(gp, state, token)
}

/// A slave's bin for one region, with the commands before and after its primitives.
struct TokenBin {
    pass: Arc<Pass>,
    context: usize,
    face: usize,
    region: RegionId,
    envelope: RegionEnvelope,
}

impl TokenBin {
    /// Returns the bin, or `None` if this slave has no bins for the face that contains the region.
    fn of(config: &CubeControlConfig, state: &SharedSlaveState, token: Token) -> Option<Self> {
        let context = context_of(token.update);
        let (face, region) = config.faces.on_face(token.region);
        let state = state.borrow();
        let passes = state.bins[context].as_ref()?;
        let envelope = envelope(config, passes.update(), token);
        Some(Self { pass: Arc::clone(passes.face(face)?), context, face, region, envelope })
    }

    fn handing(&self) -> BinHandoffWork<'_> {
        let Self { pass, region, envelope, .. } = self;
        let (context, view) = (self.context as u8, self.face as u8);
        BinHandoffWork { pass, context, view, region: *region, envelope: *envelope }
    }

    fn messages(&self) -> Vec<CommandList> {
        region_messages(&self.pass, self.region, 0, self.envelope)
    }
}

/// Returns the commands that this slave adds to its bin. The first slave adds the commands at the start of the region,
/// and the last slave the commands at its end.
fn envelope(config: &CubeControlConfig, update: &FaceUpdate, token: Token) -> RegionEnvelope {
    let last = token.slaves_left == 1;
    let target = config.faces.target(update, token.region);
    RegionEnvelope {
        begin: usize::from(token.slaves_left) == config.slaves.len(),
        shade: last,
        copy: (last && token.copies).then(|| copy_order(config, target)),
    }
}

/// Returns the message with the token for the next slave. The last slave's message reports to the master that all
/// commands were accepted.
fn passed_on(config: &CubeControlConfig, index: usize, token: Token) -> (NodeId, u32, Body) {
    let last = token.slaves_left == 1;
    let next = Token { slaves_left: token.slaves_left - 1, ..token };
    let (receiver, order) = if last {
        (config.master, UpdateOrder::Accepted(next))
    } else {
        (config.slaves[(index + 1) % config.slaves.len()], UpdateOrder::Token(next))
    };
    let (words, body) = order.message();
    (receiver, words, body)
}

/// Frees an update's commands and bins after the last token of the update.
fn free_bins(gp: &Gp, state: &SharedSlaveState, token: Token) -> Result<(), Fault> {
    let context = context_of(token.update);
    if state.borrow_mut().count_token(context, token.of) {
        gp.reserve(Account::Commands(context as u8), 0, None)?;
        gp.reserve(Account::Bins(context as u8), 0, None)?;
    }
    Ok(())
}

async fn send_to_master(gp: &Gp, config: &CubeControlConfig, order: &UpdateOrder) {
    let (words, body) = order.message();
    gp.send(config.master, words, body).await;
}

#[cfg(test)]
pub(crate) mod tests;
