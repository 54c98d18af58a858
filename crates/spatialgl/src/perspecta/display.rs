//! The Perspecta display as a board on the ring: a port, a rotating screen, and a strobe (flash of the projector) for
//! every slice.

use crate::perspecta::store::{FrameStore, StoreReceipt};
use crate::perspecta::timing::PerspectaConfig;
use crate::pixel_of_word;
use image::{Rgb, RgbImage};
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Clock, Span, Time};
use pxpl5_wire::display::{Counter, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, Surface};
use pxpl5_wire::{Body, NodeId, PeriodNumber, Word};
use std::sync::LazyLock;

/// Names of slices for [`Surface`], which needs static strings. The names are made once, for the largest possible
/// number of slices.
static LABELS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let most = 4096;
    (0..most).map(|k| &*Box::leak(format!("slice-{k}").into_boxed_str())).collect()
});

/// The model of a Perspecta display. In terms of the display interface, a period is a revolution and a surface is a
/// slice.
#[derive(Debug)]
struct Perspecta {
    config: PerspectaConfig,
    revolution: Clock,
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    store: FrameStore,
    revolutions: u64,
    swaps: u64,
    faults: u64,
    first_fault: Option<&'static str>,
}

impl Perspecta {
    fn is_lit(&self, surface: usize, x: u32, y: u32) -> bool {
        surface < self.surfaces.len() && u64::from(x) < self.config.width && u64::from(y) < self.config.height
    }

    fn picture(&self, words: &[Word]) -> RgbImage {
        let width = self.config.width as u32;
        RgbImage::from_fn(width, self.config.height as u32, |x, y| {
            let bits = pixel_of_word(words[(y * (width / 8) + x / 8) as usize], x % 8);
            Rgb([0, 1, 2].map(|channel| 255 * (bits >> channel & 1)))
        })
    }

    fn receive(&mut self, body: &Body, now: Time) -> StoreReceipt {
        match body {
            Body::Words(words) => self.store.receive(words, now),
            Body::Pixels(_) => StoreReceipt::Fault("pixels of 32 bits: a Perspecta takes packed tiles"),
            Body::Commands(_) => StoreReceipt::Fault("commands for a renderer"),
        }
    }
}

impl Display for Perspecta {
    fn name(&self) -> &'static str {
        "perspecta"
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        self.revolution.edge(period.0)
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        let n = self.revolution.edge_at_or_after(time);
        PeriodNumber(if self.revolution.edge(n) == time { n } else { n - 1 })
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        match event {
            DisplayEvent::Tick(tick) => {
                self.revolutions += 1;
                if let Some(buffer) = self.store.swap(context.now()) {
                    self.swaps += 1;
                    // The notice of a swap takes the time of one word.
                    let at = context.now() + Span::from_ns(self.config.word_ns);
                    context.output(at, DisplayOutput::Swapped { surface: 0, buffer, tick });
                }
            }
            DisplayEvent::Delivered { body, .. } => {
                // Unusable messages are counted, and the first of these messages is described.
                if let StoreReceipt::Fault(what) = self.receive(&body, context.now()) {
                    self.faults += 1;
                    self.first_fault.get_or_insert(what);
                }
            }
            DisplayEvent::Timer(_) => {}
        }
    }

    fn lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.is_lit(surface, x, y).then(|| self.config.strobe(period.0, surface as u64).0)
    }

    fn shown(&self, surface: usize) -> Option<RgbImage> {
        Some(self.picture(self.store.shown(surface)?))
    }

    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage> {
        let is_known = self.last_seen() == Some(period);
        self.store.scanned(surface).filter(|_| is_known).map(|words| self.picture(words))
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        self.revolutions.checked_sub(2).map(PeriodNumber)
    }

    fn counters(&self) -> Vec<Counter> {
        vec![
            Counter { name: "revolutions", count: self.revolutions },
            Counter { name: "volumes swapped", count: self.swaps },
            Counter { name: "tiles stored", count: self.store.tiles },
        ]
    }

    fn faults(&self) -> (u64, Option<String>) {
        (self.faults, self.first_fault.map(str::to_owned))
    }
}

impl DisplayConfig for PerspectaConfig {
    fn name(&self) -> &'static str {
        "perspecta"
    }

    fn about(&self) -> &'static str {
        "spinning screen that strobes 396 slices a turn (the SpatialGL paper)"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        vec![("perspecta", self)]
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        vec![("perspecta", self)]
    }

    /// Returns 1, because there is one volume for any number of eyes.
    fn ports(&self, _pictures: usize) -> usize {
        1
    }

    fn check(&self) -> Result<(), SettingError> {
        Self::check(self)
    }

    fn build(&self, nodes: &[NodeId], _word: Span) -> Result<Box<dyn Display>, SettingError> {
        DisplayConfig::check(self)?;
        let width = self.width as u32;
        let height = self.height as u32;
        // Every slice is a surface of the display.
        let labels = LABELS.iter().copied().take(self.slices as usize);
        let surfaces = labels.map(|label| Surface { label, title: label, width, height }).collect();
        Ok(Box::new(Perspecta {
            config: *self,
            revolution: self.revolution(),
            nodes: nodes.to_vec(),
            surfaces,
            store: FrameStore::new([width, height], self.slices as u32),
            revolutions: 0,
            swaps: 0,
            faults: 0,
            first_fault: None,
        }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(*self)
    }
}
