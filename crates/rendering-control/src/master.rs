//! Program of the master, which synchronizes host, slaves, renderers and frame buffers.

use crate::config::RenderingControlConfig;
use crate::protocol::{RegionEnd, StageOrder, Token};
use crate::rules::{Completed, EyeDrawing};
use pphigs::{PROGRAM_BYTES, copy_message};
use pxpl5_gp::{Account, Fault, Gp, Received, Stage};
use pxpl5_wire::{Body, CopyContent, CopyOrder, CopyPath, NodeId, PictureNumber, RegionId, SurfaceId, swap_request};
use std::collections::VecDeque;

/// State of a renderer, derived from the messages that the master has received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RendererUse {
    Idle,
    /// The slaves hold the token of a region that this renderer draws.
    Receiving,
    /// The renderer holds a finished region in pixel memory until the region's frame buffer is available.
    Holding(EyeDrawing, RegionId),
}

/// A copy that the rules permit now.
#[derive(Clone, Copy, Debug)]
struct AllowedCopy {
    renderer: usize,
    drawing: EyeDrawing,
    region: RegionId,
    way: CopyPath,
}

/// Progress of RENDER for one eye.
#[derive(Debug)]
struct RenderStage {
    drawing: EyeDrawing,
    /// Regions without a renderer, the regions with the most bin entries first.
    unassigned: VecDeque<RegionId>,
    /// Number of tokens that have not returned from the slaves.
    tokens_out: u16,
}

/// Reports of the slaves that have finished a stage: the number of reports, and the bin entries of each region, summed
/// over the reports.
#[derive(Debug, Default)]
struct SlaveReports {
    slaves: usize,
    entries: Vec<u64>,
}

struct RegionMaster {
    gp: Gp,
    config: RenderingControlConfig,
    completed: Completed,
    /// The first frame for which the master has not ordered EDIT.
    next_edit: PictureNumber,
    /// The first drawing for which the master has not permitted TRANSFORM.
    next_transform: EyeDrawing,
    /// The next frame for which a swap will be requested.
    next_swap: PictureNumber,
    edited: SlaveReports,
    /// Reports about each drawing (picture of one eye) that not all slaves have transformed. The first entry belongs to
    /// the drawing with the number `completed.transformed`.
    transformed: VecDeque<SlaveReports>,
    /// Number of bin entries of each region, for drawings that are transformed but not rendered.
    weights: VecDeque<Vec<u64>>,
    rendering: Option<RenderStage>,
    renderers: Vec<RendererUse>,
    /// Finished regions in the backing store of each renderer, oldest first. The regions wait for their frame buffer.
    stored: Vec<VecDeque<(EyeDrawing, RegionId)>>,
    /// Number of regions that have arrived in each frame buffer since the start.
    copied_regions: Vec<u64>,
    next_slave: usize,
}

