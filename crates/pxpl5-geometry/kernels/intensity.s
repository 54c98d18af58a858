// The light at the vertex at r5, whose normal turns away as `away` of the structure at r6 says: 0 to 1 in f16; the colour in r8.

        .macro  intensity away
        fld.l   P_LIGHT(r20), f16
        fld.l   NORMAL(r5), f20
        fld.l   P_LIGHT+4(r20), f17
        fld.l   NORMAL+4(r5), f21
        fmul.ss f16, f20, f16
        fld.l   P_LIGHT+8(r20), f18
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fld.l   \away(r6), f8
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16               // the cosine
        pfgt.ss f8, f0, f0
        bnc     facing\@
        fsub.ss f0, f16, f16                // of the other side
facing\@: pfgt.ss f16, f0, f0
        bc      lit\@
        fmov.ss f0, f16
lit\@:    fld.l   P_DIFFUSE(r20), f8
        fld.l   P_AMBIENT(r20), f9
        fmul.ss f8, f16, f16
        fld.l   P_ONE(r20), f10
        fadd.ss f9, f16, f16
        pfle.ss f0, f16, f0                 // 0 to 1
        bnc     least\@
        fmov.ss f0, f16
least\@:  pfgt.ss f16, f10, f0
        bnc     most\@
        fmov.ss f10, f16
most\@: ld.l    COLOUR(r5), r8
        .endm

