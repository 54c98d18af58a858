// Triangles that face away are not drawn: to `otherwise` if the high word of the area, in the frame or in a register, tells so.
// Changes r11, r13 and r14.

        .macro  facing_word otherwise
        ld.l    P_CULL(r20), r13
        ld.l    P_CULL+4(r20), r14
        xor     r13, r11, r13
        and     r14, r13, r13
        subs    r13, r0, r0
        bc      \otherwise
        .endm

        .macro  facing at, otherwise
        ld.l    \at(r2), r11
        facing_word \otherwise
        .endm
        .macro  facing_float high, otherwise
        fxfr    \high, r11
        facing_word \otherwise
        .endm
