//! One TRANSFORM of a GP's share for one eye.

use crate::counts::PrimitiveCounts;
use crate::encoder::Encoder;
use crate::list::Share;
use crate::picture::{Picture, RegionBinning};
use crate::placed::PlacedStructure;
use crate::placing::place_once;
use crate::view::FrameView;
use pxpl5_geometry::{Light, RegionMask, SetupStats, Touch, Transform};
use pxpl5_wire::RegionId;
use std::sync::Arc;

/// A screen triangle of a bin: what its commands are made from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinEntry {
    /// Number in the display list.
    pub(crate) triangle: u32,
    /// Which of the pieces that it was clipped to, 0 if it was not; `None` where nothing of it is seen.
    pub(crate) piece: Option<u8>,
}

/// Room that a bin begins with, once something is in it: small steps would be many in a large scene.
const FIRST_ENTRIES: usize = 64;

/// What touches one region, by rising numbers in the display list.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bin {
    pub(crate) triangles: Vec<BinEntry>,
    pub(crate) spheres: Vec<u32>,
}

/// Bins of one eye: for each region the screen primitives that touch it.
#[derive(Debug)]
pub struct Pass {
    share: Share,
    placed: Arc<[PlacedStructure]>,
    picture: Picture,
    counts: Vec<PrimitiveCounts>,
    all_regions: RegionMask,
    /// By region; empty without pixels.
    bins: Vec<Bin>,
    screen_counts: PrimitiveCounts,
    stats: SetupStats,
    /// Makes the words of triangles; `None` where nobody wants pixels.
    encoder: Option<Encoder>,
    touching: Option<[Vec<u32>; 2]>,
}

impl Share {
    /// One TRANSFORM of all held primitives for one eye.
    #[must_use]
    pub fn transform(&self, view: &FrameView, eye: usize, picture: Picture) -> Arc<Pass> {
        Arc::new(Pass::new(self.clone(), view, eye, picture, None))
    }

    /// The same of the primitives of some structures: those whose place in the display list is chosen.
    #[must_use]
    pub fn transform_chosen(&self, view: &FrameView, eye: usize, picture: Picture, chosen: &[bool]) -> Arc<Pass> {
        Arc::new(Pass::new(self.clone(), view, eye, picture, Some(chosen)))
    }
}

impl Pass {
    fn new(share: Share, view: &FrameView, eye: usize, picture: Picture, chosen: Option<&[bool]>) -> Self {
        let regions = picture.viewport.grid().regions() as usize;
        let placed = place_once(&share.list, view, eye, picture.viewport);
        let bins = if picture.pixels { vec![Bin::default(); regions] } else { Vec::new() };
        let mut pass = Self {
            share,
            placed,
            picture,
            counts: vec![PrimitiveCounts::default(); regions],
            all_regions: (0..regions as u16)
                .map(|i| RegionMask::only(RegionId(i)))
                .fold(RegionMask::EMPTY, RegionMask::union),
            bins,
            screen_counts: PrimitiveCounts::default(),
            stats: SetupStats::default(),
            encoder: picture.pixels.then(|| Encoder::for_picture(&picture)).flatten(),
            touching: chosen.map(|_| Default::default()),
        };
        pass.binitize(chosen);
        pass
    }

    fn binitize(&mut self, chosen: Option<&[bool]>) {
        let mut stats = SetupStats::default();
        let placed = Arc::clone(&self.placed);
        let share = self.share.clone();
        let is_chosen = |structure: usize| chosen.is_none_or(|chosen| chosen.get(structure) == Some(&true));
        for (_, place) in placed.iter().enumerate().filter(|(structure, _)| is_chosen(*structure)) {
            let Some(transform) = &place.transform else { continue };
            self.bin_triangles(place, transform, &share, &mut stats);
            for number in share.held_spheres(&place.structure.spheres) {
                if let Some(sphere) = transform.sphere(&share.list.spheres[number], &mut stats) {
                    self.put_sphere(sphere.regions, number as u32);
                    self.note_touching(1, number as u32);
                }
            }
        }
        self.stats = stats;
    }

    fn bin_triangles(&mut self, place: &PlacedStructure, transform: &Transform, share: &Share, stats: &mut SetupStats) {
        let first = place.structure.triangles.start;
        let touched = place.touched(&share.list, transform);
        let mut in_one_region = 0;
        for number in share.held_triangles(&place.structure.triangles) {
            let touch = touched.get(number - first);
            if let (Touch::Region(region), RegionBinning::Touched) = (touch, self.picture.binning) {
                in_one_region += 1;
                self.put_in(region, BinEntry { triangle: number as u32, piece: Some(0) });
                self.note_touching(0, number as u32);
                continue;
            }
            let triangle = number as u32;
            let mut pieces = 0;
            match touch {
                Touch::NeedsClipping => {
                    transform.bin(&share.list.corners(number), stats, |mask| {
                        self.put_piece(mask, triangle, &mut pieces);
                    });
                }
                whole => {
                    stats.triangles += 1;
                    if let Some(mask) = whole.count(stats) {
                        self.put_piece(mask, triangle, &mut pieces);
                    }
                }
            }
            if pieces > 0 {
                self.note_touching(0, triangle);
            }
            if pieces == 0 && self.picture.binning == RegionBinning::All {
                self.put_triangle(RegionMask::EMPTY, BinEntry { triangle, piece: None });
            }
        }
        // Most triangles by far, counted together.
        stats.triangles += u64::from(in_one_region);
        stats.screen_triangles += u64::from(in_one_region);
        self.screen_counts.triangles += in_one_region;
    }

