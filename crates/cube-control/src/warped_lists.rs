//! Display lists whose vertices stand where an update wants them.

use crate::update::FaceUpdate;
use pphigs::{DisplayList, ModelFrame};
use pxpl5_wire::PictureNumber;
use std::collections::{BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

/// Display lists with moved vertices. All slaves move the same ones alike; only the host's time is saved by keeping them.
#[derive(Clone, Debug, Default)]
pub struct WarpedLists(Arc<Mutex<Kept>>);

/// Lists by the update that they are of, the newest first.
type Kept = VecDeque<(PictureNumber, Arc<DisplayList>)>;

/// Updates whose lists are kept: one that is transformed while a slower slave is at the one before.
const KEPT: usize = 2;

impl WarpedLists {
    /// The list of an update, in which vertices of the structures that are still stand where the update wants them.
    #[must_use]
    pub fn placed(&self, list: &Arc<DisplayList>, update: &FaceUpdate) -> Arc<DisplayList> {
        let Some(warp) = &update.warp else { return Arc::clone(list) };
        let (number, memory) = (update.number, usize::from(update.memory));
        let is_edited = |place: usize| update.view.edits.iter().any(|edit| edit.structure as usize == place);
        let is_still = |place: usize| update.structures.get(place) == Some(&true) && !is_edited(place);
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, warped)) = kept.iter().find(|(known, _)| *known == number) {
            return Arc::clone(warped);
        }
        let mut warped = DisplayList::clone(list);
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
