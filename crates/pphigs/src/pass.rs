use crate::list::{PrimitiveCounts, Share};
use crate::picture::{Picture, RegionBinning, Shading};
use crate::placed::PlacedStructure;
use crate::placing::place_cached;
use crate::view::FrameView;
use pxpl5_geometry::{Light, RegionMask, SetupStats, Touch, Transform};
use pxpl5_renderer::{PhongTriangleEncoder, TriangleEncoder};
use pxpl5_wire::RegionId;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

#[derive(Clone, Copy, Debug)]
pub(crate) struct BinEntry {
    pub(crate) triangle: u32,
    /// Index of the piece of a clipped triangle, 0 for an unclipped triangle. `None` for an invisible triangle.
    pub(crate) piece: Option<u8>,
}

/// Primitives in one region, in the order of the display list.
#[derive(Debug)]
pub(crate) struct Bin {
    pub(crate) triangles: Vec<BinEntry>,
    pub(crate) spheres: Vec<u32>,
}

/// Result of TRANSFORM for one eye: the primitives in each region.
///
/// Simulated time depends only on the numbers of primitives, which are counted at once. The bins are filled when they
/// are first read.
#[derive(Debug)]
pub struct Pass {
    walk: Walk,
    found: Found,
    stats: SetupStats,
    bins: OnceLock<Vec<Bin>>,
    /// Triangles that touch each region, found at the first use. Only [`RegionBinning::All`] needs this list.
    touching: OnceLock<RegionTriangles>,
    encoder: OnceLock<Option<Encoder>>,
}

#[derive(Debug)]
struct Walk {
    share: Share,
    placed: Arc<[PlacedStructure]>,
    picture: Picture,
    /// True for each structure that is drawn, by index in the display list. `None` if all structures are drawn.
    chosen: Option<Box<[bool]>>,
}

/// A receiver of the results of binning, in the order of the display list.
trait BinningSink {
    fn triangle_in(&mut self, region: RegionId, triangle: u32);

    /// Takes a triangle, or a piece of a clipped triangle, and the regions that the piece touches. Under
    /// [`RegionBinning::All`], the entry belongs to the bins of all regions.
    fn piece(&mut self, touched: RegionMask, entry: BinEntry);

    /// Takes the index of a sphere in the display list, and the regions that the sphere touches.
    fn sphere(&mut self, regions: RegionMask, number: u32);
}

#[derive(Debug)]
struct Found {
    counts: Vec<PrimitiveCounts>,
    on_screen: PrimitiveCounts,
    /// Indices of the triangles and spheres in at least one bin. `None` for a pass over all structures.
    touching: Option<[Vec<u32>; 2]>,
}

/// A sink that counts primitives and does not store them.
struct PrimitiveCounter {
    /// For each region, the number of triangles that touch only this region.
    alone: [u32; RegionMask::CAPACITY as usize],
    /// Two counts for each region: triangles that touch this region and at least one other region, and spheres that
    /// touch this region.
    counts: Vec<PrimitiveCounts>,
    on_screen: PrimitiveCounts,
    binning: RegionBinning,
}

impl PrimitiveCounter {
    fn of(picture: &Picture) -> Self {
        let counts = vec![PrimitiveCounts::default(); picture.viewport.grid().regions() as usize];
        let alone = [0; RegionMask::CAPACITY as usize];
        Self { alone, counts, on_screen: PrimitiveCounts::default(), binning: picture.binning }
    }

    fn in_region(&mut self, region: RegionId) -> &mut PrimitiveCounts {
        &mut self.counts[usize::from(region.0)]
    }

    fn found(mut self, touching: Option<[Vec<u32>; 2]>) -> Found {
        for (counts, alone) in self.counts.iter_mut().zip(self.alone) {
            counts.triangles += alone;
            self.on_screen.triangles += alone;
        }
        if self.binning == RegionBinning::All {
            self.counts.iter_mut().for_each(|counts| counts.triangles = self.on_screen.triangles);
        }
        Found { counts: self.counts, on_screen: self.on_screen, touching }
    }
}

