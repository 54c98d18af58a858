//! Placement of structures: computes matrices and light for one eye, and transforms each vertex once.

use crate::list::DisplayList;
use crate::picture::Shading;
use crate::placed::{PlacedStructure, Vertices, ViewKey};
use crate::view::{DisplayStructure, EyeView, FrameView, ModelFrame, product};
use glam::{Mat4, Vec3};
use pxpl5_geometry::{Light, SurfaceVertex, Touched, Transform, ViewTransform, Viewport};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

const UNMOVED: Mat4 = Mat4::IDENTITY;

/// Places all structures of a display list for one eye of a view. `eye` is 0 for a single or left eye, 1 for a right
/// eye.
///
/// # Panics
///
/// Panics if the view has no eye. Also panics if the structures have changed since they were first placed, and the
/// cache [`recent`](DisplayList::recent) was not emptied.
pub fn place_all(list: &DisplayList, view: &FrameView, eye: usize, viewport: Viewport) -> Vec<PlacedStructure> {
    let eye = eye_of(view, eye);
    let named = list.recent.named(|| named(list));
    assert_eq!(named.len(), list.structures.len(), "a list that is changed wants an empty `recent`");
    let structures = list.structures.iter().zip(named.iter().cloned()).enumerate();
    structures.map(|(i, (s, named))| place(list, s, named, model(view, i), eye, viewport)).collect()
}

/// Returns for each structure the range from the first to the last of its vertices.
fn named(list: &DisplayList) -> Vec<Range<usize>> {
    let of = |structure: &DisplayStructure| {
        let all = list.triangles[structure.triangles.clone()].iter().flatten();
        let (first, end) = all.fold((u32::MAX, 0), |(low, high), i| (low.min(*i), high.max(*i + 1)));
        first as usize..end as usize
    };
    list.structures.iter().map(of).collect()
}

/// Places structures like [`place_all`], but reads results that were computed before from the list's cache.
pub(crate) fn place_cached(
    list: &DisplayList,
    view: &FrameView,
    eye: usize,
    viewport: Viewport,
) -> Arc<[PlacedStructure]> {
    let key = ViewKey { eye: *eye_of(view, eye), edits: view.edits.clone(), viewport };
    list.recent.cached_or_placed(key, || place_all(list, view, eye, viewport))
}

fn eye_of(view: &FrameView, eye: usize) -> &EyeView {
    &view.eyes[eye.min(view.eyes.len() - 1)]
}

fn model(view: &FrameView, structure: usize) -> Mat4 {
    view.edits.iter().rev().find(|edit| edit.structure as usize == structure).map_or(UNMOVED, |edit| edit.model)
}

/// Places one structure. If a matrix is not finite, the structure has no transform and is not drawn.
fn place(
    list: &DisplayList,
    structure: &DisplayStructure,
    named: Range<usize>,
    model: Mat4,
    eye: &EyeView,
    viewport: Viewport,
) -> PlacedStructure {
    // World structures move with the world, head structures with the viewer's head.
    let to_eye = match structure.frame {
        ModelFrame::World => eye.world_to_eye,
        ModelFrame::Head => eye.head_to_eye,
    };
    let view = ViewTransform { model_view: product(&to_eye, &model), projection: eye.projection };
    let light = Light { direction: turned(&to_eye, list.towards_light), ambient: list.ambient, diffuse: list.diffuse };
    let new = if list.is_single { Transform::in_single_precision } else { Transform::new };
    let transform = new(&view, viewport, structure.culling).ok();
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

/// Rotates a direction. The matrix must consist of a rotation and a translation.
fn turned(matrix: &Mat4, v: Vec3) -> [f32; 3] {
    let [x, y, z, _] = matrix.to_cols_array_2d();
    std::array::from_fn(|i| x[i] * v.x + y[i] * v.y + z[i] * v.z)
}

impl PlacedStructure {
    /// Returns the light source for the corners of triangles: [`Light::NONE`] if the colours are precomputed.
    pub fn light_of_corners(&self, shading: Shading) -> &Light {
        if shading == Shading::Precomputed { &Light::NONE } else { &self.light }
    }

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

    pub(crate) fn normals(&self, list: &DisplayList, transform: &Transform) -> &[SurfaceVertex] {
        let find =
            || transform.vertex_normals(&self.on_screen, &list.positions[self.named()], &list.normals[self.named()]);
        self.normals.get_or_init(find)
    }

    /// Returns all vertices with their colours under `light`, which must be [`Light::NONE`] for precomputed colours.
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
