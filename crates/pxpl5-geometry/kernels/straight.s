// The kernel of straight code (Schedule::Straight).

// Clip coordinates of a corner and the tests of the guard band in straight code.

// Clip coordinate `to` of corner n: ((c0 x + c1 y) + c2 z) + t with x y z in f16 f17 f18.
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

// Positions relative to the eye.
        .macro  relative n, k, to
        fld.l   32*\n+4*\k(r16), f8
        fld.l   P_ORIGIN+4*\k(r20), f9
        fsub.ss f8, f9, \to
        .endm

// Jumps to the clipper unless a <= b.
        .macro  need a, b
        pfle.ss \a, \b, f0
        bc      clip
        .endm

// |coordinate k| <= guard k * w.
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

// The beginning of both surface routines of straight code: normals, and how far each normal turns away from the eye.
// The arithmetic and its order are the same as in the native code.

// An operation for each corner through a pipe of three stages.
        .macro  three op, a0, b0, a1, b1, a2, b2, d0, d1, d2
        \op     \a0, \b0, f0
        \op     \a1, \b1, f0
        \op     \a2, \b2, f0
        \op     f0, f0, \d0
        \op     f0, f0, \d1
        \op     f0, f0, \d2
        .endm

// d = (u x + v y) + w z for each corner. Changes u0 to u2 and f20 to f25.
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

// The same with weights that all corners share. Changes the weights.
        .macro  weighted u, v, w, x0, x1, x2, y0, y1, y2, z0, z1, z2, d0, d1, d2
        sum     \u, \u, \u, \v, \v, \v, \w, \w, \w, \x0, \x1, \x2, \y0, \y1, \y2, \z0, \z1, \z2, \u, \v, \w, \d0, \d1, \d2
        .endm

// Row k of the normals at f4, f8, f12 in eye coordinates.
        .macro  direction k, d0, d1, d2
        fld.l   P_EYE+16*\k(r20), f16
        fld.l   P_EYE+16*\k+4(r20), f17
        fld.l   P_EYE+16*\k+8(r20), f18
        weighted f16, f17, f18, f4, f8, f12, f5, f9, f13, f6, f10, f14, \d0, \d1, \d2
        .endm

// Computes how far the normal x y z of corner n turns away from the eye.
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

// In: r5 triangle. Out: normals of the display list at f4, f8, f12; how far they turn away from the eye in f11 f15 f19.
        .macro  normals
        fld.q   NORMAL(r5), f4
        fld.q   NORMAL+32(r5), f8
        fld.q   NORMAL+64(r5), f12
        away    0, f4, f5, f6, f11
        away    1, f8, f9, f10, f15
        away    2, f12, f13, f14, f19
        .endm

.if PHONG
// Surfaces for Phong shading: the normals of the corners in units of the command's expressions, plus half a unit. The
// normals are reversed if they together turn away from the eye.

// A command: enable; three edges; depth compare, depth load; normal x, y, z; the object's colour.
COMMAND_BYTES = 128

// The colour of the triangle's first corner, and its instruction head
        .macro  finish triangle
        ld.l    P_HEADS+28(r20), r6
        ld.l    COLOUR(\triangle), r7
        st.l    r6, 120(r18)
        st.l    r7, 124(r18)
        .endm

        .macro  leave from, at
        fxfr    \from, r11
        shl     6, r11, r11
        adds    r14, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k, n0, n1, n2
        three   pfadd.ss, \n0, f5, \n1, f5, \n2, f5, f12, f13, f14
        leave   f12, SURFACE_WORD*\k
        leave   f13, SURFACE_WORD*\k+SURFACE_CORNER
        leave   f14, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 destination of the words. Changes r11, r14 and all floating-point registers.
        .align  32
surface: normals
        direction 0, f26, f27, f28
        direction 1, f29, f30, f31
        direction 2, f2, f3, f7
        fadd.ss f11, f15, f4
        fadd.ss f4, f19, f4
        pfgt.ss f4, f0, f0
        bnc     facing
        three   pfsub.ss, f0, f26, f0, f27, f0, f28, f26, f27, f28
        three   pfsub.ss, f0, f29, f0, f30, f0, f31, f29, f30, f31
        three   pfsub.ss, f0, f2, f0, f3, f0, f7, f2, f3, f7
facing: fld.l   P_ROUND_S(r20), f5
        mov     0xB0000200, r14             // - 64 * bits of 1.5 * 2^23 + half a unit + 2^31
        component 0, f26, f27, f28
        component 1, f29, f30, f31
        component 2, f2, f3, f7
        bri     r1
        nop
