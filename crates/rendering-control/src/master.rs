//! The master's program, which permits each stage to begin and assigns regions to renderers.

use crate::drawn::{Drawn, RenderingControlConfig, Sent};
use crate::protocol::{RegionEnd, StageOrder, Token};
use crate::rules::{Completed, Drawing};
use pphigs::{PROGRAM_BYTES, copy_message};
use pxpl5_gp::{Account, Fault, Gp, Received, Stage};
use pxpl5_wire::{Body, CopyOrder, CopyPath, CopyTarget, NodeId, PictureNumber, RegionId, SurfaceId, Word};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// State of a renderer, which the master infers from messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RendererUse {
    Idle,
    /// The slaves send the bins of a region to this renderer.
    Receiving,
    /// The renderer keeps a finished region in pixel memory, because the region cannot be copied yet.
    Holding(Drawing, RegionId),
}

/// A copy of a finished region that may begin now.
#[derive(Clone, Copy, Debug)]
struct AllowedCopy {
    renderer: usize,
    drawing: Drawing,
    region: RegionId,
    way: CopyPath,
}

/// Progress of a drawing that the host has sent and that is not complete in its frame buffer.
#[derive(Debug)]
struct DrawingProgress<S> {
    drawing: Drawing,
    sent: Arc<S>,
    /// Number of earlier drawings in the same frame buffer. The hidden half of the frame buffer is free after this
    /// number of swaps.
    before: u64,
    /// Number of slaves that have transformed the drawing.
    slaves: usize,
    /// Number of entries in each region's bin, summed over the slaves that have transformed the drawing.
    entries: Vec<u64>,
    announced: bool,
    /// Number of regions that have not arrived in the frame buffer yet. `None` before RENDER.
    missing: Option<u64>,
}

impl<S> DrawingProgress<S> {
    /// Returns the regions to draw, those with the most bin entries first. Regions without entries are included only if
    /// `empty` is true. If no region has entries, region 0 is drawn, so that the end of the drawing can be detected.
    fn regions(&self, empty: bool) -> VecDeque<RegionId> {
        let mut regions: Vec<usize> = (0..self.entries.len()).filter(|i| empty || self.entries[*i] > 0).collect();
        if regions.is_empty() {
            regions.push(0);
        }
        regions.sort_by_key(|region| std::cmp::Reverse(self.entries[*region]));
        regions.into_iter().map(|region| RegionId(region as u16)).collect()
    }
}

#[derive(Debug)]
struct RenderStage {
    drawing: Drawing,
    /// Regions without a renderer, in the order in which they will be drawn.
    unassigned: VecDeque<RegionId>,
    regions: u16,
    /// Number of tokens that are still with the slaves.
    tokens_out: u16,
}

struct RegionMaster<D: Drawn> {
    gp: Gp,
    config: RenderingControlConfig<D>,
    completed: Completed,
    /// First picture for which the master has not permitted EDIT.
    next_edit: PictureNumber,
    /// First drawing for which the master has not permitted TRANSFORM.
    next_transform: Drawing,
    /// First picture for which the master has not requested the swap.
    next_swap: PictureNumber,
    /// Number of slaves that have finished EDIT of the current picture.
    edited: usize,
    /// Drawings that the host has sent and that are not complete in a frame buffer, oldest first.
    under_way: VecDeque<DrawingProgress<D::Sent>>,
    /// For each frame buffer, the number of drawings that the host has sent so far.
    of_buffers: BTreeMap<NodeId, u64>,
    rendering: Option<RenderStage>,
    renderers: Vec<RendererUse>,
    /// Finished regions in the backing store of each renderer, oldest first.
    stored: Vec<VecDeque<(Drawing, RegionId)>>,
    next_slave: usize,
}

/// Runs the master's program.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] after an unknown message, or [`Fault::Memory`] if the program does not fit into memory.
pub async fn master<D: Drawn>(gp: Gp, config: RenderingControlConfig<D>) -> Result<(), Fault> {
    gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
    let mut master = RegionMaster::new(gp, config);
    loop {
        while master.begin_one().await {}
        if let Some(received) = master.wait().await {
            master.gp.pay_for(&received).await;
            master.note(&received).await?;
        }
    }
}

