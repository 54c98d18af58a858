//! Converters between addresses or labels of i860 programs and text.

use ::i860::Program;

/// Parses a 32-bit number, decimal or hexadecimal with `0x`.
pub(super) fn address(text: &str) -> Result<u32, String> {
    let lower = text.to_ascii_lowercase();
    let parsed = match lower.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => lower.parse(),
    };
    parsed.map_err(|_| format!("expected a 32-bit address such as 0x1000, found `{text}`"))
}

pub(super) fn labels_at(program: &Program, pc: u32) -> String {
    program.labels.iter().filter(|(_, at)| *at == pc).map(|(name, _)| format!("{name}:\n")).collect()
}
