// Macros of the scalar set-up, for compiled code and the clipper.

// Makes the words of a command at r18, and its bin entries, from three corners at CORNERS. The code has functions,
// local variables in registers, and scalar floating point with loads in its shadow. The program that includes this file
// defines the macros `firstcorner`, `secondcorner` (the third corner follows the second), `surfaceof` (component k of a
// corner's surface, counted from the corner, to r10), `finish` and `steep`.

// ---- stack frame
BOX    = 8        // lowest x, highest x, lowest y, highest y
FIRST  = 24       // the corners in clockwise order, kept during a call of bins
SECOND = 28
THIRD  = 32
DX1    = 40       // from corner 0 to 1 and from corner 0 to 2, single
DY1    = 44
DX2    = 48
DY2    = 52
PERPIX = 56       // 16 / twice the area
TOX    = 64       // from corner 0 to the reference pixel, in pixels
TOY    = 72
REFX   = 80       // reference pixel, double
REFY   = 88
CORNERS = 96      // three corners, each with:
C_X    = 0        // position, rounded to subpixels, single
C_Y    = 4
C_DEPTH = 8       // values of the planes at the corner, double
C_SURFACE = 16
C_AWAY = 40       // how far the normal turns away from the eye, single
C_BYTES = 48

        .macro  edgeword k, n, to
        ld.l    8+16*\k+4*\n(r18), \to
        .endm

// ---- the least and the greatest of three coordinates, as integers
        .macro  extent a, b, c, to
        fmov.ss \a, f16
        fmov.ss \a, f17
        pfgt.ss f16, \b, f0
        bnc     p\@
        fmov.ss \b, f16
p\@:    pfgt.ss f16, \c, f0
        bnc     q\@
        fmov.ss \c, f16
q\@:    pfgt.ss \b, f17, f0
        bnc     r\@
        fmov.ss \b, f17
r\@:    pfgt.ss \c, f17, f0
        bnc     s\@
        fmov.ss \c, f17
s\@:    ftrunc.sd f16, f18
        fxfr    f18, r10
        ftrunc.sd f17, f18
        fxfr    f18, r11
        st.l    r10, \to(r2)
        st.l    r11, \to+4(r2)
        .endm

// Limits a number to at least 0 and to the limit of the macro `atmost`.
        .macro  clamped r, atmost
        subs    r0, \r, r0
        bc      low\@                       // r > 0
        mov     r0, \r
low\@:  \atmost \r
        nop
        .endm

// Computes the reference pixel along one axis, which is the middle of the box within the picture. Also computes the
// distance from the corner's coordinate to the centre of this pixel.
        .macro  reference box, at, atmost, to, distance
        ld.l    \box(r2), r10
        ld.l    \box+4(r2), r11
        clamped r10, \atmost
        clamped r11, \atmost
        adds    r10, r11, r10
        shra    5, r10, r10
        xorh    0x8000, r10, r11            // convert to a double
        ixfr    r11, f8
        orh     0x4330, r0, r11
        ixfr    r11, f9
        fld.d   P_BIAS31(r20), f10
        fld.d   P_EIGHT(r20), f12
        fsub.dd f8, f10, f14
        fmov.sd \at, f10
        fld.d   P_SIXTEENTH(r20), f16
        fst.d   f14, \to(r2)
        fsub.dd f12, f10, f12
        fmul.dd f12, f16, f12
        fadd.dd f14, f12, f12
        fst.d   f12, \distance(r2)
        .endm

// Clip coordinate k: ((c0 x + c1 y) + c2 z) + t. In: c0 and c1 in f8 and f9. Out: c0 and c1 of the next row in f8 and
// f9.
        .macro  clipped k, to
        fmul.ss f8, f16, \to
        fld.l   P_ROWS+16*\k+8(r20), f10
        fmul.ss f9, f17, f12
        fld.l   P_ROWS+16*\k+12(r20), f11
        fld.l   P_ROWS+16*\k+16(r20), f8
        fadd.ss \to, f12, \to
        fld.l   P_ROWS+16*\k+20(r20), f9
        fmul.ss f10, f18, f12
        fadd.ss \to, f12, \to
        fadd.ss \to, f11, \to
        .endm

// Jumps to `beyond` unless a <= b.
        .macro  within a, b
        pfle.ss \a, \b, f0
        bc      beyond
        .endm

// The vertex at r5: position relative to the eye in f16 f17 f18, clip coordinates in f20 to f23.
        .macro  projected
        fld.l   0(r5), f16
        fld.l   P_ORIGIN(r20), f8
        fld.l   4(r5), f17
        fld.l   P_ORIGIN+4(r20), f9
        fsub.ss f16, f8, f16                // relative to the eye
        fld.l   8(r5), f18
        fld.l   P_ORIGIN+8(r20), f10
        fsub.ss f17, f9, f17
        fld.l   P_ROWS(r20), f8
        fld.l   P_ROWS+4(r20), f9
        fsub.ss f18, f10, f18
        clipped 0, f20
        clipped 1, f21
        clipped 2, f22
        clipped 3, f23
        .endm

