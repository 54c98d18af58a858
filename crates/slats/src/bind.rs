//! Assignment of regions to renderers, and the order in which regions are copied.

use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{Eye, RegionGrid, RegionId};

/// The order and the time of the copies of a field's regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// All regions are copied before the retrace.
    Whole,
    /// The top regions are copied before the retrace, and the bottom regions right after the retrace.
    Split,
    /// The top regions are copied first, then the bottom regions, into a second buffer.
    ///
    /// If the top regions are late, the display shows the last complete field of the same lines again. The late field
    /// appears at the next retrace of its lines.
    ///
    /// This schedule is not in the prototype. TR94 proposes to copy a backup field as future work. With two buffers in
    /// turn no such copy is needed, because the last complete field stays in its buffer.
    Backup,
}

pxpl5_sim::parameters::named!(CopySchedule, "copy schedule", CopySchedule::ALL);

impl CopySchedule {
    /// All schedules with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("whole", Self::Whole), ("split", Self::Split), ("backup", Self::Backup)];

    /// Returns true if the bottom regions are copied later than all top regions.
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split | Self::Backup)
    }
}

/// A region of one eye's field, with the renderer that draws this region in every field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BoundRegion {
    /// Eye whose picture contains the region.
    pub eye: Eye,
    /// Index of the region in [`RegionGrid::FIELD`].
    pub region: RegionId,
    /// Index of the renderer in the list [`crate::SlatsConfig::renderers`].
    pub renderer: usize,
    /// Index of the part of the renderer's pixel memory that holds the region, from 0 to 3.
    pub context: u8,
}

impl BoundRegion {
    /// Returns true if the region is in the upper half of the picture.
    pub const fn is_top(&self) -> bool {
        (self.region.0 as u32) < RegionGrid::FIELD.columns()
    }
}

/// The regions of both eyes, each with a fixed renderer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    regions: Vec<BoundRegion>,
    renderers: usize,
    copy: CopySchedule,
}

impl Binding {
    /// Assigns the regions to the renderers in turn. All top regions come before all bottom regions, and in each half
    /// the left eye comes before the right eye.
    ///
    /// Each renderer thus gets nearly the same number of regions of each half and each eye. Clumps are sent to the
    /// regions in this order, so that all renderers have work.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if a renderer would hold more than `contexts` regions.
    pub fn new(renderers: usize, contexts: u8, copy: CopySchedule) -> Result<Self, SettingError> {
        let columns = RegionGrid::FIELD.columns() as u16;
        let kinds = [(0, Eye::Left), (0, Eye::Right), (1, Eye::Left), (1, Eye::Right)];
        let all = kinds.iter().flat_map(|(row, eye)| (0..columns).map(move |c| (*eye, RegionId(row * columns + c))));
        let total = kinds.len() * usize::from(columns);
        let expected = total.div_ceil(usize::from(contexts.max(1)));
        if renderers < expected {
            let expected = format!("at least {expected} renderers of four contexts");
            return Err(SettingError::value("Slats binds 20 field regions statically", expected, renderers));
        }
        let regions = all.enumerate().map(|(i, (eye, region))| BoundRegion {
            eye,
            region,
            renderer: i % renderers,
            context: (i / renderers) as u8,
        });
        Ok(Self { regions: regions.collect(), renderers, copy })
    }

    /// Returns all regions, in the order in which they receive a clump.
    pub fn regions(&self) -> &[BoundRegion] {
        &self.regions
    }

    /// Returns the regions that a renderer copies, in the order of copying. The eyes alternate.
    ///
    /// A whole copy begins with the left eye. A split copy has only the top half if `top` is true, otherwise only the
    /// bottom half. In a split copy, renderers with an odd index begin with the right eye.
    pub fn copies(&self, renderer: usize, top: bool) -> Vec<BoundRegion> {
        let of_renderer = self.regions.iter().filter(|b| b.renderer == renderer);
        let mut mine: Vec<_> = of_renderer.filter(|b| !self.copy.is_split() || b.is_top() == top).copied().collect();
        if self.copy.is_split() && renderer % 2 == 1 {
            mine.sort_by_key(|b| std::cmp::Reverse(b.eye));
        }
        alternate(mine)
    }

    pub const fn renderers(&self) -> usize {
        self.renderers
    }
}

/// Reorders regions so that left and right eye alternate. The first region stays first.
fn alternate(regions: Vec<BoundRegion>) -> Vec<BoundRegion> {
    let Some(first) = regions.first().map(|b| b.eye) else { return regions };
    let (mut ours, mut others): (Vec<_>, Vec<_>) = regions.into_iter().partition(|b| b.eye == first);
    ours.reverse();
    others.reverse();
    let mut out = Vec::new();
    while !ours.is_empty() || !others.is_empty() {
        out.extend(ours.pop());
        out.extend(others.pop());
    }
    out
}
