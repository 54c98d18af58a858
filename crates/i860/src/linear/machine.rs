//! Properties of the operations that the scheduler places: units, widths and latencies.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Adder,
    /// The multiplier. Its pipe has two stages for double-precision sources, and three stages for single-precision
    /// sources.
    Multiplier {
        double: bool,
    },
    Graphics,
    Seed,
    Load,
    Store,
    Prefetch,
    Integer,
}

impl Unit {
    /// Returns true if the unit executes its operations in the floating-point half of a pair.
    pub(super) fn is_floating(self) -> bool {
        matches!(self, Unit::Adder | Unit::Multiplier { .. } | Unit::Graphics | Unit::Seed)
    }
}

/// Register file of a value, and number of registers that the value occupies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Width {
    Integer,
    Single,
    Double,
    Quad,
}

impl Width {
    pub(super) fn registers(self) -> usize {
        match self {
            Width::Integer | Width::Single => 1,
            Width::Double => 2,
            Width::Quad => 4,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Name {
    pub(super) unit: Unit,
    pub(super) mnemonic: &'static str,
    pub(super) result: Option<Width>,
    pub(super) sources: usize,
    pub(super) addresses: bool,
    /// Number of clocks from the issue of the operation until another instruction can use the result without a freeze.
    pub(super) latency: u32,
}

const fn name(unit: Unit, mnemonic: &'static str, result: Width, sources: usize, latency: u32) -> Name {
    Name { unit, mnemonic, result: Some(result), sources, addresses: false, latency }
}

const fn load(mnemonic: &'static str, result: Width, latency: u32) -> Name {
    Name { unit: Unit::Load, mnemonic, result: Some(result), sources: 0, addresses: true, latency }
}

const fn store(mnemonic: &'static str) -> Name {
    Name { unit: Unit::Store, mnemonic, result: None, sources: 1, addresses: true, latency: 2 }
}

const ADDER: u32 = 4;
const MULTIPLIER: u32 = 4;
const MULTIPLIER_DOUBLE: u32 = 5;

/// Finds an operation by its name in a linear stretch, such as `mul.sd`.
pub(super) fn named(text: &str) -> Option<Name> {
    use Unit::{Adder, Graphics, Integer, Multiplier, Prefetch, Seed};
    use Width::{Double, Quad, Single};
    let single = Multiplier { double: false };
    Some(match text {
        "add.ss" => name(Adder, "pfadd.ss", Single, 2, ADDER),
        "add.sd" => name(Adder, "pfadd.sd", Double, 2, ADDER),
        "add.dd" => name(Adder, "pfadd.dd", Double, 2, ADDER),
        "sub.ss" => name(Adder, "pfsub.ss", Single, 2, ADDER),
        "sub.sd" => name(Adder, "pfsub.sd", Double, 2, ADDER),
        "sub.dd" => name(Adder, "pfsub.dd", Double, 2, ADDER),
        "mov.sd" => name(Adder, "pfamov.sd", Double, 1, ADDER),
        "mov.ds" => name(Adder, "pfamov.ds", Single, 1, ADDER),
        "mul.ss" => name(single, "pfmul.ss", Single, 2, MULTIPLIER),
        "mul.sd" => name(single, "pfmul.sd", Double, 2, MULTIPLIER),
        "mul.dd" => name(Multiplier { double: true }, "pfmul.dd", Double, 2, MULTIPLIER_DOUBLE),
        "rcp.ss" => name(Seed, "frcp.ss", Single, 1, 2),
        "rcp.dd" => name(Seed, "frcp.dd", Double, 1, 2),
        "isub.ss" => name(Graphics, "fisub.ss", Single, 2, 2),
        "iadd.ss" => name(Graphics, "fiadd.ss", Single, 2, 2),
        "zmin.dd" => name(Graphics, "fzchkl", Double, 2, 2),
        "ixfr" => name(Integer, "ixfr", Single, 1, 3),
        "fld.l" => load("fld.l", Single, 3),
        "fld.d" => load("fld.d", Double, 3),
        "fld.q" => load("fld.q", Quad, 3),
        "ld.l" => load("ld.l", Width::Integer, 2),
        "fst.l" => store("fst.l"),
        "fst.d" => store("fst.d"),
        "st.l" => store("st.l"),
        "prefetch" => Name { unit: Prefetch, mnemonic: "ld.l", result: None, sources: 0, addresses: true, latency: 1 },
        _ => return integer(text),
    })
}

fn integer(text: &str) -> Option<Name> {
    const NAMES: [&str; 12] =
        ["adds", "subs", "addu", "subu", "and", "andnot", "or", "xor", "shl", "shr", "shra", "orh"];
    let mnemonic = NAMES.into_iter().find(|candidate| *candidate == text)?;
    Some(name(Unit::Integer, mnemonic, Width::Integer, 2, 1))
}
