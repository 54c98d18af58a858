// Finds the views that each primitive may touch, for six views of one eye (sort_rules.md).
//
// In: r16 first primitive, r17 number of primitives (at least 1), r18 destination of the result, r20 parameter block for
// triangles of the view along -z. r21 and r22 are single-precision numbers: 1 / scale of the projection of the views, and
// the scale minus a margin. For spheres, r23 is the parameter block for spheres.
// Out: one word for each primitive. Bits 0 to 5 are set for the views along +x, -x, +y, -y, +z, -z.

TRIANGLE_BYTES = 96
VERTEX_BYTES = 32
SPHERE_BYTES = 32
RADIUS   = 12
P_ROWS   = 0
P_ORIGIN = 64
S_SCALE  = 64

// Computes `to` = row k of the view's matrix times the point in f16, f17, f18.
        .macro  row k, to
        fld.l   P_ROWS+16*\k(r20), f8
        fld.l   P_ROWS+16*\k+4(r20), f9
        fmul.ss f8, f16, \to
        fld.l   P_ROWS+16*\k+8(r20), f10
        fmul.ss f9, f17, f12
        fld.l   P_ROWS+16*\k+12(r20), f11
        fadd.ss \to, f12, \to
        fmul.ss f10, f18, f12
        fadd.ss \to, f12, \to
        fadd.ss \to, f11, \to
        .endm

// Transforms the point at r5 to the axes of the eye: right in f20, up in f21, ahead in f22.
        .macro  point
        fld.l   0(r5), f16
        fld.l   P_ORIGIN(r20), f8
        fld.l   4(r5), f17
        fld.l   P_ORIGIN+4(r20), f9
        fsub.ss f16, f8, f16
        fld.l   8(r5), f18
        fld.l   P_ORIGIN+8(r20), f10
        fsub.ss f17, f9, f17
        fsub.ss f18, f10, f18
        row     0, f20
        row     1, f21
        row     3, f22
        fmul.ss f20, f2, f20
        fmul.ss f21, f2, f21
        .endm

// Widens the range from `low` to `high`, so that it contains `v`.
        .macro  widened v, low, high
        pfgt.ss \low, \v, f0
        bnc     low\@
        fmov.ss \v, \low
low\@:  pfgt.ss \v, \high, f0
        bnc     high\@
        fmov.ss \v, \high
high\@:
        .endm

// Sets `bit` in r7 unless the box lies behind the eye or outside one of the four side planes of a view. `reach` is the
// greatest distance of the box in the direction of the view. A side plane excludes the box if a, b, c or d exceeds `reach`.
        .macro  view bit, reach, a, b, c, d
        pfgt.ss f0, \reach, f0
        bc      no\@
        pfgt.ss \a, \reach, f0
        bc      no\@
        pfgt.ss \b, \reach, f0
        bc      no\@
        pfgt.ss \c, \reach, f0
        bc      no\@
        pfgt.ss \d, \reach, f0
        bc      no\@
        or      \bit, r7, r7
no\@:
        .endm

// Writes the word of a primitive. Its box extends from f24 to f25 to the right, from f26 to f27 upwards, and from f28 to f29
// ahead.
        .macro  views
        fsub.ss f0, f25, f5
        fsub.ss f0, f27, f6
        fsub.ss f0, f29, f7
        fmul.ss f24, f3, f8                 // limits of the box times the scale, for the side planes
        fmul.ss f5, f3, f9
        fmul.ss f26, f3, f10
        fmul.ss f6, f3, f11
        fmul.ss f28, f3, f12
        fmul.ss f7, f3, f13
        fsub.ss f0, f24, f5
        fsub.ss f0, f26, f6
        fsub.ss f0, f28, f7
        mov     r0, r7
        view    1, f25, f10, f11, f12, f13
        view    2, f5, f10, f11, f12, f13
        view    4, f27, f8, f9, f12, f13
        view    8, f6, f8, f9, f12, f13
        view    16, f7, f8, f9, f10, f11
        view    32, f29, f8, f9, f10, f11
        st.l    r7, 0(r18)
        adds    4, r18, r18
        .endm

        .align  32
triangles: ixfr r21, f2
        ixfr    r22, f3
next:   mov     r16, r5
        point
        fmov.ss f20, f24
        fmov.ss f20, f25
        fmov.ss f21, f26
        fmov.ss f21, f27
        fmov.ss f22, f28
        fmov.ss f22, f29
        mov     2, r6
corner: adds    VERTEX_BYTES, r5, r5
        point
        widened f20, f24, f25
        widened f21, f26, f27
        widened f22, f28, f29
        adds    -1, r6, r6
        btne    r0, r6, corner
        views
        adds    -1, r17, r17
        adds    TRIANGLE_BYTES, r16, r16
        btne    r0, r17, next
        bri     r1
        nop

        .align  32
spheres: ixfr   r21, f2
        ixfr    r22, f3
        fld.d   S_SCALE(r23), f30
another: mov    r16, r5
        point
        fld.l   RADIUS(r16), f8
        fmov.sd f8, f10
        fmul.dd f10, f30, f10
        fmov.ds f10, f4                     // the radius in units of the eye
        fsub.ss f20, f4, f24
        fadd.ss f20, f4, f25
        fsub.ss f21, f4, f26
        fadd.ss f21, f4, f27
        fsub.ss f22, f4, f28
        fadd.ss f22, f4, f29
        views
        adds    -1, r17, r17
        adds    SPHERE_BYTES, r16, r16
        btne    r0, r17, another
        bri     r1
        nop