impl<D: Drawn> RegionMaster<D> {
    fn new(gp: Gp, config: RenderingControlConfig<D>) -> Self {
        Self {
            completed: Completed::none(config.drawn.eyes()),
            next_edit: PictureNumber::FIRST,
            next_transform: Drawing::default(),
            next_swap: PictureNumber::FIRST,
            edited: 0,
            under_way: VecDeque::new(),
            of_buffers: BTreeMap::new(),
            rendering: None,
            renderers: vec![RendererUse::Idle; config.renderers.len()],
            stored: vec![VecDeque::new(); config.renderers.len()],
            next_slave: 0,
            gp,
            config,
        }
    }

    /// Waits for a message or a swap. Returns `None` after a swap.
    async fn wait(&self) -> Option<Received> {
        self.gp.until("a message or a swap", || self.message_or_swap()).await
    }

    /// Returns the next message as `Some(Some(message))`. Returns `Some(None)` if no message has arrived and frame
    /// buffers have swapped since the last call of `begin_one`. Returns `None` if the master must wait.
    fn message_or_swap(&self) -> Option<Option<Received>> {
        match self.gp.take_message() {
            Some(received) => Some(Some(received)),
            None => (self.config.drawn.swaps(&self.gp) > self.completed.swapped).then_some(None),
        }
    }

    fn progress(&self, drawing: Drawing) -> Option<&DrawingProgress<D::Sent>> {
        self.under_way.get(self.place(drawing)?)
    }

    fn progress_mut(&mut self, drawing: Drawing) -> Option<&mut DrawingProgress<D::Sent>> {
        let place = self.place(drawing)?;
        self.under_way.get_mut(place)
    }

    fn place(&self, drawing: Drawing) -> Option<usize> {
        drawing.0.checked_sub(self.under_way.front()?.drawing.0).map(|place| place as usize)
    }

    fn target(&self, one: &DrawingProgress<D::Sent>, region: RegionId) -> CopyTarget {
        self.config.drawn.target(&one.sent, self.config.eye_of(one.drawing), region)
    }

    fn surface_of(&self, drawing: Drawing) -> SurfaceId {
        SurfaceId(self.config.eye_of(drawing) as u16)
    }

    /// Begins the most urgent action that the rules permit now. Returns false if the rules permit none.
    async fn begin_one(&mut self) -> bool {
        self.completed.swapped = self.config.drawn.swaps(&self.gp);
        self.begin_render();
        // In order of urgency: announcements, copies, tokens, the swap, EDIT, TRANSFORM of a later eye.
        if let Some(place) = self.next_announcement() {
            self.announce(place).await;
        } else if let Some(copying) = self.next_allowed_copy() {
            self.copy(copying).await;
        } else if let Some((renderer, region)) = self.next_allowed_region() {
            self.send_token(renderer, region).await;
        } else if self.may_swap() {
            self.swap().await;
        } else if self.completed.may_edit(self.next_edit) {
            self.edit().await;
        } else if self.later_eye_may_transform() {
            self.permit_transform().await;
        } else {
            return false;
        }
        true
    }

    /// Returns the index in `under_way` of the first drawing that can be announced. All slaves must have finished
    /// TRANSFORM of the drawing, and the hidden half of its frame buffer must be free.
    fn next_announcement(&self) -> Option<usize> {
        let may_begin = |one: &DrawingProgress<D::Sent>| {
            let is_known = one.slaves == self.config.slaves.len();
            is_known && !one.announced && self.gp.status(self.target(one, RegionId(0)).frame_buffer) >= one.before
        };
        self.under_way.iter().position(may_begin).filter(|_| D::ANNOUNCES)
    }

