//! The rules of TR94 for the beginning of each stage. A rule is a function that returns true if the stage may begin.

use pxpl5_wire::PictureNumber;

/// Number of a drawing.
///
/// A drawing is the picture of one eye, or an update of a display memory. Drawings are counted through all frames. In a
/// stereo picture, drawing 0 is the left eye of frame 0, and drawing 1 is the right eye of frame 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Drawing(pub u64);

impl Drawing {
    /// Returns the first drawing of a frame, if each frame has `eyes` drawings.
    pub const fn first_of(frame: PictureNumber, eyes: u64) -> Self {
        Self(frame.0 * eyes)
    }

    /// Returns the frame that contains the drawing, if each frame has `eyes` drawings.
    pub const fn picture(self, eyes: u64) -> PictureNumber {
        PictureNumber(self.0 / eyes)
    }

    /// Returns the index of the eye for which this drawing is made, from 0 to `eyes` - 1.
    pub const fn eye(self, eyes: u64) -> u64 {
        self.0 % eyes
    }

    /// Returns 0 or 1, the index of the set of bins that each slave uses for the drawing.
    pub(crate) const fn context(self) -> usize {
        (self.0 % 2) as usize
    }

    /// Returns the drawing with the number of this drawing plus `count`.
    #[must_use]
    pub const fn after(self, count: u64) -> Self {
        Self(self.0 + count)
    }
}

/// Progress of all stages: for each stage, the number of frames or drawings that have passed the stage.
///
/// A drawing is the picture of one eye. Every stage processes frames and drawings in the order of their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Completed {
    /// Number of drawings of a frame: 1 for a mono picture, 2 for a stereo picture.
    pub eyes: u64,
    /// Number of frames that the host has sent (SEND).
    pub sent: u64,
    /// Number of frames for which all slaves have finished EDIT.
    pub edited: u64,
    /// Number of drawings for which all slaves have finished TRANSFORM.
    pub transformed: u64,
    /// Number of drawings for which the renderers have accepted the last commands (RENDER).
    pub rendered: u64,
    /// Number of drawings of which all regions have arrived in a frame buffer (COPY).
    pub copied: u64,
    /// Number of frames that frame buffers have shown after a swap. If pictures are announced
    /// ([`Drawn::ANNOUNCES`](crate::Drawn::ANNOUNCES)), all swaps count, and the rules for swaps and for free frame
    /// buffers do not apply.
    pub swapped: u64,
}

impl Completed {
    /// Returns the progress at power-on, when nothing has passed any stage.
    pub const fn none(eyes: u64) -> Self {
        Self { eyes, sent: 0, edited: 0, transformed: 0, rendered: 0, copied: 0, swapped: 0 }
    }

    /// Returns true if EDIT of a frame may begin.
    ///
    /// Let n be the number of the frame's first drawing, where a drawing is the picture of one eye. SEND of the frame
    /// must have finished. TRANSFORM of drawing n - 1, RENDER of drawing n - 2, and COPY of drawing n - 3 must also
    /// have finished. Before that, older drawings still use the bins and the pixel memory.
    pub const fn may_edit(&self, frame: PictureNumber) -> bool {
        let first = Drawing::first_of(frame, self.eyes);
        self.sent > frame.0 && self.transformed >= first.0 && self.buffers_free(first)
    }

    /// Returns true if TRANSFORM of a drawing may begin. A drawing is the picture of one eye.
    ///
    /// Let n be the number of the drawing. EDIT of its frame must have finished, and RENDER of drawing n - 2 and COPY of
    /// drawing n - 3 as well. The master applies the rule to the right eye and waits for all slaves. Each slave begins
    /// TRANSFORM of the left eye by itself, directly after its own EDIT: TR94 needs no synchronization there, because
    /// EDIT began under the same conditions.
    pub const fn may_transform(&self, drawing: Drawing) -> bool {
        self.edited > drawing.picture(self.eyes).0 && self.buffers_free(drawing)
    }

    /// Returns true if a drawing has buffers in all boards. Each slave has two sets of bins, and the pixel memory of
    /// each renderer has two parts.
    const fn buffers_free(&self, drawing: Drawing) -> bool {
        self.rendered + 1 >= drawing.0 && self.copied + 2 >= drawing.0
    }

