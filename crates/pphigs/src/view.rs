//! The host's message for a frame, with the matrices of the eyes and the new positions of structures, as words.

use glam::{DMat4, Mat4};
use pxpl5_geometry::Culling;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{MAX_MESSAGE_WORDS, ViewNumber, Word};
use std::ops::Range;

/// The coordinates in which a structure is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFrame {
    /// The room, in which the viewer moves.
    World,
    /// The viewer's head, so that the structure moves with the head.
    Head,
}

/// Successive primitives that move together.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayStructure {
    /// Range of the structure's triangles in the display list.
    pub triangles: Range<usize>,
    /// Range of the structure's spheres in the display list.
    pub spheres: Range<usize>,
    pub frame: ModelFrame,
    /// Choice of the triangles that are not drawn because of their winding. PHIGS+ has this choice for each structure.
    pub culling: Culling,
}

/// The matrices of one eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeView {
    /// Matrix from world to eye coordinates.
    pub world_to_eye: Mat4,
    /// Matrix from head to eye coordinates.
    pub head_to_eye: Mat4,
    /// Matrix from eye to clip coordinates.
    pub projection: Mat4,
}

/// A new matrix for one structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelEdit {
    /// Index of the structure in the display list.
    pub structure: u32,
    /// Matrix from the structure's coordinates to the coordinates of the room or the head.
    pub model: Mat4,
}

/// One view: the matrices of the eyes, and the structures that have moved.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameView {
    /// Number of the view, as counted by its pipeline.
    pub number: ViewNumber,
    /// Matrices of a single eye, or of the left and the right eye.
    pub eyes: Vec<EyeView>,
    /// Structures that have moved since the previous frame.
    pub edits: Vec<ModelEdit>,
}

const EYE_WORDS: usize = 48;
const EDIT_WORDS: usize = 17;
const HEADER_WORDS: usize = 4;

/// Largest number of edits that fit into one message with the matrices of two eyes.
pub const MAX_EDITS: usize = (MAX_MESSAGE_WORDS as usize - 8 - HEADER_WORDS - 2 * EYE_WORDS) / EDIT_WORDS;

impl FrameView {
    /// Encodes the view as words: number of the view (two words), number of eyes, number of edits, then the matrices
    /// column by column.
    pub fn to_words(&self) -> Vec<Word> {
        let [low, high] = self.number.to_words();
        let header = [low, high, self.eyes.len() as Word, self.edits.len() as Word];
        let mut words = header.to_vec();
        for eye in &self.eyes {
            [eye.world_to_eye, eye.head_to_eye, eye.projection].iter().for_each(|m| push_matrix(&mut words, m));
        }
        for edit in &self.edits {
            words.push(edit.structure);
            push_matrix(&mut words, &edit.model);
        }
        words
    }

    /// Decodes words that [`FrameView::to_words`] has encoded.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the number of words does not match the header.
    pub fn from_words(words: &[Word]) -> Result<Self, SettingError> {
        let n_eyes = header_word(words, 2);
        let n_edits = header_word(words, 3);
        let expected =
            HEADER_WORDS + n_eyes.saturating_mul(EYE_WORDS).saturating_add(n_edits.saturating_mul(EDIT_WORDS));
        // Check the length once, so that the slices below cannot fail.
        if words.len() != expected {
            return Err(SettingError::value("view", format_args!("{expected} words"), words.len()));
        }
        let (eyes, edits) = words[HEADER_WORDS..].split_at(n_eyes * EYE_WORDS);
        Ok(Self {
            number: ViewNumber::from_words(words[0], words[1]),
            eyes: eyes.chunks_exact(EYE_WORDS).map(eye).collect(),
            edits: edits
                .chunks_exact(EDIT_WORDS)
                .map(|e| ModelEdit { structure: e[0], model: matrix(&e[1..]) })
                .collect(),
        })
    }
}

fn header_word(words: &[Word], place: usize) -> usize {
    words.get(place).map_or(0, |word| *word as usize)
}

fn push_matrix(words: &mut Vec<Word>, matrix: &Mat4) {
    words.extend(matrix.to_cols_array().map(f32::to_bits));
}

fn matrix(words: &[Word]) -> Mat4 {
    Mat4::from_cols_array(&std::array::from_fn(|i| f32::from_bits(words[i])))
}

fn eye(words: &[Word]) -> EyeView {
    let [world_to_eye, head_to_eye, projection] = [0, 16, 32].map(|i| matrix(&words[i..i + 16]));
    EyeView { world_to_eye, head_to_eye, projection }
}

/// Returns `left * right`, computed in double precision and rounded once, so that every host gets the same result.
pub(crate) fn product(left: &Mat4, right: &Mat4) -> Mat4 {
    let left: DMat4 = left.as_dmat4();
    let right: DMat4 = right.as_dmat4();
    (left * right).as_mat4()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_decoded_from_its_words_bit_for_bit() {
        let edits = vec![ModelEdit { structure: 3, model: some_matrix(9.0) }];
        let view = FrameView { number: ViewNumber(1 << 40), eyes: vec![some_eye(1.0), some_eye(2.0)], edits };
        assert_eq!(FrameView::from_words(&view.to_words()), Ok(view));
    }

    fn some_eye(k: f32) -> EyeView {
        EyeView { world_to_eye: some_matrix(k), head_to_eye: some_matrix(k + 0.1), projection: some_matrix(-k) }
    }

    fn some_matrix(k: f32) -> Mat4 {
        Mat4::from_cols_array(&std::array::from_fn(|i| k + i as f32 / 3.0))
    }

    #[test]
    fn words_of_the_wrong_length_are_refused() {
        assert!(FrameView::from_words(&[]).is_err());
        assert!(FrameView::from_words(&[0, 0, u32::MAX, u32::MAX]).is_err());
    }

    #[test]
    fn the_largest_number_of_edits_fits_one_message() {
        assert!(HEADER_WORDS + 2 * EYE_WORDS + MAX_EDITS * EDIT_WORDS + 8 <= MAX_MESSAGE_WORDS as usize);
    }
}
