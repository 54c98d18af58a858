// What both surface routines begin with: unit normals in eye coordinates, and how far each turns away from the eye. The
// three corners go through the pipes side by side. Arithmetic and its order are those of the native code; only the root
// of the square and its reciprocal are formed by Newton steps in double precision, then rounded.
//
// Normals: x in f26 f27 f28 of corners 0 1 2, y in f29 f30 f31, z in f2 f3 f7.

// an operation for each corner through a pipe of three stages
        .macro  three op, a0, b0, a1, b1, a2, b2, d0, d1, d2
        \op     \a0, \b0, f0
        \op     \a1, \b1, f0
        \op     \a2, \b2, f0
        \op     f0, f0, \d0
        \op     f0, f0, \d1
        \op     f0, f0, \d2
        .endm

// products in double precision: two stages
        .macro  multiply a0, b0, a1, b1, a2, b2, d0, d1, d2
        pfmul.dd \a0, \b0, f0
        pfmul.dd \a1, \b1, f0
        pfmul.dd \a2, \b2, \d0
        pfmul.dd f0, f0, \d1
        pfmul.dd f0, f0, \d2
        .endm

// d = (u x + v y) + w z for each corner; u0 to u2 are lost, f20 to f25 used
        .macro  sum u0, u1, u2, v0, v1, v2, w0, w1, w2, x0, x1, x2, y0, y1, y2, z0, z1, z2, t0, t1, t2, d0, d1, d2
        pfmul.ss \u0, \x0, f0
        pfmul.ss \u1, \x1, f0
        pfmul.ss \u2, \x2, f0
        pfmul.ss \v0, \y0, f20
        pfmul.ss \v1, \y1, f21
        pfmul.ss \v2, \y2, f22
        pfmul.ss \w0, \z0, f23
        pfmul.ss \w1, \z1, f24
        pfmul.ss \w2, \z2, f25
        pfadd.ss f20, f23, f0
        pfadd.ss f21, f24, f0
        pfadd.ss f22, f25, f0
        pfmul.ss f0, f0, \t0
        pfmul.ss f0, f0, \t1
        pfmul.ss f0, f0, \t2
        pfadd.ss f0, f0, f20
        pfadd.ss f0, f0, f21
        pfadd.ss f0, f0, f22
        three   pfadd.ss, f20, \t0, f21, \t1, f22, \t2, \d0, \d1, \d2
        .endm

// the same with weights that all corners share, which are lost
        .macro  weighted u, v, w, x0, x1, x2, y0, y1, y2, z0, z1, z2, d0, d1, d2
        sum     \u, \u, \u, \v, \v, \v, \w, \w, \w, \x0, \x1, \x2, \y0, \y1, \y2, \z0, \z1, \z2, \u, \v, \w, \d0, \d1, \d2
        .endm

// row k of the normals at f4, f8, f12 in eye coordinates
        .macro  direction k, d0, d1, d2
        fld.q   P_EYE+16*\k(r20), f16
        weighted f16, f17, f18, f4, f8, f12, f5, f9, f13, f6, f10, f14, \d0, \d1, \d2
        .endm

// a normal without a direction, square s, becomes 0, 0, 1
        .macro  directed s, x, y, z
        pfle.ss f20, \s, f0
        bc      none\@
        pfle.ss \s, f21, f0
        bnc     some\@
none\@: fld.l   P_ONE(r20), \s
        fmov.ss f0, \x
        fmov.ss f0, \y
        fld.l   P_ONE(r20), \z
some\@: nop
        .endm

// row k of the corners (relative to the eye, at f8, f12, f16) times component k of the normals
        .macro  away k, n0, n1, n2, d0, d1, d2
        fld.l   P_EYE+16*\k(r20), f4
        fld.l   P_EYE+16*\k+4(r20), f5
        fld.l   P_EYE+16*\k+8(r20), f6
        weighted f4, f5, f6, f8, f12, f16, f9, f13, f17, f10, f14, f18, f20, f21, f22
        fld.l   P_EYE+16*\k+12(r20), f4
        three   pfadd.ss, f20, f4, f21, f4, f22, f4, f20, f21, f22
        three   pfmul.ss, f20, \n0, f21, \n1, f22, \n2, \d0, \d1, \d2
        .endm