// Jumps to `beyond` if the clip coordinates lie outside the guard band.
        .macro  guarded
        fld.l   P_GUARD(r20), f8
        fld.l   P_GUARD+4(r20), f9
        fld.l   P_GUARD+8(r20), f10
        fmul.ss f8, f23, f8
        fld.l   P_GUARD+12(r20), f11
        fmul.ss f9, f23, f9
        within f20, f8
        fsub.ss f0, f20, f12
        within f12, f8
        within f21, f9
        fsub.ss f0, f21, f12
        within f12, f9
        within f0, f22
        within f22, f23
        within f10, f23
        within f23, f11
        .endm

// Stores the screen position of the clip coordinates in the structure at r6. The depth in f12 must still be reduced by
// f10.
        .macro  placed
        fld.l   P_TWO_S(r20), f10           // 1 / w: seed and two Newton steps
        fld.l   P_SCREEN(r20), f14
        frcp.ss f23, f11
        fld.l   P_SCREEN+4(r20), f15
        fmul.ss f23, f11, f12
        fld.l   P_SCREEN+8(r20), f24
        fsub.ss f10, f12, f12
        fld.l   P_SCREEN+12(r20), f25
        fmul.ss f11, f12, f11
        fld.l   P_ROUND_S(r20), f26
        fmul.ss f23, f11, f12
        fld.l   P_DEPTH_SCALE(r20), f27
        fsub.ss f10, f12, f12
        fld.d   P_DEPTH(r20), f28
        fmul.ss f11, f12, f11
        fmul.ss f20, f11, f20               // rounded to subpixels
        fmul.ss f20, f14, f20
        fadd.ss f20, f24, f20
        fsub.ss f20, f26, f20
        fst.l   f20, C_X(r6)
        fmul.ss f21, f11, f21
        fmul.ss f21, f15, f21
        fadd.ss f21, f25, f21
        fsub.ss f21, f26, f21
        fst.l   f21, C_Y(r6)
        fmul.ss f11, f27, f12               // depth, at most far
        fmul.sd f22, f12, f12
        pfgt.dd f12, f28, f0
        bnc     nearer\@
        fmov.dd f28, f12
nearer\@: fld.d   P_DEPTH_BIAS(r20), f14
        fld.d   P_ROUND(r20), f10
        fadd.dd f12, f14, f12
        .endm

// ---- one triangle: writes the command's words at r18, advances r18 and makes bin entries. Jumps to `done` if there is
// nothing to draw.
        .macro  set_up done
        // orientation
        firstcorner r7
        fld.d   C_X(r7), f8
        secondcorner r8
        fld.d   C_X(r8), f10
        adds    C_BYTES, r8, r9
        fld.d   C_X(r9), f12
        fsub.ss f10, f8, f16                // dx, dy to corner 1, to corner 2
        fsub.ss f11, f9, f17
        fsub.ss f12, f8, f18
        fsub.ss f13, f9, f19
        fmul.sd f16, f19, f20
        fmul.sd f17, f18, f22
        fsub.dd f20, f22, f20
        pfeq.dd f20, f0, f0
        bc      \done                       // nothing to draw
        facing_float f21, \done
        pfgt.dd f0, f20, f0
        bnc     oriented\@
        fmov.ss f16, f24                    // change to clockwise order
        fmov.ss f18, f16
        fmov.ss f24, f18
        fmov.ss f17, f24
        fmov.ss f19, f17
        fmov.ss f24, f19
        fsub.dd f0, f20, f20
        mov     r8, r10
        mov     r9, r8
        mov     r10, r9
