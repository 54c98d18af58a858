//! A slave, which draws the strips or blocks that the master orders.

use crate::config::{DrawingSchedule, JitpConfig, Viewpoint};
use crate::drawing::{DrawnList, Ends};
use crate::finding::StripSearchWork;
use crate::pieces::{messages, window};
use crate::protocol::DrawingOrder;
use crate::whole::{self, WholeList};
use pphigs::{DisplayList, FrameView, MemoryPart, PROGRAM_BYTES, Share, TransformCost, WindowSearchWork};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Account, Fault, Firmware, Gp, Priority, Stage, Ticket};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, PeriodNumber, PictureNumber, RegionId};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// Number of transformed fields in memory, including the current and the next field.
const FIELDS_KEPT: usize = 3;

/// Number of parts into which the slave's memory for fields is divided: one part for each stored field, and one part
/// for the field that is being transformed. One more part, not counted here, is for a strip between two views.
const PARTS_OF_FIELDS: u8 = FIELDS_KEPT as u8 + 1;
const OF_STRIP: MemoryPart = MemoryPart::of(PARTS_OF_FIELDS as usize, PARTS_OF_FIELDS + 1);

#[derive(Default)]
struct SlaveFields {
    /// Fields that the master has ordered but that are not transformed yet, oldest first, with their views.
    ordered: VecDeque<(PeriodNumber, Vec<FrameView>)>,
    /// Transformed fields, oldest first, each with the part of memory that holds the result.
    transformed: VecDeque<(PeriodNumber, Field, MemoryPart)>,
    n_transformed: usize,
}

/// A transformed field. The list `whole` has the primitives in the first view. If the field has only one view, all
/// strips use this list.
#[derive(Clone)]
struct Field {
    ends: Ends,
    whole: Arc<DrawnList>,
}

type SharedFields = Rc<RefCell<SlaveFields>>;

/// A cache of transformed fields, which the simulator shares among all slaves.
///
/// All slaves hold the same display list and get the same views, so each field is computed only once. Every slave
/// nevertheless spends the simulated time of its own TRANSFORM.
#[derive(Clone, Default)]
pub struct Transforms(Rc<RefCell<VecDeque<(PeriodNumber, Field)>>>);

impl std::fmt::Debug for Transforms {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Transforms").field(&self.0.borrow().len()).finish()
    }
}

impl Transforms {
    fn cached_or_made(&self, field: PeriodNumber, make: impl FnOnce() -> Field) -> Field {
        let cached = &mut *self.0.borrow_mut();
        if let Some((_, ready)) = cached.iter().find(|ready| ready.0 == field) {
            return ready.clone();
        }
        let fresh = make();
        cached.push_back((field, fresh.clone()));
        if cached.len() > FIELDS_KEPT {
            cached.pop_front();
        }
        fresh
    }
}

/// Returns the programs of a slave, for both priorities of its board. `index` is the index of the slave.
///
/// The program that draws strips interrupts the program that transforms the next field. Every slave holds the whole
/// display list. The programs fail with [`Fault::Memory`] if the list does not fit into memory, and with
/// [`Fault::Protocol`] for an unknown message.
pub fn slave(
    gp: &Gp,
    config: &JitpConfig,
    list: &Arc<DisplayList>,
    transforms: &Transforms,
    index: usize,
) -> Vec<(Priority, Firmware)> {
    // Every slave holds the whole display list, so its share is complete.
    let share = Share::new(Arc::clone(list), 0, 1);
    let state = SharedFields::default();
    let [drawing, preparing] = [Priority::Interrupt, Priority::Foreground].map(|level| Slave {
        gp: gp.at_priority(level),
        config: config.clone(),
        share: share.clone(),
        pass: TransformCost::pass_over(list, share.counts()),
        state: Rc::clone(&state),
        transforms: transforms.clone(),
        index,
    });
    vec![(Priority::Interrupt, Box::pin(drawing.draw())), (Priority::Foreground, Box::pin(preparing.prepare()))]
}

struct Slave {
    gp: Gp,
    config: JitpConfig,
    share: Share,
    pass: TransformCost,
    state: SharedFields,
    transforms: Transforms,
    index: usize,
}

