//! The two programs of a slave. The foreground program performs EDIT and TRANSFORM. The interrupt program handles
//! messages and tokens.

use crate::drawn::{Drawn, RenderingControlConfig, Sent};
use crate::protocol::{StageOrder, Token};
use crate::rules::Drawing;
use pphigs::{
    BIN_ENTRY_BYTES, BinHandoffWork, DisplayList, EditWork, PROGRAM_BYTES, Pass, RegionEnvelope, Share, region_messages,
};
use pxpl5_gp::{Account, Fault, Gp, Priority, Received, Stage};
use pxpl5_wire::{Body, CommandList, NodeId, PictureNumber, RegionId, SurfaceId};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

#[derive(Debug)]
struct SlaveState<S> {
    sent: VecDeque<S>,
    /// First picture for which the master has not permitted EDIT.
    next_edit: PictureNumber,
    next_transform: Drawing,
    /// The two sets of bins, each `None` while the set is empty.
    bins: [Option<Bins<S>>; 2],
    /// Number of tokens that this slave has received for each of the two sets of bins.
    tokens: [u16; 2],
}

/// The bins of a drawing. There is one pass for each view.
#[derive(Debug)]
struct Bins<S> {
    sent: Arc<S>,
    passes: Vec<Arc<Pass>>,
}

impl<S> SlaveState<S> {
    const fn new() -> Self {
        let (next_edit, next_transform) = (PictureNumber::FIRST, Drawing(0));
        Self { sent: VecDeque::new(), next_edit, next_transform, bins: [None, None], tokens: [0; 2] }
    }

    /// Counts a token that this slave has handled, for the set of bins `context` (0 or 1). A drawing has `of` tokens. After
    /// the last token of a drawing, the function empties the set of bins and returns true.
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

impl<S: Sent> SlaveState<S> {
    /// Takes the next picture, if the host has sent it and the master has permitted its EDIT.
    fn next_picture(&mut self) -> Option<S> {
        let may_begin = self.sent.front()?.number() < self.next_edit;
        if may_begin { self.sent.pop_front() } else { None }
    }
}

/// A program of a slave, in the foreground or with the higher priority.
struct Slave<D: Drawn> {
    gp: Gp,
    config: RenderingControlConfig<D>,
    share: Share,
    index: usize,
    state: Rc<RefCell<SlaveState<D::Sent>>>,
}

/// Returns the foreground program and the interrupt program of the slave `index`, with their priorities.
///
/// A program fails with [`Fault::Memory`] if the display list, commands or bins do not fit into memory. A program fails
/// with [`Fault::Protocol`] after an unknown message.
pub fn slave<D: Drawn>(
    gp: &Gp,
    config: &RenderingControlConfig<D>,
    share: Share,
    index: usize,
) -> [(Priority, impl Future<Output = Result<(), Fault>> + use<D>); 2] {
    let state = Rc::new(RefCell::new(SlaveState::new()));
    // Tokens interrupt TRANSFORM.
    [Priority::Interrupt, Priority::Foreground].map(|level| {
        let (gp, config, share, state) = (gp.at_priority(level), config.clone(), share.clone(), Rc::clone(&state));
        let slave = Slave { gp, config, share, index, state };
        let program = async move {
            match level {
                Priority::Foreground => slave.transform_all().await,
                Priority::Interrupt => slave.answer_messages().await,
            }
        };
        (level, program)
    })
}

impl<D: Drawn> Slave<D> {
    async fn transform_all(self) -> Result<(), Fault> {
        // Reserve memory and load the display list before the first picture.
        self.gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
        self.gp.reserve(Account::DisplayList, self.share.bytes(), None)?;
        self.gp.install(|processor| self.share.install(processor))?;
        let mut installed = Arc::clone(self.share.list());
        loop {
            let sent = Arc::new(self.edit().await?);
            let share = self.config.drawn.placed(&self.share, &sent);
            place_vertices(&self.gp, &share, &mut installed)?;
            // Each eye waits for the master's permission.
            let first = self.config.first_of(sent.number());
            for drawing in (0..self.config.drawn.eyes()).map(|eye| first.after(eye)) {
                let may_begin = || self.state.borrow().next_transform > drawing;
                self.gp.until("leave to TRANSFORM", || may_begin().then_some(())).await;
                self.transform(&share, &sent, drawing).await?;
            }
        }
    }

