//! The master GP: it synchronises host, slaves, renderers and frame buffers.

use crate::config::{PROGRAM_BYTES, RenderingControlConfig};
use crate::protocol::{StageOrder, Token};
use crate::rules::Completed;
use pphigs::copy_message;
use pxpl5_gp::{Account, Fault, Gp, Received, Stage};
use pxpl5_wire::{Body, CopyOrder, NodeId, RegionId, swap_request};
use std::collections::VecDeque;

/// What a renderer is doing, as far as the master knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RendererUse {
    Idle,
    /// A token for it is with the slaves.
    Receiving,
    /// It holds a finished region that waits for a frame buffer.
    Holding(u64, RegionId),
}

/// RENDER of one eye.
#[derive(Debug)]
struct Rendering {
    picture: u64,
    /// Regions without a renderer yet, heaviest first.
    unassigned: VecDeque<RegionId>,
    /// Tokens that are with the slaves.
    tokens_out: u16,
}

/// What slaves have reported of a frame or picture that not all have finished.
#[derive(Debug, Default)]
struct SlaveReports {
    slaves: usize,
    entries: Vec<u64>,
}

struct RegionMaster {
    gp: Gp,
    config: RenderingControlConfig,
    completed: Completed,
    edits_begun: u64,
    transforms_allowed: u64,
    swaps_requested: u64,
    edited: SlaveReports,
    /// Of pictures `completed.transformed`, and the one after it.
    transformed: VecDeque<SlaveReports>,
    /// Weights of the regions of transformed pictures that are not rendered yet.
    weights: VecDeque<Vec<u64>>,
    rendering: Option<Rendering>,
    renderers: Vec<RendererUse>,
    /// Regions that have arrived in each frame buffer.
    copied_regions: Vec<u64>,
    next_slave: usize,
}

/// Runs the master.
///
/// # Errors
///
/// [`Fault::Protocol`] for a message that no board sends, [`Fault::Memory`] if the program does not fit.
pub async fn master(gp: Gp, config: RenderingControlConfig) -> Result<(), Fault> {
    gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
    let mut master = RegionMaster::new(gp, config);
    loop {
        while master.begin_one().await {}
        if let Some(received) = master.wait().await {
            master.gp.spend_message().await;
            master.note(&received).await?;
        }
    }
}

impl RegionMaster {
    fn new(gp: Gp, config: RenderingControlConfig) -> Self {
        Self {
            completed: Completed::none(config.eyes()),
            edits_begun: 0,
            transforms_allowed: 0,
            swaps_requested: 0,
            edited: SlaveReports::default(),
            transformed: VecDeque::new(),
            weights: VecDeque::new(),
            rendering: None,
            renderers: vec![RendererUse::Idle; config.renderers.len()],
            copied_regions: vec![0; config.frame_buffers.len()],
            next_slave: 0,
            gp,
            config,
        }
    }

    /// Waits for a message or for a frame buffer to swap.
    async fn wait(&self) -> Option<Received> {
        self.gp.until("a message or a swap", || self.message_or_swap()).await
    }

    /// `Some(Some(message))`, or `Some(None)` when frame buffers have swapped since the last look.
    fn message_or_swap(&self) -> Option<Option<Received>> {
        match self.gp.take_message() {
            Some(received) => Some(Some(received)),
            None => (self.swaps_shown() > self.completed.swapped).then_some(None),
        }
    }

    fn swaps_shown(&self) -> u64 {
        self.config.frame_buffers.iter().map(|node| self.gp.status(*node)).min().unwrap_or(0)
    }

    /// Begins the most urgent thing that the rules allow; false when there is none.
    async fn begin_one(&mut self) -> bool {
        self.completed.swapped = self.swaps_shown();
        self.begin_render();
        if let Some((renderer, picture, region)) = self.copy_that_may_begin() {
            self.copy(renderer, picture, region).await;
        } else if let Some((renderer, region)) = self.region_that_may_begin() {
            self.send_token(renderer, region).await;
        } else if self.completed.may_swap(self.swaps_requested) && self.completed.swapped == self.swaps_requested {
            self.swap().await;
        } else if self.completed.may_edit(self.edits_begun) {
            self.edit().await;
        } else if self.a_later_eye_may_begin() {
            self.allow_transform().await;
        } else {
            return false;
        }
        true
    }

    async fn edit(&mut self) {
        let frame = self.edits_begun;
        self.edits_begun += 1;
        self.transforms_allowed = frame * self.config.eyes() + 1;
        self.tell_slaves(&StageOrder::Edit(frame)).await;
    }

    fn a_later_eye_may_begin(&self) -> bool {
        let picture = self.transforms_allowed;
        !picture.is_multiple_of(self.config.eyes()) && self.completed.may_transform(picture)
    }

    async fn allow_transform(&mut self) {
        let picture = self.transforms_allowed;
        self.transforms_allowed += 1;
        self.tell_slaves(&StageOrder::Transform(picture)).await;
    }

    async fn tell_slaves(&self, order: &StageOrder) {
        let (words, body) = order.message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
    }

    /// Sorts the regions of the next picture, heaviest first.
    fn begin_render(&mut self) {
        let picture = self.completed.rendered;
        if self.rendering.is_some() || !self.completed.may_render(picture) {
            return;
        }
        let weights = self.weights.pop_front().unwrap_or_default();
        let mut regions: Vec<_> = (0..self.config.grid().regions() as usize).collect();
        regions.sort_by_key(|region| std::cmp::Reverse(weights.get(*region).copied().unwrap_or(0)));
        let unassigned = regions.into_iter().map(|region| RegionId(region as u16)).collect();
        self.gp.begin(Stage::Render, self.config.frame_of(picture), Some(self.config.eye_of(picture)));
        self.rendering = Some(Rendering { picture, unassigned, tokens_out: 0 });
    }

