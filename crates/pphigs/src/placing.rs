//! The display list as one eye sees it: structures in place, vertices transformed once for all who share them.

use crate::list::DisplayList;
use crate::picture::Shading;
use crate::placed::{PlacedStructure, Vertices, ViewKey};
use crate::structure::{DisplayStructure, ModelFrame};
use crate::view::{EyeView, FrameView, product};
use glam::{Mat4, Vec3};
use pxpl5_geometry::{Light, SurfaceVertex, Touched, Transform, ViewTransform, Viewport};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// The model matrix of a structure that was never edited.
const UNMOVED: Mat4 = Mat4::IDENTITY;

/// All structures of a display list as an eye (0, or 0 and 1) of a view sees them.
///
/// # Panics
///
/// If the view has no eye; if the list has other structures than when it was first placed, and its
/// [`recent`](DisplayList::recent) is the same.
#[must_use]
pub fn place_all(list: &DisplayList, view: &FrameView, eye: usize, viewport: Viewport) -> Vec<PlacedStructure> {
    let eye = eye_of(view, eye);
    let named = list.recent.named(|| named(list));
    assert_eq!(named.len(), list.structures.len(), "a list that is changed wants an empty `recent`");
    let structures = list.structures.iter().zip(named.iter().cloned()).enumerate();
    structures.map(|(i, (s, named))| place(list, s, named, model(view, i), eye, viewport)).collect()
}

/// By structure, the vertices from the first that one of its triangles names to the last.
fn named(list: &DisplayList) -> Vec<Range<usize>> {
    let of = |structure: &DisplayStructure| {
        let all = list.triangles[structure.triangles.clone()].iter().flatten();
        let (first, end) = all.fold((u32::MAX, 0), |(low, high), i| (low.min(*i), high.max(*i + 1)));
        first as usize..end as usize
    };
    list.structures.iter().map(of).collect()
}

/// As [`place_all`], made once for all who ask.
pub(crate) fn place_once(
    list: &DisplayList,
    view: &FrameView,
    eye: usize,
    viewport: Viewport,
) -> Arc<[PlacedStructure]> {
    let key = ViewKey { eye: *eye_of(view, eye), edits: view.edits.clone(), viewport };
    list.recent.find_or_place(key, || place_all(list, view, eye, viewport))
}

fn eye_of(view: &FrameView, eye: usize) -> &EyeView {
    &view.eyes[eye.min(view.eyes.len() - 1)]
}

fn model(view: &FrameView, structure: usize) -> Mat4 {
    view.edits.iter().rev().find(|edit| edit.structure as usize == structure).map_or(UNMOVED, |edit| edit.model)
}

/// A structure whose matrices are not finite is not drawn.
fn place(
    list: &DisplayList,
    structure: &DisplayStructure,
    named: Range<usize>,
    model: Mat4,
    eye: &EyeView,
    viewport: Viewport,
) -> PlacedStructure {
    let to_eye = match structure.frame {
        ModelFrame::World => eye.world_to_eye,
        ModelFrame::Head => eye.head_to_eye,
    };
    let view = ViewTransform { model_view: product(&to_eye, &model), projection: eye.projection };
    let light = Light { direction: turned(&to_eye, list.towards_light), ambient: list.ambient, diffuse: list.diffuse };
    let transform = Transform::new(&view, viewport, structure.culling).ok();
    PlacedStructure {
        transform,
        light,
        structure: structure.clone(),
        matrices: [to_eye, model, eye.projection],
        named,
        vertices: OnceLock::new(),
        touched: OnceLock::new(),
    }
}

/// A direction in eye coordinates; the matrix is a rotation and a translation.
fn turned(matrix: &Mat4, v: Vec3) -> [f32; 3] {
    let [x, y, z, _] = matrix.to_cols_array_2d();
    std::array::from_fn(|i| x[i] * v.x + y[i] * v.y + z[i] * v.z)
}

impl PlacedStructure {
    /// The light in which the colours of corners are computed: none where they are precomputed.
    #[must_use]
    pub fn light_of_corners(&self, shading: Shading) -> &Light {
        if shading == Shading::Precomputed { &Light::NONE } else { &self.light }
    }

    /// Its vertices on the screen, transformed when first asked for.
    pub(crate) fn vertices(&self, list: &DisplayList, transform: &Transform) -> &Vertices {
        self.vertices.get_or_init(|| {
            let positions = list.positions.get(self.named.clone()).unwrap_or_default();
            let on_screen = transform.screen_vertices(positions);
            Vertices {
                first: self.named.start,
                on_screen,
                normals: OnceLock::new(),
                colours: OnceLock::new(),
                precomputed: OnceLock::new(),
            }
        })
    }

    /// The regions that its triangles touch, found when first asked for.
    pub(crate) fn touched(&self, list: &DisplayList, transform: &Transform) -> &Touched {
        self.touched.get_or_init(|| {
            let vertices = self.vertices(list, transform);
            let triangles = &list.triangles[self.structure.triangles.clone()];
            transform.touched(&vertices.on_screen, vertices.first as u32, triangles)
        })
    }
}

impl Vertices {
    fn named(&self) -> Range<usize> {
        self.first..self.first + self.on_screen.len()
    }

    /// All vertices with their normals.
    pub(crate) fn normals(&self, list: &DisplayList, transform: &Transform) -> &[SurfaceVertex] {
        let find =
            || transform.vertex_normals(&self.on_screen, &list.positions[self.named()], &list.normals[self.named()]);
        self.normals.get_or_init(find)
    }

    /// All vertices with their colours under a light, which is none where they are precomputed.
    pub(crate) fn colours(
        &self,
        list: &DisplayList,
        transform: &Transform,
        shading: Shading,
        light: &Light,
    ) -> &[SurfaceVertex] {
        let colours = if shading == Shading::Precomputed { &self.precomputed } else { &self.colours };
        colours.get_or_init(|| {
            let all = self.named();
            let [positions, normals] = [&list.positions, &list.normals].map(|all_of_them| &all_of_them[all.clone()]);
            transform.vertex_colours(light, &self.on_screen, positions, normals, &list.colours[all])
        })
    }
}