    /// Performs EDIT of the next picture: applies the edits, and reports the end to the master.
    async fn edit(&self) -> Result<D::Sent, Fault> {
        let next = || self.state.borrow_mut().next_picture();
        let sent = self.gp.until("SEND and leave to EDIT", next).await;
        let number = sent.number();
        self.gp.begin(Stage::Edit, number, None);
        self.gp.work(&EditWork(sent.view())).await?;
        self.gp.end(Stage::Edit, number, None);
        self.send_to_master(&StageOrder::Edited(number)).await;
        Ok(sent)
    }

    /// Performs TRANSFORM of a drawing: makes the commands of all triangles and spheres, and fills the bins.
    ///
    /// If memory has no room for the bins beside the bins of the previous drawing, TRANSFORM waits until RENDER has
    /// freed the older bins. The simulated program has the number of entries in advance. A real program would estimate
    /// this number from the previous drawing.
    async fn transform(&self, share: &Share, sent: &Arc<D::Sent>, drawing: Drawing) -> Result<(), Fault> {
        let drawn = &self.config.drawn;
        let (picture, eye) = (self.config.picture_of(drawing), self.config.eye_of(drawing));
        let surface = Some(SurfaceId(eye as u16));
        let passes = drawn.passes(share, sent, eye);
        let entries = drawn.entries(&passes);
        // Bins alternate between two contexts, one of which may still be in use by RENDER.
        let context = drawing.context();
        let bytes = entries.iter().map(|entries| u64::from(*entries) * BIN_ENTRY_BYTES).sum();
        let other_is_empty = || self.state.borrow().bins[context ^ 1].is_none();
        let has_room = || self.gp.has_room_for_bins(context as u8, bytes) || other_is_empty();
        self.gp.until("room in the bins", || has_room().then_some(())).await;
        self.gp.begin(Stage::Transform, picture, surface);
        self.reserve_bins(&passes, &entries, context)?;
        self.gp.work(&drawn.work(share, sent, &passes, context as u8)).await?;
        self.state.borrow_mut().bins[context] = Some(Bins { sent: Arc::clone(sent), passes });
        self.gp.end(Stage::Transform, picture, surface);
        // The master sorts regions by these numbers of entries.
        self.send_to_master(&StageOrder::Transformed(drawing, entries)).await;
        Ok(())
    }

    /// Reserves memory for commands and bins. If memory is too small, the error names the first region whose bin does
    /// not fit.
    fn reserve_bins(&self, passes: &[Arc<Pass>], entries: &[u32], context: usize) -> Result<(), Fault> {
        let commands = passes.iter().map(|pass| pass.command_bytes()).sum();
        self.gp.reserve(Account::Commands(context as u8), commands, None)?;
        let mut bytes = 0;
        for (region, entries) in (0..).map(RegionId).zip(entries) {
            bytes += u64::from(*entries) * BIN_ENTRY_BYTES;
            self.gp.reserve(Account::Bins(context as u8), bytes, Some(region))?;
        }
        Ok(())
    }

    /// Runs the interrupt program, which stores the host's pictures and the master's permissions, and handles tokens.
    async fn answer_messages(self) -> Result<(), Fault> {
        loop {
            let received = self.gp.next_message().await;
            let order = StageOrder::read(&received, self.gp.node());
            // `walk` spends the software cost of a token. The software cost of other messages is spent here.
            if let Ok(StageOrder::Token(token)) = order {
                self.walk(&received, token).await?;
                continue;
            }
            self.gp.pay_for(&received).await;
            let state = &mut *self.state.borrow_mut();
            match order? {
                StageOrder::Send(sent) => state.sent.push_back(sent),
                StageOrder::Edit(picture) => {
                    state.next_edit = picture.next();
                    state.next_transform = self.config.first_of(picture).after(1);
                }
                StageOrder::Transform(drawing) => state.next_transform = drawing.after(1),
                other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at a slave: {other:?}") }),
            }
        }
    }

