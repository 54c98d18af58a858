//! When a stage of an update may begin: Rendering Control's rules for mono frames (TR94), with updates for frames.

use pxpl5_wire::PictureNumber;

/// How many updates have passed each stage. All stages work in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Completed {
    pub(crate) sent: u64,
    /// Updates that all slaves have transformed.
    pub(crate) transformed: u64,
    /// Updates whose last commands were accepted.
    pub(crate) rendered: u64,
    /// Updates of which, and of all before, every region has arrived.
    pub(crate) copied: u64,
}

impl Completed {
    /// EDIT of an update needs SEND of it, TRANSFORM of the one before, RENDER of the 2nd before (two bin contexts) and COPY of
    /// the 3rd before.
    pub(crate) const fn may_edit(&self, update: PictureNumber) -> bool {
        let n = update.0;
        self.sent > n && self.transformed >= n && self.rendered + 1 >= n && self.copied + 2 >= n
    }

    /// RENDER of an update needs its TRANSFORM by all slaves, and RENDER of the one before.
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