.elseif PRECOMPUTED
// Surfaces of precomputed colours: the colours of the corners, 0 to 255 in units of 1/4096, plus half a unit.

// A command: enable; three edges; depth compare, depth load; red, green, blue.
COMMAND_BYTES = 120

// No words follow the planes.
        .macro  finish triangle
        .endm

        .macro  leave shift, colour, at
        shr     \shift, \colour, r11
        and     255, r11, r11
        shl     12, r11, r11
        or      2048, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k
        leave   16-8*\k, r7, SURFACE_WORD*\k
        leave   16-8*\k, r8, SURFACE_WORD*\k+SURFACE_CORNER
        leave   16-8*\k, r9, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 destination of the words. Changes r7 to r9 and r11.
        .align  32
surface: ld.l   COLOUR(r5), r7
        ld.l    COLOUR+32(r5), r8
        ld.l    COLOUR+64(r5), r9
        component 0
        component 1
        component 2
        bri     r1
        nop
.else
// Surfaces for Gouraud shading: lit colours of the corners, 0 to 255 in units of 1/4096, plus half a unit.

// A command: enable; three edges; depth compare, depth load; red, green, blue.
COMMAND_BYTES = 120

// No words follow the planes.
        .macro  finish triangle
        .endm

// The cosine c of the light, at least 0. If the normal turns away (by d), the other side of the normal counts.
        .macro  cosine d, c
        pfgt.ss \d, f0, f0
        bnc     facing\@
        fsub.ss f0, \c, \c
facing\@: pfgt.ss \c, f0, f0
        bc      lit\@
        fmov.ss f0, \c
lit\@:  nop
        .endm

// Limit to the range from 0 to 1.
        .macro  within s
        pfle.ss f0, \s, f0
        bnc     least\@
        fmov.ss f0, \s
least\@: pfgt.ss \s, f6, f0
        bnc     most\@
        fmov.ss f6, \s
most\@: nop
        .endm

// 256 times 8 bits of a colour, by an addition to 2^23.
        .macro  eight shift, colour, to
        shr     \shift, \colour, r11
        and     255, r11, r11
        shl     8, r11, r11
        or      r10, r11, r11
        ixfr    r11, \to
        .endm

        .macro  leave from, at
        fxfr    \from, r11
        shl     4, r11, r11
        adds    r14, r11, r11
        st.l    r11, \at(r6)
        .endm

        .macro  component k
        eight   16-8*\k, r7, f12
        eight   16-8*\k, r8, f13
        eight   16-8*\k, r9, f14
        three   pfsub.ss, f12, f4, f13, f4, f14, f4, f12, f13, f14
        three   pfmul.ss, f12, f8, f13, f9, f14, f10, f12, f13, f14
        three   pfadd.ss, f12, f5, f13, f5, f14, f5, f12, f13, f14
        leave   f12, SURFACE_WORD*\k
        leave   f13, SURFACE_WORD*\k+SURFACE_CORNER
        leave   f14, SURFACE_WORD*\k+2*SURFACE_CORNER
        .endm

// In: r5 triangle, r6 destination of the words. Changes r7 to r14 and all floating-point registers.
        .align  32
surface: normals
        fld.l   P_LIGHT(r20), f16
        fld.l   P_LIGHT+4(r20), f17
        fld.l   P_LIGHT+8(r20), f18
        weighted f16, f17, f18, f4, f8, f12, f5, f9, f13, f6, f10, f14, f26, f27, f28
        fmov.ss f26, f8
        fmov.ss f27, f9
        fmov.ss f28, f10
        cosine  f11, f8
        cosine  f15, f9
        cosine  f19, f10
        fld.l   P_AMBIENT(r20), f4
        fld.l   P_DIFFUSE(r20), f5
        fld.l   P_ONE(r20), f6
        three   pfmul.ss, f5, f8, f5, f9, f5, f10, f8, f9, f10
        three   pfadd.ss, f4, f8, f4, f9, f4, f10, f8, f9, f10
        within  f8
        within  f9
        within  f10
        ld.l    COLOUR(r5), r7
        ld.l    COLOUR+32(r5), r8
        ld.l    COLOUR+64(r5), r9
        orh     0x4B00, r0, r10             // bits of 2^23
        mov     0x4C000800, r14             // - 16 * bits of 1.5 * 2^23 + half a unit
        fld.l   P_TWO23(r20), f4
        fld.l   P_ROUND_S(r20), f5
        component 0
        component 1
        component 2
        bri     r1
        nop
.endif

