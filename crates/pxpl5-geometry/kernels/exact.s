// Clip coordinates of a corner and the tests of the guard band in straight code.

// clip coordinate `to` of corner n: ((c0 x + c1 y) + c2 z) + t with x y z in f16 f17 f18
        .macro  row n, k
        fld.l   P_ROWS+16*\k(r20), f8
        fmul.ss f8, f16, f9
        fld.l   P_ROWS+16*\k+4(r20), f8
        fmul.ss f8, f17, f10
        fadd.ss f9, f10, f9
        fld.l   P_ROWS+16*\k+8(r20), f8
        fmul.ss f8, f18, f10
        fadd.ss f9, f10, f9
        fld.l   P_ROWS+16*\k+12(r20), f8
        fadd.ss f9, f8, f9
        fst.l   f9, CLIP+16*\n+4*\k(r2)
        .endm

// relative to the eye
        .macro  relative n, k, to
        fld.l   32*\n+4*\k(r16), f8
        fld.l   P_ORIGIN+4*\k(r20), f9
        fsub.ss f8, f9, \to
        .endm

// to the clipper unless a <= b
        .macro  need a, b
        pfle.ss \a, \b, f0
        bc      clip
        .endm

// |coordinate k| <= guard k * w
        .macro  side n, k
        fld.l   CLIP+16*\n+12(r2), f8
        fld.l   P_GUARD+4*\k(r20), f9
        fmul.ss f9, f8, f9
        fld.l   CLIP+16*\n+4*\k(r2), f10
        need    f10, f9
        fsub.ss f0, f10, f10
        need    f10, f9
        .endm

        .macro  inside n
        side    \n, 0
        side    \n, 1
        fld.l   CLIP+16*\n+8(r2), f10
        fld.l   CLIP+16*\n+12(r2), f8
        need    f0, f10
        need    f10, f8
        fld.l   P_GUARD+8(r20), f9
        need    f9, f8
        fld.l   P_GUARD+12(r20), f9
        need    f8, f9
        .endm

        .macro  corner n
        relative \n, 0, f16
        relative \n, 1, f17
        relative \n, 2, f18
        row     \n, 0
        row     \n, 1
        row     \n, 2
        row     \n, 3
        .endm