    /// Announces a drawing to its frame buffer: sends the list of regions that will arrive, and the swap request.
    async fn announce(&mut self, place: usize) {
        debug_assert_eq!(self.config.drawn.eyes(), 1, "an announcement does not name an eye");
        self.under_way[place].announced = true;
        let one = &self.under_way[place];
        let messages = self.config.drawn.announcement(&one.sent, one.regions(false).make_contiguous());
        let port = self.target(one, RegionId(0)).frame_buffer;
        self.gp.send_groups(vec![(port, messages)]).await;
    }

    fn may_swap(&self) -> bool {
        let picture = self.next_swap;
        !D::ANNOUNCES && self.completed.may_swap(picture) && self.completed.swapped == picture.0
    }

    async fn swap(&mut self) {
        let requests = self.config.drawn.swap_requests(self.next_swap);
        self.next_swap = self.next_swap.next();
        self.gp.send_batch(requests).await;
    }

    async fn edit(&mut self) {
        let picture = self.next_edit;
        self.next_edit = picture.next();
        self.next_transform = self.config.first_of(picture).after(1);
        self.send_to_slaves(&StageOrder::Edit(picture)).await;
    }

    fn later_eye_may_transform(&self) -> bool {
        let drawing = self.next_transform;
        self.config.eye_of(drawing) != 0 && self.completed.may_transform(drawing)
    }

    async fn permit_transform(&mut self) {
        let drawing = self.next_transform;
        self.next_transform = drawing.after(1);
        self.send_to_slaves(&StageOrder::Transform(drawing)).await;
    }

    async fn send_to_slaves(&self, order: &StageOrder<D::Sent>) {
        let (words, body) = order.message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
    }

    fn begin_render(&mut self) {
        let drawing = Drawing(self.completed.rendered);
        if self.rendering.is_some() || !self.completed.may_render(drawing) {
            return;
        }
        let Some(one) = self.progress_mut(drawing) else { return };
        let unassigned = one.regions(!D::ANNOUNCES);
        let regions = unassigned.len() as u16;
        one.missing = Some(regions.into());
        self.gp.begin(Stage::Render, self.config.picture_of(drawing), Some(self.surface_of(drawing)));
        self.rendering = Some(RenderStage { drawing, unassigned, regions, tokens_out: 0 });
    }

    fn next_allowed_region(&self) -> Option<(usize, RegionId)> {
        let region = *self.rendering.as_ref()?.unassigned.front()?;
        let renderer = self.renderers.iter().position(|state| *state == RendererUse::Idle)?;
        Some((renderer, region))
    }

    /// Creates the token of a region and sends the token to a slave. The first token goes to slave 0, the second to
    /// slave 1, and so on, so that the slaves share the work.
    async fn send_token(&mut self, renderer: usize, region: RegionId) {
        // The renderer receives commands from all slaves in turn.
        let Some(rendering) = &mut self.rendering else { return };
        rendering.unassigned.pop_front();
        rendering.tokens_out += 1;
        let RenderStage { drawing, regions: of, .. } = *rendering;
        self.renderers[renderer] = RendererUse::Receiving;
        // Each token starts at another slave, so that the slaves share the work.
        let slave = self.config.slaves[self.next_slave];
        self.next_slave = (self.next_slave + 1) % self.config.slaves.len();
        let slaves_left = self.config.slaves.len() as u16;
        let end = self.end_of(renderer, drawing);
        let token = Token { drawing, region, renderer: renderer as u16, slaves_left, of, end };
        let (words, body) = StageOrder::<D::Sent>::Token(token).message();
        self.gp.send(slave, words, body).await;
    }

    /// Returns true if COPY of a drawing may begin. An announced drawing may be copied after its announcement, and
    /// other drawings follow the rules of TR94.
    fn may_copy(&self, drawing: Drawing) -> bool {
        if D::ANNOUNCES {
            self.progress(drawing).is_none_or(|one| one.announced)
        } else {
            self.completed.may_copy(drawing)
        }
    }