// Computes one Gouraud triangle after another, like the output of a compiler of 1989 without optimization. Every
// statement loads its variables from the stack frame, computes with scalar operations and stores the result. The
// routines for corners, edges and planes are repeated at every call. The program is larger than the 4 KB instruction
// cache.
//
// The arithmetic and its order are the same as in the native transform and set-up.

// ---- stack frame
CLIP   = 0        // corner n: x y z w in clip coordinates, single, 16 bytes each
INV    = 48       // 1 / w, single, 4 bytes each (3, padded to 16)
SX     = 64       // x in subpixels, integer, of corners 0, 1, 2
SY     = 76       // y
SZ     = 88       // depth
DX1    = 112      // from corner 0 to 1 and from corner 0 to 2, double
DY1    = 120
DX2    = 128
DY2    = 136
AREA   = 144      // twice the area, double
PERPIX = 152      // 16 / twice the area
TOX    = 160      // from corner 0 to the reference pixel, in pixels
TOY    = 168
REFX   = 176      // reference pixel, double
REFY   = 184
TMP    = 192      // temporaries, double
TMP2   = 200
TMP3   = 208
TMP4   = 216
EDGEA  = 224      // a, b, c of edges 0, 1, 2, integer, 12 bytes each
V0     = 264      // values of a plane at the corners, double
V1     = 272
V2     = 280
BOX    = 288      // lowest x, highest x, lowest y, highest y
D1     = 304
D2     = 312
SAVE   = 320      // return address
SURF   = 328      // surface words

        .macro  edgeword k, n, to
        ld.l    EDGEA+12*\k+4*\n(r2), \to
        .endm

// ---- statements

// Frame double to = frame double a (op) frame double b.
        .macro  dop op, a, b, to
        fld.d   \a(r2), f8
        fld.d   \b(r2), f10
        \op     f8, f10, f12
        fst.d   f12, \to(r2)
        .endm

// Frame double = integer in register.
        .macro  todouble r, to
        xorh    0x8000, \r, r30
        ixfr    r30, f8
        orh     0x4330, r0, r30
        ixfr    r30, f9
        fld.d   P_BIAS31(r20), f10
        fsub.dd f8, f10, f12
        fst.d   f12, \to(r2)
        .endm

// Register = nearest integer, modulo 2^32, of a frame double.
        .macro  nearest from, r
        fld.d   \from(r2), f8
        fld.d   P_ROUND(r20), f10
        fadd.dd f8, f10, f12
        fxfr    f12, \r
        .endm

// Frame double = frame double rounded to an integer.
        .macro  rounded from, to
        fld.d   \from(r2), f8
        fld.d   P_ROUND(r20), f10
        fadd.dd f8, f10, f12
        fsub.dd f12, f10, f12
        fst.d   f12, \to(r2)
        .endm

// ---- one corner

// 1 / w: a seed and two Newton steps in single precision.
        .macro  invert n
        fld.l   CLIP+16*\n+12(r2), f16
        fld.l   P_TWO_S(r20), f17
        frcp.ss f16, f18
        .rept   2
        fmul.ss f16, f18, f19
        fsub.ss f17, f19, f19
        fmul.ss f18, f19, f18
        .endr
        fst.l   f18, INV+4*\n(r2)
        .endm

// Screen coordinate k in subpixels.
        .macro  snap n, k, to
        fld.l   CLIP+16*\n+4*\k(r2), f8
        fld.l   INV+4*\n(r2), f9
        fmul.ss f8, f9, f8
        fld.l   P_SCREEN+4*\k(r20), f9
        fmul.ss f8, f9, f8
        fld.l   P_SCREEN+8+4*\k(r20), f9
        fadd.ss f8, f9, f8
        fxfr    f8, r30
        orh     0x4B40, r0, r31             // bits of 1.5 * 2^23
        subs    r30, r31, r30
        st.l    r30, \to+4*\n(r2)
        .endm

// Depth: the integer nearest to z (1 / w * (far - near)) + near, at most far.
        .macro  depth n
        fld.l   CLIP+16*\n+8(r2), f8
        fld.l   INV+4*\n(r2), f9
        fld.l   P_DEPTH_SCALE(r20), f10
        fmul.ss f9, f10, f9
        fmul.sd f8, f9, f10
        fld.d   P_DEPTH(r20), f12
        pfgt.dd f10, f12, f0
        bnc     near\@
        fld.d   P_DEPTH(r20), f10
