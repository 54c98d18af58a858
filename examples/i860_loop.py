"""A loop on the graphics processor's i860: assembles, steps and runs the code, and prints the clocks of each label."""

import pxpl5

SOURCE = """
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
"""

program = pxpl5.assemble(SOURCE)
print(program.listing())

processor = pxpl5.Processor(program)
for _ in range(3):
    print(f"step to {processor.step():#x}")
print(processor.run(), "after", processor.clocks, "clocks and", processor.instructions, "instructions")
print("result", processor.read("result")[0])
print(processor.profile())
assert processor.read("result")[0] == sum(n * n for n in range(1, 11))