    /// Returns true if RENDER of a drawing (the picture of one eye) may begin. All slaves must have finished TRANSFORM
    /// of this drawing, and RENDER of the previous drawing must have finished.
    pub const fn may_render(&self, drawing: Drawing) -> bool {
        self.transformed > drawing.0 && self.rendered >= drawing.0
    }

    /// Returns true if the hidden buffer for a drawing is free. The buffer is free when a swap has made the previous
    /// frame visible, so that the hidden half holds a frame that was scanned out earlier (TR94).
    pub const fn frame_buffer_available(&self, drawing: Drawing) -> bool {
        self.swapped >= drawing.picture(self.eyes).0
    }

    /// Returns true if COPY of a drawing (the picture of one eye) may begin. The hidden buffer must be free, and COPY
    /// of the previous drawing must have finished.
    ///
    /// Each frame buffer has its own ring port, so the hardware could make two copies at the same time. TR94 says that
    /// Rendering Control works on one eye after the other and therefore copies to one frame buffer at a time.
    pub const fn may_copy(&self, drawing: Drawing) -> bool {
        self.frame_buffer_available(drawing) && self.copied >= drawing.0
    }

    /// Returns true if frame buffers may show a frame. COPY of all drawings of the frame must have finished.
    pub const fn may_swap(&self, frame: PictureNumber) -> bool {
        self.copied >= Drawing::first_of(frame.next(), self.eyes).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mono_edit_waits_for_send_transform_render_and_copy_of_earlier_frames() {
        // EDIT 5 needs SEND 5, TRANSFORM 4, RENDER 3 and COPY 2 (TR94).
        let ready = Completed { eyes: 1, sent: 6, edited: 5, transformed: 5, rendered: 4, copied: 3, swapped: 0 };
        assert!(ready.may_edit(PictureNumber(5)));
        for blocked in [
            Completed { sent: 5, ..ready },
            Completed { transformed: 4, ..ready },
            Completed { rendered: 3, ..ready },
            Completed { copied: 2, ..ready },
        ] {
            assert!(!blocked.may_edit(PictureNumber(5)), "{blocked:?}");
        }
    }

    #[test]
    fn stereo_transform_waits_for_the_second_and_third_previous_eye() {
        // The right eye of frame 4 is drawing 9, which needs RENDER of drawing 7 and COPY of drawing 6.
        let ready = Completed { eyes: 2, sent: 5, edited: 5, transformed: 9, rendered: 8, copied: 7, swapped: 0 };
        assert!(ready.may_transform(Drawing(9)));
        assert!(!Completed { rendered: 7, ..ready }.may_transform(Drawing(9)));
        assert!(!Completed { copied: 6, ..ready }.may_transform(Drawing(9)));
        assert!(!Completed { edited: 4, ..ready }.may_transform(Drawing(9)));
    }

    #[test]
    fn a_frame_buffer_is_free_when_the_previous_frame_is_shown() {
        let state = Completed { swapped: 3, ..Completed::none(2) };
        assert!(state.frame_buffer_available(Drawing(6)) && state.frame_buffer_available(Drawing(7)));
        assert!(!state.frame_buffer_available(Drawing(8)));
    }
    #[test]
    fn copy_of_the_right_eye_waits_for_copy_of_the_left_eye() {
        // Frame 3 consists of drawings 6 and 7. Frame 2 has become visible, so both frame buffers are free.
        let state = Completed { swapped: 3, copied: 6, ..Completed::none(2) };
        assert!(state.may_copy(Drawing(6)));
        assert!(state.frame_buffer_available(Drawing(7)) && !state.may_copy(Drawing(7)));
        let left_copied = Completed { copied: 7, ..state };
        assert!(left_copied.may_copy(Drawing(7)));
        assert!(!left_copied.may_copy(Drawing(8)), "frame 4 has no buffer before frame 3 has been swapped in");
    }

    #[test]
    fn a_mono_copy_waits_only_for_its_frame_buffer() {
        // Frame 2 has become visible, so it was copied.
        let state = Completed { swapped: 3, copied: 3, ..Completed::none(1) };
        assert!(state.may_copy(Drawing(3)) && !state.may_copy(Drawing(4)));
    }
}