impl BinningSink for PrimitiveCounter {
    #[inline(always)]
    fn triangle_in(&mut self, region: RegionId, _: u32) {
        self.alone[usize::from(region.0)] += 1;
    }

    fn piece(&mut self, touched: RegionMask, _: BinEntry) {
        if self.binning != RegionBinning::All {
            touched.iter().for_each(|region| self.in_region(region).triangles += 1);
        }
        self.on_screen.triangles += 1;
    }

    fn sphere(&mut self, regions: RegionMask, _: u32) {
        regions.iter().for_each(|region| self.in_region(region).spheres += 1);
        self.on_screen.spheres += 1;
    }
}

/// A sink that counts primitives, and stores the indices of the primitives in at least one bin.
struct PrimitiveRecorder {
    counting: PrimitiveCounter,
    touching: [Vec<u32>; 2],
}

impl BinningSink for PrimitiveRecorder {
    fn triangle_in(&mut self, region: RegionId, triangle: u32) {
        self.counting.triangle_in(region, triangle);
        self.touching[0].push(triangle);
    }

    fn piece(&mut self, touched: RegionMask, entry: BinEntry) {
        self.counting.piece(touched, entry);
        if entry.piece == Some(0) {
            self.touching[0].push(entry.triangle);
        }
    }

    fn sphere(&mut self, regions: RegionMask, number: u32) {
        self.counting.sphere(regions, number);
        self.touching[1].push(number);
    }
}

struct BinFiller {
    bins: Vec<Bin>,
    binning: RegionBinning,
}

impl BinningSink for BinFiller {
    #[inline(always)]
    fn triangle_in(&mut self, region: RegionId, triangle: u32) {
        self.bins[usize::from(region.0)].triangles.push(BinEntry { triangle, piece: Some(0) });
    }

    fn piece(&mut self, touched: RegionMask, entry: BinEntry) {
        match self.binning {
            RegionBinning::Touched | RegionBinning::Boxes => {
                touched.iter().for_each(|region| self.bins[usize::from(region.0)].triangles.push(entry));
            }
            RegionBinning::All => self.bins.iter_mut().for_each(|bin| bin.triangles.push(entry)),
        }
    }

    fn sphere(&mut self, regions: RegionMask, number: u32) {
        regions.iter().for_each(|region| self.bins[usize::from(region.0)].spheres.push(number));
    }
}

/// A sink that collects the triangles that touch each region, for a pass in which every region receives all triangles.
#[derive(Debug)]
struct RegionTriangles {
    /// Triangles of each region, with their indices in the region's bin.
    entries: Vec<Vec<(u32, BinEntry)>>,
    n_triangles: u32,
}

impl BinningSink for RegionTriangles {
    fn triangle_in(&mut self, region: RegionId, triangle: u32) {
        self.piece(RegionMask::only(region), BinEntry { triangle, piece: Some(0) });
    }

    fn piece(&mut self, touched: RegionMask, entry: BinEntry) {
        let place = self.n_triangles;
        touched.iter().for_each(|region| self.entries[usize::from(region.0)].push((place, entry)));
        self.n_triangles += 1;
    }

    fn sphere(&mut self, _: RegionMask, _: u32) {}
}

impl Walk {
    fn taken(&self) -> impl Iterator<Item = &PlacedStructure> {
        let is_chosen = |structure: usize| self.chosen.as_ref().is_none_or(|all| all.get(structure) == Some(&true));
        self.placed.iter().enumerate().filter(move |(structure, _)| is_chosen(*structure)).map(|(_, place)| place)
    }

    fn go(&self, take: &mut impl BinningSink) -> SetupStats {
        let mut stats = SetupStats::default();
        for place in self.taken() {
            let Some(transform) = &place.transform else { continue };
            self.triangles(place, transform, take, &mut stats);
            for number in self.share.held_spheres(&place.structure.spheres) {
                if let Some(sphere) = transform.sphere(&self.share.list.spheres[number], &mut stats) {
                    take.sphere(sphere.regions, number as u32);
                }
            }
        }
        stats
    }

