//! Rules that decide when a stage of an update may begin: the rules of TR94 for mono frames, applied to updates.

use pxpl5_wire::PictureNumber;

/// Number of updates that have passed each stage. Every stage processes updates in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Completed {
    pub(crate) sent: u64,
    /// Number of updates that all slaves have transformed.
    pub(crate) transformed: u64,
    /// Number of updates whose last commands were accepted.
    pub(crate) rendered: u64,
    /// Number of updates that are complete: all regions of the update and of all earlier updates have arrived.
    pub(crate) copied: u64,
}

impl Completed {
    /// Returns true if EDIT of update number n may begin.
    ///
    /// Four stages must be complete: SEND of update n, TRANSFORM of update n - 1, RENDER of update n - 2, and COPY of
    /// update n - 3. The condition for RENDER follows from the two sets of bins of each slave.
    pub(crate) const fn may_edit(&self, update: PictureNumber) -> bool {
        let n = update.0;
        self.sent > n && self.transformed >= n && self.rendered + 1 >= n && self.copied + 2 >= n
    }

    /// Returns true if RENDER of an update may begin. All slaves must have finished TRANSFORM of this update, and
    /// RENDER of the previous update must be complete.
    pub(crate) const fn may_render(&self, update: PictureNumber) -> bool {
        self.transformed > update.0 && self.rendered >= update.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_waits_for_send_transform_render_and_copy_of_the_updates_before() {
        let ready = Completed { sent: 6, transformed: 5, rendered: 4, copied: 3 };
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
}
