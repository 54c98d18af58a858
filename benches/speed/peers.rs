//! One eye's picture of a scene by the software renderers `euc` and `retrofire`, and by the computations of the
//! emulated machine without its times.

use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingDisabled, Triangles};
use euc::{Interpolate, Pipeline as _, Target as _};
use glam::{Mat4, Vec3, Vec4};
use pphigs::{
    DisplayList, DisplayStructure, EyeView, FrameView, ModelFrame, Picture, RegionBinning, RegionEnvelope, Shading,
    Share,
};
use pxpl5::ViewNumber;
use pxpl5::scene::{Hmd, Scene, View};
use pxpl5_geometry::{Culling, Viewport};
use pxpl5_renderer::{Layout, PixelArray};
use pxpl5_wire::{RegionId, Word};
use retrofire_core::geom::{Tri, tri, vertex};
use retrofire_core::math::mat::viewport;
use retrofire_core::math::{Color3f, Mat4 as RetrofireMatrix, ProjVec3, pt2, rgb, rgba};
use retrofire_core::render::{Colorbuf, Context, Frag, Framebuf, Ndc, Screen, render, shader};
use retrofire_core::util::pixfmt::Xrgb8888;
use retrofire_core::util::{Buf2, Dims};
use std::sync::Arc;

const WIDTH: usize = 640;
const HEIGHT: usize = 480;

/// Number of views that are drawn in turn. The display list stores the results of fewer views, so no result is reused.
const VIEWS: u64 = 8;

pub(crate) fn views(head: &Scene) -> Vec<EyeView> {
    let hmd = Hmd::unc();
    let views = (0..VIEWS).map(|i| hmd.mono(&head.motion().pose(i * 100_000_000_000)));
    views
        .map(|View { world_to_eye, head_to_eye, projection, .. }| EyeView { world_to_eye, head_to_eye, projection })
        .collect()
}

/// Red, green, blue, 0 to 255.
#[derive(Clone, Copy)]
struct Lit(Vec3);

impl Interpolate for Lit {
    #[inline(always)]
    fn lerp2(a: Self, b: Self, x: f32, y: f32) -> Self {
        Self(a.0 * x + b.0 * y)
    }

    #[inline(always)]
    fn lerp3(a: Self, b: Self, c: Self, x: f32, y: f32, z: f32) -> Self {
        Self(a.0 * x + b.0 * y + c.0 * z)
    }
}

struct Gouraud<'a> {
    head: &'a Scene,
    matrix: Mat4,
}

impl euc::Pipeline for Gouraud<'_> {
    type Vertex = u32;
    type VsOut = Lit;
    type Pixel = u32;

    #[inline(always)]
    fn vert(&self, index: &u32) -> ([f32; 4], Lit) {
        let vertex = &self.head.vertices()[*index as usize];
        let light = self.head.lighting();
        let intensity = light.ambient + light.diffuse * vertex.normal.dot(light.towards_light).max(0.0);
        let place: Vec4 = self.matrix * vertex.position.extend(1.0);
        (place.to_array(), Lit(Vec3::from(vertex.colour.map(f32::from)) * intensity.min(1.0)))
    }

    #[inline(always)]
    fn frag(&self, lit: &Lit) -> u32 {
        let [red, green, blue] = lit.0.to_array().map(|c| c as u32);
        1 << 24 | red << 16 | green << 8 | blue
    }
}

pub(crate) struct Euc {
    indices: Vec<u32>,
    colour: Buffer2d<u32>,
    depth: Buffer2d<f32>,
}

impl Euc {
    pub(crate) fn new(head: &Scene) -> Self {
        let size = [WIDTH, HEIGHT];
        let indices = head.triangles().as_flattened().to_vec();
        Self { indices, colour: Buffer2d::new(size, 0), depth: Buffer2d::new(size, 1.0) }
    }

    pub(crate) fn draw(&mut self, head: &Scene, view: &EyeView) {
        self.colour.clear(0);
        self.depth.clear(1.0);
        let gouraud = Gouraud { head, matrix: view.projection * view.world_to_eye };
        let depth = Some(&mut self.depth);
        gouraud.draw::<Triangles<'_, Buffer2d<f32>, BackfaceCullingDisabled>, _>(
            &self.indices,
            &mut self.colour,
            depth,
        );
    }

    pub(crate) fn covered(&self) -> usize {
        self.colour.as_ref().iter().filter(|pixel| **pixel != 0).count()
    }
}

/// A vertex for `retrofire` is the number of a vertex of the scene.
type Numbered = u32;

pub(crate) struct Retrofire {
    triangles: Vec<Tri<usize>>,
    numbers: Vec<Numbered>,
    target: Framebuf<Colorbuf<Buf2<u32>, Xrgb8888>, Buf2<f32>>,
    to_screen: RetrofireMatrix<Ndc, Screen>,
}