impl Slave {
    async fn draw(self) -> Result<(), Fault> {
        self.gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
        self.gp.reserve(Account::DisplayList, self.share.bytes(), None)?;
        self.gp.install(|processor| self.share.install(processor))?;
        loop {
            let received = self.gp.receive().await;
            match DrawingOrder::read(&received, self.gp.node())? {
                DrawingOrder::Field { field, views } => self.state.borrow_mut().ordered.push_back((field, views)),
                DrawingOrder::Strip { field, strip, deadline, view } => {
                    self.strip(field, strip, deadline, view).await?
                }
                DrawingOrder::Blocks { update, step, view } => self.blocks(update, step, &view).await?,
                other => return Err(Fault::Protocol { node: self.gp.node(), found: format!("at a slave: {other:?}") }),
            }
        }
    }

    async fn prepare(self) -> Result<(), Fault> {
        loop {
            let (field, views) = self.gp.until("the order of a field", || self.take_newest_order()).await;
            let part = self.next_part();
            self.transform_all(&views, PictureNumber::drawn_for(field), part).await?;
            self.gp.end(Stage::Transform, PictureNumber::drawn_for(field), None);
            let ready = self.transforms.cached_or_made(field, || self.transform(field, views));
            let state = &mut *self.state.borrow_mut();
            state.transformed.push_back((field, ready, part));
            state.n_transformed += 1;
            if state.transformed.len() > FIELDS_KEPT {
                state.transformed.pop_front();
            }
        }
    }

    fn next_part(&self) -> MemoryPart {
        let number = self.state.borrow().n_transformed % usize::from(PARTS_OF_FIELDS);
        MemoryPart::of(number, PARTS_OF_FIELDS + u8::from(self.dual().is_some()))
    }

    async fn transform_all(&self, views: &[FrameView], picture: PictureNumber, part: MemoryPart) -> Result<(), Fault> {
        let Self { share, pass, config, .. } = self;
        let viewport = config.extent(picture).0;
        self.gp.work(&WholeList { share, pass: *pass, views, viewport, layout: config.layout, part }).await
    }

    /// Returns the newest field that the master has ordered. Older orders are dropped.
    fn take_newest_order(&self) -> Option<(PeriodNumber, Vec<FrameView>)> {
        self.state.borrow_mut().ordered.drain(..).next_back()
    }

    fn transform(&self, field: PeriodNumber, views: Vec<FrameView>) -> Field {
        let viewport = self.config.extent(PictureNumber::drawn_for(field)).0;
        let whole = Arc::new(DrawnList::from_view(self.share.list(), &views[0], viewport));
        Field { ends: Ends::new(self.share.list(), views, viewport), whole }
    }

    async fn strip(
        &self,
        field: PeriodNumber,
        strip: u32,
        deadline: Time,
        view: Option<FrameView>,
    ) -> Result<(), Fault> {
        // The deadline has passed, so the strip is skipped.
        if self.gp.now() >= deadline {
            return Ok(());
        }
        let picture = PictureNumber::drawn_for(field);
        let viewport = self.config.extent(picture).0;
        let stands_for_field = self.config.is_middle(strip);
        // A strip with its own view needs a TRANSFORM first. Every other strip waits for the TRANSFORM of its field.
        let drawing = match &view {
            Some(view) => {
                self.transform_all(std::slice::from_ref(view), picture, MemoryPart::WHOLE).await?;
                if stands_for_field {
                    self.gp.end(Stage::Transform, picture, None);
                }
                Some((Arc::new(DrawnList::from_view(self.share.list(), view, viewport)), MemoryPart::WHOLE))
            }
            None => self.drawing_of_field(field, strip, viewport).await,
        };
        // TRANSFORM may have ended after the deadline.
        let Some((drawing, part)) = drawing.filter(|_| self.gp.now() < deadline) else { return Ok(()) };
        if stands_for_field {
            self.gp.begin(Stage::Render, picture, None);
        }
        let sent = self.send(picture, &self.config.strip_regions(strip), &viewport, &drawing, part).await?;
        if stands_for_field {
            self.gp.end_when_accepted(sent, Stage::Render, picture);
        }
        Ok(())
    }

