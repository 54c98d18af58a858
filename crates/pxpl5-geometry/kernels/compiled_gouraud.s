// The light at the corners of the compiled kernel.

// A command: enable; three edges; depth compared, depth loaded again; red, green, blue.
COMMAND_BYTES = 120

        .macro  surfaces
        mov     r16, r5
        adds    CORNERS, r2, r6
        mov     3, r4
lights: call    light
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        btne    r0, r4, lights
        .endm

// Nothing follows the planes.
        .macro  finish
        .endm

// ---- light: vertex at r5 to the values of the structure at r6, and r6 to the next
light:  fld.l   P_LIGHT(r20), f16
        fld.l   NORMAL(r5), f20
        fld.l   P_LIGHT+4(r20), f17
        fld.l   NORMAL+4(r5), f21
        fmul.ss f16, f20, f16
        fld.l   P_LIGHT+8(r20), f18
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fld.l   C_AWAY(r6), f8
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16               // the cosine
        pfgt.ss f8, f0, f0
        bnc     facing
        fsub.ss f0, f16, f16                // of the other side
facing: pfgt.ss f16, f0, f0
        bc      lit
        fmov.ss f0, f16
lit:    fld.l   P_DIFFUSE(r20), f8
        fld.l   P_AMBIENT(r20), f9
        fmul.ss f8, f16, f16
        fld.l   P_ONE(r20), f10
        fadd.ss f9, f16, f16
        pfle.ss f0, f16, f0                 // 0 to 1
        bnc     least
        fmov.ss f0, f16
least:  pfgt.ss f16, f10, f0
        bnc     most
        fmov.ss f10, f16
most:   ld.l    COLOUR(r5), r8
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
