//! Host time per simulated instruction: with memoized clocks, with all clocks counted, and without timing. The loops
//! hit the caches. `kernels.rs` has the triangle kernels, which miss the caches.

#![allow(missing_docs, reason = "criterion_group makes an undocumented function")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use i860::{Config, Cpu, Ram, RunEnd, assemble};
use std::hint::black_box;

const INSTRUCTIONS: u64 = 1_000_000;

/// Integer work with loads, stores and a branch.
const INTEGER: &str = "
        mov     0x8000, r4
        mov     1, r5
loop:   ld.l    0(r4), r6
        adds    r5, r7, r7
        xor     r7, r8, r8
        shl     3, r8, r9
        st.l    r9, 4(r4)
        adds    r6, r9, r9
        and     255, r9, r10
        br      loop
        shr     1, r10, r10
";

/// A transform of points: pipelined multiply-add with loads and stores.
const FLOATING: &str = "
        mov     0x8000, r4
loop:   fld.d   0(r4), f8
        m12apm.ss f16, f8, f0
        m12apm.ss f17, f9, f0
        m12apm.ss f18, f8, f20
        pfadd.ss f20, f21, f22
        fst.d   f22, 8(r4)
        r2p1.ss f8, f9, f10
        pfmul.ss f10, f9, f11
        br      loop
        fmul.ss f8, f9, f12
";

/// The transform of points in dual-instruction mode.
const DUAL: &str = "
        mov     0x8000, r4
        nop
        .align  8
loop:   d.m12apm.ss f16, f8, f0
        fld.d   0(r4), f8
        d.m12apm.ss f17, f9, f0
        adds    1, r5, r5
        d.m12apm.ss f18, f8, f20
        st.l    r5, 8(r4)
        d.pfadd.ss f20, f21, f22
        br      loop
        d.m12apm.ss f16, f8, f23
        nop
";

fn prepare(source: &str, config: Config) -> (Cpu, Ram) {
    let program = assemble("bench.s", 0x1000, source).expect("correct");
    let mut ram = Ram::new(0, 8 << 20);
    ram.load(0x1000, &program.bytes).expect("fits");
    (Cpu::at(config, 0x1000), ram)
}

fn modes() -> [(&'static str, Config); 3] {
    let counted = Config { memoise: false, ..Config::cycle() };
    [("memoised", Config::cycle()), ("counted", counted), ("functional", Config::functional())]
}

fn speed(c: &mut Criterion) {
    let mut group = c.benchmark_group("instructions");
    group.throughput(Throughput::Elements(INSTRUCTIONS)).sample_size(20);
    for (name, source) in [("integer", INTEGER), ("floating", FLOATING), ("dual", DUAL)] {
        for (mode, config) in modes() {
            let (mut cpu, mut ram) = prepare(source, config);
            group.bench_function(format!("{name}/{mode}"), |b| {
                b.iter(|| {
                    let outcome = cpu.run(&mut ram, None, INSTRUCTIONS);
                    assert_eq!(outcome, RunEnd::Exhausted);
                    black_box(cpu.clocks())
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, speed);
criterion_main!(benches);