    fn has_transformed(&self, field: PeriodNumber) -> bool {
        self.state.borrow().transformed.back().is_some_and(|newest| newest.0 >= field)
    }

    /// Returns the display list that is prepared for a strip, and the part of memory with the triangles of the strip's
    /// field. Returns `None` if the field was not transformed.
    async fn drawing_of_field(
        &self,
        field: PeriodNumber,
        strip: u32,
        viewport: Viewport,
    ) -> Option<(Arc<DrawnList>, MemoryPart)> {
        self.gp.until("the transforms of the field", || self.has_transformed(field).then_some(())).await;
        let state = self.state.borrow();
        let (_, ready, part) = state.transformed.iter().find(|ready| ready.0 == field)?;
        // A field with one view is drawn from this view, even if the pipeline normally interpolates.
        let drawing = match self.dual() {
            Some(interpolation) if ready.ends.views.len() == 2 => {
                let s = self.config.part(field, strip);
                Arc::new(DrawnList::between(self.share.list(), &ready.ends, s, interpolation, viewport))
            }
            _ => Arc::clone(&ready.whole),
        };
        Some((drawing, *part))
    }

    fn dual(&self) -> Option<crate::config::Interpolation> {
        match self.config.schedule {
            DrawingSchedule::Beam { viewpoint: Viewpoint::Dual(interpolation), .. } => Some(interpolation),
            _ => None,
        }
    }

    async fn blocks(&self, update: PictureNumber, step: u64, view: &FrameView) -> Result<(), Fault> {
        let DrawingSchedule::Roam { batch, order, .. } = &self.config.schedule else { return Ok(()) };
        let viewport = self.config.extent(update).0;
        self.transform_all(std::slice::from_ref(view), update, MemoryPart::WHOLE).await?;
        self.gp.end(Stage::Transform, update, None);
        let drawing = Arc::new(DrawnList::from_view(self.share.list(), view, viewport));
        let regions: Vec<_> = (0..u64::from(*batch)).map(|i| order.at(step + i)).collect();
        self.gp.begin(Stage::Render, update, None);
        let sent = self.send(update, &regions, &viewport, &drawing, MemoryPart::WHOLE).await?;
        self.gp.end_when_accepted(sent, Stage::Render, update);
        let (words, body) = DrawingOrder::Done { slave: self.index as u32 }.message();
        self.gp.send(self.config.master, words, body).await;
        Ok(())
    }

    /// Finds the primitives in some regions and sends the messages that draw these regions, as one chain.
    ///
    /// Several slaves use the same region context (part of pixel memory) of a renderer. The messages of a region
    /// therefore reserve the renderer's port until the last message, so that no other slave can draw into the region.
    async fn send(
        &self,
        picture: PictureNumber,
        regions: &[RegionId],
        viewport: &Viewport,
        drawing: &Arc<DrawnList>,
        part: MemoryPart,
    ) -> Result<Ticket, Fault> {
        let windows: Vec<_> = regions.iter().map(|region| window(&self.config, viewport, *region)).collect();
        let (counts, any) = drawing.count(&windows);
        let of_kernels = whole::picture(*viewport, self.config.layout);
        // Interpolated commands go to their own part of memory. The search uses this part instead of the field's part.
        let interpolating = drawing.interpolating(&self.share, &windows, of_kernels, [part, OF_STRIP]);
        let searching = WindowSearchWork {
            part: if interpolating.is_some() { OF_STRIP } else { part },
            viewport: *viewport,
            grid: self.config.grid(),
            windows: regions,
            counts: &counts,
        };
        let interpolate_ns = self.config.timing.interpolate_ns;
        let finding = StripSearchWork { searching, interpolating, met: any, interpolate_ns };
        self.gp.work(&finding).await?;
        self.gp.clump_buffer_free().await;
        let pieces = regions.iter().zip(&windows).zip(&counts);
        let groups = pieces.map(|((region, window), counts)| {
            let target = self.config.target(picture, *region);
            let lists = messages(&self.config, drawing, *window, *counts, target);
            let group = lists.into_iter().map(|list| (list.words(), Body::Commands(list)));
            (self.config.renderer_of(*region), group.collect())
        });
        Ok(self.gp.send_groups(groups.collect()).await)
    }
}

#[cfg(test)]
mod tests;
