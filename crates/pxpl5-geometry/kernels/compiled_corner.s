// ---- corner: vertex at r5 to the structure at r6, and r6 to the next; r7 is 0 if it is outside of the guard band

corner: projected
        guarded
        placed
        fld.l   NORMAL(r5), f20
        fsub.dd f12, f10, f12
        fld.l   NORMAL+4(r5), f21
        fst.d   f12, C_DEPTH(r6)
        fmul.ss f16, f20, f16               // how far the normal turns away
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16
        fst.l   f16, C_AWAY(r6)
        adds    C_BYTES, r6, r6
        bri     r1
        mov     1, r7
beyond: bri    r1
        mov     r0, r7