oriented\@: fst.l f16, DX1(r2)
        fst.l   f17, DY1(r2)
        fst.l   f18, DX2(r2)
        fst.l   f19, DY2(r2)
        fst.d   f20, PERPIX(r2)
        st.l    r7, FIRST(r2)
        st.l    r8, SECOND(r2)
        st.l    r9, THIRD(r2)
        // edges
        mov     r7, r10
        mov     r8, r11
        call    edge
        adds    8, r18, r12
        mov     r8, r10
        mov     r9, r11
        call    edge
        adds    24, r18, r12
        mov     r9, r10
        mov     r7, r11
        call    edge
        adds    40, r18, r12
        // box
        fld.d   C_X(r7), f8
        fld.d   C_X(r8), f10
        fld.d   C_X(r9), f12
        extent  f8, f10, f12, BOX
        extent  f9, f11, f13, BOX+8
        call    bins
        nop
        bte     r0, r22, \done              // no region
        // Values that all planes share.
        ld.l    FIRST(r2), r7
        ld.l    SECOND(r2), r8
        fld.d   C_X(r7), f24
        ld.l    THIRD(r2), r9
        reference BOX, f24, atmostx, REFX, TOX
        reference BOX+8, f25, atmosty, REFY, TOY
        fld.d   PERPIX(r2), f8
        reciprocal
        fld.d   P_SIXTEEN(r20), f8
        fmul.dd f8, f12, f12
        fst.d   f12, PERPIX(r2)
        adds    C_DEPTH, r0, r10
        call    plane
        adds    56, r18, r11
        surfaceof 0
        call    plane
        adds    76, r18, r11
        surfaceof 1
        call    plane
        adds    92, r18, r11
        surfaceof 2
        call    plane
        adds    108, r18, r11
        // Store the instruction heads.
        ld.l    P_HEADS(r20), r10
        ld.l    P_HEADS+4(r20), r11
        st.l    r10, 0(r18)
        ld.l    P_HEADS+8(r20), r10
        st.l    r11, 4(r18)
        st.l    r11, 20(r18)
        st.l    r11, 36(r18)
        ld.l    P_HEADS+12(r20), r11
        st.l    r10, 52(r18)
        ld.l    P_HEADS+16(r20), r10
        st.l    r11, 68(r18)
        ld.l    P_HEADS+20(r20), r11
        st.l    r10, 72(r18)
        ld.l    P_HEADS+24(r20), r10
        st.l    r11, 88(r18)
        st.l    r10, 104(r18)
        finish
        restate
        adds    COMMAND_BYTES, r18, r18
        .endm

// Computes the light at the vertex at r5: 0 to 1 in f16, and the colour in r8. `away` of the structure at r6 states how
// far the normal turns away from the eye.

        .macro  intensity away
        fld.l   P_LIGHT(r20), f16
        fld.l   NORMAL(r5), f20
        fld.l   P_LIGHT+4(r20), f17
        fld.l   NORMAL+4(r5), f21
        fmul.ss f16, f20, f16
        fld.l   P_LIGHT+8(r20), f18
        fld.l   NORMAL+8(r5), f22
        fmul.ss f17, f21, f17
        fld.l   \away(r6), f8
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        fadd.ss f16, f18, f16               // the cosine
        pfgt.ss f8, f0, f0
        bnc     facing\@
        fsub.ss f0, f16, f16                // use the other side of the normal
facing\@: pfgt.ss f16, f0, f0
        bc      lit\@
        fmov.ss f0, f16
lit\@:    fld.l   P_DIFFUSE(r20), f8
        fld.l   P_AMBIENT(r20), f9
        fmul.ss f8, f16, f16
        fld.l   P_ONE(r20), f10
        fadd.ss f9, f16, f16
        pfle.ss f0, f16, f0                 // limit to the range from 0 to 1
        bnc     least\@
        fmov.ss f0, f16
least\@:  pfgt.ss f16, f10, f0
        bnc     most\@
        fmov.ss f10, f16
most\@: ld.l    COLOUR(r5), r8
        .endm

.if PHONG
// A command: enable; three edges; depth compare, depth load; normal x, y, z; the object's colour.
COMMAND_BYTES = 128

// The colour of the triangle's first corner, and its instruction head
        .macro  finish
        ld.l    P_HEADS+28(r20), r10
        ld.l    COLOUR(r16), r11
        st.l    r10, 120(r18)
        st.l    r11, 124(r18)
        .endm
.else
// A command: enable; three edges; depth compare, depth load; red, green, blue.
COMMAND_BYTES = 120

// No words follow the planes.
        .macro  finish
        .endm
.endif

// Rotation of the normals of corners, for kernels whose corners are structures in memory. place.s includes none of
// these macros, because it transforms the rows once for each structure, in doubles.

// r8 = r20 if the normals of the three corners together face the eye, otherwise r20 + 24. With r8 as base, P_SIDES is
// the table of the right side. `at` of the frame states how far the first normal turns away. The numbers of the other
// corners follow at intervals of `bytes`.
        .macro  sided at, bytes
        fld.l   \at(r2), f8
        fld.l   \at+\bytes(r2), f9
        fld.l   \at+2*\bytes(r2), f10
        fadd.ss f8, f9, f8
        mov     r20, r8
        fadd.ss f8, f10, f8
        pfgt.ss f8, f0, f0
        bnc     facing
        adds    24, r20, r8
facing:
        .endm

// f16 = component of the normal in f20 f21 f22 along an axis of the eye, whose row is at P_EYE(r11). Advances r11 to
// the next row, and decrements r9.
        .macro  alongaxis
        fld.l   P_EYE(r11), f16
        fld.l   P_EYE+4(r11), f17
        fld.l   P_EYE+8(r11), f18
        adds    -1, r9, r9
        fmul.ss f16, f20, f16
        fmul.ss f17, f21, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f22, f18
        adds    16, r11, r11
        fadd.ss f16, f18, f16
        .endm
