// f18 = 1 / the root of f16 to double precision: seed and three Newton steps. In: 0.5 in f20, 1.5 in f22. Changes f8, f20.
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
