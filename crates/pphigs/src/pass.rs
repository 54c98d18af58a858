//! One TRANSFORM of a GP's share for one eye.

use crate::list::{Counts, Share};
use crate::placed::{Corners, Placed, RecentViews, Vertices};
use crate::view::FrameView;
use pxpl5_geometry::{
    Light, LitColours, Outline, RegionMask, ScreenSphere, ScreenTriangle, SetupStats, SurfaceNormals, Transform,
    Viewport,
};
use pxpl5_renderer::Layout;
use pxpl5_wire::RegionId;
use std::sync::{Arc, OnceLock};

/// Where colours are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// At the corners, by the GP; interpolated by the renderers.
    Gouraud,
    /// At the pixels, by the renderers, once at the end of the frame.
    Phong,
}

/// Which regions a primitive's commands are sent to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binning {
    /// Those that it touches.
    Touched,
    /// All; a triangle that is not seen costs as much as any other, and draws nothing (Slats prototype, TR94). Spheres,
    /// which the prototype did not have, go to the regions that they touch: elsewhere a quadratic leaves its 48 bits.
    All,
}

/// What to make of a view.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Lines and regions.
    pub viewport: Viewport,
    /// Where colours are computed.
    pub shading: Shading,
    /// Who gets the commands.
    pub binning: Binning,
    /// Division of pixel memory that the commands are encoded for.
    pub layout: Layout,
    /// Whether somebody may want the command words.
    pub pixels: bool,
}

/// Screen triangles in the order in which binning met them.
#[derive(Debug)]
pub(crate) enum ScreenTriangles {
    Gouraud(Vec<ScreenTriangle<LitColours>>),
    Phong(Vec<ScreenTriangle<SurfaceNormals>>),
}

/// Screen primitives in the order in which binning met them.
#[derive(Debug)]
pub(crate) struct Screen {
    pub(crate) triangles: ScreenTriangles,
    /// With the light of their structures.
    pub(crate) spheres: Vec<(ScreenSphere, Light)>,
}

/// Bins of one eye: for each region the numbers of the screen primitives that touch it.
#[derive(Debug)]
pub struct Pass {
    share: Share,
    placed: Arc<[Placed]>,
    picture: Picture,
    counts: Vec<Counts>,
    /// Sequence numbers of screen triangles and spheres by region; empty without pixels.
    bins: Vec<[Vec<u32>; 2]>,
    screen_counts: Counts,
    stats: SetupStats,
    screen: OnceLock<Screen>,
}

/// Nothing on the screen: a triangle whose edges exclude every pixel.
const NOWHERE: Outline = Outline { x: [0; 3], y: [0; 3], z: [0; 3], regions: RegionMask::EMPTY };

impl Pass {
    pub(crate) fn new(share: Share, view: &FrameView, eye: usize, picture: Picture) -> Self {
        let regions = picture.viewport.grid().regions() as usize;
        let placed = RecentViews::place_all(&share.list, view, eye, picture.viewport);
        let bins = if picture.pixels { vec![[Vec::new(), Vec::new()]; regions] } else { Vec::new() };
        let mut pass = Self {
            share,
            placed,
            picture,
            counts: vec![Counts::default(); regions],
            bins,
            screen_counts: Counts::default(),
            stats: SetupStats::default(),
            screen: OnceLock::new(),
        };
        pass.binitize();
        pass
    }

    fn binitize(&mut self) {
        let (mut stats, placed) = (SetupStats::default(), Arc::clone(&self.placed));
        let share = self.share.clone();
        for (place, transform) in placed.iter().filter_map(|p| Some((p, p.transform.as_ref()?))) {
            let vertices = place.vertices(&share.list, transform);
            for number in share.held_triangles(&place.structure.triangles) {
                let before = self.screen_counts.triangles;
                let corners = vertices.corners(&share.list, number);
                transform.bin_seen(vertices.seen(&corners), &mut stats, |mask| self.put_triangle(mask));
                if self.screen_counts.triangles == before && self.picture.binning == Binning::All {
                    self.put_triangle(RegionMask::EMPTY);
                }
            }
            for number in share.held_spheres(&place.structure.spheres) {
                if let Some(sphere) = transform.sphere(&share.list.spheres[number], &mut stats) {
                    self.put_sphere(sphere.regions);
                }
            }
        }
        self.stats = stats;
    }

    fn receivers(&self, mask: RegionMask) -> RegionMask {
        match self.picture.binning {
            Binning::Touched => mask,
            Binning::All => {
                let all = (0..self.counts.len()).map(|i| RegionMask::only(RegionId(i as u16)));
                all.fold(RegionMask::EMPTY, RegionMask::union)
            }
        }
    }

    fn put_triangle(&mut self, mask: RegionMask) {
        for region in self.receivers(mask).iter() {
            self.counts[usize::from(region.0)].triangles += 1;
            if let Some(bin) = self.bins.get_mut(usize::from(region.0)) {
                bin[0].push(self.screen_counts.triangles);
            }
        }
        self.screen_counts.triangles += 1;
    }

