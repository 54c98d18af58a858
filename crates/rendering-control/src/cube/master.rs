//! Program of the master, which synchronizes host, slaves, renderers and display memories.

use crate::cube::config::CubeControlConfig;
use crate::cube::protocol::{Token, UpdateOrder};
use crate::cube::rules::Completed;
use crate::cube::update::FaceUpdate;
use pphigs::{PROGRAM_BYTES, copy_message};
use pxpl5_gp::{Account, Fault, Gp, Received, Stage};
use pxpl5_wire::{Body, CopyOrder, CopyPath, CopyTarget, PictureNumber, RegionId, SurfaceId};
use std::collections::VecDeque;

/// State of a renderer, derived from the messages that the master has received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RendererUse {
    Idle,
    /// The slaves hold the token of a region that this renderer draws.
    Receiving,
    /// The renderer holds a finished region in pixel memory, until the region's display memory is available.
    Holding(CopyTarget),
}

/// Progress of an update that is not complete.
#[derive(Debug)]
struct UpdateProgress {
    update: FaceUpdate,
    /// Number of earlier updates of the same display memory. After as many swaps, the hidden buffer of the memory is
    /// free.
    before: u64,
    /// Number of slaves that have applied the edits.
    edited: usize,
    /// Number of slaves that have transformed the update.
    transformed: usize,
    /// Number of entries in each region's bin, summed over the slaves that have transformed the update.
    entries: Vec<u64>,
    /// True if the master has announced the update to its display memory, by a list of the regions that will arrive.
    announced: bool,
    /// Number of regions of this update that have not arrived in the display memory. `None` before RENDER begins.
    missing: Option<u64>,
}

impl UpdateProgress {
    /// Returns the regions with primitives, the regions with the most bin entries first. An update without primitives
    /// has one region, so that its end is detected.
    fn regions(&self) -> VecDeque<RegionId> {
        let mut regions: Vec<usize> = (0..self.entries.len()).filter(|region| self.entries[*region] > 0).collect();
        if regions.is_empty() {
            regions.push(0);
        }
        regions.sort_by_key(|region| std::cmp::Reverse(self.entries[*region]));
        regions.into_iter().map(|region| RegionId(region as u16)).collect()
    }
}

/// Progress of RENDER for one update.
#[derive(Debug)]
struct Rendering {
    number: PictureNumber,
    /// Regions without a renderer, the regions with the most bin entries first.
    unassigned: VecDeque<RegionId>,
    regions: u16,
    /// Number of tokens that have not returned from the slaves.
    tokens_out: u16,
}

struct CubeMaster {
    gp: Gp,
    config: CubeControlConfig,
    completed: Completed,
    /// The first update for which the master has not ordered EDIT.
    next_edit: PictureNumber,
    /// Updates that are not complete, oldest first. The oldest has the number `completed.copied`.
    under_way: VecDeque<UpdateProgress>,
    /// For each memory, the number of updates that the host has sent so far.
    of_memories: Vec<u64>,
    rendering: Option<Rendering>,
    renderers: Vec<RendererUse>,
    next_slave: usize,
    /// Number of swaps of all display memories at the master's last check.
    swaps_known: u64,
}

/// Runs the program of the master.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] for an invalid message, and [`Fault::Memory`] if the program does not fit into memory.
pub async fn master(gp: Gp, config: CubeControlConfig) -> Result<(), Fault> {
    gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
    let mut master = CubeMaster::new(gp, config);
    loop {
        while master.begin_one().await {}
        if let Some(received) = master.wait().await {
            master.gp.pay_for(&received).await;
            master.note(&received).await?;
        }
    }
}

impl CubeMaster {
    fn new(gp: Gp, config: CubeControlConfig) -> Self {
        Self {
            completed: Completed::default(),
            next_edit: PictureNumber::FIRST,
            under_way: VecDeque::new(),
            of_memories: vec![0; config.faces.memories.len()],
            rendering: None,
            renderers: vec![RendererUse::Idle; config.renderers.len()],
            next_slave: 0,
            swaps_known: 0,
            gp,
            config,
        }
    }

    /// Waits for a message or for a swap of a display memory.
    async fn wait(&self) -> Option<Received> {
        self.gp.until("a message or a swap", || self.message_or_swap()).await
    }

    /// Returns `Some(Some(message))` if a message has arrived. Returns `Some(None)` if a memory has swapped since the
    /// last check. Otherwise returns `None`.
    fn message_or_swap(&self) -> Option<Option<Received>> {
        match self.gp.take_message() {
            Some(received) => Some(Some(received)),
            None => (self.swaps() > self.swaps_known).then_some(None),
        }
    }

    fn swaps(&self) -> u64 {
        self.config.faces.memories.iter().map(|node| self.gp.status(*node)).sum()
    }

    fn under_way(&self, update: PictureNumber) -> Option<&UpdateProgress> {
        self.under_way.get(self.place(update)?)
    }

    fn under_way_mut(&mut self, update: PictureNumber) -> Option<&mut UpdateProgress> {
        let place = self.place(update)?;
        self.under_way.get_mut(place)
    }

