//! Tests that the timing table's constants equal the times of the executed code.

#[allow(dead_code, unused_imports, reason = "the example gp_timing uses the rest")]
#[path = "../../../examples/code_times/mod.rs"]
mod measured;

use measured::{CodeTimes, code_times};
use pxpl5_gp::{CodeUse, CodeVersion, GpTiming};
use rayon::prelude::*;

fn table(times: CodeTimes) -> Vec<u64> {
    let CodeTimes { triangle_ns, sphere_ns, guard_ns, entry_ns, edit_ns, message_ns, .. } = times;
    let CodeTimes { pass_ns, structure_ns, sphere_view_ns, token_entry_ns, .. } = times;
    let of_primitives = [triangle_ns, sphere_ns, guard_ns, entry_ns];
    let of_passes = [pass_ns, structure_ns, sphere_view_ns, edit_ns, message_ns, token_entry_ns];
    let all = of_primitives.into_iter().chain(of_passes);
    all.map(|ns| ns.round() as u64).collect()
}

/// Tests the constants of the timing table, which change with the code and the i860 model. The failure message states
/// the new values.
#[test]
fn the_table_of_code_times_equals_the_simulated_code() {
    let papers = GpTiming::PAPERS;
    let uses = [
        (CodeVersion::Scheduled, CodeUse::Pphigs, papers.of_scheduled_phong()),
        (CodeVersion::Compiled, CodeUse::Slats, papers.of_compiled_precomputed()),
        (CodeVersion::Scheduled, CodeUse::Slats, papers.of_scheduled_precomputed()),
        (CodeVersion::Compiled, CodeUse::SlatsTouched, papers.of_compiled_touched()),
        (CodeVersion::Scheduled, CodeUse::SlatsTouched, papers.of_scheduled_touched()),
        (CodeVersion::Compiled, CodeUse::SlatsLit, papers.of_compiled_gouraud()),
        (CodeVersion::Scheduled, CodeUse::SlatsLit, papers.of_scheduled_gouraud()),
    ];
    uses.into_par_iter().for_each(|(version, of, gp)| {
        let measured = code_times(version, of).expect("the scenes are built in");
        let found = vec![
            gp.triangle_ns,
            gp.sphere_ns,
            gp.guard_ns,
            gp.bin_entry_ns,
            gp.pass_ns,
            gp.structure_ns,
            gp.sphere_view_ns,
            gp.edit_ns,
            gp.message_ns,
            gp.token_entry_ns,
        ];
        assert_eq!(found, table(measured), "{measured:#?}");
    });
}
