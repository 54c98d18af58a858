// Reciprocals by Newton steps.

// f12 = 1 / f8 in double precision: a seed and three Newton steps.
        .macro  reciprocal
        fld.d   P_TWO(r20), f10
        frcp.dd f8, f12
        .rept   3
        fmul.dd f8, f12, f14
        fsub.dd f10, f14, f14
        fmul.dd f12, f14, f12
        .endr
        .endm

// f18 = 1 / the root of f16 in double precision: a seed and three Newton steps. In: 0.5 in f20, 1.5 in f22. Changes f8,
// f20.
        .macro  reciprocal_root
        fmul.dd f16, f20, f20
        frsqr.dd f16, f18
        .rept   3
        fmul.dd f18, f18, f8
        fmul.dd f20, f8, f8
        fsub.dd f22, f8, f8
        fmul.dd f18, f8, f18
        .endr
        .endm
