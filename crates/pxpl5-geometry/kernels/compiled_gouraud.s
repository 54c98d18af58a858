// The light at the corners of the compiled kernel.

        .macro  surfaces
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
lights: call    light
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, lights
        .endm

// ---- light: vertex at r5 to the values of the structure at r6, and r6 to the next
light:  intensity C_AWAY
        mov     16, r9
        mov     -8, r7
        adds    C_SURFACE, r6, r10
        fld.l   P_TWO23(r20), f8
        fld.l   P_ROUND_S(r20), f9
        fld.l   P_SIDES+8(r20), f10
        fld.d   P_SIDES+16(r20), f12
component: shr  r9, r8, r11                 // 256 times 8 bits of the colour, by way of 2^23
        and     255, r11, r11
        shl     8, r11, r11
        orh     0x4B00, r11, r11
        ixfr    r11, f17
        adds    -8, r9, r9
        nop
        fsub.ss f17, f8, f17
        fmul.ss f17, f16, f17
        fadd.ss f17, f9, f17
        fmul.sd f17, f10, f18
        fadd.dd f18, f12, f18
        fst.d   f18, 0(r10)
        adds    8, r10, r10
        btne    r9, r7, component           // r7 is the shift behind the last one
        adds    C_BYTES, r6, r6
        bri     r1
        nop
