//! Tests against published clock counts of hand-written code. The code is rewritten from its descriptions. No number of
//! the model is fitted to one of the counts. All tests use the full freeze table and the default memory. Code and data
//! are in the caches.

use i860::{Config, Cpu, Ram, RunEnd, assemble};

const CODE: u32 = 0x1000;
const DATA: u32 = 0x8000;

struct Measured {
    clocks: u64,
    instructions: u64,
    cpu: Cpu,
}

/// Runs a program from its start to `end` three times. The last run, with warm caches, counts the clocks from `begin`
/// to `end`.
fn measure(source: &str, floats: &[f32]) -> Measured {
    let program = assemble("anchor.s", CODE, source).unwrap_or_else(|e| panic!("{e}"));
    let mut ram = Ram::new(0, 0x20000);
    ram.load(CODE, &program.bytes).expect("fits");
    let bits: Vec<u32> = floats.iter().map(|x| x.to_bits()).collect();
    ram.load_words(DATA, &bits).expect("fits");
    let mut cpu = Cpu::new(Config::cycle());
    let begin = program.symbol("begin").expect("begin");
    let end = program.symbol("end").expect("end");
    let mut start = (0, 0);
    for _ in 0..3 {
        cpu.state.pc = CODE;
        cpu.state.r[4] = DATA;
        assert_eq!(cpu.run(&mut ram, Some(begin), 10_000), RunEnd::Stopped);
        start = (cpu.clocks(), cpu.instructions());
        assert_eq!(cpu.run(&mut ram, Some(end), 100_000), RunEnd::Stopped);
    }
    Measured { clocks: cpu.clocks() - start.0, instructions: cpu.instructions() - start.1, cpu }
}

/// 80 MFLOPS at 40 MHz: every m12apm is a multiplication and an addition, and one m12apm is issued in every clock.
#[test]
fn single_precision_peak_is_two_operations_per_clock() {
    let body = "m12apm.ss f8, f9, f0\n".repeat(64);
    let m = measure(&format!("begin: {body}end: nop"), &[]);
    assert_eq!((64 * 2, m.clocks), (128, 64));
}

/// 60 MFLOPS at 40 MHz: an addition in every clock and a multiplication in every second clock.
#[test]
fn double_precision_peak_is_one_and_a_half_operations_per_clock() {
    let body = "m12apm.dd f8, f10, f0\npfadd.dd f12, f14, f0\n".repeat(32);
    let m = measure(&format!("begin: {body}end: nop"), &[]);
    assert_eq!((32 * 3, m.clocks), (96, 64));
    // 32 instructions are issued at clocks 0, 2, 4 ... 62, and the run ends one clock after the last issue.
    let multiply_only = measure(&format!("nop\nnop\nbegin: {}end: nop", "m12apm.dd f8, f10, f0\n".repeat(32)), &[]);
    assert_eq!(multiply_only.clocks, 63, "two operations every second clock");
}

/// The square root function of a library of the period, as described: frsqr, two Newton steps y = y(1.5 - 0.5 x y^2),
/// and a multiplication by x. The function is called in a loop.
///
/// Measured on a real chip: 1.21 us, 48.4 clocks. A test for zero is assumed, because the function needs it (the seed
/// of zero is infinite). The way in which the original loaded its constants is not known.
#[test]
fn a_scalar_square_root_with_call_and_return_takes_about_48_clocks() {
    let m = measure(ROOT, &[10.0, 0.0, 0.5, 1.5]);
    let a_call = m.clocks as f64 / 100.0;
    assert!((45.0..=50.0).contains(&a_call), "{a_call} clocks\n{}", m.cpu.profile());
    let root = f32::from_bits(m.cpu.state.f[8]);
    assert!((root - 10.0f32.sqrt()).abs() < 1e-6, "{root}");
}

const ROOT: &str = "
constants = 0x8008
         adds    -1, r0, r6
         mov     99, r7
         bla     r6, r7, begin
         nop
         .align  8
begin:   call    sqrt
         fld.l   0(r4), f8
         bla     r6, r7, begin
         fst.l   f8, 4(r4)