near\@: fld.d   P_DEPTH_BIAS(r20), f12
        fadd.dd f10, f12, f14               // in the low word
        fxfr    f14, r30
        st.l    r30, SZ+4*\n(r2)
        .endm

        .macro  place n
        invert  \n
        snap    \n, 0, SX
        snap    \n, 1, SY
        depth   \n
        .endm

        .macro  exchange at, with
        ld.l    \at(r2), r30
        ld.l    \with(r2), r31
        st.l    r31, \at(r2)
        st.l    r30, \with(r2)
        .endm

        .macro  swapwords at
        exchange \at+4, \at+8
        .endm

        .macro  swapsurface k
        exchange SURF+SURFACE_CORNER+SURFACE_WORD*\k, SURF+2*SURFACE_CORNER+SURFACE_WORD*\k
        .endm

        .macro  delta at, n, to
        ld.l    \at+4*\n(r2), r29
        ld.l    \at(r2), r30
        subs    r29, r30, r29
        todouble r29, \to
        .endm

        .macro  area
        delta   SX, 1, DX1
        delta   SY, 1, DY1
        delta   SX, 2, DX2
        delta   SY, 2, DY2
        dop     fmul.dd, DX1, DY2, TMP
        dop     fmul.dd, DY1, DX2, TMP2
        dop     fsub.dd, TMP, TMP2, AREA
        .endm

// ---- one edge, from corner i to corner j, number k: a = -dy, b = dx, c = floor((dx (8 - y) - dy (8 - x) - tie) / 16)
        .macro  edge k, i, j
        ld.l    SX+4*\j(r2), r24
        ld.l    SX+4*\i(r2), r26
        subs    r24, r26, r24               // dx
        ld.l    SY+4*\j(r2), r25
        ld.l    SY+4*\i(r2), r27
        subs    r25, r27, r25               // dy
        subs    r0, r25, r30
        st.l    r30, EDGEA+12*\k(r2)
        st.l    r24, EDGEA+12*\k+4(r2)
        subs    8, r26, r26
        subs    8, r27, r27
        todouble r24, TMP
        todouble r27, TMP2
        dop     fmul.dd, TMP, TMP2, TMP
        todouble r25, TMP3
        todouble r26, TMP4
        dop     fmul.dd, TMP3, TMP4, TMP3
        dop     fsub.dd, TMP, TMP3, TMP
        subs    r25, r0, r0                 // a top or a left edge?
        bc      in\@                      // 0 > dy
        bte     r0, r25, flat\@
        br      out\@
        nop
flat\@: subs    r24, r0, r0
        bc      out\@
        bte     r0, r24, out\@
in\@:   fld.d P_TIE_IN(r20), f10
        br      tied\@
        nop
out\@:  fld.d   P_TIE_OUT(r20), f10
tied\@: fld.d   TMP(r2), f8
        fadd.dd f8, f10, f8
        fld.d   P_SIXTEENTH(r20), f10
        fmul.dd f8, f10, f8
        fst.d   f8, TMP(r2)
        nearest TMP, r30
        st.l    r30, EDGEA+12*\k+8(r2)
        .endm

// ---- bounding box of three frame integers
        .macro  extent at, to
        ld.l    \at(r2), r24
        ld.l    \at(r2), r25
        ld.l    \at+4(r2), r26
        subs    r26, r24, r0
        bnc     a\@
        mov     r26, r24
a\@:    subs    r25, r26, r0
        bnc     b\@
        mov     r26, r25
b\@:    ld.l    \at+8(r2), r26
        subs    r26, r24, r0
        bnc     c\@
        mov     r26, r24
c\@:    subs    r25, r26, r0
        bnc     d\@
        mov     r26, r25
d\@:    st.l    r24, \to(r2)
        st.l    r25, \to+4(r2)
        .endm

// The reference pixel along one axis: the middle of the box within the picture, whose last subpixel the macro `most`
// gives.
        .macro  clamped r, most
        subs    r0, \r, r0
        bc      low\@                       // r > 0
        mov     r0, \r
low\@:  \most   r30
        subs    r30, \r, r0
        bnc     high\@
        mov     r30, \r
high\@: nop
        .endm

        .macro  reference box, at, most, to, distance
        ld.l    \box(r2), r24
        ld.l    \box+4(r2), r25
        clamped r24, \most
        clamped r25, \most
        adds    r24, r25, r24
        shra    5, r24, r24
        todouble r24, \to
        shl     4, r24, r24
        adds    8, r24, r24
        ld.l    \at(r2), r25
        subs    r24, r25, r24
        todouble r24, TMP
        fld.d   TMP(r2), f8
        fld.d   P_SIXTEENTH(r20), f10
        fmul.dd f8, f10, f12
        fst.d   f12, \distance(r2)
        .endm