    fn receivers(&self, mask: RegionMask) -> RegionMask {
        match self.picture.binning {
            RegionBinning::Touched => mask,
            RegionBinning::All => self.all_regions,
        }
    }

    /// Puts the next piece of a triangle into bins, and counts it.
    fn put_piece(&mut self, mask: RegionMask, triangle: u32, pieces: &mut u8) {
        self.put_triangle(mask, BinEntry { triangle, piece: Some(*pieces) });
        *pieces += 1;
    }

    fn put_triangle(&mut self, mask: RegionMask, entry: BinEntry) {
        for region in self.receivers(mask).iter() {
            self.put_in(region, entry);
        }
        self.screen_counts.triangles += 1;
    }

    /// A triangle (kind 0) or sphere (1) is in some bin.
    #[inline(always)]
    fn note_touching(&mut self, kind: usize, number: u32) {
        if let Some(touching) = &mut self.touching {
            touching[kind].push(number);
        }
    }

    #[inline(always)]
    fn put_in(&mut self, region: RegionId, entry: BinEntry) {
        self.counts[usize::from(region.0)].triangles += 1;
        if let Some(Bin { triangles, .. }) = self.bins.get_mut(usize::from(region.0)) {
            if triangles.len() == triangles.capacity() {
                triangles.reserve(triangles.len().max(FIRST_ENTRIES));
            }
            triangles.push(entry);
        }
    }

    fn put_sphere(&mut self, mask: RegionMask, number: u32) {
        for region in mask.iter() {
            self.counts[usize::from(region.0)].spheres += 1;
            if let Some(bin) = self.bins.get_mut(usize::from(region.0)) {
                bin.spheres.push(number);
            }
        }
        self.screen_counts.spheres += 1;
    }

    /// Numbers of entries in a region's bin.
    #[must_use]
    pub fn counts(&self, region: RegionId) -> PrimitiveCounts {
        self.counts[usize::from(region.0)]
    }

    /// Primitives on the screen, each counted once.
    #[must_use]
    pub const fn screen_counts(&self) -> PrimitiveCounts {
        self.screen_counts
    }

    /// Entries of all bins together.
    #[must_use]
    pub fn entries(&self) -> u64 {
        self.counts.iter().map(|counts| u64::from(counts.total())).sum()
    }

    /// Numbers of primitives transformed, seen or not.
    #[must_use]
    pub fn transformed(&self) -> PrimitiveCounts {
        self.share.counts()
    }

    /// Triangles and spheres that are in some bin, by rising numbers in the display list; `None` of a pass over all structures.
    #[must_use]
    pub const fn touching(&self) -> Option<&[Vec<u32>; 2]> {
        self.touching.as_ref()
    }

    /// What happened to the primitives.
    #[must_use]
    pub const fn stats(&self) -> SetupStats {
        self.stats
    }

    /// The picture that is made of the view.
    #[must_use]
    pub const fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Red, green and blue where nothing is drawn, 0 to 255 each.
    #[must_use]
    pub fn background(&self) -> [u8; 3] {
        self.share.list.background
    }

    /// The light as the first structure's eye sees it.
    #[must_use]
    pub fn light(&self) -> Option<&Light> {
        self.placed.first().map(|placed| &placed.light)
    }

    pub(crate) fn placed(&self) -> Arc<[PlacedStructure]> {
        Arc::clone(&self.placed)
    }

    pub(crate) const fn share(&self) -> &Share {
        &self.share
    }

    pub(crate) const fn encoder(&self) -> Option<&Encoder> {
        self.encoder.as_ref()
    }

    pub(crate) fn bin(&self, region: RegionId) -> &Bin {
        &self.bins[usize::from(region.0)]
    }

    /// Structures in order, with their transforms.
    pub(crate) fn drawn(&self) -> impl Iterator<Item = (&PlacedStructure, &Transform)> {
        drawn(&self.placed)
    }
}

fn drawn(placed: &[PlacedStructure]) -> impl Iterator<Item = (&PlacedStructure, &Transform)> {
    placed.iter().filter_map(|place| Some((place, place.transform.as_ref()?)))
}