    fn place(&self, update: PictureNumber) -> Option<usize> {
        update.0.checked_sub(self.completed.copied).map(|place| place as usize)
    }

    /// Begins the most urgent action that the rules permit. Returns false if the rules permit no action.
    async fn begin_one(&mut self) -> bool {
        self.swaps_known = self.swaps();
        // Order of urgency: announce, copy, token, edit.
        self.begin_render();
        if let Some(place) = self.next_announcement() {
            self.announce(place).await;
        } else if let Some((renderer, target)) = self.next_allowed_copy() {
            self.copy(renderer, target).await;
        } else if let Some((renderer, region)) = self.next_allowed_region() {
            self.send_token(renderer, region).await;
        } else if self.completed.may_edit(self.next_edit) {
            self.edit().await;
        } else {
            return false;
        }
        true
    }

    async fn edit(&mut self) {
        let update = self.next_edit;
        self.next_edit = update.next();
        let (words, body) = UpdateOrder::Edit(update).message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
    }

    /// Returns the index in `under_way` of the first update that the master can announce to its memory. All slaves must
    /// have transformed the update, and the memory must show its previous update.
    fn next_announcement(&self) -> Option<usize> {
        self.under_way.iter().position(|one| {
            let is_known = one.transformed == self.config.slaves.len();
            let port = self.config.faces.memories[usize::from(one.update.memory)];
            is_known && !one.announced && self.gp.status(port) >= one.before
        })
    }

    /// Announces an update to its display memory. The master sends the list of the regions that will arrive, and
    /// requests the swap.
    async fn announce(&mut self, place: usize) {
        let texels = self.config.faces.face_texels();
        let one = &mut self.under_way[place];
        one.announced = true;
        let regions: Vec<RegionId> = one.regions().into();
        let messages = one.update.announcement(texels, &regions).map(|words| (words.len() as u32, Body::Words(words)));
        let port = self.config.faces.memories[usize::from(one.update.memory)];
        self.gp.send_groups(vec![(port, messages.into())]).await;
    }

    /// Begins RENDER of the next update if the rules permit it. The regions with the most bin entries come first.
    fn begin_render(&mut self) {
        let number = PictureNumber(self.completed.rendered);
        if self.rendering.is_some() || !self.completed.may_render(number) {
            return;
        }
        let Some(one) = self.under_way_mut(number) else { return };
        let unassigned = one.regions();
        let regions = unassigned.len() as u16;
        one.missing = Some(unassigned.len() as u64);
        self.gp.begin(Stage::Render, number, Some(SurfaceId(0)));
        self.rendering = Some(Rendering { number, unassigned, regions, tokens_out: 0 });
    }

    fn next_allowed_region(&self) -> Option<(usize, RegionId)> {
        let region = *self.rendering.as_ref()?.unassigned.front()?;
        let renderer = self.renderers.iter().position(|state| *state == RendererUse::Idle)?;
        Some((renderer, region))
    }

    /// Sends the token of a region to a slave. The slaves take turns as the first holder of a token.
    async fn send_token(&mut self, renderer: usize, region: RegionId) {
        let Some(rendering) = &mut self.rendering else { return };
        rendering.unassigned.pop_front();
        rendering.tokens_out += 1;
        let update = rendering.number;
        let of = rendering.regions;
        self.renderers[renderer] = RendererUse::Receiving;
        // The slaves take turns as the first holder of a token, to balance their load.
        let slave = self.config.slaves[self.next_slave];
        self.next_slave = (self.next_slave + 1) % self.config.slaves.len();
        let slaves_left = self.config.slaves.len() as u16;
        // If the memory is available, the last slave adds the copy command.
        let copies = self.is_announced(update);
        let token = Token { update, region, renderer: renderer as u16, slaves_left, of, copies };
        let (words, body) = UpdateOrder::Token(token).message();
        self.gp.send(slave, words, body).await;
    }

    fn is_announced(&self, update: PictureNumber) -> bool {
        self.under_way(update).is_none_or(|one| one.announced)
    }

    /// Returns a renderer with a finished region whose display memory has become available, and the destination of the
    /// region.
    fn next_allowed_copy(&self) -> Option<(usize, CopyTarget)> {
        self.renderers.iter().enumerate().find_map(|(renderer, state)| match state {
            RendererUse::Holding(target) => self.is_announced(target.picture).then_some((renderer, *target)),
            RendererUse::Idle | RendererUse::Receiving => None,
        })
    }

    /// Sends the copy command of a region. When the token of this region was sent, the display memory was not
    /// available.
    async fn copy(&mut self, renderer: usize, target: CopyTarget) {
        self.renderers[renderer] = RendererUse::Idle;
        let order = copy_order(&self.config, target);
        let list = copy_message(self.config.faces.picture.layout, vec![order], self.config.faces.picture.pixels);
        self.gp.send(self.config.renderers[renderer], list.words(), Body::Commands(list)).await;
    }

