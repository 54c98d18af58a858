//! Constant expressions of numbers, symbols and operators. `h%`, `l%` and `ha%` are the halves of a constant.

use std::collections::BTreeMap;

pub(super) type Symbols = BTreeMap<String, i64>;

const DEPTH: u32 = 64;

struct Parser<'a> {
    text: &'a str,
    symbols: &'a Symbols,
    depth: u32,
}

/// Computes the value of an expression in 64-bit integer arithmetic.
pub(super) fn evaluate(text: &str, symbols: &Symbols) -> Result<i64, String> {
    let mut parser = Parser { text: text.trim(), symbols, depth: 0 };
    if parser.text.is_empty() {
        return Err("an expression is missing".to_owned());
    }
    let value = parser.binary(0)?;
    match parser.text.trim() {
        "" => Ok(value),
        rest => Err(format!("unexpected `{rest}` in expression")),
    }
}

/// Binary operators, grouped by precedence, the lowest precedence first. Only [`PRODUCTS`] have a higher precedence.
const LEVELS: [&[&str]; 6] = [&["|"], &["^"], &["&"], &["==", "!="], &["<<", ">>"], &["+", "-"]];
const PRODUCTS: &[&str] = &["*", "/", "%"];

fn apply(operator: &str, a: i64, b: i64) -> Result<i64, String> {
    Ok(match operator {
        "|" => a | b,
        "^" => a ^ b,
        "&" => a & b,
        "==" => i64::from(a == b),
        "!=" => i64::from(a != b),
        "<<" => a << shift(b)?,
        ">>" => a >> shift(b)?,
        "+" => a.wrapping_add(b),
        "-" => a.wrapping_sub(b),
        "*" => a.wrapping_mul(b),
        "/" => a.wrapping_div(divisor(b)?),
        _ => a.wrapping_rem(divisor(b)?),
    })
}

fn shift(by: i64) -> Result<u32, String> {
    u32::try_from(by).ok().filter(|n| *n < 64).ok_or_else(|| format!("shift by {by}"))
}

fn divisor(by: i64) -> Result<i64, String> {
    if by == 0 { Err("division by zero".to_owned()) } else { Ok(by) }
}

fn is_part_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || "_.$@".contains(c)
}

impl Parser<'_> {
    fn take(&mut self, token: &str) -> bool {
        self.text = self.text.trim_start();
        let rest = self.text.strip_prefix(token);
        self.text = rest.unwrap_or(self.text);
        rest.is_some()
    }

    fn binary(&mut self, level: usize) -> Result<i64, String> {
        // Operators of one level are evaluated from left to right.
        let operators = LEVELS.get(level).copied().unwrap_or(PRODUCTS);
        let mut value = self.operand(level)?;
        while let Some(operator) = operators.iter().find(|o| self.take(o)) {
            let right = self.operand(level)?;
            value = apply(operator, value, right)?;
        }
        Ok(value)
    }

    fn operand(&mut self, level: usize) -> Result<i64, String> {
        if level < LEVELS.len() { self.binary(level + 1) } else { self.unary() }
    }

    fn unary(&mut self) -> Result<i64, String> {
        // Nesting is limited, because each level takes stack space.
        self.depth += 1;
        if self.depth > DEPTH {
            return Err("expression nested too deeply".to_owned());
        }
        let value = self.unary_inside();
        self.depth -= 1;
        value
    }

    fn unary_inside(&mut self) -> Result<i64, String> {
        match () {
            () if self.take("-") => Ok(self.unary()?.wrapping_neg()),
            () if self.take("+") => self.unary(),
            () if self.take("~") => Ok(!self.unary()?),
            () if self.take("!") => Ok(i64::from(self.unary()? == 0)),
            // `ha%` rounds the upper half up if the low half, which is signed, is negative.
            () if self.take("ha%") => self.unary().map(|v| v.wrapping_add(0x8000) >> 16 & 0xFFFF),
            () if self.take("h%") => self.unary().map(|v| v >> 16 & 0xFFFF),
            () if self.take("l%") => self.unary().map(|v| v & 0xFFFF),
            () if self.take("(") => {
                let value = self.binary(0)?;
                if self.take(")") { Ok(value) } else { Err("`)` is missing".to_owned()) }
            }
            () => self.atom(),
        }
    }

    fn atom(&mut self) -> Result<i64, String> {
        let end = self.text.find(|c| !is_part_of_name(c)).unwrap_or(self.text.len());
        let (word, rest) = self.text.split_at(end);
        self.text = rest;
        match word.bytes().next() {
            None => Err(format!("expected a number or a symbol, found `{rest}`")),
            Some(b'0'..=b'9') => number(word),
            Some(_) => self.symbols.get(word).copied().ok_or_else(|| format!("`{word}` is not defined")),
        }
    }
}

fn number(word: &str) -> Result<i64, String> {
    let lower = word.to_ascii_lowercase().replace('_', "");
    let parsed = if let Some(digits) = lower.strip_prefix("0x") {
        i64::from_str_radix(digits, 16)
    } else if let Some(digits) = lower.strip_prefix("0b") {
        i64::from_str_radix(digits, 2)
    } else if lower.len() > 1 && lower.starts_with('0') {
        // Other assemblers read such a number as octal, so ten would be a silent surprise.
        return Err(format!(
            "`{word}` has a leading zero: write it without the zero, or 0x before a hexadecimal number"
        ));
    } else {
        lower.parse()
    };
    parsed.map_err(|_| format!("`{word}` is not a number"))
}

#[cfg(test)]
mod tests {
    use super::{Symbols, evaluate};

    #[test]
    fn operators_have_the_precedence_of_c() {
        let none = Symbols::new();
        assert_eq!(evaluate("1 + 2 * 3 << 1 | 1", &none), Ok(15));
        assert_eq!(evaluate("-(4 - 6) * 0x10 & ~0", &none), Ok(32));
        assert_eq!(evaluate("1 + 1 == 2 & 3 != 4", &none), Ok(1));
        assert_eq!(evaluate("!0 & !7 | 2 == 1", &none), Ok(0));
    }

    #[test]
    fn the_adjusted_high_half_plus_the_signed_low_half_is_the_value() {
        let symbols = Symbols::from([("x".to_owned(), 0x0001_8004)]);
        assert_eq!(evaluate("h%x", &symbols), Ok(1));
        assert_eq!(evaluate("ha%x", &symbols), Ok(2));
        assert_eq!(evaluate("l%x", &symbols), Ok(0x8004));
        assert_eq!(evaluate("l%(x+4)", &symbols), Ok(0x8008));
    }

    #[test]
    fn errors_name_the_expression() {
        let none = Symbols::new();
        for (text, reason) in [
            ("", "missing"),
            ("1 +", "expected a number"),
            ("y", "`y` is not defined"),
            ("(1", "`)` is missing"),
            ("1/0", "division by zero"),
            ("1 << 64", "shift by 64"),
            ("0xg", "not a number"),
            ("010", "leading zero"),
            ("1 2", "unexpected"),
        ] {
            let found = evaluate(text, &none).expect_err(text);
            assert!(found.contains(reason), "{text}: {found}");
        }
        let deep = "(".repeat(100_000);
        assert!(evaluate(&deep, &none).expect_err("deep").contains("deeply"));
    }
}
