// f12 = 1 / f8 to double precision: seed and three Newton steps
        .macro  reciprocal
        fld.d   P_TWO(r20), f10
        frcp.dd f8, f12
        .rept   3
        fmul.dd f8, f12, f14
        fsub.dd f10, f14, f14
        fmul.dd f12, f14, f12
        .endr
        .endm
