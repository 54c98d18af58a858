//! Tests of the assembler and the disassembler. The tests check round trips, and the line and reason of every error.

use i860::{Rule, assemble, decode, disassemble, encode, instruction_word};
use proptest::prelude::*;

#[track_caller]
fn fault(source: &str) -> (usize, String) {
    let errors = assemble("t.s", 0x1000, source).expect_err("the source is wrong").0;
    (errors[0].line, errors[0].reason.clone())
}

#[track_caller]
fn assert_fault(source: &str, line: usize, reason: &str) {
    let (at, found) = fault(source);
    assert!(at == line && found.contains(reason), "line {at}: {found}");
}

#[test]
fn published_encodings_are_assembled() {
    for (text, word) in [
        ("nop", 0xA000_0000),
        ("fnop", 0xB000_0000),
        ("d.fnop", 0xB000_0200),
        ("fmul.ss f4, f5, f6", 0x48A6_2020),
        ("pfgt.dd f4, f6, f0", 0x48C0_2534),
        ("m12apm.ss f4, f6, f0", 0x48C0_2409),
        ("adds -1, r4, r4", 0x9484_FFFF),
        ("orh 0x1234, r0, r31", 0xEC1F_1234),
        ("fld.d 8(r4)++, f8", 0x2488_0009),
        ("flush 128(r1)", 0x3420_0084),
        ("flush 128(r1)++", 0x3420_0085),
        ("flush -8(r1)", 0x3420_FFFC),
        ("pfmul3.dd f2, f4, f30", 0x489E_15A4),
        ("d.pfmul3.dd f2, f4, f30", 0x489E_17A4),
    ] {
        let found = instruction_word(text, 0).expect(text);
        assert_eq!(found, word, "{text}: {found:08x}");
    }
}

#[test]
fn a_program_can_use_labels_macros_and_constants() {
    let program = assemble(
        "t.s",
        0x1000,
        "size = 4 * 3
         .macro add3 a, b
         loop\\@: adds \\a, \\b, \\b
         br loop\\@
         nop
         .endm
         start: add3 r5, r6
         add3 r7, r8
         .align 16
         data: .long size, start
         .float 1.5
         mov 0x12345678, r9",
    )
    .expect("correct");
    let words = program.words();
    assert_eq!(program.symbol("data"), Some(0x1020));
    assert_eq!(words[8..11], [12, 0x1000, 1.5f32.to_bits()]);
    assert_eq!(disassemble(words[1], 0x1004), "br 0x1000");
    assert_eq!(disassemble(words[4], 0x1010), "br 0x100c");
    assert_eq!(words[6], 0xA000_0000, "alignment is filled with nop");
    assert_eq!(
        (disassemble(words[11], 0), disassemble(words[12], 0)),
        ("orh 4660, r0, r9".into(), "or 22136, r9, r9".into())
    );
}

#[test]
fn the_name_of_a_constant_may_begin_with_the_name_of_a_register() {
    let program =
        assemble("t.s", 0, "size = 5\nmov size, r4\nmov sp, r5\nmov ha%0x7fffffffffffffff, r6").expect("correct");
    let text: Vec<String> = program.words().iter().map(|word| disassemble(*word, 0)).collect();
    assert_eq!(text[..3], ["orh 0, r0, r4", "or 5, r4, r4", "shl r0, r2, r5"]);
}

#[test]
fn pairing_errors_name_their_line() {
    assert_fault("d.fnop\nnop\nnop\nnop", 3, "expected a floating-point instruction");
    assert_fault("d.fnop\nnop\nd.fnop\nfadd.ss f2, f3, f4", 4, "expected a core instruction");
    assert_fault("d.fnop\nnop\nd.fadd.ss f2,f3,f4\nfld.l 0(r5),f4", 4, "the same register");
    assert_fault("d.fnop\nnop\nd.pfgt.ss f2,f3,f0\nadds 1,r4,r4", 4, "set CC");
    assert_fault("d.fnop\nnop\nd.pfgt.ss f2,f3,f0\nbc.t 0x1000\nd.fnop\nnop", 4, "beside a compare");
    assert_fault("d.fnop\nnop\nd.fnop", 3, "lacks its core instruction");
}

#[test]
fn a_correct_exit_from_dual_instruction_mode_is_accepted() {
    let pairs = "d.fnop\nnop\nd.fnop\nnop\nfnop\nnop\nfnop\nnop\nadds 1,r4,r4\nadds 1,r4,r4";
    assert!(assemble("t.s", 0, pairs).is_ok());
    let short = "d.fnop\nnop\nfnop\nnop\nadds 1,r4,r4";
    assert!(assemble("t.s", 0, short).is_ok());
}

