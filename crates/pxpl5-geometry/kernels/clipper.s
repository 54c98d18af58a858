.if PRECOMPUTED
// Precomputed colours do not depend on the normal.
        .macro  turnsaway
        .endm
.else
// Stores in the structure at r6 how far the normal of the vertex at r5 turns away from the eye. f16, f17 and f18 have
// the vertex's position relative to the eye.

        .macro  turnsaway
        fld.l   NORMAL(r5), f24             // how far the normal turns away
        fld.l   NORMAL+4(r5), f25
        fmul.ss f16, f24, f16
        fld.l   NORMAL+8(r5), f26
        fmul.ss f17, f25, f17
        fadd.ss f16, f17, f16
        fmul.ss f18, f26, f18
        fadd.ss f16, f18, f16
        fst.l   f16, V_AWAY(r6)
        .endm
.endif

.if PHONG
// The clipper interpolates the normals of Phong triangles in eye coordinates, in units of the command's normal.

        .macro  extras
        sided   VERTICES+V_AWAY, V_BYTES
        st.l    r8, SIDE(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
normal: fld.l   NORMAL(r5), f20
        fld.l   NORMAL+4(r5), f21
        fld.l   NORMAL+8(r5), f22
        adds    V_EXTRA, r6, r10
        mov     r20, r11
        mov     3, r9
axis:   alongaxis
        fst.l   f16, 0(r10)
        adds    4, r10, r10
        btne    r0, r9, axis
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, normal
        .endm
.else
// The clipper interpolates the colours of the corners, 0 to 255 * 256. The colours are lit or precomputed.

        .macro  extras
        st.l    r20, SIDE(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
.if GOURAUD
colour: intensity V_AWAY
.else
colour: ld.l    COLOUR(r5), r8
.endif
        mov     16, r9
        mov     -8, r7
        adds    V_EXTRA, r6, r10
        fld.l   P_TWO23(r20), f8
byte:   shr     r9, r8, r11                 // 256 times 8 bits of the colour, by an addition to 2^23
        and     255, r11, r11
        shl     8, r11, r11
        orh     0x4B00, r11, r11
        ixfr    r11, f17
        adds    -8, r9, r9
        adds    4, r10, r10
        fsub.ss f17, f8, f17
.if GOURAUD
        fmul.ss f17, f16, f17
.endif
        fst.l   f17, -4(r10)
        btne    r9, r7, byte                // r7 is the shift after the last component
        adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, colour
        .endm
.endif

// Code for triangles that are not completely inside the guard band. It applies the tests of the native code, clips the
// triangle at six planes, and makes a command and bin entries for each piece. All kernels share this routine and find
// its address in the parameter block. The rules of the compiled kernel apply. The arithmetic and its order are the same
// as in the native clipper.
//
// In: r16 triangle, r18 address for command words. Out: r18 address after the last command. r22 is 0 if the triangle is
// completely inside the guard band after all; the routine has then done nothing. Keeps r2 to r5, r16, r17, r19 to r21
// and no other register.

// ---- stack frame with nine corners; the upper part is as in scalar.s
SAVE     = 0        // return address
SAVED_3  = 528      // the caller's r3 to r5
SAVED_4  = 532
SAVED_5  = 536
NEXT     = 540      // second corner of the next piece
LEFT     = 544      // pieces left
SIDE     = 548      // address of P_SIDES, or of its second side
VERTICES = 560      // three vertices, each with:
V_CLIP   = 0        // x y z w, single
V_EXTRA  = 16       // the surface's three numbers, single
V_AWAY   = 28       // how far the normal turns away from the eye, single
V_BYTES  = 32
DISTANCES = 656     // of nine corners from a plane, double
POLYGON  = 736      // nine corners, each with:
G_CLIP   = 0        // x y z w, double
G_EXTRA  = 32       // the surface's three numbers, double
G_CUT    = 56       // not 0 if the corner is a cut and not a vertex
G_BYTES  = 64
OTHER    = 1312     // a second polygon of the same format
FRAME    = 1888
C_FITS   = 40       // in a corner of scalar.s: not 0 if the corner can be drawn

        .macro  firstcorner to
        adds    CORNERS, r2, \to
        .endm
        .macro  secondcorner to
        ld.l    NEXT(r2), \to
        .endm
        .macro  surfaceof k
        adds    C_SURFACE+8*\k, r0, r10
        .endm

// Jumps to `flat` if the absolute value of a slope in f22 or f24 is greater than 2^36.
        .macro  steep
        orh     0x4230, r0, r12
        ixfr    r0, f30
        ixfr    r12, f31
        pfgt.dd f22, f30, f0
        bc      flat
        pfgt.dd f24, f30, f0
        bc      flat
        fsub.dd f0, f30, f30
        pfgt.dd f30, f22, f0
        bc      flat
        pfgt.dd f30, f24, f0
        bc      flat
        .endm

// Sets `bit` in r7 if a > b.
        .macro  outcode bit, a, b
        pfgt.ss \a, \b, f0
        bnc     in\@
        or      \bit, r7, r7
in\@:
        .endm

// Draws nothing if the bits of |coordinate k| exceed the limit in r9.
        .macro  representable k
        ld.l    V_CLIP+4*\k(r6), r8
        andnoth 0x8000, r8, r8
        subs    r9, r8, r0
        bc      nothing
        .endm

// Clips the polygon at one plane. The distance of a corner is w times the factor at `k` of the parameter block, plus or
// minus a coordinate.
        .macro  cutby k, op, at
        fld.l   \k(r20), f8
        adds    DISTANCES, r2, r6
        mov     r26, r5
        mov     r27, r4
        fmov.sd f8, f16
        mov     r0, r7
each\@: fld.d   G_CLIP+24(r5), f10
        fld.d   \at(r5), f8
        adds    G_BYTES, r5, r5
        adds    -1, r4, r4
        fmul.dd f10, f16, f10
        adds    8, r6, r6
        \op     f10, f8, f12
        fst.d   f12, -8(r6)
        pfgt.dd f0, f12, f0
        bnc     within\@
        mov     1, r7
within\@: btne  r0, r4, each\@
        bte     r0, r7, next\@
        call    cut
        nop
        bte     r0, r27, nothing
next\@:
        .endm

        .align  32
clipper: adds   -FRAME, r2, r2
        st.l    r1, SAVE(r2)
        st.l    r3, SAVED_3(r2)
        st.l    r4, SAVED_4(r2)
        st.l    r5, SAVED_5(r2)
        mov     r16, r5
        adds    VERTICES, r2, r6
        mov     3, r4
        mov     r0, r24                     // number of corners inside the guard band
vertex: projected
        fst.l   f20, V_CLIP(r6)
        fst.l   f21, V_CLIP+4(r6)
        fst.l   f22, V_CLIP+8(r6)
        fst.l   f23, V_CLIP+12(r6)
        turnsaway
        guarded
        adds    1, r24, r24
beyond: adds    -1, r4, r4
        adds    VERTEX_BYTES, r5, r5
        adds    V_BYTES, r6, r6
        btne    r0, r4, vertex
        mov     3, r7
        bte     r7, r24, whole
        // Find the sides of the visible volume beyond which all corners lie.
        ld.l    P_MOST_W(r20), r9
        mov     3, r4
        mov     -1, r25
        adds    VERTICES, r2, r6
sides:  fld.l   V_CLIP(r6), f20
        fld.l   V_CLIP+4(r6), f21
        fld.l   V_CLIP+8(r6), f22
        fld.l   V_CLIP+12(r6), f23
        mov     r0, r7
        representable 0
        representable 1
        representable 2
        representable 3
        fsub.ss f0, f20, f12
        fsub.ss f0, f21, f13
        outcode 1, f20, f23
        outcode 2, f12, f23
        outcode 4, f21, f23
        outcode 8, f13, f23
        outcode 16, f0, f22
        outcode 32, f22, f23
        and     r7, r25, r25
        adds    -1, r4, r4
        adds    V_BYTES, r6, r6
        btne    r0, r4, sides
        btne    r0, r25, nothing            // all corners are beyond the same side
        extras
        // Make a polygon from the triangle.
        adds    VERTICES, r2, r6
        adds    POLYGON, r2, r26
        adds    OTHER, r2, r25
        mov     r26, r5
        mov     3, r4
corner: mov     7, r7
number: fld.l   0(r6), f8
        adds    -1, r7, r7
        adds    4, r6, r6
        fmov.sd f8, f10
        adds    8, r5, r5
        fst.d   f10, -8(r5)
        btne    r0, r7, number
        st.l    r0, 0(r5)
        adds    -1, r4, r4
        adds    8, r5, r5
        adds    4, r6, r6
        btne    r0, r4, corner
        mov     3, r27
        cutby   P_ZERO, fadd.dd, 16         // near
        cutby   P_ONE, fsub.dd, 16          // far
        cutby   P_GUARD, fsub.dd, 0
        cutby   P_GUARD, fadd.dd, 0
        cutby   P_GUARD+4, fsub.dd, 8
        cutby   P_GUARD+4, fadd.dd, 8
        adds    -2, r27, r7
        subs    r7, r0, r0
        bc      nothing                     // fewer than two corners
        bte     r0, r7, nothing
        st.l    r7, LEFT(r2)
        mov     r26, r5
        adds    CORNERS, r2, r6
        mov     r27, r4
        // Compute the screen positions of the corners.
each:   call    snapped
        nop
        adds    -1, r4, r4
        adds    G_BYTES, r5, r5
        adds    C_BYTES, r6, r6
        btne    r0, r4, each
        // Draw the pieces, which form a fan around the first corner.
        adds    CORNERS+C_BYTES, r2, r8
        st.l    r8, NEXT(r2)
piece:  ld.l    CORNERS+C_FITS(r2), r9
        ld.l    C_FITS(r8), r10
        ld.l    C_BYTES+C_FITS(r8), r11
        and     r9, r10, r10
        and     r10, r11, r11
        bte     r0, r11, drawn
        set_up  drawn
drawn:  ld.l    LEFT(r2), r7
        ld.l    NEXT(r2), r8
        adds    -1, r7, r7
        adds    C_BYTES, r8, r8
        st.l    r7, LEFT(r2)
        st.l    r8, NEXT(r2)
        btne    r0, r7, piece
nothing: mov    1, r22
leave:  ld.l    SAVE(r2), r1
        ld.l    SAVED_3(r2), r3
        ld.l    SAVED_4(r2), r4
        ld.l    SAVED_5(r2), r5
        bri     r1
        adds    FRAME, r2, r2
whole:  br      leave
        mov     r0, r22

// ---- clips the polygon of r27 corners at r26, whose distances from a plane are stored. The new polygon is at r25; r25
// and r26 are then exchanged.
cut:    mov     r26, r5
        adds    DISTANCES, r2, r6
        mov     r27, r4
        mov     r25, r9
        mov     r0, r28
        fld.d   0(r6), f16
ends:   adds    G_BYTES, r5, r7             // the next corner and its distance
        adds    8, r6, r8
        btne    1, r4, along
        mov     r26, r7
        adds    DISTANCES, r2, r8
along:  fld.d   0(r8), f18
        pfgt.dd f0, f16, f0
        bc      without
        bte     9, r28, full                // the polygon has the greatest number of corners
        fld.q   0(r5), f8
        fld.q   16(r5), f12
        fld.q   32(r5), f20
        fld.q   48(r5), f24
        fst.q   f8, 0(r9)
        fst.q   f12, 16(r9)
        fst.q   f20, 32(r9)
        fst.q   f24, 48(r9)
        adds    G_BYTES, r9, r9
        adds    1, r28, r28
full:   pfgt.dd f0, f18, f0
        bnc     on
        br      crossed
        nop
without: pfgt.dd f0, f18, f0
        bc      on
crossed: bte    9, r28, on
        mov     r5, r10                     // begin at the end that comes first in the order of the coordinates
        mov     r7, r11
        fmov.dd f16, f20
        fmov.dd f18, f22
        mov     r5, r12
        mov     r7, r13
        mov     4, r14
order:  ld.l    4(r12), r29
        ld.l    4(r13), r30
        shra    31, r29, r31
        shr     1, r31, r31
        xor     r31, r29, r29
        shra    31, r30, r31
        shr     1, r31, r24
        xor     r24, r30, r30
        subs    r30, r29, r0
        bc      greater                     // r29 > r30
        btne    r29, r30, lesser
        ld.l    0(r12), r29
        ld.l    0(r13), r30
        adds    8, r12, r12
        xor     r31, r29, r29
        xor     r31, r30, r30
        subu    r30, r29, r0
        bnc     greater                     // r29 > r30 as unsigned numbers
        btne    r29, r30, lesser
        adds    -1, r14, r14
        adds    8, r13, r13
        btne    r0, r14, order
        br      lesser
        nop
greater: mov    r7, r10
        mov     r5, r11
        fmov.dd f18, f20
        fmov.dd f16, f22
lesser: fsub.dd f20, f22, f8
        reciprocal
        fmul.dd f20, f12, f24               // fraction of the edge up to the cut
        mov     7, r12
between: fld.d  0(r10), f8
        fld.d   0(r11), f12
        adds    8, r10, r10
        adds    8, r11, r11
        fsub.dd f12, f8, f12
        adds    8, r9, r9
        fmul.dd f12, f24, f12
        adds    -1, r12, r12
        fadd.dd f8, f12, f12
        fst.d   f12, -8(r9)
        btne    r0, r12, between
        mov     1, r12
        st.l    r12, 0(r9)
        adds    8, r9, r9
        adds    1, r28, r28
on:     adds    G_BYTES, r5, r5
        adds    8, r6, r6
        adds    -1, r4, r4
        fmov.dd f18, f16
        btne    r0, r4, ends
        mov     r26, r7
        mov     r25, r26
        mov     r7, r25
        bri     r1
        mov     r28, r27

// ---- computes the screen position of the polygon's corner at r5 in the structure at r6

// coordinate k in subpixels
        .macro  scaled k, to
        fld.d   G_CLIP+8*\k(r5), \to
        fld.l   P_SCREEN+4*\k(r20), f8
        fmul.dd \to, f12, \to
        fld.l   P_SCREEN+8+4*\k(r20), f9
        fmov.sd f8, f18
        fld.l   P_ROUND_S(r20), f10
        fmul.dd \to, f18, \to
        fsub.ss f9, f10, f9
        fmov.sd f9, f18
        fadd.dd \to, f18, \to
        pfle.dd \to, f28, f0
        bc      placedend
        fsub.dd f0, \to, f18
        pfle.dd f18, f28, f0
        bc      placedend
        .endm

// component k of the surface
        .macro  component k
        fld.d   G_EXTRA+8*\k(r5), f16
        fmov.ds f16, f18
        fadd.ss f18, f9, f18
        fmul.sd f18, f10, f16
        fadd.dd f16, f12, f16
        fst.d   f16, C_SURFACE+8*\k(r6)
        .endm

snapped: fld.l  P_GUARD+8(r20), f10
        fld.d   G_CLIP+24(r5), f8
        st.l    r0, C_FITS(r6)
        fmov.sd f10, f12
        pfle.dd f12, f8, f0
        bc      placedend                   // w too small
        reciprocal
        orh     0x40F0, r0, r7              // 65,536 subpixels
        ixfr    r0, f28
        ixfr    r7, f29
        scaled  0, f16
        scaled  1, f20
        ld.l    G_CUT(r5), r7
        nop
        bte     r0, r7, uncut
        fld.d   P_ROUND(r20), f18
        fld.d   G_CLIP+16(r5), f22
        fadd.dd f16, f18, f16
        fld.l   P_DEPTH_SCALE(r20), f8
        fsub.dd f16, f18, f16
        fmov.ds f16, f9
        fst.l   f9, C_X(r6)
        fadd.dd f20, f18, f20
        fsub.dd f20, f18, f20
        fmov.ds f20, f9
        fst.l   f9, C_Y(r6)
        fmul.dd f22, f12, f22
        fmov.sd f8, f10
        fmul.dd f22, f10, f12
        pfgt.dd f12, f0, f0                 // limit the depth to the range from 0 to far
        bc      farther
        fmov.dd f0, f12
farther: fld.d  P_DEPTH(r20), f14
        nop
        pfgt.dd f12, f14, f0
        bnc     nearer
        fmov.dd f14, f12
nearer: fld.d   P_DEPTH_BIAS(r20), f14
        fld.d   P_ROUND(r20), f10
        br      deep
        fadd.dd f12, f14, f12
uncut:  fld.d   G_CLIP(r5), f8              // same computation as for vertices of triangles that are not clipped
        fld.d   G_CLIP+8(r5), f10
        fmov.ds f8, f20
        fld.d   G_CLIP+16(r5), f12
        fmov.ds f10, f21
        fld.d   G_CLIP+24(r5), f14
        fmov.ds f12, f22
        fmov.ds f14, f23
        placed
deep:   fsub.dd f12, f10, f12
        fst.d   f12, C_DEPTH(r6)
        ld.l    SIDE(r2), r7
        fld.l   P_ROUND_S(r20), f9
        fld.l   P_SIDES+8(r7), f10
        fld.d   P_SIDES+16(r7), f12
        component 0
        component 1
        component 2
        mov     1, r7
        st.l    r7, C_FITS(r6)
placedend: bri  r1
        nop

// ---- replaces a plane that is too steep for its format: the words at r11 get the mean everywhere. In: values at r10
// of the corners r7, r8 and r9.
flat:   adds    r10, r7, r12
        fld.d   0(r12), f16
        adds    r10, r8, r12
        fld.d   0(r12), f18
        adds    r10, r9, r12
        fld.d   0(r12), f20
        fadd.dd f16, f18, f16
        fld.d   P_THIRD(r20), f18
        fadd.dd f16, f20, f16
        fmul.dd f16, f18, f16
        fadd.dd f16, f28, f16
        fxfr    f16, r12
        st.l    r0, 0(r11)
        st.l    r0, 4(r11)
        bri     r1
        st.l    r12, 8(r11)
