// One Gouraud triangle after another, as a compiler of 1989 would give it: every statement loads its variables from
// the stack frame, computes with scalar operations and stores the result; the routines for corners, edges and planes
// are written out at every call. Larger than the 4 KB instruction cache.
//
// The arithmetic and its order are those of the native transform and set-up.

// ---- stack frame
CLIP   = 0        // corner n: x y z w in clip coordinates, single, 16 bytes each
INV    = 48       // 1 / w, single, 4 bytes each (3, padded to 16)
SX     = 64       // x in subpixels, integer, of corners 0, 1, 2
SY     = 76       // y
SZ     = 88       // depth
DX1    = 112      // corner 0 to 1 and 0 to 2, double
DY1    = 120
DX2    = 128
DY2    = 136
AREA   = 144      // twice the area, double
PERPIX = 152      // 16 / twice the area
TOX    = 160      // corner 0 to the pixel of reference, in pixels
TOY    = 168
REFX   = 176      // pixel of reference, double
REFY   = 184
TMP    = 192      // temporaries, double
TMP2   = 200
TMP3   = 208
TMP4   = 216
EDGEA  = 224      // a, b, c of edges 0, 1, 2, integer, 12 bytes each
V0     = 264      // values of a plane at the corners, double
V1     = 272
V2     = 280
BOX    = 288      // low x, high x, low y, high y
D1     = 304
D2     = 312
SAVE   = 320      // return address
SURF   = 328      // surface words

        .macro  edgeword k, n, to
        ld.l    EDGEA+12*\k+4*\n(r2), \to
        .endm

// ---- statements

// frame double to = frame double a (op) frame double b
        .macro  dop op, a, b, to
        fld.d   \a(r2), f8
        fld.d   \b(r2), f10
        \op     f8, f10, f12
        fst.d   f12, \to(r2)
        .endm

// frame double = integer in register
        .macro  todouble r, to
        xorh    0x8000, \r, r30
        ixfr    r30, f8
        orh     0x4330, r0, r30
        ixfr    r30, f9
        fld.d   P_BIAS31(r20), f10
        fsub.dd f8, f10, f12
        fst.d   f12, \to(r2)
        .endm

// register = nearest integer, modulo 2^32, of a frame double
        .macro  nearest from, r
        fld.d   \from(r2), f8
        fld.d   P_ROUND(r20), f10
        fadd.dd f8, f10, f12
        fxfr    f12, \r
        .endm

// frame double = frame double rounded to an integer
        .macro  rounded from, to
        fld.d   \from(r2), f8
        fld.d   P_ROUND(r20), f10
        fadd.dd f8, f10, f12
        fsub.dd f12, f10, f12
        fst.d   f12, \to(r2)
        .endm

// ---- one corner

// 1 / w: seed and two Newton steps in single precision
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

// screen coordinate k in subpixels
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

// depth: the integer nearest to z (1 / w * (far - near)) + near, at most far
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

// pixel of reference along one axis: middle of the box within the picture, whose last subpixel is what the macro `most` gives
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

// coefficients of the plane through V0 V1 V2 to the words at `to` of the command
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
        dop     fadd.dd, TMP3, TMP4, TMP3   // value at the pixel of reference
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
        swapwords SX                        // make it clockwise
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
        btne    r0, r17, next
        ld.l    SAVE(r2), r1
        nop
        bri     r1
        nop
clip:   ld.l    P_CLIPPER(r20), r6          // not wholly inside the guard band
        nop
        calli   r6
        nop
        br      done
        nop
