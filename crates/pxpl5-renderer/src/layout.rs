//! Layouts: the division of the 208 bits of pixel memory into bit fields.

use crate::isa::{MEMORY_BITS, Operand};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::format::{COLOUR_BITS, NORMAL_BITS, Z_BITS, Z_FRACTION_BITS};
use std::fmt::Write as _;
use std::ops::RangeInclusive;

/// An unchecked division of pixel memory into bit fields. [`Layout::new`] checks it.
///
/// Addresses in a context count from its first bit: context `i` begins at bit `i * context_bits` of pixel memory. The
/// address of the scratch memory is absolute. All contexts share it, because no command reads what an earlier one has
/// left there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContextPlan {
    /// Name of the layout in error messages.
    pub name: &'static str,
    /// Number of contexts. Each context is the part of pixel memory that holds one region.
    pub contexts: u8,
    /// Number of bits of pixel memory that each context has.
    pub context_bits: u8,
    /// Bit field of the colour in each context: 24 bits, 0xRRGGBB.
    pub colour: Operand,
    /// Bit field of the depth in each context, 8 to 24 bits. A smaller depth is nearer.
    pub z: Operand,
    /// Bit field of the normal in each context: x, y and z, with 12 bits each, two's complement. `None` if the layout
    /// does not support Phong shading.
    pub normal: Option<Operand>,
    /// Bit field for temporary values of sphere and shading commands.
    pub scratch: Option<Operand>,
}

/// A checked division of pixel memory into bit fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout(ContextPlan);

const RENDERING_CONTROL_PHONG: ContextPlan = ContextPlan {
    name: "rendering control, Phong",
    contexts: 1,
    context_bits: 84,
    colour: Operand::context(0, 24),
    z: Operand::context(24, 24),
    normal: Some(Operand::context(48, 36)),
    scratch: Some(Operand::absolute(84, 124)),
};

const SLATS: ContextPlan = ContextPlan {
    name: "Slats",
    contexts: 4,
    context_bits: 44,
    colour: Operand::context(0, 24),
    z: Operand::context(24, 20),
    normal: None,
    scratch: Some(Operand::absolute(176, 32)),
};

const SLATS_QUARTERS: ContextPlan = ContextPlan {
    name: "Slats in quarters",
    contexts: 4,
    context_bits: 52,
    colour: Operand::context(0, 24),
    z: Operand::context(24, 24),
    normal: None,
    scratch: None,
};

impl Layout {
    /// Returns the layout of Rendering Control with Phong shading, which has one region.
    ///
    /// The 208 bits are 24 bits of colour, 24 bits of Z, 36 bits of normal and 124 bits of scratch memory.
    pub const fn rendering_control_phong() -> Self {
        Self(RENDERING_CONTROL_PHONG)
    }

    /// Returns the layout of Slats: four regions, each with 24 bits of colour and 20 bits of Z. All regions share 32
    /// bits of scratch memory.
    ///
    /// TR94 publishes four contexts (regions) in 208 bits, but four equal parts of 52 bits leave no room for the
    /// scratch memory that a sphere needs (30 bits). It is needed only while a command runs, so all contexts can share
    /// it. To make room for it, Z has 4 bits less (assumed).
    pub const fn slats() -> Self {
        Self(SLATS)
    }

    /// Returns the layout of Slats with four equal parts of 52 bits: 24 bits of colour, 24 bits of Z and 4 unused bits.
    /// The layout supports triangles, but no spheres.
    pub const fn slats_quarters() -> Self {
        Self(SLATS_QUARTERS)
    }

    /// Checks the bit fields of `plan`, and creates the layout.
    ///
    /// # Errors
    /// Returns a [`SettingError`] if a bit field has a wrong width, or if bit fields overlap or extend beyond pixel
    /// memory. In the latter case, the error text contains a drawing of the bit ranges.
    pub fn new(plan: ContextPlan) -> Result<Self, SettingError> {
        check_widths(&plan)?;
        let ranges = ranges(&plan);
        let bad = conflicts(&plan, &ranges);
        if bad.iter().all(Option::is_none) {
            return Ok(Self(plan));
        }
        Err(SettingError::combination(format_args!(
            "layout {} does not fit {MEMORY_BITS} bits:\n{}",
            plan.name,
            draw(&ranges, &bad)
        )))
    }

    /// Returns the bit fields as a plan, from which a caller can make a similar layout.
    pub const fn plan(&self) -> &ContextPlan {
        &self.0
    }

    /// Returns the address of the first bit of context `context` in pixel memory.
    pub const fn context_base(&self, context: u8) -> u8 {
        context.wrapping_mul(self.0.context_bits)
    }

