use crate::cube::update::FaceUpdate;
use pphigs::{DisplayList, ModelFrame};
use pxpl5_wire::PictureNumber;
use std::collections::{BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

/// A cache of display lists with displaced vertices, which all slaves use. The simulator displaces the vertices once
/// for all slaves, so the cache saves time and changes no result.
#[derive(Clone, Debug, Default)]
pub struct WarpedLists(Arc<Mutex<Kept>>);

/// Display lists and the numbers of their updates, newest first.
type Kept = VecDeque<(PictureNumber, Arc<DisplayList>)>;

/// Number of display lists in the cache. A fast slave can be one update ahead of a slow slave, so two lists can be in
/// use.
const KEPT: usize = 2;

impl WarpedLists {
    /// Returns the display list with the displaced vertices of an update. Only vertices of structures that the display
    /// memory holds are displaced. Structures that are fixed to the head or moved by an edit stay in place.
    pub fn placed(&self, list: &Arc<DisplayList>, update: &FaceUpdate) -> Arc<DisplayList> {
        let Some(warp) = &update.warp else { return Arc::clone(list) };
        let (number, memory) = (update.number, usize::from(update.memory));
        let is_edited = |place: usize| update.view.edits.iter().any(|edit| edit.structure as usize == place);
        let is_still = |place: usize| update.structures.get(place) == Some(&true) && !is_edited(place);
        // Another slave may have computed the list already.
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, warped)) = kept.iter().find(|(cached, _)| *cached == number) {
            return Arc::clone(warped);
        }
        let mut warped = DisplayList::clone(list);
        // Move each vertex of the chosen structures once.
        let structures = list.structures.iter().enumerate();
        let still = structures.filter(|(place, structure)| structure.frame == ModelFrame::World && is_still(*place));
        let corners = still.flat_map(|(_, structure)| list.triangles[structure.triangles.clone()].iter().flatten());
        let vertices: BTreeSet<u32> = corners.copied().collect();
        for vertex in vertices {
            let place = &mut warped.positions[vertex as usize];
            *place = warp.moved(place.as_dvec3(), memory).map_or(*place, |moved| moved.as_vec3());
        }
        let warped = Arc::new(warped);
        kept.truncate(KEPT - 1);
        kept.push_front((number, Arc::clone(&warped)));
        warped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::warp::FaceWarp;
    use address_recalculation::priority::{Cell, CellAssignment, Falloff};
    use glam::{DVec3, Mat4, Vec3};
    use pphigs::{DisplayStructure, EyeView, FrameView, ModelEdit};
    use pxpl5_geometry::Culling;
    use pxpl5_wire::ViewNumber;

    /// Returns structures of one triangle each, which lie half a metre from the border between two display memories at
    /// x = 10 m.
    fn list() -> Arc<DisplayList> {
        let mut list = DisplayList::default();
        let frames = [ModelFrame::World, ModelFrame::Head, ModelFrame::World, ModelFrame::World, ModelFrame::World];
        for (n, frame) in frames.into_iter().enumerate() {
            let at = |y: f32| Vec3::new(9.5, y + n as f32, 5.0);
            list.positions.extend([at(0.0), at(0.3), at(0.6)]);
            list.normals.extend([Vec3::X; 3]);
            list.colours.extend([[100; 3]; 3]);
            let first = 3 * n as u32;
            list.triangles.push([first, first + 1, first + 2]);
            list.structures.push(DisplayStructure {
                triangles: n..n + 1,
                spheres: 0..0,
                frame,
                culling: Culling::None,
            });
        }
        Arc::new(list)
    }

    /// Returns an update of a display memory that holds all structures except the third. The fourth structure is moved
    /// by an edit.
    fn update(number: u64) -> FaceUpdate {
        let assignment =
            CellAssignment { home: Cell { x: 0, z: 0 }, side_m: 10.0, inner_rings: 0, ring_growth: 1, memories: 2 };
        let eye = EyeView { world_to_eye: Mat4::IDENTITY, head_to_eye: Mat4::IDENTITY, projection: Mat4::IDENTITY };
        let edits = vec![ModelEdit { structure: 3, model: Mat4::IDENTITY }];
        FaceUpdate {
            number: PictureNumber(number),
            memory: 0,
            buffer: 0,
            together: 0,
            view: FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits },
            structures: vec![true, true, false, true, true],
            warp: Some(FaceWarp {
                assignment,
                falloff: Falloff::Smoothstep,
                length_m: 4.0,
                drawn_from: DVec3::new(5.0, 1.7, 5.0),
                slower_from: DVec3::new(4.0, 1.5, 4.5),
            }),
        }
    }

    #[test]
    fn only_cached_vertices_of_static_objects_are_moved() {
        let list = list();
        let update = update(7);
        let warp = update.warp.expect("a warp");
        let placed = WarpedLists::default().placed(&list, &update);
        for (vertex, (before, found)) in list.positions.iter().zip(&placed.positions).enumerate() {
            let moved = warp.moved(before.as_dvec3(), 0).expect("a length").as_vec3();
            assert!(moved.distance(*before) > 0.01, "{moved} {before}");
            let expected = if [0, 4].contains(&(vertex / 3)) { moved } else { *before };
            assert_eq!(*found, expected, "{vertex}");
        }
        let still = FaceUpdate { warp: None, ..update };
        assert!(Arc::ptr_eq(&WarpedLists::default().placed(&list, &still), &list));
    }

    #[test]
    fn the_lists_of_the_two_newest_updates_are_kept() {
        let list = list();
        let lists = WarpedLists::default();
        let made: Vec<_> = (0..3).map(|number| lists.placed(&list, &update(number))).collect();
        for (number, is_kept) in [(2, true), (1, true), (0, false)] {
            let again = lists.placed(&list, &update(number));
            assert_eq!(Arc::ptr_eq(&again, &made[number as usize]), is_kept, "{number}");
        }
    }
}