end:     nop
sqrt:    pfeq.ss f8, f0, f0
         bc      zero
         orh     ha%constants, r0, r31
         fld.d   l%constants(r31), f20       // 0.5, 1.5
         frsqr.ss f8, f9
         fmul.ss f9, f9, f11                 // y^2
         fmul.ss f8, f11, f11
         fmul.ss f20, f11, f11
         fsub.ss f21, f11, f11
         fmul.ss f9, f11, f9
         fmul.ss f9, f9, f11                 // y^2
         fmul.ss f8, f11, f11
         fmul.ss f20, f11, f11
         fsub.ss f21, f11, f11
         fmul.ss f9, f11, f9
         fmul.ss f8, f9, f8
zero:    bri     r1
         nop
";

/// Three reciprocal square roots through the pipes, two Newton steps each: "39 clocks" in code of the period.
///
/// This project made the schedule from the formula y(1.5 - 0.5 x y^2). The schedule has thirteen groups of three
/// instructions: one seed group and six groups for each step. The groups of a step compute y^2, times x, times 0.5, 1.5
/// minus the product, and times y. In the last group, y leaves the pipe. The code has 39 instructions, and the test
/// checks that none of them waits.
#[test]
fn three_reciprocal_square_roots_at_once_take_39_clocks() {
    let m = measure(THREE_ROOTS, &[2.0, 10.0, 0.3]);
    assert_eq!((m.instructions, m.clocks), (39, 39), "{}", m.cpu.profile());
    for (n, x) in [2.0f32, 10.0, 0.3].into_iter().enumerate() {
        let y = f32::from_bits(m.cpu.state.f[12 + n]);
        assert!((y * x.sqrt() - 1.0).abs() < 1e-6, "{x}: {y}");
    }
}

fn singles(n: usize) -> String {
    "pfmul.ss f9, f10, f11\n".repeat(n)
}

/// A loop with the shape of a tree code of the period must take 106 clocks per turn. The original has 117 instructions,
/// but cannot be rewritten from its description. Only its shape is known: 11 pairs, 95 single instructions, a taken
/// bnc.t, a label at 4 mod 8, and no freeze.
#[test]
fn a_loop_like_the_published_tree_code_takes_106_clocks_an_iteration() {
    // The entry word has two single instructions. Then 11 pairs follow, and the D bit of the last two pairs is clear.
    let pairs =
        "d.m12apm.ss f9, f10, f11\nadds 1, r6, r6\n".repeat(9) + &"m12apm.ss f9, f10, f11\nadds 1, r6, r6\n".repeat(2);
    let turn =
        format!("{}d.fnop\nnop\n{pairs}{}subs r7, r6, r0\n{}bnc.t turn\nnop\n", singles(51), singles(35), singles(4));
    let source = format!("begin: mov 0, r6\nmov 54, r7\nnop\n.align 8\nnop\nturn: {turn}end: nop\nnop");
    let m = measure(&source, &[]);
    assert_eq!(m.cpu.state.r[6], 55, "five turns of eleven pairs");
    // Five instructions come before the loop. The last bnc.t is not taken, which takes one clock more and skips the
    // delay slot.
    assert_eq!((m.instructions, m.clocks), (117 * 5 + 5 - 1, 106 * 5 + 5));
}

const THREE_ROOTS: &str = "
         .macro  newton
         pfmul.ss f12, f12, f0             // y^2
         pfmul.ss f13, f13, f0
         pfmul.ss f14, f14, f0
         pfmul.ss f8, f16, f16             // x y^2, as y^2 leaves
         pfmul.ss f9, f17, f17
         pfmul.ss f10, f18, f18
         pfmul.ss f20, f16, f16            // half of it
         pfmul.ss f20, f17, f17
         pfmul.ss f20, f18, f18
         r2s1.ss f21, f0, f0               // 1.5 less that
         r2s1.ss f21, f0, f0
         r2s1.ss f21, f0, f0
         m12apm.ss f12, f16, f16           // times y, as it leaves the adder
         m12apm.ss f13, f17, f17
         m12apm.ss f14, f18, f18
         pfmul.ss f0, f0, f12
         pfmul.ss f0, f0, f13
         pfmul.ss f0, f0, f14
         .endm
         fld.l   0(r4), f8
         fld.l   4(r4), f9
         fld.l   8(r4), f10
         mov     0x3F000000, r16
         mov     0x3FC00000, r17
         ixfr    r16, f20
         ixfr    r17, f21
         nop
         nop
begin:   frsqr.ss f8, f12
         frsqr.ss f9, f13
         frsqr.ss f10, f14
         newton
         newton
end:     nop
";
