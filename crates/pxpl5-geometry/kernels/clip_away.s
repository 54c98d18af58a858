// How far the normal of the vertex at r5 turns away from the eye, to the structure at r6; where it is from the eye in f16 f17 f18.

        .macro  turnsaway
        fld.l   NORMAL(r5), f24             // how far the normal turns away
        fld.l   NORMAL+4(r5), f25
        fmul.ss f16, f24, f16
        fld.l   NORMAL+8(r5), f26
        fmul.ss f17, f25, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f26, f18
        fadd.ss f16, f18, f16
        fst.l   f16, V_AWAY(r6)
        .endm