    fn put_sphere(&mut self, mask: RegionMask) {
        for region in mask.iter() {
            self.counts[usize::from(region.0)].spheres += 1;
            if let Some(bin) = self.bins.get_mut(usize::from(region.0)) {
                bin[1].push(self.screen_counts.spheres);
            }
        }
        self.screen_counts.spheres += 1;
    }

    /// Entries of a region's bin.
    #[must_use]
    pub fn counts(&self, region: RegionId) -> Counts {
        self.counts[usize::from(region.0)]
    }

    /// Primitives on the screen, each counted once.
    #[must_use]
    pub const fn screen_counts(&self) -> Counts {
        self.screen_counts
    }

    /// Entries of all bins.
    #[must_use]
    pub fn entries(&self) -> u64 {
        self.counts.iter().map(|counts| u64::from(counts.total())).sum()
    }

    /// Primitives transformed.
    #[must_use]
    pub fn transformed(&self) -> Counts {
        self.share.counts()
    }

    /// What happened to the primitives.
    #[must_use]
    pub const fn stats(&self) -> SetupStats {
        self.stats
    }

    /// What is made of the view.
    #[must_use]
    pub const fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Background colour.
    #[must_use]
    pub fn background(&self) -> [u8; 3] {
        self.share.list.background
    }

    /// The light as the first structure's eye sees it.
    #[must_use]
    pub fn light(&self) -> Option<&Light> {
        self.placed.first().map(|placed| &placed.light)
    }

    pub(crate) const fn share(&self) -> &Share {
        &self.share
    }

    pub(crate) fn placed(&self) -> &[Placed] {
        &self.placed
    }

    pub(crate) fn bin(&self, region: RegionId) -> &[Vec<u32>; 2] {
        &self.bins[usize::from(region.0)]
    }

    /// The screen primitives, made when first asked for.
    pub(crate) fn screen(&self) -> &Screen {
        self.screen.get_or_init(|| {
            let mut stats = SetupStats::default();
            let triangles = match self.picture.shading {
                Shading::Gouraud => ScreenTriangles::Gouraud(self.gouraud(&mut stats)),
                Shading::Phong => ScreenTriangles::Phong(self.phong(&mut stats)),
            };
            Screen { triangles, spheres: self.spheres(&mut stats) }
        })
    }

    fn gouraud(&self, stats: &mut SetupStats) -> Vec<ScreenTriangle<LitColours>> {
        let nothing = ScreenTriangle { outline: NOWHERE, surface: LitColours([[0; 3]; 3]) };
        let list = &self.share.list;
        self.each_triangle(nothing, |transform, place, vertices, at, _, all| {
            let colours = at.copied(vertices.colours(list, transform, &place.light));
            transform.gouraud_seen(vertices.seen(at), colours, stats, |t| all.push(t));
        })
    }

    fn phong(&self, stats: &mut SetupStats) -> Vec<ScreenTriangle<SurfaceNormals>> {
        let nothing =
            ScreenTriangle { outline: NOWHERE, surface: SurfaceNormals { normals: [[0; 3]; 3], colour: [0; 3] } };
        let list = &self.share.list;
        self.each_triangle(nothing, |transform, _, vertices, at, number, all| {
            let normals = at.copied(vertices.normals(list, transform));
            let colour = list.colours[list.triangles[number][0] as usize];
            transform.phong_seen(vertices.seen(at), normals, colour, stats, |t| all.push(t));
        })
    }

    /// Collects the pieces of all triangles, and `nothing` for one without any where all are sent.
    fn each_triangle<T>(
        &self,
        nothing: T,
        mut pieces: impl FnMut(&Transform, &Placed, &Vertices, &Corners, usize, &mut Vec<T>),
    ) -> Vec<T>
    where
        T: Copy,
    {
        let mut all = Vec::with_capacity(self.screen_counts.triangles as usize);
        for (place, transform) in self.placed.iter().filter_map(|p| Some((p, p.transform.as_ref()?))) {
            let vertices = place.vertices(&self.share.list, transform);
            for number in self.share.held_triangles(&place.structure.triangles) {
                let before = all.len();
                let corners = vertices.corners(&self.share.list, number);
                pieces(transform, place, vertices, &corners, number, &mut all);
                if all.len() == before && self.picture.binning == Binning::All {
                    all.push(nothing);
                }
            }
        }
        all
    }

    fn spheres(&self, stats: &mut SetupStats) -> Vec<(ScreenSphere, Light)> {
        let mut all = Vec::with_capacity(self.screen_counts.spheres as usize);
        for (place, transform) in self.placed.iter().filter_map(|p| Some((p, p.transform.as_ref()?))) {
            let held = self.share.held_spheres(&place.structure.spheres);
            let seen = held.filter_map(|i| transform.sphere(&self.share.list.spheres[i], stats));
            all.extend(seen.map(|sphere| (sphere, place.light)));
        }
        all
    }
}