    /// Returns the action of `renderer` after the last commands of a region. The region is copied if COPY may begin, is
    /// stored if the backing store has room, and otherwise stays in pixel memory.
    fn end_of(&self, renderer: usize, drawing: Drawing) -> RegionEnd {
        let room = self.config.drawn.regions_stored();
        if self.may_copy(drawing) {
            RegionEnd::Copied
        } else if self.stored[renderer].len() < room {
            RegionEnd::Stored
        } else {
            // Under the other rule for finished regions, the regions wait in pixel memory, for any capacity of the
            // store.
            if room > 0 {
                self.gp.note_full_store();
            }
            RegionEnd::Held
        }
    }

    /// Returns a copy that may begin, or `None`. If several renderers have such a copy, the renderer with the lowest
    /// index is chosen. A region in the backing store is copied before a region in pixel memory.
    fn next_allowed_copy(&self) -> Option<AllowedCopy> {
        (0..self.renderers.len()).find_map(|renderer| {
            let (drawing, region, way) = match (self.stored[renderer].front(), self.renderers[renderer]) {
                (Some((drawing, region)), _) => (*drawing, *region, CopyPath::FromBacking),
                (None, RendererUse::Holding(drawing, region)) => (drawing, region, CopyPath::ThroughBacking),
                _ => return None,
            };
            self.may_copy(drawing).then_some(AllowedCopy { renderer, drawing, region, way })
        })
    }

    /// Sends the copy command of a region. The last slave could not send this command, because COPY was not permitted
    /// when the token was created.
    async fn copy(&mut self, AllowedCopy { renderer, drawing, region, way }: AllowedCopy) {
        match way {
            CopyPath::FromBacking => drop(self.stored[renderer].pop_front()),
            _ => self.renderers[renderer] = RendererUse::Idle,
        }
        let Some(one) = self.progress(drawing) else { return };
        let order = self.config.copy_order(self.target(one, region), way);
        let picture = self.config.drawn.picture();
        let list = copy_message(picture.layout, vec![order], picture.pixels);
        self.gp.send(self.config.renderers[renderer], list.words(), Body::Commands(list)).await;
    }

    async fn note(&mut self, received: &Received) -> Result<(), Fault> {
        match StageOrder::read(received, self.gp.node())? {
            StageOrder::Send(sent) => self.note_sent(sent),
            StageOrder::Edited(picture) => self.note_edited(picture).await,
            StageOrder::Transformed(drawing, entries) => self.note_transformed(drawing, &entries),
            StageOrder::Accepted(token) => self.note_accepted(token),
            StageOrder::Copied { picture, frame_buffer } => self.note_copied(picture, frame_buffer),
            other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at the master: {other:?}") }),
        }
        Ok(())
    }

    fn note_sent(&mut self, sent: D::Sent) {
        let first = self.config.first_of(sent.number());
        self.completed.sent = sent.number().next().0;
        let sent = Arc::new(sent);
        let entries = vec![0; usize::from(self.config.drawn.regions())];
        for drawing in (0..self.config.drawn.eyes()).map(|eye| first.after(eye)) {
            let mut one = DrawingProgress {
                drawing,
                sent: Arc::clone(&sent),
                before: 0,
                slaves: 0,
                entries: entries.clone(),
                announced: false,
                missing: None,
            };
            // A frame buffer takes its pictures in this order, so each drawing counts those before it.
            let of_buffer = self.of_buffers.entry(self.target(&one, RegionId(0)).frame_buffer).or_default();
            one.before = *of_buffer;
            *of_buffer += 1;
            self.under_way.push_back(one);
        }
    }

    async fn note_edited(&mut self, picture: PictureNumber) {
        self.edited += 1;
        if self.edited == self.config.slaves.len() {
            self.edited = 0;
            self.completed.edited = picture.next().0;
            let (words, body) = StageOrder::<D::Sent>::EditsDone(picture).message();
            self.gp.send(self.config.host, words, body).await;
        }
    }

    // Slaves may report a later drawing before all slaves have reported the current one.
    fn note_transformed(&mut self, drawing: Drawing, entries: &[u32]) {
        let slaves = self.config.slaves.len();
        let Some(one) = self.progress_mut(drawing) else { return };
        one.slaves += 1;
        one.entries.iter_mut().zip(entries).for_each(|(sum, n)| *sum += u64::from(*n));
        while self.progress(Drawing(self.completed.transformed)).is_some_and(|one| one.slaves == slaves) {
            self.completed.transformed += 1;
        }
    }

