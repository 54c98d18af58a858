//! The rules of TR94 for the beginning of each stage. Each rule is a function of the progress of all stages, and
//! returns true if the stage may begin.

use pxpl5_wire::PictureNumber;

/// Number of a *drawing*: the picture of one eye in a stereo frame, the whole picture of a mono frame, or an update of a
/// display memory.
///
/// Drawings are numbered in order through all frames. Number 0 is the left eye of frame 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Drawing(pub u64);

impl Drawing {
    /// Returns the number of the first drawing of a frame. `eyes` is the number of eyes of each frame.
    #[must_use]
    pub const fn first_of(frame: PictureNumber, eyes: u64) -> Self {
        Self(frame.0 * eyes)
    }

    /// Returns the frame to which this drawing belongs. `eyes` is the number of eyes of each frame.
    #[must_use]
    pub const fn picture(self, eyes: u64) -> PictureNumber {
        PictureNumber(self.0 / eyes)
    }

    /// Returns the index of the eye, 0 or 1, for which this drawing is made. `eyes` is the number of eyes of each
    /// frame.
    #[must_use]
    pub const fn eye(self, eyes: u64) -> u64 {
        self.0 % eyes
    }

    /// Returns the index, 0 or 1, of the set of bins that every slave uses for this drawing.
    pub(crate) const fn context(self) -> usize {
        (self.0 % 2) as usize
    }

    /// Returns the number of the drawing that comes `count` drawings after this drawing.
    #[must_use]
    pub const fn after(self, count: u64) -> Self {
        Self(self.0 + count)
    }
}

/// Progress of the pipeline: for each stage, the number of drawings or frames that have passed the stage.
///
/// A drawing is the picture of one eye, or the whole picture of a mono frame. Every stage processes drawings in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Completed {
    /// Number of eyes of a frame: 1 or 2.
    pub eyes: u64,
    /// Number of frames sent by the host.
    pub sent: u64,
    /// Number of frames whose edits all slaves have applied.
    pub edited: u64,
    /// Number of drawings that all slaves have transformed.
    pub transformed: u64,
    /// Number of drawings whose last commands were accepted.
    pub rendered: u64,
    /// Number of drawings that are complete in a frame buffer.
    pub copied: u64,
    /// Number of frames that a swap of the frame buffers has made visible.
    pub swapped: u64,
}

impl Completed {
    /// Returns the progress at power-on. No frame or drawing has passed any stage.
    #[must_use]
    pub const fn none(eyes: u64) -> Self {
        Self { eyes, sent: 0, edited: 0, transformed: 0, rendered: 0, copied: 0, swapped: 0 }
    }

    /// Returns true if EDIT of a frame may begin.
    ///
    /// Let n be the number of the frame's first drawing. A drawing is the picture of one eye, or of a mono frame. Four
    /// stages must be complete: SEND of the frame, TRANSFORM of drawing n - 1, RENDER of drawing n - 2, and COPY of
    /// drawing n - 3.
    ///
    /// If RENDER or COPY were not complete, the earlier drawings would still use the buffers.
    #[must_use]
    pub const fn may_edit(&self, frame: PictureNumber) -> bool {
        let first = Drawing::first_of(frame, self.eyes);
        self.sent > frame.0 && self.transformed >= first.0 && self.buffers_free(first)
    }

    /// Returns true if TRANSFORM of drawing number n (the picture of one eye) may begin.
    ///
    /// All slaves must have finished EDIT of the drawing's frame. (TR94 requires only that this EDIT has begun.) RENDER
    /// of drawing n - 2 and COPY of drawing n - 3 must be complete. These conditions are only for the later eyes of a
    /// frame. Each slave begins TRANSFORM of the first eye when its own edits are done.
    #[must_use]
    pub const fn may_transform(&self, drawing: Drawing) -> bool {
        self.edited > drawing.picture(self.eyes).0 && self.buffers_free(drawing)
    }

    /// Returns true if the slaves have a free set of bins for a drawing, and the renderers have a free part of pixel
    /// memory. Each slave has two sets of bins, and each renderer has two parts.
    const fn buffers_free(&self, drawing: Drawing) -> bool {
        self.rendered + 1 >= drawing.0 && self.copied + 2 >= drawing.0
    }

    /// Returns true if RENDER of a drawing (the picture of one eye) may begin. All slaves must have finished TRANSFORM
    /// of this drawing, and RENDER of the previous drawing must be complete.
    #[must_use]
    pub const fn may_render(&self, drawing: Drawing) -> bool {
        self.transformed > drawing.0 && self.rendered >= drawing.0
    }

    /// Returns true if the hidden buffer for a drawing is free. The buffer is free when the previous frame has become
    /// visible.
    #[must_use]
    pub const fn frame_buffer_available(&self, drawing: Drawing) -> bool {
        self.swapped >= drawing.picture(self.eyes).0
    }

    /// Returns true if COPY of a drawing (the picture of one eye) may begin. The hidden buffer must be free, and COPY
    /// of the previous drawing must be complete.
    ///
    /// Each frame buffer has its own ring port. Nevertheless, the rule of TR94 permits copies to only one frame buffer
    /// at a time, one eye after the other.
    #[must_use]
    pub const fn may_copy(&self, drawing: Drawing) -> bool {
        self.frame_buffer_available(drawing) && self.copied >= drawing.0
    }

    /// Returns true if a swap may make a frame visible. COPY of all eyes of the frame must be complete.
    #[must_use]
    pub const fn may_swap(&self, frame: PictureNumber) -> bool {
        self.copied >= Drawing::first_of(frame.next(), self.eyes).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mono_edit_waits_for_send_transform_render_and_copy_of_the_frames_before() {
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
    fn a_frame_buffer_is_free_again_when_the_frame_before_is_shown() {
        let state = Completed { swapped: 3, ..Completed::none(2) };
        assert!(state.frame_buffer_available(Drawing(6)) && state.frame_buffer_available(Drawing(7)));
        assert!(!state.frame_buffer_available(Drawing(8)));
    }
    #[test]
    fn copy_of_the_right_eye_waits_for_copy_of_the_left() {
        // Frame 3 consists of drawings 6 and 7. Frame 2 has become visible, so both frame buffers are free.
        let state = Completed { swapped: 3, copied: 6, ..Completed::none(2) };
        assert!(state.may_copy(Drawing(6)));
        assert!(state.frame_buffer_available(Drawing(7)) && !state.may_copy(Drawing(7)));
        let left_copied = Completed { copied: 7, ..state };
        assert!(left_copied.may_copy(Drawing(7)));
        assert!(!left_copied.may_copy(Drawing(8)), "frame 4 has no buffer before frame 3 has been swapped in");
    }

    #[test]
    fn a_mono_copy_waits_for_nothing_but_its_frame_buffer() {
        // Frame 2 has become visible, so it was copied.
        let state = Completed { swapped: 3, copied: 3, ..Completed::none(1) };
        assert!(state.may_copy(Drawing(3)) && !state.may_copy(Drawing(4)));
    }
}