    fn region_that_may_begin(&self) -> Option<(usize, RegionId)> {
        let region = *self.rendering.as_ref()?.unassigned.front()?;
        let renderer = self.renderers.iter().position(|state| *state == RendererUse::Idle)?;
        Some((renderer, region))
    }

    /// Gives the token of a region to the next slave in turn.
    async fn send_token(&mut self, renderer: usize, region: RegionId) {
        let Some(rendering) = &mut self.rendering else { return };
        rendering.unassigned.pop_front();
        rendering.tokens_out += 1;
        let picture = rendering.picture;
        self.renderers[renderer] = RendererUse::Receiving;
        let slave = self.config.slaves[self.next_slave];
        self.next_slave = (self.next_slave + 1) % self.config.slaves.len();
        let token = Token {
            picture,
            region,
            renderer: renderer as u16,
            slaves_left: self.config.slaves.len() as u16,
            copy: self.completed.frame_buffer_available(picture),
        };
        let (words, body) = StageOrder::Token(token).message();
        self.gp.send(slave, words, body).await;
    }

    fn copy_that_may_begin(&self) -> Option<(usize, u64, RegionId)> {
        self.renderers.iter().enumerate().find_map(|(renderer, state)| match *state {
            RendererUse::Holding(picture, region) if self.completed.frame_buffer_available(picture) => {
                Some((renderer, picture, region))
            }
            _ => None,
        })
    }

    /// Sends the copy command of a region whose frame buffer was not available in time for the last slave.
    async fn copy(&mut self, renderer: usize, picture: u64, region: RegionId) {
        self.renderers[renderer] = RendererUse::Idle;
        let order = self.copy_order(picture, region);
        let list = copy_message(self.config.picture.layout, vec![order], self.config.picture.pixels);
        self.gp.send(self.config.renderers[renderer], list.words(), Body::Commands(list)).await;
    }

    fn copy_order(&self, picture: u64, region: RegionId) -> CopyOrder {
        copy_order(&self.config, picture, region)
    }

    async fn swap(&mut self) {
        let buffer = RenderingControlConfig::buffer_of(self.swaps_requested);
        self.swaps_requested += 1;
        let requests = self.config.frame_buffers.iter().map(|node| (*node, 2, Body::Words(swap_request(buffer))));
        self.gp.send_batch(requests.collect()).await;
    }

    async fn note(&mut self, received: &Received) -> Result<(), Fault> {
        match StageOrder::read(received, self.gp.node())? {
            StageOrder::Send(view) => self.completed.sent = view.number + 1,
            StageOrder::Edited(frame) => self.note_edited(frame).await,
            StageOrder::Transformed(picture, entries) => self.note_transformed(picture, &entries),
            StageOrder::Accepted(token) => self.note_accepted(token),
            StageOrder::Copied { frame_buffer } => self.note_copied(frame_buffer),
            other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at the master: {other:?}") }),
        }
        Ok(())
    }

    async fn note_edited(&mut self, frame: u64) {
        self.edited.slaves += 1;
        if self.edited.slaves == self.config.slaves.len() {
            self.edited = SlaveReports::default();
            self.completed.edited = frame + 1;
            let (words, body) = StageOrder::EditsDone(frame).message();
            self.gp.send(self.config.host, words, body).await;
        }
    }

    fn note_transformed(&mut self, picture: u64, entries: &[u32]) {
        let place = (picture - self.completed.transformed) as usize;
        while self.transformed.len() <= place {
            self.transformed.push_back(SlaveReports { slaves: 0, entries: vec![0; entries.len()] });
        }
        let reports = &mut self.transformed[place];
        reports.slaves += 1;
        reports.entries.iter_mut().zip(entries).for_each(|(sum, n)| *sum += u64::from(*n));
        while self.transformed.front().is_some_and(|reports| reports.slaves == self.config.slaves.len()) {
            self.weights.extend(self.transformed.pop_front().map(|reports| reports.entries));
            self.completed.transformed += 1;
        }
    }

    fn note_accepted(&mut self, token: Token) {
        let held = RendererUse::Holding(token.picture, token.region);
        self.renderers[usize::from(token.renderer)] = if token.copy { RendererUse::Idle } else { held };
        let Some(rendering) = &mut self.rendering else { return };
        rendering.tokens_out -= 1;
        if rendering.tokens_out == 0 && rendering.unassigned.is_empty() {
            let picture = rendering.picture;
            self.gp.end(Stage::Render, self.config.frame_of(picture), Some(self.config.eye_of(picture)));
            self.completed.rendered += 1;
            self.rendering = None;
        }
    }

    fn note_copied(&mut self, frame_buffer: NodeId) {
        if let Some(eye) = self.config.frame_buffers.iter().position(|node| *node == frame_buffer) {
            self.copied_regions[eye] += 1;
        }
        while self.is_copied(self.completed.copied) {
            self.completed.copied += 1;
        }
    }

    /// Regions reach a frame buffer picture by picture, so a count is enough.
    fn is_copied(&self, picture: u64) -> bool {
        let regions = u64::from(self.config.grid().regions());
        self.copied_regions[self.config.eye_of(picture).index()] >= regions * (self.config.frame_of(picture) + 1)
    }
}

pub(crate) fn copy_order(config: &RenderingControlConfig, picture: u64, region: RegionId) -> CopyOrder {
    CopyOrder {
        target: config.target(picture, region),
        context: 0,
        through_backing: true,
        acknowledge: Some(config.master),
    }
}
