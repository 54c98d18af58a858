"""Tests of the i860."""

import numpy as np
import pytest

import pxpl5

#: 10 + 9 + .. + 1 = 55: the program of the crate's first page.
SUM = """
start:  mov     10, r5
loop:   adds    r5, r6, r6
        adds    -1, r5, r5
        btne    r0, r5, loop
        mov     total, r7
        st.l    r6, 0(r7)
end:    nop
total:  .long   0
"""


def test_a_loop_sums_up_and_stores_the_sum() -> None:
    program = pxpl5.assemble(SUM)
    processor = pxpl5.Processor(program)
    assert processor.run() == "stopped"
    assert processor.r[6] == 55 and processor.read("total")[0] == 55
    assert processor.pc == program.symbols["end"]
    # One mov, ten turns of three instructions, and two instructions that store the sum.
    assert processor.instructions >= 1 + 30 + 2
    profile = processor.profile()
    assert profile["clocks"] == processor.clocks >= processor.instructions
    assert sum(profile["by_label"].values()) <= profile["clocks"] and profile["by_label"]["loop"] > 0


def test_steps_do_what_a_run_does() -> None:
    program = pxpl5.assemble(SUM)
    whole = pxpl5.Processor(program)
    whole.run()
    single = pxpl5.Processor(program)
    while single.pc != program.symbols["end"]:
        single.step()
    assert np.array_equal(single.r, whole.r) and single.clocks == whole.clocks


def test_words_are_disassembled_to_what_was_assembled() -> None:
    program = pxpl5.assemble(SUM)
    assert program.words.dtype == np.uint32 and len(program.bytes) == 4 * len(program.words)
    assert pxpl5.disassemble(0x94A5FFFF) == "adds -1, r5, r5"
    assert "loop:" in program.listing() and "adds -1, r5, r5" in program.listing()


def test_a_wrong_source_names_all_its_lines() -> None:
    with pytest.raises(pxpl5.AssemblyError) as raised:
        pxpl5.assemble("mov 1, r99\nnop\nfrobnicate\n", name="wrong.s")
    assert "wrong.s" in str(raised.value) and "frobnicate" in str(raised.value) and "r99" in str(raised.value)


def test_traps_budgets_and_places_are_told() -> None:
    with pytest.raises(pxpl5.RunError, match="trap at 0x00001004: 0x00000002 is not a multiple of 4"):
        pxpl5.Processor(pxpl5.assemble("mov 2, r4\nld.l r4(r0), r5")).run()
    assert pxpl5.Processor(pxpl5.assemble("start: br start\nnop\nend: nop")).run(budget=1_000) == "exhausted"
    processor = pxpl5.Processor(pxpl5.assemble(SUM))
    with pytest.raises(pxpl5.SettingError, match=r"expected a label of the program \(start, loop, end, total\)"):
        processor.run("ende")
    with pytest.raises(pxpl5.SettingError, match="are not all in memory"):
        processor.read(0x00FF_0000)
    with pytest.raises(pxpl5.SettingError, match="do not fit"):
        pxpl5.Processor(pxpl5.assemble("nop"), memory=0x100)


def test_memory_and_registers_can_be_written() -> None:
    processor = pxpl5.Processor(pxpl5.assemble("start: ld.l 0(r8), r9\nend: nop"))
    processor.write(0x2000, [7, 8])
    processor.set_r(8, 0x2004)
    processor.run()
    assert processor.r[9] == 8
    with pytest.raises(pxpl5.SettingError, match="register: expected 1 to 31, found 0"):
        processor.set_r(0, 1)