impl Retrofire {
    pub(crate) fn new(head: &Scene) -> Self {
        let size = (WIDTH as u32, HEIGHT as u32);
        Self {
            triangles: head
                .triangles()
                .iter()
                .map(|corners| corners.map(|i| i as usize))
                .map(|[a, b, c]| tri(a, b, c))
                .collect(),
            numbers: (0..head.vertices().len() as u32).collect(),
            target: Framebuf {
                color_buf: Colorbuf::new(Buf2::new(Dims(size.0, size.1))),
                depth_buf: Buf2::new(Dims(size.0, size.1)),
            },
            to_screen: viewport(pt2(0, 0)..pt2(size.0, size.1)),
        }
    }

    pub(crate) fn draw(&mut self, head: &Scene, view: &EyeView) {
        let matrix = view.projection * view.world_to_eye;
        let light = head.lighting();
        let gouraud = shader::new(
            |number: Numbered, (): ()| {
                let corner = &head.vertices()[number as usize];
                let intensity = light.ambient + light.diffuse * corner.normal.dot(light.towards_light).max(0.0);
                let [red, green, blue] = corner.colour.map(|part| f32::from(part) / 255.0 * intensity.min(1.0));
                let place: Vec4 = matrix * corner.position.extend(1.0);
                vertex(ProjVec3::new(place.to_array()), rgb(red, green, blue))
            },
            |pixel: Frag<Color3f>, (): ()| {
                let [red, green, blue] = pixel.var.0.map(|part| (part * 255.0) as u8);
                rgba(red, green, blue, 255)
            },
        );
        // The depth buffer holds reciprocals of depths, so 0 stands for an infinite distance.
        self.target.color_buf.buf.fill(0);
        self.target.depth_buf.fill(0.0);
        let context = Context { face_cull: None, ..Context::default() };
        render(&self.triangles, &self.numbers, &gouraud, (), self.to_screen, &mut self.target, &context);
    }

    pub(crate) fn covered(&self) -> usize {
        self.target.depth_buf.data().iter().filter(|depth| **depth != 0.0).count()
    }
}

/// One graphics processor that stores the whole scene, and one pixel array that draws all regions in turn.
pub(crate) struct Ours<A> {
    share: Share,
    picture: Picture,
    array: A,
    words: Vec<Word>,
    pixels: Vec<Arc<[Word]>>,
}

const BACKGROUND: [u8; 3] = [1, 2, 3];

impl<A: PixelArray> Ours<A> {
    pub(crate) fn new(head: &Scene, array: impl Fn(&Layout) -> A) -> Self {
        let light = head.lighting();
        let structure = DisplayStructure {
            triangles: 0..head.triangles().len(),
            spheres: 0..0,
            frame: ModelFrame::World,
            culling: Culling::None,
        };
        let list = DisplayList {
            positions: head.vertices().iter().map(|v| v.position).collect(),
            normals: head.vertices().iter().map(|v| v.normal).collect(),
            colours: head.vertices().iter().map(|v| v.colour).collect(),
            triangles: head.triangles().to_vec(),
            structures: vec![structure],
            towards_light: light.towards_light,
            ambient: light.ambient,
            diffuse: light.diffuse,
            background: BACKGROUND,
            ..DisplayList::default()
        };
        let layout = Layout::rendering_control_phong();
        let viewport = Viewport::FRAME;
        let shading = Shading::Gouraud;
        let binning = RegionBinning::Touched;
        Self {
            share: Share::new(Arc::new(list.with_vertices_in_order()), 0, 1),
            picture: Picture { viewport, shading, binning, layout, pixels: true },
            array: array(&layout),
            words: Vec::new(),
            pixels: Vec::new(),
        }
    }

    pub(crate) fn draw(&mut self, view: &EyeView) {
        let view = FrameView { number: ViewNumber::FIRST, eyes: vec![*view], edits: Vec::new() };
        let pass = self.share.transform(&view, 0, self.picture);
        self.pixels.clear();
        let grid = self.picture.viewport.grid();
        for region in (0..grid.regions() as u16).map(RegionId) {
            let envelope = RegionEnvelope { begin: true, ..RegionEnvelope::default() };
            for list in pphigs::region_messages(&pass, region, 0, envelope) {
                self.array.draw(&list.content.expect("pixels are wanted"), &mut self.words);
            }
            assert_eq!(self.array.faults(), 0, "all commands are legal");
            let [_, _, width, height] = grid.rectangle(region);
            self.pixels.push(self.array.read_colour(width, height));
        }
    }

    pub(crate) fn covered(&self) -> usize {
        self.pixels.iter().flat_map(|region| region.iter()).filter(|pixel| **pixel != 0x01_02_03).count()
    }
}
