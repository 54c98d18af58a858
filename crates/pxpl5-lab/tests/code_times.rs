//! The timing table's constants that follow from code, held to the code.

use pxpl5_gp::{CodeVersion, GpTiming};
use pxpl5_lab::code_times::{CodeTimes, CodeUse, code_times};

fn table(times: CodeTimes) -> [u64; 7] {
    let CodeTimes { triangle_ns, sphere_ns, guard_ns, entry_ns, pass_ns, edit_ns, message_ns, .. } = times;
    [triangle_ns, sphere_ns, guard_ns, entry_ns, pass_ns, edit_ns, message_ns].map(|ns| ns.round() as u64)
}

/// The constants change when the code or the i860 changes; the message says what they become.
#[test]
fn the_table_of_the_code_is_what_the_code_takes() {
    let papers = GpTiming::PAPERS;
    let uses = [
        (CodeVersion::Scheduled, CodeUse::Pphigs, papers.of_scheduled_phong()),
        (CodeVersion::Compiled, CodeUse::Slats, papers.of_compiled_gouraud()),
        (CodeVersion::Scheduled, CodeUse::Slats, papers.of_scheduled_gouraud()),
    ];
    let measured = uses.map(|(version, of, _)| code_times(version, of).expect("the scenes are built in"));
    let expected = measured.map(table);
    let found = uses.map(|(_, _, gp)| {
        [gp.triangle_ns, gp.sphere_ns, gp.guard_ns, gp.bin_entry_ns, gp.pass_ns, gp.edit_ns, gp.message_ns]
    });
    assert_eq!(found, expected, "{measured:#?}");
}