    /// Returns the bits of pixel memory for colour component `index`: 0 (red), 1 (green) or 2 (blue).
    pub const fn component(&self, index: u8) -> Operand {
        self.0.colour.part((2 - index) * COLOUR_BITS as u8, COLOUR_BITS as u8)
    }

    /// Returns the number of low bits of a depth expression that pixel memory does not hold.
    pub const fn z_shift(&self) -> u8 {
        (Z_FRACTION_BITS + Z_BITS) as u8 - self.0.z.width
    }

    /// Returns the bits of pixel memory for component `index` of the normal: 0 (x), 1 (y) or 2 (z). Returns `None` if
    /// the layout has no normals.
    pub fn normal(&self, index: u8) -> Option<Operand> {
        let all = self.0.normal?;
        Some(all.part(index * NORMAL_BITS as u8, NORMAL_BITS as u8).signed())
    }

    /// Returns the number of bits of a sphere's square root: 12, or 10 if the scratch memory has only 30 to 35 bits.
    /// Returns `None` if the scratch memory is smaller.
    pub fn root_bits(&self) -> Option<u8> {
        match self.0.scratch?.width {
            36.. => Some(12),
            30..36 => Some(10),
            _ => None,
        }
    }

    /// Returns the bit ranges of all bit fields, in the order of the bit fields in [`ContextPlan`].
    pub fn ranges(&self) -> Vec<FieldRange> {
        ranges(&self.0)
    }
}

/// A named range of bits in pixel memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldRange {
    /// Name in error messages: `scratch`, or the context and the bit field, for example `context 0 z`.
    pub name: String,
    /// First bit in pixel memory, 0 to 207.
    pub first: u32,
    pub width: u32,
}

impl FieldRange {
    const fn end(&self) -> u32 {
        self.first + self.width
    }
}

fn check_widths(plan: &ContextPlan) -> Result<(), SettingError> {
    check_width("colour", "24", 24..=24, plan.colour)?;
    check_width("z", "8 to 24", 8..=24, plan.z)?;
    plan.normal.map_or(Ok(()), |normal| check_width("normal", "36", 36..=36, normal))
}

/// Returns an error if the width of a bit field is not in `allowed`. `expected` describes the allowed widths in the
/// error text.
fn check_width(
    field: &'static str,
    expected: &'static str,
    allowed: RangeInclusive<u8>,
    found: Operand,
) -> Result<(), SettingError> {
    if allowed.contains(&found.width) {
        return Ok(());
    }
    Err(SettingError::combination(format_args!("{field} has {} bits, expected {expected}", found.width)))
}

fn ranges(plan: &ContextPlan) -> Vec<FieldRange> {
    let mut out = Vec::new();
    let fields = [("colour", Some(plan.colour)), ("z", Some(plan.z)), ("normal", plan.normal)];
    // Fields of each context, at its base.
    for context in 0..u32::from(plan.contexts) {
        for (name, field) in fields {
            out.extend(field.map(|field| FieldRange {
                name: format!("context {context} {name}"),
                first: context * u32::from(plan.context_bits) + u32::from(field.address),
                width: u32::from(field.width),
            }));
        }
    }
    out.extend(plan.scratch.map(|field| FieldRange {
        name: "scratch".to_owned(),
        first: u32::from(field.address),
        width: u32::from(field.width),
    }));
    out
}

/// Returns one entry for each range in `ranges`: an error text, or `None` if the range has no error.
fn conflicts(plan: &ContextPlan, ranges: &[FieldRange]) -> Vec<Option<String>> {
    let mut out: Vec<_> = (0..ranges.len()).map(|i| conflict(&ranges[i], &ranges[..i])).collect();
    let whole = u32::from(plan.contexts) * u32::from(plan.context_bits);
    if (plan.contexts == 0 || whole > MEMORY_BITS) && !out.is_empty() {
        let i = out.len() - 1;
        out[i].get_or_insert(format!("{} contexts take {whole} bits", plan.contexts));
    }
    out
}

/// Returns an error text if a bit range overlaps one of the ranges `before`, or extends beyond pixel memory.
fn conflict(range: &FieldRange, before: &[FieldRange]) -> Option<String> {
    if range.end() > MEMORY_BITS {
        return Some(format!("ends beyond bit {}", MEMORY_BITS - 1));
    }
    let other = before.iter().find(|other| overlap(range, other))?;
    Some(format!("overlaps {}", other.name))
}

const fn overlap(a: &FieldRange, b: &FieldRange) -> bool {
    a.first < b.end() && b.first < a.end()
}

