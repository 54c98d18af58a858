//! Tests of the scheduler: the schedule does not change the results, and the scheduled code has no freezes.

use i860::linear::{schedule, slots};
use i860::timing::{FREEZES, Freeze};
use i860::{Config, Cpu, Profile, Ram, RunEnd, assemble};

const CODE: u32 = 0x1000;
const DATA: u32 = 0x8000;

/// Runs a stretch twice with data at address r4, so that the second run hits the caches. Returns the memory at DATA and
/// the profile of the second run.
fn run(settings: &str, body: &str, data: &[u32]) -> (Vec<u32>, Profile) {
    let source = format!(
        ".pool r8 r9 r10\nmov 2, r20\n.align 8\nagain: d.fnop\nnop\n.linear {settings}\n{body}\n.endlinear\n\
         fnop\nnop\nfnop\nnop\nfirst: adds -1, r20, r20\nbtne r0, r20, again\nend:"
    );
    let source = schedule(&source).unwrap_or_else(|e| panic!("{e}"));
    let program = assemble("linear.s", CODE, &source).unwrap_or_else(|e| panic!("{e}\n{source}"));
    let mut ram = Ram::new(0, 0x20000);
    ram.load(CODE, &program.bytes).expect("fits");
    ram.load_words(DATA, data).expect("fits");
    let mut cpu = Cpu::at(Config::cycle(), CODE);
    cpu.state.r[4] = DATA;
    assert_eq!(cpu.run(&mut ram, program.symbol("first"), 10_000), RunEnd::Stopped);
    cpu.clear_profile();
    assert_eq!(cpu.run(&mut ram, program.symbol("end"), 10_000), RunEnd::Stopped);
    (ram.words(DATA, 32).expect("inside"), cpu.profile())
}

/// Operations for three sets of data: sums of products in both precisions, such as (a b + c), a reciprocal by a Newton
/// step, minima, and integer operations.
const BODY: &str = "
    for i 0 1 2
a$i = fld.l 16*$i(r4)
b$i = fld.l 16*$i+4(r4)
c$i = fld.l 16*$i+8(r4)
m$i = mul.ss a$i, b$i
s$i = add.ss m$i, c$i
d$i = mul.sd a$i, c$i
e$i = mov.sd b$i
f$i = mul.dd d$i, e$i
g$i = add.dd f$i, e$i
    fst.l s$i, 64+4*$i(r4)
    fst.d g$i, 80+8*$i(r4)
    endfor
two = mov.ds e0
r   = rcp.ss a1
t   = mul.ss a1, r
u   = sub.ss a2, t
    fst.l u, 104(r4)
    fst.l two, 108(r4)
i   = ld.l 0(r4)
j   = shr 4, i
k   = adds 17, j
l   = xor k, i
@l  st.l l, 112(r4)
n   = ld.l 112(r4) !l
o   = subs r0, n
    st.l o, 116(r4)
";

fn data() -> Vec<u32> {
    [1.5f32, -2.25, 1e3, 0.0, 3.0, 7.0, -0.125, 0.0, 1.0, 0.3, 2.5, 0.0].iter().map(|v| v.to_bits()).collect()
}

#[test]
fn scheduled_code_computes_the_same_as_its_statements() {
    let (found, _) = run("", BODY, &data());
    let v = |at: usize| f32::from_bits(data()[at]);
    for i in 0..3 {
        let [a, b, c] = [v(4 * i), v(4 * i + 1), v(4 * i + 2)];
        assert_eq!(f32::from_bits(found[16 + i]), a * b + c);
        let double = u64::from(found[21 + 2 * i]) << 32 | u64::from(found[20 + 2 * i]);
        let [a, b, c] = [a, b, c].map(f64::from);
        assert_eq!(f64::from_bits(double), a * c * b + b);
    }
    // The seed of 1 / 3 with 8 bits of fraction is 0x3EAA8000.
    assert_eq!(f32::from_bits(found[26]), v(8) - v(4) * f32::from_bits(0x3EAA_8000));
    let l = ((data()[0] >> 4) + 17) ^ data()[0];
    assert_eq!((found[28], found[29]), (l, l.wrapping_neg()));
}

#[test]
fn every_schedule_computes_the_same_results() {
    let (expected, _) = run("", BODY, &data());
    for window in [1, 2, 5, 20, 100] {
        for eagerness in [0, 5, 1000] {
            for shake in 0..4 {
                let settings = format!("{window} {eagerness} 1 5 {shake}");
                assert_eq!(run(&settings, BODY, &data()).0, expected, "{settings}");
            }
        }
    }
}

#[test]
fn inside_a_scheduled_stretch_of_code_no_instruction_waits() {
    let (_, profile) = run("", BODY, &data());
    // The branch back and the code after the branch are outside the stretch, and enter the cache only in the second
    // run.
    let inside = FREEZES.iter().filter(|row| !matches!(row.id, Freeze::CompareBranchTaken | Freeze::InstructionMiss));
    let waits: Vec<_> = inside.filter(|row| profile.frozen_by(row.id) > 0).map(|row| row.number).collect();
    assert_eq!(waits, Vec::<&str>::new(), "{profile}");
}

#[test]
fn errors_name_their_line() {
    let fault = |body: &str| schedule(&format!(".pool r8\n.linear\n{body}\n.endlinear")).map_err(|e| e.to_string());
    for (body, expected) in [
        ("x = frob.ss f0, f0", "line 3: `frob.ss` is not an operation"),
        ("x = add.ss y, f0", "line 3: `y` has no value yet"),
        ("x = add.ss f0", "line 3: expected 2 sources, found 1"),
        ("add.ss f0, f0", "line 3: `add.ss`: a result is named exactly where there is one"),
        ("for i 0 1\nx$i = add.ss f0, f0", "line 3: `for` without `endfor`"),
        ("a = ld.l 0(r4)\na = ld.l 4(r4)", "line 4: `a` is named twice"),
        ("a = ld.l 0(r4) !b", "line 3: no store is marked `b`"),
    ] {
        assert_eq!(fault(body), Err(expected.to_owned()), "{body}");
    }
    let crowd: String = (0..4).map(|n| format!("v{n} = ld.l {n}(r4)\n")).collect();
    let uses = "s = adds v0, v1\nt = adds v2, v3\nu = adds s, t\nst.l u, 0(r4)";
    assert!(fault(&format!("{crowd}{uses}")).unwrap_err().contains("do not fit the registers"));
}

/// The stretch has two additions, a product of doubles that takes two slots, and four accesses to memory.
#[test]
fn no_schedule_is_shorter_than_the_slots_of_its_busiest_unit() {
    let source = "        .linear\n\
        a = fld.d 0(r16)\n\
        b = fld.d 8(r16)\n\
        c = add.dd a, b\n\
        d = mul.dd a, c\n\
        e = sub.dd d, b\n\
        fst.d e, 16(r16)\n\
        prefetch 32(r16)\n\
        .endlinear\n";
    let [found] = slots(source).expect("it is a stretch").try_into().expect("one");
    assert_eq!((found.floating, found.core), (4, 4));
    assert!(found.pairs >= found.floating.max(found.core), "{found:?}");
}