    fn note_accepted(&mut self, token: Token) {
        let renderer = usize::from(token.renderer);
        // A region that stays in pixel memory blocks its renderer. The renderer of a stored or copied region is free.
        self.renderers[renderer] = match token.end {
            RegionEnd::Held => RendererUse::Holding(token.drawing, token.region),
            RegionEnd::Stored | RegionEnd::Copied => RendererUse::Idle,
        };
        if token.end == RegionEnd::Stored {
            self.stored[renderer].push_back((token.drawing, token.region));
        }
        // RENDER ends when every region is assigned and every token has returned.
        let Some(rendering) = &mut self.rendering else { return };
        rendering.tokens_out -= 1;
        if rendering.tokens_out == 0 && rendering.unassigned.is_empty() {
            let drawing = rendering.drawing;
            self.gp.end(Stage::Render, self.config.picture_of(drawing), Some(self.surface_of(drawing)));
            self.completed.rendered += 1;
            self.rendering = None;
            self.remove_finished();
        }
    }

    /// Counts a region that has arrived in `frame_buffer`. `low` is the low word of the number of the picture.
    fn note_copied(&mut self, low: Word, frame_buffer: NodeId) {
        let Some(eye) = self.config.drawn.eye_at(frame_buffer) else { return };
        let config = &self.config;
        let is_of = |one: &&mut DrawingProgress<D::Sent>| {
            one.sent.number().to_words()[0] == low && config.eye_of(one.drawing) == eye
        };
        if let Some(missing) = self.under_way.iter_mut().find(is_of).and_then(|one| one.missing.as_mut()) {
            *missing = missing.saturating_sub(1);
        }
        while self.progress(Drawing(self.completed.copied)).is_some_and(|one| one.missing == Some(0)) {
            self.completed.copied += 1;
        }
        self.remove_finished();
    }

    /// Removes the drawings whose commands have all been accepted and whose regions have all arrived.
    fn remove_finished(&mut self) {
        let complete = Drawing(self.completed.rendered.min(self.completed.copied));
        while self.under_way.front().is_some_and(|one| one.drawing < complete) {
            self.under_way.pop_front();
        }
    }
}

impl<D: Drawn> RenderingControlConfig<D> {
    pub(crate) fn copy_order(&self, target: CopyTarget, way: CopyPath) -> CopyOrder {
        CopyOrder { target, context: 0, way, acknowledge: Some(self.master), content: self.drawn.content() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slave::tests::{TOKEN, config, update};
    use pxpl5_gp::{GpBoard, GpTiming, Priority};
    use pxpl5_sim::Span;

    /// Tests both orders of two messages: the arrival of the last region, and the acceptance of its commands.
    #[test]
    fn a_drawing_ends_when_its_regions_arrived_and_its_commands_were_accepted() {
        for accepted_first in [true, false] {
            let board = GpBoard::new(NodeId(1), GpTiming::PAPERS, Span(25_000));
            let mut master = RegionMaster::new(board.handle_for(Priority::Foreground), config());
            master.note_sent(update(0));
            master.note_transformed(Drawing(0), &[1, 0, 0, 0, 0, 0]);
            master.begin_render();
            let rendering = master.rendering.as_mut().expect("it is transformed");
            // This is the state after the token of the drawing's single region was sent.
            (rendering.unassigned, rendering.tokens_out) = (VecDeque::new(), 1);
            for is_token in [accepted_first, !accepted_first] {
                assert_eq!(master.under_way.len(), 1, "{accepted_first}");
                if is_token { master.note_accepted(TOKEN) } else { master.note_copied(0, NodeId(4)) }
            }
            assert_eq!((master.completed.rendered, master.completed.copied), (1, 1));
            assert!(master.under_way.is_empty());
        }
    }
}