    fn triangles(
        &self,
        place: &PlacedStructure,
        transform: &Transform,
        take: &mut impl BinningSink,
        stats: &mut SetupStats,
    ) {
        let list = &self.share.list;
        let first = place.structure.triangles.start;
        let touched = place.touched(list, transform);
        let binned = self.picture.binning != RegionBinning::All;
        let has_boxes = self.picture.binning == RegionBinning::Boxes;
        let columns = self.picture.viewport.grid().columns();
        let mut in_one_region = 0;
        for number in self.share.held_triangles(&place.structure.triangles) {
            let triangle = number as u32;
            if binned && let Some(region) = touched.only_region(number - first) {
                in_one_region += 1;
                take.triangle_in(region, triangle);
                continue;
            }
            let mut pieces = 0;
            let mut put = |mask: RegionMask| {
                let mask = if has_boxes { mask.rectangle(columns) } else { mask };
                take.piece(mask, BinEntry { triangle, piece: Some(pieces) });
                pieces += 1;
            };
            match touched.get(number - first) {
                Touch::NeedsClipping => transform.bin(&list.corners(number), stats, put),
                whole => {
                    stats.triangles += 1;
                    if let Some(mask) = whole.count(stats) {
                        put(mask);
                    }
                }
            }
            if pieces == 0 && self.picture.binning == RegionBinning::All {
                take.piece(RegionMask::EMPTY, BinEntry { triangle, piece: None });
            }
        }
        // Most triangles touch only one region, so these triangles are counted together.
        stats.triangles += in_one_region;
        stats.screen_triangles += in_one_region;
    }
}

impl Share {
    /// Executes TRANSFORM of the share, for the eye with index `eye` of a view.
    pub fn transform(&self, view: &FrameView, eye: usize, picture: Picture) -> Arc<Pass> {
        Arc::new(Pass::new(self.clone(), view, eye, picture, None))
    }

    /// Executes TRANSFORM of the chosen structures. `chosen` has one entry for each structure.
    pub fn transform_chosen(&self, view: &FrameView, eye: usize, picture: Picture, chosen: &[bool]) -> Arc<Pass> {
        Arc::new(Pass::new(self.clone(), view, eye, picture, Some(chosen)))
    }
}

impl Pass {
    fn new(share: Share, view: &FrameView, eye: usize, picture: Picture, chosen: Option<&[bool]>) -> Self {
        let placed = place_cached(&share.list, view, eye, picture.viewport);
        let walk = Walk { share, placed, picture, chosen: chosen.map(Box::from) };
        let mut counting = PrimitiveCounter::of(&picture);
        let (stats, found) = if walk.chosen.is_none() {
            (walk.go(&mut counting), counting.found(None))
        } else {
            let mut noting = PrimitiveRecorder { counting, touching: Default::default() };
            (walk.go(&mut noting), noting.counting.found(Some(noting.touching)))
        };
        Self { walk, found, stats, bins: OnceLock::new(), touching: OnceLock::new(), encoder: OnceLock::new() }
    }

    /// Fills the bins by a second binning, because the first binning only counted primitives.
    fn filled(&self) -> Vec<Bin> {
        let room = |counts: &PrimitiveCounts| Bin {
            triangles: Vec::with_capacity(counts.triangles as usize),
            spheres: Vec::with_capacity(counts.spheres as usize),
        };
        let bins = self.found.counts.iter().map(room).collect();
        let mut filling = BinFiller { bins, binning: self.walk.picture.binning };
        self.walk.go(&mut filling);
        filling.bins
    }

    fn found_touching(&self) -> RegionTriangles {
        let mut touching = RegionTriangles { entries: vec![Vec::new(); self.found.counts.len()], n_triangles: 0 };
        self.walk.go(&mut touching);
        touching
    }