/// Runs the program of the master.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] for an unknown message, or [`Fault::Memory`] if the program does not fit in memory.
pub async fn master(gp: Gp, config: RenderingControlConfig) -> Result<(), Fault> {
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

impl RegionMaster {
    fn new(gp: Gp, config: RenderingControlConfig) -> Self {
        Self {
            completed: Completed::none(config.eyes()),
            next_edit: PictureNumber::FIRST,
            next_transform: EyeDrawing::default(),
            next_swap: PictureNumber::FIRST,
            edited: SlaveReports::default(),
            transformed: VecDeque::new(),
            weights: VecDeque::new(),
            rendering: None,
            renderers: vec![RendererUse::Idle; config.renderers.len()],
            stored: vec![VecDeque::new(); config.renderers.len()],
            copied_regions: vec![0; config.frame_buffers.len()],
            next_slave: 0,
            gp,
            config,
        }
    }

    /// Waits for a message or for a swap of the frame buffers.
    async fn wait(&self) -> Option<Received> {
        self.gp.until("a message or a swap", || self.message_or_swap()).await
    }

    /// Returns `Some(Some(message))` if a message has arrived. Returns `Some(None)` if the frame buffers have swapped
    /// since the last call of `begin_one`. Otherwise returns `None`.
    fn message_or_swap(&self) -> Option<Option<Received>> {
        match self.gp.take_message() {
            Some(received) => Some(Some(received)),
            None => (self.swaps_shown() > self.completed.swapped).then_some(None),
        }
    }

    fn swaps_shown(&self) -> u64 {
        self.config.frame_buffers.iter().map(|node| self.gp.status(*node)).min().unwrap_or(0)
    }

    /// Begins the most urgent action that the rules permit. Returns false if the rules permit no action.
    async fn begin_one(&mut self) -> bool {
        self.completed.swapped = self.swaps_shown();
        self.begin_render();
        // In order of urgency: copies, tokens, the swap, EDIT, TRANSFORM of a later eye.
        if let Some(copying) = self.next_allowed_copy() {
            self.copy(copying).await;
        } else if let Some((renderer, region)) = self.next_allowed_region() {
            self.send_token(renderer, region).await;
        } else if self.completed.may_swap(self.next_swap) && self.completed.swapped == self.next_swap.0 {
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

    async fn edit(&mut self) {
        let frame = self.next_edit;
        self.next_edit = frame.next();
        self.next_transform = self.config.first_of(frame).after(1);
        self.send_to_slaves(&StageOrder::Edit(frame)).await;
    }

    fn later_eye_may_transform(&self) -> bool {
        let drawing = self.next_transform;
        self.config.eye_of(drawing) != SurfaceId(0) && self.completed.may_transform(drawing)
    }

    async fn permit_transform(&mut self) {
        let drawing = self.next_transform;
        self.next_transform = drawing.after(1);
        self.send_to_slaves(&StageOrder::Transform(drawing)).await;
    }

    async fn send_to_slaves(&self, order: &StageOrder) {
        let (words, body) = order.message();
        self.gp.send_batch(self.config.slaves.iter().map(|node| (*node, words, body.clone())).collect()).await;
    }

    /// Begins RENDER of the next drawing if the rules permit it. The regions with the most bin entries come first.
    fn begin_render(&mut self) {
        let drawing = EyeDrawing(self.completed.rendered);
        if self.rendering.is_some() || !self.completed.may_render(drawing) {
            return;
        }
        let weights = self.weights.pop_front().unwrap_or_default();
        let mut regions: Vec<_> = (0..self.config.grid().regions() as usize).collect();
        regions.sort_by_key(|region| std::cmp::Reverse(weights.get(*region).copied().unwrap_or(0)));
        let unassigned = regions.into_iter().map(|region| RegionId(region as u16)).collect();
        self.gp.begin(Stage::Render, self.config.frame_of(drawing), Some(self.config.eye_of(drawing)));
        self.rendering = Some(RenderStage { drawing, unassigned, tokens_out: 0 });
    }

    fn next_allowed_region(&self) -> Option<(usize, RegionId)> {
        let region = *self.rendering.as_ref()?.unassigned.front()?;
        let renderer = self.renderers.iter().position(|state| *state == RendererUse::Idle)?;
        Some((renderer, region))
    }

    /// Sends the token of a region to a slave. The slaves take turns as the first holder of a token.
    async fn send_token(&mut self, renderer: usize, region: RegionId) {
        // The renderer receives commands from all slaves in turn.
        let Some(rendering) = &mut self.rendering else { return };
        rendering.unassigned.pop_front();
        rendering.tokens_out += 1;
        let drawing = rendering.drawing;
        self.renderers[renderer] = RendererUse::Receiving;
        // Each token starts at another slave, so that the slaves share the work.
        let slave = self.config.slaves[self.next_slave];
        self.next_slave = (self.next_slave + 1) % self.config.slaves.len();
        let token = Token {
            drawing,
            region,
            renderer: renderer as u16,
            slaves_left: self.config.slaves.len() as u16,
            end: self.end_of(renderer, drawing),
        };
        let (words, body) = StageOrder::Token(token).message();
        self.gp.send(slave, words, body).await;
    }

    /// Returns the destination of a region's pixels after the region's last commands.
    fn end_of(&self, renderer: usize, drawing: EyeDrawing) -> RegionEnd {
        if self.completed.may_copy(drawing) {
            RegionEnd::Copied
        } else if self.stored[renderer].len() < self.config.regions_stored {
            RegionEnd::Stored
        } else {
            // Under the other rule, finished regions wait in pixel memory, whatever the capacity of the store is.
            if self.config.regions_stored > 0 {
                self.gp.note_full_store();
            }
            RegionEnd::Held
        }
    }

    /// Returns a copy that the rules permit, for the renderer with the lowest index. A region in the backing store is
    /// copied before a region in pixel memory.
    fn next_allowed_copy(&self) -> Option<AllowedCopy> {
        (0..self.renderers.len()).find_map(|renderer| {
            let (drawing, region, way) = match (self.stored[renderer].front(), self.renderers[renderer]) {
                (Some((drawing, region)), _) => (*drawing, *region, CopyPath::FromBacking),
                (None, RendererUse::Holding(drawing, region)) => (drawing, region, CopyPath::ThroughBacking),
                _ => return None,
            };
            self.completed.may_copy(drawing).then_some(AllowedCopy { renderer, drawing, region, way })
        })
    }

    /// Sends the copy command of a region. When the token of this region was sent, the rules did not permit COPY.
    async fn copy(&mut self, AllowedCopy { renderer, drawing, region, way }: AllowedCopy) {
        match way {
            CopyPath::FromBacking => drop(self.stored[renderer].pop_front()),
            _ => self.renderers[renderer] = RendererUse::Idle,
        }
        let order = copy_order(&self.config, drawing, region, way);
        let list = copy_message(self.config.picture.layout, vec![order], self.config.picture.pixels);
        self.gp.send(self.config.renderers[renderer], list.words(), Body::Commands(list)).await;
    }

    async fn swap(&mut self) {
        let buffer = RenderingControlConfig::buffer_of(self.next_swap);
        self.next_swap = self.next_swap.next();
        let requests = self.config.frame_buffers.iter().map(|node| (*node, 2, Body::Words(swap_request(buffer))));
        self.gp.send_batch(requests.collect()).await;
    }

    async fn note(&mut self, received: &Received) -> Result<(), Fault> {
        match StageOrder::read(received, self.gp.node())? {
            StageOrder::Send(view) => self.completed.sent = view.number.picture_taken_for().next().0,
            StageOrder::Edited(frame) => self.note_edited(frame).await,
            StageOrder::Transformed(drawing, entries) => self.note_transformed(drawing, &entries),
            StageOrder::Accepted(token) => self.note_accepted(token),
            StageOrder::Copied { frame_buffer } => self.note_copied(frame_buffer),
            other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at the master: {other:?}") }),
        }
        Ok(())
    }

    async fn note_edited(&mut self, frame: PictureNumber) {
        self.edited.slaves += 1;
        if self.edited.slaves == self.config.slaves.len() {
            self.edited = SlaveReports::default();
            self.completed.edited = frame.next().0;
            let (words, body) = StageOrder::EditsDone(frame).message();
            self.gp.send(self.config.host, words, body).await;
        }
    }

    // Slaves may report a later drawing before all slaves have reported the current one.
    fn note_transformed(&mut self, drawing: EyeDrawing, entries: &[u32]) {
        let place = (drawing.0 - self.completed.transformed) as usize;
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
            self.gp.end(Stage::Render, self.config.frame_of(drawing), Some(self.config.eye_of(drawing)));
            self.completed.rendered += 1;
            self.rendering = None;
        }
    }

    fn note_copied(&mut self, frame_buffer: NodeId) {
        if let Some(eye) = self.config.eye_at(frame_buffer) {
            self.copied_regions[eye] += 1;
        }
        while self.is_copied(EyeDrawing(self.completed.copied)) {
            self.completed.copied += 1;
        }
    }

    /// Returns true if all regions of a drawing (the picture of one eye) have been copied. A count of regions is
    /// sufficient, because the drawings reach a frame buffer in order.
    fn is_copied(&self, drawing: EyeDrawing) -> bool {
        let regions = u64::from(self.config.grid().regions());
        self.copied_regions[self.config.eye_of(drawing).index()] >= regions * self.config.frame_of(drawing).next().0
    }
}

pub(crate) fn copy_order(
    config: &RenderingControlConfig,
    drawing: EyeDrawing,
    region: RegionId,
    way: CopyPath,
) -> CopyOrder {
    CopyOrder {
        target: config.target(drawing, region),
        context: 0,
        way,
        acknowledge: Some(config.master),
        content: CopyContent::Colour,
    }
}
