//! The command `pxpl5`.

fn main() {}