    pub fn counts(&self, region: RegionId) -> PrimitiveCounts {
        self.found.counts[usize::from(region.0)]
    }

    /// Returns the numbers of primitives on the screen. A primitive in several regions counts once.
    pub const fn screen_counts(&self) -> PrimitiveCounts {
        self.found.on_screen
    }

    pub fn entries(&self) -> u64 {
        self.found.counts.iter().map(|counts| u64::from(counts.total())).sum()
    }

    /// Returns the numbers of transformed primitives, visible or not.
    pub fn transformed(&self) -> PrimitiveCounts {
        self.walk.share.counts()
    }

    /// Returns the indices of the triangles and of the spheres in at least one bin. Returns `None` for a pass over all
    /// structures.
    pub const fn touching(&self) -> Option<&[Vec<u32>; 2]> {
        self.found.touching.as_ref()
    }

    /// Returns how many primitives were dropped, cut, or limited to the range of a number format.
    pub const fn stats(&self) -> SetupStats {
        self.stats
    }

    pub const fn picture(&self) -> &Picture {
        &self.walk.picture
    }

    pub fn background(&self) -> [u8; 3] {
        self.walk.share.list.background
    }

    /// Returns the light source of the first structure, in eye coordinates.
    pub fn light(&self) -> Option<&Light> {
        self.walk.placed.first().map(|placed| &placed.light)
    }

    pub(crate) fn placed(&self) -> Arc<[PlacedStructure]> {
        Arc::clone(&self.walk.placed)
    }

    pub(crate) const fn share(&self) -> &Share {
        &self.walk.share
    }

    pub(crate) fn encoder(&self) -> Option<&Encoder> {
        self.encoder.get_or_init(|| Encoder::for_picture(self.picture())).as_ref()
    }

    pub(crate) fn bin(&self, region: RegionId) -> &Bin {
        &self.bins.get_or_init(|| self.filled())[usize::from(region.0)]
    }

    pub(crate) fn triangles_in(&self, region: RegionId, places: &Range<u32>) -> &[BinEntry] {
        &self.bin(region).triangles[places.start as usize..places.end as usize]
    }

    /// Returns those triangles at the indices `places` of a bin that touch the region. Without [`RegionBinning::All`],
    /// these are all triangles of the bin.
    pub(crate) fn triangles_touching(&self, region: RegionId, places: &Range<u32>) -> Cow<'_, [BinEntry]> {
        if self.walk.picture.binning != RegionBinning::All {
            return Cow::Borrowed(self.triangles_in(region, places));
        }
        let all = &self.touching.get_or_init(|| self.found_touching()).entries[usize::from(region.0)];
        let [from, to] = [places.start, places.end].map(|place| all.partition_point(|entry| entry.0 < place));
        all[from..to].iter().map(|entry| entry.1).collect()
    }

    pub(crate) fn drawn(&self) -> impl Iterator<Item = (&PlacedStructure, &Transform)> {
        self.walk.taken().filter_map(|place| Some((place, place.transform.as_ref()?)))
    }

    /// Returns a flag for each structure, true if the structure is drawn. Returns `None` if all structures are drawn.
    pub(crate) fn chosen(&self) -> Option<&[bool]> {
        self.walk.chosen.as_deref()
    }
}

#[derive(Debug)]
pub(crate) enum Encoder {
    Gouraud(TriangleEncoder),
    Phong(PhongTriangleEncoder),
}

impl Encoder {
    /// Creates the encoder of a picture. Returns `None` if the layout of pixel memory lacks a bit field of the
    /// commands. The machine's configuration refuses such a layout.
    pub(crate) fn for_picture(picture: &Picture) -> Option<Self> {
        match picture.shading {
            Shading::Gouraud | Shading::Precomputed => Some(Self::Gouraud(TriangleEncoder::new(&picture.layout))),
            Shading::Phong => PhongTriangleEncoder::new(&picture.layout).ok().map(Self::Phong),
        }
    }
}
