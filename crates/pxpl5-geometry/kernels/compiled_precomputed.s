// The precomputed colours at the corners of the compiled kernel.

        .macro  surfaces
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
colours: call   colour
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, colours
        .endm

// ---- colour: vertex at r5 to the values of the structure at r6, and r6 to the next
colour: ld.l    COLOUR(r5), r8
        mov     16, r9
        mov     -8, r7
        adds    C_SURFACE, r6, r10
        orh     0x4330, r0, r11             // high word of 2^52
        ixfr    r11, f17
        fld.d   P_SURFACE(r20), f12
component: shr  r9, r8, r11                 // 8 bits of the colour in units of 1/4096, and half a unit
        and     255, r11, r11
        shl     12, r11, r11
        or      2048, r11, r11
        ixfr    r11, f16
        adds    -8, r9, r9
        nop
        fsub.dd f16, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r9, r7, component           // r7 is the shift behind the last one
        adds    C_BYTES, r6, r6
        bri     r1
        nop
