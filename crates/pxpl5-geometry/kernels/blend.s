// Matrices between two views, element by element (pphigs's kernels/between_rules.md, rule 2).
//
// In: r16 those of the first view, r17 those of the second, r18 where they go, r19 how many elements (at least 1), r20 and r21 the part of
// the way as a double.

        .align  32
blend:  ixfr    r20, f16
        ixfr    r21, f17
        orh     0x3FF0, r0, r22             // 1.0
        ixfr    r0, f18
        ixfr    r22, f19
        nop
        fsub.dd f18, f16, f18
element: fld.l  0(r16), f8
        fld.l   0(r17), f9
        adds    4, r16, r16
        fmov.sd f8, f10
        adds    4, r17, r17
        fmov.sd f9, f12
        adds    -1, r19, r19
        fmul.dd f10, f18, f10
        fmul.dd f12, f16, f12
        fadd.dd f10, f12, f10
        fmov.ds f10, f8
        fst.l   f8, 0(r18)
        adds    4, r18, r18
        btne    r0, r19, element
        bri     r1
        nop
