//! Tests of the regions that each renderer draws and copies.

use pxpl5_wire::Eye;
use slats::{Binding, CopySchedule};

#[test]
fn each_of_five_renderers_keeps_the_top_and_bottom_regions_of_both_eyes() {
    let binding = Binding::new(5, 4, CopySchedule::Whole).expect("five are enough");
    for renderer in 0..5 {
        let copies = binding.copies(renderer, true);
        let kinds: Vec<_> = copies.iter().map(|b| (b.eye, b.is_top())).collect();
        assert_eq!(kinds, [(Eye::Left, true), (Eye::Right, true), (Eye::Left, false), (Eye::Right, false)]);
    }
}

#[test]
fn a_split_copy_begins_on_both_frame_buffers() {
    let binding = Binding::new(5, 4, CopySchedule::Split).expect("five are enough");
    let first: Vec<_> = (0..5).map(|renderer| binding.copies(renderer, false)[0].eye).collect();
    assert_eq!(first, [Eye::Left, Eye::Right, Eye::Left, Eye::Right, Eye::Left]);
    assert!((0..5).all(|renderer| binding.copies(renderer, false).iter().all(|b| !b.is_top())));
}

#[test]
fn every_region_is_bound_and_copied_once_on_any_number_of_renderers() {
    for renderers in 5..=20 {
        for copy in [CopySchedule::Whole, CopySchedule::Split, CopySchedule::Backup] {
            let binding = Binding::new(renderers, 4, copy).expect("enough");
            let halves = if copy.is_split() { vec![true, false] } else { vec![true] };
            let mut copied: Vec<_> = halves
                .into_iter()
                .flat_map(|top| (0..renderers).map(move |renderer| (renderer, top)))
                .flat_map(|(r, top)| binding.copies(r, top))
                .map(|b| (b.eye, b.region))
                .collect();
            copied.sort_unstable();
            copied.dedup();
            assert_eq!(copied.len(), 20);
            assert_eq!((binding.regions().len(), binding.renderers()), (20, renderers));
            assert!(binding.regions().iter().all(|b| b.context < 4));
        }
    }
}

#[test]
fn four_renderers_are_too_few() {
    let error = Binding::new(4, 4, CopySchedule::Whole).expect_err("16 contexts for 20 regions");
    assert!(error.to_string().contains("at least 5 renderers"));
}