    /// Sends this slave's bin of the token's region to the renderer, and then sends the token to the next slave.
    async fn walk(&self, received: &Received, token: Token) -> Result<(), Fault> {
        let renderer = self.config.renderers[usize::from(token.renderer)];
        let bin = self.bin_of(token);
        let lists = bin.as_ref().map_or_else(Vec::new, TokenBin::messages);
        let messages = lists.into_iter().map(|list| (renderer, list.words(), Body::Commands(list)));
        let handing = bin.as_ref().map(TokenBin::handing);
        // Spend the cost of the token, send the bin, and pass the token on in the background.
        self.gp.answer(received, handing.as_ref(), messages, self.passed_on(token)).await?;
        self.free_bins(token)
    }

    /// Returns this slave's bin of the token's region. Returns `None` if there are no bins for this region's view.
    fn bin_of(&self, token: Token) -> Option<TokenBin> {
        let drawn = &self.config.drawn;
        let context = token.drawing.context();
        let (view, region) = drawn.on_view(token.region);
        let state = self.state.borrow();
        let bins = state.bins[context].as_ref()?;
        let target = drawn.target(&bins.sent, self.config.eye_of(token.drawing), token.region);
        // The first slave begins the region, and the last slave ends it.
        let last = token.slaves_left == 1;
        let envelope = RegionEnvelope {
            begin: usize::from(token.slaves_left) == self.config.slaves.len(),
            shade: last,
            copy: token.end.way().filter(|_| last).map(|way| self.config.copy_order(target, way)),
        };
        // A region that belongs to one of several views has no place on a surface of the display.
        let frame_buffer = (D::VIEWS == 1).then_some(target.frame_buffer);
        Some(TokenBin { pass: Arc::clone(bins.passes.get(view)?), context, view, region, envelope, frame_buffer })
    }

    /// Returns the receiver and the message of a token that this slave has handled. The receiver is the next slave, or
    /// the master if all slaves have sent their bins.
    fn passed_on(&self, token: Token) -> (NodeId, u32, Body) {
        let next = Token { slaves_left: token.slaves_left - 1, ..token };
        let (receiver, order) = if next.slaves_left == 0 {
            (self.config.master, StageOrder::<D::Sent>::Accepted(next))
        } else {
            (self.config.slaves[(self.index + 1) % self.config.slaves.len()], StageOrder::Token(next))
        };
        let (words, body) = order.message();
        (receiver, words, body)
    }

    /// After the last token of a drawing, frees the memory of the drawing's commands and bins.
    fn free_bins(&self, token: Token) -> Result<(), Fault> {
        let context = token.drawing.context();
        if self.state.borrow_mut().count_token(context, token.of) {
            self.gp.reserve(Account::Commands(context as u8), 0, None)?;
            self.gp.reserve(Account::Bins(context as u8), 0, None)?;
        }
        Ok(())
    }

    async fn send_to_master(&self, order: &StageOrder<D::Sent>) {
        let (words, body) = order.message();
        self.gp.send(self.config.master, words, body).await;
    }
}

/// Writes the vertices of a picture into the board's memory if the vertices were displaced. The write takes no
/// simulated time.
fn place_vertices(gp: &Gp, share: &Share, installed: &mut Arc<DisplayList>) -> Result<(), Fault> {
    if !Arc::ptr_eq(installed, share.list()) {
        gp.install(|processor| share.install(processor))?;
        *installed = Arc::clone(share.list());
    }
    Ok(())
}

/// This slave's bin of a region, with the commands before and after the bin.
struct TokenBin {
    pass: Arc<Pass>,
    context: usize,
    view: usize,
    region: RegionId,
    envelope: RegionEnvelope,
    /// Ring port of the region's frame buffer. Observers use the port to find the eye for which the renderer draws.
    frame_buffer: Option<NodeId>,
}

impl TokenBin {
    fn handing(&self) -> BinHandoffWork<'_> {
        let Self { pass, region, envelope, .. } = self;
        let (context, view) = (self.context as u8, self.view as u8);
        BinHandoffWork { pass, context, view, region: *region, envelope: *envelope }
    }

    fn messages(&self) -> Vec<CommandList> {
        let lists = region_messages(&self.pass, self.region, 0, self.envelope).into_iter();
        let named = |list: CommandList| match self.frame_buffer {
            Some(frame_buffer) => list.for_frame_buffer(frame_buffer),
            None => list,
        };
        lists.map(named).collect()
    }
}

#[cfg(test)]
pub(crate) mod tests;
