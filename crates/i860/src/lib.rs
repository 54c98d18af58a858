//! Intel i860 XR processor: decode, execute, cycle timing, assembler, disassembler.
