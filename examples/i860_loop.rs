//! Runs a loop on the graphics processor's i860: assembles, runs and steps the code, and prints a profile of the
//! clocks. The Python version is i860_loop.py.
//!
//! `cargo run --release --example i860_loop`

use i860::{AddressProfile, Config, Cpu, Ram, assemble, disassemble};
use std::error::Error;

const SOURCE: &str = "
// Sum of the squares of 1 to 10.
start:  mov     10, r5
        mov     0, r6
loop:   ixfr    r5, f8
        fmlow.dd f8, f8, f10
        fxfr    f10, r7
        adds    r7, r6, r6
        adds    -1, r5, r5
        btne    r0, r5, loop
        mov     result, r8
        st.l    r6, 0(r8)
end:    nop
result: .long   0
";

/// Memory of a graphics processor's board, in bytes.
const MEMORY: usize = 8 << 20;

fn main() -> Result<(), Box<dyn Error>> {
    let program = assemble("source.s", 0x1000, SOURCE)?;
    let words = program.words();
    for (address, word) in (program.base..).step_by(4).zip(&words) {
        println!("{address:08x}  {word:08x}  {}", disassemble(*word, address));
    }

    let place = |label: &str| program.symbol(label).ok_or_else(|| format!("there is no label `{label}`"));
    let mut memory = Ram::new(0, MEMORY);
    memory.load(program.base, &program.bytes)?;
    let mut cpu = Cpu::at(Config::cycle(), place("start")?);
    cpu.watch(Some(AddressProfile::new(program.base, words.len())));
    for _ in 0..3 {
        cpu.step(&mut memory)?;
        println!("step to {:#x}", cpu.state.pc);
    }
    let end = cpu.run(&mut memory, Some(place("end")?), 10_000_000);
    println!("{end:?} after {} clocks and {} instructions", cpu.clocks(), cpu.instructions());
    let result = memory.words(place("result")?, 1)?[0];
    println!("result {result}");
    let labels: Vec<(&str, u32)> = program.labels.iter().map(|(name, at)| (name.as_str(), *at)).collect();
    for (label, clocks) in cpu.watched().map(|watched| watched.by_label(&labels)).unwrap_or_default() {
        println!("{clocks:6} clocks at {label}");
    }
    assert_eq!(result, (1..=10).map(|n| n * n).sum::<u32>());
    Ok(())
}