// ---- planes

        .macro  value from, bias, to
        ld.l    \from(r2), r30
        ixfr    r30, f8
        orh     0x4330, r0, r30
        ixfr    r30, f9
        fld.d   \bias(r20), f10
        fsub.dd f8, f10, f12
        fst.d   f12, \to(r2)
        .endm

// Stores the coefficients of the plane through V0 V1 V2 at `to` of the command.
        .macro  plane to
        dop     fsub.dd, V1, V0, D1
        dop     fsub.dd, V2, V0, D2
        dop     fmul.dd, D1, DY2, TMP
        dop     fmul.dd, D2, DY1, TMP2
        dop     fsub.dd, TMP, TMP2, TMP
        dop     fmul.dd, TMP, PERPIX, TMP   // slope along x
        dop     fmul.dd, D2, DX1, TMP2
        dop     fmul.dd, D1, DX2, TMP3
        dop     fsub.dd, TMP2, TMP3, TMP2
        dop     fmul.dd, TMP2, PERPIX, TMP2 // slope along y
        nearest TMP, r30
        st.l    r30, \to(r18)
        nearest TMP2, r30
        st.l    r30, \to+4(r18)
        dop     fmul.dd, TMP, TOX, TMP3
        dop     fadd.dd, V0, TMP3, TMP3
        dop     fmul.dd, TMP2, TOY, TMP4
        dop     fadd.dd, TMP3, TMP4, TMP3   // value at the reference pixel
        rounded TMP, TMP
        rounded TMP2, TMP2
        dop     fmul.dd, TMP, REFX, TMP
        dop     fmul.dd, TMP2, REFY, TMP2
        dop     fadd.dd, TMP, TMP2, TMP
        nearest TMP3, r28
        nearest TMP, r29
        subs    r28, r29, r30
        st.l    r30, \to+8(r18)
        .endm

        .macro  depthplane to
        value   SZ, P_TWO52, V0
        value   SZ+4, P_TWO52, V1
        value   SZ+8, P_TWO52, V2
        plane   \to
        .endm

        .macro  surfaceplane k, to
        value   SURF+SURFACE_WORD*\k, P_SURFACE, V0
        value   SURF+SURFACE_CORNER+SURFACE_WORD*\k, P_SURFACE, V1
        value   SURF+2*SURFACE_CORNER+SURFACE_WORD*\k, P_SURFACE, V2
        plane   \to
        .endm

        .macro  head n, to
        ld.l    P_HEADS+4*\n(r20), r30
        st.l    r30, \to(r18)
        .endm

        .macro  words k, to
        ld.l    EDGEA+12*\k(r2), r30
        st.l    r30, \to(r18)
        ld.l    EDGEA+12*\k+4(r2), r30
        st.l    r30, \to+4(r18)
        ld.l    EDGEA+12*\k+8(r2), r30
        st.l    r30, \to+8(r18)
        .endm

// ---- a triangle
        .align  32
start:  st.l    r1, SAVE(r2)
        counted
next:   passover_straight
        corner  0
        corner  1
        corner  2
        inside  0
        inside  1
        inside  2
        place   0
        place   1
        place   2
        mov     r16, r5
        call    surface
        adds    SURF, r2, r6
        area
        fld.d   AREA(r2), f8
        pfeq.dd f8, f0, f0
        bc      done                        // nothing to draw
        facing  AREA+4, done
        pfgt.dd f0, f8, f0
        bnc     oriented
        swapwords SX                        // change to clockwise order
        swapwords SY
        swapwords SZ
        swapsurface 0
        swapsurface 1
        swapsurface 2
        area
oriented: edge  0, 0, 1
        edge    1, 1, 2
        edge    2, 2, 0
        extent  SX, BOX
        extent  SY, BOX+8
        call    bins
        nop
        bte     r0, r22, done               // no region
        head    0, 0
        head    1, 4
        words   0, 8
        head    1, 20
        words   1, 24
        head    1, 36
        words   2, 40
        head    2, 52
        head    3, 68
        head    4, 72
        head    5, 88
        head    6, 104
        reference BOX, SX, mostx, REFX, TOX
        reference BOX+8, SY, mosty, REFY, TOY
        fld.d   AREA(r2), f8
        reciprocal
        fld.d   P_SIXTEEN(r20), f8
        fmul.dd f8, f12, f12
        fst.d   f12, PERPIX(r2)
        depthplane 56
        surfaceplane 0, 76
        surfaceplane 1, 92
        surfaceplane 2, 108
        finish  r16
        restate
        adds    COMMAND_BYTES, r18, r18
done:   adds    LIST_STEP, r16, r16
        adds    -1, r17, r17
        nextorclip