/// Returns a drawing as text, with one line for each bit field. A line has the bit range, a bar with one character for
/// each four bits, the name, and the error text.
fn draw(ranges: &[FieldRange], conflicts: &[Option<String>]) -> String {
    let mut out = String::new();
    for (range, conflict) in ranges.iter().zip(conflicts) {
        let bar: String = (0..MEMORY_BITS / 4).map(|i| if overlap(range, &quad(i)) { '#' } else { '.' }).collect();
        let last = range.end().max(1) - 1;
        let _ = write!(out, "{:>4}-{last:<4}|{bar}| {}", range.first, range.name);
        match conflict {
            Some(text) => {
                let _ = writeln!(out, "  <- {text}");
            }
            None => out.push('\n'),
        }
    }
    out
}

const fn quad(i: u32) -> FieldRange {
    FieldRange { name: String::new(), first: 4 * i, width: 4 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(first: u32, width: u32) -> FieldRange {
        FieldRange { name: format!("{first}"), first, width }
    }

    #[test]
    fn bit_ranges_overlap_if_they_share_a_bit() {
        let bits = |range: &FieldRange| range.first..range.first + range.width;
        let all: Vec<_> = (0..9).flat_map(|first| (1..5).map(move |width| range(first, width))).collect();
        for a in &all {
            for b in &all {
                let common = bits(a).any(|bit| bits(b).contains(&bit));
                assert_eq!(overlap(a, b), common, "{:?} {:?}", bits(a), bits(b));
            }
        }
    }

    #[test]
    fn a_drawing_of_a_layout_has_a_mark_for_every_four_bits_in_use() {
        let ranges = [range(0, 4), range(5, 2), range(7, 6), range(200, 8)];
        let drawn = draw(&ranges, &[const { None }; 4]);
        for (range, line) in ranges.iter().zip(drawn.lines()) {
            let bar = line.split('|').nth(1).expect("a bar");
            let has = |bit: u32| bit >= range.first && bit < range.first + range.width;
            let expected: String =
                (0..MEMORY_BITS / 4).map(|n| if (4 * n..4 * n + 4).any(has) { '#' } else { '.' }).collect();
            assert_eq!(bar, expected, "{line}");
        }
    }

    #[test]
    fn a_layout_needs_at_least_one_context_and_separate_bits_for_each_context() {
        let whole = |contexts, context_bits| {
            let plan = ContextPlan { contexts, context_bits, ..SLATS };
            conflicts(&plan, &[range(0, 4)])[0].clone()
        };
        assert_eq!(whole(4, (MEMORY_BITS / 4) as u8), None);
        for contexts in [0, 5] {
            let bits = contexts * MEMORY_BITS / 4;
            let expected = format!("{contexts} contexts take {bits} bits");
            assert_eq!(whole(contexts as u8, (MEMORY_BITS / 4) as u8), Some(expected));
        }
        assert!(conflicts(&SLATS, &[]).is_empty());
    }

    #[test]
    fn the_three_layouts_fit_into_pixel_memory() {
        for plan in [RENDERING_CONTROL_PHONG, SLATS, SLATS_QUARTERS] {
            Layout::new(plan).unwrap();
        }
    }

    #[test]
    fn slats_fills_pixel_memory_to_the_last_bit() {
        let used: u32 = Layout::slats().ranges().iter().map(|range| range.width).sum();
        assert_eq!(used, MEMORY_BITS);
        assert_eq!(Layout::slats().root_bits(), Some(10));
        assert_eq!(Layout::slats_quarters().root_bits(), None);
    }

    #[test]
    fn the_error_of_a_layout_with_overlapping_fields_draws_the_bit_ranges() {
        let plan = ContextPlan { scratch: Some(Operand::absolute(172, 32)), ..SLATS };
        let text = Layout::new(plan).unwrap_err().to_string();
        assert!(text.contains("172-203"), "{text}");
        assert!(text.contains("scratch  <- overlaps context 3 z"), "{text}");
    }

    #[test]
    fn phong_in_four_contexts_does_not_fit() {
        let normal = Some(Operand::context(48, 36));
        let plan = ContextPlan { normal, context_bits: 84, ..SLATS_QUARTERS };
        let text = Layout::new(plan).unwrap_err().to_string();
        assert!(text.contains("ends beyond bit 207"), "{text}");
    }

    #[test]
    fn the_error_of_a_bit_field_with_a_wrong_width_names_the_field() {
        let plan = ContextPlan { z: Operand::context(24, 28), ..SLATS };
        let error = Layout::new(plan).expect_err("28 bits");
        assert_eq!(error.to_string(), "z has 28 bits, expected 8 to 24");
    }
}
