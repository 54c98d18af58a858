// Spheres go into the bins of the regions that their boxes meet.

        .macro  boxed
        .endm

// columns r11 to r12 and rows r13 to r14 of regions
        .macro  binned
        mov     r0, r22
        mov     r13, r15
rows:   mov     r11, r23
columns: regionnumber r15, r23
        insert  r28
        adds    1, r23, r23
        subs    r12, r23, r0
        bnc     columns
        adds    1, r15, r15
        subs    r14, r15, r0
        bnc     rows
        .endm