    async fn note(&mut self, received: &Received) -> Result<(), Fault> {
        match UpdateOrder::read(received, self.gp.node())? {
            UpdateOrder::Send(update) => self.note_sent(update),
            UpdateOrder::Edited(update) => self.note_edited(update).await,
            UpdateOrder::Transformed(update, entries) => self.note_transformed(update, &entries),
            UpdateOrder::Accepted(token) => self.note_accepted(token),
            UpdateOrder::Copied { update } => self.note_copied(update),
            other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at the master: {other:?}") }),
        }
        Ok(())
    }

    fn note_sent(&mut self, update: FaceUpdate) {
        self.completed.sent = update.number.next().0;
        let of_memory = &mut self.of_memories[usize::from(update.memory)];
        let before = *of_memory;
        *of_memory += 1;
        let entries = vec![0; usize::from(self.config.faces.regions())];
        let fresh =
            UpdateProgress { update, before, edited: 0, transformed: 0, entries, announced: false, missing: None };
        self.under_way.push_back(fresh);
    }

    async fn note_edited(&mut self, update: PictureNumber) {
        let slaves = self.config.slaves.len();
        let Some(one) = self.under_way_mut(update) else { return };
        one.edited += 1;
        if one.edited == slaves {
            let (words, body) = UpdateOrder::EditsDone(update).message();
            self.gp.send(self.config.host, words, body).await;
        }
    }

    fn note_transformed(&mut self, update: PictureNumber, entries: &[u32]) {
        let slaves = self.config.slaves.len();
        let Some(one) = self.under_way_mut(update) else { return };
        one.transformed += 1;
        one.entries.iter_mut().zip(entries).for_each(|(sum, n)| *sum += u64::from(*n));
        while self.under_way(PictureNumber(self.completed.transformed)).is_some_and(|one| one.transformed == slaves) {
            self.completed.transformed += 1;
        }
    }

    fn note_accepted(&mut self, token: Token) {
        let renderer = usize::from(token.renderer);
        let target = self.under_way(token.update).map(|one| self.config.faces.target(&one.update, token.region));
        // Without a copy command, the renderer holds the region.
        let held = target.filter(|_| !token.copies);
        self.renderers[renderer] = held.map_or(RendererUse::Idle, RendererUse::Holding);
        let Some(rendering) = &mut self.rendering else { return };
        rendering.tokens_out -= 1;
        // RENDER ends with the last token.
        if rendering.tokens_out == 0 && rendering.unassigned.is_empty() {
            self.gp.end(Stage::Render, rendering.number, Some(SurfaceId(0)));
            self.completed.rendered += 1;
            self.rendering = None;
            self.remove_finished();
        }
    }

    /// Records that a region has arrived. `low` is the low word of the update's number.
    fn note_copied(&mut self, low: u32) {
        let of_update = |one: &&mut UpdateProgress| one.update.number.to_words()[0] == low;
        if let Some(missing) = self.under_way.iter_mut().find(of_update).and_then(|one| one.missing.as_mut()) {
            *missing = missing.saturating_sub(1);
        }
        self.remove_finished();
    }

    /// Removes complete updates: their commands have been accepted, and their regions have arrived.
    fn remove_finished(&mut self) {
        while self.completed.rendered > self.completed.copied
            && self.under_way.front().is_some_and(|one| one.missing == Some(0))
        {
            self.under_way.pop_front();
            self.completed.copied += 1;
        }
    }
}

pub(crate) fn copy_order(config: &CubeControlConfig, target: CopyTarget) -> CopyOrder {
    let way = CopyPath::ThroughBacking;
    CopyOrder { target, context: 0, way, acknowledge: Some(config.master), content: config.faces.content }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::slave::tests::{TOKEN, config, update};
    use pxpl5_gp::{GpBoard, GpTiming, Priority};
    use pxpl5_sim::Span;
    use pxpl5_wire::NodeId;

    /// The last region can arrive before the message that its commands were accepted.
    #[test]
    fn an_update_is_over_when_its_regions_have_arrived_and_its_commands_were_accepted() {
        for accepted_first in [true, false] {
            let board = GpBoard::new(NodeId(1), GpTiming::PAPERS, Span(25_000));
            let mut master = CubeMaster::new(board.handle_for(Priority::Foreground), config());
            master.note_sent(update(0));
            master.note_transformed(PictureNumber::FIRST, &[1, 0, 0, 0, 0, 0]);
            master.begin_render();
            let rendering = master.rendering.as_mut().expect("it is transformed");
            // This is the state after the token of the update's single region was sent.
            (rendering.unassigned, rendering.tokens_out) = (VecDeque::new(), 1);
            for is_token in [accepted_first, !accepted_first] {
                assert_eq!((master.completed.copied, master.under_way.len()), (0, 1), "{accepted_first}");
                if is_token { master.note_accepted(TOKEN) } else { master.note_copied(0) }
            }
            assert_eq!((master.completed.rendered, master.completed.copied), (1, 1));
            assert!(master.under_way.is_empty());
        }
    }
}