#[test]
fn errors_of_one_instruction_name_their_line() {
    assert_fault("nop\nfoo r1", 2, "`foo` is not an operation");
    assert_fault("adds r1, r2", 1, "expected 3 operands, found 2");
    assert_fault("adds 40000, r2, r3", 1, "40000 is not in");
    assert_fault("and -1, r2, r3", 1, "-1 is not in");
    assert_fault("fadd.dd f3, f4, f6", 1, "multiple of 2");
    assert_fault("fld.q 0(r4), f6", 1, "multiple of 4");
    assert_fault("fld.d 4(r4), f6", 1, "displacement 4 is not a multiple of 8");
    assert_fault("ld.l 0(r4)++, r6", 1, "increment");
    assert_fault("br nowhere\nnop", 1, "`nowhere` is not defined");
    assert_fault("bte r1, r2, 0x100000", 1, "words away");
    assert_fault("a: nop\na: nop", 2, "defined twice");
    assert_fault("bla r4, r4, 0x1000\nnop", 1, "two different registers");
    assert_fault("br 0x1000\nbr 0x1000\nnop", 2, "in the slot");
    assert_fault("call 0x1000\nmov r0, r1", 2, "must not write r1");
    assert_fault("r9: nop\n.org 0x10", 2, "does not lie ahead");
    assert_fault(".macro m a\nm \\a\n.endm\nm 1", 4, "calls itself");
    assert_fault("d.adds r1, r2, r3", 1, "is not an operation");
}

#[test]
fn all_errors_of_a_source_are_reported_in_line_order() {
    let errors = assemble("t.s", 0, "foo\nadds r1\nbte 32, r1, 0").expect_err("wrong").0;
    assert_eq!(errors.iter().map(|e| e.line).collect::<Vec<_>>(), [1, 2, 3]);
    assert_eq!(errors[0].to_string(), "t.s:1: `foo` is not an operation");
}

#[test]
fn semicolons_separate_statements() {
    let lines = "start: adds 1,r0,r4\nadds 2,r0,r5\naddu r4,r5,r6\nnop\nend: nop";
    let expected = assemble("t.s", 0x1000, lines).expect("correct");
    for source in [
        "start:\tadds 1,r0,r4;\tadds 2,r0,r5\n\taddu r4,r5,r6; nop\nend:\tnop",
        "start: adds 1,r0,r4;adds 2,r0,r5;addu r4,r5,r6;nop;end: nop // one; two",
        ";;start: adds 1,r0,r4;; adds 2,r0,r5 ;\n addu r4,r5,r6\r\n; nop;\nend:; nop;",
        ".macro both a, b; adds 1,r0,\\a; adds 2,r0,\\b; .endm\nstart: both r4, r5; addu r4,r5,r6; .rept 2; nop; .endr",
    ] {
        let found = assemble("t.s", 0x1000, source).expect(source);
        assert_eq!(found.words(), expected.words(), "{source}");
        assert_eq!(found.symbol("start"), Some(0x1000), "{source}");
    }
    let found = assemble("t.s", 0, "nop\nnop; foo; nop").expect_err("wrong").0;
    assert_eq!((found.len(), found[0].to_string()), (1, "t.s:2: `foo` is not an operation".to_owned()));
}

#[test]
fn a_listing_shows_the_source_line_of_each_instruction_and_marks_data_as_data() {
    let source = "start: mov 0x12345678, r5 // both halves\n.macro two\nnop\nnop\n.endm\ntwo; nop\nend: nop\n.align 8\n\
                  table: .long 7, end\n.byte 1, 2, 3, 4, 255\n.byte 0\n.short 0xffff\n.align 8\n.double -1.5\n.float 0.5\nlast:";
    let program = assemble("t.s", 0x1000, source).expect("correct");
    let expected = "\
start:
00001000  ec051234  orh 4660, r0, r5                    1  start: mov 0x12345678, r5 // both halves
00001004  e4a55678  or 22136, r5, r5
00001008  a0000000  nop                                 6  two; nop
0000100c  a0000000  nop
00001010  a0000000  nop
end:
00001014  a0000000  nop                                 7  end: nop
table:
00001018  00000007  .long 0x7                           9  table: .long 7, end
0000101c  00001014  .long 0x1014
00001020  04030201  .byte 0x1, 0x2, 0x3, 0x4           10  .byte 1, 2, 3, 4, 255
00001024  ff        .byte 0xff
00001025  00        .byte 0x0                          11  .byte 0
00001026  ffff      .short 0xffff                      12  .short 0xffff
00001028  bff8000000000000  .double -1.5                       14  .double -1.5
00001030  3f000000  .float 0.5                         15  .float 0.5
last:
";
    assert_eq!(program.listing(Some(source)), expected);
    let gap = assemble("t.s", 0x1000, "nop\n.space 4000\nnop").expect("correct");
    let listed = gap.listing(None);
    assert_eq!(listed, "00001000  a0000000  nop\n00001004            .space 4000\n00001fa4  a0000000  nop\n");
    assert_eq!(gap.data_at(0x1003), None);
    assert!(gap.data_at(0x1004).is_some() && gap.data_at(0x1FA3).is_some() && gap.data_at(0x1FA4).is_none());
}

