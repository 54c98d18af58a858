// What both surface routines of straight code begin with: normals, and how far each turns away from the eye. Arithmetic and its
// order are those of the native code.

// an operation for each corner through a pipe of three stages
        .macro  three op, a0, b0, a1, b1, a2, b2, d0, d1, d2
        \op     \a0, \b0, f0
        \op     \a1, \b1, f0
        \op     \a2, \b2, f0
        \op     f0, f0, \d0
        \op     f0, f0, \d1
        \op     f0, f0, \d2
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
        fld.l   P_EYE+16*\k(r20), f16
        fld.l   P_EYE+16*\k+4(r20), f17
        fld.l   P_EYE+16*\k+8(r20), f18
        weighted f16, f17, f18, f4, f8, f12, f5, f9, f13, f6, f10, f14, \d0, \d1, \d2
        .endm

// how far the normal x y z of corner n turns away from the eye
        .macro  away n, x, y, z, to
        fld.l   32*\n(r5), f20
        fld.l   P_ORIGIN(r20), f21
        fsub.ss f20, f21, f20
        fmul.ss f20, \x, f22
        fld.l   32*\n+4(r5), f20
        fld.l   P_ORIGIN+4(r20), f21
        fsub.ss f20, f21, f20
        fmul.ss f20, \y, f23
        fadd.ss f22, f23, f22
        fld.l   32*\n+8(r5), f20
        fld.l   P_ORIGIN+8(r20), f21
        fsub.ss f20, f21, f20
        fmul.ss f20, \z, f23
        fadd.ss f22, f23, \to
        .endm

// In: r5 triangle. Out: normals as the display list holds them at f4, f8, f12; how far they turn away from the eye in f11 f15 f19.
        .macro  normals
        fld.q   NORMAL(r5), f4
        fld.q   NORMAL+32(r5), f8
        fld.q   NORMAL+64(r5), f12
        away    0, f4, f5, f6, f11
        away    1, f8, f9, f10, f15
        away    2, f12, f13, f14, f19
        .endm