// In: r5 triangle. Out: unit normals; how far they turn away from the eye in f11 f15 f19.
        .macro  normals
        fld.q   NORMAL(r5), f4
        fld.q   NORMAL+32(r5), f8
        fld.q   NORMAL+64(r5), f12
        direction 0, f26, f27, f28
        direction 1, f29, f30, f31
        direction 2, f2, f3, f7
        sum     f26, f27, f28, f29, f30, f31, f2, f3, f7, f26, f27, f28, f29, f30, f31, f2, f3, f7, f16, f17, f18, f16, f17, f18
        fld.l   P_LEAST(r20), f20
        fld.l   P_MOST(r20), f21
        directed f16, f26, f29, f2
        directed f17, f27, f30, f3
        directed f18, f28, f31, f7
        famov.sd f16, f8                    // 1 / root of the square by seed and three Newton steps
        famov.sd f17, f10
        famov.sd f18, f12
        frsqr.dd f8, f14
        frsqr.dd f10, f16
        frsqr.dd f12, f18
        fld.d   P_HALF(r20), f4
        multiply f8, f4, f10, f4, f12, f4, f8, f10, f12
        fld.d   P_THREE_HALVES(r20), f4
        .rept   3
        multiply f14, f14, f16, f16, f18, f18, f20, f22, f24
        multiply f20, f8, f22, f10, f24, f12, f20, f22, f24
        three   pfsub.dd, f4, f20, f4, f22, f4, f24, f20, f22, f24
        multiply f14, f20, f16, f22, f18, f24, f14, f16, f18
        .endr
        multiply f8, f14, f10, f16, f12, f18, f20, f22, f24
        three   pfadd.dd, f20, f20, f22, f22, f24, f24, f20, f22, f24
        famov.ds f20, f8                    // the root, rounded to single
        famov.ds f22, f10
        famov.ds f24, f12
        famov.sd f8, f8
        famov.sd f10, f10
        famov.sd f12, f12
        fld.d   P_TWO(r20), f4
        .rept   2                           // 1 / rounded root by two Newton steps
        multiply f8, f14, f10, f16, f12, f18, f20, f22, f24
        three   pfsub.dd, f4, f20, f4, f22, f4, f24, f20, f22, f24
        multiply f14, f20, f16, f22, f18, f24, f14, f16, f18
        .endr
        famov.ds f14, f4
        famov.ds f16, f5
        famov.ds f18, f6
        pfmul.ss f26, f4, f0
        pfmul.ss f27, f5, f0
        pfmul.ss f28, f6, f0
        pfmul.ss f29, f4, f26
        pfmul.ss f30, f5, f27
        pfmul.ss f31, f6, f28
        pfmul.ss f2, f4, f29
        pfmul.ss f3, f5, f30
        pfmul.ss f7, f6, f31
        pfmul.ss f0, f0, f2
        pfmul.ss f0, f0, f3
        pfmul.ss f0, f0, f7
        fld.q   0(r5), f8                   // corners relative to the eye
        fld.q   32(r5), f12
        fld.q   64(r5), f16
        fld.l   P_ORIGIN(r20), f4
        fld.l   P_ORIGIN+4(r20), f5
        fld.l   P_ORIGIN+8(r20), f6
        three   pfsub.ss, f8, f4, f12, f4, f16, f4, f8, f12, f16
        three   pfsub.ss, f9, f5, f13, f5, f17, f5, f9, f13, f17
        three   pfsub.ss, f10, f6, f14, f6, f18, f6, f10, f14, f18
        away    0, f26, f27, f28, f11, f15, f19
        away    1, f29, f30, f31, f23, f24, f25
        three   pfadd.ss, f11, f23, f15, f24, f19, f25, f11, f15, f19
        away    2, f2, f3, f7, f23, f24, f25
        three   pfadd.ss, f11, f23, f15, f24, f19, f25, f11, f15, f19
        .endm