/// Returns the first warning of a source that assembles without errors.
#[track_caller]
fn warning(source: &str) -> Option<(Rule, String)> {
    let program = assemble("t.s", 0, source).expect(source);
    program.warnings.first().map(|warning| (warning.rule, warning.to_string()))
}

#[test]
fn broken_programming_rules_cause_warnings() {
    let reason = "t.s:2: a `d.` instruction must lie at a multiple of 8 (put a nop or .align 8 before it) [alignment]";
    assert_eq!(warning("nop\nd.fadd.ss f2, f3, f4\nnop"), Some((Rule::Alignment, reason.to_owned())));
    let reason = "t.s:1: a pipelined multiply must not have its first source as destination [multiply-source]";
    assert_eq!(warning("pfmul.ss f4, f5, f4"), Some((Rule::MultiplySource, reason.to_owned())));
    assert_eq!(warning("pfmul3.dd f4, f6, f4").map(|(rule, _)| rule), Some(Rule::MultiplySource));
    assert_eq!(warning("nop\nnop"), None);
    for (name, rule) in Rule::NAMES {
        assert_eq!(rule.name(), name);
    }
}

/// According to the manual, a scalar operation uses the pipe of its unit and destroys the results in the pipe.
#[test]
fn reading_a_pipe_after_a_scalar_operation_causes_a_warning() {
    let fault = |source: &str| {
        warning(source).map(|(rule, text)| {
            assert_eq!(rule, Rule::LostResult);
            text
        })
    };
    let drain = "pfadd.ss f0, f0, f0\n".repeat(2);
    let lost = fault(&format!("pfadd.ss f2, f3, f0\nfadd.ss f4, f5, f6\n{drain}pfadd.ss f0, f0, f10"));
    let reason = "takes a result out of the adder's pipe that a scalar operation destroyed";
    assert_eq!(lost.as_deref(), Some(format!("t.s:5: {reason} [lost-result]").as_str()));
    assert!(fault("frcp.ss f2, f3\npfmul.ss f4, f5, f6").is_some(), "a seed goes through the multiplier");
    let two = "fmul.dd f2, f4, f6\npfmul3.dd f2, f4, f0\npfmul3.dd f2, f4, f0\npfmul3.dd f2, f4, f8";
    assert!(fault(two).is_some(), "its pipe has three stages");
    assert!(fault("fmul.dd f2, f4, f6\npfmul.dd f2, f4, f0\nm12apm.dd f2, f4, f8").is_some(), "the adder gets it");
    for sound in [
        format!("fadd.ss f4, f5, f6\npfadd.ss f2, f3, f0\n{drain}pfadd.ss f0, f0, f10"),
        format!("pfadd.ss f2, f3, f0\nfmul.ss f4, f5, f6\n{drain}pfadd.ss f0, f0, f10"),
        "fadd.ss f4, f5, f6\nelsewhere: pfadd.ss f0, f0, f10".to_owned(),
        "fmul.dd f2, f4, f6\npfmul.dd f2, f4, f0\npfmul.dd f2, f4, f0\npfmul.dd f2, f4, f8".to_owned(),
        "fmul.dd f2,f4,f6\npfmul3.dd f2,f4,f0\npfmul3.dd f2,f4,f0\npfmul3.dd f2,f4,f0\npfmul3.dd f2,f4,f8".to_owned(),
    ] {
        assert_eq!(fault(&sound), None, "{sound}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn decoding_encoding_and_decoding_again_gives_the_same_instruction(word: u32) {
        if let Ok(i) = decode(word) {
            prop_assert_eq!(decode(encode(&i)), Ok(i));
        }
    }

    #[test]
    fn disassembled_words_assemble_to_the_same_words(word: u32, pc in 0u32..0x1000_0000) {
        let pc = pc & !7;
        let text = disassemble(word, pc);
        if !text.starts_with(".long") {
            prop_assert_eq!(instruction_word(&text, pc), Ok(word));
        }
    }

    #[test]
    fn floating_point_words_can_be_disassembled(low in 0u32..2048, registers: u32) {
        let word = 0x12 << 26 | (registers & 0x03DE_F000) | low;
        let text = disassemble(word, 0);
        let bits_without_meaning = [0x40, 0x50, 0x51, 0x57, 0x5A, 0x5F, 0x35].contains(&(low & 0x7F));
        let fields_used = decode(word).is_ok_and(|i| encode(&i) == word);
        if fields_used && !bits_without_meaning {
            prop_assert!(!text.starts_with(".long"), "{:08x} {}", word, text);
        }
    }

    #[test]
    fn any_source_gives_a_program_or_errors(source in "[a-z0-9 .,:()%+\\-\n\\\\]{0,200}") {
        let _ = assemble("any.s", 0, &source);
    }
}

/// The assembler rejects endless expansion quickly and with little memory. The error states the source line that causes
/// the expansion, or the line with the most expanded words.
#[test]
fn exceeding_the_expansion_budget_is_refused_at_its_line() {
    let spent = "written out to more than";
    assert_fault("nop\n.rept 1000000000000\n.macro a\n.endm\n.endr", 2, spent);
    assert_fault(".macro e\n.endm\n.rept 1000000000000\ne\n.endr", 3, spent);
    assert_fault("nop\n.rept 1000000000000\n.rept 0\nnop\n.endr\n.endr", 2, spent);
    let long = format!("nop\nnop\n.rept 1000000\n.byte {}\n.endr", vec!["0"; 5_000].join(", "));
    assert_fault(&long, 3, spent);
    let wide = format!(".macro a x\n.byte {}\n.endm\nnop\na {}", "\\x".repeat(20_000), "1".repeat(20_000));
    assert_fault(&wide, 5, spent);
    let doubling = ".macro a x\na \\x\\x\n.endm\n";
    assert_fault(&format!("{doubling}a 1"), 4, spent);
    assert!(assemble("t.s", 0, "nop\n.rept 1000000000000\n.endr").is_ok(), "nothing is repeated");
    assert_fault(".rept 900000\nnop\n.endr\nnop\n.rept 200000\nnop\n.endr", 1, spent);
}

#[test]
fn nested_repetitions_have_a_depth_limit() {
    let nested = |depth: usize| format!("{}nop\n{}", ".rept 1\n".repeat(depth), ".endr\n".repeat(depth));
    assert_fault(&nested(20_000), 33, "nest deeper than 32");
    assert_eq!(assemble("t.s", 0, &nested(32)).expect("allowed").words().len(), 1);
}

/// A million repetitions of a word give a program of a million words, a fourth of the longest program.
#[test]
fn a_million_words_are_assembled() {
    let program = assemble("t.s", 0, ".rept 1000000\n.long 7\n.endr").expect("within the budget");
    assert_eq!(program.bytes.len(), 4_000_000);
}

#[test]
fn conditions_select_lines_by_constants_defined_above() {
    let source = |phong: u32, strips: u32| {
        format!(
            "PHONG = {phong}; STRIPS = {strips}
             .if PHONG == 1
             SIZE = 128
             .if STRIPS
             adds 3, r0, r4
             .elseif SIZE == 128
             adds 4, r0, r4
             .elseif UNKNOWN
             .else
             adds 5, r0, r4
             .endif
             .else
             SIZE = 120
             .if UNKNOWN
             .endif
             .endif
             adds SIZE, r0, r5"
        )
    };
    let text = |phong, strips| -> Vec<String> {
        let program = assemble("t.s", 0, &source(phong, strips)).expect("correct");
        program.words().iter().map(|word| disassemble(*word, 0)).collect()
    };
    assert_eq!(text(1, 1), ["adds 3, r0, r4", "adds 128, r0, r5"]);
    assert_eq!(text(1, 0), ["adds 4, r0, r4", "adds 128, r0, r5"]);
    // The condition inside excluded lines is not evaluated in the other cases.
    assert_fault(&source(0, 0), 14, ".if: `UNKNOWN` is not defined");
}

#[test]
fn the_error_of_an_invalid_condition_names_its_line() {
    assert_fault("nop\n.if 1\nnop", 2, ".if without .endif");
    assert_fault("nop\n.endif", 2, ".endif without .if");
    assert_fault(".if 1\n.else\n.else\n.endif", 3, ".else without .if");
    assert_fault(".if 1\n.else\n.elseif 1\n.endif", 3, ".elseif without .if");
    assert_fault(".if label\nlabel: nop\n.endif", 1, "`label` is not defined");
    // The line numbers of other errors stay the same.
    assert_fault(".if 0\nwrong\n.endif\nwrong", 4, "`wrong` is not an operation");
}
